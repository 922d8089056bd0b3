//! Periodic cells of a bond: bricks, and the joints between them and their images.

use concio::{InputError, Result};

use crate::joint::{Contact, Stiffness};

/// Overlaps shorter than this part of the longest brick come from rounding.
const TOUCHING: f64 = 1e-9;

/// A brick of a cell: left, right, bottom and top edge [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellBrick {
    /// Left and right edge [m].
    pub x: [f64; 2],
    /// Bottom and top edge [m].
    pub y: [f64; 2],
}

impl CellBrick {
    /// Centre [m].
    pub fn centre(&self) -> [f64; 2] {
        [0.5 * (self.x[0] + self.x[1]), 0.5 * (self.y[0] + self.y[1])]
    }
}

/// A course of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellCourse {
    /// Height of its bricks, without mortar, above 0 [m].
    pub height: f64,
    /// Lengths of its bricks from the left, without mortar, each above 0 [m].
    pub bricks: Vec<f64>,
    /// Place of the left edge of the first of them, of either sign [m].
    pub offset: f64,
}

/// Joints and mortar of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Laying {
    /// Thickness of the wall, above 0 [m].
    pub thickness: f64,
    /// Mortar in bed and head joints, from 0 [m].
    pub mortar: [f64; 2],
    /// Stiffness of bed joints.
    pub bed: Stiffness,
    /// Stiffness of head joints.
    pub head: Stiffness,
}

/// A periodic cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Its bricks.
    pub bricks: Vec<CellBrick>,
    /// Its joints, each once.
    pub contacts: Vec<Contact>,
    /// Area that repeats, mortar included [m²].
    pub area: f64,
    /// Thickness of the wall [m].
    pub thickness: f64,
}

impl Cell {
    /// Bricks of `length` × `height` [m] in courses that are shifted by `overlap` pitches each, from 0 (stack bond) to below 1;
    /// ½ is running bond. One brick in the cell.
    ///
    /// # Errors
    /// Sizes that are not above 0, an overlap outside of 0 … 1.
    pub fn shifted(length: f64, height: f64, overlap: f64, laying: &Laying) -> Result<Cell> {
        if !(0.0..1.0).contains(&overlap) {
            return Err(InputError::new(format!("an overlap of {overlap}")).allowed("0 to below 1").into());
        }
        let course = CellCourse { height, bricks: vec![length], offset: 0.0 };
        Cell::of_courses(&[course], overlap * (length + laying.mortar[1]), laying)
    }

    /// Courses from the bottom that repeat along the wall, all over the same width, and upwards, each time `lean` further to the
    /// right [m].
    ///
    /// # Errors
    /// Sizes that are not above 0, courses of different widths.
    pub fn of_courses(courses: &[CellCourse], lean: f64, laying: &Laying) -> Result<Cell> {
        let width = check(courses, laying)?;
        let [bed, head] = laying.mortar;
        let mut bricks = Vec::new();
        let mut rows = Vec::new();
        let mut y = 0.0;
        for course in courses {
            let (first, mut x) = (bricks.len(), course.offset);
            for length in &course.bricks {
                bricks.push(CellBrick { x: [x, x + length], y: [y, y + course.height] });
                x += length + head;
            }
            rows.push(first..bricks.len());
            y += course.height + bed;
        }
        let rounding = TOUCHING * courses.iter().flat_map(|c| &c.bricks).fold(0.0, |most: f64, l| most.max(*l));
        let mut contacts = Vec::new();
        for (r, row) in rows.iter().enumerate() {
            for i in row.clone() {
                let last = i + 1 == row.end;
                let j = if last { row.start } else { i + 1 };
                let shift = [if last { width } else { 0.0 }, 0.0];
                let ([_, right], y) = (bricks[i].x, bricks[i].y);
                let at = [right + 0.5 * head, 0.5 * (y[0] + y[1])];
                contacts.push(contact(&bricks, [i, j], shift, at, [1.0, 0.0], y[1] - y[0], laying.head));
            }
            let last = r + 1 == rows.len();
            let above = if last { rows[0].clone() } else { rows[r + 1].clone() };
            let up = if last { [lean, y] } else { [0.0, 0.0] };
            for i in row.clone() {
                for j in above.clone() {
                    let (low, high) = (bricks[i], bricks[j]);
                    // Images of the upper brick that may reach over the lower.
                    let from = ((low.x[0] - high.x[1] - up[0]) / width).floor() as i64;
                    let to = ((low.x[1] - high.x[0] - up[0]) / width).ceil() as i64;
                    for k in from..=to {
                        let shift = [up[0] + k as f64 * width, up[1]];
                        let x = [low.x[0].max(high.x[0] + shift[0]), low.x[1].min(high.x[1] + shift[0])];
                        if x[1] - x[0] > rounding {
                            let at = [0.5 * (x[0] + x[1]), low.y[1] + 0.5 * bed];
                            contacts.push(contact(&bricks, [i, j], shift, at, [0.0, 1.0], x[1] - x[0], laying.bed));
                        }
                    }
                }
            }
        }
        Ok(Cell { bricks, contacts, area: width * y, thickness: laying.thickness })
    }

    /// Area of the bricks over that of the cell, 0 … 1.
    pub fn brick_share(&self) -> f64 {
        self.bricks.iter().map(|b| (b.x[1] - b.x[0]) * (b.y[1] - b.y[0])).sum::<f64>() / self.area
    }
}

fn contact(
    bricks: &[CellBrick],
    [a, b]: [usize; 2],
    shift: [f64; 2],
    at: [f64; 2],
    normal: [f64; 2],
    length: f64,
    stiffness: Stiffness,
) -> Contact {
    let (from, to) = (bricks[a].centre(), bricks[b].centre());
    let apart = [0, 1].map(|k| to[k] + shift[k] - from[k]);
    Contact { a, b, apart, middle: [0, 1].map(|k| at[k] - from[k]), normal, length, stiffness }
}

/// The width of all courses, mortar included.
fn check(courses: &[CellCourse], laying: &Laying) -> Result<f64> {
    let wrong = |what: String, allowed: &str| InputError::new(what).allowed(allowed);
    let sizes = courses.iter().flat_map(|c| c.bricks.iter().copied().chain([c.height]));
    for size in sizes.chain([laying.thickness]) {
        if !(size > 0.0 && size.is_finite()) {
            return Err(wrong(format!("a size of {size} m"), "above 0").into());
        }
    }
    for mortar in laying.mortar {
        if !(mortar >= 0.0 && mortar.is_finite()) {
            return Err(wrong(format!("mortar of {mortar} m"), "from 0").into());
        }
    }
    let of = |c: &CellCourse| c.bricks.iter().map(|l| l + laying.mortar[1]).sum::<f64>();
    let widths: Vec<f64> = courses.iter().map(of).collect();
    let (least, most) = widths.iter().fold((f64::INFINITY, 0.0), |(a, b), w| (w.min(a), w.max(b)));
    if courses.is_empty() || courses.iter().any(|c| c.bricks.is_empty()) {
        return Err(wrong("a cell without bricks".into(), "a course or more, each with a brick or more").into());
    }
    if most - least > 1e-9 * most {
        let what = format!("courses of a cell are {least} m to {most} m wide, mortar included");
        return Err(wrong(what, "one width: the cell repeats along the wall").into());
    }
    Ok(most)
}
