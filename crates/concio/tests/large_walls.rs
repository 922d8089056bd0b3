//! Walls of hundreds of blocks, whose matrices are factorised front by front.

use concio::outcome::Outcome;
use concio::run::Prepared;
use concio::simulate::Simulation;

use ready::ready;
use restarted::restarted;

#[path = "common/ready.rs"]
mod ready;
#[path = "common/restarted.rs"]
mod restarted;

fn wall() -> String {
    format!(
        r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 20
bricks = 20
[joint]
friction = {{ law = "stribeck", static = 0.6, dynamic = 0.42 }}
[load]
top = "2 kN/m"
{SHAKEN}"#
    )
}

const SHAKEN: &str = r#"
[motion]
duration = "0.3 s"
base = { synthetic = { seed = 3, pga = "0.8 g", duration = "4 s" } }
[output]
interval = "0.01 s"
frames = "0.01 s"
"#;

fn run(p: &Prepared, tolerance: f64) -> Outcome {
    let mut solver = p.case.solver;
    solver.tolerance = tolerance;
    let mut run = Simulation::new(&p.model, &solver, &p.sampling).unwrap();
    let (rows, reason) = run.run_to_end();
    run.outcome(rows, reason)
}

/// Without friction and with elastic heads, stages share factors; displacements are those of a finer run.
#[test]
fn factors_used_again_keep_the_accuracy() {
    let text = wall().replace("law = \"stribeck\"", "law = \"none\"");
    let p = ready(&text.replace("[joint]", "[joint]\nhead = { law = \"elastic\" }"));
    let (coarse, fine) = (run(&p, 1e-3), run(&p, 1e-5));
    let counters = coarse.counters;
    assert!(2 * counters.factorisations <= counters.iterations, "{counters:?}");
    let [a, b] = [&coarse, &fine].map(|o| &o.recording.frame_displacement);
    assert_eq!(a.len(), b.len());
    let peak = b.iter().fold(0.0f64, |m, z| m.max(z.abs()));
    let error = a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(error < 0.02 * peak, "{error:e} of {peak:e}");
}

/// A state saved after any step continues with the same bits.
#[test]
fn a_large_run_is_restored_to_the_same_bits() {
    let p = ready(&wall());
    let whole = run(&p, p.case.solver.tolerance);
    assert_eq!(restarted(&p, 3, |_| 3), whole);
}
