//! The research report's parameter sets: keys that the file leaves out are filled in the tree, before it is read as a `Case`.
//! So the file wins key by key, and a missing key of a set is an error with a place like any other.

use super::node::{Fault, Node, Value};
use super::{ParameterSet, SetName};
use crate::InputError;

/// A printed range; a single number has equal ends.
type Range = [f64; 2];

/// What the research report prints of a set (Table 1 and section 4.2), in SI.
struct Printed {
    /// L, B, H of the brick [m].
    brick: [f64; 3],
    /// γ [N/m³].
    specific_weight: Option<f64>,
    /// t [m]: thickness of bed and head joints.
    mortar: Range,
    /// K_V, K_H [N/m].
    stiffness: [Range; 2],
    friction: Coefficients,
}

enum Coefficients {
    /// Ranges of μ_s and μ_d.
    Given([Range; 2]),
    /// φ [°]: μ_s = tan φ, μ_d = 0.7 μ_s, the ratio of section 4.2.
    Angle(Range),
    /// None printed.
    Absent,
}

/// μ_d/μ_s of section 4.2 (0.28/0.40 and 0.56/0.80).
const DYNAMIC_OVER_STATIC: f64 = 0.7;

fn printed(name: SetName) -> Printed {
    let same = |v| [v, v];
    match name {
        SetName::Report => Printed {
            brick: [0.25, 0.12, 0.055],
            specific_weight: Some(18_000.0),
            mortar: same(0.01),
            stiffness: [same(5.4e7), same(5.4e7)],
            friction: Coefficients::Given([[0.40, 0.80], [0.28, 0.56]]),
        },
        SetName::P1 => Printed {
            brick: [0.25, 0.12, 0.055],
            specific_weight: Some(19_620.0),
            mortar: same(0.015),
            stiffness: [[9.00e7, 1.62e8], [5.40e7, 1.53e8]],
            friction: Coefficients::Angle([20.0, 40.0]),
        },
        SetName::P2 => Printed {
            brick: [0.25, 0.12, 0.055],
            specific_weight: Some(14_010.0),
            mortar: same(0.015),
            stiffness: [same(1.80e7), same(2.16e7)],
            friction: Coefficients::Angle([15.0, 38.0]),
        },
        SetName::P3 => Printed {
            brick: [0.5, 0.299, 0.2],
            specific_weight: Some(14_715.0),
            mortar: same(0.015),
            stiffness: [[6.69e6 - 2.14e6, 6.69e6 + 2.14e6], [6.69e7 - 2.14e6, 6.69e7 + 2.14e6]],
            friction: Coefficients::Absent,
        },
        SetName::P4 => Printed {
            brick: [0.25, 0.12, 0.07],
            specific_weight: None,
            mortar: [0.010, 0.015],
            stiffness: [[1.34e7, 1.07e8], [1.34e7, 1.07e8]],
            friction: Coefficients::Angle([17.2, 62.2]),
        },
    }
}

fn label(name: SetName) -> &'static str {
    match name {
        SetName::Report => "report",
        SetName::P1 => "p1",
        SetName::P2 => "p2",
        SetName::P3 => "p3",
        SetName::P4 => "p4",
    }
}

/// Fills what the file leaves out from `set`. The error is about a key that neither the file nor the set gives.
pub(super) fn fill(root: &mut Node, set: &ParameterSet) -> Result<(), Fault> {
    let printed = printed(set.name);
    let at = |[low, high]: Range| low + set.at * (high - low);
    if let Some(Node { value: Value::List(panels), .. }) = root.get_mut("panel") {
        for (index, panel) in panels.iter_mut().enumerate() {
            fill_panel(panel, index, &printed, set.name, at(printed.mortar))?;
        }
    }
    let place = root.at;
    root.fill("joint", Value::Table(Vec::new()));
    let Some(joint) = root.get_mut("joint") else { return Ok(()) };
    fill_spring(joint, "head", "no-tension", at(printed.stiffness[0]));
    fill_spring(joint, "bed", "elastic", at(printed.stiffness[1]));
    joint.fill("damping_ratio", Value::Float(0.05));
    let coefficients = match printed.friction {
        Coefficients::Given([static_, dynamic]) => Some([at(static_), at(dynamic)]),
        Coefficients::Angle(angle) => {
            let static_ = at(angle).to_radians().tan();
            Some([static_, DYNAMIC_OVER_STATIC * static_])
        }
        Coefficients::Absent => None,
    };
    fill_friction(joint, coefficients, set.name, place)
}

fn fill_panel(panel: &mut Node, index: usize, printed: &Printed, name: SetName, mortar: f64) -> Result<(), Fault> {
    panel.fill("brick", Value::Table(Vec::new()));
    if let Some(brick) = panel.get_mut("brick") {
        for (key, value) in ["length", "thickness", "height"].into_iter().zip(printed.brick) {
            brick.fill(key, Value::Float(value));
        }
        match printed.specific_weight {
            Some(value) => brick.fill("specific_weight", Value::Float(value)),
            None if !brick.has("specific_weight") && matches!(brick.value, Value::Table(_)) => {
                let what =
                    format!("set `{}` of Table 1 prints no specific weight, so the file must give it", label(name));
                let error = InputError::new(what).key(format!("panel[{index}].brick.specific_weight"));
                return Err(Fault::new(error.allowed("above 0 N/m3"), brick.at));
            }
            None => {}
        }
    }
    panel.fill("mortar", Value::Table(Vec::new()));
    if let Some(joint) = panel.get_mut("mortar") {
        joint.fill("bed", Value::Float(mortar));
        joint.fill("head", Value::Float(mortar));
    }
    Ok(())
}

fn fill_spring(joint: &mut Node, key: &str, law: &str, stiffness: f64) {
    joint.fill(key, Value::Table(Vec::new()));
    if let Some(spring) = joint.get_mut(key) {
        spring.fill("law", Value::Text(law.to_string()));
        spring.fill("stiffness", Value::Float(stiffness));
    }
}

fn fill_friction(joint: &mut Node, coefficients: Option<[f64; 2]>, name: SetName, place: usize) -> Result<(), Fault> {
    let absent = !joint.has("friction");
    joint.fill("friction", Value::Table(Vec::new()));
    let Some(friction) = joint.get_mut("friction") else { return Ok(()) };
    let none = friction.get("law").and_then(Node::text) == Some("none");
    match coefficients {
        Some([static_, dynamic]) => {
            friction.fill("static", Value::Float(static_));
            friction.fill("dynamic", Value::Float(dynamic));
        }
        None if !none && matches!(friction.value, Value::Table(_)) => {
            for key in ["static", "dynamic"] {
                if !friction.has(key) {
                    let what =
                        format!("set `{}` of Table 1 prints no friction angle, so the file must give it", label(name));
                    let error = InputError::new(what).key(format!("joint.friction.{key}"));
                    let error = error.allowed("from 0").help("for a wall without friction write `law = \"none\"`");
                    return Err(Fault::new(error, if absent { place } else { friction.at }));
                }
            }
        }
        None => {}
    }
    friction.fill("law", Value::Text("stribeck".into()));
    friction.fill("slip_velocity", Value::Float(1e-3));
    friction.fill("beta", Value::Float(100.0));
    friction.fill("alpha", Value::Float(0.0));
    Ok(())
}
