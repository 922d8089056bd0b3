//! Accelerograms that several runs share: each is read or made once, whatever its scale.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::Result;
use crate::case::{RecordInput, Synthetic};
use crate::files::{LARGEST_INPUT, Unread, read_input};
use crate::ground::formats::{parse, unread};
use crate::ground::process::Peaks;
use crate::ground::record::{Record, TextOptions};
use crate::ground::{channel, process, synthetic};
use crate::quantity::Acceleration;

/// Samples that are kept at most, 8 bytes each; what comes later is made anew for every run.
const MOST_SAMPLES: usize = 50_000_000;

/// What has been read and made, by what it was asked for. Threads may share it: while one makes a record, those that want
/// the same one wait for it.
#[derive(Debug, Default)]
pub struct Library {
    shelves: Mutex<Shelves>,
    /// Contents that stand for those of files.
    given: HashMap<PathBuf, Vec<u8>>,
}

#[derive(Debug, Default)]
struct Shelves {
    places: HashMap<Key, Arc<Mutex<Option<Arc<Shelved>>>>>,
    samples: usize,
}

/// What makes a record what it is, but for its scale, in words that keep every digit.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Key {
    Record(PathBuf, String),
    Synthetic(String),
}

#[derive(Debug)]
struct Shelved {
    /// Before it is scaled.
    record: Record,
    /// The names of the components in its file, and the place of this one among them, from 0.
    channels: Vec<String>,
    place: usize,
    peaks: Peaks,
}

/// What a file holds beside the component that is taken of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Its number, from 1.
    pub number: usize,
    /// The names of all components in the file; empty where it names none.
    pub names: Vec<String>,
}

/// Reads the channel of the file that `input` names, relative to `folder`, and prepares it.
///
/// # Errors
/// [`crate::Error::Input`] as [`crate::ground::formats::read`] and [`process::prepare`], and when the file has no such channel.
pub fn load(input: &RecordInput, folder: &Path) -> Result<Record> {
    Library::default().record(input, folder)
}

impl Library {
    /// With these contents in place of files: whoever has them needs no file of that path.
    pub fn holding(files: HashMap<PathBuf, Vec<u8>>) -> Self {
        Library { shelves: Mutex::default(), given: files }
    }

    /// The content of a record file.
    ///
    /// # Errors
    /// As [`read_input`].
    pub fn bytes(&self, path: &Path) -> std::result::Result<Cow<'_, [u8]>, Unread> {
        match self.given.get(path) {
            Some(bytes) => Ok(Cow::Borrowed(bytes)),
            None => read_input(path, LARGEST_INPUT).map(Cow::Owned),
        }
    }

    /// The channel that `input` names, prepared ([`process::prepare`]); its path is relative to `folder`.
    ///
    /// # Errors
    /// [`crate::Error::Input`] when the file cannot be read, has no such channel, or a number of `input` does not suit it.
    pub fn record(&self, input: &RecordInput, folder: &Path) -> Result<Record> {
        let mut record = self.of_file(input, folder)?.record.clone();
        process::size(&mut record, input).map_err(|e| in_file(e, &folder.join(&input.record)))?;
        Ok(record)
    }

    /// Which component of its file `input` takes.
    ///
    /// # Errors
    /// As [`Library::record`].
    pub fn component(&self, input: &RecordInput, folder: &Path) -> Result<Component> {
        let shelved = self.of_file(input, folder)?;
        Ok(Component { number: shelved.place + 1, names: shelved.channels.clone() })
    }

    /// Largest accelerations of the record of `input` from its file until it is prepared but for its scale.
    ///
    /// # Errors
    /// As [`Library::record`].
    pub fn peaks(&self, input: &RecordInput, folder: &Path) -> Result<Peaks> {
        Ok(self.of_file(input, folder)?.peaks)
    }

    /// The accelerogram of `input` ([`synthetic::generate`]).
    ///
    /// # Errors
    /// [`crate::Error::Input`] when a number is out of its range.
    pub fn synthetic(&self, input: &Synthetic) -> Result<Record> {
        synthetic::check(input)?;
        // A shape fits every PGA: spectrum and motion are proportional to it.
        let shape = Synthetic { pga: Acceleration::from_si(1.0), ..*input };
        let key = Key::Synthetic(format!("{shape:?}"));
        let shelved = self.shelved(key, || {
            let record = synthetic::generate(&shape)?;
            Ok(Shelved { record, channels: Vec::new(), place: 0, peaks: Peaks::default() })
        })?;
        let mut record = shelved.record.clone();
        record.acceleration.iter_mut().for_each(|a| *a *= input.pga.si());
        Ok(record)
    }

    fn of_file(&self, input: &RecordInput, folder: &Path) -> Result<Arc<Shelved>> {
        let path = folder.join(&input.record);
        let plain = RecordInput { scale: None, pga: None, ..input.clone() };
        let key = Key::Record(path.clone(), format!("{plain:?}"));
        self.shelved(key, || {
            let bytes = self.bytes(&path).map_err(|reason| unread(&path, reason))?;
            let mut records = parse(&bytes, &path, &TextOptions::from(input))?;
            // The file is in order: what is wrong is the key of the wall file.
            let place = channel::choose(&records, input.channel.as_ref()).map_err(|mut error| {
                error.what = error.what.replace("the file", &path.display().to_string());
                error
            })?;
            let channels = records.iter().map(|record| record.channel.clone()).collect();
            let mut record = records.swap_remove(place);
            let peaks = process::correct(&mut record, input).map_err(|e| in_file(e, &path))?;
            Ok(Shelved { record, channels, place, peaks })
        })
    }

    /// What stands under `key`, made first where nothing does. What could not be made is tried again.
    fn shelved(&self, key: Key, make: impl FnOnce() -> Result<Shelved>) -> Result<Arc<Shelved>> {
        let place = Arc::clone(locked(&self.shelves).places.entry(key).or_default());
        let mut place = locked(&place);
        if let Some(known) = &*place {
            return Ok(Arc::clone(known));
        }
        let made = Arc::new(make()?);
        let mut shelves = locked(&self.shelves);
        if shelves.samples + made.record.npts() <= MOST_SAMPLES {
            shelves.samples += made.record.npts();
            *place = Some(Arc::clone(&made));
        }
        Ok(made)
    }
}

/// A thread that panicked left nothing half done: places are filled whole or not at all.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn in_file(error: crate::Error, path: &Path) -> crate::Error {
    match error {
        crate::Error::Input(input) => input.in_file(path).into(),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Time;

    fn input(pga: f64, seed: u64) -> Synthetic {
        Synthetic {
            seed,
            pga: Acceleration::from_si(pga),
            duration: Time::from_si(5.0),
            dt: Time::from_si(0.01),
            corners: [0.15, 0.5, 2.0].map(Time::from_si),
        }
    }

    fn made(library: &Library) -> usize {
        locked(&library.shelves).places.len()
    }

    #[test]
    fn an_accelerogram_is_made_once_for_all_scales_and_is_that_of_a_single_run() -> Result<()> {
        let library = Library::default();
        for pga in [0.3, 2.0, 3.0] {
            let shared = library.synthetic(&input(pga, 4))?;
            assert_eq!(shared, synthetic::generate(&input(pga, 4))?);
            assert!((shared.acceleration.iter().fold(0.0, |m: f64, a| m.max(a.abs())) / pga - 1.0).abs() < 1e-15);
        }
        assert_eq!(made(&library), 1);
        assert_ne!(library.synthetic(&input(2.0, 5))?.acceleration, library.synthetic(&input(2.0, 4))?.acceleration);
        assert_eq!(made(&library), 2);
        assert!(library.synthetic(&input(-2.0, 4)).is_err_and(|e| e.to_string().contains("synthetic.pga")));
        Ok(())
    }

    #[test]
    fn a_file_is_read_once_for_all_scales() -> Result<()> {
        let folder = tempfile::tempdir().map_err(|e| crate::Error::io(Path::new("temporary"), e))?;
        let path = folder.path().join("motion.csv");
        let write = |text: &str| std::fs::write(&path, text).map_err(|e| crate::Error::io(&path, e));
        write("t [s],a [m/s2]\n0,0\n0.01,1\n0.02,-2\n0.03,0.5\n")?;
        let text = |extra: &str| format!("{{\"record\": \"motion.csv\"{extra}}}");
        let read = |extra: &str| serde_json::from_str::<RecordInput>(&text(extra)).expect("this is an input");
        let library = Library::default();
        let plain = library.record(&read(""), folder.path())?;
        write("nothing")?;
        let scaled = library.record(&read(", \"scale\": -3"), folder.path())?;
        assert_eq!(scaled.acceleration, plain.acceleration.iter().map(|a| -3.0 * a).collect::<Vec<_>>());
        let component = Component { number: 1, names: vec!["a".into()] };
        assert_eq!(library.component(&read(""), folder.path())?, component);
        // What differs by more than a scale is another record, and this file has none.
        assert!(library.record(&read(", \"reverse\": true"), folder.path()).is_err());
        Ok(())
    }
}
