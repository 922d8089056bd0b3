//! Readers of record files: each layout read back to the last digit, each trap of the archives, each wrong file
//! refused with its line.

use std::path::{Path, PathBuf};

use crate::record_texts::fixtures::*;
use crate::record_texts::writers::*;
use concio::InputError;
use concio::case::HistoryQuantity;
use concio::ground::formats::{parse, read};
use concio::ground::record::{Format, Record, TextOptions};
use proptest::prelude::*;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/records").join(name)
}

/// The files are those that the writers make; `CONCIO_BLESS=1` writes them anew.
#[test]
fn fixtures_are_what_the_writers_make() {
    for file in fixtures() {
        if std::env::var_os("CONCIO_BLESS").is_some() {
            std::fs::write(fixture(file.name), &file.text).unwrap();
        }
        assert_eq!(std::fs::read(fixture(file.name)).unwrap(), file.text.as_bytes(), "{}", file.name);
    }
}

#[test]
fn every_layout_is_read_to_the_last_digit() {
    for file in fixtures() {
        let records = read(&fixture(file.name), &TextOptions::default()).unwrap();
        assert_eq!((records[0].format, records.len()), (file.format, file.channels.len()), "{}", file.name);
        for (record, channel) in records.iter().zip(&file.channels) {
            channel.assert_read(file.name, record);
        }
    }
}

/// What DOS editors put behind a file does not matter, nor does what they fill its last sector with.
#[test]
fn the_end_of_file_mark_of_dos_is_no_sample() {
    for file in fixtures() {
        let plain = read_text(&file.text).unwrap();
        for mark in ["\u{1a}", "\u{1a}\u{1a}\u{1a}\r\n", "\u{1a}\0\0"] {
            assert_eq!(read_text(&(file.text.clone() + mark)).unwrap(), plain, "{}", file.name);
        }
    }
    assert_refused("# units: g\n# dt = 0.01 s\n0.1\n0.2\n\u{1a}0.3\n", 5, "the byte 0x1A");
}

/// A file that lost its end is refused wherever it was cut: in headers, samples, velocities and displacements.
#[test]
fn cut_files_are_refused_whatever_part_was_cut() {
    for file in fixtures().into_iter().filter(|file| file.format != Format::Text) {
        for percent in 1..100 {
            let cut = &file.text[..file.text.len() * percent / 100];
            // What ends with the mark of a channel's end is a whole file of fewer channels.
            assert!(
                read_text(cut).is_err() || cut.trim_end().ends_with("----------"),
                "{} cut at {percent} %",
                file.name
            );
        }
    }
}

/// In layouts of fixed fields even a last number without its last digit is seen.
#[test]
fn a_number_that_lost_its_last_digit_is_seen() {
    for file in fixtures() {
        let free = [Format::PeerAt2, Format::ItacaAsc, Format::KnetCsv, Format::Text];
        if free.contains(&file.format) {
            continue;
        }
        let samples =
            ["/&", "End-of-data"].iter().filter_map(|end| file.text.rfind(end)).min().unwrap_or(file.text.len());
        let last = file.text[..samples].trim_end().len();
        let error = refused(&file.text[..last - 1], &TextOptions::default());
        // An exponent without its digit is no number.
        let told = error.to_string();
        let seen = told.contains("cut off") || told.contains("is not a finite number");
        assert!(error.line.is_some() && seen, "{}: {error}", file.name);
    }
}

/// Damage in a file of a known format is told with the format and the line.
#[test]
fn damage_is_told_with_format_and_line() {
    for file in fixtures().into_iter().filter(|file| file.format != Format::Text) {
        // The last digit of a line of samples: what stands before may be a date, which is not read.
        let start = file.text.len() * 9 / 10;
        let end = start + file.text[start..].find('\n').unwrap();
        let digit = file.text[..end].rfind(|c: char| c.is_ascii_digit()).unwrap();
        let damaged = format!("{}x{}", &file.text[..digit], &file.text[digit + 1..]);
        let line = 1 + file.text[..digit].matches('\n').count();
        let error = refused(&damaged, &TextOptions::default());
        assert_eq!(error.line, Some(line), "{}: {error}", file.name);
        assert!(error.what.ends_with(&format!("(read as {})", file.format.name())), "{error}");
    }
}

#[test]
fn names_in_the_headers() {
    let one = |name: &str| read(&fixture(name), &TextOptions::default()).unwrap().swap_remove(0);
    let names = |record: &Record| [&record.station, &record.event, &record.channel, &record.units].map(String::clone);
    assert_eq!(names(&one("peer.at2")), ["", "TEST EVENT 01/01/20, NOWHERE, 360", "", "G"]);
    assert_eq!(names(&one("itaca.asc")), ["XX.TST", "TEST_EVENT 20200101", "HNE", "cm/s^2"]);
    assert_eq!(
        names(&one("cosmos.v2c")),
        [
            "00-000001 Code:XX-TST Nowhere",
            "Test Event of Wed Jan 1, 2020 12:00 UTC",
            "1: 360 deg (Rcrdr Chan 1) Location: ground",
            "cm/sec2"
        ]
    );
    assert_eq!(
        names(&one("csmip.v2")),
        ["NOWHERE", "TEST EARTHQUAKE JANUARY 1, 2020 12:00 UTC", "CHAN 1: 90 DEG", "CM/SEC/SEC"]
    );
    assert_eq!(names(&one("usgs.smc")), ["Nowhere, 1 First Street", "2020 1 1 1200 Nowhere", "360", "cm/s2"]);
    assert_eq!(names(&one("time_value.csv")), ["", "", "acceleration", "m/s2"]);
}

#[test]
fn csmip_fields_need_no_separators() {
    let text = std::fs::read_to_string(fixture("csmip.v2")).unwrap();
    let glued = |token: &str| token.matches('.').count() >= 2;
    assert!(text.lines().skip(46).take(26).any(|line| line.split_whitespace().any(glued)));
}

#[test]
fn cosmos_interval_is_value_62() {
    let text = cosmos_v2(&decaying_sine(0.005, 50), 0.005, 0.02);
    assert_eq!(read_text(&text).unwrap()[0].dt, 0.005);
}

#[test]
fn peer_headers_with_units_of_their_own() {
    let g = peer_at2(&[0.125; 20], DT, Dialect::Plain, "\n");
    let with = |line: &str| read_text(&g.replace("ACCELERATION TIME SERIES IN UNITS OF G", line));
    for (line, first) in [
        ("The units are (g)", 0.125 * G),
        ("nothing about it", 0.125 * G),
        ("acceleration [cm/s2]", 1.25e-3),
        ("ACCELERATION IN UNITS OF M/S/S.", 0.125),
    ] {
        assert_eq!(with(line).unwrap()[0].acceleration[0], first, "{line}");
    }
    assert!(with("TIME SERIES IN UNITS OF CM/S").unwrap_err().to_string().contains("file:3: `CM/S` is not a unit"));
}

fn read_text(text: &str) -> concio::Result<Vec<Record>> {
    parse(text.as_bytes(), Path::new("file"), &TextOptions::default())
}

/// The title of the time column may name its unit.
#[test]
fn times_in_milliseconds() {
    for title in ["Time [ms],a [m/s2]", "# t (msec), a (m/s2)", "t [s],a [m/s2]", "t,a [m/s2]"] {
        let read = read_text(&format!("{title}\n0,1\n5,2\n10,3\n")).expect("a record");
        let expected = if title.contains("ms") { 0.005 } else { 5.0 };
        assert!((read[0].dt - expected).abs() < 1e-15, "{title}: {}", read[0].dt);
    }
}

fn refused(text: &str, options: &TextOptions) -> InputError {
    match parse(text.as_bytes(), Path::new("file"), options) {
        Err(concio::Error::Input(error)) => *error,
        other => panic!("{other:?} for {text}"),
    }
}

/// The line and a part of the message.
fn assert_refused(text: &str, line: usize, part: &str) {
    let error = refused(text, &TextOptions::default());
    assert_eq!(error.line, Some(line), "{error}");
    assert!(error.to_string().contains(part), "`{error}` does not say `{part}`");
    assert!(error.file.is_some());
}

#[test]
fn counts_that_differ_are_refused_with_both() {
    let cm = decaying_sine(DT, 20);
    for (declared, line) in [(25, 9), (15, 9)] {
        assert_refused(&itaca_asc(&cm, DT, declared), line, &format!("declares {declared} samples, the file holds 20"));
    }
    let huge = itaca_asc(&cm, DT, 20).replace("NDATA: 20", "NDATA: 1000000000000000000");
    assert_refused(&huge, 9, "declares 1000000000000000000 samples, the file holds 20");
    let peer = peer_at2(&cm, DT, Dialect::Plain, "\n");
    assert_refused(
        &peer.replace("NPTS=  20", "NPTS=  1e18"),
        4,
        "declares 1000000000000000000 samples, the file holds 20",
    );
    assert_refused(&peer.replace("NPTS=  20", "NPTS=  19"), 4, "declares 19 samples, the file holds 20");
    let cosmos = cosmos_v2(&cm, DT, DT);
    assert_refused(&cosmos.replace("      20 acc", "      21 acc"), 48, "declares 21 samples, the file holds 20");
    assert_refused(&cosmos.replace("      20 acc", "      19 acc"), 68, "more samples than the 19");
    let csmip = csmip_v2(std::slice::from_ref(&cm), DT, Announced::InBrackets);
    assert_refused(
        &csmip.replacen("   20 POINTS OF ACCEL", "99999 POINTS OF ACCEL", 1),
        46,
        "declares 99999 samples, the file holds 20",
    );
    assert_refused(
        &csmip.replacen("   20 POINTS OF ACCEL", "   16 POINTS OF ACCEL", 1),
        49,
        "more samples than the 16",
    );
    let smc = usgs_smc(&cm, DT);
    let integer = |n: usize| format!("{n:>10}");
    assert_refused(&smc.replacen(&integer(20), &integer(21), 1), 29, "declares 21 samples, the file holds 20");
    assert_refused(&smc.replacen(&integer(20), &integer(16), 1), 14, "declares 16 samples");
}

#[test]
fn samples_that_are_no_numbers_are_refused_with_their_line() {
    let cm = decaying_sine(DT, 20);
    let itaca = itaca_asc(&cm, DT, 20);
    let lines: Vec<&str> = itaca.lines().collect();
    for bad in ["NaN", "inf", "-Infinity", "1e999", "abc", "1.2.3", "--1", "*******"] {
        let mut lines = lines.clone();
        lines[70] = bad;
        assert_refused(&lines.join("\n"), 71, &format!("`{bad}` is not a finite number"));
    }
    assert_refused("# units: g\n# dt = 0.01 s\n0.1\n0.2\nnan\n", 5, "`nan` is not a finite number");
    assert_refused("# units: g\n# dt = 0.01 s\nnan\n0.2\n", 3, "`nan` is not a finite number");
    assert_refused("# units: g\n# dt = 0.01 s\n1.0x\n0.2\n", 3, "`1.0x` is not a finite number");
    assert_refused("t [s]\ta [g]\n0,00\t0,1\n0,01\t0.2\n", 3, "part the columns by semicolons");
    // What is wrong there is no comma.
    let error = refused("t [s],a [g]\n0.00,0.1\n0.01,0.2x\n", &TextOptions::default());
    assert!(!error.to_string().contains("commas"), "{error}");
    assert_refused("# units: g\n# dt = 0.01 s\n0.1\n0.2\nend of file\n", 5, "column");
    let peer = peer_at2(&[0.125; 20], DT, Dialect::Plain, "\n");
    assert_refused(&peer.replacen(".1250000E+00", "NaN", 1), 5, "`NaN` is not a finite number");
    let cosmos = cosmos_v2(&[0.125; 20], DT, DT).replacen("1.250000e-01", "         nan", 1);
    assert_refused(&cosmos, 49, "`nan` is not a finite number");
    let csmip = csmip_v2(&[vec![0.125; 20]], DT, Announced::InBrackets).replacen("0.125", "*****", 1);
    assert_refused(&csmip, 47, "`*****` is not a finite number");
    let smc = usgs_smc(&[0.125; 20], DT).replacen("1.2500E-1", "1.2500E-x", 1);
    assert_refused(&smc, 30, "`1.2500E-x` is not a finite number");
}

#[test]
fn cosmos_gaps_are_refused() {
    let mut cm = decaying_sine(DT, 20);
    cm[4] = -999.0;
    assert_refused(&cosmos_v2(&cm, DT, DT), 53, "unknown sample");
}

#[test]
fn intervals_and_units_out_of_range_are_refused() {
    let cm = decaying_sine(DT, 20);
    for dt in [0.0, -0.01, 1e-7, 1e9] {
        let text = itaca_asc(&cm, DT, 20).replace("INTERVAL_S: 0.010000", &format!("INTERVAL_S: {dt}"));
        assert_refused(&text, 8, "sample interval");
    }
    let counts = itaca_asc(&cm, DT, 20).replace("UNITS: cm/s^2", "UNITS: counts");
    assert_refused(&counts, 12, "`counts` is not a unit of acceleration");
    let velocity = itaca_asc(&cm, DT, 20).replace("DATA_TYPE: ACCELERATION", "DATA_TYPE: VELOCITY");
    assert_refused(&velocity, 13, "VELOCITY");
    let velocity = peer_at2(&cm, DT, Dialect::Plain, "\n")
        .replace("ACCELERATION TIME SERIES IN UNITS OF G", "VELOCITY TIME SERIES IN UNITS OF CM/S");
    assert_refused(&velocity, 3, "not an acceleration history");
    let cosmos = cosmos_v2(&cm, DT, DT).replace(&format!("{:15.6}", 10.0), &format!("{:15.6}", -999.0));
    assert_refused(&cosmos, 38, "does not give the sample interval");
    assert_refused("# units: g\n# dt = 0.01 s\n0.1\n1e7\n", 3, "sample 2");
}

#[test]
fn too_few_samples_are_refused() {
    assert_refused(&itaca_asc(&[], DT, 0), 65, "0 sample(s)");
    assert_refused(&itaca_asc(&[1.0], DT, 1), 65, "1 sample(s)");
    assert_refused("# units: g\n# dt = 0.01 s\n0.1\n", 3, "1 sample(s)");
    assert_refused("time [s], acceleration [g]\n0.0, 0.1\n", 2, "1 sample(s)");
    for nothing in ["", "\n\n", "# only a comment\n", "\u{0}\u{1}\u{2}"] {
        assert!(refused(nothing, &TextOptions::default()).allowed.is_some(), "{nothing:?}");
    }
    let error = parse(&[0xff, 0xfe, b'1', 0], Path::new("file"), &TextOptions::default()).unwrap_err();
    assert!(error.to_string().contains("UTF-16"));
    let error = read(Path::new("no/such/file"), &TextOptions::default()).unwrap_err();
    assert!(matches!(&error, concio::Error::Input(e) if e.file.is_some()), "{error}");
}

#[test]
fn columns_of_text_in_their_spellings() {
    let expected = [0.1, -0.25, 0.5];
    for (text, unit) in [
        ("# dt = 0.01 s\n# units: m/s2\n0.1\n-0.25\n0.5\n", 1.0),
        ("dt: 10 ms\nacceleration [m/s²]\n.1\n-.25D0\n5e-1\n", 1.0),
        ("% sampling rate = 100 Hz, in units of g\n0.1,\n-0.25,\n0.5,\n", G),
        ("time (s)\tacc (cm/s2)\n0.00\t0.1\n0.01\t-0.25\n0.02\t0.5\n", 0.01),
        ("t [s]; a [Gal]\n0,00; 0,1\n0,01; -0,25\n0,02; 0,5\n", 0.01),
        ("t [s]\ta [Gal]\n0,00\t0,1\n0,01\t-0,25\n0,02\t0,5\n", 0.01),
        ("  0.50  0.1\n  0.51  -0.25\r\n  0.52  0.5  \n# units: mg\n", G * 1e-3),
        ("time,\"acceleration [in/s2]\"\n0,0.1\n0.01,-0.25\n2e-2,0.5\n", 0.0254),
    ] {
        let options = TextOptions { units: text.starts_with("  ").then(|| "mg".to_owned()), ..TextOptions::default() };
        let record = &parse(text.as_bytes(), Path::new("file"), &options).unwrap()[0];
        assert!((record.dt - 0.01).abs() < 1e-15, "{text}");
        for (found, expected) in record.acceleration.iter().zip(expected) {
            assert!((found - expected * unit).abs() < 1e-15, "{text}: {found}");
        }
        assert_eq!(record.npts(), 3);
    }
    let channels = read_text("t [s], east [g], north [cm/s2]\n0, 1, 2\n0.1, 3, 4\n").unwrap();
    assert_eq!(channels.iter().map(|c| c.channel.as_str()).collect::<Vec<_>>(), ["east", "north"]);
    assert_eq!(channels[1].acceleration, [0.02, 0.04]);
}

/// As spreadsheets write it: Latin-1, every cell in quotes.
#[test]
fn text_of_spreadsheets_is_read() {
    let plain = parse("t [s];a [m/s²]\n0,00;0,5\n0,01;-0,25\n".as_bytes(), Path::new("file"), &TextOptions::default());
    let latin = parse(b"t [s];a [m/s\xb2]\n0,00;0,5\n0,01;-0,25\n", Path::new("file"), &TextOptions::default());
    assert_eq!(latin.unwrap()[0].acceleration, plain.unwrap()[0].acceleration);
    let quoted = read_text("\"t [s]\",\"a [m/s2]\"\n\"0.00\",\"0.5\"\n\"0.01\",\"-0.25\"\n").unwrap();
    assert_eq!((quoted[0].dt, &quoted[0].acceleration[..]), (0.01, &[0.5, -0.25][..]));
    let error = refused("t [s],a [m/s2]\n\"0,00\",\"0,5\"\n", &TextOptions::default()).to_string();
    assert!(error.contains("save the numbers without quotes"), "{error}");
}

#[test]
fn what_a_text_file_leaves_unsaid_comes_from_the_options() {
    let text = "0.1\n0.2\n0.3\n";
    let options = TextOptions { units: Some("g".into()), dt: Some(0.02), ..TextOptions::default() };
    let record = &parse(text.as_bytes(), Path::new("file"), &options).unwrap()[0];
    assert_eq!((record.dt, record.acceleration[0]), (0.02, 0.1 * G));
    for (options, part) in [
        (TextOptions { units: Some("g".into()), ..TextOptions::default() }, "no sample interval is named"),
        (TextOptions { dt: Some(0.02), ..TextOptions::default() }, "no unit of acceleration is named"),
        (
            TextOptions { dt: Some(0.02), units: Some("parsec".into()), ..TextOptions::default() },
            "`parsec` is not a unit",
        ),
        (TextOptions { dt: Some(f64::NAN), units: Some("g".into()), ..TextOptions::default() }, "sample interval NaN"),
    ] {
        let error = refused(text, &options).to_string();
        assert!(error.contains(part), "{error}");
    }
    let named = "# dt = 0.01 s, units: g\n0.1\n0.2\n";
    let conflict = TextOptions { dt: Some(0.02), ..TextOptions::default() };
    assert!(refused(named, &conflict).to_string().contains("names the interval 0.01 s, the input 0.02 s"));
    let conflict = TextOptions { units: Some("cm/s2".into()), ..TextOptions::default() };
    assert!(refused(named, &conflict).to_string().contains("names the unit `g`, the input `cm/s2`"));
}

#[test]
fn time_columns_that_are_not_even_are_refused() {
    let head = "t [s], a [g]\n";
    assert_refused(&format!("{head}0.00,1\n0.01,1\n0.02,1\n0.04,1\n0.05,1\n"), 5, "steps by 2.000000e-2 s here");
    assert_refused(&format!("{head}0,1\n0,1\n0,1\n"), 3, "does not grow");
    assert_refused(&format!("{head}0.03,1\n0.02,1\n0.01,1\n"), 3, "does not grow");
    assert_refused(&format!("{head}0.00,1\n0.00,1\n0.01,1\n0.01,1\n0.01,1\n0.02,1\n0.02,1\n"), 3, "");
    assert_refused(&format!("{head}0.0,1\n0.01,1\n0.02\n"), 4, "1 column(s) here, 2 in the lines before");
    assert_refused("# dt = 0.02 s\nt [s], a [g]\n0.00,1\n0.01,1\n", 1, "named as 0.02 s");
    // Times printed with three digits at 0.0025 s are even but for rounding.
    let rounded: String = (0..401).map(|k| format!("{:.3},0.5\n", 0.0025 * k as f64)).collect();
    let record = &read_text(&format!("{head}{rounded}")).unwrap()[0];
    assert!((record.dt - 0.0025).abs() < 2e-6);
}

#[test]
fn displacement_histories() {
    let options = TextOptions { quantity: HistoryQuantity::Displacement, ..TextOptions::default() };
    let text = "t [s], u [mm]\n0.0, 1\n0.1, 2\n0.2, 5\n0.3, 5\n";
    let record = &parse(text.as_bytes(), Path::new("file"), &options).unwrap()[0];
    assert_eq!(record.displacement.as_deref().unwrap(), [1e-3, 2e-3, 5e-3, 5e-3]);
    // Natural spline by hand: 4 m1 + m2 = 6·2/h², m1 + 4 m2 = 6·(−3)/h² (mm), h = 0.1 s.
    let m = [0.0, (4.0 * 1200.0 + 1800.0) / 15.0 * 1e-3, (-4.0 * 1800.0 - 1200.0) / 15.0 * 1e-3, 0.0];
    for (found, expected) in record.acceleration.iter().zip(m) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    let error = refused(text, &TextOptions::default()).to_string();
    assert!(error.contains("quantity = \"displacement\""), "{error}");
}

proptest! {
    #[test]
    fn any_signal_survives_writing_and_reading(values in prop::collection::vec(-900.0..900.0_f64, 2..60)) {
        let close = |text: String, factor: f64, digit: f64| -> Result<(), TestCaseError> {
            let record = read_text(&text).map_err(|e| TestCaseError::fail(e.to_string()))?.swap_remove(0);
            prop_assert_eq!(record.npts(), values.len());
            for (found, value) in record.acceleration.iter().zip(&values) {
                prop_assert!((found - value * factor).abs() <= digit * factor * value.abs().max(1.0), "{} {}", found, value);
            }
            Ok(())
        };
        close(peer_at2(&values, DT, Dialect::NumbersFirst, "\r\r\n"), G, 0.6e-6)?;
        close(itaca_asc(&values, DT, values.len()), 0.01, 0.6e-6)?;
        close(cosmos_v2(&values, DT, 0.5), 0.01, 0.6e-6)?;
        close(csmip_v2(&[values.clone(), values.clone()], DT, Announced::InUnits), 0.01, 0.6e-3)?;
        close(usgs_smc(&values, DT), 0.01, 0.6e-4)?;
        close(csv(&values, DT), 1.0, 0.6e-9)?;
    }

    #[test]
    fn cut_and_changed_files_never_panic(index in 0..26_usize, cut in 0.0..1.0_f64, at in 0.0..1.0_f64, byte: u8) {
        let mut bytes = fixtures().swap_remove(index).text.into_bytes();
        let place = (at * (bytes.len() - 1) as f64) as usize;
        bytes[place] = byte;
        let _ = parse(&bytes, Path::new("file"), &TextOptions::default());
        bytes.truncate((cut * bytes.len() as f64) as usize);
        let _ = parse(&bytes, Path::new("file"), &TextOptions::default());
    }
}
