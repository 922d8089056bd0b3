//! Incremental dynamic analysis of walls that slide: Newmark's block at every intensity, and the ways to get there.

use std::path::Path;

use concio::run::Control;
use concio_study::Runner;
use concio_study::file::Keep;
use concio_study::ida::curve::{fractiles, fragilities};
use concio_study::ida::likelihood::Evidence;
use concio_study::ida::{Analysis, pooled, tables};
use concio_study::table::Cells;

use crate::common::Desk;

/// A panel that cannot deform to speak of, on a joint without spring and with Coulomb's friction of 0.2.
const BLOCK: &str = r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
bed = { law = "none" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.2, dynamic = 0.2 }
[motion]
duration = "3 s"
base = "none"
[solver]
tolerance = 1e-5
"#;

const T: f64 = 0.2;
const FRICTION: f64 = 0.2 * 9.81;

/// Slip under a rectangle of acceleration a: V²/2 (1/(μg) − 1/a), V = a T.
fn rectangle(a: f64) -> f64 {
    if a <= FRICTION { 0.0 } else { 0.5 * (a * T).powi(2) * (1.0 / FRICTION - 1.0 / a) }
}

/// Slip under half a sine of peak a: from sin πt₁/T = μg/a on the relative velocity is
/// w = aT/π (cos πt₁/T − cos πt/T) − μg (t − t₁) up to T, and falls with μg after; the block stops where w = 0.
fn half_sine(a: f64) -> f64 {
    use std::f64::consts::PI;
    if a <= FRICTION {
        return 0.0;
    }
    let t1 = T / PI * (FRICTION / a).asin();
    let (v, cos, sin) = (a * T / PI, (PI * t1 / T).cos(), (PI * t1 / T).sin());
    let speed = |t: f64| v * (cos - (PI * t / T).cos()) - FRICTION * (t - t1);
    let path = |t: f64| v * (cos * (t - t1) - T / PI * ((PI * t / T).sin() - sin)) - 0.5 * FRICTION * (t - t1).powi(2);
    if speed(T) > 0.0 {
        return path(T) + 0.5 * speed(T).powi(2) / FRICTION;
    }
    // Fastest where the pulse falls below the friction again, at T − t₁.
    let (mut low, mut high) = (T - t1, T);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if speed(middle) > 0.0 { low = middle } else { high = middle }
    }
    path(low)
}

const PULSES: &str = r#"
wall = "wall.toml"
[[motion]]
name = "rectangle"
base = { pulse = { shape = "rectangular", acceleration = "0.5 g", duration = "0.2 s", start = "0.1 s" } }
[[motion]]
name = "half sine"
base = { pulse = { shape = "half-sine", acceleration = "0.5 g", duration = "0.2 s", start = "0.1 s" } }
"#;

/// Runs an analysis to its end; how many runs it took.
fn run(analysis: &mut Analysis, out: &Path) -> concio::Result<usize> {
    let go = |_: &concio_study::runner::Progress| Control::Continue;
    let mut runner = Runner::open(out, &Keep::default(), 1, &go)?;
    let mut asked = 0;
    loop {
        let questions = analysis.questions(&|_| true);
        if questions.is_empty() {
            return Ok(asked);
        }
        asked += questions.len();
        let cases = questions.iter().map(|(curve, y)| analysis.case(*curve, *y)).collect::<concio::Result<Vec<_>>>()?;
        let rows = runner.rows(&cases)?.expect("nobody stops it");
        for (question, row) in questions.into_iter().zip(&rows) {
            analysis.answer(question, row);
        }
    }
}

#[test]
fn the_reference_slips() {
    // The project's reference collection: 0.14715 m and 0.04495112308557409 m at 0.5 g.
    assert!((rectangle(4.905) - 0.14715).abs() < 1e-12);
    assert!((half_sine(4.905) - 0.04495112308557409).abs() < 1e-12);
}

#[test]
fn a_sliding_wall_slips_as_newmark_says_at_every_intensity() -> concio::Result<()> {
    let desk = Desk::new(BLOCK);
    let study = format!(
        "{PULSES}[ida]\ndamage = \"peak_joint_displacement\"\nlimits = [{{ name = \"5 cm\", value = \"50 mm\" }}]\n\
         intensities = [\"0.1 g\", \"0.25 g\", \"0.4 g\", \"0.5 g\", \"0.7 g\", \"1 g\"]\n"
    );
    let plan = desk.plan(&study)?;
    let mut analysis = Analysis::new(&plan)?.expect("the study has [ida]");
    assert_eq!(run(&mut analysis, &desk.path("out"))?, 12);
    for curve in &analysis.curves {
        assert!(curve.failed.is_none() && curve.points.len() == 6, "{curve:?}");
        for p in &curve.points {
            let exact = if curve.name == "rectangle" { rectangle(p.intensity) } else { half_sine(p.intensity) };
            let slip = p.damage.unwrap_or(f64::NAN);
            assert!((slip - exact).abs() <= 1e-3 * exact + 1e-9, "{} at {}: {slip} {exact}", curve.name, p.intensity);
        }
    }
    // Capacities: where the closed form gives 5 cm, to what straight lines between the runs allow.
    for (curve, slip) in analysis.curves.iter().zip([rectangle as fn(f64) -> f64, half_sine]) {
        match curve.capacity(0.05) {
            Evidence::At(found) => {
                assert!((slip(found) / 0.05 - 1.0).abs() < 0.12, "{} {found}: {}", curve.name, slip(found));
            }
            Evidence::Within([low, high]) => assert!(slip(low) < 0.05 && slip(high) >= 0.05 && high > 1.25 * low),
            other => panic!("{}: {other:?}", curve.name),
        }
    }
    let curves: Vec<_> = analysis.curves.iter().collect();
    let middle = fractiles(&curves);
    assert!(middle.iter().all(|(y, q)| q[0] <= q[1] && q[1] <= q[2] && *y >= 0.98));
    let found = fragilities(&analysis.settings, &curves);
    assert_eq!(found.iter().map(|f| f.method).collect::<Vec<_>>(), ["capacities", "stripes"]);
    assert!(found[0].fit.is_ok());
    Ok(())
}

/// PGV of a rectangle is aT, of half a sine 2aT/π; a stiff oscillator has Sa = PGA, and an undamped one under a lasting step
/// twice that: with 5 % damping 1 + e^(−πζ/√(1 − ζ²)), as long as the rectangle lasts half its period.
#[test]
fn intensities_of_pulses() -> concio::Result<()> {
    use concio_study::intensity::Intensity;
    let desk = Desk::new(BLOCK);
    let plan = desk.plan(PULSES)?;
    let of = |run: usize, intensity: Intensity, period: f64| intensity.of(&plan.case(run)?, period);
    let a = 0.5 * 9.81;
    let near = |found: f64, exact: f64, allowed: f64| {
        assert!((found / exact - 1.0).abs() < allowed, "{found} {exact}");
    };
    near(of(0, Intensity::Pga, 0.0)?, a, 1e-12);
    near(of(1, Intensity::Pga, 0.0)?, a, 1e-5);
    near(of(0, Intensity::Pgv, 0.0)?, a * T, 1e-9);
    near(of(1, Intensity::Pgv, 0.0)?, 2.0 * a * T / std::f64::consts::PI, 1e-9);
    near(of(1, Intensity::Sa, 1e-3)?, a, 1e-2);
    let overshoot = (-std::f64::consts::PI * 0.05 / (1.0f64 - 0.0025).sqrt()).exp();
    near(of(0, Intensity::Sa, 0.1)?, a * (1.0 + overshoot), 1e-2);
    assert_eq!(of(0, Intensity::Scale, 0.0)?, 1.0);
    Ok(())
}

/// Hunt and fill asks the same questions again when it is taken up: the store answers them all.
#[test]
fn hunting_is_taken_up_where_it_was() -> concio::Result<()> {
    let desk = Desk::new(BLOCK);
    let study = format!(
        "{PULSES}[ida]\ndamage = \"peak_joint_displacement\"\ncollapse = \"300 mm\"\n\
         limits = [{{ name = \"1 cm\", value = \"10 mm\" }}, {{ name = \"10 cm\", value = 0.1 }}]\n\
         hunt = {{ first = \"0.1 g\", step = \"0.2 g\", most = \"3 g\", runs = 16 }}\n"
    );
    let plan = desk.plan(&study)?;
    let out = desk.path("out");
    let mut first = Analysis::new(&plan)?.expect("the study has [ida]");
    assert_eq!(run(&mut first, &out)?, 32);
    let bytes = || std::fs::metadata(out.join("runs/part-0001.jsonl")).expect("a part").len();
    let before = bytes();
    let mut again = Analysis::new(&plan)?.expect("the study has [ida]");
    run(&mut again, &out)?;
    assert_eq!(first.curves, again.curves);
    assert_eq!(before, bytes());
    for (curve, slip) in first.curves.iter().zip([rectangle as fn(f64) -> f64, half_sine]) {
        let collapse = curve.points.iter().position(|p| p.collapsed).expect("a collapse");
        let [low, high] = [curve.points[collapse - 1].intensity, curve.points[collapse].intensity];
        assert!(slip(low) < 0.3 && slip(high) >= 0.3 && high / low < 1.1 + 1e-9, "{low} {high}");
        for limit in [0.01, 0.1] {
            let (low, high) = curve.bracket(limit).expect("a crossing");
            let low = low.map_or(0.0, |low| low.intensity);
            assert!(slip(low) < limit && slip(high.intensity) >= limit && high.intensity / low < 1.1 + 1e-9, "{low}");
        }
    }
    Ok(())
}

/// A draw of parameters with each motion is a curve of its own; the fragility then holds their scatter too.
#[test]
fn curves_are_the_runs_of_the_design() -> concio::Result<()> {
    let desk = Desk::new(BLOCK);
    let study = format!(
        "{PULSES}[design]\nkind = \"latin-hypercube\"\nruns = 6\n[[vary]]\npath = \"joint.friction.dynamic\"\n\
         from = 0.1\nto = 0.2\n[ida]\ndamage = \"peak_joint_displacement\"\nlimits = [{{ name = \"a\", value = \"20 mm\" }}]\n\
         intensities = [\"0.2 g\", \"0.6 g\", \"1.2 g\"]\n"
    );
    let plan = desk.plan(&study)?;
    let mut analysis = Analysis::new(&plan)?.expect("the study has [ida]");
    assert_eq!(analysis.curves.len(), 6);
    run(&mut analysis, &desk.path("out"))?;
    assert!(analysis.curves.iter().all(|c| c.points.len() == 3 && c.name.contains(", ")));
    assert_eq!(analysis.curves.iter().filter(|c| c.name.ends_with("rectangle")).count(), 3);
    Ok(())
}

/// Under one motion draws tell of themselves alone, and a study says so. Motions that a factor changes are motions of their own.
#[test]
fn one_motion_is_no_sample_of_records() -> concio::Result<()> {
    let desk = Desk::new(BLOCK);
    let pulse = PULSES.split("[[motion]]\nname = \"half").next().unwrap_or_default();
    let asked = "[ida]\ndamage = \"peak_joint_displacement\"\nlimits = [{ name = \"a\", value = \"20 mm\" }]\n\
                 hunt = { first = \"0.1 g\", step = \"0.2 g\", most = \"3 g\", runs = 10 }\n";
    let of =
        |design: &str, vary: &str| desk.plan(&format!("{pulse}[design]\nkind = {design}\n[[vary]]\n{vary}\n{asked}"));
    let drawn = "\"latin-hypercube\"\nruns = 8";
    let friction = of(drawn, "path = \"joint.friction.dynamic\"\nfrom = 0.1\nto = 0.2")?;
    assert_eq!(friction.motions(), [0; 8]);
    assert!(friction.one_motion().is_some_and(|told| told.contains("the scatter between records is not in")));
    assert_eq!(pooled(&friction), None);
    let two = desk.plan(&format!("{PULSES}{asked}"))?;
    assert_eq!((two.motions(), two.one_motion()), (vec![0, 1], None));
    let shaken = "base = { pulse = { shape = \"half-sine\", acceleration = 4, duration = \"0.2 s\" } }";
    let of_wall = |path: &str| {
        let rest = "from = 1\nto = 2\n[cracks]\ncriterion = \"slip\"\n";
        let vary = format!("[[vary]]\npath = \"motion.base.pulse.{path}\"\n{rest}");
        let study = format!("wall = \"wall.toml\"\n[design]\nkind = {drawn}\n{vary}");
        Desk::new(&BLOCK.replace("base = \"none\"", shaken)).plan(&study)
    };
    let (long, strong) = (of_wall("duration")?, of_wall("acceleration")?);
    assert_eq!((long.motions(), long.one_motion()), ((0..8).collect(), None));
    assert!(strong.motions() == [0; 8] && strong.one_motion().is_some());
    for (plan, ends) in [(&friction, false), (&two, true)] {
        let mut analysis = Analysis::new(plan)?.expect("the study has [ida]");
        run(&mut analysis, &desk.path(if ends { "two" } else { "friction" }))?;
        let found = fragilities(&analysis.settings, &analysis.curves.iter().collect::<Vec<_>>());
        let fit = found[0].fit.as_ref().expect("a fit");
        assert!(fit.dispersion_interval[1].is_finite() && fit.plausible().is_some() == ends, "{found:?}");
        let told = tables::fits(&analysis.settings, &found).columns.into_iter().find(|c| c.name == "note");
        let Some(Cells::Texts(notes)) = told.map(|c| c.cells) else { panic!("no notes") };
        assert_eq!(notes[0].as_ref().is_some_and(|note| note.contains("scatter between records")), !ends, "{notes:?}");
    }
    // Values of a grid are no sample.
    let grid = of("\"grid\"", "path = \"joint.friction.dynamic\"\nvalues = [0.1, 0.15, 0.2]")?;
    assert!(pooled(&grid).is_some_and(
        |told| told.contains("`joint.friction.dynamic`") && told.contains("its dispersion holds their spread")
    ));
    Ok(())
}

/// A slender stone that turns over from 0.2 g on: its runs end when it has, and every number that is asked for is that of runs
/// that go on.
#[test]
fn runs_of_planar_walls_end_with_their_collapse_where_nothing_later_is_asked() -> concio::Result<()> {
    let stone = r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = 0.2, height = 1.0, thickness = 0.5, specific_weight = 20e3 }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "rigid" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.8 }
[motion]
duration = "6 s"
base = "none"
"#;
    let study = |damage: &str, keep: &str| {
        format!(
            "wall = \"wall.toml\"\n{keep}[[motion]]\nname = \"a\"\nbase = {{ tilt = {{ acceleration = 1, rise = \"10 ms\" }} }}\n\
             [ida]\ndamage = \"{damage}\"\nlimits = [{{ name = \"rocks\", value = \"{}\" }}]\nintensities = [\"0.15 g\", \"0.3 g\", \"0.5 g\"]\n",
            if damage == "peak_displacement" { "1 mm" } else { "1" }
        )
        .replace("\"1\"", "1")
    };
    let desk = Desk::new(stone);
    let plan = desk.plan(&study("peak_displacement", ""))?;
    let (mut stops, mut goes) =
        (Analysis::new(&plan)?.expect("an analysis"), Analysis::new(&plan)?.expect("an analysis"));
    assert!(stops.stops, "the peaks of a planar run are those before a collapse");
    goes.stops = false;
    let _ = [run(&mut stops, &desk.path("a"))?, run(&mut goes, &desk.path("b"))?];
    let told = |analysis: &Analysis| -> Vec<(f64, Option<u64>, bool)> {
        let points = analysis.curves.iter().flat_map(|curve| &curve.points);
        points.map(|p| (p.intensity, p.damage.map(f64::to_bits), p.collapsed)).collect()
    };
    assert_eq!(told(&stops), told(&goes));
    assert_eq!(told(&stops).iter().map(|p| p.2).collect::<Vec<_>>(), [false, true, true]);
    let steps = |folder: &str| -> concio::Result<f64> {
        let store = concio_study::store::Store::open(&desk.path(folder))?;
        let analysis = if folder == "a" { &stops } else { &goes };
        let ids = analysis.curves.iter().flat_map(|curve| &curve.points).map(|p| p.id.clone());
        Ok(ids.filter_map(|id| store.get(&id)?.number("steps")).sum())
    };
    let (fewer, all) = (steps("a")?, steps("b")?);
    assert!(fewer < 0.7 * all && fewer > 0.0, "{fewer} of {all} steps");
    // Energies go on after it, and whole results are asked for.
    for (damage, keep) in [("friction_energy", ""), ("peak_displacement", "[keep]\nresults = true\n")] {
        let plan = desk.plan(&study(damage, keep))?;
        assert!(!Analysis::new(&plan)?.expect("an analysis").stops, "{damage} {keep}");
    }
    Ok(())
}
