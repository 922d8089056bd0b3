//! Phase portraits: velocity over displacement, of blocks relative to the base and of joints.

use concio::InputError;

use super::data::{Data, Motion};
use super::{Options, asked, choose, largest, letter};
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;

/// Portraits in a figure when none are chosen.
const FEW: usize = 4;

/// Of blocks; of those that moved most in courses spread over the height unless they are named.
pub fn blocks(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let chosen = if options.blocks.is_empty() {
        choose(&data.sampled_blocks(), FEW, |among| spread(data, among))
    } else {
        asked(&options.blocks, "--blocks", |n| data.block(n))?
    };
    let blocks = &data.run.wall.blocks;
    let portraits: Result<Vec<_>, _> =
        chosen.iter().map(|&i| Ok((blocks[i].name.as_str(), "displacement", data.block_motion(i)?))).collect();
    let title = "Phase portraits of blocks: velocity over displacement, relative to the base";
    draw(data, options, title, &portraits?)
}

/// Of joints; of head and bed joints that moved most unless they are named.
pub fn joints(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let joints = &data.run.joints;
    let chosen = if options.joints.is_empty() {
        choose(&data.sampled_joints(), FEW, |among| {
            let peaks = &data.run.outcome.envelopes.joint_displacement;
            let is = |e: usize, upright: bool| among(e) && joints[e].joint.kind.is_upright() == upright;
            [true, false].map(|upright| largest(peaks, |e| is(e, upright), FEW / 2)).concat()
        })
    } else {
        asked(&options.joints, "--joints", |n| data.joint(n))?
    };
    if chosen.is_empty() {
        return Err(InputError::new("no joint moved").help("name joints with --joints"));
    }
    let portrait = |&e: &usize| {
        let gap = joints[e].joint.kind.is_upright() && !data.is_planar();
        let (name, motion) = (joints[e].name.as_str(), data.joint_motion(e)?);
        if data.is_planar() && !motion.sampled {
            let error = InputError::new(format!("the velocity of joint {name} was not kept")).key("--joints");
            return Err(error.help(format!("run the wall file again with `joints = [\"{name}\"]` under [output]")));
        }
        Ok((name, if gap { "gap" } else { "slip" }, motion))
    };
    let portraits: Result<Vec<_>, _> = chosen.iter().map(portrait).collect();
    let title = "Phase portraits of joints: relative velocity over relative displacement of their sides";
    draw(data, options, title, &portraits?)
}

/// Of up to [`FEW`] courses, spread over the height of the wall, the block that moved most, the highest first.
fn spread(data: &Data, among: &dyn Fn(usize) -> bool) -> Vec<usize> {
    let wall = &data.run.wall;
    let peaks = &data.run.outcome.envelopes.block_displacement;
    let most = |panel: usize, course: usize| {
        largest(peaks, |i| among(i) && wall.blocks.get(i).is_some_and(|b| b.panel == panel && b.course == course), 1)
    };
    let tallest = (0..wall.panels.len()).max_by_key(|&p| (wall.panels[p].courses, usize::MAX - p)).unwrap_or(0);
    let courses = wall.panels.get(tallest).map_or(0, |p| p.courses);
    let few = FEW.min(courses);
    let course = |k: usize| (courses - 1) * (few - 1 - k) / (few - 1).max(1);
    let found: Vec<usize> = (0..few).flat_map(|k| most(tallest, course(k))).collect();
    if found.is_empty() { (0..wall.blocks.len().min(1)).collect() } else { found }
}

/// Names, what the displacement is called, and motions.
fn draw(
    data: &Data,
    options: &Options,
    title: &str,
    portraits: &[(&str, &str, Motion)],
) -> Result<Drawing, InputError> {
    let panel = |(k, (name, quantity, motion)): (usize, &(&str, &str, Motion))| Panel {
        heading: letter(k, portraits.len(), name),
        x: Axis { quantity: (*quantity).into(), unit: "m", ..Axis::default() },
        y: Axis { quantity: "velocity".into(), unit: "m/s", ..Axis::default() },
        lines: vec![Line { x: motion.displacement.clone().into(), y: motion.velocity.clone().into(), style: 0 }],
        rising: false,
        bare: false,
        marked: false,
    };
    let drawing = chart::draw(&Sheet {
        title: title.into(),
        legend: Vec::new(),
        panels: portraits.iter().enumerate().map(panel).collect(),
        columns: options.columns(if portraits.len() > 1 { 2 } else { 1 }),
        width: options.points(),
        height: (portraits.len() == 1).then_some(0.6 * options.points().min(400.0)),
    });
    let coarse: Vec<&str> = portraits.iter().filter(|p| !p.2.sampled).map(|p| p.0).collect();
    let of_blocks = portraits.iter().all(|p| p.1 == "displacement");
    Ok(Drawing { note: data.coarse(if of_blocks { "blocks" } else { "joints" }, &coarse), ..drawing })
}
