//! How far a wall leans: the displacement of its tops relative to the base, at its largest and what is left of it.
//!
//! Under a top beam that moves, driven or with a mass, the top is that beam, and its height that of the wall: what a laboratory
//! measures. The top of a panel without such a beam is its top course: the mean displacement of the centres of its blocks, over
//! their mean height above the base, so that of a panel that turns as one piece the drift is its angle.

use serde::{Deserialize, Serialize};

/// Part of a run, at its end, over which the residual drift is a mean: swings cancel there.
const SETTLED: f64 = 0.1;

/// The tops of a wall.
#[derive(Debug, Clone, Default)]
pub struct Tops {
    /// Blocks of all top courses, by their indices.
    courses: Vec<u32>,
    /// What the displacement of the whole wall is read off: its beam, or all top courses.
    whole: Vec<u32>,
    /// The beam where it moves, and the panels that are not under it.
    tops: Vec<Top>,
}

/// A top of a wall.
#[derive(Debug, Clone, Default)]
pub struct Top {
    /// Its panel, or [`BEAM`].
    pub name: String,
    /// Unknowns whose mean displacement is that of the top.
    pub unknowns: Vec<u32>,
    /// [m]
    pub height: f64,
}

/// What a beam that moves is called.
pub const BEAM: &str = "beam";

/// How a top has gone so far.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lean {
    /// Displacement of its top now, and where it was largest [m].
    now: f64,
    peak: f64,
    /// When that was [s].
    time: f64,
    /// ∫ z dt over the last part of the run [m s], and its ends there [m].
    sum: f64,
    low: f64,
    high: f64,
}

impl Lean {
    /// Of a top at rest.
    pub const NONE: Lean =
        Lean { now: 0.0, peak: 0.0, time: 0.0, sum: 0.0, low: f64::INFINITY, high: f64::NEG_INFINITY };

    /// Takes the step from `from` to `to` [s], at whose end the top is at `top` [m]; the last part of the run begins at `settles`.
    fn follow(&mut self, [from, to]: [f64; 2], settles: f64, top: f64) {
        if top.abs() > self.peak.abs() {
            (self.peak, self.time) = (top, to);
        }
        if to > settles {
            let start = from.max(settles);
            let part = if to > from { (start - from) / (to - from) } else { 1.0 };
            let before = self.now + part * (top - self.now);
            self.sum += 0.5 * (to - start) * (before + top);
            self.low = self.low.min(before).min(top);
            self.high = self.high.max(before).max(top);
        }
        self.now = top;
    }
}

impl Tops {
    /// Of the blocks in top courses, of what the displacement of the whole wall is read off, and of the tops themselves.
    pub fn new(courses: Vec<u32>, whole: Vec<u32>, tops: Vec<Top>) -> Self {
        Tops { courses, whole, tops }
    }

    /// Mean of a quantity of blocks over all top courses.
    #[inline]
    pub fn of_courses(&self, of: impl Fn(usize) -> f64) -> f64 {
        mean(&self.courses, of)
    }

    /// Displacement of the top of the whole wall: of a beam that moves, else the mean over all top courses.
    #[inline]
    pub fn of_wall(&self, z: impl Fn(usize) -> f64) -> f64 {
        mean(&self.whole, z)
    }

    /// Tops that have yet to move.
    pub fn at_rest(&self) -> Vec<Lean> {
        vec![Lean::NONE; self.tops.len()]
    }

    /// Takes the step from `span[0]` to `span[1]` [s], at whose end displacement i is `z(i)` [m], of a run whose residual counts from
    /// `settles` [s] on.
    pub fn follow(&self, leans: &mut [Lean], span: [f64; 2], settles: f64, z: impl Fn(usize) -> f64) {
        for (top, lean) in self.tops.iter().zip(leans) {
            lean.follow(span, settles, mean(&top.unknowns, &z));
        }
    }

    /// What came of it in a run until `end` [s], which `completes` where the residual is one.
    pub fn rows(&self, leans: &[Lean], settles: f64, end: f64, completes: bool) -> Vec<DriftRow> {
        let row = |(top, lean): (&Top, &Lean)| {
            let (residual, swing) = match end > settles {
                _ if !completes => (f64::INFINITY, f64::INFINITY),
                true => {
                    let mean = lean.sum / (end - settles);
                    (mean, (lean.high - mean).max(mean - lean.low))
                }
                false => (lean.now, 0.0),
            };
            // Of two zeros neither has a sign.
            let [peak, residual, swing] = [lean.peak, residual, swing].map(|value| value + 0.0);
            DriftRow { top: top.name.clone(), height: top.height, peak, time: lean.time, residual, swing }
        };
        self.tops.iter().zip(leans).map(row).collect()
    }
}

/// When the last part of a run of that duration begins [s]: one without inertia swings nowhere, and its end is what is left.
pub fn settles(duration: f64, still: bool) -> f64 {
    if still { duration } else { (1.0 - SETTLED) * duration }
}

#[inline]
fn mean(blocks: &[u32], of: impl Fn(usize) -> f64) -> f64 {
    blocks.iter().map(|&i| of(i as usize)).sum::<f64>() / blocks.len().max(1) as f64
}

/// How far a top of the wall went relative to the base, at the ends of steps (see the module).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DriftRow {
    /// Name of the panel, or `beam`.
    pub top: String,
    /// Its height above the base [m]: displacements over it are drifts.
    pub height: f64,
    /// Displacement of the top when it was farthest from its place [m], until a collapse.
    pub peak: f64,
    /// When that was [s].
    pub time: f64,
    /// Mean over the last tenth of the run, without inertia at its end [m]; infinite of a run that stopped early and of a wall that
    /// collapsed.
    pub residual: f64,
    /// By how much it left that mean there, at most [m].
    pub swing: f64,
}

impl DriftRow {
    /// A displacement of the top as a drift, a pure number.
    pub fn ratio(&self, displacement: f64) -> f64 {
        if self.height > 0.0 { displacement / self.height } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A top that swings as 3 mm + 2 mm cos(2π t/T): the peak is at the start, and in the last tenth of ten periods there is one.
    #[test]
    fn what_is_left_of_a_swing_is_its_mean() {
        let at = |t: f64| 3e-3 + 2e-3 * (std::f64::consts::TAU * t).cos();
        let top = Top { name: "p1".into(), unknowns: vec![0], height: 2.0 };
        let tops = Tops { tops: vec![top], ..Tops::default() };
        let mut leans = tops.at_rest();
        let settles = settles(10.0, false);
        // Steps that do not meet the beginning of the last tenth.
        let ends: Vec<f64> = (0..=3700).map(|k| (k as f64 / 370.0).min(10.0)).collect();
        tops.follow(&mut leans, [0.0, 0.0], settles, |_| at(0.0));
        for step in ends.windows(2) {
            tops.follow(&mut leans, [step[0], step[1]], settles, |_| at(step[1]));
        }
        let row = &tops.rows(&leans, settles, 10.0, true)[0];
        assert_eq!((row.height, row.peak, row.time), (2.0, 5e-3, 0.0));
        assert!((row.residual - 3e-3).abs() < 1e-6 && (row.swing - 2e-3).abs() < 1e-6, "{row:?}");
        // Cut short there is no residual; without inertia it is the end.
        assert_eq!(tops.rows(&leans, settles, 9.5, false)[0].residual, f64::INFINITY);
        assert_eq!(tops.rows(&leans, 10.0, 10.0, true)[0].residual, at(10.0));
    }
}
