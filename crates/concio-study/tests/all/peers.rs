//! Statistics, spectra and searches against SALib, SciPy, eqsig and pycma on the same numbers. They need a Python that has these, named by CONCIO_PYTHON.

use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use concio::dice::Dice;
use concio::ground::formats::read;
use concio::ground::record::TextOptions;
use concio::ground::{measure, response_spectrum};
use concio_study::cma::Cma;
use concio_study::ida::fragility::fit;
use concio_study::ida::likelihood::Evidence;
use concio_study::sensitivity::{morris, ranks, sobol};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// What the peers answer; none where there is no Python.
fn peers<T: DeserializeOwned>(question: &Value) -> Option<T> {
    let Some(python) = std::env::var_os("CONCIO_PYTHON") else {
        concio_verified::skip(&format!("{} of other programs (CONCIO_PYTHON is not set)", question["what"]));
        return None;
    };
    let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/python/peers.py");
    let mut command = Command::new(python);
    command.arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("Python starts");
    child.stdin.take().expect("its input").write_all(question.to_string().as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).expect("an answer"))
}

fn near(what: &str, found: f64, peer: f64, within: f64) {
    let off = (found - peer).abs();
    println!("{what}: {found} here, {peer} there, {off:.1e} apart");
    assert!(off <= within, "{what}: {found} here, {peer} there");
}

/// Ishigami's function of three shares.
fn ishigami(x: &[f64]) -> f64 {
    let x: Vec<f64> = x.iter().map(|x| std::f64::consts::TAU * (x - 0.5)).collect();
    x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
}

#[derive(Deserialize)]
struct Shares {
    first: Vec<f64>,
    total: Vec<f64>,
    half_first: Vec<f64>,
    half_total: Vec<f64>,
}

#[test]
fn shares_of_the_variance_are_those_of_salib() {
    let (n, k) = (512, 3);
    let mut dice = Dice::new(11);
    let mut base = || -> Vec<Vec<f64>> { (0..n).map(|_| (0..k).map(|_| dice.unit()).collect()).collect() };
    let (a, b) = (base(), base());
    let mixed = |f: usize| {
        let row = move |(a, b): (&Vec<f64>, &Vec<f64>)| {
            let mut row = a.clone();
            row[f] = b[f];
            row
        };
        a.iter().zip(&b).map(row).collect::<Vec<_>>()
    };
    let blocks = [a.clone(), b.clone(), mixed(0), mixed(1), mixed(2)];
    // Far from 0, as measures are.
    let values: Vec<f64> = blocks.iter().flatten().map(|x| 40.0 + ishigami(x)).collect();
    let Some(peer) = peers::<Shares>(&json!({ "what": "sobol", "values": values, "factors": k })) else { return };
    let values: Vec<Option<f64>> = values.into_iter().map(Some).collect();
    let found = sobol::shares(&values, k, 0.95).expect("shares");
    for (f, shares) in found.iter().enumerate() {
        near(&format!("S of x{f}"), shares.first.value, peer.first[f], 1e-10);
        near(&format!("T of x{f}"), shares.total.value, peer.total[f], 1e-10);
        for (what, index, half) in [("S", shares.first, peer.half_first[f]), ("T", shares.total, peer.half_total[f])] {
            let own = 0.5 * (index.interval[1] - index.interval[0]);
            near(&format!("half the interval of {what} of x{f}"), own, half, 0.25 * half + 1e-3);
        }
    }
}

#[derive(Deserialize)]
struct Effects {
    mu: Vec<f64>,
    mu_star: Vec<f64>,
    sigma: Vec<f64>,
}

#[test]
fn elementary_effects_are_those_of_salib() {
    let (k, levels, trajectories) = (3usize, 4usize, 25);
    let way = levels as f64 / (2.0 * (levels as f64 - 1.0));
    let mut dice = Dice::new(5);
    let mut shares = Vec::new();
    for _ in 0..trajectories {
        let mut at: Vec<f64> = (0..k).map(|_| dice.below(levels / 2) as f64 / (levels as f64 - 1.0)).collect();
        shares.push(at.clone());
        let mut order: Vec<usize> = (0..k).collect();
        dice.shuffle(&mut order);
        for factor in order {
            at[factor] += way;
            shares.push(at.clone());
        }
    }
    let values: Vec<f64> = shares.iter().map(|x| ishigami(x)).collect();
    let question = json!({ "what": "morris", "shares": shares, "values": values, "levels": levels });
    let Some(peer) = peers::<Effects>(&question) else { return };
    let values: Vec<Option<f64>> = values.into_iter().map(Some).collect();
    let found = morris::effects(&shares, &values, &[true; 3], 0.95).expect("effects");
    for (f, effect) in found.iter().enumerate() {
        near(&format!("μ of x{f}"), effect.mean.value, peer.mu[f], 1e-9);
        near(&format!("μ* of x{f}"), effect.absolute.value, peer.mu_star[f], 1e-9);
        near(&format!("σ of x{f}"), effect.deviation.value, peer.sigma[f], 1e-9);
    }
}

#[derive(Deserialize)]
struct Ranks {
    coefficients: Vec<f64>,
    explained: f64,
}

#[test]
fn rank_coefficients_are_those_of_scipy() {
    let mut dice = Dice::new(8);
    let shares: Vec<Vec<f64>> = (0..80).map(|_| (0..3).map(|_| (9.0 * dice.unit()).floor()).collect()).collect();
    let values: Vec<f64> = shares.iter().map(|x| (x[0] + 2.0 * x[1]).powi(3) - x[2] + dice.normal()).collect();
    let question = json!({ "what": "ranks", "shares": shares, "values": values });
    let Some(peer) = peers::<Ranks>(&question) else { return };
    let values: Vec<Option<f64>> = values.into_iter().map(Some).collect();
    let (found, explained) = ranks::coefficients(&shares, &values, &[true; 3], (&[0; 80], 0.95)).expect("coefficients");
    for (f, index) in found.iter().enumerate() {
        near(&format!("b of x{f}"), index.expect("an order").value, peer.coefficients[f], 1e-10);
    }
    near("R²", explained, peer.explained, 1e-10);
}

#[derive(Deserialize)]
struct Fitted {
    median: f64,
    dispersion: f64,
    medians: [f64; 2],
    dispersions: [f64; 2],
}

/// Capacities, those between two runs, records that stand, and stripes; the intervals are where the profile of the likelihood has fallen by what Student's law
/// makes of n capacities.
#[test]
fn fragilities_and_their_intervals_are_those_of_scipy() {
    let confidence = 0.95;
    let mut dice = Dice::new(21);
    let drawn: Vec<f64> = (0..20).map(|_| 3.0 * (0.4 * dice.normal()).exp()).collect();
    let (found, rest) = drawn.split_at(9);
    let (bracketed, standing) = rest.split_at(7);
    let between: Vec<[f64; 2]> = bracketed.iter().map(|y| [0.85 * y, 1.2 * y]).collect();
    let above: Vec<f64> = standing.iter().map(|y| 0.7 * y).collect();
    let stripes = [[1.5, 1.0, 12.0], [2.5, 3.0, 12.0], [4.0, 10.0, 12.0]];
    let located = (found.len() + between.len()) as f64;
    let t = StudentsT::new(0.0, 1.0, located - 1.0).expect("a law").inverse_cdf(0.5 + 0.5 * confidence);
    // Half of what one quantity may cost in twice the likelihood: n ln(1 + t²/(n − 1)), which is χ² of many.
    let fall = 0.5 * located * (t * t / (located - 1.0)).ln_1p();
    for all in [true, false] {
        let none: [[f64; 3]; 0] = [];
        let stripes: &[[f64; 3]] = if all { &stripes } else { &none };
        let question = json!({
            "what": "fragility", "capacities": found, "between": between, "above": above, "stripes": stripes, "fall": fall
        });
        let Some(peer) = peers::<Fitted>(&question) else { return };
        let mut evidence: Vec<Evidence> = found.iter().map(|y| Evidence::At(*y)).collect();
        evidence.extend(between.iter().map(|ends| Evidence::Within(*ends)));
        evidence.extend(above.iter().map(|y| Evidence::Above(*y)));
        let stripe = |s: &[f64; 3]| Evidence::Stripe { intensity: s[0], reached: s[1] as usize, of: s[2] as usize };
        evidence.extend(stripes.iter().map(stripe));
        let own = fit(&evidence, confidence).expect("a fragility");
        near("θ", own.median, peer.median, 1e-5);
        near("β", own.dispersion, peer.dispersion, 1e-5);
        for k in 0..2 {
            near("end of the interval of θ", own.median_interval[k], peer.medians[k], 1e-4);
            near("end of the interval of β", own.dispersion_interval[k], peer.dispersions[k], 1e-4);
        }
    }
}

#[derive(Deserialize)]
struct Spectra {
    eqsig: Vec<f64>,
    own: Vec<f64>,
    arias: f64,
    significant: f64,
}

/// A record of the guide: at its samples eqsig sees up to 1.3 % less than there is; the recurrence at a twentieth of the step agrees within 2e-4, by which the
/// parabola through a turn misses it.
#[test]
fn spectra_are_those_of_eqsig_and_of_nigam_and_jennings() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/quake.at2");
    let record = read(&path, &TextOptions::default()).expect("a record").remove(0);
    let periods = [0.15, 0.3, 0.5, 1.0, 2.0, 3.5];
    for damping in [0.02, 0.05, 0.2] {
        let question = json!({
            "what": "spectra", "dt": record.dt, "acceleration": record.acceleration, "damping": damping, "periods": periods
        });
        let Some(peer) = peers::<Spectra>(&question) else { return };
        let found = response_spectrum(record.dt, &record.acceleration, damping, &periods).sd;
        for (k, period) in periods.iter().enumerate() {
            near(&format!("S_d at {period} s, ζ = {damping}"), found[k], peer.own[k], 2e-4 * found[k]);
            let at_samples = peer.eqsig[k] / found[k];
            assert!((0.987..1.0 + 2e-4).contains(&at_samples), "{at_samples} at {period} s, ζ = {damping}");
        }
        let measured = measure(&record);
        near("Arias intensity", measured.arias, peer.arias, 1e-10 * peer.arias);
        // eqsig counts whole samples.
        near("significant duration", measured.d5_95, peer.significant, 2.0 * record.dt);
    }
}

#[derive(Deserialize)]
struct Evaluations {
    evaluations: Vec<u64>,
}

fn middle(mut counts: Vec<u64>) -> f64 {
    counts.sort_unstable();
    counts[counts.len() / 2] as f64
}

/// The strategy needs as many evaluations as that of its author, on a function without and one with a curved valley.
#[test]
fn the_strategy_is_as_good_as_pycma() {
    let ellipsoid = |x: &[f64]| -> f64 {
        x.iter().enumerate().map(|(i, v)| 10f64.powf(6.0 * i as f64 / (x.len() - 1) as f64) * v * v).sum()
    };
    let rosenbrock =
        |x: &[f64]| -> f64 { x.windows(2).map(|p| 100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2)).sum() };
    let (population, repeats, goal) = (10, 21, 1e-9);
    type Function<'f> = &'f dyn Fn(&[f64]) -> f64;
    let functions: [(&str, Function, f64); 2] = [("ellipsoid", &ellipsoid, 1.0), ("rosenbrock", &rosenbrock, 0.0)];
    for (name, function, from) in functions {
        let (start, sigma) = ([from; 5], 0.5);
        let question = json!({
            "what": "strategy", "function": name, "start": start, "sigma": sigma, "population": population, "repeats": repeats, "goal": goal
        });
        let Some(peer) = peers::<Evaluations>(&question) else { return };
        let run = |seed: u64| {
            let mut strategy = Cma::new(&start, sigma, population, seed);
            let mut count = 0;
            loop {
                let mut points = strategy.ask();
                points.sort_by(|a, b| function(a).total_cmp(&function(b)));
                count += points.len() as u64;
                if function(&points[0]) <= goal || count > 100_000 {
                    return count;
                }
                strategy.tell(&points);
            }
        };
        let [own, peer] = [middle((1..=repeats).map(run).collect()), middle(peer.evaluations)];
        println!("{name}: {own} evaluations here, {peer} of pycma");
        assert!((own / peer).ln().abs() < 1.25f64.ln(), "{name}: {own} evaluations here, {peer} of pycma");
    }
}
