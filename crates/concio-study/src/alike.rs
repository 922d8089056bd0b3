//! Motions of a study that are one motion: its questions take motions as independent, and one that is there twice counts
//! twice.
//!
//! Compared is what moves the base, as the runs have it. Two accelerograms are alike where one is the other times a
//! factor over what they have in common, in whatever intervals each has it, where both begin together or their largest
//! samples fall together. Motions in closed form
//! are alike where their numbers are, but for strength and start.

use std::path::Path;

use concio::Result;
use concio::case::{Case, Motion, Signal, canonical_json};
use concio::ground::Library;
use concio::ground::signal::compile_with;
use concio::quantity::{Acceleration, Length, Time, Velocity};
use rayon::prelude::*;

use crate::factors::Over;
use crate::file::DesignKind;
use crate::intensity::Sampled;
use crate::plan::Plan;

/// Correlation from which on two accelerograms are one, and from which on they are told to resemble each other: filters and
/// coarser intervals change one so much.
const ONE: f64 = 0.9999;
const NEAR: f64 = 0.98;
/// The same of samples to either side of the peak, with which all pairs are compared first.
const AT_FIRST: f64 = 0.8;
const WINDOW: usize = 50;
/// Part of either's energy that what two accelerograms have in common holds at least.
const SHARE: f64 = 0.5;
/// Relative difference of strengths that are one: of accelerograms, whose samples may lie elsewhere.
const EQUAL: f64 = 1e-3;
/// Rounds in which the shift between two accelerograms is found to a fraction of an interval.
const ROUNDS: usize = 20;

/// Two motions that are alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Places in the study file, rising.
    pub motions: [usize; 2],
    /// Strength of the second over that of the first; below 0 where one is the other with its sign turned.
    pub factor: f64,
    /// Their correlation, 1 of one motion.
    pub correlation: f64,
}

impl Pair {
    /// Whether they are one motion, but for its strength and sign.
    pub fn is_one(&self) -> bool {
        self.correlation >= ONE
    }

    /// Whether they are one motion of one strength.
    pub fn is_equal(&self) -> bool {
        self.is_one() && (self.factor - 1.0).abs() <= EQUAL
    }
}

/// The pairs of motions of a study that are alike, each motion with the first that it is like. Motions that cannot be read are
/// left to who runs them.
pub fn pairs(plan: &Plan) -> Vec<Pair> {
    let motions = plan.file.study.motions.len();
    if motions < 2 {
        return Vec::new();
    }
    let shapes: Vec<Option<Shape>> =
        (0..motions).into_par_iter().map(|m| Shape::of(&case(plan, m)?, &plan.library)).collect();
    let first = |second: usize| {
        let likeness = |first: usize| {
            let [factor, correlation] = shapes[first].as_ref()?.likeness(shapes[second].as_ref()?)?;
            Some(Pair { motions: [first, second], factor, correlation })
        };
        let alike: Vec<Pair> = (0..second).filter_map(likeness).collect();
        let found = alike.iter().find(|p| p.is_equal()).or_else(|| alike.iter().find(|p| p.is_one()));
        found.or(alike.first()).copied()
    };
    (1..motions).into_par_iter().filter_map(first).collect()
}

/// The wall under a motion, all else as the wall file has it; where that is no wall, as the first run with it.
fn case(plan: &Plan, motion: usize) -> Option<Case> {
    let factor = plan.factors.iter().find(|f| f.key == "motion")?;
    let Over::Levels(levels) = &factor.over else { return None };
    plan.changed(&levels.get(motion)?.changes, 1.0).ok().or_else(|| {
        let (changes, _) = plan.setting(run(plan, motion)?);
        plan.changed(&changes, 1.0).ok()
    })
}

/// The first run with a motion.
fn run(plan: &Plan, motion: usize) -> Option<usize> {
    (0..plan.points.len()).find(|&number| plan.motion(number) == Some(motion))
}

/// Whether the same is run under both: in a list each motion may have a wall of its own.
pub fn of_one_wall(plan: &Plan, motions: [usize; 2]) -> bool {
    if plan.file.study.design.kind != DesignKind::List {
        return true;
    }
    let wall = |motion: usize| -> Option<String> {
        let mut case = plan.case(run(plan, motion)?).ok()?;
        case.motion = Motion::default();
        Some(canonical_json(&case))
    };
    let [a, b] = motions.map(wall);
    a == b
}

/// What moves the base.
struct Shape {
    base: Part,
    vertical: Part,
}

/// One direction of it.
enum Part {
    None,
    /// In closed form: all its numbers but strength and start, and its strength.
    Form(String, f64),
    Samples(Samples),
}

/// An accelerogram over a run.
struct Samples {
    dt: f64,
    a: Vec<f64>,
    peak: usize,
    /// Σ a².
    energy: f64,
}

impl Shape {
    fn of(case: &Case, library: &Library) -> Option<Self> {
        let duration = case.motion.duration.map(Time::si);
        let part = |signal: &Signal| Part::of(signal, duration, library).ok();
        Some(Shape { base: part(&case.motion.base)?, vertical: part(&case.motion.vertical)? })
    }

    /// The other over this one, and their correlation; none where they are not alike.
    fn likeness(&self, other: &Shape) -> Option<[f64; 2]> {
        if let (Part::None, Part::None) = (&self.base, &other.base) {
            return self.vertical.likeness(&other.vertical);
        }
        let base = self.base.likeness(&other.base)?;
        if let (Part::None, Part::None) = (&self.vertical, &other.vertical) {
            return Some(base);
        }
        let vertical = self.vertical.likeness(&other.vertical)?;
        let together = ((base[0] / vertical[0]).abs() - 1.0).abs() <= EQUAL;
        let factor = if vertical[0] < 0.0 { -base[0].abs() } else { base[0] };
        together.then_some([factor, base[1].min(vertical[1])])
    }
}

impl Part {
    fn of(signal: &Signal, duration: Option<f64>, library: &Library) -> Result<Self> {
        if *signal == Signal::None {
            return Ok(Part::None);
        }
        let motion = compile_with(signal, Path::new(""), library)?;
        let length = duration.unwrap_or(f64::INFINITY);
        if let Signal::Record(_) | Signal::Synthetic(_) = signal {
            // Not what comes after the last sample: where one record is cut, the other may go on.
            let length = motion.end().map_or(length, |end| end.min(length));
            let Sampled { dt, acceleration: a, .. } = Sampled::of(&motion, length);
            let peak = (0..a.len()).max_by(|&i, &j| a[i].abs().total_cmp(&a[j].abs())).unwrap_or_default();
            let energy = a.iter().map(|a| a * a).sum();
            return Ok(Part::Samples(Samples { dt, a, peak, energy }));
        }
        let (form, size) = unit(signal);
        // What goes on for ever is as long as its run.
        let cut = if motion.end().is_none_or(|end| end > length) { length } else { 0.0 };
        Ok(Part::Form(format!("{form:?} {cut}"), size))
    }

    fn likeness(&self, other: &Part) -> Option<[f64; 2]> {
        match (self, other) {
            (Part::Form(a, of_a), Part::Form(b, of_b)) if a == b && *of_a != 0.0 => Some([of_b / of_a, 1.0]),
            (Part::Samples(a), Part::Samples(b)) => match a.dt >= b.dt {
                true => a.likeness(b),
                false => b.likeness(a).map(|[factor, correlation]| [1.0 / factor, correlation]),
            },
            _ => None,
        }
    }
}

/// A motion in closed form of strength 1 that starts at once, and its strength.
fn unit(signal: &Signal) -> (Signal, f64) {
    fn acceleration(a: &mut Acceleration) -> f64 {
        std::mem::replace(a, Acceleration::from_si(1.0)).si()
    }
    fn length(u: &mut Length) -> f64 {
        std::mem::replace(u, Length::from_si(1.0)).si()
    }
    let mut unit = signal.clone();
    let size = match &mut unit {
        Signal::Sine(sine) => {
            let of_both = (sine.acceleration.as_mut().map(acceleration), sine.amplitude.as_mut().map(length));
            of_both.0.or(of_both.1).unwrap_or_default()
        }
        Signal::Ramp(ramp) => {
            ramp.start = Time::from_si(0.0);
            length(&mut ramp.amplitude)
        }
        Signal::Tilt(tilt) => {
            tilt.start = Time::from_si(0.0);
            acceleration(&mut tilt.acceleration)
        }
        Signal::Path(path) => {
            let size = path.displacements.iter().map(|u| u.si()).find(|u| *u != 0.0).unwrap_or_default();
            // Nine digits: a quotient has rounding in the last ones.
            let share = |v: f64| (v / size * 1e9).round() / 1e9;
            path.displacements.iter_mut().for_each(|u| *u = Length::from_si(share(u.si())));
            path.speed = Velocity::from_si(share(path.speed.si()).abs());
            size
        }
        Signal::Pulse(pulse) => {
            pulse.start = Time::from_si(0.0);
            acceleration(&mut pulse.acceleration)
        }
        Signal::Sweep(sweep) => acceleration(&mut sweep.acceleration),
        Signal::None | Signal::Record(_) | Signal::Synthetic(_) => 0.0,
    };
    (unit, size)
}

/// Σ x², Σ y² and Σ x y of what two accelerograms have in common.
struct Sums([f64; 3]);

impl Sums {
    fn correlation(&self) -> f64 {
        let Sums([xx, yy, xy]) = self;
        if *xx > 0.0 && *yy > 0.0 { xy / (xx * yy).sqrt() } else { 0.0 }
    }
}

impl Samples {
    /// Of some samples with those of another that come `lag` [s] later there.
    fn sums(&self, other: &Samples, lag: f64, from: usize, to: usize) -> Sums {
        let mut sums = [0.0; 3];
        let last = other.a.len() as f64 - 1.0;
        for (k, x) in self.a.iter().enumerate().take(to).skip(from) {
            // An instant that is a sample but for rounding is that sample.
            let place = (k as f64 * self.dt + lag) / other.dt + 1e-9;
            if place < 0.0 || place > last + 2e-9 {
                continue;
            }
            let at = place as usize;
            let (now, next) = (other.a[at], other.a.get(at + 1).copied().unwrap_or(other.a[at]));
            let y = now + (place - at as f64) * (next - now);
            sums[0] += x * x;
            sums[1] += y * y;
            sums[2] += x * y;
        }
        Sums(sums)
    }

    /// The correlation of all that they have in common; 0 where that is the smaller part of either.
    fn correlation(&self, other: &Samples, lag: f64) -> (f64, Sums) {
        let sums = self.sums(other, lag, 0, self.a.len());
        let Sums([xx, yy, _]) = &sums;
        let common = *xx >= SHARE * self.energy && yy * self.dt >= SHARE * other.energy * other.dt;
        (if common { sums.correlation() } else { 0.0 }, sums)
    }

    /// Another of no longer interval over this one, and their correlation; none where they are not alike.
    fn likeness(&self, other: &Samples) -> Option<[f64; 2]> {
        let peaks = other.peak as f64 * other.dt - self.peak as f64 * self.dt;
        let around = [self.peak.saturating_sub(WINDOW), self.peak + WINDOW + 1];
        let mut best: Option<[f64; 2]> = None;
        for lag in [0.0, peaks] {
            if self.sums(other, lag, around[0], around[1]).correlation().abs() < AT_FIRST {
                continue;
            }
            let mut found = self.correlation(other, lag);
            if found.0.abs() >= AT_FIRST && found.0.abs() < ONE {
                // Peaks are met to half an interval: between samples of the other lies the shift that fits best.
                let (mut low, mut high) = (lag - self.dt, lag + self.dt);
                for _ in 0..ROUNDS {
                    let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                    let [left, right] = thirds.map(|lag| self.correlation(other, lag).0.abs());
                    if left < right { low = thirds[0] } else { high = thirds[1] }
                }
                let shifted = self.correlation(other, 0.5 * (low + high));
                if shifted.0.abs() > found.0.abs() {
                    found = shifted;
                }
            }
            let (correlation, Sums([xx, _, xy])) = found;
            if correlation.abs() >= NEAR && best.is_none_or(|[_, known]| correlation.abs() > known) {
                best = Some([xy / xx, correlation.abs()]);
            }
        }
        best
    }
}
