//! A wall built without a file, pushed by its own weight on tilting ground, for several coefficients of friction at once.
//!
//! `cargo run --release -p concio --example sweep`

use concio::case::{Brick, Case, CaseFile, Friction, Joints, ModelKind, Motion, Panel, Signal, Spring, Tilt};
use concio::many::{Job, simulate_many};
use concio::run::{Prepared, prepare};

/// A dry wall of 4 × 8 stones of 0.4 × 0.2 m, 0.3 m thick.
fn wall(friction: f64) -> concio::Result<Prepared> {
    let stone = Brick::new([0.4, 0.2, 0.3], 22e3);
    let panel = Panel::running(8, 4, stone, [0.0, 0.0]);
    let mut joints = Joints::new(Spring::rigid(), Spring::none());
    joints.friction = Friction::coulomb(friction);
    let tilt = Tilt { acceleration: (0.8 * concio::G).into(), start: 0.0.into(), rise: 20.0.into() };
    let motion =
        Motion { duration: Some(20.0.into()), base: Signal::Tilt(tilt), quasi_static: true, ..Motion::default() };
    let mut case = Case::new(ModelKind::Planar, panel, joints, motion);
    case.solver.step = Some(0.05.into());
    prepare(&CaseFile::of(&case)?)
}

fn main() -> concio::Result<()> {
    let frictions = [0.2, 0.3, 0.4];
    let walls = frictions.into_iter().map(wall).collect::<concio::Result<Vec<_>>>()?;
    let jobs: Vec<Job> = walls.iter().map(Job::from).collect();
    println!("friction  base shear over weight");
    for ((friction, wall), outcome) in frictions.into_iter().zip(&walls).zip(simulate_many(&jobs, 0)) {
        let borne = outcome?.totals.base_shear_peak / wall.model.weight();
        println!("{friction:8.2}  {borne:.3}");
        // A wall that slides on its lowest bed bears μ of its weight.
        assert!((borne / friction - 1.0).abs() < 0.02, "{borne} with a friction of {friction}");
    }
    Ok(())
}
