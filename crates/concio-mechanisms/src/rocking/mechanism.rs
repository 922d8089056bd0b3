//! What rocks, as a user describes it: pieces of wall, floors, ties, friction, and what lies behind the wall.
//!
//! Places are `[x, z]`: depth behind the outer face and height above the base [m]. Outwards is the side to which the wall falls.

use concio_law::error::{InputError, Result};

/// A place on the wall [m]: depth x behind the outer face, height z above the base.
pub type Place = [f64; 2];

/// A mechanism of one body or of a chain of two, with one unknown: the rotation θ of the lower body, positive outwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Mechanism {
    /// Where its hinges are while it turns outwards.
    pub linkage: Linkage,
    /// The masonry that moves; one part or more.
    pub parts: Vec<Part>,
    /// Floors, roofs and what else bears on it.
    pub floors: Vec<Floor>,
    /// Ties that hold it back.
    pub ties: Vec<Tie>,
    /// Forces of friction, such as those of side walls along a crack.
    pub rubs: Vec<Rub>,
    /// Moment of friction about the hinge of the lower body, against the motion [N m]; from 0.
    pub friction_moment: f64,
    /// What the wall meets when it comes back.
    pub back: Back,
    /// Control point, whose displacement is reported.
    pub control: Spot,
}

/// Hinges in the wall at rest. All lie in one vertical plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Linkage {
    /// One body that turns about a hinge.
    One {
        /// The hinge: its depth is the setback a of (OP2), 0 without crushing.
        hinge: Place,
    },
    /// Two bodies, the vertical arch of (OP6): the lower turns about `base`, they meet at `middle`, and `top`, a point of the upper body, is held
    /// along x and free along z.
    Two {
        /// Hinge of the lower body; on the outer face for an arch that bulges outwards.
        base: Place,
        /// Hinge between the bodies; on the inner face for an arch that bulges outwards.
        middle: Place,
        /// Point of the upper body that is held; where N acts.
        top: Place,
    },
}

/// Which body of the chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Member {
    /// The one that turns about a fixed hinge.
    Lower,
    /// The upper one of two.
    Upper,
}

/// A point of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// The body.
    pub member: Member,
    /// Where the point is at rest [m].
    pub at: Place,
}

impl Spot {
    /// A point of the lower, or the only, body.
    pub fn lower(at: Place) -> Self {
        Spot { member: Member::Lower, at }
    }
    /// A point of the upper body.
    pub fn upper(at: Place) -> Self {
        Spot { member: Member::Upper, at }
    }
}

/// A piece of masonry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Its centre of mass.
    pub centre: Spot,
    /// Its weight [N]; above 0.
    pub weight: f64,
    /// Its moment of inertia about the centre of mass [kg m²]; from 0.
    pub inertia: f64,
}

impl Part {
    /// A rectangle between two corners `[x, z]`, `length` along the wall [m], of a weight per volume [N/m³].
    pub fn rectangle(member: Member, low: Place, high: Place, length: f64, specific_weight: f64) -> Self {
        let [t, h] = [high[0] - low[0], high[1] - low[1]];
        let weight = specific_weight * t * h * length;
        let at = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        Part { centre: Spot { member, at }, weight, inertia: weight / concio_law::G * (t * t + h * h) / 12.0 }
    }
}

/// A floor or roof on the wall, P, Q and H of (OP1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// Where its load acts.
    pub at: Spot,
    /// Load P that the wall carries [N]; from 0. Its mass moves up and down with the wall.
    pub load: f64,
    /// Weight of the mass that moves to and fro with the wall [N]; from 0. P + Q of (OP1); 0 for a slab that stays while the wall slides from under it.
    pub pushes: f64,
    /// Thrust H outwards [N]; negative inwards.
    pub thrust: f64,
    /// Friction μ_f between floor and wall, that resists any motion of the wall; from 0. Leave it 0 for a floor that moves with the wall.
    pub friction: f64,
    /// Displacement outwards at which the floor loses its seat [m]; above 0. Load, mass, thrust and friction are gone then.
    pub seat: Option<f64>,
}

impl Floor {
    /// A load that moves with the wall and never loses its seat.
    pub fn carried(at: Spot, load: f64) -> Self {
        Floor { at, load, pushes: load, thrust: 0.0, friction: 0.0, seat: None }
    }
}

/// A horizontal tie. It pulls and never pushes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tie {
    /// Where its plate holds the wall.
    pub at: Spot,
    /// Stiffness k [N/m]; above 0.
    pub stiffness: f64,
    /// Way that its plate goes before it pulls [m]; from 0.
    pub slack: f64,
    /// Pull at rest [N]; from 0, and 0 where there is slack.
    pub pretension: f64,
    /// Force at which it yields [N]; above 0. What it yields stays, as a permanent set.
    pub yield_force: Option<f64>,
    /// Elongation at which it breaks [m], elastic and permanent together, that of the pretension included; above 0.
    pub elongation_at_break: Option<f64>,
}

impl Tie {
    /// An elastic tie without slack that never breaks.
    pub fn elastic(at: Spot, stiffness: f64) -> Self {
        Tie { at, stiffness, slack: 0.0, pretension: 0.0, yield_force: None, elongation_at_break: None }
    }
}

/// A force of friction that acts against the motion of a point along x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rub {
    /// Where it acts.
    pub at: Spot,
    /// The force [N]; from 0.
    pub force: f64,
    /// Displacement of the point, either way, at which the force is lost for good [m]: the overlap of the bricks. Above 0.
    pub overlap: Option<f64>,
}

/// What the wall meets when it comes back to θ = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Back {
    /// Side walls: it rocks to one side only.
    SideWalls(Restitution),
    /// Nothing: it goes on and rocks to both sides.
    Free {
        /// Hinges while it turns inwards.
        inwards: Linkage,
        /// Part of the velocity that an impact leaves, from 0 to 1, and no more than leaves the energy; (OP11) where none is given.
        restitution: Option<f64>,
    },
}

/// Velocity after an impact on side walls over that before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Restitution {
    /// e, from 0 (it stays where it lands) to 1.
    Given(f64),
    /// e = |(1 − 1.5 sin²α_s)² (1 − 1.5 cos²α_s)| of a block (after Sorrentino, AlShawa and Decanini 2011), tan α_s = depth over height of the centre of
    /// mass from the hinge. Of one body only.
    Block,
}

/// e = |(1 − 1.5 sin²α_s)² (1 − 1.5 cos²α_s)| for tan α_s = depth over height of the centre of mass; [`Restitution::Block`].
pub fn block_restitution(slenderness: f64) -> f64 {
    let (sin, cos) = slenderness.sin_cos();
    let base = 1.0 - 1.5 * sin * sin;
    (base * base * (1.0 - 1.5 * cos * cos)).abs()
}

impl Mechanism {
    /// A wall of one body that turns about its outer edge: `thickness`, `height` and `length` [m], weight per volume [N/m³]. Its control point is the
    /// middle of its top.
    pub fn wall(thickness: f64, height: f64, length: f64, specific_weight: f64, back: Back) -> Self {
        Mechanism {
            linkage: Linkage::One { hinge: [0.0, 0.0] },
            parts: vec![Part::rectangle(Member::Lower, [0.0, 0.0], [thickness, height], length, specific_weight)],
            floors: Vec::new(),
            ties: Vec::new(),
            rubs: Vec::new(),
            friction_moment: 0.0,
            back,
            control: Spot::lower([0.5 * thickness, height]),
        }
    }

    /// The vertical arch of (OP6) in a wall of `thickness` and `height` [m] that weighs `weight` [N] and carries `load` [N] at `from_inner_face` [m]: the
    /// middle hinge is `share` of the height above the base, between 0 and 1. Its control point is that hinge.
    pub fn arch(
        [thickness, height]: [f64; 2],
        weight: f64,
        load: f64,
        from_inner_face: f64,
        share: f64,
        back: Back,
    ) -> Self {
        let [t, level] = [thickness, share * height];
        let density = weight / (t * height);
        let top = [t - from_inner_face, height];
        Mechanism {
            linkage: Linkage::Two { base: [0.0, 0.0], middle: [t, level], top },
            parts: vec![
                Part::rectangle(Member::Lower, [0.0, 0.0], [t, level], 1.0, density),
                Part::rectangle(Member::Upper, [0.0, level], [t, height], 1.0, density),
            ],
            floors: if load == 0.0 { Vec::new() } else { vec![Floor::carried(Spot::upper(top), load)] },
            ties: Vec::new(),
            rubs: Vec::new(),
            friction_moment: 0.0,
            back,
            control: Spot::lower([t, level]),
        }
    }

    /// Whether every number is within its bounds, and every point on a body that there is.
    ///
    /// # Errors
    /// The first that is not, by its name, such as `ties[0].stiffness`.
    pub fn check(&self) -> Result<()> {
        self.linkage.check("linkage")?;
        let two = matches!(self.linkage, Linkage::Two { .. });
        let spot = |key: String, spot: &Spot| {
            if spot.member == Member::Upper && !two {
                return refuse(key, "a point of the upper body".into(), "the lower body: there is one only");
            }
            place(key, spot.at)
        };
        if self.parts.is_empty() {
            return refuse("parts".into(), "no part".into(), "1 or more");
        }
        for (i, part) in self.parts.iter().enumerate() {
            spot(format!("parts[{i}].centre"), &part.centre)?;
            above_zero(format!("parts[{i}].weight"), part.weight, "N")?;
            from_zero(format!("parts[{i}].inertia"), part.inertia, "kg m2")?;
        }
        for (i, floor) in self.floors.iter().enumerate() {
            spot(format!("floors[{i}].at"), &floor.at)?;
            from_zero(format!("floors[{i}].load"), floor.load, "N")?;
            from_zero(format!("floors[{i}].pushes"), floor.pushes, "N")?;
            finite(format!("floors[{i}].thrust"), floor.thrust, "N")?;
            from_zero(format!("floors[{i}].friction"), floor.friction, "")?;
            floor.seat.map_or(Ok(()), |seat| above_zero(format!("floors[{i}].seat"), seat, "m"))?;
        }
        for (i, tie) in self.ties.iter().enumerate() {
            spot(format!("ties[{i}].at"), &tie.at)?;
            tie.check(i)?;
        }
        for (i, rub) in self.rubs.iter().enumerate() {
            spot(format!("rubs[{i}].at"), &rub.at)?;
            from_zero(format!("rubs[{i}].force"), rub.force, "N")?;
            rub.overlap.map_or(Ok(()), |overlap| above_zero(format!("rubs[{i}].overlap"), overlap, "m"))?;
        }
        from_zero("friction_moment".into(), self.friction_moment, "N m")?;
        spot("control".into(), &self.control)?;
        self.check_back(two)
    }

    fn check_back(&self, two: bool) -> Result<()> {
        match self.back {
            Back::SideWalls(Restitution::Given(e)) => share("back.restitution", e),
            Back::SideWalls(Restitution::Block) if two => refuse(
                "back.restitution".into(),
                "the formula of a block for a chain of two bodies".into(),
                "a given number from 0 to 1: no formula is known for a chain against side walls",
            ),
            Back::SideWalls(Restitution::Block) => Ok(()),
            Back::Free { inwards, restitution } => {
                inwards.check("back.inwards")?;
                if two != matches!(inwards, Linkage::Two { .. }) {
                    return refuse("back.inwards".into(), "another number of bodies".into(), "that of `linkage`");
                }
                restitution.map_or(Ok(()), |r| share("back.restitution", r))
            }
        }
    }

    /// Depth and height of the centre of mass of the masonry above the outer hinge, as tan⁻¹ of their ratio: α_s.
    pub(super) fn slenderness(&self) -> f64 {
        let (Linkage::One { hinge } | Linkage::Two { base: hinge, .. }) = self.linkage;
        let sum = |axis: usize| self.parts.iter().map(|p| p.weight * (p.centre.at[axis] - hinge[axis])).sum::<f64>();
        sum(0).atan2(sum(1))
    }
}

impl Linkage {
    fn check(&self, key: &str) -> Result<()> {
        match *self {
            Linkage::One { hinge } => place(format!("{key}.hinge"), hinge),
            Linkage::Two { base, middle, top } => {
                for (name, at) in [("base", base), ("middle", middle), ("top", top)] {
                    place(format!("{key}.{name}"), at)?;
                }
                if !(middle[1] > base[1]) {
                    return refuse(
                        format!("{key}.middle"),
                        format!("{} m high", middle[1]),
                        "above the hinge at the base",
                    );
                }
                if !(top[1] > middle[1]) {
                    return refuse(format!("{key}.top"), format!("{} m high", top[1]), "above the hinge in the middle");
                }
                Ok(())
            }
        }
    }
}

impl Tie {
    fn check(&self, i: usize) -> Result<()> {
        let key = |name: &str| format!("ties[{i}].{name}");
        above_zero(key("stiffness"), self.stiffness, "N/m")?;
        from_zero(key("slack"), self.slack, "m")?;
        from_zero(key("pretension"), self.pretension, "N")?;
        if self.slack > 0.0 && self.pretension > 0.0 {
            return refuse(key("pretension"), format!("{} N with slack", self.pretension), "0 where there is slack");
        }
        if let Some(force) = self.yield_force {
            above_zero(key("yield_force"), force, "N")?;
            if self.pretension > force {
                return refuse(
                    key("pretension"),
                    format!("{} N", self.pretension),
                    &format!("up to the yield force {force} N"),
                );
            }
        }
        let Some(most) = self.elongation_at_break else { return Ok(()) };
        above_zero(key("elongation_at_break"), most, "m")?;
        if self.pretension >= most * self.stiffness {
            return refuse(key("elongation_at_break"), format!("{most} m"), "above the elongation by the pretension");
        }
        Ok(())
    }
}

fn refuse(key: String, what: String, allowed: &str) -> Result<()> {
    Err(InputError::new(what).key(key).allowed(allowed).into())
}

fn place(key: String, at: Place) -> Result<()> {
    if at.iter().all(|c| c.is_finite()) { Ok(()) } else { refuse(key, format!("{at:?} m"), "finite") }
}

fn finite(key: String, value: f64, unit: &str) -> Result<()> {
    if value.is_finite() { Ok(()) } else { refuse(key, format!("{value} {unit}").trim_end().into(), "finite") }
}

fn above_zero(key: String, value: f64, unit: &str) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        refuse(key, format!("{value} {unit}").trim_end().into(), "above 0")
    }
}

fn from_zero(key: String, value: f64, unit: &str) -> Result<()> {
    if value >= 0.0 && value.is_finite() {
        Ok(())
    } else {
        refuse(key, format!("{value} {unit}").trim_end().into(), "from 0")
    }
}

fn share(key: &str, value: f64) -> Result<()> {
    if (0.0..=1.0).contains(&value) { Ok(()) } else { refuse(key.into(), format!("{value}"), "0 … 1") }
}
