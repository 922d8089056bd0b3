//! Blocks in motion: implicit steps with impacts (Moreau 1988, Jean 1999).
//!
//! Positions stand at the ends of steps of one length h and move by the mean of the velocities there; contact points are
//! those of the middle, q + h v/2. Motion is that of the base, relative to it: what the base accelerates pushes the blocks
//! the other way, as its exact change of velocity over the step.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree, RTreeObject};

use crate::assembly::Body;
use crate::blocks::Triple;
use crate::contact::{Contact, Effort, Solver, Status};
use crate::shape::{Place, Polygon, Touch, touches, touches_base};

/// How far apart bodies are that are looked at, over the shortest edge: as far as they may move before all are looked at
/// again.
const REACH: f64 = 0.1;

/// How contact is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// [`Solver::newton`].
    #[default]
    Newton,
    /// [`Solver::gauss_seidel`] with so many rounds at most.
    GaussSeidel(usize),
}

/// What does not change during a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Step h [s].
    pub step: f64,
    /// μ of all contacts.
    pub friction: f64,
    /// e of impacts, 0 … 1.
    pub restitution: f64,
    /// Acceleration of gravity [m/s²].
    pub gravity: f64,
    /// What contact may be violated by [m/s].
    pub tolerance: f64,
    /// How contact is solved.
    pub method: Method,
}

impl Setting {
    /// Steps of `step` [s] with friction μ, plastic impacts.
    pub fn new(step: f64, friction: f64) -> Self {
        let method = Method::default();
        Setting { step, friction, restitution: 0.0, gravity: concio::G, tolerance: 1e-8, method }
    }
}

/// Energy that went somewhere since the start [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Account {
    /// Brought by gravity and the base.
    pub input: f64,
    /// Taken by friction.
    pub friction: f64,
    /// Taken by impacts.
    pub impact: f64,
}

/// What a motion took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Counters {
    /// Steps.
    pub steps: usize,
    /// Sums of [`Effort`].
    pub iterations: usize,
    /// Matrices factorised.
    pub factorisations: usize,
    /// Times that impulses were taken anew.
    pub rounds: usize,
    /// Steps whose contact was not solved to the tolerance.
    pub unsolved: usize,
    /// Largest violation left [m/s].
    pub residual: f64,
}

/// A pair that may touch; none is the base.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    a: Option<usize>,
    b: usize,
    /// Impulses of its two contact points in the last step [N s].
    impulse: [[f64; 2]; 2],
}

/// Bodies in motion.
#[derive(Debug, Clone)]
pub struct Motion {
    setting: Setting,
    mass: Vec<Triple>,
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
    pairs: Vec<Pair>,
    solver: Solver,
    /// Where the bodies were when pairs were looked for, and how far they may go until then [m].
    looked: Vec<Place>,
    reach: f64,
    radius: Vec<f64>,
    contacts: Vec<Contact>,
    /// Pair and number of each contact.
    owners: Vec<(usize, usize)>,
    free: Vec<Triple>,
    after: Vec<Triple>,
}

impl Motion {
    /// At rest where the bodies were laid.
    pub fn new(bodies: &[Body], setting: Setting) -> Self {
        let rest: Vec<Polygon> = bodies.iter().map(Polygon::of).collect();
        let places: Vec<Place> = bodies.iter().map(|b| Place { centre: b.centre, angle: 0.0 }).collect();
        let shortest = rest.iter().map(|p| p.shortest).fold(f64::INFINITY, f64::min);
        let far = |p: &Polygon| p.corners.iter().map(|c| c[0].hypot(c[1])).fold(0.0, f64::max);
        let mut motion = Motion {
            mass: bodies.iter().map(|b| [b.mass, b.mass, b.inertia]).collect(),
            inverse: bodies.iter().map(|b| [1.0 / b.mass, 1.0 / b.mass, 1.0 / b.inertia]).collect(),
            polygons: rest.clone(),
            radius: rest.iter().map(far).collect(),
            rest,
            velocities: vec![[0.0; 3]; bodies.len()],
            time: 0.0,
            account: Account::default(),
            counters: Counters::default(),
            pairs: Vec::new(),
            solver: Solver::new(0, &[]),
            looked: places.clone(),
            reach: REACH * shortest,
            contacts: Vec::new(),
            owners: Vec::new(),
            free: vec![[0.0; 3]; bodies.len()],
            after: vec![[0.0; 3]; bodies.len()],
            places,
            setting,
        };
        motion.look();
        motion
    }

    /// Puts a body elsewhere, at rest; to be called before the first step.
    pub fn put(&mut self, body: usize, place: Place) {
        self.places[body] = place;
        self.velocities[body] = [0.0; 3];
        self.look();
    }

    /// One step, during which the velocity of the base changes by `base` [m/s].
    pub fn step(&mut self, base: [f64; 2]) {
        let h = self.setting.step;
        for (body, place) in self.places.iter().enumerate() {
            let v = self.velocities[body];
            let centre = [place.centre[0] + 0.5 * h * v[0], place.centre[1] + 0.5 * h * v[1]];
            self.polygons[body].put(&self.rest[body], &Place { centre, angle: place.angle + 0.5 * h * v[2] });
            self.free[body] = [v[0] - base[0], v[1] - base[1] - h * self.setting.gravity, v[2]];
        }
        self.meet();
        // What held in the last step will nearly hold again.
        self.after.copy_from_slice(&self.velocities);
        let effort = match self.setting.method {
            Method::Newton => {
                self.solver.newton(&self.mass, &self.free, &mut self.contacts, &mut self.after, self.setting.tolerance)
            }
            Method::GaussSeidel(rounds) => {
                let tolerance = self.setting.tolerance;
                self.solver.gauss_seidel(&self.mass, &self.free, &mut self.contacts, &mut self.after, tolerance, rounds)
            }
        };
        self.count(effort);
        self.settle();
        for (body, place) in self.places.iter_mut().enumerate() {
            let (before, after) = (self.velocities[body], self.after[body]);
            let mean = [0, 1, 2].map(|k| 0.5 * h * (before[k] + after[k]));
            place.centre[0] += mean[0];
            place.centre[1] += mean[1];
            place.angle += mean[2];
        }
        std::mem::swap(&mut self.velocities, &mut self.after);
        self.time += h;
        if self.strayed() {
            self.look();
        }
    }

    /// Contact points of the polygons as they stand.
    fn meet(&mut self) {
        self.contacts.clear();
        self.owners.clear();
        for (number, pair) in self.pairs.iter().enumerate() {
            let b = &self.polygons[pair.b];
            let found = match pair.a {
                Some(a) => touches(&self.polygons[a], b, self.reach),
                None => touches_base(b, self.reach),
            };
            for (which, touch) in found.iter().enumerate() {
                let Some(touch) = touch else { continue };
                self.owners.push((number, which));
                let contact = self.contact(pair, which, touch);
                self.contacts.push(contact);
            }
        }
    }

    fn contact(&self, pair: &Pair, which: usize, touch: &Touch) -> Contact {
        let (n, t) = (touch.normal, [-touch.normal[1], touch.normal[0]]);
        let h = self.setting.step;
        let row = |body: usize, direction: [f64; 2], sign: f64| {
            let place = &self.places[body];
            let v = &self.velocities[body];
            let arm = [0, 1].map(|k| touch.at[k] - place.centre[k] - 0.5 * h * v[k]);
            [sign * direction[0], sign * direction[1], sign * (arm[0] * direction[1] - arm[1] * direction[0])]
        };
        let rows = |direction| [pair.a.map_or([0.0; 3], |a| row(a, direction, -1.0)), row(pair.b, direction, 1.0)];
        let mut contact = Contact {
            a: pair.a,
            b: pair.b,
            slot: pair.a.map(|a| self.solver.matrix().slot(a, pair.b)),
            normal: rows(n),
            tangent: rows(t),
            friction: self.setting.friction,
            bias: 0.0,
            rho: [0.0; 2],
            impulse: pair.impulse[which],
            status: Status::Open,
        };
        let approach = contact.velocity(&self.velocities)[0];
        contact.bias = if touch.gap > 0.0 {
            // Open: what is left of the gap may be closed by the end of the step.
            2.0 * touch.gap / h
        } else {
            self.setting.restitution * approach.min(0.0)
        };
        contact.weigh(&self.inverse);
        contact
    }

    fn count(&mut self, effort: Effort) {
        self.counters.steps += 1;
        self.counters.iterations += effort.iterations;
        self.counters.factorisations += effort.factorisations;
        self.counters.rounds += effort.rounds;
        self.counters.unsolved += usize::from(!effort.converged);
        self.counters.residual = self.counters.residual.max(effort.residual);
    }

    /// Keeps impulses for the next step and accounts for the energy of this one.
    fn settle(&mut self) {
        self.pairs.iter_mut().for_each(|p| p.impulse = [[0.0; 2]; 2]);
        for (contact, (pair, which)) in self.contacts.iter().zip(&self.owners) {
            self.pairs[*pair].impulse[*which] = contact.impulse;
            if contact.impulse == [0.0; 2] {
                continue;
            }
            let (before, after) = (contact.velocity(&self.velocities), contact.velocity(&self.after));
            let work = [0, 1].map(|k| 0.5 * contact.impulse[k] * (before[k] + after[k]));
            self.account.impact -= work[0];
            self.account.friction -= work[1];
        }
        for (body, m) in self.mass.iter().enumerate() {
            let (v, w, f) = (self.velocities[body], self.after[body], self.free[body]);
            self.account.input += (0..3).map(|k| 0.5 * m[k] * (f[k] - v[k]) * (v[k] + w[k])).sum::<f64>();
        }
    }

    /// Energy of the motion relative to the base [J].
    pub fn kinetic(&self) -> f64 {
        let of = |(m, v): (&Triple, &Triple)| (0..3).map(|k| 0.5 * m[k] * v[k] * v[k]).sum::<f64>();
        self.mass.iter().zip(&self.velocities).map(of).sum()
    }

    /// Whether a body may have come to one that it is not paired with.
    fn strayed(&self) -> bool {
        let far = |(k, (now, then)): (usize, (&Place, &Place))| {
            let moved = (now.centre[0] - then.centre[0]).hypot(now.centre[1] - then.centre[1]);
            moved + self.radius[k] * (now.angle - then.angle).abs() > 0.5 * self.reach
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
                sign * corners.iter().map(|c| sign * c[k]).fold(f64::NEG_INFINITY, f64::max) + sign * self.reach
            };
            let low = [bound(0, -1.0), bound(1, -1.0)];
            boxes.push(GeomWithData::new(Rectangle::from_corners(low, [bound(0, 1.0), bound(1, 1.0)]), body));
        }
        let tree = RTree::bulk_load(boxes.clone());
        let known = std::mem::take(&mut self.pairs);
        let mut pairs: Vec<(Option<usize>, usize)> = Vec::new();
        for own in &boxes {
            let around: AABB<[f64; 2]> = own.geom().envelope();
            if around.lower()[1] <= 0.0 {
                pairs.push((None, own.data));
            }
            let others = tree.locate_in_envelope_intersecting(&around).map(|o| o.data).filter(|o| *o > own.data);
            pairs.extend(others.map(|other| (Some(own.data), other)));
        }
        pairs.sort_unstable();
        let impulse = |a, b| known.iter().find(|p| (p.a, p.b) == (a, b)).map_or([[0.0; 2]; 2], |p| p.impulse);
        self.pairs = pairs.iter().map(|&(a, b)| Pair { a, b, impulse: impulse(a, b) }).collect();
        let coupled: Vec<(usize, usize)> = pairs.iter().filter_map(|&(a, b)| Some((a?, b))).collect();
        self.solver = Solver::new(self.places.len(), &coupled);
        self.looked.clone_from(&self.places);
    }

    /// What the contact points of the last step did: impulses over the step give forces.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }
}
