//! Limit analysis in space: blocks with six unknowns, and friction in all directions of a joint.
//!
//! At each corner of a rectangle in which blocks touch, with normal n and tangents t₁, t₂, the sides press with N and rub with
//! (T₁, T₂). Equilibrium of every block under its dead load D, λ times its live load F and ties of force Y at most:
//!
//! (S1) Σ Eᵏ (N, T₁, T₂)ₖ + Σ Eᵗ Pₜ + λ F + D = 0, (S2) N ≥ 0, √(T₁² + T₂²) ≤ μ N, 0 ≤ P ≤ Y.
//!
//! The largest λ is that of a cone program. Its dual is a mechanism of velocities v, opening o and slip s of the points, and
//! stretch rates e of the ties:
//!
//! (S3) o = (v_b − v_a)·n, s = (v_b − v_a)·(t₁, t₂), (S4) o ≥ μ |s|, (S5) F·v = 1, λ = −D·v + Σ Y max(0, e).
//!
//! Forces that obey (S1) and (S2) bound λ from below, velocities that obey (S4) and (S5) from above; `certificate.rs` makes
//! both hold. What the bounds enclose is λ of this model, whose friction dilates and whose joints press in their corners: real
//! joints bear less where they slide ([`without_dilation`]) or twist ([`Assembly::drawn_in`]).
//!
//! Source: F. Portioli, C. Casapulla, M. Gilbert and L. Cascini, Limit analysis of 3D masonry block structures with
//! non-associative frictional joints using cone programming, Computers and Structures 143 (2014) 108–121; for the plane
//! R. K. Livesley, International Journal for Numerical Methods in Engineering 12 (1978) 1853–1871.

mod assembly;
mod behind;
mod certificate;
mod equations;
mod fixed_friction;
mod mechanism;
mod problem;
mod program;
mod texture;
mod turning;
mod wall;

pub use assembly::{Assembly, Body, Contact, ContactKind, Cuboid, TextureError, Vector, even_twist};
pub use behind::{Backed, Floor, Gable, SideWall};
pub use mechanism::{ContactMotion, Mechanism};
pub use problem::{PointLoad, Problem, Support, Tie};
pub use texture::{Facade, Leaves};
pub use turning::Turning;
pub use wall::{Face, of_wall};

use crate::program::Friction;
use crate::{CERTIFIED, LimitError, NonAssociative};
use assembly::length;
use equations::Equations;

/// What limit analysis in space finds.
#[derive(Debug, Clone)]
pub struct Limit {
    /// Bounds of λ for associative friction: from forces, from a mechanism.
    pub bounds: [f64; 2],
    /// Normal force [N], from 0, and forces along both tangents at the lower bound: of the four corners of each contact in
    /// turn, then of each support; as they act on side b.
    pub forces: Vec<Vector>,
    /// Force of every tie at the lower bound [N].
    pub pulls: Vec<f64>,
    /// Largest force [N] by which a block is out of balance under `forces`; the lower bound allows for it.
    pub unbalanced: f64,
    /// The mechanism of the upper bound.
    pub mechanism: Mechanism,
    /// Rounds of the solver.
    pub iterations: u32,
}

impl Limit {
    /// λ: the middle of the bounds.
    pub fn multiplier(&self) -> f64 {
        crate::middle(self.bounds)
    }

    /// Distance of the bounds over the larger of |λ| and 1e-3; below 0 by what rounding brings.
    pub fn gap(&self) -> f64 {
        crate::gap(self.bounds)
    }

    /// Whether the gap is at most [`CERTIFIED`].
    pub fn is_certified(&self) -> bool {
        self.gap() <= CERTIFIED
    }

    /// Whether the whole slides on a joint of some μ: λ is that μ, and says nothing about how blocks turn.
    pub fn slides_at(&self, problem: &Problem) -> Option<f64> {
        let frictions = problem.assembly.contacts.iter().filter(|c| c.kind != ContactKind::Head).map(|c| c.friction);
        frictions.into_iter().find(|mu| (self.multiplier() - mu).abs() <= CERTIFIED * mu)
    }

    /// Normal force of each contact [N].
    pub fn pressed(&self, problem: &Problem) -> Vec<f64> {
        let of = |four: &[Vector]| four.iter().map(|f| f[0]).sum();
        self.forces.chunks(4).take(problem.assembly.contacts.len()).map(of).collect()
    }
}

/// Finds λ, its bounds and mechanism for associative friction.
///
/// # Errors
/// A problem that is none, blocks that do not stand without the live load, a program that was not solved.
pub fn analyse(problem: &Problem) -> Result<Limit, LimitError> {
    problem.check()?;
    let equations = Equations::of(problem);
    let friction: Vec<Friction> =
        equations.points.iter().map(|p| Friction { slope: p.friction, cohesion: 0.0 }).collect();
    let solution = program::solve(&equations, &friction, program::SHARP)?;
    // Forces hold the dead load alone where they also hold it under a pull that is not below 0: else it is asked.
    if !program::stands(&equations, &friction)? {
        return Err(LimitError::DoesNotStand);
    }
    let lower = certificate::lower(&equations, &solution);
    let upper = certificate::upper(&equations, &friction, &solution)?;
    Ok(Limit {
        bounds: [equations.multiplier(lower.multiplier), equations.multiplier(upper.multiplier)],
        forces: lower.forces.iter().map(|f| f.map(|f| f * equations.force)).collect(),
        pulls: lower.pulls[lower.pulls.len() - problem.ties.len()..].iter().map(|f| f * equations.force).collect(),
        unbalanced: lower.unbalanced * equations.force,
        mechanism: mechanism::describe(problem, &equations, &upper.velocities),
        iterations: solution.iterations,
    })
}

/// The estimate for friction without dilation, from what [`analyse`] found.
pub fn without_dilation(problem: &Problem, associative: &Limit) -> NonAssociative {
    let equations = Equations::of(problem);
    fixed_friction::estimate(&equations, associative)
}

/// What crushing stones leave of λ.
#[derive(Debug, Clone)]
pub struct Crushed {
    /// λ of `problem`.
    pub limit: Limit,
    /// The problem with what its contacts bear; where `overloaded` is not empty, with smaller contacts instead.
    pub problem: Problem,
    /// Contacts by index that are pressed with more than they bear under the dead load alone: λ is no bound then.
    pub overloaded: Vec<usize>,
}

/// λ of stones that may crush, see [`Problem::crushing`]. At a strength f a contact of sides b and l bears a normal force N no nearer to its edges than
///
/// (S6) a_b = N/(2 f l), a_l = N/(2 f b),
///
/// so that the pressure f on what is left outside of that line bears N. With the forces N_e of the two corners at an edge this
/// is N² ≤ 2 f b l N_e for each edge, a cone: the largest λ and its bounds are as certain as those without. Along a diagonal
/// (S6) leaves too much, by up to (N/(f b l))² b l.
///
/// Where the dead load alone crushes a joint, all joints of its level are set back by (S6) under their mean pressure instead,
/// and those that bear less are named.
///
/// # Errors
/// As [`analyse`].
pub fn crushed(problem: &Problem) -> Result<Crushed, LimitError> {
    match analyse(problem) {
        Err(LimitError::DoesNotStand) if !problem.bears.is_empty() => overloaded(problem),
        found => Ok(Crushed { limit: found?, problem: problem.clone(), overloaded: Vec::new() }),
    }
}

/// Heights of joints nearer than this [m] are one level.
const LEVEL: f64 = 1e-6;

fn overloaded(problem: &Problem) -> Result<Crushed, LimitError> {
    let mut smaller = Problem { bears: Vec::new(), ..problem.clone() };
    let pressed = analyse(&smaller)?.pressed(problem);
    let contacts = &problem.assembly.contacts;
    let height = |k: usize| assembly::dot(contacts[k].middle(), problem.down);
    let beds: Vec<usize> = (0..contacts.len()).filter(|k| contacts[*k].kind != ContactKind::Head).collect();
    let mut overloaded = Vec::new();
    for &k in &beds {
        let level = beds.iter().filter(|other| (height(**other) - height(k)).abs() < LEVEL);
        let [normal, bears] = level.fold([0.0; 2], |[n, b], i| [n + pressed[*i], b + problem.bears[*i]]);
        let part = normal / bears;
        smaller.assembly.contacts[k].corners = contacts[k].set_back(contacts[k].sides().map(|side| 0.5 * part * side));
        if part > 1.0 || pressed[k] > problem.bears[k] {
            overloaded.push(k);
        }
    }
    Ok(Crushed { limit: analyse(&smaller)?, problem: smaller, overloaded })
}

/// Distance of a body's farthest corner from its centre [m].
fn radius(body: &Body) -> f64 {
    body.corners.iter().map(|c| length(assembly::minus(*c, body.centre))).fold(0.0, f64::max)
}
