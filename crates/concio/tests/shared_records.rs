//! Real accelerograms of the archives, kept beside the repository: every file against figures computed
//! independently. Skipped with one line where they are not there.

use std::path::{Path, PathBuf};

use concio::ground::record::{TextOptions, read};
use concio::ground::{measure, response_spectrum};
use serde_json::Value;

fn shared() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("CONCIO_SHARED").map_or(beside, PathBuf::from).join("records");
    let found = folder.join("manifest.json").is_file();
    if !found {
        println!("skipped: real accelerograms (shared/ not found)");
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

#[test]
fn every_file_matches_the_manifest() {
    let Some(folder) = shared() else { return };
    let text = std::fs::read_to_string(folder.join("manifest.json")).unwrap();
    let manifest: Vec<Value> = serde_json::from_str(&text).unwrap();
    assert!(manifest.len() >= 11);
    let mut before = String::new();
    let mut channel = 0;
    for entry in &manifest {
        let file = entry["file"].as_str().unwrap();
        channel = if before == file { channel + 1 } else { 0 };
        before = file.to_owned();
        let records = read(&folder.join(file), &TextOptions::default()).unwrap();
        let channels = manifest.iter().filter(|other| other["file"] == entry["file"]).count();
        assert_eq!(records.len(), channels, "{file}");
        let record = &records[channel];
        let measures = measure(record);
        assert_eq!(record.npts() as u64, entry["declared_npts"].as_u64().unwrap(), "{file}");
        assert_close(file, record.dt, number(entry, "dt"), 1e-12);
        assert_close(file, measures.pga.value, number(entry, "pga_ms2"), 1e-6);
        // The manifest rounds times to 1e-4 s.
        assert!((measures.pga.time - number(entry, "t_pga")).abs() <= 0.5e-4 + 1e-9, "{file}");
        assert_close(file, measures.pgv.value.abs(), number(entry, "pgv_ms"), 1e-6);
        assert_close(file, measures.arias, number(entry, "arias_m_s"), 1e-4);
        for (a, expected) in record.acceleration.iter().zip(entry["first"].as_array().unwrap()) {
            assert!((a - expected.as_f64().unwrap()).abs() <= 1e-12 * a.abs(), "{file}");
        }
        let station = entry["station"].as_str().unwrap_or(&record.station);
        assert_eq!(record.station, station, "{file}");
        println!(
            "{file} channel {}: {} {:?} {:?} {:?} Arias {:+.1e}",
            channel + 1,
            record.format.name(),
            record.station,
            record.event,
            record.channel,
            measures.arias / number(entry, "arias_m_s") - 1.0
        );
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
        assert!((sd / 0.0254 - expected).abs() <= 0.0005, "{} in instead of {expected}", sd / 0.0254);
    }
}
