//! What figures are drawn from: a stored run, histories of its blocks and joints, instants.

use std::collections::HashMap;
use std::ops::Range;

use concio::InputError;
use concio::case::{self, Case, Syntax};
use concio::moment::{JointMotion, Moment};
use concio::store::StoredRun;

use crate::args::Instant;
use crate::failure::Failure;
use crate::format::{seconds, short};

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
    /// Whether every sample was kept, and not only the frames.
    pub sampled: bool,
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
            let what =
                format!("there are {} samples from {} to {}", shown.len(), seconds(window[0]), seconds(window[1]));
            let error = InputError::new(what).key("--from, --to");
            return Err(error.allowed(format!("a part of 0 s to {} with two samples or more", seconds(end))).into());
        }
        Ok(data)
    }

    /// Whether blocks rise and turn in this run.
    pub fn is_planar(&self) -> bool {
        self.run.outcome.layout.turned > 0
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
        Some(History {
            time: recording.time[shown.clone()].to_vec(),
            values: self.column(name)?.skip(shown.start).take(shown.len()).collect(),
        })
    }

    /// All values of a channel, whatever time is shown; none of one that the run did not keep.
    pub fn whole(&self, name: &str) -> Vec<f64> {
        self.column(name).into_iter().flatten().collect()
    }

    /// All values of a channel.
    fn column(&self, name: &str) -> Option<impl Iterator<Item = f64>> {
        self.run.outcome.history(name).map(Vec::into_iter)
    }

    /// The frames in the window.
    ///
    /// # Errors
    /// No frames were kept, which says how to keep them; none lies in the window.
    fn shown_frames(&self) -> Result<Range<usize>, InputError> {
        if self.run.outcome.recording.frame_time.is_empty() {
            return Err(InputError::new("the run kept no frames")
                .help("run the wall file again with `frames = \"1 ms\"` or the like under [output]"));
        }
        let shown = self.shown(&self.run.outcome.recording.frame_time);
        if shown.is_empty() {
            let what = format!("there is no frame from {} to {}", seconds(self.window[0]), seconds(self.window[1]));
            return Err(InputError::new(what).key("--from, --to").allowed(self.frame_span()));
        }
        Ok(shown)
    }

    fn frame_span(&self) -> String {
        let times = &self.run.outcome.recording.frame_time;
        let [first, last] = [times.first(), times.last()].map(|t| crate::format::plain(t.copied().unwrap_or(0.0)));
        format!("{first} s to {last} s, the time of the {} frames", times.len())
    }

    fn moments(&self, frames: Range<usize>) -> impl Iterator<Item = Moment<'a>> {
        let run = self.run;
        frames.filter_map(move |f| Moment::of(run, f))
    }

    /// The frame nearest to an instant; [`Instant::Peak`] is that at which `peak` is largest.
    ///
    /// # Errors
    /// There are no frames; the instant lies outside of them.
    pub fn moment(&self, instant: Instant, peak: fn(&Self, &Moment) -> f64) -> Result<Moment<'a>, InputError> {
        let shown = self.shown_frames()?;
        let times = &self.run.outcome.recording.frame_time;
        let frame = match instant {
            Instant::Peak => {
                let size = |f: &usize| {
                    let value = Moment::of(self.run, *f).map_or(0.0, |m| peak(self, &m));
                    if value.is_finite() { value } else { -1.0 }
                };
                shown.max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0)
            }
            Instant::At(t) => {
                let [first, last] = [times[0], times[times.len() - 1]];
                // An instant up to half an interval beyond the last frame is still nearest to it.
                let slack = if times.len() > 1 { 0.5 * (times[1] - times[0]) } else { 1e-9 };
                if !(t >= first && t <= last + slack) {
                    let error = InputError::new(format!("{} is outside of the run", seconds(t))).key("--at");
                    return Err(error.allowed(self.frame_span()));
                }
                let after = times.partition_point(|f| *f < t).min(times.len() - 1);
                if after > 0 && t - times[after - 1] < times[after] - t { after - 1 } else { after }
            }
        };
        Moment::of(self.run, frame).ok_or_else(|| InputError::new(format!("the run has no frame {frame}")))
    }

    /// Blocks whose histories the wall file asks for, in its order.
    pub fn sampled_blocks(&self) -> Vec<usize> {
        self.sampled("block/", "/displacement", self.run.wall.blocks.iter().map(|b| b.name.as_str()))
    }

    /// Joints whose histories the wall file asks for, in its order.
    pub fn sampled_joints(&self) -> Vec<usize> {
        self.sampled("joint/", "/slip", self.run.joints.iter().map(|j| j.name.as_str()))
    }

    fn sampled<'n>(&self, start: &str, end: &str, names: impl Iterator<Item = &'n str>) -> Vec<usize> {
        let places: HashMap<&str, usize> = names.enumerate().map(|(i, n)| (n, i)).collect();
        let channels = self.run.outcome.layout.channels.iter();
        channels.filter_map(|c| places.get(c.name.strip_prefix(start)?.strip_suffix(end)?).copied()).collect()
    }

    /// What to know of a figure in which these blocks, or joints, are known at the frames alone.
    pub fn coarse(&self, key: &str, names: &[&str]) -> String {
        let layout = &self.run.outcome.layout;
        if names.is_empty() || layout.frame_every <= 1 {
            return String::new();
        }
        let apart = short(layout.interval * layout.frame_every as f64, "s");
        let list = names.iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ");
        format!("drawn from frames {apart} apart; a run with `{key} = [{list}]` under [output] keeps every sample")
    }

    /// Motion of a block relative to the base: at every sample when the wall file names it, else at the frames.
    ///
    /// # Errors
    /// Neither was kept.
    pub fn block_motion(&self, block: usize) -> Result<Motion, InputError> {
        let name = &self.run.wall.blocks[block].name;
        let of = |what: &str| self.channel(&format!("block/{name}/{what}"));
        if let (Some(u), Some(v)) = (of("displacement"), of("velocity")) {
            return Ok(Motion { time: u.time, displacement: u.values, velocity: v.values, sampled: true });
        }
        let frames = self.shown_frames().map_err(|e| or_ask(e, "blocks", name))?;
        let of = |m: Moment| (m.time(), m.block(block));
        let rows: Vec<_> = self.moments(frames).map(of).collect();
        Ok(Motion {
            time: rows.iter().map(|r| r.0).collect(),
            displacement: rows.iter().map(|r| r.1.displacement).collect(),
            velocity: rows.iter().map(|r| r.1.velocity).collect(),
            sampled: false,
        })
    }

    /// Relative motion of the sides of a joint, signed as its channels are: positive opens a head joint; of other
    /// joints that of the lower block against the upper, or of a block against base or beam. In a planar run the sliding along
    /// the joint, of which frames hold no velocity: it is not a number there.
    ///
    /// # Errors
    /// Neither samples nor frames were kept.
    pub fn joint_motion(&self, joint: usize) -> Result<Motion, InputError> {
        let name = &self.run.joints[joint].name;
        let of = |what: &str| self.channel(&format!("joint/{name}/{what}"));
        if let (Some(d), Some(v)) = (of("slip"), of("velocity")) {
            return Ok(Motion { time: d.time, displacement: d.values, velocity: v.values, sampled: true });
        }
        let (time, rows) = self.joint_frames(joint)?;
        Ok(Motion {
            time,
            displacement: rows.iter().map(|m| m.slip).collect(),
            velocity: rows.iter().map(|m| if self.is_planar() { f64::NAN } else { m.velocity }).collect(),
            sampled: false,
        })
    }

    /// Slip [m] and friction force [N] of a joint, so signed that friction against the motion encloses an area above 0. Under
    /// overburden loads the force is that on the lower or left block, and the area is not what the joint dissipates.
    ///
    /// # Errors
    /// Neither samples nor frames were kept.
    pub fn joint_friction(&self, joint: usize) -> Result<[Vec<f64>; 2], InputError> {
        let row = &self.run.joints[joint];
        let of = |what: &str| self.channel(&format!("joint/{}/{what}", row.name));
        let [slip, mut force] = match (of("slip"), of("friction")) {
            (Some(slip), Some(force)) => [slip.values, force.values],
            _ => {
                let (_, rows) = self.joint_frames(joint)?;
                [rows.iter().map(|m| m.slip).collect(), rows.iter().map(|m| m.friction).collect()]
            }
        };
        // The force is that on the left block, the gap grows with the motion of the right one. Slip along a planar joint
        // is told of the same side as its force.
        if row.joint.kind.is_upright() && !self.is_planar() {
            force.iter_mut().for_each(|f| *f = -*f);
        }
        Ok([slip, force])
    }

    fn joint_frames(&self, joint: usize) -> Result<(Vec<f64>, Vec<JointMotion>), InputError> {
        let frames = self.shown_frames().map_err(|e| or_ask(e, "joints", &self.run.joints[joint].name))?;
        Ok(self.moments(frames).map(|m| (m.time(), m.joint(joint))).unzip())
    }

    /// The block of that name.
    ///
    /// # Errors
    /// There is none.
    pub fn block(&self, name: &str) -> Result<usize, InputError> {
        let names = self.run.wall.blocks.iter().map(|b| b.name.as_str());
        find("block", "--blocks", name, names).map_err(|mut error| {
            let known = concio::pattern::out_of_reach(name, self.run.wall.blocks.iter());
            let help: Vec<String> = known.into_iter().chain(error.help.take()).collect();
            error.help = (!help.is_empty()).then(|| help.join("; "));
            error
        })
    }

    /// The joint of that name.
    ///
    /// # Errors
    /// There is none.
    pub fn joint(&self, name: &str) -> Result<usize, InputError> {
        find("joint", "--joints", name, self.run.joints.iter().map(|j| j.name.as_str()))
    }
}

fn or_ask(error: InputError, key: &str, name: &str) -> InputError {
    match error.help.clone() {
        Some(help) => error.help(format!("{help}, or with `{key} = [\"{name}\"]` there")),
        None => error,
    }
}

fn find<'n>(
    what: &str,
    key: &str,
    name: &str,
    names: impl Iterator<Item = &'n str> + Clone,
) -> Result<usize, InputError> {
    if let Some(at) = names.clone().position(|n| n == name) {
        return Ok(at);
    }
    let near = names.clone().map(|n| (strsim::damerau_levenshtein(name, n), n)).min();
    let example = names.clone().next().unwrap_or_default();
    let error = InputError::new(format!("no {what} is named `{name}`")).key(key);
    let error =
        error.allowed(format!("names as `concio check --svg` draws them, for example {example}, parted by commas"));
    Err(match near {
        Some((distance, near)) if distance <= 2 => error.help(format!("did you mean `{near}`?")),
        _ => error,
    })
}
