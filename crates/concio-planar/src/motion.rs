//! Blocks in motion: implicit steps with impacts (Moreau 1988, Jean 1999).
//!
//! Positions stand at the ends of steps of length h and move by the mean of the velocities there; contact points are
//! those of the middle, q + h v/2. Motion is that of the base, relative to it: what the base accelerates pushes the blocks
//! the other way, as its exact change of velocity over the step. A step whose contact problem is not solved is taken again in
//! two halves.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree, RTreeObject};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::G;
use crate::blocks::{Slot, Triple};
use crate::body::Body;
use crate::contact::{Contact, Effort, worse};
use crate::crack::{self, Crack, Spot};
use crate::interior::Tries;
use crate::joint::{Friction, Law, Part, Point, Start, slides};
use crate::order::Orders;
use crate::shape::{Place, Polygon, Touch, touches, touches_base};
use crate::solver::Solver;
use crate::tie::{Strain, Tie};
use devices::Bent;
use jolts::{bond_slides, falls_by, slides_whole};
use laws::Laws;
use rocking::Hold;
use softening::Softens;
use ties::{Pull, Rod};

mod devices;
mod jolts;
mod laws;
mod rocking;
mod softening;
mod ties;
mod vibration;

pub use vibration::Vibration;

/// How far bodies without a joint may be apart to be looked at, over the shortest edge: half as far they may move before all are
/// looked at again.
const REACH: f64 = 0.1;
/// Steps in turn in which nothing moves any more where bodies stand.
const RESTS: usize = 4;
/// Times that a step is halved where its contact is not solved, of these the first ones, before which no more is tried than an interior point
/// method, and times where it crosses what is pressed of a joint.
const HALVINGS: u32 = 4;
const SOON: u32 = 2;
const CROSSINGS: u32 = 6;
/// Least step in which loads come to bear and whose inertia resists without inertia [s], and after how many it is doubled: the slowest modes take the longest steps.
const SETTLING: f64 = 2e-2;
const DOUBLED: usize = 40;
/// Steps that follow a step without inertia at most; the same while each of them cracks or crushes a joint.
const FOLLOWING: usize = 60;
const CRACKING: usize = 1000;
/// Steps after which none follows where bodies do not slow down, and the way ahead over that of the farthest step at which none follows.
const PATIENCE: usize = 10;
const AT_REST: f64 = 1e-3;
/// The way in such a step over that of the one before from which the next is longer, and over the size of a body, beyond which it is only where
/// the way shrinks.
const SLOWLY: f64 = 0.75;
const FAR: f64 = 1e-4;
/// The way in such a step over the size of a body beyond which it falls, whatever cracks.
const FALLING: f64 = 1e-2;
/// The longest of them, over the first.
const LONGEST: f64 = 16.0;
/// What contact may be violated by, over the velocity that gravity gives in a step.
const ACCURACY: f64 = 1e-6;
/// ρ of what has no spring over the mass that its point moves, or a tenth of what weighs as much as presses it (without inertia all of that), in a whole step. In 1 ms a point yields by
/// 1 nm under that weight. With a quarter, bricks that slide together drift apart by 0.4 % of their slip instead of 0.1 %.
const FIRM: f64 = 1e4;
/// What a point yields by at most under that weight [m], however long the step; and without inertia, where its turn shows in the pressures of the joint
/// below.
const YIELDS: f64 = 1e-8;
const YIELDS_AT_REST: f64 = 1e-10;
/// What is left at most, over the tolerance, of a step that is not taken again in two halves.
const ENOUGH: f64 = 100.0;
/// How much deeper than their velocities took them the sides of a joint may overlap, over `REACH`: where a stone that falls comes upon another edge
/// of its neighbour there would be a spring pressed in by nothing, and energy of nothing. Where they overlap so much less, what the spring had is lost.
const JUMP: f64 = 3e-6;
/// The way of a body in a step of a motion over the shortest edge of all beyond which it is taken in parts: plates would fly through each other.
const THROUGH: f64 = 0.4;
/// Contact points of a pair that are kept in place: joints whose points move have more.
const POINTS: usize = 3;

/// A point of a joint without bond, but for where it is and how much of the joint.
const UNBONDED: Spot = Spot {
    point: 0,
    part: Part::Whole,
    at: 0.0,
    share: 0.0,
    weight: 0.0,
    rubbing: 1.0,
    damps: 1.0,
    crushed: 0.0,
    edge: 0.0,
};

/// A joint: two bodies that face each other as the wall is laid, and the law between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// First body, on the left or below; none for the base.
    pub a: Option<usize>,
    /// Second body.
    pub b: usize,
    /// Its law.
    pub law: Law,
    /// How far apart its sides are laid [m]: 0 where mortar fills the joint or they touch. Nothing acts across what is above 0 until it is closed.
    pub apart: f64,
}

impl Link {
    /// A joint whose sides touch as they are laid, through their mortar if there is any.
    pub fn closed(a: Option<usize>, b: usize, law: Law) -> Self {
        Link { a, b, law, apart: 0.0 }
    }
}

/// Bodies, their joints and their loads.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// The bodies.
    pub bodies: Vec<Body>,
    /// Their joints.
    pub links: Vec<Link>,
    /// Tie rods.
    pub ties: Vec<Tie>,
    /// Law of bodies that come to touch elsewhere.
    pub other: Law,
    /// Dead load of each body [N], upwards and to the right: its weight, as a rule.
    pub load: Vec<[f64; 2]>,
    /// Directions x, y, θ in which each body is held: x follows [`Forcing::held`], the others stay.
    pub held: Vec<[bool; 3]>,
    /// Whether the base shakes each body: the mass of one that it does not resists motion relative to the base alone.
    pub shaken: Vec<bool>,
}

impl System {
    /// Dry rigid bodies under their weight with friction μ.
    pub fn dry(bodies: &[Body], friction: f64) -> Self {
        System {
            links: Vec::new(),
            ties: Vec::new(),
            other: Law::dry(Some(Friction::coulomb(friction))),
            load: bodies.iter().map(|b| [0.0, -b.mass * G]).collect(),
            held: vec![[false; 3]; bodies.len()],
            shaken: vec![true; bodies.len()],
            bodies: bodies.to_vec(),
        }
    }
}

/// What acts between two instants.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Forcing {
    /// Change of the velocity of the base [m/s].
    pub base: [f64; 2],
    /// Way of what is held, relative to the base [m].
    pub held: f64,
}

/// How steps are taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Step h [s].
    pub step: f64,
    /// What contact is to be violated by at most [m/s]. Steps that leave a hundred times as much, without inertia any more
    /// than it, are taken again in two halves, and count as unsolved where that does not help.
    pub tolerance: f64,
    /// Whether inertia is left out: every step starts at rest.
    pub still: bool,
}

impl Setting {
    /// Steps of `step` [s], contact solved to a millionth of the velocity that gravity gives in one.
    pub fn new(step: f64) -> Self {
        Setting { step, tolerance: ACCURACY * G * step, still: false }
    }

    /// What may be left of a step that is not taken again in two halves [m/s]. Without inertia errors are not carried away by what follows.
    fn enough(&self) -> f64 {
        if self.still { self.tolerance } else { ENOUGH * self.tolerance }
    }

    /// ρ of what has no spring in a step of `h` [s], over the mass that its point moves or bears. At the length of the part, parts of a step have the
    /// stiffness of the whole; at that of the whole, its ρ.
    fn firm(&self, h: f64) -> f64 {
        let yields = if self.still { YIELDS_AT_REST } else { YIELDS.min(G * self.step * self.step / FIRM) };
        G * h * h / yields
    }

    /// The part of the tolerance that a step of `h` [s] has: without inertia it is of the way, whatever the step.
    fn part(&self, h: f64) -> f64 {
        if self.still { (self.step / h).min(1.0) } else { 1.0 }
    }
}

/// Energy that went somewhere since the start [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Account {
    /// Brought by loads and the base.
    pub input: f64,
    /// The part of `input` of what acts vertically and of moments: what lifts weights takes from them what it brings.
    pub upright: f64,
    /// Brought by what is held.
    pub held: f64,
    /// Taken by friction.
    pub friction: f64,
    /// Taken by impacts, by joints that close or ring faster than steps resolve, and where pressed sides slip off each other.
    pub impact: f64,
    /// Taken by dashpots.
    pub damping: f64,
    /// Taken by bonds that break and joints that are crushed.
    pub bond: f64,
    /// Taken by the hysteresis of devices and by ties that yield.
    pub device: f64,
    /// Stored in joints and ties at the moment.
    pub elastic: f64,
}

/// What a motion took.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Counters {
    /// Steps.
    pub steps: u64,
    /// Sums of [`Effort`].
    pub iterations: u64,
    /// Matrices factorised.
    pub factorisations: u64,
    /// Steps taken again in two halves.
    pub halved: u64,
    /// Steps whose contact was left with more than a hundred times the tolerance, without inertia with more than it, and shortest steps whose bonds were
    /// taken as they were at their start.
    pub unsolved: u64,
    /// Largest violation left [m/s].
    pub residual: f64,
    /// Steps without inertia that ended before what slowed down had come to rest.
    pub moving: u64,
}

/// What a joint did in the last step, and since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Seen {
    /// Least and largest distance of its sides [m], below 0 where they overlap.
    pub gap: [f64; 2],
    /// Way that its second side has slid along the tangent [m].
    pub slide: f64,
    /// Its velocity [m/s].
    pub speed: f64,
    /// Parting velocity [m/s].
    pub parting: f64,
    /// Pressure, from 0 where it bears no tension [N].
    pub pressure: f64,
    /// Force on its second side along the tangent [N].
    pub shear: f64,
    /// Part of it that is friction [N].
    pub friction: f64,
    /// Length of the way slid, there and back [m].
    pub path: f64,
    /// Energy taken [J].
    pub taken: f64,
    /// Part of it that breaking and crushing took [J].
    pub broken: f64,
    /// Whether it touches.
    pub touches: bool,
}

impl Seen {
    /// Its motion at a part of the step that began with `start`, on straight lines; else as it is at its end.
    pub fn since(&self, start: &Seen, part: f64) -> Self {
        if part == 1.0 {
            return *self;
        }
        let way = |a: f64, b: f64| a + part * (b - a);
        Seen {
            gap: [0, 1].map(|k| way(start.gap[k], self.gap[k])),
            slide: way(start.slide, self.slide),
            speed: way(start.speed, self.speed),
            parting: way(start.parting, self.parting),
            ..*self
        }
    }

    /// What stays of it where its sides do not touch.
    fn apart(&self) -> Self {
        let Seen { path, taken, broken, slide, gap, .. } = *self;
        Seen { path, taken, broken, slide, gap, ..Seen::default() }
    }
}

/// A pair that may touch; none is the base.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Pair {
    a: Option<usize>,
    b: usize,
    link: Option<usize>,
    points: SmallVec<[Point; POINTS]>,
    /// Distance as the wall was laid [m]; 0 for those that have come together.
    laid: f64,
    /// What has become of its bond and what is open and crushed, where its points move with that.
    crack: Option<Crack>,
}

/// All that changes during a motion, to be kept and taken up again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    places: Vec<Place>,
    velocities: Vec<Triple>,
    time: f64,
    account: Account,
    counters: Counters,
    pairs: Vec<Pair>,
    looked: Vec<Place>,
    seen: Vec<Seen>,
    pull: f64,
    borne: [f64; 2],
    shakes: [f64; 2],
    strains: Vec<Strain>,
    rings_until: f64,
    tries: Tries,
}

/// What the base moved in a step without inertia: Σ m Δx [kg m], and the work of the forces that acted at the ends of its parts [J].
#[derive(Debug, Clone, Copy, Default)]
struct Moved {
    masses: [f64; 2],
    work: f64,
}

/// A pair, and where it stands in the matrix.
#[derive(Debug, Clone, Copy)]
struct Seat {
    pair: usize,
    slot: Option<Slot>,
}

/// Where a contact comes from.
#[derive(Debug, Clone, Copy)]
struct Owner {
    pair: usize,
    point: usize,
    part: Part,
    share: f64,
    /// How much of the joint it is.
    weight: f64,
    start: Start,
    /// x of the normal and the tangent where a body is held in that direction, in the sense of the push on it.
    lever: [f64; 2],
}

/// A push on a body along a direction: the row of it, and what it adds to velocity and lever of the contact.
struct Push {
    row: Triple,
    velocity: f64,
    lever: f64,
}

/// Bodies in motion.
#[derive(Debug, Clone)]
pub struct Motion {
    setting: Setting,
    /// Bodies of the joints, and laws.
    joints: Vec<(Option<usize>, usize)>,
    laws: Laws,
    rods: Vec<Rod>,
    load: Vec<[f64; 2]>,
    /// Weight of all bodies, and their dead load where that is more [N].
    weight: f64,
    bears: f64,
    /// Mass over size of a light body: what a bonded rigid joint yields as [kg/m].
    heft: f64,
    /// What pushes each body besides, at its centre [N, N, N m].
    applied: Vec<Triple>,
    held: Vec<[bool; 3]>,
    shaken: Vec<bool>,
    mass: Vec<Triple>,
    /// Part of the mass that resists in the step, what resists, and one over it, 0 where a body is held.
    resists: f64,
    resistance: Vec<Triple>,
    inverse: Vec<Triple>,
    rest: Vec<Polygon>,
    polygons: Vec<Polygon>,
    /// Where the bodies are.
    pub places: Vec<Place>,
    /// Their velocities [m/s, m/s, 1/s].
    pub velocities: Vec<Triple>,
    /// Time [s].
    pub time: f64,
    /// Energy since the start.
    pub account: Account,
    /// Effort since the start.
    pub counters: Counters,
    /// What each joint did.
    pub seen: Vec<Seen>,
    /// Force of what is held on the others in the last step [N].
    pub pull: f64,
    /// Largest pull and base shear when a bond broke at once or friction at rest was overcome since [`Motion::go`] began [N], which forces at its end do not show; 0 where
    /// neither came to pass.
    pub breaks: [f64; 2],
    /// Whether the step without inertia ended in motion that does not slow down: its forces are not those of a wall at rest.
    pub falls: bool,
    strains: Vec<Strain>,
    pairs: Vec<Pair>,
    /// Which of them have contacts.
    met: Vec<bool>,
    /// Bodies of the links, the one of the lower number first, sorted.
    linked: Vec<(Option<usize>, usize)>,
    solver: Solver,
    orders: Orders,
    /// Where the bodies were when pairs were looked for, twice as far as each may go until that is done again [m], and how far its
    /// corners are from its centre [m].
    looked: Vec<Place>,
    reach: Vec<f64>,
    radius: Vec<f64>,
    /// Shortest edge of all bodies [m].
    thinnest: f64,
    /// Pairs of bodies in the matrix.
    coupled: Vec<(usize, usize)>,
    /// The pairs in the order of their places in the matrix.
    seats: Vec<Seat>,
    contacts: Vec<Contact>,
    owners: Vec<Owner>,
    /// Where the contacts that follow those of the pairs come from.
    pulls: Vec<Pull>,
    /// Ends held back in rocking impacts, whose contacts follow those; whether a joint has any.
    holds: Vec<Hold>,
    rocks: bool,
    /// Whether some joint can be crushed, whether some has a force that falls at once, and whether friction at rest is some other than of motion.
    crushes: bool,
    sudden: bool,
    eases: bool,
    /// How much of the change of forces in the step was over when such a force first fell in it, if one did, and what was borne at the step's end, as in
    /// [`Motion::breaks`].
    breaks_at: Option<f64>,
    /// Whether a joint has cracked or been crushed further since [`Motion::follow`] asked last.
    worn: bool,
    /// When what happens in steps that follow counts as happening [s].
    instant: Option<f64>,
    borne: [f64; 2],
    /// Without inertia: acceleration of the base in the step before [m/s²], and what moved in this one.
    shakes: [f64; 2],
    moved: Moved,
    /// Contacts of devices with a law of their own.
    bent: Vec<Bent>,
    /// Bonds that may soften in the step.
    softens: Vec<Softens>,
    /// Whether what they bear was not found.
    astray: bool,
    /// Whether bonds of rigid joints hold whatever comes.
    spares: bool,
    /// Steps of [`Motion::stand`] whose contact was left unsolved.
    pub unsettled: u64,
    /// Until when it counts how fast springs ring [s].
    rings_until: f64,
    /// Without inertia: what the step would bear had nothing cracked, where a bond broke at once in it.
    uncracked: Option<([f64; 2], f64)>,
    free: Vec<Triple>,
    after: Vec<Triple>,
}

impl Motion {
    /// At rest where the bodies were laid.
    pub fn new(system: &System, setting: Setting) -> Self {
        let bodies = &system.bodies;
        let rest: Vec<Polygon> = bodies.iter().map(Polygon::of).collect();
        let places: Vec<Place> = bodies.iter().map(|b| Place { centre: b.centre, angle: 0.0 }).collect();
        let far = |p: &Polygon| p.corners.iter().map(|c| c[0].hypot(c[1])).fold(0.0, f64::max);
        let mass: Vec<Triple> = bodies.iter().map(|b| [b.mass, b.mass, b.inertia]).collect();
        let weight = G * bodies.iter().map(|b| b.mass).sum::<f64>();
        let lightness = rest.iter().zip(bodies).map(|(shape, body)| far(shape) / body.mass).sum::<f64>();
        let mut linked: Vec<_> = system.links.iter().map(|l| in_order(l.a, l.b)).collect();
        linked.sort_unstable();
        let mut motion = Motion {
            resists: 0.0,
            resistance: mass.clone(),
            inverse: mass.clone(),
            mass,
            polygons: rest.clone(),
            radius: rest.iter().map(far).collect(),
            thinnest: rest.iter().map(|p| p.shortest).fold(f64::INFINITY, f64::min),
            reach: rest.iter().map(|p| REACH * p.shortest).collect(),
            rest,
            velocities: vec![[0.0; 3]; bodies.len()],
            time: 0.0,
            account: Account::default(),
            counters: Counters::default(),
            seen: vec![Seen::default(); system.links.len()],
            pull: 0.0,
            strains: vec![Strain::default(); system.ties.len()],
            pairs: Vec::new(),
            met: Vec::new(),
            linked,
            solver: Solver::new(0, &[], &Orders::anywhere()),
            orders: Orders::anywhere(),
            looked: places.clone(),
            coupled: Vec::new(),
            seats: Vec::new(),
            contacts: Vec::new(),
            owners: Vec::new(),
            pulls: Vec::with_capacity(system.ties.len()),
            holds: Vec::new(),
            rocks: system.links.iter().map(|link| &link.law).chain([&system.other]).any(|law| law.rocking().is_some()),
            crushes: system.links.iter().any(|link| link.law.crushing.is_finite()),
            sudden: system.links.iter().map(|link| &link.law).chain([&system.other]).any(Law::is_sudden),
            eases: system.links.iter().map(|link| &link.law).chain([&system.other]).any(Law::eases),
            breaks_at: None,
            worn: false,
            instant: None,
            borne: [0.0; 2],
            breaks: [0.0; 2],
            falls: false,
            shakes: [0.0; 2],
            moved: Moved::default(),
            bent: Vec::new(),
            softens: Vec::new(),
            astray: false,
            spares: false,
            unsettled: 0,
            rings_until: f64::NEG_INFINITY,
            uncracked: None,
            free: vec![[0.0; 3]; bodies.len()],
            after: vec![[0.0; 3]; bodies.len()],
            rods: system.ties.iter().map(|tie| Rod::new(tie, &places)).collect(),
            places,
            joints: system.links.iter().map(|link| (link.a, link.b)).collect(),
            laws: Laws::new(&system.links, system.other),
            load: system.load.clone(),
            weight,
            heft: bodies.len() as f64 / lightness,
            bears: system.load.iter().map(|load| -load[1]).sum::<f64>().max(weight),
            applied: vec![[0.0; 3]; bodies.len()],
            held: system.held.clone(),
            shaken: system.shaken.clone(),
            setting,
        };
        motion.look();
        motion.lay(&system.links);
        motion
    }

    /// Puts a body elsewhere, at rest, with springs that pull as far stretched as before; to be called before the first step.
    pub fn put(&mut self, body: usize, place: Place) {
        self.places[body] = place;
        self.velocities[body] = [0.0; 3];
        self.look();
    }

    /// Goes on with `setting` from here.
    pub fn set(&mut self, setting: Setting) {
        self.setting = setting;
    }

    /// Lets the loads come to bear without inertia until nothing moves by more than `within` [m] in a step, in
    /// `most` steps at most, or until a body has gone farther than it is large; whether it came to rest. The account starts anew.
    pub fn stand(&mut self, within: f64, most: usize) -> bool {
        let setting = Setting { still: true, step: self.setting.step.max(SETTLING), ..self.setting.clone() };
        let own = std::mem::replace(&mut self.setting, setting);
        let laid = self.places.clone();
        let holds = self.pairs.iter().any(|pair| self.laws.of(pair.link).holds());
        let (mut stands, mut rests) = (false, 0);
        for number in 1..=most {
            // What nothing breaks has forces that springs of one stiffness would have: bonds break by those, not by what loads do that come at once.
            self.spares = number == 1 && holds;
            self.take(self.setting.step, Forcing::default(), CROSSINGS);
            self.spares = false;
            // Points of joints that are open in part move after a step: at rest none have for some.
            rests = if self.fastest() * self.setting.step <= within { rests + 1 } else { 0 };
            if rests == RESTS {
                stands = true;
                break;
            }
            let gone = |(k, p): (usize, &Place)| !(way(&laid[k], p) <= self.radius[k]);
            if self.places.iter().enumerate().any(gone) {
                break;
            }
            if number.is_multiple_of(DOUBLED) {
                self.setting.step *= 2.0;
            }
        }
        self.setting = own;
        self.velocities.fill([0.0; 3]);
        self.time = 0.0;
        self.account = Account { elastic: self.account.elastic, ..Account::default() };
        self.unsettled = std::mem::take(&mut self.counters).unsolved;
        self.seen.iter_mut().for_each(|s| (s.path, s.taken, s.broken) = (0.0, 0.0, 0.0));
        // What cracks under the loads is cracked when time begins.
        for crack in self.pairs.iter_mut().filter_map(|p| p.crack.as_mut()) {
            for time in [&mut crack.cracked, &mut crack.broken] {
                *time = if time.is_finite() { 0.0 } else { f64::INFINITY };
            }
        }
        stands
    }

    /// Farthest way of a body from where it was laid [m].
    pub fn strayed_by(&self, system: &System) -> f64 {
        let gone = |(place, body): (&Place, &Body)| way(place, &Place { centre: body.centre, angle: 0.0 });
        self.places.iter().zip(&system.bodies).map(gone).fold(0.0, worse)
    }

    /// Horizontal force of the base on the bodies in the last step, that of ties to it included [N].
    pub fn base_shear(&self) -> f64 {
        let joints = self.joints.iter().zip(&self.seen).filter(|((a, _), _)| a.is_none());
        let borne = 0.0 - joints.map(|(_, seen)| seen.shear).sum::<f64>();
        let anchored = self.ties().filter(|(tie, _)| tie.a.is_none()).map(|(_, strain)| strain.pull[0]);
        anchored.fold(borne, |sum, pull| sum + pull)
    }

    /// Pushes a body at its centre [N, N] and turns it, counterclockwise [N m], besides its load, until this is called again. It is not kept
    /// ([`Motion::keep`]).
    pub fn apply(&mut self, body: usize, force: Triple) {
        self.applied[body] = force;
    }

    /// How steps are taken.
    pub fn setting(&self) -> &Setting {
        &self.setting
    }

    /// One step of the setting's length, in which `forcing` acts evenly, as [`Motion::go`] takes it; without inertia no others follow.
    pub fn step(&mut self, forcing: Forcing) {
        let (start, h) = (self.time, self.setting.step);
        let part = |from: f64, to: f64| if (from, to) == (start, start + h) { 1.0 } else { (to - from) / h };
        self.part(start, h, 0, &|from, to| Forcing {
            base: forcing.base.map(|v| part(from, to) * v),
            held: part(from, to) * forcing.held,
        });
        self.time = start + h;
    }

    /// From here over `h` [s]; `forcing` says what acts between two instants. Without inertia, steps under what acts then
    /// follow until the bodies are at rest, each twice as long as the one before where that comes slowly: what swings slowly comes
    /// to rest in long steps alone. A mechanism never does, and moves the more the longer they are.
    pub fn go(&mut self, h: f64, forcing: &impl Fn(f64, f64) -> Forcing) {
        let start = self.time;
        let (pull, before) = (self.pull, self.account);
        (self.breaks, self.moved) = ([0.0; 2], Moved::default());
        self.part(start, h, 0, forcing);
        if self.setting.still {
            let acts = forcing(start, start + h);
            let breaks = self.breaks;
            self.follow(start, h, &acts);
            if self.falls {
                self.breaks = breaks;
            }
            self.work_at_rest(h, &acts, pull, &before);
        }
        self.time = start + h;
    }

    /// Between one rest and the next forces do the work of their mean: what those at the end of the steps did beyond it went into bodies that are at rest again.
    /// That is no more than bodies and springs lost: rigid joints slide at once. `pull` acted and the account was as `before` ahead of a step of `h` [s] under `acts`.
    fn work_at_rest(&mut self, h: f64, acts: &Forcing, pull: f64, before: &Account) {
        let base = acts.base.map(|v| v / h);
        let mean = [0, 1].map(|k| 0.5 * (self.shakes[k] + base[k]));
        let Moved { masses, work } = self.moved;
        let surplus = [
            work + mean[0] * masses[0] + mean[1] * masses[1],
            self.account.held - before.held - 0.5 * (pull + self.pull) * acts.held,
        ];
        let (lost, all) = ((self.account.impact - before.impact).max(0.0), surplus[0] + surplus[1]);
        // Where a force fell at once its mean says nothing.
        let part = if all > lost {
            lost / all
        } else if all < 0.0 && self.breaks != [0.0; 2] {
            0.0
        } else {
            1.0
        };
        self.account.input -= part * surplus[0];
        self.account.held -= part * surplus[1];
        self.account.impact -= part * all;
        self.shakes = base;
    }

    /// Steps under what acts over `h` [s], until the bodies are at rest.
    fn follow(&mut self, start: f64, h: f64, acts: &Forcing) {
        let size = self.radius.iter().fold(0.0, |most: f64, r| most.max(*r));
        let stays = |from: f64, to: f64| Forcing { held: 0.0, base: acts.base.map(|v| v * (to - from) / h) };
        // What swings slowly comes to rest in steps of some length, however finely loads are followed.
        let first = h.max(SETTLING);
        let (mut way, mut step) = (self.fastest() * h, first);
        let (mut most, mut ratio, mut longer, mut rests, mut cracks) = (way, f64::INFINITY, false, false, false);
        // One step in which points of joints move to where they bear is no sign of a fall: how many of one length did not slow down.
        let (mut faster, mut falls) = (0, true);
        // All of them are at the end of the step of the load.
        self.instant = Some(start + h);
        for number in 0..CRACKING {
            // Steps that shrink by a ratio have so much before them.
            let ahead = if ratio < 1.0 { way * ratio / (1.0 - ratio) } else { f64::INFINITY };
            rests = way == 0.0 || ahead <= AT_REST * most;
            let enough = number >= FOLLOWING || number >= PATIENCE && falls && !longer;
            if rests || enough && !cracks {
                break;
            }
            longer = !cracks && ratio > SLOWLY && (ratio < 1.0 || way <= FAR * size) && step < LONGEST * first;
            if longer {
                step *= 2.0;
            } else if cracks {
                step = first;
            }
            self.worn = false;
            self.part(start + h - step, step, 0, &stays);
            let next = self.fastest() * step;
            cracks = self.worn && next <= FALLING * size;
            (ratio, way, most) = (next / way, next, most.max(next));
            faster += u32::from(ratio >= 1.0 && !longer);
            falls = ratio >= 1.0 && (faster > 1 || longer);
        }
        self.instant = None;
        self.falls = !rests && falls && !cracks;
        // What neither slows down nor cracks, as a mechanism, is not told: it has no rest to come to.
        self.counters.moving += u64::from(!rests && (!falls || cracks));
    }

    /// Largest velocity of a body's edge [m/s].
    fn fastest(&self) -> f64 {
        let of = |(v, r): (&Triple, &f64)| v[0].abs() + v[1].abs() + r * v[2].abs();
        self.velocities.iter().zip(&self.radius).map(of).fold(0.0, f64::max)
    }

    fn part(&mut self, from: f64, h: f64, halved: u32, forcing: &impl Fn(f64, f64) -> Forcing) {
        self.time = from;
        if !self.take(h, forcing(from, from + h), halved) {
            self.counters.halved += 1;
            self.part(from, 0.5 * h, halved + 1, forcing);
            self.part(from + 0.5 * h, 0.5 * h, halved + 1, forcing);
        }
    }

    /// A step that was halved so many times; whether it was taken. It is not where halves of it are to be, and nothing has happened then.
    fn take(&mut self, h: f64, forcing: Forcing, halved: u32) -> bool {
        // At the beginning: what is asked after a step is asked of the pairs that its contacts know.
        if self.strayed() {
            self.look();
        }
        if self.setting.still {
            self.velocities.fill([0.0; 3]);
        }
        if halved < HALVINGS && self.fastest() * h > THROUGH * self.thinnest {
            return false;
        }
        self.resist(h);
        // From rest to twice the mean, as all that moves does without inertia.
        let rate = forcing.held / h;
        let held = if self.setting.still { [0.0, 2.0 * rate] } else { [rate; 2] };
        self.release(h, &forcing, held);
        self.meet(h, held);
        self.fasten(h, held);
        self.hold_back(h);
        self.guess();
        // Without inertia halves of a step are other steps, of loads that come to bear: all is tried first.
        let halves = halved < SOON && !self.setting.still;
        let effort = self.solve(h, halves);
        let effort = self.follow_lines(h, halves, effort);
        let effort = if self.turn() {
            let again = self.solve(h, halves);
            effort.then(self.follow_lines(h, halves, again))
        } else {
            effort
        };
        self.count(effort);
        if self.astray && halved < HALVINGS {
            return false;
        }
        let stale = self.astray;
        let effort = if stale { self.solve_as_it_was(h) } else { effort };
        let enough = effort.residual <= self.setting.part(h) * self.setting.enough();
        let rings = halved < HALVINGS && self.rings(h, halved < SOON);
        let in_parts = rings || halved < HALVINGS && (!enough || self.jolts(h));
        if in_parts || halved < CROSSINGS && !self.follows_crushing(h) {
            return false;
        }
        self.counters.steps += 1;
        self.counters.unsolved += u64::from(!enough || stale);
        self.counters.residual = worse(self.counters.residual, effort.residual);
        self.settle(h, forcing);
        if self.sudden {
            self.tell_breaks(h);
        }
        self.advance(h, forcing.held);
        std::mem::swap(&mut self.velocities, &mut self.after);
        self.time += h;
        true
    }

    /// Raises the largest forces at breaks by those of a step of `h` [s], if something broke in it.
    fn tell_breaks(&mut self, h: f64) {
        let borne = [self.pull - self.resisted(h), self.base_shear()];
        let before = std::mem::replace(&mut self.borne, borne);
        let Some(part) = self.breaks_at.take() else { return };
        let more = self.softened_by(h);
        let (borne, part) = self.uncracked.take().unwrap_or(([0, 1].map(|k| borne[k] + more[k]), part));
        for (peak, (from, to)) in self.breaks.iter_mut().zip(before.into_iter().zip(borne)) {
            let then = from + part * (to - from);
            *peak = if then.abs() > peak.abs() { then } else { *peak };
        }
    }

    /// Part of the pull of what is held that only moves masses without inertia, which start from rest in every step [N].
    fn resisted(&self, h: f64) -> f64 {
        if !self.setting.still || !self.held.iter().any(|held| held[0]) {
            return 0.0;
        }
        let moved = self.resistance.iter().zip(&self.after).zip(&self.held).filter(|(_, held)| !held[0]);
        moved.map(|((m, w), _)| m[0] * w[0]).sum::<f64>() / h
    }

    /// Says what part of the masses resists in a step of `h` [s]. Without inertia, where joints can be crushed, parts of a step are resisted as the whole is by
    /// the same part of the way: what a body that starts to move presses on is crushed for good.
    fn resist(&mut self, h: f64) {
        let part = if self.setting.still && self.crushes { (h / SETTLING).min(1.0).powi(2) } else { 1.0 };
        if part == self.resists {
            return;
        }
        self.resists = part;
        for (body, m) in self.mass.iter().enumerate() {
            self.resistance[body] = m.map(|m| part * m);
            self.inverse[body] = [0, 1, 2].map(|k| if self.held[body][k] { 0.0 } else { 1.0 / (part * m[k]) });
        }
    }

    /// Where a slide that friction of motion held back turns round, friction at rest holds it: whether there is such a point, which is to be solved
    /// again. Rest in between two slides would be a matter of chance otherwise.
    fn turn(&mut self) -> bool {
        if self.setting.still || !self.eases {
            return false;
        }
        let mut turns = false;
        for (contact, owner) in self.contacts.iter_mut().zip(&self.owners) {
            let pair = &self.pairs[owner.pair];
            let point = &pair.points[owner.point];
            let law = self.laws.part(pair.link, owner.part);
            let Some(friction) = law.friction.filter(|_| law.bond.is_none() && point.speed > 0.0) else { continue };
            let most = point.rubbing * friction.static_;
            let after = contact.velocity(&self.after)[1];
            if contact.friction < most && owner.start.velocity[1] * after < 0.0 {
                contact.friction = most;
                turns = true;
            }
        }
        turns
    }

    /// Velocities without contact, and polygons in the middle of the step; what is held moves at `rate` before and after it [m/s].
    fn release(&mut self, h: f64, forcing: &Forcing, rate: [f64; 2]) {
        for (body, place) in self.places.iter().enumerate() {
            let (v, held, push) = (self.velocities[body], self.held[body], self.applied[body]);
            let load = self.load[body];
            let mut half = v.map(|v| 0.5 * h * v);
            let base = if self.shaken[body] { forcing.base } else { [0.0; 2] };
            let pushed = |k: usize| v[k] - base[k] / self.resists + h * (load[k] + push[k]) * self.inverse[body][k];
            let mut after = [pushed(0), pushed(1), v[2] + h * push[2] * self.inverse[body][2]];
            if held[0] {
                (half[0], after[0]) = (0.5 * h * rate[0], rate[1]);
            }
            for k in 1..3 {
                if held[k] {
                    (half[k], after[k]) = (0.0, 0.0);
                }
            }
            let centre = [place.centre[0] + half[0], place.centre[1] + half[1]];
            self.polygons[body].put(&self.rest[body], &Place { centre, angle: place.angle + half[2] });
            self.free[body] = after;
        }
    }

    /// What held in the last step will nearly hold again.
    fn guess(&mut self) {
        for (body, after) in self.after.iter_mut().enumerate() {
            let (v, free, held) = (self.velocities[body], self.free[body], self.held[body]);
            *after = [0, 1, 2].map(|k| if held[k] { free[k] } else { v[k] });
        }
    }

    fn solve(&mut self, h: f64, halves: bool) -> Effort {
        let part = self.setting.part(h);
        // Of what bore nothing before, forces are known by how little it yields alone.
        let closely = if self.spares { part / FIRM } else { part };
        let Motion { solver, resistance, free, contacts, after, setting, .. } = self;
        let ends = (closely * setting.tolerance, part * setting.enough());
        solver.solve(resistance, free, contacts, after, ends, halves)
    }

    fn advance(&mut self, h: f64, held: f64) {
        for (body, place) in self.places.iter_mut().enumerate() {
            let (before, after) = (self.velocities[body], self.after[body]);
            let mean = [0, 1, 2].map(|k| 0.5 * h * (before[k] + after[k]));
            place.centre[0] += if self.held[body][0] { held } else { mean[0] };
            place.centre[1] += mean[1];
            place.angle += mean[2];
        }
    }

    /// Contact points of the polygons as they stand.
    fn meet(&mut self, h: f64, held: [f64; 2]) {
        self.contacts.clear();
        self.owners.clear();
        self.bent.clear();
        self.softens.clear();
        for k in 0..self.seats.len() {
            let seat = self.seats[k];
            let pair = &self.pairs[seat.pair];
            let Some(ends) = ends(&self.polygons, pair, self.margin(pair)) else { continue };
            let along = |share: f64| Touch {
                at: [0, 1].map(|k| ends[0].at[k] + share * (ends[1].at[k] - ends[0].at[k])),
                gap: ends[0].gap + share * (ends[1].gap - ends[0].gap),
                normal: ends[0].normal,
            };
            let law = self.laws.of(pair.link);
            let length = (ends[1].at[0] - ends[0].at[0]).hypot(ends[1].at[1] - ends[0].at[1]);
            if let Some(crack) = &pair.crack {
                let first = self.contacts.len();
                for spot in 0..crack.spots().len() {
                    let spot = self.pairs[seat.pair].crack.as_ref().map_or(UNBONDED, |crack| crack.spots()[spot]);
                    let (contact, owner) = self.contact(seat, spot, (&along(spot.at), length), h, held);
                    self.contacts.push(contact);
                    self.owners.push(owner);
                }
                self.begin_softening(first);
                continue;
            }
            let (points, device) = (law.points(), law.device);
            for (point, [at, share]) in points.iter().copied().enumerate() {
                let spot = Spot { point, at, share, weight: share, ..UNBONDED };
                let (contact, owner) = self.contact(seat, spot, (&along(at), length), h, held);
                self.contacts.push(contact);
                self.owners.push(owner);
                if let Some(device) = device {
                    self.bent.push(Bent::of(&device, self.contacts.len() - 1, &contact));
                }
            }
        }
        self.begin_devices(h);
    }

    fn contact(
        &self,
        seat: Seat,
        spot: Spot,
        (touch, length): (&Touch, f64),
        h: f64,
        held: [f64; 2],
    ) -> (Contact, Owner) {
        let Spot { point, part, share, weight, edge, .. } = spot;
        let pair = &self.pairs[seat.pair];
        let (n, t) = (touch.normal, [-touch.normal[1], touch.normal[0]]);
        let (mut velocity, mut lever) = ([0.0; 2], [0.0; 2]);
        let mut row = |body: usize, which: usize, direction: [f64; 2], sign: f64| {
            let (place, v, fixed) = (&self.places[body], &self.velocities[body], &self.held[body]);
            let half = if fixed[0] { held[0] } else { v[0] };
            let arm = [touch.at[0] - place.centre[0] - 0.5 * h * half, touch.at[1] - place.centre[1] - 0.5 * h * v[1]];
            let push = self.push(body, arm, direction.map(|d| sign * d));
            velocity[which] += push.velocity;
            lever[which] += push.lever;
            push.row
        };
        let mut rows = |which, direction| {
            [pair.a.map_or([0.0; 3], |a| row(a, which, direction, -1.0)), row(pair.b, which, direction, 1.0)]
        };
        let rows = [rows(0, n), rows(1, t)];
        let before = [0, 1].map(|k| velocity[k] + lever[k] * held[0]);
        let state = &pair.points[point];
        let mut contact = Contact::new((pair.a, pair.b), seat.slot, rows, &self.inverse, state.force.map(|f| h * f));
        contact.drift = lever.map(|lever| lever * held[1]);
        let law = self.laws.part(pair.link, part);
        let mut gap = touch.gap - 0.5 * h * before[0];
        if law.follows {
            gap = state.gap;
        }
        let jump = JUMP * self.reach[pair.b];
        let mut slipped = false;
        if law.is_compliant() && !law.follows {
            // What pulls too is stretched by other edges as it is pressed in by them.
            let presses = law.only_presses();
            let followed = if presses { state.gap.min(0.0) } else { state.gap };
            if followed - gap > jump || !presses && gap - followed > jump {
                gap = followed;
            }
            slipped = pair.link.is_some() && gap - state.gap > jump;
        }
        // Forces of a wall whose joints all hold are those of one that yields alike all over. What grips does so however little resists.
        let mass = if law.holds() { self.heft * length * share } else { contact.moved[0] } / self.resists;
        // In parts of a step a point yields more, and leaves some of its approach: rebounds and (P8) would lose it.
        let whole = !self.setting.still && (law.rebounds() || law.rocking().is_some());
        let firm = self.setting.firm(if whole { h.max(self.setting.step) } else { h });
        let start = law.begin(state, share, h, (self.setting.still, firm, mass), (gap, before), &mut contact);
        if self.spares && law.holds() {
            (contact.pressure[0], contact.hold) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        if edge > 0.0 {
            let most = h * edge * law.crushing;
            contact.pressure = [-most, contact.pressure[1] + most];
        }
        let start = Start { slipped, edge: edge > 0.0, ..start };
        (contact, Owner { pair: seat.pair, point, part, share, weight, start, lever })
    }

    /// A push at `arm` from the centre of a body [m].
    fn push(&self, body: usize, arm: [f64; 2], direction: [f64; 2]) -> Push {
        let (v, fixed) = (&self.velocities[body], &self.held[body]);
        let mut row = [direction[0], direction[1], arm[0] * direction[1] - arm[1] * direction[0]];
        let lever = if fixed[0] { row[0] } else { 0.0 };
        for k in 0..3 {
            if fixed[k] {
                row[k] = 0.0;
            }
        }
        Push { row, velocity: row[0] * v[0] + row[1] * v[1] + row[2] * v[2], lever }
    }

    fn count(&mut self, effort: Effort) {
        self.counters.iterations += effort.iterations as u64;
        self.counters.factorisations += effort.iterations as u64;
    }

    /// Keeps what the points have come to for the next step, and accounts for the energy of this one.
    fn settle(&mut self, h: f64, Forcing { base, held }: Forcing) {
        let time = self.instant.unwrap_or(self.time + h);
        self.account.elastic = 0.0;
        self.pull = 0.0;
        self.met.fill(false);
        let mut last = None;
        for (at, (contact, owner)) in self.contacts.iter().zip(&self.owners).enumerate() {
            let pair = &mut self.pairs[owner.pair];
            let law = self.laws.part(pair.link, owner.part);
            let after = contact.velocity(&self.after);
            let point = &mut pair.points[owner.point];
            // Friction at rest is overcome at the end of the step.
            let starts = falls_by(law, point).is_some() && slides(contact, after[1], h);
            let waits =
                starts && !law.is_compliant() && !slides_whole(at, &self.contacts, &self.owners, &self.after, h);
            if starts && !waits {
                self.breaks_at.get_or_insert(1.0);
            }
            let works = law.end(point, owner.share, h, &owner.start, after, contact);
            if let Some(crack) = pair.crack.as_mut() {
                crack.rubs(works.friction);
            }
            if waits {
                point.speed = 0.0;
            }
            let whole = contact.total(after);
            let account = &mut self.account;
            account.elastic += works.elastic;
            account.damping += works.damping;
            account.friction += works.friction;
            account.impact += works.impact;
            account.bond += works.bond;
            self.worn |= works.bond > 0.0;
            account.device += works.device;
            self.pull -= (whole[0] * owner.lever[0] + whole[1] * owner.lever[1]) / h;
            self.met[owner.pair] = true;
            let Some(seen) = pair.link.map(|k| &mut self.seen[k]) else { continue };
            let first = last != Some(owner.pair);
            last = Some(owner.pair);
            if first {
                *seen = Seen { touches: true, ..seen.apart() };
            }
            seen.gap = if first { [point.gap; 2] } else { [seen.gap[0].min(point.gap), seen.gap[1].max(point.gap)] };
            seen.slide = if first { 0.0 } else { seen.slide } + owner.weight * point.slide;
            seen.speed += owner.weight * after[1];
            seen.parting += owner.weight * after[0];
            seen.pressure += whole[0] / h;
            seen.shear += whole[1] / h;
            seen.friction += contact.impulse[1] / h;
            seen.path += owner.weight * works.slip;
            seen.taken += works.damping + works.friction + works.bond + works.device;
            // Without inertia there are no impacts: this is the work of the step's last force beyond that of the mean one.
            seen.taken += if self.setting.still { 0.0 } else { works.impact };
            seen.broken += works.bond;
        }
        self.wear(time);
        // Of pairs that touch nothing more has to be fetched.
        for at in self.met.iter().enumerate().filter(|(_, met)| !**met).map(|(at, _)| at) {
            let pair = &mut self.pairs[at];
            pair.points.iter_mut().for_each(|point| point.force = [0.0; 2]);
            let law = self.laws.of(pair.link);
            let part = |pair: &mut Pair| pair.crack.as_mut().map_or(0.0, |crack| crack.part(law, &mut pair.points));
            if pair.link.is_none() {
                self.account.impact += part(pair);
            }
            let Some(link) = pair.link else { continue };
            self.seen[link] = self.seen[link].apart();
            match &pair.crack {
                None => {
                    for (point, [_, share]) in pair.points.iter_mut().zip(law.points()) {
                        self.account.impact += law.let_go(point, *share);
                    }
                }
                Some(crack) => {
                    let law = self.laws.part(Some(link), Part::Dry);
                    for spot in crack.spots().iter().filter(|spot| spot.part == Part::Dry) {
                        self.account.impact += law.let_go(&mut pair.points[spot.point], spot.share);
                    }
                    self.account.impact += part(pair);
                }
            }
        }
        self.settle_ties(h);
        self.settle_holds(h);
        self.account.held += self.pull * held;
        for (body, m) in self.resistance.iter().enumerate() {
            let (v, w, f, held) = (self.velocities[body], self.after[body], self.free[body], self.held[body]);
            for k in (0..3).filter(|k| !held[*k]) {
                let brought = 0.5 * m[k] * (f[k] - v[k]) * (v[k] + w[k]);
                self.account.input += brought;
                self.account.upright += if k == 0 { 0.0 } else { brought };
                if self.setting.still {
                    self.account.impact += 0.5 * m[k] * w[k] * w[k];
                    if k < 2 && self.shaken[body] {
                        let moved = 0.5 * self.mass[body][k] * (v[k] + w[k]);
                        self.moved.masses[k] += h * moved;
                        self.moved.work -= base[k] * moved;
                    }
                }
            }
        }
    }

    /// Whether the points of all joints that have been crushed bear at the end of a step of `h` [s] what the joints do.
    fn follows_crushing(&self, h: f64) -> bool {
        !self.crushes
            || !self.any_crushing(h, |crack, law, points, gaps| {
                let misses = |part: f64| crack.misses(law, points, gaps(part));
                // What they miss from the start shorter steps do not mend.
                let missed = misses(1.0);
                missed > crack::MISSED && missed > crack::MISSED + misses(0.0)
            })
    }

    /// Whether something holds `of` a joint that can be crushed: of its points, and of the gaps that these have at a part of the step of `h` [s] [m].
    fn any_crushing(&self, h: f64, of: impl Fn(&Crack, &Law, &[Point], &dyn Fn(f64) -> crack::Gaps) -> bool) -> bool {
        let mut at = 0;
        self.owners.chunk_by(|a, b| a.pair == b.pair).any(|owners| {
            let contacts = &self.contacts[at..at + owners.len()];
            at += owners.len();
            let Pair { crack, points, link, .. } = &self.pairs[owners[0].pair];
            let law = self.laws.of(*link);
            let Some(crack) = crack.as_ref().filter(|_| law.crushing.is_finite()) else { return false };
            of(crack, law, points, &|part| {
                let dry = owners.iter().zip(contacts).filter(|(owner, _)| owner.part == Part::Dry);
                dry.map(|(owner, contact)| {
                    let mean = 0.5 * (owner.start.velocity[0] + contact.velocity(&self.after)[0]);
                    (owner.point, owner.start.gap + part * h * mean)
                })
                .collect()
            })
        })
    }

    /// Cracks and crushes the joints by a step that ended at `time` [s].
    fn wear(&mut self, time: f64) {
        let mut at = 0;
        let mut breaks_at = self.breaks_at.unwrap_or(f64::INFINITY);
        while at < self.owners.len() {
            let own = self.owners[at].pair;
            let end = at + self.owners[at..].iter().take_while(|owner| owner.pair == own).count();
            let Pair { crack, points, link, .. } = &mut self.pairs[own];
            if let Some(crack) = crack {
                let law = self.laws.of(*link);
                let mut unseen = Seen::default();
                let seen = link.map_or(&mut unseen, |link| &mut self.seen[link]);
                match law.is_compliant() {
                    true => {
                        crack.follow(points);
                        self.account.elastic += crack.hidden();
                        let mean = |k: usize| {
                            let after = self.contacts[at + k].velocity(&self.after)[0];
                            0.5 * (self.owners[at + k].start.velocity[0] + after)
                        };
                        let parting = crack.parting(law, self.setting.still, &mean);
                        let worn = crack.wear(law, points, parting, self.setting.still, time);
                        let lost = worn.bond + worn.friction + worn.beyond;
                        breaks_at = breaks_at.min(worn.breaks_at.unwrap_or(f64::INFINITY));
                        self.account.elastic -= lost;
                        self.account.bond += worn.bond;
                        self.worn |= worn.bond > 0.0 || worn.breaks_at.is_some();
                        self.account.friction += worn.friction;
                        self.account.impact += worn.beyond;
                        seen.taken += lost;
                        seen.broken += worn.bond;
                        if !crack.is_gone() {
                            let [[near, slide], [far, slid]] = crack.line();
                            (seen.gap, seen.slide) = ([near.min(far), near.max(far)], 0.5 * (slide + slid));
                        }
                    }
                    false if self.spares => {}
                    false => {
                        let slid = bond_slides(law, &self.contacts[at..end], &self.owners[at..end], |contact, _| {
                            contact.impulse
                        });
                        let borne = [seen.pressure, seen.shear];
                        if let Some(part) = crack.break_rigid(law, points, slid, borne, time) {
                            breaks_at = breaks_at.min(part);
                            self.worn = true;
                        }
                    }
                }
            }
            at = end;
        }
        self.breaks_at = breaks_at.is_finite().then_some(breaks_at);
    }

    /// Energy of the motion relative to the base [J], what is held left out; 0 without inertia.
    pub fn kinetic(&self) -> f64 {
        if self.setting.still {
            return 0.0;
        }
        let of = |((m, v), held): ((&Triple, &Triple), &[bool; 3])| {
            (0..3).filter(|k| !held[*k]).map(|k| 0.5 * m[k] * v[k] * v[k]).sum::<f64>()
        };
        self.mass.iter().zip(&self.velocities).zip(&self.held).map(of).sum()
    }

    /// Whether a body may have come to one that it is not paired with.
    fn strayed(&self) -> bool {
        let far = |(k, (now, then)): (usize, (&Place, &Place))| {
            way(now, then) + self.radius[k] * (now.angle - then.angle).abs() > 0.5 * self.reach[k]
        };
        self.places.iter().zip(&self.looked).enumerate().any(far)
    }

    /// Finds the pairs that may touch until a body has strayed.
    fn look(&mut self) {
        let mut boxes = Vec::new();
        for (body, place) in self.places.iter().enumerate() {
            self.polygons[body].put(&self.rest[body], place);
            let corners = &self.polygons[body].corners;
            let bound = |k: usize, sign: f64| {
                sign * corners.iter().map(|c| sign * c[k]).fold(f64::NEG_INFINITY, f64::max) + sign * self.reach[body]
            };
            let low = [bound(0, -1.0), bound(1, -1.0)];
            boxes.push(GeomWithData::new(Rectangle::from_corners(low, [bound(0, 1.0), bound(1, 1.0)]), body));
        }
        let tree = RTree::bulk_load(boxes.clone());
        let known = std::mem::take(&mut self.pairs);
        let fresh = |a, b, link: Option<usize>| {
            let law = self.laws.of(link);
            Pair {
                a,
                b,
                link,
                points: SmallVec::from_elem(Point::default(), crack::most_points(law)),
                laid: 0.0,
                crack: None,
            }
        };
        // Joints stay whatever becomes of them: what has gone apart may come together again.
        let mut pairs: Vec<Pair> = self.joints.iter().enumerate().map(|(k, (a, b))| fresh(*a, *b, Some(k))).collect();
        let alone = |a, b| self.linked.binary_search(&(a, b)).is_err();
        for own in &boxes {
            let around: AABB<[f64; 2]> = own.geom().envelope();
            if around.lower()[1] <= 0.0 && alone(None, own.data) {
                pairs.push(fresh(None, own.data, None));
            }
            let others = tree.locate_in_envelope_intersecting(&around).map(|o| o.data).filter(|o| *o > own.data);
            let others = others.filter(|other| alone(Some(own.data), *other));
            pairs.extend(others.map(|other| fresh(Some(own.data), other, None)));
        }
        pairs.sort_by_key(|p| (p.a, p.b));
        for pair in known {
            if let Ok(at) = pairs.binary_search_by_key(&(pair.a, pair.b), |p| (p.a, p.b)) {
                pairs[at] = pair;
            }
        }
        for pair in pairs.iter_mut().filter(|pair| pair.crack.is_none()) {
            let law = self.laws.of(pair.link);
            pair.crack = Crack::of(law);
            if let Some(crack) = &pair.crack {
                crack.set(&mut pair.points);
            }
        }
        self.pairs = pairs;
        self.couple();
        self.looked.clone_from(&self.places);
    }

    /// How far bodies of a pair may be apart to be looked at [m]: any distance where there is a joint.
    fn margin(&self, pair: &Pair) -> f64 {
        match pair.link {
            Some(_) => f64::INFINITY,
            None => pair.a.map_or(0.0, |a| self.reach[a]).max(self.reach[pair.b]),
        }
    }

    /// A matrix for the pairs there are, unless it is there, and their places in it.
    fn couple(&mut self) {
        let pairs = self.pairs.iter().map(|p| (p.a, p.b)).chain(self.rods.iter().map(|r| (r.tie.a, r.tie.b)));
        let coupled: Vec<(usize, usize)> = pairs.filter_map(|(a, b)| Some((a?, b))).collect();
        if self.solver.is_empty() {
            self.orders = Orders::new(self.places.iter().map(|p| p.centre).collect(), &coupled);
        }
        if coupled != self.coupled || self.solver.is_empty() {
            self.solver = Solver::new(self.places.len(), &coupled, &self.orders);
            self.coupled = coupled;
        }
        // Two ends of each joint at most are held back.
        let most = if self.rocks { 2 * self.pairs.len() } else { 0 };
        self.holds.reserve(most);
        // As many contacts as there may be, so that no step asks for more.
        let points: usize = self.pairs.iter().map(|pair| pair.points.len()).sum();
        self.contacts.reserve(points + most);
        self.owners.reserve(points);
        self.softens.reserve(self.pairs.len());
        self.met.resize(self.pairs.len(), false);
        let matrix = self.solver.matrix();
        let seat = |(k, pair): (usize, &Pair)| Seat { pair: k, slot: pair.a.map(|a| matrix.slot(a, pair.b)) };
        self.seats = self.pairs.iter().enumerate().map(seat).collect();
        self.seats.sort_by_key(|seat| matrix.rank(seat.slot, self.pairs[seat.pair].b));
    }

    /// Takes the distances of the joints as they are for those of the laid wall.
    fn lay(&mut self, links: &[Link]) {
        for pair in &mut self.pairs {
            let Some(link) = pair.link else { continue };
            let ends = ends(&self.polygons, pair, f64::INFINITY);
            pair.laid += ends.map_or(0.0, |e| e[0].gap.min(e[1].gap)) - links[link].apart;
        }
    }

    /// What has become of the points of a joint; none where its bodies have never been near each other.
    pub fn points(&self, link: usize) -> Option<&[Point]> {
        let (a, b) = &self.joints[link];
        let at = self.pairs.binary_search_by_key(&(*a, *b), |p| (p.a, p.b)).ok()?;
        Some(&self.pairs[at].points)
    }

    /// The most that is crushed of a joint [m].
    pub fn crushed(&self, link: usize) -> f64 {
        let (a, b) = &self.joints[link];
        let Ok(at) = self.pairs.binary_search_by_key(&(*a, *b), |p| (p.a, p.b)) else { return 0.0 };
        match &self.pairs[at].crack {
            Some(crack) if self.laws.of(Some(link)).is_compliant() => crack.depth(),
            _ => self.pairs[at].points.iter().map(|p| p.crushed).fold(0.0, f64::max),
        }
    }

    /// The state of the bond of a joint; none where it has none.
    pub fn crack(&self, link: usize) -> Option<&Crack> {
        let (a, b) = &self.joints[link];
        let at = self.pairs.binary_search_by_key(&(*a, *b), |p| (p.a, p.b)).ok()?;
        self.pairs[at].crack.as_ref().filter(|_| self.laws.of(Some(link)).bond.is_some())
    }

    /// All that changes.
    pub fn keep(&self) -> Kept {
        Kept {
            places: self.places.clone(),
            velocities: self.velocities.clone(),
            time: self.time,
            account: self.account,
            counters: self.counters,
            pairs: self.pairs.clone(),
            looked: self.looked.clone(),
            seen: self.seen.clone(),
            pull: self.pull,
            borne: self.borne,
            shakes: self.shakes,
            strains: self.strains.clone(),
            rings_until: self.rings_until,
            tries: self.solver.tries(),
        }
    }

    /// Goes on from what was kept; false where it is not of these bodies.
    pub fn take_up(&mut self, kept: Kept) -> bool {
        let n = self.places.len();
        let fits = [kept.places.len(), kept.velocities.len(), kept.looked.len()].iter().all(|k| *k == n)
            && kept.seen.len() == self.seen.len()
            && kept.strains.len() == self.strains.len()
            && kept.pairs.iter().all(|p| p.b < n && p.a.is_none_or(|a| a < n))
            && kept.pairs.iter().all(|p| {
                let law = || self.laws.of(p.link);
                p.link.is_none_or(|k| k < self.joints.len())
                    && p.crack.is_some() == crack::moves(law())
                    && p.crack.as_ref().is_none_or(|crack| crack.fits(law()))
                    && crack::most_points(law()) == p.points.len()
            });
        if fits {
            let Kept { places, velocities, time, account, counters, pairs, .. } = kept;
            let Kept { looked, seen, pull, borne, shakes, strains, rings_until, tries, .. } = kept;
            (self.places, self.velocities, self.time) = (places, velocities, time);
            (self.account, self.counters, self.pairs) = (account, counters, pairs);
            (self.looked, self.seen, self.strains) = (looked, seen, strains);
            (self.pull, self.borne, self.shakes, self.rings_until) = (pull, borne, shakes, rings_until);
            self.pairs.iter_mut().filter_map(|pair| pair.crack.as_mut()).for_each(Crack::reserve);
            self.couple();
            self.solver.go_on(tries);
        }
        fits
    }

    /// What the contact points of the last step did: impulses over the step give forces.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }
}

/// Contact points of a pair with what is left of their distance to that of the laid wall, none where both are farther than `margin` [m].
fn ends(polygons: &[Polygon], pair: &Pair, margin: f64) -> Option<[Touch; 2]> {
    let b = &polygons[pair.b];
    let Some(a) = pair.a else { return touches_base(b, pair.laid, margin) };
    let touches = touches(&polygons[a], b, margin)?;
    Some(touches.map(|touch| Touch { gap: touch.gap - pair.laid, ..touch }))
}

/// How far two centres are apart [m].
fn way(a: &Place, b: &Place) -> f64 {
    (a.centre[0] - b.centre[0]).hypot(a.centre[1] - b.centre[1])
}

/// A pair of bodies, or the base and one, with the lower number first.
fn in_order(a: Option<usize>, b: usize) -> (Option<usize>, usize) {
    match a {
        Some(a) if a > b => (Some(b), a),
        _ => (a, b),
    }
}
