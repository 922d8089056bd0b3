//! Findings applied to the runs, as findings.json keeps them.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use super::findings::{FINDINGS, Finding, Number, Set};
use super::jobs::Job;
use super::measures::{Measures, median, rank_correlation};
use super::walls::{MEMBERS, Setting, Which};

/// What findings.json says it is.
pub const FORMAT: &str = "concio-findings";
/// Version of findings.json; raised when readers of the former would misread it.
const FORMAT_VERSION: u32 = 1;

/// The content of findings.json. Every number is the median over the members of the wall files, `low` and `high` the
/// extremes, `runs` the members themselves, the unchanged wall files first; the answer is the criterion applied to the
/// medians, `members.yes` to each member by itself.
pub fn of(runs: &BTreeMap<Job, Measures>) -> Value {
    let findings: Vec<Value> = FINDINGS.iter().map(|f| answer(f, runs)).collect();
    let settings: Vec<Value> = Setting::ALL.iter().map(|s| under(*s, runs)).collect();
    json!({
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "version": env!("CARGO_PKG_VERSION"),
        "runs": runs.len(),
        "largest_energy_residual": runs.values().map(|m| m.residual).fold(0.0, f64::max),
        "findings": findings,
        "settings": settings,
        "accelerations": [accelerations(runs, Which::One), accelerations(runs, Which::Two)],
    })
}

fn set(runs: &BTreeMap<Job, Measures>, setting: Setting, member: usize) -> Option<Set<'_>> {
    let of = |which| runs.get(&Job { setting, which, member });
    Some(Set {
        one: of(Which::One)?,
        two: of(Which::Two)?,
        three: of(Which::Three)?,
        four: of(Which::Four)?,
        five: of(Which::Five)?,
        control: of(Which::Control)?,
    })
}

fn answer(finding: &Finding, runs: &BTreeMap<Job, Measures>) -> Value {
    let members: Vec<Set> = (0..MEMBERS).filter_map(|m| set(runs, Setting::Files, m)).collect();
    let rows: Vec<Vec<f64>> = members.iter().map(|m| values(finding, m)).collect();
    let names = members.first().map(|m| (finding.numbers)(m)).unwrap_or_default();
    let columns = |k: usize| rows.iter().map(|r| r[k]).collect::<Vec<f64>>();
    let medians: Vec<f64> = (0..names.len()).map(|k| median(&columns(k))).collect();
    let number = |(k, n): (usize, &Number)| {
        let runs = columns(k);
        let [low, high] = [f64::min, f64::max].map(|pick| runs.iter().copied().reduce(pick));
        json!({ "name": n.name, "unit": n.unit, "value": medians[k], "low": low, "high": high, "runs": runs })
    };
    let numbers: Vec<Value> = names.iter().enumerate().map(number).collect();
    let yes = rows.iter().filter(|r| (finding.holds)(r)).count();
    json!({
        "id": finding.id,
        "figure": finding.figure,
        "claim": finding.claim,
        "criterion": finding.criterion,
        "answer": if (finding.holds)(&medians) { "yes" } else { "no" },
        "members": { "yes": yes, "of": rows.len() },
        "numbers": numbers,
    })
}

fn values(finding: &Finding, set: &Set) -> Vec<f64> {
    (finding.numbers)(set).iter().map(|n| n.value).collect()
}

/// Answers under another setting, from one run of each case.
fn under(setting: Setting, runs: &BTreeMap<Job, Measures>) -> Value {
    let mut answers = Map::new();
    if let Some(set) = set(runs, setting, 0) {
        for finding in &FINDINGS {
            let values = values(finding, &set);
            let answer = if (finding.holds)(&values) { "yes" } else { "no" };
            answers.insert(finding.id.into(), json!({ "answer": answer, "numbers": values }));
        }
    }
    json!({ "name": setting.name(), "answers": answers })
}

/// Peak relative accelerations of the bed and support joints, the largest first; mean over the members, because the
/// peak of one chaotic run is partly chance. `agreement` is the mean rank correlation of two members.
fn accelerations(runs: &BTreeMap<Job, Measures>, which: Which) -> Value {
    let of = |member| runs.get(&Job { setting: Setting::Files, which, member });
    let members: Vec<Vec<f64>> =
        (0..MEMBERS).filter_map(of).map(|m| m.accelerations.iter().map(|(_, a)| *a).collect()).collect();
    let names: Vec<&String> = of(0).iter().flat_map(|m| m.accelerations.iter().map(|(n, _)| n)).collect();
    let count = members.len().max(1) as f64;
    let means: Vec<f64> = (0..names.len()).map(|e| members.iter().map(|m| m[e]).sum::<f64>() / count).collect();
    let agreement = pairwise(&members);
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by(|a, b| means[*b].total_cmp(&means[*a]));
    let joints: Vec<Value> = order.iter().map(|&e| json!({ "joint": names[e], "acceleration": means[e] })).collect();
    json!({ "case": which.name(), "agreement": agreement, "joints": joints })
}

fn pairwise(members: &[Vec<f64>]) -> f64 {
    let pairs = (0..members.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    let found: Vec<f64> = pairs.map(|(a, b)| rank_correlation(&members[a], &members[b])).collect();
    found.iter().sum::<f64>() / found.len().max(1) as f64
}
