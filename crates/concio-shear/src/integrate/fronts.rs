//! A = C D⁻¹ Cᵀ for large symmetric systems, front by front (multifrontal; J. W. H. Liu, SIAM Review 34 (1992) 82).
//!
//! Columns of C with almost the same rows make a *group*; a group is eliminated as one dense matrix, its *front*,
//! which starts from the entries of A in its columns and from what the groups below it in the elimination tree left
//! over. So nearly all work is loops over whole vectors (`dense_columns`). What a front leaves over waits on a stack whose
//! layout, like all indices, is settled by [`Fronts::new`]; nothing is allocated afterwards. The order of all
//! operations is fixed, and so are the bits.

use crate::integrate::dense_columns::NotPositive;
use crate::integrate::dense_columns::{Dense, Left, Real, aligned, backward, forward, padded, scratch};
use crate::integrate::pattern::Pattern;

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

    /// Its rows, and how long its columns are.
    #[inline(always)]
    fn rows(&self) -> (usize, usize) {
        let rows = (self.width + self.height) as usize;
        (rows, padded(rows))
    }

    /// Where its columns are in `factor`.
    #[inline(always)]
    fn panel(&self) -> std::ops::Range<usize> {
        self.panel..self.panel + self.rows().1 * self.width as usize
    }

    /// What it leaves over: how long its columns are, and the row of the panel that they begin with.
    #[inline(always)]
    fn rest(&self) -> (usize, usize) {
        let above = aligned(self.width as usize);
        (self.rows().1 - above, above)
    }
}

/// Indices and factors.
#[derive(Debug, Clone)]
pub struct Fronts<R> {
    fronts: Vec<Front>,
    children: Vec<u32>,
    /// Rows below the columns of every group, and their places in the front above.
    rows: Vec<u32>,
    into: Vec<u32>,
    /// Place of every entry of A in the panel of its front.
    entry: Vec<u32>,
    /// C by groups, whole columns, and D⁻¹.
    factor: Vec<R>,
    inverse: Vec<R>,
    stack: Vec<R>,
    /// A column of a front, and its multipliers.
    column: Vec<R>,
    multipliers: Vec<R>,
}

impl<R: Real> Fronts<R> {
    /// For a matrix of order `n` with entries below the diagonal at `entries` (row, column): each once, column by
    /// column, rows and columns numbered in postorder.
    pub fn new(n: usize, entries: &[(u32, u32)]) -> Self {
        let Pattern { groups, start, rows, group_of } = Pattern::new(n, entries);
        let mut fronts = Vec::with_capacity(groups.len());
        let (mut panel, mut seen) = (0, 0);
        for (group, below) in groups.iter().zip(start.windows(2)) {
            let (width, height) = (group.len(), below[1] - below[0]);
            let inside = entries[seen..].partition_point(|&(_, c)| c < group.end);
            fronts.push(Front {
                first: group.start,
                width: width as u32,
                height: height as u32,
                entries: [seen as u32, (seen + inside) as u32],
                children: [0; 2],
                panel,
                below: below[0],
                made: 0,
                left: 0,
            });
            seen += inside;
            panel += width * padded(width + height);
        }
        let children = hang(&mut fronts, &rows, &group_of);
        let stack = stack_up(&mut fronts, &children);
        let place = |&(row, column): &(u32, u32)| {
            let f = &fronts[group_of[column as usize] as usize];
            let end = f.first + f.width;
            let place = match row < end {
                true => row - f.first,
                false => f.width + f.below(&rows).partition_point(|&r| r < row) as u32,
            };
            (column - f.first) * f.rows().1 as u32 + place
        };
        let longest = fronts.iter().map(|f| f.rows().1).max().unwrap_or(0);
        Fronts {
            into: places_above(&fronts, &rows, &group_of),
            entry: entries.iter().map(place).collect(),
            factor: vec![R::ZERO; panel],
            stack: vec![R::ZERO; stack],
            inverse: vec![R::ZERO; n],
            column: vec![R::ZERO; longest],
            multipliers: vec![R::ZERO; scratch(longest)],
            fronts,
            children,
            rows,
        }
    }

    /// Factorises A given by its diagonal, times `lift`, and the entries below it, in the order of [`Fronts::new`].
    ///
    /// # Errors
    /// [`NotPositive`] when a pivot is not above zero.
    #[inline(always)]
    pub fn factorise(&mut self, diagonal: &[f64], lower: &[f64], lift: f64) -> Result<(), NotPositive> {
        for f in &self.fronts {
            let (width, (rows, lead), (long, _)) = (f.width as usize, f.rows(), f.rest());
            let panel = &mut self.factor[f.panel()];
            panel.fill(R::ZERO);
            for (k, value) in diagonal[f.first as usize..][..width].iter().enumerate() {
                panel[k * (lead + 1)] = R::near(lift * value);
            }
            let [from, to] = f.entries.map(|e| e as usize);
            for (&at, value) in self.entry[from..to].iter().zip(&lower[from..to]) {
                panel[at as usize] = R::near(*value);
            }
            let (waiting, free) = self.stack.split_at_mut(f.made);
            let rest = &mut free[..f.height as usize * long];
            rest.fill(R::ZERO);
            let inverse = &mut self.inverse[f.first as usize..][..width];
            let mut front = Dense { panel, rest, inverse, multipliers: &mut self.multipliers, width, rows, lead };
            for &c in &self.children[f.children[0] as usize..f.children[1] as usize] {
                let child = &self.fronts[c as usize];
                let (long, above) = child.rest();
                let (columns, skip) = (&waiting[child.left..], child.width as usize - above);
                front.take_over(Left { columns, long, skip, into: child.below(&self.into) });
            }
            front.eliminate()?;
            self.stack.copy_within(f.made..f.made + f.height as usize * long, f.left);
        }
        Ok(())
    }

    /// The factors: C, and D⁻¹.
    pub fn numbers(&self) -> [&[R]; 2] {
        [&self.factor, &self.inverse]
    }

    /// Takes them up; false where they are not as long as those that are there.
    pub fn take_up(&mut self, [factor, inverse]: &[Vec<R>; 2]) -> bool {
        let fit = factor.len() == self.factor.len() && inverse.len() == self.inverse.len();
        if fit {
            self.factor.copy_from_slice(factor);
            self.inverse.copy_from_slice(inverse);
        }
        fit
    }

    /// Solves A x = b in place.
    #[inline(always)]
    pub fn solve(&mut self, x: &mut [R]) {
        for f in &self.fronts {
            let (width, (rows, lead)) = (f.width as usize, f.rows());
            let own = &mut x[f.first as usize..][..width];
            if own.iter().all(|b| *b == R::ZERO) {
                continue;
            }
            let column = &mut self.column[..lead];
            column[..width].copy_from_slice(own);
            column[width..].fill(R::ZERO);
            forward(&self.factor[f.panel()], lead, &self.inverse[f.first as usize..][..width], column, own);
            for (&r, s) in f.below(&self.rows).iter().zip(&column[width..rows]) {
                x[r as usize] += *s;
            }
        }
        for f in self.fronts.iter().rev() {
            let (width, (rows, lead)) = (f.width as usize, f.rows());
            let column = &mut self.column[..lead];
            column[rows..].fill(R::ZERO);
            for (&r, value) in f.below(&self.rows).iter().zip(&mut column[width..rows]) {
                *value = x[r as usize];
            }
            let own = &mut x[f.first as usize..][..width];
            backward(&self.factor[f.panel()], lead, &self.inverse[f.first as usize..][..width], column, own);
        }
    }
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
        let size = fronts[s].height as usize * fronts[s].rest().0;
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
        let mut fronts = Fronts::<f64>::new(n, &entries);
        assert!(fronts.fronts.iter().any(|f| f.width > 16 && f.height > 16), "loops over long columns are tried too");
        // Twice: nothing of the first time may be left.
        for _ in 0..2 {
            fronts.factorise(&diagonal, &lower, 1.0).expect("diagonally dominant");
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
        assert_eq!(fronts.factorise(&diagonal, &lower, 1.0), Err(NotPositive));
    }
}
