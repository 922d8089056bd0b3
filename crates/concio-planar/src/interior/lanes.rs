//! Numbers that the laws of a contact are written in: one contact's, or as many contacts' as a register holds.

use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::Simd;

/// Contacts that are taken together, on every machine: as many as the widest registers hold of the shorter numbers.
pub(super) const PACK: usize = 16;

/// A number of each.
pub(super) type Pack<F> = [F; PACK];

/// A number, or several side by side that are treated alike.
pub(super) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Share of the impulses by which rounding puts distances from bounds off: to mend that would keep the way short where a bound is met.
    const ROUNDED: f64;
    /// Squares of multipliers below which nothing is shared out by them.
    const TINY: f64;
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
    const ROUNDED: f64 = <f64 as Element>::ROUNDED;
    const TINY: f64 = <f64 as Element>::TINY;
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

/// What contacts that are taken together have their numbers in.
pub(super) trait Element: Copy + Default + PartialEq + std::ops::AddAssign {
    /// [`Real::ROUNDED`] and [`Real::TINY`].
    const ROUNDED: f64;
    const TINY: f64;
    type Register<S: Simd>: Copy;
    type Mask<S: Simd>: Copy;
    fn of(x: f64) -> Self;
    fn wide(self) -> f64;
    fn short(self) -> f32;
    fn of_short(x: f32) -> Self;
    fn registers<S: Simd>(pack: &Pack<Self>) -> &[Self::Register<S>];
    fn registers_mut<S: Simd>(pack: &mut Pack<Self>) -> &mut [Self::Register<S>];
    fn all<S: Simd>(simd: S, x: Self) -> Self::Register<S>;
    fn add<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Register<S>;
    fn sub<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Register<S>;
    fn mul<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Register<S>;
    fn div<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Register<S>;
    fn neg<S: Simd>(simd: S, a: Self::Register<S>) -> Self::Register<S>;
    fn size<S: Simd>(simd: S, a: Self::Register<S>) -> Self::Register<S>;
    fn below<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Mask<S>;
    fn at_most<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Mask<S>;
    fn equal<S: Simd>(simd: S, a: Self::Register<S>, b: Self::Register<S>) -> Self::Mask<S>;
    fn first<S: Simd>(simd: S, mask: Self::Mask<S>) -> usize;
    fn pick<S: Simd>(simd: S, mask: Self::Mask<S>, yes: Self::Register<S>, no: Self::Register<S>) -> Self::Register<S>;
}

/// [`Element`] of a type by what registers call its operations.
macro_rules! element {
    ($number:ty, $rounded:literal, $tiny:literal, $register:ident, $mask:ident, $as:ident, $as_mut:ident, $first:ident, $pick:ident, $splat:ident,
     $neg:ident, $abs:ident, [$($two:ident = $of_two:ident),*], [$($ask:ident = $answer:ident),*]) => {
        impl Element for $number {
            const ROUNDED: f64 = $rounded;
            const TINY: f64 = $tiny;
            type Register<S: Simd> = S::$register;
            type Mask<S: Simd> = S::$mask;

            #[inline(always)]
            fn of(x: f64) -> Self {
                x as $number
            }

            #[inline(always)]
            fn wide(self) -> f64 {
                self as f64
            }

            #[inline(always)]
            fn short(self) -> f32 {
                self as f32
            }

            #[inline(always)]
            fn of_short(x: f32) -> Self {
                x as $number
            }

            #[inline(always)]
            fn registers<S: Simd>(pack: &Pack<Self>) -> &[S::$register] {
                S::$as(pack).0
            }

            #[inline(always)]
            fn registers_mut<S: Simd>(pack: &mut Pack<Self>) -> &mut [S::$register] {
                S::$as_mut(pack).0
            }

            #[inline(always)]
            fn all<S: Simd>(simd: S, x: Self) -> S::$register {
                simd.$splat(x)
            }

            #[inline(always)]
            fn neg<S: Simd>(simd: S, a: S::$register) -> S::$register {
                simd.$neg(a)
            }

            #[inline(always)]
            fn size<S: Simd>(simd: S, a: S::$register) -> S::$register {
                simd.$abs(a)
            }

            #[inline(always)]
            fn first<S: Simd>(simd: S, mask: S::$mask) -> usize {
                simd.$first(mask)
            }

            #[inline(always)]
            fn pick<S: Simd>(simd: S, mask: S::$mask, yes: S::$register, no: S::$register) -> S::$register {
                simd.$pick(mask, yes, no)
            }

            $(
                #[inline(always)]
                fn $two<S: Simd>(simd: S, a: S::$register, b: S::$register) -> S::$register {
                    simd.$of_two(a, b)
                }
            )*

            $(
                #[inline(always)]
                fn $ask<S: Simd>(simd: S, a: S::$register, b: S::$register) -> S::$mask {
                    simd.$answer(a, b)
                }
            )*
        }
    };
}

element!(
    f64,
    1e-13,
    1e-280,
    f64s,
    m64s,
    as_simd_f64s,
    as_mut_simd_f64s,
    first_true_m64s,
    select_f64s,
    splat_f64s,
    neg_f64s,
    abs_f64s,
    [add = add_f64s, sub = sub_f64s, mul = mul_f64s, div = div_f64s],
    [below = less_than_f64s, at_most = less_than_or_equal_f64s, equal = equal_f64s]
);
element!(
    f32,
    3e-7,
    1e-30,
    f32s,
    m32s,
    as_simd_f32s,
    as_mut_simd_f32s,
    first_true_m32s,
    select_f32s,
    splat_f32s,
    neg_f32s,
    abs_f32s,
    [add = add_f32s, sub = sub_f32s, mul = mul_f32s, div = div_f32s],
    [below = less_than_f32s, at_most = less_than_or_equal_f32s, equal = equal_f32s]
);

/// A register of numbers.
#[derive(Clone, Copy)]
pub(super) struct Lanes<S: Simd, F: Element> {
    simd: S,
    x: F::Register<S>,
}

#[derive(Clone, Copy)]
pub(super) struct Mask<S: Simd, F: Element> {
    simd: S,
    x: F::Mask<S>,
}

impl<S: Simd, F: Element> Lanes<S, F> {
    /// Registers that a pack takes.
    pub(super) const PARTS: usize = PACK * size_of::<F>() / size_of::<F::Register<S>>();

    /// Which of a pack this part has.
    #[inline(always)]
    pub(super) fn own(part: usize) -> std::ops::Range<usize> {
        part * (PACK / Self::PARTS)..(part + 1) * (PACK / Self::PARTS)
    }

    #[inline(always)]
    pub(super) fn all(simd: S, x: f64) -> Self {
        Lanes { simd, x: F::all(simd, F::of(x)) }
    }

    /// Of a pack, the numbers of this part.
    #[inline(always)]
    pub(super) fn of(simd: S, pack: &Pack<F>, part: usize) -> Self {
        Lanes { simd, x: F::registers::<S>(pack)[part] }
    }

    #[inline(always)]
    pub(super) fn put(self, pack: &mut Pack<F>, part: usize) {
        F::registers_mut::<S>(pack)[part] = self.x;
    }
}

macro_rules! operator {
    ($operator:ident, $name:ident) => {
        impl<S: Simd, F: Element> $operator for Lanes<S, F> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Lanes { x: F::$name(self.simd, self.x, other.x), ..self }
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<S: Simd, F: Element> Neg for Lanes<S, F> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Lanes { x: F::neg(self.simd, self.x), ..self }
    }
}

impl<S: Simd, F: Element> Real for Lanes<S, F> {
    const ROUNDED: f64 = F::ROUNDED;
    const TINY: f64 = F::TINY;
    type Mask = Mask<S, F>;

    #[inline(always)]
    fn alike(self, x: f64) -> Self {
        Lanes::all(self.simd, x)
    }

    #[inline(always)]
    fn below(self, other: Self) -> Mask<S, F> {
        Mask { simd: self.simd, x: F::below(self.simd, self.x, other.x) }
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Mask<S, F> {
        Mask { simd: self.simd, x: F::at_most(self.simd, self.x, other.x) }
    }

    #[inline(always)]
    fn is_number(self) -> Mask<S, F> {
        Mask { simd: self.simd, x: F::equal(self.simd, self.x, self.x) }
    }

    #[inline(always)]
    fn size(self) -> Self {
        Lanes { x: F::size(self.simd, self.x), ..self }
    }

    #[inline(always)]
    fn any(self, mask: Mask<S, F>) -> bool {
        F::first(self.simd, mask.x) < PACK / Self::PARTS
    }

    #[inline(always)]
    fn pick(mask: Mask<S, F>, yes: Self, no: Self) -> Self {
        Lanes { x: F::pick(mask.simd, mask.x, yes.x, no.x), simd: mask.simd }
    }
}

#[inline(always)]
pub(super) fn brief(pack: Pack<f64>) -> Pack<f32> {
    pack.map(|x| x as f32)
}

#[inline(always)]
pub(super) fn wide<F: Element>(pack: Pack<F>) -> Pack<f64> {
    pack.map(F::wide)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::worse;

    struct Ask;

    fn ask<S: Simd, F: Element + std::fmt::Debug>(simd: S) {
        let numbers = [-2.0, -0.0, 0.0, 0.5, 3.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        let twice: Pack<f64> = std::array::from_fn(|k| numbers[k % numbers.len()]);
        for turn in 0..PACK {
            let mut turned = twice;
            turned.rotate_left(turn);
            let [first, second] = [twice, turned].map(|pack| pack.map(F::of));
            let mut seen = [[F::of(0.0); PACK]; 5];
            let parts = Lanes::<S, F>::PARTS;
            for part in 0..parts {
                let (a, b) = (Lanes::of(simd, &first, part), Lanes::of(simd, &second, part));
                a.larger(b).put(&mut seen[0], part);
                a.smaller(b).put(&mut seen[1], part);
                a.worse(b).put(&mut seen[2], part);
                a.inverse().put(&mut seen[3], part);
                a.between(b, a.alike(1.0)).put(&mut seen[4], part);
            }
            for k in 0..PACK {
                let (a, b) = (twice[k], turned[k]);
                let one = [a.larger(b), a.smaller(b), a.worse(b), a.inverse(), a.between(b, 1.0)].map(F::of);
                for (seen, one) in seen.iter().zip(one) {
                    let [seen, one] = [seen[k], one].map(F::wide);
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
            ask::<S, f64>(simd);
            ask::<S, f32>(simd);
        }
    }

    /// Numbers side by side are treated as each of them would be, in the widest registers and alone.
    #[test]
    fn lanes_are_numbers() {
        pulp::Arch::new().dispatch(Ask);
        pulp::Arch::Scalar.dispatch(Ask);
    }
}
