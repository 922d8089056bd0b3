//! Joint laws and the changes to some joints.

use std::collections::HashMap;

use super::{Bound, Findings, devices};
use crate::case::{
    Bond, BondChange, Case, Friction, FrictionChange, FrictionLaw, JointBond, JointChange, ModelKind, Panel, Selector,
    Spring,
};
use crate::quantity::shown;
use crate::{InputError, case::de::suggestion};

pub(super) fn check(f: &mut Findings, case: &Case) {
    let j = &case.joint;
    f.number("joint.damping_ratio", j.damping_ratio, DAMPING);
    let kinds = [
        ("bed", Some(&j.bed)),
        ("head", Some(&j.head)),
        ("base", j.base.as_ref()),
        ("top", j.top.as_ref()),
        ("connection", j.connection.as_ref()),
    ];
    for (kind, spring) in kinds {
        if let Some(spring) = spring {
            self::spring(f, kind, spring);
        }
    }
    friction(f, &j.friction);
    if let Some(b) = &j.bond {
        bond(f, b);
    }
    if j.changes.len() > MOST_CHANGES {
        f.push("joint.change", format!("{} changes are too many", j.changes.len()), format!("up to {MOST_CHANGES}"));
        return;
    }
    let panels = Panels::of(case);
    // What an earlier change gave the same joints is not known here: after one that sets coefficients only a pair
    // given together is compared.
    let mut settled = true;
    for (i, change) in j.changes.iter().enumerate() {
        selector(f, i, &change.at, &panels);
        self::change(f, i, change);
        // A rocking wall reads none of them, and says so.
        if let Some(r) = change.friction.as_ref().filter(|_| case.model != ModelKind::Rocking) {
            friction_change(f, i, r, &j.friction, settled);
            settled &= r.static_.is_none() && r.dynamic.is_none();
        }
        if let Some(b) = &change.bond {
            bond_values(f, &format!("joint.change[{i}].bond"), b);
        }
        if let Some(d) = &change.device {
            devices::check(f, &format!("joint.change[{i}].device"), d);
        }
    }
}

/// Changes of the laws of some joints that a wall may have.
const MOST_CHANGES: usize = 100_000;
/// Names of panels that a message lists.
const MOST_LISTED: usize = 20;

/// What selectors ask of the panels.
struct Panels {
    names: Vec<String>,
    courses: HashMap<String, usize>,
    most_courses: usize,
}

impl Panels {
    fn of(case: &Case) -> Self {
        let names: Vec<String> = (0..case.panels.len()).map(|p| case.panel_name(p)).collect();
        let courses: HashMap<String, usize> = names.iter().cloned().zip(case.panels.iter().map(courses)).collect();
        let most_courses = courses.values().copied().max().unwrap_or(0);
        Panels { names, courses, most_courses }
    }

    /// Courses of the highest of some panels; of all where none is named.
    fn courses(&self, names: &[String]) -> usize {
        match names.is_empty() {
            true => self.most_courses,
            false => names.iter().filter_map(|name| self.courses.get(name)).copied().max().unwrap_or(0),
        }
    }

    fn listed(&self) -> String {
        let some: Vec<String> = self.names.iter().take(MOST_LISTED).map(|n| format!("`{n}`")).collect();
        let more = self.names.len().saturating_sub(MOST_LISTED);
        if more > 0 { format!("{} and {more} more", some.join(", ")) } else { some.join(", ") }
    }
}

const DAMPING: Bound = Bound::Between(0.0, 2.0);

fn spring(f: &mut Findings, kind: &str, s: &Spring) {
    f.stiffness(format_args!("joint.{kind}.stiffness"), s.stiffness);
    f.number(format_args!("joint.{kind}.rigidity"), s.rigidity, Bound::Above0);
    f.number(format_args!("joint.{kind}.stiffness_factor"), s.stiffness_factor, Bound::From0);
    for (name, given) in [RESTITUTION, ROCKING].into_iter().zip([s.restitution, s.rocking_restitution]) {
        restitution(f, (&format!("joint.{kind}"), name), given, Some(s.law.is_rigid()));
    }
    if let Some(ratio) = s.damping_ratio {
        f.number(format_args!("joint.{kind}.damping_ratio"), ratio, DAMPING);
    }
    f.number(format_args!("joint.{kind}.normal_to_shear"), s.normal_to_shear, Bound::Above0);
    if let Some(strength) = s.compressive_strength {
        f.quantity(format_args!("joint.{kind}.compressive_strength"), strength, Bound::Above0);
    }
}

const RESTITUTION: &str = "restitution";
const ROCKING: &str = "rocking_restitution";

/// What a joint gives back, by its table and name, where it is known here whether its law is `rigid`.
fn restitution(f: &mut Findings, (table, name): (&str, &str), given: Option<f64>, rigid: Option<bool>) {
    let Some(e) = given else { return };
    let key = format!("{table}.{name}");
    if rigid == Some(false) {
        f.push(key, "is for law `rigid` alone", format!("law = \"rigid\", or no `{name}`"));
    } else {
        f.number(key, e, Bound::Between(0.0, 1.0));
    }
}

fn friction(f: &mut Findings, r: &Friction) {
    f.number("joint.friction.static", r.static_, Bound::From0);
    // Without a key of its own it is the static one, of which that is said already.
    if r.dynamic != r.static_ {
        f.number("joint.friction.dynamic", r.dynamic, Bound::From0);
    }
    f.quantity("joint.friction.slip_velocity", r.slip_velocity, Bound::Above0);
    f.number("joint.friction.beta", r.beta, Bound::Above0);
    f.number("joint.friction.alpha", r.alpha, Bound::From0);
    below_static(f, "joint.friction.dynamic", r.dynamic, r.static_);
}

/// Steepest friction angle of a bond [rad]: 80°, whose tangent is 5.7.
const STEEPEST: f64 = 80.0 * std::f64::consts::PI / 180.0;

fn bond(f: &mut Findings, b: &JointBond) {
    let values = BondChange {
        tensile_strength: Some(b.tensile_strength),
        cohesion: Some(b.cohesion),
        friction_angle: Some(b.friction_angle),
        mode_1_energy: Some(b.mode_1_energy),
        mode_2_energy: Some(b.mode_2_energy),
        residual_stiffness: Some(b.residual_stiffness),
    };
    bond_values(f, "joint.bond", &values);
    if b.on.is_empty() {
        f.push("joint.bond.on", "no kind of joint is named", "some of `bed`, `head`, `base`, `top`, `connection`");
    }
    let strengths = [b.tensile_strength.si(), b.cohesion.si(), b.friction_angle.si()];
    if strengths.iter().all(|s| *s == 0.0) {
        let allowed = "`tensile_strength`, `cohesion` or `friction_angle` above 0; no `bond` for dry joints";
        f.push("joint.bond", "the bond has no strength", allowed);
    }
}

fn bond_values(f: &mut Findings, key: &str, b: &BondChange) {
    for (name, value) in [("tensile_strength", b.tensile_strength), ("cohesion", b.cohesion)] {
        if let Some(v) = value {
            f.quantity(format_args!("{key}.{name}"), v, Bound::From0);
        }
    }
    if let Some(v) = b.friction_angle.filter(|v| !(0.0..=STEEPEST).contains(&v.si())) {
        let what = format!("{} deg is out of range", shown(v.si().to_degrees()));
        f.push(format_args!("{key}.friction_angle"), what, "0 … 80 deg (a number without unit is in rad)");
    }
    for (name, value) in [("mode_1_energy", b.mode_1_energy), ("mode_2_energy", b.mode_2_energy)] {
        if let Some(v) = value {
            f.quantity(format_args!("{key}.{name}"), v, Bound::From0);
        }
    }
    if let Some(v) = b.residual_stiffness {
        f.number(format_args!("{key}.residual_stiffness"), v, Bound::Between(0.0, 1.0));
    }
}

fn below_static(f: &mut Findings, key: impl std::fmt::Display, dynamic: f64, static_: f64) {
    // Of a static one that is wrong itself nothing follows.
    if dynamic > static_ && static_ >= 0.0 {
        let what = format!("{} is above the static coefficient", shown(dynamic));
        f.push(key, what, format!("0 … {}, the static coefficient", shown(static_)));
    }
}

fn change(f: &mut Findings, i: usize, change: &JointChange) {
    let of_mortar = change.spring.is_some() || change.friction.is_some() || change.bond.is_some();
    if !of_mortar && change.device.is_none() {
        f.push(format_args!("joint.change[{i}]"), "nothing is changed", "`spring`, `friction` or `bond`, or `device`");
    }
    if of_mortar && change.device.is_some() {
        let what = "a device takes the place of spring, friction and bond";
        f.push(format_args!("joint.change[{i}].device"), what, "`device` alone, or a change without it");
    }
    if let Some(s) = &change.spring {
        // Without a law the joint keeps its own, which is not known here: a restitution of no rigid joint has no effect.
        for (name, given) in [RESTITUTION, ROCKING].into_iter().zip([s.restitution, s.rocking_restitution]) {
            restitution(f, (&format!("joint.change[{i}].spring"), name), given, s.law.map(|law| law.is_rigid()));
        }
        if let Some(v) = s.stiffness {
            f.stiffness(format_args!("joint.change[{i}].spring.stiffness"), v);
        }
        if let Some(v) = s.compressive_strength {
            f.quantity(format_args!("joint.change[{i}].spring.compressive_strength"), v, Bound::Above0);
        }
        for (key, value, bound) in [
            ("rigidity", s.rigidity, Bound::Above0),
            ("stiffness_factor", s.stiffness_factor, Bound::From0),
            ("damping_ratio", s.damping_ratio, DAMPING),
            ("normal_to_shear", s.normal_to_shear, Bound::Above0),
        ] {
            if let Some(v) = value {
                f.number(format_args!("joint.change[{i}].spring.{key}"), v, bound);
            }
        }
    }
}

fn friction_change(f: &mut Findings, i: usize, r: &FrictionChange, common: &Friction, settled: bool) {
    if let Some(v) = r.slip_velocity {
        f.quantity(format_args!("joint.change[{i}].friction.slip_velocity"), v, Bound::Above0);
    }
    for (key, value, bound) in [
        ("static", r.static_, Bound::From0),
        ("dynamic", r.dynamic, Bound::From0),
        ("beta", r.beta, Bound::Above0),
        ("alpha", r.alpha, Bound::From0),
    ] {
        if let Some(v) = value {
            f.number(format_args!("joint.change[{i}].friction.{key}"), v, bound);
        }
    }
    let law = r.law.filter(|law| *law != FrictionLaw::None);
    let rubs = law.filter(|_| common.law == FrictionLaw::None && common.static_ == 0.0);
    if let Some(law) = rubs
        && (r.static_.is_none() || r.dynamic.is_none())
    {
        let key = if r.static_.is_none() { "static" } else { "dynamic" };
        let name = match law {
            FrictionLaw::Coulomb => "coulomb",
            FrictionLaw::StribeckStick => "stribeck-stick",
            FrictionLaw::Stribeck | FrictionLaw::None => "stribeck",
        };
        let what = format!("the key is missing: law `{name}` needs it, and [joint.friction] gives none");
        f.push(format_args!("joint.change[{i}].friction.{key}"), what, "from 0");
    }
    let pair = match (r.static_, r.dynamic) {
        (Some(s), Some(d)) => Some((s, d, "dynamic")),
        (Some(s), None) if settled => Some((s, common.dynamic, "static")),
        (None, Some(d)) if settled => Some((common.static_, d, "dynamic")),
        _ => None,
    };
    match pair {
        Some((s, d, "static")) if s < d => {
            let what = format!("{} is below the dynamic coefficient of [joint.friction]", shown(s));
            f.push(format_args!("joint.change[{i}].friction.static"), what, format!("from {}", shown(d)));
        }
        Some((s, d, "dynamic")) => below_static(f, format_args!("joint.change[{i}].friction.dynamic"), d, s),
        _ => {}
    }
}

fn selector(f: &mut Findings, i: usize, at: &Selector, panels: &Panels) {
    for (k, name) in at.panel.iter().enumerate() {
        if !panels.courses.contains_key(name) && f.takes_more() {
            let error = InputError::new(format!("no panel is called `{name}`"))
                .key(format!("joint.change[{i}].at.panel[{k}]"))
                .allowed(panels.listed());
            f.add(match suggestion(name, panels.names.iter().map(String::as_str)) {
                Some(near) => error.help(format!("did you mean `{near}`?")),
                None => error,
            });
        }
    }
    let courses = panels.courses(&at.panel);
    for (k, course) in at.course.iter().enumerate() {
        // The top support counts as the course above the last.
        if !(1..=courses.saturating_add(1)).contains(course) && courses > 0 {
            let what = format!("course {course} does not exist");
            let allowed = format!("1 … {courses}, and {} for the top support", courses.saturating_add(1));
            f.push(format_args!("joint.change[{i}].at.course[{k}]"), what, allowed);
        }
    }
    if let Some(region) = at.region {
        let before = f.list.len();
        for (k, v) in region.into_iter().enumerate() {
            f.quantity(format_args!("joint.change[{i}].at.region[{k}]"), v, Bound::Finite);
        }
        let [x0, y0, x1, y1] = region;
        if f.list.len() == before && (x0 >= x1 || y0 >= y1) {
            let what = format!("[{x0}, {y0}, {x1}, {y1}] encloses nothing");
            f.push(
                format_args!("joint.change[{i}].at.region"),
                what,
                "[x0, y0, x1, y1] with x0 below x1 and y0 below y1",
            );
        }
    }
}

fn courses(panel: &Panel) -> usize {
    match panel.bond {
        Bond::Explicit => panel.blocks.iter().map(|b| b.course).max().unwrap_or(0),
        Bond::Arch => 1,
        Bond::Irregular if panel.random.is_none() => panel.course_list.len(),
        _ => panel.courses.unwrap_or(0),
    }
}
