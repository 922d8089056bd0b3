//! Pushover curves of mechanisms.

use std::borrow::Cow;

use concio_mechanisms::survey::Found;

use super::rows;
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;

/// Width and height of a curve [pt].
const SIZE: [f64; 2] = [340.0, 150.0];

/// α over the displacement of the control point: all that acts, and what surely acts till collapse.
pub fn curve(found: &Found) -> Drawing {
    let points = found.pushover.curve();
    let x: Vec<f64> = points.iter().map(|p| p.displacement).collect();
    let all: Vec<f64> = points.iter().map(|p| p.multiplier).collect();
    let sure: Vec<f64> = points.iter().map(|p| p.sure).collect();
    let differs = all.iter().zip(&sure).any(|(a, b)| (a - b).abs() > 1e-12);
    let mut lines = Vec::new();
    let mut legend = Vec::new();
    if differs {
        lines.push(Line { x: Cow::Borrowed(&x), y: Cow::Borrowed(&sure), style: 1 });
        legend = vec!["with ties and friction".to_string(), "weights and thrusts alone".to_string()];
    }
    lines.push(Line { x: Cow::Borrowed(&x), y: Cow::Borrowed(&all), style: 0 });
    let label = rows::label(found);
    chart::draw(&Sheet {
        title: format!("Pushover of {label}"),
        legend,
        panels: vec![Panel {
            heading: String::new(),
            x: Axis { quantity: "d of the oscillator".into(), unit: "m", range: None, logarithmic: false },
            y: Axis { quantity: "α".into(), unit: "", range: None, logarithmic: false },
            lines,
            rising: true,
            bare: false,
            marked: false,
        }],
        columns: 1,
        width: SIZE[0],
        height: Some(SIZE[1]),
    })
}
