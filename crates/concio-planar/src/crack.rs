//! What becomes of a joint: what is open of it, what of its bond has cracked, what is crushed.
//!
//! A joint between rigid blocks opens and slides by straight lines along its length. Its bond and what is crushed are known at equally spaced nodes,
//! with straight lines in between. What is left of the bond acts in both directions and gives two contact points the
//! stiffness against parting and against turning that it has in all, exactly: half of it at each, at the distance of its radius of gyration
//! from its centre. What has cracked, as all of a joint without bond, acts in compression alone, at two points for each of its zones: open, pressed, crushed and crushing (`zone.rs`).
//! It rubs for the whole joint: friction at springs that pull too would have a kink, where contact is hard to solve.
//! Its friction is in line with the part D of the stiffness along: a joint that sticks is as stiff as before it cracked (Alfano & Sacco 2006), and of
//! the shear that breaks a part of it friction goes on to bear what it can.
//!
//! At a node that is stretched by w across and s along the joint,
//!
//! (P9)  σ = (1 − D) k_n w ≤ e^−ξ f_t,   |τ| = (1 − D) k_t |s| ≤ e^−ξ (c + p tan φ) − σ tan φ
//!
//! p being the pressure there; of tension σ tan φ counts, c σ/f_t at most, so that f_t is borne without shear.
//! Where a limit is passed, ξ grows by the way that goes beyond it over δ_c of that mode, and what that mode alone would lose of its stiffness to where the limit is met; D is the larger loss of the two.
//! Where falling pressure lowers the limit, what has slid since it was met last counts, and no more. One ξ weakens both strengths, as mixed modes do (Lourenço & Rots
//! 1997); stiffness that is lost in one mode does not put off the limit of the other. Along one mode alone that is (B3). χ = 1 − e^−ξ is
//! the part that rubs, so that shear stays within (B5). δ_c follows from G_f with the strength of the moment, S = f_t of opening, c + p tan φ of shear, and with
//! what friction goes on to bear of it, R = min(μ p, S) of shear, so that all that the bond loses is G_f:
//!
//! (P10)  G_f = ½ (S² − R²)/k + (1 − ε) S δ_c
//!
//! which is (B4) but for what the springs of friction keep. Where pressure changes as it breaks, δ_c is that with which the rest of G_f goes.
//!
//! Of two modes in turn (P9) makes, under no pressure and with a = tan φ k_n/k_t (or c/f_t for tan φ, where that is less): slid to s, then opened by w,
//!
//! (P11)  σ = e^−ξ min(f_t, c k_n w/(k_t q)),   q = s + a w,   ξ = (q − q_0)/δ_t + ⟨w − w_1⟩/δ_n,   k_t q_0 = c,   k_n w_1 = e^−ξ f_t
//!
//! as long as f_t is not the smaller one, and opened to w, then slid by s,
//!
//! (P12)  τ = e^−ξ min(c s/q, f_t k_t s/(k_n w)),   q = s + min(1, f_t k_t q/(c k_n w)) a w,   ξ = (w − w_0)/δ_n + ⟨s − s_1⟩/δ_t,   k_n w_0 = f_t,   k_t s_1 = e^−ξ₀ (c − f_t tan φ),   ξ₀ = (w − w_0)/δ_n
//!
//! Rigid joints break by plane sections: the stress of the joint is the straight line that balances what its points bear, cracked parts pressing only;
//! the crack runs as far as it is above f_t at its tip, or of a joint that is pulled as a whole above what its shear leaves there.

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::fibres::{FIBRES, Fibres};
use crate::joint::{Bond, Law, Normal, Part, Point};
use crate::zone::{self, Local, Moments, Zone};

mod friction;
mod placed;

/// Nodes of a joint: a crack advances by 1/128 of it.
const NODES: usize = 129;
/// Nodes of a joint without bond at which it is known what is crushed: what rocks back over that leans on a narrow edge.
const CRUSHED_NODES: usize = 513;
/// Places between fibres, and the fibres themselves.
const BETWEEN_FIBRES: usize = 2 * FIBRES - 1;
/// Points of what has cracked: two for each zone, and two more for either that is open of a joint that can be crushed.
pub(crate) const DRY: usize = 2 * ZONES + 4;
/// Points of what has cracked and their gaps [m].
pub(crate) type Gaps = SmallVec<[(usize, f64); DRY]>;
/// Points of what is left of the bond.
pub(crate) const HELD: usize = 2;
/// Points of a bonded joint, the last for the spring that stays beside friction.
pub(crate) const POINTS: usize = HELD + DRY + 1;
/// Moments of the whole joint.
const WHOLE: Moments = [1.0, 0.5, 1.0 / 3.0];
/// Part of its strength below which a bond counts as broken, ε of (B4).
const BROKEN: f64 = 1e-3;
/// Part of the least zone by which zones may grow or shrink before points are placed anew.
const NEARLY: f64 = 1.0 / 32.0;
/// The same with inertia, where the end of what is open has a point: what it bears is to go once blocks rest.
const PLACED: f64 = 1.0 / 4096.0;
/// Distance up to which sides touch [m]: more than positions are rounded by.
const TOUCHING: f64 = 1e-12;
/// How far apart sides are taken to be that face each other no more [m]: more than is ever crushed.
const APART: f64 = 1e3;
/// Parts of the length δ_c in which a node is followed on its way, and how closely it is found from where on it softens, over that way.
const PARTS: f64 = 8.0;
const CLOSELY: f64 = 1e-4;
/// Part of a joint below which what is left of its bond is rounding.
const NOTHING: f64 = 1e-9;
/// Part of the strength up to which a joint that has not been crushed may come in a step without a look at whether its points bear what it does.
const FAR_BELOW: f64 = 0.1;
/// Part of what crushes below which what is pressed beside it is its edge.
const THIN: f64 = 0.1;
/// Part of the strength up to which a corner is a contact point.
const WELL_BELOW: f64 = 0.5;
/// Part by which what points bear may be off where the joint is crushed, before a step is halved.
pub(crate) const MISSED: f64 = 0.02;
/// Part by which the pressure of what crushes is below the strength at most.
const HARDLY: f64 = 0.01;

/// A node of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Node {
    /// e^−ξ: what is left of both strengths.
    left: f64,
    /// What opening and shear alone would have lost of the stiffness.
    lost: [f64; 2],
    /// The part of G_f that opening and shear still have to take.
    rest: [f64; 2],
    /// Up to which slide ξ has grown [m]: it lags behind where pressure put the limit off.
    counted: f64,
}

impl Node {
    const INTACT: Node = Node { left: 1.0, lost: [0.0; 2], rest: [1.0; 2], counted: 0.0 };
    const GONE: Node = Node { left: 0.0, lost: [1.0; 2], rest: [0.0; 2], counted: 0.0 };

    /// D.
    fn damage(&self) -> f64 {
        self.lost[0].max(self.lost[1])
    }

    /// χ.
    fn chi(&self) -> f64 {
        1.0 - self.left
    }

    /// What a slide and an opening ask of it together along [m]: tension takes from the strength along what it bears times tan φ, and a slide that would bear that is added to
    /// the one there is.
    fn sheared(&self, [w, s]: [f64; 2], law: &Law) -> f64 {
        let [opened, slid] = self.lost.map(|lost| 1.0 - lost);
        s.abs() + (opened / slid).min(1.0) * law.pulled(w)
    }

    /// How far it may be stretched in a mode of `k` [N/m] and this strength [N] [m].
    fn limit(&self, mode: usize, k: f64, strength: f64) -> f64 {
        strength * self.left / (k * (1.0 - self.lost[mode]))
    }

    /// Whether being stretched by `w` and `s` [m] does nothing to it: it is broken already, or within its strengths.
    fn stays(&self, [w, s]: [f64; 2], law: &Law, bond: &Bond) -> bool {
        let Normal::Springs { both, press, .. } = law.normal else { return true };
        let along = law.breaking_stiffness();
        let pressure = (both + press) * (-w).max(0.0);
        let within =
            |mode: usize, stretch: f64, k: f64, strength: f64| k == 0.0 || !(stretch > self.limit(mode, k, strength));
        self.damage() == 1.0
            || pressure <= law.crushing
                && within(0, w - TOUCHING, both, bond.tension)
                && within(1, self.sheared([w, s], law), along, law.shear_strengths(pressure)[0])
    }

    /// The way beyond its limit along of a node that has slid to `slid`, the last `way` of it in this step, counted from here on [m]. What it slid while
    /// pressure put its limit off counts when that comes back: or where pressure trembles ever so little nothing would soften.
    fn slid_beyond(&mut self, limit: f64, [slid, way]: [f64; 2], pressed: bool) -> f64 {
        // What tension adds to the slide counts as it grows.
        if !pressed {
            self.counted = slid;
            return way;
        }
        if self.lost[1] == 0.0 {
            self.counted = limit.max(slid - way);
        }
        let way = way.max(slid - self.counted);
        self.counted = (self.counted + way.min(slid - limit)).min(slid);
        way
    }

    /// What friction bears of the shear that broke it after the slide `s` [m], under the pressure of an opening `w`, and what its springs store
    /// then, of a joint as it would be everywhere [N, J].
    fn friction(&self, [w, s]: [f64; 2], law: &Law) -> [f64; 2] {
        let (along, damage) = (law.breaking_stiffness(), self.damage());
        let [_, goes_on] = law.shear_strengths(law.normal_stiffness() * (-w).max(0.0));
        let borne = (self.chi() * goes_on).min(damage * along * s.abs());
        [borne, if borne > 0.0 { 0.5 * borne * borne / (damage * along) } else { 0.0 }]
    }

    /// What becomes of it on the straight way `from` one stretch `to` another [m], in so many parts as that takes.
    fn on_the_way(self, from: [f64; 2], to: [f64; 2], law: &Law, bond: &Bond) -> Wear {
        let stays = Wear { node: self, taken: 0.0, less: [[0.0; 2]; 2] };
        if self.stays(to, law, bond) {
            return stays;
        }
        let (at_once, taken) = self.worn(to, from, law, bond);
        if at_once == self {
            return stays;
        }
        let parts = parts(from, to, law, bond);
        let Some(mut done) = (parts > 1.0).then(|| self.keeps_until(from, to, law, bond)) else {
            let lost = self.lost_at(&at_once, to, law);
            return Wear { node: at_once, taken, less: [lost.map(|lost| 0.5 * lost), lost] };
        };
        let (mut node, mut sum, mut was, mut mean, mut lost) =
            (self, 0.0, between(&[from, to], done), [0.0; 2], [0.0; 2]);
        while done < 1.0 {
            let next = if node.damage() < 1.0 { (done + 1.0 / parts).min(1.0) } else { 1.0 };
            let at = between(&[from, to], next);
            let (worn, taken) = node.worn(at, was, law, bond);
            let now = self.lost_at(&worn, at, law);
            (0..2).for_each(|k| mean[k] += 0.5 * (next - done) * (lost[k] + now[k]));
            (node, sum, was, lost, done) = (worn, sum + taken, at, now, next);
        }
        Wear { node, taken: sum, less: [mean, lost] }
    }

    /// Up to which part of the way `from` one stretch `to` another it bore all that it did, 0 … 1, where it has become `node` on that way and breaks at
    /// once.
    fn breaks_at(&self, node: &Node, from: [f64; 2], to: [f64; 2], law: &Law) -> Option<f64> {
        let Normal::Springs { both, press, .. } = law.normal else { return None };
        if *self != Node::INTACT || *node != Node::GONE {
            return None;
        }
        let pressure = (both + press) * (-to[0]).max(0.0);
        let tension = law.bond.map_or(0.0, |bond| bond.tension);
        let part = |from: f64, to: f64, strength: f64| {
            if to > strength { ((strength - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 }
        };
        let sheared =
            part(law.sheared(from), law.sheared(to), law.shear_strengths(pressure)[0] / law.breaking_stiffness());
        Some(part(from[0], to[0], tension / both).min(sheared))
    }

    /// Up to which part of the way it loses nothing, 0 … 1.
    fn keeps_until(&self, from: [f64; 2], to: [f64; 2], law: &Law, bond: &Bond) -> f64 {
        let (mut keeps, mut loses) = (0.0, 1.0);
        while loses - keeps > CLOSELY {
            let half = 0.5 * (keeps + loses);
            *if self.stays(between(&[from, to], half), law, bond) { &mut keeps } else { &mut loses } = half;
        }
        keeps
    }

    /// What it bears less across and along where it is stretched by `w` and `s` once it has become `node` [N], but for what friction goes on to bear of it.
    fn lost_at(&self, node: &Node, [w, s]: [f64; 2], law: &Law) -> [f64; 2] {
        let Normal::Springs { both, .. } = law.normal else { return [0.0; 2] };
        let gone = node.damage() - self.damage();
        let [had, rubs] = [self, node].map(|node| node.friction([w, s], law)[0]);
        [gone * both * w.max(0.0), gone * law.breaking_stiffness() * s - (rubs - had) * s.signum()]
    }

    /// Takes from what a mode has to take what the other took of its strength, of which `left` was left, so that its δ_c stays as it is.
    fn weaken(&mut self, mode: usize, left: f64, law: &Law, pressure: f64) {
        let Some(bond) = law.bond else { return };
        let (energy, k) = (bond.energy[mode], [law.springs().0, law.breaking_stiffness()][mode]);
        let strength = [bond.tension, law.shear_strengths(pressure)[0]][mode];
        let stored = |left: f64| 0.5 * (strength * left).powi(2) / (k * (1.0 - self.lost[mode]) * energy);
        if energy > 0.0 && k > 0.0 {
            let part = (self.left - BROKEN) / (left - BROKEN);
            self.rest[mode] = (self.rest[mode] - stored(left)) * part + stored(self.left);
        }
    }

    /// What becomes of it where it is stretched by `w` and `s`, and was by `then` before [m], and what it lost, of a joint as it would be
    /// everywhere [J].
    fn worn(self, [w, s]: [f64; 2], then: [f64; 2], law: &Law, bond: &Bond) -> (Node, f64) {
        let mut node = self;
        let Normal::Springs { both, press, .. } = law.normal else { return (node, 0.0) };
        let (damage, had) = (node.damage(), node.lost);
        let along = law.breaking_stiffness();
        let pressure = ((both + press) * -w).max(0.0);
        let sheared = node.sheared([w, s], law);
        let grown = [w - then[0], s.abs() - then[1].abs(), sheared - node.sheared(then, law)];
        let grown = grown.map(|way| way.max(0.0));
        let (mut taken, mut passed) = (0.0, [false; 2]);
        // `way` is how much farther it is stretched than before, `other` twice what the other direction would store.
        let mut pass = |node: &mut Node,
                        mode: usize,
                        [stretch, way]: [f64; 2],
                        k: f64,
                        [strength, goes_on]: [f64; 2],
                        other: f64| {
            let before = node.damage();
            if k == 0.0 || before == 1.0 {
                return;
            }
            let from = strength * node.left;
            let limit = node.limit(mode, k, strength);
            if !(stretch > limit) {
                return;
            }
            passed[mode] = true;
            let way = if mode == 1 { node.slid_beyond(limit, [s.abs(), way], pressure > 0.0) } else { way };
            // Of what the bond stores, and of what breaking takes from here on, the springs of friction keep a part.
            let kept = |node: &Node| if mode == 1 { node.friction([w, s], law)[1] } else { 0.0 };
            let (had, left) = (kept(node), node.left);
            let capacity = bond.energy[mode] * node.rest[mode];
            let stored = 0.5 * (from * limit - goes_on * goes_on / k) + had;
            let decay = ((capacity - stored) / (from - BROKEN * strength)).max(0.0);
            // What has no strength breaks at once.
            let decay = if strength > 0.0 { decay } else { 0.0 };
            // Where the limit has come to the stretch, as pressure fell or the other mode took of the strength or added to the stretch, the rest is no work of
            // breaking. But for the pressure δ_c stays as it is.
            let at = limit.max(stretch - way);
            let added = if mode == 0 || pressure == 0.0 { 0.5 * from * (at - limit) } else { 0.0 };
            // Where the limit has come to the stretch and not the stretch to the limit, nothing has gone beyond it.
            node.left *= if decay > 0.0 { (-(stretch - limit).min(way) / decay).exp() } else { 0.0 };
            let to = strength * node.left;
            if to > BROKEN * strength {
                node.lost[mode] = 1.0 - to / (k * stretch);
                let spent = decay * (from - to) - 0.5 * (to * stretch - from * at);
                taken += spent;
                if bond.energy[mode] > 0.0 {
                    node.rest[mode] = (capacity + added - spent + kept(node) - had) / bond.energy[mode];
                }
                node.weaken(1 - mode, left, law, pressure);
            } else {
                // What bears next to nothing bears nothing, and gives back nothing of what it stored.
                *node = Node::GONE;
                taken += decay * (from - BROKEN * strength).max(0.0) + 0.5 * from * at;
            }
            taken += 0.5 * (node.damage() - before) * other;
        };
        pass(&mut node, 0, [w - TOUCHING, grown[0]], both, [bond.tension, 0.0], along * s * s);
        let stretch = node.sheared([w, s], law);
        let opened = both * w.max(0.0).powi(2);
        pass(&mut node, 1, [stretch, grown[2]], along, law.shear_strengths(pressure), opened);
        // What the slide took of the strength, an opening that is at its limit bears no more: it would count once more as that comes back to where it was.
        if both > 0.0 && node.damage() < 1.0 && w - TOUCHING > node.limit(0, both, bond.tension) {
            let from = bond.tension * node.left;
            if bond.energy[0] > 0.0 {
                node.rest[0] += 0.5 * from * (w - TOUCHING - node.limit(0, both, bond.tension)) / bond.energy[0];
            }
            node.lost[0] = 1.0 - from / (both * (w - TOUCHING));
        }
        // Where both modes have lost some, one of them bears less than its limit. What springs bore on the way and do not store is taken then.
        if passed[0] && (passed[1] || had[1] > 0.0) || passed[1] && (node.lost[0] > 0.0 || law.pulled(w) > 0.0) {
            let [w, s] = [w.max(0.0), s.abs()];
            let both_ways = both * w * (w - grown[0]).max(0.0) + along * s * (s - grown[1]);
            taken = 0.5 * (node.damage() - damage) * both_ways;
        }
        if pressure > law.crushing && node.damage() < 1.0 {
            taken += 0.5 * (1.0 - node.damage()) * along * s * s;
            node = Node::GONE;
        }
        (node, taken)
    }
}

/// What becomes of a node in a step, of a joint as it would be everywhere.
struct Wear {
    node: Node,
    /// What it lost [J].
    taken: f64,
    /// What it bore less across and along than had nothing cracked [N], in the mean and at the end.
    less: [[f64; 2]; 2],
}

/// The first of two instants of which there may be none.
pub(crate) fn earlier(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    a.into_iter().chain(b).reduce(f64::min)
}

/// In how many parts a node is followed from one stretch to another, if it softens all the way.
fn parts(from: [f64; 2], to: [f64; 2], law: &Law, bond: &Bond) -> f64 {
    let Normal::Springs { both, press, .. } = law.normal else { return 1.0 };
    let pressure = (both + press) * (-from[0].min(to[0])).max(0.0);
    let of = |mode: usize, way: f64, strength: f64, k: f64| {
        let length = (bond.energy[mode] / strength).max(strength / k);
        if way > 0.0 && length > 0.0 { PARTS * way / length } else { 1.0 }
    };
    let opens = of(0, to[0] - from[0].max(0.0), bond.tension, both);
    let [sheared, strength] = [law.sheared(to) - law.sheared(from), law.shear_strengths(pressure)[0]];
    opens.max(of(1, sheared, strength, law.breaking_stiffness())).ceil()
}

/// A contact point of a bonded joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Spot {
    /// Which of the points.
    pub point: usize,
    /// What it stands for.
    pub part: Part,
    /// Where, 0 … 1 along the joint.
    pub at: f64,
    /// How much of the joint's law it bears.
    pub share: f64,
    /// How much of the joint it is: these add up to 1.
    pub weight: f64,
    /// The part of its friction that acts: above 1 where it rubs for an edge beside it.
    pub rubbing: f64,
    /// The part of its dashpot across that acts.
    pub damps: f64,
    /// What is crushed of it [m], so that its zone bears what it does: of two points that stand for an uneven one any number.
    pub crushed: f64,
    /// By how much of the joint the part that is crushed may grow or shrink beside it in a step, which it bears.
    pub edge: f64,
}

/// The state of the bond of one joint, and of what is crushed of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Crack {
    nodes: Vec<Node>,
    /// Opening and slide at both ends, now and a step before [m].
    line: [[f64; 2]; 2],
    was: [[f64; 2]; 2],
    /// First and last node of a rigid joint that are held; what it bore across and along after the last step, and by how much its largest tension was over
    /// the strength then [N].
    held: [usize; 2],
    borne: [f64; 2],
    over: f64,
    /// What is crushed at its nodes [m]; none of a joint that bears any pressure.
    crushed: Vec<f64>,
    /// How much of it was in each zone when its points were placed, and its first moment.
    placed: [[f64; 2]; ZONES],
    /// Energy in its springs across beyond that of its points [J].
    hidden: f64,
    /// Its springs along, once nothing of its bond is left.
    fibres: Fibres,
    /// When it first cracked [s]; infinite while it is intact.
    pub cracked: f64,
    /// When nothing was left of it [s].
    pub broken: f64,
    /// How far it was stretched at most where it has cracked [m].
    pub reach: f64,
    /// Largest tension and shear that a rigid joint bore when it cracked or broke, which may be within a step [N].
    pub peak: [f64; 2],
    /// What its points stand for.
    spots: Vec<Spot>,
}

/// Zones of a joint: what is open, what is pressed, what is pressed where it was crushed, what is pressed nearly as hard as it bears, and what is open
/// beyond that: what was crushed at both ends leans on its middle.
const ZONES: usize = 5;
const OPEN: usize = 0;
const PRESSED: usize = 1;
const CRUSHED: usize = 2;
const CRUSHING: usize = 3;
const BEYOND: usize = 4;

/// Whether nothing is pressed of a zone.
fn is_open(kind: usize) -> bool {
    kind == OPEN || kind == BEYOND
}

/// What a bond loses in a step, in the mean over it or without inertia at its end, of the forces that it would bear had nothing cracked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Softened {
    /// Tension [N], and its moment about the first end over the length of the joint.
    pub across: [f64; 2],
    /// Shear, in the sense of the slide [N].
    pub along: f64,
    /// The part of its stiffness across and along with which each of its two points goes on to resist.
    pub left: [[f64; 2]; 2],
    /// What that takes [J].
    pub taken: f64,
    /// How much of the step was over when a part of it that breaks at once did so, 0 … 1; none where none did.
    pub breaks_at: Option<f64>,
}

impl Softened {
    /// Of a bond that bears all that it did.
    pub(crate) const NOTHING: Softened =
        Softened { across: [0.0; 2], along: 0.0, left: [[1.0; 2]; 2], taken: 0.0, breaks_at: None };
}

/// What became of the bond in a step [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Worn {
    /// What breaking and crushing took.
    pub bond: f64,
    /// What friction took where parts of the joint opened that had borne shear.
    pub friction: f64,
    /// What springs lost beside that, because a step goes beyond a limit before it is met, and where points are placed anew.
    pub beyond: f64,
    /// How much of the step was over when a part of it that breaks at once did so, 0 … 1; none where none did.
    pub breaks_at: Option<f64>,
}

/// How a joint stands as a step has ended.
struct Ended<'s> {
    /// Opening and slide at both ends [m].
    line: &'s [[f64; 2]; 2],
    /// Without inertia.
    still: bool,
    /// How fast its ends part, where dashpots count [m/s].
    parting: [f64; 2],
    /// What was crushed between its fibres before the step [m], which counts with inertia; none where nothing was.
    shallower: Option<&'s [f64; BETWEEN_FIBRES]>,
}

/// The first and the last of what is somewhere `at` a joint; none where they are no two.
fn outermost<T: Copy>(mut all: impl Iterator<Item = T>, at: impl Fn(T) -> f64) -> Option<[T; 2]> {
    let only = all.next()?;
    let [first, last] = all.fold([only; 2], |[first, last], one| {
        [if at(one) < at(first) { one } else { first }, if at(one) > at(last) { one } else { last }]
    });
    (at(last) > at(first)).then_some([first, last])
}

/// Opening and slide of the point that a spot stands for [m].
fn ways(points: &[Point]) -> impl Fn(&Spot) -> [f64; 2] {
    |spot| [points[spot.point].gap, points[spot.point].slide]
}

/// Place of a node, 0 … 1.
fn place(node: usize) -> f64 {
    node as f64 / (NODES - 1) as f64
}

/// The part of a joint of so many nodes that one of them stands for.
fn weight(node: usize, nodes: usize) -> f64 {
    let whole = 1.0 / (nodes - 1) as f64;
    if node == 0 || node == nodes - 1 { 0.5 * whole } else { whole }
}

/// On the way from one end to the other.
fn between(line: &[[f64; 2]; 2], at: f64) -> [f64; 2] {
    [0, 1].map(|k| line[0][k] + at * (line[1][k] - line[0][k]))
}

/// Whether the points of a joint of this law move, as a bond cracks or a part of the joint opens.
pub(crate) fn moves(law: &Law) -> bool {
    law.bond.is_some() || law.has_zones()
}

/// At how many nodes of a joint of this law it is known what is crushed.
fn crushed_nodes(law: &Law) -> usize {
    let known = moves(law) && law.is_compliant() && law.crushing.is_finite();
    if !known {
        0
    } else if law.bond.is_some() {
        NODES
    } else {
        CRUSHED_NODES
    }
}

/// How many points a joint of this law has at most.
pub(crate) fn most_points(law: &Law) -> usize {
    if moves(law) { POINTS } else { law.points().len() }
}

impl Crack {
    /// Of an intact joint, or of one without bond whose springs only press: that is one whose bond is gone. None of another, whose points stay where they are.
    pub(crate) fn of(law: &Law) -> Option<Self> {
        if !moves(law) {
            return None;
        }
        let bonded = law.bond.is_some();
        let since = if bonded { f64::INFINITY } else { 0.0 };
        let mut crack = Crack {
            nodes: if bonded { vec![Node::INTACT; NODES] } else { Vec::new() },
            line: [[0.0; 2]; 2],
            was: [[0.0; 2]; 2],
            held: [0, NODES - 1],
            borne: [0.0; 2],
            over: f64::NEG_INFINITY,
            crushed: vec![0.0; crushed_nodes(law)],
            placed: [[0.0; 2]; ZONES],
            hidden: 0.0,
            fibres: Fibres::new(law.cracked().in_line()),
            cracked: since,
            broken: since,
            reach: 0.0,
            peak: [0.0; 2],
            spots: Vec::with_capacity(POINTS),
        };
        crack.place(law, &[[0.0; 2]; 2], &crack.zones(law, &[[0.0; 2]; 2]), true);
        Some(crack)
    }

    /// Its contact points.
    pub(crate) fn spots(&self) -> &[Spot] {
        &self.spots
    }

    /// Mean of D over the joint.
    pub fn damage(&self) -> f64 {
        if self.is_gone() { 1.0 } else { self.mean(|n| self.nodes[n].damage()) }
    }

    /// Part of the joint along which it has cracked, 0 … 1.
    pub fn length(&self) -> f64 {
        if self.is_gone() { 1.0 } else { self.mean(|n| f64::from(u8::from(self.nodes[n].damage() > 0.0))) }
    }

    /// Part of the joint along which it has cracked from its first contact point on, the first along the tangent; the rest of what has cracked lies at the other end.
    pub fn length_at_first(&self) -> f64 {
        let held = self.nodes.iter().position(|node| node.damage() == 0.0).filter(|_| !self.is_gone());
        held.map_or(self.length(), |first| (first as f64 - 0.5).max(0.0) / (NODES - 1) as f64)
    }

    /// Opening and slide at both ends [m].
    pub fn line(&self) -> [[f64; 2]; 2] {
        self.line
    }

    /// Whether nothing is left of it.
    pub fn is_gone(&self) -> bool {
        self.broken.is_finite()
    }

    /// Of what is linear between nodes.
    fn mean(&self, f: impl Fn(usize) -> f64) -> f64 {
        let ends = 0.5 * (f(0) + f(NODES - 1));
        (ends + (1..NODES - 1).map(f).sum::<f64>()) / (NODES - 1) as f64
    }

    /// Whether its points stand for something that is crushed.
    pub(crate) fn is_crushed(&self) -> bool {
        self.spots.iter().any(|spot| spot.crushed != 0.0)
    }

    /// Whether nothing is crushed of it.
    fn is_even(&self) -> bool {
        self.crushed.iter().all(|depth| *depth == 0.0)
    }

    /// The most that is crushed of it [m].
    pub fn depth(&self) -> f64 {
        self.crushed.iter().copied().fold(0.0, f64::max)
    }

    /// Energy in its springs beyond that of its points [J].
    pub(crate) fn hidden(&self) -> f64 {
        self.hidden + self.fibres.uneven
    }

    /// Where its sides face each other no more: all that has no bond is open, and what springs keep beyond that of the points is lost, which is returned [J].
    pub(crate) fn part(&mut self, law: &Law, points: &mut [Point]) -> f64 {
        let pressed = self.placed.iter().enumerate().any(|(kind, placed)| !is_open(kind) && placed[0] > 0.0);
        if !law.is_compliant() || !pressed {
            return 0.0;
        }
        let lost = self.hidden + self.fibres.let_go();
        let apart = [[APART, 0.0]; 2];
        (self.line, self.was) = (apart, apart);
        let zones = self.zones(law, &apart);
        self.place(law, &apart, &zones, false);
        for spot in self.spots.iter().filter(|spot| spot.part == Part::Dry) {
            points[spot.point] = Point { crushed: spot.crushed, ..Point::default() };
        }
        self.set(points);
        lost
    }

    /// Makes room for all of its points, as one that was read back may not have.
    pub(crate) fn reserve(&mut self) {
        self.spots.reserve(POINTS - self.spots.len());
    }

    /// What is open of what has cracked, what is pressed and what crushes, its ends being as far apart as `line` says.
    fn zones(&self, law: &Law, line: &[[f64; 2]; 2]) -> [Zone; ZONES] {
        let mut zones = [Zone::default(); ZONES];
        let Normal::Springs { both, press, .. } = law.normal else { return zones };
        let stiffness = both + press;
        let most = law.crushing / stiffness;
        let [from, to] = [line[0][0], line[1][0]];
        let gone = self.is_gone();
        let mut beyond = false;
        let mut take = |[a, b]: [(f64, Local); 2], pressed: usize| {
            let mut add = |ends: [(f64, Local); 2]| {
                let opens = ends[0].1[3].max(ends[1].1[3]) > TOUCHING;
                beyond |= !opens && zones[OPEN].acts[0] > 0.0;
                let open = if beyond { BEYOND } else { OPEN };
                zones[if opens { open } else { pressed }].add(ends);
            };
            let [start, end] = [a.1[3], b.1[3]];
            // Where its sides touch it has two parts.
            if start * end < 0.0 {
                let part = start / (start - end);
                let mut middle = (a.0 + part * (b.0 - a.0), zone::between(&a.1, &b.1, part));
                middle.1[3] = 0.0;
                add([a, middle]);
                add([middle, b]);
            } else {
                add([a, b]);
            }
        };
        // Most joints by far.
        if gone && self.is_even() && -from.min(to) < most {
            take([(0.0, [1.0, 1.0, 1.0, from]), (1.0, [1.0, 1.0, 1.0, to])], PRESSED);
        } else {
            let depth = |n: usize| *self.crushed.get(n).unwrap_or(&0.0);
            let local = |n: usize| self.nodes.get(n).map_or([1.0; 2], |node| [node.damage(), node.chi()]);
            let place = |n: usize| self.place_of(n);
            let last = self.nodes.len().max(self.crushed.len()) - 1;
            let plain = |n: usize| n <= last && local(n)[0] == 1.0 && depth(n) == 0.0;
            // Of springs of which some act in compression only as long as nothing has cracked.
            let acts = |cracked: f64| if gone { 1.0 } else { (both * cracked + press) / stiffness };
            let mut n = 0;
            while n < last {
                // What has cracked for good is alike as far as it goes.
                let mut end = n + 1;
                while plain(n) && plain(end) && plain(end + 1) {
                    end += 1;
                }
                let [from, to] = [local(n), local(end)];
                let mut piece = |ends: [[f64; 2]; 2]| {
                    let ends = ends.map(|[at, deep]| {
                        let [cracked, rubs] = zone::between(&from, &to, (at - place(n)) / (place(end) - place(n)));
                        (at, [acts(cracked), cracked, rubs, between(line, at)[0] + deep])
                    });
                    let [(_, first), (_, last)] = ends;
                    if first[0] > 0.0 || last[0] > 0.0 {
                        let pressed = match first[3].max(last[3]) <= -most * (1.0 - HARDLY) {
                            true => CRUSHING,
                            false if depth(n) > 0.0 && depth(end) > 0.0 => CRUSHED,
                            false => PRESSED,
                        };
                        take(ends, pressed);
                    }
                };
                match self.edge(n).filter(|_| end == n + 1) {
                    Some(edge) => {
                        piece([[place(n), depth(n)], [edge, 0.0]]);
                        piece([[edge, 0.0], [place(end), depth(end)]]);
                    }
                    None => piece([[place(n), depth(n)], [place(end), depth(end)]]),
                }
                n = end;
            }
        }
        zones
    }

    /// Where what is crushed ends between a node and the next one: as the line through the last two nodes of it says, if it ends there.
    fn edge(&self, n: usize) -> Option<f64> {
        let depth = |n: Option<usize>| n.and_then(|n| self.crushed.get(n)).copied().unwrap_or(0.0);
        let [deeper, deep, rest, sense] = match [depth(Some(n)), depth(Some(n + 1))] {
            [deep, 0.0] if deep > 0.0 => [depth(n.checked_sub(1)), deep, self.place_of(n), 1.0],
            [0.0, deep] if deep > 0.0 => [depth(Some(n + 2)), deep, self.place_of(n + 1), -1.0],
            _ => return None,
        };
        let reach = deep / (deeper - deep);
        (reach > 0.0 && reach < 1.0).then(|| rest + sense * reach * self.place_of(1))
    }

    /// What is crushed at a place of it, 0 … 1 [m].
    fn deep(&self, at: f64) -> f64 {
        let last = self.crushed.len().saturating_sub(1);
        let node = at * last as f64;
        let first = (node as usize).min(last.saturating_sub(1));
        match self.crushed.get(first..=first + 1) {
            Some(ends) => ends[0] + (node - first as f64) * (ends[1] - ends[0]),
            None => 0.0,
        }
    }

    /// Place of a node of which it is known what is crushed, 0 … 1.
    fn place_of(&self, node: usize) -> f64 {
        node as f64 / (self.nodes.len().max(self.crushed.len()) - 1) as f64
    }

    /// Whether it has the nodes of a joint of this law, as one that was read back may not.
    pub(crate) fn fits(&self, law: &Law) -> bool {
        self.nodes.len() == if law.bond.is_some() { NODES } else { 0 }
            && (law.bond.is_some() || self.is_gone())
            && self.crushed.len() == crushed_nodes(law)
            && self.fibres.fit(law.cracked().in_line())
            && (1..=POINTS).contains(&self.spots.len())
            && self.spots.iter().all(|spot| spot.point < POINTS && spot.at.is_finite() && spot.share > 0.0)
            && self.held[0] < self.held[1]
            && self.held[1] < NODES
    }

    /// By what part of the pressure its points, at these gaps now [m], miss what the whole of it bears that has cracked, where some of it is crushed.
    pub(crate) fn misses(&self, law: &Law, points: &[Point], gaps: Gaps) -> f64 {
        if !self.is_gone() {
            return 0.0;
        }
        let stiffness = law.normal_stiffness();
        let Some([start, slope]) = self.gap_at(&gaps) else { return 0.0 };
        let mut found = [0.0; 2];
        for (point, gap) in gaps {
            let Some(spot) = self.spots.iter().find(|spot| spot.point == point) else { continue };
            let bears = -spot.share * stiffness * (gap + points[spot.point].crushed);
            let force = bears.clamp(-spot.edge * law.crushing, (spot.share + spot.edge) * law.crushing);
            found = [found[0] + force, found[1] + force * spot.at];
        }
        let end = start + slope;
        if self.depth() == 0.0 && -stiffness * start.min(end) <= FAR_BELOW * law.crushing {
            return 0.0;
        }
        let pressed = |n: usize| -stiffness * (start + slope * self.place_of(n) + self.crushed[n]) / law.crushing;
        // ∫ of what is borne, over the strength, to a pressure over it.
        let borne = |p: f64| if p < 1.0 { 0.5 * p.max(0.0).powi(2) } else { p - 0.5 };
        let mut whole = [0.0; 2];
        let mut from = pressed(0);
        for n in 1..self.crushed.len() {
            let to = pressed(n);
            let mean = match (to - from).abs() > NOTHING {
                true => (borne(to) - borne(from)) / (to - from),
                false => to.clamp(0.0, 1.0),
            };
            let force = law.crushing * self.place_of(1) * mean;
            whole = [whole[0] + force, whole[1] + 0.5 * force * (self.place_of(n - 1) + self.place_of(n))];
            from = to;
        }
        let off = (whole[0] - found[0]).abs().max((whole[1] - found[1]).abs());
        off / found[0].max(MISSED * law.crushing)
    }

    /// By how much more is crushed where its points are at these gaps [m], over what its springs are pressed in by where that begins.
    pub(crate) fn crushes_by(&self, law: &Law, gaps: Gaps) -> f64 {
        let most = law.crushing / law.normal_stiffness();
        let Some([start, slope]) = self.gap_at(&gaps).filter(|_| self.is_gone()) else { return 0.0 };
        if -start.min(start + slope) <= most {
            return 0.0;
        }
        let deeper = |n: usize| -(start + slope * self.place_of(n)) - self.crushed[n];
        (0..self.crushed.len()).map(deeper).fold(0.0, f64::max) / most - 1.0
    }

    /// Gap at the first end and by how much more it is at the other, where its points are at these gaps [m]; none where they are no two.
    fn gap_at(&self, gaps: &[(usize, f64)]) -> Option<[f64; 2]> {
        let standing = |point: usize| self.spots.iter().find(|spot| spot.point == point);
        let places = gaps.iter().filter_map(|(point, gap)| Some([standing(*point)?.at, *gap]));
        let [[from, near], [to, far]] = outermost(places, |place| place[0])?;
        let slope = (far - near) / (to - from);
        Some([near - slope * from, slope])
    }

    /// What is crushed between its fibres [m]; none where nothing is.
    fn crushed_at_fibres(&self) -> Option<[f64; BETWEEN_FIBRES]> {
        let last = self.crushed.len().checked_sub(1).filter(|_| !self.is_even())? as f64;
        let node = |n: usize| (n as f64 / (BETWEEN_FIBRES - 1) as f64 * last).round() as usize;
        Some(std::array::from_fn(|n| self.crushed[node(n)]))
    }

    /// Crushes what is pressed harder than it bears, its ends being as far apart as `line` says; what that takes [J].
    fn crush(&mut self, law: &Law, line: &[[f64; 2]; 2]) -> f64 {
        let most = law.crushing / law.normal_stiffness();
        // It is pressed in most at an end.
        if -line[0][0].min(line[1][0]) <= most {
            return 0.0;
        }
        let mut taken = 0.0;
        for n in 0..self.crushed.len() {
            let to = -between(line, self.place_of(n))[0] - most;
            if to > self.crushed[n] {
                taken += weight(n, self.crushed.len()) * law.crushing * (to - self.crushed[n]);
                self.crushed[n] = to;
            }
        }
        taken
    }

    /// Opening and slide of a point that is held, which go on with the motion wherever it was before.
    pub(crate) fn stretched(&self, at: f64) -> [f64; 2] {
        between(&self.line, at)
    }

    /// Takes opening and slide at the ends from the points, after a step.
    pub(crate) fn follow(&mut self, points: &[Point]) {
        // Where nothing is left of the bond, all that has cracked moves alike.
        let part = if self.is_gone() { Part::Dry } else { Part::Held };
        if let Some(line) = self.line_through(part, &ways(points)) {
            self.was = std::mem::replace(&mut self.line, line);
        }
    }

    /// Where the two points of what is left of its bond are, 0 … 1 along it.
    pub(crate) fn held_at(&self) -> [f64; HELD] {
        [0, 1].map(|k| self.spots[k].at)
    }

    /// Opening and slide at the ends where those two are stretched by so much [m].
    pub(crate) fn line_of_held(&self, stretched: [[f64; 2]; HELD]) -> [[f64; 2]; 2] {
        self.line_through(Part::Held, &|spot| stretched[spot.point]).unwrap_or(self.line)
    }

    /// Opening and slide at the ends where the points of a part have those `of` them; none where they are no two.
    fn line_through(&self, part: Part, of: &impl Fn(&Spot) -> [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let spots = self.spots.iter().filter(|spot| spot.part == part);
        let [first, second] = outermost(spots, |spot| spot.at)?;
        let (from, to, length) = (of(first), of(second), second.at - first.at);
        let at = |x: f64| [0, 1].map(|k| from[k] + (x - first.at) / length * (to[k] - from[k]));
        Some([at(0.0), at(1.0)])
    }

    /// Energy in the springs of the joint as its line and its points stand [J].
    pub(crate) fn stored(&self, law: &Law, points: &[Point]) -> f64 {
        let Normal::Springs { both, press, .. } = law.normal else { return 0.0 };
        let residual = law.bond.map_or(0.0, |bond| bond.residual);
        let shear = law.shear.stiffness;
        let breaks = law.breaking_stiffness();
        let [_, mut energy] = self.friction_borne(law, points);
        energy += self.hidden();
        for spot in &self.spots {
            let point = &points[spot.point];
            energy += match spot.part {
                Part::Held => {
                    let [w, s] = self.stretched(spot.at);
                    0.5 * spot.share * (both * w * w + breaks * s * s)
                }
                Part::Dry => {
                    let k = spot.share * (both + press);
                    let gap = point.gap + point.crushed;
                    0.5 * k * gap.min(0.0).powi(2)
                }
                // Of the whole there is no point where there is a bond.
                Part::Whole | Part::Stays => 0.5 * residual * shear * point.slide * point.slide,
            };
        }
        energy
    }

    /// Whether nothing of it has cracked nor comes near its strength where its ends are as far apart as `line` says: most joints at most times.
    fn is_far_from_cracking(&self, law: &Law, [near, far]: &[[f64; 2]; 2]) -> bool {
        let Normal::Springs { both, press, .. } = law.normal else { return false };
        let sheared = law.shear.stiffness * near[1].abs().max(far[1].abs());
        let pressed = (both + press) * (-near[0].min(far[0])).max(0.0);
        let opened = near[0].max(far[0]);
        let bond = law.bond.unwrap_or_default();
        let pulled = law.shear.stiffness * law.pulled(opened);
        self.cracked.is_infinite()
            && both * (opened - TOUCHING) <= bond.tension
            && sheared + pulled <= bond.cohesion
            && pressed <= law.crushing
    }

    /// What the bond loses in a step that ends with its ends as far apart as `line` says; none if it loses nothing.
    pub(crate) fn softened(&self, law: &Law, line: &[[f64; 2]; 2], still: bool) -> Option<Softened> {
        let bond = law.bond?;
        if self.is_gone() || self.is_far_from_cracking(law, line) {
            return None;
        }
        let mut softened = Softened { left: [[0.0; 2]; 2], ..Softened::NOTHING };
        let (mut worn, mut held) = (false, [0.0; 2]);
        let [near, far] = self.held_at();
        let middle = 0.5 * (near + far);
        for n in 0..NODES {
            let x = place(n);
            let [w, s] = between(line, x);
            let (before, weight) = (self.nodes[n], weight(n, NODES));
            let half = usize::from(x > middle);
            let had = weight * (1.0 - before.damage());
            let [opened, slid] = between(&self.line, x);
            held[half] += had;
            let Wear { node, less, taken } = before.on_the_way([opened, slid], [w, s], law, &bond);
            if node == before {
                softened.left.iter_mut().for_each(|left| left[half] += had);
                continue;
            }
            worn = true;
            softened.breaks_at = earlier(softened.breaks_at, before.breaks_at(&node, [opened, slid], [w, s], law));
            let keeps = weight * (1.0 - node.damage());
            let [opens, slides] = less[usize::from(still)].map(|lost| weight * lost);
            softened.across = [softened.across[0] + opens, softened.across[1] + x * opens];
            softened.along += slides;
            softened.taken += weight * taken;
            // What is pressed of what breaks stays pressed. What softens bears the less the farther it is stretched: it resists nothing.
            let bears = if w > 0.0 { keeps } else { had };
            let lost = [0, 1].map(|k| node.lost[k] > before.lost[k]);
            softened.left[0][half] += if w > 0.0 && lost[0] { 0.0 } else { bears };
            softened.left[1][half] += if lost[1] { 0.0 } else { keeps };
        }
        for left in &mut softened.left {
            *left = [0, 1].map(|half| if held[half] > 0.0 { left[half] / held[half] } else { 0.0 });
        }
        worn.then_some(softened)
    }

    /// What the bond lost in a step of a joint with springs that ended at `time` [s], and what was crushed; its points are placed anew where it lost
    /// something or other parts of it are open, pressed or crushing.
    pub(crate) fn wear(&mut self, law: &Law, points: &mut [Point], parting: [f64; 2], still: bool, time: f64) -> Worn {
        if !law.is_compliant() {
            return Worn::default();
        }
        let intact = self.cracked.is_infinite();
        if self.is_far_from_cracking(law, &self.line) {
            return Worn::default();
        }
        let bond = law.bond.unwrap_or_default();
        let mut friction = [0.0; 2];
        let mut taken = 0.0;
        let mut worn = false;
        let mut breaks_at: Option<f64> = None;
        let bonded = if self.is_gone() { 0 } else { self.nodes.len() };
        for n in 0..bonded {
            let x = place(n);
            let [w, s] = self.stretched(x);
            let weight = weight(n, NODES);
            let then = between(&self.was, x);
            let before = self.nodes[n];
            let Wear { node, taken: lost, .. } = before.on_the_way(then, [w, s], law, &bond);
            // A crushed node may have taken nothing.
            if node == before {
                continue;
            }
            self.nodes[n] = node;
            let [had, keeps] = [before, node].map(|node| node.friction([w, s], law));
            friction[0] -= weight * (keeps[0] - had[0]) * s.signum();
            friction[1] += weight * (keeps[1] - had[1]);
            worn = true;
            breaks_at = earlier(breaks_at, before.breaks_at(&node, then, [w, s], law));
            taken += weight * (lost - (keeps[1] - had[1]));
            self.reach = self.reach.max(w.max(s.abs()));
        }
        // Breaking gives nothing back: where a wall falls on its edges, what friction would store beyond it is lost in impacts.
        let mut taken = taken.max(0.0);
        // What is left of it has no points any more.
        if worn && 1.0 - self.damage() <= NOTHING {
            self.nodes.fill(Node::GONE);
        }
        // What has cracked opens as the edges of the blocks stand, what is held by how far it was stretched: they differ by rounding and by turning.
        let dry_line = |crack: &Self| crack.line_through(Part::Dry, &ways(points)).unwrap_or(crack.line);
        let line = if bonded == 0 { self.line } else { dry_line(self) };
        let shallower = if still { None } else { self.crushed_at_fibres() };
        let crushed = self.crush(law, &line);
        let ended = Ended { line: &line, still, parting, shallower: shallower.as_ref() };
        let dry = || self.spots.iter().filter(|spot| spot.part == Part::Dry);
        // What the points have crushed in the step is told as theirs.
        let told: f64 = dry().map(|spot| (points[spot.point].crushed - spot.crushed) * spot.share).sum();
        let new = worn || crushed > 0.0 || told > 0.0;
        if !new && intact {
            return Worn::default();
        }
        let breaks = !self.is_gone() && self.nodes.iter().all(|node| node.damage() == 1.0);
        if breaks {
            self.broken = time;
        }
        let zones = self.zones(law, &line);
        if !new && self.stand(&zones, still) {
            return self.rub(law, points, &ended);
        }
        taken += crushed - if told > 0.0 { law.crushing * told } else { 0.0 };
        let before = self.stored(law, points);
        let [borne, stored] = self.friction_borne(law, points);
        self.cracked = self.cracked.min(time);
        // Points go on with the speed of the nearest one.
        let mut speeds = [[f64::NAN; 2]; DRY];
        dry().zip(&mut speeds).for_each(|(spot, speed)| *speed = [spot.at, points[spot.point].speed]);
        let handed = [borne + friction[0], stored + friction[1]];
        if breaks && self.fibres.are_there() {
            let stretch = handed[0] / law.breaking_stiffness();
            self.fibres.begin(|x| between(&line, x)[1] + stretch);
        }
        self.place(law, &line, &zones, still);
        for spot in self.spots.iter().filter(|spot| spot.part == Part::Dry) {
            let [gap, slide] = between(&line, spot.at);
            let nearest = speeds.iter().filter(|speed| !speed[0].is_nan()).min_by(|a, b| {
                let [a, b] = [a, b].map(|speed| (speed[0] - spot.at).abs());
                a.total_cmp(&b)
            });
            let speed = nearest.map_or(0.0, |speed| speed[1]);
            points[spot.point] = Point { gap, slide, speed, crushed: spot.crushed, ..points[spot.point] };
        }
        self.set(points);
        let rubbed = if self.fibres.are_there() && self.is_gone() {
            // Springs along are theirs.
            self.follow_fibres(law, points, &ended, handed[1])
        } else {
            self.share_friction(law, points, &self.limits(law, points, &ended), handed);
            stored + friction[1] - self.friction_borne(law, points)[1]
        };
        // What the next step takes them to bear before it knows better.
        for spot in self.spots.iter().filter(|spot| spot.part == Part::Dry) {
            let point = &mut points[spot.point];
            point.force = [spot.share * law.normal_stiffness() * (-point.gap - point.crushed).max(0.0), point.bearing];
        }
        let lost = before - self.stored(law, points);
        Worn { bond: taken, friction: rubbed, beyond: lost - taken - rubbed, breaks_at }
    }

    /// Parting velocities of the ends of a joint that can be crushed, where its points part at `mean` [m/s]; 0 without inertia and of all others.
    pub(crate) fn parting(&self, law: &Law, still: bool, mean: &dyn Fn(usize) -> f64) -> [f64; 2] {
        if still || law.crushing.is_infinite() {
            return [0.0; 2];
        }
        let dry = self.spots.iter().enumerate().filter(|(_, spot)| spot.part == Part::Dry);
        let first = dry.clone().min_by(|a, b| a.1.at.total_cmp(&b.1.at));
        let last = dry.max_by(|a, b| a.1.at.total_cmp(&b.1.at));
        let (Some((first, from)), Some((last, to))) = (first, last) else { return [0.0; 2] };
        let [near, far] = [mean(first), mean(last)];
        let slope = if to.at > from.at { (far - near) / (to.at - from.at) } else { 0.0 };
        [near - slope * from.at, near + slope * (1.0 - from.at)]
    }

    /// Whether a rigid joint cracks farther under what its points bear, `force` [N], or breaks as it slides.
    pub(crate) fn breaks_rigid(&self, law: &Law, force: &dyn Fn(usize) -> [f64; 2], slid: bool) -> bool {
        let Some(bond) = law.bond.filter(|_| !self.is_gone()) else { return false };
        let Front { held, gone, .. } = self.front(&bond, force, slid);
        gone || held != self.held
    }

    /// How far a rigid joint cracks under what its points bear, `force` [N]; it is `gone` where it slid. Of a joint that is pulled as a whole, what its bond bears along is the same
    /// all over what is held, and takes from the tension that its tip bears, as (P9) says.
    fn front(&self, bond: &Bond, force: &dyn Fn(usize) -> [f64; 2], mut gone: bool) -> Front {
        let sum = |f: &dyn Fn(&Spot) -> f64| self.spots.iter().map(|s| force(s.point)[0] * f(s)).sum::<f64>();
        let (normal, moment) = (sum(&|_| 1.0), sum(&|spot| spot.at - 0.5));
        let held = self.spots.iter().filter(|spot| spot.part == Part::Held);
        let shear = held.map(|spot| force(spot.point)[1]).sum::<f64>().abs();
        let bears = |first: usize, last: usize| {
            let (left, tan) = (bond.cohesion - shear / (place(last) - place(first)), bond.tan_pulled());
            if normal < 0.0 && tan > 0.0 && left < tan * bond.tension { left.max(0.0) / tan } else { bond.tension }
        };
        // The edges of an uncracked joint are stressed by N ∓ 6 M/ℓ over its area.
        let stressed = |first: usize, last: usize| match last - first == NODES - 1 {
            true => Some([normal - 6.0 * moment, normal + 6.0 * moment]),
            false => plane(normal, moment, first, last),
        };
        let [mut first, mut last] = self.held;
        let mut begins = None;
        let over = loop {
            let tips = stressed(first, last);
            let over = tips.map_or(f64::INFINITY, |[a, b]| -a.min(b) - bears(first, last));
            begins.get_or_insert(over);
            if gone || over <= 0.0 {
                break over;
            }
            match tips {
                Some([a, b]) if a <= b => first += 1,
                Some(_) => last -= 1,
                None => gone = true,
            }
            gone |= first >= last;
        };
        Front { held: [first, last], gone, begins: begins.unwrap_or(over), over }
    }

    /// Breaks a rigid joint by what its points bear, or that slides, in a step that ended at `time` [s]; it bears `borne` across and along [N]. Returns how much of
    /// the change of its forces was over when it cracked or broke, 0 … 1; none where it did not.
    pub(crate) fn break_rigid(
        &mut self,
        law: &Law,
        points: &mut [Point],
        slid: bool,
        borne: [f64; 2],
        time: f64,
    ) -> Option<f64> {
        let bond = law.bond?;
        if self.is_gone() {
            return None;
        }
        let parted = bond.tension == 0.0
            && self.spots.iter().any(|spot| spot.part == Part::Held && points[spot.point].gap > TOUCHING);
        let Front { held: [first, last], gone, begins, over } =
            self.front(&bond, &|point| points[point].force, slid || parted);
        let (was, before) = (std::mem::replace(&mut self.borne, borne), std::mem::replace(&mut self.over, over));
        if !gone && [first, last] == self.held {
            return None;
        }
        let begins = Some(begins).filter(|over| *over > 0.0 && before.is_finite());
        let part = begins.map_or(1.0, |over| if before < 0.0 { before / (before - over) } else { 0.0 });
        let [across, along] = [0, 1].map(|k| was[k] + part * (borne[k] - was[k]));
        self.peak = [self.peak[0].max(-across), self.peak[1].max(along.abs())];
        if !gone {
            self.held = [first, last];
        }
        for (n, node) in self.nodes.iter_mut().enumerate() {
            if gone || n < first || n > last {
                *node = Node::GONE;
            }
        }
        self.cracked = self.cracked.min(time);
        if gone {
            self.broken = self.broken.min(time);
        }
        self.place(law, &self.line.clone(), &[Zone::default(); ZONES], true);
        self.set(points);
        Some(part)
    }
}

/// How far a rigid joint cracks.
struct Front {
    /// First and last node of what is held then, and whether nothing is.
    held: [usize; 2],
    gone: bool,
    /// By how much the larger stress at the tips is above the tensile strength, before it cracks and after [N].
    begins: f64,
    over: f64,
}

/// Stress over a mean of 1 at the tips of what is held from node `first` to node `last`, pressing above 0, of a plane section that balances `normal`
/// and `moment` about the middle [N, both over a joint of length 1]; what has cracked presses only. None where nothing balances them.
fn plane(normal: f64, moment: f64, first: usize, last: usize) -> Option<[f64; 2]> {
    let mut line = [normal, 0.0];
    for _ in 0..2 * NODES {
        // What bears: what is held, and what has cracked where it is pressed.
        let mut sums = [0.0; 3];
        for n in 0..NODES - 1 {
            let [from, middle, to] = [0.0, 0.5, 1.0].map(|part| (n as f64 + part) / (NODES - 1) as f64 - 0.5);
            if (first..last).contains(&n) || line[0] + line[1] * middle > 0.0 {
                let whole = |k: i32| (from.powi(k) + 4.0 * middle.powi(k) + to.powi(k)) / (6.0 * (NODES - 1) as f64);
                (0..3).for_each(|k| sums[k as usize] += whole(k));
            }
        }
        let [a, b, c] = sums;
        let whole = a * c - b * b;
        if !(whole > 1e-12) {
            return None;
        }
        let next = [(c * normal - b * moment) / whole, (a * moment - b * normal) / whole];
        let settled = (0..2).all(|k| (next[k] - line[k]).abs() <= 1e-9 * (normal.abs() + moment.abs()));
        line = next;
        if settled {
            break;
        }
    }
    Some([first, last].map(|n| line[0] + line[1] * (place(n) - 0.5)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::{Friction, Shear};
    use concio_verified::agrees;

    /// One node of a joint of 0.3 m²: f_t 50 kPa, c 20 kPa, tan φ 0.6, 20 and 100 N/m.
    fn law() -> Law {
        Law {
            normal: Normal::Springs { both: 3e9, press: 0.0, damping: 0.0 },
            shear: Shear { stiffness: 3e9, damping: 0.0, series: false },
            bond: Some(Bond { tension: 15e3, cohesion: 6e3, tan_angle: 0.6, energy: [6.0, 30.0], residual: 0.0 }),
            ..Law::dry(Some(Friction::coulomb(0.6)))
        }
    }

    /// What the seventh node lost.
    fn wear_node(crack: &mut Crack, at: [f64; 2], was: [f64; 2], law: &Law, bond: &Bond) -> f64 {
        let (node, lost) = crack.nodes[7].worn(at, was, law, bond);
        crack.nodes[7] = node;
        lost
    }

    fn stretch(crack: &mut Crack, from: [f64; 2], to: [f64; 2], law: &Law) -> f64 {
        let bond = law.bond.expect("a bond");
        let mut taken = 0.0;
        let steps = 2000;
        let mut was = from;
        for n in 1..=steps {
            let at = [0, 1].map(|k| from[k] + (to[k] - from[k]) * f64::from(n) / f64::from(steps));
            taken += wear_node(crack, at, was, law, &bond);
            was = at;
        }
        taken
    }

    /// What a node has lost by opening it does not bear in shear, nor what it lost in shear in tension.
    #[test]
    fn one_damage_weakens_both_strengths() {
        let law = law();
        let pressed = -60e3 / 3e9;
        let mut crack = Crack::of(&law).expect("a bond");
        // δ_c of opening is G/f_t and a little less: χ = 0.9 at 2.3 of it.
        stretch(&mut crack, [0.0; 2], [2.303 * 6.0 / 15e3, 0.0], &law);
        let chi = crack.nodes[7].chi();
        assert!((chi - 0.9).abs() < 0.01, "{chi}");
        stretch(&mut crack, [pressed, 0.0], [pressed, 3.2e-3], &law);
        let (damage, left) = (crack.nodes[7].damage(), crack.nodes[7].left);
        let strength = 6e3 + 0.6 * 60e3;
        // (B5) with what is left, at most.
        assert!((1.0 - damage) * 3e9 * 3.2e-3 <= (1.0 - chi) * strength * (1.0 + 1e-9));
        let rubs = (1.0 - left) * 0.6 * 60e3;
        assert!((1.0 - damage) * 3e9 * 3.2e-3 + rubs <= (1.0 - chi) * strength + 0.6 * 60e3);
        let mut crack = Crack::of(&law).expect("a bond");
        stretch(&mut crack, [0.0; 2], [0.0, 5e-3], &law);
        let left = crack.nodes[7].left;
        stretch(&mut crack, [0.0, 5e-3], [1e-4, 5e-3], &law);
        assert!((1.0 - crack.nodes[7].damage()) * 3e9 * 1e-4 <= left * 15e3 * (1.0 + 1e-9));
    }

    /// Either mode takes its energy, however it is approached, and gives the curve of (B3).
    #[test]
    fn a_node_follows_its_softening_and_takes_its_energy() {
        let law = law();
        for (mode, strength) in [(0, 15e3), (1, 6e3)] {
            let mut crack = Crack::of(&law).expect("a bond");
            let bond = law.bond.expect("a bond");
            let along = |way: f64| if mode == 0 { [way, 0.0] } else { [0.0, way] };
            let limit = strength / 3e9;
            let decay = (bond.energy[mode] - 0.5 * strength * limit) / ((1.0 - BROKEN) * strength);
            let mut taken = stretch(&mut crack, [0.0; 2], along(limit + decay), &law);
            let force = (1.0 - crack.nodes[7].damage()) * 3e9 * (limit + decay);
            assert!((force / (strength * (-1.0f64).exp()) - 1.0).abs() < 1e-6, "{force}");
            taken += stretch(&mut crack, along(limit + decay), along(limit + 8.0 * decay), &law);
            assert!(crack.nodes[7].damage() == 1.0 && (taken / bond.energy[mode] - 1.0).abs() < 1e-3, "{taken}");
        }
    }

    /// A break in both modes takes no more than the tougher one alone, whatever the path, and half of the weaker at least: work of the stresses along it.
    #[test]
    fn mixed_modes_take_what_lies_between() {
        let law = law();
        let bond = law.bond.expect("a bond");
        let far = [8.0 * bond.energy[0] / bond.tension, 8.0 * bond.energy[1] / bond.cohesion];
        let half = [0.25 * bond.energy[0] / bond.tension, 0.25 * bond.energy[1] / bond.cohesion];
        let straight = |ratio: f64| vec![[0.0; 2], [ratio.min(1.0) * far[0], (1.0 / ratio).min(1.0) * far[1]]];
        let paths = [
            straight(1.0),
            straight(0.1),
            straight(10.0),
            vec![[0.0; 2], [half[0], 0.0], [half[0], far[1]], far],
            vec![[0.0; 2], [0.0, half[1]], [far[0], half[1]]],
            vec![[0.0; 2], half, [0.0, half[1]], [0.0, far[1]]],
        ];
        for path in paths {
            let mut crack = Crack::of(&law).expect("a bond");
            let (mut work, mut taken, mut was) = (0.0, 0.0, [0.0; 2]);
            let stresses =
                |crack: &Crack, [w, s]: [f64; 2]| [w, s].map(|way| (1.0 - crack.nodes[7].damage()) * 3e9 * way);
            for leg in path.windows(2) {
                let steps = 40_000;
                for n in 1..=steps {
                    let at = [0, 1].map(|k| leg[0][k] + (leg[1][k] - leg[0][k]) * f64::from(n) / f64::from(steps));
                    let before = stresses(&crack, was);
                    taken += wear_node(&mut crack, at, was, &law, &bond);
                    let after = stresses(&crack, at);
                    work += (0..2).map(|k| 0.5 * (before[k] + after[k]) * (at[k] - was[k])).sum::<f64>();
                    was = at;
                }
            }
            assert_eq!(crack.nodes[7].damage(), 1.0, "{path:?}");
            let [least, most] = bond.energy;
            assert!(work > 0.5 * least && work < 1.001 * most, "{work} J along {path:?}");
            assert!((taken / work - 1.0).abs() < 0.02, "{taken} J booked of {work} J along {path:?}");
        }
    }

    /// Both orders against what follows from (P9) by hand.
    #[test]
    fn modes_in_either_order_follow_their_closed_forms() {
        let law = law();
        let bond = law.bond.expect("a bond");
        let (k, a) = (3e9, bond.tan_pulled());
        let [f, c] = [bond.tension, bond.cohesion];
        let softens = |mode: usize, strength: f64| {
            (bond.energy[mode] - 0.5 * strength * strength / k) / ((1.0 - BROKEN) * strength)
        };
        let [opens, shears] = [softens(0, f), softens(1, c)];
        let bears = |crack: &Crack, way: f64| (1.0 - crack.nodes[7].damage()) * k * way;

        let mut crack = Crack::of(&law).expect("a bond");
        let slid = 2e-3;
        stretch(&mut crack, [0.0; 2], [0.0, slid], &law);
        let sheared = |w: f64| (-(slid + a * w - c / k) / shears).exp();
        // The opening at which it comes to its own limit: at w_1 = e^−ξ f_t/k_n, which the slide alone has set.
        let limit = (0..50).fold(0.0, |w, _| sheared(w) * f / k);
        let mut was = 0.0;
        for w in [0.2e-3, 0.4e-3, 0.8e-3, 1.2e-3] {
            stretch(&mut crack, [was, slid], [w, slid], &law);
            let left = sheared(w) * (-(w - limit) / opens).exp();
            let expected = left * f.min(c * w / (slid + a * w));
            let found = bears(&crack, w);
            let subject = format!("Bonds: a point that slides 2 mm and then opens; by {} mm", 1e3 * w);
            agrees!(subject, "(P11) of docs/planar.md", "N", found, expected, 1e-3);
            was = w;
        }

        // Stiffer pressed than sheared, tougher sheared than opened.
        let softer = Law {
            normal: Normal::Springs { both: 2.4e8, press: 0.0, damping: 0.0 },
            shear: Shear { stiffness: 1e8, damping: 0.0, series: false },
            bond: Some(Bond { tension: 10e3, cohesion: 15e3, tan_angle: 0.6, energy: [10.0, 50.0], residual: 0.0 }),
            ..law
        };
        for (name, law, open) in [("a", law, 0.3e-3), ("a", law, 1e-3), ("a softer", softer, 0.98e-3)] {
            let (bond, Normal::Springs { both, .. }) = (law.bond.expect("a bond"), law.normal) else { unreachable!() };
            let ([f, c], k, a) = ([bond.tension, bond.cohesion], law.shear.stiffness, law.pulled(1.0));
            let softens = |mode: usize, strength: f64, k: f64| {
                (bond.energy[mode] - 0.5 * strength * strength / k) / ((1.0 - BROKEN) * strength)
            };
            let [opens, shears] = [softens(0, f, both), softens(1, c, k)];
            let mut crack = Crack::of(&law).expect("a bond");
            stretch(&mut crack, [0.0; 2], [open, 0.0], &law);
            let first = (-(open - f / both) / opens).exp();
            // What its slide and the tension that it bears together ask of it.
            let way = |slide: f64| {
                let pulled = |q: f64| (f * k * q / (c * both * open)).min(1.0) * a * open;
                let (mut less, mut more) = (slide, slide + a * open);
                for _ in 0..60 {
                    let half = 0.5 * (less + more);
                    *if slide + pulled(half) > half { &mut less } else { &mut more } = half;
                }
                0.5 * (less + more)
            };
            let mut was = 0.0;
            for s in [0.05e-3, 0.5e-3, 2e-3, 4e-3, 8e-3] {
                stretch(&mut crack, [open, was], [open, s], &law);
                let left = first * (-(s - first * (c - f * bond.tan_angle) / k).max(0.0) / shears).exp();
                let expected = left * (c * s / way(s)).min(f * k * s / (both * open));
                let found = (1.0 - crack.nodes[7].damage()) * k * s;
                let subject =
                    format!("Bonds: {name} point that opens {} mm and then slides; by {} mm", 1e3 * open, 1e3 * s);
                agrees!(subject, "(P12) of docs/planar.md", "N", found, expected, 1e-3);
                was = s;
            }
        }
    }

    /// An intact joint has two points with the stiffness against turning of the whole; one that has lost its bond three.
    #[test]
    fn points_have_the_stiffness_of_the_joint() {
        let law = law();
        let mut crack = Crack::of(&law).expect("a bond");
        let moments = |crack: &Crack| {
            [0, 1, 2].map(|k| crack.spots().iter().map(|s| s.share * (s.at - 0.5).powi(k)).sum::<f64>())
        };
        let close = |found: [f64; 3], within: f64| {
            let whole = [1.0, 0.0, 1.0 / 12.0];
            assert!((0..3).all(|k| (found[k] - whole[k]).abs() < within), "{found:?}");
        };
        assert_eq!(crack.spots().len(), 2);
        close(moments(&crack), 1e-15);
        for cracked in [5, 20, 40, NODES] {
            crack.nodes[..cracked].fill(Node::GONE);
            crack.broken = if cracked == NODES { 0.0 } else { f64::INFINITY };
            crack.place(&law, &[[0.0; 2]; 2], &crack.zones(&law, &[[0.0; 2]; 2]), true);
            close(moments(&crack), 4e-3);
            let weights: f64 = crack.spots().iter().map(|s| s.weight).sum();
            assert!((weights - 1.0).abs() < 1e-2, "{weights}");
        }
        assert_eq!(crack.spots().len(), 3);
    }
}
