//! What the research report's Table 1 and section 4.2 make of the groups.

use concio::case::{Case, SetName, Syntax, from_str};

use super::{Reference, areas};

/// Ranges of the groups over the sets p1 to p4 and section 4.2, each set's own range of numbers included. Stiffnesses of
/// bed and head joints are taken to vary independently of each other.
pub fn ranges() -> Vec<(&'static str, [f64; 2])> {
    let mut found: Vec<(&'static str, [f64; 2])> = Vec::new();
    for set in [SetName::Report, SetName::P1, SetName::P2, SetName::P3, SetName::P4] {
        for (name, range) in of_set(set) {
            match found.iter_mut().find(|(n, _)| *n == name) {
                Some((_, all)) => *all = [all[0].min(range[0]), all[1].max(range[1])],
                None => found.push((name, range)),
            }
        }
    }
    found
}

/// The groups of one set: those that its numbers determine.
pub fn of_set(set: SetName) -> Vec<(&'static str, [f64; 2])> {
    let (weighs, rubs) = (set != SetName::P4, set != SetName::P3);
    let ends: Option<Vec<Case>> = [0.0, 1.0].into_iter().map(|at| case(set, at, weighs, rubs)).collect();
    let Some(ends) = ends else { return Vec::new() };
    let over = |f: &dyn Fn(&Case) -> f64| {
        let values = [f(&ends[0]), f(&ends[1])];
        [values[0].min(values[1]), values[0].max(values[1])]
    };
    let areas = |c: &Case| areas(&c.panels[0].brick);
    let bed = over(&|c| c.joint.bed.stiffness.over(areas(c)[0]));
    let head = over(&|c| c.joint.head.stiffness.over(areas(c)[1]) * c.joint.head.rigidity);
    let mut found = vec![("stiffness", [1.0, 2.0]), ("head_stiffness", [head[0] / bed[1], head[1] / bed[0]])];
    let reference = |c: &Case| Reference::of(c, None).ok();
    if weighs {
        found.push(("weight", over(&|c| reference(c).map_or(f64::NAN, |r| r.mass * concio::G / r.force()))));
        if set == SetName::Report {
            let velocity = |c: &Case| c.joint.friction.slip_velocity.si();
            found.push(("slip_velocity", over(&|c| reference(c).map_or(f64::NAN, |r| velocity(c) / r.velocity()))));
        }
    }
    if rubs {
        found.push(("static", over(&|c| c.joint.friction.static_)));
    }
    // Printed in section 4.2 alone; the sets of Table 1 take them from there.
    if set == SetName::Report {
        found.push(("dynamic", over(&|c| c.joint.friction.dynamic)));
        found.push(("beta", over(&|c| c.joint.friction.beta)));
        found.push(("alpha", over(&|c| c.joint.friction.alpha)));
        found.push(("damping", over(&|c| c.joint.damping_ratio)));
    }
    found
}

/// One brick with the numbers of a set; what Table 1 does not print of it is given and not used.
fn case(set: SetName, at: f64, weighs: bool, rubs: bool) -> Option<Case> {
    let name = serde_json::to_value(set).ok()?;
    let brick = if weighs { "" } else { "brick = { specific_weight = 18000 }\n" };
    let friction = if rubs { "" } else { "[joint.friction]\nlaw = \"none\"\n" };
    let text = format!(
        "model = \"shear\"\nset = {{ name = {name}, at = {at:?} }}\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n\
         {brick}{friction}[motion]\nduration = 1\n"
    );
    from_str(&text, Syntax::Toml, None).ok().map(|file| file.case)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(set: SetName, name: &str) -> Option<[f64; 2]> {
        of_set(set).into_iter().find(|(n, _)| *n == name).map(|(_, range)| range)
    }

    /// Table 1, column p1: K_V 9.00e7 … 1.62e8 N/m, K_H 5.40e7 … 1.53e8 N/m, φ 20° … 40°; closed head joints 1000 times
    /// as stiff. Section 4.2: δ_v 1 mm/s, K 5.4e7 N/m, brick 0.25 × 0.12 × 0.055 m of 18 kN/m³.
    #[test]
    fn the_printed_numbers_come_out() {
        let near = |found: Option<[f64; 2]>, expected: [f64; 2]| {
            let found = found.unwrap_or([f64::NAN; 2]);
            assert!((0..2).all(|k| (found[k] / expected[k] - 1.0).abs() < 1e-9), "{found:?} {expected:?}");
        };
        near(of(SetName::P1, "head_stiffness"), [1e3 * 9.00 / 15.3, 1e3 * 16.2 / 5.40]);
        near(of(SetName::P1, "static"), [20f64.to_radians().tan(), 40f64.to_radians().tan()]);
        let weight = 18_000.0 * 0.25 * 0.12 * 0.055;
        near(of(SetName::Report, "weight"), [weight / (5.4e7 * 0.25); 2]);
        let omega = (5.4e7 / (weight / 9.81)).sqrt();
        near(of(SetName::Report, "slip_velocity"), [1e-3 / (0.25 * omega); 2]);
        assert_eq!((of(SetName::P4, "weight"), of(SetName::P3, "static")), (None, None));
        assert!(of(SetName::P4, "static").is_some() && of(SetName::P3, "weight").is_some());
    }
}
