//! Doors and windows: which blocks go, which are cut, and the lintels.
//!
//! Bottom and top of an opening and the top of its lintel lie on bed joints, so that blocks are cut upright alone and stay
//! rectangles. A bed joint reaches from the tops of one course to the bottoms of the next.

use super::place::{Frame, Place};
use super::{Courses, Found, Rect};
use crate::InputError;
use crate::case::Panel;
use crate::case::validate::tidy;

/// Shortest rest of a cut block, as a part of the brick's length.
const SLIVER: f64 = 0.02;

/// Cuts the openings of a panel out of its courses, unless `found` grows: by openings beyond the panel, over each other or off
/// the bed joints; cuts that leave a sliver; lintels without bearing. Where they lie.
pub(super) fn cut(panel: &Panel, index: usize, courses: &mut Courses, found: &mut Found) -> Vec<Place> {
    if panel.openings.is_empty() {
        return Vec::new();
    }
    let before = found.number();
    let frame = Frame::new(panel, index, courses);
    let holes = placed(panel, &frame, found);
    if found.number() > before {
        return Vec::new();
    }
    let key = |k: usize| format!("panel[{index}].opening[{k}]");
    for (k, hole) in holes.iter().enumerate() {
        for (zone, rows) in zones(hole, frame.head) {
            for r in rows {
                courses[r] = frame.cleared(&courses[r], r, zone, &mut |e| found.add(e.key(key(k))));
            }
        }
    }
    for (zone, rows) in holes.iter().filter_map(|hole| over(hole, frame.head)) {
        rows.for_each(|r| frame.reach(&mut courses[r], zone));
    }
    for (k, hole) in holes.iter().enumerate() {
        let Some(lintel) = &hole.lintel else { continue };
        let place = courses[lintel.top - 1].partition_point(|b| b.x[0] < lintel.x[0]);
        let rect = Rect { x: lintel.x, y: lintel.y, source: k, lintel: lintel.top - hole.beds[1] };
        courses[lintel.top - 1].insert(place, rect);
    }
    for (k, hole) in holes.iter().enumerate() {
        frame.bears(hole, courses, &mut |e| found.add(e.key(key(k)).allowed("a block below it on either side")));
        frame.left_over(hole, &holes, courses, &mut |e| found.add(e.key(key(k))));
    }
    for course in courses {
        course.iter_mut().filter(|b| b.lintel == 0).enumerate().for_each(|(place, block)| block.source = place);
    }
    holes
}

/// Where all openings lie, none over another.
fn placed(panel: &Panel, frame: &Frame, found: &mut Found) -> Vec<Place> {
    let mut holes: Vec<(usize, Place)> = Vec::with_capacity(panel.openings.len());
    for (k, opening) in panel.openings.iter().enumerate() {
        let key = |below: &str| format!("panel[{}].opening[{k}]{below}", frame.index);
        match frame.place(opening) {
            Err(faults) => faults.into_iter().for_each(|(below, e)| found.add(e.key(key(below)))),
            Ok(hole) => {
                for (other, _) in holes.iter().filter(|(_, h)| meet(h, &hole, frame.tolerance)) {
                    let what = format!("the opening or its lintel lies over opening[{other}] or its lintel");
                    found.add(InputError::new(what).key(key("")).allowed("openings and lintels beside each other"));
                }
                holes.push((k, hole));
            }
        }
    }
    holes.into_iter().map(|(_, hole)| hole).collect()
}

/// From left to right [m], and in which courses.
type Zone = ([f64; 2], std::ops::Range<usize>);

/// What is cleared of blocks, and in which courses; a lintel has head joints of `mortar`.
fn zones(hole: &Place, mortar: f64) -> impl Iterator<Item = Zone> {
    std::iter::once((hole.x, hole.beds[0]..hole.beds[1])).chain(over(hole, mortar))
}

/// That of the lintel.
fn over(hole: &Place, mortar: f64) -> Option<Zone> {
    let lintel = hole.lintel.as_ref()?;
    Some(([lintel.x[0] - mortar, lintel.x[1] + mortar], hole.beds[1]..lintel.top))
}

/// Whether two openings or their lintels lie over each other.
fn meet(a: &Place, b: &Place, tolerance: f64) -> bool {
    let parts = |h: &Place| [Some((h.x, h.y)), h.lintel.as_ref().map(|l| (l.x, l.y))];
    let common = |a: [f64; 2], b: [f64; 2]| a[1].min(b[1]) - a[0].max(b[0]) > tolerance;
    let theirs = parts(b);
    let meets = |(x, y): ([f64; 2], [f64; 2])| {
        theirs.iter().flatten().any(|(other_x, other_y)| common(x, *other_x) && common(y, *other_y))
    };
    parts(a).into_iter().flatten().any(meets)
}

impl Frame {
    /// A course without what lies in `zone`.
    fn cleared(&self, course: &[Rect], r: usize, zone: [f64; 2], wrong: &mut dyn FnMut(InputError)) -> Vec<Rect> {
        let mut rest = Vec::with_capacity(course.len() + 1);
        for block in course {
            let [x0, x1] = block.x;
            if !self.is_in(block, zone) {
                rest.push(*block);
                continue;
            }
            for x in [[x0, zone[0]], [zone[1], x1]] {
                let length = x[1] - x[0];
                if length <= self.head + self.tolerance {
                    continue;
                }
                if length < SLIVER * self.length {
                    // Earlier openings have changed the numbers of what follows them: the place says which one it is.
                    let course = r + 1;
                    let what = format!(
                        "the cut leaves {} m of the block from x = {} to {} m in course {course} of panel p{}",
                        tidy(length),
                        tidy(x0),
                        tidy(x1),
                        self.index + 1
                    );
                    let least = tidy(SLIVER * self.length);
                    let none = tidy(self.head);
                    let error =
                        InputError::new(what).allowed(format!("rests from {least} m, or up to {none} m, which go"));
                    wrong(error.help("move the opening, make it wider, or let `snap = true` move it"));
                }
                rest.push(Rect { x, ..*block });
            }
        }
        rest
    }

    /// Whether a block reaches into a zone.
    fn is_in(&self, block: &Rect, zone: [f64; 2]) -> bool {
        !(block.x[1] <= zone[0] + self.tolerance || block.x[0] >= zone[1] - self.tolerance)
    }

    /// Blocks beside a lintel reach to the mortar of its ends: where a rest has gone, or a head joint lay across an end, they are longer by up
    /// to two joints.
    fn reach(&self, course: &mut [Rect], zone: [f64; 2]) {
        let wide = |gap: f64| gap > 0.0 && gap <= 2.0 * self.head + self.tolerance;
        for block in course {
            if wide(zone[0] - block.x[1]) {
                block.x[1] = zone[0];
            } else if wide(block.x[0] - zone[1]) {
                block.x[0] = zone[1];
            }
        }
    }

    /// A lintel lies on the wall at both ends.
    fn bears(&self, hole: &Place, courses: &Courses, wrong: &mut dyn FnMut(InputError)) {
        let Some(lintel) = &hole.lintel else { return };
        for (side, x) in [("left", [lintel.x[0], hole.x[0]]), ("right", [hole.x[1], lintel.x[1]])] {
            let carries = |b: &Rect| b.x[1].min(x[1]) - b.x[0].max(x[0]) > self.tolerance;
            if !courses[hole.beds[1] - 1].iter().any(carries) {
                wrong(InputError::new(format!("the lintel has no block under its {side} end")));
            }
        }
    }

    /// Every course keeps a block.
    fn left_over(&self, hole: &Place, holes: &[Place], courses: &Courses, wrong: &mut dyn FnMut(InputError)) {
        let spanned =
            |r: usize| holes.iter().any(|h| h.lintel.as_ref().is_some_and(|l| (h.beds[1]..l.top).contains(&r)));
        if let Some(r) = (hole.beds[0]..hole.beds[1]).find(|&r| courses[r].is_empty() && !spanned(r)) {
            let what = format!("nothing is left of course {}", r + 1);
            wrong(InputError::new(what).allowed("a block in every course beside the opening"));
        }
    }
}

/// An opening as it comes to lie in its panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Laid {
    /// Panel and place in its list, from 0.
    pub panel: usize,
    /// See above.
    pub number: usize,
    /// Left and right side, from the panel's leftmost edge [m].
    pub x: [f64; 2],
    /// Bottom and top, from the base [m].
    pub y: [f64; 2],
    /// Length and height of its lintel [m].
    pub lintel: Option<[f64; 2]>,
    /// Blocks that were left out for it and its lintel.
    pub removed: usize,
    /// Blocks that were cut.
    pub cut: usize,
    /// The left and the right jamb; none where the opening begins at the panel's edge.
    pub jambs: [Option<Jamb>; 2],
    /// What `snap` moved, and by how much [m].
    pub moved: Vec<(&'static str, f64)>,
}

/// The blocks beside an opening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jamb {
    /// Courses beside it.
    pub courses: usize,
    /// Courses that end before the side of the opening: at a head joint, or with an offcut no longer than the head joint left out.
    pub short: usize,
    /// By how much at most [m].
    pub by: f64,
}

/// What became of the openings of a panel whose courses were `before` they were cut, and are now `after`.
pub(super) fn laid(panel: &Panel, index: usize, [before, after]: [&Courses; 2], holes: &[Place]) -> Vec<Laid> {
    if holes.is_empty() {
        return Vec::new();
    }
    let frame = Frame::new(panel, index, before);
    let of = |(number, hole): (usize, &Place)| {
        let (mut removed, mut cut) = (0, 0);
        for (zone, rows) in zones(hole, frame.head) {
            for block in rows.flat_map(|r| &before[r]).filter(|b| frame.is_in(b, zone)) {
                let stays = [zone[0] - block.x[0], block.x[1] - zone[1]];
                let stays = stays.into_iter().any(|rest| rest > frame.head + frame.tolerance);
                *(if stays { &mut cut } else { &mut removed }) += 1;
            }
        }
        Laid {
            panel: index,
            number,
            x: hole.x.map(|x| x - frame.x[0]),
            y: hole.y,
            lintel: hole.lintel.as_ref().map(|l| [l.x[1] - l.x[0], l.y[1] - l.y[0]]),
            removed,
            cut,
            jambs: [jamb(&frame, hole, after, 0), jamb(&frame, hole, after, 1)],
            moved: hole.moved.clone(),
        }
    };
    holes.iter().enumerate().map(of).collect()
}

/// The jamb at a side of a hole.
fn jamb(frame: &Frame, hole: &Place, courses: &Courses, side: usize) -> Option<Jamb> {
    let short_of = |block: &Rect| match side {
        0 => hole.x[0] - block.x[1],
        _ => block.x[0] - hole.x[1],
    };
    let nearest = |r: usize| {
        let gaps = courses[r].iter().map(short_of).filter(|gap| *gap >= -frame.tolerance);
        gaps.reduce(f64::min).filter(|gap| *gap <= 2.0 * frame.head + frame.tolerance)
    };
    let gaps: Vec<f64> = (hole.beds[0]..hole.beds[1]).filter_map(nearest).collect();
    let short = gaps.iter().filter(|gap| **gap > frame.tolerance).count();
    let by = gaps.iter().fold(0.0, |most: f64, gap| most.max(*gap));
    (!gaps.is_empty()).then_some(Jamb { courses: gaps.len(), short, by: if short > 0 { by } else { 0.0 } })
}
