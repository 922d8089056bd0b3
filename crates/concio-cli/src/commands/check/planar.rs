//! Joints, bonds, forces and ties of planar walls, which press, part and slide.

use concio::bond;
use concio::case::{BlockForce, Case};
use concio::model::Model;
use concio::planar::{Planar, Rest};
use concio::quantity::Force;
use concio_planar::joint::{Law, Normal};

use super::{KINDS, range};
use crate::draw::wall::kind_name;
use crate::failure::Failure;
use crate::files;
use crate::format::{plain, seconds, si, significant};

/// Up to this rigid joints do not count as settled: 1 nm in each of a hundred courses [m].
const ROUNDED: f64 = 1e-7;

/// Stiffnesses of pressed joints across, of sticking ones along, and friction, kind by kind.
pub fn joint_rows(model: &Model, planar: &Planar) -> Vec<Vec<String>> {
    let mut rows =
        vec![["joints", "number", "pressed", "sheared", "friction", "crushed by"].map(String::from).to_vec()];
    let devices = model.device_of_joint();
    for kind in KINDS {
        let joints = model.joints.iter().zip(&devices).zip(&planar.system.links).zip(&planar.open);
        let joints = joints.filter(|(((joint, device), _), _)| joint.kind == kind && device.is_none());
        let (open, closed): (Vec<_>, Vec<_>) = joints.map(|((_, link), open)| (link, *open)).partition(|of| of.1);
        if open.is_empty() && closed.is_empty() {
            continue;
        }
        let laws: Vec<&Law> = closed.iter().map(|(link, _)| &link.law).collect();
        let finite = |law: &&Law| Some(law.crushing).filter(|f| f.is_finite());
        rows.push(vec![
            kind_name(kind).into(),
            (open.len() + closed.len()).to_string(),
            pressed(&laws, &open.iter().map(|(link, _)| link.apart).collect::<Vec<_>>()),
            range(laws.iter().map(|l| l.shear.stiffness).filter(|k| *k > 0.0), |v| si(v, "N/m")),
            range(laws.iter().filter_map(|l| l.friction).map(|f| f.static_), |v| significant(v, 3)),
            range(laws.iter().filter_map(finite), |v| si(v, "N")),
        ]);
    }
    rows
}

/// Stiffnesses of the joints that have one, restitution of the rigid ones, and of their rocking where it is given; how far the sides of open ones
/// are apart [m].
fn pressed(laws: &[&Law], open: &[f64]) -> String {
    let stiffness = laws.iter().filter_map(|law| match law.normal {
        Normal::Springs { both, press, .. } => Some(both + press).filter(|k| *k > 0.0),
        Normal::Rigid { .. } => None,
    });
    let given = |which: usize| {
        let of = move |law: &&Law| match law.normal {
            Normal::Rigid { restitution, rocking } => Some([restitution, rocking][which]),
            Normal::Springs { .. } => None,
        };
        range(laws.iter().filter_map(of), plain)
    };
    let springs = range(stiffness, |v| si(v, "N/m"));
    let [rigid, rocking] = [0, 1].map(given);
    let rocking = if rocking == "1" { String::new() } else { format!(", η ≤ {rocking}") };
    let filled = match (springs.as_str(), rigid.as_str()) {
        (_, "–") => springs,
        ("–", _) => format!("rigid, e = {rigid}{rocking}"),
        _ => format!("{springs} or rigid, e = {rigid}{rocking}"),
    };
    let gaps = match open.iter().all(|gap| *gap == 0.0) {
        true => "open, sides touch".into(),
        false => format!("open, {} apart", range(open.iter().copied(), |v| si(v, "m"))),
    };
    match (open.is_empty(), laws.is_empty()) {
        (true, _) => filled,
        (false, true) => gaps,
        (false, false) => format!("{filled} or {gaps}"),
    }
}

/// What holds the bonded joints, which part and slide, kind by kind; nothing where there are none.
pub fn bond_rows(case: &Case, model: &Model) -> Result<Vec<Vec<String>>, Failure> {
    if model.shear.bonds.is_empty() {
        return Ok(Vec::new());
    }
    let given = bond::given(case, &model.wall, &model.joints)?;
    let mut rows = vec![["bonds", "number", "f_t", "c", "tan φ", "G_f^I", "G_f^II"].map(String::from).to_vec()];
    for kind in KINDS {
        let bonds = model.shear.bonds.iter().filter(|b| model.joints[b.joint as usize].kind == kind);
        let values: Vec<_> = bonds.filter_map(|b| given[b.joint as usize]).collect();
        if values.is_empty() {
            continue;
        }
        let tough = |v: f64| if v == 0.0 { "brittle".into() } else { si(v, "N/m") };
        rows.push(vec![
            kind_name(kind).into(),
            values.len().to_string(),
            range(values.iter().map(|b| b.tensile_strength), |v| si(v, "Pa")),
            range(values.iter().map(|b| b.cohesion), |v| si(v, "Pa")),
            range(values.iter().map(|b| b.tan_angle), |v| significant(v, 3)),
            range(values.iter().map(|b| b.energy[0]), tough),
            range(values.iter().map(|b| b.energy[1]), tough),
        ]);
    }
    rows.push(vec!["all".into(), model.shear.bonds.len().to_string()]);
    Ok(rows)
}

/// Warns of a wall that does not stand.
pub fn warn_of_fall(planar: &Planar) {
    let open = planar.open.iter().filter(|open| **open).count();
    let why = match open {
        0 => String::new(),
        1 => "; 1 of its joints is open (law `none`) and bears nothing".into(),
        open => format!("; {open} of its joints are open (law `none`) and bear nothing"),
    };
    files::note(&format!("warning: the wall does not stand under its loads: it falls before anything moves{why}"));
}

/// Whether the wall stands before anything moves, and whole.
pub fn rest(rest: Rest, bonds: usize) -> String {
    match rest {
        Rest::Stands { settled, cracked } => {
            let settled = match settled < ROUNDED {
                true => String::new(),
                false => format!(", settled by {} at most", si(settled, "m")),
            };
            let cracked = match cracked {
                0 => String::new(),
                cracked => format!(", {cracked} of {bonds} bonds cracked"),
            };
            format!("stands{settled}{cracked}")
        }
        Rest::Settles(way) => {
            format!("not at rest after {} at most, and laid unsettled: soft joints, or a slow fall", si(way, "m"))
        }
        Rest::Falls => "does not stand: it falls before anything moves".into(),
    }
}

/// The forces on blocks; nothing where there are none.
pub fn force_rows(case: &Case) -> Vec<Vec<String>> {
    if case.forces.is_empty() {
        return Vec::new();
    }
    let values = |values: &[Force]| match values {
        [] => "–".into(),
        [one] => si(one.si(), "N"),
        many => {
            let ends = many.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v.si()), b.max(v.si())]);
            format!("{} values, {} … {}", many.len(), si(ends[0], "N"), si(ends[1], "N"))
        }
    };
    let head = ["forces", "block", "to the right", "upwards", "each for"].map(String::from).to_vec();
    let row = |(number, force): (usize, &BlockForce)| {
        let every = force.every.map_or("–".into(), |every| seconds(every.si()));
        vec![(number + 1).to_string(), force.block.clone(), values(&force.x), values(&force.y), every]
    };
    std::iter::once(head).chain(case.forces.iter().enumerate().map(row)).collect()
}

/// The tie rods; nothing where there are none.
pub fn tie_rows(case: &Case, planar: &Planar) -> Vec<Vec<String>> {
    if planar.system.ties.is_empty() {
        return Vec::new();
    }
    let mut rows = vec![["ties", "from", "to", "stiffness", "yields at"].map(String::from).to_vec()];
    for (number, (rod, tie)) in planar.system.ties.iter().zip(&case.ties).enumerate() {
        let yields = if rod.yield_force.is_finite() { si(rod.yield_force, "N") } else { "–".into() };
        rows.push(vec![(number + 1).to_string(), tie.from.clone(), tie.to.clone(), si(rod.stiffness, "N/m"), yields]);
    }
    rows
}
