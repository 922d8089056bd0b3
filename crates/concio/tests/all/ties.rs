//! Tie rods of wall files, against closed forms and the energy account.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::outcome::Outcome;
use concio::record::{Recording, StopReason};
use concio::run::{prepare_case, run_in_memory};
use concio::simulate::Simulation;
use concio::store::{self, hdf5};
use concio_verified::agrees;

use crate::common::ready::{close, last, ready};

fn ran(text: &str) -> Outcome {
    run_in_memory(&ready(text)).expect("a run")
}

/// A block of 5 kN that begins at x = 2 m, with μ = 0.4, pushed by 0.7 of its weight.
fn held(tie: &str) -> String {
    format!(
        r#"
model = "planar"
[[panel]]
bond = "explicit"
block = [{{ id = "stone", course = 1, x = 2, y = 0, length = 1, height = 0.25 }}]
brick = {{ length = 1, height = 0.25, thickness = 1, specific_weight = 20e3 }}
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", static = 0.4, dynamic = 0.4 }}
{tie}
[motion]
duration = "4 s"
quasi_static = true
base = {{ tilt = {{ acceleration = "-0.7 g", rise = "2 s" }} }}
"#
    )
}

/// A rod to the base bears 0.3 of the weight, wherever the wall begins and whichever end is named first; what the base exerts is all.
#[test]
fn a_rod_holds_what_friction_does_not() {
    for ends in [
        "from = \"base\"\nat = [0, 0.125]\nto = \"stone\"\nto_at = [-0.5, 0]",
        "from = \"stone\"\nat = [-0.5, 0]\nto = \"base\"\nto_at = [0, 0.125]",
    ] {
        let outcome = ran(&held(&format!("[[tie]]\n{ends}\nstiffness = \"5 MN/m\"")));
        let [tie] = &outcome.ties[..] else { panic!("{:?}", outcome.ties) };
        assert_eq!((tie.from.as_str(), tie.to.as_str(), tie.stretch), ("base", "stone", 0.0));
        assert!(tie.yielded.is_infinite());
        let first = if ends.starts_with("from = \"base\"") { "base" } else { "stone" };
        let of = |what: &str| format!("Ties: stone of a wall file on a rod, {what}; named from the {first}");
        agrees!(of("force"), "(0.7 − μ) W", "N", tie.force, 0.3 * 5e3, 1e-5);
        agrees!(of("way"), "f/k", "m", last(&outcome, "top/displacement"), tie.force / 5e6, 1e-5);
        agrees!(of("base shear"), "0.7 W", "N", last(&outcome, "base/shear"), -0.7 * 5e3, 1e-5);
    }
    // Too weak: it yields when what it should bear passes f_y, 0.4 + 1 kN/5 kN of the weight.
    let tie = "from = \"base\"\nat = [0, 0.125]\nto = \"stone\"\nstiffness = \"50 MN/m\"\nyield_force = \"1 kN\"";
    let outcome = ran(&held(&format!("[[tie]]\n{tie}")));
    let tie = &outcome.ties[0];
    let of = |what: &str| format!("Ties: stone of a wall file on a rod that yields, {what}");
    agrees!(of("force"), "f_y", "N", tie.force, 1e3, 1e-9);
    agrees!(of("instant it yields"), "μ W + f_y", "s", tie.yielded, 2.0 * 0.6 / 0.7, abs: 0.03);
    agrees!(of("energy taken"), "f_y e_p", "J", outcome.energies.device, 1e3 * tie.stretch, 1e-9);
}

/// Six courses of a dry wall, tied along the top and down to the base at both sides, rods of both kinds that yield.
fn shaken(law: &str) -> String {
    format!(
        r#"
model = "planar"
[[panel]]
bond = "running"
courses = 6
bricks = 3
brick = {{ length = 0.25, height = 0.1, thickness = 0.12, specific_weight = 18e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {law}
head = {law}
friction = {{ law = "coulomb", static = 0.7, dynamic = 0.7 }}
[[tie]]
from = "p1c6b1"
to = "p1c6b4"
stiffness = "2 MN/m"
slack = "0.1 mm"
[[tie]]
from = "base"
to = "p1c6b1"
at = [0.02, 0]
to_at = [-0.0425, 0]
stiffness = "2 MN/m"
yield_force = "100 N"
[[tie]]
from = "base"
to = "p1c6b4"
at = [0.73, 0]
to_at = [0.0425, 0]
stiffness = "2 MN/m"
yield_force = "100 N"
[motion]
duration = "0.3 s"
base = {{ sine = {{ acceleration = "1.1 g", frequency = "4 Hz" }} }}
vertical = {{ sine = {{ acceleration = "0.2 g", frequency = "7 Hz" }} }}
[solver]
step = "1 ms"
"#
    )
}

const RIGID: &str = "{ law = \"rigid\" }";
const SPRINGS: &str = "{ law = \"no-tension\", stiffness = \"3 N/mm3\", rigidity = 1 }";

/// What the base brings is what is stored and taken, and what yielding takes is f_y times the stretch.
#[test]
fn a_tied_wall_keeps_its_energy() {
    for law in [RIGID, SPRINGS] {
        let text = shaken(law);
        let outcome = ran(&text);
        let residual = outcome.totals.peak_residual / outcome.totals.peak_input;
        assert!(residual < 1e-3, "{law}: {residual:e}");
        assert_eq!(outcome.stop_reason, StopReason::Completed);
        let ties = &outcome.ties;
        assert!(ties.iter().all(|t| t.force > 0.0 && t.yielded.is_finite() == (t.stretch > 0.0)), "{law}: {ties:?}");
        assert!(ties[1].yielded.is_finite() && ties[0].yielded.is_infinite(), "{law}: {ties:?}");
        assert!(ties[1..].iter().all(|t| t.force <= 100.0 * (1.0 + 1e-9)), "{law}: {ties:?}");
        let taken: f64 = ties[1..].iter().map(|t| 100.0 * t.stretch).sum();
        close(outcome.energies.device, taken, 1e-9);
        let start = text.find("[[tie]]").expect("ties");
        let untied = [&text[..start], &text[text.find("[motion]").expect("a motion")..]].concat();
        let untied = ran(&untied);
        assert!(untied.ties.is_empty() && untied.energies.device == 0.0);
    }
}

#[test]
fn a_resumed_run_has_the_bits_of_one_that_was_not_stopped() {
    let prepared = ready(&shaken(RIGID));
    let whole = run_in_memory(&prepared).expect("a run");
    let new = || Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling).expect("a run");
    let mut first = new();
    let mut rows = Recording::default();
    for _ in 0..6 {
        first.advance(25);
        rows.append(first.recording());
        first.clear_recording();
    }
    let saved = first.save();
    let mut second = new();
    assert!(second.restore(&saved));
    let (rest, reason) = second.run_to_end();
    rows.append(&rest);
    assert_eq!(second.outcome(rows, reason), whole);
}

/// The result file holds what the rods bore, the summary says it.
#[test]
fn results_hold_the_rods() {
    let prepared = ready(&shaken(RIGID));
    let outcome = run_in_memory(&prepared).expect("a run");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("result.h5");
    let model = &prepared.model;
    let (provenance, joints) = (prepared.provenance(), concio::run::joint_rows(model));
    hdf5::write(&path, &provenance, &model.wall, &joints, &outcome).expect("a file");
    let read = hdf5::read(&path).expect("a result");
    assert_eq!(read.outcome.ties, outcome.ties);
    let summary = store::summary(&provenance, &model.wall, &joints, &outcome, &store::RunFacts::default());
    assert_eq!(summary["ties"].as_array().map(Vec::len), Some(3));
    assert_eq!(summary["ties"][0]["from"], "p1c6b1");
    assert_eq!(summary["ties"][0]["yielded"], serde_json::Value::Null);
    assert_eq!(summary["ties"][1]["peak_force"].as_f64(), Some(outcome.ties[1].force));
}

#[test]
fn rods_without_length_are_refused_and_detached_ones_doubted() {
    let wrong = held("[[tie]]\nfrom = \"base\"\nat = [2.5, 0.125]\nto = \"stone\"\nstiffness = 1e6");
    let file = from_str(&wrong, Syntax::Toml, None).expect("a wall file");
    let error = prepare_case(file.case, Path::new(".")).expect_err("no length").to_string();
    assert!(error.contains("tie[0].to_at") && error.contains("at the same place"), "{error}");
    let doubts = |at: f64| {
        let tie = format!("[[tie]]\nfrom = \"base\"\nto = \"stone\"\nto_at = [{at}, 0]\nstiffness = 1e6");
        let warnings = ready(&held(&tie)).model.warnings.clone();
        warnings.into_iter().filter(|w| w.contains("tie[0]")).collect::<Vec<_>>()
    };
    assert_eq!(doubts(-0.5), [""; 0]);
    assert_eq!(doubts(-0.6), ["tie[0].to_at lies 0.100 m outside of block stone"]);
}
