//! Devices in the place of mortar (theory, section 3), as a wall file gives them: springs, dashpots, friction and what is left, a law of
//! `concio_law::device`, whose equations (I1) to (I7) are.

pub use concio_law::device::{BoucWen, Law, Power, ReCentring};

use concio_law::friction::Stribeck;
use concio_shear::law::{Elastic, Nonlinear, Rub};

use crate::assign::{JointLaw, resolve};
use crate::case::{BETA, Case, Device as Given, DeviceLaw, GAMMA};
use crate::error::Result;
use crate::wall::{Joint, Wall};

const SHARPNESS: f64 = 2.0;
const SLIP_VELOCITY: f64 = 1e-3;
const STEEPNESS: f64 = 100.0;

/// A joint with a device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Device {
    /// Index of the joint.
    pub joint: u32,
    /// Its law.
    pub law: DeviceLaw,
}

/// What a device is good for, in numbers that all laws have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rating {
    /// Its law.
    pub law: DeviceLaw,
    /// Stiffness at rest [N/m].
    pub stiffness: f64,
    /// Dashpot [N s/m], that of a power law at its reference velocity.
    pub damping: f64,
    /// Force at which it slips, yields or is activated [N]; infinite where it does none of these.
    pub gives_way: f64,
}

impl Rating {
    fn of(given: &Given) -> Self {
        let force = match given.law {
            DeviceLaw::Viscous | DeviceLaw::Elastic => None,
            DeviceLaw::FrictionDamper => given.slip_force,
            DeviceLaw::BoucWen => given.yield_force,
            DeviceLaw::ReCentring => given.activation_force,
        };
        Rating {
            law: given.law,
            stiffness: elastic(given).stiffness + nonlinear(given).map_or(0.0, |law| law.initial_stiffness()),
            damping: given.damping.map_or(0.0, |c| c.si()),
            gives_way: force.map_or(f64::INFINITY, |f| f.si()),
        }
    }
}

/// The devices that `case`, whose wall and joints these are, has, in the order of the joints.
///
/// # Errors
/// None that compiling the model did not have.
pub fn ratings(case: &Case, wall: &Wall, joints: &[Joint]) -> Result<Vec<Rating>> {
    let laws = resolve(case, wall, joints)?;
    Ok(laws.iter().filter_map(|law| law.device(case)).map(Rating::of).collect())
}

/// Spring and dashpot of a device.
pub(crate) fn elastic(d: &Given) -> Elastic {
    let si = |q: Option<crate::quantity::ForcePerLength>| q.map_or(0.0, |k| k.si());
    let dashpot = d.damping.map_or(0.0, |c| c.si());
    let (stiffness, damping) = match d.law {
        DeviceLaw::Viscous if d.exponent.unwrap_or(1.0) < 1.0 => (0.0, 0.0),
        DeviceLaw::Viscous => (0.0, dashpot),
        DeviceLaw::Elastic => (si(d.stiffness), dashpot),
        DeviceLaw::FrictionDamper => (0.0, 0.0),
        DeviceLaw::BoucWen => {
            let (force, displacement) = yielding(d);
            (d.hardening.unwrap_or(0.0) * force / displacement, dashpot)
        }
        DeviceLaw::ReCentring => (si(d.post_stiffness), dashpot),
    };
    Elastic { stiffness, damping, unilateral: false }
}

/// F_y [N] and d_y [m].
fn yielding(d: &Given) -> (f64, f64) {
    (d.yield_force.map_or(0.0, |f| f.si()), d.yield_displacement.map_or(1.0, |l| l.si()))
}

/// What is left of a device beside [`elastic`] and friction.
pub(crate) fn nonlinear(d: &Given) -> Option<Law> {
    match d.law {
        DeviceLaw::Viscous => {
            let exponent = d.exponent.filter(|alpha| *alpha < 1.0)?;
            let velocity = d.reference_velocity.map_or(1.0, |v| v.si());
            Some(Law::Power(Power { damping: d.damping?.si(), velocity, exponent }))
        }
        DeviceLaw::Elastic | DeviceLaw::FrictionDamper => None,
        DeviceLaw::BoucWen => {
            let (force, displacement) = yielding(d);
            Some(Law::BoucWen(BoucWen {
                force: (1.0 - d.hardening.unwrap_or(0.0)) * force,
                displacement,
                amplitude: d.amplitude.unwrap_or(1.0),
                beta: d.beta.unwrap_or(BETA),
                gamma: d.gamma.unwrap_or(GAMMA),
                sharpness: d.sharpness.unwrap_or(SHARPNESS),
            }))
        }
        DeviceLaw::ReCentring => {
            let first = d.stiffness?.si();
            Some(Law::ReCentring(ReCentring {
                stiffness: first - d.post_stiffness.map_or(0.0, |k| k.si()),
                activation: d.activation_force?.si() / first,
                flag: d.flag?,
            }))
        }
    }
}

/// (I3) as friction of unit coefficients.
pub(crate) fn rub(joint: usize, d: &Given) -> Option<Rub> {
    let force = d.slip_force.filter(|_| d.law == DeviceLaw::FrictionDamper)?.si();
    let regular = Stribeck {
        static_: 1.0,
        dynamic: 1.0,
        slip_velocity: d.slip_velocity.map_or(SLIP_VELOCITY, |v| v.si()),
        beta: STEEPNESS,
        alpha: 0.0,
    };
    let sticks = d.sticks == Some(true);
    let law = if sticks { Stribeck { beta: f64::INFINITY, slip_velocity: 0.0, ..regular } } else { regular };
    Some(Rub { joint: joint as u32, normal: [force; 2], law })
}

/// The devices of a wall, and what they do beyond a spring, a dashpot and friction; their springs and dashpots into
/// `elastic`.
pub(crate) fn compile(case: &Case, laws: &[JointLaw], elastic: &mut [Elastic]) -> (Vec<Device>, Vec<Nonlinear>) {
    let (mut devices, mut rest) = (Vec::new(), Vec::new());
    for (e, law) in laws.iter().enumerate() {
        let Some(given) = law.device(case) else { continue };
        elastic[e] = self::elastic(given);
        devices.push(Device { joint: e as u32, law: given.law });
        rest.extend(nonlinear(given).map(|law| Nonlinear { joint: e as u32, law }));
    }
    (devices, rest)
}

#[cfg(test)]
mod tests {
    /// Devices that are springs, dashpots and friction share lanes, those with laws of their own do not.
    #[test]
    fn lanes_take_devices_that_are_only_numbers() {
        use crate::case::{Scheme, Syntax, from_str};
        let kind = |device: &str| {
            let text = format!(
                r#"model = "shear"
                set = "report"
                [[panel]]
                bond = "running"
                courses = 3
                bricks = 2
                [[joint.change]]
                at = {{ joints = ["p1c1b1|p1c2b1"] }}
                device = {device}
                [motion]
                duration = 1"#
            );
            let file = from_str(&text, Syntax::Toml, None).unwrap();
            file.validate().unwrap();
            let model = crate::run::prepare_case(file.case.clone(), std::path::Path::new("")).unwrap().model;
            assert_eq!(model.devices.len(), 1);
            concio_shear::lanes::Kind::of(&model.shear, Scheme::TrBdf2)
        };
        let dashpot = kind(r#"{ law = "viscous", damping = 10 }"#);
        assert!(dashpot.is_some() && dashpot == kind(r#"{ law = "elastic", stiffness = 1e6, damping = 3 }"#));
        assert!(kind(r#"{ law = "friction-damper", slip_force = 5 }"#).is_some());
        for own in [
            r#"{ law = "viscous", damping = 10, exponent = 0.5 }"#,
            r#"{ law = "friction-damper", slip_force = 5, sticks = true }"#,
            r#"{ law = "bouc-wen", yield_force = 5, yield_displacement = 1e-3 }"#,
            r#"{ law = "re-centring", stiffness = 1e6, activation_force = 5, flag = 1 }"#,
        ] {
            assert!(kind(own).is_none(), "{own}");
        }
    }
}
