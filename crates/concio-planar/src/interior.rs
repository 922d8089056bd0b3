//! Velocities at the end of a step by an interior point method.
//!
//! The impulses p of a contact obey up to four bounds,
//!
//! (P5)  s₁ = p_n − least,   s₂ = most − p_n,   s₃ = B − p_t,   s₄ = B + p_t,   B = μ [p_n + s_n]₊ + hold
//!
//! with s_n what springs beside press, and with a multiplier λ ≥ 0 for each, 0 ≤ λ ⊥ s ≥ 0,
//!
//! (P5a)  u_n + b + E_n (p_n − p_n⁰) = λ₁ − λ₂,   u_t + E_t (p_t − p_t⁰) = λ₄ − λ₃
//!
//! are (P2) and (P3): what slides bears against its slide all that friction allows, and opens no more than what sticks. In the plane
//! this is a linear complementarity problem (Lötstedt 1981), and not a program with a least value: its matrix is not symmetric. Where
//! springs beside or bonds can pull, [p_n + s_n]₊ has a kink besides, and whether friction bears anything is decided from iterate to
//! iterate.
//! E is 1/ρ of (P4), that of a spring where a contact is compliant; elsewhere it is small, p⁰ is what the
//! contact bore before, and both choose among impulses that give the same motion those nearest to p⁰.
//!
//! Every iteration solves (P1), (P5) and (P5a), linear about the iterate and with products λ s that fall, for v: a matrix like that
//! of [`crate::contact`] with what friction answers to pressure in each contact. It is factorised once per iteration, in 32 bits where no
//! contact is too stiff for that, and used for a prediction and a correction (Mehrotra 1992). However many contacts open and close, that takes
//! about a dozen iterations, the last few of them by Newton's method on the laws themselves where nearly all contacts have springs
//! (`interior/finish.rs`).

mod finish;

use pulp::{Arch, Simd, WithSimd};

use crate::blocks::{Blocks, Digits, Triple};
use crate::contact::{Contact, Effort, Rows, Status, unbalance, worse};

/// Iterations after which a step is given up.
const MOST: usize = 60;
/// 1/E over ρ of a rigid contact: more leaves what head joints bear to chance instead of to what they bore before, less
/// gives way by more than the tolerance.
const FIRM: f64 = 1e4;
/// Iterations in which what is left has to be halved: once it is small enough, and before.
const PATIENCE: usize = 8;
const STALLED: usize = 25;
/// Iterations that have not halved what is left after which it begins anew, once, from where it came to, and for what is out of balance
/// then the share of what was left at first: bounds it came too near to on its way keep the way short, and there are steps that it never
/// ends otherwise.
const ANEW: usize = 4;
const NEARER: f64 = 0.01;
/// Largest 1/E, with springs beside, over the mass that a contact moves where half of the digits tell directions, which are off by some 6·10⁻⁸
/// of that.
const YIELDING: f64 = 1e5;
/// Least distance from the bounds at the start, over what is out of balance, and over what was borne before.
const FLOOR: f64 = 1.0;
const SHARE: f64 = 0.02;
/// Least multiplier at the start, over what is out of balance, and that of friction that begins to bear, over its bound by the mass.
const CRACK: f64 = 0.5;
const GRIP: f64 = 0.01;
/// Share of the way to the boundary that is gone.
const INSIDE: f64 = 0.995;
/// Share of the way after which products are evened out instead of reduced.
const STUCK: f64 = 0.03;
/// What distances from bounds are rounded by, over the impulses: to mend it would keep the way short where a bound is met.
const ROUNDED: f64 = 1e-13;

/// How the multiplier of each bound stands in (P5a), and in which direction: 0 across, 1 along.
const SENSE: [f64; 4] = [-1.0, 1.0, 1.0, -1.0];
const DIRECTION: [usize; 4] = [1, 1, 0, 0];

/// A contact during a solution: with three bounds, or with that of crushing four.
#[derive(Debug, Clone, Copy)]
struct Point<const N: usize> {
    /// How far each bound is away, and its multiplier: friction forth and back, least and most p_n.
    s: [f64; N],
    lambda: [f64; N],
    /// Impulses, and those that it is drawn to, p⁰.
    p: [f64; 2],
    anchor: [f64; 2],
    /// Diagonal of E.
    soft: [f64; 2],
    /// Mass that a push moves, and spring across [kg].
    mass: f64,
    rho: f64,
    /// Whether the impulse across and along may change, whether there is friction, whether it follows from pressure alone, and which
    /// bounds there are.
    moves: [bool; 2],
    rubs: bool,
    dry: bool,
    on: [bool; N],
}

/// What a look at a point makes of it, for the directions from there.
#[derive(Debug, Clone, Copy)]
struct View<const N: usize> {
    /// One over the distance from each bound, 0 where there is no such bound.
    near: [f64; N],
    /// By how much (P5) and (P5a) are off.
    astray: [f64; N],
    off: [f64; 2],
    /// μ where the contact is pressed, 0 where it is pulled.
    mu: f64,
    /// By how much impulses fall as velocities rise, across and along, and the impulse along as the pressure across rises.
    response: [f64; 3],
    /// Impulses where velocities stay, to products of 0.
    right: [f64; 2],
}

impl<const N: usize> View<N> {
    const NONE: Self =
        View { near: [0.0; N], astray: [0.0; N], off: [0.0; 2], mu: 0.0, response: [0.0; 3], right: [0.0; 2] };

    /// Impulses by what (P5a) is off.
    #[inline(always)]
    fn answer(&self, off: [f64; 2]) -> [f64; 2] {
        let [across, along, tilt] = self.response;
        let p_n = across * off[0];
        [p_n, along * off[1] - tilt * p_n]
    }

    /// What a contact and the springs beside answer to velocities: across and along to the same, and along to across.
    #[inline(always)]
    fn answers(&self, contact: &Contact) -> [f64; 3] {
        let [across, along, tilt] = self.response;
        let [beside, along_beside] = contact.spring.map(|s| s.rho);
        [across + beside, along + along_beside, -tilt * (across + beside)]
    }
}

/// A direction of impulses, distances and multipliers.
#[derive(Debug, Clone, Copy)]
struct Way<const N: usize> {
    p: [f64; 2],
    s: [f64; N],
    lambda: [f64; N],
}

impl<const N: usize> Way<N> {
    const NONE: Self = Way { p: [0.0; 2], s: [0.0; N], lambda: [0.0; N] };
}

/// Contacts with as many bounds. What is fetched and what is written in each go through them lies apart: in walls of thousands of
/// blocks a step takes as long as that.
#[derive(Debug, Clone)]
struct Group<const N: usize> {
    /// Their numbers.
    which: Vec<u32>,
    /// Theirs again, close together: most goes through the contacts need no more of them.
    rows: Vec<Rows>,
    points: Vec<Point<N>>,
    views: Vec<View<N>>,
    /// Second-order part of the products.
    second: Vec<[f64; N]>,
    /// Changes along the last direction.
    ways: Vec<Way<N>>,
    /// Impulses, what they are drawn to and E, before an attempt to end.
    before: Vec<[[f64; 2]; 3]>,
}

impl<const N: usize> Default for Group<N> {
    fn default() -> Self {
        Group {
            which: Vec::new(),
            rows: Vec::new(),
            points: Vec::new(),
            views: Vec::new(),
            second: Vec::new(),
            ways: Vec::new(),
            before: Vec::new(),
        }
    }
}

/// Room for the solution.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interior {
    /// Contacts without and with a largest p_n.
    usual: Group<3>,
    limited: Group<4>,
    residual: Vec<Triple>,
    step: Vec<Triple>,
    work: Vec<Triple>,
    /// What contacts push with where velocities stay and second-order parts of the products are taken off: to products of 0, and
    /// what each unit of the products adds.
    pushes: [Vec<Triple>; 2],
    /// Velocities before an attempt to end.
    before: Vec<Triple>,
}

/// What is left of the conditions [m/s].
#[derive(Debug, Clone, Copy, Default)]
struct Left {
    residual: f64,
    /// Largest E (p − p⁰) of a rigid contact.
    drawn: f64,
    /// Sum of the products λ s, and their number.
    products: f64,
    number: usize,
}

impl Left {
    fn mean(&self) -> f64 {
        self.products / self.number.max(1) as f64
    }
}

/// What an iterate is looked at for.
#[derive(Debug, Clone, Copy)]
enum Method {
    /// Interior points, after this share of their last direction.
    Inside { share: f64 },
    /// Newton's method on the laws; whether the last direction tells which bounds hold.
    AtBounds { led: bool },
}

/// What a direction comes to.
#[derive(Debug, Clone, Copy)]
struct Course {
    /// How far it may be gone, 1 at most.
    share: f64,
    /// Growth of the products with the share and its square.
    growth: [f64; 2],
}

impl Course {
    const BEGIN: Course = Course { share: 1.0, growth: [0.0; 2] };

    /// Takes a point's part of the direction up, which is gone `keep` of the way to the boundary at most.
    #[inline(always)]
    fn meet<const N: usize>(&mut self, point: &Point<N>, way: &Way<N>, keep: f64) {
        for i in 0..N {
            if point.on[i] {
                let (s, l, ds, dl) = (point.s[i], point.lambda[i], way.s[i], way.lambda[i]);
                // Most bounds are farther off than the nearest so far: only those that are not are divided by.
                if ds * self.share < -keep * s {
                    self.share = -keep * s / ds;
                }
                if dl * self.share < -keep * l {
                    self.share = -keep * l / dl;
                }
                self.growth[0] += s * dl + l * ds;
                self.growth[1] += ds * dl;
            }
        }
    }
}

/// Whether [`Interior::solve`] knows what a contact does.
pub(crate) fn fits(contact: &Contact) -> bool {
    contact.moved[0].is_finite()
}

impl Interior {
    /// Solves a step to `tolerance` [m/s], or for as long as that gets nearer to it from `enough` [m/s] on; `v` holds a guess on entry.
    pub(crate) fn solve(
        &mut self,
        matrix: &mut Blocks,
        (mass, free): (&[Triple], &[Triple]),
        contacts: &mut [Contact],
        v: &mut [Triple],
        (tolerance, enough): (f64, f64),
    ) -> Effort {
        self.start(mass, free, contacts, v, tolerance);
        let mut effort = Effort { rounds: 1, ..Effort::default() };
        let (mut least, mut since) = (f64::INFINITY, 0);
        // Share of the last direction that is gone.
        let (mut share, mut stuck) = (0.0, false);
        let mut near = if finish::may_end(contacts) { finish::NEAR * tolerance } else { 0.0 };
        // Half of the digits do for directions while they lead on: what is off by them is seen in the next look. Newton's method ends with all.
        let mut digits = if near > 0.0 && is_yielding(contacts) { Digits::Half } else { Digits::All };
        // What was left at the start, until it began anew.
        let mut begun = None;
        loop {
            let mut left = self.look(matrix, (mass, free), contacts, v, Method::Inside { share });
            effort.residual = worse(left.residual, left.drawn);
            if left.residual <= tolerance {
                if left.drawn <= tolerance {
                    effort.converged = true;
                    break;
                }
                self.usual.anchor(contacts);
                self.limited.anchor(contacts);
                effort.rounds += 1;
                share = 0.0;
                continue;
            }
            (least, since) = if effort.residual <= 0.5 * least { (effort.residual, 0) } else { (least, since + 1) };
            if effort.iterations == 0 {
                begun = Some(left.residual);
            }
            if since >= ANEW {
                digits = Digits::All;
            }
            let stays = since >= if effort.residual <= enough { PATIENCE } else { STALLED };
            if effort.iterations >= MOST || stays || !left.residual.is_finite() {
                break;
            }
            if let Some(begun) = begun.take_if(|_| since >= ANEW && effort.residual > enough) {
                self.usual.enter(contacts, v, NEARER * begun);
                self.limited.enter(contacts, v, NEARER * begun);
                // A last direction that was hardly gone leaves `stuck`: the first from here evens products out.
                (share, least, since) = (0.0, f64::INFINITY, 0);
                continue;
            }
            if left.residual <= near {
                let end = self.finish(matrix, (mass, free), contacts, v, tolerance, share > 0.0);
                effort.iterations += end.iterations;
                effort.rounds += end.rounds;
                if end.converged {
                    (effort.residual, effort.converged) = (end.residual, true);
                    break;
                }
                (near, digits) = (finish::AGAIN * left.residual, Digits::All);
                left = self.look(matrix, (mass, free), contacts, v, Method::Inside { share: 0.0 });
            }
            effort.iterations += 1;
            share = self.direct(matrix, digits, &left, stuck);
            // Where products vanish before the conditions hold, rounding ends in nothing over nothing.
            if !self.step.iter().flatten().all(|x| x.is_finite()) {
                if digits == Digits::All {
                    break;
                }
                self.usual.ways.fill(Way::NONE);
                self.limited.ways.fill(Way::NONE);
                (share, digits) = (0.0, Digits::All);
                continue;
            }
            stuck = share < STUCK;
            for (v, step) in v.iter_mut().zip(&self.step) {
                (0..3).for_each(|k| v[k] += share * step[k]);
            }
        }
        effort.factorisations = effort.iterations;
        self.usual.tell(contacts, v);
        self.limited.tell(contacts, v);
        effort
    }

    /// Within the bounds, near what was borne before: as far from them as that is off balance.
    fn start(&mut self, mass: &[Triple], free: &[Triple], contacts: &[Contact], v: &[Triple], tolerance: f64) {
        let [push, rise] = &mut self.pushes;
        for room in [&mut self.residual, &mut self.step, &mut self.work, push, rise] {
            room.resize(v.len(), [0.0; 3]);
        }
        self.usual.clear();
        self.limited.clear();
        inertia(&mut self.residual, mass, free, v);
        for (number, contact) in contacts.iter().enumerate() {
            let u = contact.velocity(v);
            let p = match contact.pressure[1] == f64::INFINITY {
                true => self.usual.add(number, contact, u),
                false => self.limited.add(number, contact, u),
            };
            contact.push(&mut self.residual, contact.whole(p, u));
        }
        let scale = unbalance(&self.residual, mass).max(tolerance);
        self.usual.enter(contacts, v, scale);
        self.limited.enter(contacts, v, scale);
    }

    /// What is left of (P1), into `self.residual`, and of the laws, and the matrix and the right side, into `self.step`, of a direction that would
    /// leave nothing: all in one go through the contacts, which are most of what has to be fetched.
    fn look(
        &mut self,
        matrix: &mut Blocks,
        (mass, free): (&[Triple], &[Triple]),
        contacts: &[Contact],
        v: &[Triple],
        method: Method,
    ) -> Left {
        inertia(&mut self.residual, mass, free, v);
        self.step.fill([0.0; 3]);
        matrix.reset_whole(mass);
        let mut sums = Sums { left: Left::default(), residual: &mut self.residual, step: &mut self.step, matrix };
        self.usual.look(contacts, v, method, &mut sums);
        self.limited.look(contacts, v, method, &mut sums);
        let mut left = sums.left;
        left.residual = worse(left.residual, unbalance(&self.residual, mass));
        left
    }

    /// The direction, into `self.step` and the points, and how far it is gone; `stuck` where the last was hardly gone at all.
    fn direct(&mut self, matrix: &mut Blocks, digits: Digits, left: &Left, stuck: bool) -> f64 {
        let mean = left.mean();
        self.begin_right_side();
        matrix.factorise_and_solve(&mut self.step, &mut self.work, digits);
        let mut first = Course::BEGIN;
        self.pushes.iter_mut().for_each(|push| push.fill([0.0; 3]));
        self.usual.predict(&self.step, &mut self.pushes, &mut first);
        self.limited.predict(&self.step, &mut self.pushes, &mut first);
        let after = left.products + first.share * (first.growth[0] + first.share * first.growth[1]);
        let after = after / left.number.max(1) as f64;
        // Rounding takes products of nothing below 0.
        let falls = if mean > 0.0 { (mean * (after / mean).powi(3)).max(0.0) } else { 0.0 };
        let target = if stuck { mean } else { falls };
        let [push, rise] = &self.pushes;
        for (step, (push, rise)) in self.step.iter_mut().zip(push.iter().zip(rise)) {
            *step = std::array::from_fn(|k| push[k] + target * rise[k]);
        }
        self.begin_right_side();
        matrix.solve(&mut self.step, &mut self.work);
        let mut course = Course::BEGIN;
        self.usual.turn(&self.step, target, &mut course);
        self.limited.turn(&self.step, target, &mut course);
        course.share
    }

    /// Takes what is out of balance from what the contacts push, `self.step`: the right side for the change of the velocities.
    fn begin_right_side(&mut self) {
        for (step, residual) in self.step.iter_mut().zip(&self.residual) {
            (0..3).for_each(|k| step[k] -= residual[k]);
        }
    }
}

/// What a look at the contacts adds up.
struct Sums<'a> {
    left: Left,
    residual: &'a mut [Triple],
    step: &'a mut [Triple],
    matrix: &'a mut Blocks,
}

impl<const N: usize> Group<N> {
    fn clear(&mut self) {
        self.which.clear();
        self.rows.clear();
        self.points.clear();
        self.views.clear();
        self.second.clear();
        self.ways.clear();
    }

    /// Another contact; what it is taken to bear.
    fn add(&mut self, number: usize, contact: &Contact, u: [f64; 2]) -> [f64; 2] {
        let point = Point::lay(contact, u);
        self.which.push(number as u32);
        self.rows.push(contact.rows);
        self.points.push(point);
        self.views.push(View::NONE);
        self.second.push([0.0; N]);
        self.ways.push(Way::NONE);
        point.p
    }

    fn enter(&mut self, contacts: &[Contact], v: &[Triple], scale: f64) {
        for (point, which) in self.points.iter_mut().zip(&self.which) {
            let contact = &contacts[*which as usize];
            point.enter(contact, contact.velocity(v), scale);
        }
    }

    fn look(&mut self, contacts: &[Contact], v: &[Triple], method: Method, sums: &mut Sums) {
        Arch::new().dispatch(Look { group: self, contacts, v, method, sums });
    }

    #[inline(always)]
    fn look_at_each(&mut self, contacts: &[Contact], v: &[Triple], method: Method, sums: &mut Sums) {
        let each = self.points.iter_mut().zip(&mut self.views).zip(&mut self.ways).zip(&self.which);
        for (((point, view), way), which) in each {
            let contact = &contacts[*which as usize];
            let u = contact.velocity(v);
            match method {
                Method::Inside { share } => {
                    point.go(share, way);
                    point.look(contact, u, (view, way), &mut sums.left);
                    point.invert(view);
                    view.right = point.aim(view, 0.0, &[0.0; N]);
                }
                Method::AtBounds { led } => point.choose(contact, u, led.then_some(way), view, &mut sums.left),
            }
            contact.push(sums.residual, contact.whole(point.p, u));
            contact.couple(sums.matrix, view.answers(contact));
            contact.rows.push(sums.step, view.right);
        }
    }

    /// Where a direction of velocities to products of 0 would lead, and what the contacts push with in the next direction.
    fn predict(&mut self, step: &[Triple], pushes: &mut [Vec<Triple>; 2], course: &mut Course) {
        Arch::new().dispatch(Predict { group: self, step, pushes, course });
    }

    #[inline(always)]
    fn predict_each(&mut self, step: &[Triple], [push, rise]: &mut [Vec<Triple>; 2], course: &mut Course) {
        let each = self.points.iter().zip(&self.views).zip(&mut self.second).zip(&self.rows);
        for (((point, view), second), rows) in each {
            let way = point.way(view, rows.change(step), view.right, 0.0, &[0.0; N]);
            course.meet(point, &way, 1.0);
            *second = std::array::from_fn(|i| way.s[i] * way.lambda[i]);
            rows.push(push, point.aim(view, 0.0, second));
            rows.push(rise, point.rise(view));
        }
    }

    /// The direction of velocities `step`, to products of `target`, and how far it may be gone.
    fn turn(&mut self, step: &[Triple], target: f64, course: &mut Course) {
        Arch::new().dispatch(Turn { group: self, step, target, course });
    }

    #[inline(always)]
    fn turn_each(&mut self, step: &[Triple], target: f64, course: &mut Course) {
        let each = self.points.iter().zip(&self.views).zip(&self.second).zip(&mut self.ways).zip(&self.rows);
        for ((((point, view), second), way), rows) in each {
            let right = point.aim(view, target, second);
            *way = point.way(view, rows.change(step), right, target, second);
            course.meet(point, way, INSIDE);
        }
    }

    /// Draws rigid contacts to what they bear now.
    fn anchor(&mut self, contacts: &[Contact]) {
        for (point, which) in self.points.iter_mut().zip(&self.which) {
            let contact = &contacts[*which as usize];
            (0..2).filter(|k| !contact.compliant[*k]).for_each(|k| point.anchor[k] = point.p[k]);
        }
    }

    fn tell(&self, contacts: &mut [Contact], v: &[Triple]) {
        for (point, which) in self.points.iter().zip(&self.which) {
            point.tell(&mut contacts[*which as usize], v);
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
    target: f64,
    course: &'a mut Course,
}

impl<const N: usize> WithSimd for Turn<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.group.turn_each(self.step, self.target, self.course);
    }
}

/// Whether each contact, with what acts beside it, is so soft beside the mass that it moves that half of the digits tell a direction.
fn is_yielding(contacts: &[Contact]) -> bool {
    let stiffest = |c: &Contact, k: usize| {
        let bears = k == 0 || c.friction > 0.0 || c.hold > 0.0;
        c.spring[k].rho + if bears { 1.0 / soft(c, k) } else { 0.0 }
    };
    let yields = |c: &Contact, k: usize| !c.moved[k].is_finite() || stiffest(c, k) <= YIELDING * c.moved[k];
    contacts.iter().all(|c| yields(c, 0) && yields(c, 1))
}

/// Whether friction follows from pressure alone.
fn is_dry(contact: &Contact) -> bool {
    let alone = contact.pressure[0] == 0.0 && contact.hold == 0.0 && contact.spring[0] == Default::default();
    alone && contact.friction > 0.0 && !is_fixed(contact) && contact.moved[1].is_finite()
}

/// Whether what presses stays whatever moves.
fn is_fixed(contact: &Contact) -> bool {
    contact.compliant[0] && contact.law[0].rho == 0.0
}

/// E of a contact across or along.
fn soft(contact: &Contact, k: usize) -> f64 {
    1.0 / (contact.law[k].rho * if contact.compliant[k] { 1.0 } else { FIRM })
}

impl<const N: usize> Point<N> {
    /// What it bore before, within its bounds.
    fn lay(contact: &Contact, u: [f64; 2]) -> Self {
        let [least, most] = contact.pressure;
        let fixed = is_fixed(contact);
        let p_n = if fixed { contact.law[0].offset } else { contact.impulse[0] }.clamp(least, most);
        let bound = contact.bound(p_n, u[0]);
        let p = [p_n, contact.impulse[1].clamp(-bound, bound)];
        let rubs = (contact.friction > 0.0 || contact.hold > 0.0) && contact.moved[1].is_finite();
        let moves = [!fixed, rubs && (bound > 0.0 || is_dry(contact))];
        let bounds = [moves[1], moves[1], !fixed && least.is_finite(), !fixed && most.is_finite()];
        Point {
            s: [0.0; N],
            lambda: [0.0; N],
            soft: [0, 1].map(|k| if moves[k] { soft(contact, k) } else { 0.0 }),
            mass: contact.moved[0],
            rho: contact.spring[0].rho,
            p,
            anchor: [0, 1].map(|k| if contact.compliant[k] { contact.law[k].offset } else { p[k] }),
            moves,
            rubs,
            dry: is_dry(contact),
            on: std::array::from_fn(|i| bounds[i]),
        }
    }

    /// Impulses, distances and multipliers at the start, where velocities are out of balance by `scale` [m/s]: so far from
    /// the bounds that bearing or not stays open.
    fn enter(&mut self, contact: &Contact, u: [f64; 2], scale: f64) {
        let floor = FLOOR * contact.moved[0] * scale + SHARE * self.p[0].abs();
        let [least, most] = contact.pressure;
        let inside = floor.min(0.5 * (most - least));
        if self.on[2] {
            self.p[0] = self.p[0].max(least + inside);
        }
        if N > 3 && self.on[3] {
            self.p[0] = self.p[0].min(most - inside);
        }
        let bound = contact.bound(self.p[0], u[0]);
        let room = (bound - floor.min(0.5 * bound)).max(0.0);
        self.p[1] = self.p[1].clamp(-room, room);
        let (far, wanted) = (self.far(contact, bound), self.wanted(contact, u));
        for i in 0..N {
            self.s[i] = far[i].max(floor);
            self.lambda[i] = wanted[i].max(CRACK * FLOOR * scale * floor / self.s[i]);
        }
    }

    /// Distances from the bounds by the impulses.
    #[inline(always)]
    fn far(&self, contact: &Contact, bound: f64) -> [f64; N] {
        let ([p_n, p_t], [least, most]) = (self.p, contact.pressure);
        let far = [bound - p_t, bound + p_t, p_n - least, most - p_n];
        std::array::from_fn(|i| far[i])
    }

    /// Multipliers by the velocities, each as if its bound alone held.
    fn wanted(&self, contact: &Contact, u: [f64; 2]) -> [f64; N] {
        let pulls = [u[0] + contact.bias + self.shift(0), u[1] + self.shift(1)];
        std::array::from_fn(|i| SENSE[i] * pulls[DIRECTION[i]])
    }

    #[inline(always)]
    fn go(&mut self, share: f64, way: &Way<N>) {
        (0..2).for_each(|k| self.p[k] += share * way.p[k]);
        for i in 0..N {
            self.s[i] += share * way.s[i];
            self.lambda[i] += share * way.lambda[i];
        }
    }

    /// E (p − p⁰).
    #[inline(always)]
    fn shift(&self, k: usize) -> f64 {
        self.soft[k] * (self.p[k] - self.anchor[k])
    }

    /// By how much it is off at the velocity `u`.
    #[inline(always)]
    fn look(&mut self, contact: &Contact, u: [f64; 2], (view, way): (&mut View<N>, &mut Way<N>), left: &mut Left) {
        let beside = contact.spring[0].at(u[0]);
        view.mu = if self.dry || self.tends(contact, u[0]) + beside > 0.0 { contact.friction } else { 0.0 };
        let bound = (view.mu * (self.p[0] + beside)).max(0.0) + contact.hold;
        if !self.dry && self.rubs {
            self.grip(bound, contact, way);
            view.mu = if self.moves[1] { view.mu } else { 0.0 };
        }
        let shift = [self.shift(0), self.shift(1)];
        let far = self.far(contact, bound);
        let rounded = ROUNDED * (self.p[0].abs() + self.p[1].abs() + bound.abs());
        view.off = [u[0] + contact.bias + shift[0], u[1] + shift[1]];
        for i in 0..N {
            if !self.on[i] {
                view.astray[i] = 0.0;
                continue;
            }
            let (s, l) = (self.s[i], self.lambda[i]);
            let astray = far[i] - s;
            // What is no number stays one, to be seen.
            view.astray[i] = if astray.abs() <= rounded { 0.0 } else { astray };
            view.off[DIRECTION[i]] -= SENSE[i] * l;
            left.residual = worse(worse(left.residual, view.astray[i].abs() / self.mass), (s / self.mass).min(l));
            left.products += s * l;
            left.number += 1;
        }
        for k in 0..2 {
            if !self.moves[k] {
                view.off[k] = 0.0;
            }
            left.residual = worse(left.residual, view.off[k].abs());
            if !contact.compliant[k] {
                left.drawn = left.drawn.max(shift[k].abs());
            }
        }
    }

    /// What p_n would be without friction, whose bounds would not let the whole pass from pressure to tension.
    #[inline(always)]
    fn tends(&self, contact: &Contact, u_n: f64) -> f64 {
        let [least, most] = contact.pressure;
        let free = match contact.compliant[0] {
            true => contact.law[0].at(u_n + contact.bias),
            false => self.p[0] - self.mass * (u_n + contact.bias),
        };
        free.clamp(least, most)
    }

    /// Friction that may bear nothing is left out until it may bear something again.
    fn grip(&mut self, bound: f64, contact: &Contact, way: &mut Way<N>) {
        let grips = bound > 0.0;
        if self.moves[1] && !grips {
            self.p[1] = 0.0;
        } else if !self.moves[1] && grips {
            for i in 0..2 {
                self.s[i] = bound;
                self.lambda[i] = GRIP * bound / contact.moved[1];
                (way.s[i], way.lambda[i]) = (0.0, 0.0);
            }
            self.anchor[1] = if contact.compliant[1] { contact.law[1].offset } else { 0.0 };
            self.soft[1] = soft(contact, 1);
        }
        (self.moves[1], self.on[0], self.on[1]) = (grips, grips, grips);
    }

    #[inline(always)]
    fn invert(&self, view: &mut View<N>) {
        view.near = std::array::from_fn(|i| if self.on[i] { 1.0 / self.s[i] } else { 0.0 });
        let d: [f64; N] = std::array::from_fn(|i| self.lambda[i] * view.near[i]);
        let across = self.soft[0] + d[2] + if N > 3 { d[3] } else { 0.0 };
        let along = self.soft[1] + d[0] + d[1];
        let [across, along] = [across, along].map(|k| 1.0 / k);
        let across = if self.moves[0] { across } else { 0.0 };
        let along = if self.moves[1] { along } else { 0.0 };
        view.response = [across, along, view.mu * (d[1] - d[0]) * along];
    }

    /// Impulses for products of `target` where velocities stay.
    #[inline(always)]
    fn aim(&self, view: &View<N>, target: f64, second: &[f64; N]) -> [f64; 2] {
        let mut off = view.off.map(|o| -o);
        for i in 0..N {
            if self.on[i] {
                let l = self.lambda[i];
                off[DIRECTION[i]] += SENSE[i] * ((target - second[i] - l * view.astray[i]) * view.near[i] - l);
            }
        }
        view.answer(off)
    }

    /// What each unit of the products adds to them.
    #[inline(always)]
    fn rise(&self, view: &View<N>) -> [f64; 2] {
        let mut off = [0.0; 2];
        for i in 0..N {
            off[DIRECTION[i]] += SENSE[i] * view.near[i];
        }
        view.answer(off)
    }

    /// Change of the impulses where velocities change by `du`, and otherwise by `right`.
    #[inline(always)]
    fn follows(&self, view: &View<N>, du: [f64; 2], right: [f64; 2]) -> [f64; 2] {
        let [across, along, tilt] = view.response;
        let (d_n, d_t) = (-across * du[0], -along * du[1]);
        [right[0] + d_n, right[1] + d_t - tilt * (d_n - self.rho * du[0])]
    }

    /// The direction where velocities change by `du`, to products of `target` that have a second-order part.
    #[inline(always)]
    fn way(&self, view: &View<N>, du: [f64; 2], right: [f64; 2], target: f64, second: &[f64; N]) -> Way<N> {
        let d_p = self.follows(view, du, right);
        let bound = view.mu * (d_p[0] - self.rho * du[0]);
        let far = [bound - d_p[1], bound + d_p[1], d_p[0], -d_p[0]];
        let far: [f64; N] = std::array::from_fn(|i| far[i] + view.astray[i]);
        let mut dl: [f64; N] = std::array::from_fn(|i| match self.on[i] {
            true => (target - second[i] - self.lambda[i] * far[i]) * view.near[i] - self.lambda[i],
            false => 0.0,
        });
        // (P5a) is linear: what rounding leaves of it goes to the multipliers, most to the largest.
        for k in 0..2 {
            let own = (0..N).filter(|i| DIRECTION[*i] == k && self.on[*i]);
            let mut left = du[k] + self.soft[k] * d_p[k] + view.off[k];
            let mut weight = 0.0;
            for i in own.clone() {
                left -= SENSE[i] * dl[i];
                weight += self.lambda[i] * self.lambda[i];
            }
            if weight > 0.0 && self.moves[k] {
                own.for_each(|i| dl[i] += SENSE[i] * left * self.lambda[i].powi(2) / weight);
            }
        }
        // What bears at a bound lies at it to rounding: distances follow from the products there.
        let ds = std::array::from_fn(|i| {
            let (s, l) = (self.s[i], self.lambda[i]);
            match self.on[i] {
                true if s < self.mass * l => (target - second[i] - s * dl[i]) / l - s,
                true => far[i],
                false => 0.0,
            }
        });
        Way { p: d_p, s: ds, lambda: dl }
    }

    /// Impulses and what they mean.
    fn tell(&self, contact: &mut Contact, v: &[Triple]) {
        let held: [bool; N] = std::array::from_fn(|i| self.on[i] && self.s[i] <= self.mass * self.lambda[i]);
        let [least, most] = contact.pressure;
        let p_n = match held[2..] {
            [true, ..] => least,
            [_, true] => most,
            _ => self.p[0].clamp(least, most),
        };
        let bound = contact.bound(p_n, contact.velocity(v)[0]);
        let p_t = if self.moves[1] { self.p[1].clamp(-bound, bound) } else { 0.0 };
        (contact.impulse, contact.status) = match [held[0], held[1]] {
            _ if p_n == 0.0 && !(bound > 0.0) => ([0.0; 2], Status::Open),
            [true, false] => ([p_n, p_t], Status::Forth),
            [false, true] => ([p_n, p_t], Status::Back),
            _ => ([p_n, p_t], Status::Stick),
        };
        for k in 0..2 {
            if !contact.compliant[k] {
                contact.law[k].offset = contact.impulse[k];
            }
        }
    }
}

pub(crate) fn inertia(residual: &mut [Triple], mass: &[Triple], free: &[Triple], v: &[Triple]) {
    for (body, r) in residual.iter_mut().enumerate() {
        (0..3).for_each(|k| r[k] = mass[body][k] * (v[body][k] - free[body][k]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Linear;
    use crate::order::Orders;

    /// Numbers from −1 to 1.
    struct Draw(u64);

    impl Draw {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 33) as f64 / (1u64 << 30) as f64 - 1.0
        }

        fn of(&mut self, low: f64, high: f64) -> f64 {
            low + (high - low) * 0.5 * (self.next() + 1.0)
        }
    }

    const MASS: Triple = [2.0, 2.0, 0.3];

    /// Half of the digits are for springs that are not too stiff, wherever they stand.
    #[test]
    fn stiff_contacts_take_all_digits() {
        let matrix = Blocks::new(6, &(1..6).map(|b| (b - 1, b)).collect::<Vec<_>>(), &Orders::anywhere());
        let contacts = contacts(&mut Draw(1), &matrix, 1.0);
        assert!(is_yielding(&contacts));
        let stiffer: [fn(&mut Contact); 4] = [
            |c| c.compliant[0] = false,
            |c| (c.compliant[1], c.friction) = (false, 0.5),
            |c| c.law[0].rho = 1e6 * c.moved[0],
            |c| c.spring[1].rho = 1e6 * c.moved[1],
        ];
        for stiffen in stiffer {
            let mut contacts = contacts.clone();
            stiffen(&mut contacts[3]);
            assert!(!is_yielding(&contacts));
        }
    }

    /// Contacts of six bodies in a row and of each with the base, of every kind: rigid and springs, with bounds of tension and crushing,
    /// what friction bears beside pressure, springs and dashpots beside, none across, none along; this share of them with springs.
    fn contacts(draw: &mut Draw, matrix: &Blocks, springs: f64) -> Vec<Contact> {
        let inverse = vec![MASS.map(|m| 1.0 / m); 6];
        let mut contacts = Vec::new();
        for b in 0..6usize {
            for a in [None, b.checked_sub(1)] {
                let (mut n, mut t) = ([draw.next(), draw.next()], [0.0; 2]);
                let length = n[0].hypot(n[1]);
                n = n.map(|x| x / length);
                (t[0], t[1]) = (-n[1], n[0]);
                let row = |d: [f64; 2], sign: f64, arm: f64| [sign * d[0], sign * d[1], arm];
                let arms = [draw.next(), draw.next(), draw.next(), draw.next()].map(|x| 0.3 * x);
                let rows =
                    [[row(n, -1.0, arms[0]), row(n, 1.0, arms[1])], [row(t, -1.0, arms[2]), row(t, 1.0, arms[3])]];
                if a.is_none() && b > 0 && draw.next() > 0.0 {
                    continue;
                }
                let slot = a.map(|a| matrix.slot(a, b));
                let mut c = Contact::rigid((a, b), slot, rows, &inverse, [draw.of(0.0, 2.0), draw.of(-0.5, 0.5)]);
                let kind = |draw: &mut Draw, odds: f64| draw.of(0.0, 1.0) < odds;
                let steep = if kind(draw, 0.1) { 4.0 } else { 0.8 };
                c.friction = if kind(draw, 0.8) { draw.of(0.05, steep) } else { 0.0 };
                c.bias = if kind(draw, 0.3) { draw.of(-0.3, 0.3) } else { 0.0 };
                if kind(draw, 0.3) {
                    c.hold = draw.of(0.0, 1.0);
                }
                if kind(draw, 0.3) {
                    c.pressure[0] = -draw.of(0.0, 1.0);
                }
                if kind(draw, 0.3) {
                    c.pressure[1] = draw.of(0.1, 2.0);
                }
                if kind(draw, 0.05) {
                    c.pressure[0] = f64::NEG_INFINITY;
                }
                for k in 0..2 {
                    if kind(draw, springs) {
                        c.compliant[k] = true;
                        c.law[k] = Linear { offset: draw.of(-0.3, 1.0), rho: c.moved[k] * draw.of(0.1, 50.0) };
                    }
                }
                for k in 0..2 {
                    if kind(draw, 0.2) {
                        c.spring[k] = Linear { offset: draw.of(-0.5, 0.5), rho: c.moved[k] * draw.of(0.1, 5.0) };
                    }
                }
                if kind(draw, 0.1) {
                    // Nothing presses but the spring beside.
                    (c.compliant[0], c.law[0]) = (true, Linear::default());
                    c.pressure = [0.0, f64::INFINITY];
                }
                contacts.push(c);
            }
        }
        contacts
    }

    /// What a solution leaves of (P1) to (P4), looked up in the laws themselves [m/s].
    fn left(contacts: &[Contact], v: &[Triple], free: &[Triple]) -> f64 {
        let mut balance: Vec<Triple> =
            (0..6).map(|body| [0, 1, 2].map(|k| MASS[k] * (v[body][k] - free[body][k]))).collect();
        let mut worst: f64 = 0.0;
        for c in contacts {
            let u = c.velocity(v);
            c.push(&mut balance, c.whole(c.impulse, u));
            let law = |k: usize| match c.compliant[k] {
                true => c.law[k],
                false => Linear { offset: c.impulse[k], rho: c.moved[k] },
            };
            let at = |k: usize, u: f64| law(k).offset - law(k).rho * u;
            let bound = c.bound(c.impulse[0], u[0]);
            let wanted = [at(0, u[0] + c.bias).clamp(c.pressure[0], c.pressure[1]), at(1, u[1]).clamp(-bound, bound)];
            for k in 0..2 {
                let over = if c.compliant[k] { c.law[k].rho.max(c.moved[k]) } else { c.moved[k] };
                worst = worse(worst, (wanted[k] - c.impulse[k]).abs() / over);
            }
        }
        worse(worst, unbalance(&balance, &[MASS; 6]))
    }

    /// Whatever bounds contacts have, what is called solved obeys their laws; nearly all is solved. Where all have springs Newton's method
    /// ends it, to rounding.
    #[test]
    fn every_kind_of_contact_obeys_its_laws() {
        let pairs: Vec<_> = (1..6).map(|b| (b - 1, b)).collect();
        let mut matrix = Blocks::new(6, &pairs, &Orders::anywhere());
        let mut interior = Interior::default();
        for springs in [0.4, 0.97, 1.0] {
            let (mut solved, mut to_rounding) = (0, 0);
            for seed in 0..500 {
                let mut draw = Draw(seed);
                let mut contacts = contacts(&mut draw, &matrix, springs);
                let free: Vec<Triple> = (0..6).map(|_| [draw.next(), draw.next(), draw.next()]).collect();
                let mut v = vec![[0.0; 3]; 6];
                let effort = interior.solve(&mut matrix, (&[MASS; 6], &free), &mut contacts, &mut v, (1e-6, 1e-6));
                let left = left(&contacts, &v, &free);
                if effort.converged {
                    solved += 1;
                    to_rounding += usize::from(left < 1e-12);
                    assert!(left < 1e-5, "seed {seed}: {left:e} {effort:?}");
                }
            }
            // Contacts that point anywhere may have no solution.
            assert!(solved > 475, "{solved}");
            assert!(springs < 1.0 || to_rounding > 450, "{to_rounding}");
        }
    }
}
