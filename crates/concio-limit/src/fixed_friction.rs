//! Friction without dilation, by linear programs in sequence.
//!
//! Blocks that slide do not rise as (L4) makes them. In every round the cone of a point is replaced by |T| ≤ c + ν N through
//! the bound μ N̄ of the normal force of the rounds before:
//!
//! (L6) c = (μ − ν) N̄, ν → 0,
//!
//! so that slip in the end opens nothing. Where N comes to N̄, forces obey (L2) and the mechanism slides without dilation.
//! There may be several such states, of different λ; the one found need not be the lowest, and none may be found.
//!
//! Source: M. Gilbert, C. Casapulla and H. M. Ahmed, Limit analysis of masonry block structures with non-associative
//! frictional joints using linear programming, Computers and Structures 84 (2006) 873–887.

use crate::equations::Equations;
use crate::program::{Friction, Solution, solve};

/// The estimate for friction without dilation.
#[derive(Debug, Clone, PartialEq)]
pub struct NonAssociative {
    /// λ of the last round; not a number where there was none.
    pub multiplier: f64,
    /// Linear programs solved.
    pub rounds: usize,
    /// How it ended.
    pub stop: Stop,
    /// Largest |T| − μ N of a point over the largest N, from 0: how far the last forces are from (L2).
    pub excess: f64,
    /// Least and most λ of the states that have the mechanism of the last round; in space alone, and where both were found.
    pub states: Option<[f64; 2]>,
}

/// How the rounds ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// λ came to rest, to 3e-4 of itself, and the forces obey the friction.
    Converged,
    /// They did not within the rounds there are.
    Rounds,
    /// A round had no solution.
    Unsolved,
}

/// Most rounds.
const MOST: usize = 200;
/// Spread of λ over this many rounds at which it is at rest, over λ. Where several states lie near each other it wanders
/// between them by some 1e-4.
const AT_REST: (usize, f64) = (8, 3e-4);
/// Excess at which forces obey the friction.
pub(crate) const OBEYS: f64 = 1e-3;
/// Factor on ν from round to round; below a millionth of μ it is 0.
const FLATTER: f64 = 0.1;
/// Part of the newest normal force in N̄.
const NEWEST: f64 = 0.6;

pub(super) fn estimate(equations: &Equations, friction: &[f64], start: &Solution) -> NonAssociative {
    let mut normal: Vec<f64> = start.forces.iter().map(|f| f[0].max(0.0)).collect();
    // Of the rounds without slope.
    let mut multipliers: Vec<f64> = Vec::new();
    let (mut last, mut excess, mut part) = (f64::NAN, f64::NAN, 1.0);
    for rounds in 1..=MOST {
        part = if part > 1e-6 { part * FLATTER } else { 0.0 };
        let law = |(mu, n): (&f64, &f64)| Friction { slope: part * mu, cohesion: (1.0 - part) * mu * n };
        let laws: Vec<Friction> = friction.iter().zip(&normal).map(law).collect();
        let Ok(found) = solve(equations, &laws) else {
            return NonAssociative { multiplier: f64::NAN, rounds, stop: Stop::Unsolved, excess, states: None };
        };
        (last, excess) = (equations.multiplier(found.multiplier), beyond(&found.forces, friction));
        multipliers.extend((part == 0.0).then_some(last));
        if excess <= OBEYS && at_rest(&multipliers) {
            return NonAssociative { multiplier: last, rounds, stop: Stop::Converged, excess, states: None };
        }
        normal.iter_mut().zip(&found.forces).for_each(|(n, f)| *n = NEWEST * f[0].max(0.0) + (1.0 - NEWEST) * *n);
    }
    NonAssociative { multiplier: last, rounds: MOST, stop: Stop::Rounds, excess, states: None }
}

pub(crate) fn at_rest(multipliers: &[f64]) -> bool {
    let Some(window) = multipliers.last_chunk::<{ AT_REST.0 }>() else { return false };
    let [low, high] = window.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |e, v| [e[0].min(*v), e[1].max(*v)]);
    high - low <= AT_REST.1 * high.abs().max(1e-3)
}

fn beyond(forces: &[[f64; 2]], friction: &[f64]) -> f64 {
    let largest = forces.iter().map(|f| f[0]).fold(f64::MIN_POSITIVE, f64::max);
    forces.iter().zip(friction).map(|(f, mu)| (f[1].abs() - mu * f[0]) / largest).fold(0.0, f64::max)
}
