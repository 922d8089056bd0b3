//! findings.json for people: a table for the terminal, a page in Markdown.

use std::fmt::Write as _;

use serde_json::Value;

use crate::format::{plain, si, significant};

/// For the terminal.
pub fn text(findings: &Value) -> String {
    let mut out = String::new();
    for finding in list(findings, "findings") {
        let _ = writeln!(
            out,
            "{:<4}Figure {}: {}",
            word(finding, "answer"),
            word(finding, "figure"),
            word(finding, "claim")
        );
        for number in list(finding, "numbers") {
            let _ = writeln!(out, "      {:<62} {}", word(number, "name"), value(number));
        }
        let _ = writeln!(out, "      {} of {} perturbed runs say so\n", votes(finding), finding["members"]["of"]);
    }
    let _ = writeln!(out, "Under other settings ({}):", codes(findings));
    for setting in list(findings, "settings") {
        let answers = answers(findings, setting).into_iter().map(|a| format!("{a:<4}")).collect::<String>();
        let _ = writeln!(out, "  {:<38} {}", word(setting, "name"), answers.trim_end());
    }
    out
}

/// The tables of docs/report-cases.md.
pub fn markdown(findings: &Value) -> String {
    let mut out = String::from(
        "| figure | the report finds | here | what decides (lowest … highest of the perturbed runs) |\n|---|---|---|---|\n",
    );
    for finding in list(findings, "findings") {
        let numbers = list(finding, "numbers").map(|n| format!("{}: {}", word(n, "name"), value(n)));
        let (yes, of) = (votes(finding), &finding["members"]["of"]);
        let _ = writeln!(
            out,
            "| {} | {} | **{}**, {yes} of {of} | {} |",
            word(finding, "figure"),
            word(finding, "claim"),
            word(finding, "answer"),
            numbers.collect::<Vec<_>>().join("<br>")
        );
    }
    out.push_str("\n| criterion for a yes | |\n|---|---|\n");
    for finding in list(findings, "findings") {
        let _ = writeln!(out, "| {} | {} |", word(finding, "claim"), word(finding, "criterion"));
    }
    let heads = list(findings, "findings").map(|f| word(f, "figure")).collect::<Vec<_>>();
    let _ = writeln!(out, "\n| setting | {} |\n|---|{}", heads.join(" | "), "---|".repeat(heads.len()));
    for setting in list(findings, "settings") {
        let _ = writeln!(out, "| {} | {} |", word(setting, "name"), answers(findings, setting).join(" | "));
    }
    out.push_str("\n| texture | joints with the largest relative accelerations, mean of the perturbed runs | agreement of the runs |\n|---|---|---|\n");
    for map in list(findings, "accelerations") {
        let joint =
            |j: &Value| format!("`{}` {}", word(j, "joint").replace('|', "\\|"), si(real(j, "acceleration"), "m/s²"));
        let joints: Vec<String> = list(map, "joints").take(3).map(joint).collect();
        let _ = writeln!(
            out,
            "| {} | {} | {} |",
            word(map, "case"),
            joints.join(", "),
            significant(real(map, "agreement"), 2)
        );
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

/// How many perturbed runs give the answer that is given.
fn votes(finding: &Value) -> u64 {
    let [yes, of] = ["yes", "of"].map(|key| finding["members"][key].as_u64().unwrap_or(0));
    if word(finding, "answer") == "yes" { yes } else { of - yes.min(of) }
}

fn codes(findings: &Value) -> String {
    list(findings, "findings").map(|f| word(f, "figure")).collect::<Vec<_>>().join(", ")
}

fn answers<'a>(findings: &'a Value, setting: &'a Value) -> Vec<&'a str> {
    list(findings, "findings").map(|f| word(&setting["answers"][word(f, "id")], "answer")).collect()
}

/// `5.80 µm (5.79 … 5.81)`: three digits are more than chaotic runs agree on.
fn value(number: &Value) -> String {
    let unit = word(number, "unit");
    let [value, low, high] = ["value", "low", "high"].map(|key| real(number, key));
    let show = |v: f64| if unit.is_empty() { plain(rounded(v)) } else { si(rounded(v), unit) };
    if show(low) == show(high) { show(value) } else { format!("{} ({} … {})", show(value), show(low), show(high)) }
}

fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
