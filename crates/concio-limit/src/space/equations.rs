//! (S1) as sparse columns, free of dimensions: forces over the mean dead load, lengths over the mean size of a block.

use super::Problem;
use super::assembly::{Vector, cross, dot, length, minus, plus, scaled};
use crate::equations::Column;

/// Rows of a body: three forces, three moments about its centre.
pub(super) const ROWS: usize = 6;

/// A point where two sides press and rub.
#[derive(Debug, Clone)]
pub(super) struct Point {
    /// A unit of normal force.
    pub normal: Column,
    /// A unit of each tangential force.
    pub tangents: [Column; 2],
    /// μ.
    pub friction: f64,
}

/// A pull of bounded force.
#[derive(Debug, Clone)]
pub(super) struct Pull {
    /// A unit of force.
    pub column: Column,
    /// The most that it pulls.
    pub most: f64,
}

/// The equations of equilibrium.
#[derive(Clone)]
pub(super) struct Equations {
    /// Number of rows: six of each body that may move, then one of each contact that gives way.
    pub rows: usize,
    /// Bodies that may move.
    pub moved: usize,
    /// Four points of each contact in turn, then one of each support.
    pub points: Vec<Point>,
    /// What each contact bears until it crushes; empty: none does.
    pub bears: Vec<f64>,
    /// What gives way, in the order of its contacts, then the ties.
    pub pulls: Vec<Pull>,
    /// The live load, its magnitudes summing to 1: velocities of the mechanism are then near 1.
    pub live: Vec<f64>,
    /// The dead load.
    pub dead: Vec<f64>,
    /// Unit of force [N].
    pub force: f64,
    /// Unit of length [m].
    pub length: f64,
    /// First row of every body; none of what is held.
    pub first: Vec<Option<usize>>,
    /// Centre of every body that may move, in the order of its rows, over the unit of length.
    pub centres: Vec<Vector>,
    /// Unit vector upwards.
    pub up: Vector,
    total: f64,
}

impl Equations {
    /// Of a problem that was checked.
    pub fn of(problem: &Problem) -> Self {
        let bodies = &problem.assembly.bodies;
        let mut rows = 0;
        let first: Vec<Option<usize>> = problem
            .held
            .iter()
            .map(|held| {
                (!held).then(|| {
                    rows += ROWS;
                    rows - ROWS
                })
            })
            .collect();
        let moving = || (0..bodies.len()).filter(|i| first[*i].is_some());
        let count = (rows / ROWS).max(1) as f64;
        let size = |i: usize| bodies[i].corners.iter().map(|c| length(minus(*c, bodies[i].centre))).fold(0.0, f64::max);
        let unit = moving().map(size).sum::<f64>() / count;
        let own: f64 = moving().map(|i| bodies[i].weight).sum();
        let given: f64 = problem.loads.iter().map(|l| length(l.force)).sum();
        // Where nothing weighs, what pushes is the measure.
        let force = if own + given > 0.0 { own + given } else { problem.live_load() } / count;
        let total = problem.live_load() / force;
        let at_body = |body: usize, at: Vector, f: Vector| -> Column {
            let Some(row) = first[body] else { return Vec::new() };
            let moment = cross(scaled(minus(at, bodies[body].centre), 1.0 / unit), f);
            let all = f.into_iter().chain(moment).enumerate();
            all.filter(|(_, v)| v.abs() > ROUNDING).map(|(k, v)| (row + k, v)).collect()
        };
        let between = |a: usize, b: Option<usize>, at: [Vector; 2], f: Vector| -> Column {
            let mut column = at_body(a, at[0], scaled(f, -1.0));
            column.extend(b.map(|b| at_body(b, at[1], f)).unwrap_or_default());
            column.sort_by_key(|(row, _)| *row);
            column
        };
        let mut points = Vec::with_capacity(4 * problem.assembly.contacts.len() + problem.supports.len());
        let mut pulls = Vec::with_capacity(problem.ties.len());
        let moved = rows / ROWS;
        for contact in &problem.assembly.contacts {
            // What gives way is a body that moves along the normal alone, against a force of its own.
            let abutment = contact.gives_way.map(|most| {
                pulls.push(Pull { column: vec![(rows, 1.0)], most: most / force });
                rows += 1;
                (rows - 1, -1.0)
            });
            let tangents = tangents(contact.normal, minus(contact.corners[1], contact.corners[0]));
            points.extend(contact.corners.iter().map(|at| Point {
                normal: between(contact.a, contact.b, [*at; 2], contact.normal).into_iter().chain(abutment).collect(),
                tangents: tangents.map(|t| between(contact.a, contact.b, [*at; 2], t)),
                friction: contact.friction,
            }));
        }
        for support in &problem.supports {
            let normal = scaled(support.direction, 1.0 / length(support.direction));
            points.push(Point {
                normal: at_body(support.body, support.at, normal),
                tangents: tangents(normal, [0.0; 3]).map(|t| at_body(support.body, support.at, t)),
                friction: support.friction,
            });
        }
        pulls.extend(problem.ties.iter().map(|tie| {
            let along = minus(tie.end, tie.at);
            let along = scaled(along, -1.0 / length(along));
            Pull { column: between(tie.body, tie.to, [tie.at, tie.end], along), most: tie.yields / force }
        }));
        let down = scaled(problem.down, 1.0 / length(problem.down));
        let direction = scaled(problem.direction, 1.0 / length(problem.direction));
        let (mut dead, mut live) = (vec![0.0; rows], vec![0.0; rows]);
        let add = |to: &mut Vec<f64>, body: usize, at: Vector, f: Vector| {
            at_body(body, at, f).iter().for_each(|(row, v)| to[*row] += v);
        };
        for i in moving() {
            let (weight, centre) = (bodies[i].weight, bodies[i].centre);
            add(&mut dead, i, centre, scaled(down, weight / force));
            if problem.pushed[i] {
                add(&mut live, i, centre, scaled(direction, weight / (force * total)));
            }
        }
        for load in &problem.loads {
            add(&mut dead, load.body, load.at, scaled(load.force, 1.0 / force));
            add(&mut live, load.body, load.at, scaled(direction, load.pushes / (force * total)));
        }
        Equations {
            rows,
            moved,
            points,
            bears: problem.bears.iter().map(|b| b / force).collect(),
            pulls,
            live,
            dead,
            force,
            length: unit,
            centres: moving().map(|i| scaled(bodies[i].centre, 1.0 / unit)).collect(),
            first,
            up: scaled(down, -1.0),
            total,
        }
    }

    /// λ of the scaled multiplier.
    pub fn multiplier(&self, scaled: f64) -> f64 {
        scaled / self.total
    }

    /// What is out of balance under forces of points and ties and the scaled multiplier, (S1).
    pub fn residual(&self, forces: &[Vector], pulls: &[f64], multiplier: f64) -> Vec<f64> {
        let mut sum: Vec<f64> = self.live.iter().zip(&self.dead).map(|(f, d)| multiplier * f + d).collect();
        let mut add = |column: &Column, force: f64| column.iter().for_each(|(row, v)| sum[*row] += v * force);
        for (point, force) in self.points.iter().zip(forces) {
            add(&point.normal, force[0]);
            add(&point.tangents[0], force[1]);
            add(&point.tangents[1], force[2]);
        }
        self.pulls.iter().zip(pulls).for_each(|(pull, force)| add(&pull.column, *force));
        sum
    }
}

/// Parts of unit vectors, and of arms over the size of a block, that count as none.
const ROUNDING: f64 = 1e-14;

/// Two unit vectors across a normal, one along a side where it has a length.
pub(super) fn tangents(normal: Vector, side: Vector) -> [Vector; 2] {
    let smallest = (0..3).min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[smallest] = 1.0;
    let along = if length(side) > 0.0 { side } else { axis };
    let first = plus(along, scaled(normal, -dot(along, normal)));
    let first = scaled(first, 1.0 / length(first));
    [first, cross(normal, first)]
}
