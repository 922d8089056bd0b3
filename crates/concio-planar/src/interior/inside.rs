//! Interior points of contacts in packs.

use std::array::from_fn;

use pulp::Simd;

use super::Sums;
use super::lanes::{Lanes, PACK, Pack, Real};
use super::lever::{ALL, Arms, Bodies, Joined, PUSHES};
use super::point::{Course, Kind, Laws, Left, Point, View, Way};
use crate::blocks::{Slot, Triple};
use crate::contact::Contact;

/// Bounds of each.
pub(super) const N: usize = 3;

/// Where contacts push.
#[derive(Debug, Clone, Default)]
pub(super) struct Joints {
    pub bodies: Vec<Bodies>,
    pub slots: Vec<[Option<Slot>; PACK]>,
}

/// What stays of a pack during a solution: of each [`Point`] what does, what its laws say, and its arms.
#[derive(Debug, Clone, Copy)]
pub(super) struct Given {
    pub anchor: [Pack; 2],
    soft: [Pack; 2],
    mass: Pack,
    friction: Pack,
    bias: Pack,
    pub arms: Arms<Pack>,
}

/// What laws say that is seldom asked for, as in [`Laws`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Rest {
    along: Pack,
}

/// Distances from the bounds, and multipliers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    s: [Pack; N],
    lambda: [Pack; N],
}

/// What stays of a look for the directions from there; the rest is made again, which takes less time than to fetch it.
#[derive(Debug, Clone, Copy)]
struct Stray {
    astray: [Pack; N],
    off: [Pack; 2],
}

/// Packs of contacts. What is fetched and what is written in each go through them lies apart.
#[derive(Debug, Clone, Default)]
pub(super) struct Inside {
    pub given: Vec<Given>,
    pub p: Vec<[Pack; 2]>,
    bounds: Vec<Bounds>,
    /// By how much (P5) and (P5a) are off.
    strays: Vec<Stray>,
    /// Second-order part of the products.
    second: Vec<[Pack; N]>,
    /// Changes along the last direction.
    ways: Vec<Way<N, Pack>>,
}

/// What contacts of a pack do by Newton's method, from which their response follows: across 1 where springs bear and 0 where nothing does, along
/// 0 where they do, 1 where the contact slides forth and −1 back.
#[derive(Debug, Clone, Copy)]
pub(super) struct Does([Pack; 2]);

impl Default for Does {
    fn default() -> Self {
        Does([[0.0; PACK]; 2])
    }
}

impl Does {
    /// By a response, [`View::response`].
    #[inline(always)]
    pub fn put<S: Simd>(&mut self, [across, _, tilt]: [Lanes<S>; 3], part: usize) {
        let (zero, one) = (across.alike(0.0), across.alike(1.0));
        let bears = Real::pick(zero.below(across), one, zero);
        let back = Real::pick(zero.below(tilt), -one, zero);
        put(&mut self.0, [bears, Real::pick(tilt.below(zero), one, back)], part);
    }

    #[inline(always)]
    pub fn one(&self, k: usize) -> [f64; 2] {
        self.0.map(|does| does[k])
    }

    /// That response of a point.
    #[inline(always)]
    pub fn response<S: Simd>(
        &self,
        point: &Point<N, Lanes<S>>,
        friction: Lanes<S>,
        (simd, part): (S, usize),
    ) -> [Lanes<S>; 3] {
        let [across, along] = parts(simd, &self.0, part);
        let (zero, one) = (across.alike(0.0), across.alike(1.0));
        let sticks = Real::pick(zero.below(along.size()), zero, one / point.soft[1]);
        [across * (one / point.soft[0]), sticks, -along * friction]
    }
}

impl Given {
    pub fn of(own: [&Contact; PACK], points: &[Point<N>; PACK], arms: Arms<Pack>) -> (Self, Rest) {
        let laws = own.map(|contact| Laws::of(contact, [0.0; 2]));
        let given = Given {
            anchor: from_fn(|k| points.map(|point| point.anchor[k])),
            soft: from_fn(|k| points.map(|point| point.soft[k])),
            mass: points.map(|point| point.mass),
            friction: laws.map(|laws| laws.friction),
            bias: laws.map(|laws| laws.bias),
            arms,
        };
        (given, Rest { along: laws.map(|laws| laws.along) })
    }

    /// Points of a part; without `bounds` where none is asked for.
    #[inline(always)]
    pub fn point<S: Simd>(
        &self,
        p: &[Pack; 2],
        bounds: Option<&Bounds>,
        (simd, part): (S, usize),
    ) -> Point<N, Lanes<S>> {
        let zero = Lanes::all(simd, 0.0);
        Point {
            s: if let Some(bounds) = bounds { parts(simd, &bounds.s, part) } else { [zero; N] },
            lambda: if let Some(bounds) = bounds { parts(simd, &bounds.lambda, part) } else { [zero; N] },
            p: parts(simd, p, part),
            anchor: parts(simd, &self.anchor, part),
            soft: parts(simd, &self.soft, part),
            mass: Lanes::of(simd, &self.mass, part),
            rho: zero,
        }
    }

    /// Without the rest what moves along is not known.
    #[inline(always)]
    pub fn laws<S: Simd>(&self, rest: Option<&Rest>, (simd, part): (S, usize)) -> Laws<Lanes<S>> {
        let zero = Lanes::all(simd, 0.0);
        let of = |pack: &Pack| Lanes::of(simd, pack, part);
        Laws {
            friction: Lanes::of(simd, &self.friction, part),
            hold: zero,
            beside: zero,
            pressure: [zero, zero.alike(f64::INFINITY)],
            bias: Lanes::of(simd, &self.bias, part),
            along: if let Some(rest) = rest { of(&rest.along) } else { zero },
            tight: zero.alike(1.0),
        }
    }
}

impl Bounds {
    #[inline(always)]
    fn put<S: Simd>(&mut self, of: &Point<N, Lanes<S>>, part: usize) {
        put(&mut self.s, of.s, part);
        put(&mut self.lambda, of.lambda, part);
    }
}

impl Stray {
    /// What the look made of a point.
    #[inline(always)]
    fn view<S: Simd>(
        &self,
        point: &Point<N, Lanes<S>>,
        friction: &Pack,
        (simd, part): (S, usize),
    ) -> View<N, Lanes<S>> {
        let mut view = point.view(Lanes::of(simd, friction, part));
        view.astray = parts(simd, &self.astray, part);
        view.off = parts(simd, &self.off, part);
        view
    }
}

impl<S: Simd> Point<N, Lanes<S>> {
    /// How near bounds are, and what impulses answer.
    #[inline(always)]
    fn view(&self, friction: Lanes<S>) -> View<N, Lanes<S>> {
        let zero = friction.alike(0.0);
        let mut view = View::none(zero);
        view.mu = friction;
        for i in 0..N {
            view.near[i] = zero.alike(1.0) / self.s[i];
        }
        self.respond(&mut view);
        view
    }
}

impl Way<N, Pack> {
    #[inline(always)]
    fn part<S: Simd>(&self, simd: S, part: usize) -> Way<N, Lanes<S>> {
        Way { p: parts(simd, &self.p, part), s: parts(simd, &self.s, part), lambda: parts(simd, &self.lambda, part) }
    }

    #[inline(always)]
    fn put<S: Simd>(&mut self, of: &Way<N, Lanes<S>>, part: usize) {
        put(&mut self.p, of.p, part);
        put(&mut self.s, of.s, part);
        put(&mut self.lambda, of.lambda, part);
    }
}

#[inline(always)]
pub(super) fn parts<S: Simd, const K: usize>(simd: S, of: &[Pack; K], part: usize) -> [Lanes<S>; K] {
    let mut own = [Lanes::all(simd, 0.0); K];
    for (own, pack) in own.iter_mut().zip(of) {
        *own = Lanes::of(simd, pack, part);
    }
    own
}

#[inline(always)]
pub(super) fn put<S: Simd, const K: usize>(to: &mut [Pack; K], of: [Lanes<S>; K], part: usize) {
    for (pack, own) in to.iter_mut().zip(of) {
        own.put(pack, part);
    }
}

/// [`put`] into some of many.
#[inline(always)]
pub(super) fn put_at<S: Simd, const K: usize, const MOST: usize>(
    to: &mut [Pack; MOST],
    from: usize,
    of: [Lanes<S>; K],
    part: usize,
) {
    for k in 0..K {
        of[k].put(&mut to[from + k], part);
    }
}

/// Of all lanes, in the order of contacts.
#[inline(always)]
fn each<S: Simd>(of: &[Lanes<S>; PACK]) -> Pack {
    let mut pack = [0.0; PACK];
    for part in 0..Lanes::<S>::PARTS {
        of[part].put(&mut pack, part);
    }
    pack
}

impl Inside {
    pub fn clear(&mut self) {
        self.given.clear();
        self.p.clear();
    }

    /// Another pack that bears `p`.
    pub fn add(&mut self, given: Given, p: [Pack; 2]) {
        self.given.push(given);
        self.p.push(p);
    }

    /// For all that changes, also where it only settles: no later step has to ask for more.
    fn make_room(&mut self) {
        let (packs, none) = (self.given.len(), [0.0; PACK]);
        self.bounds.resize(packs, Bounds { s: [none; N], lambda: [none; N] });
        self.strays.resize(packs, Stray { astray: [none; N], off: [none; 2] });
        self.second.resize(packs, [none; N]);
        self.ways.resize(packs, Way::none(none));
    }

    /// [`Point::enter`].
    #[inline(always)]
    pub fn enter<S: Simd>(&mut self, simd: S, joints: &Joints, v: &[Triple], scale: f64) {
        self.make_room();
        self.place(simd, joints, v, Some(scale));
    }

    #[inline(always)]
    fn place<S: Simd>(&mut self, simd: S, joints: &Joints, v: &[Triple], scale: Option<f64>) {
        let points = self.given.iter().zip(&mut self.p).zip(&mut self.bounds);
        for (((given, p), bounds), bodies) in points.zip(&joints.bodies) {
            let u = bodies.gather(v);
            for part in 0..Lanes::<S>::PARTS {
                let (mut point, laws) = (given.point(p, None, (simd, part)), given.laws(None, (simd, part)));
                let u = given.arms.part(simd, part).change(parts(simd, &u, part));
                match scale {
                    Some(scale) => point.enter(&Kind::DRY.on, &laws, u, scale),
                    None => point.settle(&Kind::DRY.on, &laws, u),
                }
                put(p, point.p, part);
                bounds.put(&point, part);
            }
        }
    }

    /// After this share of the last direction.
    #[inline(always)]
    pub fn look<S: Simd>(
        &mut self,
        simd: S,
        joints: &Joints,
        v: &[Triple],
        share: f64,
        rests: Option<&[Rest]>,
        sums: &mut Sums,
    ) {
        let zero = Lanes::<S>::all(simd, 0.0);
        let mut left = [Left::none(zero); PACK];
        let mut joined = Joined::<ALL>::none();
        let points = self.given.iter().zip(&mut self.p).zip(&mut self.bounds).zip(&mut self.strays).zip(&self.ways);
        let each = points.zip(joints.bodies.iter().zip(&joints.slots)).enumerate();
        for (at, (((((given, p), bounds), strays), ways), (bodies, slots))) in each {
            let u = bodies.gather(v);
            let rest = rests.map(|rests| &rests[at]);
            let mut numbers = [[0.0; PACK]; ALL];
            for part in 0..Lanes::<S>::PARTS {
                let laws = given.laws(rest, (simd, part));
                let (mut point, arms) = (given.point(p, Some(bounds), (simd, part)), given.arms.part(simd, part));
                let (u, left) = (arms.change(parts(simd, &u, part)), &mut left[part]);
                // Before the first of a step, that of another is there.
                if share != 0.0 {
                    point.go(zero.alike(share), &ways.part(simd, part));
                }
                let mut view = point.view(laws.friction);
                let bound = (laws.friction * point.p[0]).larger(zero);
                point.stray(&laws, u, bound, &mut view, left);
                point.gauge(&laws, &view, left);
                put(p, point.p, part);
                bounds.put(&point, part);
                put(&mut strays.astray, view.astray, part);
                put(&mut strays.off, view.off, part);
                view.right = point.aim(&view, zero, &[zero; N]);
                // What answers to velocities: across and along to the same, and along to across.
                let [across, along, tilt] = view.response;
                let answer = [across, along, -(tilt * across)];
                put_at::<S, 4, ALL>(&mut numbers, 0, arms.thrust([-point.p[0], -point.p[1]]), part);
                put_at::<S, 4, ALL>(&mut numbers, 4, arms.thrust(view.right), part);
                put_at::<S, 16, ALL>(&mut numbers, PUSHES, arms.couple(answer), part);
            }
            for k in 0..PACK {
                let own = bodies.each(k);
                if joined.bodies != own {
                    joined.end_look(sums);
                    joined.begin(own, slots[k]);
                }
                joined.add(&numbers, k, ALL);
            }
        }
        joined.end_look(sums);
        sums.left.join(&left);
        sums.number += N * PACK * self.given.len();
    }

    #[inline(always)]
    pub fn predict<S: Simd>(
        &mut self,
        simd: S,
        joints: &Joints,
        step: &[Triple],
        [on, rise]: &mut [Vec<Triple>; 2],
        course: &mut Course,
    ) {
        let zero = Lanes::<S>::all(simd, 0.0);
        let mut courses = [Course::begin(zero); PACK];
        let mut joined = Joined::<PUSHES>::none();
        let points = self.given.iter().zip(&self.p).zip(&self.bounds).zip(&self.strays).zip(&mut self.second);
        for (((((given, p), bounds), strays), second), bodies) in points.zip(&joints.bodies) {
            let du = bodies.gather(step);
            let mut numbers = [[0.0; PACK]; PUSHES];
            for part in 0..Lanes::<S>::PARTS {
                let (point, arms) = (given.point(p, Some(bounds), (simd, part)), given.arms.part(simd, part));
                let view = strays.view(&point, &given.friction, (simd, part));
                let right = point.aim(&view, zero, &[zero; N]);
                let way = point.way(&view, arms.change(parts(simd, &du, part)), right, zero, &[zero; N]);
                courses[part].meet(&point, &way, false);
                let mut own = [zero; N];
                for i in 0..N {
                    own[i] = way.s[i] * way.lambda[i];
                }
                put(second, own, part);
                put_at::<S, 4, PUSHES>(&mut numbers, 0, arms.thrust(point.aim(&view, zero, &own)), part);
                put_at::<S, 4, PUSHES>(&mut numbers, 4, arms.thrust(point.rise(&view)), part);
            }
            for k in 0..PACK {
                let own = bodies.each(k);
                if joined.bodies != own {
                    joined.push(0, on);
                    joined.push(4, rise);
                    joined.begin(own, None);
                }
                joined.add(&numbers, k, PUSHES);
            }
        }
        joined.push(0, on);
        joined.push(4, rise);
        course.join(&courses);
    }

    #[inline(always)]
    pub fn turn<S: Simd>(
        &mut self,
        simd: S,
        joints: &Joints,
        step: &[Triple],
        (target, bold): (f64, bool),
        course: &mut Course,
    ) {
        let zero = Lanes::<S>::all(simd, 0.0);
        let target = zero.alike(target);
        let mut courses = [Course::begin(zero); PACK];
        let points = self.given.iter().zip(&self.p).zip(&self.bounds).zip(&self.strays).zip(&self.second);
        for ((((((given, p), bounds), strays), second), ways), bodies) in points.zip(&mut self.ways).zip(&joints.bodies)
        {
            let du = bodies.gather(step);
            for part in 0..Lanes::<S>::PARTS {
                let (point, arms) = (given.point(p, Some(bounds), (simd, part)), given.arms.part(simd, part));
                let view = strays.view(&point, &given.friction, (simd, part));
                let second = parts(simd, second, part);
                let right = point.aim(&view, target, &second);
                let way = point.way(&view, arms.change(parts(simd, &du, part)), right, target, &second);
                courses[part].meet(&point, &way, bold);
                ways.put(&way, part);
            }
        }
        course.join(&courses);
    }

    /// Above 0 for each bound of a pack that holds by the last direction.
    #[inline(always)]
    pub fn leads<S: Simd>(&self, simd: S, at: usize) -> [Pack; N] {
        let mut leads = [[0.0; PACK]; N];
        for part in 0..Lanes::<S>::PARTS {
            let point = self.given[at].point(&[[0.0; PACK]; 2], Some(&self.bounds[at]), (simd, part));
            let zero = point.mass.alike(0.0);
            let led = point.led(&self.ways[at].part(simd, part));
            put(&mut leads, led.map(|led| Real::pick(led, zero.alike(1.0), zero)), part);
        }
        leads
    }
    /// [`Point::settle`].
    #[inline(always)]
    pub fn settle<S: Simd>(&mut self, simd: S, joints: &Joints, v: &[Triple]) {
        self.make_room();
        self.place(simd, joints, v, None);
    }

    /// One point of a pack.
    pub fn one(&self, at: usize, k: usize) -> Point<N> {
        let (given, p, bounds) = (&self.given[at], &self.p[at], &self.bounds[at]);
        Point {
            s: bounds.s.map(|x| x[k]),
            lambda: bounds.lambda.map(|x| x[k]),
            p: p.map(|x| x[k]),
            anchor: given.anchor.map(|x| x[k]),
            soft: given.soft.map(|x| x[k]),
            mass: given.mass[k],
            rho: 0.0,
        }
    }
}

impl Left {
    /// Takes up what is left in each lane.
    #[inline(always)]
    pub fn join<S: Simd>(&mut self, lanes: &[Left<Lanes<S>>; PACK]) {
        let residual = each(&lanes.map(|l| l.residual));
        let products = each(&lanes.map(|l| l.products));
        for k in 0..PACK {
            self.residual = self.residual.worse(residual[k]);
            self.products += products[k];
        }
    }
}

impl Course {
    /// Takes up what each lane comes to.
    #[inline(always)]
    fn join<S: Simd>(&mut self, lanes: &[Course<Lanes<S>>; PACK]) {
        let share = each(&lanes.map(|c| c.share));
        let growth = [0, 1].map(|k| each(&lanes.map(|c| c.growth[k])));
        for k in 0..PACK {
            self.share = self.share.smaller(share[k]);
            (0..2).for_each(|i| self.growth[i] += growth[i][k]);
        }
    }
}
