//! Rows of a recording as bytes: counts of samples, frames and events, then the arrays, then four numbers for every
//! event, little-endian.

use crate::record::{Event, EventKind, Layout, Recording};

/// All kinds of event; the place in the list is the number that stands for one.
const KINDS: [EventKind; 5] =
    [EventKind::Impact, EventKind::Crack, EventKind::Break, EventKind::Collapse, EventKind::Crush];

/// Adds the bytes of `rows`; an error when their lengths do not fit the layout.
pub(super) fn encode(rows: &Recording, layout: &Layout, bytes: &mut Vec<u8>) -> Result<(), String> {
    let (samples, frames) = (rows.time.len(), rows.frame_time.len());
    let arrays = rows.arrays();
    for (array, (rows, width)) in arrays.iter().zip(Recording::shapes(layout, samples, frames)) {
        if array.len() != rows * width {
            let found = array.len();
            return Err(format!("not written: {found} values in {rows} rows of {width}"));
        }
    }
    bytes.reserve(24 + 8 * arrays.iter().map(|a| a.len()).sum::<usize>() + 32 * rows.events.len());
    bytes.extend_from_slice(&(samples as u64).to_le_bytes());
    bytes.extend_from_slice(&(frames as u64).to_le_bytes());
    bytes.extend_from_slice(&(rows.events.len() as u64).to_le_bytes());
    for array in arrays {
        let from = bytes.len();
        bytes.resize(from + 8 * array.len(), 0);
        for (into, value) in bytes[from..].as_chunks_mut::<8>().0.iter_mut().zip(array) {
            *into = value.to_le_bytes();
        }
    }
    bytes.extend(rows.events.iter().flat_map(numbers).flat_map(f64::to_le_bytes));
    Ok(())
}

/// Appends the rows in `bytes` to `to`; `None`, with `to` in part filled, when they do not fit the layout.
pub(super) fn decode(bytes: &[u8], layout: &Layout, to: &mut Recording) -> Option<()> {
    let (samples, bytes) = bytes.split_first_chunk::<8>()?;
    let (frames, bytes) = bytes.split_first_chunk::<8>()?;
    let (events, mut bytes) = bytes.split_first_chunk::<8>()?;
    let samples = usize::try_from(u64::from_le_bytes(*samples)).ok()?;
    let frames = usize::try_from(u64::from_le_bytes(*frames)).ok()?;
    let events = usize::try_from(u64::from_le_bytes(*events)).ok()?;
    for (array, (rows, width)) in to.arrays_mut().into_iter().zip(Recording::shapes(layout, samples, frames)) {
        bytes = take(bytes, rows.checked_mul(width)?, array)?;
    }
    let mut rows = Vec::new();
    bytes = take(bytes, events.checked_mul(4)?, &mut rows)?;
    let (rows, _) = rows.as_chunks::<4>();
    for row in rows {
        to.events.push(event(*row)?);
    }
    bytes.is_empty().then_some(())
}

/// Time, joint, kind and value of an event.
fn numbers(event: &Event) -> [f64; 4] {
    let kind = KINDS.iter().position(|kind| *kind == event.kind).unwrap_or(usize::MAX);
    [event.time, f64::from(event.joint), kind as f64, event.value]
}

/// The reverse of [`numbers`]; none for a kind that there is not.
fn event([time, joint, kind, value]: [f64; 4]) -> Option<Event> {
    Some(Event { time, joint: joint as u32, kind: *KINDS.get(kind as usize)?, value })
}

/// Moves `count` numbers from the front of `bytes` to `array`; what is left.
fn take<'b>(bytes: &'b [u8], count: usize, array: &mut Vec<f64>) -> Option<&'b [u8]> {
    let (numbers, rest) = bytes.split_at_checked(count.checked_mul(8)?)?;
    let (chunks, _) = numbers.as_chunks::<8>();
    array.extend(chunks.iter().map(|number| f64::from_le_bytes(*number)));
    Some(rest)
}

/// An empty recording with room for the rows of a journal of `bytes` bytes.
pub(super) fn with_capacity(layout: &Layout, bytes: u64) -> Recording {
    // The layout says how much a whole run holds, the file how much is there: the smaller of the two is enough.
    let there = usize::try_from(bytes / 8).unwrap_or(usize::MAX);
    let limit = |rows: usize, width: usize| rows.min(there / width.max(1));
    let frames = layout.samples.checked_div(layout.frame_every).map_or(0, |n| n + 1);
    let in_frame: usize =
        Recording::shapes(layout, 0, 1).iter().filter(|(rows, _)| *rows > 0).map(|(_, width)| width).sum();
    Recording::with_room(layout, limit(layout.samples, layout.channels.len()), limit(frames, in_frame), 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_event_is_read_as_it_was_written() {
        for (number, kind) in KINDS.into_iter().enumerate() {
            let written = Event { time: 0.25, joint: 7, kind, value: -1.5 };
            assert_eq!((numbers(&written)[2], event(numbers(&written))), (number as f64, Some(written)));
            // Numbers stand in journals: the list is that of the kinds, none twice.
            assert_eq!(kind as usize, number);
        }
        assert_eq!(event([0.0, 0.0, KINDS.len() as f64, 0.0]), None);
    }
}
