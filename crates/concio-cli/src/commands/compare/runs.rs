//! Two runs beside each other: what differs in their input, their numbers, histories over each other, what they warn of.

use std::fs;
use std::path::{Path, PathBuf};

use concio::InputError;
use concio_study::table::Table;
use serde_json::{Value, json};

use super::super::run::refuse_a_file;
use super::inputs::{self, Difference};
use super::side::Side;
use super::{figures, numbers};
use crate::args::Compare;
use crate::failure::Failure;
use crate::files;
use crate::format::columns;
use crate::study::page::{self, Section};

/// Differences of the input that the terminal shows.
const MOST_SHOWN: usize = 20;

/// Sets two runs side by side.
pub fn runs(args: &Compare) -> Result<(), Failure> {
    let (Some(a), Some(b)) = (&args.a, &args.b) else {
        return Err(InputError::new("two folders of runs are compared").help("concio compare A B").into());
    };
    if let (Ok(first), Ok(second)) = (a.canonicalize(), b.canonicalize())
        && first == second
    {
        let error = InputError::new("is compared with itself: both folders are one").in_file(a);
        return Err(error.help("name the folders of two runs").into());
    }
    let sides = [Side::read(a)?, Side::read(b)?];
    let models = [0, 1].map(|k| sides[k].run.provenance.model.as_str());
    if models[0] != models[1] {
        let what = format!("is a run of a {} wall, and {} one of a {} wall", models[0], b.display(), models[1]);
        let error = InputError::new(format!("{what}: their numbers do not mean the same")).in_file(a);
        return Err(error.help("runs of one model are compared").into());
    }
    let names = names(a, b);
    let names = [names[0].as_str(), names[1].as_str()];
    let out = args.out.clone().unwrap_or_else(|| default_folder(names));
    refuse_a_file(&out)?;
    if [a, b].into_iter().any(|own| out.canonicalize().is_ok_and(|out| own.canonicalize().is_ok_and(|own| own == out)))
    {
        let error = InputError::new("the folder for the comparison is that of a run, whose report it would replace");
        return Err(error.in_file(&out).help("give another folder with --out").into());
    }
    let differences = inputs::differences(&sides[0].case()?, &sides[1].case()?);
    let (pairs, words) = (numbers::pairs(&sides), numbers::words(&sides));
    let warnings = warnings(&sides, names);
    let text = format!("{}\n{}", told(names, &sides, &differences), numbers::told(names, &words, &pairs));
    let warned = sides.iter().map(|side| {
        let one = |(kind, text)| json!({ "kind": kind, "text": text });
        side.warnings().into_iter().map(one).collect::<Vec<_>>()
    });
    let warned: Vec<Vec<Value>> = warned.collect();
    let json = json!({
        "runs": [a.display().to_string(), b.display().to_string()],
        "inputs": differences.iter().map(|d| json!({ "key": d.key, "values": d.values })).collect::<Vec<_>>(),
        "numbers": numbers::json(&pairs),
        "words": words.iter().map(|(name, values)| json!({ "name": name, "values": values })).collect::<Vec<_>>(),
        "warnings": warned,
        "version": env!("CARGO_PKG_VERSION"),
    });
    let json = serde_json::to_string_pretty(&json).map_err(|e| Failure::Other(e.to_string(), None))?;
    let sections = sections(&sides, names, &differences, &pairs, &words, &warnings);
    let facts = [("A", a.display().to_string()), ("B", b.display().to_string())];
    fs::create_dir_all(&out).map_err(|e| concio::Error::io(&out, e))?;
    let page = page::write(&out, &format!("{} beside {}", names[0], names[1]), &facts, &sections)?;
    files::write(&out.join("compare.json"), &(json + "\n"))?;
    for (name, _, text) in &warnings {
        files::note(&format!("warning: {name}: {text}"));
    }
    files::print(&format!("{text}\nopen {}\n", page.display()))
}

/// What the runs are called: by the ends of their paths, where these differ.
fn names(a: &Path, b: &Path) -> [String; 2] {
    let short = |path: &Path| {
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        whole.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
    };
    let names = [short(a), short(b)];
    if names[0] != names[1] { names } else { [a, b].map(|path| path.display().to_string()) }
}

/// `concio-compare/A-B` in the working directory.
fn default_folder(names: [&str; 2]) -> PathBuf {
    let plain = |name: &str| name.replace(['/', '\\', '.'], "-").trim_matches('-').to_string();
    Path::new("concio-compare").join(names.map(plain).join("-"))
}

/// Run, kind and sentence of all warnings.
fn warnings(sides: &[Side; 2], names: [&str; 2]) -> Vec<(String, String, String)> {
    let of = |(side, name): (&Side, &str)| {
        side.warnings().into_iter().map(|(kind, text)| (name.to_string(), kind, text)).collect::<Vec<_>>()
    };
    sides.iter().zip(names).flat_map(of).collect()
}

/// What the inputs have in common where no key differs.
fn alike(sides: &[Side; 2]) -> &'static str {
    let [a, b] = [0, 1].map(|k| &sides[k].run.provenance);
    match (a.inputs_hash == b.inputs_hash, a.version == b.version) {
        (true, _) => "the input is the same",
        (false, true) => "the wall files say the same; the content of their records differs",
        (false, false) => {
            "the wall files say the same; the versions of Concio, and maybe the content of records, differ"
        }
    }
}

/// What differs in the input, for the terminal.
fn told(names: [&str; 2], sides: &[Side; 2], differences: &[Difference]) -> String {
    if differences.is_empty() {
        return format!("  {}\n", alike(sides));
    }
    let cell = |value: &Option<String>| value.clone().unwrap_or_else(|| "–".into());
    let mut rows = vec![vec!["input".to_string(), names[0].into(), names[1].into()]];
    rows.extend(
        differences.iter().take(MOST_SHOWN).map(|d| vec![d.key.clone(), cell(&d.values[0]), cell(&d.values[1])]),
    );
    let more = match differences.len().checked_sub(MOST_SHOWN) {
        Some(more) if more > 0 => format!("  and {more} more, which report.html lists\n"),
        _ => String::new(),
    };
    columns(&rows) + &more
}

fn sections(
    sides: &[Side; 2],
    names: [&str; 2],
    differences: &[Difference],
    pairs: &[numbers::Pair],
    words: &[(&'static str, [String; 2])],
    warnings: &[(String, String, String)],
) -> Vec<Section> {
    let mut head = Section { title: "What differs".into(), ..Section::default() };
    if differences.is_empty() {
        head.text.push(format!("{}.", alike(sides)));
    } else {
        head.tables.push(("Keys of the wall file that differ, in SI".into(), inputs::table(names, differences)));
    }
    if !warnings.is_empty() {
        let mut table = Table::default();
        table.texts("run", warnings.iter().map(|w| Some(w.0.clone())).collect());
        table.texts("kind", warnings.iter().map(|w| Some(w.1.clone())).collect());
        table.texts("what it says", warnings.iter().map(|w| Some(w.2.clone())).collect());
        head.tables.push(("Warnings: read them before the numbers".into(), table));
    }
    let mut said = Table::default();
    said.texts("", words.iter().map(|(name, _)| Some((*name).into())).collect());
    for (k, name) in names.into_iter().enumerate() {
        said.texts(name, words.iter().map(|(_, values)| Some(values[k].clone())).collect());
    }
    let numbers = Section {
        title: "Numbers".into(),
        tables: vec![
            ("How the runs ended".into(), said),
            (
                format!("Difference: {} less {}; ratio: {} over {}", names[1], names[0], names[1], names[0]),
                numbers::table(names, pairs),
            ),
        ],
        ..Section::default()
    };
    let histories =
        Section { title: "Histories".into(), figures: figures::figures(sides, names), ..Section::default() };
    vec![head, numbers, histories]
}
