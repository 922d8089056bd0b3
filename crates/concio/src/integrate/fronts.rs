//! A = L Lᵀ for large symmetric systems, front by front (multifrontal; J. W. H. Liu, SIAM Review 34 (1992) 82).
//!
//! Columns of L with almost the same rows make a *group*; a group is eliminated as one dense matrix, its *front*,
//! which starts from the entries of A in its columns and from what the groups below it in the elimination tree left
//! over. So nearly all work is plain loops over contiguous columns. What a front leaves over waits on a stack whose
//! layout, like all indices, is settled by [`Fronts::new`]; nothing is allocated afterwards. The order of all
//! operations is fixed, and so are the bits.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SymbolicSupernodalParams;
use faer::sparse::linalg::cholesky::{simplicial, supernodal};

use crate::integrate::linear::NotPositive;

/// Groups are joined as long as they have at most so many columns and less than this part of zeros.
const JOINED: [(usize, f64); 3] = [(4, 1.0), (16, 0.4), (48, 0.05)];

/// One group of columns.
#[derive(Debug, Clone, Copy)]
struct Front {
    /// First column, number of columns, number of rows below them.
    first: u32,
    width: u32,
    height: u32,
    /// The entries of A below the diagonal in its columns.
    entries: [u32; 2],
    /// The groups right below it: their places in `children`.
    children: [u32; 2],
    /// Where its columns start in `factor`, all its rows in each, and its rows below in `rows`.
    panel: usize,
    below: usize,
    /// Where what it leaves over is made, and where it then waits, in `stack`.
    made: usize,
    left: usize,
}

impl Front {
    /// Its rows below its columns, out of those of all groups.
    #[inline(always)]
    fn below<'a>(&self, rows: &'a [u32]) -> &'a [u32] {
        &rows[self.below..self.below + self.height as usize]
    }

    /// Where its columns are in `factor`, and how long each of them is.
    #[inline(always)]
    fn panel(&self) -> (std::ops::Range<usize>, usize) {
        let full = (self.width + self.height) as usize;
        (self.panel..self.panel + full * self.width as usize, full)
    }
}

/// Indices and factors.
#[derive(Debug, Clone)]
pub struct Fronts {
    fronts: Vec<Front>,
    children: Vec<u32>,
    /// Rows below the columns of every group, and their places in the front above.
    rows: Vec<u32>,
    into: Vec<u32>,
    /// Place of every entry of A in the panel of its front.
    entry: Vec<u32>,
    /// L by groups, full columns; inverse values on the diagonal.
    factor: Vec<f64>,
    stack: Vec<f64>,
    column: Vec<f64>,
}

impl Fronts {
    /// For a matrix of order `n` with entries below the diagonal at `entries` (row, column): each once, column by
    /// column, rows and columns numbered in postorder.
    pub fn new(n: usize, entries: &[(u32, u32)]) -> Self {
        let groups = groups(n, entries);
        let mut fronts = Vec::with_capacity(groups.n_supernodes());
        let mut rows = Vec::with_capacity(groups.row_idx().len());
        let mut group_of = vec![0u32; n];
        let (mut panel, mut seen) = (0, 0);
        for s in 0..groups.n_supernodes() {
            let group = groups.supernode(s);
            let (first, end, below) = (group.start(), groups.supernode_end()[s], group.pattern());
            group_of[first..end].fill(s as u32);
            let inside = entries[seen..].partition_point(|&(_, c)| (c as usize) < end);
            fronts.push(Front {
                first: first as u32,
                width: (end - first) as u32,
                height: below.len() as u32,
                entries: [seen as u32, (seen + inside) as u32],
                children: [0; 2],
                panel,
                below: rows.len(),
                made: 0,
                left: 0,
            });
            seen += inside;
            rows.extend(below.iter().map(|&r| r as u32));
            panel += (end - first) * (end - first + below.len());
        }
        rows.shrink_to_fit();
        let children = hang(&mut fronts, &rows, &group_of);
        let stack = stack_up(&mut fronts, &children);
        let place = |&(row, column): &(u32, u32)| {
            let f = &fronts[group_of[column as usize] as usize];
            let end = f.first + f.width;
            let place = match row < end {
                true => row - f.first,
                false => f.width + f.below(&rows).partition_point(|&r| r < row) as u32,
            };
            (column - f.first) * (f.width + f.height) + place
        };
        Fronts {
            into: places_above(&fronts, &rows, &group_of),
            entry: entries.iter().map(place).collect(),
            factor: vec![0.0; panel],
            stack: vec![0.0; stack],
            column: vec![0.0; fronts.iter().map(|f| f.height as usize).max().unwrap_or(0)],
            fronts,
            children,
            rows,
        }
    }

    /// Factorises A given by its diagonal and the entries below it, in the order of [`Fronts::new`].
    ///
    /// # Errors
    /// [`NotPositive`] when a pivot is not above zero.
    #[inline(always)]
    pub fn factorise(&mut self, diagonal: &[f64], lower: &[f64]) -> Result<(), NotPositive> {
        for f in &self.fronts {
            let (width, height) = (f.width as usize, f.height as usize);
            let (panel, full) = f.panel();
            let panel = &mut self.factor[panel];
            panel.fill(0.0);
            for (k, value) in diagonal[f.first as usize..][..width].iter().enumerate() {
                panel[k * (full + 1)] = *value;
            }
            let [from, to] = f.entries.map(|e| e as usize);
            for (&at, value) in self.entry[from..to].iter().zip(&lower[from..to]) {
                panel[at as usize] = *value;
            }
            let (waiting, free) = self.stack.split_at_mut(f.made);
            let rest = &mut free[..height * height];
            rest.fill(0.0);
            for &c in &self.children[f.children[0] as usize..f.children[1] as usize] {
                let child = &self.fronts[c as usize];
                take_over(&waiting[child.left..], child.below(&self.into), panel, width, rest, height);
            }
            eliminate(panel, width, full)?;
            subtract_products(panel, width, rest, height);
            self.stack.copy_within(f.made..f.made + height * height, f.left);
        }
        Ok(())
    }

    /// Solves L Lᵀ x = b in place.
    #[inline(always)]
    pub fn solve(&mut self, x: &mut [f64]) {
        for f in &self.fronts {
            let width = f.width as usize;
            let (panel, full) = f.panel();
            let panel = &self.factor[panel];
            let own = &mut x[f.first as usize..][..width];
            for (k, column) in panel.chunks_exact(full).enumerate() {
                let value = own[k] * column[k];
                own[k] = value;
                for (x, l) in own[k + 1..].iter_mut().zip(&column[k + 1..width]) {
                    *x -= l * value;
                }
            }
            let sum = &mut self.column[..f.height as usize];
            sum.fill(0.0);
            subtract_all(panel, full, own, sum);
            for (&r, s) in f.below(&self.rows).iter().zip(&*sum) {
                x[r as usize] += s;
            }
        }
        for f in self.fronts.iter().rev() {
            let width = f.width as usize;
            let (panel, full) = f.panel();
            let panel = &self.factor[panel];
            let column = &mut self.column[..f.height as usize];
            for (&r, value) in f.below(&self.rows).iter().zip(column.iter_mut()) {
                *value = x[r as usize];
            }
            let own = &mut x[f.first as usize..][..width];
            for (k, l) in panel.chunks_exact(full).enumerate().rev() {
                let within: f64 = l[k + 1..width].iter().zip(&own[k + 1..]).map(|(l, x)| l * x).sum();
                own[k] = (own[k] - within - dot(&l[width..], column)) * l[k];
            }
        }
    }
}

/// Columns of like rows, found by faer.
fn groups(n: usize, entries: &[(u32, u32)]) -> supernodal::SymbolicSupernodalCholesky<usize> {
    // The upper triangle by columns is the lower one by rows.
    let mut start = vec![0usize; n + 1];
    for &(r, _) in entries {
        start[r as usize + 1] += 1;
    }
    for k in 0..n {
        start[k + 1] += start[k];
    }
    let mut next = start.clone();
    let mut columns = vec![0usize; entries.len()];
    for &(r, c) in entries {
        columns[next[r as usize]] = c as usize;
        next[r as usize] += 1;
    }
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &start, None, &columns);
    let (mut tree, mut counts) = (vec![0isize; n], vec![0usize; n]);
    let mut memory = MemBuffer::new(StackReq::any_of(&[
        simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, entries.len()),
        supernodal::factorize_supernodal_symbolic_cholesky_scratch::<usize>(n),
    ]));
    let stack = MemStack::new(&mut memory);
    let tree = simplicial::prefactorize_symbolic_cholesky(&mut tree, &mut counts, pattern, stack);
    let joined = SymbolicSupernodalParams { relax: Some(&JOINED) };
    // It can fail for want of memory alone, as every other allocation here, or where an index exceeds 64 bits.
    supernodal::factorize_supernodal_symbolic_cholesky(pattern, tree, &counts, stack, joined)
        .expect("memory for the pattern of the factors")
}

/// The groups right below each group: those whose first row below is one of its columns.
fn hang(fronts: &mut [Front], rows: &[u32], group_of: &[u32]) -> Vec<u32> {
    let above: Vec<Option<u32>> = fronts.iter().map(|f| f.below(rows).first().map(|&r| group_of[r as usize])).collect();
    let mut count = vec![0u32; fronts.len() + 1];
    for &a in above.iter().flatten() {
        count[a as usize + 1] += 1;
    }
    for s in 0..fronts.len() {
        count[s + 1] += count[s];
        fronts[s].children = [count[s]; 2];
    }
    let mut children = vec![0u32; above.iter().flatten().count()];
    for (s, &a) in above.iter().enumerate() {
        if let Some(a) = a {
            let end = &mut fronts[a as usize].children[1];
            children[*end as usize] = s as u32;
            *end += 1;
        }
    }
    children
}

/// Lays the stack out and returns its size. What a group leaves over is made above that of its children and then put
/// in their place. Right because columns are in postorder: what lies above the first child belongs to the children.
fn stack_up(fronts: &mut [Front], children: &[u32]) -> usize {
    let (mut top, mut most) = (0, 0);
    for s in 0..fronts.len() {
        let [from, to] = fronts[s].children.map(|c| c as usize);
        let base = children[from..to].first().map_or(top, |&c| fronts[c as usize].left);
        let size = (fronts[s].height as usize).pow(2);
        (fronts[s].made, fronts[s].left) = (top, base);
        most = most.max(top + size);
        top = base + size;
    }
    most
}

/// Where the rows below each group stand in the front of the group above.
fn places_above(fronts: &[Front], rows: &[u32], group_of: &[u32]) -> Vec<u32> {
    let mut into = Vec::with_capacity(rows.len());
    for f in fronts.iter().filter(|f| f.height > 0) {
        let own = f.below(rows);
        let a = &fronts[group_of[own[0] as usize] as usize];
        let theirs = a.below(rows);
        let mut at = 0;
        for &r in own {
            if r < a.first + a.width {
                into.push(r - a.first);
                continue;
            }
            while theirs[at] < r {
                at += 1;
            }
            into.push(a.width + at as u32);
        }
    }
    into
}

/// Adds what a child left over (lower triangle, one full column after the other) to its parent's front.
#[inline(always)]
fn take_over(child: &[f64], into: &[u32], panel: &mut [f64], width: usize, rest: &mut [f64], height: usize) {
    let (size, full) = (into.len(), width + height);
    let in_panel = into.partition_point(|&p| (p as usize) < width);
    for j in 0..in_panel {
        let column = &mut panel[into[j] as usize * full..][..full];
        for (&p, value) in into[j..].iter().zip(&child[j * size + j..(j + 1) * size]) {
            column[p as usize] += value;
        }
    }
    for j in in_panel..size {
        let column = &mut rest[(into[j] as usize - width) * height..][..height];
        for (&p, value) in into[j..].iter().zip(&child[j * size + j..(j + 1) * size]) {
            column[p as usize - width] += value;
        }
    }
}

/// Eliminates the first `width` columns, `full` long, four at a time.
#[inline(always)]
fn eliminate(panel: &mut [f64], width: usize, full: usize) -> Result<(), NotPositive> {
    let mut from = 0;
    while from < width {
        let to = (from + 4).min(width);
        for k in from..to {
            let (done, later) = panel.split_at_mut((k + 1) * full);
            let column = &mut done[k * full..];
            let pivot = column[k];
            if !(pivot > 0.0) {
                return Err(NotPositive);
            }
            let inverse = 1.0 / pivot.sqrt();
            column[k] = inverse;
            for value in &mut column[k + 1..] {
                *value *= inverse;
            }
            for j in k + 1..to {
                let factor = column[j];
                let target = &mut later[(j - k - 1) * full..][j..full];
                for (value, l) in target.iter_mut().zip(&column[j..]) {
                    *value -= factor * l;
                }
            }
        }
        let (done, later) = panel.split_at_mut(to * full);
        let done = &done[from * full..];
        for j in to..width {
            let target = &mut later[(j - to) * full..][j..full];
            subtract(done, full, to - from, j, j, target);
        }
        from = to;
    }
    Ok(())
}

/// `rest` −= L Lᵀ, lower triangle, L being the rows of the panel below its first `width`.
#[inline(always)]
fn subtract_products(panel: &[f64], width: usize, rest: &mut [f64], height: usize) {
    let full = width + height;
    let mut from = 0;
    while from < width {
        let count = (width - from).min(4);
        let columns = &panel[from * full..];
        let mut j = 0;
        while j + 1 < height && count == 4 {
            let (a, b) = rest[j * height..].split_at_mut(height);
            a[j] -= (0..4).map(|k| columns[k * full + width + j].powi(2)).sum::<f64>();
            pair(columns, full, width + j, &mut a[j + 1..], &mut b[j + 1..height]);
            j += 2;
        }
        for j in j..height {
            subtract(columns, full, count, width + j, width + j, &mut rest[j * height + j..][..height - j]);
        }
        from += count;
    }
}

/// Two columns of the lower triangle at once, from row `row` + 1 on: they belong to rows `row` and `row` + 1.
#[inline(always)]
fn pair(columns: &[f64], full: usize, row: usize, first: &mut [f64], second: &mut [f64]) {
    let n = first.len();
    let second = &mut second[..n];
    let l: [&[f64]; 4] = std::array::from_fn(|k| &columns[k * full + row + 1..][..n]);
    let a: [f64; 4] = std::array::from_fn(|k| columns[k * full + row]);
    let b: [f64; 4] = std::array::from_fn(|k| columns[k * full + row + 1]);
    for i in 0..n {
        let x = [l[0][i], l[1][i], l[2][i], l[3][i]];
        first[i] -= (a[0] * x[0] + a[1] * x[1]) + (a[2] * x[2] + a[3] * x[3]);
        second[i] -= (b[0] * x[0] + b[1] * x[1]) + (b[2] * x[2] + b[3] * x[3]);
    }
}

/// `target` −= Σ_k L[row.., k] L[at, k] over the first `count` (at most 4) columns.
#[inline(always)]
fn subtract(columns: &[f64], full: usize, count: usize, at: usize, row: usize, target: &mut [f64]) {
    let n = target.len();
    let l = |k: usize| &columns[k * full + row..][..n];
    let a = |k: usize| columns[k * full + at];
    match count {
        4 => four(target, [l(0), l(1), l(2), l(3)], [a(0), a(1), a(2), a(3)]),
        _ => {
            for k in 0..count {
                let (l, a) = (l(k), a(k));
                for i in 0..n {
                    target[i] -= a * l[i];
                }
            }
        }
    }
}

#[inline(always)]
fn four(target: &mut [f64], l: [&[f64]; 4], a: [f64; 4]) {
    let n = target.len();
    let l = l.map(|l| &l[..n]);
    for i in 0..n {
        target[i] -= (a[0] * l[0][i] + a[1] * l[1][i]) + (a[2] * l[2][i] + a[3] * l[3][i]);
    }
}

/// `target` −= Σ_k L[below, k] x[k] over all columns of a panel.
#[inline(always)]
fn subtract_all(panel: &[f64], full: usize, x: &[f64], target: &mut [f64]) {
    let (n, width) = (target.len(), x.len());
    let l = |k: usize| &panel[k * full + width..][..n];
    let mut from = 0;
    while from + 4 <= width {
        let a = [x[from], x[from + 1], x[from + 2], x[from + 3]];
        four(target, [l(from), l(from + 1), l(from + 2), l(from + 3)], a);
        from += 4;
    }
    for k in from..width {
        let (l, a) = (l(k), x[k]);
        for i in 0..n {
            target[i] -= a * l[i];
        }
    }
}

/// Sum of products in a fixed order that vector instructions can follow.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7])) + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::order::{elimination_order, postordered};

    /// A grid cut in pieces, one unknown joined to its whole last row: A x = b for the A that was given.
    #[test]
    fn a_large_grid_is_solved() {
        let (w, h) = (97, 60);
        let n = w * h + 1;
        let (mut pairs, mut at) = (Vec::new(), Vec::new());
        for i in 0..n - 1 {
            let (c, r) = (i % w, i / w);
            at.push([c as f64, 0.2 * r as f64]);
            let right = (c + 1 < w).then_some(i + 1);
            let above = if r + 1 < h { i + w } else { n - 1 };
            let aslant = (r + 1 < h && c + 1 < w).then_some(i + w + 1);
            pairs.extend(right.into_iter().chain([above]).chain(aslant).map(|j| (i, j)));
        }
        let mut places = elimination_order(n, &pairs, &at);
        let placed = |places: &[u32]| -> Vec<(u32, u32)> {
            pairs.iter().map(|&(i, j)| (places[i].max(places[j]), places[i].min(places[j]))).collect()
        };
        let mut entries = placed(&places);
        postordered(&mut places, &mut entries);
        let mut seen = places.clone();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(k, &p)| k as u32 == p), "every place once");
        let mut entries = placed(&places);
        entries.sort_unstable_by_key(|&(r, c)| (c, r));
        let value = |k: usize| -[1.0, 30.0, 1e5, 700.0][k % 4];
        let mut diagonal: Vec<f64> = (0..n).map(|i| 1.0 + (i % 3) as f64).collect();
        let lower: Vec<f64> = (0..entries.len()).map(value).collect();
        for (&(r, c), v) in entries.iter().zip(&lower) {
            diagonal[r as usize] -= v;
            diagonal[c as usize] -= v;
        }
        let mut fronts = Fronts::new(n, &entries);
        assert!(fronts.fronts.iter().any(|f| f.width > 16 && f.height > 16), "loops over long columns are tried too");
        // Twice: nothing of the first time may be left.
        for _ in 0..2 {
            fronts.factorise(&diagonal, &lower).expect("diagonally dominant");
        }
        let exact: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let mut b: Vec<f64> = exact.iter().zip(&diagonal).map(|(x, d)| x * d).collect();
        for (&(r, c), v) in entries.iter().zip(&lower) {
            b[r as usize] += v * exact[c as usize];
            b[c as usize] += v * exact[r as usize];
        }
        fronts.solve(&mut b);
        for (i, (x, exact)) in b.iter().zip(&exact).enumerate() {
            assert!((x - exact).abs() < 1e-8, "unknown {i}: {x} against {exact}");
        }
        diagonal[n / 2] = -1.0;
        assert_eq!(fronts.factorise(&diagonal, &lower), Err(NotPositive));
    }
}
