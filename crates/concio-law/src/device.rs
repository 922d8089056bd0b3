//! Devices in place of mortar (theory, section 3): forces on side a against d = x_a − x_b and w = ḋ.
//!
//!   (I1)  F = c v_0 |w/v_0|^α sgn w                                        viscous
//!   (I2)  F = k d + c w                                                    elastic
//!   (I3)  F = F_s (2/π) arctan(100 w/δ_v), or |F| ≤ F_s at rest            friction-damper
//!   (I4)  F = a (F_y/d_y) d + (1 − a) F_y ζ + c w                          bouc-wen
//!   (I5)  ζ̇ = [A w − β |w| |ζ|^{n−1} ζ − γ w |ζ|^n]/d_y
//!   (I6)  F = k_2 d + (k_1 − k_2) (d − s) + c w                            re-centring
//!   (I7)  s stays unless |d| leads it to (|d| − d_a)₊ or lets it back to (|d| − (1 − β_f) d_a)₊,   d_a = F_a/k_1
//!
//! Linear parts are springs and dashpots of the joint, (I3) friction of unit coefficients under the normal force F_s; what
//! remains is a [`Law`]. The dissipation of (I5) is F_y (1 − a) |ζ|^n (β |w ζ| + γ w ζ)/A, from 0 for |γ| ≤ β; what is stored,
//! ½ (1 − a) F_y d_y ζ²/A. (I6) stores ½ (k_1 − k_2) (d − s)² + (1 − β_f/2) (k_1 − k_2) d_a |s| beside ½ k_2 d² and loses
//! ½ β_f (k_1 − k_2) d_a |Δs|.
//!
//! Dashpots with a power are those of Soong & Dargush (1997); (I4), (I5) of Bouc (1967) and Wen (1976); (I6), (I7) of
//! Christopoulos, Filiatrault & Folz (2002).

/// Velocity over v_0 below which a dashpot with α < 1 is linear: its slope would be infinite at rest.
const SLOW: f64 = 1e-4;
/// Piece of a way over that in which ζ would come to its limit, how many there are at most (longer ways end a thousandth off), and way over d_y
/// that is none.
const SHORT: f64 = 0.25;
const MOST_PIECES: f64 = 400.0;
const TINY: f64 = 1e-9;
/// Iterations for ζ at most; bisection alone would take as many.
const MOST: usize = 80;

/// The laws that are more than a spring, a dashpot and friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// (I1) with α below 1.
    Power(Power),
    /// (1 − a) F_y ζ of (I4).
    BoucWen(BoucWen),
    /// (k_1 − k_2) (d − s) of (I6).
    ReCentring(ReCentring),
}

/// (I1), with the power (w² + w_0²)^((α − 1)/2) w so that its slope is finite at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// c [N s/m], above 0.
    pub damping: f64,
    /// v_0 [m/s], above 0.
    pub velocity: f64,
    /// α, 0.2 … 1.
    pub exponent: f64,
}

/// (I5) and its part of (I4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoucWen {
    /// (1 − a) F_y [N], from 0.
    pub force: f64,
    /// d_y [m], above 0.
    pub displacement: f64,
    /// A, above 0.
    pub amplitude: f64,
    /// β, above 0.
    pub beta: f64,
    /// γ, above −β, up to β.
    pub gamma: f64,
    /// n, 1 … 100.
    pub sharpness: f64,
}

/// (I7) and its part of (I6).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReCentring {
    /// k_1 − k_2 [N/m], above 0.
    pub stiffness: f64,
    /// d_a [m], above 0.
    pub activation: f64,
    /// β_f, 0 … 1.
    pub flag: f64,
}

/// Origin where a stage finds a law: d = `d` + τ w, ζ = `internal` + τ ζ̇, s = `internal` at the start of the step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Origin {
    /// Relative displacement [m].
    pub d: f64,
    /// ζ or s [m].
    pub internal: f64,
    /// τ [s].
    pub tau: f64,
}

/// A law at the relative velocity `w` [m/s].
#[derive(Debug, Clone, Copy, Default)]
pub struct Response {
    /// Relative velocity [m/s].
    pub w: f64,
    /// Force [N].
    pub force: f64,
    /// Its slope over the relative velocity [N s/m].
    pub slope: f64,
    /// ζ or s [m]; 0 where there is none.
    pub internal: f64,
}

/// A law over a step in which the relative velocity is the same throughout.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stride {
    /// Mean force [N] and its slope over that velocity [N s/m], never below 0: force times way is what is stored and lost.
    pub mean: [f64; 2],
    /// Force at the end, and its slope.
    pub end: [f64; 2],
    /// ζ or s [m] at the end.
    pub internal: f64,
    /// Dissipated [J], from 0.
    pub lost: f64,
}

impl Law {
    /// The law over a step of `h` [s] that begins at the relative displacement `d` [m] with the internal variable `internal`,
    /// at the relative velocity `w` [m/s]. (I5) and (I7) know no time: along the straight way they are followed however far it goes.
    pub fn over(&self, [d, internal]: [f64; 2], w: f64, h: f64) -> Stride {
        let way = h * w;
        match self {
            Law::Power(law) => {
                let (force, slope) = law.at(w);
                Stride { mean: [force, slope], end: [force, slope], internal: 0.0, lost: force * way }
            }
            Law::BoucWen(law) => law.over(internal, w, h),
            Law::ReCentring(law) => law.over(d, internal, w, h),
        }
    }

    /// A slope over the relative velocity [N s/m] from which iterations over a step of `h` [s] cannot go round in circles: of (I5) and (I7) the
    /// largest that a mean force has, of (I1) the secant.
    pub fn steepest(&self, w: f64, h: f64) -> f64 {
        match self {
            Law::Power(law) => law.secant(w),
            Law::BoucWen(law) => {
                let most = law.power(law.limit(), law.sharpness);
                0.5 * h * law.force / law.displacement * (law.amplitude + most * (law.beta - law.gamma).max(0.0))
            }
            Law::ReCentring(law) => 0.5 * h * law.stiffness,
        }
    }

    /// The law at the end of a stage, as a function of the relative velocity alone.
    #[inline]
    pub fn respond(&self, w: f64, from: &Origin) -> Response {
        match self {
            Law::Power(law) => {
                let (force, slope) = law.at(w);
                Response { w, force, slope, internal: 0.0 }
            }
            Law::BoucWen(law) => {
                let (internal, slope) = law.step(w, from);
                Response { w, force: law.force * internal, slope: law.force * slope, internal }
            }
            Law::ReCentring(law) => {
                let d = from.d + from.tau * w;
                let (internal, moves) = law.settled(from.internal, d);
                let slope = if moves { 0.0 } else { from.tau * law.stiffness };
                Response { w, force: law.stiffness * (d - internal), slope, internal }
            }
        }
    }

    /// Force [N] at relative displacement, velocity and internal variable.
    #[inline]
    pub fn force(&self, d: f64, w: f64, internal: f64) -> f64 {
        match self {
            Law::Power(law) => law.at(w).0,
            Law::BoucWen(law) => law.force * internal,
            Law::ReCentring(law) => law.stiffness * (d - internal),
        }
    }

    /// Rate of the internal variable, where it has one [1/s].
    #[inline]
    pub fn rate(&self, w: f64, internal: f64) -> f64 {
        match self {
            Law::BoucWen(law) => law.rate(w, internal),
            Law::Power(_) | Law::ReCentring(_) => 0.0,
        }
    }

    /// Internal variable that the relative displacement `d` [m] allows, coming from `internal`.
    #[inline]
    pub fn settled(&self, internal: f64, d: f64) -> f64 {
        match self {
            Law::ReCentring(law) => law.settled(internal, d).0,
            Law::Power(_) | Law::BoucWen(_) => internal,
        }
    }

    /// Rate of dissipation [W], where it is one: of (I6) the way of s says it.
    #[inline]
    pub fn lost(&self, w: f64, internal: f64) -> f64 {
        match self {
            Law::Power(law) => law.at(w).0 * w,
            Law::BoucWen(law) => law.lost(w, internal),
            Law::ReCentring(_) => 0.0,
        }
    }

    /// Whether what it dissipates counts as damping.
    pub fn is_viscous(&self) -> bool {
        matches!(self, Law::Power(_))
    }

    /// Dissipated when the internal variable goes from `before` to `after` in one direction [J], where no rate says it.
    #[inline]
    pub fn spent(&self, before: f64, after: f64) -> f64 {
        match self {
            Law::ReCentring(law) => 0.5 * law.flag * law.stiffness * law.activation * (after - before).abs(),
            Law::Power(_) | Law::BoucWen(_) => 0.0,
        }
    }

    /// Elastic energy beyond that of the joint's spring [J].
    #[inline]
    pub fn stored(&self, d: f64, internal: f64) -> f64 {
        match self {
            Law::Power(_) => 0.0,
            Law::BoucWen(law) => 0.5 * law.force * law.displacement / law.amplitude * internal * internal,
            Law::ReCentring(law) => {
                let free = (1.0 - 0.5 * law.flag) * law.activation * internal.abs();
                law.stiffness * (0.5 * (d - internal) * (d - internal) + free)
            }
        }
    }

    /// Size of the forces [N]; 0 where there is none by which to measure them.
    #[inline]
    pub fn size(&self) -> f64 {
        match self {
            Law::Power(_) => 0.0,
            Law::BoucWen(law) => law.force,
            Law::ReCentring(law) => law.stiffness * law.activation,
        }
    }

    /// Stiffness at rest, beyond that of the joint's spring [N/m].
    pub fn initial_stiffness(&self) -> f64 {
        match self {
            Law::Power(_) => 0.0,
            Law::BoucWen(law) => law.force * law.amplitude / law.displacement,
            Law::ReCentring(law) => law.stiffness,
        }
    }

    /// d(force)/d(displacement) of a stage's tangent: what an error of the displacement alone does [N/m].
    #[inline]
    pub fn stiffness_of(&self, tangent: &Response, tau: f64) -> f64 {
        match self {
            Law::ReCentring(_) => tangent.slope / tau,
            Law::Power(_) | Law::BoucWen(_) => 0.0,
        }
    }

    /// Force of an error of the internal variable's integration [N]: the stage divides it by 1 − τ ∂ζ̇/∂ζ.
    #[inline]
    pub fn force_of(&self, error: f64, at: &Response, tau: f64) -> f64 {
        match self {
            Law::BoucWen(law) => law.force * error / (1.0 - tau * law.slope_of_rate(at.w, at.internal)),
            Law::Power(_) | Law::ReCentring(_) => 0.0,
        }
    }
}

impl Power {
    /// Force [N] and slope [N s/m].
    #[inline]
    fn at(&self, w: f64) -> (f64, f64) {
        let x = w / self.velocity;
        let square = x * x + SLOW * SLOW;
        let secant = self.secant(w);
        (secant * w, secant * (1.0 + (self.exponent - 1.0) * x * x / square))
    }

    /// Force over velocity [N s/m].
    #[inline]
    fn secant(&self, w: f64) -> f64 {
        let x = w / self.velocity;
        self.damping * (x * x + SLOW * SLOW).powf(0.5 * (self.exponent - 1.0))
    }
}

impl BoucWen {
    /// |ζ|^p.
    #[inline]
    fn power(&self, zeta: f64, p: f64) -> f64 {
        let size = zeta.abs();
        if p == 1.0 {
            size
        } else if p == 2.0 {
            size * size
        } else {
            size.powf(p)
        }
    }

    /// β sgn(w ζ) + γ.
    #[inline]
    fn shape(&self, w: f64, zeta: f64) -> f64 {
        if w * zeta < 0.0 { self.gamma - self.beta } else { self.gamma + self.beta }
    }

    /// (I5) [1/s].
    #[inline]
    fn rate(&self, w: f64, zeta: f64) -> f64 {
        w / self.displacement * (self.amplitude - self.power(zeta, self.sharpness) * self.shape(w, zeta))
    }

    /// ∂ζ̇/∂ζ [1/s]: never above 0.
    #[inline]
    fn slope_of_rate(&self, w: f64, zeta: f64) -> f64 {
        let n = self.sharpness;
        -(w / self.displacement * n * self.shape(w, zeta) * self.power(zeta, n - 1.0)).copysign(1.0)
    }

    /// |ζ| that no motion in one direction exceeds.
    pub fn limit(&self) -> f64 {
        (self.amplitude / (self.beta + self.gamma)).powf(1.0 / self.sharpness)
    }

    #[inline]
    fn lost(&self, w: f64, zeta: f64) -> f64 {
        self.force * self.power(zeta, self.sharpness) * (self.beta * (w * zeta).abs() + self.gamma * w * zeta)
            / self.amplitude
    }

    /// [`Law::over`]: pieces of the way by the midpoint rule, short enough for ζ to come to its limit from one side. What a piece stores and
    /// loses is its work to rounding.
    fn over(&self, start: f64, w: f64, h: f64) -> Stride {
        let way = h * w;
        let most = self.power(start.abs().max(self.limit()), self.sharpness - 1.0);
        let steep = self.sharpness * (self.beta + self.gamma.abs()) * most / self.displacement;
        let piece = (SHORT / steep).max(way.abs() / MOST_PIECES).copysign(way);
        let (mut zeta, mut worked, mut lost, mut left, mut force) = (start, 0.0, 0.0, way, start);
        // The last is what is left, so that the force goes with the way without jumps.
        while left.abs() > 0.0 {
            let part = if left.abs() > piece.abs() { piece } else { left };
            let (middle, rise) = self.step(part, &Origin { d: 0.0, internal: zeta, tau: 0.5 });
            zeta = 2.0 * middle - zeta;
            worked += middle * part;
            force = middle + part * rise;
            lost += self.lost(part, middle);
            left -= part;
        }
        let mean = if way.abs() > f64::MIN_POSITIVE / f64::EPSILON { worked / way } else { start };
        // What is no number stays one.
        let (zeta, mean) = if way.is_finite() { (zeta, mean) } else { (f64::NAN, f64::NAN) };
        // The sign of the way counts where it is 0, too.
        let rise = |zeta: f64| h * self.rate(1f64.copysign(w), zeta).abs();
        let bends = way.abs() > TINY * self.displacement;
        let slope = if bends { ((force - mean) / w).max(0.0) } else { 0.5 * rise(start) };
        let of = |zeta: f64, slope: f64| [self.force * zeta, self.force * slope];
        Stride { mean: of(mean, slope), end: of(zeta, rise(zeta)), internal: zeta, lost }
    }

    /// ζ = ζ_p + τ ζ̇(w, ζ) and dζ/dw. The residual grows with ζ, and its zero lies between ζ_p and the limit: Newton inside
    /// bisection.
    #[inline]
    fn step(&self, w: f64, from: &Origin) -> (f64, f64) {
        let (start, tau) = (from.internal, from.tau);
        let slope = |zeta: f64| {
            let drive =
                tau / self.displacement * (self.amplitude - self.power(zeta, self.sharpness) * self.shape(w, zeta));
            drive / (1.0 - tau * self.slope_of_rate(w, zeta))
        };
        if w == 0.0 || tau == 0.0 {
            return (start, slope(start));
        }
        let end = self.limit().copysign(w);
        let (mut low, mut high) = (start.min(end), start.max(end));
        let mut zeta = (start + tau * self.rate(w, start)).clamp(low, high);
        for _ in 0..MOST {
            let residual = zeta - start - tau * self.rate(w, zeta);
            if residual > 0.0 {
                high = zeta;
            } else {
                low = zeta;
            }
            let newton = zeta - residual / (1.0 - tau * self.slope_of_rate(w, zeta));
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let moved = (next - zeta).abs();
            zeta = next;
            if moved <= f64::EPSILON * zeta.abs() {
                break;
            }
        }
        (zeta, slope(zeta))
    }
}

impl ReCentring {
    /// [`Law::over`]: s is a straight line between the corners of the flag that lie on the way.
    fn over(&self, d: f64, internal: f64, w: f64, h: f64) -> Stride {
        let way = h * w;
        // Along the way upwards: backwards all is the same the other way round.
        let up = 1f64.copysign(way);
        let (from, to) = (up * d, up * (d + way));
        let start = up * self.settled(internal, d).0;
        let back = (1.0 - self.flag) * self.activation;
        // s stays until the flag takes it along: back to 0 below 0, forth beyond d_a.
        let at = |d: f64| start.max((d + back).min(0.0)).max(d - self.activation);
        let corners = if start < 0.0 { [start - back, -back] } else { [from; 2] };
        // Next to d, a way may be nothing.
        let mut mean = if to > from { 0.0 } else { start };
        let mut last = from;
        for corner in [corners[0], corners[1], self.activation + start.max(0.0), to] {
            let next = if corner >= to { to } else { corner.max(last) };
            if next > last {
                mean += 0.5 * (at(last) + at(next)) * ((next - last) / (to - from));
                last = next;
            }
        }
        // What is no number stays one.
        let mean = if way.is_finite() { self.stiffness * (d + 0.5 * way - up * mean) } else { f64::NAN };
        let (settled, moves) = self.settled(up * start, d + way);
        let force = self.stiffness * (d + way - settled);
        let most = 0.5 * h * self.stiffness;
        let slope = if !(to > from) { most } else { ((force - mean) / w).clamp(0.0, most) };
        let lost = 0.5 * self.flag * self.stiffness * self.activation * (settled - up * start).abs();
        let end = [force, if moves { 0.0 } else { 2.0 * most }];
        Stride { mean: [mean, slope], end, internal: settled, lost }
    }

    /// s at the relative displacement `d`, coming from `held` without a turn, and whether it moves with d there.
    #[inline]
    fn settled(&self, held: f64, d: f64) -> (f64, bool) {
        let forward = (d.abs() - self.activation).max(0.0).copysign(d);
        let back = (d.abs() - (1.0 - self.flag) * self.activation).max(0.0).copysign(d);
        let (low, high) = if d >= 0.0 { (forward, back) } else { (back, forward) };
        if held < low {
            (low, low != 0.0)
        } else if held > high {
            (high, high != 0.0)
        } else {
            (held, false)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use concio_verified::agrees;

    const HYSTERETIC: BoucWen =
        BoucWen { force: 1e3, displacement: 1e-3, amplitude: 1.0, beta: 0.6, gamma: 0.3, sharpness: 3.0 };

    fn laws() -> [Law; 5] {
        [
            Law::Power(Power { damping: 2e3, velocity: 0.1, exponent: 0.3 }),
            Law::BoucWen(HYSTERETIC),
            Law::BoucWen(BoucWen { sharpness: 1.0, gamma: -0.4, ..HYSTERETIC }),
            Law::BoucWen(BoucWen { sharpness: 40.0, amplitude: 2.0, ..HYSTERETIC }),
            Law::ReCentring(ReCentring { stiffness: 2e6, activation: 1e-3, flag: 0.8 }),
        ]
    }

    /// The tangent of a stage is the derivative of its force, which never falls; ζ solves its equation.
    #[test]
    fn the_tangent_of_a_stage_is_its_derivative() {
        for law in laws() {
            for internal in [-6e-4, 0.0, 4e-4] {
                for tau in [1e-5, 1e-3, 0.1] {
                    // ζ is of the size of 1, s of that of d_a.
                    let internal = if matches!(law, Law::BoucWen(_)) { 1e3 * internal } else { internal };
                    let from = Origin { d: 3e-4, internal, tau };
                    for w in [-3.0, -0.11, -2e-3, 1e-5, 0.07, 1.3] {
                        let (at, h) = (law.respond(w, &from), 1e-6 * w);
                        let near = [law.respond(w - h, &from), law.respond(w + h, &from)];
                        let difference = (near[1].force - near[0].force) / (2.0 * h);
                        let scale = at.slope.abs() + at.force.abs() / w.abs();
                        assert!((difference - at.slope).abs() <= 1e-5 * scale, "{law:?} at {w} from {from:?}");
                        assert!(at.slope >= 0.0);
                        if let Law::BoucWen(bw) = law {
                            let residual = at.internal - internal - tau * bw.rate(w, at.internal);
                            let terms = 1.0 + tau * w.abs() / bw.displacement * bw.sharpness;
                            assert!(residual.abs() < 1e-14 * terms, "{residual:e} at {w} from {from:?}, {law:?}");
                        }
                    }
                }
            }
        }
    }

    /// Along any path what is stored and lost is the work done: a fine walk of small steps.
    #[test]
    fn stored_and_lost_are_the_work() {
        let names = ["Bouc–Wen, n = 3", "Bouc–Wen, n = 1, γ < 0", "Bouc–Wen, n = 40", "re-centring"];
        for (law, name) in laws()[1..].iter().zip(names) {
            let (mut d, mut internal, mut work, mut lost) = (0.0f64, 0.0, 0.0, 0.0);
            let n = 200_000;
            let tau = 1.0 / f64::from(n);
            for k in 0..n {
                let t = (f64::from(k) + 0.5) * tau;
                let next = 4e-3 * t.sqrt() * (20.0 * (t + 0.5 * tau)).sin();
                let w = (next - d) / tau;
                let from = Origin { d, internal, tau };
                let before = law.force(d, w, internal);
                let found = law.respond(w, &from);
                work += 0.5 * (before + found.force) * (next - d);
                lost += law.spent(internal, found.internal);
                lost += 0.5 * tau * (law.lost(w, internal) + law.lost(w, found.internal));
                (d, internal) = (next, found.internal);
            }
            let stored = law.stored(d, internal);
            assert!(lost > 0.0 && stored > 0.0);
            let subject = format!("Devices: laws with a memory, energy stored and lost along a growing swing; {name}");
            agrees!(subject, "work of the force in 200,000 steps", "J", stored + lost, work, 2e-4);
        }
    }

    /// Ways of nothing or next to it, from what a flag has taken along by rounding: forces are those of the start, no slope is steeper than the
    /// steepest, and what is no number is told as none.
    #[test]
    fn the_shortest_ways_bear_what_the_start_does() {
        for law in laws() {
            for internal in [-0.6, 0.0, 0.4f64] {
                let internal = if matches!(law, Law::ReCentring(_)) { 1e-3 * internal } else { internal };
                for off in [0.0, 1e-18, -1e-9, 1e-9] {
                    let d = internal + 1e-3 * internal.signum() + off;
                    for w in [0.0, 5e-324, 1e-300, 1e-17, -1e-20, 1e-12, -1e-12, 1e-9, -1e-6] {
                        let (stride, start) = (law.over([d, internal], w, 1e-3), law.force(d, w, internal));
                        let near = 1e-2 * law.steepest(w, 1e-3) * 1e-6 + law.initial_stiffness() * 2e-9;
                        assert!(
                            (stride.mean[0] - start).abs() <= near,
                            "{law:?} {internal} {off} {w}: {stride:?} {start}"
                        );
                        assert!(
                            (stride.end[0] - start).abs() <= near,
                            "{law:?} {internal} {off} {w}: {stride:?} {start}"
                        );
                        assert!(
                            stride.mean[1] >= 0.0 && stride.mean[1] <= law.steepest(w, 1e-3) * (1.0 + 1e-9),
                            "{stride:?}"
                        );
                        assert!(stride.lost >= 0.0);
                    }
                }
                assert!(law.over([1e-4, internal], f64::NAN, 1e-3).mean[0].is_nan(), "{law:?}");
            }
        }
    }

    /// The force over a step is the work over the way, its slope the derivative, and nothing is made of nothing, however far a step
    /// goes: many short steps come to the same.
    #[test]
    fn a_stride_does_the_work_of_its_way() {
        for law in laws() {
            for internal in [-0.5, 0.0, 0.3f64] {
                let internal = if matches!(law, Law::ReCentring(_)) { 1e-3 * internal } else { internal };
                // What a device can have come to.
                let from = match law {
                    Law::ReCentring(law) => [internal + 0.7 * law.activation * internal.signum(), internal],
                    _ => [2e-4, internal],
                };
                for w in [-4.0, -0.2, -1e-3, 2e-4, 0.05, 0.9] {
                    let h = 4e-3;
                    let whole = law.over(from, w, h);
                    let (next, bend) = (1e-6 * w, law.over(from, w, h).mean[0].abs() / w.abs());
                    let near = [law.over(from, w - next, h).mean[0], law.over(from, w + next, h).mean[0]];
                    let slope = (near[1] - near[0]) / (2.0 * next);
                    assert!(
                        (slope - whole.mean[1]).abs() < 1e-2 * (slope.abs() + bend),
                        "{law:?} {from:?} {w}: {slope} {whole:?}"
                    );
                    assert!(whole.lost >= 0.0 && whole.mean[1] >= 0.0 && whole.end[1] >= 0.0);
                    let stored = law.stored(from[0] + h * w, whole.internal) - law.stored(from[0], from[1]);
                    let work = whole.mean[0] * h * w;
                    assert!((stored + whole.lost - work).abs() < 1e-9 * (stored.abs() + whole.lost), "{law:?} {w}");
                    let (mut at, mut worked) = (from, 0.0);
                    for _ in 0..500 {
                        let piece = law.over(at, w, h / 500.0);
                        worked += piece.mean[0] * h / 500.0 * w;
                        at = [at[0] + h / 500.0 * w, piece.internal];
                    }
                    let scale = work.abs().max(law.size() * (h * w).abs());
                    assert!((worked - work).abs() < 1e-2 * scale, "{law:?} {from:?} {w}: {worked} {work}");
                    assert!(whole.mean[1] <= law.steepest(w, h) * (1.0 + 1e-9), "{law:?} {from:?} {w}");
                }
            }
        }
    }
}
