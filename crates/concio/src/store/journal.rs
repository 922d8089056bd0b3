//! The journal of a run that goes on: rows appended to `journal.bin`, the solver's state in `checkpoint.bin`.
//!
//! Both are written so that the process may be killed at any instant. A checkpoint belongs to a length of the journal;
//! resuming cuts the journal to that length and goes on from there. `journal.bin` is a header and blocks:
//!
//! ```text
//! block   = kind (1 byte) | length of payload (8 bytes, little-endian) | payload | digest (32 bytes)
//! digest  = BLAKE3(digest of the block before | kind | length | payload)
//! ```
//!
//! so a digest stands for everything up to it. A checkpoint holds the digest at its length: if the journal was
//! changed, cut short or mixed with another one, the two do not match and the run starts anew.
//! A journal is read by the version that wrote it only; it is no archive format.

use std::fs::{self, File};
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::{Error, Result};
use crate::files::{self, remove_if_there};
use crate::record::{Layout, Recording};

mod lock;
mod rows;

/// First bytes of both files; the last is the version of their format.
const JOURNAL_MAGIC: [u8; 8] = *b"concioJ1";
const CHECKPOINT_MAGIC: [u8; 8] = *b"concioCA";
const HEADER: u8 = b'H';
const ROWS: u8 = b'R';
const STATE: u8 = b'S';

const DIGEST: usize = blake3::OUT_LEN;
/// Kind and length before a payload.
const LEAD: usize = 1 + 8;
/// Length and digest of the journal, before the state in a checkpoint.
const POSITION: usize = 8 + DIGEST;

/// What a journal belongs to. A journal with another header is not resumed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JournalHeader {
    /// Hash of the run's inputs.
    pub inputs_hash: String,
    /// Version of Concio.
    pub version: String,
    /// What the rows hold.
    pub layout: Layout,
}

/// An open journal. Its folder is locked for other runs until it is dropped or removed.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    file: File,
    layout: Layout,
    position: Position,
    /// The block that was written last: its room serves the next one.
    written: Vec<u8>,
    _lock: lock::Lock,
}

/// A place in the journal behind a whole block.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Position {
    length: u64,
    digest: [u8; DIGEST],
}

/// Removes journal and checkpoint from `folder`, if they are there.
///
/// # Errors
/// [`Error::Io`] when a file cannot be removed, [`Error::Store`] when another run is writing to the folder.
pub fn discard(folder: &Path) -> Result<()> {
    if !folder.is_dir() {
        return Ok(());
    }
    let lock = lock::Lock::take(folder)?;
    remove_if_there(&checkpoint_path(folder))?;
    remove_if_there(&journal_path(folder))?;
    lock.remove()
}

impl Journal {
    /// Starts a journal in `folder`, which is made if need be. A journal that was there is lost. `clear` is called when the folder
    /// is this run's and has no journal: what must never stand beside one is to go there.
    ///
    /// # Errors
    /// [`Error::Store`] when another run is writing to the folder, [`Error::Io`] when the disk fails; those of `clear`.
    pub fn create(folder: &Path, header: &JournalHeader, clear: impl FnOnce() -> Result<()>) -> Result<Journal> {
        fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
        let lock = lock::Lock::take(folder)?;
        // The old checkpoint goes first: it must never stand beside rows of this run.
        let path = journal_path(folder);
        remove_if_there(&checkpoint_path(folder))?;
        remove_if_there(&path)?;
        clear()?;
        let mut file = files::make_anew(&path)?;
        file.write_all(&JOURNAL_MAGIC).map_err(|e| Error::io(&path, e))?;
        let position = Position { length: JOURNAL_MAGIC.len() as u64, digest: [0; DIGEST] };
        let layout = header.layout.clone();
        let written = Vec::new();
        let mut journal = Journal { folder: folder.to_path_buf(), file, layout, position, written, _lock: lock };
        let header = header_bytes(folder, header)?;
        journal.append_block(HEADER, |_, payload| {
            payload.extend_from_slice(&header);
            Ok(())
        })?;
        files::sync_folder_of(&path)?;
        Ok(journal)
    }

    /// Opens the journal in `folder` at its last checkpoint and gives back the state kept there.
    /// `None` when there is nothing to resume: no checkpoint, other inputs, another version, or damaged files.
    ///
    /// # Errors
    /// [`Error::Store`] when another run is writing to the folder, [`Error::Io`] when the disk fails.
    pub fn resume(folder: &Path, header: &JournalHeader) -> Result<Option<(Journal, Vec<u8>)>> {
        let path = journal_path(folder);
        if !checkpoint_path(folder).exists() || !path.exists() {
            return Ok(None);
        }
        let lock = lock::Lock::take(folder)?;
        let Some((position, state)) = read_checkpoint(&checkpoint_path(folder))? else { return Ok(None) };
        let Some(file) = files::open_itself(&path)? else { return Ok(None) };
        let layout = header.layout.clone();
        let written = Vec::new();
        let mut journal = Journal { folder: folder.to_path_buf(), file, layout, position, written, _lock: lock };
        if !journal.leads_to_position(&header_bytes(folder, header)?)? {
            return Ok(None);
        }
        journal.file.set_len(position.length).map_err(|e| Error::io(&path, e))?;
        Ok(Some((journal, state)))
    }

    /// Appends the rows of a recording.
    ///
    /// # Errors
    /// [`Error::Store`] when the rows do not fit the layout, [`Error::Io`] when the disk fails or is full; the journal
    /// is then as it was before.
    pub fn append(&mut self, rows: &Recording) -> Result<()> {
        self.append_block(ROWS, |journal, payload| {
            let failed = |what| Error::Store { path: journal_path(&journal.folder), what };
            rows::encode(rows, &journal.layout, payload).map_err(failed)
        })
    }

    /// Keeps the state of the solver: a later [`Journal::resume`] goes on from here. The former state is replaced in
    /// one instant. Everything appended so far is on the disk when this returns.
    ///
    /// # Errors
    /// [`Error::Io`] when the disk fails or is full; the former checkpoint then stays.
    pub fn checkpoint(&mut self, state: &[u8]) -> Result<()> {
        self.file.sync_all().map_err(|e| Error::io(journal_path(&self.folder), e))?;
        let (position, mut made) = (self.position, Vec::with_capacity(LEAD + POSITION + state.len() + DIGEST));
        block(STATE, &[0; DIGEST], &mut made, |payload| {
            payload.extend_from_slice(&position.length.to_le_bytes());
            payload.extend_from_slice(&position.digest);
            payload.extend_from_slice(state);
            Ok(())
        })?;
        let mut bytes = CHECKPOINT_MAGIC.to_vec();
        bytes.extend_from_slice(&made);
        files::replace_bytes(&checkpoint_path(&self.folder), &bytes)
    }

    /// Reads back every row appended so far, block by block.
    ///
    /// # Errors
    /// [`Error::Store`] when the file was damaged meanwhile, [`Error::Io`] when it cannot be read.
    pub fn read_all(&mut self) -> Result<Recording> {
        let path = journal_path(&self.folder);
        let damaged = || Error::Store { path: path.clone(), what: "was damaged while the run went on".into() };
        let mut recording = rows::with_capacity(&self.layout, self.position.length);
        let mut reader = BlockReader::start(&mut self.file, self.position.length, &path)?.ok_or_else(damaged)?;
        while let Some((kind, payload)) = reader.next_block()? {
            if kind == ROWS {
                rows::decode(&payload, &self.layout, &mut recording).ok_or_else(damaged)?;
            }
        }
        if reader.position() == self.position { Ok(recording) } else { Err(damaged()) }
    }

    /// Removes journal, checkpoint and lock: the run is over and its result is on the disk.
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be removed.
    pub fn remove(self) -> Result<()> {
        let Journal { folder, file, _lock: lock, .. } = self;
        drop(file);
        remove_if_there(&checkpoint_path(&folder))?;
        files::remove_leftovers(&checkpoint_path(&folder))?;
        remove_if_there(&journal_path(&folder))?;
        lock.remove()
    }

    /// Appends a block whose payload `fill` adds to what it is given.
    fn append_block(&mut self, kind: u8, fill: impl FnOnce(&Self, &mut Vec<u8>) -> Result<()>) -> Result<()> {
        let mut bytes = std::mem::take(&mut self.written);
        let made = block(kind, &self.position.digest, &mut bytes, |payload| fill(self, payload));
        let written = made.and_then(|digest| self.write(&bytes, digest));
        self.written = bytes;
        written
    }

    fn write(&mut self, bytes: &[u8], digest: [u8; DIGEST]) -> Result<()> {
        // A failed attempt may have left half a block: every block goes to where the last whole one ends.
        let at = self.position.length;
        let written = self.file.seek(SeekFrom::Start(at)).and_then(|_| self.file.write_all(bytes));
        written.map_err(|e| {
            let _ = self.file.set_len(at);
            Error::io(journal_path(&self.folder), e)
        })?;
        self.position = Position { length: at + bytes.len() as u64, digest };
        Ok(())
    }

    /// Whether the file begins with this header and arrives at `self.position` with every digest right.
    fn leads_to_position(&mut self, header: &[u8]) -> Result<bool> {
        let path = journal_path(&self.folder);
        let Some(mut reader) = BlockReader::start(&mut self.file, self.position.length, &path)? else {
            return Ok(false);
        };
        match reader.next_block()? {
            Some((HEADER, found)) if found == header => {}
            _ => return Ok(false),
        }
        let mut unused = Recording::default();
        while let Some((kind, payload)) = reader.next_block()? {
            unused.clear();
            if kind != ROWS || rows::decode(&payload, &self.layout, &mut unused).is_none() {
                return Ok(false);
            }
        }
        Ok(reader.position() == self.position)
    }
}

/// Reads blocks up to a length; stops at the first that is not whole.
struct BlockReader<'a> {
    reader: BufReader<&'a mut File>,
    path: &'a Path,
    position: Position,
    end: u64,
}

impl<'a> BlockReader<'a> {
    /// `None` when the file is shorter than `end` or no journal.
    fn start(file: &'a mut File, end: u64, path: &'a Path) -> Result<Option<BlockReader<'a>>> {
        let failed = |e| Error::io(path, e);
        if file.metadata().map_err(failed)?.len() < end {
            return Ok(None);
        }
        file.seek(SeekFrom::Start(0)).map_err(failed)?;
        let mut reader = BufReader::new(file);
        let mut magic = [0; JOURNAL_MAGIC.len()];
        let whole = read_whole(&mut reader, &mut magic).map_err(failed)?;
        let position = Position { length: magic.len() as u64, digest: [0; DIGEST] };
        Ok((whole && magic == JOURNAL_MAGIC).then_some(BlockReader { reader, path, position, end }))
    }

    fn position(&self) -> Position {
        self.position
    }

    fn next_block(&mut self) -> Result<Option<(u8, Vec<u8>)>> {
        self.read_block().map_err(|e| Error::io(self.path, e))
    }

    fn read_block(&mut self) -> std::io::Result<Option<(u8, Vec<u8>)>> {
        let left = self.end.saturating_sub(self.position.length);
        let mut lead = [0; LEAD];
        if left < (LEAD + DIGEST) as u64 || !read_whole(&mut self.reader, &mut lead)? {
            return Ok(None);
        }
        let Some((kind, length)) = parse_lead(&lead, left) else { return Ok(None) };
        let mut payload = vec![0; length];
        let mut digest = [0; DIGEST];
        if !read_whole(&mut self.reader, &mut payload)? || !read_whole(&mut self.reader, &mut digest)? {
            return Ok(None);
        }
        if digest != chained(&self.position.digest, &lead, &payload) {
            return Ok(None);
        }
        let length = self.position.length + (LEAD + length + DIGEST) as u64;
        self.position = Position { length, digest };
        Ok(Some((kind, payload)))
    }
}

/// Kind and length of payload of a block of which `left` bytes may be there.
fn parse_lead(lead: &[u8; LEAD], left: u64) -> Option<(u8, usize)> {
    let [kind, length @ ..] = *lead;
    let length = u64::from_le_bytes(length);
    (length <= left.checked_sub((LEAD + DIGEST) as u64)?).then_some((kind, usize::try_from(length).ok()?))
}

/// Makes a block of the payload that `fill` adds to what it is given; returns its digest.
fn block(
    kind: u8,
    before: &[u8; DIGEST],
    bytes: &mut Vec<u8>,
    fill: impl FnOnce(&mut Vec<u8>) -> Result<()>,
) -> Result<[u8; DIGEST]> {
    let mut lead = [kind; LEAD];
    bytes.clear();
    bytes.extend_from_slice(&lead);
    fill(bytes)?;
    lead[1..].copy_from_slice(&((bytes.len() - LEAD) as u64).to_le_bytes());
    bytes[..LEAD].copy_from_slice(&lead);
    let digest = chained(before, &lead, &bytes[LEAD..]);
    bytes.extend_from_slice(&digest);
    Ok(digest)
}

fn chained(before: &[u8; DIGEST], lead: &[u8; LEAD], payload: &[u8]) -> [u8; DIGEST] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(before).update(lead).update(payload);
    *hasher.finalize().as_bytes()
}

/// Position and state of a checkpoint; `None` when the file is not a whole one.
fn read_checkpoint(path: &Path) -> Result<Option<(Position, Vec<u8>)>> {
    let Some(mut file) = files::open_itself(path)? else { return Ok(None) };
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(|e| Error::io(path, e))?;
    Ok(parse_checkpoint(&bytes))
}

fn parse_checkpoint(bytes: &[u8]) -> Option<(Position, Vec<u8>)> {
    let bytes = bytes.strip_prefix(&CHECKPOINT_MAGIC)?;
    let (lead, rest) = bytes.split_first_chunk::<LEAD>()?;
    let (kind, length) = parse_lead(lead, bytes.len() as u64)?;
    let (payload, digest) = rest.split_at_checked(length)?;
    if kind != STATE || digest != chained(&[0; DIGEST], lead, payload) {
        return None;
    }
    let (length, payload) = payload.split_first_chunk::<8>()?;
    let (digest, state) = payload.split_first_chunk::<DIGEST>()?;
    Some((Position { length: u64::from_le_bytes(*length), digest: *digest }, state.to_vec()))
}

/// Fills the buffer; `false` when the file ends before.
fn read_whole(reader: &mut impl Read, buffer: &mut [u8]) -> std::io::Result<bool> {
    match reader.read_exact(buffer) {
        Ok(()) => Ok(true),
        Err(e) if e.kind() == ErrorKind::UnexpectedEof => Ok(false),
        Err(e) => Err(e),
    }
}

fn header_bytes(folder: &Path, header: &JournalHeader) -> Result<Vec<u8>> {
    let failed = |e: serde_json::Error| Error::Store { path: journal_path(folder), what: e.to_string() };
    serde_json::to_vec(header).map_err(failed)
}

fn journal_path(folder: &Path) -> PathBuf {
    folder.join("journal.bin")
}

fn checkpoint_path(folder: &Path) -> PathBuf {
    folder.join("checkpoint.bin")
}
