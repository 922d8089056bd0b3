//! Devices that joints take in the place of their mortar: what the wall file says of them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{DampingConstant, Force, ForcePerLength, Length, Velocity};

/// β and γ of (I5) unless given.
pub(crate) const BETA: f64 = 0.5;
/// See [`BETA`].
pub(crate) const GAMMA: f64 = 0.5;

/// A device in the place of the mortar of a joint: a law and the keys of that law. Values are those of the whole joint,
/// whatever its overlap. It acts against the relative displacement of its sides in both directions, also where they
/// would close a head joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// The law.
    pub law: DeviceLaw,
    /// c [N s/m] of a linear dashpot: above 0 of law `viscous`, which needs it; beside `elastic`, `bouc-wen` and
    /// `re-centring` from 0, default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<DampingConstant>,
    /// α of (I1), 0.2 … 1, of law `viscous`: the force grows with the velocity to this power. Default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.2, max = 1.0))]
    pub exponent: Option<f64>,
    /// v_0 of (I1) [m/s], above 0, of law `viscous`: velocity at which the force is c v_0 whatever the exponent. Default
    /// 1 m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_velocity: Option<Velocity>,
    /// k of (I2) [N/m], from 0, of law `elastic`; k_1 of (I6), above 0, of law `re-centring`. Both need it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<ForcePerLength>,
    /// F_s of (I3) [N], above 0, of law `friction-damper`, which needs it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slip_force: Option<Force>,
    /// δ_v of (I3) [m/s], above 0, of law `friction-damper`: a hundredth of it is where F_s is half reached. Default
    /// 1 mm/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slip_velocity: Option<Velocity>,
    /// Whether a `friction-damper` sticks truly, as law `coulomb` of friction does, instead of creeping. Default false.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sticks: Option<bool>,
    /// F_y of (I4) [N], above 0, of law `bouc-wen`, which needs it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_force: Option<Force>,
    /// d_y of (I4) and (I5) [m], above 0, of law `bouc-wen`, which needs it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_displacement: Option<Length>,
    /// a of (I4), 0 … 1, of law `bouc-wen`: part of the stiffness F_y/d_y that stays beyond yielding. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub hardening: Option<f64>,
    /// A of (I5), above 0, of law `bouc-wen`. Default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub amplitude: Option<f64>,
    /// β of (I5), above 0, of law `bouc-wen`. Default 0.5.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub beta: Option<f64>,
    /// γ of (I5), above −β and up to β, of law `bouc-wen`. Default 0.5.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gamma: Option<f64>,
    /// n of (I5), 1 … 100, of law `bouc-wen`: how sharply it yields. Default 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 100.0))]
    pub sharpness: Option<f64>,
    /// F_a of (I6) [N], above 0, of law `re-centring`, which needs it: force at which the stiffness changes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub activation_force: Option<Force>,
    /// k_2 of (I6) [N/m], from 0 to below k_1, of law `re-centring`. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub post_stiffness: Option<ForcePerLength>,
    /// β_f of (I6), 0 … 1, of law `re-centring`, which needs it: height of the flag over F_a. 0 dissipates nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub flag: Option<f64>,
}

/// Laws of devices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DeviceLaw {
    /// A dashpot, linear or with a power of the velocity, equation (I1).
    Viscous,
    /// A spring, with a dashpot if need be, equation (I2).
    Elastic,
    /// Friction at a force that does not depend on the weight carried, equation (I3).
    FrictionDamper,
    /// Smooth hysteresis of Bouc and Wen, equations (I4) and (I5).
    BoucWen,
    /// Flag-shaped: yields, dissipates, and comes back to where it was, equations (I6) and (I7).
    #[serde(rename = "re-centring")]
    ReCentring,
}

impl Device {
    /// A device of a law with none of its keys given.
    pub fn of(law: DeviceLaw) -> Self {
        Device {
            law,
            damping: None,
            exponent: None,
            reference_velocity: None,
            stiffness: None,
            slip_force: None,
            slip_velocity: None,
            sticks: None,
            yield_force: None,
            yield_displacement: None,
            hardening: None,
            amplitude: None,
            beta: None,
            gamma: None,
            sharpness: None,
            activation_force: None,
            post_stiffness: None,
            flag: None,
        }
    }
}

impl DeviceLaw {
    /// All laws.
    pub const ALL: [DeviceLaw; 5] =
        [DeviceLaw::Viscous, DeviceLaw::Elastic, DeviceLaw::FrictionDamper, DeviceLaw::BoucWen, DeviceLaw::ReCentring];

    /// The law of that name, if there is one.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|law| law.name() == name)
    }

    /// The word of the wall file.
    pub fn name(self) -> &'static str {
        match self {
            DeviceLaw::Viscous => "viscous",
            DeviceLaw::Elastic => "elastic",
            DeviceLaw::FrictionDamper => "friction-damper",
            DeviceLaw::BoucWen => "bouc-wen",
            DeviceLaw::ReCentring => "re-centring",
        }
    }
}
