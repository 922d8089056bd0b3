//! Rocking walls against closed forms: free motion, ties, friction, floors, chains; order, energy, rest, signs.

use concio::G;
use concio::ground::GroundMotion;
use concio_mechanisms::rocking::{
    Back, Event, Floor, Ladder, Linkage, Mechanism, Member, Part, Positive, Response, Restitution, Rocking, Rub,
    Setting, Shaking, Spot, Stop, Tie, Verdict, What,
};
use concio_verified::agrees;

const WEIGHT: f64 = 20e3;

fn side_walls(e: f64) -> Back {
    Back::SideWalls(Restitution::Given(e))
}

fn free(t: f64, restitution: Option<f64>) -> Back {
    Back::Free { inwards: Linkage::One { hinge: [t, 0.0] }, restitution }
}

/// t by h, one metre of 20 kN/m³.
fn wall(t: f64, h: f64, back: Back) -> Mechanism {
    Mechanism::wall(t, h, 1.0, WEIGHT, back)
}

fn ready(mechanism: &Mechanism) -> Rocking {
    Rocking::new(mechanism).expect("a wall that stands")
}

/// Let go, or thrown, on a ground at rest.
fn thrown(mechanism: &Mechanism, start: [f64; 2], tail: f64) -> Response {
    let setting = Setting { start, tail, ..Setting::default() };
    ready(mechanism).respond(&Shaking::across(&GroundMotion::AtRest, Positive::Inwards), &setting).unwrap()
}

fn shaken(mechanism: &Mechanism, ground: &GroundMotion, setting: &Setting) -> Response {
    ready(mechanism).respond(&Shaking::across(ground, Positive::Inwards), setting).unwrap()
}

fn of(response: &Response, what: What) -> Vec<Event> {
    response.events.iter().copied().filter(|event| event.what == what).collect()
}

/// A motion that lifts a wall of 0.4 m by 4 m off several times: sines of 0.3 g that change their sign.
fn shaking() -> GroundMotion {
    let acceleration: Vec<f64> =
        (0..=400).map(|k| 0.3 * G * (0.05 * f64::from(k)).sin() * (0.013 * f64::from(k)).sin()).collect();
    GroundMotion::sampled(0.01, &acceleration).unwrap()
}

/// α, moment of inertia about the hinge, W R of a rectangle.
fn block(t: f64, h: f64) -> [f64; 3] {
    let (weight, radius) = (WEIGHT * t * h, 0.5 * t.hypot(h));
    [t.atan2(h), 4.0 / 3.0 * weight / G * radius * radius, weight * radius]
}

/// Housner's quarter period (1/p) arcosh(1/(1 − θ₀/α)) of a slender block, and twice of it from one impact to the next where nothing is lost.
#[test]
fn a_slender_block_rocks_with_its_period() {
    let (t, h) = (0.002, 4.0);
    let [alpha, ..] = block(t, h);
    let p = (0.75 * G / (0.5 * t.hypot(h))).sqrt();
    for (name, back) in [("one-sided", side_walls(1.0)), ("two-sided", free(t, Some(1.0)))] {
        for share in [0.1, 0.5, 0.9] {
            let response = thrown(&wall(t, h, back), [share * alpha, 0.0], 10.0);
            let impacts = of(&response, What::Impact);
            let quarter = (1.0 / (1.0 - share)).acosh() / p;
            let subject = |what: &str| format!("Rocking: period of a slender block; {name}, from {share} α, {what}");
            agrees!(subject("first impact"), "Housner 1963", "s", impacts[0].time, quarter, 1e-6);
            let period = impacts[2].time - impacts[0].time;
            agrees!(subject("two impacts on"), "Housner 1963", "s", period, 4.0 * quarter, 1e-6);
            assert!(response.relative_residual() < 1e-7, "{}", response.relative_residual());
            assert_eq!(response.stop, Stop::Moving);
        }
    }
}

/// Housner's loss: the energy after an impact over that before is r², between impacts it stays.
#[test]
fn impacts_take_housners_share_and_nothing_else_does() {
    let (t, h) = (0.8, 4.0);
    let [alpha, inertia, moment] = block(t, h);
    let response = thrown(&wall(t, h, free(t, None)), [0.6 * alpha, 0.0], 60.0);
    let impacts = of(&response, What::Impact);
    let r = 1.0 - 1.5 * alpha.sin().powi(2);
    let first = (2.0 * moment * ((0.4 * alpha).cos() - alpha.cos()) / inertia).sqrt();
    for (k, impact) in impacts.iter().take(5).enumerate() {
        let expected = first * r.powi(k as i32);
        let subject = format!("Rocking: velocity of Housner's block; impact {}", k + 1);
        agrees!(
            subject,
            "energy between impacts, 1 − 1.5 sin²α at each",
            "rad/s",
            impact.velocity.abs(),
            expected,
            1e-9
        );
        assert_eq!(impact.velocity < 0.0, k % 2 == 0);
    }
    // It comes to rest, and impacts have taken all of what it had.
    assert!(matches!(response.stop, Stop::AtRest { .. }), "{:?}", response.stop);
    let energies = response.energies;
    agrees!(
        "Rocking: what impacts take of a block let go",
        "energy at the start",
        "J",
        energies.impact,
        energies.start,
        1e-9
    );
    agrees!(
        "Rocking: energy of a block at the start",
        "W R (cos(α − θ) − cos α)",
        "J",
        energies.start,
        moment * ((0.4 * alpha).cos() - alpha.cos()),
        1e-12
    );
    assert_eq!((energies.kinetic, energies.place, energies.input), (0.0, 0.0, 0.0));
}

/// The scheme has order 4, through lift-off, impacts, a tie that yields: in the velocity of an
/// impact, and in the residual of the account.
#[test]
fn the_scheme_has_order_4() {
    let tie = Tie { yield_force: Some(2e3), slack: 0.01, ..Tie::elastic(Spot::lower([0.0, 3.9]), 4e4) };
    let walls = [
        ("one body with a tie", Mechanism { ties: vec![tie], ..wall(0.4, 4.0, side_walls(0.6)) }, 1.0),
        ("chain of two", Mechanism::arch([0.3, 3.2], 17.28e3, 5e3, 0.15, 0.6, side_walls(0.5)), 2.2),
    ];
    for (name, mechanism, scale) in walls {
        let rocking = ready(&mechanism);
        let ground = shaking();
        let run = |step: f64| {
            let setting = Setting { step: Some(step), duration: Some(3.0), tail: 0.0, ..Setting::default() };
            rocking.respond(&Shaking::across(&ground, Positive::Inwards).times(scale), &setting).unwrap()
        };
        let exact = run(1e-2 / 64.0);
        assert!(exact.counts.impacts >= 1 && exact.peak.rotation > 1e-3, "{exact:?}");
        let steps = [1e-2, 5e-3, 2.5e-3];
        let runs = steps.map(run);
        let velocity = |r: &Response| of(r, What::Impact)[1].velocity;
        let errors = runs.each_ref().map(|r| (velocity(r) / velocity(&exact) - 1.0).abs());
        println!(
            "{name}: {errors:?}, residuals {:?}, {:?}",
            runs.each_ref().map(|r| r.relative_residual()),
            exact.counts
        );
        for k in 0..2 {
            assert!((errors[k] / errors[k + 1]).log2() > 3.5, "{name}: {errors:?}");
            let residuals = [runs[k].residual, runs[k + 1].residual];
            assert!((residuals[0] / residuals[1]).log2() > 3.5, "{name}: {residuals:?}");
        }
    }
}

/// A wall that turns back and out again within one step rubs both ways there: as in steps that are a hundred times shorter.
#[test]
fn two_turns_within_a_step_are_found() {
    let rubs = Mechanism { friction_moment: 300.0, ..wall(0.4, 4.0, side_walls(0.0)) };
    let ground = GroundMotion::sampled(0.2, &[0.55, 1.4, 1.4]).unwrap();
    let run = |step: f64| {
        let start = [0.02, 1e-3];
        let setting = Setting { start, step: Some(step), duration: Some(0.2), tail: 0.0, ..Setting::default() };
        shaken(&rubs, &ground, &setting)
    };
    let (whole, fine) = (run(0.2), run(0.002));
    // It went back farther than it came.
    assert!(fine.energies.friction > 1.1 * 300.0 * (fine.peak.rotation - 0.02), "{fine:?}");
    // Unseen, the turns cost 2e-2.
    let off = (whole.peak.rotation / fine.peak.rotation - 1.0).abs();
    assert!(off < 2e-4, "{whole:?} {fine:?}");
    assert!((whole.energies.friction / fine.energies.friction - 1.0).abs() < 1e-2, "{whole:?} {fine:?}");
}

/// Below g α0 nothing moves, from it on it does: the lift-off of a growing acceleration.
#[test]
fn rest_is_rest_up_to_the_multiplier() {
    let mechanism = wall(0.4, 4.0, side_walls(0.5));
    let rocking = ready(&mechanism);
    agrees!("Rocking: multiplier of a wall", "t/h", "", rocking.multiplier(), 0.1, 1e-14);
    let at = |peak: f64| GroundMotion::sampled(1.0, &[0.0, peak, -peak, 0.0]).unwrap();
    let still = shaken(&mechanism, &at(0.0999 * G), &Setting::default());
    assert_eq!((still.peak.rotation, still.first_lift_off, still.counts.lift_offs), (0.0, None, 0));
    assert_eq!(still.stop, Stop::AtRest { time: 3.0 });
    assert!(still.events.is_empty());
    let moves = shaken(&mechanism, &at(0.15 * G), &Setting::default());
    agrees!(
        "Rocking: first lift-off under a growing acceleration",
        "a = g α0",
        "s",
        moves.first_lift_off.unwrap(),
        0.1 / 0.15,
        1e-12
    );
    // With friction, the moment adds to that of the weight.
    let [alpha, _, moment] = block(0.4, 4.0);
    let rubs = ready(&Mechanism { friction_moment: 1e3, ..mechanism.clone() });
    agrees!(
        "Rocking: multiplier with friction",
        "(W R sin α + M_f)/(W R cos α)",
        "",
        rubs.multiplier(),
        alpha.tan() + 1e3 / (moment * alpha.cos()),
        1e-12
    );
    // With a ground that falls by 2 m/s², weights are less, masses are not.
    let falling = GroundMotion::sampled(10.0, &[-2.0, -2.0]).unwrap();
    let ground = at(0.15 * G);
    let vertical = Shaking { vertical: &falling, ..Shaking::across(&ground, Positive::Inwards) };
    let light = rocking.respond(&vertical, &Setting::default()).unwrap();
    agrees!(
        "Rocking: first lift-off while the ground falls",
        "a = (g − 2) α0",
        "s",
        light.first_lift_off.unwrap(),
        0.1 * (G - 2.0) / (0.15 * G),
        1e-12
    );
    assert!(light.relative_residual() < 1e-7, "{}", light.relative_residual());
}

/// The scale of a first lift-off needs no run, and runs agree with it: with friction of floors, vertical motion, to both sides.
#[test]
fn the_scale_of_the_first_lift_off_is_that_of_runs() {
    let (ground, vertical) = (shaking(), GroundMotion::sampled(0.013, &[0.0, 3.0, -4.0, 1.0, -2.0, 3.0, 0.0]).unwrap());
    let floor = Floor { friction: 0.3, pushes: 0.0, ..Floor::carried(Spot::lower([0.15, 4.0]), 5e3) };
    let with_floor = |back: Back| Mechanism { floors: vec![floor], ..wall(0.4, 4.0, back) };
    let tie = Tie { pretension: 1e3, ..Tie::elastic(Spot::lower([0.0, 3.9]), 1e6) };
    let tied = Mechanism { ties: vec![tie], ..wall(0.4, 4.0, free(0.4, None)) };
    for mechanism in [with_floor(side_walls(0.0)), with_floor(free(0.4, None)), tied] {
        let rocking = ready(&mechanism);
        let shaking = Shaking { vertical: &vertical, scale: 3.0, ..Shaking::across(&ground, Positive::Inwards) };
        let found = rocking.first_lift_off(&shaking, &Setting::default()).unwrap().unwrap();
        let run = |scale: f64| rocking.respond(&Shaking { scale, ..shaking }, &Setting::default()).unwrap();
        assert_eq!(run(found.scale * (1.0 - 1e-9)).first_lift_off, None);
        let lifted = run(found.scale * (1.0 + 1e-9));
        assert!((lifted.first_lift_off.unwrap() - found.time).abs() < 1e-6, "{lifted:?}, {found:?}");
        let first = lifted.events[0];
        assert!(first.what == What::LiftOff && (lifted.peak.rotation > 0.0) == found.outwards, "{lifted:?}, {found:?}");
    }
    let none = ready(&wall(0.4, 4.0, side_walls(0.0)));
    let still = Shaking::across(&GroundMotion::AtRest, Positive::Inwards);
    assert_eq!(none.first_lift_off(&still, &Setting { duration: Some(1.0), ..Setting::default() }).unwrap(), None);
}

/// A ground that falls faster than g leaves nothing to compute.
#[test]
fn a_wall_in_the_air_is_not_computed() {
    let falling = GroundMotion::sampled(1.0, &[0.0, -20.0, 0.0]).unwrap();
    let shaking = Shaking { vertical: &falling, ..Shaking::across(&GroundMotion::AtRest, Positive::Inwards) };
    let response = ready(&wall(0.4, 4.0, side_walls(0.5))).respond(&shaking, &Setting::default()).unwrap();
    assert!(matches!(response.stop, Stop::Airborne { time } if time < 0.5), "{:?}", response.stop);
    assert!(response.doubts()[0].starts_with("the ground falls faster than the wall would at 0."));
}

/// Weights under a steady vertical acceleration are those of another gravity: the quarter period.
#[test]
fn vertical_acceleration_is_gravity() {
    let (t, h) = (0.002, 4.0);
    let [alpha, ..] = block(t, h);
    let rising = GroundMotion::sampled(100.0, &[3.0, 3.0]).unwrap();
    let shaking = Shaking { vertical: &rising, ..Shaking::across(&GroundMotion::AtRest, Positive::Inwards) };
    let setting = Setting { start: [0.5 * alpha, 0.0], duration: Some(5.0), ..Setting::default() };
    let response = ready(&wall(t, h, side_walls(0.0))).respond(&shaking, &setting).unwrap();
    let p = (0.75 * (G + 3.0) / (0.5 * t.hypot(h))).sqrt();
    agrees!(
        "Rocking: quarter period while the ground rises",
        "p² = 3 (g + v̈)/(4 R)",
        "s",
        of(&response, What::Impact)[0].time,
        2f64.acosh() / p,
        1e-6
    );
    assert!(response.relative_residual() < 1e-7, "{response:?}");
}

/// Positive inwards under a record is positive outwards under the reversed one; the two-sided block of one is the mirror of the other.
#[test]
fn signs_are_those_of_the_record() {
    let ground = shaking();
    let one_sided = ready(&wall(0.4, 4.0, side_walls(0.4)));
    let shaking = Shaking::across(&ground, Positive::Inwards);
    let setting = Setting { interval: Some(0.01), ..Setting::default() };
    let [as_it_is, reversed] = one_sided.both_signs(&shaking, &setting).unwrap();
    assert_ne!(as_it_is.peak.rotation, reversed.peak.rotation);
    let negative = one_sided.respond(&shaking.times(-1.0), &setting).unwrap();
    assert_eq!(negative, reversed);
    let two_sided = ready(&wall(0.4, 4.0, free(0.4, None)));
    let [a, b] = two_sided.both_signs(&shaking, &setting).unwrap();
    assert!(a.peak.rotation > 0.0 && a.inwards.unwrap().rotation > 0.0);
    assert!((a.peak.rotation / b.inwards.unwrap().rotation - 1.0).abs() < 1e-9);
    assert!((a.inwards.unwrap().rotation / b.peak.rotation - 1.0).abs() < 1e-9);
    let (a, b) = (a.history.unwrap(), b.history.unwrap());
    assert!(a.rotation.iter().zip(&b.rotation).all(|(a, b)| (a + b).abs() < 1e-9));
}

/// Equal runs have equal bits, with histories or without.
#[test]
fn histories_change_no_bit() {
    let mechanism =
        Mechanism { ties: vec![Tie::elastic(Spot::lower([0.0, 3.9]), 1e4)], ..wall(0.4, 4.0, side_walls(0.5)) };
    let bare = shaken(&mechanism, &shaking(), &Setting::default());
    for interval in [0.003, 0.05] {
        let kept = shaken(&mechanism, &shaking(), &Setting { interval: Some(interval), ..Setting::default() });
        let history = kept.history.clone().unwrap();
        let n = history.time.len();
        assert_eq!(Response { history: None, counts: bare.counts, ..kept }, bare);
        let lengths = [
            history.rotation.len(),
            history.velocity.len(),
            history.displacement.len(),
            history.ground.len(),
            history.ties.len(),
            history.energies.len(),
        ];
        assert!(lengths.iter().all(|length| *length == n));
        assert!(*history.time.last().unwrap() >= 4.0 - interval);
        // Samples lie on the curve: their account closes too.
        let most = history.energies.iter().map(|e| e.residual().abs()).fold(0.0, f64::max);
        assert!(most < 2e-4 * bare.scale, "{most} of {}", bare.scale);
        let highest = history.rotation.iter().copied().fold(0.0, f64::max);
        assert!(highest <= bare.peak.rotation && highest > 0.99 * bare.peak.rotation);
    }
}

/// A stiff tie is a spring under a steady moment: θ = (θ₀ + θ_s) cos ωt − θ_s.
#[test]
fn a_tie_is_a_spring() {
    let (t, h, z, k) = (0.4, 4.0, 3.0, 5e6);
    let [alpha, inertia, moment] = block(t, h);
    let tie = Tie::elastic(Spot::lower([0.0, z]), k);
    let start = 1e-4;
    let response = thrown(&Mechanism { ties: vec![tie], ..wall(t, h, side_walls(0.3)) }, [start, 0.0], 5.0);
    let omega = ((k * z * z - moment * alpha.cos()) / inertia).sqrt();
    let steady = moment * alpha.sin() / (inertia * omega * omega);
    let impact = of(&response, What::Impact)[0];
    let time = (steady / (start + steady)).acos() / omega;
    agrees!("Rocking: a tie as a spring; first impact", "(θ₀ + θ_s) cos ωt − θ_s", "s", impact.time, time, 1e-6);
    let velocity = omega * ((start + steady).powi(2) - steady * steady).sqrt();
    agrees!(
        "Rocking: a tie as a spring; velocity",
        "(θ₀ + θ_s) cos ωt − θ_s",
        "rad/s",
        -impact.velocity,
        velocity,
        1e-6
    );
    agrees!("Rocking: a tie as a spring; pull", "k z sin θ", "N", response.ties[0].peak, k * z * start.sin(), 1e-9);
    assert!(response.relative_residual() < 1e-7, "{}", response.relative_residual());
}

/// Thrown outwards against a tie with slack: where it turns back, by energy; what it yields, what breaks it.
#[test]
fn ties_take_the_energy_of_a_throw() {
    let (t, h, z, k) = (0.4, 4.0, 3.9, 1e6);
    let [alpha, inertia, moment] = block(t, h);
    let velocity = 0.15;
    let throw = |tie: Tie| thrown(&Mechanism { ties: vec![tie], ..wall(t, h, side_walls(0.0)) }, [0.0, velocity], 20.0);
    let place = |turn: f64| moment * ((alpha - turn).cos() - alpha.cos());
    let start = 0.5 * inertia * velocity * velocity;
    let slack = 0.01;
    let tie = Tie { slack, ..Tie::elastic(Spot::lower([0.0, z]), k) };
    let elastic = throw(tie);
    let turn = elastic.peak.rotation;
    let stretch = z * turn.sin() - slack;
    agrees!(
        "Rocking: thrown against a tie; elastic",
        "energy",
        "J",
        place(turn) + 0.5 * k * stretch * stretch,
        start,
        1e-7
    );
    agrees!("Rocking: thrown against a tie; pull", "k (u − s)", "N", elastic.ties[0].peak, k * stretch, 1e-9);
    assert_eq!(elastic.ties[0].set, 0.0);

    let force = 5e3;
    let yields = throw(Tie { yield_force: Some(force), ..tie });
    let turn = yields.peak.rotation;
    let set = z * turn.sin() - slack - force / k;
    agrees!("Rocking: thrown against a tie; set", "u − s − T_y/k", "m", yields.ties[0].set, set, 1e-9);
    agrees!(
        "Rocking: thrown against a tie; with yield",
        "energy",
        "J",
        place(turn) + 0.5 * force * force / k + force * set,
        start,
        1e-7
    );
    agrees!("Rocking: thrown against a tie; energy of yield", "T_y e_p", "J", yields.energies.ties, force * set, 1e-9);
    assert_eq!(of(&yields, What::TieYields(0)).len(), 1);

    let most = 3e-3;
    let breaks = throw(Tie { elongation_at_break: Some(most), ..tie });
    let broke = of(&breaks, What::TieBreaks(0))[0];
    assert_eq!(breaks.ties[0].broke, Some(broke.time));
    agrees!("Rocking: a tie breaks; where", "u = s + e_u", "m", z * broke.rotation.sin(), slack + most, 1e-9);
    agrees!("Rocking: a tie breaks; energy", "k e_u²/2", "J", breaks.energies.ties, 0.5 * k * most * most, 1e-9);
    for response in [elastic, yields, breaks] {
        assert!(response.relative_residual() < 1e-7, "{}", response.relative_residual());
    }
}

/// A pretension holds a thrust that the weight does not, and counts in the multiplier.
#[test]
fn a_pretension_pulls_at_rest() {
    let (t, h, z) = (0.4, 4.0, 3.9);
    let floor = Floor { thrust: 5e3, ..Floor::carried(Spot::lower([0.2, 4.0]), 10e3) };
    let thrust = Mechanism { floors: vec![floor], ..wall(t, h, side_walls(0.0)) };
    let error = Rocking::new(&thrust).unwrap_err().to_string();
    assert!(error.contains("α0 = -"), "{error}");
    let tie = Tie { pretension: 6e3, ..Tie::elastic(Spot::lower([0.0, z]), 1e6) };
    let tied = ready(&Mechanism { ties: vec![tie], ..thrust });
    let weight = WEIGHT * t * h;
    let expected = (weight * 0.2 + 10e3 * 0.2 - 5e3 * h + 6e3 * z) / (weight * 0.5 * h + 10e3 * h);
    agrees!("Rocking: multiplier with thrust and pretension", "(OP3)", "", tied.multiplier(), expected, 1e-12);
    assert_eq!(tied.d0().unwrap().rotation, 0.0);
}

/// Friction against the motion takes M_f per turn, and holds a wall open where it can.
#[test]
fn friction_holds_and_takes() {
    let (t, h) = (0.4, 4.0);
    let [alpha, inertia, moment] = block(t, h);
    let friction = 2e3;
    let mechanism = Mechanism { friction_moment: friction, ..wall(t, h, side_walls(0.0)) };
    // From 0.8 α the weight's moment is less than friction: it stands open.
    let held = thrown(&mechanism, [0.8 * alpha, 0.0], 5.0);
    assert_eq!((held.stop, held.counts.impacts), (Stop::AtRest { time: 0.0 }, 0));
    assert!(moment * (0.2 * alpha).sin() < friction);
    // From 0.2 α it closes, friction takes its share.
    let closes = thrown(&mechanism, [0.2 * alpha, 0.0], 5.0);
    let impact = of(&closes, What::Impact)[0];
    let left = moment * ((0.8 * alpha).cos() - alpha.cos()) - 0.2 * alpha * friction;
    agrees!(
        "Rocking: a wall that rubs; velocity of the impact",
        "energy less M_f θ",
        "rad/s",
        -impact.velocity,
        (2.0 * left / inertia).sqrt(),
        1e-8
    );
    agrees!(
        "Rocking: a wall that rubs; energy of friction",
        "M_f θ",
        "J",
        closes.energies.friction,
        0.2 * alpha * friction,
        1e-9
    );
    // A force F at height z rubs over its way z sin θ until its overlap is spent.
    let rub = Rub { at: Spot::lower([0.0, 2.0]), force: 1e3, overlap: Some(0.02) };
    let thrown_out = thrown(&Mechanism { rubs: vec![rub], ..wall(t, h, side_walls(0.0)) }, [0.0, 0.15], 20.0);
    let lost = of(&thrown_out, What::RubLost(0))[0];
    agrees!("Rocking: an overlap is spent; where", "z sin θ", "m", 2.0 * lost.rotation.sin(), 0.02, 1e-9);
    agrees!("Rocking: an overlap is spent; energy", "F l", "J", thrown_out.energies.friction, 1e3 * 0.02, 1e-7);
    assert!(thrown_out.relative_residual() < 1e-7);
}

/// A floor loads the wall and rubs until it loses its seat; it goes with its energy.
#[test]
fn a_floor_loses_its_seat() {
    let (t, h) = (0.4, 4.0);
    let floor = Floor { seat: Some(0.1), friction: 0.4, pushes: 0.0, ..Floor::carried(Spot::lower([0.1, 4.0]), 10e3) };
    let mechanism = Mechanism { floors: vec![floor], ..wall(t, h, side_walls(0.0)) };
    let weight = WEIGHT * t * h;
    let multiplier = (weight * 0.2 + 10e3 * 0.1 + 0.4 * 10e3 * 4.0) / (weight * 2.0);
    agrees!(
        "Rocking: multiplier with a floor that rubs",
        "(OP3), the floor stays",
        "",
        ready(&mechanism).multiplier(),
        multiplier,
        1e-12
    );
    let response = thrown(&mechanism, [0.0, 0.45], 20.0);
    let lost = of(&response, What::SeatLost(0))[0];
    let displacement = 4.0 * lost.rotation.sin() - 0.1 * (lost.rotation.cos() - 1.0);
    // Depth 0.1 m behind the hinge: outwards by z sin θ + x (1 − cos θ).
    agrees!("Rocking: a floor loses its seat; where", "z sin θ + x (1 − cos θ)", "m", displacement, 0.1, 1e-9);
    let risen = 0.1 * lost.rotation.sin() - 4.0 * (1.0 - lost.rotation.cos());
    let up = 0.1 * lost.rotation.cos() - 4.0 * lost.rotation.sin();
    let kinetic = 0.5 * 10e3 / G * (up * lost.velocity).powi(2);
    agrees!(
        "Rocking: a floor loses its seat; energy that goes with it",
        "place and motion of P",
        "J",
        response.energies.floors,
        10e3 * risen + kinetic,
        1e-9
    );
    assert!(response.relative_residual() < 1e-7, "{}", response.relative_residual());
}

/// The arch of (OP6): multiplier, curve, d0.
#[test]
fn the_arch_is_that_of_limit_analysis() {
    let [t, h, weight] = [0.3, 3.2, 17.28e3];
    let source = "computed independently";
    for (load, d, x, expected) in
        [(30e3, 0.15, 0.639690, 1.253707), (30e3, 0.3, 0.556617, 1.655852), (0.0, 0.15, 0.8, 0.234375)]
    {
        let arch = ready(&Mechanism::arch([t, h], weight, load, d, x, side_walls(0.0)));
        let subject = format!("Rocking: multiplier of an arch; N = {load} N, d = {d} m");
        agrees!(subject, source, "", arch.multiplier(), expected, 1e-6);
        if load == 0.0 {
            continue;
        }
        let d0 = arch.d0().unwrap();
        let bulge = if d == 0.15 { 0.220280 } else { 0.3 };
        agrees!(
            format!("Rocking: bulge at which an arch holds no longer; d = {d} m"),
            source,
            "m",
            d0.displacement,
            bulge,
            1e-5
        );
        if d == 0.15 {
            agrees!("Rocking: turn at which an arch holds no longer", source, "rad", d0.rotation, 0.106977, 1e-5);
            agrees!(
                "Rocking: multiplier of an arch at half of it",
                source,
                "",
                arch.multiplier_at(0.5 * d0.rotation),
                0.627430,
                1e-5
            );
        }
    }
}

/// A chain that is thrown keeps its energy up to d0 and beyond, and loses (OP11) at impacts.
#[test]
fn a_chain_keeps_its_energy() {
    let [t, h] = [0.3, 3.2];
    let inwards = Linkage::Two { base: [t, 0.0], middle: [0.0, 0.6 * h], top: [0.5 * t, h] };
    let back = Back::Free { inwards, restitution: None };
    let arch = Mechanism::arch([t, h], 17.28e3, 5e3, 0.5 * t, 0.6, back);
    let r = ready(&arch).restitution();
    let response = thrown(&arch, [0.06, 0.0], 20.0);
    let impacts = of(&response, What::Impact);
    assert!(response.relative_residual() < 1e-7, "{}", response.relative_residual());
    assert!(impacts.len() > 4);
    let ratio = impacts[2].velocity / impacts[0].velocity;
    // Mirrored in the middle of the wall, both sides are one.
    agrees!("Rocking: two impacts of a chain", "r² of (OP11)", "", ratio, r * r, 1e-6);
    // Thrown hard, it falls: the upper body lies.
    let falls = thrown(&arch, [0.0, 3.0], 20.0);
    assert!(falls.stop.fell(), "{:?}", falls.stop);
    assert!(falls.relative_residual() < 1e-6, "{}", falls.relative_residual());
}

/// One body of the linkage, whatever its parts: a wall in two pieces is a wall.
#[test]
fn a_wall_in_pieces_is_a_wall() {
    let whole = wall(0.4, 4.0, side_walls(0.5));
    let parts = [[0.0, 1.3], [1.3, 4.0]]
        .map(|[low, high]| Part::rectangle(Member::Lower, [0.0, low], [0.4, high], 1.0, WEIGHT));
    let pieces = Mechanism { parts: parts.into(), ..whole.clone() };
    let [a, b] = [whole, pieces].map(|m| shaken(&m, &shaking(), &Setting::default()));
    assert!(a.peak.rotation > 0.0);
    assert!((a.peak.rotation / b.peak.rotation - 1.0).abs() < 1e-9);
}

/// Beyond d0 is not collapse: a wall at 1.2 α that moves inwards comes back. On the ground it is.
#[test]
fn beyond_d0_is_not_collapse() {
    let [alpha, inertia, moment] = block(0.4, 4.0);
    let mechanism = wall(0.4, 4.0, side_walls(0.0));
    let needed = (2.0 * moment * (1.0 - (0.2 * alpha).cos()) / inertia).sqrt();
    let back = thrown(&mechanism, [1.2 * alpha, -1.01 * needed], 60.0);
    assert!(matches!(back.stop, Stop::AtRest { .. }), "{:?}", back.stop);
    assert_eq!(of(&back, What::BackFromD0).len(), 1);
    assert_eq!(back.counts.beyond_d0, 0);
    let falls = thrown(&mechanism, [1.2 * alpha, -0.99 * needed], 60.0);
    assert!(falls.stop.fell());
    let Stop::Fallen { time, beyond } = falls.stop else { panic!("{:?}", falls.stop) };
    assert!(beyond == 0.0 && time > 1.0);
    let speed = (2.0 * moment * ((0.2 * alpha).cos() - alpha.sin()) / inertia + (0.99f64 * needed).powi(2)).sqrt();
    agrees!(
        "Rocking: a wall that falls; velocity on the ground",
        "energy",
        "rad/s",
        of(&falls, What::Fall)[0].velocity,
        speed,
        1e-7
    );
}

/// A jump of the ground's velocity is an impulse m R cos α Δv.
#[test]
fn a_jump_of_the_ground_is_an_impulse() {
    use concio::case::{Ramp, Signal};
    use concio::quantity::{Length, Time};
    let ramp = Ramp { amplitude: Length::from_si(0.05), start: Time::from_si(0.5), rise: Time::from_si(1.0) };
    let ground = concio::ground::compile(&Signal::Ramp(ramp), std::path::Path::new("")).unwrap();
    let mechanism = wall(0.4, 4.0, side_walls(0.0));
    let response = shaken(&mechanism, &ground, &Setting::default());
    let [alpha, inertia, moment] = block(0.4, 4.0);
    let velocity = moment / G * alpha.cos() * 0.05 / inertia;
    let lift = response.events[0];
    assert_eq!((lift.what, lift.time), (What::LiftOff, 0.5));
    agrees!("Rocking: velocity after a jump of the ground", "m R cos α Δv/I", "rad/s", lift.velocity, velocity, 1e-12);
    assert!(response.relative_residual() < 1e-7, "{response:?}");
    // The ground stops: the reverse impulse throws a wall that leans on side walls nowhere.
    let reversed =
        ready(&mechanism).respond(&Shaking::across(&ground, Positive::Outwards), &Setting::default()).unwrap();
    assert_eq!(reversed.events[0].time, 1.5);
}

/// A sure run stands; one that a thousandth decides is chance.
#[test]
fn chance_is_told() {
    let rocking = ready(&wall(0.4, 4.0, side_walls(0.4)));
    let ground = shaking();
    let shaking = Shaking::across(&ground, Positive::Inwards);
    let sure = rocking.repeat(&shaking.times(0.5), &Setting::default()).unwrap();
    assert_eq!((sure.verdict, sure.fell), (Verdict::Stands, [0, 6]));
    assert_eq!(sure.doubts(), Vec::<String>::new());
    let falls = rocking.repeat(&shaking.times(4.0), &Setting::default()).unwrap();
    assert_eq!((falls.verdict, falls.peaks), (Verdict::Falls, None));
    let ladder = Ladder { within: 1e-5, ..Ladder::default() };
    let [low, high] = rocking.least_fall(&shaking, &Setting::default(), &ladder).unwrap().unwrap().scales;
    assert!(0.0 < high - low && high - low <= 1e-5 * high);
    let most = Ladder { most: 0.9 * low, ..ladder };
    assert_eq!(rocking.least_fall(&shaking, &Setting::default(), &most).unwrap(), None);
    let threshold = rocking.repeat(&shaking.times(low), &Setting::default()).unwrap();
    assert_eq!(threshold.verdict, Verdict::Chance);
    assert!(!threshold.response.stop.fell() && threshold.fell[0] > 0, "{:?}", threshold.fell);
    let doubts = threshold.doubts();
    assert!(doubts.iter().any(|doubt| doubt.starts_with("the run is a matter of chance: of runs under")), "{doubts:?}");
}

/// Wrong numbers are named with their bound.
#[test]
fn wrong_numbers_are_named() {
    let good = wall(0.4, 4.0, side_walls(0.5));
    let tie = Tie::elastic(Spot::lower([0.0, 3.9]), 1e6);
    let floor = Floor::carried(Spot::lower([0.2, 4.0]), 1e3);
    let with_tie = |tie: Tie| Mechanism { ties: vec![tie], ..good.clone() };
    let with_floor = |floor: Floor| Mechanism { floors: vec![floor], ..good.clone() };
    let cases = [
        (Mechanism { back: side_walls(1.2), ..good.clone() }, "back.restitution: 1.2; allowed: 0 … 1"),
        (Mechanism { parts: vec![], ..good.clone() }, "parts: no part"),
        (Mechanism { friction_moment: -1.0, ..good.clone() }, "friction_moment: -1 N m; allowed: from 0"),
        (Mechanism { control: Spot::upper([0.0, 4.0]), ..good.clone() }, "control: a point of the upper body"),
        (with_tie(Tie { stiffness: 0.0, ..tie }), "ties[0].stiffness: 0 N/m; allowed: above 0"),
        (with_tie(Tie { slack: 0.01, pretension: 5.0, ..tie }), "ties[0].pretension: 5 N with slack"),
        (
            with_tie(Tie { yield_force: Some(1.0), pretension: 5.0, ..tie }),
            "ties[0].pretension: 5 N; allowed: up to the yield force 1 N",
        ),
        (with_tie(Tie { yield_force: Some(f64::NAN), ..tie }), "ties[0].yield_force: NaN N; allowed: above 0"),
        (with_floor(Floor { load: -1.0, ..floor }), "floors[0].load: -1 N; allowed: from 0"),
        (with_floor(Floor { seat: Some(0.0), ..floor }), "floors[0].seat: 0 m; allowed: above 0"),
        (
            Mechanism { linkage: Linkage::One { hinge: [0.3, 0.0] }, ..good.clone() },
            "linkage: the wall turns under its own loads",
        ),
        (
            Mechanism::arch([0.3, 3.2], 1e4, 0.0, 0.15, 0.6, Back::SideWalls(Restitution::Block)),
            "back.restitution: the formula of a block for a chain",
        ),
        (Mechanism::arch([0.3, 3.2], 1e4, 0.0, 0.15, 1.0, side_walls(0.5)), "linkage.top: 3.2 m high; allowed: above"),
        (
            Mechanism {
                back: Back::Free {
                    inwards: Linkage::Two { base: [0.4, 0.0], middle: [0.0, 1.0], top: [0.0, 2.0] },
                    restitution: None,
                },
                ..good.clone()
            },
            "back.inwards: another number of bodies",
        ),
    ];
    for (mechanism, expected) in cases {
        let error = Rocking::new(&mechanism).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}\ninstead of {expected}");
    }
    let rocking = ready(&good);
    let at_rest = Shaking::across(&GroundMotion::AtRest, Positive::Inwards);
    let wrong = |setting: Setting, expected: &str| {
        let error = rocking.respond(&at_rest, &setting).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}\ninstead of {expected}");
    };
    wrong(Setting { step: Some(0.0), ..Setting::default() }, "step: 0 s; allowed: above 0");
    wrong(Setting { tail: -1.0, ..Setting::default() }, "tail: -1 s; allowed: from 0");
    wrong(Setting { duration: Some(f64::INFINITY), ..Setting::default() }, "duration: inf s; allowed: above 0");
    wrong(
        Setting { interval: Some(1e-9), ..Setting::default() },
        "interval: 0.000000001 s; allowed: at most 1e7 samples",
    );
    wrong(Setting { start: [-0.1, 0.0], ..Setting::default() }, "start: a start from -0.1 rad");
    wrong(Setting { start: [2.0, 0.0], ..Setting::default() }, "start: a start from 2 rad");
    let endless = concio::samples::shaking(1.0, 1.0).unwrap();
    let error = rocking.respond(&Shaking::across(&endless, Positive::Inwards), &Setting::default()).unwrap_err();
    assert!(error.to_string().starts_with("duration: a motion that never ends"), "{error}");
    for (ladder, expected) in [
        (Ladder { step: 0.0, ..Ladder::default() }, "ladder.step: 0; allowed: above 0"),
        (Ladder { most: 0.01, ..Ladder::default() }, "ladder.most: 0.01; allowed: 0.05 to 5000"),
        (Ladder { within: 0.0, ..Ladder::default() }, "ladder.within: 0; allowed: 1e-12 to below 1"),
    ] {
        let error = rocking.least_fall(&at_rest, &Setting::default(), &ladder).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
    }
}
