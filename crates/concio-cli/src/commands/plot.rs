//! `concio plot`.

use std::fs;

use concio::Error;
use serde_json::Value;

use super::export::stored;
use crate::args::Plot;
use crate::failure::Failure;
use crate::{files, report};

/// Makes the report of a run anew.
pub fn plot(args: &Plot) -> Result<(), Failure> {
    let run = stored(&args.dir)?;
    let path = args.dir.join("summary.json");
    let text = fs::read_to_string(&path).map_err(|e| Error::io(&path, e))?;
    let summary: Value =
        serde_json::from_str(&text).map_err(|e| Error::Store { path: path.clone(), what: e.to_string() })?;
    let hash = summary.get("inputs_hash").and_then(Value::as_str);
    let reached = summary.get("time_reached").and_then(Value::as_f64);
    if hash != Some(&run.provenance.inputs_hash) || reached != Some(run.outcome.time_reached) {
        let what = "belongs to another run than result.h5: run the wall file again".into();
        return Err(Error::Store { path, what }.into());
    }
    let report = report::write(&args.dir, &report::Content::of_stored(&args.dir, &run, &summary)?)?;
    files::note(&format!("open {}", report.display()));
    Ok(())
}
