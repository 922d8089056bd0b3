//! What a run leaves of a record: whether it is cut off or followed by silence, and which channel was taken unasked.

use std::path::Path;

use crate::G;
use crate::case::plausible::rounded;
use crate::case::{Baseline, Beam, BlockForce, Case, HistoryQuantity, ModelKind, RecordInput, Signal};
use crate::error::Result;
use crate::ground::library::Component;
use crate::ground::process::Peaks;
use crate::ground::record::{Format, Record};
use crate::ground::signal::{GroundMotion, compile_with};
use crate::ground::{Library, STANDARD_GRAVITY, channel, measure, units};
use crate::quantity::shown;
use crate::warning::{Warning, WarningKind};

/// Difference of run and record that does not count, over the length of the record.
const SLACK: f64 = 1e-6;

/// Displacement at the end of a motion, over its largest, from which it is called drift; `concio record` uses the same.
pub const DRIFT: f64 = 0.5;

/// Mean of an acceleration over its largest magnitude from which it counts as an offset; `concio record` uses the same.
pub const OFFSET: f64 = 0.01;

/// Displacement [m] at the end of a motion below which nobody minds.
const SMALLEST_DRIFT: f64 = 0.01;
/// Peak accelerations of records beyond which units are doubted [m/s²].
const SMALLEST_PEAK: f64 = 0.01;
const LARGEST_PEAK: f64 = 60.0;
/// Peak of nearly all records [g].
const STRONGEST: f64 = 2.0;
/// The same of a motion whose peak the wall file names: the largest that were recorded have 3 to 4 g.
const NAMED: f64 = 3.0;
const ROUNDING: f64 = 1e-9;

/// A peak above which one is told, in the g in which it was named: a limit is not told of itself.
#[derive(Debug, Clone, Copy)]
struct Most {
    /// In `gravity`.
    peak: f64,
    /// That of records, or that of wall files [m/s²].
    gravity: f64,
}

/// Of motions whose peak nothing names.
const FOUND: Most = Most { peak: STRONGEST, gravity: STANDARD_GRAVITY };
/// Below this peak hardly a wall moves [m/s²].
const WEAK: f64 = 0.05 * STANDARD_GRAVITY;
/// Difference from g of a factor that is meant to be g: 9.8, 9.80665, 9.81.
const NEARLY_G: f64 = 2.5e-3;
/// Factor on one of two components alone from which it is told: rounding, and corrections of one of them.
const TOGETHER: f64 = 1.1;
/// Keys that scale a record.
const SCALES: &str = "`scale` and `pga`";
/// Instants at which a pulse or sweep is looked at for its peak.
const LOOKS: usize = 10_000;
/// Time between samples beyond which its unit is doubted [s]: earthquakes shake at 5 Hz and more.
const LARGEST_INTERVAL: f64 = 0.1;
/// Length of a record below which it is hardly whole [s].
const SHORTEST: f64 = 1.0;

/// How a run of `duration` [s] covers a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coverage {
    /// To its end and no further.
    Whole,
    /// The record ends later.
    Cut,
    /// The run ends later [s]: so long without acceleration.
    Silence(f64),
}

/// How a run of `duration` [s] covers `record`.
pub fn coverage(record: &Record, duration: f64) -> Coverage {
    let whole = record.duration();
    if duration < whole - SLACK * whole {
        Coverage::Cut
    } else if duration > whole + SLACK * whole {
        Coverage::Silence(duration - whole)
    } else {
        Coverage::Whole
    }
}

/// What a user should know of the records of a case before believing a run of `duration` [s], one sentence each.
/// `folder` is where relative record paths start; records are taken from `library`.
///
/// # Errors
/// Records that cannot be read.
pub fn warnings(case: &Case, folder: &Path, duration: f64, library: &Library) -> Result<Vec<Warning>> {
    let driven = case.load.beam == Beam::Driven;
    let mut found = Vec::new();
    let signals = || case.motion.signals().into_iter().filter(|(name, _)| *name != "top" || driven);
    // Of two components one may be weak.
    let mut hardly_moves = true;
    for (_, signal) in signals() {
        hardly_moves &= match signal {
            Signal::Record(input) => library.record(input, folder)?.largest() < WEAK,
            Signal::Synthetic(input) => input.pga.si() < WEAK,
            _ => true,
        };
    }
    for (name, signal) in signals() {
        match signal {
            Signal::Record(input) => {
                found.extend(unchosen(name, input, folder, library)?);
                let record = library.record(input, folder)?;
                let scale = of_gravity(name, input, &record).map(|text| Warning::new(WarningKind::ScaledByG, text));
                let unit = in_gravity(name, input, &record).filter(|_| scale.is_none() && hardly_moves);
                let told_twice = |w: &Warning| unit.is_some() && w.kind == WarningKind::UnlikelyPeak;
                let doubted = unit.as_ref().map(|t| Warning::new(WarningKind::UnlikelyRecord, t.clone()));
                found.extend(scale.or(doubted));
                if record.displacement.is_none() {
                    let weakened = weakened(name, input, &library.peaks(input, folder)?);
                    found.extend(weakened.into_iter().map(|text| Warning::new(WarningKind::RecordCut, text)));
                }
                let meant = input.pga.is_some();
                found.extend(of_record(case, name, &record, meant, duration).into_iter().filter(|w| !told_twice(w)));
            }
            Signal::Synthetic(input) => {
                let made = library.synthetic(input)?;
                found.extend(uncovered(place(name), "accelerogram", &made, duration));
                let key = format!("motion.{name}");
                found.extend(beyond(&key, made.largest(), most(case, true), SCALES));
            }
            other => found
                .extend(cut(name, other, duration, library, folder)?.map(|t| Warning::new(WarningKind::RecordCut, t))),
        }
    }
    let apart = apart(case, folder, library)?;
    found.extend(apart.map(|text| Warning::new(WarningKind::UnlikelyRecord, text)));
    Ok(found)
}

/// The same of a motion of the base that no file gives: that results do not hold it, and what would be said of a record of its samples.
pub fn of_own(case: &Case, base: &GroundMotion, duration: f64) -> Vec<Warning> {
    let mut found = match base {
        GroundMotion::AtRest => return Vec::new(),
        GroundMotion::Samples(samples) => of_record(case, "base", &samples.record(), false, duration),
        GroundMotion::Pieces(_) => {
            unended("base", base, duration).map(|t| Warning::new(WarningKind::RecordCut, t)).into_iter().collect()
        }
    };
    let text =
        "motion.base: the base is moved by a motion that no file gives; results and reports say that nothing moved it";
    found.push(Warning::new(WarningKind::MotionInNoFile, text));
    found
}

/// The same of a record that moves a wall across its plane by an option of a command, such as `--record`, and scaled as it does so.
pub fn of_option(option: &str, record: &Record) -> Vec<Warning> {
    let place = if option == "--vertical" { "vertical direction" } else { "base" };
    let named = Named { key: option, place, units: "--units", scales: "--scale and --pga", file: " of a wall file" };
    [named.remarks(record), named.numbers(record, FOUND)].concat()
}

/// Says that a motion without samples multiplied by `--scale` has a peak [m/s²] that hardly an earthquake had.
pub fn of_scaled(peak: f64) -> Option<Warning> {
    beyond("--scale", peak, FOUND, "and --scale")
}

/// What a signal moves, in words.
fn place(name: &str) -> &str {
    if name == "vertical" { "vertical direction" } else { name }
}

/// How sentences name a record, and what changes it.
struct Named<'n> {
    key: &'n str,
    /// What it moves.
    place: &'n str,
    /// What says its unit.
    units: &'n str,
    scales: &'n str,
    /// Whose key takes a drift away, where it is not that of the record.
    file: &'n str,
}

impl Named<'_> {
    /// What its file makes one doubt.
    fn remarks(&self, record: &Record) -> Vec<Warning> {
        let doubtful = record.remarks.iter().filter(|remark| remark.is_doubtful());
        let doubtful = doubtful.map(|remark| format!("{}, of the record: {remark}", self.key));
        doubtful.map(|text| Warning::new(WarningKind::DoubtfulRecord, text)).collect()
    }

    /// What its samples do; a peak above `most` is told.
    fn numbers(&self, record: &Record, most: Most) -> Vec<Warning> {
        let Named { key, place, units, scales, file } = self;
        let drift = drifting(place, file, record).map(|text| Warning::new(WarningKind::Drift, text));
        let peak = odd_peak(record).map(|odd| format!("{key}: {odd} as it moves the wall: look at {units}, {scales}"));
        let interval = odd_interval(record).map(|odd| format!("{key}: {odd}"));
        let length = odd_length(record).map(|odd| format!("{key}: {odd}"));
        let rare = if peak.is_none() { beyond(key, record.largest(), most, scales) } else { None };
        let odd = interval.into_iter().chain(length).map(|text| Warning::new(WarningKind::UnlikelyRecord, text));
        let peak = peak.map(|text| Warning::new(WarningKind::UnlikelyPeak, text));
        drift.into_iter().chain(rare).chain(peak).chain(odd).collect()
    }
}

/// `meant`: whether the wall file names its peak.
fn of_record(case: &Case, name: &str, record: &Record, meant: bool, duration: f64) -> Vec<Warning> {
    let key = format!("motion.{name}");
    let named = Named { key: &key, place: place(name), units: "`units`", scales: SCALES, file: "" };
    let covered = uncovered(place(name), "record", record, duration);
    [named.remarks(record), covered.into_iter().collect(), named.numbers(record, most(case, meant))].concat()
}

/// Where the wall file names a peak more is meant, but of rocking walls, which it throws over.
fn most(case: &Case, meant: bool) -> Most {
    match (meant, case.model) {
        (false, _) => FOUND,
        (true, ModelKind::Rocking) => Most { peak: STRONGEST, gravity: G },
        (true, _) => Most { peak: NAMED, gravity: G },
    }
}

/// Says which component is taken where none is chosen of several, and whether one of the other direction is taken.
fn unchosen(name: &str, input: &RecordInput, folder: &Path, library: &Library) -> Result<Option<Warning>> {
    let Component { number, names } = library.component(input, folder)?;
    let label = |number: usize| match names[number - 1].as_str() {
        "" => format!("channel {number}"),
        label => format!("channel {number} `{label}`"),
    };
    let is_vertical = channel::is_vertical(&names[number - 1]);
    let upright = name == "vertical";
    if input.channel.is_none() && names.len() > 1 {
        let which = if is_vertical { "none of them horizontal" } else { "the first horizontal one" };
        let other = (1..=names.len()).find(|k| upright && channel::is_vertical(&names[k - 1]));
        let advice = other.map_or(String::new(), |k| format!("; the vertical one is {} (`channel = {k}`)", label(k)));
        let taken = label(number);
        let text = format!(
            "motion.{name}: the record has {} channels and none is chosen: {taken} is taken, {which} (`channel = {number}`){advice}",
            names.len()
        );
        return Ok(Some(Warning::new(WarningKind::UnchosenChannel, text)));
    }
    let (which, kind) = match names.len() {
        1 => ("only", WarningKind::UnchosenChannel),
        _ => ("chosen", WarningKind::UnlikelyRecord),
    };
    Ok((is_vertical && !upright).then(|| {
        let label = &names[number - 1];
        Warning::new(
            kind,
            format!("motion.{name}: the record's {which} component is a vertical one by its name, `{label}`"),
        )
    }))
}

/// A motion is judged as it moves the wall, after `trim`, `baseline` and scaling: `concio record` sees only the file. A
/// displacement history may end where it likes. `file` follows the key that takes the drift away.
fn drifting(name: &str, file: &str, record: &Record) -> Option<String> {
    if record.displacement.is_some() {
        return None;
    }
    let m = measure(record);
    let (end, peak) = (m.final_displacement, m.pgd.value.abs());
    if !(end.abs() > DRIFT * peak && end.abs() > SMALLEST_DRIFT) {
        return None;
    }
    let (end, peak) = (1e3 * end, 1e3 * peak);
    // Sums leave rounding.
    let mean = if m.mean.abs() > 1e-9 * m.pga.value.abs() { m.mean } else { 0.0 };
    let why = match offset(record) {
        Some(offset) => format!(
            "{offset}; `baseline = {{ polynomial = 0 }}`{file} takes it off, `{{ high_pass = \"0.1 Hz\" }}` what drift is left as well"
        ),
        None => format!(
            "`baseline = {{ high_pass = \"0.1 Hz\" }}`{file} takes that away and hardly touches the acceleration, whose mean is {} m/s²",
            rounded(mean, 2)
        ),
    };
    Some(format!(
        "the motion of the {name} as processed drifts: its displacement ends at {end:.0} mm, its largest is {peak:.0} mm; {why}"
    ))
}

/// Says of an acceleration whose mean is no rounding that it has an offset, and what that does: a constant push for as long as the record
/// lasts, which the peak holds too. None for displacement histories.
pub fn offset(record: &Record) -> Option<String> {
    let m = measure(record);
    let (mean, peak) = (m.mean, m.pga.value.abs());
    (record.displacement.is_none() && mean.abs() > OFFSET * peak).then(|| {
        let [mean_g, without] = [mean.abs() / STANDARD_GRAVITY, m.pga_without_mean.value.abs()].map(|v| rounded(v, 3));
        format!(
            "its acceleration has an offset: its mean is {} m/s² ({mean_g} g, {} % of its peak). It pushes one way all the time, and the peak \
             of {} m/s² includes it ({without} m/s² without)",
            rounded(mean, 3),
            rounded(100.0 * mean.abs() / peak, 2),
            rounded(peak, 4),
        )
    })
}

/// Says of a peak that no earthquake has, or that no wall feels, that it is: it comes from units, or from a file of zeros.
pub fn odd_peak(record: &Record) -> Option<String> {
    let peak = record.largest();
    let (how, bound) = if peak > LARGEST_PEAK { ("more", LARGEST_PEAK) } else { ("less", SMALLEST_PEAK) };
    if peak == 0.0 {
        return Some("the record is 0 from end to end".into());
    }
    (!(SMALLEST_PEAK..=LARGEST_PEAK).contains(&peak))
        .then(|| format!("the record's peak acceleration is {} m/s², {how} than {bound} m/s²", rounded(peak, 4)))
}

/// Says of a record, as its file has it, that its peak is above 2 g.
pub fn rare_peak(record: &Record) -> Option<String> {
    let peak = record.largest();
    let in_g = peak / STANDARD_GRAVITY;
    (in_g > STRONGEST && peak <= LARGEST_PEAK).then(|| {
        let peak = shown(rounded(in_g, 3));
        format!("the record's peak acceleration is {peak} g, more than 2 g, which few records have: look at its unit")
    })
}

/// Says of a peak [m/s²] above `most` that hardly an earthquake had that it is one.
fn beyond(key: &str, peak: f64, Most { peak: most, gravity }: Most, scales: &str) -> Option<Warning> {
    let peak = peak / gravity;
    (peak > most * (1.0 + ROUNDING)).then(|| {
        // As many digits as tell it from the limit.
        let peak = (3..9).map(|digits| rounded(peak, digits)).find(|peak| *peak > most).unwrap_or(most);
        let [peak, most] = [peak, most].map(shown);
        let text = format!(
            "{key}: its peak acceleration is {peak} g as it moves the wall, more than {most} g, which few records have: look at its unit, its interval, {scales}"
        );
        Warning::new(WarningKind::RarePeak, text)
    })
}

/// Says of a record of text, as its file has it, that hardly moves a wall in the unit that the file or `units` gives, that its numbers may be in another.
/// `what` gives it, and `remedy` is what to change.
pub fn odd_unit(what: &str, remedy: &str, record: &Record) -> Option<String> {
    let text = record.format == Format::Text && record.displacement.is_none();
    let unit = Some(&record.units).filter(|_| text)?;
    let peak = record.largest();
    // The largest number of the file.
    let number = peak / units::factor(unit, HistoryQuantity::Acceleration)?;
    let shakes = |(_, factor): &(&str, f64)| (WEAK..STRONGEST * STANDARD_GRAVITY).contains(&(number * factor));
    let meant: Vec<_> = [("g", STANDARD_GRAVITY), ("m/s2", 1.0)].into_iter().filter(shakes).collect();
    (peak < WEAK && !meant.is_empty()).then(|| {
        let in_g = |a: f64| shown(rounded(a / STANDARD_GRAVITY, 3));
        let asked: Vec<String> = meant.iter().map(|(_, factor)| format!("{} g", in_g(number * factor))).collect();
        let units: Vec<String> = meant.iter().map(|(unit, _)| format!("\"{unit}\"")).collect();
        format!(
            "{what} is {unit:?}, in which the record's peak acceleration is {} g: it hardly moves a wall. Is it {}? Then {remedy} is {}",
            in_g(peak),
            asked.join(", or "),
            units.join(", or ")
        )
    })
}

/// Whether a warning is that of a peak of the base that no wall feels, which [`odd_unit`] tells with its reason.
pub fn is_of_peak(warning: &Warning) -> bool {
    warning.kind == WarningKind::UnlikelyPeak && warning.starts_with("motion.base")
}

/// [`odd_unit`] of a record that a wall file takes as it is.
fn in_gravity(name: &str, input: &RecordInput, record: &Record) -> Option<String> {
    let (what, remedy) = match input.units {
        Some(_) => (format!("motion.{name}.units"), "`units`"),
        None => (format!("motion.{name}.record: the unit in the file"), "its unit"),
    };
    let as_given = input.scale.is_none() && input.pga.is_none();
    if as_given { odd_unit(&what, remedy, record) } else { None }
}

/// Part of its peak that a record keeps as it is trimmed and filtered, below which it is told.
const KEPT: f64 = 0.6;
/// The same where it is resampled, which takes no more than rounding of what shakes a wall.
const SAMPLED: f64 = 0.85;

/// Says of an acceleration which of the steps that prepare it took away its strongest part.
fn weakened(name: &str, input: &RecordInput, peaks: &Peaks) -> Vec<String> {
    let steps = [
        ("trim", input.trim.is_some(), peaks.trim, KEPT),
        ("baseline", input.baseline != Baseline::None, peaks.baseline, KEPT),
        ("resample", input.resample.is_some(), peaks.resample, SAMPLED),
    ];
    let [_, last] = peaks.resample;
    let scaled = match input.pga {
        Some(pga) if last > 0.0 => {
            format!(", and `pga` multiplies what is left by {}", shown(rounded(pga.si() / last, 3)))
        }
        _ => String::new(),
    };
    let weak = steps.into_iter().filter(|(_, done, [before, after], least)| *done && *after < least * before);
    let told = weak.map(|(key, _, [before, after], _)| {
        let gone = if after < KEPT * before { ": its strongest part is gone" } else { "" };
        let [before, after] = [before, after].map(|a| shown(rounded(a / STANDARD_GRAVITY, 3)));
        format!(
            "motion.{name}.{key}: of the record's peak acceleration of {before} g this leaves {after} g{gone}{scaled}"
        )
    });
    told.collect()
}

/// Says of a factor that is g, or one over g, in a unit of acceleration: files and `units` say theirs, and g would count twice.
fn of_gravity(name: &str, input: &RecordInput, record: &Record) -> Option<String> {
    let scale = input.scale.filter(|_| input.quantity == HistoryQuantity::Acceleration)?;
    let near = |of: f64| (scale.abs() / of - 1.0).abs() < NEARLY_G;
    let is_g = [G, 100.0 * G, 1.0 / G, 0.01 / G].into_iter().any(near);
    is_g.then(|| {
        let peak = record.largest() / STANDARD_GRAVITY;
        let [scale, peak, without] = [scale, peak, peak / scale.abs()].map(|v| shown(rounded(v, 3)));
        format!(
            "motion.{name}.scale is {scale}, a conversion to or from g, but records are converted by their own unit: the peak is {peak} g as it moves the wall, \
             {without} g without `scale`. Leave `scale` out; a text file of another unit takes `units`, such as \"g\""
        )
    })
}

/// Whether a warning is one of a factor on the record of the base that is g, or of the peak that it comes to: it means nothing where a study chose
/// the factor.
pub fn is_of_factor(warning: &Warning) -> bool {
    matches!(warning.kind, WarningKind::ScaledByG | WarningKind::RarePeak) && warning.starts_with("motion.base")
}

/// Says of the two components of a motion that one of them alone is scaled: they are no more of one earthquake.
fn apart(case: &Case, folder: &Path, library: &Library) -> Result<Option<String>> {
    let (Signal::Record(base), Signal::Record(vertical)) = (&case.motion.base, &case.motion.vertical) else {
        return Ok(None);
    };
    let key = |input: &RecordInput| input.pga.map(|_| "pga").or(input.scale.map(|_| "scale"));
    let (scaled, how, plain, own) = match (key(base), key(vertical)) {
        (Some(how), None) => ("base", how, "vertical", base),
        (None, Some(how)) => ("vertical", how, "base", vertical),
        _ => return Ok(None),
    };
    let peak = |input: &RecordInput| -> Result<f64> { Ok(measure(&library.record(input, folder)?).pga.value.abs()) };
    let [with, without] = [peak(own)?, peak(&RecordInput { pga: None, scale: None, ..own.clone() })?];
    let factor = with / without;
    Ok(((factor.ln()).abs() > TOGETHER.ln()).then(|| {
        let factor = shown(rounded(factor, 3));
        format!(
            "motion.{plain} is not scaled, and `{how}` multiplies motion.{scaled} by {factor}: the two no longer have the ratio that was recorded. `scale = {factor}` in \
             motion.{plain} keeps their ratio; `scale = 1` says that it is meant so"
        )
    }))
}

/// Says of samples of an acceleration that are too far apart for an earthquake that they are: times are in another unit.
pub fn odd_interval(record: &Record) -> Option<String> {
    (record.dt > LARGEST_INTERVAL && record.displacement.is_none()).then(|| {
        let (dt, most) = (rounded(record.dt, 4), LARGEST_INTERVAL);
        format!("the record's samples are {dt} s apart, more than {most} s: are its times in milliseconds? (`Time [ms]` heads them)")
    })
}

/// Says of a record that is too short for an earthquake that it is: most of its file is missing, or its interval is in another unit.
pub fn odd_length(record: &Record) -> Option<String> {
    let (samples, length) = (record.npts(), record.duration());
    (length < SHORTEST).then(|| {
        let length = seconds(length);
        format!("the record has {samples} samples in {length}, less than {SHORTEST} s: is it whole, and its interval in seconds?")
    })
}

/// Says of a pulse or sweep that ends after the run that it does, and how much of it has come by then.
fn unended(name: &str, motion: &GroundMotion, duration: f64) -> Option<String> {
    let end = motion.end().filter(|end| duration < end * (1.0 - SLACK))?;
    let most = |until: f64| {
        let at = |k: usize| motion.acceleration(until * k as f64 / LOOKS as f64).abs();
        (0..LOOKS).map(at).fold(0.0, f64::max)
    };
    let [within, whole] = [most(duration), most(end)].map(|a| shown(rounded(a / STANDARD_GRAVITY, 3)));
    Some(format!(
        "motion.duration cuts the motion of the {name}, which ends at {}: {} of it is used, and its acceleration reaches {within} g of {whole} g",
        seconds(end),
        seconds(duration)
    ))
}

/// What grows from 0 at one time until another [s].
struct Growth {
    key: &'static str,
    /// The keys of its end.
    until: &'static str,
    times: [f64; 2],
    /// What it grows to, in `unit`.
    whole: f64,
    unit: &'static str,
}

fn growth(signal: &Signal) -> Option<Growth> {
    let from = |start: f64, rise: f64| [start, start + rise];
    let (key, until, times, whole, unit) = match signal {
        Signal::Tilt(t) => ("tilt", "start + rise", from(t.start.si(), t.rise.si()), t.acceleration.si() / G, "g"),
        Signal::Ramp(r) => ("ramp", "start + rise", from(r.start.si(), r.rise.si()), 1e3 * r.amplitude.si(), "mm"),
        Signal::Sine(s) => match (s.amplitude, s.acceleration) {
            (Some(amplitude), _) => ("sine", "ramp", from(0.0, s.ramp.si()), 1e3 * amplitude.si(), "mm"),
            (None, acceleration) => ("sine", "ramp", from(0.0, s.ramp.si()), acceleration?.si() / G, "g"),
        },
        _ => return None,
    };
    Some(Growth { key, until, times, whole, unit })
}

/// Says of what grows that it ends, or the run does, before it has grown, and what it has reached by then.
fn ungrown(name: &str, signal: &Signal, duration: f64) -> Option<String> {
    let Growth { key, until, times: [start, end], whole, unit } = growth(signal)?;
    let own = match signal {
        Signal::Sine(sine) => sine.cycles.map(|cycles| cycles / sine.frequency.si()),
        _ => None,
    };
    let (last, what, remedy) = match own.filter(|own| *own < duration) {
        Some(own) => (own, format!("motion.{name}.{key}.cycles end"), "Let `cycles` be more, or `ramp` shorter".into()),
        None => (duration, "the run ends".into(), format!("Let motion.duration be {} or longer", seconds(end))),
    };
    let [reached, whole] = [whole * (last - start) / (end - start), whole].map(|v| shown(rounded(v, 3)));
    (last < end * (1.0 - SLACK)).then(|| {
        let [end, last] = [end, last].map(seconds);
        format!("motion.{name}.{key} reaches {reached} {unit} of {whole} {unit}: it grows until {end} ({until}), and {what} at {last}. {remedy}")
    })
}

/// Says of a path that the run ends on its way, and where.
fn unwalked(name: &str, motion: &GroundMotion, duration: f64) -> Option<String> {
    let end = motion.end().filter(|end| duration < end * (1.0 - SLACK))?;
    let [place, last] = [duration, end].map(|t| shown(rounded(1e3 * motion.at(t).u, 3)));
    let [end, duration] = [end, duration].map(seconds);
    Some(format!(
        "motion.{name}.path is cut by motion.duration: it takes {end}, and after {duration} it is at {place} mm; its last displacement is {last} mm. \
         Without motion.duration the run takes it whole"
    ))
}

/// Says of a motion that no record gives that the run ends before it does.
fn cut(name: &str, signal: &Signal, duration: f64, library: &Library, folder: &Path) -> Result<Option<String>> {
    let motion = compile_with(signal, folder, library)?;
    Ok(match signal {
        Signal::Path(_) => unwalked(name, &motion, duration),
        Signal::Pulse(_) | Signal::Sweep(_) => unended(name, &motion, duration),
        Signal::Sine(_) => ungrown(name, signal, duration).or_else(|| unended(name, &motion, duration)),
        _ => ungrown(name, signal, duration),
    })
}

/// Says of forces on blocks that the run ends before their last value acts.
pub(crate) fn of_forces(case: &Case, duration: f64) -> Vec<Warning> {
    let told = |(index, force): (usize, &BlockForce)| {
        let (every, values) = (force.every?.si(), force.x.len().max(force.y.len()));
        let last = values.saturating_sub(1) as f64 * every;
        (last >= duration).then(|| {
            let acts = (duration / every).ceil();
            let [every, last, end] = [every, last, duration].map(seconds);
            let text = format!(
                "force[{index}].every is {every}: the run of {end} ends before its last value acts, which does from {last} on ({acts} of {values} act). \
                 Let motion.duration be longer"
            );
            Warning::new(WarningKind::RecordCut, text)
        })
    };
    case.forces.iter().enumerate().filter_map(told).collect()
}

fn uncovered(name: &str, what: &str, record: &Record, duration: f64) -> Option<Warning> {
    let whole = seconds(record.duration());
    match coverage(record, duration) {
        Coverage::Whole => None,
        Coverage::Cut => {
            let m = measure(record);
            let t95 = m.t5 + m.d5_95;
            let strong = if duration < t95 {
                let t95 = seconds(t95);
                format!(", and ends before the strong shaking does (95 % of the Arias intensity at {t95})")
            } else {
                String::new()
            };
            let text = format!(
                "motion.duration cuts the {what} of the {name}: {} of {whole} is used{strong}; without `duration` the \
                 run takes it whole",
                seconds(duration)
            );
            Some(Warning::new(WarningKind::RecordCut, text))
        }
        Coverage::Silence(_) => {
            let end = seconds(duration);
            let text = format!("the {what} of the {name} ends at {whole}, the run at {end}: silence follows it");
            Some(Warning::new(WarningKind::RecordOutlasted, text))
        }
    }
}

/// At most nine significant digits, no zeros behind the last.
fn seconds(value: f64) -> String {
    let digits: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    format!("{digits} s")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::Format;

    fn record(npts: usize) -> Record {
        Record {
            format: Format::Text,
            dt: 0.01,
            acceleration: (0..npts).map(|k| (0.3 * k as f64).sin()).collect(),
            displacement: None,
            units: String::new(),
            station: String::new(),
            event: String::new(),
            channel: String::new(),
            remarks: Vec::new(),
        }
    }

    #[test]
    fn a_record_is_covered_cut_or_followed_by_silence() {
        let record = record(101);
        assert_eq!(coverage(&record, 1.0), Coverage::Whole);
        assert_eq!(coverage(&record, 1.0 + 1e-9), Coverage::Whole);
        assert_eq!(coverage(&record, 0.5), Coverage::Cut);
        assert_eq!(coverage(&record, 1.5), Coverage::Silence(0.5));
        let cut = uncovered("base", "record", &record, 0.5).expect("a warning");
        assert!(cut.contains("0.5 s of 1 s is used, and ends before the strong shaking does"), "{cut}");
        assert!(!uncovered("base", "record", &record, 0.99).expect("a warning").contains("strong shaking"));
        let silence = uncovered("top", "record", &record, 1.5).expect("a warning");
        assert_eq!(silence, "the record of the top ends at 1 s, the run at 1.5 s: silence follows it");
    }

    #[test]
    fn a_motion_that_ends_away_from_its_start_drifts() {
        // One second of 1 m/s² one way and one back comes to rest 1 m away (0.99 m with the slope between the two
        // samples where it turns); back again, it ends where it began.
        let mut there = record(0);
        there.acceleration = [vec![1.0; 100], vec![-1.0; 101]].concat();
        let warning = drifting("base", "", &there).expect("a warning");
        assert!(warning.contains("ends at 990 mm, its largest is 990 mm"), "{warning}");
        let mut back = record(0);
        back.acceleration = [vec![1.0; 100], vec![-1.0; 200], vec![1.0; 100]].concat();
        assert_eq!(drifting("base", "", &back), None);
        there.displacement = Some(vec![0.0; 201]);
        assert_eq!(drifting("base", "", &there), None);
    }

    /// Wall files take 9.81 m/s² for g, records 9.80665 m/s².
    #[test]
    fn a_limit_that_a_wall_file_names_is_not_told_of_itself() {
        let text = include_str!("../../../../examples/19-rocking-facade.toml");
        let file = crate::case::from_str(text, crate::case::Syntax::Toml, None).expect("a wall file");
        let told = |peak: f64, most: Most| beyond("motion.base", peak, most, SCALES).map(|w| w.text);
        assert_eq!(told(2.0 * G, most(&file.case, true)), None);
        assert_eq!(told(2.0 * STANDARD_GRAVITY, most(&file.case, false)), None);
        let above = told(2.0001 * G, most(&file.case, true)).expect("a warning");
        assert!(above.contains("is 2.0001 g as it moves the wall, more than 2 g"), "{above}");
        assert!(told(2.0 * G, FOUND).is_some_and(|w| w.contains("more than 2 g")));
    }

    #[test]
    fn peaks_and_intervals_of_other_units_are_told() {
        let usual = record(101);
        assert_eq!((odd_peak(&usual), odd_interval(&usual)), (None, None));
        let mut other = record(101);
        other.acceleration.iter_mut().for_each(|a| *a *= 981.0);
        other.dt = 5.0;
        let peak = odd_peak(&other).expect("a doubt");
        assert!(peak.contains("981 m/s², more than 60 m/s²"), "{peak}");
        let interval = odd_interval(&other).expect("a doubt");
        assert!(interval.contains("5 s apart, more than 0.1 s"), "{interval}");
        assert_eq!(odd_length(&usual), None);
        let short = odd_length(&record(3)).expect("a doubt");
        assert!(short.contains("3 samples in 0.02 s, less than 1 s"), "{short}");
        let mut silent = record(101);
        silent.acceleration.fill(0.0);
        assert!(odd_peak(&silent).is_some_and(|odd| odd.contains("0 from end to end")));
    }

    #[test]
    fn times_bear_no_digits_of_rounding() {
        assert_eq!((seconds(49.995_000_000_000_005), seconds(65.0)), ("49.995 s".into(), "65 s".into()));
    }
}
