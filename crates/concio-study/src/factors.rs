//! From the study file to factors: what varies, over which values, with errors that name the line.

use std::collections::{BTreeSet, HashSet};

use concio::Result;
use concio::quantity::shown;
use serde_json::Value;
use statrs::distribution::{ContinuousCDF, LogNormal, Normal};

use crate::file::{Distribution, DistributionLaw, Follower, Spacing, StudyFile, Vary};
use crate::motions;
use crate::values::{Changes, amount, few, number, written};

/// Factors that a study may have.
const MOST_FACTORS: usize = 1000;
/// Values, choices, motions or scales of one factor: each is tried alone.
const MOST_LEVELS: usize = 10_000;
/// Keys that one level changes, and keys that all factors change: each is compared with all others.
const MOST_CHANGES: usize = 1000;
const MOST_PATHS: usize = 10_000;

/// What varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// Heading of its column.
    pub name: String,
    /// Key of the study file that it stands at, for errors.
    pub key: String,
    /// Unit that all its values have, that of the key where they are numbers without one; empty for none, or where they differ.
    pub unit: String,
    /// Over what.
    pub over: Over,
}

/// Over what a factor varies.
#[derive(Debug, Clone, PartialEq)]
pub enum Over {
    /// Some levels.
    Levels(Vec<Level>),
    /// All values of a distribution.
    Values(Continuous),
    /// Factors on the motion of the base.
    Scales(Vec<f64>),
}

/// A level of a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// What stands in its column: the value as the wall file says it, or the name of a choice.
    pub label: Value,
    /// Changes of the wall file.
    pub changes: Changes,
    /// Where it stands on a scale of its own: the number of a value, the share of a range; none of a name, and of values
    /// that do not have one unit.
    pub place: Option<f64>,
}

/// A quantity with a distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Continuous {
    path: String,
    unit: String,
    law: Law,
    also: Vec<Follower>,
}

#[derive(Debug, Clone, PartialEq)]
enum Law {
    Uniform([f64; 2]),
    LogUniform([f64; 2]),
    /// Of the value or, `log`, its logarithm; cut off at the two shares.
    Normal {
        mean: f64,
        deviation: f64,
        log: bool,
        shares: [f64; 2],
    },
    Triangular {
        low: f64,
        mode: f64,
        high: f64,
    },
}

/// Values that the shares 0 and 1 of an unbounded distribution stand for lie at this share from its ends.
const TAIL: f64 = 1e-6;

impl Continuous {
    /// The value below which lies this share of the distribution, 0 … 1, in the unit of the file.
    pub fn quantile(&self, share: f64) -> f64 {
        match &self.law {
            Law::Uniform([low, high]) => low + share * (high - low),
            Law::LogUniform([low, high]) => low * (high / low).powf(share),
            Law::Normal { mean, deviation, log, shares: [from, to] } => {
                // Ends that are given hold; where none are, the share stops short of infinity.
                let ends = [if *from > 0.0 { *from } else { TAIL }, if *to < 1.0 { *to } else { 1.0 - TAIL }];
                let share = (from + share * (to - from)).max(ends[0]).min(ends[1]);
                // Deviations were checked to be above 0.
                if *log {
                    LogNormal::new(*mean, *deviation).map_or(f64::NAN, |d| d.inverse_cdf(share))
                } else {
                    Normal::new(*mean, *deviation).map_or(f64::NAN, |d| d.inverse_cdf(share))
                }
            }
            Law::Triangular { low, mode, high } => {
                let width = high - low;
                let at_mode = (mode - low) / width;
                if share < at_mode {
                    low + (share * width * (mode - low)).sqrt()
                } else {
                    high - ((1.0 - share) * width * (high - mode)).sqrt()
                }
            }
        }
    }

    /// The level at this share.
    pub fn level(&self, share: f64) -> Level {
        let value = self.quantile(share);
        let label = written(value, &self.unit);
        let mut changes = vec![(self.path.clone(), label.clone())];
        changes.extend(self.also.iter().map(|f| (f.path.clone(), written(value * f.times, &self.unit))));
        Level { label, changes, place: Some(share) }
    }

    /// Whether it has a least and a largest value; a bell curve that is not cut off on both sides has none.
    pub fn is_bounded(&self) -> bool {
        match self.law {
            Law::Normal { shares: [from, to], .. } => from >= TAIL && to <= 1.0 - TAIL,
            _ => true,
        }
    }
}

impl Factor {
    /// Key paths that it changes, each once.
    fn paths(&self) -> Vec<&str> {
        match &self.over {
            Over::Levels(levels) => {
                let all = levels.iter().flat_map(|l| l.changes.iter().map(|(path, _)| path.as_str()));
                all.collect::<BTreeSet<_>>().into_iter().collect()
            }
            Over::Values(values) => {
                [values.path.as_str()].into_iter().chain(values.also.iter().map(|f| f.path.as_str())).collect()
            }
            Over::Scales(_) => Vec::new(),
        }
    }

    /// Whether it changes what stands at a key of the wall file, a part of that, or more than that.
    pub fn changes(&self, key: &str) -> bool {
        let key = steps(key);
        self.paths().into_iter().any(|path| meet(&steps(path), &key))
    }

    /// The paths that are changed at once, level by level, but for levels that change the same as the one before.
    fn together(&self) -> Vec<Vec<&str>> {
        match &self.over {
            Over::Levels(levels) => {
                let of = levels.iter().map(|l| l.changes.iter().map(|(path, _)| path.as_str()).collect());
                let mut all: Vec<Vec<&str>> = of.collect();
                all.dedup();
                all
            }
            Over::Values(_) => vec![self.paths()],
            Over::Scales(_) => Vec::new(),
        }
    }

    /// Number of levels; none for a distribution.
    pub fn levels(&self) -> Option<usize> {
        match &self.over {
            Over::Levels(levels) => Some(levels.len()),
            Over::Scales(scales) => Some(scales.len()),
            Over::Values(_) => None,
        }
    }

    /// What a level of it is called; empty for a distribution.
    pub fn label(&self, level: usize) -> String {
        let label = match &self.over {
            Over::Levels(levels) => levels[level].label.clone(),
            Over::Scales(scales) => number(scales[level]),
            Over::Values(_) => return String::new(),
        };
        label.as_str().map_or_else(|| label.to_string(), str::to_string)
    }

    /// Where its levels stand between the least and the largest, 0 … 1: by their values, names at equal distances. Empty
    /// for a distribution.
    pub fn places(&self) -> Vec<f64> {
        let numbers: Option<Vec<f64>> = match &self.over {
            Over::Values(_) => return Vec::new(),
            Over::Scales(scales) => Some(scales.clone()),
            Over::Levels(levels) => levels.iter().map(|l| l.place).collect(),
        };
        let numbers = numbers.unwrap_or_else(|| (0..self.levels().unwrap_or(0)).map(|i| i as f64).collect());
        let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let width = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low;
        numbers.iter().map(|v| if width > 0.0 { (v - low) / width } else { 0.0 }).collect()
    }

    /// Whether its values have an order: numbers do, of names two alone, the first and the second.
    pub fn is_ordered(&self) -> bool {
        match &self.over {
            Over::Values(_) | Over::Scales(_) => true,
            Over::Levels(levels) => levels.len() <= 2 || levels.iter().all(|l| l.place.is_some()),
        }
    }
}

/// The factors of a study: those of `vary`, then the motions, then the scales.
///
/// # Errors
/// What contradicts itself, is empty or out of range, with its line.
pub fn factors(file: &StudyFile) -> Result<Vec<Factor>> {
    let study = &file.study;
    for (key, empty) in [("vary", study.factors.is_empty()), ("motion", study.motions.is_empty())] {
        if empty && file.document.has(key) {
            return Err(file.wrong(key, "is empty: nothing varies by it", &format!("`[[{key}]]`, or no `{key}`")));
        }
    }
    if study.factors.len() > MOST_FACTORS {
        let what = format!("{} factors are too many", study.factors.len());
        return Err(file.wrong("vary", what, &format!("up to {MOST_FACTORS}")));
    }
    for (key, levels) in [("motion", study.motions.len()), ("scales", study.scales.len())] {
        few(levels, MOST_LEVELS, |what, allowed| file.wrong(key, what, allowed))?;
    }
    let mut factors = Vec::new();
    for (index, vary) in study.factors.iter().enumerate() {
        factors.push(Reader { file, vary, key: format!("vary[{index}]") }.factor()?);
    }
    if !study.motions.is_empty() {
        factors.push(motion_factor(file)?);
    }
    if !study.scales.is_empty() {
        if let Some(i) = study.scales.iter().position(|s| !(*s > 0.0 && s.is_finite())) {
            return Err(file.wrong(
                &format!("scales[{i}]"),
                format!("{} is out of range", shown(study.scales[i])),
                "above 0",
            ));
        }
        if factors.iter().any(|f| f.paths().contains(&"group.acceleration")) {
            let what = "`scales` and `group.acceleration` contradict each other: both set the strength of the motion";
            return Err(file.wrong("scales", what, "one of both"));
        }
        let over = Over::Scales(study.scales.clone());
        factors.push(Factor { name: "scale".into(), key: "scales".into(), unit: String::new(), over });
    }
    names(file, &factors)?;
    contradictions(file, &factors)?;
    Ok(factors)
}

/// Names are headings of the table of runs: each is there once.
fn names(file: &StudyFile, factors: &[Factor]) -> Result<()> {
    for (index, factor) in factors.iter().enumerate() {
        if let Some(other) = factors[..index].iter().find(|f| f.name == factor.name) {
            let what = format!("`{}` is the name of two factors, here and at {}", factor.name, other.key);
            return Err(file.wrong(&factor.key, what, "a `name` of its own for each"));
        }
        if crate::measures::is_column(&factor.name) {
            let what = format!("`{}` is a column that the table of runs has already", factor.name);
            return Err(file.wrong(&format!("{}.name", factor.key), what, "another `name`"));
        }
    }
    Ok(())
}

/// Two factors that change one key: the later would silently win.
fn contradictions(file: &StudyFile, factors: &[Factor]) -> Result<()> {
    // Of all factors before, with the place of each.
    let mut before: Vec<(Steps, usize)> = Vec::new();
    for (index, factor) in factors.iter().enumerate() {
        let paths = factor.paths();
        few(before.len() + paths.len(), MOST_PATHS, |what, allowed| file.wrong(&factor.key, what, allowed))?;
        let own: Vec<Steps> = paths.iter().map(|path| steps(path)).collect();
        for (path, own) in paths.iter().zip(&own) {
            if let Some((_, other)) = before.iter().find(|(other, _)| meet(other, own)) {
                let what = format!("`{}` and `{}` both change {path}", factors[*other].name, factor.name);
                return Err(file.wrong(&factor.key, what, "each key changed by one factor"));
            }
        }
        before.extend(own.into_iter().map(|own| (own, index)));
        for paths in factor.together() {
            few(paths.len(), MOST_CHANGES, |what, allowed| file.wrong(&factor.key, what, allowed))?;
            let all: Vec<Steps> = paths.iter().map(|path| steps(path)).collect();
            let twice = |i: &usize| all[..*i].iter().any(|other| meet(other, &all[*i]));
            if let Some(i) = (1..paths.len()).find(twice) {
                let what = format!("`{}` changes {} twice", factor.name, paths[i]);
                return Err(file.wrong(&factor.key, what, "each key changed once"));
            }
        }
    }
    Ok(())
}

/// A key path in its parts.
type Steps = Vec<String>;

/// Those of a path. A group is the key that realises it; those of the base are set by scaling what its motion is.
fn steps(path: &str) -> Steps {
    let key = match path.strip_prefix("group.") {
        Some("acceleration" | "frequency") | None => path,
        Some(name) => crate::groups::realised_by(name).unwrap_or(path),
    };
    key.split(['.', '[']).map(str::to_string).collect()
}

/// Whether two paths change one key: they are the same, or one leads to a part of the other.
fn meet(a: &Steps, b: &Steps) -> bool {
    let same = |a: &String, b: &String| a == b || (a.ends_with(']') && b.ends_with(']') && (a == "*]" || b == "*]"));
    a.iter().zip(b).all(|(a, b)| same(a, b))
}

fn motion_factor(file: &StudyFile) -> Result<Factor> {
    let folder = file.document.folder();
    let mut levels: Vec<Level> = Vec::new();
    let mut names = HashSet::new();
    for (index, motion) in file.study.motions.iter().enumerate() {
        let key = format!("motion[{index}]");
        let label = Value::String(motion.name.clone());
        if !names.insert(&motion.name) {
            return Err(file.wrong(&format!("{key}.name"), "two motions have this name", "names that differ"));
        }
        let json = |v: serde_json::Result<Value>| v.map_err(|e| file.wrong(&key, e.to_string(), ""));
        let mut changes = Vec::new();
        let given = [("base", Some(&motion.base)), ("vertical", motion.vertical.as_ref())];
        for (name, signal) in given.into_iter().filter_map(|(name, signal)| Some((name, signal?))) {
            if let concio::case::Signal::Record(record) = signal {
                let path = folder.join(&record.record);
                if !path.is_file() {
                    let what = format!("there is no file {}", path.display());
                    let allowed = "a record, relative to the study file";
                    return Err(file.wrong(&format!("{key}.{name}.record"), what, allowed));
                }
            }
            // As the file says it: whether a number has a unit is asked about.
            let given = file.document.given(&format!("{key}.{name}"));
            let mut value = given.map_or_else(|| json(serde_json::to_value(signal)), Ok)?;
            if let concio::case::Signal::Record(record) = motions::rooted(signal, &folder) {
                value["record"] = json(serde_json::to_value(record.record))?;
            }
            changes.push((format!("motion.{name}"), value));
        }
        if let Some(duration) = motion.duration {
            changes.push(("motion.duration".into(), json(serde_json::to_value(duration))?));
        }
        levels.push(Level { label, changes, place: None });
    }
    Ok(Factor { name: "motion".into(), key: "motion".into(), over: Over::Levels(levels), unit: String::new() })
}

/// Reads one entry of `vary`.
struct Reader<'a> {
    file: &'a StudyFile,
    vary: &'a Vary,
    key: String,
}

impl Reader<'_> {
    fn factor(&self) -> Result<Factor> {
        let v = self.vary;
        let ways = [
            (!v.values.is_empty(), "values"),
            (v.from.is_some() || v.to.is_some(), "from"),
            (v.distribution.is_some(), "distribution"),
            (!v.choices.is_empty(), "choices"),
        ];
        let given: Vec<&str> = ways.iter().filter(|w| w.0).map(|w| w.1).collect();
        let one = "exactly one of `values` (at least one), `from` with `to`, `distribution`, `choices` (at least one)";
        match given[..] {
            [] => return Err(self.wrong("", "nothing says over what it varies: it is empty", one)),
            [_] => {}
            _ => {
                return Err(self.wrong(
                    given[1],
                    format!("`{}` and `{}` contradict each other", given[0], given[1]),
                    one,
                ));
            }
        }
        let over = match given[0] {
            "choices" => self.choices()?,
            "values" => Over::Levels(self.values()?),
            "from" => self.range()?,
            _ => Over::Values(self.distribution()?),
        };
        let name = match (&v.name, &v.path) {
            (Some(name), _) => name.clone(),
            (None, Some(path)) => path.clone(),
            (None, None) => return Err(self.wrong("", "choices have no path to be named after", "a `name`")),
        };
        let unit = match &over {
            Over::Values(values) => Some(values.unit.clone()),
            Over::Levels(levels) => one_unit(levels.iter().map(|l| &l.label)).filter(|_| v.choices.is_empty()),
            Over::Scales(_) => None,
        };
        // Numbers without a unit are in that of their key.
        let of_key = |unit: String| if unit.is_empty() { concio::case::unit(v.path.as_deref()?) } else { Some(unit) };
        Ok(Factor { name, key: self.key.clone(), unit: unit.and_then(of_key).unwrap_or_default(), over })
    }

    fn wrong(&self, key: &str, what: impl Into<String>, allowed: &str) -> concio::Error {
        let key = if key.is_empty() { self.key.clone() } else { format!("{}.{key}", self.key) };
        self.file.wrong(&key, what, allowed)
    }

    fn few(&self, key: &str, levels: usize) -> Result<()> {
        few(levels, MOST_LEVELS, |what, allowed| self.wrong(key, what, allowed))
    }

    fn path(&self) -> Result<String> {
        self.vary.path.clone().ok_or_else(|| self.wrong("path", "the key is missing", "a key path of the wall file"))
    }

    fn choices(&self) -> Result<Over> {
        let v = self.vary;
        for (given, key) in [(v.path.is_some(), "path"), (!v.also.is_empty(), "also"), (v.count.is_some(), "count")] {
            if given {
                return Err(self.wrong(
                    key,
                    format!("`{key}` has no meaning beside `choices`"),
                    "`set` in each choice",
                ));
            }
        }
        let level = |choice: &crate::file::Choice| Level {
            label: Value::String(choice.name.clone()),
            changes: choice.set.iter().map(|(k, v)| (k.clone(), v.clone())).collect(),
            place: None,
        };
        self.few("choices", v.choices.len())?;
        let mut names = HashSet::new();
        for (i, choice) in v.choices.iter().enumerate() {
            if !names.insert(&choice.name) {
                return Err(self.wrong(
                    &format!("choices[{i}].name"),
                    "two choices have this name",
                    "names that differ",
                ));
            }
        }
        Ok(Over::Levels(v.choices.iter().map(level).collect()))
    }

    fn values(&self) -> Result<Vec<Level>> {
        let values = &self.vary.values;
        self.few("values", values.len())?;
        // 0 and -0 are one number.
        let of = |v: &Value| amount(v).map_or_else(|| (v.to_string(), 0), |(v, unit)| (unit, (v + 0.0).to_bits() + 1));
        let mut seen = HashSet::new();
        if let Some(i) = (0..values.len()).find(|&i| !seen.insert(of(&values[i]))) {
            let what = format!("{} stands here twice", values[i]);
            return Err(self.wrong(&format!("values[{i}]"), what, "values that differ"));
        }
        let mut unit = None;
        if values.iter().all(|v| amount(v).is_some()) {
            // Numbers have an order, which differing units would hide.
            for (i, value) in values.iter().enumerate() {
                self.amount(&format!("values[{i}]"), Some(value), &mut unit)?;
            }
        }
        let mut levels = values.iter().map(|value| self.level(value)).collect::<Result<Vec<_>>>()?;
        if unit.is_none() {
            levels.iter_mut().for_each(|level| level.place = None);
        }
        Ok(levels)
    }

    fn level(&self, value: &Value) -> Result<Level> {
        let mut changes = vec![(self.path()?, value.clone())];
        if !self.vary.also.is_empty() {
            let (amount, unit) =
                amount(value).ok_or_else(|| self.wrong("also", "follows a number, and a value is none", "numbers"))?;
            changes.extend(self.vary.also.iter().map(|f| (f.path.clone(), written(amount * f.times, &unit))));
        }
        Ok(Level { label: value.clone(), changes, place: amount(value).map(|(number, _)| number) })
    }

    /// The number given at a key, and its unit, which has to be `unit` if that is known.
    fn amount(&self, key: &str, value: Option<&Value>, unit: &mut Option<String>) -> Result<f64> {
        let value = value.ok_or_else(|| self.wrong(key, "the key is missing", "a number, or a text with a unit"))?;
        let (number, found) = amount(value)
            .ok_or_else(|| self.wrong(key, format!("{value} is no number"), "a number, or a text with a unit"))?;
        match unit {
            Some(unit) if *unit != found => {
                let name = |u: &str| if u.is_empty() { "none".to_string() } else { format!("`{u}`") };
                Err(self.wrong(
                    key,
                    format!("its unit is {}, that of the others {}", name(&found), name(unit)),
                    "one unit",
                ))
            }
            _ => {
                *unit = Some(found);
                Ok(number)
            }
        }
    }

    fn range(&self) -> Result<Over> {
        let v = self.vary;
        let mut unit = None;
        let low = self.amount("from", v.from.as_ref(), &mut unit)?;
        let high = self.amount("to", v.to.as_ref(), &mut unit)?;
        if !(low < high) {
            return Err(self.wrong(
                "to",
                format!("{} does not lie above `from`, {}", shown(high), shown(low)),
                "above `from`",
            ));
        }
        let law = match v.spacing {
            Spacing::Linear => Law::Uniform([low, high]),
            Spacing::Log if low > 0.0 => Law::LogUniform([low, high]),
            Spacing::Log => return Err(self.wrong("from", format!("{} has no logarithm", shown(low)), "above 0")),
        };
        let continuous = self.continuous(unit, law)?;
        match v.count {
            None => Ok(Over::Values(continuous)),
            Some(count) if count > MOST_LEVELS => {
                Err(self.wrong("count", format!("{count} is out of range"), &format!("from 2 to {MOST_LEVELS}")))
            }
            Some(count) if count >= 2 => {
                let share = |i: usize| i as f64 / (count - 1) as f64;
                Ok(Over::Levels((0..count).map(|i| continuous.level(share(i))).collect()))
            }
            Some(count) => Err(self.wrong("count", format!("{count} is out of range"), "from 2")),
        }
    }

    fn continuous(&self, unit: Option<String>, law: Law) -> Result<Continuous> {
        let also = self.vary.also.clone();
        Ok(Continuous { path: self.path()?, unit: unit.unwrap_or_default(), law, also })
    }

    fn distribution(&self) -> Result<Continuous> {
        let Some(given) = &self.vary.distribution else {
            return Err(self.wrong("distribution", "the key is missing", "a distribution"));
        };
        if self.vary.count.is_some() {
            return Err(self.wrong(
                "count",
                "`count` belongs to a range, not to a distribution",
                "`from` and `to`, or no `count`",
            ));
        }
        let mut unit = None;
        let law = self.law(given, &mut unit)?;
        self.continuous(unit, law)
    }

    fn law(&self, given: &Distribution, unit: &mut Option<String>) -> Result<Law> {
        use DistributionLaw::{LogUniform, Lognormal, Normal as Bell, Triangular, Uniform};
        let used: &[&str] = match given.law {
            Uniform | LogUniform => &["low", "high"],
            Bell => &["mean", "deviation", "low", "high"],
            Lognormal => &["median", "dispersion", "low", "high"],
            Triangular => &["low", "mode", "high"],
        };
        let keys = [
            ("mean", given.mean.is_some()),
            ("deviation", given.deviation.is_some()),
            ("median", given.median.is_some()),
            ("dispersion", given.dispersion.is_some()),
            ("mode", given.mode.is_some()),
        ];
        if let Some((key, _)) = keys.iter().find(|(key, is)| *is && !used.contains(key)) {
            let allowed = used.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ");
            return Err(self.wrong(&format!("distribution.{key}"), "has no meaning for this law", &allowed));
        }
        let mut at =
            |key: &str, value: &Option<Value>| self.amount(&format!("distribution.{key}"), value.as_ref(), unit);
        let law = match given.law {
            Uniform => Law::Uniform([at("low", &given.low)?, at("high", &given.high)?]),
            LogUniform => Law::LogUniform([at("low", &given.low)?, at("high", &given.high)?]),
            Triangular => {
                let (low, mode, high) = (at("low", &given.low)?, at("mode", &given.mode)?, at("high", &given.high)?);
                Law::Triangular { low, mode, high }
            }
            Bell | Lognormal => {
                let log = given.law == Lognormal;
                let (mean, deviation) = if log {
                    let median = at("median", &given.median)?;
                    let dispersion = given
                        .dispersion
                        .ok_or_else(|| self.wrong("distribution.dispersion", "the key is missing", "above 0"))?;
                    (median.ln(), dispersion)
                } else {
                    (at("mean", &given.mean)?, at("deviation", &given.deviation)?)
                };
                if !(deviation > 0.0 && deviation.is_finite() && mean.is_finite()) {
                    let (center, spread) = if log { ("median", "dispersion") } else { ("mean", "deviation") };
                    let what = format!("`{center}` and `{spread}` make no distribution");
                    return Err(self.wrong("distribution", what, &format!("`{spread}` above 0, a median above 0")));
                }
                let mut end = |key: &str, value: &Option<Value>, none: f64| -> Result<f64> {
                    if value.is_none() { Ok(none) } else { at(key, value) }
                };
                let ends = [end("low", &given.low, f64::NEG_INFINITY)?, end("high", &given.high, f64::INFINITY)?];
                self.cut(mean, deviation, log, ends)?
            }
        };
        let falls = match &law {
            Law::Uniform([low, high]) => !(low < high),
            Law::LogUniform([low, high]) => !(*low > 0.0 && low < high),
            Law::Triangular { low, mode, high } => !(low <= mode && mode <= high && low < high),
            Law::Normal { shares: [from, to], .. } => !(to > from),
        };
        if falls {
            return Err(self.wrong(
                "distribution",
                "its ends do not follow each other",
                "`low` below `high`, `mode` between, logarithms of what is above 0",
            ));
        }
        Ok(law)
    }

    fn cut(&self, mean: f64, deviation: f64, log: bool, ends: [f64; 2]) -> Result<Law> {
        let normal = Normal::new(mean, deviation).map_err(|e| self.wrong("distribution", e.to_string(), ""))?;
        let share = |end: f64| match log {
            true if end <= 0.0 => 0.0,
            true => normal.cdf(end.ln()),
            false => normal.cdf(end),
        };
        Ok(Law::Normal { mean, deviation, log, shares: ends.map(share) })
    }
}

/// The unit that all values have, empty where they have none; none where some are no numbers or their units differ.
fn one_unit<'v>(values: impl Iterator<Item = &'v Value>) -> Option<String> {
    let mut units = values.map(|value| amount(value).map(|(_, unit)| unit));
    let first = units.next()??;
    units.all(|unit| unit.as_ref() == Some(&first)).then_some(first)
}
