//! Documents that are made by the program itself, so that they cannot disagree with it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{Outcome, read};
use crate::{concio, concio_dev, equations, gallery, performance, shown, symbols};

/// Figures of docs/figures.md: example, options, name of the picture. Not compared by [`check`]: where joints stick and
/// slip a run ends elsewhere with another mathematical library.
const FIGURES: [(&str, &str, &str); 7] = [
    ("02-driven-top", "--figure deformed", "deformed"),
    ("02-driven-top", "--figure phase --blocks p1c6b4,p1c2b1", "phase"),
    ("02-driven-top", "--figure joint-histories --joints p1c6b4|p1c6b5,p1c5b3|p1c5b4", "joint-histories"),
    ("02-driven-top", "--figure peak-acceleration", "peak-acceleration"),
    ("12-bonded-joints", "--figure cracks", "cracks"),
    ("04-two-panels", "--figure top-force", "top-force"),
    ("01-first-wall", "--figure energies", "energies"),
];

/// Figures of guide 13: what the façade is asked, the file that the answer leaves, and the name of the picture. Not compared either.
const FACADE: &str = "examples/limit/facade.toml";
const ACROSS: [(&[&str], &str, &str); 2] = [
    (&["limit", FACADE, "--out-of-plane", "--above", "3m"], "mechanism.svg", "facade-in-space"),
    (&["mechanisms", FACADE], "figures/overturning.svg", "facade-overturning"),
];

/// Makes all of them.
pub fn make(root: &Path) -> Outcome {
    figures(root)?;
    for (path, text) in all(root)? {
        let file = root.join(&path);
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        }
        fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))?;
        println!("{path}");
    }
    Ok(())
}

/// Fails when one of them is not what the program makes today, or when what they show or cite does not hold.
pub fn check(root: &Path) -> Outcome {
    for (path, text) in all(root)? {
        let found = fs::read_to_string(root.join(&path)).map_err(|e| format!("{path}: {e}"))?;
        if found != text {
            return Err(format!("{path} is not current: run `cargo xtask docs` and commit it"));
        }
        println!("{path} is current");
    }
    equations::check(root)?;
    shown::check(root)
}

fn all(root: &Path) -> Result<Vec<(String, String)>, String> {
    let of = |program: PathBuf, args: &[&str]| read(Command::new(program).args(args).current_dir(root));
    let schema = of(concio(root), &["schema"])?;
    let mut all = vec![
        ("docs/cli.md".into(), of(concio_dev(root), &["reference"])?),
        ("docs/symbols.md".into(), symbols::page(root, &schema)?),
        ("docs/wall.schema.json".into(), schema),
        ("docs/img/first-wall.svg".into(), drawing(root)?),
        (CASES.into(), with_tables(root, CASES, &["cases", "--tables", "docs/report-cases.json"])?),
        (STUDIES.into(), with_tables(root, STUDIES, &["reference", "--measures"])?),
    ];
    all.append(&mut gallery::make(root)?);
    all.append(&mut performance::with_tables(root)?);
    Ok(all)
}

/// The pictures of docs/figures.md.
fn figures(root: &Path) -> Outcome {
    let folder = root.join("target").join("figures");
    for example in FIGURES.map(|f| f.0).iter().collect::<BTreeSet<_>>() {
        let wall = root.join("examples").join(format!("{example}.toml"));
        read(Command::new(concio(root)).arg("run").arg(wall).arg("--fresh").arg("--out").arg(folder.join(example)))?;
    }
    for (example, options, name) in FIGURES {
        let run = folder.join(example);
        read(Command::new(concio(root)).arg("plot").arg(&run).args(options.split(' ')))?;
        let drawn = run.join("figures").join(format!("{name}.svg"));
        let path = format!("docs/img/{name}.svg");
        fs::copy(&drawn, root.join(&path)).map_err(|e| format!("{}: {e}", drawn.display()))?;
        println!("{path}");
    }
    for (asked, file, name) in ACROSS {
        let out = folder.join(name);
        read(Command::new(concio(root)).args(asked).arg("--out").arg(&out).current_dir(root))?;
        let path = format!("docs/img/{name}.svg");
        fs::copy(out.join(file), root.join(&path)).map_err(|e| format!("{}: {e}", out.display()))?;
        println!("{path}");
    }
    Ok(())
}

/// The picture of the README.
fn drawing(root: &Path) -> Result<String, String> {
    let out: PathBuf = root.join("target").join("first-wall.svg");
    fs::create_dir_all(root.join("target")).map_err(|e| format!("target: {e}"))?;
    let mut check = Command::new(concio(root));
    read(check.args(["check", "examples/01-first-wall.toml", "--svg"]).arg(&out).current_dir(root))?;
    fs::read_to_string(&out).map_err(|e| format!("{}: {e}", out.display()))
}

/// Pages with tables that the program prints: the cases of the research report, of docs/report-cases.json, which a test of the command
/// line holds against new runs; the measures of a study's runs.
const CASES: &str = "docs/report-cases.md";
const STUDIES: &str = "docs/studies.md";
/// The tables stand between these lines.
const TABLES: [&str; 2] = ["<!-- tables: made by cargo xtask docs -->\n", "<!-- end of tables -->\n"];

/// A page with what a command prints today as its tables.
fn with_tables(root: &Path, page: &str, command: &[&str]) -> Result<String, String> {
    let tables = read(Command::new(concio_dev(root)).args(command).current_dir(root))?;
    let text = fs::read_to_string(root.join(page)).map_err(|e| format!("{page}: {e}"))?;
    let parts = text.split_once(TABLES[0]).and_then(|(head, rest)| Some((head, rest.split_once(TABLES[1])?.1)));
    let (head, tail) = parts.ok_or_else(|| format!("{page}: the lines around its tables are missing"))?;
    Ok([head, TABLES[0], &tables, TABLES[1], tail].concat())
}
