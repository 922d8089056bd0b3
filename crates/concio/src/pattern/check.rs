//! Geometry that no wall may have: blocks that overlap, rest on nothing or vanish beside the others.

use std::cmp::Ordering;
use std::collections::{BTreeMap, HashSet};

use super::place::Place;
use super::{Courses, Found, Rect};
use crate::case::{Bond, Case, JointKind, Panel};
use crate::quantity::{Length, shown};
use crate::wall::{Block, CONTACT_TOLERANCE, End, Joint, Wall};
use crate::{InputError, Result, graph, polygon};

/// Smallest block and largest coordinate, as parts and multiples of the panel's brick: between them rounding stays
/// below the contact tolerance.
const SMALLEST: f64 = 1e-5;
const FARTHEST: f64 = 1e7;

/// Adds what is wrong with a panel to `found`; `holes` are its openings.
pub(super) fn panel(panel: &Panel, index: usize, courses: &Courses, holes: &[Place], found: &mut Found) {
    let site = Site { panel, index, tolerance: CONTACT_TOLERANCE * panel.brick.length.si(), holes };
    let before = found.number();
    site.sizes(courses, found);
    let plain = panel.bond != Bond::Arch && panel.blocks.iter().all(|b| b.is_rectangle());
    if !plain || found.number() > before {
        return;
    }
    if panel.bond == Bond::Explicit {
        let beside = site.side_by_side(courses, found);
        site.overlaps(courses, &beside, found);
        if found.number() > before {
            // Whatever lies in another block also begins below its top.
            return;
        }
    }
    if panel.openings.is_empty() {
        courses.windows(2).enumerate().for_each(|(r, pair)| site.rests(r, &pair[0], &pair[1], found));
    } else {
        (1..courses.len()).for_each(|r| site.rests(r - 1, &courses[r - 1], &beginning(courses, r), found));
    }
}

/// How far blocks that are no rectangles may reach into each other, as a part of the brick's length: corners written in
/// millimetres are that far off.
const ROUGH: f64 = 4e-3;

/// Overlaps in a panel of blocks that are not all rectangles; `blocks` are those of `courses`, in their order.
pub(super) fn polygons(panel: &Panel, index: usize, courses: &Courses, blocks: &[Block], found: &mut Found) {
    if blocks.iter().all(Block::is_rectangle) {
        return;
    }
    let tolerance = ROUGH * panel.brick.length.si();
    let mut order: Vec<usize> = (0..blocks.len()).collect();
    order.sort_by(|&i, &j| blocks[i].x[0].total_cmp(&blocks[j].x[0]));
    let sources: Vec<usize> = courses.iter().flatten().map(|rect| rect.source).collect();
    let (before, mut looks) = (found.number(), 0usize);
    for (k, &i) in order.iter().enumerate() {
        let beside = order[k + 1..].iter().take_while(|&&j| blocks[j].x[0] < blocks[i].x[1]);
        // Boxes that do not meet need no closer look: a tower has all of its blocks beside each other.
        let level = |j: &&usize| blocks[**j].y[0] < blocks[i].y[1] && blocks[i].y[0] < blocks[**j].y[1];
        for &j in beside.filter(level) {
            looks += usize::from(found.number() > before);
            if looks > MOST_DEPTHS {
                found.cut = true;
                return;
            }
            if polygon::depth(&blocks[i].corners(), &blocks[j].corners()) > tolerance {
                let (a, b) = if sources[i] < sources[j] { (i, j) } else { (j, i) };
                found.add_one(|| {
                    let what = format!("blocks {} and {} overlap", blocks[a].name, blocks[b].name);
                    let key = match panel.bond {
                        Bond::Arch => format!("panel[{index}].arch"),
                        _ => format!("panel[{index}].block[{}]", sources[b]),
                    };
                    InputError::new(what).key(key).allowed("blocks that share edges at most")
                });
            }
        }
    }
}

/// Of blocks given one by one, none hangs in the air: each lies on what is under it, and in a panel of blocks that are not all rectangles
/// hangs together with the base by joints.
pub(super) fn stands(case: &Case, wall: &Wall) -> Result<()> {
    if !case.panels.iter().any(|panel| matches!(panel.bond, Bond::Explicit | Bond::Arch)) {
        return Ok(());
    }
    let joints = graph::joints(wall, false);
    hangs(case, wall, &joints)?;
    if wall.blocks.iter().all(Block::is_rectangle) {
        return Ok(());
    }
    let mut beside = vec![Vec::new(); wall.blocks.len()];
    let mut reached: Vec<usize> = Vec::new();
    for joint in &joints {
        match joint.b {
            End::Block(b) => {
                beside[joint.a].push(b);
                beside[b].push(joint.a);
            }
            End::Base | End::Top => reached.push(joint.a),
        }
    }
    let mut found = vec![false; wall.blocks.len()];
    while let Some(i) = reached.pop() {
        if !std::mem::replace(&mut found[i], true) {
            reached.extend(&beside[i]);
        }
    }
    let Some(lost) = found.iter().position(|found| !found) else { return Ok(()) };
    let block = &wall.blocks[lost];
    let what = format!("block {} has no joint that leads to the base", block.name);
    let error = InputError::new(what).key(key_of(case, block));
    let allowed = "sides that face those of other blocks, or the base at y = 0, over no more than the mortar";
    Err(error.allowed(allowed).into())
}

/// Thickest bed joint of blocks given one by one: twice the mortar and so much of the brick's height, by which stones differ.
const UNEVEN: f64 = 0.1;

/// Refuses blocks that lie higher above what is under them than mortar reaches, as by a wrong `y`.
fn hangs(case: &Case, wall: &Wall, joints: &[Joint]) -> Result<()> {
    let over = |joint: &Joint| -> Option<(f64, usize, bool)> {
        let (block, from) = match (joint.kind, joint.b) {
            (JointKind::Bed, End::Block(b)) => (b, wall.blocks[joint.a].y[1]),
            (JointKind::Base, _) => (joint.a, 0.0),
            _ => return None,
        };
        let panel = &wall.panels[wall.blocks[block].panel];
        let explicit = case.panels[wall.blocks[block].panel].bond == Bond::Explicit;
        // Sides of polygons are joined over no more than mortar as it is.
        let upright = wall.blocks[joint.a].is_rectangle() && wall.blocks[block].is_rectangle();
        let gap = wall.blocks[block].y[0] - from;
        let most = 2.0 * panel.mortar[0] + UNEVEN * panel.reference_height;
        (explicit && (upright || joint.kind == JointKind::Base)).then_some((gap, block, gap > most))
    };
    let mut over: Vec<(f64, usize, bool)> = joints.iter().filter_map(over).collect();
    over.sort_by(|a, b| a.1.cmp(&b.1).then(a.0.total_cmp(&b.0)));
    let of_block: Vec<&[(f64, usize, bool)]> =
        over.chunk_by(|a, b| a.1 == b.1).filter(|of| of.iter().any(|g| g.2)).collect();
    let hangs = |of: &&[(f64, usize, bool)]| of.iter().all(|(.., thick)| *thick);
    // What hangs is told before what rests on one side alone.
    let Some(first) = of_block.iter().find(|of| hangs(of)).or(of_block.first()) else { return Ok(()) };
    let (gap, lost, _) = if hangs(first) { first[0] } else { first[first.len() - 1] };
    let block = &wall.blocks[lost];
    let under = if block.lowest_course() == 0 { "the base" } else { "what is under it" };
    let others = match of_block.len() {
        1 => String::new(),
        n => format!("; {} more are like it", n - 1),
    };
    let gap = Length::from_si(gap);
    let what = match hangs(first) {
        true => format!("block {} hangs in the air, {gap} above {under}{others}", block.name),
        false => format!("block {} rests on one block and lies {gap} above another of that course{others}", block.name),
    };
    let bed = Length::from_si(wall.panels[block.panel].mortar[0]);
    let allowed =
        format!("a bottom edge on the base at y = 0 or on a block, with the mortar ({bed}) or less between them");
    Err(InputError::new(what).key(key_of(case, block)).allowed(allowed).into())
}

/// The key of a block that is given by hand.
fn key_of(case: &Case, block: &Block) -> String {
    let given = &case.panels[block.panel].blocks;
    let named = given.iter().position(|b| b.id.as_deref() == Some(block.name.as_str()));
    let placed =
        || given.iter().position(|b| polygon::bounds(&b.outline())[1] == block.y && b.course == block.course + 1);
    match named.or_else(placed) {
        Some(k) => format!("panel[{}].block[{k}]", block.panel),
        None => format!("panel[{}]", block.panel),
    }
}

/// The blocks whose lowest course is `r`, from left to right.
fn beginning(courses: &Courses, r: usize) -> Vec<Rect> {
    let of = |(upper, course): (usize, &Vec<Rect>)| -> Vec<Rect> {
        course.iter().filter(|b| upper + 1 == r + b.lintel.max(1)).copied().collect()
    };
    let mut found: Vec<Rect> = courses.iter().enumerate().skip(r).flat_map(of).collect();
    found.sort_by(|a, b| a.x[0].total_cmp(&b.x[0]));
    found
}

/// A panel under check.
struct Site<'a> {
    panel: &'a Panel,
    index: usize,
    /// Overlaps up to this are rounding [m].
    tolerance: f64,
    /// Its openings.
    holes: &'a [Place],
}

impl Site<'_> {
    /// The key that a block comes from.
    fn key(&self, course: usize, rect: &Rect) -> String {
        let i = self.index;
        let below = |hole: &Place| hole.y[1] <= rect.y[0] + self.tolerance;
        let beside = |hole: &Place| rect.x[0] < hole.x[1] && rect.x[1] > hole.x[0];
        if rect.lintel > 0 {
            return format!("panel[{i}].opening[{}].lintel", rect.source);
        }
        if let Some(k) = self.holes.iter().rposition(|hole| below(hole) && beside(hole)) {
            return format!("panel[{i}].opening[{k}]");
        }
        match (self.panel.bond, &self.panel.random) {
            (Bond::Explicit, _) => format!("panel[{i}].block[{}]", rect.source),
            (Bond::Arch, _) => format!("panel[{i}].arch"),
            (Bond::Irregular, None) => format!("panel[{i}].course[{course}]"),
            (Bond::Irregular, Some(_)) => format!("panel[{i}].random"),
            (Bond::Running | Bond::Stack, _) => format!("panel[{i}]"),
        }
    }
    /// The name of the block at a place of a course.
    fn name(&self, course: usize, place: usize, rect: &Rect) -> String {
        super::name(self.panel, self.index, course, place, rect)
    }
    fn sizes(&self, courses: &Courses, found: &mut Found) {
        let (length, height) = (self.panel.brick.length.si(), self.panel.brick.height.si());
        for (r, k, rect) in each(courses) {
            let [dx, dy] = [rect.x, rect.y].map(|[a, b]| b - a);
            let far = rect.x.iter().any(|x| x.abs() > FARTHEST * length)
                || rect.y.iter().any(|y| y.abs() > FARTHEST * height);
            // Written so that NaN fails too.
            let large = dx >= SMALLEST * length && dy >= SMALLEST * height;
            if !large || far {
                let what = if far { "lies too far from the origin" } else { "is too small" };
                let [dx, dy] = [dx, dy].map(shown);
                let what =
                    format!("block {} ({dx} m by {dy} m) {what} to be told from rounding", self.name(r, k, rect));
                let allowed = "sizes from 1e-5 of the panel's brick, coordinates up to 1e7 of it";
                found.add(InputError::new(what).key(self.key(r, rect)).allowed(allowed));
            }
        }
    }
    /// Blocks of one course stand beside each other, else neighbours and supports could not be told. Those that do not, by
    /// their sources.
    fn side_by_side(&self, courses: &Courses, found: &mut Found) -> HashSet<[usize; 2]> {
        let mut told = HashSet::new();
        for (r, course) in courses.iter().enumerate() {
            for (k, pair) in course.windows(2).enumerate() {
                if pair[1].x[0] >= pair[0].x[1] - self.tolerance {
                    continue;
                }
                found.add_one(|| {
                    let (a, b) = (self.name(r, k, &pair[0]), self.name(r, k + 1, &pair[1]));
                    let beside = pair[0].y[1] <= pair[1].y[0] || pair[1].y[1] <= pair[0].y[0];
                    let what = if beside {
                        format!("blocks {a} and {b} of course {} stand one above the other", r + 1)
                    } else {
                        format!("blocks {a} and {b} overlap")
                    };
                    let allowed = "blocks of one course side by side";
                    InputError::new(what).key(self.key(r, &pair[1])).allowed(allowed)
                });
                told.insert(sources(&pair[0], &pair[1]));
            }
        }
        told
    }
    /// Overlaps between any two blocks but those `told`, by a line sweeping from left to right. While the blocks it cuts do not
    /// overlap, a new one need be compared with its neighbours above and below only; from the first overlap on with all.
    fn overlaps(&self, courses: &Courses, told: &HashSet<[usize; 2]>, found: &mut Found) {
        let all: Vec<_> = each(courses).collect();
        let mut events = Vec::with_capacity(2 * all.len());
        for (i, (.., rect)) in all.iter().enumerate() {
            events.push((rect.x[0] + self.tolerance, false, i));
            events.push((rect.x[1] - self.tolerance, true, i));
        }
        // At one place blocks end before others begin.
        events.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let mut cut: BTreeMap<(Height, usize), usize> = BTreeMap::new();
        let (mut clean, mut looks) = (told.is_empty(), 0usize);
        for (_, ends, i) in events {
            let rect = all[i].2;
            let place = |height: f64, i: usize| (Height(height), i);
            if ends {
                cut.remove(&place(rect.y[0], i));
                continue;
            }
            let deep = |other: &usize| {
                let y = all[*other].2.y;
                y[1].min(rect.y[1]) - y[0].max(rect.y[0]) > self.tolerance
            };
            let below = cut.range(..place(rect.y[0], i)).next_back();
            let above = cut.range(place(rect.y[0], i)..).next();
            let mut hits: Vec<usize> = below.into_iter().chain(above).map(|(_, o)| *o).filter(deep).collect();
            if !clean || !hits.is_empty() {
                clean = false;
                looks += cut.len();
                hits = cut.range(..place(rect.y[1], 0)).map(|(_, o)| *o).filter(deep).collect();
                hits.sort_unstable();
            }
            for other in hits.into_iter().filter(|o| !told.contains(&sources(all[*o].2, rect))) {
                found.add_one(|| self.overlap(all[other], all[i]));
            }
            if looks > MOST_LOOKS {
                found.cut = true;
                return;
            }
            cut.insert(place(rect.y[0], i), i);
        }
    }
    fn overlap(&self, a: (usize, usize, &Rect), b: (usize, usize, &Rect)) -> InputError {
        // The later one in the file is the one complained about.
        let (a, b) = if a.2.source < b.2.source { (a, b) } else { (b, a) };
        let what = format!("blocks {} and {} overlap", self.name(a.0, a.1, a.2), self.name(b.0, b.1, b.2));
        InputError::new(what).key(self.key(b.0, b.2)).allowed("blocks that share edges at most")
    }
    /// Every block of the course `upper` (number r + 1 from 0) lies on a block of the course below.
    fn rests(&self, r: usize, lower: &[Rect], upper: &[Rect], found: &mut Found) {
        let mut first = 0;
        for (k, rect) in upper.iter().enumerate() {
            while lower.get(first).is_some_and(|b| b.x[1] <= rect.x[0] + self.tolerance) {
                first += 1;
            }
            let carrying = |b: &&Rect| b.x[1].min(rect.x[1]) - b.x[0].max(rect.x[0]) > self.tolerance;
            let mut carriers = lower[first..].iter().take_while(|b| b.x[0] < rect.x[1]).filter(carrying).peekable();
            let name = self.name(r + 1, k, rect);
            let key = self.key(r + 1, rect);
            if carriers.peek().is_none() {
                let what =
                    format!("block {name} of course {} rests on nothing: its load has no way to the base", r + 2);
                let allowed = format!("an overlap with a block of course {}", r + 1);
                let error = InputError::new(what).allowed(allowed);
                let over_opening = key.contains(".opening[") && !key.ends_with("lintel");
                let error = if over_opening { error.help("a `lintel` bears what lies over an opening") } else { error };
                found.add(error.key(key));
                continue;
            }
            if let Some(over) = carriers.find(|b| b.y[1] > rect.y[0] + self.tolerance) {
                let what = format!(
                    "block {name} of course {} begins at {} m, below the top of a block under it",
                    r + 2,
                    shown(rect.y[0])
                );
                found.add(InputError::new(what).key(key).allowed(format!("from {} m", shown(over.y[1]))));
            }
        }
    }
}

/// Comparisons of polygons from the first overlap on after which the others are left untold: each takes a microsecond.
const MOST_DEPTHS: usize = 1_000_000;
/// The same of rectangles.
const MOST_LOOKS: usize = 20_000_000;

/// The places of two blocks in the file, the earlier first.
fn sources(a: &Rect, b: &Rect) -> [usize; 2] {
    [a.source.min(b.source), a.source.max(b.source)]
}

/// Course, place and block.
fn each(courses: &Courses) -> impl Iterator<Item = (usize, usize, &Rect)> {
    courses.iter().enumerate().flat_map(|(r, c)| c.iter().enumerate().map(move |(k, rect)| (r, k, rect)))
}

/// A coordinate as a key.
struct Height(f64);

impl PartialEq for Height {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Height {}
impl PartialOrd for Height {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Height {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}
