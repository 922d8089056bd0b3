//! Rigid unilateral contact with Newton's law of impact, against closed forms and hand calculation.

use concio::case::{Pulse, PulseShape, Scheme, Signal, Solver};
use concio::constrained::{self, Heads};
use concio::excitation::Excitation;
use concio::ground::signal::{GroundMotion, compile};
use concio::model::Model;
use concio::record::StopReason;
use concio::run::Prepared;
use concio::samples::{Link, lumped, solver};
use concio::simulate::{Progress, Sampling, Simulation};
use concio::wall::End;
use concio_verified::{agrees, farthest};
use proptest::prelude::*;

use crate::common::ready::ready;

const M: f64 = 100.0;

fn fine(tolerance: f64) -> Solver {
    solver(Scheme::TrBdf2, tolerance)
}

/// A base acceleration of −a from t = 0 on, which presses blocks onto a contact with the base on their right.
fn pushing(a: f64, duration: f64) -> Excitation {
    let pulse = Pulse {
        shape: PulseShape::Rectangular,
        acceleration: (-a).into(),
        duration: (2.0 * duration).into(),
        start: 0.0.into(),
    };
    Excitation::of_base(compile(&Signal::Pulse(pulse), std::path::Path::new("")).unwrap(), duration)
}

/// Runs step by step; after each, `look` sees the simulation.
fn watch(model: &Model, solver: &Solver, z: &[f64], v: &[f64], mut look: impl FnMut(&Simulation)) -> StopReason {
    let sampling = Sampling { interval: model.excitation.duration, frame_every: 0, blocks: vec![], joints: vec![] };
    let mut run = Simulation::new(model, solver, &sampling).unwrap();
    run.start_from(z, v);
    loop {
        let progress = run.advance(1);
        look(&run);
        run.clear_recording();
        if let Progress::Ended(reason) = progress {
            return reason;
        }
    }
}

/// A block falls by g = 10 m/s² from 1 mm and bounces: instants of the impacts t_1 (1 + 2 Σ e^k), heights e^{2k} H.
#[test]
fn bouncing_block() {
    let (a, height) = (10.0, 1e-3f64);
    for e in [0.5, 0.8] {
        let first = (2.0 * height / a).sqrt();
        let end = first * (1.0 + e) / (1.0 - e);
        let model = lumped(&[M], &[Link::rigid(0, End::Base, e)], pushing(a, 1.1 * end));
        let mut times = Vec::new();
        let mut seen = 0;
        let (mut deepest, mut ends) = (0.0f64, 1.0);
        let reason = watch(&model, &fine(1e-9), &[-height], &[0.0], |run| {
            deepest = deepest.max(run.state().z[0]);
            ends = run.state().v[0];
            if run.state().counters.impacts > seen {
                seen = run.state().counters.impacts;
                times.push(run.time());
            }
        });
        assert_eq!(reason, StopReason::Completed);
        let mut exact = first;
        let pairs = times.iter().take(30).enumerate().map(|(k, t)| {
            let now = exact;
            exact += 2.0 * first * e.powi(k as i32 + 1);
            (t / now, 1.0)
        });
        let subject =
            format!("Rigid contact: bouncing block, instants of 30 impacts, largest error over each; e = {e}");
        agrees!(subject, "t₁ (1 + 2 Σ eᵏ)", "", farthest(pairs), 0.0, abs: 1e-6);
        // Bounces as low as 1e-13 m are none.
        let [most, least] = [1e-13f64, 1e-12].map(|low| ((low / height).ln() / (2.0 * e.ln())).round() as usize);
        assert!((least..=most + 1).contains(&times.len()), "{} impacts, not {least} to {most}", times.len());
        assert!(deepest <= 1e-12, "{deepest:e}");
        assert_eq!(ends, 0.0, "it still moves");
    }
}

/// With e = 0 the block stays where it hits, borne by m a, and leaves when the push has turned: the way from there is
/// that of constant acceleration.
#[test]
fn plastic_impact_sticks_and_lets_go() {
    let (a, height, turns, end) = (10.0, 1e-3f64, 0.05, 0.06);
    let push =
        Pulse { shape: PulseShape::Rectangular, acceleration: (-a).into(), duration: turns.into(), start: 0.0.into() };
    // A second pulse the other way: the base's velocity after the first is not 0, which relative motion does not see.
    let sine = Pulse { acceleration: a.into(), start: turns.into(), ..push };
    for (motion, leaves) in [(push, false), (sine, true)] {
        let base = compile(&Signal::Pulse(motion), std::path::Path::new("")).unwrap();
        let model = lumped(&[M], &[Link::rigid(0, End::Base, 0.0)], Excitation::of_base(base, end));
        let z = if leaves { 0.0 } else { -height };
        let (mut last, mut borne) = (0.0, 0.0f64);
        watch(&model, &fine(1e-9), &[z], &[0.0], |run| {
            let state = run.state();
            last = state.z[0];
            borne = borne.max(state.envelopes.joint_force[0]);
            assert!(state.z[0] <= 1e-12, "{:e}", state.z[0]);
        });
        if leaves {
            let exact = -0.5 * a * (end - turns) * (end - turns);
            agrees!("Rigid contact: block that lets go, way", "½ a t²", "m", last, exact, 1e-6);
            assert_eq!(borne, 0.0);
        } else {
            assert!(last.abs() < 1e-12, "it moved after the impact: {last}");
            agrees!("Rigid contact: block pressed on after a plastic impact, force", "m a", "N", borne, M * a, 1e-9);
        }
    }
}

/// Impulses come from velocities, multiplied by a large number: they have four digits less.
const IMPULSE: f64 = 1e-9;

/// Velocities [m/s] after the impact of touching masses in a row, impulses [N s] of the joints, energy lost [J].
fn chain(masses: &[f64], e: f64, v: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
    let links: Vec<Link> = (1..masses.len()).map(|i| Link::rigid(i - 1, End::Block(i), e)).collect();
    let model = lumped(masses, &links, Excitation::of_base(GroundMotion::AtRest, 1.0));
    let sampling = Sampling { interval: 1.0, frame_every: 0, blocks: vec![], joints: vec![] };
    let mut run = Simulation::new(&model, &fine(1e-6), &sampling).unwrap();
    run.start_from(&vec![0.0; masses.len()], v);
    let state = run.state();
    (state.v[..masses.len()].to_vec(), state.envelopes.joint_impulse.clone(), state.energies.impact)
}

fn close(found: &[f64], exact: &[f64], tolerance: f64) {
    let scale = exact.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for (f, x) in found.iter().zip(exact) {
        assert!((f - x).abs() <= tolerance * scale, "{found:?} against {exact:?}");
    }
}

/// Two masses: v⁺ from momentum and w⁺ = −e w⁻; the loss is ½ m_eff (1 − e²) w².
#[test]
fn two_blocks() {
    let (m, v) = ([2.0, 3.0], [1.0, -0.5]);
    for e in [0.0, 0.4, 1.0] {
        let (after, impulse, lost) = chain(&m, e, &v);
        let (reduced, w) = (m[0] * m[1] / (m[0] + m[1]), v[0] - v[1]);
        let p = (1.0 + e) * reduced * w;
        close(&after, &[v[0] - p / m[0], v[1] + p / m[1]], 1e-14);
        close(&impulse, &[p], IMPULSE);
        let exact = 0.5 * reduced * (1.0 - e * e) * w * w;
        let allowed = IMPULSE * reduced * w * w;
        let subject = format!("Rigid contact: two masses collide, energy lost; e = {e}");
        agrees!(subject, "½ m₁m₂/(m₁ + m₂) (1 − e²) w²", "J", lost, exact, abs: allowed);
    }
}

/// Three equal masses that touch, the first runs into the others. By (R4), with all joints at once: 2p₁ − p₂ = (1 + e) m v
/// and 2p₂ − p₁ = 0, so that p₁ = ⅔ (1 + e) m v, p₂ = p₁/2. With e = 1 the cradle does not pass the motion on to the last ball
/// but leaves (−⅓, ⅔, ⅔): that is Newton's law, not an error.
#[test]
fn newtons_cradle_by_newtons_law() {
    for e in [0.0, 0.5, 1.0] {
        let (after, impulse, lost) = chain(&[1.0; 3], e, &[1.0, 0.0, 0.0]);
        let p = 2.0 / 3.0 * (1.0 + e);
        close(&impulse, &[p, 0.5 * p], IMPULSE);
        close(&after, &[1.0 - p, 0.5 * p, 0.5 * p], 1e-14);
        let subject = format!("Rigid contact: Newton's cradle of three balls, speed of the last; e = {e}");
        agrees!(subject, "(1 + e)/3 v (R4)", "m/s", after[2], 0.5 * p, 1e-14);
        let exact = 0.5 * p * (1.0 - e);
        assert!((lost - exact).abs() < IMPULSE, "e = {e}: {lost} against {exact}");
    }
    let (after, ..) = chain(&[1.0; 3], 1.0, &[1.0, 0.0, 0.0]);
    close(&after, &[-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0], 1e-14);
}

/// Two against one from both sides; and a joint that parts takes no part.
#[test]
fn three_blocks_from_both_sides() {
    let (after, impulse, lost) = chain(&[1.0; 3], 0.0, &[1.0, 0.0, -1.0]);
    close(&after, &[0.0, 0.0, 0.0], 1e-14);
    close(&impulse, &[1.0, 1.0], IMPULSE);
    assert!((lost - 1.0).abs() < IMPULSE);
    let (after, impulse, _) = chain(&[1.0; 3], 0.5, &[1.0, 0.0, 5.0]);
    close(&after, &[0.25, 0.75, 5.0], 1e-14);
    close(&impulse, &[0.75, 0.0], IMPULSE);
}

proptest! {
    /// Random rows of touching blocks: momentum is kept, no joint is left closing or pulls, what is lost is what the motion
    /// had less, and it is no gain.
    #[test]
    fn random_chains_obey_the_law(
        row in prop::collection::vec((0.1f64..10.0, -1.0f64..1.0), 2..12),
        e in prop::sample::select(vec![0.0, 0.3, 0.9, 1.0]),
    ) {
        let (m, v): (Vec<f64>, Vec<f64>) = row.into_iter().unzip();
        let (after, impulse, lost) = chain(&m, e, &v);
        let sum = |v: &[f64], power: i32| m.iter().zip(v).map(|(m, v)| m * v.powi(power)).sum::<f64>();
        let scale = m.iter().zip(&v).map(|(m, v)| m * v.abs()).sum::<f64>();
        prop_assert!((sum(&after, 1) - sum(&v, 1)).abs() <= 1e-12 * scale);
        // Joints may collide more than once in the same instant: what is left neither closes nor, hit but once from
        // rest, parts otherwise than Newton's law says.
        for j in 0..m.len() - 1 {
            let w = after[j] - after[j + 1];
            prop_assert!(w <= 1e-13, "joint {} closes with {}", j, w);
            prop_assert!(impulse[j] >= 0.0);
        }
        let less = 0.5 * (sum(&v, 2) - sum(&after, 2));
        prop_assert!((lost - less).abs() <= IMPULSE * sum(&v, 2), "{} booked, {} gone", lost, less);
        prop_assert!(lost >= -IMPULSE * sum(&v, 2));
    }
}

fn panel(head: &str, friction: &str, rest: &str) -> Prepared {
    let text = format!(
        r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 6
bricks = 4
[joint]
head = {{ {head} }}
friction = {{ law = "{friction}", static = 0.6, dynamic = 0.42 }}
{rest}"#
    );
    ready(&text)
}

const SLIPPING: &str = r#"
[load]
top = "10 kN/m"
beam = "driven"
[motion]
duration = "0.3 s"
top = { sine = { amplitude = "5 mm", frequency = "2 Hz", ramp = "0.5 s" } }
"#;

/// The slipping panel with rigid head joints, under every friction law: no gap below −1e-12 m after any step, an account
/// that closes, the same bits twice and from a restored state.
#[test]
fn slipping_panels_never_interpenetrate() {
    for (friction, e) in [("stribeck", 0.0), ("stribeck", 1.0), ("coulomb", 0.5), ("stribeck-stick", 0.3)] {
        let prepared =
            panel(&format!("law = \"rigid\", stiffness = \"5.4e7 N/m\", restitution = {e}"), friction, SLIPPING);
        let model = &prepared.model;
        assert_eq!(model.shear.contacts.len(), 21);
        let mut run = Simulation::new(model, &prepared.case.solver, &prepared.sampling).unwrap();
        let (mut deepest, mut kept) = (0.0f64, None);
        loop {
            let progress = run.advance(1);
            for contact in &model.shear.contacts {
                let [a, b] = model.shear.sides[contact.joint as usize].map(|s| s as usize);
                deepest = deepest.max(run.state().z[a] - run.state().z[b]);
            }
            run.clear_recording();
            if kept.is_none() && run.time() > 0.1 {
                kept = Some(run.save());
            }
            if let Progress::Ended(reason) = progress {
                assert_eq!(reason, StopReason::Completed, "{friction}, e = {e} at {} s", run.time());
                break;
            }
        }
        let state = run.state();
        let residual = state.totals.peak_residual / state.totals.peak_input;
        println!(
            "{friction}, e = {e}: deepest {deepest:e} m, residual {residual:e}, contact {:e} m/s, {:?}, {:?}",
            state.totals.contact_residual, state.counters, state.energies
        );
        assert!(deepest <= 1e-12, "{friction}, e = {e}: {deepest:e} m");
        assert!(-state.totals.minimum_gap <= 1e-12 && -state.totals.minimum_gap >= deepest);
        assert!(residual <= 1e-4, "{friction}, e = {e}: residual {residual:e}");
        assert!(state.counters.impacts > 100, "{:?}", state.counters);
        // The accuracy of a stage, 0.02 of the tolerance.
        let allowed = 0.02 * prepared.case.solver.tolerance * run.shear().expect("a shear wall").state.scale[1];
        assert!(state.totals.contact_residual <= allowed, "{:e}", state.totals.contact_residual);
        let end = run.shear().expect("a shear wall").state.clone();
        let mut again = Simulation::new(model, &prepared.case.solver, &prepared.sampling).unwrap();
        assert!(again.restore(&kept.unwrap()));
        again.run_to_end();
        assert!(
            again.shear().expect("a shear wall").state == end,
            "{friction}, e = {e}: a restored run goes another way"
        );
    }
}

/// Shaken in stick, below a beam with mass: joints open and close by fractions of a micrometre.
#[test]
fn shaken_panels_never_interpenetrate() {
    let shaken = r#"
[load]
top = "2 kN/m"
beam = { mass = "500 kg" }
[motion]
duration = "0.5 s"
base = { synthetic = { seed = 3, pga = "0.8 g", duration = "4 s" } }
"#;
    let prepared = panel("law = \"rigid\", stiffness = \"5.4e7 N/m\"", "stribeck", shaken);
    let mut run = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling).unwrap();
    let (_, reason) = run.run_to_end();
    let state = run.state();
    println!("shaken: {:?} {:?} {:?}", state.counters, state.energies, state.totals);
    assert_eq!(reason, StopReason::Completed);
    assert!(state.totals.minimum_gap >= -1e-12);
    assert!(state.totals.peak_residual <= 1e-4 * state.totals.peak_input);
}

/// A row of three bricks, the first bedded softly: it swings against the others under a pulse.
const ROW: &str = r#"
model = "shear"
set = "report"
[[panel]]
bond = "stack"
courses = 1
bricks = 3
[joint]
damping_ratio = 0.02
head = { law = "no-tension", stiffness = "5.4e7 N/m" }
friction = { law = "none" }
[[joint.change]]
at = { joints = ["base|p1c1b1"] }
spring = { stiffness = "1e7 N/m" }
[motion]
duration = "4 ms"
base = { pulse = { shape = "half-sine", acceleration = "1 g", duration = "2 ms" } }
[solver]
tolerance = 1e-7
[output]
interval = "0.01 ms"
"#;

/// As κ grows, no-tension springs come to what rigid contact with e = 1 does.
#[test]
fn no_tension_converges_to_rigid_contact() {
    let prepared = ready(ROW);
    let blocks: Vec<String> = (1..=3).map(|b| format!("p1c1b{b}")).collect();
    let run = |heads| constrained::respond(&prepared, heads, &blocks, &[]).unwrap();
    let rigid = run(Heads::Rigid(1.0));
    assert!(rigid.deepest() <= 1e-12);
    assert!(rigid.outcome.counters.impacts >= 2, "{:?}", rigid.outcome.counters);
    let kappas = [10.0, 100.0, 1e3, 1e4, 1e5, 1e6];
    let differences: Vec<f64> = kappas
        .iter()
        .map(|&kappa| {
            let spring = run(Heads::NoTension(Some(kappa)));
            let of = |b: &String| {
                let name = format!("block/{b}/displacement");
                constrained::difference(&spring.history(&name).unwrap(), &rigid.history(&name).unwrap())
            };
            blocks.iter().map(of).fold(0.0, f64::max)
        })
        .collect();
    let rate = constrained::rate(&kappas, &differences).unwrap();
    println!("differences {differences:?}, rate {rate}, impacts {}", rigid.outcome.counters.impacts);
    assert!(run(Heads::Free).deepest() > 1e-6);
    assert!((-0.65..=-0.4).contains(&rate), "{rate}: {differences:?}");
}
