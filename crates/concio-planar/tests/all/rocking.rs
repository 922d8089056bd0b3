//! A block that rocks on its base, against closed forms and against integrations of its equation by another program.
//!
//! With R the distance of the corner from the centre, α the slenderness angle, I the moment of inertia about the centre and
//! i = I/(m R²), the equation of motion knows p² = g/(R (1 + i)), and an impact without slip and without rebound leaves
//! η = (i + cos 2α)/(1 + i) of the angular velocity (Housner 1963: i = 1/3). Nothing else can be left by what pushes from
//! below: a push at the corner that lifts would leave more, none leaves less. A given η is therefore that of a block whose
//! mass lies as it has to, or that of a joint which loses more as it rocks (P8).

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use concio_planar::G;
use concio_planar::body::Body;
use concio_planar::joint::Normal;
use concio_planar::motion::{Forcing, Motion, Setting, System};
use concio_planar::shape::Place;
use concio_verified::{agrees, farthest};
use serde_json::Value;

/// Half sizes [m], i, and η of its joint.
#[derive(Clone, Copy)]
struct Rocker {
    b: f64,
    h: f64,
    i: f64,
    joint: f64,
}

impl Rocker {
    fn homogeneous(b: f64, h: f64) -> Self {
        Rocker { b, h, i: 1.0 / 3.0, joint: 1.0 }
    }

    /// Of 1 m from corner to centre, that keeps η of its angular velocity.
    fn keeping(eta: f64, alpha: f64) -> Self {
        Rocker { b: alpha.sin(), h: alpha.cos(), i: ((2.0 * alpha).cos() - eta) / (eta - 1.0), joint: 1.0 }
    }

    /// So slender that it moves by the linear equations, whose only loss is that of its joint.
    fn slender(eta: f64) -> Self {
        Rocker { joint: eta, ..Rocker::homogeneous(0.02, 1.0) }
    }

    fn alpha(self) -> f64 {
        self.b.atan2(self.h)
    }

    fn radius(self) -> f64 {
        self.b.hypot(self.h)
    }

    fn p(self) -> f64 {
        (G / (self.radius() * (1.0 + self.i))).sqrt()
    }

    /// On its right corner, turned by `share` of α, on a base that it does not slip on.
    fn tilted(self, share: f64, step: f64) -> Motion {
        self.rebounding(0.0, share, step)
    }

    /// The same on a joint that gives back `restitution` of a fall.
    fn rebounding(self, restitution: f64, share: f64, step: f64) -> Motion {
        let Rocker { b, h, i, joint } = self;
        let mass = 1000.0;
        let body = Body {
            name: "block".into(),
            centre: [0.0, h],
            corners: vec![[-b, -h], [b, -h], [b, h], [-b, h]],
            mass,
            inertia: i * mass * (b * b + h * h),
        };
        let mut system = System::dry(&[body], 1e3);
        system.other.normal = Normal::Rigid { restitution, rocking: joint };
        let mut motion = Motion::new(&system, Setting::new(step));
        let angle = -share * self.alpha();
        let (s, c) = angle.sin_cos();
        motion.put(0, Place { centre: [b - c * b - s * h, -s * b + c * h], angle });
        motion
    }
}

/// Of a block let go: when it passes through upright [s], how fast in rad/s, and its largest turn before each passage, over
/// α.
struct Rocks {
    times: Vec<f64>,
    speeds: Vec<f64>,
    peaks: Vec<f64>,
    motion: Motion,
}

fn rocks(rocker: Rocker, share: f64, step: f64, passages: usize) -> Rocks {
    let mut motion = rocker.tilted(share, step);
    let (mut times, mut speeds, mut peaks) = (Vec::new(), Vec::new(), Vec::new());
    let (mut last, mut speed, mut peak) = (motion.places[0].angle, 0.0, share);
    while times.len() < passages && motion.time < 20.0 {
        motion.step(Forcing::default());
        let angle = motion.places[0].angle;
        if last.signum() != angle.signum() {
            times.push(motion.time - step * angle / (angle - last));
            speeds.push(speed);
            peaks.push(peak);
            peak = 0.0;
        }
        peak = f64::max(peak, angle.abs() / rocker.alpha());
        (last, speed) = (angle, motion.velocities[0][2].abs());
    }
    Rocks { times, speeds, peaks, motion }
}

fn reference(name: &str) -> Option<Value> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("CONCIO_SHARED").map_or(beside, PathBuf::from);
    let Ok(text) = std::fs::read_to_string(folder.join("reference").join(name)) else {
        concio_verified::skip(&format!("{name} (shared/ not found)"));
        return None;
    };
    Some(serde_json::from_str(&text).expect("JSON"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

fn close(what: &str, found: f64, expected: f64, within: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error <= within, "{what}: {found} instead of {expected} (relative error {error:.1e})");
}

fn unbalanced(motion: &Motion) -> f64 {
    let account = &motion.account;
    (motion.kinetic() - account.input + account.friction + account.impact).abs()
}

/// Housner's block (analytic.json, A7): quarter period and speed of impact from five angles, and what is left from peak to
/// peak. The listed peaks are those of the equation for small angles, which are up to 0.58 % lower than those with the energy of any angle.
#[test]
fn a_block_rocks_as_housner_says() {
    let Some(all) = reference("analytic.json") else { return };
    let known = &all["A7_housner"];
    let rocker = Rocker::homogeneous(number(&known["b_half"]), number(&known["h_half"]));
    close("p", rocker.p(), number(&known["p"]), 1e-12);
    let [shares, quarters, speeds] =
        ["theta0_over_alpha", "quarter_period_nonlinear", "impact_speed_energy"].map(|key| numbers(&known[key]));
    for ((share, quarter), speed) in shares.iter().zip(quarters).zip(speeds) {
        let found = rocks(rocker, *share, 1e-4, 1);
        close(&format!("quarter period from {share}"), found.times[0], quarter, 1e-3);
        close(&format!("speed from {share}"), found.speeds[0], speed.abs(), 1e-3);
    }
    let found = rocks(rocker, 0.5, 5e-5, 7);
    let depth = |share: f64| (rocker.alpha() * (1.0 - share)).cos() - rocker.alpha().cos();
    let listed = numbers(&known["peak_sequence_linear_theta_over_alpha_from_0p5"]);
    let mut left = depth(0.5);
    for (peak, listed) in found.peaks.iter().zip(listed) {
        let (mut low, mut high) = (0.0, 0.6);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *if depth(middle) < left { &mut low } else { &mut high } = middle;
        }
        close("peak", *peak, low, 1e-3);
        close("peak of small angles", low, listed, 5.8e-3);
        left *= number(&known["r_energy"]);
    }
    for pair in found.peaks.windows(2) {
        close("energy left", depth(pair[1]) / depth(pair[0]), number(&known["r_energy"]), 2e-3);
    }
    assert!(unbalanced(&found.motion) < 1e-6 * found.motion.account.impact);
    assert_eq!(found.motion.counters.unsolved, 0);
}

/// A block of 0.4 m × 1.6 m from 0.6 α: time between its first and its third impact, and the peak between the first two, by
/// an integration of the equation of motion.
#[test]
fn a_full_cycle_of_a_free_block() {
    let found = rocks(Rocker::homogeneous(0.2, 0.8), 0.6, 1e-4, 3);
    let against = "integration of the equation of motion by another program";
    let cycle = found.times[2] - found.times[0];
    agrees!("Rocking: block of 0.4 m × 1.6 m from 0.6 α, full cycle", against, "s", cycle, 1.4828, 1e-3);
    agrees!("Rocking: block of 0.4 m × 1.6 m from 0.6 α, second peak", against, "α", found.peaks[1], 0.4512, 1e-2);
}

/// While a block turns about one corner nothing has to be found out: one solution, and another for what ρ gives way by.
#[test]
fn turning_on_goes_on_as_it_did() {
    let mut motion = Rocker::homogeneous(0.3, 0.9).tilted(0.5, 1e-3);
    for _ in 0..400 {
        motion.step(Forcing { base: [0.0; 2], held: 0.0 });
    }
    assert!(motion.places[0].angle < -0.01, "still on its first corner: {}", motion.places[0].angle);
    let counters = &motion.counters;
    assert!(counters.unsolved == 0 && counters.iterations <= 3 * counters.steps, "{counters:?}");
}

/// The time of the first fall is off by what the step is, or less: an impact has its place somewhere within one.
#[test]
fn rocking_converges() {
    let off = |h: f64| (rocks(Rocker::homogeneous(0.3, 0.9), 0.5, h, 1).times[0] / 0.47433765843173 - 1.0).abs();
    let [coarse, fine] = [1e-3, 1e-4].map(off);
    assert!(fine < 0.2 * coarse && coarse < 2e-4, "{coarse:e} {fine:e}");
}

/// A joint with η of its own leaves that of the angular velocity (P8), unless the impact leaves less; what it takes is in
/// the account, and it neither delays uplift nor stops a block.
#[test]
fn a_joint_takes_more_than_the_impact() {
    let left = |joint: f64| {
        let rocker = Rocker { joint, ..Rocker::homogeneous(0.2, 0.8) };
        let found = rocks(rocker, 0.8, 1e-4, 5);
        let account = &found.motion.account;
        assert!(unbalanced(&found.motion) < 1e-6 * account.impact, "{account:?}");
        assert_eq!(found.motion.counters.unsolved, 0);
        let depth = |share: f64| (rocker.alpha() * (1.0 - share)).cos() - rocker.alpha().cos();
        let ratios = found.peaks.windows(2).map(|pair| (depth(pair[1]) / depth(pair[0])).sqrt());
        ratios.collect::<Vec<f64>>()
    };
    let alpha = 0.25f64.atan();
    let housner = (1.0 / 3.0 + (2.0 * alpha).cos()) / (4.0 / 3.0);
    for (joint, expected) in [(0.8, 0.8), (0.5, 0.5), (0.99, housner), (1.0, housner)] {
        let off = farthest(left(joint).into_iter().map(|ratio| (ratio / expected, 1.0)));
        let subject = format!("Rocking: angular velocity left by impacts, largest error over it; η = {joint}");
        agrees!(subject, "the lesser of η and (i + cos 2α)/(1 + i) (Housner 1963)", "", off, 0.0, abs: 5e-3);
    }
}

/// With a rebound e the end that lands parts again, and the turn still keeps η of what it was; nothing less than nothing is left.
#[test]
fn a_joint_that_rebounds_keeps_its_turn() {
    let step = 1e-5;
    for (restitution, eta) in [(0.0, 0.6), (0.3, 0.6), (0.0, 0.0)] {
        let mut motion = Rocker { joint: eta, ..Rocker::homogeneous(0.2, 0.8) }.rebounding(restitution, 0.5, step);
        let mut before = motion.velocities[0][2];
        let kept = loop {
            motion.step(Forcing::default());
            let now = motion.velocities[0][2];
            // From one step to the next gravity alone changes little.
            if (now / before - 1.0).abs() > 0.05 && motion.time > 0.2 {
                motion.step(Forcing::default());
                break motion.velocities[0][2] / before;
            }
            before = now;
            assert!(motion.time < 2.0, "it falls");
        };
        let subject = format!("Rocking: angular velocity left by an impact; η = {eta}, e = {restitution}");
        agrees!(subject, "η (P8)", "", kept, eta, abs: 5e-3);
        assert!(unbalanced(&motion) < 1e-6 * motion.account.impact);
    }
}

/// Uplift needs an acceleration of g b/h: one below it leaves the block where it is, one above it turns it.
#[test]
fn a_block_lifts_above_its_slenderness() {
    for (b, h) in [(0.3, 0.9), (0.2, 0.8)] {
        let turned = |share: f64| {
            let mut motion = Rocker::homogeneous(b, h).tilted(0.0, 1e-3);
            let mut most: f64 = 0.0;
            for _ in 0..200 {
                motion.step(Forcing { base: [share * b / h * G * 1e-3, 0.0], held: 0.0 });
                most = most.max(motion.places[0].angle.abs());
            }
            most
        };
        // By what its edge yields under all of the weight.
        assert!(turned(0.9999) < 2e-8, "{:e}", turned(0.9999));
        assert!(turned(1.0001) > 1e-6, "{:e}", turned(1.0001));
    }
}

/// Acceleration of the base over α g, by the phase of a pulse; `end` is where it ends.
#[derive(Clone, Copy)]
enum Pulse {
    Rectangle,
    HalfSine,
    OneSine,
}

impl Pulse {
    fn end(self) -> f64 {
        match self {
            Pulse::Rectangle => 1.0,
            Pulse::HalfSine => PI,
            Pulse::OneSine => TAU,
        }
    }

    /// Integral of the pulse up to a phase.
    fn velocity(self, phase: f64) -> f64 {
        let phase = phase.min(self.end());
        match self {
            Pulse::Rectangle => phase,
            Pulse::HalfSine | Pulse::OneSine => 1.0 - phase.cos(),
        }
    }
}

/// How a block came out of a pulse.
#[derive(Debug, PartialEq)]
enum Fate {
    /// Overturned after so many impacts.
    Overturned(usize),
    /// Its largest turn, over α.
    Stands(f64),
}

/// After a pulse of `amplitude` α g whose phase grows by `rate` p in a second.
fn pulsed(rocker: Rocker, pulse: Pulse, amplitude: f64, rate: f64) -> Fate {
    let (alpha, p) = (rocker.alpha(), rocker.p());
    let step = 5e-4 / p;
    let omega = rate * p;
    let mut motion = rocker.tilted(0.0, step);
    let (mut side, mut impacts, mut peak) = (0.0f64, 0, 0.0f64);
    let steps = ((pulse.end() / rate + 12.0) / (p * step)) as usize;
    for k in 0..steps {
        let [from, to] = [k, k + 1].map(|k| amplitude * alpha * G / omega * pulse.velocity(omega * k as f64 * step));
        motion.step(Forcing { base: [to - from, 0.0], held: 0.0 });
        let (angle, speed) = (motion.places[0].angle, motion.velocities[0][2]);
        peak = peak.max(angle.abs() / alpha);
        if angle.abs() > 1e-6 * alpha {
            impacts += usize::from(side * angle < 0.0);
            side = angle.signum();
        }
        // During a pulse a block comes back from beyond α.
        if angle.abs() > 0.5 * PI || (omega * motion.time > pulse.end() && angle.abs() > alpha && angle * speed > 0.0) {
            return Fate::Overturned(impacts);
        }
    }
    Fate::Stands(peak)
}

/// The same of x = θ/α by the equation for small angles, x'' = x − sign x − A sin ωt in times over 1/p, η left by an impact:
/// Runge and Kutta's method of fourth order, impacts on a straight line.
fn by_small_angles(eta: f64, amplitude: f64, rate: f64) -> Fate {
    const STEP: f64 = 2e-4;
    let end = TAU / rate;
    let (mut t, mut x, mut v, mut side) = ((1.0 / amplitude).asin() / rate, 0.0, 0.0, -1.0f64);
    let (mut impacts, mut peak) = (0, 0.0f64);
    while t < end + 12.0 {
        let base = |t: f64| if t < end { amplitude * (rate * t).sin() } else { 0.0 };
        let rates = |t: f64, [x, v]: [f64; 2]| [v, x - side - base(t)];
        let on = |k: [f64; 2], h: f64| [x + h * k[0], v + h * k[1]];
        let a = rates(t, [x, v]);
        let b = rates(t + 0.5 * STEP, on(a, 0.5 * STEP));
        let c = rates(t + 0.5 * STEP, on(b, 0.5 * STEP));
        let d = rates(t + STEP, on(c, STEP));
        let next = [0, 1].map(|k| [x, v][k] + STEP / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]));
        if next[0] * side < 0.0 {
            let share = x / (x - next[0]);
            (t, x, v, side) = (t + share * STEP, 0.0, eta * (v + share * (next[1] - v)), -side);
            impacts += 1;
            continue;
        }
        (t, x, v) = (t + STEP, next[0], next[1]);
        peak = peak.max(x.abs());
        if t > end && x.abs() > 1.0 && x * v > 0.0 {
            return Fate::Overturned(impacts);
        }
    }
    Fate::Stands(peak)
}

/// Least pulses that overturn without an impact (analytic.json, A8), which are those of small angles: a slender block.
#[test]
fn a_slender_block_overturns_at_once() {
    let Some(all) = reference("analytic.json") else { return };
    let known = &all["A8_overturn_no_impact_linear"];
    let rocker = Rocker::homogeneous(0.02, 1.0);
    for (key, pulse) in [("rect", Pulse::Rectangle), ("halfsine", Pulse::HalfSine), ("onesine", Pulse::OneSine)] {
        for (rate, least) in known[key].as_object().expect("an object") {
            let rate: f64 = rate.parse().expect("a number");
            // The closed form of a one-sine supposes that the block is still up when the pulse ends.
            if matches!(pulse, Pulse::OneSine) && rate < 3.0 {
                continue;
            }
            // Of a rectangle the key is its duration times p.
            let rate = if matches!(pulse, Pulse::Rectangle) { 1.0 / rate } else { rate };
            let fate = |share: f64| pulsed(rocker, pulse, share * number(least), rate);
            assert_eq!(fate(1.01), Fate::Overturned(0), "{key} {rate}");
            assert_ne!(fate(0.99), Fate::Overturned(0), "{key} {rate}");
        }
    }
}

/// Which one-sine pulses overturn a block, by an integration of its equation with η = 0.9 and α = 0.25 after J. Zhang and
/// N. Makris, Journal of Engineering Mechanics 127 (2001) 473–483; those of small angles are those of a slender block on a
/// joint with that η.
#[test]
fn one_sine_pulses_overturn_where_zhang_and_makris_say() {
    let Some(all) = reference("zhang_makris_onesine_boundaries.json") else { return };
    let mut checked = 0;
    for case in all.as_array().expect("a list") {
        let eta = number(&case["eta"]);
        let large = case["nonlinear"] == true;
        let rocker = if large { Rocker::keeping(eta, number(&case["alpha"])) } else { Rocker::slender(eta) };
        let rate = number(&case["wp_over_p"]);
        for transition in case["transitions"].as_array().expect("a list") {
            let fate = |share: f64| match pulsed(rocker, Pulse::OneSine, share * number(&transition[2]), rate) {
                Fate::Stands(_) => "n",
                Fate::Overturned(0) => "o0",
                Fate::Overturned(_) => "o1",
            };
            assert_eq!(fate(0.99), transition[0], "below {transition} at {rate}");
            // One transition of small angles is listed as one that are two, 1.3 % apart: between them the block stands.
            let two = transition[0] == "o1" && transition[1] == "o0";
            if two {
                let between = by_small_angles(eta, 1.01 * number(&transition[2]), rate);
                assert!(!large && matches!(between, Fate::Stands(_)), "{between:?}");
                assert_eq!(fate(1.01), "n", "between {transition} at {rate}");
            }
            assert_eq!(fate(if two { 1.02 } else { 1.01 }), transition[1], "above {transition} at {rate}");
            checked += 1;
        }
    }
    assert_eq!(checked, 29);
}

/// Peak rotations under one-sine pulses of 5 p, as above.
#[test]
fn one_sine_pulses_turn_as_far() {
    let Some(all) = reference("zhang_makris_onesine_checkpoints.json") else { return };
    for case in all.as_array().expect("a list") {
        let rocker = if case["nonlinear"] == true { Rocker::keeping(0.9, 0.25) } else { Rocker::slender(0.9) };
        let fate = pulsed(rocker, Pulse::OneSine, number(&case["A"]), 5.0);
        match (&fate, case["peak_theta_over_alpha"].as_f64()) {
            (Fate::Stands(found), Some(peak)) => close(&format!("peak of {case}"), *found, peak, 1e-2),
            (Fate::Overturned(impacts), None) => assert_eq!(Some(*impacts as u64), case["impacts"].as_u64(), "{case}"),
            _ => panic!("{fate:?} of {case}"),
        }
    }
}
