//! Friction along a joint on springs, place by place: fibres that stick, slide or hang free.
//!
//! The contact points of a zone say what it bears across. Along, what opens lets go what it bore, what closes begins with nothing, and where pressure falls to 0
//! some of a joint slides under any shear. Points that move with the zones cannot tell which of it that was; fibres that stay where they are can.
//!
//! (P13)  τ = clamp(k_t (s − a), ±μ p),   a = s − τ/k_t
//!
//! with the slide s of the joint there, the pressure p and the anchor a, the slide at which the fibre bears nothing.

use std::ops::Range;

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
        for (n, own) in self.anchors.iter_mut().enumerate() {
            *own = anchor(place(n));
        }
    }

    /// Takes those of a `part` of the joint along to where it slid to, with springs of `stiffness` over all of it [N/m]: `at` says how it stands around each. What would
    /// bear more than friction lets it slides.
    #[inline(always)]
    pub fn follow(&mut self, stiffness: f64, part: Range<usize>, at: impl Fn(f64) -> Stands) -> Sheared {
        if part.is_empty() {
            return Sheared::default();
        }
        // What each bears [N] and stores twice [J]: no sum is in the way of taking several at once.
        let mut sheared = [[0.0; FIBRES]; 2];
        let [borne, energy] = sheared.each_mut().map(|all| &mut all[part.clone()]);
        let states = self.anchors[part.clone()].iter_mut().zip(&mut self.pressed[part.clone()]);
        for ((n, (anchor, pressed)), (borne, energy)) in part.zip(states).zip(borne.iter_mut().zip(energy)) {
            let Stands { slide, most, pressed: now } = at(place(n));
            let before = std::mem::replace(pressed, now);
            // What has just closed bears nothing yet.
            let stretch = (*anchor - slide) * if now > before { before / now } else { 1.0 };
            let k = now * stiffness;
            let sticks = k * stretch;
            *borne = if sticks > most { most } else { sticks };
            *borne = if *borne < -most { -most } else { *borne };
            let slid = if k == 0.0 { 0.0 } else { *borne / k };
            // Rounding would move what sticks.
            let stretch = if *borne == sticks && k != 0.0 { stretch } else { slid };
            *anchor = slide + stretch;
            *energy = *borne * stretch;
        }
        let [whole, energy] = sheared.map(|all| {
            let fours = all.chunks(4).fold([0.0; 4], |mut sums, four| {
                four.iter().zip(&mut sums).for_each(|(own, sum)| *sum += own);
                sums
            });
            let ends = 0.5 * (all[0] + all[FIBRES - 1]);
            (fours[0] + fours[1] + (fours[2] + fours[3]) - ends) / (FIBRES - 1) as f64
        });
        Sheared { whole, energy: 0.5 * energy }
    }

    /// Lets those of a `part` of the joint hang free.
    pub fn hang(&mut self, part: Range<usize>) {
        // What has just closed bears nothing, wherever its anchor is.
        self.pressed[part].fill(0.0);
    }

    /// Lets all of them bear only a `part` of what they do where the joint slid to `at` [m].
    pub fn weaken(&mut self, part: f64, at: impl Fn(f64) -> f64) {
        for (n, anchor) in self.anchors.iter_mut().enumerate() {
            let slide = at(place(n));
            *anchor = slide + part * (*anchor - slide);
        }
    }
}

/// Place of a fibre, 0 … 1.
fn place(n: usize) -> f64 {
    // Whole numbers so small are turned into others several at once.
    f64::from(n as u16) / (FIBRES - 1) as f64
}
