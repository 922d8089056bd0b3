//! Rows of one number per lane, and arithmetic on them that reads like arithmetic on numbers.
//!
//! A row has [`WIDTH`] lanes on every machine; what differs is how many instructions an operation takes. No
//! operation is fused and none mixes lanes, so that a lane has the bits that the same operations on single numbers
//! have.

use std::ops::{Add, Div, Mul, Sub};

use pulp::Simd;

use concio_law::elementary::{
    ATAN_DENOMINATOR, ATAN_NUMERATOR, EXP_LARGEST, EXP_TAYLOR, LN_2_HIGH, LN_2_LOW, Number, ROUND,
};
use concio_law::friction::Smooth;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LOG2_E};

/// Lanes of a row.
pub const WIDTH: usize = 8;

/// Numbers that fill a cache line, which is what a row is and where it starts.
const LINE: usize = 64;

/// An array with a row for every joint, unknown or matrix entry.
#[derive(Debug)]
pub struct Rows {
    data: Vec<f64>,
    from: usize,
    len: usize,
}

impl Rows {
    /// `len` rows of zeros.
    pub fn new(len: usize) -> Self {
        let room = WIDTH - 1;
        let data = vec![0.0; len * WIDTH + room];
        // Rows that straddle cache lines cost twice the loads.
        let from = data.as_ptr().align_offset(LINE).min(room);
        Rows { data, from, len }
    }

    #[inline(always)]
    pub fn at(&self, row: usize, lane: usize) -> f64 {
        self.data[self.from + row * WIDTH + lane]
    }

    #[inline(always)]
    pub fn set(&mut self, row: usize, lane: usize, value: f64) {
        self.data[self.from + row * WIDTH + lane] = value;
    }

    /// Sets the whole row.
    #[inline(always)]
    pub fn set_row(&mut self, row: usize, values: [f64; WIDTH]) {
        let at = self.from + row * WIDTH;
        self.data[at..at + WIDTH].copy_from_slice(&values);
    }

    /// The numbers of a row.
    #[inline(always)]
    pub fn row(&self, row: usize) -> [f64; WIDTH] {
        std::array::from_fn(|lane| self.at(row, lane))
    }

    #[inline(always)]
    pub fn read<S: Simd>(&self, simd: S) -> Read<'_, S> {
        Read { simd, rows: S::as_simd_f64s(&self.data[self.from..self.from + self.len * WIDTH]).0 }
    }

    #[inline(always)]
    pub fn write<S: Simd>(&mut self, simd: S) -> Write<'_, S> {
        Write { simd, rows: S::as_mut_simd_f64s(&mut self.data[self.from..self.from + self.len * WIDTH]).0 }
    }
}

/// Rows that belong together, side by side in memory: K of them for every joint or unknown. What is read in turn is
/// read without an index and its check, what is read out of turn with one check for all K.
#[derive(Debug)]
pub struct Groups<const K: usize>(Rows);

impl<const K: usize> Groups<K> {
    /// `len` groups of zeros.
    pub fn new(len: usize) -> Self {
        Groups(Rows::new(len * K))
    }
    /// All rows, group after group.
    pub fn rows(&self) -> &Rows {
        &self.0
    }
    /// Number of groups.
    pub fn len(&self) -> usize {
        self.0.len / K
    }
    #[inline(always)]
    pub fn at(&self, group: usize, row: usize, lane: usize) -> f64 {
        self.0.at(group * K + row, lane)
    }
    #[inline(always)]
    pub fn set(&mut self, group: usize, row: usize, lane: usize, value: f64) {
        self.0.set(group * K + row, lane, value);
    }
    #[inline(always)]
    pub fn read<S: Simd>(&self, simd: S) -> ReadGroups<'_, S, K> {
        ReadGroups { simd, groups: self.0.read(simd).rows.as_chunks().0 }
    }
    #[inline(always)]
    pub fn write<S: Simd>(&mut self, simd: S) -> WriteGroups<'_, S, K> {
        WriteGroups { simd, groups: self.0.write(simd).rows.as_chunks_mut().0 }
    }
}

/// Groups to read.
#[derive(Clone, Copy)]
pub struct ReadGroups<'a, S: Simd, const K: usize> {
    simd: S,
    groups: &'a [[S::f64s; K]],
}

impl<'a, S: Simd, const K: usize> ReadGroups<'a, S, K> {
    #[inline(always)]
    pub fn at(&self, i: u32) -> [V<S>; K] {
        let simd = self.simd;
        self.groups[i as usize].map(
            #[inline(always)]
            |x| V(simd, x),
        )
    }
    /// Row `row` of group `i`.
    #[inline(always)]
    pub fn of(&self, i: u32, row: usize) -> V<S> {
        V(self.simd, self.groups[i as usize][row])
    }
    #[inline(always)]
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = Group<'a, S, K>> + ExactSizeIterator + use<'a, S, K> {
        let simd = self.simd;
        self.groups.iter().map(
            #[inline(always)]
            move |rows| Group { simd, rows },
        )
    }
}

/// A group to read.
#[derive(Clone, Copy)]
pub struct Group<'a, S: Simd, const K: usize> {
    simd: S,
    rows: &'a [S::f64s; K],
}

impl<S: Simd, const K: usize> Group<'_, S, K> {
    #[inline(always)]
    pub fn row(&self, row: usize) -> V<S> {
        V(self.simd, self.rows[row])
    }
}

/// Groups to read and write.
pub struct WriteGroups<'a, S: Simd, const K: usize> {
    simd: S,
    groups: &'a mut [[S::f64s; K]],
}

impl<'a, S: Simd, const K: usize> WriteGroups<'a, S, K> {
    #[inline(always)]
    pub fn group(&mut self, i: u32) -> GroupMut<'_, S, K> {
        GroupMut { simd: self.simd, rows: &mut self.groups[i as usize] }
    }
    #[inline(always)]
    pub fn of(&self, i: u32, row: usize) -> V<S> {
        V(self.simd, self.groups[i as usize][row])
    }
    #[inline(always)]
    pub fn iter_mut(&mut self) -> impl DoubleEndedIterator<Item = GroupMut<'_, S, K>> + ExactSizeIterator {
        let simd = self.simd;
        self.groups.iter_mut().map(
            #[inline(always)]
            move |rows| GroupMut { simd, rows },
        )
    }
}

/// A group to read and write.
pub struct GroupMut<'a, S: Simd, const K: usize> {
    simd: S,
    rows: &'a mut [S::f64s; K],
}

impl<S: Simd> GroupMut<'_, S, 2> {
    #[inline(always)]
    pub fn both(&self) -> [V<S>; 2] {
        [self.row(0), self.row(1)]
    }
}

impl<S: Simd, const K: usize> GroupMut<'_, S, K> {
    #[inline(always)]
    pub fn row(&self, row: usize) -> V<S> {
        V(self.simd, self.rows[row])
    }
    #[inline(always)]
    pub fn set(&mut self, row: usize, value: V<S>) {
        self.rows[row] = value.1;
    }
    #[inline(always)]
    pub fn add(&mut self, row: usize, value: V<S>) {
        self.set(row, self.row(row) + value);
    }
    #[inline(always)]
    pub fn subtract(&mut self, row: usize, value: V<S>) {
        self.set(row, self.row(row) - value);
    }
    /// Sets the lanes in `mask` alone.
    #[inline(always)]
    pub fn set_where(&mut self, mask: Mask<S>, row: usize, value: V<S>) {
        self.set(row, mask.pick(value, self.row(row)));
    }
    /// Raises the lanes in `mask` to `value` where they are below.
    #[inline(always)]
    pub fn raise_where(&mut self, mask: Mask<S>, row: usize, value: V<S>) {
        let old = self.row(row);
        self.set(row, mask.pick(old.max(value), old));
    }
}

/// Rows to read.
#[derive(Clone, Copy)]
pub struct Read<'a, S: Simd> {
    simd: S,
    rows: &'a [S::f64s],
}

impl<'a, S: Simd> Read<'a, S> {
    #[inline(always)]
    pub fn at(&self, i: u32) -> V<S> {
        V(self.simd, self.rows[i as usize])
    }
    #[inline(always)]
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = V<S>> + ExactSizeIterator + use<'a, S> {
        let simd = self.simd;
        self.rows.iter().map(
            #[inline(always)]
            move |&x| V(simd, x),
        )
    }
}

/// Rows to read and write.
pub struct Write<'a, S: Simd> {
    simd: S,
    rows: &'a mut [S::f64s],
}

impl<'a, S: Simd> Write<'a, S> {
    #[inline(always)]
    pub fn into_iter(self) -> impl ExactSizeIterator<Item = GroupMut<'a, S, 1>> {
        let simd = self.simd;
        self.rows.as_chunks_mut::<1>().0.iter_mut().map(
            #[inline(always)]
            move |rows| GroupMut { simd, rows },
        )
    }
    #[inline(always)]
    pub fn at(&self, i: u32) -> V<S> {
        V(self.simd, self.rows[i as usize])
    }
    #[inline(always)]
    pub fn set(&mut self, i: u32, value: V<S>) {
        self.rows[i as usize] = value.1;
    }
    #[inline(always)]
    pub fn iter_mut(&mut self) -> impl ExactSizeIterator<Item = GroupMut<'_, S, 1>> {
        let simd = self.simd;
        self.rows.as_chunks_mut::<1>().0.iter_mut().map(
            #[inline(always)]
            move |rows| GroupMut { simd, rows },
        )
    }
}

/// One row in registers.
#[derive(Clone, Copy)]
pub struct V<S: Simd>(S, S::f64s);

impl<S: Simd> V<S> {
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        V(simd, simd.splat_f64s(value))
    }
    #[inline(always)]
    pub fn of(simd: S, values: [f64; WIDTH]) -> Self {
        V(simd, pulp::bytemuck::cast(values))
    }
    #[inline(always)]
    pub fn numbers(self) -> [f64; WIDTH] {
        pulp::bytemuck::cast(self.1)
    }
    #[inline(always)]
    pub fn simd(self) -> S {
        self.0
    }
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        V::splat(self.0, value)
    }
    #[inline(always)]
    pub fn abs(self) -> Self {
        V(self.0, self.0.abs_f64s(self.1))
    }
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        V(self.0, self.0.max_f64s(self.1, other.1))
    }
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        V(self.0, self.0.min_f64s(self.1, other.1))
    }
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        V(self.0, self.0.sqrt_f64s(self.1))
    }
    #[inline(always)]
    pub fn above(self, other: Self) -> Mask<S> {
        Mask(self.0, self.0.greater_than_f64s(self.1, other.1))
    }
    #[inline(always)]
    pub fn below(self, other: Self) -> Mask<S> {
        other.above(self)
    }
    #[inline(always)]
    pub fn at_most(self, other: Self) -> Mask<S> {
        Mask(self.0, self.0.less_than_or_equal_f64s(self.1, other.1))
    }
    /// −x, the sign of zero turned too.
    #[inline(always)]
    pub fn negated(self) -> Self {
        V(self.0, self.0.xor_f64s(self.1, self.0.splat_f64s(-0.0)))
    }
    /// |x| with the sign of `sign`.
    #[inline(always)]
    pub fn with_sign_of(self, sign: Self) -> Self {
        let bit = self.0.and_f64s(sign.1, self.0.splat_f64s(-0.0));
        V(self.0, self.0.or_f64s(self.abs().1, bit))
    }
}

macro_rules! operator {
    ($trait: ident, $method: ident, $instruction: ident) => {
        impl<S: Simd> $trait for V<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                V(self.0, self.0.$instruction(self.1, other.1))
            }
        }
        impl<S: Simd> $trait<f64> for V<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                V(self.0, self.0.$instruction(self.1, self.0.splat_f64s(other)))
            }
        }
        impl<S: Simd> $trait<V<S>> for f64 {
            type Output = V<S>;
            #[inline(always)]
            fn $method(self, other: V<S>) -> V<S> {
                V(other.0, other.0.$instruction(other.0.splat_f64s(self), other.1))
            }
        }
    };
}
operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

/// A yes or no per lane.
#[derive(Clone, Copy)]
pub struct Mask<S: Simd>(S, S::m64s);

impl<S: Simd> Mask<S> {
    /// Of lanes that are not zero.
    #[inline(always)]
    pub fn of(row: V<S>) -> Self {
        row.above(row.like(0.0))
    }
    #[inline(always)]
    pub fn pick(self, yes: V<S>, no: V<S>) -> V<S> {
        V(self.0, self.0.select_f64s(self.1, yes.1, no.1))
    }
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Mask(self.0, self.0.and_m64s(self.1, other.1))
    }
    #[inline(always)]
    pub fn or(self, other: Self) -> Self {
        Mask(self.0, self.0.or_m64s(self.1, other.1))
    }
    #[inline(always)]
    pub fn not(self) -> Self {
        Mask(self.0, self.0.not_m64s(self.1))
    }
    #[inline(always)]
    pub fn differs(self, other: Self) -> Self {
        Mask(self.0, self.0.xor_m64s(self.1, other.1))
    }
    /// One where it holds, zero where not.
    #[inline(always)]
    pub fn as_row(self) -> V<S> {
        self.pick(V::splat(self.0, 1.0), V::splat(self.0, 0.0))
    }
    #[inline(always)]
    pub fn any(self) -> bool {
        self.0.first_true_m64s(self.1) < WIDTH
    }
}

/// [`concio_law::elementary::exp_of_negative`] in every lane.
#[inline(always)]
pub fn exp_of_negative<S: Simd>(x: V<S>) -> V<S> {
    let largest = x.like(EXP_LARGEST);
    let x = x.above(largest).pick(largest, x);
    let shifted = ROUND - x * LOG2_E;
    let k = shifted - ROUND;
    let r = (x.negated() - k * LN_2_HIGH) - k * LN_2_LOW;
    let mut sum = x.like(EXP_TAYLOR[0]);
    for &c in &EXP_TAYLOR[1..] {
        sum = sum * r + c;
    }
    let power = shifted.numbers().map(|s| f64::from_bits(s.to_bits().wrapping_add(1023) << 52));
    sum * V::of(x.0, power)
}

/// [`concio_law::elementary::atan_of_positive`] in every lane.
#[inline(always)]
pub fn atan_of_positive<S: Simd>(z: V<S>) -> V<S> {
    let (p, q) = (ATAN_NUMERATOR, ATAN_DENOMINATOR);
    let (far, middle) = (z.above(z.like(2.414_213_562_373_095)), z.above(z.like(0.66)));
    let top = far.pick(z.like(-1.0), middle.pick(z - 1.0, z));
    let bottom = far.pick(z, middle.pick(z + 1.0, z.like(1.0)));
    let turned = far.pick(z.like(FRAC_PI_2), middle.pick(z.like(FRAC_PI_4), z.like(0.0)));
    let t = top / bottom;
    let s = t * t;
    let p = (((p[0] * s + p[1]) * s + p[2]) * s + p[3]) * s + p[4];
    let q = ((((s + q[0]) * s + q[1]) * s + q[2]) * s + q[3]) * s + q[4];
    turned + (t + t * s * (p / q))
}

impl<S: Simd> Number for V<S> {
    #[inline(always)]
    fn exp_of_negative(self) -> Self {
        exp_of_negative(self)
    }
    #[inline(always)]
    fn atan_of_positive(self) -> Self {
        atan_of_positive(self)
    }
}

/// Parameters of (6) in every lane.
pub type Law<S> = Smooth<V<S>>;

/// μ(v) and its slope in every lane.
#[inline(always)]
pub fn friction<S: Simd>(law: Law<S>, v: V<S>) -> (V<S>, V<S>) {
    let (value, slope) = law.at(v.abs());
    (value.with_sign_of(v), slope)
}
