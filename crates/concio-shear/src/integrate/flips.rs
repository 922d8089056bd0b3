//! Joints that open or close while a stage is sought, without a new factorisation.
//!
//! With B the columns e_a − e_b of those whose state is no longer that of the factors of J, S = ±τ² k and β what they
//! add to the right side, the solution x of J x = b becomes that of (J + B S Bᵀ) x' = b + B β by
//!
//!   x' = y − U (I + S Bᵀ U)⁻¹ S Bᵀ y,   y = x + U β,   U = J⁻¹ B
//!
//! (M. A. Woodbury 1950; W. W. Hager, SIAM Review 31 (1989) 221). Exact but for rounding: where a closed joint with a
//! stiffness a million times what is beside it opens, some six of sixteen digits are lost.

use crate::integrate::linear::Matrix;

/// Joints that are followed at most: a solution for each costs as much as a new factorisation beyond that.
const MOST: usize = 6;

/// The joints that have changed, and what that makes of solutions.
#[derive(Debug, Clone)]
pub struct Flips {
    /// Places of the unknowns, base and top at the end.
    n: usize,
    joints: Vec<Flipped>,
    /// U, a column for each of them.
    columns: Vec<f64>,
    /// x.
    before: Vec<f64>,
    /// I + S Bᵀ U, factorised: rows as they were exchanged.
    small: [[f64; MOST]; MOST],
    order: [usize; MOST],
}

#[derive(Debug, Clone, Copy)]
struct Flipped {
    joint: u32,
    sides: [u32; 2],
    /// Its part of S and of β; 0 when it is back in the state of the factors.
    weight: f64,
    push: f64,
}

impl Flipped {
    /// Bᵀ x.
    #[inline(always)]
    fn across(&self, x: &[f64]) -> f64 {
        x[self.sides[0] as usize] - x[self.sides[1] as usize]
    }
}

impl Flips {
    /// For `n` unknowns; with none nothing can be followed.
    pub fn new(n: usize) -> Self {
        let room = if n > 0 { n + 2 } else { 0 };
        Flips {
            n: room,
            joints: Vec::with_capacity(MOST),
            columns: vec![0.0; MOST * room],
            before: vec![0.0; room],
            small: [[0.0; MOST]; MOST],
            order: [0; MOST],
        }
    }

    pub fn in_use(&self) -> bool {
        self.n > 0
    }

    /// The factors are those of the joints as they are.
    pub fn clear(&mut self) {
        self.joints.clear();
    }

    /// Keeps x, before the first joint changes.
    #[inline(always)]
    pub fn begin(&mut self, x: &[f64]) {
        if self.joints.is_empty() {
            self.before.copy_from_slice(x);
        }
    }

    /// The joints that have been met so far, with what they add to matrix and right side: `[weight, push]` of each anew.
    #[inline(always)]
    pub fn revise(&mut self, change: impl Fn(usize) -> [f64; 2]) {
        for flipped in &mut self.joints {
            [flipped.weight, flipped.push] = change(flipped.joint as usize);
        }
    }

    #[inline(always)]
    fn hold(&self, joint: usize) -> bool {
        self.joints.iter().any(|f| f.joint as usize == joint)
    }

    /// Whether there is room for all of `joints` that are not there yet: asked before solutions are made for any.
    #[inline(always)]
    pub fn have_room(&self, joints: impl Iterator<Item = usize>) -> bool {
        self.joints.len() + joints.filter(|&joint| !self.hold(joint)).take(MOST + 1).count() <= MOST
    }

    /// Another joint, if it is none of them; there has to be room.
    #[inline(always)]
    pub fn add(&mut self, joint: usize, sides: [u32; 2], [weight, push]: [f64; 2], matrix: &mut Matrix) {
        if self.hold(joint) {
            return;
        }
        let at = self.joints.len();
        let column = &mut self.columns[at * self.n..][..self.n];
        column.fill(0.0);
        column[sides[0] as usize] = 1.0;
        column[sides[1] as usize] = -1.0;
        // Supports do not move.
        column[self.n - 2..].fill(0.0);
        matrix.solve(&mut column[..self.n - 2]);
        self.joints.push(Flipped { joint: joint as u32, sides, weight, push });
    }

    /// x' into `x`; false where the matrix may have ceased to be positive.
    #[inline(always)]
    pub fn solution(&mut self, x: &mut [f64]) -> bool {
        if !self.factorise() {
            return false;
        }
        x.copy_from_slice(&self.before);
        for (flipped, column) in self.joints.iter().zip(self.columns.chunks_exact(self.n)) {
            subtract(x, -flipped.push, column);
        }
        self.correct(x);
        true
    }

    /// Makes of a solution with the factors, `x` by place, the one with the changed matrix.
    #[inline(always)]
    pub fn correct(&self, x: &mut [f64]) {
        let count = self.joints.len();
        if count == 0 {
            return;
        }
        let mut c = [0.0; MOST];
        for i in 0..count {
            let flipped = &self.joints[self.order[i]];
            c[i] = flipped.weight * flipped.across(x);
        }
        for i in 0..count {
            for k in 0..i {
                c[i] -= self.small[i][k] * c[k];
            }
        }
        for i in (0..count).rev() {
            for k in i + 1..count {
                c[i] -= self.small[i][k] * c[k];
            }
            c[i] /= self.small[i][i];
        }
        for (c, column) in c[..count].iter().zip(self.columns.chunks_exact(self.n)) {
            subtract(x, *c, column);
        }
    }

    /// L U of I + S Bᵀ U with rows exchanged; false where its determinant, by which that of the matrix changes, is not
    /// positive.
    #[inline(always)]
    fn factorise(&mut self) -> bool {
        let count = self.joints.len();
        let small = &mut self.small;
        for (i, flipped) in self.joints.iter().enumerate() {
            for (j, column) in self.columns.chunks_exact(self.n).take(count).enumerate() {
                small[i][j] = flipped.weight * flipped.across(column) + if i == j { 1.0 } else { 0.0 };
            }
            self.order[i] = i;
        }
        let mut positive = true;
        for k in 0..count {
            let largest = (k..count).fold(k, |m, i| if small[i][k].abs() > small[m][k].abs() { i } else { m });
            if largest != k {
                small.swap(k, largest);
                self.order.swap(k, largest);
                positive = !positive;
            }
            let pivot = small[k][k];
            if !(pivot.abs() > 0.0) {
                return false;
            }
            positive ^= pivot < 0.0;
            for i in k + 1..count {
                small[i][k] /= pivot;
                let factor = small[i][k];
                for j in k + 1..count {
                    small[i][j] -= factor * small[k][j];
                }
            }
        }
        positive
    }
}

#[inline(always)]
fn subtract(x: &mut [f64], factor: f64, column: &[f64]) {
    for (x, u) in x.iter_mut().zip(column) {
        *x -= factor * u;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::linear::Factoring;

    /// Springs of a row of blocks come and go: solutions are those of the matrix factorised anew.
    #[test]
    fn solutions_follow_the_joints() {
        let n = 40;
        let pairs: Vec<(usize, usize)> = (0..n - 1).map(|i| (i, i + 1)).chain((0..n - 7).map(|i| (i, i + 7))).collect();
        let base = |e: usize| [3.0, 50.0, 1e5][e % 3];
        let row = |turned: &[usize]| {
            let (mut matrix, slots) = Matrix::new(n, &pairs, &[], Factoring::Symmetric);
            let place = matrix.places().to_vec();
            matrix.diagonal.fill(1.0);
            for (e, (&(i, j), &slot)) in pairs.iter().zip(&slots).enumerate() {
                let s = if turned.contains(&e) { 7e5 - base(e) } else { base(e) };
                matrix.diagonal[place[i] as usize] += s;
                matrix.diagonal[place[j] as usize] += s;
                matrix.lower[slot as usize] -= s;
            }
            matrix.factorise().expect("diagonally dominant");
            (matrix, place)
        };
        let (mut matrix, place) = row(&[]);
        let b: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
        let mut first = b.clone();
        matrix.solve(&mut first);
        first.extend([0.0; 2]);
        let mut flips = Flips::new(n);
        flips.begin(&first);
        let sides = |e: usize| [place[pairs[e].0], place[pairs[e].1]];
        let change = |e: usize| 7e5 - 2.0 * base(e);
        let mut x = first.clone();
        for turned in [&[2usize][..], &[2, 40], &[40], &[40, 9, 10, 11, 70], &[2, 40, 9, 10, 11, 70]] {
            assert!(flips.have_room(turned.iter().copied()));
            flips.revise(|e| if turned.contains(&e) { [change(e), 0.3 * e as f64] } else { [0.0; 2] });
            for &e in turned {
                flips.add(e, sides(e), [change(e), 0.3 * e as f64], &mut matrix);
            }
            assert!(flips.solution(&mut x));
            let (mut anew, _) = row(turned);
            let mut exact = b.clone();
            for &e in turned {
                let [i, j] = sides(e).map(|s| s as usize);
                exact[i] += 0.3 * e as f64;
                exact[j] -= 0.3 * e as f64;
            }
            anew.solve(&mut exact);
            let scale = exact.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            for (i, (x, exact)) in x.iter().zip(&exact).enumerate() {
                assert!((x - exact).abs() < 1e-9 * scale, "{turned:?}, unknown {i}: {x} against {exact}");
            }
        }
        assert!(flips.have_room([70, 9].into_iter()));
        assert!(!flips.have_room([70, 0].into_iter()), "no room for a seventh");
        // A spring that is more than taken away leaves nothing that could be solved.
        flips.revise(|e| [if e == 2 { -3e5 } else { 0.0 }, 0.0]);
        assert!(!flips.solution(&mut x));
    }
}
