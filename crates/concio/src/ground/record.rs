//! What a file of accelerograms holds: its format, its channels, and what all formats have in common.

use crate::case::{HistoryLayout, HistoryQuantity, RecordInput};
use crate::ground::source::Source;
use crate::ground::{spline, units};
use crate::{InputError, Result};

pub use crate::ground::remark::Remark;

/// Shortest and longest sample interval that is believed [s].
pub const INTERVAL_RANGE: [f64; 2] = [1e-6, 100.0];
/// Largest magnitude of a sample that is believed: 1e5 m/s² (ten thousand g) and 1e3 m.
const LARGEST_ACCELERATION: f64 = 1e5;
const LARGEST_DISPLACEMENT: f64 = 1e3;
/// Mean over the largest magnitude of samples from which it is no rounding.
const ROUNDING: f64 = 1e-9;
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
    /// Largest magnitude of its acceleration [m/s²].
    pub(crate) fn largest(&self) -> f64 {
        self.acceleration.iter().fold(0.0, |most, a| most.max(a.abs()))
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

/// Tells of each channel that the file has no mark of an end behind any of them.
pub(super) fn tell_unmarked(records: &mut [Record], marked: bool) {
    if !marked {
        records.iter_mut().for_each(|record| record.remarks.push(Remark::Unmarked));
    }
}

/// Tells of each channel of a file that there are fewer than its instrument recorded.
pub(super) fn tell_fewer(records: &mut [Record], recorded: Option<u64>) {
    let found = records.len();
    let Some(recorded) = recorded.filter(|recorded| *recorded > found as u64) else { return };
    records.iter_mut().for_each(|record| record.remarks.push(Remark::Fewer { recorded, found }));
}
