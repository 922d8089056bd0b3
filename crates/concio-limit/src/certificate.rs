//! Bounds that hold whatever the solver says of its solution.
//!
//! An interior point method stops near the optimum, with forces slightly out of balance and a mechanism in which points
//! overlap slightly. Which edges of cones carry force and which open is known there, and the nearest forces in
//! balance on the first, the nearest velocities under which these neither open nor overlap, are least-squares problems,
//! exact to rounding. Where degeneracy spoils the choice of edges the solution as it came is used. Of both, the better:
//!
//! - Lower: weights below 0 are cut off. What then is out of balance, r, can have raised λ by |r|·|v| of the mechanism,
//!   because λ is concave in the dead load and v its gradient; twice that is taken off.
//! - Upper: where a point overlaps by as much as δ, δ times velocities under which every point opens by 1 are added.
//!   (L4) then holds, and any velocities that obey it and (L5) bound λ.

use clarabel::algebra::CscMatrix;
use clarabel::qdldl::{QDLDLFactorisation, QDLDLSettings};

use crate::LimitError;
use crate::equations::{Column, Equations, dot, power};
use crate::program::{Edge, Solution, edges, opening};

/// Forces and the multiplier that they prove.
pub(super) struct Lower {
    /// Scaled λ.
    pub multiplier: f64,
    /// Normal and tangential force of every point.
    pub forces: Vec<[f64; 2]>,
    /// Largest residual of a force balance.
    pub unbalanced: f64,
}

/// Velocities and the multiplier that they prove.
pub(super) struct Upper {
    /// Scaled λ.
    pub multiplier: f64,
    pub velocities: Vec<f64>,
}

/// Edges carry force where their weight is more than this many times their power.
const SPLITS: [f64; 3] = [1.0, 1e-3, 1e3];
/// Rounds of refinement of a least-squares problem.
const ROUNDS: usize = 12;
/// Regularisation of its factors, which refinement takes out again.
const REGULAR: f64 = 1e-9;

pub(super) fn lower(equations: &Equations, friction: &[f64], solution: &Solution) -> Lower {
    let polished = SPLITS.iter().filter_map(|split| balanced(equations, solution, *split));
    let candidates = polished.chain([(solution.weights.clone(), solution.multiplier)]);
    let proven =
        candidates.map(|(weights, multiplier)| prove_lower(equations, friction, solution, &weights, multiplier));
    let best = proven.reduce(|a, b| if b.multiplier > a.multiplier { b } else { a });
    best.unwrap_or(Lower { multiplier: f64::NEG_INFINITY, forces: Vec::new(), unbalanced: f64::INFINITY })
}

fn prove_lower(
    equations: &Equations,
    friction: &[f64],
    solution: &Solution,
    weights: &[f64],
    multiplier: f64,
) -> Lower {
    let mut forces = vec![[0.0f64; 2]; friction.len()];
    for (edge, weight) in solution.edges.iter().zip(weights) {
        forces[edge.point][0] += weight.max(0.0);
        forces[edge.point][1] += edge.slope * weight.max(0.0);
    }
    for (force, mu) in forces.iter_mut().zip(friction) {
        let most = mu * force[0];
        force[1] = force[1].clamp(-most, most);
    }
    let residual = equations.residual(&forces, multiplier);
    let raised: f64 = residual.iter().zip(&solution.velocities).map(|(r, v)| r.abs() * v.abs()).sum();
    let of_forces = residual.iter().enumerate().filter(|(row, _)| row % 3 < 2).map(|(_, r)| r.abs());
    Lower { multiplier: multiplier - 2.0 * raised, forces, unbalanced: of_forces.fold(0.0, f64::max) }
}

/// The nearest weights in balance on the edges that carry force, distances taken relative to the weights.
fn balanced(equations: &Equations, solution: &Solution, split: f64) -> Option<(Vec<f64>, f64)> {
    let carries = carrying(solution, split);
    let mut forces = vec![[0.0; 2]; equations.normal.len()];
    for &e in &carries {
        let (edge, weight) = (&solution.edges[e], solution.weights[e]);
        forces[edge.point][0] += weight;
        forces[edge.point][1] += edge.slope * weight;
    }
    let residual = equations.residual(&forces, solution.multiplier);
    let mut rows: Vec<Column> = vec![Vec::new(); equations.rows];
    for (k, &e) in carries.iter().enumerate() {
        let scale = solution.weights[e];
        solution.edges[e].column.iter().for_each(|(row, v)| rows[*row].push((k, v * scale)));
    }
    for (row, live) in equations.live.iter().enumerate().filter(|(_, f)| **f != 0.0) {
        rows[row].push((carries.len(), *live));
    }
    let right: Vec<f64> = residual.iter().map(|r| -r).collect();
    let change = least_change(&rows, carries.len() + 1, &right)?;
    let mut weights = vec![0.0; solution.weights.len()];
    for (&e, change) in carries.iter().zip(&change) {
        weights[e] = solution.weights[e] * (1.0 + change);
    }
    Some((weights, solution.multiplier + change[carries.len()]))
}

fn carrying(solution: &Solution, split: f64) -> Vec<usize> {
    (0..solution.edges.len()).filter(|&e| solution.weights[e] > (split * solution.powers[e]).max(1e-13)).collect()
}

/// # Errors
/// Velocities that do not move the live load.
pub(super) fn upper(equations: &Equations, friction: &[f64], solution: &Solution) -> Result<Upper, LimitError> {
    let edges = edges(equations, friction.iter().copied());
    let apart = opening(equations, &edges)?;
    let polished = SPLITS.iter().filter_map(|split| unopened(equations, solution, *split));
    let candidates = polished.chain([solution.velocities.clone()]);
    let proven = candidates.filter_map(|v| prove_upper(equations, &edges, apart.as_deref(), v));
    let best = proven.reduce(|a, b| if b.multiplier < a.multiplier { b } else { a });
    best.ok_or_else(|| LimitError::NotSolved("no mechanism obeys the flow rule".into()))
}

fn prove_upper(
    equations: &Equations,
    edges: &[Edge],
    apart: Option<&[f64]>,
    mut velocities: Vec<f64>,
) -> Option<Upper> {
    let least = |v: &[f64]| edges.iter().map(|e| power(&e.column, v)).fold(f64::INFINITY, f64::min);
    let overlap = (-least(&velocities)).max(0.0);
    if overlap > 0.0 {
        velocities.iter_mut().zip(apart?).for_each(|(v, a)| *v += overlap * a);
    }
    let moved = dot(&equations.live, &velocities);
    if !(moved > 0.0) {
        return None;
    }
    velocities.iter_mut().for_each(|v| *v /= moved);
    Some(Upper { multiplier: -dot(&equations.dead, &velocities), velocities })
}

/// The nearest velocities under which the edges that carry force have no power, and the live load that of (L5).
fn unopened(equations: &Equations, solution: &Solution, split: f64) -> Option<Vec<f64>> {
    let carries = carrying(solution, split);
    let mut rows: Vec<Column> = carries.iter().map(|&e| solution.edges[e].column.clone()).collect();
    rows.push(equations.live.iter().copied().enumerate().filter(|(_, f)| *f != 0.0).collect());
    let mut right: Vec<f64> = rows.iter().map(|row| -power(row, &solution.velocities)).collect();
    right[carries.len()] += 1.0;
    let change = least_change(&rows, equations.rows, &right)?;
    Some(solution.velocities.iter().zip(&change).map(|(v, c)| v + c).collect())
}

/// The shortest x with rows · x = right, `rows` by ascending column. Rows may depend on each other.
pub(crate) fn least_change(rows: &[Column], unknowns: usize, right: &[f64]) -> Option<Vec<f64>> {
    // Upper triangle of (1, Aᵀ; A, −ε).
    let size = unknowns + rows.len();
    let (mut starts, mut places, mut values): (Vec<usize>, Vec<usize>, Vec<f64>) =
        ((0..=unknowns).collect(), (0..unknowns).collect(), vec![1.0; unknowns]);
    for (k, row) in rows.iter().enumerate() {
        places.extend(row.iter().map(|(j, _)| *j).chain([unknowns + k]));
        values.extend(row.iter().map(|(_, v)| *v).chain([-REGULAR]));
        starts.push(places.len());
    }
    let matrix = CscMatrix::new(size, size, starts, places, values);
    let settings = QDLDLSettings { regularize_enable: false, ..QDLDLSettings::default() };
    let mut factors = QDLDLFactorisation::<f64>::new(&matrix, Some(settings)).ok()?;
    let mut solution = vec![0.0; size];
    for _ in 0..ROUNDS {
        let (x, p) = solution.split_at(unknowns);
        let mut step: Vec<f64> = x.iter().map(|x| -x).chain(right.iter().copied()).collect();
        for (k, row) in rows.iter().enumerate() {
            for (j, v) in row {
                step[*j] -= v * p[k];
                step[unknowns + k] -= v * x[*j];
            }
        }
        factors.solve(&mut step);
        solution.iter_mut().zip(&step).for_each(|(s, d)| *s += d);
    }
    solution.truncate(unknowns);
    solution.iter().all(|v| v.is_finite()).then_some(solution)
}
