//! `concio run`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use concio::record::StopReason;
use concio::run::{Control, Finished, Prepared};
use concio::store::JointRow;

use super::wall_file;
use crate::args::Run;
use crate::failure::{Failure, STOPPED};
use crate::format::{padded, seconds, significant, width};
use crate::progress::Progress;
use crate::{digest, files, report, stop};

/// What an unfinished run leaves in its folder.
const CHECKPOINT: &str = "checkpoint.bin";

/// Runs a wall file, writes results and report, prints what matters.
pub fn run(args: &Run) -> Result<ExitCode, Failure> {
    let file = match &args.file {
        Some(path) => wall_file::read(path)?,
        None => {
            files::note("No wall file is given: running the built-in example (`concio new` writes one to start from).");
            concio::case::example()?
        }
    };
    let prepared = wall_file::prepare(&file)?;
    let out = args.out.clone().unwrap_or_else(|| default_folder(args.file.as_deref()));
    refuse_a_file(&out)?;
    if args.fresh {
        concio::run::forget(&out)?;
    }
    crate::warned::warn(&file, &prepared.model.warnings);
    let finished = simulate(&prepared, &out)?;
    let joints = concio::run::joint_rows(&prepared.model);
    let mut content = report::Content::of_run(&out, &prepared, &joints, &finished, file.text());
    content.command = Some(report::command(args.file.as_deref(), &out));
    let report = report::write(&out, &content)?;
    let stopped = !finished.outcome.stop_reason.is_end();
    // Whether a rocking wall lifts off is a matter of the peak: a wrong unit shows there.
    let motion =
        if prepared.model.rocking().is_some() { wall_file::motion(&file, &prepared, false)? } else { Vec::new() };
    tell(&finished, &prepared, (&joints, motion), &report)?;
    Ok(if stopped { ExitCode::from(STOPPED) } else { ExitCode::SUCCESS })
}

fn simulate(prepared: &Prepared, out: &Path) -> Result<Finished, Failure> {
    stop::listen()?;
    let mut progress = Progress::new(out.join(CHECKPOINT).exists());
    let finished = concio::run::run(prepared, out, &mut |status| {
        progress.show(status);
        if stop::asked() { Control::Stop } else { Control::Continue }
    });
    let told = progress.clear();
    let finished = finished?;
    // A run taken up so near its end that it was over before the first look.
    if let Some(time) = finished.resumed_from.filter(|_| !told) {
        files::note(&format!("taken up at t = {} s", significant(time, 4)));
    }
    Ok(finished)
}

/// `concio-run/NAME` in the working directory.
fn default_folder(file: Option<&Path>) -> PathBuf {
    let name = file.map_or("example".as_ref(), |f| f.file_stem().unwrap_or(f.as_os_str()));
    Path::new("concio-run").join(name)
}

/// A message in the words of the command line, before anything is made.
pub fn refuse_a_file(out: &Path) -> Result<(), Failure> {
    if out.exists() && !out.is_dir() {
        let error = concio::InputError::new("the folder for the results is a file").in_file(out);
        return Err(error.help("give another folder with --out").into());
    }
    Ok(())
}

/// `told`: the joints, and what is told of the motion.
fn tell(
    finished: &Finished,
    prepared: &Prepared,
    told: (&[JointRow], Vec<(&'static str, String)>),
    report: &Path,
) -> Result<(), Failure> {
    let (joints, motion) = told;
    let (wall, outcome, summary) = (&prepared.model.wall, &finished.outcome, &finished.summary);
    let answers = digest::head(joints, outcome, summary);
    let head: Vec<(&str, String)> = answers.iter().map(|answer| (answer.name, answer.line())).collect();
    let rows = [motion, digest::rows(wall, joints, outcome, summary)].concat();
    let width = width(head.iter().chain(&rows));
    files::print(&padded(&head, width))?;
    // Those of the model were told before the run.
    let known = &prepared.model.warnings;
    for warning in digest::warnings(&finished.summary).filter(|w| !known.iter().any(|k| k == w)) {
        files::note(&format!("warning: {warning}"));
    }
    let reason = finished.outcome.stop_reason;
    if reason != StopReason::Completed {
        let [at, end] = [finished.outcome.time_reached, prepared.model.excitation.duration].map(seconds);
        let early = if reason.is_end() { "ended" } else { "stopped early" };
        files::note(&format!(
            "{early} at t = {at} of {end}: {}",
            digest::why(reason, finished.outcome.rocking.is_some())
        ));
    }
    files::print(&format!("\n{}\nopen {}\n", padded(&rows, width), report.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_folder_bears_the_name_of_the_wall() {
        assert_eq!(default_folder(None), Path::new("concio-run/example"));
        assert_eq!(default_folder(Some(Path::new("walls/nave.toml"))), Path::new("concio-run/nave"));
    }

    /// The report quotes it.
    #[test]
    fn the_built_in_example_has_a_text() {
        let file = concio::case::example().expect("the example is valid");
        assert!(file.text().contains("[[panel]]"));
    }
}
