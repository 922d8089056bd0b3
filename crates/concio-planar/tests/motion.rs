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

#[test]
#[ignore = "a table by hand"]
fn table() {
    for (h, method) in
        [(1e-3, Method::Newton), (5e-4, Method::Newton), (2.5e-4, Method::Newton), (1e-3, Method::GaussSeidel(1000))]
    {
        for g in [0.8, 0.3] {
            let bodies = wall(10, 10);
            let begun = std::time::Instant::now();
            let setting = Setting { method, ..Setting::new(h, 0.6) };
            let (peak, motion) = shaken(&bodies, g * concio::G, setting);
            let e = motion.kinetic() - motion.account.input + motion.account.friction + motion.account.impact;
            println!(
                "{method:?} {h:e} {g}: {} blocks, peak {peak:e} m, {:?}, {:.3} s, energy {:?} residual {e:e}",
                bodies.len(),
                motion.counters,
                begun.elapsed().as_secs_f64(),
                motion.account
            );
        }
    }
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

#[test]
#[ignore = "a table by hand"]
fn rocking_table() {
    let quarter = 0.47433765843173;
    for h in [1e-3, 5e-4, 1e-4, 2e-5] {
        let (times, speeds, peaks, motion) = rocks(0.5, h, 3.0);
        let alpha = (0.3f64 / 0.9).atan();
        let depth = |x: f64| (alpha * (1.0 - x)).cos() - alpha.cos();
        let ratios: Vec<f64> = peaks.windows(2).map(|w| depth(w[1]) / depth(w[0])).collect();
        println!(
            "{h:e}: {} {} {:?} {ratios:?} {:?}",
            times[0] / quarter - 1.0,
            speeds[0] / 0.7718068677362414 - 1.0,
            depth(peaks[0]) / depth(0.5),
            motion.counters
        );
        let e = motion.kinetic() - motion.account.input + motion.account.friction + motion.account.impact;
        println!(
            "   {:?} {e:e} slip {:e} height {:e}",
            motion.account,
            motion.places[0].centre[0],
            motion.places[0].centre[1] - 0.9
        );
    }
}
