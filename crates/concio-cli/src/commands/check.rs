//! `concio check`.

use concio::bond;
use concio::case::{Beam, Bond, Case, DeviceLaw, JointKind, Panel, StopAt};
use concio::device;
use concio::model::{Model, System};
use concio::planar::{Rest, tie_lines};
use concio::rocking::Rocking;
use concio_study::shaking::{Mode, first_mode};

mod openings;
mod planar;

use super::wall_file;
use crate::args::Check;
use crate::draw::wall::{self, Paint, Subject, kind_name, mass};
use crate::failure::Failure;
use crate::format::{columns, line, pairs, plain, seconds, si, significant};
use crate::{files, report};

/// Most blocks of walls whose rest and first period are looked for.
pub(super) const TRIED: usize = 2_000;
/// Courses of one length that are named at most.
const MOST_COURSES: usize = 8;
const KINDS: [JointKind; 5] = [JointKind::Base, JointKind::Bed, JointKind::Head, JointKind::Connection, JointKind::Top];

/// Validates a wall file and prints what it describes.
pub fn check(args: &Check) -> Result<(), Failure> {
    if let Some(path) = &args.svg {
        files::guard(path, "svg", &[&args.file])?;
    }
    let file = wall_file::read(&args.file)?;
    let prepared = wall_file::prepare(&file)?;
    let model = &prepared.model;
    let lopsided = model.planar().is_some() && !planar::is_symmetric(&prepared.case, model);
    let motion = wall_file::motion(&file, &prepared, lopsided)?;
    crate::warned::warn(&file, &model.warnings);
    if let Some(path) = &args.svg {
        let names = model.joint_names();
        let beam = report::beam_label(&prepared.case);
        let ties = tie_lines(&prepared.case, &model.wall);
        let subject = Subject { wall: &model.wall, joints: &model.joints, names: &names, ties: &ties, beam: &beam };
        files::write(path, &wall::draw(&subject, Paint::Kinds))?;
    }
    let duration = model.excitation.duration;
    let samples = (duration / prepared.sampling.interval).floor() as u64 + 1;
    let mut general = vec![("unknowns", unknowns(model).to_string()), ("mass", masses(&prepared.case, model))];
    if model.top_load > 0.0 {
        general.push(("load on top", load_on_top(model)));
    }
    let mut falls = false;
    if let Some(own) = model.rocking() {
        general.extend(rocking_rows(own));
    } else if model.wall.blocks.len() > TRIED {
        let not_asked = format!("not asked of more than {TRIED} blocks; `concio run` settles the wall first");
        general.extend(model.planar().map(|_| ("under its loads", not_asked)));
        general.push(("first period", format!("not asked of more than {TRIED} blocks")));
    } else {
        if let Some(own) = model.planar() {
            let rest = own.rest();
            falls = rest == Rest::Falls;
            if falls {
                planar::warn_of_fall(own);
            }
            general.push(("under its loads", planar::rest(rest, model.shear.bonds.len())));
        }
        let mode = first_mode(model);
        let told = |m: Mode| {
            let damping = significant(100.0 * m.damping, 3);
            format!("{}, {}, damped by {damping} %", si(m.period, "s"), si(1.0 / m.period, "Hz"))
        };
        general.push(("first period", mode.map_or_else(|| no_period(model, falls), told)));
    }
    let case = &prepared.case;
    let stops = case
        .motion
        .stop_at
        .map_or(String::new(), |StopAt::Collapse(after)| format!("; ends {} after a collapse", seconds(after.si())));
    general.push(("duration", format!("{}, {samples} samples kept{stops}", seconds(duration))));
    let (mut joints, bonds, ties) = match model.planar() {
        None => (joint_rows(model), bond_rows(case, model)?, Vec::new()),
        Some(own) => {
            (planar::joint_rows(model, own), planar::bond_rows(case, model)?, planar::tie_rows(case, model, own))
        }
    };
    // Laws of joints are those of blocks, which a rocking wall has not.
    let devices = if model.rocking().is_some() { Vec::new() } else { device_rows(case, model)? };
    if devices.is_empty() {
        joints.push(vec!["all".into(), model.joints.len().to_string()]);
    }
    let table = |rows: &[Vec<String>]| if rows.is_empty() { String::new() } else { format!("{}\n", columns(rows)) };
    let list = if args.joints { format!("\n{}", columns(&joint_list(model))) } else { String::new() };
    let title = &case.title;
    let title = if title.is_empty() { String::new() } else { format!("{}\n\n", line(title)) };
    let but = if falls { ", but its wall does not stand under its loads" } else { "" };
    let text = format!(
        "{title}{}\n{}{}{}\n{}{}{}{}{}\n{}{list}\n{} is a valid wall file{but}.\n",
        columns(&panel_rows(model)),
        table(&course_rows(case, model)),
        openings::told(case)?,
        columns(&joints),
        table(&devices),
        table(&bonds),
        table(&ties),
        table(&planar::force_rows(case)),
        pairs(&general),
        pairs(&motion),
        args.file.display()
    );
    files::print(&text)
}

fn unknowns(model: &Model) -> usize {
    match model.system {
        System::Shear => model.unknowns(),
        System::Planar(_) => 3 * model.unknowns(),
        System::Rocking(_) => 1,
    }
}

/// The mechanism that rocks.
fn rocking_rows(own: &Rocking) -> Vec<(&'static str, String)> {
    let mechanism = format!("{}, hinge at {}", own.kind.what(), si(own.hinge, "m"));
    let holds = match own.compiled.d0() {
        Some(d0) => format!("d_C0 = {} at its control point", si(d0.displacement, "m")),
        None => "its weights hold at any turn".into(),
    };
    let sets_off = format!("at α = {}; {holds}", significant(own.compiled.multiplier(), 4));
    vec![
        ("mechanism", mechanism),
        ("sets off", sets_off),
        ("restitution", significant(own.compiled.restitution(), 3)),
        ("ties", own.mechanism.ties.len().to_string()),
    ]
}

fn panel_rows(model: &Model) -> Vec<Vec<String>> {
    // A wall that rocks out of its plane is seen in section.
    let across = if model.rocking().is_some() { "thickness" } else { "width" };
    let mut rows = vec![["panel", "courses", "blocks", across, "height", "mass"].map(String::from).to_vec()];
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

/// Why a wall has no first period.
fn no_period(model: &Model, falls: bool) -> String {
    let contacts = model.shear.contact_of_joint();
    let why = if falls {
        "the wall falls"
    } else if contacts.iter().any(Option::is_some) {
        "its joints are rigid"
    } else {
        "nothing holds one of its blocks"
    };
    format!("none: {why}")
}

/// Lengths of courses that are listed one by one and differ, the most frequent first; nothing where all are one.
fn course_rows(case: &Case, model: &Model) -> Vec<Vec<String>> {
    let mut rows = vec![["courses of", "length", "number", "which"].map(String::from).to_vec()];
    for (panel, info) in case.panels.iter().zip(&model.wall.panels) {
        let mut lengths: Vec<(String, Vec<String>)> = Vec::new();
        for (number, course) in panel.course_list.iter().enumerate() {
            let [from, to] = course.ends(panel.mortar.head);
            let (length, number) = (si(to - from, "m"), (number + 1).to_string());
            match lengths.iter_mut().find(|(own, _)| *own == length) {
                Some((_, which)) => which.push(number),
                None => lengths.push((length, vec![number])),
            }
        }
        lengths.sort_by_key(|(_, which)| std::cmp::Reverse(which.len()));
        for (length, which) in lengths.iter().filter(|_| lengths.len() > 1) {
            let more = if which.len() > MOST_COURSES { ", …" } else { "" };
            let named = which.iter().take(MOST_COURSES).cloned().collect::<Vec<_>>().join(", ") + more;
            rows.push(vec![info.name.clone(), length.clone(), which.len().to_string(), named]);
        }
    }
    if rows.len() > 1 { rows } else { Vec::new() }
}

fn joint_rows(model: &Model) -> Vec<Vec<String>> {
    let mut rows = vec![["joints", "number", "stiffness", "friction", "normal force"].map(String::from).to_vec()];
    let devices = model.device_of_joint();
    for kind in KINDS {
        let is_one = |e: &usize| model.joints[*e].kind == kind && devices[*e].is_none();
        let members: Vec<usize> = (0..model.joints.len()).filter(is_one).collect();
        if members.is_empty() {
            continue;
        }
        let rubs: Vec<_> = model.shear.rubs.iter().filter(|r| is_one(&(r.joint as usize))).collect();
        let friction = range(rubs.iter().map(|r| r.law.static_), |v| significant(v, 3));
        let normal = range(rubs.iter().flat_map(|r| r.normal), |v| si(v, "N"));
        rows.push(vec![
            kind_name(kind).into(),
            members.len().to_string(),
            stiffness(model, &members),
            friction,
            normal,
        ]);
    }
    rows
}

/// The joints that are devices, law by law, after which nothing but their sum with the others is left; nothing where there are none.
fn device_rows(case: &Case, model: &Model) -> Result<Vec<Vec<String>>, Failure> {
    let mut laws: Vec<DeviceLaw> = Vec::new();
    let ratings = device::ratings(case, &model.wall, &model.joints)?;
    for device in &ratings {
        if !laws.contains(&device.law) {
            laws.push(device.law);
        }
    }
    if laws.is_empty() {
        return Ok(Vec::new());
    }
    let mut rows = vec![["devices", "number", "at rest", "dashpot", "gives way at"].map(String::from).to_vec()];
    for law in laws {
        let of = || ratings.iter().filter(move |d| d.law == law);
        let positive = |value: f64| Some(value).filter(|v| *v > 0.0 && v.is_finite());
        rows.push(vec![
            law.name().into(),
            of().count().to_string(),
            range(of().filter_map(|d| positive(d.stiffness)), |v| si(v, "N/m")),
            range(of().filter_map(|d| positive(d.damping)), |v| si(v, "N s/m")),
            range(of().filter_map(|d| positive(d.gives_way)), |v| si(v, "N")),
        ]);
    }
    rows.push(vec!["all joints".into(), model.joints.len().to_string()]);
    Ok(rows)
}

/// Stiffnesses of the joints that have one, restitution of the rigid ones.
fn stiffness(model: &Model, members: &[usize]) -> String {
    let contacts = model.shear.contact_of_joint();
    let (rigid, springs): (Vec<usize>, Vec<usize>) = members.iter().partition(|&e| contacts[*e].is_some());
    let restitution =
        range(rigid.iter().filter_map(|&e| contacts[e]).map(|c| model.shear.contacts[c].restitution), plain);
    let rigid = (!rigid.is_empty()).then(|| format!("rigid, e = {restitution}"));
    let stiffness = range(springs.iter().map(|&e| model.shear.elastic[e].stiffness), |v| si(v, "N/m"));
    // Bonds make springs one-sided whose law is not.
    let bonded = model.shear.bond_of_joint();
    let by_bond =
        |e: usize| bonded[e].is_some_and(|b| model.shear.bonds[b].law.stiffness == model.shear.elastic[e].stiffness);
    let unilateral = springs.iter().any(|&e| model.shear.elastic[e].unilateral && !by_bond(e));
    let unit = if unilateral { " (κ K_V)" } else { "" };
    let springs = (!springs.is_empty()).then(|| format!("{stiffness}{unit}"));
    springs.into_iter().chain(rigid).collect::<Vec<_>>().join(" or ")
}

/// What holds the bonded joints, kind by kind; nothing where there are none.
fn bond_rows(case: &Case, model: &Model) -> Result<Vec<Vec<String>>, Failure> {
    if model.shear.bonds.is_empty() {
        return Ok(Vec::new());
    }
    let given = bond::given(case, &model.wall, &model.joints)?;
    let head = ["bonds", "number", "f_t or c", "tan φ", "G_f", "strength"];
    let mut rows = vec![head.map(String::from).to_vec()];
    for kind in KINDS {
        let bonds = || model.shear.bonds.iter().filter(|b| model.joints[b.joint as usize].kind == kind);
        let values = || bonds().filter_map(|b| given[b.joint as usize]);
        let upright = kind.is_upright();
        let holds = range(values().map(|b| if upright { b.tensile_strength } else { b.cohesion }), |v| si(v, "Pa"));
        let angle = if upright { "–".into() } else { range(values().map(|b| b.tan_angle), |v| significant(v, 3)) };
        let tough = |v: f64| if v == 0.0 { "brittle".into() } else { si(v, "N/m") };
        let energy = range(values().map(|b| b.energy[usize::from(!upright)]), tough);
        let strength = range(bonds().map(|b| b.law.strength), |v| si(v, "N"));
        if bonds().next().is_some() {
            rows.push(vec![kind_name(kind).into(), bonds().count().to_string(), holds, angle, energy, strength]);
        }
    }
    rows.push(vec!["all".into(), model.shear.bonds.len().to_string()]);
    Ok(rows)
}

/// Mass of the blocks, and of a beam that has one [kg]: what a planar wall is led by has a body too.
/// Of wall and beam, and that of a load that stands on the wall.
fn masses(case: &Case, model: &Model) -> String {
    let load = model.load_mass;
    let of_load = if load > 0.0 { format!(", and {} of the load", mass(load)) } else { String::new() };
    let bare = if model.rocking().is_none() { unweighed(case) } else { 0.0 };
    let of_mortar = if bare > 0.0 {
        format!("; mortar, {} % of its area, weighs nothing", significant(100.0 * bare, 2))
    } else {
        String::new()
    };
    mass(total(model)) + &of_load + &of_mortar
}

/// Part of regular brickwork that is mortar, which has no mass, as the first panel has it.
fn unweighed(case: &Case) -> f64 {
    let regular = |panel: &&Panel| matches!(panel.bond, Bond::Running | Bond::Stack);
    case.panels.first().filter(regular).map_or(0.0, |Panel { brick, mortar, .. }| {
        let [length, height] = [brick.length.si(), brick.height.si()];
        1.0 - length * height / ((length + mortar.head.si()) * (height + mortar.bed.si()))
    })
}

/// The vertical force of `load.top`, which counts bricks and no mortar, and what it presses on: the joints below a beam, or the top sides.
fn load_on_top(model: &Model) -> String {
    let wall = &model.wall;
    let below = |joint: &&concio::wall::Joint| joint.kind == JointKind::Top;
    let joints: f64 = model.joints.iter().filter(below).map(|joint| joint.area(wall)).sum();
    let sides = || wall.loaded().iter().zip(&wall.blocks).map(|(length, block)| length * block.thickness).sum();
    let area = if joints > 0.0 { joints } else { sides() };
    format!("{}, {} on {} m² of bricks", si(model.top_load, "N"), si(model.top_load / area, "Pa"), significant(area, 4))
}

fn total(model: &Model) -> f64 {
    let of_beam = if let Beam::Mass(m) = model.beam { m.si() } else { 0.0 };
    model.wall.blocks.iter().map(|b| b.mass()).sum::<f64>() + of_beam
}

fn joint_list(model: &Model) -> Vec<Vec<String>> {
    let mut rows = vec![["joint", "kind", "course", "overlap", "normal force"].map(String::from).to_vec()];
    // A column of its own only where there is something to tell.
    let devices = model.device_of_joint();
    if !model.devices.is_empty() {
        rows[0].push("device".into());
    }
    let rubs = model.shear.rub_of_joint();
    // Statics by columns knows upright sides alone.
    let upright = model.wall.blocks.iter().all(concio::wall::Block::is_rectangle);
    for (((joint, name), rub), device) in model.joints.iter().zip(model.joint_names()).zip(rubs).zip(devices) {
        // A friction damper slips at a force of its own, whatever presses it.
        let rub = rub.filter(|_| device.is_none() && upright);
        let normal = rub.map_or("–".into(), |r| range(model.shear.rubs[r].normal.into_iter(), |v| si(v, "N")));
        let course = joint.course(&model.wall).to_string();
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
