//! What is known of runs, on disk: `runs/part-NNNN.jsonl` in the folder of a study, one line per run.
//!
//! Every process appends to a part of its own, so that shards share a folder without locks. A line is written at one
//! go; one that a killed process left unfinished is passed over, and its run is done again. The same run may stand in
//! two parts, when shards raced for it: equal inputs give equal rows, and the first is taken. Rows of other measures than
//! today's are not known, so that their runs are done again.
//!
//! A line is an object in JSON whose last key is `digest`: BLAKE3 of all of the line before it. A line that has another counts
//! for nothing and is told ([`Store::faults`]), and so are kept results whose digest is not that in their row.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::fmt::{self, Display};
use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use concio::store::digest;
use concio::{Error, Result};
use rayon::prelude::*;

use crate::file::PerJoint;
use crate::measures::{End, MEASURES, Row, VERSION};

/// Folder of the parts in that of the study.
const RUNS: &str = "runs";
/// Time by the clock between two demands on the disk to hold what was written: what a power failure can lose. A killed
/// process loses nothing that was appended.
const BETWEEN_SYNCS: Duration = Duration::from_secs(2);

/// The rows of a folder.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    rows: HashMap<String, Row>,
    /// Digests that kept results were written with, by the id of the run: one, but where machines reckon differently.
    results: HashMap<String, Vec<String>>,
    /// Runs whose kept result was read whole and found to be what was written.
    read: HashSet<String>,
    part: Option<Part>,
    faults: Vec<Fault>,
    /// Lines that were passed over because their measures are those of another version.
    pub outdated: usize,
}

/// What does not count because it is not what was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The file.
    pub path: PathBuf,
    /// Line in it, from 1; none of a file that is one whole.
    pub line: Option<usize>,
    /// What is wrong with it.
    pub what: &'static str,
}

impl Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = self.line.map_or(String::new(), |line| format!(":{line}"));
        write!(f, "{}{line}: {}", self.path.display(), self.what)
    }
}

/// Numbers of rows that were written before there were rocking walls: such runs have none of their measures.
const BEFORE_ROCKING: usize = 33;

/// Said of the last line of a part.
const UNFINISHED: &str = "the line is not whole: a process was stopped while it wrote it, or is writing it now";
const NO_LINE: &str = "this is no row of a study";

/// The file that this process appends to.
#[derive(Debug)]
struct Part {
    path: PathBuf,
    file: File,
    length: u64,
    synced: Instant,
}

impl Store {
    /// The row of a run, if it holds all that is to be kept: `joints`, and with `results` the whole result, which is a file that
    /// ends with the digest in the row. [`Store::look_at_results`] can read such files whole.
    pub fn holding(&self, id: &str, joints: &[PerJoint], results: bool) -> Option<&Row> {
        let row = self.get(id)?;
        let file = || row.end == End::Failed || self.read.contains(id) || self.is_ours(id, digest::noted);
        (row.has(joints) && (!results || file())).then_some(row)
    }

    /// Whether a kept result has a digest that its run was written with, as `found` finds it.
    fn is_ours(&self, id: &str, found: impl Fn(&Path) -> Result<Option<String>>) -> bool {
        let found = found(&self.result_path(id)).ok().flatten();
        found.is_some_and(|found| self.results.get(id).is_some_and(|known| known.contains(&found)))
    }

    /// Takes kept results that are not what was written for not there, and for faults: with `whole` it reads them all, side by
    /// side, else only where their digest stands, which tells a file that was cut off or is another's, and takes no time.
    pub fn look_at_results<'i>(&mut self, ids: impl Iterator<Item = &'i str>, whole: bool) {
        let one = |id: &&str| self.results.contains_key(*id) && !self.read.contains(*id);
        // In order, so that faults are.
        let ids: BTreeSet<&str> = ids.filter(one).collect();
        let found = if whole { digest::check } else { digest::noted };
        let looked: Vec<(&str, bool)> = ids.into_par_iter().map(|id| (id, self.is_ours(id, found))).collect();
        for (id, is_ours) in looked {
            if is_ours {
                self.read.extend(whole.then(|| id.to_string()));
                continue;
            }
            self.results.remove(id);
            let path = self.result_path(id);
            // One that is not there was removed by somebody: that is no fault.
            if path.exists() {
                self.faults.push(Fault { path, line: None, what: digest::CHANGED });
            }
        }
    }

    /// What was passed over because it is not what was written.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// Where the whole result of a run is kept.
    pub fn result_path(&self, id: &str) -> PathBuf {
        self.folder.join("results").join(format!("{id}.h5"))
    }

    /// Reads what the folder knows; a folder that is not there knows nothing, and is made when the first row comes.
    ///
    /// # Errors
    /// [`Error::Io`] when a part cannot be read.
    pub fn open(folder: &Path) -> Result<Self> {
        let mut store = Store {
            folder: folder.to_path_buf(),
            rows: HashMap::new(),
            results: HashMap::new(),
            read: HashSet::new(),
            part: None,
            faults: Vec::new(),
            outdated: 0,
        };
        for path in parts(&folder.join(RUNS))? {
            store.read_part(&path)?;
        }
        Ok(store)
    }

    fn read_part(&mut self, path: &Path) -> Result<()> {
        let bytes = fs::read(path).map_err(|e| Error::io(path, e))?;
        let mut lines = bytes.split(|b| *b == b'\n').enumerate().peekable();
        while let Some((number, line)) = lines.next() {
            if line.is_empty() {
                continue;
            }
            match parsed(line) {
                Ok(row) if row.version != VERSION => self.outdated += 1,
                Ok(mut row) if row.numbers.len() == BEFORE_ROCKING => {
                    row.numbers.resize(MEASURES.len(), None);
                    self.keep(row);
                }
                Ok(row) if row.numbers.is_empty() || row.numbers.len() == MEASURES.len() => self.keep(row),
                found => {
                    let what = match found {
                        _ if lines.peek().is_none() => UNFINISHED,
                        Ok(_) => NO_LINE,
                        Err(what) => what,
                    };
                    self.faults.push(Fault { path: path.to_path_buf(), line: Some(number + 1), what });
                }
            }
        }
        Ok(())
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The row of a run.
    pub fn get(&self, id: &str) -> Option<&Row> {
        self.rows.get(id)
    }

    /// Number of runs known.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether no run is known.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The first row of a run stays; a later one adds what it holds more, for the numbers of one id are equal.
    fn keep(&mut self, row: Row) {
        if let Some(digest) = &row.result {
            self.results.entry(row.id.clone()).or_default().push(digest.clone());
        }
        match self.rows.get_mut(&row.id) {
            Some(known) => {
                for (kind, values) in row.joints {
                    known.joints.entry(kind).or_insert(values);
                }
            }
            None => drop(self.rows.insert(row.id.clone(), row)),
        }
    }

    /// Adds a row, on disk first.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be written; what was written before stays whole.
    pub fn append(&mut self, row: Row) -> Result<()> {
        if self.part.is_none() {
            self.part = Some(Part::create(&self.folder.join(RUNS))?);
        }
        let Some(part) = &mut self.part else { return Ok(()) };
        part.append(&row)?;
        // Its result was written just now.
        self.read.extend(row.result.is_some().then(|| row.id.clone()));
        self.keep(row);
        Ok(())
    }

    /// Makes the disk hold all that was appended.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn sync(&mut self) -> Result<()> {
        match &mut self.part {
            Some(part) => part.sync(),
            None => Ok(()),
        }
    }
}

impl Part {
    fn create(folder: &Path) -> Result<Self> {
        fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
        let mut number = parts(folder)?.len();
        loop {
            number += 1;
            let path = folder.join(format!("part-{number:04}.jsonl"));
            // Refused where the file is there already: another process took the number.
            match OpenOptions::new().append(true).create_new(true).open(&path) {
                Ok(file) => return Ok(Part { path, file, length: 0, synced: Instant::now() }),
                Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
                Err(e) => return Err(Error::io(&path, e)),
            }
        }
    }

    fn append(&mut self, row: &Row) -> Result<()> {
        let line = line_of(row).map_err(|e| Error::Store { path: self.path.clone(), what: e.to_string() })?;
        if let Err(e) = self.file.write_all(line.as_bytes()) {
            // A full disk may have taken the start of the line; if it cannot be taken back, readers pass it over.
            let _ = self.file.set_len(self.length);
            return Err(Error::io(&self.path, e));
        }
        self.length += line.len() as u64;
        if self.synced.elapsed() >= BETWEEN_SYNCS { self.sync() } else { Ok(()) }
    }

    fn sync(&mut self) -> Result<()> {
        self.synced = Instant::now();
        self.file.sync_data().map_err(|e| Error::io(&self.path, e))
    }
}

/// The key of the digest, as it stands behind the rest of a line.
const LEAD: &str = ",\"digest\":\"";
const END: &str = "\"}";

/// A line with its digest.
///
/// # Errors
/// None that is known: rows are numbers and text.
pub fn line_of(row: &Row) -> serde_json::Result<String> {
    let mut line = serde_json::to_string(row)?;
    line.pop();
    let digest = blake3::hash(line.as_bytes()).to_hex();
    line.extend([LEAD, digest.as_str(), END, "\n"]);
    Ok(line)
}

/// The row of a line; what is wrong with one that was not written so. Rows of other versions may have no digest.
///
/// # Errors
/// What is wrong, in words.
pub fn parsed(line: &[u8]) -> std::result::Result<Row, &'static str> {
    let end = LEAD.len() + 2 * blake3::OUT_LEN + END.len();
    let (before, noted) = line.split_at(line.len().saturating_sub(end));
    let expected = [LEAD, blake3::hash(before).to_hex().as_str(), END].concat();
    let row = serde_json::from_slice::<Row>(line);
    match (noted == expected.as_bytes(), row) {
        (true, Ok(row)) => Ok(row),
        (true, Err(_)) => Err(NO_LINE),
        (false, Ok(row)) if row.version < VERSION && !contains(line, LEAD.as_bytes()) => Ok(row),
        (false, _) => Err(digest::CHANGED),
    }
}

fn contains(line: &[u8], text: &[u8]) -> bool {
    line.windows(text.len()).any(|w| w == text)
}

/// The parts of a folder in the order of their names.
fn parts(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(e) => return Err(Error::io(folder, e)),
    };
    let mut parts = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| Error::io(folder, e))?.path();
        // A pipe of that name would never end.
        if path.extension().is_some_and(|e| e == "jsonl") && path.is_file() {
            parts.push(path);
        }
    }
    parts.sort();
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(id: &str, value: f64) -> Row {
        let mut row = Row::failed(id, "");
        (row.end, row.cause) = (crate::measures::End::Completed, None);
        row.numbers = vec![Some(value); MEASURES.len()];
        row
    }

    #[test]
    fn rows_come_back_to_the_bit_and_torn_lines_are_passed_over() -> Result<()> {
        let folder = tempfile::tempdir().map_err(|e| Error::io("", e))?;
        let mut store = Store::open(folder.path())?;
        let values = [0.1 + 0.2, 1e-300, -1.0 / 3.0, 5e-324];
        for (i, v) in values.iter().enumerate() {
            store.append(row(&format!("r{i}"), *v))?;
        }
        let part = parts(&folder.path().join(RUNS))?.remove(0);
        let whole = fs::read(&part).map_err(|e| Error::io(&part, e))?;
        // Cut anywhere, as a killed process may leave it: the runs before the cut are there, the others are not.
        for cut in (0..whole.len()).step_by(11) {
            fs::write(&part, &whole[..cut]).map_err(|e| Error::io(&part, e))?;
            let found = Store::open(folder.path())?;
            let complete = whole[..cut].iter().filter(|b| **b == b'\n').count();
            // A line whose end alone is missing is whole.
            let whole = found.len() == complete + 1 && whole[cut] == b'\n';
            assert!(found.len() == complete || whole, "cut at {cut}");
            let begun = !whole && cut > 0 && fs::read(&part).is_ok_and(|bytes| bytes.last() != Some(&b'\n'));
            let told = found.faults().iter().map(|f| (f.line, f.what)).collect::<Vec<_>>();
            assert_eq!(told, if begun { vec![(Some(complete + 1), UNFINISHED)] } else { Vec::new() }, "cut at {cut}");
        }
        fs::write(&part, &whole).map_err(|e| Error::io(&part, e))?;
        let found = Store::open(folder.path())?;
        for (i, v) in values.iter().enumerate() {
            let back = found.get(&format!("r{i}")).and_then(|r| r.numbers[0]);
            assert_eq!(back.map(f64::to_bits), Some(v.to_bits()));
        }
        Ok(())
    }

    /// A line of an earlier version, written before rows had a number of theirs or with another one, counts for nothing
    /// however many numbers it has.
    #[test]
    fn rows_of_other_measures_are_not_known() -> Result<()> {
        let folder = tempfile::tempdir().map_err(|e| Error::io("", e))?;
        let mut store = Store::open(folder.path())?;
        store.append(row("now", 1.0))?;
        let part = parts(&folder.path().join(RUNS))?.remove(0);
        let now = fs::read_to_string(&part).map_err(|e| Error::io(&part, e))?;
        let told = format!("\"version\":{VERSION},");
        assert!(now.contains(&told), "{now}");
        // Rows had no digests then.
        let bare = now.split(LEAD).next().unwrap_or_default().to_string() + "}\n";
        let unnumbered = bare.replace(&told, "").replace("\"now\"", "\"first\"");
        let other = bare.replace(&told, &format!("\"version\":{},", VERSION - 1)).replace("\"now\"", "\"second\"");
        let mut third = row("third", 1.0);
        third.version = VERSION + 1;
        let third = line_of(&third).map_err(|e| Error::Store { path: part.clone(), what: e.to_string() })?;
        fs::write(&part, unnumbered + &other + &third + &now).map_err(|e| Error::io(&part, e))?;
        let found = Store::open(folder.path())?;
        assert_eq!((found.len(), found.outdated, found.faults().len()), (1, 3, 0));
        assert!(found.get("now").is_some() && found.get("first").is_none() && found.get("second").is_none());
        Ok(())
    }

    /// Whatever bit of the store is flipped, a row is what it was or is not known, and then a line is told.
    #[test]
    fn a_bit_flipped_in_a_store_is_told() -> Result<()> {
        use crate::file::PerJoint::{Cracked, Displacement};
        let folder = tempfile::tempdir().map_err(|e| Error::io("", e))?;
        for part in 0..2 {
            let mut store = Store::open(folder.path())?;
            for i in 0..10 {
                let mut row = row(&format!("r{part}{i}"), 0.1 + f64::from(i));
                row.peak_joint = Some("p1c1b1|p1c2b1".into());
                row.joints.insert(Displacement, vec![Some(1e-3 * f64::from(i)), Some(0.25), None]);
                row.joints.insert(Cracked, vec![None; 3]);
                store.append(row)?;
            }
        }
        let intact = Store::open(folder.path())?;
        assert_eq!((intact.len(), intact.faults().len()), (20, 0));
        let parts = parts(&folder.path().join(RUNS))?;
        for n in 0..200 {
            let mut dice = concio::dice::Dice::new(n);
            let part = &parts[dice.below(parts.len())];
            let whole = fs::read(part).map_err(|e| Error::io(part, e))?;
            let (at, bit) = (dice.below(whole.len()), dice.below(8));
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << bit;
            fs::write(part, &bytes).map_err(|e| Error::io(part, e))?;
            let found = Store::open(folder.path())?;
            let line = 1 + whole[..at].iter().filter(|b| **b == b'\n').count();
            let told = found.faults().iter().any(|f| f.path == *part && f.line.is_some_and(|l| l.abs_diff(line) <= 1));
            assert!(told && found.len() < 20, "byte {at}, bit {bit} of {} were not told", part.display());
            assert!(found.rows.iter().all(|(id, row)| intact.get(id) == Some(row)), "byte {at}, bit {bit}");
            fs::write(part, &whole).map_err(|e| Error::io(part, e))?;
        }
        Ok(())
    }

    #[test]
    fn what_two_rows_of_a_run_hold_per_joint_is_known_together() -> Result<()> {
        use crate::file::PerJoint::{Cracked, Displacement};
        let folder = tempfile::tempdir().map_err(|e| Error::io("", e))?;
        let mut store = Store::open(folder.path())?;
        for kind in [Cracked, Displacement] {
            let mut row = row("r", 1.0);
            row.joints.insert(kind, vec![Some(2.0)]);
            store.append(row)?;
            assert!(store.get("r").is_some_and(|r| r.has(&[kind])));
        }
        let again = Store::open(folder.path())?;
        assert!(again.get("r").is_some_and(|r| r.has(&[Cracked, Displacement])));
        Ok(())
    }

    #[test]
    fn two_processes_have_parts_of_their_own_and_the_first_row_wins() -> Result<()> {
        let folder = tempfile::tempdir().map_err(|e| Error::io("", e))?;
        let (mut a, mut b) = (Store::open(folder.path())?, Store::open(folder.path())?);
        a.append(row("same", 1.0))?;
        b.append(row("same", 1.0))?;
        b.append(row("other", 2.0))?;
        assert_eq!(parts(&folder.path().join(RUNS))?.len(), 2);
        let both = Store::open(folder.path())?;
        assert_eq!((both.len(), both.faults().len()), (2, 0));
        Ok(())
    }
}
