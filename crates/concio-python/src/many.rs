//! Many runs at once.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use concio::many::{Job, Standing, simulate_each};
use concio::outcome::Outcome;
use pyo3::prelude::*;

use crate::failure::Raised;
use crate::prepared::Prepared;
use crate::run::Run;
use crate::watch::{Watch, beside};

/// What has ended so far, by number.
type Ended = Mutex<Vec<Option<concio::Result<Outcome>>>>;

/// Runs all on `threads` threads (0: one per core), alike ones side by side; none for those that Ctrl-C left out.
#[pyfunction]
pub fn run_many(
    py: Python<'_>,
    walls: Vec<Bound<'_, Prepared>>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<Option<Run>>, bool)> {
    let prepared: Vec<_> = walls.iter().map(|wall| wall.get().prepared.clone()).collect();
    let ended: Ended = Mutex::new(prepared.iter().map(|_| None).collect());
    let mut watch = Watch::new(progress);
    let start = Instant::now();
    let worked = py.detach(|| {
        beside(&mut watch, |board| {
            let jobs: Vec<Job> = prepared.iter().map(|prepared| Job::from(&**prepared)).collect();
            let keep = |number: usize, outcome| {
                ended.lock().unwrap_or_else(PoisonError::into_inner)[number] = Some(outcome);
            };
            simulate_each(&jobs, threads, None, &|standing: Standing| board.look(standing.share), &keep);
        })
    });
    worked.map_err(|_| Raised::Other("a run panicked: this is an error of the engine".into()))?;
    if let Some(error) = watch.error {
        return Err(error);
    }
    // Runs share threads and lanes: of one alone no time is known.
    let seconds = start.elapsed().as_secs_f64() / walls.len().max(1) as f64;
    let ended = ended.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut runs = Vec::with_capacity(ended.len());
    for (wall, outcome) in walls.iter().zip(ended) {
        let outcome = outcome.transpose().map_err(Raised::from)?;
        let run = outcome.map(|outcome| wall.get().ended(py, outcome, seconds, watch.interrupted));
        runs.push(run.transpose()?);
    }
    Ok((runs, watch.interrupted))
}
