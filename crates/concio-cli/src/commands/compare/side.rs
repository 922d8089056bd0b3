//! A run that is compared.

use std::path::{Path, PathBuf};

use concio::InputError;
use concio::record::StopReason;
use concio::run::SUMMARY;
use concio::store::{StoredRun, read_summary};
use serde_json::Value;

use super::super::export::{stored, unusable};
use crate::digest;
use crate::failure::Failure;
use crate::format::seconds;

/// A run that is compared.
#[derive(Debug)]
pub struct Side {
    /// Its folder.
    pub folder: PathBuf,
    /// Its result.
    pub run: StoredRun,
    /// Its summary.
    pub summary: Value,
}

impl Side {
    /// A run that has ended, read from its folder.
    pub fn read(folder: &Path) -> Result<Side, Failure> {
        let help = "two folders are compared that `concio run` wrote to";
        if !folder.is_dir() {
            let what = if folder.exists() { "is no folder" } else { "there is no such folder" };
            return Err(InputError::new(what).in_file(folder).help(help).into());
        }
        let run = stored(folder)?;
        if folder.join("journal.bin").is_file() {
            let error = InputError::new("a run in this folder has not ended").in_file(folder);
            return Err(error.help("`concio run` with the same wall file and --out goes on with it").into());
        }
        if run.outcome.stop_reason == StopReason::Interrupted {
            let what = format!("the run was interrupted at t = {}", seconds(run.outcome.time_reached));
            let error = InputError::new(what).in_file(folder);
            return Err(error.help("`concio run` with the same wall file and --out goes on with it").into());
        }
        let path = folder.join(SUMMARY);
        let summary = read_summary(&path)?;
        let side = Side { folder: folder.to_path_buf(), run, summary };
        let hash = side.summary.get("inputs_hash").and_then(Value::as_str);
        let own = &side.run;
        if hash != Some(&own.provenance.inputs_hash) || side.number("/time_reached") != Some(own.outcome.time_reached) {
            return Err(unusable(&path, "it belongs to another run than result.h5"));
        }
        Ok(side)
    }

    /// A number of the summary.
    pub fn number(&self, at: &str) -> Option<f64> {
        self.summary.pointer(at)?.as_f64()
    }

    /// The resolved input.
    pub fn case(&self) -> Result<Value, Failure> {
        let path = self.folder.join("result.h5");
        serde_json::from_str(&self.run.provenance.case_json).map_err(|e| unusable(&path, &e.to_string()))
    }

    /// Kind, where the summary has it, and sentence of every warning.
    pub fn warnings(&self) -> Vec<(String, String)> {
        let kinds = self.summary.get("warning_kinds").and_then(Value::as_array);
        let kind = |k: usize| kinds.and_then(|kinds| kinds.get(k)?.as_str()).unwrap_or_default().to_string();
        digest::warnings(&self.summary).enumerate().map(|(k, text)| (kind(k), text.to_string())).collect()
    }
}
