//! A wall with its joints drawn by how often they crack, and the lines that they form.

use concio::case::JointKind;
use concio::model::Model;
use concio::wall::Block;
use concio_study::crack_lines::{CrackLine, Group, meet};

use crate::draw::chart::LETTERS;
use crate::draw::output::Drawing;
use crate::draw::svg::{Anchor, Canvas, closed, line, px, rectangle};
use crate::draw::wall::{LIGHT, ground, shade};
use crate::format::significant;

/// Width of a map [pt], and its greatest height over it.
const WIDTH: f64 = 250.0;
const TALLEST: f64 = 1.2;
/// Room around a wall: sides, above, below [pt].
const MARGIN: [f64; 3] = [10.0, 26.0, 30.0];
/// Widest crack [pt].
const WIDEST: f64 = 4.5;
/// Lines that bear a number on the map.
const MOST_NAMED: usize = 9;

struct View {
    /// Left, bottom, right, top of the wall [m].
    bounds: [f64; 4],
    scale: f64,
    left: f64,
    bottom: f64,
}

impl View {
    fn point(&self, x: f64, y: f64) -> [f64; 2] {
        [self.left + (x - self.bounds[0]) * self.scale, self.bottom - (y - self.bounds[1]) * self.scale]
    }

    fn line(&self, [x0, y0, x1, y1]: [f64; 4]) -> String {
        let ([ax, ay], [bx, by]) = (self.point(x0, y0), self.point(x1, y1));
        line([ax, ay, bx, by])
    }

    fn outline(&self, block: &Block) -> String {
        closed(&block.corners().iter().map(|&[x, y]| self.point(x, y)).collect::<Vec<_>>())
    }
}

/// One map per group, side by side.
pub fn maps(model: &Model, groups: &[Group]) -> Drawing {
    const NOWHERE: [f64; 4] = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let bounds = model
        .wall
        .blocks
        .iter()
        .fold(NOWHERE, |b, k| [b[0].min(k.x[0]), b[1].min(k.y[0]), b[2].max(k.x[1]), b[3].max(k.y[1])]);
    let extent = [(bounds[2] - bounds[0]).max(1e-9), (bounds[3] - bounds[1]).max(1e-9)];
    let scale = ((WIDTH - 2.0 * MARGIN[0]) / extent[0]).min(TALLEST * WIDTH / extent[1]);
    let high = extent[1] * scale + MARGIN[1] + MARGIN[2];
    let columns = groups.len().clamp(1, 2);
    let mut canvas = Canvas::default();
    for (k, group) in groups.iter().enumerate() {
        let [x, y] = [(k % columns) as f64 * WIDTH, (k / columns) as f64 * high];
        let left = x + 0.5 * (WIDTH - extent[0] * scale);
        let view = View { bounds, scale, left, bottom: y + high - MARGIN[2] };
        let said = format!("{}: {} runs, {} with cracks", group.name, group.runs, group.cracked);
        let size = f64::from(LETTERS[1]);
        canvas.text([x + 0.5 * WIDTH, y + 3.0 + 0.5 * size], size, Anchor::Middle, false, "#000", &said);
        map(&mut canvas, &view, model, group);
    }
    let rows = groups.len().div_ceil(columns);
    let size = [columns as f64 * WIDTH, rows as f64 * high + 14.0];
    colours(&mut canvas, size);
    Drawing { body: canvas.into_body(), size, title: "Joints by how often they crack".into(), note: String::new() }
}

fn map(canvas: &mut Canvas, view: &View, model: &Model, group: &Group) {
    let wall = &model.wall;
    let blocks: String = wall.blocks.iter().map(|b| view.outline(b)).collect();
    canvas.path(&blocks, &format!(r##"fill="{LIGHT}" stroke="#b4b4b4" stroke-width="0.35""##), None);
    let ([left, base], [right, top]) =
        (view.point(view.bounds[0], view.bounds[1]), view.point(view.bounds[2], view.bounds[3]));
    ground(canvas, [left, right, base], 0.65);
    if model.joints.iter().any(|j| j.kind == JointKind::Top) {
        let beam = rectangle([left, top - 7.5, right, top - 2.5]);
        canvas.path(&beam, r##"fill="#e6e6e6" stroke="#8c8c8c" stroke-width="0.4""##, None);
    }
    // Lines have a dark edge, closed where joints meet across a corner.
    for chain in &group.lines {
        let frequency = |e: usize| group.joints.iter().find(|j| j.joint == e).map_or(0.0, |j| j.frequency);
        let mut edge: String = chain.joints.iter().map(|e| view.line(model.joints[*e].line)).collect();
        edge.push_str(&corners(view, model, chain));
        let most = chain.joints.iter().map(|e| frequency(*e)).fold(0.0, f64::max);
        let width = px(width(most) + 1.6);
        canvas.path(
            &edge,
            &format!(r##"fill="none" stroke="#222" stroke-width="{width}" stroke-linecap="round""##),
            None,
        );
    }
    let mut order: Vec<_> = group.joints.iter().filter(|j| j.cracked > 0).collect();
    order.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    for joint in order {
        let f = joint.frequency;
        let said = format!("{}: {}", concio::graph::name(wall, &model.joints[joint.joint]), significant(f, 3));
        let attributes = format!(r#"fill="none" stroke="{}" stroke-width="{}""#, shade(f), px(width(f)));
        canvas.path(&view.line(model.joints[joint.joint].line), &attributes, Some(&said));
    }
    for (k, chain) in group.lines.iter().enumerate().take(MOST_NAMED) {
        let [x0, y0, x1, y1] = chain.reach;
        let [x, y] = view.point(0.5 * (x0 + x1), 0.5 * (y0 + y1));
        canvas.open_halo();
        canvas.text([x, y], f64::from(LETTERS[1]), Anchor::Middle, false, "#000", &format!("L{}", k + 1));
        canvas.raw("</g>");
    }
}

fn width(frequency: f64) -> f64 {
    0.5 + (WIDEST - 0.5) * frequency
}

/// Short strokes from end to end where joints of a line meet across mortar.
fn corners(view: &View, model: &Model, chain: &CrackLine) -> String {
    let ends = |e: usize| {
        let l = model.joints[e].line;
        [[l[0], l[1]], [l[2], l[3]]]
    };
    let apart = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let mut strokes = String::new();
    for (k, &a) in chain.joints.iter().enumerate() {
        for &b in &chain.joints[k + 1..] {
            if !meet(&model.wall, &model.joints[a], &model.joints[b]) {
                continue;
            }
            let pairs = ends(a).into_iter().flat_map(|p| ends(b).map(|q| (p, q)));
            if let Some((p, q)) = pairs.min_by(|s, t| apart(s.0, s.1).total_cmp(&apart(t.0, t.1))) {
                strokes.push_str(&view.line([p[0], p[1], q[0], q[1]]));
            }
        }
    }
    strokes
}

/// What colours and widths stand for.
fn colours(canvas: &mut Canvas, size: [f64; 2]) {
    let (small, y) = (f64::from(LETTERS[0]), size[1] - 12.0);
    let x = 0.5 * size[0] - 100.0;
    let steps = 25;
    for k in 0..steps {
        let f = (f64::from(k) + 0.5) / f64::from(steps);
        let at = [x + 4.0 * f64::from(k), x + 4.0 * f64::from(k + 1) + 0.2];
        let half = 0.5 * width(f);
        canvas.path(&rectangle([at[0], y - half, at[1], y + half]), &format!(r#"fill="{}""#, shade(f)), None);
    }
    canvas.text([x - 3.0, y], small, Anchor::End, false, "#000", "0");
    canvas.text([x + 103.0, y], small, Anchor::Start, false, "#000", "1: cracks in this share of the runs");
}
