//! Contacts of the most frequent kind, a pack at a time: friction that follows from pressure alone, no largest pressure, and neither springs
//! beside nor bodies that are driven. All three bounds are always there, so that contacts of a pack are the same numbers side by side.

use pulp::{Arch, Simd, WithSimd};

use super::inside::{Does, Given, Inside, Joints, N, Rest, parts, put, put_at};
use super::lanes::{Lanes, PACK, Pack, Real, brief, wide};
use super::lever::{ALL, Bodies, Joined, PUSHES};
use super::point::{Course, Kind, Left, Point, View, is_dry};
use super::{Method, Sums};
use crate::blocks::{Digits, Triple};
use crate::contact::Contact;

/// Contacts in packs. Interior points go on with half of the digits, in half the room, for as long as directions do; Newton's method has all.
#[derive(Debug, Clone)]
pub(super) struct Packs {
    /// Their numbers, one after the other.
    which: Vec<u32>,
    joints: Joints,
    /// What interior points go on with: `rough`, or with all digits `fine`, where Newton's method too has what the laws say and the impulses.
    digits: Digits,
    rough: Inside<f32>,
    fine: Inside<f64>,
    rests: Vec<Rest>,
    /// What contacts do by Newton's method, and what impulses change by where velocities stay.
    does: Vec<(Does, [Pack<f64>; 2])>,
    /// Whether a direction of Newton's method has yet to be gone.
    leaps: bool,
    /// Impulses before an attempt to end.
    before: Vec<[Pack<f64>; 2]>,
}

impl Default for Packs {
    fn default() -> Self {
        Packs {
            which: Vec::new(),
            joints: Joints::default(),
            digits: Digits::All,
            rough: Inside::default(),
            fine: Inside::default(),
            rests: Vec::new(),
            does: Vec::new(),
            leaps: false,
            before: Vec::new(),
        }
    }
}

/// Whether a contact is of this kind.
pub(super) fn is_plain(contact: &Contact) -> bool {
    let alone = contact.spring[1] == Default::default() && contact.drift == [0.0; 2] && contact.tight == 1.0;
    alone && contact.rows.levers().is_some() && contact.pressure[1] == f64::INFINITY && is_dry(contact)
}

impl Packs {
    /// None yet, of those that interior points will have with these digits.
    pub fn begin(&mut self, digits: Digits) {
        self.which.clear();
        self.joints.bodies.clear();
        self.joints.slots.clear();
        self.digits = digits;
        self.rough.clear();
        self.fine.clear();
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
        if self.digits == Digits::Half {
            self.rough.add(given.brief(), p.map(brief));
        }
        self.fine.add(given, p);
        points.map(|p| p.p)
    }

    /// All digits from here on.
    pub fn refine(&mut self) {
        if self.digits == Digits::Half {
            self.fine.take_over(&mut self.rough);
            self.digits = Digits::All;
        }
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
        (by_way, first, whole): (bool, bool, bool),
        sums: &mut Sums,
    ) {
        let zero = Lanes::all(simd, 0.0);
        let mut left = [Left::none(zero); PACK];
        let mut joined = Joined::<f64, ALL>::none();
        let rough = self.digits == Digits::Half;
        let leaps = std::mem::take(&mut self.leaps);
        if first {
            self.does.resize(self.fine.given.len(), (Does::default(), [[0.0; PACK]; 2]));
            if rough {
                self.fine.p.iter_mut().zip(&self.rough.p).for_each(|(fine, rough)| *fine = rough.map(wide));
            }
        }
        let mut impulses = std::mem::take(&mut self.fine.p);
        let points = self.fine.given.iter().zip(&mut impulses).zip(&mut self.does).zip(&self.rests);
        let joints = self.joints.bodies.iter().zip(&self.joints.slots);
        for (at, ((((given, p), (does, rights)), rest), (bodies, slots))) in points.zip(joints).enumerate() {
            let u = bodies.gather::<f64>(v);
            let mut numbers = [[0.0; PACK]; ALL];
            let du = if leaps { bodies.gather::<f64>(gone) } else { [[0.0; PACK]; 4] };
            let before = *does;
            let leads = match by_way {
                true if rough => self.rough.leads(simd, at),
                true => self.fine.leads(simd, at),
                false => [[0.0; PACK]; N],
            };
            for part in 0..Lanes::<S, f64>::PARTS {
                let laws = given.laws(Some(rest), (simd, part));
                let (mut point, arms) = (given.point(p, None, (simd, part)), given.arms.part(simd, part));
                let mut view = View::none(zero);
                if leaps || !whole {
                    view.response = before.response(&point, laws.friction, (simd, part));
                }
                let was = if whole { [zero; 3] } else { view.response };
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
                put_at::<S, f64, 4, ALL>(&mut numbers, 0, arms.thrust([-point.p[0], -point.p[1]]), part);
                put_at::<S, f64, 4, ALL>(&mut numbers, 4, arms.thrust(view.right), part);
                put_at::<S, f64, 16, ALL>(&mut numbers, PUSHES, arms.couple(more), part);
            }
            for k in 0..PACK {
                let own = bodies.each(k);
                if joined.bodies != own {
                    joined.end_look(sums);
                    joined.begin(own, slots[k]);
                }
                let changes = before.one(k) != does.one(k);
                sums.changed += usize::from(changes);
                joined.add(&numbers, k, if whole || changes { ALL } else { PUSHES });
            }
        }
        joined.end_look(sums);
        self.fine.p = impulses;
        sums.left.join(&left);
        sums.number += N * self.which.len();
    }

    /// Where a direction of velocities to products of 0 would lead, and what the contacts push with in the next direction.
    pub fn predict(&mut self, step: &[Triple], pushes: &mut [Vec<Triple>; 2], course: &mut Course) {
        Arch::new().dispatch(Predict { packs: self, step, pushes, course });
    }

    /// The direction of velocities `step`, to products of `target`, and how far it may be gone.
    pub fn turn(&mut self, step: &[Triple], target: f64, course: &mut Course) {
        Arch::new().dispatch(Turn { packs: self, step, target, course });
    }

    /// All of what Newton's method says is to be gone.
    pub fn leap(&mut self) {
        self.leaps = true;
    }

    /// What goes back to half of the digits need not be kept: they stay.
    pub fn keep(&mut self) {
        self.before.clear();
        if self.digits == Digits::Half {
            return;
        }
        self.before.extend_from_slice(&self.fine.p);
    }

    pub fn restore(&mut self) {
        self.leaps = false;
        for (p, before) in self.fine.p.iter_mut().zip(&self.before) {
            *p = *before;
        }
    }

    pub fn tell(&mut self, contacts: &mut [Contact], v: &[Triple]) {
        self.refine();
        for (at, which) in self.which.chunks_exact(PACK).enumerate() {
            for (k, number) in which.iter().enumerate() {
                let contact = &mut contacts[*number as usize];
                let u_n = contact.velocity(v)[0];
                self.fine.one(at, k).tell(&Kind::DRY, contact, u_n);
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
                let Packs { joints, rough, fine, .. } = packs;
                match packs.digits {
                    Digits::Half => rough.look(simd, joints, v, share, None, sums),
                    Digits::All => fine.look(simd, joints, v, share, None, sums),
                }
            }
            Method::AtBounds { led } => packs.choose(simd, (v, gone), (led, true, true), sums),
            Method::Onwards { whole } => packs.choose(simd, (v, gone), (false, false, whole), sums),
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
        let Packs { joints, rough, fine, digits, .. } = self.packs;
        match digits {
            Digits::Half => rough.enter(simd, joints, self.v, self.scale),
            Digits::All => fine.enter(simd, joints, self.v, self.scale),
        }
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
        let Packs { joints, fine, digits, .. } = self.packs;
        fine.settle(simd, joints, self.v);
        *digits = Digits::All;
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
        let Packs { joints, rough, fine, digits, .. } = self.packs;
        match digits {
            Digits::Half => rough.predict(simd, joints, self.step, self.pushes, self.course),
            Digits::All => fine.predict(simd, joints, self.step, self.pushes, self.course),
        }
    }
}

/// [`Packs::turn`].
struct Turn<'a> {
    packs: &'a mut Packs,
    step: &'a [Triple],
    target: f64,
    course: &'a mut Course,
}

impl WithSimd for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Packs { joints, rough, fine, digits, .. } = self.packs;
        match digits {
            Digits::Half => rough.turn(simd, joints, self.step, self.target, self.course),
            Digits::All => fine.turn(simd, joints, self.step, self.target, self.course),
        }
    }
}
