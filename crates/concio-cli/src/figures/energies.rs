//! Energies by mechanism over time.

use concio::InputError;

use super::Options;
use super::data::Data;
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;

/// Channels and what they are called.
const MECHANISMS: [(&str, &str); 9] = [
    ("input", "work done"),
    ("friction", "friction"),
    ("damping", "damping"),
    ("elastic", "elastic"),
    ("kinetic", "kinetic"),
    ("bond", "broken bonds"),
    ("device", "hysteresis of devices"),
    ("impact", "impacts"),
    ("nonreciprocal", "unbalanced friction"),
];

/// The account of energies, without mechanisms that stay at zero.
pub fn energies(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let found =
        MECHANISMS.iter().filter_map(|(channel, name)| Some((*name, data.channel(&format!("energy/{channel}"))?)));
    let found: Vec<_> = found.filter(|(_, h)| h.values.iter().any(|v| *v != 0.0)).collect();
    if found.is_empty() {
        return Err(InputError::new("no work is done in the time shown").key("--from, --to"));
    }
    let lines = found.iter().enumerate();
    let lines = lines.map(|(style, (_, h))| Line { x: (&h.time).into(), y: (&h.values).into(), style });
    let panel = Panel {
        heading: String::new(),
        x: Axis { quantity: "time".into(), unit: "s", ..Axis::default() },
        y: Axis { quantity: "energy".into(), unit: "J", ..Axis::default() },
        lines: lines.collect(),
        rising: true,
        bare: false,
        marked: false,
    };
    Ok(chart::draw(&Sheet {
        title: "Energies by mechanism over time".into(),
        legend: found.iter().map(|(name, _)| (*name).into()).collect(),
        panels: vec![panel],
        columns: 1,
        width: options.points(),
        height: Some(0.55 * options.points().min(360.0)),
    }))
}
