//! `concio study` of a study with `[ida]`: the runs that its curves ask for, its tables and its section.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use concio::InputError;
use concio::case::ModelKind;
use concio::run::Control;
use concio_study::Plan;
use concio_study::ida::Way;
use concio_study::ida::curve::{Curve, Found, SHARES, fractiles, fragilities, grid};
use concio_study::ida::fragility::Fragility;
use concio_study::ida::hazard::{Hazard, Rate};
use concio_study::ida::likelihood::Evidence;
use concio_study::ida::{Analysis, Settings, tables};
use concio_study::intensity::Intensity;
use concio_study::measures::MEASURES;
use concio_study::runner::{Progress, Runner};
use concio_study::store::Store;
use concio_study::table::{self, Table};
use concio_study::warned::Warned;

use super::page::{Figure, Section, shown};
use super::sections::label;
use super::{Kind, asked};
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::failure::{Failure, STOPPED};
use crate::files;
use crate::format::{counted, pairs, plain, significant};
use crate::progress::Runs;
use crate::stop;
use crate::warned::warn_of_runs;

/// Width of a figure and height of a plot [pt].
const SIZE: [f64; 2] = [420.0, 210.0];
/// Places in the styles of the chart: a single motion, median, the other fractiles or the band.
const ONE: usize = 5;
const MIDDLE: usize = 0;
const OUTER: usize = 1;

/// Does the runs of one share of the curves; writes tables and report when all curves are done. `told` is what was warned of
/// before.
pub fn run(
    plan: &Plan,
    out: &Path,
    threads: usize,
    [share, of]: [usize; 2],
    told: &Warned,
) -> std::result::Result<ExitCode, Failure> {
    let Some(mut analysis) = Analysis::new(plan)? else { return Ok(ExitCode::SUCCESS) };
    stop::listen()?;
    let bar = Runs::default();
    let watch = |progress: &Progress| {
        bar.show(progress);
        if stop::asked() { Control::Stop } else { Control::Continue }
    };
    let mut runner = Runner::open(out, &plan.file.study.keep, threads, &watch)?;
    let passed_over = super::tell_passed_over(runner.store(), 0);
    let ended = analysis.ask(&mut runner, &|curve| curve % of == share - 1);
    bar.clear();
    if ended? == Control::Stop {
        files::note("stopped early; the same command goes on from here");
        return Ok(ExitCode::from(STOPPED));
    }
    super::tell_passed_over(runner.store(), passed_over);
    // Other shards may have ended meanwhile.
    let analysis = known(plan, &Store::open(out)?)?;
    tell(plan, &analysis, told)?;
    let missing = missing(&analysis);
    if missing > 0 {
        let all = counted(analysis.curves.len(), "curve");
        files::note(&format!("{missing} of {all} are left to other shards"));
        return Ok(ExitCode::SUCCESS);
    }
    files::print(&format!("open {}\n", write(plan, &analysis, out)?.display()))?;
    let whole = analysis.curves.iter().all(|c| c.failed.is_none());
    Ok(if whole { ExitCode::SUCCESS } else { ExitCode::from(STOPPED) })
}

/// Tells how far the curves are.
pub fn status(plan: &Plan, out: &Path) -> std::result::Result<ExitCode, Failure> {
    let store = Store::open(out)?;
    super::tell_passed_over(&store, 0);
    let analysis = known(plan, &store)?;
    tell(plan, &analysis, &Warned::default())?;
    Ok(ExitCode::SUCCESS)
}

/// Writes tables and report of the runs that the folder has.
pub fn export(plan: &Plan, out: &Path) -> std::result::Result<(), Failure> {
    let analysis = known(plan, &Store::open(out)?)?;
    files::print(&format!("open {}\n", write(plan, &analysis, out)?.display()))
}

/// What a study with `[ida]` does, for `concio study check`.
pub fn described(plan: &Plan) -> std::result::Result<Vec<(&'static str, String)>, Failure> {
    let Some(analysis) = Analysis::new(plan)? else { return Ok(Vec::new()) };
    let s = &analysis.settings;
    let asked = analysis.questions(&|_| true).len();
    let hazard = s.hazard.as_ref().map(|hazard| curve(hazard, s.intensity));
    Ok([
        ("curves", analysis.curves.len().to_string()),
        (
            "intensity",
            format!(
                "{} [{}]",
                s.intensity.name(),
                if s.intensity.unit().is_empty() { "1" } else { s.intensity.unit() }
            ),
        ),
        ("damage", measured(&s.damage)),
        (
            "limit states",
            s.limits
                .iter()
                .map(|(n, v)| format!("{n} ({})", format!("{v} {}", s.unit).trim_end()))
                .collect::<Vec<_>>()
                .join(", "),
        ),
        ("first runs", asked.to_string()),
    ]
    .into_iter()
    .chain(hazard.map(|curve| ("hazard curve", curve)))
    .collect())
}

/// A measure with what it is.
fn measured(name: &str) -> String {
    let measure = MEASURES.iter().find(|m| m.name == name);
    measure.map_or_else(|| name.into(), |m| format!("{name}: {}", m.text))
}

/// The analysis as far as the store answers it.
fn known<'a>(plan: &'a Plan, store: &Store) -> std::result::Result<Analysis<'a>, Failure> {
    let missing = || InputError::new("the study has no [ida]").key("ida");
    let mut analysis = Analysis::new(plan)?.ok_or_else(missing)?;
    let mut open = vec![true; analysis.curves.len()];
    loop {
        let questions = analysis.questions(&|curve| open[curve]);
        if questions.is_empty() {
            return Ok(analysis);
        }
        let mut found = Vec::new();
        for (curve, y) in &questions {
            match store.get(&plan.id(&analysis.case(*curve, *y)?)?) {
                Some(row) => found.push(((*curve, *y), row)),
                None => open[*curve] = false,
            }
        }
        // A list is answered whole or not at all: its numbers stand for places in it.
        for (question, row) in found.into_iter().filter(|((curve, _), _)| open[*curve]) {
            analysis.answer(question, row);
        }
    }
}

/// Curves that ask for more.
fn missing(analysis: &Analysis) -> usize {
    let mut curves: Vec<usize> = analysis.questions(&|_| true).into_iter().map(|(curve, _)| curve).collect();
    curves.dedup();
    curves.len()
}

/// What the runs of all curves warn of.
fn warned(plan: &Plan, analysis: &Analysis) -> Warned {
    let mut warned = Warned::default();
    let unit = analysis.settings.intensity.unit();
    for curve in &analysis.curves {
        for point in &curve.points {
            let name = || format!("{} at {} {unit}", curve.name, shown(point.intensity)).trim_end().to_string();
            warned.add(name, &[plan.unit_doubts(curve.number), point.warnings.clone()].concat());
        }
    }
    warned
}

fn tell(plan: &Plan, analysis: &Analysis, told: &Warned) -> std::result::Result<(), Failure> {
    let runs = analysis.curves.iter().map(|c| c.points.len()).sum::<usize>();
    let collapsed = analysis.curves.iter().filter(|c| c.points.iter().any(|p| p.collapsed)).count();
    let mut rows = vec![
        ("curves", analysis.curves.len().to_string()),
        ("done", (analysis.curves.len() - missing(analysis)).to_string()),
        ("runs", runs.to_string()),
        ("collapse", counted(collapsed, "curve")),
    ];
    let warned = warned(plan, analysis);
    rows.extend(asked::counted_warnings(&warned).map(|counts| ("warnings", counts)));
    warn_of_runs(&plan.file.wall, &warned.sentences(told));
    let failed = analysis.curves.iter().filter(|c| c.failed.is_some()).count();
    if failed > 0 {
        rows.push(("failed", failed.to_string()));
    }
    for curve in &analysis.curves {
        if let Some(cause) = &curve.failed {
            files::note(&format!("{}: {cause}", curve.name));
        }
    }
    files::print(&pairs(&rows))?;
    if missing(analysis) > 0 {
        return Ok(());
    }
    for told in doubts(analysis) {
        files::note(&format!("warning: {told}"));
    }
    let found = fragilities(&analysis.settings, &usable(analysis));
    files::print(&found.iter().map(|f| line(analysis, f)).collect::<String>())
}

/// A hazard curve from its first to its last point.
fn curve(hazard: &Hazard, intensity: Intensity) -> String {
    let at = |[value, rate]: [f64; 2]| {
        let in_g = format!(" ({} g)", significant(value / concio::G, 3));
        let in_g = if intensity == Intensity::Pgv { String::new() } else { in_g };
        format!("{} {}{in_g} {} times a year", shown(value), intensity.unit(), shown(rate))
    };
    let ends = [hazard.points.first(), hazard.points.last()].map(|point| at(point.copied().unwrap_or_default()));
    format!("from {} to {}", ends[0], ends[1])
}

/// How often a year, and in fifty years.
fn often(hazard: &Hazard, fit: &Fragility) -> String {
    let rate = hazard.of(fit);
    let Rate { value, interval: [low, high], .. } = rate;
    let percent = shown(-1e2 * (-50.0 * value).exp_m1());
    let end = if high.is_finite() { shown(high) } else { "no end".into() };
    let told = format!(", {} a year ({} … {end}), {percent} % in 50 years", shown(value), shown(low));
    told + &rate.doubt().map_or(String::new(), |doubt| format!("; {doubt}"))
}

/// An interval of a fit: without an end it begins at 0, or does not end.
fn ends([low, high]: [f64; 2]) -> String {
    match (low > 0.0, high.is_finite()) {
        (false, false) => "no interval".into(),
        (_, false) => format!("{} … no end", shown(low)),
        _ => format!("{} … {}", shown(low), shown(high)),
    }
}

/// What is known of a limit where one curve alone was run; none of more, or of none.
fn alone(analysis: &Analysis, limit: &str) -> Option<String> {
    let settings = &analysis.settings;
    let curves = usable(analysis);
    let ([curve], Some((_, value))) = (&curves[..], settings.limits.iter().find(|(name, _)| name == limit)) else {
        return None;
    };
    let capacity = told_alone(curve.capacity(*value), settings.intensity.unit())?;
    Some(format!("{capacity}; a fragility is fitted to two or more"))
}

/// The capacity of one curve; none of stripes.
fn told_alone(capacity: Evidence, unit: &str) -> Option<String> {
    Some(match capacity {
        Evidence::At(at) => format!("reached at {} {unit} by the one curve", shown(at)),
        Evidence::Within([from, to]) => {
            format!("reached between {} and {} {unit} by the one curve", shown(from), shown(to))
        }
        Evidence::Above(from) => format!("not reached up to {} {unit} by the one curve", shown(from)),
        Evidence::Below(to) => {
            format!("reached at {} {unit} already, the lowest that was run, by the one curve", shown(to))
        }
        Evidence::Stripe { .. } => return None,
    })
}

/// A fit in a line.
fn line(analysis: &Analysis, found: &Found) -> String {
    let settings = &analysis.settings;
    let unit = settings.intensity.unit();
    match &found.fit {
        Ok(f) => format!(
            "  {} ({}): median {} {unit} ({}), dispersion {} ({}){}{}\n",
            found.limit,
            found.method,
            shown(f.median),
            ends(f.median_interval),
            shown(f.dispersion),
            ends(f.dispersion_interval),
            settings.hazard.as_ref().map_or(String::new(), |hazard| often(hazard, f)),
            f.doubt().map_or(String::new(), |doubt| format!("; {doubt}")),
        ),
        Err(cause) => {
            let told = alone(analysis, &found.limit).unwrap_or_else(|| format!("no fragility is fitted: {cause}"));
            format!("  {} ({}): {told}\n", found.limit, found.method)
        }
    }
}

/// What is to be known of capacities before their fit is believed.
fn doubts(analysis: &Analysis) -> Vec<String> {
    let curves = usable(analysis);
    let of = |(name, value): &(String, f64)| {
        let again = curves.iter().filter(|c| c.below_again(*value) > 0).count();
        let between = curves.iter().filter(|c| matches!(c.capacity(*value), Evidence::Within(_))).count();
        let all = counted(curves.len(), "curve");
        [
            (again > 0).then(|| {
                format!("{name}: {again} of {all} fall below the limit again at a higher intensity; their lowest crossing counts")
            }),
            (between > 0).then(|| {
                format!(
                    "{name}: {between} of {all} reach the limit between two runs that are far apart, or jump over it, and count as anywhere between them; runs between \
                     narrow the intervals"
                )
            }),
        ]
    };
    analysis.settings.limits.iter().flat_map(of).flatten().collect()
}

fn usable<'a>(analysis: &'a Analysis) -> Vec<&'a Curve> {
    analysis.curves.iter().filter(|c| c.failed.is_none() && !c.points.is_empty()).collect()
}

fn write(plan: &Plan, analysis: &Analysis, out: &Path) -> std::result::Result<PathBuf, Failure> {
    let (s, curves) = (&analysis.settings, usable(analysis));
    let (middle, found) = (fractiles(&curves), fragilities(s, &curves));
    let all: [(&str, &str, Table); 5] = [
        ("ida", "All runs of all curves", tables::runs(s, &analysis.curves)),
        ("capacities", "Intensity at which each curve reaches each limit", tables::capacities(s, &analysis.curves)),
        ("fractiles", "Fractiles of the damage", tables::fractiles(s, &middle)),
        ("fragility", "Fitted lognormals", tables::fits(s, &found)),
        ("fragility_curves", "Fragilities with their bands", tables::fragilities(s, &found)),
    ];
    for (name, _, table) in &all {
        table::write_csv(table, &out.join(format!("{name}.csv")))?;
        table::write_parquet(table, &out.join(format!("{name}.parquet")))?;
    }
    let [runs, capacities, middle_table, fits, _] = all.map(|(_, caption, table)| (caption.to_string(), table));
    let incremental = Section {
        title: "Incremental dynamic analysis".into(),
        text: vec![
            "Every motion at rising intensity. Between two runs curves are straight in the logarithms of intensity and \
             damage, unless damage jumps. Fractiles are those of the damage over the curves at one intensity; where so many curves have collapsed \
             they end."
                .into(),
        ],
        figures: vec![curves_figure(s, &curves, &middle)],
        tables: vec![capacities, middle_table, runs],
        ..Section::default()
    };
    let mut text: Vec<String> = found.iter().map(|f| line(analysis, f).trim().to_string()).collect();
    text.extend(doubts(analysis).into_iter().map(|told| format!("Warning: {told}.")));
    let percent = 100.0 * s.confidence;
    text.insert(
        0,
        format!(
            "Lognormal fragilities by maximum likelihood, of the capacities of the records (those that did not reach the limit \
             included) and, where all motions were run at the same intensities, of the counts at each. Intervals and bands \
             hold with {percent} % confidence and are those of the profile of the likelihood; they speak of these records as \
             a sample, not of the model."
        ),
    );
    let fragility = Section {
        title: "Fragility".into(),
        text,
        figures: fragility_figure(s, &found),
        tables: vec![fits],
        ..Section::default()
    };
    let case = plan.case(0)?;
    let mut first = asked::section(plan, "curve", Some(&case), trouble(plan, analysis))?;
    let stops = analysis.stops && case.model == ModelKind::Planar;
    let stops =
        if stops { " A run ends when the wall has collapsed: its damage is that of the time before." } else { "" };
    let asked = first.text.iter().position(|text| text.starts_with("Asked")).map_or(0, |place| place + 1);
    first.text.insert(asked, ways(s) + stops);
    let name = |path: Option<&Path>| path.map_or(String::new(), |p| p.display().to_string());
    let title = if plan.file.study.title.is_empty() { "Incremental dynamic analysis" } else { &plan.file.study.title };
    let facts = [
        ("study file", name(plan.file.document.path())),
        ("wall file", name(plan.file.wall.path())),
        ("curves", analysis.curves.len().to_string()),
        ("runs", analysis.curves.iter().map(|c| c.points.len()).sum::<usize>().to_string()),
        ("runs with warnings", warned(plan, analysis).runs.to_string()),
        ("failed curves", analysis.curves.iter().filter(|c| c.failed.is_some()).count().to_string()),
    ];
    super::tell_others(out, Kind::Ida);
    super::write(out, title, &facts, &[first, fragility, incremental])
}

/// Which intensities each curve was asked for, and what counts as what.
fn ways(s: &Settings) -> String {
    let unit = s.intensity.unit();
    let of = |v: f64| format!("{} {unit}", shown(v)).trim_end().to_string();
    let damage = |v: f64| format!("{} {}", shown(v), s.unit).trim_end().to_string();
    let way = match &s.way {
        Way::List(list) => format!("at {}", list.iter().map(|v| of(*v)).collect::<Vec<_>>().join(", ")),
        Way::Hunt { first, step, growth, most, runs, resolution } => format!(
            "from {} in steps of {} that grow by {}, up to {}, {} each, gaps that hold a collapse or a limit closed to {} of it",
            of(*first),
            of(*step),
            of(*growth),
            of(*most),
            counted(*runs, "run"),
            plain(*resolution)
        ),
    };
    let limits: Vec<String> = s.limits.iter().map(|(name, v)| format!("{name} ({})", damage(*v))).collect();
    let collapse = match s.collapse.is_finite() {
        true => {
            format!("{} counts as collapse, and so does a run that the solver could not finish", damage(s.collapse))
        }
        false => "a run that the solver could not finish counts as collapse".into(),
    };
    let quantity = intensity(s).quantity;
    format!("Intensities: {quantity} {way}. Damage: {}; limits {}; {collapse}.", s.damage, limits.join(", "))
}

/// What became of the curves.
fn trouble(plan: &Plan, analysis: &Analysis) -> asked::Trouble {
    let failed: Vec<&Curve> = analysis.curves.iter().filter(|c| c.failed.is_some()).collect();
    let runs: usize = analysis.curves.iter().map(|c| c.points.len()).sum();
    let collapsed = analysis.curves.iter().flat_map(|c| &c.points).filter(|p| p.collapsed).count();
    let curves = counted(analysis.curves.len(), "curve");
    let mut told = format!("{curves} of {} in all; {collapsed} of them count as collapse", counted(runs, "run"));
    if missing(analysis) > 0 {
        told += &format!("; {} not done yet", counted(missing(analysis), "curve"));
    }
    told += &match failed.len() {
        0 => ".".to_string(),
        n => format!("; {} failed and cannot be used.", counted(n, "curve")),
    };
    let mut table = Table::default();
    table.texts("curve", failed.iter().map(|c| Some(c.name.clone())).collect());
    table.texts("cause", failed.iter().map(|c| c.failed.clone()).collect());
    asked::Trouble { warned: warned(plan, analysis), told: vec![told], runs: (!failed.is_empty()).then_some(table) }
}

fn intensity(s: &Settings) -> Axis {
    let unit = s.intensity.unit();
    let quantity = match s.intensity {
        concio_study::intensity::Intensity::Sa => format!("Sa({} s)", s.period),
        other => other.name().into(),
    };
    Axis { quantity, unit, ..Axis::default() }
}

fn curves_figure(s: &Settings, curves: &[&Curve], middle: &[(f64, [f64; 3])]) -> Figure {
    let mut lines: Vec<Line> = Vec::new();
    for curve in curves {
        let standing = curve.points.iter().filter(|p| !p.collapsed);
        let (x, y): (Vec<f64>, Vec<f64>) =
            std::iter::once((0.0, 0.0)).chain(standing.filter_map(|p| Some((p.damage?, p.intensity)))).unzip();
        lines.push(Line { x: x.into(), y: y.into(), style: ONE });
    }
    for k in 0..SHARES.len() {
        let (x, y): (Vec<f64>, Vec<f64>) =
            middle.iter().filter(|(_, q)| q[k].is_finite()).map(|(y, q)| (q[k], *y)).unzip();
        lines.push(Line { x: x.into(), y: y.into(), style: if k == 1 { MIDDLE } else { OUTER } });
    }
    let panel = Panel {
        heading: String::new(),
        x: Axis { quantity: s.damage.replace('_', " "), unit: s.unit, ..Axis::default() },
        y: intensity(s),
        lines,
        rising: false,
        bare: false,
        marked: false,
    };
    let legend = legend([(MIDDLE, "50 %"), (OUTER, "16 and 84 %"), (ONE, "one motion")]);
    let title = "Incremental dynamic analysis".to_string();
    let sheet = Sheet { title, legend, panels: vec![panel], columns: 1, width: SIZE[0], height: Some(SIZE[1]) };
    let caption = format!(
        "{} of each motion at rising {}, and its fractiles; a curve ends where the wall collapses.",
        s.damage,
        label(s.intensity.name(), s.intensity.unit())
    );
    Figure { name: "ida".into(), caption, drawing: chart::draw(&sheet) }
}

/// Names at their places in the styles.
fn legend<const N: usize>(names: [(usize, &str); N]) -> Vec<String> {
    let mut all = vec![String::new(); names.iter().map(|n| n.0).max().map_or(0, |n| n + 1)];
    names.into_iter().for_each(|(style, name)| all[style] = name.into());
    all
}

fn fragility_figure(s: &Settings, found: &[Found]) -> Vec<Figure> {
    let panel = |f: &Found| {
        let fit = f.fit.as_ref().ok()?;
        let y = grid(fit);
        let (mut middle, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
        for &y in &y {
            let band = fit.band(y);
            middle.push(fit.probability(y));
            low.push(band[0]);
            high.push(band[1]);
        }
        let curve = |p: Vec<f64>, style| Line { x: y.clone().into(), y: p.into(), style };
        let mut lines = vec![curve(low, OUTER), curve(high, OUTER), curve(middle, MIDDLE)];
        let mark = |(x, p): (f64, f64)| Line { x: vec![x].into(), y: vec![p].into(), style: ONE };
        lines.extend(points(&f.evidence).into_iter().map(mark));
        let probability = Axis { quantity: "probability".into(), range: Some([-0.03, 1.03]), ..Axis::default() };
        let heading = format!("{}, from {}", f.limit, f.method);
        Some(Panel { heading, x: intensity(s), y: probability, lines, rising: true, bare: false, marked: false })
    };
    let panels: Vec<Panel> = found.iter().filter_map(panel).collect();
    if panels.is_empty() {
        return Vec::new();
    }
    let columns = panels.len().min(2);
    let legend = legend([(MIDDLE, "fit"), (OUTER, "band of confidence"), (ONE, "records")]);
    let height = Some(SIZE[1] * if columns == 1 { 1.0 } else { 0.7 });
    let sheet = Sheet { title: "Fragility".into(), legend, panels, columns, width: SIZE[0], height };
    let caption =
        "Probability of reaching each limit; points: share of the records that reach it at that intensity.".into();
    vec![Figure { name: "fragility".into(), caption, drawing: chart::draw(&sheet) }]
}

/// Share of the records that reach the limit: at each stripe, or at each capacity, where records that did not reach the limit
/// count as long as they are known to stand (Kaplan and Meier).
fn points(evidence: &[Evidence]) -> Vec<(f64, f64)> {
    let stripe = |e: &Evidence| match e {
        Evidence::Stripe { intensity, reached, of } => Some((*intensity, *reached as f64 / (*of).max(1) as f64)),
        _ => None,
    };
    let stripes: Vec<(f64, f64)> = evidence.iter().filter_map(stripe).collect();
    if !stripes.is_empty() {
        return stripes;
    }
    let place = |e: &Evidence| match e {
        Evidence::At(y) | Evidence::Below(y) => Some((*y, true)),
        Evidence::Within([low, high]) => Some(((low * high).sqrt(), true)),
        Evidence::Above(y) => Some((*y, false)),
        Evidence::Stripe { .. } => None,
    };
    let mut all: Vec<(f64, bool)> = evidence.iter().filter_map(place).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let (mut standing, mut found) = (1.0, Vec::new());
    for (k, (y, reached)) in all.iter().enumerate() {
        if *reached {
            standing *= 1.0 - 1.0 / (all.len() - k) as f64;
            found.push((*y, 1.0 - standing));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four records, the second lost from sight at 0.3: 1/4, then 1 − ¾ · ½, then all.
    #[test]
    fn shares_of_records_that_are_known_to_stand() {
        let evidence = [Evidence::At(0.5), Evidence::At(0.2), Evidence::Above(0.3), Evidence::At(0.9)];
        assert_eq!(points(&evidence), [(0.2, 0.25), (0.5, 0.625), (0.9, 1.0)]);
        let stripe = [Evidence::Stripe { intensity: 0.4, reached: 1, of: 4 }];
        assert_eq!(points(&stripe), [(0.4, 0.25)]);
    }

    /// A curve that ends below its limit, and one that begins above it.
    #[test]
    fn what_one_curve_found_is_told_as_it_is() {
        for (capacity, told) in [
            (Evidence::At(2.5), "reached at 2.500 m/s² by the one curve"),
            (Evidence::Within([2.0, 3.0]), "reached between 2 and 3 m/s² by the one curve"),
            (Evidence::Above(4.0), "not reached up to 4 m/s² by the one curve"),
            (Evidence::Below(1.0), "reached at 1 m/s² already, the lowest that was run, by the one curve"),
        ] {
            assert_eq!(told_alone(capacity, "m/s²").as_deref(), Some(told));
        }
        assert_eq!(told_alone(Evidence::Stripe { intensity: 0.4, reached: 1, of: 4 }, "m/s²"), None);
    }
}
