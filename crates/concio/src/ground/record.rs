//! Reading of accelerograms. The format is found from the content of the file; its name says nothing.

use std::borrow::Cow;
use std::path::Path;

use crate::case::{HistoryLayout, HistoryQuantity, RecordInput};
use crate::files::{LARGEST_INPUT, read_input};
use crate::ground::source::{Source, line_end};
use crate::ground::{
    cosmos, csmip_v2, cwb, geonet, itaca_asc, knet, knet_csv, nsmn, peer_at2, resemblance, spline, text, unam_asa,
    units, usgs_smc, volume_1,
};
use crate::{Error, InputError, Result};

pub use crate::ground::remark::Remark;

/// Shortest and longest sample interval that is believed [s].
pub const INTERVAL_RANGE: [f64; 2] = [1e-6, 100.0];
/// Largest magnitude of a sample that is believed: 1e5 m/s² (ten thousand g) and 1e3 m.
const LARGEST_ACCELERATION: f64 = 1e5;
const LARGEST_DISPLACEMENT: f64 = 1e3;
/// Mean over the largest magnitude of samples from which it is no rounding.
const ROUNDING: f64 = 1e-9;
/// Most samples that a file may hold, all its components together: as many as a run keeps of one channel, and fourteen hours of two
/// components at 100 Hz. It bounds lines as well.
pub const MOST_SAMPLES: usize = 10_000_000;

/// File formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// PEER NGA time series (`.AT2`).
    PeerAt2,
    /// ITACA, ESM and AFAD, DYNA header (`.ASC`).
    ItacaAsc,
    /// COSMOS volumes 1 and 2 (`.V1`, `.V2`, `.V2c`).
    Cosmos,
    /// CSMIP volume 2 (`.V2`), also of the University of Southern California.
    CsmipV2,
    /// USGS strong-motion compact disc (`.smc`).
    UsgsSmc,
    /// K-NET and KiK-net in ASCII (`.NS`, `.EW`, `.UD`, `.NS2`, …).
    Knet,
    /// K-NET and KiK-net as CSV.
    KnetCsv,
    /// GeoNet volumes 1 and 2 (`.V1A`, `.V2A`).
    Geonet,
    /// National strong-motion network of Turkey, text.
    Nsmn,
    /// UNAM, standard file of acceleration.
    UnamAsa,
    /// Central Weather Administration of Taiwan, text.
    Cwb,
    /// Uncorrected volume 1 (`.v1`, `.RAW`): RENADIC, USC, CSMIP, BHRC.
    Volume1,
    /// Columns of text.
    Text,
    /// Not a file: made by [`crate::ground::synthetic`].
    Synthetic,
}

impl Format {
    /// The formats that are told from their content, in the order in which their marks are looked for: strict ones first.
    pub(super) const KNOWN: [Format; 12] = [
        Format::ItacaAsc,
        Format::Cosmos,
        Format::UsgsSmc,
        Format::Knet,
        Format::KnetCsv,
        Format::Geonet,
        Format::Nsmn,
        Format::UnamAsa,
        Format::Cwb,
        Format::CsmipV2,
        Format::Volume1,
        Format::PeerAt2,
    ];

    /// Name used in reports and in `concio record --json`.
    pub fn name(self) -> &'static str {
        match self {
            Format::PeerAt2 => "PEER AT2",
            Format::ItacaAsc => "ITACA/ESM ASC",
            Format::Cosmos => "COSMOS V1/V2",
            Format::CsmipV2 => "CSMIP V2",
            Format::UsgsSmc => "USGS SMC",
            Format::Knet => "K-NET/KiK-net ASCII",
            Format::KnetCsv => "K-NET CSV",
            Format::Geonet => "GeoNet V1A/V2A",
            Format::Nsmn => "NSMN text",
            Format::UnamAsa => "UNAM ASA",
            Format::Cwb => "CWB text",
            Format::Volume1 => "Volume 1",
            Format::Text => "text",
            Format::Synthetic => "synthetic",
        }
    }

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

/// The formats that are read, for messages.
pub(super) fn all_formats() -> String {
    let mut names: Vec<&str> = Format::KNOWN.iter().map(|format| format.name()).collect();
    names.sort_unstable();
    format!("{}, columns of numbers", names.join(", "))
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
    /// What the reader did or found.
    pub remarks: Vec<Remark>,
}

impl Record {
    /// Number of samples in the file, and the time from one to the next there [s], the mean where that varies.
    pub fn in_file(&self) -> (usize, f64) {
        let resampled = self.remarks.iter().find_map(|remark| match remark {
            Remark::Resampled { samples, .. } => Some(*samples),
            _ => None,
        });
        resampled.map_or((self.npts(), self.dt), |n| (n, self.duration() / (n.max(2) - 1) as f64))
    }
    /// What was taken off the samples of the file [m/s²].
    pub fn offset(&self) -> f64 {
        let offsets = self.remarks.iter().map(|remark| if let Remark::Offset { mean } = remark { *mean } else { 0.0 });
        offsets.sum()
    }
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
    /// Sample interval of values without a time column [s], when the file does not name it.
    pub dt: Option<f64>,
    /// How the values stand, when the file does not say it; none for columns unless they look like rows.
    pub layout: Option<HistoryLayout>,
}

impl From<&RecordInput> for TextOptions {
    fn from(input: &RecordInput) -> Self {
        let dt = input.dt.map(|dt| dt.si());
        TextOptions { quantity: input.quantity, units: input.units.clone(), dt, layout: input.layout }
    }
}

/// Reads all channels of a file.
///
/// # Errors
/// [`crate::Error::Input`] when the file cannot be read or is not a record; it names file, line and cause.
pub fn read(path: &Path, options: &TextOptions) -> Result<Vec<Record>> {
    let bytes = read_input(path, LARGEST_INPUT).map_err(|reason| {
        InputError::new(format!("the record cannot be read: {reason}"))
            .in_file(path)
            .help("a path in a wall file is relative to that file")
    })?;
    parse(&bytes, path, options)
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
    // Zeros may fill a file behind the byte that ends it under DOS.
    let text = bytes.iter().take(4096).take_while(|b| **b != 0x1a);
    known.or_else(|| text.into_iter().any(|b| *b == 0).then_some("a binary file"))
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
    pub remarks: Vec<Remark>,
    /// Whether the archive takes the mean of the samples off before it tells their peak.
    pub offset: bool,
}

impl Raw {
    /// Accelerations of a format without anything yet.
    pub fn of(format: Format) -> Self {
        Raw {
            format,
            quantity: HistoryQuantity::Acceleration,
            dt: 0.0,
            values: Vec::new(),
            units: String::new(),
            station: String::new(),
            event: String::new(),
            channel: String::new(),
            dt_line: 0,
            units_line: 0,
            data_line: 0,
            remarks: Vec::new(),
            offset: false,
        }
    }
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
    let mut values = raw.values;
    values.iter_mut().for_each(|value| *value *= factor);
    check_size(source, raw.data_line, &values, raw.quantity)?;
    let mut remarks = raw.remarks;
    if raw.offset {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let peak = values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
        values.iter_mut().for_each(|value| *value -= mean);
        // Of an offset that is rounding there is nothing to tell.
        remarks.extend((mean.abs() > ROUNDING * peak).then_some(Remark::Offset { mean }));
    }
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
        remarks,
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
