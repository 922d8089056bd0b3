//! The numbers of two runs beside each other, with difference and ratio.

use concio::failure::{Collapsed, Failure};
use concio_study::table::Table;
use serde_json::{Value, json};

use super::side::Side;
use crate::format::{columns, si};
use crate::study::page::shown;

/// What is less than this fraction of the larger of two values is rounding, and no difference.
const ROUNDING: f64 = 1e-12;

/// A number of two runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// What it is.
    pub name: &'static str,
    /// SI unit; empty for pure numbers.
    pub unit: &'static str,
    /// Its values; none where a run has none.
    pub values: [Option<f64>; 2],
}

impl Pair {
    /// The second less the first.
    pub fn difference(&self) -> Option<f64> {
        let [a, b] = [self.values[0]?, self.values[1]?];
        let difference = b - a;
        Some(if difference.abs() <= ROUNDING * a.abs().max(b.abs()) { 0.0 } else { difference })
    }

    /// The second over the first.
    pub fn ratio(&self) -> Option<f64> {
        let [a, b] = [self.values[0]?, self.values[1]?];
        (a != 0.0).then(|| b / a).filter(|ratio| ratio.is_finite())
    }
}

/// Numbers that summary.json has, by their place in it.
const OF_SUMMARY: [(&str, &str, &str); 36] = [
    ("time reached", "s", "/time_reached"),
    ("peak drift", "", "/drift/peak"),
    ("time of the peak drift", "s", "/drift/time"),
    ("residual drift", "", "/drift/residual"),
    ("largest slide over its overlap", "", "/slide/of_overlap"),
    ("peak displacement", "m", "/peak_relative_displacement"),
    ("peak slip velocity", "m/s", "/peak_slip_velocity"),
    ("least gap of a head joint", "m", "/minimum_gap"),
    ("collapse", "s", "/collapse/time"),
    ("first crack", "s", "/bonds/first_crack"),
    ("acceleration of the base then", "m/s²", "/bonds/first_acceleration"),
    ("joints cracked", "", "/bonds/cracked"),
    ("joints broken", "", "/bonds/broken"),
    ("peak base shear", "N", "/base_shear_peak"),
    ("time of the peak base shear", "s", "/base_shear_time"),
    ("top displacement then", "m", "/base_shear_displacement"),
    ("secant stiffness", "N/m", "/push/stiffness"),
    ("ultimate displacement of the top", "m", "/push/ultimate"),
    ("peak force of the beam", "N", "/top_force_peak"),
    ("rms force of the beam", "N", "/top_force_rms"),
    ("energy at the start", "J", "/energy/initial"),
    ("work done on the wall", "J", "/energy/input"),
    ("work of the top", "J", "/top_work"),
    ("kinetic energy at the end", "J", "/energy/kinetic"),
    ("elastic energy at the end", "J", "/energy/elastic"),
    ("friction", "J", "/energy/friction"),
    ("damping", "J", "/energy/damping"),
    ("broken bonds", "J", "/energy/bond"),
    ("hysteresis of devices", "J", "/energy/device"),
    ("impacts", "J", "/energy/impact"),
    ("energy residual over the largest work", "", "/energy/residual_relative"),
    ("weight", "N", "/weight"),
    ("vertical force on the base", "N", "/base_load"),
    ("blocks", "", "/blocks"),
    ("joints", "", "/joints"),
    ("steps", "", "/counters/steps"),
];

/// The numbers that either run has and that are not 0 in both.
pub fn pairs(sides: &[Side; 2]) -> Vec<Pair> {
    let of = |pick: &dyn Fn(&Side) -> Option<f64>| [pick(&sides[0]), pick(&sides[1])];
    let mut all: Vec<Pair> =
        OF_SUMMARY.iter().map(|&(name, unit, at)| Pair { name, unit, values: of(&|side| side.number(at)) }).collect();
    let largest = |values: &[f64]| values.iter().copied().reduce(f64::max);
    let residual = of(&|side| side.run.outcome.history("peak/displacement")?.last().copied());
    let share =
        of(&|side| Some(side.number("/base_shear_peak")? / side.number("/base_load")?).filter(|v| v.is_finite()));
    let after = |name: &str| all.iter().position(|p| p.name == name).map_or(0, |place| place + 1);
    let places = [after("peak displacement"), after("peak slip velocity"), after("peak base shear")];
    let more = [
        Pair { name: "largest displacement at the end", unit: "m", values: residual },
        Pair {
            name: "widest opening of a joint",
            unit: "m",
            values: of(&|s| largest(&s.run.outcome.envelopes.joint_opening)),
        },
        Pair { name: "peak base shear over the vertical force", unit: "", values: share },
    ];
    for (place, pair) in places.into_iter().zip(more).rev() {
        all.insert(place, pair);
    }
    all.retain(|pair| pair.values.iter().any(|v| v.is_some_and(|v| v != 0.0)));
    all
}

/// What both runs say in words: how they ended, how they failed, where.
pub fn words(sides: &[Side; 2]) -> Vec<(&'static str, [String; 2])> {
    let of = |pick: &dyn Fn(&Side) -> Option<String>| [0, 1].map(|k| pick(&sides[k]).unwrap_or_else(|| "–".into()));
    let text = |at: &'static str| move |side: &Side| Some(side.summary.pointer(at)?.as_str()?.to_string());
    let all = [
        ("ended", of(&text("/stop_reason"))),
        ("failure", of(&failure)),
        ("fell first", of(&|side| Some(collapse(side)?.block))),
        ("cracked first", of(&text("/bonds/first_joint"))),
        ("version", of(&text("/version"))),
    ];
    let told = |(name, words): &(&str, [String; 2])| match *name {
        "ended" => true,
        "version" => words[0] != words[1],
        _ => words.iter().any(|word| word != "–"),
    };
    all.into_iter().filter(told).collect()
}

fn failure(side: &Side) -> Option<String> {
    let failure: Failure = serde_json::from_value(side.summary.get("failure")?.clone()).ok()?;
    let names: Vec<&str> = failure.modes.iter().map(|mode| mode.name()).collect();
    Some(if names.is_empty() { "none".into() } else { names.join(", ") })
}

fn collapse(side: &Side) -> Option<Collapsed> {
    serde_json::from_value(side.summary.get("collapse")?.clone()).ok()
}

/// The table on the terminal.
pub fn told(names: [&str; 2], words: &[(&'static str, [String; 2])], pairs: &[Pair]) -> String {
    let [a, b] = names;
    let mut rows = vec![vec![String::new(), a.into(), b.into(), format!("{b} − {a}"), format!("{b} / {a}")]];
    rows.extend(words.iter().map(|(name, [a, b])| vec![(*name).to_string(), a.clone(), b.clone()]));
    let shown = |value: Option<f64>, unit: &str| match value {
        None => "–".into(),
        Some(v) if unit.is_empty() => shown(v),
        Some(v) => si(v, unit),
    };
    for pair in pairs {
        let [a, b] = pair.values.map(|v| shown(v, pair.unit));
        rows.push(vec![pair.name.into(), a, b, shown(pair.difference(), pair.unit), shown(pair.ratio(), "")]);
    }
    columns(&rows)
}

/// The same for the page.
pub fn table(names: [&str; 2], pairs: &[Pair]) -> Table {
    let mut table = Table::default();
    table.texts("number", pairs.iter().map(|p| Some(p.name.into())).collect());
    table.texts("unit", pairs.iter().map(|p| Some(p.unit.into())).collect());
    for (k, name) in names.into_iter().enumerate() {
        table.numbers(name, "", pairs.iter().map(|p| p.values[k]).collect());
    }
    table.numbers("difference", "", pairs.iter().map(Pair::difference).collect());
    table.numbers("ratio", "", pairs.iter().map(Pair::ratio).collect());
    table
}

/// The same for other programs.
pub fn json(pairs: &[Pair]) -> Value {
    let one = |pair: &Pair| {
        json!({
            "name": pair.name,
            "unit": pair.unit,
            "values": pair.values,
            "difference": pair.difference(),
            "ratio": pair.ratio(),
        })
    };
    pairs.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_and_ratios() {
        let pair = |a: Option<f64>, b: Option<f64>| Pair { name: "n", unit: "m", values: [a, b] };
        let of = |a, b| (pair(a, b).difference(), pair(a, b).ratio());
        assert_eq!(of(Some(2.0), Some(3.0)), (Some(1.0), Some(1.5)));
        assert_eq!(of(Some(0.0), Some(3.0)), (Some(3.0), None));
        assert_eq!(of(None, Some(3.0)), (None, None));
        assert_eq!(of(Some(0.1 + 0.2), Some(0.3)).0, Some(0.0));
        let text =
            told(["a", "b"], &[("ended", ["completed".into(), "collapsed".into()])], &[pair(Some(2e-3), Some(3e-3))]);
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        assert_eq!(rows[1], ["ended", "completed", "collapsed"]);
        assert_eq!(rows[2], ["n", "2.000", "mm", "3.000", "mm", "1.000", "mm", "1.500"]);
    }
}
