//! Runs that end with their first crack: single runs on several threads, each looked at after every step.
//!
//! What a wall does once it has cracked is not asked, and has no bound: friction that lets go and sticks again takes small
//! steps. Lanes ([`concio::many`]) cannot drop one of their runs, and are no faster here: docs/studies/first-cracking.md.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use concio::Result;
use concio::many::{Job, Standing};
use concio::outcome::Outcome;
use concio::record::{Recording, StopReason};
use concio::run::Control;
use concio::simulate::{Progress, Simulation};

use crate::limits::{Limits, Rule};

/// Steps from one look at the watch to the next.
const BETWEEN_LOOKS: u64 = 4096;

/// As [`concio::many::simulate_each`], but a run in which a joint cracks ends there, as [`StopReason::Completed`] with the time that
/// it has reached, and no histories are kept.
pub fn simulate_until(
    jobs: &[Job],
    rule: &Rule,
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
        rule,
        watch,
        taken: AtomicUsize::new(0),
        ended: AtomicUsize::new(0),
        under_way: Mutex::new(vec![0.0; threads]),
        stopped: AtomicBool::new(false),
    };
    std::thread::scope(|scope| {
        for thread in 1..threads {
            let batch = &batch;
            scope.spawn(move || batch.work(thread, keep));
        }
        batch.work(0, keep);
    });
}

struct Batch<'a> {
    jobs: &'a [Job<'a>],
    rule: &'a Rule,
    watch: &'a (dyn Fn(Standing) -> Control + Sync),
    taken: AtomicUsize,
    ended: AtomicUsize,
    /// Per thread: share of its run that is done.
    under_way: Mutex<Vec<f64>>,
    stopped: AtomicBool,
}

impl Batch<'_> {
    fn work(&self, thread: usize, keep: &(dyn Fn(usize, Result<Outcome>) + Sync)) {
        while self.goes_on(thread, 0.0) {
            let number = self.taken.fetch_add(1, Ordering::Relaxed);
            let Some(job) = self.jobs.get(number) else { return };
            let outcome = self.one(thread, job);
            self.ended.fetch_add(1, Ordering::Relaxed);
            keep(number, outcome);
        }
    }

    fn one(&self, thread: usize, job: &Job) -> Result<Outcome> {
        let mut run = Simulation::new(job.model, job.solver, job.sampling)?;
        let limits = Limits::of(job.model, self.rule);
        let mut looked = 0;
        let reason = loop {
            let progress = run.advance(1);
            run.clear_recording();
            if let Progress::Ended(reason) = progress {
                break reason;
            }
            if limits.as_ref().is_some_and(|l| l.reached(&run.state())) {
                break StopReason::Completed;
            }
            let status = run.status();
            if status.steps >= looked + BETWEEN_LOOKS {
                looked = status.steps;
                if !self.goes_on(thread, status.time / status.duration) {
                    break StopReason::Interrupted;
                }
            }
        };
        Ok(run.outcome(Recording::default(), reason))
    }

    fn goes_on(&self, thread: usize, share: f64) -> bool {
        let under_way: f64 = {
            let mut shares = self.under_way.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            shares[thread] = share;
            shares.iter().sum()
        };
        let (ended, of) = (self.ended.load(Ordering::Relaxed), self.jobs.len());
        let standing = Standing { ended, of, share: ((ended as f64 + under_way) / of.max(1) as f64).min(1.0) };
        if (self.watch)(standing) == Control::Stop {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.stopped.load(Ordering::Relaxed)
    }
}
