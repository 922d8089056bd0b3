//! Contacts of the most frequent kind, a pack at a time: friction that follows from pressure alone, no largest pressure, and neither springs
//! beside nor bodies that are driven. All three bounds are always there, so that contacts of a pack are the same numbers side by side.

use pulp::{Arch, Simd, WithSimd};

use super::inside::{Does, Given, Inside, Joints, N, Rest, parts, put, put_at};
use super::lanes::{Lanes, PACK, Pack, Real};
use super::lever::{ALL, Bodies, Joined, PUSHES};
use super::point::{Course, Kind, Left, Point, View, is_dry};
use super::{Method, Sums};
use crate::blocks::Triple;
use crate::contact::Contact;

/// Contacts in packs.
#[derive(Debug, Clone, Default)]
pub(super) struct Packs {
    /// Their numbers, one after the other.
    which: Vec<u32>,
    joints: Joints,
    inside: Inside,
    rests: Vec<Rest>,
    /// What contacts do by Newton's method, and what impulses change by where velocities stay.
    does: Vec<(Does, [Pack; 2])>,
    /// Whether a direction of Newton's method has yet to be gone.
    leaps: bool,
    /// Impulses before an attempt to end.
    before: Vec<[Pack; 2]>,
}

/// Whether a contact is of this kind.
pub(super) fn is_plain(contact: &Contact) -> bool {
    let alone = contact.spring[1] == Default::default() && contact.drift == [0.0; 2] && contact.tight == 1.0;
    alone && contact.rows.levers().is_some() && contact.pressure[1] == f64::INFINITY && is_dry(contact)
}

impl Packs {
    /// None yet.
    pub fn clear(&mut self) {
        self.which.clear();
        self.joints.bodies.clear();
        self.joints.slots.clear();
        self.inside.clear();
        self.rests.clear();
    }

    /// Takes a pack of plain contacts of these numbers; what each is taken to bear.
    pub fn add(&mut self, numbers: [u32; PACK], contacts: &[Contact], v: &[Triple]) -> [[f64; 2]; PACK] {
        let own = numbers.map(|number| &contacts[number as usize]);
        let points = own.map(|contact| Point::<N>::lay(contact, contact.velocity(v)).0);
        self.which.extend(numbers);
        let (bodies, arms) = Bodies::of(own.map(|contact| &contact.rows));
        self.joints.bodies.push(bodies);
        self.joints.slots.push(own.map(|contact| contact.slot));
        let (given, rest) = Given::of(own, &points, arms);
        self.rests.push(rest);
        let p = [0, 1].map(|k| points.map(|point| point.p[k]));
        self.inside.add(given, p);
        points.map(|p| p.p)
    }

    /// [`Point::enter`].
    pub fn enter(&mut self, v: &[Triple], scale: f64) {
        Arch::new().dispatch(Enter { packs: self, v, scale });
    }

    /// [`Point::settle`].
    pub fn settle(&mut self, v: &[Triple]) {
        Arch::new().dispatch(Settle { packs: self, v });
    }

    /// With all of the direction `gone` that Newton's method said last, if it was told to [`Packs::leap`].
    pub fn look(&mut self, v: &[Triple], gone: &[Triple], method: Method, sums: &mut Sums) {
        Arch::new().dispatch(Look { packs: self, v, gone, method, sums });
    }

    /// By Newton's method, with the bounds at first that the last direction tells (`by_way`). Impulses go with the direction `gone` here, where all
    /// that takes is at hand.
    #[inline(always)]
    fn choose<S: Simd>(
        &mut self,
        simd: S,
        (v, gone): (&[Triple], &[Triple]),
        (by_way, first): (bool, bool),
        sums: &mut Sums,
    ) {
        let zero = Lanes::all(simd, 0.0);
        let mut left = [Left::none(zero); PACK];
        let mut joined = Joined::<ALL>::none();
        let leaps = std::mem::take(&mut self.leaps);
        if first {
            self.does.resize(self.inside.given.len(), (Does::default(), [[0.0; PACK]; 2]));
        }
        let mut impulses = std::mem::take(&mut self.inside.p);
        let points = self.inside.given.iter().zip(&mut impulses).zip(&mut self.does).zip(&self.rests);
        let joints = self.joints.bodies.iter().zip(&self.joints.slots);
        for (at, ((((given, p), (does, rights)), rest), (bodies, slots))) in points.zip(joints).enumerate() {
            let u = bodies.gather(v);
            let mut numbers = [[0.0; PACK]; ALL];
            let du = if leaps { bodies.gather(gone) } else { [[0.0; PACK]; 4] };
            let before = *does;
            let leads = match by_way {
                true => self.inside.leads(simd, at),
                false => [[0.0; PACK]; N],
            };
            for part in 0..Lanes::<S>::PARTS {
                let laws = given.laws(Some(rest), (simd, part));
                let (mut point, arms) = (given.point(p, None, (simd, part)), given.arms.part(simd, part));
                let mut view = View::none(zero);
                if leaps || !first {
                    view.response = before.response(&point, laws.friction, (simd, part));
                }
                let was = if first { [zero; 3] } else { view.response };
                if leaps {
                    let change = point.follows(&view, arms.change(parts(simd, &du, part)), parts(simd, rights, part));
                    point.p = [point.p[0] + change[0], point.p[1] + change[1]];
                    put(p, point.p, part);
                }
                let (u, left) = (arms.change(parts(simd, &u, part)), &mut left[part]);
                let led = by_way.then(|| parts(simd, &leads, part).map(|led| zero.below(led)));
                point.choose_across(&laws, u[0], led, &mut view, left);
                point.choose_along(&laws, (laws.friction, u[1]), led, &mut view, left);
                does.put(view.response, part);
                put(rights, view.right, part);
                let now = view.response;
                let more = [now[0] - was[0], now[1] - was[1], was[2] * was[0] - now[2] * now[0]];
                put_at::<S, 4, ALL>(&mut numbers, 0, arms.thrust([-point.p[0], -point.p[1]]), part);
                put_at::<S, 4, ALL>(&mut numbers, 4, arms.thrust(view.right), part);
                put_at::<S, 16, ALL>(&mut numbers, PUSHES, arms.couple(more), part);
            }
            for k in 0..PACK {
                let own = bodies.each(k);
                if joined.bodies != own {
                    joined.end_look(sums);
                    joined.begin(own, slots[k]);
                }
                let changes = before.one(k) != does.one(k);
                sums.changed += usize::from(changes);
                joined.add(&numbers, k, if first || changes { ALL } else { PUSHES });
            }
        }
        joined.end_look(sums);
        self.inside.p = impulses;
        sums.left.join(&left);
        sums.number += N * self.which.len();
    }

    /// Where a direction of velocities to products of 0 would lead, and what the contacts push with in the next direction.
    pub fn predict(&mut self, step: &[Triple], pushes: &mut [Vec<Triple>; 2], course: &mut Course) {
        Arch::new().dispatch(Predict { packs: self, step, pushes, course });
    }

    /// The direction of velocities `step`, to products of a target, and how far it may be gone, over what yields whatever its bounds if `aim` says so.
    pub fn turn(&mut self, step: &[Triple], aim: (f64, bool), course: &mut Course) {
        Arch::new().dispatch(Turn { packs: self, step, aim, course });
    }

    /// All of what Newton's method says is to be gone.
    pub fn leap(&mut self) {
        self.leaps = true;
    }

    pub fn keep(&mut self) {
        self.before.clear();
        self.before.extend_from_slice(&self.inside.p);
    }

    pub fn restore(&mut self) {
        self.leaps = false;
        for (p, before) in self.inside.p.iter_mut().zip(&self.before) {
            *p = *before;
        }
    }

    pub fn tell(&mut self, contacts: &mut [Contact], v: &[Triple]) {
        for (at, which) in self.which.chunks_exact(PACK).enumerate() {
            for (k, number) in which.iter().enumerate() {
                let contact = &mut contacts[*number as usize];
                let u_n = contact.velocity(v)[0];
                self.inside.one(at, k).tell(&Kind::DRY, contact, u_n);
            }
        }
    }
}

/// [`Packs::look`] in the widest registers there are: the bits are the same in all.
struct Look<'a, 'b> {
    packs: &'a mut Packs,
    v: &'a [Triple],
    gone: &'a [Triple],
    method: Method,
    sums: &'a mut Sums<'b>,
}

impl WithSimd for Look<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Look { packs, v, gone, method, sums } = self;
        match method {
            Method::Inside { share } => {
                let Packs { joints, inside, .. } = packs;
                inside.look(simd, joints, v, share, None, sums)
            }
            Method::AtBounds { led } => packs.choose(simd, (v, gone), (led, true), sums),
            Method::Onwards => packs.choose(simd, (v, gone), (false, false), sums),
        }
    }
}

/// [`Packs::enter`].
struct Enter<'a> {
    packs: &'a mut Packs,
    v: &'a [Triple],
    scale: f64,
}

impl WithSimd for Enter<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Packs { joints, inside, .. } = self.packs;
        inside.enter(simd, joints, self.v, self.scale)
    }
}

/// [`Packs::settle`].
struct Settle<'a> {
    packs: &'a mut Packs,
    v: &'a [Triple],
}

impl WithSimd for Settle<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Packs { joints, inside, .. } = self.packs;
        inside.settle(simd, joints, self.v);
    }
}

/// [`Packs::predict`].
struct Predict<'a> {
    packs: &'a mut Packs,
    step: &'a [Triple],
    pushes: &'a mut [Vec<Triple>; 2],
    course: &'a mut Course,
}

impl WithSimd for Predict<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Packs { joints, inside, .. } = self.packs;
        inside.predict(simd, joints, self.step, self.pushes, self.course)
    }
}

/// [`Packs::turn`].
struct Turn<'a> {
    packs: &'a mut Packs,
    step: &'a [Triple],
    aim: (f64, bool),
    course: &'a mut Course,
}

impl WithSimd for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Packs { joints, inside, .. } = self.packs;
        inside.turn(simd, joints, self.step, self.aim, self.course)
    }
}
