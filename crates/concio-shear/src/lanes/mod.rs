//! Runs side by side in the lanes of vector instructions.
//!
//! Every lane is at its own time, step, stage and iteration; each turn of `Gang::drive` makes one iteration in all
//! of them at once. What depends on a lane alone (size of the step, what comes next) is decided by `lane.rs` with plain
//! numbers. No number of a lane depends on what runs beside it.

mod account;
mod lane;
mod meet;
mod rows;
mod topology;
mod work;

use pulp::{Simd, WithSimd};

use crate::integrate::tableau::{STAGES, tableau};
use crate::lanes::account::{Account, Balance, Peaks, Powers, Settle};
use crate::lanes::lane::{Lane, Next};
use crate::lanes::meet::Meet;
pub use crate::lanes::rows::WIDTH;
pub use crate::lanes::topology::Kind;
use crate::lanes::topology::Topology;
use crate::lanes::work::{ACCEPTED, Advance, CONVERGED, GIVEN_UP, GOING, Iterate, PENDING, Turn, Work};
use crate::run::{Keep, Run};
use concio_law::account::StopReason;

/// Up to eight runs of one kind.
pub struct Gang<'m> {
    work: Work,
    account: Account,
    powers: Powers,
    peaks: Peaks,
    lanes: [Option<Lane<'m>>; WIDTH],
    /// Lanes that are used.
    width: usize,
    /// Turns so far.
    turns: u64,
    /// Whether the desk has no more runs.
    last: bool,
}

/// Where a gang gets its runs and leaves what became of them.
pub trait Desk<'m> {
    /// The next run and its number; none when there are no more.
    fn next(&mut self) -> Option<(usize, Run<'m>)>;
    /// Who keeps what the run of that number tells.
    fn keeper(&mut self, number: usize) -> &mut dyn Keep;
    /// A run has ended.
    fn ended(&mut self, number: usize, run: Run<'m>, reason: StopReason);
    /// A run under way has left its lane: it goes on alone, to the same bits.
    fn left(&mut self, number: usize, run: Run<'m>);
    /// How many others could take runs that leave their lanes.
    fn idle(&self) -> usize;
    /// Called from time to time with the sum of the shares that the runs under way have reached; false to stop them
    /// where they are.
    fn goes_on(&mut self, under_way: f64) -> bool;
}

/// Lanes from which on they are faster than as many single runs.
pub const FEWEST: usize = 4;
/// Turns from one [`Desk::goes_on`] to the next.
const BETWEEN_LOOKS: u64 = 4096;

impl<'m> Gang<'m> {
    /// `width` lanes for runs of the kind of `run`.
    pub fn new(run: &Run<'m>, width: usize) -> Self {
        let topology = Topology::new(run.system);
        let (n, e) = (topology.unknowns as usize, topology.joints.len());
        Gang {
            work: Work::new(topology, tableau(run.control.scheme)),
            account: Account::new(n, e),
            powers: Powers::default(),
            peaks: Peaks::default(),
            lanes: [const { None }; WIDTH],
            width: width.min(WIDTH),
            turns: 0,
            last: false,
        }
    }

    /// Works from `first` on until the desk has no more runs, and then on fewer than [`FEWEST`] lanes no longer, with the
    /// widest instructions of the machine. They are chosen here and not by pulp's `Arch`, because rows have eight lanes on all.
    pub fn start(mut self, first: (usize, Run<'m>), desk: &mut dyn Desk<'m>) {
        self.take(0, first);
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(simd) = pulp::x86::V4::try_new() {
                return self.drive(simd, desk);
            }
            if let Some(simd) = pulp::x86::V3::try_new() {
                return self.drive(pulp::x86::V3_512b(simd), desk);
            }
        }
        self.drive(pulp::Scalar512b, desk);
    }

    fn drive<S: Simd>(mut self, simd: S, desk: &mut dyn Desk<'m>) {
        for lane in 0..self.width {
            if self.lanes[lane].is_none() {
                self.take_next(lane, desk);
            }
        }
        while self.lanes.iter().any(Option::is_some) {
            if self.turns.is_multiple_of(BETWEEN_LOOKS) {
                let under_way = self.lanes.iter().flatten().map(Lane::share).sum();
                if !desk.goes_on(under_way) {
                    self.stop_all(simd, desk);
                    break;
                }
            }
            self.turn(simd, desk);
        }
    }

    fn turn<S: Simd>(&mut self, simd: S, desk: &mut dyn Desk<'m>) {
        self.turns += 1;
        vectorize(simd, Iterate(&mut self.work));
        let mut ended = [false; STAGES];
        let mut marks = Marks::default();
        let (mut going_flipped, mut overwrites) = (false, false);
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            let Some(lane) = lane else { continue };
            match lane.judge(&self.work, i) {
                Next::Iterate { flipped } => {
                    marks.going[i] = 1.0;
                    going_flipped |= flipped;
                }
                Next::Stage => {
                    marks.converged[i] = 1.0;
                    ended[lane.stage] = true;
                    overwrites |= lane.stage == 1 && lane.pending;
                }
                Next::Shorter => {}
            }
        }
        if overwrites {
            self.settle(simd);
        }
        self.work.lane.set_row(CONVERGED, marks.converged);
        self.work.lane.set_row(GOING, marks.going);
        vectorize(simd, Advance { work: &mut self.work, ended, going_flipped });
        if ended[self.work.tableau.stages - 1] {
            vectorize(simd, Balance { work: &self.work, powers: &mut self.powers });
        }
        if !self.work.misses.is_empty() {
            vectorize(simd, Meet(&mut self.work));
        }
        self.decide(simd, &marks, desk);
    }

    /// What comes next in the lanes that have ended a stage or given up a step.
    fn decide<S: Simd>(&mut self, simd: S, marks: &Marks, desk: &mut dyn Desk<'m>) {
        let (mut accepted, mut given_up) = ([0.0; WIDTH], [0.0; WIDTH]);
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            let Some(lane) = lane else { continue };
            if marks.going[i] > 0.0 {
                continue;
            }
            let converged = marks.converged[i] > 0.0;
            if converged && lane.stage + 1 < self.work.tableau.stages {
                lane.begin_stage(&mut self.work, i, lane.stage + 1);
            } else if converged && lane.verdict(&self.work, &self.powers, i) {
                accepted[i] = 1.0;
            } else {
                given_up[i] = 1.0;
            }
        }
        if accepted == [0.0; WIDTH] && given_up == [0.0; WIDTH] {
            return;
        }
        self.work.lane.set_row(ACCEPTED, accepted);
        self.work.lane.set_row(GIVEN_UP, given_up);
        vectorize(simd, Turn(&mut self.work));
        for i in 0..WIDTH {
            if accepted[i] > 0.0 {
                self.after_step(simd, i, desk);
            } else if given_up[i] > 0.0 {
                self.after_failure(simd, i, desk);
            }
        }
    }

    /// A step was accepted: samples, breaks of the motion, the end.
    fn after_step<S: Simd>(&mut self, simd: S, i: usize, desk: &mut dyn Desk<'m>) {
        let Some(lane) = &mut self.lanes[i] else { return };
        lane.accept(&mut self.work, &mut self.account, i);
        lane.sample_inside(&self.work, i, desk.keeper(lane.number));
        let (restarts, ends) = lane.arrives();
        if restarts.is_some() || ends {
            self.settle(simd);
        }
        let few = self.last && self.lanes.iter().flatten().count() < FEWEST * (1 + desk.idle());
        let Some(lane) = &mut self.lanes[i] else { return };
        if let Some(jump) = restarts {
            lane.restart(&mut self.work, &mut self.account, i, jump, desk.keeper(lane.number));
        }
        lane.sample(&self.work, i, desk.keeper(lane.number));
        if ends {
            self.finish(i, None, desk);
        } else if few {
            self.leave(simd, i, desk);
        } else {
            lane.begin_step(&mut self.work, i);
        }
    }

    /// Gives up lane `i`, between two steps.
    fn leave<S: Simd>(&mut self, simd: S, i: usize, desk: &mut dyn Desk<'m>) {
        self.settle(simd);
        if let Some(lane) = self.lanes[i].take() {
            desk.left(lane.number, lane.leave(&self.work, &self.account, i));
        }
    }

    /// A step was given up: a shorter one, or the end of the run.
    fn after_failure<S: Simd>(&mut self, simd: S, i: usize, desk: &mut dyn Desk<'m>) {
        let Some(lane) = &mut self.lanes[i] else { return };
        match lane.stopped {
            Some(reason) => {
                self.settle(simd);
                self.finish(i, Some(reason), desk);
            }
            None => lane.begin_attempt(&mut self.work, i),
        }
    }

    /// Makes up the accounts that wait.
    fn settle<S: Simd>(&mut self, simd: S) {
        let mut waits = [0.0; WIDTH];
        for (wait, lane) in waits.iter_mut().zip(&self.lanes) {
            *wait = lane.as_ref().map_or(0.0, |lane| if lane.pending { 1.0 } else { 0.0 });
        }
        if waits == [0.0; WIDTH] {
            return;
        }
        self.work.lane.set_row(PENDING, waits);
        let (work, account, peaks) = (&self.work, &mut self.account, &mut self.peaks);
        vectorize(simd, Settle { work, account, peaks });
        for (i, lane) in self.lanes.iter_mut().enumerate() {
            if let Some(lane) = lane
                && lane.pending
            {
                lane.enter_account(&self.peaks, i);
            }
        }
    }

    fn finish(&mut self, i: usize, reason: Option<StopReason>, desk: &mut dyn Desk<'m>) {
        if let Some(lane) = self.lanes[i].take() {
            let reason = reason.unwrap_or(StopReason::Completed);
            desk.ended(lane.number, lane.end(&self.work, &self.account, i), reason);
        }
        self.take_next(i, desk);
    }

    fn stop_all<S: Simd>(&mut self, simd: S, desk: &mut dyn Desk<'m>) {
        self.settle(simd);
        for i in 0..WIDTH {
            if let Some(lane) = self.lanes[i].take() {
                desk.ended(lane.number, lane.end(&self.work, &self.account, i), StopReason::Interrupted);
            }
        }
    }

    fn take_next(&mut self, i: usize, desk: &mut dyn Desk<'m>) {
        match desk.next() {
            Some(run) => self.take(i, run),
            None => self.last = true,
        }
    }

    fn take(&mut self, i: usize, (number, run): (usize, Run<'m>)) {
        let mut lane = Lane::new(number, run);
        lane.load(&mut self.work, &mut self.account, i);
        lane.begin_step(&mut self.work, i);
        self.lanes[i] = Some(lane);
    }
}

/// An operation with rows of `simd`, whatever type the instructions are switched on by: two AVX2 vectors in a row are
/// switched on by pulp as one.
struct Wide<S, Op> {
    simd: S,
    op: Op,
}

impl<S: Simd, Op: WithSimd> WithSimd for Wide<S, Op> {
    type Output = Op::Output;

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) -> Self::Output {
        self.op.with_simd(self.simd)
    }
}

fn vectorize<S: Simd, Op: WithSimd>(simd: S, op: Op) -> Op::Output {
    simd.vectorize(Wide { simd, op })
}

/// One for the lanes of which it holds.
#[derive(Default)]
struct Marks {
    converged: [f64; WIDTH],
    going: [f64; WIDTH],
}

#[cfg(test)]
mod tests {
    use concio_law::account::{Counters, Energies, Envelopes, Event, Totals};
    use concio_law::drift::Lean;
    use concio_law::friction::Stribeck;
    use concio_law::motion::Drive;

    use super::*;
    use crate::run::{Control, Schedule};
    use crate::samples::{Base, Link, Side, lumped};
    use crate::state::{State, View};
    use crate::system::{Scheme, System};

    /// Motion and friction at the samples of a run.
    #[derive(Default, PartialEq)]
    struct Rows {
        values: Vec<f64>,
        events: Vec<Event>,
    }

    impl Keep for Rows {
        fn sample(&mut self, _: u64, _: &Drive, at: View<'_>) {
            self.values.extend(at.z.iter().chain(at.v).chain(at.a).chain(at.mu));
        }
        fn events(&mut self) -> &mut Vec<Event> {
            &mut self.events
        }
    }

    /// What a run leaves.
    #[derive(PartialEq)]
    struct Ended {
        energies: Energies,
        envelopes: Envelopes,
        totals: Totals,
        counters: Counters,
        leans: Vec<Lean>,
    }

    struct Pile<'m> {
        runs: Vec<Run<'m>>,
        rows: Vec<Rows>,
        ends: Vec<Option<State>>,
    }

    impl<'m> Desk<'m> for Pile<'m> {
        fn next(&mut self) -> Option<(usize, Run<'m>)> {
            self.runs.pop().map(|run| (self.runs.len(), run))
        }
        fn keeper(&mut self, number: usize) -> &mut dyn Keep {
            &mut self.rows[number]
        }
        fn ended(&mut self, number: usize, run: Run<'m>, reason: StopReason) {
            assert_eq!(reason, StopReason::Completed);
            self.ends[number] = Some(run.state);
        }
        fn left(&mut self, number: usize, mut run: Run<'m>) {
            while run.state.t < run.excitation.duration() {
                run.step(&mut self.rows[number]).expect("a step");
            }
            self.ended(number, run, StopReason::Completed);
        }
        fn idle(&self) -> usize {
            0
        }
        fn goes_on(&mut self, _: f64) -> bool {
            true
        }
    }

    /// Four masses that rub, touch and hang together, shaken harder from one to the next.
    fn walls() -> Vec<(System, Base)> {
        let law = Stribeck { static_: 0.5, dynamic: 0.3, slip_velocity: 1e-3, beta: 100.0, alpha: 0.1 };
        let wall = |k: usize| {
            let links = [
                Link::spring(0, Side::Base, 4e4, 30.0),
                Link::friction(0, Side::Base, law, 60.0),
                Link::unilateral(0, Side::Block(1), 1e6),
                Link::friction(1, Side::Block(2), law, 25.0),
                Link::spring(1, Side::Base, 2e4, 10.0),
                Link::unilateral(3, Side::Block(2), 2e6),
                Link::spring(3, Side::Base, 3e4, 20.0),
            ];
            let base = Base::shaking(4.0 + k as f64, 7.0, 0.2);
            (lumped(&[10.0, 7.0, 5.0, 8.0], &links, 0.2), base)
        };
        (0..11).map(wall).collect()
    }

    /// Histories, peaks and account of all.
    fn by<S: Simd>(simd: S, walls: &[(System, Base)]) -> Vec<(Rows, Ended)> {
        let control = Control { scheme: Scheme::TrBdf2, tolerance: 1e-4, floor: 1e-15, longest_step: f64::INFINITY };
        let schedule = Schedule { interval: 1e-3, samples: 201, frame_every: 10 };
        let mut rows: Vec<Rows> = walls.iter().map(|_| Rows::default()).collect();
        let runs: Vec<Run> = walls
            .iter()
            .zip(&mut rows)
            .map(|((system, base), rows)| Run::new(system, base, control, schedule, rows))
            .collect();
        let gang = Gang::new(&runs[0], WIDTH);
        let mut pile = Pile { runs, rows, ends: walls.iter().map(|_| None).collect() };
        gang.drive(simd, &mut pile);
        let ended = pile.ends.into_iter().map(|state| {
            let State { energies, envelopes, totals, counters, leans, .. } = state.expect("every run ends");
            Ended { energies, envelopes, totals, counters, leans }
        });
        pile.rows.into_iter().zip(ended).collect()
    }

    /// Wide, halved and single instructions give the same bits.
    #[test]
    fn all_instructions_give_the_same_bits() {
        let walls = walls();
        let plain = by(pulp::Scalar512b, &walls);
        assert!(plain.len() == 11 && plain.iter().all(|(rows, _)| rows.values.len() == 201 * (6 + 6 + 6 + 2)));
        assert!(plain.iter().all(|(_, end)| end.totals.peak_slip_velocity > 1e-3 && end.totals.minimum_gap < -1e-6));
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(simd) = pulp::x86::V3::try_new() {
                assert!(by(pulp::x86::V3_512b(simd), &walls) == plain);
            }
            if let Some(simd) = pulp::x86::V4::try_new() {
                assert!(by(simd, &walls) == plain);
            }
        }
    }
}
