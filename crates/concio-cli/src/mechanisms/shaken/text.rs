//! Time histories for the terminal.

use super::{Case, Followed, LIMITS, Shaken, Sign};
use crate::format::{columns, fixed, si, significant};
use crate::mechanisms::rows;

/// The table, and beside it what is doubtful.
pub fn told(shaken: &Shaken) -> String {
    let mut text = format!("\ntime history under {}\n", shaken.motion);
    shaken.doubts.iter().for_each(|doubt| text.push_str(&format!("  {doubt}\n")));
    let mut lines = vec![
        ["mechanism", "hinge", "positive", "sets off at", "turn/θ0", "its spread", "control point", "d_C0", "outcome"]
            .map(String::from)
            .to_vec(),
    ];
    for case in &shaken.cases {
        let Ok(followed) = &case.followed else { continue };
        lines.extend(followed.signs.iter().map(|sign| row(case, followed, sign)));
    }
    if lines.len() > 1 {
        text.push_str(&columns(&lines));
        if !shaken.all {
            text.push_str("  the least of each kind; --all follows every hinge level\n");
        }
        text.push_str("  positive: the side to which positive values of the motion point; a façade does not know the sign of a record\n");
        text.push_str(
            "  d_C0: where the control point is at θ0; d0 of the other table is that of the equivalent oscillator\n",
        );
        text.push_str("  sets off at: the factor of this motion at which it first lifts off\n");
        text.push_str("  spread: six runs, the motion times 0.999 to 1.001 and with half of the step; turns are outwards, or inwards if farther\n");
    }
    for case in &shaken.cases {
        let lines = beside(case);
        if !lines.is_empty() {
            text.push_str(&format!("\n{}\n", rows::label(case.found)));
            lines.iter().for_each(|line| text.push_str(&format!("  {line}\n")));
        }
    }
    text.push_str("\nwhat a time history does not say\n");
    LIMITS.iter().for_each(|limit| text.push_str(&format!("  {limit}\n")));
    text
}

fn row(case: &Case, followed: &Followed, sign: &Sign) -> Vec<String> {
    let mark = if case.found.counts { "" } else { " (for comparison)" };
    let dash = || "–".to_string();
    let fell = sign.response().stop.fell();
    vec![
        format!("{} ({}){mark}", case.found.kind.what(), case.found.kind.equation()),
        format!("{} m", fixed(case.found.hinge, 2)),
        sign.name().trim_start_matches("positive-").into(),
        sign.lift_off.map_or_else(dash, |lift_off| format!("× {}", significant(lift_off.scale, 3))),
        sign.over_d0().filter(|_| !fell).map_or_else(dash, |over| fixed(over, 3)),
        spread(followed, sign).map_or_else(dash, |[low, high]| format!("{} … {}", fixed(low, 3), fixed(high, 3))),
        if fell { dash() } else { si(sign.displacement(), "m") },
        followed.last.map_or_else(dash, |last| si(last.displacement, "m")),
        sign.outcome(followed.life).1,
    ]
}

/// Least and largest turn over θ0 of the runs that stood.
pub fn spread(followed: &Followed, sign: &Sign) -> Option<[f64; 2]> {
    let last = followed.last.filter(|last| last.rotation > 0.0)?;
    sign.repeated.peaks.map(|peaks| peaks.map(|peak| peak / last.rotation))
}

/// What stands beside the numbers of a mechanism.
pub fn beside(case: &Case) -> Vec<String> {
    let followed = match &case.followed {
        Ok(followed) => followed,
        Err(why) => return vec![format!("no time history: {why}")],
    };
    let mut lines = vec![format!(
        "sets off at α = {}, α0 = {}; e = {}{}",
        significant(followed.sets_off, 4),
        significant(case.found.multiplier(), 4),
        fixed(followed.restitution, 3),
        followed.life.map_or(String::new(), |life| format!("; control point at d_SLV: {}", si(life, "m")))
    )];
    lines.extend(followed.notes.iter().cloned());
    for sign in &followed.signs {
        lines.extend(sign.repeated.doubts().into_iter().map(|doubt| format!("{}: {doubt}", sign.words())));
    }
    lines
}
