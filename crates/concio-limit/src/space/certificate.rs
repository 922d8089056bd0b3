//! Bounds that hold whatever the solver says of its solution.
//!
//! An interior point method stops with forces inside their cones that are slightly out of balance, and with velocities under
//! which points overlap slightly.
//!
//! - Lower: the change that brings the forces back into balance is the shortest one measured by how far every force is from
//!   the border of its cone (the local norm of its barrier): below 1 in each point it leaves no cone. What leaves one is put
//!   back on its border. Of the imbalance r that remains the power on the mechanism, |r|·|v|, is taken off twice: for
//!   velocities v of the collapse itself, λ of the forces is at most r·v above the true one.
//! - Upper: where a point overlaps by as much as δ, δ times velocities under which every point opens by 1 are added. (S4) then
//!   holds, and any velocities that obey it and (S5) bound λ. Where blocks are wedged in between held ones there are none such;
//!   of the overlaps δ that remain the power δ N is added twice, with the normal force N found and a block's weight.
//!
//! Forces on contacts that crush are put back into (S6) towards even pressure. What eases the corners of crushing contacts is
//! taken from the solution, and its cost is counted as (S6) has it, whatever the solver says of it.
//!
//! Both are evaluated for the solution as it came too, and the better counts.

use super::assembly::Vector;
use super::equations::{Equations, Pull, ROWS};
use super::program::{EDGES, Ease, Solution, beyond, opening};
use crate::LimitError;
use crate::certificate::least_change;
use crate::equations::{Column, dot, power};
use crate::program::Friction;

/// Forces and the multiplier that they prove.
pub(super) struct Lower {
    /// Scaled λ.
    pub multiplier: f64,
    /// Normal and tangential forces of every point.
    pub forces: Vec<Vector>,
    /// Forces of ties.
    pub pulls: Vec<f64>,
    /// Largest residual of a force balance.
    pub unbalanced: f64,
}

/// Velocities and the multiplier that they prove.
pub(super) struct Upper {
    /// Scaled λ.
    pub multiplier: f64,
    pub velocities: Vec<f64>,
}

/// Times that the forces are brought back into balance: each finds what the last one cut off.
const ROUNDS: usize = 3;
/// What the margin may take off λ, over the larger of |λ| and 1, before they are: as a rule the solver's forces take less.
const GOOD: f64 = 1e-7;

/// An approximate answer in forces.
#[derive(Clone)]
struct Forces {
    points: Vec<Vector>,
    pulls: Vec<f64>,
    multiplier: f64,
}

pub(super) fn lower(equations: &Equations, solution: &Solution) -> Lower {
    let given =
        Forces { points: solution.forces.clone(), pulls: solution.pulls.clone(), multiplier: solution.multiplier };
    let mut forces = admissible(equations, given);
    let mut best = prove_lower(equations, solution, forces.clone());
    for _ in 0..ROUNDS {
        if best.multiplier >= solution.multiplier - GOOD * solution.multiplier.abs().max(1.0) {
            break;
        }
        let Some(next) = balanced(equations, &forces) else { break };
        forces = admissible(equations, next);
        let proven = prove_lower(equations, solution, forces.clone());
        if proven.multiplier > best.multiplier {
            best = proven;
        }
    }
    best
}

/// The forces with those that left their cones on their borders.
fn admissible(equations: &Equations, mut forces: Forces) -> Forces {
    forces.points.iter_mut().for_each(|force| force[0] = force[0].max(0.0));
    equations.bears.iter().zip(forces.points.chunks_mut(4)).for_each(|(bears, corners)| borne(*bears, corners));
    for (force, point) in forces.points.iter_mut().zip(&equations.points) {
        let (most, has) = (point.friction * force[0], force[1].hypot(force[2]));
        if has > most {
            // A little less, so that rounding does not bring it out again.
            let part = most / has * (1.0 - f64::EPSILON);
            (force[1], force[2]) = (part * force[1], part * force[2]);
        }
    }
    for (force, pull) in forces.pulls.iter_mut().zip(&equations.pulls) {
        *force = force.clamp(0.0, pull.most);
    }
    forces
}

/// Normal forces of a contact's corners, from 0, brought into (S6).
fn borne(bears: f64, corners: &mut [Vector]) {
    // A little less, so that rounding does not bring them out again.
    let bears = bears * (1.0 - 4.0 * f64::EPSILON);
    let all = |corners: &[Vector]| corners.iter().map(|f| f[0]).sum::<f64>();
    let over = all(corners) / bears;
    if over > 1.0 {
        corners.iter_mut().for_each(|f| f[0] /= over);
    }
    let sum = all(corners);
    let least = sum * sum / (2.0 * bears);
    let lacks = |edge: [usize; 2]| {
        let has: f64 = edge.iter().map(|k| corners[*k][0]).sum();
        if has < least { ((least - has) / (0.5 * sum - has)).clamp(0.0, 1.0) } else { 0.0 }
    };
    let part = EDGES.map(lacks).into_iter().fold(0.0, f64::max);
    if part > 0.0 {
        corners.iter_mut().for_each(|f| f[0] += part * (0.25 * sum - f[0]));
    }
}

fn prove_lower(equations: &Equations, solution: &Solution, forces: Forces) -> Lower {
    let residual = equations.residual(&forces.points, &forces.pulls, forces.multiplier);
    let raised: f64 = residual.iter().zip(&solution.velocities).map(|(r, v)| r.abs() * v.abs()).sum();
    let of_forces = residual
        .iter()
        .enumerate()
        .filter(|(row, _)| row % ROWS < 3 || *row >= ROWS * equations.moved)
        .map(|(_, r)| r.abs());
    Lower {
        multiplier: forces.multiplier - 2.0 * raised,
        unbalanced: of_forces.fold(0.0, f64::max),
        forces: forces.points,
        pulls: forces.pulls,
    }
}

/// What a unit of an unknown adds to the forces of a point or a tie.
enum Part {
    Point(usize, Vector),
    Pull(usize, f64),
    Multiplier(f64),
}

/// The nearest forces in balance, by the local norm.
///
/// A cone is in the plane of its axis and its force the product of two half lines, with weights (N ± |T|/μ)/2 on its edges;
/// across that plane the norm is that of a length √(2 w₊ w₋).
fn balanced(equations: &Equations, forces: &Forces) -> Option<Forces> {
    let residual = equations.residual(&forces.points, &forces.pulls, forces.multiplier);
    let mut parts = Vec::new();
    for (k, (force, point)) in forces.points.iter().zip(&equations.points).enumerate() {
        let (mu, normal, rubs) = (point.friction, force[0], force[1].hypot(force[2]));
        if mu == 0.0 {
            parts.push(Part::Point(k, [normal, 0.0, 0.0]));
            continue;
        }
        let way = if rubs > 0.0 { [force[1] / rubs, force[2] / rubs] } else { [1.0, 0.0] };
        let weights = [0.5 * (normal + rubs / mu), (0.5 * (normal - rubs / mu)).max(0.0)];
        for (weight, sign) in weights.iter().zip([mu, -mu]) {
            parts.push(Part::Point(k, [*weight, sign * weight * way[0], sign * weight * way[1]]));
        }
        let across = mu * (2.0 * weights[0] * weights[1]).sqrt();
        parts.push(Part::Point(k, [0.0, -across * way[1], across * way[0]]));
    }
    for (k, (force, pull)) in forces.pulls.iter().zip(&equations.pulls).enumerate() {
        parts.push(Part::Pull(k, force.min(pull.most - force)));
    }
    parts.push(Part::Multiplier(1.0));
    let mut rows: Vec<Column> = vec![Vec::new(); equations.rows];
    for (k, part) in parts.iter().enumerate() {
        let mut add = |column: &Column, by: f64| {
            if by != 0.0 {
                for (row, v) in column {
                    match rows[*row].last_mut() {
                        Some((last, sum)) if *last == k => *sum += by * v,
                        _ => rows[*row].push((k, by * v)),
                    }
                }
            }
        };
        match part {
            Part::Point(p, force) => {
                let point = &equations.points[*p];
                add(&point.normal, force[0]);
                add(&point.tangents[0], force[1]);
                add(&point.tangents[1], force[2]);
            }
            Part::Pull(p, force) => add(&equations.pulls[*p].column, *force),
            Part::Multiplier(by) => {
                equations.live.iter().enumerate().for_each(|(row, f)| {
                    if *f != 0.0 {
                        rows[row].push((k, by * f));
                    }
                });
            }
        }
    }
    let right: Vec<f64> = residual.iter().map(|r| -r).collect();
    let change = least_change(&rows, parts.len(), &right)?;
    let mut next = forces.clone();
    for (part, change) in parts.iter().zip(&change) {
        match part {
            Part::Point(k, unit) => next.points[*k].iter_mut().zip(unit).for_each(|(f, u)| *f += change * u),
            Part::Pull(k, unit) => next.pulls[*k] += change * unit,
            Part::Multiplier(unit) => next.multiplier += change * unit,
        }
    }
    Some(next)
}

/// # Errors
/// Velocities that do not move the live load.
pub(super) fn upper(equations: &Equations, friction: &[Friction], solution: &Solution) -> Result<Upper, LimitError> {
    let mut velocities = solution.velocities.clone();
    let mut eases: Vec<Ease> = solution.eases.iter().map(|e| possible(*e)).collect();
    let overlaps = |v: &[f64], eases: &[Ease]| -> Vec<f64> {
        let each = equations.points.iter().zip(friction).enumerate();
        each.map(|(k, (point, law))| (-beyond(point, law.slope, v) - eased(eases, k)).max(0.0)).collect()
    };
    let most = overlaps(&velocities, &eases).into_iter().fold(0.0, f64::max);
    if most > 0.0
        && let Some(apart) = opening(equations, friction)?
    {
        velocities.iter_mut().zip(&apart).for_each(|(v, a)| *v += most * a);
    }
    let moved = dot(&equations.live, &velocities);
    if !(moved > 0.0) {
        return Err(LimitError::NotSolved("no mechanism obeys the flow rule".into()));
    }
    velocities.iter_mut().for_each(|v| *v /= moved);
    eases.iter_mut().for_each(|e| *e = Ease { all: e.all / moved, edge: e.edge / moved });
    let stretch = |pull: &Pull| pull.most * (-power(&pull.column, &velocities)).max(0.0);
    let ties: f64 = equations.pulls.iter().map(stretch).sum();
    let costs =
        equations.bears.iter().zip(eases.chunks(4)).map(|(c, four)| four.iter().map(|e| cost(*c, *e)).sum::<f64>());
    let crushed: f64 = costs.sum();
    let pressed = overlaps(&velocities, &eases).into_iter().zip(&solution.forces);
    let wedged: f64 = pressed.map(|(overlap, force)| 2.0 * overlap * (1.0 + force[0].max(0.0))).sum();
    Ok(Upper { multiplier: ties - dot(&equations.dead, &velocities) + crushed + wedged, velocities })
}

/// What eases corners at a cost that is a number; else none does.
fn possible(ease: Ease) -> Ease {
    if ease.edge > 0.0 && ease.all > 0.0 { ease } else { Ease::default() }
}

/// By how much a corner may overlap, (S6): below 0 where it has to part.
fn eased(eases: &[Ease], corner: usize) -> f64 {
    let four = eases.get(corner / 4 * 4..corner / 4 * 4 + 4).unwrap_or(&[]);
    let along = |edge: [usize; 2]| edge.contains(&(corner % 4));
    four.iter().zip(EDGES).map(|(e, edge)| if along(edge) { e.all - e.edge } else { e.all }).sum()
}

/// Power of what crushes: c r²/(2 p).
fn cost(bears: f64, ease: Ease) -> f64 {
    if ease.all > 0.0 { bears * ease.all * ease.all / (2.0 * ease.edge) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::program::{SHARP, solve};
    use super::super::{Assembly, Facade, Problem};
    use super::*;

    /// Forces that a careless solver left a thousandth off are brought into balance within their cones, and prove nearly as much.
    #[test]
    fn forces_that_are_off_still_prove_a_bound() {
        let facade = Facade {
            thickness: 0.2,
            course: 0.2,
            courses: 4,
            length: 1.2,
            sides: [true, false],
            depth: 0.9,
            specific_weight: 20e3,
        };
        let blocks = facade.blocks().expect("a façade");
        let problem = Problem::new(Assembly::of_boxes(&blocks, 0.6).expect("a wall"), [-1.0, 0.0, 0.0]);
        let equations = Equations::of(&problem);
        let friction: Vec<Friction> =
            equations.points.iter().map(|p| Friction { slope: p.friction, cohesion: 0.0 }).collect();
        let mut solution = solve(&equations, &friction, SHARP).expect("a solution");
        let right = solution.multiplier;
        for (k, force) in solution.forces.iter_mut().enumerate() {
            let off = 1e-3 * ((k * 7919 % 101) as f64 / 50.0 - 1.0);
            force.iter_mut().for_each(|f| *f *= 1.0 + off);
        }
        let given = Forces { points: solution.forces.clone(), pulls: Vec::new(), multiplier: right };
        let as_given = prove_lower(&equations, &solution, admissible(&equations, given)).multiplier;
        let found = lower(&equations, &solution);
        assert!(
            found.multiplier <= right * (1.0 + 1e-9) && found.multiplier > 0.99 * right,
            "{} {right}",
            found.multiplier
        );
        assert!(as_given < found.multiplier && found.unbalanced < 1e-9, "{as_given} {}", found.unbalanced);
        for (force, point) in found.forces.iter().zip(&equations.points) {
            assert!(force[0] >= 0.0 && force[1].hypot(force[2]) <= point.friction * force[0], "{force:?}");
        }
    }
}
