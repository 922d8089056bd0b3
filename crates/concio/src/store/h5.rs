//! HDF5 with the errors, units and checks that the store needs, over `rust-hdf5` (no C library, no CMake).

use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use rust_hdf5::{DatatypeMessage, H5Dataset, H5File, H5Group, H5Type, Hdf5Error, VarLenUnicode};

use crate::error::{Error, Result};

/// Level 1 of 9: results are nearly incompressible digits, on which higher levels take four times as long for a few
/// per cent (frames of a shaken wall: 75 ms and 12 MB at level 1, 285 ms and 11 MB at level 4).
const DEFLATE_LEVEL: u32 = 1;

/// Bytes of a chunk before compression: readers take one in whole, so it must neither be tiny nor fill memory.
const CHUNK_BYTES: usize = 1 << 20;

/// Arrays below this many bytes are stored as they are.
const SMALL: usize = 4096;

/// Deflate never shrinks below 1/1032, so a file whose arrays claim more than that is broken.
const LARGEST_RATIO: u64 = 1100;

/// Unit and meaning of a dataset, stored with it as attributes.
#[derive(Clone, Copy)]
pub(super) struct Label<'a> {
    pub unit: &'a str,
    pub description: &'a str,
}

/// A [`Label`].
pub(super) fn label<'a>(unit: &'a str, description: &'a str) -> Label<'a> {
    Label { unit, description }
}

/// A file being written.
pub(super) struct Sink {
    file: H5File,
    groups: BTreeSet<String>,
    path: PathBuf,
}

impl Sink {
    /// Creates `temporary`; errors name `path`, the file the user knows of.
    pub fn create(temporary: &Path, path: &Path) -> Result<Sink> {
        // The temporary file is nobody else's, and some network file systems know no locks.
        let file = H5File::options().no_locking().create(temporary).map_err(|e| failure(path, "", e))?;
        Ok(Sink { file, groups: BTreeSet::new(), path: path.to_path_buf() })
    }

    /// Finishes the file; syncing it is the caller's.
    pub fn close(self) -> Result<()> {
        let Sink { file, path, .. } = self;
        file.close_no_sync().map_err(|e| failure(&path, "", e))
    }

    /// A real-valued or integer array in row-major order.
    pub fn array<T: H5Type>(&mut self, name: &str, shape: &[usize], data: &[T], label: Label) -> Result<()> {
        let dataset = self.dataset::<T>(name, shape, &chunk_of::<T>(shape))?;
        // The library keeps no place for an array without elements, and refuses to write to it.
        if !data.is_empty() {
            dataset.write_raw(data).map_err(|e| self.failure(name, e))?;
        }
        self.label(name, &dataset, label)
    }

    /// A list of numbers.
    pub fn list<T: H5Type>(&mut self, name: &str, data: &[T], label: Label) -> Result<()> {
        self.array(name, &[data.len()], data, label)
    }

    /// One number.
    pub fn number<T: H5Type>(&mut self, name: &str, value: T, label: Label) -> Result<()> {
        self.array(name, &[], &[value], label)
    }

    /// An array made frame by frame: `fill(i, lines)` fills the `per_frame` lines of frame i, which come as zeros.
    /// Chunks hold whole frames, and no more than one chunk is in memory.
    pub fn frames<T: H5Type + Default>(
        &mut self,
        name: &str,
        [frames, per_frame, width]: [usize; 3],
        label: Label,
        mut fill: impl FnMut(usize, &mut [T]),
    ) -> Result<()> {
        let length = per_frame * width;
        let together = (CHUNK_BYTES / (length * T::element_size()).max(1)).clamp(1, frames.max(1));
        let empty = frames * length == 0;
        let chunk = if empty { Vec::new() } else { vec![together * per_frame, width] };
        let dataset = self.dataset::<T>(name, &[frames * per_frame, width], &chunk)?;
        for first in (0..if empty { 0 } else { frames }).step_by(together) {
            let count = together.min(frames - first);
            let mut lines = vec![T::default(); count * length];
            lines.chunks_exact_mut(length).enumerate().for_each(|(k, frame)| fill(first + k, frame));
            let (start, extent) = ([first * per_frame, 0], [count * per_frame, width]);
            dataset.write_slice(&start, &extent, &lines).map_err(|e| self.failure(name, e))?;
        }
        self.label(name, &dataset, label)
    }

    /// A list of texts (variable-length UTF-8).
    pub fn texts<S: AsRef<str>>(&mut self, name: &str, texts: &[S], description: &str) -> Result<()> {
        let (group, leaf) = self.group_of(name)?;
        let texts: Vec<&str> = texts.iter().map(S::as_ref).collect();
        let dataset = group.write_vlen_strings(leaf, &texts).map_err(|e| self.failure(name, e))?;
        text_attribute(&dataset, "description", description).map_err(|e| self.failure(name, e))
    }

    /// A text attribute of a group; `/` is the file itself.
    pub fn attribute(&mut self, group: &str, name: &str, value: &str) -> Result<()> {
        let result = self.group(group)?.set_attr_string(name, value);
        result.map_err(|e| self.failure(name, e))
    }

    /// A text attribute of fixed length in ASCII, which is what VTK asks of `Type`.
    pub fn ascii_attribute(&mut self, group: &str, name: &str, value: &str) -> Result<()> {
        let kind = DatatypeMessage::FixedString { size: value.len() as u32, padding: 1, charset: 0 };
        let result = self.group(group)?.set_attr_typed(name, kind, value.as_bytes().to_vec());
        result.map_err(|e| self.failure(name, e))
    }

    /// A number as an attribute of a group.
    pub fn number_attribute<T: H5Type>(&mut self, group: &str, name: &str, value: T) -> Result<()> {
        let result = self.group(group)?.set_attr_numeric(name, &value);
        result.map_err(|e| self.failure(name, e))
    }

    /// Numbers as an attribute of a group.
    pub fn list_attribute<T: H5Type>(&mut self, group: &str, name: &str, values: &[T]) -> Result<()> {
        let result = self.group(group)?.set_attr_array_numeric(name, values);
        result.map_err(|e| self.failure(name, e))
    }

    fn dataset<T: H5Type>(&mut self, name: &str, shape: &[usize], chunk: &[usize]) -> Result<H5Dataset> {
        let (group, leaf) = self.group_of(name)?;
        let mut builder = group.new_dataset::<T>().shape(shape);
        if !chunk.is_empty() {
            builder = builder.chunk(chunk).shuffle_deflate(DEFLATE_LEVEL);
        }
        builder.create(leaf).map_err(|e| self.failure(name, e))
    }

    fn label(&self, name: &str, dataset: &H5Dataset, label: Label) -> Result<()> {
        text_attribute(dataset, "unit", label.unit)
            .and_then(|()| text_attribute(dataset, "description", label.description))
            .map_err(|e| self.failure(name, e))
    }

    fn group_of<'n>(&mut self, name: &'n str) -> Result<(H5Group, &'n str)> {
        let (parent, leaf) = name.rsplit_once('/').unwrap_or(("/", name));
        Ok((self.group(parent)?, leaf))
    }

    /// The group of that path, made with its parents when it is not there yet.
    fn group(&mut self, path: &str) -> Result<H5Group> {
        let root = self.file.root_group();
        if path == "/" {
            return Ok(root);
        }
        if self.groups.contains(path) {
            return root.group(path).map_err(|e| self.failure(path, e));
        }
        let (parent, leaf) = path.rsplit_once('/').unwrap_or(("/", path));
        let made = self.group(parent)?.create_group(leaf).map_err(|e| self.failure(path, e))?;
        self.groups.insert(path.to_string());
        Ok(made)
    }

    fn failure(&self, name: &str, error: Hdf5Error) -> Error {
        failure(&self.path, name, error)
    }
}

/// A file being read. Whatever is not as expected is an [`Error::Store`].
pub(super) struct Source {
    file: H5File,
    path: PathBuf,
    bytes: u64,
}

impl Source {
    /// Opens a file.
    pub fn open(path: &Path) -> Result<Source> {
        let bytes = fs::metadata(path).map_err(|e| Error::io(path, e))?.len();
        // A result never changes once it has its name, so reading takes no lock.
        let file = H5File::options().no_locking().open(path).map_err(|e| broken(path, "", e))?;
        Ok(Source { file, path: path.to_path_buf(), bytes })
    }

    /// A text attribute of the file.
    pub fn attribute(&self, name: &str) -> Result<String> {
        self.file.attr_string(name).map_err(|e| broken(&self.path, name, e))
    }

    /// An array; its shape must be `shape`, in which `None` allows any extent.
    pub fn array<T: H5Type>(&self, name: &str, shape: &[Option<usize>]) -> Result<Vec<T>> {
        let dataset = self.dataset(name)?;
        let kind = dataset.datatype().map_err(|e| broken(&self.path, name, e))?;
        if kind != T::hdf5_type() {
            return Err(self.wrong(name, format!("holds {kind} where {} is expected", T::hdf5_type())));
        }
        self.check_shape(name, &dataset, shape)?;
        let data = dataset.read_raw::<T>().map_err(|e| broken(&self.path, name, e))?;
        if data.len() != dataset.shape().iter().product::<usize>() {
            return Err(self.wrong(name, "holds fewer values than its shape says".into()));
        }
        Ok(data)
    }

    /// A list of numbers.
    pub fn list<T: H5Type>(&self, name: &str, length: usize) -> Result<Vec<T>> {
        self.array(name, &[Some(length)])
    }

    /// Whether there is such a dataset.
    pub fn has(&self, name: &str) -> bool {
        self.file.dataset(name).is_ok()
    }

    /// One number.
    pub fn number<T: H5Type>(&self, name: &str) -> Result<T> {
        self.array(name, &[])?.first().copied().ok_or_else(|| self.wrong(name, "is empty".into()))
    }

    /// A list of texts of any length.
    pub fn texts(&self, name: &str) -> Result<Vec<String>> {
        let dataset = self.dataset(name)?;
        self.check_shape(name, &dataset, &[None])?;
        dataset.read_strings().map_err(|e| broken(&self.path, name, e))
    }

    /// An attribute of a dataset.
    pub fn label(&self, name: &str, attribute: &str) -> Result<String> {
        let text = self.dataset(name)?.attr(attribute).and_then(|a| a.read_string());
        text.map_err(|e| broken(&self.path, name, e))
    }

    /// Says what is wrong with a dataset.
    pub fn wrong(&self, name: &str, what: String) -> Error {
        Error::Store { path: self.path.clone(), what: format!("`{name}` {what}") }
    }

    fn dataset(&self, name: &str) -> Result<H5Dataset> {
        self.file.dataset(name).map_err(|e| broken(&self.path, name, e))
    }

    /// A broken file may claim any extent: allocating it would end the program.
    fn check_shape(&self, name: &str, dataset: &H5Dataset, shape: &[Option<usize>]) -> Result<()> {
        let found = dataset.shape();
        let fits = found.len() == shape.len() && found.iter().zip(shape).all(|(&n, m)| m.is_none_or(|m| m == n));
        if !fits {
            let expected: Vec<String> = shape.iter().map(|n| n.map_or("any".into(), |n| n.to_string())).collect();
            return Err(self.wrong(name, format!("has shape {found:?}, expected [{}]", expected.join(", "))));
        }
        let claimed = found.iter().try_fold(dataset.element_size().max(1) as u64, |n, &m| n.checked_mul(m as u64));
        if claimed.is_none_or(|n| n / LARGEST_RATIO > self.bytes) {
            return Err(self.wrong(name, format!("claims shape {found:?} in a file of {} bytes", self.bytes)));
        }
        Ok(())
    }
}

/// Chunk of an array: whole rows of about [`CHUNK_BYTES`]; empty for contiguous storage.
fn chunk_of<T: H5Type>(shape: &[usize]) -> Vec<usize> {
    let elements: usize = shape.iter().product();
    let Some((&lines, rest)) = shape.split_first() else { return Vec::new() };
    if elements * T::element_size() < SMALL {
        return Vec::new();
    }
    let line: usize = rest.iter().product::<usize>() * T::element_size();
    let mut chunk = vec![(CHUNK_BYTES / line.max(1)).clamp(1, lines)];
    chunk.extend_from_slice(rest);
    chunk
}

fn text_attribute(dataset: &H5Dataset, name: &str, value: &str) -> std::result::Result<(), Hdf5Error> {
    dataset.new_attr::<VarLenUnicode>().shape(()).create(name)?.write_string(value)
}

fn failure(path: &Path, name: &str, error: Hdf5Error) -> Error {
    match error {
        Hdf5Error::Io(source) => Error::io(path, source),
        other => broken(path, name, other),
    }
}

/// While reading, an end of file before its time is a fault of the file, not of the system.
fn broken(path: &Path, name: &str, error: Hdf5Error) -> Error {
    match error {
        Hdf5Error::Io(source) if source.kind() != ErrorKind::UnexpectedEof => Error::io(path, source),
        other if name.is_empty() => Error::Store { path: path.to_path_buf(), what: other.to_string() },
        other => Error::Store { path: path.to_path_buf(), what: format!("`{name}`: {other}") },
    }
}
