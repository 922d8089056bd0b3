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
    cosmos(values_cm, dt, raw_dt, "cm/sec2(04)")
}

/// COSMOS with a unit of its own, code in brackets.
pub fn cosmos(values: &[f64], dt: f64, raw_dt: f64, unit: &str) -> String {
    let n = values.len();
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
    writeln!(text, "{n:8} acceleration pts, approx    2 secs, units={unit},Format=(1E15.6)").unwrap();
    text += &block(values, 1, 15, "\n", |v| exponent_of_two_digits(&format!("{v:.6e}")));
    text + "End-of-data for Chan  1 acceleration\n"
}

/// `1.5e-2` as `1.5e-02`.
fn exponent_of_two_digits(text: &str) -> String {
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    format!("{mantissa}e{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
}

/// How a CSMIP file announces its samples.
#[derive(Clone, Copy, Debug)]
pub enum Announced {
    /// ` 3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)`
    InBrackets,
    /// `  7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)`
    WithFormat,
    /// `  1887 POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.  IN UNITS CM/SEC/SEC`
    InUnits,
}

/// CSMIP V2: channels of acceleration, velocity and displacement in full fields of ten characters.
pub fn csmip_v2(channels: &[Vec<f64>], dt: f64, announced: Announced) -> String {
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
        lines.push(format!("CHAN  {number}:  {}", ["90 DEG", "UP", "360 DEG"][index % 3]));
        lines.push("TEST EARTHQUAKE     JANUARY 1, 2020 12:00 UTC".to_owned());
        lines.resize(15, String::new());
        lines.push(format!("{n:5} POINTS OF INSTRUMENT- AND BASELINE-CORRECTED ACCEL, VELOC AND DISPL DATA"));
        lines.resize(25, String::new());
        text += &(lines.join(end) + end);
        text += &block(&[0.0; 100], 16, 5, end, |v| format!("{v:.0}"));
        text += &block(&[0.0; 100], 8, 10, end, |v| format!("{v:.3}"));
        for (name, unit) in [("ACCEL", "CM/SEC/SEC"), ("VELOC", "CM/SEC"), ("DISPL", "CM")] {
            let (short, digits) = (&name[..3], if matches!(announced, Announced::WithFormat) { 6 } else { 3 });
            let line = match announced {
                Announced::InBrackets => {
                    format!("{n:5} POINTS OF {name} DATA EQUALLY SPACED AT {dt:5.3} SEC.  (UNITS: {unit})")
                }
                Announced::WithFormat => {
                    let unit = unit.replace("SEC/SEC", "sec2").to_lowercase();
                    let name = name.to_lowercase();
                    format!(
                        "{n:6} points of {name} data equally spaced at {dt:5.3} sec, in {unit}. (8f10.{digits})    "
                    )
                }
                Announced::InUnits => {
                    format!("{n:6} POINTS OF {short} DATA EQUALLY SPACED AT {dt:6.3} SEC.  IN UNITS {unit}")
                }
            };
            text += &(line + end);
            let own: Vec<f64> = if name == "ACCEL" { values.clone() } else { vec![0.25; n] };
            text += &block(&own, 8, 10, end, |v| format!("{v:.digits$}"));
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

/// K-NET and KiK-net in ASCII: counts of `unit` gal on an offset, eight in a line.
pub fn knet(values_gal: &[f64], dt: f64, direction: &str, offset: f64) -> String {
    let (numerator, denominator) = (3920.0, 6_182_761.0);
    let mean = values_gal.iter().sum::<f64>() / values_gal.len() as f64;
    let peak = values_gal.iter().fold(0.0, |peak: f64, a| peak.max((a - mean).abs()));
    let header = [
        ("Origin Time", "2000/01/01 00:00:00".to_owned()),
        ("Lat.", "40.0".to_owned()),
        ("Long.", "140.0".to_owned()),
        ("Depth. (km)", "10".to_owned()),
        ("Mag.", "5.0".to_owned()),
        ("Station Code", "XXX001".to_owned()),
        ("Station Lat.", "40.0".to_owned()),
        ("Station Long.", "140.0".to_owned()),
        ("Station Height(m)", "1".to_owned()),
        ("Record Time", "2000/01/01 00:00:15".to_owned()),
        ("Sampling Freq(Hz)", format!("{:.0}Hz", 1.0 / dt)),
        ("Duration Time(s)", format!("{:.0}", values_gal.len() as f64 * dt)),
        ("Dir.", direction.to_owned()),
        ("Scale Factor", format!("{numerator:.0}(gal)/{denominator:.0}")),
        ("Max. Acc. (gal)", format!("{peak:.3}")),
        ("Last Correction", "2000/01/01 00:00:00".to_owned()),
        ("Memo.", String::new()),
    ];
    let mut text: String = header.iter().map(|(name, value)| format!("{name:<18}{value}\n")).collect();
    for row in values_gal.chunks(8) {
        let counts = row.iter().map(|a| format!("{:8.0} ", (a + offset) * denominator / numerator));
        text += &(counts.collect::<String>() + "\n");
    }
    text
}

/// K-NET as CSV, two decimals, on offsets of 0.1, 1.7 and 16.5 gal.
pub fn knet_csv(components_gal: [&[f64]; 3], dt: f64) -> String {
    let n = components_gal[0].len();
    let mut text = format!(
        "#K-NET CSV\n#Event\n#OriginTime,Latitude,Longitude,Depth(km),Magnitude\n#2000/01/01 00:00:00,40.0,140.0,10,5.0\n#Station\n\
         #Code,Latitude,Longitude,Height(m)\n#XXX001,40.0,140.0,1\n#Record\n#SamplingFrequency(Hz)\n#{:.0}\n#DurationTime(s)\n#{:.0}\n\
         #Offset\n#N-S(gal),E-W(gal),U-D(gal)\n#0.10,1.70,16.50\n#Time,RelativeTime(s),N-S(gal),E-W(gal),U-D(gal)\n",
        1.0 / dt,
        n as f64 * dt
    );
    for k in 0..n {
        let t = k as f64 * dt;
        let [x, y, z] = [0, 1, 2].map(|c| components_gal[c][k] + [0.1, 1.7, 16.5][c]);
        writeln!(text, "2000/01/01 00:00:{t:05.2},{t:.2},{x:.2},{y:.2},{z:.2}").unwrap();
    }
    text
}

/// GeoNet: three components in mm/s², one decimal; `corrected` files hold velocity and displacement too.
pub fn geonet(components_mm: [&[f64]; 3], dt: f64, corrected: bool) -> String {
    let mut text = String::new();
    for (name, values) in ["S90E", "N00E", "Up"].into_iter().zip(components_mm) {
        let n = values.len();
        let title = if corrected { "Corrected" } else { "Uncorrected" };
        let interval = if corrected {
            format!("Instrument corrected data at {dt:.3} sec intervals")
        } else {
            // Raw readings in halves of a millimetre per second squared.
            format!("Raw readings in units of 0.50 mm/s/s  at intervals of {dt:.3} s")
        };
        text += &format!(
            "{title} accelerogram 20000101_000000_XXXX_20 Test\nSite XXXX      40 00 00S  170 00 00E     Cusp file:  20000101_000000_XXXX\n\
             Test Place\nInstrument Test\nResolution: 18-bit   Instr Period: 0.0050 s   Damping: 0.700\n\
             Accelerogram 20000101_000000_XXXX_20                 Processed 2000 January 01\n5 km west of Nowhere\n\
             2000 January 01         00:00:00 UT\nEpicentre  40 00 00S 170 00 00E  Bearing N00E  Dist    1km  Depth    1km Mw 5.00\n\
             Number of points {n:5}    Duration {:.2} sec\n{interval}\nBand-pass filter transition bands are .10-.25 Hz and 24.50-25.50 Hz\n\
             Component {name}    Test Axis\nAcceleration:  peak 0.0 mm/s/s\nVelocity: none\nDisplacement: none\n",
            (n - 1) as f64 * dt
        );
        let others = if corrected { n as f64 } else { 0.0 };
        let mut integers = [0.0; 40];
        (integers[33], integers[34], integers[35]) = (n as f64, others, others);
        text += &block(&integers, 10, 8, "\n", |v| format!("{v:.0}"));
        text += &block(&[0.0; 60], 10, 8, "\n", |v| format!("{v:.2}"));
        let unit = if corrected { 1.0 } else { 0.5 };
        text += &block(values, 10, 8, "\n", |v| format!("{:.1}", v / unit));
        if corrected {
            text += &block(&vec![0.25; 2 * n][..n], 10, 8, "\n", |v| format!("{v:.2}"));
            text += &block(&vec![0.125; n], 10, 8, "\n", |v| format!("{v:.3}"));
        }
    }
    text
}

/// NSMN, Turkey: three columns in gal without time, six decimals.
pub fn nsmn(components_gal: [&[f64]; 3], dt: f64) -> String {
    let n = components_gal[0].len();
    let mut text = format!(
        "STRONG GROUND MOTION RECORDS OF TURKIYE\r\nPLACE                   : NOWHERE\r\n\
         EARTHQUAKE DATE         : 2000/01/01 00:00:00 (GMT)\r\nSTATION ID              : 0001\r\n\
         NUMBER OF DATA          : {n}\r\nSAMPLING INTERVAL (sec) : {dt}\r\n\
         RAW PGA VALUES (gal)    : (N-S) 1 (E-W) 1 (U-D) 1\r\nCopyright NOBODY\r\n       N-S          E-W          U-D\r\n"
    );
    for k in 0..n {
        let [x, y, z] = [0, 1, 2].map(|c: usize| components_gal[c][k]);
        write!(text, "{x:12.6}{y:14.6}{z:13.6}\r\n").unwrap();
    }
    text
}

/// UNAM, Mexico: three columns in gal without time, `3F10.4`; the header lists what each channel has.
pub fn unam(components_gal: [&[f64]; 3], dt: f64) -> String {
    let n = components_gal[0].len();
    let length = n as f64 * dt;
    let rule = "---------+---------+---------+---------+---------+---------+---------+---------+";
    let mut text = format!(
        "INSTITUTO DE INGENIERIA, UNAM\r\nARCHIVO ESTANDAR DE ACELERACION:\r\n\
         NOMBRE DE LA ESTACION                  : EN NINGUNA PARTE\r\nCLAVE DE LA ESTACION                   : NADA\r\n\
         ORIENTACION C1-C6 (rumbo;orientacion)  : /V/N00E/N90E\r\nORIENTACION C7-C12 (rumbo;orientacion) : \r\n\
         INTERVALO DE MUESTREO, C1-C6 (s)       : /{dt}/{dt}/{dt}\r\nINTERVALO DE MUESTREO, C7-C12 (s)      : \r\n\
         FECHA DEL SISMO [GMT]                  : 2000/01/01\r\n\
         DURACION DEL REGISTRO (s), C1-C6       : /{length:.2}/{length:.2}/{length:.2}\r\n\
         NUM. TOTAL DE MUESTRAS, C1-C6          : /{n}/{n}/{n}\r\nNUM. TOTAL DE MUESTRAS, C7-C12         : \r\n\
         UNIDADES DE LOS DATOS                  : Gal (cm/s/s)\r\nFACTOR DE DECIMACION                   : 1\r\n\
         FORMATO DATOS (FORTRAN,10 campos/dato) : 3F10.4\r\nDATOS DE ACELERACION:\r\n{rule}\r\n   CANAL-1   CANAL-2   CANAL-3\r\n\
         \x20        V      N00E      N90E\r\n{rule}\r\n"
    );
    for k in 0..n {
        let [x, y, z] = [0, 1, 2].map(|c: usize| components_gal[c][k]);
        write!(text, "{x:10.4}{y:10.4}{z:10.4}\r\n").unwrap();
    }
    text
}

/// CWB, Taiwan: time and three columns in gal, `4F10.3`.
pub fn cwb(components_gal: [&[f64]; 3], dt: f64) -> String {
    let n = components_gal[0].len();
    let mut text = format!(
        "#Earthquake Information\r\n#Origin Time(GMT+08): 2000/01/01-00:00:00\r\n\r\n#Station Information\r\n#StationCode: XXX\r\n\
         #StationName: Nowhere\r\n#RecordLength(sec): {:.0}\r\n#SampleRate(Hz): {:.0}\r\n#AmplitudeUnit:  gal. DCoffset(corr)\r\n\
         #DataSequence: Time U(+); N(+); E(+)\r\n#Data: 4F10.3 \r\n",
        n as f64 * dt,
        1.0 / dt
    );
    for k in 0..n {
        let [x, y, z] = [0, 1, 2].map(|c: usize| components_gal[c][k]);
        write!(text, "{:10.3}{x:10.3}{y:10.3}{z:10.3}\r\n", k as f64 * dt).unwrap();
    }
    text
}

/// How a volume 1 writes its samples.
#[derive(Clone, Copy, Debug)]
pub enum Volume {
    /// `10F7.3`, time and g/10, as RENADIC and CSMIP do.
    Pairs,
    /// The same behind a blank, of one channel, as USC does.
    Usc,
    /// `13200 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)`
    Announced,
    /// `10E13.6`, as BHRC does.
    Bhrc,
}

/// Uncorrected volume 1 from pairs of time and g/10, one channel after the other.
pub fn volume_1(channels: &[(&str, Vec<[f64; 2]>)], volume: Volume) -> String {
    let end = "\r\n";
    let mut text = String::new();
    for (place, (name, pairs)) in channels.iter().enumerate() {
        let (n, last) = (pairs.len(), pairs.last().map_or(0.0, |pair| pair[0]));
        let dt = last / (n - 1) as f64;
        let mut lines = vec![String::new(); 13];
        let (unit, length) = match volume {
            Volume::Announced => ("Units of uncor data are sec and g .", last + dt),
            Volume::Bhrc => ("UNITS ARE SECONDS AND G/10", last + dt),
            _ => ("UNITS OF UNCOR ACCEL ARE SEC AND G/10.", last),
        };
        lines[0] = match volume {
            Volume::Usc => "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:".into(),
            Volume::Bhrc => "* VOL1DS FILE:  0001/01".into(),
            _ => "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 01/01/2000".into(),
        };
        lines[1] = "TEST EARTHQUAKE".into();
        (lines[5], lines[6]) = ("NOWHERE".into(), format!("CHAN  {}: {name}", place + 1));
        if matches!(volume, Volume::Usc) {
            lines[6] = format!("COMP {name}                 9");
        }
        if matches!(volume, Volume::Bhrc) {
            (lines[2], lines[4]) = ("Origin Time : 2000/01/01   00:00:00".into(), (*name).into());
            lines[6] = format!("COMP {name}{}", place + 1);
            lines[7] = "Nowhere           Station   38.474 N 47.059 E   Altitude 1360m   Azimuth L 352   T 82 ".into();
        }
        lines[10] = format!("NO. OF POINTS = {n:6}      DURATION = {length:8.3} SEC");
        lines[11] = unit.into();
        text += &(lines.join(end) + end);
        text += &block(&[0.0; 100], 16, 5, end, |v| format!("{v:.0}"));
        text += &block(&[0.0; 50], 8, 10, end, |v| format!("{v:.3}"));
        let values: Vec<f64> = pairs.iter().map(|pair| pair[1]).collect();
        match volume {
            Volume::Pairs | Volume::Usc => {
                for row in pairs.chunks(5) {
                    let blank = if matches!(volume, Volume::Usc) { " " } else { "" };
                    let fields = row.iter().map(|[t, a]| format!("{t:7.3}{a:7.3}"));
                    text += &(blank.to_owned() + &fields.collect::<String>() + end);
                }
            }
            Volume::Announced => {
                write!(
                    text,
                    " {n} Accelerogram points at {:.0} pts/sec in units of g .      Format: (8f9.6)  {end}",
                    1.0 / dt
                )
                .unwrap();
                text += &block(&values, 8, 9, end, |v| format!("{:.6}", v / 10.0));
            }
            Volume::Bhrc => text += &block(&values, 10, 13, end, fortran_e),
        }
        match volume {
            Volume::Usc => {}
            Volume::Bhrc => text += &format!("/&{end}"),
            _ => text += &format!("/&  ----------  END OF DATA FOR CHANNEL  {}  ----------{end}", place + 1),
        }
    }
    text
}
