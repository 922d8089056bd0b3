//! The time history of mechanisms: the least of each kind through a motion, with both of its signs.

use concio::case::CaseFile;
use concio::warning::Warning;
use concio::{Error, InputError};
use concio_mechanisms::rocking::{
    Capacity, LiftOff, Positive, Repeated, Response, Rocking, Setting, Shaking, Stop, Verdict,
};
use concio_mechanisms::survey::{Found, Survey};
use concio_mechanisms::time_history::TimeHistory;
use concio_mechanisms::wall::Wall;

use crate::args;
use crate::failure::Failure;

mod motion;
pub mod page;
pub mod text;
pub mod values;

use motion::Motion;

/// Samples of a history that are kept, about.
const SAMPLES: f64 = 20_000.0;
/// Part of d0 at life safety (Circolare, C8.7.1.2.1.6).
const LIFE: f64 = 0.4;

/// What no reader of a time history should overlook.
pub const LIMITS: [&str; 5] = [
    "The mechanism with the least α0 sets off first and need not fall first, for small bodies turn fast and large ones slowly: --all follows \
     every hinge level.",
    "The restitution e of impacts is chosen, not known: repeat with other values (--restitution). Larger ones leave more motion.",
    "One record is one sample: other records of the same peak may overturn what this one leaves standing. A fall is not monotonic in the \
     scale either, so that a larger scale has to be run too.",
    "The wall is shaken as one that stands on the ground. The building, its floors and soil are not asked.",
    "Standing beyond d_SLV is not what the code asks for, even where the wall comes back.",
];

/// Mechanisms under a motion.
#[derive(Debug)]
pub struct Shaken<'s> {
    /// What shook them, in words.
    pub motion: String,
    /// Factor on the motion as its file has it.
    pub factor: f64,
    /// What a reader should know of the motion.
    pub doubts: Vec<String>,
    /// What makes it doubtful, as runs tell it.
    pub warnings: Vec<Warning>,
    /// The least of each kind, or every one.
    pub cases: Vec<Case<'s>>,
    /// Whether every hinge level is among them.
    pub all: bool,
}

impl Shaken<'_> {
    /// The name of a mechanism's files, without an ending; where all are among them it bears the level of the hinge.
    pub fn file(&self, case: &Case) -> String {
        let kind = case.found.kind.name();
        if self.all { format!("time-history-{kind}-{:.2}m", case.found.hinge) } else { format!("time-history-{kind}") }
    }

    /// Warnings and doubts, for those who do not see standard error.
    pub fn all_doubts(&self) -> Vec<String> {
        self.warnings.iter().map(ToString::to_string).chain(self.doubts.iter().cloned()).collect()
    }
}

/// A mechanism under a motion.
#[derive(Debug)]
pub struct Case<'s> {
    /// As the survey found it.
    pub found: &'s Found,
    /// Its time histories, or why it has none.
    pub followed: Result<Followed, String>,
}

/// The time histories of a mechanism.
#[derive(Debug)]
pub struct Followed {
    /// What is assumed.
    pub notes: Vec<String>,
    /// Multiplier at which it sets off: ties begin at no force.
    pub sets_off: f64,
    /// e of impacts at the end of a turn outwards.
    pub restitution: f64,
    /// d0: weights and thrusts alone.
    pub last: Option<Capacity>,
    /// The same inwards, negative; none either where the wall does not rock to that side.
    pub last_inwards: Option<f64>,
    /// Displacement of the control point at d_SLV [m]; none where weights alone hold nothing.
    pub life: Option<f64>,
    /// With the record's positive side inwards, and outwards.
    pub signs: [Sign; 2],
}

/// A time history with one sign of the motion.
#[derive(Debug)]
pub struct Sign {
    /// The side to which positive values of the motion point.
    pub positive: Positive,
    /// The run and its repetitions.
    pub repeated: Repeated,
    /// Factor of the motion at which it first lifts off; none where no factor does.
    pub lift_off: Option<LiftOff>,
}

impl Sign {
    /// As files spell it.
    pub fn name(&self) -> &'static str {
        match self.positive {
            Positive::Inwards => "positive-inwards",
            Positive::Outwards => "positive-outwards",
        }
    }

    /// In words.
    pub fn words(&self) -> String {
        self.name().replace('-', " ")
    }

    /// The farthest turn over θ0 of the run, to whichever side; none without a θ0.
    pub fn over_d0(&self) -> Option<f64> {
        let response = &self.repeated.response;
        let inwards = response.inwards.and_then(|peak| peak.over_d0);
        [response.peak.over_d0, inwards].into_iter().flatten().reduce(f64::max)
    }

    /// The farthest displacement of the control point, to whichever side [m].
    pub fn displacement(&self) -> f64 {
        let response = &self.repeated.response;
        response.inwards.map_or(0.0, |peak| peak.displacement.abs()).max(response.peak.displacement)
    }

    /// How it ended, as files spell it and in words.
    pub fn outcome(&self, life: Option<f64>) -> (&'static str, String) {
        let Repeated { response, fell: [fell, runs], verdict, .. } = &self.repeated;
        let beyond_d0 = response.counts.beyond_d0 > 0 || self.over_d0().is_some_and(|over| over > 1.0);
        match (verdict, response.stop) {
            (_, Stop::Airborne { .. } | Stop::NotFinite { .. } | Stop::StepsSpent) => ("no-answer", "no answer".into()),
            (Verdict::Falls, Stop::Fallen { time, .. }) => ("falls", format!("falls, on the ground at {time:.1} s")),
            (Verdict::Falls, _) => ("falls", "falls".into()),
            (Verdict::Chance, _) if *fell > 0 => ("chance", format!("a matter of chance: {fell} of {runs} runs fall")),
            (Verdict::Chance, _) => ("chance", "a matter of chance: peaks differ by a tenth".into()),
            (Verdict::Stands, Stop::Moving) => ("moves", "stands so far, still moves".into()),
            (Verdict::Stands, _) if self.displacement() == 0.0 => ("rests", "rests".into()),
            (Verdict::Stands, _) if beyond_d0 => ("stands", "stands, came back from beyond θ0".into()),
            (Verdict::Stands, _) if life.is_some_and(|life| self.displacement() > life) => {
                ("stands", "stands, beyond d_SLV".into())
            }
            (Verdict::Stands, _) => ("stands", "stands".into()),
        }
    }

    /// Its run.
    pub fn response(&self) -> &Response {
        &self.repeated.response
    }
}

/// Follows the least mechanism of each kind, or `all` of them, through the motion that was asked for; none where none was.
///
/// # Errors
/// A record that cannot be read; a motion at rest; a restitution that would give energy.
pub fn follow<'s>(
    asked: &args::TimeHistory,
    file: &CaseFile,
    wall: &Wall,
    survey: &'s Survey,
    all: bool,
) -> Result<Option<Shaken<'s>>, Failure> {
    let Some(motion) = motion::asked(asked, file)? else { return Ok(None) };
    let mut cases = Vec::new();
    let chosen = if all { survey.found.iter().collect() } else { survey.least_of_kinds() };
    for found in chosen {
        cases.push(Case { found, followed: followed(asked, &motion, wall, found)? });
    }
    let Motion { words, factor, mut doubts, warnings, .. } = motion;
    if file.case.rocking.restitution.is_some() && asked.restitution.is_none() {
        doubts.push(
            "rocking.restitution is of runs of the wall file: here impacts follow their formulas, or --restitution"
                .into(),
        );
    }
    Ok(Some(Shaken { motion: words, factor, doubts, warnings, cases, all }))
}

fn followed(
    asked: &args::TimeHistory,
    motion: &Motion,
    wall: &Wall,
    found: &Found,
) -> Result<Result<Followed, String>, Failure> {
    let made = match TimeHistory::of(wall, found, asked.restitution) {
        Ok(made) => made,
        Err(why) => return Ok(Err(why)),
    };
    let rocking = match Rocking::new(&made.mechanism) {
        Ok(rocking) => rocking,
        Err(error) if error.key.as_deref() == Some("back.restitution") => {
            return Err(of_restitution(*error, found).into());
        }
        // The keys of its errors are those of a struct that nobody sees.
        Err(error) => return Ok(Err(error.what)),
    };
    let shaking = Shaking {
        across: &motion.across,
        positive: Positive::Inwards,
        vertical: &motion.vertical,
        scale: motion.factor,
    };
    let interval = motion.across.sample_interval().unwrap_or(0.005).max(motion.duration / SAMPLES);
    let setting = Setting { duration: Some(motion.duration), interval: Some(interval), ..Setting::default() };
    let sign = |shaking: Shaking| -> Result<Sign, Error> {
        let mut lift_off = rocking.first_lift_off(&shaking, &setting)?;
        if let Some(lift_off) = &mut lift_off {
            lift_off.scale /= motion.factor;
        }
        Ok(Sign { positive: shaking.positive, repeated: rocking.repeat(&shaking, &setting)?, lift_off })
    };
    let signs = [sign(shaking)?, sign(shaking.reversed())?];
    let pushover = &found.pushover;
    let life = pushover.drop.map_or(LIFE * pushover.last, |drop| drop.min(LIFE * pushover.last)) / pushover.part;
    Ok(Ok(Followed {
        notes: made.notes,
        sets_off: rocking.multiplier(),
        restitution: rocking.restitution(),
        last: rocking.d0(),
        last_inwards: rocking.d0_inwards().map(|last| last.displacement),
        life: (life > 0.0).then_some(life),
        signs,
    }))
}

fn of_restitution(error: InputError, found: &Found) -> InputError {
    let error = error.key("--restitution");
    error.help(format!("that is the bound of: {}; leave the option out for (OP11)", found.kind.what()))
}
