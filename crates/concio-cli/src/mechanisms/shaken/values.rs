//! Time histories for programs: JSON, and CSV of the histories.

use concio_mechanisms::rocking::{History, Peak, Stop};
use concio_study::table::Table;
use serde_json::{Value, json};

use super::text::beside;
use super::{Case, Followed, LIMITS, Shaken, Sign};

/// Everything but the histories, in SI.
pub fn json(shaken: &Shaken) -> Value {
    json!({
        "motion": shaken.motion,
        "factor": shaken.factor,
        "doubts": shaken.all_doubts(),
        "mechanisms": shaken.cases.iter().map(case).collect::<Vec<_>>(),
        "limits": LIMITS,
    })
}

fn case(case: &Case) -> Value {
    let found = case.found;
    let head = json!({ "kind": found.kind.name(), "counts": found.counts, "hinge": found.hinge, "multiplier": found.multiplier() });
    let mut value = head;
    match &case.followed {
        Err(why) => value["not_made"] = why.as_str().into(),
        Ok(followed) => {
            value["sets_off"] = followed.sets_off.into();
            value["restitution"] = followed.restitution.into();
            value["last_turn"] = followed.last.map(|last| last.rotation).into();
            value["last_displacement"] = followed.last.map(|last| last.displacement).into();
            value["life_safety_displacement"] = followed.life.into();
            value["signs"] = followed.signs.iter().map(|own| sign(followed, own)).collect();
            value["doubts"] = beside(case).into();
        }
    }
    value
}

fn sign(followed: &Followed, sign: &Sign) -> Value {
    let response = sign.response();
    let (verdict, words) = sign.outcome(followed.life);
    let [fell, runs] = sign.repeated.fell;
    let peak = |peak: &Peak| json!({ "turn": peak.rotation, "time": peak.time, "displacement": peak.displacement, "over_d0": peak.over_d0 });
    json!({
        "positive": sign.name().trim_start_matches("positive-"),
        "verdict": verdict,
        "outcome": words,
        "runs": runs,
        "fell": fell,
        "peak_turns": sign.repeated.peaks,
        "first_lift_off_factor": sign.lift_off.map(|l| l.scale),
        "first_lift_off_time": response.first_lift_off,
        "outwards": peak(&response.peak),
        "inwards": response.inwards.as_ref().map(peak),
        "fallen_at": match response.stop { Stop::Fallen { time, .. } => Some(time), _ => None },
        "impacts": response.counts.impacts,
        "beyond_d0": response.counts.beyond_d0,
        "energy_residual": response.relative_residual(),
        "ties": response.ties.iter().map(|t| json!({ "peak": t.peak, "set": t.set, "broke": t.broke })).collect::<Vec<_>>(),
    })
}

/// Names of files of histories, with them.
pub fn histories(shaken: &Shaken) -> Vec<(String, Table)> {
    let made = shaken.cases.iter().filter_map(|case| {
        let followed = case.followed.as_ref().ok()?;
        Some((format!("{}.csv", shaken.file(case)), table(followed)?))
    });
    made.collect()
}

/// Both signs side by side; a run that ends before the other leaves its cells empty.
fn table(followed: &Followed) -> Option<Table> {
    let of = |sign: &Sign| sign.response().history.clone();
    let histories: Vec<(&Sign, History)> = followed.signs.iter().filter_map(|sign| Some((sign, of(sign)?))).collect();
    let longest = histories.iter().map(|(_, history)| &history.time).max_by_key(|time| time.len())?;
    let mut table = Table::default();
    table.numbers("time", "s", longest.iter().map(|t| Some(*t)).collect());
    let filled = |values: &[f64]| {
        let empty = std::iter::repeat_n(None, longest.len() - values.len());
        values.iter().map(|v| Some(*v)).chain(empty).collect::<Vec<_>>()
    };
    for (sign, history) in &histories {
        let name = |what: &str| format!("{}/{what}", sign.name());
        table.numbers(name("ground"), "m/s2", filled(&history.ground));
        table.numbers(name("turn"), "rad", filled(&history.rotation));
        table.numbers(name("velocity"), "rad/s", filled(&history.velocity));
        table.numbers(name("displacement"), "m", filled(&history.displacement));
        let ties = sign.response().ties.len();
        for tie in 0..ties {
            let pulls: Vec<f64> = history.ties.iter().skip(tie).step_by(ties).copied().collect();
            table.numbers(name(&format!("tie-{}", tie + 1)), "N", filled(&pulls));
        }
    }
    Some(table)
}
