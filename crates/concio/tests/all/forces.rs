//! Forces on blocks, of wall files and set between steps, against closed forms and each other.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::outcome::Outcome;
use concio::run::{Prepared, prepare_case, run_in_memory};
use concio::simulate::Simulation;
use concio_verified::agrees;

use crate::common::ready::{last, ready as prepared};

const G: f64 = 9.81;

fn ran(text: &str) -> Outcome {
    run_in_memory(&prepared(text)).expect("a run")
}

/// A stone of 5 kN, so long and so high [m], on ground with friction 0.3; what pushes it, and other tables.
fn stone([length, height]: [f64; 2], rest: &str) -> String {
    let weight = 5e3 / (length * height);
    format!(
        r#"
model = "planar"
[[panel]]
bond = "explicit"
block = [{{ id = "stone", course = 1, x = 2, y = 0, length = {length}, height = {height} }}]
brick = {{ length = {length}, height = {height}, thickness = 1, specific_weight = {weight} }}
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", static = 0.3, dynamic = 0.3 }}
{rest}
"#
    )
}

const FLAT: [f64; 2] = [1.0, 0.25];

/// A half of its weight accelerates it by 0.5 g − μ g; drawn upwards by a half besides, by 0.5 g − μ 0.5 g. What is brought is F s.
#[test]
fn a_force_accelerates_what_friction_does_not_hold() {
    let rest = |y: &str| format!("[[force]]\nblock = \"stone\"\nx = [2500]\n{y}\n[motion]\nduration = \"0.5 s\"");
    for (y, a) in [("", 0.2 * G), ("y = [2500]", 0.35 * G)] {
        let outcome = ran(&stone(FLAT, &rest(y)));
        let of = |what: &str| {
            format!(
                "Forces: stone of 5 kN pushed by 2.5 kN{}, {what}",
                if y.is_empty() { "" } else { " and drawn upwards" }
            )
        };
        let way = last(&outcome, "top/displacement");
        agrees!(of("way"), "½ (F/m − μ N/m) t²", "m", way, 0.5 * a * 0.25, 1e-4);
        agrees!(of("energy brought"), "F s", "J", outcome.energies.input(), 2500.0 * way, 1e-8);
        assert!(outcome.energies.residual().abs() < 1e-9 * outcome.energies.input());
    }
    // Friction holds 0.3 of the weight and no more.
    for (force, moves) in [(1499.0, false), (1501.0, true)] {
        let outcome =
            ran(&stone(FLAT, &format!("[[force]]\nblock = \"stone\"\nx = [{force}]\n[motion]\nduration = \"1 s\"")));
        assert_eq!(last(&outcome, "top/displacement") > 1e-4, moves, "{force}");
    }
}

/// Through the centre of a stone 0.5 m wide and 2 m high a quarter of the weight turns it, before friction gives way; with 5 kN on its top, whose mass
/// moves with it, 2.5 kN more are needed.
#[test]
fn a_force_turns_a_stone_over_at_its_moment() {
    for (load, turns) in [(0.0, 1250.0), (5e3, 2500.0)] {
        for (part, moves) in [(0.998, false), (1.002, true)] {
            let text = format!(
                "[load]\ntop.force = {load}\n[[force]]\nblock = \"stone\"\nx = [{}]\n[motion]\nduration = \"1 s\"",
                part * turns
            );
            let outcome = ran(&stone([0.5, 2.0], &text));
            let lifted = outcome.envelopes.joint_opening.iter().fold(0.0f64, |most, v| most.max(*v));
            assert_eq!(lifted > 1e-5, moves, "{part} of {turns} N: {lifted} m");
        }
    }
}

/// One stone is pushed alike by its inertia and by a force of the same size.
#[test]
fn a_force_is_what_the_base_does_the_other_way() {
    let shaken = ran(&stone(
        FLAT,
        "[motion]\nduration = \"0.6 s\"\nbase = { pulse = { shape = \"rectangular\", acceleration = \"-0.5 g\", duration = \"0.2 s\" } }",
    ));
    let mut pushed =
        stone(FLAT, "[[force]]\nblock = \"stone\"\nx = [2500, 0]\nevery = \"0.2 s\"\n[motion]\nduration = \"0.6 s\"");
    pushed.push_str("[solver]\nmax_step = \"1 ms\"");
    let pushed = ran(&pushed);
    let [a, b] = [&shaken, &pushed].map(|outcome| last(outcome, "top/displacement"));
    agrees!("Forces: stone pushed for 0.2 s, way until it rests", "that of a base pulse", "m", b, a, 1e-6);
}

/// A wall of four courses, pulled at one of its blocks by a spring of 200 kN/m whose far end goes at 20 mm/s: block and force of every step.
fn pulled(prepared: &Prepared, block: usize, cut: Option<usize>) -> (Vec<[f64; 3]>, Vec<f64>) {
    let begun = || Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling).expect("a simulation");
    let (mut simulation, mut forces) = (begun(), Vec::new());
    for step in 0..400 {
        if Some(step) == cut {
            let state = simulation.save();
            simulation = begun();
            assert!(simulation.restore(&state));
        }
        let force = 200e3 * (0.02 * simulation.time() - simulation.places()[block][0]);
        simulation.push(block, [force, 0.0]).expect("a block");
        forces.push(force);
        simulation.clear_recording();
        let _ = simulation.advance(1);
    }
    (simulation.places(), forces)
}

const WALL: &str = r#"
model = "planar"
[[panel]]
bond = "running"
courses = 4
bricks = 3
brick = { length = 0.25, height = 0.1, thickness = 0.12, specific_weight = 18e3 }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.7, dynamic = 0.7 }
[load]
top = "500 N/m"
[solver]
step = "1 ms"
"#;

/// What pulls between steps does what the same forces of a wall file do, to the bit, also after a run that was taken up.
#[test]
fn forces_between_steps_are_those_of_a_wall_file_to_the_bit() {
    let own = prepared(&format!("{WALL}[motion]\nduration = \"0.4 s\"\n"));
    let block = own.model.wall.blocks.iter().position(|b| b.name == "p1c4b2").expect("a block");
    let (places, forces) = pulled(&own, block, None);
    assert!(forces[399] > 10.0 && places[block][0] > 1e-4, "{} N, {:?}", forces[399], places[block]);
    assert_eq!(pulled(&own, block, Some(150)), (places.clone(), forces.clone()));
    let given = prepared(&format!(
        "{WALL}[motion]\nduration = \"0.4 s\"\n[[force]]\nblock = \"p1c4b2\"\nx = {forces:?}\nevery = \"1 ms\"\n"
    ));
    let mut run = Simulation::new(&given.model, &given.case.solver, &given.sampling).expect("a simulation");
    run.run_to_end();
    assert_eq!(run.places(), places);
}

/// What cannot be a force is told by its key.
#[test]
fn what_is_no_force_is_told() {
    let told = |rest: &str| {
        let file = from_str(&stone(FLAT, rest), Syntax::Toml, None).expect("a wall file");
        let found = file.validate().and_then(|()| prepare_case(file.case, Path::new(".")).map(drop));
        found.expect_err("a force that is none").to_string()
    };
    let motion = "\n[motion]\nduration = \"1 s\"";
    for (force, words) in [
        ("x = [1, 2]", "how long each acts"),
        ("every = \"1 s\"", "without values"),
        ("x = [nan]", "force[0].x[0]"),
        ("x = [1]\nevery = 0", "force[0].every"),
    ] {
        let told = told(&format!("[[force]]\nblock = \"stone\"\n{force}{motion}"));
        assert!(told.contains(words), "{force}: {told}");
    }
    let told_of = told(&format!("[[force]]\nblock = \"stones\"\nx = [1]{motion}"));
    assert!(told_of.contains("did you mean `stone`?"), "{told_of}");
    let still = told("[[force]]\nblock = \"stone\"\nx = [1]\n[motion]\nduration = \"1 s\"\nquasi_static = true");
    assert!(still.contains("inertia"), "{still}");
}

/// Forces in another unit, and values that never act, are told.
#[test]
fn forces_that_are_hardly_meant_are_told() {
    let told = |force: &str, duration: &str| {
        let text = stone(FLAT, &format!("[[force]]\nblock = \"stone\"\n{force}\n[motion]\nduration = \"{duration}\""));
        let texts: Vec<String> = prepared(&text).model.warnings.iter().map(|w| w.text.clone()).collect();
        texts.join("\n")
    };
    assert!(told("x = [3]", "1 s").contains("did you mean \"3 kN\""), "{}", told("x = [3]", "1 s"));
    assert!(told("x = [-3e8]", "1 s").contains("force[0].x"));
    let slow = told("x = [2500, 3000]\nevery = 1", "0.5 s");
    assert!(slow.contains("ends before its last value acts"), "{slow}");
    assert_eq!(told("x = [2500, 3000]\nevery = \"1 ms\"", "0.5 s"), "");
}
