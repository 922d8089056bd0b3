//! A mechanism, compiled: its sides, its laws, and what follows of them without a run.

use concio_law::G;

use super::mechanism::{Back, Mechanism, Restitution, block_restitution};
use super::pull::Pull;
use super::response::Capacity;
use super::shaking::Shaking;
use super::side::Side;

/// Longest step by the quickest motion: ω h.
const STEP: f64 = 0.02;
/// Longest step where nothing else limits it [s].
const LONGEST: f64 = 0.01;
/// Share of the largest turn up to which the quickest motion is looked for: the chain is singular at its end.
const LOOKED_AT: f64 = 0.98;

/// A mechanism, compiled.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct System {
    /// Outwards; inwards, where it rocks to both sides.
    pub sides: Vec<Side>,
    /// Turn at which the weights hold no longer.
    pub d0: [Option<f64>; 2],
    /// What an impact leaves; none for (OP11).
    pub restitution: Option<f64>,
    pub friction_moment: f64,
    /// Friction and seat of floors, force and overlap of rubs; +∞ where they are never lost.
    pub floors: Vec<[f64; 2]>,
    pub rubs: Vec<[f64; 2]>,
    pub ties: Vec<Pull>,
    /// Longest step that resolves wall and ties [s].
    step: f64,
}

impl System {
    /// Compiles a mechanism whose numbers have been checked.
    pub fn new(mechanism: &Mechanism) -> Self {
        let none_gone = vec![false; mechanism.floors.len()];
        let mut sides = vec![Side::new(mechanism, &mechanism.linkage, 1.0)];
        let restitution = match mechanism.back {
            Back::SideWalls(Restitution::Given(e)) => Some(e),
            Back::SideWalls(Restitution::Block) => Some(block_restitution(mechanism.slenderness())),
            Back::Free { inwards, restitution } => {
                sides.push(Side::new(mechanism, &inwards, -1.0));
                restitution
            }
        };
        let never = f64::INFINITY;
        let mut system = System {
            d0: [0, 1].map(|i| sides.get(i).and_then(|side: &Side| side.unstable_from(&none_gone))),
            restitution,
            friction_moment: mechanism.friction_moment,
            floors: mechanism.floors.iter().map(|f| [f.friction * f.load, f.seat.unwrap_or(never)]).collect(),
            rubs: mechanism.rubs.iter().map(|rub| [rub.force, rub.overlap.unwrap_or(never)]).collect(),
            ties: mechanism.ties.iter().map(Pull::new).collect(),
            step: LONGEST,
            sides,
        };
        let quickest = system.sides.iter().map(|side| quickest(side, mechanism, &none_gone)).fold(0.0, f64::max);
        system.step = LONGEST.min(STEP / quickest);
        system
    }
}

/// The quickest angular frequency of the wall with its ties [rad/s].
fn quickest(side: &Side, mechanism: &Mechanism, gone: &[bool]) -> f64 {
    const PLACES: usize = 64;
    let width = LOOKED_AT * side.end / PLACES as f64;
    let square = |k: usize| {
        let (low, high) = (side.pose(k as f64 * width), side.pose((k + 1) as f64 * width));
        let [from, to] = [low, high].map(|pose| side.terms(&pose, gone));
        let place = ((to.weight - to.thrust) - (from.weight - from.thrust)).abs() / width;
        let ties = mechanism.ties.iter().zip(&side.ties).map(|(tie, grip)| tie.stiffness * low.track(grip).dx.powi(2));
        (place + ties.sum::<f64>()) / from.inertia
    };
    (0..PLACES).map(square).fold(0.0, f64::max).sqrt()
}

impl System {
    /// The largest part of the velocity that an impact may leave: more would give energy.
    pub fn most_restitution(&self) -> f64 {
        let [outwards, inwards] = self.sides.as_slice() else { return 1.0 };
        let none_gone = vec![false; self.floors.len()];
        let [out, inw] = [outwards, inwards].map(|side| side.terms(&side.pose(0.0), &none_gone).inertia);
        (out / inw).min(inw / out).sqrt()
    }

    /// Longest step under a motion of the ground, where none is given [s].
    pub fn step(&self, shaking: &Shaking) -> f64 {
        self.step.min(shaking.longest_step())
    }

    /// d0 of a side.
    pub fn capacity(&self, side: usize) -> Option<Capacity> {
        let rotation = (*self.d0.get(side)?)?;
        let side = &self.sides[side];
        Some(Capacity { rotation, displacement: side.displacement(&side.pose(rotation), &side.control) })
    }

    /// α(θ) outwards without ties and friction.
    pub fn multiplier_at(&self, rotation: f64) -> f64 {
        let side = &self.sides[0];
        if !(0.0..=side.end).contains(&rotation) {
            return f64::NAN;
        }
        let terms = side.terms(&side.pose(rotation), &vec![false; self.floors.len()]);
        (terms.weight - terms.thrust) / (G * terms.push)
    }

    /// Part of the velocity that an impact at the end of a turn outwards leaves.
    pub fn restitution(&self) -> f64 {
        let none_gone = vec![false; self.floors.len()];
        match (self.restitution, self.sides.get(1)) {
            (Some(given), _) => given,
            (None, Some(inwards)) => self.sides[0].passes_on(inwards, &none_gone),
            (None, None) => 0.0,
        }
    }
}
