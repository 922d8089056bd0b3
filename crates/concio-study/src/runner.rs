//! Does runs that the store does not have: side by side, in lanes where walls are alike, on several threads.
//!
//! A run that cannot be prepared or panics becomes a row that says why, and the others go on.

use std::any::Any;
use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use concio::case::Case;
use concio::ground::{GroundMotion, Library};
use concio::many::{Job, Standing, Until, simulate_each};
use concio::model::Model;
use concio::outcome::Outcome;
use concio::record::StopReason;
use concio::run::{Control, Prepared, joint_rows, prepare_with};
use concio::store::{digest, hdf5};
use concio::warning::WarningKind;
use concio::{Error, Result};
use rayon::prelude::*;

use crate::file::{Keep, PerJoint};
use crate::limits::Rule;
use crate::measures::{End, Row, row};
use crate::plan::Records;
use crate::store::Store;
use crate::task::{Task, tasks};
use crate::warned::Warned;

/// Threads wait for each other where one set of runs ends and the next begins, so sets are large; but no larger than this
/// in runs and in memory, about [bytes], and no longer in the making: what is being made is lost when a study is killed.
const MOST_AT_ONCE: usize = 4096;
const MOST_MEMORY: usize = 1 << 30;
const MOST_MAKING: Duration = Duration::from_secs(5);
/// Memory of a run per block, and per sample of its motion [bytes].
const PER_BLOCK: usize = 2500;
const PER_SAMPLE: usize = 24;

/// How far the runs are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Runs that are over, those that the store had included.
    pub done: usize,
    /// Of these, those that the store had.
    pub known: usize,
    /// Runs in all.
    pub of: usize,
    /// Runs that failed or stopped early.
    pub failed: usize,
    /// Share of the work of this call that is done, 0 … 1.
    pub share: f64,
    /// Time by the clock since the call.
    pub elapsed: Duration,
}

/// Solves a set of jobs: [`simulate_each`], or a stand-in in tests.
pub type Solve =
    fn(&[Job], usize, Option<&Until>, &(dyn Fn(Standing) -> Control + Sync), &(dyn Fn(usize, Result<Outcome>) + Sync));

/// Does tasks outside of this process, or writes them down for others to do: hands every row on as it comes, and stops where
/// that says so. [`Control::Stop`] where it was stopped, or hands no rows on.
pub type Elsewhere<'a> = dyn Fn(Vec<Task>, &mut Deliver) -> Result<Control> + Sync + 'a;

/// Takes a row that came from elsewhere.
pub type Deliver<'a> = dyn FnMut(Row) -> Result<Control> + 'a;

/// Who does the runs.
#[derive(Clone, Copy)]
pub enum Hands<'a> {
    /// Threads of this process; 0 for one per core.
    Here(usize),
    /// Others, that take so many runs at a time.
    Elsewhere(&'a Elsewhere<'a>, usize),
}

impl From<usize> for Hands<'_> {
    fn from(threads: usize) -> Self {
        Hands::Here(threads)
    }
}

/// Does runs and keeps what was measured of them.
pub struct Runner<'a> {
    store: Store,
    hands: Hands<'a>,
    /// What is kept per joint.
    pub joints: Vec<PerJoint>,
    /// Whether whole results are kept.
    pub results: bool,
    /// Whether rows that the store does not have are left undone, as if the watch had stopped them.
    pub reading: bool,
    records: Records,
    library: Library,
    /// Where runs are made ready.
    pool: rayon::ThreadPool,
    watch: &'a (dyn Fn(&Progress) -> Control + Sync),
    solve: Solve,
    until: Option<Rule>,
    /// What the runs that were asked for warn of, each counted once.
    pub warned: Warned,
    counted: HashSet<String>,
    /// Time by the clock spent inside the solver.
    pub solving: Duration,
}

impl<'a> Runner<'a> {
    /// With the store of `folder`; `watch` is called a few times a second and can stop the runs.
    ///
    /// # Errors
    /// [`Error::Io`] when the store cannot be read.
    pub fn open(
        folder: &Path,
        keep: &Keep,
        hands: impl Into<Hands<'a>>,
        watch: &'a (dyn Fn(&Progress) -> Control + Sync),
    ) -> Result<Self> {
        let hands = hands.into();
        let threads = match hands {
            Hands::Here(threads) => threads,
            Hands::Elsewhere(..) => 0,
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|e| Error::io(folder, std::io::Error::other(e)))?;
        Ok(Runner {
            store: Store::open(folder)?,
            hands,
            joints: keep.joints.clone(),
            results: keep.results,
            reading: false,
            records: Records::default(),
            library: Library::default(),
            pool,
            watch,
            solve: simulate_each,
            until: None,
            warned: Warned::default(),
            counted: HashSet::new(),
            solving: Duration::ZERO,
        })
    }

    /// With accelerograms that are in memory.
    pub fn with_library(mut self, library: Library) -> Self {
        self.library = library;
        self
    }

    /// With another solver.
    pub fn solved_by(mut self, solve: Solve) -> Self {
        self.solve = solve;
        self
    }

    /// Ends every run with its first crack. Such runs are known by other ids than whole ones, and keep no whole results.
    pub fn until(mut self, rule: Rule) -> Self {
        self.until = Some(rule);
        self.results = false;
        self
    }

    /// What is known.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// Id of a case, and of where its run ends.
    ///
    /// # Errors
    /// A record that cannot be read.
    pub fn id(&self, case: &Case) -> Result<String> {
        let whole = self.records.id(case, &self.library)?;
        let Some(rule) = &self.until else { return Ok(whole) };
        let hash = blake3::hash(format!("{whole} until {}", rule.key()).as_bytes());
        Ok(hash.to_hex()[..32].to_string())
    }

    /// The row of a case, if the store has it with all that is kept.
    pub fn known(&self, id: &str) -> Option<&Row> {
        self.store.holding(id, &self.joints, self.results)
    }

    /// What `ask` finds with runs that end with their first crack ([`Runner::until`]) and keep `joints`, whatever this runner does else.
    pub fn with_cracks<T>(&mut self, rule: &Rule, joints: &[PerJoint], ask: impl FnOnce(&mut Self) -> T) -> T {
        let own = (
            self.until.replace(*rule),
            std::mem::take(&mut self.results),
            std::mem::replace(&mut self.joints, joints.to_vec()),
        );
        let found = ask(self);
        (self.until, self.results, self.joints) = own;
        found
    }

    /// The rows of `cases`, in their order: from the store, or run now. None when the watch stopped the runs (what was
    /// done until then is in the store), or [`Runner::reading`] and some are not known.
    ///
    /// # Errors
    /// The store cannot be written, a record cannot be read. Cases that fail have rows that say so.
    pub fn rows(&mut self, cases: &[Case]) -> Result<Option<Vec<Row>>> {
        let ids = cases.iter().map(|c| self.id(c)).collect::<Result<Vec<_>>>()?;
        if self.results {
            let store = &mut self.store;
            self.pool.install(|| store.look_at_results(ids.iter().map(String::as_str), true));
        }
        let mut seen = HashSet::new();
        let todo: Vec<usize> =
            (0..cases.len()).filter(|&i| self.known(&ids[i]).is_none() && seen.insert(&ids[i])).collect();
        if self.reading && !todo.is_empty() {
            return Ok(None);
        }
        let tally = Tally::new(cases.len(), cases.len() - todo.len(), ids.iter().filter_map(|id| self.store.get(id)));
        if let Hands::Elsewhere(work, at_once) = self.hands
            && !todo.is_empty()
        {
            let todo: Vec<_> = todo.iter().map(|&i| (ids[i].as_str(), &cases[i])).collect();
            if self.elsewhere(work, &todo, at_once, &tally)? == Control::Stop {
                self.store.sync()?;
                return Ok(None);
            }
        }
        let mut rest = if matches!(self.hands, Hands::Here(_)) { &todo[..] } else { &[] };
        while !rest.is_empty() {
            let set = self.made(cases, rest);
            let (these, after) = rest.split_at(set.len());
            rest = after;
            let set = these.iter().map(|&i| ids[i].as_str()).zip(set).collect();
            if self.run_set(set, &tally)? == Control::Stop {
                self.store.sync()?;
                return Ok(None);
            }
        }
        self.store.sync()?;
        (self.watch)(&tally.progress(0.0));
        for id in &ids {
            if let Some(row) = self.store.get(id)
                && self.counted.insert(id.clone())
            {
                self.warned.add(|| format!("run {id}"), &row.warnings);
            }
        }
        let row = |id: &String| self.store.get(id).cloned();
        Ok(Some(ids.iter().filter_map(row).collect()))
    }

    /// Has runs done elsewhere.
    fn elsewhere(
        &mut self,
        work: &Elsewhere,
        todo: &[(&str, &Case)],
        at_once: usize,
        tally: &Tally,
    ) -> Result<Control> {
        let results = self.results.then(|| self.store.folder());
        let tasks = tasks(todo, at_once, (&self.joints, self.until, results), &self.library)?;
        let mut open: HashSet<&str> = todo.iter().map(|(id, _)| *id).collect();
        let begun = Instant::now();
        let (store, watch) = (&mut self.store, self.watch);
        let ended = work(tasks, &mut |row| {
            // A task that was done twice brings its rows twice.
            if open.remove(row.id.as_str()) {
                tally.ended(row.end == End::Completed);
                store.append(row)?;
            }
            Ok(watch(&tally.progress(0.0)))
        })?;
        self.solving += begun.elapsed();
        match (ended, open.len()) {
            (Control::Continue, left @ 1..) => Err(Error::Store {
                path: self.store.folder().to_path_buf(),
                what: format!("{left} of {} runs that were given away did not come back", todo.len()),
            }),
            _ => Ok(ended),
        }
    }

    /// The first of `todo` made ready, as many as are to run together.
    fn made(&self, cases: &[Case], todo: &[usize]) -> Vec<std::result::Result<Prepared, String>> {
        let begun = Instant::now();
        let mut set = Vec::new();
        let (mut memory, mut next) = (0, self.pool.current_num_threads());
        while set.len() < todo.len().min(MOST_AT_ONCE) && memory < MOST_MEMORY && begun.elapsed() < MOST_MAKING {
            let some = &todo[set.len()..todo.len().min(set.len() + next)];
            let make = || some.par_iter().map(|&i| ready(&cases[i], &self.library)).collect::<Vec<_>>();
            let made = self.pool.install(make);
            let weight = |p: &Prepared| PER_BLOCK * p.model.wall.blocks.len() + PER_SAMPLE * samples(&p.model);
            memory += made.iter().flatten().map(weight).sum::<usize>();
            set.extend(made);
            // As many again, while those there took little of what there is.
            next = if 4 * memory < MOST_MEMORY { 2 * next } else { self.pool.current_num_threads() };
        }
        set
    }

    fn run_set(&mut self, set: Vec<(&str, std::result::Result<Prepared, String>)>, tally: &Tally) -> Result<Control> {
        let mut jobs: Vec<(&str, &Prepared)> = Vec::new();
        for (id, prepared) in &set {
            match prepared {
                Ok(prepared) => jobs.push((id, prepared)),
                Err(cause) => {
                    tally.ended(false);
                    self.store.append(Row::failed(id, cause.clone()))?;
                }
            }
        }
        let begun = Instant::now();
        let ended = self.solve_set(&jobs, tally);
        self.solving += begun.elapsed();
        ended
    }

    /// All jobs together; where one panics, those not done one by one.
    fn solve_set(&mut self, jobs: &[(&str, &Prepared)], tally: &Tally) -> Result<Control> {
        let desk = Desk {
            store: Mutex::new(&mut self.store),
            joints: &self.joints,
            results: self.results,
            cut: self.until.is_some(),
            error: Mutex::new(None),
            done: Mutex::new(HashSet::new()),
            stopped: AtomicUsize::new(0),
        };
        let watch = |standing: Standing| {
            desk.watch(self.watch, tally, standing.share * jobs.len() as f64 - standing.ended as f64)
        };
        let until = self.until.as_ref().map(Rule::until);
        let run = |some: &[(&str, &Prepared)], threads: usize| {
            let list: Vec<Job> = some.iter().map(|(_, p)| Job::from(*p)).collect();
            let keep = |number: usize, outcome: Result<Outcome>| desk.keep(some[number], outcome, tally);
            catch_unwind(AssertUnwindSafe(|| (self.solve)(&list, threads, until.as_deref(), &watch, &keep)))
        };
        let Hands::Here(threads) = self.hands else { return Ok(Control::Continue) };
        if run(jobs, threads).is_err() {
            for job in jobs {
                if desk.stopped() || locked(&desk.done).contains(job.0) {
                    continue;
                }
                if let Err(panic) = run(&[*job], 1) {
                    desk.put(Row::failed(job.0, format!("panicked: {}", message(&*panic))), tally);
                }
            }
        }
        match desk.error.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(error) => Err(error),
            None if desk.stopped.load(Ordering::Relaxed) > 0 => Ok(Control::Stop),
            None => Ok(Control::Continue),
        }
    }
}

/// Takes what the threads bring.
struct Desk<'s> {
    store: Mutex<&'s mut Store>,
    joints: &'s [PerJoint],
    results: bool,
    /// Whether runs end before their time.
    cut: bool,
    error: Mutex<Option<Error>>,
    done: Mutex<HashSet<String>>,
    stopped: AtomicUsize,
}

impl Desk<'_> {
    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed) > 0 || locked(&self.error).is_some()
    }

    fn watch(&self, user: &(dyn Fn(&Progress) -> Control + Sync), tally: &Tally, under_way: f64) -> Control {
        if self.stopped() {
            return Control::Stop;
        }
        let answer = user(&tally.progress(under_way));
        if answer == Control::Stop {
            self.stopped.store(1, Ordering::Relaxed);
        }
        answer
    }

    fn keep(&self, (id, prepared): (&str, &Prepared), outcome: Result<Outcome>, tally: &Tally) {
        let row = match outcome {
            // Stopped on the way: to be done again.
            Ok(outcome) if outcome.stop_reason == StopReason::Interrupted => return,
            Ok(outcome) => {
                let mut row = row(id, prepared, &outcome, self.joints);
                if self.results {
                    match self.write_result(id, prepared, &outcome) {
                        Ok(digest) => row.result = digest,
                        Err(error) => {
                            locked(&self.error).get_or_insert(error);
                            return;
                        }
                    }
                }
                if self.cut {
                    // That the wall moves where its run was cut off says nothing of it.
                    row.warnings.retain(|w| w.kind != WarningKind::UnderWay);
                }
                row
            }
            Err(error) => Row::failed(id, error.to_string()),
        };
        self.put(row, tally);
    }

    fn put(&self, row: Row, tally: &Tally) {
        locked(&self.done).insert(row.id.clone());
        tally.ended(row.end == End::Completed);
        if let Err(error) = locked(&self.store).append(row) {
            locked(&self.error).get_or_insert(error);
        }
    }

    /// Its digest.
    fn write_result(&self, id: &str, prepared: &Prepared, outcome: &Outcome) -> Result<Option<String>> {
        let path = locked(&self.store).result_path(id);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
        }
        let (model, provenance) = (&prepared.model, prepared.provenance());
        hdf5::write(&path, &provenance, &model.wall, &joint_rows(model), outcome)?;
        digest::noted(&path)
    }
}

/// Counts runs.
struct Tally {
    of: usize,
    known: usize,
    ended: AtomicUsize,
    failed: AtomicUsize,
    begun: Instant,
}

impl Tally {
    fn new<'r>(of: usize, known: usize, rows: impl Iterator<Item = &'r Row>) -> Self {
        let failed = rows.filter(|r| r.end != End::Completed).count();
        Tally { of, known, ended: AtomicUsize::new(0), failed: AtomicUsize::new(failed), begun: Instant::now() }
    }

    fn ended(&self, well: bool) {
        self.ended.fetch_add(1, Ordering::Relaxed);
        if !well {
            self.failed.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn progress(&self, under_way: f64) -> Progress {
        let ended = self.ended.load(Ordering::Relaxed);
        let todo = (self.of - self.known).max(1) as f64;
        Progress {
            done: self.known + ended,
            known: self.known,
            of: self.of,
            failed: self.failed.load(Ordering::Relaxed),
            share: ((ended as f64 + under_way.max(0.0)) / todo).min(1.0),
            elapsed: self.begun.elapsed(),
        }
    }
}

/// Samples of the motions that a model holds.
fn samples(model: &Model) -> usize {
    let motions = &model.excitation;
    [&motions.base, &motions.top, &motions.vertical].into_iter().map(GroundMotion::samples).sum()
}

/// Makes a case ready; a panic on the way is a cause like any other.
fn ready(case: &Case, library: &Library) -> std::result::Result<Prepared, String> {
    catch_unwind(AssertUnwindSafe(|| prepare_with(case.clone(), Path::new(""), library)))
        .unwrap_or_else(|panic| Err(concio::InputError::new(format!("panicked: {}", message(&*panic))).into()))
        .map_err(|e| e.to_string())
}

fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_string());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without a message".into())
}

/// What a panicking thread held is only ever replaced whole.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
