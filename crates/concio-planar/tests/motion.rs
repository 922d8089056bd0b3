//! Blocks in motion against closed forms.

use std::f64::consts::PI;

use concio::wall::Block;
use concio_planar::assembly::Body;
use concio_planar::motion::{Method, Motion, Setting};

fn brick(name: &str, x: [f64; 2], y: [f64; 2], gamma: f64) -> Body {
    Body::of(&Block { name: name.into(), panel: 0, course: 0, x, y, thickness: 0.12, specific_weight: gamma })
}

/// Dry running bond of `courses` × `bricks`, half bricks flush at the ends of every second course.
fn wall(courses: usize, bricks: usize) -> Vec<Body> {
    let (l, h, gamma) = (0.25, 0.055, 1835.0 * concio::G);
    let mut bodies = Vec::new();
    for c in 0..courses {
        let y = [c as f64 * h, (c + 1) as f64 * h];
        let cuts: Vec<f64> = match c % 2 {
            0 => (0..=bricks).map(|k| k as f64 * l).collect(),
            _ => {
                [0.0].into_iter().chain((0..bricks).map(|k| (k as f64 + 0.5) * l)).chain([bricks as f64 * l]).collect()
            }
        };
        for pair in cuts.windows(2) {
            bodies.push(brick(&format!("{c}"), [pair[0], pair[1]], y, gamma));
        }
    }
    bodies
}

/// Velocity of a base that accelerates by a sin(2π f t).
fn base(a: f64, f: f64, t: f64) -> f64 {
    a / (2.0 * PI * f) * (1.0 - (2.0 * PI * f * t).cos())
}

/// Largest slip of the bottom course and the motion, after two seconds of 3 Hz.
fn shaken(bodies: &[Body], a: f64, setting: Setting) -> (f64, Motion) {
    let h = setting.step;
    let mut motion = Motion::new(bodies, setting);
    let start = motion.places[0].centre[0];
    let mut peak: f64 = 0.0;
    for k in 0..(2.0 / h).round() as usize {
        let t = k as f64 * h;
        motion.step([base(a, 3.0, t + h) - base(a, 3.0, t), 0.0]);
        if std::env::var("V").is_ok() && k % 10 == 0 {
            eprintln!("{k} {:?} {:?} {}", motion.counters, motion.places[0], motion.kinetic());
        }
        peak = peak.max((motion.places[0].centre[0] - start).abs());
    }
    (peak, motion)
}

fn unbalanced(motion: &Motion) -> f64 {
    let account = &motion.account;
    (motion.kinetic() - account.input + account.friction + account.impact).abs()
}

/// Peak slip on a base that follows a sine, by Newmark's sliding block (../shared/reference, issue figures): 6.556 mm.
#[test]
fn a_wall_slides_as_newmark_says() {
    for (h, within) in [(1e-3, 1e-3), (2.5e-4, 1e-4)] {
        let (peak, motion) = shaken(&wall(10, 10), 0.8 * concio::G, Setting::new(h, 0.6));
        assert!((peak / newmark(0.8, 0.6, 3.0, 2.0) - 1.0).abs() < within, "{h}: {peak}");
        assert!(unbalanced(&motion) < 1e-6 * motion.account.friction);
        // Blocks move as one.
        let moved = |k: usize| motion.places[k].centre[0] - motion.places[0].centre[0];
        let start = wall(10, 10);
        let apart = |k: usize| (moved(k) - start[k].centre[0] + start[0].centre[0]).abs();
        assert!((0..start.len()).map(apart).fold(0.0, f64::max) < 1e-5);
    }
}

/// Largest |slip| of a block on a base that accelerates by a g sin(2π f t), from the exact motion within every short step.
fn newmark(a: f64, mu: f64, f: f64, end: f64) -> f64 {
    let steps = 2_000_000;
    let h = end / f64::from(steps);
    let (mut x, mut v, mut peak) = (0.0f64, 0.0f64, 0.0f64);
    for k in 0..steps {
        let t = f64::from(k) * h;
        let push = -(base(a * concio::G, f, t + h) - base(a * concio::G, f, t));
        let most = mu * concio::G * h;
        let free = v + push;
        let after = if free.abs() <= most { 0.0 } else { free - most * free.signum() };
        x += 0.5 * h * (v + after);
        v = after;
        peak = peak.max(x.abs());
    }
    peak
}

#[test]
fn below_friction_nothing_moves() {
    let (peak, motion) = shaken(&wall(10, 10), 0.3 * concio::G, Setting::new(1e-3, 0.6));
    assert!(peak < 1e-10, "{peak:e}");
    assert_eq!(motion.counters.unsolved, 0);
    let start = wall(10, 10);
    let sunk = motion.places.iter().zip(&start).map(|(p, b)| (p.centre[1] - b.centre[1]).abs()).fold(0.0, f64::max);
    assert!(sunk < 1e-9, "{sunk:e}");
}

#[test]
fn both_methods_find_the_same_motion() {
    let setting = Setting { tolerance: 1e-9, ..Setting::new(1e-3, 0.6) };
    let seidel = Setting { method: Method::GaussSeidel(20_000), ..setting.clone() };
    let [a, b] = [setting, seidel].map(|s| shaken(&wall(3, 3), 0.8 * concio::G, s));
    assert!((a.0 / b.0 - 1.0).abs() < 1e-5, "{} {}", a.0, b.0);
    assert!(a.1.counters.iterations * 5 < b.1.counters.iterations);
}

#[test]
fn equal_input_gives_equal_bits() {
    let run = || shaken(&wall(4, 3), 0.9 * concio::G, Setting::new(2e-3, 0.5)).1;
    assert_eq!(run().places, run().places);
}

/// A block of 0.6 m × 1.8 m that stands on its right corner, turned by `share` of α.
fn tilted(share: f64, setting: Setting) -> (Motion, f64) {
    let body = brick("block", [-0.3, 0.3], [0.0, 1.8], 20e3);
    let alpha = (0.3f64 / 0.9).atan();
    let angle = -share * alpha;
    let mut motion = Motion::new(&[body], setting);
    // From the corner (0.3, 0) to the centre, turned.
    let (s, c) = angle.sin_cos();
    let centre = [0.3 - c * 0.3 - s * 0.9, -s * 0.3 + c * 0.9];
    motion.put(0, concio_planar::shape::Place { centre, angle });
    (motion, alpha)
}

/// Times at which the block passes through upright, its speed there, and its largest turn after each.
fn rocks(share: f64, h: f64, until: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>, Motion) {
    let (mut motion, alpha) = tilted(share, Setting::new(h, 10.0));
    let (mut times, mut speeds, mut peaks) = (Vec::new(), Vec::new(), Vec::new());
    let mut last = motion.places[0].angle;
    let mut speed = 0.0;
    while motion.time < until {
        motion.step([0.0; 2]);
        let angle = motion.places[0].angle;
        if last.signum() != angle.signum() {
            times.push(motion.time - h * angle / (angle - last));
            speeds.push(speed);
            peaks.push(0.0);
        }
        if let Some(peak) = peaks.last_mut() {
            *peak = f64::max(*peak, angle.abs() / alpha);
        }
        speed = motion.velocities[0][2].abs();
        last = angle;
    }
    (times, speeds, peaks, motion)
}

/// Housner's block (../shared/reference/analytic.json, A7, half sizes 0.3 m and 0.9 m, from half of α): quarter period and
/// speed of impact of the nonlinear equation; what is left after each impact is 1 − 3/2 sin²α squared, 0.7225.
#[test]
fn a_block_rocks_as_housner_says() {
    let alpha = (0.3f64 / 0.9).atan();
    let depth = |share: f64| (alpha * (1.0 - share)).cos() - alpha.cos();
    let (times, speeds, peaks, motion) = rocks(0.5, 1e-4, 3.0);
    assert!((times[0] / 0.47433765843173 - 1.0).abs() < 1e-4, "{}", times[0]);
    assert!((speeds[0] / 0.7718068677362414 - 1.0).abs() < 1e-3, "{}", speeds[0]);
    let mut before = depth(0.5);
    for peak in &peaks[..5] {
        let left = depth(*peak) / before;
        assert!((left / 0.7225 - 1.0).abs() < 5e-3, "{left}");
        before = depth(*peak);
    }
    assert!(unbalanced(&motion) < 1e-6 * motion.account.impact);
    assert_eq!(motion.counters.unsolved, 0);
}

/// The time of the first fall is off by what the step is, or less: an impact has its place somewhere within one.
#[test]
fn rocking_converges() {
    let off = |h: f64| (rocks(0.5, h, 0.6).0[0] / 0.47433765843173 - 1.0).abs();
    let [coarse, fine] = [1e-3, 1e-4].map(off);
    assert!(fine < 0.2 * coarse && coarse < 2e-4, "{coarse:e} {fine:e}");
}

/// Uplift needs an acceleration of b/h: a pulse below it leaves the block where it is, one above it turns it.
#[test]
fn a_block_lifts_above_its_slenderness() {
    let turned = |g: f64| {
        let (mut motion, _) = tilted(0.0, Setting::new(1e-3, 10.0));
        let mut most: f64 = 0.0;
        for _ in 0..200 {
            motion.step([g * concio::G * 1e-3, 0.0]);
            most = most.max(motion.places[0].angle.abs());
        }
        most
    };
    assert!(turned(0.333) < 1e-12, "{:e}", turned(0.333));
    assert!(turned(0.334) > 1e-6, "{:e}", turned(0.334));
}
