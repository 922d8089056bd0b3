//! Horizontal arch: a strip between two abutments that give way at a thrust bends outwards.
//!
//! (OP7) α0 = 2 H_r t/(w L_1 L_2) + μ (1 + N/W), lowest at midspan 8 H_r t/(w L²); with masses m on the strip and a thrust h outwards, per
//! length, w becomes w + m in the first term, W + M in the second, and h/(w + m) is taken off
//!
//! w weight per length, L_1 + L_2 = L the span, parted by the vertical hinge on the inner face; the abutments' hinges lie on the outer one.
//! Derived from (OP1). H_r is the least thrust at which an abutment gives way: a tie, a side wall in its plane, a corner. Friction μ acts on
//! the bed joint below, on which the strip slides under its own weight W and the load N. In the displaced shape both halves keep their
//! edges together: t cos θ_i − L_i sin θ_i is the same for both.

/// A strip of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HorizontalArch {
    /// t [m], above 0.
    pub thickness: f64,
    /// L_1 and L_2 [m], each above 0.
    pub spans: [f64; 2],
    /// w [N/m], above 0.
    pub weight: f64,
    /// H_r [N], from 0.
    pub thrust: f64,
    /// μ of the bed joint below, from 0; 0 leaves friction out.
    pub friction: f64,
    /// N [N/m], from 0: load on the strip, per length. It presses its bed.
    pub load: f64,
    /// Weight of masses on the strip, per length [N/m], from 0.
    pub pushing: f64,
    /// What pushes it outwards, per length [N/m], from 0.
    pub outwards: f64,
}

impl HorizontalArch {
    /// α0.
    pub fn multiplier(&self) -> f64 {
        self.at(0.0).unwrap_or(f64::NAN)
    }

    /// α at turn θ [rad] of the first half; none where the halves no longer meet.
    pub fn at(&self, turn: f64) -> Option<f64> {
        let sliding = self.friction * (self.weight + self.load) / (self.weight + self.pushing);
        let (resists, pushes) = self.work(turn)?;
        Some(resists / pushes + sliding)
    }

    /// The same without friction: what surely acts till collapse.
    pub fn sure(&self, turn: f64) -> Option<f64> {
        let (resists, pushes) = self.work(turn)?;
        Some(resists / pushes)
    }

    /// Turn [rad] of the first half at which [`HorizontalArch::sure`] is 0: the thrust line has no height left.
    pub fn last_turn(&self) -> f64 {
        let closed = self.thickness.atan2(self.spans[0]);
        if self.outwards == 0.0 {
            return closed;
        }
        let (mut low, mut high) = (0.0, closed);
        for _ in 0..70 {
            let middle = 0.5 * (low + high);
            if self.sure(middle).is_some_and(|multiplier| multiplier > 0.0) { low = middle } else { high = middle }
        }
        low
    }

    /// Outward displacement of the inner edge of the crack at turn θ [m].
    pub fn bulge(&self, turn: f64) -> f64 {
        self.spans[0] * turn.sin() + self.thickness * (1.0 - turn.cos())
    }

    /// Masses, as weights [N], with their velocities per turn of the first half at rest [m].
    pub fn masses(&self) -> Vec<[f64; 2]> {
        let half = 0.5 * self.spans[0];
        self.spans.map(|span| [(self.weight + self.pushing) * span, half]).to_vec()
    }

    fn work(&self, turn: f64) -> Option<(f64, f64)> {
        let t = self.thickness;
        let [first, second] = self.spans;
        let edge = t * turn.cos() - first * turn.sin();
        let reach = t.hypot(second);
        let other = (edge.abs() < reach).then(|| (edge / reach).acos() - second.atan2(t))?;
        let rate = (t * turn.sin() + first * turn.cos()) / (t * other.sin() + second * other.cos());
        let spread = |span: f64, turn: f64| t * turn.cos() - span * turn.sin();
        let out = |span: f64, turn: f64| span * 0.5 * (span * turn.cos() + t * turn.sin());
        let resists = self.thrust * (spread(first, turn) + spread(second, other) * rate);
        let out = out(first, turn) + out(second, other) * rate;
        Some((resists - self.outwards * out, (self.weight + self.pushing) * out))
    }
}
