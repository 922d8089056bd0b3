//! `concio study`.

use std::io::{BufRead, stdin};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use concio::case::{Beam, Case};
use concio::run::Control;
use concio::{InputError, Result};
use concio_study::file::Keep;
use concio_study::measures::{End, Row};
use concio_study::runner::{Deliver, Hands, Progress, Runner};
use concio_study::store::{Store, line_of};
use concio_study::task::Task;
use concio_study::warned::Warned;
use concio_study::{Plan, answer, drive, file, first_crack, interfaces, table};
use rayon::prelude::*;

use super::run::refuse_a_file;
use super::wall_file::Kind;
use crate::args::{StudyCheck, StudyCommand, StudyPlace, StudyPlan, StudyRun, StudyWork};
use crate::failure::{Failure, STOPPED};
use crate::format::{columns, counted, pairs};
use crate::progress::Runs;
use crate::study::asked::{self, Trouble};
use crate::study::first_crack::{Do, Request};
use crate::{files, stop, study};

/// Runs that a listing of failures names at most.
const MOST_NAMED: usize = 5;

/// A question and its answer.
type Answered = (interfaces::Question, answer::Answer, Warned);

/// Dispatches.
pub fn run_command(command: &StudyCommand) -> std::result::Result<ExitCode, Failure> {
    match command {
        StudyCommand::Check(args) => check(args).map(|()| ExitCode::SUCCESS),
        StudyCommand::Run(args) => run(&read(&args.place.file)?, args),
        StudyCommand::Plan(args) => tasks(args),
        StudyCommand::Work(args) => work(args),
        StudyCommand::Resume(args) => {
            // A mistake in the file is told before a folder that it could not have made.
            let plan = read(&args.place.file)?;
            let folder = folder(&args.place);
            let store = Store::open(&folder)?;
            if store.is_empty() && store.faults().is_empty() {
                let error = InputError::new("there is nothing to go on with: the folder has no runs").in_file(&folder);
                return Err(error.help("`concio study run` begins a study").into());
            }
            run(&plan, args)
        }
        StudyCommand::Status(place) => status(place),
        StudyCommand::Report(place) | StudyCommand::Export(place) => export(place),
        StudyCommand::Schema(_) => {
            let text = serde_json::to_string_pretty(&file::schema());
            files::print_json(&(text.map_err(|e| Failure::Other(e.to_string(), None))? + "\n"))
                .map(|()| ExitCode::SUCCESS)
        }
    }
}

/// What a point of the design is: a run, or what takes several.
fn point(plan: &Plan) -> &'static str {
    let study = &plan.file.study;
    match (study.first_crack.is_some(), study.ida.is_some()) {
        (true, _) => "case",
        (_, true) => "curve",
        _ => "run",
    }
}

/// `concio-study/NAME` in the working directory.
fn folder(place: &StudyPlace) -> PathBuf {
    let name = place.file.file_stem().unwrap_or(place.file.as_os_str());
    place.out.clone().unwrap_or_else(|| Path::new("concio-study").join(name))
}

/// Reads a study file.
fn read(path: &Path) -> Result<Plan> {
    Plan::read(path).map_err(|error| match Kind::of(path) {
        Some(Kind::Wall) => {
            let error = InputError::new("is a wall file, and a study file is wanted").in_file(path);
            error.help("`concio check` and `concio run` take wall files; a study file names one as `wall`").into()
        }
        _ => error,
    })
}

/// All runs of a plan, complete and valid, with their ids; what is asked of them has a meaning.
fn cases(plan: &Plan) -> Result<Vec<(String, Case)>> {
    let numbers = 0..plan.points.len();
    let one = |number: usize| plan.case(number).and_then(|case| Ok((plan.id(&case)?, case)));
    // The first that is wrong is told, whatever thread comes to it first.
    let cases: Vec<(String, Case)> =
        numbers.into_par_iter().map(one).collect::<Vec<_>>().into_iter().collect::<Result<_>>()?;
    drive::check_questions(plan, cases.iter().map(|(_, case)| case))?;
    Ok(cases)
}

/// Tells what the runs will warn of, as far as that is known before; what was told.
fn warn(plan: &Plan) -> Warned {
    let before = asked::before(plan);
    crate::warned::warn_of_runs(&plan.file.wall, &before.sentences());
    let mut told = before.warned;
    told.told.extend(before.read.told);
    told
}

/// A study whose runs and questions have a meaning, as `concio study check` finds.
pub struct Checked {
    /// What it asks.
    pub plan: Plan,
    /// The runs of its design with their ids.
    cases: Vec<(String, Case)>,
    /// Name, motion and use of each motion.
    shaking: Vec<[String; 3]>,
}

/// Reads a study file and looks whether its runs can be made ready.
///
/// # Errors
/// What the study file or the walls of its runs may not say.
pub fn checked(path: &Path) -> Result<Checked> {
    let plan = read(path)?;
    let cases = cases(&plan)?;
    if plan.file.study.first_crack.is_some() {
        first_crack::of_study(&plan)?;
    }
    let shaking = asked::shaking(&plan)?;
    Ok(Checked { plan, cases, shaking })
}

fn check(args: &StudyCheck) -> std::result::Result<(), Failure> {
    let Checked { plan, cases, shaking } = checked(&args.place.file)?;
    let study = &plan.file.study;
    warn(&plan);
    let store = opened(&plan, &folder(&args.place), &cases)?;
    let mut rows = asked::lines(&plan, point(&plan), &shaking);
    rows.extend(study::ida::described(&plan)?);
    if study.first_crack.is_none() && study.ida.is_none() {
        rows.push(("runs", cases.len().to_string()));
        rows.push(("done", found(&plan, &store, &cases).iter().flatten().count().to_string()));
    }
    if let Some(interfaces) = &study.interfaces {
        let question = interfaces::question(&plan)?;
        let runs = counted(interfaces.runs, "run");
        rows.push(("search", format!("up to {runs}, and as many to tune the greedy placements")));
        rows.push(("comparison", format!("up to {}", counted(answer::comparison(&plan, &question), "run"))));
    }
    if study.first_crack.is_some() || study.ida.is_some() || study.interfaces.is_some() {
        rows.push(("in folder", counted(store.len(), "run")));
    }
    let mut text = pairs(&rows);
    if args.runs {
        let heading = ["run".to_string()].into_iter().chain(plan.factors.iter().map(|f| f.name.clone())).collect();
        let line = |i: usize| {
            let labels = plan.labels(i);
            [(i + 1).to_string()].into_iter().chain(labels.iter().map(asked::text)).collect()
        };
        let lines: Vec<Vec<String>> = [heading].into_iter().chain((0..cases.len()).map(line)).collect();
        text.push('\n');
        text.push_str(&columns(&lines));
    }
    files::print(&text)
}

fn run(plan: &Plan, args: &StudyRun) -> std::result::Result<ExitCode, Failure> {
    if plan.file.study.first_crack.is_some() {
        return first_cracks(plan, &args.place, args.threads, Do::Share(args.shard.unwrap_or([1, 1])));
    }
    let cases = cases(plan)?;
    let out = folder(&args.place);
    refuse_a_file(&out)?;
    asked::shaking(plan)?;
    let known = warn(plan);
    let [share, of] = args.shard.unwrap_or([1, 1]);
    if plan.file.study.ida.is_some() {
        return study::ida::run(plan, &out, args.threads.map_or(0, usize::from), [share, of], &known);
    }
    stop::listen()?;
    let mine: Vec<Case> = cases.iter().skip(share - 1).step_by(of).map(|(_, case)| case.clone()).collect();
    let bar = Runs::default();
    let watch = |progress: &Progress| {
        bar.show(progress);
        if stop::asked() { Control::Stop } else { Control::Continue }
    };
    let threads = args.threads.map_or(0, usize::from);
    let mut runner = Runner::open(&out, &plan.file.study.keep, threads, &watch)?;
    let told = study::tell_passed_over(runner.store(), 0);
    let rows = runner.rows(&mine);
    bar.clear();
    study::tell_passed_over(runner.store(), told);
    let rows = rows?;
    if rows.is_none() {
        files::note("stopped early; the same command goes on from here");
        return Ok(ExitCode::from(STOPPED));
    }
    // Other shards may have ended meanwhile.
    let store = Store::open(&out)?;
    let found = found(plan, &store, &cases);
    let missing = found.iter().filter(|r| r.is_none()).count();
    tell(plan, &found, &known)?;
    if missing > 0 {
        files::note(&format!("{missing} of {} are left to other shards", counted(cases.len(), "run")));
        return Ok(ExitCode::SUCCESS);
    }
    let rows: Vec<&Row> = found.iter().flatten().copied().collect();
    let answered = ask(plan, &rows, &out, threads, &watch, false)?;
    bar.clear();
    if plan.file.study.interfaces.is_some() && answered.is_none() {
        files::note("stopped early; the same command goes on from here");
        return Ok(ExitCode::from(STOPPED));
    }
    files::print(&format!("open {}\n", write(plan, &cases, &found, answered, &out)?.display()))?;
    let complete = found.iter().flatten().all(|r| r.end == End::Completed);
    Ok(if complete { ExitCode::SUCCESS } else { ExitCode::from(STOPPED) })
}

/// Prints what can be done now.
fn tasks(args: &StudyPlan) -> std::result::Result<ExitCode, Failure> {
    let plan = read(&args.place.file)?;
    cases(&plan)?;
    asked::shaking(&plan)?;
    let out = folder(&args.place);
    refuse_a_file(&out)?;
    let laid_out = Mutex::new(Vec::new());
    let write_down = |tasks, _: &mut Deliver| {
        *laid_out.lock().unwrap_or_else(PoisonError::into_inner) = tasks;
        Ok(Control::Stop)
    };
    let hands = Hands::Elsewhere(&write_down, args.runs.into());
    let ended = drive::complete(&plan, &out, hands, &|_| Control::Continue)?;
    let laid_out = laid_out.into_inner().unwrap_or_else(PoisonError::into_inner);
    if args.json {
        laid_out.iter().try_for_each(|task| files::print_json(&(task.line() + "\n")))?;
    } else {
        let runs = laid_out.iter().map(|task| task.ids().len()).sum::<usize>();
        files::print(&pairs(&[("runs", runs.to_string()), ("tasks", laid_out.len().to_string())]))?;
    }
    if ended == Control::Continue {
        files::note("nothing is left to be run: `concio study report` writes tables and report");
    }
    Ok(ExitCode::SUCCESS)
}

/// Does the tasks of standard input.
fn work(args: &StudyWork) -> std::result::Result<ExitCode, Failure> {
    if let Some(out) = &args.out {
        refuse_a_file(out)?;
    }
    stop::listen()?;
    let watch = |_: &Progress| if stop::asked() { Control::Stop } else { Control::Continue };
    for (number, line) in stdin().lock().lines().enumerate() {
        let line = line.map_err(|e| Failure::Other(format!("standard input: {e}"), None))?;
        if line.trim().is_empty() {
            continue;
        }
        let located = |error| match error {
            concio::Error::Input(e) => e.in_file(Path::new("standard input")).at_line(number + 1).into(),
            other => other,
        };
        let task = Task::parse(&line).map_err(located)?;
        let threads = args.threads.map_or(0, usize::from);
        let (rows, ended) = drive::work(&task, args.out.as_deref(), threads, &watch).map_err(located)?;
        if args.out.is_none() {
            let lines = rows.iter().map(line_of).collect::<std::result::Result<String, _>>();
            // Their digests are of these bytes.
            files::write_out(&lines.map_err(|e| Failure::Other(e.to_string(), None))?)?;
        }
        if ended == Control::Stop {
            files::note("stopped early; runs that had not ended are to be done again");
            return Ok(ExitCode::from(STOPPED));
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// A study that asks for first cracks instead of runs of its own.
fn first_cracks(
    plan: &Plan,
    place: &StudyPlace,
    threads: Option<u16>,
    what: Do,
) -> std::result::Result<ExitCode, Failure> {
    let (question, subjects) = first_crack::of_study(plan)?;
    let out = folder(place);
    refuse_a_file(&out)?;
    let mut known = Warned::default();
    if matches!(what, Do::Share(_)) {
        cases(plan)?;
        asked::shaking(plan)?;
        known = warn(plan);
        stop::listen()?;
    }
    let file = &plan.file;
    let title = if file.study.title.is_empty() { "First cracking" } else { &file.study.title };
    let name = |path: Option<&Path>| path.map_or(String::new(), |p| p.display().to_string());
    let facts = vec![
        ("study file", name(file.document.path())),
        ("wall file", name(file.wall.path())),
        ("motions", subjects.len().to_string()),
    ];
    let threads = threads.map_or(0, usize::from);
    let case = subjects.first().map(|s| &s.case);
    let first = asked::section(plan, point(plan), case, Trouble::default())?;
    let (question, subjects) = (&question, &subjects[..]);
    let wall = &file.wall;
    study::first_crack::answer(
        &Request { title, facts, first, question, subjects, out: &out, threads, wall, known },
        what,
    )
}

/// The rows of the study's runs that hold all that it keeps.
fn found<'s>(plan: &Plan, store: &'s Store, cases: &[(String, Case)]) -> Vec<Option<&'s Row>> {
    let keep = &plan.file.study.keep;
    cases.iter().map(|(id, _)| store.holding(id, &keep.joints, keep.results)).collect()
}

/// What the folder knows of the runs of a plan; what does not count of it is told.
fn opened(plan: &Plan, folder: &Path, cases: &[(String, Case)]) -> Result<Store> {
    let mut store = Store::open(folder)?;
    if plan.file.study.keep.results {
        store.look_at_results(cases.iter().map(|(id, _)| id.as_str()), false);
    }
    study::tell_passed_over(&store, 0);
    Ok(store)
}

/// How many runs there are, what became of them and what they warn of, but for what is known already.
fn tell(plan: &Plan, found: &[Option<&Row>], known: &Warned) -> std::result::Result<(), Failure> {
    let count = |end: End| found.iter().flatten().filter(|r| r.end == end).count();
    let mut rows = vec![("runs", found.len().to_string()), ("completed", count(End::Completed).to_string())];
    for (name, end) in [("stopped early", End::Stopped), ("failed", End::Failed)] {
        if count(end) > 0 {
            rows.push((name, count(end).to_string()));
        }
    }
    let left = found.iter().filter(|r| r.is_none()).count();
    if left > 0 {
        rows.push(("not run", left.to_string()));
    }
    let warned = asked::warned(plan, found);
    rows.extend(asked::counted_warnings(&warned).map(|told| ("warnings", told)));
    crate::warned::warn_of_runs(&plan.file.wall, &warned.sentences(known));
    let bad = found.iter().enumerate().filter_map(|(i, r)| r.as_ref().map(|r| (i, r)));
    for (number, row) in bad.filter(|(_, r)| r.end != End::Completed).take(MOST_NAMED) {
        let cause = row.cause.as_deref().unwrap_or("no cause is known");
        files::note(&format!("run {} ({}): {cause}", number + 1, asked::values(plan, number)));
    }
    files::print(&pairs(&rows))
}

fn status(place: &StudyPlace) -> std::result::Result<ExitCode, Failure> {
    let plan = read(&place.file)?;
    if plan.file.study.ida.is_some() {
        return study::ida::status(&plan, &folder(place));
    }
    if plan.file.study.first_crack.is_some() {
        return first_cracks(&plan, place, None, Do::Tell);
    }
    let cases = cases(&plan)?;
    let store = opened(&plan, &folder(place), &cases)?;
    tell(&plan, &found(&plan, &store, &cases), &Warned::default())?;
    Ok(ExitCode::SUCCESS)
}

/// Writes report and tables of what `folder` has of a study file, as `concio study report` does.
///
/// # Errors
/// As those of the command: a study file that is wrong, a folder without its runs, files that cannot be written.
pub fn report(file: PathBuf, folder: PathBuf) -> std::result::Result<(), Failure> {
    export(&StudyPlace { file, out: Some(folder) }).map(drop)
}

fn export(place: &StudyPlace) -> std::result::Result<ExitCode, Failure> {
    let plan = read(&place.file)?;
    let cases = cases(&plan)?;
    let out = folder(place);
    let store = opened(&plan, &out, &cases)?;
    if store.is_empty() {
        let error = InputError::new("there is nothing to export: the folder has no runs").in_file(&out);
        return Err(error.help("`concio study run` begins a study").into());
    }
    if plan.file.study.ida.is_some() {
        return study::ida::export(&plan, &out).map(|()| ExitCode::SUCCESS);
    }
    if plan.file.study.first_crack.is_some() {
        return first_cracks(&plan, place, None, Do::Report);
    }
    let found = found(&plan, &store, &cases);
    let rows: Vec<&Row> = found.iter().flatten().copied().collect();
    if rows.is_empty() {
        // Tables of other runs would be overwritten by empty ones.
        let error =
            InputError::new(format!("none of its {} runs is one of this study, or holds what it keeps", store.len()))
                .in_file(&out);
        return Err(error.help("study or wall file were changed since; `concio study run` does the runs anew").into());
    }
    let answered = match rows.len() == cases.len() {
        true => ask(&plan, &rows, &out, 0, &|_| Control::Stop, true)?,
        false => None,
    };
    if plan.file.study.interfaces.is_some() && answered.is_none() {
        files::note("the search for interfaces has not ended: `concio study run` goes on with it");
    }
    files::print(&format!("open {}\n", write(&plan, &cases, &found, answered, &out)?.display()))?;
    Ok(ExitCode::SUCCESS)
}

/// What the study asks of interfaces, answered; none where it asks nothing, was stopped, or, `reading`, the store has
/// not all of it.
fn ask(
    plan: &Plan,
    rows: &[&Row],
    out: &Path,
    threads: usize,
    watch: &(dyn Fn(&Progress) -> Control + Sync),
    reading: bool,
) -> Result<Option<Answered>> {
    if plan.file.study.interfaces.is_none() {
        return Ok(None);
    }
    let question = interfaces::question(plan)?;
    // Thousands of walls: nothing is kept of them per joint.
    let mut runner = Runner::open(out, &Keep::default(), threads, watch)?;
    runner.reading = reading;
    match answer::answer(plan, &question, rows, &mut runner)? {
        Some(answer) => Ok(Some((question, answer, runner.warned))),
        None => Ok(None),
    }
}

/// Writes tables and report; the path of the report.
fn write(
    plan: &Plan,
    cases: &[(String, Case)],
    found: &[Option<&Row>],
    answered: Option<Answered>,
    out: &Path,
) -> std::result::Result<PathBuf, Failure> {
    let runs = table::of_plan(plan, found);
    table::write_csv(&runs, &out.join("runs.csv"))?;
    table::write_parquet(&runs, &out.join("runs.parquet"))?;
    if !plan.file.study.keep.joints.is_empty() {
        table::write_joints(found, &|number| joint_names(&cases[number].1), out)?;
    }
    let mut sections =
        vec![asked::section(plan, "run", cases.first().map(|(_, case)| case), Trouble::of(plan, found))?];
    if let Some((section, table)) = study::sensitivity::section(plan, found)? {
        table::write_csv(&table, &out.join("sensitivity.csv"))?;
        table::write_parquet(&table, &out.join("sensitivity.parquet"))?;
        sections.push(section);
    }
    let file = &plan.file;
    let name = |path: Option<&Path>| path.map_or(String::new(), |p| p.display().to_string());
    let title = if file.study.title.is_empty() { "Study" } else { &file.study.title };
    let facts = [
        ("study file", name(file.document.path())),
        ("wall file", name(file.wall.path())),
        ("runs", found.len().to_string()),
        ("with warnings", asked::warned(plan, found).runs.to_string()),
        ("without a result", found.iter().filter(|r| r.is_none_or(|r| r.end == End::Failed)).count().to_string()),
    ];
    if let Some((question, answer, warned)) = &answered {
        let mut section = study::interfaces::section(question, answer, out)?;
        if let Some(told) = asked::counted_warnings(warned) {
            section.brief += &format!("  warnings {told}\n");
        }
        if let Some((text, table)) = asked::warning_table(warned) {
            section.text.insert(0, text);
            section.tables.insert(0, table);
        }
        sections.push(section);
    }
    if let Some((_, case)) = cases.first() {
        sections.extend(study::ranking::section(plan, case, found, out)?);
        sections.extend(study::cracks::section(plan, case, found, out)?);
    }
    sections.push(study::sections::runs(plan, &runs));
    for section in sections.iter().filter(|s| !s.brief.is_empty()) {
        files::print(&format!("\n{}", section.brief))?;
    }
    study::tell_others(out, study::Kind::Design);
    study::write(out, title, &facts, &sections)
}

/// Names of the joints of a case that was run: it can be laid. Its motion is not made for that, which takes longer.
fn joint_names(case: &Case) -> Vec<String> {
    let names = |wall: concio::wall::Wall| {
        let joints = concio::graph::joints(&wall, case.load.beam != Beam::Free);
        joints.iter().map(|j| concio::graph::name(&wall, j)).collect()
    };
    concio::pattern::lay(case).map(names).unwrap_or_default()
}
