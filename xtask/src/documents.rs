//! Documents that are made by the program itself, so that they cannot disagree with it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{Outcome, read};
use crate::concio;

/// Figures of docs/figures.md: example, options, name of the picture. Not compared by [`check`]: where joints stick and
/// slip a run ends elsewhere with another mathematical library.
const FIGURES: [(&str, &str, &str); 6] = [
    ("02-driven-top", "--figure deformed", "deformed"),
    ("02-driven-top", "--figure phase --blocks p1c6b4,p1c2b1", "phase"),
    ("02-driven-top", "--figure joint-histories --joints p1c6b4|p1c6b5,p1c5b3|p1c5b4", "joint-histories"),
    ("02-driven-top", "--figure peak-acceleration", "peak-acceleration"),
    ("04-two-panels", "--figure top-force", "top-force"),
    ("01-first-wall", "--figure energies", "energies"),
];

/// Makes all of them.
pub fn make(root: &Path) -> Outcome {
    figures(root)?;
    for (path, text) in all(root)? {
        let file = root.join(path);
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        }
        fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))?;
        println!("{path}");
    }
    Ok(())
}

/// Fails when one of them is not what the program makes today, or a wall file that a document shows is wrong.
pub fn check(root: &Path) -> Outcome {
    for (path, text) in all(root)? {
        let found = fs::read_to_string(root.join(path)).map_err(|e| format!("{path}: {e}"))?;
        if found != text {
            return Err(format!("{path} is not current: run `cargo xtask docs` and commit it"));
        }
        println!("{path} is current");
    }
    walls_in_readme(root)
}

/// A record for the wall files in documents, which name one.
const RECORD: &str = "Record\n\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= 0.01 SEC\n0.0 0.1 -0.2 0.0\n";

/// The wall files that the README shows are valid.
fn walls_in_readme(root: &Path) -> Outcome {
    let text = fs::read_to_string(root.join("README.md")).map_err(|e| format!("README.md: {e}"))?;
    let walls: Vec<&str> = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let folder = root.join("target").join("readme");
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).map_err(|e| format!("{name}: {e}"));
    write("quake.at2", RECORD)?;
    for wall in &walls {
        write("wall.toml", wall)?;
        read(Command::new(concio(root)).args(["check", "wall.toml"]).current_dir(&folder))?;
    }
    println!("{} wall file(s) in README.md are valid", walls.len());
    if walls.is_empty() { Err("README.md shows no wall file".into()) } else { Ok(()) }
}

fn all(root: &Path) -> Result<[(&'static str, String); 3], String> {
    let print = |args: &[&str]| read(Command::new(concio(root)).args(args).current_dir(root));
    Ok([
        ("docs/cli.md", print(&["reference"])?),
        ("docs/wall.schema.json", print(&["schema"])?),
        ("docs/img/first-wall.svg", drawing(root)?),
    ])
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
