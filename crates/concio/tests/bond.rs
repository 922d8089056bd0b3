//! Joints whose mortar cracks, (B1) to (B4), against closed forms and against the laws between which they lie.

use std::f64::consts::PI;

use concio::bond::Bond;
use concio::case::{Pulse, PulseShape, Ramp, Scheme, Signal, Solver};
use concio::excitation::Excitation;
use concio::ground::signal::{GroundMotion, compile};
use concio::law::Stribeck;
use concio::model::Model;
use concio::outcome::Outcome;
use concio::record::StopReason;
use concio::samples::{Link, lumped, solver};
use concio::simulate::{Progress, Sampling, Simulation};
use concio::wall::End;

const M: f64 = 10.0;
const K: f64 = 1e7;
const F0: f64 = 2000.0;

fn fine(tolerance: f64) -> Solver {
    solver(Scheme::TrBdf2, tolerance)
}

fn signal(signal: Signal) -> GroundMotion {
    compile(&signal, std::path::Path::new("")).unwrap()
}

fn ramp(amplitude: f64, start: f64, rise: f64) -> GroundMotion {
    signal(Signal::Ramp(Ramp { amplitude: amplitude.into(), start: start.into(), rise: rise.into() }))
}

fn run(model: &Model, solver: &Solver, samples: usize) -> Outcome {
    let interval = model.excitation.duration / samples as f64;
    let sampling = Sampling { interval, frame_every: 1, blocks: Vec::new(), joints: vec!["all".into()] };
    let mut run = Simulation::new(model, solver, &sampling).unwrap();
    let (rows, reason) = run.run_to_end();
    assert_eq!(reason, StopReason::Completed);
    run.outcome(rows, reason)
}

fn channel(outcome: &Outcome, name: &str) -> Vec<f64> {
    let width = outcome.layout.channels.len();
    let at = outcome.layout.channels.iter().position(|c| c.name == name).expect(name);
    outcome.recording.values.iter().skip(at).step_by(width).copied().collect()
}

fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

fn residual(outcome: &Outcome) -> f64 {
    outcome.totals.peak_residual / outcome.totals.peak_input.max(outcome.energies.initial.abs())
}

/// A mass that is bonded to the base and drawn slowly by a driven beam through a spring stiffer than the bond softens.
fn drawn(bond: Bond, way: f64, duration: f64, friction: Option<(Stribeck, f64)>) -> Model {
    let links =
        [Link::bonded(0, End::Base, bond, friction), Link::spring(0, End::Top, 10.0 * K, 2.0 * (10.0 * K * M).sqrt())];
    lumped(&[M], &links, Excitation::of_top(ramp(way, 0.0, duration), duration))
}

/// Peak force, energy and times of a joint that is sheared, or opened, until nothing holds.
#[test]
fn a_softening_joint_bears_its_strength_and_takes_its_energy() {
    let limit = F0 / K;
    for opens in [false, true] {
        let energy = 4.0 * 0.5 * F0 * limit;
        let bond = Bond::new(F0, K, 0.0, energy, opens).unwrap();
        assert!((bond.energy() / energy - 1.0).abs() < 1e-14);
        // Ten times the decay: e^-10 is below what counts as broken. Opening is to the left.
        let way = (limit + 10.0 * bond.decay) * if opens { -1.0 } else { 1.0 };
        let outcome = run(&drawn(bond, way, 2.0, None), &fine(1e-4), 4000);
        let row = outcome.bonds[0];
        let force = peak(&channel(&outcome, "joint/base|m1/elastic"));
        assert!((force / F0 - 1.0).abs() < 1e-3, "peak force {force} of {F0}");
        assert!((outcome.energies.bond / energy - 1.0).abs() < 1e-3, "{} of {energy} J", outcome.energies.bond);
        assert_eq!((row.spent, row.damage), (outcome.energies.bond, 1.0));
        // The block follows the beam but for the spring between: F/(10 K) of it, quasi-statically.
        let cracked = 1.1 * limit / way.abs() * 2.0;
        assert!((row.cracked / cracked - 1.0).abs() < 1e-3, "cracked at {} instead of {cracked}", row.cracked);
        let last = limit + bond.decay * 1e3f64.ln();
        assert!((row.broken / (last / way.abs() * 2.0) - 1.0).abs() < 1e-2, "broken at {}", row.broken);
        assert!(residual(&outcome) < 1e-4, "energy residual {}", residual(&outcome));
    }
}

/// The energy of a joint that breaks converges with the tolerance.
#[test]
fn the_energy_converges_with_the_tolerance() {
    let limit = F0 / K;
    let energy = 4.0 * 0.5 * F0 * limit;
    let bond = Bond::new(F0, K, 0.0, energy, false).unwrap();
    let error = |tolerance: f64| {
        let outcome = run(&drawn(bond, limit + 10.0 * bond.decay, 2.0, None), &fine(tolerance), 50);
        println!("{tolerance:e}: {:e} steps {:?}", outcome.energies.bond / energy - 1.0, outcome.counters);
        (outcome.energies.bond / energy - 1.0).abs()
    };
    let errors = [1e-2, 1e-3, 1e-4].map(error);
    assert!(errors[0] < 1e-3 && errors[2] < 1e-4, "{errors:?}");
}
