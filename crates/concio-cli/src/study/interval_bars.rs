//! Indices of factors as bars with their intervals: one row per factor, one plot per measure.

use std::fmt::Write as _;

use crate::draw::chart::{LETTERS, STYLES};
use crate::draw::font;
use crate::draw::output::Drawing;
use crate::draw::scale::{Scale, around};
use crate::draw::svg::{Anchor, Canvas, line, px, rectangle};
use crate::format::exponent;

/// Height of a bar and room between the rows of two factors [pt].
const BAR: f64 = 6.5;
const GAP: f64 = 4.0;
/// Half the height of the ends of an interval [pt].
const CAP: f64 = 1.6;

/// A bar: a value and its interval; none where there is none.
pub type Bar = Option<(f64, [f64; 2])>;

/// One plot.
#[derive(Debug)]
pub struct Group {
    /// Line above it.
    pub heading: String,
    /// Unit of its values; the prefix is added.
    pub unit: &'static str,
    /// One per factor: a bar per entry of the legend.
    pub rows: Vec<Vec<Bar>>,
}

/// Draws the plots below each other, `width` pt wide.
pub fn draw(title: &str, legend: &[&str], factors: &[String], groups: &[Group], width: f64) -> Drawing {
    let (small, size) = (f64::from(LETTERS[0]), f64::from(LETTERS[1]));
    let widest = factors.iter().map(|f| font::width(f, size)).fold(0.0, f64::max);
    let left = (widest + 8.0).min(0.5 * width);
    let mut canvas = Canvas::default();
    let mut top = 3.0;
    if legend.len() > 1 {
        let mut x = left;
        for (k, name) in legend.iter().enumerate() {
            let box_ = rectangle([x, top + 1.0, x + 9.0, top + 1.0 + BAR]);
            canvas.path(&box_, &fill(k), None);
            canvas.text([x + 12.0, top + 1.0 + 0.5 * BAR], size, Anchor::Start, false, "#000", name);
            x += 12.0 + font::width(name, size) + 12.0;
        }
        top += size + 6.0;
    }
    for group in groups {
        canvas.text([left, top + 0.5 * size], size, Anchor::Start, false, "#000", &group.heading);
        top += size + 4.0;
        top = plot(&mut canvas, group, factors, [left, top, width - left - 10.0], [small, size]);
        top += 10.0;
    }
    Drawing { body: canvas.into_body(), size: [width, top], title: title.into(), note: String::new() }
}

fn fill(k: usize) -> String {
    // The first darkest: brightness tells them apart in print too.
    let opacity = [0.95, 0.45, 0.2][k.min(2)];
    format!(r#"fill="{}" fill-opacity="{opacity}" stroke="{0}" stroke-width="0.4""#, STYLES[0].0)
}

/// Draws one plot from `[x, y]` on, `width` wide; where it ends.
fn plot(
    canvas: &mut Canvas,
    group: &Group,
    factors: &[String],
    [x, y, width]: [f64; 3],
    [small, size]: [f64; 2],
) -> f64 {
    let ends = |bar: &Bar| bar.iter().flat_map(|(v, i)| [*v, i[0], i[1]]).filter(|v| v.is_finite()).collect::<Vec<_>>();
    let all: Vec<f64> = group.rows.iter().flatten().flat_map(ends).chain([0.0]).collect();
    let [low, high] = around(all.iter(), 0.04);
    let range = [if low < 0.0 && all.iter().all(|v| *v >= 0.0) { 0.0 } else { low }, high];
    let scale = Scale::linear(range, group.unit, (width / 40.0) as usize);
    let at = |v: f64| x + width * (v / scale.factor - scale.range[0]) / (scale.range[1] - scale.range[0]);
    let bars = group.rows.iter().map(Vec::len).max().unwrap_or(1) as f64;
    let height = GAP + factors.len() as f64 * (bars * BAR + GAP);
    let thin = r##"fill="none" stroke="#000" stroke-width="0.5""##;
    for (k, (factor, row)) in factors.iter().zip(&group.rows).enumerate() {
        let start = y + GAP + k as f64 * (bars * BAR + GAP);
        let fit = (size * (x - 6.0) / font::width(factor, size).max(1.0)).min(size);
        canvas.text([x - 4.0, start + 0.5 * bars * BAR], fit, Anchor::End, false, "#000", factor);
        for (i, bar) in row.iter().enumerate() {
            let Some((value, interval)) = bar.filter(|(v, _)| v.is_finite()) else { continue };
            let (upper, middle) = (start + i as f64 * BAR, start + (i as f64 + 0.5) * BAR);
            let edges = [at(0.0).min(at(value)), at(0.0).max(at(value))];
            let tip = format!("{factor}: {}", exponent(value, 4));
            canvas.path(&rectangle([edges[0], upper, edges[1], upper + BAR]), &fill(i), Some(&tip));
            if interval.iter().all(|v| v.is_finite()) {
                let [a, b] = interval.map(at);
                let mut d = line([a, middle, b, middle]);
                for end in [a, b] {
                    let _ = write!(d, "{}", line([end, middle - CAP, end, middle + CAP]));
                }
                canvas.path(&d, r##"fill="none" stroke="#c8553d" stroke-width="0.8""##, None);
            }
        }
    }
    canvas.path(&rectangle([x, y, x + width, y + height]), thin, None);
    canvas.path(&line([at(0.0), y, at(0.0), y + height]), thin, None);
    let ticks = [(scale.range[0] / scale.step).ceil() as i64, (scale.range[1] / scale.step).floor() as i64];
    for k in ticks[0]..=ticks[1].min(ticks[0] + 100) {
        let value = k as f64 * scale.step;
        let place = at(value * scale.factor);
        canvas.path(&format!("M{} {}v-2.5", px(place), px(y + height)), thin, None);
        canvas.text([place, y + height + 2.0 + 0.5 * small], small, Anchor::Middle, false, "#000", &scale.label(value));
    }
    let mut end = y + height + 3.0 + small;
    if !group.unit.is_empty() || !scale.prefix.is_empty() {
        let unit = format!("[{}{}]", scale.prefix, group.unit);
        canvas.text([x + 0.5 * width, end + 0.5 * size], size, Anchor::Middle, false, "#000", &unit);
        end += size + 2.0;
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_end_at_their_values_and_intervals_are_drawn() {
        let rows = vec![vec![Some((2.0, [1.0, 3.0]))], vec![Some((-1.0, [f64::NAN, f64::NAN]))], vec![None]];
        let group = Group { heading: "h".into(), unit: "m", rows };
        let factors = ["one", "two & more", "three"].map(String::from);
        let drawing = draw("t", &["a"], &factors, &[group], 300.0);
        for text in [">one<", ">two &amp; more<", ">three<", ">h<", "[m]", "one: 2.0000e0", "two &amp; more: −1"] {
            assert!(drawing.body.contains(text), "{text}");
        }
        assert_eq!(drawing.body.matches("stroke=\"#c8553d\"").count(), 1);
        assert!(drawing.png(50.0).is_ok());
    }
}
