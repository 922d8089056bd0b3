//! The runs of a study: each with the values of its factors and the wall that they make.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use concio::case::{Case, CaseFile, Signal, canonical_json};
use concio::ground::Library;
use concio::quantity::Time;
use concio::warning::Warning;
use concio::{Error, InputError, Result};
use serde_json::Value;

use crate::design::{At, points};
use crate::factors::{Factor, Over, factors};
use crate::file::StudyFile;
use crate::intensity::Intensity;
use crate::values::Changes;
use crate::{groups, motions};

/// A study with its runs.
#[derive(Debug)]
pub struct Plan {
    /// The file.
    pub file: StudyFile,
    /// What varies.
    pub factors: Vec<Factor>,
    /// Per run, where each factor stands.
    pub points: Vec<Vec<At>>,
    /// What is to be known of its motions before its answers are believed.
    pub doubts: Vec<String>,
    /// Accelerograms that were read for checks.
    pub library: Library,
    records: Records,
}

/// Digits of an id.
const DIGITS: usize = 32;

/// Hashes of record files, each read once.
#[derive(Debug, Default)]
pub struct Records(Mutex<HashMap<PathBuf, String>>);

impl Plan {
    /// The runs that a study file describes, each level of each factor tried; what it asks of them is not looked at
    /// ([`crate::questions`]).
    ///
    /// # Errors
    /// [`Error::Input`] with file and line.
    pub(crate) fn laid_out(file: StudyFile) -> Result<Self> {
        let factors = factors(&file)?;
        let points = points(&file, &factors)?;
        let plan = Plan {
            file,
            factors,
            points,
            doubts: Vec::new(),
            library: Library::default(),
            records: Records::default(),
        };
        plan.try_levels()?;
        Ok(plan)
    }

    /// Each level alone, so that a message names the value at fault; their combinations are looked at by [`Plan::case`].
    fn try_levels(&self) -> Result<()> {
        for factor in &self.factors {
            let levels: Vec<(String, Changes)> = match &factor.over {
                Over::Levels(levels) => {
                    let key = |i: usize| self.level_key(factor, i);
                    levels.iter().enumerate().map(|(i, l)| (key(i), l.changes.clone())).collect()
                }
                Over::Values(values) => {
                    [0.0, 1.0].map(|share| (format!("{}.path", factor.key), values.level(share).changes)).to_vec()
                }
                Over::Scales(_) => continue,
            };
            for (key, changes) in levels {
                let at = || self.lost_path(factor, &changes).unwrap_or(key);
                self.laid(&changes).map_err(|e| self.file.of_wall(&at(), beside(e, &changes)))?;
            }
        }
        Ok(())
    }

    /// Where a factor gives a path that the wall refuses in the same words whatever stands there: no value is at fault then.
    fn lost_path(&self, factor: &Factor, changes: &Changes) -> Option<String> {
        let vary = self.file.study.factors.iter().enumerate().filter(|(_, v)| v.path.is_some());
        let key = vary.map(|(i, _)| format!("vary[{i}]")).find(|key| *key == factor.key)?;
        let refused = |path: &str, value: &Value| match self.laid(&vec![(path.to_string(), value.clone())]) {
            Err(Error::Input(e)) => Some((e.key, e.what)),
            _ => None,
        };
        let others = [Value::Null, Value::Object(serde_json::Map::new())];
        let lost = |(path, value): &(String, Value)| {
            let found = refused(path, value);
            found.is_some() && others.iter().all(|other| refused(path, other) == found)
        };
        // The path of the factor comes first, those of `also` behind it.
        match changes.iter().position(lost)? {
            0 => Some(format!("{key}.path")),
            place => Some(format!("{key}.also[{}].path", place - 1)),
        }
    }

    fn level_key(&self, factor: &Factor, level: usize) -> String {
        let vary = self.file.study.factors.iter().enumerate();
        let of = vary.map(|(i, v)| (format!("vary[{i}]"), v)).find(|(key, _)| *key == factor.key);
        match of {
            Some((key, v)) if !v.values.is_empty() => format!("{key}.values[{level}]"),
            Some((key, v)) if !v.choices.is_empty() => format!("{key}.choices[{level}].set"),
            Some((key, _)) => format!("{key}.path"),
            None => format!("{}[{level}]", factor.key),
        }
    }

    /// Value of every factor in run `number`, as tables show them.
    pub fn labels(&self, number: usize) -> Vec<Value> {
        let label = |(at, factor): (&At, &Factor)| match (&factor.over, at) {
            (Over::Levels(levels), At::Level(level)) => levels[*level].label.clone(),
            (Over::Scales(scales), At::Level(level)) => crate::values::number(scales[*level]),
            (Over::Values(values), At::Share(share)) => values.level(*share).label,
            _ => Value::Null,
        };
        self.points[number].iter().zip(&self.factors).map(label).collect()
    }

    /// The wall of run `number`, complete and valid, its output set to what the study keeps.
    ///
    /// # Errors
    /// [`Error::Input`] where the values of this run make no wall.
    pub fn case(&self, number: usize) -> Result<Case> {
        self.scaled_case(number, 1.0)
    }

    /// The same with the base moving `factor` times as strongly as it would.
    ///
    /// # Errors
    /// As [`Plan::case`].
    pub fn scaled_case(&self, number: usize, factor: f64) -> Result<Case> {
        let (changes, scale) = self.setting(number);
        self.changed(&changes, scale * factor).map_err(|e| {
            let labels: Vec<String> =
                self.factors.iter().zip(self.labels(number)).map(|(f, l)| format!("{} = {l}", f.name)).collect();
            let mut key = self.factors.first().map_or("wall".to_string(), |f| f.key.clone());
            if let (Some(motion), Error::Input(e)) = (self.motion(number), &e)
                && e.key.as_deref().is_some_and(|k| k.starts_with("motion."))
            {
                key = format!("motion[{motion}]");
            }
            let also = if self.is_left_behind(&e, &changes) { "; `also` lets another key follow" } else { "" };
            match self.file.of_wall(&key, e) {
                Error::Input(e) => e.help(format!("in run {} with {}{also}", number + 1, labels.join(", "))).into(),
                other => other,
            }
        })
    }

    /// Whether a wall with some changes is refused for a key that none of them touches: it does not suit what varies.
    fn is_left_behind(&self, error: &Error, changes: &Changes) -> bool {
        let Error::Input(e) = error else { return false };
        let of_wall = e.file.as_deref().is_none_or(|file| Some(file) == self.file.wall.path());
        let (Some(key), true) = (&e.key, of_wall) else { return false };
        // Without places in lists: `[*]` stands for each.
        let plain = |path: &str| path.split(['[', ']']).step_by(2).collect::<String>();
        let refused = plain(key);
        let touches = |(path, _): &(String, Value)| {
            let path = plain(path);
            path.starts_with(groups::PREFIX) || path.starts_with(&refused) || refused.starts_with(&path)
        };
        self.file.study.factors.iter().any(|v| v.path.is_some()) && !changes.iter().any(touches)
    }

    /// What run `number` changes of the wall file, and how much stronger its base moves.
    pub fn setting(&self, number: usize) -> (Changes, f64) {
        let mut changes: Changes = Vec::new();
        let mut scale = 1.0;
        for (at, factor) in self.points[number].iter().zip(&self.factors) {
            match (&factor.over, at) {
                (Over::Levels(levels), At::Level(level)) => changes.extend(levels[*level].changes.iter().cloned()),
                (Over::Values(values), At::Share(share)) => changes.extend(values.level(*share).changes),
                (Over::Scales(scales), At::Level(level)) => scale = scales[*level],
                _ => {}
            }
        }
        (changes, scale)
    }

    /// The motion of run `number`, by its place in the study file; none where that gives no motions.
    pub fn motion(&self, number: usize) -> Option<usize> {
        let motion = self.factors.iter().position(|f| f.key == "motion")?;
        match self.points[number].get(motion) {
            Some(At::Level(level)) => Some(*level),
            _ => None,
        }
    }

    /// Per run a number that it shares with the runs under the same motion, however strong: of the same `[[motion]]`, or of the wall file, with the same changes of what shakes the base.
    pub fn motions(&self) -> Vec<usize> {
        let mut known: HashMap<String, usize> = HashMap::new();
        let of = |number: usize| {
            let shakes = |(path, _): &&(String, Value)| {
                let strength =
                    ["pga", "acceleration", "amplitude", "scale"].contains(&path.rsplit('.').next().unwrap_or(path));
                let moves =
                    ["motion.base", "motion.vertical", "group.frequency"].iter().any(|key| path.starts_with(key));
                path == "motion" || moves && !strength
            };
            let told: Vec<String> =
                self.setting(number).0.iter().filter(shakes).map(|(path, value)| format!("{path} {value}")).collect();
            let next = known.len();
            *known.entry(told.join("\n")).or_insert(next)
        };
        (0..self.points.len()).map(of).collect()
    }

    /// What is to be known of answers that take motions as a sample where all runs are under one.
    pub fn one_motion(&self) -> Option<String> {
        let study = &self.file.study;
        let sampled = (study.ida.is_some() || study.cracks.is_some()) && self.points.len() > 1;
        (sampled && self.motions().iter().all(|motion| *motion == 0)).then(|| {
            "all runs are under one motion: the scatter between records is not in what they tell, nor in any interval; more [[motion]] bring it in".into()
        })
    }

    /// One sentence for each acceleration of run `number` that stands in the wall file or the study file without a unit and was hardly meant in m/s². An
    /// incremental analysis sets the strength of the motion itself, but for a factor on it.
    pub fn unit_doubts(&self, number: usize) -> Vec<Warning> {
        let own = self.file.study.ida.as_ref().is_some_and(|ida| ida.intensity != Intensity::Scale);
        let set = |w: &Warning| own && w.starts_with("motion.base.");
        let found = self.file.wall.unit_doubts_with(&self.setting(number).0);
        found.into_iter().filter(|w| !set(w)).collect()
    }

    /// Whether the study changes what stands at a key of the wall file.
    pub fn sets(&self, key: &str) -> bool {
        self.factors.iter().any(|factor| factor.changes(key))
    }

    /// The study's wall with some changes; groups among them are solved for when all else is as it will be.
    fn laid(&self, changes: &Changes) -> Result<CaseFile> {
        let (of_groups, plain): (Changes, Changes) =
            changes.iter().cloned().partition(|(path, _)| path.starts_with(groups::PREFIX));
        let file = self.file.wall.changed(&plain)?;
        if of_groups.is_empty() {
            return Ok(file);
        }
        groups::realise(&self.file.wall, plain, &of_groups)
    }

    /// The study's wall with some changes, its base moving `scale` times as strongly.
    ///
    /// # Errors
    /// [`Error::Input`] where that is no wall, located in the wall file.
    pub fn changed(&self, changes: &Changes, scale: f64) -> Result<Case> {
        let mut file = self.laid(changes)?;
        let folder = file.folder().to_path_buf();
        let motion = &mut file.case.motion;
        // Motions of the study file are rooted already; all others start from the wall's folder.
        let last = |key: &str| changes.iter().rev().find(|(path, _)| path == key);
        let rooted = |key: &str| last(key).is_some_and(|change| self.is_motion(change));
        let rooted = ["motion.base", "motion.top", "motion.vertical"].map(rooted);
        for (signal, _) in motion.signals_mut().into_iter().zip(rooted).filter(|(_, rooted)| !rooted) {
            *signal = motions::rooted(signal, &folder);
        }
        if scale != 1.0 {
            motions::strengthen(motion, scale);
        }
        if !self.file.study.keep.results {
            quiet(&mut file);
        }
        file.validate()?;
        Ok(file.case)
    }

    /// Whether a change is one of the study file's `[[motion]]`.
    fn is_motion(&self, change: &(String, Value)) -> bool {
        let motions = self.factors.iter().filter(|f| f.key == "motion");
        motions
            .into_iter()
            .any(|f| matches!(&f.over, Over::Levels(levels) if levels.iter().any(|l| l.changes.contains(change))))
    }

    /// What the result of a case is known by.
    ///
    /// # Errors
    /// A record that cannot be read.
    pub fn id(&self, case: &Case) -> Result<String> {
        self.records.id(case, &self.library)
    }
}

/// Asks of a path that leads nowhere whether it is one of the wall file with a step less: `motion.base.pga`, not `motion.base.record.pga`.
fn beside(error: Error, changes: &Changes) -> Error {
    let Error::Input(mut error) = error else { return error };
    let shorter = |path: &String| {
        let steps: Vec<&str> = path.split('.').collect();
        let without = |k: usize| [&steps[..k], &steps[k + 1..]].concat().join(".");
        let found =
            (1..steps.len().saturating_sub(1)).map(without).find(|other| concio::case::describe(other).is_some());
        found.filter(|_| concio::case::describe(path).is_none())
    };
    let found = changes.iter().find_map(|(path, _)| shorter(path));
    error.help = error.help.take().or(found.map(|path| format!("did you mean the path `{path}`?")));
    Error::Input(error)
}

/// Said of a record that the system does not give.
pub(crate) fn cannot_be_read(path: &Path, reason: &concio::files::Unread) -> InputError {
    InputError::new(format!("cannot be read: {reason}")).in_file(path).allowed("an accelerogram that can be read")
}

/// Keeps no histories and no frames: a study reads peaks, energies and cracks.
fn quiet(file: &mut CaseFile) {
    let output = &mut file.case.output;
    output.frames = Some(Time::from_si(0.0));
    output.blocks.clear();
    output.joints.clear();
    output.interval = None;
}

impl Records {
    /// BLAKE3 of the resolved case with the content of its records in place of their paths, and of the versions of
    /// program, result files and measures; 32 hexadecimal digits.
    ///
    /// # Errors
    /// A record that cannot be read.
    pub fn id(&self, case: &Case, library: &Library) -> Result<String> {
        let mut case = case.clone();
        for signal in case.motion.signals_mut() {
            if let Signal::Record(input) = signal {
                input.record = PathBuf::from(self.hash(&input.record, library)?);
            }
        }
        let mut id = concio::run::hash(&[crate::measures::VERSION.to_string(), canonical_json(&case)]);
        id.truncate(DIGITS);
        Ok(id)
    }

    fn hash(&self, path: &Path, library: &Library) -> Result<String> {
        let known = |map: &HashMap<PathBuf, String>| map.get(path).cloned();
        let mut map = self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(hash) = known(&map) {
            return Ok(hash);
        }
        let bytes = library.bytes(path).map_err(|reason| cannot_be_read(path, &reason))?;
        let hash = blake3::hash(&bytes).to_hex().to_string();
        map.insert(path.to_path_buf(), hash.clone());
        Ok(hash)
    }
}
