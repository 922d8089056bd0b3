//! Matrices of 3 × 3 blocks with a pattern that is symmetric and stays: ordered and laid out once, factorised again and again.

use std::collections::BTreeSet;

use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};

/// A block, by rows of four for the sake of registers; the last column is 0.
pub type Block = [[f64; 4]; 3];
/// Three unknowns of a body.
pub type Triple = [f64; 3];

const ZERO: Block = [[0.0; 4]; 3];

/// A matrix in the order of elimination: for every row a diagonal block and the blocks right of it, fill included; those below the diagonal
/// are the same turned over, or stand beside them where the matrix is not symmetric. A = L D U, D of blocks.
#[derive(Debug, Clone)]
pub struct Blocks {
    /// Place in the order of elimination of each body.
    place: Vec<usize>,
    /// Start of each row's blocks in `columns`, by place.
    start: Vec<usize>,
    /// Places of the columns right of the diagonal, rising in each row.
    columns: Vec<usize>,
    /// What changes each row when those before it are eliminated, row by row, and where each row's begin.
    feeds: Vec<Feed>,
    fed: Vec<usize>,
    /// Per feed, for each block of the feeding row right of the one named there: which block of the fed row it changes.
    targets: Vec<u32>,
    diagonal: Vec<Block>,
    /// Blocks right of the diagonal, and those below it turned over, which are not looked at in a symmetric matrix.
    right: Vec<Block>,
    below: Vec<Block>,
    is_symmetric: bool,
    /// The eliminated diagonal blocks.
    pivots: Vec<Pivot>,
}

/// An eliminated row that changes another.
#[derive(Debug, Clone, Copy)]
struct Feed {
    row: u32,
    /// Where its block in the column of the other stands.
    at: u32,
}

/// A diagonal block by its own factors, P A = L D U with rows exchanged by P. Its inverse would not do: where contacts hold one direction of a
/// body 10⁸ times as stiffly as another, what it makes of the other is rounded by as much. And rows have to be exchanged where the matrix is not
/// symmetric: joints that slide may take a number on the diagonal through 0 in a block that is far from singular.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Pivot {
    /// Below the diagonal of L: second row, then third; of U turned over the same.
    l: [f64; 3],
    u: [f64; 3],
    /// 1/D.
    d: [f64; 3],
    /// Which row comes first, second and third.
    rows: [u8; 3],
}

impl Pivot {
    #[inline(always)]
    fn of<const SYMMETRIC: bool>(a: &Block) -> Self {
        let mut a = *a;
        let mut rows = [0, 1, 2];
        let mut first = |a: &mut Block, k: usize, i: usize| {
            if !SYMMETRIC && a[i][k].abs() > a[k][k].abs() {
                a.swap(i, k);
                rows.swap(i, k);
            }
        };
        first(&mut a, 0, 1);
        first(&mut a, 0, 2);
        let d0 = 1.0 / a[0][0];
        for i in 1..3 {
            a[i][0] *= d0;
            (1..3).for_each(|j| a[i][j] -= a[i][0] * a[0][j]);
        }
        first(&mut a, 1, 2);
        let d1 = 1.0 / a[1][1];
        a[2][1] *= d1;
        let d2 = 1.0 / (a[2][2] - a[2][1] * a[1][2]);
        Pivot { l: [a[1][0], a[2][0], a[2][1]], u: [a[0][1] * d0, a[0][2] * d0, a[1][2] * d1], d: [d0, d1, d2], rows }
    }

    /// A⁻¹ of the columns of a block.
    #[inline(always)]
    fn solved(&self, b: &Block) -> Block {
        swept(self.l, self.d, self.u, self.rows.map(|row| b[row as usize]))
    }

    /// The same of A turned over.
    #[inline(always)]
    fn solved_turned(&self, b: &Block) -> Block {
        let y = swept(self.u, self.d, self.l, *b);
        let mut x = ZERO;
        (0..3).for_each(|k| x[self.rows[k] as usize] = y[k]);
        x
    }

    #[inline]
    fn solve(&self, b: Triple) -> Triple {
        let y = self.rows.map(|row| b[row as usize]);
        let ([l10, l20, l21], [u10, u20, u21]) = (self.l, self.u);
        let y1 = y[1] - l10 * y[0];
        let z2 = (y[2] - l20 * y[0] - l21 * y1) * self.d[2];
        let z1 = y1 * self.d[1] - u21 * z2;
        [y[0] * self.d[0] - u10 * z1 - u20 * z2, z1, z2]
    }
}

/// What L D U, U turned over, makes the columns of a block.
#[inline(always)]
fn swept([l10, l20, l21]: [f64; 3], d: [f64; 3], [u10, u20, u21]: [f64; 3], mut y: Block) -> Block {
    for j in 0..4 {
        y[1][j] -= l10 * y[0][j];
        y[2][j] = (y[2][j] - l20 * y[0][j] - l21 * y[1][j]) * d[2];
        y[1][j] = y[1][j] * d[1] - u21 * y[2][j];
        y[0][j] = y[0][j] * d[0] - u10 * y[1][j] - u20 * y[2][j];
    }
    y
}

/// [`Blocks::factorise`] compiled for some registers.
struct Elimination<'a>(&'a mut Blocks);

impl WithSimd for Elimination<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        match self.0.is_symmetric {
            true => self.0.eliminate::<true>(),
            false => self.0.eliminate::<false>(),
        }
    }
}

/// Factors of a symmetric matrix, to be kept.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Factors {
    right: Vec<Block>,
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
        let (order, rows) = grouped(eliminated(near));
        let mut place = vec![0; bodies];
        order.iter().enumerate().for_each(|(k, &body)| place[body] = k);
        let (mut start, mut columns) = (vec![0], Vec::new());
        for row in &rows {
            let mut row: Vec<usize> = row.iter().map(|&b| place[b]).collect();
            row.sort_unstable();
            columns.extend(row);
            start.push(columns.len());
        }
        let mut blocks = Blocks {
            place,
            start,
            feeds: Vec::with_capacity(columns.len()),
            fed: vec![0],
            targets: Vec::new(),
            diagonal: vec![ZERO; bodies],
            right: vec![ZERO; columns.len()],
            below: vec![ZERO; columns.len()],
            columns,
            is_symmetric: true,
            pivots: vec![Pivot::default(); bodies],
        };
        blocks.link();
        blocks
    }

    /// What changes each row.
    fn link(&mut self) {
        let n = self.diagonal.len();
        let (mut feeds, mut targets) = (vec![Vec::new(); n], Vec::new());
        for row in 0..n {
            for at in self.start[row]..self.start[row + 1] {
                feeds[self.columns[at]].push(Feed { row: row as u32, at: at as u32 });
            }
        }
        for (own, feeds) in feeds.iter().enumerate() {
            for feed in feeds {
                let others = &self.columns[feed.at as usize + 1..self.start[feed.row as usize + 1]];
                let places = others.iter().map(|&j| (self.find(own, j) - self.start[own]) as u32);
                targets.extend(places);
            }
            self.feeds.extend(feeds);
            self.fed.push(self.feeds.len());
        }
        self.targets = targets;
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

    /// A symmetric matrix, all zero but for the diagonal, which gets `diagonal` by body.
    pub fn reset(&mut self, diagonal: &[Triple]) {
        self.is_symmetric = true;
        self.right.fill(ZERO);
        for (body, values) in diagonal.iter().enumerate() {
            let block = &mut self.diagonal[self.place[body]];
            *block = ZERO;
            (0..3).for_each(|k| block[k][k] = values[k]);
        }
    }

    /// The same of one that need not be symmetric.
    pub fn reset_whole(&mut self, diagonal: &[Triple]) {
        self.reset(diagonal);
        self.is_symmetric = false;
        self.below.fill(ZERO);
    }

    /// Adds `times` the square of a row of one body.
    pub fn add(&mut self, body: usize, times: f64, row: Triple) {
        add_outer(&mut self.diagonal[self.place[body]], times, row, row);
    }

    /// Adds a column times a row to the block of one body; the sum of what is added to a symmetric matrix has to be symmetric.
    pub fn add_product(&mut self, body: usize, column: Triple, row: Triple) {
        add_outer(&mut self.diagonal[self.place[body]], 1.0, column, row);
    }

    /// Adds `times` the product of the rows of a pair's two bodies, to a symmetric matrix.
    pub fn add_pair(&mut self, slot: Slot, times: f64, [a, b]: [Triple; 2]) {
        debug_assert!(self.is_symmetric);
        let (first, second) = if slot.turned { (b, a) } else { (a, b) };
        add_outer(&mut self.right[slot.at], times, first, second);
    }

    /// Adds the columns of a pair's two bodies times the rows of the other, to a matrix that need not be symmetric.
    pub fn add_products(&mut self, slot: Slot, columns: [Triple; 2], rows: [Triple; 2]) {
        debug_assert!(!self.is_symmetric);
        let (first, second) = if slot.turned { (1, 0) } else { (0, 1) };
        add_outer(&mut self.right[slot.at], 1.0, columns[first], rows[second]);
        add_outer(&mut self.below[slot.at], 1.0, rows[first], columns[second]);
    }

    /// Eliminates row by row.
    pub fn factorise(&mut self) {
        // In the widest registers there are; nothing is fused, so that bits do not tell them apart.
        Arch::new().dispatch(Elimination(self));
    }

    /// Every row takes what those before it change: it stays near while they pass by.
    #[inline(always)]
    fn eliminate<const SYMMETRIC: bool>(&mut self) {
        let Blocks { start, feeds, fed, targets, diagonal, right, below, pivots, .. } = self;
        let mut targets = &targets[..];
        for own in 0..pivots.len() {
            let (before, after) = right.split_at_mut(start[own]);
            let row = &mut after[..start[own + 1] - start[own]];
            let (before_below, after) = below.split_at_mut(start[own]);
            let row_below = &mut after[..row.len()];
            let mut square = diagonal[own];
            for feed in &feeds[fed[own]..fed[own + 1]] {
                let (at, end) = (feed.at as usize, start[feed.row as usize + 1]);
                let pivot = pivots[feed.row as usize];
                let forth = pivot.solved(&before[at]);
                let back = if SYMMETRIC { forth } else { pivot.solved_turned(&before_below[at]) };
                subtract_product(&mut square, &back, &before[at]);
                let (own_targets, others) = targets.split_at(end - at - 1);
                targets = others;
                for (source, target) in before[at + 1..end].iter().zip(own_targets) {
                    subtract_product(&mut row[*target as usize], &back, source);
                }
                if !SYMMETRIC {
                    for (source, target) in before_below[at + 1..end].iter().zip(own_targets) {
                        subtract_product(&mut row_below[*target as usize], &forth, source);
                    }
                }
            }
            pivots[own] = Pivot::of::<SYMMETRIC>(&square);
        }
    }

    /// Solves with the factors, in place; `work` has as many triples as there are bodies.
    pub fn solve(&self, x: &mut [Triple], work: &mut [Triple]) {
        for (body, value) in x.iter().enumerate() {
            work[self.place[body]] = *value;
        }
        let below = if self.is_symmetric { &self.right } else { &self.below };
        for k in 0..work.len() {
            let value = self.pivots[k].solve(work[k]);
            work[k] = value;
            let own = self.start[k]..self.start[k + 1];
            for (column, block) in self.columns[own.clone()].iter().zip(&below[own]) {
                subtract_transposed(&mut work[*column], block, value);
            }
        }
        for k in (0..work.len()).rev() {
            let mut sum = [0.0; 3];
            let own = self.start[k]..self.start[k + 1];
            for (column, block) in self.columns[own.clone()].iter().zip(&self.right[own]) {
                add_times(&mut sum, block, work[*column]);
            }
            let back = self.pivots[k].solve(sum);
            (0..3).for_each(|i| work[k][i] -= back[i]);
        }
        for (body, value) in x.iter_mut().enumerate() {
            *value = work[self.place[body]];
        }
    }

    /// The factors of a symmetric matrix as they are.
    pub fn keep(&self) -> Factors {
        debug_assert!(self.is_symmetric);
        Factors { right: self.right.clone(), pivots: self.pivots.clone() }
    }

    /// Takes factors of this pattern; false where they are of another.
    pub fn take_up(&mut self, factors: Factors) -> bool {
        let Factors { right, pivots } = factors;
        let fits = right.len() == self.right.len() && pivots.len() == self.pivots.len();
        if fits {
            (self.right, self.pivots, self.is_symmetric) = (right, pivots, true);
        }
        fits
    }

    /// Blocks right of the diagonal, fill included.
    pub fn fill(&self) -> usize {
        self.columns.len()
    }
}

/// The order in which bodies are eliminated, and the neighbours that each has left then.
type Order = (Vec<usize>, Vec<Vec<usize>>);

/// Minimum degree.
fn eliminated(mut near: Vec<BTreeSet<usize>>) -> Order {
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

/// The same elimination with what feeds a row right before it, by the tree of who feeds whom first.
fn grouped((order, rows): Order) -> Order {
    let n = order.len();
    let mut place = vec![0; n];
    order.iter().enumerate().for_each(|(k, &body)| place[body] = k);
    let mut feeders: Vec<Vec<usize>> = vec![Vec::new(); n];
    let mut open = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        match row.iter().map(|b| place[*b]).min() {
            Some(next) => feeders[next].push(k),
            None => open.push(k),
        }
    }
    // Every one before those that feed it, and then backwards.
    let mut last_first = Vec::with_capacity(n);
    while let Some(k) = open.pop() {
        last_first.push(k);
        open.extend(&feeders[k]);
    }
    last_first.reverse();
    last_first.iter().map(|&k| (order[k], rows[k].clone())).unzip()
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

    /// A grid of bodies with diagonals.
    fn grid(w: usize, h: usize) -> Vec<(usize, usize)> {
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
        pairs
    }

    /// A matrix of seeded values solves what it multiplied, whether it is symmetric or not; the next one of the same pattern too.
    #[test]
    fn solves_what_it_multiplied() {
        // A grid, another beside it, and a body alone.
        let n = 42 + 12 + 1;
        let mut pairs = grid(7, 6);
        pairs.extend(grid(4, 3).iter().map(|(a, b)| (a + 42, b + 42)));
        let mut seed = 1u64;
        let mut draw = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / (1u64 << 31) as f64 - 0.5
        };
        let mut blocks = Blocks::new(n, &pairs);
        assert!(blocks.fill() < 4 * pairs.len());
        for symmetric in [true, false, true] {
            let mut dense = vec![vec![0.0; 3 * n]; 3 * n];
            let own = [0.9, 0.8, 0.7];
            if symmetric {
                blocks.reset(&vec![own; n])
            } else {
                blocks.reset_whole(&vec![own; n])
            }
            (0..3 * n).for_each(|k| dense[k][k] = own[k % 3]);
            for &(a, b) in &pairs {
                let rows = [[draw(), draw(), draw()], [draw(), draw(), draw()]];
                // Towards the rows turned by a bit: more than half of the product stays symmetric.
                let bent = if symmetric { 0.0 } else { 0.3 };
                let columns = rows.map(|row| row.map(|x| x + bent * draw()));
                if symmetric {
                    blocks.add_pair(blocks.slot(a, b), 1.0, rows);
                    blocks.add(a, 1.0, rows[0]);
                    blocks.add(b, 1.0, rows[1]);
                } else {
                    blocks.add_products(blocks.slot(a, b), columns, rows);
                    blocks.add_product(a, columns[0], rows[0]);
                    blocks.add_product(b, columns[1], rows[1]);
                }
                let both = [a, b];
                for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                    dense[3 * both[i / 3] + i % 3][3 * both[j / 3] + j % 3] +=
                        columns[i / 3][i % 3] * rows[j / 3][j % 3];
                }
            }
            let wanted: Vec<Triple> = (0..n).map(|_| [draw(), draw(), draw()]).collect();
            let flat: Vec<f64> = wanted.iter().flatten().copied().collect();
            let product = |row: &Vec<f64>| row.iter().zip(&flat).map(|(a, b)| a * b).sum::<f64>();
            let mut x: Vec<Triple> = (0..n).map(|k| [0, 1, 2].map(|i| product(&dense[3 * k + i]))).collect();
            blocks.factorise();
            blocks.solve(&mut x, &mut vec![[0.0; 3]; n]);
            let error = x.iter().flatten().zip(&flat).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-12, "{error:e}");
        }
    }
}
