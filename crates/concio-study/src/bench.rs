//! Measures designs: builds their walls, has them run, takes the runs together to objectives.

use concio::Result;
use concio::case::Case;
use rayon::prelude::*;

use crate::interfaces::{Question, Target, with};
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

    /// The scale of the motion at which a first bond cracks, by halving the logarithm of the interval, all trials at
    /// once: the middle of the last interval; an end of the range where the first crack lies beyond it.
    fn first_cracks(&mut self, trials: &[Trial]) -> Result<Option<Vec<f64>>> {
        let [low, high] = self.question.input.crack_scales;
        let mut ends = vec![[low, high]; trials.len()];
        let mut found: Vec<Option<f64>> = vec![None; trials.len()];
        for (scale, wanted) in [(low, true), (high, false)] {
            let Some(cracks) = self.cracked(trials, &vec![scale; trials.len()])? else { return Ok(None) };
            for (found, cracks) in found.iter_mut().zip(cracks) {
                match cracks {
                    Some(cracks) if cracks == wanted => *found = found.or(Some(scale)),
                    Some(_) => {}
                    None => *found = found.or(Some(f64::NAN)),
                }
            }
        }
        for _ in 0..self.question.rounds() {
            let open: Vec<usize> = (0..trials.len()).filter(|&i| found[i].is_none()).collect();
            if open.is_empty() {
                break;
            }
            let some: Vec<Trial> = open.iter().map(|&i| trials[i]).collect();
            let middles: Vec<f64> = open.iter().map(|&i| (ends[i][0] * ends[i][1]).sqrt()).collect();
            let Some(cracks) = self.cracked(&some, &middles)? else { return Ok(None) };
            for ((&i, middle), cracks) in open.iter().zip(middles).zip(cracks) {
                match cracks {
                    Some(cracks) => ends[i][usize::from(cracks)] = middle,
                    None => found[i] = Some(f64::NAN),
                }
            }
        }
        let of = |(found, [low, high]): (Option<f64>, [f64; 2])| found.unwrap_or((low * high).sqrt());
        Ok(Some(found.into_iter().zip(ends).map(of).collect()))
    }

    /// Whether a bond cracks at these scales; none where a run failed before one did. Runs end with their first crack.
    fn cracked(&mut self, trials: &[Trial], scales: &[f64]) -> Result<Option<Vec<Option<bool>>>> {
        let cases = self.cases(trials, scales)?;
        let rule = Rule::new(Criterion::Bond, None);
        let Some(rows) = self.runner.rows_until(&cases, &rule)? else { return Ok(None) };
        let cracked = |row: &Row| (row.end == End::Completed).then(|| row.number("first_crack").is_some());
        Ok(Some(rows.iter().map(cracked).collect()))
    }
}

/// A number of a run that reached its end.
fn measured(row: &Row, of: impl Fn(&Row) -> Option<f64>) -> Option<f64> {
    if row.end == End::Completed { of(row) } else { None }
}
