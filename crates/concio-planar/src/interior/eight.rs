//! Contacts of the most frequent kind, eight at a time: friction that follows from pressure alone, no largest pressure, and neither springs
//! beside nor bodies that are driven. All three bounds are always there, so that eight contacts are the same numbers side by side.

use std::array::from_fn;

use pulp::{Arch, Simd, WithSimd};

use super::lanes::{EIGHT, Eight, Lanes, Real};
use super::lever::{ALL, Joined, Lever, PUSHES};
use super::point::{Course, Kind, Laws, Left, Point, View, Way, is_dry};
use super::{INSIDE, Method, Sums};
use crate::blocks::{Slot, Triple};
use crate::contact::Contact;

/// Bounds of each.
const N: usize = 3;

/// What is small beside what it is added to, or soon to be, and takes half of the room: a direction, and what is off. What rounding
/// leaves of either is off in the next iteration, and 10⁻⁷ of it.
type Brief = [f32; EIGHT];

/// [`Point`] of eight contacts.
#[derive(Debug, Clone, Copy)]
struct Octet {
    s: [Eight; N],
    lambda: [Eight; N],
    p: [Eight; 2],
    anchor: [Eight; 2],
    soft: [Eight; 2],
    mass: Eight,
}

/// What the laws of eight contacts say.
#[derive(Debug, Clone, Copy)]
struct Rule {
    friction: Eight,
    bias: Eight,
}

/// What they say that is seldom asked for, as in [`Laws`].
#[derive(Debug, Clone, Copy)]
struct Rest {
    firm: [Eight; 2],
    along: Eight,
}

/// Contacts in groups of eight. What is fetched and what is written in each go through them lies apart.
#[derive(Debug, Clone, Default)]
pub(super) struct Eights {
    /// Their numbers, one after the other.
    which: Vec<u32>,
    levers: Vec<Lever>,
    slots: Vec<[Option<Slot>; EIGHT]>,
    rules: Vec<Rule>,
    rests: Vec<Rest>,
    /// Whether any is rigid across or along.
    any_firm: bool,
    points: Vec<Octet>,
    /// By how much (P5) and (P5a) are off.
    strays: Vec<Stray>,
    /// What impulses do in Newton's method: response and change where velocities stay.
    answers: Vec<([Eight; 3], [Eight; 2])>,
    /// Second-order part of the products.
    second: Vec<[Brief; N]>,
    /// Changes along the last direction.
    ways: Vec<Way<N, Brief>>,
    /// Impulses and what they are drawn to, before an attempt to end.
    before: Vec<[[Eight; 2]; 2]>,
}

/// Whether a contact is of this kind.
pub(super) fn is_plain(contact: &Contact) -> bool {
    let alone = contact.spring[1] == Default::default() && contact.drift == [0.0; 2];
    alone && contact.rows.levers().is_some() && contact.pressure[1] == f64::INFINITY && is_dry(contact)
}

impl Octet {
    fn one(&self, k: usize) -> Point<N> {
        Point {
            s: self.s.map(|x| x[k]),
            lambda: self.lambda.map(|x| x[k]),
            p: self.p.map(|x| x[k]),
            anchor: self.anchor.map(|x| x[k]),
            soft: self.soft.map(|x| x[k]),
            mass: self.mass[k],
            rho: 0.0,
        }
    }

    fn of(each: &[Point<N>; EIGHT]) -> Self {
        Octet {
            s: from_fn(|i| each.map(|p| p.s[i])),
            lambda: from_fn(|i| each.map(|p| p.lambda[i])),
            p: from_fn(|i| each.map(|p| p.p[i])),
            anchor: from_fn(|i| each.map(|p| p.anchor[i])),
            soft: from_fn(|i| each.map(|p| p.soft[i])),
            mass: each.map(|p| p.mass),
        }
    }

    #[inline(always)]
    fn part<S: Simd>(&self, simd: S, part: usize) -> Point<N, Lanes<S>> {
        Point {
            s: parts(simd, &self.s, part),
            lambda: parts(simd, &self.lambda, part),
            p: parts(simd, &self.p, part),
            anchor: parts(simd, &self.anchor, part),
            soft: parts(simd, &self.soft, part),
            mass: Lanes::of(simd, &self.mass, part),
            rho: Lanes::all(simd, 0.0),
        }
    }

    /// What changes from iterate to iterate.
    #[inline(always)]
    fn put<S: Simd>(&mut self, of: &Point<N, Lanes<S>>, part: usize) {
        put(&mut self.s, of.s, part);
        put(&mut self.lambda, of.lambda, part);
        put(&mut self.p, of.p, part);
    }
}

/// What stays of a look for the directions from there; the rest is made again, which takes less time than to fetch it.
#[derive(Debug, Clone, Copy)]
struct Stray {
    astray: [Brief; N],
    off: [Brief; 2],
}

impl Stray {
    /// What the look made of a point.
    #[inline(always)]
    fn view<S: Simd>(&self, point: &Point<N, Lanes<S>>, rule: &Rule, (simd, part): (S, usize)) -> View<N, Lanes<S>> {
        let mut view = point.view(Lanes::of(simd, &rule.friction, part));
        view.astray = widened(simd, &self.astray, part);
        view.off = widened(simd, &self.off, part);
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

impl Way<N, Brief> {
    #[inline(always)]
    fn part<S: Simd>(&self, simd: S, part: usize) -> Way<N, Lanes<S>> {
        Way {
            p: widened(simd, &self.p, part),
            s: widened(simd, &self.s, part),
            lambda: widened(simd, &self.lambda, part),
        }
    }

    #[inline(always)]
    fn put<S: Simd>(&mut self, of: &Way<N, Lanes<S>>, part: usize) {
        put_brief(&mut self.p, of.p, part);
        put_brief(&mut self.s, of.s, part);
        put_brief(&mut self.lambda, of.lambda, part);
    }
}

impl Rule {
    fn of(each: [&Contact; EIGHT]) -> (Self, Rest) {
        let laws = each.map(|contact| Laws::of(contact, [0.0; 2]));
        let rule = Rule { friction: laws.map(|l| l.friction), bias: laws.map(|l| l.bias) };
        (rule, Rest { firm: from_fn(|k| laws.map(|l| l.firm[k])), along: laws.map(|l| l.along) })
    }

    /// Without the rest nothing is rigid, and what moves along is not known.
    #[inline(always)]
    fn part<S: Simd>(&self, rest: Option<&Rest>, simd: S, part: usize) -> Laws<Lanes<S>> {
        let zero = Lanes::all(simd, 0.0);
        Laws {
            friction: Lanes::of(simd, &self.friction, part),
            hold: zero,
            beside: zero,
            pressure: [zero, zero.alike(f64::INFINITY)],
            bias: Lanes::of(simd, &self.bias, part),
            firm: if let Some(rest) = rest { parts(simd, &rest.firm, part) } else { [zero; 2] },
            along: if let Some(rest) = rest { Lanes::of(simd, &rest.along, part) } else { zero },
        }
    }
}

#[inline(always)]
fn parts<S: Simd, const K: usize>(simd: S, of: &[Eight; K], part: usize) -> [Lanes<S>; K] {
    let mut own = [Lanes::all(simd, 0.0); K];
    for (own, eight) in own.iter_mut().zip(of) {
        *own = Lanes::of(simd, eight, part);
    }
    own
}

#[inline(always)]
fn put<S: Simd, const K: usize>(to: &mut [Eight; K], of: [Lanes<S>; K], part: usize) {
    for (eight, own) in to.iter_mut().zip(of) {
        own.put(eight, part);
    }
}

/// Numbers of this part of what is brief.
#[inline(always)]
fn widened<S: Simd, const K: usize>(simd: S, of: &[Brief; K], part: usize) -> [Lanes<S>; K] {
    let mut own = [Lanes::all(simd, 0.0); K];
    for (own, brief) in own.iter_mut().zip(of) {
        let mut eight = [0.0; EIGHT];
        for k in Lanes::<S>::own(part) {
            eight[k] = brief[k] as f64;
        }
        *own = Lanes::of(simd, &eight, part);
    }
    own
}

#[inline(always)]
fn put_brief<S: Simd, const K: usize>(to: &mut [Brief; K], of: [Lanes<S>; K], part: usize) {
    for (brief, own) in to.iter_mut().zip(of) {
        let mut eight = [0.0; EIGHT];
        own.put(&mut eight, part);
        for k in Lanes::<S>::own(part) {
            brief[k] = eight[k] as f32;
        }
    }
}

/// [`put`] into some of many.
#[inline(always)]
fn put_at<S: Simd, const K: usize, const MOST: usize>(
    to: &mut [Eight; MOST],
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
fn each<S: Simd>(of: &[Lanes<S>; EIGHT]) -> Eight {
    let mut eight = [0.0; EIGHT];
    for part in 0..Lanes::<S>::PARTS {
        of[part].put(&mut eight, part);
    }
    eight
}

impl Eights {
    pub fn clear(&mut self) {
        self.which.clear();
        self.levers.clear();
        self.slots.clear();
        self.rules.clear();
        self.rests.clear();
        self.any_firm = false;
        self.points.clear();
        self.strays.clear();
        self.answers.clear();
        self.second.clear();
        self.ways.clear();
    }

    /// Takes eight plain contacts of these numbers; what each is taken to bear.
    pub fn add(&mut self, numbers: [u32; EIGHT], contacts: &[Contact], v: &[Triple]) -> [[f64; 2]; EIGHT] {
        let own = numbers.map(|number| &contacts[number as usize]);
        let points = own.map(|contact| Point::<N>::lay(contact, contact.velocity(v)).0);
        self.which.extend(numbers);
        self.levers.push(Lever::of(own.map(|contact| &contact.rows)));
        self.slots.push(own.map(|contact| contact.slot));
        let (rule, rest) = Rule::of(own);
        self.rules.push(rule);
        self.rests.push(rest);
        self.any_firm |= rest.firm != [[0.0; EIGHT]; 2];
        self.points.push(Octet::of(&points));
        let (zero, brief) = ([0.0; EIGHT], [0.0; EIGHT]);
        self.strays.push(Stray { astray: [brief; N], off: [brief; 2] });
        self.answers.push(([zero; 3], [zero; 2]));
        self.second.push([brief; N]);
        self.ways.push(Way::none(brief));
        points.map(|p| p.p)
    }

    /// [`Point::enter`].
    pub fn enter(&mut self, v: &[Triple], scale: f64) {
        Arch::new().dispatch(Place { eights: self, v, scale: Some(scale) });
    }

    /// [`Point::settle`].
    pub fn settle(&mut self, v: &[Triple]) {
        Arch::new().dispatch(Place { eights: self, v, scale: None });
    }

    #[inline(always)]
    fn place_each<S: Simd>(&mut self, simd: S, v: &[Triple], scale: Option<f64>) {
        for ((points, rule), lever) in self.points.iter_mut().zip(&self.rules).zip(&self.levers) {
            let u = lever.gather(v);
            for part in 0..Lanes::<S>::PARTS {
                let (mut point, laws) = (points.part(simd, part), rule.part(None, simd, part));
                let u = lever.part(simd, part).change(parts(simd, &u, part));
                match scale {
                    Some(scale) => point.enter(&Kind::DRY.on, &laws, u, scale),
                    None => point.settle(&Kind::DRY.on, &laws, u),
                }
                points.put(&point, part);
            }
        }
    }

    pub fn look(&mut self, v: &[Triple], method: Method, sums: &mut Sums) {
        Arch::new().dispatch(Look { eights: self, v, method, sums });
    }

    #[inline(always)]
    fn look_at_each<S: Simd>(&mut self, simd: S, v: &[Triple], method: Method, sums: &mut Sums) {
        let zero = Lanes::all(simd, 0.0);
        let mut left = [Left::none(zero); EIGHT];
        let whole = method.begins_matrix();
        let mut joined = Joined::<ALL>::none();
        let points = self.points.iter_mut().zip(&mut self.strays).zip(&mut self.answers).zip(&self.ways);
        let inside = matches!(method, Method::Inside { .. });
        let asks = !inside || self.any_firm;
        for ((((points, strays), answers), ways), (((rule, rest), lever), slots)) in
            points.zip(self.rules.iter().zip(&self.rests).zip(&self.levers).zip(&self.slots))
        {
            let u = lever.gather(v);
            let mut numbers = [[0.0; EIGHT]; ALL];
            let before = answers.0;
            for part in 0..Lanes::<S>::PARTS {
                let (mut point, laws) = (points.part(simd, part), rule.part(asks.then_some(rest), simd, part));
                let arms = lever.part(simd, part);
                let (u, left) = (arms.change(parts(simd, &u, part)), &mut left[part]);
                let mut view = View::none(zero);
                let mut was = [zero; 3];
                match method {
                    Method::Inside { share } => {
                        point.go(zero.alike(share), &ways.part(simd, part));
                        view = point.view(laws.friction);
                        let bound = (laws.friction * point.p[0]).larger(zero);
                        point.stray(&laws, u, bound, &mut view, left);
                        point.gauge(&laws, &view, left);
                        points.put(&point, part);
                        put_brief(&mut strays.astray, view.astray, part);
                        put_brief(&mut strays.off, view.off, part);
                        // As the directions have them.
                        view.astray = widened(simd, &strays.astray, part);
                        view.off = widened(simd, &strays.off, part);
                        view.right = point.aim(&view, zero, &[zero; N]);
                    }
                    Method::AtBounds { .. } | Method::Onwards { .. } => {
                        let by_way = matches!(method, Method::AtBounds { led: true });
                        let led = if by_way { Some(point.led(&ways.part(simd, part))) } else { None };
                        if !whole {
                            was = parts(simd, &before, part);
                        }
                        point.choose_across(&laws, u[0], led, &mut view, left);
                        point.choose_along(&laws, (laws.friction, u[1]), led, &mut view, left);
                        put(&mut answers.0, view.response, part);
                        put(&mut answers.1, view.right, part);
                    }
                }
                // What answers to velocities: across and along to the same, and along to across.
                let now = view.response;
                let more = [now[0] - was[0], now[1] - was[1], was[2] * was[0] - now[2] * now[0]];
                put_at::<S, 4, ALL>(&mut numbers, 0, arms.thrust([-point.p[0], -point.p[1]]), part);
                put_at::<S, 4, ALL>(&mut numbers, 4, arms.thrust(view.right), part);
                put_at::<S, 16, ALL>(&mut numbers, PUSHES, arms.couple(more), part);
            }
            for k in 0..EIGHT {
                let bodies = lever.bodies(k);
                if joined.bodies != bodies {
                    joined.end_look(sums);
                    joined.begin(bodies, slots[k]);
                }
                let changes = !inside && (0..3).any(|i| before[i][k] != answers.0[i][k]);
                sums.changed += usize::from(changes);
                joined.add(&numbers, k, if whole || changes { ALL } else { PUSHES });
            }
        }
        joined.end_look(sums);
        for k in 0..EIGHT {
            sums.left.residual = sums.left.residual.worse(each(&left.map(|l| l.residual))[k]);
            sums.left.drawn = sums.left.drawn.larger(each(&left.map(|l| l.drawn))[k]);
            sums.left.products += each(&left.map(|l| l.products))[k];
        }
        sums.number += N * self.which.len();
    }

    /// Where a direction of velocities to products of 0 would lead, and what the contacts push with in the next direction.
    pub fn predict(&mut self, step: &[Triple], pushes: &mut [Vec<Triple>; 2], course: &mut Course) {
        Arch::new().dispatch(Predict { eights: self, step, pushes, course });
    }

    #[inline(always)]
    fn predict_each<S: Simd>(
        &mut self,
        simd: S,
        step: &[Triple],
        [on, rise]: &mut [Vec<Triple>; 2],
        course: &mut Course,
    ) {
        let zero = Lanes::all(simd, 0.0);
        let mut courses = [Course::begin(zero); EIGHT];
        let mut joined = Joined::<PUSHES>::none();
        let points = self.points.iter().zip(&self.strays).zip(&mut self.second);
        for (((points, strays), second), (rule, lever)) in points.zip(self.rules.iter().zip(&self.levers)) {
            let du = lever.gather(step);
            let mut numbers = [[0.0; EIGHT]; PUSHES];
            for part in 0..Lanes::<S>::PARTS {
                let (point, arms) = (points.part(simd, part), lever.part(simd, part));
                let view = strays.view(&point, rule, (simd, part));
                let right = point.aim(&view, zero, &[zero; N]);
                let way = point.way(&view, arms.change(parts(simd, &du, part)), right, zero, &[zero; N]);
                courses[part].meet(&point, &way, zero.alike(1.0));
                let mut own = [zero; N];
                for i in 0..N {
                    own[i] = way.s[i] * way.lambda[i];
                }
                put_brief(second, own, part);
                put_at::<S, 4, PUSHES>(&mut numbers, 0, arms.thrust(point.aim(&view, zero, &own)), part);
                put_at::<S, 4, PUSHES>(&mut numbers, 4, arms.thrust(point.rise(&view)), part);
            }
            for k in 0..EIGHT {
                let bodies = lever.bodies(k);
                if joined.bodies != bodies {
                    joined.push(0, on);
                    joined.push(4, rise);
                    joined.begin(bodies, None);
                }
                joined.add(&numbers, k, PUSHES);
            }
        }
        joined.push(0, on);
        joined.push(4, rise);
        course.join(&courses);
    }

    /// The direction of velocities `step`, to products of `target`, and how far it may be gone.
    pub fn turn(&mut self, step: &[Triple], target: f64, course: &mut Course) {
        Arch::new().dispatch(Turn { eights: self, step, target, course });
    }

    #[inline(always)]
    fn turn_each<S: Simd>(&mut self, simd: S, step: &[Triple], target: f64, course: &mut Course) {
        let zero = Lanes::all(simd, 0.0);
        let (target, inside) = (zero.alike(target), zero.alike(INSIDE));
        let mut courses = [Course::begin(zero); EIGHT];
        let points = self.points.iter().zip(&self.strays).zip(&self.second).zip(&mut self.ways);
        for ((((points, strays), second), ways), (rule, lever)) in points.zip(self.rules.iter().zip(&self.levers)) {
            let du = lever.gather(step);
            for part in 0..Lanes::<S>::PARTS {
                let (point, arms) = (points.part(simd, part), lever.part(simd, part));
                let view = strays.view(&point, rule, (simd, part));
                let second = widened(simd, second, part);
                let right = point.aim(&view, target, &second);
                let way = point.way(&view, arms.change(parts(simd, &du, part)), right, target, &second);
                courses[part].meet(&point, &way, inside);
                ways.put(&way, part);
            }
        }
        course.join(&courses);
    }

    /// Nothing is gone of the last.
    pub fn forget_directions(&mut self) {
        self.ways.fill(Way::none([0.0; EIGHT]));
    }

    /// Goes all of what Newton's method says.
    pub fn jump(&mut self, step: &[Triple]) {
        Arch::new().dispatch(Jump { eights: self, step });
    }

    #[inline(always)]
    fn jump_each<S: Simd>(&mut self, simd: S, step: &[Triple]) {
        for ((points, answers), lever) in self.points.iter_mut().zip(&self.answers).zip(&self.levers) {
            let du = lever.gather(step);
            for part in 0..Lanes::<S>::PARTS {
                let (point, arms) = (points.part(simd, part), lever.part(simd, part));
                let mut view = View::none(point.mass.alike(0.0));
                view.response = parts(simd, &answers.0, part);
                let right = parts(simd, &answers.1, part);
                let change = point.follows(&view, arms.change(parts(simd, &du, part)), right);
                put(&mut points.p, [point.p[0] + change[0], point.p[1] + change[1]], part);
            }
        }
    }

    /// Draws rigid contacts to what they bear now.
    pub fn anchor(&mut self) {
        for (points, rest) in self.points.iter_mut().zip(&self.rests) {
            for (k, lane) in (0..2).flat_map(|k| (0..EIGHT).map(move |lane| (k, lane))) {
                if rest.firm[k][lane] > 0.0 {
                    points.anchor[k][lane] = points.p[k][lane];
                }
            }
        }
    }

    pub fn keep(&mut self) {
        self.before.clear();
        self.before.extend(self.points.iter().map(|points| [points.p, points.anchor]));
    }

    pub fn restore(&mut self) {
        for (points, before) in self.points.iter_mut().zip(&self.before) {
            [points.p, points.anchor] = *before;
        }
    }

    pub fn tell(&self, contacts: &mut [Contact], v: &[Triple]) {
        for (points, which) in self.points.iter().zip(self.which.chunks_exact(EIGHT)) {
            for (k, number) in which.iter().enumerate() {
                let contact = &mut contacts[*number as usize];
                let u_n = contact.velocity(v)[0];
                points.one(k).tell(&Kind::DRY, contact, u_n);
            }
        }
    }
}

impl Course {
    /// Takes up what each of eight lanes comes to.
    #[inline(always)]
    fn join<S: Simd>(&mut self, lanes: &[Course<Lanes<S>>; EIGHT]) {
        let share = each(&lanes.map(|c| c.share));
        let growth = [0, 1].map(|k| each(&lanes.map(|c| c.growth[k])));
        for k in 0..EIGHT {
            self.share = self.share.smaller(share[k]);
            (0..2).for_each(|i| self.growth[i] += growth[i][k]);
        }
    }
}

/// [`Eights::look`] in the widest registers there are: the bits are the same in all.
struct Look<'a, 'b> {
    eights: &'a mut Eights,
    v: &'a [Triple],
    method: Method,
    sums: &'a mut Sums<'b>,
}

impl WithSimd for Look<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.eights.look_at_each(simd, self.v, self.method, self.sums);
    }
}

/// [`Eights::enter`] and [`Eights::settle`].
struct Place<'a> {
    eights: &'a mut Eights,
    v: &'a [Triple],
    scale: Option<f64>,
}

impl WithSimd for Place<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.eights.place_each(simd, self.v, self.scale);
    }
}

/// [`Eights::predict`].
struct Predict<'a> {
    eights: &'a mut Eights,
    step: &'a [Triple],
    pushes: &'a mut [Vec<Triple>; 2],
    course: &'a mut Course,
}

impl WithSimd for Predict<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.eights.predict_each(simd, self.step, self.pushes, self.course);
    }
}

/// [`Eights::turn`].
struct Turn<'a> {
    eights: &'a mut Eights,
    step: &'a [Triple],
    target: f64,
    course: &'a mut Course,
}

impl WithSimd for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.eights.turn_each(simd, self.step, self.target, self.course);
    }
}

/// [`Eights::jump`].
struct Jump<'a> {
    eights: &'a mut Eights,
    step: &'a [Triple],
}

impl WithSimd for Jump<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.eights.jump_each(simd, self.step);
    }
}
