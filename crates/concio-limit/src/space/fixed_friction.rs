//! Friction without dilation, by cone programs in sequence.
//!
//! As in the plane (`../fixed_friction.rs`): in every round the cone of a point is replaced by
//!
//! (S7) √(T₁² + T₂²) ≤ c + ν N, c = (μ − ν) N̄, ν → 0,
//!
//! with the normal force N̄ of the rounds before. Where N comes to N̄, forces obey (S2) and the mechanism slides without
//! dilation. There may be several such states, of different λ; the one found need not be the lowest, and none may be found.
//!
//! Source: M. Gilbert, C. Casapulla and H. M. Ahmed, Computers and Structures 84 (2006) 873–887, with cones.

use super::Limit;
use super::assembly::Vector;
use super::equations::Equations;
use super::program::{COARSE, solve};
use crate::fixed_friction::{AT_REST, NonAssociative, OBEYS, Stop, at_rest};
use crate::program::Friction;

/// Most rounds.
const MOST: usize = 60;
/// Factor on ν from round to round; below a millionth of μ it is 0.
const FLATTER: f64 = 0.1;
/// Part of the newest normal force in N̄.
const NEWEST: f64 = 0.6;

pub(super) fn estimate(equations: &Equations, start: &Limit) -> NonAssociative {
    let mut normal: Vec<f64> = start.forces.iter().map(|f| f[0].max(0.0) / equations.force).collect();
    // Of the rounds without slope.
    let mut multipliers: Vec<f64> = Vec::with_capacity(AT_REST.0);
    let (mut last, mut excess, mut part) = (f64::NAN, f64::NAN, 1.0);
    for rounds in 1..=MOST {
        part = if part > 1e-6 { part * FLATTER } else { 0.0 };
        let law = |(mu, n): (f64, &f64)| Friction { slope: part * mu, cohesion: (1.0 - part) * mu * n };
        let friction = equations.points.iter().map(|p| p.friction);
        let laws: Vec<Friction> = friction.zip(&normal).map(law).collect();
        let Ok(found) = solve(equations, &laws, COARSE) else {
            return NonAssociative { multiplier: f64::NAN, rounds, stop: Stop::Unsolved, excess };
        };
        (last, excess) = (equations.multiplier(found.multiplier), beyond(equations, &found.forces));
        multipliers.extend((part == 0.0).then_some(last));
        if excess <= OBEYS && at_rest(&multipliers) {
            return NonAssociative { multiplier: last, rounds, stop: Stop::Converged, excess };
        }
        normal.iter_mut().zip(&found.forces).for_each(|(n, f)| *n = NEWEST * f[0].max(0.0) + (1.0 - NEWEST) * *n);
    }
    NonAssociative { multiplier: last, rounds: MOST, stop: Stop::Rounds, excess }
}

fn beyond(equations: &Equations, forces: &[Vector]) -> f64 {
    let largest = forces.iter().map(|f| f[0]).fold(f64::MIN_POSITIVE, f64::max);
    let over = forces.iter().zip(&equations.points).map(|(f, p)| (f[1].hypot(f[2]) - p.friction * f[0]) / largest);
    over.fold(0.0, f64::max)
}
