//! Rows of a recording as bytes: counts of samples and frames, then the five arrays, little-endian.

use crate::record::{Layout, Recording};

/// The bytes of `rows`; an error when their lengths do not fit the layout.
pub(super) fn encode(rows: &Recording, layout: &Layout) -> Result<Vec<u8>, String> {
    let (samples, frames) = (rows.time.len(), rows.frame_time.len());
    let fits = rows.values.len() == samples * layout.channels.len()
        && rows.frame_displacement.len() == frames * layout.unknowns
        && rows.frame_velocity.len() == frames * layout.unknowns;
    if !fits {
        return Err(format!(
            "not written: {samples} samples and {frames} frames come with {}, {} and {} values",
            rows.values.len(),
            rows.frame_displacement.len(),
            rows.frame_velocity.len()
        ));
    }
    let arrays = [&rows.time, &rows.values, &rows.frame_time, &rows.frame_displacement, &rows.frame_velocity];
    let mut bytes = Vec::with_capacity(16 + 8 * arrays.iter().map(|a| a.len()).sum::<usize>());
    bytes.extend_from_slice(&(samples as u64).to_le_bytes());
    bytes.extend_from_slice(&(frames as u64).to_le_bytes());
    for array in arrays {
        bytes.extend(array.iter().flat_map(|value| value.to_le_bytes()));
    }
    Ok(bytes)
}

/// Appends the rows in `bytes` to `to`; `None`, with `to` in part filled, when they do not fit the layout.
pub(super) fn decode(bytes: &[u8], layout: &Layout, to: &mut Recording) -> Option<()> {
    let (samples, bytes) = bytes.split_first_chunk::<8>()?;
    let (frames, bytes) = bytes.split_first_chunk::<8>()?;
    let samples = usize::try_from(u64::from_le_bytes(*samples)).ok()?;
    let frames = usize::try_from(u64::from_le_bytes(*frames)).ok()?;
    let frame = frames.checked_mul(layout.unknowns)?;
    let bytes = take(bytes, samples, &mut to.time)?;
    let bytes = take(bytes, samples.checked_mul(layout.channels.len())?, &mut to.values)?;
    let bytes = take(bytes, frames, &mut to.frame_time)?;
    let bytes = take(bytes, frame, &mut to.frame_displacement)?;
    let bytes = take(bytes, frame, &mut to.frame_velocity)?;
    bytes.is_empty().then_some(())
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
    let limit = |rows: usize, width: usize| {
        let there = usize::try_from(bytes / 8).unwrap_or(usize::MAX);
        rows.saturating_mul(width).min(there)
    };
    let frames = layout.samples.checked_div(layout.frame_every).map_or(0, |n| n + 1);
    Recording {
        time: Vec::with_capacity(limit(layout.samples, 1)),
        values: Vec::with_capacity(limit(layout.samples, layout.channels.len())),
        frame_time: Vec::with_capacity(limit(frames, 1)),
        frame_displacement: Vec::with_capacity(limit(frames, layout.unknowns)),
        frame_velocity: Vec::with_capacity(limit(frames, layout.unknowns)),
    }
}

/// Empties a recording and keeps its room.
pub(super) fn clear(recording: &mut Recording) {
    recording.time.clear();
    recording.values.clear();
    recording.frame_time.clear();
    recording.frame_displacement.clear();
    recording.frame_velocity.clear();
}
