//! `concio plot`.

use std::fs;
use std::path::PathBuf;

use concio::run::SUMMARY;
use concio::store::{StoredRun, read_summary};
use concio::{Error, InputError};
use serde_json::Value;

use super::export::{stored, unusable};
use crate::args::{Figure, Figures, Format, Plot};
use crate::draw::output::Drawing;
use crate::failure::Failure;
use crate::figures::{self, Data, Options};
use crate::{files, report};

/// Draws the figures that are asked for; makes the report of a run anew when none are.
pub fn plot(args: &Plot) -> Result<(), Failure> {
    let run = stored(&args.dir)?;
    if args.figure.is_empty() { report(args, &run) } else { draw(args, &run) }
}

fn report(args: &Plot, run: &StoredRun) -> Result<(), Failure> {
    let path = args.dir.join(SUMMARY);
    let summary = read_summary(&path).map_err(|error| match error {
        Error::Store { path, what } => unusable(&path, &what),
        Error::Io { path, source } => unusable(&path, &source.to_string()),
        other => other.into(),
    })?;
    let hash = summary.get("inputs_hash").and_then(Value::as_str);
    let reached = summary.get("time_reached").and_then(Value::as_f64);
    if hash != Some(&run.provenance.inputs_hash) || reached != Some(run.outcome.time_reached) {
        return Err(unusable(&path, "it belongs to another run than result.h5"));
    }
    let report = report::write(&args.dir, &report::Content::of_stored(&args.dir, run, &summary)?)?;
    files::note(&format!("open {}", report.display()));
    Ok(())
}

/// Draws everything before anything is written: a wrong name leaves no file behind.
fn draw(args: &Plot, run: &StoredRun) -> Result<(), Failure> {
    let out = args.out.clone().unwrap_or_else(|| args.dir.join("figures"));
    if out.exists() && !out.is_dir() {
        let error = InputError::new("the folder for the figures is a file").in_file(&out);
        return Err(error.help("give another folder with --out").into());
    }
    let data = Data::new(run, [args.from, args.to])?;
    let options = Options {
        width: args.width,
        at: args.at,
        scale: args.scale,
        blocks: args.blocks.clone(),
        joints: args.joints.clone(),
    };
    // Names that do not exist are wrong whatever is drawn.
    args.blocks.iter().try_for_each(|n| data.block(n).map(drop))?;
    args.joints.iter().try_for_each(|n| data.joint(n).map(drop))?;
    let (mut drawings, mut left_out) = (Vec::new(), Vec::new());
    for (figure, by_name) in chosen(&args.figure) {
        match figures::draw(figure, &data, &options) {
            Ok(drawing) => drawings.push((figure, drawing)),
            Err(error) if by_name => return Err(told(figure, error).into()),
            // No option is to blame where all figures are asked for.
            Err(error) => left_out.push(InputError { key: None, ..told(figure, error) }),
        }
    }
    let contents: Result<Vec<_>, _> = drawings.iter().map(|(figure, d)| content(args, *figure, d)).collect();
    fs::create_dir_all(&out).map_err(|e| Error::io(&out, e))?;
    let ending = match args.format {
        Format::Svg => "svg",
        Format::Png => "png",
        Format::Pdf => "pdf",
    };
    for ((figure, _), content) in drawings.iter().zip(contents?) {
        let path: PathBuf = out.join(format!("{}.{ending}", figure.name()));
        files::write(&path, &content)?;
        files::print(&format!("{}\n", path.display()))?;
    }
    for (figure, drawing) in drawings.iter().filter(|(_, d)| !d.note.is_empty()) {
        files::note(&format!("note: figure {}: {}", figure.name(), drawing.note));
    }
    for error in left_out {
        files::note(&format!("note: left out: {error}"));
    }
    Ok(())
}

fn told(figure: Figure, error: InputError) -> InputError {
    let what = format!("figure {}: {}", figure.name(), error.what);
    InputError { what, ..error }
}

/// Each figure once, and whether it is asked for by its name.
fn chosen(asked: &[Figures]) -> Vec<(Figure, bool)> {
    use clap::ValueEnum;
    let by_name = |f: &Figure| asked.contains(&Figures::One(*f));
    let all = asked.contains(&Figures::All);
    Figure::value_variants().iter().filter(|f| all || by_name(f)).map(|f| (*f, by_name(f))).collect()
}

fn content(args: &Plot, figure: Figure, drawing: &Drawing) -> Result<Vec<u8>, Failure> {
    let made = match args.format {
        Format::Svg => drawing.outlined().map(String::into_bytes),
        Format::Png => drawing.png(f64::from(args.dpi)),
        Format::Pdf => drawing.pdf(),
    };
    made.map_err(|why| Failure::Other(format!("figure {}: {why}", figure.name()), None))
}
