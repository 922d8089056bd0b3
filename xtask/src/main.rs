//! Chores of the project: `cargo xtask ci` does everything that CI does, `cargo xtask docs` makes the generated
//! documents. A check that this machine cannot make prints a line that starts with `skipped:`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

mod api;
mod archive;
mod cases;
mod command;
mod documents;
mod equations;
mod examples;
mod gallery;
mod histories;
mod links;
mod modules;
mod packages;
mod peers;
mod performance;
mod planar;
mod python;
mod report_ui;
mod schemes;
mod shown;
mod site;
mod studies;
mod symbols;
mod verification;
mod words;

use command::{Outcome, cargo, run, skipped};

const USAGE: &str = "\
cargo xtask ci         everything that CI does
cargo xtask docs       make the generated documents (reference, schema, symbols, gallery, pictures)
cargo xtask cases      run the cases of the research report anew; docs/report-cases.md and its pictures follow from them
cargo xtask studies    make the worked examples of docs/studies/ anew: runs, output, figures (or those named)
cargo xtask planar     make the runs and pictures of docs/planar.md anew
cargo xtask verification   make docs/verification.md anew of what tests find (--cargo-profile, --check, --recorded)
cargo xtask examples   run every wall file in examples/
cargo xtask shown      try the wall files and commands that documents show
cargo xtask equations  check the numbers of equations
cargo xtask links      check the links of the documents
cargo xtask modules    find circles between modules
cargo xtask site       build the site of the documents under target/site (needs Python)
cargo xtask man        write the man pages into target/man
cargo xtask archive    pack the program, man pages and completions into target/archive, for a release
cargo xtask packages   check the crates that are published, in order (--order, --version: print these alone)
cargo xtask words      count the words of the documents, and of their sentences
cargo xtask report-ui  build the program of the interactive report into the tree (needs Node.js)
cargo xtask report-ui-check   its bundle is current, its tests pass, a browser shows the numbers of the result
cargo xtask peers      compare with CVODE
cargo xtask python     build, install and check the package for Python
cargo xtask performance   measure Concio and other solvers, draw docs/performance.md (--quick, --case, --peers, --page)
cargo xtask schemes    compare schemes at fixed steps, for docs/decisions/0007-schemes.md";

fn main() -> ExitCode {
    let root = root();
    let task = std::env::args().nth(1).unwrap_or_default();
    let rest: Vec<String> = std::env::args().skip(2).collect();
    let outcome = match task.as_str() {
        "ci" => ci(&root),
        "cases" => build(&root).and_then(|()| cases::make(&root)).and_then(|()| documents::make(&root)),
        "docs" => build(&root).and_then(|()| documents::make(&root)),
        "studies" => build(&root).and_then(|()| studies::make(&root, &rest)),
        "planar" => build(&root).and_then(|()| planar::make(&root)),
        "verification" => verification::make(&root, &rest),
        "examples" => build(&root).and_then(|()| examples::run_all(&root)),
        "shown" => build(&root).and_then(|()| shown::check(&root)),
        "equations" => equations::check(&root),
        "links" => links::check(&root),
        "modules" => modules::check(&root),
        "site" => site::make(&root),
        "man" => build(&root).and_then(|()| archive::man(&root, &root.join("target/man"))),
        "archive" => build(&root).and_then(|()| archive::make(&root)),
        "packages" => packages::make(&root, &rest),
        "words" => words::check(&root),
        "report-ui" => report_ui::build(&root),
        "report-ui-check" => build(&root).and_then(|()| report_ui::check(&root)),
        "peers" => build(&root).and_then(|()| peers::compare(&root)),
        "python" => python::environment(&root).and_then(|python| python::check_package(&root, python.as_deref())),
        "schemes" => build(&root).and_then(|()| schemes::compare(&root)),
        "performance" => build(&root).and_then(|()| performance::run(&root, &rest)),
        _ => Err(USAGE.into()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// The root of the repository, the folder above this package.
fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// The `concio` program of this tree.
fn concio(root: &Path) -> PathBuf {
    program(root, "concio")
}

/// The program of this tree that only its chores need.
fn concio_dev(root: &Path) -> PathBuf {
    program(root, "concio-dev")
}

fn program(root: &Path, name: &str) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), |d| root.join(d));
    target.join("release").join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

fn build(root: &Path) -> Outcome {
    run(cargo(root).args(["build", "--locked", "--release", "--package", "concio-cli", "--package", "concio-dev"]))
}

fn ci(root: &Path) -> Outcome {
    let python = python::environment(root)?;
    let steps: [(&str, &dyn Fn() -> Outcome); 17] = [
        ("format", &|| run(cargo(root).args(["fmt", "--all", "--check"]))),
        ("lints", &|| {
            run(cargo(root).args([
                "clippy",
                "--locked",
                "--release",
                "--workspace",
                "--all-targets",
                "--",
                "--deny",
                "warnings",
            ]))
        }),
        ("modules", &|| modules::check(root)),
        ("build", &|| build(root)),
        ("tests", &|| tests(root, python.as_deref())),
        ("page of verification", &|| verification::check(root)),
        ("API documentation", &|| api::check(root)),
        ("generated documents", &|| documents::check(root)),
        ("links", &|| links::check(root)),
        ("words", &|| words::check(root)),
        ("site", &|| site::make(root)),
        ("crates to publish", &|| packages::make(root, &[])),
        ("examples", &|| examples::run_all(root)),
        ("readers of results", &|| python::read_results(root, python.as_deref())),
        ("package for Python", &|| python::check_package(root, python.as_deref())),
        ("interactive report", &|| report_ui::check(root)),
        ("comparison with CVODE", &|| peers::compare(root)),
    ];
    let start = Instant::now();
    let mut took = Vec::new();
    for (name, step) in steps {
        println!("\n== {name}");
        let start = Instant::now();
        step().map_err(|why| format!("{name}: {why}"))?;
        took.push(format!("{name} {:.0}", start.elapsed().as_secs_f64()));
    }
    let skipped: Vec<String> = skipped().into_iter().chain(verification::skipped(root)?).collect();
    println!("\n{} checks were skipped{}", skipped.len(), if skipped.is_empty() { "." } else { ":" });
    skipped.iter().for_each(|what| println!("  {what}"));
    println!("Seconds: {}.", took.join(", "));
    println!("All checks passed in {:.0} s.", start.elapsed().as_secs_f64());
    Ok(())
}

/// Unit, integration and documentation tests; with cargo-nextest where it is installed.
fn tests(root: &Path, python: Option<&Path>) -> Outcome {
    let nextest = cargo(root).args(["nextest", "--version"]).output().is_ok_and(|o| o.status.success());
    let mut all = cargo(root);
    if nextest {
        all.args(["nextest", "run", "--locked", "--cargo-profile", "release", "--workspace"]);
    } else {
        all.args(["test", "--locked", "--release", "--workspace", "--all-targets"]);
    }
    all.env("CONCIO_VERIFIED", verification::folder(root)?);
    if let Some(python) = python {
        all.env("CONCIO_PYTHON", python);
    }
    run(&mut all)?;
    run(cargo(root).args(["test", "--locked", "--release", "--workspace", "--doc"]))
}
