//! The dimensionless form: the dimensionless system gives back the dimensional one, and walls with equal groups move alike.

use std::path::Path;

use concio::case::{CaseFile, Scheme, Signal, Solver, Syntax, from_str};
use concio::ground::signal::compile;
use concio::model::Model;
use concio::run::{Prepared, prepare_case};
use concio::samples::respond;
use concio_study::groups::{Group, Reference, groups};

use crate::common::Desk;

/// A panel under a floor mass that shakes too little to slip.
const WALL: &str = r#"
model = "shear"
[[panel]]
bond = "running"
courses = 4
bricks = 3
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
damping_ratio = 0.05
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "2.7e7 N/m", rigidity = 1000 }
friction = { law = "stribeck", static = 0.6, dynamic = 0.42, slip_velocity = "1 mm/s" }
[load]
top = "40 kN/m"
beam = { mass = "2 t" }
[motion]
duration = "0.2 s"
base = { sine = { acceleration = "0.2 g", frequency = "12 Hz", ramp = "0.05 s" } }
[solver]
scheme = "esdirk4"
tolerance = 1e-9
"#;

fn read(text: &str) -> CaseFile {
    let file = from_str(text, Syntax::Toml, None).expect("a wall file");
    file.validate().expect("a valid wall");
    file
}

fn ready(file: &CaseFile) -> Prepared {
    prepare_case(file.case.clone(), Path::new("")).expect("a wall that stands")
}

fn solver(length: f64) -> Solver {
    Solver { floor: (1e-15 * length).into(), ..concio::samples::solver(Scheme::Esdirk4, 1e-11) }
}

/// Displacements over Λ, one row per instant of which there are 201, and velocities over ΛΩ; and the largest slip velocity
/// of a bed joint over δ_v.
fn response(model: &Model, solver: &Solver, r: &Reference) -> (Vec<f64>, f64) {
    let zeros = vec![0.0; model.unknowns()];
    let h = respond(model, solver, model.excitation.duration / 200.0, &zeros, &zeros).expect("a run");
    let u = h.displacement.concat().into_iter().map(|x| x / r.length);
    let v: Vec<f64> = h.velocity.concat().into_iter().map(|v| v / r.velocity()).collect();
    let n = model.unknowns();
    let slip = model.shear.rubs.iter().map(|rub| {
        let [a, b] = model.shear.sides[rub.joint as usize].map(|s| s as usize);
        let at = |row: usize, i: usize| if i < n { v[row * n + i] } else { 0.0 };
        let most = (0..v.len() / n).map(|row| (at(row, a) - at(row, b)).abs()).fold(0.0, f64::max);
        most * r.velocity() / rub.law.slip_velocity
    });
    (u.collect(), slip.fold(0.0, f64::max))
}

fn differs(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
}

/// Equation (G1) as a system of its own: every number of the model over its unit.
fn dimensionless(prepared: &Prepared, r: &Reference) -> Model {
    let mut model = prepared.model.clone();
    model.shear.mass.iter_mut().for_each(|m| *m /= r.mass);
    for e in &mut model.shear.elastic {
        e.stiffness /= r.stiffness;
        e.damping /= r.frequency * r.mass;
    }
    for rub in &mut model.shear.rubs {
        rub.normal = rub.normal.map(|n| n / r.force());
        rub.law.slip_velocity /= r.velocity();
    }
    model.shear.stiffest /= r.frequency * r.frequency;
    let Signal::Sine(mut sine) = prepared.case.motion.base.clone() else { panic!("a sine") };
    sine.acceleration = sine.acceleration.map(|a| (a.si() / r.acceleration()).into());
    sine.frequency = (sine.frequency.si() / r.frequency).into();
    sine.ramp = (sine.ramp.si() * r.frequency).into();
    model.excitation.base = compile(&Signal::Sine(sine), Path::new("")).expect("a sine");
    model.excitation.duration *= r.frequency;
    model
}

/// A stiffness per area counts as that of a half-brick contact (L B/2) and of a head joint (H B) of the reference brick, and
/// a study gives such a wall another group.
#[test]
fn groups_of_a_stiffness_per_area() {
    let (bed, head) = (5.4e7 / (0.5 * 0.25 * 0.12), 2.7e7 / (0.055 * 0.12));
    let text = WALL
        .replace("\"5.4e7 N/m\"", &format!("\"{bed:?} N/m3\""))
        .replace("\"2.7e7 N/m\"", &format!("\"{:?} N/mm3\"", head * 1e-9));
    let values = |file: &CaseFile| {
        let prepared = ready(file);
        let r = Reference::of(&prepared.case, None).expect("a reference");
        groups(&prepared.case, &prepared.model, Path::new(""), &r).expect("groups")
    };
    let (per_joint, per_area) = (values(&read(WALL)), values(&read(&text)));
    for (a, b) in per_joint.iter().zip(&per_area) {
        let (Some(a), Some(b)) = (a.value, b.value) else { continue };
        assert!((0..2).all(|k| (a[k] - b[k]).abs() <= 1e-12 * b[k].abs()), "{a:?} {b:?}");
    }
    let wanted = vec![("group.head_stiffness".to_string(), serde_json::json!(700.0))];
    let other = concio_study::groups::realise(&read(&text), Vec::new(), &wanted).expect("another wall");
    let found = values(&other).into_iter().find(|g| g.name == "head_stiffness").and_then(|g| g.value);
    assert!(found.is_some_and(|v| (v[0] / 700.0 - 1.0).abs() < 1e-12), "{found:?}");
}

#[test]
fn the_dimensionless_system_scaled_back_is_the_wall() {
    let prepared = ready(&read(WALL));
    let r = Reference::of(&prepared.case, None).expect("a reference");
    let (wall, slip) = response(&prepared.model, &solver(r.length), &r);
    assert!(slip < 1.0, "a joint slips: {slip} δ_v");
    let one = Reference { mass: 1.0, stiffness: 1.0, frequency: 1.0, length: 1.0 };
    let (scaled, _) = response(&dimensionless(&prepared, &r), &solver(1.0), &one);
    let error = differs(&wall, &scaled);
    assert!(error < 1e-13, "{error}");
    // Λ is a unit and nothing else: a hundredth of it gives displacements a hundred times as large.
    let short = Reference::of(&prepared.case, Some(0.01 * r.length)).expect("a reference");
    // The displacement below which errors do not count is a length, and scales too.
    let (again, _) = response(&dimensionless(&prepared, &short), &solver(100.0), &one);
    let again: Vec<f64> = again.iter().map(|u| 0.01 * u).collect();
    assert!(differs(&wall, &again) < 1e-12, "{}", differs(&wall, &again));
}

/// A wall of bricks 1.6 times as long, high and thick, of brick of 15 kN/m³, with joints of 2e8 N/m, brought to the groups of
/// the first wall by a study that varies the groups.
#[test]
fn two_walls_with_equal_groups_move_alike() -> concio::Result<()> {
    let first = ready(&read(WALL));
    let r = Reference::of(&first.case, None)?;
    let wanted = groups(&first.case, &first.model, Path::new(""), &r)?;
    let other = WALL
        .replace("250 mm", "400 mm")
        .replace("55 mm", "88 mm")
        .replace("120 mm", "192 mm")
        .replace("10 mm", "16 mm")
        .replace("18 kN/m3", "15 kN/m3")
        .replace("5.4e7 N/m", "2e8 N/m")
        .replace("damping_ratio = 0.05", "damping_ratio = 0.02")
        .replace("static = 0.6", "static = 0.5");
    let value = |name: &str| {
        let group = wanted.iter().find(|g| g.name == name).expect("a group");
        group.value.expect("a value")
    };
    let names = [
        "weight",
        "beam_mass",
        "head_stiffness",
        "damping",
        "load",
        "static",
        "dynamic",
        "slip_velocity",
        "beta",
        "duration",
        "frequency",
        "acceleration",
    ];
    let of = |name: &str| {
        // Damping is that of a half-brick bed joint: ξ γ with w = 1.
        let value = if name == "damping" { 0.05 } else { value(name)[0] };
        format!("[[vary]]\npath = \"group.{name}\"\nvalues = [{value:?}]\n")
    };
    let study = format!("wall = \"wall.toml\"\n{}", names.map(of).concat());
    let plan = Desk::new(&other).plan(&study)?;
    let mut case = plan.case(0)?;
    assert!((case.joint.damping_ratio, case.joint.friction.static_) == (0.05, 0.6));
    assert!((case.panels[0].brick.specific_weight.si() / 15e3 - 1.0).abs() > 0.1);
    case.output = first.case.output.clone();
    let second = prepare_case(case, Path::new(""))?;
    let s = Reference::of(&second.case, None)?;
    assert!(s.length == 0.4 && (s.mass / r.mass - 1.0).abs() > 1.0 && (s.frequency / r.frequency - 1.0).abs() > 0.1);
    for (a, b) in wanted.iter().zip(groups(&second.case, &second.model, Path::new(""), &s)?) {
        assert_same(a, &b);
    }
    let (one, slip) = response(&first.model, &solver(r.length), &r);
    let (two, _) = response(&second.model, &solver(s.length), &s);
    assert!(slip < 1.0, "a joint slips: {slip} δ_v");
    assert!(differs(&one, &two) < 1e-12, "{}", differs(&one, &two));
    Ok(())
}

fn assert_same(a: &Group, b: &Group) {
    let near = |a: [f64; 2], b: [f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() <= 1e-5 * b[k].abs());
    match (a.value, b.value) {
        (Some(x), Some(y)) => assert!(near(x, y), "{}: {x:?} {y:?}", a.name),
        (x, y) => assert_eq!(x, y, "{}", a.name),
    }
}

/// Λ is a unit: whether a wall lies in the ranges of the report, and how far off, does not depend on it.
#[test]
fn another_length_moves_a_wall_and_the_ranges_alike() -> concio::Result<()> {
    let prepared = ready(&read(WALL));
    let of = |length: Option<f64>| {
        let reference = Reference::of(&prepared.case, length)?;
        groups(&prepared.case, &prepared.model, Path::new(""), &reference)
    };
    let (own, other) = (of(None)?, of(Some(0.1))?);
    let mut moved = Vec::new();
    for (a, b) in own.iter().zip(&other) {
        let (Some(x), Some(y), Some(range), Some(ranged)) = (a.value, b.value, a.table1, b.table1) else { continue };
        for k in 0..2 {
            let [one, two] = [x[k] * ranged[k], y[k] * range[k]];
            assert!((one - two).abs() <= 1e-12 * two.abs(), "{}: {one} {two}", a.name);
        }
        if (y[0] - x[0]).abs() > 1e-9 * x[0].abs() {
            moved.push(a.name);
            assert!((y[0] / x[0] - 2.5).abs() < 1e-12, "{}: bricks of 0.25 m are 2.5 Λ long", a.name);
        }
    }
    assert_eq!(moved, ["weight", "slip_velocity"]);
    Ok(())
}

#[test]
fn walls_without_stiffness_have_no_reference() {
    let text = WALL.replace("law = \"elastic\"", "law = \"none\"").replace("\"2.7e7 N/m\"", "0");
    let error = Reference::of(&read(&text).case, None).expect_err("no stiffness").to_string();
    assert!(error.contains("joint.bed.stiffness") && error.contains("above 0"), "{error}");
}
