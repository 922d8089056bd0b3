//! Force of the top beam over its displacement.

use concio::InputError;
use concio::case::Beam;

use super::Options;
use super::data::Data;
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;

/// Horizontal force of the beam on the wall over the displacement of the beam relative to the base; of a beam that
/// moves with the base over that of the top course.
pub fn force(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let (channel, quantity) = match data.case.load.beam {
        Beam::Free => {
            return Err(InputError::new("the wall has no top beam, and no force at its top")
                .help("`beam = \"driven\"`, \"tied\" or { mass = … } under [load] gives it one"));
        }
        Beam::Tied => ("top/displacement", "displacement of top course"),
        Beam::Driven | Beam::Mass(_) => ("beam/displacement", "displacement of top beam"),
    };
    let missing = || InputError::new("the run did not keep the force and displacement of its top");
    let (u, f) = (data.channel(channel).ok_or_else(missing)?, data.channel("top/force").ok_or_else(missing)?);
    let panel = Panel {
        heading: String::new(),
        x: Axis { quantity: quantity.into(), unit: "m", ..Axis::default() },
        y: Axis { quantity: "force of top beam".into(), unit: "N", ..Axis::default() },
        lines: vec![Line { x: u.values.into(), y: f.values.into(), style: 0 }],
        rising: false,
        bare: false,
        marked: false,
    };
    Ok(chart::draw(&Sheet {
        title: "Horizontal force of the top beam on the wall over the displacement of the top relative to the base"
            .into(),
        legend: Vec::new(),
        panels: vec![panel],
        columns: 1,
        width: options.points(),
        height: Some(0.6 * options.points().min(360.0)),
    }))
}
