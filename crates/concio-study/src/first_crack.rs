//! First cracking: the least factor on a motion at which a first joint of a wall cracks, between two runs that were done.
//!
//! From below: a run without a crack whose largest demand over limit is U proposes the factor s/U, or, where two of them
//! show how fast U grows, s U^(−1/p). Around the proposal two runs are made that are closer together than the interval
//! asked for; what they say moves the ends until one lies on either side of the crack. Since a response need not grow with its
//! motion, some lower factors are tried in the end: a crack there is a new upper end, and the search goes on below it.

use std::path::Path;

use concio::case::{Case, JointKind, Signal};
use concio::model::Model;
use concio::quantity::{Length, shown};
use concio::rocking::LiftOff;
use concio::run::prepare_case;
use concio::warning::Warning;
use concio::{InputError, Result};
use serde::Serialize;

use crate::file::analyses::FirstCrackInput;
use crate::file::{Keep, PerJoint};
use crate::limits::{Criterion, Limits, Rule};
use crate::measures::{End, Row};
use crate::motions;
use crate::runner::Runner;
use crate::shaking::{Mode, Shaking, first_mode};

/// Acceleration of the first run [m/s²], 0.01 g: walls stand that.
const START: f64 = 0.01 * concio::G;
/// Acceleration up to which cracks are looked for [m/s²], 20 g: beyond every record.
const MOST: f64 = 20.0 * concio::G;
/// A run without a crack proposes at most so many times its factor.
const LEAP: f64 = 10.0;
/// The same of one that does not tell how near it came.
const UNKNOWN: f64 = 2.0;
/// Sets of runs after which the search for one motion gives up.
const ROUNDS: usize = 60;
/// How far the two runs around a proposal are apart, over what is asked, as logarithms.
const PAIR: f64 = 0.9;
/// A lower factor counts as tried when a run lies so near to it, over the distance from one of them to the next.
const NEAR: f64 = 0.1;
/// Relative distance of the two ends of an answer in closed form.
const CLOSED: f64 = 1e-9;
/// Bounds of the interval.
pub const INTERVAL: [f64; 2] = [1e-5, 1.0];
/// Most lower factors.
pub const MOST_CHECKS: usize = 100;

impl FirstCrackInput {
    /// The question, its numbers in range.
    ///
    /// # Errors
    /// What is out of range or has no meaning, under the key `first-crack.…`.
    pub fn question(&self) -> std::result::Result<Question, InputError> {
        let wrong = |key: &str, what: String, allowed: &str| {
            Err(InputError::new(what).key(format!("first-crack.{key}")).allowed(allowed))
        };
        let limit = self.limit.map(Length::si);
        check_limit(self.criterion, limit, "first-crack")?;
        let [low, high] = INTERVAL;
        if !(low..=high).contains(&self.interval) {
            return wrong("interval", format!("{} is out of range", shown(self.interval)), "1e-5 to 1");
        }
        if self.checks > MOST_CHECKS {
            return wrong("checks", format!("{} is out of range", self.checks), "0 to 100");
        }
        if let Some(i) = self.periods.iter().position(|t| !(t.si() > 0.0 && t.si().is_finite())) {
            return wrong(&format!("periods[{i}]"), format!("{} is out of range", self.periods[i]), "above 0 s");
        }
        let periods = self.periods.iter().map(|t| t.si()).collect();
        let rule = Rule::new(self.criterion, limit);
        Ok(Question { rule, interval: self.interval, checks: self.checks, periods })
    }
}

/// A limit that suits its criterion.
///
/// # Errors
/// A limit that is not above 0, or beside `bond`, under `TABLE.limit`.
pub fn check_limit(criterion: Criterion, limit: Option<f64>, table: &str) -> std::result::Result<(), InputError> {
    let key = format!("{table}.limit");
    match (criterion, limit) {
        (Criterion::Bond, Some(_)) => Err(InputError::new("a bond has its strength for a limit")
            .key(key)
            .allowed("no `limit`, or criterion `opening` or `slip`")),
        (_, Some(limit)) if !(limit > 0.0 && limit.is_finite()) => {
            Err(InputError::new(format!("{} m is out of range", shown(limit))).key(key).allowed("above 0 m"))
        }
        _ => Ok(()),
    }
}

/// What is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// What counts as a crack.
    pub rule: Rule,
    /// Largest relative distance of the two ends.
    pub interval: f64,
    /// Lower factors that are tried.
    pub checks: usize,
    /// Periods of spectral accelerations [s].
    pub periods: Vec<f64>,
}

/// A wall under a motion.
#[derive(Debug, Clone)]
pub struct Subject {
    /// What it is called.
    pub name: String,
    /// The wall and its motion as given: factor 1. Records stand relative to the working directory.
    pub case: Case,
}

/// A run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// Factor on the motion.
    pub scale: f64,
    /// Whether a joint cracked.
    pub cracked: bool,
    /// Largest demand over limit, up to the first crack.
    pub utilisation: f64,
    /// Joint of the largest demand over limit, or that cracked first.
    pub joint: String,
    /// Its kind.
    pub kind: &'static str,
    /// When it cracked [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// What a user should know before believing it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
}

/// What is known of one wall under one motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// What it is called.
    pub name: String,
    /// The motion at factor 1.
    pub shaking: Shaking,
    /// First mode of the intact wall.
    pub mode: Option<Mode>,
    /// All runs, by rising factor.
    pub trials: Vec<Trial>,
    /// Place in `trials` of the run below the crack, and of that with it.
    pub ends: [Option<usize>; 2],
    /// Lower factors at which no joint cracked.
    pub checked: Vec<f64>,
    /// Why there is no answer, where there is none.
    pub cause: Option<String>,
}

impl Answer {
    /// The run without a crack next below the first crack.
    pub fn below(&self) -> Option<&Trial> {
        self.ends[0].map(|k| &self.trials[k])
    }

    /// The run with the first crack.
    pub fn crack(&self) -> Option<&Trial> {
        self.ends[1].map(|k| &self.trials[k])
    }

    /// Factors above the first crack at which no joint cracked: more than none, and the response does not grow with the motion.
    pub fn uncracked_above(&self) -> Vec<f64> {
        let Some(crack) = self.crack() else { return Vec::new() };
        self.trials.iter().filter(|t| !t.cracked && t.scale > crack.scale).map(|t| t.scale).collect()
    }
}

/// What a runner keeps for this analysis.
pub fn keep() -> Keep {
    Keep { joints: vec![PerJoint::Displacement, PerJoint::Opening, PerJoint::Cracked], results: false }
}

/// The walls of a study under its motions, and what is asked.
///
/// # Errors
/// [`concio::Error::Input`] with the line: numbers out of range, no motion, `scales` beside the question.
pub fn of_study(plan: &crate::Plan) -> Result<(Question, Vec<Subject>)> {
    let file = &plan.file;
    let input = file.study.first_crack.clone().unwrap_or_default();
    let question = input.question().map_err(|e| file.document.locate(e))?;
    if !file.study.scales.is_empty() {
        let what = "the scale is what `first-crack` looks for";
        return Err(file.wrong("scales", what, "no `scales` beside `[first-crack]`"));
    }
    if file.study.cracks.is_some() {
        let what = "crack lines are counted over the study's own runs, which `first-crack` takes the place of";
        return Err(file.wrong("cracks", what, "one of `[cracks]` and `[first-crack]`"));
    }
    let subject = |number: usize| {
        let text = |v: serde_json::Value| v.as_str().map_or_else(|| v.to_string(), str::to_string);
        let labels = plan.labels(number).into_iter().zip(&plan.factors);
        let named = labels.map(|(v, f)| if f.key == "motion" { text(v) } else { format!("{} = {}", f.name, text(v)) });
        let name = named.collect::<Vec<_>>().join(", ");
        let name = if name.is_empty() { "the wall's own motion".into() } else { name };
        Ok(Subject { name, case: plan.case(number)? })
    };
    let subjects = (0..plan.points.len()).map(subject).collect::<Result<Vec<_>>>()?;
    for subject in &subjects {
        let objection = objection(&question, subject).map_err(|e| file.of_wall("first-crack", e))?;
        if let Some(objection) = objection {
            return Err(file.document.locate(objection.error()).into());
        }
    }
    Ok((question, subjects))
}

/// Why the question cannot be asked of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Objection {
    /// Its base is at rest.
    AtRest,
    /// It rocks, and no joint opens or slips before.
    Rocks,
    /// It has no bonds.
    Unbonded,
    /// It has no head joints.
    NoHeads,
    /// It has no bed joints.
    NoBeds,
}

impl Objection {
    /// The same in words; the key is `first-crack.criterion` or `motion`.
    pub fn error(self) -> InputError {
        let (what, key, allowed) = match self {
            Objection::AtRest => (
                "there is no motion: the base is at rest, and its motion is what is scaled",
                "motion",
                "a `base` motion, or records",
            ),
            Objection::Rocks => (
                "a rocking wall cracks where it lifts off its hinge: no joint opens or slips before",
                "first-crack.criterion",
                "`bond`",
            ),
            Objection::Unbonded => (
                "no joint of this wall is bonded, and `bond` asks for the strength of bonds",
                "first-crack.criterion",
                "`[joint.bond]` in the wall file, or criterion `opening` or `slip`",
            ),
            Objection::NoHeads => {
                ("this wall has no head joints that could open", "first-crack.criterion", "criterion `bond` or `slip`")
            }
            Objection::NoBeds => (
                "this wall has no bed joints that could slip",
                "first-crack.criterion",
                "criterion `bond` or `opening`",
            ),
        };
        InputError::new(what).key(key).allowed(allowed)
    }
}

/// Why the question cannot be asked of this wall, if it cannot.
///
/// # Errors
/// A wall that cannot be laid, a record that cannot be read.
pub fn objection(question: &Question, subject: &Subject) -> Result<Option<Objection>> {
    if subject.case.motion.base == Signal::None {
        return Ok(Some(Objection::AtRest));
    }
    let model = prepare_case(subject.case.clone(), Path::new(""))?.model;
    if model.rocking().is_some() {
        return Ok((question.rule.criterion != Criterion::Bond).then_some(Objection::Rocks));
    }
    if Limits::of(&model, &question.rule).is_some() {
        return Ok(None);
    }
    Ok(Some(match question.rule.criterion {
        Criterion::Bond => Objection::Unbonded,
        Criterion::Opening => Objection::NoHeads,
        Criterion::Slip => Objection::NoBeds,
    }))
}

/// The answers for all subjects, in their order; none when the runner was stopped. Asked again, the runs are those of the
/// store. The runner has to stop at the first crack by the same rule ([`Runner::until`]).
///
/// # Errors
/// The store cannot be written, a record cannot be read, a wall cannot be laid.
pub fn search(question: &Question, subjects: &[Subject], runner: &mut Runner) -> Result<Option<Vec<Answer>>> {
    let mut seeks = subjects.iter().map(|s| Seek::new(question, s)).collect::<Result<Vec<_>>>()?;
    loop {
        let mut asked: Vec<(usize, f64)> = Vec::new();
        let mut cases: Vec<Case> = Vec::new();
        for (number, seek) in seeks.iter_mut().enumerate() {
            for scale in seek.proposals() {
                let mut case = seek.case.clone();
                motions::strengthen(&mut case.motion, scale);
                asked.push((number, scale));
                cases.push(case);
            }
        }
        if cases.is_empty() {
            return Ok(Some(seeks.into_iter().map(Seek::answer).collect()));
        }
        let Some(rows) = runner.rows(&cases)? else { return Ok(None) };
        for ((number, scale), row) in asked.into_iter().zip(rows) {
            seeks[number].learn(scale, &row);
        }
    }
}

/// The search for one subject.
struct Seek<'a> {
    question: &'a Question,
    name: &'a str,
    case: &'a Case,
    limits: Option<Limits>,
    joints: Vec<(String, &'static str)>,
    shaking: Shaking,
    mode: Option<Mode>,
    /// By rising factor.
    trials: Vec<Trial>,
    /// Whether the answer is one in closed form, which needs no run.
    closed: bool,
    rounds: usize,
    cause: Option<String>,
}

/// The first lift-off of a rocking wall, whose scale is known without a run, as the two ends of a search: demand over limit is linear in the scale up
/// to there.
fn closed_form(lifts: LiftOff, interval: f64, model: &Model) -> Vec<Trial> {
    let trial = |scale: f64, cracked: bool| Trial {
        scale,
        cracked,
        utilisation: scale / lifts.scale,
        joint: concio::graph::name(&model.wall, &model.joints[0]),
        kind: kind_name(model.joints[0].kind),
        time: cracked.then_some(lifts.time),
        warnings: Vec::new(),
    };
    vec![trial(lifts.scale / (1.0 + interval.min(CLOSED)), false), trial(lifts.scale, true)]
}

impl<'a> Seek<'a> {
    fn new(question: &'a Question, subject: &'a Subject) -> Result<Self> {
        let prepared = prepare_case(subject.case.clone(), Path::new(""))?;
        let model = &prepared.model;
        let mode = first_mode(model);
        let shaking = Shaking::of(&model.excitation, &question.periods, mode);
        let limits = Limits::of(model, &question.rule);
        let lifts = model.rocking().map(|own| own.first_lift_off(&model.excitation)).transpose()?;
        let joint = |j| (concio::graph::name(&model.wall, j), kind_name(j.kind));
        Ok(Seek {
            question,
            name: &subject.name,
            case: &subject.case,
            joints: model.joints.iter().map(joint).collect(),
            cause: match (shaking.pga == 0.0, &limits) {
                _ if lifts.is_some() => None,
                (true, _) => Some("the base does not accelerate during the run".into()),
                (_, None) => Some("no joint of the wall can crack by the rule".into()),
                _ => None,
            },
            limits,
            shaking,
            mode,
            trials: lifts.flatten().map_or_else(Vec::new, |lifts| closed_form(lifts, question.interval, model)),
            closed: lifts.is_some(),
            rounds: 0,
        })
    }

    fn learn(&mut self, scale: f64, row: &Row) {
        let Some(limits) = &self.limits else { return };
        if row.end != End::Completed {
            let cause = row.cause.as_deref().unwrap_or("no cause is known");
            self.cause.get_or_insert(format!("the run at scale {} failed: {cause}", shown(scale)));
            return;
        }
        let value = |kind: PerJoint, e: usize| row.joints.get(&kind).and_then(|v| v.get(e).copied().flatten());
        let peak = |kind: PerJoint| move |e: usize| value(kind, e).unwrap_or(0.0);
        let (mut joint, utilisation) = limits.nearest(peak(PerJoint::Displacement), peak(PerJoint::Opening));
        let mut time = (utilisation >= 1.0).then(|| row.number("time_reached")).flatten();
        if self.question.rule.criterion == Criterion::Bond {
            time = row.number("first_crack");
            let first = (0..self.joints.len()).filter_map(|e| Some((e, value(PerJoint::Cracked, e)?)));
            if let Some((e, _)) = first.reduce(|a, b| if b.1 < a.1 { b } else { a }) {
                joint = e;
            }
        }
        let (name, kind) = self.joints[joint].clone();
        if time == Some(0.0) {
            self.cause.get_or_insert(format!("joint {name} cracks under the loads at rest, whatever the motion"));
        }
        // The factor is the search's own, whatever it is near to.
        let warnings = row.warnings.iter().filter(|w| !concio::ground::coverage::is_of_factor(w)).cloned().collect();
        let trial = Trial { scale, cracked: time.is_some(), utilisation, joint: name, kind, time, warnings };
        let place = self.trials.partition_point(|t| t.scale < scale);
        self.trials.insert(place, trial);
    }

    /// Places of the ends: the first run with a crack, and the last without one below it.
    fn ends(&self) -> [Option<usize>; 2] {
        let high = self.trials.iter().position(|t| t.cracked);
        let below = high.unwrap_or(self.trials.len());
        [below.checked_sub(1), high]
    }

    /// The factors to run next; none when the search is over.
    fn proposals(&mut self) -> Vec<f64> {
        if self.cause.is_some() || self.closed {
            return Vec::new();
        }
        let most = MOST / self.shaking.pga;
        let wanted = match self.ends() {
            [None, None] => vec![START / self.shaking.pga],
            [None, Some(high)] => vec![self.trials[high].scale / LEAP],
            [Some(low), high] => {
                let [low_scale, high_scale] = [Some(low), high].map(|k| k.map(|k| self.trials[k].scale));
                let (low_scale, width) = (low_scale.unwrap_or(0.0), 1.0 + self.question.interval);
                match high_scale {
                    Some(high) if high <= low_scale * width => self.checks_left(low_scale),
                    None if low_scale >= most * (1.0 - 1e-6) => self.checks_left(low_scale),
                    _ => self.around(low, high_scale, most),
                }
            }
        };
        let known = |s: &f64| self.trials.iter().any(|t| t.scale == *s);
        let mut wanted: Vec<f64> = wanted.into_iter().map(rounded).filter(|s| !known(s)).collect();
        wanted.sort_by(f64::total_cmp);
        wanted.dedup();
        self.rounds += usize::from(!wanted.is_empty());
        if self.rounds > ROUNDS {
            self.cause = Some(format!("the ends did not come together in {ROUNDS} sets of runs"));
            wanted.clear();
        }
        wanted
    }

    /// Two factors around the likely one, and the middle when there is an upper end.
    fn around(&self, low: usize, high: Option<f64>, most: f64) -> Vec<f64> {
        let scale = self.trials[low].scale;
        let top = high.unwrap_or(most);
        let mut likely = scale * self.growth(low).min(LEAP);
        if high.is_some() && !(likely > scale && likely < top) {
            likely = (scale * top).sqrt();
        }
        let half = (1.0 + self.question.interval).powf(0.5 * PAIR);
        let pair = [likely / half, likely * half];
        if high.is_none() {
            return pair.map(|s| s.clamp(scale, most)).to_vec();
        }
        let middle = (scale * top).sqrt();
        [pair[0], middle, pair[1]].into_iter().filter(|s| *s > scale && *s < top).collect()
    }

    /// By which factor the motion has to grow for the largest demand of a run to reach its limit.
    fn growth(&self, low: usize) -> f64 {
        let trial = &self.trials[low];
        // Nothing is known of how near rigid joints are.
        if trial.utilisation == 0.0 {
            return UNKNOWN;
        }
        // A crack that the envelope sees and the solver does not is a matter of rounding.
        let used = trial.utilisation.clamp(1e-12, 1.0 - 1e-9);
        let before =
            low.checked_sub(1).map(|k| &self.trials[k]).filter(|b| b.utilisation > 0.0 && b.utilisation < used);
        let power = before.map_or(1.0, |b| (used / b.utilisation).ln() / (trial.scale / b.scale).ln());
        used.powf(-1.0 / power.clamp(0.25, 8.0))
    }

    /// Lower factors that have not been tried.
    fn checks_left(&self, low: f64) -> Vec<f64> {
        let near = NEAR * low / (self.question.checks + 1) as f64;
        let tried = |s: f64| self.trials.iter().any(|t| (t.scale - s).abs() <= near);
        self.checks(low).into_iter().filter(|s| !tried(*s)).collect()
    }

    fn checks(&self, low: f64) -> Vec<f64> {
        let n = self.question.checks;
        (1..=n).map(|k| low * k as f64 / (n + 1) as f64).collect()
    }

    fn answer(self) -> Answer {
        let ends = self.ends();
        let low = ends[0].map_or(0.0, |k| self.trials[k].scale);
        let checked = self.trials.iter().filter(|t| !t.cracked && t.scale < low).map(|t| t.scale).collect();
        Answer {
            name: self.name.to_string(),
            shaking: self.shaking,
            mode: self.mode,
            trials: self.trials,
            ends,
            checked,
            cause: self.cause,
        }
    }
}

/// Nine digits: what tables show is what was run.
fn rounded(scale: f64) -> f64 {
    format!("{scale:.8e}").parse().unwrap_or(scale)
}

fn kind_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Bed => "bed",
        JointKind::Head => "head",
        JointKind::Base => "base",
        JointKind::Top => "top",
        JointKind::Connection => "connection",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::MEASURES;

    const LIMIT: f64 = 1e-4;

    fn subject() -> Result<Subject> {
        Ok(Subject { name: "example".into(), case: concio::case::example()?.case })
    }

    /// What a run would leave whose largest demand over limit is `utilisation`.
    fn row(utilisation: f64) -> Row {
        let mut row = Row::failed("", "");
        (row.end, row.cause) = (End::Completed, None);
        row.numbers = vec![Some(1.0); MEASURES.len()];
        row.joints.insert(PerJoint::Displacement, vec![Some(utilisation * LIMIT)]);
        row
    }

    /// The answer for a wall whose demand over limit at a factor is `response`, and how many sets of runs it took.
    fn sought(response: impl Fn(f64) -> f64, interval: f64) -> Result<(Answer, usize)> {
        let rule = Rule::new(Criterion::Slip, Some(LIMIT));
        let question = Question { rule, interval, checks: 3, periods: Vec::new() };
        seek(&question, &subject()?, response)
    }

    fn seek(question: &Question, subject: &Subject, response: impl Fn(f64) -> f64) -> Result<(Answer, usize)> {
        let mut seek = Seek::new(question, subject)?;
        loop {
            let scales = seek.proposals();
            if scales.is_empty() {
                let rounds = seek.rounds;
                return Ok((seek.answer(), rounds));
            }
            for scale in scales {
                seek.learn(scale, &row(response(scale)));
            }
        }
    }

    fn crack(answer: &Answer, interval: f64) -> f64 {
        let (below, crack) = (answer.below().expect("a run below"), answer.crack().expect("a crack"));
        assert!(crack.scale <= below.scale * (1.0 + interval), "{below:?} {crack:?}");
        crack.scale
    }

    #[test]
    fn any_growth_is_enclosed_and_a_power_law_at_once() -> Result<()> {
        for (power, most) in [(1.0, 5), (2.0, 6), (0.5, 7), (5.0, 9)] {
            let (answer, rounds) = sought(|s| (s / 3.0f64).powf(power), 1e-3)?;
            assert!((crack(&answer, 1e-3) / 3.0 - 1.0).abs() < 1.1e-3, "power {power}");
            assert!(rounds <= most, "power {power}: {rounds} sets of runs");
            assert!(answer.checked.len() >= 3 && answer.uncracked_above().is_empty());
        }
        // A demand that leaps: nothing announces it.
        let (answer, rounds) = sought(|s| if s < 0.7 { 1e-3 * s } else { 50.0 }, 1e-3)?;
        assert!((crack(&answer, 1e-3) / 0.7 - 1.0).abs() < 1.1e-3 && rounds < 20, "{rounds} sets of runs");
        Ok(())
    }

    /// However many lower factors are asked for, each has a run of its own.
    #[test]
    fn as_many_lower_factors_are_tried_as_asked_for() -> Result<()> {
        let subject = subject()?;
        for checks in [1, 3, 30, MOST_CHECKS] {
            let rule = Rule::new(Criterion::Slip, Some(LIMIT));
            let question = Question { rule, interval: 0.01, checks, periods: Vec::new() };
            let (answer, _) = seek(&question, &subject, |s| s / 3.0)?;
            let below = answer.below().expect("a run below").scale;
            assert!(answer.checked.len() >= checks, "{checks}: {}", answer.checked.len());
            let places: std::collections::BTreeSet<usize> =
                answer.checked.iter().map(|s| (s / below * (checks + 1) as f64).round() as usize).collect();
            assert!((1..=checks).all(|k| places.contains(&k)), "{checks}: {places:?}");
        }
        Ok(())
    }

    /// An island of cracks below the crossing, wide enough for one of the lower factors to meet it.
    #[test]
    fn cracks_at_lower_factors_are_found_and_followed_down() -> Result<()> {
        let island = |s: f64| if (0.9..1.2).contains(&s) { 1.5 } else { s / 2.0 };
        let (answer, _) = sought(island, 0.01)?;
        assert!((crack(&answer, 0.01) / 0.9 - 1.0).abs() < 0.011, "{:?}", answer.crack());
        assert!(!answer.uncracked_above().is_empty());
        Ok(())
    }

    #[test]
    fn a_wall_that_nothing_cracks_has_no_end_above() -> Result<()> {
        let (answer, _) = sought(|_| 0.0, 0.01)?;
        assert!(answer.crack().is_none() && answer.cause.is_none());
        let below = answer.below().expect("runs").scale * answer.shaking.pga;
        assert!((below / MOST - 1.0).abs() < 1e-6, "{below}");
        // And one that cracks whatever the factor ends with a cause.
        let (answer, rounds) = sought(|_| 2.0, 0.01)?;
        assert!(answer.below().is_none() && answer.cause.is_some() && rounds > ROUNDS);
        Ok(())
    }

    #[test]
    fn a_run_that_fails_ends_its_search_with_its_cause() -> Result<()> {
        let rule = Rule::new(Criterion::Slip, None);
        let question = Question { rule, interval: 0.01, checks: 0, periods: Vec::new() };
        let subject = subject()?;
        let mut seek = Seek::new(&question, &subject)?;
        let scale = seek.proposals()[0];
        seek.learn(scale, &Row::failed("", "the step became too short"));
        assert!(seek.proposals().is_empty());
        assert!(seek.answer().cause.is_some_and(|c| c.contains("too short")));
        Ok(())
    }
}
