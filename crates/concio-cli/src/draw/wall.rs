//! The wall: bricks, mortar, joints, names, dimensions. Kinds of joint differ in dash pattern and values in
//! brightness, so that the drawing can be read in grey.

use concio::case::JointKind;
use concio::wall::{Block, Joint, Wall};

use super::scale::round_end;
use super::svg::{Anchor, Canvas, closed, line, px, rectangle};
use crate::format::{NOTHING, short, si};

/// Colour of bricks.
pub const BRICK: &str = "#f4d9c0";
/// Colour of joints that have no value.
const NONE: &str = "#b4b4b4";
/// Ties.
const TIE: &str = r##"fill="none" stroke="#2e7d32" stroke-width="2.2" stroke-dasharray="9 3""##;
/// Colour of bricks beside coloured joints.
pub const LIGHT: &str = "#fbf6f1";
/// Largest size of the wall itself [px].
const LARGEST: [f64; 2] = [820.0, 620.0];
/// Room around it for dimensions and legend [px]: left, top, right, bottom.
const MARGIN: [f64; 4] = [64.0, 40.0, 20.0, 104.0];
/// Blocks and joints up to which each is an element of its own, with its name under the mouse.
const DETAILED: usize = 1500;
/// Width of a letter over the size of the font, on the safe side for the usual sans-serif fonts.
const LETTER: f64 = 0.62;
/// Smallest and largest letters [px].
const LETTERS: [f64; 2] = [4.8, 13.0];
/// Shades in which values are drawn when elements are merged.
const SHADES: usize = 32;

/// The parts of a joint that has its value all along.
pub const WHOLE: [[f64; 2]; 2] = [[0.0, 1.0], [1.0; 2]];

/// A value per block or joint.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    /// What it is.
    pub title: &'a str,
    /// SI unit.
    pub unit: &'a str,
    /// The values, from 0; of joints not a number where there is none.
    pub values: &'a [f64],
    /// What a joint without value is.
    pub none: &'a str,
    /// The parts of each joint that have the value, from where to where, 0 … 1 along it; the rest has 0. Empty where all of it has.
    pub parts: &'a [[[f64; 2]; 2]],
}

/// What the colours stand for.
#[derive(Debug, Clone, Copy)]
pub enum Paint<'a> {
    /// Joints by kind, with the names of blocks and joints where they fit.
    Kinds,
    /// Blocks by a value.
    Blocks(Field<'a>),
    /// Joints by a value.
    Joints(Field<'a>),
}

/// A wall to draw.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// Its blocks.
    pub wall: &'a Wall,
    /// Its joints.
    pub joints: &'a [Joint],
    /// Their names.
    pub names: &'a [String],
    /// Where its ties begin and end [m].
    pub ties: &'a [[f64; 4]],
    /// What the top beam does, written on it.
    pub beam: &'a str,
}

/// Draws the wall as SVG.
pub fn draw(subject: &Subject, paint: Paint) -> String {
    let view = View::of(subject.wall);
    let mut canvas = Canvas::default();
    supports(&mut canvas, &view, subject);
    // In a large wall what does not carry the values would only hide them, at the cost of megabytes.
    let large = !is_detailed(subject);
    if large && matches!(paint, Paint::Joints(_)) {
        outlines(&mut canvas, &view, subject.wall);
    } else {
        mortar(&mut canvas, &view, subject.wall);
        blocks(&mut canvas, &view, subject, paint);
    }
    if !(large && matches!(paint, Paint::Blocks(_))) {
        joints(&mut canvas, &view, subject, paint);
    }
    for (number, tie) in subject.ties.iter().enumerate() {
        canvas.path(&line(view.line(*tie)), TIE, Some(&format!("tie {}", number + 1)));
    }
    if let Paint::Kinds = paint {
        joint_names(&mut canvas, &view, subject);
    }
    dimensions(&mut canvas, &view);
    match paint {
        Paint::Kinds => kind_legend(&mut canvas, &view, subject),
        Paint::Blocks(field) | Paint::Joints(field) => value_legend(&mut canvas, &view, &field),
    }
    let label = format!("wall of {} blocks and {} joints", subject.wall.blocks.len(), subject.joints.len());
    canvas.finish(view.size, &label)
}

/// Whether each block and joint is an element of its own.
fn is_detailed(subject: &Subject) -> bool {
    subject.wall.blocks.len() + subject.joints.len() <= DETAILED
}

/// From metres to pixels.
struct View {
    /// x0, y0, x1, y1 of the wall [m]; y0 is the base.
    bounds: [f64; 4],
    scale: f64,
    size: [f64; 2],
}

impl View {
    fn of(wall: &Wall) -> View {
        let mut b = [f64::INFINITY, 0.0, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for block in &wall.blocks {
            b = [b[0].min(block.x[0]), b[1].min(block.y[0]), b[2].max(block.x[1]), b[3].max(block.y[1])];
        }
        let extent = [(b[2] - b[0]).max(f64::MIN_POSITIVE), (b[3] - b[1]).max(f64::MIN_POSITIVE)];
        let scale = (LARGEST[0] / extent[0]).min(LARGEST[1] / extent[1]);
        // The legend needs its width even beside a slender wall.
        let width = (extent[0] * scale).max(440.0);
        let size = [width + MARGIN[0] + MARGIN[2], extent[1] * scale + MARGIN[1] + MARGIN[3]];
        View { bounds: b, scale, size }
    }
    fn x(&self, x: f64) -> f64 {
        MARGIN[0] + (x - self.bounds[0]) * self.scale
    }
    fn y(&self, y: f64) -> f64 {
        MARGIN[1] + (self.bounds[3] - y) * self.scale
    }
    /// Left, top, right, bottom of a rectangle given in metres.
    fn rectangle(&self, x: [f64; 2], y: [f64; 2]) -> [f64; 4] {
        [self.x(x[0]), self.y(y[1]), self.x(x[1]), self.y(y[0])]
    }
    /// Outline of a block, over its corners, as path data.
    fn outline(&self, block: &Block) -> String {
        closed(&block.corners().iter().map(|&[x, y]| [self.x(x), self.y(y)]).collect::<Vec<_>>())
    }
    fn line(&self, l: [f64; 4]) -> [f64; 4] {
        [self.x(l[0]), self.y(l[1]), self.x(l[2]), self.y(l[3])]
    }
}

fn supports(canvas: &mut Canvas, view: &View, subject: &Subject) {
    let [left, right, base] = [view.x(view.bounds[0]), view.x(view.bounds[2]), view.y(view.bounds[1])];
    ground(canvas, [left, right, base], 1.0);
    let tops = subject.joints.iter().filter(|j| j.kind == JointKind::Top);
    let ends = tops.fold([f64::INFINITY, f64::NEG_INFINITY], |e, j| [e[0].min(j.line[0]), e[1].max(j.line[2])]);
    if ends[0] < ends[1] {
        let top = view.y(view.bounds[3]) - 3.0;
        let beam = [view.x(ends[0]), top - 18.0, view.x(ends[1]), top];
        canvas.path(&rectangle(beam), r##"fill="#d8d8d8" stroke="#222" stroke-width="1""##, Some(subject.beam));
        label(canvas, beam, 11.0, false, "#111", subject.beam);
    }
}

/// The base under a wall from left to right; `size` makes the hatching coarser.
pub fn ground(canvas: &mut Canvas, [left, right, base]: [f64; 3], size: f64) {
    let mut hatch = line([left - 6.0 * size, base, right + 6.0 * size, base]);
    let mut x = left;
    while x <= right + 4.0 * size {
        hatch.push_str(&line([x, base, x - 6.0 * size, base + 7.0 * size]));
        x += 8.0 * size;
    }
    canvas.path(&hatch, &format!(r##"fill="none" stroke="#222" stroke-width="{}""##, px(size)), Some("base"));
}

/// A rectangle around each panel that is one.
fn outlines(canvas: &mut Canvas, view: &View, wall: &Wall) {
    for panel in 0..wall.panels.len() {
        let mut b = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        let of_panel = || wall.blocks.iter().filter(|b| b.panel == panel);
        if !of_panel().all(Block::is_rectangle) {
            continue;
        }
        for block in of_panel() {
            b = [b[0].min(block.x[0]), b[1].min(block.y[0]), b[2].max(block.x[1]), b[3].max(block.y[1])];
        }
        if b[0] < b[2] {
            canvas.path(&rectangle(view.rectangle([b[0], b[2]], [b[1], b[3]])), r##"fill="#f3f1ed""##, None);
        }
    }
}

/// Every block with half a joint around it, and a rectangle with a whole one below, in one path: what is not covered by blocks
/// afterwards is mortar.
fn mortar(canvas: &mut Canvas, view: &View, wall: &Wall) {
    let mut d = String::new();
    for block in &wall.blocks {
        let panel = &wall.panels[block.panel];
        // Thinner than that it cannot be seen.
        if panel.mortar.iter().all(|t| t * view.scale < 0.4) {
            continue;
        }
        let half = panel.mortar.map(|t| 0.5 * t);
        if !block.is_rectangle() {
            let [x0, y0, x1, y1] = view.bounds;
            let within = |&[x, y]: &[f64; 2]| [view.x(x.clamp(x0, x1)), view.y(y.clamp(y0, y1))];
            let around = grown(&block.corners(), half[0].max(half[1]));
            d.push_str(&closed(&around.iter().map(within).collect::<Vec<_>>()));
            continue;
        }
        let low = (block.y[0] - panel.mortar[0]).max(view.bounds[1]);
        let x = [block.x[0] - half[1], block.x[1] + half[1]].map(|x| x.clamp(view.bounds[0], view.bounds[2]));
        d.push_str(&rectangle(view.rectangle(x, [low, block.y[1]])));
    }
    canvas.path(&d, r##"fill="#e9e6e0""##, None);
}

/// A convex outline, counterclockwise, with its sides moved outwards.
fn grown(corners: &[[f64; 2]], by: f64) -> Vec<[f64; 2]> {
    let n = corners.len();
    let normal = |k: usize| {
        let [[x0, y0], [x1, y1]] = [corners[k % n], corners[(k + 1) % n]];
        let length = (x1 - x0).hypot(y1 - y0);
        [(y1 - y0) / length, (x0 - x1) / length]
    };
    let moved = |k: usize| {
        let ([ax, ay], [bx, by_]) = (normal(k + n - 1), normal(k));
        // Acute corners would run far out.
        let factor = by / (1.0 + ax * bx + ay * by_).max(0.3);
        [corners[k][0] + factor * (ax + bx), corners[k][1] + factor * (ay + by_)]
    };
    (0..n).map(moved).collect()
}

/// Room for the name of a block [m], left and right, bottom and top: all of a rectangle; within a polygon one that is half as
/// high as it is above and below its centre.
fn room(block: &Block) -> [[f64; 2]; 2] {
    if block.is_rectangle() {
        return [block.x, block.y];
    }
    let (corners, [x, y]) = (block.corners(), block.centre());
    let quarter = 0.25 * chord(&corners, 0, x).map_or(0.0, |[low, high]| high - low);
    let half = [y - quarter, y, y + quarter].into_iter().map(|at| {
        let across = chord(&corners, 1, at);
        across.map_or(0.0, |[left, right]| (x - left).min(right - x).max(0.0))
    });
    let half = half.fold(f64::INFINITY, f64::min);
    [[x - half, x + half], [y - quarter, y + quarter]]
}

/// Where the line on which coordinate `axis` is `at` runs through a convex outline: from and to in the other coordinate.
fn chord(corners: &[[f64; 2]], axis: usize, at: f64) -> Option<[f64; 2]> {
    let sides = (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]);
    let crossed = sides.filter(|[p, q]| (p[axis] <= at) != (q[axis] <= at)).map(|[p, q]| {
        let part = (at - p[axis]) / (q[axis] - p[axis]);
        p[1 - axis] + part * (q[1 - axis] - p[1 - axis])
    });
    let ends = crossed.fold([f64::INFINITY, f64::NEG_INFINITY], |e, v| [e[0].min(v), e[1].max(v)]);
    (ends[0] < ends[1]).then_some(ends)
}

fn blocks(canvas: &mut Canvas, view: &View, subject: &Subject, paint: Paint) {
    let wall = subject.wall;
    let stroke = px((0.004 * view.scale).clamp(0.15, 0.8));
    let attributes = |fill: &str| format!(r##"fill="{fill}" stroke="#555" stroke-width="{stroke}""##);
    let largest = if let Paint::Blocks(field) = paint { end(&field) } else { 0.0 };
    let fraction = |i: usize| match paint {
        Paint::Blocks(field) if largest > 0.0 => Some(field.values.get(i).copied().unwrap_or(0.0) / largest),
        Paint::Blocks(_) => Some(0.0),
        _ => None,
    };
    if !is_detailed(subject) {
        for (fill, members) in shades((0..wall.blocks.len()).map(fraction), BRICK) {
            let d: String = members.iter().map(|&i| view.outline(&wall.blocks[i])).collect();
            canvas.path(&d, &attributes(&fill), None);
        }
        return;
    }
    for (i, block) in wall.blocks.iter().enumerate() {
        let title = match paint {
            Paint::Blocks(field) => {
                format!("{}: {}", block.name, si(field.values.get(i).copied().unwrap_or(0.0), field.unit))
            }
            _ => format!(
                "{}: {} × {}, {}",
                block.name,
                si(block.length(), "m"),
                si(block.height(), "m"),
                mass(block.mass())
            ),
        };
        let (fill, letters) = match fraction(i) {
            Some(f) => (shade(f), if f > 0.55 { "#fff" } else { "#111" }),
            None => (BRICK.into(), "#111"),
        };
        canvas.path(&view.outline(block), &attributes(&fill), Some(&title));
        let [x, y] = room(block);
        label(canvas, view.rectangle(x, y), LETTERS[1], false, letters, &block.name);
    }
}

fn joints(canvas: &mut Canvas, view: &View, subject: &Subject, paint: Paint) {
    let thin = (0.003 * view.scale).clamp(0.5, 1.6);
    let detailed = is_detailed(subject);
    let whole = |e: usize| line(view.line(subject.joints[e].line));
    let Paint::Joints(field) = paint else {
        for kind in KINDS {
            let members: Vec<usize> = (0..subject.joints.len()).filter(|&e| subject.joints[e].kind == kind).collect();
            let attributes = format!(r#"fill="none" {}"#, stroke(kind, thin));
            if detailed {
                members.iter().for_each(|&e| canvas.path(&whole(e), &attributes, Some(&subject.names[e])));
            } else if !members.is_empty() {
                canvas.path(&members.iter().map(|&e| whole(e)).collect::<String>(), &attributes, None);
            }
        }
        return;
    };
    let data = |e: usize| match field.parts.get(e) {
        Some(parts) => parts_of(view.line(subject.joints[e].line), parts),
        None => whole(e),
    };
    // What has no value of a joint that is cracked in part.
    let is_part = |e: usize| field.parts.get(e).is_some_and(|[a, b]| a[1] < b[0] && (a[0] < a[1] || b[0] < b[1]));
    let rest: String = (0..subject.joints.len()).filter(|&e| is_part(e)).map(whole).collect();
    // Large values lie on top and are thicker.
    let largest = end(&field);
    let value = |e: usize| field.values.get(e).copied().unwrap_or(0.0);
    let fraction = |e: usize| {
        let of_largest = if largest > 0.0 { value(e) / largest } else { 0.0 };
        (!value(e).is_nan()).then_some(of_largest)
    };
    let attributes = |fill: &str, f: f64| {
        format!(r#"fill="none" stroke="{fill}" stroke-width="{}""#, px(thin * (1.0 + 2.5 * f.clamp(0.0, 1.0))))
    };
    if !rest.is_empty() {
        canvas.path(&rest, &attributes(&shade(0.0), 0.0), None);
    }
    if detailed {
        let mut order: Vec<usize> = (0..subject.joints.len()).collect();
        let height = |e: usize| fraction(e).unwrap_or(-1.0);
        order.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
        for e in order {
            let text = if value(e).is_nan() { field.none.into() } else { si(value(e), field.unit) };
            let fill = fraction(e).map_or_else(|| NONE.into(), shade);
            canvas.path(&data(e), &attributes(&fill, height(e)), Some(&format!("{}: {text}", subject.names[e])));
        }
    } else {
        for (number, (fill, members)) in shades((0..subject.joints.len()).map(fraction), NONE).into_iter().enumerate() {
            let thick = if fill == NONE { 0.0 } else { number as f64 / SHADES as f64 };
            let d: String = members.iter().map(|&e| data(e)).collect();
            canvas.path(&d, &attributes(&fill, thick), None);
        }
    }
}

/// Parts of a line, from where to where, 0 … 1 along it; all of it where there is none, for what lies below a pointer.
pub fn parts_of([x0, y0, x1, y1]: [f64; 4], parts: &[[f64; 2]; 2]) -> String {
    let at = |s: f64| [x0 + s * (x1 - x0), y0 + s * (y1 - y0)];
    let of = |[from, to]: &[f64; 2]| {
        let ([ax, ay], [bx, by]) = (at(*from), at(*to));
        line([ax, ay, bx, by])
    };
    let some: String = parts.iter().filter(|[from, to]| from < to).map(of).collect();
    if some.is_empty() { line([x0, y0, x1, y1]) } else { some }
}

fn joint_names(canvas: &mut Canvas, view: &View, subject: &Subject) {
    if !is_detailed(subject) {
        return;
    }
    canvas.open_halo();
    for (joint, name) in subject.joints.iter().zip(subject.names) {
        let [x0, y0, x1, y1] = view.line(joint.line);
        // Names are level or upright, and there is no room for such beside a sloping joint.
        if x0 != x1 && y0 != y1 {
            continue;
        }
        let mortar = subject.wall.panels[subject.wall.blocks[joint.a].panel].mortar;
        match joint.kind {
            JointKind::Top => {}
            JointKind::Head | JointKind::Connection => {
                let half = 0.5 * mortar[1] * view.scale;
                label(canvas, [x0 - half, y1, x0 + half, y0], 8.0, true, "#111", name);
            }
            JointKind::Bed | JointKind::Base => {
                let half = 0.5 * mortar[0] * view.scale;
                label(canvas, [x0, y0 - half, x1, y0 + half], 8.0, false, "#111", name);
            }
        }
    }
    canvas.raw("</g>");
}

/// A text in the middle of a rectangle, at most `size` high; nothing when it would not fit.
fn label(canvas: &mut Canvas, [x0, y0, x1, y1]: [f64; 4], size: f64, upright: bool, fill: &str, text: &str) {
    let (along, across) = if upright { (y1 - y0, x1 - x0) } else { (x1 - x0, y1 - y0) };
    let letters = text.chars().count() as f64;
    let size = size.min(0.92 * along / (LETTER * letters)).min(0.8 * across);
    if size >= LETTERS[0] {
        canvas.text([0.5 * (x0 + x1), 0.5 * (y0 + y1)], size, Anchor::Middle, upright, fill, text);
    }
}

fn dimensions(canvas: &mut Canvas, view: &View) {
    let [left, top, right, bottom] = view.rectangle([view.bounds[0], view.bounds[2]], [view.bounds[1], view.bounds[3]]);
    let (y, x) = (bottom + 24.0, left - 22.0);
    let d = [
        line([left, y, right, y]),
        line([left, y - 4.0, left, y + 4.0]),
        line([right, y - 4.0, right, y + 4.0]),
        line([x, top, x, bottom]),
        line([x - 4.0, top, x + 4.0, top]),
        line([x - 4.0, bottom, x + 4.0, bottom]),
    ];
    canvas.path(&d.concat(), r##"fill="none" stroke="#444" stroke-width="0.8""##, None);
    let [width, height] = [view.bounds[2] - view.bounds[0], view.bounds[3] - view.bounds[1]];
    canvas.text([0.5 * (left + right), y + 11.0], 11.0, Anchor::Middle, false, "#111", &si(width, "m"));
    canvas.text([x - 11.0, 0.5 * (top + bottom)], 11.0, Anchor::Middle, true, "#111", &si(height, "m"));
    let bar = round_length(0.2 * width);
    let y = view.size[1] - 14.0;
    let end = left + bar * view.scale;
    let d = line([left, y, end, y]);
    canvas.path(&d, r##"fill="none" stroke="#111" stroke-width="4""##, None);
    let text = if bar < 1.0 { format!("{} mm", (bar * 1e3).round()) } else { format!("{bar} m") };
    canvas.text([end + 8.0, y], 11.0, Anchor::Start, false, "#111", &text);
}

/// The largest of 1, 2, 5 times a power of ten not above `length`.
pub fn round_length(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|m| m * power).find(|l| *l <= length * 1.000_001).unwrap_or(power)
}

const KINDS: [JointKind; 5] = [JointKind::Bed, JointKind::Head, JointKind::Base, JointKind::Top, JointKind::Connection];

/// What the kinds are called.
pub fn kind_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Bed => "bed",
        JointKind::Head => "head",
        JointKind::Base => "base",
        JointKind::Top => "top",
        JointKind::Connection => "connection",
    }
}

fn stroke(kind: JointKind, width: f64) -> String {
    let (colour, factor, dashes) = match kind {
        JointKind::Bed => ("#1f5fa8", 1.0, ""),
        JointKind::Head => ("#c0390b", 1.3, "5 2"),
        JointKind::Base => ("#111", 1.8, ""),
        JointKind::Top => ("#111", 1.8, "2 2"),
        JointKind::Connection => ("#6a2c91", 1.8, "7 2 1.5 2"),
    };
    let dashes = if dashes.is_empty() { String::new() } else { format!(r#" stroke-dasharray="{dashes}""#) };
    format!(r#"stroke="{colour}" stroke-width="{}"{dashes}"#, px(width * factor))
}

fn kind_legend(canvas: &mut Canvas, view: &View, subject: &Subject) {
    let y = view.size[1] - 40.0;
    let mut x = MARGIN[0];
    let kinds = KINDS.map(|kind| {
        let number = subject.joints.iter().filter(|j| j.kind == kind).count();
        (format!(r#"fill="none" {}"#, stroke(kind, 1.6)), kind_name(kind), number)
    });
    let ties = (TIE.to_string(), "tie", subject.ties.len());
    for (attributes, name, number) in kinds.into_iter().chain([ties]).filter(|(.., number)| *number > 0) {
        canvas.path(&line([x, y, x + 26.0, y]), &attributes, None);
        let text = format!("{name} ({number})");
        canvas.text([x + 31.0, y], 11.0, Anchor::Start, false, "#111", &text);
        x += 40.0 + 11.0 * LETTER * text.len() as f64;
    }
}

fn value_legend(canvas: &mut Canvas, view: &View, field: &Field) {
    let (y, x, width) = (view.size[1] - 46.0, MARGIN[0], 160.0);
    let steps = 40;
    for k in 0..steps {
        let at = [x + width * k as f64 / steps as f64, x + width * (k + 1) as f64 / steps as f64];
        let fill = shade((k as f64 + 0.5) / steps as f64);
        canvas.path(&rectangle([at[0], y, at[1], y + 11.0]), &format!(r#"fill="{fill}""#), None);
    }
    canvas.path(&rectangle([x, y, x + width, y + 11.0]), r##"fill="none" stroke="#444" stroke-width="0.6""##, None);
    canvas.text([x - 4.0, y + 5.5], 11.0, Anchor::End, false, "#111", "0");
    let text = match end(field) {
        0.0 => format!("0 everywhere: {}", field.title),
        end => format!("{}: {}", short(end, field.unit), field.title),
    };
    canvas.text([x + width + 6.0, y + 5.5], 11.0, Anchor::Start, false, "#111", &text);
    if field.values.iter().any(|v| v.is_nan()) && !field.none.is_empty() {
        let x = x + width + 26.0 + 11.0 * LETTER * text.chars().count() as f64;
        canvas.path(
            &line([x, y + 5.5, x + 20.0, y + 5.5]),
            &format!(r#"fill="none" stroke="{NONE}" stroke-width="2""#),
            None,
        );
        canvas.text([x + 25.0, y + 5.5], 11.0, Anchor::Start, false, "#111", field.none);
    }
}

/// Where the colours of a field end: at its largest value, rounded up; 0 where there is none.
fn end(field: &Field) -> f64 {
    let largest = field.values.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    if largest < NOTHING { 0.0 } else { round_end(largest) }
}

/// Colour of a fraction 0 … 1 of the largest value; the brightness falls steadily.
pub fn shade(fraction: f64) -> String {
    let f = if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 1.0 };
    format!("#{:x}", colorous::YELLOW_ORANGE_RED.eval_continuous(0.06 + 0.94 * f))
}

/// Members of each shade, from the brightest; elements without a value share the colour `none`.
fn shades(fractions: impl Iterator<Item = Option<f64>>, none: &str) -> Vec<(String, Vec<usize>)> {
    let mut classes = vec![Vec::new(); SHADES + 1];
    for (i, fraction) in fractions.enumerate() {
        let class = fraction.map_or(SHADES, |f| ((f * SHADES as f64) as usize).min(SHADES - 1));
        classes[class].push(i);
    }
    let colour = |class: usize| if class == SHADES { none.into() } else { shade((class as f64 + 0.5) / SHADES as f64) };
    classes.into_iter().enumerate().filter(|(_, m)| !m.is_empty()).map(|(c, m)| (colour(c), m)).collect()
}

/// A mass in kilograms or tonnes.
pub fn mass(kilograms: f64) -> String {
    if kilograms < 1000.0 {
        format!("{} kg", crate::format::significant(kilograms, 4))
    } else {
        si(kilograms / 1000.0, "t")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]];

    #[test]
    fn grown_outlines_keep_their_sides_at_a_distance() {
        let around = grown(&TRIANGLE, 0.1);
        assert!((around[0][0] + 0.1).abs() < 1e-12 && (around[0][1] + 0.1).abs() < 1e-12, "{around:?}");
        let square = grown(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 0.5);
        assert_eq!(square, [[-0.5, -0.5], [1.5, -0.5], [1.5, 1.5], [-0.5, 1.5]]);
    }

    /// All corners of what a name may take lie in the block.
    #[test]
    fn names_find_room_in_polygons() {
        let shape = concio::wall::Shape { span: 1, corners: TRIANGLE.to_vec() };
        let block = Block {
            name: "p1c1b1".into(),
            panel: 0,
            course: 0,
            x: [0.0, 3.0],
            y: [0.0, 3.0],
            shape: Some(Box::new(shape)),
            thickness: 1.0,
            specific_weight: 1.0,
        };
        let [x, y] = room(&block);
        // The chord through the centre (1, 1) is 2 long.
        assert!((y[0] - 0.5).abs() < 1e-12 && (y[1] - 1.5).abs() < 1e-12, "{y:?}");
        assert!((x[1] - 1.5).abs() < 1e-12 && x[0] >= 0.0, "{x:?}");
        assert!(x[1] + y[1] <= 3.0 + 1e-12);
        let rectangle = Block { shape: None, ..block };
        assert_eq!(room(&rectangle), [[0.0, 3.0], [0.0, 3.0]]);
    }
}
