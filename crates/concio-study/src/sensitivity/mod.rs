//! Which factors move a measure, and how much: indices that fit the design of the study.
//!
//! `morris` gives elementary effects, `sobol` shares of the variance, every other design standardised rank regression
//! coefficients. Intervals of elementary effects are those of small samples ([`morris`]). Those of the others are from the bootstrap: whatever the design drew
//! independently (base points, runs) is drawn again with replacement, and the interval holds the middle part of the indices so found.

pub mod morris;
pub mod ranks;
pub mod sobol;
pub mod tables;

use concio::Result;
use concio::dice::Dice;
use concio::quantity::shown;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::Plan;
use crate::design::At;
use crate::factors::Factor;
use crate::file::DesignKind;
use crate::measures::{End, MEASURES, Measure, Row};

/// `[sensitivity]`: indices of the factors for some measures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sensitivity {
    /// Measures of a run (docs/studies), at least one: `peak_joint_displacement`, `friction_energy`, …
    pub of: Vec<String>,
    /// Confidence of the intervals, between 0 and 1; default 0.95.
    #[serde(default = "confidence")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub confidence: f64,
    /// Resamples of the bootstrap, which all designs but `morris` have, 100 … 100,000; default 1000.
    #[serde(default = "resamples")]
    #[schemars(range(min = 100, max = 100_000))]
    pub resamples: usize,
    /// Seed of the bootstrap; default 1.
    #[serde(default = "seed")]
    pub seed: u64,
}

fn confidence() -> f64 {
    0.95
}
fn resamples() -> usize {
    1000
}
fn seed() -> u64 {
    1
}

/// An index with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Index {
    /// Estimate from all that was run.
    pub value: f64,
    /// Its interval.
    pub interval: [f64; 2],
}

/// By how many deviations an interval of that confidence lies on either side, by Student's law with so many degrees of freedom.
pub(crate) fn student(freedom: f64, confidence: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |law| law.inverse_cdf(0.5 + 0.5 * confidence))
}

/// How the bootstrap is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bootstrap {
    /// Number of resamples, from 1.
    pub resamples: usize,
    /// Confidence, between 0 and 1.
    pub confidence: f64,
    /// Seed.
    pub seed: u64,
}

impl Bootstrap {
    /// Indices of `n` independent parts: `of` computes them from a list of parts, which may hold one several times. An index
    /// that is no number has an interval that is none.
    pub fn indices(&self, n: usize, of: &dyn Fn(&[usize]) -> Vec<f64>) -> Vec<Index> {
        let all: Vec<usize> = (0..n).collect();
        let values = of(&all);
        let mut dice = Dice::new(self.seed);
        let mut drawn: Vec<Vec<f64>> = vec![Vec::new(); values.len()];
        for _ in 0..self.resamples {
            let parts: Vec<usize> = (0..n).map(|_| dice.below(n)).collect();
            for (list, value) in drawn.iter_mut().zip(of(&parts)) {
                if value.is_finite() {
                    list.push(value);
                }
            }
        }
        let tail = 0.5 * (1.0 - self.confidence);
        let interval = |mut list: Vec<f64>| {
            list.sort_by(f64::total_cmp);
            [tail, 1.0 - tail].map(|share| crate::ida::curve::quantile(&list, share))
        };
        values.into_iter().zip(drawn).map(|(value, list)| Index { value, interval: interval(list) }).collect()
    }
}

/// The indices of the factors for one measure.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The measure.
    pub measure: &'static Measure,
    /// What was found, or why nothing was.
    pub indices: std::result::Result<Indices, String>,
    /// Runs that could not be used: not completed, or without the measure; whole trajectories and base points with them.
    pub left_out: usize,
}

/// Indices by the kind of design, one entry per factor.
#[derive(Debug, Clone, PartialEq)]
pub enum Indices {
    /// Elementary effects over the whole range of a factor, in the unit of the measure.
    Morris(Vec<morris::Effect>),
    /// Shares of the variance.
    Sobol(Vec<sobol::Shares>),
    /// Standardised rank regression coefficients; none for factors without an order.
    Ranks {
        /// One per factor.
        coefficients: Vec<Option<Index>>,
        /// R² of the regression: what part of the variance of the ranks it explains.
        explained: f64,
    },
}

/// The measures asked for; empty when the study has no `[sensitivity]`.
///
/// # Errors
/// An unknown measure, an empty list, numbers out of range, with their line.
pub fn measures(plan: &Plan) -> Result<Vec<&'static Measure>> {
    let file = &plan.file;
    let Some(asked) = &file.study.sensitivity else { return Ok(Vec::new()) };
    let known = || MEASURES.iter().map(|m| m.name).collect::<Vec<_>>().join(", ");
    if asked.of.is_empty() {
        return Err(file.wrong("sensitivity.of", "no measure is named", &known()));
    }
    if plan.factors.is_empty() {
        return Err(file.wrong("sensitivity", "nothing varies", "at least one [[vary]], [[motion]] or `scales`"));
    }
    if !(asked.confidence > 0.0 && asked.confidence < 1.0) {
        let what = format!("{} is out of range", shown(asked.confidence));
        return Err(file.wrong("sensitivity.confidence", what, "between 0 and 1"));
    }
    if !(100..=100_000).contains(&asked.resamples) {
        let what = format!("{} is out of range", asked.resamples);
        return Err(file.wrong("sensitivity.resamples", what, "100 … 100,000"));
    }
    let find = |(i, name): (usize, &String)| {
        let found = MEASURES.iter().find(|m| m.name == name);
        found.ok_or_else(|| {
            let what = format!("`{name}` is no measure of a run");
            file.wrong(&format!("sensitivity.of[{i}]"), what, &known())
        })
    };
    asked.of.iter().enumerate().map(find).collect()
}

/// The indices for every measure asked for. `rows` as the runs stand in the plan, none where a run is not done.
///
/// # Errors
/// As [`measures`].
pub fn sensitivity(plan: &Plan, rows: &[Option<&Row>]) -> Result<Vec<Found>> {
    let measures = measures(plan)?;
    let Some(asked) = &plan.file.study.sensitivity else { return Ok(Vec::new()) };
    let bootstrap = Bootstrap { resamples: asked.resamples, confidence: asked.confidence, seed: asked.seed };
    let levels: Vec<Vec<f64>> = plan.factors.iter().map(Factor::places).collect();
    let ordered: Vec<bool> = plan.factors.iter().map(Factor::is_ordered).collect();
    let shares: Vec<Vec<f64>> = plan.points.iter().map(|row| places(row, &levels)).collect();
    let of = |measure: &'static Measure| {
        let value = |row: &Option<&Row>| row.filter(|r| r.end == End::Completed).and_then(|r| r.number(measure.name));
        let values: Vec<Option<f64>> = rows.iter().map(value).collect();
        let k = plan.factors.len();
        let found = match plan.file.study.design.kind {
            DesignKind::Morris => morris::effects(&shares, &values, &ordered, asked.confidence).map(Indices::Morris),
            DesignKind::Sobol => sobol::shares(&values, k, &bootstrap).map(Indices::Sobol),
            _ => ranks::coefficients(&shares, &values, &ordered, &bootstrap)
                .map(|(coefficients, explained)| Indices::Ranks { coefficients, explained }),
        };
        Found { measure, indices: found, left_out: values.iter().filter(|v| v.is_none()).count() }
    };
    Ok(measures.into_iter().map(of).collect())
}

/// Where each factor stands in its range, 0 … 1; `levels` are the places of the levels of each.
fn places(row: &[At], levels: &[Vec<f64>]) -> Vec<f64> {
    let place = |(at, levels): (&At, &Vec<f64>)| match at {
        At::Share(share) => *share,
        At::Level(level) => levels[*level],
    };
    row.iter().zip(levels).map(place).collect()
}
