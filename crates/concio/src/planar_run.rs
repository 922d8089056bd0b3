//! A planar wall in motion as a run sees it: its bodies' steps, and what of them goes into state and samples.

use concio_law::drift::Lean;
use concio_planar::motion::{self, Forcing, Motion, Seen};
use concio_planar::shape::Place;
use concio_planar::tie;
use serde::{Deserialize, Serialize};

use crate::bond::BondState;
use crate::case::Tie;
use crate::channels::Channels;
use crate::channels::{Row, turned};
use crate::excitation::Excitation;
use crate::failure::is_down;
use crate::ground::signal::GroundMotion;
use crate::model::Model;
use crate::outcome::{Before, Collapse, Deepest, Falling, TieRow, Totals};
use crate::planar::{Planar, Pushes, standing};
use crate::record::{Counters, Energies, Envelopes, Event, EventKind, Layout, Recording, StopReason};
use crate::state;
use crate::wall::End;

/// Depth from which a point counts as crushed [m]: less is rounding of a rigid point that bears all it may.
const CRUSHED: f64 = 1e-9;

/// A run of a planar wall.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    bodies: Bodies,
    state: State,
}

/// Motion and account after a step.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct State {
    t: f64,
    z: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// Force of the top beam on the wall after the last step, its sign turned [N].
    pull: f64,
    bonds: Vec<BondState>,
    /// Base shear at `totals.base_shear_time` [N].
    marked_shear: f64,
    /// How the tops have gone.
    pub leans: Vec<Lean>,
    samples: u64,
    energies: Energies,
    envelopes: Envelopes,
    totals: Totals,
    counters: Counters,
}

impl State {
    fn at_rest(model: &Model) -> Self {
        let (n, e) = (model.unknowns(), model.joints.len());
        State {
            z: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            bonds: vec![BondState::INTACT; model.shear.bonds.len()],
            leans: model.shear.tops.at_rest(),
            envelopes: Envelopes::at_rest(n, e, 0),
            ..State::default()
        }
    }

    fn fits(&self, model: &Model) -> bool {
        let (n, e) = (model.unknowns(), model.joints.len());
        [&self.z, &self.v, &self.a].iter().all(|x| x.len() == n)
            && self.bonds.len() == model.shear.bonds.len()
            && self.leans.len() == model.shear.tops.at_rest().len()
            && self.envelopes.fits(n, e, 0)
    }

    /// As a run shows it.
    pub fn shown(&self) -> state::State<'_> {
        let State { t, z, v, a, bonds, energies, envelopes, totals, counters, .. } = self;
        state::State { t: *t, z, v, a, bonds, energies, envelopes, totals, counters }
    }
}

impl Run {
    /// At rest under its loads.
    pub fn new(model: &Model, planar: &Planar, longest: f64) -> Self {
        let bodies = Bodies::new(model, planar, longest);
        let mut state = State::at_rest(model);
        bodies.begin(&mut state);
        Run { bodies, state }
    }

    /// Motion and account after the last step.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Where every body is: displacement along x and y relative to the base [m] and rotation, counterclockwise, in rad.
    pub fn places(&self) -> Vec<[f64; 3]> {
        let Moved { z, vertical, rotation, .. } = &self.bodies.last.end;
        z.iter().zip(vertical).zip(rotation).map(|((x, y), turn)| [*x, *y, *turn]).collect()
    }

    /// What became of the ties.
    pub fn ties(&self, model: &Model) -> Vec<TieRow> {
        self.bodies.ties(model)
    }

    /// The joint that was crushed deepest in motion, if one was.
    pub fn deepest(&self) -> Option<Deepest> {
        let crushed = self.bodies.crushed.iter().map(|(deepest, _)| *deepest).filter(|deepest| deepest.depth > CRUSHED);
        crushed.filter(|_| !self.bodies.still).max_by(|a, b| a.depth.total_cmp(&b.depth))
    }

    /// How it falls, without inertia, after the last step.
    pub fn falling(&self) -> Option<Falling> {
        self.bodies.falling
    }

    /// Pushes a block at its centre from now on [N, N], besides the forces of the wall file.
    pub fn push(&mut self, block: usize, force: [f64; 2]) {
        self.bodies.pushed[block] = force;
        self.bodies.pushes = true;
    }

    /// Whether it has gone on after a collapse for as long as it was to.
    pub fn collapsed(&self, model: &Model) -> bool {
        let after = model.planar().and_then(|planar| planar.after_collapse);
        let ends = self.state.totals.collapse.zip(after).map(|(collapse, after)| collapse.time + after);
        ends.is_some_and(|ends| self.bodies.told_until() >= ends)
    }

    /// One step, and the samples of which all is known after it.
    ///
    /// # Errors
    /// Why the run goes no further.
    pub fn step(
        &mut self,
        model: &Model,
        channels: &Channels,
        layout: &Layout,
        recording: &mut Recording,
    ) -> Result<(), StopReason> {
        let due = self.sample_time(model, layout);
        let Run { bodies, state } = self;
        let heard = &mut recording.events;
        let from = heard.len();
        let stepped = bodies.step(model, state, due, |event| heard.push(event));
        Event::sort(&mut heard[from..]);
        let ends = stepped.is_ok() && state.t >= model.excitation.duration;
        let until = 1e-9 * layout.interval + if ends { state.t } else { bodies.told_until() };
        while self.sample_time(model, layout) <= until {
            self.sample(model, channels, layout, recording);
        }
        stepped
    }

    /// When the next sample is due [s]; +∞ after the last.
    fn sample_time(&self, model: &Model, layout: &Layout) -> f64 {
        let k = self.state.samples;
        if k >= layout.samples as u64 {
            return f64::INFINITY;
        }
        (k as f64 * layout.interval).min(model.excitation.duration)
    }

    /// Takes the next sample.
    pub fn sample(&mut self, model: &Model, channels: &Channels, layout: &Layout, recording: &mut Recording) {
        let at = self.sample_time(model, layout);
        self.bodies.sample(model, channels, layout, &self.state, (self.state.samples, at), recording);
        self.state.samples += 1;
    }

    /// The state as bytes.
    pub fn keep(&self) -> Vec<u8> {
        // Plain vectors of numbers into memory: nothing that could fail.
        postcard::to_stdvec(&(&self.state, self.bodies.keep())).unwrap_or_default()
    }

    /// Goes back to a state that was kept; false where it is not one of this wall, and the run is then to be made anew.
    pub fn take_up(&mut self, model: &Model, bytes: &[u8]) -> bool {
        let Ok((state, bodies)) = postcard::from_bytes::<(State, Kept)>(bytes) else { return false };
        if !state.fits(model) || !self.bodies.take_up(bodies) {
            return false;
        }
        self.state = state;
        true
    }
}

/// The bodies of a planar wall under way.
#[derive(Debug, Clone)]
struct Bodies {
    motion: Motion,
    step: f64,
    still: bool,
    /// Where the bodies stand under their loads.
    origin: Vec<Place>,
    /// Blocks whose centre is not that of their body, and where it is from there [m].
    aside: Vec<(usize, [f64; 2])>,
    /// How far the sides of each joint are laid apart with nothing between them [m].
    apart: Vec<f64>,
    /// Relative velocity of every joint before the step [m/s].
    before: Vec<f64>,
    /// Joints that can be crushed, and whether that is told of each.
    crushed: Vec<(Deepest, bool)>,
    ties: Vec<Borne>,
    /// How the wall falls, without inertia.
    falling: Option<Falling>,
    /// What pushes each block besides the wall file's forces [N, N], and whether anything pushes at all.
    pushed: Vec<[f64; 2]>,
    pushes: bool,
    /// All that pushes each block in the step [N, N].
    acting: Vec<[f64; 2]>,
    /// The last step, and the one before it where a sample needs it.
    last: Stride,
    past: Past,
    /// What the joints did at a sample.
    seen: Vec<Seen>,
    a: Vec<f64>,
}

/// What is kept of a run beside its state.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Kept {
    motion: motion::Kept,
    origin: Vec<Place>,
    before: Vec<f64>,
    crushed: Vec<(Deepest, bool)>,
    ties: Vec<Borne>,
    falling: Option<Falling>,
    pushed: Vec<[f64; 2]>,
    last: Stride,
}

/// Part of a step that the last one may be longer by: times add up with rounding, and of what that leaves no acceleration can be told.
const SLIVER: f64 = 1e-3;

/// What a tie has borne so far, as in [`TieRow`].
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Borne {
    force: f64,
    stretch: f64,
    yielded: f64,
}

/// Motion over a step. Its forces and accelerations are means over it: they belong to its middle, without inertia to its end.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Stride {
    /// When it began, and from where `start` is.
    began: f64,
    from: f64,
    middle: f64,
    to: f64,
    /// Those of the step's start and end.
    start: Moved,
    end: Moved,
    /// What the joints did when it began.
    before: Vec<Seen>,
    /// Horizontal force of the base on the wall [N].
    shear: f64,
}

/// Displacement and velocity along x, displacement along y and rotation of each block.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Moved {
    z: Vec<f64>,
    v: Vec<f64>,
    vertical: Vec<f64>,
    rotation: Vec<f64>,
}

/// A step that is over, with all that a sample in its second half is made of.
#[derive(Debug, Clone)]
struct Past {
    stride: Stride,
    a: Vec<f64>,
    seen: Vec<Seen>,
    bonds: Vec<BondState>,
    energies: Energies,
    pull: f64,
}

impl Moved {
    fn none(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        Moved { z: zeros(), v: zeros(), vertical: zeros(), rotation: zeros() }
    }

    fn numbers(&mut self) -> [&mut Vec<f64>; 4] {
        let Moved { z, v, vertical, rotation } = self;
        [z, v, vertical, rotation]
    }

    fn read(&mut self, motion: &Motion, origin: &[Place], aside: &[(usize, [f64; 2])]) {
        for (i, (now, then)) in motion.places.iter().zip(origin).enumerate() {
            self.z[i] = now.centre[0] - then.centre[0];
            self.vertical[i] = now.centre[1] - then.centre[1];
            self.rotation[i] = now.angle - then.angle;
            self.v[i] = motion.velocities[i][0];
        }
        for &(i, offset) in aside {
            let [now, then] = [&motion.places[i], &origin[i]].map(|place| place.turned(offset));
            self.z[i] += now[0] - then[0];
            self.vertical[i] += now[1] - then[1];
            self.v[i] -= motion.velocities[i][2] * now[1];
        }
    }
}

impl Stride {
    /// At rest at t = 0.
    fn none(n: usize, seen: &[Seen]) -> Self {
        let [start, end] = [(); 2].map(|()| Moved::none(n));
        Stride { began: 0.0, from: 0.0, middle: 0.0, to: 0.0, start, end, before: seen.to_vec(), shear: 0.0 }
    }

    /// How much of it is over at `t`, 0 … 1.
    fn share(&self, t: f64) -> f64 {
        part_of(self.began, t, self.to)
    }

    /// Motion at `t` in the step, for which its start is given up.
    fn at(&mut self, t: f64) -> &Moved {
        let share = part_of(self.from, t, self.to);
        for (first, last) in self.start.numbers().into_iter().zip(self.end.numbers()) {
            first.iter_mut().zip(last).for_each(|(a, b)| *a += share * (*b - *a));
        }
        self.from = t;
        &self.start
    }
}

impl Bodies {
    fn new(model: &Model, planar: &Planar, longest: f64) -> Self {
        let (motion, _) = standing(planar);
        let n = motion.places.len();
        let crushable = (0..model.joints.len()).filter(|e| planar.system.links[*e].law.crushing.is_finite());
        let never = Stride { to: f64::NEG_INFINITY, ..Stride::none(n, &motion.seen) };
        let mut run = Bodies {
            origin: motion.places.clone(),
            aside: planar.offset.iter().copied().enumerate().filter(|(_, offset)| *offset != [0.0; 2]).collect(),
            apart: planar.system.links.iter().map(|link| link.apart).collect(),
            step: planar.step.min(longest),
            still: planar.still,
            before: vec![0.0; model.joints.len()],
            crushed: crushable
                .map(|joint| (Deepest { joint, depth: motion.crushed(joint), at_once: 0.0 }, false))
                .collect(),
            ties: vec![Borne { force: 0.0, stretch: 0.0, yielded: f64::INFINITY }; planar.system.ties.len()],
            falling: None,
            pushed: vec![[0.0; 2]; model.wall.blocks.len()],
            pushes: !planar.forces.is_empty(),
            acting: vec![[0.0; 2]; model.wall.blocks.len()],
            last: Stride::none(n, &motion.seen),
            past: Past {
                stride: never,
                a: vec![0.0; n],
                seen: motion.seen.clone(),
                bonds: vec![BondState::INTACT; model.shear.bonds.len()],
                energies: Energies::default(),
                pull: 0.0,
            },
            seen: motion.seen.clone(),
            a: vec![0.0; n],
            motion,
        };
        run.last.shear = run.motion.base_shear();
        run.strain(0.0);
        run
    }

    /// What became of the ties.
    fn ties(&self, model: &Model) -> Vec<TieRow> {
        let name = |body: usize| model.wall.blocks[body].name.clone();
        let row = |((tie, _), borne): ((&tie::Tie, &tie::Strain), &Borne)| TieRow {
            from: tie.a.map_or_else(|| Tie::BASE.into(), name),
            to: name(tie.b),
            force: borne.force,
            stretch: borne.stretch,
            yielded: borne.yielded,
        };
        self.motion.ties().zip(&self.ties).map(row).collect()
    }

    /// Peaks of the ties after a step that ended at `time` [s].
    fn strain(&mut self, time: f64) {
        for (row, (tie, strain)) in self.ties.iter_mut().zip(self.motion.ties()) {
            row.force = row.force.max(strain.force(tie));
            row.stretch = strain.yielded();
            if row.stretch > 0.0 {
                row.yielded = row.yielded.min(time);
            }
        }
    }

    /// Energies at the start.
    fn begin(&self, state: &mut State) {
        // What is held bears its part of the loads before anything moves.
        state.pull = self.motion.pull;
        state.energies.elastic = self.motion.account.elastic;
        state.energies.initial = self.motion.account.elastic;
    }

    /// What has to be kept beside the state.
    fn keep(&self) -> Kept {
        let (origin, before, crushed) = (self.origin.clone(), self.before.clone(), self.crushed.clone());
        let (ties, pushed, last) = (self.ties.clone(), self.pushed.clone(), self.last.clone());
        Kept { motion: self.motion.keep(), origin, before, crushed, ties, falling: self.falling, pushed, last }
    }

    /// Goes on from what was kept; false where it is not of this wall.
    fn take_up(&mut self, kept: Kept) -> bool {
        let Kept { motion, origin, before, crushed, ties, falling, pushed, mut last } = kept;
        let n = self.a.len();
        let fits = origin.len() == self.origin.len()
            && before.len() == self.before.len()
            && crushed
                .iter()
                .map(|(deepest, _)| deepest.joint)
                .eq(self.crushed.iter().map(|(deepest, _)| deepest.joint))
            && ties.len() == self.ties.len()
            && pushed.len() == self.pushed.len()
            && last.before.len() == self.before.len()
            && [&mut last.start, &mut last.end].iter_mut().all(|moved| moved.numbers().iter().all(|x| x.len() == n))
            && self.motion.take_up(motion);
        if fits {
            self.last = last;
            (self.origin, self.before, self.crushed) = (origin, before, crushed);
            (self.ties, self.falling) = (ties, falling);
            self.pushes |= pushed.iter().any(|force| *force != [0.0; 2]);
            self.pushed = pushed;
        }
        fits
    }

    /// One step, to the end of the run at the farthest. The next sample is due at `due` [s].
    fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        due: f64,
        mut tell: impl FnMut(Event),
    ) -> Result<(), StopReason> {
        let excitation = &model.excitation;
        let remaining = excitation.duration - state.t;
        let lands = remaining <= self.step * (1.0 + SLIVER);
        let h = if lands { remaining } else { self.step };
        if !self.still && due <= state.t + 0.5 * h {
            self.pass(state);
        }
        (self.last.began, self.last.from) = (state.t, state.t);
        self.last.middle = state.t + if self.still { h } else { 0.5 * h };
        self.last.start.read(&self.motion, &self.origin, &self.aside);
        if due <= state.t + h + 0.5 * h {
            self.last.before.copy_from_slice(&self.motion.seen);
        }
        let drives = model.floating_beam().filter(|_| model.beam == crate::case::Beam::Driven);
        let still = self.still;
        // Without inertia forces are those of the step's end.
        let change = |motion: &GroundMotion, from: f64, to: f64| match still {
            true => (to - from) * motion.acceleration(to),
            false => velocity(motion, to) - velocity(motion, from),
        };
        let forcing = |from: f64, to: f64| Forcing {
            base: [&excitation.base, &excitation.vertical].map(|motion| change(motion, from, to)),
            held: if drives.is_some() { drive(excitation, to) - drive(excitation, from) } else { 0.0 },
        };
        self.motion.time = state.t;
        if self.pushes {
            self.push(model.planar().map_or(&[], |planar| &planar.forces), state.t);
        }
        self.motion.go(h, &forcing);
        state.t = if lands { excitation.duration } else { state.t + h };
        self.last.to = state.t;
        self.last.end.read(&self.motion, &self.origin, &self.aside);
        self.last.shear = self.motion.base_shear();
        let Moved { z, vertical, rotation, .. } = &self.last.end;
        if z.iter().chain(vertical).chain(rotation).any(|x| !x.is_finite()) {
            // What was due before is told with what is known.
            self.last.middle = f64::INFINITY;
            return Err(StopReason::NotFinite);
        }
        self.observe(model, state, h, &mut tell);
        Ok(())
    }

    /// Lets what pushes the blocks at `t` [s] act on their bodies, of which some have their centre elsewhere.
    fn push(&mut self, forces: &[Pushes], t: f64) {
        self.acting.copy_from_slice(&self.pushed);
        for force in forces {
            let given = force.at(t);
            let sum = &mut self.acting[force.block];
            *sum = [0, 1].map(|k| sum[k] + given[k]);
        }
        for (block, &[x, y]) in self.acting.iter().enumerate() {
            self.motion.apply(block, [x, y, 0.0]);
        }
        for &(block, offset) in &self.aside {
            let ([x, y], lever) = (self.acting[block], self.motion.places[block].turned(offset));
            self.motion.apply(block, [x, y, lever[0] * y - lever[1] * x]);
        }
    }

    /// Puts the last step behind, with what a sample in its second half needs of it.
    fn pass(&mut self, state: &State) {
        let past = &mut self.past;
        std::mem::swap(&mut past.stride, &mut self.last);
        let n = past.a.len();
        past.a.copy_from_slice(&state.a[..n]);
        past.seen.copy_from_slice(&self.motion.seen);
        past.bonds.copy_from_slice(&state.bonds);
        (past.energies, past.pull) = (state.energies, state.pull);
    }

    /// Until when forces are known [s].
    fn told_until(&self) -> f64 {
        if self.last.middle.is_finite() { self.last.middle } else { self.last.began }
    }

    /// State, envelopes and totals after a step.
    fn observe(&mut self, model: &Model, state: &mut State, h: f64, tell: &mut impl FnMut(Event)) {
        let n = self.last.end.z.len();
        for i in 0..n {
            state.a[i] = (self.last.end.v[i] - self.last.start.v[i]) / h;
        }
        state.z[..n].copy_from_slice(&self.last.end.z);
        state.v[..n].copy_from_slice(&self.last.end.v);
        let (account, counted) = (&self.motion.account, &self.motion.counters);
        let energies = &mut state.energies;
        (energies.input_base, energies.input_top) = (account.input, account.held);
        (energies.kinetic, energies.elastic) = (self.motion.kinetic(), account.elastic);
        (energies.damping, energies.friction) = (account.damping, account.friction);
        (energies.bond, energies.impact) = (account.bond, account.impact);
        energies.device = account.device;
        let counters = &mut state.counters;
        let parts = counted.steps.saturating_sub(counters.steps);
        (counters.steps, counters.rejected, counters.unsolved) = (counted.steps, counted.halved, counted.unsolved);
        counters.moving = counted.moving;
        (counters.iterations, counters.factorisations) = (counted.iterations, counted.factorisations);
        state.totals.contact_residual = state.totals.contact_residual.max(counted.residual);
        for (taken, seen) in state.envelopes.joint_dissipation.iter_mut().zip(&self.motion.seen) {
            *taken = seen.taken;
        }
        let pull = self.pull(model, state, h);
        let [broken_pull, broken_shear] = self.motion.breaks;
        let shear = [self.last.shear, broken_shear].map(|shear| self.borne(model, state.t, shear));
        // What falls bears nothing that it could bear at rest; a driven beam holds what it pushes.
        let falls = self.motion.falls && model.beam != crate::case::Beam::Driven;
        let shear = if falls { shear[1] } else { shear[0].max(shear[1]) };
        if state.totals.collapse.is_none() {
            let top = model.shear.tops.of_wall(|i| state.z[i]);
            state.totals.raise_base_shear(&mut state.marked_shear, shear, state.t, top);
            model.shear.tops.follow(&mut state.leans, [state.t - h, state.t], model.shear.settles, |i| state.z[i]);
            let totals = &mut state.totals;
            totals.top_force_peak = totals.top_force_peak.max(pull.abs()).max(broken_pull.abs());
            totals.top_force_square += 0.5 * h * (state.pull * state.pull + pull * pull);
            self.raise(model, state, h);
            self.strain(state.t);
        }
        state.pull = pull;
        let totals = &mut state.totals;
        totals.peak_input = totals.peak_input.max(state.energies.input().abs());
        let account = &self.motion.account;
        let [level, upright, held] = [account.input - account.upright, account.upright, account.held].map(f64::abs);
        totals.peak_work = totals.peak_work.max(level + upright + held);
        totals.peak_residual = totals.peak_residual.max(state.energies.residual().abs());
        self.falling = self.fall(model);
        self.cracks(model, state, tell);
        self.crush(state.t, parts, tell);
        if state.totals.collapse.is_none()
            && let Some((collapse, event)) = self.collapse(model, state.t)
        {
            let Counters { steps, unsolved, moving, .. } = state.counters;
            let residual = state.totals.residual_relative(state.energies.initial);
            state.totals.collapse =
                Some(Collapse { before: Some(Before { residual, steps, unsolved, moving }), ..collapse });
            tell(event);
        }
    }

    /// How the wall falls after a step that did not end at rest.
    fn fall(&self, model: &Model) -> Option<Falling> {
        if !self.motion.falls {
            return None;
        }
        let (start, end) = (&self.last.start, &self.last.end);
        let way = |i: usize| (end.z[i] - start.z[i]).hypot(end.vertical[i] - start.vertical[i]);
        let blocks = 0..model.wall.blocks.len();
        let (block, way) = blocks.map(|i| (i, way(i))).max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Falling { since: self.falling.map_or(self.last.began, |falling| falling.since), block, way })
    }

    /// How deep joints are crushed after a step that ended at `time` [s] and was taken in so many parts, and that they are, once.
    fn crush(&mut self, time: f64, parts: u64, tell: &mut impl FnMut(Event)) {
        for (Deepest { joint, depth, at_once }, told) in &mut self.crushed {
            let before = std::mem::replace(depth, self.motion.crushed(*joint));
            *at_once = at_once.max((*depth - before) / parts.max(1) as f64);
            if *depth > CRUSHED && !std::mem::replace(told, true) {
                tell(Event { time, joint: *joint as u32, kind: EventKind::Crush, value: *depth });
            }
        }
    }

    /// What counts as borne of a base shear at the time `t` [N]: without inertia what the base holds against the load. A stone that turns over
    /// from rest in every step pulls at the base the other way, by more than it ever bore.
    fn borne(&self, model: &Model, t: f64, shear: f64) -> f64 {
        let base = model.excitation.base.acceleration(t);
        if self.still && base != 0.0 { shear * base.signum() } else { shear.abs() }
    }

    /// Peaks of blocks and joints, of a wall that has not collapsed.
    fn raise(&mut self, model: &Model, state: &mut State, h: f64) {
        let blocks = model.wall.blocks.len();
        let envelopes = &mut state.envelopes;
        for i in 0..self.last.end.z.len() {
            envelopes.block_displacement[i] = envelopes.block_displacement[i].max(state.z[i].abs());
            envelopes.block_velocity[i] = envelopes.block_velocity[i].max(state.v[i].abs());
            envelopes.block_acceleration[i] = envelopes.block_acceleration[i].max(state.a[i].abs());
        }
        let totals = &mut state.totals;
        let largest = state.z[..blocks].iter().fold(0.0, |most: f64, z| most.max(z.abs()));
        totals.peak_relative_displacement = totals.peak_relative_displacement.max(largest);
        for (e, (seen, joint)) in self.motion.seen.iter().zip(&model.joints).enumerate() {
            let upright = joint.kind.is_upright();
            let opening = (seen.gap[1] - self.apart[e]).max(0.0);
            let (moved, speed) = if upright { (opening, seen.parting) } else { (seen.slide.abs(), seen.speed) };
            envelopes.joint_displacement[e] = envelopes.joint_displacement[e].max(moved);
            envelopes.joint_velocity[e] = envelopes.joint_velocity[e].max(speed.abs());
            envelopes.joint_acceleration[e] = envelopes.joint_acceleration[e].max((speed - self.before[e]).abs() / h);
            self.before[e] = speed;
            envelopes.joint_slip[e] = seen.path;
            envelopes.joint_opening[e] = envelopes.joint_opening[e].max(opening);
            envelopes.joint_closing[e] = envelopes.joint_closing[e].max(-seen.gap[0]);
            let force = if upright { seen.pressure } else { seen.shear };
            let broke = self.motion.crack(e).map_or(0.0, |crack| crack.peak[usize::from(!upright)]);
            envelopes.joint_force[e] = envelopes.joint_force[e].max(force.abs()).max(broke);
            totals.peak_friction_force = totals.peak_friction_force.max(seen.friction.abs());
            if upright {
                totals.minimum_gap = totals.minimum_gap.min(seen.gap[0]);
            } else {
                totals.peak_slip_velocity = totals.peak_slip_velocity.max(seen.speed.abs());
            }
        }
    }

    /// Force of the beam on the wall [N].
    fn pull(&self, model: &Model, state: &State, h: f64) -> f64 {
        match model.floating_beam() {
            None => 0.0,
            Some(beam) if matches!(model.beam, crate::case::Beam::Mass(_)) => {
                let base = &model.excitation.base;
                let ground = velocity(base, state.t) - velocity(base, self.last.began);
                -model.shear.mass[beam] * (state.a[beam] + ground / h)
            }
            Some(_) => self.motion.pull,
        }
    }

    fn cracks(&self, model: &Model, state: &mut State, tell: &mut impl FnMut(Event)) {
        for (bond, held) in model.shear.bonds.iter().zip(&mut state.bonds) {
            let e = bond.joint as usize;
            let Some(crack) = self.motion.crack(e) else { continue };
            let (first, last, reach) = (crack.cracked, crack.broken, crack.reach);
            let stretch = crack.line().iter().map(|[gap, slide]| gap.max(slide.abs())).fold(0.0, f64::max);
            let damage = crack.damage();
            let start = crack.length_at_first();
            // Contact goes along the tangent, the normal to what lies above or to the right turned counterclockwise.
            let lengths = match model.joints[e].kind.is_upright() {
                true => [start, crack.length() - start],
                false => [crack.length() - start, start],
            };
            if !held.cracked.is_finite() && first.is_finite() {
                tell(Event { time: first, joint: bond.joint, kind: EventKind::Crack, value: stretch });
            }
            if !held.broken.is_finite() && last.is_finite() {
                tell(Event { time: last, joint: bond.joint, kind: EventKind::Break, value: stretch });
            }
            let seen = &self.motion.seen[e];
            let upright = model.joints[e].kind.is_upright();
            let force = if upright { -seen.pressure } else { seen.shear.abs() };
            let peak = held.peak.max(force).max(crack.peak[usize::from(!upright)]);
            *held = BondState {
                reach,
                damage,
                crack: Some(lengths),
                spent: seen.broken,
                peak,
                cracked: first,
                broken: last,
            };
        }
    }

    /// The first block that has fallen or turned over, and the same as an event of one of its joints.
    fn collapse(&self, model: &Model, time: f64) -> Option<(Collapse, Event)> {
        let down =
            |i: usize| is_down(self.last.end.rotation[i], self.last.end.vertical[i], model.wall.blocks[i].height());
        let (block, turned) = (0..model.wall.blocks.len()).find_map(|i| Some((i, down(i)?)))?;
        let of_block = |j: &crate::wall::Joint| j.a == block || j.b == End::Block(block);
        let joint = model.joints.iter().position(of_block)? as u32;
        let way = self.last.end.z[block].hypot(self.last.end.vertical[block]);
        let event = Event { time, joint, kind: EventKind::Collapse, value: way };
        Some((Collapse { time, block, way, turned, before: None }, event))
    }

    /// Appends sample `k` at `t` [s], and the frame if one is due. Forces and accelerations between the middles of two steps are those on the
    /// line from one to the other, beyond the last middle those of the last step.
    fn sample(
        &mut self,
        model: &Model,
        channels: &Channels,
        layout: &Layout,
        state: &State,
        (k, t): (u64, f64),
        recording: &mut Recording,
    ) {
        let Bodies { motion, last, past, seen, a, .. } = self;
        let (from, to) = (past.stride.middle, last.middle);
        let share = if past.stride.to == last.began { part_of(from, t, to) } else { 1.0 };
        // What is no number after a step that fails is not asked.
        let mean = |a: f64, b: f64| match share {
            0.0 => a,
            1.0 => b,
            _ => a + share * (b - a),
        };
        let earlier = t <= past.stride.to;
        let (done, stride, bonds, energies) = match earlier {
            true => (&past.seen, &past.stride, &past.bonds, &past.energies),
            false => (&motion.seen, &*last, &state.bonds, &state.energies),
        };
        let moved = stride.share(t);
        for (k, at) in seen.iter_mut().enumerate() {
            let (first, [before, after]) = (done[k].since(&stride.before[k], moved), [&past.seen[k], &motion.seen[k]]);
            *at = Seen {
                pressure: mean(before.pressure, after.pressure),
                shear: mean(before.shear, after.shear),
                friction: mean(before.friction, after.friction),
                ..first
            };
        }
        for (at, (before, after)) in a.iter_mut().zip(past.a.iter().zip(&state.a)) {
            *at = mean(*before, *after);
        }
        let (pull, shear) = (mean(past.pull, state.pull), mean(past.stride.shear, last.shear));
        let Moved { z, v, vertical, rotation } = if earlier { past.stride.at(t) } else { last.at(t) };
        recording.time.push(t);
        let row = Row { t, z, v, a, vertical, rotation, seen, bonds, energies, pull, shear };
        channels.sample_planar(model, row, &mut recording.values);
        if layout.frame_every == 0 || !k.is_multiple_of(layout.frame_every as u64) {
            return;
        }
        recording.frame_time.push(t);
        recording.frame_displacement.extend_from_slice(z);
        recording.frame_velocity.extend_from_slice(v);
        recording.frame_acceleration.extend_from_slice(a);
        recording.frame_vertical.extend_from_slice(vertical);
        recording.frame_rotation.extend_from_slice(rotation);
        recording.frame_damage.extend(bonds.iter().map(|bond| bond.damage));
        for ((seen, joint), apart) in seen.iter().zip(&model.joints).zip(&self.apart) {
            let sign = turned(joint.kind);
            recording.frame_slip.push(sign * seen.slide);
            recording.frame_opening.push((seen.gap[1] - apart).max(0.0));
            recording.frame_pressure.push(seen.pressure);
            recording.frame_friction.push(-sign * seen.shear);
        }
    }
}

/// How much of the way from `from` to `to` lies behind `t`, 0 … 1; all of one of no length.
fn part_of(from: f64, t: f64, to: f64) -> f64 {
    if to > from { ((t - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 }
}

/// Velocity of the base [m/s], that of a base that is set in motion at t = 0 included.
fn velocity(motion: &GroundMotion, t: f64) -> f64 {
    if t == 0.0 { 0.0 } else { motion.at(t).v }
}

/// Displacement of a driven top relative to the base [m].
fn drive(excitation: &Excitation, t: f64) -> f64 {
    excitation.top.at(t).u - excitation.base.at(t).u
}
