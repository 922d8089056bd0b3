//! Time histories on the page of a wall's mechanisms.

use std::borrow::Cow;

use concio_mechanisms::rocking::Stop;
use concio_study::table::Table;

use super::text::{beside, spread};
use super::{Case, Followed, LIMITS, Shaken, Sign};
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;
use crate::mechanisms::rows;
use crate::study::page::{Figure, Section};

/// Width and height of a history [pt].
const SIZE: [f64; 2] = [400.0, 110.0];
/// d0 beyond which a fall is not drawn on: it would hide what led to it.
const DRAWN: f64 = 1.3;
/// Way to one side over that to the other from which levels are drawn there.
const SEEN: f64 = 0.1;

/// The sections.
pub fn sections(shaken: &Shaken) -> Vec<Section> {
    let mut text = vec![format!("Motion: {}.", shaken.motion)];
    text.extend(shaken.all_doubts());
    text.extend(LIMITS.iter().map(|limit| limit.to_string()));
    let caption = "both signs of the motion; sets off: factor of this motion at which it first lifts off; spread: \
                   the motion times 0.999 to 1.001 and half of the step"
        .to_string();
    let mut sections = vec![Section {
        title: "Time history".into(),
        text,
        tables: vec![(caption, table(shaken))],
        ..Section::default()
    }];
    sections.extend(shaken.cases.iter().map(|case| section(shaken, case)));
    sections
}

fn section(shaken: &Shaken, case: &Case) -> Section {
    let figure = case.followed.as_ref().ok().map(|followed| Figure {
        name: shaken.file(case),
        caption: "Displacement of the control point, positive outwards. Beyond d_C0, where θ0 is reached, weights and thrusts alone hold the wall no longer; a fall is \
                  drawn to 1.3 d_C0."
            .into(),
        drawing: drawing(case, followed),
    });
    Section {
        title: format!("Time history: {}", rows::label(case.found)),
        text: beside(case),
        figures: figure.into_iter().collect(),
        ..Section::default()
    }
}

fn table(shaken: &Shaken) -> Table {
    let all: Vec<(&Case, &Followed, &Sign)> = shaken
        .cases
        .iter()
        .filter_map(|case| Some((case, case.followed.as_ref().ok()?)))
        .flat_map(|(case, followed)| followed.signs.iter().map(move |sign| (case, followed, sign)))
        .collect();
    type Of<'a, T> = &'a dyn Fn(&(&Case, &Followed, &Sign)) -> T;
    let texts = |of: Of<String>| all.iter().map(|row| Some(of(row))).collect();
    let numbers = |of: Of<Option<f64>>| all.iter().map(of).collect();
    let stood = |sign: &Sign| !sign.response().stop.fell();
    let mut table = Table::default();
    table.texts("mechanism", texts(&|(case, ..)| rows::label(case.found)));
    table.texts("counts", texts(&|(case, ..)| if case.found.counts { "yes" } else { "no" }.into()));
    table.texts("sign", texts(&|(.., sign)| sign.words()));
    table.numbers("sets_off", "", numbers(&|(.., sign)| sign.lift_off.map(|l| l.scale)));
    table.numbers("turn_over_theta_0", "", numbers(&|(.., sign)| sign.over_d0().filter(|_| stood(sign))));
    table.numbers("spread_from", "", numbers(&|(_, followed, sign)| spread(followed, sign).map(|s| s[0])));
    table.numbers("spread_to", "", numbers(&|(_, followed, sign)| spread(followed, sign).map(|s| s[1])));
    table.numbers("displacement", "m", numbers(&|(.., sign)| stood(sign).then(|| sign.displacement())));
    table.numbers("d_slv_control", "m", numbers(&|(_, followed, _)| followed.life));
    table.numbers("d_0_control", "m", numbers(&|(_, followed, _)| followed.last.map(|last| last.displacement)));
    table.texts("outcome", texts(&|(_, followed, sign)| sign.outcome(followed.life).1));
    table
}

fn drawing(case: &Case, followed: &Followed) -> Drawing {
    let last = followed.last.map(|last| last.displacement).filter(|last| *last > 0.0);
    // Outwards and inwards; d_SLV inwards is the same part of d0 there.
    let life = followed.life.map(|life| [Some(life), followed.last_inwards.zip(last).map(|(d, last)| life * d / last)]);
    let levels = [(Some([last, followed.last_inwards]), "d_C0"), (life, "d_SLV")];
    let mut legend = vec!["displacement".to_string()];
    legend.extend(levels.iter().map(|(_, name)| name.to_string()));
    let panel = |sign: &Sign| {
        let (x, y) = drawn(sign, last);
        let ends = [0.0, x.last().copied().unwrap_or(1.0)];
        let reached = sides(&y);
        let drawn_levels = levels.iter().enumerate().flat_map(|(k, (values, _))| {
            let values = values.unwrap_or_default().into_iter().zip(reached);
            values.filter(|(_, reached)| *reached).filter_map(move |(value, _)| Some((value?, k + 1)))
        });
        let level = |(level, style)| Line { x: ends.to_vec().into(), y: vec![level; 2].into(), style };
        let mut lines: Vec<Line> = drawn_levels.map(level).collect();
        lines.push(Line { x: Cow::Owned(x), y: Cow::Owned(y), style: 0 });
        Panel {
            heading: format!("{}: {}{}", sign.words(), sign.outcome(followed.life).1, ends_early(sign, ends[1])),
            x: Axis { quantity: "time".into(), unit: "s", range: None, logarithmic: false },
            y: Axis { quantity: "outwards".into(), unit: "m", range: None, logarithmic: false },
            lines,
            rising: true,
            bare: false,
            marked: false,
        }
    };
    chart::draw(&Sheet {
        title: format!("Time history of {}", rows::label(case.found)),
        legend,
        panels: followed.signs.iter().map(panel).collect(),
        columns: 1,
        width: SIZE[0],
        height: Some(SIZE[1]),
    })
}

/// Whether a curve goes outwards and inwards far enough for a level there to say something; one that rests does so outwards.
fn sides(y: &[f64]) -> [bool; 2] {
    let [low, high] = y.iter().fold([0.0f64; 2], |[low, high], u| [low.min(*u), high.max(*u)]);
    let most = high.max(-low);
    [high >= SEEN * most, most > 0.0 && -low >= SEEN * most]
}

/// What follows in a heading where a fall goes on after the time up to which it is drawn [s].
fn ends_early(sign: &Sign, drawn: f64) -> String {
    match sign.response().stop {
        Stop::Fallen { time, .. } if drawn < time => format!(", drawn until {drawn:.1} s"),
        _ => String::new(),
    }
}

/// The history as it is drawn: to the last motion, and of a fall to a little beyond d0.
fn drawn(sign: &Sign, last: Option<f64>) -> (Vec<f64>, Vec<f64>) {
    let Some(history) = &sign.response().history else { return Default::default() };
    let far = last.map_or(f64::INFINITY, |last| DRAWN * last);
    let inside = history.displacement.iter().take_while(|u| u.abs() <= far).count();
    let count = (inside + 1).min(history.time.len());
    let moved = history.displacement[..count].iter().rposition(|u| *u != 0.0).map_or(count, |k| k + 2);
    let shaken = history.ground.iter().rposition(|a| *a != 0.0).map_or(0, |k| k + 2);
    let count = count.min(moved.max(shaken));
    (history.time[..count].to_vec(), history.displacement[..count].to_vec())
}
