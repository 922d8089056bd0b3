//! The assembled system as JSON, for other solvers (`concio system`).

use serde_json::{Value, json};

use crate::error::{InputError, Result};
use crate::model::Model;

/// The system (1) in coordinates relative to the base: masses, joints, motion (the format is fixed in docs/system.md).
///
/// # Errors
/// A driven top on a moving base: the format has one motion for the top and it is relative to the base. Planar walls, set-valued
/// friction, rigid joints, bonds and devices with laws of their own, which the format cannot express.
pub fn system(model: &Model) -> Result<Value> {
    model.shear_only("the system for other solvers")?;
    if let Some(contact) = model.shear.contacts.first() {
        let name = crate::graph::name(&model.wall, &model.joints[contact.joint as usize]);
        let error = InputError::new(format!("the rigid joint {name} has no place in the system for other solvers"));
        return Err(error.key("joint.head.law").allowed("`no-tension`, `elastic`").into());
    }
    if model.shear.sticks() {
        let error = InputError::new("set-valued friction has no place in the system for other solvers");
        return Err(error.key("joint.friction.law").allowed("`stribeck`, `none`").into());
    }
    if !model.shear.bonds.is_empty() {
        let error = InputError::new("bonds have no place in the system for other solvers");
        return Err(error.key("joint.bond").allowed("joints without bond").into());
    }
    if let Some(device) = model.shear.nonlinear.first() {
        let name = crate::graph::name(&model.wall, &model.joints[device.joint as usize]);
        let error = InputError::new(format!("the device of joint {name} has no place in the system for other solvers"));
        let allowed = "linear `viscous`, `elastic` and `friction-damper` devices";
        return Err(error.key("joint.change").allowed(allowed).into());
    }
    let (base, top) = (model.shear.base(), model.shear.top());
    let rub: Vec<_> = model.shear.rub_of_joint().into_iter().map(|r| r.map(|r| &model.shear.rubs[r])).collect();
    let side = |b: usize| {
        if b == base {
            json!("base")
        } else if b == top {
            json!("top")
        } else {
            json!(b)
        }
    };
    let joints: Vec<Value> = model
        .shear
        .elastic
        .iter()
        .zip(&model.shear.sides)
        .zip(&rub)
        .map(|((law, &[a, b]), rub)| {
            json!({
                "a": a,
                "b": side(b as usize),
                "law": if law.unilateral { "no-tension" } else { "elastic" },
                "stiffness": law.stiffness,
                "damping": law.damping,
                "normal_force": rub.map_or([0.0; 2], |r| r.normal),
                "friction": rub.map(|r| json!({
                    "static": r.law.static_,
                    "dynamic": r.law.dynamic,
                    "slip_velocity": r.law.slip_velocity,
                    "beta": r.law.beta,
                    "alpha": r.law.alpha,
                })),
            })
        })
        .collect();
    let (base, top) = model.excitation.system_motions(model.beam)?;
    Ok(json!({
        "mass": model.shear.mass,
        "joints": joints,
        "base": base,
        "top": top,
        "duration": model.excitation.duration,
    }))
}
