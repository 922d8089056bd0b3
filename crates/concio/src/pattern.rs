//! From a [`Case`] to the blocks of its wall (theory, section 1).
//!
//! The base is at y = 0 and the first course of a panel lies on a bed of mortar, so it begins at y = t_b; every
//! further course lies t_b above the one below. The left edge of the first panel's unshifted courses is at x = 0. A
//! panel in series stands with its leftmost edge `connection` to the right of the rightmost edge of the one before it.
//! Explicit blocks keep the coordinates they are given, but for that shift.

use std::collections::HashMap;

use crate::case::{Bond, Case, Ends, ExplicitBlock, First, Panel, Tie, de::suggestion, validate};
use crate::polygon;
use crate::wall::{Block, PanelInfo, Shape, Wall};
use crate::{InputError, Result};

mod arch;
mod check;
mod openings;
mod place;
mod random;

pub use openings::{Jamb, Laid};

/// A block before it has a name.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rect {
    x: [f64; 2],
    y: [f64; 2],
    /// Place in the panel's list of explicit blocks, from 0; of a lintel that of its opening; elsewhere the place in the
    /// course.
    source: usize,
    /// Number of courses that a lintel takes up, 0 of all other blocks.
    lintel: usize,
}

impl Rect {
    fn new(x: f64, y: f64, length: f64, height: f64, source: usize) -> Rect {
        Rect { x: [x, x + length], y: [y, y + height], source, lintel: 0 }
    }
}

/// The courses of a panel from the bottom, each from left to right; a lintel stands in the topmost that it takes up.
type Courses = Vec<Vec<Rect>>;

/// Mistakes of a geometry; the first of them are kept.
#[derive(Debug, Default)]
struct Found {
    list: Vec<InputError>,
    more: usize,
    /// Whether not all were looked for.
    cut: bool,
}

/// Mistakes that are told one by one: more are mostly of one cause.
const MOST_FOUND: usize = 20;

impl Found {
    fn add(&mut self, error: InputError) {
        self.add_one(|| error);
    }

    /// The same of one that is put into words only if it is told.
    fn add_one(&mut self, error: impl FnOnce() -> InputError) {
        if self.list.len() < MOST_FOUND {
            self.list.push(error());
        } else {
            self.more += 1;
        }
    }

    /// How many there are.
    fn number(&self) -> usize {
        self.list.len() + self.more
    }
}

/// All mistakes of a geometry that [`lay`] refuses, the first of them one by one and how many more there are; none where it
/// lays the wall.
pub fn findings(case: &Case) -> Vec<InputError> {
    let mut found = Found::default();
    if let Err(error) = validate::panels(case) {
        return if let crate::Error::Input(error) = error { vec![*error] } else { Vec::new() };
    }
    laid(case, &mut found);
    if found.more > 0 {
        let least = if found.cut { "at least " } else { "" };
        found.list.push(InputError::new(format!("and {least}{} more mistakes like these", found.more)));
    }
    found.list
}

/// Lays the blocks of the wall, panel by panel, course by course from the bottom, left to right. Equal cases give
/// equal bits on every machine: only sums, products and quotients are taken, but for the angles of arches.
///
/// # Errors
/// [`InputError`] when a panel breaks the bounds of its keys; when blocks overlap, rest on nothing, vanish by rounding
/// or share a name; when no random texture holds the stagger; when `output.blocks` names a block that does not exist.
pub fn lay(case: &Case) -> Result<Wall> {
    validate::panels(case)?;
    let mut found = Found::default();
    let wall = laid(case, &mut found);
    found.list.into_iter().next().map_or(Ok(wall), |error| Err(error.into()))
}

/// The wall, if nothing is found against it.
fn laid(case: &Case, found: &mut Found) -> Wall {
    let mut wall = Wall { panels: Vec::with_capacity(case.panels.len()), blocks: Vec::new() };
    let mut right = None;
    for (index, panel) in case.panels.iter().enumerate() {
        let info = panel_info(case, index);
        let mut courses = match courses(panel, index) {
            Ok(courses) => courses,
            Err(error) => {
                add(found, error);
                continue;
            }
        };
        let before = found.number();
        let mut holes = openings::cut(panel, index, &mut courses, found);
        if let Some(right) = right {
            let by = shift(&mut courses, right + info.connection);
            holes.iter_mut().for_each(|hole| hole.x = hole.x.map(|x| x + by));
        }
        right = Some(edge(&courses, f64::NEG_INFINITY, |r| r.x[1], f64::max));
        if found.number() > before {
            // What lies on a bad opening is no mistake of its own.
            continue;
        }
        check::panel(panel, index, &courses, &holes, found);
        let first = wall.blocks.len();
        append(&mut wall.blocks, panel, index, &courses);
        check::polygons(panel, index, &courses, &wall.blocks[first..], found);
        wall.panels.push(PanelInfo { courses: courses.len(), ..info });
    }
    if found.number() == 0 {
        let whole = check::stands(case, &wall).and_then(|()| names(case, &wall));
        whole.err().into_iter().for_each(|error| add(found, error));
    }
    wall
}

fn add(found: &mut Found, error: crate::Error) {
    found.add(match error {
        crate::Error::Input(error) => *error,
        other => InputError::new(other.to_string()),
    });
}

/// The openings of a wall that can be laid as they come to lie, panel by panel in the order of the file.
///
/// # Errors
/// As [`lay`] of courses that cannot be made.
pub fn openings(case: &Case) -> Result<Vec<Laid>> {
    let mut all = Vec::new();
    for (index, panel) in case.panels.iter().enumerate().filter(|(_, panel)| !panel.openings.is_empty()) {
        let before = courses(panel, index)?;
        let mut after = before.clone();
        let holes = openings::cut(panel, index, &mut after, &mut Found::default());
        all.extend(openings::laid(panel, index, [&before, &after], &holes));
    }
    Ok(all)
}

fn panel_info(case: &Case, index: usize) -> PanelInfo {
    let panel = &case.panels[index];
    let (brick, mortar) = (&panel.brick, &panel.mortar);
    let reference = Block {
        name: String::new(),
        panel: index,
        course: 0,
        x: [0.0, brick.length.si()],
        y: [0.0, brick.height.si()],
        shape: None,
        thickness: brick.thickness.si(),
        specific_weight: brick.specific_weight.si(),
    };
    PanelInfo {
        name: case.panel_name(index),
        courses: 0,
        reference_length: brick.length.si(),
        reference_height: brick.height.si(),
        reference_mass: reference.mass(),
        mortar: [mortar.bed.si(), mortar.head.si()],
        connection: if index == 0 { 0.0 } else { panel.connection.unwrap_or(mortar.head).si() },
    }
}

fn courses(panel: &Panel, index: usize) -> Result<Courses> {
    match (panel.bond, &panel.random) {
        (Bond::Running, _) => Ok(regular(panel, true)),
        (Bond::Stack, _) => Ok(regular(panel, false)),
        (Bond::Irregular, Some(texture)) => random::courses(panel, texture, index),
        (Bond::Irregular, None) => Ok(listed(panel)),
        (Bond::Explicit | Bond::Arch, _) => Ok(shaped(panel)),
    }
}

/// Running or stack bond.
fn regular(panel: &Panel, running: bool) -> Courses {
    let (length, height) = (panel.brick.length.si(), panel.brick.height.si());
    let [bed, head] = [panel.mortar.bed.si(), panel.mortar.head.si()];
    let (bricks, pitch) = (panel.bricks.unwrap_or(0), length + head);
    (0..panel.courses.unwrap_or(0))
        .map(|r| {
            let y = bed + r as f64 * (height + bed);
            let whole = |k: usize, start: f64| Rect::new(start + k as f64 * pitch, y, length, height, k);
            let shifted = running && (r % 2 == 1) != (panel.first == First::Half);
            match (shifted, panel.ends) {
                (false, _) => (0..bricks).map(|k| whole(k, 0.0)).collect(),
                (true, Ends::Toothed) => (0..bricks).map(|k| whole(k, pitch / 2.0)).collect(),
                (true, Ends::Flush) => {
                    let half = (length - head) / 2.0;
                    let first = Rect::new(0.0, y, half, height, 0);
                    let last = Rect::new(half + head + (bricks - 1) as f64 * pitch, y, half, height, bricks);
                    let between = (1..bricks).map(|k| Rect { source: k, ..whole(k - 1, half + head) });
                    std::iter::once(first).chain(between).chain([last]).collect()
                }
            }
        })
        .collect()
}

/// Irregular texture from lists.
fn listed(panel: &Panel) -> Courses {
    let lists = panel.course_list.iter().map(|c| {
        let lengths = c.bricks.iter().map(|l| l.si()).collect();
        (c.height.si(), c.offset.si(), lengths)
    });
    stacked(panel, lists)
}

/// Courses of given height, offset and brick lengths, one on the other.
fn stacked(panel: &Panel, lists: impl IntoIterator<Item = (f64, f64, Vec<f64>)>) -> Courses {
    let [bed, head] = [panel.mortar.bed.si(), panel.mortar.head.si()];
    let mut y = bed;
    lists
        .into_iter()
        .map(|(height, offset, lengths)| {
            let mut x = offset;
            let course = lengths.into_iter().enumerate().map(|(k, length)| {
                let rect = Rect::new(x, y, length, height, k);
                x += length + head;
                rect
            });
            let course = course.collect();
            y += height + bed;
            course
        })
        .collect()
}

/// The corners of all blocks of a panel that is not laid of bricks, counterclockwise.
fn shapes(panel: &Panel) -> Vec<Vec<polygon::Point>> {
    match (&panel.arch, panel.bond) {
        (Some(arch), Bond::Arch) => arch::voussoirs(arch),
        (_, Bond::Explicit) => panel.blocks.iter().map(convex_outline).collect(),
        _ => Vec::new(),
    }
}

fn convex_outline(block: &ExplicitBlock) -> Vec<polygon::Point> {
    // The wall file was checked: a block that is not convex does not come here.
    let given = block.outline();
    polygon::convex(&given).unwrap_or(given)
}

/// Courses of explicit blocks and of arches.
fn shaped(panel: &Panel) -> Courses {
    let count = panel.blocks.iter().map(|b| b.course).max().unwrap_or(1);
    let mut courses = vec![Vec::new(); count];
    for (k, corners) in shapes(panel).iter().enumerate() {
        let [x, y] = polygon::bounds(corners);
        let course = panel.blocks.get(k).map_or(0, |b| b.course - 1);
        courses[course].push(Rect { x, y, source: k, lintel: 0 });
    }
    for course in &mut courses {
        course.sort_by(|a: &Rect, b| a.x[0].total_cmp(&b.x[0]));
    }
    courses
}

fn edge(courses: &Courses, start: f64, of: impl Fn(&Rect) -> f64, pick: impl Fn(f64, f64) -> f64) -> f64 {
    courses.iter().flatten().map(of).fold(start, pick)
}

/// Moves a panel so that its leftmost edge is at `left`; by how much [m].
fn shift(courses: &mut Courses, left: f64) -> f64 {
    let by = left - edge(courses, f64::INFINITY, |r| r.x[0], f64::min);
    for rect in courses.iter_mut().flatten() {
        rect.x = rect.x.map(|x| x + by);
    }
    by
}

fn append(blocks: &mut Vec<Block>, panel: &Panel, index: usize, courses: &Courses) {
    blocks.reserve(courses.iter().map(Vec::len).sum());
    let shapes = shapes(panel);
    for (r, course) in courses.iter().enumerate() {
        for (k, rect) in course.iter().enumerate() {
            let given = if panel.bond == Bond::Explicit { panel.blocks.get(rect.source) } else { None };
            let of_lintel = panel.openings.get(rect.source).filter(|_| rect.lintel > 0).and_then(|o| o.lintel);
            let own = given.and_then(|b| b.specific_weight).or(of_lintel.and_then(|l| l.specific_weight));
            blocks.push(Block {
                name: name(panel, index, r, k, rect),
                panel: index,
                course: r,
                x: rect.x,
                y: rect.y,
                shape: Shape::of(
                    rect.lintel.max(1),
                    shapes.get(rect.source).map_or_else(|| polygon::of_box(rect.x, rect.y), |c| moved(c, rect)),
                    rect.x,
                    rect.y,
                ),
                thickness: panel.brick.thickness.si(),
                specific_weight: own.unwrap_or(panel.brick.specific_weight).si(),
            });
        }
    }
}

/// Corners of a block, moved along with its panel.
fn moved(corners: &[polygon::Point], rect: &Rect) -> Vec<polygon::Point> {
    let [x, y] = polygon::bounds(corners);
    let level = |c: &polygon::Point| x.contains(&c[0]) && y.contains(&c[1]);
    if corners.len() == 4 && corners.iter().all(level) {
        return polygon::of_box(rect.x, rect.y);
    }
    corners.iter().map(|c| [c[0] + (rect.x[0] - x[0]), c[1]]).collect()
}

/// The name of a block at a place of a course, both from 0.
fn name(panel: &Panel, index: usize, course: usize, place: usize, rect: &Rect) -> String {
    if rect.lintel > 0 {
        return format!("p{}o{}", index + 1, rect.source + 1);
    }
    if panel.bond != Bond::Explicit {
        return block_name(index, course, rect.source);
    }
    let given = panel.blocks.get(rect.source).and_then(|b| b.id.clone());
    given.unwrap_or_else(|| block_name(index, course, place))
}

/// `p1c2b3`: panel, course and place, each from 1 in the name and from 0 here.
fn block_name(panel: usize, course: usize, place: usize) -> String {
    format!("p{}c{}b{}", panel + 1, course + 1, place + 1)
}

/// What is there of the panel or course that a name such as `p1c9b1` speaks of; `None` for other names.
pub fn out_of_reach<'a>(name: &str, blocks: impl Iterator<Item = &'a crate::wall::Block> + Clone) -> Option<String> {
    let rest = name.strip_prefix('p')?;
    let (panel, rest) = rest.split_once('c')?;
    let (course, place) = rest.split_once('b')?;
    let [panel, course, place] = [panel, course, place].map(|n| n.parse::<usize>().ok().filter(|n| *n > 0));
    let (panel, course, place) = (panel?, course?, place?);
    let panels = blocks.clone().map(|b| b.panel + 1).max()?;
    if panel > panels {
        return Some(format!("the wall has {panels} panel{}", if panels == 1 { "" } else { "s" }));
    }
    let of_panel = blocks.filter(move |b| b.panel + 1 == panel);
    let courses = of_panel.clone().map(|b| b.course + 1).max()?;
    if course > courses {
        return Some(format!("panel {panel} has {courses} courses"));
    }
    let count = of_panel.filter(|b| b.course + 1 == course).count();
    (place > count).then(|| format!("course {course} of panel {panel} has {count} blocks"))
}

/// Names are unique, and the blocks to be recorded exist.
fn names(case: &Case, wall: &Wall) -> Result<()> {
    let own = case.panels.iter().any(|p| p.blocks.iter().any(|b| b.id.is_some()));
    let kept = case.output.blocks.iter().enumerate().filter(|(_, name)| *name != "all");
    let kept = kept.map(|(k, name)| (format!("output.blocks[{k}]"), name, "`all`, or names"));
    let tied = case.ties.iter().enumerate().flat_map(|(i, tie)| [(i, "from", &tie.from), (i, "to", &tie.to)]);
    let tied = tied.filter(|(.., name)| *name != Tie::BASE);
    let tied = tied.map(|(i, end, name)| (format!("tie[{i}].{end}"), name, "`base`, or names of blocks"));
    let pushed = case.forces.iter().enumerate();
    let pushed = pushed.map(|(i, force)| (format!("force[{i}].block"), &force.block, "names of blocks"));
    let wanted: Vec<(String, &String, &str)> = tied.chain(pushed).chain(kept).collect();
    if !own && wanted.is_empty() {
        return Ok(());
    }
    let mut seen = HashMap::with_capacity(wall.blocks.len());
    for block in &wall.blocks {
        if seen.insert(block.name.as_str(), block).is_some() {
            return Err(twice(case, &block.name).into());
        }
    }
    for (key, name, allowed) in wanted {
        if !seen.contains_key(name.as_str()) {
            let error = InputError::new(format!("no block is called `{name}`")).key(key);
            let error = error.allowed(format!("{allowed} as `concio check` draws them"));
            // A suggestion is sought among few names only: it compares with each.
            let near = suggestion(name, wall.blocks.iter().map(|b| b.name.as_str()).take(10_000));
            let meant = near.map(|n| format!("did you mean `{n}`?"));
            let help: Vec<String> = out_of_reach(name, wall.blocks.iter()).into_iter().chain(meant).collect();
            return Err(if help.is_empty() { error } else { error.help(help.join("; ")) }.into());
        }
    }
    Ok(())
}

/// The error about a name that two blocks have; it stands at the last block that was given it.
fn twice(case: &Case, name: &str) -> InputError {
    let given = case.panels.iter().enumerate().flat_map(|(i, p)| {
        let ids = p.blocks.iter().enumerate();
        ids.filter(|(_, b)| b.id.as_deref() == Some(name)).map(move |(k, _)| format!("panel[{i}].block[{k}]"))
    });
    let given: Vec<String> = given.collect();
    let what = match given.as_slice() {
        [first, .., _] => format!("`{name}` is the name of {first} already"),
        _ => format!("`{name}` is the name of an unnamed block already"),
    };
    let key = given.last().map_or("panel".to_string(), |k| format!("{k}.id"));
    InputError::new(what).key(key).allowed("names unique in the wall")
}
