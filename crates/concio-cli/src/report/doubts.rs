//! When not to believe a result: what the model cannot show, and what this run strains.

use concio::case::{FrictionLaw, JointKind};

use super::Content;
use crate::digest::residual;
use crate::format::{si, significant};

/// Residual of the energy account beyond which a run is not to be trusted.
pub const LARGEST_RESIDUAL: f64 = 1e-3;
/// Part of the shortest contact up to which displacements may be called small.
const SMALL: f64 = 0.1;

/// One sentence or two each; those of this run come first.
pub fn list(content: &Content) -> Vec<String> {
    let mut doubts = of_this_run(content);
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
    let (outcome, friction) = (content.outcome, &content.case.joint.friction);
    let mut doubts = Vec::new();
    let residual = residual(content.summary);
    if !(residual <= LARGEST_RESIDUAL) {
        doubts.push(format!(
            "The energy account of this run does not close: its residual is {residual:.1e} of the largest work, more \
             than {LARGEST_RESIDUAL}. Lower solver.tolerance."
        ));
    }
    if let Some((moved, overlap)) = strained(content) {
        doubts.push(format!(
            "A joint moved by {}, which is {} % of its contact of {}: contacts and loads are those of the undeformed \
             wall throughout.",
            si(moved, "m"),
            significant(100.0 * moved / overlap, 2),
            si(overlap, "m")
        ));
    }
    if friction.law == FrictionLaw::Stribeck && outcome.totals.peak_slip_velocity > friction.slip_velocity.si() {
        doubts.push(
            "Joints slip in this run. Stick-slip is sensitive to the last digit: energies, envelopes and forces can be \
             relied on, the course of a single history after many slips cannot."
                .into(),
        );
    }
    doubts
}

/// The bed or support joint that moved most for its length, if that is no small displacement any more.
fn strained(content: &Content) -> Option<(f64, f64)> {
    let moved = &content.outcome.envelopes.joint_displacement;
    let lying = |kind| matches!(kind, JointKind::Bed | JointKind::Base | JointKind::Top);
    let all = content.joints.iter().zip(moved).filter(|(j, _)| lying(j.kind)).map(|(j, &d)| (d, j.overlap));
    all.max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1))).filter(|(d, l)| d / l > SMALL)
}
