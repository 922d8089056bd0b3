//! Phase portraits: velocity over displacement, of blocks relative to the base and of joints.

use concio::InputError;

use super::data::{Data, Motion, is_upright};
use super::{Options, asked, largest, letter};
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;

/// Portraits in a figure when none are chosen.
const FEW: usize = 4;

/// Of blocks; of those that moved most in courses spread over the height unless they are named.
pub fn blocks(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let known = data.asked_for("block");
    let chosen = match (options.blocks.is_empty(), known.is_empty()) {
        (false, _) => asked(&options.blocks, "--blocks", |n| data.block(n))?,
        (true, false) => known.iter().take(FEW).map(|n| data.block(n)).collect::<Result<_, _>>()?,
        (true, true) => spread(data),
    };
    let blocks = &data.run.wall.blocks;
    let portraits: Result<Vec<_>, _> =
        chosen.iter().map(|&i| Ok((blocks[i].name.clone(), data.block_motion(i)?))).collect();
    let title = "Phase portraits of blocks: velocity over displacement, relative to the base";
    draw(data, options, title, ["displacement", "velocity"], &portraits?)
}

/// Of joints; of head and bed joints that moved most unless they are named.
pub fn joints(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let joints = &data.run.joints;
    let known = data.asked_for("joint");
    let chosen = if options.joints.is_empty() && !known.is_empty() {
        known.iter().take(FEW).map(|n| data.joint(n)).collect::<Result<_, _>>()?
    } else if options.joints.is_empty() {
        let peaks = &data.run.outcome.envelopes.joint_displacement;
        let of = |upright: bool| largest(peaks, |e| is_upright(joints[e].joint.kind) == upright, FEW / 2);
        [of(true), of(false)].concat()
    } else {
        asked(&options.joints, "--joints", |n| data.joint(n))?
    };
    if chosen.is_empty() {
        return Err(InputError::new("no joint moved").help("name joints with --joints"));
    }
    let portraits: Result<Vec<_>, _> =
        chosen.iter().map(|&e| Ok((joints[e].name.clone(), data.joint_motion(e)?))).collect();
    let title = "Phase portraits of joints: relative velocity over relative displacement of their sides";
    draw(data, options, title, ["rel. displacement", "rel. velocity"], &portraits?)
}

/// Of up to [`FEW`] courses, spread over the height of the wall, the block that moved most, the highest first.
fn spread(data: &Data) -> Vec<usize> {
    let wall = &data.run.wall;
    let peaks = &data.run.outcome.envelopes.block_displacement;
    let most = |panel: usize, course: usize| {
        largest(peaks, |i| wall.blocks.get(i).is_some_and(|b| b.panel == panel && b.course == course), 1)
    };
    let tallest = (0..wall.panels.len()).max_by_key(|&p| (wall.panels[p].courses, usize::MAX - p)).unwrap_or(0);
    let courses = wall.panels.get(tallest).map_or(0, |p| p.courses);
    let few = FEW.min(courses);
    let course = |k: usize| (courses - 1) * (few - 1 - k) / (few - 1).max(1);
    let found: Vec<usize> = (0..few).flat_map(|k| most(tallest, course(k))).collect();
    if found.is_empty() { (0..wall.blocks.len().min(1)).collect() } else { found }
}

fn draw(
    data: &Data,
    options: &Options,
    title: &str,
    [displacement, velocity]: [&str; 2],
    portraits: &[(String, Motion)],
) -> Result<Drawing, InputError> {
    let panel = |(k, (name, motion)): (usize, &(String, Motion))| Panel {
        heading: letter(k, portraits.len(), name),
        x: Axis { quantity: displacement.into(), unit: "m", ..Axis::default() },
        y: Axis { quantity: velocity.into(), unit: "m/s", ..Axis::default() },
        lines: vec![Line { x: motion.displacement.clone().into(), y: motion.velocity.clone().into(), style: 0 }],
        rising: false,
        bare: false,
    };
    let columns = options.columns(if portraits.len() > 1 { 2 } else { 1 });
    let coarse: Vec<&str> = portraits.iter().filter(|p| !p.1.sampled).map(|p| p.0.as_str()).collect();
    let key = if displacement.starts_with("rel") { "joints" } else { "blocks" };
    let drawing = chart::draw(&Sheet {
        title: title.into(),
        legend: Vec::new(),
        panels: portraits.iter().enumerate().map(panel).collect(),
        columns,
        width: options.points(),
        height: (portraits.len() == 1).then_some(0.6 * options.points().min(400.0)),
    });
    Ok(Drawing { note: data.coarse(key, &coarse), ..drawing })
}
