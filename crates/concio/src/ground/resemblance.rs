//! What a file that could not be read looks like, for the message: a format that is read, damaged in its marks, or one that is not read.

use crate::ground::record::{Format, all_formats};
use crate::ground::source::Source;
use crate::{Error, InputError};

/// Lines in which marks are looked for.
const HEADER: usize = 150;

/// Words of headers, in upper case, by the format that has them.
const MARKS: [(Format, &[&str]); 12] = [
    (Format::ItacaAsc, &["EVENT_NAME:", "STATION_CODE:", "SAMPLING_INTERVAL_S", "NDATA", "DATE_TIME_FIRST_SAMPLE"]),
    (Format::Cosmos, &["REAL-HEADER VALUES", "INTEGER-HEADER VALUES", "ACCELERATION PTS", "(FORMAT V"]),
    (Format::UsgsSmc, &["CORRECTED ACCELEROGRAM", "MOMENT MAG=", "EPICENTRAL DIST ="]),
    (
        Format::Knet,
        &["ORIGIN TIME  ", "STATION CODE  ", "SAMPLING FREQ(HZ)", "SCALE FACTOR", "MAX. ACC. (GAL)", "LAST CORRECTION"],
    ),
    (Format::KnetCsv, &["#K-NET", "#SAMPLINGFREQUENCY", "#DURATIONTIME", "RELATIVETIME(S)"]),
    (Format::Geonet, &["GNS SCIENCE", "ACCELEROGRAPH", "MM/S/S", "INSTR PERIOD:", "CUSP FILE"]),
    (Format::Nsmn, &["STRONG GROUND MOTION RECORDS", "NUMBER OF DATA", "SAMPLING INTERVAL (SEC)", "RAW PGA VALUES"]),
    (Format::UnamAsa, &["UNAM", "ACELERACION", "INTERVALO DE MUESTREO", "MUESTRAS"]),
    (Format::Cwb, &["#STATIONCODE", "#SAMPLERATE", "#RECORDLENGTH", "#AMPLITUDEUNIT"]),
    (Format::CsmipV2, &["POINTS OF ACCEL", "CORRECTED ACCELEROGRAM", "PEAK ACCELERATION =", "INSTR PERIOD ="]),
    (Format::Volume1, &["UNCORRECTED ACCELEROGRAM DATA", "NO. OF POINTS", "SEC AND G", "INSTR PERIOD ="]),
    (Format::PeerAt2, &["NPTS", "IN UNITS OF G", "STRONG MOTION DATABASE", "STRONG-MOTION"]),
];

/// Formats that are not read, by a mark of theirs in upper case, and what to do.
const NOT_READ: [(&str, &str, &str); 7] = [
    ("RESPONSE AND FOURIER AMPLITUDE SPECTRA", "a CSMIP volume 3, spectra", "take volume 2 of the same record"),
    ("* VOL2", "a corrected volume of BHRC", "take volume 1 of the same record"),
    ("TIMESERIES ", "SLIST or TSPAIR", "save its samples as text in columns"),
    ("WID2 ", "GSE or IMS", "save its samples as text in columns"),
    (
        "TIME OF FIRST SAMPLE:",
        "the European Strong-Motion Database",
        "take the record from ESM, or its samples as text in columns",
    ),
    (
        "DATA TYPE=AC",
        "a USGS file with its format in words",
        "take the SMC file of the same record, or its samples as text",
    ),
    ("-12345.0", "SAC in letters", "save its samples as text in columns"),
];

/// Adds what the file resembles to an error of reading it as text.
pub(super) fn told(source: &Source, error: Error) -> Error {
    let Error::Input(error) = error else { return error };
    match resembles(source) {
        Some((what, advice)) => {
            let mut error: InputError = *error;
            error.help = Some(match error.help.take() {
                Some(help) => format!("the file resembles {what}: {advice}; as text: {help}"),
                None => format!("the file resembles {what}: {advice}"),
            });
            error.into()
        }
        None => Error::Input(error),
    }
}

/// A name and what to do about it.
fn resembles(source: &Source) -> Option<(String, String)> {
    let head: Vec<String> = source.head(HEADER).map(|(_, line)| line.to_uppercase()).collect();
    let has = |mark: &str| head.iter().any(|line| line.contains(mark));
    if let Some((_, what, advice)) = NOT_READ.iter().find(|(mark, ..)| has(mark)) {
        return Some(((*what).into(), format!("it is not read; {advice}")));
    }
    let found = MARKS.iter().map(|(format, marks)| (*format, *marks, marks.iter().filter(|mark| has(mark)).count()));
    let (format, marks, _) = found.filter(|(.., count)| *count > 0).max_by_key(|(.., count)| *count)?;
    let (there, lacking): (Vec<&str>, Vec<&str>) = marks.iter().partition(|mark| has(mark));
    let listed = |words: &[&str]| words.iter().map(|word| format!("`{}`", word.trim())).collect::<Vec<_>>().join(", ");
    let lacks = if lacking.is_empty() { String::new() } else { format!(" and lacks {}", listed(&lacking)) };
    Some((format.name().into(), format!("it has {}{lacks}; fetch it again", listed(&there))))
}

/// What is allowed instead of a file that holds nothing.
pub(super) fn nothing(source: &Source) -> InputError {
    source.error("no samples: this is none of the formats that are read").allowed(all_formats())
}
