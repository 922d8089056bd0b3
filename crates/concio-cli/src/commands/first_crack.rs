//! `concio first-crack`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use concio::InputError;
use concio::case::{self, Case, CaseFile, RecordInput, Signal};
use concio::quantity::{Length, Time};
use concio::warning::Warning;
use concio_study::file::analyses::FirstCrackInput;
use concio_study::first_crack::{Objection, Question, Subject, objection};
use concio_study::limits::Criterion;
use concio_study::warned::Told;

use super::run::refuse_a_file;
use super::wall_file;
use crate::args::{CrackCriterion, FirstCrack};
use crate::failure::Failure;
use crate::study::asked;
use crate::study::first_crack::{Do, Request, answer};
use crate::study::page::Section;
use crate::{motion, stop};

/// Finds the first crack under each motion.
pub fn first_crack(args: &FirstCrack) -> Result<ExitCode, Failure> {
    let wall = wall_file::read(&args.file)?;
    let question = question(args).map_err(as_option)?;
    let subjects = subjects(args, &wall)?;
    for subject in &subjects {
        if let Some(objection) = objection(&question, subject).map_err(|e| wall.locate(e))? {
            return Err(objected(objection, &args.file).into());
        }
    }
    let name = args.file.file_stem().unwrap_or(args.file.as_os_str());
    let out = args.out.clone().unwrap_or_else(|| Path::new("concio-first-crack").join(name));
    refuse_a_file(&out)?;
    let name = |n: usize| subjects[n].name.clone();
    let mut before = concio_study::warned::before(subjects.len(), |n| Some(subjects[n].case.clone()), name);
    let runs = before.warned.of;
    let replaced = |w: &Warning| !args.records.is_empty() && w.starts_with("motion.base.");
    let doubts = wall.unit_doubts().into_iter().filter(|w| !replaced(w));
    let of_file = |first: Warning| Told { first, name: String::new(), runs, same: true };
    before.warned.told.splice(0..0, doubts.map(of_file));
    crate::warned::warn_of_runs(&wall, &before.sentences());
    stop::listen()?;
    let title = if wall.case.title.is_empty() {
        "First cracking".into()
    } else {
        format!("{}: first cracking", wall.case.title)
    };
    let facts = vec![("wall file", args.file.display().to_string()), ("motions", subjects.len().to_string())];
    let threads = args.threads.map_or(0, usize::from);
    let first = first(&subjects, &wall.case)?;
    let request = Request {
        title: &title,
        facts,
        first,
        question: &question,
        subjects: &subjects,
        out: &out,
        threads,
        wall: &wall,
        known: before.warned,
    };
    answer(&request, Do::Share([1, 1]))
}

/// What was run.
fn first(subjects: &[Subject], wall: &Case) -> Result<Section, Failure> {
    let motion = |s: &Subject| [s.name.clone(), motion::short(&s.case.motion.base)];
    let motions: Vec<[String; 2]> = subjects.iter().map(motion).collect();
    let asked =
        "Asked: the least scale of each motion at which a first joint cracks; what counts as a crack stands below.";
    Ok(Section {
        title: asked::TITLE.into(),
        text: vec![asked.into(), asked::wall(wall)?, asked::limits(wall.model).into()],
        tables: vec![("Motions of the base at scale 1".into(), asked::words(["motion", "what it is"], &motions))],
        ..Section::default()
    })
}

fn question(args: &FirstCrack) -> Result<Question, InputError> {
    let criterion = match args.criterion {
        CrackCriterion::Bond => Criterion::Bond,
        CrackCriterion::Opening => Criterion::Opening,
        CrackCriterion::Slip => Criterion::Slip,
    };
    let mut input = FirstCrackInput { criterion, limit: args.limit.map(Length::from_si), ..FirstCrackInput::default() };
    (input.interval, input.checks) = (args.interval, args.checks);
    if !args.periods.is_empty() {
        input.periods = args.periods.iter().copied().map(Time::from_si).collect();
    }
    input.question()
}

/// The wall under each record, whole; without records under its own motion.
fn subjects(args: &FirstCrack, wall: &CaseFile) -> Result<Vec<Subject>, Failure> {
    let mut wall = wall.clone();
    let folder = wall.folder().to_path_buf();
    for signal in wall.case.motion.signals_mut() {
        *signal = concio_study::motions::rooted(signal, &folder);
    }
    let mut case = wall.case;
    let output = &mut case.output;
    (output.frames, output.interval) = (Some(Time::from_si(0.0)), None);
    output.blocks.clear();
    output.joints.clear();
    if args.records.is_empty() {
        let name = match &case.motion.base {
            Signal::Record(record) => label(&record.record),
            _ => "the wall's own motion".into(),
        };
        return Ok(vec![Subject { name, case }]);
    }
    let mut subjects: Vec<Subject> = Vec::new();
    for path in &args.records {
        if !path.is_file() {
            let error = InputError::new(format!("there is no file {}", path.display())).key("--records");
            return Err(error.allowed("accelerograms, with commas between them").into());
        }
        // Named by its file unless two files bear the name.
        let short = label(path);
        let twice = args.records.iter().filter(|p| label(p) == short).count() > 1;
        let name = if twice { path.display().to_string() } else { short };
        if subjects.iter().any(|s| s.name == name) {
            let error = InputError::new(format!("{} is named twice", path.display())).key("--records");
            return Err(error.allowed("records that differ").into());
        }
        let mut case = case.clone();
        case.motion.base = Signal::Record(whole(path));
        case.motion.duration = None;
        subjects.push(Subject { name, case });
    }
    Ok(subjects)
}

fn label(path: &Path) -> String {
    path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn whole(path: &Path) -> RecordInput {
    RecordInput {
        record: PathBuf::from(path),
        channel: None,
        scale: None,
        pga: None,
        trim: None,
        reverse: false,
        resample: None,
        baseline: case::Baseline::None,
        quantity: case::HistoryQuantity::Acceleration,
        units: None,
        dt: None,
        layout: None,
    }
}

/// Keys of a study file are options here.
fn as_option(mut error: InputError) -> InputError {
    error.key = error.key.map(|key| key.replace("first-crack.", "--"));
    error
}

/// What is wrong with the wall of this file for the question.
fn objected(objection: Objection, file: &Path) -> InputError {
    let error = as_option(objection.error());
    let error = match objection {
        Objection::AtRest => error.key("motion.base").help("name accelerograms with --records"),
        // Bonds are asked for where nothing is said.
        Objection::Unbonded => error
            .key("joint.bond")
            .allowed("`[joint.bond]` in the wall file, or `--criterion slip` or `--criterion opening`"),
        Objection::Rocks | Objection::NoHeads | Objection::NoBeds => error,
    };
    error.in_file(file)
}
