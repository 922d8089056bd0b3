//! Incremental dynamic analysis: every motion at rising intensity, what the wall suffers, and the fragility that follows.
//!
//! Equations and ways: D. Vamvatsikos, C. A. Cornell, Earthquake Engng Struct. Dyn. 31 (2002) 491 and Earthquake Spectra 20
//! (2004) 523 (hunt and fill, fractiles); J. W. Baker, Earthquake Spectra 31 (2015) 579 (stripes).
//!
//! A curve is a run of the study's design, scaled: with motions alone, one per motion; with a design that draws, one per
//! draw of parameters and motion.

pub mod curve;
pub mod doubts;
pub mod fragility;
pub mod hazard;
pub mod hunt;
pub mod likelihood;
pub mod tables;

use std::collections::HashMap;

use concio::Result;
use concio::case::{Case, ModelKind, StopAt};
use concio::ground::coverage::is_of_factor;
use concio::quantity::{Acceleration, Length, Time, Velocity, shown};
use concio::run::Control;
use serde_json::Value;

use crate::Plan;
use crate::factors::Factor;
use crate::file::analyses::{HazardInput, Ida};
use crate::file::{DesignKind, StudyFile};
use crate::intensity::Intensity;
use crate::measures::{MEASURES, Measure, Row, ends_with_collapse};
use crate::runner::Runner;
use crate::values::few;
use curve::{Curve, Point};
use hazard::Hazard;

/// Measures that do not grow with the shaking.
const NO_DAMAGE: [&str; 6] = ["time_reached", "first_crack", "first_lift_off", "energy_residual", "steps", "collapse"];
/// Measures that are ratios, of which a limit may be given in per cent, and that whose 1 is d0.
const RATIOS: [&str; 2] = ["peak_drift", OF_D0];
const OF_D0: &str = "peak_over_d0";
/// Intensities of a list, and runs of a curve.
const MOST_PER_CURVE: usize = 1000;
/// Limit states.
const MOST_LIMITS: usize = 100;

/// How intensities are chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum Way {
    /// These, for every motion.
    List(Vec<f64>),
    /// Hunt and fill.
    Hunt {
        /// First intensity.
        first: f64,
        /// First step.
        step: f64,
        /// What each step is longer than the one before.
        growth: f64,
        /// Intensity that is not exceeded.
        most: f64,
        /// Runs per motion.
        runs: usize,
        /// Gap that holds a collapse or a limit, over the intensity below it, that is small enough.
        resolution: f64,
    },
}

/// `[ida]` in SI, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Intensity measure.
    pub intensity: Intensity,
    /// Its period [s]; 0 where it has none.
    pub period: f64,
    /// Measure of damage.
    pub damage: String,
    /// Its SI unit.
    pub unit: &'static str,
    /// Names and values of the limit states, rising.
    pub limits: Vec<(String, f64)>,
    /// Damage of collapse; infinite when none is given.
    pub collapse: f64,
    /// How intensities are chosen.
    pub way: Way,
    /// How often they are exceeded.
    pub hazard: Option<Hazard>,
    /// Confidence of intervals.
    pub confidence: f64,
}

/// Reads `[ida]`; none when the study has none.
///
/// # Errors
/// What is missing, empty or out of range, with its line.
pub fn settings(file: &StudyFile) -> Result<Option<Settings>> {
    let study = &file.study;
    let Some(ida) = &study.ida else { return Ok(None) };
    if study.motions.is_empty() {
        return Err(file.wrong("ida", "the study has no motions", "at least one [[motion]]"));
    }
    if !study.scales.is_empty() {
        let what = "`scales` and `[ida]` contradict each other: an incremental analysis scales the motions itself";
        return Err(file.wrong("scales", what, "no `scales`, or no `[ida]`"));
    }
    if let Some(i) = study.factors.iter().position(|f| f.path.as_deref() == Some("group.acceleration")) {
        let what =
            "`group.acceleration` and `[ida]` contradict each other: an incremental analysis scales the motions itself";
        return Err(file.wrong(&format!("vary[{i}].path"), what, "another path, or no `[ida]`"));
    }
    if let DesignKind::Sobol | DesignKind::Morris = study.design.kind {
        let what = "takes each value again in several runs, and `[ida]` takes draws as independent";
        return Err(file.wrong("design.kind", what, "`random`, `latin-hypercube`, `grid` or `list`"));
    }
    if study.sensitivity.is_some() {
        let what = "`[sensitivity]` and `[ida]` contradict each other: one looks at the runs of the design as they are";
        return Err(file.wrong("sensitivity", what, "one of both"));
    }
    let model = file.wall.case.model;
    let known = || MEASURES.iter().filter(|m| !NO_DAMAGE.contains(&m.name) && m.is_of(model));
    let Some(measure) = known().find(|m| m.name == ida.damage) else {
        let names: Vec<&str> = known().map(|m| m.name).collect();
        let what = match MEASURES.iter().any(|m| m.name == ida.damage && !m.is_of(model)) {
            true => format!("runs of {} walls have no `{}`", model.name(), ida.damage),
            false => format!("`{}` is no measure of damage", ida.damage),
        };
        return Err(file.wrong("ida.damage", what, &names.join(", ")));
    };
    let period = match (ida.intensity, ida.period) {
        (Intensity::Sa, Some(period)) if period.si() > 0.0 => period.si(),
        (Intensity::Sa, Some(_)) => return Err(file.wrong("ida.period", "is out of range", "above 0 s")),
        (Intensity::Sa, None) => {
            return Err(file.wrong("ida.period", "the key is missing: `sa` needs it", "above 0 s"));
        }
        (_, Some(_)) => return Err(file.wrong("ida.period", "only `sa` has a period", "no `period`")),
        (_, None) => 0.0,
    };
    if !(ida.confidence > 0.0 && ida.confidence < 1.0) {
        let what = format!("{} is out of range", shown(ida.confidence));
        return Err(file.wrong("ida.confidence", what, "between 0 and 1"));
    }
    let collapse = ida.collapse.as_ref().map(|v| damage(file, "ida.collapse", v, measure)).transpose()?;
    Ok(Some(Settings {
        intensity: ida.intensity,
        period,
        damage: ida.damage.clone(),
        unit: measure.unit,
        limits: limits(file, ida, measure, collapse)?,
        collapse: collapse.unwrap_or(f64::INFINITY),
        way: way(file, ida)?,
        hazard: ida.hazard.as_ref().map(|input| hazard(file, input, ida.intensity)).transpose()?,
        confidence: ida.confidence,
    }))
}

fn limits(file: &StudyFile, ida: &Ida, measure: &Measure, collapse: Option<f64>) -> Result<Vec<(String, f64)>> {
    if ida.limits.is_empty() {
        return Err(file.wrong("ida.limits", "there are no limit states", "at least one `{ name = …, value = … }`"));
    }
    few(ida.limits.len(), MOST_LIMITS, |what, allowed| file.wrong("ida.limits", what, allowed))?;
    let mut limits: Vec<(String, f64)> = Vec::new();
    for (i, limit) in ida.limits.iter().enumerate() {
        let key = format!("ida.limits[{i}].value");
        let value = damage(file, &key, &limit.value, measure)?;
        if collapse.is_some_and(|c| value > c) {
            return Err(file.wrong(&key, "lies beyond `collapse`", "up to `collapse`"));
        }
        if limits.iter().any(|(name, _)| *name == limit.name) {
            let key = format!("ida.limits[{i}].name");
            return Err(file.wrong(&key, "two limit states have this name", "names that differ"));
        }
        limits.push((limit.name.clone(), value));
    }
    limits.sort_by(|a, b| a.1.total_cmp(&b.1));
    Ok(limits)
}

fn hazard(file: &StudyFile, input: &HazardInput, intensity: Intensity) -> Result<Hazard> {
    let (n, rates) = (input.intensities.len(), input.rates.len());
    if intensity == Intensity::Scale {
        let what = "`scale` is no intensity that a site has";
        return Err(file.wrong("ida.hazard", what, "`pga`, `pgv` or `sa` as `intensity`"));
    }
    if n != rates || n < 2 {
        let what = format!("{n} intensities and {rates} rates make no curve");
        return Err(file.wrong("ida.hazard.rates", what, "as many rates as intensities, two at least"));
    }
    few(n, MOST_PER_CURVE, |what, allowed| file.wrong("ida.hazard.intensities", what, allowed))?;
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (i, (value, rate)) in input.intensities.iter().zip(&input.rates).enumerate() {
        let key = |list: &str| format!("ida.hazard.{list}[{i}]");
        let value = above(file, &key("intensities"), value, intensity.unit())?;
        let [before, more] = points.last().copied().unwrap_or([0.0, f64::INFINITY]);
        if value <= before {
            return Err(file.wrong(&key("intensities"), "does not lie above the one before it", "rising intensities"));
        }
        if !(*rate > 0.0 && *rate < more) {
            let what = format!("{} is out of range", shown(*rate));
            return Err(file.wrong(&key("rates"), what, "above 0 and below the one before it"));
        }
        points.push([value, *rate]);
    }
    Ok(Hazard { points })
}

fn way(file: &StudyFile, ida: &Ida) -> Result<Way> {
    let unit = ida.intensity.unit();
    let one = "exactly one of `intensities` (at least one) and `hunt`";
    match (&ida.hunt, ida.intensities.is_empty()) {
        (Some(_), false) => Err(file.wrong("ida.hunt", "`intensities` and `hunt` contradict each other", one)),
        (None, true) => Err(file.wrong("ida", "nothing says at which intensities the motions are run", one)),
        (None, false) => {
            let mut list = Vec::new();
            for (i, value) in ida.intensities.iter().enumerate() {
                let key = format!("ida.intensities[{i}]");
                let value = above(file, &key, value, unit)?;
                if list.last().is_some_and(|last| value <= *last) {
                    return Err(file.wrong(&key, "does not lie above the one before it", "rising intensities"));
                }
                list.push(value);
            }
            if list.len() > MOST_PER_CURVE {
                return Err(file.wrong("ida.intensities", "are too many", "up to 1,000"));
            }
            Ok(Way::List(list))
        }
        (Some(hunt), true) => {
            let at = |key: &str, value: &Value| above(file, &format!("ida.hunt.{key}"), value, unit);
            let (first, step, most) = (at("first", &hunt.first)?, at("step", &hunt.step)?, at("most", &hunt.most)?);
            let growth = match &hunt.growth {
                None => 0.5 * step,
                Some(value) => number(value, unit).filter(|v| *v >= 0.0).ok_or_else(|| {
                    file.wrong("ida.hunt.growth", format!("{value} is out of range"), &allowed("from 0", unit))
                })?,
            };
            if most <= first {
                return Err(file.wrong("ida.hunt.most", "does not lie above `first`", "above `first`"));
            }
            if !(4..=MOST_PER_CURVE).contains(&hunt.runs) {
                return Err(file.wrong("ida.hunt.runs", format!("{} is out of range", hunt.runs), "4 … 1000"));
            }
            if !(hunt.resolution > 0.0 && hunt.resolution.is_finite()) {
                let what = format!("{} is out of range", shown(hunt.resolution));
                return Err(file.wrong("ida.hunt.resolution", what, "above 0"));
            }
            Ok(Way::Hunt { first, step, growth, most, runs: hunt.runs, resolution: hunt.resolution })
        }
    }
}

fn allowed(range: &str, unit: &str) -> String {
    if unit.is_empty() { range.into() } else { format!("{range}: a number in {unit}, or a text with its unit") }
}

fn above(file: &StudyFile, key: &str, value: &Value, unit: &str) -> Result<f64> {
    let found = number(value, unit).filter(|v| *v > 0.0 && v.is_finite());
    found.ok_or_else(|| file.wrong(key, format!("{value} is out of range"), &allowed("above 0", unit)))
}

/// A value of the measure of damage in SI.
fn damage(file: &StudyFile, key: &str, value: &Value, measure: &Measure) -> Result<f64> {
    if !RATIOS.contains(&measure.name) {
        return above(file, key, value, measure.unit);
    }
    ratio(value).filter(|v| *v > 0.0 && v.is_finite()).ok_or_else(|| {
        file.wrong(key, format!("{value} is out of range"), "above 0: a number, or a text in per cent such as \"1 %\"")
    })
}

/// A ratio: a number, or a text in per cent.
fn ratio(value: &Value) -> Option<f64> {
    let Some(text) = value.as_str() else { return value.as_f64() };
    text.trim().strip_suffix('%')?.trim().parse::<f64>().ok().map(|percent| percent / 100.0)
}

/// A value in SI: a number, or a text with a unit of the same kind.
fn number(value: &Value, unit: &str) -> Option<f64> {
    let Value::String(text) = value else { return value.as_f64() };
    match unit {
        "m" => Length::parse(text).ok().map(|v| v.si()),
        "m/s" => Velocity::parse(text).ok().map(|v| v.si()),
        "m/s²" => Acceleration::parse(text).ok().map(|v| v.si()),
        "s" => Time::parse(text).ok().map(|v| v.si()),
        _ => None,
    }
}

impl Settings {
    /// The intensities to run next, given those that were run, rising ([`Way::next`]).
    pub fn next(&self, points: &[Point]) -> Vec<f64> {
        let limits: Vec<f64> = self.limits.iter().map(|(_, value)| *value).collect();
        self.way.next(points, &limits)
    }
}

/// An incremental analysis under way.
#[derive(Debug)]
pub struct Analysis<'a> {
    /// What was asked.
    pub settings: Settings,
    /// One curve per run of the design.
    pub curves: Vec<Curve>,
    /// Whether runs of planar walls end with their collapse: nothing that is asked of them comes later.
    pub stops: bool,
    plan: &'a Plan,
}

impl<'a> Analysis<'a> {
    /// Nothing is run yet. None when the study has no `[ida]`.
    ///
    /// # Errors
    /// As [`settings`]; a motion that does not shake.
    pub fn new(plan: &'a Plan) -> Result<Option<Self>> {
        let Some(settings) = settings(&plan.file)? else { return Ok(None) };
        let motions = plan.motions();
        let curve = |number: usize| -> Result<Curve> {
            let unit = settings.intensity.of(&plan.case(number)?, settings.period)?;
            Ok(Curve {
                name: name(plan, number),
                motion: motions[number],
                number,
                unit,
                points: Vec::new(),
                failed: None,
            })
        };
        let curves = (0..plan.points.len()).map(curve).collect::<Result<Vec<_>>>()?;
        let mut seen = HashMap::new();
        // What is drawn twice counts twice.
        let listed = matches!(plan.file.study.design.kind, DesignKind::Grid | DesignKind::List);
        for curve in curves.iter().filter(|_| listed) {
            let id = plan.id(&plan.scaled_case(curve.number, 1.0 / curve.unit)?)?;
            if let Some(before) = seen.insert(id, &curve.name) {
                let what = format!(
                    "`{before}` and `{}` are one motion once they are scaled: it would count twice",
                    curve.name
                );
                return Err(plan.file.wrong(
                    "motion",
                    what,
                    "values that differ by more than the strength of the motion",
                ));
            }
        }
        let stops = ends_with_collapse(&settings.damage) && !plan.file.study.keep.results;
        Ok(Some(Analysis { settings, curves, stops, plan }))
    }

    /// The case of a curve at an intensity.
    ///
    /// # Errors
    /// Values that make no wall.
    pub fn case(&self, curve: usize, intensity: f64) -> Result<Case> {
        let curve = &self.curves[curve];
        let mut case = self.plan.scaled_case(curve.number, intensity / curve.unit)?;
        if self.stops && case.model == ModelKind::Planar {
            case.motion.stop_at = Some(StopAt::Collapse(Time::from_si(0.0)));
        }
        Ok(case)
    }

    /// Asks the runner until every curve of a share is whole; whether it was stopped before.
    ///
    /// # Errors
    /// As [`Runner::rows`].
    pub fn ask(&mut self, runner: &mut Runner, share: &dyn Fn(usize) -> bool) -> Result<Control> {
        loop {
            let questions = self.questions(share);
            if questions.is_empty() {
                return Ok(Control::Continue);
            }
            let cases = questions.iter().map(|(curve, y)| self.case(*curve, *y)).collect::<Result<Vec<_>>>()?;
            let Some(rows) = runner.rows(&cases)? else { return Ok(Control::Stop) };
            for (question, row) in questions.into_iter().zip(&rows) {
                self.answer(question, row);
            }
        }
    }

    /// What is asked next of the curves in `share`: numbers of curves and intensities. Empty when they are done.
    pub fn questions(&self, share: &dyn Fn(usize) -> bool) -> Vec<(usize, f64)> {
        let of = |(number, curve): (usize, &Curve)| {
            let asked =
                if share(number) && curve.failed.is_none() { self.settings.next(&curve.points) } else { Vec::new() };
            asked.into_iter().map(move |intensity| (number, intensity))
        };
        self.curves.iter().enumerate().flat_map(of).collect()
    }

    /// Takes what became of a question.
    pub fn answer(&mut self, (number, intensity): (usize, f64), row: &Row) {
        let curve = &mut self.curves[number];
        let scale = intensity / curve.unit;
        match Point::of(intensity, scale, row, &self.settings) {
            Ok(mut point) => {
                // The factor is the analysis's own, whatever it is near to.
                point.warnings.retain(|w| self.settings.intensity == Intensity::Scale || !is_of_factor(w));
                let place = curve.points.partition_point(|p| p.intensity < intensity);
                curve.points.insert(place, point);
            }
            Err(cause) => curve.failed = Some(cause),
        }
    }
}

/// What is to be known of fragilities over factors whose values are chosen, not drawn.
pub fn pooled(plan: &Plan) -> Option<String> {
    let study = &plan.file.study;
    let chosen = study.ida.is_some() && matches!(study.design.kind, DesignKind::Grid | DesignKind::List);
    let several = |factor: &&Factor| factor.key != "motion" && factor.levels().is_some_and(|levels| levels > 1);
    let names: Vec<String> =
        plan.factors.iter().filter(|_| chosen).filter(several).map(|factor| format!("`{}`", factor.name)).collect();
    (!names.is_empty()).then(|| {
        format!(
            "the values of {} are chosen, not drawn, and all count in one fragility: its dispersion holds their spread; a study of each value tells them apart",
            names.join(", ")
        )
    })
}

/// What the run of a design is called: its motion, or all its values.
fn name(plan: &Plan, number: usize) -> String {
    let label = |v: Value| v.as_str().map_or_else(|| v.to_string(), str::to_string);
    let labels: Vec<String> = plan.labels(number).into_iter().map(label).collect();
    labels.join(", ")
}
