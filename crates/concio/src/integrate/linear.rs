//! Sparse factorisation with a pattern settled once: A = L D U with unit triangles, U = Lᵀ when A is symmetric.
//!
//! Up-looking, one row of L (and one column of U) at a time, after T. A. Davis, *Direct Methods for Sparse Linear
//! Systems*, SIAM 2006, sections 4.7–4.8; the unsymmetric case has a symmetric pattern because every entry is a
//! joint. The order is approximate minimum degree (faer). No pivoting: the stage matrix is symmetric positive
//! definite for any step that makes sense, and a pivot that is not positive is reported instead of divided by.
//! Nothing is allocated after [`Matrix::new`].

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// A matrix with the pattern of a joint graph, and its factors.
#[derive(Debug, Clone)]
pub struct Matrix {
    n: usize,
    /// Old index at each place of the elimination order, and the inverse.
    order: Vec<u32>,
    place: Vec<u32>,
    /// Diagonal of A by place.
    diagonal: Vec<f64>,
    /// Off-diagonal of A by rows of the lower triangle, and the mirror image.
    row_start: Vec<u32>,
    row_column: Vec<u32>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// L by columns; `l_value[p]` is L(r, k), `u_value[p]` is U(k, r).
    l_start: Vec<u32>,
    l_row: Vec<u32>,
    l_value: Vec<f64>,
    u_value: Vec<f64>,
    /// Rows of L: columns, ascending, and where they stand in `l_value`.
    reach_start: Vec<u32>,
    reach: Vec<Reach>,
    pivot: Vec<f64>,
    inverse_pivot: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    symmetric: bool,
}

#[derive(Debug, Clone, Copy)]
struct Reach {
    column: u32,
    at: u32,
}

/// A pivot that is not positive, or not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotPositive;

impl Matrix {
    /// A zero matrix of order `n` with a diagonal and the pairs (i, j), i ≠ j, on both sides of it. Returns too
    /// the slot of each pair, for [`Matrix::add`].
    pub fn new(n: usize, pairs: &[(usize, usize)]) -> (Self, Vec<u32>) {
        let (order, place) = elimination_order(n, pairs);
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); n];
        let placed = |&(i, j): &(usize, usize)| {
            let (p, q) = (place[i], place[j]);
            (p.max(q), p.min(q))
        };
        for pair in pairs {
            let (r, c) = placed(pair);
            rows[r as usize].push(c);
        }
        let mut row_start = vec![0u32];
        let mut row_column = Vec::new();
        for row in &mut rows {
            row.sort_unstable();
            row.dedup();
            row_column.extend_from_slice(row);
            row_start.push(row_column.len() as u32);
        }
        let slots = pairs
            .iter()
            .map(|pair| {
                let (r, c) = placed(pair);
                let (s, e) = (row_start[r as usize] as usize, row_start[r as usize + 1] as usize);
                (s + row_column[s..e].partition_point(|&x| x < c)) as u32
            })
            .collect();
        let (l_start, l_row, reach_start, reach) = symbolic(n, &row_start, &row_column);
        let (entries, fill) = (row_column.len(), l_row.len());
        let matrix = Matrix {
            n,
            order,
            place,
            diagonal: vec![0.0; n],
            row_start,
            row_column,
            lower: vec![0.0; entries],
            upper: vec![0.0; entries],
            l_start,
            l_row,
            l_value: vec![0.0; fill],
            u_value: vec![0.0; fill],
            reach_start,
            reach,
            pivot: vec![0.0; n],
            inverse_pivot: vec![0.0; n],
            x: vec![0.0; n],
            y: vec![0.0; n],
            symmetric: true,
        };
        (matrix, slots)
    }

    /// Sets A to diag(d).
    pub fn set_diagonal(&mut self, d: &[f64]) {
        for (place, &old) in self.order.iter().enumerate() {
            self.diagonal[place] = d[old as usize];
        }
        self.lower.fill(0.0);
        self.upper.fill(0.0);
    }

    /// Adds `s` to A(i, i).
    #[inline]
    pub fn add_diagonal(&mut self, i: usize, s: f64) {
        self.diagonal[self.place[i] as usize] += s;
    }

    /// The diagonal entry of A at i.
    #[inline]
    pub fn diagonal(&self, i: usize) -> f64 {
        self.diagonal[self.place[i] as usize]
    }

    /// Adds the coupling of a joint between i and j whose slot is `slot`: `in_i` is −A(i, j), `in_j` is −A(j, i);
    /// each goes with the opposite sign to its row's diagonal.
    #[inline]
    pub fn add(&mut self, slot: u32, i: usize, j: usize, in_i: f64, in_j: f64) {
        let (p, q) = (self.place[i] as usize, self.place[j] as usize);
        self.diagonal[p] += in_i;
        self.diagonal[q] += in_j;
        let (low, up) = if p > q { (in_i, in_j) } else { (in_j, in_i) };
        self.lower[slot as usize] -= low;
        self.upper[slot as usize] -= up;
    }

    /// Factorises A. With `symmetric` the mirror image is not read.
    ///
    /// # Errors
    /// [`NotPositive`] when a pivot is not above zero; the factors are then of no use.
    pub fn factorise(&mut self, symmetric: bool) -> Result<(), NotPositive> {
        self.symmetric = symmetric;
        if symmetric { self.factorise_symmetric() } else { self.factorise_unsymmetric() }
    }

    fn factorise_symmetric(&mut self) -> Result<(), NotPositive> {
        for i in 0..self.n {
            for e in self.row_start[i] as usize..self.row_start[i + 1] as usize {
                self.x[self.row_column[e] as usize] = self.lower[e];
            }
            let mut d = self.diagonal[i];
            for t in self.reach_start[i] as usize..self.reach_start[i + 1] as usize {
                let Reach { column, at } = self.reach[t];
                let (k, at) = (column as usize, at as usize);
                let xk = std::mem::take(&mut self.x[k]);
                let start = self.l_start[k] as usize;
                for (l, &r) in self.l_value[start..at].iter().zip(&self.l_row[start..at]) {
                    self.x[r as usize] -= l * xk;
                }
                let l = xk * self.inverse_pivot[k];
                d -= l * xk;
                self.l_value[at] = l;
            }
            if d > 0.0 {
                self.inverse_pivot[i] = 1.0 / d;
            } else {
                return Err(self.abandon());
            }
        }
        Ok(())
    }

    fn factorise_unsymmetric(&mut self) -> Result<(), NotPositive> {
        for i in 0..self.n {
            for e in self.row_start[i] as usize..self.row_start[i + 1] as usize {
                let c = self.row_column[e] as usize;
                self.x[c] = self.lower[e];
                self.y[c] = self.upper[e];
            }
            let mut d = self.diagonal[i];
            for t in self.reach_start[i] as usize..self.reach_start[i + 1] as usize {
                let Reach { column, at } = self.reach[t];
                let (k, at) = (column as usize, at as usize);
                let xk = std::mem::take(&mut self.x[k]);
                let yk = std::mem::take(&mut self.y[k]);
                for p in self.l_start[k] as usize..at {
                    let r = self.l_row[p] as usize;
                    self.x[r] -= self.u_value[p] * xk;
                    self.y[r] -= self.l_value[p] * yk;
                }
                let l = xk * self.inverse_pivot[k];
                d -= l * yk;
                self.l_value[at] = l;
                self.u_value[at] = yk * self.inverse_pivot[k];
            }
            if d > 0.0 {
                self.inverse_pivot[i] = 1.0 / d;
            } else {
                return Err(self.abandon());
            }
        }
        Ok(())
    }

    fn abandon(&mut self) -> NotPositive {
        self.x.fill(0.0);
        self.y.fill(0.0);
        NotPositive
    }

    /// Solves A x = b in place with the last factors.
    pub fn solve(&mut self, b: &mut [f64]) {
        let z = &mut self.pivot;
        for (place, &old) in self.order.iter().enumerate() {
            z[place] = b[old as usize];
        }
        for k in 0..self.n {
            let zk = z[k];
            let column = self.l_start[k] as usize..self.l_start[k + 1] as usize;
            for (l, &r) in self.l_value[column.clone()].iter().zip(&self.l_row[column]) {
                z[r as usize] -= l * zk;
            }
        }
        let u = if self.symmetric { &self.l_value } else { &self.u_value };
        for k in (0..self.n).rev() {
            let column = self.l_start[k] as usize..self.l_start[k + 1] as usize;
            let mut zk = z[k] * self.inverse_pivot[k];
            for (u, &r) in u[column.clone()].iter().zip(&self.l_row[column]) {
                zk -= u * z[r as usize];
            }
            z[k] = zk;
        }
        for (place, &old) in self.order.iter().enumerate() {
            b[old as usize] = z[place];
        }
    }
}

/// Approximate minimum degree order of the graph: (old index at each place, place of each old index).
fn elimination_order(n: usize, pairs: &[(usize, usize)]) -> (Vec<u32>, Vec<u32>) {
    let mut columns: Vec<Vec<usize>> = vec![Vec::new(); n];
    for &(i, j) in pairs {
        columns[i].push(j);
        columns[j].push(i);
    }
    let mut start = vec![0usize];
    let mut rows = Vec::new();
    for column in &mut columns {
        column.sort_unstable();
        column.dedup();
        rows.extend_from_slice(column);
        start.push(rows.len());
    }
    let mut perm = vec![0usize; n];
    let mut inverse = vec![0usize; n];
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &start, None, &rows);
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(n, rows.len()));
    let stack = MemStack::new(&mut memory);
    if amd::order(&mut perm, &mut inverse, pattern, amd::Control::default(), stack).is_err() {
        // Only an overflow of the index type can fail; the natural order is right too, just slower.
        perm = (0..n).collect();
        inverse = (0..n).collect();
    }
    (perm.iter().map(|&i| i as u32).collect(), inverse.iter().map(|&i| i as u32).collect())
}

/// Columns of L and rows of L from the rows of the lower triangle of A (elimination tree reach).
fn symbolic(n: usize, row_start: &[u32], row_column: &[u32]) -> (Vec<u32>, Vec<u32>, Vec<u32>, Vec<Reach>) {
    const NONE: u32 = u32::MAX;
    let mut parent = vec![NONE; n];
    let mut mark = vec![NONE; n];
    let mut rows: Vec<Vec<u32>> = Vec::with_capacity(n);
    for i in 0..n {
        mark[i] = i as u32;
        let mut row = Vec::new();
        for &c in &row_column[row_start[i] as usize..row_start[i + 1] as usize] {
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
        for symmetric in [true, false] {
            let (mut m, slots) = Matrix::new(n, &pairs);
            let mass: Vec<f64> = (0..n).map(|i| 1.0 + 0.01 * i as f64).collect();
            let mut dense = vec![vec![0.0; n]; n];
            m.set_diagonal(&mass);
            for i in 0..n {
                dense[i][i] = mass[i];
            }
            for (e, (&(i, j), &slot)) in pairs.iter().zip(&slots).enumerate() {
                let s = 1.0 + (e % 5) as f64 * 100.0;
                let t = if symmetric { s } else { s * 1.3 };
                m.add(slot, i, j, s, t);
                dense[i][i] += s;
                dense[i][j] -= s;
                dense[j][j] += t;
                dense[j][i] -= t;
            }
            m.factorise(symmetric).expect("diagonally dominant");
            let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
            let mut x = b.clone();
            m.solve(&mut x);
            for i in 0..n {
                let product: f64 = (0..n).map(|j| dense[i][j] * x[j]).sum();
                assert!((product - b[i]).abs() < 1e-11, "row {i}: {product} against {}", b[i]);
            }
        }
    }

    #[test]
    fn reports_a_pivot_that_is_not_positive() {
        let (mut m, slots) = Matrix::new(2, &[(0, 1)]);
        m.set_diagonal(&[1.0, 1.0]);
        m.add(slots[0], 0, 1, -2.0, -2.0);
        assert_eq!(m.factorise(true), Err(NotPositive));
        m.set_diagonal(&[1.0, 1.0]);
        m.add(slots[0], 0, 1, 2.0, 2.0);
        assert_eq!(m.factorise(true), Ok(()));
    }
}
