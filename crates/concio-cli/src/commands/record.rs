//! `concio record`.

use concio::case::HistoryQuantity;
use concio::ground::coverage::{self, DRIFT};
use concio::ground::process::integrate;
use concio::ground::record::{self, Format, Record as History, TextOptions};
use concio::ground::{Measures, Spectrum, measure, response_spectrum};
use concio::{Error, InputError};
use serde_json::json;

use crate::args::{Quantity, Record};
use crate::draw::curves::{self, Curve, Figure};
use crate::failure::Failure;
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
    };
    let channels = record::read(&args.file, &options).map_err(as_options)?;
    let number = args.channel.unwrap_or(1) as usize;
    let Some(history) = channels.get(number - 1) else {
        let error = InputError::new(format!("the file has no channel {number}")).in_file(&args.file);
        return Err(error.key("--channel").allowed(format!("1 … {}", channels.len())).into());
    };
    let (measures, spectrum) = (measure(history), spectrum(history));
    if let Some(path) = &args.svg {
        files::write(path, &drawing(history, &measures, &spectrum))?;
    }
    if args.json {
        return files::print_json(&json(history, number, channels.len(), &measures, &spectrum));
    }
    files::print(&table(history, number, channels.len(), &measures))?;
    notes(args, history, channels.len());
    Ok(())
}

/// What the user may have overlooked.
fn notes(args: &Record, history: &History, channels: usize) {
    if history.format != Format::Text {
        for (option, given) in [("--units", args.units.is_some()), ("--dt", args.dt.is_some())] {
            if given {
                let format = history.format.name();
                files::note(&format!("note: {option} is not used: {format} files say it themselves"));
            }
        }
    } else if args.units.as_ref().is_some_and(|units| *units != history.units) {
        files::note(&format!("note: the file names its unit itself: {}", history.units));
    }
    if channels > 1 && args.channel.is_none() {
        files::note(&format!("note: the file has {channels} channels; --channel chooses another than the first"));
    }
    for odd in [coverage::odd_peak(history), coverage::odd_interval(history)].into_iter().flatten() {
        files::note(&format!("warning: {odd}"));
    }
}

/// The readers' hints name keys of a wall file; here they are options.
fn as_options(error: Error) -> Error {
    let Error::Input(mut error) = error else { return error };
    error.help = error.help.take().filter(|help| !help.contains("wall file")).map(|help| {
        help.replace("add `dt = \"0.005 s\"` to the input", "give --dt 0.005")
            .replace("add `units = \"cm/s2\"` to the input", "give --units cm/s2")
            .replace("set `quantity = \"acceleration\"`", "give --quantity acceleration")
            .replace("set `quantity = \"displacement\"`", "give --quantity displacement")
            .replace("leave `dt` out", "leave --dt out")
            .replace("leave `units` out", "leave --units out")
    });
    error.what = error.what.replace("s, the input ", "s, --dt ").replace("`, the input `", "`, --units `");
    Error::Input(error)
}

fn spectrum(history: &History) -> Spectrum {
    let (n, low, high) = PERIODS;
    let periods: Vec<f64> = (0..n).map(|k| low * (high / low).powf(k as f64 / (n - 1) as f64)).collect();
    response_spectrum(history.dt, &history.acceleration, DAMPING, &periods)
}

fn json(history: &History, channel: usize, channels: usize, m: &Measures, spectrum: &Spectrum) -> String {
    let value = json!({
        "npts": history.npts(),
        "dt": history.dt,
        "pga": m.pga.value.abs(),
        "pgv": m.pgv.value.abs(),
        "pgd": m.pgd.value.abs(),
        "arias": m.arias,
        "d5_95": m.d5_95,
        "housner": m.housner,
        "units": history.units,
        "format": history.format.name(),
        "station": history.station,
        "event": history.event,
        "component": history.channel,
        "channel": channel,
        "channels": channels,
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
    let g = m.pga.value.abs() / concio::ground::STANDARD_GRAVITY;
    let mut text = pairs(&[
        ("format", history.format.name().into()),
        ("event", named(&history.event)),
        ("station", named(&history.station)),
        ("channel", format!("{channel} of {channels}  {}", history.channel).trim_end().into()),
        ("samples", format!("{} every {}, {}", history.npts(), seconds(history.dt), seconds(history.duration()))),
        ("unit in the file", named(&history.units)),
    ]);
    text.push('\n');
    text.push_str(&pairs(&[
        ("PGA", format!("{} m/s² = {} g {}", significant(m.pga.value, 5), significant(g, 4), at(m.pga.time))),
        ("PGV", format!("{} {}", si(m.pgv.value, "m/s"), at(m.pgv.time))),
        ("PGD", format!("{} {}", si(m.pgd.value, "m"), at(m.pgd.time))),
        ("end displacement", si(m.final_displacement, "m")),
        ("Arias intensity", format!("{} m/s", significant(m.arias, 5))),
        ("D5–95", format!("{} s from {} s", significant(m.d5_95, 4), significant(m.t5, 4))),
        ("Housner intensity", format!("{} m", significant(m.housner, 4))),
    ]));
    // A displacement that ends far from where it was is drift: the record wants a baseline correction.
    if m.final_displacement.abs() > DRIFT * m.pgd.value.abs() && m.pgd.value != 0.0 {
        text.push_str(&format!(
            "\nThe displacement ends at {}: the record drifts. A baseline correction in the wall file takes it away:\n\
             baseline = {{ high_pass = \"0.1 Hz\" }}\n",
            si(m.final_displacement, "m")
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
