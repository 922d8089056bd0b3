//! The linear program in the edges of the friction cones.
//!
//! N and T are sums over the edges (1, ±μ) with weights z ≥ 0, so that (L2) holds for any weights. A cohesion c adds a
//! tangential force between −c and c.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use crate::LimitError;
use crate::equations::{Column, Equations, power};

/// Friction of a contact point: |T| ≤ cohesion + slope N.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Friction {
    pub slope: f64,
    pub cohesion: f64,
}

/// An edge of a cone.
#[derive(Debug, Clone)]
pub(super) struct Edge {
    pub point: usize,
    /// Tangential force of a unit of normal force.
    pub slope: f64,
    pub column: Column,
}

/// Approximate solution of the program and its dual.
pub(super) struct Solution {
    pub edges: Vec<Edge>,
    /// Weight of every edge.
    pub weights: Vec<f64>,
    /// Power of every edge under the velocities: what the solver has for it, above 0.
    pub powers: Vec<f64>,
    /// Normal and tangential force of every point.
    pub forces: Vec<[f64; 2]>,
    /// Scaled λ.
    pub multiplier: f64,
    pub velocities: Vec<f64>,
}

/// What is aimed at; what is reached is certified afterwards.
const TOLERANCE: f64 = 1e-12;

pub(super) fn edges(equations: &Equations, slopes: impl Iterator<Item = f64>) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (point, slope) in slopes.enumerate() {
        let signs: &[f64] = if slope > 0.0 { &[1.0, -1.0] } else { &[0.0] };
        for slope in signs.iter().map(|sign| sign * slope) {
            edges.push(Edge { point, slope, column: edge(equations, point, slope) });
        }
    }
    edges
}

fn edge(equations: &Equations, point: usize, slope: f64) -> Column {
    let mut column = equations.normal[point].clone();
    for &(row, value) in equations.tangent[point].iter().filter(|_| slope != 0.0) {
        match column.iter_mut().find(|(r, _)| *r == row) {
            Some((_, v)) => *v += slope * value,
            None => column.push((row, slope * value)),
        }
    }
    column.sort_by_key(|(row, _)| *row);
    column
}

/// Maximises λ.
///
/// # Errors
/// No solution, or none that is made of numbers.
pub(super) fn solve(equations: &Equations, friction: &[Friction]) -> Result<Solution, LimitError> {
    let edges = edges(equations, friction.iter().map(|f| f.slope));
    let slides: Vec<usize> = (0..friction.len()).filter(|&k| friction[k].cohesion > 0.0).collect();
    let mut program = Sparse::new(equations.rows);
    for edge in &edges {
        let row = program.bound(0.0);
        program.column(edge.column.iter().copied().chain([(row, -1.0)]), 0.0);
    }
    for &k in &slides {
        let rows = [program.bound(friction[k].cohesion), program.bound(friction[k].cohesion)];
        program.column(equations.tangent[k].iter().copied().chain([(rows[0], 1.0), (rows[1], -1.0)]), 0.0);
    }
    program.column(entries(&equations.live), -1.0);
    let right = equations.dead.iter().map(|d| -d);
    let (status, x, z) = program.solve(right)?;
    if matches!(status, SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible) {
        return Err(LimitError::DoesNotStand);
    }
    if matches!(status, SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible) {
        return Err(LimitError::NotSolved("nothing limits the load".into()));
    }
    let mut forces = vec![[0.0; 2]; friction.len()];
    for (edge, weight) in edges.iter().zip(&x) {
        forces[edge.point][0] += weight;
        forces[edge.point][1] += edge.slope * weight;
    }
    for (&k, slide) in slides.iter().zip(&x[edges.len()..]) {
        forces[k][1] += slide;
    }
    let velocities = z[..equations.rows].to_vec();
    Ok(Solution {
        weights: x[..edges.len()].to_vec(),
        powers: z[equations.rows..equations.rows + edges.len()].to_vec(),
        forces,
        multiplier: x[x.len() - 1],
        velocities,
        edges,
    })
}

/// Whether forces balance the dead load alone, to 1e-6 of it.
///
/// # Errors
/// A program that was not solved.
pub(super) fn stands(equations: &Equations, friction: &[Friction]) -> Result<bool, LimitError> {
    // The least part of the dead load that has to be held by a hand.
    let mut program = Sparse::new(equations.rows);
    for edge in edges(equations, friction.iter().map(|f| f.slope)) {
        let row = program.bound(0.0);
        program.column(edge.column.into_iter().chain([(row, -1.0)]), 0.0);
    }
    let row = program.bound(0.0);
    program.column(entries(&equations.dead).map(|(r, d)| (r, -d)).chain([(row, -1.0)]), 1.0);
    let (_, x, _) = program.solve(equations.dead.iter().map(|d| -d))?;
    Ok(x[x.len() - 1] < 1e-6)
}

/// Velocities under which every edge has as much power as can be, 1 at least; none where there are no such velocities.
pub(super) fn opening(equations: &Equations, edges: &[Edge]) -> Result<Option<Vec<f64>>, LimitError> {
    // Blocks drift apart, upwards more than sideways: enough for courses with level beds.
    for ratio in [1.0, 4.0, 16.0, 64.0, 256.0] {
        let drift: Vec<f64> = equations.centres.iter().flat_map(|c| [c[0], ratio * c[1], 0.0]).collect();
        let least = edges.iter().map(|e| power(&e.column, &drift)).fold(f64::INFINITY, f64::min);
        if least > 1e-3 {
            return Ok(Some(drift.iter().map(|v| v / least).collect()));
        }
    }
    let mut program = Sparse::new(0);
    let mut columns: Vec<Column> = vec![Vec::new(); equations.rows];
    let rows: Vec<usize> = edges.iter().map(|_| program.bound(0.0)).collect();
    for (row, edge) in rows.iter().zip(edges) {
        edge.column.iter().for_each(|(v, value)| columns[*v].push((*row, -value)));
    }
    for column in columns {
        let ends = [program.bound(1.0), program.bound(1.0)];
        program.column(column.into_iter().chain([(ends[0], 1.0), (ends[1], -1.0)]), 0.0);
    }
    program.column(rows.iter().map(|row| (*row, 1.0)), -1.0);
    let (_, x, _) = program.solve(std::iter::empty())?;
    let least = edges.iter().map(|e| power(&e.column, &x)).fold(f64::INFINITY, f64::min);
    Ok((least > 1e-6).then(|| x[..equations.rows].iter().map(|v| v / least).collect()))
}

fn entries(dense: &[f64]) -> impl Iterator<Item = (usize, f64)> {
    dense.iter().copied().enumerate().filter(|(_, v)| *v != 0.0)
}

/// minimise q·x where the first rows of A x equal their right side and the others are at most theirs.
struct Sparse {
    equalities: usize,
    bounds: Vec<f64>,
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    cost: Vec<f64>,
}

impl Sparse {
    fn new(equalities: usize) -> Self {
        let (bounds, rows, values, cost) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Sparse { equalities, bounds, starts: vec![0], rows, values, cost }
    }

    /// Adds an inequality; its row.
    fn bound(&mut self, most: f64) -> usize {
        self.bounds.push(most);
        self.equalities + self.bounds.len() - 1
    }

    /// Adds an unknown; entries by ascending row.
    fn column(&mut self, entries: impl Iterator<Item = (usize, f64)>, cost: f64) {
        for (row, value) in entries {
            self.rows.push(row);
            self.values.push(value);
        }
        self.starts.push(self.rows.len());
        self.cost.push(cost);
    }

    /// Status, unknowns and multipliers of the rows.
    fn solve(self, right: impl Iterator<Item = f64>) -> Result<(SolverStatus, Vec<f64>, Vec<f64>), LimitError> {
        let unsolved = |what: String| LimitError::NotSolved(what);
        let (m, n) = (self.equalities + self.bounds.len(), self.cost.len());
        let matrix = CscMatrix::new(m, n, self.starts, self.rows, self.values);
        let right: Vec<f64> = right.chain(self.bounds.iter().copied()).collect();
        let zero = (self.equalities > 0).then_some(SupportedConeT::ZeroConeT(self.equalities));
        let cones: Vec<_> = zero.into_iter().chain([SupportedConeT::NonnegativeConeT(self.bounds.len())]).collect();
        let none = CscMatrix::zeros((n, n));
        let mut solver = DefaultSolver::new(&none, &self.cost, &matrix, &right, &cones, settings(TOLERANCE))
            .map_err(|e| unsolved(e.to_string()))?;
        solver.solve();
        let (status, x, z) = (solver.solution.status, solver.solution.x, solver.solution.z);
        if x.iter().chain(&z).all(|v| v.is_finite()) {
            Ok((status, x, z))
        } else {
            Err(unsolved(format!("{status:?}")))
        }
    }
}

/// How exactly programs are solved, on one thread.
pub(crate) fn settings(tolerance: f64) -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        tol_gap_abs: tolerance,
        tol_gap_rel: tolerance,
        tol_feas: tolerance,
        presolve_enable: false,
        max_threads: 1,
        direct_solve_method: "qdldl".into(),
        ..DefaultSettings::default()
    }
}
