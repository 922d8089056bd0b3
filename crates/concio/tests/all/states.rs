//! The bits of six examples, whatever profile built them: work on the house that is to leave results alone leaves these.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use concio::case::read;
use concio::outcome::Outcome;
use concio::run::{prepare_case, run_in_memory};

/// Shear: stribeck friction, true stick, bonds, devices. Planar: a dry wall that is pushed, an arch that is tilted.
const EXAMPLES: [&str; 6] =
    ["02-driven-top", "10-true-stick", "12-bonded-joints", "13-interfaces", "15-dry-shear-wall", "17-arch"];

/// FNV-1a of all samples and frames.
fn hash(outcome: &Outcome) -> u64 {
    let kept = &outcome.recording;
    let numbers = [
        &kept.time,
        &kept.values,
        &kept.frame_displacement,
        &kept.frame_velocity,
        &kept.frame_vertical,
        &kept.frame_rotation,
        &kept.frame_friction,
    ];
    let bytes = numbers.into_iter().flatten().flat_map(|x| x.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu"))]
fn of_this_machine() -> bool {
    std::arch::is_x86_feature_detected!("fma")
}

#[cfg(not(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu")))]
fn of_this_machine() -> bool {
    false
}

/// Held where sines and exponentials are those of glibc on a processor with fused multiplication: others round their last digit otherwise. glibc 2.36 wrote
/// the file. `CONCIO_BLESS=1` writes it anew, for a change that is to move results.
#[test]
fn six_examples_keep_their_bits() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = package.join("tests/data/states.txt");
    if !of_this_machine() {
        concio_verified::skip("bits of the examples (not x86-64 Linux with glibc and fused multiplication)");
        return;
    }
    let mut found = String::new();
    for name in EXAMPLES {
        let path = package.join("../../examples").join(name).with_extension("toml");
        let case = read(&path).expect("an example").case.clone();
        let prepared = prepare_case(case, path.parent().expect("a folder")).expect("a model");
        let outcome = run_in_memory(&prepared).expect("a run");
        writeln!(found, "{name} {:016x}", hash(&outcome)).expect("text");
    }
    if std::env::var_os("CONCIO_BLESS").is_some() {
        fs::write(&file, &found).expect("a file");
    }
    let told = fs::read_to_string(&file).expect("a file");
    assert_eq!(found, told, "results have moved; see `CONCIO_BLESS` here");
}
