//! Measures designs: builds their walls, has them run, takes the runs together to objectives.

use concio::Result;
use concio::case::Case;
use rayon::prelude::*;

use crate::file::analyses::{FirstCrackInput, Target};
use crate::first_crack::{self, Answer, Subject};
use crate::interfaces::{Question, with};
use crate::limits::{Criterion, Rule};
use crate::measures::{End, Row};
use crate::plan::Plan;
use crate::runner::Runner;
use crate::search::Design;

/// Values of a design by factor on the motions, scene and objective.
pub type Copies = Vec<Vec<Vec<f64>>>;

/// A wall under one motion.
#[derive(Debug, Clone, Copy)]
pub struct Trial<'d> {
    /// The design; none for the wall as it is.
    pub design: Option<&'d Design>,
    /// The scene, by its place in the question.
    pub scene: usize,
    /// Factor on the motion besides that of the scene.
    pub factor: f64,
}

/// Where designs are tried.
pub struct Bench<'b, 'r> {
    plan: &'b Plan,
    question: &'b Question,
    runner: &'b mut Runner<'r>,
    /// Runs asked for so far, those that the store had included.
    pub runs: usize,
}

impl<'b, 'r> Bench<'b, 'r> {
    /// A bench for one question.
    pub fn new(plan: &'b Plan, question: &'b Question, runner: &'b mut Runner<'r>) -> Self {
        Bench { plan, question, runner, runs: 0 }
    }

    /// The question.
    pub fn question(&self) -> &Question {
        self.question
    }

    /// Per trial, the value of each objective in SI; not a number where a run failed. None where the user stopped.
    ///
    /// # Errors
    /// The store, or a design that makes no wall.
    pub fn values(&mut self, trials: &[Trial]) -> Result<Option<Vec<Vec<f64>>>> {
        let targets: Vec<Target> = self.question.objectives.iter().map(|o| o.target).collect();
        let mut values = vec![vec![f64::NAN; targets.len()]; trials.len()];
        if targets.iter().any(|t| *t != Target::FirstCracking) {
            let cases = self.cases(trials, &vec![1.0; trials.len()])?;
            let Some(rows) = self.runner.rows(&cases)? else { return Ok(None) };
            for (values, row) in values.iter_mut().zip(&rows) {
                for (value, target) in values.iter_mut().zip(&targets) {
                    *value = measured(row, |row| target.of(row)).unwrap_or(f64::NAN);
                }
            }
        }
        if let Some(place) = targets.iter().position(|t| *t == Target::FirstCracking) {
            let Some(scales) = self.first_cracks(trials)? else { return Ok(None) };
            values.iter_mut().zip(scales).for_each(|(values, scale)| values[place] = scale);
        }
        Ok(Some(values))
    }

    /// The objectives of some designs, each over the scenes `scenes` and the factors `factors` on their motions: first by
    /// design, then by factor, then by objective. None where the user stopped.
    ///
    /// # Errors
    /// As [`Bench::values`].
    pub fn objectives(
        &mut self,
        designs: &[Option<&Design>],
        scenes: &[usize],
        factors: &[f64],
    ) -> Result<Option<Vec<Vec<Vec<f64>>>>> {
        let Some(values) = self.by_scene(designs, scenes, factors)? else { return Ok(None) };
        let of = |scenes: &Vec<Vec<f64>>| -> Vec<f64> {
            let one = |k: usize| scenes.iter().map(|v| v[k]).collect::<Vec<f64>>();
            self.question.objectives.iter().enumerate().map(|(k, o)| o.over(&one(k))).collect()
        };
        Ok(Some(values.iter().map(|factors| factors.iter().map(of).collect()).collect()))
    }

    /// The same scene by scene: by design, factor, scene, objective.
    ///
    /// # Errors
    /// As [`Bench::values`].
    pub fn by_scene(
        &mut self,
        designs: &[Option<&Design>],
        scenes: &[usize],
        factors: &[f64],
    ) -> Result<Option<Vec<Copies>>> {
        let mut trials = Vec::new();
        for design in designs {
            for factor in factors {
                trials.extend(scenes.iter().map(|&scene| Trial { design: *design, scene, factor: *factor }));
            }
        }
        let Some(values) = self.values(&trials)? else { return Ok(None) };
        let mut values = values.into_iter();
        let mut take = || values.by_ref().take(scenes.len()).collect::<Vec<_>>();
        Ok(Some(designs.iter().map(|_| factors.iter().map(|_| take()).collect()).collect()))
    }

    /// The wall of a trial.
    fn case(&self, trial: &Trial, scale: f64) -> Result<Case> {
        let scene = &self.question.scenes[trial.scene];
        let mut changes = scene.changes.clone();
        if let Some(design) = trial.design {
            let device = &self.question.devices[design.device];
            let change = device.change(&design.shares, &self.question.names(design));
            changes.push(("joint.change".into(), with(scene, change)));
        }
        self.plan.changed(&changes, scene.scale * trial.factor * scale)
    }

    /// The walls of some trials at these scales; they count as runs.
    fn cases(&mut self, trials: &[Trial], scales: &[f64]) -> Result<Vec<Case>> {
        self.runs += trials.len();
        (trials, scales).into_par_iter().map(|(t, s)| self.case(t, *s)).collect::<Vec<_>>().into_iter().collect()
    }

    /// The least scale of the motion at which a first bond cracks, as `[first-crack]` finds it: from below, with lower scales tried
    /// in the end, because a wall that slides or rocks may stand more than it cracks at. An end of the range where it lies beyond it; not a number where a run
    /// failed.
    fn first_cracks(&mut self, trials: &[Trial]) -> Result<Option<Vec<f64>>> {
        let [low, high] = self.question.input.crack_scales;
        let subject = |trial: &Trial| Ok(Subject { name: String::new(), case: self.case(trial, 1.0)? });
        let subjects = trials.par_iter().map(subject).collect::<Vec<_>>().into_iter().collect::<Result<Vec<_>>>()?;
        let rule = Rule::new(Criterion::Bond, None);
        let input = FirstCrackInput::default();
        let asked = first_crack::Question {
            rule,
            interval: self.question.input.crack_within,
            checks: input.checks,
            periods: Vec::new(),
        };
        let keep = first_crack::keep().joints;
        let found = self.runner.with_cracks(&rule, &keep, |runner| first_crack::search(&asked, &subjects, runner))?;
        let Some(answers) = found else { return Ok(None) };
        self.runs += answers.iter().map(|answer| answer.trials.len()).sum::<usize>();
        let of = |answer: &Answer| match (answer.below(), answer.crack()) {
            (_, Some(crack)) if crack.time == Some(0.0) || crack.scale <= low => low,
            (Some(below), _) if below.scale >= high => high,
            _ if answer.cause.is_some() => f64::NAN,
            (below, Some(crack)) => (below.map_or(0.0, |below| below.scale) * crack.scale).sqrt().clamp(low, high),
            (_, None) => high,
        };
        Ok(Some(answers.iter().map(of).collect()))
    }
}

/// A number of a run that reached its end.
fn measured(row: &Row, of: impl Fn(&Row) -> Option<f64>) -> Option<f64> {
    if row.end == End::Completed { of(row) } else { None }
}
