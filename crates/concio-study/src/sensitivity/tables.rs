//! The table of the indices: one line per measure and factor.

use super::{Found, Index, Indices};
use crate::Plan;
use crate::table::Table;

/// Names of the indices of a design, in the order of [`rows`].
pub fn names(indices: &Indices) -> &'static [&'static str] {
    match indices {
        Indices::Morris(_) => &["mu_star", "sigma", "mu"],
        Indices::Sobol(_) => &["total", "first_order"],
        Indices::Ranks { .. } => &["rank_coefficient"],
    }
}

/// The indices of every factor, in the order of [`names`].
pub fn rows(indices: &Indices) -> Vec<Vec<Option<Index>>> {
    match indices {
        Indices::Morris(all) => all.iter().map(|e| vec![Some(e.absolute), Some(e.deviation), Some(e.mean)]).collect(),
        Indices::Sobol(all) => all.iter().map(|s| vec![Some(s.total), Some(s.first)]).collect(),
        Indices::Ranks { coefficients, .. } => coefficients.iter().map(|c| vec![*c]).collect(),
    }
}

/// Factors that a rank regression leaves out since their values have no order.
pub fn left_out<'p>(plan: &'p Plan, indices: &Indices) -> Vec<&'p str> {
    match indices {
        Indices::Ranks { .. } => plan.factors.iter().filter(|f| !f.is_ordered()).map(|f| f.name.as_str()).collect(),
        _ => Vec::new(),
    }
}

/// What is to be known of a factor's index: why there is none, or what is left out of it.
fn note(plan: &Plan, indices: &Indices, place: usize) -> Option<String> {
    let Indices::Ranks { coefficients, .. } = indices else { return None };
    if coefficients[place].is_some() {
        let out = left_out(plan, indices);
        return (!out.is_empty()).then(|| format!("of a regression without {}", out.join(", ")));
    }
    Some(match plan.factors[place].is_ordered() {
        true => "it has one value in the runs that could be used".into(),
        false => "its values are names, or have several units: ranks of them mean nothing".into(),
    })
}

/// All indices with their intervals. Elementary effects have the unit of their measure, given in a column of its own; beside rank
/// coefficients stands R² of their regression.
pub fn table(plan: &Plan, found: &[Found]) -> Table {
    let mut table = Table::default();
    let Some(kinds) = found.iter().find_map(|f| f.indices.as_ref().ok()).map(names) else {
        table.texts("measure", found.iter().map(|f| Some(f.measure.name.into())).collect());
        table.texts("note", found.iter().map(|f| f.indices.as_ref().err().cloned()).collect());
        return table;
    };
    let (mut measure, mut unit, mut factor, mut notes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut explained: Vec<Option<f64>> = Vec::new();
    let mut cells: Vec<Vec<Option<f64>>> = vec![Vec::new(); 3 * kinds.len()];
    for f in found {
        let rows = f.indices.as_ref().map(rows).unwrap_or_default();
        for (k, of) in plan.factors.iter().enumerate() {
            measure.push(Some(f.measure.name.to_string()));
            unit.push(Some(f.measure.unit.to_string()));
            factor.push(Some(of.name.clone()));
            notes.push(f.indices.as_ref().map_or_else(|cause| Some(cause.clone()), |i| note(plan, i, k)));
            explained.push(match f.indices {
                Ok(Indices::Ranks { explained, .. }) => Some(explained),
                _ => None,
            });
            for i in 0..kinds.len() {
                let index = rows.get(k).and_then(|r| r[i]);
                let all = index.map(|x| [x.value, x.interval[0], x.interval[1]]);
                for (j, column) in cells[3 * i..3 * i + 3].iter_mut().enumerate() {
                    column.push(all.map(|v| v[j]).filter(|v| v.is_finite()));
                }
            }
        }
    }
    table.texts("measure", measure);
    if matches!(kinds, ["mu_star", ..]) {
        table.texts("unit", unit);
    }
    table.texts("factor", factor);
    let mut cells = cells.into_iter();
    for name in kinds {
        for part in ["", "_low", "_high"] {
            table.numbers(format!("{name}{part}"), "", cells.next().unwrap_or_default());
        }
    }
    if matches!(kinds, ["rank_coefficient"]) {
        table.numbers("r_squared", "", explained);
    }
    table.texts("note", notes);
    table
}
