//! Irregular texture drawn from a seeded distribution (the research report's Figure 14).
//!
//! Course heights are uniform between their bounds. A course is drawn from left to right: the end of a brick is uniform
//! over the places from which the course can still be completed, so no draw leads into a dead end. These places are
//! found beforehand, from right to left: with the pitch p = length + mortar between p_low and p_high, a brick may begin
//! at x if its head joint keeps the stagger to the course below and another brick may begin somewhere in
//! x + p_low … x + p_high, or the course ends there. They form a few intervals per brick.
//!
//! A course over which none can be laid is drawn again, and with repeated failures more of the courses below it.

use super::{Courses, stacked};
use crate::case::{Panel, RandomTexture};
use crate::dice::Dice;
use crate::wall::SLACK;
use crate::{InputError, Result};

/// Uniform over some intervals together; over their points if they have no length. None of no interval.
fn among(dice: &mut Dice, intervals: &[[f64; 2]]) -> Option<f64> {
    let total: f64 = intervals.iter().map(|[a, b]| b - a).sum();
    let last = intervals.last()?;
    if total <= 0.0 {
        let index = (dice.unit() * intervals.len() as f64) as usize;
        return intervals.get(index).map(|i| i[0]);
    }
    let mut left = dice.unit() * total;
    for [a, b] in intervals {
        if left <= b - a {
            return Some(a + left);
        }
        left -= b - a;
    }
    Some(last[1])
}

/// The texture of a panel.
///
/// # Errors
/// [`InputError`] when no texture is found that holds the stagger.
pub(super) fn courses(panel: &Panel, texture: &RandomTexture, index: usize) -> Result<Courses> {
    let rule = Rule::new(panel, texture);
    let mut dice = Dice::new(texture.seed);
    let count = panel.courses.unwrap_or(0);
    let (mut failures, mut highest) = (0, 0);
    let mut rows: Vec<Vec<f64>> = Vec::new();
    while rows.len() < count {
        let below = rows.last().map_or(Vec::new(), |row| rule.joints(row));
        if let Some(row) = rule.course(&mut dice, &below) {
            rows.push(row);
            continue;
        }
        // Courses that were hard to get past do not count against those higher up.
        failures = if rows.len() > highest { 1 } else { failures + 1 };
        highest = highest.max(rows.len());
        if failures > TRIES {
            return Err(no_texture(texture, index, rows.len()).into());
        }
        rows.truncate(rows.len().saturating_sub(1 + failures % 8));
    }
    let height = texture.height.map(|h| h.si());
    Ok(stacked(panel, rows.into_iter().map(|row| (dice.between(height), 0.0, row))))
}

/// So often courses are drawn again without getting higher.
const TRIES: usize = 200;

fn no_texture(texture: &RandomTexture, index: usize, course: usize) -> InputError {
    let stagger = texture.stagger;
    let what = format!(
        "no texture was found that keeps {stagger} between the head joints of courses {course} and {}",
        course + 1
    );
    let help = "take a smaller stagger, a wider range of lengths, another width or another seed";
    InputError::new(what).key(format!("panel[{index}].random")).help(help)
}

/// What a course has to keep, in m.
struct Rule {
    width: f64,
    mortar: f64,
    /// Shortest and longest brick with a head joint.
    pitch: [f64; 2],
    stagger: f64,
    /// Rounding allowed when bricks make up the width.
    slack: f64,
}

impl Rule {
    fn new(panel: &Panel, texture: &RandomTexture) -> Rule {
        let (width, mortar) = (texture.width.si(), panel.mortar.head.si());
        let pitch = texture.length.map(|l| l.si() + mortar);
        Rule { width, mortar, pitch, stagger: texture.stagger.si(), slack: SLACK * width }
    }

    /// Where the course ends: a brick would begin there if it went on.
    fn end(&self) -> f64 {
        self.width + self.mortar
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

    /// Brick lengths of one course over the head joints `below`; none if there is no such course.
    fn course(&self, dice: &mut Dice, below: &[f64]) -> Option<Vec<f64>> {
        let begins = self.begins(below);
        let mut row = Vec::new();
        let mut x = 0.0;
        loop {
            let (open, closes) = self.next(&begins, x);
            if closes && (open.is_empty() || dice.unit() < 0.5) {
                row.push(self.width - x);
                return Some(row);
            }
            let next = among(dice, &open)?;
            row.push(next - self.mortar - x);
            x = next;
        }
    }

    /// The intervals in which the brick after one at x may begin, and whether that one may be the last.
    fn next(&self, begins: &[[f64; 2]], x: f64) -> (Vec<[f64; 2]>, bool) {
        let [from, to] = [x + self.pitch[0], x + self.pitch[1]];
        let closes = from <= self.end() + self.slack && to >= self.end() - self.slack;
        // The first interval is the end of the course.
        let near = begins[1..].partition_point(|[low, _]| *low > to + self.slack);
        let open = begins[1 + near..].iter().take_while(|[_, high]| *high >= from - self.slack);
        let cut = open.map(|[low, high]| {
            let [a, b] = [low.max(from), high.min(to)];
            // Ends that miss each other by rounding meet in a point.
            if a <= b { [a, b] } else { [a.min(*high).max(*low); 2] }
        });
        (cut.collect(), closes)
    }

    /// Where bricks may begin so that the course can be completed: intervals from right to left, the first being the
    /// end of the course.
    fn begins(&self, below: &[f64]) -> Vec<[f64; 2]> {
        let mut found = vec![[self.end() - self.slack, self.end() + self.slack]];
        let mut first = 0;
        for [low, high] in self.windows(below) {
            // What is reached from a piece lies to the right of it when it is no longer than a pitch.
            let pieces = (2.0 * (high - low) / self.pitch[0]).ceil().max(1.0) as usize;
            for k in (0..pieces).rev() {
                let at = |k: usize| low + (high - low) * k as f64 / pieces as f64;
                self.extend(&mut found, &mut first, [at(k), at(k + 1)]);
            }
        }
        found
    }

    /// Adds the part of a piece from which one of the intervals found so far is reached.
    fn extend(&self, found: &mut Vec<[f64; 2]>, first: &mut usize, [low, high]: [f64; 2]) {
        while found.get(*first).is_some_and(|i| i[0] > high + self.pitch[1]) {
            *first += 1;
        }
        let mut k = *first;
        while let Some([from, to]) = found.get(k).copied().filter(|i| i[1] >= low + self.pitch[0]) {
            let [a, b] = [low.max(from - self.pitch[1]), high.min(to - self.pitch[0])];
            match found.last_mut() {
                Some(last) if a <= b && b >= last[0] => last[0] = last[0].min(a),
                _ if a <= b => found.push([a, b]),
                _ => {}
            }
            k += 1;
        }
    }

    /// Where a brick may begin as far as the course below is concerned, from right to left.
    fn windows(&self, below: &[f64]) -> Vec<[f64; 2]> {
        let half = self.mortar / 2.0;
        let mut high = self.end() - self.pitch[0];
        let mut windows = Vec::with_capacity(below.len() + 1);
        for joint in below.iter().rev() {
            let low = joint + self.stagger + half;
            if low <= high {
                windows.push([low, high]);
            }
            high = high.min(joint - self.stagger + half);
        }
        if self.pitch[0] <= high {
            windows.push([self.pitch[0], high]);
        }
        windows
    }
}
