//! Diagrams for documents, a curve per series: of measured points with both axes logarithmic, or plain.

use std::fs;
use std::path::Path;

use concio::{Error, InputError};
use serde::Deserialize;

use concio_cli::draw::chart::{Axis, Line, Panel, Sheet, draw};
use concio_cli::draw::output::Drawing;
use concio_cli::failure::Failure;
use concio_cli::files;

/// Width and height of the plot [pt].
const SIZE: [f64; 2] = [420.0, 230.0];
/// Room beyond the outermost points, as a factor.
const ROOM: f64 = 1.6;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Chart {
    title: String,
    /// Labels of the axes, with units.
    x: String,
    y: String,
    series: Vec<Series>,
    /// Curves over linear axes instead of marked points over logarithmic ones.
    #[serde(default)]
    plain: bool,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Series {
    name: String,
    /// Above 0 unless the axes are linear.
    points: Vec<[f64; 2]>,
}

/// Prints the diagram as SVG.
pub fn chart(file: &Path) -> Result<(), Failure> {
    let text = fs::read_to_string(file).map_err(|e| Error::io(file, e))?;
    let chart: Chart =
        serde_json::from_str(&text).map_err(|e| InputError::new(format!("not a chart: {e}")).in_file(file))?;
    let svg = drawing(&chart).outlined().map_err(|why| Failure::Other(format!("the chart: {why}"), None))?;
    files::print(&svg)
}

fn drawing(chart: &Chart) -> Drawing {
    let axis = |label: &str, k: usize| {
        let all = chart.series.iter().flat_map(|s| &s.points).map(|p| p[k]);
        let [low, high] = all.fold([f64::INFINITY, 0.0], |r, v| [f64::min(r[0], v), f64::max(r[1], v)]);
        let range = if low > 0.0 && low <= high { [low / ROOM, high * ROOM] } else { [1.0, 10.0] };
        Axis { quantity: label.into(), unit: "", range: (!chart.plain).then_some(range), logarithmic: !chart.plain }
    };
    let line = |(style, series): (usize, &Series)| Line {
        x: series.points.iter().map(|p| p[0]).collect::<Vec<_>>().into(),
        y: series.points.iter().map(|p| p[1]).collect::<Vec<_>>().into(),
        style,
    };
    let panel = Panel {
        heading: String::new(),
        x: axis(&chart.x, 0),
        y: axis(&chart.y, 1),
        lines: chart.series.iter().enumerate().map(line).collect(),
        rising: false,
        bare: false,
        marked: !chart.plain,
    };
    let sheet = Sheet {
        title: chart.title.clone(),
        legend: chart.series.iter().map(|s| s.name.clone()).collect(),
        panels: vec![panel],
        columns: 1,
        width: SIZE[0],
        height: Some(SIZE[1]),
    };
    draw(&sheet)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three points and their two curves, named; an empty series and no series at all are drawn too.
    #[test]
    fn every_point_is_marked() {
        let series = |name: &str, points: &[[f64; 2]]| Series { name: name.into(), points: points.to_vec() };
        let of = |series| {
            drawing(&Chart { title: "t".into(), x: "time [s]".into(), y: "error".into(), plain: false, series }).svg()
        };
        let svg = of(vec![series("one", &[[0.1, 1e-3], [1.0, 1e-4]]), series("two", &[[0.2, 0.5]])]);
        assert_eq!(svg.matches("<circle").count(), 2, "{svg}");
        assert!(svg.contains(">one<") && svg.contains(">two<") && svg.contains("time [s]"));
        for empty in [vec![series("none", &[])], Vec::new()] {
            assert!(of(empty).starts_with("<svg"));
        }
    }
}
