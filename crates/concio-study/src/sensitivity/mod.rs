//! Which factors move a measure, and how much: indices that fit the design of the study.
//!
//! `morris` gives elementary effects, `sobol` shares of the variance, every other design standardised rank regression
//! coefficients. Intervals of elementary effects are those of small samples ([`morris`]), those of the others are from the jackknife ([`jackknife`]): whatever
//! is independent (base points, runs, or the motions of runs that share some) is left out in turn.

pub mod morris;
pub mod ranks;
pub mod sobol;
pub mod tables;

use concio::Result;
use concio::quantity::shown;

use crate::Plan;
use crate::design::At;
use crate::factors::Factor;
use crate::file::DesignKind;
use crate::measures::{End, MEASURES, Measure, Row};
use crate::statistics::student;

/// An index with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Index {
    /// Estimate from all that was run.
    pub value: f64,
    /// Its interval.
    pub interval: [f64; 2],
}

/// Parts that are left out one by one at most: of more, groups are.
const GROUPS: usize = 200;

/// Indices of `n` independent parts, two at least: `of` computes them from a list of parts. Their intervals are Student's with so many degrees of `freedom` of
/// what the jackknife tells of their scatter (J. W. Tukey, 1958; of groups that are not alike, F. Busing et al., Stat. Comput. 9 (1999) 3):
///
/// (J1)  s² = 1/G Σ_j (h_j θ − (h_j − 1) θ_j − θ_J)²/(h_j − 1),   θ_J = G θ − Σ_j (1 − 1/h_j) θ_j
///
/// θ_j is θ without group j of G groups, which has n/h_j parts. An index that is no number, of some group left out too, has an interval that is none.
pub fn jackknife(n: usize, freedom: f64, confidence: f64, of: &dyn Fn(&[usize]) -> Vec<f64>) -> Vec<Index> {
    let all: Vec<usize> = (0..n).collect();
    let values = of(&all);
    let groups = n.min(GROUPS);
    let without = |group: usize| all.iter().copied().filter(|part| part % groups != group).collect::<Vec<_>>();
    let left: Vec<Vec<f64>> = (0..groups).map(|group| of(&without(group))).collect();
    let times: Vec<f64> = (0..groups).map(|group| n as f64 / (n - group).div_ceil(groups) as f64).collect();
    let index = |(k, value): (usize, f64)| {
        let count = groups as f64;
        let sum: f64 = left.iter().zip(&times).map(|(left, h)| (1.0 - 1.0 / h) * left[k]).sum();
        let centre = count * value - sum;
        let off = |(left, h): (&Vec<f64>, &f64)| (h * value - (h - 1.0) * left[k] - centre).powi(2) / (h - 1.0);
        let scatter = (left.iter().zip(&times).map(off).sum::<f64>() / count).sqrt();
        let half = student(freedom.min(count - 1.0), confidence) * scatter;
        Index { value, interval: [value - half, value + half] }
    };
    values.into_iter().enumerate().map(index).collect()
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
    let of_model = || MEASURES.iter().filter(|m| m.is_of(file.wall.case.model));
    let known = || of_model().map(|m| m.name).collect::<Vec<_>>().join(", ");
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
    let find = |(i, name): (usize, &String)| {
        let found = of_model().find(|m| m.name == name);
        found.ok_or_else(|| {
            let what = match MEASURES.iter().any(|m| m.name == name) {
                true => format!("runs of {} walls have no `{name}`", file.wall.case.model.name()),
                false => format!("`{name}` is no measure of a run"),
            };
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
    let motions = plan.motions();
    let levels: Vec<Vec<f64>> = plan.factors.iter().map(Factor::places).collect();
    let ordered: Vec<bool> = plan.factors.iter().map(Factor::is_ordered).collect();
    let shares: Vec<Vec<f64>> = plan.points.iter().map(|row| places(row, &levels)).collect();
    let of = |measure: &'static Measure| {
        let value = |row: &Option<&Row>| row.filter(|r| r.end == End::Completed).and_then(|r| r.number(measure.name));
        let values: Vec<Option<f64>> = rows.iter().map(value).collect();
        let k = plan.factors.len();
        let found = match plan.file.study.design.kind {
            DesignKind::Morris => morris::effects(&shares, &values, &ordered, asked.confidence).map(Indices::Morris),
            DesignKind::Sobol => sobol::shares(&values, k, asked.confidence).map(Indices::Sobol),
            _ => ranks::coefficients(&shares, &values, &ordered, (&motions, asked.confidence))
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
