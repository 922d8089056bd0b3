//! Any bytes as a record file: an error or records that keep their promises, never a panic.
#![no_main]

use std::path::Path;

use concio::case::HistoryQuantity;
use concio::ground::record::{INTERVAL_RANGE, TextOptions, parse};
use concio::ground::signal::from_record;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // The first byte picks what a wall file may add to a text file, so that both ways in are reached.
    let (choice, bytes) = data.split_first().map_or((0, data), |(first, rest)| (*first, rest));
    let options = TextOptions {
        quantity: if choice & 1 == 0 { HistoryQuantity::Acceleration } else { HistoryQuantity::Displacement },
        units: (choice & 2 != 0).then(|| if choice & 1 == 0 { "g" } else { "mm" }.to_owned()),
        dt: (choice & 4 != 0).then_some(0.01),
    };
    match parse(bytes, Path::new("record"), &options) {
        Ok(records) => {
            assert!(!records.is_empty());
            for record in &records {
                assert!(record.npts() >= 2);
                assert!(record.acceleration.iter().all(|a| a.is_finite()));
                assert!((INTERVAL_RANGE[0]..=INTERVAL_RANGE[1]).contains(&record.dt));
                assert!(record.displacement.as_ref().is_none_or(|u| u.len() == record.npts()));
                let motion = from_record(record);
                assert!(motion.at(0.5 * record.duration()).u.is_finite());
                assert!(motion.next_break(0.0) > 0.0);
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
