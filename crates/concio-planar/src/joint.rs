//! What a joint bears at its contact points during one step: springs, dashpots, friction, bond, crushing.
//!
//! A rigid joint has two points, its ends. A compliant one has those of its zones ([`crate::crack`]), or if all of it
//! pulls three: its ends and its middle, with a sixth, two thirds and a sixth of its length, which gives a layer of springs its stiffness against parting and against
//! turning. Over a step the stretch g of a spring goes on with the mean of the velocities at its ends, and its
//! force is that of g_0 + θ (g_1 − g_0):
//!
//! (P6)  θ = ½ + min(½ x²/(1 + x²), ζ/(2 x)),   x = h ω/4,   ω² = k/m,   ζ = ⅛
//!
//! where a spring lets go, in compression only or in line with friction, k being the stiffness of the whole joint and m the mass that the
//! point moves. A stiff joint that rings faster than the step resolves is damped at a ratio of ζ at most, however many points it has:
//! more would damp the wall's own modes, which are slower, with it. A spring that closes during the step takes θ = 1: any
//! less would make energy. What θ takes counts as lost in impacts, of a point that slides as friction. Springs in both directions take
//! the midpoint, θ = ½, which keeps energy whatever the step: the modes of a mortared wall are slower than its joints alone, and
//! would be damped with them.

use concio_law::device;
use concio_law::friction::Stribeck;
use serde::{Deserialize, Serialize};

use crate::G;
use crate::contact::{Contact, Linear, Status};

/// Law of a joint. Stiffnesses, dashpots and strengths are those of its whole length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// How the joint bears pressure, and tension.
    pub normal: Normal,
    /// How it bears shear beside friction.
    pub shear: Shear,
    /// Friction under the pressure of the moment.
    pub friction: Option<Friction>,
    /// What holds it until it cracks.
    pub bond: Option<Bond>,
    /// Pressure at which it is crushed [N]; infinite where it is not. Of joints with springs alone that do not pull once their bond is gone.
    pub crushing: f64,
    /// Force at which it yields across and along, whatever the pressure, as a friction damper does [N]; 0 for none.
    pub slip: [f64; 2],
    /// A device with a law of its own.
    pub device: Option<Device>,
    /// Whether its stretch across goes on with the motion, whatever edges of the blocks face each other, as that of a device does.
    pub follows: bool,
}

/// A device whose force is no straight line, in one direction of a joint beside all else that it bears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Device {
    /// 0 across, 1 along.
    pub direction: usize,
    /// Its law, of the whole joint.
    pub law: device::Law,
}

/// What a device bears over a step where the velocity at its end is some one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Borne {
    /// Impulse [N s].
    pub impulse: f64,
    /// By how much it falls as that velocity rises, and how fast no line has to fall for iterations not to go round in circles [kg].
    pub rho: f64,
    pub steepest: f64,
}

/// Normal direction of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Normal {
    /// Parts freely and never overlaps.
    Rigid {
        /// e of impacts, 0 … 1.
        restitution: f64,
        /// η of (P8), 0 … 1: what is left at most of the velocity with which it turns as it rocks from one end to the other; 1 where
        /// that is what the impact itself leaves.
        rocking: f64,
    },
    /// Springs and a dashpot.
    Springs {
        /// In both directions [N/m], until the bond cracks; without bond for good.
        both: f64,
        /// In compression only, besides [N/m].
        press: f64,
        /// Dashpot [N s/m], which acts where a spring does.
        damping: f64,
    },
}

/// Shear of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shear {
    /// Spring [N/m].
    pub stiffness: f64,
    /// Dashpot beside it [N s/m].
    pub damping: f64,
    /// Whether the spring bears no more than friction allows, as a dry joint's roughness does; otherwise it acts beside
    /// friction, as mortar does (the shear model's equation (2)).
    pub series: bool,
}

/// Dry friction that sticks truly up to μ_s, in slip (6) without its first factor: the shear model's (6b), and (6a) where
/// δ_v is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// μ_s.
    pub static_: f64,
    /// μ_d.
    pub dynamic: f64,
    /// δ_v [m/s].
    pub slip_velocity: f64,
    /// α [s²/m²].
    pub alpha: f64,
}

impl Friction {
    /// Coulomb's law with one μ.
    pub fn coulomb(mu: f64) -> Self {
        Friction { static_: mu, dynamic: mu, slip_velocity: 0.0, alpha: 0.0 }
    }

    /// μ of a slide without inertia, as slow as can be: that at rest, or of one that has no δ_v μ_d once it has slid.
    pub fn slowly(&self, slid: bool) -> f64 {
        if slid && self.slip_velocity == 0.0 { self.dynamic } else { self.static_ }
    }

    /// μ that acts in a step: at the speed of sliding [m/s], or without inertia (`still`), where a speed means no more than that it has slid.
    pub(crate) fn of(&self, speed: f64, still: bool) -> f64 {
        if still { self.slowly(speed > 0.0) } else { self.at(speed) }
    }

    /// μ at the speed of sliding [m/s]; 0 where it sticks.
    pub fn at(&self, speed: f64) -> f64 {
        if speed == 0.0 {
            return self.static_;
        }
        Stribeck {
            beta: f64::INFINITY,
            static_: self.static_,
            dynamic: self.dynamic,
            slip_velocity: self.slip_velocity,
            alpha: self.alpha,
        }
        .in_slip(speed)
        .0
    }
}

/// Bond of a joint by tension cut-off and Mohr and Coulomb, brittle or softening exponentially (P9).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bond {
    /// f_t A [N].
    pub tension: f64,
    /// c A [N].
    pub cohesion: f64,
    /// tan φ.
    pub tan_angle: f64,
    /// G_f A of opening and of shear [J]; 0 where it is brittle.
    pub energy: [f64; 2],
    /// η: part of the shear stiffness that stays.
    pub residual: f64,
}

impl Bond {
    /// What tension takes from the strength along, over that tension (P9): tan φ, c/f_t at most.
    pub(crate) fn tan_pulled(&self) -> f64 {
        if self.tension > 0.0 { self.tan_angle.min((1.0 - ROUNDING) * self.cohesion / self.tension) } else { 0.0 }
    }
}

/// ζ of (P6): ratio at which a joint that rings faster than the step resolves is damped at most.
const RINGING: f64 = 0.125;
/// h ω up to which (P6) damps what rings by less than ζ: 4 x where x³ = ζ (1 + x²).
pub const RESOLVED: f64 = 2.18;
/// Speed over that which gravity gives in a step up to which a point rests.
pub(crate) const RESTING: f64 = 1e-5;
/// Part of the strength along that is left at f_t at least.
const ROUNDING: f64 = 1e-6;
/// What presses a point counts by this much of its mass, with inertia. With all of it, walls that rock take a third more iterations; with none, small bricks under 20 MPa
/// lose a sixth of their friction work. Without inertia all counts: with a tenth, walls that tilt leave steps unsolved.
const LOADED: f64 = 0.1;
/// Distance up to which sides touch [m]: more than positions are rounded by.
const TOUCHING: f64 = 1e-12;

impl Law {
    /// Dry and rigid, plastic in impacts.
    pub fn dry(friction: Option<Friction>) -> Self {
        Law {
            normal: Normal::Rigid { restitution: 0.0, rocking: 1.0 },
            shear: Shear { stiffness: 0.0, damping: 0.0, series: false },
            friction,
            bond: None,
            crushing: f64::INFINITY,
            slip: [0.0; 2],
            device: None,
            follows: false,
        }
    }

    /// Whether it has a spring, and so more points than its ends.
    pub fn is_compliant(&self) -> bool {
        matches!(self.normal, Normal::Springs { .. })
    }

    /// Whether its force may fall at once: as a bond breaks, or as friction at rest is overcome.
    pub(crate) fn is_sudden(&self) -> bool {
        let falls = self.friction.is_some_and(|friction| friction.slowly(true) < friction.static_);
        falls || self.bond.is_some()
    }

    /// Whether its friction at rest is some other than that of motion.
    pub(crate) fn eases(&self) -> bool {
        self.friction.is_some_and(|friction| friction.static_ != friction.dynamic)
    }

    /// Stiffness across of the joint while it is pressed [N/m]; 0 of a rigid one.
    pub fn normal_stiffness(&self) -> f64 {
        let (both, press) = self.springs();
        both + press
    }

    /// Whether it returns a part of the velocity with which it closes.
    pub(crate) fn rebounds(&self) -> bool {
        matches!(self.normal, Normal::Rigid { restitution, .. } if restitution > 0.0)
    }

    /// η of (P8) where it loses more than an impact takes as it rocks.
    pub(crate) fn rocking(&self) -> Option<f64> {
        let Normal::Rigid { rocking, .. } = self.normal else { return None };
        (rocking < 1.0).then_some(rocking)
    }

    /// Stiffness along of its bond that breaking takes [N/m].
    pub(crate) fn breaking_stiffness(&self) -> f64 {
        (1.0 - self.bond.map_or(0.0, |bond| bond.residual)) * self.shear.stiffness
    }

    /// What its bond bears along under a pressure at most [N], and what friction goes on to bear of that once it breaks.
    pub(crate) fn shear_strengths(&self, pressure: f64) -> [f64; 2] {
        let of = |bond: Bond| (1.0 - bond.residual) * (bond.cohesion + pressure * bond.tan_angle);
        let strength = self.bond.map_or(0.0, of);
        [strength, (self.slow_friction() * pressure).min(strength)]
    }

    /// Whether its bond alone holds it: rigid points of such a joint yield alike, however much presses them.
    pub(crate) fn holds(&self) -> bool {
        self.bond.is_some() && !self.is_compliant()
    }

    /// Slide that would bear along what an opening `w` of an intact bond takes from its strength there, as (P9) says [m].
    pub(crate) fn pulled(&self, w: f64) -> f64 {
        let (both, _) = self.springs();
        let tan = self.bond.map_or(0.0, |bond| bond.tan_pulled());
        let opened = (w - TOUCHING).max(0.0);
        if self.shear.stiffness == 0.0 { 0.0 } else { tan * both * opened / self.shear.stiffness }
    }

    /// Slide that asks of an intact bond what an opening and a slide do together [m].
    pub(crate) fn sheared(&self, [w, s]: [f64; 2]) -> f64 {
        s.abs() + self.pulled(w)
    }

    /// μ of a slide that is as slow as can be; 0 where nothing rubs.
    pub(crate) fn slow_friction(&self) -> f64 {
        self.friction.map_or(0.0, |friction| friction.slowly(true))
    }

    /// Places of its points that stay where they are, 0 … 1 along the joint, and the part of it that each stands for.
    pub fn points(&self) -> &'static [[f64; 2]] {
        match self.is_compliant() {
            true => &[[0.0, 1.0 / 6.0], [0.5, 2.0 / 3.0], [1.0, 1.0 / 6.0]],
            false => &[[0.0, 0.5], [1.0, 0.5]],
        }
    }

    /// The joint once its bond has cracked through; itself where it has none.
    pub fn cracked(&self) -> Law {
        if self.bond.is_some() { self.part(Part::Dry) } else { *self }
    }

    /// What a part of a bonded joint bears, the whole of it being such a part.
    pub(crate) fn part(&self, part: Part) -> Law {
        let Law { normal, shear, bond, .. } = *self;
        let residual = bond.map_or(0.0, |bond| bond.residual);
        let scaled = |factor: f64, series: bool| Shear {
            stiffness: factor * shear.stiffness,
            damping: factor * shear.damping,
            series,
        };
        let Normal::Springs { both, press, damping } = normal else {
            // Without springs the bond is rigid too.
            return if part == Part::Dry { Law { bond: None, ..*self } } else { *self };
        };
        let springs = |both: f64, press: f64, damping: f64| Normal::Springs { both, press, damping };
        let dry = Law { bond: None, ..*self };
        match part {
            Part::Whole => *self,
            Part::Held => Law {
                normal: springs(both, 0.0, damping),
                shear: scaled(1.0 - residual, false),
                crushing: f64::INFINITY,
                follows: true,
                ..dry
            },
            Part::Dry => {
                Law { normal: springs(0.0, both + press, damping), shear: scaled(1.0 - residual, true), ..dry }
            }
            Part::Stays => Law {
                normal: springs(0.0, 0.0, 0.0),
                shear: scaled(residual, false),
                friction: None,
                crushing: f64::INFINITY,
                follows: true,
                ..dry
            },
        }
    }

    /// Springs: in both directions, and in compression only.
    pub(crate) fn springs(&self) -> (f64, f64) {
        match self.normal {
            Normal::Rigid { .. } => (0.0, 0.0),
            Normal::Springs { both, press, .. } => (both, press),
        }
    }

    /// Whether its springs act in compression only.
    pub(crate) fn only_presses(&self) -> bool {
        self.is_compliant() && self.springs().0 == 0.0 && self.device.is_none()
    }

    /// Whether its points stand for zones that move along it without bond, as springs that only press let go of what opens.
    pub(crate) fn has_zones(&self) -> bool {
        self.only_presses() && self.normal_stiffness() > 0.0 && !self.follows && self.slip == [0.0; 2]
    }

    /// Lets go what a point keeps in springs that act only where its sides face each other, which they do no more; returns that [J].
    pub(crate) fn let_go(&self, point: &mut Point, share: f64) -> f64 {
        if !self.in_line() {
            point.bearing = 0.0;
        }
        if !self.only_presses() || self.follows {
            return 0.0;
        }
        let (_, press) = self.springs();
        let pressed = 0.5 * share * press * (point.gap + point.crushed).min(0.0).powi(2);
        let k = share * self.shear.stiffness;
        let sheared = if self.in_line() { 0.5 * point.bearing * point.bearing / k } else { 0.0 };
        (point.gap, point.bearing) = (0.0, 0.0);
        pressed + sheared
    }

    /// Dashpot across [N s/m]; 0 of a rigid joint.
    pub(crate) fn normal_damping(&self) -> f64 {
        if let Normal::Springs { damping, .. } = self.normal { damping } else { 0.0 }
    }

    /// Shear spring beside friction.
    fn mortar(&self) -> f64 {
        if self.shear.series { 0.0 } else { self.shear.stiffness }
    }

    /// Dashpot beside it: a damper has one without a spring.
    fn mortar_damping(&self) -> f64 {
        if self.shear.series { 0.0 } else { self.shear.damping }
    }

    /// Whether the normal dashpot acts in both directions; otherwise where the joint is pressed.
    fn damps_both(&self) -> bool {
        let (both, press) = self.springs();
        both > 0.0 || press == 0.0
    }

    /// Stiffness and dashpot across and along [N/m, N s/m], of the whole joint, while it is pressed or not and sticks.
    pub fn tangent(&self, pressed: bool) -> [[f64; 2]; 2] {
        let (both, press) = self.springs();
        let bears = pressed || self.damps_both();
        let across = [both + if pressed { press } else { 0.0 }, if bears { self.normal_damping() } else { 0.0 }];
        let along = match self.in_line() {
            true if pressed => [self.shear.stiffness, self.shear.damping],
            true => [0.0; 2],
            false => [self.mortar(), self.mortar_damping()],
        };
        let mut both = [across, along];
        if let Some(Device { direction, law }) = self.device {
            both[direction][0] += law.initial_stiffness();
        }
        both
    }

    /// Whether the shear spring is in line with friction.
    pub(crate) fn in_line(&self) -> bool {
        self.shear.series && self.shear.stiffness > 0.0
    }
}

/// What a point of a bonded joint stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Part {
    /// The joint as it is, without bond.
    Whole,
    /// What is left of the bond.
    Held,
    /// What has cracked.
    Dry,
    /// The spring that stays beside friction.
    Stays,
}

/// What has become of a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Forces of the last step [N].
    pub force: [f64; 2],
    /// Way that it has slid, along the tangent [m].
    pub slide: f64,
    /// What a spring in line with friction bears, along the tangent [N].
    pub bearing: f64,
    /// Speed of sliding [m/s]; 0 where it sticks.
    pub speed: f64,
    /// Crushed off [m].
    pub crushed: f64,
    /// Internal variable of a device, ζ of (I5) or s [m] of (I7).
    pub internal: f64,
    /// The part of its friction that acts: less than 1 where a bond holds, more where it rubs for an edge beside it.
    pub rubbing: f64,
    /// The part of its dashpot across that acts, 0 or 1: none where it stands for what is open of a joint that can be crushed.
    pub damps: f64,
    /// Distance of the two sides [m].
    pub gap: f64,
    /// Parting velocity before it landed in the last step, which left what closed it; 0 of one that did not [m/s].
    pub approach: f64,
}

impl Default for Point {
    fn default() -> Self {
        Point {
            force: [0.0; 2],
            slide: 0.0,
            bearing: 0.0,
            speed: 0.0,
            crushed: 0.0,
            internal: 0.0,
            rubbing: 1.0,
            damps: 1.0,
            gap: 0.0,
            approach: 0.0,
        }
    }
}

/// A contact point at the start of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Start {
    /// Distance [m].
    pub gap: f64,
    /// Parting and sliding velocity [m/s].
    pub velocity: [f64; 2],
    /// Whether inertia is left out.
    pub still: bool,
    /// Whether the distance is greater than that of the end of the last step, because other edges face each other: what springs kept is lost.
    pub slipped: bool,
    /// Whether it is an edge of what crushes, which no strength limits.
    pub edge: bool,
}

/// The normal direction of a point over a step: its mean velocity, distances at the ends, impulses of (P4) and of springs.
struct Across {
    h: f64,
    mean: f64,
    gaps: [f64; 2],
    slipped: bool,
    edge: bool,
    pressed: f64,
    linear: f64,
}

/// Whether a contact slid in a step of `h` [s], faster than what rests does, with `after` at its end [m/s].
pub(crate) fn slides(contact: &Contact, after: f64, h: f64) -> bool {
    matches!(contact.status, Status::Forth | Status::Back) && after.abs() > RESTING * G * h
}

/// Where the energy at a point went during a step [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Works {
    /// Stored at the end.
    pub elastic: f64,
    /// To dashpots.
    pub damping: f64,
    /// To friction.
    pub friction: f64,
    /// To impacts, to joints that close or ring faster than the step resolves, and what springs lose where their sides slip off each other.
    pub impact: f64,
    /// To the breaking of bonds and to crushing.
    pub bond: f64,
    /// To the hysteresis of devices.
    pub device: f64,
    /// Way slid [m].
    pub slip: f64,
}

impl Law {
    /// Makes a contact one of this law: `share` is the part of the joint that it stands for, `h` the step [s], `gap` and
    /// `velocity` the state at its start. Without inertia (`still`) springs are those of the end of the step. Where nothing else yields, `firm` is ρ of (P4) over the
    /// `mass` that its point moves, or has its share of where it holds [kg].
    pub fn begin(
        &self,
        point: &Point,
        share: f64,
        h: f64,
        (still, firm, mass): (bool, f64, f64),
        (gap, velocity): (f64, [f64; 2]),
        contact: &mut Contact,
    ) -> Start {
        let [u_n, u_t] = velocity;
        // `k` of the whole joint: points that each took their own would add up to more than ζ.
        let theta = |k: f64, m: f64| {
            let square = 0.0625 * h * h * k / m;
            if still { 1.0 } else { 0.5 + (0.5 * square / (1.0 + square)).min(0.5 * RINGING / square.sqrt()) }
        };
        let (both, press) = self.springs();
        let resolved = theta(both + press, contact.moved[0]);
        let (both, press, dashpot) = (share * both, share * press, point.damps * share * self.normal_damping());
        let midpoint = if still { 1.0 } else { 0.5 };
        let theta_press = if gap + point.crushed > TOUCHING { 1.0 } else { resolved };
        // A spring of `k` stretched by `g` with a dashpot of `c`.
        let over = |k: f64, c: f64, g: f64, u: f64, theta: f64| Linear {
            offset: -h * (k * (g + 0.5 * theta * h * u) + 0.5 * c * u),
            rho: 0.5 * h * (k * theta * h + c),
        };
        // ρ of what has no spring, both ways by the mass that moves across, or what of that whose weight presses it counts [kg]: along, stiffer ones take more
        // iterations.
        let pressed = point.force[0].max(-(both + press) * (gap + point.crushed));
        let loaded = if self.holds() { 0.0 } else { pressed / G };
        let resists = firm * mass.max(if still { 1.0 } else { LOADED } * loaded);
        match self.normal {
            Normal::Rigid { restitution, .. } => {
                contact.law[0] = Linear { offset: h * point.force[0], rho: resists };
                // Open: what is left of the gap may be closed by the end of the step. It rebounds in the next one, with the velocity of before.
                let left = open(gap, u_n, h);
                // A bond that yields does not pull until nothing is left of that.
                let holds = self.bond.is_some_and(|bond| bond.tension > 0.0);
                contact.bias = if left > 0.0 && point.approach == 0.0 && !holds {
                    2.0 * left / h
                } else {
                    restitution * u_n.min(point.approach).min(0.0)
                };
                if let Some(bond) = &self.bond {
                    contact.pressure[0] = -share * bond.tension * h;
                }
            }
            Normal::Springs { .. } => {
                let beside = if self.damps_both() { dashpot } else { 0.0 };
                contact.spring[0] = over(both, beside, gap + point.crushed, u_n, midpoint);
                contact.law[0] = over(press, dashpot - beside, gap + point.crushed, u_n, theta_press);
            }
        }
        contact.pressure[1] = share * self.crushing * h;
        let [across, along] = self.slip.map(|force| share * force * h);
        if across > 0.0 {
            // Beside springs of its own a damper takes the place of those in compression.
            contact.pressure = [-across, across];
            contact.law[0] = Linear { offset: h * point.force[0], rho: resists };
        }
        let shear = share * self.shear.stiffness;
        if self.in_line() {
            let line = over(shear, share * self.shear.damping, 0.0, u_t, theta(self.shear.stiffness, contact.moved[1]));
            contact.law[1] = Linear { offset: line.offset + h * point.bearing, rho: line.rho };
        } else {
            contact.law[1] = Linear { offset: h * point.bearing, rho: resists };
            if still {
                contact.tight = firm;
            }
            let mortar = share * self.mortar();
            let damping = share * self.mortar_damping();
            contact.spring[1] = over(mortar, damping, point.slide, u_t, midpoint);
        }
        contact.hold = along;
        contact.friction = point.rubbing * self.friction.map_or(0.0, |friction| friction.of(point.speed, still));
        if let Some(bond) = &self.bond {
            (contact.friction, contact.hold) = (bond.tan_angle, share * bond.cohesion * h);
            // Solved so closely that no slide is taken for sticking: it must be seen to break.
            if still && !self.is_compliant() {
                contact.tight = contact.tight.max(0.5 * firm);
            }
        }
        Start { gap, velocity, still, slipped: false, edge: false }
    }

    /// What a device bears at a point over a step of `h` [s] where the velocity at its end is `after` [m/s].
    pub(crate) fn borne(
        &self,
        device: &Device,
        (point, share): (&Point, f64),
        h: f64,
        start: &Start,
        after: f64,
    ) -> Borne {
        let mean = 0.5 * (start.velocity[device.direction] + after);
        let stride = device.law.over([stretch(device, point, start), point.internal], mean, h);
        let ([force, slope], ends) = if start.still { (stride.end, 2.0) } else { (stride.mean, 1.0) };
        let steepest = ends * device.law.steepest(mean, h);
        let rho = |slope: f64| 0.5 * h * share * slope;
        Borne { impulse: -h * share * force, rho: rho(slope.max(0.0).min(steepest)), steepest: rho(steepest) }
    }

    /// What a step of `h` [s] came to, `after` being the velocity at its end.
    pub fn end(
        &self,
        point: &mut Point,
        share: f64,
        h: f64,
        start: &Start,
        after: [f64; 2],
        contact: &Contact,
    ) -> Works {
        let mean = [0, 1].map(|k| 0.5 * (start.velocity[k] + after[k]));
        let gap = start.gap + h * mean[0];
        let mut works = Works::default();
        let linear = [0, 1].map(|k| contact.spring[k].offset - contact.spring[k].rho * after[k]);
        let compressed = (contact.impulse[0] + linear[0]) / h;
        let normal = Across {
            h,
            mean: mean[0],
            gaps: [start.gap, gap],
            slipped: start.slipped,
            edge: start.edge,
            pressed: contact.impulse[0],
            linear: linear[0],
        };
        if let Some(device) = &self.device {
            let from = stretch(device, point, start);
            let way = mean[device.direction];
            let stride = device.law.over([from, point.internal], way, h);
            let stored = |d: f64, internal: f64| share * device.law.stored(d, internal);
            let after = stored(from + h * way, stride.internal);
            let lost = share * stride.lost;
            works.elastic += after;
            *if device.law.is_viscous() { &mut works.damping } else { &mut works.device } += lost;
            works.impact -= after - stored(from, point.internal) + lost;
            point.internal = stride.internal;
        }
        let lands = self.rebounds()
            && point.approach == 0.0
            && contact.impulse[0] > 0.0
            && open(start.gap, start.velocity[0], h) > 0.0;
        point.approach = if lands { start.velocity[0].min(0.0) } else { 0.0 };
        self.end_normal(point, share, normal, &mut works);
        self.end_shear(point, share, h, mean[1], (contact, linear[1]), &mut works);
        point.force = contact.impulse.map(|p| p / h);
        point.gap = gap;
        // What hardly moves rests: what is left of a velocity that was taken away counts as none.
        let slides = slides(contact, after[1], h);
        // Without inertia what has slid goes on to count as sliding: its speed means nothing.
        let rests = if start.still { point.speed } else { 0.0 };
        point.speed = if slides { after[1].abs() } else { rests };
        // Where nothing rubs all that moves under pressure slides.
        let free = contact.friction == 0.0 && contact.hold == 0.0 && compressed > 0.0;
        works.slip = if slides || free { h * mean[1].abs() } else { 0.0 };
        // Where a slide turns round in an impact, friction against its end pushes along its mean: part of what the impact takes.
        if works.friction < 0.0 {
            works.impact += std::mem::take(&mut works.friction);
        }
        works
    }

    fn end_normal(
        &self,
        point: &mut Point,
        share: f64,
        Across { h, mean, gaps: [start, gap], slipped, edge, pressed, linear }: Across,
        works: &mut Works,
    ) {
        let Normal::Springs { .. } = self.normal else {
            works.impact -= pressed * mean;
            return;
        };
        let (both, press) = self.springs();
        let (both, press, dashpot) = (share * both, share * press, point.damps * share * self.normal_damping());
        if self.slip[0] > 0.0 {
            works.friction -= pressed * mean;
        }
        let pressed = if self.slip[0] > 0.0 { 0.0 } else { pressed };
        let stored =
            |g: f64, crushed: f64| 0.5 * both * (g + crushed).powi(2) + 0.5 * press * (g + crushed).min(0.0).powi(2);
        let before = stored(start, point.crushed);
        if slipped {
            works.impact += stored(point.gap, point.crushed) - before;
        }
        let mut after = stored(gap, point.crushed);
        let (all, most) = (both + press, share * self.crushing);
        if !edge && all > 0.0 && -all * (gap + point.crushed) > most {
            let further = -gap - most / all - point.crushed;
            point.crushed += further;
            works.bond += most * further;
            after = 0.5 * most * most / all;
        }
        // What springs do not keep and breaking does not take. A dashpot in compression only acts in the part of a step in which the sides
        // touch, and within the strength.
        let lost = -(pressed + linear) * mean - (after - before) - works.bond;
        let full = dashpot * mean * mean * h;
        let damping = match self.damps_both() {
            true => full,
            false if pressed != 0.0 => full.min(lost.max(0.0)),
            false => 0.0,
        };
        works.elastic += after;
        works.damping += damping;
        works.impact += lost - damping;
    }

    fn end_shear(
        &self,
        point: &mut Point,
        share: f64,
        h: f64,
        mean: f64,
        (contact, linear): (&Contact, f64),
        works: &mut Works,
    ) {
        let borne = contact.impulse[1];
        // Where friction may bear nothing, what does not slide bears nothing either.
        let slides = contact.status != Status::Stick || borne == 0.0;
        if self.in_line() {
            let k = share * self.shear.stiffness;
            let before = point.bearing;
            let limit = borne.abs() / h;
            let free = before - k * h * mean;
            point.bearing = if slides { free.clamp(-limit, limit) } else { free };
            let damping = if slides { 0.0 } else { share * self.shear.damping * mean * mean * h };
            let stored = 0.5 * point.bearing * point.bearing / k;
            works.elastic += stored;
            works.damping += damping;
            let lost = -borne * mean - (stored - 0.5 * before * before / k) - damping;
            *if slides { &mut works.friction } else { &mut works.impact } += lost;
        } else {
            point.bearing = borne / h;
            *if slides { &mut works.friction } else { &mut works.impact } -= borne * mean;
        }
        let mortar = share * self.mortar();
        let damping = share * self.mortar_damping() * mean * mean * h;
        let before = 0.5 * mortar * point.slide * point.slide;
        point.slide += h * mean;
        let stored = 0.5 * mortar * point.slide * point.slide;
        works.elastic += stored;
        works.damping += damping;
        works.impact += -linear * mean - (stored - before) - damping;
    }
}

/// What is left of a gap in the middle of a step of `h` [s] that begins with the parting velocity `u` [m], above 0 where it is open.
fn open(gap: f64, u: f64, h: f64) -> f64 {
    gap + 0.5 * h * u
}

/// How far a device is stretched at the start of a step [m].
fn stretch(device: &Device, point: &Point, start: &Start) -> f64 {
    if device.direction == 0 { start.gap } else { point.slide }
}
