//! The table of the indices: one line per measure and factor.

use super::{Found, Index, Indices};
use crate::Plan;
use crate::factors::Factor;
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

/// Why a factor has no index beside others that have one.
fn silent(indices: &Indices, place: usize, factor: &Factor) -> Option<String> {
    match indices {
        Indices::Ranks { coefficients, .. } if coefficients[place].is_none() => Some(match factor.is_ordered() {
            true => "it has one value in the runs that could be used".into(),
            false => "its values are names, or have several units: ranks of them mean nothing".into(),
        }),
        _ => None,
    }
}

/// All indices with their intervals. Elementary effects have the unit of their measure, given in a column of its own.
pub fn table(plan: &Plan, found: &[Found]) -> Table {
    let mut table = Table::default();
    let Some(kinds) = found.iter().find_map(|f| f.indices.as_ref().ok()).map(names) else {
        table.texts("measure", found.iter().map(|f| Some(f.measure.name.into())).collect());
        table.texts("note", found.iter().map(|f| f.indices.as_ref().err().cloned()).collect());
        return table;
    };
    let (mut measure, mut unit, mut factor, mut note) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut cells: Vec<Vec<Option<f64>>> = vec![Vec::new(); 3 * kinds.len()];
    for f in found {
        let rows = f.indices.as_ref().map(rows).unwrap_or_default();
        for (k, of) in plan.factors.iter().enumerate() {
            measure.push(Some(f.measure.name.to_string()));
            unit.push(Some(f.measure.unit.to_string()));
            factor.push(Some(of.name.clone()));
            note.push(f.indices.as_ref().map_or_else(|cause| Some(cause.clone()), |i| silent(i, k, of)));
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
    table.texts("note", note);
    table
}
