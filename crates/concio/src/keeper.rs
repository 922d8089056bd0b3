//! What is kept while a run goes on: a buffer of samples, frames and events, which its caller empties.

use concio_law::motion::Drive;
use concio_shear::dynamics::devices;
use concio_shear::run::{self, Keep};
use concio_shear::state::View;

use crate::channels::Channels;
use crate::model::Model;
use crate::record::{Event, Layout, Recording};

/// Samples in a step at most; the record buffer holds twice as many.
pub(crate) const WINDOW: usize = run::WINDOW;
/// Events that it holds, beside as many as may happen at one instant.
pub(crate) const EVENTS: usize = 1024;

/// What is kept of a run, and where.
#[derive(Debug, Clone)]
pub(crate) struct Keeper<'m> {
    pub model: &'m Model,
    pub channels: Channels,
    pub layout: Layout,
    pub recording: Recording,
}

impl Keeper<'_> {
    /// Whether it waits to be emptied.
    pub fn is_full(&self) -> bool {
        self.recording.time.len() >= WINDOW || self.recording.events.len() >= EVENTS
    }

    /// Moves what the buffer holds to the end of `rows`.
    pub fn empty_into(&mut self, rows: &mut Recording) {
        rows.append(&self.recording);
        self.recording.clear();
    }

    /// Likewise, if it is full.
    pub fn spill_into(&mut self, rows: &mut Recording) {
        if self.is_full() {
            self.empty_into(rows);
        }
    }
}

impl Keep for Keeper<'_> {
    /// Appends sample `k`, and the frame if one is due.
    fn sample(&mut self, k: u64, drive: &Drive, at: View<'_>) {
        let Keeper { model, channels, layout, recording } = self;
        let system = &model.shear;
        let t = k as f64 * layout.interval;
        recording.time.push(t);
        channels.sample(model, drive, at, &mut recording.values);
        if layout.frame_every == 0 || !k.is_multiple_of(layout.frame_every as u64) {
            return;
        }
        let n = layout.unknowns;
        recording.frame_time.push(t);
        recording.frame_displacement.extend_from_slice(&at.z[..n]);
        recording.frame_velocity.extend_from_slice(&at.v[..n]);
        recording.frame_acceleration.extend_from_slice(&at.a[..n]);
        recording.frame_damage.extend(at.bonds.iter().map(|bond| bond.damage));
        if layout.held > 0 {
            let from = recording.frame_friction.len();
            recording.frame_friction.resize(from + layout.held, 0.0);
            for (rub, mu) in system.rubs.iter().zip(at.mu) {
                recording.frame_friction[from + rub.joint as usize] = rub.normal[0] * mu;
            }
            let forces = &mut recording.frame_friction[from..];
            devices::forces(system, at.devices, [at.z, at.v], |e, force| forces[e] = force);
        }
    }

    fn events(&mut self) -> &mut Vec<Event> {
        &mut self.recording.events
    }
}
