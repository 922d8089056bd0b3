//! Walls side by side, their joints coloured by values, some of them marked.

use concio::wall::{Joint, Wall};

use crate::draw::chart::LETTERS;
use crate::draw::font;
use crate::draw::output::Drawing;
use crate::draw::svg::{Anchor, Canvas, closed, line, px, rectangle};
use crate::draw::wall::{LIGHT, ground, shade};
use crate::format::significant;

/// Width of a map [pt], its greatest height over it, and the room at its sides, above and below [pt].
const WIDTH: f64 = 255.0;
const TALLEST: f64 = 1.1;
const MARGIN: [f64; 3] = [10.0, 16.0, 12.0];
/// Colour of marks and their width beyond the joint [pt].
const MARK: (&str, f64) = ("#0b2545", 3.2);
/// Width of the paper between a mark and the colour of its joint, beyond the joint [pt].
const INSIDE: f64 = 1.8;

/// A wall to draw.
#[derive(Debug)]
pub struct Map {
    /// Line above it.
    pub heading: String,
    /// Per joint, 0 … 1.
    pub values: Vec<f64>,
    /// Joints that are marked.
    pub marked: Vec<usize>,
}

struct View {
    /// Left, bottom of the wall [m].
    origin: [f64; 2],
    scale: f64,
    /// Where that is on the paper [pt].
    at: [f64; 2],
}

impl View {
    fn point(&self, x: f64, y: f64) -> [f64; 2] {
        [self.at[0] + (x - self.origin[0]) * self.scale, self.at[1] - (y - self.origin[1]) * self.scale]
    }
}

/// Draws the maps, two in a row; `label` says what the colours are, empty where they are nothing.
pub fn draw(wall: &Wall, joints: &[Joint], names: &[String], maps: &[Map], title: &str, label: &str) -> Drawing {
    let nowhere = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let bounds = wall
        .blocks
        .iter()
        .fold(nowhere, |b, k| [b[0].min(k.x[0]), b[1].min(k.y[0]), b[2].max(k.x[1]), b[3].max(k.y[1])]);
    let extent = [(bounds[2] - bounds[0]).max(1e-9), (bounds[3] - bounds[1]).max(1e-9)];
    let scale = ((WIDTH - 2.0 * MARGIN[0]) / extent[0]).min(TALLEST * WIDTH / extent[1]);
    let high = extent[1] * scale + MARGIN[1] + MARGIN[2];
    let columns = maps.len().clamp(1, 2);
    let mut canvas = Canvas::default();
    for (k, one) in maps.iter().enumerate() {
        let corner = [(k % columns) as f64 * WIDTH, (k / columns) as f64 * high];
        let left = corner[0] + 0.5 * (WIDTH - extent[0] * scale);
        let view = View { origin: [bounds[0], bounds[1]], scale, at: [left, corner[1] + high - MARGIN[2]] };
        let size = fitting(&one.heading);
        let above = [corner[0] + 0.5 * WIDTH, corner[1] + 3.0 + 0.5 * size];
        canvas.text(above, size, Anchor::Middle, false, "#000", &one.heading);
        map(&mut canvas, &view, (wall, joints, names), one);
        let [x0, y0] = view.point(bounds[0], bounds[1]);
        ground(&mut canvas, [x0, view.point(bounds[2], 0.0)[0], y0], 0.65);
    }
    let width = columns as f64 * WIDTH;
    let bottom = legend(&mut canvas, width, maps.len().div_ceil(columns) as f64 * high, maps, label);
    Drawing { body: canvas.into_body(), size: [width, bottom], title: title.into(), note: String::new() }
}

/// The size of letters at which a heading fits above its map.
fn fitting(heading: &str) -> f64 {
    let size = f64::from(LETTERS[1]);
    size * ((WIDTH - 6.0) / font::width(heading, size)).min(1.0)
}

fn map(canvas: &mut Canvas, view: &View, (wall, joints, names): (&Wall, &[Joint], &[String]), one: &Map) {
    let outline =
        |b: &concio::wall::Block| closed(&b.corners().iter().map(|&[x, y]| view.point(x, y)).collect::<Vec<_>>());
    let blocks: String = wall.blocks.iter().map(outline).collect();
    canvas.path(&blocks, &format!(r##"fill="{LIGHT}" stroke="#b4b4b4" stroke-width="0.35""##), None);
    let value = |e: usize| one.values.get(e).copied().unwrap_or(0.0);
    let coloured = one.values.iter().any(|v| *v > 0.0);
    let width = (0.012 * view.scale).clamp(1.0, 2.6);
    // Large values lie on top.
    let mut order: Vec<usize> = (0..joints.len()).collect();
    order.sort_by(|&a, &b| value(a).total_cmp(&value(b)));
    let mut stroke = |e: usize, colour: &str, width: f64, title: Option<&str>| {
        let [x0, y0, x1, y1] = joints[e].line;
        let ([ax, ay], [bx, by]) = (view.point(x0, y0), view.point(x1, y1));
        let attributes = format!(r#"fill="none" stroke="{colour}" stroke-width="{}""#, px(width));
        canvas.path(&line([ax, ay, bx, by]), &attributes, title);
    };
    one.marked.iter().for_each(|&e| stroke(e, MARK.0, width + MARK.1, names.get(e).map(String::as_str)));
    if coloured {
        // An outline: a solid mark would drown the colours of its joint and of those beside it.
        one.marked.iter().for_each(|&e| stroke(e, "#fff", width + INSIDE, None));
    }
    for e in order {
        let title = names.get(e).map(|n| format!("{n}: {}", significant(value(e), 3)));
        if coloured {
            stroke(e, "#6e6e6e", width + 0.5, None);
            stroke(e, &shade(value(e)), width, title.as_deref());
        } else if !one.marked.contains(&e) {
            stroke(e, "#9a9a9a", 0.5 * width, names.get(e).map(String::as_str));
        }
    }
}

/// What colours and marks are; where it ends [pt].
fn legend(canvas: &mut Canvas, width: f64, top: f64, maps: &[Map], label: &str) -> f64 {
    let size = f64::from(LETTERS[1]);
    let (y, mut x) = (top + 5.0, MARGIN[0]);
    if !label.is_empty() {
        let (long, high, steps) = (110.0, 6.0, 60);
        for k in 0..steps {
            let at = |k: usize| x + 8.0 + long * k as f64 / f64::from(steps as u32);
            let fill = shade((k as f64 + 0.5) / f64::from(steps as u32));
            canvas.path(&rectangle([at(k), y, at(k + 1) + 0.2, y + high]), &format!(r#"fill="{fill}""#), None);
        }
        canvas.text([x, y + 3.0], size, Anchor::Start, false, "#000", "0");
        let text = format!("1  {label}");
        canvas.text([x + long + 11.0, y + 3.0], size, Anchor::Start, false, "#000", &text);
        x += long + 11.0 + font::width(&text, size) + 16.0;
    }
    if maps.iter().any(|m| !m.marked.is_empty()) {
        let mark = format!(r#"fill="none" stroke="{}" stroke-width="{}""#, MARK.0, px(1.2 + MARK.1));
        let wide = 18.0 + font::width("replaced or listed", size);
        let (x, y) = if x + wide > width { (MARGIN[0], y + 12.0) } else { (x, y) };
        canvas.path(&line([x, y + 3.0, x + 14.0, y + 3.0]), &mark, None);
        if !label.is_empty() {
            let inside = format!(r##"fill="none" stroke="#fff" stroke-width="{}""##, px(1.2 + INSIDE));
            canvas.path(&line([x, y + 3.0, x + 14.0, y + 3.0]), &inside, None);
        }
        let text = if label.is_empty() { "replaced" } else { "listed" };
        canvas.text([x + 18.0, y + 3.0], size, Anchor::Start, false, "#000", text);
        return y + 14.0;
    }
    y + 14.0
}
