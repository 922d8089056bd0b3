//! `concio record`, and what `check` says of records: components, offsets, steps of processing, files that are none.

use std::path::{Path, PathBuf};

use serde_json::Value;
use snapbox::cmd::Command;

use crate::support::{Desk, PROGRAM};

/// Three components in gal without time; the second stands on an offset.
const COLUMNS: &str =
    "# dt = 0.01 s, units: gal\n U-D   N-S   E-W\n 10    50   -30\n -20   70    60\n 30    30   -90\n 5     50    20\n";

fn told(command: Command, status: i32) -> [String; 2] {
    let done = command.assert().code(status);
    [&done.get_output().stdout, &done.get_output().stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned())
}

fn json(command: Command) -> Value {
    serde_json::from_str(&told(command, 0)[0]).expect("JSON")
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} of {value}"))
}

#[test]
fn components_are_chosen_by_name_or_number_and_the_one_taken_is_told() {
    let desk = Desk::new();
    desk.put("three.txt", COLUMNS);
    for (line, place, name) in [
        ("record three.txt --json", 2, "N-S"),
        ("record three.txt --json --channel 3", 3, "E-W"),
        ("record three.txt --json --channel e-w", 3, "E-W"),
        ("record three.txt --json --channel U-D", 1, "U-D"),
    ] {
        let found = json(desk.concio(line));
        assert_eq!((found["channel"].as_u64(), found["component"].as_str()), (Some(place), Some(name)), "{line}");
    }
    let [_, notes] = told(desk.concio("record three.txt"), 0);
    let note = "note: channel 2 is taken, the first horizontal one; --channel chooses of 1 `U-D`, 2 `N-S`, 3 `E-W`";
    assert!(notes.contains(note), "{notes}");
    assert!(!told(desk.concio("record three.txt --channel N-S"), 0)[1].contains("is taken"));
    for wrong in ["4", "Z", "0"] {
        let [_, error] = told(desk.concio(&format!("record three.txt --channel {wrong}")), 2);
        assert!(error.contains("--channel") && error.contains("allowed: "), "{error}");
    }
}

/// By hand: 50, 70, 30 and 50 gal have a mean of 50 gal; without it 20 gal at 0.01 s is the peak.
#[test]
fn json_has_peaks_with_their_times_and_without_the_mean() {
    let desk = Desk::new();
    desk.put("three.txt", COLUMNS);
    let found = json(desk.concio("record three.txt --json"));
    for (key, expected) in [
        ("npts", 4.0),
        ("dt", 0.01),
        ("duration", 0.03),
        ("pga", 0.7),
        ("pga_signed", 0.7),
        ("pga_time", 0.01),
        ("mean", 0.5),
        ("pga_without_mean", 0.2),
        ("pga_without_mean_signed", 0.2),
        ("pga_without_mean_time", 0.01),
        ("offset", 0.0),
    ] {
        assert!((number(&found, key) - expected).abs() < 1e-12, "{key}: {}", found[key]);
    }
    assert_eq!(found["components"].as_array().map(Vec::len), Some(3));
    assert!(found["resampled"].is_null() && found["remarks"].as_array().is_some_and(Vec::is_empty));
    let down = json(desk.concio("record three.txt --json --channel E-W"));
    assert!((number(&down, "pga_signed") + 0.9).abs() < 1e-12 && (number(&down, "pga") - 0.9).abs() < 1e-12);
    // The table says what the offset does, and what to do.
    let [table, _] = told(desk.concio("record three.txt"), 0);
    for part in ["PGA without it", "has an offset: its mean is 0.5 m/s² (0.051 g, 71 % of its peak)", "polynomial = 0"]
    {
        assert!(table.contains(part), "{part}:\n{table}");
    }
}

#[test]
fn an_interval_may_bear_a_unit() {
    let desk = Desk::new();
    desk.put("column.txt", "0.0\n1.0\n-2.0\n0.5\n");
    for dt in ["0.01", "0.01s", "10ms"] {
        let found = json(desk.concio(&format!("record column.txt --dt {dt} --units cm/s2 --json")));
        assert_eq!((found["dt"].as_f64(), found["pga"].as_f64()), (Some(0.01), Some(0.02)), "{dt}");
    }
    let [_, error] = told(desk.concio("record column.txt --dt 0.01kg --units cm/s2"), 2);
    assert!(error.contains("--dt") && error.contains("allowed"), "{error}");
}

/// One component row by row, as archives print it, and the hint at it in the words of the command line.
#[test]
fn rows_of_one_component() {
    let desk = Desk::new();
    desk.put("rows.txt", "0.1 0.2 0.3 0.4\n0.5 0.6 0.7 -0.8\n0.9 0.2\n");
    let found = json(desk.concio("record rows.txt --dt 0.01 --units gal --layout rows --json"));
    assert_eq!((found["npts"].as_u64(), found["channels"].as_u64()), (Some(10), Some(1)));
    assert!((number(&found, "pga") - 0.009).abs() < 1e-12 && (number(&found, "pga_time") - 0.08).abs() < 1e-12);
    let [_, error] = told(desk.concio("record rows.txt --dt 0.01 --units gal"), 2);
    assert!(error.contains("give --layout rows") && !error.contains("to the input"), "{error}");
}

/// The base is shaken by 100 samples of 5 m/s² and -3 m/s² in turn, 0.01 s apart: 4 m/s² about an offset of 1 m/s².
fn shaken(desk: &Desk, keys: &str) -> String {
    let rows: String = (0..100).map(|k| if k % 2 == 0 { "5\n" } else { "-3\n" }).collect();
    desk.put("quake.txt", format!("# dt = 0.01 s, units: m/s2\n{rows}"));
    let wall = desk.get("wall.toml");
    let (head, _) = wall.split_once("[load]").expect("the wall has loads");
    let wall = format!("{head}[load]\ntop = \"10 kN/m\"\n[motion]\nbase = {{ record = \"quake.txt\"{keys} }}\n");
    desk.put("shaken.toml", &wall);
    wall
}

/// From 0.2 s to 0.8 s there are 31 samples of 5 m/s² and 30 of -3 m/s²: their mean is 65/61 m/s², the peak without it 3 + 65/61 m/s².
#[test]
fn check_tells_each_step_of_processing_with_its_numbers() {
    let desk = Desk::new();
    shaken(
        &desk,
        ", trim = [\"0.2 s\", \"0.8 s\"], reverse = true, baseline = { polynomial = 0 }, resample = \"5 ms\", pga = \"0.3 g\"",
    );
    let [out, _] = told(desk.concio("check shaken.toml"), 0);
    for part in [
        "in the file 100 samples every 0.01 s, 0.99 s, PGA 5.000 m/s² = 0.5097 g at 0 s",
        "trimmed from 0.2 s to 0.8 s: 100 → 61 samples, PGA 5.000 m/s²",
        "played backwards: 61 samples, PGA 5.000 m/s²",
        "polynomial of degree 0 taken off: 61 samples, PGA 5.000 → 4.066 m/s²",
        "resampled every 0.005 s: 61 → 121 samples, PGA 4.066 m/s²",
        "121 samples every 0.005 s, 0.6 s",
        "scale factor ",
        "2.943 m/s² = 0.3000 g",
    ] {
        assert!(out.contains(part), "{part}:\n{out}");
    }
    shaken(&desk, ", baseline = { high_pass = \"1 Hz\", order = 2 }");
    let [out, _] = told(desk.concio("check shaken.toml"), 0);
    assert!(out.contains("high-passed at 1 Hz, order 2, both ways: 100 samples, PGA 5.000 → "), "{out}");
    shaken(&desk, "");
    assert!(!told(desk.concio("check shaken.toml"), 0)[0].contains("in the file"));
}

/// A header that names another unit than that of its numbers: a peak that hardly shakes, or one that hardly an earthquake had.
#[test]
fn a_record_whose_header_names_the_wrong_unit_is_told() {
    let desk = Desk::new();
    let warned = |unit: &str, size: f64| {
        let rows: String = (0..200).map(|k| format!("{}\n", size * (0.3 * f64::from(k)).sin())).collect();
        desk.put("quake.txt", format!("# dt = 0.01 s, units: {unit}\n{rows}"));
        told(desk.concio("record quake.txt"), 0)[1].clone()
    };
    let weak = warned("cm/s2", 3.4323);
    assert!(weak.contains("warning: the unit in the file is \"cm/s2\", in which the record's peak acceleration is 0.0035 g: it hardly moves a wall. Is it 0.35 g? Then its unit is \"m/s2\""), "{weak}");
    let strong = warned("g", 3.4323);
    assert!(
        strong.contains("warning: the record's peak acceleration is 3.43 g, more than 2 g, which few records have"),
        "{strong}"
    );
    assert_eq!([warned("m/s2", 3.4323), warned("g", 0.35)], ["", ""]);
    // Told once, and with the option that gave it.
    let weak = warned("cm/s2", 0.8);
    assert!(weak.contains("hardly moves a wall") && !weak.contains("less than 0.01 m/s²"), "{weak}");
    let rows: String = (0..200).map(|k| format!("{}\n", 3.4323 * (0.3 * f64::from(k)).sin())).collect();
    desk.put("bare.txt", rows);
    let [_, said] = told(desk.concio("record bare.txt --dt 0.01 --units gal"), 0);
    assert!(said.contains("Then --units is \"m/s2\""), "{said}");
}

/// An offset drifts because it pushes: that is said, not that a filter hardly touches the acceleration.
#[test]
fn a_record_with_an_offset_says_what_it_does_to_the_acceleration() {
    let desk = Desk::new();
    shaken(&desk, "");
    let [_, warned] = told(desk.concio("check shaken.toml"), 0);
    assert!(
        warned.contains("has an offset: its mean is 1 m/s² (0.102 g, 20 % of its peak)")
            && warned.contains("of 5 m/s² includes it (4 m/s² without)")
            && warned.contains("polynomial = 0"),
        "{warned}"
    );
    assert!(!warned.contains("hardly touches"), "{warned}");
    shaken(&desk, ", baseline = { polynomial = 0 }");
    assert!(!told(desk.concio("check shaken.toml"), 0)[1].contains("offset"));
}

#[test]
fn a_wall_names_components_too_and_is_told_of_doubtful_ones() {
    let desk = Desk::new();
    let wall = shaken(&desk, "");
    desk.put("three.txt", COLUMNS);
    let check = |keys: &str, status: i32| {
        desk.put("wall.toml", wall.replace("record = \"quake.txt\"", &format!("record = \"three.txt\"{keys}")));
        told(desk.concio("check wall.toml"), status)
    };
    let [out, warned] = check(", channel = \"E-W\"", 0);
    assert!(out.contains("three.txt, text, channel 3 of 3 E-W") && !warned.contains("none is chosen"), "{out}{warned}");
    assert!(check(", channel = 3", 0)[0].contains("channel 3 of 3 E-W"));
    let [out, warned] = check("", 0);
    let part = "motion.base: the record has 3 channels and none is chosen: channel 2 `N-S` is taken, the first horizontal one (`channel = 2`)";
    assert!(out.contains("channel 2 of 3 N-S") && warned.contains(part), "{out}{warned}");
    // Chosen, and still hardly what shakes a wall to and fro.
    let upright = "motion.base: the record's chosen component is a vertical one by its name, `U-D`";
    assert!(check(", channel = \"U-D\"", 0)[1].contains(upright));
    let [_, error] = check(", channel = \"Z\"", 2);
    assert!(error.contains("motion.base.channel") && error.contains("three.txt has no channel `Z`"), "{error}");
    assert!(check(", channel = true", 2)[1].contains("the number of a component, from 1, or its name"));
    desk.put("up.txt", "# dt = 0.01 s, units: gal\nU-D\n10\n-20\n30\n");
    desk.put("wall.toml", wall.replace("quake.txt", "up.txt"));
    assert!(told(desk.concio("check wall.toml"), 0)[1].contains("only component is a vertical one by its name, `U-D`"));
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_at_once() {
    let desk = Desk::new();
    let wall = shaken(&desk, "");
    assert!(std::process::Command::new("mkfifo").arg(desk.path("pipe")).status().is_ok_and(|status| status.success()));
    for device in ["/dev/zero", "/dev/urandom", "pipe"] {
        desk.put("device.toml", wall.replace("quake.txt", device));
        let [_, error] = told(desk.concio("check device.toml"), 2);
        assert!(error.contains("is a pipe or a device") && error.contains("device.toml:"), "{error}");
        assert!(told(desk.concio(&format!("record {device}")), 2)[1].contains("is a pipe or a device"));
    }
    assert!(told(desk.concio("check pipe"), 2)[1].contains("is a pipe or a device, not a wall file"));
    assert!(told(desk.concio("study check pipe"), 2)[1].contains("is a pipe or a device, not a study file"));
}

/// Damage through the program: read or refused, with nothing on standard output where it is refused.
#[test]
fn damaged_files_end_with_status_0_or_2() {
    let desk = Desk::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../concio/tests/fixtures/records");
    let mut refused = 0;
    for (name, seed) in
        [("csmip.v2", 7), ("geonet.v2a", 11), ("knet.ew", 13), ("renadic.v1", 17), ("unam.asa", 19), ("cosmos.v1", 23)]
    {
        let mut bytes = std::fs::read(folder.join(name)).expect("a fixture");
        // A linear congruence is chance enough to turn a few bytes over.
        let mut state: u64 = seed;
        for _ in 0..3 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let at = (state >> 33) as usize % bytes.len();
            bytes[at] ^= 1 << (state >> 20 & 7);
        }
        desk.put("damaged", &bytes);
        let done = desk.concio("record damaged").assert();
        let status = done.get_output().status.code();
        assert!(matches!(status, Some(0 | 2)), "{name}: {status:?}");
        if status == Some(2) {
            refused += 1;
            assert!(done.get_output().stdout.is_empty() && !done.get_output().stderr.is_empty(), "{name}");
        }
    }
    assert!(refused > 0);
}

fn shared() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("CONCIO_SHARED").map_or(beside, PathBuf::from).join("records");
    let found = folder.join("manifest.json").is_file();
    if !found {
        concio_verified::skip("real accelerograms (shared/ not found)");
    }
    found.then_some(folder)
}

/// Samples, interval, peak and its time of every real file, as the manifest has them: within 1e-5, or within the digits that it writes.
#[test]
fn real_files_have_the_numbers_of_the_manifest() {
    let Some(folder) = shared() else { return };
    let text = std::fs::read_to_string(folder.join("manifest.json")).expect("the manifest");
    let manifest: Vec<Value> = serde_json::from_str(&text).expect("JSON");
    let mut seen = std::collections::HashMap::new();
    for entry in &manifest {
        let file = entry["file"].as_str().expect("a file");
        let place: &mut usize = seen.entry(file).or_insert(0);
        *place += 1;
        let label = entry["channel"].as_str().unwrap_or("");
        let channel = if label.is_empty() || label.len() >= 8 { place.to_string() } else { label.into() };
        let output = std::process::Command::new(PROGRAM)
            .arg("record")
            .arg(folder.join(file))
            .args(["--json", "--channel", &channel])
            .output()
            .expect("concio starts");
        assert!(output.status.success(), "{file}: {}", String::from_utf8_lossy(&output.stderr));
        let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        for (key, wanted) in [("npts", "npts"), ("dt", "dt"), ("pga_signed", "pga_ms2"), ("pga_time", "t_pga")] {
            let Some(expected) = entry[wanted].as_f64() else { continue };
            let decimals = entry[wanted].to_string().split_once('.').map_or(0, |(_, decimals)| decimals.len());
            let digits = 0.5 * 10f64.powi(-(decimals.min(20) as i32)) * (1.0 + 1e-9);
            let off = (number(&found, key) - expected).abs();
            assert!(off <= (1e-5 * expected.abs()).max(digits), "{file} {channel}: {key} {} {expected}", found[key]);
        }
    }
}
