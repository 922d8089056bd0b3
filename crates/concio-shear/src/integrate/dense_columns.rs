//! Dense columns of a front: A = C D⁻¹ Cᵀ, C lower triangular with the pivots D on its diagonal.
//!
//! Columns are as long as a multiple of [`LANES`], so that all loops are over whole vectors; what they do to rows above
//! the diagonal is of no account. C is kept as it comes, multipliers C D⁻¹ are made for an update and forgotten: no square
//! roots, and no pass over the column waits for its pivot. Every number is the result of the same operations in the same
//! order whatever the vectors of the machine.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

/// A pivot that is not positive, or not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotPositive;

/// Numbers that loops go through at a time: rows start and end at multiples of it.
pub const LANES: usize = 8;
/// Columns that are eliminated before the columns behind them are brought up to date.
const BLOCK: usize = 32;
/// Columns that are brought up to date at a time.
const QUAD: usize = 4;

/// What factors are kept in: `f64`, or `f32` where they only lead to a solution.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
{
    const ZERO: Self;
    const ONE: Self;

    /// The nearest number of this kind.
    fn near(x: f64) -> Self;
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    #[inline(always)]
    fn near(x: f64) -> Self {
        x
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    #[inline(always)]
    fn near(x: f64) -> Self {
        x as f32
    }
}

type Lanes<R> = [R; LANES];

/// `n` rounded up to whole vectors.
pub const fn padded(n: usize) -> usize {
    n.next_multiple_of(LANES)
}

/// `row` rounded down to the start of a vector.
pub const fn aligned(row: usize) -> usize {
    row - row % LANES
}

/// Length of the scratch for fronts of at most `rows` rows.
pub const fn scratch(rows: usize) -> usize {
    (rows + QUAD) * BLOCK
}

#[inline(always)]
fn lanes<R>(column: &[R], row: usize) -> &Lanes<R> {
    column[row..].first_chunk().expect("rows end at whole vectors")
}

#[inline(always)]
fn lanes_mut<R>(column: &mut [R], row: usize) -> &mut Lanes<R> {
    column[row..].first_chunk_mut().expect("rows end at whole vectors")
}

#[inline(always)]
fn less<R: Real>(target: &mut Lanes<R>, factor: R, x: &Lanes<R>) {
    for i in 0..LANES {
        target[i] -= factor * x[i];
    }
}

/// The columns of a front: the first `width` of them, `lead` long, and what lies behind, columns `width` to `rows` with
/// the rows from [`aligned`]`(width)` on.
#[derive(Debug)]
pub struct Dense<'a, R> {
    pub panel: &'a mut [R],
    pub rest: &'a mut [R],
    /// D⁻¹ of the first columns.
    pub inverse: &'a mut [R],
    pub multipliers: &'a mut [R],
    pub width: usize,
    pub rows: usize,
    pub lead: usize,
}

/// What a front left over: the rest of its columns, `long` each, of which the first `skip` numbers are of no account.
#[derive(Debug, Clone, Copy)]
pub struct Left<'a, R> {
    pub columns: &'a [R],
    pub long: usize,
    pub skip: usize,
    /// Its rows in the front that takes it over.
    pub into: &'a [u32],
}

impl<R: Real> Dense<'_, R> {
    /// Adds what another front left over.
    #[inline(always)]
    pub fn take_over(&mut self, left: Left<R>) {
        let (lead, above, into) = (self.lead, aligned(self.width), left.into);
        for (j, (column, &at)) in left.columns.chunks_exact(left.long).zip(into).enumerate() {
            let at = at as usize;
            let values = &column[left.skip + j..];
            if at < self.width {
                let target = &mut self.panel[at * lead..][..lead];
                for (&p, value) in into[j..].iter().zip(values) {
                    target[p as usize] += *value;
                }
            } else {
                let target = &mut self.rest[(at - self.width) * (lead - above)..][..lead - above];
                for (&p, value) in into[j..].iter().zip(values) {
                    target[p as usize - above] += *value;
                }
            }
        }
    }

    /// Eliminates the first columns.
    ///
    /// # Errors
    /// [`NotPositive`] when a pivot is not above zero.
    #[inline(always)]
    pub fn eliminate(&mut self) -> Result<(), NotPositive> {
        let mut from = 0;
        while from < self.width {
            let to = (from + BLOCK).min(self.width);
            let mut at = from;
            while at < to {
                let next = (at + QUAD).min(to);
                match next - at {
                    1 => self.pivots::<1>(at)?,
                    2 => self.pivots::<2>(at)?,
                    3 => self.pivots::<3>(at)?,
                    _ => self.pivots::<QUAD>(at)?,
                }
                self.update_panel(at, next, to);
                at = next;
            }
            self.update_panel(from, to, self.width);
            self.update_rest(from, to);
            from = to;
        }
        // The diagonal and what became of the rows above it: solutions go through them as zeros.
        for k in 0..self.width {
            self.panel[k * self.lead + aligned(k)..=k * self.lead + k].fill(R::ZERO);
        }
        Ok(())
    }

    /// Eliminates `K` columns against each other.
    #[inline(always)]
    fn pivots<const K: usize>(&mut self, from: usize) -> Result<(), NotPositive> {
        let lead = self.lead;
        let columns = &mut self.panel[from * lead..(from + K) * lead];
        let (mut c, mut m) = ([[R::ZERO; K]; K], [[R::ZERO; K]; K]);
        for k in 0..K {
            c[k][k..].copy_from_slice(&columns[k * lead + from + k..][..K - k]);
        }
        for k in 0..K {
            let pivot = c[k][k];
            if !(pivot > R::ZERO) {
                return Err(NotPositive);
            }
            let inverse = R::ONE / pivot;
            self.inverse[from + k] = inverse;
            for j in k + 1..K {
                m[k][j] = c[k][j] * inverse;
                for i in j..K {
                    c[j][i] -= m[k][j] * c[k][i];
                }
            }
        }
        for row in (aligned(from)..lead).step_by(LANES) {
            let mut x = [[R::ZERO; LANES]; K];
            for k in 0..K {
                x[k] = *lanes(&columns[k * lead..], row);
            }
            for k in 0..K {
                let known = x[k];
                for j in k + 1..K {
                    less(&mut x[j], m[k][j], &known);
                }
            }
            for k in 1..K {
                *lanes_mut(&mut columns[k * lead..], row) = x[k];
            }
        }
        Ok(())
    }

    /// Columns `to` to `end` of the panel less what columns `from` to `to` make of them.
    #[inline(always)]
    fn update_panel(&mut self, from: usize, to: usize, end: usize) {
        if to == end {
            return;
        }
        self.multiply(from, to, to, end);
        let lead = self.lead;
        let (done, later) = self.panel.split_at_mut(to * lead);
        let done = Done { columns: &done[from * lead..], lead, depth: to - from, multipliers: self.multipliers };
        done.update(Behind { columns: &mut later[..(end - to) * lead], long: lead, first: to, above: 0 });
    }

    #[inline(always)]
    fn update_rest(&mut self, from: usize, to: usize) {
        if self.rows == self.width {
            return;
        }
        self.multiply(from, to, self.width, self.rows);
        let (lead, above) = (self.lead, aligned(self.width));
        let columns = &self.panel[from * lead..to * lead];
        let done = Done { columns, lead, depth: to - from, multipliers: self.multipliers };
        done.update(Behind { columns: self.rest, long: lead - above, first: self.width, above });
    }

    /// C D⁻¹ of columns `from` to `to` in rows `first` to `end`, four rows at a time.
    #[inline(always)]
    fn multiply(&mut self, from: usize, to: usize, first: usize, end: usize) {
        let (depth, lead) = (to - from, self.lead);
        for (k, column) in self.panel[from * lead..to * lead].chunks_exact(lead).enumerate() {
            let inverse = self.inverse[from + k];
            let mut quads = self.multipliers[QUAD * k..].chunks_mut(QUAD * depth);
            let (whole, part) = column[first..end].as_chunks::<QUAD>();
            for (values, into) in whole.iter().zip(quads.by_ref()) {
                for i in 0..QUAD {
                    into[i] = values[i] * inverse;
                }
            }
            if let Some(into) = quads.next().filter(|_| !part.is_empty()) {
                for i in 0..QUAD {
                    into[i] = part.get(i).map_or(R::ZERO, |value| *value * inverse);
                }
            }
        }
    }
}

/// Columns that have been eliminated, `lead` long, with the multipliers of the rows that are brought up to date.
struct Done<'a, R> {
    columns: &'a [R],
    lead: usize,
    depth: usize,
    multipliers: &'a [R],
}

/// Columns `first`, … behind them, `long` each, from row `above` on.
struct Behind<'a, R> {
    columns: &'a mut [R],
    long: usize,
    first: usize,
    above: usize,
}

impl<R: Real> Done<'_, R> {
    /// The columns behind less these times their multipliers.
    #[inline(always)]
    fn update(&self, behind: Behind<R>) {
        let Behind { columns, long, first, above } = behind;
        let quads = columns.chunks_mut(QUAD * long).zip(self.multipliers.chunks_exact(QUAD * self.depth));
        for (q, (columns, multipliers)) in quads.enumerate() {
            let row = aligned(first + QUAD * q);
            match columns.len() / long {
                1 => self.tiles::<1>(multipliers, columns, long, row, above),
                2 => self.tiles::<2>(multipliers, columns, long, row, above),
                3 => self.tiles::<3>(multipliers, columns, long, row, above),
                _ => self.tiles::<QUAD>(multipliers, columns, long, row, above),
            }
        }
    }

    /// `N` columns from row `row` on, vector by vector.
    #[inline(always)]
    fn tiles<const N: usize>(&self, multipliers: &[R], behind: &mut [R], long: usize, row: usize, above: usize) {
        let (multipliers, _) = multipliers.as_chunks::<QUAD>();
        for row in (row..self.lead).step_by(LANES) {
            let mut sums = [[R::ZERO; LANES]; N];
            for j in 0..N {
                sums[j] = *lanes(&behind[j * long..], row - above);
            }
            for (column, m) in self.columns.chunks_exact(self.lead).zip(multipliers) {
                let x = lanes(column, row);
                for j in 0..N {
                    less(&mut sums[j], m[j], x);
                }
            }
            for j in 0..N {
                *lanes_mut(&mut behind[j * long..], row - above) = sums[j];
            }
        }
    }
}

/// C D⁻¹ y = b for one front: `x` holds b in the rows of the panel, and then what the columns leave of it in the rows
/// below; y D⁻¹ goes into `own`.
#[inline(always)]
pub fn forward<R: Real>(panel: &[R], lead: usize, inverse: &[R], x: &mut [R], own: &mut [R]) {
    let width = inverse.len();
    let mut from = 0;
    while from < width {
        let count = (width - from).min(QUAD);
        let columns = &panel[from * lead..(from + count) * lead];
        let (inverse, own) = (&inverse[from..], &mut own[from..]);
        match count {
            1 => forward_block::<R, 1>(columns, lead, from, inverse, x, own),
            2 => forward_block::<R, 2>(columns, lead, from, inverse, x, own),
            3 => forward_block::<R, 3>(columns, lead, from, inverse, x, own),
            _ => forward_block::<R, 4>(columns, lead, from, inverse, x, own),
        }
        from += count;
    }
}

#[inline(always)]
fn forward_block<R: Real, const K: usize>(
    columns: &[R],
    lead: usize,
    from: usize,
    inverse: &[R],
    x: &mut [R],
    own: &mut [R],
) {
    let mut y = [R::ZERO; K];
    y.copy_from_slice(&x[from..from + K]);
    for k in 0..K {
        y[k] = y[k] * inverse[k];
        for j in k + 1..K {
            y[j] -= columns[k * lead + from + j] * y[k];
        }
    }
    own[..K].copy_from_slice(&y);
    for row in (aligned(from + 1)..lead).step_by(LANES) {
        let x = lanes_mut(x, row);
        let mut sums = *x;
        for k in 0..K {
            less(&mut sums, y[k], lanes(&columns[k * lead..], row));
        }
        *x = sums;
    }
}

/// D⁻¹ Cᵀ x = y for one front: `x` holds x in the rows below and is scratch above, y and then x is in `own`.
#[inline(always)]
pub fn backward<R: Real>(panel: &[R], lead: usize, inverse: &[R], x: &mut [R], own: &mut [R]) {
    let width = inverse.len();
    x[..width].fill(R::ZERO);
    let mut to = width;
    while to > 0 {
        let count = (to - 1) % QUAD + 1;
        let from = to - count;
        let columns = &panel[from * lead..to * lead];
        let (inverse, own) = (&inverse[from..], &mut own[from..]);
        match count {
            1 => backward_block::<R, 1>(columns, lead, from, inverse, x, own),
            2 => backward_block::<R, 2>(columns, lead, from, inverse, x, own),
            3 => backward_block::<R, 3>(columns, lead, from, inverse, x, own),
            _ => backward_block::<R, 4>(columns, lead, from, inverse, x, own),
        }
        to = from;
    }
}

#[inline(always)]
fn backward_block<R: Real, const K: usize>(
    columns: &[R],
    lead: usize,
    from: usize,
    inverse: &[R],
    x: &mut [R],
    own: &mut [R],
) {
    // The block's own rows of x are still zero.
    let mut sums = [[R::ZERO; LANES]; K];
    // Downwards, as the fronts are gone through: what comes next is then fetched in time.
    for row in (aligned(from + 1)..lead).step_by(LANES).rev() {
        let x = lanes(x, row);
        for k in 0..K {
            let l = lanes(&columns[k * lead..], row);
            for i in 0..LANES {
                sums[k][i] += l[i] * x[i];
            }
        }
    }
    for k in (0..K).rev() {
        let mut sum = whole(&sums[k]);
        for j in k + 1..K {
            sum += columns[k * lead + from + j] * own[j];
        }
        own[k] -= inverse[k] * sum;
        x[from + k] = own[k];
    }
}

/// The sum of all lanes, by halves.
#[inline(always)]
fn whole<R: Real>(x: &Lanes<R>) -> R {
    let four: [R; 4] = std::array::from_fn(|i| x[i] + x[i + 4]);
    let two: [R; 2] = std::array::from_fn(|i| four[i] + four[i + 2]);
    two[0] + two[1]
}
