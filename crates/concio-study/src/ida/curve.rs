//! What a motion does at rising intensity, and what all of them do together.

use concio::warning::Warning;

use concio::quantity::shown;

use super::Settings;
use super::Way;
use super::fragility::{Fragility, fit_clusters, fit_curves};
use super::likelihood::Evidence;
use crate::measures::{End, Row};

/// A run of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Intensity in SI.
    pub intensity: f64,
    /// Factor on the motion.
    pub scale: f64,
    /// Damage in SI; of a run that stopped early, up to there.
    pub damage: Option<f64>,
    /// Whether it counts as collapse.
    pub collapsed: bool,
    /// Id of the run.
    pub id: String,
    /// What a user should know before believing it.
    pub warnings: Vec<Warning>,
}

impl Point {
    /// Of a run.
    ///
    /// # Errors
    /// Why the run has no number.
    pub fn of(intensity: f64, scale: f64, row: &Row, settings: &Settings) -> Result<Self, String> {
        let damage = row.number(&settings.damage);
        let at = || format!("at {} {}", shown(intensity), settings.intensity.unit()).trim_end().to_string();
        let fell = row.number("collapse").is_some();
        let collapsed = match (row.end, damage) {
            (End::Failed, _) => return Err(format!("{}: {}", at(), row.cause.as_deref().unwrap_or("failed"))),
            (End::Stopped, _) => true,
            (End::Completed, None) => return Err(format!("{}: the run has no {}", at(), settings.damage)),
            (End::Completed, Some(damage)) => fell || damage >= settings.collapse,
        };
        Ok(Point { intensity, scale, damage, collapsed, id: row.id.clone(), warnings: row.warnings.clone() })
    }

    /// Whether damage of that value is reached.
    pub(crate) fn reaches(&self, value: f64) -> bool {
        self.collapsed || self.damage.is_some_and(|d| d >= value)
    }
}

/// One motion at rising intensity.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name.
    pub name: String,
    /// Curves with the same number belong together: those of one motion.
    pub motion: usize,
    /// Number of the run of the design that it scales, from 0.
    pub number: usize,
    /// Intensity at scale 1.
    pub unit: f64,
    /// Its runs, rising.
    pub points: Vec<Point>,
    /// Why it cannot be used, if so.
    pub failed: Option<String>,
}

impl Curve {
    /// The two runs between which damage first reaches `value`, the lower one none where the first run reaches it; none where no run does.
    pub fn bracket(&self, value: f64) -> Option<(Option<&Point>, &Point)> {
        let upper = self.points.iter().position(|p| p.reaches(value))?;
        Some((upper.checked_sub(1).map(|i| &self.points[i]), &self.points[upper]))
    }

    /// The intensity at which damage first reaches `value`.
    ///
    /// Between two runs the logarithm of the intensity is linear in that of the damage. Where damage jumps from one to the other, as a number of joints does and any damage where sliding, rocking
    /// or a collapse begins, and between runs that lie far apart, such a line says nothing: the capacity is the middle of both where they are next to each other, and known to lie between them where not.
    pub fn capacity(&self, value: f64) -> Evidence {
        let Some((low, high)) = self.bracket(value) else {
            return Evidence::Above(self.points.last().map_or(0.0, |p| p.intensity));
        };
        let Some(low) = low else { return Evidence::Below(high.intensity) };
        let ratio = high.intensity / low.intensity;
        let damages = (low.damage.unwrap_or(0.0), high.damage.unwrap_or(0.0));
        let share = match damages {
            (d0, d1)
                if !high.collapsed
                    && !self.counts()
                    && d0 > 0.0
                    && ratio <= 1.0 + WIDE
                    && (d1 / d0).ln() <= STEEPEST * ratio.ln() =>
            {
                (value / d0).ln() / (d1 / d0).ln()
            }
            _ if ratio > 1.0 + NEAR => return Evidence::Within([low.intensity, high.intensity]),
            _ => 0.5,
        };
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        Evidence::At(low.intensity * ratio.powf(share))
    }

    /// Whether damage is a number of things, which rises by jumps alone.
    fn counts(&self) -> bool {
        self.points.iter().all(|point| point.damage.is_none_or(|damage| damage.fract() == 0.0))
    }

    /// Runs of higher intensity than that at which damage first reaches `value` that do not reach it.
    pub fn below_again(&self, value: f64) -> usize {
        self.points.iter().skip_while(|p| !p.reaches(value)).filter(|p| !p.reaches(value)).count()
    }

    /// Damage at an intensity between its runs, straight between the logarithms; infinite from collapse on, none beyond
    /// its runs.
    pub fn damage(&self, intensity: f64) -> Option<f64> {
        let collapse = self.points.iter().position(|p| p.collapsed).unwrap_or(self.points.len());
        let standing = &self.points[..collapse];
        let upper = standing.partition_point(|p| p.intensity < intensity * (1.0 - 1e-12));
        let Some(high) = standing.get(upper) else {
            // Beyond the last run that stands: collapsed, or not known.
            return (collapse < self.points.len()).then_some(f64::INFINITY);
        };
        let d1 = high.damage?;
        let Some(low) = upper.checked_sub(1).map(|i| &standing[i]) else {
            return ((high.intensity / intensity - 1.0).abs() < 1e-9).then_some(d1);
        };
        let d0 = low.damage?;
        let share = (intensity / low.intensity).ln() / (high.intensity / low.intensity).ln();
        if d0 > 0.0 && d1 > 0.0 { Some(d0 * (d1 / d0).powf(share)) } else { Some(d0 + share * (d1 - d0)) }
    }
}

/// Power of the intensity with which damage rises from one run to the next at most where it does not jump.
const STEEPEST: f64 = 4.0;
/// By what part of the lower intensity two runs may lie apart at most for damage to be a power of the intensity in between.
const WIDE: f64 = 0.25 + 1e-9;
/// By what part of the lower intensity two runs may lie apart whose middle is a capacity: its error is a 35th of that then.
const NEAR: f64 = 0.1 + 1e-9;

/// Shares of the curves that the fractiles stand for.
pub const SHARES: [f64; 3] = [0.16, 0.5, 0.84];
/// Intensities at which fractiles and fragilities are told.
const GRID: usize = 60;

/// Fractiles of the damage at rising intensities: intensity, then one value per entry of [`SHARES`], infinite where so many
/// collapsed. From the highest first run of a curve to the lowest last run of one that stands.
pub fn fractiles(curves: &[&Curve]) -> Vec<(f64, [f64; 3])> {
    let most = |f: &dyn Fn(&Curve) -> Option<f64>, start: f64, pick: fn(f64, f64) -> f64| {
        curves.iter().filter_map(|c| f(c)).fold(start, pick)
    };
    let low = most(&|c| c.points.first().map(|p| p.intensity), 0.0, f64::max);
    let stands = |c: &Curve| c.points.last().filter(|_| c.points.iter().all(|p| !p.collapsed)).map(|p| p.intensity);
    let ends = most(&stands, f64::INFINITY, f64::min);
    let high = ends.min(most(&|c| c.points.last().map(|p| p.intensity), 0.0, f64::max));
    if curves.is_empty() || !(low > 0.0 && low < high) {
        return Vec::new();
    }
    let at = |k: usize| low * (high / low).powf(k as f64 / (GRID - 1) as f64);
    let of = |intensity: f64| {
        let mut damages: Vec<f64> = curves.iter().filter_map(|c| c.damage(intensity)).collect();
        damages.sort_by(f64::total_cmp);
        (intensity, SHARES.map(|share| quantile(&damages, share)))
    };
    (0..GRID).map(|k| of(at(k))).filter(|(_, q)| q.iter().all(|v| !v.is_nan())).collect()
}

/// The value below which lies that share of sorted values, linear between them; infinite where it touches an infinite one.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let (low, rest) = (place.floor() as usize, place.fract());
    if rest == 0.0 || low == last {
        return sorted[low];
    }
    // Between two infinite values a difference would be no number.
    if sorted[low + 1].is_infinite() { sorted[low + 1] } else { sorted[low] + rest * (sorted[low + 1] - sorted[low]) }
}

/// The fragility of a limit state.
#[derive(Debug)]
pub struct Found {
    /// Name of the limit state.
    pub limit: String,
    /// Damage at which it is reached.
    pub value: f64,
    /// `capacities` of records, or `stripes`.
    pub method: &'static str,
    /// What was fitted to: one entry per usable curve, or per intensity.
    pub evidence: Vec<Evidence>,
    /// The fit, or why there is none.
    pub fit: Result<Fragility, &'static str>,
}

/// The fragilities: of capacities for every limit, and where all motions were run at the same intensities of stripes too.
pub fn fragilities(settings: &Settings, curves: &[&Curve]) -> Vec<Found> {
    let mut found = Vec::new();
    for (limit, value) in &settings.limits {
        let mut add = |method, evidence: Vec<Evidence>, fit| {
            found.push(Found { limit: limit.clone(), value: *value, method, evidence, fit });
        };
        let motions: Vec<usize> = curves.iter().map(|c| c.motion).collect();
        let evidence: Vec<Evidence> = curves.iter().map(|c| c.capacity(*value)).collect();
        let fit = fit_clusters(&evidence, &motions, settings.confidence);
        add("capacities", evidence, fit);
        if let Way::List(list) = &settings.way {
            let stripe = |(k, intensity): (usize, &f64)| Evidence::Stripe {
                intensity: *intensity,
                reached: curves.iter().filter(|c| c.points.get(k).is_some_and(|p| p.reaches(*value))).count(),
                of: curves.len(),
            };
            // A motion is the same at all intensities: what each of its runs says is one entry.
            let each = |(curve, c): (usize, &&Curve)| {
                let entry = |p: &Point| match p.reaches(*value) {
                    true => Evidence::Below(p.intensity),
                    false => Evidence::Above(p.intensity),
                };
                c.points.iter().map(|p| (entry(p), (curve, c.motion))).collect::<Vec<_>>()
            };
            let (entries, of): (Vec<Evidence>, Vec<_>) = curves.iter().enumerate().flat_map(each).unzip();
            let (each, of): (Vec<usize>, Vec<usize>) = of.into_iter().unzip();
            let fit = fit_curves(&entries, [&each, &of], settings.confidence);
            add("stripes", list.iter().enumerate().map(stripe).collect(), fit);
        }
    }
    found
}

/// Intensities from a little below to a little above what a fit speaks of.
pub fn grid(fit: &Fragility) -> Vec<f64> {
    let reach = (3.0 * fit.dispersion).clamp(0.05, 3.0);
    (0..GRID).map(|k| fit.median * (reach * (2.0 * k as f64 / (GRID - 1) as f64 - 1.0)).exp()).collect()
}
