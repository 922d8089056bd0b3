//! Safety checks of a mechanism in the form of the Italian code.
//!
//! Source: Circolare, C8.7.1.2.1.5 to C8.7.1.2.1.8, and the spectrum of NTC 2018, 3.2.3.2:
//!
//! S_e(T, ξ) = a_g S η F0 [ T/T_B + (1 − T/T_B)/(η F0) ], a_g S η F0, · T_C/T, · T_C T_D/T², η = √(10/(5 + ξ)) ≥ 0.55,
//!
//! T_B = T_C/3, T_D = 4 a_g/g + 1.6 s, S_De = S_e T²/4π².
//!
//! - Damage (SLD): a = α0 g/(e* FC) against a_g S on the ground, against a_Z(z) aloft; S_eZ(T_0, 5 %) where a part vibrates freely and a
//!   floor spectrum is given.
//! - Life safety (SLV), linear: q times that, q = 2.
//! - By displacement: d_SLV = 0.4 d0 on the curve of what surely acts till collapse, or where ties end and α drops by more than half if that
//!   is less; d_SLC = 0.6 d0, or where beams lose their seat. T = 1.68 π √(d_SLV/a(d_SLV)) with ξ = 8 %, 1.56 π √(d_SLC/a(d_SLC)) with 10 %.
//! - Aloft, (C7.2.5) to (C7.2.10): a_Z = S_e(T_1, ξ_1) |γ_1 ψ_1(z)| √(1 + 0.0004 ξ_1²), ξ_1 in per cent; here no less than a_g S.
//!
//! The amplification of a_Z into a floor spectrum S_eZ is unclear at its source and not coded: checks that need it take a spectrum that is
//! given, and say so where there is none.

use std::f64::consts::PI;
use std::fmt;

use crate::G;
use crate::pushover::Pushover;

/// FC of knowledge level LC1; also the one to take whenever crushing is left out.
pub const LOWEST_KNOWLEDGE: f64 = 1.35;
/// q of the linear check for life safety.
pub const BEHAVIOUR: f64 = 2.0;
/// ξ [%] of the oscillator at life safety and at collapse prevention.
const DAMPING: [f64; 2] = [8.0, 10.0];

/// An elastic spectrum.
#[derive(Debug, Clone, PartialEq)]
pub enum Spectrum {
    /// That of the code.
    Code(Site),
    /// Given at 5 %: periods [s], from 0 and rising, and accelerations [m/s²], from 0. Straight between them; beyond the last the
    /// displacement stays. Other dampings by η.
    Columns(Vec<[f64; 2]>),
}

/// Parameters of the spectrum of the code.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// a_g [m/s²], above 0.
    pub ground: f64,
    /// S, above 0: soil and topography.
    pub soil: f64,
    /// F0, above 0.
    pub amplification: f64,
    /// T_C [s], above 0: C_C T_C*.
    pub corner: f64,
}

/// η of a damping ξ in per cent.
pub fn damping_factor(damping: f64) -> f64 {
    (10.0 / (5.0 + damping)).sqrt().max(0.55)
}

impl Spectrum {
    /// S_e [m/s²] at a period [s], from 0, and damping in per cent.
    pub fn acceleration(&self, period: f64, damping: f64) -> f64 {
        let factor = damping_factor(damping);
        match self {
            Spectrum::Code(site) => site.acceleration(period, factor),
            Spectrum::Columns(points) => factor * interpolated(points, period),
        }
    }

    /// S_De [m].
    pub fn displacement(&self, period: f64, damping: f64) -> f64 {
        self.acceleration(period, damping) * (period / (2.0 * PI)).powi(2)
    }

    /// a_g S [m/s²]: S_e at T = 0, which no damping changes.
    pub fn peak(&self) -> f64 {
        match self {
            Spectrum::Code(site) => site.ground * site.soil,
            Spectrum::Columns(points) => points.first().map_or(0.0, |p| p[1]),
        }
    }
}

impl Site {
    fn acceleration(&self, period: f64, factor: f64) -> f64 {
        let plateau = self.ground * self.soil * factor * self.amplification;
        let (rise, fall) = (self.corner / 3.0, self.corner);
        let far = 4.0 * self.ground / G + 1.6;
        if period < rise {
            let part = period / rise;
            plateau * (part + (1.0 - part) / (factor * self.amplification))
        } else if period < fall {
            plateau
        } else if period < far {
            plateau * fall / period
        } else {
            plateau * fall * far / (period * period)
        }
    }
}

fn interpolated(points: &[[f64; 2]], period: f64) -> f64 {
    let after = points.iter().position(|p| p[0] >= period);
    match (after, points) {
        (_, []) => 0.0,
        (Some(0), _) => points[0][1],
        (Some(i), _) => {
            let ([a, from], [b, to]) = (points[i - 1], points[i]);
            from + (to - from) * (period - a) / (b - a)
        }
        (None, [.., [last, value]]) => value * (last / period).powi(2),
    }
}

/// A building whose floors shake a mechanism aloft.
#[derive(Debug, Clone, PartialEq)]
pub struct Building {
    /// H [m], above 0.
    pub height: f64,
    /// Storeys, from 1.
    pub storeys: usize,
    /// T_1 [s], above 0.
    pub period: f64,
    /// ξ_1 in per cent, from 0.
    pub damping: f64,
    /// γ_1, above 0.
    pub participation: f64,
}

impl Building {
    /// Of regular masses and a straight mode: T_1 = 0.05 H^0.75, γ_1 = 3n/(2n + 1), ξ_1 = 5 %.
    pub fn regular(height: f64, storeys: usize) -> Building {
        let n = storeys as f64;
        Building {
            height,
            storeys,
            period: 0.05 * height.powf(0.75),
            damping: 5.0,
            participation: 3.0 * n / (2.0 * n + 1.0),
        }
    }

    /// ψ_1(z) = z/H, up to 1.
    pub fn shape(&self, level: f64) -> f64 {
        (level / self.height).clamp(0.0, 1.0)
    }

    /// a_Z [m/s²] of the first mode at a level [m], on the ground spectrum.
    pub fn acceleration(&self, level: f64, ground: &Spectrum) -> f64 {
        let mode = ground.acceleration(self.period, self.damping) * (self.participation * self.shape(level)).abs();
        mode * (1.0 + 0.0004 * self.damping * self.damping).sqrt()
    }
}

/// Where a mechanism has its hinge.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    /// On the ground.
    Ground,
    /// At a level [m] of a building, with the floor spectrum there where one is given.
    Aloft {
        /// z [m].
        level: f64,
        /// The building.
        building: Building,
        /// S_eZ there.
        floor: Option<Spectrum>,
    },
}

/// Spectra of the limit states; those that are not given are not checked.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hazard {
    /// SLD.
    pub damage: Option<Spectrum>,
    /// SLV.
    pub life: Option<Spectrum>,
    /// SLC.
    pub collapse: Option<Spectrum>,
}

/// What is asked of a mechanism.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// Spectra of the ground.
    pub hazard: Hazard,
    /// Where it has its hinge.
    pub place: Place,
    /// FC, from 1.
    pub confidence: f64,
    /// q, from 1.
    pub behaviour: f64,
    /// d [m] of the oscillator at which the first beam loses its seat; none: unknown, or none does.
    pub seat: Option<f64>,
    /// T_0 [s] of the part before it cracks, which bounds the search in given spectra from below; 0 where it is not known.
    pub first_period: f64,
    /// Whether the part vibrates freely before it cracks, as parapets and gables do: aloft its damage is checked against S_eZ(T_0) then.
    pub free: bool,
}

/// A check by forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linear {
    /// What the mechanism bears [m/s²], q included.
    pub capacity: f64,
    /// What shakes it [m/s²]: a_g S, a_Z, or S_eZ(T_0) of a part that vibrates freely.
    pub demand: f64,
}

/// A check by displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ByDisplacement {
    /// d_SLV or d_SLC [m].
    pub capacity: f64,
    /// a there [m/s²].
    pub acceleration: f64,
    /// Secant period [s].
    pub period: f64,
    /// S_De there [m].
    pub demand: f64,
    /// Capacity over demand; where the linear check for damage bears more, that: a_g,SLV is no less than a_g,SLD.
    pub ratio: f64,
    /// Whether that is so.
    pub by_damage: bool,
}

impl Linear {
    /// Capacity over demand.
    pub fn ratio(&self) -> f64 {
        self.capacity / self.demand
    }
}

/// Why a check is not made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// No hazard of this limit state.
    Hazard,
    /// No floor spectrum; the amplification of the code is unclear at its source.
    FloorSpectrum,
    /// Nothing stands by itself: d0 is 0.
    Stands,
    /// α at the displacement is not above 0.
    Capacity,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Missing::Hazard => "no hazard is given for this limit state",
            Missing::FloorSpectrum => {
                "aloft it needs a floor spectrum S_eZ: the amplification of the code is unclear at its source, so give one"
            }
            Missing::Stands => "the wall does not stand by itself: ties or friction alone hold it",
            Missing::Capacity => "α at this displacement is not above 0",
        })
    }
}

/// All checks of a mechanism.
#[derive(Debug, Clone, PartialEq)]
pub struct Checks {
    /// a* = α0 g/(e* FC) [m/s²].
    pub acceleration: f64,
    /// SLD.
    pub damage: Result<Linear, Missing>,
    /// SLV by forces.
    pub life: Result<Linear, Missing>,
    /// SLV by displacements.
    pub life_displacement: Result<ByDisplacement, Missing>,
    /// SLC by displacements.
    pub collapse: Result<ByDisplacement, Missing>,
}

impl Checks {
    /// Of a mechanism.
    pub fn of(pushover: &Pushover, asked: &Asked) -> Checks {
        let acceleration = pushover.acceleration(pushover.multiplier, asked.confidence);
        let linear = |spectrum: &Option<Spectrum>, times: f64| {
            let ground = spectrum.as_ref().ok_or(Missing::Hazard)?;
            Ok(Linear { capacity: times * acceleration, demand: asked.place.demand(ground) })
        };
        let life = asked.drop(0.4 * pushover.last, pushover.drop);
        let collapse = asked.drop(0.6 * pushover.last, asked.seat);
        let by = |hazard: &Option<Spectrum>, capacity: f64, factor: f64, damping: f64| {
            asked.by_displacement(pushover, hazard, capacity, factor, damping)
        };
        Checks {
            acceleration,
            damage: linear(&asked.hazard.damage, 1.0).map(|l| Linear { demand: l.demand.max(asked.vibrates()), ..l }),
            life: linear(&asked.hazard.life, asked.behaviour),
            life_displacement: by(&asked.hazard.life, life, 1.68, DAMPING[0]),
            collapse: by(&asked.hazard.collapse, collapse, 1.56, DAMPING[1]),
        }
    }

    /// The better of both ratios for life safety, by which the check counts: either suffices.
    pub fn ratio(&self) -> Option<f64> {
        let linear = self.life.ok().map(|l| l.ratio());
        let displacement = self.life_displacement.ok().map(|d| d.ratio);
        [linear, displacement].into_iter().flatten().reduce(f64::max)
    }
}

impl Asked {
    /// S_eZ(T_0, 5 %) [m/s²] of a part that vibrates freely aloft; 0 of others, and without its spectrum.
    fn vibrates(&self) -> f64 {
        match &self.place {
            Place::Aloft { floor: Some(floor), .. } if self.free => floor.acceleration(self.first_period, 5.0),
            _ => 0.0,
        }
    }

    fn drop(&self, usual: f64, other: Option<f64>) -> f64 {
        other.map_or(usual, |d| d.min(usual))
    }

    fn by_displacement(
        &self,
        pushover: &Pushover,
        hazard: &Option<Spectrum>,
        capacity: f64,
        factor: f64,
        damping: f64,
    ) -> Result<ByDisplacement, Missing> {
        let ground = hazard.as_ref().ok_or(Missing::Hazard)?;
        if capacity <= 0.0 {
            return Err(Missing::Stands);
        }
        // At a drop the curve counts before it.
        let before = capacity * (1.0 - 1e-8);
        let acceleration = pushover.acceleration(pushover.at(before), self.confidence);
        if acceleration <= 0.0 {
            return Err(Missing::Capacity);
        }
        let period = factor * PI * (capacity / acceleration).sqrt();
        let demand = self.place.displacement(ground, period, damping, self.first_period)?;
        let ratio = capacity / demand;
        let damage = pushover.acceleration(pushover.multiplier, self.confidence) / self.place.demand(ground);
        Ok(ByDisplacement {
            capacity,
            acceleration,
            period,
            demand,
            ratio: ratio.max(damage),
            by_damage: damage > ratio,
        })
    }
}

impl Place {
    /// a_g S or a_Z [m/s²].
    fn demand(&self, ground: &Spectrum) -> f64 {
        match self {
            Place::Ground => ground.peak(),
            // The first mode alone goes to 0 at the base, where the ground itself shakes the wall.
            Place::Aloft { level, building, .. } => building.acceleration(*level, ground).max(ground.peak()),
        }
    }

    /// S_De [m] at a period; of given spectra the largest from `first` on.
    fn displacement(&self, ground: &Spectrum, period: f64, damping: f64, first: f64) -> Result<f64, Missing> {
        match self {
            Place::Ground => Ok(largest(ground, period, damping, first)),
            Place::Aloft { floor: None, .. } => Err(Missing::FloorSpectrum),
            Place::Aloft { floor: Some(floor), building, .. } => {
                let own = largest(floor, period, damping, first);
                let first = building.period;
                // b of the code: beyond b T_1 the displacement does not fall below that of the mode.
                let least = floor.acceleration(first, damping) * (1.1 * first / (2.0 * PI)).powi(2);
                Ok(if period > 1.1 * first { own.max(least) } else { own })
            }
        }
    }
}

/// S_De at a period, or the largest of a spectrum of records between T_0 and that period.
fn largest(spectrum: &Spectrum, period: f64, damping: f64, first: f64) -> f64 {
    let at = |t: f64| spectrum.displacement(t, damping);
    match spectrum {
        Spectrum::Code(_) => at(period),
        Spectrum::Columns(points) => {
            let inside = points.iter().map(|p| p[0]).filter(|t| (first..=period).contains(t));
            inside.map(at).fold(at(period), f64::max)
        }
    }
}

/// T_0 [s] of a part that is free to vibrate before it cracks: κ λ L √(γ/(E g)), λ = L/t.
///
/// `length` L and `thickness` t [m], `specific_weight` γ [N/m³], `modulus` E [Pa], all above 0. Held at both ends or a cantilever: a parapet,
/// a gable.
pub fn first_period(length: f64, thickness: f64, specific_weight: f64, modulus: f64, cantilever: bool) -> f64 {
    let factor = if cantilever { 6.2 } else { 2.2 };
    factor * length * length / thickness * (specific_weight / (modulus * G)).sqrt()
}
