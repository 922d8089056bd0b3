//! Fits of fragilities against known lognormals: medians, dispersions and bands that hold them as often as they say.

use concio::dice::Dice;
use concio_study::ida::fragility::{Fragility, fit};
use concio_study::ida::likelihood::{Evidence, phi};

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
}
