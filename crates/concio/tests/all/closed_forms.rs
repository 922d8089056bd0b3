//! The integration against closed forms. Numbers of the form A1, A2 … are those of the project's reference
//! collection of closed forms; each is also computed here from its formula, so that nothing rests on a copied digit.

use std::f64::consts::PI;

use concio::case::{Pulse, PulseShape, Ramp, Scheme, Signal, Solver};
use concio::excitation::Excitation;
use concio::ground::signal::{GroundMotion, compile};
use concio::record::StopReason;
use concio::samples::{Histories, Link, lumped, respond, shaking, sharp_friction, solver};
use concio::wall::End;
use concio_verified::{agrees, farthest};

const M: f64 = 100.0;
const K: f64 = 4e5;
const N: f64 = 981.0;

fn fine() -> Solver {
    solver(Scheme::Esdirk4, 1e-9)
}

fn at_rest(duration: f64) -> Excitation {
    Excitation::of_base(GroundMotion::AtRest, duration)
}

fn first(h: &Histories) -> Vec<f64> {
    h.displacement.iter().map(|row| row[0]).collect()
}

/// Values at turning points of a history, by a parabola through the three samples around each.
fn turning_points(x: &[f64]) -> Vec<f64> {
    let turns = |w: &[f64]| (w[1] - w[0]) * (w[2] - w[1]) < 0.0;
    let peak = |w: &[f64]| {
        let (d1, d2) = (0.5 * (w[2] - w[0]), w[2] - 2.0 * w[1] + w[0]);
        w[1] - 0.5 * d1 * d1 / d2
    };
    x.windows(3).filter(|w| turns(w)).map(peak).collect()
}

/// A1: x = x0 e^{−ζωt} (cos ω_d t + ζω/ω_d sin ω_d t).
#[test]
fn free_decay() {
    let (zeta, x0) = (0.05, 1e-3);
    let omega = (K / M).sqrt();
    let model = lumped(&[M], &[Link::spring(0, End::Base, K, 2.0 * zeta * M * omega)], at_rest(0.5));
    for (scheme, tolerance, allowed) in [(Scheme::Esdirk4, 1e-9, 1e-6), (Scheme::TrBdf2, 1e-9, 1e-5)] {
        let h = respond(&model, &solver(scheme, tolerance), 0.01, &[x0], &[0.0]).unwrap();
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        let exact = |t: f64| {
            let decay = (-zeta * omega * t).exp();
            x0 * decay * ((damped * t).cos() + zeta * omega / damped * (damped * t).sin())
        };
        let off = farthest(first(&h).iter().enumerate().map(|(k, x)| (x / x0, exact(k as f64 * 0.01) / x0)));
        let subject = format!("Integration: free decay over 0.5 s, largest error over x₀; {scheme:?}");
        agrees!(subject, "x₀ e^(−ζωt) (cos ω_d t + ζω/ω_d sin ω_d t)", "", off, 0.0, abs: allowed);
        assert_eq!(h.displacement.len(), 51);
        assert!(h.residual < 10.0 * allowed, "energy residual {}", h.residual);
    }
}

/// A2: steady amplitude of the relative displacement under base acceleration 1 m/s² sin(Ωt),
/// (m A/k) / √((1 − r²)² + (2ζr)²); and a force F0 as the base acceleration F0/m.
#[test]
fn harmonic_response() {
    let zeta = 0.05;
    let omega = (K / M).sqrt();
    let listed = [0.0003325950526188697, 0.0011891287353862354, 0.0025, 0.0010545613515239936, 8.314876315471742e-05];
    for (r, listed) in [0.5, 0.9, 1.0, 1.1, 2.0].into_iter().zip(listed) {
        let frequency = r * omega / (2.0 * PI);
        // After 8 s the transient has decayed by e^{-25}.
        let duration = 8.0 + 2.0 / frequency;
        let motion = Excitation::of_base(shaking(1.0, frequency).unwrap(), duration);
        let model = lumped(&[M], &[Link::spring(0, End::Base, K, 2.0 * zeta * M * omega)], motion);
        let h = respond(&model, &solver(Scheme::Esdirk4, 1e-8), duration / 20000.0, &[0.0], &[0.0]).unwrap();
        let x = first(&h);
        let tail = &x[(8.0 / duration * 20000.0) as usize..];
        let amplitude = turning_points(tail).iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let exact = 1.0 / (omega * omega) / ((1.0 - r * r).powi(2) + (2.0 * zeta * r).powi(2)).sqrt();
        assert!((exact - listed).abs() < 1e-12);
        let subject = format!("Integration: steady amplitude under a sine; r = {r}");
        agrees!(subject, "m A/k / √((1 − r²)² + (2ζr)²)", "m", amplitude, exact, 1e-6);
    }
}

/// A3: amplitudes fall by 2μN/k each half cycle; the regularised law must give each within 1 % of the first.
#[test]
fn coulomb_decrement() {
    let (mu, x0) = (0.3, 0.012);
    let law = sharp_friction(mu, mu, 1e-4, 100.0);
    let links = [Link::spring(0, End::Base, K, 0.0), Link::friction(0, End::Base, law, N)];
    let model = lumped(&[M], &links, at_rest(0.39));
    let h = respond(&model, &solver(Scheme::TrBdf2, 1e-6), 1e-4, &[x0], &[0.0]).unwrap();
    let turns = turning_points(&first(&h));
    let loss = 2.0 * mu * N / K;
    assert!(turns.len() >= 7, "{turns:?}");
    let exact = |k: usize| (x0 - (k + 1) as f64 * loss) * if k.is_multiple_of(2) { -1.0 } else { 1.0 };
    let off = farthest(turns.iter().take(7).enumerate().map(|(k, turn)| (turn / exact(k), 1.0)));
    let subject = "Friction: regularised law beside a spring, amplitudes of 7 half cycles, largest error over each";
    agrees!(subject, "x₀ − 2 n μN/k", "", off, 0.0, abs: 0.01);
    assert!(h.residual < 1e-4, "energy residual {}", h.residual);
}

fn belt(speed: f64, duration: f64) -> Excitation {
    let ramp = Ramp { amplitude: (speed * 100.0).into(), start: 0.0.into(), rise: 100.0.into() };
    Excitation::of_top(compile(&Signal::Ramp(ramp), std::path::Path::new("")).unwrap(), duration)
}

/// A4: a block on a belt of 0.05 m/s with μ_s 0.6, μ_k 0.4 and a sharp drop: period, largest displacement.
#[test]
fn stick_slip_belt() {
    let (mu_s, mu_k, v) = (0.6, 0.4, 0.05f64);
    // The largest value of (6) falls short of μ_s by about √(1/β): a sharp release needs a large β.
    let law = sharp_friction(mu_s, mu_k, 2e-4, 1e6);
    let links = [Link::spring(0, End::Base, K, 0.0), Link::friction(0, End::Top, law, N)];
    let model = lumped(&[M], &links, belt(v, 1.0));
    let h = respond(&model, &solver(Scheme::TrBdf2, 1e-5), 1e-4, &[mu_k * N / K], &[v]).unwrap();
    let x = first(&h);
    let (release, centre) = (mu_s * N / K, mu_k * N / K);
    let omega = (K / M).sqrt();
    let amplitude = ((release - centre).powi(2) + (v / omega).powi(2)).sqrt();
    let slip = (2.0 * PI - 2.0 * ((release - centre) * omega / v).atan()) / omega;
    let period = slip + 2.0 * (release - centre) / v;
    assert!((period - 0.10140535380222271f64).abs() < 1e-14, "A4's T_total");
    let peaks: Vec<usize> =
        (1..x.len() - 1).filter(|&i| x[i] > x[i - 1] && x[i] >= x[i + 1] && x[i] > release).collect();
    assert!(peaks.len() >= 8, "{peaks:?}");
    let measured = (peaks[peaks.len() - 1] - peaks[1]) as f64 * 1e-4 / (peaks.len() - 2) as f64;
    let against = "sticking to μ_s N/k, then a half wave about μ_k N/k";
    agrees!("Friction: regularised law, block on a belt, period", against, "s", measured, period, 0.01);
    let largest = x.iter().fold(0.0f64, |a, x| a.max(*x));
    agrees!("Friction: regularised law, block on a belt, peak", against, "m", largest, centre + amplitude, 0.01);
}

/// A4b: steady sliding loses stability where c + N dμ/dv = 0, at v = v_s ln(N (μ_s − μ_k)/(c v_s)); on either side a
/// small oscillation grows or decays as e^{−(c + N μ')t/2m}.
#[test]
fn stability_limit_of_steady_sliding() {
    let (mu_s, mu_k, v_s, c) = (0.6, 0.4, 0.1f64, 200.0);
    let law = sharp_friction(mu_s, mu_k, v_s, 1e7);
    let critical = v_s * (N * (mu_s - mu_k) / (c * v_s)).ln();
    assert!((critical - 0.2283402273577272).abs() < 1e-12);
    let links = [Link::spring(0, End::Base, K, c), Link::friction(0, End::Top, law, N)];
    let t = 5.8;
    for v in [0.2f64, critical, 0.26] {
        let slope = -(mu_s - mu_k) / v_s * (-v / v_s).exp();
        let steady = N * (mu_k + (mu_s - mu_k) * (-v / v_s).exp()) / K;
        let model = lumped(&[M], &links, belt(v, t));
        let start = steady * 1e-4;
        let h = respond(&model, &solver(Scheme::Esdirk4, 1e-10), 1e-3, &[steady + start], &[0.0]).unwrap();
        let swing: Vec<f64> = first(&h).iter().map(|x| x - steady).collect();
        let end = swing[swing.len() - 150..].iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let begin = swing[..100].iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let exact = (-(c + N * slope) / (2.0 * M) * (t - 0.15)).exp();
        let subject = format!("Friction: falling law, swing about steady sliding, growth in 5.65 s; at {v:.3} m/s");
        agrees!(subject, "e^(−(c + N dμ/dv) t/2m)", "", end / begin, exact, 0.05);
    }
}

fn newmark(shape: PulseShape, duration: f64) -> f64 {
    let pulse = Pulse { shape, acceleration: 4.905.into(), duration: 0.2.into(), start: 0.0.into() };
    let motion = compile(&Signal::Pulse(pulse), std::path::Path::new("")).unwrap();
    let law = sharp_friction(0.2, 0.2, 1e-4, 100.0);
    let model = lumped(&[M], &[Link::friction(0, End::Base, law, M * 9.81)], Excitation::of_base(motion, duration));
    let h = respond(&model, &solver(Scheme::TrBdf2, 1e-5), duration / 1000.0, &[0.0], &[0.0]).unwrap();
    assert_eq!(h.stop_reason, StopReason::Completed);
    first(&h).last().unwrap().abs()
}

/// A6: slip of a rigid block (μ 0.2) under pulses of 0.5 g and 0.2 s: 0.14715 m (rectangle, V²/2 (1/(μg) − 1/A)),
/// 0.04495112308557409 m (half sine).
#[test]
fn newmark_pulses() {
    let v: f64 = 4.905 * 0.2;
    let rectangle: f64 = 0.5 * v * v * (1.0 / (0.2 * 9.81) - 1.0 / 4.905);
    assert!((rectangle - 0.14715).abs() < 1e-12);
    for (shape, exact) in [(PulseShape::Rectangular, rectangle), (PulseShape::HalfSine, 0.04495112308557409)] {
        let slip = newmark(shape, 0.6);
        let subject = format!("Friction: regularised law, slip under a pulse of 0.5 g; {shape:?}");
        agrees!(subject, "Newmark's sliding block", "m", slip, exact, 0.01);
    }
}

/// A9: a spring on one side, two on the other: T = π (1/ω1 + 1/ω2), and the amplitudes on the two sides relate as
/// √((k1 + k2)/k1).
#[test]
fn bilinear_no_tension_oscillator() {
    let links = [Link::spring(0, End::Base, K, 0.0), Link::unilateral(0, End::Base, 4.0 * K)];
    let (w1, w2) = ((K / M).sqrt(), (5.0 * K / M).sqrt());
    let period = PI / w1 + PI / w2;
    assert!((period - 0.07188735601977234).abs() < 1e-14);
    let cycles = 10.0;
    let model = lumped(&[M], &links, at_rest(cycles * period));
    let h = respond(&model, &fine(), period / 400.0, &[-1e-3], &[0.0]).unwrap();
    let x = first(&h);
    let last = x.last().unwrap();
    let subject = "Integration: a spring on one side, two on the other, x after ten periods of π/ω₁ + π/ω₂";
    agrees!(subject, "x₀", "m", *last, -1e-3, 1e-6);
    // The velocity there says how far the phase is off.
    let phase = h.velocity.last().unwrap()[0] / (w1 * 1e-3) / (cycles * period * w1);
    assert!(phase.abs() < 1e-6, "phase {phase}");
    let other = turning_points(&x).iter().fold(0.0f64, |a, x| a.max(*x));
    let subject = "Integration: a spring on one side, two on the other, ratio of amplitudes";
    agrees!(subject, "√((k₁ + k₂)/k₁)", "", 1e-3 / other, 5.0f64.sqrt(), 1e-6);
    assert!(h.residual < 1e-6);
}

/// A10: ten masses fixed-free: each mode ω_j = 2√(k/m) sin((2j − 1)π/42), as one period of its own shape returns.
#[test]
fn chain_frequencies() {
    let (n, m, k) = (10, 50.0, 2e6f64);
    let mut links = vec![Link::spring(0, End::Base, k, 0.0)];
    links.extend((1..n).map(|i| Link::spring(i, End::Block(i - 1), k, 0.0)));
    let listed = [29.8920374345697, 395.53233049005144];
    let mut pairs = Vec::new();
    for j in 1..=n {
        let listed = [1, n].iter().position(|&end| end == j).map(|end| listed[end]);
        let angle: f64 = (2 * j - 1) as f64 * PI / 42.0;
        let omega = 2.0 * (k / m).sqrt() * angle.sin();
        assert!(listed.is_none_or(|l| (omega / l - 1.0).abs() < 1e-12));
        let shape: Vec<f64> = (1..=n).map(|i| 1e-3 * (2.0 * angle * i as f64).sin()).collect();
        let model = lumped(&vec![m; n], &links, at_rest(2.0 * PI / omega));
        let h = respond(&model, &fine(), PI / omega / 2.0, &shape, &vec![0.0; n]).unwrap();
        let end = h.displacement.last().unwrap();
        let velocity = h.velocity.last().unwrap();
        for i in 0..n {
            pairs.push((end[i] / 1e-3, shape[i] / 1e-3));
            assert!(velocity[i].abs() < 1e-6 * omega * 1e-3 * 2.0 * PI, "mode {j} mass {i}");
        }
    }
    let subject = "Integration: ten masses in a row, every mode after its period, largest error over x₀";
    agrees!(subject, "its shape, ω_j = 2 √(k/m) sin((2j − 1)π/42)", "", farthest(pairs), 0.0, abs: 1e-6);
}

/// The error of x falls with the fixed step as h^order.
#[test]
fn order_of_convergence() {
    let (zeta, x0, end) = (0.05f64, 1e-3, 0.3);
    let omega = (K / M).sqrt();
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let model = lumped(&[M], &[Link::spring(0, End::Base, K, 2.0 * zeta * M * omega)], at_rest(end));
    let decay = (-zeta * omega * end).exp();
    let exact = x0 * decay * ((damped * end).cos() + zeta * omega / damped * (damped * end).sin());
    for (scheme, order, steps) in [(Scheme::TrBdf2, 2.0, 200.0), (Scheme::Esdirk4, 4.0, 60.0)] {
        let error = |steps: f64| {
            // A tolerance that accepts everything leaves the longest step in charge.
            let fixed = Solver { tolerance: 1e6, max_step: Some((end / steps).into()), ..solver(scheme, 1.0) };
            let h = respond(&model, &fixed, end, &[x0], &[0.0]).unwrap();
            (first(&h).last().unwrap() - exact).abs()
        };
        let (coarse, fine) = (error(steps), error(2.0 * steps));
        let measured = (coarse / fine).log2();
        let subject = format!("Integration: order at fixed steps; {scheme:?}");
        agrees!(subject, "order of the scheme", "", measured, order, abs: 0.2);
    }
}
