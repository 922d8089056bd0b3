//! A rocking wall as a run sees it: its steps, and what of them goes into state and samples.
//!
//! The section has x inwards, as depths are told. So blocks, base and base shear count inwards; the control point, which is the top here, counts
//! outwards as all of a mechanism does.

use concio_law::drift::Lean;
use concio_mechanisms::rocking::{self as mechanics, Kept, Moved, Setting, Spot, Stop, What};
use serde::{Deserialize, Serialize};

use crate::channels::{Channels, RockingRow};
use crate::model::Model;
use crate::outcome::{Collapse, RockingOutcome, TieRow, Totals};
use crate::record::{Counters, Energies, Envelopes, Event, EventKind, Layout, Recording, StopReason};
use crate::rocking::Rocking;
use crate::state;

/// By which part an impact has to exceed all before it to be listed.
const LARGER: f64 = 1.1;

/// A run of a wall that rocks.
#[derive(Debug, Clone)]
pub(crate) struct Run<'m> {
    rocking: &'m Rocking,
    centres: Vec<Spot>,
    motion: mechanics::Run<'m>,
    state: State,
    over: Option<StopReason>,
}

/// Motion and account after a step.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct State {
    t: f64,
    z: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// How the control point has gone.
    pub leans: Vec<Lean>,
    /// Base shear at `totals.base_shear_time` [N].
    marked_shear: f64,
    /// Largest impulse of an impact that is listed [N s].
    hardest: f64,
    /// Farthest turn over that at which the weights hold no longer, either way.
    over_d0: f64,
    /// When each tie first yielded, and each floor lost its seat [s].
    yielded: Vec<f64>,
    lost: Vec<f64>,
    samples: u64,
    energies: Energies,
    envelopes: Envelopes,
    totals: Totals,
    counters: Counters,
}

impl State {
    /// As a run shows it.
    pub fn shown(&self) -> state::State<'_> {
        let State { t, z, v, a, energies, envelopes, totals, counters, .. } = self;
        state::State { t: *t, z, v, a, bonds: &[], energies, envelopes, totals, counters }
    }
}

impl<'m> Run<'m> {
    /// At rest.
    ///
    /// # Errors
    /// Intervals and steps that are no numbers.
    pub fn new(model: &'m Model, rocking: &'m Rocking, interval: f64) -> crate::Result<Self> {
        let excitation = &model.excitation;
        let setting = Setting { interval: Some(interval), ..rocking.setting(excitation) };
        let (n, e) = (model.wall.blocks.len(), model.joints.len());
        let state = State {
            z: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            leans: model.shear.tops.at_rest(),
            yielded: vec![f64::INFINITY; rocking.mechanism.ties.len()],
            lost: vec![f64::INFINITY; rocking.mechanism.floors.len()],
            envelopes: Envelopes::at_rest(n, e, e),
            ..State::default()
        };
        let centres = (0..n).map(|block| rocking.centre(&model.wall, block)).collect();
        Ok(Run {
            rocking,
            centres,
            motion: rocking.compiled.run(&rocking.shaking(excitation), &setting)?,
            state,
            over: None,
        })
    }

    /// Motion and account after the last step.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Why the run is over, where it is.
    pub fn over(&self) -> Option<StopReason> {
        self.over
    }

    /// Where every body is in the section: displacement of its centre along x and y relative to the ground [m] and rotation,
    /// counterclockwise, in rad.
    pub fn places(&self) -> Vec<[f64; 3]> {
        let at = self.motion.turned();
        let place = |spot| {
            let Moved { displacement: [out, up], rotation, .. } = self.rocking.compiled.moved(spot, at.turned);
            [0.0 - out, up, rotation]
        };
        self.centres.iter().map(place).collect()
    }

    /// What became of the ties.
    pub fn ties(&self) -> Vec<TieRow> {
        let row = |((tie, outcome), yielded): ((&mechanics::Tie, mechanics::TieOutcome), &f64)| TieRow {
            from: crate::case::Tie::BASE.into(),
            to: self.block(tie.at.member).into(),
            force: outcome.peak,
            stretch: outcome.set,
            yielded: *yielded,
        };
        self.rocking.mechanism.ties.iter().zip(self.motion.ties()).zip(&self.state.yielded).map(row).collect()
    }

    fn block(&self, member: mechanics::Member) -> &'static str {
        crate::rocking::BODIES[usize::from(member == mechanics::Member::Upper)]
    }

    /// What became of the mechanism.
    pub fn row(&self) -> RockingOutcome {
        let compiled = &self.rocking.compiled;
        let counts = self.motion.counts();
        let d0 = compiled.d0();
        RockingOutcome {
            mechanism: self.rocking.kind.name().into(),
            hinge: self.rocking.hinge,
            multiplier: compiled.multiplier(),
            restitution: compiled.restitution(),
            d0: d0.map_or(f64::INFINITY, |d0| d0.displacement),
            rotation_d0: d0.map_or(f64::INFINITY, |d0| d0.rotation),
            peak_over_d0: if d0.is_some() { self.state.over_d0 } else { f64::NAN },
            first_lift_off: self.motion.first_lift_off().unwrap_or(f64::INFINITY),
            beyond_d0: counts.beyond_d0,
            lift_offs: counts.lift_offs,
            impacts: counts.impacts,
            broken_ties: self.motion.ties().iter().map(|tie| tie.broke.unwrap_or(f64::INFINITY)).collect(),
            lost_seats: self.state.lost.clone(),
        }
    }

    /// One step, and the samples of which all is known after it.
    ///
    /// # Errors
    /// Why the run goes no further without having come to its end.
    pub fn step(
        &mut self,
        model: &Model,
        channels: &Channels,
        layout: &Layout,
        recording: &mut Recording,
    ) -> Result<(), StopReason> {
        let stop = self.motion.advance();
        self.observe(model, stop, &mut recording.events);
        self.sample(model, channels, layout, recording);
        self.motion.clear();
        match stop {
            None => Ok(()),
            Some(Stop::AtRest { .. } | Stop::Moving) => {
                self.over = Some(StopReason::Completed);
                Ok(())
            }
            Some(Stop::Fallen { .. }) => {
                self.over = Some(StopReason::Collapsed);
                Ok(())
            }
            Some(Stop::Airborne { .. }) => Err(StopReason::Airborne),
            Some(Stop::NotFinite { .. }) => Err(StopReason::NotFinite),
            Some(Stop::StepsSpent) => Err(StopReason::StepTooShort),
        }
    }

    /// State, envelopes, totals and events after a step.
    fn observe(&mut self, model: &Model, stop: Option<Stop>, heard: &mut Vec<Event>) {
        let Run { rocking, centres, motion, state, .. } = self;
        let before = state.t;
        state.t = motion.time();
        let at = motion.turned();
        let mut now = [Moved::default(); 2];
        for (block, spot) in centres.iter().enumerate() {
            now[block] = rocking.compiled.moved(spot, at.turned);
            let Moved { displacement: [out, _], velocity, acceleration: [acceleration, _], .. } = now[block];
            [state.z[block], state.v[block], state.a[block]] = [-out, -velocity, -acceleration];
        }
        state.energies = account(&motion.account_now());
        let counts = motion.counts();
        let counters = &mut state.counters;
        (counters.steps, counters.impacts, counters.iterations) = (counts.steps, counts.impacts, counts.evaluations);
        let envelopes = &mut state.envelopes;
        envelopes.joint_dissipation[0] = state.energies.dissipated();
        for event in motion.kept().1 {
            let tell = |kind, value| Event { time: event.time, joint: 0, kind, value };
            counters.events += 1;
            match event.what {
                What::LiftOff if Some(event.time) == motion.first_lift_off() => heard.push(tell(EventKind::Crack, 0.0)),
                What::Impact => {
                    envelopes.joint_impacts[0] += 1.0;
                    envelopes.joint_impulse[0] = envelopes.joint_impulse[0].max(event.impulse);
                    if event.impulse > LARGER * state.hardest {
                        state.hardest = event.impulse;
                        heard.push(tell(EventKind::Impact, event.impulse));
                    }
                }
                What::SeatLost(floor) => state.lost[floor] = event.time,
                What::TieYields(tie) => state.yielded[tie] = state.yielded[tie].min(event.time),
                _ => {}
            }
        }
        let totals = &mut state.totals;
        totals.raise_base_shear(&mut state.marked_shear, at.shear.abs(), state.t, at.displacement);
        let span = [before, state.t];
        model.shear.tops.follow(&mut state.leans, span, model.shear.settles, |_| at.displacement);
        let largest = state.z.iter().fold(at.displacement.abs(), |most, z| most.max(z.abs()));
        totals.peak_relative_displacement = totals.peak_relative_displacement.max(largest);
        totals.peak_input = totals.peak_input.max(state.energies.input().abs());
        totals.peak_work = totals.peak_work.max(state.energies.works());
        totals.peak_residual = totals.peak_residual.max(state.energies.residual().abs());
        state.over_d0 = state.over_d0.max(at.over_d0.unwrap_or(0.0));
        for (e, joint) in model.joints.iter().enumerate() {
            let opening = opening(&now, e) * joint.overlap;
            envelopes.joint_opening[e] = envelopes.joint_opening[e].max(opening);
        }
        for (block, (z, (v, a))) in state.z.iter().zip(state.v.iter().zip(&state.a)).enumerate() {
            envelopes.block_displacement[block] = envelopes.block_displacement[block].max(z.abs());
            envelopes.block_velocity[block] = envelopes.block_velocity[block].max(v.abs());
            envelopes.block_acceleration[block] = envelopes.block_acceleration[block].max(a.abs());
        }
        if let Some(Stop::Fallen { time, .. }) = stop {
            let block = state.z.len() - 1;
            let way = at.displacement.abs();
            state.totals.collapse = Some(Collapse { time, block, way, turned: true, before: None });
            heard.push(Event { time, joint: 0, kind: EventKind::Collapse, value: way });
        }
    }

    /// Appends the samples of the last step, and the frames that are due.
    pub fn sample(&mut self, model: &Model, channels: &Channels, layout: &Layout, recording: &mut Recording) {
        let Run { rocking, centres, motion, state, .. } = self;
        let Some(history) = motion.kept().0 else { return };
        let mut moved = [Moved::default(); 2];
        for (i, &t) in history.time.iter().enumerate() {
            let turned = [history.rotation[i], history.velocity[i], history.acceleration[i]];
            for (to, spot) in moved.iter_mut().zip(centres.iter()) {
                *to = rocking.compiled.moved(spot, turned);
            }
            let moved = &moved[..centres.len()];
            let row = RockingRow {
                control: rocking.compiled.moved(&rocking.mechanism.control, turned),
                ground: [history.ground[i], rocking.inwards() * model.excitation.base.at(t).u],
                shear: 0.0 - history.shear[i],
                energies: &account(&history.energies[i]),
                moved,
            };
            recording.time.push(t);
            channels.sample_rocking(&row, &mut recording.values);
            let due = layout.frame_every > 0 && state.samples.is_multiple_of(layout.frame_every as u64);
            state.samples += 1;
            if !due {
                continue;
            }
            recording.frame_time.push(t);
            recording.frame_displacement.extend(moved.iter().map(|m| 0.0 - m.displacement[0]));
            recording.frame_velocity.extend(moved.iter().map(|m| 0.0 - m.velocity));
            recording.frame_acceleration.extend(moved.iter().map(|m| 0.0 - m.acceleration[0]));
            recording.frame_vertical.extend(moved.iter().map(|m| m.displacement[1]));
            recording.frame_rotation.extend(moved.iter().map(|m| m.rotation));
            let up = model.excitation.vertical.acceleration(t);
            let floors = motion.gone();
            for (e, joint) in model.joints.iter().enumerate() {
                recording.frame_slip.push(0.0);
                recording.frame_friction.push(0.0);
                recording.frame_opening.push(opening(moved, e) * joint.overlap);
                recording.frame_pressure.push(rocking.pressure(e, turned, floors, up));
            }
        }
    }

    /// Samples that were taken at the start.
    pub fn begin(&mut self, model: &Model, channels: &Channels, layout: &Layout, recording: &mut Recording) {
        self.sample(model, channels, layout, recording);
        self.motion.clear();
    }

    /// The state as bytes.
    pub fn keep(&self) -> Vec<u8> {
        // Plain vectors of numbers into memory: nothing that could fail.
        postcard::to_stdvec(&(&self.state, self.motion.keep())).unwrap_or_default()
    }

    /// Goes back to a state that was kept; false where it is not one of this wall, and the run is then to be made anew.
    pub fn take_up(&mut self, bytes: &[u8]) -> bool {
        let Ok((state, motion)) = postcard::from_bytes::<(State, Kept)>(bytes) else { return false };
        let (n, e) = (self.state.z.len(), self.state.envelopes.joint_impacts.len());
        let fits = [&state.z, &state.v, &state.a].iter().all(|x| x.len() == n)
            && state.leans.len() == self.state.leans.len()
            && state.yielded.len() == self.state.yielded.len()
            && state.lost.len() == self.state.lost.len()
            && state.envelopes.fits(n, e, e);
        if !fits || !self.motion.take_up(motion) {
            return false;
        }
        self.state = state;
        true
    }
}

/// How wide hinge `e` gapes on its far side, over its length: as a chord of the turn of what lies on it.
fn opening(moved: &[Moved], e: usize) -> f64 {
    let below = if e == 0 { 0.0 } else { moved[e - 1].rotation };
    2.0 * (0.5 * (moved[e].rotation - below)).sin().abs()
}

/// The account in the words of all models: weights keep energy as springs do, and floors that lose their seat take theirs along.
fn account(of: &mechanics::Energies) -> Energies {
    Energies {
        input_base: of.input,
        initial: of.start,
        kinetic: of.kinetic,
        elastic: of.place + of.elastic,
        friction: of.friction,
        bond: of.floors,
        device: of.ties,
        impact: of.impact,
        ..Energies::default()
    }
}
