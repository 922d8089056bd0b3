//! Fixed points x = g(x) from a few values of g: each next x is that at which g(x) − x, straight between those known, is least
//! (Anderson 1965; Walker and Ni 2011).

/// Values that are kept.
pub(crate) const MOST: usize = 8;
/// What the sums of squares are raised by, for differences that are nearly the same.
const RIDGE: f64 = 1e-10;

/// What is known of g.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mixing {
    rounds: usize,
    /// g(x) and g(x) − x of the last x.
    last: [Vec<f64>; 2],
    /// By how much both have changed from x to x.
    change: Vec<[Vec<f64>; 2]>,
    /// Products of the changes of g(x) − x.
    products: [[f64; MOST]; MOST],
}

impl Mixing {
    /// Begins anew, for x of `n` numbers.
    pub fn begin(&mut self, n: usize) {
        self.rounds = 0;
        self.last.iter_mut().for_each(|l| l.resize(n, 0.0));
        self.change.iter_mut().flatten().for_each(|c| c.resize(n, 0.0));
    }

    /// Takes g(x) of `x`, and makes `x` the next.
    pub fn next(&mut self, x: &mut [f64], g: &[f64]) {
        let known = self.rounds.min(MOST);
        if known > 0 {
            let at = known - 1;
            if at == self.change.len() {
                self.change.push([vec![0.0; x.len()], vec![0.0; x.len()]]);
            }
            let [of_g, of_f] = &mut self.change[at];
            for k in 0..x.len() {
                of_g[k] = g[k] - self.last[0][k];
                of_f[k] = g[k] - x[k] - self.last[1][k];
            }
            for i in 0..known {
                let product = self.change[i][1].iter().zip(&self.change[at][1]).map(|(a, b)| a * b).sum();
                (self.products[i][at], self.products[at][i]) = (product, product);
            }
        }
        for k in 0..x.len() {
            (self.last[0][k], self.last[1][k]) = (g[k], g[k] - x[k]);
        }
        let mut shares = [0.0; MOST];
        for i in 0..known {
            shares[i] = self.change[i][1].iter().zip(&self.last[1]).map(|(a, b)| a * b).sum();
        }
        solve(self.products, &mut shares, known);
        x.copy_from_slice(g);
        for (share, [of_g, _]) in shares.iter().zip(&self.change).take(known) {
            x.iter_mut().zip(of_g).for_each(|(x, c)| *x -= share * c);
        }
        self.rounds += 1;
    }
}

/// Gauss's elimination of `n` equations, symmetric and positive; what none of them says is 0.
fn solve(mut a: [[f64; MOST]; MOST], x: &mut [f64; MOST], n: usize) {
    for i in 0..n {
        a[i][i] *= 1.0 + RIDGE;
    }
    for i in 0..n {
        for j in i + 1..n {
            let factor = if a[i][i] > 0.0 { a[j][i] / a[i][i] } else { 0.0 };
            for k in i..n {
                a[j][k] -= factor * a[i][k];
            }
            x[j] -= factor * x[i];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| a[i][k] * x[k]).sum();
        x[i] = if a[i][i] > 0.0 { (x[i] - known) / a[i][i] } else { 0.0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight map of four numbers, expanding in one direction, has its fixed point after five values.
    #[test]
    fn a_straight_map_ends_after_as_many_values_as_it_has_directions() {
        let g = |x: &[f64]| vec![0.9 * x[0] + 0.1 * x[3] + 1.0, -0.5 * x[1] + 2.0, 3.0 * x[2] + x[1], 0.2 * x[3] - 1.0];
        let mut mixing = Mixing::default();
        let mut x = vec![0.0; 4];
        mixing.begin(4);
        for _ in 0..6 {
            let value = g(&x);
            mixing.next(&mut x, &value);
        }
        let off = g(&x).iter().zip(&x).map(|(g, x)| (g - x).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{off:e} {x:?}");
    }
}
