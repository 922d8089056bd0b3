//! Blocks → joints, from geometry alone; and the vertical load that each joint carries (theory, sections 1 and 3).

use std::collections::HashSet;
use std::ops::Range;

use crate::case::{JointKind, NormalForce};
use crate::polygon::{facing, of_box};
use crate::wall::CONTACT_TOLERANCE;
use crate::wall::{Block, End, Joint, Wall};

/// Finds all joints: base, then course by course bed and head joints of each panel, then connections, then the
/// joints of a top beam if there is one. The order is part of the result format.
pub fn joints(wall: &Wall, beam: bool) -> Vec<Joint> {
    let courses = standing(wall);
    let mut joints = Vec::new();
    let shaped: Vec<bool> = shaped(wall);
    for (panel, rows) in courses.iter().enumerate() {
        let reference = wall.panels[panel].reference_length;
        if shaped[panel] {
            polygons(wall, panel, &mut joints);
            continue;
        }
        for &i in rows.first().into_iter().flatten() {
            joints.push(support(wall, i, JointKind::Base, End::Base));
        }
        for (r, row) in rows.iter().enumerate() {
            heads(wall, r, row, wall.panels[panel].mortar[1] + CONTACT_TOLERANCE * reference, &mut joints);
            if let Some(above) = rows.get(r + 1) {
                let ends = |i: &&usize| wall.blocks[**i].course == r;
                let begins = |i: &&usize| wall.blocks[**i].lowest_course() == r + 1;
                beds(wall, row.iter().filter(ends), above.iter().filter(begins), reference, &mut joints);
            }
        }
        if uneven(wall, rows, reference) {
            through(wall, panel, &mut joints);
        }
    }
    for (left, pair) in courses.windows(2).enumerate() {
        if shaped[left] || shaped[left + 1] {
            polygon_connections(wall, left, &mut joints);
        } else {
            connections(wall, left, &pair[0], &pair[1], &mut joints);
        }
    }
    if beam {
        for (panel, rows) in
            courses.iter().enumerate().filter(|(panel, _)| below_beam(wall, *panel) <= packing(wall, *panel))
        {
            for &i in rows.last().into_iter().flatten() {
                match shaped[panel] {
                    true => joints.extend(side(wall, i, JointKind::Top, End::Top)),
                    false => joints.push(support(wall, i, JointKind::Top, End::Top)),
                }
            }
        }
    }
    // They stay as long as the model does.
    joints.shrink_to_fit();
    joints
}

/// Whether a block of a panel of rectangles reaches up beside blocks of a higher course, as a through stone does that stands beside two courses.
fn uneven(wall: &Wall, rows: &[Vec<usize>], reference: f64) -> bool {
    let mut highest = f64::NEG_INFINITY;
    for row in rows {
        // Lintels have their courses.
        let own = || row.iter().map(|&i| &wall.blocks[i]).filter(|block| block.lowest_course() == block.course);
        let low = own().map(|block| block.y[0]).fold(f64::INFINITY, f64::min);
        if low < highest - CONTACT_TOLERANCE * reference {
            return true;
        }
        highest = own().map(|block| block.y[1]).fold(highest, f64::max);
    }
    false
}

/// Joints of such blocks that courses do not show: those between sides that face each other.
fn through(wall: &Wall, panel: usize, joints: &mut Vec<Joint>) {
    let known: HashSet<(usize, usize)> = joints
        .iter()
        .filter_map(|j| if let End::Block(b) = j.b { Some((j.a.min(b), j.a.max(b))) } else { None })
        .collect();
    let info = &wall.panels[panel];
    let mut order: Vec<usize> = (0..wall.blocks.len()).filter(|&i| wall.blocks[i].panel == panel).collect();
    order.sort_by(|&i, &j| wall.blocks[i].x[0].total_cmp(&wall.blocks[j].x[0]));
    let widest = info.mortar[0].max(info.mortar[1]) + ROUGH * info.reference_length;
    for (k, &i) in order.iter().enumerate() {
        let beside = order[k + 1..].iter().take_while(|&&j| wall.blocks[j].x[0] <= wall.blocks[i].x[1] + widest);
        let new = beside.filter(|&&j| !known.contains(&(i.min(j), i.max(j))));
        joints.extend(new.filter_map(|&j| between(wall, i, j, None)));
    }
}

/// Which panels have blocks that are not rectangles: their joints are found by the sides that face each other, without
/// regard to courses.
fn shaped(wall: &Wall) -> Vec<bool> {
    let mut shaped = vec![false; wall.panels.len()];
    for block in wall.blocks.iter().filter(|b| !b.is_rectangle()) {
        shaped[block.panel] = true;
    }
    shaped
}

/// Base joints, and the joints between blocks of a panel from left to right.
fn polygons(wall: &Wall, panel: usize, joints: &mut Vec<Joint>) {
    let info = &wall.panels[panel];
    let mut order: Vec<usize> = (0..wall.blocks.len()).filter(|&i| wall.blocks[i].panel == panel).collect();
    // As elsewhere the lowest blocks lie on the base at whatever height.
    let lowest = order.iter().map(|&i| wall.blocks[i].y[0]).fold(f64::INFINITY, f64::min);
    for &i in &order {
        let on_base = side(wall, i, JointKind::Base, End::Base);
        joints.extend(on_base.filter(|j| j.line[1] <= lowest.max(info.mortar[0]) + ROUGH * info.reference_length));
    }
    order.sort_by(|&i, &j| wall.blocks[i].x[0].total_cmp(&wall.blocks[j].x[0]));
    let widest = info.mortar[0].max(info.mortar[1]);
    for (k, &i) in order.iter().enumerate() {
        let reach = wall.blocks[i].x[1] + widest + ROUGH * info.reference_length;
        for &j in order[k + 1..].iter().take_while(|&&j| wall.blocks[j].x[0] <= reach) {
            joints.extend(between(wall, i, j, None));
        }
    }
}

fn polygon_connections(wall: &Wall, left: usize, joints: &mut Vec<Joint>) {
    let of = |panel: usize| (0..wall.blocks.len()).filter(move |&i| wall.blocks[i].panel == panel);
    let right: Vec<usize> = of(left + 1).collect();
    for i in of(left) {
        joints.extend(right.iter().filter_map(|&j| between(wall, i, j, Some(wall.panels[left + 1].connection))));
    }
}

/// Gaps and overlaps of this part of L_ref beside the mortar count as none where blocks are polygons: their corners are
/// often written in millimetres.
const ROUGH: f64 = 4e-3;

/// The joint between two blocks by the sides that face each other: bed or head by its slope, within 45° of the horizontal
/// or not; with `connection`, the width of the gap between their panels [m], that.
fn between(wall: &Wall, i: usize, j: usize, connection: Option<f64>) -> Option<Joint> {
    let (a, b) = (&wall.blocks[i], &wall.blocks[j]);
    let info = &wall.panels[a.panel];
    let rough = ROUGH * info.reference_length;
    // Of the many pairs of a large wall most are told apart by their boxes.
    let most = connection.unwrap_or(info.mortar[0].max(info.mortar[1])) + 2.0 * rough;
    let apart = |a: [f64; 2], b: [f64; 2]| a[0].max(b[0]) - a[1].min(b[1]) > most;
    if apart(a.x, b.x) || apart(a.y, b.y) {
        return None;
    }
    let widest = |normal: [f64; 2]| connection.unwrap_or(info.mortar[usize::from(normal[0].abs() > normal[1].abs())]);
    let allows = |normal: [f64; 2], gap: f64| (-rough..=widest(normal) + rough).contains(&gap);
    let found = facing(&a.corners(), &b.corners(), CONTACT_TOLERANCE * info.reference_length, allows)?;
    let [across, up] = found.normal;
    let level = up.abs() >= across.abs();
    let kind = match connection {
        Some(_) => JointKind::Connection,
        None if level => JointKind::Bed,
        None => JointKind::Head,
    };
    let forwards = if level && connection.is_none() { up > 0.0 } else { across > 0.0 };
    let [a, b] = if forwards || connection.is_some() { [i, j] } else { [j, i] };
    let mut ends = found.ends;
    let axis = usize::from(!level);
    if ends[0][axis] > ends[1][axis] {
        ends.swap(0, 1);
    }
    // Head joints are whole ones, as those between rectangles (theory, section 1).
    let weight = match kind {
        JointKind::Bed => found.length / (0.5 * info.reference_length),
        JointKind::Connection => found.length / info.reference_height,
        _ => 1.0,
    };
    let line = [ends[0][0], ends[0][1], ends[1][0], ends[1][1]];
    Some(Joint { kind, a, b: End::Block(b), weight, overlap: found.length, line })
}

/// The joint of a polygon's level side with base or beam.
fn side(wall: &Wall, i: usize, kind: JointKind, b: End) -> Option<Joint> {
    let block = &wall.blocks[i];
    let reference = wall.panels[block.panel].reference_length;
    let ([x0, x1], far) = (block.x, block.height() + reference);
    let other = match kind {
        JointKind::Base => of_box([x0, x1], [block.y[0] - far, block.y[0]]),
        _ => of_box([x0, x1], [block.y[1], block.y[1] + far]),
    };
    let touches = |_: [f64; 2], gap: f64| gap.abs() <= ROUGH * reference;
    let found = facing(&block.corners(), &other, CONTACT_TOLERANCE * reference, touches)?;
    let level = found.normal[1].abs() >= found.normal[0].abs();
    let [[from, y], [to, _]] = found.ends;
    let line = [from.min(to), y, from.max(to), y];
    level.then_some(Joint { kind, a: i, b, weight: 2.0 * found.length / reference, overlap: found.length, line })
}

/// How far the top of a panel lies below the level of the beam, which lies on the highest panel [m].
pub fn below_beam(wall: &Wall, panel: usize) -> f64 {
    let top = |panel: Option<usize>| {
        let of_panel = wall.blocks.iter().filter(|b| panel.is_none_or(|p| b.panel == p));
        of_panel.map(|b| b.y[1]).fold(f64::NEG_INFINITY, f64::max)
    };
    top(None) - top(Some(panel))
}

/// A gap under the beam up to half a brick's height is packed with mortar and carries; a wider one is air [m].
pub fn packing(wall: &Wall, panel: usize) -> f64 {
    0.5 * wall.panels[panel].reference_height
}

/// q of each panel [N/m]: under a beam only the panels that it lies on are loaded.
fn loads(wall: &Wall, load: f64, beam: bool) -> Vec<f64> {
    let carries = |panel: usize| !beam || below_beam(wall, panel) <= packing(wall, panel);
    (0..wall.panels.len()).map(|panel| if carries(panel) { load } else { 0.0 }).collect()
}

/// Block indices by panel and course, from left to right; a lintel stands in the topmost of its courses.
pub fn courses(wall: &Wall) -> Vec<Vec<Vec<usize>>> {
    rows(wall, |block| block.course..block.course + 1)
}

/// The same with lintels in all of their courses.
fn standing(wall: &Wall) -> Vec<Vec<Vec<usize>>> {
    rows(wall, |block| block.lowest_course()..block.course + 1)
}

fn rows(wall: &Wall, of: impl Fn(&Block) -> Range<usize>) -> Vec<Vec<Vec<usize>>> {
    let mut rows: Vec<Vec<Vec<usize>>> = wall.panels.iter().map(|p| vec![Vec::new(); p.courses]).collect();
    for (i, block) in wall.blocks.iter().enumerate() {
        for r in of(block) {
            rows[block.panel][r].push(i);
        }
    }
    for row in rows.iter_mut().flatten() {
        row.sort_by(|&i, &j| wall.blocks[i].x[0].total_cmp(&wall.blocks[j].x[0]));
    }
    rows
}

fn support(wall: &Wall, i: usize, kind: JointKind, b: End) -> Joint {
    let block = &wall.blocks[i];
    let y = if kind == JointKind::Base { block.y[0] } else { block.y[1] };
    let overlap = block.length();
    Joint {
        kind,
        a: i,
        b,
        weight: 2.0 * overlap / wall.panels[block.panel].reference_length,
        overlap,
        line: [block.x[0], y, block.x[1], y],
    }
}

/// Neighbours in course `r`. A gap wider than the mortar is an opening, not a joint. Lintels beside each other share one
/// joint, in the lowest course that both take up.
fn heads(wall: &Wall, r: usize, row: &[usize], widest: f64, joints: &mut Vec<Joint>) {
    for pair in row.windows(2) {
        let (left, right) = (&wall.blocks[pair[0]], &wall.blocks[pair[1]]);
        if left.lowest_course().max(right.lowest_course()) < r {
            continue;
        }
        let y = [left.y[0].max(right.y[0]), left.y[1].min(right.y[1])];
        if right.x[0] - left.x[1] <= widest && y[1] > y[0] {
            joints.push(upright(JointKind::Head, pair[0], pair[1], left, right, y, 1.0));
        }
    }
}

fn upright(kind: JointKind, a: usize, b: usize, left: &Block, right: &Block, y: [f64; 2], weight: f64) -> Joint {
    let x = 0.5 * (left.x[1] + right.x[0]);
    Joint { kind, a, b: End::Block(b), weight, overlap: y[1] - y[0], line: [x, y[0], x, y[1]] }
}

/// Contacts between a course and the one above, by one sweep over both.
fn beds<'a>(
    wall: &Wall,
    mut below: impl Iterator<Item = &'a usize>,
    mut above: impl Iterator<Item = &'a usize>,
    reference: f64,
    joints: &mut Vec<Joint>,
) {
    let mut pair = (below.next(), above.next());
    while let (Some(&i), Some(&j)) = pair {
        let (low, high) = (&wall.blocks[i], &wall.blocks[j]);
        let x = [low.x[0].max(high.x[0]), low.x[1].min(high.x[1])];
        let overlap = x[1] - x[0];
        if overlap > CONTACT_TOLERANCE * reference {
            let y = 0.5 * (low.y[1] + high.y[0]);
            joints.push(Joint {
                kind: JointKind::Bed,
                a: i,
                b: End::Block(j),
                weight: 2.0 * overlap / reference,
                overlap,
                line: [x[0], y, x[1], y],
            });
        }
        if low.x[1] < high.x[1] {
            pair.0 = below.next();
        } else {
            pair.1 = above.next();
        }
    }
}

/// Joints between the last blocks of one panel and the first of the next, where their heights overlap; the weight
/// is that height over the left panel's brick height, so that equal courses have weight 1. Where a course stands back
/// by more than the connection's thickness (toothed ends) there is air and no joint.
fn connections(wall: &Wall, panel: usize, left: &[Vec<usize>], right: &[Vec<usize>], joints: &mut Vec<Joint>) {
    let reference = wall.panels[panel].reference_height;
    let widest = wall.panels[panel + 1].connection + CONTACT_TOLERANCE * wall.panels[panel].reference_length;
    // A course without blocks cannot be joined; a lintel stands in several.
    let mut left: Vec<usize> = left.iter().filter_map(|row| row.last().copied()).collect();
    let mut right: Vec<usize> = right.iter().filter_map(|row| row.first().copied()).collect();
    left.dedup();
    right.dedup();
    let (mut r, mut s) = (0, 0);
    while r < left.len() && s < right.len() {
        let (i, j) = (left[r], right[s]);
        let (a, b) = (&wall.blocks[i], &wall.blocks[j]);
        let y = [a.y[0].max(b.y[0]), a.y[1].min(b.y[1])];
        if b.x[0] - a.x[1] <= widest && y[1] - y[0] > CONTACT_TOLERANCE * reference {
            let weight = (y[1] - y[0]) / reference;
            joints.push(upright(JointKind::Connection, i, j, a, b, y, weight));
        }
        if a.y[1] < b.y[1] { r += 1 } else { s += 1 }
    }
}

/// Name of a joint: its blocks, lower or left first (`p1c1b1|p1c2b1`, `base|p1c1b1`, `p1c6b4|top`).
pub fn name(wall: &Wall, joint: &Joint) -> String {
    let block = |i: usize| wall.blocks[i].name.as_str();
    match joint.b {
        End::Base => format!("base|{}", block(joint.a)),
        End::Top => format!("{}|top", block(joint.a)),
        End::Block(b) => format!("{}|{}", block(joint.a), block(b)),
    }
}

/// Normal force of each joint, in the equations of its two sides [N]: `[in a's, in b's]`. `load` is q [N/m], brought by
/// the beam where there is one.
pub fn normal_forces(wall: &Wall, joints: &[Joint], load: f64, beam: bool, from: NormalForce) -> Vec<[f64; 2]> {
    let loads = loads(wall, load, beam);
    match from {
        NormalForce::Transmitted => transmitted(wall, joints, &loads),
        NormalForce::Overburden => overburden(wall, joints, &loads),
    }
}

/// Weight and top load handed down course by course in proportion to the overlaps. Head joints carry nothing.
fn transmitted(wall: &Wall, joints: &[Joint], loads: &[f64]) -> Vec<[f64; 2]> {
    let mut below: Vec<Vec<usize>> = vec![Vec::new(); wall.blocks.len()];
    for (e, joint) in joints.iter().enumerate() {
        match (joint.kind, joint.b) {
            (JointKind::Base, _) => below[joint.a].push(e),
            (JointKind::Bed, End::Block(upper)) => below[upper].push(e),
            _ => {}
        }
    }
    let mut carried = vec![0.0; wall.blocks.len()];
    let mut forces = vec![[0.0; 2]; joints.len()];
    for (i, block) in wall.blocks.iter().enumerate() {
        if block.course + 1 == wall.panels[block.panel].courses {
            carried[i] = loads[block.panel] * block.length();
        }
    }
    for (e, joint) in joints.iter().enumerate() {
        if joint.kind == JointKind::Top {
            forces[e] = [carried[joint.a]; 2];
        }
    }
    for rows in courses(wall) {
        for &i in rows.iter().rev().flatten() {
            let total = carried[i] + wall.blocks[i].weight();
            let contact: f64 = below[i].iter().map(|&e| joints[e].overlap).sum();
            for &e in &below[i] {
                let share = total * joints[e].overlap / contact;
                forces[e] = [share; 2];
                if joints[e].kind == JointKind::Bed {
                    carried[joints[e].a] += share;
                }
            }
        }
    }
    forces
}

/// The research report's 3.1: every joint of block i carries w (m_i g + P0_i) in block i's equation, with
/// P0_i = q L_i + γ B L_i (y_max − y_i); y are centres of gravity, y_max that of the panel's top course.
fn overburden(wall: &Wall, joints: &[Joint], loads: &[f64]) -> Vec<[f64; 2]> {
    let centre = |b: &Block| 0.5 * (b.y[0] + b.y[1]);
    let mut highest = vec![f64::NEG_INFINITY; wall.panels.len()];
    for block in &wall.blocks {
        highest[block.panel] = highest[block.panel].max(centre(block));
    }
    let of = |i: usize| {
        let b = &wall.blocks[i];
        let above = b.specific_weight * b.thickness * b.length() * (highest[b.panel] - centre(b));
        b.weight() + loads[b.panel] * b.length() + above
    };
    let pair = |joint: &Joint| {
        let a = of(joint.a);
        let b = if let End::Block(b) = joint.b { of(b) } else { a };
        [joint.weight * a, joint.weight * b]
    };
    joints.iter().map(pair).collect()
}
