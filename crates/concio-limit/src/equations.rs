//! (L1) as sparse columns, free of dimensions: forces over the mean dead load, lengths over the mean size of a block.

use crate::Problem;
use crate::assembly::{ContactPoint, Other};

/// Entries of a sparse column: row and value.
pub(crate) type Column = Vec<(usize, f64)>;

/// Three rows for each body: force along x, along y, moment about its centre.
pub(super) struct Equations {
    /// Number of rows.
    pub rows: usize,
    /// A unit of normal force of each contact point.
    pub normal: Vec<Column>,
    /// A unit of tangential force of each contact point.
    pub tangent: Vec<Column>,
    /// The live load, its magnitudes summing to 1: velocities of the mechanism are then near 1.
    pub live: Vec<f64>,
    /// The dead load.
    pub dead: Vec<f64>,
    /// Unit of force [N].
    pub force: f64,
    /// Unit of length [m].
    pub length: f64,
    /// Centres of the bodies, over the unit of length.
    pub centres: Vec<[f64; 2]>,
    total: f64,
}

impl Equations {
    pub fn of(problem: &Problem) -> Self {
        let bodies = &problem.assembly.bodies;
        let count = bodies.len().max(1) as f64;
        let magnitude = |f: &[f64; 2]| f[0].hypot(f[1]);
        let force = problem.dead.iter().map(magnitude).sum::<f64>() / count;
        let size = |corners: &[[f64; 2]]| corners.iter().map(magnitude).fold(0.0, f64::max);
        let length = bodies.iter().map(|b| size(&b.corners)).sum::<f64>() / count;
        let total = problem.live.iter().map(magnitude).sum::<f64>() / force;
        let column = |point: &ContactPoint, direction: [f64; 2]| {
            let side = |body: usize, sign: f64| {
                let f = direction.map(|d| sign * d);
                let centre = bodies[body].centre;
                let arm = [0, 1].map(|k| (point.at[k] - centre[k]) / length);
                [(3 * body, f[0]), (3 * body + 1, f[1]), (3 * body + 2, arm[0] * f[1] - arm[1] * f[0])]
            };
            let mut column: Column = side(point.a, -1.0).to_vec();
            if let Other::Body(b) = point.b {
                column.extend(side(b, 1.0));
            }
            // What keeps its turn has no balance of moments.
            let turns = problem.level.map_or(usize::MAX, |body| 3 * body + 2);
            column.retain(|(row, v)| *v != 0.0 && *row != turns);
            column.sort_by_key(|(row, _)| *row);
            column
        };
        let rows = |loads: &[[f64; 2]], unit: f64| loads.iter().flat_map(|f| [f[0] / unit, f[1] / unit, 0.0]).collect();
        let points = &problem.assembly.points;
        Equations {
            rows: 3 * bodies.len(),
            normal: points.iter().map(|p| column(p, p.normal)).collect(),
            tangent: points.iter().map(|p| column(p, p.tangent())).collect(),
            live: rows(&problem.live, force * total),
            dead: rows(&problem.dead, force),
            force,
            length,
            centres: bodies.iter().map(|b| b.centre.map(|x| x / length)).collect(),
            total,
        }
    }

    /// λ of the scaled multiplier.
    pub fn multiplier(&self, scaled: f64) -> f64 {
        scaled / self.total
    }

    /// Opening and slip of every point under velocities, (L3).
    pub fn rates(&self, velocities: &[f64]) -> Vec<[f64; 2]> {
        let columns = self.normal.iter().zip(&self.tangent);
        columns.map(|(n, t)| [power(n, velocities), power(t, velocities)]).collect()
    }

    /// What is out of balance under forces of the points and the scaled multiplier, (L1).
    pub fn residual(&self, forces: &[[f64; 2]], multiplier: f64) -> Vec<f64> {
        let mut sum: Vec<f64> = self.live.iter().zip(&self.dead).map(|(f, d)| multiplier * f + d).collect();
        for ((normal, tangent), force) in self.normal.iter().zip(&self.tangent).zip(forces) {
            normal.iter().for_each(|(row, v)| sum[*row] += v * force[0]);
            tangent.iter().for_each(|(row, v)| sum[*row] += v * force[1]);
        }
        sum
    }
}

/// Power of a column's forces under velocities.
pub(crate) fn power(column: &[(usize, f64)], velocities: &[f64]) -> f64 {
    column.iter().map(|(row, v)| v * velocities[*row]).sum()
}

/// Inner product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
