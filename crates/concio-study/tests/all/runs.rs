//! Runs of a study: the same bits whoever does them, nothing lost, nothing stopped by one that fails.

use std::collections::HashSet;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

use concio::case::{Case, Signal, Syntax, from_str};
use concio::dice::Dice;
use concio::many::{Job, Standing, Until, simulate_each};
use concio::outcome::Outcome;
use concio::run::{Control, prepare, run_in_memory};
use concio_study::Plan;
use concio_study::file::{Keep, PerJoint};
use concio_study::measures::{End, MEASURES, Row, row};
use concio_study::runner::{Progress, Runner};
use concio_study::store::Store;

use crate::common::Desk;

const WALL: &str = r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 3
bricks = 2
[load]
top = "10 kN/m"
beam = "driven"
[motion]
duration = "20 ms"
top = { sine = { amplitude = "5 mm", frequency = "20 Hz" } }
"#;

type Anyhow = Result<(), Box<dyn std::error::Error>>;

fn cases(plan: &Plan) -> concio::Result<Vec<Case>> {
    (0..plan.points.len()).map(|i| plan.case(i)).collect()
}

fn go_on(_: &Progress) -> Control {
    Control::Continue
}

fn keep() -> Keep {
    Keep { joints: vec![PerJoint::Displacement, PerJoint::Dissipation], results: false }
}

const TWENTY: &str = r#"
wall = "wall.toml"
[design]
kind = "latin-hypercube"
runs = 20
seed = 3
[[vary]]
path = "joint.friction.static"
from = 0.4
to = 0.8
also = [{ path = "joint.friction.dynamic", times = 0.7 }]
[[vary]]
path = "load.top"
distribution = { law = "lognormal", median = "10 kN/m", dispersion = 0.3 }
"#;

/// What is told of a model's runs before they are done is what they have: a number for each measure of theirs, of others none, or 0.
#[test]
fn measures_are_those_of_the_model() -> Anyhow {
    // Of what may not come there is no time.
    let moments = ["first_crack", "collapse", "first_lift_off"];
    for text in [
        WALL,
        include_str!("../../../../examples/01-first-wall.toml"),
        include_str!("../../../../examples/19-rocking-facade.toml"),
    ] {
        let file = from_str(text, Syntax::Toml, None)?.changed(&[("motion.duration".into(), "1 s".into())])?;
        let prepared = prepare(&file)?;
        let row = row("one", &prepared, &run_in_memory(&prepared)?, &[]);
        for measure in MEASURES.iter().filter(|measure| !moments.contains(&measure.name)) {
            let number = row.number(measure.name);
            match measure.is_of(file.case.model) {
                true => assert!(number.is_some(), "{:?}: {}", file.case.model, measure.name),
                false => assert_eq!(number.unwrap_or(0.0), 0.0, "{:?}: {}", file.case.model, measure.name),
            }
        }
    }
    Ok(())
}

#[test]
fn threads_shards_and_order_do_not_change_a_bit() -> Anyhow {
    let desk = Desk::new(WALL);
    let plan = desk.plan(TWENTY)?;
    let cases = cases(&plan)?;
    let run = |name: &str, threads: usize, order: &[usize]| -> concio::Result<Vec<Row>> {
        let mut runner = Runner::open(&desk.path(name), &keep(), threads, &go_on)?;
        for &i in order {
            runner.rows(&cases[i..=i])?;
        }
        Ok(runner.rows(&cases)?.unwrap_or_default())
    };
    let alone = run("one", 1, &[])?;
    assert_eq!(alone.len(), 20);
    assert!(alone.iter().all(|r| r.end == End::Completed && r.number("top_work").is_some_and(|w| w > 0.0)));
    let ids: HashSet<&String> = alone.iter().map(|r| &r.id).collect();
    assert_eq!(ids.len(), 20);
    for (name, threads, order) in [("two", 2, &[][..]), ("five", 5, &[7, 3, 19][..])] {
        let other = run(name, threads, order)?;
        // As text, in which every digit stands.
        assert_eq!(serde_json::to_string(&other)?, serde_json::to_string(&alone)?, "{name}");
    }
    // Shards in one folder.
    for share in [2, 0, 1] {
        let mut runner = Runner::open(&desk.path("shards"), &keep(), 1, &go_on)?;
        let mine: Vec<Case> = cases.iter().skip(share).step_by(3).cloned().collect();
        runner.rows(&mine)?;
    }
    let together = run("shards", 1, &[])?;
    assert_eq!(serde_json::to_string(&together)?, serde_json::to_string(&alone)?);
    assert_eq!(fs::read_dir(desk.path("shards/runs"))?.count(), 3, "the last call had nothing to run");
    Ok(())
}

#[test]
fn what_is_known_is_not_run_again_unless_more_is_kept() -> Anyhow {
    static RUNS: AtomicUsize = AtomicUsize::new(0);
    fn counted(
        jobs: &[Job],
        threads: usize,
        until: Option<&Until>,
        watch: &(dyn Fn(Standing) -> Control + Sync),
        keep: &(dyn Fn(usize, concio::Result<Outcome>) + Sync),
    ) {
        RUNS.fetch_add(jobs.len(), Ordering::Relaxed);
        simulate_each(jobs, threads, until, watch, keep);
    }
    let desk = Desk::new(WALL);
    let plan = desk.plan(TWENTY)?;
    let cases = cases(&plan)?;
    let out = desk.path("out");
    // The same wall twice in one call is one run.
    let doubled: Vec<Case> = cases.iter().chain(&cases).cloned().collect();
    let rows = Runner::open(&out, &Keep::default(), 2, &go_on)?.solved_by(counted).rows(&doubled)?;
    assert_eq!(rows.map(|r| r.len()), Some(40));
    assert_eq!(RUNS.load(Ordering::Relaxed), 20);
    Runner::open(&out, &Keep::default(), 2, &go_on)?.solved_by(counted).rows(&cases)?;
    assert_eq!(RUNS.load(Ordering::Relaxed), 20);
    let rows = Runner::open(&out, &keep(), 2, &go_on)?.solved_by(counted).rows(&cases)?.unwrap_or_default();
    assert_eq!(RUNS.load(Ordering::Relaxed), 40);
    assert!(rows.iter().all(|r| r.joints.len() == 2));
    let results = Keep { joints: Vec::new(), results: true };
    Runner::open(&out, &results, 2, &go_on)?.solved_by(counted).rows(&cases[..2])?;
    assert_eq!(RUNS.load(Ordering::Relaxed), 42);
    assert_eq!(fs::read_dir(out.join("results"))?.count(), 2);
    Ok(())
}

/// A kept result is more than a file that is there: cut off, another run's, or of another bit anywhere, it is made again and told.
#[test]
fn kept_results_that_are_not_what_was_written_are_made_again() -> Anyhow {
    static RUNS: AtomicUsize = AtomicUsize::new(0);
    fn counted(
        jobs: &[Job],
        threads: usize,
        until: Option<&Until>,
        watch: &(dyn Fn(Standing) -> Control + Sync),
        keep: &(dyn Fn(usize, concio::Result<Outcome>) + Sync),
    ) {
        RUNS.fetch_add(jobs.len(), Ordering::Relaxed);
        simulate_each(jobs, threads, until, watch, keep);
    }
    let desk = Desk::new(WALL);
    let plan = desk.plan(TWENTY)?;
    let cases = &cases(&plan)?[..2];
    let out = desk.path("out");
    let results = Keep { joints: Vec::new(), results: true };
    let ids = cases.iter().map(|case| plan.id(case)).collect::<concio::Result<Vec<_>>>()?;
    Runner::open(&out, &results, 2, &go_on)?.rows(cases)?;
    let store = Store::open(&out)?;
    let [path, other] = [0, 1].map(|i| store.result_path(&ids[i]));
    let (whole, others) = (fs::read(&path)?, fs::read(&other)?);
    assert!(whole != others);
    let mut dice = Dice::new(1);
    let flips = (0..20).map(|_| {
        let (at, bit) = (dice.below(whole.len()), dice.below(8));
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << bit;
        bytes
    });
    let bad = flips.chain([Vec::new(), whole[..1000].to_vec(), whole[..whole.len() - 1].to_vec(), others]);
    for (n, bytes) in bad.enumerate() {
        fs::write(&path, bytes)?;
        let mut runner = Runner::open(&out, &results, 2, &go_on)?.solved_by(counted);
        runner.rows(cases)?;
        assert_eq!(RUNS.load(Ordering::Relaxed), n + 1);
        assert!(fs::read(&path)? == whole, "{n}: it was not made again");
        let told: Vec<_> = runner.store().faults().iter().map(|f| (f.path.clone(), f.line)).collect();
        assert_eq!(told, [(path.clone(), None)], "{n}");
        // Known to be whole now.
        runner.rows(cases)?;
        assert_eq!(RUNS.load(Ordering::Relaxed), n + 1);
    }
    // A look at the ends alone tells what was cut off or is another's, and no more.
    let looked = |bytes: &[u8]| -> concio::Result<bool> {
        fs::write(&path, bytes).map_err(|e| concio::Error::io(&path, e))?;
        let mut store = Store::open(&out)?;
        store.look_at_results(ids.iter().map(String::as_str), false);
        let known = store.holding(&ids[0], &[], true).is_some();
        assert_eq!(store.faults().is_empty(), known);
        Ok(known)
    };
    assert!(looked(&whole)? && !looked(&whole[..1000])? && !looked(&fs::read(&other)?)?);
    // What somebody took away is made again, and no fault.
    fs::remove_file(&path)?;
    let mut runner = Runner::open(&out, &results, 2, &go_on)?;
    runner.rows(cases)?;
    assert!(fs::read(&path)? == whole && runner.store().faults().is_empty());
    Ok(())
}

#[test]
fn a_run_that_panics_is_recorded_and_the_others_go_on() -> Anyhow {
    /// Panics, in the middle of others, over the run with the largest top load.
    fn panicking(
        jobs: &[Job],
        threads: usize,
        until: Option<&Until>,
        watch: &(dyn Fn(Standing) -> Control + Sync),
        keep: &(dyn Fn(usize, concio::Result<Outcome>) + Sync),
    ) {
        let bad = |job: &Job| job.model.shear.rubs.iter().any(|r| r.normal[0] > 7e3);
        if let Some(place) = jobs.iter().position(bad) {
            simulate_each(&jobs[..place], threads, until, watch, keep);
            panic!("one too heavy");
        }
        simulate_each(jobs, threads, until, watch, keep);
    }
    let desk = Desk::new(WALL);
    let text = TWENTY.replace("runs = 20", "runs = 6");
    let text = text.split("[[vary]]").take(2).collect::<Vec<_>>().join("[[vary]]")
        + "[[vary]]\npath = \"load.top\"\nvalues = [\"10 kN/m\", \"60 kN/m\"]\n";
    let plan = desk.plan(&text)?;
    let cases = cases(&plan)?;
    let out = desk.path("out");
    let rows = Runner::open(&out, &keep(), 1, &go_on)?.solved_by(panicking).rows(&cases)?.unwrap_or_default();
    let failed: Vec<&Row> = rows.iter().filter(|r| r.end == End::Failed).collect();
    assert_eq!((rows.len(), failed.len()), (6, 3));
    assert!(failed.iter().all(|r| r.cause.as_deref() == Some("panicked: one too heavy")));
    assert!(rows.iter().filter(|r| r.end == End::Completed).all(|r| r.number("steps").is_some()));
    Ok(())
}

#[test]
fn a_stopped_study_goes_on_where_it_was() -> Anyhow {
    let desk = Desk::new(WALL);
    let mut cases = cases(&desk.plan(TWENTY)?)?;
    // Long enough for several looks.
    for case in &mut cases {
        case.motion.duration = Some(concio::quantity::Time::from_si(0.4));
    }
    let out = desk.path("out");
    // Some runs are over by then: they are done eight at a time.
    let stop = |progress: &Progress| if progress.share > 0.6 { Control::Stop } else { Control::Continue };
    assert_eq!(Runner::open(&out, &keep(), 1, &stop)?.rows(&cases)?, None, "it was not stopped");
    let done = Store::open(&out)?.len();
    assert!(0 < done && done < cases.len(), "{done} of {} runs were over", cases.len());
    let known = AtomicUsize::new(0);
    let go_on_with = |progress: &Progress| {
        known.store(progress.known, Ordering::Relaxed);
        Control::Continue
    };
    let ended = Runner::open(&out, &keep(), 1, &go_on_with)?.rows(&cases)?;
    assert_eq!(known.into_inner(), done, "what was over is not done again");
    let whole = Runner::open(&desk.path("whole"), &keep(), 1, &go_on)?.rows(&cases)?;
    assert!(ended.is_some() && ended == whole);
    Ok(())
}

/// What came in is what moves, what is stretched and what was dissipated, in all its ways: cracks and impacts take their part.
#[test]
fn dissipation_closes_the_balance_of_a_wall_that_cracks() -> Anyhow {
    let bond = "[joint.bond]\ntensile_strength = \"0.05 MPa\"\ncohesion = \"0.05 MPa\"\nmode_1_energy = \"5 N/m\"\nmode_2_energy = \"20 N/m\"\n[load]";
    let desk = Desk::new(&WALL.replace("[load]", bond).replace("20 ms", "50 ms"));
    let plan = desk.plan("wall = \"wall.toml\"\n")?;
    let rows = Runner::open(&desk.path("out"), &keep(), 1, &go_on)?.rows(&cases(&plan)?)?.unwrap_or_default();
    let of = |name: &str| rows[0].number(name).unwrap_or(f64::NAN);
    let dissipated = of("dissipated_energy");
    let rest = of("base_work") + of("top_work") - of("kinetic_energy") - of("elastic_energy");
    println!("{dissipated} J, {rest} J, of bonds {} J, impacts {} J", of("bond_energy"), of("impact_energy"));
    assert!(of("bond_energy") > 1e-3 * dissipated, "{} J of {dissipated} J", of("bond_energy"));
    assert!((dissipated / rest - 1.0).abs() < 1e-4, "{dissipated} J against {rest} J");
    Ok(())
}

#[test]
fn an_id_knows_the_content_of_records_and_not_their_place() -> Anyhow {
    let desk = Desk::new(WALL);
    let record = |scale: f64| (0..200).map(|i| format!("{}\n", scale * (0.1 * f64::from(i)).sin())).collect::<String>();
    for (name, scale) in [("a.txt", 1.0), ("b.txt", 1.0), ("c.txt", 2.0)] {
        fs::write(desk.path(name), record(scale))?;
    }
    let study = |name: &str| {
        format!(
            "wall = \"wall.toml\"\n[[motion]]\nname = \"x\"\nbase = {{ record = \"{name}\", units = \"m/s2\", dt = 0.005 }}\n"
        )
    };
    let id = |name: &str| -> concio::Result<String> {
        let plan = desk.plan(&study(name))?;
        plan.id(&plan.case(0)?)
    };
    assert_eq!(id("a.txt")?, id("b.txt")?);
    assert_ne!(id("a.txt")?, id("c.txt")?);
    Ok(())
}

/// A vertical record goes with its motion, from the study's folder, and scales as the horizontal one does; without one the wall keeps its own, from
/// the wall's folder.
#[test]
fn a_motion_brings_its_vertical_record() -> Anyhow {
    let planar = "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 3\nbricks = 2\nmortar = { bed = 0, head = 0 }\n\
                  brick = { length = 0.25, height = 0.12, thickness = 0.25, specific_weight = 18e3 }\n[joint]\n\
                  bed = { law = \"rigid\" }\nhead = { law = \"rigid\" }\n[joint.friction]\nlaw = \"coulomb\"\nstatic = 0.6\n\
                  dynamic = 0.6\n[motion]\n";
    let own = "vertical = { record = \"own.txt\", units = \"m/s2\", dt = 0.01 }\n";
    let desk = Desk::new("");
    fs::create_dir(desk.path("walls"))?;
    fs::write(desk.path("walls/wall.toml"), format!("{planar}{own}"))?;
    for name in ["walls/own.txt", "x.txt", "up.txt"] {
        fs::write(desk.path(name), "0\n1\n2\n-1\n0\n")?;
    }
    let record = |name: &str| format!("{{ record = \"{name}\", units = \"m/s2\", dt = 0.01 }}");
    let plan = desk.plan(&format!(
        "wall = \"walls/wall.toml\"\nscales = [3.0]\n[[motion]]\nname = \"a\"\nbase = {}\nvertical = {}\n\
         [[motion]]\nname = \"b\"\nbase = {}\n",
        record("x.txt"),
        record("up.txt"),
        record("x.txt")
    ))?;
    for (run, file) in ["up.txt", "walls/own.txt"].into_iter().enumerate() {
        let motion = plan.case(run)?.motion;
        let of = |signal: Signal| match signal {
            Signal::Record(record) => (record.record, record.scale),
            other => panic!("{other:?}"),
        };
        assert_eq!(of(motion.base), (desk.path("x.txt"), Some(3.0)));
        assert_eq!(of(motion.vertical), (desk.path(file), Some(3.0)), "run {run}");
    }
    Ok(())
}

#[test]
fn every_factor_reaches_the_wall() -> Anyhow {
    let desk = Desk::new(WALL);
    let text = r#"
wall = "wall.toml"
scales = [1.0, 2.0]
[[vary]]
name = "texture"
choices = [
  { name = "as it is" },
  { name = "stack", set = { "panel[0].bond" = "stack", "panel[0].courses" = 4 } },
]
[[vary]]
path = "panel[*].brick.length"
from = "200 mm"
to = "300 mm"
count = 3
[[motion]]
name = "sine"
base = { sine = { acceleration = "0.2 g", frequency = "3 Hz" } }
duration = "30 ms"
"#;
    let plan = desk.plan(text)?;
    assert_eq!(plan.points.len(), 2 * 3 * 2);
    let mut seen = HashSet::new();
    for number in 0..plan.points.len() {
        let case = plan.case(number)?;
        let labels = plan.labels(number);
        let stack = labels[0] == "stack";
        assert_eq!(case.panels[0].courses, Some(if stack { 4 } else { 3 }));
        let length = case.panels[0].brick.length.si();
        assert!(
            labels[1].as_str().is_some_and(|l| l.starts_with(&format!("{:?}", 1e3 * length))),
            "{labels:?} {length}"
        );
        let concio::case::Signal::Sine(sine) = &case.motion.base else { panic!("another motion") };
        let acceleration = sine.acceleration.map_or(0.0, |a| a.si());
        let scale = labels[3].as_f64().unwrap_or(0.0);
        assert!((acceleration - 0.2 * 9.80665 * scale).abs() < 0.01 * acceleration, "{acceleration} at {scale}");
        assert_eq!(case.motion.duration.map(|d| d.si()), Some(0.03));
        seen.insert(plan.id(&case)?);
    }
    assert_eq!(seen.len(), plan.points.len());
    Ok(())
}

/// What is wrong, where, and what is allowed.
#[test]
fn wrong_study_files() {
    let cases: &[(&str, &str, usize)] = &[
        ("wall = \"none.toml\"", "there is no file", 1),
        ("title = \"none\"", "the key is missing", 1),
        ("wall = \"wall.toml\"\ncolour = 1", "unknown key", 2),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nvalues = [1, 2,\n 1.0]", "stands here twice", 5),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nvalues = [\"1 kN/m\", \"1.0 kN/m\"]", "twice", 4),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"joint.frction.static\"\nvalues = [1]", "unknown key", 3),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"panel[7].bricks\"\nvalues = [1]", "1 elements", 3),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nvalues = []", "it is empty", 2),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nvalues = [1]\nfrom = 1\nto = 2", "contradict", 5),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nvalues = [\"10 kg\"]", "not a unit", 4),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nfrom = 1\nto = 2", "no values for a grid", 2),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nfrom = 2\nto = 1\ncount = 3", "does not lie above", 5),
        (
            "wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nfrom = \"1 N/m\"\nto = \"2 kN/m\"\ncount = 2",
            "its unit",
            5,
        ),
        (
            "wall = \"wall.toml\"\n[design]\nkind = \"random\"\n[[vary]]\npath = \"load.top\"\nfrom = 1\nto = 2",
            "this design needs it",
            2,
        ),
        (
            "wall = \"wall.toml\"\n[design]\nkind = \"morris\"\nruns = 2\nlevels = 5\n[[vary]]\npath = \"load.top\"\nfrom = 1\nto = 2",
            "out of range",
            5,
        ),
        (
            "wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nvalues = [1]\n[[vary]]\nname = \"again\"\npath = \"load.top\"\nvalues = [2]",
            "both change load.top",
            5,
        ),
        (
            "wall = \"wall.toml\"\n[[vary]]\nname = \"a\"\npath = \"panel[*].brick.height\"\nvalues = [0.05]\n[[vary]]\nname = \"b\"\npath = \"panel[0].brick.height\"\nvalues = [0.06]",
            "both change panel[0].brick.height",
            6,
        ),
        (
            "wall = \"wall.toml\"\n[[vary]]\nname = \"a\"\npath = \"joint.friction.static\"\nvalues = [0.5]\n[[vary]]\nname = \"b\"\npath = \"group.static\"\nvalues = [0.6]",
            "both change group.static",
            6,
        ),
        (
            "wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nvalues = [1]\nalso = [{ path = \"load.top\", times = 2 }]",
            "changes load.top twice",
            2,
        ),
        (
            "wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nvalues = [\"1 kN/m\", \"900 N/m\"]",
            "its unit is `N/m`",
            4,
        ),
        (
            "wall = \"wall.toml\"\nscales = [1, 2]\n[[vary]]\npath = \"group.acceleration\"\nvalues = [1e-6]",
            "both set the strength of the motion",
            2,
        ),
        (
            "wall = \"wall.toml\"\n[design]\nkind = \"sobol\"\nruns = 65537\n[[vary]]\npath = \"load.top\"\nfrom = 1\nto = 2",
            "too many for the sequence",
            4,
        ),
        (
            "wall = \"wall.toml\"\n[design]\nkind = \"list\"\n[[vary]]\npath = \"load.top\"\nvalues = [1, 2]\n[[vary]]\npath = \"panel[0].courses\"\nvalues = [3]",
            "equally many",
            7,
        ),
        ("wall = \"wall.toml\"\n[[motion]]\nname = \"x\"\nbase = { record = \"gone.at2\" }", "there is no file", 4),
        (
            "wall = \"wall.toml\"\n[[motion]]\nname = \"x\"\nbase = \"none\"\nvertical = { record = \"gone.at2\" }",
            "there is no file",
            5,
        ),
        (
            "wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\nfrom = 1\nto = 2\ncount = 18446744073709551615",
            "from 2 to 10000",
            6,
        ),
        ("wall = \"wall.toml\"\nscales = [1, 0]", "out of range", 2),
        (
            "wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\ndistribution = { law = \"normal\", mean = 1, deviation = 0 }\n[design]\nkind = \"random\"\nruns = 3",
            "make no distribution",
            4,
        ),
        (
            "wall = \"wall.toml\"\n[[vary]]\npath = \"load.top\"\ndistribution = { law = \"uniform\", low = 1, high = 2, mean = 1 }",
            "no meaning for this law",
            4,
        ),
        ("wall = \"wall.toml\"\n[[vary]]\npath = \"joint.friction.static\"\nvalues = [0.1]", "dynamic", 2),
    ];
    for (text, says, line) in cases {
        let desk = Desk::new(WALL);
        let all = || -> concio::Result<()> {
            let plan = desk.plan(text)?;
            (0..plan.points.len()).try_for_each(|i| plan.case(i).map(drop))
        };
        match all() {
            Ok(()) => panic!("taken: {text}"),
            Err(concio::Error::Input(e)) => {
                let said = e.to_string();
                assert!(said.contains(says), "{text}\n  says: {said}");
                assert!(e.file.as_ref().is_some_and(|f| f.ends_with("study.toml")), "{text}: {said}");
                assert_eq!(e.line, Some(*line), "{text}: {said}");
            }
            Err(other) => panic!("{text}: {other}"),
        }
    }
}
