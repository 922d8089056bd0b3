//! What figures are drawn from: a stored run, histories of its blocks and joints, instants.

use std::ops::Range;

use concio::InputError;
use concio::case::{self, Beam, Case, JointKind, Syntax};
use concio::store::StoredRun;
use concio::wall::End;

use crate::failure::Failure;

/// A run and the part of it that is shown.
#[derive(Debug)]
pub struct Data<'a> {
    /// The run.
    pub run: &'a StoredRun,
    /// Its resolved input.
    pub case: Case,
    /// Time shown, from and to [s].
    window: [f64; 2],
}

/// Values over time; those of a block or joint that the wall file does not name are known at the frames alone.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// Instants [s].
    pub time: Vec<f64>,
    /// Values in SI.
    pub values: Vec<f64>,
}

/// A displacement or gap, and its rate.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Instants [s].
    pub time: Vec<f64>,
    /// Relative displacement [m].
    pub displacement: Vec<f64>,
    /// Relative velocity [m/s].
    pub velocity: Vec<f64>,
}

/// An instant of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Instant {
    /// That of the frame with the largest displacement of a block relative to the base.
    Peak,
    /// This one [s]; the nearest frame is drawn.
    At(f64),
}

impl<'a> Data<'a> {
    /// A run, of which the part between `window[0]` and `window[1]` [s] is shown.
    ///
    /// # Errors
    /// The input that the run keeps cannot be read; the window holds less than two samples.
    pub fn new(run: &'a StoredRun, window: [Option<f64>; 2]) -> Result<Self, Failure> {
        let case = case::from_str(&run.provenance.case_json, Syntax::Json, None)?.case;
        let end = run.outcome.recording.time.last().copied().unwrap_or(0.0);
        let window = [window[0].unwrap_or(0.0), window[1].unwrap_or(end)];
        let data = Data { run, case, window };
        let shown = data.shown(&run.outcome.recording.time);
        if shown.len() < 2 {
            let what = format!("there are {} samples from {} s to {} s", shown.len(), window[0], window[1]);
            let error = InputError::new(what).key("--from, --to");
            return Err(error.allowed(format!("a part of 0 s to {end} s with two samples or more")).into());
        }
        Ok(data)
    }

    /// Which of rising instants lie in the window.
    fn shown(&self, time: &[f64]) -> Range<usize> {
        // Half a nanosecond takes the rounding of decimals.
        let from = time.partition_point(|t| *t < self.window[0] - 5e-10);
        let to = time.partition_point(|t| *t <= self.window[1] + 5e-10);
        from..to.max(from)
    }

    /// A channel in the window.
    pub fn channel(&self, name: &str) -> Option<History> {
        let recording = &self.run.outcome.recording;
        let shown = self.shown(&recording.time);
        Some(History { time: recording.time[shown.clone()].to_vec(), values: self.column(name)?.skip(shown.start).take(shown.len()).collect() })
    }

    /// All values of a channel.
    fn column(&self, name: &str) -> Option<impl Iterator<Item = f64>> {
        let channels = &self.run.outcome.layout.channels;
        let at = channels.iter().position(|c| c.name == name)?;
        Some(self.run.outcome.recording.values.chunks_exact(channels.len()).map(move |row| row[at]))
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.run.outcome.recording.frame_time.len()
    }

    /// The frames in the window; none kept is an error that says how to keep them.
    ///
    /// # Errors
    /// There are none.
    pub fn shown_frames(&self) -> Result<Range<usize>, InputError> {
        if self.frames() == 0 {
            return Err(InputError::new("the run kept no frames")
                .help("run the wall file again with `frames = \"1 ms\"` or the like under [output]"));
        }
        let shown = self.shown(&self.run.outcome.recording.frame_time);
        if shown.is_empty() {
            let what = format!("there is no frame from {} s to {} s", self.window[0], self.window[1]);
            return Err(InputError::new(what).key("--from, --to").allowed(self.frame_span()));
        }
        Ok(shown)
    }

    fn frame_span(&self) -> String {
        let times = &self.run.outcome.recording.frame_time;
        let [first, last] = [times.first(), times.last()].map(|t| crate::format::plain(t.copied().unwrap_or(0.0)));
        format!("{first} s to {last} s, the time of the {} frames", times.len())
    }

    /// Displacements of all unknowns at a frame [m], relative to the base.
    pub fn displacement(&self, frame: usize) -> &[f64] {
        let unknowns = self.run.outcome.layout.unknowns;
        &self.run.outcome.recording.frame_displacement[frame * unknowns..(frame + 1) * unknowns]
    }

    fn velocity(&self, frame: usize) -> &[f64] {
        let unknowns = self.run.outcome.layout.unknowns;
        &self.run.outcome.recording.frame_velocity[frame * unknowns..(frame + 1) * unknowns]
    }

    /// The frame of an instant.
    ///
    /// # Errors
    /// There are no frames; the instant lies outside of them.
    pub fn frame(&self, instant: Instant) -> Result<usize, InputError> {
        let shown = self.shown_frames()?;
        let times = &self.run.outcome.recording.frame_time;
        match instant {
            Instant::Peak => {
                let blocks = self.run.wall.blocks.len();
                let size = |f: &usize| self.displacement(*f)[..blocks].iter().fold(0.0f64, |m, z| m.max(z.abs()));
                Ok(shown.max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0))
            }
            Instant::At(t) => {
                let [first, last] = [times[0], times[times.len() - 1]];
                // An instant up to half an interval beyond the last frame is still nearest to it.
                let slack = if times.len() > 1 { 0.5 * (times[1] - times[0]) } else { 1e-9 };
                if !(t >= first && t <= last + slack) {
                    return Err(InputError::new(format!("{t} s is outside of the run")).key("--at").allowed(self.frame_span()));
                }
                let after = times.partition_point(|f| *f < t).min(times.len() - 1);
                Ok(if after > 0 && t - times[after - 1] < times[after] - t { after - 1 } else { after })
            }
        }
    }

    /// Time of a frame [s].
    pub fn frame_time(&self, frame: usize) -> f64 {
        self.run.outcome.recording.frame_time[frame]
    }

    /// Displacement of the top beam relative to the base at a frame [m]; none without a beam.
    pub fn beam_displacement(&self, frame: usize) -> Option<f64> {
        self.beam(frame, "beam/displacement", Self::displacement)
    }

    fn beam(&self, frame: usize, channel: &str, of_frame: fn(&Self, usize) -> &[f64]) -> Option<f64> {
        match self.case.load.beam {
            Beam::Free => None,
            Beam::Tied => Some(0.0),
            Beam::Mass(_) => of_frame(self, frame).last().copied(),
            Beam::Driven => self.column(channel)?.nth(frame * self.run.outcome.layout.frame_every),
        }
    }

    /// Motion of a block relative to the base: at every sample when the wall file names it, else at the frames.
    ///
    /// # Errors
    /// Neither was kept.
    pub fn block_motion(&self, block: usize) -> Result<Motion, InputError> {
        let name = &self.run.wall.blocks[block].name;
        let of = |what: &str| self.channel(&format!("block/{name}/{what}"));
        if let (Some(u), Some(v)) = (of("displacement"), of("velocity")) {
            return Ok(Motion { time: u.time, displacement: u.values, velocity: v.values });
        }
        let frames = self.shown_frames().map_err(|e| or_ask(e, "blocks", name))?;
        Ok(Motion {
            time: frames.clone().map(|f| self.frame_time(f)).collect(),
            displacement: frames.clone().map(|f| self.displacement(f)[block]).collect(),
            velocity: frames.map(|f| self.velocity(f)[block]).collect(),
        })
    }

    /// Relative motion of the sides of a joint, signed as its channels are: positive opens a head joint; of other
    /// joints that of the lower block against the upper, or of a block against base or beam.
    ///
    /// # Errors
    /// Neither samples nor frames were kept; the velocity of a driven beam is not known.
    pub fn joint_motion(&self, joint: usize) -> Result<Motion, InputError> {
        let name = &self.run.joints[joint].name;
        let of = |what: &str| self.channel(&format!("joint/{name}/{what}"));
        if let (Some(d), Some(v)) = (of("slip"), of("velocity")) {
            return Ok(Motion { time: d.time, displacement: d.values, velocity: v.values });
        }
        let frames = self.shown_frames().map_err(|e| or_ask(e, "joints", name))?;
        let over = |displaced: bool| -> Option<Vec<f64>> { frames.clone().map(|f| self.between(joint, f, displaced)).collect() };
        let time = frames.clone().map(|f| self.frame_time(f)).collect();
        match (over(true), over(false)) {
            (Some(displacement), Some(velocity)) => Ok(Motion { time, displacement, velocity }),
            _ => Err(InputError::new(format!("the motion of the top beam at joint {name} was not kept"))
                .help("run the wall file again with this version")),
        }
    }

    fn between(&self, joint: usize, frame: usize, displaced: bool) -> Option<f64> {
        let joint = &self.run.joints[joint].joint;
        let (of_frame, channel): (fn(&Self, usize) -> &[f64], _) =
            if displaced { (Self::displacement, "beam/displacement") } else { (Self::velocity, "beam/velocity") };
        let a = of_frame(self, frame)[joint.a];
        let b = match joint.b {
            End::Block(b) => of_frame(self, frame)[b],
            End::Base => 0.0,
            End::Top => self.beam(frame, channel, of_frame)?,
        };
        Some(if is_upright(joint.kind) { b - a } else { a - b })
    }

    /// The block of that name.
    ///
    /// # Errors
    /// There is none.
    pub fn block(&self, name: &str) -> Result<usize, InputError> {
        let names = self.run.wall.blocks.iter().map(|b| b.name.as_str());
        find("block", "--blocks", name, names)
    }

    /// The joint of that name.
    ///
    /// # Errors
    /// There is none.
    pub fn joint(&self, name: &str) -> Result<usize, InputError> {
        find("joint", "--joints", name, self.run.joints.iter().map(|j| j.name.as_str()))
    }

    /// What a figure of blocks or joints is drawn from, to be told: frames may miss what samples show.
    pub fn frame_interval(&self) -> f64 {
        self.run.outcome.layout.interval * self.run.outcome.layout.frame_every as f64
    }

    /// Whether the wall file asked for the histories of this joint.
    pub fn has_joint_channels(&self, joint: usize) -> bool {
        let channel = format!("joint/{}/slip", self.run.joints[joint].name);
        self.run.outcome.layout.channels.iter().any(|c| c.name == channel)
    }
}

/// Whether a joint opens and closes rather than slides.
pub fn is_upright(kind: JointKind) -> bool {
    matches!(kind, JointKind::Head | JointKind::Connection)
}

fn or_ask(error: InputError, key: &str, name: &str) -> InputError {
    match error.help.clone() {
        Some(help) => error.help(format!("{help}, or with `{key} = [\"{name}\"]` there")),
        None => error,
    }
}

fn find<'n>(what: &str, key: &str, name: &str, names: impl Iterator<Item = &'n str> + Clone) -> Result<usize, InputError> {
    if let Some(at) = names.clone().position(|n| n == name) {
        return Ok(at);
    }
    let near = names.clone().map(|n| (strsim::damerau_levenshtein(name, n), n)).min();
    let example = names.clone().next().unwrap_or_default();
    let error = InputError::new(format!("no {what} is named `{name}`")).key(key);
    let error = error.allowed(format!("names as `concio check --svg` draws them, for example {example}, parted by commas"));
    Err(match near {
        Some((distance, near)) if distance <= 2 => error.help(format!("did you mean `{near}`?")),
        _ => error,
    })
}
