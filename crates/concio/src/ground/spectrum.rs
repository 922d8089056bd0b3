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
/// given [s]. Oscillators start at rest and are followed up to the last sample.
///
/// Peaks are those at the ends of the steps, as in published spectra: at most 1 − cos(π/20) = 1.2 % below a peak
/// between them (El Centro, T = 0.5 s, ζ = 2 %: 2.675 in at the samples, 2.688 in between two of them).
/// A period that is not above 0 counts as 0.
pub fn response_spectrum(dt: f64, acceleration: &[f64], damping: f64, periods: &[f64]) -> Spectrum {
    let pga = acceleration.iter().fold(0.0_f64, |peak, a| peak.max(a.abs()));
    let mut spectrum =
        Spectrum { damping, periods: periods.to_vec(), sd: Vec::new(), psv: Vec::new(), psa: Vec::new() };
    for &period in periods {
        let (sd, psv, psa) = if period > RIGID * dt {
            let omega = 2.0 * PI / period;
            let sd = peak_displacement(dt, acceleration, damping, period);
            (sd, omega * sd, omega * omega * sd)
        } else if period > 0.0 {
            let omega = 2.0 * PI / period;
            (pga / (omega * omega), pga / omega, pga)
        } else {
            (0.0, 0.0, pga)
        };
        spectrum.sd.push(sd);
        spectrum.psv.push(psv);
        spectrum.psa.push(psa);
    }
    spectrum
}

/// Sd of one oscillator.
fn peak_displacement(dt: f64, acceleration: &[f64], damping: f64, period: f64) -> f64 {
    let parts = (STEPS_PER_PERIOD * dt / period).ceil().max(1.0);
    let h = dt / parts;
    let step = Step::new(h, 2.0 * PI / period, damping);
    let (mut u, mut v, mut peak) = (0.0_f64, 0.0_f64, 0.0_f64);
    for pair in acceleration.windows(2) {
        let slope = (pair[1] - pair[0]) / parts;
        for part in 0..parts as usize {
            let a0 = pair[0] + slope * part as f64;
            let (u1, v1) = step.advance(u, v, a0, a0 + slope);
            peak = peak.max(u1.abs());
            (u, v) = (u1, v1);
        }
    }
    peak
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

    #[inline]
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
