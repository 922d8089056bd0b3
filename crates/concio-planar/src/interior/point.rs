//! The laws of a contact about an iterate: of one, or of as many side by side as a register holds.

use super::lanes::Real;
use super::{GRIP, KEPT, SHARE, YIELDS};
use crate::contact::{Contact, Status};
use crate::interior::CRACK;

/// Share of the impulses by which rounding puts distances from bounds off: to mend that would keep the way short where a bound is met.
const ROUNDED: f64 = 1e-13;

/// How the multiplier of each bound stands in (P5a), and in which direction: 0 across, 1 along.
const SENSE: [f64; 4] = [-1.0, 1.0, 1.0, -1.0];
const DIRECTION: [usize; 4] = [1, 1, 0, 0];

/// Distance and multiplier of a bound that is not there.
const ABSENT: (f64, f64) = (1.0, 0.0);

/// A contact during a solution: with three bounds, or with that of crushing four.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point<const N: usize, T = f64> {
    /// How far each bound is away, and its multiplier, 1 and 0 where there is no such bound: friction forth and back, least and most p_n.
    pub s: [T; N],
    pub lambda: [T; N],
    /// Impulses, and those of the laws where nothing moves, p⁰.
    pub p: [T; 2],
    pub anchor: [T; 2],
    /// Diagonal of E, 0 where the impulse does not change.
    pub soft: [T; 2],
    /// Mass that a push moves, and spring across [kg].
    pub mass: T,
    pub rho: T,
}

/// What a point can do.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind<const N: usize> {
    /// Whether the impulse across and along may change, whether there is friction, whether it follows from pressure alone, and which
    /// bounds there are.
    pub moves: [bool; 2],
    pub rubs: bool,
    pub dry: bool,
    pub on: [bool; N],
}

impl<const N: usize> Kind<N> {
    /// Friction that follows from pressure alone, and no largest pressure.
    pub const DRY: Self = Kind { moves: [true; 2], rubs: true, dry: true, on: [true; N] };
}

/// What the laws of a contact say during a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Laws<T = f64> {
    /// μ.
    pub friction: T,
    /// What friction bears beside μ p_n, and what springs beside press, at the velocity looked at [N s].
    pub hold: T,
    pub beside: T,
    /// Least and largest p_n [N s].
    pub pressure: [T; 2],
    /// b [m/s].
    pub bias: T,
    /// Mass that a push along moves [kg].
    pub along: T,
    /// By how many times nearer than others the law along is to be met.
    pub tight: T,
}

impl Laws {
    #[inline(always)]
    pub fn of(contact: &Contact, u: [f64; 2]) -> Self {
        Laws {
            friction: contact.friction,
            hold: contact.hold,
            beside: contact.spring[0].at(u[0]),
            pressure: contact.pressure,
            bias: contact.bias,
            along: contact.moved[1],
            tight: contact.tight,
        }
    }
}

impl<T: Real> Laws<T> {
    /// What bounds friction where p_n is what it is.
    #[inline(always)]
    fn bound(&self, p_n: T) -> T {
        (self.friction * (p_n + self.beside)).larger(p_n.alike(0.0)) + self.hold
    }
}

/// What a look at a point makes of it, for the directions from there.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<const N: usize, T = f64> {
    /// One over the distance from each bound, 0 where there is no such bound.
    pub near: [T; N],
    /// By how much (P5) and (P5a) are off.
    pub astray: [T; N],
    pub off: [T; 2],
    /// μ where the contact is pressed, 0 where it is pulled.
    pub mu: T,
    /// By how much impulses fall as velocities rise, across and along, and the impulse along as the pressure across rises.
    pub response: [T; 3],
    /// Impulses where velocities stay, to products of 0.
    pub right: [T; 2],
}

impl<const N: usize, T: Real> View<N, T> {
    #[inline(always)]
    pub fn none(zero: T) -> Self {
        View { near: [zero; N], astray: [zero; N], off: [zero; 2], mu: zero, response: [zero; 3], right: [zero; 2] }
    }

    /// Impulses by what (P5a) is off.
    #[inline(always)]
    fn answer(&self, off: [T; 2]) -> [T; 2] {
        let [across, along, tilt] = self.response;
        let p_n = across * off[0];
        [p_n, along * off[1] - tilt * p_n]
    }
}

/// A direction of impulses, distances and multipliers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way<const N: usize, T = f64> {
    pub p: [T; 2],
    pub s: [T; N],
    pub lambda: [T; N],
}

impl<const N: usize, T: Copy> Way<N, T> {
    pub fn none(zero: T) -> Self {
        Way { p: [zero; 2], s: [zero; N], lambda: [zero; N] }
    }
}

/// What is left of the laws [m/s].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Left<T = f64> {
    pub residual: T,
    /// Sum of the products λ s.
    pub products: T,
}

impl<T: Real> Left<T> {
    #[inline(always)]
    pub fn none(zero: T) -> Self {
        Left { residual: zero, products: zero }
    }
}

/// What a direction comes to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course<T = f64> {
    /// How far it may be gone, 1 at most.
    pub share: T,
    /// Growth of the products with the share and its square.
    pub growth: [T; 2],
}

impl<T: Real> Course<T> {
    #[inline(always)]
    pub fn begin(zero: T) -> Self {
        Course { share: zero.alike(1.0), growth: [zero; 2] }
    }

    /// Takes a point's part of the direction up, which is gone to the boundary at most, or, where the point yields, as far as others may (`bold`).
    #[inline(always)]
    pub fn meet<const N: usize>(&mut self, point: &Point<N, T>, way: &Way<N, T>, bold: bool) {
        let one = point.mass.alike(1.0);
        let firm = if bold { (point.soft[0] * point.mass).at_most(one.alike(YIELDS)) } else { one.at_most(one) };
        let reach = T::pick(firm, one, one.alike(f64::INFINITY));
        for i in 0..N {
            let (s, l, ds, dl) = (point.s[i], point.lambda[i], way.s[i], way.lambda[i]);
            self.stop(s, ds, reach);
            self.stop(l, dl, reach);
            self.growth[0] = self.growth[0] + (s * dl + l * ds);
            self.growth[1] = self.growth[1] + ds * dl;
        }
    }

    /// Most bounds are farther off than the nearest so far: only those that are not are divided by.
    #[inline(always)]
    fn stop(&mut self, x: T, change: T, reach: T) {
        let room = -reach * x;
        let passes = (change * self.share).below(room);
        if self.share.any(passes) {
            self.share = T::pick(passes, room / change, self.share);
        }
    }
}

/// E of a contact across or along.
pub(super) fn soft(contact: &Contact, k: usize) -> f64 {
    1.0 / contact.law[k].rho
}

/// Whether friction follows from pressure alone.
pub(super) fn is_dry(contact: &Contact) -> bool {
    let alone = contact.pressure[0] == 0.0 && contact.hold == 0.0 && contact.spring[0] == Default::default();
    alone && contact.friction > 0.0 && !is_fixed(contact)
}

/// Whether what presses stays whatever moves.
fn is_fixed(contact: &Contact) -> bool {
    contact.law[0].rho == 0.0
}

/// The bounds that there are, of four.
#[inline(always)]
fn first<const N: usize, T: Copy>(four: [T; 4]) -> [T; N] {
    let mut some = [four[0]; N];
    some.copy_from_slice(&four[..N]);
    some
}

/// Whether friction is taken to slide forth, back, and forth where both is said.
struct Slides<T: Real> {
    forth: T::Mask,
    back: T::Mask,
    both: T::Mask,
}

impl<T: Real> Slides<T> {
    /// What belongs to sliding forth or back, and to sticking.
    #[inline(always)]
    fn of(&self, [forth, back]: [T; 2], sticks: T) -> T {
        let either = T::pick(self.back, T::pick(self.both, forth, back), forth);
        T::pick(self.forth, either, T::pick(self.back, back, sticks))
    }
}

impl<const N: usize, T: Real> Point<N, T> {
    /// Distances from the bounds by the impulses.
    #[inline(always)]
    fn far(&self, [least, most]: [T; 2], bound: T) -> [T; N] {
        let [p_n, p_t] = self.p;
        first([bound - p_t, bound + p_t, p_n - least, most - p_n])
    }

    /// Multipliers by the velocities, as if the bounds of a direction alone held.
    #[inline(always)]
    fn pulls(&self, laws: &Laws<T>, u: [T; 2]) -> [T; 2] {
        [u[0] + laws.bias + self.shift(0), u[1] + self.shift(1)]
    }

    /// Impulses, distances and multipliers at the start, where velocities are out of balance by `scale` [m/s]: so far from
    /// the bounds that bearing or not stays open.
    #[inline(always)]
    pub fn enter(&mut self, on: &[bool; N], laws: &Laws<T>, u: [T; 2], scale: f64) {
        let zero = self.mass.alike(0.0);
        let half = zero.alike(0.5);
        let floor = zero.alike(scale) * self.mass + zero.alike(SHARE) * self.p[0].size();
        let [least, most] = laws.pressure;
        let inside = floor.smaller(half * (most - least));
        if on[2] {
            self.p[0] = self.p[0].larger(least + inside);
        }
        if N > 3 && on[3] {
            self.p[0] = self.p[0].smaller(most - inside);
        }
        let bound = laws.bound(self.p[0]);
        let room = (bound - floor.smaller(half * bound)).larger(zero);
        self.p[1] = self.p[1].between(-room, room);
        let (far, pulls) = (self.far(laws.pressure, bound), self.pulls(laws, u));
        for i in 0..N {
            (self.s[i], self.lambda[i]) = (zero.alike(ABSENT.0), zero.alike(ABSENT.1));
            if on[i] {
                self.s[i] = far[i].larger(floor);
                let least = zero.alike(CRACK * scale) * floor / self.s[i];
                self.lambda[i] = (zero.alike(SENSE[i]) * pulls[DIRECTION[i]]).larger(least);
            }
        }
    }

    /// Distances and multipliers of the impulses as they are, at the velocity `u`.
    #[inline(always)]
    pub fn settle(&mut self, on: &[bool; N], laws: &Laws<T>, u: [T; 2]) {
        let zero = self.mass.alike(0.0);
        let (far, pulls) = (self.far(laws.pressure, laws.bound(self.p[0])), self.pulls(laws, u));
        for i in 0..N {
            (self.s[i], self.lambda[i]) = (zero.alike(ABSENT.0), zero.alike(ABSENT.1));
            if on[i] {
                self.s[i] = far[i].larger(zero);
                self.lambda[i] = (zero.alike(SENSE[i]) * pulls[DIRECTION[i]]).larger(zero);
            }
        }
    }

    /// Goes a share of the direction, with distances and multipliers that stay above 0: by what they are astray then the next mends.
    #[inline(always)]
    pub fn go(&mut self, share: T, way: &Way<N, T>) {
        let kept = share.alike(KEPT);
        for k in 0..2 {
            self.p[k] = self.p[k] + share * way.p[k];
        }
        for i in 0..N {
            self.s[i] = (self.s[i] + share * way.s[i]).larger(kept * self.s[i]);
            self.lambda[i] = (self.lambda[i] + share * way.lambda[i]).larger(kept * self.lambda[i]);
        }
    }

    /// E (p − p⁰).
    #[inline(always)]
    fn shift(&self, k: usize) -> T {
        self.soft[k] * (self.p[k] - self.anchor[k])
    }

    /// By how much it is off at the velocity `u`, where friction bears `bound` and `view` says how near bounds are.
    #[inline(always)]
    pub fn stray(&self, laws: &Laws<T>, u: [T; 2], bound: T, view: &mut View<N, T>, left: &mut Left<T>) {
        let zero = self.mass.alike(0.0);
        let far = self.far(laws.pressure, bound);
        let rounded = zero.alike(ROUNDED) * (self.p[0].size() + self.p[1].size() + bound.size());
        let per_mass = zero.alike(1.0) / self.mass;
        view.off = self.pulls(laws, u);
        for i in 0..N {
            let (s, l) = (self.s[i], self.lambda[i]);
            let absent = view.near[i].at_most(zero);
            let astray = far[i] - s;
            // What is no number stays one, to be seen.
            let astray = T::pick(astray.size().at_most(rounded), zero, astray);
            view.astray[i] = T::pick(absent, zero, astray);
            let k = DIRECTION[i];
            view.off[k] = view.off[k] - zero.alike(SENSE[i]) * l;
            left.residual = left.residual.worse(view.astray[i].size() * per_mass);
            let pull = if k == 1 { l * laws.tight } else { l };
            left.residual = left.residual.worse(T::pick(absent, zero, (s * per_mass).smaller(pull)));
            left.products = left.products + T::pick(absent, zero, s * l);
        }
    }

    /// What that leaves of (P5a).
    #[inline(always)]
    pub fn gauge(&self, laws: &Laws<T>, view: &View<N, T>, left: &mut Left<T>) {
        for k in 0..2 {
            let off = view.off[k].size();
            left.residual = left.residual.worse(if k == 1 { off * laws.tight } else { off });
        }
    }

    /// What impulses answer, by how near the bounds are.
    #[inline(always)]
    pub fn respond(&self, view: &mut View<N, T>) {
        let mut d = self.lambda;
        for i in 0..N {
            d[i] = d[i] * view.near[i];
        }
        let across = self.soft[0] + d[2];
        let across = if N > 3 { across + d[N - 1] } else { across };
        let along = self.soft[1] + d[0] + d[1];
        let (across, along) = (across.inverse(), along.inverse());
        view.response = [across, along, view.mu * (d[1] - d[0]) * along];
    }

    /// Impulses for products of `target` where velocities stay.
    #[inline(always)]
    pub fn aim(&self, view: &View<N, T>, target: T, second: &[T; N]) -> [T; 2] {
        let mut off = [-view.off[0], -view.off[1]];
        for i in 0..N {
            let (l, k) = (self.lambda[i], DIRECTION[i]);
            off[k] = off[k] + l.alike(SENSE[i]) * ((target - second[i] - l * view.astray[i]) * view.near[i] - l);
        }
        view.answer(off)
    }

    /// What each unit of the products adds to them.
    #[inline(always)]
    pub fn rise(&self, view: &View<N, T>) -> [T; 2] {
        let mut off = [self.mass.alike(0.0); 2];
        for i in 0..N {
            let k = DIRECTION[i];
            off[k] = off[k] + self.mass.alike(SENSE[i]) * view.near[i];
        }
        view.answer(off)
    }

    /// Change of the impulses where velocities change by `du`, and otherwise by `right`.
    #[inline(always)]
    pub fn follows(&self, view: &View<N, T>, du: [T; 2], right: [T; 2]) -> [T; 2] {
        let [across, along, tilt] = view.response;
        let (d_n, d_t) = (-across * du[0], -along * du[1]);
        [right[0] + d_n, right[1] + d_t - tilt * (d_n - self.rho * du[0])]
    }

    /// The direction where velocities change by `du`, to products of `target` that have a second-order part.
    #[inline(always)]
    pub fn way(&self, view: &View<N, T>, du: [T; 2], right: [T; 2], target: T, second: &[T; N]) -> Way<N, T> {
        let zero = self.mass.alike(0.0);
        let d_p = self.follows(view, du, right);
        let bound = view.mu * (d_p[0] - self.rho * du[0]);
        let mut far: [T; N] = first([bound - d_p[1], bound + d_p[1], d_p[0], -d_p[0]]);
        let mut dl = self.lambda;
        for i in 0..N {
            far[i] = far[i] + view.astray[i];
            dl[i] = (target - second[i] - self.lambda[i] * far[i]) * view.near[i] - self.lambda[i];
        }
        // (P5a) is linear: what rounding leaves of it goes to the multipliers, most to the largest.
        for k in 0..2 {
            let mut left = du[k] + self.soft[k] * d_p[k] + view.off[k];
            let mut weight = zero;
            for i in 0..N {
                if DIRECTION[i] == k {
                    left = left - zero.alike(SENSE[i]) * dl[i];
                    weight = weight + self.lambda[i] * self.lambda[i];
                }
            }
            let part = T::pick(zero.alike(f64::MIN_POSITIVE).below(weight), left / weight, zero);
            for i in 0..N {
                if DIRECTION[i] == k {
                    dl[i] = dl[i] + zero.alike(SENSE[i]) * part * (self.lambda[i] * self.lambda[i]);
                }
            }
        }
        // What bears at a bound lies at it to rounding: distances follow from the products there.
        let mut ds = far;
        for i in 0..N {
            let (s, l) = (self.s[i], self.lambda[i]);
            let by_products = (target - second[i] - s * dl[i]) / l - s;
            let by_impulses = T::pick(view.near[i].at_most(zero), zero, far[i]);
            ds[i] = T::pick(s.below(self.mass * l), by_products, by_impulses);
        }
        Way { p: d_p, s: ds, lambda: dl }
    }

    /// Which bounds hold by the last direction: those whose distance falls faster than the multiplier (El-Bakry, Tapia and Zhang 1994).
    #[inline(always)]
    pub fn led(&self, way: &Way<N, T>) -> [T::Mask; N] {
        let zero = self.mass.alike(0.0);
        let mut led = [zero.below(zero); N];
        for i in 0..N {
            led[i] = (self.lambda[i] * way.s[i]).below(self.s[i] * way.lambda[i]);
        }
        led
    }

    /// What it leaves of (P4) across at the velocity `u_n`, and what the impulse across does where the bound holds that holds by it and the
    /// velocity now, or by the last direction.
    #[inline(always)]
    pub fn choose_across(
        &self,
        laws: &Laws<T>,
        u_n: T,
        led: Option<[T::Mask; N]>,
        view: &mut View<N, T>,
        left: &mut Left<T>,
    ) {
        let zero = self.mass.alike(0.0);
        let [least, most] = laws.pressure;
        let off = u_n + laws.bias + self.shift(0);
        let tends = self.p[0] - self.mass * off;
        left.residual = left.residual.worse((self.p[0] - tends.between(least, most)).size() / self.mass);
        let (lets_go, crushes) = match led {
            Some(led) if N > 3 => (led[2], led[N - 1]),
            Some(led) => (led[2], zero.below(zero)),
            None => (tends.at_most(least), most.at_most(tends)),
        };
        let stiffness = zero.alike(1.0) / self.soft[0];
        view.response[0] = T::pick(lets_go, zero, T::pick(crushes, zero, stiffness));
        let by_law = -off * stiffness;
        view.right[0] = T::pick(lets_go, least - self.p[0], T::pick(crushes, most - self.p[0], by_law));
    }

    /// The same of (P4) along and the impulse there, after [`Point::choose_across`]; `mu` is that of a contact that is pressed.
    #[inline(always)]
    pub fn choose_along(
        &self,
        laws: &Laws<T>,
        (mu, u_t): (T, T),
        led: Option<[T::Mask; N]>,
        view: &mut View<N, T>,
        left: &mut Left<T>,
    ) {
        let zero = self.mass.alike(0.0);
        let pressed = self.p[0] + laws.beside;
        let bound = (mu * pressed).larger(zero) + laws.hold;
        let off = u_t + self.shift(1);
        let by = |mass: T| self.p[1] - mass * off;
        let wanted = by(laws.along).between(-bound, bound);
        left.residual = left.residual.worse((self.p[1] - wanted).size() * laws.tight / laws.along);
        // By more than the law answers what slid one way would slide the other, and never stick.
        let tends = by(laws.along.smaller(zero.alike(1.0) / self.soft[1]));
        // Where both are led to, it goes where it tends to.
        let ([forth, back], both) = match led {
            Some(led) => ([led[0], led[1]], zero.below(tends)),
            None => ([bound.at_most(tends), tends.at_most(-bound)], bound.at_most(tends)),
        };
        let slides = Slides { forth, back, both };
        let (grip, tilt) = (mu * pressed + laws.hold, mu * view.right[0]);
        let stiffness = zero.alike(1.0) / self.soft[1];
        view.response[1] = slides.of([zero, zero], stiffness);
        view.response[2] = slides.of([-mu, mu], zero);
        view.right[1] = slides.of([grip - self.p[1] + tilt, -grip - self.p[1] - tilt], -off * stiffness);
    }
}

impl<const N: usize> Point<N> {
    /// What a contact bore before, within its bounds.
    pub fn lay(contact: &Contact, u: [f64; 2]) -> (Self, Kind<N>) {
        let [least, most] = contact.pressure;
        let fixed = is_fixed(contact);
        let p_n = if fixed { contact.law[0].offset } else { contact.impulse[0] }.clamp(least, most);
        let bound = contact.bound(p_n, u[0]);
        let p = [p_n, contact.impulse[1].clamp(-bound, bound)];
        let rubs = contact.friction > 0.0 || contact.hold > 0.0;
        let moves = [!fixed, rubs && (bound > 0.0 || is_dry(contact))];
        let bounds = [moves[1], moves[1], !fixed && least.is_finite(), !fixed && most.is_finite()];
        let point = Point {
            s: [0.0; N],
            lambda: [0.0; N],
            soft: [0, 1].map(|k| if moves[k] { soft(contact, k) } else { 0.0 }),
            mass: contact.moved[0],
            rho: contact.spring[0].rho,
            p,
            anchor: contact.law.map(|law| law.offset),
        };
        (point, Kind { moves, rubs, dry: is_dry(contact), on: std::array::from_fn(|i| bounds[i]) })
    }

    /// μ where the contact is pressed or would be, 0 where it is pulled. What holds without pressure lets p_n pass from one to the other itself: what
    /// it would be jumps to and fro where it hardly yields.
    #[inline(always)]
    pub fn mu(&self, kind: &Kind<N>, contact: &Contact, u_n: f64, beside: f64) -> f64 {
        let p_n = if contact.hold > 0.0 { self.p[0] } else { self.tends(contact, u_n) };
        if kind.dry || p_n + beside > 0.0 { contact.friction } else { 0.0 }
    }

    /// What p_n would be without friction, whose bounds would not let the whole pass from pressure to tension.
    #[inline(always)]
    fn tends(&self, contact: &Contact, u_n: f64) -> f64 {
        let [least, most] = contact.pressure;
        contact.law[0].at(u_n + contact.bias).clamp(least, most)
    }

    /// Friction that may bear nothing is left out until it may bear something again.
    pub fn grip(&mut self, kind: &mut Kind<N>, bound: f64, contact: &Contact, way: &mut Way<N>) {
        let grips = bound > 0.0;
        if kind.moves[1] && !grips {
            (self.p[1], self.soft[1]) = (0.0, 0.0);
            for i in 0..2 {
                (self.s[i], self.lambda[i]) = ABSENT;
                (way.s[i], way.lambda[i]) = (0.0, 0.0);
            }
        } else if !kind.moves[1] && grips {
            for i in 0..2 {
                self.s[i] = bound;
                self.lambda[i] = GRIP * bound / contact.moved[1];
                (way.s[i], way.lambda[i]) = (0.0, 0.0);
            }
            self.anchor[1] = contact.law[1].offset;
            self.soft[1] = soft(contact, 1);
        }
        (kind.moves[1], kind.on[0], kind.on[1]) = (grips, grips, grips);
    }

    /// Impulses and what they mean, at the parting velocity `u_n`.
    pub fn tell(&self, kind: &Kind<N>, contact: &mut Contact, u_n: f64) {
        let held: [bool; N] = std::array::from_fn(|i| kind.on[i] && self.s[i] <= self.mass * self.lambda[i]);
        let [least, most] = contact.pressure;
        let p_n = match held[2..] {
            [true, ..] => least,
            [_, true] => most,
            _ => self.p[0].clamp(least, most),
        };
        let bound = contact.bound(p_n, u_n);
        let p_t = if kind.moves[1] { self.p[1].clamp(-bound, bound) } else { 0.0 };
        (contact.impulse, contact.status) = match [held[0], held[1]] {
            _ if p_n == 0.0 && !(bound > 0.0) => ([0.0; 2], Status::Open),
            [true, false] => ([p_n, p_t], Status::Forth),
            [false, true] => ([p_n, p_t], Status::Back),
            _ => ([p_n, p_t], Status::Stick),
        };
    }
}
