//! Bars by name: some quantities side by side, one line per name.

use crate::draw::chart::LETTERS;
use crate::draw::font;
use crate::draw::output::Drawing;
use crate::draw::svg::{Anchor, Canvas, line, rectangle};
use crate::format::significant;

/// Width of the figure [pt].
const WIDTH: f64 = 510.0;
/// Height of a line [pt].
const LINE: f64 = 13.0;
/// Room for the names at most, and between two columns [pt].
const NAMES: f64 = 170.0;
const BETWEEN: f64 = 12.0;
/// Colours of joints that lie and that stand.
const COLOURS: [(&str, &str, &str); 2] =
    [("#1f5fa8", "#b9cfe8", "bed or support joint"), ("#c0390b", "#f0c8b8", "head joint or connection")];
/// Narrowest mark of an interval [pt].
const MARK: f64 = 1.2;

/// A value known to lie between two.
#[derive(Debug, Clone, Copy)]
pub struct Bar {
    /// The two.
    pub ends: [f64; 2],
    /// Whether it stands for an upright joint.
    pub upright: bool,
}

/// A column of bars.
#[derive(Debug, Clone)]
pub struct Bars {
    /// What they are.
    pub quantity: String,
    /// Its unit; empty for none.
    pub unit: &'static str,
    /// The bars, one per name; none where there is no value.
    pub bars: Vec<Option<Bar>>,
}

/// Draws the columns.
pub fn bars(title: &str, names: &[&str], columns: &[Bars]) -> Drawing {
    let [small, size] = LETTERS.map(f64::from);
    let mut canvas = Canvas::default();
    let widest = names.iter().map(|n| font::width(n, size)).fold(0.0, f64::max).min(NAMES) + 6.0;
    let width = (WIDTH - widest - BETWEEN * columns.len() as f64) / columns.len().max(1) as f64;
    let (top, mut x) = (size + 10.0, widest);
    let bottom = top + LINE * names.len() as f64;
    for (k, name) in names.iter().enumerate() {
        let y = top + LINE * (k as f64 + 0.5);
        canvas.text([widest - 6.0, y], size, Anchor::End, false, "#000", &fitting(name, size));
    }
    for column in columns {
        let largest = column.bars.iter().flatten().map(|b| b.ends[1]).fold(0.0, f64::max);
        let unit = if column.unit.is_empty() { String::new() } else { format!(" [{}]", column.unit) };
        canvas.text([x, 3.0 + 0.5 * size], size, Anchor::Start, false, "#000", &format!("{}{unit}", column.quantity));
        // Numbers stand behind the bars.
        let room = font::width("0.0000", small) + 6.0;
        let scale = (width - room) / largest.max(f64::MIN_POSITIVE);
        for (k, bar) in column.bars.iter().enumerate() {
            let Some(bar) = bar else { continue };
            let (dark, light, _) = COLOURS[usize::from(bar.upright)];
            let (y, [low, high]) = (top + LINE * k as f64 + 2.5, bar.ends.map(|v| x + v * scale));
            let mark = low.min(high - MARK);
            canvas.path(&rectangle([x, y, high, y + LINE - 5.0]), &format!(r#"fill="{light}""#), None);
            let said = format!("{}: {} … {}{unit}", names[k], significant(bar.ends[0], 5), significant(bar.ends[1], 5));
            canvas.path(&rectangle([mark, y, high, y + LINE - 5.0]), &format!(r#"fill="{dark}""#), Some(&said));
            let number = significant(bar.ends[1], 3);
            canvas.text([high + 3.0, y + 0.5 * (LINE - 5.0)], small, Anchor::Start, false, "#000", &number);
        }
        canvas.path(&line([x, top, x, bottom]), r##"fill="none" stroke="#000" stroke-width="0.5""##, None);
        x += width + BETWEEN;
    }
    let mut x = widest;
    let y = bottom + 10.0;
    for (upright, (dark, _, name)) in COLOURS.iter().enumerate() {
        let used = columns.iter().flat_map(|c| &c.bars).flatten().any(|b| usize::from(b.upright) == upright);
        if used {
            canvas.path(&rectangle([x, y - 3.0, x + 8.0, y + 3.0]), &format!(r#"fill="{dark}""#), None);
            canvas.text([x + 11.0, y], small, Anchor::Start, false, "#000", name);
            x += 11.0 + font::width(name, small) + 16.0;
        }
    }
    Drawing { body: canvas.into_body(), size: [WIDTH, y + 8.0], title: title.into(), note: String::new() }
}

/// A name cut to the room that names have.
fn fitting(name: &str, size: f64) -> String {
    if font::width(name, size) <= NAMES {
        return name.into();
    }
    let mut cut: String = name.into();
    while !cut.is_empty() && font::width(&cut, size) + font::width("…", size) > NAMES {
        cut.pop();
    }
    cut + "…"
}
