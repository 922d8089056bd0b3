//! Where the edges of openings lie: lengths as they are given, courses and bricks at the faces of what stays, and `snap` on
//! the nearest joints.
//!
//! With the pitch p = L + t_h, n bricks to the left of an opening end at n p − t_h, and w bricks taken out leave those on the
//! right to begin at (n + w) p: the clear width is w p + t_h. In a running bond both are faces of bricks in every second
//! course and cut half bricks in the others, for n and w in halves.

use super::{Courses, edge};
use crate::InputError;
use crate::case::validate::tidy;
use crate::case::{Bond, Extent, Opening, Panel};
use crate::wall::CONTACT_TOLERANCE;

/// How far off a bed joint a height may be, as a part of the brick's height: numbers copied from a message have been
/// rounded.
const NEAR: f64 = 1e-3;
/// Length over the panel's larger side from which a bare number was meant in millimetres.
const BARE: f64 = 20.0;

/// The key below the opening, and the error.
pub(super) type Fault = (&'static str, InputError);

/// A panel before anything is cut.
pub(super) struct Frame {
    pub index: usize,
    /// Leftmost and rightmost edge [m].
    pub x: [f64; 2],
    /// Bed joints from the base to the panel's top, each from its lower to its upper face [m].
    beds: Vec<[f64; 2]>,
    /// Head mortar [m].
    pub head: f64,
    /// Of a brick [m].
    pub length: f64,
    /// From one head joint of the wall to the next, of all courses together [m]; none where they are in no order.
    step: Option<f64>,
    near: f64,
    pub tolerance: f64,
}

/// An opening with the room that its lintel takes, in the coordinates of the wall [m].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Place {
    pub x: [f64; 2],
    pub y: [f64; 2],
    /// The bed joints at bottom and top, from 0 at the base: by the course that lies on them.
    pub beds: [usize; 2],
    pub lintel: Option<Slab>,
    /// What `snap` moved, and by how much.
    pub moved: Vec<(&'static str, f64)>,
}

/// Room of a lintel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slab {
    pub x: [f64; 2],
    pub y: [f64; 2],
    /// Bed joint at its top.
    pub top: usize,
}

/// An edge on a bed joint: the joint and the height.
type Bed = (usize, f64);

/// The bed joints at bottom and top, both heights, and the lintel's top.
struct Heights {
    beds: [usize; 2],
    y: [f64; 2],
    slab: Option<Bed>,
}

impl Frame {
    pub fn new(panel: &Panel, index: usize, courses: &Courses) -> Self {
        let mut beds = Vec::with_capacity(courses.len() + 1);
        let mut below = 0.0;
        for block in courses.iter().filter_map(|course| course.first()) {
            beds.push([below, block.y[0]]);
            below = block.y[1];
        }
        beds.push([below, below + panel.mortar.bed.si()]);
        let (length, height) = (panel.brick.length.si(), panel.brick.height.si());
        let head = panel.mortar.head.si();
        Frame {
            index,
            x: [
                edge(courses, f64::INFINITY, |r| r.x[0], f64::min),
                edge(courses, f64::NEG_INFINITY, |r| r.x[1], f64::max),
            ],
            beds,
            head,
            length,
            step: match panel.bond {
                Bond::Running => Some(0.5 * (length + head)),
                Bond::Stack => Some(length + head),
                _ => None,
            },
            near: NEAR * height,
            tolerance: CONTACT_TOLERANCE * length,
        }
    }

    /// Where an opening lies; or all that is wrong with its edges.
    pub fn place(&self, o: &Opening) -> Result<Place, Vec<Fault>> {
        let mut faults = self.implausible(o);
        if !faults.is_empty() {
            return Err(faults);
        }
        let mut moved = Vec::new();
        let reach = o.lintel.map_or(0.0, |l| self.bearing(l.bearing, o.snap, &mut moved));
        if let Some(lintel) = o.lintel.filter(|_| reach <= self.tolerance) {
            let what = format!("{} leave nothing to lie on", lintel.bearing);
            faults.push((".lintel.bearing", InputError::new(what).allowed("more than a head joint")));
        }
        let x = self.sides(o, reach, &mut moved).map_err(|fault| faults.push(fault));
        let y = self.heights(o, &mut moved, &mut faults);
        match (x, y) {
            (Ok(x), Some(Heights { beds, y, slab })) if faults.is_empty() => {
                let lintel = slab.map(|(top, end)| Slab { x: [x[0] - reach, x[1] + reach], y: [y[1], end], top });
                Ok(Place { x, y, beds, lintel, moved })
            }
            _ => Err(faults),
        }
    }

    /// Lengths that no panel has, with what they were meant to be.
    fn implausible(&self, o: &Opening) -> Vec<Fault> {
        let [wide, high] = [self.x[1] - self.x[0], self.beds.last().map_or(0.0, |bed| bed[1])];
        let slab = o.lintel.map(|l| [(".lintel.height", l.height), (".lintel.bearing", l.bearing)]);
        let extents = [(".x", o.x), (".y", o.y), (".width", o.width), (".height", o.height)];
        let mut faults = Vec::new();
        for (key, extent) in extents.into_iter().chain(slab.into_iter().flatten()) {
            if let Some(length) = extent.length().filter(|length| *length > BARE * wide.max(high)) {
                let what = format!("{} m in a panel of {} m × {} m", tidy(length), tidy(wide), tidy(high));
                let help = format!("did you mean \"{} mm\"?", tidy(length));
                faults.push((key, InputError::new(what).allowed("a length within the panel").help(help)));
            }
        }
        faults
    }

    /// Pitch of the bricks [m].
    fn pitch(&self) -> f64 {
        self.length + self.head
    }

    /// How far a lintel reaches onto the wall on either side.
    fn bearing(&self, bearing: Extent, snap: bool, moved: &mut Vec<(&'static str, f64)>) -> f64 {
        let given = match bearing {
            Extent::Bricks(number) => return number * self.pitch() - self.head,
            other => other.length().unwrap_or(0.0),
        };
        let Some(step) = self.step.filter(|_| snap) else { return given };
        let nearest = ((given + self.head) / step).round().max(1.0) * step - self.head;
        note(moved, ("the bearing", given, nearest), self.tolerance)
    }

    /// Left and right side, room for a lintel that reaches so far included.
    fn sides(&self, o: &Opening, reach: f64, moved: &mut Vec<(&'static str, f64)>) -> Result<[f64; 2], Fault> {
        let wide = self.x[1] - self.x[0];
        let given = match o.x {
            Extent::Bricks(number) => (number * self.pitch() - self.head).max(0.0),
            other => other.length().unwrap_or(0.0),
        };
        let mut left = given;
        if let Some(step) = self.step.filter(|_| o.snap && o.x.length().is_some()) {
            let nearest = (((left + self.head) / step).round() * step - self.head).max(0.0);
            let nearest = if left < 0.5 * (step - self.head) { 0.0 } else { nearest };
            left = note(moved, ("the left side", left, nearest), self.tolerance);
        }
        // Bricks on the right begin a joint behind those taken out, which begin a joint behind those on the left.
        let begins = if left > self.tolerance { left + self.head } else { left };
        let mut right = match o.width {
            Extent::Bricks(number) => begins + number * self.pitch(),
            other => given + other.length().unwrap_or(0.0),
        };
        if let Some(step) = self.step.filter(|_| o.snap && o.width.length().is_some()) {
            let nearest = ((right / step).round() * step).max(begins + step);
            right = note(moved, ("the right side", right, nearest.min(wide)), self.tolerance);
        }
        if right > wide && right <= wide + self.head + self.tolerance && matches!(o.width, Extent::Bricks(_)) {
            right = wide;
        }
        let with = if reach > 0.0 { "with the lintel's bearing it " } else { "it " };
        if left < reach - self.tolerance {
            let what = format!("{with}reaches beyond the panel's left edge");
            return Err((".x", InputError::new(what).allowed(format!("from {} m, the bearing", tidy(reach)))));
        }
        if right + reach > wide + self.tolerance {
            let what = format!("{with}ends at {} m, beyond the panel", tidy(right + reach));
            let most = wide - left - reach;
            let allowed = match most > 0.0 {
                true => format!("up to {} m at this `x`", tidy(most)),
                false => format!("a smaller `x`: the panel is {} m long", tidy(wide)),
            };
            return Err((".width", InputError::new(what).allowed(allowed)));
        }
        Ok([self.x[0] + left, self.x[0] + right])
    }

    /// Bottom and top, and the top of the lintel.
    fn heights(&self, o: &Opening, moved: &mut Vec<(&'static str, f64)>, faults: &mut Vec<Fault>) -> Option<Heights> {
        let mut on = |key: &'static str, found: Result<Bed, InputError>| match found {
            Ok(bed) => Some(bed),
            Err(error) => {
                faults.push((key, error));
                None
            }
        };
        let over = o.lintel.and_then(|l| l.height.length()).unwrap_or(0.0);
        let bottom = match (o.y, o.y.length()) {
            (Extent::Courses(below), _) => on(".y", self.above(below, 0)),
            (_, Some(y)) if o.snap => on(".y", self.nearest(("the bottom", y), 0, 0, moved)),
            (_, y) => on(".y", self.bed(y.unwrap_or(0.0), 0.0, 0, 0.0)),
        };
        // Of a bottom that lies on no bed joint the height is known, not the joint.
        let (low, y) = match (bottom, o.y.length()) {
            (Some(bed), _) => bed,
            (None, Some(y)) => (0, y),
            (None, None) => return None,
        };
        let top = match (o.height, o.height.length()) {
            (Extent::Courses(number), _) => {
                bottom.and_then(|_| on(".height", self.above(low as f64 + number, low + 1))).map(|(bed, y)| {
                    // Below the underside of the course above, if there is one.
                    let face = self.beds.get(bed).filter(|_| bed + 1 < self.beds.len()).map_or(y, |faces| faces[1]);
                    (bed, face)
                })
            }
            // From where the bottom was, not from where it has been moved.
            (_, Some(height)) if o.snap => {
                let from = o.y.length().unwrap_or(y);
                on(".height", self.nearest(("the top", from + height), low + 1, 1, moved))
            }
            (_, height) => on(".height", self.bed(y + height.unwrap_or(0.0), y, low + 1, over)),
        };
        let (high, upper) = top?;
        let slab = match o.lintel.map(|l| (l.height, l.height.length())) {
            None => None,
            Some((Extent::Courses(number), _)) => {
                Some(on(".lintel.height", self.above(high as f64 + number, high + 1))?)
            }
            Some((_, Some(height))) if o.snap => {
                Some(on(".lintel.height", self.nearest(("the lintel's top", upper + height), high + 1, 0, moved))?)
            }
            Some((_, height)) => {
                Some(on(".lintel.height", self.bed(upper + height.unwrap_or(0.0), upper, high + 1, 0.0))?)
            }
        };
        bottom.map(|_| Heights { beds: [low, high], y: [y, upper], slab })
    }

    /// The bed joint over so many courses, no lower than number `least`, and the height of its lower face.
    fn above(&self, courses: f64, least: usize) -> Result<Bed, InputError> {
        let last = self.beds.len() - 1;
        match courses {
            n if n >= least as f64 && n <= last as f64 => Ok((n as usize, self.beds[n as usize][0])),
            n => {
                let what = format!("an edge above course {} lies outside the panel, which has {last} courses", tidy(n));
                Err(InputError::new(what).allowed(format!("up to the panel's {last} courses")))
            }
        }
    }

    /// The bed joint nearest to a height, no lower than number `least`: where the height is on none, at its face `side`.
    fn nearest(
        &self,
        (name, y): (&'static str, f64),
        least: usize,
        side: usize,
        moved: &mut Vec<(&'static str, f64)>,
    ) -> Result<Bed, InputError> {
        if let Ok(bed) = self.bed(y, 0.0, least, 0.0) {
            return Ok(bed);
        }
        let last = self.beds.len() - 1;
        // The topmost joint has nothing above it.
        let face = |bed: usize| if bed == last { self.beds[bed][0] } else { self.beds[bed][side] };
        let away = |bed: &usize| (face(*bed) - y).abs();
        let nearest = (least..=last).min_by(|a, b| away(a).total_cmp(&away(b)));
        let bed = nearest.ok_or_else(|| {
            let what = format!("no course is left for the edge at a height of {} m", tidy(y));
            InputError::new(what).allowed("a lower place")
        })?;
        Ok((bed, note(moved, (name, y, face(bed)), self.tolerance)))
    }

    /// The bed joint at the height `y`, no lower than number `least`, and the height within it; messages count from `zero` and name
    /// heights with room for a lintel of `over`.
    fn bed(&self, y: f64, zero: f64, least: usize, over: f64) -> Result<Bed, InputError> {
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
        let error = InputError::new(what).allowed(allowed);
        Err(if near.is_empty() {
            error
        } else {
            error.help("count it in courses (\"2 courses\"), or let `snap = true` move it")
        })
    }
}

/// A length that `snap` moves, unless by rounding alone.
fn note(moved: &mut Vec<(&'static str, f64)>, (name, from, to): (&'static str, f64, f64), tolerance: f64) -> f64 {
    if (to - from).abs() > tolerance {
        moved.push((name, to - from));
    }
    to
}
