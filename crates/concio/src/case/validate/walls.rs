//! Panels: bricks, mortar, and the keys that each bond takes.

use std::collections::HashMap;
use std::fmt::Display;

use super::{Bound, Findings};
use crate::InputError;
use crate::case::{Bond, Case, Ends, ExplicitBlock, Extent, First, Panel, RandomTexture};

/// Most blocks of a wall: 1.4 GB where they rise and turn.
pub const LARGEST_WALL: usize = 500_000;
/// Most panels of a wall.
const MOST_PANELS: usize = 1000;
/// Most openings of a panel: each is compared with all others.
const MOST_OPENINGS: usize = 1000;
/// Longest name of a panel or block [bytes]: joints bear two of them, tables and drawings many.
const LONGEST_NAME: usize = 200;

/// No fewer blocks than the panel will have (for a random texture an upper bound, else the number).
pub fn block_bound(panel: &Panel) -> usize {
    let courses = panel.courses.unwrap_or(0);
    // An opening may part a block of every course, and adds its lintel.
    let parted = panel.openings.len().saturating_mul(courses.max(panel.course_list.len()).saturating_add(1));
    parted.saturating_add(match (panel.bond, &panel.random) {
        (Bond::Explicit, _) => panel.blocks.len(),
        (Bond::Arch, _) => panel.arch.map_or(0, |a| a.voussoirs),
        (Bond::Irregular, None) => panel.course_list.iter().map(|c| c.bricks.len()).sum(),
        (Bond::Irregular, Some(r)) => {
            let mortar = panel.mortar.head.si();
            let most = (r.width.si() + mortar) / (r.length[0].si() + mortar) + 1.0;
            // A float beyond the range of `usize` saturates, one that is no number gives 0: refused elsewhere.
            courses.saturating_mul(most as usize)
        }
        (Bond::Stack, _) => courses.saturating_mul(panel.bricks.unwrap_or(0)),
        (Bond::Running, _) => {
            // A course of a flush panel that starts with a half brick has one block more.
            let longer = match (panel.ends, panel.first) {
                (Ends::Toothed, _) => 0,
                (Ends::Flush, First::Full) => courses / 2,
                (Ends::Flush, First::Half) => courses.div_ceil(2),
            };
            courses.saturating_mul(panel.bricks.unwrap_or(0)).saturating_add(longer)
        }
    })
}

pub(super) fn check(f: &mut Findings, case: &Case) {
    if case.panels.is_empty() {
        f.push("panel", "the wall has no panel", "at least one [[panel]]");
    }
    if case.panels.len() > MOST_PANELS {
        f.push("panel", format!("{} panels are too many", case.panels.len()), format!("up to {MOST_PANELS}"));
        return;
    }
    names(f, case);
    let mut total = 0usize;
    for (i, panel) in case.panels.iter().enumerate() {
        common(f, i, panel);
        keys(f, i, panel);
        openings(f, i, panel);
        match panel.bond {
            Bond::Running | Bond::Stack => regular(f, i, panel),
            Bond::Irregular => irregular(f, i, panel),
            Bond::Explicit => explicit(f, i, panel),
            Bond::Arch => arch(f, i, panel),
        }
        total = total.saturating_add(block_bound(panel));
        if total > LARGEST_WALL {
            let what = format!("the wall would have up to {total} blocks");
            f.push(format_args!("panel[{i}]"), what, format!("up to {LARGEST_WALL} blocks"));
            break;
        }
    }
}

fn names(f: &mut Findings, case: &Case) {
    let mut seen: HashMap<String, usize> = HashMap::new();
    for (i, panel) in case.panels.iter().enumerate() {
        let name = case.panel_name(i);
        if panel.name.as_deref().is_some_and(|n| n.trim().is_empty()) {
            f.push(format_args!("panel[{i}].name"), "the name is empty", "a name that is not blank");
        }
        a_name(f, format_args!("panel[{i}].name"), panel.name.as_deref());
        if let Some(first) = seen.insert(name.clone(), i) {
            let what = format!("panel[{first}] is called `{name}` too");
            f.push(
                format_args!("panel[{i}].name"),
                what,
                "names that differ (`p1`, `p2`, … are the names of unnamed panels)",
            );
        }
    }
}

/// What a result can hold: in HDF5 a text ends at U+0000.
fn a_name(f: &mut Findings, key: impl Display, name: Option<&str>) {
    if let Some(name) = name.filter(|name| name.len() > LONGEST_NAME) {
        f.push(&key, format!("a name of {} bytes is too long", name.len()), format!("up to {LONGEST_NAME} bytes"));
    }
    if name.is_some_and(|name| name.contains('\0')) {
        f.push(key, "a name holds U+0000", "all other characters");
    }
}

fn common(f: &mut Findings, i: usize, panel: &Panel) {
    let b = &panel.brick;
    f.quantity(format_args!("panel[{i}].brick.length"), b.length, Bound::Above0);
    f.quantity(format_args!("panel[{i}].brick.height"), b.height, Bound::Above0);
    f.quantity(format_args!("panel[{i}].brick.thickness"), b.thickness, Bound::Above0);
    f.quantity(format_args!("panel[{i}].brick.specific_weight"), b.specific_weight, Bound::Above0);
    f.quantity(format_args!("panel[{i}].mortar.bed"), panel.mortar.bed, Bound::From0);
    f.quantity(format_args!("panel[{i}].mortar.head"), panel.mortar.head, Bound::From0);
    if let Some(connection) = panel.connection {
        f.quantity(format_args!("panel[{i}].connection"), connection, Bound::From0);
        if i == 0 {
            let what = "the first panel has no panel on its left to be connected to";
            f.push("panel[0].connection", what, "on the second panel and after it");
        }
    }
}

fn openings(f: &mut Findings, i: usize, panel: &Panel) {
    if panel.openings.len() > MOST_OPENINGS {
        let what = format!("{} openings are too many", panel.openings.len());
        f.push(format_args!("panel[{i}].opening"), what, format!("up to {MOST_OPENINGS}"));
        return;
    }
    for (k, o) in panel.openings.iter().enumerate() {
        let key = format!("panel[{i}].opening[{k}]");
        extent(f, &format!("{key}.x"), o.x, Bound::From0, Counted::Bricks, panel.bond);
        extent(f, &format!("{key}.y"), o.y, Bound::From0, Counted::Courses, panel.bond);
        extent(f, &format!("{key}.width"), o.width, Bound::Above0, Counted::Bricks, panel.bond);
        extent(f, &format!("{key}.height"), o.height, Bound::Above0, Counted::Courses, panel.bond);
        if let Some(lintel) = &o.lintel {
            extent(f, &format!("{key}.lintel.height"), lintel.height, Bound::Above0, Counted::Courses, panel.bond);
            extent(f, &format!("{key}.lintel.bearing"), lintel.bearing, Bound::Above0, Counted::Bricks, panel.bond);
            if let Some(weight) = lintel.specific_weight {
                f.quantity(format_args!("{key}.lintel.specific_weight"), weight, Bound::Above0);
            }
        }
    }
}

/// What an extent is counted in besides lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Counted {
    Courses,
    Bricks,
}

/// A length, or a number of what its direction is counted in.
fn extent(f: &mut Findings, key: &str, extent: Extent, bound: Bound, counted: Counted, bond: Bond) {
    match (extent, counted) {
        (Extent::Length(length), _) => f.quantity(key, length, bound),
        (Extent::Courses(number), Counted::Courses) => {
            f.value(key, number, " courses", bound);
            if number.fract() != 0.0 {
                f.push(key, format!("{extent} end within a course"), "whole courses");
            }
        }
        (Extent::Bricks(number), Counted::Bricks) if matches!(bond, Bond::Running | Bond::Stack) => {
            f.value(key, number, " bricks", bound);
        }
        (Extent::Bricks(_), Counted::Bricks) => {
            let what = format!("{extent}: bricks of bond `{}` have no one length", bond_name(bond));
            f.push(key, what, "a length; bricks in bond `running` or `stack`");
        }
        (_, Counted::Courses) => {
            f.push(key, format!("{extent}: heights are counted in courses"), "a length, or courses")
        }
        (_, Counted::Bricks) => f.push(key, format!("{extent}: widths are counted in bricks"), "a length, or bricks"),
    }
}

/// Keys that another bond takes are refused: left unread they would mislead.
fn keys(f: &mut Findings, i: usize, panel: &Panel) {
    use Bond::*;
    let given: [(&str, bool, &[Bond], &str); 9] = [
        ("courses", panel.courses.is_some(), &[Running, Stack, Irregular], "`running`, `stack` or `irregular`"),
        ("bricks", panel.bricks.is_some(), &[Running, Stack], "`running` or `stack`"),
        ("ends", panel.ends != Ends::default(), &[Running], "`running`"),
        ("first", panel.first != First::default(), &[Running], "`running`"),
        ("course", !panel.course_list.is_empty(), &[Irregular], "`irregular`"),
        ("random", panel.random.is_some(), &[Irregular], "`irregular`"),
        ("block", !panel.blocks.is_empty(), &[Explicit], "`explicit`"),
        ("arch", panel.arch.is_some(), &[Arch], "`arch`"),
        ("opening", !panel.openings.is_empty(), &[Running, Stack, Irregular], "`running`, `stack` or `irregular`"),
    ];
    for (key, given, bonds, allowed) in given {
        if given && !bonds.contains(&panel.bond) {
            let what = format!("the key does not go with bond `{}`", bond_name(panel.bond));
            f.push(format_args!("panel[{i}].{key}"), what, format!("with bond {allowed}"));
        }
    }
}

fn bond_name(bond: Bond) -> &'static str {
    match bond {
        Bond::Running => "running",
        Bond::Stack => "stack",
        Bond::Irregular => "irregular",
        Bond::Explicit => "explicit",
        Bond::Arch => "arch",
    }
}

fn count(f: &mut Findings, i: usize, key: &str, value: Option<usize>, bond: Bond) {
    match value {
        Some(0) => f.push(format_args!("panel[{i}].{key}"), "0 is out of range", "from 1"),
        Some(_) => {}
        None => {
            let what = format!("the key is missing: bond `{}` needs it", bond_name(bond));
            f.push(format_args!("panel[{i}].{key}"), what, "a whole number from 1");
        }
    }
}

fn regular(f: &mut Findings, i: usize, panel: &Panel) {
    count(f, i, "courses", panel.courses, panel.bond);
    count(f, i, "bricks", panel.bricks, panel.bond);
    let half = panel.bond == Bond::Running && panel.ends == Ends::Flush;
    if half && panel.mortar.head >= panel.brick.length {
        let what = format!("{} of mortar leave no half brick of (L - t_h)/2", panel.mortar.head);
        f.push(
            format_args!("panel[{i}].mortar.head"),
            what,
            format!("below the brick's length, {}", panel.brick.length),
        );
    }
}

fn irregular(f: &mut Findings, i: usize, panel: &Panel) {
    match (&panel.random, panel.course_list.is_empty()) {
        (Some(r), true) => random(f, i, panel, r),
        (None, false) => listed(f, i, panel),
        (given, _) => {
            let what =
                if given.is_some() { "both a list and a distribution are given" } else { "the courses are not given" };
            f.push(format_args!("panel[{i}].course"), what, "either [[panel.course]] or `random`");
        }
    }
}

fn listed(f: &mut Findings, i: usize, panel: &Panel) {
    if panel.courses.is_some() {
        let what = "the courses are listed and need no number";
        f.push(format_args!("panel[{i}].courses"), what, "with `irregular` only beside `random`");
    }
    for (r, course) in panel.course_list.iter().enumerate() {
        f.quantity(format_args!("panel[{i}].course[{r}].height"), course.height, Bound::Above0);
        f.quantity(format_args!("panel[{i}].course[{r}].offset"), course.offset, Bound::Finite);
        if course.bricks.is_empty() {
            f.push(format_args!("panel[{i}].course[{r}].bricks"), "the course has no brick", "at least one length");
        }
        for (k, length) in course.bricks.iter().enumerate() {
            f.quantity(format_args!("panel[{i}].course[{r}].bricks[{k}]"), *length, Bound::Above0);
        }
    }
}

fn random(f: &mut Findings, i: usize, panel: &Panel, r: &RandomTexture) {
    let before = f.list.len();
    count(f, i, "courses", panel.courses, panel.bond);
    f.quantity(format_args!("panel[{i}].random.width"), r.width, Bound::Above0);
    for (key, pair) in [("length", r.length), ("height", r.height)] {
        for (k, v) in pair.into_iter().enumerate() {
            f.quantity(format_args!("panel[{i}].random.{key}[{k}]"), v, Bound::Above0);
        }
        f.rising(format_args!("panel[{i}].random.{key}"), pair, true);
    }
    f.quantity(format_args!("panel[{i}].random.stagger"), r.stagger, Bound::From0);
    if f.list.len() > before {
        return;
    }
    let shortest = r.length[0].si();
    if r.stagger.si() > shortest / 2.0 {
        let what = format!("{} cannot be held over bricks of {}", r.stagger, r.length[0]);
        f.push(
            format_args!("panel[{i}].random.stagger"),
            what,
            format!("0 … {} m, half of the shortest brick", shortest / 2.0),
        );
    }
    // The first head joints of two courses both lie between the shortest and the longest brick.
    let range = r.length[1].si() - r.length[0].si();
    if r.stagger.si() > range * (1.0 + crate::wall::SLACK)
        && panel.courses.is_some_and(|c| c > 1)
        && r.width > r.length[1]
    {
        let what = format!("{} cannot be held over bricks of {} to {}", r.stagger, r.length[0], r.length[1]);
        let allowed = format!("0 … {} m, the range of the lengths", tidy(range));
        f.push(format_args!("panel[{i}].random.stagger"), what, allowed);
    }
    if let Some(error) = unfillable(panel, r) {
        f.add(error.key(format!("panel[{i}].random.width")));
    }
}

/// To a micrometre, for messages.
pub(crate) fn tidy(v: f64) -> f64 {
    (v * 1e6).round() / 1e6
}

/// The error when no whole number of bricks with mortar between them makes up the width.
fn unfillable(panel: &Panel, r: &RandomTexture) -> Option<InputError> {
    let (mortar, width) = (panel.mortar.head.si(), r.width.si());
    let [low, high] = r.length.map(|l| l.si() + mortar);
    // n pitches between low and high make up width + mortar; n is the largest number that can.
    let slack = 1.0 + crate::wall::SLACK;
    let n = ((width + mortar) / low * slack).floor();
    if n >= 1.0 && n * high * slack >= width + mortar {
        return None;
    }
    let (below, above) = (n * high - mortar, (n + 1.0) * low - mortar);
    let allowed = if n >= 1.0 {
        format!("up to {} m, or from {} m", tidy(below), tidy(above))
    } else {
        format!("from {} m", tidy(above))
    };
    let what = format!("no number of bricks of {} to {} makes up {}", r.length[0], r.length[1], r.width);
    Some(InputError::new(what).allowed(allowed))
}

fn arch(f: &mut Findings, i: usize, panel: &Panel) {
    let Some(a) = &panel.arch else {
        let what = "the key is missing: bond `arch` needs it";
        f.push(format_args!("panel[{i}].arch"), what, "{ span = …, rise = …, thickness = …, voussoirs = … }");
        return;
    };
    f.quantity(format_args!("panel[{i}].arch.span"), a.span, Bound::Above0);
    f.quantity(format_args!("panel[{i}].arch.rise"), a.rise, Bound::Above0);
    f.quantity(format_args!("panel[{i}].arch.thickness"), a.thickness, Bound::Above0);
    f.quantity(format_args!("panel[{i}].arch.springing"), a.springing, Bound::From0);
    let half = 0.5 * a.span.si();
    if a.rise.si() > half {
        let what = format!("{} is more than half the span", a.rise);
        f.push(format_args!("panel[{i}].arch.rise"), what, format!("above 0 m, up to {} m", tidy(half)));
    }
    if !(3..=1000).contains(&a.voussoirs) {
        f.push(format_args!("panel[{i}].arch.voussoirs"), format!("{} is out of range", a.voussoirs), "3 … 1,000");
    }
}

/// Names in joints, ties and outputs that are not those of blocks.
const MEANT_OTHERWISE: [&str; 3] = ["base", "top", "all"];

fn explicit(f: &mut Findings, i: usize, panel: &Panel) {
    if panel.blocks.is_empty() {
        f.push(format_args!("panel[{i}].block"), "the panel has no block", "at least one [[panel.block]]");
    }
    for (k, block) in panel.blocks.iter().enumerate() {
        let key = |name: &'static str| format!("panel[{i}].block[{k}].{name}");
        if block.course == 0 {
            f.push(key("course"), "0 is out of range", "from 1 at the bottom");
        }
        match block.corners.is_empty() {
            true => sides(f, &format!("panel[{i}].block[{k}]"), block),
            false => corners(f, &format!("panel[{i}].block[{k}]"), block),
        }
        if let Some(weight) = block.specific_weight {
            f.quantity(format_args!("panel[{i}].block[{k}].specific_weight"), weight, Bound::Above0);
        }
        a_name(f, key("id"), block.id.as_deref());
        if let Some(id) = &block.id {
            let what = || format!("`{id}` cannot be the name of a block");
            if id.is_empty() || id.contains(|c: char| c.is_whitespace() || c == '|' || c == ',') {
                f.push(key("id"), what(), "a text without blanks, `|` and commas");
            } else if MEANT_OTHERWISE.contains(&id.as_str()) {
                f.push(key("id"), what(), "another name: `base`, `top` and `all` mean something else");
            }
        }
    }
    courses_in_use(f, i, panel);
}

fn sides(f: &mut Findings, key: &str, block: &ExplicitBlock) {
    for (name, value, bound) in [
        ("x", block.x, Bound::Finite),
        ("y", block.y, Bound::From0),
        ("length", block.length, Bound::Above0),
        ("height", block.height, Bound::Above0),
    ] {
        match value {
            Some(v) => f.quantity(format_args!("{key}.{name}"), v, bound),
            None => {
                let what = "the key is missing: a block has `x`, `y`, `length` and `height`, or `corners`";
                f.push(format_args!("{key}.{name}"), what, bound.text(" m"));
            }
        }
    }
}

/// Corners of a convex block.
fn corners(f: &mut Findings, key: &str, block: &ExplicitBlock) {
    let given = [("x", block.x), ("y", block.y), ("length", block.length), ("height", block.height)];
    if let Some((name, _)) = given.iter().find(|(_, value)| value.is_some()) {
        let what = "the block has `corners`, which say where it is";
        f.push(format_args!("{key}.{name}"), what, "`corners`, or `x`, `y`, `length` and `height`");
    }
    let before = f.list.len();
    if !(3..=16).contains(&block.corners.len()) {
        let what = format!("the block has {} corners", block.corners.len());
        f.push(format_args!("{key}.corners"), what, "3 to 16");
    }
    for (n, [x, y]) in block.corners.iter().enumerate() {
        f.quantity(format_args!("{key}.corners[{n}]"), *x, Bound::Finite);
        f.quantity(format_args!("{key}.corners[{n}]"), *y, Bound::From0);
    }
    if f.list.len() > before {
        return;
    }
    if let Err(n) = crate::polygon::convex(&block.outline()) {
        let what = "the block is not convex: it turns the wrong way, or not at all, at this corner";
        f.push(format_args!("{key}.corners[{n}]"), what, "corners in their order round a convex block");
    }
}

fn courses_in_use(f: &mut Findings, i: usize, panel: &Panel) {
    let mut courses: Vec<usize> = panel.blocks.iter().map(|b| b.course).collect();
    courses.sort_unstable();
    courses.dedup();
    let gap = courses.iter().zip(1..).find(|(course, wanted)| **course != *wanted);
    if let Some((course, wanted)) = gap
        && *course > 0
    {
        let what = format!("course {wanted} has no block, course {course} has");
        f.push(format_args!("panel[{i}].block"), what, "courses numbered 1, 2, 3, … without a gap");
    }
}
