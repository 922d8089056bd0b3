//! Studies: the runs that a study file describes, those done that its folder lacks, and their table.

use std::path::PathBuf;

use concio::InputError;
use concio::case::Case;
use concio_study::measures::Row;
use concio_study::runner::Progress;
use concio_study::table::{self, Cells, Table};
use concio_study::{Plan, Runner};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::failure::Raised;
use crate::json;
use crate::watch::{Board, Watch, beside};

/// A table, and whether it is whole.
type Done = (Value, bool);

/// Does the runs of a study file that its folder lacks, on `threads` threads (0: one per core); the columns of the table of all its runs,
/// and whether all are done.
#[pyfunction]
pub fn study_run(
    py: Python<'_>,
    file: PathBuf,
    folder: PathBuf,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Py<PyAny>, bool)> {
    let mut watch = Watch::new(progress);
    let done = py.detach(|| beside(&mut watch, |board| rows(&file, &folder, threads, board)));
    if let Some(error) = watch.error {
        return Err(error);
    }
    let (table, whole) =
        done.map_err(|_| Raised::Other("the study panicked: this is an error of the engine".into()))??;
    Ok((json::to_python(py, &table)?.unbind(), whole))
}

fn rows(file: &std::path::Path, folder: &std::path::Path, threads: usize, board: &Board) -> Result<Done, Raised> {
    let plan = Plan::read(file)?;
    let study = &plan.file.study;
    let asked = [
        ("ida", study.ida.is_some()),
        ("first-crack", study.first_crack.is_some()),
        ("interfaces", study.interfaces.is_some()),
    ];
    if let Some((key, _)) = asked.into_iter().find(|(_, asked)| *asked) {
        let error = InputError::new("asks for more than the runs of a design").in_file(file).key(key);
        return Err(error.help("`concio study run` answers it").into());
    }
    let cases: Vec<Case> = (0..plan.points.len()).map(|number| plan.case(number)).collect::<Result<_, _>>()?;
    let look = |progress: &Progress| board.look(progress.share);
    let mut runner = Runner::open(folder, &study.keep, threads, &look)?;
    let whole = runner.rows(&cases)?.is_some();
    let ids: Vec<String> = cases.iter().map(|case| runner.id(case)).collect::<Result<_, _>>()?;
    let found: Vec<Option<&Row>> = ids.iter().map(|id| runner.known(id)).collect();
    Ok((columns(&table::of_plan(&plan, &found)), whole))
}

fn columns(table: &Table) -> Value {
    let cells = |cells: &Cells| match cells {
        Cells::Numbers(numbers) => json!(numbers),
        Cells::Texts(texts) => json!(texts),
    };
    let column = |c: &table::Column| json!({ "name": c.name, "unit": c.unit, "cells": cells(&c.cells) });
    table.columns.iter().map(column).collect()
}
