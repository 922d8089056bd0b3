//! Side walls that a façade takes along, or that hold it by friction.
//!
//! A crack at β from the vertical parts the side wall; the wedge before it goes with the façade. Of n courses over the hinge,
//!
//! W_w = ½ γ t_s h_w² tan β, F = f n (n+1) μ γ t_s l h_b, z_F = h_w/3 · (n−1)/n,
//!
//! are the wedge's weight and the friction of the overlaps l along an upright crack (part of (OP4)). f = ½ is the sum of what n courses press
//! on n overlaps (derived); (C8.7.1.2) of the Circolare has f = 0.4, and F at h_w/3. Friction falls with the slope of the crack as
//! 1 − tan β/tan β_b, tan β_b = l/h_b (after Casapulla and co-workers, not read again). A load q on the side wall adds n μ q l at
//! h_w/2 · (n−1)/n, on the same bed joints.

use crate::body::{Hold, HoldLaw};

/// A wall that meets the façade from behind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideWall {
    /// t_s [m], above 0.
    pub thickness: f64,
    /// γ [N/m³], above 0.
    pub specific_weight: f64,
    /// h_b [m], above 0: height of a course.
    pub course: f64,
    /// l [m], from 0: overlap of blocks of adjacent courses.
    pub overlap: f64,
    /// μ of the overlaps, from 0.
    pub friction: f64,
    /// q [N/m], from 0: load on the side wall.
    pub load: f64,
    /// Distance of its first opening from the façade [m], above 0, which bounds the wedge. None: no opening.
    pub opening: Option<f64>,
}

/// Which sum of the friction of overlaps is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Overlaps {
    /// f = ½ at h_w/3 · (n−1)/n: the sum over the courses.
    #[default]
    Summed,
    /// f = 0.4 of the code, at the height of the sum.
    Code,
    /// f = 0.4 at h_w/3, as the code has it: n/(n−1) too high for its own forces.
    CodeAtThird,
}

impl Overlaps {
    /// f.
    pub fn factor(self) -> f64 {
        match self {
            Overlaps::Summed => 0.5,
            Overlaps::Code | Overlaps::CodeAtThird => 0.4,
        }
    }
}

impl SideWall {
    /// tan β_b: the slope of the texture's own stepped crack, from the vertical.
    pub fn texture_slope(&self) -> f64 {
        self.overlap / self.course
    }

    /// Largest tan β of a wedge over a hinge h_w [m] below the top: the texture's, or what ends before the opening.
    pub fn largest_slope(&self, height: f64) -> f64 {
        let to_opening = self.opening.map_or(f64::INFINITY, |distance| distance / height);
        self.texture_slope().min(to_opening)
    }

    /// W_w [N].
    pub fn wedge(&self, height: f64, slope: f64) -> f64 {
        0.5 * self.specific_weight * self.thickness * height * height * slope
    }

    /// Moment of the friction along an upright crack about the hinge [N m].
    pub fn friction_moment(&self, height: f64, overlaps: Overlaps) -> f64 {
        let n = height / self.course;
        let force = overlaps.factor() * n * (n + 1.0) * self.friction * self.specific_weight * self.thickness;
        let force = force * self.overlap * self.course;
        let reach = match overlaps {
            Overlaps::CodeAtThird => height,
            // Less than a course over the hinge shears no overlap.
            _ => height * (n - 1.0).max(0.0) / n,
        };
        force * reach / 3.0 + n * self.friction * self.load * self.overlap * 0.5 * reach
    }

    /// Part of that friction which a crack of slope tan β leaves.
    pub fn kept(&self, slope: f64) -> f64 {
        let texture = self.texture_slope();
        if texture > 0.0 { (1.0 - slope / texture).max(0.0) } else { 0.0 }
    }

    /// The friction of a crack of slope tan β, course by course where that is what the sum stands for: each overlap holds until its course
    /// has moved by l. At rest the moment is that of [`SideWall::friction_moment`].
    pub fn holds(&self, height: f64, slope: f64, overlaps: Overlaps) -> Vec<Hold> {
        let (kept, until) = (self.kept(slope), Some(self.overlap));
        let courses = height / self.course;
        let whole = (courses - courses.round()).abs() < 1e-6;
        if kept == 0.0 || self.friction == 0.0 {
            return Vec::new();
        }
        let law = HoldLaw::Friction { until };
        if overlaps != Overlaps::Summed || !whole {
            // One force in the place of all: it ends when the top has moved by l.
            let moment = kept * self.friction_moment(height, overlaps);
            return vec![Hold { force: moment / height, depth: 0.0, height, law }];
        }
        let n = courses.round();
        let pressed = 2.0
            * overlaps.factor()
            * self.friction
            * self.specific_weight
            * self.thickness
            * self.overlap
            * self.course;
        let loaded = self.friction * self.load * self.overlap;
        let mut holds = Vec::new();
        for k in 1..=n as usize {
            let (k, low) = (k as f64, height - k as f64 * self.course);
            holds.push(Hold { force: kept * (pressed * k + loaded), depth: 0.0, height: low, law });
        }
        holds
    }
}
