//! `concio scale`.

use concio_study::groups::{Group, Reference, groups};
use serde_json::json;

use super::wall_file;
use crate::args::Scale;
use crate::failure::Failure;
use crate::files;
use crate::format::{columns, exponent, pairs, short, significant};

/// Prints the dimensionless groups of a wall.
pub fn scale(args: &Scale) -> Result<(), Failure> {
    let file = wall_file::read(&args.file)?;
    let prepared = wall_file::prepare(&file)?;
    let reference = Reference::of(&prepared.case, args.length.map(|l| l.si())).map_err(|e| file.locate(e))?;
    let found = groups(&prepared.case, &prepared.model, file.folder(), &reference).map_err(|e| file.locate(e))?;
    if args.json {
        let value = json!({ "reference": reference, "groups": found });
        return files::print_json(&format!("{value:#}\n"));
    }
    let general = pairs(&[
        ("M", format!("{}, the first panel's reference brick", short(reference.mass, "kg"))),
        ("K", short(reference.stiffness, "N/m")),
        ("Ω", format!("{} = √(K/M)", short(reference.frequency, "rad/s"))),
        ("Λ", short(reference.length, "m")),
    ]);
    let heading = ["group", "formula", "this wall", "Table 1", "varied by"].map(String::from).to_vec();
    let rows: Vec<Vec<String>> = [heading].into_iter().chain(found.iter().map(row)).collect();
    files::print(&format!("{general}\n{}", columns(&rows)))
}

fn row(group: &Group) -> Vec<String> {
    let varied = match (group.name, group.realised_by) {
        ("frequency", Some(key)) => format!("{key}, of a sine or pulse alone"),
        (_, key) => key.unwrap_or("–").into(),
    };
    [group.name.into(), group.formula.into(), range(group.value), range(group.table1), varied].to_vec()
}

fn range(values: Option<[f64; 2]>) -> String {
    match values {
        None => "–".into(),
        Some([low, high]) if (high - low).abs() <= 1e-9 * high.abs() => number(low),
        Some([low, high]) => format!("{} … {}", number(low), number(high)),
    }
}

fn number(v: f64) -> String {
    if v == 0.0 || (1e-3..1e5).contains(&v.abs()) { significant(v, 4) } else { exponent(v, 3) }
}
