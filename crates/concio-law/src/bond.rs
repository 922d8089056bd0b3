//! Bonded joints: elastic while intact, cracked joints of their law afterwards (theory, section 3).
//!
//!   (B1)  F = k [1 − (1 − η) D] δ + χ N μ(δ̇),   D, χ = 0 intact … 1 broken
//!   (B2)  F_0 = c A + N tan φ of bed and support joints, f_t A of head joints and connections, which are bonded
//!         against opening alone and keep F^el of their law in compression
//!   (B3)  D = 1 − (δ_0/δ_m) (1 − χ),   χ = 1 − e^{−(δ_m − δ_0)/δ_c},   δ_m = max |δ| so far,   δ_0 = F_0/k;
//!         brittle: D = χ = 1 from δ_0 on
//!   (B4)  G_f A = (1 − η) F_0 [½ δ_0 + (1 − ε) δ_c],   the work done on a joint that is opened for good
//!
//!   (B5)  |F| ≤ (1 − χ) (c A + N tan φ) + χ N μ_s   of bed and support joints, η = 0, (4) left out
//!
//! A part of the joint is cracked and rubs, the rest is elastic (Alfano & Sacco 2006); strengths, exponential softening and
//! how friction takes the place of what is lost of the strength are those of the interface of Lourenço & Rots (1997), with
//! secant unloading instead of plastic slip. The part that rubs is χ and not D: D, which leads the loss of strength by
//! the way δ_m/δ_0, would let friction add to a strength that is still there.

use serde::{Deserialize, Serialize};

use crate::elementary::exp_of_negative;

/// ε: a softening bond that bears no more than this fraction of its strength is broken.
const BROKEN: f64 = 1e-3;

/// Law of a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bond {
    /// F_0 [N], above 0.
    pub strength: f64,
    /// k of the intact joint [N/m], above 0.
    pub stiffness: f64,
    /// η, 0 … 1: fraction of it that a cracked joint keeps.
    pub residual: f64,
    /// δ_c [m], above 0; 0 for a brittle bond.
    pub decay: f64,
    /// Bonded against opening alone: head joints and connections.
    pub opens: bool,
}

impl Bond {
    /// A bond that takes `energy` = G_f A [J] to break; 0 for a brittle one. None when the energy is below
    /// [`Bond::least_energy`].
    pub fn new(strength: f64, stiffness: f64, residual: f64, energy: f64, opens: bool) -> Option<Self> {
        let brittle = Bond { strength, stiffness, residual, decay: 0.0, opens };
        if energy == 0.0 {
            return Some(brittle);
        }
        let beyond = energy - brittle.least_energy();
        let decay = beyond / ((1.0 - residual) * strength * (1.0 - BROKEN));
        (decay > 0.0 && decay.is_finite()).then_some(Bond { decay, ..brittle })
    }

    /// What the part of the joint that breaks stores at its strength [J]: with less, it would snap back.
    pub fn least_energy(&self) -> f64 {
        0.5 * (1.0 - self.residual) * self.strength * self.limit()
    }

    /// G_f A by (B4) [J], of a brittle bond what it stores at its strength.
    pub fn energy(&self) -> f64 {
        self.least_energy() + (1.0 - self.residual) * self.strength * (1.0 - BROKEN) * self.decay
    }

    /// δ_0 [m].
    pub fn limit(&self) -> f64 {
        self.strength / self.stiffness
    }

    /// Whether it breaks at once.
    pub fn is_brittle(&self) -> bool {
        self.decay == 0.0
    }

    /// How far a relative displacement `d` = x_a − x_b [m] strains the bond: |δ|, or the gap.
    #[inline]
    pub fn stretch(&self, d: f64) -> f64 {
        if self.opens { (-d).max(0.0) } else { d.abs() }
    }

    /// D and χ by (B3) of a softening bond at the stretch `reach` [m], each with its slope [1/m]; the curves go on where the
    /// bond counts as broken.
    #[inline]
    pub fn worn(&self, reach: f64) -> [(f64, f64); 2] {
        let limit = self.limit();
        if reach <= limit {
            return [(0.0, 0.0); 2];
        }
        let left = self.left(reach);
        let intact = limit / reach * left;
        [(1.0 - intact, intact * (1.0 / reach + 1.0 / self.decay)), (1.0 - left, left / self.decay)]
    }

    /// D alone.
    #[inline]
    pub fn damage(&self, reach: f64) -> f64 {
        self.worn(reach)[0].0
    }

    /// 1 − χ of a softening bond beyond δ_0.
    #[inline]
    fn left(&self, reach: f64) -> f64 {
        exp_of_negative((reach - self.limit()) / self.decay)
    }

    /// χ of a bond in the state `held`.
    #[inline]
    pub fn rubbing(&self, held: &BondState) -> f64 {
        if self.is_brittle() || held.damage == 1.0 { held.damage } else { self.worn(held.reach)[1].0 }
    }

    /// D where the joint is displaced by `d` [m] inside a step that began with the damage `held`; a brittle bond keeps it.
    #[inline]
    pub fn damage_at(&self, held: f64, d: f64) -> f64 {
        if self.is_brittle() { held } else { held.max(self.damage(self.stretch(d))) }
    }

    /// Whether a softening bond that was stretched by `reach` [m] bears next to nothing any more.
    pub fn is_broken(&self, reach: f64) -> bool {
        reach > self.limit() && self.left(reach) <= BROKEN
    }

    /// Stiffness that the damage leaves [N/m].
    #[inline]
    pub fn secant(&self, damage: f64) -> f64 {
        self.stiffness * (1.0 - (1.0 - self.residual) * damage)
    }

    /// Work on the part that breaks, of a bond stretched from rest to `reach` [J].
    fn work(&self, reach: f64) -> f64 {
        let (limit, part) = (self.limit(), 1.0 - self.residual);
        if reach <= limit || self.is_brittle() {
            return 0.5 * part * self.stiffness * reach * reach;
        }
        part * self.strength * (0.5 * limit + self.decay * (1.0 - self.left(reach)))
    }

    /// What it took to bring a bond to `damage` by a stretch of `reach` [m] [J]: the work less what unloading gives back.
    pub fn spent(&self, reach: f64, damage: f64) -> f64 {
        self.work(reach) - self.stored(reach, damage)
    }

    /// Elastic energy of the part that breaks [J].
    fn stored(&self, stretch: f64, damage: f64) -> f64 {
        0.5 * (1.0 - damage) * (1.0 - self.residual) * self.stiffness * stretch * stretch
    }
}

/// What a run has done to a bond.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BondState {
    /// δ_m: largest |δ|, or widest gap, that counted for the damage so far [m]; 0 while the bond is intact.
    pub reach: f64,
    /// D, 0 … 1: what is lost of the stiffness. The part that rubs is [`Bond::rubbing`].
    pub damage: f64,
    /// Parts of the joint's length along which it has cracked, from its first end (left or below) and from the other, where cracks run along joints.
    pub crack: Option<[f64; 2]>,
    /// Energy that breaking took [J].
    pub spent: f64,
    /// Largest |elastic force| of the joint so far [N].
    pub peak: f64,
    /// When it first cracked [s]; infinite while it is intact.
    pub cracked: f64,
    /// When nothing was left of it [s]; infinite until then.
    pub broken: f64,
}

impl BondState {
    /// Of an intact bond.
    pub const INTACT: BondState = BondState {
        reach: 0.0,
        damage: 0.0,
        crack: None,
        spent: 0.0,
        peak: 0.0,
        cracked: f64::INFINITY,
        broken: f64::INFINITY,
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRENGTH: f64 = 2e3;
    const STIFFNESS: f64 = 5e7;

    fn soft(residual: f64) -> Bond {
        let least = 0.5 * (1.0 - residual) * STRENGTH * STRENGTH / STIFFNESS;
        Bond::new(STRENGTH, STIFFNESS, residual, 5.0 * least, false).unwrap()
    }

    #[test]
    fn the_slopes_of_wear_are_its_derivatives() {
        let bond = soft(0.0);
        for factor in [1.001, 1.1, 2.0, 5.0, 20.0] {
            let (d, h) = (factor * bond.limit(), 1e-4 * bond.limit());
            for which in [0, 1] {
                let difference = (bond.worn(d + h)[which].0 - bond.worn(d - h)[which].0) / (2.0 * h);
                assert!((difference / bond.worn(d)[which].1 - 1.0).abs() < 1e-6, "{which} at {factor} δ_0");
            }
        }
        assert_eq!(bond.worn(bond.limit()), [(0.0, 0.0); 2]);
    }

    /// What the spring bears at a stretch that is the largest so far is the share of the strength that does not rub, for
    /// whatever energy: friction takes the place of what is lost and no more.
    #[test]
    fn what_rubs_is_what_the_strength_has_lost() {
        for times in [1.001, 1.5, 10.0, 1e3] {
            let bond =
                Bond::new(STRENGTH, STIFFNESS, 0.0, times * 0.5 * STRENGTH * STRENGTH / STIFFNESS, false).unwrap();
            for way in [1e-6, 0.01, 0.5, 1.0, 3.0, 6.0] {
                let reach = bond.limit() + way * bond.decay;
                let [(damage, _), (rubs, _)] = bond.worn(reach);
                let borne = bond.secant(damage) * reach / STRENGTH;
                assert!((borne + rubs - 1.0).abs() < 1e-12, "{borne} beside {rubs}");
                let held = BondState { reach, damage, ..BondState::INTACT };
                assert_eq!(bond.rubbing(&held), rubs);
            }
            assert_eq!(bond.rubbing(&BondState::INTACT), 0.0);
            assert_eq!(bond.rubbing(&BondState { damage: 1.0, reach: bond.limit(), ..BondState::INTACT }), 1.0);
        }
    }

    /// The area under force over displacement, summed up, is G_f A; what is spent grows to it and takes the elastic part along.
    #[test]
    fn the_area_under_the_curve_is_the_energy() {
        for residual in [0.0, 0.25] {
            let bond = soft(residual);
            let end = bond.limit() + bond.decay * (1.0 / BROKEN).ln();
            assert!(!bond.is_broken(end * (1.0 - 1e-9)) && bond.is_broken(end * (1.0 + 1e-9)));
            let force = |d: f64| bond.secant(bond.damage(d)) * d - residual * STIFFNESS * d;
            let n = 200_000;
            let step = end / f64::from(n);
            let area: f64 = (0..n).map(|k| step * force((f64::from(k) + 0.5) * step)).sum();
            assert!((area / bond.energy() - 1.0).abs() < 1e-8, "{area} J of {}", bond.energy());
            assert!((bond.spent(end, 1.0) / bond.energy() - 1.0).abs() < 1e-12);
            assert_eq!(bond.spent(bond.limit(), 0.0), 0.0);
        }
    }

    #[test]
    fn limits_of_the_law() {
        let least = 0.5 * STRENGTH * STRENGTH / STIFFNESS;
        assert!(Bond::new(STRENGTH, STIFFNESS, 0.0, 0.999 * least, false).is_none());
        assert!(Bond::new(STRENGTH, STIFFNESS, 1.0, least, false).is_none(), "nothing to soften");
        let brittle = Bond::new(STRENGTH, STIFFNESS, 0.0, 0.0, true).unwrap();
        assert!(brittle.is_brittle() && (brittle.energy() / least - 1.0).abs() < 1e-14);
        assert!((brittle.spent(brittle.limit(), 1.0) / least - 1.0).abs() < 1e-14);
        // Intact, to the bit; closed, the law of the head joint.
        assert_eq!((brittle.secant(0.0), brittle.secant(1.0)), (STIFFNESS, 0.0));
    }
}
