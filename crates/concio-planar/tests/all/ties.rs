//! Tie rods against closed forms.

use std::f64::consts::{FRAC_PI_3, PI};

use concio_planar::G;
use concio_planar::body::Body;
use concio_planar::motion::{Forcing, Motion, Setting, System};
use concio_planar::tie::Tie;
use concio_verified::agrees;

const MASS: f64 = 1000.0;
const STIFFNESS: f64 = 4e6;

/// A flat block of 1 m × 0.5 m with its left bottom corner at `x` [m].
fn block(x: f64) -> Body {
    Body::rectangle("block", [x, x + 1.0], [0.0, 0.5], MASS)
}

/// A level rod of 2 m from the base to the centre of the block at 0.
fn rod() -> Tie {
    Tie { a: None, b: 0, at: [[-1.5, 0.25], [0.0; 2]], stiffness: STIFFNESS, yield_force: f64::INFINITY, slack: 0.0 }
}

fn tied(bodies: &[Body], friction: f64, ties: &[Tie], setting: Setting) -> Motion {
    Motion::new(&System { ties: ties.to_vec(), ..System::dry(bodies, friction) }, setting)
}

fn force(motion: &Motion) -> f64 {
    motion.ties().map(|(tie, strain)| strain.force(tie)).sum()
}

fn yielded(motion: &Motion) -> f64 {
    motion.ties().map(|(_, strain)| strain.yielded()).sum()
}

/// Kinetic energy of before `given` [J].
fn unbalanced(motion: &Motion, given: f64) -> f64 {
    let a = &motion.account;
    motion.kinetic() + a.elastic + a.friction + a.impact + a.damping + a.bond + a.device - a.input - given
}

/// Without inertia: what friction does not hold of m a the rod holds, f = m a − μ m g, whichever end is named first.
#[test]
fn a_rod_holds_what_friction_does_not() {
    let (mu, a) = (0.2, 0.7 * G);
    let h = 0.02;
    let still = Setting { still: true, ..Setting::new(h) };
    let mut motion = tied(&[block(0.0)], mu, &[rod()], still);
    for _ in 0..50 {
        motion.go(h, &|from, to| Forcing { base: [-(to - from) * a, 0.0], held: 0.0 });
    }
    // Contact is solved to a millionth of what gravity does in a step, here m g.
    let expected = MASS * (a - mu * G);
    agrees!("Ties: rod that holds a pushed block", "m a − μ m g", "N", force(&motion), expected, abs: 1e-6 * MASS * G);
    assert_eq!(motion.counters.unsolved, 0);
    // The other way it is slack, and the block goes.
    let still = Setting { still: true, ..Setting::new(h) };
    let mut motion = tied(&[block(0.0)], mu, &[rod()], still);
    motion.go(h, &|from, to| Forcing { base: [(to - from) * a, 0.0], held: 0.0 });
    assert!(force(&motion) == 0.0 && motion.places[0].centre[0] < 0.5 - 1e-3);
}

/// A sudden acceleration makes a block on a rod swing: f = m a (1 − cos ω t), to the second order of the step, and no energy is
/// lost but for what (P6) takes, of the fourth.
#[test]
fn a_rod_is_a_spring() {
    let a = 0.5 * G;
    let omega = (STIFFNESS / MASS).sqrt();
    let error = |h: f64| {
        let mut motion = tied(&[block(0.0)], 0.0, &[rod()], Setting::new(h));
        let mut worst: f64 = 0.0;
        for _ in 0..(0.9 * 2.0 * PI / omega / h) as usize {
            motion.step(Forcing { base: [-h * a, 0.0], held: 0.0 });
            worst = worst.max((force(&motion) - MASS * a * (1.0 - (omega * motion.time).cos())).abs());
        }
        assert!(unbalanced(&motion, 0.0).abs() < 1e-9 * motion.account.input, "{:e}", unbalanced(&motion, 0.0));
        worst / (MASS * a)
    };
    let [coarse, fine] = [1e-3, 5e-4].map(error);
    let subject = "Ties: block on a rod, accelerated at once, largest error of the force over m a";
    agrees!(subject, "m a (1 − cos ω t)", "", fine, 0.0, abs: 5e-3);
    agrees!("Ties: block on a rod, accelerated at once, how the error falls where the step is halved", "4, second order", "", coarse / fine, 4.0, abs: 0.4);
}

/// Two blocks that part: nothing until the slack is gone, v √(k m/2) at most, and then they go on towards each other as fast
/// as they parted, the rod slack.
#[test]
fn a_slack_rod_bears_late_and_never_pushes() {
    let (v, slack, h) = (0.8, 0.02, 1e-4);
    let bodies = [block(0.0), block(1.5)];
    let tie = Tie { a: Some(0), b: 1, at: [[0.4, 0.0], [-0.4, 0.0]], slack, ..rod() };
    let turned = Tie { a: Some(1), b: 0, at: [tie.at[1], tie.at[0]], ..tie };
    let parted = |tie: Tie| {
        let mut motion = tied(&bodies, 0.0, &[tie], Setting::new(h));
        (motion.velocities[0][0], motion.velocities[1][0]) = (-0.5 * v, 0.5 * v);
        let (mut peak, mut first) = (0.0f64, f64::INFINITY);
        for _ in 0..(0.15 / h) as usize {
            motion.step(Forcing::default());
            if force(&motion) > 0.0 {
                first = first.min(motion.time);
            }
            peak = peak.max(force(&motion));
        }
        (motion, peak, first)
    };
    let (motion, peak, first) = parted(tie);
    agrees!("Ties: slack rod between blocks that part, instant it bears", "slack/v", "s", first, slack / v, abs: 1.01 * h);
    let expected = v * (0.5 * STIFFNESS * MASS).sqrt();
    agrees!("Ties: slack rod between blocks that part, peak force", "v √(k m/2)", "N", peak, expected, 1e-3);
    let after = motion.velocities[0][0] - motion.velocities[1][0];
    agrees!("Ties: slack rod between blocks that part, speed at which they come back", "v", "m/s", after, v, 2e-3);
    assert_eq!((force(&motion), motion.account.device), (0.0, 0.0));
    let given = 0.25 * MASS * v * v;
    assert!(unbalanced(&motion, given).abs() < 1e-9 * given, "{:e}", unbalanced(&motion, given));
    let (other, ..) = parted(turned);
    assert!((other.places[0].centre[0] - motion.places[0].centre[0]).abs() < 1e-12);
}

/// Wherever in a step of 1 ms a stiff slack rod snaps taut, it gives the block that flies off its speed back.
#[test]
fn a_rod_that_snaps_taut_within_a_step_takes_nothing() {
    let (v, stiffness) = (0.5, 4e7);
    for slack in [2.0e-3, 2.1e-3, 2.2e-3, 2.3e-3, 2.4e-3] {
        let tie = Tie { slack, stiffness, ..rod() };
        let mut motion = tied(&[block(0.0)], 0.0, &[tie], Setting::new(1e-3));
        motion.velocities[0][0] = v;
        let mut peak = 0.0f64;
        for _ in 0..60 {
            motion.go(1e-3, &|_, _| Forcing::default());
            peak = peak.max(force(&motion));
        }
        let subject = format!("Ties: rod of ω h = 0.2 that snaps taut after {slack} m");
        agrees!(format!("{subject}, speed after"), "−v", "m/s", motion.velocities[0][0], -v, 1e-2);
        agrees!(format!("{subject}, peak force"), "v √(k m)", "N", peak, v * (stiffness * MASS).sqrt(), 2e-2);
    }
}

/// A block of speed v pulls a rod beyond its strength: ½ m v² = f_y²/2 k + f_y e_p. It comes back with what the rod had stored,
/// f_y/√(k m), and next time the rod bears later by e_p and as much as before.
#[test]
fn a_rod_yields_and_unloads_as_it_was_loaded() {
    let (v, h) = (1.0, 1e-4);
    let most = 2e4;
    let mut motion = tied(&[block(0.0)], 0.0, &[Tie { yield_force: most, ..rod() }], Setting::new(h));
    motion.velocities[0][0] = v;
    let given = 0.5 * MASS * v * v;
    let plastic = given / most - 0.5 * most / STIFFNESS;
    let mut peak: f64 = 0.0;
    while motion.time < 0.2 {
        motion.step(Forcing::default());
        peak = peak.max(force(&motion));
    }
    agrees!("Ties: rod that yields, peak force", "f_y", "N", peak, most, 1e-12);
    let against = "½ m v² = f_y²/2 k + f_y e_p";
    agrees!("Ties: rod that yields, plastic stretch", against, "m", yielded(&motion), plastic, 1e-4);
    let taken = motion.account.device;
    agrees!("Ties: rod that yields, energy taken", "f_y e_p", "J", taken, most * yielded(&motion), 1e-9);
    let (back, expected) = (-motion.velocities[0][0], most / (STIFFNESS * MASS).sqrt());
    agrees!("Ties: rod that yields, speed of the block after", "f_y/√(k m)", "m/s", back, expected, 1e-3);
    assert_eq!(force(&motion), 0.0);
    assert!(unbalanced(&motion, given).abs() < 1e-9 * given, "{:e}", unbalanced(&motion, given));
    // Again, too slow to yield.
    let slow = 0.5 * most / (STIFFNESS * MASS).sqrt();
    motion.velocities[0][0] = slow;
    let stretched = yielded(&motion);
    let mut from = f64::INFINITY;
    peak = 0.0;
    for _ in 0..(2.0 / h) as usize {
        motion.step(Forcing::default());
        if force(&motion) > 0.0 {
            from = from.min(motion.places[0].centre[0] - 0.5);
        }
        peak = peak.max(force(&motion));
    }
    let expected = slow * (STIFFNESS * MASS).sqrt();
    agrees!("Ties: rod that has yielded, pulled again, peak force", "v √(k m)", "N", peak, expected, 1e-3);
    assert!((from - stretched).abs() < 1.01 * slow * h, "{from} {stretched}");
    assert_eq!(yielded(&motion), stretched);
}

/// A block that hangs on a rod is a pendulum: 4 √(L/g) K(sin 30°) is its period from 60°, K = 1.685750 (Abramowitz and Stegun,
/// table 17.1).
#[test]
fn a_rod_turns_with_what_it_holds() {
    let length = 2.0;
    let (s, c) = FRAC_PI_3.sin_cos();
    let mut body = Body::rectangle("block", [-0.1, 0.1], [-0.1, 0.1], MASS);
    body.centre = [length * s, 5.0 - length * c];
    let tie = Tie { at: [[0.0, 5.0], [0.0; 2]], stiffness: 1e9, ..rod() };
    let mut motion = tied(&[body], 0.0, &[tie], Setting::new(1e-3));
    let (mut crossed, mut last) = (Vec::new(), motion.places[0].centre[0]);
    while crossed.len() < 3 {
        motion.step(Forcing::default());
        let x = motion.places[0].centre[0];
        if x * last < 0.0 {
            crossed.push(motion.time - 1e-3 * x / (x - last));
        }
        last = x;
        assert!(motion.time < 20.0);
    }
    let (period, expected) = (crossed[2] - crossed[0], 4.0 * (length / G).sqrt() * 1.685_750);
    let against = "4 √(L/g) K(sin 30°) (Abramowitz and Stegun, table 17.1)";
    agrees!("Ties: block that hangs on a rod, period from 60°", against, "s", period, expected, 1e-4);
    let swung = MASS * G * length * (1.0 - c);
    assert!(unbalanced(&motion, 0.0).abs() < 1e-4 * swung, "{:e}", unbalanced(&motion, 0.0) / swung);
    assert_eq!(motion.places[0].angle, 0.0);
}

/// A slender block tied down at its left side is tilted to the right: it lifts at m a h = m g b, then the rod bears
/// (m a h − m g b)/2 b, and it goes where m a h = m g b + 2 b f_y.
#[test]
fn a_block_tied_down_rocks_later() {
    let (b, height) = (0.25, 2.0);
    let (most, h) = (5e3, 0.02);
    let tilted = |lambda: f64| {
        let body = Body::rectangle("block", [-b, b], [0.0, height], MASS);
        let tie = Tie {
            at: [[-b, 0.0], [-b, 0.5 * height]],
            // So stiff that the block stands as good as upright.
            stiffness: 1e9,
            yield_force: most,
            ..rod()
        };
        let mut motion = tied(&[body], 1e3, &[tie], Setting { still: true, ..Setting::new(h) });
        for k in 0..200 {
            let push = lambda * G * (f64::from(k + 1) / 100.0).min(1.0);
            motion.go(h, &|from, to| Forcing { base: [-(to - from) * push, 0.0], held: 0.0 });
        }
        motion
    };
    let lifts = b / (0.5 * height);
    let goes = lifts + 2.0 * b * most / (MASS * G * 0.5 * height);
    let stands = tilted(0.99 * lifts);
    assert!(force(&stands) < 1e-6 * most, "{}", force(&stands));
    let middle = 0.5 * (lifts + goes);
    let held = tilted(middle);
    let expected = (middle - lifts) * MASS * G * 0.5 * height / (2.0 * b);
    agrees!(
        "Ties: slender block tied down and tilted, force",
        "(m a h − m g b)/2 b",
        "N",
        force(&held),
        expected,
        1e-4
    );
    assert!(held.places[0].angle < 0.0 && held.places[0].angle > -1e-4);
    let held = tilted(0.99 * goes);
    assert_eq!(yielded(&held), 0.0);
    let gone = tilted(1.01 * goes);
    assert!(yielded(&gone) > 0.0 && gone.places[0].angle < -0.01, "{}", gone.places[0].angle);
}

/// What a motion goes on from holds its ties.
#[test]
fn a_motion_taken_up_again_has_the_same_bits() {
    let new = || {
        let tie = Tie { yield_force: 5e3, slack: 1e-4, ..rod() };
        tied(&[block(0.0)], 0.3, &[tie], Setting::new(1e-3))
    };
    let shake = |motion: &mut Motion, steps: usize| {
        for _ in 0..steps {
            let push = 0.9 * G * (2.0 * PI * 3.0 * motion.time).sin();
            motion.step(Forcing { base: [-1e-3 * push, 0.0], held: 0.0 });
        }
    };
    let mut whole = new();
    shake(&mut whole, 1000);
    let (mut first, mut second) = (new(), new());
    shake(&mut first, 400);
    assert!(second.take_up(first.keep()));
    shake(&mut second, 600);
    assert_eq!(second.keep(), whole.keep());
    assert!(yielded(&whole) > 0.0);
    let untied = tied(&[block(0.0)], 0.3, &[], Setting::new(1e-3));
    assert!(!new().take_up(untied.keep()));
}
