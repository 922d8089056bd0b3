//! Does the runs, several side by side, and keeps what was read off them, so that nothing is run twice.

use std::collections::BTreeMap;
use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::measures::{self, Measures};
use super::walls::{self, MEMBERS, Setting, Which};
use concio::Error;
use concio::record::StopReason;
use concio::run::{self, Control, Prepared};
use concio::store::{SCHEMA_VERSION, StoredRun, digest, hdf5, read_summary};
use concio_cli::failure::Failure;
use concio_cli::{files, report, stop};
use concio_study::warned::{Warned, of_summary};
use serde::{Deserialize, Serialize};

/// Name of the file of [`Kept`] in the folder of results.
const KEPT: &str = "measures.json";
/// Raised when [`Measures`] means something else, so that older files are not believed.
const MEANING: u32 = 2;

/// One run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Job {
    /// What the research report leaves open.
    pub setting: Setting,
    /// The case.
    pub which: Which,
    /// From 0, below [`MEMBERS`].
    pub member: usize,
}

impl Job {
    /// The five runs that leave a folder: the wall files as they are.
    fn folder(self, out: &Path) -> Option<PathBuf> {
        let shown = self.setting == Setting::Files && self.member == 0 && self.which != Which::Control;
        shown.then(|| out.join(self.which.name()))
    }
}

/// All runs: of the wall files with all members, of the other settings one each.
pub fn all() -> Vec<Job> {
    let members = |setting| if setting == Setting::Files { MEMBERS } else { 1 };
    let of = |setting| (0..members(setting)).map(move |member| (setting, member));
    let runs = Setting::ALL.into_iter().flat_map(of);
    runs.flat_map(|(setting, member)| Which::ALL.map(|which| Job { setting, which, member })).collect()
}

/// What earlier calls read off their runs.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Kept {
    meaning: u32,
    measures: Vec<Measures>,
}

/// Runs what is not yet done into `out`; none when the user stopped it, and then the same call goes on later.
/// `done` is called with the number of runs that are over, from any thread.
///
/// # Errors
/// A folder that cannot be written, a run that did not reach its end.
pub fn run_all(out: &Path, done: &(dyn Fn(usize) + Sync)) -> Result<Option<BTreeMap<Job, Measures>>, Failure> {
    fs::create_dir_all(out).map_err(|e| Error::io(out, e))?;
    let kept = Mutex::new(read_kept(out));
    let (jobs, next, finished) = (all(), AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || -> Result<Vec<(Job, Measures)>, Failure> {
        let mut mine = Vec::new();
        while let Some(&job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let Some(measures) = one(job, out, &kept)? else { break };
            mine.push((job, measures));
            done(finished.fetch_add(1, Ordering::Relaxed) + 1);
        }
        Ok(mine)
    };
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let parts: Vec<Result<Vec<(Job, Measures)>, Failure>> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let lost = || Err(Failure::Other("a worker ended before its work did".into(), None));
        workers.into_iter().map(|w| w.join().unwrap_or_else(|_| lost())).collect()
    });
    let mut found = BTreeMap::new();
    for part in parts {
        found.extend(part?);
    }
    Ok((found.len() == jobs.len()).then_some(found))
}

/// What the runs warn of that left a folder in `out`.
pub fn warned(out: &Path) -> Warned {
    let mut warned = Warned::default();
    for job in all() {
        let Some(folder) = job.folder(out) else { continue };
        let summary = read_summary(&folder.join(run::SUMMARY)).unwrap_or_default();
        warned.add(|| job.which.name().into(), &of_summary(&summary));
    }
    warned
}

/// None when the user asked to stop.
fn one(job: Job, out: &Path, kept: &Mutex<Kept>) -> Result<Option<Measures>, Failure> {
    if stop::asked() {
        return Ok(None);
    }
    let file = walls::file(job.which, job.setting, job.member)?;
    let prepared = run::prepare_case(file.case.clone(), file.folder())?;
    let folder = job.folder(out);
    let hash = &prepared.inputs_hash;
    let known = locked(kept).measures.iter().find(|m| m.inputs_hash == *hash).cloned();
    if folder.as_ref().is_none_or(|f| is_done(f, hash))
        && let Some(known) = known
    {
        return Ok(Some(known));
    }
    let measures = match folder {
        Some(folder) if is_done(&folder, hash) => measures::of(&hdf5::read(&folder.join(run::RESULT))?),
        Some(folder) => match in_folder(&prepared, &folder, file.text())? {
            Some(run) => measures::of(&run),
            None => return Ok(None),
        },
        None => measures::of(&stored(&prepared, run::run_in_memory(&prepared)?)?),
    };
    let mut kept = locked(kept);
    kept.measures.retain(|m| m.inputs_hash != *hash);
    kept.measures.push(measures.clone());
    write_kept(out, &mut kept)?;
    Ok(Some(measures))
}

/// Whether `folder` holds the whole run with these inputs, as it was written.
fn is_done(folder: &Path, hash: &str) -> bool {
    let summary = read_summary(&folder.join(run::SUMMARY)).unwrap_or_default();
    let whole = summary["stop_reason"] == "completed" && summary["inputs_hash"] == hash;
    let result = || matches!(digest::check(&folder.join(run::RESULT)), Ok(Some(_)));
    whole && folder.join(run::REPORT).is_file() && result()
}

/// As `concio run` does it; none when it was stopped.
fn in_folder(prepared: &Prepared, folder: &Path, text: &str) -> Result<Option<StoredRun>, Failure> {
    let look = |_: &concio::simulate::Status| if stop::asked() { Control::Stop } else { Control::Continue };
    let finished = run::run(prepared, folder, &mut { look })?;
    let joints = run::joint_rows(&prepared.model);
    report::write(folder, &report::Content::of_run(folder, prepared, &joints, &finished, text))?;
    if finished.outcome.stop_reason == StopReason::Interrupted {
        return Ok(None);
    }
    stored(prepared, finished.outcome).map(Some)
}

fn stored(prepared: &Prepared, outcome: concio::outcome::Outcome) -> Result<StoredRun, Failure> {
    if outcome.stop_reason != StopReason::Completed {
        let what = format!(
            "{}: {}",
            prepared.case.title,
            concio_cli::digest::why(outcome.stop_reason, prepared.model.rocking().is_some())
        );
        return Err(Failure::Other(what, None));
    }
    Ok(StoredRun {
        schema_version: SCHEMA_VERSION,
        provenance: prepared.provenance(),
        wall: prepared.model.wall.clone(),
        joints: run::joint_rows(&prepared.model),
        outcome,
    })
}

/// A worker that panicked left the list whole: it is only ever replaced entry by entry.
fn locked(kept: &Mutex<Kept>) -> std::sync::MutexGuard<'_, Kept> {
    kept.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Nothing when there is no such file, it is of another version or not what was written: then all is run again.
fn read_kept(out: &Path) -> Kept {
    let text = fs::read_to_string(out.join(KEPT)).unwrap_or_default();
    let kept = serde_json::from_str(&text).ok().and_then(digest::opened);
    let kept: Kept = kept.and_then(|kept| serde_json::from_value(kept).ok()).unwrap_or_default();
    if kept.meaning == MEANING { kept } else { Kept { meaning: MEANING, measures: Vec::new() } }
}

/// In an order that does not depend on which run was over first.
fn write_kept(out: &Path, kept: &mut Kept) -> Result<(), Failure> {
    kept.measures.sort_by(|a, b| a.inputs_hash.cmp(&b.inputs_hash));
    let mut value = serde_json::to_value(kept).map_err(|e| Failure::Other(e.to_string(), None))?;
    digest::seal(&mut value);
    files::write(&out.join(KEPT), &value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_runs_leave_a_folder() {
        let jobs = all();
        let folders: Vec<_> = jobs.iter().filter_map(|j| j.folder(Path::new("out"))).collect();
        assert_eq!(folders.len(), 5);
        assert_eq!(jobs.len(), 6 * (MEMBERS + Setting::ALL.len() - 1));
    }
}
