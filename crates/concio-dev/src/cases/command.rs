//! `concio-dev cases`.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use concio::{Error, InputError};
use concio_study::warned::Warned;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;

use super::{answers, jobs, page, pictures};
use crate::Cases;
use concio_cli::commands::run::refuse_a_file;
use concio_cli::failure::{Failure, STOPPED};
use concio_cli::{files, stop};

/// Runs the cases of the research report and answers its findings.
pub fn cases(args: &Cases) -> Result<ExitCode, Failure> {
    if let Some(file) = &args.tables {
        return tables(file);
    }
    refuse_a_file(&args.out)?;
    stop::listen()?;
    let bar = ProgressBar::new(jobs::all().len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos} of {len} runs") {
        bar.set_style(style);
    }
    let runs = jobs::run_all(&args.out, &|done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let Some(runs) = runs? else {
        files::note("stopped early; the same command goes on from here");
        return Ok(ExitCode::from(STOPPED));
    };
    let findings = answers::of(&runs);
    let json = serde_json::to_string_pretty(&findings).map_err(|e| Failure::Other(e.to_string(), None))?;
    files::write(&args.out.join("findings.json"), &(json + "\n"))?;
    let page_path = args.out.join("findings.md");
    files::write(&page_path, &page::markdown(&findings))?;
    if args.figures {
        pictures::draw(&args.out)?;
    }
    for sentence in jobs::warned(&args.out).sentences(&Warned::default()) {
        files::note(&format!("warning: {sentence}"));
    }
    files::print(&format!("{}\nopen {}\n", page::text(&findings), page_path.display()))?;
    Ok(ExitCode::SUCCESS)
}

fn tables(file: &Path) -> Result<ExitCode, Failure> {
    let text = fs::read_to_string(file).map_err(|e| Error::io(file, e))?;
    let findings: Value = serde_json::from_str(&text).unwrap_or_default();
    if findings["format"] != answers::FORMAT {
        let error = InputError::new("is not a findings.json of `concio-dev cases`").in_file(file);
        return Err(error.into());
    }
    files::print(&page::markdown(&findings))?;
    Ok(ExitCode::SUCCESS)
}
