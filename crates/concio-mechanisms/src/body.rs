//! One body that turns about a line: virtual work, its multiplier, and the same in the displaced shape.
//!
//! (OP1) α0 = [ Σ P δ_Py − Σ F δ_F + L_i ] / Σ (P + Q) δ_PQx
//!
//! Source: Circolare, (C8.7.1.1). δ are the velocities of the mechanism: δ_Py upwards, δ_PQx outwards, δ_F along a force that helps. L_i is
//! the work that ties and friction take. For a body that has turned by θ about a line in the plane of the wall, at ϑ from the vertical, a
//! point at depth x behind the line and at height z over it, in the plane of the wall, has
//!
//! δ_PQx = z cos θ + x sin θ, δ_Py = sin ϑ (x cos θ − z sin θ).
//!
//! Overturning has ϑ = 90°; oblique hinges have less (OP8).

/// A weight on a body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Weight {
    /// P [N]: weight that the body carries, from 0. An opening may take some away: below 0.
    pub carried: f64,
    /// Q [N]: weight of mass that pushes the body but rests elsewhere, from 0.
    pub pushing: f64,
    /// x [m]: depth behind the hinge, positive inwards.
    pub depth: f64,
    /// z [m]: distance from the hinge in the plane of the wall, upwards for a level hinge.
    pub height: f64,
}

/// A horizontal force on a body, perpendicular to the wall, that keeps its direction and its point of the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thrust {
    /// H [N], positive outwards: it helps the mechanism.
    pub force: f64,
    /// Depth behind the hinge [m].
    pub depth: f64,
    /// Distance from the hinge in the plane of the wall [m].
    pub height: f64,
}

/// What holds a body back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// Largest force [N], from 0; towards the inside.
    pub force: f64,
    /// Depth behind the hinge [m].
    pub depth: f64,
    /// Distance from the hinge in the plane of the wall [m].
    pub height: f64,
    /// How the force comes and goes.
    pub law: HoldLaw,
}

/// How the force of a [`Hold`] depends on the outward displacement of its point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HoldLaw {
    /// A tie: 0 up to the slack [m], then with its stiffness [N/m] up to its force; gone from `breaks` [m] on.
    Tie {
        /// Stiffness [N/m], above 0; none: rigid.
        stiffness: Option<f64>,
        /// Displacement at which it begins to bear [m], from 0.
        slack: f64,
        /// Displacement at which it breaks [m], above 0; none: it does not.
        breaks: Option<f64>,
    },
    /// Friction: its force at once, gone from this displacement [m] on, where the surfaces have left each other.
    Friction {
        /// Displacement [m], above 0; none: unknown, and it stays.
        until: Option<f64>,
    },
}

/// A force in the plane of the wall on the inner edge of a vertical crack, which a flap pushes away as it turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Press {
    /// H [N], from 0.
    pub force: f64,
    /// Depth of the edge behind the hinge [m].
    pub depth: f64,
    /// Mean distance of the crack from the hinge in the plane of the wall [m].
    pub height: f64,
}

/// A body with all that acts on it, by lever arms from its hinge.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// ϑ [rad], from 0 to π/2: angle of the hinge from the vertical; π/2 is a level hinge.
    pub hinge_angle: f64,
    /// Weights.
    pub weights: Vec<Weight>,
    /// Thrusts.
    pub thrusts: Vec<Thrust>,
    /// Ties and friction.
    pub holds: Vec<Hold>,
    /// Forces on cracks.
    pub presses: Vec<Press>,
}

/// What makes up α0; the sum of all is α0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shares {
    /// The wall's own weight.
    pub wall: f64,
    /// Floors, roof, wedges of side walls.
    pub loads: f64,
    /// Thrusts, which take away.
    pub thrusts: f64,
    /// Ties and connections.
    pub ties: f64,
    /// Friction of seats and overlaps.
    pub friction: f64,
    /// Forces on cracks.
    pub presses: f64,
}

impl Default for Body {
    fn default() -> Self {
        let (weights, thrusts, holds, presses) = Default::default();
        Body { hinge_angle: std::f64::consts::FRAC_PI_2, weights, thrusts, holds, presses }
    }
}

impl Hold {
    /// The force at an outward displacement [m] of its point.
    pub fn at(&self, displacement: f64) -> f64 {
        match self.law {
            HoldLaw::Tie { breaks: Some(most), .. } | HoldLaw::Friction { until: Some(most) }
                if displacement >= most =>
            {
                0.0
            }
            HoldLaw::Tie { stiffness: Some(k), slack, .. } => (k * (displacement - slack)).clamp(0.0, self.force),
            HoldLaw::Tie { stiffness: None, slack, .. } if displacement < slack => 0.0,
            _ => self.force,
        }
    }

    /// Displacement [m] at which the force is gone for good, if it ever is.
    pub fn ends(&self) -> Option<f64> {
        match self.law {
            HoldLaw::Tie { breaks, .. } => breaks,
            HoldLaw::Friction { until } => until,
        }
    }
}

/// Outward displacement of a point at turn θ [m].
fn outward(depth: f64, height: f64, turn: f64) -> f64 {
    height * turn.sin() + depth * (1.0 - turn.cos())
}

/// Its derivative.
fn outward_rate(depth: f64, height: f64, turn: f64) -> f64 {
    height * turn.cos() + depth * turn.sin()
}

/// Derivative of what a point rises against the direction down the slope of the hinge.
fn rise_rate(depth: f64, height: f64, turn: f64) -> f64 {
    depth * turn.cos() - height * turn.sin()
}

impl Body {
    /// α0 of (OP1), ties at their full force. Below 0: the body falls without an earthquake.
    pub fn multiplier(&self) -> f64 {
        self.work(0.0, |hold, _| hold.force) / self.push(0.0)
    }

    /// Turn from which its weights alone no longer bring it back [rad].
    pub fn falls_at(&self) -> f64 {
        let (rights, tips) =
            self.weights.iter().fold((0.0, 0.0), |(r, t), w| (r + w.carried * w.depth, t + w.carried * w.height));
        rights.atan2(tips)
    }

    /// α0 as a sum: of the first weight, of the others, of thrusts, ties, friction and forces on cracks.
    pub fn shares(&self) -> Shares {
        let only = |keep: &dyn Fn(&mut Body)| {
            let mut body = Body { hinge_angle: self.hinge_angle, ..Body::default() };
            keep(&mut body);
            body.work(0.0, |hold, _| hold.force) / self.push(0.0)
        };
        let ties = |hold: &Hold| matches!(hold.law, HoldLaw::Tie { .. });
        Shares {
            wall: only(&|b| b.weights = self.weights.iter().take(1).copied().collect()),
            loads: only(&|b| b.weights = self.weights.iter().skip(1).copied().collect()),
            thrusts: only(&|b| b.thrusts = self.thrusts.clone()),
            ties: only(&|b| b.holds = self.holds.iter().filter(|h| ties(h)).copied().collect()),
            friction: only(&|b| b.holds = self.holds.iter().filter(|h| !ties(h)).copied().collect()),
            presses: only(&|b| b.presses = self.presses.clone()),
        }
    }

    /// α at turn θ [rad], each tie and friction by its law.
    pub fn at(&self, turn: f64) -> f64 {
        self.work(turn, Hold::at) / self.push(turn)
    }

    /// The same of what surely acts till collapse: weights and thrusts, without ties and friction.
    pub fn sure(&self, turn: f64) -> f64 {
        self.work(turn, |_, _| 0.0) / self.push(turn)
    }

    /// Turn [rad] at which [`Body::sure`] is 0; 0 where it is not above 0 at rest.
    pub fn last_turn(&self) -> f64 {
        let slope = self.hinge_angle.sin();
        let along = self.hinge_angle.cos();
        let (mut rights, mut tips) = (0.0, 0.0);
        for w in &self.weights {
            rights += slope * w.carried * w.depth;
            tips += slope * w.carried * w.height;
        }
        for h in &self.thrusts {
            rights -= h.force * h.height;
            tips += h.force * h.depth;
        }
        for p in &self.presses {
            rights += along * p.force * p.depth;
            tips += along * p.force * p.height;
        }
        if rights <= 0.0 { 0.0 } else { rights.atan2(tips) }
    }

    /// Work per turn of all that resists, less that of thrusts [N m].
    fn work(&self, turn: f64, force: impl Fn(&Hold, f64) -> f64) -> f64 {
        let slope = self.hinge_angle.sin();
        let along = self.hinge_angle.cos();
        let weights: f64 = self.weights.iter().map(|w| slope * w.carried * rise_rate(w.depth, w.height, turn)).sum();
        let thrusts: f64 = self.thrusts.iter().map(|h| h.force * outward_rate(h.depth, h.height, turn)).sum();
        let held = |h: &Hold| force(h, outward(h.depth, h.height, turn)) * outward_rate(h.depth, h.height, turn);
        let holds: f64 = self.holds.iter().map(held).sum();
        let presses: f64 = self.presses.iter().map(|p| along * p.force * rise_rate(p.depth, p.height, turn)).sum();
        weights - thrusts + holds + presses
    }

    /// Σ (P + Q) δ_PQx per turn [N m].
    fn push(&self, turn: f64) -> f64 {
        self.weights.iter().map(|w| (w.carried + w.pushing) * outward_rate(w.depth, w.height, turn)).sum()
    }

    /// Masses, as weights [N], with their velocities per turn at rest [m].
    pub fn masses(&self) -> Vec<[f64; 2]> {
        self.weights.iter().map(|w| [w.carried + w.pushing, w.height]).collect()
    }

    /// Outward displacement [m] of a point straight over the hinge, or away from it in the plane of the wall, at turn θ.
    pub fn displacement(&self, height: f64, turn: f64) -> f64 {
        outward(0.0, height, turn)
    }

    /// Turns [rad] at which a tie or friction ends, in rising order.
    pub fn ends(&self) -> Vec<f64> {
        let of = |hold: &Hold| {
            let most = hold.ends()?;
            (hold.height > most).then(|| turn_to(hold, most))
        };
        let mut turns: Vec<f64> = self.holds.iter().filter_map(of).collect();
        turns.sort_by(f64::total_cmp);
        turns
    }
}

/// The turn at which the point of a hold has gone so far outwards.
fn turn_to(hold: &Hold, displacement: f64) -> f64 {
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if outward(hold.depth, hold.height, middle) < displacement { low = middle } else { high = middle }
    }
    high
}
