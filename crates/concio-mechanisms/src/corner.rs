//! A corner that falls outwards: the union of two wedges, one of each wall, that overlap in the corner column.
//!
//! (OP5) α0 = [ ∫γ s dV + P s_P − H h + Σ (1 − tan β/tan β_b) F z_F ] / [ ∫γ z dV + (P + Q) h ]
//!
//! The hinge line passes through the outer corner, perpendicular to the plane at φ from wall 1; s = x cos φ + y sin φ is the distance behind
//! it. At height z over the hinge the section is x_1 y_1 + x_2 y_2 − x_o y_o with x_1 = z tan β_1, y_1 = t_1, x_2 = t_2, y_2 = z tan β_2,
//! x_o = min(x_1, x_2), y_o = min(y_1, y_2). H is the thrust of a hip rafter. Derived from (OP1). φ stays given: left free, the minimum runs
//! to one wall that overturns with a piece of the other. Of both cracks one and the same part of the texture's slope is taken, for the
//! same reason.
//!
//! Floors and ties of wall 1 count where they lie on its wedge, as in (OP3): of a floor the part z tan β_1/L, in the middle of that length.
//! The corner falls along φ; thrusts, ties and connections act across the wall, with sin φ of their force.

use crate::body::{Body, Hold, HoldLaw, Thrust, Weight};
use crate::facade::{Floor, Tie};
use crate::side_wall::{Overlaps, SideWall};

/// A corner of two walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// The walls, each with its thickness, weight and texture; an opening's distance is from the corner.
    pub walls: [SideWall; 2],
    /// φ [rad], 0 to π/2: direction of falling from wall 1; π/4 unless something speaks for another.
    pub direction: f64,
    /// Level of the top [m].
    pub top: f64,
    /// What lies on it at the top.
    pub load: CornerLoad,
    /// Sum of the friction of overlaps.
    pub overlaps: Overlaps,
}

/// Load of a hip rafter or beam at the top of a corner.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CornerLoad {
    /// P [N], from 0.
    pub load: f64,
    /// s_P [m], from 0: distance of P behind the hinge line.
    pub depth: f64,
    /// Q [N], from 0.
    pub pushing: f64,
    /// H [N], positive outwards.
    pub thrust: f64,
}

/// What lies on wall 1 and pulls it beside the corner.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Beside<'w> {
    /// Floors, spread over the wall.
    pub floors: &'w [Floor],
    /// Ties, their positions measured from the corner [m].
    pub ties: &'w [Tie],
    /// Length of the wall [m], above 0 where there are floors.
    pub length: f64,
}

/// A corner that turns about one hinge.
#[derive(Debug, Clone, PartialEq)]
pub struct Overturning {
    /// Level of the hinge [m].
    pub hinge: f64,
    /// α0.
    pub multiplier: f64,
    /// tan β of both cracks.
    pub slopes: [f64; 2],
    /// The body that turns.
    pub body: Body,
}

/// A weight with its centroid behind and over the hinge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wedge {
    /// Weight [N].
    pub weight: f64,
    /// s_G [m].
    pub depth: f64,
    /// z_G [m].
    pub height: f64,
}

/// Points of a search over the slope; the least beside them is found by sections.
const TRIED: usize = 64;

impl Corner {
    /// The union of the wedges over a hinge h [m] below the top.
    pub fn wedge(&self, height: f64, slopes: [f64; 2]) -> Wedge {
        let [one, two] = &self.walls;
        // Between the levels where a wedge leaves the corner column the integrands are cubic at most: three points of Gauss are exact.
        let mut cuts = vec![0.0, height];
        for (slope, across) in [(slopes[0], two.thickness), (slopes[1], one.thickness)] {
            cuts.extend((slope > 0.0).then(|| across / slope).filter(|z| *z < height));
        }
        cuts.sort_by(f64::total_cmp);
        let mut sums = [0.0; 3];
        for pair in cuts.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            for (point, factor) in [(-0.6f64.sqrt(), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6f64.sqrt(), 5.0 / 9.0)] {
                let z = middle + half * point;
                let [weight, moment] = self.section(z, slopes);
                sums[0] += factor * half * weight;
                sums[1] += factor * half * moment;
                sums[2] += factor * half * weight * z;
            }
        }
        Wedge { weight: sums[0], depth: sums[1] / sums[0], height: sums[2] / sums[0] }
    }

    /// Weight per height of the section at z [N/m], and its moment about the hinge line [N].
    fn section(&self, z: f64, slopes: [f64; 2]) -> [f64; 2] {
        let [one, two] = &self.walls;
        let along = [z * slopes[0], two.thickness];
        let across = [one.thickness, z * slopes[1]];
        let both = [along[0].min(along[1]), across[0].min(across[1])];
        let (sin, cos) = self.direction.sin_cos();
        let of = |x: f64, y: f64| [x * y, x * y * 0.5 * (x * cos + y * sin)];
        let parts = [
            (of(along[0], across[0]), one.specific_weight),
            (of(along[1], across[1]), two.specific_weight),
            // What both have is counted once, with the mean of their weights.
            (of(both[0], both[1]), -0.5 * (one.specific_weight + two.specific_weight)),
        ];
        parts.iter().fold([0.0; 2], |sum, (part, weight)| [sum[0] + weight * part[0], sum[1] + weight * part[1]])
    }

    /// Overturning about a hinge at a level [m] below the top, with cracks of given slopes, not both 0.
    pub fn with_slopes(&self, hinge: f64, slopes: [f64; 2], beside: &Beside) -> Overturning {
        let height = self.top - hinge;
        let wedge = self.wedge(height, slopes);
        let mut body = Body::default();
        body.weights.push(Weight { carried: wedge.weight, pushing: 0.0, depth: wedge.depth, height: wedge.height });
        let CornerLoad { load, depth, pushing, thrust } = self.load;
        if load > 0.0 || pushing > 0.0 {
            body.weights.push(Weight { carried: load, pushing, depth, height });
        }
        if thrust != 0.0 {
            body.thrusts.push(Thrust { force: thrust, depth, height });
        }
        let holds = |i: usize| self.walls[i].holds(height, slopes[i], self.overlaps);
        body.holds = [0, 1].into_iter().flat_map(holds).collect::<Vec<Hold>>();
        self.lay(&mut body, hinge, slopes[0], beside);
        Overturning { hinge, multiplier: body.multiplier(), slopes, body }
    }

    /// Floors and ties on the wedge of wall 1.
    fn lay(&self, body: &mut Body, hinge: f64, slope: f64, beside: &Beside) {
        let (sin, cos) = self.direction.sin_cos();
        // What stands on the wall's top, such as a gable, is not beside the corner.
        let on_it = |f: &&Floor| f.level > hinge + LEVEL && f.level <= self.top + LEVEL;
        for floor in beside.floors.iter().filter(on_it) {
            let height = floor.level - hinge;
            let reach = (height * slope).min(beside.length);
            let (part, depth) = (reach / beside.length, 0.5 * reach * cos + floor.depth * sin);
            if part <= 0.0 {
                continue;
            }
            body.weights.push(Weight { carried: part * floor.load, pushing: part * floor.pushing, depth, height });
            if floor.thrust != 0.0 {
                body.thrusts.push(Thrust { force: part * floor.thrust * sin, depth, height });
            }
            let rubs = part * floor.friction * floor.load;
            if rubs > 0.0 {
                body.holds.push(Hold { force: rubs, depth, height, law: HoldLaw::Friction { until: floor.seat } });
            }
            if floor.connection > 0.0 {
                let law = HoldLaw::Tie { stiffness: None, slack: 0.0, breaks: None };
                body.holds.push(Hold { force: part * floor.connection * sin, depth, height, law });
            }
        }
        for tie in beside.ties.iter().filter(|t| t.level > hinge + LEVEL) {
            let height = tie.level - hinge;
            if (0.0..=height * slope).contains(&tie.position) {
                let law = HoldLaw::Tie { stiffness: tie.stiffness, slack: tie.slack, breaks: tie.breaks };
                let force = tie.comes_to(height * body.falls_at().sin() * sin) * sin;
                body.holds.push(Hold { force, depth: tie.position * cos, height, law });
            }
        }
    }

    /// The least over the slopes, both the same part of the largest that their walls allow. A wedge reaches an overlap into its wall at its
    /// top at least: a thinner one would be cut out of a block.
    pub fn least(&self, hinge: f64, beside: &Beside) -> Overturning {
        let height = self.top - hinge;
        let most = [0, 1].map(|i| self.walls[i].largest_slope(height));
        let thinnest = [0, 1].map(|i| if most[i] > 0.0 { self.walls[i].overlap / height / most[i] } else { 0.0 });
        let thinnest = thinnest[0].max(thinnest[1]).min(1.0);
        let at = |part: f64| self.with_slopes(hinge, most.map(|slope| part * slope), beside);
        let least = |part: f64| if part > 0.0 { at(part).multiplier } else { f64::INFINITY };
        at(crate::minimum::least(TRIED, thinnest, 1.0, least))
    }
}

/// Loads this far below a hinge still stand on it: rounding of levels [m].
const LEVEL: f64 = crate::overturning::LEVEL;
