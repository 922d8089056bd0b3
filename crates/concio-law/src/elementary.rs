//! Exponential and arctangent without branches, so that a loop over joints becomes vector instructions, and without
//! the system's mathematical library, so that every machine gets the same bits.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LOG2_E};
use std::ops::{Add, Div, Mul, Sub};

/// Adding it to a number of at most 2⁵¹ leaves the nearest integer in the low bits.
pub const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 · 2⁵²
/// ln 2 in two parts; the first has 21 trailing zeros, so that its product with a small integer is exact.
pub const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
/// See above.
pub const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// Below it the exponential is taken as e^(−EXP_LARGEST) ≈ 3·10⁻³⁰⁸: nothing that is added to a friction coefficient.
pub const EXP_LARGEST: f64 = 707.0;
/// Coefficients of Taylor's series of e^r, the highest power first.
pub const EXP_TAYLOR: [f64; 14] = [
    1.0 / 6_227_020_800.0,
    1.0 / 479_001_600.0,
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
    1.0,
];
/// P and Q of the arctangent, the highest power first; that of Q is 1.
pub const ATAN_NUMERATOR: [f64; 5] = [
    -0.875_060_860_003_190_4,
    -16.157_537_187_333_652,
    -75.008_557_923_147_05,
    -122.886_668_449_013_61,
    -64.850_219_049_420_25,
];
/// See above.
pub const ATAN_DENOMINATOR: [f64; 5] = [
    24.858_464_901_423_062,
    165.027_009_831_698_85,
    432.881_060_491_290_27,
    485.390_399_635_913_7,
    194.550_657_148_261_4,
];

/// A number, or one in every lane of a vector, with the functions of this module.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// e^(−x) for x ≥ 0.
    fn exp_of_negative(self) -> Self;
    /// arctan z for z ≥ 0.
    fn atan_of_positive(self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn exp_of_negative(self) -> f64 {
        exp_of_negative(self)
    }
    #[inline(always)]
    fn atan_of_positive(self) -> f64 {
        atan_of_positive(self)
    }
}

/// e^(−x) for x ≥ 0; relative error below 4·10⁻¹⁶.
///
/// −x = k ln 2 + r with |r| ≤ ½ ln 2; Taylor's series of e^r to r¹³ leaves less than (½ ln 2)¹⁴/14! = 4.2·10⁻¹⁸.
#[inline(always)]
pub fn exp_of_negative(x: f64) -> f64 {
    // Not f64::min: what is not a number stays so.
    let x = if x > EXP_LARGEST { EXP_LARGEST } else { x };
    let shifted = ROUND - x * LOG2_E;
    let k = shifted - ROUND;
    let r = (-x - k * LN_2_HIGH) - k * LN_2_LOW;
    let mut sum = EXP_TAYLOR[0];
    for c in &EXP_TAYLOR[1..] {
        sum = sum * r + c;
    }
    // The low bits of `shifted` are k; moved to the place of the exponent they are 2^k.
    let power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    sum * power
}

/// arctan z for z ≥ 0; relative error below 5·10⁻¹⁶.
///
/// Reduced by arctan z = π/4 + arctan((z−1)/(z+1)) and π/2 − arctan(1/z) to |t| ≤ 0.66, and there the
/// rational approximation t + t³ P(t²)/Q(t²) of S. L. Moshier, *Methods and Programs for Mathematical Functions* (1989).
#[inline(always)]
pub fn atan_of_positive(z: f64) -> f64 {
    let (p, q) = (ATAN_NUMERATOR, ATAN_DENOMINATOR);
    let (far, middle) = (z > 2.414_213_562_373_095, z > 0.66);
    let top = if far {
        -1.0
    } else if middle {
        z - 1.0
    } else {
        z
    };
    let bottom = if far {
        z
    } else if middle {
        z + 1.0
    } else {
        1.0
    };
    let turned = if far {
        FRAC_PI_2
    } else if middle {
        FRAC_PI_4
    } else {
        0.0
    };
    let t = top / bottom;
    let s = t * t;
    let p = (((p[0] * s + p[1]) * s + p[2]) * s + p[3]) * s + p[4];
    let q = ((((s + q[0]) * s + q[1]) * s + q[2]) * s + q[3]) * s + q[4];
    turned + (t + t * s * (p / q))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stated bounds against the standard library, whose own error is below one unit in the last place.
    #[test]
    fn errors_are_below_their_bounds() {
        let (mut exp, mut atan) = (0.0f64, 0.0f64);
        for i in 0..=2_000_000 {
            let x = 1e-12 * (1.0f64 + 1.7e-5).powi(i);
            atan = atan.max((atan_of_positive(x) / x.atan() - 1.0).abs());
            if x <= 700.0 {
                exp = exp.max((exp_of_negative(x) / (-x).exp() - 1.0).abs());
            }
        }
        assert!(exp < 4e-16 && atan < 5e-16, "{exp:e} {atan:e}");
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(exp_of_negative(0.0), 1.0);
        assert!(exp_of_negative(1e300) < 1e-300 && exp_of_negative(f64::INFINITY) >= 0.0);
        assert_eq!(atan_of_positive(0.0), 0.0);
        assert_eq!(atan_of_positive(f64::INFINITY), FRAC_PI_2);
        assert!(exp_of_negative(f64::NAN).is_nan() && atan_of_positive(f64::NAN).is_nan());
    }
}
