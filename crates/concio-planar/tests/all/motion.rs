//! Blocks in motion against closed forms.

use std::f64::consts::PI;

use concio_planar::G;
use concio_planar::body::Body;
use concio_planar::joint::{Bond, Friction, Law, Normal, Shear};
use concio_planar::motion::{Forcing, Link, Motion, Setting, System};
use concio_planar::shape::Place;
use concio_verified::{agrees, farthest};

fn brick(name: &str, x: [f64; 2], y: [f64; 2], gamma: f64) -> Body {
    Body::rectangle(name, x, y, gamma / G * (x[1] - x[0]) * (y[1] - y[0]) * 0.12)
}

/// Dry running bond of `courses` × `bricks`, half bricks flush at the ends of every second course.
fn wall(courses: usize, bricks: usize) -> Vec<Body> {
    let (l, h, gamma) = (0.25, 0.055, 1835.0 * G);
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
fn shaken(bodies: &[Body], a: f64, mu: f64, setting: Setting) -> (f64, Motion) {
    let h = setting.step;
    let mut motion = Motion::new(&System::dry(bodies, mu), setting);
    let start = motion.places[0].centre[0];
    let mut peak: f64 = 0.0;
    for k in 0..(2.0 / h).round() as usize {
        let t = k as f64 * h;
        motion.step(Forcing { base: [base(a, 3.0, t + h) - base(a, 3.0, t), 0.0], held: 0.0 });
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
    for (h, within, most) in [(1e-2, 1.5e-3, 25), (5e-3, 1.5e-3, 12), (1e-3, 1e-3, 6), (2.5e-4, 1e-4, 4)] {
        let (peak, motion) = shaken(&wall(10, 10), 0.8 * G, 0.6, Setting::new(h));
        let subject =
            format!("Sliding: dry wall of 10 courses, μ = 0.6, under 0.8 g at 3 Hz, peak slip; steps of {h} s");
        let expected = newmark(0.8, 0.6, 3.0, 2.0);
        agrees!(subject, "Newmark's sliding block in steps of 1 µs", "m", peak, expected, within);
        assert!(unbalanced(&motion) < 1e-6 * motion.account.friction);
        let counters = &motion.counters;
        assert_eq!(counters.unsolved, 0, "{h}");
        assert!(counters.iterations <= most * counters.steps, "{h}: {counters:?}");
        // Blocks move as one, but for what is left of a micrometre at each of a dozen slides.
        let moved = |k: usize| motion.places[k].centre[0] - motion.places[0].centre[0];
        let start = wall(10, 10);
        let apart = |k: usize| (moved(k) - start[k].centre[0] + start[0].centre[0]).abs();
        let most = (0..start.len()).map(apart).fold(0.0, f64::max);
        assert!(most < 2e-5, "{h}: {most:e}");
    }
}

/// Largest |slip| of a block on a base that accelerates by a g sin(2π f t), from the exact motion within every short step.
fn newmark(a: f64, mu: f64, f: f64, end: f64) -> f64 {
    let steps = 2_000_000;
    let h = end / f64::from(steps);
    let (mut x, mut v, mut peak) = (0.0f64, 0.0f64, 0.0f64);
    for k in 0..steps {
        let t = f64::from(k) * h;
        let push = -(base(a * G, f, t + h) - base(a * G, f, t));
        let most = mu * G * h;
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
    let (peak, motion) = shaken(&wall(10, 10), 0.3 * G, 0.6, Setting::new(1e-3));
    // Firm contacts yield by nanometres.
    assert!(peak < 1e-8, "{peak:e}");
    assert_eq!(motion.counters.unsolved, 0);
    let start = wall(10, 10);
    let sunk = motion.places.iter().zip(&start).map(|(p, b)| (p.centre[1] - b.centre[1]).abs()).fold(0.0, f64::max);
    assert!(sunk < 1e-7, "{sunk:e}");
}

/// A minute at rest moves nothing: what is firm bears what it did.
#[test]
fn what_rests_does_not_creep() {
    let mut motion = Motion::new(&System::dry(&wall(6, 5), 0.6), Setting::new(1e-2));
    assert!(motion.stand(1e-12, 4000));
    let start = motion.places.clone();
    (0..6000).for_each(|_| motion.step(Forcing::default()));
    let moved =
        motion.places.iter().zip(&start).map(|(a, b)| (a.centre[0] - b.centre[0]).hypot(a.centre[1] - b.centre[1]));
    let most = moved.fold(0.0, f64::max);
    assert!(most < 1e-12, "{most:e}");
    assert_eq!(motion.counters.unsolved, 0);
}

/// A stone between two others that nothing presses together falls as if it were alone: rigid joints could hold it by any pair of forces.
#[test]
fn nothing_hangs_in_friction_that_nothing_presses() {
    let bodies = [0.0, 0.4, 0.8].map(|x| brick("stone", [x, x + 0.4], [1.0, 1.2], 2e4));
    let mut system = System::dry(&bodies, 0.6);
    (system.held[0], system.held[2]) = ([true; 3], [true; 3]);
    let mut motion = Motion::new(&system, Setting::new(1e-3));
    (0..200).for_each(|_| motion.step(Forcing::default()));
    let fallen = 1.1 - motion.places[1].centre[1];
    assert!((fallen / (0.5 * G * 0.2 * 0.2) - 1.0).abs() < 0.01, "{fallen}");
}

#[test]
fn equal_input_gives_equal_bits() {
    let run = || shaken(&wall(4, 3), 0.9 * G, 0.5, Setting::new(2e-3)).1;
    assert_eq!(run().places, run().places);
}

/// Slender stones on top of each other that rock, slide and come apart, so that contacts are few, then more, then others: what goes on
/// from the middle ends at the same bits, every step is solved, and the account closes.
#[test]
fn a_tower_that_falls_goes_on_from_where_it_was_kept() {
    let stones: Vec<Body> = (0..3)
        .map(|k| brick(&format!("{k}"), [0.0, 0.15], [0.4 * f64::from(k), 0.4 * f64::from(k + 1)], 20e3))
        .collect();
    let new = || Motion::new(&System::dry(&stones, 0.5), Setting::new(1e-3));
    let shake = |motion: &mut Motion, steps: usize| {
        for _ in 0..steps {
            let (t, h) = (motion.time, 1e-3);
            motion.step(Forcing { base: [base(0.7 * G, 2.0, t + h) - base(0.7 * G, 2.0, t), 0.0], held: 0.0 });
        }
    };
    let mut whole = new();
    shake(&mut whole, 1200);
    for middle in [60, 300, 700] {
        let (mut first, mut second) = (new(), new());
        shake(&mut first, middle);
        assert!(second.take_up(first.keep()));
        shake(&mut second, 1200 - middle);
        assert!(second.keep() == whole.keep(), "from step {middle}");
    }
    let most = whole.places.iter().map(|place| place.angle.abs()).fold(0.0, f64::max);
    assert!(most > 1.0, "a stone has fallen over: {most}");
    assert_eq!(whole.counters.unsolved, 0, "{:?}", whole.counters);
    let account = &whole.account;
    assert!(unbalanced(&whole) < 1e-3 * account.input.abs().max(account.friction), "{account:?}");
}

/// A stone whose joint is found a millimetre deeper than its velocity took it, as where it comes upon another edge of its neighbour, is not
/// thrown back by what it takes to press that in; it comes to rest there.
#[test]
fn what_nothing_has_pressed_in_stores_nothing() {
    let bodies = [brick("a", [0.0, 0.4], [0.0, 0.2], 20e3), brick("b", [0.0, 0.4], [0.2, 0.4], 20e3)];
    let press = 1e9;
    let springs =
        Law { normal: Normal::Springs { both: 0.0, press, damping: 0.0 }, ..Law::dry(Some(Friction::coulomb(0.6))) };
    let links = [(None, 0), (Some(0), 1)].map(|(a, b)| Link::closed(a, b, springs));
    let system = System { links: links.to_vec(), ..System::dry(&bodies, 0.6) };
    let mut motion = Motion::new(&system, Setting::new(1e-3));
    let place = motion.places[1];
    motion.put(1, Place { centre: [place.centre[0], place.centre[1] - 1e-3], ..place });
    let mut most: f64 = 0.0;
    for _ in 0..200 {
        motion.step(Forcing::default());
        most = most.max(motion.kinetic() + motion.account.elastic);
    }
    let weight = 2.0 * bodies[1].mass * G;
    // Both stones dropped onto their springs at once: twice as deep as they stand, at most, for each joint.
    assert!(most < 8.0 * weight * weight / press, "{most:e}");
    assert!(most < 1e-4 * 0.5 * press * 1e-6);
    let sunk = place.centre[1] - motion.places[1].centre[1];
    assert!((0.9e-3..1.1e-3).contains(&sunk), "{sunk:e}");
}

/// A beam under 100 kN drives a block of `height` slowly, by `ways` in steps of `step`; the block stands on a `base`, and a joint of `law` (of its area,
/// 0.2 m²) lies on it. What presses the base, and the force of the beam after each step and at a break within it [N].
fn driven(
    height: f64,
    base: Law,
    turns: bool,
    law: &impl Fn(f64) -> Law,
    step: f64,
    ways: &[f64],
) -> (f64, Vec<[f64; 2]>) {
    let block = Body::rectangle("block", [0.0, 1.0], [0.0, height], 20e3 / G * 0.2 * height);
    let beam = Body::rectangle("beam", [0.0, 1.0], [height, height + 1e-3], 0.4);
    let pressed = block.mass * G + 100e3;
    let links = vec![Link::closed(None, 0, base), Link::closed(Some(0), 1, law(0.2))];
    let mut system = System { links, ..System::dry(&[block, beam], 0.6) };
    system.load[1] = [0.0, -100e3];
    system.held[1] = [true, false, !turns];
    let mut motion = Motion::new(&system, Setting { still: true, ..Setting::new(step) });
    assert!(motion.stand(1e-12, 4000));
    let borne = ways.iter().map(|way| {
        motion.go(step, &|_, _| Forcing { base: [0.0; 2], held: *way });
        [motion.pull, motion.breaks[0]]
    });
    (pressed, borne.collect())
}

/// A block that a beam drives to and fro through mortar beside friction slides at μ N on a dry rigid base, and at F_s on a friction damper: what the solution
/// is off by is no force.
#[test]
fn what_slides_in_series_with_mortar_bears_what_slides() {
    let mortar = |area: f64| Law {
        normal: Normal::Springs { both: 24e9 * area, press: 0.0, damping: 0.0 },
        shear: Shear { stiffness: 10e9 * area, damping: 0.0, series: false },
        ..Law::dry(Some(Friction::coulomb(0.6)))
    };
    let damper = Law { slip: [0.0, 15e3], ..Law::dry(None) };
    for (base, on, against) in
        [(Law::dry(Some(Friction::coulomb(0.6))), "a dry base", "μ N"), (damper, "a friction damper", "F_s")]
    {
        for step in [20e-3f64, 10e-3, 5e-3] {
            let steps = (0.4 / step).round() as usize;
            let ways: Vec<f64> = (0..2 * steps).map(|n| if n < steps { 1e-3 * step } else { -1e-3 * step }).collect();
            let (pressed, borne) = driven(0.5, base, true, &mortar, step, &ways);
            let most = if base.slip[1] > 0.0 { base.slip[1] } else { 0.6 * pressed };
            let slides = borne.iter().enumerate().filter(|(n, _)| n % steps > steps / 4);
            let slides = slides.map(|(_, [borne, _])| (borne.abs() / most, 1.0));
            let subject =
                format!("Sliding: block driven through mortar on {on}, largest error of its force; steps of {step} s");
            agrees!(subject, against, "", farthest(slides), 0.0, abs: 1e-6);
        }
    }
}

/// A bonded rigid joint that a beam drives slowly through springs of any stiffness breaks at c A + N tan φ, and slides at μ N from then on.
#[test]
fn a_bonded_rigid_joint_that_is_driven_breaks() {
    let (cohesion, tan_angle, mu) = (50e3 * 0.2, 0.6, 0.4);
    let bond = Bond { tension: 50e3 * 0.2, cohesion, tan_angle, energy: [0.0; 2], residual: 0.0 };
    let base = Law { bond: Some(bond), ..Law::dry(Some(Friction::coulomb(mu))) };
    for stiffness in [1e9, 10e9, 50e9, 200e9, 1000e9, 4000e9] {
        let springs = |area: f64| Law {
            normal: Normal::Springs { both: 0.0, press: stiffness * area, damping: 0.0 },
            shear: Shear { stiffness: stiffness * area, damping: 0.0, series: true },
            ..Law::dry(Some(Friction::coulomb(2.0)))
        };
        for step in [50e-3f64, 20e-3, 5e-3] {
            let ways = vec![0.5e-3 * step; (2.0 / step) as usize];
            let (pressed, borne) = driven(0.05, base, false, &springs, step, &ways);
            let most = borne.iter().flatten().fold(0.0f64, |most, borne| most.max(*borne));
            let of = |what| {
                format!(
                    "Bonds: block on a bonded rigid joint driven through springs, {what}; {} N/mm³, steps of {step} s",
                    1e-9 * stiffness
                )
            };
            agrees!(of("what it bears at most"), "c A + N tan φ", "N", most, cohesion + tan_angle * pressed, 1e-6);
            let last = borne.last().map_or(0.0, |[borne, _]| *borne);
            agrees!(of("what it bears as it slides"), "μ N", "N", last, mu * pressed, 1e-5);
        }
    }
}

/// A rigid joint with μ_s 0.6 and μ_d 0.4 that a beam drives slowly through soft mortar bears μ_s N before it slides and μ_d N after: its ends slide together.
#[test]
fn what_is_driven_slowly_bears_friction_at_rest_first() {
    let soft = |area: f64| Law {
        normal: Normal::Springs { both: 0.0, press: 1.2e9 * area, damping: 0.0 },
        shear: Shear { stiffness: 0.5e9 * area, damping: 0.0, series: true },
        ..Law::dry(Some(Friction::coulomb(2.0)))
    };
    let friction = Friction { static_: 0.6, dynamic: 0.4, slip_velocity: 0.0, alpha: 0.0 };
    for step in [20e-3, 10e-3, 5e-3] {
        let ways = vec![1e-3 * step; (2.0 / step) as usize];
        let (pressed, borne) = driven(0.2, Law::dry(Some(friction)), false, &soft, step, &ways);
        let most = borne.iter().flatten().fold(0.0f64, |most, borne| most.max(*borne));
        let subject = format!("Sliding: block driven through soft mortar, what it bears at most; steps of {step} s");
        agrees!(subject, "μ_s N", "N", most, 0.6 * pressed, 5e-3);
        let last = borne.last().map_or(0.0, |[borne, _]| *borne);
        let subject =
            format!("Sliding: block driven through soft mortar, what it bears as it slides; steps of {step} s");
        agrees!(subject, "μ_d N", "N", last, 0.4 * pressed, 5e-3);
    }
}

/// A block that falls by h on a joint that gives back e of its velocity rises by e² h, wherever in a step it lands, and then by e⁴ h, but for the ways of
/// steps.
#[test]
fn what_lands_within_a_step_rebounds_with_all_of_its_velocity() {
    let body = Body::rectangle("block", [0.0, 1.0], [0.0, 0.5], 1000.0);
    for (e, step) in [(0.3, 1e-3), (0.5, 1e-3), (0.8, 1e-3), (0.3, 2.5e-4), (0.5, 2.5e-4), (0.8, 2.5e-4)] {
        let law =
            Law { normal: Normal::Rigid { restitution: e, rocking: 1.0 }, ..Law::dry(Some(Friction::coulomb(0.6))) };
        let mut farthest = [0.0f64; 2];
        for phase in 0..12 {
            // It lands a twelfth of a step later each time.
            let time = 0.2 + step / 12.0 * f64::from(phase);
            let high = 0.5 * G * time * time;
            let system = System {
                links: vec![Link::closed(None, 0, law)],
                other: law,
                ..System::dry(std::slice::from_ref(&body), 0.6)
            };
            let mut motion = Motion::new(&system, Setting::new(step));
            let start = motion.places[0].centre[1];
            motion.put(0, Place { centre: [0.5, start + high], angle: 0.0 });
            let (mut peaks, mut landed, mut before) = ([0.0f64; 2], 0, 0.0);
            while landed < 3 {
                motion.go(step, &|_, _| Forcing::default());
                let velocity = motion.velocities[0][1];
                landed += usize::from(before < 0.0 && velocity > 0.0);
                before = velocity;
                if (1..3).contains(&landed) {
                    let peak = &mut peaks[landed - 1];
                    *peak = peak.max(motion.places[0].centre[1] - start);
                }
            }
            for (k, found) in peaks.iter().enumerate() {
                farthest[k] = farthest[k].max((found / (high * e.powi(2 * (k as i32 + 1))) - 1.0).abs());
            }
        }
        for (k, rise) in ["e² h", "e⁴ h"].iter().enumerate() {
            let subject = format!(
                "Rigid contact: a fall on a joint with e = {e}, rise {}, largest error; steps of {step} s",
                k + 1
            );
            // A way of v h over e² v²/(2 g) or e⁴ v²/(2 g).
            let within = 1.5 * step * 2.0 * G / (e.powi(2 * k as i32 + 1) * G * 0.2);
            agrees!(subject, rise, "", farthest[k], 0.0, abs: within);
        }
    }
}

/// A plate that flies farther in a step than another is thick strikes it all the same: both go on at half of its speed, and it does not end up inside.
#[test]
fn a_plate_strikes_another_however_fast_it_is() {
    let plate = |x: f64| Body::rectangle("plate", [x, x + 0.02], [50.0, 50.5], 25.0);
    for v in [10.0, 18.0, 40.0, 100.0] {
        for gap in [0.05, 0.113, 0.2] {
            let bodies = [plate(0.0), plate(0.02 + gap)];
            let mut motion = Motion::new(&System::dry(&bodies, 0.5), Setting::new(1e-3));
            motion.velocities[0][0] = v;
            for _ in 0..60 {
                motion.go(1e-3, &|_, _| Forcing::default());
            }
            let [first, second] = [0, 1].map(|k| motion.velocities[k][0]);
            assert!(
                (first - 0.5 * v).abs() < 1e-3 * v && (second - 0.5 * v).abs() < 1e-3 * v,
                "{v} {gap}: {first} {second}"
            );
            let inside = 0.02 - (motion.places[1].centre[0] - motion.places[0].centre[0]);
            assert!(inside < 0.004, "{v} {gap}: {inside}");
        }
    }
}
