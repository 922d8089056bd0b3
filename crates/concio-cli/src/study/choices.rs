//! Named alternatives side by side: what was measured of each, over all runs that have it.

use concio_study::Plan;
use concio_study::factors::Over;
use concio_study::ida::curve::quantile;
use concio_study::table::{Cells, Table};

use super::interval_bars::{self, Group};
use super::page::Figure;

/// Measures that are drawn over the factors.
pub const DRAWN: [(&str, &str, &str); 4] = [
    ("peak_joint_displacement", "relative displacement", "m"),
    ("peak_joint_acceleration", "relative acceleration", "m/s²"),
    ("peak_drift", "drift", ""),
    ("friction_energy", "friction work", "J"),
];
/// Width of a figure [pt].
const WIDTH: f64 = 420.0;

/// One figure per factor whose values are names: medians, and the least and largest over the other factors.
pub fn figures(plan: &Plan, table: &Table) -> Vec<Figure> {
    let mut figures = Vec::new();
    for (index, factor) in plan.factors.iter().enumerate() {
        let Over::Levels(levels) = &factor.over else { continue };
        let column = table.columns.iter().find(|c| c.name == factor.name);
        let Some(Cells::Texts(cells)) = column.map(|c| &c.cells) else { continue };
        let names: Vec<String> = levels.iter().filter_map(|l| l.label.as_str().map(str::to_string)).collect();
        if names.len() != levels.len() || names.len() < 2 {
            continue;
        }
        let group = |(measure, quantity, unit): (&str, &str, &'static str)| {
            let values = table.column(measure)?;
            let of = |name: &String| {
                let mut found: Vec<f64> = cells
                    .iter()
                    .zip(values)
                    .filter(|(c, _)| c.as_ref() == Some(name))
                    .filter_map(|(_, v)| *v)
                    .collect();
                found.sort_by(f64::total_cmp);
                let ends = [*found.first()?, *found.last()?];
                Some((quantile(&found, 0.5), ends))
            };
            let rows: Vec<_> = names.iter().map(|name| vec![of(name)]).collect();
            let moved = rows.iter().flatten().flatten().any(|(v, _)| *v != 0.0);
            moved.then(|| Group { heading: quantity.into(), unit, rows })
        };
        let groups: Vec<Group> = DRAWN.into_iter().filter_map(group).collect();
        if groups.is_empty() {
            continue;
        }
        let title = format!("What was measured, by {}", factor.name);
        figures.push(Figure {
            name: format!("choice-{}", index + 1),
            caption: format!("By {}: bars are medians, lines reach from the least to the largest run.", factor.name),
            drawing: interval_bars::draw(&title, &["median"], &names, &groups, WIDTH),
        });
    }
    figures
}
