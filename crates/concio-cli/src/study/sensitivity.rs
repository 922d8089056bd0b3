//! The section on what moves what was measured.

use concio::Result;
use concio_study::Plan;
use concio_study::measures::Row;
use concio_study::sensitivity::{Found, Index, Indices, sensitivity, tables};
use concio_study::table::Table;

use super::interval_bars::{self, Group};
use super::page::{Figure, Section, shown};
use crate::format::{columns, counted};

/// Width of the figure [pt].
const WIDTH: f64 = 420.0;

/// Section and table; none when the study does not ask.
///
/// # Errors
/// As [`sensitivity`].
pub fn section(plan: &Plan, rows: &[Option<&Row>]) -> Result<Option<(Section, Table)>> {
    let found = sensitivity(plan, rows)?;
    if found.is_empty() {
        return Ok(None);
    }
    let table = tables::table(plan, &found);
    let text = text(plan, &found);
    let figures = figure(plan, &found).into_iter().collect();
    let caption = "Indices with their intervals".to_string();
    let tables = vec![(caption, table.clone())];
    let brief = brief(plan, &found);
    Ok(Some((Section { title: "Sensitivity".into(), text, figures, tables, brief }, table)))
}

/// What the indices are called, in the order of [`tables::rows`], as many as are shown.
fn headings(indices: &Indices) -> &'static [&'static str] {
    match indices {
        Indices::Morris(_) => &["μ*", "σ"],
        Indices::Sobol(_) => &["total", "first order"],
        Indices::Ranks { .. } => &["rank regression coefficient"],
    }
}

/// One line per measure and factor, with the intervals.
fn brief(plan: &Plan, found: &[Found]) -> String {
    let mut lines: Vec<Vec<String>> = Vec::new();
    let mut notes = String::new();
    for f in found {
        let indices = match &f.indices {
            Ok(indices) => indices,
            Err(cause) => {
                notes.push_str(&format!("  {}: no indices, {cause}\n", f.measure.name));
                continue;
            }
        };
        let headings = headings(indices);
        if lines.is_empty() {
            let heading = ["sensitivity of", "to"].into_iter().chain(headings.iter().copied());
            lines.push(heading.map(String::from).collect());
        }
        let unit = if matches!(indices, Indices::Morris(_)) { f.measure.unit } else { "" };
        for (factor, row) in plan.factors.iter().zip(tables::rows(indices)) {
            let cell = |index: &Option<Index>| match index.filter(|i| i.value.is_finite()) {
                Some(i) => {
                    let [low, high] = i.interval.map(shown);
                    format!("{} {unit}", shown(i.value)).trim_end().to_string() + &format!(" ({low} … {high})")
                }
                None => "–".into(),
            };
            let cells = row.iter().take(headings.len()).map(cell);
            lines.push([f.measure.name.to_string(), factor.name.clone()].into_iter().chain(cells).collect());
        }
    }
    let told = found.iter().filter_map(|f| Some(format!("  {}\n", regression(plan, f)?)));
    columns(&lines) + &notes + &told.collect::<String>()
}

/// What a rank regression explains, and of which factors it is; none of other indices.
fn regression(plan: &Plan, found: &Found) -> Option<String> {
    let indices = found.indices.as_ref().ok()?;
    let Indices::Ranks { explained, .. } = indices else { return None };
    let out = match tables::left_out(plan, indices) {
        out if out.is_empty() => String::new(),
        out => format!("; it leaves out {}, whose values have no order", out.join(", ")),
    };
    let percent = 100.0 * explained;
    Some(format!("{}: the regression explains {percent:.0} % of the ranks' variance{out}", found.measure.name))
}

fn text(plan: &Plan, found: &[Found]) -> Vec<String> {
    let kind = found.iter().find_map(|f| f.indices.as_ref().ok());
    let mut text = vec![match kind {
        Some(Indices::Morris(_)) => "Elementary effects (Morris): μ* is the mean size of a factor's effect over its whole \
             range, in the unit of the measure; σ near or above μ* tells that the effect depends on the other factors or is \
             not straight."
            .to_string(),
        Some(Indices::Sobol(_)) => "Shares of the variance (Sobol): what each factor explains alone (first order), and with \
             all its interactions (total). First-order shares that add up to much less than 1 tell of interactions."
            .into(),
        _ => "Standardised rank regression coefficients: how far the rank of the measure follows that of the factor, from −1 \
             to 1."
            .into(),
    }];
    for f in found {
        match &f.indices {
            Err(cause) => text.push(format!("{}: no indices, {cause}.", f.measure.name)),
            Ok(Indices::Ranks { coefficients, .. }) => {
                let unknown = coefficients.iter().flatten().any(|index| index.interval[0].is_nan());
                let why = match unknown {
                    true => {
                        " It has no intervals: they come from leaving out groups of runs, those of a motion together, and without some of these the factors cannot be told apart. More runs or motions give them."
                    }
                    false => "",
                };
                text.extend(regression(plan, f).map(|told| format!("{told}.{why}")));
            }
            Ok(_) => {}
        }
        if f.left_out > 0 {
            text.push(format!("{}: {} could not be used.", f.measure.name, counted(f.left_out, "run")));
        }
    }
    text
}

fn figure(plan: &Plan, found: &[Found]) -> Option<Figure> {
    let kind = found.iter().find_map(|f| f.indices.as_ref().ok())?;
    let legend = headings(kind);
    let bar = |index: &Option<Index>| index.map(|i| (i.value, i.interval));
    let group = |f: &Found| {
        let indices = f.indices.as_ref().ok()?;
        let unit = if matches!(indices, Indices::Morris(_)) { f.measure.unit } else { "" };
        let rows = tables::rows(indices).iter().map(|r| r.iter().take(legend.len()).map(bar).collect()).collect();
        Some(Group { heading: f.measure.text.to_string(), unit, rows })
    };
    let groups: Vec<Group> = found.iter().filter_map(group).collect();
    let factors: Vec<String> = plan.factors.iter().map(|f| f.name.clone()).collect();
    let caption = format!("Bars: {}; lines: their intervals.", legend.join(" (dark), "));
    let drawing =
        interval_bars::draw("Sensitivity of what was measured to the factors", legend, &factors, &groups, WIDTH);
    Some(Figure { name: "sensitivity".into(), caption, drawing })
}
