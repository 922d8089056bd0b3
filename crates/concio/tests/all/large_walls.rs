//! Walls of hundreds of blocks, whose matrices are factorised front by front, and of thousands, where factors lead a search.

use concio::outcome::Outcome;
use concio::run::Prepared;
use concio::simulate::Simulation;

use crate::common::ready::ready;
use crate::common::restarted::restarted;

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

/// The error is largest where the record has a kink. The first step there is as long as the last one there has shown it may be:
/// without that every twelfth step is refused here.
#[test]
fn few_steps_are_refused_where_the_record_has_kinks() {
    let counters = run(&ready(&wall()), 1e-4).counters;
    assert!(20 * counters.rejected < counters.steps, "{counters:?}");
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
    ready(&text(count, friction))
}

fn text(count: usize, friction: &str) -> String {
    format!(
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
    )
}

/// Differences of displacements, velocities and accelerations over their peaks, over the tolerance.
const MOST: [f64; 3] = [2e-3, 0.1, 10.0];

/// Two panels have too many blocks for a factorisation per iteration, one alone does not; each moves as it does alone.
#[test]
fn a_search_finds_what_factors_find() {
    for (friction, tolerance) in [("stribeck", 1e-2), ("none", 1e-2), ("stribeck", 1e-4)] {
        let [one, two] = [1, 2].map(|count| panels(count, friction));
        let blocks = one.model.wall.blocks.len();
        assert!(blocks <= 4_000 && two.model.wall.blocks.len() == 2 * blocks && 2 * blocks > 4_000);
        let [a, b] = [&one, &two].map(|p| run(p, tolerance));
        let frames = a.recording.frame_displacement.len() / blocks;
        let peak = a.recording.frame_displacement.iter().fold(0.0f64, |m, z| m.max(z.abs()));
        assert!(frames > 20 && peak > 1e-8, "{frames} frames, {peak:e} m");
        // What alone and what both panels came to, frame by frame: the largest difference over the peak.
        let worst = |of: fn(&Outcome) -> &[f64]| {
            let (alone, both) = (of(&a), of(&b));
            let count = alone.len() / frames;
            let peak = alone.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let mut worst = 0.0f64;
            for (alone, both) in alone.chunks(count).zip(both.chunks(2 * count)) {
                for (x, pair) in alone.iter().zip(both.iter().zip(&both[count..])) {
                    worst = worst.max((x - pair.0).abs()).max((x - pair.1).abs());
                }
            }
            worst / peak
        };
        let found = [
            worst(|o| &o.recording.frame_displacement),
            worst(|o| &o.recording.frame_velocity),
            worst(|o| &o.recording.frame_acceleration),
        ];
        println!("{friction} {tolerance:e}: {found:?}; {:?}", b.counters);
        assert!(found.iter().zip(MOST).all(|(found, most)| *found < most * tolerance), "{friction}: {found:?}");
        assert!(b.energies.residual().abs() < 1e-4 * b.totals.peak_input, "{friction}: {:?}", b.energies);
        // Where friction holds blocks beside head joints, factors serve for more than a step.
        let most = if friction == "none" { b.counters.iterations } else { b.counters.steps };
        assert!(b.counters.factorisations < most, "{friction}: {:?}", b.counters);
    }
}

/// The factors of a step may be those of steps before: a state saved after any step knows them.
#[test]
fn a_search_is_restored_to_the_same_bits() {
    for friction in ["stribeck", "none"] {
        let p = panels(2, friction);
        let whole = run(&p, p.case.solver.tolerance);
        assert!(restarted(&p, 7, |_| 7) == whole, "{friction}");
    }
}

/// A wall at rest stays there until something happens.
#[test]
fn a_large_wall_waits() {
    let pulse =
        r#"base = { pulse = { shape = "half-sine", acceleration = "0.3 g", duration = "0.1 s", start = "0.2 s" } }"#;
    let text = text(2, "stribeck");
    let (motion, rest) = text.split_once("base = {").expect("a motion");
    let p = ready(&format!("{motion}{pulse}{}", &rest[rest.find('\n').expect("a line")..]));
    let outcome = run(&p, 1e-2);
    assert_eq!(outcome.counters.failed, 0);
    let blocks = p.model.wall.blocks.len();
    let frames = outcome.recording.frame_displacement.chunks(blocks).zip(&outcome.recording.frame_time);
    for (z, t) in frames {
        let peak = z.iter().fold(0.0f64, |m, z| m.max(z.abs()));
        assert!(if *t <= 0.2 { peak == 0.0 } else { peak > 1e-9 }, "{peak:e} m at {t} s");
    }
}
