//! Walls with their joints coloured by a value, and what drawings of walls for print share.

use concio::InputError;
use concio::case::JointKind;
use concio::moment::Moment;
use concio::record::Motion;

use super::Options;
use super::data::Data;
use crate::args::Instant;
use crate::draw::chart::LETTERS;
use crate::draw::font;
use crate::draw::output::Drawing;
use crate::draw::scale::{Scale, round_end};
use crate::draw::svg::{Anchor, Canvas, closed, line, px, rectangle};
use crate::draw::wall::{LIGHT, WHOLE, ground, parts_of, shade};
use crate::format::{plain, short};

/// Height of the wall over the width of the figure, at most.
const TALLEST: f64 = 1.15;
/// Room left and right of the wall [pt].
pub(super) const SIDE: f64 = 8.0;
/// Height of the top beam and its distance from the wall [pt].
const BEAM: [f64; 2] = [8.0, 1.5];
/// Height of the hatching below the base [pt].
const GROUND: f64 = 5.0;

/// From metres to points.
pub(super) struct View {
    pub(super) origin: [f64; 2],
    pub(super) scale: f64,
    /// Left, right, bottom, top of the wall at rest [m].
    pub(super) bounds: [f64; 4],
    /// Where the ground ends below [pt].
    pub(super) below: f64,
}

impl View {
    /// A wall whose blocks reach beyond it, under headings of height `head`.
    pub(super) fn new(data: &Data, width: f64, reach: Reach, head: f64) -> View {
        let bounds = bounds(data);
        let wide = (bounds[1] - bounds[0] + reach.left + reach.right).max(1e-9);
        let high = (bounds[3] - bounds[2] + reach.above + reach.below).max(1e-9);
        let scale = ((width - 2.0 * SIDE) / wide).min(TALLEST * width / high);
        let left = 0.5 * (width - wide * scale) + reach.left * scale;
        let beam = if has_beam(data) { BEAM[0] + BEAM[1] + 2.0 } else { 2.0 };
        let bottom = head + beam + high * scale;
        View {
            origin: [left - bounds[0] * scale, bottom + (bounds[2] - reach.below) * scale],
            scale,
            bounds,
            below: bottom + GROUND + 2.0,
        }
    }

    /// A place given in metres.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + x * self.scale, self.origin[1] - y * self.scale]
    }

    /// Left, top, right, bottom of a rectangle given in metres.
    fn rectangle(&self, x: [f64; 2], y: [f64; 2]) -> [f64; 4] {
        let [ox, oy] = self.origin;
        [ox + x[0] * self.scale, oy - y[1] * self.scale, ox + x[1] * self.scale, oy - y[0] * self.scale]
    }

    pub(super) fn ground(&self, canvas: &mut Canvas) {
        let [left, _, right, bottom] = self.rectangle([self.bounds[0], self.bounds[1]], [self.bounds[2]; 2]);
        ground(canvas, [left, right, bottom], 0.65);
    }

    /// The top beam, its motion so many times as large.
    pub(super) fn beam(&self, canvas: &mut Canvas, data: &Data, (motion, scale): (Motion, f64), attributes: &str) {
        let ends = beam_ends(data);
        if ends[0] < ends[1] {
            let foot = beam_foot(data);
            let [low, high] = [BEAM[1], BEAM[0] + BEAM[1]].map(|v| self.bounds[3] + v / self.scale);
            let corners = [[ends[0], low], [ends[1], low], [ends[1], high], [ends[0], high]];
            let moved = corners.map(|[x, y]| {
                let way = motion.of_point([x - foot[0], y - foot[1]]);
                self.at([x + scale * way[0], y + scale * way[1]])
            });
            canvas.path(&closed(&moved), attributes, None);
        }
    }
}

/// How far a wall reaches beyond what it takes at rest [m].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Reach {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) above: f64,
    pub(super) below: f64,
}

/// Left, right, bottom, top of the wall at rest [m].
pub(super) fn bounds(data: &Data) -> [f64; 4] {
    let start = [f64::INFINITY, f64::NEG_INFINITY, 0.0, f64::NEG_INFINITY];
    data.run
        .wall
        .blocks
        .iter()
        .flat_map(|k| k.corners())
        .fold(start, |b, [x, y]| [b[0].min(x), b[1].max(x), f64::min(b[2], y), b[3].max(y)])
}

/// Left and right end of the joints under the top beam [m].
fn beam_ends(data: &Data) -> [f64; 2] {
    let tops = data.run.joints.iter().map(|j| &j.joint).filter(|j| j.kind == JointKind::Top);
    tops.fold([f64::INFINITY, f64::NEG_INFINITY], |e, j| [e[0].min(j.line[0]), e[1].max(j.line[2])])
}

/// The point that the beam is drawn to turn about [m]: the middle of its lower side.
pub(super) fn beam_foot(data: &Data) -> [f64; 2] {
    let ends = beam_ends(data);
    [0.5 * (ends[0] + ends[1]), bounds(data)[3]]
}

pub(super) fn has_beam(data: &Data) -> bool {
    data.run.joints.iter().any(|j| j.joint.kind == JointKind::Top)
}

fn largest_acceleration(data: &Data, moment: &Moment) -> f64 {
    (0..data.run.joints.len()).map(|e| moment.joint(e).acceleration.abs()).fold(0.0, f64::max)
}

/// Three significant digits.
pub(super) fn three(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// A time without the digits that sums of intervals leave behind.
pub(super) fn rounded(time: f64) -> f64 {
    (time * 1e9).round() / 1e9
}

/// Texts in as few centred lines as they need; where they end [pt].
pub(super) fn headings(canvas: &mut Canvas, width: f64, texts: &[String]) -> f64 {
    let size = f64::from(LETTERS[1]);
    let mut lines: Vec<String> = Vec::new();
    for text in texts {
        match lines.last_mut() {
            Some(last) if font::width(&format!("{last}, {text}"), size) <= width - 2.0 * SIDE => {
                *last += &format!(", {text}")
            }
            _ => lines.push(text.clone()),
        }
    }
    let mut y = 3.0;
    for text in lines {
        canvas.text([0.5 * width, y + 0.5 * size], size, Anchor::Middle, false, "#000", &text);
        y += size + 3.0;
    }
    y
}

/// Joints coloured by the largest relative acceleration of each.
pub fn peak_acceleration(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let peaks = &data.run.outcome.envelopes.joint_acceleration;
    let largest = largest(peaks)?;
    Ok(accelerations(data, options, peaks, largest, "peak over the whole history".into()))
}

/// Joints coloured by their relative acceleration at an instant; the colours reach to the largest in the whole history.
pub fn acceleration(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    if data.is_planar() {
        return Err(InputError::new("frames of a planar run hold no accelerations of joints")
            .help("`peak-acceleration` draws the largest of the run"));
    }
    let largest = largest(&data.run.outcome.envelopes.joint_acceleration)?;
    let moment = data.moment(options.at, largest_acceleration)?;
    let values: Vec<f64> = (0..data.run.joints.len()).map(|e| moment.joint(e).acceleration.abs()).collect();
    let time = format!("t = {}", crate::format::seconds(rounded(moment.time())));
    Ok(accelerations(data, options, &values, largest, time))
}

/// Joints coloured by the damage of their bonds, at the end of the run or at an instant.
pub fn cracks(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let bonds = &data.run.outcome.bonds;
    if bonds.is_empty() && data.is_planar() {
        return openings(data, options);
    }
    if bonds.is_empty() {
        return Err(InputError::new("no joint of this run is bonded").help("see `bond` in docs/wall-file.md"));
    }
    let mut values = vec![None; data.run.joints.len()];
    let mut time = data.run.outcome.time_reached;
    if options.at == Instant::Peak {
        bonds.iter().for_each(|bond| values[bond.joint] = Some(bond.damage));
    } else {
        let moment = data.moment(options.at, |_, _| 0.0)?;
        (0..values.len()).for_each(|e| values[e] = moment.damage(e));
        time = moment.time();
    }
    let cracked = values.iter().filter(|value| value.is_some_and(|v| v > 0.0)).count();
    let broken = values.iter().filter(|value| **value == Some(1.0)).count();
    let texts = [
        format!("t = {}", crate::format::seconds(rounded(time))),
        format!("{cracked} of {} bonds cracked, {broken} of them broken", bonds.len()),
    ];
    let colours = Colours { quantity: "damage of the bond, 0 = intact, 1 = broken", unit: "", end: 1.0 };
    let mut parts = vec![WHOLE; data.run.joints.len()];
    if options.at == Instant::Peak {
        for bond in bonds {
            parts[bond.joint] = bond.cracks();
            values[bond.joint] = Some(bond.damage_of_crack());
        }
    }
    let (drawn, bottom) = map(data, options, (&values, &parts), &texts, &colours);
    let title = "Joints coloured by the damage of their bonds".into();
    Ok(Drawing { body: drawn, size: [options.points(), bottom], title, note: String::new() })
}

/// Joints of a wall without bonds coloured by their opening, the widest of the run or that at an instant.
fn openings(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let peaks = &data.run.outcome.envelopes.joint_opening;
    let (values, text) = if options.at == Instant::Peak {
        let collapse = data.run.outcome.totals.collapse.map(|c| crate::format::seconds(rounded(c.time)));
        (
            peaks.clone(),
            collapse.map_or("widest over the whole history".into(), |t| format!("widest until the collapse at {t}")),
        )
    } else {
        let moment = data.moment(options.at, |_, _| 0.0)?;
        let values = (0..data.run.joints.len()).map(|e| moment.joint(e).opening).collect();
        (values, format!("t = {}", crate::format::seconds(rounded(moment.time()))))
    };
    let largest = values.iter().copied().filter(|v: &f64| v.is_finite()).fold(0.0, f64::max);
    if largest == 0.0 {
        return Err(InputError::new("no joint opened").key("--at"));
    }
    let values: Vec<Option<f64>> = values.into_iter().map(Some).collect();
    let (drawn, bottom) =
        map(data, options, (&values, &[]), &[text], &Colours::up_to("opening of joints", "m", largest));
    let title = "Joints coloured by their opening".into();
    Ok(Drawing { body: drawn, size: [options.points(), bottom], title, note: String::new() })
}

fn accelerations(data: &Data, options: &Options, values: &[f64], largest: f64, text: String) -> Drawing {
    let values: Vec<Option<f64>> = values.iter().map(|v| Some(*v)).collect();
    let colours = Colours::up_to("relative acceleration", "m/s²", largest);
    let texts = [text, format!("largest {} m/s²", plain(three(largest)))];
    let (body, bottom) = map(data, options, (&values, &[]), &texts, &colours);
    let title = "Joints coloured by relative acceleration".into();
    Drawing { body, size: [options.points(), bottom], title, note: hits(data) }
}

fn largest(peaks: &[f64]) -> Result<f64, InputError> {
    let largest = peaks.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    if largest > 0.0 {
        Ok(largest)
    } else {
        Err(InputError::new("no joint moved: there are no relative accelerations"))
    }
}

/// What colours stand for: a quantity from 0 to `end` in SI.
pub(super) struct Colours {
    pub(super) quantity: &'static str,
    pub(super) unit: &'static str,
    pub(super) end: f64,
}

impl Colours {
    /// Up to the largest value, rounded up.
    pub(super) fn up_to(quantity: &'static str, unit: &'static str, largest: f64) -> Self {
        Colours { quantity, unit, end: round_end(largest) }
    }
}

/// The wall with its joints coloured by values, where they have parts these alone, those without one, which are not bonded, dashed in grey; and where it ends [pt].
fn map(
    data: &Data,
    options: &Options,
    (values, parts): (&[Option<f64>], &[[[f64; 2]; 2]]),
    texts: &[String],
    colours: &Colours,
) -> (String, f64) {
    let mut canvas = Canvas::default();
    let head = headings(&mut canvas, options.points(), texts);
    let view = View::new(data, options.points(), Reach::default(), head);
    let still = (Motion::default(), 0.0);
    view.beam(&mut canvas, data, still, r##"fill="#e6e6e6" stroke="#8c8c8c" stroke-width="0.4""##);
    let outline = |b: &concio::wall::Block| closed(&b.corners().iter().map(|c| view.at(*c)).collect::<Vec<_>>());
    let outlines: String = data.run.wall.blocks.iter().map(outline).collect();
    canvas.path(&outlines, &format!(r##"fill="{LIGHT}" stroke="#a8a8a8" stroke-width="0.35""##), None);
    view.ground(&mut canvas);
    let width = (0.012 * view.scale).clamp(1.0, 3.0);
    // Large values lie on top.
    let mut order: Vec<usize> = (0..data.run.joints.len()).collect();
    order.sort_by(|&a, &b| values[a].unwrap_or(-1.0).total_cmp(&values[b].unwrap_or(-1.0)));
    for cased in [true, false] {
        for &e in &order {
            let [x0, y0, x1, y1] = data.run.joints[e].joint.line;
            let [ax, ay, ..] = view.rectangle([x0; 2], [y0; 2]);
            let [bx, by, ..] = view.rectangle([x1; 2], [y1; 2]);
            let name = &data.run.joints[e].name;
            let Some(value) = values[e] else {
                if !cased {
                    canvas.path(&line([ax, ay, bx, by]), &unbonded(width), Some(&format!("{name}: not bonded")));
                }
                continue;
            };
            let (fill, width) =
                if cased { ("#6e6e6e".into(), width + 0.5) } else { (shade(value / colours.end), width) };
            let attributes = format!(r#"fill="none" stroke="{fill}" stroke-width="{}""#, px(width));
            let title = (!cased).then(|| format!("{name}: {}", short(three(value), colours.unit)));
            let ends = [ax, ay, bx, by];
            let drawn = parts.get(e).map_or_else(|| line(ends), |parts| parts_of(ends, parts));
            if !cased && drawn != line(ends) {
                let intact = format!(r#"fill="none" stroke="{}" stroke-width="{}""#, shade(0.0), px(0.5 * width));
                canvas.path(&line(ends), &intact, None);
            }
            canvas.path(&drawn, &attributes, title.as_deref());
        }
    }
    let mut bottom = colour_bar(&mut canvas, view.below, options.points(), colours);
    if values.iter().any(Option::is_none) {
        bottom = line_key(&mut canvas, options.points(), bottom, &unbonded(width), "not bonded");
    }
    (canvas.into_body(), bottom)
}

/// How a joint without bond is drawn where those with one are `width` wide.
fn unbonded(width: f64) -> String {
    format!(
        r##"fill="none" stroke="#8c8c8c" stroke-width="{0}" stroke-dasharray="{1} {1}""##,
        px(0.5 * width),
        px(width)
    )
}

/// What a kind of line stands for, in the middle of a line from `y`; where it ends [pt].
pub(super) fn line_key(canvas: &mut Canvas, width: f64, y: f64, attributes: &str, text: &str) -> f64 {
    let (size, sample) = (f64::from(LETTERS[1]), 16.0);
    let x = 0.5 * (width - sample - 4.0 - font::width(text, size));
    let middle = y + 0.5 * size;
    canvas.path(&line([x, middle, x + sample, middle]), attributes, None);
    canvas.text([x + sample + 4.0, middle], size, Anchor::Start, false, "#000", text);
    y + size + 4.0
}

/// What accelerations depend on where joints close with a hit; empty without such joints.
fn hits(data: &Data) -> String {
    if !data.run.joints.iter().any(|j| j.law.is_no_tension()) {
        return String::new();
    }
    format!(
        "peaks are hits of head joints as they close and go about with √κ (joint.head.rigidity = {} here)",
        plain(data.case.joint.head.rigidity)
    )
}

/// The colours with what they stand for, below `from` [pt]; where it ends [pt].
pub(super) fn colour_bar(canvas: &mut Canvas, from: f64, width: f64, colours: &Colours) -> f64 {
    let [small, size] = LETTERS.map(f64::from);
    let (y, x, long, high) = (from + 3.0, 0.5 * (width - 0.6 * width), 0.6 * width, 6.0);
    let steps = 100;
    for k in 0..steps {
        let fraction = |k: usize| k as f64 / steps as f64;
        // A little wider than a step, so that no seams show.
        let part = [x + long * fraction(k), y, (x + long * fraction(k + 1) + 0.3).min(x + long), y + high];
        canvas.path(&rectangle(part), &format!(r#"fill="{}""#, shade((k as f64 + 0.5) / steps as f64)), None);
    }
    let mut frame = rectangle([x, y, x + long, y + high]);
    let scale = Scale::linear([0.0, colours.end], colours.unit, 6);
    for k in 0..=(scale.range[1] / scale.step + 1e-9) as usize {
        let value = k as f64 * scale.step;
        let at = x + long * value / scale.range[1];
        frame.push_str(&line([at, y + high, at, y + high + 2.0]));
        canvas.text([at, y + high + 4.0 + 0.5 * small], small, Anchor::Middle, false, "#000", &scale.label(value));
    }
    canvas.path(&frame, r##"fill="none" stroke="#000" stroke-width="0.5""##, None);
    let below = y + high + 6.0 + small + 0.5 * size;
    let Colours { quantity, unit, .. } = colours;
    let label = if unit.is_empty() && scale.prefix.is_empty() {
        (*quantity).into()
    } else {
        format!("{quantity} [{}{unit}]", scale.prefix)
    };
    canvas.text([0.5 * width, below], size, Anchor::Middle, false, "#000", &label);
    below + 0.5 * size + 4.0
}
