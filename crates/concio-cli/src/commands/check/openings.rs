//! Doors and windows as `concio check` tells them.

use concio::Result;
use concio::case::{Bond, Case};
use concio::pattern::{self, Jamb, Laid};

use crate::format::{columns, short};

/// Where the openings of a wall lie, what became of blocks for them, and whether their jambs are straight; nothing for a wall
/// without.
pub fn told(case: &Case) -> Result<String> {
    let openings = pattern::openings(case)?;
    if openings.is_empty() {
        return Ok(String::new());
    }
    let mut rows =
        vec![["openings", "from left, base", "size", "lintel", "blocks", "jambs"].map(String::from).to_vec()];
    rows.extend(openings.iter().map(row));
    let notes: String = openings.iter().flat_map(|o| notes(case, o)).map(|note| format!("  {note}\n")).collect();
    Ok(format!("{}{notes}\n", columns(&rows)))
}

/// As its lintel is called.
fn name(opening: &Laid) -> String {
    format!("p{}o{}", opening.panel + 1, opening.number + 1)
}

fn row(opening: &Laid) -> Vec<String> {
    let length = |v: f64| short(v, "m");
    let size = |[x, y]: [f64; 2]| format!("{} × {}", length(x), length(y));
    let Laid { x, y, lintel, removed, cut, jambs, .. } = opening;
    vec![
        name(opening),
        format!("{}, {}", length(x[0]), length(y[0])),
        size([x[1] - x[0], y[1] - y[0]]),
        lintel.map_or("none".into(), size),
        format!("{removed} left out, {cut} cut"),
        sides(jambs),
    ]
}

/// `straight`, or which jamb is not.
fn sides(jambs: &[Option<Jamb>; 2]) -> String {
    let ragged = |(side, jamb): (&str, &Option<Jamb>)| {
        let jamb = jamb.filter(|jamb| jamb.short > 0)?;
        Some(format!("{side} ragged by {}", short(jamb.by, "m")))
    };
    let ragged: Vec<String> = ["left", "right"].into_iter().zip(jambs).filter_map(ragged).collect();
    match (ragged.is_empty(), jambs.iter().any(Option::is_some)) {
        (false, _) => ragged.join(", "),
        (true, true) => "straight".into(),
        (true, false) => "none".into(),
    }
}

/// Why a jamb is not straight, and what was moved.
fn notes(case: &Case, opening: &Laid) -> Vec<String> {
    let name = name(opening);
    let by_bricks = match case.panels[opening.panel].bond {
        Bond::Running => "; widths in half bricks (`x = \"2.5 bricks\"`) and `snap = true` make jambs straight",
        Bond::Stack => "; widths in bricks (`x = \"2 bricks\"`) and `snap = true` make jambs straight",
        _ => "",
    };
    let ragged = |(side, jamb): (&str, &Option<Jamb>)| {
        let Jamb { courses, short: ends, .. } = jamb.filter(|jamb| jamb.short > 0)?;
        Some(format!(
            "{name}: in {ends} of {courses} courses its {side} side lies in a head joint, or would leave a rest no longer than the mortar, \
             which is left out{by_bricks}"
        ))
    };
    let moved = |(what, by): &(&str, f64)| {
        let (size, way) = (short(by.abs(), "m"), if *by > 0.0 { "up" } else { "down" });
        let way = match *what {
            "the left side" | "the right side" => {
                if *by > 0.0 {
                    "to the right"
                } else {
                    "to the left"
                }
            }
            "the bearing" => {
                if *by > 0.0 {
                    "outwards"
                } else {
                    "inwards"
                }
            }
            _ => way,
        };
        format!("{name}: `snap` moved {what} by {size} {way}")
    };
    let sides = ["left", "right"].into_iter().zip(&opening.jambs);
    opening.moved.iter().map(moved).chain(sides.filter_map(ragged)).collect()
}
