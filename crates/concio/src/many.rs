//! Many runs at once: runs of one wall with other parameters, scales or records advance side by side in the lanes of
//! vector instructions, groups of them on several threads.
//!
//! A run of a batch has the bits that the same run has alone, whatever runs beside it and on however many threads.
//! Runs share lanes when their walls have the same joints between the same blocks, the same joints rub, the same
//! joints are one-sided and the scheme is the same; masses, stiffnesses, normal forces, laws, motions, durations,
//! tolerances and samplings may differ. What lanes do not take runs alone in the same call: set-valued friction,
//! bonds, devices with laws of their own (`bouc-wen`, `re-centring`, a dashpot with a power of the velocity), and normal
//! forces that differ in action and reaction (`overburden`).

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::case::Solver;
use crate::error::Result;
use crate::lanes::{Desk, Gang, Kind};
use crate::model::Model;
use crate::outcome::Outcome;
use crate::record::{Recording, StopReason};
use crate::run::{Control, Prepared};
use crate::simulate::{Progress, Sampling, Simulation};

/// A run of a batch.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// The compiled wall.
    pub model: &'a Model,
    /// Scheme and tolerances.
    pub solver: &'a Solver,
    /// What it keeps.
    pub sampling: &'a Sampling,
}

impl<'a> From<&'a Prepared> for Job<'a> {
    fn from(prepared: &'a Prepared) -> Self {
        Job { model: &prepared.model, solver: &prepared.case.solver, sampling: &prepared.sampling }
    }
}

/// How far a batch is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Runs that have ended.
    pub ended: usize,
    /// Runs in all.
    pub of: usize,
    /// Share of the work that is done, from 0 to 1: every run counts alike, one under way by the time it has reached.
    pub share: f64,
}

/// Runs all `jobs` on `threads` threads (0: one per core) and returns what became of each, in their order.
///
/// # Errors
/// Of a single run, in its place: as [`Simulation::new`]. The others do not suffer.
pub fn simulate_many(jobs: &[Job], threads: usize) -> Vec<Result<Outcome>> {
    let outcomes: Mutex<Vec<Option<Result<Outcome>>>> = Mutex::new(jobs.iter().map(|_| None).collect());
    let keep = |number: usize, outcome| {
        let mut outcomes = outcomes.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        outcomes[number] = Some(outcome);
    };
    simulate_each(jobs, threads, &|_| Control::Continue, &keep);
    // Every job is handed to `keep` once.
    outcomes.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner()).into_iter().flatten().collect()
}

/// Runs all `jobs` on `threads` threads (0: one per core) and hands each result to `keep` with the number of its job,
/// as it ends and on the thread that made it: no more results are held than runs are under way. `watch` is called a few
/// times a second on every thread; after [`Control::Stop`] the runs under way end as
/// [`StopReason::Interrupted`] where they are, and those that have not begun are left out.
pub fn simulate_each(
    jobs: &[Job],
    threads: usize,
    watch: &(dyn Fn(Standing) -> Control + Sync),
    keep: &(dyn Fn(usize, Result<Outcome>) + Sync),
) {
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
        some => some,
    };
    let batch = Batch {
        jobs,
        queues: queues(jobs, threads),
        watch,
        keep,
        ended: AtomicUsize::new(0),
        under_way: Mutex::new(vec![0.0; threads]),
        stopped: AtomicBool::new(false),
    };
    std::thread::scope(|scope| {
        for thread in 1..threads {
            let batch = &batch;
            scope.spawn(move || batch.work(thread));
        }
        batch.work(0);
    });
}

/// Jobs that are taken one after the other.
struct Queue {
    jobs: Vec<usize>,
    taken: AtomicUsize,
    /// Lanes that a thread fills with them; 1 for single runs.
    lanes: usize,
}

/// Lanes from which on they are faster than as many single runs.
const FEWEST_LANES: usize = 3;

fn queues(jobs: &[Job], threads: usize) -> Vec<Queue> {
    let mut alone = Vec::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut group_of: HashMap<Kind, usize> = HashMap::new();
    for (number, job) in jobs.iter().enumerate() {
        match Kind::of(job.model, job.solver.scheme) {
            Some(kind) => {
                let group = *group_of.entry(kind).or_insert(groups.len());
                if group == groups.len() {
                    groups.push(Vec::new());
                }
                groups[group].push(number);
            }
            None => alone.push(number),
        }
    }
    let queue = |jobs: Vec<usize>, lanes: usize| Queue { jobs, taken: AtomicUsize::new(0), lanes };
    let mut queues: Vec<Queue> = Vec::new();
    for group in groups {
        // No thread takes so many that another has none.
        let lanes = group.len().div_ceil(threads).min(crate::lanes::WIDTH);
        if lanes < FEWEST_LANES { alone.extend(group) } else { queues.push(queue(group, lanes)) }
    }
    queues.push(queue(alone, 1));
    queues
}

struct Batch<'a> {
    jobs: &'a [Job<'a>],
    queues: Vec<Queue>,
    watch: &'a (dyn Fn(Standing) -> Control + Sync),
    keep: &'a (dyn Fn(usize, Result<Outcome>) + Sync),
    ended: AtomicUsize,
    /// Per thread: sum over its runs under way of the share that each has reached.
    under_way: Mutex<Vec<f64>>,
    stopped: AtomicBool,
}

impl<'a> Batch<'a> {
    fn work(&self, thread: usize) {
        for queue in &self.queues {
            let mut seat = Seat { batch: self, queue, thread };
            while let Some((number, run)) = seat.next() {
                if queue.lanes > 1 {
                    // The first run says what kind the group is of, and takes the first lane.
                    Gang::new(&run, queue.lanes).start((number, run), &mut seat);
                } else {
                    seat.alone(number, run);
                }
            }
        }
    }

    fn give(&self, number: usize, outcome: Result<Outcome>) {
        self.ended.fetch_add(1, Ordering::Relaxed);
        (self.keep)(number, outcome);
    }

    fn goes_on(&self, thread: usize, under_way: f64) -> bool {
        let sum: f64 = {
            let mut shares = self.under_way.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            shares[thread] = under_way;
            shares.iter().sum()
        };
        let (ended, of) = (self.ended.load(Ordering::Relaxed), self.jobs.len());
        let standing = Standing { ended, of, share: ((ended as f64 + sum) / of as f64).min(1.0) };
        if (self.watch)(standing) == Control::Stop {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.stopped.load(Ordering::Relaxed)
    }
}

/// A thread at a queue.
struct Seat<'b, 'a> {
    batch: &'b Batch<'a>,
    queue: &'b Queue,
    thread: usize,
}

impl<'a> Desk<'a> for Seat<'_, 'a> {
    fn next(&mut self) -> Option<(usize, Simulation<'a>)> {
        while !self.batch.stopped.load(Ordering::Relaxed) {
            let at = self.queue.taken.fetch_add(1, Ordering::Relaxed);
            let number = *self.queue.jobs.get(at)?;
            let job = self.batch.jobs[number];
            match Simulation::new(job.model, job.solver, job.sampling) {
                Ok(run) => return Some((number, run)),
                Err(error) => self.batch.give(number, Err(error)),
            }
        }
        None
    }

    fn ended(&mut self, number: usize, outcome: Outcome) {
        self.batch.give(number, Ok(outcome));
    }

    fn goes_on(&mut self, under_way: f64) -> bool {
        self.batch.goes_on(self.thread, under_way)
    }
}

/// Steps of a single run from one look at the watch to the next.
const BETWEEN_LOOKS: u64 = 4096;

impl<'a> Seat<'_, 'a> {
    fn alone(&mut self, number: usize, mut run: Simulation<'a>) {
        let mut rows = Recording::default();
        let reason = loop {
            let progress = run.advance(BETWEEN_LOOKS);
            rows.append(run.recording());
            run.clear_recording();
            if let Progress::Ended(reason) = progress {
                break reason;
            }
            let status = run.status();
            if !self.goes_on(status.time / status.duration) {
                break StopReason::Interrupted;
            }
        };
        let outcome = run.outcome(rows, reason);
        self.ended(number, outcome);
    }
}
