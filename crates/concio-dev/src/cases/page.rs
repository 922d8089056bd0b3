//! findings.json for people: a table for the terminal, a page in Markdown.

use std::fmt::Write as _;

use serde_json::Value;

use concio_cli::format::{self, columns, plain, significant};

/// For the terminal.
pub fn text(findings: &Value) -> String {
    let mut out = String::new();
    for (k, finding) in list(findings, "findings").enumerate() {
        let [answer, claim, figure] = ["answer", "claim", "figure"].map(|key| word(finding, key));
        let _ = writeln!(out, "{:>2}  {:<4}{claim} ({figure}; {})", k + 1, answer.to_uppercase(), votes(finding));
        let row = |n: &Value| vec![format!("      {}", word(n, "name")), value(n)];
        out.push_str(&columns(&list(finding, "numbers").map(row).collect::<Vec<_>>()));
        out.push('\n');
    }
    out.push_str("Under other settings:\n");
    let heads = (1..=list(findings, "findings").count()).map(|k| k.to_string());
    let mut rows = vec![[String::new()].into_iter().chain(heads).collect::<Vec<_>>()];
    for setting in list(findings, "settings") {
        let answers = answers(findings, setting).into_iter().map(str::to_string);
        rows.push([word(setting, "name").to_string()].into_iter().chain(answers).collect());
    }
    out + &columns(&rows)
}

/// The tables of docs/report-cases.md.
pub fn markdown(findings: &Value) -> String {
    let mut out =
        String::from("| | figure | the research report finds | here | runs that say so |\n|---|---|---|---|---|\n");
    for (k, finding) in list(findings, "findings").enumerate() {
        let [figure, claim, answer] = ["figure", "claim", "answer"].map(|key| word(finding, key));
        let _ = writeln!(out, "| {} | {figure} | {claim} | **{answer}** | {} |", k + 1, votes(finding));
    }
    out.push_str("\nThe numbers that decide, with the extremes of the perturbed runs:\n\n| of | number | value |\n|---|---|---|\n");
    // Findings may share a number.
    let mut rows: Vec<(String, String)> = Vec::new();
    for (k, finding) in list(findings, "findings").enumerate() {
        for number in list(finding, "numbers") {
            let row = format!("{} | {}", word(number, "name"), value(number));
            match rows.iter_mut().find(|(_, there)| *there == row) {
                Some((of, _)) => *of += &format!(", {}", k + 1),
                None => rows.push(((k + 1).to_string(), row)),
            }
        }
    }
    for (of, row) in rows {
        let _ = writeln!(out, "| {of} | {row} |");
    }
    out.push_str("\nWhat has to hold for a yes:\n\n");
    for (k, finding) in list(findings, "findings").enumerate() {
        let _ = writeln!(out, "{}. {}", k + 1, word(finding, "criterion"));
    }
    out.push_str(
        "\nUnder other settings, one run of each case (numbers in [report-cases.json](report-cases.json)):\n\n",
    );
    out.push_str("| setting | findings not confirmed |\n|---|---|\n");
    for setting in list(findings, "settings") {
        let answers = answers(findings, setting);
        let other = (1..).zip(answers).filter(|(_, answer)| *answer != "yes").map(|(k, _)| k.to_string());
        let other = other.collect::<Vec<_>>().join(", ");
        let _ = writeln!(out, "| {} | {} |", word(setting, "name"), if other.is_empty() { "none" } else { &other });
    }
    out + &accelerations(findings)
}

fn accelerations(findings: &Value) -> String {
    let mut out = String::from(
        "\nBed and support joints with the largest peak relative accelerations (mean of the perturbed runs), and the rank \
         correlation of all joints between two such runs:\n\n| case | joints | correlation |\n|---|---|---|\n",
    );
    for map in list(findings, "accelerations") {
        let joint = |j: &Value| {
            format!("`{}` {}", word(j, "joint").replace('|', "\\|"), short(real(j, "acceleration"), "m/s²"))
        };
        let joints: Vec<String> = list(map, "joints").take(3).map(joint).collect();
        let agreement = significant(real(map, "agreement"), 2);
        let _ = writeln!(out, "| {} | {} | {agreement} |", word(map, "case"), joints.join(", "));
    }
    out
}

fn list<'a>(value: &'a Value, key: &str) -> impl Iterator<Item = &'a Value> {
    value[key].as_array().into_iter().flatten()
}

fn word<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or("?")
}

fn real(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or(f64::NAN)
}

/// `5 of 5`: how many runs by themselves give the answer that is given.
fn votes(finding: &Value) -> String {
    let [yes, of] = ["yes", "of"].map(|key| finding["members"][key].as_u64().unwrap_or(0));
    format!("{} of {of}", if word(finding, "answer") == "yes" { yes } else { of - yes.min(of) })
}

fn answers<'a>(findings: &'a Value, setting: &'a Value) -> Vec<&'a str> {
    list(findings, "findings").map(|f| word(&setting["answers"][word(f, "id")], "answer")).collect()
}

/// `13.2 µm (12.4 µm … 14.5 µm)`.
fn value(number: &Value) -> String {
    let unit = word(number, "unit");
    let [value, low, high] = ["value", "low", "high"].map(|key| short(real(number, key), unit));
    if low == high { value } else { format!("{value} ({low} … {high})") }
}

/// Three digits: more than chaotic runs agree on. A ratio to what a run does not have (the force of no beam) is none.
fn short(value: f64, unit: &str) -> String {
    if !value.is_finite() {
        return "none".into();
    }
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if unit.is_empty() { plain(rounded) } else { format::short(rounded, unit) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(1.3234e-5, "m"), "13.2 µm");
        assert_eq!(short(8437.0, "m/s²"), "8.44 km/s²");
        assert_eq!(short(f64::NAN, ""), "none");
        assert_eq!((short(1317.0, ""), short(0.0, ""), short(0.0, "m")), ("1320".into(), "0".into(), "0 m".into()));
    }
}
