//! A gable that falls outwards, whole or in flaps.
//!
//! (OP9) α0 = [ W t/2 + P c − H h_g ] / [ W h_g/3 + (P + Q) h_g ], 3t/(2 h_g) without a roof
//!
//! for the whole gable about its base, P at c behind the outer face and the thrust H at the ridge. Derived from (OP1). Flaps are those of
//! (OP8) on the gable's outline: a vertical crack below the ridge, a hinge from the slope to the foot of the crack. Where the mass Q of the
//! ridge beam is large, the least over all flaps runs to a small piece about the beam: that is punching. Blocks bound it, for a crack that
//! climbs along joints is no steeper than tan ϑ = tan β_b.

use crate::body::{Body, Thrust, Weight};
use crate::flap::{Flap, PointLoad};

/// A triangular gable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gable {
    /// Length of its base [m], above 0.
    pub base: f64,
    /// h_g [m], above 0.
    pub height: f64,
    /// t [m], above 0.
    pub thickness: f64,
    /// γ [N/m³], above 0.
    pub specific_weight: f64,
    /// P [N], from 0: load of the ridge beam.
    pub load: f64,
    /// c [m]: depth of P behind the outer face.
    pub depth: f64,
    /// Q [N], from 0.
    pub pushing: f64,
    /// H [N], positive outwards: thrust at the ridge.
    pub thrust: f64,
}

/// Flaps of a gable.
#[derive(Debug, Clone, PartialEq)]
pub struct Flaps {
    /// One of the two, on the left.
    pub flap: Flap,
    /// α0.
    pub multiplier: f64,
    /// The body that turns.
    pub body: Body,
}

/// Points of a search along the slope and along the crack.
const TRIED: usize = 60;

impl Gable {
    /// W [N].
    pub fn weight(&self) -> f64 {
        0.5 * self.specific_weight * self.thickness * self.base * self.height
    }

    /// The whole gable about its base.
    pub fn whole(&self) -> Body {
        let height = self.height;
        let mut body = Body::default();
        body.weights.push(Weight {
            carried: self.weight(),
            pushing: 0.0,
            depth: 0.5 * self.thickness,
            height: height / 3.0,
        });
        body.weights.push(Weight { carried: self.load, pushing: self.pushing, depth: self.depth, height });
        if self.thrust != 0.0 {
            body.thrusts.push(Thrust { force: self.thrust, depth: self.depth, height });
        }
        body
    }

    /// The left one of two flaps whose hinge runs from `from` along the base [m], on the slope, to the foot of the crack below the ridge at
    /// `foot` over the base [m]; half of the ridge load lies on each, and the crack is pressed by `press` [N].
    pub fn flaps(&self, from: f64, foot: f64, press: f64) -> Flaps {
        let half = 0.5 * self.base;
        let on_slope = [from, self.height * from / half];
        let [foot, ridge] = [[half, foot], [half, self.height]];
        let hinge = if on_slope[1] < foot[1] { [on_slope, foot] } else { [foot, on_slope] };
        let flap = Flap { outline: vec![on_slope, foot, ridge], hinge, crack: [foot, ridge], thrust: press };
        let load = PointLoad { at: ridge, load: 0.5 * self.load, depth: self.depth, pushing: 0.5 * self.pushing };
        let (area, centroid) = flap.area();
        let carried = self.specific_weight * self.thickness * area;
        let mut body = flap.body(&crate::facade::Masonry { thickness: self.thickness, pieces: Vec::new() }, &[load]);
        body.weights[0] =
            Weight { carried, pushing: 0.0, depth: 0.5 * self.thickness, height: flap.distance(centroid) };
        if self.thrust != 0.0 {
            body.thrusts.push(Thrust { force: 0.5 * self.thrust, depth: self.depth, height: flap.distance(ridge) });
        }
        Flaps { multiplier: body.multiplier(), flap, body }
    }

    /// The least of all flaps whose hinge is at least at tan ϑ = `steepest` from the vertical; 0 leaves it free.
    pub fn least_flaps(&self, steepest: f64, press: f64) -> Flaps {
        let half = 0.5 * self.base;
        let at = |from: f64, foot: f64| self.flaps(from * half, foot * self.height, press);
        let allowed =
            |found: &Flaps| found.flap.angle().tan() >= steepest * (1.0 - 1e-9) && found.body.weights[0].height > 0.0;
        let value = |from: f64, foot: f64| {
            let found = at(from, foot);
            if allowed(&found) && found.multiplier.is_finite() { found.multiplier } else { f64::INFINITY }
        };
        let row = |foot: f64| crate::minimum::least(TRIED, 0.0, MOST, |from| value(from, foot));
        let foot = crate::minimum::least(TRIED, 0.0, MOST, |foot| value(row(foot), foot));
        at(row(foot), foot)
    }
}

/// Parts of the base and of the height that a flap spares at least: a piece of the last hundredth is no wall.
const MOST: f64 = 0.99;
