//! Symmetric matrices of 3 × 3 blocks with a pattern that stays: ordered and laid out once, factorised again and again.

use std::collections::BTreeSet;

use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};

/// A block, by rows of four for the sake of registers; the last column is 0.
pub type Block = [[f64; 4]; 3];
/// Three unknowns of a body.
pub type Triple = [f64; 3];

const ZERO: Block = [[0.0; 4]; 3];

/// A symmetric positive definite matrix in the order of elimination: for every row a diagonal block and the blocks right
/// of it, fill included. A = Uᵀ D U, D of blocks.
#[derive(Debug, Clone)]
pub struct Blocks {
    /// Place in the order of elimination of each body.
    place: Vec<usize>,
    /// Start of each row's blocks in `columns`, by place.
    start: Vec<usize>,
    /// Places of the columns right of the diagonal, rising in each row.
    columns: Vec<usize>,
    /// What an elimination changes: per row and pair of its columns, where the block of the pair stands; the diagonal
    /// blocks follow those right of it.
    targets: Vec<u32>,
    /// Blocks right of the diagonal, row by row, then the diagonal ones.
    values: Vec<Block>,
    /// The eliminated diagonal blocks.
    pivots: Vec<Pivot>,
}

/// A diagonal block by its own factors L D Lᵀ. Its inverse would not do: where contacts hold one direction of a body 10⁸ times as stiffly as
/// another, what it makes of the other is rounded by as much.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Pivot {
    /// Below the diagonal of L: second row, then third.
    l: [f64; 3],
    /// 1/D.
    d: [f64; 3],
}

impl Pivot {
    #[inline(always)]
    fn of(a: &Block) -> Self {
        let d0 = 1.0 / a[0][0];
        let l = [a[1][0] * d0, a[2][0] * d0];
        let d1 = 1.0 / (a[1][1] - l[0] * a[1][0]);
        let below = a[2][1] - l[1] * a[1][0];
        let l21 = below * d1;
        let d2 = 1.0 / (a[2][2] - l[1] * a[2][0] - l21 * below);
        Pivot { l: [l[0], l[1], l21], d: [d0, d1, d2] }
    }

    /// A⁻¹ of the columns of a block.
    #[inline(always)]
    fn solved(&self, b: &Block) -> Block {
        let mut y = *b;
        let [l10, l20, l21] = self.l;
        for j in 0..4 {
            y[1][j] -= l10 * y[0][j];
            y[2][j] = (y[2][j] - l20 * y[0][j] - l21 * y[1][j]) * self.d[2];
            y[1][j] = y[1][j] * self.d[1] - l21 * y[2][j];
            y[0][j] = y[0][j] * self.d[0] - l10 * y[1][j] - l20 * y[2][j];
        }
        y
    }

    #[inline]
    fn solve(&self, x: Triple) -> Triple {
        let [l10, l20, l21] = self.l;
        let y1 = x[1] - l10 * x[0];
        let z2 = (x[2] - l20 * x[0] - l21 * y1) * self.d[2];
        let z1 = y1 * self.d[1] - l21 * z2;
        [x[0] * self.d[0] - l10 * z1 - l20 * z2, z1, z2]
    }
}

/// [`Blocks::factorise`] compiled for some registers.
struct Elimination<'a>(&'a mut Blocks);

impl WithSimd for Elimination<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.eliminate();
    }
}

/// Factors of a matrix, to be kept.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Factors {
    values: Vec<Block>,
    pivots: Vec<Pivot>,
}

/// Where the block of a pair of bodies stands, and whether the second of them comes first there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    at: usize,
    turned: bool,
}

impl Blocks {
    /// With a block for each body and each of `pairs`, all zero.
    pub fn new(bodies: usize, pairs: &[(usize, usize)]) -> Self {
        let mut near: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); bodies];
        for &(a, b) in pairs {
            near[a].insert(b);
            near[b].insert(a);
        }
        let (order, rows) = eliminated(near);
        let mut place = vec![0; bodies];
        order.iter().enumerate().for_each(|(k, &body)| place[body] = k);
        let (mut start, mut columns) = (vec![0], Vec::new());
        for row in &rows {
            let mut row: Vec<usize> = row.iter().map(|&b| place[b]).collect();
            row.sort_unstable();
            columns.extend(row);
            start.push(columns.len());
        }
        let values = vec![ZERO; columns.len() + bodies];
        let mut blocks =
            Blocks { place, start, columns, targets: Vec::new(), values, pivots: vec![Pivot::default(); bodies] };
        blocks.targets = blocks.updates();
        blocks
    }

    /// Per row, for every pair of its columns in the order of the loops of [`Blocks::factorise`].
    fn updates(&self) -> Vec<u32> {
        let mut targets = Vec::new();
        for k in 0..self.pivots.len() {
            let row = &self.columns[self.start[k]..self.start[k + 1]];
            for (first, &i) in row.iter().enumerate() {
                targets.push((self.columns.len() + i) as u32);
                targets.extend(row[first + 1..].iter().map(|&j| self.find(i, j) as u32));
            }
        }
        targets
    }

    /// Where column `j` stands in row `i`, both places; the pattern is closed under elimination, so it is there.
    fn find(&self, i: usize, j: usize) -> usize {
        let from = self.start[i];
        from + self.columns[from..self.start[i + 1]].partition_point(|c| *c < j)
    }

    /// Where the block of a pair stands.
    pub fn slot(&self, a: usize, b: usize) -> Slot {
        let (i, j) = (self.place[a], self.place[b]);
        if i < j { Slot { at: self.find(i, j), turned: false } } else { Slot { at: self.find(j, i), turned: true } }
    }

    /// All zero but for the diagonal, which gets `diagonal` by body.
    pub fn reset(&mut self, diagonal: &[Triple]) {
        self.values.fill(ZERO);
        for (body, values) in diagonal.iter().enumerate() {
            let block = &mut self.values[self.columns.len() + self.place[body]];
            (0..3).for_each(|k| block[k][k] = values[k]);
        }
    }

    /// Adds `times` the square of a row of one body.
    pub fn add(&mut self, body: usize, times: f64, row: Triple) {
        add_outer(&mut self.values[self.columns.len() + self.place[body]], times, row, row);
    }

    /// Adds a column times a row to the block of one body; the sum of what is added has to be symmetric.
    pub fn add_product(&mut self, body: usize, column: Triple, row: Triple) {
        add_outer(&mut self.values[self.columns.len() + self.place[body]], 1.0, column, row);
    }

    /// Adds `times` the product of the rows of a pair's two bodies.
    pub fn add_pair(&mut self, slot: Slot, times: f64, [a, b]: [Triple; 2]) {
        let (first, second) = if slot.turned { (b, a) } else { (a, b) };
        add_outer(&mut self.values[slot.at], times, first, second);
    }

    /// Eliminates row by row.
    pub fn factorise(&mut self) {
        // In the widest registers there are; nothing is fused, so that bits do not tell them apart.
        Arch::new().dispatch(Elimination(self));
    }

    #[inline(always)]
    fn eliminate(&mut self) {
        let Blocks { start, columns, targets, values, pivots, .. } = self;
        let mut targets = targets.iter();
        for k in 0..pivots.len() {
            let own = Pivot::of(&values[columns.len() + k]);
            pivots[k] = own;
            // What a row changes comes after it.
            let (rows, after) = values.split_at_mut(start[k + 1]);
            let row = &rows[start[k]..];
            for (first, left) in row.iter().enumerate() {
                let factor = own.solved(left);
                for (right, target) in row[first..].iter().zip(&mut targets) {
                    subtract_product(&mut after[*target as usize - start[k + 1]], &factor, right);
                }
            }
        }
    }

    /// Solves with the factors, in place; `work` has as many triples as there are bodies.
    pub fn solve(&self, x: &mut [Triple], work: &mut [Triple]) {
        for (body, value) in x.iter().enumerate() {
            work[self.place[body]] = *value;
        }
        for k in 0..work.len() {
            let value = self.pivots[k].solve(work[k]);
            work[k] = value;
            for at in self.start[k]..self.start[k + 1] {
                subtract_transposed(&mut work[self.columns[at]], &self.values[at], value);
            }
        }
        for k in (0..work.len()).rev() {
            let mut sum = [0.0; 3];
            for at in self.start[k]..self.start[k + 1] {
                add_times(&mut sum, &self.values[at], work[self.columns[at]]);
            }
            let back = self.pivots[k].solve(sum);
            (0..3).for_each(|i| work[k][i] -= back[i]);
        }
        for (body, value) in x.iter_mut().enumerate() {
            *value = work[self.place[body]];
        }
    }

    /// The factors as they are.
    pub fn keep(&self) -> Factors {
        Factors { values: self.values.clone(), pivots: self.pivots.clone() }
    }

    /// Takes factors of this pattern; false where they are of another.
    pub fn take_up(&mut self, factors: Factors) -> bool {
        let Factors { values, pivots } = factors;
        let fits = values.len() == self.values.len() && pivots.len() == self.pivots.len();
        if fits {
            (self.values, self.pivots) = (values, pivots);
        }
        fits
    }

    /// Blocks right of the diagonal, fill included.
    pub fn fill(&self) -> usize {
        self.columns.len()
    }
}

/// Minimum degree: the order in which bodies are eliminated, and the neighbours that each has left then.
fn eliminated(mut near: Vec<BTreeSet<usize>>) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut queue: BTreeSet<(usize, usize)> = near.iter().enumerate().map(|(b, n)| (n.len(), b)).collect();
    let (mut order, mut rows) = (Vec::new(), Vec::new());
    while let Some((_, body)) = queue.pop_first() {
        let row: Vec<usize> = std::mem::take(&mut near[body]).into_iter().collect();
        for &i in &row {
            queue.remove(&(near[i].len(), i));
            near[i].remove(&body);
            near[i].extend(row.iter().filter(|j| **j != i));
        }
        for &i in &row {
            queue.insert((near[i].len(), i));
        }
        order.push(body);
        rows.push(row);
    }
    (order, rows)
}

fn add_outer(block: &mut Block, times: f64, column: Triple, row: Triple) {
    for i in 0..3 {
        for j in 0..3 {
            block[i][j] += times * column[i] * row[j];
        }
    }
}

/// c − aᵀ b.
#[inline(always)]
fn subtract_product(c: &mut Block, a: &Block, b: &Block) {
    for i in 0..3 {
        for j in 0..4 {
            c[i][j] -= a[0][i] * b[0][j] + a[1][i] * b[1][j] + a[2][i] * b[2][j];
        }
    }
}

#[inline]
fn add_times(y: &mut Triple, a: &Block, x: Triple) {
    for i in 0..3 {
        y[i] += a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2];
    }
}

#[inline]
fn subtract_transposed(y: &mut Triple, a: &Block, x: Triple) {
    for i in 0..3 {
        y[i] -= a[0][i] * x[0] + a[1][i] * x[1] + a[2][i] * x[2];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of bodies with diagonals, values from a seeded sequence.
    #[test]
    fn solves_what_it_multiplied() {
        let (w, h) = (7, 6);
        let mut pairs = Vec::new();
        for k in 0..w * h {
            let (x, y) = (k % w, k / w);
            if x + 1 < w {
                pairs.push((k, k + 1));
            }
            if y + 1 < h {
                pairs.push((k + w, k));
            }
            if x + 1 < w && y + 1 < h {
                pairs.push((k, k + w + 1));
            }
        }
        let mut seed = 1u64;
        let mut draw = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / (1u64 << 31) as f64 - 0.5
        };
        let n = w * h;
        let mut blocks = Blocks::new(n, &pairs);
        let mut dense = vec![vec![0.0; 3 * n]; 3 * n];
        blocks.reset(&vec![[0.9, 0.8, 0.7]; n]);
        for k in 0..n {
            (0..3).for_each(|i| dense[3 * k + i][3 * k + i] = [0.9, 0.8, 0.7][i]);
        }
        for &(a, b) in &pairs {
            let (rows, weight) = ([[draw(), draw(), draw()], [draw(), draw(), draw()]], 1.0 + draw());
            blocks.add_pair(blocks.slot(a, b), weight, rows);
            blocks.add(a, weight, rows[0]);
            blocks.add(b, weight, rows[1]);
            let both: Vec<(usize, f64)> =
                (0..3).map(|k| (3 * a + k, rows[0][k])).chain((0..3).map(|k| (3 * b + k, rows[1][k]))).collect();
            for &(i, x) in &both {
                both.iter().for_each(|&(j, y)| dense[i][j] += weight * x * y);
            }
        }
        let wanted: Vec<Triple> = (0..n).map(|_| [draw(), draw(), draw()]).collect();
        let flat: Vec<f64> = wanted.iter().flatten().copied().collect();
        let mut x: Vec<Triple> =
            (0..n).map(|k| [0, 1, 2].map(|i| dense[3 * k + i].iter().zip(&flat).map(|(a, b)| a * b).sum())).collect();
        blocks.factorise();
        blocks.solve(&mut x, &mut vec![[0.0; 3]; n]);
        let error = x.iter().flatten().zip(&flat).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-13, "{error:e}");
        assert!(blocks.fill() < 4 * pairs.len());
    }
}
