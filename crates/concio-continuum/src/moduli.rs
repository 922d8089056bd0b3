//! Moduli of a continuum, and how they follow from a periodic cell.
//!
//! N = A ε with N = (N11, N22, N12), ε = (ε11, ε22, γ12); M = D χ with χ = (χ11, χ22, 2 χ12); Q = F γ. Axis 1 lies along the
//! courses, axis 2 upwards. With γ12 = 2 ε12 the last entries of the matrices are A1212 and D1212.
//!
//! The cell is solved with three unknowns per brick in the plane and three out of it. Bricks move to where the energy is
//! least; D has what is left when they turn as they like (Kirchhoff), F when their mean rotation is held.

use crate::ContinuumError;
use crate::cell::Cell;
use crate::springs::{Spring, UNKNOWNS, condense};

/// Stiffness of a wall per length.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Moduli {
    /// A [N/m].
    pub membrane: [[f64; 3]; 3],
    /// D [N m].
    pub plate: [[f64; 3]; 3],
    /// F [N/m].
    pub shear: [[f64; 2]; 2],
    /// Stiffness against the two shear strains of Cosserat's continuum, ε12 + ω and ε12 − ω [N/m]: p t and q t of (H2) on the
    /// diagonal. ω is the rotation of the bricks, anticlockwise.
    pub polar: [[f64; 2]; 2],
    /// Couple stiffnesses; none where a cell has more than one brick.
    pub couple: Option<Couple>,
    /// t [m].
    pub thickness: f64,
}

/// Couple stiffnesses per length, M13 = C1 ω,1 and M23 = C2 ω,2 [N m²/m].
///
/// They are the energy of what neighbours turn against each other, all else held. Of the same order in the size of bricks is
/// what a Cosserat continuum leaves out of the strain, so that waves do not confirm them alone (docs/continuum.md).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Couple {
    /// C1 in N.
    pub c1: f64,
    /// C2 in N.
    pub c2: f64,
}

/// Engineering constants of an orthotropic plane stress in Pa, for the thickness t.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Constants {
    /// E1, along the courses.
    pub e1: f64,
    /// E2, upwards.
    pub e2: f64,
    /// ν12: shortening along 2 over the strain along 1.
    pub nu12: f64,
    /// G12.
    pub g12: f64,
    /// G13 = F11/t.
    pub g13: f64,
    /// G23 = F22/t.
    pub g23: f64,
}

/// Part of the largest modulus up to which another is rounding.
const ROUNDING: f64 = 1e-9;

impl Moduli {
    /// Of a periodic cell.
    ///
    /// # Errors
    /// A system that was not solved.
    pub fn of_cell(cell: &Cell) -> Result<Moduli, ContinuumError> {
        let t = cell.thickness;
        let n = cell.bricks.len();
        let all = |of: fn(&crate::Contact, f64) -> Vec<Spring>| -> Vec<Spring> {
            cell.contacts.iter().flat_map(|contact| of(contact, t)).collect()
        };
        let mean = |unknown: usize| {
            let areas = cell.bricks.iter().map(|b| (b.x[1] - b.x[0]) * (b.y[1] - b.y[0]));
            let total: f64 = areas.clone().sum();
            let mut weights = vec![0.0; UNKNOWNS * n];
            areas.enumerate().for_each(|(i, area)| weights[UNKNOWNS * i + unknown] = area / total);
            weights
        };
        let plane = condense(n, &all(crate::Contact::in_plane), &[mean(2)])?;
        let bent = condense(n, &all(crate::Contact::out_of_plane), &[mean(1), mean(2)])?;
        let per_area = |v: f64| v / cell.area;
        let block = |m: &[[f64; 5]; 5]| -> [[f64; 3]; 3] {
            std::array::from_fn(|i| std::array::from_fn(|j| per_area(0.5 * (m[i][j] + m[j][i]))))
        };
        let membrane = block(&plane.energy);
        // The mean rotation held at ω: W = ½ γ A γ + ½ s (ω − m γ)², with m γ the mean that is free.
        let s = per_area(1.0 / plane.yielding[0][0]);
        let m = plane.means[0][2];
        // γ12 = ε12 + ε12 = e + f and ω = (e − f)/2 in e = ε12 + ω, f = ε12 − ω.
        let (of_e, of_f) = (0.5 - m, -0.5 - m);
        let g = membrane[2][2];
        let polar = [[g + s * of_e * of_e, g + s * of_e * of_f], [g + s * of_e * of_f, g + s * of_f * of_f]];
        Ok(Moduli {
            membrane,
            plate: block(&bent.energy),
            shear: held_upright(&bent).map(|row| row.map(per_area)),
            polar,
            couple: (n == 1).then(|| couple(cell)),
            thickness: t,
        })
    }

    /// Engineering constants; none where stretching and shear are coupled, A1112 or A2212 not 0, as in bonds that lean to one
    /// side, and where nothing holds the wall together along an axis.
    pub fn constants(&self) -> Option<Constants> {
        let [[a11, a12, a16], [_, a22, a26], [_, _, a66]] = self.membrane;
        let most = a11.max(a22).max(a66);
        let t = self.thickness;
        let whole = [a11, a22, a66].iter().all(|a| *a > ROUNDING * most);
        let apart = a16.abs().max(a26.abs()) <= ROUNDING * most;
        (whole && apart).then(|| Constants {
            e1: (a11 - a12 * a12 / a22) / t,
            e2: (a22 - a12 * a12 / a11) / t,
            nu12: if a12.abs() <= ROUNDING * most { 0.0 } else { a12 / a22 },
            g12: a66 / t,
            g13: self.shear[0][0] / t,
            g23: self.shear[1][1] / t,
        })
    }

    /// Apparent E1, E2 [Pa], ν12 and G12 [Pa] of single stresses, whatever is coupled; none where nothing holds the wall together
    /// along an axis.
    pub fn apparent(&self) -> Option<[f64; 4]> {
        let f = inverse(&self.membrane)?;
        let t = self.thickness;
        Some([1.0 / (t * f[0][0]), 1.0 / (t * f[1][1]), -f[0][1] / f[0][0], 1.0 / (t * f[2][2])])
    }

    /// Bricks that deform: flexibilities of joints and bricks added up, in the plane and out of it. An estimate, which bricks of
    /// `modulus` E_b in Pa, above 0, and Poisson's ratio `nu`, −1 to ½, would have if both bore the same stress everywhere.
    ///
    /// # Errors
    /// A matrix without inverse, where nothing holds the wall together along an axis; numbers outside of their bounds.
    pub fn in_series(&self, modulus: f64, nu: f64) -> Result<Moduli, ContinuumError> {
        if !(modulus > 0.0 && modulus.is_finite() && nu > -1.0 && nu <= 0.5) {
            let what = format!("bricks of E {modulus} Pa and ν {nu}");
            return Err(concio::InputError::new(what).allowed("E above 0, ν above −1 to 0.5").into());
        }
        let t = self.thickness;
        let shear = 0.5 * modulus / (1.0 + nu);
        let brick = |depth: f64| -> [[f64; 3]; 3] {
            let f = 1.0 / (modulus * depth);
            [[f, -nu * f, 0.0], [-nu * f, f, 0.0], [0.0, 0.0, 1.0 / (shear * depth)]]
        };
        let added = |m: &[[f64; 3]; 3], depth: f64| {
            let joints = inverse(m).ok_or(ContinuumError::FallsApart)?;
            let brick = brick(depth);
            let sum = std::array::from_fn(|i| std::array::from_fn(|j| joints[i][j] + brick[i][j]));
            inverse(&sum).ok_or(ContinuumError::FallsApart)
        };
        // 5/6: shear stress over a brick is parabolic.
        let upright = |f: f64| 1.0 / (1.0 / f + 1.2 / (shear * t));
        let mut series = *self;
        series.membrane = added(&self.membrane, t)?;
        series.plate = added(&self.plate, t.powi(3) / 12.0)?;
        series.shear = [[upright(self.shear[0][0]), 0.0], [0.0, upright(self.shear[1][1])]];
        Ok(series)
    }
}

/// F: what the deflection's slope meets while the mean rotations are held.
fn held_upright(bent: &crate::springs::Condensed) -> [[f64; 2]; 2] {
    let y = &bent.yielding;
    let det = y[0][0] * y[1][1] - y[0][1] * y[1][0];
    let stiff = [[y[1][1] / det, -y[0][1] / det], [-y[1][0] / det, y[0][0] / det]];
    let m = |k: usize, i: usize| bent.means[k][3 + i];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let mut f = 0.5 * (bent.energy[3 + i][3 + j] + bent.energy[3 + j][3 + i]);
            for k in 0..2 {
                for l in 0..2 {
                    f += m(k, i) * stiff[k][l] * m(l, j);
                }
            }
            f
        })
    })
}

/// Energy of the rotations that neighbours have against each other under a gradient.
fn couple(cell: &Cell) -> Couple {
    let of = |axis: usize| {
        let joint = |c: &crate::Contact| c.stiffness.normal * c.length.powi(3) / 12.0 * c.apart[axis].powi(2);
        cell.thickness * cell.contacts.iter().map(joint).sum::<f64>() / cell.area
    };
    Couple { c1: of(0), c2: of(1) }
}

/// Inverse of a symmetric positive matrix; none where it is not.
pub(crate) fn inverse(m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let minor = |i: usize, j: usize| {
        let (r, c): (Vec<usize>, Vec<usize>) =
            ((0..3).filter(|k| *k != i).collect(), (0..3).filter(|k| *k != j).collect());
        m[r[0]][c[0]] * m[r[1]][c[1]] - m[r[0]][c[1]] * m[r[1]][c[0]]
    };
    let sign = |i: usize, j: usize| if (i + j).is_multiple_of(2) { 1.0 } else { -1.0 };
    let det: f64 = (0..3).map(|j| sign(0, j) * m[0][j] * minor(0, j)).sum();
    let size: f64 = (0..3).map(|i| m[i][i]).product();
    (det > 1e-12 * size && size > 0.0)
        .then(|| std::array::from_fn(|i| std::array::from_fn(|j| sign(i, j) * minor(j, i) / det)))
}
