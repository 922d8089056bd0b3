//! The horizontal load under which a wall of rigid dry blocks becomes a mechanism: limit analysis.
//!
//! At a contact point of normal n and tangent t the sides press with N ≥ 0 and rub with T. Equilibrium of every block under
//! its dead load D and λ times its live load F:
//!
//! (L1) Σ Eᵏ (N, T)ₖ + λ F + D = 0, (L2) N ≥ 0, |T| ≤ μ N.
//!
//! The largest λ is that of a linear program. Its dual is a mechanism of velocities v, opening o and slip s of the points:
//!
//! (L3) o = v_b·n − v_a·n, s = v_b·t − v_a·t, (L4) o ≥ μ |s|, (L5) F·v = 1, λ = −D·v.
//!
//! Forces that obey (L1) and (L2) bound λ from below, velocities that obey (L4) and (L5) from above. Both are made to hold
//! after the solver has ended (`certificate.rs`): the bounds do not rest on what it says of itself.
//!
//! Source: R. K. Livesley, Limit analysis of structures formed from rigid blocks, International Journal for Numerical
//! Methods in Engineering 12 (1978) 1853–1871; M. C. Ferris and F. Tin-Loi, International Journal of Mechanical
//! Sciences 43 (2001) 209–224.

use std::fmt;

pub mod assembly;
mod certificate;
mod equations;
mod fixed_friction;
mod mechanism;
mod problem;
mod program;
pub mod space;

pub use fixed_friction::{NonAssociative, Stop};
pub use mechanism::{JointMotion, Mechanism, MechanismKind};
pub use problem::{Heads, Options, Problem, Push, Towards, other_strengths};

use equations::Equations;
use program::Friction;

/// Widest relative distance of the bounds of a [`Limit`] that counts as certified.
pub const CERTIFIED: f64 = 1e-4;

/// What limit analysis finds for a wall.
#[derive(Debug, Clone)]
pub struct Limit {
    /// Bounds of λ for associative friction: from forces, from a mechanism.
    pub bounds: [f64; 2],
    /// Normal and tangential force of every contact point at the lower bound [N]; the normal force from 0, tangential
    /// as it acts on side b along the tangent.
    pub forces: Vec<[f64; 2]>,
    /// Largest force [N] by which a block is out of balance under `forces`; the lower bound allows for it.
    pub unbalanced: f64,
    /// The mechanism of the upper bound.
    pub mechanism: Mechanism,
    /// The estimate for friction without dilation.
    pub non_associative: NonAssociative,
}

impl Limit {
    /// λ: the middle of the bounds.
    pub fn multiplier(&self) -> f64 {
        middle(self.bounds)
    }

    /// Distance of the bounds over the larger of |λ| and 1e-3; below 0 by what rounding brings.
    pub fn gap(&self) -> f64 {
        gap(self.bounds)
    }

    /// Whether the gap is at most [`CERTIFIED`].
    pub fn is_certified(&self) -> bool {
        self.gap() <= CERTIFIED
    }
}

/// λ of two bounds.
fn middle([lower, upper]: [f64; 2]) -> f64 {
    0.5 * (lower + upper)
}

/// Their distance over the larger of |λ| and 1e-3.
fn gap([lower, upper]: [f64; 2]) -> f64 {
    (upper - lower) / middle([lower, upper]).abs().max(1e-3)
}

/// Why there is no multiplier.
#[derive(Debug, Clone, PartialEq)]
pub enum LimitError {
    /// No forces balance the dead load.
    DoesNotStand,
    /// The solver ended with neither forces nor mechanism; its own words.
    NotSolved(String),
    /// What was asked is no problem of limit analysis: what is wrong.
    Wrong(String),
}

impl fmt::Display for LimitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LimitError::DoesNotStand => write!(f, "the wall does not stand under its dead load"),
            LimitError::NotSolved(why) => write!(f, "the program was not solved: {why}"),
            LimitError::Wrong(what) => write!(f, "{what}"),
        }
    }
}

impl std::error::Error for LimitError {}

/// Finds λ, its bounds and mechanism, then the estimate for friction without dilation.
///
/// # Errors
/// A wall that does not stand without the live load, a program that was not solved.
pub fn analyse(problem: &Problem) -> Result<Limit, LimitError> {
    let equations = Equations::of(problem);
    let friction: Vec<Friction> = problem.friction.iter().map(|&mu| Friction { slope: mu, cohesion: 0.0 }).collect();
    if !program::stands(&equations, &friction)? {
        return Err(LimitError::DoesNotStand);
    }
    let solution = program::solve(&equations, &friction)?;
    let lower = certificate::lower(&equations, &problem.friction, &solution);
    let upper = certificate::upper(&equations, &problem.friction, &solution)?;
    let non_associative = fixed_friction::estimate(&equations, &problem.friction, &solution);
    Ok(Limit {
        bounds: [equations.multiplier(lower.multiplier), equations.multiplier(upper.multiplier)],
        forces: lower.forces.iter().map(|f| f.map(|f| f * equations.force)).collect(),
        unbalanced: lower.unbalanced * equations.force,
        mechanism: mechanism::describe(problem, &equations, &upper.velocities),
        non_associative,
    })
}
