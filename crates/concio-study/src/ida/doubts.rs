//! Numbers of `[ida]` that are allowed but hardly meant: as those of a wall file they are in SI where they have no unit.

use concio::case::plausible::{Expected, FROM_MM, bare_list, rounded};
use concio::quantity::shown;
use serde_json::Value;

use super::{OF_D0, RATIOS};
use crate::file::StudyFile;
use crate::file::analyses::Ida;
use crate::intensity::Intensity;
use crate::measures::MEASURES;

/// Displacements, slips and openings that a limit is set to; who means more writes its unit.
const WAY: Expected = Expected { limits: [0.0, 0.5], usual: [5e-5, 0.2], unit: "m", slips: &[FROM_MM] };
/// PGV: some 3 m/s at most was recorded.
const VELOCITY: Expected =
    Expected { limits: [0.0, 4.0], usual: [0.01, 3.0], unit: "m/s", slips: &[(1e-2, "cm/s", 1e-2)] };
/// Periods of a wall and of what stands on it.
const PERIOD: Expected = Expected { limits: [0.0, 10.0], usual: [0.01, 5.0], unit: "s", slips: &[(1e-3, "ms", 1e-3)] };
/// Drifts of the lowest limit state: of walls that crack, some tenths of a per cent.
const FIRST_DRIFT: Expected = Expected { limits: [0.0, 0.2], usual: [5e-4, 0.2], unit: "", slips: &[(1e-2, "", 1.0)] };
/// Drifts of any limit state: a top that goes as far as it is high lies on the ground.
const DRIFT: Expected = Expected { limits: [0.0, 1.0], ..FIRST_DRIFT };
/// What adds up over all joints of a wall, and so goes far.
const SUM: &str = "total_slip";
/// Acceleration below which no hazard curve ends that is of use [m/s²].
const LOW_HAZARD: f64 = 2.0;

/// What is to be known of the numbers of `[ida]` before anything is run.
pub fn of_numbers(file: &StudyFile) -> Vec<String> {
    let Some(ida) = &file.study.ida else { return Vec::new() };
    let period = ida.period.and_then(|period| PERIOD.doubt("ida.period", period.si(), ""));
    let doubts = of_intensities(ida).into_iter().chain(period.map(|w| w.text)).chain(of_hazard(ida));
    doubts.chain(of_limits(ida)).collect()
}

/// Bare numbers at which the motions are run.
fn of_intensities(ida: &Ida) -> Vec<String> {
    let (key, values): (_, Vec<&Value>) = match &ida.hunt {
        Some(hunt) => {
            let growth = hunt.growth.as_ref();
            ("ida.hunt.first, step and most", [&hunt.first, &hunt.step, &hunt.most].into_iter().chain(growth).collect())
        }
        None => ("ida.intensities", ida.intensities.iter().collect()),
    };
    let bare = values.into_iter().map(Value::as_f64);
    match ida.intensity {
        Intensity::Pga | Intensity::Sa => bare_list(key, bare).map(|w| w.text).into_iter().collect(),
        Intensity::Pgv => {
            let most = bare.flatten().fold(0.0, f64::max);
            VELOCITY.doubt(&format!("the largest of {key}"), most, "").map(|w| w.text).into_iter().collect()
        }
        Intensity::Scale => Vec::new(),
    }
}

fn of_hazard(ida: &Ida) -> Option<String> {
    let last = ida.hazard.as_ref().and_then(|hazard| hazard.intensities.last())?;
    let end = last.as_f64().filter(|y| *y < LOW_HAZARD && matches!(ida.intensity, Intensity::Pga | Intensity::Sa))?;
    let [end, in_g] = [end, rounded(end / concio::G, 3)].map(shown);
    Some(format!("ida.hazard.intensities end at {end} m/s2, {in_g} g: did you mean \"{end} g\"?"))
}

/// Limit states and the damage of collapse.
fn of_limits(ida: &Ida) -> Vec<String> {
    let limits = ida.limits.iter().enumerate().map(|(i, limit)| (format!("ida.limits[{i}].value"), &limit.value));
    let collapse = ida.collapse.iter().map(|value| ("ida.collapse".to_string(), value));
    let bare = |(key, value): (String, &Value)| Some((key, value.as_f64()?));
    // Of all limits, those with a unit too: they show that the others are meant.
    let of_any = |(key, value): (String, &Value)| Some((key, super::ratio(value)?, value.is_number()));
    let lowest = limits.clone().filter_map(of_any).reduce(|a, b| if b.1 < a.1 { b } else { a });
    let lowest = lowest.filter(|(_, _, bare)| *bare);
    let all = || limits.clone().chain(collapse.clone()).filter_map(bare);
    let unit = MEASURES.iter().find(|m| m.name == ida.damage).map_or("", |m| m.unit);
    let percent = |v: f64| format!(": a drift of {} %", shown(rounded(100.0 * v, 4)));
    let told: Vec<String> = match (ida.damage.as_str(), unit) {
        (OF_D0, _) => beyond_d0(ida),
        (drift, _) if RATIOS.contains(&drift) => {
            let first = lowest.and_then(|(key, value, _)| FIRST_DRIFT.doubt(&key, value, &percent(value)));
            let any = || all().filter_map(|(key, value)| DRIFT.doubt(&key, value, &percent(value))).map(|w| w.text);
            first.map_or_else(|| any().collect(), |w| vec![w.text])
        }
        (name, "m") if name != SUM => {
            all().filter_map(|(key, value)| WAY.doubt(&key, value, "")).map(|w| w.text).collect()
        }
        (_, "m/s²") => {
            bare_list("ida.limits", ida.limits.iter().map(|l| l.value.as_f64())).map(|w| w.text).into_iter().collect()
        }
        _ => Vec::new(),
    };
    told
}

/// Of d0 a wall that is turned once falls, as a rule.
fn beyond_d0(ida: &Ida) -> Vec<String> {
    let told = |limit: &crate::file::analyses::Limit| {
        let value = super::ratio(&limit.value).filter(|value| *value > 1.0)?;
        let percent = match (10.0..=100.0).contains(&value) {
            true => format!("; did you mean {:.2}?", 0.01 * value),
            false => String::new(),
        };
        let (name, value) = (&limit.name, shown(value));
        Some(format!(
            "{name}: its limit is {value} d0, beyond which a wall falls: its capacity is that of collapse{percent}"
        ))
    };
    ida.limits.iter().filter_map(told).collect()
}
