//! Dry stone walls pushed at their tops, against laboratory tests kept beside the repository (shared/reference/dry-walls.json; walls
//! WS of Vasconcelos and Lourenço). Skipped with one line where they are not there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use concio::case::{Syntax, from_str};
use concio::failure::{Mode, failure};
use concio::run::{prepare_case, run_in_memory};
use serde_json::Value;

const WALL: &str = include_str!("../../../../examples/15-dry-shear-wall.toml");

fn reference() -> Option<Vec<Value>> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("CONCIO_SHARED").map_or(beside, PathBuf::from);
    let Ok(text) = std::fs::read_to_string(folder.join("reference/dry-walls.json")) else {
        concio_verified::skip("laboratory walls (shared/ not found)");
        return None;
    };
    Some(serde_json::from_str(&text).expect("JSON"))
}

/// Peak force under a load on top [N], and how the wall fails.
fn pushed(load: f64) -> (f64, Vec<Mode>) {
    let mut file = from_str(WALL, Syntax::Toml, None).expect("the example");
    file.case.load.top = load.into();
    let prepared = prepare_case(file.case, Path::new(".")).expect("a wall");
    let outcome = run_in_memory(&prepared).expect("a run");
    assert!(outcome.totals.contact_residual < 1e-6, "{:e}", outcome.totals.contact_residual);
    let failed = failure(&prepared.model.wall, &prepared.model.joints, &outcome.recording).expect("frames");
    (outcome.totals.top_force_peak, failed.modes)
}

/// Mean of the measured peaks of each load within 10 %, by rocking as in the tests.
#[test]
fn dry_walls_bear_what_they_bore_in_the_laboratory() {
    let Some(tests) = reference() else { return };
    let mut measured: BTreeMap<u64, Vec<f64>> = BTreeMap::new();
    for test in tests.iter().filter(|t| t["Test unit name"].as_str().is_some_and(|name| name.starts_with("WS"))) {
        // 100 kN stand for a total of 104.8 kN, the wall's own weight included.
        let load = (test["Ntot [kN]"].as_f64().expect("a load") - 4.8).round() as u64;
        let peaks = ["Vmax,+ [kN]", "Vmax,- [kN]"].map(|key| test[key].as_f64());
        measured.entry(load).or_default().extend(peaks.into_iter().flatten());
    }
    assert_eq!(measured.keys().copied().collect::<Vec<_>>(), [40, 100, 175, 250]);
    for (load, peaks) in measured {
        let mean = 1e3 * peaks.iter().sum::<f64>() / peaks.len() as f64;
        let (peak, modes) = pushed(1e3 * load as f64);
        println!("{load} kN: {peak:.0} N, measured {mean:.0} N, {modes:?}");
        assert!((peak / mean - 1.0).abs() < 0.1, "{load} kN: {peak} instead of {mean}");
        assert_eq!(modes.first(), Some(&Mode::Rocking), "{load} kN");
    }
}
