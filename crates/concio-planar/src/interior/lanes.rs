//! Numbers that the laws of a contact are written in: one contact's, or as many contacts' as a register holds.

use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::Simd;

/// Contacts that are taken together, on every machine: as many as the widest registers hold.
pub(super) const PACK: usize = 8;

/// A number of each.
pub(super) type Pack = [f64; PACK];

/// A number, or several side by side that are treated alike.
pub(super) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Answers to a question of each.
    type Mask: Copy;

    /// `x` as often as there are numbers in this one.
    fn alike(self, x: f64) -> Self;
    fn below(self, other: Self) -> Self::Mask;
    fn at_most(self, other: Self) -> Self::Mask;
    fn is_number(self) -> Self::Mask;
    fn size(self) -> Self;
    fn any(self, mask: Self::Mask) -> bool;
    /// Of each the first where the mask says yes.
    fn pick(mask: Self::Mask, yes: Self, no: Self) -> Self;

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::pick(self.below(other), other, self)
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::pick(other.below(self), other, self)
    }

    /// Between two others; what is no number stays so.
    #[inline(always)]
    fn between(self, least: Self, most: Self) -> Self {
        self.larger(least).smaller(most)
    }

    /// [`crate::contact::worse`].
    #[inline(always)]
    fn worse(self, other: Self) -> Self {
        Self::pick(other.is_number(), self.larger(other), other)
    }

    /// 1 over it, and 0 over what is not above 0; what is no number stays so.
    #[inline(always)]
    fn inverse(self) -> Self {
        Self::pick(self.at_most(self.alike(0.0)), self.alike(0.0), self.alike(1.0) / self)
    }
}

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn alike(self, x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn is_number(self) -> bool {
        !self.is_nan()
    }

    #[inline(always)]
    fn size(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn any(self, mask: bool) -> bool {
        mask
    }

    #[inline(always)]
    fn pick(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

/// A register of numbers.
#[derive(Clone, Copy)]
pub(super) struct Lanes<S: Simd> {
    simd: S,
    x: S::f64s,
}

#[derive(Clone, Copy)]
pub(super) struct Mask<S: Simd> {
    simd: S,
    x: S::m64s,
}

impl<S: Simd> Lanes<S> {
    /// Registers that a pack takes.
    pub(super) const PARTS: usize = PACK * size_of::<f64>() / size_of::<S::f64s>();

    #[inline(always)]
    pub(super) fn all(simd: S, x: f64) -> Self {
        Lanes { simd, x: simd.splat_f64s(x) }
    }

    /// Of a pack, the numbers of this part.
    #[inline(always)]
    pub(super) fn of(simd: S, pack: &Pack, part: usize) -> Self {
        Lanes { simd, x: S::as_simd_f64s(pack).0[part] }
    }

    #[inline(always)]
    pub(super) fn put(self, pack: &mut Pack, part: usize) {
        S::as_mut_simd_f64s(pack).0[part] = self.x;
    }
}

macro_rules! operator {
    ($operator:ident, $name:ident, $simd:ident) => {
        impl<S: Simd> $operator for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Lanes { x: self.simd.$simd(self.x, other.x), ..self }
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Lanes { x: self.simd.neg_f64s(self.x), ..self }
    }
}

impl<S: Simd> Real for Lanes<S> {
    type Mask = Mask<S>;

    #[inline(always)]
    fn alike(self, x: f64) -> Self {
        Lanes::all(self.simd, x)
    }

    #[inline(always)]
    fn below(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, x: self.simd.less_than_f64s(self.x, other.x) }
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, x: self.simd.less_than_or_equal_f64s(self.x, other.x) }
    }

    #[inline(always)]
    fn is_number(self) -> Mask<S> {
        Mask { simd: self.simd, x: self.simd.equal_f64s(self.x, self.x) }
    }

    #[inline(always)]
    fn size(self) -> Self {
        Lanes { x: self.simd.abs_f64s(self.x), ..self }
    }

    #[inline(always)]
    fn any(self, mask: Mask<S>) -> bool {
        self.simd.first_true_m64s(mask.x) < PACK / Self::PARTS
    }

    #[inline(always)]
    fn pick(mask: Mask<S>, yes: Self, no: Self) -> Self {
        Lanes { x: mask.simd.select_f64s(mask.x, yes.x, no.x), simd: mask.simd }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::worse;

    struct Ask;

    fn ask<S: Simd>(simd: S) {
        let numbers = [-2.0, -0.0, 0.0, 0.5, 3.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        let twice: Pack = std::array::from_fn(|k| numbers[k % numbers.len()]);
        for turn in 0..PACK {
            let mut turned = twice;
            turned.rotate_left(turn);
            let mut seen = [[0.0; PACK]; 5];
            for part in 0..Lanes::<S>::PARTS {
                let (a, b) = (Lanes::of(simd, &twice, part), Lanes::of(simd, &turned, part));
                a.larger(b).put(&mut seen[0], part);
                a.smaller(b).put(&mut seen[1], part);
                a.worse(b).put(&mut seen[2], part);
                a.inverse().put(&mut seen[3], part);
                a.between(b, a.alike(1.0)).put(&mut seen[4], part);
            }
            for k in 0..PACK {
                let (a, b) = (twice[k], turned[k]);
                let one = [a.larger(b), a.smaller(b), a.worse(b), a.inverse(), a.between(b, 1.0)];
                for (seen, one) in seen.iter().zip(one) {
                    let seen = seen[k];
                    assert_eq!(seen.is_sign_negative() && seen == 0.0, one.is_sign_negative() && one == 0.0, "{a} {b}");
                    assert!(seen == one || seen.is_nan() && one.is_nan(), "{a} {b}: {seen} {one}");
                }
                assert!(a.worse(b) == worse(a, b) || worse(a, b).is_nan() && a.worse(b).is_nan());
            }
        }
    }

    impl pulp::WithSimd for Ask {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            ask(simd);
        }
    }

    /// Numbers side by side are treated as each of them would be, in the widest registers and alone.
    #[test]
    fn lanes_are_numbers() {
        pulp::Arch::new().dispatch(Ask);
        pulp::Arch::Scalar.dispatch(Ask);
    }
}
