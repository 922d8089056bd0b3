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
//! from the plane of the wall:
//!
//! (h − b) sin φ − d cos φ = t − d − t cos θ + b sin θ, b = x h.

/// A storey between two levels that hold it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VerticalArch {
    /// t [m], above 0.
    pub thickness: f64,
    /// h [m], above 0: from the lower level to the upper one.
    pub height: f64,
    /// Weights of the parts below and above the hinge [N] with the heights of their centroids over the lower level [m].
    pub parts: [[f64; 2]; 2],
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
        let parts = [[weight * part, 0.5 * hinge], [weight * (1.0 - part), 0.5 * (hinge + height)]];
        VerticalArch { thickness, height, parts, hinge, load, depth }
    }

    /// α0.
    pub fn multiplier(&self) -> f64 {
        self.at(0.0).unwrap_or(f64::NAN)
    }

    /// α at turn θ [rad] of the lower part; none where the parts no longer reach the top.
    pub fn at(&self, turn: f64) -> Option<f64> {
        let (resists, pushes) = self.work(turn)?;
        Some(resists / pushes)
    }

    /// R [N]: the horizontal force that the top needs at α0.
    pub fn reaction(&self) -> f64 {
        let [lower, upper] = self.parts;
        let tips = self.multiplier() * (lower[0] * lower[1] + upper[0] * upper[1]);
        let rights = 0.5 * self.thickness * (lower[0] + upper[0]) + self.load * (self.thickness - self.depth);
        (tips - rights) / self.height
    }

    /// Turn [rad] at which α is 0; where the parts reach the top no longer, the last at which they do.
    pub fn last_turn(&self) -> f64 {
        let stands = |turn: f64| self.work(turn).is_some_and(|(resists, _)| resists > 0.0);
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
        let [lower, upper] = self.parts;
        let other = self.hinge / (self.height - self.hinge);
        vec![[lower[0], lower[1]], [upper[0], (self.height - upper[1]) * other]]
    }

    /// Turn φ of the upper part [rad].
    pub fn upper_turn(&self, turn: f64) -> Option<f64> {
        let (t, b, d, above) = (self.thickness, self.hinge, self.depth, self.height - self.hinge);
        let reach = d.hypot(above);
        let needed = (t - d - t * turn.cos() + b * turn.sin()) / reach;
        (needed.abs() < 1.0).then(|| d.atan2(above) + needed.asin())
    }

    /// Work per turn that resists, and of the masses outwards [N m].
    fn work(&self, turn: f64) -> Option<(f64, f64)> {
        let (t, b, d, above) = (self.thickness, self.hinge, self.depth, self.height - self.hinge);
        let (sin, cos) = turn.sin_cos();
        let (s, c) = self.upper_turn(turn)?.sin_cos();
        let rate = (t * sin + b * cos) / (d * s + above * c);
        let [lower, upper] = self.parts;
        let half = 0.5 * t;
        // Hinge of both parts: outwards, upwards.
        let hinge = [t * sin + b * cos, t * cos - b * sin];
        let low = [lower[1] * cos + half * sin, half * cos - lower[1] * sin];
        // From the hinge to a point of the upper part: inwards, upwards.
        let of = |x: f64, z: f64| [hinge[0] + (x * s - z * c) * rate, hinge[1] - (z * s + x * c) * rate];
        let high = of(-half, upper[1] - b);
        let top = of(-d, above);
        let resists = lower[0] * low[1] + upper[0] * high[1] + self.load * top[1];
        Some((resists, lower[0] * low[0] + upper[0] * high[0]))
    }
}
