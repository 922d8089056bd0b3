//! Figures for print: functions from a run and options to drawings, one file per family.

use std::collections::HashSet;

use concio::InputError;

use crate::args::{Figure, Instant, SINGLE};
use crate::draw::output::{Drawing, POINTS};

mod data;
mod deformed;
mod energies;
mod joints;
mod motion;
mod phase;
mod top;
mod wall;

pub use data::Data;

#[cfg(test)]
mod tests;

/// Most blocks or joints that a figure shows.
const MOST: usize = 12;

/// What a figure shows and how large.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Width in print [mm].
    pub width: f64,
    /// Instant of figures that show one.
    pub at: Instant,
    /// How many times larger displacements are drawn; chosen by the figure when none is given.
    pub scale: Option<f64>,
    /// Names of blocks; chosen by the figure when none are given.
    pub blocks: Vec<String>,
    /// Names of joints; chosen by the figure when none are given.
    pub joints: Vec<String>,
}

impl Default for Options {
    fn default() -> Self {
        Options { width: SINGLE, at: Instant::Peak, scale: None, blocks: Vec::new(), joints: Vec::new() }
    }
}

impl Options {
    /// Width in print [pt].
    fn points(&self) -> f64 {
        self.width * POINTS
    }
    /// Columns of plots: wide figures have twice as many.
    fn columns(&self, single: usize) -> usize {
        if self.width > 1.4 * SINGLE { 2 * single } else { single }
    }
}

/// Draws a figure.
///
/// # Errors
/// What the figure needs and the run did not keep or does not have, and what to do; names that do not exist.
pub fn draw(figure: Figure, data: &Data, options: &Options) -> Result<Drawing, InputError> {
    match figure {
        Figure::Deformed => deformed::deformed(data, options),
        Figure::PeakAcceleration => wall::peak_acceleration(data, options),
        Figure::Acceleration => wall::acceleration(data, options),
        Figure::Cracks => wall::cracks(data, options),
        Figure::Phase => phase::blocks(data, options),
        Figure::JointPhase => phase::joints(data, options),
        Figure::JointHistories => joints::histories(data, options),
        Figure::Hysteresis => joints::hysteresis(data, options),
        Figure::TopForce => top::force(data, options),
        Figure::Energies => energies::energies(data, options),
        Figure::Motion => motion::motion(data, options),
    }
}

/// `(a) `, `(b) `, … before the heading of one of several plots.
fn letter(k: usize, of: usize, heading: &str) -> String {
    match u8::try_from(k).ok().filter(|k| *k < 26 && of > 1) {
        Some(k) => format!("({}) {heading}", char::from(b'a' + k)),
        None => heading.into(),
    }
}

/// The blocks or joints asked for, no more than a figure can show.
fn asked(
    names: &[String],
    key: &str,
    find: impl Fn(&str) -> Result<usize, InputError>,
) -> Result<Vec<usize>, InputError> {
    if names.len() > MOST {
        let error = InputError::new(format!("{} names are given", names.len())).key(key);
        return Err(error.allowed(format!("up to {MOST} in one figure")));
    }
    names.iter().map(|n| find(n)).collect()
}

/// What a figure shows when nothing is named: those whose every sample is known if they are few, else the choice of
/// `best` among them, else among all.
fn choose(sampled: &[usize], few: usize, best: impl Fn(&dyn Fn(usize) -> bool) -> Vec<usize>) -> Vec<usize> {
    if !sampled.is_empty() && sampled.len() <= few {
        return sampled.to_vec();
    }
    let known: HashSet<usize> = sampled.iter().copied().collect();
    best(&|i| known.is_empty() || known.contains(&i))
}

/// Places of the largest values, the largest first, of those that `of` lets through and that are above 0.
fn largest(values: &[f64], of: impl Fn(usize) -> bool, most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).filter(|&i| of(i) && values[i] > 0.0).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]).then(a.cmp(&b)));
    order.truncate(most);
    order
}
