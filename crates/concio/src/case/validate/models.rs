//! Keys that belong to one of the models alone: left unread they would mislead.

use super::{Bound, Findings};
use crate::InputError;
use crate::case::{Beam, BeamRotation, Bond, Case, FrictionPreset, ModelKind, NormalForce, Signal, StopAt};

pub(super) fn check(f: &mut Findings, case: &Case) {
    match case.model {
        ModelKind::Shear => {
            shapes(f, case);
            of_planar(case).into_iter().for_each(|key| refused(f, key));
        }
        ModelKind::Planar => planar(f, case),
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
        ("solver.step", case.solver.step.is_some()),
    ];
    keys.extend(others.into_iter().filter(|(_, given)| *given).map(|(key, _)| key.to_string()));
    keys
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
