//! Keys that belong to one of the models alone: left unread they would mislead.

use super::{Bound, Findings};
use crate::InputError;
use crate::case::{
    Beam, BeamRotation, Bond, Case, FrictionPreset, ModelKind, NormalForce, Rocking, Signal, Solver, StopAt,
};

pub(super) fn check(f: &mut Findings, case: &Case) {
    match case.model {
        ModelKind::Shear => {
            shapes(f, case);
            of_planar(case).into_iter().for_each(|key| refused(f, key));
        }
        ModelKind::Planar => planar(f, case),
        ModelKind::Rocking => rocking(f, case),
    }
    if case.model != ModelKind::Rocking && case.rocking != Rocking::default() {
        f.push(
            "rocking",
            "the table is for walls that rock out of their plane",
            "with `model = \"rocking\"`; else leave it out",
        );
    }
}

fn refused(f: &mut Findings, key: String) {
    let error =
        InputError::new("the key is for planar walls: blocks of a shear wall move horizontally and nothing else");
    f.add(error.key(key).allowed("with `model = \"planar\"`; else leave it out"));
}

/// Blocks that lie on each other along slopes cannot slide past each other without rising.
fn shapes(f: &mut Findings, case: &Case) {
    for (i, panel) in case.panels.iter().enumerate() {
        if panel.bond == Bond::Arch {
            let what = "blocks of a shear wall move horizontally and nothing else: an arch could not give way";
            f.push(format_args!("panel[{i}].bond"), what, "`arch` with `model = \"planar\"`");
        }
        if let Some(k) = panel.blocks.iter().position(|block| !block.is_rectangle()) {
            let what = "the block is no level rectangle, and blocks of a shear wall move horizontally and nothing else";
            f.push(
                format_args!("panel[{i}].block[{k}].corners"),
                what,
                "rectangles; with `model = \"planar\"` any convex block",
            );
        }
    }
}

/// The keys given that only planar walls have.
fn of_planar(case: &Case) -> Vec<String> {
    let j = &case.joint;
    let mut keys = Vec::new();
    let kinds = [
        ("bed", Some(&j.bed)),
        ("head", Some(&j.head)),
        ("base", j.base.as_ref()),
        ("top", j.top.as_ref()),
        ("connection", j.connection.as_ref()),
    ];
    for (kind, spring) in kinds.into_iter().filter_map(|(kind, spring)| Some((kind, spring?))) {
        let ratio = (!crate::case::is_isotropic(&spring.normal_to_shear)).then_some("normal_to_shear");
        let strength = spring.compressive_strength.map(|_| "compressive_strength");
        let rocking = spring.rocking_restitution.map(|_| "rocking_restitution");
        keys.extend([ratio, strength, rocking].into_iter().flatten().map(|key| format!("joint.{kind}.{key}")));
    }
    for (i, spring) in j.changes.iter().enumerate().filter_map(|(i, change)| Some((i, change.spring?))) {
        let ratio = spring.normal_to_shear.map(|_| "normal_to_shear");
        let strength = spring.compressive_strength.map(|_| "compressive_strength");
        let rocking = spring.rocking_restitution.map(|_| "rocking_restitution");
        let given = [ratio, strength, rocking].into_iter().flatten();
        keys.extend(given.map(|key| format!("joint.change[{i}].spring.{key}")));
    }
    let others = [
        ("load.beam_rotation", case.load.beam_rotation != BeamRotation::Free),
        ("load.beam_height", case.load.beam_height.is_some()),
        ("motion.vertical", case.motion.vertical != Signal::None),
        ("motion.quasi_static", case.motion.quasi_static),
        ("motion.stop_at", case.motion.stop_at.is_some()),
        ("force[0]", !case.forces.is_empty()),
        ("solver.step", case.solver.step.is_some()),
    ];
    keys.extend(others.into_iter().filter(|(_, given)| *given).map(|(key, _)| key.to_string()));
    keys
}

/// What a wall that rocks out of its plane needs, and what it has no use for.
fn rocking(f: &mut Findings, case: &Case) {
    if case.out_of_plane.is_none() {
        let error = InputError::new(
            "a rocking wall turns out of its plane, and the file does not say what holds and loads it there",
        );
        let error = error.key("model").allowed("with a table [out_of_plane]");
        f.add(error.help("an empty one is a bare wall on the ground; `shear` and `planar` walls move in their plane"));
    }
    let Rocking { mechanism, hinge, restitution, .. } = case.rocking;
    if let Some(level) = hinge {
        f.quantity("rocking.hinge", level, Bound::From0);
        if mechanism.is_none() {
            f.push("rocking.hinge", "a level without a mechanism", "with `rocking.mechanism`; else leave it out");
        }
    }
    if let Some(e) = restitution {
        f.number("rocking.restitution", e, Bound::Between(0.0, 1.0));
    }
    let floors = "none: `out_of_plane.floor` has what lies on the wall and holds it";
    let solver = Solver::default();
    let unread = [
        ("tie[0]", !case.ties.is_empty(), "none: `out_of_plane.anchor` holds a wall back"),
        ("force[0]", !case.forces.is_empty(), "none: floors of `out_of_plane.floor` thrust"),
        ("load.beam", case.load.beam != Beam::Free, floors),
        ("load.beam_rotation", case.load.beam_rotation != BeamRotation::Free, floors),
        ("load.beam_height", case.load.beam_height.is_some(), floors),
        (
            "load.mass",
            case.load.mass.is_some(),
            "none: the mass of a load is that of its weight; `out_of_plane.floor` has others",
        ),
        ("motion.top", case.motion.top != Signal::None, "none: `motion.base` moves the wall"),
        ("motion.quasi_static", case.motion.quasi_static, "none: `concio mechanisms` follows the wall without inertia"),
        ("motion.stop_at", case.motion.stop_at.is_some(), "none: a run ends when the wall lies on the ground"),
        ("solver.scheme", case.solver.scheme != solver.scheme, "none: `solver.step` is the longest step"),
        ("solver.tolerance", case.solver.tolerance != solver.tolerance, "none: `solver.step` is the longest step"),
        ("solver.floor", case.solver.floor != solver.floor, "none: `solver.step` is the longest step"),
        ("solver.max_step", case.solver.max_step.is_some(), "none: `solver.step` is the longest step"),
        (
            "output.joints",
            !case.output.joints.is_empty(),
            "none: hinges have no histories; those of the bodies are always kept",
        ),
        ("output.blocks", !case.output.blocks.is_empty(), "none: histories of the bodies are always kept"),
    ];
    for (key, _, allowed) in unread.into_iter().filter(|(_, given, _)| *given) {
        f.push(key, "a rocking wall does not read the key", allowed);
    }
}

fn planar(f: &mut Findings, case: &Case) {
    if let Some(StopAt::Collapse(after)) = case.motion.stop_at {
        f.quantity("motion.stop_at.collapse", after, Bound::From0);
    }
    let friction = &case.joint.friction;
    let what = "in planar walls the pressure of a joint follows from the motion of its blocks";
    if friction.preset == Some(FrictionPreset::Report) {
        f.push("joint.friction.preset", what, "no preset; `on = \"all\"` for head joints that rub");
    } else if friction.normal_force == NormalForce::Overburden {
        f.push("joint.friction.normal_force", what, "`transmitted`, or leave the key out");
    }
    if let Some(height) = case.load.beam_height {
        f.quantity("load.beam_height", height, Bound::Above0);
        if case.load.beam == Beam::Free {
            f.push(
                "load.beam_height",
                "there is no beam that could be high",
                "with a beam: `driven`, `tied` or { mass = … }",
            );
        }
    }
    if case.load.beam_rotation == BeamRotation::Fixed && case.load.beam == Beam::Free {
        let what = "there is no beam whose rotation could be fixed";
        f.push("load.beam_rotation", what, "with a beam: `driven`, `tied` or { mass = … }");
    }
}
