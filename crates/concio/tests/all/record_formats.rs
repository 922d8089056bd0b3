//! What single formats of record files need beside the layouts of `records.rs`: units by code, promised blocks, unequal steps, offsets,
//! components, layouts of text, limits, and what is told of files that are none of them.

use std::path::Path;

use crate::record_texts::fixtures::*;
use crate::record_texts::writers::*;
use concio::InputError;
use concio::case::{HistoryLayout, RecordChannel};
use concio::ground::MOST_SAMPLES;
use concio::ground::channel;
use concio::ground::formats::{parse, read};
use concio::ground::measure;
use concio::ground::record::{Format, Record, Remark, TextOptions};

fn read_text(text: &str) -> concio::Result<Vec<Record>> {
    parse(text.as_bytes(), Path::new("file"), &TextOptions::default())
}

fn given(dt: f64, units: &str, layout: Option<HistoryLayout>) -> TextOptions {
    TextOptions { dt: Some(dt), units: Some(units.into()), layout, ..TextOptions::default() }
}

fn read_with(text: &str, options: &TextOptions) -> concio::Result<Vec<Record>> {
    parse(text.as_bytes(), Path::new("file"), options)
}

fn refused(text: &str, options: &TextOptions) -> InputError {
    match read_with(text, options) {
        Err(concio::Error::Input(error)) => *error,
        other => panic!("{other:?} for {:.200}", text),
    }
}

fn assert_refused(text: &str, line: usize, part: &str) {
    let error = refused(text, &TextOptions::default());
    assert_eq!(error.line, Some(line), "{error}");
    assert!(error.to_string().contains(part), "`{error}` does not say `{part}`");
}

#[test]
fn the_code_of_a_cosmos_unit_counts() {
    let values = [0.0, 0.5, -0.25, 0.125];
    // Table 2 of the format, version 1.20.
    for (unit, si) in [
        ("g.     (02)", G),
        ("g (02)", G),
        ("???(02)", G),
        ("cm/sec2(04)", 0.01),
        ("cm/s/s (04)", 0.01),
        ("in/sec2(07)", 0.0254),
        ("(10)", 0.01),
        ("milli-g(11)", 1e-3 * G),
        ("micro-g(12)", 1e-6 * G),
        ("cm/sec2", 0.01),
    ] {
        let record = &read_text(&cosmos(&values, DT, DT, unit)).unwrap()[0];
        assert!((record.acceleration[1] - 0.5 * si).abs() < 1e-15, "{unit}: {}", record.acceleration[1]);
        assert_eq!(record.remarks, [], "{unit}");
    }
    // Where words and code differ, the code counts, and it is told.
    let record = &read_text(&cosmos(&values, DT, DT, "cm/sec2(02)")).unwrap()[0];
    assert_eq!((record.acceleration[1], record.remarks[..].to_vec()), (0.5 * G, vec![Remark::UnitByCode { code: 2 }]));
    assert_refused(&cosmos(&values, DT, DT, "cm/sec(05)"), 48, "the code 05 is not one of a unit of acceleration");
    assert_refused(&cosmos(&values, DT, DT, "counts (50)"), 48, "volume 0");
}

/// Modern announcements: unit and format on the line of the count, also without the format, also with lines as long as the archive's.
#[test]
fn modern_csmip_files_name_unit_and_format_on_the_line_of_the_count() {
    let values = [0.0, 17.487368, 24.204540, 19.184437, 6.736478, -6.382823, -14.349928, -14.636146, -8.509392];
    let text = csmip_v2(&[values.to_vec()], DT, Announced::WithFormat);
    for text in [text.clone(), text.replacen(" (8f10.6)", "", 1)] {
        let record = &read_text(&text).unwrap()[0];
        let peak = measure(record).pga;
        assert_eq!((record.npts(), record.units.as_str()), (9, "cm/sec2"));
        assert!((peak.value - 0.2420454).abs() < 1e-12 && (peak.time - 0.02).abs() < 1e-12, "{peak:?}");
    }
}

/// The header says that velocity and displacement follow, in words or by their counts; accelerations alone are read where it does not.
#[test]
fn csmip_blocks_that_are_promised_must_be_there() {
    let values = decaying_sine(DT, 16);
    let whole = csmip_v2(std::slice::from_ref(&values), DT, Announced::InBrackets);
    let displacement = whole.find("   16 POINTS OF DISPL").unwrap();
    let velocity = whole.find("   16 POINTS OF VELOC").unwrap();
    for cut in [velocity, displacement] {
        let error = refused(&whole[..cut], &TextOptions::default());
        assert!(error.to_string().contains("promises velocity and displacement"), "{error}");
    }
    let silent = whole.replace("ACCEL, VELOC AND DISPL DATA", "ACCEL DATA");
    let accelerations = &format!("{}/&\r\n", &silent[..silent.find("   16 POINTS OF VELOC").unwrap()]);
    assert_eq!(read_text(accelerations).unwrap()[0].npts(), 16);
    // Integers 64 and 66 are the counts: the 15th of the fourth line, the second of the fifth.
    let line = 25 + 3;
    let counted: Vec<String> = accelerations
        .split("\r\n")
        .enumerate()
        .map(|(k, text)| if k == line { format!("{}   16{}", &text[..75], &text[80..]) } else { text.into() })
        .collect();
    assert!(refused(&counted.join("\r\n"), &TextOptions::default()).to_string().contains("promises"));
}

/// Files whose channels end with a mark are cut behind every line and inside of every mark: refused, but for a cut behind a whole mark. That
/// leaves a file of fewer channels, which is told where the header knows how many there were; so is a first channel without its mark.
#[test]
fn files_with_marks_are_whole_or_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/records");
    let is_mark = |line: &str| line.starts_with("/&") || line.starts_with("End-of-data");
    for (name, channels) in [
        ("csmip.v2", 3),
        ("csmip_2012.v1", 3),
        ("csmip_2012.v2", 2),
        ("csmip_usc.v2", 3),
        ("cosmos.v1", 1),
        ("cosmos.v2c", 1),
        ("renadic.v1", 3),
        ("bhrc.v1", 3),
    ] {
        let text = std::fs::read_to_string(folder.join(name)).unwrap();
        let (mut start, mut ends) = (0, Vec::new());
        for line in text.split_inclusive('\n') {
            let mark = line.trim_end().len();
            let inside = if is_mark(line) { start..start + mark } else { start..start + 1 };
            for cut in inside.filter(|cut| *cut > 0 && !is_mark(text[..*cut].trim_end().lines().last().unwrap())) {
                // Behind the first channel nothing says that there should be a mark: read, and told.
                let whole = |records: Vec<Record>| records.len() == 1 && records[0].remarks == [Remark::Unmarked];
                let first = ends.is_empty() && !name.starts_with("cosmos");
                assert!(read_text(&text[..cut]).map_or(true, |records| first && whole(records)), "{name} cut at {cut}");
            }
            // A mark of BHRC is whole with its second character.
            for cut in (start + 1..start + mark).filter(|_| is_mark(line) && mark > 2) {
                let cut_mark = text[start..cut].trim_end();
                // So is one of COSMOS with the number of its channel.
                let whole = cut_mark == "/&" || cut_mark.ends_with("Chan  1");
                assert!(whole || read_text(&text[..cut]).is_err(), "{name} cut at {cut}: {cut_mark}");
            }
            start += line.len();
            ends.extend(is_mark(line).then_some(start));
        }
        assert_eq!(ends.len(), channels, "{name}");
        for (k, end) in ends.iter().enumerate() {
            assert_eq!(read_text(&text[..*end]).unwrap().len(), k + 1, "{name}");
        }
    }
    let cut = |name: &str, mark: &str| {
        let text = std::fs::read_to_string(folder.join(name)).unwrap();
        let end = text.match_indices(mark).nth(1).map_or(text.len(), |(at, _)| at);
        read_text(&text[..end]).unwrap()
    };
    for (name, mark) in [("geonet.v2a", "Corrected accelerogram"), ("geonet.v1a", "Uncorrected accelerogram")] {
        let records = cut(name, mark);
        assert_eq!(records.len(), 1, "{name}");
        assert_eq!(records[0].remarks, [Remark::Fewer { recorded: 3, found: 1 }], "{name}");
    }
}

/// Counts that no memory holds, where a format declares them, are counted and not believed.
#[test]
fn huge_counts_take_no_memory() {
    for file in fixtures() {
        for count in ["200", "201", "300", "150"] {
            for huge in ["999999999999", "99999", "1e18"] {
                let _ = read_text(&file.text.replacen(count, huge, 1));
            }
        }
    }
}

#[test]
fn offsets_of_knet_are_taken_off_and_told() {
    let values = [1.0, -3.0, 4.0, 2.0, -1.0, 0.5, -2.0, -1.5].map(|gal| 10.0 * gal).repeat(25);
    let record = &read_text(&knet(&values, DT, "N-S", -7.7)).unwrap()[0];
    // The values sum to zero: 40 gal is the peak, as the header says, and the offset is all that they stand on.
    let count = 3920.0 / 6_182_761.0 * 0.01;
    assert!((measure(record).pga.value - 0.4).abs() < count && (record.offset() + 0.077).abs() < count);
    assert!(matches!(record.remarks[..], [Remark::Offset { .. }]), "{:?}", record.remarks);
    let told = record.remarks[0].to_string();
    assert!(told.contains("an offset of -0.077 m/s² (-7.7 gal)"), "{told}");
    let short = knet(&values[..192], DT, "N-S", 0.0).replace("Duration Time(s)  2", "Duration Time(s)  3");
    assert_refused(&short, 12, "declares 300 samples, the file holds 192");
    for (key, wrong) in
        [("100Hz", "fast"), ("3920(gal)/6182761", "3920/6182761"), ("Duration Time(s)  2", "Duration Time(s)  x")]
    {
        let error = refused(&knet(&values, DT, "N-S", 0.0).replace(key, wrong), &TextOptions::default());
        assert!(error.line.is_some_and(|line| (11..15).contains(&line)), "{error}");
    }
}

#[test]
fn rows_of_knet_csv_stand_at_their_times() {
    let values: Vec<f64> = decaying_sine(DT, 200).iter().map(|a| 100.0 * a).collect();
    let text = knet_csv([&values, &values, &values], DT);
    let swapped = text.replacen(",0.50,", ",0.05,", 1);
    assert_refused(&swapped, 67, "the time is 0.05 s where 0.5 s is due");
    let names: Vec<String> = (1..=6).map(|k| format!("{k}(gal)")).collect();
    let kiknet = text.replace("N-S(gal),E-W(gal),U-D(gal)\n2000", &format!("{}\n2000", names[..3].join(",")));
    let labels: Vec<String> = read_text(&kiknet).unwrap().into_iter().map(|record| record.channel).collect();
    assert_eq!(labels, ["NS1 (borehole)", "EW1 (borehole)", "UD1 (borehole)"]);
}

#[test]
fn surplus_rows_of_unam_are_left_away_and_told() {
    let values: Vec<f64> = decaying_sine(DT, 200).iter().map(|a| 100.0 * a).collect();
    let text = unam([&values, &values, &values], DT);
    let last = text.trim_end().rsplit("\r\n").next().unwrap().to_owned() + "\r\n";
    let longer = read_text(&(text.clone() + &last + &last)).unwrap();
    assert_eq!(longer[0].remarks, [Remark::Surplus { samples: 2 }]);
    assert_eq!(longer[0].acceleration, read_text(&text).unwrap()[0].acceleration);
    assert_refused(&(text.clone() + &last.repeat(11)), 11, "declares 200 samples, the file holds 211");
    assert_refused(&text.replace("2.00/2.00/2.00", "4.00/4.00/4.00"), 10, "the header says 4 s");
}

/// Film at unequal steps: equal ones on which every sample lies, so that the peak is the file's to the last bit.
#[test]
fn unequal_steps_are_made_equal_and_told() {
    let pairs = film();
    let record = &read_text(&volume_1(&[("N00W", pairs.clone())], Volume::Usc)).unwrap()[0];
    let peak = pairs.iter().fold([0.0, 0.0_f64], |peak, pair| if pair[1].abs() > peak[1].abs() { *pair } else { peak });
    let found = measure(record).pga;
    assert!(
        (found.value - 0.1 * G * peak[1]).abs() < 1e-12 && (found.time - peak[0]).abs() < 1e-12,
        "{found:?} {peak:?}"
    );
    assert_eq!(record.in_file().0, 300);
    assert!((record.in_file().1 - pairs[299][0] / 299.0).abs() < 1e-12);
    let remark = Remark::Resampled { samples: 300, steps: [0.004, 0.012], dt: 0.001, exact: true };
    assert_eq!(record.remarks, [remark]);
    assert!(
        remark
            .to_string()
            .contains("300 samples stand at unequal steps of 0.004 s to 0.012 s: it is resampled every 0.001 s")
    );
    // Steps of 0.02 s and 0.06 s are multiples of 0.02 s.
    let coarse: Vec<[f64; 2]> = [0.0, 0.02, 0.04, 0.1, 0.12].iter().map(|t| [*t, 1.0 - t]).collect();
    let record = &read_text(&volume_1(&[("N00W", coarse)], Volume::Pairs)).unwrap()[0];
    assert_eq!((record.dt, record.npts()), (0.02, 7));
    assert!((record.acceleration[3] - 0.1 * G * 0.94).abs() < 1e-12);
    // One pair late by ten minutes would make half a million samples of six: a step that does not is taken, and said to cut peaks.
    let far = [0.0, 0.001, 0.002, 0.003, 0.004, 600.0].map(|t| [t, 0.5]).to_vec();
    let record = &read_text(&volume_1(&[("N00W", far)], Volume::Pairs)).unwrap()[0];
    assert!(record.npts() <= 121 && record.remarks[0].to_string().contains("cuts peaks short"), "{:?}", record.remarks);
}

#[test]
fn times_of_volume_1_grow_and_may_start_anywhere() {
    let pairs = |times: [f64; 7]| vec![("EW", times.into_iter().map(|t| [t, 0.5]).collect::<Vec<_>>())];
    let late = &read_text(&volume_1(&pairs([5.0, 5.01, 5.02, 5.03, 5.04, 5.05, 5.06]), Volume::Pairs)).unwrap()[0];
    assert_eq!((late.remarks.clone(), late.npts()), (vec![Remark::Start { time: 5.0 }], 7));
    let error =
        refused(&volume_1(&pairs([0.0, 0.01, 0.02, 0.02, 0.03, 0.04, 0.05]), Volume::Pairs), &TextOptions::default());
    assert!(error.line == Some(28) && error.to_string().contains("the time does not grow"), "{error}");
    // Times of three digits touch the values before them.
    let glued = volume_1(&pairs([0.0, 20.0, 40.0, 60.0, 80.0, 100.0, 120.0]), Volume::Pairs);
    assert!(glued.contains("  0.500120.000"));
    assert_eq!(read_text(&glued).unwrap()[0].dt, 20.0);
}

/// The first horizontal component of every file that has several.
#[test]
fn the_component_taken_is_horizontal() {
    for (name, place) in [
        ("csmip.v2", 0),
        ("knet.csv", 0),
        ("geonet.v2a", 0),
        ("nsmn.txt", 0),
        ("unam.asa", 1),
        ("cwb.dat", 1),
        ("renadic.v1", 0),
        ("bhrc.v1", 0),
        ("kiknet.ud2", 0),
    ] {
        let file = fixtures().into_iter().find(|file| file.name == name).unwrap();
        let records = read_text(&file.text).unwrap();
        assert_eq!(channel::choose(&records, None), Ok(place), "{name}");
        file.channels[place].assert_read(name, &records[place]);
        for (k, channel) in file.channels.iter().enumerate() {
            let named = |name: &str| channel::choose(&records, Some(&RecordChannel::Name(name.into())));
            assert_eq!(named(channel.label), Ok(k), "{name}");
        }
    }
    let unam = read_text(&fixtures().into_iter().find(|file| file.name == "unam.asa").unwrap().text).unwrap();
    for (name, place) in [("C3", 2), ("n90e", 2), ("V", 0), ("2", 1)] {
        assert_eq!(channel::choose(&unam, Some(&RecordChannel::Name(name.into()))), Ok(place), "{name}");
    }
}

const COLUMNS: &str = "       N-S          E-W          U-D\n  0.10  0.20 0.30\n -0.40 -0.50 0.60\n  0.20  0.10 0.05\n";

#[test]
fn columns_without_time_are_components() {
    let records = read_with(COLUMNS, &given(0.01, "gal", None)).unwrap();
    assert_eq!(records.iter().map(|record| record.channel.as_str()).collect::<Vec<_>>(), ["N-S", "E-W", "U-D"]);
    assert_eq!((records[1].acceleration[1], records[2].dt), (-0.5 * 0.01, 0.01));
    let named = format!("# dt = 0.01 s\n# units: gal\n{COLUMNS}");
    assert_eq!(read_text(&named).unwrap()[1].acceleration, records[1].acceleration);
    // Without an interval there is nothing to go by; what is missing is said, not that time does not grow.
    let error = refused(COLUMNS, &TextOptions { units: Some("gal".into()), ..TextOptions::default() });
    assert!(error.to_string().contains("3 columns, none of them time, and no sample interval is named"), "{error}");
    // A time column stays one beside a known interval, also where a sample is missing.
    let timed = "t  a\n0.00 0.1\n0.01 0.2\n0.02 0.3\n";
    assert_eq!(read_with(timed, &given(0.01, "g", None)).unwrap().len(), 1);
    let untitled: String =
        (0..60).filter(|k| *k != 31).map(|k| format!("{:.2} {:.2}\n", 0.01 * k as f64, (k as f64).sin())).collect();
    let error = refused(&untitled, &given(0.01, "g", None));
    assert!(error.line == Some(32) && error.what.contains("steps by 2.000000e-2"), "{error}");
    assert!(refused(timed, &given(0.02, "g", None)).what.contains("named as 0.02 s"));
}

/// Files of other quantities are no accelerograms, whatever unit the caller gives; columns of them beside accelerations are left out.
#[test]
fn other_quantities_are_refused() {
    let rows: String = (0..50).map(|n| format!("{:.2} {:.4}\n", 0.01 * f64::from(n), f64::from(n).sin())).collect();
    let options = TextOptions { units: Some("cm/s2".into()), ..given(0.01, "cm/s2", None) };
    for (title, part) in [
        ("t [s]  v [cm/s]", "velocity"),
        ("time velocity", "velocity"),
        ("T Sa", "a spectrum"),
        ("T [s]  Sa [g]", "a spectrum"),
        ("time (s) velocity (cm/s)", "velocity"),
        ("time in seconds  velocity (cm/s)", "velocity"),
        ("Velocity (cm/s), dt = 0.01", "velocity"),
        ("disp_mm force_kN", "the first column is displacement"),
        ("freq_Hz amplitude", "the first column is a spectrum"),
    ] {
        let error = refused(&format!("{title}\n{rows}"), &TextOptions { dt: None, ..options.clone() });
        assert!(error.to_string().contains(part), "{title}: {error}");
        assert_eq!(error.line, Some(1), "{title}");
    }
    let both: String =
        (0..50).map(|n| format!("{:.2},{:.4},{:.4}\n", 0.01 * f64::from(n), f64::from(n).sin(), 7.0)).collect();
    for title in [
        "time [s],acc [cm/s2],vel [cm/s]",
        "t [s]  a [cm/s2]  v [cm/s]",
        "t (s) SA01 (cm/s2) vel1",
        "t (s) 1_acc (cm/s2) 1_vel",
        "[s] [cm/s2] [cm/s]",
    ] {
        let records = read_text(&format!("{title}\n{both}")).expect("an accelerogram");
        assert_eq!(records.len(), 1, "{title}");
    }
}

#[test]
fn one_component_row_by_row() {
    let values = decaying_sine(DT, 100);
    let rows: String =
        values.chunks(8).map(|row| row.iter().map(|a| format!("{a:10.5}")).collect::<String>() + "\n").collect();
    let expected: Vec<f64> = values.iter().map(|a| (1e5 * a).round() / 1e5).collect();
    let of_option = read_with(&rows, &given(DT, "m/s2", Some(HistoryLayout::Rows))).unwrap();
    let of_header = read_text(&format!("# layout: rows, dt = 0.01 s, units: m/s2\n{rows}")).unwrap();
    assert_eq!((of_option.len(), &of_option), (1, &of_header));
    for (found, expected) in of_option[0].acceleration.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-12);
    }
    assert_eq!(of_option[0].npts(), 100);
    // Eight columns without titles are not guessed at, nor are three that change less along the rows.
    let [eight, three] = [8, 3].map(|n| {
        let whole = values.len() - values.len() % n;
        let row = |row: &[f64]| row.iter().map(|a| format!("{a:10.5}")).collect::<String>() + "\n";
        values[..whole].chunks(n).map(row).collect::<String>()
    });
    for (text, columns) in [(&eight, 8), (&three, 3)] {
        let error = refused(text, &given(DT, "m/s2", None));
        assert!(
            error.key.as_deref() == Some("layout") && error.what.contains(&format!("{columns} columns")),
            "{error}"
        );
        assert!(
            error.help.is_some_and(|help| help.contains("layout = \"rows\"") && help.contains("layout = \"columns\""))
        );
        let columns_then = read_with(text, &given(DT, "m/s2", Some(HistoryLayout::Columns))).unwrap();
        assert_eq!(columns_then.len(), columns);
    }
    // Without an interval the layout is named in what is said of the time column.
    let error = refused(&eight, &TextOptions { units: Some("g".into()), ..TextOptions::default() });
    assert!(error.help.as_deref().is_some_and(|help| help.contains("layout = \"rows\"")), "{error}");
    let both = format!("# layout: columns\n{rows}");
    assert!(refused(&both, &given(DT, "m/s2", Some(HistoryLayout::Rows))).what.contains("its layout is columns"));
}

#[test]
fn decimal_commas_are_read_or_asked_about() {
    let values = "0,5\n-0,25\n0,125\n";
    let error = refused(values, &given(DT, "g", None));
    assert!(error.what.contains("one with decimal commas"), "{error}");
    let unknown = refused(values, &TextOptions { units: Some("g".into()), ..TextOptions::default() });
    assert!(unknown.help.is_some_and(|help| help.starts_with("of decimal commas make points")));
    assert_eq!(read_with(&values.replace('\n', ";\n"), &given(DT, "g", None)).unwrap()[0].acceleration[2], 0.125 * G);
    let tabs = "t\ta [m/s2]\n0,00\t0,5\n0,01\t-1,25e-1\n0,02\t3\n";
    assert_eq!(read_text(tabs).unwrap()[0].acceleration, [0.5, -0.125, 3.0]);
}

#[test]
fn a_time_column_that_starts_elsewhere_is_told() {
    let text = |start: f64| -> String {
        let rows = (0..5).map(|k| format!("{:.2},{k}\n", start + 0.01 * f64::from(k)));
        "t [s],a [m/s2]\n".to_owned() + &rows.collect::<String>()
    };
    assert_eq!(read_text(&text(0.0)).unwrap()[0].remarks, []);
    let late = &read_text(&text(12.5)).unwrap()[0];
    assert_eq!(late.remarks, [Remark::Start { time: 12.5 }]);
    assert!(late.remarks[0].to_string().contains("its time starts at 12.5 s"));
}

/// Steps that all pass for rounding may add up: 0.004 s for a while, then 0.005 s.
#[test]
fn a_time_column_that_drifts_off_is_refused() {
    let mut ticks = 0;
    let mut rows = String::from("t [s],a [m/s2]\n");
    for k in 0..200 {
        rows += &format!("{:.3},1\n", f64::from(ticks) / 1000.0);
        ticks += if k < 100 { 4 } else { 5 };
    }
    let error = refused(&rows, &TextOptions::default());
    assert!(error.what.contains("with equal steps"), "{error}");
}

#[test]
fn files_that_are_too_large_are_refused_at_once() {
    let zeros = "# dt = 0.01\n# units: g\n".to_owned() + &"0\n".repeat(MOST_SAMPLES);
    let error = refused(&zeros, &TextOptions::default());
    assert!(
        error.what.contains("the file has 10000002 lines") && error.to_string().contains("up to 10000000 samples"),
        "{error}"
    );
    let line = "# layout: rows, dt = 0.01, units: g\n".to_owned() + &"0 ".repeat(MOST_SAMPLES + 1);
    assert!(refused(&line, &TextOptions::default()).what.contains("more than 10000000 samples"));
    // A line of many numbers is one component or nothing; so is a table of many columns.
    for rows in [1, 5] {
        let wide = "# dt = 0.01 units: g\n".to_owned() + &("0 ".repeat(200_000) + "\n").repeat(rows);
        let error = refused(&wide, &TextOptions::default());
        assert!(error.line == Some(2) && error.to_string().contains("up to 1000 columns"), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_refused_without_being_opened() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()));
    for (path, part) in [
        (pipe.as_path(), "a pipe or a device, not a file"),
        (Path::new("/dev/zero"), "a pipe or a device, not a file"),
        (folder.path(), "a folder, not a file"),
    ] {
        let error = read(path, &TextOptions::default()).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
    }
    let error = concio::case::read(&pipe).unwrap_err();
    assert!(error.to_string().contains("is a pipe or a device, not a wall file"), "{error}");
    // Longer than any input file, without taking up the disk.
    let long = folder.path().join("long.txt");
    std::fs::File::create(&long).and_then(|file| file.set_len(concio::files::LARGEST_INPUT + 1)).unwrap();
    assert!(read(&long, &TextOptions::default()).unwrap_err().to_string().contains("larger than 256 MiB"));
}

/// A file without the marks of a format is told what it looks like.
#[test]
fn files_of_no_known_format_are_told_what_they_resemble() {
    let knet = knet(&[1.0; 200], DT, "N-S", 0.0);
    let damaged: String = knet
        .lines()
        .filter(|line| !line.contains("(gal)") && !line.contains("Freq"))
        .map(|l| format!("{l}\n"))
        .collect();
    let damaged = damaged.replace("Station Code", "Stat. Code  ");
    for (text, part) in [
        (damaged.as_str(), "resembles K-NET/KiK-net ASCII: it has `ORIGIN TIME`"),
        (
            "TIMESERIES XX_TST__HNE_D, 3 samples, 100 sps, SLIST, FLOAT, M/S**2\n1 2 3\n",
            "SLIST or TSPAIR: it is not read",
        ),
        ("Response and Fourier amplitude spectra (78 periods)\n5 6\n7\n", "CSMIP volume 3, spectra"),
        ("#StationCode: XXX\n", "resembles CWB text"),
    ] {
        let error = refused(text, &TextOptions::default()).to_string();
        assert!(error.contains(part), "`{error}` does not say `{part}`");
    }
    let plain = refused("0.1 x\n", &TextOptions::default()).to_string();
    assert!(!plain.contains("resembles"), "{plain}");
    assert!(refused("", &TextOptions::default()).allowed.is_some_and(|allowed| allowed.contains("GeoNet V1A/V2A")));
}

#[test]
fn formats_have_names_of_their_own() {
    let names: std::collections::BTreeSet<&str> = fixtures().iter().map(|file| file.format.name()).collect();
    assert_eq!(names.len(), 13);
    assert!(names.contains(Format::Volume1.name()));
}
