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
    let report = report::write(&args.dir, &report::Content::of_stored(&args.dir, &run, &summary)?)?;
    files::note(&format!("open {}", report.display()));
    Ok(())
}
