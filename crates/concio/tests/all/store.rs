//! The store: what is written is read back bit for bit; broken files are errors; a journal survives any cut.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use crate::store_sample::{SMALL, Sample, Size, reshape, rows, sample};
use concio::Error;
use concio::dice::Dice;
use concio::outcome::Push;
use concio::record::{Channel, Recording};
use concio::store::{self, Journal, JournalHeader, Moving, RunFacts, StoredRun, digest, export, hdf5};
use concio::warning::{Warning, WarningKind};
use proptest::prelude::*;

fn write(path: &Path, s: &Sample) {
    hdf5::write(path, &s.provenance, &s.wall, &s.joints, &s.outcome).unwrap();
}

/// A journal in a folder that has no results.
fn create(folder: &Path, header: &JournalHeader) -> concio::Result<Journal> {
    Journal::create(folder, header, || Ok(()))
}

fn stored(s: Sample) -> StoredRun {
    let Sample { provenance, wall, joints, outcome } = s;
    StoredRun { schema_version: store::SCHEMA_VERSION, provenance, wall, joints, outcome }
}

fn round_trip(s: Sample) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    write(&path, &s);
    assert!(hdf5::read(&path).unwrap() == stored(s), "what is read differs from what was written");
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["result.h5"], "nothing but the result is left");
}

#[test]
fn a_run_is_read_back_as_written() {
    round_trip(sample(SMALL));
}

#[test]
fn runs_without_frames_channels_or_samples_are_read_back() {
    round_trip(sample(Size { frame_every: 0, beam: false, ..SMALL }));
    round_trip(sample(Size { channels: 0, ..SMALL }));
    let mut early = sample(SMALL);
    early.outcome.recording = Recording::default();
    early.outcome.stop_reason = concio::record::StopReason::StepTooShort;
    round_trip(early);
    round_trip(sample(Size { courses: 0, bricks: 0, channels: 0, ..SMALL }));
}

/// Polygons and lintels too; a file whose corners do not fit its blocks is refused.
#[test]
fn shapes_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    let mut s = sample(SMALL);
    reshape(&mut s.wall);
    write(&path, &s);
    let read = hdf5::read(&path).unwrap();
    let corners = |i: usize| read.wall.blocks[i].shape.as_ref().map(|shape| (shape.span, shape.corners.len()));
    assert_eq!([2, 3, 4, 5, 6].map(corners), [Some((2, 0)), None, Some((1, 3)), Some((1, 5)), Some((1, 4))]);
    assert!(read == stored(s));
    let mut s = sample(SMALL);
    reshape(&mut s.wall);
    s.wall.blocks[4].x[1] += 0.01;
    write(&path, &s);
    let error = hdf5::read(&path).unwrap_err().to_string();
    assert!(error.contains("`wall/blocks/corners` does not agree with the edges of block 4"), "{error}");
}

#[test]
fn odd_channel_names_are_read_back() {
    let mut s = sample(SMALL);
    let names = ["time", "a/b", "a", "a/b/c", "", "x//y", "Fuge ü/δ"];
    let channel = |n: &str| Channel { name: n.into(), unit: "m²".into(), description: String::new() };
    s.outcome.layout.channels = names.map(channel).to_vec();
    round_trip(s);
}

#[test]
fn values_that_are_not_finite_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    let mut s = sample(SMALL);
    s.outcome.totals.peak_input = f64::NAN;
    s.outcome.recording.values[3] = f64::INFINITY;
    write(&path, &s);
    let outcome = hdf5::read(&path).unwrap().outcome;
    assert!(outcome.totals.peak_input.is_nan() && outcome.recording.values[3] == f64::INFINITY);
}

#[test]
fn equal_runs_give_equal_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (folder.path().join("a.h5"), folder.path().join("other name.h5"));
    // More than one chunk in every large array.
    let size = Size { courses: 30, bricks: 30, samples: 3001, frame_every: 10, channels: 5, beam: true, planar: false };
    write(&a, &sample(size));
    write(&b, &sample(size));
    assert!(fs::read(&a).unwrap() == fs::read(&b).unwrap());
    let run = hdf5::read(&a).unwrap();
    for (k, name) in ["1.npz", "2.npz"].iter().enumerate() {
        export::npz(&run, &folder.path().join(name)).unwrap();
        assert_eq!(fs::read(folder.path().join(name)).unwrap(), fs::read(folder.path().join("1.npz")).unwrap(), "{k}");
    }
}

/// Panels, friction and all else of the wall are in the archive as in the HDF5 file.
#[test]
fn an_archive_holds_the_whole_wall() {
    let folder = tempfile::tempdir().unwrap();
    let (result, archive) = (folder.path().join("result.h5"), folder.path().join("result.npz"));
    write(&result, &sample(SMALL));
    let run = hdf5::read(&result).unwrap();
    export::npz(&run, &archive).unwrap();
    let mut zip = zip::ZipArchive::new(fs::File::open(&archive).unwrap()).unwrap();
    let mut numbers = |name: &str| -> Vec<f64> {
        let mut bytes = Vec::new();
        zip.by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut bytes).unwrap();
        npyz::NpyFile::new(&bytes[..]).unwrap().into_vec().unwrap()
    };
    let panels = &run.wall.panels;
    let lengths: Vec<f64> = panels.iter().map(|p| p.reference_length).collect();
    assert_eq!(numbers("wall/panels/reference_length"), lengths);
    let connections: Vec<f64> = panels.iter().map(|p| p.connection).collect();
    assert_eq!(numbers("wall/panels/connection"), connections);
    let static_: Vec<f64> = run.joints.iter().map(|j| j.friction.map_or(0.0, |f| f.static_)).collect();
    assert_eq!(numbers("wall/joints/friction_static"), static_);
    let mut rubs = Vec::new();
    zip.by_name("wall/joints/friction.npy").unwrap().read_to_end(&mut rubs).unwrap();
    let rubs: Vec<u8> = npyz::NpyFile::new(&rubs[..]).unwrap().into_vec().unwrap();
    let expected: Vec<u8> = run.joints.iter().map(|j| u8::from(j.friction.is_some())).collect();
    assert!(rubs == expected && rubs.contains(&0) && rubs.contains(&1), "{rubs:?}");
}

#[test]
fn a_result_is_replaced_and_a_folder_that_is_not_there_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    fs::write(&path, "an older file").unwrap();
    write(&path, &sample(SMALL));
    hdf5::read(&path).unwrap();
    let s = sample(SMALL);
    let nowhere = folder.path().join("no/such/result.h5");
    let error = hdf5::write(&nowhere, &s.provenance, &s.wall, &s.joints, &s.outcome).unwrap_err();
    assert!(matches!(&error, Error::Io { path, .. } if *path == nowhere), "{error}");
    let error = hdf5::read(&nowhere).unwrap_err();
    assert!(matches!(&error, Error::Io { path, .. } if *path == nowhere), "{error}");
}

#[test]
fn an_outcome_that_contradicts_itself_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    fs::write(&path, "an older file").unwrap();
    let mut s = sample(SMALL);
    s.outcome.recording.values.pop();
    let error = hdf5::write(&path, &s.provenance, &s.wall, &s.joints, &s.outcome).unwrap_err();
    assert!(matches!(error, Error::Store { .. }), "{error}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "an older file");
    let run = stored(s);
    assert!(export::npz(&run, &path).is_err() && export::vtkhdf(&run, &path).is_err());
    assert!(export::csv(&run, folder.path()).is_err());
}

#[test]
fn a_foreign_file_is_an_error_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    for content in [&b""[..], b"x", b"\x89HDF\r\n\x1a\n", &[0; 4096]] {
        fs::write(&path, content).unwrap();
        let error = hdf5::read(&path).unwrap_err();
        assert!(matches!(&error, Error::Store { path: p, .. } if *p == path), "{error}");
    }
    export::vtkhdf(&stored(sample(SMALL)), &path).unwrap();
    let error = hdf5::read(&path).unwrap_err().to_string();
    assert!(error.contains("not a result of Concio"), "{error}");
}

#[test]
fn a_truncated_file_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    write(&path, &sample(SMALL));
    let whole = fs::read(&path).unwrap();
    for part in 0..64 {
        fs::write(&path, &whole[..whole.len() * part / 64]).unwrap();
        let error = hdf5::read(&path).expect_err("a part is not the whole");
        assert!(matches!(error, Error::Store { .. }), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    /// A file that was damaged before it got its digest may still be readable where the damage hits a value; it must never panic
    /// or eat the memory. So it is with one that bears a digest made for it.
    #[test]
    fn a_damaged_file_does_not_panic(places in prop::collection::vec((0.0..1.0f64, any::<u8>()), 1..20)) {
        static WHOLE: OnceLock<Vec<u8>> = OnceLock::new();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.h5");
        let whole = WHOLE.get_or_init(|| {
            let size = Size { samples: 21, channels: 4, courses: 2, bricks: 2, frame_every: 5, beam: false, planar: false };
            write(&path, &sample(size));
            fs::read(&path).unwrap()
        });
        let mut bytes = whole[..whole.len() - LINE].to_vec();
        for (place, value) in places {
            let at = (place * bytes.len() as f64) as usize;
            bytes[at] = value;
        }
        bytes.extend(line(&bytes));
        fs::write(&path, bytes).unwrap();
        if let Err(error) = hdf5::read(&path) {
            prop_assert!(matches!(error, Error::Store { .. }), "{error}");
        }
    }
}

/// Length of the line with the digest, as docs/results.md has it.
const LINE: usize = 73;

/// The line with the digest of a result, as docs/results.md has it.
fn line(bytes: &[u8]) -> Vec<u8> {
    format!("\nBLAKE3 {}\n", blake3::hash(bytes).to_hex()).into_bytes()
}

/// Number `n` of single bits of a file, flipped: seeded, so that they are the same at every run.
fn flipped(whole: &[u8], n: u64) -> Vec<u8> {
    let mut dice = Dice::new(n);
    let (at, bit) = (dice.below(whole.len()), dice.below(8));
    let mut bytes = whole.to_vec();
    bytes[at] ^= 1 << bit;
    bytes
}

#[test]
fn a_result_ends_with_its_digest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    write(&path, &sample(SMALL));
    let bytes = fs::read(&path).unwrap();
    let (before, end) = bytes.split_at(bytes.len() - LINE);
    assert!(end == line(before), "{}", String::from_utf8_lossy(end));
    let noted = digest::noted(&path).unwrap();
    assert_eq!(noted.as_deref(), Some(blake3::hash(before).to_hex().as_str()));
    assert_eq!(digest::check(&path).unwrap(), noted);
}

/// HDF5 itself tells of some: of what it does not, most changed numbers that somebody may believe.
#[test]
fn a_bit_flipped_in_a_result_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    write(&path, &sample(SMALL));
    let whole = fs::read(&path).unwrap();
    for n in 0..200 {
        fs::write(&path, flipped(&whole, n)).unwrap();
        let error = hdf5::read(&path).expect_err("a bit is not what it was");
        assert!(matches!(&error, Error::Store { what, .. } if *what == digest::CHANGED), "{n}: {error}");
    }
    // Nor is one believed that lost its digest with a part of its own end.
    fs::write(&path, &whole[..whole.len() - LINE]).unwrap();
    assert!(hdf5::read(&path).unwrap_err().to_string().contains(digest::CHANGED));
}

/// Blanks and the order of keys are no content.
#[test]
fn a_bit_flipped_in_a_summary_is_told_or_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("summary.json");
    let s = sample(SMALL);
    let facts =
        RunFacts { duration: 0.1, warnings: vec![Warning::new(WarningKind::Creep, "One.")], ..RunFacts::default() };
    let summary = store::summary(&s.provenance, &s.wall, &s.joints, &s.outcome, &facts);
    store::write_summary(&path, &summary).unwrap();
    assert_eq!(store::read_summary(&path).unwrap(), summary);
    let whole = fs::read(&path).unwrap();
    let mut told = 0;
    for n in 0..200 {
        fs::write(&path, flipped(&whole, n)).unwrap();
        match store::read_summary(&path) {
            Ok(read) => assert_eq!(read, summary, "{n}"),
            Err(Error::Store { .. }) => told += 1,
            Err(other) => panic!("{other}"),
        }
    }
    assert!(told > 100, "{told} of 200 were told");
    let compact = serde_json::from_slice::<serde_json::Value>(&whole).unwrap().to_string();
    fs::write(&path, compact).unwrap();
    assert_eq!(store::read_summary(&path).unwrap(), summary);
}

fn header(s: &Sample) -> JournalHeader {
    let (inputs_hash, version) = (s.provenance.inputs_hash.clone(), s.provenance.version.clone());
    JournalHeader { inputs_hash, version, layout: s.outcome.layout.clone() }
}

fn state(samples: usize) -> Vec<u8> {
    (0..200 + samples).map(|k| (k * 7 + samples) as u8).collect()
}

/// Appends the samples of `range` by tens, with a checkpoint after every thirty.
fn go_on(journal: &mut Journal, header: &JournalHeader, range: std::ops::Range<usize>) {
    for start in range.clone().step_by(10) {
        journal.append(&rows(&header.layout, start..start + 10)).unwrap();
        if (start + 10) % 30 == 0 {
            journal.checkpoint(&state(start + 10)).unwrap();
        }
    }
}

#[test]
fn a_journal_resumes_at_its_checkpoint() {
    let s = sample(SMALL);
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join("new/run");
    let header = header(&s);
    assert!(Journal::resume(&at, &header).unwrap().is_none());
    let mut journal = create(&at, &header).unwrap();
    go_on(&mut journal, &header, 0..110);
    assert!(journal.read_all().unwrap() == rows(&header.layout, 0..110));
    drop(journal);

    let (mut journal, found) = Journal::resume(&at, &header).unwrap().expect("a checkpoint is there");
    assert_eq!(found, state(90));
    assert!(journal.read_all().unwrap() == rows(&header.layout, 0..90));
    go_on(&mut journal, &header, 90..200);
    assert!(journal.read_all().unwrap() == rows(&header.layout, 0..200));
    fs::write(at.join(".checkpoint.bin.x7.tmp"), "left behind by a kill").unwrap();
    journal.remove().unwrap();
    assert_eq!(fs::read_dir(&at).unwrap().count(), 0, "the folder is empty again");
}

#[test]
fn a_journal_of_other_inputs_is_not_resumed() {
    let s = sample(SMALL);
    let folder = tempfile::tempdir().unwrap();
    let header = header(&s);
    let mut journal = create(folder.path(), &header).unwrap();
    go_on(&mut journal, &header, 0..30);
    drop(journal);
    let mut others = [header.clone(), header.clone(), header.clone()];
    others[0].inputs_hash.push('0');
    others[1].version = "0.2.0".into();
    others[2].layout.interval *= 2.0;
    for other in &others {
        assert!(Journal::resume(folder.path(), other).unwrap().is_none());
    }
    assert!(Journal::resume(folder.path(), &header).unwrap().is_some());
    // A new journal takes the old state away before anything else.
    drop(create(folder.path(), &others[0]).unwrap());
    assert!(Journal::resume(folder.path(), &header).unwrap().is_none());
    assert!(Journal::resume(folder.path(), &others[0]).unwrap().is_none());
}

#[test]
fn two_runs_do_not_write_to_one_folder() {
    let s = sample(SMALL);
    let folder = tempfile::tempdir().unwrap();
    let header = header(&s);
    let mut first = create(folder.path(), &header).unwrap();
    go_on(&mut first, &header, 0..30);
    let error = create(folder.path(), &header).unwrap_err().to_string();
    assert!(error.contains("another run"), "{error}");
    assert!(Journal::resume(folder.path(), &header).is_err());
    assert!(first.read_all().unwrap() == rows(&header.layout, 0..30), "the first is unharmed");
    first.remove().unwrap();
    create(folder.path(), &header).unwrap();
}

/// What a link leads to is not written to, nor read as if it were the journal: a folder of results may be open to others.
#[cfg(unix)]
#[test]
fn a_journal_follows_no_links() {
    let folder = tempfile::tempdir().unwrap();
    let (run, theirs) = (folder.path().join("run"), folder.path().join("theirs"));
    let header = header(&sample(SMALL));
    fs::create_dir(&run).unwrap();
    // A whole journal of these inputs, at another place.
    let mut journal = create(&theirs, &header).unwrap();
    go_on(&mut journal, &header, 0..60);
    drop(journal);
    let names = ["journal.bin", "checkpoint.bin", "journal.lock"];
    let bytes = || names.map(|name| fs::read(theirs.join(name)).unwrap());
    let before = bytes();
    for name in names {
        std::os::unix::fs::symlink(theirs.join(name), run.join(name)).unwrap();
    }
    assert!(Journal::resume(&run, &header).unwrap().is_none(), "a journal that is a link is no journal");
    let mut journal = create(&run, &header).unwrap();
    go_on(&mut journal, &header, 0..30);
    drop(journal);
    assert!(bytes() == before, "what a link leads to was changed");
    for name in names {
        assert!(fs::symlink_metadata(run.join(name)).unwrap().is_file(), "{name} is a link still");
    }
    assert!(Journal::resume(&run, &header).unwrap().is_some());
    // A link that leads nowhere makes no file where it points.
    for name in names {
        fs::remove_file(run.join(name)).unwrap();
        std::os::unix::fs::symlink(folder.path().join("nothing"), run.join(name)).unwrap();
    }
    create(&run, &header).unwrap().remove().unwrap();
    assert!(!folder.path().join("nothing").exists());
    assert_eq!(fs::read_dir(&run).unwrap().count(), 0);
}

#[test]
fn rows_that_do_not_fit_are_refused_and_leave_the_journal_as_it_was() {
    let s = sample(SMALL);
    let folder = tempfile::tempdir().unwrap();
    let header = header(&s);
    let mut journal = create(folder.path(), &header).unwrap();
    go_on(&mut journal, &header, 0..20);
    let mut odd = rows(&header.layout, 20..30);
    odd.values.pop();
    assert!(journal.append(&odd).is_err());
    assert!(journal.read_all().unwrap() == rows(&header.layout, 0..20));
}

/// What may happen to a file.
#[derive(Debug, Clone)]
enum Harm {
    Cut(f64),
    Flip(f64, u8),
    Zero(f64, usize),
    Grow(Vec<u8>),
    Older,
    Gone,
}

fn harm() -> impl Strategy<Value = Harm> {
    prop_oneof![
        (0.0..1.0f64).prop_map(Harm::Cut),
        (0.0..1.0f64, 1..=255u8).prop_map(|(at, bits)| Harm::Flip(at, bits)),
        (0.0..1.0f64, 1..5000usize).prop_map(|(at, length)| Harm::Zero(at, length)),
        prop::collection::vec(any::<u8>(), 1..200).prop_map(Harm::Grow),
        Just(Harm::Older),
        Just(Harm::Gone),
    ]
}

fn do_harm(path: &Path, older: &[u8], harm: &Harm) {
    let mut bytes = fs::read(path).unwrap();
    let place = |at: f64| (at * bytes.len() as f64) as usize;
    match harm {
        Harm::Cut(at) => bytes.truncate(place(*at)),
        Harm::Flip(at, bits) => {
            let at = place(*at);
            bytes[at] ^= bits;
        }
        Harm::Zero(at, length) => {
            let (at, end) = (place(*at), bytes.len());
            bytes[at..(at + length).min(end)].fill(0);
        }
        Harm::Grow(more) => bytes.extend(more),
        Harm::Older => bytes = older.to_vec(),
        Harm::Gone => return fs::remove_file(path).unwrap(),
    }
    fs::write(path, bytes).unwrap();
}

const HARMED: Size = Size { samples: 201, courses: 2, bricks: 2, ..SMALL };
const FILES: [&str; 2] = ["journal.bin", "checkpoint.bin"];

/// Journal and checkpoint of a run, each as it was at 70 and at 110 samples. Made once: a checkpoint waits for the disk.
fn unharmed() -> &'static [[Vec<u8>; 2]; 2] {
    static MADE: OnceLock<[[Vec<u8>; 2]; 2]> = OnceLock::new();
    MADE.get_or_init(|| {
        let header = header(&sample(HARMED));
        let folder = tempfile::tempdir().unwrap();
        let content = || FILES.map(|name| fs::read(folder.path().join(name)).unwrap());
        let mut journal = create(folder.path(), &header).unwrap();
        go_on(&mut journal, &header, 0..70);
        let [older_journal, older_state] = content();
        go_on(&mut journal, &header, 70..110);
        let [journal, state] = content();
        [[older_journal, journal], [older_state, state]]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    /// Whatever happens to either file: resuming gives a state with exactly the rows before it, or nothing.
    #[test]
    fn a_harmed_journal_never_gives_wrong_data(
        journal_harm in prop::option::of(harm()),
        state_harm in prop::option::of(harm()),
    ) {
        let header = header(&sample(HARMED));
        let folder = tempfile::tempdir().unwrap();
        let harms = [&journal_harm, &state_harm];
        for ((name, [older, newer]), harm) in FILES.iter().zip(unharmed()).zip(harms) {
            let path = folder.path().join(name);
            fs::write(&path, newer).unwrap();
            if let Some(harm) = harm {
                do_harm(&path, older, harm);
            }
        }
        let resumed = Journal::resume(folder.path(), &header).unwrap();
        prop_assert!(resumed.is_some() || journal_harm.is_some() || state_harm.is_some());
        if let Some((mut journal, found)) = resumed {
            let samples = found.len() - 200;
            prop_assert!(samples == 60 || samples == 90);
            prop_assert_eq!(found, state(samples));
            prop_assert!(journal.read_all().unwrap() == rows(&header.layout, 0..samples));
            go_on(&mut journal, &header, samples..samples + 20);
            prop_assert!(journal.read_all().unwrap() == rows(&header.layout, 0..samples + 20));
        }
        // Starting anew works whatever is left in the folder.
        let mut journal = create(folder.path(), &header).unwrap();
        go_on(&mut journal, &header, 0..20);
        prop_assert!(journal.read_all().unwrap() == rows(&header.layout, 0..20));
    }
}

#[test]
fn every_prefix_of_a_journal_resumes_or_starts_anew() {
    let s = sample(Size { samples: 61, courses: 1, bricks: 2, channels: 1, ..SMALL });
    let folder = tempfile::tempdir().unwrap();
    let header = header(&s);
    let path = folder.path().join("journal.bin");
    let mut journal = create(folder.path(), &header).unwrap();
    go_on(&mut journal, &header, 0..30);
    let checkpoint_at = fs::metadata(&path).unwrap().len();
    go_on(&mut journal, &header, 30..40);
    drop(journal);
    let whole = fs::read(&path).unwrap();
    for length in 0..=whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        let resumed = Journal::resume(folder.path(), &header).unwrap();
        assert_eq!(resumed.is_some(), length as u64 >= checkpoint_at, "cut at {length}");
        if let Some((mut journal, _)) = resumed {
            assert!(journal.read_all().unwrap() == rows(&header.layout, 0..30), "cut at {length}");
        }
    }
}

/// Samples that the child of the tests below records.
const LONG: Size = Size { samples: 30_001, channels: 20, courses: 5, bricks: 5, ..SMALL };

/// Not a test: what the tests below start as a process of its own. Resumes or starts the journal in the folder that
/// CONCIO_JOURNAL names and goes on to the end.
#[test]
#[ignore = "a process that other tests start"]
fn journal_child() {
    let Some(folder) = std::env::var_os("CONCIO_JOURNAL").map(PathBuf::from) else { return };
    let header = header(&sample(LONG));
    let (mut journal, first) = match Journal::resume(&folder, &header).unwrap() {
        Some((journal, state)) => (journal, state.len() - 200),
        None => (create(&folder, &header).unwrap(), 0),
    };
    go_on(&mut journal, &header, first..LONG.samples - 1);
}

/// Not a test: writes a result into the folder.
#[test]
#[ignore = "a process that other tests start"]
fn result_child() {
    let Some(folder) = std::env::var_os("CONCIO_JOURNAL").map(PathBuf::from) else { return };
    write(&folder.join("result.h5"), &sample(LONG));
}

/// Not a test: writes an archive into the folder.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "a process that other tests start"]
fn archive_child() {
    let Some(folder) = std::env::var_os("CONCIO_JOURNAL").map(PathBuf::from) else { return };
    export::npz(&stored(sample(LONG)), &folder.join("result.npz")).unwrap();
}

fn start_child(folder: &Path, name: &str, before: &str) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", &format!(r#"{before} exec "$0" --exact store::{name} --ignored --nocapture"#)]);
    command.arg(std::env::current_exe().unwrap()).env("CONCIO_JOURNAL", folder);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

#[cfg(unix)]
#[test]
fn a_killed_run_resumes_from_whatever_it_left() {
    let folder = tempfile::tempdir().unwrap();
    let header = header(&sample(LONG));
    let mut reached = Vec::new();
    for attempt in 0..12 {
        let mut child = start_child(folder.path(), "journal_child", "").spawn().unwrap();
        let patience = Instant::now();
        while !folder.path().join("checkpoint.bin").exists() && patience.elapsed() < Duration::from_secs(60) {
            std::thread::yield_now();
        }
        std::thread::sleep(Duration::from_millis(7 * attempt));
        child.kill().unwrap();
        child.wait().unwrap();
        let samples = match Journal::resume(folder.path(), &header).unwrap() {
            Some((mut journal, found)) => {
                let samples = found.len() - 200;
                assert_eq!(found, state(samples));
                assert!(journal.read_all().unwrap() == rows(&header.layout, 0..samples), "after {reached:?}");
                samples
            }
            None => 0,
        };
        assert!(reached.last().is_none_or(|&before| samples >= before), "{samples} after {reached:?}");
        reached.push(samples);
    }
    assert!(reached.last().is_some_and(|&samples| samples > 0), "no attempt came to a checkpoint");
}

/// A limit on the size of files stands for a full disk: the write fails half-way.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_that_names_the_file_and_keeps_the_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let header = header(&sample(LONG));
    let output = start_child(folder.path(), "journal_child", "trap '' XFSZ; ulimit -f 100;").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("Io {") && said.contains("journal.bin"), "{said}");
    let (mut journal, found) = Journal::resume(folder.path(), &header).unwrap().expect("the checkpoint is whole");
    let samples = found.len() - 200;
    assert!(samples > 0 && journal.read_all().unwrap() == rows(&header.layout, 0..samples));
    go_on(&mut journal, &header, samples..samples + 60);
    assert!(journal.read_all().unwrap() == rows(&header.layout, 0..samples + 60));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_keeps_the_former_result() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    write(&path, &sample(SMALL));
    for limit in [1, 100, 1000] {
        let before = format!("trap '' XFSZ; ulimit -f {limit};");
        let output = start_child(folder.path(), "result_child", &before).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains("Err` value") && said.contains("result.h5"), "{said}");
        assert!(hdf5::read(&path).unwrap() == stored(sample(SMALL)));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "the temporary file is gone");
    }
}

/// One sentence tells it: the archive that is given up says nothing of its own.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_of_an_archive_once() {
    let folder = tempfile::tempdir().unwrap();
    for limit in [1, 20, 40] {
        let before = format!("trap '' XFSZ; ulimit -f {limit};");
        let output = start_child(folder.path(), "archive_child", &before).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains("Err` value") && said.contains("result.npz"), "{said}");
        assert!(!said.contains("ZipWriter"), "{said}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "the temporary file is gone");
    }
}

#[test]
fn summary_has_the_keys_that_other_programs_read() {
    let s = sample(SMALL);
    let facts = RunFacts {
        duration: 0.1,
        weight: 3e4,
        base_load: 5e4,
        solve_seconds: 0.5,
        resumed_from: None,
        push: Some(Push { stiffness: 2e7, ultimate: Some(5e-3) }),
        at_first_crack: Some(Moving { acceleration: -2.5, beam: Some(1e-3) }),
        warnings: vec![Warning::new(WarningKind::Collapse, "One.")],
    };
    let summary = store::summary(&s.provenance, &s.wall, &s.joints, &s.outcome, &facts);
    let number = |key: &str| summary.pointer(key).and_then(|v| v.as_f64()).unwrap_or_else(|| panic!("no {key}"));
    assert_eq!(number("/blocks"), 12.0);
    assert_eq!(number("/joints"), s.joints.len() as f64);
    assert_eq!(number("/unknowns"), 13.0);
    assert_eq!(number("/steps"), 10.0);
    assert_eq!((number("/weight"), number("/base_load")), (3e4, 5e4));
    assert_eq!(number("/solve_seconds"), 0.5);
    assert_eq!(number("/peak_relative_displacement"), 1.1e-3);
    assert_eq!(number("/peak_slip_velocity"), 2.2e-2);
    assert_eq!(number("/weight"), 3e4);
    assert_eq!(number("/base_shear_peak"), 1.9e5);
    assert_eq!((number("/base_shear_time"), number("/base_shear_displacement")), (0.02, -1.25e-3));
    assert_eq!((number("/push/stiffness"), number("/push/ultimate")), (2e7, 5e-3));
    assert_eq!((number("/drift/peak"), number("/drift/displacement"), number("/drift/time")), (-4e-3, -2e-3, 0.03));
    assert!(summary["drift"]["top"] == "p1" && summary["drift"]["residual"].is_null(), "{}", summary["drift"]);
    assert_eq!((number("/bonds/first_acceleration"), number("/bonds/first_beam")), (-2.5, 1e-3));
    assert_eq!((number("/collapse/time"), number("/collapse/displacement")), (0.06, 0.25));
    assert_eq!(summary.pointer("/collapse/block").and_then(|v| v.as_str()), Some(s.wall.blocks[0].name.as_str()));
    assert_eq!(number("/top_work"), 2.5);
    assert_eq!(number("/top_force_peak"), 2.3e5);
    // √(4e8 N² s / 0.06 s): until it collapsed.
    assert!((number("/top_force_rms") / 81_649.658_092_772_6 - 1.0).abs() < 1e-14);
    assert_eq!(number("/minimum_gap"), -1.0e-9);
    assert_eq!(number("/energy/input"), 4.0);
    assert_eq!(number("/energy/friction"), 3.0);
    assert_eq!(number("/energy/nonreciprocal"), 0.03125);
    assert_eq!(number("/energy/residual_relative"), 2.5e-7);
    assert_eq!(summary["stop_reason"], "completed");
    assert_eq!(summary["inputs_hash"], "0123456789abcdef");
    assert_eq!(summary["version"], "0.1.0");
    assert_eq!((&summary["warnings"][0], &summary["warning_kinds"][0]), (&"One.".into(), &"collapse".into()));
    for key in ["kinetic", "elastic", "damping", "bond"] {
        number(&format!("/energy/{key}"));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("summary.json");
    store::write_summary(&path, &summary).unwrap();
    let mut read: serde_json::Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    assert_eq!(read["digest"], blake3::hash(summary.to_string().as_bytes()).to_hex().as_str());
    read.as_object_mut().unwrap().remove("digest");
    assert_eq!(read, summary);
}

#[test]
fn a_run_without_work_or_motion_has_a_finite_summary() {
    let mut s = sample(SMALL);
    s.outcome.energies.initial = 0.0;
    s.outcome.totals.peak_input = 0.0;
    s.outcome.totals.peak_work = 0.0;
    s.outcome.time_reached = 0.0;
    let summary = store::summary(&s.provenance, &s.wall, &s.joints, &s.outcome, &RunFacts::default());
    assert_eq!(summary["energy"]["residual_relative"], 0.0);
    assert_eq!(summary["top_force_rms"], 0.0);
}

#[test]
fn csv_holds_every_number_with_its_unit() {
    let folder = tempfile::tempdir().unwrap();
    let run = stored(sample(SMALL));
    let at = folder.path().join("csv");
    export::csv(&run, &at).unwrap();
    let table = |name: &str| {
        let mut reader = csv::Reader::from_path(at.join(name)).unwrap();
        let head: Vec<String> = reader.headers().unwrap().iter().map(str::to_string).collect();
        let rows: Vec<Vec<String>> =
            reader.records().map(|r| r.unwrap().iter().map(str::to_string).collect()).collect();
        (head, rows)
    };
    let (head, histories) = table("histories.csv");
    assert_eq!(head[..2], ["time [s]", "top/displacement [m]"]);
    let (recording, width) = (&run.outcome.recording, head.len() - 1);
    assert_eq!((histories.len(), width), (401, 7));
    for (k, row) in histories.iter().enumerate() {
        let numbers: Vec<f64> = row.iter().map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(numbers[0], recording.time[k]);
        assert_eq!(numbers[1..], recording.values[k * width..(k + 1) * width]);
    }
    let (head, envelopes) = table("joint_envelopes.csv");
    assert_eq!(head[4], "slip [m]");
    assert_eq!(envelopes.len(), run.joints.len());
    assert_eq!(envelopes[2][0], run.joints[2].name);
    assert_eq!(envelopes[2][4].parse::<f64>().unwrap(), run.outcome.envelopes.joint_slip[2]);
    let (_, envelopes) = table("block_envelopes.csv");
    assert_eq!(envelopes.last().unwrap()[0], "beam");
    let (head, joints) = table("joints.csv");
    assert_eq!(joints.len(), run.joints.len());
    assert_eq!(joints[0][..5], ["p1c1b1|base", "base", "p1c1b1", "base", "elastic"]);
    let stiffness = head.iter().position(|h| h == "stiffness [N/m]").unwrap();
    assert_eq!(joints[3][stiffness].parse::<f64>().unwrap(), run.joints[3].stiffness);
    let (head, events) = table("events.csv");
    assert_eq!(head, ["time [s]", "joint", "kind", "value", "unit"]);
    assert_eq!(events.len(), recording.events.len());
    for (row, event) in events.iter().zip(&recording.events) {
        let numbers = [&row[0], &row[3]].map(|cell| cell.parse::<f64>().unwrap());
        assert_eq!(numbers, [event.time, event.value]);
        assert_eq!([&row[1], &row[2], &row[4]], [&run.joints[event.joint as usize].name, "impact", "N s"]);
    }
    let mut quiet = run.clone();
    quiet.outcome.recording.events.clear();
    export::csv(&quiet, &folder.path().join("quiet")).unwrap();
    assert!(!folder.path().join("quiet/events.csv").exists(), "a table of nothing");
    assert!(!at.join("corners.csv").exists(), "rectangles have edges");
    let mut shaped = run.clone();
    reshape(&mut shaped.wall);
    export::csv(&shaped, &folder.path().join("shaped")).unwrap();
    let corners = fs::read_to_string(folder.path().join("shaped/corners.csv")).unwrap();
    let of_triangle: Vec<&str> = corners.lines().filter(|l| l.starts_with("p1c2b1,")).collect();
    assert_eq!((corners.lines().next(), of_triangle.len()), (Some("block,x [m],y [m]"), 3));
    let [x, y] = shaped.wall.blocks[4].corners()[2];
    assert_eq!(of_triangle[2], format!("p1c2b1,{x:e},{y:e}"));
    let (head, blocks) = table("blocks.csv");
    let mass = head.iter().position(|h| h == "mass [kg]").unwrap();
    assert_eq!(blocks[5][mass].parse::<f64>().unwrap(), run.wall.blocks[5].mass());
}

/// h5py, VTK and NumPy on the files themselves; needs a Python with `h5py`, `numpy` and `vtk`, named by CONCIO_PYTHON.
#[test]
fn other_readers_agree() {
    let Some(python) = std::env::var_os("CONCIO_PYTHON") else {
        concio_verified::skip("readers in Python (CONCIO_PYTHON is not set)");
        return;
    };
    let sizes = [
        SMALL,
        Size { frame_every: 0, beam: false, ..SMALL },
        Size { courses: 40, bricks: 50, samples: 501, frame_every: 25, channels: 9, beam: false, planar: false },
        Size { planar: true, ..SMALL },
    ];
    let mut samples = Vec::from(sizes.map(|size| (size, sample(size))));
    let mut shaped = sample(Size { planar: true, ..SMALL });
    reshape(&mut shaped.wall);
    samples.push((SMALL, shaped));
    for (size, sample) in samples {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        write(&at("result.h5"), &sample);
        let run = hdf5::read(&at("result.h5")).unwrap();
        export::csv(&run, &at("csv")).unwrap();
        export::npz(&run, &at("result.npz")).unwrap();
        export::vtkhdf(&run, &at("result.vtkhdf")).unwrap();
        let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/python/check_result.py");
        let check = || {
            let mut command = Command::new(&python);
            command.arg(&script).arg(at("result.h5")).arg("--vtkhdf").arg(at("result.vtkhdf"));
            let output = command.arg("--csv").arg(at("csv")).arg("--npz").arg(at("result.npz")).output().unwrap();
            let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
            (output.status.success(), said.into_owned())
        };
        let (passed, said) = check();
        assert!(passed, "{size:?}: {said}");

        // The check must notice a single other value in each of the files.
        let mut other = run.clone();
        other.outcome.recording.values[10] += 1e-12;
        other.wall.blocks[1].y[1] += 1e-12;
        export::csv(&other, &at("csv")).unwrap();
        let (passed, said) = check();
        assert!(!passed && said.contains("mismatch: csv"), "{said}");
        export::npz(&other, &at("result.npz")).unwrap();
        let (passed, said) = check();
        assert!(!passed && said.contains("mismatch: npz"), "{said}");
        export::vtkhdf(&other, &at("result.vtkhdf")).unwrap();
        let (passed, said) = check();
        assert!(!passed && said.contains("points: values differ"), "{said}");
    }
}

/// Run by hand for its figures: `cargo test --release -p concio --test all -- --ignored --nocapture store::large`.
#[test]
#[ignore = "writes a gigabyte; prints figures"]
fn large_runs() {
    let folder = tempfile::tempdir().unwrap();
    let long =
        Size { courses: 6, bricks: 4, samples: 80_001, frame_every: 0, channels: 200, beam: false, planar: false };
    let wide =
        Size { courses: 100, bricks: 100, samples: 2000, frame_every: 1, channels: 10, beam: false, planar: false };
    for (name, size) in [("80,001 samples of 200 channels", long), ("2,000 frames of 10,000 blocks", wide)] {
        let s = sample(size);
        let path = folder.path().join("result.h5");
        let start = Instant::now();
        write(&path, &s);
        let written = start.elapsed();
        let bytes = fs::metadata(&path).unwrap().len();
        let start = Instant::now();
        let run = hdf5::read(&path).unwrap();
        println!("{name}: {written:.2?} written, {bytes} bytes, {:.2?} read", start.elapsed());
        let header = header(&s);
        let start = Instant::now();
        let mut journal = create(&folder.path().join("run"), &header).unwrap();
        for first in (0..size.samples - size.samples % 100).step_by(100) {
            journal.append(&rows(&header.layout, first..first + 100)).unwrap();
        }
        journal.checkpoint(&[0; 1000]).unwrap();
        println!("{name}: {:.2?} made and journalled", start.elapsed());
        let start = Instant::now();
        journal.read_all().unwrap();
        println!("{name}: {:.2?} journal read", start.elapsed());
        journal.remove().unwrap();
        let start = Instant::now();
        export::npz(&run, &folder.path().join("result.npz")).unwrap();
        println!("{name}: {:.2?} npz", start.elapsed());
        let start = Instant::now();
        export::csv(&run, &folder.path().join("csv")).unwrap();
        println!("{name}: {:.2?} csv", start.elapsed());
    }
}
