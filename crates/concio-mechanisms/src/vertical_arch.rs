//! Vertical arch: a storey that is held at base and top bends outwards between them.
//!
//! (OP6) α0(x) = (2t/h) [ 1 + n (1 + (d/t) x/(1−x)) ] / x, n = N/W
//!
//! x* = 1/(1 + √(n δ/(1+n))), δ = d/t, min α0 = (2t/h) ( √(1+n) + √(n δ) )²,
//!
//! R = α0 W/2 − [ W t/2 + N (t − d) ]/h
//!
//! for a hinge x h above the base at the inner face, the base's on the outer one, and N, all that lies above, at d from the inner face.
//! Derived from (OP1). R is the reaction that the top needs. N is held, and pushes nothing: it counts among no masses. In the displaced
//! shape the lower part turns by θ about the outer edge of the base, the upper one by φ the other way, so that the top keeps its distance
//! from the plane of the wall (forces H of floors between the ends, below 0 where they hold back, take Σ H δ off the numerator and add Σ H z/h
//! to R):
//!
//! (h − b) sin φ − d cos φ = t − d − t cos θ + b sin θ, b = x h.

use crate::body::{Thrust, Weight};

/// A storey between two levels that hold it.
#[derive(Debug, Clone, PartialEq)]
pub struct VerticalArch {
    /// t [m], above 0.
    pub thickness: f64,
    /// h [m], above 0: from the lower level to the upper one.
    pub height: f64,
    /// Weights of the parts below and above the hinge, each behind the outer face and over the lower level.
    pub parts: [Vec<Weight>; 2],
    /// Forces on these parts: thrusts of floors and, below 0, what holds back between the ends.
    pub forces: [Vec<Thrust>; 2],
    /// b [m], above 0 and below h: height of the hinge.
    pub hinge: f64,
    /// N [N], from 0.
    pub load: f64,
    /// d [m], from 0 to t: distance of N from the inner face.
    pub depth: f64,
}

/// What the formulas of (OP6) give for a uniform wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Least {
    /// x*.
    pub part: f64,
    /// α0 there.
    pub multiplier: f64,
}

/// The least α0 of a uniform wall of weight W [N] over all heights of its hinge; N = 0 has its infimum at x = 1.
pub fn least(thickness: f64, height: f64, weight: f64, load: f64, depth: f64) -> Least {
    let (n, inner) = (load / weight, depth / thickness);
    let root = (1.0 + n).sqrt() + (n * inner).sqrt();
    let part = 1.0 / (1.0 + (n * inner / (1.0 + n)).sqrt());
    Least { part, multiplier: 2.0 * thickness / height * root * root }
}

impl VerticalArch {
    /// A uniform wall of weight W [N] with its hinge at x of its height.
    pub fn uniform(thickness: f64, height: f64, weight: f64, part: f64, load: f64, depth: f64) -> VerticalArch {
        let hinge = part * height;
        let of = |part: f64, height: f64| {
            vec![Weight { carried: weight * part, pushing: 0.0, depth: 0.5 * thickness, height }]
        };
        let parts = [of(part, 0.5 * hinge), of(1.0 - part, 0.5 * (hinge + height))];
        VerticalArch { thickness, height, parts, forces: Default::default(), hinge, load, depth }
    }

    /// α0.
    pub fn multiplier(&self) -> f64 {
        self.at(0.0).unwrap_or(f64::NAN)
    }

    /// α at turn θ [rad] of the lower part; none where the parts no longer reach the top.
    pub fn at(&self, turn: f64) -> Option<f64> {
        let (resists, pushes) = self.work(turn, |_| true)?;
        Some(resists / pushes)
    }

    /// The same of what surely acts till collapse: without what holds back between the ends.
    pub fn sure(&self, turn: f64) -> Option<f64> {
        let (resists, pushes) = self.work(turn, |force| force.force > 0.0)?;
        Some(resists / pushes)
    }

    /// R [N]: the horizontal force that the top needs at α0.
    pub fn reaction(&self) -> f64 {
        let all = || self.parts.iter().flatten();
        let tips = self.multiplier() * all().map(|w| (w.carried + w.pushing) * w.height).sum::<f64>();
        let own: f64 = all().map(|w| w.carried * w.depth).sum();
        let rights = own + self.load * (self.thickness - self.depth);
        let forces: f64 = self.forces.iter().flatten().map(|f| f.force * f.height).sum();
        (tips + forces - rights) / self.height
    }

    /// Turn [rad] at which [`VerticalArch::sure`] is 0; where the parts reach the top no longer, the last at which they do.
    pub fn last_turn(&self) -> f64 {
        let stands = |turn: f64| self.sure(turn).is_some_and(|multiplier| multiplier > 0.0);
        let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
        // α falls all the way, so that the first turn without it bounds the last with it.
        for _ in 0..70 {
            let middle = 0.5 * (low + high);
            if stands(middle) { low = middle } else { high = middle }
        }
        low
    }

    /// Outward displacement of the hinge, at the inner face, at turn θ [m].
    pub fn bulge(&self, turn: f64) -> f64 {
        self.hinge * turn.sin() + self.thickness * (1.0 - turn.cos())
    }

    /// Masses, as weights [N], with their velocities per turn of the lower part at rest [m].
    pub fn masses(&self) -> Vec<[f64; 2]> {
        let [lower, upper] = &self.parts;
        let other = self.hinge / (self.height - self.hinge);
        let below = lower.iter().map(|w| [w.carried + w.pushing, w.height]);
        let above = upper.iter().map(|w| [w.carried + w.pushing, (self.height - w.height) * other]);
        below.chain(above).collect()
    }

    /// Turn φ of the upper part [rad].
    pub fn upper_turn(&self, turn: f64) -> Option<f64> {
        let (t, b, d, above) = (self.thickness, self.hinge, self.depth, self.height - self.hinge);
        let reach = d.hypot(above);
        let needed = (t - d - t * turn.cos() + b * turn.sin()) / reach;
        (needed.abs() < 1.0).then(|| d.atan2(above) + needed.asin())
    }

    /// Work per turn that resists, and of the masses outwards [N m].
    fn work(&self, turn: f64, acts: impl Fn(&Thrust) -> bool) -> Option<(f64, f64)> {
        let (t, b, d, above) = (self.thickness, self.hinge, self.depth, self.height - self.hinge);
        let (sin, cos) = turn.sin_cos();
        let (s, c) = self.upper_turn(turn)?.sin_cos();
        let rate = (t * sin + b * cos) / (d * s + above * c);
        // Hinge of both parts: outwards, upwards.
        let hinge = [t * sin + b * cos, t * cos - b * sin];
        // A point of the lower part, and one of the upper part by its place from the hinge: outwards, upwards.
        let low = |x: f64, z: f64| [z * cos + x * sin, x * cos - z * sin];
        let high = |x: f64, z: f64| [hinge[0] + (x * s - z * c) * rate, hinge[1] - (z * s + x * c) * rate];
        let mut resists = self.load * high(-d, above)[1];
        let mut pushes = 0.0;
        let [below, above] = &self.forces;
        let below = below.iter().map(|f| (f, low(f.depth, f.height)));
        let above = above.iter().map(|f| (f, high(f.depth - t, f.height - b)));
        for (force, [out, _]) in below.chain(above).filter(|(force, _)| acts(force)) {
            resists -= force.force * out;
        }
        let [lower, upper] = &self.parts;
        let lower = lower.iter().map(|w| (w, low(w.depth, w.height)));
        let upper = upper.iter().map(|w| (w, high(w.depth - t, w.height - b)));
        for (weight, [out, up]) in lower.chain(upper) {
            resists += weight.carried * up;
            pushes += (weight.carried + weight.pushing) * out;
        }
        Some((resists, pushes))
    }
}
