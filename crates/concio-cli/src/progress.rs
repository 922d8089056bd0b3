//! The progress bar: only on a terminal, and only for runs that last.

use std::time::{Duration, Instant};

use concio::run::Status;
use indicatif::{ProgressBar, ProgressStyle};

/// How long a run may take before a bar appears.
const PATIENCE: Duration = Duration::from_millis(500);
/// Length of the bar in steps of progress.
const LENGTH: f64 = 10_000.0;

/// Progress of one run.
pub struct Progress {
    started: Instant,
    /// Time of the run when the first status came [s]: a resumed run does not start at 0.
    first: Option<f64>,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Nothing is shown yet.
    pub fn new() -> Self {
        Progress { started: Instant::now(), first: None, bar: None }
    }

    /// Shows how far the run is. Does nothing when standard error is no terminal.
    pub fn show(&mut self, status: &Status) {
        let first = *self.first.get_or_insert(status.time);
        let position = |time: f64| (time / status.duration * LENGTH) as u64;
        let message = || format!("t = {:.3} of {} s, {} steps", status.time, status.duration, status.steps);
        if self.bar.is_none() && self.started.elapsed() > PATIENCE {
            // The remaining time is reckoned from what this process has done.
            let bar = ProgressBar::new(LENGTH as u64).with_position(position(first));
            bar.reset_eta();
            bar.set_message(message());
            if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {eta} left") {
                bar.set_style(style);
            }
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(position(status.time));
            bar.set_message(message());
        }
    }

    /// Takes the bar away.
    pub fn clear(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}
