//! `cargo xtask performance`: Concio and general-purpose solvers on the same systems, in turn on one machine; work and
//! error of each into docs/performance.json, from which the tables and diagrams of docs/performance.md are drawn.
//!
//! Every program reads what `concio system` prints and answers in the same form (peers/README.md), so that a solver is
//! added in `programs` alone. What is measured stands in `cases`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::command::{Outcome, cargo, read};

mod cases;
mod diagrams;
mod machine;
mod measure;
mod page;
mod programs;
mod tables;

pub use page::with_tables;

/// Where measurements are kept, from the root.
pub const DATA: &str = "docs/performance.json";

const USAGE: &str = "\
cargo xtask performance [--quick] [--case NAME,…] [--peers NAME,…] [--page]

  --quick    short motions, one run each, into target/performance/quick: whether all works
  --case     only these cases (slipping, …; bench-batch, bench-large); the others stay as they were measured last
  --peers    only these programs (beside CVODE at rtol 1e-4, which the others are compared with)
  --page     measure nothing, draw the page from docs/performance.json anew";

/// Benchmarks in crates/concio/benches whose output the page shows, with their headings.
const PRINTED: [(&str, &str); 2] = [("batch", "Many runs of one wall"), ("large", "Cost per block")];

/// What was asked for.
struct Options {
    quick: bool,
    page: bool,
    cases: Vec<String>,
    programs: Vec<String>,
}

/// Measures and draws.
pub fn run(root: &Path, arguments: &[String]) -> Outcome {
    let options = parse(arguments)?;
    let (data, pictures) = places(root, options.quick)?;
    let mut all = measure::load(&data)?;
    if !options.page {
        let folder = root.join("target/performance");
        let (printed, named) = options.cases.iter().cloned().partition::<Vec<_>, _>(|n| bench_of(n).is_some());
        let cases = if named.is_empty() && !printed.is_empty() {
            Vec::new()
        } else {
            chosen(cases::all(options.quick), &named)?
        };
        let programs = programs::ready(root, &folder, &options.programs)?;
        let here = machine::describe(root, &programs);
        if !cases.is_empty() {
            all.machine = here.clone();
        }
        for case in &cases {
            match measure::case(root, &folder, case, &programs) {
                Ok(Some(measured)) => {
                    all.cases.insert(case.name.into(), measured);
                }
                Ok(None) => {}
                Err(why) => return Err(format!("{}: {why}", case.name)),
            }
            // Kept case by case: a long measurement that is cut off loses one.
            measure::save(&all, &data)?;
        }
        let wanted = |name: &str| printed.iter().any(|p| bench_of(p) == Some(name));
        for (name, _) in PRINTED {
            if wanted(name) || options.cases.is_empty() && !options.quick {
                let elsewhere = here.processor != all.machine.processor;
                all.printed.extend(bench(root, name, if elsewhere { &here.processor } else { "" })?);
                measure::save(&all, &data)?;
            }
        }
    }
    diagrams::draw(root, &all, &pictures)?;
    if options.quick {
        println!("{}", tables::all(&all));
        return Ok(());
    }
    page::write(root)
}

/// The benchmark that a name on the command line means: `bench-large`.
fn bench_of(name: &str) -> Option<&str> {
    let bench = name.strip_prefix("bench-")?;
    PRINTED.iter().any(|p| p.0 == bench).then_some(bench)
}

/// Runs a benchmark on `processor`; what it printed.
fn bench(root: &Path, name: &str, processor: &str) -> Result<Option<(String, measure::Printed)>, String> {
    if !root.join("crates/concio/benches").join(format!("{name}.rs")).is_file() {
        crate::command::skip(&format!("benchmark {name} (it is not there)"));
        return Ok(None);
    }
    println!("\n== benchmark {name}");
    let text = read(cargo(root).args(["bench", "--quiet", "--locked", "--package", "concio", "--bench", name]))?;
    print!("{text}");
    let text = text.trim_end().to_string();
    Ok(Some((name.into(), measure::Printed { date: machine::today(), processor: processor.into(), text })))
}

/// The file of the measurements and the folder of the diagrams.
fn places(root: &Path, quick: bool) -> Result<(PathBuf, PathBuf), String> {
    if !quick {
        return Ok((root.join(DATA), root.join("docs/img/performance")));
    }
    let folder = root.join("target/performance/quick");
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    Ok((folder.join("performance.json"), folder))
}

fn parse(arguments: &[String]) -> Result<Options, String> {
    let mut options = Options { quick: false, page: false, cases: Vec::new(), programs: Vec::new() };
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        let mut names = || -> Result<Vec<String>, String> {
            let list = rest.next().ok_or_else(|| format!("{argument} needs a name\n{USAGE}"))?;
            Ok(list.split(',').map(str::to_string).collect())
        };
        match argument.as_str() {
            "--quick" => options.quick = true,
            "--page" => options.page = true,
            "--case" => options.cases = names()?,
            "--peers" => options.programs = names()?,
            _ => return Err(USAGE.into()),
        }
    }
    Ok(options)
}

fn chosen(all: Vec<cases::Case>, names: &[String]) -> Result<Vec<cases::Case>, String> {
    for name in names {
        if !all.iter().any(|c| c.name == name) {
            let known: Vec<&str> = all.iter().map(|c| c.name).collect();
            return Err(format!("no case `{name}`; there are {}", known.join(", ")));
        }
    }
    Ok(all.into_iter().filter(|c| names.is_empty() || names.iter().any(|n| n == c.name)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read() {
        let words = |text: &str| text.split(' ').map(String::from).collect::<Vec<_>>();
        let options = parse(&words("--quick --case slipping,shaken --peers cvode")).expect("these are right");
        assert!(options.quick && !options.page);
        assert_eq!((options.cases.len(), options.programs.len()), (2, 1));
        assert!(parse(&words("--case")).is_err() && parse(&words("--fast")).is_err());
        assert!(chosen(cases::all(false), &["no such".into()]).is_err());
        assert_eq!(chosen(cases::all(false), &["slipping".into()]).expect("it is there").len(), 1);
    }
}
