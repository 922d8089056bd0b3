//! A motion of one's own, and a monitor that stops the run where a block has moved by 20 mm.
//!
//! `cargo run --release -p concio --example own_motion`

use concio::case::{Brick, Case, CaseFile, Friction, Joints, ModelKind, Motion, Panel, Spring};
use concio::ground::signal::GroundMotion;
use concio::run::{Control, prepare_moved, run_watched};

fn main() -> concio::Result<()> {
    // A stone of 1 × 0.5 m on its base, friction 0.3.
    let panel = Panel::stack(1, 1, Brick::new([1.0, 0.5, 0.5], 20e3), [0.0, 0.0]);
    let mut joints = Joints::new(Spring::rigid(), Spring::none());
    joints.friction = Friction::coulomb(0.3);
    let motion = Motion { duration: Some(3.0.into()), ..Motion::default() };
    let wall = CaseFile::of(&Case::new(ModelKind::Planar, panel, joints, motion))?;

    // Samples of an acceleration that grows, every 5 ms [m/s²].
    let dt = 5e-3;
    let samples: Vec<f64> = (0..600).map(|k| f64::from(k) * dt).map(|t| 3.0 * t * (12.0 * t).sin()).collect();
    let prepared = prepare_moved(&wall, GroundMotion::sampled(dt, &samples)?)?;

    let outcome = run_watched(&prepared, &mut |run| match run.state().z[0].abs() > 20e-3 {
        true => Control::Stop,
        false => Control::Continue,
    })?;
    assert_eq!(outcome.stop_reason, concio::record::StopReason::Interrupted);
    println!(
        "{:?} at {:.3} s; it moved {:.1} mm at most",
        outcome.stop_reason,
        outcome.time_reached,
        1e3 * outcome.totals.peak_relative_displacement
    );
    Ok(())
}
