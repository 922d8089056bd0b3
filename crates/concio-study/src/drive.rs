//! Studies driven from outside: all runs that a study asks for, whatever it asks, and the runs of a task.

use std::path::Path;

use concio::case::Case;
use concio::run::Control;
use concio::{Error, InputError, Result};

use crate::file::Keep;
use crate::first_crack::{keep, of_study, search};
use crate::ida::Analysis;
use crate::measures::Row;
use crate::runner::{Hands, Progress, Runner};
use crate::task::Task;
use crate::{Plan, answer, interfaces};

/// Does the runs that `folder` does not have yet. [`Control::Stop`] where `watch` stopped them, or hands that only write tasks down: asked again,
/// it goes on, and asks for what follows from the runs that were there.
///
/// # Errors
/// As [`Runner::rows`]; what is asked has no meaning.
pub fn complete<'a>(
    plan: &Plan,
    folder: &Path,
    hands: Hands<'a>,
    watch: &'a (dyn Fn(&Progress) -> Control + Sync),
) -> Result<Control> {
    let study = &plan.file.study;
    if study.first_crack.is_some() {
        let (question, subjects) = of_study(plan)?;
        let mut runner = Runner::open(folder, &keep(), hands, watch)?.until(question.rule);
        return Ok(ended(&search(&question, &subjects, &mut runner)?));
    }
    if let Some(mut analysis) = Analysis::new(plan)? {
        return analysis.ask(&mut Runner::open(folder, &study.keep, hands, watch)?, &|_| true);
    }
    let cases = (0..plan.points.len()).map(|number| plan.case(number)).collect::<Result<Vec<_>>>()?;
    check_questions(plan, &cases)?;
    let mut runner = Runner::open(folder, &study.keep, hands, watch)?;
    let Some(rows) = runner.rows(&cases)? else { return Ok(Control::Stop) };
    if study.interfaces.is_none() {
        return Ok(Control::Continue);
    }
    let question = interfaces::question(plan)?;
    let rows: Vec<&Row> = rows.iter().collect();
    // Thousands of walls: nothing is kept of them per joint.
    let mut runner = Runner::open(folder, &Keep::default(), hands, watch)?;
    Ok(ended(&answer::answer(plan, &question, &rows, &mut runner)?))
}

/// Looks whether what is asked of the runs of a design has a meaning, before any is made.
///
/// # Errors
/// Thresholds, groups and joints of crack lines and rankings that these runs cannot have.
pub fn check_questions<'a>(plan: &Plan, cases: impl IntoIterator<Item = &'a Case>) -> Result<()> {
    let study = &plan.file.study;
    if let Some(cracks) = &study.cracks {
        cracks.check(plan)?;
    }
    study.ranking.as_ref().map_or(Ok(()), |ranking| ranking.check_joints(&plan.file, cases))
}

/// Does the runs of a task on so many threads, 0 for one per core; the rows of those that ended, in the order of the runs, and whether
/// `watch` stopped the others. They are kept in `folder` on the way; without one where the task wants whole results, else nowhere.
///
/// # Errors
/// [`Error::Input`] where a run is not what it was laid out as; [`Error::Io`] where the folder cannot be written.
pub fn work(
    task: &Task,
    folder: Option<&Path>,
    threads: usize,
    watch: &(dyn Fn(&Progress) -> Control + Sync),
) -> Result<(Vec<Row>, Control)> {
    let passing = tempfile::tempdir().map_err(|e| Error::io(std::env::temp_dir(), e))?;
    let folder = folder.or(task.results()).unwrap_or(passing.path());
    let mut runner = Runner::open(folder, &task.keep(), threads, watch)?.with_library(task.library()?);
    if let Some(rule) = task.until() {
        runner = runner.until(rule);
    }
    let cases = task.cases();
    for ((id, case), number) in task.ids().zip(&cases).zip(1..) {
        let found = runner.id(case)?;
        if found != *id {
            let what = format!("run {number} of the task is {found}, and was laid out as {id}");
            let help = "a task is sent as it was printed, to a program of the same version";
            return Err(InputError::new(what).help(help).into());
        }
    }
    match runner.rows(&cases)? {
        Some(rows) => Ok((rows, Control::Continue)),
        None => Ok((task.ids().filter_map(|id| runner.known(id).cloned()).collect(), Control::Stop)),
    }
}

/// What became of a search: none was stopped.
fn ended<T>(answer: &Option<T>) -> Control {
    if answer.is_some() { Control::Continue } else { Control::Stop }
}
