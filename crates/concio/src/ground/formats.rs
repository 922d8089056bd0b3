//! Reading of accelerograms. The format is found from the content of the file; its name says nothing.

use std::borrow::Cow;
use std::path::Path;

use crate::case::HistoryQuantity;
use crate::files::{LARGEST_INPUT, Unread, read_input};
use crate::ground::record::{Format, Record, TextOptions, all_formats};
use crate::ground::source::{MOST_SAMPLES, Source, line_end};
use crate::ground::{
    cosmos, csmip_v2, cwb, geonet, itaca_asc, knet, knet_csv, nsmn, peer_at2, resemblance, text, unam_asa, units,
    usgs_smc, volume_1,
};
use crate::{Error, InputError, Result};

impl Format {
    fn is_of(self, source: &Source) -> bool {
        match self {
            Format::PeerAt2 => peer_at2::is_format(source),
            Format::ItacaAsc => itaca_asc::is_format(source),
            Format::Cosmos => cosmos::is_format(source),
            Format::CsmipV2 => csmip_v2::is_format(source),
            Format::UsgsSmc => usgs_smc::is_format(source),
            Format::Knet => knet::is_format(source),
            Format::KnetCsv => knet_csv::is_format(source),
            Format::Geonet => geonet::is_format(source),
            Format::Nsmn => nsmn::is_format(source),
            Format::UnamAsa => unam_asa::is_format(source),
            Format::Cwb => cwb::is_format(source),
            Format::Volume1 => volume_1::is_format(source),
            Format::Text | Format::Synthetic => false,
        }
    }

    fn read(self, source: &Source, options: &TextOptions) -> Result<Vec<Record>> {
        let one = |record: Result<Record>| record.map(|record| vec![record]);
        match self {
            Format::PeerAt2 => one(peer_at2::read(source)),
            Format::ItacaAsc => one(itaca_asc::read(source)),
            Format::Cosmos => cosmos::read(source),
            Format::CsmipV2 => csmip_v2::read(source),
            Format::UsgsSmc => one(usgs_smc::read(source)),
            Format::Knet => one(knet::read(source)),
            Format::KnetCsv => knet_csv::read(source),
            Format::Geonet => geonet::read(source),
            Format::Nsmn => nsmn::read(source),
            Format::UnamAsa => unam_asa::read(source),
            Format::Cwb => cwb::read(source),
            Format::Volume1 => volume_1::read(source),
            Format::Text | Format::Synthetic => text::read(source, options),
        }
    }
}

/// Reads all channels of a file.
///
/// # Errors
/// [`crate::Error::Input`] when the file cannot be read or is not a record; it names file, line and cause.
pub fn read(path: &Path, options: &TextOptions) -> Result<Vec<Record>> {
    let bytes = read_input(path, LARGEST_INPUT).map_err(|reason| unread(path, reason))?;
    parse(&bytes, path, options)
}

/// Said of a file that the system does not give.
pub(crate) fn unread(path: &Path, reason: Unread) -> InputError {
    InputError::new(format!("the record cannot be read: {reason}"))
        .in_file(path)
        .help("a path in a wall file is relative to that file")
}

/// Reads all channels of a file in memory; `path` is named in errors only.
///
/// # Errors
/// [`crate::Error::Input`] when the content is not a record; it names file, line and cause, and the format where the file has one.
pub fn parse(bytes: &[u8], path: &Path, options: &TextOptions) -> Result<Vec<Record>> {
    let text = decode(bytes, path)?;
    let lines = text.matches(line_end(&text)).count();
    if lines > MOST_SAMPLES {
        let error = InputError::new(format!("the file has {lines} lines")).in_file(path);
        return Err(error.allowed(format!("up to {MOST_SAMPLES} samples, as many as a run keeps")).into());
    }
    let source = Source::new(path, &text);
    let Some(format) = Format::KNOWN.into_iter().find(|format| format.is_of(&source)) else {
        return of_text(&source, options);
    };
    let records = format.read(&source, options).map_err(|error| read_as(error, format))?;
    if records.is_empty() {
        return Err(read_as(source.error_at(0, "the file holds no component").into(), format));
    }
    for record in &records {
        agree(&source, record, options)?;
    }
    Ok(records)
}

/// A file with no marks of a format.
fn of_text(source: &Source, options: &TextOptions) -> Result<Vec<Record>> {
    if source
        .lines
        .iter()
        .find(|line| !line.trim().is_empty())
        .is_some_and(|line| line.trim_start().starts_with(['{', '<']))
    {
        let error = source.error("the file is JSON or a page of markup, none of the formats that are read");
        return Err(error.allowed(all_formats()).into());
    }
    if let Some(line) = source.behind_mark {
        let error = source.error_at(line, "the file goes on behind the byte 0x1A, which ends files of DOS");
        return Err(error.help("take that byte out, or what stands behind it").into());
    }
    text::read(source, options).map_err(|error| resemblance::told(source, error))
}

/// Says of a damaged file what it was read as; every such error has a line.
fn read_as(error: Error, format: Format) -> Error {
    let Error::Input(mut error) = error else { return error };
    error.what = format!("{} (read as {})", error.what, format.name());
    error.line.get_or_insert(1);
    Error::Input(error)
}

/// These formats name unit, quantity and interval themselves. What the input says beside that must not contradict it:
/// to follow either in silence would give wrong numbers.
fn agree(source: &Source, record: &Record, options: &TextOptions) -> Result<()> {
    let differ = |key: &str, found: String, given: String| {
        let error = source.error(format!("the file says {found}, the input {given}")).key(key);
        Err(error.allowed("what the file says, or nothing").into())
    };
    let found = match record.displacement {
        Some(_) => HistoryQuantity::Displacement,
        None => HistoryQuantity::Acceleration,
    };
    if options.quantity != HistoryQuantity::Acceleration && options.quantity != found {
        return differ("quantity", "acceleration".into(), "displacement".into());
    }
    if let Some(given) = &options.units {
        let factor = |unit: &str| units::factor(unit, found);
        // The names of units in headers are free text; one that is not known cannot be compared.
        if factor(given).is_none() || (factor(&record.units).is_some() && factor(given) != factor(&record.units)) {
            return differ("units", format!("`{}`", record.units), format!("`{given}`"));
        }
    }
    match options.dt {
        Some(given) if (given - record.dt).abs() > 1e-6 * record.dt => {
            differ("dt", format!("{} s", record.dt), format!("{given} s"))
        }
        _ => Ok(()),
    }
}

/// Bytes as text. What is no UTF-8 is taken as Latin-1, in which spreadsheets write `m/s²`; what that does not print becomes a replacement
/// character, which no field minds.
fn decode<'a>(bytes: &'a [u8], path: &Path) -> Result<Cow<'a, str>> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let error = InputError::new("the file is UTF-16").in_file(path);
        return Err(error.allowed("UTF-8 or ASCII").help("save it as plain text").into());
    }
    if let Some(kind) = binary(bytes) {
        let error = InputError::new(format!("the file is {kind}, not text")).in_file(path);
        return Err(error.allowed("text").help("save it as CSV or text").into());
    }
    let bytes = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
    if let Ok(text) = std::str::from_utf8(bytes) {
        return Ok(Cow::Borrowed(text));
    }
    let latin = |byte: &u8| if *byte < 0xa0 { char::REPLACEMENT_CHARACTER } else { char::from(*byte) };
    let mut text = String::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(latin));
    }
    Ok(Cow::Owned(text))
}

/// What a file that is not text is, from its first bytes.
fn binary(bytes: &[u8]) -> Option<&'static str> {
    const KINDS: [(&[u8], &str); 7] = [
        (b"PK\x03\x04", "a spreadsheet or a zip archive"),
        (b"\xd0\xcf\x11\xe0", "a spreadsheet or document of old"),
        (b"\x89PNG", "a picture"),
        (b"\xff\xd8\xff", "a picture"),
        (b"%PDF", "a PDF document"),
        (b"\x1f\x8b", "a gzip archive"),
        (b"\x89HDF", "an HDF5 file"),
    ];
    let known = KINDS.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, kind)| *kind);
    // Zeros may fill a file behind the byte that ends it under DOS.
    let text = bytes.iter().take(4096).take_while(|b| **b != 0x1a);
    known.or_else(|| text.into_iter().any(|b| *b == 0).then_some("a binary file"))
}
