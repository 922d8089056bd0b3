//! Files that went wrong are refused or taken, and neither ends the program nor its machine. Alone in its program, because it
//! counts what the whole program asks for.

mod mutants;

use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use concio::case;
use concio::dice::Dice;
use concio::run::prepare_case;
use concio::{bond, device};
use concio_study::shaking::first_mode;
use concio_study::{Plan, first_crack, interfaces};
use mutants::{examples, mutant};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What `concio check` may take in memory [bytes].
const MOST_MEMORY: usize = 2_000_000_000;
/// After this a file is taken for one that never ends.
const ENDLESS: Duration = Duration::from_secs(120);
/// Blocks up to which `concio check` looks for rest and period.
const TRIED: usize = 2_000;
/// Runs of a study that are made.
const MADE: usize = 50;

/// What `concio check` does of a wall file but for its text: whether it is one.
fn checked(path: &Path) -> concio::Result<()> {
    let file = case::read(path)?;
    for finding in file.findings() {
        assert!(finding.line.is_some() && finding.key.is_some(), "{finding}");
    }
    file.validate()?;
    let prepared = prepare_case(file.case.clone(), file.folder()).map_err(|e| file.locate(e))?;
    let model = &prepared.model;
    if model.wall.blocks.len() <= TRIED {
        model.planar().map(|planar| planar.rest());
        first_mode(model);
    }
    assert_eq!(model.joint_names().len(), concio::run::joint_rows(model).len());
    device::ratings(&prepared.case, &model.wall, &model.joints)?;
    bond::given(&prepared.case, &model.wall, &model.joints)?;
    Ok(())
}

/// What `concio study check` does, of the first runs.
fn checked_study(path: &Path) -> concio::Result<()> {
    let plan = Plan::read(path)?;
    for number in 0..plan.points.len().min(MADE) {
        plan.id(&plan.case(number)?)?;
        plan.labels(number);
    }
    if plan.file.study.first_crack.is_some() {
        first_crack::of_study(&plan)?;
    }
    if plan.file.study.interfaces.is_some() {
        interfaces::question(&plan)?;
    }
    Ok(())
}

/// Mutants of files that are checked one after the other: how many were taken.
fn mutate(files: &[String], seed: u64, count: usize, check: fn(&Path) -> concio::Result<()>) -> usize {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mutant.toml");
    let mut dice = Dice::new(seed);
    let (mut taken, mut slowest) = (0, Duration::ZERO);
    for number in 0..count {
        let mutant = mutant(&files[dice.below(files.len())], &mut dice);
        std::fs::write(&path, &mutant).expect("a file");
        let text = || String::from_utf8_lossy(&mutant).into_owned();
        MEMORY.reset_peak_usage();
        let (begun, (say, hear)) = (Instant::now(), channel());
        let its = path.clone();
        let worker = thread::spawn(move || say.send(check(&its)).is_ok());
        let found = match hear.recv_timeout(ENDLESS) {
            Ok(found) => found,
            Err(RecvTimeoutError::Disconnected) => panic!("mutant {number} panicked:\n{}", text()),
            Err(RecvTimeoutError::Timeout) => panic!("mutant {number} does not end:\n{}", text()),
        };
        assert!(worker.join().expect("it said what it found"));
        slowest = slowest.max(begun.elapsed());
        assert!(MEMORY.peak_usage() < MOST_MEMORY, "mutant {number} takes {} bytes:\n{}", MEMORY.peak_usage(), text());
        match found {
            Ok(()) => taken += 1,
            Err(error) => {
                let told = error.to_string();
                assert!(matches!(error, concio::Error::Input(_)) && !told.is_empty(), "{number}: {told}\n{}", text());
            }
        }
    }
    println!("{taken} of {count} were taken, the slowest in {slowest:.1?}");
    taken
}

#[test]
fn mutated_files_are_refused_or_taken() {
    let walls: Vec<String> = ["", "report", "limit"].iter().flat_map(|folder| examples(folder)).collect();
    assert!(walls.len() >= 20);
    let taken = mutate(&walls, 1, 400, checked);
    // A generator whose files are all alike would try nothing.
    assert!((40..360).contains(&taken), "{taken} of 400 walls were taken");
    let studies: Vec<String> = examples("studies").into_iter().filter(|text| text.contains("wall = ")).collect();
    let taken = mutate(&studies, 2, 100, checked_study);
    assert!((10..90).contains(&taken), "{taken} of 100 studies were taken");
}
