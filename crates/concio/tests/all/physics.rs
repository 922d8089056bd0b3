//! Walls as a whole: balances, equivalences, determinism.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::model::Model;
use concio::moment::Moment;
use concio::outcome::Outcome;
use concio::record::StopReason;
use concio::run::{joint_rows, prepare_case, run_in_memory};
use concio::simulate::Simulation;
use concio::store::{StoredRun, residual_relative};
use concio_verified::{agrees, farthest};

use crate::common::ready::{channel, edited, ready};
use crate::common::restarted::restarted;

const PANEL: &str = r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 6
bricks = 4
[joint]
friction = { law = "stribeck", static = 0.6, dynamic = 0.42 }
"#;

const SLIPPING: &str = r#"
[load]
top = "10 kN/m"
beam = "driven"
[motion]
duration = "0.1 s"
top = { sine = { amplitude = "10 mm", frequency = "3 Hz" } }
"#;

const SHAKEN: &str = r#"
[load]
top = "2 kN/m"
[motion]
duration = "2 s"
base = { synthetic = { seed = 3, pga = "0.8 g", duration = "4 s" } }
"#;

/// The panel with a set-valued law.
fn sticking(motion: &str, law: &str) -> String {
    format!("{PANEL}{motion}").replace("law = \"stribeck\"", &format!("law = \"{law}\""))
}

fn outcome(text: &str) -> Outcome {
    let out = run_in_memory(&ready(text)).unwrap();
    assert_eq!(out.stop_reason, StopReason::Completed);
    out
}

/// The 6 × 4 panel: 27 blocks in courses of 4 and 5, joints as counted by hand.
#[test]
fn joints_of_the_six_by_four_panel() {
    use concio::case::JointKind::*;
    let model = ready(&format!("{PANEL}{SLIPPING}")).model;
    assert_eq!(model.wall.blocks.len(), 27);
    let count = |kind| model.joints.iter().filter(|j| j.kind == kind).count();
    // Bed: 5 interfaces of 8 half-brick contacts. Head: 3 in each course of 4, 4 in each of 5.
    assert_eq!((count(Base), count(Bed), count(Head), count(Top)), (4, 40, 21, 5));
    // w = 2ℓ/L: a brick on the base 2; (L − t)/2 of overlap 0.96.
    for joint in &model.joints {
        let expected = match joint.kind {
            Base => 2.0,
            Bed => 0.96,
            Top if joint.overlap < 0.2 => 0.96,
            Top => 2.0,
            _ => 1.0,
        };
        assert!((joint.weight - expected).abs() < 1e-12, "{:?}", joint);
    }
}

/// Statics: what the base joints carry is the weight of the wall and q times the length of the top course.
#[test]
fn transmitted_loads_add_up_to_weight_and_top_load() {
    for extra in ["", "[[panel]]\nbond = \"stack\"\ncourses = 6\nbricks = 3\n"] {
        let text = format!("{PANEL}{SLIPPING}").replace("[joint]", &format!("{extra}[joint]"));
        let model = ready(&text).model;
        let weight: f64 = model.wall.blocks.iter().map(|b| b.weight()).sum();
        let top: f64 = model
            .wall
            .blocks
            .iter()
            .filter(|b| b.course + 1 == model.wall.panels[b.panel].courses)
            .map(|b| b.length() * 1e4)
            .sum();
        let base: f64 = model
            .shear
            .rubs
            .iter()
            .filter(|r| model.joints[r.joint as usize].kind == concio::case::JointKind::Base)
            .map(|r| r.normal[0])
            .sum();
        let panels = if extra.is_empty() { "one panel" } else { "two panels" };
        let subject = format!("Walls and loads: shear model, what the base bears; {panels}");
        agrees!(subject, "weight and load of the top course", "N", base, weight + top, 1e-12);
    }
}

/// A wall under its own statics: with stiffness alone, a constant base acceleration settles where the base shear is
/// the inertia force of the whole mass.
#[test]
fn base_shear_balances_inertia() {
    let text = format!(
        "{PANEL}[load]\ntop = 0\n[motion]\nduration = \"0.2 s\"\nbase = {{ pulse = {{ shape = \"rectangular\", acceleration = \"0.1 g\", duration = \"1 s\" }} }}\n"
    );
    let p = edited(&text, |c| {
        c.joint.friction.law = concio::case::FrictionLaw::None;
        c.joint.damping_ratio = 0.5;
    });
    let out = run_in_memory(&p).unwrap();
    let shear = *channel(&out, "base/shear").last().unwrap();
    let mass: f64 = p.model.shear.mass.iter().sum();
    // Mass times base acceleration; blocks are at rest relative to the base by then.
    let subject = "Integration: 6 × 4 panel under a constant acceleration, base shear";
    agrees!(subject, "m a", "N", shear, mass * 0.981, 1e-6);
}

#[test]
fn energy_balances_in_every_regime() {
    let irregular = r#"
model = "shear"
set = "report"
[[panel]]
bond = "irregular"
random = { seed = 5, width = "1.2 m", length = ["150 mm", "300 mm"], height = ["50 mm", "80 mm"], stagger = "30 mm" }
courses = 6
[[panel]]
bond = "stack"
courses = 5
bricks = 3
[joint]
friction = { law = "stribeck", static = 0.4, dynamic = 0.28 }
[load]
top = "20 kN/m"
beam = { mass = "4 t" }
[motion]
duration = "1 s"
base = { sine = { acceleration = "0.8 g", frequency = "4 Hz" } }
"#;
    let cases = [
        ("slipping", format!("{PANEL}{SLIPPING}")),
        ("shaken", format!("{PANEL}{SHAKEN}")),
        ("frictionless", format!("{PANEL}{SLIPPING}").replace("law = \"stribeck\"", "law = \"none\"")),
        (
            "report preset",
            format!("{PANEL}{SLIPPING}").replace("dynamic = 0.42", "dynamic = 0.42, preset = \"report\""),
        ),
        ("irregular, two panels, floor", irregular.to_string()),
        ("true stick", sticking(SLIPPING, "coulomb")),
        ("true stick, report preset", sticking(SLIPPING, "coulomb").replace("0.42", "0.42, preset = \"report\"")),
        ("true stick, falling", sticking(SLIPPING, "stribeck-stick")),
    ];
    for (name, text) in cases {
        let out = outcome(&text);
        let residual = residual_relative(&out);
        assert!(residual <= 1e-3, "{name}: residual {residual:e}");
        assert!(out.energies.input() > 0.0 && out.energies.damping > 0.0, "{name}: {:?}", out.energies);
        assert_eq!(out.energies.nonreciprocal != 0.0, name.ends_with("report preset"), "{name}: {:?}", out.energies);
        let joints: f64 = out.envelopes.joint_dissipation.iter().sum();
        let account = out.energies.damping + out.energies.friction;
        assert!((joints / account - 1.0).abs() < 1e-9, "{name}: joints {joints} against account {account}");
    }
}

/// The wall slips, and head joints open: what the slipping case is there for.
#[test]
fn the_driven_panel_slips_and_opens() {
    let out = outcome(&format!("{PANEL}{SLIPPING}"));
    assert!(out.totals.peak_slip_velocity > 1e-2, "{:?}", out.totals);
    assert!(out.envelopes.joint_opening.iter().any(|&g| g > 1e-7));
    // No interpenetration beyond what κ allows: closing force over κ K_V.
    assert!(out.totals.minimum_gap > -1e-6, "{}", out.totals.minimum_gap);
}

/// Mirror image: reversing the motion of a symmetric wall reverses the response. Head joints are no exception,
/// because left and right change places. Smooth regime, where round-off is not amplified.
#[test]
fn mirrored_motion_mirrors_the_response() {
    let sine = |sign: &str| {
        outcome(&format!(
            "{PANEL}[load]\ntop = \"2 kN/m\"\n[motion]\nduration = \"0.5 s\"\nbase = {{ sine = {{ acceleration = \"{sign}0.5 g\", frequency = \"5 Hz\" }} }}\n"
        ))
    };
    let (plus, minus) = (sine(""), sine("-"));
    let (a, b) = (channel(&plus, "top/displacement"), channel(&minus, "top/displacement"));
    let peak = a.iter().fold(0.0f64, |p, x| p.max(x.abs()));
    for (x, y) in a.iter().zip(&b) {
        assert!((x + y).abs() < 1e-6 * peak, "{x} against {y}");
    }
}

/// A tied beam is a driven beam that follows the base; both are the base carried to the top.
#[test]
fn tied_beam_equals_a_driven_one_with_the_same_motion() {
    let motion = |beam: &str, top: &str| {
        format!(
            "{PANEL}[load]\ntop = \"5 kN/m\"\nbeam = \"{beam}\"\n[motion]\nduration = \"0.5 s\"\nbase = {{ sine = {{ acceleration = \"0.5 g\", frequency = \"5 Hz\" }} }}\n{top}"
        )
    };
    let tied = outcome(&motion("tied", ""));
    let driven = outcome(&motion("driven", "top = { sine = { acceleration = \"0.5 g\", frequency = \"5 Hz\" } }\n"));
    let (a, b) = (channel(&tied, "peak/displacement"), channel(&driven, "peak/displacement"));
    let peak = a.iter().fold(0.0f64, |p, x| p.max(x.abs()));
    for (x, y) in a.iter().zip(&b) {
        assert!((x - y).abs() < 1e-9 * peak, "{x} against {y}");
    }
}

/// Runs side by side on two threads give the bits of runs one after the other.
#[test]
fn same_bits_on_any_number_of_threads() {
    let p = ready(&format!("{PANEL}{SLIPPING}"));
    let alone = run_in_memory(&p).unwrap();
    let together: Vec<Outcome> = std::thread::scope(|s| {
        let handles: Vec<_> = (0..2).map(|_| s.spawn(|| run_in_memory(&p).unwrap())).collect();
        handles.into_iter().map(|h| h.join().unwrap()).collect()
    });
    for out in together {
        assert_eq!(out, alone);
    }
}

/// A state saved anywhere and restored into a new simulation continues with the same bits.
#[test]
fn a_restored_state_continues_with_the_same_bits() {
    for text in [format!("{PANEL}{SLIPPING}"), format!("{PANEL}{SHAKEN}")] {
        let p = ready(&text);
        let whole = run_in_memory(&p).unwrap();
        assert_eq!(restarted(&p, 1, |stride| stride * 3 % 1009), whole);
    }
}

#[test]
fn a_foreign_state_is_refused() {
    let p = ready(&format!("{PANEL}{SHAKEN}"));
    let other = ready(&format!("{PANEL}{SHAKEN}").replace("courses = 6", "courses = 5"));
    let bytes = Simulation::new(&other.model, &other.case.solver, &other.sampling).unwrap().save();
    let mut run = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    assert!(!run.restore(&bytes));
    assert!(!run.restore(&bytes[..bytes.len() / 2]));
}

/// The stiffness factor takes the elastic force away and leaves the damping (case 5 of the report).
#[test]
fn a_stiffness_factor_of_zero_leaves_the_damping() {
    let text = format!("{PANEL}{SLIPPING}");
    let model = |factor: f64| edited(&text, |c| c.joint.bed.stiffness_factor = factor).model;
    let (with, without): (Model, Model) = (model(1.0), model(0.0));
    for ((a, b), joint) in with.shear.elastic.iter().zip(&without.shear.elastic).zip(&with.joints) {
        assert_eq!(a.damping, b.damping);
        assert_eq!(b.stiffness == 0.0, joint.kind != concio::case::JointKind::Head, "{joint:?}");
    }
}

/// A floor so heavy that nothing moves it is a tied beam seen from above: as M grows, a free-floating beam under a
/// moving base stays where it is in space.
#[test]
fn a_very_heavy_beam_stays_in_space() {
    let text = format!(
        "{PANEL}[load]\ntop = \"5 kN/m\"\nbeam = {{ mass = 1e12 }}\n[motion]\nduration = \"0.2 s\"\nbase = {{ sine = {{ amplitude = \"1 mm\", frequency = \"5 Hz\", ramp = \"0.2 s\" }} }}\n"
    );
    let out = outcome(&text);
    let (beam, base) = (channel(&out, "beam/displacement"), channel(&out, "base/displacement"));
    let off = farthest(beam.iter().zip(&base).map(|(x, y)| (*x, -y)));
    let subject = "Integration: very heavy beam above a moving base, largest error of its place";
    agrees!(subject, "at rest in space", "m", off, 0.0, abs: 1e-8);
}

/// Case 5 of the report: without bed stiffness there is no elastic time scale but the head joints'.
#[test]
fn a_wall_without_bed_stiffness_runs() {
    for motion in [SLIPPING, SHAKEN] {
        let mut p = edited(&format!("{PANEL}{motion}"), |c| c.joint.bed.stiffness_factor = 0.0);
        p.model.excitation.duration = p.model.excitation.duration.min(0.5);
        let out = run_in_memory(&p).unwrap();
        assert_eq!(out.stop_reason, StopReason::Completed);
        assert!(residual_relative(&out) < 1e-3, "{:e}", residual_relative(&out));
        assert!(out.totals.peak_relative_displacement > 0.0);
    }
}

/// A wall with neither springs nor friction stays in space while its base moves.
#[test]
fn free_blocks_stay_in_space() {
    let text = format!(
        "{PANEL}[load]\ntop = 0\n[motion]\nduration = \"0.3 s\"\nbase = {{ ramp = {{ amplitude = \"3 mm\", rise = \"0.2 s\" }} }}\n"
    );
    let p = edited(&text, |c| {
        c.joint.friction.law = concio::case::FrictionLaw::None;
        c.joint.damping_ratio = 0.0;
        c.joint.bed.stiffness_factor = 0.0;
    });
    let out = run_in_memory(&p).unwrap();
    // The base starts with a jump of its velocity, which the blocks do not share.
    let (top, base) = (channel(&out, "top/displacement"), channel(&out, "base/displacement"));
    let off = farthest(top.iter().zip(&base).map(|(x, y)| (*x, -y)));
    let subject = "Integration: wall without springs or friction above a moving base, largest error of its place";
    agrees!(subject, "at rest in space", "m", off, 0.0, abs: 1e-12);
    assert!((channel(&out, "base/displacement").last().unwrap() - 3e-3).abs() < 1e-12);
}

/// The relative acceleration of the top joints is that of block and beam, not of the block alone.
#[test]
fn a_driven_beam_has_its_acceleration() {
    let text = format!(
        "{PANEL}[load]\ntop = 0\nbeam = \"driven\"\n[motion]\nduration = \"0.4375 s\"\ntop = {{ sine = {{ amplitude = \"1 mm\", frequency = \"4 Hz\", ramp = \"0.25 s\" }} }}\n"
    );
    let p = edited(&text, |c| {
        c.joint.friction.law = concio::case::FrictionLaw::None;
        c.joint.damping_ratio = 0.3;
    });
    let mut run = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    assert_eq!(run.run_to_end().1, StopReason::Completed);
    // At 1.75 cycles the sine is at its trough: a = A ω².
    let beam = 1e-3 * (2.0 * std::f64::consts::PI * 4.0f64).powi(2);
    let a = &run.state().a;
    let found = a[p.model.shear.top()];
    agrees!("Integration: beam driven by a sine, acceleration at its trough", "A ω²", "m/s²", found, beam, 1e-9);
    for joint in p.model.joints.iter().filter(|j| j.kind == concio::case::JointKind::Top) {
        // Seven springs in a row, nearly equal: the top course has about 6/7 of the motion of the beam.
        assert!((a[joint.a] / beam - 6.0 / 7.0).abs() < 0.02, "{} with a beam of {beam}", a[joint.a]);
    }
}

/// Every run ends with a sample at its end, also where the interval is no binary fraction of it.
#[test]
fn no_sample_is_missed_or_doubled() {
    for (interval, duration) in [(0.005f64, 0.7f64), (0.01, 0.7), (0.004, 1.4), (0.1, 0.3), (0.03, 0.33), (0.07, 0.5)] {
        let text = format!(
            "{PANEL}[load]\ntop = 0\n[motion]\nduration = {duration}\nbase = {{ synthetic = {{ seed = 1, pga = 0.1, duration = 4, dt = 0.01 }} }}\n[output]\ninterval = {interval}\nframes = {interval}\n"
        );
        let out = outcome(&text);
        let rows = out.recording.time.len();
        assert_eq!(rows, out.layout.samples, "interval {interval}, duration {duration}");
        assert_eq!(rows, (duration / interval + 1e-6).floor() as usize + 1);
        assert_eq!(out.recording.frame_time.len(), rows);
        // Steps between a sample and a break that coincide but for rounding would show as wild accelerations.
        let worst = out.envelopes.block_acceleration.iter().fold(0.0f64, |a, x| a.max(*x));
        assert!(worst < 1.0, "interval {interval}: {worst} m/s² under a base of 0.1 m/s²");
    }
}

/// Frictionless runs reuse factors; a restored one must count and compute the same.
#[test]
fn a_restored_frictionless_run_is_the_same() {
    let p = edited(&format!("{PANEL}{SLIPPING}"), |c| {
        c.joint.friction.law = concio::case::FrictionLaw::None;
        c.solver.max_step = Some((1.0 / 16384.0).into());
    });
    let whole = run_in_memory(&p).unwrap();
    assert_eq!(restarted(&p, 37, |_| 37), whole);
}

/// What is not a number ends the run with that reason instead of passing every comparison.
#[test]
fn not_a_number_stops_the_run() {
    let p = ready(&format!("{PANEL}{SHAKEN}"));
    let mut run = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    let n = p.model.unknowns();
    run.start_from(&vec![f64::NAN; n], &vec![0.0; n]);
    assert_eq!(run.run_to_end().1, StopReason::NotFinite);
}

/// Toothed ends leave air between panels in every second course.
#[test]
fn connections_do_not_reach_across_air() {
    let flush = format!("{PANEL}{SLIPPING}")
        .replace("[joint]", "[[panel]]\nbond = \"running\"\ncourses = 6\nbricks = 4\n[joint]");
    let count = |text: &str| {
        let model = ready(text).model;
        model.joints.iter().filter(|j| j.kind == concio::case::JointKind::Connection).count()
    };
    assert_eq!(count(&flush), 6);
    assert_eq!(count(&flush.replacen("bricks = 4", "bricks = 4\nends = \"toothed\"", 1)), 3);
}

/// Friction given to head joints by a change of their own makes them rub, whatever `friction.on` says.
#[test]
fn a_change_may_let_head_joints_rub() {
    let text = format!("{PANEL}{SLIPPING}").replace(
        "[load]",
        "[[joint.change]]\nat = { kind = [\"head\"], course = [1] }\nfriction = { static = 0.3, dynamic = 0.2 }\n[load]",
    );
    let text = text.replace("dynamic = 0.42", "dynamic = 0.42, normal_force = \"overburden\"");
    let model = ready(&text).model;
    let heads =
        model.shear.rubs.iter().filter(|r| model.joints[r.joint as usize].kind == concio::case::JointKind::Head);
    assert_eq!(heads.count(), 3);
}

#[test]
fn a_one_way_law_on_bed_joints_is_refused() {
    for line in ["bed = { law = \"no-tension\", stiffness = 1e7 }", "top = { law = \"no-tension\", stiffness = 1e7 }"] {
        let text = format!("{PANEL}{SLIPPING}").replace("[joint]", &format!("[joint]\n{line}"));
        let file = from_str(&text, Syntax::Toml, None).unwrap();
        let refused = file.validate().and_then(|()| prepare_case(file.case.clone(), Path::new("")).map(|_| ()));
        let message = refused.unwrap_err().to_string();
        assert!(message.contains("no-tension") && message.contains("elastic"), "{message}");
    }
}

/// A panel that ends well below the beam carries neither beam nor load; one that nearly reaches it does.
#[test]
fn a_low_panel_does_not_carry_the_beam() {
    let text = |courses: usize| {
        format!("{PANEL}{SLIPPING}")
            .replace("[joint]", &format!("[[panel]]\nbond = \"stack\"\ncourses = {courses}\nbricks = 2\n[joint]"))
    };
    let top = |model: &Model| {
        let joint =
            |j: &&concio::wall::Joint| j.kind == concio::case::JointKind::Top && model.wall.blocks[j.a].panel == 1;
        model.joints.iter().filter(joint).count()
    };
    let (equal, low) = (ready(&text(6)).model, ready(&text(5)).model);
    assert_eq!((top(&equal), top(&low)), (2, 0));
    assert!(equal.warnings.is_empty(), "{:?}", equal.warnings);
    let told = low.warnings.iter().find(|w| w.starts_with("load.beam: panel p2 ends 65 mm below")).expect("a warning");
    assert!(
        told.ends_with("Give the panels under it one height, by `courses`, `brick.height` and `mortar.bed`"),
        "{told}"
    );
    // Its base then carries its own weight alone.
    let base = |model: &Model| {
        let of_panel = |r: &&concio::law::Rub| {
            let joint = &model.joints[r.joint as usize];
            joint.kind == concio::case::JointKind::Base && model.wall.blocks[joint.a].panel == 1
        };
        model.shear.rubs.iter().filter(of_panel).map(|r| r.normal[0]).sum::<f64>()
    };
    let weight: f64 = low.wall.blocks.iter().filter(|b| b.panel == 1).map(|b| b.weight()).sum();
    assert!((base(&low) / weight - 1.0).abs() < 1e-12);
    assert!(base(&equal) > 10.0 * weight);
}

/// What a stored run says of a frame is what was sampled at that instant, and its accelerations obey (1).
#[test]
fn a_moment_of_a_stored_run_is_what_was_sampled() {
    let massive = SLIPPING.replace("\"driven\"", "{ mass = \"1 t\" }").replace("top = {", "base = {");
    for motion in [SLIPPING, SHAKEN, &massive] {
        let text = format!(
            "{PANEL}{motion}[output]\ninterval = \"2 ms\"\nframes = \"6 ms\"\nblocks = [\"all\"]\njoints = [\"all\"]\n[solver]\ntolerance = 1e-5\n"
        );
        let p = ready(&text);
        let outcome = run_in_memory(&p).unwrap();
        let run = StoredRun {
            schema_version: concio::store::SCHEMA_VERSION,
            provenance: p.provenance(),
            wall: p.model.wall.clone(),
            joints: joint_rows(&p.model),
            outcome,
        };
        let out = &run.outcome;
        let names = p.model.joint_names();
        assert!(out.recording.frame_time.len() > 5);
        for frame in 0..out.recording.frame_time.len() {
            let moment = Moment::of(&run, frame).unwrap();
            let sample = frame * out.layout.frame_every;
            assert_eq!(moment.time(), out.recording.time[sample]);
            let value = |name: String| {
                let c = out.layout.channels.iter().position(|c| c.name == name).unwrap();
                out.recording.values[sample * out.layout.channels.len() + c]
            };
            assert_eq!(moment.beam().displacement, value("beam/displacement".into()));
            let mut force = vec![0.0; p.model.wall.blocks.len()];
            for (e, name) in names.iter().enumerate() {
                let of = |quantity: &str| value(format!("joint/{name}/{quantity}"));
                let joint = moment.joint(e);
                assert_eq!([joint.slip, joint.velocity], [of("slip"), of("velocity")], "{name}");
                assert_eq!([joint.elastic, joint.damping], [of("elastic"), of("damping")], "{name}");
                // The run keeps the tangent of (6) at the solution, the moment the law itself.
                let capacity = 0.6 * run.joints[e].normal_force[0];
                assert!((joint.friction - of("friction")).abs() <= 1e-3 * capacity, "{name}");
                let sum = joint.elastic + joint.damping + of("friction");
                force[p.model.joints[e].a] -= sum;
                if let concio::wall::End::Block(b) = p.model.joints[e].b {
                    force[b] += sum;
                }
            }
            for (i, block) in p.model.wall.blocks.iter().enumerate() {
                let of = |quantity: &str| value(format!("block/{}/{quantity}", block.name));
                let motion = moment.block(i);
                assert_eq!([motion.displacement, motion.velocity], [of("displacement"), of("velocity")]);
                assert_eq!(motion.acceleration, of("acceleration"));
                let expected = force[i] / p.model.shear.mass[i] - value("base/acceleration".into());
                let scale = out.envelopes.block_acceleration[i];
                // The iteration on the laws leaves a mismatch of forces, below the tolerance of the step.
                let error = (motion.acceleration - expected).abs() / scale;
                assert!(error <= 1e-3, "{} {frame}: {error}", block.name);
            }
        }
        assert!(Moment::of(&run, out.recording.frame_time.len()).is_none());
    }
}

/// A shaken wall whose joints can bear it moves exactly nowhere, where the regularised law creeps.
#[test]
fn what_sticks_does_not_move() {
    for law in ["coulomb", "stribeck-stick"] {
        let text = sticking(SHAKEN, law).replace("0.8 g", "0.1 g").replace("2 kN/m", "20 kN/m");
        let out = outcome(&text);
        assert_eq!(out.totals.peak_relative_displacement, 0.0, "{law}");
        assert_eq!(out.energies.friction, 0.0);
        // The joints carry what it takes to go along with the base.
        let mass: f64 = ready(&text).model.shear.mass.iter().sum();
        let (shear, base) = (channel(&out, "base/shear"), channel(&out, "base/acceleration"));
        for (f, a) in shear.iter().zip(&base) {
            assert!((f - mass * a).abs() <= 1e-6 * mass * 0.981, "{f} against {}", mass * a);
        }
    }
}

/// The set-valued law is the limit of (6) for steep first branches: work and force of the beam.
#[test]
fn a_steep_law_comes_near_the_set_valued_one() {
    let work = |text: &str| {
        let out = outcome(text);
        (out.energies.input_top, out.totals.top_force_square.sqrt())
    };
    let limit = work(&sticking(SLIPPING, "stribeck-stick"));
    let error = |beta: &str| {
        let steep = format!("{PANEL}{SLIPPING}").replace("0.42 }", &format!("0.42, beta = {beta} }}"));
        let (w, f) = work(&steep);
        ((w / limit.0 - 1.0).abs(), (f / limit.1 - 1.0).abs())
    };
    let (coarse, fine) = (error("10"), error("1000"));
    assert!(fine.0 < 0.02 && fine.1 < 0.002, "{fine:?}");
    assert!(fine.0 < coarse.0, "{coarse:?} {fine:?}");
}

/// Bits of a set-valued run survive a restart anywhere, and its frames hold the friction that was sampled: frames enough to find over a hundred joints
/// at rest.
#[test]
fn a_sticking_run_is_restored_and_its_friction_is_kept() {
    let text = format!(
        "{}[output]\ninterval = \"1 ms\"\nframes = \"4 ms\"\njoints = [\"all\"]\n",
        sticking(SLIPPING, "coulomb")
    );
    let p = ready(&text);
    let mut whole = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    let (rows, _) = whole.run_to_end();
    let mut first = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    first.advance(137);
    let saved = first.save();
    let mut second = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    assert!(second.restore(&saved));
    second.run_to_end();
    assert_eq!(second.time(), p.model.excitation.duration);
    assert!(second.save() == whole.save(), "other bits after a restart");
    let run = StoredRun {
        schema_version: concio::store::SCHEMA_VERSION,
        provenance: p.provenance(),
        wall: p.model.wall.clone(),
        joints: joint_rows(&p.model),
        outcome: whole.outcome(rows, StopReason::Completed),
    };
    let out = &run.outcome;
    let mut held = 0;
    for frame in 0..out.recording.frame_time.len() {
        let moment = Moment::of(&run, frame).unwrap();
        for (e, name) in p.model.joint_names().iter().enumerate() {
            let c = out.layout.channels.iter().position(|c| c.name == format!("joint/{name}/friction")).unwrap();
            let sampled = out.recording.values[frame * out.layout.frame_every * out.layout.channels.len() + c];
            assert_eq!(moment.joint(e).friction, sampled);
            held += usize::from(moment.joint(e).velocity == 0.0 && sampled != 0.0);
        }
    }
    assert!(held > 100, "joints at rest are held by friction: {held}");
}
