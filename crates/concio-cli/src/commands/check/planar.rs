//! Joints, bonds, forces and ties of planar walls, which press, part and slide.

use concio::bond;
use concio::case::{BlockForce, Case, JointChange};
use concio::model::Model;
use concio::planar::{Planar, Rest, tie_lines};
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
        Rest::Stands { settled, cracked, unsolved } => {
            let settled = match settled < ROUNDED {
                true => String::new(),
                false => format!(", settled by {} at most", si(settled, "m")),
            };
            let cracked = match cracked {
                0 => String::new(),
                cracked => format!(", {cracked} of {bonds} bonds cracked"),
            };
            let unsolved = match unsolved {
                0 => String::new(),
                unsolved => format!(
                    ", but {unsolved} steps of that were left unsolved: its joints may bear what they should not"
                ),
            };
            format!("stands{settled}{cracked}{unsolved}")
        }
        Rest::Settles(way) => {
            format!(
                "not found: it still moves after settling by {} at most, and the run begins with it as laid. Its joints are soft, or it falls slowly",
                si(way, "m")
            )
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

/// The tie rods, each with the places of its ends; nothing where there are none.
pub fn tie_rows(case: &Case, model: &Model, planar: &Planar) -> Vec<Vec<String>> {
    if planar.system.ties.is_empty() {
        return Vec::new();
    }
    let head = ["ties", "from", "at", "to", "at", "length", "stiffness", "yields at"];
    let mut rows = vec![head.map(String::from).to_vec()];
    let lines = tie_lines(case, &model.wall);
    for (number, ((rod, tie), [x0, y0, x1, y1])) in planar.system.ties.iter().zip(&case.ties).zip(lines).enumerate() {
        let yields = if rod.yield_force.is_finite() { si(rod.yield_force, "N") } else { "–".into() };
        let [from, to] = [[x0, y0], [x1, y1]].map(|at| format!("{}, {} m", metres(at[0]), metres(at[1])));
        let (number, length) = ((number + 1).to_string(), si((x1 - x0).hypot(y1 - y0), "m"));
        rows.push(vec![number, tie.from.clone(), from, tie.to.clone(), to, length, si(rod.stiffness, "N/m"), yields]);
    }
    rows
}

/// A place to the millimetre.
fn metres(x: f64) -> String {
    // No minus before 0.
    format!("{:.3}", x + 0.0).replace("-0.000", "0.000")
}

/// Whether a wall with its ties, joints and forces is its own mirror image, so that a push to one side is one to the other.
pub fn is_symmetric(case: &Case, model: &Model) -> bool {
    if !case.forces.is_empty() {
        return false;
    }
    let blocks = &model.wall.blocks;
    let [left, right] =
        blocks.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, r], b| [l.min(b.x[0]), r.max(b.x[1])]);
    let grain = 1e-6 * (right - left).max(f64::MIN_POSITIVE);
    let rounded = |v: f64| (v / grain).round() as i64;
    // Parts of the wall whose joints, or devices in them, are others than elsewhere.
    let aside = |[x0, x1]: [f64; 2]| rounded(x0.max(left) - left) != rounded(right - x1.min(right));
    let changed = case.joint.changes.iter().any(|JointChange { at, .. }| {
        let of_panels = !at.panel.is_empty() && case.panels.len() > 1;
        of_panels || !at.joints.is_empty() || at.region.is_some_and(|[x0, _, x1, _]| aside([x0.si(), x1.si()]))
    });
    if changed {
        return false;
    }
    // The two ends of anything, the first to the left.
    let both = |x: [f64; 2], own: [f64; 2], mirrored: [f64; 2], stuff: [f64; 3]| {
        let [a, b, c] = stuff;
        let all = |x: [f64; 2], y: [f64; 2]| [x[0], x[1], y[0], y[1], a, b, c].map(rounded);
        (all([x[0] - left, x[1] - left], own), all([right - x[1], right - x[0]], mirrored))
    };
    let of_blocks = blocks.iter().map(|b| both(b.x, b.y, b.y, [b.thickness, b.specific_weight, 0.0]));
    let of_ties = case.ties.iter().zip(tie_lines(case, &model.wall)).map(|(tie, [x0, y0, x1, y1])| {
        let stuff = [tie.stiffness.si(), tie.yield_force.map_or(f64::INFINITY, |force| force.si()), tie.slack.si()];
        match x0 <= x1 {
            true => both([x0, x1], [y0, y1], [y1, y0], stuff),
            false => both([x1, x0], [y1, y0], [y0, y1], stuff),
        }
    });
    let (mut own, mut mirrored): (Vec<_>, Vec<_>) = of_blocks.chain(of_ties).unzip();
    own.sort_unstable();
    mirrored.sort_unstable();
    // Neighbouring grains are one place.
    own.iter().zip(&mirrored).all(|(a, b)| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1))
}
