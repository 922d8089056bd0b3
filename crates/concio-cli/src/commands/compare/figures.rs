//! Histories of two runs over each other.

use super::side::Side;
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::study::page::Figure;

/// Width of the figures [pt], and height of a plot.
const SIZE: [f64; 2] = [510.0, 110.0];
/// Channels over time: name, heading, quantity, unit.
const HISTORIES: [(&str, &str, &str, &str); 5] = [
    ("base/acceleration", "acceleration of the base", "acceleration", "m/s²"),
    ("top/displacement", "mean displacement of the top, relative to the base", "displacement", "m"),
    ("peak/displacement", "largest displacement of a block, relative to the base", "displacement", "m"),
    ("base/shear", "base shear", "force", "N"),
    ("top/force", "force of the top beam", "force", "N"),
];
/// Energies: channel and heading.
const ENERGIES: [(&str, &str); 8] = [
    ("input", "work done on the wall"),
    ("friction", "friction"),
    ("damping", "damping"),
    ("kinetic", "kinetic energy"),
    ("elastic", "elastic energy"),
    ("bond", "broken bonds"),
    ("device", "hysteresis of devices"),
    ("impact", "impacts"),
];

/// All figures that the two runs have something for.
pub fn figures(sides: &[Side; 2], names: [&str; 2]) -> Vec<Figure> {
    let legend = names.map(String::from).to_vec();
    let time = |name: &str, heading: &str, quantity: &str, unit: &'static str| {
        let lines: Vec<Line> =
            sides.iter().enumerate().filter_map(|(style, side)| over_time(side, name, style)).collect();
        let moves = lines.iter().any(|line| line.y.iter().any(|v| *v != 0.0));
        moves.then(|| Panel {
            heading: heading.into(),
            x: Axis { quantity: "time".into(), unit: "s", ..Axis::default() },
            y: Axis { quantity: quantity.into(), unit, ..Axis::default() },
            lines,
            rising: true,
            bare: false,
            marked: false,
        })
    };
    let histories: Vec<Panel> =
        HISTORIES.iter().filter_map(|(name, heading, quantity, unit)| time(name, heading, quantity, unit)).collect();
    let energies: Vec<Panel> =
        ENERGIES.iter().filter_map(|(name, heading)| time(&format!("energy/{name}"), heading, "energy", "J")).collect();
    let all = [
        ("histories", "Motion and forces of both runs over time.", histories, 1, Some(SIZE[1])),
        (
            "loop",
            "Base shear over the mean displacement of the top.",
            looped(sides).into_iter().collect(),
            1,
            Some(2.5 * SIZE[1]),
        ),
        ("energies", "Energies of both runs over time.", energies, 2, Some(SIZE[1])),
    ];
    let figure = |(name, caption, mut panels, columns, height): (&str, &str, Vec<Panel>, usize, Option<f64>)| {
        if panels.is_empty() {
            return None;
        }
        let last = panels.len() - 1;
        if columns == 1 {
            // One axis of time below all.
            panels.iter_mut().take(last).for_each(|panel| panel.bare = true);
        }
        let sheet = Sheet { title: caption.into(), legend: legend.clone(), panels, columns, width: SIZE[0], height };
        Some(Figure { name: name.into(), caption: caption.into(), drawing: chart::draw(&sheet) })
    };
    all.into_iter().filter_map(figure).collect()
}

fn over_time<'s>(side: &'s Side, name: &str, style: usize) -> Option<Line<'s>> {
    let values = side.run.outcome.history(name)?;
    Some(Line { x: side.run.outcome.recording.time.as_slice().into(), y: values.into(), style })
}

fn looped(sides: &[Side; 2]) -> Option<Panel<'_>> {
    let line = |(style, side): (usize, &Side)| {
        let of = |name: &str| side.run.outcome.history(name);
        Some(Line { x: of("top/displacement")?.into(), y: of("base/shear")?.into(), style })
    };
    let lines: Vec<Line> = sides.iter().enumerate().filter_map(line).collect();
    lines.iter().any(|line| line.y.iter().any(|v| *v != 0.0)).then(|| Panel {
        heading: String::new(),
        x: Axis { quantity: "displacement of the top".into(), unit: "m", ..Axis::default() },
        y: Axis { quantity: "base shear".into(), unit: "N", ..Axis::default() },
        lines,
        rising: false,
        bare: false,
        marked: false,
    })
}
