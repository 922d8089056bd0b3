//! The least scale of a motion under which a wall falls.
//!
//! A fall is not monotonic in the scale: a stronger pulse may bring the wall back. So all scales up to the largest are tried, a step apart, and the
//! first interval that ends with a fall is halved. A fall between two scales that both stand is not seen: choose the step accordingly.

use concio_law::error::{InputError, Result};

use super::{Rocking, Setting, Shaking};

/// Scales that are tried at most.
const MOST: f64 = 1e5;

/// Which scales are tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ladder {
    /// From one scale to the next; above 0.
    pub step: f64,
    /// The largest; from `step`.
    pub most: f64,
    /// Distance of the two scales that are found, over the larger one; from 1e-12 to below 1.
    pub within: f64,
}

impl Default for Ladder {
    fn default() -> Self {
        Ladder { step: 0.05, most: 5.0, within: 1e-3 }
    }
}

/// Where a wall begins to fall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fall {
    /// A scale under which it stands, and one above it under which it falls; `shaking.scale` does not count.
    pub scales: [f64; 2],
    /// Runs that it took.
    pub runs: usize,
}

impl Rocking {
    /// The least scale of a motion under which the wall falls; none up to the largest.
    ///
    /// # Errors
    /// As [`Rocking::respond`]; a number of `ladder` that is out of its bounds.
    pub fn least_fall(&self, shaking: &Shaking, setting: &Setting, ladder: &Ladder) -> Result<Option<Fall>> {
        ladder.check()?;
        let bare = Setting { interval: None, ..*setting };
        let mut runs = 0;
        let mut falls = |scale: f64| {
            runs += 1;
            self.respond(&Shaking { scale, ..*shaking }, &bare).map(|response| response.stop.fell())
        };
        let (mut low, mut k) = (0.0, 1.0);
        let mut high = loop {
            let scale = k * ladder.step;
            if scale > ladder.most * (1.0 + 1e-12) {
                return Ok(None);
            }
            if falls(scale)? {
                break scale;
            }
            (low, k) = (scale, k + 1.0);
        };
        while high - low > ladder.within * high {
            let middle = 0.5 * (low + high);
            if falls(middle)? { high = middle } else { low = middle }
        }
        Ok(Some(Fall { scales: [low, high], runs }))
    }
}

impl Ladder {
    fn check(&self) -> Result<()> {
        let wrong = |key: &str, value: f64, allowed: String| {
            Err(InputError::new(format!("{value}")).key(format!("ladder.{key}")).allowed(allowed).into())
        };
        if !(self.step > 0.0 && self.step.is_finite()) {
            return wrong("step", self.step, "above 0".into());
        }
        if !(self.most >= self.step && self.most / self.step <= MOST) {
            return wrong("most", self.most, format!("{} to {}", self.step, MOST * self.step));
        }
        if !(1e-12..1.0).contains(&self.within) {
            return wrong("within", self.within, "1e-12 to below 1".into());
        }
        Ok(())
    }
}
