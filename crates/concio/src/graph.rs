//! Blocks → joints, from geometry alone; and the vertical load that each joint carries (theory, sections 1 and 3).

use crate::case::{JointKind, NormalForce};
use crate::pattern::CONTACT_TOLERANCE;
use crate::wall::{Block, End, Joint, Wall};

/// Finds all joints: base, then course by course bed and head joints of each panel, then connections, then the
/// joints of a top beam if there is one. The order is part of the result format.
pub fn joints(wall: &Wall, beam: bool) -> Vec<Joint> {
    let courses = courses(wall);
    let mut joints = Vec::new();
    for (panel, rows) in courses.iter().enumerate() {
        let reference = wall.panels[panel].reference_length;
        for &i in rows.first().into_iter().flatten() {
            joints.push(support(wall, i, JointKind::Base, End::Base));
        }
        for (r, row) in rows.iter().enumerate() {
            heads(wall, row, wall.panels[panel].mortar[1] + CONTACT_TOLERANCE * reference, &mut joints);
            if let Some(above) = rows.get(r + 1) {
                beds(wall, row, above, reference, &mut joints);
            }
        }
    }
    for (left, pair) in courses.windows(2).enumerate() {
        connections(wall, left, &pair[0], &pair[1], &mut joints);
    }
    if beam {
        for (_, rows) in
            courses.iter().enumerate().filter(|(panel, _)| below_beam(wall, *panel) <= packing(wall, *panel))
        {
            for &i in rows.last().into_iter().flatten() {
                joints.push(support(wall, i, JointKind::Top, End::Top));
            }
        }
    }
    // They stay as long as the model does.
    joints.shrink_to_fit();
    joints
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

/// Block indices by panel and course, from left to right.
pub fn courses(wall: &Wall) -> Vec<Vec<Vec<usize>>> {
    let mut rows: Vec<Vec<Vec<usize>>> = wall.panels.iter().map(|p| vec![Vec::new(); p.courses]).collect();
    for (i, block) in wall.blocks.iter().enumerate() {
        rows[block.panel][block.course].push(i);
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

/// Neighbours in a course. A gap wider than the mortar is an opening, not a joint.
fn heads(wall: &Wall, row: &[usize], widest: f64, joints: &mut Vec<Joint>) {
    for pair in row.windows(2) {
        let (left, right) = (&wall.blocks[pair[0]], &wall.blocks[pair[1]]);
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
fn beds(wall: &Wall, below: &[usize], above: &[usize], reference: f64, joints: &mut Vec<Joint>) {
    let (mut i, mut j) = (0, 0);
    while i < below.len() && j < above.len() {
        let (low, high) = (&wall.blocks[below[i]], &wall.blocks[above[j]]);
        let x = [low.x[0].max(high.x[0]), low.x[1].min(high.x[1])];
        let overlap = x[1] - x[0];
        if overlap > CONTACT_TOLERANCE * reference {
            let y = 0.5 * (low.y[1] + high.y[0]);
            joints.push(Joint {
                kind: JointKind::Bed,
                a: below[i],
                b: End::Block(above[j]),
                weight: 2.0 * overlap / reference,
                overlap,
                line: [x[0], y, x[1], y],
            });
        }
        if low.x[1] < high.x[1] {
            i += 1;
        } else {
            j += 1;
        }
    }
}

/// Joints between the last blocks of one panel and the first of the next, where their heights overlap; the weight
/// is that height over the left panel's brick height, so that equal courses have weight 1. Where a course stands back
/// by more than the connection's thickness (toothed ends) there is air and no joint.
fn connections(wall: &Wall, panel: usize, left: &[Vec<usize>], right: &[Vec<usize>], joints: &mut Vec<Joint>) {
    let reference = wall.panels[panel].reference_height;
    let widest = wall.panels[panel + 1].connection + CONTACT_TOLERANCE * wall.panels[panel].reference_length;
    let (mut r, mut s) = (0, 0);
    while r < left.len() && s < right.len() {
        let (Some(&i), Some(&j)) = (left[r].last(), right[s].first()) else {
            // An empty course cannot be joined; pass over it.
            if left[r].is_empty() {
                r += 1
            } else {
                s += 1
            }
            continue;
        };
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

/// The report's 3.1: every joint of block i carries w (m_i g + P0_i) in block i's equation, with
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
