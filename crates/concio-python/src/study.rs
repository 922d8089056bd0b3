//! Studies: the runs that a study file asks for, those done that its folder lacks, and the table of a design's.

use std::path::{Path, PathBuf};

use concio::Error;
use concio::case::Case;
use concio::run::Control;
use concio_cli::commands::study::{checked, report};
use concio_cli::files::silently;
use concio_cli::study::asked;
use concio_study::measures::Row;
use concio_study::runner::{Deliver, Hands, Progress};
use concio_study::store::Store;
use concio_study::table::{self, Cells, Table};
use concio_study::{Plan, Task, drive};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::elsewhere::Executor;
use crate::failure::Raised;
use crate::json;
use crate::watch::{Board, Watch, beside};

/// A table, null where the study asks for more than the runs of a design, and whether all runs are done.
type Done = (Value, bool);

/// Does the runs of a study file that its folder lacks: on `threads` threads (0: one per core), or with `rows` by an executor,
/// `at_once` of them in a task. The columns of the table of a design, and whether all runs are done.
#[pyfunction]
pub fn study_run(
    py: Python<'_>,
    file: PathBuf,
    folder: PathBuf,
    threads: usize,
    progress: Option<Py<PyAny>>,
    rows: Option<Py<PyAny>>,
    at_once: usize,
) -> PyResult<(Py<PyAny>, bool)> {
    let mut watch = Watch::new(progress);
    let executor = rows.map(Executor::new);
    let done = py.detach(|| {
        beside(&mut watch, |board| match &executor {
            None => complete(&file, &folder, Hands::Here(threads), board),
            Some(executor) => {
                let work = |tasks: Vec<Task>, deliver: &mut Deliver| executor.work(tasks, deliver, board);
                complete(&file, &folder, Hands::Elsewhere(&work, at_once), board)
            }
        })
    });
    if let Some(error) = watch.error.or(executor.and_then(|executor| executor.raised())) {
        return Err(error);
    }
    let (table, whole) =
        done.map_err(|_| Raised::Other("the study panicked: this is an error of the engine".into()))??;
    Ok((json::to_python(py, &table)?.unbind(), whole))
}

fn complete(file: &Path, folder: &Path, hands: Hands, board: &Board) -> Result<Done, Raised> {
    let plan = Plan::read(file)?;
    let look = |progress: &Progress| board.look(progress.share);
    let whole = drive::complete(&plan, folder, hands, &look)? == Control::Continue;
    let study = &plan.file.study;
    if study.ida.is_some() || study.first_crack.is_some() || study.interfaces.is_some() {
        return Ok((Value::Null, whole));
    }
    let cases: Vec<Case> = (0..plan.points.len()).map(|number| plan.case(number)).collect::<Result<_, _>>()?;
    let ids: Vec<String> = cases.iter().map(|case| plan.id(case)).collect::<Result<_, _>>()?;
    let store = Store::open(folder)?;
    let keep = &study.keep;
    let found: Vec<Option<&Row>> = ids.iter().map(|id| store.holding(id, &keep.joints, keep.results)).collect();
    Ok((columns(&table::of_plan(&plan, &found)), whole))
}

/// What `concio study check` says of a study file: the columns of its design, the factors of each run, and what is doubtful.
#[pyfunction]
pub fn study_check(py: Python<'_>, file: PathBuf) -> PyResult<(Py<PyAny>, Vec<String>)> {
    let found = py.detach(|| {
        let plan = checked(&file)?.plan;
        let mut design = table::of_plan(&plan, &vec![None; plan.points.len()]);
        // Behind the number of the run and its factors stands what it is not known to measure.
        design.columns.truncate(1 + plan.factors.len());
        let doubts = asked::before(&plan).sentences().iter().map(ToString::to_string).collect();
        Ok::<_, Error>((columns(&design), doubts))
    });
    let (design, doubts) = found.map_err(Raised::from)?;
    Ok((json::to_python(py, &design)?.unbind(), doubts))
}

/// Writes report and tables of what a folder has of a study file; what the command would tell besides, line by line.
#[pyfunction]
pub fn study_report(py: Python<'_>, file: PathBuf, folder: PathBuf) -> PyResult<Vec<String>> {
    let (written, told) = py.detach(|| silently(|| report(file, folder)));
    Ok(written.map(|()| told).map_err(Raised::from)?)
}

fn columns(table: &Table) -> Value {
    let cells = |cells: &Cells| match cells {
        Cells::Numbers(numbers) => json!(numbers),
        Cells::Texts(texts) => json!(texts),
    };
    let column = |c: &table::Column| json!({ "name": c.name, "unit": c.unit, "cells": cells(&c.cells) });
    table.columns.iter().map(column).collect()
}
