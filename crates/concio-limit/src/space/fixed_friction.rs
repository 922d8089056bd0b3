//! Friction without dilation, by cone programs in sequence.
//!
//! As in the plane (`../fixed_friction.rs`), the cone of a point is replaced by a bound from the normal force N̄ of the round before:
//!
//! (S7) √(T₁² + T₂²) ≤ μ N̄.
//!
//! Where N comes to N̄, forces obey (S2) and the mechanism slides without dilation. Many forces bear the same λ, and what a program
//! picks of them jumps from round to round. Each round therefore seeks the most of λ − w Σ (N − N̄)²/2: w slows what changes, and
//! vanishes from the state at which it ends.
//!
//! That state is one of many. The forces that a mechanism leaves are a convex set: none where it opens, μ N against the slip where
//! it slides, (S2) elsewhere. Two more programs have the least and the most λ of it.
//!
//! Source: M. Gilbert, C. Casapulla and H. M. Ahmed, Computers and Structures 84 (2006) 873–887, with cones and without their
//! slope ν, which w makes needless.

use super::Limit;
use super::assembly::Vector;
use super::equations::{Equations, Point};
use super::program::{COARSE, Near, Solution, solve, solve_near};
use crate::equations::power;
use crate::fixed_friction::{NonAssociative, OBEYS, Stop, at_rest};
use crate::program::Friction;

/// Most rounds.
const MOST: usize = 60;
/// Twice what w would take from λ if all N changed by themselves. With less, N̄ jumps; with four times as much, façades of 250 blocks do not settle.
const SLOWS: f64 = 0.05;
/// Opening, slip and stretch that count as none, over the velocity of what is pushed.
const STICKS: f64 = 1e-4;

pub(super) fn estimate(equations: &Equations, start: &Limit) -> NonAssociative {
    let (estimate, mechanism) = sequence(equations, start);
    let states = || {
        let [least, most] = [-1.0, 1.0].map(|sign| extreme(equations, &mechanism, sign));
        let states = [least?, most?].map(|found| equations.multiplier(found.multiplier));
        // Else what is told apart as open, sliding or at rest is not yet.
        let slack = OBEYS * estimate.multiplier.abs();
        (states[0] - slack..=states[1] + slack).contains(&estimate.multiplier).then_some(states)
    };
    NonAssociative { states: if estimate.stop == Stop::Converged { states() } else { None }, ..estimate }
}

/// The estimate, without its states, and the velocities of its mechanism.
fn sequence(equations: &Equations, start: &Limit) -> (NonAssociative, Vec<f64>) {
    let mut normal: Vec<f64> = start.forces.iter().map(|f| f[0].max(0.0) / equations.force).collect();
    let squares: f64 = normal.iter().map(|n| n * n).sum();
    let weight = SLOWS / (equations.multiplier(1.0) * squares.max(1.0));
    let mut multipliers = Vec::with_capacity(MOST);
    let mut estimate =
        NonAssociative { multiplier: f64::NAN, rounds: 0, stop: Stop::Rounds, excess: f64::NAN, states: None };
    let mut mechanism = Vec::new();
    while estimate.stop == Stop::Rounds && estimate.rounds < MOST {
        estimate.rounds += 1;
        let law = |(point, n): (&Point, &f64)| Friction { slope: 0.0, cohesion: point.friction * n };
        let laws: Vec<Friction> = equations.points.iter().zip(&normal).map(law).collect();
        let Ok(found) = solve_near(equations, &laws, COARSE, Some(Near { normal: &normal, weight })) else {
            (estimate.multiplier, estimate.stop) = (f64::NAN, Stop::Unsolved);
            break;
        };
        multipliers.push(equations.multiplier(found.multiplier));
        (estimate.multiplier, estimate.excess) = (multipliers[estimate.rounds - 1], beyond(equations, &found.forces));
        if estimate.excess <= OBEYS && at_rest(&multipliers) {
            estimate.stop = Stop::Converged;
        }
        normal.iter_mut().zip(&found.forces).for_each(|(n, f)| *n = f[0].max(0.0));
        mechanism = found.velocities;
    }
    (estimate, mechanism)
}

/// Of the forces that a mechanism leaves those of the least (sign −1) or the most λ. What crushes is left out: none is found there.
fn extreme(equations: &Equations, velocities: &[f64], sign: f64) -> Option<Solution> {
    if !equations.bears.is_empty() {
        return None;
    }
    let mut left = equations.clone();
    left.live.iter_mut().for_each(|v| *v *= sign);
    left.points.retain_mut(|point| bears(point, velocities));
    for pull in &mut left.pulls {
        let stretch = -power(&pull.column, velocities);
        if stretch.abs() > STICKS {
            let force = if stretch > 0.0 { pull.most } else { 0.0 };
            pull.column.iter().for_each(|(row, v)| left.dead[*row] += force * v);
            pull.most = 0.0;
        }
    }
    let laws: Vec<Friction> = left.points.iter().map(|p| Friction { slope: p.friction, cohesion: 0.0 }).collect();
    let found = solve(&left, &laws, COARSE).ok()?;
    Some(Solution { multiplier: sign * found.multiplier, ..found })
}

/// Whether a point bears anything then: not where it opens. Where it slides, friction against its slip goes with N.
fn bears(point: &mut Point, velocities: &[f64]) -> bool {
    let [opening, a, b] = [&point.normal, &point.tangents[0], &point.tangents[1]].map(|c| power(c, velocities));
    let slip = a.hypot(b);
    if slip > STICKS {
        for (tangent, part) in point.tangents.iter().zip([a / slip, b / slip]) {
            point.normal.extend(tangent.iter().map(|(row, v)| (*row, -point.friction * part * v)));
        }
        point.friction = 0.0;
    }
    opening <= STICKS
}

fn beyond(equations: &Equations, forces: &[Vector]) -> f64 {
    let largest = forces.iter().map(|f| f[0]).fold(f64::MIN_POSITIVE, f64::max);
    let over = forces.iter().zip(&equations.points).map(|(f, p)| (f[1].hypot(f[2]) - p.friction * f[0]) / largest);
    over.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Assembly, Facade, Problem, analyse};

    /// Forces of the least λ, of the most, and of what another program has for the façades L3 and L5: in equilibrium, none beyond friction, none
    /// where it opens, friction against slip.
    #[test]
    fn every_multiplier_between_has_forces_that_its_mechanism_leaves() {
        // The second settles to what counts as none.
        for (length, theirs, none) in [(2.0, 0.346, 1e-6), (4.0, 0.259, STICKS)] {
            let facade = Facade {
                thickness: 0.2,
                course: 0.2,
                courses: 10,
                length,
                sides: [true; 2],
                depth: 2.4,
                specific_weight: 20e3,
            };
            let blocks = facade.blocks().expect("a façade");
            let wall = Problem::new(Assembly::of_boxes(&blocks, 0.6).expect("a wall"), [-1.0, 0.0, 0.0]);
            let (start, equations) = (analyse(&wall).expect("a limit"), Equations::of(&wall));
            let (estimate, v) = sequence(&equations, &start);
            assert_eq!(estimate.stop, Stop::Converged);
            let ends = [-1.0, 1.0].map(|sign| extreme(&equations, &v, sign).expect("forces"));
            let [least, most] = [&ends[0], &ends[1]].map(|end| end.multiplier);
            assert!(most > 1.02 * least, "{least} to {most}");
            let lifted = |p: &&Point| power(&p.normal, &v) > STICKS;
            assert!(equations.points.iter().filter(lifted).count() > 50);
            let moves = |p: &Point| [&p.normal, &p.tangents[0], &p.tangents[1]].map(|c| power(c, &v));
            let whole = |found: &Solution| -> Vec<Vector> {
                let mut bear = found.forces.iter();
                let force = |point: &Point| {
                    let [opening, a, b] = moves(point);
                    let slip = a.hypot(b);
                    match (opening > STICKS, slip > STICKS) {
                        (true, _) => [0.0; 3],
                        (_, false) => *bear.next().expect("a force"),
                        _ => {
                            let n = bear.next().expect("a force")[0];
                            [n, -point.friction * n * a / slip, -point.friction * n * b / slip]
                        }
                    }
                };
                equations.points.iter().map(force).collect()
            };
            let ends = ends.each_ref().map(whole);
            let between = (theirs / equations.multiplier(1.0) - least) / (most - least);
            assert!((0.0..=1.0).contains(&between), "{theirs}");
            for part in [0.0, between, 1.0] {
                let mixed = |(a, b): (&Vector, &Vector)| [0, 1, 2].map(|k| a[k] + part * (b[k] - a[k]));
                let forces: Vec<Vector> = ends[0].iter().zip(&ends[1]).map(mixed).collect();
                let residual = equations.residual(&forces, &[], least + part * (most - least));
                let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
                assert!(most(&mut residual.iter().map(|r| r.abs())) < 1e-6, "out of balance");
                assert!(beyond(&equations, &forces) < 1e-6, "beyond friction");
                let overlap = most(&mut equations.points.iter().map(|p| -moves(p)[0]));
                assert!(overlap < none, "{length} m: blocks overlap by {overlap:e}");
            }
        }
    }
}
