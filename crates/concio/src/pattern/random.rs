//! Irregular texture drawn from a seeded distribution (the report's Figure 14).
//!
//! Course heights are uniform between their bounds. A course is drawn from left to right: a brick's length is uniform
//! over the lengths from which whole bricks can still make up the rest of the width and whose head joint keeps the
//! stagger to the course below; the last brick takes what is left. Where nothing is left to draw from, the last bricks
//! are taken back and drawn again, more of them each time in turn; where that goes on too long, the course below too.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::{Courses, SLACK, stacked};
use crate::case::{Panel, RandomTexture, validate};
use crate::{InputError, Result};

/// The generator: the same numbers for a seed on every machine and in every version.
struct Dice(ChaCha8Rng);

impl Dice {
    fn new(seed: u64) -> Dice {
        // The seed is laid out by hand: how a library spreads a number over the key may change.
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        Dice(ChaCha8Rng::from_seed(key))
    }
    /// Uniform in 0 … 1, without 1; 53 bits.
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }
    fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
        (low + self.unit() * (high - low)).clamp(low, high)
    }
    /// Uniform over some intervals together; over their points if they have no length. None of no interval.
    fn among(&mut self, intervals: &[[f64; 2]]) -> Option<f64> {
        let total: f64 = intervals.iter().map(|[a, b]| b - a).sum();
        let last = intervals.last()?;
        if total <= 0.0 {
            let index = (self.unit() * intervals.len() as f64) as usize;
            return intervals.get(index).map(|i| i[0]);
        }
        let mut left = self.unit() * total;
        for [a, b] in intervals {
            if left <= b - a {
                return Some(a + left);
            }
            left -= b - a;
        }
        Some(last[1])
    }
}

/// The texture of a panel.
///
/// # Errors
/// [`InputError`] when no texture is found that holds the stagger.
pub(super) fn courses(panel: &Panel, texture: &RandomTexture, index: usize) -> Result<Courses> {
    let rule = Rule::new(panel, texture);
    let mut dice = Dice::new(texture.seed);
    let count = panel.courses.unwrap_or(0);
    // Dead ends are cheap but not free: enough for every texture that can be found with some luck.
    let mut budget = 10_000 + 100 * validate::block_bound(panel) as u64;
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(count);
    while rows.len() < count {
        let below = rows.last().map_or(Vec::new(), |row| rule.joints(row));
        match rule.course(&mut dice, &below, &mut budget) {
            Some(row) => rows.push(row),
            None if budget == 0 => return Err(no_texture(texture, index, rows.len()).into()),
            None => {
                rows.pop();
            }
        }
    }
    let height = texture.height.map(|h| h.si());
    Ok(stacked(panel, rows.into_iter().map(|row| (dice.between(height), 0.0, row))))
}

fn no_texture(texture: &RandomTexture, index: usize, course: usize) -> InputError {
    let what = format!(
        "no texture was found that keeps {} between the head joints of courses {} and {}",
        texture.stagger,
        course,
        course + 1
    );
    let help = "take a smaller stagger, a wider range of lengths, another width or another seed";
    InputError::new(what).key(format!("panel[{index}].random")).help(help)
}

/// What a course has to keep, in m.
struct Rule {
    width: f64,
    mortar: f64,
    length: [f64; 2],
    stagger: f64,
    /// Rounding allowed when bricks make up the width.
    slack: f64,
}

impl Rule {
    fn new(panel: &Panel, texture: &RandomTexture) -> Rule {
        let width = texture.width.si();
        Rule {
            width,
            mortar: panel.mortar.head.si(),
            length: texture.length.map(|l| l.si()),
            stagger: texture.stagger.si(),
            slack: SLACK * width,
        }
    }

    /// Middles of the head joints of a course.
    fn joints(&self, row: &[f64]) -> Vec<f64> {
        let mut x = 0.0;
        let ends = row.iter().map(|length| {
            x += length + self.mortar;
            x - self.mortar / 2.0
        });
        ends.take(row.len().saturating_sub(1)).collect()
    }

    /// Brick lengths of one course over the head joints `below`; none when it takes too many dead ends.
    fn course(&self, dice: &mut Dice, below: &[f64], budget: &mut u64) -> Option<Vec<f64>> {
        let mut row: Vec<f64> = Vec::new();
        let mut starts = vec![0.0];
        let mut dead_ends = 0usize;
        loop {
            let x = starts.last().copied().unwrap_or(0.0);
            let left = self.width - x;
            let closes = left >= self.length[0] - self.slack && left <= self.length[1] + self.slack;
            let open = self.open(x, left, below);
            if closes && (open.is_empty() || dice.unit() < 0.5) {
                row.push(left);
                return Some(row);
            }
            if let Some(length) = dice.among(&open) {
                row.push(length);
                starts.push(x + length + self.mortar);
                continue;
            }
            *budget = budget.checked_sub(1)?;
            dead_ends += 1;
            if *budget == 0 || dead_ends > 200 + 50 * starts.len() {
                return None;
            }
            let keep = row.len().saturating_sub(1 + dead_ends % 8);
            row.truncate(keep);
            starts.truncate(keep + 1);
        }
    }

    /// Lengths for a brick that begins at x with `left` to go, when others follow it.
    fn open(&self, x: f64, left: f64, below: &[f64]) -> Vec<[f64; 2]> {
        let mut open = Vec::new();
        for [low, high] in self.fillable(left) {
            // A joint of the course below forbids the middles of joints within the stagger around it.
            let shift = x + self.mortar / 2.0;
            let mut low = low;
            let near = below.partition_point(|b| b + self.stagger - shift <= low);
            for b in below[near..].iter().take_while(|b| **b - self.stagger - shift < high) {
                let [from, to] = [b - self.stagger - shift, b + self.stagger - shift];
                if from >= low {
                    open.push([low, from]);
                }
                low = low.max(to);
            }
            if low <= high {
                open.push([low, high]);
            }
        }
        open
    }

    /// Lengths after which m ≥ 1 whole bricks can make up the rest: with pitches p = length + mortar,
    /// m p_low ≤ left − length ≤ m p_high.
    fn fillable(&self, left: f64) -> Vec<[f64; 2]> {
        let [low, high] = self.length;
        let [p_low, p_high] = self.length.map(|l| l + self.mortar);
        // From this m on the ranges of m and m + 1 touch: every rest from m p_low on can be filled.
        let touching = (p_low / (p_high - p_low)).ceil().max(1.0);
        let least = ((left - high - self.slack) / p_high).ceil().max(1.0);
        let most = ((left - low + self.slack) / p_low).floor();
        let mut found = Vec::new();
        let mut take = |a: f64, b: f64| {
            let (a, b) = (a.max(low), b.min(high));
            if a <= b {
                found.push([a, b]);
            }
        };
        if most >= touching {
            take(low, left - touching * p_low);
        }
        let mut m = most.min(touching - 1.0);
        while m >= least {
            take(left - m * p_high - self.slack, left - m * p_low + self.slack);
            m -= 1.0;
        }
        found
    }
}
