//! How a planar wall failed: what of its displacement is turning, sliding, or a stepped crack.
//!
//! At the frame in which the top has gone farthest, its displacement is split: a course that turns by θ brings θ times its
//! height (rocking), a bed joint plane in which all joints have slid the same way brings what the least of them slid
//! (sliding). What is left comes from joints that slide and open here and not there; where these reach through the wall in
//! steps, it is a diagonal crack. Where joints have parted from edge to edge, so that nothing holds the top to the base any more, what
//! slid along that cut counts: as sliding where half of it lies at one level, otherwise as a crack in steps.

use serde::{Deserialize, Serialize};

use crate::case::JointKind;
use crate::graph;
use crate::record::{EventKind, Recording};
use crate::wall::{End, Joint, Wall};

mod collapse;

pub use collapse::Collapsed;
pub(crate) use collapse::is_down;

/// Part of the top's displacement from which a mode is named.
const NAMED: f64 = 0.25;
/// Displacement of the top over the height of the wall below which it has not failed.
const MOVED: f64 = 5e-4;
/// Opening and slip from which the joints of a cut have parted, over the displacement of the top: the largest at which there is one counts.
const PARTED: [f64; 7] = [0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.1];
/// Part of a cut at one level from which it is a plane that slid, and not a crack in steps.
const FLAT: f64 = 0.5;
/// Opening and slip from which a joint counts as cracked in a stepped crack, over the displacement of the top.
const CRACKED: f64 = 0.02;

/// Ways to fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Parts of the wall turn about their toes.
    Rocking,
    /// One part of the wall slides on another along a bed joint.
    Sliding,
    /// A crack runs in steps through bed and head joints.
    Diagonal,
    /// The toe is crushed.
    Crushing,
    /// Blocks have fallen.
    Collapse,
}

impl Mode {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Mode::Rocking => "rocking",
            Mode::Sliding => "bed sliding",
            Mode::Diagonal => "stepped diagonal crack",
            Mode::Crushing => "toe crushing",
            Mode::Collapse => "collapse",
        }
    }
}

/// How a wall failed, and of which parts the displacement of its top consists.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// The modes, the largest part first; none where it did not fail.
    pub modes: Vec<Mode>,
    /// Instant at which the top has gone farthest [s].
    pub time: f64,
    /// Displacement of the top then [m].
    pub top: f64,
    /// Part of it from turning, 0 … 1.
    pub rocking: f64,
    /// Part of it from planes that slid, 0 … 1.
    pub sliding: f64,
}

/// How the wall of this recording failed, before a collapse made rubble of it; none where frames are missing or not of a planar wall.
pub fn failure(wall: &Wall, joints: &[Joint], recording: &Recording) -> Option<Failure> {
    let frames = recording.frame_time.len();
    let per = |values: &[f64]| values.len().checked_div(frames).unwrap_or(0);
    let (unknowns, held) = (per(&recording.frame_displacement), per(&recording.frame_slip));
    if held != joints.len() || per(&recording.frame_rotation) != unknowns || unknowns < wall.blocks.len() {
        return None;
    }
    let courses = graph::courses(wall);
    let top: Vec<usize> = courses.iter().filter_map(|rows| rows.last()).flatten().copied().collect();
    // Where there is a beam, it is the top.
    let beam = (unknowns > wall.blocks.len()).then_some(unknowns - 1);
    let of_top = |frame: usize| match beam {
        Some(beam) => recording.frame_displacement[frame * unknowns + beam],
        None => {
            top.iter().map(|&i| recording.frame_displacement[frame * unknowns + i]).sum::<f64>()
                / top.len().max(1) as f64
        }
    };
    let frame =
        (0..recording.standing(&recording.frame_time)).max_by(|a, b| of_top(*a).abs().total_cmp(&of_top(*b).abs()))?;
    let moved = of_top(frame);
    let rotation = |i: usize| recording.frame_rotation[frame * unknowns + i];
    let slip = |e: usize| recording.frame_slip[frame * held + e];
    let opening = |e: usize| recording.frame_opening[frame * held + e];
    // What stays behind a crack does not count: every block as far as it has gone.
    let gone = |i: usize| wall.blocks[i].mass() * recording.frame_displacement[frame * unknowns + i].abs();
    let mean = |row: &[usize]| {
        let weight: f64 = row.iter().map(|&i| gone(i)).sum();
        // Its bed of mortar turns with a block.
        let pitch = |i: usize| wall.blocks[i].height() + wall.panels[wall.blocks[i].panel].mortar[0];
        let turn: f64 = row.iter().map(|&i| -rotation(i) * gone(i) * pitch(i)).sum();
        if weight > 0.0 { turn / weight } else { 0.0 }
    };
    // All panels carry the same top: what one of them does is what the wall does, so that the mean of them counts.
    let panels = courses.len().max(1) as f64;
    let turned: f64 = courses.iter().flatten().filter(|row| !row.is_empty()).map(|row| mean(row)).sum::<f64>() / panels;
    let slid = slid(wall, joints, &slip) / panels;
    let share = |part: f64| if moved == 0.0 { 0.0 } else { (part / moved).clamp(0.0, 1.0) };
    let (rocking, sliding) = (share(turned), share(slid));
    let height = wall.blocks.iter().map(|b| b.y[1]).fold(0.0, f64::max);
    let limit = CRACKED * moved.abs();
    let cracked = |e: &usize| if joints[*e].kind.is_upright() { opening(*e) > limit } else { slip(*e).abs() > limit };
    // The cut that has parted farthest: there may be others, of less.
    let cut = PARTED.iter().find_map(|part| {
        let least = part * moved.abs();
        cut(wall, joints, &courses, &|e| slip(e).abs() > least || opening(e) > least, &slip)
    });
    let (flat, stepped) = match &cut {
        Some(cut) if cut.level >= FLAT => (share(cut.slid), 0.0),
        Some(cut) => (0.0, share(cut.slid)),
        None => (0.0, 0.0),
    };
    let sliding = sliding.max(flat);
    let mut parts = vec![(Mode::Rocking, rocking), (Mode::Sliding, sliding)];
    let rest = if steps(wall, joints, &cracked) { 1.0 - (rocking + sliding).min(1.0) } else { 0.0 };
    parts.push((Mode::Diagonal, rest.max(stepped)));
    parts.retain(|part| part.1 >= NAMED && moved.abs() > MOVED * height);
    parts.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut modes: Vec<Mode> = parts.into_iter().map(|part| part.0).collect();
    let lies = |e: u32| matches!(joints[e as usize].kind, JointKind::Base | JointKind::Bed);
    let end = recording.collapse().map_or(f64::INFINITY, |event| event.time);
    let crushed = recording.events.iter().any(|e| e.kind == EventKind::Crush && e.time <= end && lies(e.joint));
    modes.extend(crushed.then_some(Mode::Crushing));
    modes.extend(end.is_finite().then_some(Mode::Collapse));
    Some(Failure { modes, time: recording.frame_time[frame], top: moved, rocking, sliding })
}

/// Sum over the planes of bed joints of what slid right through [m], with its sign: below towards above.
fn slid(wall: &Wall, joints: &[Joint], slip: &impl Fn(usize) -> f64) -> f64 {
    let mut planes: Vec<Vec<Option<[f64; 2]>>> = wall.panels.iter().map(|p| vec![None; p.courses + 1]).collect();
    for (e, joint) in joints.iter().enumerate() {
        // Offset of the upper side: slip is that of the lower one, of a base joint that of the block itself.
        let lower = &wall.blocks[joint.a];
        let (panel, course, offset) = match joint.b {
            End::Base => (lower.panel, lower.lowest_course(), slip(e)),
            End::Top => (lower.panel, lower.course + 1, -slip(e)),
            End::Block(upper) => {
                let upper = &wall.blocks[upper];
                // Of an arch, all voussoirs are one course: nothing slides right through.
                if joint.kind.is_upright() || upper.lowest_course() <= lower.course {
                    continue;
                }
                (upper.panel, upper.lowest_course(), -slip(e))
            }
        };
        let plane = &mut planes[panel][course];
        let [low, high] = plane.unwrap_or([offset; 2]);
        *plane = Some([low.min(offset), high.max(offset)]);
    }
    let through = |[low, high]: [f64; 2]| {
        if low > 0.0 {
            low
        } else if high < 0.0 {
            high
        } else {
            0.0
        }
    };
    planes.iter().flatten().flatten().map(|ends| through(*ends)).sum()
}

/// A cut from edge to edge along which a wall has parted.
struct Cut {
    /// How far what is above has slid on what is below, the mean along bed joints [m].
    slid: f64,
    /// Part of its length that lies at one level.
    level: f64,
}

/// The upper side of what the base still holds through joints that have not parted, where no more of the top hangs on it.
fn cut(
    wall: &Wall,
    joints: &[Joint],
    courses: &[Vec<Vec<usize>>],
    parted: &impl Fn(usize) -> bool,
    slip: &impl Fn(usize) -> f64,
) -> Option<Cut> {
    let (base, top) = (wall.blocks.len(), wall.blocks.len() + 1);
    let node = |end: &End| match end {
        End::Base => base,
        End::Top => top,
        End::Block(block) => *block,
    };
    let mut around = vec![Vec::new(); wall.blocks.len() + 2];
    for (_, joint) in joints.iter().enumerate().filter(|(e, _)| !parted(*e)) {
        let other = node(&joint.b);
        around[joint.a].push(other);
        around[other].push(joint.a);
    }
    let mut held = vec![false; around.len()];
    held[base] = true;
    let mut stack = vec![base];
    while let Some(at) = stack.pop() {
        for next in &around[at] {
            if !std::mem::replace(&mut held[*next], true) {
                stack.push(*next);
            }
        }
    }
    let beam = joints.iter().any(|joint| joint.b == End::Top);
    let highest = || courses.iter().filter_map(|rows| rows.last()).flatten();
    if if beam { held[top] } else { highest().any(|block| held[*block]) } {
        return None;
    }
    let (mut length, mut slid, mut levels) = (0.0, 0.0, std::collections::BTreeMap::new());
    for (e, joint) in joints.iter().enumerate() {
        let other = node(&joint.b);
        if held[joint.a] == held[other] || joint.kind.is_upright() {
            continue;
        }
        let [x0, y0, x1, y1] = joint.line;
        let along = (x1 - x0).abs();
        // Slip is that of the lower side, of a base joint that of the block itself; what is held may lie above.
        let offset = if held[joint.a] { -slip(e) } else { slip(e) };
        length += along;
        slid += along * offset;
        *levels.entry((0.5e3 * (y0 + y1)).round() as i64).or_insert(0.0) += along;
    }
    let longest = levels.values().copied().fold(0.0, f64::max);
    (length > 0.0).then(|| Cut { slid: slid / length, level: longest / length })
}

/// Whether cracked joints hang together over at least half of the courses, through head joints and pieces of bed joints.
fn steps(wall: &Wall, joints: &[Joint], cracked: &impl Fn(&usize) -> bool) -> bool {
    let reach = 0.6 * wall.panels.iter().map(|p| p.mortar[0].max(p.mortar[1])).fold(0.0, f64::max) + 1e-6;
    let heights = |e: usize| [joints[e].line[1].min(joints[e].line[3]), joints[e].line[1].max(joints[e].line[3])];
    // From the lowest up, so that those that may touch one are found at its height.
    let mut list: Vec<usize> = (0..joints.len()).filter(cracked).collect();
    list.sort_by(|a, b| heights(*a)[0].total_cmp(&heights(*b)[0]));
    let tallest = list.iter().map(|e| heights(*e)[1] - heights(*e)[0]).fold(0.0, f64::max);
    let around = |e: usize| {
        let [low, high] = heights(e);
        let from = list.partition_point(|other| heights(*other)[0] < low - tallest - reach);
        from..list.partition_point(|other| heights(*other)[0] <= high + reach)
    };
    // Joints meet where they share a block and an end.
    let touch = |a: &Joint, b: &Joint| {
        let ends = |j: &Joint| [[j.line[0], j.line[1]], [j.line[2], j.line[3]]];
        ends(a).iter().any(|p| {
            let [x0, y0, x1, y1] = b.line;
            p[0] >= x0 - reach && p[0] <= x1 + reach && p[1] >= y0 - reach && p[1] <= y1 + reach
        }) || ends(b).iter().any(|p| {
            let [x0, y0, x1, y1] = a.line;
            p[0] >= x0 - reach && p[0] <= x1 + reach && p[1] >= y0 - reach && p[1] <= y1 + reach
        })
    };
    let courses = wall.panels.iter().map(|p| p.courses).max().unwrap_or(0);
    // In an arch or a single course there are no steps.
    if courses < 2 {
        return false;
    }
    let mut seen = vec![false; list.len()];
    for start in 0..list.len() {
        if seen[start] {
            continue;
        }
        let (mut stack, mut heads) = (vec![start], std::collections::BTreeSet::new());
        seen[start] = true;
        while let Some(k) = stack.pop() {
            let joint = &joints[list[k]];
            if joint.kind.is_upright() {
                heads.insert(wall.blocks[joint.a].course);
            }
            for other in around(list[k]) {
                if !seen[other] && touch(joint, &joints[list[other]]) {
                    seen[other] = true;
                    stack.push(other);
                }
            }
        }
        if 2 * heads.len() >= courses {
            return true;
        }
    }
    false
}
