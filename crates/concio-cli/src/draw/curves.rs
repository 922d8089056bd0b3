//! Curves over time or period, drawn by kuva. Curves of one figure differ in dash pattern, not in colour alone.

use std::sync::Arc;

use kuva::backend::svg::SvgBackend;
use kuva::plot::{LegendPosition, LinePlot, LineStyle};
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

use super::scale::{logarithmic_label, prefix};
use super::svg::mended;
use super::thin;
use crate::format::tick;

/// Width of a figure [px].
const WIDTH: f64 = 900.0;
/// Room to the left for the numbers of the axis [px].
const LEFT: f64 = 74.0;
/// Room to the right of figures without a legend [px].
pub const NO_LEGEND: f64 = 24.0;
/// Room to the right of figures with a legend [px].
pub const LEGEND: f64 = 190.0;
/// Columns of pixels that a curve covers; more points than two in a column cannot be seen.
const COLUMNS: usize = 700;

/// One curve.
#[derive(Debug, Clone)]
pub struct Curve<'a> {
    /// Name in the legend; empty for none.
    pub name: &'a str,
    /// Abscissae, rising.
    pub x: &'a [f64],
    /// Values, as many.
    pub y: &'a [f64],
}

/// A figure with one or more curves.
#[derive(Debug, Clone)]
pub struct Figure<'a> {
    /// Title above it.
    pub title: &'a str,
    /// What the abscissae are, with the unit.
    pub x_label: &'a str,
    /// What the values are.
    pub quantity: &'a str,
    /// Their SI unit; the figure adds the decimal prefix that suits them.
    pub unit: &'a str,
    /// The curves.
    pub curves: Vec<Curve<'a>>,
    /// Height [px].
    pub height: f64,
    /// Room to the right for the legend [px]: equal in figures whose time axes are to be compared.
    pub right: f64,
    /// Whether the abscissae, above 0, are on a logarithmic axis.
    pub logarithmic: bool,
}

/// Colours and dash patterns of the curves; the colours differ in brightness too.
const STYLES: [(&str, &str); 8] = [
    ("#0b3c6f", ""),
    ("#c0390b", "7 3"),
    ("#2a8f4f", "2 3"),
    ("#8a5bb5", "9 3 2 3"),
    ("#d08a00", "4 1.5"),
    ("#555555", "12 4"),
    ("#1fa3b8", "1 2"),
    ("#b03a7e", "10 2 2 2 2 2"),
];

/// Draws a figure as SVG with a view box.
pub fn draw(figure: &Figure) -> String {
    let largest = figure.curves.iter().flat_map(|c| c.y).filter(|v| v.is_finite()).fold(0.0f64, |m, v| m.max(v.abs()));
    let (prefix, factor) = prefix(largest, figure.unit);
    let mut plots = Vec::new();
    for (curve, (colour, dashes)) in figure.curves.iter().zip(STYLES.iter().cycle()) {
        let points: Vec<(f64, f64)> =
            thin::columns(curve.x, curve.y, COLUMNS).into_iter().map(|(x, y)| (x, y / factor)).collect();
        if points.is_empty() {
            continue;
        }
        let mut line = LinePlot::new().with_data(points).with_color(*colour).with_stroke_width(1.2);
        if !dashes.is_empty() {
            line = line.with_line_style(LineStyle::Custom((*dashes).into()));
        }
        if !curve.name.is_empty() {
            line = line.with_legend(curve.name);
        }
        plots.push(Plot::Line(line));
    }
    let y_label = if figure.unit.is_empty() {
        figure.quantity.into()
    } else {
        format!("{} [{prefix}{}]", figure.quantity, figure.unit)
    };
    let mut layout = Layout::auto_from_plots(&plots)
        .with_width(WIDTH)
        .with_height(figure.height)
        .with_title(figure.title)
        .with_title_size(14)
        .with_label_size(12)
        .with_tick_size(11)
        .with_body_size(11)
        .with_font_family("DejaVu Sans, Arial, sans-serif")
        .with_force_margins(LEFT, figure.right)
        .with_x_label(figure.x_label)
        .with_y_label(y_label)
        .with_legend_position(LegendPosition::OutsideRightTop);
    // The axis ends where the data do.
    let ends =
        figure.curves.iter().flat_map(|c| [c.x.first(), c.x.last()]).flatten().copied().filter(|x| x.is_finite());
    let [low, high] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |e, x| [e[0].min(x), e[1].max(x)]);
    if low < high {
        layout = layout.with_x_axis_min(low).with_x_axis_max(high);
    }
    if figure.logarithmic && low > 0.0 {
        // Plain decimals: the library would write 1e-1.
        let format = move |v: f64| logarithmic_label(v, [low, high]);
        layout = layout.with_log_x().with_x_tick_format(TickFormat::Custom(Arc::new(format)));
    }
    let top = largest / factor;
    layout = layout.with_y_tick_format(TickFormat::Custom(Arc::new(move |v: f64| tick(v, top))));
    if largest == 0.0 {
        // A curve that is zero throughout has no range of its own.
        layout = layout.with_y_axis_min(-1.0).with_y_axis_max(1.0);
    }
    with_view_box(mended(SvgBackend::new().render_scene(&render_multiple(plots, layout))))
}

/// Puts figures one below the other into one drawing.
pub fn stack(figures: &[String]) -> String {
    let mut body = String::new();
    let (mut width, mut y) = (0f64, 0.0);
    for figure in figures {
        let [w, h] = size(figure).unwrap_or([WIDTH, 0.0]);
        body.push_str(&format!("<g transform=\"translate(0 {y})\">{figure}</g>\n"));
        width = width.max(w);
        y += h;
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{y}\" viewBox=\"0 0 {width} {y}\">\n{body}</svg>\n"
    )
}

/// Width and height that a drawing declares.
fn size(svg: &str) -> Option<[f64; 2]> {
    let value = |name: &str| {
        let start = svg.find(name)? + name.len();
        svg[start..].split('"').next()?.parse().ok()
    };
    Some([value("width=\"")?, value("height=\"")?])
}

/// kuva gives a size but no view box, without which a drawing cannot be scaled to its page.
fn with_view_box(svg: String) -> String {
    match size(&svg) {
        Some([w, h]) => svg.replacen("<svg ", &format!("<svg viewBox=\"0 0 {w} {h}\" "), 1),
        None => svg,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_nothing_and_of_what_is_not_finite_are_drawn() {
        let figure = |x: &'static [f64], y: &'static [f64]| Figure {
            title: "t",
            x_label: "time [s]",
            quantity: "displacement",
            unit: "m",
            curves: vec![Curve { name: "", x, y }],
            height: 260.0,
            right: NO_LEGEND,
            logarithmic: false,
        };
        for (x, y) in [(&[][..], &[][..]), (&[0.0, 1.0], &[0.0, 0.0]), (&[0.0, 1.0], &[f64::NAN, f64::INFINITY])] {
            assert!(draw(&figure(x, y)).starts_with("<svg viewBox="));
        }
        assert!(draw(&figure(&[0.0, 1.0], &[0.0, 3e-6])).contains("displacement [µm]"));
    }

    #[test]
    fn numbers_of_logarithmic_axes_are_decimals() {
        let svg = draw(&Figure {
            title: "",
            x_label: "period [s]",
            quantity: "pseudo-acceleration",
            unit: "m/s²",
            curves: vec![Curve { name: "", x: &[0.02, 0.1, 10.0], y: &[1.0, 3.0, 0.1] }],
            height: 300.0,
            right: NO_LEGEND,
            logarithmic: true,
        });
        assert!(svg.contains(">0.1<") && svg.contains(">10<") && !svg.contains("1e"), "{svg}");
    }
}
