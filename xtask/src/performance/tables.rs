//! The tables of docs/performance.md.

use std::fmt::Write;

use super::PRINTED;
use super::cases::{self, BASELINE, Case, Judge};
use super::measure::{Measured, Performance, Timed, baseline};
use super::programs::Method;

/// How much faster than CVODE a case is meant to be, and what is aimed at.
const ASKED: [(&str, f64, Option<f64>); 3] =
    [("slipping", 15.0, Some(50.0)), ("shaken", 10.0, Some(30.0)), ("large", 10.0, None)];
/// Tolerance of a wall file that gives none.
const DEFAULT: f64 = 1e-2;
/// Least tolerance in a table; the diagrams have the runs below it too.
const FINEST: f64 = 1e-4;

/// Machine, summary, and a section per case.
pub fn all(all: &Performance) -> String {
    let mut text = machine(all);
    let known = cases::all(false);
    let measured = || known.iter().filter_map(|c| all.cases.get(c.name).map(|m| (c, m)));
    text += "\n## Against CVODE\n\n";
    text += &summary(measured());
    for (case, measured) in measured() {
        let _ = write!(text, "\n## {}\n\n{}", heading(case.name), section(case, measured));
    }
    for (name, title) in PRINTED {
        if let Some(printed) = all.printed.get(name) {
            let on = if printed.processor.is_empty() { String::new() } else { format!(", {}", printed.processor) };
            let source = format!("`crates/concio/benches/{name}.rs`, {}{on}", printed.date);
            let _ = write!(text, "\n## {title}\n\n{source}:\n\n```text\n{}\n```\n", printed.text);
        }
    }
    text
}

fn heading(name: &str) -> String {
    let mut text = name.replace('-', " ");
    text[..1].make_ascii_uppercase();
    text
}

fn machine(all: &Performance) -> String {
    let m = &all.machine;
    format!(
        "Measured on: {}, {} processors seen, {}. {}.\n",
        m.processor,
        m.processors,
        m.system,
        m.versions.join("; ")
    )
}

/// What a run may be off by, in a case.
struct Held {
    words: String,
    by: Box<dyn Fn(&Timed) -> bool>,
}

fn held(case: &Case, measured: &Measured) -> Held {
    match case.judge {
        Judge::Account { work, rms, may } => Held {
            words: format!("work within {}, rms force within {} of the reference", percent(may[0]), percent(may[1])),
            by: Box::new(move |r| (r.work / work - 1.0).abs() <= may[0] && (r.rms / rms - 1.0).abs() <= may[1]),
        },
        Judge::Histories { .. } => {
            let most = baseline(measured).and_then(|b| b.error).unwrap_or(0.0);
            Held {
                words: format!(
                    "error of the histories at most CVODE's own at rtol {}, {}",
                    power(BASELINE),
                    percent(most)
                ),
                by: Box::new(move |r| r.error.is_some_and(|e| e <= most)),
            }
        }
    }
}

fn summary<'a>(measured: impl Iterator<Item = (&'a Case, &'a Measured)>) -> String {
    let mut text = format!(
        "| case | accuracy to hold | Concio, tolerance | off by | CVODE's time at {} over Concio's | asked for |\n|---|---|---|---|---|---|\n",
        power(BASELINE)
    );
    for (case, measured) in measured {
        let Some((_, least, aim)) = ASKED.iter().find(|a| a.0 == case.name) else { continue };
        let held = held(case, measured);
        let ours = || measured.runs.iter().filter(|r| r.program == Method::Concio.name() && r.median().is_some());
        let fastest = ours()
            .filter(|r| (held.by)(r))
            .min_by(|a, b| a.median().unwrap_or(0.0).total_cmp(&b.median().unwrap_or(0.0)));
        let default = ours().find(|r| r.tolerance == DEFAULT);
        let asked = aim.map_or_else(|| format!("{least}"), |aim| format!("{least}, aim {aim}"));
        let mut accuracy = Some(held.words);
        for (run, which) in [(fastest, "fastest that holds it"), (default, "default")] {
            let Some(run) = run else { continue };
            let _ = writeln!(
                text,
                "| {} | {} | {}, {which} | {} | {} | {asked} |",
                case.name,
                accuracy.take().unwrap_or_else(|| "likewise".into()),
                power(run.tolerance),
                off(case, run),
                ratio(measured, run)
            );
        }
    }
    text
}

fn section(case: &Case, measured: &Measured) -> String {
    let mut text = format!(
        "{}. {} unknowns, {} joints, samples every {} s. Reference: {}. Measured on {}.\n\n![Error over time](img/performance/{}.svg)\n\n",
        capital(case.title),
        measured.unknowns,
        measured.joints,
        measured.interval,
        measured.reference,
        measured.date,
        case.name
    );
    let account = matches!(case.judge, Judge::Account { .. });
    let judged: &[&str] =
        if account { &["work [J]", "rms force [kN]", "off by (work, force)"] } else { &["error over the peak"] };
    let columns = [&["program", "tolerance", "steps", "factorisations"], judged, &["time [s]"]].concat();
    let _ = writeln!(text, "| {} |\n|{}", columns.join(" | "), "---|".repeat(columns.len()));
    for run in measured.runs.iter().filter(|r| r.tolerance >= FINEST) {
        let _ = writeln!(text, "{}", row(case, run, account));
    }
    text
}

fn row(case: &Case, run: &Timed, account: bool) -> String {
    let mut cells = vec![run.program.clone(), power(run.tolerance)];
    let count = |n: u64| if n == 0 { "–".into() } else { thousands(n) };
    if let Some(why) = &run.stopped {
        cells.extend(vec![String::from("–"); if account { 5 } else { 3 }]);
        cells.push(why.clone());
    } else {
        cells.push(count(run.steps));
        cells.push(run.factorisations.map_or_else(|| "–".into(), count));
        if account {
            cells.push(format!("{:.2}", run.work));
            cells.push(format!("{:.2}", 1e-3 * run.rms));
        }
        cells.push(off(case, run));
        cells.push(seconds(run));
    }
    format!("| {} |", cells.join(" | "))
}

/// How far a run is from the reference.
fn off(case: &Case, run: &Timed) -> String {
    match case.judge {
        Judge::Account { work, rms, .. } => {
            format!("{}, {}", percent((run.work / work - 1.0).abs()), percent((run.rms / rms - 1.0).abs()))
        }
        Judge::Histories { .. } => run.error.map_or_else(|| "–".into(), percent),
    }
}

/// Time of the baseline over that of a run.
fn ratio(measured: &Measured, run: &Timed) -> String {
    match (baseline(measured).and_then(Timed::median), run.median()) {
        (Some(theirs), Some(ours)) if ours > 0.0 => {
            let ratio = theirs / ours;
            if ratio >= 9.95 { format!("{ratio:.0}") } else { format!("{ratio:.2}") }
        }
        _ => "–".into(),
    }
}

/// Median, and how many runs it is of.
fn seconds(run: &Timed) -> String {
    let Some(median) = run.median() else { return "–".into() };
    let digits = if median >= 10.0 {
        1
    } else if median >= 0.1 {
        2
    } else {
        4
    };
    let of = if run.seconds.len() > 1 { format!(" ({})", run.seconds.len()) } else { String::new() };
    format!("{median:.digits$}{of}")
}

fn percent(value: f64) -> String {
    let value = 100.0 * value;
    if value == 0.0 {
        return "0 %".into();
    }
    let digits = (1.0 - value.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$} %")
}

/// 3·10⁻² for 0.03.
fn power(value: f64) -> String {
    let exponent = (value.log10() + 1e-9).floor();
    let lead = (value / 10f64.powf(exponent)).round();
    let digits: String = format!("{exponent}")
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
        })
        .collect();
    if lead == 1.0 { format!("10{digits}") } else { format!("{lead}·10{digits}") }
}

fn thousands(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_for_people() {
        assert_eq!([0.03, 1e-4, 1e-10, 1.0].map(power), ["3·10⁻²", "10⁻⁴", "10⁻¹⁰", "10⁰"]);
        assert_eq!([0.0016, 0.12, 1.3e-7, 0.0].map(percent), ["0.16 %", "12 %", "0.000013 %", "0 %"]);
        assert_eq!([7, 1234, 690_085].map(thousands), ["7", "1,234", "690,085"]);
        assert_eq!(heading("slip-start"), "Slip start");
    }
}
