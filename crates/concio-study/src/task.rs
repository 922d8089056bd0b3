//! Runs that another process does: a task holds by value all that they need, so that it can be sent anywhere.
//!
//! A task is a line of JSON, and so is each row that comes back ([`crate::store::line_of`]). Records travel by content. The
//! same task gives the same rows, to the bit, whoever does it: a task that was lost with its worker is done again.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use concio::case::{Case, Signal};
use concio::ground::Library;
use concio::{InputError, Result};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::file::{Keep, PerJoint};
use crate::limits::Rule;
use crate::measures::VERSION;
use crate::plan::cannot_be_read;

/// Some runs of a study, with what is kept of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Versions of the program that laid it out, and of the measures: another would do other runs.
    concio: String,
    measures: u32,
    /// What each run is known by, and its wall.
    runs: Vec<(String, Case)>,
    joints: Vec<PerJoint>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    until: Option<Rule>,
    /// Folder that all workers see, where whole results are kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    results: Option<PathBuf>,
    /// Contents of the record files by their paths.
    records: BTreeMap<PathBuf, Contents>,
}

/// What a record file holds, a character per byte; tasks of one study share it.
#[derive(Debug, Clone, PartialEq)]
struct Contents(Arc<str>);

impl Serialize for Contents {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.0)
    }
}

impl<'d> Deserialize<'d> for Contents {
    fn deserialize<D: Deserializer<'d>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        Ok(Contents(String::deserialize(deserializer)?.into()))
    }
}

/// Lays `todo` out as tasks of up to `at_once` runs, each known by its id. What is kept: values per joint, where runs end, and the
/// folder of whole results.
///
/// # Errors
/// A record that cannot be read.
pub(crate) fn tasks(
    todo: &[(&str, &Case)],
    at_once: usize,
    (joints, until, results): (&[PerJoint], Option<Rule>, Option<&Path>),
    library: &Library,
) -> Result<Vec<Task>> {
    let results = results.map(|folder| std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf()));
    let mut read: HashMap<PathBuf, Contents> = HashMap::new();
    let task = |some: &[(&str, &Case)]| {
        let mut records = BTreeMap::new();
        for (_, signal) in some.iter().flat_map(|(_, case)| case.motion.signals()) {
            if let Signal::Record(input) = signal
                && !records.contains_key(&input.record)
            {
                let contents = match read.get(&input.record) {
                    Some(contents) => contents.clone(),
                    None => {
                        let bytes =
                            library.bytes(&input.record).map_err(|reason| cannot_be_read(&input.record, &reason))?;
                        let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
                        read.entry(input.record.clone()).or_insert(Contents(text.into())).clone()
                    }
                };
                records.insert(input.record.clone(), contents);
            }
        }
        Ok(Task {
            concio: env!("CARGO_PKG_VERSION").into(),
            measures: VERSION,
            runs: some.iter().map(|(id, case)| (id.to_string(), (*case).clone())).collect(),
            joints: joints.to_vec(),
            until,
            results: results.clone(),
            records,
        })
    };
    todo.chunks(at_once.max(1)).map(task).collect()
}

impl Task {
    /// The task of a line.
    ///
    /// # Errors
    /// [`concio::Error::Input`] for what is no task, or one of another version.
    pub fn parse(line: &str) -> Result<Self> {
        let task: Task = serde_json::from_str(line).map_err(|e| {
            InputError::new(format!("is no task: {e}")).allowed("a line that `concio study plan --json` printed")
        })?;
        let (own, other) = (env!("CARGO_PKG_VERSION"), &task.concio);
        if (own, VERSION) != (other.as_str(), task.measures) {
            let what = format!("the task is of version {other} with measures {}", task.measures);
            return Err(InputError::new(what).allowed(format!("version {own} with measures {VERSION}")).into());
        }
        Ok(task)
    }

    /// It in one line.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("a task has only tables with text keys, and no value refuses serialisation")
    }

    /// What its runs are known by, in their order.
    pub fn ids(&self) -> impl ExactSizeIterator<Item = &str> {
        self.runs.iter().map(|(id, _)| id.as_str())
    }

    /// The walls of its runs, in their order.
    pub fn cases(&self) -> Vec<Case> {
        self.runs.iter().map(|(_, case)| case.clone()).collect()
    }

    /// What is kept of each run.
    pub fn keep(&self) -> Keep {
        Keep { joints: self.joints.clone(), results: self.results.is_some() }
    }

    /// Where its runs end before their time.
    pub fn until(&self) -> Option<Rule> {
        self.until
    }

    /// The records that it holds.
    ///
    /// # Errors
    /// [`concio::Error::Input`] where one has a character that is no byte.
    pub fn library(&self) -> Result<Library> {
        let bytes = |text: &str| {
            let bytes: std::result::Result<Vec<u8>, _> = text.chars().map(u8::try_from).collect();
            bytes.map_err(|_| InputError::new("a record of the task has a character that is no byte"))
        };
        let records = self.records.iter().map(|(path, text)| Ok((path.clone(), bytes(&text.0)?)));
        Ok(Library::holding(records.collect::<Result<HashMap<_, _>>>()?))
    }

    /// The folder that all workers see, where whole results are kept.
    pub fn results(&self) -> Option<&Path> {
        self.results.as_deref()
    }
}
