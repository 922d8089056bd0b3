//! The arch of example 17 on ground that tilts so slowly that inertia does nothing: it falls by hinges, which do not slide, so that
//! dilation makes no difference to its multiplier.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::run::prepare_case;
use concio::simulate::{Progress, Simulation};
use concio_limit::{Options, Problem, analyse};
use concio_verified::agrees;

/// Displacement at which the arch counts as moving [m]: what a mechanism covers within a thousandth of the ramp.
const MOVING: f64 = 1e-4;

#[test]
fn a_tilted_arch_falls_at_its_multiplier() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/17-arch.toml");
    let text = std::fs::read_to_string(path).expect("the example");
    let slow = text
        .replace("duration = \"3.2 s\"", "duration = \"20 s\"\nquasi_static = true")
        .replace("rise = \"2 s\"", "rise = \"20 s\"");
    let case = from_str(&slow, Syntax::Toml, None).expect("a wall file").case;
    assert!(case.motion.quasi_static && slow.contains("\"-0.2 g\", rise = \"20 s\""), "the example is another one");
    let limit = analyse(&Problem::of(&case, Options::default()).expect("an arch")).expect("a limit");
    let [lower, upper] = limit.bounds;
    assert!((upper - lower).abs() <= 1e-9, "{lower} … {upper}");
    let prepared = prepare_case(case, Path::new(".")).expect("an arch");
    let mut run = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling).expect("a run");
    while run.state().totals.peak_relative_displacement < MOVING {
        assert_eq!(run.advance(1), Progress::Running, "it moves");
        run.clear_recording();
    }
    let found = 0.2 * run.time() / 20.0;
    let subject = "Limit analysis: arch of example 17 on ground that tilts slowly, tilt at which it falls";
    agrees!(subject, "multiplier of limit analysis", "g", found, limit.multiplier(), 0.01);
}
