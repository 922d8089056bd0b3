//! What many runs warn of, together: by kind, and by sentence but for its numbers.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use concio::case::Case;
use concio::ground::Library;
use concio::model::Model;
use concio::run::prepare_with;
use concio::warning::{Warning, WarningKind};
use rayon::prelude::*;
use serde_json::Value;

/// Runs of which one says what runs like it warn of before they are done: laying and compiling large walls takes its time.
const LOOKED_AT: usize = 16;

/// Warnings of many runs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Warned {
    /// Runs that were looked at.
    pub of: usize,
    /// Runs with any warning.
    pub runs: usize,
    /// Runs by kind.
    kinds: BTreeMap<WarningKind, usize>,
    /// Sentences that differ by more than their numbers, in the order in which they came.
    pub told: Vec<Told>,
}

/// A sentence that some runs are warned with.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// The warning of the first of them.
    pub first: Warning,
    /// What that run is called.
    pub name: String,
    /// How many runs have it.
    pub runs: usize,
    /// Whether it is the same in all of them, numbers included.
    pub same: bool,
}

impl Warned {
    /// Counts a run; `name` is what it is called.
    pub fn add(&mut self, name: impl Fn() -> String, warnings: &[Warning]) {
        self.of += 1;
        self.runs += usize::from(!warnings.is_empty());
        for kind in kinds_of(warnings) {
            *self.kinds.entry(kind).or_default() += 1;
        }
        let mut counted: Vec<usize> = Vec::new();
        for warning in warnings {
            let place = self.told.iter().position(|t| t.is_like(warning)).unwrap_or_else(|| {
                self.told.push(Told { first: warning.clone(), name: name(), runs: 0, same: true });
                self.told.len() - 1
            });
            let told = &mut self.told[place];
            told.same &= told.first.text == warning.text;
            if !counted.contains(&place) {
                counted.push(place);
                told.runs += 1;
            }
        }
    }

    /// Number of runs by kind, `heavy-beam 12, creep 3`; the kinds of most runs first.
    pub fn counts(&self) -> String {
        let mut kinds: Vec<(WarningKind, usize)> = self.kinds.iter().map(|(k, n)| (*k, *n)).collect();
        kinds.sort_by_key(|(kind, runs)| (std::cmp::Reverse(*runs), *kind));
        kinds.iter().map(|(kind, runs)| format!("{kind} {runs}")).collect::<Vec<_>>().join(", ")
    }

    /// The sentences that another list does not have.
    pub fn sentences(&self, but: &Warned) -> Vec<Sentence> {
        self.sentences_of(but, self.of, self.of)
    }

    /// The same where `looked` of `all` runs were looked at, of which not all could be made ready.
    fn sentences_of(&self, but: &Warned, looked: usize, all: usize) -> Vec<Sentence> {
        let new = |told: &&Told| !but.told.iter().any(|o| o.is_like(&told.first));
        self.told.iter().filter(new).map(|told| told.sentence(looked, all)).collect()
    }
}

/// A warning of many runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Sentence {
    /// Which of them it is of: `in every run: `.
    pub of: String,
    /// What it says in the first of them.
    pub text: String,
    /// Whether it says just that in all runs that were looked at.
    pub everywhere: bool,
}

impl std::fmt::Display for Sentence {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.of, self.text)
    }
}

impl Told {
    /// Whether a warning is this one but for its numbers.
    fn is_like(&self, other: &Warning) -> bool {
        self.first.kind == other.kind && alike(&self.first.text, &other.text)
    }

    /// The warning, with the number of its runs, of `looked` that were looked at of `all`.
    fn sentence(&self, looked: usize, all: usize) -> Sentence {
        let Told { first, name, runs, same } = self;
        let which = match (*runs == all, looked < all) {
            (true, _) => "in every run".into(),
            (false, false) => format!("in {runs} of {all} runs"),
            (false, true) if *runs == looked => format!("in all {looked} runs checked, of {all} in the study"),
            (false, true) => format!("in {runs} of {looked} runs checked, of {all} in the study"),
        };
        let of = match (*runs, *same && *runs == looked) {
            (_, true) => format!("{which}: "),
            (1, _) => format!("{which}, {name}: "),
            _ => format!("{which}, such as {name}: "),
        };
        Sentence { of, text: first.text.clone(), everywhere: *runs == all && *same }
    }
}

/// The warnings that a summary.json holds.
pub fn of_summary(summary: &Value) -> Vec<Warning> {
    let list = |key: &str| summary.get(key).and_then(Value::as_array).into_iter().flatten();
    let one =
        |(text, kind): (&Value, &Value)| Some(Warning::new(serde_json::from_value(kind.clone()).ok()?, text.as_str()?));
    list("warnings").zip(list("warning_kinds")).filter_map(one).collect()
}

/// The kinds of some warnings, each once, parted by blanks: a cell of a table; none where there are none.
pub fn kinds(warnings: &[Warning]) -> Option<String> {
    let names: Vec<&str> = kinds_of(warnings).into_iter().map(WarningKind::name).collect();
    (!names.is_empty()).then(|| names.join(" "))
}

/// The same as they are, sorted.
fn kinds_of(warnings: &[Warning]) -> Vec<WarningKind> {
    let mut kinds: Vec<WarningKind> = warnings.iter().map(|w| w.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}

/// Whether two sentences differ by their numbers alone.
fn alike(a: &str, b: &str) -> bool {
    a == b || words(a).eq(words(b))
}

/// A sentence without its numbers and their signs.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    text.split(number).filter(|part| !part.is_empty() && *part != "e")
}

/// What is known of runs before they are done.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Before {
    /// Their warnings, as far as they are known.
    pub warned: Warned,
    /// Runs that cannot be made ready: what each is called, and why.
    pub lost: Vec<(String, String)>,
    /// What the design leaves out, and how runs differ that are to be compared.
    pub gaps: Vec<String>,
    /// Warnings of all runs that are read off the files alone.
    pub read: Warned,
    /// Runs in all, of which `warned.of` and those of `lost` were looked at.
    pub all: usize,
}

impl Before {
    /// What is to be told.
    pub fn sentences(&self) -> Vec<Sentence> {
        let looked = self.warned.of + self.lost.len();
        let lost = |(name, cause): &(String, String)| Sentence {
            of: format!("{name} cannot be run: "),
            text: cause.clone(),
            everywhere: false,
        };
        let lost = self.lost.iter().map(lost);
        let gap = |text: &String| Sentence { of: String::new(), text: text.clone(), everywhere: false };
        self.gaps
            .iter()
            .map(gap)
            .chain(lost)
            .chain(self.read.sentences(&Warned::default()))
            .chain(self.warned.sentences_of(&Warned::default(), looked, self.all))
            .collect()
    }
}

/// Makes some of `all` runs ready, evenly spread over them, and says what they warn of; all of a few. `case` gives the wall of a
/// run, with paths of records from the working directory.
pub fn before(all: usize, case: impl Fn(usize) -> Option<Case> + Sync, name: impl Fn(usize) -> String) -> Before {
    let places = spread(all);
    let library = Library::default();
    let made: Vec<Option<Made>> = places
        .par_iter()
        .map(|&number| {
            let prepared = prepare_with(case(number)?, Path::new(""), &library).map_err(|e| e.to_string());
            Some(prepared.map(|p| (Followed::of(&p.model), p.model.warnings)))
        })
        .collect();
    let mut before = Before { all, ..Before::default() };
    let mut followed = Vec::new();
    for (number, made) in places.into_iter().zip(made) {
        match made {
            Some(Ok((own, warnings))) => {
                before.warned.add(|| name(number), &warnings);
                followed.extend(own.map(|own| (number, own)));
            }
            Some(Err(cause)) => before.lost.push((name(number), cause)),
            None => {}
        }
    }
    before.gaps.extend(unlike(&followed, name));
    before
}

/// What is told of a run that was made ready, and what rocks in it; or why it cannot be.
type Made = Result<(Option<Followed>, Vec<Warning>), String>;

/// Says of runs, each with its number, that not all of them follow the mechanism of the first.
fn unlike(followed: &[(usize, Followed)], name: impl Fn(usize) -> String) -> Option<String> {
    let (first, one) = followed.first()?;
    let (second, other) = followed.iter().find(|(_, own)| !one.is_like(own))?;
    Some(format!(
        "the runs do not follow one mechanism: {} has {one}, {} has {other}, and their peaks are of different bodies; `rocking.mechanism` and `rocking.hinge` in the wall \
         file hold to one",
        name(*first),
        name(*second)
    ))
}

/// What rocks in a run.
struct Followed {
    mechanism: &'static str,
    /// Level of its hinge [m], and that over the height of the wall.
    hinge: [f64; 2],
}

impl Followed {
    fn of(model: &Model) -> Option<Followed> {
        let rocking = model.rocking()?;
        let top = model.wall.blocks.iter().map(|block| block.y[1]).fold(0.0, f64::max);
        Some(Followed { mechanism: rocking.kind.what(), hinge: [rocking.hinge, rocking.hinge / top] })
    }

    /// Walls of other sizes have their hinges at other levels.
    fn is_like(&self, other: &Followed) -> bool {
        self.mechanism == other.mechanism && (self.hinge[1] - other.hinge[1]).abs() <= 0.02
    }
}

impl fmt::Display for Followed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with its hinge at {:.2} m", self.mechanism, self.hinge[0])
    }
}

/// Numbers of the runs that are looked at: the first, the last and some between.
fn spread(all: usize) -> Vec<usize> {
    let last = all.min(LOOKED_AT).saturating_sub(1).max(1);
    (0..all.min(LOOKED_AT)).map(|k| (k * (all - 1) + last / 2) / last).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warning(kind: WarningKind, text: &str) -> Warning {
        Warning::new(kind, text)
    }

    #[test]
    fn runs_are_counted_by_kind_and_sentences_told_once() {
        let mut warned = Warned::default();
        let heavy =
            |load: &str| warning(WarningKind::HeavyBeam, &format!("the beam weighs 49050 N, load.top {load} N"));
        let slid = |joint: &str| warning(WarningKind::LargeSlip, &format!("joint {joint} slid by 12 %"));
        warned.add(|| "run 1".into(), &[heavy("12400"), slid("p1c1b1|p1c2b1"), slid("p1c3b1|p1c4b1")]);
        warned.add(|| "run 2".into(), &[heavy("-1.5e+4")]);
        warned.add(|| "run 3".into(), &[heavy("12400"), warning(WarningKind::Creep, "no joint slipped")]);
        warned.add(|| "run 4".into(), &[heavy("9")]);
        assert_eq!((warned.of, warned.runs), (4, 4));
        assert_eq!(warned.counts(), "heavy-beam 4, large-slip 1, creep 1");
        let told: Vec<String> = warned.sentences(&Warned::default()).iter().map(Sentence::to_string).collect();
        assert_eq!(told.len(), 3, "{told:?}");
        assert_eq!(told[0], "in every run, such as run 1: the beam weighs 49050 N, load.top 12400 N");
        assert_eq!(told[1], "in 1 of 4 runs, run 1: joint p1c1b1|p1c2b1 slid by 12 %");
        assert_eq!(told[2], "in 1 of 4 runs, run 3: no joint slipped");
        let mut known = Warned::default();
        known.add(String::new, &[heavy("1")]);
        assert_eq!(warned.sentences(&known).len(), 2);
        assert_eq!(kinds(&[slid("a"), heavy("1"), slid("b")]).as_deref(), Some("heavy-beam large-slip"));
        assert_eq!(kinds(&[]), None);
    }

    #[test]
    fn warnings_are_read_off_a_summary() {
        let summary = serde_json::json!({ "warnings": ["It fell.", "It is new."], "warning_kinds": ["collapse", "of-a-later-version"] });
        assert_eq!(of_summary(&summary), [warning(WarningKind::Collapse, "It fell.")]);
        assert!(of_summary(&Value::Null).is_empty());
    }

    #[test]
    fn runs_that_are_looked_at_are_spread_over_all() {
        assert_eq!((spread(0), spread(1), spread(3)), (vec![], vec![0], vec![0, 1, 2]));
        assert_eq!(spread(LOOKED_AT), (0..LOOKED_AT).collect::<Vec<_>>());
        let many = spread(1000);
        assert!(many.len() == LOOKED_AT && many[0] == 0 && many[LOOKED_AT - 1] == 999, "{many:?}");
        assert!(many.windows(2).all(|w| (66..=67).contains(&(w[1] - w[0]))), "{many:?}");
    }

    /// A sample of the runs says no more than it knows.
    #[test]
    fn of_many_runs_a_part_is_looked_at() {
        let mut case = concio::case::example().expect("a wall").case;
        case.load.beam = concio::case::Beam::Mass(concio::quantity::Mass::from_si(1e6));
        let told =
            |all| before(all, |_| Some(case.clone()), |number| format!("run {number}")).sentences()[0].to_string();
        assert!(told(2).starts_with("in every run: load.beam.mass: the beam weighs 9810000 N"), "{:?}", told(2));
        assert!(
            told(100).starts_with("in all 16 runs checked, of 100 in the study: load.beam.mass: the beam"),
            "{:?}",
            told(100)
        );
        case.motion.base = concio::case::Signal::None;
        case.motion.duration = None;
        let lost = before(1, |_| Some(case.clone()), |number| format!("run {number}")).sentences();
        assert!(lost.len() == 1 && lost[0].to_string().starts_with("run 0 cannot be run: motion.duration"), "{lost:?}");
    }
}
