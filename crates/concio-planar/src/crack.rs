//! Bonded joints: a crack that runs along the joint from where it opens.
//!
//! A joint between rigid blocks opens and slides by straight lines along its length. Its bond is known at equally spaced nodes,
//! with what it lost in between by straight lines too. What is left of it acts in both directions and gives two contact points the
//! stiffness against parting and against turning that it has in all, exactly: half of it at each, at the distance of its radius of gyration
//! from its centre. What has cracked acts in compression alone, at three points with its stiffness and turning, where a part of it is pressed
//! and a part open at three each, where joints may be crushed at nine. It rubs for the whole joint: friction at springs that pull too would have a kink, where contact is hard to solve.
//! Its friction is in line with the part D of the stiffness along: a joint that sticks is as stiff as before it cracked (Alfano & Sacco 2006), and of
//! the shear that breaks a part of it friction goes on to bear what it can.
//!
//! At a node that is stretched by w across and s along the joint,
//!
//! (P9)  σ = (1 − D) k_n w ≤ e^−ξ f_t,   |τ| = (1 − D) k_t |s| ≤ e^−ξ (c + p tan φ)
//!
//! p being the pressure there. Where a limit is passed, ξ grows by the way that goes beyond it over δ_c of that mode, and what that mode alone
//! would lose of its stiffness to where the limit is met; D is the larger loss of the two. One ξ weakens both strengths, as mixed modes do (Lourenço & Rots
//! 1997); stiffness that is lost in one mode does not put off the limit of the other. Along one mode alone that is (B3). χ = 1 − e^−ξ is
//! the part that rubs, so that shear stays within (B5). δ_c follows from G_f with the strength of the moment, S = f_t of opening, c + p tan φ of shear, and with
//! what friction goes on to bear of it, R = min(μ p, S) of shear, so that all that the bond loses is G_f:
//!
//! (P10)  G_f = ½ (S² − R²)/k + (1 − ε) S δ_c
//!
//! which is (B4) but for what the springs of friction keep. Where pressure changes as it breaks, δ_c is that with which the rest of G_f goes.
//!
//! Rigid joints break by plane sections: the stress of the joint is the straight line that balances what its points bear, cracked parts pressing only;
//! the crack runs as far as it is above f_t at its tip.

use serde::{Deserialize, Serialize};

use crate::joint::{Bond, Law, Normal, Point};

/// Nodes of a joint: a crack advances by a sixty-fourth of it.
const NODES: usize = 65;
/// Points of what has cracked.
pub(crate) const DRY: usize = 9;
/// Points of what is left of the bond.
pub(crate) const HELD: usize = 2;
/// Points of a bonded joint, the last for the spring that stays beside friction.
pub(crate) const POINTS: usize = HELD + DRY + 1;
/// What the weights of the nine points are, over those of trapezoids: so they turn as a layer of springs does, where all has cracked.
const GREGORY: [f64; DRY] = {
    let [end, next, third] = [0.75, 7.0 / 6.0, 23.0 / 24.0];
    [end, next, third, 1.0, 1.0, 1.0, third, next, end]
};
/// Those of the nine that are taken where three do.
const THREE: [usize; 3] = [0, 4, 8];
/// Those that are taken where two stand for what lies on one side of where the joint's sides touch, and two for what lies on the other.
const FOUR: [[usize; 2]; 2] = [[0, 2], [8, 6]];
/// Moments of the whole joint.
const WHOLE: Moments = [1.0, 0.5, 1.0 / 3.0];
/// Part of its strength below which a bond counts as broken, ε of (B4).
const BROKEN: f64 = 1e-3;
/// Part of what is pressed or open by which the place where sides touch may move away before points are placed anew.
const NEARLY: f64 = 1.0 / 32.0;
/// Distance up to which sides touch [m]: more than positions are rounded by.
const TOUCHING: f64 = 1e-12;
/// Part of a joint below which what is left of its bond is rounding.
const NOTHING: f64 = 1e-9;

/// A node of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Node {
    /// e^−ξ: what is left of both strengths.
    left: f64,
    /// What opening and shear alone would have lost of the stiffness.
    lost: [f64; 2],
    /// The part of G_f that opening and shear still have to take.
    rest: [f64; 2],
}

impl Node {
    const INTACT: Node = Node { left: 1.0, lost: [0.0; 2], rest: [1.0; 2] };
    const GONE: Node = Node { left: 0.0, lost: [1.0; 2], rest: [0.0; 2] };

    /// D.
    fn damage(&self) -> f64 {
        self.lost[0].max(self.lost[1])
    }

    /// χ.
    fn chi(&self) -> f64 {
        1.0 - self.left
    }

    /// What friction bears of the shear that broke it after the slide `s` [m], under the pressure of an opening `w`, and what its springs store
    /// then, of a joint as it would be everywhere [N, J].
    fn friction(&self, [w, s]: [f64; 2], law: &Law) -> [f64; 2] {
        let (along, damage) = (law.breaking_stiffness(), self.damage());
        let [_, goes_on] = law.shear_strengths(law.normal_stiffness() * (-w).max(0.0));
        let borne = (self.chi() * goes_on).min(damage * along * s.abs());
        [borne, if borne > 0.0 { 0.5 * borne * borne / (damage * along) } else { 0.0 }]
    }
}

/// What a point of a bonded joint stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// The joint as it is, without bond.
    Whole,
    /// What is left of the bond.
    Held,
    /// What has cracked.
    Dry,
    /// The spring that stays beside friction.
    Stays,
}

/// A contact point of a bonded joint.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// The part of its friction that acts.
    pub rubbing: f64,
}

/// The state of the bond of one joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Crack {
    nodes: Vec<Node>,
    /// Opening and slide at both ends, now and a step before [m].
    line: [[f64; 2]; 2],
    was: [[f64; 2]; 2],
    /// First and last node of a rigid joint that are held.
    held: [usize; 2],
    /// Where its sides touch, between nodes, where a part of what has cracked is open and a part pressed; else 0.
    split: f64,
    /// When it first cracked [s]; infinite while it is intact.
    pub cracked: f64,
    /// When nothing was left of it [s].
    pub broken: f64,
    /// How far it was stretched at most where it has cracked [m].
    pub reach: f64,
    /// What its points stand for; follows from the nodes.
    #[serde(skip)]
    spots: Vec<Spot>,
}

/// What became of the bond in a step [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Worn {
    /// What breaking took.
    pub bond: f64,
    /// What springs lost beside that, because a step goes beyond a limit before it is met, and where points are placed anew.
    pub beyond: f64,
}

/// Place of a node, 0 … 1.
fn place(node: usize) -> f64 {
    node as f64 / (NODES - 1) as f64
}

/// On the way from one end to the other.
fn between(line: &[[f64; 2]; 2], at: f64) -> [f64; 2] {
    [0, 1].map(|k| line[0][k] + at * (line[1][k] - line[0][k]))
}

/// ∫ f x^k over the joint for k of 0, 1 and 2.
type Moments = [f64; 3];

/// Moments of all between two places, counted in nodes.
fn whole_between(places: [f64; 2]) -> Moments {
    let [from, to] = places.map(|at| at / (NODES - 1) as f64);
    [to - from, (to * to - from * from) / 2.0, (to.powi(3) - from.powi(3)) / 3.0]
}

/// What a point at the edge of a part of the joint bears and what another one, so that they have these moments (Gauss and Radau): a part that is pressed
/// bears what it should to second order in how far its end is from where it was taken to be. And where the other is.
fn edge_and_inside(moments: Moments, edge: f64) -> ([f64; 2], f64) {
    let [whole, first, second] = moments;
    let [first, second] = [first - edge * whole, second - edge * (2.0 * first - edge * whole)];
    let inside = if second > 0.0 { first * first / second } else { 0.0 };
    ([whole - inside, inside], if first == 0.0 { edge } else { edge + second / first })
}

/// What three points at the ends and the middle of a part of the joint bear, from `from` on and of this length, so that they have these moments.
fn thirds(moments: Moments, from: f64, length: f64) -> [f64; 3] {
    let [whole, first, second] = moments;
    let [first, second] =
        [(first - from * whole) / length, (second - from * (2.0 * first - from * whole)) / (length * length)];
    [whole - 3.0 * first + 2.0 * second, 4.0 * (first - second), 2.0 * second - first]
}

/// Whether the points of a joint of this law move, as a bond cracks or a part of the joint opens.
pub(crate) fn moves(law: &Law) -> bool {
    law.bond.is_some() || law.parts_freely()
}

/// How many points a joint of this law has at most.
pub(crate) fn most_points(law: &Law) -> usize {
    if moves(law) { POINTS } else { law.shares().len() }
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
            split: 0.0,
            cracked: since,
            broken: since,
            reach: 0.0,
            spots: Vec::with_capacity(POINTS),
        };
        crack.place(law);
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
        self.nodes.iter().all(|node| node.damage() == 1.0)
    }

    /// Of what is linear between nodes.
    fn mean(&self, f: impl Fn(usize) -> f64) -> f64 {
        let ends = 0.5 * (f(0) + f(NODES - 1));
        (ends + (1..NODES - 1).map(f).sum::<f64>()) / (NODES - 1) as f64
    }

    /// D on the way from a node to the next.
    fn damage_between(&self, n: usize, part: f64) -> f64 {
        let [from, to] = [n, n + 1].map(|n| self.nodes[n].damage());
        from + part * (to - from)
    }

    /// χ there.
    fn chi_between(&self, n: usize, part: f64) -> f64 {
        let [from, to] = [n, n + 1].map(|n| self.nodes[n].chi());
        from + part * (to - from)
    }

    /// Moments of D and of χ between two places, counted in nodes.
    fn moments(&self, [first, last]: [f64; 2]) -> [Moments; 2] {
        if self.is_gone() {
            return [whole_between([first, last]); 2];
        }
        let mut sums = [[0.0; 3]; 2];
        for n in first as usize..last.ceil() as usize {
            // What cracks runs along a part of the joint: the rest has nothing to add.
            let [from, to] = [n, n + 1].map(|n| self.nodes[n].damage());
            if from == 0.0 && to == 0.0 {
                continue;
            }
            let [start, end] = [(first - n as f64).max(0.0), (last - n as f64).min(1.0)];
            for (part, factor) in [(start, 1.0), (0.5 * (start + end), 4.0), (end, 1.0)] {
                let x = (n as f64 + part) / (NODES - 1) as f64;
                let values = [self.damage_between(n, part), self.chi_between(n, part)];
                for (sum, value) in sums.iter_mut().zip(values) {
                    for (k, power) in [1.0, x, x * x].into_iter().enumerate() {
                        sum[k] += factor * (end - start) * value * power;
                    }
                }
            }
        }
        sums.map(|sum| sum.map(|moment| moment / (6.0 * (NODES - 1) as f64)))
    }

    /// Whether it has the nodes of a joint of this law, as one that was read back may not.
    pub(crate) fn fits(&self, law: &Law) -> bool {
        self.nodes.len() == if law.bond.is_some() { NODES } else { 0 }
            && (0.0..(NODES - 1) as f64).contains(&self.split)
            && self.held[0] < self.held[1]
            && self.held[1] < NODES
    }

    /// Gives the points what follows from its state: stretch of what is held, and what part of friction acts.
    pub(crate) fn set(&self, points: &mut [Point]) {
        for spot in &self.spots {
            let point = &mut points[spot.point];
            point.rubbing = spot.rubbing;
            if spot.part == Part::Held {
                [point.gap, point.slide] = self.stretched(spot.at);
            }
        }
    }

    /// Takes the points from the nodes.
    pub(crate) fn place(&mut self, law: &Law) {
        let mut spots = std::mem::take(&mut self.spots);
        spots.clear();
        match law.normal {
            Normal::Rigid { .. } => self.place_rigid(&mut spots),
            Normal::Springs { both, press, .. } => self.place_springs([both, press], law, &mut spots),
        }
        self.spots = spots;
    }

    fn place_rigid(&self, spots: &mut Vec<Spot>) {
        let [first, last] = self.held;
        let dry = |end: usize, weight: f64| Spot {
            point: HELD + end * (DRY - 1),
            part: Part::Dry,
            at: end as f64,
            share: 0.5,
            weight,
            rubbing: 1.0,
        };
        if self.is_gone() {
            spots.extend([dry(0, 0.5), dry(1, 0.5)]);
            return;
        }
        let length = place(last) - place(first);
        let held = |point: usize, node: usize| Spot {
            point,
            part: Part::Held,
            at: place(node),
            share: 0.5 * length,
            weight: 0.5,
            rubbing: 1.0,
        };
        if first > 0 {
            spots.push(dry(0, 0.0));
        }
        spots.extend([held(0, first), held(1, last)]);
        if last < NODES - 1 {
            spots.push(dry(1, 0.0));
        }
    }

    fn place_springs(&self, [both, press]: [f64; 2], law: &Law, spots: &mut Vec<Spot>) {
        let intact = self.nodes.iter().all(|node| node.damage() == 0.0);
        let gone = self.is_gone();
        if !gone {
            let [damaged, _] = self.moments([0.0, (NODES - 1) as f64]);
            let [whole, first, second]: Moments = std::array::from_fn(|k| WHOLE[k] - damaged[k]);
            if whole > NOTHING {
                let centre = first / whole;
                let away = (second / whole - centre * centre).max(0.0).sqrt();
                let share = 0.5 * whole;
                let held =
                    |point: usize, at: f64| Spot { point, part: Part::Held, at, share, weight: share, rubbing: 0.0 };
                spots.extend([held(0, centre - away), held(1, centre + away)]);
            }
        }
        // Of springs of which some act in compression only as long as nothing has cracked.
        let stiffness = both + press;
        let cracked = |damaged: f64, all: f64| (both * damaged + press * all) / stiffness;
        // The part χ of all pressure rubs, of which what has cracked bears its share.
        let dry = |point: usize, at: f64, share: f64, [damaged, rubbing]: [f64; 2]| Spot {
            point: HELD + point,
            part: Part::Dry,
            at,
            share,
            weight: damaged.max(0.0),
            rubbing: (rubbing / share).clamp(0.0, 1.0),
        };
        let [near, far] = self.presses_between(press);
        let before = spots.len();
        let mut few = law.crushing.is_infinite() || intact;
        if self.split > 0.0 {
            // Of what is pressed and what is open of it two points each.
            for (between, points) in [[near, self.split], [self.split, far]].into_iter().zip(FOUR) {
                let edge = if between[0] == near { near } else { far } / (NODES - 1) as f64;
                let [damaged, rubs] = self.moments(between);
                let all = whole_between(between);
                let ([outer, inner], at) = edge_and_inside([0, 1, 2].map(|k| cracked(damaged[k], all[k])), edge);
                // What is in proportion to it in all and where.
                let split = |moments: Moments| {
                    let inner = if at == edge { 0.0 } else { (moments[1] - edge * moments[0]) / (at - edge) };
                    [moments[0] - inner, inner]
                };
                let [damaged, rubs] = [split(damaged), split(rubs)];
                let both = [(edge, outer), (at, inner)];
                for k in if edge < at { [0, 1] } else { [1, 0] } {
                    let (at, share) = both[k];
                    if share > NOTHING {
                        spots.push(dry(points[k], at, share, [damaged[k], rubs[k]]));
                    }
                }
            }
        } else {
            // Three points at the ends and the middle of what has cracked, which turn as it does.
            let [start, end] = [near, far].map(|at| at / (NODES - 1) as f64);
            let [damaged, rubs] = self.moments([near, far]);
            let [damaged, all, rubs] =
                [damaged, whole_between([near, far]), rubs].map(|moments| thirds(moments, start, end - start));
            for (k, point) in THREE.into_iter().enumerate() {
                let share = cracked(damaged[k], all[k]);
                // Where damage is so uneven that one of them would pull, nine stand for what is around them.
                few &= share >= -NOTHING && rubs[k] >= -NOTHING && rubs[k] <= share + NOTHING;
                if share > NOTHING {
                    spots.push(dry(point, start + 0.5 * k as f64 * (end - start), share, [damaged[k], rubs[k]]));
                }
            }
        }
        if !few {
            spots.truncate(before);
            for point in 0..DRY {
                let [damaged, all, rubs] = self.around(point);
                let share = cracked(damaged, all);
                if share > NOTHING {
                    spots.push(dry(point, point as f64 / (DRY - 1) as f64, share, [damaged, rubs]));
                }
            }
        }
        self.stays(law, spots);
    }

    fn stays(&self, law: &Law, spots: &mut Vec<Spot>) {
        if law.bond.is_some_and(|bond| bond.residual > 0.0) {
            spots.push(Spot { point: POINTS - 1, part: Part::Stays, at: 0.5, share: 1.0, weight: 0.0, rubbing: 0.0 });
        }
    }

    /// Between which nodes all lies that acts in compression only: what has cracked, or all of it.
    fn presses_between(&self, press: f64) -> [f64; 2] {
        let all = [0.0, (NODES - 1) as f64];
        if press > 0.0 || self.is_gone() {
            return all;
        }
        let cracked = |node: &Node| node.damage() > 0.0;
        let first = self.nodes.iter().position(cracked).unwrap_or(0);
        let last = self.nodes.iter().rposition(cracked).unwrap_or(0);
        [(first as f64 - 1.0).max(all[0]), (last as f64 + 1.0).min(all[1])]
    }

    /// Where its sides touch, what has cracked being open on one side of it and pressed on the other; 0 where it is all one, or may be crushed.
    fn touching(&self, law: &Law) -> f64 {
        let Normal::Springs { press, .. } = law.normal else { return 0.0 };
        let [[from, _], [to, _]] = self.line;
        let at = from / (from - to) * (NODES - 1) as f64;
        if law.crushing.is_finite() || !(from.max(to) > TOUCHING && at > 0.0 && at < (NODES - 1) as f64) {
            return 0.0;
        }
        let [near, far] = self.presses_between(press);
        let room = |at: f64| (at - near).min(far - at);
        let stays = self.split > 0.0 && (at - self.split).abs() < NEARLY * room(self.split);
        match room(at) > 0.0 {
            true if stays => self.split,
            true => at,
            false => 0.0,
        }
    }

    /// The part of the joint that a point of what has cracked stands for: what of it has, all of it, and what rubs.
    fn around(&self, point: usize) -> [f64; 3] {
        let apart = (NODES - 1) / (DRY - 1);
        let centre = point * apart;
        let nodes = centre.saturating_sub(apart)..(centre + apart).min(NODES - 1);
        let mut sums = [0.0; 3];
        for n in nodes {
            for (part, factor) in [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)] {
                let hat = 1.0 - ((n as f64 + part) - centre as f64).abs() / apart as f64;
                for (sum, value) in sums.iter_mut().zip([self.damage_between(n, part), 1.0, self.chi_between(n, part)])
                {
                    *sum += factor * hat * value;
                }
            }
        }
        // Of a part trapezoids keep what it is in all and where; of the whole they would turn too stiffly.
        let rule = if self.is_gone() { GREGORY[point] } else { 1.0 };
        sums.map(|sum| sum * rule / (6.0 * (NODES - 1) as f64))
    }

    /// Opening and slide of a point that is held, which go on with the motion wherever it was before.
    pub(crate) fn stretched(&self, at: f64) -> [f64; 2] {
        between(&self.line, at)
    }

    /// Takes opening and slide at the ends from the points, after a step.
    pub(crate) fn follow(&mut self, points: &[Point]) {
        // Where nothing is left of the bond, all that has cracked moves alike.
        let part = if self.is_gone() { Part::Dry } else { Part::Held };
        if let Some(line) = self.line_through(part, points) {
            self.was = std::mem::replace(&mut self.line, line);
        }
    }

    /// Opening and slide at the ends as the points of a part have them; none where they are no two.
    fn line_through(&self, part: Part, points: &[Point]) -> Option<[[f64; 2]; 2]> {
        let mut ends = self.spots.iter().filter(|spot| spot.part == part);
        let (first, second) = (ends.next()?, ends.next_back()?);
        let of = |spot: &Spot| [points[spot.point].gap, points[spot.point].slide];
        let (from, to, length) = (of(first), of(second), second.at - first.at);
        let at = |x: f64| [0, 1].map(|k| from[k] + (x - first.at) / length * (to[k] - from[k]));
        (length > 0.0).then(|| [at(0.0), at(1.0)])
    }

    /// Energy in the springs of the joint as its line and its points stand [J].
    pub(crate) fn stored(&self, law: &Law, points: &[Point]) -> f64 {
        let Normal::Springs { both, press, .. } = law.normal else { return 0.0 };
        let residual = law.bond.map_or(0.0, |bond| bond.residual);
        let shear = law.shear.stiffness;
        let breaks = law.breaking_stiffness();
        let [_, mut energy] = self.friction_borne(law, points);
        for spot in &self.spots {
            let point = &points[spot.point];
            energy += match spot.part {
                Part::Held => {
                    let [w, s] = self.stretched(spot.at);
                    0.5 * spot.share * (both * w * w + breaks * s * s)
                }
                Part::Dry => {
                    let k = spot.share * (both + press);
                    0.5 * k * (point.gap + point.crushed).min(0.0).powi(2)
                }
                // Of the whole there is no point where there is a bond.
                Part::Whole | Part::Stays => 0.5 * residual * shear * point.slide * point.slide,
            };
        }
        energy
    }

    /// What the bond lost in a step of a joint with springs that ended at `time` [s]; its points are placed anew where it lost something or its sides touch elsewhere.
    pub(crate) fn wear(&mut self, law: &Law, points: &mut [Point], time: f64) -> Worn {
        let Normal::Springs { both, press, .. } = law.normal else { return Worn::default() };
        if self.broken.is_finite() && self.touching(law) == self.split {
            return Worn::default();
        }
        let [near, far] = self.line;
        // Nothing that has not cracked is near its strength: most joints at most times.
        let sheared = law.shear.stiffness * near[1].abs().max(far[1].abs());
        let pressed = (both + press) * (-near[0].min(far[0])).max(0.0);
        let intact = self.cracked.is_infinite();
        let opened = near[0].max(far[0]);
        let bond =
            law.bond.unwrap_or(Bond { tension: 0.0, cohesion: 0.0, tan_angle: 0.0, energy: [0.0; 2], residual: 0.0 });
        if intact && both * (opened - TOUCHING) <= bond.tension && sheared <= bond.cohesion && pressed <= law.crushing {
            return Worn::default();
        }
        let before = self.stored(law, points);
        let mut friction = self.friction_borne(law, points);
        let mut taken = 0.0;
        let mut worn = false;
        for n in 0..self.nodes.len() {
            let x = place(n);
            let [w, s] = self.stretched(x);
            let weight = if n == 0 || n == NODES - 1 { 0.5 } else { 1.0 } / (NODES - 1) as f64;
            if self.nodes[n].damage() == 1.0 {
                continue;
            }
            let then = between(&self.was, x);
            let grown = [w - then[0], s.abs() - then[1].abs()].map(|way| way.max(0.0));
            let before = self.nodes[n];
            let kept = |node: &Node| node.friction([w, s], law);
            let (lost, had) = (self.wear_node(n, [w, s], grown, law, &bond), kept(&before));
            let [borne, stored] = kept(&self.nodes[n]);
            friction[0] -= weight * (borne - had[0]) * s.signum();
            friction[1] += weight * (stored - had[1]);
            let lost = lost - (stored - had[1]);
            // A crushed node may have taken nothing.
            if self.nodes[n] != before {
                worn = true;
                taken += weight * lost;
                self.reach = self.reach.max(w.max(s.abs()));
            }
        }
        // What is left of it has no points any more.
        if worn && 1.0 - self.damage() <= NOTHING {
            self.nodes.fill(Node::GONE);
        }
        let split = if worn || !intact { self.touching(law) } else { self.split };
        if !worn && split == self.split {
            return Worn::default();
        }
        self.split = split;
        self.cracked = self.cracked.min(time);
        if self.is_gone() {
            self.broken = self.broken.min(time);
        }
        // What has cracked opens as the edges of the blocks stand, what is held by how far it was stretched: they differ by rounding and by turning.
        let line = self.line_through(Part::Dry, points).unwrap_or(self.line);
        let mut was = [f64::NAN; POINTS];
        self.spots.iter().for_each(|spot| was[spot.point] = spot.at);
        // Blocks slide alike along the joint.
        let speed = self.spots.iter().map(|spot| points[spot.point].speed).fold(0.0, f64::max);
        self.place(law);
        for spot in self.spots.iter().filter(|spot| spot.part == Part::Dry && spot.at != was[spot.point]) {
            let [gap, slide] = between(&line, spot.at);
            let point = &mut points[spot.point];
            let kept = if was[spot.point].is_nan() { Point { speed, ..Point::default() } } else { *point };
            *point = Point { gap, slide, ..kept };
        }
        self.set(points);
        self.share_friction(law, points, friction);
        let lost = before - self.stored(law, points);
        Worn { bond: taken, beyond: lost - taken }
    }

    /// What has cracked bears along the joint, and what its springs along store [N, J].
    fn friction_borne(&self, law: &Law, points: &[Point]) -> [f64; 2] {
        let along = law.breaking_stiffness();
        let dry = self.spots.iter().filter(|spot| spot.part == Part::Dry && along > 0.0);
        dry.fold([0.0; 2], |[whole, energy], spot| {
            let bearing = points[spot.point].bearing;
            [whole + bearing, energy + 0.5 * bearing * bearing / (spot.share * along)]
        })
    }

    /// Has what has cracked bear `whole` along the joint [N], or what stores no more than `energy` [J]: all its points stretched alike, those that
    /// friction lets.
    fn share_friction(&self, law: &Law, points: &mut [Point], [whole, energy]: [f64; 2]) {
        let (stiffness, along) = (law.normal_stiffness(), law.breaking_stiffness());
        let mu = |point: &Point| law.friction.map_or(0.0, |friction| friction.at(point.speed));
        let dry = || self.spots.iter().filter(|spot| spot.part == Part::Dry && along > 0.0);
        let (mut rest, mut held, mut slides) =
            (whole, dry().map(|spot| spot.share * along).sum::<f64>(), [false; POINTS]);
        loop {
            let stretch = if held > 0.0 { rest / held } else { 0.0 };
            let mut settled = true;
            for spot in dry() {
                if slides[spot.point] {
                    continue;
                }
                let point = &mut points[spot.point];
                let pressed = spot.share * stiffness * (-point.gap - point.crushed).max(0.0);
                let most = spot.rubbing * mu(point) * pressed;
                point.bearing = stretch * spot.share * along;
                if point.bearing.abs() > most {
                    point.bearing = most.copysign(stretch);
                    (rest, held) = (rest - point.bearing, held - spot.share * along);
                    (slides[spot.point], settled) = (true, false);
                }
            }
            if settled {
                break;
            }
        }
        let [_, stored] = self.friction_borne(law, points);
        if stored > energy.max(0.0) {
            let part = (energy.max(0.0) / stored).sqrt();
            dry().for_each(|spot| points[spot.point].bearing *= part);
        }
    }

    /// What a node lost that is stretched by `w` and `s`, `grown` of it in this step [m], of a joint as it would be everywhere [J].
    fn wear_node(&mut self, n: usize, [w, s]: [f64; 2], grown: [f64; 2], law: &Law, bond: &Bond) -> f64 {
        let Normal::Springs { both, press, .. } = law.normal else { return 0.0 };
        let mut node = self.nodes[n];
        let (damage, had) = (node.damage(), node.lost);
        let along = law.breaking_stiffness();
        let pressure = ((both + press) * -w).max(0.0);
        let (mut taken, mut passed) = (0.0, [false; 2]);
        // `way` is how much farther it is stretched than before, `other` twice what the other direction would store.
        let mut pass = |mode: usize, [stretch, way]: [f64; 2], k: f64, [strength, goes_on]: [f64; 2], other: f64| {
            let before = node.damage();
            if k == 0.0 || before == 1.0 {
                return;
            }
            let from = strength * node.left;
            let limit = from / (k * (1.0 - node.lost[mode]));
            if !(stretch > limit) {
                return;
            }
            passed[mode] = true;
            // Of what the bond stores, and of what breaking takes from here on, the springs of friction keep a part.
            let kept = |node: &Node| if mode == 1 { node.friction([w, s], law)[1] } else { 0.0 };
            let (had, left) = (kept(&node), node.left);
            let capacity = bond.energy[mode] * node.rest[mode];
            let stored = 0.5 * (from * limit - goes_on * goes_on / k) + had;
            let decay = ((capacity - stored) / (from - BROKEN * strength)).max(0.0);
            // What has no strength breaks at once.
            let decay = if strength > 0.0 { decay } else { 0.0 };
            // Where the limit has come to the stretch as pressure fell, the rest is no work of breaking.
            let at = limit.max(stretch - way);
            // Where the limit has come to the stretch and not the stretch to the limit, nothing has slid beyond it.
            node.left *= if decay > 0.0 { (-(stretch - limit).min(way) / decay).exp() } else { 0.0 };
            let to = strength * node.left;
            if to > BROKEN * strength {
                node.lost[mode] = 1.0 - to / (k * stretch);
                let spent = decay * (from - to) - 0.5 * (to * stretch - from * at);
                taken += spent;
                if bond.energy[mode] > 0.0 {
                    node.rest[mode] = (capacity - spent + kept(&node) - had) / bond.energy[mode];
                }
                node.rest[1 - mode] *= node.left / left;
            } else {
                // What bears next to nothing bears nothing, and gives back nothing of what it stored.
                node = Node::GONE;
                taken += decay * (from - BROKEN * strength).max(0.0) + 0.5 * from * at;
            }
            taken += 0.5 * (node.damage() - before) * other;
        };
        pass(0, [w - TOUCHING, grown[0]], both, [bond.tension, 0.0], along * s * s);
        pass(1, [s.abs(), grown[1]], along, law.shear_strengths(pressure), both * w.max(0.0).powi(2));
        // Where both modes have lost some, one of them bears less than its limit. What springs bore on the way and do not store is taken then.
        if passed[0] && (passed[1] || had[1] > 0.0) || passed[1] && had[0] > 0.0 {
            let [w, s] = [w.max(0.0), s.abs()];
            let both_ways = both * w * (w - grown[0]).max(0.0) + along * s * (s - grown[1]);
            taken = 0.5 * (node.damage() - damage) * both_ways;
        }
        if pressure > law.crushing && node.damage() < 1.0 {
            taken += 0.5 * (1.0 - node.damage()) * along * s * s;
            node = Node::GONE;
        }
        self.nodes[n] = node;
        taken
    }

    /// Breaks a rigid joint by what its points bear [N], or that slides, in a step that ended at `time` [s].
    pub(crate) fn break_rigid(&mut self, law: &Law, points: &mut [Point], slid: bool, time: f64) {
        let Some(bond) = law.bond else { return };
        if self.is_gone() {
            return;
        }
        let parted = bond.tension == 0.0
            && self.spots.iter().any(|spot| spot.part == Part::Held && points[spot.point].gap > TOUCHING);
        let sum = |f: &dyn Fn(&Spot) -> f64| self.spots.iter().map(|s| points[s.point].force[0] * f(s)).sum::<f64>();
        let (normal, moment) = (sum(&|_| 1.0), sum(&|spot| spot.at - 0.5));
        let mut gone = slid || parted;
        let [mut first, mut last] = self.held;
        // The edge of an uncracked joint is stressed by N ∓ 6 M/ℓ over its area.
        if !gone && (self.cracked.is_finite() || 6.0 * moment.abs() - normal > bond.tension) {
            loop {
                let Some(tips) = plane(normal, moment, first, last) else {
                    gone = true;
                    break;
                };
                let over = tips.map(|stress| -stress > bond.tension);
                if !over[0] && !over[1] {
                    break;
                }
                first += usize::from(over[0] && tips[0] <= tips[1]);
                last -= usize::from(over[1] && tips[1] < tips[0]);
                if first >= last {
                    gone = true;
                    break;
                }
            }
        }
        if !gone && [first, last] == self.held {
            return;
        }
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
        self.place(law);
        self.set(points);
    }
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

    /// One node of a joint of 0.3 m²: f_t 50 kPa, c 20 kPa, tan φ 0.6, 20 and 100 N/m.
    fn law() -> Law {
        Law {
            normal: Normal::Springs { both: 3e9, press: 0.0, damping: 0.0 },
            shear: Shear { stiffness: 3e9, damping: 0.0, series: false },
            bond: Some(Bond { tension: 15e3, cohesion: 6e3, tan_angle: 0.6, energy: [6.0, 30.0], residual: 0.0 }),
            ..Law::dry(Some(Friction::coulomb(0.6)))
        }
    }

    fn stretch(crack: &mut Crack, from: [f64; 2], to: [f64; 2], law: &Law) -> f64 {
        let bond = law.bond.expect("a bond");
        let mut taken = 0.0;
        let steps = 2000;
        let mut was = from;
        for n in 1..=steps {
            let at = [0, 1].map(|k| from[k] + (to[k] - from[k]) * f64::from(n) / f64::from(steps));
            let grown = [at[0] - was[0], at[1].abs() - was[1].abs()].map(|way| way.max(0.0));
            taken += crack.wear_node(7, at, grown, law, &bond);
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
                    let grown = [0, 1].map(|k| (at[k] - was[k]).max(0.0));
                    taken += crack.wear_node(7, at, grown, &law, &bond);
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
            crack.place(&law);
            close(moments(&crack), 4e-3);
            let weights: f64 = crack.spots().iter().map(|s| s.weight).sum();
            assert!((weights - 1.0).abs() < 1e-2, "{weights}");
        }
        assert_eq!(crack.spots().len(), 3);
    }
}
