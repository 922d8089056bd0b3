//! The choice of steps: nothing short is stepped over, samples do not depend on the steps, orders where friction jumps.

use std::f64::consts::PI;

use concio::case::{Pulse, PulseShape, Ramp, Scheme, Signal, Solver};
use concio::excitation::Excitation;
use concio::ground::record::{Format, Record};
use concio::ground::signal::{GroundMotion, compile, from_record};
use concio::law::Stribeck;
use concio::model::Model;
use concio::record::StopReason;
use concio::samples::{Histories, Link, lumped, respond, solver};
use concio::simulate::{Sampling, Simulation};
use concio::wall::End;
use concio_verified::{agrees, farthest};

const M: f64 = 100.0;
const K: f64 = 4e5;
const N: f64 = 981.0;

fn signal(signal: Signal) -> GroundMotion {
    compile(&signal, std::path::Path::new("")).unwrap()
}

fn spring_alone(motion: GroundMotion, duration: f64) -> Model {
    lumped(&[M], &[Link::spring(0, End::Base, K, 0.0)], Excitation::of_base(motion, duration))
}

fn first(h: &Histories) -> Vec<f64> {
    h.displacement.iter().map(|row| row[0]).collect()
}

/// Response of the undamped oscillator to a base acceleration that rises by 1 m/s³ from t = 0.
fn to_a_ramp(t: f64) -> f64 {
    let omega = (K / M).sqrt();
    if t <= 0.0 { 0.0 } else { -(t - (omega * t).sin() / omega) / omega.powi(2) }
}

/// One second of silence, then half a sine of 2 ms, a fiftieth of the oscillator's period: the response is that of the
/// closed form, ω_p and ω apart, at every tolerance.
#[test]
fn a_late_pulse_is_not_stepped_over() {
    let (peak, length, start) = (5.0, 2e-3, 1.0);
    let pulse =
        Pulse { shape: PulseShape::HalfSine, acceleration: peak.into(), duration: length.into(), start: start.into() };
    let model = spring_alone(signal(Signal::Pulse(pulse)), 1.5);
    let (omega, p) = ((K / M).sqrt(), PI / length);
    // u'' + ω² u = −A sin(pt) for t < length; twice that, shifted by half a period of the pulse, from there on.
    let forced = |t: f64| {
        if t <= 0.0 { 0.0 } else { -peak / (omega * omega - p * p) * ((p * t).sin() - p / omega * (omega * t).sin()) }
    };
    let exact = |t: f64| forced(t - start) + forced(t - start - length);
    for (scheme, tolerance, allowed) in
        [(Scheme::TrBdf2, 1e-2, 0.02), (Scheme::TrBdf2, 1e-6, 4e-4), (Scheme::Esdirk4, 1e-2, 0.02)]
    {
        let h = respond(&model, &solver(scheme, tolerance), 1e-3, &[0.0], &[0.0]).unwrap();
        let x = first(&h);
        let scale = peak * 2.0 * length / PI / omega;
        let off = farthest((0..x.len()).map(|k| (x[k] / scale, exact(1e-3 * k as f64) / scale)));
        let subject =
            format!("Integration: late pulse of 2 ms, largest error over the peak; {scheme:?} at {tolerance:e}");
        agrees!(subject, "−A/(ω² − p²) (sin pt − p/ω sin ωt), twice", "", off, 0.0, abs: allowed);
        assert!(x[..1000].iter().all(|x| *x == 0.0), "it moved before the pulse");
    }
}

/// A record of zeros with one sample that is not: a triangle of two sample intervals.
#[test]
fn a_single_spike_of_a_record_is_not_stepped_over() {
    let (dt, peak, at) = (0.01, 3.0, 150);
    let mut acceleration = vec![0.0; 300];
    acceleration[at] = peak;
    let record = Record {
        format: Format::Synthetic,
        dt,
        acceleration,
        displacement: None,
        units: "m/s2".into(),
        station: String::new(),
        event: String::new(),
        channel: String::new(),
        remarks: Vec::new(),
    };
    let model = spring_alone(from_record(&record), 2.0);
    let slope = peak / dt;
    let exact = |t: f64| {
        let from = (at - 1) as f64 * dt;
        slope * (to_a_ramp(t - from) - 2.0 * to_a_ramp(t - from - dt) + to_a_ramp(t - from - 2.0 * dt))
    };
    for (tolerance, allowed) in [(1e-2, 0.02), (1e-6, 1e-3)] {
        let h = respond(&model, &solver(Scheme::TrBdf2, tolerance), 1e-3, &[0.0], &[0.0]).unwrap();
        let x = first(&h);
        let times = || (0..x.len()).map(|k| 1e-3 * k as f64);
        let scale = times().map(|t| exact(t).abs()).fold(0.0, f64::max);
        assert!(scale > 1e-4, "the spike is felt");
        let off = farthest(times().zip(&x).map(|(t, x)| (x / scale, exact(t) / scale)));
        let subject = format!("Integration: one sample of a record, largest error over the peak; at {tolerance:e}");
        agrees!(subject, "three ramps, t − sin(ωt)/ω", "", off, 0.0, abs: allowed);
    }
}

/// Steps, and displacement and velocity of the first block at every sample: a run without frames, which would end steps.
fn without_frames(model: &Model, solver: &Solver, interval: f64, x0: f64) -> (u64, Vec<[f64; 2]>) {
    let sampling = Sampling { interval, frame_every: 0, blocks: vec!["m1".into()], joints: Vec::new() };
    let mut run = Simulation::new(model, solver, &sampling).unwrap();
    run.start_from(&[x0], &[0.0]);
    let channels = &run.layout().channels;
    let place = |name: &str| channels.iter().position(|c| c.name == format!("block/m1/{name}")).unwrap();
    let (x, v, width) = (place("displacement"), place("velocity"), channels.len());
    let (rows, _) = run.run_to_end();
    (run.state().counters.steps, rows.values.chunks(width).map(|row| [row[x], row[v]]).collect())
}

/// What is sampled between the ends of steps has the error of the steps: a hundred samples in a step or none.
#[test]
fn samples_inside_steps_are_as_good_as_the_steps() {
    let (x0, end) = (1e-3, 0.5);
    let omega = (K / M).sqrt();
    let model = spring_alone(GroundMotion::AtRest, end);
    for (scheme, tolerance) in
        [(Scheme::TrBdf2, 1e-3), (Scheme::TrBdf2, 1e-5), (Scheme::Esdirk4, 1e-4), (Scheme::Esdirk4, 1e-7)]
    {
        let worst = |interval: f64| {
            let (steps, rows) = without_frames(&model, &solver(scheme, tolerance), interval, x0);
            let error = |(k, [x, v]): (usize, &[f64; 2])| {
                let phase = omega * interval * k as f64;
                (x - x0 * phase.cos()).abs().max((v / omega + x0 * phase.sin()).abs()) / x0
            };
            (steps, rows.iter().enumerate().map(error).fold(0.0, f64::max))
        };
        let ((few, at_ends), (many, inside)) = (worst(end / 4.0), worst(end / 5000.0));
        assert!(many < 2500 && few <= many, "{scheme:?} {tolerance:e}: {few} and {many} steps for 5000 samples");
        assert!(inside <= 2.0 * at_ends + 3.0 * tolerance, "{scheme:?} {tolerance:e}: {inside:e} against {at_ends:e}");
    }
}

/// Peaks are met inside steps too: 1 mm, with steps of a sixth of the period.
#[test]
fn peaks_are_found_inside_steps() {
    let model = spring_alone(GroundMotion::AtRest, 1.0);
    let coarse = Solver { tolerance: 1e-2, ..solver(Scheme::Esdirk4, 1.0) };
    let sampling = Sampling { interval: 0.5, frame_every: 0, blocks: Vec::new(), joints: Vec::new() };
    let mut run = Simulation::new(&model, &coarse, &sampling).unwrap();
    // Passing through the middle, so that no step begins at the peak.
    run.start_from(&[0.0], &[1e-3 * (K / M).sqrt()]);
    run.run_to_end();
    let state = run.state();
    let per_period = state.counters.steps as f64 * 2.0 * PI / (K / M).sqrt();
    let peak = state.envelopes.block_displacement[0];
    println!("{per_period} steps a period");
    agrees!("Integration: peak inside of a step", "v₀/ω", "m", peak, 1e-3, 0.01);
}

/// A block on a belt: its displacement after two slips, and the number of steps.
fn belt(law: Stribeck, solver: Solver) -> (f64, f64) {
    let (v, end) = (0.05, 0.24);
    let links = [Link::spring(0, End::Base, K, 0.0), Link::friction(0, End::Top, law, N)];
    let ramp = Ramp { amplitude: (v * 100.0).into(), start: 0.0.into(), rise: 100.0.into() };
    let model = lumped(&[M], &links, Excitation::of_top(signal(Signal::Ramp(ramp)), end));
    let h = respond(&model, &solver, end, &[0.4 * N / K], &[v]).unwrap();
    assert_eq!(h.stop_reason, StopReason::Completed, "{law:?} {solver:?}");
    (*first(&h).last().unwrap(), h.steps as f64)
}

/// Error over number of steps, steps chosen by the tolerance: it falls at least as fast as steps grow in number, with the law
/// (6) and across the jumps of a set-valued law; there, where steps are short at the jumps alone, by no certain order.
#[test]
fn orders_with_stick_and_slip() {
    let smooth = Stribeck { static_: 0.6, dynamic: 0.4, slip_velocity: 0.02, beta: 3.0, alpha: 0.0 };
    let sharp = Stribeck { static_: 0.6, dynamic: 0.4, slip_velocity: 0.0, beta: f64::INFINITY, alpha: 0.0 };
    for (law, low, high) in [(smooth, 1.0, 6.0), (sharp, 1.0, 6.0)] {
        let (reference, _) = belt(law, solver(Scheme::TrBdf2, 1e-9));
        let [coarse, fine] = [1e-4, 1e-7].map(|tolerance| {
            let (x, steps) = belt(law, solver(Scheme::TrBdf2, tolerance));
            ((x - reference).abs(), steps)
        });
        let order = (coarse.0 / fine.0).ln() / (fine.1 / coarse.1).ln();
        println!("beta {}: order {order:.2}, errors and steps {coarse:?} {fine:?}", law.beta);
        assert!((low..high).contains(&order), "β {}: order {order}, {coarse:?} {fine:?}", law.beta);
        assert!(fine.0 < 1e-6, "{fine:?}");
    }
}
