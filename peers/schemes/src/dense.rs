//! A dense symmetric matrix, factorised by Cholesky: for the few unknowns of a comparison.

/// Lower triangle, row by row with the full stride.
#[derive(Debug, Clone)]
pub struct Dense {
    n: usize,
    a: Vec<f64>,
}

impl Dense {
    pub fn new(n: usize) -> Self {
        Dense { n, a: vec![0.0; n * n] }
    }

    /// The diagonal matrix of these values.
    pub fn set_diagonal(&mut self, diagonal: &[f64]) {
        self.a.fill(0.0);
        for (i, d) in diagonal.iter().enumerate() {
            self.a[i * self.n + i] = *d;
        }
    }

    /// Adds s to (i, i), and where there is a j to (j, j), and −s to (i, j).
    pub fn couple(&mut self, i: usize, j: Option<usize>, s: f64) {
        self.a[i * self.n + i] += s;
        if let Some(j) = j {
            self.a[j * self.n + j] += s;
            self.a[i.max(j) * self.n + i.min(j)] -= s;
        }
    }

    /// The diagonal entry.
    pub fn diagonal(&self, i: usize) -> f64 {
        self.a[i * self.n + i]
    }

    /// A = L Lᵀ in place; false where A is not positive definite.
    pub fn factorise(&mut self) -> bool {
        let n = self.n;
        for j in 0..n {
            let (above, rest) = self.a.split_at_mut(j * n);
            let row = &mut rest[..n];
            for k in 0..j {
                let other = &above[k * n..k * n + k + 1];
                let dot: f64 = row[..k].iter().zip(other).map(|(x, y)| x * y).sum();
                row[k] = (row[k] - dot) / other[k];
            }
            let pivot = row[j] - row[..j].iter().map(|x| x * x).sum::<f64>();
            if !(pivot > 0.0) {
                return false;
            }
            row[j] = pivot.sqrt();
        }
        true
    }

    /// Solves with the factors.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.n;
        for i in 0..n {
            let row = &self.a[i * n..i * n + i + 1];
            let dot: f64 = row[..i].iter().zip(&*b).map(|(l, x)| l * x).sum();
            b[i] = (b[i] - dot) / row[i];
        }
        for i in (0..n).rev() {
            b[i] /= self.a[i * n + i];
            let x = b[i];
            for (value, l) in b[..i].iter_mut().zip(&self.a[i * n..i * n + i]) {
                *value -= l * x;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_chain() {
        let mut matrix = Dense::new(3);
        matrix.set_diagonal(&[1.0, 2.0, 3.0]);
        matrix.couple(0, Some(1), 4.0);
        matrix.couple(2, Some(1), 5.0);
        matrix.couple(2, None, 6.0);
        // A x for x = (1, −2, 3).
        let mut b = [5.0 + 8.0, -4.0 - 22.0 - 15.0, 10.0 + 42.0];
        assert!(matrix.factorise());
        matrix.solve(&mut b);
        for (found, exact) in b.iter().zip([1.0, -2.0, 3.0]) {
            assert!((found - exact).abs() < 1e-14, "{b:?}");
        }
        matrix.set_diagonal(&[1.0, -1.0, 1.0]);
        assert!(!matrix.factorise());
    }
}
