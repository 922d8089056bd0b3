//! The wall at an instant with its displacements enlarged: blocks where they are, and over them the joints that opened or
//! slid.

use concio::InputError;
use concio::moment::{JointMotion, Moment};
use concio::record::Motion;
use concio::wall::{Block, End, Joint};

use super::Options;
use super::data::Data;
use super::wall::{
    Colours, Reach, SIDE, View, beam_foot, bounds, colour_bar, has_beam, headings, line_key, rounded, three,
};
use crate::draw::chart::LETTERS;
use crate::draw::font;
use crate::draw::output::Drawing;
use crate::draw::scale::round_end;
use crate::draw::svg::{Anchor, Canvas, closed, line, px};
use crate::draw::wall::{BRICK, round_length, shade};
use crate::format::{plain, short, si, significant};

/// The largest displacement as drawn, over the length of a typical block.
const DRAWN: f64 = 0.3;

/// The panel at an instant, displacements enlarged, over its outline at rest. Blocks that turn are drawn turned, and the joints
/// that opened or slid lie over them.
pub fn deformed(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let moment = data.moment(options.at, largest_displacement)?;
    let shapes = Shapes::of(data, &moment)?;
    let scale = options.scale.unwrap_or_else(|| automatic_scale(data, shapes.largest));
    let mut canvas = Canvas::default();
    let head = headings(&mut canvas, options.points(), &shapes.texts(&moment, scale));
    let view = View::new(data, options.points(), shapes.reach(data, scale), head);
    let rest = r##"fill="#e6e6e6" stroke="#8c8c8c" stroke-width="0.4""##;
    canvas.path(&shapes.blocks.iter().map(|b| outline(&view, b, 0.0)).collect::<String>(), rest, None);
    if let Some(beam) = shapes.beam {
        view.beam(&mut canvas, data, (Motion::default(), 0.0), rest);
        view.beam(&mut canvas, data, (beam, scale), r##"fill="#c9c9c9" stroke="#222" stroke-width="0.5""##);
    }
    let brick = format!(r##"fill="{BRICK}" stroke="#333" stroke-width="0.5""##);
    for (block, shape) in data.run.wall.blocks.iter().zip(&shapes.blocks) {
        let title = format!("{}: {}", block.name, told(&shape.motion, data.is_planar()));
        canvas.path(&outline(&view, shape, scale), &brick, Some(&title));
    }
    let cracks = data.is_planar().then(|| cracked_joints(&mut canvas, &view, data, &moment, scale));
    view.ground(&mut canvas);
    let displacements = (shapes.largest > 0.0).then_some((scale, shapes.largest));
    let mut bottom = bars(&mut canvas, &view, options.points(), displacements);
    if let Some(cracks) = cracks {
        bottom = cracks_key(&mut canvas, options.points(), bottom, cracks);
    }
    Ok(Drawing {
        body: canvas.into_body(),
        size: [options.points(), bottom],
        title: format!("Deformed wall at {} s, displacements × {}", plain(rounded(moment.time())), plain(scale)),
        note: String::new(),
    })
}

/// How a block has moved, in words.
fn told(motion: &Motion, planar: bool) -> String {
    let across = si(motion.displacement, "m");
    if !planar {
        return across;
    }
    format!("{across} to the right, {} up, turned by {}", si(motion.vertical, "m"), degrees(motion.rotation))
}

fn degrees(rotation: f64) -> String {
    format!("{}°", significant(rotation.to_degrees(), 3))
}

/// A block at rest and how it has moved.
struct Shape {
    /// Corners at rest [m], and how far each of them has moved [m].
    corners: Vec<[[f64; 2]; 2]>,
    motion: Motion,
}

impl Shape {
    fn of(block: &Block, motion: Motion) -> Self {
        let corners = block.corners().into_iter().map(|corner| [corner, motion.of_point_in(block, corner)]);
        Shape { corners: corners.collect(), motion }
    }

    /// The largest way of a corner [m].
    fn largest(&self) -> f64 {
        self.corners.iter().map(|[_, way]| way[0].hypot(way[1])).fold(0.0, f64::max)
    }
}

/// Outline of a block, its displacements `scale` times as large, as path data.
fn outline(view: &View, shape: &Shape, scale: f64) -> String {
    let moved = |[corner, way]: &[[f64; 2]; 2]| view.at([corner[0] + scale * way[0], corner[1] + scale * way[1]]);
    closed(&shape.corners.iter().map(moved).collect::<Vec<_>>())
}

/// The blocks of a wall as they have moved.
struct Shapes {
    blocks: Vec<Shape>,
    beam: Option<Motion>,
    /// The largest way of a corner, or of the beam [m].
    largest: f64,
    planar: bool,
}

impl Shapes {
    fn of(data: &Data, moment: &Moment) -> Result<Self, InputError> {
        let blocks: Vec<Shape> =
            data.run.wall.blocks.iter().enumerate().map(|(i, b)| Shape::of(b, moment.block(i))).collect();
        let beam = has_beam(data).then(|| moment.beam());
        let motions = blocks.iter().map(|b| b.motion).chain(beam);
        let sum: f64 = motions.map(|m| m.displacement + m.vertical + m.rotation).sum();
        if !sum.is_finite() {
            let what = format!("displacements at {} s are not finite", plain(moment.time()));
            return Err(InputError::new(what).key("--at").help("the run failed there: choose an earlier instant"));
        }
        let of_beam = beam.map_or(0.0, |m| m.displacement.hypot(m.vertical));
        let largest = blocks.iter().map(Shape::largest).fold(of_beam, f64::max);
        Ok(Shapes { blocks, beam, largest, planar: data.is_planar() })
    }

    /// How far the wall reaches beyond what it takes at rest when its displacements are enlarged [m].
    fn reach(&self, data: &Data, scale: f64) -> Reach {
        let beam = self.beam.map_or(0.0, |m| m.displacement);
        if !self.planar {
            let ways = self.blocks.iter().map(|b| b.motion.displacement).chain([beam]);
            let [low, high] = ways.fold([0.0f64; 2], |e, z| [e[0].min(z), e[1].max(z)]);
            return Reach { left: -low * scale, right: high * scale, ..Reach::default() };
        }
        let [left, right, bottom, top] = bounds(data);
        let lift = self.beam.map_or(0.0, |m| m.vertical);
        let start = Reach {
            left: (-beam * scale).max(0.0),
            right: (beam * scale).max(0.0),
            above: (lift * scale).max(0.0),
            ..Reach::default()
        };
        let corners = self.blocks.iter().flat_map(|b| &b.corners);
        corners.fold(start, |reach, [corner, way]| {
            let [x, y] = [corner[0] + scale * way[0], corner[1] + scale * way[1]];
            Reach {
                left: reach.left.max(left - x),
                right: reach.right.max(x - right),
                above: reach.above.max(y - top),
                below: reach.below.max(bottom - y),
            }
        })
    }

    fn texts(&self, moment: &Moment, scale: f64) -> Vec<String> {
        let time = format!("t = {}", crate::format::seconds(rounded(moment.time())));
        let drawn =
            if scale == 1.0 { "displacements to scale".into() } else { format!("displacements × {}", plain(scale)) };
        let way = |m: &Motion| m.displacement.hypot(m.vertical);
        let of_blocks = self.blocks.iter().map(|b| way(&b.motion)).fold(0.0, f64::max);
        let mut texts = vec![time, drawn, format!("blocks up to {}", short(three(of_blocks), "m"))];
        if self.planar {
            let turned = self.blocks.iter().map(|b| b.motion.rotation.abs()).fold(0.0, f64::max);
            texts.push(format!("turned by up to {}", degrees(turned)));
        }
        texts.extend(self.beam.map(|m| format!("beam {}", short(three(m.displacement), "m"))));
        texts
    }
}

/// Part of the largest opening, or slip, from which a joint counts as opened, or slid.
const NOTICED: f64 = 0.01;
/// Width of the line of a joint that opened or slid [pt]: least and most.
const CRACK: [f64; 2] = [0.8, 2.4];

/// The joints that opened or slid, on the blocks as they have moved; the largest opening, and the largest slip of those that
/// did not open [m]. Joints whose sides are no neighbours any more are left out.
fn cracked_joints(canvas: &mut Canvas, view: &View, data: &Data, moment: &Moment, scale: f64) -> [f64; 2] {
    let touching = (0..data.run.joints.len()).filter(|&e| !has_parted(data, moment, e));
    let mut joints: Vec<(usize, JointMotion)> = touching.map(|e| (e, moment.joint(e))).collect();
    // Wide ones lie on top.
    joints.sort_by(|(_, a), (_, b)| a.opening.total_cmp(&b.opening));
    let most =
        |of: fn(&JointMotion) -> f64| joints.iter().map(|(_, j)| of(j)).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let (opening, slip) = (most(|j| j.opening), most(|j| j.slip.abs()));
    let mut slid: f64 = 0.0;
    for (e, joint) in joints {
        let part = |value: f64, largest: f64| if largest > 0.0 { (value / largest).min(1.0) } else { 0.0 };
        let width = |part: f64| px(CRACK[0] + (CRACK[1] - CRACK[0]) * part);
        let open = part(joint.opening, opening);
        let attributes = if open > NOTICED {
            let colour = shade(part(joint.opening, round_end(opening)));
            format!(r#"fill="none" stroke="{colour}" stroke-width="{}""#, width(open))
        } else if part(joint.slip.abs(), slip.max(opening)) > NOTICED {
            slid = slid.max(joint.slip.abs());
            slid_line(&width(part(joint.slip.abs(), slip)))
        } else {
            continue;
        };
        let row = &data.run.joints[e];
        let [a, b] = ends(&row.joint).map(|p| {
            let [a, b] = sides(data, moment, &row.joint, p);
            view.at([0, 1].map(|k| p[k] + scale * 0.5 * (a[k] + b[k])))
        });
        let title = format!("{}: opened {}, slid {}", row.name, si(joint.opening, "m"), si(joint.slip, "m"));
        canvas.path(&line([a[0], a[1], b[0], b[1]]), &attributes, Some(&title));
    }
    [opening, slid]
}

/// Part of its length by which the sides of a joint come apart, or along each other, before they are no neighbours any more.
const PARTED: f64 = 0.5;

fn has_parted(data: &Data, moment: &Moment, e: usize) -> bool {
    let joint = &data.run.joints[e].joint;
    let apart = |p: [f64; 2]| {
        let [a, b] = sides(data, moment, joint, p);
        (a[0] - b[0]).hypot(a[1] - b[1])
    };
    let [p, q] = ends(joint).map(apart);
    p.min(q) > PARTED * joint.overlap
}

fn ends(joint: &Joint) -> [[f64; 2]; 2] {
    let [x0, y0, x1, y1] = joint.line;
    [[x0, y0], [x1, y1]]
}

/// How a joint is drawn that slid and did not open.
fn slid_line(width: &str) -> String {
    format!(r##"fill="none" stroke="#1f5fa8" stroke-width="{width}" stroke-dasharray="2 1.2""##)
}

/// How far the two sides of a joint have moved at a point that they share at rest [m].
fn sides(data: &Data, moment: &Moment, joint: &Joint, point: [f64; 2]) -> [[f64; 2]; 2] {
    let blocks = &data.run.wall.blocks;
    let of_block = |i: usize| moment.block(i).of_point_in(&blocks[i], point);
    let other = match joint.b {
        End::Block(b) => of_block(b),
        End::Base => [0.0; 2],
        End::Top => {
            let foot = beam_foot(data);
            moment.beam().of_point([point[0] - foot[0], point[1] - foot[1]])
        }
    };
    [of_block(joint.a), other]
}

/// What the colours and dashes of joints stand for; where it ends [pt].
fn cracks_key(canvas: &mut Canvas, width: f64, from: f64, [opening, slip]: [f64; 2]) -> f64 {
    let mut y = from;
    if opening > 0.0 {
        y = colour_bar(canvas, y, width, &Colours::up_to("opening of joints", "m", opening));
    }
    if slip > 0.0 {
        let text = format!("slid without opening, up to {}", short(three(slip), "m"));
        y = line_key(canvas, width, y, &slid_line(&px(CRACK[1])), &text);
    }
    y
}

/// The largest way of a corner; what comes after a collapse is below all others, because it says nothing of the wall.
fn largest_displacement(data: &Data, moment: &Moment) -> f64 {
    if data.run.outcome.recording.standing(&[moment.time()]) == 0 {
        return -1.0;
    }
    let way = |(i, block): (usize, &Block)| Shape::of(block, moment.block(i)).largest();
    data.run.wall.blocks.iter().enumerate().map(way).fold(0.0, f64::max)
}

/// 1, 2 or 5 times a power of ten, so that the largest displacement shows and blocks stay apart.
fn automatic_scale(data: &Data, largest: f64) -> f64 {
    let mut lengths: Vec<f64> = data.run.wall.blocks.iter().map(concio::wall::Block::length).collect();
    lengths.sort_by(f64::total_cmp);
    let typical = lengths.get(lengths.len() / 2).copied().unwrap_or(1.0);
    if largest > 0.0 { round_length(DRAWN * typical / largest).max(1.0) } else { 1.0 }
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
