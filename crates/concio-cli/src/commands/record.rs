//! `concio record`.

use concio::Error;
use concio::case::{HistoryLayout, HistoryQuantity};
use concio::ground::channel;
use concio::ground::coverage::{self, DRIFT, OFFSET};
use concio::ground::formats;
use concio::ground::process::integrate;
use concio::ground::record::{Format, Record as History, TextOptions};
use concio::ground::{Measures, Spectrum, measure, response_spectrum};
use serde_json::json;

use crate::args::{Layout, Quantity, Record};
use crate::draw::curves::{self, Curve, Figure};
use crate::failure::{Failure, as_options};
use crate::files;
use crate::format::{pairs, seconds, si, significant};

/// Damping ratio of the spectrum.
const DAMPING: f64 = 0.05;
/// Periods of the spectrum [s]: that many from the shortest to the longest, at equal ratios.
const PERIODS: (usize, f64, f64) = (400, 0.02, 10.0);

/// Prints and draws the measures of a record.
pub fn record(args: &Record) -> Result<(), Failure> {
    if let Some(path) = &args.svg {
        files::guard(path, "svg", &[&args.file])?;
    }
    let options = TextOptions {
        quantity: match args.quantity {
            Quantity::Acceleration => HistoryQuantity::Acceleration,
            Quantity::Displacement => HistoryQuantity::Displacement,
        },
        units: args.units.clone(),
        dt: args.dt,
        layout: args.layout.map(|layout| match layout {
            Layout::Columns => HistoryLayout::Columns,
            Layout::Rows => HistoryLayout::Rows,
        }),
    };
    let channels = formats::read(&args.file, &options).map_err(as_options)?;
    let place = channel::choose(&channels, args.channel.as_ref());
    let place = place.map_err(|error| Error::from(error.in_file(&args.file).key("--channel")))?;
    let history = &channels[place];
    let (measures, spectrum) = (measure(history), spectrum(history));
    if let Some(path) = &args.svg {
        files::write(path, &drawing(history, &measures, &spectrum))?;
    }
    if args.json {
        return files::print_json(&json(&channels, place, &measures, &spectrum));
    }
    files::print(&table(history, place + 1, channels.len(), &measures))?;
    notes(args, &channels, place);
    Ok(())
}

/// What the user may have overlooked.
fn notes(args: &Record, channels: &[History], place: usize) {
    let history = &channels[place];
    if history.format != Format::Text {
        let given =
            [("--units", args.units.is_some()), ("--dt", args.dt.is_some()), ("--layout", args.layout.is_some())];
        for (option, _) in given.into_iter().filter(|(_, given)| *given) {
            let format = history.format.name();
            files::note(&format!("note: {option} is not used: {format} files say it themselves"));
        }
    } else if args.units.as_ref().is_some_and(|units| *units != history.units) {
        files::note(&format!("note: the file names its unit itself: {}", history.units));
    }
    if channels.len() > 1 && args.channel.is_none() {
        let which =
            if channel::is_vertical(&history.channel) { "none is horizontal" } else { "the first horizontal one" };
        let names = channel::names(channels);
        files::note(&format!("note: channel {} is taken, {which}; --channel chooses of {names}", place + 1));
    }
    for remark in &history.remarks {
        files::note(&format!("note: {remark}"));
    }
    let [what, remedy] = if args.units.is_some() { ["--units"; 2] } else { ["the unit in the file", "its unit"] };
    let odd = [
        coverage::odd_unit(what, remedy, history).or_else(|| coverage::odd_peak(history)),
        coverage::rare_peak(history),
        coverage::odd_interval(history),
        coverage::odd_length(history),
    ];
    for odd in odd.into_iter().flatten() {
        files::note(&format!("warning: {odd}"));
    }
}

fn spectrum(history: &History) -> Spectrum {
    let (n, low, high) = PERIODS;
    let periods: Vec<f64> = (0..n).map(|k| low * (high / low).powf(k as f64 / (n - 1) as f64)).collect();
    response_spectrum(history.dt, &history.acceleration, DAMPING, &periods)
}

/// `npts` and `dt` are those of the file; where its steps are unequal, `dt` is their mean and `resampled` what is measured. What is measured
/// is without the `offset` that the archive's own peak is without.
fn json(channels: &[History], place: usize, m: &Measures, spectrum: &Spectrum) -> String {
    let history = &channels[place];
    let (npts, dt) = history.in_file();
    let resampled = (npts != history.npts()).then(|| json!({ "npts": history.npts(), "dt": history.dt }));
    let remarks: Vec<String> = history.remarks.iter().map(ToString::to_string).collect();
    let names: Vec<&str> = channels.iter().map(|channel| channel.channel.as_str()).collect();
    let value = json!({
        "npts": npts,
        "dt": dt,
        "duration": history.duration(),
        "resampled": resampled,
        "pga": m.pga.value.abs(),
        "pga_signed": m.pga.value,
        "pga_time": m.pga.time,
        "mean": m.mean,
        "pga_without_mean": m.pga_without_mean.value.abs(),
        "pga_without_mean_signed": m.pga_without_mean.value,
        "pga_without_mean_time": m.pga_without_mean.time,
        "offset": history.offset(),
        "pgv": m.pgv.value.abs(),
        "pgv_time": m.pgv.time,
        "pgd": m.pgd.value.abs(),
        "pgd_time": m.pgd.time,
        "arias": m.arias,
        "d5_95": m.d5_95,
        "housner": m.housner,
        "units": history.units,
        "format": history.format.name(),
        "station": history.station,
        "event": history.event,
        "component": history.channel,
        "channel": place + 1,
        "channels": channels.len(),
        "components": names,
        "remarks": remarks,
        "final_velocity": m.final_velocity,
        "final_displacement": m.final_displacement,
        "spectrum": {
            "damping": spectrum.damping,
            "period": spectrum.periods,
            "sd": spectrum.sd,
            "psv": spectrum.psv,
            "psa": spectrum.psa,
        },
    });
    format!("{value:#}\n")
}

fn table(history: &History, channel: usize, channels: usize, m: &Measures) -> String {
    let at = |time: f64| format!("at {}", seconds(time));
    let named = |text: &str| if text.is_empty() { "–".to_string() } else { text.into() };
    let peak = |peak: concio::ground::Peak| {
        let g = peak.value.abs() / concio::ground::STANDARD_GRAVITY;
        format!("{} m/s² = {} g {}", significant(peak.value, 5), significant(g, 4), at(peak.time))
    };
    let mut text = pairs(&[
        ("format", history.format.name().into()),
        ("event", named(&history.event)),
        ("station", named(&history.station)),
        ("channel", format!("{channel} of {channels}  {}", history.channel).trim_end().into()),
        ("samples", format!("{} every {}, {}", history.npts(), seconds(history.dt), seconds(history.duration()))),
        ("unit in the file", named(&history.units)),
    ]);
    text.push('\n');
    let mut rows = vec![("PGA", peak(m.pga))];
    // Of a displacement history the mean acceleration is none of its own.
    let has_offset = history.displacement.is_none() && m.mean.abs() > OFFSET * m.pga.value.abs();
    if has_offset {
        rows.push(("mean", format!("{} m/s²", significant(m.mean, 4))));
        rows.push(("PGA without it", peak(m.pga_without_mean)));
    }
    rows.extend([
        ("PGV", format!("{} {}", si(m.pgv.value, "m/s"), at(m.pgv.time))),
        ("PGD", format!("{} {}", si(m.pgd.value, "m"), at(m.pgd.time))),
        ("end displacement", si(m.final_displacement, "m")),
        ("Arias intensity", format!("{} m/s", significant(m.arias, 5))),
        ("D5–95", format!("{} s from {} s", significant(m.d5_95, 4), significant(m.t5, 4))),
        ("Housner intensity", format!("{} m", significant(m.housner, 4))),
    ]);
    text.push_str(&pairs(&rows));
    let end = si(m.final_displacement, "m");
    // A displacement that ends far from where it was is drift: the record wants a baseline correction.
    if let Some(offset) = coverage::offset(history) {
        text.push_str(&format!(
            "\nThe displacement ends at {end}: {offset}.\nA baseline correction in the wall file takes it off: baseline = {{ polynomial = 0 }},\n\
             and what drift is left as well: baseline = {{ high_pass = \"0.1 Hz\" }}\n"
        ));
    } else if m.final_displacement.abs() > DRIFT * m.pgd.value.abs() && m.pgd.value != 0.0 {
        text.push_str(&format!(
            "\nThe displacement ends at {end}: the record drifts. A baseline correction in the wall file takes it away:\n\
             baseline = {{ high_pass = \"0.1 Hz\" }}\n"
        ));
    }
    text
}

fn drawing(history: &History, m: &Measures, spectrum: &Spectrum) -> String {
    let a = &history.acceleration;
    let (v, integrated) = integrate(history.dt, a, 0.0, 0.0);
    let u = history.displacement.as_ref().unwrap_or(&integrated);
    let t: Vec<f64> = (0..a.len()).map(|k| k as f64 * history.dt).collect();
    let over_time = |title: &str, quantity: &str, unit: &str, y: &[f64]| {
        curves::draw(&Figure {
            title,
            x_label: "time [s]",
            quantity,
            unit,
            curves: vec![Curve { name: "", x: &t, y }],
            height: 240.0,
            right: curves::NO_LEGEND,
            logarithmic: false,
        })
    };
    let title = [&history.event, &history.station, &history.channel].map(String::as_str).into_iter();
    let title = title.map(|s| s.trim().trim_end_matches([',', ';', ':', '.']).trim()).filter(|s| !s.is_empty());
    let title = title.collect::<Vec<_>>().join(", ");
    let size = m.pga.value.abs();
    let g = size / concio::ground::STANDARD_GRAVITY;
    let pga = format!("PGA {} m/s² = {} g", significant(size, 4), significant(g, 4));
    let pga = if title.is_empty() { pga } else { format!("{title}: {pga}") };
    let mut figures = vec![over_time(&pga, "acceleration", "m/s²", a)];
    // The velocity of a displacement history is its spline's, which only the measures know.
    if history.displacement.is_none() {
        figures.push(over_time("", "velocity", "m/s", &v));
    }
    figures.push(over_time("", "displacement", "m", u));
    figures.push(curves::draw(&Figure {
        title: "5 % response spectrum",
        x_label: "period [s]",
        quantity: "pseudo-acceleration",
        unit: "m/s²",
        curves: vec![Curve { name: "", x: &spectrum.periods, y: &spectrum.psa }],
        height: 300.0,
        right: curves::NO_LEGEND,
        logarithmic: true,
    }));
    curves::stack(&figures)
}
