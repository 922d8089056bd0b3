//! Many runs at once: runs of one wall with other parameters, scales or records advance side by side in the lanes of
//! vector instructions, groups of them on several threads.
//!
//! A run of a batch has the bits that the same run has alone, whatever runs beside it and on however many threads.
//! Runs share lanes when their walls have the same joints between the same blocks, the same joints rub, the same
//! joints are one-sided and the scheme is the same; masses, stiffnesses, normal forces, laws, motions, durations,
//! tolerances and samplings may differ. What lanes do not take runs alone in the same call: set-valued friction,
//! bonds, devices with laws of their own (`bouc-wen`, `re-centring`, a dashpot with a power of the velocity), and normal
//! forces that differ in action and reaction (`overburden`), and planar walls.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard};

use crate::case::Solver;
use crate::error::Result;
use concio_law::motion::Drive;
use concio_shear::lanes::{self, Desk, Gang, Kind};
use concio_shear::run::{Keep, Run};
use concio_shear::state::View;

use crate::keeper::Keeper;
use crate::model::Model;
use crate::outcome::Outcome;
use crate::record::{Event, Recording, StopReason};
use crate::run::{Control, Prepared};
use crate::simulate::{Progress, Sampling, Simulation};
use crate::state::State;

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

/// Builds, for a job, the test that ends its run.
pub type Until = dyn Fn(&Job) -> Box<dyn Fn(&State) -> bool> + Sync;

/// How far a batch is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Runs that have ended.
    pub ended: usize,
    /// Runs in all.
    pub of: usize,
    /// Share of the work that is done, from 0 to 1, no less than any that was counted before: every run counts alike, one under way by
    /// the time it has reached.
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
    simulate_each(jobs, threads, None, &|_| Control::Continue, &keep);
    // Every job is handed to `keep` once.
    outcomes.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner()).into_iter().flatten().collect()
}

/// Runs all `jobs` on `threads` threads (0: one per core) and hands each result to `keep` with the number of its job,
/// as it ends and on the thread that ended it: no more results are held than runs are under way. `watch` is called a few
/// times a second on every thread that has a run; after [`Control::Stop`] the runs under way end as
/// [`StopReason::Interrupted`] where they are, and those that have not begun are left out.
///
/// Where `until` says of a run that it is over after a step, it ends there, as [`StopReason::Completed`] with the time that it has reached; no
/// histories are kept, and no lanes are used, which cannot drop one of their runs.
pub fn simulate_each(
    jobs: &[Job],
    threads: usize,
    until: Option<&Until>,
    watch: &(dyn Fn(Standing) -> Control + Sync),
    keep: &(dyn Fn(usize, Result<Outcome>) + Sync),
) {
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
        // More than there are runs would only wait.
        some => some.min(jobs.len().max(1)),
    };
    let batch = Batch {
        jobs,
        queues: queues(jobs, threads, until.is_none()),
        until,
        rest: Mutex::new(Rest { runs: Vec::new(), busy: 0 }),
        more: Condvar::new(),
        waiting: AtomicUsize::new(0),
        watch,
        keep,
        ended: AtomicUsize::new(0),
        reached: Mutex::new(Reached { under_way: vec![0.0; threads], told: 0.0 }),
        stopped: AtomicBool::new(false),
    };
    std::thread::scope(|scope| {
        // All are busy before the first may wait for the others.
        let busy: Vec<Busy> = (0..threads).map(|_| Busy::new(&batch)).collect();
        let mut seats = busy.into_iter().enumerate();
        let own = seats.next();
        for (thread, busy) in seats {
            let batch = &batch;
            scope.spawn(move || batch.work(thread, busy));
        }
        if let Some((thread, busy)) = own {
            batch.work(thread, busy);
        }
    });
}

/// Jobs that are taken one after the other.
struct Queue {
    jobs: Vec<usize>,
    taken: AtomicUsize,
    /// Lanes that a thread fills with them; 1 for single runs.
    lanes: usize,
}

fn queues(jobs: &[Job], threads: usize, share: bool) -> Vec<Queue> {
    let mut alone = Vec::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut group_of: HashMap<Kind, usize> = HashMap::new();
    for (number, job) in jobs.iter().enumerate() {
        let shares = share && !job.model.turns();
        match shares.then(|| Kind::of(&job.model.shear, job.solver.scheme)).flatten() {
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
        let lanes = group.len().div_ceil(threads).min(lanes::WIDTH);
        if lanes < lanes::FEWEST { alone.extend(group) } else { queues.push(queue(group, lanes)) }
    }
    queues.push(queue(alone, 1));
    queues
}

/// A run under way that goes on alone, and what it has recorded so far.
struct Under<'a> {
    number: usize,
    run: Simulation<'a>,
    rows: Recording,
}

impl Under<'_> {
    /// Takes some steps; why the run ended, where it did.
    fn advance(&mut self) -> Option<StopReason> {
        let progress = self.run.advance(BETWEEN_LOOKS);
        self.rows.append(self.run.recording());
        self.run.clear_recording();
        if let Progress::Ended(reason) = progress { Some(reason) } else { None }
    }
    /// Likewise, without histories; it also ends after a step that it is over with.
    fn advance_until(&mut self, over: &dyn Fn(&State) -> bool) -> Option<StopReason> {
        for _ in 0..BETWEEN_LOOKS {
            let progress = self.run.advance(1);
            self.run.clear_recording();
            if let Progress::Ended(reason) = progress {
                return Some(reason);
            }
            if over(&self.run.state()) {
                return Some(StopReason::Completed);
            }
        }
        None
    }
    fn share(&self) -> f64 {
        self.run.status().share()
    }
    /// Time that it has yet to go through [s].
    fn left(&self) -> f64 {
        let status = self.run.status();
        status.duration - status.time
    }
}

/// What the last lanes have left for whatever thread is free.
struct Rest<'a> {
    runs: Vec<Under<'a>>,
    /// Threads at the queues, which may leave some yet.
    busy: usize,
}

impl<'a> Rest<'a> {
    /// The run that has farthest to go.
    fn take(&mut self) -> Option<Under<'a>> {
        let left = self.runs.iter().map(Under::left).enumerate();
        let (most, _) = left.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(self.runs.swap_remove(most))
    }
}

/// How far the runs under way are.
struct Reached {
    /// Per thread: sum over its runs of the share that each has reached.
    under_way: Vec<f64>,
    /// The largest share of the batch that was told: what leaves its lane is taken out as it is, and was counted as it was at the last
    /// look, so that a sum may fall.
    told: f64,
}

struct Batch<'a> {
    jobs: &'a [Job<'a>],
    queues: Vec<Queue>,
    rest: Mutex<Rest<'a>>,
    /// Told when there is more in `rest`, or less to come.
    more: Condvar,
    until: Option<&'a Until>,
    /// Threads that wait for it.
    waiting: AtomicUsize,
    watch: &'a (dyn Fn(Standing) -> Control + Sync),
    keep: &'a (dyn Fn(usize, Result<Outcome>) + Sync),
    ended: AtomicUsize,
    reached: Mutex<Reached>,
    stopped: AtomicBool,
}

/// A thread at the queues; however it goes, the others do not wait for it.
struct Busy<'b, 'a>(&'b Batch<'a>);

impl<'b, 'a> Busy<'b, 'a> {
    fn new(batch: &'b Batch<'a>) -> Self {
        batch.rest().busy += 1;
        Busy(batch)
    }
}

impl Drop for Busy<'_, '_> {
    fn drop(&mut self) {
        self.0.rest().busy -= 1;
        self.0.more.notify_all();
    }
}

impl<'a> Batch<'a> {
    fn work(&self, thread: usize, busy: Busy) {
        for queue in &self.queues {
            if queue.lanes > 1 {
                let mut seat = Seat { batch: self, queue, thread, lanes: Vec::new() };
                while let Some((number, run)) = seat.next() {
                    // The first run says what kind the group is of, and takes the first lane.
                    Gang::new(&run, queue.lanes).start((number, run), &mut seat);
                    self.reached().under_way[thread] = 0.0;
                }
            } else {
                while let Some((number, run)) = self.take(queue) {
                    self.alone(thread, Under { number, run, rows: Recording::default() });
                }
            }
            while let Some(under) = self.left_now() {
                self.alone(thread, under);
            }
        }
        drop(busy);
        while let Some(under) = self.next_left() {
            self.alone(thread, under);
        }
    }

    /// The next run of a queue, and its number.
    fn take(&self, queue: &Queue) -> Option<(usize, Simulation<'a>)> {
        while !self.stopped.load(Ordering::Relaxed) {
            let at = queue.taken.fetch_add(1, Ordering::Relaxed);
            let number = *queue.jobs.get(at)?;
            let job = self.jobs[number];
            match Simulation::new(job.model, job.solver, job.sampling) {
                Ok(run) => return Some((number, run)),
                Err(error) => self.give(number, Err(error)),
            }
        }
        None
    }

    fn rest(&self) -> MutexGuard<'_, Rest<'a>> {
        self.rest.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// The next of the runs that have been left by their lanes.
    fn left_now(&self) -> Option<Under<'a>> {
        self.rest().take()
    }

    /// The next of the runs left by their lanes; waits while there may be one.
    fn next_left(&self) -> Option<Under<'a>> {
        let mut rest = self.rest();
        while rest.runs.is_empty() && rest.busy > 0 {
            self.waiting.fetch_add(1, Ordering::Relaxed);
            rest = self.more.wait(rest).unwrap_or_else(|poisoned| poisoned.into_inner());
            self.waiting.fetch_sub(1, Ordering::Relaxed);
        }
        rest.take()
    }

    fn alone(&self, thread: usize, mut under: Under<'a>) {
        let over = self.until.map(|until| until(&self.jobs[under.number]));
        // Runs may be shorter than what lies between two looks.
        self.goes_on(thread, under.share());
        let reason = loop {
            if self.stopped.load(Ordering::Relaxed) {
                break StopReason::Interrupted;
            }
            let ended = match &over {
                None => under.advance(),
                Some(over) => under.advance_until(over),
            };
            if let Some(reason) = ended {
                break reason;
            }
            self.goes_on(thread, under.share());
        };
        // What ends here is no longer under way.
        self.reached().under_way[thread] = 0.0;
        self.give(under.number, Ok(under.run.outcome(under.rows, reason)));
    }

    fn reached(&self) -> MutexGuard<'_, Reached> {
        self.reached.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn give(&self, number: usize, outcome: Result<Outcome>) {
        self.ended.fetch_add(1, Ordering::Relaxed);
        (self.keep)(number, outcome);
    }

    fn goes_on(&self, thread: usize, under_way: f64) -> bool {
        let left: f64 = self.rest().runs.iter().map(Under::share).sum();
        let (ended, of) = (self.ended.load(Ordering::Relaxed), self.jobs.len());
        let share = {
            let mut reached = self.reached();
            reached.under_way[thread] = under_way;
            let sum = left + reached.under_way.iter().sum::<f64>();
            reached.told = ((ended as f64 + sum) / of as f64).max(reached.told).min(1.0);
            reached.told
        };
        let standing = Standing { ended, of, share };
        if (self.watch)(standing) == Control::Stop {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.stopped.load(Ordering::Relaxed)
    }
}

/// A thread at a queue of runs for lanes.
struct Seat<'b, 'a> {
    batch: &'b Batch<'a>,
    queue: &'b Queue,
    thread: usize,
    /// What keeps the runs in its lanes.
    lanes: Vec<InLane<'a>>,
}

/// What keeps a run in a lane: its buffer, emptied into rows when it is full.
struct InLane<'a> {
    number: usize,
    keeper: Keeper<'a>,
    rows: Recording,
}

impl Keep for InLane<'_> {
    fn sample(&mut self, k: u64, drive: &Drive, at: View<'_>) {
        self.keeper.sample(k, drive, at);
        self.keeper.spill_into(&mut self.rows);
    }

    fn events(&mut self) -> &mut Vec<Event> {
        self.keeper.events()
    }
}

impl<'a> Seat<'_, 'a> {
    /// A run that has left its lane, and what it has recorded.
    fn out(&mut self, number: usize, run: Run<'a>) -> Option<Under<'a>> {
        let at = self.lanes.iter().position(|lane| lane.number == number)?;
        let InLane { mut keeper, mut rows, .. } = self.lanes.swap_remove(at);
        keeper.empty_into(&mut rows);
        Some(Under { number, run: Simulation::from_parts(keeper, run), rows })
    }
}

impl<'a> Desk<'a> for Seat<'_, 'a> {
    fn next(&mut self) -> Option<(usize, Run<'a>)> {
        loop {
            let (number, run) = self.batch.take(self.queue)?;
            match run.into_parts() {
                Ok((keeper, run)) => {
                    self.lanes.push(InLane { number, keeper, rows: Recording::default() });
                    return Some((number, run));
                }
                // Of one kind with the others, it is of the shear model.
                Err(run) => self.batch.alone(self.thread, Under { number, run, rows: Recording::default() }),
            }
        }
    }

    fn keeper(&mut self, number: usize) -> &mut dyn Keep {
        let lane = self.lanes.iter_mut().find(|lane| lane.number == number);
        lane.expect("what keeps a run is there as long as the run is in a lane")
    }

    fn ended(&mut self, number: usize, run: Run<'a>, reason: StopReason) {
        if let Some(under) = self.out(number, run) {
            self.batch.give(number, Ok(under.run.outcome(under.rows, reason)));
        }
    }

    fn left(&mut self, number: usize, run: Run<'a>) {
        let Some(under) = self.out(number, run) else { return };
        let share = under.share();
        self.batch.reached().under_way[self.thread] -= share;
        self.batch.rest().runs.push(under);
        self.batch.more.notify_one();
    }

    fn idle(&self) -> usize {
        self.batch.waiting.load(Ordering::Relaxed)
    }

    fn goes_on(&mut self, under_way: f64) -> bool {
        self.batch.goes_on(self.thread, under_way)
    }
}

/// Steps of a single run from one look at the watch to the next.
const BETWEEN_LOOKS: u64 = 4096;
