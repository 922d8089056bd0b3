//! The wall at an instant: deformed, or with its joints coloured by relative acceleration.

use concio::InputError;
use concio::case::JointKind;
use concio::moment::Moment;

use super::Options;
use super::data::{Data, Instant};
use crate::draw::chart::LETTERS;
use crate::draw::font;
use crate::draw::output::Drawing;
use crate::draw::svg::{Anchor, Canvas, line, px, rectangle};
use crate::draw::wall::{BRICK, LIGHT, ground, round_length, shade};
use crate::format::{plain, short, si, significant};

/// Height of the wall over the width of the figure, at most.
const TALLEST: f64 = 1.15;
/// Room left and right of the wall [pt].
const SIDE: f64 = 8.0;
/// Height of the top beam and its distance from the wall [pt].
const BEAM: [f64; 2] = [8.0, 1.5];
/// The largest displacement as drawn, over the length of a typical block.
const DRAWN: f64 = 0.3;
/// Height of the hatching below the base [pt].
const GROUND: f64 = 5.0;

/// From metres to points.
struct View {
    origin: [f64; 2],
    scale: f64,
    /// Left, right, bottom, top of the wall at rest [m].
    bounds: [f64; 4],
    /// Where the ground ends below [pt].
    below: f64,
}

impl View {
    /// A wall whose blocks reach `out` [m] beyond it to the left and to the right, under headings of height `head`.
    fn new(data: &Data, width: f64, out: [f64; 2], head: f64) -> View {
        let blocks = &data.run.wall.blocks;
        let bounds = blocks.iter().fold([f64::INFINITY, f64::NEG_INFINITY, 0.0, f64::NEG_INFINITY], |b, k| {
            [b[0].min(k.x[0]), b[1].max(k.x[1]), f64::min(b[2], k.y[0]), b[3].max(k.y[1])]
        });
        let [wide, high] = [(bounds[1] - bounds[0] + out[0] + out[1]).max(1e-9), (bounds[3] - bounds[2]).max(1e-9)];
        let scale = ((width - 2.0 * SIDE) / wide).min(TALLEST * width / high);
        let left = 0.5 * (width - wide * scale) + out[0] * scale;
        let beam = if has_beam(data) { BEAM[0] + BEAM[1] + 2.0 } else { 2.0 };
        let bottom = head + beam + high * scale;
        View {
            origin: [left - bounds[0] * scale, bottom + bounds[2] * scale],
            scale,
            bounds,
            below: bottom + GROUND + 2.0,
        }
    }

    /// Left, top, right, bottom of a rectangle given in metres.
    fn rectangle(&self, x: [f64; 2], y: [f64; 2]) -> [f64; 4] {
        let [ox, oy] = self.origin;
        [ox + x[0] * self.scale, oy - y[1] * self.scale, ox + x[1] * self.scale, oy - y[0] * self.scale]
    }

    fn ground(&self, canvas: &mut Canvas) {
        let [left, _, right, bottom] = self.rectangle([self.bounds[0], self.bounds[1]], [self.bounds[2]; 2]);
        ground(canvas, [left, right, bottom], 0.65);
    }

    /// The top beam, moved by `shift` [m].
    fn beam(&self, canvas: &mut Canvas, data: &Data, shift: f64, attributes: &str) {
        let tops = data.run.joints.iter().map(|j| &j.joint).filter(|j| j.kind == JointKind::Top);
        let ends = tops.fold([f64::INFINITY, f64::NEG_INFINITY], |e, j| [e[0].min(j.line[0]), e[1].max(j.line[2])]);
        if ends[0] < ends[1] {
            let [left, top, right, _] = self.rectangle(ends.map(|x| x + shift), [self.bounds[3]; 2]);
            canvas.path(&rectangle([left, top - BEAM[0] - BEAM[1], right, top - BEAM[1]]), attributes, None);
        }
    }
}

fn has_beam(data: &Data) -> bool {
    data.run.joints.iter().any(|j| j.joint.kind == JointKind::Top)
}

/// The panel at an instant, displacements enlarged, over its outline at rest.
pub fn deformed(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let moment = data.moment(options.at, largest_displacement)?;
    let blocks = &data.run.wall.blocks;
    let moved: Vec<f64> = (0..blocks.len()).map(|i| moment.block(i).displacement).collect();
    let beam = has_beam(data).then(|| moment.beam().displacement);
    if moved.iter().chain(&beam).any(|z| !z.is_finite()) {
        let what = format!("displacements at {} s are not finite", plain(moment.time()));
        return Err(InputError::new(what).key("--at").help("the run failed there: choose an earlier instant"));
    }
    let all = moved.iter().chain(&beam);
    let [low, high] = all.fold([0.0f64; 2], |e, z| [e[0].min(*z), e[1].max(*z)]);
    let largest = high.max(-low);
    let scale = options.scale.unwrap_or_else(|| automatic_scale(data, largest));
    let out = [-low * scale, high * scale];
    let time = format!("t = {}", crate::format::seconds(rounded(moment.time())));
    let drawn =
        if scale == 1.0 { "displacements to scale".into() } else { format!("displacements × {}", plain(scale)) };
    let mut canvas = Canvas::default();
    let of_blocks = moved.iter().fold(0.0, |m, z| z.abs().max(m));
    let mut texts = vec![time, drawn, format!("blocks up to {}", short(three(of_blocks), "m"))];
    texts.extend(beam.map(|z| format!("beam {}", short(three(z), "m"))));
    let head = headings(&mut canvas, options.points(), &texts);
    let view = View::new(data, options.points(), out, head);
    let rest = r##"fill="#e6e6e6" stroke="#8c8c8c" stroke-width="0.4""##;
    let shift = |z: f64, b: &concio::wall::Block| rectangle(view.rectangle(b.x.map(|x| x + z * scale), b.y));
    canvas.path(&blocks.iter().map(|b| shift(0.0, b)).collect::<String>(), rest, None);
    if let Some(z) = beam {
        view.beam(&mut canvas, data, 0.0, rest);
        view.beam(&mut canvas, data, z * scale, r##"fill="#c9c9c9" stroke="#222" stroke-width="0.5""##);
    }
    let brick = format!(r##"fill="{BRICK}" stroke="#333" stroke-width="0.5""##);
    for (block, z) in blocks.iter().zip(&moved) {
        canvas.path(&shift(*z, block), &brick, Some(&format!("{}: {}", block.name, si(*z, "m"))));
    }
    view.ground(&mut canvas);
    let bottom = bars(&mut canvas, &view, options.points(), (largest > 0.0).then_some((scale, largest)));
    Ok(Drawing {
        body: canvas.into_body(),
        size: [options.points(), bottom],
        title: format!("Deformed wall at {} s, displacements × {}", plain(rounded(moment.time())), plain(scale)),
        note: String::new(),
    })
}

fn largest_displacement(data: &Data, moment: &Moment) -> f64 {
    (0..data.run.wall.blocks.len()).map(|i| moment.block(i).displacement.abs()).fold(0.0, f64::max)
}

fn largest_acceleration(data: &Data, moment: &Moment) -> f64 {
    (0..data.run.joints.len()).map(|e| moment.joint(e).acceleration.abs()).fold(0.0, f64::max)
}

/// Three significant digits.
fn three(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// A time without the digits that sums of intervals leave behind.
fn rounded(time: f64) -> f64 {
    (time * 1e9).round() / 1e9
}

/// 1, 2 or 5 times a power of ten, so that the largest displacement shows and blocks stay apart.
fn automatic_scale(data: &Data, largest: f64) -> f64 {
    let mut lengths: Vec<f64> = data.run.wall.blocks.iter().map(concio::wall::Block::length).collect();
    lengths.sort_by(f64::total_cmp);
    let typical = lengths.get(lengths.len() / 2).copied().unwrap_or(1.0);
    if largest > 0.0 { round_length(DRAWN * typical / largest).max(1.0) } else { 1.0 }
}

/// Texts in as few centred lines as they need; where they end [pt].
fn headings(canvas: &mut Canvas, width: f64, texts: &[String]) -> f64 {
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

/// A bar for lengths, and one for displacements; where they end [pt].
fn bars(canvas: &mut Canvas, view: &View, width: f64, displacements: Option<(f64, f64)>) -> f64 {
    let size = f64::from(LETTERS[0]);
    let y = view.below + 6.0;
    let bar = |canvas: &mut Canvas, x: f64, length: f64, text: &str| {
        let end = x + length;
        let ticks = [line([x, y, end, y]), line([x, y - 2.0, x, y + 2.0]), line([end, y - 2.0, end, y + 2.0])];
        canvas.path(&ticks.concat(), r##"fill="none" stroke="#000" stroke-width="0.8""##, None);
        canvas.text([end + 4.0, y], size, Anchor::Start, false, "#000", text);
        end + 4.0 + font::width(text, size)
    };
    let wall = view.bounds[1] - view.bounds[0];
    let length = round_length(0.25 * wall);
    let text = if length < 1.0 {
        format!("{} mm", plain((length * 1e6).round() / 1e3))
    } else {
        format!("{} m", plain(length))
    };
    let end = bar(canvas, SIDE, length * view.scale, &format!("wall: {text}"));
    if let Some((scale, largest)) = displacements {
        let length = round_length(largest);
        let drawn = length * scale * view.scale;
        let text = format!("displacement: {}", short(length, "m"));
        let room = drawn + 4.0 + font::width(&text, size);
        if end + 14.0 + room <= width - 2.0 {
            bar(canvas, (width - SIDE - room).max(end + 14.0), drawn, &text);
        }
    }
    y + 8.0
}

/// Joints coloured by the largest relative acceleration of each, over the largest of all.
pub fn peak_acceleration(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let peaks = &data.run.outcome.envelopes.joint_acceleration;
    let largest = largest(peaks)?;
    Ok(accelerations(data, options, peaks, largest, "peak over the whole history".into()))
}

/// Joints coloured by their relative acceleration at an instant, over the largest in the whole history.
pub fn acceleration(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let largest = largest(&data.run.outcome.envelopes.joint_acceleration)?;
    let moment = data.moment(options.at, largest_acceleration)?;
    let values: Vec<f64> = (0..data.run.joints.len()).map(|e| moment.joint(e).acceleration.abs()).collect();
    let time = format!("t = {}", crate::format::seconds(rounded(moment.time())));
    Ok(accelerations(data, options, &values, largest, time))
}

/// Joints coloured by the damage of their bonds, at the end of the run or at an instant.
pub fn cracks(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let bonds = &data.run.outcome.bonds;
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
    let (drawn, bottom) = map(data, options, &values, &texts, "damage of the bond [1], 0 = intact, 1 = broken");
    let title = "Joints coloured by the damage of their bonds".into();
    Ok(Drawing { body: drawn, size: [options.points(), bottom], title, note: String::new() })
}

fn accelerations(data: &Data, options: &Options, values: &[f64], largest: f64, text: String) -> Drawing {
    let values: Vec<Option<f64>> = values.iter().map(|v| Some(v / largest)).collect();
    // Large ones in m/s², as accelerations are read.
    let peak = if largest < 0.1 { short(three(largest), "m/s²") } else { format!("{} m/s²", plain(three(largest))) };
    let label = format!("relative acceleration [1], 1 = {peak}");
    let (body, bottom) = map(data, options, &values, &[text], &label);
    let title = "Joints coloured by relative acceleration over the largest in the whole history".into();
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

/// The wall with its joints coloured by values from 0 to 1, which `label` names, those without one, which are not bonded,
/// dashed in grey; and where it ends [pt].
fn map(data: &Data, options: &Options, values: &[Option<f64>], texts: &[String], label: &str) -> (String, f64) {
    let mut canvas = Canvas::default();
    let head = headings(&mut canvas, options.points(), texts);
    let view = View::new(data, options.points(), [0.0; 2], head);
    view.beam(&mut canvas, data, 0.0, r##"fill="#e6e6e6" stroke="#8c8c8c" stroke-width="0.4""##);
    let outlines: String = data.run.wall.blocks.iter().map(|b| rectangle(view.rectangle(b.x, b.y))).collect();
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
            let (fill, width) = if cased { ("#6e6e6e".into(), width + 0.5) } else { (shade(value), width) };
            let attributes = format!(r#"fill="none" stroke="{fill}" stroke-width="{}""#, px(width));
            let title = (!cased).then(|| format!("{name}: {}", significant(value, 3)));
            canvas.path(&line([ax, ay, bx, by]), &attributes, title.as_deref());
        }
    }
    let mut bottom = colour_bar(&mut canvas, &view, options.points(), label);
    if values.iter().any(Option::is_none) {
        bottom = unbonded_key(&mut canvas, options.points(), bottom, width);
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

/// What the dashes stand for, in the middle of a line from `y`; where it ends [pt].
fn unbonded_key(canvas: &mut Canvas, width: f64, y: f64, stroke: f64) -> f64 {
    let (size, text, sample) = (f64::from(LETTERS[1]), "not bonded", 16.0);
    let x = 0.5 * (width - sample - 4.0 - font::width(text, size));
    let middle = y + 0.5 * size;
    canvas.path(&line([x, middle, x + sample, middle]), &unbonded(stroke), None);
    canvas.text([x + sample + 4.0, middle], size, Anchor::Start, false, "#000", text);
    y + size + 4.0
}

/// What accelerations depend on where joints close with a hit; empty without such joints.
fn hits(data: &Data) -> String {
    use concio::case::SpringLaw;
    if !data.run.joints.iter().any(|j| j.law == SpringLaw::NoTension) {
        return String::new();
    }
    format!(
        "peaks are hits of head joints as they close and go about with √κ (joint.head.rigidity = {} here)",
        plain(data.case.joint.head.rigidity)
    )
}

/// The colours from 0 to 1 with what they stand for; where it ends [pt].
fn colour_bar(canvas: &mut Canvas, view: &View, width: f64, label: &str) -> f64 {
    let [small, size] = LETTERS.map(f64::from);
    let (y, x, long, high) = (view.below + 3.0, 0.5 * (width - 0.6 * width), 0.6 * width, 6.0);
    let steps = 100;
    for k in 0..steps {
        let fraction = |k: usize| k as f64 / steps as f64;
        // A little wider than a step, so that no seams show.
        let part = [x + long * fraction(k), y, (x + long * fraction(k + 1) + 0.3).min(x + long), y + high];
        canvas.path(&rectangle(part), &format!(r#"fill="{}""#, shade((k as f64 + 0.5) / steps as f64)), None);
    }
    let mut frame = rectangle([x, y, x + long, y + high]);
    for k in 0..=5 {
        let at = x + long * f64::from(k) / 5.0;
        frame.push_str(&line([at, y + high, at, y + high + 2.0]));
        let label = if k == 0 {
            "0".into()
        } else if k == 5 {
            "1".into()
        } else {
            format!("0.{}", 2 * k)
        };
        canvas.text([at, y + high + 4.0 + 0.5 * small], small, Anchor::Middle, false, "#000", &label);
    }
    canvas.path(&frame, r##"fill="none" stroke="#000" stroke-width="0.5""##, None);
    let below = y + high + 6.0 + small + 0.5 * size;
    canvas.text([0.5 * width, below], size, Anchor::Middle, false, "#000", label);
    below + 0.5 * size + 4.0
}
