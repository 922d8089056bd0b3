//! Sparse factorisation with a pattern settled once: A = L D U with unit triangles, U = Lᵀ when A is symmetric.
//!
//! The order is that of `order`; the unsymmetric case has a symmetric pattern because every entry is a joint. Unknowns
//! are numbered by their place in that order throughout, so that nothing is permuted while solving. Small systems are
//! eliminated column by column along a list of all updates made beforehand; larger symmetric ones as `fronts` says; large
//! unsymmetric ones row by row after T. A. Davis, *Direct Methods for Sparse Linear Systems*, SIAM 2006, sections
//! 4.7–4.8. No pivoting: the stage matrix is symmetric positive definite for any step that makes sense, and
//! a pivot that is not positive is reported instead of divided by. Nothing is allocated after [`Matrix::new`].

use crate::integrate::conjugate::{Conjugate, largest};
use crate::integrate::dense_columns::NotPositive;
use crate::integrate::fronts::Fronts;
use crate::integrate::order::{elimination_order, postordered};

/// Unknowns up to which a list of updates is faster than fronts.
pub const MOST_LISTED: usize = 256;
/// Updates up to which the list of them is kept without symmetry (12 bytes each).
const LONGEST_LIST: usize = 200_000;

/// A matrix with the pattern of a joint graph, and its factors.
#[derive(Debug, Clone)]
pub struct Matrix {
    n: usize,
    /// Place of each unknown in the elimination order.
    place: Vec<u32>,
    /// Diagonal of A, then D⁻¹.
    pub diagonal: Vec<f64>,
    /// The pattern of L by columns: where each starts, row and column of every entry.
    start: Vec<u32>,
    row: Vec<u32>,
    column: Vec<u32>,
    /// A below the diagonal, and its mirror image above; destroyed by the factorisation.
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    /// L, and U by rows.
    scaled: Vec<f64>,
    turned: Vec<f64>,
    /// Entries and updates of every column.
    counts: Vec<[u32; 2]>,
    /// For every column and every two rows in it, the later one outside: where their update goes, and the two entries.
    /// Empty when it would be too long (without symmetry only).
    updates: Vec<[u32; 3]>,
    /// Rows of L: columns, ascending, and where they stand in `lower`.
    reach_start: Vec<u32>,
    reach: Vec<Reach>,
    x: Vec<f64>,
    y: Vec<f64>,
    /// What large symmetric systems have instead of `start` to `y`, `lower` excepted; that holds the entries of A alone.
    fronts: Option<Fronts<f64>>,
    /// The same where factors lead a search.
    led: Option<Led>,
    symmetric: bool,
}

/// Which systems a matrix is made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Factoring {
    /// Factorised whenever it changes.
    Symmetric,
    /// Factorised now and then, in single precision: its factors lead a search ([`Matrix::begin`]) and solve nothing.
    Led,
    /// Factorised whenever it changes.
    Unsymmetric,
}

/// Factors that lead a search, and the search.
#[derive(Debug, Clone)]
struct Led {
    factors: Fronts<f32>,
    search: Conjugate,
}

#[derive(Debug, Clone, Copy)]
struct Reach {
    column: u32,
    at: u32,
}

/// Diagonal of the factors that lead over that of the matrix, where without it they are not positive.
const LIFTED: f64 = 1.0 + 1e-5;
/// What a rough solution may leave, over the right side, and iterations for it at most.
const ROUGH: f64 = 0.25;
const MOST_ROUGH: usize = 8;

impl Matrix {
    /// A matrix of order `n` with a diagonal and the pairs (i, j), i ≠ j, on both sides of it; `at` is where the first
    /// unknowns lie. Returns too where each pair stands in `lower` and `upper`; only an unsymmetric matrix has an `upper`.
    pub fn new(n: usize, pairs: &[(usize, usize)], at: &[[f64; 2]], kind: Factoring) -> (Self, Vec<u32>) {
        let place = elimination_order(n, pairs, at);
        let symmetric = kind != Factoring::Unsymmetric;
        let leads = kind == Factoring::Led;
        match symmetric && n > MOST_LISTED {
            true => Self::by_fronts(n, place, pairs, leads),
            false => Self::by_entries(n, place, pairs, symmetric),
        }
    }

    fn by_fronts(n: usize, mut place: Vec<u32>, pairs: &[(usize, usize)], leads: bool) -> (Self, Vec<u32>) {
        let mut entries = below_diagonal(&place, pairs);
        postordered(&mut place, &mut entries);
        let all = below_diagonal(&place, pairs);
        let mut entries = all.clone();
        entries.sort_unstable_by_key(|&(r, c)| (c, r));
        entries.dedup();
        let slot = |&(r, c): &(u32, u32)| entries.partition_point(|&(s, d)| (d, s) < (c, r)) as u32;
        let slots = all.iter().map(slot).collect();
        let lower = vec![0.0; entries.len()];
        let mut matrix = Self::empty(n, place, true);
        matrix.lower = lower;
        if leads {
            matrix.led = Some(Led { factors: Fronts::new(n, &entries), search: Conjugate::new(n, &entries) });
        } else {
            matrix.fronts = Some(Fronts::new(n, &entries));
        }
        (matrix, slots)
    }

    fn empty(n: usize, place: Vec<u32>, symmetric: bool) -> Self {
        Matrix {
            n,
            place,
            diagonal: vec![0.0; n],
            start: Vec::new(),
            row: Vec::new(),
            column: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
            scaled: Vec::new(),
            turned: Vec::new(),
            counts: Vec::new(),
            updates: Vec::new(),
            reach_start: Vec::new(),
            reach: Vec::new(),
            x: Vec::new(),
            y: Vec::new(),
            fronts: None,
            led: None,
            symmetric,
        }
    }

    fn by_entries(n: usize, place: Vec<u32>, pairs: &[(usize, usize)], symmetric: bool) -> (Self, Vec<u32>) {
        let entries = below_diagonal(&place, pairs);
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); n];
        for &(r, c) in &entries {
            rows[r as usize].push(c);
        }
        let (start, row, reach_start, reach) = symbolic(&rows);
        let at = |r: u32, c: u32| {
            let (s, e) = (start[c as usize] as usize, start[c as usize + 1] as usize);
            (s + row[s..e].partition_point(|&x| x < r)) as u32
        };
        let slots = entries.iter().map(|&(r, c)| at(r, c)).collect();
        let columns = || (0..n).map(|k| &row[start[k] as usize..start[k + 1] as usize]);
        let count: usize = columns().map(|c| c.len() * c.len().saturating_sub(1) / 2).sum();
        let mut updates = Vec::new();
        if symmetric || count <= LONGEST_LIST {
            for k in 0..n {
                let first = start[k];
                let column = &row[first as usize..start[k + 1] as usize];
                for (p, &r) in (first..).zip(column) {
                    updates.extend((first..p).zip(column).map(|(q, &c)| [at(r, c), p, q]));
                }
            }
        }
        let counts = columns().map(|c| [c.len(), c.len() * c.len().saturating_sub(1) / 2].map(|x| x as u32)).collect();
        let column = (0..n as u32).flat_map(|k| std::iter::repeat_n(k, columns_of(&start, k))).collect();
        let fill = row.len();
        let above = if symmetric { 0 } else { fill };
        let rows = if updates.is_empty() { n } else { 0 };
        let matrix = Matrix {
            start,
            row,
            column,
            scaled: vec![0.0; fill],
            turned: vec![0.0; above],
            counts,
            lower: vec![0.0; fill],
            upper: vec![0.0; above],
            updates,
            reach_start,
            reach,
            x: vec![0.0; rows],
            y: vec![0.0; rows],
            ..Self::empty(n, place, symmetric)
        };
        (matrix, slots)
    }

    /// Whether it is of [`Factoring::Led`], and large enough for it.
    pub fn is_led(&self) -> bool {
        self.led.is_some()
    }

    /// Place of each unknown in the elimination order: the number it has in `diagonal` and in [`Matrix::solve`].
    pub fn places(&self) -> &[u32] {
        &self.place
    }

    /// The pattern of L by columns: where each starts, and the row of every entry.
    pub fn pattern(&self) -> (&[u32], &[u32]) {
        (&self.start, &self.row)
    }

    /// Factorises what `diagonal`, `lower` and, without symmetry, `upper` hold; they may be destroyed.
    ///
    /// # Errors
    /// [`NotPositive`] when a pivot is not above zero; the factors are then of no use.
    #[inline(always)]
    pub fn factorise(&mut self) -> Result<(), NotPositive> {
        if let Some(fronts) = &mut self.fronts {
            return fronts.factorise(&self.diagonal, &self.lower, 1.0);
        }
        if let Some(led) = &mut self.led {
            let [diagonal, lower] = [&self.diagonal, &self.lower];
            // Single precision loses the mass beside springs 10⁷ times as large; what only leads may do without it.
            return (led.factors.factorise(diagonal, lower, 1.0))
                .or_else(|_| led.factors.factorise(diagonal, lower, LIFTED));
        }
        if self.symmetric {
            self.columns_symmetric()
        } else if self.updates.is_empty() && self.row.len() >= self.n {
            self.rows_unsymmetric()
        } else {
            self.columns_unsymmetric()
        }
    }

    /// Column by column; loops are flat because columns are short.
    #[inline(always)]
    fn columns_symmetric(&mut self) -> Result<(), NotPositive> {
        let (diagonal, lower, scaled) = (&mut self.diagonal[..], &mut self.lower[..], &mut self.scaled[..]);
        let (mut rows, mut updates, mut from) = (&self.row[..], &self.updates[..], 0);
        for k in 0..diagonal.len() {
            let d = diagonal[k];
            if !(d > 0.0) {
                return Err(NotPositive);
            }
            let inverse = 1.0 / d;
            diagonal[k] = inverse;
            let [entries, count] = self.counts[k].map(|c| c as usize);
            let (of_column, rest) = rows.split_at(entries);
            rows = rest;
            let to = from + entries;
            for ((&r, value), l) in of_column.iter().zip(&lower[from..to]).zip(&mut scaled[from..to]) {
                *l = value * inverse;
                diagonal[r as usize] -= *l * value;
            }
            from = to;
            let (of_column, rest) = updates.split_at(count);
            updates = rest;
            for &[at, p, q] in of_column {
                lower[at as usize] -= scaled[p as usize] * lower[q as usize];
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn columns_unsymmetric(&mut self) -> Result<(), NotPositive> {
        let (diagonal, lower, upper) = (&mut self.diagonal[..], &mut self.lower[..], &mut self.upper[..]);
        let (scaled, turned) = (&mut self.scaled[..], &mut self.turned[..]);
        let (mut updates, mut from) = (&self.updates[..], 0);
        for k in 0..diagonal.len() {
            let d = diagonal[k];
            if !(d > 0.0) {
                return Err(NotPositive);
            }
            let inverse = 1.0 / d;
            diagonal[k] = inverse;
            let [entries, count] = self.counts[k].map(|c| c as usize);
            for p in from..from + entries {
                scaled[p] = lower[p] * inverse;
                turned[p] = upper[p] * inverse;
                diagonal[self.row[p] as usize] -= scaled[p] * upper[p];
            }
            from += entries;
            let (of_column, rest) = updates.split_at(count);
            updates = rest;
            for &[at, p, q] in of_column {
                lower[at as usize] -= scaled[p as usize] * upper[q as usize];
                upper[at as usize] -= turned[p as usize] * lower[q as usize];
            }
        }
        Ok(())
    }

    fn rows_unsymmetric(&mut self) -> Result<(), NotPositive> {
        for i in 0..self.n {
            let reach = self.reach_start[i] as usize..self.reach_start[i + 1] as usize;
            for Reach { column, at } in &self.reach[reach.clone()] {
                self.x[*column as usize] = self.lower[*at as usize];
                self.y[*column as usize] = self.upper[*at as usize];
            }
            let mut d = self.diagonal[i];
            for t in reach {
                let Reach { column, at } = self.reach[t];
                let (k, at) = (column as usize, at as usize);
                let (xk, yk) = (self.x[k], self.y[k]);
                for p in self.start[k] as usize..at {
                    let r = self.row[p] as usize;
                    self.x[r] -= self.turned[p] * xk;
                    self.y[r] -= self.scaled[p] * yk;
                }
                let l = xk * self.diagonal[k];
                d -= l * yk;
                self.scaled[at] = l;
                self.turned[at] = yk * self.diagonal[k];
            }
            if !(d > 0.0) {
                return Err(NotPositive);
            }
            self.diagonal[i] = 1.0 / d;
        }
        Ok(())
    }

    /// Begins to seek x of A x = b at `x`, with the factors of another matrix: [`Factoring::Led`] alone.
    #[inline(always)]
    pub fn begin(&mut self, b: &[f64], x: &[f64]) {
        if let Some(led) = &mut self.led {
            led.search.begin([&self.diagonal, &self.lower], b, x);
        }
    }

    /// The next iteration of that.
    ///
    /// # Errors
    /// [`NotPositive`] where the matrix is not.
    #[inline(always)]
    pub fn advance(&mut self, x: &mut [f64]) -> Result<(), NotPositive> {
        let led = self.led.as_mut().ok_or(NotPositive)?;
        led.search.advance([&self.diagonal, &self.lower], x, &mut led.factors)
    }

    /// The matrix, b or the factors have changed.
    #[inline(always)]
    pub fn turn(&mut self) {
        if let Some(led) = &mut self.led {
            led.search.turn();
        }
    }

    /// Solves A x = b in place but for a quarter of b at most, from nothing; what eight iterations leave where that is more. Not
    /// a number where A is not positive.
    #[inline(always)]
    pub fn solve_roughly(&mut self, b: &mut [f64]) {
        let Some(led) = &mut self.led else { return };
        led.search.residual.copy_from_slice(b);
        led.search.turn();
        b.fill(0.0);
        let enough = ROUGH * largest(self.residual());
        for _ in 0..MOST_ROUGH {
            if self.advance(b).is_err() {
                return b.fill(f64::NAN);
            }
            if largest(self.residual()) <= enough {
                return;
            }
        }
    }

    /// The factors and the inverse pivots of [`Factoring::Led`].
    pub fn rough_factors(&self) -> Option<[&[f32]; 2]> {
        self.led.as_ref().map(|led| led.factors.numbers())
    }

    /// Takes them up; false where they are not as long as those that are there.
    pub fn take_up(&mut self, factors: &[Vec<f32>; 2]) -> bool {
        self.led.as_mut().is_some_and(|led| led.factors.take_up(factors))
    }

    /// b − A x of that.
    #[inline(always)]
    pub fn residual(&self) -> &[f64] {
        self.led.as_ref().map_or(&[], |led| &led.search.residual)
    }

    /// Adds a spring between the unknowns `sides`, whose entry is at `slot`, and what it bears at x.
    #[inline(always)]
    pub fn stiffen(&mut self, slot: Option<usize>, [a, b]: [usize; 2], spring: f64, bears: f64) {
        let Some(led) = &mut self.led else { return };
        self.diagonal[a] += spring;
        led.search.residual[a] -= bears;
        if let Some(slot) = slot {
            self.diagonal[b] += spring;
            self.lower[slot] -= spring;
            led.search.residual[b] += bears;
        }
    }

    /// Solves A x = b in place with the last factors; b by place.
    #[inline(always)]
    pub fn solve(&mut self, b: &mut [f64]) {
        let b = &mut b[..self.n];
        if let Some(fronts) = &mut self.fronts {
            return fronts.solve(b);
        }
        for ((&r, &c), l) in self.row.iter().zip(&self.column).zip(&self.scaled) {
            b[r as usize] -= l * b[c as usize];
        }
        for (b, d) in b.iter_mut().zip(&self.diagonal) {
            *b *= d;
        }
        let upper = if self.symmetric { &self.scaled } else { &self.turned };
        for ((&r, &c), u) in self.row.iter().zip(&self.column).zip(upper).rev() {
            b[c as usize] -= u * b[r as usize];
        }
    }
}

/// Row and column of every pair's entry below the diagonal.
fn below_diagonal(place: &[u32], pairs: &[(usize, usize)]) -> Vec<(u32, u32)> {
    pairs.iter().map(|&(i, j)| (place[i].max(place[j]), place[i].min(place[j]))).collect()
}

/// Entries of column `k`.
fn columns_of(start: &[u32], k: u32) -> usize {
    (start[k as usize + 1] - start[k as usize]) as usize
}

/// Columns of L and rows of L from the rows of the lower triangle of A (elimination tree reach).
fn symbolic(lower: &[Vec<u32>]) -> (Vec<u32>, Vec<u32>, Vec<u32>, Vec<Reach>) {
    const NONE: u32 = u32::MAX;
    let n = lower.len();
    let mut parent = vec![NONE; n];
    let mut mark = vec![NONE; n];
    let mut rows: Vec<Vec<u32>> = Vec::with_capacity(n);
    for i in 0..n {
        mark[i] = i as u32;
        let mut row = Vec::new();
        for &c in &lower[i] {
            let mut k = c;
            while mark[k as usize] != i as u32 {
                mark[k as usize] = i as u32;
                row.push(k);
                if parent[k as usize] == NONE {
                    parent[k as usize] = i as u32;
                }
                k = parent[k as usize];
            }
        }
        row.sort_unstable();
        rows.push(row);
    }
    let mut l_start = vec![0u32; n + 1];
    for &k in rows.iter().flatten() {
        l_start[k as usize + 1] += 1;
    }
    for k in 0..n {
        l_start[k + 1] += l_start[k];
    }
    let mut next = l_start.clone();
    let mut l_row = vec![0u32; l_start[n] as usize];
    let mut reach_start = vec![0u32];
    let mut reach = Vec::with_capacity(l_row.len());
    for (i, row) in rows.iter().enumerate() {
        for &k in row {
            let at = next[k as usize];
            next[k as usize] += 1;
            l_row[at as usize] = i as u32;
            reach.push(Reach { column: k, at });
        }
        reach_start.push(reach.len() as u32);
    }
    (l_start, l_row, reach_start, reach)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall-like grid with a dense row (a beam), against a dense product: A (A⁻¹ b) = b.
    #[test]
    fn solves_what_it_was_given() {
        let (w, h) = (7, 5);
        let n = w * h + 1;
        let mut pairs = Vec::new();
        for r in 0..h {
            for c in 0..w {
                let i = r * w + c;
                if c + 1 < w {
                    pairs.push((i, i + 1));
                }
                if r + 1 < h {
                    pairs.push((i, i + w));
                }
                if r + 1 == h {
                    pairs.push((i, n - 1));
                }
            }
        }
        for (symmetric, listed) in [(true, true), (false, true), (true, false), (false, false)] {
            let place = elimination_order(n, &pairs, &[]);
            let (mut m, slots) = match (symmetric, listed) {
                (true, false) => Matrix::by_fronts(n, place, &pairs, false),
                _ => Matrix::by_entries(n, place, &pairs, symmetric),
            };
            assert!(m.fronts.is_some() || !m.updates.is_empty());
            if !symmetric && !listed {
                m.updates.clear();
                (m.x, m.y) = (vec![0.0; n], vec![0.0; n]);
            }
            let place = m.places().to_vec();
            let mut dense = vec![vec![0.0; n]; n];
            for i in 0..n {
                dense[i][i] = 1.0 + 0.01 * i as f64;
            }
            for (e, (&(i, j), &slot)) in pairs.iter().zip(&slots).enumerate() {
                let s = 1.0 + (e % 5) as f64 * 100.0;
                let t = if symmetric { s } else { s * 1.3 };
                dense[i][i] += s;
                dense[i][j] -= s;
                dense[j][j] += t;
                dense[j][i] -= t;
                let (low, up) = if place[i] > place[j] { (s, t) } else { (t, s) };
                m.lower[slot as usize] -= low;
                if !symmetric {
                    m.upper[slot as usize] -= up;
                }
            }
            for i in 0..n {
                m.diagonal[place[i] as usize] = dense[i][i];
            }
            m.factorise().expect("diagonally dominant");
            let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
            let mut x = vec![0.0; n];
            for i in 0..n {
                x[place[i] as usize] = b[i];
            }
            m.solve(&mut x);
            for i in 0..n {
                let product: f64 = (0..n).map(|j| dense[i][j] * x[place[j] as usize]).sum();
                assert!((product - b[i]).abs() < 1e-11, "row {i}: {product} against {}", b[i]);
            }
        }
    }

    /// Three masses on springs a billion times as large, which single precision takes for all: factors lead all the same.
    #[test]
    fn masses_beside_large_springs_are_found() {
        let (k, b) = (1e9, [1.0, 2.0, -0.5]);
        let (mut m, slots) = Matrix::by_fronts(3, vec![0, 1, 2], &[(0, 1), (1, 2)], true);
        m.diagonal.copy_from_slice(&[1.0 + k, 1.0 + 2.0 * k, 1.0 + k]);
        slots.iter().for_each(|slot| m.lower[*slot as usize] = -k);
        m.factorise().expect("lifted");
        let mut x = [0.0; 3];
        m.begin(&b, &x);
        for _ in 0..6 {
            m.advance(&mut x).expect("positive");
        }
        // All move alike, by the sum of the impulses over that of the masses.
        assert!(x.iter().all(|x| (x - 2.5 / 3.0).abs() < 1e-6), "{x:?}");
        let mut rough = b;
        m.solve_roughly(&mut rough);
        assert!(m.residual().iter().all(|r| r.abs() <= 0.25 * 2.0), "{:?}", m.residual());
        rough = [0.0; 3];
        m.solve_roughly(&mut rough);
        assert_eq!(rough, [0.0; 3]);
    }

    #[test]
    fn reports_a_pivot_that_is_not_positive() {
        for (listed, coupling, expected) in
            [(true, 2.0, Err(NotPositive)), (false, 2.0, Err(NotPositive)), (true, -0.5, Ok(())), (false, -0.5, Ok(()))]
        {
            let (pairs, place) = ([(0, 1), (1, 2), (0, 2)], vec![0, 1, 2]);
            let (mut m, slots) = if listed {
                Matrix::by_entries(3, place, &pairs, true)
            } else {
                Matrix::by_fronts(3, place, &pairs, false)
            };
            m.diagonal.fill(1.0);
            m.lower[slots[0] as usize] = coupling;
            assert_eq!(m.factorise(), expected);
        }
    }
}
