//! Textures of boxes: a façade with side walls or a corner, and two leaves with headers.
//!
//! x runs inwards from the outer face, y along the wall, z upwards from the base. Blocks are twice as long as the wall is
//! thick, so that a course that starts a thickness later breaks all joints of the one below.

use super::assembly::{Cuboid, TextureError};

/// A façade along y with none, one or two side walls behind it.
///
/// In even courses, from 0 at the base, whole blocks run through the façade and side walls start behind it; in odd ones side
/// walls run through. With one side wall it is a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facade {
    /// Thickness of all walls [m]; blocks are twice as long.
    pub thickness: f64,
    /// Height of a course [m].
    pub course: f64,
    /// Number of courses, from 1.
    pub courses: usize,
    /// Length of the façade [m], over the side walls: more than twice the thickness.
    pub length: f64,
    /// Whether there is a side wall at y = 0 and at the other end.
    pub sides: [bool; 2],
    /// Where the side walls are cut off [m], from the outer face: more than twice the thickness.
    pub depth: f64,
    /// γ [N/m³].
    pub specific_weight: f64,
}

/// Two leaves of stretchers, and courses of headers that reach through both.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaves {
    /// Thickness of a leaf [m]; stretchers are twice as long, headers as wide.
    pub thickness: f64,
    /// Height of a course [m].
    pub course: f64,
    /// Number of courses, from 1.
    pub courses: usize,
    /// Length of the wall [m], at least twice the thickness.
    pub length: f64,
    /// Courses of headers, from 1 at the base.
    pub headers: Vec<usize>,
    /// γ [N/m³].
    pub specific_weight: f64,
}

/// Pieces shorter than this part of a block come from rounding.
const SLIVER: f64 = 1e-6;

/// Ends of the blocks of a row; the last is cut off.
pub(super) fn row(from: f64, to: f64, first: f64, block: f64) -> Vec<[f64; 2]> {
    let mut blocks = Vec::new();
    let (mut at, mut size) = (from, first);
    while to - at > SLIVER * block {
        let end = if at + size > to - SLIVER * block { to } else { at + size };
        blocks.push([at, end]);
        (at, size) = (end, block);
    }
    blocks
}

fn above_zero(values: &[(f64, &'static str)]) -> Result<(), TextureError> {
    let wrong = values.iter().find(|(v, _)| !(v.is_finite() && *v > 0.0));
    wrong.map_or(Ok(()), |(_, what)| Err(TextureError::Range(what, "above 0")))
}

/// Most blocks of a texture.
const MOST: f64 = 1e5;

impl Facade {
    /// Its blocks, course by course: façade from y = 0, then the side walls.
    ///
    /// # Errors
    /// Sizes out of their range.
    pub fn blocks(&self) -> Result<Vec<Cuboid>, TextureError> {
        let Facade { thickness: t, course, courses, length, sides, depth, specific_weight } = *self;
        above_zero(&[
            (t, "thickness"),
            (course, "course"),
            (courses as f64, "courses"),
            (length, "length"),
            (specific_weight, "specific_weight"),
        ])?;
        if !(length > 2.0 * t) {
            return Err(TextureError::Range("length", "more than twice the thickness"));
        }
        if sides.contains(&true) && !(depth > 2.0 * t && depth.is_finite()) {
            return Err(TextureError::Range("depth", "more than twice the thickness"));
        }
        if (length + 2.0 * depth) / (2.0 * t) * courses as f64 > MOST {
            return Err(TextureError::Range("number of blocks", "up to 100,000"));
        }
        let mut blocks = Vec::new();
        for c in 0..courses {
            let z = [c as f64 * course, (c + 1) as f64 * course];
            let mut add = |name: String, x: [f64; 2], y: [f64; 2]| {
                blocks.push(Cuboid { name, edges: [x, y, z], specific_weight });
            };
            let odd = c % 2 == 1;
            let from = if odd && sides[0] { t } else { 0.0 };
            let to = if odd && sides[1] { length - t } else { length };
            let first = if odd && !sides[0] { t } else { 2.0 * t };
            for (k, y) in row(from, to, first, 2.0 * t).into_iter().enumerate() {
                add(format!("f{}b{}", c + 1, k + 1), [0.0, t], y);
            }
            let start = if odd { 0.0 } else { t };
            let places = [(sides[0], "l", [0.0, t]), (sides[1], "r", [length - t, length])];
            for (_, side, y) in places.into_iter().filter(|p| p.0) {
                for (k, x) in row(start, depth, 2.0 * t, 2.0 * t).into_iter().enumerate() {
                    add(format!("{side}{}b{}", c + 1, k + 1), x, y);
                }
            }
        }
        Ok(blocks)
    }
}

impl Leaves {
    /// Its blocks, course by course: the outer leaf from y = 0, then the inner one.
    ///
    /// # Errors
    /// Sizes out of their range, courses of headers that there are not.
    pub fn blocks(&self) -> Result<Vec<Cuboid>, TextureError> {
        let Leaves { thickness: t, course, courses, length, ref headers, specific_weight } = *self;
        above_zero(&[
            (t, "thickness"),
            (course, "course"),
            (courses as f64, "courses"),
            (length, "length"),
            (specific_weight, "specific_weight"),
        ])?;
        if !(length >= 2.0 * t) {
            return Err(TextureError::Range("length", "at least twice the thickness"));
        }
        if length / t * courses as f64 * 2.0 > MOST {
            return Err(TextureError::Range("number of blocks", "up to 100,000"));
        }
        if headers.iter().any(|c| *c < 1 || *c > courses) {
            return Err(TextureError::Range("headers", "courses from 1 to their number"));
        }
        let mut blocks = Vec::new();
        for c in 0..courses {
            let z = [c as f64 * course, (c + 1) as f64 * course];
            let mut add = |name: String, x: [f64; 2], y: [f64; 2]| {
                blocks.push(Cuboid { name, edges: [x, y, z], specific_weight });
            };
            if headers.contains(&(c + 1)) {
                for (k, y) in row(0.0, length, t, t).into_iter().enumerate() {
                    add(format!("h{}b{}", c + 1, k + 1), [0.0, 2.0 * t], y);
                }
                continue;
            }
            let first = if c % 2 == 1 { t } else { 2.0 * t };
            for (leaf, x) in [("o", [0.0, t]), ("i", [t, 2.0 * t])] {
                for (k, y) in row(0.0, length, first, 2.0 * t).into_iter().enumerate() {
                    add(format!("{leaf}{}b{}", c + 1, k + 1), x, y);
                }
            }
        }
        Ok(blocks)
    }
}
