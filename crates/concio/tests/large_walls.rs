//! Walls of hundreds of blocks, whose matrices are factorised front by front, and of thousands, where factors lead a search.

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

const PANEL: &str = r#"
[[panel]]
bond = "running"
courses = 41
bricks = 50
"#;

/// `count` panels side by side that do not touch.
fn panels(count: usize, friction: &str) -> Prepared {
    ready(&format!(
        r#"
model = "shear"
set = "report"
{}
[joint]
friction = {{ law = "{friction}", static = 0.6, dynamic = 0.42 }}
connection = {{ law = "none" }}
[load]
top = "2 kN/m"
{SHAKEN}"#,
        PANEL.repeat(count)
    ))
}

/// Two panels have too many blocks for a factorisation per iteration, one alone does not; each moves as it does alone.
#[test]
fn a_search_finds_what_factors_find() {
    for friction in ["stribeck", "none"] {
        let [one, two] = [1, 2].map(|count| panels(count, friction));
        let blocks = one.model.wall.blocks.len();
        assert!(blocks <= 4_000 && two.model.wall.blocks.len() == 2 * blocks && 2 * blocks > 4_000);
        let [a, b] = [(&one, 1e-2), (&two, 1e-2)].map(|(p, tolerance)| run(p, tolerance));
        let frames = a.recording.frame_displacement.len() / blocks;
        let peak = a.recording.frame_displacement.iter().fold(0.0f64, |m, z| m.max(z.abs()));
        assert!(frames > 20 && peak > 1e-8, "{frames} frames, {peak:e} m");
        let rows = a.recording.frame_displacement.chunks(blocks).zip(b.recording.frame_displacement.chunks(2 * blocks));
        let mut worst = 0.0f64;
        for (alone, both) in rows {
            for (z, pair) in alone.iter().zip(both.chunks(blocks).next().unwrap().iter().zip(&both[blocks..])) {
                worst = worst.max((z - pair.0).abs()).max((z - pair.1).abs());
            }
        }
        println!("{friction}: {worst:e} of {peak:e}; {:?}", b.counters);
        assert!(worst < 2e-3 * peak, "{friction}: {worst:e} of {peak:e}");
        assert!(b.energies.residual().abs() < 1e-4 * b.totals.peak_input, "{friction}: {:?}", b.energies);
        // Where friction holds blocks beside head joints, factors serve for more than a step.
        let most = if friction == "none" { b.counters.iterations } else { b.counters.steps };
        assert!(b.counters.factorisations < most, "{friction}: {:?}", b.counters);
    }
}

/// The factors of a step may be those of steps before: a state saved after any step knows them.
#[test]
fn a_search_is_restored_to_the_same_bits() {
    let p = panels(2, "stribeck");
    let whole = run(&p, p.case.solver.tolerance);
    assert_eq!(restarted(&p, 7, |_| 7), whole);
}
