//! Progress of runs that last: a bar on a terminal, a line now and then in a log.

use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use concio::simulate::Status;
use concio_study::runner;
use indicatif::{ProgressBar, ProgressStyle};

use crate::files;
use crate::format::{clock, seconds, significant};

/// How long a run may take before a bar appears.
const PATIENCE: Duration = Duration::from_millis(500);
/// Length of the bar in steps of progress.
const LENGTH: f64 = 10_000.0;

/// Time between two lines where standard error is no terminal, as in the log of a batch job.
const BETWEEN_LINES: Duration = Duration::from_secs(30);

/// Progress of one run.
pub struct Progress {
    started: Instant,
    /// Time of the run when the first status came [s]: a resumed run does not start at 0.
    first: Option<f64>,
    bar: Option<ProgressBar>,
    /// Whether lines are printed instead of a bar, and when the last one was.
    lines: Option<Instant>,
    /// Whether an unfinished run lay in the folder.
    unfinished: bool,
}

impl Progress {
    /// Nothing is shown yet. `unfinished`: an unfinished run lies in the folder.
    pub fn new(unfinished: bool) -> Self {
        let started = Instant::now();
        let lines = (!io::stderr().is_terminal()).then_some(started);
        Progress { started, first: None, bar: None, lines, unfinished }
    }

    /// Shows how far the run is: a bar on a terminal, a line now and then elsewhere. Says at first what became of an
    /// unfinished run in the folder.
    pub fn show(&mut self, status: &Status) {
        if self.first.is_none() && self.unfinished {
            files::note(&match status.resumed_from {
                Some(time) => format!("taken up at t = {} s of {}", significant(time, 4), seconds(status.duration)),
                None => "An unfinished run lies in the folder, but of other inputs or damaged: it is discarded.".into(),
            });
        }
        let first = *self.first.get_or_insert(status.time);
        let elapsed = self.started.elapsed();
        if let Some(last) = &mut self.lines {
            if last.elapsed() >= BETWEEN_LINES {
                *last = Instant::now();
                let percent = 100.0 * status.time / status.duration;
                files::note(&format!("{percent:.0} %  {}", line(status, first, elapsed)));
            }
            return;
        }
        if self.bar.is_none() && elapsed > PATIENCE {
            let bar = ProgressBar::new(LENGTH as u64);
            if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}") {
                bar.set_style(style);
            }
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position((status.time / status.duration * LENGTH) as u64);
            bar.set_message(line(status, first, elapsed));
        }
    }

    /// Takes the bar away; whether it has been said that an earlier run was taken up.
    pub fn clear(self) -> bool {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
        self.unfinished && self.first.is_some()
    }
}

/// How far the run is, and the time left as this process's own progress from `first` lets expect.
fn line(status: &Status, first: f64, elapsed: Duration) -> String {
    let done = status.time - first;
    // Less than this says nothing: a start from rest takes its first steps in nanoseconds.
    let left = if done > 1e-3 * status.duration {
        format!(", {} left", clock(elapsed.as_secs_f64() * (status.duration - status.time) / done))
    } else {
        String::new()
    };
    format!("t = {:.3} of {}, {} steps{left}", status.time, seconds(status.duration), status.steps)
}

/// Progress of many runs.
pub struct Runs {
    bar: ProgressBar,
    /// Whether standard error is a terminal; in a log a line is printed now and then, the last one then.
    terminal: bool,
    last: Mutex<Instant>,
}

impl Default for Runs {
    /// Nothing is shown yet.
    fn default() -> Self {
        let terminal = io::stderr().is_terminal();
        let bar = if terminal { ProgressBar::new(LENGTH as u64) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}") {
            bar.set_style(style);
        }
        Runs { bar, terminal, last: Mutex::new(Instant::now()) }
    }
}

impl Runs {
    /// Shows how far the runs are; from any thread.
    pub fn show(&self, progress: &runner::Progress) {
        let text = line_of_runs(progress);
        if self.terminal {
            self.bar.set_position((progress.share * LENGTH) as u64);
            self.bar.set_message(text);
            return;
        }
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.elapsed() >= BETWEEN_LINES {
            *last = Instant::now();
            files::note(&format!("{:.0} %  {text}", 100.0 * progress.share));
        }
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

fn line_of_runs(progress: &runner::Progress) -> String {
    let mut text = format!("{} of {} runs", progress.done, progress.of);
    if progress.failed > 0 {
        text.push_str(&format!(", {} failed", progress.failed));
    }
    if progress.share > 1e-3 && progress.share < 1.0 {
        let left = progress.elapsed.as_secs_f64() * (1.0 - progress.share) / progress.share;
        text.push_str(&format!(", {} left", clock(left)));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_reckoned_from_this_session() {
        let status = Status { time: 5.0, duration: 6.0, steps: 1000, resumed_from: Some(4.0) };
        // One second of motion in two minutes, one second to go; a run taken up at 4 s did not make the other four.
        let text = line(&status, 4.0, Duration::from_secs(120));
        assert_eq!(text, "t = 5.000 of 6 s, 1000 steps, 2 min 0 s left");
        assert_eq!(line(&status, 5.0, Duration::from_secs(120)), "t = 5.000 of 6 s, 1000 steps");
        assert_eq!(line(&status, 4.999, Duration::from_secs(120)), "t = 5.000 of 6 s, 1000 steps");
    }
}
