//! `concio mechanisms`.

use std::fs;

use concio::Error;
use concio::case::CaseFile;
use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::survey;
use concio_study::table;
use serde_json::Value;

use super::{Answer, run::refuse_a_file, wall_file};
use crate::args::{Mechanisms, OverlapSum};
use crate::draw::out_of_plane;
use crate::failure::Failure;
use crate::format::line;
use crate::mechanisms::shaken::Shaken;
use crate::mechanisms::{Subject, page, rows, shaken, text};
use crate::{files, study};

/// Names of the results in their folder.
const RESULT: &str = "mechanisms.json";
const TABLE: &str = "mechanisms.csv";

/// Finds the mechanisms of a wall.
pub fn mechanisms(args: &Mechanisms) -> Result<(), Failure> {
    let file = if args.motion.shaken { wall_file::read(&args.file)? } else { wall_file::read_at_rest(&args.file)? };
    wall_file::doubt(&file);
    if let Some(out) = &args.out {
        refuse_a_file(out)?;
    }
    found(args, &file, |subject, shaken, result| {
        crate::warned::warn(&file, &concio::facade::doubts(&file.case, subject.wall));
        crate::warned::warn(&file, shaken.map_or(&[], |shaken| &shaken.warnings[..]));
        show(args, subject, shaken, &result)
    })
}

/// What `--json` prints, and the least of the mechanisms that count, drawn.
pub fn answer(args: &Mechanisms, file: &CaseFile) -> Result<Answer, Failure> {
    found(args, file, |Subject { wall, survey, .. }, _, value| {
        Ok(Answer { value, drawing: survey.least().map(|least| out_of_plane::draw(wall, least).svg()) })
    })
}

/// Finds the mechanisms, and follows them where that is asked; what `then` makes of them.
fn found<T>(
    args: &Mechanisms,
    file: &CaseFile,
    then: impl FnOnce(&Subject, Option<&Shaken>, Value) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let wall = concio::facade::of(&file.case).map_err(|e| wall_file::all(file, file.locate(e)))?;
    let overlaps = match args.overlaps {
        OverlapSum::Summed => Overlaps::Summed,
        OverlapSum::Code => Overlaps::Code,
    };
    let survey = survey(&wall, overlaps);
    let shaken = shaken::follow(&args.motion, file, &wall, &survey, args.all)?;
    let name = args.file.file_stem().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let title = if file.case.title.is_empty() { name } else { file.case.title.clone() };
    let subject = Subject { title: &title, wall: &wall, survey: &survey, overlaps, trilinear: args.trilinear };
    let mut result = rows::json(&subject);
    if let Some(shaken) = &shaken {
        result["time_history"] = shaken::values::json(shaken);
    }
    then(&subject, shaken.as_ref(), result)
}

fn show(args: &Mechanisms, subject: &Subject, shaken: Option<&Shaken>, result: &Value) -> Result<(), Failure> {
    let mut sections = page::sections(subject);
    let mut told = text::told(subject, args.all);
    if let Some(shaken) = shaken {
        sections.extend(shaken::page::sections(shaken));
        told.push_str(&shaken::text::told(shaken));
    }
    if let Some(out) = &args.out {
        fs::create_dir_all(out).map_err(|e| Failure::from(Error::io(out, e)))?;
        files::write(&out.join(RESULT), &format!("{result:#}\n"))?;
        table::write_csv(&rows::table(subject), &out.join(TABLE))?;
        for (name, history) in shaken.into_iter().flat_map(shaken::values::histories) {
            table::write_csv(&history, &out.join(name))?;
        }
        study::page::write(out, &format!("Out of the plane: {}", subject.title), &page::facts(subject), &sections)?;
    }
    if args.json {
        return files::print_json(&format!("{result:#}\n"));
    }
    let written =
        args.out.as_ref().map_or(String::new(), |out| format!("\nopen {}\n", out.join("report.html").display()));
    files::print(&format!("{}\n\n{told}{written}", line(subject.title)))
}
