//! Axes: prefix, range, ticks and their labels.

use crate::format::fixed;

/// Size below which numbers without a unit are shown over a power of ten.
const SMALL: f64 = 1e-4;

/// Ticks of one axis in the unit it shows.
#[derive(Debug, Clone)]
pub struct Scale {
    /// Decimal prefix of the unit; of numbers without one a power of ten.
    pub prefix: &'static str,
    /// What values in SI are divided by.
    pub factor: f64,
    /// Ends of the axis, divided.
    pub range: [f64; 2],
    /// Distance of the ticks, divided; not used by a logarithmic axis.
    pub step: f64,
    /// Whether it is logarithmic.
    pub logarithmic: bool,
}

/// The least distance of ticks, 1, 2, 2.5 or 5 times a power of ten, at which at most `most` of them lie in `range`.
pub fn step(range: [f64; 2], most: usize) -> f64 {
    let power = 10f64.powf(((range[1] - range[0]) / most.max(1) as f64).log10().floor() - 1.0);
    let steps = [1.0, 10.0, 100.0, 1000.0].into_iter().flat_map(|p| [1.0, 2.0, 2.5, 5.0].map(|m| m * p * power));
    let number = |s: f64| (range[1] / s + 1e-9).floor() - (range[0] / s - 1e-9).ceil() + 1.0;
    steps.into_iter().find(|s| number(*s) <= most as f64).unwrap_or(range[1] - range[0])
}

/// The least round number that is not below a size: where a scale of colours ends.
pub fn round_end(largest: f64) -> f64 {
    const ROUND: [f64; 11] = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    if !(largest > 0.0 && largest.is_finite()) {
        return largest;
    }
    let power = largest.log10().floor() as i32;
    // Through decimals, so that 3 · 10⁻³ is the number that is written so.
    let of = |m: f64| format!("{m}e{power}").parse().unwrap_or(largest);
    ROUND.map(of).into_iter().find(|end| *end >= largest * (1.0 - 1e-9)).unwrap_or(largest)
}

/// Decimals in which multiples of a step are exact.
fn decimals(step: f64) -> usize {
    let exact = |d: &i32| {
        let scaled = step * 10f64.powi(*d);
        (scaled - scaled.round()).abs() < 1e-6 * scaled
    };
    (0..9).find(exact).unwrap_or(9) as usize
}

impl Scale {
    /// A linear axis from `range[0]` to `range[1]` in SI, with at most `most` ticks.
    pub fn linear(range: [f64; 2], unit: &str, most: usize) -> Scale {
        let largest = range.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        // Times are read in seconds unless they are all short.
        let (prefix, factor) = match unit {
            "s" if largest >= 0.1 => ("", 1.0),
            "" => power(largest),
            _ => prefix(largest, unit),
        };
        let range = range.map(|v| v / factor);
        Scale { prefix, factor, range, step: step(range, most), logarithmic: false }
    }

    /// A logarithmic axis; both ends above 0.
    pub fn logarithmic(range: [f64; 2]) -> Scale {
        Scale { prefix: "", factor: 1.0, range, step: 1.0, logarithmic: true }
    }

    /// The label of a tick; empty where a logarithmic axis has no room for one.
    pub fn label(&self, value: f64) -> String {
        if self.logarithmic { logarithmic_label(value, self.range) } else { linear_label(value, self.step) }
    }

    /// The labels of all ticks, to know their room.
    pub fn labels(&self) -> Vec<String> {
        if self.logarithmic {
            let powers = self.range.map(|v| v.log10().floor().clamp(-99.0, 99.0) as i32);
            let ticks = (powers[0]..=powers[1]).flat_map(|p| [1.0, 2.0, 5.0].map(|lead| lead * 10f64.powi(p)));
            let inside = |v: &f64| (self.range[0] * (1.0 - 1e-9)..=self.range[1] * (1.0 + 1e-9)).contains(v);
            return ticks.filter(inside).map(|v| self.label(v)).collect();
        }
        let [first, last] = [(self.range[0] / self.step).ceil(), (self.range[1] / self.step).floor()];
        (0..=(last - first).clamp(0.0, 100.0) as i64).map(|k| self.label((first + k as f64) * self.step)).collect()
    }
}

/// As many decimals as the step needs.
fn linear_label(value: f64, step: f64) -> String {
    fixed(value, decimals(step))
}

/// Plain decimals at 1, 2, 5 times a power of ten; at powers of ten alone when the axis is long.
pub fn logarithmic_label(value: f64, range: [f64; 2]) -> String {
    let power = value.log10().floor();
    let lead = (value / 10f64.powf(power)).round();
    let (lead, power) = if lead >= 10.0 { (1.0, power + 1.0) } else { (lead, power) };
    let long = (range[1] / range[0]).log10() > 4.0;
    if !(lead == 1.0 || !long && matches!(lead as i64, 2 | 5)) {
        return String::new();
    }
    let decimals = (-power).clamp(0.0, 9.0) as usize;
    format!("{:.decimals$}", lead * 10f64.powf(power))
}

/// The range of values, wider by `room` of it at both ends; of values that are all equal one around them.
pub fn around<'a>(values: impl Iterator<Item = &'a f64>, room: f64) -> [f64; 2] {
    let finite = values.copied().filter(|v| v.is_finite());
    let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |r, v| [r[0].min(v), r[1].max(v)]);
    if low > high {
        return [-1.0, 1.0];
    }
    let span = high - low;
    if span <= 1e-12 * low.abs().max(high.abs()) {
        let half = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
        return [low - half, high + half];
    }
    [low - room * span, high + room * span]
}

/// A power of ten for numbers without a unit whose decimals nobody counts.
fn power(largest: f64) -> (&'static str, f64) {
    const POWERS: [(&str, f64); 2] = [("1e-6", 1e-6), ("1e-9", 1e-9)];
    if largest >= SMALL || largest == 0.0 {
        return ("", 1.0);
    }
    POWERS.into_iter().find(|(_, f)| largest >= *f).unwrap_or(POWERS[1])
}

/// The decimal prefix that brings `largest` between 1 and 1000, and its factor.
pub fn prefix(largest: f64, unit: &str) -> (&'static str, f64) {
    const PREFIXES: [(&str, f64); 7] =
        [("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9)];
    // Accelerations are read in m/s² whatever their size, and numbers without unit bear no prefix.
    if unit.is_empty() || unit.starts_with("m/s²") || largest == 0.0 {
        return ("", 1.0);
    }
    PREFIXES.into_iter().find(|(_, f)| largest >= *f).unwrap_or(("n", 1e-9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        for (range, most, expected) in [
            ([0.0, 1.0], 6, 0.2),
            ([-425.0, 425.0], 4, 250.0),
            ([-425.0, 425.0], 5, 200.0),
            ([1.1e-6, 8.4e-6], 5, 2e-6),
            ([0.01, 0.99], 3, 0.25),
        ] {
            assert!((step(range, most) / expected - 1.0).abs() < 1e-9, "{range:?} {most}: {}", step(range, most));
        }
        assert_eq!([0.25, 2.5, 25.0, 0.1, 0.002, 3e3].map(decimals), [2, 1, 0, 1, 3, 0]);
    }

    #[test]
    fn scales_of_colours_end_at_round_numbers() {
        for (largest, end) in
            [(3.47e-3, 4e-3), (1.0, 1.0), (9.3, 10.0), (0.0101, 0.012), (250.0, 250.0), (5.2e-9, 6e-9)]
        {
            assert_eq!(round_end(largest), end, "{largest}");
        }
        assert_eq!((round_end(0.0), round_end(f64::INFINITY)), (0.0, f64::INFINITY));
    }

    #[test]
    fn labels_are_decimals() {
        let scale = Scale::linear([-2.1e-6, 3.2e-6], "m", 5);
        assert_eq!((scale.prefix, scale.labels()), ("µ", ["−2", "0", "2"].map(String::from).to_vec()));
        let scale = Scale::linear([0.0, 3.7e-6], "", 4);
        assert_eq!((scale.prefix, scale.labels()), ("1e-6", ["0", "1", "2", "3"].map(String::from).to_vec()));
        assert_eq!(Scale::linear([0.0, 3.7e-4], "", 4).prefix, "");
        let scale = Scale::linear([-0.3, 0.3], "m/s²", 4);
        assert_eq!(scale.labels(), ["−0.2", "0.0", "0.2"]);
        let of = |v| logarithmic_label(v, [0.02, 10.0]);
        assert_eq!([0.02, 0.05, 0.1, 0.5, 1.0, 10.0].map(of), ["0.02", "0.05", "0.1", "0.5", "1", "10"]);
        assert_eq!(of(0.3), "");
        assert_eq!(Scale::logarithmic([0.3, 30.0]).labels(), ["0.5", "1", "2", "5", "10", "20"]);
        assert_eq!([0.001, 0.002].map(|v| logarithmic_label(v, [0.001, 100.0])), ["0.001", ""]);
    }
}
