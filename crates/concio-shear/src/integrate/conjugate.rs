//! Conjugate gradients for large systems, (T2), led by the factors of a matrix that A hardly differs from.
//!
//! Within a step the matrix of a stage changes where head joints open and close and where friction's slope does. None of
//! that is far from what the factors were made of: a joint that opens or closes changes one eigenvalue of their quotient,
//! and most of these are alike. So a few iterations (M. R. Hestenes and E. Stiefel 1952) do, at the cost of a solution each,
//! where a factorisation costs four and more. Factors that only lead may be rough: they are kept in single precision.

use crate::integrate::dense_columns::NotPositive;
use crate::integrate::fronts::Fronts;

/// Numbers that are added up side by side.
const LANES: usize = 8;

/// What the search for x of A x = b keeps from one iteration to the next.
#[derive(Debug, Clone)]
pub struct Conjugate {
    /// The pattern of A below the diagonal by columns.
    start: Vec<u32>,
    row: Vec<u32>,
    /// b − A x.
    pub residual: Vec<f64>,
    direction: Vec<f64>,
    /// A times the direction.
    image: Vec<f64>,
    /// What the factors make of the residual, over its scale.
    led: Vec<f32>,
    /// Residual times what the factors made of it, of the iteration before; 0 before the first.
    before: f64,
}

impl Conjugate {
    /// For a matrix of order `n` with entries below the diagonal at `entries` (row, column), column by column.
    pub fn new(n: usize, entries: &[(u32, u32)]) -> Self {
        let mut start = vec![0u32; n + 1];
        for &(_, c) in entries {
            start[c as usize + 1] += 1;
        }
        for k in 0..n {
            start[k + 1] += start[k];
        }
        let zeros = || vec![0.0; n];
        Conjugate {
            start,
            row: entries.iter().map(|&(r, _)| r).collect(),
            residual: zeros(),
            direction: zeros(),
            image: zeros(),
            led: vec![0.0; n],
            before: 0.0,
        }
    }

    /// Begins at `x`.
    #[inline(always)]
    pub fn begin(&mut self, [diagonal, lower]: [&[f64]; 2], b: &[f64], x: &[f64]) {
        multiply(&self.start, &self.row, [diagonal, lower], x, &mut self.image);
        for ((r, b), q) in self.residual.iter_mut().zip(b).zip(&self.image) {
            *r = b - q;
        }
        self.turn();
    }

    /// A or b has changed, and the residual with them: directions of before are forgotten.
    #[inline(always)]
    pub fn turn(&mut self) {
        self.before = 0.0;
    }

    /// One iteration, which moves `x`; nowhere where nothing is left.
    ///
    /// # Errors
    /// A or the matrix of the factors is not positive.
    #[inline(always)]
    pub fn advance(
        &mut self,
        [diagonal, lower]: [&[f64]; 2],
        x: &mut [f64],
        factors: &mut Fronts<f32>,
    ) -> Result<(), NotPositive> {
        let scale = self.lead(factors);
        if scale == 0.0 {
            // Or nothing of it is a number.
            return if self.residual.iter().all(|r| *r == 0.0) { Ok(()) } else { Err(NotPositive) };
        }
        let Conjugate { start, row, residual, direction, image, led, before } = self;
        let now = scale * dot(residual, led, f64::from);
        let begins = *before == 0.0;
        let share = now / *before;
        *before = now;
        for (p, z) in direction.iter_mut().zip(&led[..]) {
            let own = scale * f64::from(*z);
            *p = if begins { own } else { own + share * *p };
        }
        multiply(start, row, [diagonal, lower], direction, image);
        let curvature = dot(direction, image, |x| x);
        // Negated, so that what is not a number fails.
        if !(curvature > 0.0 && now > 0.0) {
            return Err(NotPositive);
        }
        let way = now / curvature;
        for ((x, r), (p, q)) in x.iter_mut().zip(residual).zip(direction.iter().zip(&image[..])) {
            *x += way * p;
            *r -= way * q;
        }
        Ok(())
    }

    /// What the factors make of the residual, over its scale, which is returned.
    #[inline(always)]
    fn lead(&mut self, factors: &mut Fronts<f32>) -> f64 {
        let scale = rounded(&self.residual, &mut self.led);
        factors.solve(&mut self.led);
        scale
    }
}

/// The largest size among numbers; what is none is passed over.
#[inline(always)]
pub fn largest(of: &[f64]) -> f64 {
    of.iter().fold(0.0f64, |most, x| most.max(x.abs()))
}

/// `from` over its scale, which is returned: single precision has the digits, not the range.
#[inline(always)]
fn rounded(from: &[f64], to: &mut [f32]) -> f64 {
    let scale = largest(from);
    let inverse = if scale > 0.0 { 1.0 / scale } else { 0.0 };
    for (to, x) in to.iter_mut().zip(from) {
        *to = (x * inverse) as f32;
    }
    scale
}

/// y = A x.
#[inline(always)]
fn multiply(start: &[u32], row: &[u32], [diagonal, lower]: [&[f64]; 2], x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    for (c, (d, ends)) in diagonal.iter().zip(start.windows(2)).enumerate() {
        let own = x[c];
        let mut sum = d * own;
        let entries = ends[0] as usize..ends[1] as usize;
        for (&r, value) in row[entries.clone()].iter().zip(&lower[entries]) {
            let r = r as usize;
            sum += value * x[r];
            y[r] += value * own;
        }
        y[c] += sum;
    }
}

/// Side by side, so that sums do not wait for each other, in an order that is always the same.
#[inline(always)]
fn dot<T: Copy>(a: &[f64], b: &[T], wide: impl Fn(T) -> f64) -> f64 {
    let mut sums = [0.0; LANES];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for i in 0..LANES {
            sums[i] += a[i] * wide(b[i]);
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * wide(*b)).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of 600 with twelve springs that are no longer those of the factors: a few more iterations do, and
    /// single precision leaves nothing of its own.
    #[test]
    fn a_few_iterations_do() {
        let n = 600;
        let entries: Vec<(u32, u32)> = (1..n as u32).map(|r| (r, r - 1)).collect();
        let matrix = |spring: &dyn Fn(usize) -> f64| {
            let (mut diagonal, mut lower) = (vec![1.0; n], vec![0.0; n - 1]);
            for (i, below) in lower.iter_mut().enumerate() {
                *below = -spring(i);
                diagonal[i] += spring(i);
                diagonal[i + 1] += spring(i);
            }
            [diagonal, lower]
        };
        let mut factors = Fronts::<f32>::new(n, &entries);
        let [diagonal, lower] = matrix(&|_| 1e3);
        factors.factorise(&diagonal, &lower, 1.0).expect("diagonally dominant");
        let [diagonal, lower] = matrix(&|i| if i % 50 == 7 { 1.0 } else { 1e3 });
        let a = [&diagonal[..], &lower[..]];
        let exact: Vec<f64> = (0..n).map(|i| (0.1 * i as f64).sin()).collect();
        let mut search = Conjugate::new(n, &entries);
        let mut b = vec![0.0; n];
        multiply(&search.start, &search.row, a, &exact, &mut b);
        let mut x = vec![0.0; n];
        search.begin(a, &b, &x);
        for _ in 0..16 {
            search.advance(a, &mut x, &mut factors).expect("positive");
        }
        let off = x.iter().zip(&exact).fold(0.0f64, |m, (x, y)| m.max((x - y).abs()));
        let left = search.residual.iter().fold(0.0f64, |m, r| m.max(r.abs()));
        assert!(off < 1e-8 && left < 1e-6, "{off:e} {left:e}");
        // Where nothing is left it stays, and what was no number before is forgotten.
        search.begin(a, &vec![0.0; n], &vec![0.0; n]);
        let mut still = vec![0.0; n];
        assert_eq!((search.advance(a, &mut still, &mut factors), still), (Ok(()), vec![0.0; n]));
        search.begin(a, &vec![f64::NAN; n], &x);
        assert!(search.advance(a, &mut vec![0.0; n], &mut factors).is_err());
        let mut again = vec![0.0; n];
        search.begin(a, &b, &again);
        for _ in 0..16 {
            search.advance(a, &mut again, &mut factors).expect("positive");
        }
        assert!(again.iter().zip(&exact).all(|(x, y)| (x - y).abs() < 1e-8));
        // A spring that pushes apart: somewhere the curvature is negative.
        let [diagonal, lower] = matrix(&|i| if i == 300 { -1e3 } else { 1e3 });
        let a = [&diagonal[..], &lower[..]];
        search.begin(a, &b, &x);
        assert!((0..n).any(|_| search.advance(a, &mut x, &mut factors).is_err()));
    }
}
