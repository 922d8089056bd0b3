//! `concio cases`.

use std::process::ExitCode;

use indicatif::{ProgressBar, ProgressStyle};

use super::run::refuse_a_file;
use crate::args::Cases;
use crate::cases::{answers, jobs, page};
use crate::failure::{Failure, STOPPED};
use crate::{files, stop};

/// Runs the cases of the report and answers its findings.
pub fn cases(args: &Cases) -> Result<ExitCode, Failure> {
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
    files::print(&format!("{}\nopen {}\n", page::text(&findings), page_path.display()))?;
    Ok(ExitCode::SUCCESS)
}
