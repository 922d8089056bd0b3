//! Walls as they are, brick by brick: stiffness of panels, and how far a few courses are from many.

use concio::wall::{End, Joint, JointKind, Wall};

use crate::ContinuumError;
use crate::cell::Cell;
use crate::joint::{Contact, Stiffness};
use crate::moduli::Moduli;
use crate::springs::{Matrix, Spring, UNKNOWNS};

/// Relative error of A1212 in a wall of so many courses without sides, from 1: G_N/A1212 − 1 with G_N = K H/L of bricks between
/// a rigid base and a level beam that moves along the courses; first order in 1/N. Bonds with one brick in the cell.
///
/// # Errors
/// A cell of several bricks, no courses, a system that was not solved.
pub fn scale(cell: &Cell, courses: usize) -> Result<f64, ContinuumError> {
    if cell.bricks.len() != 1 || courses == 0 {
        let what = format!("{} bricks in a cell, {courses} courses", cell.bricks.len());
        return Err(concio::InputError::new(what).allowed("one brick, one course or more").into());
    }
    let (level, upright): (Vec<&Contact>, Vec<&Contact>) = cell.contacts.iter().partition(|c| c.normal[1] > 0.5);
    let Some(bed) = level.first() else { return Err(ContinuumError::FallsApart) };
    let rise = bed.apart[1];
    let length = cell.bricks[0].x[1] - cell.bricks[0].x[0];
    let width = cell.area / rise;
    let [base, beam] = [courses, courses + 1];
    let mut contacts = Vec::new();
    for r in 0..courses {
        contacts.extend(upright.iter().map(|c| Contact { a: r, b: r, ..(*c).clone() }));
        if r + 1 < courses {
            contacts.extend(level.iter().map(|c| Contact { a: r, b: r + 1, ..(*c).clone() }));
        }
    }
    let support = |a: usize, b: usize, up: f64| Contact {
        a,
        b,
        apart: [0.0, up * rise],
        middle: [0.0, 0.5 * up * rise],
        normal: [0.0, up],
        length,
        stiffness: bed.stiffness,
    };
    contacts.extend([support(0, base, -1.0), support(courses - 1, beam, 1.0)]);
    let force = pushed(&contacts, cell.thickness, base, beam)?;
    let height = courses as f64 * rise;
    Ok(force * height / width / Moduli::of_cell(cell)?.membrane[2][2] - 1.0)
}

/// Horizontal stiffness of a wall on its base under a beam that stays level and neither rises nor falls, all joints intact [N/m].
/// `stiffness` has that of every joint.
///
/// # Errors
/// A wall without a beam, a system that was not solved.
pub fn panel_stiffness(wall: &Wall, joints: &[Joint], stiffness: &[Stiffness]) -> Result<f64, ContinuumError> {
    if !joints.iter().any(|j| j.kind == JointKind::Top) {
        let error = concio::InputError::new("a wall without a beam has nothing to be pushed by");
        return Err(error.key("load.beam").allowed("a beam").into());
    }
    let (base, beam) = (wall.blocks.len(), wall.blocks.len() + 1);
    let contacts: Vec<Contact> = joints.iter().zip(stiffness).map(|(j, k)| contact(wall, j, *k)).collect();
    let thickness = wall.blocks.iter().map(|b| b.thickness).fold(f64::INFINITY, f64::min);
    // Joints between blocks of several thicknesses have that of the thinner.
    let thick: Vec<f64> = joints.iter().map(|j| j.area(wall) / j.overlap).collect();
    let scaled: Vec<Contact> = contacts.into_iter().zip(thick).map(|(c, t)| with_thickness(c, t / thickness)).collect();
    pushed(&scaled, thickness, base, beam)
}

fn with_thickness(contact: Contact, factor: f64) -> Contact {
    let Stiffness { normal, tangential, transverse } = contact.stiffness;
    let stiffness =
        Stiffness { normal: factor * normal, tangential: factor * tangential, transverse: factor * transverse };
    Contact { stiffness, ..contact }
}

/// Force on the last body over its displacement along the courses, the body `base` at rest; both neither rise nor turn.
fn pushed(contacts: &[Contact], thickness: f64, base: usize, beam: usize) -> Result<f64, ContinuumError> {
    let springs: Vec<Spring> = contacts.iter().flat_map(|c| c.in_plane(thickness)).collect();
    let unknowns = UNKNOWNS * (beam + 1);
    let mut prescribed = vec![None; unknowns];
    (0..UNKNOWNS).for_each(|k| prescribed[UNKNOWNS * base + k] = Some(vec![0.0]));
    (0..UNKNOWNS).for_each(|k| prescribed[UNKNOWNS * beam + k] = Some(vec![if k == 0 { 1.0 } else { 0.0 }]));
    let x = Matrix::of(&springs).solve(unknowns, &[vec![0.0; unknowns]], &prescribed)?;
    Ok(springs.iter().map(|s| s.stiffness * s.jump(&x[0]).powi(2)).sum())
}

/// A joint of a wall as a contact; base and beam have the numbers after the last block.
pub(crate) fn contact(wall: &Wall, joint: &Joint, stiffness: Stiffness) -> Contact {
    let centre = wall.blocks[joint.a].centre();
    let [x0, y0, x1, y1] = joint.line;
    let mut at = [0.5 * (x0 + x1), 0.5 * (y0 + y1)];
    let along = [(x1 - x0) / joint.overlap, (y1 - y0) / joint.overlap];
    let n = wall.blocks.len();
    let (b, other, normal) = match joint.b {
        // Blocks reach through their mortar to the base.
        End::Base => {
            at[1] = 0.0;
            (n, at, [0.0, -1.0])
        }
        End::Top => (n + 1, at, [0.0, 1.0]),
        End::Block(b) if joint.kind.is_upright() => (b, wall.blocks[b].centre(), [along[1], -along[0]]),
        End::Block(b) => (b, wall.blocks[b].centre(), [-along[1], along[0]]),
    };
    Contact {
        a: joint.a,
        b,
        apart: [0, 1].map(|k| other[k] - centre[k]),
        middle: [0, 1].map(|k| at[k] - centre[k]),
        normal,
        length: joint.overlap,
        stiffness,
    }
}
