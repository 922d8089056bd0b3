//! Linear springs between bodies of three unknowns, their energy, and the systems that it leads to.
//!
//! W = ½ Σ k (g·x + h·m)², where x are the six unknowns of the two bodies and m what is imposed from outside.

use clarabel::algebra::CscMatrix;
use clarabel::qdldl::{QDLDLFactorisation, QDLDLSettings};

use crate::ContinuumError;

/// Unknowns of a body: two displacements and a rotation in the plane; a deflection and two rotations out of it.
pub(crate) const UNKNOWNS: usize = 3;
/// Numbers that may be imposed.
pub(crate) const IMPOSED: usize = 5;

/// A spring at a point of a joint.
#[derive(Debug, Clone)]
pub(crate) struct Spring {
    /// The bodies beside it; the same one where a brick touches its own image.
    pub bodies: [usize; 2],
    /// What the unknowns of either body do to it.
    pub rows: [[f64; UNKNOWNS]; 2],
    /// What the imposed numbers do to it.
    pub imposed: [f64; IMPOSED],
    /// k, energy per square of the jump: N/m in the plane.
    pub stiffness: f64,
}

/// Part of its own diagonal that is added to every unknown: bodies that nothing holds stay where they are, the energy of all
/// others changes by no more than this.
const HELD: f64 = 1e-13;

/// Row, column, value.
type Entry = (usize, usize, f64);

/// Stiffness matrix of springs, symmetric and without negative part.
#[derive(Debug, Clone, Default)]
pub(crate) struct Matrix {
    entries: Vec<Entry>,
}

impl Matrix {
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        if value != 0.0 {
            self.entries.push((row, column, value));
        }
    }

    pub fn of(springs: &[Spring]) -> Matrix {
        let mut matrix = Matrix::default();
        for spring in springs {
            let unknowns = spring.unknowns();
            for (i, u) in unknowns {
                for (j, v) in unknowns {
                    matrix.add(i, j, spring.stiffness * u * v);
                }
            }
        }
        matrix
    }

    /// Solves for right sides, some unknowns prescribed.
    ///
    /// # Errors
    /// A matrix that is none of springs: with numbers that are none.
    pub fn solve(
        &self,
        unknowns: usize,
        right: &[Vec<f64>],
        prescribed: &[Option<Vec<f64>>],
    ) -> Result<Vec<Vec<f64>>, ContinuumError> {
        let free = |i: usize| prescribed.get(i).is_none_or(Option::is_none);
        let mut number = vec![usize::MAX; unknowns];
        let mut n = 0;
        for i in (0..unknowns).filter(|i| free(*i)) {
            number[i] = n;
            n += 1;
        }
        let of_free = |values: &Vec<f64>| (0..unknowns).filter(|i| free(*i)).map(|i| values[i]).collect();
        let mut found: Vec<Vec<f64>> = right.iter().map(of_free).collect();
        let mut diagonal = vec![0.0; n];
        let mut entries = Vec::with_capacity(self.entries.len() + n);
        for &(i, j, value) in self.entries.iter().filter(|(i, ..)| free(*i)) {
            match prescribed.get(j).and_then(Option::as_ref) {
                Some(values) => found.iter_mut().zip(values).for_each(|(b, x)| b[number[i]] -= value * x),
                None => {
                    entries.push((number[i], number[j], value));
                    if i == j {
                        diagonal[number[i]] += value;
                    }
                }
            }
        }
        entries.extend(diagonal.iter().enumerate().map(|(i, d)| (i, i, if *d > 0.0 { HELD * d } else { 1.0 })));
        solve_all(n, &entries, &mut found)?;
        let value = |i: usize, c: usize| match prescribed.get(i).and_then(Option::as_ref) {
            Some(values) => values[c],
            None => found[c][number[i]],
        };
        Ok((0..right.len()).map(|c| (0..unknowns).map(|i| value(i, c)).collect()).collect())
    }
}

/// Solves for all right sides in place; `entries` are those of both triangles, the same place may have several.
fn solve_all(n: usize, entries: &[Entry], right: &mut [Vec<f64>]) -> Result<(), ContinuumError> {
    if n == 0 {
        return Ok(());
    }
    let unsolved = |what: String| ContinuumError::NotSolved(what);
    let upper = entries.iter().filter(|(i, j, _)| i <= j);
    let (rows, (columns, values)): (_, (_, Vec<f64>)) = upper.map(|&(i, j, value)| (i, (j, value))).unzip();
    let matrix = CscMatrix::new_from_triplets(n, n, rows, columns, values);
    let settings = QDLDLSettings { regularize_enable: false, ..QDLDLSettings::default() };
    let mut factors = QDLDLFactorisation::new(&matrix, Some(settings)).map_err(|e| unsolved(e.to_string()))?;
    if factors.positive_inertia() < n {
        return Err(unsolved("the stiffness is not positive".into()));
    }
    for b in right.iter_mut() {
        let mut x = b.clone();
        factors.solve(&mut x);
        // One correction: the factor knows of the parts that hold.
        entries.iter().for_each(|&(i, j, value)| b[i] -= value * x[j]);
        factors.solve(b);
        b.iter_mut().zip(&x).for_each(|(b, x)| *b += x);
    }
    if right.iter().flatten().all(|x| x.is_finite()) { Ok(()) } else { Err(unsolved("not finite".into())) }
}

impl Spring {
    fn unknowns(&self) -> [(usize, f64); 2 * UNKNOWNS] {
        let at =
            |k: usize| (UNKNOWNS * self.bodies[k / UNKNOWNS] + k % UNKNOWNS, self.rows[k / UNKNOWNS][k % UNKNOWNS]);
        [0, 1, 2, 3, 4, 5].map(at)
    }

    /// The jump under unknowns `x`, nothing imposed.
    pub fn jump(&self, x: &[f64]) -> f64 {
        self.unknowns().iter().map(|(i, g)| g * x[*i]).sum()
    }
}

/// What springs bear when the bodies have come to where the energy is least.
pub(crate) struct Condensed {
    /// ∂²W/∂m∂m of the least energy.
    pub energy: [[f64; IMPOSED]; IMPOSED],
    /// Means of the unknowns under each imposed number, as `means` asks for them: one row per mean.
    pub means: Vec<[f64; IMPOSED]>,
    /// What a unit of force on each mean does to all means: inverse of the stiffness against changing them.
    pub yielding: Vec<Vec<f64>>,
}

/// Lets `bodies` bodies go where the energy is least under each imposed number; `means` are weights of all unknowns.
///
/// # Errors
/// As [`Matrix::solve`].
pub(crate) fn condense(bodies: usize, springs: &[Spring], means: &[Vec<f64>]) -> Result<Condensed, ContinuumError> {
    let unknowns = UNKNOWNS * bodies;
    let mut right = vec![vec![0.0; unknowns]; IMPOSED];
    for spring in springs {
        for (i, g) in spring.unknowns() {
            for (m, h) in spring.imposed.iter().enumerate() {
                right[m][i] -= spring.stiffness * g * h;
            }
        }
    }
    right.extend(means.iter().cloned());
    let found = Matrix::of(springs).solve(unknowns, &right, &[])?;
    let (moved, pushed) = found.split_at(IMPOSED);
    let mut energy = [[0.0; IMPOSED]; IMPOSED];
    for spring in springs {
        // The jump under each number, bodies included: its squares are without the loss of a difference.
        let jumps: Vec<f64> = (0..IMPOSED).map(|m| spring.imposed[m] + spring.jump(&moved[m])).collect();
        for i in 0..IMPOSED {
            for j in 0..IMPOSED {
                energy[i][j] += spring.stiffness * jumps[i] * jumps[j];
            }
        }
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    Ok(Condensed {
        energy,
        means: means.iter().map(|w| std::array::from_fn(|m| dot(w, &moved[m]))).collect(),
        yielding: means.iter().map(|w| pushed.iter().map(|x| dot(w, x)).collect()).collect(),
    })
}
