//! Response spectrum of a piecewise-linear acceleration.
//!
//! Equations: the relative displacement u of an oscillator obeys ü + 2ζω u̇ + ω² u = −a(t). With a linear over a
//! step h the solution at its end is linear in (u, u̇) at its start and in a at both ends (Nigam and Jennings 1969):
//!
//! (S1)  (u, u̇)₁ = A (u, u̇)₀ + B (a₀, a₁)
//!
//! The coefficients are summed from the Taylor series of the exact solution,
//! c₍ₖ₊₂₎ (k+2)(k+1) = −2ζω (k+1) c₍ₖ₊₁₎ − ω² cₖ − aₖ, because their closed form loses digits as ωh → 0. Steps are
//! subdivided to h ≤ T/20, which bounds ωh by 0.32, so that few terms reach round-off.

use std::f64::consts::PI;

use serde::Serialize;

/// Steps in a period, at least.
const STEPS_PER_PERIOD: f64 = 20.0;
/// Periods below this fraction of the sample interval are taken as rigid: the free part of the response is below
/// this fraction of the peak there.
const RIGID: f64 = 1e-3;
/// Oscillators that are followed side by side: each waits for its own last step only, and they fill the lanes of vector instructions.
const LANES: usize = 8;

/// Peaks of oscillators.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Spectrum {
    /// Damping ratio ζ.
    pub damping: f64,
    /// Natural periods T [s].
    pub periods: Vec<f64>,
    /// Largest |relative displacement| [m].
    pub sd: Vec<f64>,
    /// Pseudo-velocity ω Sd [m/s].
    pub psv: Vec<f64>,
    /// Pseudo-acceleration ω² Sd [m/s²]; the peak ground acceleration at T = 0.
    pub psa: Vec<f64>,
}

/// Response spectrum of `acceleration` [m/s²] at samples `dt` [s] apart, for damping ratio ζ ≥ 0 and the periods
/// given [s]. Oscillators start at rest, and go on to swing when the motion has ended after the last sample.
///
/// Peaks are those between the samples, where the velocity is 0: up to 1.2 % above those at the samples that published spectra have (El Centro, T = 0.5 s,
/// ζ = 2 %: 2.675 in at the samples, 2.688 in between two of them). A period that is not above 0 counts as 0.
pub fn response_spectrum(dt: f64, acceleration: &[f64], damping: f64, periods: &[f64]) -> Spectrum {
    spectrum::<true>(dt, acceleration, damping, periods)
}

/// The same at the samples alone, and up to the last: what synthetic motions are matched by.
pub(crate) fn spectrum_at_samples(dt: f64, acceleration: &[f64], damping: f64, periods: &[f64]) -> Spectrum {
    spectrum::<false>(dt, acceleration, damping, periods)
}

/// Either of both, `WHOLE` with the peaks between samples and after the last.
fn spectrum<const WHOLE: bool>(dt: f64, acceleration: &[f64], damping: f64, periods: &[f64]) -> Spectrum {
    let pga = acceleration.iter().fold(0.0_f64, |peak, a| peak.max(a.abs()));
    let peaks = peak_displacements::<WHOLE>(dt, acceleration, damping, periods);
    let mut spectrum = Spectrum { damping, periods: periods.to_vec(), sd: peaks, psv: Vec::new(), psa: Vec::new() };
    for (&period, sd) in periods.iter().zip(&mut spectrum.sd) {
        let omega = 2.0 * PI / period;
        let (found, psv, psa) = if period > RIGID * dt {
            (*sd, omega * *sd, omega * omega * *sd)
        } else if period > 0.0 {
            (pga / (omega * omega), pga / omega, pga)
        } else {
            (0.0, 0.0, pga)
        };
        *sd = found;
        spectrum.psv.push(psv);
        spectrum.psa.push(psa);
    }
    spectrum
}

/// Sd of oscillators, 0 for those that are rigid.
fn peak_displacements<const WHOLE: bool>(dt: f64, acceleration: &[f64], damping: f64, periods: &[f64]) -> Vec<f64> {
    let parts = |period: f64| (STEPS_PER_PERIOD * dt / period).ceil().max(1.0);
    let mut peaks = vec![0.0; periods.len()];
    let soft: Vec<usize> = (0..periods.len()).filter(|&k| periods[k] > RIGID * dt).collect();
    // Neighbours are mostly divided into the same parts.
    for alike in soft.chunk_by(|&a, &b| parts(periods[a]) == parts(periods[b])) {
        for some in alike.chunks(LANES) {
            let divided = parts(periods[some[0]]);
            let step =
                |lane: usize| Step::new(dt / divided, 2.0 * PI / periods[some[lane.min(some.len() - 1)]], damping);
            let found = follow::<WHOLE>(acceleration, dt, divided, &std::array::from_fn(step));
            for (&k, (peak, end)) in some.iter().zip(found) {
                let after = if WHOLE { free_peak(end, 2.0 * PI / periods[k], damping) } else { 0.0 };
                peaks[k] = peak.max(after);
            }
        }
    }
    peaks
}

/// Largest |displacement| of an oscillator that swings freely from a displacement and a velocity: at its first turn, the next ones are smaller.
fn free_peak([u, v]: [f64; 2], omega: f64, damping: f64) -> f64 {
    if damping >= 1.0 {
        // It turns once at most: u e^(r t) + … of both roots, or of one that is double.
        let root = omega * (damping * damping - 1.0).sqrt();
        let [slow, fast] = [root, -root].map(|root| root - damping * omega);
        let (turn, at): (f64, Box<dyn Fn(f64) -> f64>) = if root > 0.0 {
            let second = (v - slow * u) / (fast - slow);
            let first = u - second;
            let turn = (-second * fast / (first * slow)).ln() / (slow - fast);
            (turn, Box::new(move |t| first * (slow * t).exp() + second * (fast * t).exp()))
        } else {
            let rises = v + omega * u;
            (v / (omega * rises), Box::new(move |t| (u + rises * t) * (-omega * t).exp()))
        };
        return if turn > 0.0 && turn.is_finite() { at(turn).abs().max(u.abs()) } else { u.abs() };
    }
    let damped = omega * (1.0 - damping * damping).sqrt();
    let turn = (v * damped).atan2(omega * omega * u + damping * omega * v);
    let time = turn.rem_euclid(PI) / damped;
    let sine = (v + damping * omega * u) / damped;
    let (sin, cos) = (damped * time).sin_cos();
    ((-damping * omega * time).exp() * (u * cos + sine * sin)).abs()
}

/// Largest |displacement| of oscillators that start at rest, each step of `dt` of the record in that many parts, and displacement and velocity at its end.
fn follow<const WHOLE: bool>(
    acceleration: &[f64],
    dt: f64,
    parts: f64,
    steps: &[Step; LANES],
) -> [(f64, [f64; 2]); LANES] {
    let half = 0.5 * dt / parts;
    let lanes = |of: fn(&Step) -> f64| -> [f64; LANES] { std::array::from_fn(|lane| of(&steps[lane])) };
    let [uu, uv, ua, ub] = [lanes(|s| s.a[0][0]), lanes(|s| s.a[0][1]), lanes(|s| s.b[0][0]), lanes(|s| s.b[0][1])];
    let [vu, vv, va, vb] = [lanes(|s| s.a[1][0]), lanes(|s| s.a[1][1]), lanes(|s| s.b[1][0]), lanes(|s| s.b[1][1])];
    let (mut u, mut v, mut peak) = ([0.0_f64; LANES], [0.0_f64; LANES], [0.0_f64; LANES]);
    for pair in acceleration.windows(2) {
        let slope = (pair[1] - pair[0]) / parts;
        for part in 0..parts as usize {
            let a0 = pair[0] + slope * part as f64;
            let a1 = a0 + slope;
            for k in 0..LANES {
                let next = uu[k] * u[k] + uv[k] * v[k] + ua[k] * a0 + ub[k] * a1;
                let after = vu[k] * u[k] + vv[k] * v[k] + va[k] * a0 + vb[k] * a1;
                peak[k] = peak[k].max(next.abs());
                if WHOLE {
                    // It turns where the velocity, straight over the part, is 0.
                    let turns = v[k] * after < 0.0;
                    let turn = u[k] + half * v[k] * (v[k] / (v[k] - after));
                    peak[k] = peak[k].max(if turns { turn.abs() } else { 0.0 });
                }
                (u[k], v[k]) = (next, after);
            }
        }
    }
    std::array::from_fn(|k| (peak[k], [u[k], v[k]]))
}

/// Coefficients of (S1).
struct Step {
    a: [[f64; 2]; 2],
    b: [[f64; 2]; 2],
}

impl Step {
    fn new(h: f64, omega: f64, damping: f64) -> Self {
        let (c, k) = (2.0 * damping * omega * h, omega * omega * h * h);
        // Unit initial values in turn; time in steps, so velocities are h times the true ones.
        let from_u = series(c, k, [1.0, 0.0], [0.0, 0.0]);
        let from_v = series(c, k, [0.0, 1.0], [0.0, 0.0]);
        let constant = series(c, k, [0.0, 0.0], [1.0, 0.0]);
        let slope = series(c, k, [0.0, 0.0], [0.0, 1.0]);
        let square = h * h;
        Step {
            a: [[from_u[0], from_v[0] * h], [from_u[1] / h, from_v[1]]],
            b: [[(constant[0] - slope[0]) * square, slope[0] * square], [(constant[1] - slope[1]) * h, slope[1] * h]],
        }
    }

    #[cfg(test)]
    fn advance(&self, u: f64, v: f64, a0: f64, a1: f64) -> (f64, f64) {
        let row = |a: &[f64; 2], b: &[f64; 2]| a[0] * u + a[1] * v + b[0] * a0 + b[1] * a1;
        (row(&self.a[0], &self.b[0]), row(&self.a[1], &self.b[1]))
    }
}

/// Value and slope at s = 1 of u'' + c u' + k u = −(load₀ + load₁ s), from the Taylor series about s = 0.
fn series(c: f64, k: f64, start: [f64; 2], load: [f64; 2]) -> [f64; 2] {
    let [mut low, mut high] = start;
    let (mut value, mut slope) = (low + high, high);
    for order in 0..60 {
        let n = order as f64;
        let load = load.get(order).copied().unwrap_or(0.0);
        let next = (-load - c * (n + 1.0) * high - k * low) / ((n + 1.0) * (n + 2.0));
        value += next;
        slope += (n + 2.0) * next;
        (low, high) = (high, next);
        if order > 2 && low.abs().max(high.abs()) * (n + 2.0) < 1e-18 {
            break;
        }
    }
    [value, slope]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of Nigam and Jennings as Chopra tabulates them (Dynamics of Structures, table 5.2.1), for a unit
    /// mass under the load p = −a.
    fn closed_form(h: f64, omega: f64, z: f64) -> [f64; 4] {
        let root = (1.0 - z * z).sqrt();
        let (sin, cos) = (omega * root * h).sin_cos();
        let decay = (-z * omega * h).exp();
        let (k, s) = (omega * omega, 2.0 * z / (omega * h));
        let a = decay * (z / root * sin + cos);
        let b = decay * sin / (omega * root);
        let c = (s + decay * (((1.0 - 2.0 * z * z) / (omega * root * h) - z / root) * sin - (1.0 + s) * cos)) / k;
        let d = (1.0 - s + decay * ((2.0 * z * z - 1.0) / (omega * root * h) * sin + s * cos)) / k;
        [a, b, -c, -d]
    }

    #[test]
    fn coefficients_are_those_of_the_closed_form() {
        for (h, omega, damping) in [(0.02, 12.0, 0.05), (0.01, 30.0, 0.0), (0.05, 6.0, 0.7)] {
            let step = Step::new(h, omega, damping);
            let found = [step.a[0][0], step.a[0][1], step.b[0][0], step.b[0][1]];
            for (found, expected) in found.iter().zip(closed_form(h, omega, damping)) {
                assert!((found - expected).abs() < 1e-12 * expected.abs().max(h * h), "{found} {expected}");
            }
        }
    }

    /// Side by side or alone, to the last bit; the periods are divided into different parts, and one group is not full.
    #[test]
    fn oscillators_side_by_side_are_those_alone() {
        let motion: Vec<f64> = (0..400).map(|k| (0.37 * k as f64).sin() * (-0.01 * k as f64).exp()).collect();
        let periods: Vec<f64> = (1..40).map(|k| 0.015 * k as f64).collect();
        let together = response_spectrum(0.01, &motion, 0.05, &periods);
        for (k, &period) in periods.iter().enumerate() {
            let parts = (STEPS_PER_PERIOD * 0.01 / period).ceil().max(1.0);
            let step = Step::new(0.01 / parts, 2.0 * PI / period, 0.05);
            let (mut u, mut v, mut peak) = (0.0, 0.0, 0.0_f64);
            for pair in motion.windows(2) {
                let slope = (pair[1] - pair[0]) / parts;
                for part in 0..parts as usize {
                    let a0 = pair[0] + slope * part as f64;
                    (u, v) = step.advance(u, v, a0, a0 + slope);
                    peak = peak.max(u.abs());
                }
            }
            assert_eq!(spectrum_at_samples(0.01, &motion, 0.05, &[period]).sd[0], peak, "{period}");
            assert_eq!(response_spectrum(0.01, &motion, 0.05, &[period]).sd[0], together.sd[k], "{period}");
            assert!(together.sd[k] >= peak && (together.sd[k] < 1.0125 * peak || period > 0.3), "{period}");
        }
    }

    #[test]
    fn many_short_steps_make_a_long_one() {
        let (omega, damping, parts) = (3.0, 0.05, 64);
        let (whole, part) = (Step::new(0.1, omega, damping), Step::new(0.1 / parts as f64, omega, damping));
        let (mut u, mut v) = (0.01, -0.2);
        let expected = whole.advance(u, v, 1.5, -0.5);
        for k in 0..parts {
            let a = |k: usize| 1.5 - 2.0 * k as f64 / parts as f64;
            (u, v) = part.advance(u, v, a(k), a(k + 1));
        }
        assert!((u - expected.0).abs() < 1e-15 && (v - expected.1).abs() < 1e-14, "{u} {v} {expected:?}");
    }
}
