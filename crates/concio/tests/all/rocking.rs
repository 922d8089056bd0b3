//! Walls of `model = "rocking"`: the mechanism is that of the survey, the run that of the mechanism.

use std::path::{Path, PathBuf};

use concio::case::{Syntax, from_str};
use concio::ground::GroundMotion;
use concio::many::{Job, simulate_many};
use concio::model::Model;
use concio::outcome::Outcome;
use concio::record::{EventKind, StopReason};
use concio::rocking::Rocking;
use concio::run::{Prepared, prepare, prepare_moved, run_in_memory};
use concio::simulate::{Progress, Simulation};
use concio::warning::WarningKind;
use concio_mechanisms::rocking::{Response, Setting, Shaking};
use concio_verified::agrees;

/// What pages say of numbers that another program computed.
const SOURCE: &str = "another program";

/// A wall of one block, one metre of it, 20 kN/m³.
fn wall(t: f64, h: f64, rest: &str) -> String {
    format!(
        "model = \"rocking\"\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n\
         brick = {{ length = 1.0, height = {h:?}, thickness = {t:?}, specific_weight = 20e3 }}\n\
         mortar = {{ bed = 0, head = 0 }}\n\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"none\" }}\nfriction = {{ law = \"coulomb\", static = 0.6 }}\n{rest}\n"
    )
}

/// What stops it when it comes back.
const LEANS: &str = "[[out_of_plane.side_wall]]\nx = 0\nthickness = 0.4\nbonded = false\n";

fn prepared(text: &str) -> Prepared {
    let file = from_str(text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    prepare(&file).unwrap_or_else(|e| panic!("{e}"))
}

fn moved(text: &str, motion: GroundMotion) -> Prepared {
    let file = from_str(text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    prepare_moved(&file, motion).unwrap_or_else(|e| panic!("{e}"))
}

fn own(model: &Model) -> &Rocking {
    model.rocking().expect("a rocking wall")
}

/// The same time history without the engine.
fn alone(prepared: &Prepared) -> Response {
    let (model, own) = (&prepared.model, own(&prepared.model));
    let shaking = Shaking {
        across: &model.excitation.base,
        positive: own.positive,
        vertical: &model.excitation.vertical,
        scale: 1.0,
    };
    let setting = Setting {
        duration: Some(own.shaking_ends),
        tail: model.excitation.duration - own.shaking_ends,
        interval: Some(prepared.sampling.interval),
        ..Setting::default()
    };
    own.compiled.respond(&shaking, &setting).expect("a response")
}

fn residual(outcome: &Outcome) -> f64 {
    outcome.totals.peak_residual / outcome.totals.peak_input
}

fn shaking() -> GroundMotion {
    // Two seconds of growing and dying swings, 0.25 g at most.
    let at = |k: usize| {
        let t = 0.01 * k as f64;
        2.4 * (std::f64::consts::PI * t / 4.0).sin() * (std::f64::consts::TAU * 0.9 * t).sin()
    };
    GroundMotion::sampled(0.01, &(0..=400).map(at).collect::<Vec<f64>>()).expect("a motion")
}

/// α0 of what rocks is that of the closed forms: t/h, (OP3) with floors, and (OP6).
#[test]
fn the_mechanism_is_that_of_the_closed_forms() {
    let still = "[motion]\nduration = 1.0\n";
    let bare = prepared(&wall(0.5, 6.0, &format!("[out_of_plane]\n{still}")));
    agrees!("Rocking walls: multiplier; bare", "t/h", "", own(&bare.model).compiled.multiplier(), 0.5 / 6.0, 1e-12);
    // P 12 kN/m at 0.35 m and H 1.5 kN/m at 6 m.
    let floor = "[[out_of_plane.floor]]\nz = 6.0\nload = 12e3\nat = 0.35\nthrust = 1.5e3\n";
    let laden = prepared(&wall(0.5, 6.0, &format!("{floor}{still}")));
    let weight: f64 = 20e3 * 0.5 * 6.0;
    let closed = (weight * 0.25 + 12e3 * 0.35 - 1.5e3 * 6.0) / (weight * 3.0 + 12e3 * 6.0);
    agrees!(
        "Rocking walls: multiplier; with a floor",
        "(OP3)",
        "",
        own(&laden.model).compiled.multiplier(),
        closed,
        1e-12
    );
    assert!(
        (laden.model.weight() - weight - 12e3).abs() < 1e-6 && (laden.model.base_load() - weight - 12e3).abs() < 1e-6
    );
    // A storey held at its top and its base, eight courses: the hinge lies on a bed joint.
    let arch = wall(
        0.3,
        0.4,
        "[[out_of_plane.floor]]\nz = 3.2\nload = 30e3\nat = 0.15\nholds = true\n[motion]\nduration = 1.0\n",
    );
    let arch = prepared(&arch.replace("courses = 1", "courses = 8"));
    let rocking = own(&arch.model);
    let (weight, x) = (20e3 * 0.3 * 3.2, rocking.hinge / 3.2);
    let n = 30e3 / weight;
    let closed = 2.0 * 0.3 / 3.2 * (1.0 + n * (1.0 + 0.5 * x / (1.0 - x))) / x;
    agrees!("Rocking walls: multiplier; arch", "(OP6)", "", rocking.compiled.multiplier(), closed, 1e-12);
    let names: Vec<&str> = arch.model.wall.blocks.iter().map(|b| b.name.as_str()).collect();
    assert_eq!((rocking.kind.name(), names, arch.model.joints.len()), ("vertical-arch", vec!["lower", "upper"], 2));
    assert_eq!(arch.model.wall.blocks[1].y, [rocking.hinge, 3.2]);
}

/// A run is the time history of its mechanism, to the last bit of the shared steps.
#[test]
fn a_run_is_the_time_history_of_its_mechanism() {
    let tied = "[[out_of_plane.anchor]]\nz = 3.5\nstiffness = 2e6\nyield_force = 6e3\n[motion]\nduration = 9.0\n";
    let free = "[out_of_plane]\n[rocking]\npositive = \"outwards\"\n[motion]\nduration = 9.0\n";
    let leans = format!("{LEANS}[rocking]\nrestitution = 0.3\n[motion]\nduration = 9.0\n");
    let mut lifted = 0;
    for rest in [free, tied, &leans] {
        let prepared = moved(&wall(0.5, 4.0, rest), shaking());
        let (outcome, response) = (run_in_memory(&prepared).expect("a run"), alone(&prepared));
        let history = response.history.as_ref().expect("a history");
        let channel = |name: &str| outcome.history(name).expect("a channel");
        // A run ends when the wall rests after its motion.
        let n = outcome.recording.time.len();
        assert!(n > 400 && n <= history.time.len());
        assert_eq!(outcome.recording.time, history.time[..n]);
        assert_eq!(channel("top/displacement"), history.displacement[..n]);
        assert_eq!(channel("block/lower/rotation"), history.rotation[..n]);
        assert_eq!(channel("energy/impact"), history.energies[..n].iter().map(|e| e.impact).collect::<Vec<f64>>());
        assert_eq!(channel("base/acceleration"), history.ground[..n]);
        let rocking = outcome.rocking.as_ref().expect("an outcome");
        let peaks = [Some(response.peak), response.inwards].into_iter().flatten().filter_map(|peak| peak.over_d0);
        assert_eq!(rocking.peak_over_d0, peaks.fold(0.0, f64::max));
        assert_eq!([rocking.impacts, rocking.lift_offs], [response.counts.impacts, response.counts.lift_offs]);
        assert_eq!(
            outcome.ties.iter().map(|tie| tie.force).collect::<Vec<f64>>(),
            response.ties.iter().map(|tie| tie.peak).collect::<Vec<f64>>()
        );
        lifted += usize::from(rocking.lift_offs > 0);
        let cracks: Vec<_> = outcome.recording.events.iter().filter(|e| e.kind == EventKind::Crack).collect();
        assert_eq!(
            cracks.iter().map(|e| Some(e.time)).collect::<Vec<_>>(),
            response.first_lift_off.map_or(vec![], |t| vec![Some(t)])
        );
        assert!(residual(&outcome) < 1e-7, "{}", residual(&outcome));
        let ends = if response.stop.fell() { StopReason::Collapsed } else { StopReason::Completed };
        assert_eq!(outcome.stop_reason, ends);
    }
    assert_eq!(lifted, 3);
}

/// Base shear is what changes the momentum of the wall: of one that rests, its mass times the acceleration of the ground, and of one that is thrown up by
/// an impulse the hinge bears what (OP10) leaves.
#[test]
fn base_shear_is_mass_times_absolute_acceleration() {
    let prepared = moved(&wall(1.0, 2.0, "[out_of_plane]\n[motion]\nduration = 5.0\n"), shaking());
    let outcome = run_in_memory(&prepared).expect("a run");
    let [shear, ground] = ["base/shear", "base/acceleration"].map(|name| outcome.history(name).expect("a channel"));
    let mass = 20e3 * 2.0 / concio::G;
    assert_eq!(outcome.rocking.as_ref().map(|rocking| rocking.lift_offs), Some(0));
    for (shear, ground) in shear.iter().zip(&ground) {
        assert!((shear - mass * ground).abs() <= 1e-9 * mass);
    }
    // Of a wall that rocks it is the derivative of the momentum along the section, where no impact comes between samples.
    let fine = wall(0.5, 4.0, &format!("{LEANS}[motion]\nduration = 5.0\n[output]\ninterval = 5e-4\n"));
    let fine = moved(&fine, shaking());
    let (outcome, response) = (run_in_memory(&fine).expect("a run"), alone(&fine));
    let [shear, ground, velocity] = ["base/shear", "base/acceleration", "block/lower/velocity"]
        .map(|name| outcome.history(name).expect("a channel"));
    let (mass, dt) = (20e3 * 0.5 * 4.0 / concio::G, 5e-4);
    let instants: Vec<f64> = response.events.iter().map(|event| event.time).collect();
    let mut compared = 0;
    for k in 1..shear.len() - 1 {
        let t = outcome.recording.time[k];
        if instants.iter().any(|instant| (instant - t).abs() < 2.0 * dt) {
            continue;
        }
        let along = mass * ((velocity[k + 1] - velocity[k - 1]) / (2.0 * dt) + ground[k]);
        assert!((along - shear[k]).abs() < 2e-3 * mass, "{t}: {along} and {}", shear[k]);
        compared += usize::from(velocity[k] != 0.0);
    }
    assert!(compared > 1000, "{compared}");
}

/// A state that is kept goes on with the same bits; one of another wall is refused.
#[test]
fn a_run_that_is_taken_up_goes_on_with_the_same_bits() {
    let rest = format!(
        "{LEANS}[[out_of_plane.anchor]]\nz = 3.5\nstiffness = 2e6\nyield_force = 3e3\n[motion]\nduration = 6.0\n"
    );
    let prepared = moved(&wall(0.4, 4.0, &rest), shaking());
    let whole = run_in_memory(&prepared).expect("a run");
    let new = || Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling).expect("a simulation");
    for steps in [1, 70, 333, 801] {
        let mut first = new();
        assert_eq!(first.advance(steps), Progress::Running);
        let mut rows = first.recording().clone();
        let kept = first.save();
        let mut second = new();
        assert!(second.restore(&kept));
        let (rest, reason) = second.run_to_end();
        rows.append(&rest);
        assert_eq!(second.outcome(rows, reason), whole);
    }
    let other = moved(&wall(0.4, 4.0, "[out_of_plane]\n[motion]\nduration = 6.0\n"), shaking());
    let mut stranger = Simulation::new(&other.model, &other.case.solver, &other.sampling).expect("a simulation");
    assert!(!stranger.restore(&new().save()) && !new().restore(b"nothing"));
}

/// Whatever the number of threads, a run has the same bits.
#[test]
fn threads_change_nothing() {
    let ready: Vec<Prepared> = (0..6)
        .map(|k| moved(&wall(0.4 + 0.02 * k as f64, 4.0, &format!("{LEANS}[motion]\nduration = 6.0\n")), shaking()))
        .collect();
    let jobs: Vec<Job> = ready.iter().map(Job::from).collect();
    let [one, four] = [1, 4].map(|threads| simulate_many(&jobs, threads));
    for ((one, four), prepared) in one.iter().zip(&four).zip(&ready) {
        let [one, four] = [one, four].map(|outcome| outcome.as_ref().expect("a run"));
        assert!(one == four && *one == run_in_memory(prepared).expect("a run"));
    }
}

/// A pulse of one sine overturns a wall from a certain peak on (S17).
#[test]
fn pulses_overturn_where_computed() {
    let falls = |period: f64, positive: &str, peak: f64| {
        let acceleration = peak * concio::G;
        let rest = format!(
            "{LEANS}[rocking]\nrestitution = 0.4708\npositive = \"{positive}\"\n[motion]\nduration = 40.0\n\
             base = {{ pulse = {{ shape = \"one-sine\", acceleration = {acceleration:?}, duration = {period:?} }} }}\n"
        );
        let prepared = prepared(&wall(0.4, 4.0, &rest));
        let outcome = run_in_memory(&prepared).expect("a run");
        assert_eq!(outcome.totals.collapse.is_some(), outcome.stop_reason == StopReason::Collapsed);
        let told = concio::run::warnings_of(&prepared.model, &[], &outcome);
        let chance = told.iter().any(|warning| warning.kind == WarningKind::Chance);
        (outcome.totals.collapse.is_some(), chance)
    };
    // A first half that pushes the wall inwards is a ground that goes outwards.
    for (period, positive, least) in [
        (0.4, "outwards", 0.48955),
        (0.8, "outwards", 0.28443),
        (0.8, "inwards", 0.54406),
        (1.6, "outwards", 0.18264),
        (1.6, "inwards", 0.24101),
    ] {
        assert!(!falls(period, positive, least * (1.0 - 1e-3)).0, "{period} s {positive}");
        assert!(falls(period, positive, least * (1.0 + 1e-3)).0, "{period} s {positive}");
        // Within a thousandth of the least that overturns it, chance decides, and not a twentieth beside it.
        assert!(falls(period, positive, least * (1.0 + 3e-4)).1, "{period} s {positive}");
        assert_eq!(falls(period, positive, least * 1.05), (true, false), "{period} s {positive}");
        assert_eq!(falls(period, positive, least * 0.95), (false, false), "{period} s {positive}");
    }
}

fn record(name: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("CONCIO_SHARED").map_or(beside, PathBuf::from).join("records/itaca_esm");
    let path = folder.join(name);
    if !path.is_file() {
        concio_verified::skip(&format!("{name} (shared/ not found)"));
        return None;
    }
    Some(path)
}

/// The wall under a record as a user's file names it.
fn under(record: &Path, size: [f64; 2], rest: &str) -> Outcome {
    let motion = format!("[motion]\nbase = {{ record = '{}' }}\n", record.display());
    run_in_memory(&prepared(&wall(size[0], size[1], &format!("{LEANS}{rest}{motion}")))).expect("a run")
}

/// Records at which walls stand and fall (S18, S19), and what a tie makes of it (S20).
#[test]
fn records_shake_walls_as_computed() {
    let (Some(norcia), Some(mirandola)) =
        (record("IT.NRC..HGE.D.20161030.064018.C.ACC.ASC"), record("IT.MRN..HNN.D.20120529.070002.C.ACC.ASC"))
    else {
        return;
    };
    let over = |outcome: &Outcome| outcome.rocking.as_ref().map_or(f64::NAN, |rocking| rocking.peak_over_d0);
    let stays = under(&norcia, [0.4, 4.0], "[rocking]\nrestitution = 0.0\n");
    agrees!("Rocking walls: peak under a record; Norcia, e 0", SOURCE, "θ0", over(&stays), 0.84543, 1e-3);
    let drift = stays.worst_drift().expect("a drift");
    agrees!("Rocking walls: when; Norcia, e 0", SOURCE, "s", drift.time, 12.66, 1e-3);
    assert!(residual(&stays) < 1e-6, "{}", residual(&stays));
    let reversed = under(&norcia, [0.6, 6.0], "[rocking]\nrestitution = 0.47\npositive = \"outwards\"\n");
    agrees!("Rocking walls: peak under a record; Norcia, reversed", SOURCE, "θ0", over(&reversed), 0.32993, 1e-3);
    let stands = under(&mirandola, [0.6, 6.0], "");
    agrees!("Rocking walls: peak under a record; Mirandola", SOURCE, "θ0", over(&stands), 0.56604, 1e-3);
    let falls = under(&mirandola, [0.4, 4.0], "");
    assert_eq!(falls.stop_reason, StopReason::Collapsed);
    // It lies a little after θ = 1.5.
    let collapse = falls.totals.collapse.expect("a fall");
    assert!(collapse.time > 25.34 && collapse.time < 25.40, "{}", collapse.time);
    let tie = |force: &str| {
        format!(
            "[[out_of_plane.anchor]]\nz = 3.9\nstiffness = 2e6\nyield_force = {force}\n[rocking]\nrestitution = 0.0\n"
        )
    };
    let elastic = under(&norcia, [0.4, 4.0], &tie("1e6"));
    agrees!("Rocking walls: peak with a tie; elastic", SOURCE, "θ0", over(&elastic), 0.0135012, 1e-3);
    let yields = under(&norcia, [0.4, 4.0], &tie("8e3"));
    agrees!("Rocking walls: peak with a tie; it yields", SOURCE, "θ0", over(&yields), 0.0157952, 1e-3);
    agrees!("Rocking walls: set of the tie", SOURCE, "m", yields.ties[0].stretch, 2.13971e-3, 1e-3);
    assert!(yields.ties[0].yielded.is_finite() && yields.ties[0].to == "lower");
}

/// Where no duration is given, a wall has time to fall after its motion.
#[test]
fn a_wall_falls_after_its_motion_too() {
    // It is left beyond d0 when a long pulse ends.
    let motion = |rest: &str| {
        let at = |k: usize| if k < 80 { 2.2 } else { 0.0 };
        let text = wall(0.4, 4.0, &format!("{LEANS}[motion]\n{rest}"));
        let file = from_str(&text, Syntax::Toml, None).expect("a wall");
        let base = GroundMotion::sampled(0.01, &(0..=85).map(at).collect::<Vec<f64>>()).expect("a motion");
        prepare_moved(&file, base).unwrap_or_else(|e| panic!("{e}"))
    };
    let cut = run_in_memory(&motion("duration = 0.85\n")).expect("a run");
    assert_eq!((cut.stop_reason, cut.totals.collapse), (StopReason::Completed, None));
    let told: Vec<WarningKind> = {
        let prepared = motion("duration = 0.85\n");
        concio::run::warnings_of(&prepared.model, &[], &cut).iter().map(|warning| warning.kind).collect()
    };
    assert!(told.contains(&WarningKind::UnderWay), "{told:?}");
    let whole = run_in_memory(&motion("duration = 30.0\n")).expect("a run");
    assert!(whole.totals.collapse.is_some_and(|collapse| collapse.time > 0.85));
}

/// What the file lacks or has in vain is told with its key.
#[test]
fn what_a_rocking_wall_cannot_have_is_refused() {
    const MOVES: &str = "[motion]\nduration = 1.0\nbase = { sine = { acceleration = 1.0, frequency = 1.0 } }\n";
    let motion = "[motion]\nduration = 1.0\n";
    let refused = |rest: String| {
        let file = from_str(&wall(0.4, 4.0, &rest), Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
        prepare(&file).err().map_or_else(String::new, |error| error.to_string())
    };
    for (rest, says) in [
        (motion.to_string(), "model: a rocking wall turns out of its plane"),
        (
            format!("[out_of_plane]\n[load]\nbeam = \"tied\"\n{motion}"),
            "load.beam: a rocking wall does not read the key",
        ),
        (format!("[out_of_plane]\n{motion}quasi_static = true\n"), "motion.quasi_static"),
        (format!("[out_of_plane]\n{motion}[output]\njoints = [\"all\"]\n"), "output.joints"),
        (format!("[out_of_plane]\n[solver]\ntolerance = 1e-3\n{motion}"), "solver.tolerance"),
        (
            format!("[out_of_plane]\n[rocking]\nmechanism = \"gable\"\n{MOVES}"),
            "rocking.mechanism: the wall has no gable",
        ),
        (format!("[out_of_plane]\n[rocking]\nhinge = 1.0\n{motion}"), "rocking.hinge: a level without a mechanism"),
        (
            format!("[out_of_plane]\n[rocking]\nmechanism = \"overturning\"\nhinge = 1.0\n{MOVES}"),
            "rocking.hinge: no hinge of its overturning lies at 1 m; allowed: 0 m",
        ),
        (format!("[out_of_plane]\n[rocking]\nrestitution = 1.5\n{motion}"), "rocking.restitution"),
        (
            format!(
                "[[out_of_plane.floor]]\nz = 4.0\nload = 5e3\nthrust = 9e3\n[rocking]\nmechanism = \"overturning\"\n{MOVES}"
            ),
            "rocking.mechanism: overturning: the wall turns under its own loads",
        ),
        // A tie of 20 kN would hold it; it begins at no force.
        (
            format!(
                "[[out_of_plane.floor]]\nz = 4.0\nload = 5e3\nthrust = 9e3\n[[out_of_plane.anchor]]\nz = 4.0\nyield_force = 20e3\n\
                 [rocking]\nmechanism = \"overturning\"\n{MOVES}"
            ),
            "Its ties, which begin at no force, do not hold it yet: with their full force α0 is 0.",
        ),
        // N of 37 kN over 80 kPa needs 0.46 m, more than the 0.4 m that there are: the hinge is taken to lie on the other face.
        (
            format!("[out_of_plane]\nstrength = 80e3\n[[out_of_plane.floor]]\nz = 4.0\nload = 5e3\nthrust = 1e3\n[rocking]\nmechanism = \"overturning\"\n{MOVES}"),
            "Masonry of this out_of_plane.strength crushes under it",
        ),
        (
            "[out_of_plane]\n[motion]\nduration = 1.0\ntop = { sine = { acceleration = 1.0, frequency = 1.0 } }\n".to_string(),
            "motion.top: a rocking wall does not read the key; allowed: none: `motion.base` moves the wall",
        ),
        (
            "[out_of_plane]\n[motion]\nduration = 1.5\nbase = { pulse = { shape = \"half-sine\", acceleration = 3.4, duration = 1.0, start = 2.0 } }\n"
                .to_string(),
            "motion.base.pulse.start: 2 s is when the run has ended: nothing would move; allowed: below motion.duration, 1.5 s",
        ),
    ] {
        let told = refused(rest.clone());
        assert!(told.contains(says), "{rest}\n{told}");
    }
    let planar =
        wall(0.4, 4.0, &format!("[rocking]\nrestitution = 0.2\n{motion}")).replace("\"rocking\"", "\"planar\"");
    let file = from_str(&planar, Syntax::Toml, None).expect("a file");
    let told = prepare(&file).err().map_or_else(String::new, |error| error.to_string());
    assert!(told.contains("rocking: the table is for walls that rock out of their plane"), "{told}");
}

/// Keys of joints that a rocking wall does not read, and motions that hardly move it, are told with what does it.
#[test]
fn slips_of_rocking_walls_are_told() {
    let told = |rest: &str| {
        let prepared = prepared(&wall(0.4, 4.0, rest));
        let outcome = run_in_memory(&prepared).expect("a run");
        concio::run::warnings_of(&prepared.model, &[], &outcome)
    };
    let under =
        |base: &str, duration: f64| told(&format!("{LEANS}[motion]\nduration = {duration:?}\nbase = {{ {base} }}\n"));
    let pulse = |keys: &str| format!("pulse = {{ shape = \"half-sine\", acceleration = \"0.35 g\", {keys} }}");
    // α0 = 0.1: half a sine of 500 s reaches 0.35 g sin(4π/500), which would have to be 11.4 times as strong.
    for (base, duration, kind, says) in [
        (
            pulse("duration = 500"),
            4.0,
            WarningKind::RecordCut,
            "motion.duration cuts the motion of the base, which ends at 500 s: 4 s of it is used, and its acceleration reaches 0.0088 g of 0.35 g",
        ),
        (
            pulse("duration = 500"),
            4.0,
            WarningKind::UnlikelyRecord,
            "the wall rests: its motion within the run would have to be 11.4 times as strong to lift it off, which takes 0.1 g",
        ),
        (
            pulse("duration = 1").replace("half-sine", "ricker"),
            0.5,
            WarningKind::RecordCut,
            "motion.duration cuts the motion of the base",
        ),
        (
            pulse("duration = 1").replace("0.35", "-0.35"),
            2.0,
            WarningKind::UnlikelyRecord,
            "the wall rests: nothing in the motion within the run acts in the direction that lifts it off, which takes 0.1 g",
        ),
        (
            "synthetic = { seed = 1, pga = \"3.5 g\", duration = 12 }".into(),
            12.0,
            WarningKind::RarePeak,
            "motion.base: its peak acceleration is 3.5 g as it moves the wall, more than 2 g, which few records have",
        ),
    ] {
        let found = under(&base, duration);
        assert!(found.iter().any(|w| w.kind == kind && w.starts_with(says)), "{base}: {found:?}");
    }
    let fine = under(&pulse("duration = 1"), 2.0);
    let doubts = [WarningKind::RecordCut, WarningKind::UnlikelyRecord, WarningKind::RarePeak, WarningKind::ScaledByG];
    assert!(fine.iter().all(|w| !doubts.contains(&w.kind)), "{fine:?}");
    let idle = |bed: &str| {
        let text =
            wall(0.4, 4.0, &format!("{LEANS}[motion]\nduration = 1.0\nbase = {{ {} }}\n", pulse("duration = 1")));
        let warnings = prepared(&text.replacen("law = \"rigid\"", bed, 1)).model.warnings;
        warnings.into_iter().filter(|w| w.kind == WarningKind::IdleKey).map(|w| w.text).collect::<Vec<_>>()
    };
    for (bed, says) in [
        (
            "law = \"rigid\", restitution = 0.5",
            "joint.bed.restitution does nothing in a rocking wall: `rocking.restitution` is that of its impacts",
        ),
        (
            "law = \"rigid\", rocking_restitution = 0.5",
            "joint.bed.rocking_restitution does nothing in a rocking wall: `rocking.restitution` is that of its impacts",
        ),
        (
            "law = \"no-tension\", stiffness = \"10 N/mm3\", compressive_strength = \"0.3 MPa\"",
            "joint.bed.compressive_strength does nothing in a rocking wall: `out_of_plane.strength` sets its hinges back",
        ),
    ] {
        assert_eq!(idle(bed), [says], "{bed}");
    }
    assert_eq!(idle("law = \"rigid\""), [""; 0]);
    // A change that would have to be mended elsewhere: it does nothing, and that is what is told.
    let changed = told(&format!(
        "[[joint.change]]\nat = {{ kind = [\"bed\"] }}\nfriction = {{ static = 0.2 }}\n{LEANS}[motion]\nduration = 1.0\nbase = {{ {} }}\n",
        pulse("duration = 0.5")
    ));
    let says = "joint.bond and joint.change do nothing in a rocking wall";
    assert!(changed.iter().any(|w| w.kind == WarningKind::IdleKey && w.starts_with(says)), "{changed:?}");
    // Nothing moves it at all.
    let still = told(&format!("{LEANS}[motion]\nduration = 4.0\n"));
    let says = "motion.base is at rest, and so is motion.vertical: nothing moves the wall";
    assert_eq!(still.iter().filter(|w| w.kind == WarningKind::UnlikelyRecord).collect::<Vec<_>>(), [says]);
    // A tie of so much slack bears nothing before the wall falls.
    let loose = told(&format!(
        "{LEANS}[[out_of_plane.anchor]]\nz = 3.9\nyield_force = 20e3\nstiffness = 2e7\nslack = 5\n[motion]\nduration = 1.0\nbase = {{ {} }}\n",
        pulse("duration = 0.5")
    ));
    for says in ["out_of_plane.anchor[0].slack is 5 m", "the tie at 3.90 m bears nothing before the wall would fall"] {
        assert!(loose.iter().any(|w| w.starts_with(says)), "{loose:?}");
    }
}
