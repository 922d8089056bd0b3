//! Doors and windows: which blocks go, which are cut, and the lintels.
//!
//! Bottom and top of an opening and the top of its lintel lie on bed joints, so that blocks are cut upright alone and stay
//! rectangles. A bed joint reaches from the tops of one course to the bottoms of the next.

use super::{CONTACT_TOLERANCE, Courses, Rect, block_name, edge};
use crate::case::validate::tidy;
use crate::case::{Opening, Panel};
use crate::{InputError, Result};

/// How far off a bed joint a height may be, as a part of the brick's height: numbers copied from a message have been
/// rounded.
const NEAR: f64 = 1e-3;
/// Length over the panel's larger side from which a bare number was meant in millimetres.
const BARE: f64 = 20.0;

/// Shortest rest of a cut block, as a part of the brick's length.
const SLIVER: f64 = 0.02;

/// Cuts the openings of a panel out of its courses.
///
/// # Errors
/// Openings beyond the panel, over each other or off the bed joints; cuts that leave a sliver; lintels without bearing.
pub(super) fn cut(panel: &Panel, index: usize, courses: &mut Courses) -> Result<()> {
    if panel.openings.is_empty() {
        return Ok(());
    }
    let frame = Frame::new(panel, index, courses);
    let mut holes: Vec<Hole> = Vec::with_capacity(panel.openings.len());
    for (k, opening) in panel.openings.iter().enumerate() {
        let at = |key: &str, e: InputError| e.key(format!("panel[{index}].opening[{k}]{key}"));
        let hole = frame.hole(opening).map_err(|(key, e)| at(key, e))?;
        if let Some(other) = holes.iter().position(|h| h.meets(&hole, frame.tolerance)) {
            let what = format!("the opening or its lintel lies over opening[{other}] or its lintel");
            return Err(at("", InputError::new(what).allowed("openings and lintels beside each other")).into());
        }
        holes.push(hole);
    }
    for (k, hole) in holes.iter().enumerate() {
        for (zone, rows) in hole.zones(frame.head) {
            for r in rows {
                let error = |e: InputError| e.key(format!("panel[{index}].opening[{k}]"));
                courses[r] = frame.cleared(&courses[r], r, zone).map_err(error)?;
            }
        }
    }
    for (zone, rows) in holes.iter().filter_map(|hole| hole.over(frame.head)) {
        rows.for_each(|r| frame.reach(&mut courses[r], zone));
    }
    for (k, hole) in holes.iter().enumerate() {
        let Some(lintel) = &hole.lintel else { continue };
        let place = courses[lintel.top - 1].partition_point(|b| b.x[0] < lintel.x[0]);
        let rect = Rect { x: lintel.x, y: lintel.y, source: k, lintel: lintel.top - hole.beds[1] };
        courses[lintel.top - 1].insert(place, rect);
    }
    for (k, hole) in holes.iter().enumerate() {
        let error = |e: InputError| e.key(format!("panel[{index}].opening[{k}]"));
        frame.bears(hole, courses).map_err(|e| error(e).allowed("a block below it on either side"))?;
        frame.left_over(hole, &holes, courses).map_err(error)?;
    }
    for course in courses {
        course.iter_mut().filter(|b| b.lintel == 0).enumerate().for_each(|(place, block)| block.source = place);
    }
    Ok(())
}

/// What is taken out of the wall, in its coordinates.
struct Hole {
    x: [f64; 2],
    y: [f64; 2],
    /// The bed joints at bottom and top, from 0 at the base: by the course that lies on them.
    beds: [usize; 2],
    lintel: Option<Slab>,
}

struct Slab {
    x: [f64; 2],
    y: [f64; 2],
    /// Bed joint at its top.
    top: usize,
}

/// From left to right [m], and in which courses.
type Zone = ([f64; 2], std::ops::Range<usize>);

impl Hole {
    /// What is cleared of blocks, and in which courses; a lintel has head joints of `mortar`.
    fn zones(&self, mortar: f64) -> impl Iterator<Item = Zone> {
        std::iter::once((self.x, self.beds[0]..self.beds[1])).chain(self.over(mortar))
    }

    /// That of the lintel.
    fn over(&self, mortar: f64) -> Option<Zone> {
        let lintel = self.lintel.as_ref()?;
        Some(([lintel.x[0] - mortar, lintel.x[1] + mortar], self.beds[1]..lintel.top))
    }

    fn meets(&self, other: &Hole, tolerance: f64) -> bool {
        let parts = |h: &Hole| [Some((h.x, h.y)), h.lintel.as_ref().map(|l| (l.x, l.y))];
        let common = |a: [f64; 2], b: [f64; 2]| a[1].min(b[1]) - a[0].max(b[0]) > tolerance;
        let theirs = parts(other);
        let meet = |(x, y): ([f64; 2], [f64; 2])| {
            theirs.iter().flatten().any(|(other_x, other_y)| common(x, *other_x) && common(y, *other_y))
        };
        parts(self).into_iter().flatten().any(meet)
    }
}

/// A panel before anything is cut.
struct Frame {
    index: usize,
    /// Leftmost and rightmost edge [m].
    x: [f64; 2],
    /// Bed joints from the base to the panel's top, each from its lower to its upper face [m].
    beds: Vec<[f64; 2]>,
    /// Head mortar [m].
    head: f64,
    length: f64,
    near: f64,
    tolerance: f64,
}

/// The key below the opening, and the error.
type Fault = (&'static str, InputError);

impl Frame {
    fn new(panel: &Panel, index: usize, courses: &Courses) -> Self {
        let mut beds = Vec::with_capacity(courses.len() + 1);
        let mut below = 0.0;
        for block in courses.iter().filter_map(|course| course.first()) {
            beds.push([below, block.y[0]]);
            below = block.y[1];
        }
        beds.push([below, below + panel.mortar.bed.si()]);
        let (length, height) = (panel.brick.length.si(), panel.brick.height.si());
        Frame {
            index,
            x: [
                edge(courses, f64::INFINITY, |r| r.x[0], f64::min),
                edge(courses, f64::NEG_INFINITY, |r| r.x[1], f64::max),
            ],
            beds,
            head: panel.mortar.head.si(),
            length,
            near: NEAR * height,
            tolerance: CONTACT_TOLERANCE * length,
        }
    }

    /// Says of lengths that no panel has what they were meant to be.
    fn plausible(&self, o: &Opening) -> std::result::Result<(), Fault> {
        let [wide, high] = [self.x[1] - self.x[0], self.beds.last().map_or(0.0, |bed| bed[1])];
        let slab = o.lintel.map_or([0.0; 2], |l| [l.height.si(), l.bearing.si()]);
        let lengths = [(".x", o.x.si()), (".y", o.y.si()), (".width", o.width.si()), (".height", o.height.si())];
        for (key, length) in lengths.into_iter().chain([(".lintel.height", slab[0]), (".lintel.bearing", slab[1])]) {
            if length > BARE * wide.max(high) {
                let what = format!("{} m in a panel of {} m × {} m", tidy(length), tidy(wide), tidy(high));
                let help = format!("did you mean \"{} mm\"?", tidy(length));
                return Err((key, InputError::new(what).allowed("a length within the panel").help(help)));
            }
        }
        Ok(())
    }

    fn hole(&self, o: &Opening) -> std::result::Result<Hole, Fault> {
        self.plausible(o)?;
        let reach = o.lintel.map_or(0.0, |l| l.bearing.si());
        let with = if reach > 0.0 { "with the lintel's bearing it " } else { "it " };
        let x = [self.x[0] + o.x.si(), self.x[0] + o.x.si() + o.width.si()];
        if o.x.si() < reach - self.tolerance {
            let what = format!("{with}reaches beyond the panel's left edge");
            return Err((".x", InputError::new(what).allowed(format!("from {} m, the bearing", tidy(reach)))));
        }
        if x[1] + reach > self.x[1] + self.tolerance {
            let what = format!("{with}ends at {} m, beyond the panel", tidy(x[1] + reach - self.x[0]));
            let most = self.x[1] - x[0] - reach;
            let allowed = match most > 0.0 {
                true => format!("up to {} m at this `x`", tidy(most)),
                false => format!("a smaller `x`: the panel is {} m long", tidy(self.x[1] - self.x[0])),
            };
            return Err((".width", InputError::new(what).allowed(allowed)));
        }
        let (low, bottom) = self.bed(o.y.si(), 0.0, 0, 0.0).map_err(|e| (".y", e))?;
        let over = o.lintel.map_or(0.0, |l| l.height.si());
        let (high, top) = self.bed(o.y.si() + o.height.si(), o.y.si(), low + 1, over).map_err(|e| (".height", e))?;
        let lintel = |l: crate::case::Lintel| {
            let (bed, end) = self.bed(top + l.height.si(), top, high + 1, 0.0).map_err(|e| (".lintel.height", e))?;
            Ok(Slab { x: [x[0] - reach, x[1] + reach], y: [top, end], top: bed })
        };
        Ok(Hole { x, y: [bottom, top], beds: [low, high], lintel: o.lintel.map(lintel).transpose()? })
    }

    /// The bed joint at the height `y`, no lower than number `least`, and the height within it; messages count from `zero` and name
    /// heights with room for a lintel of `over`.
    fn bed(&self, y: f64, zero: f64, least: usize, over: f64) -> std::result::Result<(usize, f64), InputError> {
        let within = |[low, high]: &[f64; 2]| (low - self.near..=high + self.near).contains(&y);
        if let Some(bed) = self.beds.iter().position(within).filter(|bed| *bed >= least) {
            // Of a dry wall both are one height, but for rounding.
            let [low, high] = self.beds[bed];
            return Ok((bed, y.max(low).min(high)));
        }
        let most = self.beds.last().map_or(0.0, |bed| bed[1]) + self.near - over;
        let possible = &self.beds[least.min(self.beds.len())..];
        // Where no place has room for the lintel, it is the lintel that is too high.
        let possible = match possible.partition_point(|bed| bed[0] <= most) {
            0 => possible,
            roomy => &possible[..roomy],
        };
        let above = possible.iter().position(|bed| bed[0] > y).unwrap_or(possible.len());
        let near: Vec<String> = possible[above.saturating_sub(1)..(above + 1).min(possible.len())]
            .iter()
            .map(|bed| bed.map(|v| tidy(v - zero)))
            .map(|[low, high]| if low == high { format!("{low} m") } else { format!("{low} … {high} m") })
            .collect();
        let top = self.beds.last().map_or(0.0, |bed| bed[0]);
        let what = match y > top + self.near {
            true => {
                format!("the edge at a height of {} m is above the panel, whose top is at {} m", tidy(y), tidy(top))
            }
            false => format!("the edge at a height of {} m is not on a bed joint", tidy(y)),
        };
        let allowed = if near.is_empty() { "a lower place: no course is left above".into() } else { near.join(" or ") };
        Err(InputError::new(what).allowed(allowed))
    }

    /// A course without what lies in `zone`.
    fn cleared(&self, course: &[Rect], r: usize, zone: [f64; 2]) -> std::result::Result<Vec<Rect>, InputError> {
        let mut rest = Vec::with_capacity(course.len() + 1);
        for block in course {
            let [x0, x1] = block.x;
            if x1 <= zone[0] + self.tolerance || x0 >= zone[1] - self.tolerance {
                rest.push(*block);
                continue;
            }
            for x in [[x0, zone[0]], [zone[1], x1]] {
                let length = x[1] - x[0];
                if length <= self.head + self.tolerance {
                    continue;
                }
                if length < SLIVER * self.length {
                    let name = block_name(self.index, r, block.source);
                    let what = format!("the cut leaves {} m of block {name}", tidy(length));
                    let least = tidy(SLIVER * self.length);
                    let none = tidy(self.head);
                    let error =
                        InputError::new(what).allowed(format!("rests from {least} m, or up to {none} m, which go"));
                    return Err(error.help("move the opening, or make it wider"));
                }
                rest.push(Rect { x, ..*block });
            }
        }
        Ok(rest)
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
    fn bears(&self, hole: &Hole, courses: &Courses) -> std::result::Result<(), InputError> {
        let Some(lintel) = &hole.lintel else { return Ok(()) };
        for (side, x) in [("left", [lintel.x[0], hole.x[0]]), ("right", [hole.x[1], lintel.x[1]])] {
            let carries = |b: &Rect| b.x[1].min(x[1]) - b.x[0].max(x[0]) > self.tolerance;
            if !courses[hole.beds[1] - 1].iter().any(carries) {
                return Err(InputError::new(format!("the lintel has no block under its {side} end")));
            }
        }
        Ok(())
    }

    /// Every course keeps a block.
    fn left_over(&self, hole: &Hole, holes: &[Hole], courses: &Courses) -> std::result::Result<(), InputError> {
        let spanned =
            |r: usize| holes.iter().any(|h| h.lintel.as_ref().is_some_and(|l| (h.beds[1]..l.top).contains(&r)));
        match (hole.beds[0]..hole.beds[1]).find(|&r| courses[r].is_empty() && !spanned(r)) {
            Some(r) => {
                let what = format!("nothing is left of course {}", r + 1);
                Err(InputError::new(what).allowed("a block in every course beside the opening"))
            }
            None => Ok(()),
        }
    }
}
