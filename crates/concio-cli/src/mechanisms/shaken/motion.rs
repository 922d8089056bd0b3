//! What shakes the mechanisms: a record, or the motion of the wall file.

use std::path::Path;

use concio::case::{CaseFile, HistoryLayout, HistoryQuantity, ModelKind, RecordChannel, Signal};
use concio::ground::record::{Record, TextOptions};
use concio::ground::signal::{compile, from_record};
use concio::ground::{GroundMotion, Library, channel, coverage, formats, measure};
use concio::quantity::Quantity;
use concio::warning::{Warning, WarningKind};
use concio::{Error, InputError};
use concio_study::motions::strengthen;

use crate::args::{Layout, TimeHistory};
use crate::failure::{Failure, as_options};
use crate::format::{plain, seconds, significant};
use crate::motion::short;

/// A motion.
pub struct Motion {
    /// Across the wall.
    pub across: GroundMotion,
    /// Upwards.
    pub vertical: GroundMotion,
    /// Factor on both.
    pub factor: f64,
    /// How long it shakes [s].
    pub duration: f64,
    /// What it is, with its peak as it shakes the wall.
    pub words: String,
    /// What a reader should know of it.
    pub doubts: Vec<String>,
    /// What makes it doubtful, as runs tell it.
    pub warnings: Vec<Warning>,
}

/// The motion that is asked for; none where none is.
///
/// # Errors
/// A file that cannot be read, a component that it does not have, a motion at rest.
pub fn asked(args: &TimeHistory, file: &CaseFile) -> Result<Option<Motion>, Failure> {
    match &args.record {
        Some(path) => of_record(args, path).map(Some),
        None if args.shaken => of_wall(args, file).map(Some),
        None => Ok(None),
    }
}

fn of_record(args: &TimeHistory, path: &Path) -> Result<Motion, Failure> {
    let across = taken(args, path, args.channel.as_ref(), false)?;
    let vertical = args.vertical.as_ref().map(|path| taken(args, path, args.vertical_channel.as_ref(), true));
    let vertical = vertical.transpose()?;
    let peak = measure(&across.record).pga;
    if peak.value == 0.0 {
        let error = InputError::new("the record is zero throughout").in_file(path).key("--record");
        return Err(error.allowed("a record that moves").help("check --units and --channel").into());
    }
    let factor = args.pga.map_or(args.scale.unwrap_or(1.0), |pga| pga / peak.value.abs());
    let times = if factor == 1.0 { String::new() } else { format!(" times {}", significant(factor, 5)) };
    let size = factor * peak.value.abs();
    let mut words = format!(
        "{}{times}, peak {} m/s² = {} g at {}",
        across.words,
        significant(size, 4),
        significant(size / concio::G, 4),
        seconds(peak.time)
    );
    let mut doubts = across.doubts;
    let mut warnings = across.warnings;
    warnings.extend(doubted("--record", &across.record, factor, &mut doubts));
    let [what, remedy] =
        if args.units.is_some() { ["--units"; 2] } else { ["--record: the unit in the file", "its unit"] };
    let as_given = args.pga.is_none() && args.scale.is_none();
    if let Some(odd) = coverage::odd_unit(what, remedy, &across.record).filter(|_| as_given) {
        warnings.retain(|warning| warning.kind != WarningKind::UnlikelyPeak);
        warnings.push(Warning::new(WarningKind::UnlikelyRecord, odd));
    }
    let mut duration = across.record.duration();
    match &vertical {
        Some(up) => {
            let size = factor * measure(&up.record).pga.value.abs();
            words.push_str(&format!("; upwards {}{times}, peak {} m/s²", up.words, significant(size, 4)));
            doubts.extend(up.doubts.iter().cloned());
            warnings.extend(doubted("--vertical", &up.record, factor, &mut doubts));
            duration = duration.max(up.record.duration());
        }
        None => doubts.push("no vertical motion: --vertical adds one".into()),
    }
    let vertical = vertical.map_or(GroundMotion::AtRest, |up| from_record(&up.record));
    Ok(Motion { across: from_record(&across.record), vertical, factor, duration, words, doubts, warnings })
}

/// What runs would warn of a record as it shakes the wall; an offset without drift is a doubt.
fn doubted(option: &str, record: &Record, factor: f64, doubts: &mut Vec<String>) -> Vec<Warning> {
    let mut scaled = record.clone();
    scaled.acceleration.iter_mut().for_each(|a| *a *= factor);
    let warnings = coverage::of_option(option, &scaled);
    if warnings.iter().all(|warning| warning.kind != WarningKind::Drift) {
        doubts.extend(coverage::offset(&scaled));
    }
    warnings
}

/// A component of a file.
struct Taken {
    record: Record,
    words: String,
    doubts: Vec<String>,
    warnings: Vec<Warning>,
}

fn taken(args: &TimeHistory, path: &Path, wanted: Option<&RecordChannel>, up: bool) -> Result<Taken, Failure> {
    let options = TextOptions {
        quantity: HistoryQuantity::Acceleration,
        units: args.units.clone(),
        dt: args.dt,
        layout: args.layout.map(|layout| match layout {
            Layout::Columns => HistoryLayout::Columns,
            Layout::Rows => HistoryLayout::Rows,
        }),
    };
    let option = if up { "--vertical-channel" } else { "--channel" };
    let mut records = formats::read(path, &options).map_err(as_options)?;
    let own = |error: InputError| Failure::from(error.in_file(path).key(option));
    let place = match (up, wanted) {
        (true, None) => upright(&records).map_err(own)?,
        _ => channel::choose(&records, wanted).map_err(own)?,
    };
    let (mut doubts, mut warnings) = (Vec::new(), Vec::new());
    let label = &records[place].channel;
    if !up && channel::is_vertical(label) {
        let text = format!("the component `{label}` that shakes the wall to and fro is a vertical one by its name");
        warnings.push(Warning::new(WarningKind::UnlikelyRecord, text));
    }
    if up && !label.is_empty() && !channel::is_vertical(label) {
        doubts.push(format!("the component `{label}` that shakes the wall up and down is no vertical one by its name"));
    }
    if !up && records.len() > 1 && wanted.is_none() {
        let names = channel::names(&records);
        doubts.push(format!(
            "component {} is taken: --channel chooses of {names}. Which of them lies across the wall?",
            place + 1
        ));
    }
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let words = format!("{name}, channel {} of {} {label}", place + 1, records.len());
    let record = records.swap_remove(place);
    doubts.extend(record.remarks.iter().filter(|remark| !remark.is_doubtful()).map(ToString::to_string));
    Ok(Taken { words: words.trim_end().into(), record, doubts, warnings })
}

/// The first vertical component, or the only one.
fn upright(records: &[Record]) -> Result<usize, InputError> {
    let found = records.iter().position(|record| channel::is_vertical(&record.channel));
    found.or((records.len() == 1).then_some(0)).ok_or_else(|| {
        InputError::new("no component is vertical by its name").allowed(channel::names(records)).help("take its number")
    })
}

fn of_wall(args: &TimeHistory, file: &CaseFile) -> Result<Motion, Failure> {
    let motion = &file.case.motion;
    if motion.base == Signal::None {
        let error = InputError::new("at rest: nothing shakes the wall across its plane").key("motion.base");
        let error = error.allowed("a motion").help("or name a record with --record");
        return Err(file.locate(error.into()).into());
    }
    let compiled = |signal: &Signal| compile(signal, file.folder()).map_err(|e| file.locate(e));
    let (across, vertical) = (compiled(&motion.base)?, compiled(&motion.vertical)?);
    let duration = motion.duration.map(Quantity::si).or_else(|| Some(across.end()?.max(vertical.end()?)));
    let Some(duration) = duration else {
        let error = InputError::new("the motion never ends, and no duration is given").key("motion.duration");
        return Err(file.locate(Error::from(error.allowed("above 0 s"))).into());
    };
    let factor = args.scale.unwrap_or(1.0);
    let times = if factor == 1.0 { String::new() } else { format!(", times {}", plain(factor)) };
    let mut words =
        format!("the wall file's motion across the wall: {}{times}, {}", short(&motion.base), seconds(duration));
    let mut doubts = vec![
        "the motion of the wall file's base is taken across the wall; runs in the plane take it along the wall".into(),
    ];
    if motion.vertical == Signal::None {
        doubts.push("no vertical motion: motion.vertical adds one".into());
    } else {
        words.push_str(&format!("; upwards {}", short(&motion.vertical)));
    }
    let mut warnings = warned(file, duration, factor)?;
    let sampled = matches!(motion.base, Signal::Record(_) | Signal::Synthetic(_));
    if factor != 1.0 && !sampled {
        let at = |k: usize| across.acceleration(duration * k as f64 / LOOKS as f64).abs();
        warnings.extend(coverage::of_scaled(factor * (0..=LOOKS).map(at).fold(0.0, f64::max)));
    }
    Ok(Motion { across, vertical, factor, duration, words, doubts, warnings })
}

/// Instants at which a motion without samples is looked at for its peak.
const LOOKS: usize = 10_000;

/// What a run that rocks would warn of the wall file's motion, multiplied by `factor`.
fn warned(file: &CaseFile, duration: f64, factor: f64) -> Result<Vec<Warning>, Failure> {
    let mut case = file.case.clone();
    (case.model, case.motion.top) = (ModelKind::Rocking, Signal::None);
    if factor != 1.0 {
        strengthen(&mut case.motion, factor);
    }
    let found = coverage::warnings(&case, file.folder(), duration, &Library::default());
    let mut found = found.map_err(|e| Failure::from(file.locate(e)))?;
    // The factor is that of the command, which says it.
    found.retain(|warning| factor == 1.0 || warning.kind != WarningKind::ScaledByG);
    Ok(found)
}
