//! Walls without a cell: moduli of a window of the wall from three static tests.
//!
//! The centres of the bricks along the border of the window are moved by a uniform strain, one test for each of its three numbers;
//! all bricks turn as they like. Over the bricks inside, whose neighbours all lie in the window, the mean stress is what their
//! joints bear times where they are, the mean strain that of a linear field through their centres. A is one over the other.
//!
//! This is no closed form: it depends on the window, and windows differ. Three give a mean and a scatter. Compare F. Cluni and
//! V. Gusella, International Journal of Solids and Structures 41 (2004) 1911.

use concio::wall::{End, Joint, Wall};

use crate::ContinuumError;
use crate::joint::{Contact, Stiffness};
use crate::moduli::inverse;
use crate::panel::contact;
use crate::springs::{Matrix, Spring, UNKNOWNS};

/// Least number of bricks inside of a window.
const LEAST: usize = 6;
/// Brick lengths that a third of a panel has at least, or windows overlap.
const WIDE: f64 = 6.0;

/// A part of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Left and right side [m].
    pub x: [f64; 2],
    /// Indices of its blocks: those whose centre lies between the sides.
    pub blocks: Vec<usize>,
}

/// What a window tells.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WindowModuli {
    /// A [N/m], made symmetric.
    pub membrane: [[f64; 3]; 3],
    /// By how much it was not: largest difference over the largest modulus.
    pub skew: f64,
    /// Bricks inside, over which means are taken.
    pub inside: usize,
}

/// Three windows of a panel, all of its height: thirds of its width, or halves that overlap where it is short; and whether they
/// do.
pub fn windows(wall: &Wall, panel: usize) -> ([Window; 3], bool) {
    let of_panel = || wall.blocks.iter().enumerate().filter(move |(_, b)| b.panel == panel);
    let [left, right] =
        of_panel().fold([f64::INFINITY, f64::NEG_INFINITY], |e, (_, b)| [e[0].min(b.x[0]), e[1].max(b.x[1])]);
    let mean = of_panel().map(|(_, b)| b.length()).sum::<f64>() / of_panel().count().max(1) as f64;
    let width = right - left;
    let overlap = width / 3.0 < WIDE * mean;
    let part = if overlap { 0.5 } else { 1.0 / 3.0 };
    let window = |k: usize| {
        let from = left + 0.5 * k as f64 * (1.0 - part) * width;
        let x = [from, from + part * width];
        let inside = |b: &concio::wall::Block| (x[0]..=x[1]).contains(&b.centre()[0]);
        Window { x, blocks: of_panel().filter(|(_, b)| inside(b)).map(|(i, _)| i).collect() }
    };
    ([window(0), window(1), window(2)], overlap)
}

/// Moduli of a window; `stiffness` has that of every joint of the wall.
///
/// # Errors
/// A window with too few bricks inside, a system that was not solved.
pub fn window(
    wall: &Wall,
    joints: &[Joint],
    stiffness: &[Stiffness],
    window: &Window,
) -> Result<WindowModuli, ContinuumError> {
    let mut local = vec![usize::MAX; wall.blocks.len()];
    window.blocks.iter().enumerate().for_each(|(k, b)| local[*b] = k);
    let n = window.blocks.len();
    // Sides of every block at which there is a neighbour in the window: left, right, below, above.
    let mut sides = vec![[false; 4]; n];
    let mut contacts: Vec<Contact> = Vec::new();
    for (joint, k) in joints.iter().zip(stiffness) {
        let End::Block(other) = joint.b else { continue };
        let (a, b) = (local[joint.a], local[other]);
        if a == usize::MAX || b == usize::MAX {
            continue;
        }
        let own = Contact { a, b, ..contact(wall, joint, *k) };
        let axis = if own.normal[0].abs() > own.normal[1].abs() { 0 } else { 1 };
        let forwards = own.normal[axis] > 0.0;
        sides[a][2 * axis + usize::from(forwards)] = true;
        sides[b][2 * axis + usize::from(!forwards)] = true;
        contacts.push(own);
    }
    let inside: Vec<bool> = sides.iter().map(|s| s.iter().all(|side| *side)).collect();
    let number = inside.iter().filter(|i| **i).count();
    if number < LEAST {
        let what = format!(
            "a window from {:.3} m to {:.3} m has {number} bricks with neighbours on all sides",
            window.x[0], window.x[1]
        );
        let error = concio::InputError::new(what).allowed(format!("{LEAST} or more"));
        return Err(error.help("a panel with more courses and bricks").into());
    }
    let centres: Vec<[f64; 2]> = window.blocks.iter().map(|b| wall.blocks[*b].centre()).collect();
    let thickness = wall.blocks[window.blocks[0]].thickness;
    let springs: Vec<Vec<Spring>> = contacts.iter().map(|c| c.in_plane(thickness)).collect();
    let mut prescribed: Vec<Option<Vec<f64>>> = vec![None; UNKNOWNS * n];
    for (k, c) in centres.iter().enumerate().filter(|(k, _)| !inside[*k]) {
        prescribed[UNKNOWNS * k] = Some(vec![c[0], 0.0, 0.5 * c[1]]);
        prescribed[UNKNOWNS * k + 1] = Some(vec![0.0, c[1], 0.5 * c[0]]);
    }
    let all: Vec<Spring> = springs.iter().flatten().cloned().collect();
    let right = vec![vec![0.0; UNKNOWNS * n]; 3];
    let found = Matrix::of(&all).solve(UNKNOWNS * n, &right, &prescribed)?;
    let areas: Vec<f64> = window.blocks.iter().map(|b| pitch_area(wall, *b)).collect();
    let total: f64 = (0..n).filter(|k| inside[*k]).map(|k| areas[k]).sum();
    let mut stress = [[0.0; 3]; 3];
    let mut strain = [[0.0; 3]; 3];
    for (test, x) in found.iter().enumerate() {
        for (own, springs) in contacts.iter().zip(&springs) {
            let mut force = [0.0; 2];
            for s in springs {
                let f = s.stiffness * s.jump(x);
                force[0] += f * s.rows[1][0];
                force[1] += f * s.rows[1][1];
            }
            let from_b = [0, 1].map(|k| own.middle[k] - own.apart[k]);
            for (brick, sign, r) in [(own.a, 1.0, own.middle), (own.b, -1.0, from_b)] {
                if inside[brick] {
                    let f = force.map(|f| sign * f / total);
                    stress[0][test] += f[0] * r[0];
                    stress[1][test] += f[1] * r[1];
                    stress[2][test] += 0.5 * (f[0] * r[1] + f[1] * r[0]);
                }
            }
        }
        let chosen: Vec<(usize, [f64; 2])> =
            (0..n).filter(|k| inside[*k]).map(|k| (k, [x[UNKNOWNS * k], x[UNKNOWNS * k + 1]])).collect();
        let gradient = gradient(&chosen, &centres).ok_or(ContinuumError::FallsApart)?;
        strain[0][test] = gradient[0][0];
        strain[1][test] = gradient[1][1];
        strain[2][test] = gradient[0][1] + gradient[1][0];
    }
    let back = inverse_of(&strain).ok_or(ContinuumError::FallsApart)?;
    let a: [[f64; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| stress[i][k] * back[k][j]).sum()));
    let most = a.iter().flatten().fold(0.0, |most: f64, v| most.max(v.abs()));
    let pairs = [(0, 1), (0, 2), (1, 2)];
    let skew = pairs.iter().map(|(i, j)| (a[*i][*j] - a[*j][*i]).abs()).fold(0.0, f64::max) / most;
    let membrane: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (a[i][j] + a[j][i])));
    // Also a check that it is positive.
    inverse(&membrane).ok_or(ContinuumError::FallsApart)?;
    Ok(WindowModuli { membrane, skew, inside: number })
}

/// Area of a block with half of the mortar around it [m²].
pub(crate) fn pitch_area(wall: &Wall, block: usize) -> f64 {
    let block = &wall.blocks[block];
    let [bed, head] = wall.panels[block.panel].mortar;
    match block.is_rectangle() {
        true => (block.length() + head) * (block.height() + bed),
        false => block.area(),
    }
}

/// A brick and its displacement [m].
type Moved = (usize, [f64; 2]);

/// Slopes of the linear field that comes nearest to displacements at some centres.
fn gradient(moved: &[Moved], centres: &[[f64; 2]]) -> Option<[[f64; 2]; 2]> {
    let n = moved.len() as f64;
    let mean = |of: &dyn Fn(&Moved) -> f64| moved.iter().map(of).sum::<f64>() / n;
    let middle = [0, 1].map(|k| mean(&|m| centres[m.0][k]));
    let [xx, xy, yy] =
        [[0, 0], [0, 1], [1, 1]].map(|[i, j]| mean(&|m| (centres[m.0][i] - middle[i]) * (centres[m.0][j] - middle[j])));
    let det = xx * yy - xy * xy;
    let slopes = |k: usize| {
        let [ux, uy] = [0, 1].map(|i| mean(&|m| m.1[k] * (centres[m.0][i] - middle[i])));
        [(yy * ux - xy * uy) / det, (xx * uy - xy * ux) / det]
    };
    (det > 1e-12 * (xx * yy).max(f64::MIN_POSITIVE)).then(|| [slopes(0), slopes(1)])
}

/// Inverse of a matrix that need not be symmetric; none where it has none.
fn inverse_of(m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let cofactor = |i: usize, j: usize| {
        let (r, s, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    let det: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    (det.abs() > 1e-9).then(|| std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / det)))
}
