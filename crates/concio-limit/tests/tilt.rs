//! Dry walls tilted slowly until they move, against the multipliers of limit analysis: friction without dilation gives less than the
//! associative λ, and more than walls whose head joints do not rub at all.

use std::path::Path;

use concio::Result;
use concio::case::{Case, ModelKind, Spring, SpringLaw};
use concio::run::prepare;
use concio::simulate::{Progress, Simulation};
use concio_limit::{Heads, Options, Push, Towards};

mod limit_walls;
use limit_walls::{DryWall, certified};

/// Displacement at which a wall counts as moving [m]: what a mechanism covers within a thousandth of the ramp.
const MOVING: f64 = 1e-4;

/// λ of the quasi-static planar model: base acceleration over g when a block has moved, of a ramp to `most`.
fn tilted(wall: &DryWall, most: f64) -> Result<f64> {
    let mut case: Case = wall.case();
    case.model = ModelKind::Planar;
    let rigid = |spring: Spring| Spring { law: SpringLaw::Rigid, ..spring };
    (case.joint.bed, case.joint.head) = (rigid(case.joint.bed), rigid(case.joint.head));
    // The base goes to the left, the blocks are pushed to the right: 1,000 steps.
    let motion = format!(
        "{{ \"motion\": {{ \"base\": {{ \"tilt\": {{ \"acceleration\": {:?}, \"rise\": 20 }} }} }} }}",
        -most * concio::G
    );
    let motion: serde_json::Value = serde_json::from_str(&motion).expect("JSON");
    case.motion = serde_json::from_value(motion["motion"].clone()).expect("a motion");
    case.motion.quasi_static = true;
    case.motion.duration = Some(concio::quantity::Time::from_si(20.0));
    let prepared = prepare(case, Path::new("."))?;
    let mut run = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?;
    while run.state().totals.peak_relative_displacement < MOVING {
        assert_eq!(run.advance(1), Progress::Running, "it moves");
        run.clear_recording();
    }
    assert!(run.state().totals.contact_residual < 1e-5, "{:e}", run.state().totals.contact_residual);
    Ok(most * run.time() / 20.0)
}

#[test]
fn tilted_walls_move_between_their_bounds() {
    let brick = [0.25, 0.12];
    let halves = |mu| DryWall::running(4, 8, brick, mu, false);
    let opening = vec![
        vec![1.0, 1.0, 1.0, 1.0],
        vec![0.5, 1.0, 1.0, 1.0, 0.5],
        vec![1.0, 0.5, -1.0, 0.5, 1.0],
        vec![0.5, 1.0, -1.0, 1.0, 0.5],
        vec![1.0, 1.0, 1.0, 1.0],
        vec![0.5, 1.0, 1.0, 1.0, 0.5],
    ];
    let walls = [
        ("W1, μ = 0.3", halves(0.3)),
        ("W1, μ = 0.65", halves(0.65)),
        ("W2, μ = 0.65", DryWall::running(6, 6, brick, 0.65, false)),
        ("with an opening", DryWall::pattern(&opening, [0.4, 0.175], 0.65)),
        ("stack", DryWall::stack(5, [0.4, 0.25], 0.7)),
    ];
    for (name, wall) in walls {
        let associative = wall.multiplier();
        let options = Options { heads: Heads::Frictionless, push: Push::Body, towards: Towards::Right };
        let frictionless = certified(&wall.limit(options));
        let found = tilted(&wall, 1.2 * associative).expect("a run");
        println!("{name}: {frictionless:.4} … {found:.4} … {associative:.4}");
        assert!(found >= 0.97 * frictionless && found <= 1.01 * associative, "{name}");
    }
}
