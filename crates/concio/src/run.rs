//! From a wall file's content to a folder with results: what the command line, studies and tests call.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use concio_law::motion::Excitation as _;
use concio_planar::joint::Law;
use concio_shear::law::Rub;
use serde_json::Value;

use crate::case::{Beam, Case, CaseFile, MOST_SAMPLES, Signal, canonical_json, plausible};
use crate::error::{Error, InputError, Result};
use crate::excitation::Excitation;
use crate::files;
use crate::ground::formats::unread;
use crate::ground::signal::{GroundMotion, compile_with};
use crate::ground::{Library, coverage};
use crate::model::Model;
use crate::outcome::Outcome;
use crate::pattern;
use crate::quantity::shown;
use crate::record::{Recording, StopReason};
use crate::simulate::{Progress, Sampling, Simulation, Status};
use crate::store::{self, JointRow, Journal, JournalHeader, Provenance, RunFacts, StoredRun};
use crate::wall::Wall;
use crate::warning::{Warning, WarningKind};

mod warnings;

pub use warnings::{all as warnings_of, only_creeps};

/// A case made ready to run.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The input, all defaults in it.
    pub case: Case,
    /// The compiled system.
    pub model: Model,
    /// Intervals and channels, resolved.
    pub sampling: Sampling,
    /// BLAKE3 of the resolved input, the bytes of its records and the versions of program and format, in hex.
    pub inputs_hash: String,
}

/// What the caller wants to happen next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop cleanly and write what was computed.
    Stop,
}

/// A run that has ended, its files written.
#[derive(Debug, Clone)]
pub struct Finished {
    /// The result.
    pub outcome: Outcome,
    /// What summary.json holds.
    pub summary: Value,
    /// Time from which an earlier, killed run was taken up [s].
    pub resumed_from: Option<f64>,
}

/// Name of the result in its folder.
pub const RESULT: &str = "result.h5";
/// Name of the summary in its folder.
pub const SUMMARY: &str = "summary.json";
/// Name of the page that is made of both, by whoever makes one.
pub const REPORT: &str = "report.html";

/// Time by the clock between two looks at it and at the monitor, about: the steps in between are chosen for it.
const BETWEEN_LOOKS: Duration = Duration::from_millis(40);
/// Time by the clock between two checkpoints: what a killed run can lose.
const BETWEEN_CHECKPOINTS: Duration = Duration::from_secs(1);
/// Steps of which there are hardly meant to be more: of a hundred blocks hours, of a thousand days.
const ENDLESS: f64 = 1e8;

/// Makes a wall file ready to run: validates it, lays the wall, reads its records, compiles motion and model. Numbers that are hardly meant and
/// records that the run cuts or outlasts join the model's warnings.
///
/// # Errors
/// What the file may not say, records that cannot be read, walls that do not stand, names that nothing bears; each with file, line and key, of a record
/// with where it is named.
pub fn prepare(file: &CaseFile) -> Result<Prepared> {
    file.validate()?;
    let prepared = prepare_case(file.case.clone(), file.folder());
    let mut prepared = prepared.map_err(|error| file.locate(named(file, error)))?;
    prepared.model.warnings.splice(0..0, file.unit_doubts());
    Ok(prepared)
}

/// Adds to an error in a record where the wall file names that record.
fn named(file: &CaseFile, error: Error) -> Error {
    let Error::Input(mut error) = error else { return error };
    let found = file.case.motion.signals().into_iter().find(|(_, signal)| {
        let Signal::Record(input) = signal else { return false };
        error.file.as_deref() == Some(file.folder().join(&input.record).as_path())
    });
    if let Some((key, _)) = found {
        let key = format!("motion.{key}.record");
        let place = match file.locate(InputError::new("").key(&*key).into()) {
            Error::Input(at) => at.file.zip(at.line).map(|(path, line)| format!("{}:{line}", path.display())),
            _ => None,
        };
        let place = format!("the record is named in {} as {key}", place.unwrap_or_else(|| "the wall file".into()));
        error.help = Some(error.help.take().map_or_else(|| place.clone(), |help| format!("{help}; {place}")));
    }
    Error::Input(error)
}

/// [`prepare`] with a motion of the base that no file gives, over `motion.duration`, or as long as it is. It is doubted as records are. Results know it by
/// [`Prepared::inputs_hash`] alone, of which a warning tells: keep the motion beside them.
///
/// # Errors
/// As [`prepare`]; a wall file that moves base or top too.
pub fn prepare_moved(file: &CaseFile, base: GroundMotion) -> Result<Prepared> {
    file.validate()?;
    let case = file.case.clone();
    let moves = case.motion.signals().into_iter().find(|(_, signal)| **signal != Signal::None);
    if let Some((name, _)) = moves {
        let error = InputError::new("the motion is given beside the wall file").key(format!("motion.{name}"));
        return Err(file.locate(error.allowed("none").into()));
    }
    let duration = case.motion.duration.map(|duration| duration.si()).or(base.end()).unwrap_or(0.0);
    let inputs_hash = hash(&[canonical_json(&case).into_bytes(), format!("{base:?}").into_bytes()]);
    let of_motion = coverage::of_own(&case, &base, duration);
    let excitation = Excitation::of_base(base, duration);
    let parts = pattern::lay(&case).and_then(|wall| Ok((wall, sampling(&case, &excitation)?)));
    let prepared =
        parts.and_then(|(wall, sampling)| compiled(case, (wall, excitation, sampling), of_motion, inputs_hash));
    let mut prepared = prepared.map_err(|error| file.locate(error))?;
    prepared.model.warnings.splice(0..0, file.unit_doubts());
    Ok(prepared)
}

/// [`prepare`] of a case that is valid; `folder` is where relative record paths start.
///
/// # Errors
/// As [`prepare`], by key alone.
pub fn prepare_case(case: Case, folder: &Path) -> Result<Prepared> {
    prepare_with(case, folder, &Library::default())
}

/// [`prepare_case`] for one of many runs: accelerograms are taken from `library`.
///
/// # Errors
/// As [`prepare_case`].
pub fn prepare_with(case: Case, folder: &Path, library: &Library) -> Result<Prepared> {
    let wall = pattern::lay(&case)?;
    let excitation = excitation(&case, folder, library)?;
    let sampling = sampling(&case, &excitation)?;
    let inputs_hash = inputs_hash(&case, folder, library)?;
    let of_records = coverage::warnings(&case, folder, excitation.duration, library)?;
    compiled(case, (wall, excitation, sampling), of_records, inputs_hash)
}

fn compiled(
    case: Case,
    (wall, excitation, sampling): (Wall, Excitation, Sampling),
    of_records: Vec<Warning>,
    inputs_hash: String,
) -> Result<Prepared> {
    let mut model = Model::compile(&case, wall, excitation)?;
    model.warnings.splice(0..0, plausible::doubts(&case));
    model.warnings.extend(of_records);
    model.warnings.extend(coverage::of_forces(&case, model.excitation.duration));
    model.warnings.extend(endless(&case, &model));
    model.warnings.extend(passed_over(&model));
    Simulation::check(&model, &sampling)?;
    Ok(Prepared { case, model, sampling, inputs_hash })
}

/// Says of steps that pass over samples of a motion that they do.
fn passed_over(model: &Model) -> Option<Warning> {
    let step = model.planar().filter(|planar| !planar.still)?.step;
    let motions = &model.excitation;
    let sampled = [&motions.base, &motions.vertical].into_iter().filter_map(|m| m.sample_interval());
    let interval = sampled.reduce(f64::min).filter(|interval| step > 1.5 * interval)?;
    let [step, interval] = [step, interval].map(|t| shown(plausible::rounded(t, 6)));
    let text = format!(
        "solver.step is {step} s, and the motion has samples {interval} s apart: what it does between steps hardly moves the wall"
    );
    Some(Warning::new(WarningKind::UnlikelyNumber, text))
}

/// Says of a run that takes days at least that it does, and why.
fn endless(case: &Case, model: &Model) -> Option<Warning> {
    let asked = case.solver.max_step.map_or(f64::INFINITY, |h| h.si());
    let resolves = model.excitation.longest_step();
    let (step, why) = match model.planar() {
        Some(planar) => (planar.step, "solver.step"),
        None if asked < resolves => (asked, "solver.max_step"),
        None => (resolves, "what the motion changes within"),
    };
    let steps = model.excitation.duration / step;
    (steps > ENDLESS).then(|| {
        let [step, duration] = [step, model.excitation.duration].map(|t| shown(plausible::rounded(t, 3)));
        let text = format!(
            "motion.duration: {duration} s takes {steps:.0e} steps at least, none longer than {step} s ({why})"
        );
        Warning::new(WarningKind::LongRun, text)
    })
}

fn excitation(case: &Case, folder: &Path, library: &Library) -> Result<Excitation> {
    let compiled = |signal, key| compile_with(signal, folder, library).map_err(|e| at_key(e, key));
    let base = compiled(&case.motion.base, "motion.base")?;
    let top = compiled(&case.motion.top, "motion.top")?;
    let vertical = compiled(&case.motion.vertical, "motion.vertical")?;
    let driven = case.load.beam == Beam::Driven;
    let ends = [base.end(), vertical.end(), top.end().filter(|_| driven)].into_iter().flatten();
    let end = ends.reduce(f64::max).filter(|&end| end > 0.0);
    let duration = case.motion.duration.map(|d| d.si()).or(end).ok_or_else(|| {
        InputError::new("is needed: the motion has no end of its own").key("motion.duration").allowed("above 0 s")
    })?;
    let top_sine = if let Signal::Sine(sine) = case.motion.top { Some(sine) } else { None };
    Ok(Excitation { base, top, vertical, driven, top_sine, duration })
}

/// An error of a motion is at its key of the wall file, or below it, unless it is one of the record's file.
fn at_key(error: Error, key: &str) -> Error {
    match error {
        Error::Input(e) if e.file.is_none() => {
            let below = e.key.as_ref().map(|below| format!("{key}.{below}"));
            e.key(below.unwrap_or_else(|| key.into())).into()
        }
        other => other,
    }
}

/// What is left of a whole number by rounding.
const WHOLE: f64 = 1e-6;

fn sampling(case: &Case, excitation: &Excitation) -> Result<Sampling> {
    let (output, duration) = (&case.output, excitation.duration);
    let asked = output.frames.map(|frames| frames.si()).filter(|frames| *frames > 0.0 && *frames <= duration);
    // A frame is taken with a sample. Between steps without inertia there is nothing: samples there, which make stairs, are taken for such frames alone.
    let of_steps = case.motion.quasi_static.then(|| {
        let step = case.planar_step();
        let most = (duration / 2000.0 / step).ceil().max(1.0) as u64;
        let frame = asked.map_or(0, |frames| (frames / step).round() as u64);
        step * (1..=most).rev().find(|steps| frame.is_multiple_of(*steps)).unwrap_or(1) as f64
    });
    let top = excitation.driven.then_some(&excitation.top);
    let of_record = [Some(&excitation.base), Some(&excitation.vertical), top]
        .into_iter()
        .flatten()
        .filter_map(|m| m.sample_interval());
    let own = of_steps.or(of_record.reduce(f64::min)).unwrap_or(duration / 2000.0).min(duration);
    let interval = match (output.interval, asked) {
        (Some(interval), _) => interval.si(),
        (None, Some(frames)) => frames / (frames / own * (1.0 - WHOLE)).ceil(),
        (None, None) => own,
    };
    if !(interval <= duration && duration / interval <= MOST_SAMPLES) {
        let [least, every, most] = [duration / MOST_SAMPLES, interval, duration].map(shown);
        let what = format!("{every} s for a run of {most} s");
        let allowed = format!("{least} s to {most} s, for at most {MOST_SAMPLES:.0} samples");
        let key = if output.interval.is_none() && asked.is_some() { "output.frames" } else { "output.interval" };
        return Err(InputError::new(what).key(key).allowed(allowed).into());
    }
    let frames = output.frames.map_or(duration / 400.0, |f| f.si());
    let frame_every = if frames == 0.0 { 0 } else { ((frames / interval).round() as usize).max(1) };
    if asked.is_some_and(|frames| (frame_every as f64 * interval / frames - 1.0).abs() > WHOLE) {
        let what = format!("a frame every {} s, but a sample every {} s", shown(frames), shown(interval));
        let fewer = (frames / interval).floor().max(1.0);
        let [less, more] = [fewer, fewer + 1.0].map(|times| shown(times * interval));
        let allowed = format!("whole multiples of the interval of samples, such as {less} s or {more} s");
        return Err(InputError::new(what).key("output.frames").allowed(allowed).into());
    }
    Ok(Sampling { interval, frame_every, blocks: output.blocks.clone(), joints: output.joints.clone() })
}

/// Hash of everything that the result depends on.
fn inputs_hash(case: &Case, folder: &Path, library: &Library) -> Result<String> {
    let mut parts = vec![canonical_json(case).into_bytes()];
    for (_, signal) in case.motion.signals() {
        if let Signal::Record(input) = signal {
            let path = folder.join(&input.record);
            parts.push(library.bytes(&path).map_err(|reason| unread(&path, reason))?.into_owned());
        }
    }
    Ok(hash(&parts))
}

/// BLAKE3, in hex, of the versions of program and result format and of `parts`, each told from the next by its length: what
/// a result is known by, here and in studies.
pub fn hash(parts: &[impl AsRef<[u8]>]) -> String {
    let mut hasher = blake3::Hasher::new();
    let format = store::SCHEMA_VERSION.to_le_bytes();
    let versions = [env!("CARGO_PKG_VERSION").as_bytes(), &format];
    for part in versions.into_iter().chain(parts.iter().map(AsRef::as_ref)) {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    hasher.finalize().to_hex().to_string()
}

impl Prepared {
    /// Where a result of this run comes from.
    pub fn provenance(&self) -> Provenance {
        Provenance {
            case_json: canonical_json(&self.case),
            inputs_hash: self.inputs_hash.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            model: self.case.model.name().into(),
        }
    }
}

/// Runs `prepared` into the folder `out`; `monitor` is called now and then. `result.h5` and `summary.json` appear
/// there whole or not at all. An interrupted run resumes where its journal ends. Results of other inputs
/// that the folder holds are removed before a journal stands beside them.
///
/// # Errors
/// The folder cannot be written, or belongs to another run that is under way.
pub fn run(prepared: &Prepared, out: &Path, monitor: &mut dyn FnMut(&Status) -> Control) -> Result<Finished> {
    let mut simulation = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?;
    let (mut journal, resumed_from) = open_journal(prepared, &mut simulation, out)?;
    let start = Instant::now();
    let mut look = |status: Status| monitor(&Status { resumed_from, ..status });
    let reason = integrate(&mut simulation, &mut journal, &mut look)?;
    let solve_seconds = start.elapsed().as_secs_f64();
    let rows = journal.read_all()?;
    let outcome = simulation.outcome(rows, reason);
    for name in [RESULT, SUMMARY] {
        files::remove_leftovers(&out.join(name))?;
    }
    let summary = summary(prepared, &outcome, solve_seconds, resumed_from);
    store::hdf5::write(
        &out.join(RESULT),
        &prepared.provenance(),
        &prepared.model.wall,
        &joint_rows(&prepared.model),
        &outcome,
    )?;
    store::write_summary(&out.join(SUMMARY), &summary)?;
    if reason != StopReason::Interrupted {
        journal.remove()?;
    }
    Ok(Finished { outcome, summary, resumed_from })
}

/// Removes what an earlier, unfinished run left in `out`, so that the next one starts anew.
///
/// # Errors
/// The files are there and cannot be removed.
pub fn forget(out: &Path) -> Result<()> {
    store::journal::discard(out)
}

fn open_journal<'p>(
    prepared: &'p Prepared,
    simulation: &mut Simulation<'p>,
    out: &Path,
) -> Result<(Journal, Option<f64>)> {
    let header = JournalHeader {
        inputs_hash: prepared.inputs_hash.clone(),
        version: env!("CARGO_PKG_VERSION").into(),
        layout: simulation.layout().clone(),
    };
    let clear = || remove_results_of_others(out, &prepared.inputs_hash);
    if let Some((journal, state)) = Journal::resume(out, &header)? {
        if simulation.restore(&state) {
            clear()?;
            return Ok((journal, Some(simulation.time())));
        }
        *simulation = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?;
    }
    Ok((Journal::create(out, &header, clear)?, None))
}

/// A result beside the journal of another run would be taken for that run's, if it were killed: by whoever draws it, exports it
/// or opens its page. The result goes last: without it the others are nothing.
fn remove_results_of_others(out: &Path, inputs_hash: &str) -> Result<()> {
    let result = out.join(RESULT);
    match store::hdf5::inputs_hash(&result) {
        Some(own) if own == inputs_hash => return Ok(()),
        Some(_) => {}
        // What is beside no result of a run is not ours to take away.
        None if !store::is_summary(&out.join(SUMMARY)) => return Ok(()),
        None => {}
    }
    [REPORT, SUMMARY].iter().try_for_each(|name| files::remove_if_there(&out.join(name)))?;
    files::remove_if_there(&result)
}

/// The loop around the time loop: moves rows to the journal, keeps checkpoints, asks the monitor.
fn integrate(
    simulation: &mut Simulation<'_>,
    journal: &mut Journal,
    monitor: &mut dyn FnMut(Status) -> Control,
) -> Result<StopReason> {
    let mut kept = Instant::now();
    let mut stride = 1;
    loop {
        let looked = Instant::now();
        let progress = simulation.advance(stride);
        // How many steps go between two looks changes nothing in the result.
        stride = if looked.elapsed() < BETWEEN_LOOKS { (2 * stride).min(1 << 14) } else { (stride / 2).max(1) };
        let stop = match progress {
            Progress::Ended(reason) => Some(reason),
            Progress::Running => (monitor(simulation.status()) == Control::Stop).then_some(StopReason::Interrupted),
        };
        let due = kept.elapsed() >= BETWEEN_CHECKPOINTS;
        if due || stop.is_some() || simulation.buffer_is_full() {
            if !simulation.recording().is_empty() {
                journal.append(simulation.recording())?;
                simulation.clear_recording();
            }
            if due || stop == Some(StopReason::Interrupted) {
                journal.checkpoint(&simulation.save())?;
                kept = Instant::now();
            }
        }
        if let Some(reason) = stop {
            return Ok(reason);
        }
    }
}

/// Writes a run that was made in memory, or read back, into the folder `out`, as [`run()`] does: `result.h5` and `summary.json`, whole or not
/// at all. What an unfinished run or one of other inputs left there goes.
///
/// # Errors
/// The folder cannot be written, or belongs to another run that is under way.
pub fn keep(run: &StoredRun, summary: &Value, out: &Path) -> Result<()> {
    let StoredRun { provenance, wall, joints, outcome, .. } = run;
    fs::create_dir_all(out).map_err(|e| Error::io(out, e))?;
    forget(out)?;
    remove_results_of_others(out, &provenance.inputs_hash)?;
    store::hdf5::write(&out.join(RESULT), provenance, wall, joints, outcome)?;
    store::write_summary(&out.join(SUMMARY), summary)
}

/// What `summary.json` holds of a run; `solve_seconds` is the time by the clock that solving took, `resumed_from` the time from which it was
/// taken up [s].
pub fn summary(prepared: &Prepared, outcome: &Outcome, solve_seconds: f64, resumed_from: Option<f64>) -> Value {
    let (model, provenance, joints) = (&prepared.model, prepared.provenance(), joint_rows(&prepared.model));
    let warnings = warnings::all(model, &joints, outcome);
    let pushes = model.excitation.driven || model.planar().is_some_and(|planar| planar.still);
    let facts = RunFacts {
        push: if pushes { outcome.push() } else { None },
        duration: model.excitation.duration,
        weight: model.weight(),
        base_load: model.base_load(),
        solve_seconds,
        resumed_from,
        at_first_crack: outcome.first_crack().map(|bond| moving(model, bond.cracked)),
        warnings,
    };
    store::summary(&provenance, &model.wall, &joints, outcome, &facts)
}

/// What moves a wall at the time `t` [s].
fn moving(model: &Model, t: f64) -> store::Moving {
    let Excitation { base, top, driven, .. } = &model.excitation;
    store::Moving { acceleration: base.acceleration(t), beam: driven.then(|| top.at(t).u - base.at(t).u) }
}

/// The joints of a model with their compiled numbers, as results keep them.
pub fn joint_rows(model: &Model) -> Vec<JointRow> {
    use crate::case::FrictionLaw;
    let (contact, device) = (model.shear.contact_of_joint(), model.device_of_joint());
    let planar = model.planar();
    let of_shear = |r: &Rub| store::FrictionRow {
        law: match r.law.sticks() {
            false => FrictionLaw::Stribeck,
            true if r.law.slip_velocity == 0.0 => FrictionLaw::Coulomb,
            true => FrictionLaw::StribeckStick,
        },
        static_: r.law.static_,
        dynamic: r.law.dynamic,
        slip_velocity: r.law.slip_velocity,
        beta: if r.law.sticks() { 0.0 } else { r.law.beta },
        alpha: r.law.alpha,
    };
    // Friction of planar walls sticks truly, that of upright joints too, under the pressure of the moment.
    let of_planar = |e: usize| {
        let rubs = planar.filter(|planar| !planar.open[e])?.system.links[e].law.friction?;
        Some(store::FrictionRow {
            law: if rubs.slip_velocity == 0.0 { FrictionLaw::Coulomb } else { FrictionLaw::StribeckStick },
            static_: rubs.static_,
            dynamic: rubs.dynamic,
            slip_velocity: rubs.slip_velocity,
            beta: 0.0,
            alpha: rubs.alpha,
        })
    };
    // Joints of planar walls have stiffnesses of their own, along and across, which rigidity does not touch along.
    let own = |e: usize| {
        let planar = planar.filter(|planar| !planar.open[e] && device[e].is_none())?;
        Some(&planar.system.links[e].law)
    };
    let row = |(e, rub): (usize, Option<usize>)| {
        let rub = rub.map(|r| &model.shear.rubs[r]);
        let (joint, law) = (&model.joints[e], &model.shear.elastic[e]);
        JointRow {
            joint: joint.clone(),
            name: crate::graph::name(&model.wall, joint),
            law: model.acting_law(e, contact[e].is_some()),
            stiffness: own(e).map_or(law.stiffness, |own| own.shear.stiffness),
            normal_stiffness: own(e).map_or(0.0, Law::normal_stiffness),
            damping: own(e).map_or(law.damping, |own| own.shear.damping),
            restitution: contact[e].map_or(0.0, |c| model.shear.contacts[c].restitution),
            device: device[e],
            normal_force: rub.map_or([0.0; 2], |r| r.normal),
            friction: if planar.is_some() { of_planar(e) } else { rub.map(of_shear) },
        }
    };
    model.shear.rub_of_joint().into_iter().enumerate().map(row).collect()
}

/// Runs to the end in memory, without files.
///
/// # Errors
/// As [`Simulation::new`].
pub fn run_in_memory(prepared: &Prepared) -> Result<Outcome> {
    run_watched(prepared, &mut |_| Control::Continue)
}

/// [`run_in_memory`]; `monitor` is called after every step, and may stop the run there.
///
/// # Errors
/// As [`Simulation::new`].
pub fn run_watched(prepared: &Prepared, monitor: &mut dyn FnMut(&Simulation) -> Control) -> Result<Outcome> {
    let mut simulation = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?;
    let mut rows = Recording::default();
    let reason = loop {
        let ended = match simulation.advance(1) {
            Progress::Ended(reason) => Some(reason),
            Progress::Running => (monitor(&simulation) == Control::Stop).then_some(StopReason::Interrupted),
        };
        if ended.is_some() || simulation.buffer_is_full() {
            rows.append(simulation.recording());
            simulation.clear_recording();
        }
        if let Some(reason) = ended {
            break reason;
        }
    };
    Ok(simulation.outcome(rows, reason))
}
