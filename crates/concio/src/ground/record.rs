//! Reading of accelerograms. The format is found from the content of the file; its name says nothing.

use std::borrow::Cow;
use std::path::Path;

use crate::case::{HistoryQuantity, RecordInput};
use crate::ground::source::Source;
use crate::ground::{cosmos_v2, csmip_v2, itaca_asc, peer_at2, spline, text, units, usgs_smc};
use crate::{InputError, Result};

/// Shortest and longest sample interval that is believed [s].
pub const INTERVAL_RANGE: [f64; 2] = [1e-6, 100.0];
/// Largest magnitude of a sample that is believed: 1e5 m/s² (ten thousand g) and 1e3 m.
const LARGEST_ACCELERATION: f64 = 1e5;
const LARGEST_DISPLACEMENT: f64 = 1e3;
/// Largest file that is read [bytes].
const LARGEST_FILE: u64 = 1 << 30;

/// File formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// PEER NGA time series (`.AT2`).
    PeerAt2,
    /// ITACA and ESM, DYNA header (`.ASC`).
    ItacaAsc,
    /// COSMOS volume 2 (`.V2`, `.V2c`).
    CosmosV2,
    /// CSMIP volume 2 (`.V2`).
    CsmipV2,
    /// USGS strong-motion compact disc (`.smc`).
    UsgsSmc,
    /// Columns of text.
    Text,
    /// Not a file: made by [`crate::ground::synthetic`].
    Synthetic,
}

impl Format {
    /// Name used in reports and in `concio record --json`.
    pub fn name(self) -> &'static str {
        match self {
            Format::PeerAt2 => "PEER AT2",
            Format::ItacaAsc => "ITACA/ESM ASC",
            Format::CosmosV2 => "COSMOS V2",
            Format::CsmipV2 => "CSMIP V2",
            Format::UsgsSmc => "USGS SMC",
            Format::Text => "text",
            Format::Synthetic => "synthetic",
        }
    }
}

/// One history at equal intervals. Between samples the acceleration is linear.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Where it comes from.
    pub format: Format,
    /// Sample interval [s], within [`INTERVAL_RANGE`].
    pub dt: f64,
    /// Acceleration at the samples [m/s²], two or more. Of a displacement history: the second derivative of the
    /// natural cubic spline through it.
    pub acceleration: Vec<f64>,
    /// Displacement at the samples [m] when the file is a displacement history; as many as `acceleration`.
    pub displacement: Option<Vec<f64>>,
    /// Unit of the samples as the file writes it.
    pub units: String,
    /// Station as the file names it; empty when it does not.
    pub station: String,
    /// Event as the file names it; empty when it does not.
    pub event: String,
    /// Channel or component as the file names it; empty when it does not.
    pub channel: String,
}

impl Record {
    /// Number of samples.
    pub fn npts(&self) -> usize {
        self.acceleration.len()
    }
    /// Time from the first sample to the last [s].
    pub fn duration(&self) -> f64 {
        (self.npts().saturating_sub(1)) as f64 * self.dt
    }
}

/// What a text file of columns may leave unsaid. The other formats name all of it, and options must agree with them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TextOptions {
    /// What the values are.
    pub quantity: HistoryQuantity,
    /// Unit of the values, when the file does not name it.
    pub units: Option<String>,
    /// Sample interval of a single column [s], when the file does not name it.
    pub dt: Option<f64>,
}

impl From<&RecordInput> for TextOptions {
    fn from(input: &RecordInput) -> Self {
        TextOptions { quantity: input.quantity, units: input.units.clone(), dt: input.dt.map(|dt| dt.si()) }
    }
}

/// Reads all channels of a file.
///
/// # Errors
/// [`crate::Error::Input`] when the file cannot be read or is not a record; it names file, line and cause.
pub fn read(path: &Path, options: &TextOptions) -> Result<Vec<Record>> {
    let unreadable = |source: std::io::Error| {
        InputError::new(format!("the record cannot be read: {source}"))
            .in_file(path)
            .help("a path in a wall file is relative to that file")
    };
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size > LARGEST_FILE {
        let what = format!("the record is a file of {size} bytes");
        return Err(InputError::new(what).in_file(path).allowed(format!("up to {LARGEST_FILE} bytes")).into());
    }
    let bytes = std::fs::read(path).map_err(unreadable)?;
    parse(&bytes, path, options)
}

/// Reads all channels of a file in memory; `path` is named in errors only.
///
/// # Errors
/// [`crate::Error::Input`] when the content is not a record; it names file, line and cause.
pub fn parse(bytes: &[u8], path: &Path, options: &TextOptions) -> Result<Vec<Record>> {
    let text = decode(bytes, path)?;
    let source = Source::new(path, &text);
    let format = detect(&source);
    let records = match format {
        Format::ItacaAsc => itaca_asc::read(&source).map(|record| vec![record]),
        Format::CosmosV2 => cosmos_v2::read(&source),
        Format::CsmipV2 => csmip_v2::read(&source),
        Format::UsgsSmc => usgs_smc::read(&source).map(|record| vec![record]),
        Format::PeerAt2 => peer_at2::read(&source).map(|record| vec![record]),
        Format::Text | Format::Synthetic if text.trim_start().starts_with(['{', '<']) => {
            let error = source.error("the file is JSON or a page of markup, none of the formats that are read");
            Err(error.allowed("PEER AT2, ITACA/ESM ASC, COSMOS V2, CSMIP V2, USGS SMC, columns of numbers").into())
        }
        Format::Text | Format::Synthetic => return text::read(&source, options),
    }?;
    for record in &records {
        agree(&source, record, options)?;
    }
    Ok(records)
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

/// Bytes as text. Latin-1 letters in station names become replacement characters, which no field minds.
fn decode<'a>(bytes: &'a [u8], path: &Path) -> Result<Cow<'a, str>> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let error = InputError::new("the file is UTF-16").in_file(path);
        return Err(error.allowed("UTF-8 or ASCII").help("save it as plain text").into());
    }
    if let Some(kind) = binary(bytes) {
        let error = InputError::new(format!("the file is {kind}, not text")).in_file(path);
        return Err(error.allowed("text").help("save it as CSV or text").into());
    }
    Ok(String::from_utf8_lossy(bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes)))
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
    known.or_else(|| bytes.iter().take(4096).any(|b| *b == 0).then_some("a binary file"))
}

/// The format, from marks that only it has.
fn detect(source: &Source) -> Format {
    match source {
        _ if itaca_asc::is_format(source) => Format::ItacaAsc,
        _ if cosmos_v2::is_format(source) => Format::CosmosV2,
        _ if usgs_smc::is_format(source) => Format::UsgsSmc,
        _ if csmip_v2::is_format(source) => Format::CsmipV2,
        _ if peer_at2::is_format(source) => Format::PeerAt2,
        _ => Format::Text,
    }
}

/// What a reader found, before units and checks.
pub(super) struct Raw {
    pub format: Format,
    pub quantity: HistoryQuantity,
    pub dt: f64,
    /// In the file's unit.
    pub values: Vec<f64>,
    pub units: String,
    pub station: String,
    pub event: String,
    pub channel: String,
    /// Lines (from 0) that errors about interval, unit and samples name.
    pub dt_line: usize,
    pub units_line: usize,
    pub data_line: usize,
}

/// Checks what all formats have in common and converts to SI.
pub(super) fn finish(source: &Source, raw: Raw) -> Result<Record> {
    if let Some(error) = interval_error(raw.dt) {
        return Err(error.in_file(source.path).at_line(raw.dt_line + 1).into());
    }
    if raw.values.len() < 2 {
        let what = format!("the file holds {} sample(s)", raw.values.len());
        return Err(source.error_at(raw.data_line, what).allowed("2 samples or more").into());
    }
    let factor = units::factor(&raw.units, raw.quantity).ok_or_else(|| {
        let shown: String = raw.units.chars().take(40).collect();
        source
            .error_at(raw.units_line, format!("`{shown}` is not a unit of {}", name(raw.quantity)))
            .allowed(units::allowed(raw.quantity))
    })?;
    let values: Vec<f64> = raw.values.iter().map(|value| value * factor).collect();
    check_size(source, raw.data_line, &values, raw.quantity)?;
    let (acceleration, displacement) = match raw.quantity {
        HistoryQuantity::Acceleration => (values, None),
        HistoryQuantity::Displacement => {
            (spline::second_derivatives(raw.dt, &values, spline::Ends::Natural), Some(values))
        }
    };
    Ok(Record {
        format: raw.format,
        dt: raw.dt,
        acceleration,
        displacement,
        units: raw.units,
        station: raw.station,
        event: raw.event,
        channel: raw.channel,
    })
}

/// The error of an interval that no record has.
pub(super) fn interval_error(dt: f64) -> Option<InputError> {
    let [low, high] = INTERVAL_RANGE;
    let error = || {
        InputError::new(format!("sample interval {} s", crate::quantity::shown(dt)))
            .key("dt")
            .allowed(format!("{low} … {high} s"))
    };
    (!(low..=high).contains(&dt)).then(error)
}

fn check_size(source: &Source, line: usize, values: &[f64], quantity: HistoryQuantity) -> Result<()> {
    let (limit, unit) = match quantity {
        HistoryQuantity::Acceleration => (LARGEST_ACCELERATION, "m/s2"),
        HistoryQuantity::Displacement => (LARGEST_DISPLACEMENT, "m"),
    };
    let Some(k) = values.iter().position(|value| value.abs() > limit) else { return Ok(()) };
    let what = format!("sample {} is {:e} {unit}", k + 1, values[k]);
    Err(source.error_at(line, what).allowed(format!("magnitudes up to {limit:e} {unit}")).help("check the unit").into())
}

/// Name of a quantity in messages.
pub(super) fn name(quantity: HistoryQuantity) -> &'static str {
    match quantity {
        HistoryQuantity::Acceleration => "acceleration",
        HistoryQuantity::Displacement => "displacement",
    }
}
