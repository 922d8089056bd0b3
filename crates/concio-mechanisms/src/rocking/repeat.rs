//! Whether a run is a matter of chance.
//!
//! After many impacts, or near d0, a wall may forget what it was shaken by: a difference that no record can be trusted for decides whether it falls. Such a
//! run has no peak, only a spread. It is found by runs under the record times factors within 1 ± 10⁻³, and with half of the step.

use concio_law::error::Result;

use super::{Response, Rocking, Setting, Shaking};

/// Factors of the record.
pub const FACTORS: [f64; 5] = [1.0, 0.999, 0.9995, 1.0005, 1.001];
/// Spread of the peaks over their mean from which a run is one of chance: fifty times that of the records.
const CHANCE: f64 = 0.1;

/// Peak over the turn at which weights hold nothing any more, up to which peaks that differ are of no matter: the wall is far from falling.
const SLIGHT: f64 = 0.01;

/// What repeated runs say of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// All stood, with peaks that agree.
    Stands,
    /// All fell.
    Falls,
    /// Some fell and some did not, or their peaks differ by a tenth or more: a matter of chance.
    Chance,
}

/// A run and its repetitions.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeated {
    /// The run under the record as it is.
    pub response: Response,
    /// How many of all runs fell, and how many there were.
    pub fell: [usize; 2],
    /// Least and largest peak rotation of the runs that stood, outwards or inwards [rad]; none where all fell.
    pub peaks: Option<[f64; 2]>,
    /// What is to be made of it.
    pub verdict: Verdict,
}

impl Repeated {
    /// What a reader should know before believing the response, in words; nothing of most runs.
    pub fn doubts(&self) -> Vec<String> {
        self.response.doubts().into_iter().chain(self.chance()).collect()
    }

    /// That it is a matter of chance, in words, where it is.
    pub fn chance(&self) -> Option<String> {
        let [fell, runs] = self.fell;
        (self.verdict == Verdict::Chance).then(|| {
            let stand = |whose: &str| {
                let told = |[low, high]: [f64; 2]| format!("; {whose} peaks range from {low:.4} to {high:.4} rad");
                self.peaks.map_or(String::new(), told)
            };
            let found = match fell {
                0 => format!("none of {runs} runs falls{}", stand("their")),
                fell => format!("{fell} of {runs} runs fall{}", stand("the others'")),
            };
            format!(
                "the run is a matter of chance: of runs under 0.999 to 1.001 times the motion and one with half the step {found}. State that, not a peak"
            )
        })
    }
}

impl Rocking {
    /// The response to a motion, and whether it is a matter of chance: as [`Rocking::respond`], five runs under the record times [`FACTORS`] and one
    /// with half of the step.
    ///
    /// # Errors
    /// As [`Rocking::respond`].
    pub fn repeat(&self, shaking: &Shaking, setting: &Setting) -> Result<Repeated> {
        let response = self.respond(shaking, setting)?;
        let bare = Setting { interval: None, ..*setting };
        let halved = Setting { step: Some(0.5 * self.step(shaking, setting)), ..bare };
        let mut others = vec![self.respond(shaking, &halved)?];
        for factor in &FACTORS[1..] {
            others.push(self.respond(&shaking.times(*factor), &bare)?);
        }
        let slight = SLIGHT * self.d0().map_or(0.0, |d0| d0.rotation);
        Ok(judged(response, &others, slight))
    }

    /// The longest step that a run takes [s].
    pub fn step(&self, shaking: &Shaking, setting: &Setting) -> f64 {
        setting.step.unwrap_or_else(|| self.system.step(shaking))
    }
}

/// Of peaks that differ, those up to `slight` [rad] are no matter of chance.
fn judged(response: Response, others: &[Response], slight: f64) -> Repeated {
    let all = || std::iter::once(&response).chain(others);
    let (fell, runs) = (all().filter(|r| r.stop.fell()).count(), others.len() + 1);
    let farthest = |r: &Response| r.inwards.map_or(r.peak.rotation, |inwards| inwards.rotation.max(r.peak.rotation));
    let stood = all().filter(|r| !r.stop.fell()).map(farthest);
    let [low, high] = stood.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], peak| [low.min(peak), high.max(peak)]);
    let peaks = (fell < runs).then_some([low, high]);
    let verdict = match peaks {
        None => Verdict::Falls,
        Some(_) if fell > 0 || (high > slight && high - low > CHANCE * 0.5 * (low + high)) => Verdict::Chance,
        Some(_) => Verdict::Stands,
    };
    Repeated { response, fell: [fell, runs], peaks, verdict }
}
