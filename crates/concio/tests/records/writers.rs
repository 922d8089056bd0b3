//! Writers of small record files in the layouts of the archives, for the reader's tests only.

use std::fmt::Write;

/// The known signal: a decaying sine [m/s²], 1.5 e^{−0.8 t} sin(2π 2.5 t + 0.3).
pub fn decaying_sine(dt: f64, npts: usize) -> Vec<f64> {
    let value = |t: f64| 1.5 * (-0.8 * t).exp() * (2.0 * std::f64::consts::PI * 2.5 * t + 0.3).sin();
    (0..npts).map(|k| value(k as f64 * dt)).collect()
}

/// Fortran E format with a leading decimal point: `.1234567E-01`, seven digits.
fn fortran_e(value: f64) -> String {
    if value == 0.0 {
        return ".0000000E+00".to_owned();
    }
    let text = format!("{:.6e}", value.abs());
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse::<i32>().unwrap() + 1;
    let sign = if value < 0.0 { "-" } else { "" };
    let exponent_sign = if exponent < 0 { '-' } else { '+' };
    format!("{sign}.{}E{exponent_sign}{:02}", mantissa.replace('.', ""), exponent.abs())
}

/// Values in lines of `per_line` fields of `width` characters.
fn block(values: &[f64], per_line: usize, width: usize, end: &str, field: impl Fn(f64) -> String) -> String {
    let line = |row: &[f64]| row.iter().map(|v| format!("{:>width$}", field(*v))).collect::<String>() + end;
    values.chunks(per_line).map(line).collect()
}

/// How a PEER file writes its number line.
#[derive(Clone, Copy, Debug)]
pub enum Dialect {
    /// `NPTS=  4000, DT= .01000 SEC`
    Plain,
    /// `NPTS=   8192, dt=  .00244`
    LowerCase,
    /// `NPTS=   4000, DT=   .0100 SEC,`
    Comma,
    /// `  4000    0.0100    NPTS, DT`
    NumbersFirst,
    /// NPTS and DT on lines of their own, after a longer header.
    OwnLines,
}

/// PEER AT2: acceleration in g, five fields of fifteen characters.
pub fn peer_at2(values_g: &[f64], dt: f64, dialect: Dialect, end: &str) -> String {
    let n = values_g.len();
    let dt = format!("{dt:.5}");
    let dt = dt.trim_start_matches('0');
    let numbers = match dialect {
        Dialect::Plain => format!("NPTS=  {n}, DT= {dt} SEC"),
        Dialect::LowerCase => format!("NPTS=   {n}, dt=  {dt}"),
        Dialect::Comma => format!("NPTS=   {n}, DT=   {dt} SEC,"),
        Dialect::NumbersFirst => format!("  {n}    {dt}    NPTS, DT"),
        Dialect::OwnLines => format!("Station on rock, width of the vault 3 m{end}npts = {n}{end}dt = {dt}"),
    };
    let head = [
        "SYNTHETIC STRONG-MOTION RECORD",
        "TEST EVENT 01/01/20, NOWHERE, 360",
        "ACCELERATION TIME SERIES IN UNITS OF G",
    ];
    head.join(end) + end + &numbers + end + &block(values_g, 5, 15, end, fortran_e)
}

/// ITACA/ESM ASC: 64 `KEY: value` lines, one sample in cm/s² a line; `declared` samples in the header.
pub fn itaca_asc(values_cm: &[f64], dt: f64, declared: usize) -> String {
    let known = [
        ("EVENT_NAME", "TEST_EVENT".to_owned()),
        ("EVENT_ID", "XX-2020-0001".to_owned()),
        ("EVENT_DATE_YYYYMMDD", "20200101".to_owned()),
        ("EVENT_TIME_HHMMSS", "120000".to_owned()),
        ("NETWORK", "XX".to_owned()),
        ("STATION_CODE", "TST".to_owned()),
        ("STATION_NAME", "NOWHERE: A TEST".to_owned()),
        ("SAMPLING_INTERVAL_S", format!("{dt:.6}")),
        ("NDATA", declared.to_string()),
        ("DURATION_S", format!("{:.3}", declared as f64 * dt)),
        ("STREAM", "HNE".to_owned()),
        ("UNITS", "cm/s^2".to_owned()),
        ("DATA_TYPE", "ACCELERATION".to_owned()),
    ];
    let mut text = String::new();
    for (key, value) in &known {
        writeln!(text, "{key}: {value}").unwrap();
    }
    for k in known.len()..64 {
        writeln!(text, "USER{k}: ").unwrap();
    }
    for value in values_cm {
        writeln!(text, "{value:.6}").unwrap();
    }
    text
}

/// COSMOS V2: 100 integers, 100 reals of which 34 is the interval of the raw record and 62 that of the samples.
pub fn cosmos_v2(values_cm: &[f64], dt: f64, raw_dt: f64) -> String {
    let n = values_cm.len();
    let mut text = "Corrected acceleration    (Format v01.20 with 13 text lines)
Record of Test Event of Wed Jan 1, 2020 12:00 UTC
Hypocenter: 45.0000   10.0000   H= 10km Mw=6.0
Origin: 2020/01/01 12:00:00    UTC
Statn No: 00-000001 Code:XX-TST     Nowhere
Coords: 45.0000   10.0000   Site geology: rock
Recorder: none            ( 1 Chns of   3 at Sta) Sensor: none
Rcrd start time: 2020/01/01 12:00:00.000 UTC (Q=5) RcrdId: none
Sta Chan   1: 360 deg (Rcrdr Chan  1) Location: ground
Raw record length = 2.000 sec, Uncor max = 1, at 0.000 sec.
Processed: 2020-01-01 12:00:00 GMT, NONE
Record filtered below  0.03 Hz, and above 20.0 Hz
Values used when parameter or data value is unknown/unspecified:   -999, -999.00
"
    .to_owned();
    writeln!(text, " 100 Integer-header values follow on  10 lines, Format= (10I8)").unwrap();
    text += &block(&[-999.0; 100], 10, 8, "\n", |v| format!("{v:.0}"));
    let mut reals = [-999.0; 100];
    reals[33] = raw_dt;
    reals[61] = dt * 1e3;
    writeln!(text, " 100 Real-header values follow on  20 lines, Format= (5F15.6)").unwrap();
    text += &block(&reals, 5, 15, "\n", |v| format!("{v:.6}"));
    writeln!(text, "   1 Comment line(s) follow, each starting with a \"|\":\n| made for a test").unwrap();
    writeln!(text, "{n:8} acceleration pts, approx    2 secs, units=cm/sec2(04),Format=(1E15.6)").unwrap();
    text += &block(values_cm, 1, 15, "\n", |v| exponent_of_two_digits(&format!("{v:.6e}")));
    text + "End-of-data for Chan  1 acceleration\n"
}

/// `1.5e-2` as `1.5e-02`.
fn exponent_of_two_digits(text: &str) -> String {
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    format!("{mantissa}e{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
}

/// CSMIP V2: channels of acceleration, velocity and displacement in full fields of ten characters, `8F10.3`.
pub fn csmip_v2(channels: &[Vec<f64>], dt: f64) -> String {
    let end = "\r\n";
    let mut text = String::new();
    for (index, values) in channels.iter().enumerate() {
        let (n, number) = (values.len(), index + 1);
        let mut lines = vec![
            format!("CORRECTED ACCELEROGRAM   00001-S0001-20001.01       CHAN  {number}: TEST"),
            "UNCORRECTED ACCELEROGRAM DATA              PROCESSED:  1/01/20".to_owned(),
        ];
        lines.extend(
            [
                "TEST EARTHQUAKE",
                "JANUARY 1, 2020 12:00 UTC",
                "00001-S0001-20001.01",
                "STATION NO. 1   45.000N, 10.000E",
                "NOWHERE",
            ]
            .map(str::to_owned),
        );
        lines.push(format!("CHAN  {number}:  90 DEG"));
        lines.push("TEST EARTHQUAKE     JANUARY 1, 2020 12:00 UTC".to_owned());
        lines.resize(25, String::new());
        text += &(lines.join(end) + end);
        text += &block(&[0.0; 100], 16, 5, end, |v| format!("{v:.0}"));
        text += &block(&[0.0; 100], 8, 10, end, |v| format!("{v:.3}"));
        for (name, unit) in [("ACCEL", "CM/SEC/SEC"), ("VELOC", "CM/SEC"), ("DISPL", "CM")] {
            write!(text, "{n:5} POINTS OF {name} DATA EQUALLY SPACED AT {dt:5.3} SEC.  (UNITS: {unit}){end}").unwrap();
            let own: Vec<f64> = if name == "ACCEL" { values.clone() } else { vec![0.25; n] };
            text += &block(&own, 8, 10, end, |v| format!("{v:.3}"));
        }
        write!(text, "/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------{end}").unwrap();
    }
    text
}

/// USGS SMC: 11 text lines, 48 integers, 50 reals, two comments, samples in `8(1PE10.4E1)`.
pub fn usgs_smc(values_cm: &[f64], dt: f64) -> String {
    let end = "\r\n";
    let mut lines = vec![
        "2 CORRECTED ACCELEROGRAM",
        "*",
        "TEST",
        "     2020   1   1    1200 Nowhere",
        "Moment Mag=      6.0",
        "station = Nowhere, 1 First Street      component=    360",
        "epicentral dist =     10.0",
        "inst type=none",
        "*",
        "*",
        "*",
    ]
    .into_iter()
    .map(|line| format!("{line:<80}"))
    .collect::<Vec<_>>()
    .join(end)
        + end;
    let mut integers = [-32768.0; 48];
    integers[15] = 2.0;
    integers[16] = values_cm.len() as f64;
    lines += &block(&integers, 8, 10, end, |v| format!("{v:.0}"));
    let mut reals = [1.7e38; 50];
    reals[1] = 1.0 / dt;
    lines += &block(&reals, 5, 15, end, |v| format!("0{}", fortran_e(v)));
    lines += &format!("|{end}|made for a test{end}");
    lines + &block(values_cm, 8, 10, end, smc_field)
}

/// `1PE10.4E1`: ten characters, one digit of exponent, so that neighbours touch.
fn smc_field(value: f64) -> String {
    let text = format!("{value:.4e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    if exponent < -9 {
        return "0.0000E+0".to_owned();
    }
    format!("{mantissa}E{}{}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
}

/// Text with a time column, the unit named in the title.
pub fn csv(values: &[f64], dt: f64) -> String {
    let row = |(k, v): (usize, &f64)| format!("{:.4},{v:.9}\n", k as f64 * dt);
    "# made for a test\ntime [s],acceleration [m/s2]\n".to_owned()
        + &values.iter().enumerate().map(row).collect::<String>()
}
