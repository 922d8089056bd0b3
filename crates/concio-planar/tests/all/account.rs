//! The energy account where sides of joints come upon other edges, slip off each other or shut.

use std::f64::consts::PI;

use concio_planar::G;
use concio_planar::body::Body;
use concio_planar::joint::{Friction, Law, Normal, Shear};
use concio_planar::motion::{Forcing, Link, Motion, Setting, System};
use concio_planar::shape::Place;
use concio_verified::agrees;

fn stone(x: [f64; 2], y: [f64; 2]) -> Body {
    Body::rectangle("stone", x, y, 20e3 / G * (x[1] - x[0]) * (y[1] - y[0]) * 0.3)
}

fn springs(both: f64, press: f64, damping: f64) -> Law {
    Law { normal: Normal::Springs { both, press, damping }, ..Law::dry(Some(Friction::coulomb(0.6))) }
}

/// What is missing from the account of a motion that began with `initial` in its springs [J].
fn missing(motion: &Motion, initial: f64) -> f64 {
    let a = &motion.account;
    initial + a.input - motion.kinetic() - a.elastic - a.friction - a.damping - a.impact - a.bond - a.device
}

/// Eight courses of stones, and the pairs of them that touch.
fn courses() -> (Vec<Body>, Vec<(Option<usize>, usize)>) {
    let [length, height] = [0.4, 0.2];
    let (mut bodies, mut rows, mut pairs) = (Vec::new(), Vec::<Vec<([f64; 2], usize)>>::new(), Vec::new());
    for course in 0..8 {
        let cuts = if course % 2 == 0 { vec![0.0, 1.0, 2.0, 3.0] } else { vec![0.0, 0.5, 1.5, 2.5, 3.0] };
        let y = [course as f64 * height, (course + 1) as f64 * height];
        let mut row: Vec<([f64; 2], usize)> = Vec::new();
        for ends in cuts.windows(2) {
            let (x, own) = ([ends[0] * length, ends[1] * length], bodies.len());
            bodies.push(stone(x, y));
            pairs.extend(row.last().map(|(_, left)| (Some(*left), own)));
            match rows.last() {
                None => pairs.push((None, own)),
                Some(below) => pairs.extend(
                    below.iter().filter(|(o, _)| x[1].min(o[1]) - x[0].max(o[0]) > 1e-6).map(|(_, o)| (Some(*o), own)),
                ),
            }
            row.push((x, own));
        }
        rows.push(row);
    }
    (bodies, pairs)
}

const SHEAR: Shear = Shear { stiffness: 4e8, damping: 0.0, series: true };

/// A step under a base that is shaken by `g`, in g, at 3 Hz.
fn shake(motion: &mut Motion, g: f64) {
    let base = |t: f64| g * G / (6.0 * PI) * (1.0 - (6.0 * PI * t).cos());
    motion.go(1e-3, &|from, to| Forcing { base: [base(to) - base(from), 0.0], held: 0.0 });
}

/// Stones that slide step after step, where what fails is left out for some steps, go on from anywhere with the same bits.
#[test]
fn a_wall_that_slides_goes_on_from_where_it_was_kept() {
    let (bodies, pairs) = courses();
    let law = Law { shear: SHEAR, ..springs(0.0, 1.2e9, 0.0) };
    let links: Vec<Link> = pairs.iter().map(|&(a, b)| Link::closed(a, b, law)).collect();
    let new = || Motion::new(&System { links: links.clone(), ..System::dry(&bodies, 0.6) }, Setting::new(1e-3));
    let mut whole = new();
    whole.stand(1e-10, 400);
    let mut kept = Vec::new();
    for step in 0..320 {
        if step % 29 == 0 {
            kept.push(whole.keep());
        }
        shake(&mut whole, 1.0);
    }
    for (number, kept) in kept.into_iter().enumerate() {
        let mut second = new();
        assert!(second.take_up(kept));
        (29 * number..320).for_each(|_| shake(&mut second, 1.0));
        assert!(second.keep() == whole.keep(), "from step {}", 29 * number);
    }
}

/// Stones that rock, open and slide under 1 g and more: dry, and with joints that pull.
#[test]
fn the_account_of_a_shaken_wall_closes() {
    let (bodies, pairs) = courses();
    for (law, g) in [(springs(0.0, 1.2e9, 0.0), 1.0), (springs(0.0, 1.2e9, 0.0), 1.6), (springs(1.2e9, 0.0, 0.0), 1.6)]
    {
        let law = Law { shear: SHEAR, ..law };
        let links = pairs.iter().map(|&(a, b)| Link::closed(a, b, law)).collect();
        let mut motion = Motion::new(&System { links, ..System::dry(&bodies, 0.6) }, Setting::new(1e-3));
        motion.stand(1e-10, 400);
        let initial = motion.account.elastic;
        let (mut most, mut off): (f64, f64) = (0.0, 0.0);
        for _ in 0..2_000 {
            shake(&mut motion, g);
            most = most.max(motion.account.input.abs());
            off = off.max(missing(&motion, initial).abs());
        }
        assert!(motion.account.impact > 0.0 || matches!(law.normal, Normal::Springs { press: 0.0, .. }));
        assert!(off < 1e-4 * most, "{g} g, {law:?}: {off} of {most} J");
    }
}

/// A loaded stone is pushed off the one under it: what their joint had stored is lost, and told as that in the step in which they part.
#[test]
fn what_slips_off_an_edge_is_lost() {
    for (press, speed) in [(1e7, 5.0), (1e8, 5.0), (1e7, 1.0)] {
        let bodies = [stone([0.0, 0.4], [0.5, 0.7]), stone([0.0, 0.4], [0.7, 0.9])];
        let law = Law { friction: None, ..springs(0.0, press, 0.0) };
        let mut system = System { links: vec![Link::closed(Some(0), 1, law)], ..System::dry(&bodies, 0.0) };
        (system.held[0], system.held[1][2]) = ([true; 3], true);
        system.load[1][1] = -5e4;
        let mut motion = Motion::new(&system, Setting::new(1e-3));
        motion.stand(1e-10, 400);
        let initial = motion.account.elastic;
        let subject = format!("Springs: energy of a loaded joint at rest; k = {press:e} N/m, {speed} m/s");
        agrees!(subject, "F²/(2 k)", "J", initial, 0.5 * 5e4 * 5e4 / press, 1e-6);
        motion.step(Forcing { base: [-speed, 0.0], held: 0.0 });
        let mut parted = false;
        for _ in 0..600 {
            motion.step(Forcing::default());
            parted |= motion.places[1].centre[0] > 0.62;
            assert!(missing(&motion, initial).abs() < 1e-3 * initial, "{speed} m/s: {}", missing(&motion, initial));
        }
        assert!(parted && motion.account.impact > 0.5 * initial, "{} of {initial} J", motion.account.impact);
    }
}

/// A stone that falls shut within a step onto a strong dashpot: it takes what the stone has, and impacts give nothing back.
#[test]
fn a_dashpot_takes_no_more_than_there_is() {
    let bodies = [stone([0.0, 0.4], [0.0, 0.2])];
    let law = springs(0.0, 1e8, 1e5);
    let system = System { links: vec![Link::closed(None, 0, law)], ..System::dry(&bodies, 0.6) };
    let mut motion = Motion::new(&system, Setting::new(1e-2));
    motion.put(0, Place { centre: [0.2, 0.106], angle: 0.0 });
    motion.velocities[0] = [0.0, -0.6, 0.0];
    let (before, weight) = (motion.kinetic(), 20e3 * 0.4 * 0.2 * 0.3);
    for _ in 0..50 {
        motion.step(Forcing::default());
        let a = &motion.account;
        assert!(a.impact >= -1e-9 && a.damping >= 0.0, "{a:?}");
        assert!(a.impact + a.damping <= before + weight * 0.007, "{a:?} of {before} J");
    }
    assert!(motion.kinetic() < 1e-2 * before);
}

/// Pushed and tilted slowly, a block on mortar takes the work of the mean of the force, ½ k d² and ½ m a x, and loses nothing, whatever the step.
#[test]
fn slow_loads_do_the_work_of_their_mean() {
    let (k, area) = (10e9, 0.3);
    let law = Law {
        normal: Normal::Springs { both: 24e9 * area, press: 0.0, damping: 0.0 },
        shear: Shear { stiffness: k * area, damping: 0.0, series: false },
        ..Law::dry(None)
    };
    let body = stone([0.0, 1.0], [0.0, 0.5]);
    let dry = System::dry(&[body], 0.6);
    for step in [5e-3f64, 2e-2, 8e-2] {
        let steps = (1.6 / step).round() as usize;
        let at_rest = |held: [bool; 3]| {
            let system = System { links: vec![Link::closed(None, 0, law)], held: vec![held], ..dry.clone() };
            let mut motion = Motion::new(&system, Setting { still: true, ..Setting::new(step) });
            assert!(motion.stand(1e-12, 4000));
            motion
        };
        let mut pushed = at_rest([true, false, true]);
        let way = 1e-4 / steps as f64;
        (0..steps).for_each(|_| pushed.go(step, &|_, _| Forcing { base: [0.0; 2], held: way }));
        let work = 0.5 * k * area * 1e-8;
        let subject = format!("Springs: work of a slow push of a block on mortar; steps of {step} s");
        agrees!(subject, "½ k d²", "J", pushed.account.held, work, 1e-6);
        assert!(pushed.account.impact.abs() < 1e-6 * work, "{:?}", pushed.account);
        let mut tilted = at_rest([false; 3]);
        let start = tilted.places[0].centre;
        for n in 1..=steps {
            let tilt = 20.0 * G * n as f64 / steps as f64;
            tilted.go(step, &|from, to| Forcing { base: [tilt * (to - from), 0.0], held: 0.0 });
        }
        let end = tilted.places[0].centre;
        let mass = dry.bodies[0].mass;
        let work = 0.5 * mass * 20.0 * G * (start[0] - end[0]) - mass * G * (end[1] - start[1]);
        let subject = format!("Springs: work of a slow tilt of a block on mortar and of its weight; steps of {step} s");
        agrees!(subject, "½ m a x − W z", "J", tilted.account.input, work, 1e-3);
        assert!(tilted.account.impact.abs() < 1e-3 * work, "{:?}", tilted.account);
    }
}

/// A slow tilt goes on from anywhere with the same bits and the same work.
#[test]
fn a_slow_tilt_goes_on_from_where_it_was_kept() {
    let law = Law { shear: SHEAR, ..springs(0.0, 1.2e9, 0.0) };
    let system =
        System { links: vec![Link::closed(None, 0, law)], ..System::dry(&[stone([0.0, 1.0], [0.0, 0.5])], 0.6) };
    let new = || Motion::new(&system, Setting { still: true, ..Setting::new(2e-2) });
    let tilt = |motion: &mut Motion, n: usize| {
        let acceleration = 0.5 * G * n as f64 / 40.0;
        motion.go(2e-2, &|from, to| Forcing { base: [acceleration * (to - from), 0.0], held: 0.0 });
    };
    let mut whole = new();
    assert!(whole.stand(1e-12, 4000));
    (1..=20).for_each(|n| tilt(&mut whole, n));
    let mut second = new();
    assert!(second.take_up(whole.keep()));
    (21..=40).for_each(|n| tilt(&mut whole, n));
    (21..=40).for_each(|n| tilt(&mut second, n));
    assert!(second.keep() == whole.keep() && whole.account.input > 0.0);
}
