//! Matrices of 3 × 3 blocks with a pattern that is symmetric and stays: ordered and laid out once, factorised again and again.

use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};

use crate::order::Orders;

/// A block, by rows of four for the sake of registers; the last column is 0.
pub type Block = [[f64; 4]; 3];
/// Three unknowns of a body.
pub type Triple = [f64; 3];

const ZERO: Block = [[0.0; 4]; 3];
/// One in so many rows that changed, and more, takes all rows to be eliminated anew, right sides with them.
const FEW: usize = 8;

/// As wide as a row of [`Both`].
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct Row;

/// A block right of the diagonal and, behind each of its rows, that of the block below the diagonal turned over, which is not looked at in a
/// symmetric matrix: what is eliminated changes both alike, and so a row of both is changed at once. The empty end aligns it to its rows.
#[derive(Debug, Clone, Copy)]
struct Both([[f64; 8]; 3], [Row; 0]);

impl Both {
    const ZERO: Self = Both([[0.0; 8]; 3], []);

    /// The block right of the diagonal.
    #[inline(always)]
    fn right(&self) -> Block {
        let part = |row: &[f64; 8]| [row[0], row[1], row[2], row[3]];
        [part(&self.0[0]), part(&self.0[1]), part(&self.0[2])]
    }

    /// These blocks where it is `fresh`, and otherwise as much more.
    #[inline(always)]
    fn take(&mut self, fresh: bool, blocks: [[f64; 8]; 3]) {
        for (own, row) in self.0.iter_mut().zip(blocks) {
            *own = std::array::from_fn(|j| if fresh { row[j] } else { own[j] + row[j] });
        }
    }

    /// What the factors have here: D⁻¹ L⁻¹ P of what is right of the diagonal, and what is below times U⁻¹.
    #[inline(always)]
    fn eliminate<const SYMMETRIC: bool>(&mut self, pivot: &Pivot) {
        let Pivot { l, u, d, .. } = pivot;
        let [a, b, c] = &pivot.rows;
        let start = |row: &[f64; 8]| [row[0], row[1], row[2], row[3]];
        let end = |row: &[f64; 8]| [row[4], row[5], row[6], row[7]];
        let right = [start(&self.0[*a as usize]), start(&self.0[*b as usize]), start(&self.0[*c as usize])];
        let below = if SYMMETRIC { right } else { [end(&self.0[0]), end(&self.0[1]), end(&self.0[2])] };
        let (right, below) = (swept(right, l), swept(below, u));
        for i in 0..3 {
            for j in 0..4 {
                self.0[i][j] = right[i][j] * d[i];
                self.0[i][4 + j] = below[i][j];
            }
        }
    }
}

/// A matrix in the order of elimination: for every row a diagonal block and the blocks right of it, fill included; those below the diagonal
/// are the same turned over, or stand behind them where the matrix is not symmetric. The factors take their place: 𝓛 𝓤 with P⁻¹ L D and U of
/// `Pivot` on their diagonals.
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
    targets: Vec<u16>,
    /// Where each row's begin among them.
    aimed: Vec<usize>,
    diagonal: Vec<Block>,
    /// Whether the rows that begin with the diagonal block have changed since they were last eliminated.
    changed: Vec<bool>,
    /// Blocks of the pairs, row by row: where each is among those of its row, where each row's begin, and what is in them.
    paired: Vec<u32>,
    first: Vec<usize>,
    given: Vec<Both>,
    /// Which matrix each block of a pair was last given for, and which this one is: what was not given for it is 0.
    stamps: Vec<u64>,
    stamp: u64,
    /// Factors off the diagonal, fill included.
    beside: Vec<Both>,
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

    /// L⁻¹ P of a triple.
    #[inline(always)]
    fn forth(&self, b: Triple) -> Triple {
        let [y0, y1, y2] = self.rows.map(|row| b[row as usize]);
        let y1 = y1 - self.l[0] * y0;
        [y0, y1, y2 - self.l[1] * y0 - self.l[2] * y1]
    }

    /// U⁻¹ of a triple.
    #[inline(always)]
    fn back(&self, [y0, y1, y2]: Triple) -> Triple {
        let y1 = y1 - self.u[2] * y2;
        [y0 - self.u[0] * y1 - self.u[1] * y2, y1, y2]
    }
}

/// [`Blocks::factorise`] compiled for some registers.
struct Factorising<'a, 'b>(&'a mut Blocks, &'b mut [Triple]);

impl WithSimd for Factorising<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Factorising(blocks, sides) = self;
        let given = &blocks.given[..];
        let pattern = Pattern {
            start: &blocks.start,
            feeds: &blocks.feeds,
            fed: &blocks.fed,
            columns: &blocks.columns,
            targets: &blocks.targets,
            aimed: &blocks.aimed,
            diagonal: &blocks.diagonal,
            paired: &blocks.paired,
            first: &blocks.first,
            stamps: &blocks.stamps,
            stamp: blocks.stamp,
        };
        let rows = (&mut blocks.pivots[..], &mut blocks.changed[..]);
        if blocks.is_symmetric {
            pattern.eliminate::<true>(given, &mut blocks.beside, rows, sides);
        } else {
            pattern.eliminate::<false>(given, &mut blocks.beside, rows, sides);
        }
    }
}

/// Right sides in the order of elimination through the factors: forth, where they have not gone with the elimination, and back.
struct Solving<'a, 'b> {
    blocks: &'a Blocks,
    work: &'b mut [Triple],
    forth: bool,
}

impl WithSimd for Solving<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        if self.forth {
            self.blocks.forth(self.work);
        }
        self.blocks.back(self.work);
    }
}

/// What is eliminated: the matrix and its pattern, as in [`Blocks`].
struct Pattern<'a> {
    start: &'a [usize],
    feeds: &'a [Feed],
    fed: &'a [usize],
    columns: &'a [usize],
    targets: &'a [u16],
    aimed: &'a [usize],
    diagonal: &'a [Block],
    paired: &'a [u32],
    first: &'a [usize],
    stamps: &'a [u64],
    stamp: u64,
}

impl Pattern<'_> {
    /// Every row takes what those before it change: it stays near while they pass by. Rows that have not changed, nor any of those, are left as
    /// they are; right sides go with all rows or with none.
    #[inline(always)]
    fn eliminate<const SYMMETRIC: bool>(
        &self,
        given: &[Both],
        beside: &mut [Both],
        (pivots, changed): (&mut [Pivot], &mut [bool]),
        sides: &mut [Triple],
    ) {
        debug_assert!(sides.is_empty() || changed.iter().all(|changed| *changed));
        let Pattern { start, feeds, fed, diagonal, paired, first, .. } = self;
        for own in 0..pivots.len() {
            if !std::mem::take(&mut changed[own]) {
                continue;
            }
            // All that it changes are changed by those in between as well.
            if let Some(next) = self.columns[start[own]..start[own + 1]].first() {
                changed[*next] = true;
            }
            let mut targets = &self.targets[self.aimed[own]..self.aimed[own + 1]];
            let (before, after) = beside.split_at_mut(start[own]);
            let row = &mut after[..start[own + 1] - start[own]];
            row.fill(Both::ZERO);
            let pairs = first[own]..first[own + 1];
            let given = given[pairs.clone()].iter().zip(&self.stamps[pairs.clone()]);
            for (at, (given, stamp)) in paired[pairs].iter().zip(given) {
                if *stamp == self.stamp {
                    row[*at as usize] = *given;
                }
            }
            // The right side stands behind the diagonal block, and is changed with it.
            let mut square = diagonal[own];
            let behind = sides.get(own).copied().unwrap_or_default();
            for (row, side) in square.iter_mut().zip(behind) {
                row[3] = side;
            }
            for feed in &feeds[fed[own]..fed[own + 1]] {
                let (at, end) = (feed.at as usize, start[feed.row as usize + 1]);
                let factor = Factor::of(&before[at]);
                let above = sides.get(feed.row as usize).copied().unwrap_or_default();
                subtract_square(&mut square, &before[at], above);
                let (own_targets, others) = targets.split_at(end - at - 1);
                targets = others;
                for (source, target) in before[at + 1..end].iter().zip(own_targets) {
                    let target = &mut row[*target as usize];
                    if SYMMETRIC { factor.subtract::<4>(target, source) } else { factor.subtract::<8>(target, source) }
                }
            }
            let pivot = Pivot::of::<SYMMETRIC>(&square);
            for both in row {
                both.eliminate::<SYMMETRIC>(&pivot);
            }
            if let Some(place) = sides.get_mut(own) {
                let reduced = pivot.forth([square[0][3], square[1][3], square[2][3]]);
                *place = [0, 1, 2].map(|i| reduced[i] * pivot.d[i]);
            }
            pivots[own] = pivot;
        }
    }
}

/// Where the block of a pair of bodies stands, and whether the second of them is eliminated first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    at: usize,
    turned: bool,
}

impl Slot {
    /// Of the pair in the order of elimination, and the two sides of `pair` in that order.
    pub(crate) fn straighten<T>(self, [a, b]: [T; 2]) -> (Self, [T; 2]) {
        (Slot { turned: false, ..self }, if self.turned { [b, a] } else { [a, b] })
    }
}

impl Blocks {
    /// With a block for each body and each of `pairs`, all zero.
    pub(crate) fn new(bodies: usize, pairs: &[(usize, usize)], orders: &Orders) -> Self {
        let elimination = orders.elimination(bodies, pairs);
        let place: Vec<usize> = elimination.places().iter().map(|k| *k as usize).collect();
        let (mut start, mut columns) = (vec![0], Vec::new());
        for row in &elimination.rows {
            columns.extend(row.iter().map(|k| *k as usize));
            start.push(columns.len());
        }
        let mut entries: Vec<(usize, usize)> =
            pairs.iter().map(|&(a, b)| (place[a].min(place[b]), place[a].max(place[b]))).collect();
        entries.sort_unstable();
        entries.dedup();
        let mut blocks = Blocks {
            place,
            start,
            feeds: Vec::with_capacity(columns.len()),
            fed: vec![0],
            targets: Vec::new(),
            aimed: vec![0],
            diagonal: vec![ZERO; bodies],
            changed: vec![true; bodies],
            paired: Vec::new(),
            first: Vec::with_capacity(bodies + 1),
            given: Vec::new(),
            stamps: Vec::new(),
            stamp: 1,
            beside: vec![Both::ZERO; columns.len()],
            columns,
            is_symmetric: true,
            pivots: vec![Pivot::default(); bodies],
        };
        for own in entries.chunk_by(|one, other| one.0 == other.0) {
            let row = own[0].0;
            blocks.first.resize(row + 1, blocks.paired.len());
            let places = own.iter().map(|(_, column)| (blocks.find(row, *column) - blocks.start[row]) as u32);
            let places: Vec<u32> = places.collect();
            blocks.paired.extend(places);
        }
        blocks.first.resize(bodies + 1, blocks.paired.len());
        let pairs = blocks.paired.len();
        blocks.given = vec![Both::ZERO; pairs];
        blocks.stamps = vec![0; pairs];
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
                let places = others.iter().map(|&j| {
                    let place = self.find(own, j) - self.start[own];
                    u16::try_from(place).expect("rows of less than 65,536 blocks")
                });
                targets.extend(places);
            }
            self.aimed.push(targets.len());
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

    /// Where the block of a pair stands, one of those that the matrix was made with.
    pub fn slot(&self, a: usize, b: usize) -> Slot {
        let (i, j) = (self.place[a], self.place[b]);
        let (row, column) = (i.min(j), i.max(j));
        let (from, wanted) = (self.first[row], (self.find(row, column) - self.start[row]) as u32);
        let at = from + self.paired[from..self.first[row + 1]].partition_point(|k| *k < wanted);
        Slot { at, turned: i > j }
    }

    /// Where the block of a pair, or the row of a body with the base, stands among all: contacts in this order go through the matrix once.
    pub fn rank(&self, slot: Option<Slot>, body: usize) -> usize {
        slot.map_or(self.first[self.place[body]], |slot| slot.at)
    }

    /// A symmetric matrix, all zero but for the diagonal, which gets `diagonal` by body.
    pub fn reset(&mut self, diagonal: &[Triple]) {
        self.is_symmetric = true;
        self.stamp += 1;
        self.changed.fill(true);
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
    }

    /// The diagonal block of a body, and with it those of its pairs, which are given with those of their bodies.
    #[inline(always)]
    fn changing(&mut self, body: usize) -> &mut Block {
        let place = self.place[body];
        self.changed[place] = true;
        &mut self.diagonal[place]
    }

    /// Adds `times` the square of a row of one body.
    pub fn add(&mut self, body: usize, times: f64, row: Triple) {
        add_outer(self.changing(body), times, row, row);
    }

    /// Adds two columns times two rows to the block of one body; the sum of what is added to a symmetric matrix has to be symmetric.
    #[inline(always)]
    pub fn add_products(&mut self, body: usize, columns: [Triple; 2], rows: [Triple; 2]) {
        let block = self.changing(body);
        let rows = rows.map(|[x, y, z]| [x, y, z, 0.0]);
        for (i, sum) in block.iter_mut().enumerate() {
            *sum = std::array::from_fn(|j| sum[j] + columns[0][i] * rows[0][j] + columns[1][i] * rows[1][j]);
        }
    }

    /// Adds `times` the product of the rows of a pair's two bodies, the first that is eliminated first, to a symmetric matrix.
    pub(crate) fn add_pair(&mut self, slot: Slot, times: f64, [first, second]: [Triple; 2]) {
        debug_assert!(self.is_symmetric && !slot.turned);
        let row =
            |x: f64| [times * x * second[0], times * x * second[1], times * x * second[2], 0.0, 0.0, 0.0, 0.0, 0.0];
        self.give(slot, first.map(row));
    }

    /// Adds twice the columns of a pair's two bodies, the first that is eliminated first, times the rows of the other, to a matrix that need not be
    /// symmetric.
    #[inline(always)]
    pub(crate) fn add_pairs_of_products(&mut self, slot: Slot, columns: [[Triple; 2]; 2], rows: [[Triple; 2]; 2]) {
        debug_assert!(!self.is_symmetric && !slot.turned);
        // What is right of the diagonal, and behind it what is below, turned over.
        let ends = |start: Triple, end: Triple| [start[0], start[1], start[2], 0.0, end[0], end[1], end[2], 0.0];
        let across = [0, 1].map(|k| ends(rows[k][1], columns[k][1]));
        let down = |k: usize, i: usize| {
            let (a, b) = (columns[k][0][i], rows[k][0][i]);
            [a, a, a, a, b, b, b, b]
        };
        let row = |i: usize| -> [f64; 8] {
            let [one, other] = [down(0, i), down(1, i)];
            std::array::from_fn(|j| one[j] * across[0][j] + other[j] * across[1][j])
        };
        self.give(slot, [row(0), row(1), row(2)]);
    }

    /// Adds a block to that of one body.
    #[inline(always)]
    pub(crate) fn add_block(&mut self, body: usize, block: Block) {
        for (sum, row) in self.changing(body).iter_mut().zip(block) {
            *sum = std::array::from_fn(|j| sum[j] + row[j]);
        }
    }

    /// Adds the blocks of a pair's two bodies, the first that is eliminated first, to a matrix that need not be symmetric: the one of the first in
    /// columns of the second and, behind its rows, the other turned over.
    #[inline(always)]
    pub(crate) fn add_pair_of_blocks(&mut self, slot: Slot, blocks: [[f64; 8]; 3]) {
        debug_assert!(!self.is_symmetric && !slot.turned);
        self.give(slot, blocks);
    }

    /// A pair is given with the blocks of its bodies, which say that rows change.
    #[inline(always)]
    fn give(&mut self, slot: Slot, blocks: [[f64; 8]; 3]) {
        let fresh = std::mem::replace(&mut self.stamps[slot.at], self.stamp) != self.stamp;
        self.given[slot.at].take(fresh, blocks);
    }

    /// Eliminates row by row what has changed since that was done last.
    pub fn factorise(&mut self) {
        self.factorise_with(&mut []);
    }

    /// Eliminates a matrix that need not be symmetric, and solves in place, as [`Blocks::solve`] does then. Where more than a few rows have changed
    /// right sides go forth with the elimination, which has each block at hand.
    pub fn factorise_and_solve(&mut self, x: &mut [Triple], work: &mut [Triple]) {
        debug_assert!(!self.is_symmetric);
        self.sort(x, work);
        let changed = self.changed.iter().filter(|changed| **changed).count();
        let few = changed * FEW < self.changed.len();
        if few {
            self.factorise_with(&mut []);
        } else {
            self.changed.fill(true);
            self.factorise_with(work);
        }
        self.go_through(x, work, few);
    }

    /// With right sides in the order of elimination, or none, of a matrix that is not symmetric.
    fn factorise_with(&mut self, sides: &mut [Triple]) {
        // In the widest registers there are. Products of blocks are added without rounding in between on every machine, where need be one by one, so
        // that bits do not tell them apart.
        Arch::new().dispatch(Factorising(self, sides));
    }

    /// Solves with the factors, in place; `work` has as many triples as there are bodies.
    pub fn solve(&self, x: &mut [Triple], work: &mut [Triple]) {
        self.sort(x, work);
        self.go_through(x, work, true);
    }

    #[inline(always)]
    fn forth(&self, work: &mut [Triple]) {
        let half = if self.is_symmetric { 0 } else { 4 };
        for k in 0..work.len() {
            let pivot = &self.pivots[k];
            let reduced = pivot.forth(work[k]);
            work[k] = [0, 1, 2].map(|i| reduced[i] * pivot.d[i]);
            // What is below is D times what is beside it, if it is not held.
            let value = if self.is_symmetric { reduced } else { work[k] };
            let own = self.start[k]..self.start[k + 1];
            for (column, both) in self.columns[own.clone()].iter().zip(&self.beside[own]) {
                subtract_transposed(&mut work[*column], both, half, value);
            }
        }
    }

    /// Right sides in the order of elimination.
    fn sort(&self, x: &[Triple], sides: &mut [Triple]) {
        for (body, value) in x.iter().enumerate() {
            sides[self.place[body]] = *value;
        }
    }

    /// To the solution by body, of what is to go forth first or has gone.
    fn go_through(&self, x: &mut [Triple], work: &mut [Triple], forth: bool) {
        Arch::new().dispatch(Solving { blocks: self, work, forth });
        for (body, value) in x.iter_mut().enumerate() {
            *value = work[self.place[body]];
        }
    }

    #[inline(always)]
    fn back(&self, work: &mut [Triple]) {
        for k in (0..work.len()).rev() {
            let mut sums = [[0.0; 4]; 3];
            let own = self.start[k]..self.start[k + 1];
            // Downwards in each row too: memory is read ahead in one direction.
            for (column, both) in self.columns[own.clone()].iter().zip(&self.beside[own]).rev() {
                let [x, y, z] = work[*column];
                let x = [x, y, z, 0.0];
                for (sum, row) in sums.iter_mut().zip(&both.0) {
                    *sum = std::array::from_fn(|j| row[j].mul_add(x[j], sum[j]));
                }
            }
            let value = [0, 1, 2].map(|i| work[k][i] - (sums[i][0] + sums[i][1] + sums[i][2]));
            work[k] = self.pivots[k].back(value);
        }
    }

    /// Blocks right of the diagonal, fill included.
    pub fn fill(&self) -> usize {
        self.columns.len()
    }
}

fn add_outer(block: &mut Block, times: f64, column: Triple, row: Triple) {
    for i in 0..3 {
        for j in 0..3 {
            block[i][j] += times * column[i] * row[j];
        }
    }
}

/// What a row is multiplied by when it changes another, turned round: the block below the diagonal for what is right of it, and behind it
/// the block on the right for what is below.
#[derive(Debug, Clone, Copy)]
struct Factor([[[f64; 8]; 3]; 3]);

impl Factor {
    #[inline(always)]
    fn of(own: &Both) -> Self {
        let turned = |i: usize, k: usize| {
            let (a, b) = (-own.0[k][4 + i], -own.0[k][i]);
            [a, a, a, a, b, b, b, b]
        };
        // Written out: loops over these go through memory.
        Factor([
            [turned(0, 0), turned(0, 1), turned(0, 2)],
            [turned(1, 0), turned(1, 1), turned(1, 2)],
            [turned(2, 0), turned(2, 1), turned(2, 2)],
        ])
    }

    /// Takes the product with the first so many columns of the source from those of the target.
    #[inline(always)]
    fn subtract<const COLUMNS: usize>(&self, target: &mut Both, source: &Both) {
        // All is read before anything is written: what is written might be what is read, for all that a compiler knows, which would read it
        // again.
        let ([s0, s1, s2], [t0, t1, t2]) = (&source.0.map(first::<COLUMNS>), &target.0.map(first::<COLUMNS>));
        let row = |[f0, f1, f2]: &[[f64; 8]; 3], t: &[f64; COLUMNS]| -> [f64; COLUMNS] {
            std::array::from_fn(|j| f2[j].mul_add(s2[j], f1[j].mul_add(s1[j], f0[j].mul_add(s0[j], t[j]))))
        };
        let rows = [row(&self.0[0], t0), row(&self.0[1], t1), row(&self.0[2], t2)];
        target.0[0][..COLUMNS].copy_from_slice(&rows[0]);
        target.0[1][..COLUMNS].copy_from_slice(&rows[1]);
        target.0[2][..COLUMNS].copy_from_slice(&rows[2]);
    }
}

#[inline(always)]
fn first<const COLUMNS: usize>(row: [f64; 8]) -> [f64; COLUMNS] {
    std::array::from_fn(|j| row[j])
}

/// L⁻¹ of the columns of a block.
#[inline(always)]
fn swept(y: [[f64; 4]; 3], l: &[f64; 3]) -> [[f64; 4]; 3] {
    let less = |y: [f64; 4], l: f64, x: [f64; 4]| -> [f64; 4] { std::array::from_fn(|j| (-l).mul_add(x[j], y[j])) };
    let y1 = less(y[1], l[0], y[0]);
    [y[0], y1, less(less(y[2], l[1], y[0]), l[2], y1)]
}

/// What a row takes from the diagonal block of another, and from what is `above` of its right side.
#[inline(always)]
fn subtract_square(target: &mut Block, own: &Both, above: Triple) {
    let mut source: [[f64; 4]; 3] = own.right();
    (0..3).for_each(|k| source[k][3] = above[k]);
    for i in 0..3 {
        for k in 0..3 {
            let factor = -own.0[k][4 + i];
            target[i] = std::array::from_fn(|j| factor.mul_add(source[k][j], target[i][j]));
        }
    }
}

/// The same of a right side alone, with what is below or, where the matrix is symmetric, with what is right of the diagonal.
#[inline(always)]
fn subtract_transposed(y: &mut Triple, a: &Both, from: usize, x: Triple) {
    let mut sum = [y[0], y[1], y[2], 0.0];
    for k in 0..3 {
        sum = std::array::from_fn(|i| (-a.0[k][from + i]).mul_add(x[k], sum[i]));
    }
    *y = [sum[0], sum[1], sum[2]];
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
        let mut blocks = Blocks::new(n, &pairs, &Orders::anywhere());
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
                let (slot, both) = blocks.slot(a, b).straighten([a, b]);
                let [a, b] = both;
                let mut rows = || [[draw(), draw(), draw()], [draw(), draw(), draw()]];
                let rows = [rows(), rows()];
                // Towards the rows turned by a bit: more than half of the product stays symmetric.
                let bent = if symmetric { 0.0 } else { 0.3 };
                let columns = rows.map(|pair| pair.map(|row| row.map(|x| x + bent * draw())));
                if symmetric {
                    for rows in rows {
                        blocks.add_pair(slot, 1.0, rows);
                        blocks.add(a, 1.0, rows[0]);
                        blocks.add(b, 1.0, rows[1]);
                    }
                } else {
                    let of = |two: [[Triple; 2]; 2], body: usize| two.map(|pair| pair[body]);
                    blocks.add_pairs_of_products(slot, columns, rows);
                    blocks.add_products(a, of(columns, 0), of(rows, 0));
                    blocks.add_products(b, of(columns, 1), of(rows, 1));
                }
                for (columns, rows) in columns.iter().zip(&rows) {
                    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                        dense[3 * both[i / 3] + i % 3][3 * both[j / 3] + j % 3] +=
                            columns[i / 3][i % 3] * rows[j / 3][j % 3];
                    }
                }
            }
            let wanted: Vec<Triple> = (0..n).map(|_| [draw(), draw(), draw()]).collect();
            let flat: Vec<f64> = wanted.iter().flatten().copied().collect();
            let product = |row: &Vec<f64>| row.iter().zip(&flat).map(|(a, b)| a * b).sum::<f64>();
            let mut x: Vec<Triple> = (0..n).map(|k| [0, 1, 2].map(|i| product(&dense[3 * k + i]))).collect();
            let (right, mut work) = (x.clone(), vec![[0.0; 3]; n]);
            let off = |x: &[Triple]| x.iter().flatten().zip(&flat).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if !symmetric {
                blocks.factorise_and_solve(&mut x, &mut work);
                let together = x.clone();
                x.copy_from_slice(&right);
                blocks.solve(&mut x, &mut work);
                assert_eq!(x, together);
                assert!(off(&x) < 1e-12, "{:e}", off(&x));
            }
            x.copy_from_slice(&right);
            blocks.changed.fill(true);
            blocks.factorise();
            blocks.solve(&mut x, &mut work);
            assert!(off(&x) < 1e-12, "{:e}", off(&x));
        }
    }

    /// What is eliminated after a few pairs have changed is, to the bit, what all of it would come to.
    #[test]
    fn eliminates_what_changed() {
        let (n, pairs) = (400, grid(20, 20));
        let mut blocks = Blocks::new(n, &pairs, &Orders::anywhere());
        let own = |k: usize| [9.0 + (k % 7) as f64, 8.0 + (k % 5) as f64, 7.0 + (k % 3) as f64];
        let bent = |k: usize| {
            let x = ((7 * k) % 11) as f64 / 11.0 - 0.4;
            [[x, 0.3, -x, 0.0, 0.2, x, 0.1, 0.0]; 3]
        };
        let give = |blocks: &mut Blocks, k: usize| {
            let (slot, both) = blocks.slot(pairs[k].0, pairs[k].1).straighten([pairs[k].0, pairs[k].1]);
            let block = [[0.5, 0.1, 0.0, 0.0], [-0.1, 0.4, 0.0, 0.0], [0.0, 0.2, 0.3, 0.0]];
            both.iter().for_each(|body| blocks.add_block(*body, block));
            blocks.add_pair_of_blocks(slot, bent(k));
        };
        let right: Vec<Triple> = (0..n).map(|k| [k as f64, 1.0, -2.0]).collect();
        let solve = |blocks: &mut Blocks| {
            let (mut x, mut work) = (right.clone(), vec![[0.0; 3]; n]);
            blocks.factorise_and_solve(&mut x, &mut work);
            x
        };
        blocks.reset_whole(&(0..n).map(own).collect::<Vec<_>>());
        (0..pairs.len()).for_each(|k| give(&mut blocks, k));
        let mut last = solve(&mut blocks);
        for some in [vec![], vec![5], vec![pairs.len() - 1], vec![40, 300, 301], (0..pairs.len()).step_by(3).collect()]
        {
            some.iter().for_each(|k| give(&mut blocks, *k));
            let mut whole = blocks.clone();
            whole.changed.fill(true);
            let x = solve(&mut blocks);
            assert_eq!(x, solve(&mut whole), "{some:?}");
            assert_eq!(x == last, some.is_empty());
            last = x;
        }
    }
}
