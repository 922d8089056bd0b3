//! Contacts of any kind, one by one.

use pulp::{Arch, Simd, WithSimd};

use super::point::{Course, Kind, Laws, Left, Point, View, Way};
use super::{Method, Sums};
use crate::blocks::Triple;
use crate::contact::{Contact, Rows};

/// Contacts with as many bounds. What is fetched and what is written in each go through them lies apart: in walls of thousands of
/// blocks a step takes as long as that.
#[derive(Debug, Clone)]
pub(super) struct Group<const N: usize> {
    /// Their numbers.
    which: Vec<u32>,
    /// Theirs again, close together: most goes through the contacts need no more of them.
    rows: Vec<Rows>,
    kinds: Vec<Kind<N>>,
    points: Vec<Point<N>>,
    views: Vec<View<N>>,
    /// Second-order part of the products.
    second: Vec<[f64; N]>,
    /// Changes along the last direction.
    ways: Vec<Way<N>>,
    /// Impulses and E, before an attempt to end.
    before: Vec<[[f64; 2]; 2]>,
}

impl<const N: usize> Default for Group<N> {
    fn default() -> Self {
        Group {
            which: Vec::new(),
            rows: Vec::new(),
            kinds: Vec::new(),
            points: Vec::new(),
            views: Vec::new(),
            second: Vec::new(),
            ways: Vec::new(),
            before: Vec::new(),
        }
    }
}

impl<const N: usize> Group<N> {
    pub fn clear(&mut self) {
        self.which.clear();
        self.rows.clear();
        self.kinds.clear();
        self.points.clear();
        self.views.clear();
        self.second.clear();
        self.ways.clear();
    }

    /// Another contact; what it is taken to bear.
    pub fn add(&mut self, number: usize, contact: &Contact, u: [f64; 2]) -> [f64; 2] {
        let (point, kind) = Point::lay(contact, u);
        self.which.push(number as u32);
        self.rows.push(contact.rows);
        self.kinds.push(kind);
        self.points.push(point);
        self.views.push(View::none(0.0));
        self.second.push([0.0; N]);
        self.ways.push(Way::none(0.0));
        point.p
    }

    pub fn enter(&mut self, contacts: &[Contact], v: &[Triple], scale: f64) {
        for ((point, kind), which) in self.points.iter_mut().zip(&self.kinds).zip(&self.which) {
            let contact = &contacts[*which as usize];
            let u = contact.velocity(v);
            point.enter(&kind.on, &Laws::of(contact, u), u, scale);
        }
    }

    pub fn look(&mut self, contacts: &[Contact], v: &[Triple], method: Method, sums: &mut Sums) {
        Arch::new().dispatch(Look { group: self, contacts, v, method, sums });
    }

    #[inline(always)]
    fn look_at_each(&mut self, contacts: &[Contact], v: &[Triple], method: Method, sums: &mut Sums) {
        let each =
            self.points.iter_mut().zip(&mut self.views).zip(&mut self.ways).zip(&mut self.kinds).zip(&self.which);
        for ((((point, view), way), kind), which) in each {
            let contact = &contacts[*which as usize];
            let u = contact.velocity(v);
            let before = *view;
            match method {
                Method::Inside { share } => {
                    point.go(share, way);
                    point.look(kind, contact, u, (view, way), &mut sums.left);
                    sums.number += kind.on.iter().filter(|on| **on).count();
                    point.respond(view);
                    view.right = point.aim(view, 0.0, &[0.0; N]);
                }
                Method::AtBounds { led } => point.choose(kind, contact, u, led.then_some(&*way), view, &mut sums.left),
                Method::Onwards => point.choose(kind, contact, u, None, view, &mut sums.left),
            }
            contact.push(sums.residual, contact.whole(point.p, u));
            contact.rows.push(sums.step, view.right);
            let changes = before.response != view.response;
            sums.changed += usize::from(changes);
            if method.begins_matrix() {
                contact.rows.couple(contact.slot, sums.matrix, view.answers(contact));
            } else if changes {
                let [now, was] = [&*view, &before].map(|view| view.answers(contact));
                contact.rows.couple(contact.slot, sums.matrix, std::array::from_fn(|k| now[k] - was[k]));
            }
        }
    }

    /// Where a direction of velocities to products of 0 would lead, and what the contacts push with in the next direction.
    pub fn predict(&mut self, step: &[Triple], pushes: &mut [Vec<Triple>; 2], course: &mut Course) {
        Arch::new().dispatch(Predict { group: self, step, pushes, course });
    }

    #[inline(always)]
    fn predict_each(&mut self, step: &[Triple], [push, rise]: &mut [Vec<Triple>; 2], course: &mut Course) {
        let each = self.points.iter().zip(&self.views).zip(&mut self.second).zip(&self.rows);
        for (((point, view), second), rows) in each {
            let way = point.way(view, rows.change(step), view.right, 0.0, &[0.0; N]);
            course.meet(point, &way, false);
            *second = std::array::from_fn(|i| way.s[i] * way.lambda[i]);
            rows.push(push, point.aim(view, 0.0, second));
            rows.push(rise, point.rise(view));
        }
    }

    /// [`super::packs::Packs::turn`].
    pub fn turn(&mut self, step: &[Triple], aim: (f64, bool), course: &mut Course) {
        Arch::new().dispatch(Turn { group: self, step, aim, course });
    }

    #[inline(always)]
    fn turn_each(&mut self, step: &[Triple], (target, bold): (f64, bool), course: &mut Course) {
        let each = self.points.iter().zip(&self.views).zip(&self.second).zip(&mut self.ways).zip(&self.rows);
        for ((((point, view), second), way), rows) in each {
            let right = point.aim(view, target, second);
            *way = point.way(view, rows.change(step), right, target, second);
            course.meet(point, way, bold);
        }
    }

    /// Goes all of what Newton's method says.
    pub fn jump(&mut self, step: &[Triple]) {
        for ((point, view), rows) in self.points.iter_mut().zip(&self.views).zip(&self.rows) {
            let change = point.follows(view, rows.change(step), view.right);
            (0..2).for_each(|k| point.p[k] += change[k]);
        }
    }

    pub fn keep(&mut self) {
        self.before.clear();
        self.before.extend(self.points.iter().map(|point| [point.p, point.soft]));
    }

    pub fn restore(&mut self) {
        for (point, before) in self.points.iter_mut().zip(&self.before) {
            [point.p, point.soft] = *before;
        }
    }

    /// Distances and multipliers of the impulses as they are.
    pub fn settle(&mut self, contacts: &[Contact], v: &[Triple]) {
        for ((point, kind), which) in self.points.iter_mut().zip(&mut self.kinds).zip(&self.which) {
            let contact = &contacts[*which as usize];
            let u = contact.velocity(v);
            let grips = kind.rubs && (kind.dry || contact.bound(point.p[0], u[0]) > 0.0);
            (kind.moves[1], kind.on[0], kind.on[1]) = (grips, grips, grips);
            point.settle(&kind.on, &Laws::of(contact, u), u);
        }
    }

    pub fn tell(&self, contacts: &mut [Contact], v: &[Triple]) {
        for ((point, kind), which) in self.points.iter().zip(&self.kinds).zip(&self.which) {
            let contact = &mut contacts[*which as usize];
            let u_n = contact.velocity(v)[0];
            point.tell(kind, contact, u_n);
        }
    }
}

impl<const N: usize> View<N> {
    /// What a contact and the springs beside answer to velocities: across and along to the same, and along to across.
    #[inline(always)]
    fn answers(&self, contact: &Contact) -> [f64; 3] {
        let [across, along, tilt] = self.response;
        let [beside, along_beside] = contact.spring.map(|s| s.rho);
        [across + beside, along + along_beside, -tilt * (across + beside)]
    }
}

impl<const N: usize> Point<N> {
    /// By how much it is off at the velocity `u`.
    #[inline(always)]
    fn look(
        &mut self,
        kind: &mut Kind<N>,
        contact: &Contact,
        u: [f64; 2],
        (view, way): (&mut View<N>, &mut Way<N>),
        left: &mut Left,
    ) {
        let laws = Laws::of(contact, u);
        view.mu = self.mu(kind, contact, u[0], laws.beside);
        let bound = (view.mu * (self.p[0] + laws.beside)).max(0.0) + contact.hold;
        if !kind.dry && kind.rubs {
            self.grip(kind, bound, contact, way);
            view.mu = if kind.moves[1] { view.mu } else { 0.0 };
        }
        view.near = std::array::from_fn(|i| if kind.on[i] { 1.0 / self.s[i] } else { 0.0 });
        self.stray(&laws, u, bound, view, left);
        (0..2).filter(|k| !kind.moves[*k]).for_each(|k| view.off[k] = 0.0);
        self.gauge(&laws, view, left);
    }

    /// What it leaves of (P4) at the velocity `u`, and what impulses do where the bounds hold that hold by impulses and velocities now,
    /// or by the last direction.
    #[inline(always)]
    fn choose(
        &mut self,
        kind: &Kind<N>,
        contact: &Contact,
        u: [f64; 2],
        way: Option<&Way<N>>,
        view: &mut View<N>,
        left: &mut Left,
    ) {
        let laws = Laws::of(contact, u);
        let led = way.map(|way| self.led(way));
        (view.response, view.right) = ([0.0; 3], [0.0; 2]);
        if kind.moves[0] {
            self.choose_across(&laws, u[0], led, view, left);
        }
        if kind.rubs {
            if self.soft[1] == 0.0 {
                self.soft[1] = super::point::soft(contact, 1);
            }
            let pressed = kind.dry || self.p[0] + laws.beside > 0.0;
            let mu = if pressed { contact.friction } else { 0.0 };
            self.choose_along(&laws, (mu, u[1]), led.filter(|_| kind.on[0]), view, left);
        }
    }
}

/// [`Group::look`] compiled for some registers, as all that goes through the contacts in every iteration: the bits are the same in all.
struct Look<'a, 'b, const N: usize> {
    group: &'a mut Group<N>,
    contacts: &'a [Contact],
    v: &'a [Triple],
    method: Method,
    sums: &'a mut Sums<'b>,
}

impl<const N: usize> WithSimd for Look<'_, '_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.group.look_at_each(self.contacts, self.v, self.method, self.sums);
    }
}

/// [`Group::predict`].
struct Predict<'a, const N: usize> {
    group: &'a mut Group<N>,
    step: &'a [Triple],
    pushes: &'a mut [Vec<Triple>; 2],
    course: &'a mut Course,
}

impl<const N: usize> WithSimd for Predict<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.group.predict_each(self.step, self.pushes, self.course);
    }
}

/// [`Group::turn`].
struct Turn<'a, const N: usize> {
    group: &'a mut Group<N>,
    step: &'a [Triple],
    aim: (f64, bool),
    course: &'a mut Course,
}

impl<const N: usize> WithSimd for Turn<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.group.turn_each(self.step, self.aim, self.course);
    }
}
