//! Overturning of a façade about a bed joint, alone or with wedges of its side walls.
//!
//! (OP3) α0 = [ W (t/2 − a) + Σ P_i (x_i − a) + Σ (T_i + μ_f P_i − H_i)(z_i − z_0) ] / [ W h_w/2 + Σ (P_i + Q_i)(z_i − z_0) ]
//!
//! (OP4) α0 = [ W t/2 + Σ_s ( W_w (t + h_w tan β/3) + (1 − tan β/tan β_b) F z_F ) ] / [ W h_w/2 + Σ_s W_w 2 h_w/3 ],
//!
//! with the floors, ties and thrusts of (OP3). Where there are openings, W and its height are those of what is left. Derived from (OP1);
//! each hinge level is a mechanism of its own, and over the slopes of the cracks the least is taken. In (OP4) numerator and denominator are
//! quadratic and linear in every slope, so that the least is found exactly: for a trial α each slope has a closed form, and α follows
//! (Dinkelbach 1967, Management Science 13:492).

use crate::body::{Body, Hold, HoldLaw, Thrust, Weight};
use crate::facade::{Floor, Masonry, Tie};
use crate::setback::Crushing;
use crate::side_wall::{Overlaps, SideWall};

/// A façade that may turn outwards.
#[derive(Debug, Clone, Copy)]
pub struct Facade<'f> {
    /// Its masonry.
    pub masonry: &'f Masonry,
    /// Floors and roof.
    pub floors: &'f [Floor],
    /// Ties.
    pub ties: &'f [Tie],
    /// Side walls that are bonded to it.
    pub side_walls: &'f [SideWall],
    /// Crushing at hinges.
    pub crushing: Crushing,
    /// Sum of the friction of overlaps.
    pub overlaps: Overlaps,
}

/// Overturning about one hinge.
#[derive(Debug, Clone, PartialEq)]
pub struct Overturning {
    /// Level of the hinge [m].
    pub hinge: f64,
    /// α0.
    pub multiplier: f64,
    /// a [m] of (OP2).
    pub setback: f64,
    /// Width of its block of pressure [m].
    pub width: f64,
    /// tan β of the crack of each side wall.
    pub slopes: Vec<f64>,
    /// The body that turns.
    pub body: Body,
}

/// Rounds of slopes and setback; both settle in a few.
const ROUNDS: usize = 60;
/// Loads this far below a hinge still stand on it: rounding of levels [m].
pub(crate) const LEVEL: f64 = 1e-9;

impl Facade<'_> {
    /// Overturning about a hinge at a level [m] below the top, with cracks of given slopes, one for each side wall.
    pub fn with_slopes(&self, hinge: f64, slopes: &[f64]) -> Overturning {
        let height = self.masonry.top() - hinge;
        let mut body = self.alone(hinge);
        for (wall, &slope) in self.side_walls.iter().zip(slopes) {
            let depth = self.masonry.thickness + height * slope / 3.0;
            let carried = wall.wedge(height, slope);
            if carried > 0.0 {
                body.weights.push(Weight { carried, pushing: 0.0, depth, height: 2.0 * height / 3.0 });
            }
            body.holds.extend(wall.holds(height, slope, self.overlaps));
        }
        // What loads a wedge goes with it.
        for (wall, &slope) in self.side_walls.iter().zip(slopes) {
            let carried = wall.load * height * slope;
            if carried > 0.0 {
                let depth = self.masonry.thickness + 0.5 * height * slope;
                body.weights.push(Weight { carried, pushing: 0.0, depth, height });
            }
        }
        let force: f64 = body.weights.iter().map(|w| w.carried).sum();
        let bearing = self.masonry.bearing(hinge);
        let setback = self.crushing.setback_within(force, bearing, self.masonry.thickness);
        let width = if bearing > 0.0 { self.crushing.width(force, bearing) } else { 0.0 };
        body.weights.iter_mut().for_each(|w| w.depth -= setback);
        body.thrusts.iter_mut().for_each(|h| h.depth -= setback);
        body.holds.iter_mut().for_each(|h| h.depth -= setback);
        Overturning { hinge, multiplier: body.multiplier(), setback, width, slopes: slopes.to_vec(), body }
    }

    /// The least over the slopes of all cracks, each from 0 to the largest that its side wall allows.
    pub fn least(&self, hinge: f64) -> Overturning {
        let height = self.masonry.top() - hinge;
        let mut slopes = vec![0.0; self.side_walls.len()];
        let mut found = self.with_slopes(hinge, &slopes);
        for _ in 0..ROUNDS {
            let (alpha, setback) = (found.multiplier, found.setback);
            for (wall, slope) in self.side_walls.iter().zip(&mut slopes) {
                *slope = self.slope(wall, height, alpha, setback);
            }
            let next = self.with_slopes(hinge, &slopes);
            let settled = next.multiplier >= alpha * (1.0 - 1e-15) && next.setback == setback;
            if next.multiplier <= alpha {
                found = next;
            }
            if settled {
                break;
            }
        }
        found
    }

    /// The slope that makes numerator less α times denominator least.
    fn slope(&self, wall: &SideWall, height: f64, alpha: f64, setback: f64) -> f64 {
        let wedge = wall.wedge(height, 1.0);
        let texture = wall.texture_slope();
        let lost = if texture > 0.0 { wall.friction_moment(height, self.overlaps) / texture } else { 0.0 };
        let (load, behind) = (wall.load * height, self.masonry.thickness - setback);
        let linear = (wedge + load) * behind - lost - alpha * (wedge * 2.0 / 3.0 + load) * height;
        let quadratic = (wedge / 3.0 + load / 2.0) * height;
        (-linear / (2.0 * quadratic)).clamp(0.0, wall.largest_slope(height))
    }

    /// The façade over a hinge on its face, without side walls.
    fn alone(&self, hinge: f64) -> Body {
        let mut body = self.untied(hinge);
        let falls_at = body.falls_at();
        for tie in self.ties.iter().filter(|t| t.level > hinge + LEVEL) {
            let law = HoldLaw::Tie { stiffness: tie.stiffness, slack: tie.slack, breaks: tie.breaks };
            let height = tie.level - hinge;
            body.holds.push(Hold { force: tie.comes_to(height * falls_at.sin()), depth: 0.0, height, law });
        }
        body
    }

    /// The same without its ties.
    fn untied(&self, hinge: f64) -> Body {
        let own = self.masonry.above(hinge);
        let half = 0.5 * self.masonry.thickness;
        let mut body = Body::default();
        body.weights.push(Weight { carried: own.weight, pushing: 0.0, depth: half, height: own.centroid[1] - hinge });
        for floor in self.floors.iter().filter(|f| f.level > hinge + LEVEL) {
            let (depth, height) = (floor.depth, floor.level - hinge);
            body.weights.push(Weight { carried: floor.load, pushing: floor.pushing, depth, height });
            if floor.thrust != 0.0 {
                body.thrusts.push(Thrust { force: floor.thrust, depth, height });
            }
            if floor.friction * floor.load > 0.0 {
                let law = HoldLaw::Friction { until: floor.seat };
                body.holds.push(Hold { force: floor.friction * floor.load, depth, height, law });
            }
            if floor.connection > 0.0 {
                let law = HoldLaw::Tie { stiffness: None, slack: 0.0, breaks: None };
                body.holds.push(Hold { force: floor.connection, depth, height, law });
            }
        }
        body
    }

    /// What a tie comes to [N] before the façade over a hinge would fall without ties and friction.
    pub fn tie(&self, hinge: f64, tie: &Tie) -> f64 {
        tie.comes_to((tie.level - hinge) * self.untied(hinge).falls_at().sin())
    }

    /// The same façade as if its side walls did not hold it (OP3).
    pub fn without_side_walls(mut self) -> Self {
        self.side_walls = &[];
        self
    }
}
