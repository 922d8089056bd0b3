//! Assertions against answers that are known beforehand: closed forms and independent computations.
//!
//! [`agrees!`] asserts, and leaves a record of what it found where [`FOLDER`] names a folder. `cargo xtask verification`
//! makes `docs/verification.md` of the records, so that the page says what the tests assert.

use std::fmt;
use std::io::Write;
use std::path::Path;

/// Environment variable that names the folder for records; without it nothing is written.
pub const FOLDER: &str = "CONCIO_VERIFIED";

/// How far a number may be from the answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Within {
    /// As a part of the answer.
    Relative(f64),
    /// In the unit of the answer, for answers near 0.
    Absolute(f64),
}

/// What is held against what, and where.
#[derive(Clone, Copy, Debug)]
pub struct Case<'c> {
    /// Section of the page and subject, as `section: subject` or `section: subject; case`, which no other case of the
    /// test has. The page makes one row of the cases of a subject.
    pub subject: &'c str,
    /// The closed form or the independent computation, with its source where it has one.
    pub against: &'c str,
    /// Unit of both numbers, empty for pure ones.
    pub unit: &'c str,
    /// Package of the test.
    pub package: &'c str,
    /// Its crate, as rustc calls it.
    pub target: &'c str,
    /// Path of a function inside the test.
    pub function: &'c str,
}

/// Asserts that a number is the one known beforehand: `agrees!(subject, against, unit, found, expected, within)`.
///
/// `within` is a part of `expected`; `abs: within` is in its unit. See [`Case`] for the texts.
#[macro_export]
macro_rules! agrees {
    ($subject:expr, $against:expr, $unit:expr, $found:expr, $expected:expr, abs: $within:expr $(,)?) => {
        $crate::agrees!(@ $subject, $against, $unit, $found, $expected, $crate::Within::Absolute($within))
    };
    (@ $subject:expr, $against:expr, $unit:expr, $found:expr, $expected:expr, $within:expr) => {{
        fn here() {}
        // What the texts borrow from lives as long as the match.
        match (&$subject, &$against) {
            (subject, against) => $crate::hold(
                &$crate::Case {
                    subject: ::std::convert::AsRef::<str>::as_ref(subject),
                    against: ::std::convert::AsRef::<str>::as_ref(against),
                    unit: $unit,
                    package: ::std::env!("CARGO_PKG_NAME"),
                    target: ::std::env!("CARGO_CRATE_NAME"),
                    function: ::std::any::type_name_of_val(&here),
                },
                $found,
                $expected,
                $within,
            ),
        }
    }};
    ($subject:expr, $against:expr, $unit:expr, $found:expr, $expected:expr, $within:expr $(,)?) => {
        $crate::agrees!(@ $subject, $against, $unit, $found, $expected, $crate::Within::Relative($within))
    };
}

/// The largest difference within pairs; what is no number stays one.
pub fn farthest(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let larger = |most: f64, off: f64| if most.is_nan() || off <= most { most } else { off };
    pairs.into_iter().map(|(a, b)| (a - b).abs()).fold(0.0, larger)
}

/// File in [`FOLDER`] with a line for every check that was left out, and its test.
pub const SKIPPED: &str = "skipped.txt";

/// Says of a check that it cannot be made here; leaves a record of it where [`FOLDER`] names a folder.
///
/// # Panics
///
/// Where the record cannot be written.
pub fn skip(what: &str) {
    println!("skipped: {what}");
    if let Some(folder) = std::env::var_os(FOLDER) {
        let path = Path::new(&folder).join(SKIPPED);
        let file = std::fs::OpenOptions::new().append(true).create(true).open(&path);
        let thread = std::thread::current();
        let line = format!("{what} ({})\n", thread.name().unwrap_or_default());
        let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
        written.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    }
}

/// What [`agrees!`] does.
///
/// # Panics
///
/// Where the numbers differ by more than allowed or are none, and where a record cannot be written or is there already.
#[track_caller]
pub fn hold(case: &Case, found: f64, expected: f64, within: Within) {
    let allowed = match within {
        Within::Relative(part) => part * expected.abs(),
        Within::Absolute(most) => most,
    };
    let (subject, off) = (case.subject, (found - expected).abs());
    assert!(off <= allowed, "{subject}: {found} instead of {expected} ({off:e} off, {allowed:e} allowed)");
    if let Some(folder) = std::env::var_os(FOLDER) {
        let line = case.line(found, expected, within);
        let path = Path::new(&folder).join(format!("{:016x}.json", case.hash()));
        // Two cases of one name would be one row, whichever comes last.
        assert!(!path.exists(), "{subject}: recorded already; give every case its own subject, and empty the folder");
        std::fs::write(&path, line).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    }
}

impl Case<'_> {
    /// Path of the test within its crate.
    fn test(&self) -> &str {
        let path = self.function.split("::{{closure}}").next().unwrap_or_default();
        let path = path.strip_suffix("::here").unwrap_or(path);
        path.strip_prefix(self.target).and_then(|path| path.strip_prefix("::")).unwrap_or(path)
    }

    /// The record, one line of JSON.
    fn line(&self, found: f64, expected: f64, within: Within) -> String {
        let (kind, within) = match within {
            Within::Relative(part) => ("relative", part),
            Within::Absolute(most) => ("absolute", most),
        };
        format!(
            "{{\"subject\":{},\"against\":{},\"unit\":{},\"package\":{},\"target\":{},\"test\":{},\"kind\":\"{kind}\",\
             \"found\":{found:e},\"expected\":{expected:e},\"within\":{within:e}}}\n",
            Text(self.subject),
            Text(self.against),
            Text(self.unit),
            Text(self.package),
            Text(self.target),
            Text(self.test()),
        )
    }

    /// Of what tells one record from the others (FNV-1a).
    fn hash(&self) -> u64 {
        let all = [self.package, self.target, self.test(), self.subject, self.against];
        let bytes = all.iter().flat_map(|text| text.bytes().chain([0]));
        bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }
}

/// A text as JSON writes it.
struct Text<'t>(&'t str);

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("\"")?;
        for c in self.0.chars() {
            match c {
                '"' | '\\' => write!(f, "\\{c}")?,
                c if c.is_control() => write!(f, "\\u{:04x}", u32::from(c))?,
                c => write!(f, "{c}")?,
            }
        }
        f.write_str("\"")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case<'c>(function: &'c str, target: &'c str) -> Case<'c> {
        Case { subject: "a: b", against: "x \"y\"", unit: "m", package: "p", target, function }
    }

    #[test]
    fn a_test_is_named_as_cargo_names_it() {
        assert_eq!(case("cracks::a_block::here", "cracks").test(), "a_block");
        assert_eq!(case("concio_law::tests::a_law::{{closure}}::here", "concio_law").test(), "tests::a_law");
    }

    #[test]
    fn what_is_off_fails() {
        for (found, within) in
            [(1.02, Within::Relative(0.01)), (1.2, Within::Absolute(0.1)), (f64::NAN, Within::Absolute(1.0))]
        {
            let held = std::panic::catch_unwind(|| hold(&case("a::b::here", "a"), found, 1.0, within));
            assert!(held.is_err(), "{found}");
        }
        assert_eq!(farthest([(1.0, 1.5), (2.0, 1.0)]), 1.0);
        assert!(farthest([(1.0, 1.5), (f64::NAN, 1.0), (0.0, 7.0)]).is_nan());
    }

    #[test]
    fn a_record_is_a_line_of_json() {
        let line = case("a::b::here", "a").line(1.5e-3, 0.0, Within::Absolute(0.01));
        assert_eq!(
            line,
            "{\"subject\":\"a: b\",\"against\":\"x \\\"y\\\"\",\"unit\":\"m\",\"package\":\"p\",\"target\":\"a\",\
             \"test\":\"b\",\"kind\":\"absolute\",\"found\":1.5e-3,\"expected\":0e0,\"within\":1e-2}\n"
        );
    }
}
