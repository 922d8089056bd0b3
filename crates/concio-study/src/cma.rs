//! Evolution strategy with covariance matrix adaptation (CMA-ES): N. Hansen, The CMA Evolution Strategy: A Tutorial,
//! arXiv:1604.00772 (2016), equation numbers below are his; default parameters of his Table 1, with the weights that are
//! above 0 alone.
//!
//! Points are asked for and told in the order of their worth, so that any order serves, that of two objectives too.
//! Bounds are met by folding ([`folded`]): beyond them the strategy sees the mirror image of what lies inside.

use concio::dice::Dice;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The strategy: a normal distribution that learns from its better draws.
#[derive(Debug, Clone)]
pub struct Cma {
    /// Points of a generation, λ.
    population: usize,
    weights: Vec<f64>,
    mu_eff: f64,
    c_sigma: f64,
    d_sigma: f64,
    c_c: f64,
    c_1: f64,
    c_mu: f64,
    /// Expected length of a standard normal vector.
    chi: f64,
    mean: DVector<f64>,
    sigma: f64,
    /// C, its eigenvectors, and the square roots of its eigenvalues.
    covariance: DMatrix<f64>,
    axes: DMatrix<f64>,
    lengths: DVector<f64>,
    path_sigma: DVector<f64>,
    path_c: DVector<f64>,
    generation: i32,
    dice: Dice,
}

impl Cma {
    /// Around `mean`, with standard deviation `sigma` (above 0) along every axis; `population` points a generation, at
    /// least 4. `mean` has at least one element.
    pub fn new(mean: &[f64], sigma: f64, population: usize, seed: u64) -> Self {
        let n = mean.len() as f64;
        let lambda = population.max(4);
        let mu = lambda / 2;
        // (49), (53) of the positive ones.
        let raw: Vec<f64> = (1..=mu).map(|i| ((lambda as f64 + 1.0) / 2.0).ln() - (i as f64).ln()).collect();
        let total: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / total).collect();
        let mu_eff = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let c_sigma = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let c_1 = 2.0 / ((n + 1.3).powi(2) + mu_eff);
        let c_mu = 2.0 * (0.25 + mu_eff + 1.0 / mu_eff - 2.0) / ((n + 2.0).powi(2) + mu_eff);
        Cma {
            population: lambda,
            weights,
            mu_eff,
            c_sigma,
            d_sigma: 1.0 + 2.0 * (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma,
            c_c: (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n),
            c_1,
            c_mu: c_mu.min(1.0 - c_1),
            chi: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
            mean: DVector::from_column_slice(mean),
            sigma,
            covariance: DMatrix::identity(mean.len(), mean.len()),
            axes: DMatrix::identity(mean.len(), mean.len()),
            lengths: DVector::from_element(mean.len(), 1.0),
            path_sigma: DVector::zeros(mean.len()),
            path_c: DVector::zeros(mean.len()),
            generation: 0,
            dice: Dice::new(seed),
        }
    }

    /// Points of the next generation, (38) to (40).
    pub fn ask(&mut self) -> Vec<Vec<f64>> {
        (0..self.population).map(|_| self.draw()).collect()
    }

    fn draw(&mut self) -> Vec<f64> {
        let z = DVector::from_fn(self.mean.len(), |_, _| self.dice.normal());
        let y = &self.axes * z.component_mul(&self.lengths);
        (&self.mean + self.sigma * y).iter().copied().collect()
    }

    /// Learns from the points of a generation, the best first.
    pub fn tell(&mut self, ranked: &[Vec<f64>]) {
        let steps: Vec<DVector<f64>> = (ranked.iter().zip(&self.weights))
            .map(|(x, _)| (DVector::from_column_slice(x) - &self.mean) / self.sigma)
            .collect();
        let zero = DVector::zeros(self.mean.len());
        let step = steps.iter().zip(&self.weights).fold(zero, |sum, (y, w)| sum + *w * y);
        self.mean += self.sigma * &step; // (42)
        self.generation += 1;
        let whitened = &self.axes * (self.axes.transpose() * &step).component_div(&self.lengths);
        let keep = 1.0 - self.c_sigma;
        self.path_sigma =
            keep * &self.path_sigma + (self.c_sigma * (2.0 - self.c_sigma) * self.mu_eff).sqrt() * whitened; // (43)
        let length = self.path_sigma.norm();
        // (45): the other path waits while the steps grow fast.
        let n = self.mean.len() as f64;
        let usual = length / (1.0 - keep.powi(2 * self.generation)).sqrt();
        let goes_on = usual < (1.4 + 2.0 / (n + 1.0)) * self.chi;
        let gain = if goes_on { (self.c_c * (2.0 - self.c_c) * self.mu_eff).sqrt() } else { 0.0 };
        self.path_c = (1.0 - self.c_c) * &self.path_c + gain * &step;
        self.adapt(&steps, goes_on);
        self.sigma *= ((self.c_sigma / self.d_sigma) * (length / self.chi - 1.0)).min(1.0).exp(); // (44)
    }

    /// The covariance, (47), and its axes.
    fn adapt(&mut self, steps: &[DVector<f64>], goes_on: bool) {
        let stalled = if goes_on { 0.0 } else { self.c_1 * self.c_c * (2.0 - self.c_c) };
        let keep = 1.0 + stalled - self.c_1 - self.c_mu;
        let mut c = keep * &self.covariance + self.c_1 * &self.path_c * self.path_c.transpose();
        for (y, w) in steps.iter().zip(&self.weights) {
            c += self.c_mu * *w * y * y.transpose();
        }
        self.covariance = 0.5 * (&c + c.transpose());
        let eigen = SymmetricEigen::new(self.covariance.clone());
        // Round-off may leave an eigenvalue a little below 0.
        let least = 1e-14 * eigen.eigenvalues.max();
        self.lengths = eigen.eigenvalues.map(|v| v.max(least).sqrt());
        self.axes = eigen.eigenvectors;
    }

    /// The middle of the distribution.
    pub fn mean(&self) -> &[f64] {
        self.mean.as_slice()
    }

    /// Its width along its longest axis.
    pub fn width(&self) -> f64 {
        self.sigma * self.lengths.max()
    }
}

/// A number folded into 0 … 1: beyond an end it comes back as from a mirror.
pub fn folded(x: f64) -> f64 {
    let x = x.rem_euclid(2.0);
    if x > 1.0 { 2.0 - x } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evaluations until the best value lies below `target`, of at most `most`.
    fn evaluations(value: fn(&[f64]) -> f64, start: &[f64], target: f64, most: usize, seed: u64) -> Option<usize> {
        let mut cma = Cma::new(start, 0.5, 4 + (3.0 * (start.len() as f64).ln()) as usize, seed);
        let mut done = 0;
        while done < most {
            let mut points = cma.ask();
            done += points.len();
            points.sort_by(|a, b| value(a).total_cmp(&value(b)));
            if value(&points[0]) < target {
                return Some(done);
            }
            cma.tell(&points);
        }
        None
    }

    fn sphere(x: &[f64]) -> f64 {
        x.iter().map(|v| v * v).sum()
    }

    fn rosenbrock(x: &[f64]) -> f64 {
        x.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2)).sum()
    }

    /// An ellipsoid whose axes differ by 10³ in length: without a learnt covariance it takes some 10⁵ evaluations.
    fn ellipsoid(x: &[f64]) -> f64 {
        let n = x.len() as f64 - 1.0;
        x.iter().enumerate().map(|(i, v)| 1e6f64.powf(i as f64 / n) * v * v).sum()
    }

    #[test]
    fn known_minima_are_found_to_1e_minus_12() {
        for seed in 1..=5 {
            let of = |f: fn(&[f64]) -> f64, n: usize, most| evaluations(f, &vec![1.7; n], 1e-12, most, seed);
            assert!(of(sphere, 1, 500).is_some() && of(sphere, 5, 1500).is_some(), "sphere, seed {seed}");
            assert!(of(ellipsoid, 5, 6000).is_some(), "ellipsoid, seed {seed}");
        }
        // The valley of Rosenbrock's function has a second, local minimum from four unknowns on: start on its side.
        for seed in 1..=5 {
            let found = evaluations(rosenbrock, &[0.0; 5], 1e-12, 15_000, seed);
            assert!(found.is_some(), "Rosenbrock, seed {seed}");
        }
    }

    #[test]
    fn a_seed_gives_the_same_points() {
        let run = |seed| {
            let mut cma = Cma::new(&[0.3, 0.6], 0.3, 8, seed);
            for _ in 0..20 {
                let mut points = cma.ask();
                points.sort_by(|a, b| rosenbrock(a).total_cmp(&rosenbrock(b)));
                cma.tell(&points);
            }
            cma.mean().iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(run(3), run(3));
        assert_ne!(run(3), run(4));
    }

    #[test]
    fn numbers_are_folded_at_their_bounds() {
        for (x, y) in [(0.25, 0.25), (-0.25, 0.25), (1.25, 0.75), (2.25, 0.25), (-1.25, 0.75), (1.0, 1.0), (2.0, 0.0)] {
            assert_eq!(folded(x), y, "{x}");
        }
    }
}
