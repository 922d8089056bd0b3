//! Figures of one or more plots for print: plots of equal size in rows and columns, axes by the plotting library,
//! labels, headings and one legend placed here so that margins are equal and nothing overlaps.

use std::borrow::Cow;
use std::sync::Arc;

use kuva::backend::svg::SvgBackend;
use kuva::plot::scatter::{MarkerShape, ScatterPlot};
use kuva::plot::{LinePlot, LineStyle};
use kuva::render::layout::{AxisLine, Layout, TickAlign, TickFormat, TickPos};
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

use super::font;
use super::output::Drawing;
use super::scale::{Scale, around, logarithmic_label};
use super::svg::{Anchor, Canvas, line, mended, px};
use super::thin;

/// Sizes of letters [pt]: numbers at ticks, everything else.
pub const LETTERS: [u32; 2] = [7, 8];
/// Width of curves and of axes [pt].
const STROKES: [f64; 2] = [0.75, 0.5];
/// Half the size of the mark at a measured point [pt].
const MARK: f64 = 1.8;
/// Columns of a point of width in which a curve keeps its lowest and highest value.
const COLUMNS_PER_POINT: f64 = 4.0;
/// What a path may move when it is thinned, over the size of its plot.
const NEAR: f64 = 2e-4;
/// Room around a plot that the library draws into for the numbers [pt].
const ROOM: f64 = 60.0;
/// Room to the right of a plot [pt].
const RIGHT: f64 = 7.0;
/// Width of a plot that is always left [pt].
const SMALLEST: f64 = 20.0;
/// Between the numbers of the level axis [pt].
const APART: f64 = 4.0;
/// From the upright axis to its numbers, as the library places them, and from the level axis to its label [pt].
const GAP: [f64; 2] = [5.5, 8.0];

/// Colours and dash patterns [pt] of the curves of one plot: the brightness differs too.
pub const STYLES: [(&str, &str); 8] = [
    ("#0b2545", ""),
    ("#c8553d", "3.6 1.5"),
    ("#3a8f6a", "1 1.3"),
    ("#8d6cab", "5 1.4 1 1.4"),
    ("#d9a441", ""),
    ("#5f6c7b", "6 2"),
    ("#2f8fb3", "2 1"),
    ("#a33b6f", "6 1.3 1 1.3 1 1.3"),
];

/// One curve.
#[derive(Debug, Clone)]
pub struct Line<'a> {
    /// Abscissae in SI.
    pub x: Cow<'a, [f64]>,
    /// Values in SI, as many.
    pub y: Cow<'a, [f64]>,
    /// Place in [`STYLES`].
    pub style: usize,
}

/// What an axis shows.
#[derive(Debug, Clone, Default)]
pub struct Axis {
    /// Quantity, before its unit.
    pub quantity: String,
    /// SI unit; the prefix is added.
    pub unit: &'static str,
    /// Ends in SI; those of the data when none are given.
    pub range: Option<[f64; 2]>,
    /// Whether it is logarithmic; then its values are above 0.
    pub logarithmic: bool,
}

/// One plot.
#[derive(Debug, Clone)]
pub struct Panel<'a> {
    /// Line above it.
    pub heading: String,
    /// Level axis.
    pub x: Axis,
    /// Upright axis.
    pub y: Axis,
    /// Curves, later ones on top.
    pub lines: Vec<Line<'a>>,
    /// Whether the abscissae of all curves rise, as time does.
    pub rising: bool,
    /// Whether the plot below shows the numbers of the level axis for both.
    pub bare: bool,
    /// Whether every point of a curve is drawn and marked: measurements rather than histories. A curve of one point always is.
    pub marked: bool,
}

/// Plots in rows and columns.
#[derive(Debug, Clone)]
pub struct Sheet<'a> {
    /// What it shows, for those who cannot see it.
    pub title: String,
    /// Names of the styles that the plots use, for the legend; empty for none.
    pub legend: Vec<String>,
    /// The plots, row by row.
    pub panels: Vec<Panel<'a>>,
    /// Columns.
    pub columns: usize,
    /// Width of the whole [pt].
    pub width: f64,
    /// Height of a plot [pt]; none for plots as high as wide.
    pub height: Option<f64>,
}

/// Scales of a plot and its label beside the upright axis.
struct Axes {
    x: Scale,
    y: Scale,
}

/// Draws the sheet.
pub fn draw(sheet: &Sheet) -> Drawing {
    let columns = sheet.columns.clamp(1, sheet.panels.len().max(1));
    let rows = sheet.panels.len().div_ceil(columns);
    let guess = sheet.height.unwrap_or(sheet.width / columns as f64 * 0.6);
    let mut axes: Vec<Axes> = sheet.panels.iter().map(|p| scales(p, [sheet.width / columns as f64, guess])).collect();
    // Equal margins in a column, the same in all columns, so that all plots are of one size.
    let widest = axes.iter().flat_map(|a| a.y.labels()).map(|l| font::width(&l, LETTERS[0].into())).fold(0.0, f64::max);
    let left = 2.0 + f64::from(LETTERS[1]) + 3.0 + widest + GAP[0];
    // The last number below an axis may reach beyond it by half.
    let (mut right, mut width) = (RIGHT, 0.0);
    for _ in 0..2 {
        width = (sheet.width / columns as f64 - left - right).max(SMALLEST);
        for (panel, axes) in sheet.panels.iter().zip(&mut axes) {
            right = f64::max(right, 0.5 * fit_numbers(panel, axes, width) + 1.0);
        }
    }
    let height = sheet.height.unwrap_or(width);
    let mut canvas = Canvas::default();
    let mut top = legend(&mut canvas, sheet, left);
    for row in 0..rows {
        let members = row * columns..((row + 1) * columns).min(sheet.panels.len());
        let headed = sheet.panels[members.clone()].iter().any(|p| !p.heading.is_empty());
        top += if headed { f64::from(LETTERS[1]) + 5.0 } else { 5.0 };
        for k in members.clone() {
            let x = (k % columns) as f64 * (left + width + right) + left;
            panel(&mut canvas, &sheet.panels[k], &axes[k], [x, top, width, height], left);
        }
        let bare = sheet.panels[members].iter().all(|p| p.bare);
        top += height + if bare { 1.0 } else { GAP[1] + f64::from(LETTERS[0] + LETTERS[1]) + 4.0 };
    }
    Drawing { body: canvas.into_body(), size: [sheet.width, top], title: sheet.title.clone(), note: String::new() }
}

/// Ranges and ticks of a plot of about that size.
fn scales(panel: &Panel, size: [f64; 2]) -> Axes {
    let all = |level: bool| -> Vec<f64> {
        panel.lines.iter().flat_map(|l| if level { l.x.iter() } else { l.y.iter() }).copied().collect()
    };
    let of = |axis: &Axis, all: Vec<f64>, room: f64, most: usize| {
        let range = axis.range.unwrap_or_else(|| around(all.iter(), room));
        if axis.logarithmic { Scale::logarithmic(range) } else { Scale::linear(range, axis.unit, most) }
    };
    let room = if panel.rising { 0.0 } else { 0.05 };
    Axes {
        x: of(&panel.x, all(true), room, (size[0] / 32.0).max(2.0) as usize),
        y: of(&panel.y, all(false), 0.06, (size[1] / 14.0).clamp(3.0, 7.0) as usize),
    }
}

/// Takes ticks away until their numbers stand apart; the width of the last number.
fn fit_numbers(panel: &Panel, axes: &mut Axes, width: f64) -> f64 {
    let widths =
        |scale: &Scale| -> Vec<f64> { scale.labels().iter().map(|l| font::width(l, LETTERS[0].into())).collect() };
    if !axes.x.logarithmic {
        let range = axes.x.range.map(|v| v * axes.x.factor);
        for most in (2..=8).rev() {
            axes.x = Scale::linear(range, panel.x.unit, most);
            let apart = width * axes.x.step / (axes.x.range[1] - axes.x.range[0]);
            if widths(&axes.x).windows(2).all(|w| 0.5 * (w[0] + w[1]) + APART <= apart) {
                break;
            }
        }
    }
    widths(&axes.x).last().copied().unwrap_or(0.0)
}

/// One plot with its frame at `[x, y, width, height]`.
fn panel(canvas: &mut Canvas, panel: &Panel, axes: &Axes, frame: [f64; 4], margin: f64) {
    let [x, y, width, height] = frame;
    canvas.raw(&format!(
        r#"<g transform="translate({} {})" stroke-linejoin="round">{}</g>"#,
        px(x - ROOM),
        px(y - ROOM),
        library(panel, axes, [width, height])
    ));
    let size = f64::from(LETTERS[1]);
    if !panel.heading.is_empty() {
        canvas.text([x, y - 2.0 - 0.5 * size], size, Anchor::Start, false, "#000", &panel.heading);
    }
    let upright = [x - margin + 2.0 + 0.5 * size, y + 0.5 * height];
    let label = name(&panel.y, &axes.y);
    canvas.text(upright, shrunk(&label, size, height + 8.0), Anchor::Middle, true, "#000", &label);
    if !panel.bare {
        let below = y + height + GAP[1] + f64::from(LETTERS[0]) + 0.5 * size;
        let label = name(&panel.x, &axes.x);
        canvas.text(
            [x + 0.5 * width, below],
            shrunk(&label, size, width + 2.0 * RIGHT - 2.0),
            Anchor::Middle,
            false,
            "#000",
            &label,
        );
    }
}

/// The size at which a text is no longer than `room`, down to that of the numbers less one.
fn shrunk(text: &str, size: f64, room: f64) -> f64 {
    let width = font::width(text, size);
    if width <= room { size } else { (size * room / width).max(f64::from(LETTERS[0]) - 1.0) }
}

/// `displacement [µm]`.
fn name(axis: &Axis, scale: &Scale) -> String {
    if axis.unit.is_empty() && scale.prefix.is_empty() {
        axis.quantity.clone()
    } else {
        format!("{} [{}{}]", axis.quantity, scale.prefix, axis.unit)
    }
}

/// Frame, ticks, numbers and curves, with [`ROOM`] around them.
fn library(panel: &Panel, axes: &Axes, [width, height]: [f64; 2]) -> String {
    let mut plots: Vec<Plot> = panel.lines.iter().filter_map(|l| curve(panel, l, axes, width)).collect();
    // A line of one point has nothing but its mark.
    plots.extend(panel.lines.iter().filter(|l| panel.marked || l.x.len() == 1).map(|l| marks(l, axes)));
    let [x, y] = [axes.x.range, axes.y.range];
    let mut layout = Layout::auto_from_plots(&plots)
        .with_width(width + 2.0 * ROOM)
        .with_height(height + 2.0 * ROOM)
        .with_force_margins(ROOM, ROOM)
        .with_force_margins_y(ROOM, ROOM)
        .with_x_axis_min(x[0])
        .with_x_axis_max(x[1])
        .with_y_axis_min(y[0])
        .with_y_axis_max(y[1])
        .with_tick_size(LETTERS[0])
        .with_show_grid(false)
        .with_axis_line(AxisLine::Box)
        .with_axis_line_width(STROKES[1])
        .with_tick_align(TickAlign::Inside)
        .with_tick_pos(TickPos::Both)
        .with_tick_width(STROKES[1])
        .with_tick_length(2.5)
        .with_minor_ticks(if axes.x.logarithmic || axes.y.logarithmic { 1 } else { 2 })
        .with_x_tick_format(format(&axes.x, !panel.bare))
        .with_y_tick_format(format(&axes.y, true));
    if axes.x.logarithmic {
        layout = layout.with_log_x()
    } else {
        layout = layout.with_x_tick_step(axes.x.step)
    }
    if axes.y.logarithmic {
        layout = layout.with_log_y()
    } else {
        layout = layout.with_y_tick_step(axes.y.step)
    }
    let mut scene = render_multiple(plots, layout);
    scene.background_color = None;
    let svg = mended(SvgBackend::new().render_scene(&scene));
    let inner = svg.split_once('>').map_or("", |(_, rest)| rest);
    inner.trim_end().trim_end_matches("</svg>").into()
}

fn format(scale: &Scale, shown: bool) -> TickFormat {
    let scale = scale.clone();
    let text = move |v: f64| match (shown, scale.logarithmic) {
        (false, _) => String::new(),
        (true, true) => logarithmic_label(v, scale.range),
        (true, false) => scale.label(v),
    };
    TickFormat::Custom(Arc::new(text))
}

fn curve(panel: &Panel, line: &Line, axes: &Axes, width: f64) -> Option<Plot> {
    if line.x.len() < 2 {
        return None;
    }
    let points = if panel.marked {
        line.x.iter().copied().zip(line.y.iter().copied()).collect()
    } else if panel.rising {
        // First what a column of the paper cannot show, then what a straight line shows as well.
        let (x, y): (Vec<f64>, Vec<f64>) =
            thin::columns(&line.x, &line.y, (COLUMNS_PER_POINT * width) as usize).into_iter().unzip();
        thin::path(&x, &y, NEAR)
    } else {
        thin::path(&line.x, &line.y, NEAR)
    };
    if points.len() < 2 {
        return None;
    }
    let points: Vec<(f64, f64)> = points.into_iter().map(|(x, y)| (x / axes.x.factor, y / axes.y.factor)).collect();
    let (colour, dashes) = STYLES[line.style % STYLES.len()];
    let mut plot = LinePlot::new().with_data(points).with_color(colour).with_stroke_width(STROKES[0]);
    if !dashes.is_empty() {
        plot = plot.with_line_style(LineStyle::Custom(dashes.into()));
    }
    Some(Plot::Line(plot))
}

/// The points of a curve; shapes differ where colours may not be seen.
fn marks(line: &Line, axes: &Axes) -> Plot {
    const SHAPES: [MarkerShape; 4] =
        [MarkerShape::Circle, MarkerShape::Square, MarkerShape::Triangle, MarkerShape::Diamond];
    let points = line.x.iter().zip(line.y.iter()).map(|(x, y)| (x / axes.x.factor, y / axes.y.factor));
    let (colour, _) = STYLES[line.style % STYLES.len()];
    let plot = ScatterPlot::new().with_data(points.collect::<Vec<_>>()).with_color(colour).with_size(MARK);
    Plot::Scatter(plot.with_marker(SHAPES[line.style % SHAPES.len()]))
}

/// The legend above the plots, in as many rows as it needs; where it ends [pt].
fn legend(canvas: &mut Canvas, sheet: &Sheet, left: f64) -> f64 {
    let size = f64::from(LETTERS[1]);
    let entries: Vec<(usize, &String)> = sheet.legend.iter().enumerate().filter(|(_, name)| !name.is_empty()).collect();
    if entries.is_empty() {
        return 0.0;
    }
    let (mut x, mut y) = (left, 3.0 + 0.5 * size);
    for (style, name) in entries {
        let width = 16.0 + 3.0 + font::width(name, size);
        if x > left && x + width > sheet.width - 2.0 {
            (x, y) = (left, y + size + 3.0);
        }
        let (colour, dashes) = STYLES[style % STYLES.len()];
        let attributes = format!(
            r#"fill="none" stroke="{colour}" stroke-width="{}" stroke-dasharray="{}""#,
            1.3 * STROKES[0],
            if dashes.is_empty() { "none" } else { dashes }
        );
        canvas.path(&line([x, y, x + 16.0, y]), &attributes, None);
        canvas.text([x + 19.0, y], size, Anchor::Start, false, "#000", name);
        x += width + 10.0;
    }
    y + 0.5 * size
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet<'a>(x: &'a [f64], y: &'a [f64], rising: bool) -> Sheet<'a> {
        let axis = |unit, range| Axis { quantity: "a quantity".into(), unit, range: Some(range), ..Axis::default() };
        Sheet {
            title: String::new(),
            legend: vec!["one".into(), "two".into()],
            panels: vec![Panel {
                heading: "(a)".into(),
                x: axis("s", [0.0, 100.0]),
                y: axis("N", [-10.0, 10.0]),
                lines: vec![Line { x: x.into(), y: y.into(), style: 0 }],
                rising,
                bare: false,
                marked: false,
            }],
            columns: 1,
            width: 241.0,
            height: Some(100.0),
        }
    }

    /// Points of the curve in the first style.
    fn points(drawing: &Drawing) -> Vec<[f64; 2]> {
        // The legend, drawn before it, has the style too.
        let (before, _) = drawing.body.rsplit_once("\" stroke=\"#0b2545\"").expect("a curve");
        let (_, d) = before.rsplit_once("d=\"").expect("its path");
        let numbers: Vec<f64> = d.split(['M', 'L', ' ']).filter_map(|n| n.parse().ok()).collect();
        numbers.chunks_exact(2).map(|p| [p[0], p[1]]).collect()
    }

    /// 100 pt stand for 20 N: a peak of 7 N lies 15 pt below the upper edge, wherever it is among many points.
    #[test]
    fn curves_carry_the_peaks_of_their_histories() {
        let x: Vec<f64> = (0..200_001).map(|k| 5e-4 * f64::from(k)).collect();
        let mut y: Vec<f64> = x.iter().map(|t| (3.0 * t).sin()).collect();
        (y[77_777], y[123_456]) = (7.0, -9.0);
        for rising in [true, false] {
            let drawn = points(&draw(&sheet(&x, &y, rising)));
            assert!(drawn.len() < 3_000, "{}", drawn.len());
            let [low, high] = drawn.iter().fold([0.0f64, 1e9], |e, p| [e[0].max(p[1]), e[1].min(p[1])]);
            assert!((high - (ROOM + 15.0)).abs() < 0.011 && (low - (ROOM + 95.0)).abs() < 0.011, "{low} {high}");
        }
    }

    #[test]
    fn axes_and_legend_are_named() {
        let drawing = draw(&sheet(&[0.0, 100.0], &[0.0, 5.0], true));
        for text in ["a quantity [s]", "a quantity [N]", ">one<", ">two<", ">−10<", ">100<"] {
            assert!(drawing.body.contains(text), "{text}");
        }
        assert!(!drawing.body.contains("1e-") && drawing.size[0] == 241.0);
    }

    #[test]
    fn nothing_and_what_is_not_finite_are_drawn() {
        for (x, y) in [(&[][..], &[][..]), (&[0.0, 1.0], &[0.0, 0.0]), (&[0.0, 1.0], &[f64::NAN, f64::INFINITY])] {
            let mut sheet = sheet(x, y, true);
            (sheet.panels[0].x.range, sheet.panels[0].y.range) = (None, None);
            assert!(draw(&sheet).png(50.0).is_ok());
        }
    }

    /// Two styles differ in their dashes, or much in brightness.
    #[test]
    fn styles_differ_in_print() {
        let grey = |hex: &str| {
            let part = |k: usize| f64::from(u8::from_str_radix(&hex[k..k + 2], 16).unwrap_or(0));
            0.299 * part(1) + 0.587 * part(3) + 0.114 * part(5)
        };
        for (k, a) in STYLES.iter().enumerate() {
            for b in &STYLES[..k] {
                assert!(a.1 != b.1 || (grey(a.0) - grey(b.0)).abs() > 60.0, "{a:?} {b:?}");
            }
        }
    }
}
