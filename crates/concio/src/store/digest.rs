//! Digests of what is read back: whoever reads a result or a summary learns whether it is what was written.
//!
//! A result file ends with a line of text behind all that HDF5 knows of, which its other readers pass over:
//!
//! ```text
//! result.h5 = HDF5 file | "\nBLAKE3 " | 64 hexadecimal digits of all before | "\n"
//! ```
//!
//! A digest beside the file would be lost with the first copy of it, and one inside, as an attribute, would have to leave out
//! its own place. An object in JSON holds that of all its other keys under `digest`.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use serde_json::Value;

use crate::error::{Error, Result};

const LEAD: &[u8] = b"\nBLAKE3 ";
const HEX: usize = 2 * blake3::OUT_LEN;
/// Length of the line [bytes].
const LINE: usize = LEAD.len() + HEX + 1;
/// Key of the digest of an object.
const KEY: &str = "digest";

/// Said of what does not have the digest that it was written with.
pub const CHANGED: &str =
    "its digest is missing or does not match: it was cut off, changed or damaged since it was written";

/// Adds the line to a file that has none.
pub(super) fn append(path: &Path) -> io::Result<()> {
    let mut file = File::options().read(true).append(true).open(path)?;
    let line = line(&of(&mut file)?);
    file.write_all(&line)
}

/// The digest that stands at the end of a result, or none, without a look at what stands before: what it was written as.
///
/// # Errors
/// [`Error::Io`] when it cannot be read.
pub fn noted(path: &Path) -> Result<Option<String>> {
    let io = |e| Error::io(path, e);
    noted_in(&mut File::open(path).map_err(io)?).map_err(io)
}

/// The digest of a result, none where it has no such line.
///
/// # Errors
/// [`Error::Store`] when the file is not what it was when it was written, [`Error::Io`] when it cannot be read.
pub fn check(path: &Path) -> Result<Option<String>> {
    let io = |e| Error::io(path, e);
    if !fs::metadata(path).map_err(io)?.is_file() {
        return Err(Error::Store { path: path.to_path_buf(), what: "it is no file".into() });
    }
    let mut file = File::open(path).map_err(io)?;
    let Some(noted) = noted_in(&mut file).map_err(io)? else { return Ok(None) };
    let before = file.metadata().map_err(io)?.len() - LINE as u64;
    file.seek(SeekFrom::Start(0)).map_err(io)?;
    match of(&mut file.take(before)).map_err(io)? == noted {
        true => Ok(Some(noted)),
        false => Err(Error::Store { path: path.to_path_buf(), what: CHANGED.into() }),
    }
}

fn noted_in(file: &mut File) -> io::Result<Option<String>> {
    let mut end = [0; LINE];
    if file.metadata()?.len() < LINE as u64 {
        return Ok(None);
    }
    file.seek(SeekFrom::End(-(LINE as i64)))?;
    file.read_exact(&mut end)?;
    let digest = std::str::from_utf8(&end[LEAD.len()..LINE - 1]).unwrap_or_default();
    Ok((line(digest) == end && digest.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))).then(|| digest.into()))
}

fn of(bytes: &mut impl Read) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(bytes)?;
    Ok(hasher.finalize().to_hex().to_string())
}

fn line(digest: &str) -> Vec<u8> {
    [LEAD, digest.as_bytes(), b"\n"].concat()
}

/// Gives an object the digest of what it holds, in the place of one that it had.
pub fn seal(object: &mut Value) {
    if let Value::Object(keys) = object {
        keys.remove(KEY);
    }
    let digest = of_value(object);
    if let Value::Object(keys) = object {
        keys.insert(KEY.into(), digest.into());
    }
}

/// An object without its digest; none where it is not what it was when it was sealed. How it is written (blanks, the order of
/// keys) does not matter.
pub fn opened(mut object: Value) -> Option<Value> {
    let Value::Object(keys) = &mut object else { return None };
    let noted = keys.remove(KEY)?;
    (noted.as_str() == Some(&of_value(&object))).then_some(object)
}

/// Keys are in the order of the alphabet.
fn of_value(value: &Value) -> String {
    blake3::hash(value.to_string().as_bytes()).to_hex().to_string()
}
