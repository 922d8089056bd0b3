//! What a study asks of which runs, in words: for `concio study check`, and for the first section of every report, from
//! which a reader judges the rest.

use std::path::Path;

use concio::case::plausible::rounded;
use concio::case::{Baseline, Case, ModelKind, Signal, TopLoad};
use concio::ground::coverage::{Coverage, coverage};
use concio::run::prepare_with;
use concio_study::Plan;
use concio_study::design::{scarce, unreached};
use concio_study::file::analyses::{DeviceInput, ObjectiveInput, Over, Target};
use concio_study::file::{Choice, Design, DesignKind, Distribution, DistributionLaw, Follower, Spacing, Study, Vary};
use concio_study::ida::pooled;
use concio_study::measures::{End, Row};
use concio_study::ranking;
use concio_study::table::Table;
use concio_study::warned::{Before, Warned};
use serde_json::Value;

use super::page::Section;
use crate::format::{counted, plain, seconds, short};
use crate::motion;

/// What no result of the shear model tells, for every report of many of its runs.
const SHEAR: &str = "Limits of the model: every block moves horizontally in the plane of the wall and in no other way. \
    Blocks do not rock, turn, lift off or fall, units neither split nor crush, nothing moves out of plane. The normal force \
    of a joint, which friction and cohesion work with, is that of weight and load at rest; it does not change while the \
    wall moves, and neither do overlaps. The model therefore knows no collapse: large slip, opening or drift says how far \
    joints moved, not that a real wall would stand it.";

/// The same of walls that rock out of their plane.
const ROCKING: &str = "Limits of the rocking model: one mechanism of rigid bodies out of the plane, whose hinges neither slide nor crush on. \
     The restitution of impacts is chosen, not known; a record has no sign that a façade knows (rocking.positive); masonry that \
     disintegrates falls before it turns.";
/// The same of the planar model.
const PLANAR: &str = "Limits of the planar model: blocks are rigid and stay in the plane of the wall. A joint has all the give \
    there is, cracks run along joints and never through a block, leaves do not part, and nothing moves out of plane. A run \
    counts as collapsed from the first block that falls: its peaks, slips and openings are those of the time until then.";

/// Values that a list shows.
const MOST_VALUES: usize = 12;

/// The questions; empty where the study asks none beside its runs.
pub fn questions(plan: &Plan) -> Vec<String> {
    let study = &plan.file.study;
    let mut asked = Vec::new();
    if let Some(s) = &study.sensitivity {
        asked.push(format!("sensitivity of {}", s.of.join(", ")));
    }
    if let Some(ida) = &study.ida {
        let limits: Vec<&str> = ida.limits.iter().map(|l| l.name.as_str()).collect();
        let (damage, over) = (&ida.damage, ida.intensity.name());
        asked.push(format!("incremental dynamic analysis: {damage} over {over}, limits {}", limits.join(", ")));
    }
    if let Some(first) = &study.first_crack {
        let motions = counted(plan.points.len(), "motion");
        asked.push(format!("first cracking ({}) under {motions}", first.criterion.name()));
    }
    if let Some(cracks) = &study.cracks {
        asked.push(format!("crack lines ({})", cracks.criterion.name()));
    }
    if let Some(r) = &study.ranking {
        let by: Vec<&str> = r.by.iter().map(|by| ranking::name(*by)).collect();
        asked.push(format!("critical joints by {}", by.join(", ")));
    }
    if let Some(interfaces) = &study.interfaces {
        let most = match (interfaces.count, interfaces.share) {
            (Some(most), _) => counted(most, "joint"),
            (None, Some(share)) => format!("{} % of all joints", plain(100.0 * share)),
            (None, None) => "the joints".into(),
        };
        asked.push(format!("smart interfaces: which devices in at most {most}"));
    }
    asked
}

/// How the runs are chosen; `one` is what the design's points are: runs, curves, cases.
pub fn design(plan: &Plan, one: &str) -> String {
    let Design { kind, runs, seed, levels } = plan.file.study.design;
    let points = counted(plan.points.len(), one);
    let drawn = counted(runs.unwrap_or(0), "base point");
    match kind {
        _ if plan.factors.is_empty() => format!("{points} of the wall as it is"),
        DesignKind::Grid => format!("grid, every value with every other: {points}"),
        DesignKind::List => format!("list, first values together, second values together and so on: {points}"),
        DesignKind::LatinHypercube => format!("Latin hypercube: {points}, seed {seed}"),
        DesignKind::Random => format!("independent draws: {points}, seed {seed}"),
        DesignKind::Morris => {
            let trajectories = if runs == Some(1) { "trajectory" } else { "trajectories" };
            format!("Morris: {} {trajectories} on {levels} levels, {points}, seed {seed}", runs.unwrap_or(0))
        }
        DesignKind::Sobol => format!("Sobol: {drawn}, {points}, seed {seed}"),
    }
}

/// A factor: its name, the keys that it changes and over what it varies.
pub fn factors(study: &Study) -> Vec<[String; 3]> {
    let mut factors: Vec<[String; 3]> = study.factors.iter().map(factor).collect();
    if !study.motions.is_empty() {
        let over = format!("{}, listed below", counted(study.motions.len(), "motion"));
        factors.push(["motion".into(), "motion.base".into(), over]);
    }
    if !study.scales.is_empty() {
        let over = listed(study.scales.iter().map(|s| plain(*s)));
        factors.push(["scale".into(), "factor on motion.base".into(), over]);
    }
    factors
}

fn factor(vary: &Vary) -> [String; 3] {
    let path = vary.path.clone().unwrap_or_default();
    let mut keys: Vec<String> = if path.is_empty() { Vec::new() } else { vec![path.clone()] };
    for Choice { set, .. } in &vary.choices {
        keys.extend(set.keys().filter(|k| !keys.contains(k)).cloned().collect::<Vec<_>>());
    }
    keys.extend(vary.also.iter().map(|Follower { path, times }| format!("{path} × {}", plain(*times))));
    let over = match (&vary.distribution, &vary.from, &vary.to) {
        (Some(distribution), ..) => distributed(distribution),
        (None, Some(from), Some(to)) => {
            let ends = format!("{} to {}", text(from), text(to));
            match (vary.count, vary.spacing) {
                (Some(count), Spacing::Linear) => format!("{ends}, {count} values at equal distances"),
                (Some(count), Spacing::Log) => format!("{ends}, {count} values at equal ratios"),
                (None, Spacing::Linear) => format!("{ends}, uniform"),
                (None, Spacing::Log) => format!("{ends}, uniform in the logarithm"),
            }
        }
        _ if !vary.choices.is_empty() => listed(vary.choices.iter().map(|c| c.name.clone())),
        _ => listed(vary.values.iter().map(text)),
    };
    [vary.name.clone().unwrap_or(path), keys.join(", "), over]
}

fn distributed(d: &Distribution) -> String {
    let name = match d.law {
        DistributionLaw::Uniform => "uniform",
        DistributionLaw::LogUniform => "uniform in the logarithm",
        DistributionLaw::Normal => "normal",
        DistributionLaw::Lognormal => "lognormal",
        DistributionLaw::Triangular => "triangular",
    };
    let dispersion = d.dispersion.map(Value::from);
    let [low, high] = match d.law {
        DistributionLaw::Normal | DistributionLaw::Lognormal => ["cut off below", "cut off above"],
        _ => ["from", "to"],
    };
    let parameters = [
        ("mean", &d.mean),
        ("deviation", &d.deviation),
        ("median", &d.median),
        ("dispersion", &dispersion),
        ("mode", &d.mode),
        (low, &d.low),
        (high, &d.high),
    ];
    let given = parameters.into_iter().filter_map(|(name, value)| Some(format!("{name} {}", text(value.as_ref()?))));
    [name.to_string()].into_iter().chain(given).collect::<Vec<_>>().join(", ")
}

/// The motions of a study, each made ready once: name, motion, what becomes of it.
///
/// # Errors
/// A wall or a motion that cannot be made ready.
pub fn shaking(plan: &Plan) -> concio::Result<Vec<[String; 3]>> {
    let (study, wall) = (&plan.file.study, &plan.file.wall);
    let varied = varied_of_motion(study);
    let mut motions = Vec::new();
    for place in 0..study.motions.len().max(1) {
        let input = study.motions.get(place);
        let run = (0..plan.points.len()).find(|&n| plan.motion(n).is_none_or(|m| m == place));
        let cut = run.map(|number| cut(plan, number, place)).transpose()?.flatten();
        let usage = match (varied.is_empty(), cut) {
            (false, _) => Some(format!("{} varied", varied.join(", "))),
            (true, Some(cut)) => Some(cut),
            (true, None) => input.and_then(|m| m.duration).map(|d| format!("{} long", seconds(d.si()))),
        };
        motions.push(match input {
            Some(m) => {
                let held = m.held_out.then(|| "held out".to_string());
                let more: Vec<String> = usage.into_iter().chain(held).collect();
                [m.name.clone(), in_words(&m.base), more.join(", ")]
            }
            None => match varied.iter().find(|path| ["motion", "motion.base"].contains(path)) {
                Some(path) => ["varied".into(), path.to_string(), String::new()],
                None => ["of the wall file".into(), in_words(&wall.case.motion.base), usage.unwrap_or_default()],
            },
        });
    }
    Ok(motions)
}

/// How much is used, where that is a part, of the record of run `number`, whose motion stands at `place` in the study file.
fn cut(plan: &Plan, number: usize, place: usize) -> concio::Result<Option<String>> {
    let case = plan.case(number)?;
    let wall = &plan.file.wall;
    let of_study = !plan.file.study.motions.is_empty();
    let (mut base, mut start) = (wall.case.clone(), wall.folder());
    base.output = case.output.clone();
    if of_study {
        // That of the run starts from the working directory.
        (base.motion, start) = (case.motion.clone(), Path::new(""));
    }
    let library = &plan.library;
    let from = |case: Case, start| prepare_with(case, start, library).map(|prepared| (prepared, start));
    // A wall file may leave to the factors what a run cannot do without.
    let prepared = from(base, start).or_else(|_| from(case, Path::new("")));
    let key = if of_study { format!("motion[{place}]") } else { "wall".to_string() };
    let (prepared, start) = prepared.map_err(|e| plan.file.of_wall(&key, e))?;
    let record = match &prepared.case.motion.base {
        Signal::Record(input) => Some(library.record(input, start)?),
        Signal::Synthetic(input) => Some(library.synthetic(input)?),
        _ => None,
    };
    let duration = prepared.model.excitation.duration;
    let cut = record.filter(|record| coverage(record, duration) == Coverage::Cut);
    Ok(cut.map(|record| format!("{} of {} used", seconds(duration), seconds(record.duration()))))
}

/// What the runs of a plan warn of as far as it is known before they are done, of some of them.
pub fn before(plan: &Plan) -> Before {
    let mut before = concio_study::warned::before(plan.points.len(), |n| plan.case(n).ok(), |n| run_name(plan, n));
    for number in 0..plan.points.len() {
        before.read.add(|| run_name(plan, number), &plan.unit_doubts(number));
    }
    of_study(plan, &mut before.read);
    of_study(plan, &mut before.warned);
    // Where the study names them, they are to differ.
    if plan.sets("rocking.mechanism") || plan.sets("rocking.hinge") {
        before.gaps.clear();
    }
    before.gaps.extend(of_design(plan));
    before
}

/// What the study sets is no number of the wall file, whose line would be told, even where it is the same in all runs.
fn of_study(plan: &Plan, warned: &mut Warned) {
    for told in &mut warned.told {
        let key = told.first.split(' ').next().unwrap_or_default().trim_end_matches(':');
        told.same &= !plan.sets(key);
    }
}

/// What is to be known of the study's design before anything is run.
fn of_design(plan: &Plan) -> Vec<String> {
    let question =
        plan.file.study.interfaces.is_some().then(|| concio_study::interfaces::question(plan).ok()).flatten();
    let study = &plan.file.study;
    let runs = match study.design.kind {
        DesignKind::Morris | DesignKind::Sobol => study.design.runs.unwrap_or(0),
        _ => plan.points.len(),
    };
    let ordered = plan.factors.iter().filter(|factor| factor.is_ordered() && factor.levels() != Some(1)).count();
    let few = study.sensitivity.is_some().then(|| scarce(study.design.kind, runs, ordered)).flatten();
    let doubts = plan
        .doubts
        .iter()
        .cloned()
        .chain(plan.one_motion())
        .chain(pooled(plan))
        .chain(concio_study::ida::doubts::of_numbers(&plan.file))
        .chain(unreached(&plan.factors, &plan.points));
    doubts.chain(few).chain(question.and_then(|q| q.too_few())).collect()
}

/// What the runs that are known warn of.
pub fn warned(plan: &Plan, found: &[Option<&Row>]) -> Warned {
    let mut warned = Warned::default();
    for (number, row) in found.iter().enumerate().filter_map(|(number, row)| Some((number, (*row)?))) {
        warned.add(|| run_name(plan, number), &[plan.unit_doubts(number), row.warnings.clone()].concat());
    }
    of_study(plan, &mut warned);
    warned
}

/// What a run is called: its number and its values.
fn run_name(plan: &Plan, number: usize) -> String {
    match values(plan, number) {
        values if values.is_empty() => format!("run {}", number + 1),
        values => format!("run {} ({values})", number + 1),
    }
}

/// A motion in a line, with what is taken off a record.
fn in_words(signal: &Signal) -> String {
    let text = motion::short(signal);
    let Signal::Record(input) = signal else { return text };
    match input.baseline {
        Baseline::None => text,
        Baseline::Polynomial(degree) => format!("{text}, baseline: polynomial of degree {degree} subtracted"),
        Baseline::HighPass { corner, order } => {
            format!("{text}, baseline: high-pass at {} Hz, order {order}", plain(corner.si()))
        }
    }
}

/// Key paths and groups of the base's motion that `vary` changes.
fn varied_of_motion(study: &Study) -> Vec<&str> {
    let mut varied = Vec::new();
    for vary in &study.factors {
        let keys = vary.choices.iter().flat_map(|choice| choice.set.keys());
        let paths = vary.path.iter().chain(vary.also.iter().map(|f| &f.path)).chain(keys).map(String::as_str);
        for path in paths {
            let groups = ["group.frequency", "group.acceleration", "group.duration"];
            let of_motion = path == "motion" || ["motion.base", "motion.duration"].iter().any(|p| path.starts_with(p));
            if (of_motion || groups.contains(&path)) && !varied.contains(&path) {
                varied.push(path);
            }
        }
    }
    varied
}

/// An objective: `mean peak_drift, small`.
pub fn objective(objective: &ObjectiveInput) -> String {
    let over = match objective.over {
        Over::Mean => "mean",
        Over::Worst => "worst",
    };
    let large = match objective.goal {
        Some(goal) => goal == concio_study::file::analyses::Goal::Maximise,
        None => matches!(objective.measure, Target::DissipatedEnergy | Target::FirstCracking),
    };
    format!("{over} {} as {} as can be", objective.measure.title(), if large { "large" } else { "small" })
}

/// The free parameters of a device with their bounds; `as it is` for one without.
pub fn bounds(device: &DeviceInput) -> Vec<[String; 2]> {
    let one = |p: &concio_study::file::analyses::ParameterInput| {
        let log = if p.spacing == Spacing::Log { ", at equal ratios" } else { "" };
        let also: String = p.also.iter().map(|f| format!("; {} × {}", f.path, plain(f.times))).collect();
        [p.path.clone(), format!("{} to {}{log}{also}", text(&p.from), text(&p.to))]
    };
    if device.parameters.is_empty() {
        return vec![[String::new(), "as it is".into()]];
    }
    device.parameters.iter().map(one).collect()
}

/// A value as the file says it.
pub fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

/// The factors of a run with their values: `friction = 0.5, motion = Ricker`. Numbers that were drawn have six digits; the tables
/// have all.
pub fn values(plan: &Plan, number: usize) -> String {
    let labels = plan.factors.iter().zip(plan.labels(number));
    labels.map(|(f, l)| format!("{} = {}", f.name, brief(&text(&l)))).collect::<Vec<_>>().join(", ")
}

/// A number, with its unit if it has one, in six digits; any other text as it is.
fn brief(text: &str) -> String {
    let (number, unit) = text.split_once(' ').map_or((text, ""), |(number, unit)| (number, unit));
    match number.parse::<f64>() {
        Ok(v) if v.is_finite() => format!("{} {unit}", rounded(v, DIGITS)).trim_end().into(),
        _ => text.into(),
    }
}

/// Digits of a value where it tells runs apart.
const DIGITS: usize = 6;

fn listed(values: impl ExactSizeIterator<Item = String>) -> String {
    let all = values.len();
    let mut shown: Vec<String> = values.take(MOST_VALUES).collect();
    if all > MOST_VALUES {
        shown.push(format!("… ({all} in all)"));
    }
    shown.join(", ")
}

/// What was run, as `concio study check` prints it.
pub fn lines(plan: &Plan, one: &str, motions: &[[String; 3]]) -> Vec<(&'static str, String)> {
    let study = &plan.file.study;
    let mut rows: Vec<(&'static str, String)> = questions(plan).into_iter().map(|q| ("asks", q)).collect();
    rows.push(("wall", plan.file.wall.path().map_or(String::new(), |p| p.display().to_string())));
    rows.push(("design", design(plan, one)));
    let varied = factors(study).into_iter();
    rows.extend(varied.map(|[name, keys, over]| match keys == name || keys.is_empty() {
        true => ("varies", format!("{name}: {over}")),
        false => ("varies", format!("{name} ({keys}): {over}")),
    }));
    for [name, motion, more] in motions {
        let more = if more.is_empty() { String::new() } else { format!(", {more}") };
        rows.push(("motion", format!("{name}: {motion}{more}")));
    }
    if let Some(interfaces) = &study.interfaces {
        rows.extend(interfaces.objectives.iter().map(|o| ("objective", objective(o))));
        for device in &interfaces.devices {
            let bounds: Vec<String> =
                bounds(device).into_iter().map(|[path, over]| format!("{path} {over}").trim().into()).collect();
            rows.push(("device", format!("{}: {}", device.name, bounds.join("; "))));
        }
    }
    rows
}

/// Runs that did not end as they should, or are to be doubted, for [`section`].
#[derive(Debug, Default)]
pub struct Trouble {
    /// What runs warn of.
    pub warned: Warned,
    /// Sentences: how many runs there are and what became of them.
    pub told: Vec<String>,
    /// Those that have no complete result.
    pub runs: Option<Table>,
}

impl Trouble {
    /// Of the runs of a plan.
    pub fn of(plan: &Plan, found: &[Option<&Row>]) -> Trouble {
        let ended = |end: End| found.iter().flatten().filter(|r| r.end == end).count();
        let [completed, stopped, failed] = [End::Completed, End::Stopped, End::Failed].map(ended);
        let missing = found.iter().filter(|r| r.is_none()).count();
        let others = [(stopped, "stopped early"), (failed, "failed"), (missing, "not done yet")];
        let others: Vec<String> =
            others.into_iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
        let told = match (found.len(), others.is_empty()) {
            (1, true) => "The run was completed.".into(),
            (n, true) => format!("All {n} runs were completed."),
            (n, false) => format!("Of {}, {completed} completed, {}.", counted(n, "run"), others.join(", ")),
        };
        let bad: Vec<(usize, &Row)> = found
            .iter()
            .enumerate()
            .filter_map(|(i, r)| Some((i, (*r)?)))
            .filter(|(_, r)| r.end != End::Completed)
            .collect();
        let mut runs = Table::default();
        runs.numbers("run", "", bad.iter().map(|(i, _)| Some((i + 1) as f64)).collect());
        runs.texts("values", bad.iter().map(|(i, _)| Some(values(plan, *i))).collect());
        let end = |row: &Row| if row.end == End::Failed { "failed" } else { "stopped early" };
        runs.texts("ended", bad.iter().map(|(_, r)| Some(end(r).into())).collect());
        runs.texts("cause", bad.iter().map(|(_, r)| r.cause.clone()).collect());
        Trouble { warned: warned(plan, found), told: vec![told], runs: (!bad.is_empty()).then_some(runs) }
    }
}

/// How many runs warn, and of what: `12 of 12 (heavy-beam 12)`; none where none does.
pub fn counted_warnings(warned: &Warned) -> Option<String> {
    (warned.runs > 0).then(|| format!("in {} of {} ({})", warned.runs, counted(warned.of, "run"), warned.counts()))
}

/// What runs warn of, for the head of a report: a sentence and a table; none where there are none.
pub fn warning_table(warned: &Warned) -> Option<(String, (String, Table))> {
    let told = counted_warnings(warned)?;
    let mut table = Table::default();
    let all = &warned.told;
    table.texts("kind", all.iter().map(|t| Some(t.first.kind.name().into())).collect());
    table.numbers("runs", "", all.iter().map(|t| Some(t.runs as f64)).collect());
    table.texts("first in", all.iter().map(|t| Some(t.name.clone())).collect());
    table.texts("what it says there", all.iter().map(|t| Some(t.first.text.clone())).collect());
    Some((format!("Warnings {told}: read them before the results."), ("Warnings of the runs".into(), table)))
}

/// What no result of the model tells.
pub fn limits(model: ModelKind) -> &'static str {
    match model {
        ModelKind::Shear => SHEAR,
        ModelKind::Planar => PLANAR,
        ModelKind::Rocking => ROCKING,
    }
}

/// That of the models that runs of the study have.
fn models(plan: &Plan, case: Option<&Case>) -> Vec<&'static str> {
    if plan.file.study.factors.iter().any(|factor| factor.path.as_deref() == Some("model")) {
        return vec![SHEAR, PLANAR];
    }
    vec![limits(case.map_or(ModelKind::Shear, |case| case.model))]
}

/// The first section of a study's report; `one` is what a point of its design is.
///
/// # Errors
/// A wall that cannot be laid; as [`shaking`].
pub fn section(plan: &Plan, one: &str, case: Option<&Case>, trouble: Trouble) -> concio::Result<Section> {
    let study = &plan.file.study;
    let (doubts, doubted) = warning_table(&trouble.warned).unzip();
    let mut text: Vec<String> = doubts.into_iter().collect();
    let asked = questions(plan);
    if !asked.is_empty() {
        text.push(format!("Asked: {}.", asked.join("; ")));
    }
    text.push(format!("Design: {}.", design(plan, one)));
    text.extend(of_design(plan).into_iter().map(|told| format!("Warning: {told}.")));
    text.extend(case.map(wall).transpose()?);
    text.extend(trouble.told);
    text.extend(models(plan, case).into_iter().map(String::from));
    let mut tables: Vec<(String, Table)> = doubted.into_iter().collect();
    let factors = factors(study);
    if !factors.is_empty() {
        tables.push(("What varied".to_string(), words(["factor", "keys of the wall file", "over"], &factors)));
    }
    tables.push(("Motions of the base".into(), words(["motion", "what it is", "use"], &shaking(plan)?)));
    if let Some(interfaces) = &study.interfaces {
        let objectives: Vec<[String; 1]> = interfaces.objectives.iter().map(|o| [objective(o)]).collect();
        tables.push(("Objectives".into(), words(["objective"], &objectives)));
        let of = |d: &DeviceInput| {
            bounds(d).into_iter().map(|[path, over]| [d.name.clone(), path, over]).collect::<Vec<_>>()
        };
        let devices: Vec<[String; 3]> = interfaces.devices.iter().flat_map(of).collect();
        tables.push((
            "Devices and the bounds of their parameters".into(),
            words(["device", "parameter", "bounds"], &devices),
        ));
    }
    tables.extend(trouble.runs.map(|runs| ("Runs without a complete result".into(), runs)));
    Ok(Section { title: TITLE.into(), text, tables, ..Section::default() })
}

/// Heading of the first section.
pub const TITLE: &str = "What was run";

/// The wall of a run in a sentence.
///
/// # Errors
/// A wall that cannot be laid.
pub fn wall(case: &Case) -> concio::Result<String> {
    let wall = concio::pattern::lay(case)?;
    let joints = concio::graph::joints(&wall, case.load.beam != concio::case::Beam::Free).len();
    let panels =
        if wall.panels.len() == 1 { String::new() } else { format!("{}, ", counted(wall.panels.len(), "panel")) };
    let (load, unit) = match case.load.top {
        TopLoad::PerLength(load) => (load.si(), "N/m"),
        TopLoad::Force(load) => (load.si(), "N"),
    };
    let load = if load == 0.0 { String::new() } else { format!(", {} on top", short(load, unit)) };
    let beam = match case.load.beam {
        concio::case::Beam::Mass(mass) => format!(", a beam of {}", crate::draw::wall::mass(mass.si())),
        concio::case::Beam::Free => String::new(),
        concio::case::Beam::Driven => ", a driven beam".into(),
        concio::case::Beam::Tied => ", a beam tied to the base".into(),
    };
    let blocks = counted(wall.blocks.len(), "block");
    Ok(format!("Wall of the first run: {panels}{blocks}, {}{load}{beam}.", counted(joints, "joint")))
}

/// A table of words.
pub fn words<const N: usize>(names: [&str; N], rows: &[[String; N]]) -> Table {
    let mut table = Table::default();
    for (k, name) in names.into_iter().enumerate() {
        table.texts(name, rows.iter().map(|row| Some(row[k].clone())).collect());
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vary(text: &str) -> [String; 3] {
        let vary: Vary = serde_json::from_str(text).expect("an entry of `vary`");
        factor(&vary)
    }

    #[test]
    fn values_are_told_in_six_digits() {
        for (value, told) in [
            ("0.7073111615231241", "0.707311"),
            ("8.674290262018376 kN/m", "8.67429 kN/m"),
            ("0.6", "0.6"),
            ("250 mm", "250 mm"),
            ("1 of 2 records", "1 of 2 records"),
            ("quake.at2", "quake.at2"),
        ] {
            assert_eq!(brief(value), told);
        }
    }

    #[test]
    fn factors_in_words() {
        let [name, keys, over] = vary(
            r#"{ "name": "μ", "path": "joint.friction.static", "from": 0.4, "to": 0.8,
                "also": [{ "path": "joint.friction.dynamic", "times": 0.7 }] }"#,
        );
        assert_eq!(name, "μ");
        assert_eq!(keys, "joint.friction.static, joint.friction.dynamic × 0.7");
        assert_eq!(over, "0.4 to 0.8, uniform");
        let over = |text: &str| vary(text)[2].clone();
        assert_eq!(
            over(r#"{ "path": "load.top", "from": "1 kN/m", "to": "9 kN/m", "spacing": "log", "count": 3 }"#),
            "1 kN/m to 9 kN/m, 3 values at equal ratios"
        );
        assert_eq!(
            over(
                r#"{ "path": "a", "distribution": { "law": "lognormal", "median": "10 kN/m", "dispersion": 0.3,
                    "high": "20 kN/m" } }"#
            ),
            "lognormal, median 10 kN/m, dispersion 0.3, cut off above 20 kN/m"
        );
        assert_eq!(over(r#"{ "path": "a", "values": [1, "2 m", true] }"#), "1, 2 m, true");
        assert_eq!(over(r#"{ "name": "n", "choices": [{ "name": "x", "set": { "a": 1 } }] }"#), "x");
        let many: Vec<String> = (0..20).map(|v| v.to_string()).collect();
        assert!(over(&format!(r#"{{ "path": "a", "values": [{}] }}"#, many.join(","))).ends_with("11, … (20 in all)"));
    }
}
