//! The page of a wall's mechanisms, for a report.

use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::Found;
use concio_study::table::Table;

use super::{LIMITS, Subject, figures, numbers, rows};
use crate::draw::out_of_plane;
use crate::format::{fixed, si, significant};
use crate::study::page::{Figure, Section};

/// What stands at the head.
pub fn facts(subject: &Subject) -> Vec<(&'static str, String)> {
    let Subject { wall, survey, overlaps, .. } = subject;
    let t = wall.masonry.thickness;
    let mut facts = vec![
        (
            "wall",
            format!(
                "{} long, {} high, {} thick, {} of masonry",
                si(wall.length(), "m"),
                si(wall.top, "m"),
                si(t, "m"),
                si(wall.masonry.above(0.0).weight, "N")
            ),
        ),
        ("texture", format!("courses of {}, overlap {}", si(wall.texture[0], "m"), si(wall.texture[1], "m"))),
        ("factors", format!("FC {}, q {}", significant(wall.confidence, 3), significant(wall.behaviour, 3))),
        (
            "friction of side walls",
            match overlaps {
                Overlaps::Summed => "f = ½, the sum over courses".into(),
                _ => "f = 0.4 of the code".into(),
            },
        ),
    ];
    if let Some(least) = survey.least() {
        facts.push(("least α0", format!("{} ({})", significant(least.multiplier(), 4), rows::label(least))));
    }
    match survey.worst().and_then(|w| Some((w, w.checks.ratio()?))) {
        Some((worst, ratio)) => {
            let said = if ratio >= 1.0 { "satisfied" } else { "not satisfied" };
            facts.push((
                "worst check for life safety",
                format!("{} of what is asked ({}): {said}", fixed(ratio, 3), rows::label(worst)),
            ));
        }
        None => facts.push(("checks", "none: the wall file gives no site".into())),
    }
    facts
}

/// The sections of the page.
pub fn sections(subject: &Subject) -> Vec<Section> {
    let mut sections = vec![limits(), assumed(subject), all(subject)];
    sections.extend(subject.survey.least_of_kinds().iter().map(|found| mechanism(subject, found)));
    sections.push(without(subject));
    sections
}

fn limits() -> Section {
    let text = LIMITS.iter().map(|l| l.to_string()).collect();
    Section { title: "What to know before the numbers are believed".into(), text, ..Section::default() }
}

fn assumed(subject: &Subject) -> Section {
    let mut table = Table::default();
    let of = &subject.wall.assumed;
    table.texts("key of the wall file", of.iter().map(|a| Some(a.key.clone())).collect());
    table.texts("assumed", of.iter().map(|a| Some(a.what.clone())).collect());
    let text =
        vec!["The wall file does not say these things, or they are taken otherwise than it may mean them.".into()];
    Section { title: "Assumed".into(), text, tables: vec![("assumptions".into(), table)], ..Section::default() }
}

fn all(subject: &Subject) -> Section {
    let caption = "every mechanism at every hinge level; ratios are capacity over demand".to_string();
    let text = vec![
        "A mechanism that does not count stands for comparison: the wall cannot have it as it is. For life safety one of both checks suffices, \
         the linear one or that by displacement."
            .into(),
    ];
    Section { title: "Mechanisms".into(), text, tables: vec![(caption, rows::table(subject))], ..Section::default() }
}

fn mechanism(subject: &Subject, found: &Found) -> Section {
    let label = rows::label(found);
    let name = found.kind.name();
    let text =
        std::iter::once(format!("α0 = {}, made up of {}.", significant(found.multiplier(), 5), rows::governed(found)))
            .chain(found.notes.iter().cloned())
            .collect();
    let drawing = Figure {
        name: name.into(),
        caption: "Elevation and section, to scale; the turn is enlarged. Red: hinges. Dashed: cracks.".into(),
        drawing: out_of_plane::draw(subject.wall, found),
    };
    let curve = Figure {
        name: format!("{name}-pushover"),
        caption: "α over the displacement of the equivalent oscillator, by exact kinematics".into(),
        drawing: figures::curve(found),
    };
    Section {
        title: format!("{label} ({})", found.kind.equation()),
        text,
        figures: vec![drawing, curve],
        tables: vec![("every number with its formula and source".into(), numbers::table(subject.wall, found))],
        ..Section::default()
    }
}

fn without(subject: &Subject) -> Section {
    let mut table = Table::default();
    let of = &subject.survey.without;
    table.texts("mechanism", of.iter().map(|(kind, _)| Some(kind.what().into())).collect());
    table.texts("why not", of.iter().map(|(_, why)| Some(why.clone())).collect());
    let text = vec!["Data that the wall file lacks may be the reason: give them, and look again.".into()];
    Section {
        title: "Mechanisms that this wall cannot have".into(),
        text,
        tables: vec![("kinds".into(), table)],
        ..Section::default()
    }
}
