//! Joints over time, and friction over slip.

use concio::InputError;
use concio::case::{DeviceLaw, JointKind};

use super::data::{Data, Motion};
use super::{Options, asked, choose, largest, letter};
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;
use crate::draw::scale::around;

/// Joints in a figure when none are chosen.
const FEW: usize = 4;

/// Histories of the relative displacement of neighbours; of the head joints that opened or closed most unless joints
/// are named. All have one scale.
pub fn histories(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let joints = &data.run.joints;
    let chosen = if options.joints.is_empty() {
        choose(&data.sampled_joints(), FEW, |among| {
            let peaks = &data.run.outcome.envelopes.joint_displacement;
            let heads = largest(peaks, |e| among(e) && joints[e].joint.kind == JointKind::Head, FEW);
            if heads.is_empty() { largest(peaks, among, FEW) } else { heads }
        })
    } else {
        asked(&options.joints, "--joints", |n| data.joint(n))?
    };
    if chosen.is_empty() {
        return Err(InputError::new("no joint moved").help("name joints with --joints"));
    }
    let motions: Result<Vec<_>, _> = chosen.iter().map(|&e| data.joint_motion(e)).collect();
    let motions = motions?;
    let coarse: Vec<&str> =
        chosen.iter().zip(&motions).filter(|(_, m)| !m.sampled).map(|(&e, _)| joints[e].name.as_str()).collect();
    let range = around(motions.iter().flat_map(|m| &m.displacement), 0.06);
    let upright = chosen.iter().filter(|&&e| joints[e].joint.kind.is_upright()).count();
    let quantity = if data.is_planar() {
        "slip"
    } else if upright == chosen.len() {
        "gap"
    } else if upright == 0 {
        "slip"
    } else {
        "gap, slip"
    };
    let panel = |(k, (&e, motion)): (usize, (&usize, &Motion))| Panel {
        heading: letter(k, chosen.len(), &format!("{}, {}", joints[e].name, kind(joints[e].joint.kind))),
        x: Axis { quantity: "time".into(), unit: "s", ..Axis::default() },
        y: Axis { quantity: quantity.into(), unit: "m", range: Some(range), ..Axis::default() },
        lines: vec![Line { x: motion.time.clone().into(), y: motion.displacement.clone().into(), style: 0 }],
        rising: true,
        bare: k + 1 < chosen.len(),
        marked: false,
    };
    let drawing = chart::draw(&Sheet {
        title: if data.is_planar() {
            "Histories of the sliding of neighbouring blocks along their joints".into()
        } else {
            "Histories of the relative displacement of neighbouring blocks (positive opens a head joint)".into()
        },
        legend: Vec::new(),
        panels: chosen.iter().zip(&motions).enumerate().map(panel).collect(),
        columns: 1,
        width: options.points(),
        height: Some(if chosen.len() == 1 { 90.0 } else { 52.0 }),
    });
    Ok(Drawing { note: data.coarse("joints", &coarse), ..drawing })
}

fn kind(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Bed => "bed joint",
        JointKind::Head => "head joint",
        JointKind::Base => "base joint",
        JointKind::Top => "top joint",
        JointKind::Connection => "connection",
    }
}

/// Friction force over slip, of devices with a law of their own theirs; of the joints that dissipated most unless joints are named.
pub fn hysteresis(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let joints = &data.run.joints;
    let yields = |law: DeviceLaw| matches!(law, DeviceLaw::BoucWen | DeviceLaw::ReCentring);
    let rubs = |e: usize| joints[e].friction.is_some() || joints[e].device.is_some_and(yields);
    let known: Vec<usize> = data.sampled_joints().into_iter().filter(|&e| rubs(e)).collect();
    let chosen = if options.joints.is_empty() {
        let dissipated = &data.run.outcome.envelopes.joint_dissipation;
        choose(&known, 2, |among| largest(dissipated, |e| among(e) && rubs(e), 2))
    } else {
        asked(&options.joints, "--joints", |n| data.joint(n))?
    };
    if let Some(&e) = chosen.iter().find(|&&e| !rubs(e)) {
        let error = InputError::new(format!("joint {} has no friction, and no device that yields", joints[e].name))
            .key("--joints");
        return Err(error.help("choose bed or support joints, or `friction.on = \"all\"` in the wall file"));
    }
    if chosen.is_empty() {
        return Err(InputError::new("no joint of this wall rubs").help("give the joints friction in the wall file"));
    }
    let coarse: Vec<&str> = chosen.iter().filter(|e| !known.contains(e)).map(|&e| joints[e].name.as_str()).collect();
    let note = data.coarse("joints", &coarse);
    let loops: Result<Vec<_>, _> = chosen.iter().map(|&e| data.joint_friction(e)).collect();
    let panel = |(k, (&e, [slip, force])): (usize, (&usize, [Vec<f64>; 2]))| Panel {
        heading: letter(k, chosen.len(), &joints[e].name),
        x: Axis { quantity: "slip".into(), unit: "m", ..Axis::default() },
        y: Axis { quantity: "friction force".into(), unit: "N", ..Axis::default() },
        lines: vec![Line { x: slip.into(), y: force.into(), style: 0 }],
        rising: false,
        bare: false,
        marked: false,
    };
    let drawing = chart::draw(&Sheet {
        title: "Friction force over the slip of joints".into(),
        legend: Vec::new(),
        panels: chosen.iter().zip(loops?).enumerate().map(panel).collect(),
        columns: options.columns(chosen.len().min(2)).min(chosen.len()),
        width: options.points(),
        height: (chosen.len() == 1).then_some(0.6 * options.points().min(360.0)),
    });
    Ok(Drawing { note, ..drawing })
}
