//! What every study shows: its runs, and how its factors move what was measured.

use concio_study::Plan;
use concio_study::table::Table;

use super::choices::DRAWN;
use super::page::{Figure, Section};
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};

/// Width of the figures [pt], and height of a plot.
const SIZE: [f64; 2] = [510.0, 120.0];
/// Factors that are drawn.
const MOST_FACTORS: usize = 8;

/// The table of all runs, and each of some measures over each factor that is a number.
pub fn runs(plan: &Plan, table: &Table) -> Section {
    let mut figures = super::choices::figures(plan, table);
    for (index, factor) in plan.factors.iter().enumerate().take(MOST_FACTORS) {
        let Some(x) = table.column(&factor.name) else { continue };
        let mut panels = Vec::new();
        for (name, quantity, unit) in DRAWN {
            let Some(y) = table.column(name) else { continue };
            let mut points: Vec<(f64, f64)> = x.iter().zip(y).filter_map(|(x, y)| Some(((*x)?, (*y)?))).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            if points.len() < 2 || points.iter().all(|p| p.1 == 0.0) || points[0].0 == points[points.len() - 1].0 {
                continue;
            }
            // Each run is a line without length: the mark at its end is all of it.
            let line = |(x, y): &(f64, f64)| Line { x: vec![*x].into(), y: vec![*y].into(), style: 0 };
            panels.push(Panel {
                heading: String::new(),
                x: Axis { quantity: label(&factor.name, &factor.unit), ..Axis::default() },
                y: Axis { quantity: quantity.into(), unit, ..Axis::default() },
                lines: points.iter().map(line).collect(),
                // Room at both ends: a mark on the frame would be cut in half.
                rising: false,
                bare: false,
                marked: true,
            });
        }
        if panels.is_empty() {
            continue;
        }
        let columns = panels.len().min(2);
        let title = format!("Runs over {}", factor.name);
        let sheet = Sheet { title, legend: Vec::new(), panels, columns, width: SIZE[0], height: Some(SIZE[1]) };
        figures.push(Figure {
            name: format!("factor-{}", index + 1),
            caption: format!("Every run, by {}.", factor.name),
            drawing: chart::draw(&sheet),
        });
    }
    Section {
        title: "Runs".into(),
        text: Vec::new(),
        figures,
        tables: vec![("All runs".into(), table.clone())],
        ..Section::default()
    }
}

/// A factor's name with the unit of its values.
pub fn label(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.into() } else { format!("{name} [{unit}]") }
}
