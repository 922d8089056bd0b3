//! `concio check`.

use concio::case::JointKind;
use concio::model::Model;

use super::wall_file;
use crate::args::Check;
use crate::draw::wall::{self, Paint, Subject, kind_name, mass};
use crate::failure::Failure;
use crate::format::{columns, pairs, seconds, si, significant};
use crate::{files, report};

const KINDS: [JointKind; 5] = [JointKind::Base, JointKind::Bed, JointKind::Head, JointKind::Connection, JointKind::Top];

/// Validates a wall file and prints what it describes.
pub fn check(args: &Check) -> Result<(), Failure> {
    if let Some(path) = &args.svg {
        files::guard(path, "svg", &[&args.file])?;
    }
    let file = wall_file::read(&args.file)?;
    let prepared = wall_file::prepare(&file)?;
    let model = &prepared.model;
    let motion = wall_file::motion(&file, &prepared)?;
    for warning in &model.warnings {
        files::note(&format!("warning: {warning}"));
    }
    if let Some(path) = &args.svg {
        let names = model.joint_names();
        let beam = report::beam_label(&prepared.case);
        let subject = Subject { wall: &model.wall, joints: &model.joints, names: &names, beam: &beam };
        files::write(path, &wall::draw(&subject, Paint::Kinds))?;
    }
    let duration = model.excitation.duration;
    let samples = (duration / prepared.sampling.interval).floor() as u64 + 1;
    let general = pairs(&[
        ("unknowns", model.unknowns().to_string()),
        ("mass", mass(model.mass.iter().sum())),
        ("duration", format!("{}, {samples} samples kept", seconds(duration))),
    ]);
    let list = if args.joints { format!("\n{}", columns(&joint_list(model))) } else { String::new() };
    let title = &prepared.case.title;
    let title = if title.is_empty() { String::new() } else { format!("{title}\n\n") };
    let text = format!(
        "{title}{}\n{}\n{general}\n{}{list}\n{} is a valid wall file.\n",
        columns(&panel_rows(model)),
        columns(&joint_rows(model)),
        pairs(&motion),
        args.file.display()
    );
    files::print(&text)
}

fn panel_rows(model: &Model) -> Vec<Vec<String>> {
    let mut rows = vec![["panel", "courses", "blocks", "width", "height", "mass"].map(String::from).to_vec()];
    for (number, panel) in model.wall.panels.iter().enumerate() {
        let blocks: Vec<_> = model.wall.blocks.iter().filter(|b| b.panel == number).collect();
        let [left, right, top] = blocks.iter().fold([f64::INFINITY, f64::NEG_INFINITY, 0.0], |e, b| {
            [e[0].min(b.x[0]), e[1].max(b.x[1]), f64::max(e[2], b.y[1])]
        });
        rows.push(vec![
            panel.name.clone(),
            panel.courses.to_string(),
            blocks.len().to_string(),
            si(right - left, "m"),
            si(top, "m"),
            mass(blocks.iter().map(|b| b.mass()).sum()),
        ]);
    }
    rows
}

fn joint_rows(model: &Model) -> Vec<Vec<String>> {
    let mut rows = vec![["joints", "number", "stiffness", "friction", "normal force"].map(String::from).to_vec()];
    for kind in KINDS {
        let members: Vec<usize> = (0..model.joints.len()).filter(|&e| model.joints[e].kind == kind).collect();
        if members.is_empty() {
            continue;
        }
        let rubs: Vec<_> = model.rubs.iter().filter(|r| model.joints[r.joint as usize].kind == kind).collect();
        let friction = range(rubs.iter().map(|r| r.law.static_), |v| significant(v, 3));
        let normal = range(rubs.iter().flat_map(|r| r.normal), |v| si(v, "N"));
        let stiffness = range(members.iter().map(|&e| model.elastic[e].stiffness), |v| si(v, "N/m"));
        let unilateral = members.iter().any(|&e| model.elastic[e].unilateral);
        let stiffness = if unilateral { format!("{stiffness} (κ K_V)") } else { stiffness };
        rows.push(vec![kind_name(kind).into(), members.len().to_string(), stiffness, friction, normal]);
    }
    rows.push(vec!["all".into(), model.joints.len().to_string()]);
    if !model.devices.is_empty() {
        rows.push(vec!["  with devices".into(), model.devices.len().to_string()]);
    }
    rows
}

fn joint_list(model: &Model) -> Vec<Vec<String>> {
    let mut rows = vec![["joint", "kind", "course", "weight", "normal force"].map(String::from).to_vec()];
    // A column of its own only where there is something to tell.
    let devices = model.device_of_joint();
    if !model.devices.is_empty() {
        rows[0].push("device".into());
    }
    let rubs = model.rub_of_joint();
    for (((joint, name), rub), device) in model.joints.iter().zip(model.joint_names()).zip(rubs).zip(devices) {
        let normal = rub.map_or("–".into(), |r| range(model.rubs[r].normal.into_iter(), |v| si(v, "N")));
        let course = (model.wall.blocks[joint.a].course + 1).to_string();
        let mut row = vec![name, kind_name(joint.kind).into(), course, significant(joint.weight, 4), normal];
        if !model.devices.is_empty() {
            row.push(device.map_or("–", |law| law.name()).into());
        }
        rows.push(row);
    }
    rows
}

/// `a`, or `a … b` when values differ by more than rounding; `–` when there are none.
fn range(values: impl Iterator<Item = f64>, show: impl Fn(f64) -> String) -> String {
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |r, v| [r[0].min(v), r[1].max(v)]);
    match (low <= high, show(low) == show(high)) {
        (false, _) => "–".into(),
        (true, true) => show(low),
        (true, false) => format!("{} … {}", show(low), show(high)),
    }
}
