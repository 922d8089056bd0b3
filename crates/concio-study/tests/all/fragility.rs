//! Fits of fragilities against known lognormals: medians, dispersions and bands that hold them as often as they say.

use concio::dice::Dice;
use concio_study::ida::Way;
use concio_study::ida::curve::{Curve, Point};
use concio_study::ida::fragility::{Fragility, fit, fit_clusters, fit_curves};
use concio_study::ida::likelihood::{Evidence, phi};
use concio_verified::agrees;

const MEDIAN: f64 = 0.45;
const DISPERSION: f64 = 0.4;
const TRIALS: usize = 200;

/// How often median, dispersion and the probabilities at three intensities lie in their intervals, over repeated draws.
fn coverage(draw: &mut dyn FnMut() -> Vec<Evidence>) -> [f64; 5] {
    let at = [0.3, 0.5, 0.8];
    let mut held = [0; 5];
    let mut fitted = 0;
    for _ in 0..TRIALS {
        let Ok(found) = fit(&draw(), 0.95) else { continue };
        fitted += 1;
        let within = |[low, high]: [f64; 2], v: f64| usize::from(low <= v && v <= high);
        held[0] += within(found.median_interval, MEDIAN);
        held[1] += within(found.dispersion_interval, DISPERSION);
        for (k, y) in at.into_iter().enumerate() {
            held[2 + k] += within(found.band(y), phi((y / MEDIAN).ln() / DISPERSION));
        }
    }
    assert!(fitted >= TRIALS - 2, "{fitted} of {TRIALS} were fitted");
    held.map(|n| n as f64 / fitted as f64)
}

fn holds(shares: [f64; 5]) {
    // 200 trials at 95 %: three deviations are 4.6 %.
    assert!(shares.iter().all(|s| (0.90..=0.99).contains(s)), "{shares:?}");
}

fn capacity(dice: &mut Dice) -> f64 {
    MEDIAN * (DISPERSION * dice.normal()).exp()
}

/// Part of `trials` fits whose intervals hold the median and the dispersion, and how many could be fitted.
fn held(trials: usize, fitted: &mut dyn FnMut() -> Option<Fragility>) -> ([f64; 2], usize) {
    let (mut held, mut all) = ([0usize; 2], 0);
    for found in (0..trials).filter_map(|_| fitted()) {
        let within = |[low, high]: [f64; 2], v: f64| usize::from(low <= v && v <= high);
        all += 1;
        held[0] += within(found.median_interval, MEDIAN);
        held[1] += within(found.dispersion_interval, DISPERSION);
    }
    (held.map(|n| n as f64 / all as f64), all)
}

/// How often both intervals hold what they estimate, each with its subject.
fn covering(what: &str, case: &str, shares: [f64; 2]) -> impl Iterator<Item = (String, f64)> {
    let of = move |(share, of): (f64, &str)| {
        (format!("Statistics: part of 95 % intervals of a fragility's {of} that hold it, {what}; {case}"), share)
    };
    shares.into_iter().zip(["median", "dispersion"]).map(of).collect::<Vec<_>>().into_iter()
}

/// Intervals of few records are Student's: two say next to nothing.
#[test]
fn intervals_of_few_records_cover() {
    let mut dice = Dice::new(11);
    for n in [2, 3, 5, 12, 40] {
        let mut draw = || fit(&(0..n).map(|_| Evidence::At(capacity(&mut dice))).collect::<Vec<_>>(), 0.95).ok();
        let (shares, fitted) = held(1000, &mut draw);
        assert_eq!(fitted, 1000);
        for (subject, share) in covering("capacities found", &format!("{n} records"), shares) {
            agrees!(subject, "0.90 to 0.98", "", share, 0.94, abs: 0.04);
        }
    }
    // t(0.975, 1) = 12.706: the half-width of ln θ is t s/√2, s that over n − 1.
    let found = fit(&[Evidence::At(8.0), Evidence::At(10.0)], 0.95).expect("two capacities");
    let half = 12.706_2 * 0.5 * (10f64 / 8.0).ln();
    agrees!(
        "Statistics: upper end of the 95 % interval of the median of two capacities, 8 and 10",
        "√80 e^(t s/√2), t(0.975, 1) = 12.7062",
        "",
        found.median_interval[1],
        80f64.sqrt() * half.exp(),
        1e-4
    );
}

/// Draws of the parameters under each motion: the median is as certain as the motions are many, and the dispersion between that and as the draws are many. `part` of the variance is that
/// of the motions.
fn draws(dice: &mut Dice, [motions, each]: [usize; 2], part: f64) -> (Vec<Evidence>, Vec<usize>) {
    let [between, rest] = [part, 1.0 - part].map(|part: f64| DISPERSION * part.sqrt());
    let of = |motion: usize, dice: &mut Dice| {
        let own = between * dice.normal();
        (0..each).map(|_| (Evidence::At(MEDIAN * (own + rest * dice.normal()).exp()), motion)).collect::<Vec<_>>()
    };
    (0..motions).flat_map(|motion| of(motion, dice)).unzip()
}

#[test]
fn intervals_take_motions_as_clusters() {
    use concio_study::ida::hazard::Hazard;
    // λ = 1e-3 (y/θ)^−2.5: the rate is 1e-3 e^(k² β²/2).
    let at = |i: i32| MEDIAN * 10f64.powf(0.25 * f64::from(i - 16));
    let hazard = Hazard { points: (0..33).map(|i| [at(i), 1e-3 * (at(i) / MEDIAN).powf(-2.5)]).collect() };
    let rate = 1e-3 * (0.5 * (2.5 * DISPERSION).powi(2)).exp();
    for (between, motions, each) in [3.0, 0.3].into_iter().flat_map(|between| {
        let motions = [2, 4, 8, 20].into_iter();
        motions.flat_map(move |motions| [1, 8, 40].map(|each| (between, motions, each)))
    }) {
        let mut dice = Dice::new(12);
        let mut rates = [0.0; 2];
        let mut fitted = || {
            let (evidence, of) = draws(&mut dice, [motions, each], between / (1.0 + between));
            let found = fit_clusters(&evidence, &of, 0.95).ok()?;
            // Of many curves it takes its time.
            if (4..=64).contains(&evidence.len()) && motions > 2 {
                let [low, high] = hazard.of(&found).interval;
                rates = [rates[0] + f64::from(u8::from(low <= rate && rate <= high)), rates[1] + 1.0];
            }
            Some(found)
        };
        let (shares, all) = held(200, &mut fitted);
        assert_eq!(all, 200);
        let case =
            format!("{motions} motions, {each} draws each, {between} times as much variance between them as within");
        for (subject, share) in covering("draws under each motion", &case, shares) {
            agrees!(subject, "0.90 to 1.00", "", share, 0.95, abs: 0.05);
        }
        if rates[1] > 0.0 {
            let subject = format!(
                "Statistics: part of 95 % intervals of an annual rate that hold it, draws under each motion; {case}"
            );
            agrees!(subject, "0.90 to 1.00", "", rates[0] / rates[1], 0.95, abs: 0.05);
        }
    }
    // As independent runs they do not.
    let mut alone = Dice::new(12);
    let (naive, _) = held(400, &mut || fit(&draws(&mut alone, [8, 8], 0.75).0, 0.95).ok());
    assert!(naive.iter().all(|share| *share < 0.8), "{naive:?}");
}

/// Draws of what changes nothing add nothing: forty under each motion have the intervals of one, capacities that were found or not; draws that decide all alone nearly those of as many
/// independent ones.
#[test]
fn draws_that_change_nothing_add_nothing() {
    let known = [0.31, 0.42, 0.55, 0.38].map(Evidence::At);
    let vague = [Evidence::At(0.31), Evidence::Within([0.4, 0.5]), Evidence::Above(0.6), Evidence::At(0.38)];
    for evidence in [known, vague, known.map(|e| if e == known[0] { Evidence::Below(0.31) } else { e })] {
        let once = fit(&evidence, 0.95).expect("a fit");
        let all: Vec<Evidence> = (0..160).map(|run| evidence[run % 4]).collect();
        let of: Vec<usize> = (0..160).map(|run| run % 4).collect();
        let again = fit_clusters(&all, &of, 0.95).expect("a fit");
        let numbers = |f: &Fragility| {
            let ends = [f.median_interval, f.dispersion_interval, f.band(0.35), f.band(0.6)];
            [vec![f.median, f.dispersion], ends.concat()].concat()
        };
        for (once, again) in numbers(&once).into_iter().zip(numbers(&again)) {
            assert!((again / once - 1.0).abs() < 1e-6, "{once} {again} of {evidence:?}");
        }
        let most = |f: &Fragility| f.plausible().expect("ends").into_iter().map(|[_, d]| d).fold(0.0, f64::max);
        assert!((most(&again) / most(&once) - 1.0).abs() < 1e-6);
    }
    // At equal intensities too.
    let curves = |times: usize| {
        let records = [0.2, 0.31, 0.38, 0.42, 0.6, 1.2];
        let entries = (0..6 * times).flat_map(|curve| at_stripes(records[curve % 6]).map(|e| (e, (curve, curve % 6))));
        let (entries, of): (Vec<Evidence>, Vec<_>) = entries.unzip();
        let (each, motions): (Vec<usize>, Vec<usize>) = of.into_iter().unzip();
        fit_curves(&entries, [&each, &motions], 0.95).expect("a fit")
    };
    let [once, again] = [curves(1), curves(20)].map(|f| [f.median_interval, f.dispersion_interval].concat());
    assert!(once.iter().zip(&again).all(|(once, again)| (again / once - 1.0).abs() < 1e-6), "{once:?} {again:?}");
    let (evidence, of) = draws(&mut Dice::new(3), [40, 40], 0.0);
    let [motions, alone] = [fit_clusters(&evidence, &of, 0.95), fit(&evidence, 0.95)].map(|f| f.expect("a fit"));
    for (a, b) in motions.dispersion_interval.into_iter().zip(alone.dispersion_interval) {
        assert!((a / b - 1.0).abs() < 0.01, "{a} {b}");
    }
    agrees!(
        "Statistics: upper end of the 95 % interval of the dispersion of two capacities, 8 and 10, as of forty curves each that are the same",
        "β √r, r − ln r = 1 + ln(1 + t²), t(0.975, 1) = 12.7062",
        "",
        fit_clusters(
            &(0..80).map(|run| Evidence::At([8.0, 10.0][run % 2])).collect::<Vec<_>>(),
            &(0..80).map(|run| run % 2).collect::<Vec<_>>(),
            0.95
        )
        .expect("a fit")
        .dispersion_interval[1],
        0.5 * 1.25f64.ln() / UPPER_OF_TWO.sqrt(),
        1e-4
    );
}

/// r = β̂²/β² at the upper end of the dispersion of two capacities: r − ln r = 1 + ln(1 + 12.7062²) by hand, r = e^(r − 6.09034).
const UPPER_OF_TWO: f64 = 0.002_270_0;

/// The probability that a joint cracks, of runs under motions that differ: as the shares by motion vary, so wide is the interval.
#[test]
fn intervals_of_crack_maps_cover() {
    // By motion the probability is Φ(a + b x), so that its mean is Φ(a/√(1 + b²)).
    let cases = [
        (5, 30, 0.3, 1.0),
        (8, 30, 0.5, 1.5),
        (12, 10, 0.0, 0.6),
        (40, 6, -0.8, 1.0),
        (6, 10, -2.5, 1.0),
        (6, 10, -2.5, 0.3),
    ];
    for (motions, runs, a, b) in cases {
        let mut dice = Dice::new(16);
        let truth = phi(a / (1.0f64 + b * b).sqrt());
        let mut held = 0.0;
        for _ in 0..1000 {
            let of = |motion: usize, dice: &mut Dice| {
                let p = phi(a + b * dice.normal());
                (0..runs).map(|_| (motion, dice.unit() < p)).collect::<Vec<_>>()
            };
            let (of, hits): (Vec<_>, Vec<_>) = (0..motions).flat_map(|motion| of(motion, &mut dice)).unzip();
            let [low, high] = concio_study::crack_lines::interval(&of, &hits);
            held += f64::from(u8::from(low <= truth && truth <= high));
        }
        let subject = format!(
            "Statistics: part of 95 % intervals of a crack's probability that hold it; {motions} motions, {runs} runs each, {truth:.2}"
        );
        agrees!(subject, "0.90 to 1.00", "", held / 1000.0, 0.95, abs: 0.05);
    }
}

/// The intensities of stripes.
const STRIPES: [f64; 6] = [0.15, 0.25, 0.35, 0.5, 0.7, 1.0];

/// What a record says that reaches the limit at `own`.
fn at_stripes(own: f64) -> [Evidence; 6] {
    STRIPES.map(|y| if own <= y { Evidence::Below(y) } else { Evidence::Above(y) })
}

/// All records at the same intensities: what a record does at one of them is not independent of what it does at the next.
#[test]
fn intervals_of_stripes_cover() {
    for n in [12, 40] {
        let mut dice = Dice::new(13);
        let mut fitted = || {
            let of = |record: usize, dice: &mut Dice| at_stripes(capacity(dice)).map(|entry| (entry, record));
            let (entries, of): (Vec<_>, Vec<_>) = (0..n).flat_map(|record| of(record, &mut dice)).unzip();
            fit_clusters(&entries, &of, 0.95).ok()
        };
        let (shares, all) = held(400, &mut fitted);
        assert!(all >= 396, "{all}");
        for (subject, share) in covering("stripes of the same records", &format!("{n} records"), shares) {
            agrees!(subject, "0.90 to 0.98", "", share, 0.94, abs: 0.04);
        }
    }
    // Eight draws under each motion, whose own variance is three quarters of all.
    for motions in [4, 8] {
        let mut dice = Dice::new(19);
        let mut fitted = || {
            let (found, of) = draws(&mut dice, [motions, 8], 0.75);
            let own = |e: &Evidence| if let Evidence::At(y) = e { *y } else { f64::NAN };
            let entries: Vec<Evidence> = found.iter().flat_map(|e| at_stripes(own(e))).collect();
            let curves: Vec<usize> = (0..entries.len()).map(|entry| entry / 6).collect();
            let of: Vec<usize> = curves.iter().map(|curve| of[*curve]).collect();
            fit_curves(&entries, [&curves, &of], 0.95).ok()
        };
        let (shares, all) = held(200, &mut fitted);
        assert!(all >= 198, "{all}");
        for (subject, share) in
            covering("stripes, draws under each motion", &format!("{motions} motions, 8 draws each"), shares)
        {
            agrees!(subject, "0.90 to 1.00", "", share, 0.95, abs: 0.05);
        }
    }
}

/// A limit that damage jumps over, as where sliding begins: the runs of a hunt tell between which intensities, and the fit knows no more.
#[test]
fn intervals_of_jumps_cover() {
    let way = Way::Hunt { first: 0.05, step: 0.05, growth: 0.01, most: 3.0, runs: 14, resolution: 0.1 };
    let hunted = |own: f64| {
        let mut points: Vec<Point> = Vec::new();
        while let [y] = way.next(&points, &[1e-4])[..] {
            let damage = if y < own { 1e-7 * y } else { 1e-2 * (y / own - 1.0) + 2e-4 };
            let place = points.partition_point(|p| p.intensity < y);
            let run = Point {
                intensity: y,
                scale: y,
                damage: Some(damage),
                collapsed: false,
                id: String::new(),
                warnings: vec![],
            };
            points.insert(place, run);
        }
        assert_eq!(points.len(), 14);
        let curve = Curve { name: String::new(), motion: 0, number: 0, unit: 1.0, points, failed: None };
        if let Some((low, high)) = curve.bracket(1e-4) {
            assert!(low.is_none_or(|low| low.intensity < own) && own <= high.intensity);
        }
        curve.capacity(1e-4)
    };
    for n in [5, 12, 40] {
        let mut dice = Dice::new(14);
        let (shares, all) =
            held(200, &mut || fit(&(0..n).map(|_| hunted(capacity(&mut dice))).collect::<Vec<_>>(), 0.95).ok());
        assert!(all >= 196, "{all}");
        for (subject, share) in covering("limits that damage jumps over", &format!("{n} records, 14 runs each"), shares)
        {
            agrees!(subject, "0.90 to 0.98", "", share, 0.94, abs: 0.04);
        }
    }
}

/// Where nothing is known but between which runs capacities lie, the likelihood is that of intervals.
#[test]
fn intervals_of_capacities_are_fitted() -> Result<(), &'static str> {
    let mut dice = Dice::new(15);
    let edges: Vec<f64> = (0..40).map(|k| 0.05 * 1.15f64.powi(k)).collect();
    let within = |c: f64| {
        let upper = edges.partition_point(|e| *e < c);
        Evidence::Within([edges[upper - 1], edges[upper]])
    };
    let evidence: Vec<Evidence> = (0..20_000).map(|_| within(capacity(&mut dice))).collect();
    let found = fit(&evidence, 0.95)?;
    assert!(
        (found.median / MEDIAN - 1.0).abs() < 0.015 && (found.dispersion / DISPERSION - 1.0).abs() < 0.02,
        "{found:?}"
    );
    Ok(())
}

#[test]
fn capacities() {
    let mut dice = Dice::new(1);
    holds(coverage(&mut || (0..30).map(|_| Evidence::At(capacity(&mut dice))).collect()));
}

/// Records that did not reach the limit by 0.6, a quarter of all.
#[test]
fn capacities_of_which_some_are_not_known() {
    let mut dice = Dice::new(2);
    holds(coverage(&mut || {
        let of = |c: f64| if c > 0.6 { Evidence::Above(0.6) } else { Evidence::At(c) };
        (0..40).map(|_| of(capacity(&mut dice))).collect()
    }));
}

#[test]
fn stripes() {
    let mut dice = Dice::new(3);
    let intensities = [0.15, 0.25, 0.35, 0.5, 0.7, 1.0];
    holds(coverage(&mut || {
        let stripe = |intensity: f64, dice: &mut Dice| Evidence::Stripe {
            intensity,
            reached: (0..40).filter(|_| capacity(dice) <= intensity).count(),
            of: 40,
        };
        intensities.map(|y| stripe(y, &mut dice)).to_vec()
    }));
}

/// With very many records a fit comes back to what they were drawn from, whatever way.
#[test]
fn many_records_give_back_the_lognormal() -> Result<(), &'static str> {
    let mut dice = Dice::new(4);
    let all: Vec<f64> = (0..20_000).map(|_| capacity(&mut dice)).collect();
    let near =
        |f: &Fragility| (f.median / MEDIAN - 1.0).abs() < 0.015 && (f.dispersion / DISPERSION - 1.0).abs() < 0.02;
    let at: Vec<Evidence> = all.iter().map(|c| Evidence::At(*c)).collect();
    let cut: Vec<Evidence> =
        all.iter().map(|c| if *c > 0.5 { Evidence::Above(0.5) } else { Evidence::At(*c) }).collect();
    let stripe =
        |y: f64| Evidence::Stripe { intensity: y, reached: all.iter().filter(|c| **c <= y).count(), of: all.len() };
    for evidence in [at, cut, [0.2, 0.4, 0.6, 0.9].map(stripe).to_vec()] {
        let found = fit(&evidence, 0.95)?;
        assert!(near(&found), "{} {}", found.median, found.dispersion);
    }
    // A twentieth of a percent of capacities lie below this: far out the curve is still the lognormal's.
    let found = fit(&[Evidence::At(0.3), Evidence::At(0.6)], 0.95)?;
    assert!((found.probability(found.median) - 0.5).abs() < 1e-12 && found.probability(1e-9) < 1e-12);
    Ok(())
}

#[test]
fn limits_that_none_or_all_reach_say_so() {
    let why = |evidence: &[Evidence]| fit(evidence, 0.95).err().unwrap_or("was fitted");
    assert_eq!(why(&[Evidence::Above(0.4), Evidence::Above(0.6)]), "no record reaches the limit");
    assert!(why(&[Evidence::Below(0.4), Evidence::Below(0.6)]).contains("lowest intensity"));
    let stripe = |intensity, reached| Evidence::Stripe { intensity, reached, of: 4 };
    assert_eq!(why(&[stripe(0.1, 0), stripe(0.2, 0)]), "no record reaches the limit");
    assert!(why(&[stripe(0.1, 4), stripe(0.2, 4)]).contains("lowest intensity"));
    // From none to all between two intensities: any dispersion that is small enough.
    for evidence in [vec![stripe(0.5, 0), stripe(1.5, 4)], vec![Evidence::Above(0.5), Evidence::Below(0.8)]] {
        assert!(why(&evidence).contains("do not overlap"), "{}", why(&evidence));
    }
    // Of capacities nothing overlaps or not: all may be 0.8, or 0.51 but for the last digit.
    for evidence in [
        vec![Evidence::Within([0.5, 0.8]), Evidence::Within([0.8, 1.0])],
        vec![Evidence::At(0.5), Evidence::Within([0.5, 0.6]), Evidence::Within([0.4, 0.51])],
    ] {
        assert!(why(&evidence).contains("may be the capacity of all"), "{}", why(&evidence));
    }
    assert!(why(&[stripe(0.1, 3), stripe(0.2, 1)]).contains("does not rise enough"));
}

/// Over a hazard that falls as y^(−k) the rate is λ(θ) e^(k² β²/2) (Cornell); between points of a curve it is what a fine sum is, and its interval holds the truth.
#[test]
fn annual_rates_are_those_of_cornell() {
    use concio_study::ida::hazard::Hazard;
    let (k, at) = (2.5, 1e-3);
    let power = |points: usize| Hazard {
        points: (0..points)
            .map(|i| {
                let y = 1e-4 * 1e8f64.powf(i as f64 / (points - 1) as f64);
                [y, at * (y / MEDIAN).powf(-k)]
            })
            .collect(),
    };
    let expected = at * (0.5 * k * k * DISPERSION * DISPERSION).exp();
    for points in [2, 30] {
        let subject =
            format!("Statistics: annual rate of a limit over a hazard curve that is a power; {points} points");
        agrees!(subject, "λ(θ) e^(k² β²/2)", "1/year", power(points).rate(MEDIAN, DISPERSION), expected, 1e-9);
    }
    // A curve of a site, bent: a sum over fine steps, and the last point beyond.
    let points: Vec<[f64; 2]> = vec![[0.5, 0.05], [1.0, 0.01], [2.0, 1.5e-3], [5.0, 1e-4]];
    let rate = |y: f64| {
        let i = points.iter().rposition(|p| p[0] <= y).unwrap_or(0).min(points.len() - 2);
        let [[y0, r0], [y1, r1]] = [points[i], points[i + 1]];
        r0 * (y / y0).powf(-(r0 / r1).ln() / (y1 / y0).ln())
    };
    let (median, dispersion): (f64, f64) = (2.2, 0.45);
    let probability = |y: f64| phi((y / median).ln() / dispersion);
    let n = 200_000;
    let y = |i: usize| 0.5 * 10f64.powf(i as f64 / n as f64);
    let sum: f64 = (0..n).map(|i| probability((y(i) * y(i + 1)).sqrt()) * (rate(y(i)) - rate(y(i + 1)))).sum();
    let hazard = Hazard { points: points.clone() };
    agrees!(
        "Statistics: annual rate of a limit over a hazard curve of four points",
        "sum over 200,000 steps, and λ of the last point",
        "1/year",
        hazard.rate(median, dispersion),
        sum + 1e-4 * probability(5.0),
        1e-6
    );
    // Of a wide fragility the shifted normal law lies far in its tail: the sum has digits there too.
    let wide = |y: f64| phi(y.ln() / 4.0);
    let sum: f64 = (0..n).map(|i| wide((y(i) * y(i + 1)).sqrt()) * (rate(y(i)) - rate(y(i + 1)))).sum();
    let found = Hazard { points: points.clone() }.rate(1.0, 4.0);
    agrees!(
        "Statistics: annual rate of a limit with a dispersion of 4",
        "sum over 200,000 steps, and λ of the last point",
        "1/year",
        found,
        sum + 1e-4 * wide(5.0),
        1e-6
    );
    // How often the interval holds the rate of the lognormal that ten records were drawn from.
    let hazard = power(30);
    let mut dice = Dice::new(18);
    let mut held = 0.0;
    for _ in 0..400 {
        let found = fit(&(0..10).map(|_| Evidence::At(capacity(&mut dice))).collect::<Vec<_>>(), 0.95).expect("a fit");
        let [low, high] = hazard.of(&found).interval;
        held += f64::from(u8::from(low <= expected && expected <= high));
    }
    let subject = "Statistics: part of 95 % intervals of an annual rate that hold it, ten records";
    agrees!(subject, "0.90 to 0.98", "", held / 400.0, 0.94, abs: 0.04);
}

/// One motion, however often it was run, is no sample of motions: intervals are those of the draws under it, which is said, and rates have none.
#[test]
fn one_motion_is_told() {
    let evidence = [0.3, 0.4, 0.5, 0.7].map(Evidence::At);
    let found = fit_clusters(&evidence, &[3; 4], 0.95).expect("a fit");
    let draws = fit(&evidence, 0.95).expect("a fit");
    assert_eq!(found.median_interval, draws.median_interval);
    assert_eq!(found.dispersion_interval, draws.dispersion_interval);
    assert_eq!(found.plausible(), None);
    assert!(found.doubt().is_some_and(|doubt| doubt.contains("the scatter between records is not in them")));
    assert_eq!(fit(&evidence, 0.95).expect("a fit").doubt(), None);
    // Curves under it count once, however many intensities each was run at.
    let limits = [0.15, 0.35, 0.5, 0.55, 0.7];
    let runs = || (0..5).flat_map(|curve| [0.2, 0.4, 0.6, 0.8].map(|y| (curve, y)));
    let at =
        |(curve, y): (usize, f64)| Evidence::Stripe { intensity: y, reached: usize::from(y > limits[curve]), of: 1 };
    let (stripes, each): (Vec<Evidence>, Vec<usize>) =
        (runs().map(at).collect(), runs().map(|(curve, _)| curve).collect());
    let of_motions = |motions: &[usize]| fit_curves(&stripes, [&each, motions], 0.95).expect("a fit");
    let [alone, under_one] = [of_motions(&each), of_motions(&[0; 20])];
    assert_eq!(alone.median_interval, under_one.median_interval);
    assert_eq!(alone.dispersion_interval, under_one.dispersion_interval);
    // Two motions that reach the limit are two, whatever others do not.
    let mut many = vec![Evidence::At(0.3), Evidence::At(0.6)];
    many.extend([Evidence::Above(0.35); 8]);
    let pairs: Vec<usize> = (0..10).map(|k| k / 2 + usize::from(k == 1) * 9).collect();
    let [clustered, alone] = [fit_clusters(&many, &pairs, 0.95), fit(&many, 0.95)].map(|f| f.expect("a fit"));
    assert!(clustered.median_interval[1] >= 0.999 * alone.median_interval[1], "{clustered:?} {alone:?}");
}

/// A rate whose shaking below the first point of the curve may matter has no end above; one whose curve ends too low holds what lies beyond.
#[test]
fn rates_hold_what_a_hazard_curve_leaves_out() {
    use concio_study::ida::hazard::Hazard;
    let stripe = |intensity: f64, reached: usize| Evidence::Stripe { intensity, reached, of: 8 };
    // Two stripes that hardly rise: any dispersion up to infinity is as likely.
    let vague = fit(&[stripe(2.4, 3), stripe(2.8, 4)], 0.95).expect("a fit");
    assert_eq!(vague.plausible(), None);
    let site = Hazard { points: vec![[0.5, 0.03], [1.0, 0.01], [4.0, 2e-4]] };
    let rate = site.of(&vague);
    assert!(rate.interval[1].is_infinite() && rate.interval[0] < rate.value, "{rate:?}");
    assert!(rate.doubt().is_some_and(|doubt| doubt.contains("begin it lower")));
    // All records stand up to where the curve ends.
    let strong = fit(&[3.0, 3.4, 4.0, 4.2, 5.0].map(Evidence::At), 0.95).expect("a fit");
    let short = Hazard { points: vec![[0.5, 0.03], [1.0, 0.01]] };
    let rate = short.of(&strong);
    assert!(rate.value < 1e-6 && (rate.interval[1] / 0.01 - 1.0).abs() < 1e-3, "{rate:?}");
    assert!(rate.doubt().is_some_and(|doubt| doubt.contains("beyond")));
    // Numbers of a sentence have four digits.
    let weak = fit(&[0.4, 0.6, 0.7, 0.9].map(Evidence::At), 0.95).expect("a fit");
    let told = short.of(&weak).doubt().expect("a doubt");
    let digits = |word: &str| word.chars().filter(char::is_ascii_digit).count();
    assert!(told.contains('%') && told.split(' ').all(|word| digits(word) <= 9 && word.len() <= 12), "{told}");
    assert_eq!(Hazard { points: vec![[0.5, 0.03], [1.0, 0.01], [20.0, 1e-9]] }.of(&strong).doubt(), None);
}

/// What would end beyond all sense has no end: a median a factor of a million off, a dispersion above 100.
#[test]
fn senseless_ends_are_none() {
    let ends = |lowest: f64| {
        let found = fit(&[Evidence::At(lowest), Evidence::At(10.0)], 0.95).expect("a fit");
        [found.median_interval, found.dispersion_interval]
    };
    let [[low, high], [_, widest]] = ends(5.0);
    assert!(low > 0.0 && high.is_finite() && widest < 10.0, "{low} {high} {widest}");
    assert_eq!(ends(1e-4).map(|[_, high]| high), [f64::INFINITY; 2]);
    assert_eq!(ends(1e-4)[0][0], 0.0);
    assert!(ends(1e-4)[1][0] > 0.0);
}

/// One capacity says no more than two: of eight blocks that were run up to where the first overturned, whose median is 2.29, the interval of the median is no narrower than
/// that of two like ones.
#[test]
fn one_capacity_says_no_more_than_two() {
    let mut evidence = vec![Evidence::At(0.991)];
    evidence.extend([Evidence::Above(1.0); 7]);
    let one = fit(&evidence, 0.95).expect("a fit");
    assert!(one.median_interval[1] > 2.29, "{:?}", one.median_interval);
}
