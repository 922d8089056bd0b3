//! What the terminal is told.

use std::fmt::Display;

use concio_mechanisms::checks::Missing;
use concio_mechanisms::survey::Found;

use super::{LIMITS, Subject, rows};
use crate::format::{columns, fixed, si, significant};

/// The table, what governs, what is assumed and what the wall cannot have.
pub fn told(subject: &Subject, all: bool) -> String {
    let survey = subject.survey;
    let chosen: Vec<&Found> = if all { survey.found.iter().collect() } else { survey.least_and_worst() };
    let checked = survey.found.iter().any(|f| f.checks.ratio().is_some() || f.checks.damage.is_ok());
    let mut text = columns(&table(&chosen, checked));
    if !all {
        let worst = if chosen.len() > survey.least_of_kinds().len() { ", and the worst check" } else { "" };
        text.push_str(&format!("  the least of each kind{worst}; --all prints every hinge level\n"));
    }
    text.push('\n');
    if let Some(least) = survey.least() {
        text.push_str(&format!("least α0: {} = {}\n", rows::label(least), significant(least.multiplier(), 4)));
        text.push_str(&format!("  made up of {}\n", rows::governed(least)));
    }
    if let Some(worst) = survey.worst() {
        let ratio = worst.checks.ratio().unwrap_or(0.0);
        let said = if ratio >= 1.0 { "satisfied" } else { "not satisfied" };
        text.push_str(&format!(
            "worst check (SLV): {}, {} of what is asked: {said}\n",
            rows::label(worst),
            fixed(ratio, 3)
        ));
    }
    for found in chosen {
        let curve = subject.trilinear.and_then(|parts| found.pushover.trilinear(parts));
        let plateau = curve.map(|t| {
            let [from, to] = t.ends.map(|d| si(d, "m"));
            let a = si(found.pushover.acceleration(t.plateau, found.confidence), "m/s²");
            format!("trilinear: α = {} from d = {from} to {to}, a = {a}", significant(t.plateau, 4))
        });
        let notes: Vec<&String> = found.notes.iter().chain(&plateau).collect();
        if !notes.is_empty() {
            text.push_str(&format!("\n{}\n", rows::label(found)));
            notes.iter().for_each(|note| text.push_str(&format!("  {note}\n")));
        }
    }
    list(
        &mut text,
        "mechanisms that this wall cannot have",
        survey.without.iter().map(|(kind, why)| format!("{}: {why}", kind.what())),
    );
    list(&mut text, "assumed", subject.wall.assumed.iter().map(|a| format!("{}: {}", a.key, a.what)));
    text.push_str("\nwhat not to believe\n");
    text.push_str(&format!("  {}\n  {}\n", LIMITS[0], LIMITS[1]));
    text
}

fn list(text: &mut String, head: &str, lines: impl Iterator<Item = String>) {
    let lines: Vec<String> = lines.collect();
    if !lines.is_empty() {
        text.push_str(&format!("\n{head}\n"));
        lines.iter().for_each(|line| text.push_str(&format!("  {line}\n")));
    }
}

fn table(chosen: &[&Found], checked: bool) -> Vec<Vec<String>> {
    let mut head = vec!["mechanism", "hinge", "tan β or ϑ", "α0", "e*", "a*", "d0"];
    if checked {
        head.extend(["SLD", "SLV, q", "SLV, d", "SLC, d"]);
    }
    let mut lines = vec![head.into_iter().map(String::from).collect::<Vec<_>>()];
    for found in chosen {
        let pushover = &found.pushover;
        let mark = if found.counts { "" } else { " (for comparison)" };
        let slopes = match found.slopes[..] {
            [] => "–".into(),
            ref own if own.iter().all(|s| *s == own[0]) => slope(own[0]),
            ref own => own.iter().map(|s| slope(*s)).collect::<Vec<_>>().join(" "),
        };
        let mut line = vec![
            format!("{} ({}){mark}", found.kind.what(), found.kind.equation()),
            format!("{} m", fixed(found.hinge, 2)),
            slopes,
            significant(found.multiplier(), 4),
            fixed(pushover.participation, 3),
            si(found.checks.acceleration, "m/s²"),
            si(pushover.last, "m"),
        ];
        if checked {
            let c = &found.checks;
            line.push(ratio(c.damage.map(|c| c.ratio())));
            line.push(ratio(c.life.map(|c| c.ratio())));
            line.push(ratio(c.life_displacement.map(|c| c.ratio)));
            line.push(ratio(c.collapse.map(|c| c.ratio)));
        }
        lines.push(line);
    }
    lines
}

/// tan β or tan ϑ in words: a level hinge has none.
pub(super) fn slope(value: f64) -> String {
    rows::tangent(value).map_or_else(|| "90°".into(), |tan| fixed(tan, 3))
}

fn ratio(check: Result<f64, Missing>) -> String {
    let short = |why: Missing| -> &dyn Display {
        match why {
            Missing::Hazard => &"–",
            Missing::FloorSpectrum => &"no S_eZ",
            Missing::Stands | Missing::Capacity => &"0",
        }
    };
    check.map_or_else(|why| short(why).to_string(), |v| fixed(v, 3))
}
