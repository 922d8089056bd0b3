//! Any bytes as a record file: an error or records that keep their promises, never a panic.
#![no_main]

use std::path::Path;

use concio::case::{HistoryLayout, HistoryQuantity, RecordChannel};
use concio::ground::channel;
use concio::ground::process::{resample, subtract_polynomial};
use concio::ground::formats::parse;
use concio::ground::record::{INTERVAL_RANGE, Record, TextOptions};
use concio::ground::MOST_SAMPLES;
use concio::ground::signal::from_record;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // The first byte picks what a wall file may add to a text file, so that both ways in are reached.
    let (choice, bytes) = data.split_first().map_or((0, data), |(first, rest)| (*first, rest));
    let options = TextOptions {
        quantity: if choice & 1 == 0 { HistoryQuantity::Acceleration } else { HistoryQuantity::Displacement },
        units: (choice & 2 != 0).then(|| if choice & 1 == 0 { "g" } else { "mm" }.to_owned()),
        dt: (choice & 4 != 0).then_some(0.01),
        layout: [None, None, Some(HistoryLayout::Columns), Some(HistoryLayout::Rows)][usize::from(choice >> 3 & 3)],
    };
    match parse(bytes, Path::new("record"), &options) {
        Ok(records) => {
            assert!(!records.is_empty());
            assert!(channel::choose(&records, None).is_ok_and(|place| place < records.len()));
            // A name of the file finds a component, or several bear it.
            let name = RecordChannel::Name(records[records.len() - 1].channel.clone());
            if let Err(error) = channel::choose(&records, Some(&name)) {
                assert!(error.allowed.is_some());
            }
            records.iter().for_each(follow);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});

fn follow(record: &Record) {
    assert!((2..=MOST_SAMPLES).contains(&record.npts()));
    assert!(record.acceleration.iter().all(|a| a.is_finite()));
    assert!((INTERVAL_RANGE[0]..=INTERVAL_RANGE[1]).contains(&record.dt));
    assert!(record.displacement.as_ref().is_none_or(|u| u.len() == record.npts()));
    assert!(record.remarks.iter().all(|remark| !remark.to_string().is_empty()));
    let (samples, dt) = record.in_file();
    assert!(samples >= 2 && dt > 0.0 && record.offset().is_finite());
    let motion = from_record(record);
    assert!(motion.at(0.5 * record.duration()).u.is_finite());
    assert!(motion.next_break(0.0) > 0.0);
    let mut values = record.acceleration.clone();
    assert!(subtract_polynomial(&mut values, 0).is_ok());
    let mut finer = record.clone();
    if resample(&mut finer, 0.5 * record.dt).is_ok() {
        assert!(finer.acceleration.iter().all(|a| a.is_finite()));
    }
}
