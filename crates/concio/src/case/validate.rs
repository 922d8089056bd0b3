//! Checks of a [`Case`] against the bounds that its keys document. What only the laid wall shows (blocks that overlap
//! or rest on nothing, unknown block names) is found by [`crate::pattern::lay`].

use std::fmt::Display;

use super::{Beam, Case, ModelKind, Motion, ParameterSet, Signal, TopLoad};
use crate::quantity::{Dimension, Quantity, Stiffness, shown};
use crate::{InputError, Result};

mod devices;
mod forces;
mod joints;
mod models;
mod motion;
mod out_of_plane;
mod ties;
mod walls;

pub(super) use devices::keys_of as device_keys;
pub(crate) use walls::tidy;
pub use walls::{LARGEST_WALL, block_bound};

/// Largest and, but for 0, smallest magnitude of a number in SI.
const MAGNITUDE: [f64; 2] = [1e-18, 1e18];

/// Findings beyond this many are not collected: they would repeat each other.
const MOST_FINDINGS: usize = 100;

/// The first finding of [`findings`] as an error.
///
/// # Errors
/// [`InputError`] with key, what is wrong and the allowed range; [`super::CaseFile::validate`] adds file and line.
pub fn validate(case: &Case) -> Result<()> {
    findings(case).into_iter().next().map_or(Ok(()), |e| Err(e.into()))
}

/// Everything that is wrong with the case, in the order of the wall file's documentation; empty when it can be run.
pub fn findings(case: &Case) -> Vec<InputError> {
    let mut f = Findings::default();
    f.list.extend(case.set.as_ref().and_then(parameter_set));
    walls::check(&mut f, case);
    ties::check(&mut f, case);
    forces::check(&mut f, case);
    out_of_plane::check(&mut f, case);
    joints::check(&mut f, case);
    load(&mut f, case);
    motion::check(&mut f, case);
    solver(&mut f, case);
    output(&mut f, case);
    models::check(&mut f, case);
    f.list
}

/// What is wrong with the panels alone.
pub(crate) fn panels(case: &Case) -> Result<()> {
    let mut f = Findings::default();
    walls::check(&mut f, case);
    f.list.into_iter().next().map_or(Ok(()), |e| Err(e.into()))
}

/// Where the case names a joint, as `(key, name)`: whoever builds the joints checks that they exist.
pub fn joint_names(case: &Case) -> Vec<(String, &str)> {
    let changes = case.joint.changes.iter().enumerate().flat_map(|(i, change)| {
        let names = change.at.joints.iter().enumerate();
        names.map(move |(k, name)| (format!("joint.change[{i}].at.joints[{k}]"), name.as_str()))
    });
    let kept = case.output.joints.iter().enumerate().filter(|(_, name)| *name != "all");
    changes.chain(kept.map(|(k, name)| (format!("output.joints[{k}]"), name.as_str()))).collect()
}

pub(super) fn parameter_set(set: &ParameterSet) -> Option<InputError> {
    let mut f = Findings::default();
    f.number("set.at", set.at, Bound::Between(0.0, 1.0));
    f.list.pop()
}

/// A bound as the documentation words it.
#[derive(Debug, Clone, Copy)]
enum Bound {
    /// Of either sign.
    Finite,
    /// From 0.
    From0,
    /// Above 0.
    Above0,
    /// From there, above 0.
    From(f64),
    /// Both ends included.
    Between(f64, f64),
}

impl Bound {
    fn holds(self, v: f64) -> bool {
        match self {
            Bound::Finite => v.is_finite(),
            Bound::From0 => v >= 0.0,
            Bound::Above0 => v > 0.0,
            Bound::From(low) => v >= low,
            Bound::Between(low, high) => (low..=high).contains(&v),
        }
    }
    fn text(self, unit: &str) -> String {
        match self {
            Bound::Finite => format!("a finite number{}", if unit.is_empty() { "" } else { " of either sign" }),
            Bound::From0 => format!("from 0{unit}"),
            Bound::Above0 => format!("above 0{unit}"),
            Bound::From(low) => format!("from {}{unit}", shown(low)),
            Bound::Between(low, high) => format!("{} … {}{unit}", shown(low), shown(high)),
        }
    }
}

/// What was found so far.
#[derive(Default)]
struct Findings {
    list: Vec<InputError>,
}

impl Findings {
    /// Whether there is room: what takes time to find out need not be then.
    fn takes_more(&self) -> bool {
        self.list.len() < MOST_FINDINGS
    }
    fn add(&mut self, error: InputError) {
        if self.takes_more() {
            self.list.push(error);
        }
    }
    fn push(&mut self, key: impl Display, what: impl Into<String>, allowed: impl Into<String>) {
        self.add(InputError::new(what).key(key.to_string()).allowed(allowed));
    }
    fn quantity<D: Dimension>(&mut self, key: impl Display, q: Quantity<D>, bound: Bound) {
        self.value(key, q.si(), &format!(" {}", D::UNITS[0].0), bound);
    }
    fn stiffness(&mut self, key: impl Display, k: Stiffness) {
        match k {
            Stiffness::PerJoint(k) => self.quantity(key, k, Bound::From0),
            Stiffness::PerArea(k) => self.quantity(key, k, Bound::From0),
        }
    }
    fn number(&mut self, key: impl Display, v: f64, bound: Bound) {
        self.value(key, v, "", bound);
    }
    fn value(&mut self, key: impl Display, v: f64, unit: &str, bound: Bound) {
        let ([least, most], found) = (MAGNITUDE, format!("{}{unit}", shown(v)));
        if !bound.holds(v) {
            self.push(key, format!("{found} is out of range"), bound.text(unit));
        } else if v.abs() > most {
            self.push(key, format!("{found} is too large"), format!("{}, up to {most:e}{unit}", bound.text(unit)));
        } else if v != 0.0 && v.abs() < least {
            let allowed = format!("{}, and not below {least:e}{unit} in magnitude", bound.text(unit));
            self.push(key, format!("{found} is too small"), allowed);
        }
    }
    /// Two values of which the first must be below the second (or equal to it, if `equal`).
    fn rising<D: Dimension>(&mut self, key: impl Display, pair: [Quantity<D>; 2], equal: bool) {
        let [a, b] = pair.map(Quantity::si);
        if a > b || (a == b && !equal) {
            let allowed =
                if equal { "the first value not above the second" } else { "the first value below the second" };
            self.push(key, format!("{} comes before {}", pair[0], pair[1]), allowed);
        }
    }
}

fn load(f: &mut Findings, case: &Case) {
    match case.load.top {
        TopLoad::PerLength(load) => f.quantity("load.top", load, Bound::From0),
        TopLoad::Force(force) => f.quantity("load.top.force", force, Bound::From0),
    }
    if let Beam::Mass(mass) = case.load.beam {
        f.quantity("load.beam.mass", mass, Bound::Above0);
    }
    if let Some(mass) = case.load.mass {
        f.quantity("load.mass", mass, Bound::From0);
        match case.load.beam {
            Beam::Free => {}
            Beam::Mass(_) => f.push("load.mass", "the beam has the mass", "beam = { mass = … } alone"),
            Beam::Driven | Beam::Tied => f.push(
                "load.mass",
                "the beam is held from side to side: no mass on it is shaken",
                "with `beam = \"free\"`; else leave it out",
            ),
        }
    }
    match (case.load.beam, &case.motion.top) {
        // Of no motion at all that is said as such.
        (Beam::Driven, Signal::None) if case.motion == Motion::default() => {}
        (Beam::Driven, Signal::None) => {
            f.push("motion.top", "the beam is `driven` but has no motion", "a motion such as { sine = { … } }");
        }
        (Beam::Driven, _) | (_, Signal::None) => {}
        // Told with the keys that it does not read.
        _ if case.model == ModelKind::Rocking => {}
        _ => f.add(
            InputError::new("only a `driven` top beam takes a motion")
                .key("motion.top")
                .allowed("`none`")
                .help("write `beam = \"driven\"` in [load], or leave `top` out"),
        ),
    }
}

/// Shortest step of planar walls [s]: contact is solved to a millionth of what gravity gives in a step, and below this rounding
/// is more than that.
const SHORTEST_STEP: f64 = 1e-8;

fn solver(f: &mut Findings, case: &Case) {
    let s = &case.solver;
    f.number("solver.tolerance", s.tolerance, Bound::Between(1e-12, 0.1));
    f.quantity("solver.floor", s.floor, Bound::Above0);
    for (key, step, bound) in
        [("solver.max_step", s.max_step, Bound::Above0), ("solver.step", s.step, Bound::From(SHORTEST_STEP))]
    {
        if let Some(step) = step {
            f.quantity(key, step, bound);
        }
    }
}

fn output(f: &mut Findings, case: &Case) {
    let o = &case.output;
    if let Some(interval) = o.interval {
        f.quantity("output.interval", interval, Bound::Above0);
        if let Some(duration) = case.motion.duration
            && interval.si() > 0.0
            && duration.si() / interval.si() > crate::case::MOST_SAMPLES
        {
            let allowed = format!("at least {} s for this duration", shown(duration.si() / crate::case::MOST_SAMPLES));
            f.push("output.interval", format!("{interval} gives more than 10,000,000 samples"), allowed);
        }
    }
    if let Some(frames) = o.frames {
        f.quantity("output.frames", frames, Bound::From0);
        if let Some(interval) = o.interval
            && frames.si() > 0.0
            && frames < interval
        {
            f.push(
                "output.frames",
                format!("{frames} is shorter than output.interval"),
                format!("0 or from {interval}"),
            );
        }
    }
}
