//! The cone program of mechanisms, whose dual is that of forces.
//!
//! Unknown are the velocities v, the stretch rate e of every tie, and, where a point has a cohesion c, what bounds its slip:
//!
//! (S8) least −D·v + Σ c τ + Σ Y e with F·v = 1, e ≥ 0, e ≥ the tie's own; τ ≥ |s|, o ≥ ν τ.
//!
//! Without cohesion (o, μ s) lies in the cone. The multipliers of these rows are the forces N and T, that of F·v = 1 is λ. In
//! this form the matrix that is factorised has three rows for each point; written in forces it has six.
//! Where stones crush, each edge of a contact adds what is dual to (S6): its corners have to part by p − r, the others may overlap
//! by r, at the cost c r²/(2 p). With α ≥ √(β² + γ²) these are p = √c (α + β), r = −√2 γ and √c (α − β).
//! Forces near N̄: a point may overlap by u, at the cost N̄ u + u²/(2 w), whose dual is w (N − N̄)²/2.
//! A point without friction has a row of its own, o ≥ 0: in (μ N, T) with μ = 0 nothing would keep N from pulling.

use std::f64::consts::SQRT_2;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use super::assembly::{Vector, dot, scaled};
use super::equations::{Equations, Point, Pull};
use crate::LimitError;
use crate::equations::{Column, power};
use crate::program::{Friction, settings};

/// Approximate solution of the program and its dual.
pub(super) struct Solution {
    /// Normal and the tangential forces of every point.
    pub forces: Vec<Vector>,
    /// Force of every tie.
    pub pulls: Vec<f64>,
    /// How every edge of every contact that crushes eases its corners.
    pub eases: Vec<Ease>,
    /// Velocities.
    pub velocities: Vec<f64>,
    /// Scaled λ.
    pub multiplier: f64,
    /// Rounds of the solver.
    pub iterations: u32,
}

/// What crushes lets corners overlap: all four of a contact by r, less by p along one edge.
#[derive(Clone, Copy, Default)]
pub(super) struct Ease {
    pub all: f64,
    pub edge: f64,
}

/// Corners of the edges of a contact.
pub(super) const EDGES: [[usize; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 0]];

/// What is aimed at; what is reached is certified afterwards.
pub(super) const SHARP: f64 = 1e-10;
/// Enough where the answer is yes or no, or an estimate.
pub(super) const COARSE: f64 = 1e-8;

/// Normal forces N̄ that those of the points should be near to.
pub(super) struct Near<'a> {
    pub normal: &'a [f64],
    /// w: what (N − N̄)²/2 of a point takes from the scaled λ.
    pub weight: f64,
}

/// Minimises (S8).
///
/// # Errors
/// A load without limit, forces that cannot balance the dead load, an end without numbers.
pub(super) fn solve(equations: &Equations, friction: &[Friction], tolerance: f64) -> Result<Solution, LimitError> {
    solve_near(equations, friction, tolerance, None)
}

/// As [`solve`], with normal forces near others.
pub(super) fn solve_near(
    equations: &Equations,
    friction: &[Friction],
    tolerance: f64,
    near: Option<Near>,
) -> Result<Solution, LimitError> {
    let mut program = Program::new(equations);
    program.cost.iter_mut().zip(&equations.dead).for_each(|(cost, dead)| *cost = -dead);
    let moved = program.zero(1.0);
    program.dense(moved, &equations.live);
    let places: Vec<Place> =
        equations.points.iter().zip(friction).map(|(point, law)| program.point(point, *law)).collect();
    if let Some(near) = near {
        program.near(&places, &near);
    }
    let crushes = program.crush(equations, &places);
    let pulls: Vec<Row> = equations.pulls.iter().map(|pull| program.pull(pull)).collect();
    let ended = program.solve(tolerance)?;
    match ended.status {
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            return Err(LimitError::NotSolved("nothing limits the load".into()));
        }
        SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => return Err(LimitError::DoesNotStand),
        _ => {}
    }
    let z = &ended.z;
    let force = |(place, law): (&Place, &Friction)| match *place {
        Place::Smooth(row) => [z.at(row), 0.0, 0.0],
        Place::Rough(row) => {
            let [normal, a, b] = z.three(row);
            [normal, law.slope * a, law.slope * b]
        }
        Place::Cohesive(above, row) => {
            let [_, a, b] = z.three(row);
            [z.at(above), a, b]
        }
    };
    let roots = equations.bears.iter().flat_map(|c| [c.sqrt(); 4]);
    let eased = |([a, b, c], root): (&[usize; 3], f64)| Ease {
        edge: root * (ended.x[*a] + ended.x[*b]),
        all: -SQRT_2 * ended.x[*c],
    };
    Ok(Solution {
        eases: crushes.iter().zip(roots).map(eased).collect(),
        forces: places.iter().zip(friction).map(force).collect(),
        pulls: pulls.iter().map(|row| z.at(*row)).collect(),
        velocities: ended.x[..equations.rows].to_vec(),
        multiplier: -z.at(moved),
        iterations: ended.iterations,
    })
}

/// Whether forces balance the dead load alone, to 1e-5 of it.
///
/// # Errors
/// A program that was not solved.
pub(super) fn stands(equations: &Equations, friction: &[Friction]) -> Result<bool, LimitError> {
    // The most power that the dead load can have in a mechanism of power 1 at most: 0 or 1.
    let mut program = Program::new(equations);
    program.cost.iter_mut().zip(&equations.dead).for_each(|(cost, dead)| *cost = -dead);
    let row = program.above(1.0);
    program.dense(row, &equations.dead);
    let places: Vec<Place> =
        equations.points.iter().zip(friction).map(|(point, law)| program.point(point, *law)).collect();
    program.crush(equations, &places);
    equations.pulls.iter().for_each(|pull| {
        program.pull(pull);
    });
    Ok(program.solve(COARSE)?.cost > -1e-5)
}

/// Velocities under which every point opens by 1 at least beyond its dilation; none where there are no such velocities.
///
/// # Errors
/// A program that was not solved.
pub(super) fn opening(equations: &Equations, friction: &[Friction]) -> Result<Option<Vec<f64>>, LimitError> {
    let least = |v: &[f64]| {
        let each = equations.points.iter().zip(friction).map(|(p, law)| beyond(p, law.slope, v));
        each.fold(f64::INFINITY, f64::min)
    };
    // Blocks drift apart, upwards more than sideways: enough for courses with level beds.
    for ratio in [1.0, 4.0, 16.0, 64.0] {
        let mut drift: Vec<f64> = equations
            .centres
            .iter()
            .flat_map(|c| {
                let up = scaled(equations.up, (ratio - 1.0) * dot(*c, equations.up));
                [c[0] + up[0], c[1] + up[1], c[2] + up[2], 0.0, 0.0, 0.0]
            })
            .collect();
        drift.resize(equations.rows, 0.0);
        let found = least(&drift);
        if found > 1e-3 {
            return Ok(Some(drift.iter().map(|v| v / found).collect()));
        }
    }
    // The most that all can open by with velocities of 1 at most.
    let mut program = Program::new(equations);
    let all = program.unknown(-1.0);
    for (point, law) in equations.points.iter().zip(friction) {
        let row = program.point(point, *law).opens();
        program.entry(row, all, 1.0);
    }
    for unknown in 0..equations.rows {
        for sign in [1.0, -1.0] {
            let row = program.above(1.0);
            program.entry(row, unknown, sign);
        }
    }
    let x = program.solve(COARSE)?.x;
    let found = least(&x[..equations.rows]);
    Ok((found > 1e-6).then(|| x[..equations.rows].iter().map(|v| v / found).collect()))
}

/// How far a point opens beyond μ times its slip.
pub(super) fn beyond(point: &Point, slope: f64, velocities: &[f64]) -> f64 {
    let [o, a, b] = [&point.normal, &point.tangents[0], &point.tangents[1]].map(|c| power(c, velocities));
    if slope > 0.0 { o - slope * a.hypot(b) } else { o }
}

/// Rows of a point.
#[derive(Clone, Copy)]
enum Place {
    /// Its opening.
    Smooth(Row),
    /// The first of three: opening, and slip times μ.
    Rough(Row),
    /// Its opening beyond dilation; the first of three: bound of its slip, and slip.
    Cohesive(Row, Row),
}

impl Place {
    /// The row of its opening.
    fn opens(self) -> Row {
        let (Place::Smooth(row) | Place::Rough(row) | Place::Cohesive(row, _)) = self;
        row
    }
}

/// A row, before it is known how many there are of each kind.
#[derive(Clone, Copy)]
enum Row {
    Zero,
    Above(usize),
    Cone(usize),
}

/// What clarabel is given: rows b − A x that are 0, at least 0, or three in a cone.
struct Program {
    cost: Vec<f64>,
    /// Unknowns whose squares cost too, with twice the factor.
    squares: Vec<(usize, f64)>,
    rows: Vec<Row>,
    columns: Vec<usize>,
    values: Vec<f64>,
    zero: Vec<f64>,
    above: Vec<f64>,
    cones: usize,
}

/// Multipliers of the rows.
struct Split {
    values: Vec<f64>,
    above: usize,
    cones: usize,
}

impl Split {
    fn at(&self, row: Row) -> f64 {
        self.values[match row {
            Row::Zero => 0,
            Row::Above(k) => self.above + k,
            Row::Cone(k) => self.cones + k,
        }]
    }

    fn three(&self, row: Row) -> Vector {
        [0, 1, 2].map(|k| self.at(row.next(k)))
    }
}

impl Row {
    /// Some rows further.
    fn next(self, by: usize) -> Row {
        match self {
            Row::Zero => Row::Zero,
            Row::Above(k) => Row::Above(k + by),
            Row::Cone(k) => Row::Cone(k + by),
        }
    }
}

struct Ended {
    status: SolverStatus,
    x: Vec<f64>,
    z: Split,
    cost: f64,
    iterations: u32,
}

impl Program {
    /// The velocities are its first unknowns.
    fn new(equations: &Equations) -> Self {
        Program {
            cost: vec![0.0; equations.rows],
            squares: Vec::new(),
            rows: Vec::new(),
            columns: Vec::new(),
            values: Vec::new(),
            zero: Vec::new(),
            above: Vec::new(),
            cones: 0,
        }
    }

    fn unknown(&mut self, cost: f64) -> usize {
        self.cost.push(cost);
        self.cost.len() - 1
    }

    fn zero(&mut self, right: f64) -> Row {
        self.zero.push(right);
        Row::Zero
    }

    fn above(&mut self, right: f64) -> Row {
        self.above.push(right);
        Row::Above(self.above.len() - 1)
    }

    fn cone(&mut self) -> Row {
        self.cones += 3;
        Row::Cone(self.cones - 3)
    }

    fn entry(&mut self, row: Row, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    fn sparse(&mut self, row: Row, column: &Column, factor: f64) {
        column.iter().for_each(|(unknown, v)| self.entry(row, *unknown, factor * v));
    }

    fn dense(&mut self, row: Row, values: &[f64]) {
        values.iter().enumerate().filter(|(_, v)| **v != 0.0).for_each(|(k, v)| self.entry(row, k, *v));
    }

    fn point(&mut self, point: &Point, law: Friction) -> Place {
        if law.cohesion > 0.0 {
            let bound = self.unknown(law.cohesion);
            let (above, row) = (self.above(0.0), self.cone());
            self.sparse(above, &point.normal, -1.0);
            if law.slope > 0.0 {
                self.entry(above, bound, law.slope);
            }
            self.entry(row, bound, -1.0);
            (0..2).for_each(|k| self.sparse(row.next(k + 1), &point.tangents[k], -1.0));
            Place::Cohesive(above, row)
        } else if law.slope > 0.0 {
            let row = self.cone();
            self.sparse(row, &point.normal, -1.0);
            (0..2).for_each(|k| self.sparse(row.next(k + 1), &point.tangents[k], -law.slope));
            Place::Rough(row)
        } else {
            let row = self.above(0.0);
            self.sparse(row, &point.normal, -1.0);
            Place::Smooth(row)
        }
    }

    fn near(&mut self, places: &[Place], near: &Near) {
        for (place, normal) in places.iter().zip(near.normal) {
            let overlap = self.unknown(*normal);
            self.entry(place.opens(), overlap, -1.0);
            self.squares.push((overlap, 1.0 / near.weight));
        }
    }

    /// What crushes, edge by edge; its unknowns α, β and γ.
    fn crush(&mut self, equations: &Equations, places: &[Place]) -> Vec<[usize; 3]> {
        let mut all = Vec::with_capacity(4 * equations.bears.len());
        for (bears, corners) in equations.bears.iter().zip(places.chunks(4)) {
            let root = bears.sqrt();
            for edge in EDGES {
                let unknowns = [root, -root, 0.0].map(|cost| self.unknown(cost));
                let cone = self.cone();
                unknowns.iter().enumerate().for_each(|(k, unknown)| self.entry(cone.next(k), *unknown, -1.0));
                for (k, corner) in corners.iter().enumerate() {
                    let row = corner.opens();
                    self.entry(row, unknowns[2], SQRT_2);
                    if edge.contains(&k) {
                        self.entry(row, unknowns[0], root);
                        self.entry(row, unknowns[1], root);
                    }
                }
                all.push(unknowns);
            }
        }
        all
    }

    /// What a pull gives way by costs its force; the row of what it is pulled by.
    fn pull(&mut self, pull: &Pull) -> Row {
        let stretch = self.unknown(pull.most);
        let (own, none) = (self.above(0.0), self.above(0.0));
        self.entry(own, stretch, -1.0);
        self.sparse(own, &pull.column, -1.0);
        self.entry(none, stretch, -1.0);
        own
    }

    /// # Errors
    /// An end without numbers.
    fn solve(self, tolerance: f64) -> Result<Ended, LimitError> {
        let unsolved = |what: String| LimitError::NotSolved(what);
        let (above, cones) = (self.zero.len(), self.zero.len() + self.above.len());
        let place = |row: &Row| match *row {
            Row::Zero => 0,
            Row::Above(k) => above + k,
            Row::Cone(k) => cones + k,
        };
        let (m, n) = (cones + self.cones, self.cost.len());
        let rows: Vec<usize> = self.rows.iter().map(place).collect();
        let matrix = CscMatrix::new_from_triplets(m, n, rows, self.columns, self.values);
        let right = [self.zero.clone(), self.above.clone(), vec![0.0; self.cones]].concat();
        let mut kinds = Vec::new();
        kinds.extend((above > 0).then_some(SupportedConeT::ZeroConeT(above)));
        kinds.extend((cones > above).then_some(SupportedConeT::NonnegativeConeT(cones - above)));
        kinds.extend((0..self.cones / 3).map(|_| SupportedConeT::SecondOrderConeT(3)));
        let (at, squares): (Vec<usize>, Vec<f64>) = self.squares.into_iter().unzip();
        let squares = CscMatrix::new_from_triplets(n, n, at.clone(), at, squares);
        let mut solver = DefaultSolver::new(&squares, &self.cost, &matrix, &right, &kinds, settings(tolerance))
            .map_err(|e| unsolved(e.to_string()))?;
        solver.solve();
        let ended = solver.solution;
        let infeasible = matches!(
            ended.status,
            SolverStatus::PrimalInfeasible
                | SolverStatus::AlmostPrimalInfeasible
                | SolverStatus::DualInfeasible
                | SolverStatus::AlmostDualInfeasible
        );
        if !infeasible && !ended.x.iter().chain(&ended.z).all(|v| v.is_finite()) {
            return Err(unsolved(format!("{:?}", ended.status)));
        }
        Ok(Ended {
            status: ended.status,
            x: ended.x,
            z: Split { values: ended.z, above, cones },
            cost: ended.obj_val,
            iterations: ended.iterations,
        })
    }
}
