//! Processing, measures, response spectrum and the runtime motion against closed forms.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use concio::case::{
    Baseline, DisplacementPath, HistoryQuantity, Pulse, PulseShape, Ramp, RecordChannel, RecordInput, Signal, Sine,
    Sweep, Synthetic, Tilt,
};
use concio::ground::formats::parse;
use concio::ground::library;
use concio::ground::process::{self, integrate, prepare};
use concio::ground::record::{Format, Record, TextOptions};
use concio::ground::signal::{GroundMotion, compile, from_record};
use concio::ground::{STANDARD_GRAVITY, measure, response_spectrum};
use concio::quantity::{Acceleration, Frequency, Length, Time, Velocity};
use concio_verified::{agrees, farthest};
use proptest::prelude::*;

fn record(dt: f64, npts: usize, a: impl Fn(f64) -> f64) -> Record {
    Record {
        format: Format::Text,
        dt,
        acceleration: (0..npts).map(|k| a(k as f64 * dt)).collect(),
        displacement: None,
        units: "m/s2".into(),
        station: String::new(),
        event: String::new(),
        channel: String::new(),
        remarks: Vec::new(),
    }
}

fn input() -> RecordInput {
    RecordInput {
        record: PathBuf::from("peer.at2"),
        channel: None,
        scale: None,
        pga: None,
        trim: None,
        reverse: false,
        resample: None,
        baseline: Baseline::None,
        quantity: HistoryQuantity::Acceleration,
        units: None,
        dt: None,
        layout: None,
    }
}

fn seconds(t: f64) -> Time {
    Time::from_si(t)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| f64::max(largest, value.abs()))
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} instead of {expected}");
}

// Response spectrum

#[test]
fn spectrum_of_a_step() {
    // u = −a/ω² [1 − e^{−ζωt}(cos ω_d t + ζ/√(1−ζ²) sin ω_d t)], largest at ω_d t = π.
    let step = record(0.001, 6001, |_| 2.0);
    for damping in [0.0, 0.02, 0.05, 0.3] {
        let spectrum = response_spectrum(step.dt, &step.acceleration, damping, &[0.5, 1.0, 3.0]);
        for (period, sd) in spectrum.periods.iter().zip(&spectrum.sd) {
            let omega = 2.0 * PI / period;
            let peak = 2.0 / (omega * omega) * (1.0 + (-PI * damping / (1.0 - damping * damping).sqrt()).exp());
            let subject = format!("Ground motion: S_d of a step; ζ = {damping}, T = {period} s");
            agrees!(subject, "a/ω² (1 + e^(−πζ/√(1 − ζ²)))", "m", *sd, peak, 1e-5);
        }
    }
}

/// A pulse that ends before an oscillator has moved leaves it a velocity: S_d = v e^(−ζ/√(1 − ζ²) atan(√(1 − ζ²)/ζ))/ω, wherever its samples end. And a peak lies between samples.
#[test]
fn spectrum_of_what_is_over() {
    let omega = 2.0 * PI / 0.5;
    let damping: f64 = 0.05;
    let root = (1.0 - damping * damping).sqrt();
    let expected = 2.0 * 1e-4 / PI * (-damping / root * (root / damping).atan()).exp() / omega;
    for samples in [101, 120, 4000] {
        let pulse = record(1e-6, samples, |t| if t <= 1e-4 { (1e4 * PI * t).sin() } else { 0.0 });
        let found = response_spectrum(pulse.dt, &pulse.acceleration, damping, &[0.5]).sd[0];
        let subject = format!("Ground motion: S_d of a pulse of 0.1 ms; {samples} samples of 1 µs");
        agrees!(subject, "v/ω e^(−ζ/√(1 − ζ²) atan(√(1 − ζ²)/ζ))", "m", found, expected, 1e-4);
    }
    // Critically damped it reaches v/(e ω), overdamped v r^(r/(1 − r))/|r_2| with the ratio r of its roots.
    let pulse = record(1e-6, 101, |t| (1e4 * PI * t).sin());
    let velocity = 2.0 * 1e-4 / PI;
    let found = response_spectrum(pulse.dt, &pulse.acceleration, 1.0, &[0.5]).sd[0];
    agrees!(
        "Ground motion: S_d of a pulse, critically damped",
        "v/(e ω)",
        "m",
        found,
        velocity / 1f64.exp() / omega,
        1e-3
    );
    let found = response_spectrum(pulse.dt, &pulse.acceleration, 1.25, &[0.5]).sd[0];
    // The roots of ζ = 1.25 are −ω/2 and −2 ω.
    let expected = velocity / (1.5 * omega) * (0.25f64.powf(1.0 / 3.0) - 0.25f64.powf(4.0 / 3.0));
    agrees!("Ground motion: S_d of a pulse, ζ = 1.25", "v (4^(−1/3) − 4^(−4/3))/(1.5 ω)", "m", found, expected, 1e-3);
    let coarse = record(0.025, 400, |t| if t > 0.0 { 1.0 } else { 0.0 });
    let fine = record(0.001, 10_000, |t| (40.0 * t).min(1.0));
    let [coarse, fine] = [coarse, fine].map(|r| response_spectrum(r.dt, &r.acceleration, 0.0, &[0.5]).sd[0]);
    assert_close(coarse, fine, 2e-4);
}

#[test]
fn spectrum_at_resonance() {
    // From rest at r = 1 the envelope grows to the steady amplitude a/(2ζω²) and never passes it.
    let harmonic = record(0.001, 80_001, |t| 0.7 * (2.0 * PI * t).sin());
    let spectrum = response_spectrum(harmonic.dt, &harmonic.acceleration, 0.05, &[1.0]);
    let expected = 0.7 / (0.1 * 4.0 * PI * PI);
    agrees!("Ground motion: S_d of a sine at resonance", "a/(2 ζ ω²)", "m", spectrum.sd[0], expected, 2e-5);
    assert_close(spectrum.psv[0], spectrum.sd[0] * 2.0 * PI, 1e-14);
    assert_close(spectrum.psa[0], spectrum.sd[0] * 4.0 * PI * PI, 1e-14);
}

#[test]
fn stiff_oscillators_follow_the_ground() {
    let coarse = record(0.02, 500, |t| (2.0 * PI * t).sin() * (-0.2 * t).exp());
    let spectrum = response_spectrum(coarse.dt, &coarse.acceleration, 0.05, &[0.0, 1e-9, 1e-5, 1e-4, 0.002, 0.02]);
    let pga = largest(&coarse.acceleration);
    assert_eq!(spectrum.psa[..3], [pga; 3]);
    assert_eq!(spectrum.sd[0], 0.0);
    for psa in &spectrum.psa[3..] {
        assert_close(*psa, pga, 0.02);
    }
    // Soft ones stay behind: Sd tends to the ground's own displacement.
    let closed = record(0.005, 4001, |t| if t < 2.0 { (PI * t).sin() } else { 0.0 });
    let soft = response_spectrum(closed.dt, &closed.acceleration, 0.0, &[4000.0]);
    let expected = measure(&closed).pgd.value.abs();
    agrees!("Ground motion: S_d of a soft oscillator", "peak ground displacement", "m", soft.sd[0], expected, 1e-3);
}

proptest! {
    #[test]
    fn spectrum_is_linear_in_the_motion(factor in prop_oneof![-20.0..-0.01_f64, 0.01..20.0], values in prop::collection::vec(-5.0..5.0_f64, 2..200)) {
        let periods = [0.01, 0.1, 0.7, 3.0, 50.0];
        let scaled: Vec<f64> = values.iter().map(|a| a * factor).collect();
        let (one, other) = (response_spectrum(0.01, &values, 0.05, &periods), response_spectrum(0.01, &scaled, 0.05, &periods));
        for (one, other) in one.sd.iter().zip(&other.sd) {
            prop_assert!((other - factor.abs() * one).abs() <= 1e-12 * other.abs());
        }
    }

    #[test]
    fn integration_is_exact_for_a_line(a in -9.0..9.0_f64, slope in -9.0..9.0_f64, v0 in -2.0..2.0_f64, u0 in -2.0..2.0_f64, dt in 1e-4..0.1_f64) {
        let line = record(dt, 300, |t| a + slope * t);
        let (v, u) = integrate(dt, &line.acceleration, v0, u0);
        for k in [0, 1, 17, 299] {
            let t = k as f64 * dt;
            let (exact_v, exact_u) = (v0 + t * (a + slope * t / 2.0), u0 + t * (v0 + t * (a / 2.0 + slope * t / 6.0)));
            let scale = 1.0 + t * t * (a.abs() + slope.abs() * t + v0.abs());
            prop_assert!((v[k] - exact_v).abs() < 1e-12 * scale.max(v0.abs() + t * a.abs()) && (u[k] - exact_u).abs() < 1e-12 * scale);
        }
    }

    #[test]
    fn polynomials_vanish(coefficients in prop::collection::vec(-3.0..3.0_f64, 1..8), npts in 10..400_usize) {
        let degree = coefficients.len() - 1;
        prop_assume!(degree <= 6);
        let polynomial = |k: usize| coefficients.iter().rev().fold(0.0, |sum, c| sum * (k as f64 / npts as f64) + c);
        let mut values: Vec<f64> = (0..npts).map(polynomial).collect();
        process::subtract_polynomial(&mut values, degree).unwrap();
        prop_assert!(largest(&values) < 1e-11, "{}", largest(&values));
    }
}

// Measures

#[test]
fn measures_of_one_sine() {
    let (peak, period, dt) = (2.0, 1.0, 0.001);
    let sine = record(dt, 1001, |t| peak * (2.0 * PI * t / period).sin());
    let m = measure(&sine);
    assert_close(m.pga.value, peak, 1e-12);
    assert_close(m.pga.time, 0.25, 1e-12);
    agrees!("Ground motion: one sine, peak velocity", "A T/π", "m/s", m.pgv.value, peak * period / PI, 1e-5);
    assert_close(m.pgv.time, 0.5, 1e-12);
    let expected = peak * period * period / (2.0 * PI);
    agrees!("Ground motion: one sine, peak displacement", "A T²/2π", "m", m.pgd.value, expected, 1e-5);
    assert_close(m.final_displacement, m.pgd.value, 1e-12);
    assert!(m.final_velocity.abs() < 1e-12);
    let expected = PI / (2.0 * STANDARD_GRAVITY) * peak * peak * period / 2.0;
    agrees!("Ground motion: one sine, Arias intensity", "π/(2g) A² T/2", "m/s", m.arias, expected, 1e-9);
    // Husid curve of sin²: x − sin(4πx)/(4π) = 0.05 at x = 0.127863, solved by bisection; symmetric.
    let husid = |x: f64| x - (4.0 * PI * x).sin() / (4.0 * PI);
    let (mut low, mut high) = (0.0, 0.5);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if husid(middle) < 0.05 { low = middle } else { high = middle }
    }
    assert_close(m.t5, low, 1e-4);
    let against = "x − sin(4πx)/4π = 0.05, by bisection";
    agrees!("Ground motion: one sine, significant duration", against, "s", m.d5_95, 1.0 - 2.0 * low, 1e-4);
}

#[test]
fn measures_of_a_constant() {
    let m = measure(&record(0.01, 1001, |_| -3.0));
    assert_eq!((m.pga.value, m.pga.time), (-3.0, 0.0));
    assert_close(m.d5_95, 9.0, 1e-12);
    assert_close(m.final_velocity, -30.0, 1e-12);
    assert_close(m.final_displacement, -150.0, 1e-12);
    // 5 % step response: PSV = a T/(2π)(1 + e^{−πζ/√(1−ζ²)}), integrated over 0.1 … 2.5 s.
    let overshoot = 1.0 + (-PI * 0.05 / (1.0_f64 - 0.0025).sqrt()).exp();
    let expected = 3.0 * overshoot / (4.0 * PI) * (2.5 * 2.5 - 0.1 * 0.1);
    let against = "PSV of a step, integrated from 0.1 s to 2.5 s";
    agrees!("Ground motion: constant acceleration, Housner intensity", against, "m", m.housner, expected, 2e-3);
    let rest = measure(&record(0.01, 10, |_| 0.0));
    assert_eq!((rest.pga.value, rest.arias, rest.d5_95, rest.housner), (0.0, 0.0, 0.0, 0.0));
}

// Processing

#[test]
fn steps_run_in_their_order() {
    let raw = record(0.01, 1001, |t| 0.5 + (2.0 * PI * 1.5 * t).sin());
    let steps = RecordInput {
        trim: Some([seconds(2.0), seconds(8.0)]),
        baseline: Baseline::Polynomial(0),
        resample: Some(seconds(0.005)),
        pga: Some(Acceleration::from_si(3.0)),
        ..input()
    };
    let done = prepare(raw.clone(), &steps).unwrap();
    assert_eq!((done.npts(), done.dt), (1201, 0.005));
    assert_close(largest(&done.acceleration), 3.0, 1e-14);
    let mean = done.acceleration.iter().step_by(2).sum::<f64>() / 601.0;
    assert!(mean.abs() < 1e-13, "{mean}");
    let doubled = prepare(raw.clone(), &RecordInput { scale: Some(-2.0), ..input() }).unwrap();
    assert!(doubled.acceleration.iter().zip(&raw.acceleration).all(|(b, a)| *b == -2.0 * a));
    assert_eq!(prepare(raw.clone(), &input()).unwrap(), raw);
}

/// a(T − t): twice is the record again, peaks and Arias intensity are those of the record, the kept interval is chosen
/// before; a displacement history runs back along its own path.
#[test]
fn reversed_records_run_backwards() {
    let raw = record(0.01, 1001, |t| (1.0 + t) * (2.0 * PI * 1.5 * t).sin());
    let backwards = RecordInput { reverse: true, ..input() };
    let done = prepare(raw.clone(), &backwards).unwrap();
    assert!(done.acceleration.iter().zip(raw.acceleration.iter().rev()).all(|(b, a)| b == a));
    assert_eq!(prepare(done.clone(), &backwards).unwrap(), raw);
    let (m, n) = (measure(&raw), measure(&done));
    assert_eq!(m.pga.value, n.pga.value);
    assert_close(n.arias, m.arias, 1e-12);
    let kept = RecordInput { trim: Some([seconds(2.0), seconds(8.0)]), ..backwards.clone() };
    let kept = prepare(raw.clone(), &kept).unwrap();
    assert_eq!((kept.npts(), kept.acceleration[0]), (601, raw.acceleration[800]));
    let rows: String = (0..=100).map(|k| format!("{:.2},{:.9}\n", 0.01 * k as f64, (0.05 * k as f64).sin())).collect();
    let options = TextOptions { quantity: HistoryQuantity::Displacement, ..TextOptions::default() };
    let path = parse(format!("t [s], u [mm]\n{rows}").as_bytes(), Path::new("file"), &options).unwrap().swap_remove(0);
    let back = prepare(path.clone(), &backwards).unwrap();
    let (there, home) = (from_record(&path), from_record(&back));
    // Wherever displacements are counted from, both paths are the same one.
    let apart = |t: f64| home.at(1.0 - t).u - there.at(t).u;
    for t in [0.123, 0.5, 0.77] {
        assert!((apart(t) - apart(0.25)).abs() < 1e-12, "{t}: {} {}", apart(t), apart(0.25));
    }
}

#[test]
fn refining_leaves_the_motion_as_it_was() {
    let raw = record(0.02, 301, |t| (5.0 * t).sin() * (3.0 - t));
    let mut fine = raw.clone();
    process::resample(&mut fine, 0.02 / 7.0).unwrap();
    assert_eq!(fine.npts(), 2101);
    let (v, u) = integrate(raw.dt, &raw.acceleration, 0.0, 0.0);
    let (fine_v, fine_u) = integrate(fine.dt, &fine.acceleration, 0.0, 0.0);
    for k in 0..301 {
        assert!((fine.acceleration[7 * k] - raw.acceleration[k]).abs() < 1e-12);
        assert!((fine_v[7 * k] - v[k]).abs() < 1e-12 && (fine_u[7 * k] - u[k]).abs() < 1e-12);
    }
}

#[test]
fn coarsening_does_not_mirror_high_frequencies() {
    let slow = |t: f64| (2.0 * PI * 2.0 * t).sin();
    let mut mixed = record(0.001, 20_001, |t| slow(t) + (2.0 * PI * 98.0 * t).sin());
    process::resample(&mut mixed, 0.01).unwrap();
    // Unfiltered, 98 Hz would come back as a full 2 Hz wave at 100 samples a second.
    let middle = 200..1800;
    let error = farthest(middle.map(|k| (mixed.acceleration[k], slow(k as f64 * 0.01))));
    let subject = "Ground motion: 2 Hz and 98 Hz at 100 samples a second, largest error";
    agrees!(subject, "2 Hz alone", "m/s²", error, 0.0, abs: 2e-3);
}

#[test]
fn high_pass_by_its_response() {
    // Forward and backward Butterworth: gain 1/(1 + (f_c/f)^{2n}) with pre-warped frequencies.
    let dt = 0.005;
    for (frequency, corner, order) in [(1.0, 1.0, 4), (2.0, 1.0, 4), (0.7, 1.0, 2), (5.0, 0.1, 4)] {
        let steps =
            RecordInput { baseline: Baseline::HighPass { corner: Frequency::from_si(corner), order }, ..input() };
        let wave = record(dt, 20_001, |t| (2.0 * PI * frequency * t).sin());
        let filtered = prepare(wave, &steps).unwrap();
        let warped = |f: f64| (PI * f * dt).tan();
        let gain = 1.0 / (1.0 + (warped(corner) / warped(frequency)).powi(2 * order as i32));
        let found = largest(&filtered.acceleration[6000..14_000]);
        let subject = format!("Ground motion: high pass, gain; order {order} at {corner} Hz, at {frequency} Hz");
        agrees!(subject, "1/(1 + (f_c/f)^2n), frequencies pre-warped", "", found, gain, abs: 1e-3);
    }
    let drift = RecordInput { baseline: Baseline::HighPass { corner: Frequency::from_si(0.5), order: 4 }, ..input() };
    let filtered = prepare(record(dt, 20_001, |_| 1.0), &drift).unwrap();
    assert!(largest(&filtered.acceleration) < 1e-9);
}

/// A part of a record, cut where the base moves fastest: high-passed, it starts and ends at rest where it was, and all that
/// this adds to its acceleration is slow.
#[test]
fn a_cut_record_does_not_drift_when_it_is_high_passed() {
    // 0.5 Hz and 2 Hz under sin² over 40 s: at rest at both ends, and nothing below 0.3 Hz.
    let whole = record(0.005, 8001, |t| {
        let envelope = (PI * t / 40.0).sin().powi(2);
        envelope * (1.0 * (PI * t).sin() + 2.0 * (4.0 * PI * t + 0.7).sin())
    });
    let (v, u) = integrate(whole.dt, &whole.acceleration, 0.0, 0.0);
    // The base is still moving where it is cut, and drifts by decimetres when nothing is done.
    let from = (3200..3600).max_by(|&a, &b| v[a].abs().total_cmp(&v[b].abs())).unwrap();
    let cut = Some([seconds(from as f64 * 0.005), seconds(from as f64 * 0.005 + 12.0)]);
    let drifting = measure(&prepare(whole.clone(), &RecordInput { trim: cut, ..input() }).unwrap());
    assert!(v[from].abs() > 0.3 && drifting.final_displacement.abs() > 2.0, "{drifting:?}");
    for order in [2, 4, 8] {
        let baseline = Baseline::HighPass { corner: Frequency::from_si(0.1), order };
        let done = prepare(whole.clone(), &RecordInput { trim: cut, baseline, ..input() }).unwrap();
        let m = measure(&done);
        assert!(m.final_displacement.abs() < 1e-9 && m.final_velocity.abs() < 1e-9, "{m:?}");
        let (_, moved) = integrate(done.dt, &done.acceleration, 0.0, 0.0);
        let added: Vec<f64> = (0..=2400).map(|k| done.acceleration[k] - whole.acceleration[from + k]).collect();
        let (pga, faster) = (largest(&whole.acceleration), added.windows(2).map(|a| a[1] - a[0]).collect::<Vec<_>>());
        println!("order {order}: {} m of {}, {} m/s2 of {pga}", largest(&moved), largest(&u), largest(&added));
        assert!(largest(&moved) < 0.15 * drifting.final_displacement.abs(), "order {order}: {} m", largest(&moved));
        assert!(largest(&added[5..2396]) < 0.12 * pga, "order {order}: {} m/s2", largest(&added));
        // In 5 ms no more than a slow wave changes: 2 Hz of this amplitude would change by 0.06 of it.
        assert!(largest(&faster[5..2390]) < 0.02 * largest(&added), "order {order}: {} m/s2", largest(&faster));
        assert!((m.pga.value.abs() / pga - 1.0).abs() < 0.08, "order {order}: {}", m.pga.value);
    }
}

#[test]
fn displacement_histories_are_trimmed_refined_and_scaled_as_splines() {
    let options = TextOptions { quantity: HistoryQuantity::Displacement, ..TextOptions::default() };
    let rows: String =
        (0..=100).map(|k| format!("{:.2},{:.9}\n", 0.01 * k as f64, 3.0 + (0.05 * k as f64).sin())).collect();
    let text = format!("t [s], u [mm]\n{rows}");
    let raw = parse(text.as_bytes(), Path::new("file"), &options).unwrap().swap_remove(0);
    let mut fine = raw.clone();
    process::resample(&mut fine, 0.0025).unwrap();
    let (coarse_motion, fine_motion) = (from_record(&raw), from_record(&fine));
    for t in [0.0, 0.123, 0.5, 0.77] {
        assert!((coarse_motion.at(t).u - fine_motion.at(t).u).abs() < 1e-12, "{t}");
        assert!((coarse_motion.at(t).v - fine_motion.at(t).v).abs() < 1e-8, "{t}");
    }
    let steps = RecordInput { scale: Some(2.0), trim: Some([seconds(0.1), seconds(0.6)]), ..input() };
    let part = prepare(raw.clone(), &steps).unwrap();
    assert_eq!(part.displacement.as_ref().unwrap()[0], 2.0 * raw.displacement.as_ref().unwrap()[10]);
    assert_eq!(part.npts(), 51);
    let steps = RecordInput { baseline: Baseline::Polynomial(1), ..input() };
    assert!(prepare(raw, &steps).unwrap_err().to_string().contains("baseline"));
}

#[test]
fn numbers_that_do_not_suit_the_record_are_refused() {
    let raw = || record(0.01, 101, |t| t);
    let high_pass = |corner: f64, order| Baseline::HighPass { corner: Frequency::from_si(corner), order };
    for (steps, key) in [
        (RecordInput { trim: Some([seconds(-0.1), seconds(0.5)]), ..input() }, "trim"),
        (RecordInput { trim: Some([seconds(0.5), seconds(0.5)]), ..input() }, "trim"),
        (RecordInput { trim: Some([seconds(0.5), seconds(1.5)]), ..input() }, "trim"),
        (RecordInput { trim: Some([seconds(f64::NAN), seconds(0.5)]), ..input() }, "trim"),
        (RecordInput { baseline: Baseline::Polynomial(7), ..input() }, "baseline.polynomial"),
        (RecordInput { baseline: high_pass(0.0, 4), ..input() }, "baseline.high_pass"),
        (RecordInput { baseline: high_pass(50.0, 4), ..input() }, "baseline.high_pass"),
        (RecordInput { baseline: high_pass(f64::NAN, 4), ..input() }, "baseline.high_pass"),
        (RecordInput { baseline: high_pass(1.0, 0), ..input() }, "baseline.order"),
        (RecordInput { baseline: high_pass(1.0, 9), ..input() }, "baseline.order"),
        (RecordInput { resample: Some(seconds(0.0)), ..input() }, "resample"),
        (RecordInput { resample: Some(seconds(5.0)), ..input() }, "resample"),
        (RecordInput { resample: Some(seconds(f64::NAN)), ..input() }, "resample"),
        (RecordInput { scale: Some(f64::INFINITY), ..input() }, "scale"),
        (RecordInput { pga: Some(Acceleration::from_si(0.0)), ..input() }, "pga"),
        (RecordInput { pga: Some(Acceleration::from_si(1.0)), scale: Some(1.0), ..input() }, "pga"),
    ] {
        let error = prepare(raw(), &steps).unwrap_err();
        let concio::Error::Input(error) = error else { panic!("{error}") };
        assert_eq!(error.key.as_deref(), Some(key), "{error}");
        assert!(error.allowed.is_some(), "{error}");
    }
    let zero = prepare(record(0.01, 10, |_| 0.0), &RecordInput { pga: Some(Acceleration::from_si(1.0)), ..input() });
    assert!(zero.unwrap_err().to_string().contains("zero throughout"));
    let short = prepare(record(0.01, 10, |t| t), &RecordInput { baseline: high_pass(1.0, 4), ..input() });
    assert!(short.unwrap_err().to_string().contains("too few"));
}

// Runtime motion

fn motion(signal: Signal) -> GroundMotion {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/records");
    compile(&signal, &base).unwrap()
}

fn sine(
    amplitude: Option<f64>,
    acceleration: Option<f64>,
    frequency: f64,
    ramp: f64,
    cycles: Option<f64>,
) -> GroundMotion {
    motion(Signal::Sine(Sine {
        amplitude: amplitude.map(Length::from_si),
        acceleration: acceleration.map(Acceleration::from_si),
        frequency: Frequency::from_si(frequency),
        ramp: seconds(ramp),
        cycles,
    }))
}

fn pulse(shape: PulseShape, peak: f64, duration: f64, start: f64) -> GroundMotion {
    let (acceleration, duration, start) = (Acceleration::from_si(peak), seconds(duration), seconds(start));
    motion(Signal::Pulse(Pulse { shape, acceleration, duration, start }))
}

fn tilt(acceleration: f64, start: f64, rise: f64) -> GroundMotion {
    let (start, rise) = (seconds(start), seconds(rise));
    motion(Signal::Tilt(Tilt { acceleration: Acceleration::from_si(acceleration), start, rise }))
}

fn path(displacements: &[f64], speed: f64) -> GroundMotion {
    let displacements = displacements.iter().copied().map(Length::from_si).collect();
    motion(Signal::Path(DisplacementPath { displacements, speed: Velocity::from_si(speed) }))
}

/// a = A τ/T up to T, then A: v = A τ²/(2 T), u = A τ³/(6 T), beyond T v = A (τ − T/2), u = A (τ²/2 − τ T/2 + T²/6).
#[test]
fn a_tilt_follows_its_closed_form() {
    let (a, start, rise) = (4.905, 0.7, 10.0);
    let motion = tilt(a, start, rise);
    let mut pairs = Vec::new();
    for t in [0.0, 0.3, 0.7, 1.2, 5.0, 10.69, 10.71, 12.0, 40.0] {
        let s = f64::max(t - start, 0.0);
        let expected = if s < rise {
            [a * s.powi(3) / (6.0 * rise), a * s * s / (2.0 * rise), a * s / rise]
        } else {
            [a * (0.5 * s * s - 0.5 * s * rise + rise * rise / 6.0), a * (s - 0.5 * rise), a]
        };
        let now = motion.at(t);
        for (found, expected) in [now.u, now.v, now.a].into_iter().zip(expected) {
            assert!(expected != 0.0 || found == 0.0, "{found} at {t}");
            pairs.push(if expected == 0.0 { (0.0, 0.0) } else { (found / expected, 1.0) });
        }
    }
    let subject = "Ground motion: tilt, u, v and a, largest error over each";
    agrees!(subject, "A τ³/6T, A τ²/2T, A τ/T; after T with what is left", "", farthest(pairs), 0.0, abs: 1e-13);
    assert_eq!([motion.next_break(0.0), motion.next_break(1.0)], [start, start + rise]);
    assert_eq!((motion.end(), motion.next_break(11.0)), (None, f64::INFINITY));
}

/// Corner k lies where the whole way up to it has been gone at the speed.
#[test]
fn a_path_turns_at_its_corners() {
    let (places, speed) = ([1e-3, -1e-3, 2e-3, 1.5e-3], 0.5e-3);
    let motion = path(&places, speed);
    let (mut t, mut way, mut place) = (0.0, 0.0, 0.0);
    for target in places {
        let middle = motion.at((way + 0.5 * f64::abs(target - place)) / speed);
        assert!((middle.u - 0.5 * (place + target)).abs() < 1e-15 && middle.a == 0.0);
        assert_eq!(middle.v, speed.copysign(target - place));
        way += f64::abs(target - place);
        t = motion.next_break(t);
        assert!((t - way / speed).abs() < 1e-12 && (motion.at(t).u - target).abs() < 1e-15, "{t} s");
        place = target;
    }
    assert_eq!((t, motion.end()), (13.0, Some(13.0)));
    let after = motion.at(20.0);
    assert_eq!((after.u, after.v, after.a), (1.5e-3, 0.0, 0.0));
}

/// All motions that are not at rest, with the time over which they are looked at.
fn motions() -> Vec<(&'static str, GroundMotion, f64)> {
    let sweep = |logarithmic| {
        motion(Signal::Sweep(Sweep {
            acceleration: Acceleration::from_si(1.0),
            frequency: [0.5, 4.0].map(Frequency::from_si),
            duration: seconds(5.0),
            logarithmic,
        }))
    };
    let ramp = Ramp { amplitude: Length::from_si(0.01), start: seconds(0.4), rise: seconds(0.5) };
    let synthetic = Synthetic {
        seed: 1,
        pga: Acceleration::from_si(2.0),
        duration: seconds(3.0),
        dt: seconds(0.01),
        corners: [0.15, 0.5, 2.0].map(Time::from_si),
    };
    vec![
        ("sine", sine(Some(0.005), None, 2.0, 0.0, None), 3.0),
        ("ramped sine", sine(Some(0.005), None, 2.0, 0.6, None), 3.0),
        ("sine of 2.3 cycles", sine(Some(0.005), None, 2.0, 0.3, Some(2.3)), 3.0),
        ("sine that ends in its ramp", sine(Some(0.005), None, 2.0, 2.0, Some(2.0)), 3.0),
        ("sine acceleration", sine(None, Some(3.0), 2.0, 0.0, None), 3.0),
        ("ramped sine acceleration", sine(None, Some(3.0), 2.0, 0.7, None), 3.0),
        ("sine acceleration of 3 cycles", sine(None, Some(3.0), 2.0, 0.7, Some(3.0)), 3.0),
        ("ramp", motion(Signal::Ramp(ramp)), 2.0),
        ("tilt", tilt(3.0, 0.4, 0.5), 2.0),
        ("tilt at once", tilt(-3.0, 0.0, 0.5), 2.0),
        ("path", path(&[0.01, -0.01, 0.02], 0.02), 4.0),
        ("rectangular", pulse(PulseShape::Rectangular, 2.0, 0.5, 0.3), 2.0),
        ("half sine", pulse(PulseShape::HalfSine, -2.0, 0.5, 0.3), 2.0),
        ("one sine", pulse(PulseShape::OneSine, 2.0, 0.5, 0.0), 2.0),
        ("Ricker", pulse(PulseShape::Ricker, 2.0, 0.5, 0.2), 3.0),
        ("linear sweep", sweep(false), 6.0),
        ("logarithmic sweep", sweep(true), 6.0),
        ("record", motion(Signal::Record(input())), 3.0),
        ("synthetic", motion(Signal::Synthetic(synthetic)), 4.0),
    ]
}

#[test]
fn velocity_and_acceleration_are_derivatives_within_a_piece() {
    for (name, motion, length) in motions() {
        let mut t = 0.0;
        let mut pieces = 0;
        while t < length {
            let segment = motion.segment(t);
            assert!(segment.end > t && segment.start <= t, "{name} at {t}");
            assert_eq!(segment.end, motion.next_break(t));
            let end = segment.end.min(length);
            for part in [0.1, 0.5, 0.9] {
                let (at, h) = (t + part * (end - t), 1e-4 * (end - t));
                let (before, now, after) = (segment.at(at - h), segment.at(at), segment.at(at + h));
                let slope = |high: f64, low: f64| (high - low) / (2.0 * h);
                let size = now.a.abs() + 40.0 * (now.v.abs() + 40.0 * now.u.abs()) + 1e-6;
                assert!((slope(after.u, before.u) - now.v).abs() < 1e-5 * size, "{name}: v at {at}");
                assert!((slope(after.v, before.v) - now.a).abs() < 1e-3 * size, "{name}: a at {at}");
                assert_eq!(segment.acceleration(at), now.a);
            }
            t = segment.end;
            pieces += 1;
        }
        assert!(pieces < 2100, "{name}");
    }
}

#[test]
fn motions_are_continuous_and_start_from_rest() {
    for (name, motion, length) in motions() {
        let before = motion.at(-0.5);
        assert_eq!((before.u, before.v, before.a), (0.0, 0.0, 0.0), "{name}");
        assert_eq!(motion.at(0.0).u, 0.0, "{name}");
        let mut t = 0.0;
        let mut jumps = Vec::new();
        if motion.velocity_jump(0.0) != 0.0 {
            jumps.push(0.0);
        }
        while motion.next_break(t) < length {
            let segment = motion.segment(t);
            let (left, right) = (segment.at(segment.end), motion.at(segment.end));
            assert!((left.u - right.u).abs() <= 1e-14, "{name}: u jumps at {}", segment.end);
            let jump = motion.velocity_jump(segment.end);
            assert!((right.v - left.v - jump).abs() < 1e-14, "{name}: v at {}", segment.end);
            if jump.abs() > 1e-12 {
                jumps.push(segment.end);
            }
            assert_eq!(motion.velocity_jump(0.5 * (t + segment.end)), 0.0, "{name}");
            t = segment.end;
        }
        // Only motions given as displacements start or stop at once.
        let expected = match name {
            "sine" => vec![0.0],
            "ramped sine" => vec![0.6],
            "sine of 2.3 cycles" => vec![0.3, 1.15],
            "sine that ends in its ramp" => vec![1.0],
            "ramp" => vec![0.4, 0.9],
            "path" => vec![0.0, 0.5, 1.5, 3.0],
            _ => vec![],
        };
        assert_eq!(jumps.len(), expected.len(), "{name}: {jumps:?}");
        assert!(
            jumps.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12),
            "{name}: {jumps:?}"
        );
    }
}

#[test]
fn sines_in_closed_form() {
    let (a, omega) = (0.005, 4.0 * PI);
    let ramped = sine(Some(a), None, 2.0, 0.6, None);
    for t in [0.1, 0.599, 0.6, 1.234, 57.0] {
        let grown = f64::min(1.0, t / 0.6);
        assert!((ramped.at(t).u - a * grown * (omega * t).sin()).abs() < 1e-15, "{t}");
    }
    let accelerated = sine(None, Some(3.0), 2.0, 0.0, None);
    for t in [0.0, 0.01, 0.4, 1.0, 9.9] {
        let k = accelerated.at(t);
        assert!((k.a - 3.0 * (omega * t).sin()).abs() < 1e-13);
        assert!((k.v - 3.0 / omega * (1.0 - (omega * t).cos())).abs() < 1e-14);
        assert!((k.u - 3.0 / omega * (t - (omega * t).sin() / omega)).abs() < 1e-13);
    }
    // The ramped acceleration against its integral by the exact rule on fine samples.
    let ramped = sine(None, Some(3.0), 2.0, 0.7, Some(3.0));
    let fine = record(1e-4, 20_001, |t| match t {
        t if t > 1.5 => 0.0,
        t => 3.0 * f64::min(1.0, t / 0.7) * (omega * t).sin(),
    });
    let (v, u) = integrate(fine.dt, &fine.acceleration, 0.0, 0.0);
    let mut pairs = Vec::new();
    for k in [700, 7000, 12_000, 15_000, 20_000] {
        let now = ramped.at(k as f64 * 1e-4);
        pairs.extend([(now.v, v[k]), (now.u, u[k])]);
    }
    let subject = "Ground motion: sine that grows, v and u, largest error of both";
    agrees!(subject, "integration of samples of 0.1 ms", "m, m/s", farthest(pairs), 0.0, abs: 1e-6);
    assert_eq!((ramped.end(), ramped.sample_interval(), ramped.longest_useful_step()), (Some(1.5), None, 0.025));
}

#[test]
fn pulses_in_closed_form() {
    let rectangle = pulse(PulseShape::Rectangular, 2.0, 0.5, 0.3);
    assert_eq!((rectangle.acceleration(0.3), rectangle.acceleration(0.8)), (2.0, 0.0));
    assert_eq!(rectangle.segment(0.3).acceleration(0.8), 2.0);
    assert_close(rectangle.at(0.8).u, 0.25, 1e-14);
    agrees!(
        "Ground motion: rectangular pulse, u a second after",
        "½ A T² + A T t",
        "m",
        rectangle.at(1.8).u,
        1.25,
        1e-14
    );
    let half = pulse(PulseShape::HalfSine, -2.0, 0.5, 0.3);
    assert_close(half.acceleration(0.55), -2.0, 1e-14);
    let expected = -2.0 * 2.0 * 0.5 / PI;
    agrees!("Ground motion: half sine, v after", "2 A T/π", "m/s", half.at(0.9).v, expected, 1e-14);
    let one = pulse(PulseShape::OneSine, 2.0, 0.5, 0.0);
    assert!(one.at(0.5).v.abs() < 1e-15);
    agrees!("Ground motion: one sine, u after", "A T²/2π", "m", one.at(0.5).u, 2.0 * 0.25 / (2.0 * PI), 1e-13);
    let ricker = pulse(PulseShape::Ricker, 2.0, 0.5, 0.2);
    assert_close(ricker.acceleration(0.95), 2.0, 1e-14);
    // The wavelet crosses zero where 2 π² f² τ² = 1, and its lobes cancel.
    assert!(ricker.acceleration(0.95 + 0.5 / (2.0_f64.sqrt() * PI)).abs() < 1e-12);
    assert!(ricker.at(5.0).v.abs() < 1e-8 && ricker.at(1.7).u.abs() < 1e-8);
    assert_eq!(ricker.end(), Some(1.7));
}

#[test]
fn sweeps_follow_their_phase() {
    for (logarithmic, cycles) in [
        (false, Box::new(|t: f64| 0.5 * t + 0.35 * t * t) as Box<dyn Fn(f64) -> f64>),
        (true, Box::new(|t: f64| 0.5 * 5.0 / 8.0_f64.ln() * (8.0_f64.powf(t / 5.0) - 1.0))),
    ] {
        let name = if logarithmic { "logarithmic sweep" } else { "linear sweep" };
        let (_, sweep, _) = motions().into_iter().find(|m| m.0 == name).unwrap();
        let times = (0..500).map(|k| 0.01 * k as f64);
        let off = farthest(times.map(|t| (sweep.acceleration(t), (2.0 * PI * cycles(t)).sin())));
        let subject = format!("Ground motion: sweep, largest error over its amplitude; {name}");
        agrees!(subject, "sin of its phase", "", off, 0.0, abs: 5e-4);
    }
}

#[test]
fn records_break_at_every_sample_once() {
    let npts = 5001;
    let dt = 0.00244;
    let samples = record(dt, npts, |t| (3.0 * t).sin());
    let motion = from_record(&samples);
    let mut t = 0.0;
    for k in 1..npts {
        let next = motion.next_break(t);
        assert_eq!(next, k as f64 * dt);
        // Just below, at and just above a sample the same break comes next.
        for off in [-0.9e-9, -1e-12, 0.0, 1e-12, 0.9e-9] {
            let expected = if k + 1 < npts { (k + 1) as f64 * dt } else { f64::INFINITY };
            assert_eq!(motion.next_break(next + off * dt), expected, "sample {k}, off by {off}");
        }
        assert_eq!(motion.next_break(next - 1e-3 * dt), next);
        t = next;
    }
    assert_eq!(motion.next_break(t), f64::INFINITY);
    assert_eq!(motion.next_break(-1.0), 0.0);
    assert_eq!((motion.end(), motion.sample_interval()), (Some(5000.0 * dt), Some(dt)));
    let (v, u) = integrate(dt, &samples.acceleration, 0.0, 0.0);
    let after = motion.at(5000.0 * dt + 2.0);
    assert_eq!((after.a, after.v), (0.0, v[5000]));
    assert_close(after.u, u[5000] + 2.0 * v[5000], 1e-12);
    let rest = motion_at_rest();
    assert_eq!((rest.next_break(0.0), rest.at(3.0).u, rest.end()), (f64::INFINITY, 0.0, Some(0.0)));
    assert_eq!(rest.longest_useful_step(), f64::INFINITY);
}

fn motion_at_rest() -> GroundMotion {
    motion(Signal::None)
}

#[test]
fn displacement_history_keeps_its_offset_and_slope() {
    let options = TextOptions { quantity: HistoryQuantity::Displacement, ..TextOptions::default() };
    let rows: String =
        (0..=200).map(|k| format!("{:.2},{:.12}\n", 0.01 * k as f64, 5.0 + (0.04 * k as f64).sin())).collect();
    let text = format!("t [s], u [mm]\n{rows}");
    let motion = from_record(&parse(text.as_bytes(), Path::new("file"), &options).unwrap()[0]);
    assert_eq!((motion.at(-1.0).u, motion.at(-1.0).v), (5e-3, 0.0));
    assert_close(motion.at(0.0).u, 5e-3, 1e-15);
    assert_close(motion.velocity_jump(0.0), 4e-3, 1e-3);
    for t in [0.305, 1.0, 1.7] {
        let now = motion.at(t);
        assert!((now.u - 1e-3 * (5.0 + (4.0 * t).sin())).abs() < 1e-9);
        assert!((now.v - 4e-3 * (4.0 * t).cos()).abs() < 1e-6 && (now.a + 16e-3 * (4.0 * t).sin()).abs() < 1e-4);
    }
}

#[test]
fn signals_out_of_range_are_refused() {
    let refused = |signal: Signal| compile(&signal, Path::new(".")).unwrap_err().to_string();
    let wave = Sine {
        amplitude: Some(Length::from_si(0.1)),
        acceleration: None,
        frequency: Frequency::from_si(1.0),
        ramp: seconds(0.0),
        cycles: None,
    };
    let zero = Frequency::from_si(0.0);
    assert!(refused(Signal::Sine(Sine { frequency: zero, ..wave })).contains("sine.frequency: 0 Hz"));
    assert!(refused(Signal::Sine(Sine { ramp: seconds(-1.0), ..wave })).contains("sine.ramp"));
    assert!(refused(Signal::Sine(Sine { cycles: Some(0.0), ..wave })).contains("sine.cycles"));
    assert!(refused(Signal::Sine(Sine { amplitude: None, ..wave })).contains("sine: give either"));
    assert!(
        refused(Signal::Sine(Sine { acceleration: Some(Acceleration::from_si(1.0)), ..wave }))
            .contains("one of the two")
    );
    let ramp = Ramp { amplitude: Length::from_si(0.1), start: seconds(0.0), rise: seconds(0.0) };
    assert!(refused(Signal::Ramp(ramp)).contains("ramp.rise"));
    let tilt = Tilt { acceleration: Acceleration::from_si(1.0), start: seconds(0.0), rise: seconds(0.0) };
    assert!(refused(Signal::Tilt(tilt)).contains("tilt.rise"));
    let places = |speed: f64, u: &[f64]| DisplacementPath {
        displacements: u.iter().copied().map(Length::from_si).collect(),
        speed: Velocity::from_si(speed),
    };
    assert!(refused(Signal::Path(places(0.0, &[1.0]))).contains("path.speed"));
    assert!(refused(Signal::Path(places(1.0, &[1.0, 1.0]))).contains("other than the one before it"));
    let sweep = Sweep {
        acceleration: Acceleration::from_si(1.0),
        frequency: [1e6, 1.0].map(Frequency::from_si),
        duration: seconds(1e6),
        logarithmic: false,
    };
    assert!(refused(Signal::Sweep(sweep)).contains("sweep.duration"));
    let missing = RecordInput { record: "no such file".into(), ..input() };
    assert!(refused(Signal::Record(missing)).contains("no such file"));
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/records");
    let third = RecordInput { record: "csmip.v2".into(), channel: Some(RecordChannel::Number(3)), ..input() };
    assert_eq!(library::load(&third, &base).unwrap().npts(), 150);
    let up = RecordInput { channel: Some(RecordChannel::Name("360 deg".into())), ..third.clone() };
    assert_eq!(library::load(&up, &base).unwrap(), library::load(&third, &base).unwrap());
    for channel in [RecordChannel::Number(0), RecordChannel::Number(4), RecordChannel::Name("U-D".into())] {
        let error = library::load(&RecordInput { channel: Some(channel), ..third.clone() }, &base).unwrap_err();
        assert!(
            error.to_string().contains("no channel") && error.to_string().contains("3 `CHAN 3: 360 DEG`"),
            "{error}"
        );
    }
}
