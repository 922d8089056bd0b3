//! Dry friction: (6a) and (6b) for the laws that stick truly, or
//! (6) μ(v) = (2/π) arctan(β v/δ_v) [(μ_s − μ_d) e^{−|v|/δ_v} + μ_d] + α |v| v.

use std::f64::consts::FRAC_2_PI;
use std::ops::{Add, Mul};

use crate::elementary::{Number, exp_of_negative};

/// Velocity-dependent dry friction (6).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stribeck {
    /// μ_s.
    pub static_: f64,
    /// μ_d.
    pub dynamic: f64,
    /// δ_v [m/s].
    pub slip_velocity: f64,
    /// β; infinite for the set-valued law, which sticks truly: at rest any |μ| ≤ μ_s, in slip (6) without its first
    /// factor. With δ_v = 0 besides, slip has μ_d at once (Coulomb).
    pub beta: f64,
    /// α [s²/m²].
    pub alpha: f64,
}

impl Stribeck {
    /// Whether the law is set-valued at rest.
    pub fn sticks(&self) -> bool {
        self.beta.is_infinite()
    }

    /// Whether friction falls from μ_s at once as slip begins.
    pub fn drops(&self) -> bool {
        self.sticks() && self.in_slip(0.0).0 < self.static_
    }

    /// Whether a joint at rest bears more than one that slides.
    pub fn holds(&self) -> bool {
        self.sticks() && self.dynamic < self.static_
    }

    /// μ(v) and dμ/dv [s/m] at v [m/s]; odd in v. At rest a set-valued law has no one value: 0 stands for it.
    #[inline(always)]
    pub fn at(&self, v: f64) -> (f64, f64) {
        let speed = v.abs();
        if self.sticks() {
            let (level, slope) = self.in_slip(speed);
            return (if v == 0.0 { 0.0 } else { level.copysign(v) }, slope);
        }
        let Stribeck { static_, dynamic, slip_velocity, beta, alpha } = *self;
        let law = Smooth { excess: static_ - dynamic, dynamic, slip_velocity, steep: beta / slip_velocity, alpha };
        let (value, slope) = law.at(speed);
        (value.copysign(v), slope)
    }

    /// Of the set-valued laws (6a) and (6b): |μ| at the speed [m/s] of a slip, and its slope [s/m].
    pub fn in_slip(&self, speed: f64) -> (f64, f64) {
        let (decay, falling) = if self.slip_velocity > 0.0 {
            let decay = (self.static_ - self.dynamic) * exp_of_negative(speed / self.slip_velocity);
            (decay, decay / self.slip_velocity)
        } else {
            (0.0, 0.0)
        };
        (decay + self.dynamic + self.alpha * speed * speed, 2.0 * self.alpha * speed - falling)
    }

    /// The law of a part of the joint, `share` of it from 0 to 1: (6) is linear in its coefficients.
    pub fn times(&self, share: f64) -> Stribeck {
        let (static_, dynamic, alpha) = (share * self.static_, share * self.dynamic, share * self.alpha);
        Stribeck { static_, dynamic, alpha, ..*self }
    }

    /// μ(v) alone.
    #[inline]
    pub fn value(&self, v: f64) -> f64 {
        self.at(v).0
    }

    /// Slope at rest, (2/π) β μ_s/δ_v [s/m]: the steepest.
    pub fn slope_at_rest(&self) -> f64 {
        FRAC_2_PI * self.beta / self.slip_velocity * self.static_
    }
}

/// The numbers of (6) as it is computed, of one joint or of several in the lanes of a vector.
#[derive(Debug, Clone, Copy)]
pub struct Smooth<N> {
    /// μ_s − μ_d.
    pub excess: N,
    /// μ_d.
    pub dynamic: N,
    /// δ_v [m/s].
    pub slip_velocity: N,
    /// β/δ_v [s/m].
    pub steep: N,
    /// α [s²/m²].
    pub alpha: N,
}

impl<N: Number> Smooth<N>
where
    f64: Add<N, Output = N> + Mul<N, Output = N>,
{
    /// |μ| and dμ/dv [s/m] at a speed [m/s], from 0.
    #[inline(always)]
    pub fn at(&self, speed: N) -> (N, N) {
        let Smooth { excess, dynamic, slip_velocity, steep, alpha } = *self;
        let z = speed * steep;
        let decay = excess * (speed / slip_velocity).exp_of_negative();
        let level = decay + dynamic;
        let angle = FRAC_2_PI * z.atan_of_positive();
        let value = angle * level + alpha * speed * speed;
        let slope = FRAC_2_PI * steep / (1.0 + z * z) * level - angle * decay / slip_velocity + 2.0 * alpha * speed;
        (value, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Stribeck = Stribeck { static_: 0.6, dynamic: 0.42, slip_velocity: 1e-3, beta: 100.0, alpha: 0.7 };

    #[test]
    fn slope_is_the_derivative_and_the_law_is_odd() {
        for v in [0.0, 1e-7, 1e-6, 1e-5, 1.4e-4, 1e-3, 5e-3, 0.1, 2.0] {
            let (value, slope) = LAW.at(v);
            assert_eq!(LAW.value(-v), -value);
            let h = 1e-6 * (v + 1e-6);
            let difference = (LAW.value(v + h) - LAW.value(v - h)) / (2.0 * h);
            assert!((difference - slope).abs() <= 1e-5 * slope.abs() + 1e-6, "v = {v}: {difference} against {slope}");
        }
        assert!((LAW.at(0.0).1 - LAW.slope_at_rest()).abs() < 1e-9);
    }

    #[test]
    fn limits_of_the_law() {
        // Well past δ_v the law is (2/π) arctan(β v/δ_v) μ_d + α v².
        let v = 1.0;
        let expected = FRAC_2_PI * (1e5f64).atan() * 0.42 + 0.7;
        assert!((LAW.value(v) - expected).abs() < 1e-12);
    }
}
