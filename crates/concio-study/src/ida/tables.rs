//! Tables of an incremental analysis.

use super::curve::{Curve, Found, SHARES, grid};
use super::hazard::Rate;
use super::{Settings, likelihood::Evidence};
use crate::table::Table;
use crate::warned::kinds;

/// All runs: one line per curve and intensity.
pub fn runs(settings: &Settings, curves: &[Curve]) -> Table {
    let mut table = Table::default();
    let all: Vec<(&Curve, &super::curve::Point)> =
        curves.iter().flat_map(|c| c.points.iter().map(move |p| (c, p))).collect();
    table.texts("curve", all.iter().map(|(c, _)| Some(c.name.clone())).collect());
    table.numbers("scale", "", all.iter().map(|(_, p)| Some(p.scale)).collect());
    let name = settings.intensity.name();
    if name != "scale" {
        table.numbers(name, settings.intensity.unit(), all.iter().map(|(_, p)| Some(p.intensity)).collect());
    }
    table.numbers(&settings.damage, settings.unit, all.iter().map(|(_, p)| p.damage).collect());
    let yes = |b: bool| Some(if b { "yes" } else { "no" }.to_string());
    table.texts("collapsed", all.iter().map(|(_, p)| yes(p.collapsed)).collect());
    table.numbers("warnings", "", all.iter().map(|(_, p)| Some(p.warnings.len() as f64)).collect());
    table.texts("warning_kinds", all.iter().map(|(_, p)| kinds(&p.warnings)).collect());
    table.texts("id", all.iter().map(|(_, p)| Some(p.id.clone())).collect());
    table
}

/// Intensity at which every curve reaches every limit, the two runs that it lies between, what it counts as, and how many runs of higher intensity fall below the limit
/// again: one line per curve.
pub fn capacities(settings: &Settings, curves: &[Curve]) -> Table {
    let mut table = Table::default();
    table.texts("curve", curves.iter().map(|c| Some(c.name.clone())).collect());
    table.numbers("runs", "", curves.iter().map(|c| Some(c.points.len() as f64)).collect());
    let last = |c: &Curve| c.points.last().map(|p| p.intensity);
    let unit = settings.intensity.unit();
    table.numbers("highest run", unit, curves.iter().map(last).collect());
    // Of curves that still ask for runs nothing is known for good.
    let done = |c: &&Curve| c.failed.is_none() && settings.next(&c.points).is_empty();
    let all: Vec<Option<&Curve>> = curves.iter().map(|c| Some(c).filter(done)).collect();
    let usable = || all.iter().copied();
    for (name, value) in &settings.limits {
        let cell = |c: &Curve| match c.capacity(*value) {
            Evidence::At(y) => Some(y),
            Evidence::Within([low, high]) => Some((low * high).sqrt()),
            _ => None,
        };
        table.numbers(name, unit, usable().map(|c| cell(c?)).collect());
        let from = |c: &Curve| match c.bracket(*value) {
            Some((low, _)) => low.map(|p| p.intensity),
            None => last(c),
        };
        table.numbers(format!("{name} from"), unit, usable().map(|c| from(c?)).collect());
        table.numbers(format!("{name} to"), unit, usable().map(|c| Some(c?.bracket(*value)?.1.intensity)).collect());
        let counts = |c: &Curve| match c.capacity(*value) {
            Evidence::At(_) => "found",
            Evidence::Within(_) => "between runs",
            Evidence::Below(_) => "below the first run",
            _ => "above the last run",
        };
        table.texts(format!("{name} is"), usable().map(|c| Some(counts(c?).into())).collect());
        table.numbers(
            format!("{name} below again"),
            "",
            usable().map(|c| Some(c?.below_again(*value) as f64)).collect(),
        );
    }
    table.texts("cause", curves.iter().map(|c| c.failed.clone()).collect());
    table
}

/// 16, 50 and 84 % of the damage at rising intensity; empty where so many collapsed.
pub fn fractiles(settings: &Settings, found: &[(f64, [f64; 3])]) -> Table {
    let mut table = Table::default();
    let intensity = found.iter().map(|(y, _)| Some(*y)).collect();
    table.numbers(settings.intensity.name(), settings.intensity.unit(), intensity);
    for (k, share) in SHARES.iter().enumerate() {
        let cells = found.iter().map(|(_, q)| Some(q[k]).filter(|v| v.is_finite())).collect();
        table.numbers(format!("{} at {:.0} %", settings.damage, 100.0 * share), settings.unit, cells);
    }
    table
}

/// Median and dispersion of every fit, with their intervals.
pub fn fits(settings: &Settings, found: &[Found]) -> Table {
    let mut table = Table::default();
    let unit = settings.intensity.unit();
    table.texts("limit", found.iter().map(|f| Some(f.limit.clone())).collect());
    table.numbers(&settings.damage, settings.unit, found.iter().map(|f| Some(f.value)).collect());
    table.texts("from", found.iter().map(|f| Some(f.method.into())).collect());
    let count = |pick: fn(&Evidence) -> bool| -> Vec<Option<f64>> {
        let number = |f: &Found| f.evidence.iter().filter(|e| pick(e)).count() as f64;
        found.iter().map(|f| (f.method == "capacities").then(|| number(f))).collect()
    };
    table.numbers("reached", "", count(|e| !matches!(e, Evidence::Above(_))));
    table.numbers("between runs", "", count(|e| matches!(e, Evidence::Within(_))));
    table.numbers("not reached", "", count(|e| matches!(e, Evidence::Above(_))));
    let mut numbers = |name: &str, unit: &str, pick: &dyn Fn(&super::fragility::Fragility) -> f64| {
        // An end that there is none of is empty.
        let cell = |f: &Found| f.fit.as_ref().ok().map(pick).filter(|v| *v > 0.0 && v.is_finite());
        table.numbers(name, unit, found.iter().map(cell).collect());
    };
    numbers("median", unit, &|f| f.median);
    numbers("median from", unit, &|f| f.median_interval[0]);
    numbers("median to", unit, &|f| f.median_interval[1]);
    numbers("dispersion", "", &|f| f.dispersion);
    numbers("dispersion from", "", &|f| f.dispersion_interval[0]);
    numbers("dispersion to", "", &|f| f.dispersion_interval[1]);
    let rate = |f: &Found| Some(settings.hazard.as_ref()?.of(f.fit.as_ref().ok()?));
    let rates: Vec<Option<Rate>> = found.iter().map(rate).collect();
    if settings.hazard.is_some() {
        let mut column = |name: &str, of: fn(Rate) -> Option<f64>| {
            table.numbers(name, "1/year", rates.iter().map(|rate| rate.and_then(of)).collect());
        };
        column("annual rate", |rate| Some(rate.value));
        column("annual rate from", |rate| Some(rate.interval[0]));
        column("annual rate to", |rate| Some(rate.interval[1]).filter(|high| high.is_finite()));
        column("annual rate beyond", |rate| Some(rate.beyond));
    }
    let note = |(f, rate): (&Found, &Option<Rate>)| match &f.fit {
        Ok(fit) => {
            let all = [fit.doubt().map(String::from), rate.and_then(|rate| rate.doubt())];
            Some(all.into_iter().flatten().collect::<Vec<_>>().join("; ")).filter(|note| !note.is_empty())
        }
        Err(cause) => Some((*cause).to_string()),
    };
    table.texts("note", found.iter().zip(&rates).map(note).collect());
    table
}

/// Every fitted fragility over the intensity, with its band.
pub fn fragilities(settings: &Settings, found: &[Found]) -> Table {
    let mut lines: Vec<(String, &'static str, [f64; 4])> = Vec::new();
    for f in found {
        let Ok(fit) = &f.fit else { continue };
        for y in grid(fit) {
            let [low, high] = fit.band(y);
            lines.push((f.limit.clone(), f.method, [y, fit.probability(y), low, high]));
        }
    }
    let mut table = Table::default();
    table.texts("limit", lines.iter().map(|l| Some(l.0.clone())).collect());
    table.texts("from", lines.iter().map(|l| Some(l.1.into())).collect());
    let heads =
        [(settings.intensity.name(), settings.intensity.unit()), ("probability", ""), ("low", ""), ("high", "")];
    for (k, (name, unit)) in heads.into_iter().enumerate() {
        table.numbers(name, unit, lines.iter().map(|l| Some(l.2[k])).collect());
    }
    table
}
