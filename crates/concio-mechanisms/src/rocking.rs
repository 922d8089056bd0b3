//! Time history of a mechanism out of the plane of a wall: one body that turns about its hinge, or a chain of two.
//!
//! One unknown, the turn θ of the lower body, positive outwards; ü_g and v̈_g are the accelerations of the ground outwards and upwards:
//!
//! ```text
//! (OP10)  m*(θ) θ̈ + ½ m*′ θ̇² + (1 + v̈_g/g) U′(θ) − Σ H x′ + Σ T x′ + M_f sgn θ̇ = −ü_g Σ m x′
//!         m* = Σ (m x′² + m_z z′² + I φ′²),  U′ = Σ W z′
//! (OP11)  θ̇ after an impact = r θ̇ before,  r = (v_new·M v_old)/(v_new·M v_new)
//! ```
//!
//! x, z: places of masses and forces outwards and upwards, ′ their derivative after θ; m moves to and fro, m_z = W/g up and down; H: thrusts,
//! T: ties; M_f: friction of side walls and of floors on their seats, the latter with the weight of the instant; v: velocities of the bodies per unit
//! of turn in the mechanism that closes (old) and in the one that opens (new). Against side walls θ ≥ 0 and θ̇ after an impact is −e θ̇ before, e given
//! ([`Restitution`]). One body on a hinge at distance R from its centre of mass, tan α_s = depth over height of that:
//!
//! ```text
//! I_O θ̈ = −W R sin(α_s − θ) + m a_in R cos(α_s − θ) − …,   r = 1 − 1.5 sin²α_s for a rectangle on its base (Housner 1963)
//! ```
//!
//! ```
//! use concio::ground::GroundMotion;
//! use concio_mechanisms::rocking::{Back, Mechanism, Positive, Restitution, Rocking, Setting, Shaking};
//!
//! // A wall of 0.4 m by 4 m, one metre of its length, 20 kN/m³, against side walls.
//! let wall = Mechanism::wall(0.4, 4.0, 1.0, 20e3, Back::SideWalls(Restitution::Block));
//! let wall = Rocking::new(&wall)?;
//! let ground = GroundMotion::sampled(0.3, &[0.0, 2.0, -2.0, 0.0])?;
//! let response = wall.respond(&Shaking::across(&ground, Positive::Inwards), &Setting::default())?;
//! assert!(!response.stop.fell() && response.peak.over_d0 > Some(0.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Limits. Bodies are rigid, hinges are points that neither slide nor crush, joints do not disintegrate; e is chosen, not known. Turn beyond d0 is not
//! collapse: walls come back from there. A run that went through many impacts may be a matter of chance: [`Rocking::repeat`] says so.
//!
//! Sources: G. W. Housner, Bulletin of the Seismological Society of America 53 (1963) 403–417; for walls against side walls L. Sorrentino,
//! O. AlShawa and L. D. Decanini (2011), Earthquake Engineering and Structural Dynamics, whose formula
//! for e ([`block_restitution`]) was not read again in the paper.

mod fall;
mod lift_off;
mod mechanism;
mod motion;
mod pull;
mod repeat;
mod response;
mod shaking;
mod side;
mod state;
mod system;

pub use fall::{Fall, Ladder};
pub use lift_off::LiftOff;
pub use mechanism::{
    Back, Floor, Linkage, Mechanism, Member, Part, Place, Restitution, Rub, Spot, Tie, block_restitution,
};
pub use motion::{Kept, Run, Turned};
pub use repeat::{FACTORS, Repeated, Verdict};
pub use response::{Capacity, Counts, Energies, Event, History, Peak, Response, Stop, TieOutcome, What};
pub use shaking::{Positive, Setting, Shaking};
pub use side::Moved;

use concio_law::G;
use concio_law::error::{InputError, Result};
use system::System;

/// A mechanism that is ready to be shaken.
#[derive(Debug, Clone, PartialEq)]
pub struct Rocking {
    system: System,
}

impl Rocking {
    /// Compiles a mechanism.
    ///
    /// # Errors
    /// A number of the mechanism that is out of its bounds; a wall that does not stand by itself, its ties, and its friction; a restitution that
    /// would give energy.
    pub fn new(mechanism: &Mechanism) -> Result<Self> {
        mechanism.check()?;
        let rocking = Rocking { system: System::new(mechanism) };
        for (side, name) in [(0, "linkage"), (1, "back.inwards")].into_iter().take(rocking.system.sides.len()) {
            let least = rocking.system.lifts_off_at(side);
            if !(least > 0.0) {
                let what = format!("the wall turns under its own loads (α0 = {:.6})", least / G);
                let error = InputError::new(what).key(name).allowed("a mechanism with α0 above 0");
                return Err(error
                    .help("thrusts need the pretension of a tie, and the hinge must lie outside of the loads")
                    .into());
            }
        }
        let most = rocking.system.most_restitution();
        if let Back::Free { restitution: Some(given), .. } = mechanism.back
            && given > most * (1.0 + 1e-12)
        {
            let error = InputError::new(format!("{given}: impacts would give energy")).key("back.restitution");
            return Err(error.allowed(format!("0 … {most:.6}")).help("leave it out for (OP11)").into());
        }
        Ok(rocking)
    }

    /// Multiplier α0 = a/g of the ground's acceleration inwards at which the wall sets off, with friction and the pretension of ties.
    pub fn multiplier(&self) -> f64 {
        self.system.lifts_off_at(0) / G
    }

    /// Static multiplier α(θ) = (Σ W z′ − Σ H x′)/(g Σ m x′) in the position turned outwards by θ [rad], ties and friction left out: 0 at d0. No
    /// number beyond the end of the mechanism.
    pub fn multiplier_at(&self, rotation: f64) -> f64 {
        self.system.multiplier_at(rotation)
    }

    /// d0 outwards: where the weights hold no longer, ties and friction left out; none where they hold at any turn.
    pub fn d0(&self) -> Option<Capacity> {
        self.system.capacity(0)
    }

    /// The same inwards, its displacement negative; none either where the wall does not rock to that side.
    pub fn d0_inwards(&self) -> Option<Capacity> {
        self.system.capacity(1)
    }

    /// Velocity that an impact at the end of a turn outwards leaves over that before: (OP11), or as given.
    pub fn restitution(&self) -> f64 {
        self.system.restitution()
    }

    /// The response to a motion of the ground.
    ///
    /// # Errors
    /// A number of `setting` or `shaking` that is out of its bounds.
    pub fn respond(&self, shaking: &Shaking, setting: &Setting) -> Result<Response> {
        self.run(shaking, setting).map(Run::go)
    }

    /// A run that is taken step by step: what [`Rocking::respond`] goes through.
    ///
    /// # Errors
    /// As [`Rocking::respond`].
    pub fn run<'s>(&'s self, shaking: &Shaking<'s>, setting: &Setting) -> Result<Run<'s>> {
        let end = setting.end(shaking)?;
        self.check_start(setting.start)?;
        Ok(Run::new(&self.system, *shaking, setting, end))
    }

    /// How a point of the wall has moved at θ, θ̇ and θ̈, positive outwards [rad, rad/s, rad/s²].
    pub fn moved(&self, spot: &Spot, turned: [f64; 3]) -> Moved {
        let inwards = turned[0] < 0.0 && self.system.sides.len() > 1;
        let side = &self.system.sides[usize::from(inwards)];
        side.moved(spot, turned.map(|v| side.sign * v))
    }

    /// The responses to a motion as it is and with its sign reversed; thresholds of the two differ.
    ///
    /// # Errors
    /// As [`Rocking::respond`].
    pub fn both_signs(&self, shaking: &Shaking, setting: &Setting) -> Result<[Response; 2]> {
        Ok([self.respond(shaking, setting)?, self.respond(&shaking.reversed(), setting)?])
    }

    /// The least scale of a motion at which the wall first lifts off, by (OP10) at rest; `shaking.scale` does not count. None where no scale lifts it off.
    /// Exact for records; motions in closed form are looked at 400 times in a period. Jumps of the ground's velocity do not count.
    ///
    /// # Errors
    /// As [`Rocking::respond`].
    pub fn first_lift_off(&self, shaking: &Shaking, setting: &Setting) -> Result<Option<LiftOff>> {
        let end = setting.end(shaking)?;
        Ok(self.system.first_lift_off(&Shaking { scale: 1.0, ..*shaking }, end))
    }

    fn check_start(&self, start: [f64; 2]) -> Result<()> {
        let low = self.system.sides.get(1).map_or(0.0, |inwards| -inwards.end);
        let high = self.system.sides[0].end;
        let [rotation, velocity] = start;
        if (low..high).contains(&rotation) && rotation > low.min(-f64::MIN_POSITIVE) && velocity.is_finite() {
            return Ok(());
        }
        let error = InputError::new(format!("a start from {rotation} rad with {velocity} rad/s")).key("start");
        Err(error.allowed(format!("from {low} to below {high} rad")).into())
    }
}
