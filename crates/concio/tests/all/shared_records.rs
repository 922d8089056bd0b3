//! Real accelerograms of the archives, kept beside the repository: every file against figures computed
//! independently. Skipped with one line where they are not there.

use std::path::{Path, PathBuf};

use concio::case::RecordChannel;
use concio::ground::formats::{parse, read};
use concio::ground::record::{Remark, TextOptions};
use concio::ground::{STANDARD_GRAVITY, channel, measure, response_spectrum};
use serde_json::Value;

fn shared() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("CONCIO_SHARED").map_or(beside, PathBuf::from).join("records");
    let found = folder.join("manifest.json").is_file();
    if !found {
        concio_verified::skip("real accelerograms (shared/ not found)");
    }
    found.then_some(folder)
}

fn number(entry: &Value, key: &str) -> f64 {
    entry[key].as_f64().unwrap_or_else(|| panic!("{key} of {entry}"))
}

fn assert_close(what: &str, found: f64, expected: f64, relative: f64) {
    let error = (found - expected).abs() / expected.abs();
    assert!(error <= relative, "{what}: {found} instead of {expected} (relative error {error:.1e})");
}

/// Half a unit of the last digit of a number as the manifest writes it: some are rounded as the archive's header is.
fn half_digit(value: &Value) -> f64 {
    let text = value.to_string();
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    0.5 * 10f64.powi(-(decimals.min(20) as i32)) * (1.0 + 1e-9)
}

#[test]
fn every_file_matches_the_manifest() {
    let Some(folder) = shared() else { return };
    let text = std::fs::read_to_string(folder.join("manifest.json")).unwrap();
    let manifest: Vec<Value> = serde_json::from_str(&text).unwrap();
    assert!(manifest.len() >= 30);
    let mut seen = std::collections::HashMap::new();
    for entry in &manifest {
        let file = entry["file"].as_str().unwrap();
        let place: &mut usize = seen.entry(file).or_insert(0);
        *place += 1;
        let records = read(&folder.join(file), &TextOptions::default()).unwrap();
        // Newer entries name the component; those of CSMIP quote a line of the file, in the order of the channels.
        let label = entry["channel"].as_str().unwrap_or("");
        let named = !label.is_empty() && label.len() < 8;
        let wanted = if named { RecordChannel::Name(label.into()) } else { RecordChannel::Number(*place) };
        let record = &records[channel::choose(&records, Some(&wanted)).unwrap()];
        let m = measure(record);
        let (npts, dt) = record.in_file();
        if let Some(expected) = entry["npts"].as_u64() {
            assert_eq!(npts as u64, expected, "{file}");
        }
        if !entry["dt"].is_null() {
            assert_close(file, dt, number(entry, "dt"), 1e-12);
        }
        if !entry["pga_ms2"].is_null() {
            let expected = number(entry, "pga_ms2");
            let off = (m.pga.value - expected).abs();
            assert!(
                off <= (1e-6 * expected.abs()).max(half_digit(&entry["pga_ms2"])),
                "{file}: {} {expected}",
                m.pga.value
            );
        }
        if !entry["t_pga"].is_null() {
            // The manifest rounds times to 1e-4 s.
            assert!((m.pga.time - number(entry, "t_pga")).abs() <= 0.5e-4 + 1e-9, "{file}");
        }
        if !entry["pgv_ms"].is_null() {
            assert_close(file, m.pgv.value.abs(), number(entry, "pgv_ms"), 1e-6);
            assert_close(file, m.arias, number(entry, "arias_m_s"), 1e-4);
        }
        for (a, expected) in record.acceleration.iter().zip(entry["first"].as_array().into_iter().flatten()) {
            assert!((a - expected.as_f64().unwrap()).abs() <= 1e-12 * a.abs(), "{file}");
        }
        let station = entry["station"].as_str().unwrap_or(&record.station);
        assert_eq!(record.station, station, "{file}");
        println!(
            "{file} {wanted}: {} {:?} {:?} {:?} {:?}",
            record.format.name(),
            record.station,
            record.event,
            record.channel,
            record.remarks
        );
    }
}

/// Where the manifest gives no peak, the header of the file does.
#[test]
fn peaks_in_the_headers_of_volume_1() {
    let Some(folder) = shared() else { return };
    let of = |file: &str| read(&folder.join("volume_1").join(file), &TextOptions::default()).unwrap();
    // Times in the header count from the trigger, 50.4 s after the first sample.
    for (record, (g, time)) in of("renadic_pisagua.v1").iter().zip([(-0.125, 6.365), (0.165, 7.470), (-0.068, 6.375)]) {
        let peak = measure(record).pga;
        assert!(
            (peak.value / STANDARD_GRAVITY - g).abs() <= 0.5e-3 && (peak.time - time - 50.4).abs() < 1e-9,
            "{peak:?}"
        );
        assert!((record.duration() - 119.995).abs() < 1e-9);
    }
    let film = &of("usc_017m30cc.y0a")[0];
    // The largest pair of the file: 4.680 s, 4.064 g/10.
    let peak = measure(film).pga;
    assert!((peak.value - 0.4064 * STANDARD_GRAVITY).abs() < 1e-12 && (peak.time - 4.680).abs() < 1e-9, "{peak:?}");
    assert!(matches!(film.remarks[..], [Remark::Resampled { samples: 7340, exact: true, .. }]), "{:?}", film.remarks);
}

/// Every real file that is cut somewhere is refused, whatever part was cut.
#[test]
fn real_files_that_were_cut_are_refused() {
    let Some(folder) = shared() else { return };
    let text = std::fs::read_to_string(folder.join("manifest.json")).unwrap();
    let manifest: Vec<Value> = serde_json::from_str(&text).unwrap();
    let files: std::collections::BTreeSet<&str> = manifest.iter().filter_map(|entry| entry["file"].as_str()).collect();
    for file in files {
        let bytes = std::fs::read(folder.join(file)).unwrap();
        for percent in [1, 5, 20, 30, 40, 50, 62, 70, 80, 95, 99] {
            let cut = &bytes[..bytes.len() * percent / 100];
            let found = parse(cut, Path::new(file), &TextOptions::default());
            assert!(found.is_err(), "{file} cut at {percent} %");
        }
    }
}

#[test]
fn spectral_displacements_of_el_centro() {
    // Chopra, Dynamics of Structures, deformation response of the El Centro ground motion, 2 % damping [in].
    let Some(folder) = shared() else { return };
    let path = folder.join("peer_at2/elCentro_Peknold.AT2");
    let record = &read(&path, &TextOptions::default()).unwrap()[0];
    let spectrum = response_spectrum(record.dt, &record.acceleration, 0.02, &[0.5, 1.0, 2.0]);
    for (sd, expected) in spectrum.sd.iter().zip([2.675, 5.968, 7.467]) {
        println!("Sd {:.5} in", sd / 0.0254);
        // His are those at samples, ours those between.
        let over = sd / 0.0254 - expected;
        assert!((-0.0005..0.006 * expected).contains(&over), "{} in instead of {expected}", sd / 0.0254);
    }
}
