//! What is known of runs, on disk: `runs/part-NNNN.jsonl` in the folder of a study, one line per run.
//!
//! Every process appends to a part of its own, so that shards share a folder without locks. A line is written at one
//! go; one that a killed process left unfinished is passed over, and its run is done again. The same run may stand in
//! two parts, when shards raced for it: equal inputs give equal rows, and the first is taken. Rows of other measures than
//! today's are not known, so that their runs are done again.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use concio::{Error, Result};

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
    part: Option<Part>,
    /// Lines that were passed over because they were not whole.
    pub torn: usize,
    /// Lines that were passed over because their measures are those of another version.
    pub outdated: usize,
}

/// The file that this process appends to.
#[derive(Debug)]
struct Part {
    path: PathBuf,
    file: File,
    length: u64,
    synced: Instant,
}

impl Store {
    /// The row of a run, if it holds all that is to be kept: `joints`, and with `results` the whole result.
    pub fn holding(&self, id: &str, joints: &[PerJoint], results: bool) -> Option<&Row> {
        let row = self.get(id)?;
        let file = !results || row.end == End::Failed || self.result_path(id).is_file();
        (row.has(joints) && file).then_some(row)
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
        let mut store = Store { folder: folder.to_path_buf(), rows: HashMap::new(), part: None, torn: 0, outdated: 0 };
        for path in parts(&folder.join(RUNS))? {
            let bytes = fs::read(&path).map_err(|e| Error::io(&path, e))?;
            for line in bytes.split(|b| *b == b'\n').filter(|l| !l.is_empty()) {
                match serde_json::from_slice::<Row>(line) {
                    Ok(row) if row.version != VERSION => store.outdated += 1,
                    Ok(row) if row.numbers.is_empty() || row.numbers.len() == MEASURES.len() => store.keep(row),
                    _ => store.torn += 1,
                }
            }
        }
        Ok(store)
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

    /// The first row of a run stays; a later one adds what it holds more per joint, for the numbers of one id are equal.
    fn keep(&mut self, row: Row) {
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
        let line = serde_json::to_string(row);
        let mut line = line.map_err(|e| Error::Store { path: self.path.clone(), what: e.to_string() })?;
        line.push('\n');
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
        if path.extension().is_some_and(|e| e == "jsonl") {
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
            assert!(found.len() == complete || found.len() == complete + 1 && whole[cut] == b'\n', "cut at {cut}");
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
        let unnumbered = now.replace(&told, "").replace("\"now\"", "\"first\"");
        let other = now.replace(&told, &format!("\"version\":{},", VERSION - 1)).replace("\"now\"", "\"second\"");
        fs::write(&part, unnumbered + &other + &now).map_err(|e| Error::io(&part, e))?;
        let found = Store::open(folder.path())?;
        assert_eq!((found.len(), found.outdated, found.torn), (1, 2, 0));
        assert!(found.get("now").is_some() && found.get("first").is_none() && found.get("second").is_none());
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
        assert_eq!((both.len(), both.torn), (2, 0));
        Ok(())
    }
}
