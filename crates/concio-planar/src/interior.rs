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
//! of [`crate::contact`] with what friction answers to pressure in each contact. It is factorised once per iteration, in 32 bits, as most contacts are
//! kept too, where none is too stiff for that, and used for a prediction and a correction (Mehrotra 1992). However many contacts open and close, that takes
//! about a dozen iterations. Where nearly all contacts have springs, Newton's method on the laws themselves (`interior/finish.rs`) does the last few of them,
//! and is tried first, from what contacts did in the last step: where most go on to do that, as in slow pushes, it needs about four in all.

mod finish;
mod group;
mod inside;
mod lanes;
mod lever;
mod packs;
mod point;

use crate::blocks::{Blocks, Digits, Triple};
use crate::contact::{Contact, Effort, Linear, Status, unbalance, worse};
use group::Group;
use lanes::PACK;
use packs::{Packs, is_plain};
use point::{Course, Left, soft};

/// Iterations after which a step is given up.
const MOST: usize = 60;
/// 1/E over ρ of a rigid contact: more leaves what head joints bear to chance instead of to what they bore before, less
/// gives way by more than the tolerance.
const FIRM: f64 = 1e4;
/// Iterations in which what is left has to be halved: once it is small enough, and before, and before where the step is taken in two halves if it
/// is not solved.
const PATIENCE: usize = 8;
const STALLED: usize = 25;
const STALLED_SHORT: usize = 12;
/// Iterations that have not halved what is left after which it begins anew, from where it came to, and for what is out of balance then the
/// share of what was left at first: bounds it came too near to on its way keep the way short, and there are steps that it never ends otherwise.
const ANEW: usize = 4;
const NEARER: f64 = 0.01;
/// How often it does so where nearly all contacts have springs, and elsewhere, where more costs more than it solves.
const TIMES: usize = 2;
const TIMES_RIGID: usize = 1;
/// Largest 1/E, with springs beside, over the mass that a contact moves where half of the digits tell directions, which are off by some 6·10⁻⁸
/// of that.
const YIELDING: f64 = 1e5;
/// The same where they also keep what is left of a matrix when contacts let go: some 6·10⁻⁸ of what those were.
const KEEPING: f64 = 1e4;
/// Least distance from the bounds at the start, over what is out of balance, and over what was borne before.
const FLOOR: f64 = 1.0;
const SHARE: f64 = 0.02;
/// Least multiplier at the start, over what is out of balance, and that of friction that begins to bear, over its bound by the mass.
const CRACK: f64 = 0.5;
const GRIP: f64 = 0.01;
/// Share of rigid contacts from which on Newton's method does not end a step.
const RIGID: f64 = 0.1;
/// Share of the way to the boundary that is gone.
const INSIDE: f64 = 0.995;
/// Share of the way after which products are evened out instead of reduced.
const STUCK: f64 = 0.03;

/// Room for the solution.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interior {
    /// Contacts that are springs alone, which no bound meets.
    springs: Vec<u32>,
    /// Most others, in packs; others without and with a largest p_n.
    plain: Packs,
    usual: Group<3>,
    limited: Group<4>,
    residual: Vec<Triple>,
    step: Vec<Triple>,
    /// The last direction of Newton's method.
    gone: Vec<Triple>,
    work: Vec<Triple>,
    /// What contacts push with where velocities stay and second-order parts of the products are taken off: to products of 0, and
    /// what each unit of the products adds.
    pushes: [Vec<Triple>; 2],
    /// Velocities at the start, and before an attempt to end.
    guess: Vec<Triple>,
    before: Vec<Triple>,
}

/// What is left of all conditions [m/s].
#[derive(Debug, Clone, Copy)]
struct Whole {
    residual: f64,
    drawn: f64,
    products: f64,
    number: usize,
    /// Contacts that do something else than in the last look by Newton's method, in such a look.
    changed: usize,
}

impl Whole {
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
    /// The same from the iterate after; the matrix is begun anew (`whole`), or changes where contacts changed what they do.
    Onwards { whole: bool },
}

impl Method {
    fn begins_matrix(self) -> bool {
        !matches!(self, Method::Onwards { whole: false })
    }
}

/// What contacts are like, for how a step is solved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Survey {
    number: usize,
    /// Whether [`Interior::solve`] knows what all of them do, and whether none bore anything.
    pub fits: bool,
    pub new: bool,
    /// The largest of [`stiffness`].
    stiffest: f64,
    /// How many are rigid, and how many are of the most frequent kind.
    rigid: usize,
    plain: usize,
}

impl Default for Survey {
    fn default() -> Self {
        Survey { number: 0, fits: true, new: true, stiffest: 0.0, rigid: 0, plain: 0 }
    }
}

impl Survey {
    /// Another contact.
    pub fn see(&mut self, contact: &Contact) {
        self.number += 1;
        self.fits &= contact.moved[0].is_finite();
        self.new &= contact.impulse == [0.0; 2];
        self.stiffest = worse(self.stiffest, worse(stiffness(contact, 0), stiffness(contact, 1)));
        let rubs = contact.friction > 0.0 || contact.hold > 0.0;
        self.rigid += usize::from(!contact.compliant[0] || (!contact.compliant[1] && rubs));
        self.plain += usize::from(is_plain(contact));
    }

    /// Whether so few contacts are rigid that impulses follow from velocities, and Newton's method ends a step.
    pub fn may_end(&self) -> bool {
        (self.rigid as f64) < RIGID * self.number as f64
    }

    /// Whether half of the digits tell directions.
    fn yields(&self) -> bool {
        self.stiffest <= YIELDING
    }

    /// Whether they also keep what is left of a matrix that changes by differences.
    fn keeps(&self) -> bool {
        self.stiffest <= KEEPING
    }
}

impl Interior {
    /// Solves a step to `tolerance` [m/s], or for as long as that gets nearer to it from `enough` [m/s] on; `v` holds a guess on entry. What `halves`
    /// is left sooner where it stalls.
    pub(crate) fn solve(
        &mut self,
        matrix: &mut Blocks,
        (mass, free): (&[Triple], &[Triple]),
        (contacts, survey): (&mut [Contact], &Survey),
        v: &mut [Triple],
        (tolerance, enough): (f64, f64),
        halves: bool,
    ) -> Effort {
        let mut near = if survey.may_end() { finish::NEAR * tolerance } else { 0.0 };
        // Half of the digits do for directions while they lead on: what is off by them is seen in the next look.
        let mut digits = if near > 0.0 && survey.yields() { Digits::Half } else { Digits::All };
        self.guess.clear();
        self.guess.extend_from_slice(v);
        let scale = self.gather((mass, free), (contacts, survey), v, (tolerance, digits));
        let mut effort = Effort { rounds: 1, ..Effort::default() };
        // Contacts mostly go on to do what they did.
        if near > 0.0 && !survey.new {
            let end = self.finish(matrix, (mass, free), contacts, v, (tolerance, digits), (false, survey.keeps()));
            effort = effort.then(Effort { residual: f64::INFINITY, ..end });
            if end.converged {
                (effort.residual, effort.converged, effort.factorisations) = (end.residual, true, effort.iterations);
                self.write_back(contacts, v);
                return effort;
            }
        }
        self.start_inside(contacts, v, scale);
        let spent = effort.iterations;
        let (mut least, mut since) = (f64::INFINITY, 0);
        // Share of the last direction that is gone.
        let (mut share, mut stuck) = (0.0, false);
        // What was left at the start, and times that it began anew.
        let (mut begun, mut times) = (0.0, 0);
        let most_times = if survey.may_end() { TIMES } else { TIMES_RIGID };
        let stalled = if halves { STALLED_SHORT } else { STALLED };
        loop {
            let mut left = self.look((matrix, digits), (mass, free), contacts, v, Method::Inside { share });
            effort.residual = worse(left.residual, left.drawn);
            // With half of the digits it is left to Newton's method to say so.
            if left.residual <= tolerance && digits == Digits::All {
                if left.drawn <= tolerance {
                    effort.converged = true;
                    break;
                }
                self.plain.anchor();
                self.usual.anchor(contacts);
                self.limited.anchor(contacts);
                effort.rounds += 1;
                share = 0.0;
                continue;
            }
            (least, since) = if effort.residual <= 0.5 * least { (effort.residual, 0) } else { (least, since + 1) };
            if effort.iterations == spent {
                begun = left.residual;
            }
            if !left.residual.is_finite() && self.begins_anew(digits, (mass, free), (contacts, survey), v, tolerance) {
                (share, least, since, digits) = (0.0, f64::INFINITY, 0, Digits::All);
                continue;
            }
            let stays = since >= if effort.residual <= enough { PATIENCE } else { stalled };
            if effort.iterations >= spent + MOST || stays || !left.residual.is_finite() {
                // Half of the digits do not tell how near it is.
                if digits == Digits::Half {
                    effort.residual = f64::INFINITY;
                }
                break;
            }
            if times < most_times && since >= ANEW && effort.residual > enough {
                times += 1;
                self.plain.refine();
                self.plain.enter(v, NEARER * begun);
                self.usual.enter(contacts, v, NEARER * begun);
                self.limited.enter(contacts, v, NEARER * begun);
                // A last direction that was hardly gone leaves `stuck`: the first from here evens products out.
                (share, least, since, digits) = (0.0, f64::INFINITY, 0, Digits::All);
                continue;
            }
            if left.residual <= near {
                let end =
                    self.finish(matrix, (mass, free), contacts, v, (tolerance, digits), (share > 0.0, survey.keeps()));
                effort.iterations += end.iterations;
                effort.rounds += end.rounds;
                if end.converged {
                    (effort.residual, effort.converged) = (end.residual, true);
                    break;
                }
                (near, digits) = (finish::AGAIN * left.residual, Digits::All);
                self.plain.refine();
                left = self.look((matrix, digits), (mass, free), contacts, v, Method::Inside { share: 0.0 });
            }
            effort.iterations += 1;
            share = self.direct(matrix, &left, stuck);
            // Where products vanish before the conditions hold, rounding ends in nothing over nothing.
            if !self.step.iter().flatten().all(|x| x.is_finite()) {
                if !self.begins_anew(digits, (mass, free), (contacts, survey), v, tolerance) {
                    break;
                }
                (share, least, since, digits) = (0.0, f64::INFINITY, 0, Digits::All);
                continue;
            }
            if since >= ANEW {
                digits = Digits::All;
                self.plain.refine();
            }
            stuck = share < STUCK;
            for (v, step) in v.iter_mut().zip(&self.step) {
                (0..3).for_each(|k| v[k] += share * step[k]);
            }
        }
        effort.factorisations = effort.iterations;
        self.write_back(contacts, v);
        effort
    }

    /// Impulses and what they mean, into the contacts.
    fn write_back(&mut self, contacts: &mut [Contact], v: &[Triple]) {
        for number in &self.springs {
            let contact = &mut contacts[*number as usize];
            (contact.impulse, contact.status) = ([0.0; 2], Status::Open);
        }
        self.plain.tell(contacts, v);
        self.usual.tell(contacts, v);
        self.limited.tell(contacts, v);
    }

    /// Within the bounds, as far from them as what was borne before is off balance, `scale` [m/s].
    fn start_inside(&mut self, contacts: &[Contact], v: &[Triple], scale: f64) {
        self.plain.enter(v, scale);
        self.usual.enter(contacts, v, scale);
        self.limited.enter(contacts, v, scale);
    }

    /// Where half of the digits ended in what is no number, from the guess with all of them; false where it has all.
    fn begins_anew(
        &mut self,
        digits: Digits,
        bodies: (&[Triple], &[Triple]),
        contacts: (&[Contact], &Survey),
        v: &mut [Triple],
        tolerance: f64,
    ) -> bool {
        let half = digits == Digits::Half;
        if half {
            v.copy_from_slice(&self.guess);
            let scale = self.gather(bodies, contacts, v, (tolerance, Digits::All));
            self.start_inside(contacts.0, v, scale);
        }
        half
    }

    /// Takes the contacts up as they bore before; returns by how much that is off balance [m/s], the tolerance at least.
    fn gather(
        &mut self,
        (mass, free): (&[Triple], &[Triple]),
        (contacts, survey): (&[Contact], &Survey),
        v: &[Triple],
        (tolerance, digits): (f64, Digits),
    ) -> f64 {
        let [push, rise] = &mut self.pushes;
        for room in [&mut self.residual, &mut self.step, &mut self.gone, &mut self.work, push, rise] {
            room.resize(v.len(), [0.0; 3]);
        }
        self.springs.clear();
        self.plain.begin(digits);
        self.usual.clear();
        self.limited.clear();
        inertia(&mut self.residual, mass, free, v);
        // What is left over of packs are the last.
        let mut packs = survey.plain / PACK;
        let (mut numbers, mut waiting) = ([0; PACK], 0);
        for (number, contact) in contacts.iter().enumerate() {
            let u = contact.velocity(v);
            if packs > 0 && is_plain(contact) {
                numbers[waiting] = number as u32;
                waiting += 1;
                if waiting == PACK {
                    (packs, waiting) = (packs - 1, 0);
                    for (number, p) in numbers.iter().zip(self.plain.add(numbers, contacts, v)) {
                        contacts[*number as usize].push(&mut self.residual, p);
                    }
                }
                continue;
            }
            if is_spring(contact) {
                self.springs.push(number as u32);
                contact.push(&mut self.residual, contact.whole([0.0; 2], u));
                continue;
            }
            let p = match contact.pressure[1] == f64::INFINITY {
                true => self.usual.add(number, contact, u),
                false => self.limited.add(number, contact, u),
            };
            contact.push(&mut self.residual, contact.whole(p, u));
        }
        debug_assert!(waiting == 0 && packs == 0);
        unbalance(&self.residual, mass).max(tolerance)
    }

    /// What is left of (P1), into `self.residual`, and of the laws, and the matrix and the right side, into `self.step`, of a direction that would
    /// leave nothing: all in one go through the contacts, which are most of what has to be fetched.
    fn look(
        &mut self,
        (matrix, digits): (&mut Blocks, Digits),
        (mass, free): (&[Triple], &[Triple]),
        contacts: &[Contact],
        v: &[Triple],
        method: Method,
    ) -> Whole {
        inertia(&mut self.residual, mass, free, v);
        self.step.fill([0.0; 3]);
        if method.begins_matrix() {
            matrix.reset_whole(mass, digits);
        }
        for number in &self.springs {
            let contact = &contacts[*number as usize];
            contact.push(&mut self.residual, contact.whole([0.0; 2], contact.velocity(v)));
            if method.begins_matrix() {
                let [across, along] = contact.spring.map(|spring| spring.rho);
                contact.rows.couple(contact.slot, matrix, [across, along, 0.0]);
            }
        }
        let (residual, step) = (&mut self.residual[..], &mut self.step[..]);
        let mut sums = Sums { left: Left::default(), number: 0, changed: 0, residual, step, matrix };
        self.plain.look(v, &self.gone, method, &mut sums);
        self.usual.look(contacts, v, method, &mut sums);
        self.limited.look(contacts, v, method, &mut sums);
        let Sums { left: Left { residual, drawn, products }, number, changed, .. } = sums;
        Whole { residual: worse(residual, unbalance(&self.residual, mass)), drawn, products, number, changed }
    }

    /// The direction, into `self.step` and the points, and how far it is gone; `stuck` where the last was hardly gone at all.
    fn direct(&mut self, matrix: &mut Blocks, left: &Whole, stuck: bool) -> f64 {
        let mean = left.mean();
        self.begin_right_side();
        matrix.factorise_and_solve(&mut self.step, &mut self.work);
        let mut first = Course::begin(0.0);
        self.pushes.iter_mut().for_each(|push| push.fill([0.0; 3]));
        self.plain.predict(&self.step, &mut self.pushes, &mut first);
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
        let mut course = Course::begin(0.0);
        self.plain.turn(&self.step, target, &mut course);
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
    /// Number of the products, and of contacts that do something else than in the last look.
    number: usize,
    changed: usize,
    residual: &'a mut [Triple],
    step: &'a mut [Triple],
    matrix: &'a mut Blocks,
}

/// Whether a contact is no more than the springs beside: what is left of a bond.
fn is_spring(contact: &Contact) -> bool {
    let bears = contact.friction > 0.0 || contact.hold > 0.0;
    contact.compliant[0] && contact.law[0] == Linear::default() && contact.pressure[0] <= 0.0 && !bears
}

/// What a contact answers across or along, with what acts beside it, over the mass that it moves.
fn stiffness(contact: &Contact, k: usize) -> f64 {
    if !contact.moved[k].is_finite() {
        return 0.0;
    }
    let bears = k == 0 || contact.friction > 0.0 || contact.hold > 0.0;
    (contact.spring[k].rho + if bears { 1.0 / soft(contact, k) } else { 0.0 }) / contact.moved[k]
}

pub(crate) fn inertia(residual: &mut [Triple], mass: &[Triple], free: &[Triple], v: &[Triple]) {
    for (body, r) in residual.iter_mut().enumerate() {
        (0..3).for_each(|k| r[k] = mass[body][k] * (v[body][k] - free[body][k]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::order::Orders;
    use crate::solver::Solver;

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

    fn survey(contacts: &[Contact]) -> Survey {
        let mut survey = Survey::default();
        contacts.iter().for_each(|contact| survey.see(contact));
        survey
    }

    /// Half of the digits are for springs that are not too stiff, wherever they stand.
    #[test]
    fn stiff_contacts_take_all_digits() {
        let matrix = Blocks::new(6, &(1..6).map(|b| (b - 1, b)).collect::<Vec<_>>(), &Orders::anywhere());
        let contacts = contacts(&mut Draw(1), &matrix, 1.0);
        assert!(survey(&contacts).yields());
        let stiffer: [fn(&mut Contact); 4] = [
            |c| c.compliant[0] = false,
            |c| (c.compliant[1], c.friction) = (false, 0.5),
            |c| c.law[0].rho = 1e6 * c.moved[0],
            |c| c.spring[1].rho = 1e6 * c.moved[1],
        ];
        for stiffen in stiffer {
            let mut contacts = contacts.clone();
            stiffen(&mut contacts[3]);
            assert!(!survey(&contacts).yields());
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
                let survey = survey(&contacts);
                let bodies = (&[MASS; 6][..], &free[..]);
                let effort = interior.solve(&mut matrix, bodies, (&mut contacts, &survey), &mut v, (1e-6, 1e-6), false);
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

    /// What may be halved is left unsolved, and says so, where the augmented Lagrangian goes on otherwise, if nearly all contacts have springs. What
    /// is solved is the same to the bit either way.
    #[test]
    fn what_halves_is_left_sooner() {
        let pairs: Vec<_> = (1..6).map(|b| (b - 1, b)).collect();
        let (new, mut left_sooner) = (Solver::new(6, &pairs, &Orders::anywhere()), 0);
        for (springs, seed) in (0..15_000).map(|seed| (1.0, seed)).chain((0..300).map(|seed| (0.4, seed))) {
            let mut draw = Draw(seed);
            let contacts = contacts(&mut draw, new.matrix(), springs);
            let free: Vec<Triple> = (0..6).map(|_| [draw.next(), draw.next(), draw.next()]).collect();
            let may_end = survey(&contacts).may_end();
            let [goes_on, halves] = [false, true].map(|halves| {
                let (mut own, mut v) = (contacts.clone(), vec![[0.0; 3]; 6]);
                let mut solver = new.clone();
                let effort = solver.newton(&[MASS; 6], &free, &mut own, &mut v, (1e-6, 1e-6), halves);
                (effort, v, own)
            });
            if goes_on == halves {
                continue;
            }
            left_sooner += 1;
            assert!(may_end && !halves.0.converged && !(halves.0.residual <= 1e-6), "{seed}: {:?}", halves.0);
            assert!(halves.0.iterations < goes_on.0.iterations, "{seed}: {:?} {:?}", halves.0, goes_on.0);
        }
        assert!(left_sooner > 5, "{left_sooner}");
    }

    /// Contacts of seed `seed` that may all be taken in packs, and velocities without contact.
    fn plain_contacts(seed: u64, matrix: &Blocks) -> (Vec<Contact>, Vec<Triple>) {
        let mut draw = Draw(seed);
        let mut own: Vec<Contact> = (0..3).flat_map(|_| contacts(&mut draw, matrix, 1.0)).collect();
        for contact in &mut own {
            (contact.hold, contact.pressure) = (0.0, [0.0, f64::INFINITY]);
            contact.spring = Default::default();
            contact.friction = contact.friction.clamp(0.1, 0.8);
            for k in 0..2 {
                contact.law[k].rho = contact.law[k].rho.max(0.1 * contact.moved[k]);
            }
        }
        let free = (0..6).map(|_| [draw.next(), draw.next(), draw.next()]).collect();
        (own, free)
    }

    /// Masses and impulses that 32 bits do not hold, or whose factors they do not, are solved with 64.
    #[test]
    fn what_half_of_the_digits_do_not_hold_is_solved_with_all() {
        let pairs: Vec<_> = (1..6).map(|b| (b - 1, b)).collect();
        let mut matrix = Blocks::new(6, &pairs, &Orders::anywhere());
        let mut interior = Interior::default();
        for scale in [1e-25, 1e-37, 1e25, 1e36] {
            let (mut solved, mut alike) = (0, 0);
            for seed in 0..100 {
                let (own, free) = plain_contacts(seed, &matrix);
                let [as_is, scaled] = [1.0, scale].map(|scale| {
                    let (mut contacts, mut v) = (own.clone(), vec![[0.0; 3]; 6]);
                    for contact in &mut contacts {
                        for k in 0..2 {
                            contact.law[k].offset *= scale;
                            contact.law[k].rho *= scale;
                            contact.moved[k] *= scale;
                            contact.impulse[k] *= scale;
                        }
                    }
                    let survey = survey(&contacts);
                    assert!(survey.yields() && survey.may_end() && survey.plain == contacts.len());
                    let mass = [MASS.map(|m| scale * m); 6];
                    let bodies = (&mass[..], &free[..]);
                    let effort =
                        interior.solve(&mut matrix, bodies, (&mut contacts, &survey), &mut v, (1e-6, 1e-6), false);
                    (v, effort.converged)
                });
                if as_is.1 {
                    solved += usize::from(scaled.1);
                    let off = as_is.0.iter().flatten().zip(scaled.0.iter().flatten()).map(|(a, b)| (a - b).abs());
                    alike += usize::from(scaled.1 && off.fold(0.0, worse) < 1e-9);
                }
            }
            assert!(solved > 90 && alike * 20 > solved * 19, "{scale:e}: {solved}, {alike}");
        }
    }

    /// Contacts that are taken in packs do what they would do one by one, and some are left over of packs.
    #[test]
    fn packs_do_what_each_does_alone() {
        let pairs: Vec<_> = (1..6).map(|b| (b - 1, b)).collect();
        let mut matrix = Blocks::new(6, &pairs, &Orders::anywhere());
        let mut interior = Interior::default();
        let (mut solved, mut alike, mut left_over) = (0, 0, 0);
        for seed in 0..300 {
            let (own, free) = plain_contacts(seed, &matrix);
            let survey = survey(&own);
            assert!(survey.plain == own.len() && own.len() > PACK);
            left_over += usize::from(!own.len().is_multiple_of(PACK));
            let [together, alone] = [survey, Survey { plain: 0, ..survey }].map(|survey| {
                let (mut contacts, mut v) = (own.clone(), vec![[0.0; 3]; 6]);
                let bodies = (&[MASS; 6][..], &free[..]);
                let effort = interior.solve(&mut matrix, bodies, (&mut contacts, &survey), &mut v, (1e-6, 1e-6), false);
                assert!(!effort.converged || left(&contacts, &v, &free) < 1e-5, "seed {seed}: {effort:?}");
                (contacts, v, effort.converged)
            });
            if together.2 && alone.2 {
                solved += 1;
                let off = |a: f64, b: f64| (a - b).abs();
                let velocities = together.1.iter().flatten().zip(alone.1.iter().flatten()).map(|(a, b)| off(*a, *b));
                let impulses = together.0.iter().zip(&alone.0);
                let impulses = impulses.flat_map(|(a, b)| [0, 1].map(|k| off(a.impulse[k], b.impulse[k])));
                alike += usize::from(velocities.chain(impulses).fold(0.0, worse) < 1e-9);
            }
        }
        assert!(solved > 270 && left_over > 200, "{solved} {left_over}");
        // Friction lets some move in more than one way.
        assert!(alike * 50 > solved * 49, "{alike} of {solved}");
    }
}
