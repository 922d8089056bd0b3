//! Friction along a joint on springs, place by place: fibres that stick, slide or hang free.
//!
//! The contact points of a zone say what it bears across. Along, what opens lets go what it bore, what closes begins with nothing, and where pressure falls to 0
//! some of a joint slides under any shear. Points that move with the zones cannot tell which of it that was; fibres that stay where they are can.
//!
//! (P13)  τ = clamp(k_t (s − a), ±μ p),   a = s − τ/k_t
//!
//! with the slide s of the joint there, the pressure p and the anchor a, the slide at which the fibre bears nothing.

use std::ops::Range;

use pulp::Arch;
use serde::{Deserialize, Serialize};

/// Fibres of a joint, evenly from one end to the other.
pub(crate) const FIBRES: usize = 65;

/// The springs along what has no bond, in line with friction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Fibres {
    /// Slide at which each bears nothing [m]; none of a joint that is rigid along.
    anchors: Vec<f64>,
    /// The part of each that was pressed, 0 … 1.
    pressed: Vec<f64>,
    /// Energy in them beyond that of the points [J].
    pub uneven: f64,
    /// What friction took of the points in the step [J].
    pub rubbed: f64,
    /// Whether the joint slides.
    pub sliding: bool,
}

/// How a joint stands around a fibre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stands {
    /// How far it slid [m].
    pub slide: f64,
    /// What friction bears at most, over all of the joint [N].
    pub most: f64,
    /// The part that is pressed, 0 … 1.
    pub pressed: f64,
}

/// What fibres bear along [N] and store [J].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sheared {
    pub whole: f64,
    pub energy: f64,
}

/// How a joint slid [m] and what presses it, over all of it and no more than `limit` [N], as straight lines: at its start, and how much more at its end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lines {
    pub slide: [f64; 2],
    pub press: [f64; 2],
    pub limit: f64,
    /// Friction.
    pub mu: f64,
}

/// Sums over fibres, in fours by their numbers: the same bits however many are taken at once.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    whole: [f64; 4],
    energy: [f64; 4],
}

impl Sums {
    /// What a fibre bears [N] and stores twice [J].
    #[inline(always)]
    fn add(&mut self, n: usize, borne: f64, energy: f64) {
        // Those at the ends stand for half as much.
        let weight = if n == 0 || n == FIBRES - 1 { 0.5 } else { 1.0 };
        self.whole[n % 4] += weight * borne;
        self.energy[n % 4] += weight * energy;
    }

    #[inline(always)]
    fn sheared(&self) -> Sheared {
        let [whole, energy] = [self.whole, self.energy].map(|[a, b, c, d]| (a + b + (c + d)) / (FIBRES - 1) as f64);
        Sheared { whole, energy: 0.5 * energy }
    }
}

/// What a fibre with a spring of `k` [N/m] bears [N] at this stretch, `most` at most, and the stretch that is left [m].
#[inline(always)]
fn bears(k: f64, stretch: f64, most: f64) -> (f64, f64) {
    let sticks = k * stretch;
    let borne = if sticks > most { most } else { sticks };
    let borne = if borne < -most { -most } else { borne };
    // Rounding would move what sticks.
    (borne, if borne == sticks { stretch } else { borne / k })
}

/// [`Fibres::follow_pressed`], of fibres from number `first` on.
#[inline(always)]
fn sweep((anchors, pressed): (&mut [f64], &mut [f64]), first: usize, stiffness: f64, lines: &Lines) -> Sheared {
    let Lines { slide: [from, more], press: [least, rise], limit, mu } = *lines;
    // No sum is in the way of taking several at once.
    let (mut borne, mut energy) = ([0.0; FIBRES], [0.0; FIBRES]);
    let places = &PLACES[first..first + anchors.len()];
    let states = anchors.iter_mut().zip(pressed).zip(places);
    for (((anchor, pressed), x), (borne, energy)) in states.zip(borne.iter_mut().zip(&mut energy)) {
        let slide = from + x * more;
        let most = mu * (least + x * rise).max(0.0).min(limit);
        // What has just closed bears nothing yet.
        let (force, stretch) = bears(stiffness, (*anchor - slide) * *pressed, most);
        (*anchor, *pressed) = (slide + stretch, 1.0);
        (*borne, *energy) = (force, force * stretch);
    }
    let mut sums = Sums::default();
    for (n, (borne, energy)) in borne.iter().zip(&energy).take(anchors.len()).enumerate() {
        sums.add(first + n, *borne, *energy);
    }
    sums.sheared()
}

impl Sheared {
    pub fn and(self, other: Self) -> Self {
        Sheared { whole: self.whole + other.whole, energy: self.energy + other.energy }
    }
}

/// Those that are pressed all over, those that are in part and those that hang free, of a joint that a straight line presses in by so much at its ends [m].
pub(crate) fn parts([from, to]: [f64; 2]) -> [Range<usize>; 3] {
    let (none, all) = (0..0, 0..FIBRES);
    match [from > 0.0, to > 0.0] {
        [true, true] => [all, none.clone(), none],
        [false, false] => [none.clone(), none, all],
        [starts, _] => {
            let opens = from / (from - to) * (FIBRES - 1) as f64;
            // One more at each side, where rounding may put it.
            let [first, last] = [(opens - 1.0).max(0.0) as usize, (opens + 2.5).min(FIBRES as f64) as usize];
            let (before, beyond) = (0..first, last..FIBRES);
            if starts { [before, first..last, beyond] } else { [beyond, first..last, before] }
        }
    }
}

/// Half of what a fibre stands for, of the joint.
pub(crate) const HALF: f64 = 0.5 / (FIBRES - 1) as f64;

/// The part above 0 of what goes from one number to another, and the mean of it there over all.
pub(crate) fn above([from, to]: [f64; 2]) -> [f64; 2] {
    let part = match [from > 0.0, to > 0.0] {
        [true, true] => return [1.0, 0.5 * (from + to)],
        [false, false] => return [0.0; 2],
        [true, false] => from / (from - to),
        [false, true] => to / (to - from),
    };
    [part, 0.5 * part * from.max(to)]
}

impl Fibres {
    /// Of a joint that bears nothing yet.
    pub fn new(there: bool) -> Self {
        let number = if there { FIBRES } else { 0 };
        Fibres { anchors: vec![0.0; number], pressed: vec![0.0; number], uneven: 0.0, rubbed: 0.0, sliding: false }
    }

    pub fn are_there(&self) -> bool {
        !self.anchors.is_empty()
    }

    /// Whether there are as many as a joint needs.
    pub fn fit(&self, there: bool) -> bool {
        let number = if there { FIBRES } else { 0 };
        self.anchors.len() == number && self.pressed.len() == number
    }

    /// They bear nothing where they are; returns what they stored beyond the points [J].
    pub fn let_go(&mut self) -> f64 {
        self.anchors.fill(0.0);
        self.pressed.fill(0.0);
        (self.sliding, self.rubbed) = (false, 0.0);
        std::mem::take(&mut self.uneven)
    }

    /// Begins with the slide at which each bears nothing, by its place 0 … 1.
    pub fn begin(&mut self, anchor: impl Fn(f64) -> f64) {
        (self.uneven, self.rubbed) = (0.0, 0.0);
        self.pressed.fill(1.0);
        for (own, x) in self.anchors.iter_mut().zip(PLACES) {
            *own = anchor(x);
        }
    }

    /// Takes those of a `part` of the joint along to where it slid to, with springs of `stiffness` over all of it [N/m]: `at` says how it stands around each. What would
    /// bear more than friction lets it slides.
    pub fn follow(&mut self, stiffness: f64, part: Range<usize>, at: impl Fn(f64) -> Stands) -> Sheared {
        let mut sums = Sums::default();
        for n in part {
            let Stands { slide, most, pressed } = at(PLACES[n]);
            let before = std::mem::replace(&mut self.pressed[n], pressed);
            // What has just closed bears nothing yet.
            let stretch = (self.anchors[n] - slide) * if pressed > before { before / pressed } else { 1.0 };
            let k = pressed * stiffness;
            let (borne, stretch) = if k == 0.0 { (0.0, 0.0) } else { bears(k, stretch, most) };
            self.anchors[n] = slide + stretch;
            sums.add(n, borne, borne * stretch);
        }
        sums.sheared()
    }

    /// The same of those that are pressed all over, along `lines`: most by far, several at once.
    pub fn follow_pressed(&mut self, stiffness: f64, part: Range<usize>, lines: &Lines) -> Sheared {
        if part.is_empty() {
            return Sheared::default();
        }
        let (anchors, pressed) = (&mut self.anchors[part.clone()], &mut self.pressed[part.clone()]);
        Arch::new().dispatch(|| sweep((anchors, pressed), part.start, stiffness, lines))
    }

    /// Lets those of a `part` of the joint hang free.
    pub fn hang(&mut self, part: Range<usize>) {
        // What has just closed bears nothing, wherever its anchor is.
        self.pressed[part].fill(0.0);
    }

    /// Lets all of them bear only a `part` of what they do where the joint slid to `at` [m].
    pub fn weaken(&mut self, part: f64, at: impl Fn(f64) -> f64) {
        for (n, anchor) in self.anchors.iter_mut().enumerate() {
            let slide = at(PLACES[n]);
            *anchor = slide + part * (*anchor - slide);
        }
    }
}

/// Place of each fibre, 0 … 1.
const PLACES: [f64; FIBRES] = {
    let mut places = [0.0; FIBRES];
    let mut n = 0;
    while n < FIBRES {
        places[n] = n as f64 / (FIBRES - 1) as f64;
        n += 1;
    }
    places
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Fibres of a joint that slides and opens by straight lines, followed several at once where they are pressed all over and not at all where they hang free, do what
    /// they do one by one: to rounding, over fifty steps of any opening, also at no pressure and where it opens at a fibre.
    #[test]
    fn quick_ways_do_what_each_fibre_does_alone() {
        let (stiffness, mu, mut seed) = (3e9, 0.6, 7_u64);
        let mut next = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / (1u64 << 30) as f64 - 1.0
        };
        let (mut sticks, mut slides, mut opens) = (0, 0, 0);
        for _ in 0..100 {
            let [mut quick, mut slow] = [Fibres::new(true), Fibres::new(true)];
            for step in 0..50 {
                let sunk = match step % 5 {
                    0 => [0.0, 1e-5 * next()],
                    1 => [1e-5, -1e-5],
                    _ => [1e-5 * next(), 1e-5 * next()],
                };
                let slide = [1e-5 * next(), 1e-6 * next()];
                let at = |x: f64| sunk[0] + x * (sunk[1] - sunk[0]);
                let around = |x: f64| {
                    let [pressed, sprung] = above([(x - HALF).max(0.0), (x + HALF).min(1.0)].map(at));
                    Stands { slide: slide[0] + x * slide[1], most: mu * stiffness * sprung, pressed }
                };
                let expected = slow.follow(stiffness, 0..FIBRES, around);
                let [closed, begins, hangs] = parts(sunk);
                assert_eq!(closed.len() + begins.len() + hangs.len(), FIBRES, "{sunk:?}");
                opens += hangs.len();
                quick.hang(hangs);
                let press = [stiffness * sunk[0], stiffness * (sunk[1] - sunk[0])];
                let lines = Lines { slide, press, limit: f64::INFINITY, mu };
                let found = quick.follow_pressed(stiffness, closed.clone(), &lines);
                let found = found.and(quick.follow(stiffness, begins, around));
                // At the ends the quick way takes the pressure there for that of half a fibre: 1/128 of 1/64.
                let size = stiffness * 2e-5;
                assert!((found.whole - expected.whole).abs() < 1e-4 * size, "{found:?} {expected:?} {sunk:?}");
                assert!((found.energy - expected.energy).abs() < 1e-4 * size * 2e-5, "{found:?} {expected:?}");
                for n in closed.filter(|n| (1..FIBRES - 1).contains(n)) {
                    let stretch = |fibres: &Fibres| fibres.anchors[n] - slide[0] - PLACES[n] * slide[1];
                    assert!((stretch(&quick) - stretch(&slow)).abs() < 1e-15 && quick.pressed[n] == 1.0);
                    let most = mu * stiffness * at(PLACES[n]);
                    let slid = (stiffness * stretch(&quick)).abs() > most * (1.0 - 1e-9);
                    *if slid { &mut slides } else { &mut sticks } += 1;
                }
            }
        }
        assert!(sticks > 1000 && slides > 1000 && opens > 1000, "{sticks} {slides} {opens}");
    }
}
