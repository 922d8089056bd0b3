//! When not to believe a result: what the model cannot show, and what this run strains.

use concio::case::{FrictionLaw, ModelKind};

use super::Content;
use crate::digest::residual;
use crate::format::{exponent, seconds};

/// Residual of the energy account beyond which a run is not to be trusted.
pub const LARGEST_RESIDUAL: f64 = 1e-3;

/// Of walls that rock out of their plane.
const ROCKING: [&str; 4] = [
    "Bodies are rigid and hinges neither slide nor crush on: masonry that disintegrates falls before it turns.",
    "The mechanism with the least α0 sets off first and need not fall first: rocking.mechanism and rocking.hinge name others.",
    "The restitution e of impacts is chosen, not known, and a record has no sign: repeat with other values and with the other sign \
     (rocking.restitution, rocking.positive).",
    "One record is one sample, and a fall is not monotonic in its scale: what stands here may fall under less.",
];

/// One sentence or two each; those of this run come first.
pub fn list(content: &Content) -> Vec<String> {
    let mut doubts = of_this_run(content);
    if content.case.model == ModelKind::Rocking {
        doubts.extend(ROCKING.map(String::from));
        return doubts;
    }
    if content.is_planar() {
        doubts.push(
            "Blocks are rigid and stay in the plane of the wall: a joint has all the give there is, cracks run along joints \
             and never through a block, and leaves do not part."
                .into(),
        );
        return doubts;
    }
    doubts.push(
        "Blocks move horizontally only. Rocking, uplift, flexure and diagonal cracking cannot occur in this model: a \
         slender wall, or one under little load, may fail in those ways first."
            .into(),
    );
    doubts.push(
        "Normal forces are those of statics, constant in time: vertical shaking and the change of load through \
         overturning are left out."
            .into(),
    );
    if content.case.joint.friction.law != FrictionLaw::None {
        doubts.push(
            "The springs of the bed joints stay elastic beside friction, however far a joint slips: forces may exceed \
             the friction capacity, and the wall never slides off."
                .into(),
        );
    }
    if content.case.joint.friction.law == FrictionLaw::Stribeck {
        doubts.push(
            "Friction is a smooth function of velocity: a joint that sticks creeps slowly under load instead of \
             holding for ever."
                .into(),
        );
    }
    doubts
}

fn of_this_run(content: &Content) -> Vec<String> {
    let outcome = content.outcome;
    let mut doubts = Vec::new();
    let speeds = content.joints.iter().zip(&outcome.envelopes.joint_velocity);
    let slips = speeds.filter_map(|(j, v)| Some((j.friction?, *v))).any(|(law, v)| v > law.creeps_below());
    let residual = residual(content.summary);
    if !(residual <= LARGEST_RESIDUAL) {
        doubts.push(format!(
            "The energy account of this run does not close: its residual is {} of the largest work, more \
             than {LARGEST_RESIDUAL}. Lower {}.",
            exponent(residual, 1),
            if content.case.model != ModelKind::Shear { "solver.step" } else { "solver.tolerance" }
        ));
    }
    let unsolved = outcome.counters.unsolved;
    if unsolved > 0 {
        doubts.push(format!(
            "The contact of {unsolved} of {} steps was left unsolved: blocks may overlap there, and forces be \
             off.",
            outcome.counters.steps
        ));
    }
    if let Some(event) = outcome.recording.collapse() {
        doubts.push(format!(
            "The wall counts as collapsed from t = {} on: what its blocks do afterwards is no more than a picture.",
            seconds(event.time)
        ));
    }
    let planar = content.is_planar();
    if planar && content.case.motion.quasi_static {
        doubts.push(
            "This run leaves inertia out: forces and displacements count up to where the wall gives way; velocities, and how \
             and when blocks fall, mean nothing."
                .into(),
        );
    }
    if slips && planar && !content.case.motion.quasi_static {
        doubts.push(
            "Blocks slip and meet in this run, and both are sensitive to the last digit: drifts, peaks of forces and the name of \
             the failure may change with the step. Run it with half of `solver.step` too, and rely only on what does not change. \
             The largest base shear is often that of an impact."
                .into(),
        );
    } else if slips {
        let sure = if planar { "envelopes and forces" } else { "energies, envelopes and forces" };
        doubts.push(format!(
            "Joints slip in this run. Stick-slip is sensitive to the last digit: {sure} can be relied on, the course of a \
             single history after many slips cannot."
        ));
    }
    doubts
}
