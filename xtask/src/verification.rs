//! docs/verification.md, made of the records that `agrees!` leaves (crates/concio-verified).

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::command::{Outcome, cargo, run};

/// Where tests say what they left out, as crates/concio-verified does.
const SKIPPED: &str = "skipped.txt";
const PAGE: &str = "docs/verification.md";
const PACKAGES: [&str; 8] = [
    "concio-continuum",
    "concio-law",
    "concio-limit",
    "concio-mechanisms",
    "concio-planar",
    "concio-shear",
    "concio",
    "concio-study",
];
const HEADER: &str = "| Subject | Held against | Expected | Found | Off by | The test allows | Test |";

/// Sections of the page in their order; the first half of a record's subject is one of them.
const SECTIONS: [(&str, &str); 20] = [
    ("Ground motion", "Signals, filters, measures and response spectra."),
    ("Walls and loads", "Geometry, weights, and what joints bear at rest."),
    ("Integration", "Oscillators of the shear model, without friction and with springs that let go."),
    ("Friction", "Laws of friction, regularised and set-valued."),
    ("Rigid contact", "Newton's law of impact between blocks that touch."),
    ("Springs", "Elastic joints, joints without tension and open ones: stiffness, vibration, damping, tilt."),
    ("Bonds", "Mortar that cracks: strengths, energies, and what is left."),
    ("Crushing", "Joints of limited compressive strength."),
    ("Devices", "Laws of devices in the place of mortar."),
    ("Ties", "Tie rods."),
    ("Forces", "Forces on blocks."),
    ("Sliding", "Blocks and dry walls that slide on what is below them."),
    ("Rocking", "Blocks that rock on their corners."),
    ("Rocking walls", "Walls of the model `rocking` through wall files."),
    ("Limit analysis", "Multipliers of the load under which walls of rigid blocks become mechanisms."),
    ("Limit analysis in space", "The same of walls whose blocks move in all directions."),
    ("Mechanisms", "Parts of a wall that fall out of its plane: multipliers, displaced shapes, checks of the code."),
    (
        "Continuum",
        "Moduli and strength of the continuum that stands for a wall, and walls of more and more bricks beside it.",
    ),
    ("Statistics", "Estimates of studies, and how often their intervals hold what they estimate."),
    ("Laboratory", "Walls that were tested elsewhere; the answer is what was measured."),
];

const INTRODUCTION: &str = "\
# Verification

Here are numbers that Concio computes and whose answers are known beforehand.
The answers are closed forms, computations by other means inside the tests, or measurements.

Each row is an assertion of a test, and the test itself wrote down the numbers of its row.
`cargo xtask verification` runs these tests and makes this page of what they wrote; do not edit it.
`cargo xtask ci` fails where the page and the tests disagree.

How to read a row:

- *Off by* is the distance from the answer, as a part of the answer, rounded up. Where *The test allows* begins with ±, it is the distance itself.
- *The test allows* is the bound that the test asserts. Beyond it the test fails.
- *Test* is package and test: `cargo test -p PACKAGE TEST` repeats it. It needs nothing outside of the repository.
- A row of several cases shows the least and the largest number of each column, and of *Off by* the largest.
- A row of a largest error has the answer 0. What it is the error of, and over what it is taken, is in the subject.

Tests against references that lie beside the repository have no rows, because the page is to be the same without them.
";

#[derive(Deserialize)]
struct Record {
    subject: String,
    against: String,
    unit: String,
    package: String,
    test: String,
    kind: String,
    found: f64,
    expected: f64,
    within: f64,
}

/// The folder for records, emptied.
pub fn folder(root: &Path) -> Result<PathBuf, String> {
    let folder = root.join("target").join("verified");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    Ok(folder)
}

/// Checks that tests left out in the run that filled the folder, each once.
pub fn skipped(root: &Path) -> Result<BTreeSet<String>, String> {
    let path = root.join("target").join("verified").join(SKIPPED);
    if !path.exists() {
        return Ok(BTreeSet::new());
    }
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(text.lines().map(String::from).collect())
}

/// Runs the tests that record, built with a profile (`release` where none is named), and writes the page; with `--check` it only compares
/// the page with what the last run wrote, with `--recorded` it makes it of that.
pub fn make(root: &Path, rest: &[String]) -> Outcome {
    let profile = match rest {
        [] => "release",
        [key, profile] if key == "--cargo-profile" => profile,
        [key] if key == "--check" => return check(root),
        [key] if key == "--recorded" => return write(root),
        _ => return Err("cargo xtask verification [--cargo-profile PROFILE | --check | --recorded]".into()),
    };
    let records = folder(root)?;
    let nextest = cargo(root).args(["nextest", "--version"]).output().is_ok_and(|o| o.status.success());
    for package in PACKAGES {
        let (targets, tests) = recording(root, package)?;
        if tests.is_empty() {
            continue;
        }
        let mut command = cargo(root);
        match nextest {
            true => command.args(["nextest", "run", "--locked", "--cargo-profile", profile]),
            false => command.args(["test", "--locked", "--profile", profile]),
        };
        command.args(["--no-fail-fast", "--package", package]).args(targets).arg("--").args(tests);
        run(command.env("CONCIO_VERIFIED", &records))?;
    }
    write(root)
}

/// Writes the page of what the tests that ran last wrote down.
fn write(root: &Path) -> Outcome {
    let text = page(root)?;
    fs::write(root.join(PAGE), text).map_err(|e| format!("{PAGE}: {e}"))?;
    println!("{PAGE}");
    Ok(())
}

/// Fails where the page is not what the tests that ran last wrote down.
pub fn check(root: &Path) -> Outcome {
    let path = root.join(PAGE);
    let committed = fs::read_to_string(&path).map_err(|e| format!("{PAGE}: {e}"))?;
    let (there, now) = (rows(&committed)?, rows(&page(root)?)?);
    let again = "run `cargo xtask verification` and commit it";
    for (key, told) in &there {
        let Some(found) = now.get(key) else { return Err(format!("{PAGE}: no test tells this row: {key}; {again}")) };
        if !found.agrees(told) {
            return Err(format!("{PAGE}: {key}: the page tells {told:?}, the test {found:?}; {again}"));
        }
    }
    match now.keys().find(|key| !there.contains_key(*key)) {
        Some(key) => Err(format!("{PAGE} lacks this row: {key}; {again}")),
        None => {
            println!("{PAGE} is current: {} rows", there.len());
            Ok(())
        }
    }
}

/// Files of Rust in a folder and those below it.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let own = files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "rs"));
    own.chain(folders.iter().flat_map(|folder| sources(folder))).collect()
}

/// Options that choose the targets of a package whose tests call `agrees!`, and the names of these tests.
fn recording(root: &Path, package: &str) -> Result<(Vec<String>, BTreeSet<String>), String> {
    let folder = root.join("crates").join(package);
    let mut files: Vec<_> =
        sources(&folder.join("src")).into_iter().map(|path| (path, vec!["--lib".to_string()])).collect();
    for entry in fs::read_dir(folder.join("tests").join("all")).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|e| e == "rs") {
            files.push((path, vec!["--test".into(), "all".into()]));
        }
    }
    files.sort();
    let (mut targets, mut tests) = (Vec::new(), BTreeSet::new());
    for (path, target) in files {
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let (mut own, mut marked, mut any, mut shared) = (Vec::new(), false, false, false);
        let mut inside = None;
        for line in text.lines().map(str::trim_start) {
            if let Some(rest) = line.strip_prefix("fn ") {
                inside = rest.split('(').next().filter(|_| marked);
                own.extend(inside);
                marked = false;
            } else if line.starts_with("macro_rules!") {
                inside = None;
            }
            marked |= line.starts_with("#[test]");
            if line.contains("agrees!(") {
                tests.extend(inside.map(String::from));
                (any, shared) = (true, shared || inside.is_none());
            }
        }
        // What several tests call may be called by each of them.
        if shared {
            tests.extend(own.into_iter().map(String::from));
        }
        if any && !targets.ends_with(&target) {
            targets.extend(target);
        }
    }
    Ok((targets, tests))
}

/// The page that the records in the folder make.
fn page(root: &Path) -> Result<String, String> {
    let folder = root.join("target").join("verified");
    let mut sections: BTreeMap<usize, BTreeMap<String, Vec<Record>>> = BTreeMap::new();
    for entry in fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))? {
        let path = entry.map_err(|e| format!("{}: {e}", folder.display()))?.path();
        if path.extension().is_none_or(|e| e != "json") {
            continue;
        }
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let record: Record = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        let name = record.subject.split(": ").next().unwrap_or_default();
        let section = SECTIONS.iter().position(|(title, _)| *title == name);
        let section = section.ok_or_else(|| format!("`{}` names no section of {PAGE}", record.subject))?;
        sections.entry(section).or_default().entry(record.key()).or_default().push(record);
    }
    let mut text = INTRODUCTION.to_string();
    for (section, rows) in sections {
        // Not as they were found: the order of files is that of the file system.
        let rows: BTreeSet<String> = rows.values().map(|cases| row(cases)).collect();
        let (title, what) = SECTIONS[section];
        let ruler = HEADER.split(" | ").map(|_| "---").collect::<Vec<_>>().join(" | ");
        let rows: String = rows.iter().map(|row| format!("{row}\n")).collect();
        write!(text, "\n## {title}\n\n{what}\n\n{HEADER}\n| {ruler} |\n{rows}").map_err(|e| e.to_string())?;
    }
    Ok(text)
}

impl Record {
    /// What the cases of one row share: all but the case and its numbers.
    fn key(&self) -> String {
        let subject = self.subject.split("; ").next().unwrap_or_default();
        format!("{subject} | {} | {} | {} | {}", self.against, self.unit, self.allows(), self.command())
    }

    fn with_unit(&self, text: &str) -> String {
        if self.unit.is_empty() { text.to_string() } else { format!("{text} {}", self.unit) }
    }

    fn off(&self) -> f64 {
        let off = (self.found - self.expected).abs();
        if self.kind == "relative" { off / self.expected.abs() } else { off }
    }

    fn allows(&self) -> String {
        match self.kind.as_str() {
            "relative" => power(self.within),
            _ => self.with_unit(&format!("± {}", power(self.within))),
        }
    }

    fn command(&self) -> String {
        format!("`{} {}`", self.package, self.test)
    }
}

/// The row of cases that share their key, of which there is one or more: numbers of several are their range.
fn row(cases: &[Record]) -> String {
    let first = &cases[0];
    let subject = first.subject.split_once(": ").map_or(first.subject.as_str(), |(_, subject)| subject);
    let subject = match (cases.len(), subject.split_once("; ")) {
        (1, _) => subject.replace("; ", ", "),
        (count, Some((subject, _))) => format!("{subject}, {count} cases"),
        (count, None) => format!("{subject}, {count} cases"),
    };
    let range = |of: fn(&Record) -> f64| {
        let [low, high] = [f64::min, f64::max].map(|end| cases.iter().map(of).reduce(end).unwrap_or(f64::NAN));
        let [low, high] = [low, high].map(digits);
        first.with_unit(&if low == high { low } else { format!("{low} … {high}") })
    };
    let off = up(cases.iter().map(Record::off).fold(0.0, f64::max));
    let cells = [
        subject,
        first.against.clone(),
        range(|case| case.expected),
        range(|case| case.found),
        if first.kind == "relative" { off } else { first.with_unit(&off) },
        first.allows(),
        first.command(),
    ];
    format!("| {} |", cells.map(|cell| cell.replace('|', "\\|")).join(" | "))
}

/// Three digits that count and a power of ten.
fn power(x: f64) -> String {
    format!("{:e}", format!("{x:.2e}").parse().unwrap_or(x))
}

/// Five digits that count, without zeros at the end.
fn digits(x: f64) -> String {
    let told = format!("{x:.4e}");
    let (mantissa, power) = told.split_once('e').unwrap_or((&told, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text.to_string(),
    };
    match power {
        -3..=5 => trimmed(&format!("{:.*}", (4 - power).max(0) as usize, told.parse().unwrap_or(x))),
        _ => format!("{}e{power}", trimmed(mantissa)),
    }
}

/// One digit, rounded up.
fn up(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    let power = x.log10().floor() as i32;
    // What is one digit already must not become the next for its binary form.
    let digit = (x / 10f64.powi(power) * (1.0 - 1e-12)).ceil().max(1.0);
    if digit > 9.0 { format!("1e{}", power + 1) } else { format!("{digit:.0}e{power}") }
}

/// What a row tells in numbers: the least and the largest of its cases.
#[derive(Debug)]
struct Told {
    expected: [f64; 2],
    found: [f64; 2],
    /// What the test allows, in the unit of the numbers.
    allowed: [f64; 2],
}

impl Told {
    /// The same but for other machines: answers to their last digit, findings to a tenth of what is allowed.
    fn agrees(&self, other: &Told) -> bool {
        let last = |x: f64| if x == 0.0 { 0.0 } else { 1.01 * 10f64.powi(x.abs().log10().floor() as i32 - 4) };
        let near = |a: f64, b: f64, more: f64| (a - b).abs() <= last(a).max(last(b)).max(more);
        (0..2).all(|end| {
            near(self.expected[end], other.expected[end], 0.0)
                && near(self.found[end], other.found[end], 0.1 * self.allowed[end])
        })
    }
}

/// Rows of a page by what they say, without the numbers.
fn rows(page: &str) -> Result<BTreeMap<String, Told>, String> {
    let mut rows = BTreeMap::new();
    let mut section = "";
    for line in page.lines() {
        section = line.strip_prefix("## ").unwrap_or(section);
        let cells = line.strip_prefix("| ").and_then(|line| line.strip_suffix(" |"));
        let Some(cells) = cells.filter(|_| line != HEADER && !line.starts_with("| ---")) else { continue };
        let cells: Vec<&str> = cells.split(" | ").collect();
        let [subject, against, expected, found, _, within, command] = cells[..] else {
            return Err(format!("{PAGE}: {} cells in: {line}", cells.len()));
        };
        let number = |text: &str| text.parse::<f64>().map_err(|e| format!("{PAGE}: {text}: {e} in: {line}"));
        let range = |cell: &str| {
            let words: Vec<&str> = cell.split(' ').collect();
            let high = if words.get(1) == Some(&"…") { 2 } else { 0 };
            Ok::<_, String>([number(words[0])?, number(words.get(high).unwrap_or(&""))?])
        };
        let expected = range(expected)?;
        let allowed = match within.strip_prefix("± ") {
            Some(within) => [range(within)?[0]; 2],
            None => expected.map(|x| x.abs() * number(within).unwrap_or(0.0)),
        };
        let key = format!("{section}: {subject} | {against} | allowed {within} | {command}");
        rows.insert(key, Told { expected, found: range(found)?, allowed });
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> Record {
        Record {
            subject: "Rocking: a block".into(),
            against: "|θ| = α".into(),
            unit: "m".into(),
            package: "concio-planar".into(),
            test: "a_block_rocks".into(),
            kind: "relative".into(),
            found: 1.0012,
            expected: 1.0,
            within: 0.01,
        }
    }

    #[test]
    fn numbers_have_five_digits_and_errors_one() {
        for (x, told) in
            [(0.0, "0"), (1.0, "1"), (-0.00123456, "-0.0012346"), (123456.0, "123460"), (6.54321e-5, "6.5432e-5")]
        {
            assert_eq!(digits(x), told);
        }
        for (x, told) in [(0.0, "0"), (3e-9, "3e-9"), (3.01e-9, "4e-9"), (9.5e-3, "1e-2"), (0.1, "1e-1")] {
            assert_eq!(up(x), told);
        }
    }

    #[test]
    fn cases_of_one_row_are_a_range() {
        let case = |name: &str, expected: f64| Record {
            subject: format!("Rocking: a block; {name}"),
            expected,
            found: 1.001 * expected,
            ..record()
        };
        let (one, other) = (case("high", 2.0), case("low", 0.5));
        assert_eq!(one.key(), other.key());
        assert!(
            row(&[case("high", 2.0)]).starts_with("| a block, high | \\|θ\\| = α | 2 m | 2.002 m | 1e-3 | 1e-2 | `")
        );
        let both = row(&[one, other]);
        assert!(
            both.starts_with("| a block, 2 cases | \\|θ\\| = α | 0.5 … 2 m | 0.5005 … 2.002 m | 1e-3 | 1e-2 | `"),
            "{both}"
        );
        let told = rows(&both).expect("rows");
        assert_eq!(told.values().next().map(|told| told.expected), Some([0.5, 2.0]));
    }

    #[test]
    fn pages_differ_where_numbers_or_words_do() {
        let of = |record: Record| rows(&format!("## Rocking\n{HEADER}\n| --- | --- |\n{}\n", row(&[record])));
        let page = of(record()).expect("rows");
        let (key, told) = page.first_key_value().expect("a row");
        let same = |record: Record| {
            let other = of(record).expect("rows");
            other.get(key).is_some_and(|found| found.agrees(told))
        };
        assert!(same(record()) && same(Record { found: 1.0021, ..record() }));
        assert!(!same(Record { found: 1.0023, ..record() }));
        assert!(!same(Record { expected: 1.0003, ..record() }));
        assert!(!same(Record { within: 0.02, ..record() }));
        assert!(!same(Record { against: "another".into(), ..record() }));
        assert!(!same(Record { test: "another".into(), ..record() }));
    }
}
