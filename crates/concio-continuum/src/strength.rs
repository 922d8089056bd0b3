//! The stresses that a bond bears: planes in closed form, and the linear program of the forces in a cell.
//!
//! Running bond of overlap ½ whose bricks touch all along, one Coulomb law |τ| ≤ c − μ σ in all joints, m = 2a/b, μ ≤ 1:
//!
//! (H5) |σ12| + μ σ22 ≤ c
//! (H6) m σ11 + μ σ22 + (1 + m μ) |σ12| ≤ c (1 + m/μ)
//! (H7) m μ σ11 + σ22 + (m + μ) |σ12| ≤ c (m + 1/μ)
//!
//! Beds slide, a stepped crack opens, bricks turn while heads slide. (H7) binds only where m μ > 1. Friction is associative:
//! what slides also dilates, which makes the domain one from outside of that of real joints. By the kinematic route
//! P. de Buhan and G. de Felice first gave such a domain: Journal of the Mechanics and Physics of Solids 45 (1997) 1085.
//!
//! The program takes any cell and any [`Strength`]. A joint bears A (f_t, ±(c − μ f_t)) less what presses at its ends, which
//! is all that pressure of any distribution along it can bring; with a finite f_c it is cut into strips of uniform stress,
//! from inside.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use crate::ContinuumError;
use crate::cell::Cell;
use crate::joint::Strength;
use crate::polar;
use crate::running::RunningBond;

/// A bound a·(σ11, σ22, σ12) ≤ b.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Plane {
    /// a, without unit; the largest of its numbers is 1.
    pub a: [f64; 3],
    /// b in Pa.
    pub b: f64,
}

impl Plane {
    fn scaled(a: [f64; 3], b: f64) -> Plane {
        let most = a.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        Plane { a: a.map(|v| v / most), b: b / most }
    }

    /// a·σ − b in Pa: above 0 outside.
    pub fn excess(&self, stress: [f64; 3]) -> f64 {
        (0..3).map(|i| self.a[i] * stress[i]).sum::<f64>() - self.b
    }
}

/// Whether (H5) to (H7) are those of a bond: its bricks touch all along, bed and head joints have one Coulomb law up to its apex
/// with 0 < μ ≤ 1, and bear any pressure.
pub fn holds(bond: &RunningBond, bed: Strength, head: Strength) -> bool {
    let apex = bed.cohesion == 0.0 || bed.tension >= bed.cohesion / bed.friction * (1.0 - 1e-12);
    bond.is_closed()
        && bed == head
        && bed.friction > 0.0
        && bed.friction <= 1.0
        && apex
        && bed.compression.is_infinite()
}

/// (H5) to (H7), each for both signs of σ12; (H7) where it binds. For bonds that [`holds`] says yes to.
pub fn planes(bond: &RunningBond, law: Strength) -> Vec<Plane> {
    let (c, mu, m) = (law.cohesion, law.friction, 2.0 * bond.rise / bond.pitch);
    let mut rows = vec![([0.0, mu, 1.0], c), ([m, mu, 1.0 + m * mu], c * (1.0 + m / mu))];
    if m * mu > 1.0 {
        rows.push(([m * mu, 1.0, m + mu], c * (m + 1.0 / mu)));
    }
    let both = |(a, b): ([f64; 3], f64)| [Plane::scaled(a, b), Plane::scaled([a[0], a[1], -a[2]], b)];
    rows.into_iter().flat_map(both).collect()
}

/// How far a straight way of stress goes until a plane of the list stops it [multiples of `direction`]; infinite where none does.
pub fn cut(planes: &[Plane], from: [f64; 3], direction: [f64; 3]) -> f64 {
    let way = |plane: &Plane| {
        let speed = plane.a.iter().zip(direction).map(|(a, d)| a * d).sum::<f64>();
        if speed > 0.0 { -plane.excess(from) / speed } else { f64::INFINITY }
    };
    planes.iter().map(way).fold(f64::INFINITY, f64::min)
}

/// How far the stress of a cell goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Multiple of the direction, from 0.
    pub multiplier: f64,
    /// The plane that stops it: the dual of the program.
    pub plane: Plane,
}

/// The planes of a domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Planes {
    /// The planes.
    pub planes: Vec<Plane>,
    /// 0 where all corners between them were verified: none is missing. Else they reach at most this part further than the wall
    /// does, from a stress inside; infinite where they have no end and the wall may have one.
    pub excess: f64,
}

/// A domain seen from a stress inside.
struct View {
    centre: [f64; 3],
    /// Along each axis [Pa]; 0 where the domain is flat.
    size: [f64; 3],
}

impl View {
    /// The bound y·u ≤ 1 in stresses. What is below a ten-millionth is rounding.
    fn plane(&self, y: [f64; 3], unit: f64) -> Plane {
        let is_flat = (0..3).any(|k| self.size[k] == 0.0 && y[k] != 0.0);
        let a: [f64; 3] = std::array::from_fn(|k| if self.size[k] > 0.0 { y[k] / self.size[k] } else { y[k] / unit });
        let at: f64 = (0..3).map(|k| a[k] * self.centre[k]).sum();
        let plane = Plane::scaled(a, if is_flat { at } else { 1.0 + at });
        let clean = |v: f64, size: f64| if v.abs() < 1e-7 * size { 0.0 } else { v };
        Plane { a: plane.a.map(|v| clean(v, 1.0)), b: clean(plane.b, unit) }
    }
}

/// Directions in which the search begins.
const SEEDS: usize = 26;
/// Times that the domain is measured before the search begins, each time from its middle as it was measured last.
const PASSES: usize = 4;
/// How far planes may reach over the wall where they are verified.
const VERIFIED: f64 = 1e-6;
/// Strips of a joint that can crush.
const STRIPS: usize = 8;
/// What the program is solved to.
const TOLERANCE: f64 = 1e-11;

/// The strength domain of a cell.
#[derive(Debug, Clone)]
pub struct Domain<'c> {
    cell: &'c Cell,
    /// Law of every joint; none where nothing is in it.
    laws: Vec<Option<Strength>>,
}

impl<'c> Domain<'c> {
    /// Of a cell, whose level joints have the law `bed` and whose others `head`; none is a joint with nothing in it.
    pub fn new(cell: &'c Cell, bed: Option<Strength>, head: Option<Strength>) -> Domain<'c> {
        let law = |c: &crate::Contact| if c.normal[1].abs() >= c.normal[0].abs() { bed } else { head };
        Domain { laws: cell.contacts.iter().map(law).collect(), cell }
    }

    /// Goes from a stress that the wall bears in a direction until it does not; none where nothing stops it.
    ///
    /// # Errors
    /// A stress to begin with that the wall does not bear, a program that was not solved.
    pub fn reach(&self, from: [f64; 3], direction: [f64; 3]) -> Result<Option<Reach>, ContinuumError> {
        let unit = self.unit(from);
        let size = direction.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let program = self.program(from.map(|s| s / unit), direction.map(|s| s / size), unit);
        let Some((multiplier, stresses)) = program.solve()? else { return Ok(None) };
        let speed: f64 = (0..3).map(|i| stresses[i] * direction[i] / size).sum();
        let a = stresses.map(|v| v / speed);
        let multiplier = multiplier * unit / size;
        let at: [f64; 3] = std::array::from_fn(|i| from[i] + multiplier * direction[i]);
        let b = (0..3).map(|i| a[i] * at[i]).sum();
        Ok(Some(Reach { multiplier, plane: Plane::scaled(a, b) }))
    }

    /// The planes that bound the domain, found from a stress that the wall bears.
    ///
    /// Each corner of the domain that the planes found so far have is asked by a program of its own whether the wall bears it; a
    /// plane that cuts it off is one more. The search ends where all corners are borne, or after some `programs`.
    ///
    /// # Errors
    /// As [`Domain::reach`].
    pub fn planes(&self, inside: [f64; 3], programs: usize) -> Result<Planes, ContinuumError> {
        let unit = self.unit(inside);
        let view = self.view(inside, unit)?;
        let flat = (0..3)
            .filter(|k| view.size[*k] == 0.0)
            .flat_map(|k| [1.0, -1.0].map(|sign| std::array::from_fn(|i| if i == k { sign } else { 0.0 })));
        let mut found: Vec<[f64; 3]> = flat.collect();
        let (mut asked, mut excess): (Vec<([f64; 3], f64)>, f64);
        asked = Vec::new();
        for direction in sphere(SEEDS) {
            let (_, y) = self.bound(&view, direction, unit)?;
            found.push(y);
        }
        loop {
            found = polar::corners(&found);
            let sides = polar::facets(&found);
            excess = if sides.is_empty() { f64::INFINITY } else { 0.0 };
            let mut more = Vec::new();
            for side in sides {
                let like = |d: &[f64; 3]| (0..3).all(|k| (d[k] - side.normal[k]).abs() < 1e-7);
                let known = asked.iter().find(|(d, _)| like(d)).map(|(_, most)| *most);
                let most = match known {
                    Some(most) => most,
                    None => {
                        let (most, y) = self.bound(&view, side.normal, unit)?;
                        asked.push((side.normal, most));
                        if most > side.offset * (1.0 + VERIFIED) + VERIFIED {
                            more.push(y);
                        }
                        most
                    }
                };
                if most > side.offset * (1.0 + VERIFIED) + VERIFIED {
                    let ends = side.offset > VERIFIED;
                    excess = excess.max(if ends { most / side.offset - 1.0 } else { f64::INFINITY });
                }
            }
            let ends = more.is_empty() || asked.len() >= programs;
            found.extend(more);
            if ends {
                break;
            }
        }
        found = polar::corners(&found);
        let mut planes: Vec<Plane> = found.iter().map(|y| view.plane(*y, unit)).collect();
        planes.sort_by(|p, q| q.a.partial_cmp(&p.a).unwrap_or(std::cmp::Ordering::Equal));
        Ok(Planes { planes, excess })
    }

    /// A stress well inside the domain, and how far the domain goes from there along each axis, at most one `unit`.
    fn view(&self, inside: [f64; 3], unit: f64) -> Result<View, ContinuumError> {
        let mut view = View { centre: inside, size: [0.0; 3] };
        let mut next = inside;
        for pass in 0..PASSES {
            let ends = match self.ends(next, unit) {
                // On the bound of a domain, by rounding.
                Err(ContinuumError::Outside) if pass > 0 => break,
                ends => ends?,
            };
            let size = ends.map(|[up, down]| if up + down > 1e-6 * unit { 0.5 * (up + down) } else { 0.0 });
            view = View { centre: next, size };
            // The mean of all ends: each of them is borne, and so is that.
            (0..3).for_each(|k| next[k] += (ends[k][0] - ends[k][1]) / 6.0);
        }
        Ok(view)
    }

    /// How far the domain goes up and down along each axis, at most one `unit`.
    fn ends(&self, from: [f64; 3], unit: f64) -> Result<[[f64; 2]; 3], ContinuumError> {
        let mut ends = [[0.0; 2]; 3];
        for (k, pair) in ends.iter_mut().enumerate() {
            for (end, sign) in pair.iter_mut().zip([1.0, -1.0]) {
                let way = std::array::from_fn(|i| if i == k { sign } else { 0.0 });
                *end = self.reach(from, way)?.map_or(unit, |r| r.multiplier.min(unit));
            }
        }
        Ok(ends)
    }

    /// The bound y·u ≤ 1 that stops a way from the centre of a view, u in its sizes, and y·direction; 0 where nothing stops it.
    fn bound(&self, view: &View, direction: [f64; 3], unit: f64) -> Result<(f64, [f64; 3]), ContinuumError> {
        let flat =
            (0..3).filter(|k| view.size[*k] == 0.0).max_by(|i, j| direction[*i].abs().total_cmp(&direction[*j].abs()));
        let way = std::array::from_fn(|k| view.size[k] / unit * direction[k]);
        let mut found = (0.0, [0.0; 3]);
        if way.iter().any(|v: &f64| v.abs() > 1e-9) {
            let program = self.program(view.centre.map(|s| s / unit), way, unit);
            let (most, stresses) = program.gauge()?;
            found = (most, std::array::from_fn(|k| stresses[k] * view.size[k] / unit));
        }
        match flat {
            Some(k) if direction[k].abs() > found.0 => {
                Ok((direction[k].abs(), std::array::from_fn(|i| if i == k { direction[k].signum() } else { 0.0 })))
            }
            _ => Ok(found),
        }
    }

    /// A stress of the size of those in question in Pa.
    fn unit(&self, from: [f64; 3]) -> f64 {
        let laws = self.laws.iter().flatten();
        let own = laws.map(|l| l.cohesion.max(l.reached_tension())).fold(0.0, f64::max);
        let most = from.iter().fold(own, |most: f64, v| most.max(v.abs()));
        if most > 0.0 { most } else { 1.0 }
    }

    /// Forces over the stress `unit` times a length of the cell.
    fn program(&self, from: [f64; 3], direction: [f64; 3], unit: f64) -> Program {
        let length = self.cell.area.sqrt();
        let bricks = self.cell.bricks.len();
        // Balance of every brick, then N11, N22, N12.
        let mut program = Program::new(3 * bricks + 3);
        let stress = 3 * bricks;
        let moment = |r: [f64; 2], f: [f64; 2]| (r[0] * f[1] - r[1] * f[0]) / length;
        let columns = |contact: &crate::Contact, p: [f64; 2], force: [f64; 2]| {
            let d = contact.apart;
            let mut rows = vec![0.0; 3 * bricks + 3];
            let from_b = [p[0] - d[0], p[1] - d[1]];
            for (brick, sign, r) in [(contact.a, 1.0, p), (contact.b, -1.0, from_b)] {
                rows[3 * brick] += sign * force[0];
                rows[3 * brick + 1] += sign * force[1];
                rows[3 * brick + 2] += sign * moment(r, force);
            }
            let scale = length / self.cell.area;
            rows[stress] += force[0] * d[0] * scale;
            rows[stress + 1] += force[1] * d[1] * scale;
            rows[stress + 2] += 0.5 * (force[0] * d[1] + force[1] * d[0]) * scale;
            rows
        };
        for (contact, law) in self.cell.contacts.iter().zip(&self.laws) {
            let Some(law) = law else { continue };
            let (n, t) = (contact.normal, contact.tangent());
            let share = contact.length / length;
            let tension = law.reached_tension() / unit;
            let cohesion = (law.cohesion / unit - law.friction * tension).max(0.0);
            program.given(columns(contact, contact.middle, n.map(|v| v * share * tension)));
            if cohesion > 0.0 {
                let column = columns(contact, contact.middle, t.map(|v| v * share * cohesion));
                program.free(column, &[(1.0, 1.0), (-1.0, 1.0)]);
            }
            let crushes = law.compression.is_finite();
            let places: Vec<f64> = match crushes {
                true => (0..STRIPS).map(|s| (s as f64 + 0.5) / STRIPS as f64 - 0.5).collect(),
                false => vec![-0.5, 0.5],
            };
            for place in places {
                let p = [0, 1].map(|k| contact.middle[k] + place * contact.length * t[k]);
                let signs: &[f64] = if law.friction > 0.0 { &[1.0, -1.0] } else { &[0.0] };
                let cap = crushes
                    .then(|| program.bound((law.compression + law.reached_tension()) / unit * share / STRIPS as f64));
                for sign in signs {
                    let edge = [0, 1].map(|k| -n[k] + sign * law.friction * t[k]);
                    program.pressed(columns(contact, p, edge), cap);
                }
            }
        }
        let mut goal = vec![0.0; 3 * bricks + 3];
        (0..3).for_each(|i| goal[stress + i] = -direction[i]);
        program.goal(goal);
        let mut right = vec![0.0; 3 * bricks + 3];
        (0..3).for_each(|i| right[stress + i] = from[i]);
        program.right(&right);
        program
    }
}

/// Directions spread over a sphere (Fibonacci's spiral).
fn sphere(number: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..number).map(move |k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / number as f64;
        let (angle, r) = (k as f64 * std::f64::consts::PI * (3.0 - 5f64.sqrt()), (1.0 - z * z).sqrt());
        [r * angle.cos(), r * angle.sin(), z]
    })
}

/// Maximise the last unknown where sums of columns balance, some unknowns bounded.
struct Program {
    equalities: usize,
    columns: Vec<Vec<f64>>,
    /// (column, factor, row) of the inequalities.
    inequalities: Vec<(usize, f64, usize)>,
    bounds: Vec<f64>,
    right: Vec<f64>,
}

impl Program {
    fn new(equalities: usize) -> Program {
        let right = vec![0.0; equalities];
        Program { equalities, columns: Vec::new(), inequalities: Vec::new(), bounds: Vec::new(), right }
    }

    fn bound(&mut self, most: f64) -> usize {
        self.bounds.push(most);
        self.bounds.len() - 1
    }

    /// A force that is there.
    fn given(&mut self, column: Vec<f64>) {
        self.right.iter_mut().zip(column).for_each(|(r, c)| *r -= c);
    }

    /// An unknown x with factor × x ≤ most for each pair.
    fn free(&mut self, column: Vec<f64>, bounds: &[(f64, f64)]) {
        for (factor, most) in bounds {
            let row = self.bound(*most);
            self.inequalities.push((self.columns.len(), *factor, row));
        }
        self.columns.push(column);
    }

    /// An unknown from 0, which counts to a bound with others.
    fn pressed(&mut self, column: Vec<f64>, cap: Option<usize>) {
        let row = self.bound(0.0);
        self.inequalities.push((self.columns.len(), -1.0, row));
        if let Some(row) = cap {
            self.inequalities.push((self.columns.len(), 1.0, row));
        }
        self.columns.push(column);
    }

    fn goal(&mut self, column: Vec<f64>) {
        self.columns.push(column);
    }

    fn right(&mut self, add: &[f64]) {
        self.right.iter_mut().zip(add).for_each(|(r, a)| *r += a);
    }

    /// The least s at which s times the domain, seen from the stress to begin with, reaches as far as the goal does at 1; and the
    /// duals, whose product with the goal is s. It always has an end, also where the goal has none: there s is 0.
    fn gauge(mut self) -> Result<(f64, [f64; 3]), ContinuumError> {
        let goal = self.columns.pop().unwrap_or_default();
        let own = self.columns.len();
        let given = std::mem::replace(&mut self.right, goal.iter().map(|v| -v).collect());
        let bounds = std::mem::take(&mut self.bounds);
        self.inequalities.extend(bounds.iter().enumerate().filter(|(_, b)| **b != 0.0).map(|(row, b)| (own, -b, row)));
        self.bounds = vec![0.0; bounds.len()];
        self.pressed(given.iter().map(|v| -v).collect(), None);
        self.solve_for(1.0)?.ok_or_else(|| ContinuumError::NotSolved("a gauge without an end".into()))
    }

    /// The largest multiplier and the duals of the last three equations; none where it has no bound.
    fn solve(self) -> Result<Option<(f64, [f64; 3])>, ContinuumError> {
        self.solve_for(-1.0)
    }

    /// The least `sense` times the last unknown.
    fn solve_for(self, sense: f64) -> Result<Option<(f64, [f64; 3])>, ContinuumError> {
        let (n, m) = (self.columns.len(), self.equalities + self.bounds.len());
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for (k, column) in self.columns.iter().enumerate() {
            for (row, value) in column.iter().enumerate().filter(|(_, v)| **v != 0.0) {
                rows.push(row);
                values.push(*value);
            }
            let mut own: Vec<(usize, f64)> =
                self.inequalities.iter().filter(|i| i.0 == k).map(|i| (self.equalities + i.2, i.1)).collect();
            own.sort_by_key(|(row, _)| *row);
            for (row, value) in own {
                rows.push(row);
                values.push(value);
            }
            starts.push(rows.len());
        }
        let matrix = CscMatrix::new(m, n, starts, rows, values);
        let right: Vec<f64> = self.right.iter().chain(&self.bounds).copied().collect();
        let mut cost = vec![0.0; n];
        cost[n - 1] = sense;
        let cones = [SupportedConeT::ZeroConeT(self.equalities), SupportedConeT::NonnegativeConeT(self.bounds.len())];
        let settings = DefaultSettings::<f64> {
            verbose: false,
            tol_gap_abs: TOLERANCE,
            tol_gap_rel: TOLERANCE,
            tol_feas: TOLERANCE,
            presolve_enable: false,
            max_threads: 1,
            direct_solve_method: "qdldl".into(),
            ..DefaultSettings::default()
        };
        let unsolved = |what: String| ContinuumError::NotSolved(what);
        let none = CscMatrix::zeros((n, n));
        let mut solver =
            DefaultSolver::new(&none, &cost, &matrix, &right, &cones, settings).map_err(|e| unsolved(e.to_string()))?;
        solver.solve();
        let (x, z) = (&solver.solution.x, &solver.solution.z);
        match solver.solution.status {
            SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => return Ok(None),
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
                return Err(ContinuumError::Outside);
            }
            SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress => {}
            other => return Err(unsolved(format!("{other:?}"))),
        }
        let at = self.equalities - 3;
        let (multiplier, duals) = (x[n - 1], [z[at], z[at + 1], z[at + 2]]);
        if multiplier.is_finite() && duals.iter().all(|v| v.is_finite()) && multiplier > -1e-7 {
            // What the solver says of itself is not relied on: forces that balance to less than this are no solution.
            let mut off = self.right.clone();
            for (column, x) in self.columns.iter().zip(x) {
                off.iter_mut().zip(column).for_each(|(o, c)| *o -= c * x);
            }
            let worst = off.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
            if worst > 1e-7 * (1.0 + multiplier) {
                return Err(unsolved(format!("forces are out of balance by {worst:.1e}")));
            }
            // The duals are those of right sides that lessen the multiplier.
            return Ok(Some((multiplier.max(0.0), duals.map(|v| -v))));
        }
        Err(if multiplier.is_finite() { ContinuumError::Outside } else { unsolved("not finite".into()) })
    }
}
