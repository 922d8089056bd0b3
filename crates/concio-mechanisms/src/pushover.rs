//! A mechanism followed through large turns, and the oscillator that stands for it.
//!
//! a = α g/(e* FC), d = d_C Σ(P+Q)δ²/(δ_C Σ(P+Q)δ), e* = [Σ(P+Q)δ]²/( Σ(P+Q) Σ(P+Q)δ² )
//!
//! Source: Circolare, (C8.7.1.3) to (C8.7.1.5). δ are velocities of the masses per turn, at rest; δ_C that of the control point, d_C its
//! displacement. Sums run over blocks with their resultants: one block alone has e* = 1. Masses that the mechanism holds at rest, such as
//! what lies on a vertical arch, are left out: they would raise a. FC divides the capacity.
//!
//! α(d) comes from exact kinematics, α = Σ of (OP1) in the displaced shape; for one body without loads it is tan(α_s − θ), tan α_s = t/h.

use crate::G;
use crate::body::Body;
use crate::horizontal_arch::HorizontalArch;
use crate::vertical_arch::VerticalArch;

/// What moves.
#[derive(Debug, Clone, PartialEq)]
pub enum Kinematics {
    /// One body, with its control point so far from the hinge, in the plane of the wall [m].
    Body(Body, f64),
    /// Two bodies between levels that hold; the control point is the hinge at the inner face.
    VerticalArch(VerticalArch),
    /// Two bodies between abutments; the control point is the inner edge of the crack.
    HorizontalArch(HorizontalArch),
}

/// A point of a pushover curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// θ [rad].
    pub turn: f64,
    /// d_C [m].
    pub control: f64,
    /// d [m] of the oscillator.
    pub displacement: f64,
    /// α, ties and friction by their laws.
    pub multiplier: f64,
    /// α of what surely acts till collapse.
    pub sure: f64,
}

/// A mechanism as an oscillator.
#[derive(Debug, Clone, PartialEq)]
pub struct Pushover {
    /// What moves.
    pub kinematics: Kinematics,
    /// α0.
    pub multiplier: f64,
    /// e*, above 0 and up to 1.
    pub participation: f64,
    /// d/d_C at small turns.
    pub part: f64,
    /// θ0 [rad]: where what surely acts no longer holds; 0 where it never does.
    pub last_turn: f64,
    /// d0 [m] there.
    pub last: f64,
    /// d [m] at which ties or friction end and α drops by more than half; none where they never do before d0.
    pub drop: Option<f64>,
}

/// The curve of joints that are not sharp: a slope up to Δ1, a plateau up to Δ2, and from there the one of rigid blocks.
///
/// Source: K. Doherty, M. C. Griffith, N. Lam and J. Wilson, Earthquake Engineering and Structural Dynamics 31 (2002) 833–850 (abstract):
/// Δ1 and Δ2 are parts of the displacement at which the wall falls, here d0, that depend on the state of the joints and on nothing else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trilinear {
    /// Δ1 and Δ2 [m] of the oscillator.
    pub ends: [f64; 2],
    /// α of the plateau: that of rigid blocks at Δ2.
    pub plateau: f64,
}

/// Points of a curve between rest and d0.
const POINTS: usize = 60;
/// How close to an end of a tie its curve has points.
const BESIDE: f64 = 1e-9;

impl Kinematics {
    /// α at turn θ [rad]; none beyond what the mechanism can reach.
    pub fn at(&self, turn: f64) -> Option<f64> {
        match self {
            Kinematics::Body(body, _) => Some(body.at(turn)),
            Kinematics::VerticalArch(arch) => arch.at(turn),
            Kinematics::HorizontalArch(arch) => arch.at(turn),
        }
    }

    /// α at turn θ [rad] of what surely acts till collapse.
    pub fn sure(&self, turn: f64) -> Option<f64> {
        match self {
            Kinematics::Body(body, _) => Some(body.sure(turn)),
            Kinematics::VerticalArch(arch) => arch.sure(turn),
            Kinematics::HorizontalArch(arch) => arch.sure(turn),
        }
    }

    /// d_C [m].
    pub fn control(&self, turn: f64) -> f64 {
        match self {
            Kinematics::Body(body, height) => body.displacement(*height, turn),
            Kinematics::VerticalArch(arch) => arch.bulge(turn),
            Kinematics::HorizontalArch(arch) => arch.bulge(turn),
        }
    }

    fn multiplier(&self) -> f64 {
        match self {
            Kinematics::Body(body, _) => body.multiplier(),
            Kinematics::VerticalArch(arch) => arch.multiplier(),
            Kinematics::HorizontalArch(arch) => arch.multiplier(),
        }
    }

    fn last_turn(&self) -> f64 {
        match self {
            Kinematics::Body(body, _) => body.last_turn(),
            Kinematics::VerticalArch(arch) => arch.last_turn(),
            Kinematics::HorizontalArch(arch) => arch.last_turn(),
        }
    }

    /// δ_C [m].
    fn control_rate(&self) -> f64 {
        match self {
            Kinematics::Body(_, height) => *height,
            Kinematics::VerticalArch(arch) => arch.hinge,
            Kinematics::HorizontalArch(arch) => arch.spans[0],
        }
    }

    fn masses(&self) -> Vec<[f64; 2]> {
        match self {
            Kinematics::Body(body, _) => body.masses(),
            Kinematics::VerticalArch(arch) => arch.masses(),
            Kinematics::HorizontalArch(arch) => arch.masses(),
        }
    }

    fn ends(&self) -> Vec<f64> {
        match self {
            Kinematics::Body(body, _) => body.ends(),
            _ => Vec::new(),
        }
    }
}

impl Pushover {
    /// Of a mechanism.
    pub fn of(kinematics: Kinematics) -> Pushover {
        let masses = kinematics.masses();
        let sum = |power: i32| masses.iter().map(|[weight, rate]| weight * rate.powi(power)).sum::<f64>();
        let (whole, first, second) = (sum(0), sum(1), sum(2));
        let last_turn = kinematics.last_turn();
        let part = second / (kinematics.control_rate() * first);
        let mut found = Pushover {
            multiplier: kinematics.multiplier(),
            participation: first * first / (whole * second),
            part,
            last_turn,
            last: part * kinematics.control(last_turn),
            drop: None,
            kinematics,
        };
        found.drop = found.dropped();
        found
    }

    /// a [m/s²] that a multiplier stands for, divided by the confidence factor.
    pub fn acceleration(&self, multiplier: f64, confidence: f64) -> f64 {
        multiplier * G / (self.participation * confidence)
    }

    /// Turn [rad] at a displacement d [m] of the oscillator, up to a right angle.
    pub fn turn_at(&self, displacement: f64) -> f64 {
        let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if self.part * self.kinematics.control(middle) < displacement { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// α(d), 0 beyond what the mechanism can reach.
    pub fn at(&self, displacement: f64) -> f64 {
        self.kinematics.at(self.turn_at(displacement)).unwrap_or(0.0)
    }

    /// The trilinear curve whose plateau ends at these parts of d0, rising, above 0 and below 1; none where nothing stands by itself.
    pub fn trilinear(&self, parts: [f64; 2]) -> Option<Trilinear> {
        let ends = parts.map(|part| part * self.last);
        let plateau = self.at(ends[1]);
        (self.last > 0.0 && plateau > 0.0).then_some(Trilinear { ends, plateau })
    }

    /// α at a displacement [m] of the oscillator on such a curve.
    pub fn at_trilinear(&self, curve: &Trilinear, displacement: f64) -> f64 {
        match displacement {
            d if d < curve.ends[0] => curve.plateau * d / curve.ends[0],
            d if d < curve.ends[1] => curve.plateau,
            d => self.at(d),
        }
    }

    /// The curve from rest to d0, or as far as ties and friction hold where that is farther.
    pub fn curve(&self) -> Vec<Point> {
        let farthest = self.kinematics.ends().last().map_or(self.last_turn, |end| self.last_turn.max(1.02 * end));
        // Where nothing stands by itself a few degrees show what ties do.
        let farthest = if farthest > 0.0 { farthest } else { 0.1 };
        let mut turns: Vec<f64> = (0..=POINTS).map(|i| farthest * i as f64 / POINTS as f64).collect();
        turns.extend(self.kinematics.ends().iter().flat_map(|end| [end * (1.0 - BESIDE), end * (1.0 + BESIDE)]));
        turns.sort_by(f64::total_cmp);
        let point = |turn: f64| {
            let control = self.kinematics.control(turn);
            let (multiplier, sure) = (self.kinematics.at(turn)?, self.kinematics.sure(turn)?);
            Some(Point { turn, control, displacement: self.part * control, multiplier, sure })
        };
        turns.into_iter().filter_map(point).collect()
    }

    fn dropped(&self) -> Option<f64> {
        let at = |turn: f64| self.kinematics.at(turn).unwrap_or(0.0);
        let halves = |end: &f64| at(end * (1.0 + BESIDE)) < 0.5 * at(end * (1.0 - BESIDE));
        let end = self.kinematics.ends().into_iter().find(halves)?;
        Some(self.part * self.kinematics.control(end)).filter(|d| *d < self.last)
    }
}
