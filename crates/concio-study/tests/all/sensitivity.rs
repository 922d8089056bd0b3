//! Sensitivity indices against functions whose indices are known.

use concio::dice::Dice;
use concio_study::Plan;
use concio_study::measures::{End, MEASURES, Row};
use concio_study::sensitivity::{Found, Indices, jackknife, morris, ranks, sensitivity, sobol, tables};
use concio_study::table::Cells;
use concio_verified::agrees;
use std::f64::consts::PI;

use crate::common::Desk;

/// What a count of intervals that hold the truth is held against.
const COVERAGE: &str = "0.90 to 0.98";

/// One motion for all runs, and the confidence.
const ALONE: (&[usize], f64) = (&[0; 1000], 0.95);

/// Keys that take any number: nothing is run.
const PATHS: [&str; 6] = [
    "joint.friction.beta",
    "joint.friction.alpha",
    "load.top",
    "panel[0].brick.length",
    "panel[0].brick.height",
    "panel[0].brick.thickness",
];

/// Points of a design, as a study makes them, without a wall.
fn points(kind: &str, runs: usize, k: usize) -> Vec<Vec<f64>> {
    seeded(kind, [runs, 5], k)
}

/// The same of another seed than 5.
fn seeded(kind: &str, [runs, seed]: [usize; 2], k: usize) -> Vec<Vec<f64>> {
    let vary: String = (0..k)
        .map(|i| format!("[[vary]]\nname = \"x{i}\"\npath = \"{}\"\nfrom = {}\nto = {}\n", PATHS[i], 10 + i, 900))
        .collect();
    let plan = plan(kind, runs, &format!("seed = {seed}\n{vary}"));
    let share = |at: &concio_study::design::At| match at {
        concio_study::design::At::Share(share) => *share,
        concio_study::design::At::Level(level) => *level as f64,
    };
    plan.points.iter().map(|row| row.iter().map(share).collect()).collect()
}

/// The plan of a design with some factors and questions.
fn plan(kind: &str, runs: usize, rest: &str) -> Plan {
    let runs = if runs > 0 { format!("runs = {runs}\n") } else { String::new() };
    let seed = if rest.starts_with("seed") { "" } else { "seed = 5\n" };
    let text = format!("wall = \"wall.toml\"\n[design]\nkind = \"{kind}\"\n{runs}{seed}{rest}");
    Desk::new(include_str!("../../../concio/tests/data/shear-panel.toml")).plan(&text).expect("a study")
}

/// What a study finds whose runs have `measured` for their largest slip, given the labels of their factors.
fn found(plan: &Plan, measured: impl Fn(&[serde_json::Value]) -> f64) -> Found {
    let place = MEASURES.iter().position(|m| m.name == "largest_slip").expect("a measure");
    let row = |number: usize| {
        let mut row = Row::failed("", "");
        (row.end, row.numbers) = (End::Completed, vec![None; MEASURES.len()]);
        row.numbers[place] = Some(measured(&plan.labels(number)));
        row
    };
    let rows: Vec<Row> = (0..plan.points.len()).map(row).collect();
    sensitivity(plan, &rows.iter().map(Some).collect::<Vec<_>>()).expect("indices").remove(0)
}

const ASKED: &str = "[sensitivity]\nof = [\"largest_slip\"]\n";

/// Values far from equal distances, in no order.
const UNEVEN: &str = "[[vary]]\npath = \"load.top\"\nvalues = [\"9 kN/m\", \"1 kN/m\", \"2 kN/m\", \"0 kN/m\"]\n";
const BETA: &str = "[[vary]]\npath = \"joint.friction.beta\"\nvalues = [50, 150]\n";

fn load(labels: &[serde_json::Value]) -> f64 {
    let text = labels[0].as_str().expect("a load");
    text.trim_end_matches(" kN/m").parse().expect("a number")
}

/// A measure that rises in proportion to a listed value has one elementary effect, that over the list's whole range, and no
/// scatter; steps by the place in the list would give effects of every size.
#[test]
fn listed_values_stand_where_their_numbers_do() {
    let study = plan("morris", 30, &format!("{UNEVEN}{BETA}{ASKED}"));
    let found = found(&study, |labels| 0.5 * load(labels));
    let Ok(Indices::Morris(effects)) = &found.indices else { panic!("{:?}", found.indices) };
    assert!((effects[0].mean.value - 4.5).abs() < 1e-12 && effects[0].deviation.value < 1e-12, "{:?}", effects[0]);
    assert_eq!(effects[1].absolute.value, 0.0);
}

/// Names have no order: however they are listed, the same runs are drawn, and an effect is never larger than the largest difference of two names.
#[test]
fn effects_of_names_do_not_depend_on_their_order() {
    let value = |name: &str| {
        [("a", 2.0), ("b", 7.0), ("c", 2.5), ("d", 3.0)].into_iter().find(|(n, _)| *n == name).map(|(_, v)| v)
    };
    let of = |order: &str| {
        let choices: Vec<String> =
            order.chars().map(|c| format!("{{ name = \"{c}\", set = {{ title = \"{c}\" }} }}")).collect();
        let names = format!("[[vary]]\nname = \"thing\"\nchoices = [{}]\n", choices.join(", "));
        let study = plan("morris", 60, &format!("{names}{BETA}{ASKED}"));
        let found = found(&study, |labels| labels[0].as_str().and_then(value).expect("a name"));
        let Ok(Indices::Morris(effects)) = &found.indices else { panic!("{:?}", found.indices) };
        effects[0]
    };
    let found = of("abcd");
    for order in ["acbd", "dcba", "bdac"] {
        assert_eq!(of(order), found, "{order}");
    }
    // The six pairs differ by 5, 0.5, 1, 4.5, 4 and 0.5.
    assert!((found.absolute.value - 15.5 / 6.0).abs() < 0.5 && found.absolute.interval[1] <= 5.0, "{found:?}");
}

/// Every choice stands a chance of being run, more of them than `levels` too, and what no run has is told.
#[test]
fn every_choice_may_be_run() {
    let choices: Vec<String> = (1..=9).map(|i| format!("{{ name = \"a{i}\", set = {{ title = \"{i}\" }} }}")).collect();
    let values: Vec<String> = (1..=7).map(|i| format!("\"{i} kN/m\"")).collect();
    let vary = format!(
        "[[vary]]\nname = \"thing\"\nchoices = [{}]\n[[vary]]\npath = \"load.top\"\nvalues = [{}]\n",
        choices.join(", "),
        values.join(", ")
    );
    let study = plan("morris", 40, &vary);
    assert_eq!(concio_study::design::unreached(&study.factors, &study.points), [""; 0]);
    let few = plan("morris", 2, &vary);
    let told = concio_study::design::unreached(&few.factors, &few.points);
    assert!(told[0].starts_with("no run has ") && told[0].contains("of the 9 values of `thing`: a"), "{told:?}");
}

/// The rank coefficient of what rises with a listed value is 1, in whatever order the list has its values. Names have none,
/// and the table says why.
#[test]
fn ranks_are_those_of_values_and_names_have_none() {
    let names = "[[vary]]\nname = \"case\"\nchoices = [{ name = \"1\" }, { name = \"2\", set = { title = \"b\" } }, \
                 { name = \"3\", set = { title = \"c\" } }]\n";
    let study = plan("grid", 0, &format!("{UNEVEN}{names}{BETA}{ASKED}"));
    let found = found(&study, |labels| load(labels).powi(3));
    let Ok(Indices::Ranks { coefficients, explained }) = &found.indices else { panic!("{:?}", found.indices) };
    assert!(coefficients[0].is_some_and(|c| (c.value - 1.0).abs() < 1e-9), "{coefficients:?}");
    assert!(coefficients[1].is_none() && (explained - 1.0).abs() < 1e-9, "{coefficients:?} {explained}");
    let table = tables::table(&study, std::slice::from_ref(&found));
    let note = table.columns.iter().find(|c| c.name == "note").map(|c| &c.cells);
    let Some(Cells::Texts(notes)) = note else { panic!("{note:?}") };
    assert!([0, 2].iter().all(|k| notes[*k].as_deref() == Some("of a regression without case")), "{notes:?}");
    let squares = table.column("r_squared").map(<[_]>::to_vec).unwrap_or_default();
    assert!(squares.iter().flatten().filter(|r| (**r - 1.0).abs() < 1e-9).count() == 3, "{squares:?}");
    assert!(notes[1].as_ref().is_some_and(|n| n.contains("names") && n.contains("mean nothing")), "{notes:?}");
}

/// sin x1 + 7 sin² x2 + 0.1 x3⁴ sin x1 over −π … π. V1 = ½ (1 + 0.1 π⁴/5)², V2 = 49/8, V13 = 0.01 π⁸ (1/18 − 1/50)
/// (T. Ishigami, T. Homma, 1990).
fn ishigami(x: &[f64]) -> f64 {
    let x: Vec<f64> = x.iter().map(|s| PI * (2.0 * s - 1.0)).collect();
    x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
}

#[test]
fn shares_of_the_variance_of_ishigami() -> Result<(), String> {
    let (v1, v2) = (0.5 * (1.0 + 0.1 * PI.powi(4) / 5.0).powi(2), 49.0 / 8.0);
    let v13 = 0.01 * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let v = v1 + v2 + v13;
    let first = [v1 / v, v2 / v, 0.0];
    let total = [(v1 + v13) / v, v2 / v, v13 / v];
    let values: Vec<Option<f64>> = points("sobol", 8192, 3).iter().map(|x| Some(ishigami(x))).collect();
    let found = sobol::shares(&values, 3, 0.95)?;
    for (k, s) in found.iter().enumerate() {
        assert!((s.first.value - first[k]).abs() < 0.015, "S{k} {} {}", s.first.value, first[k]);
        assert!((s.total.value - total[k]).abs() < 0.015, "T{k} {} {}", s.total.value, total[k]);
        for (index, exact) in [(s.first, first[k]), (s.total, total[k])] {
            assert!(index.interval[0] <= index.value && index.value <= index.interval[1]);
            // The interval is that of independent draws, wider than the error of the sequence.
            assert!(index.interval[0] - 0.01 < exact && exact < index.interval[1] + 0.01, "{index:?} {exact}");
        }
    }
    Ok(())
}

/// y = Σ a_i x_i: each factor's share is a_i²/Σa², alone and in all; rank coefficients of a linear function are those of
/// the values where all factors are uniform.
#[test]
fn an_additive_function_has_no_interactions() -> Result<(), String> {
    let a = [1.0, 2.0, 4.0];
    let y = |x: &Vec<f64>| x.iter().zip(a).map(|(x, a)| a * x).sum::<f64>() + 100.0;
    let values: Vec<Option<f64>> = points("sobol", 512, 3).iter().map(|x| Some(y(x))).collect();
    for (k, s) in sobol::shares(&values, 3, 0.95)?.iter().enumerate() {
        let exact = a[k] * a[k] / 21.0;
        assert!((s.first.value - exact).abs() < 0.01 && (s.total.value - exact).abs() < 0.01, "{k} {s:?}");
    }
    let x = points("latin-hypercube", 400, 3);
    let values: Vec<Option<f64>> = x.iter().map(|x| Some(y(x))).collect();
    let (found, explained) = ranks::coefficients(&x, &values, &[true; 3], ALONE)?;
    assert!(explained > 0.97, "{explained}");
    for (k, c) in found.iter().enumerate() {
        let (c, exact) = (c.expect("an ordered factor"), a[k] / 21f64.sqrt());
        assert!((c.value - exact).abs() < 0.05, "{k} {c:?} {exact}");
        assert!(c.interval[0] < c.value && c.value < c.interval[1]);
    }
    // Any rising function of the same has the same ranks.
    let cubes: Vec<Option<f64>> = values.iter().map(|v| v.map(|v| v.powi(3).exp())).collect();
    let logs: Vec<Option<f64>> = values.iter().map(|v| v.map(f64::ln)).collect();
    assert_eq!(ranks::coefficients(&x, &logs, &[true; 3], ALONE)?.0, found);
    assert!(ranks::coefficients(&x, &cubes, &[true; 3], ALONE).is_err(), "all infinite: nothing varies");
    Ok(())
}

#[test]
fn elementary_effects_of_a_linear_function_are_its_coefficients() -> Result<(), String> {
    let a = [3.0, -2.0, 0.5, 0.0];
    let x = points("morris", 12, 4);
    let values: Vec<Option<f64>> =
        x.iter().map(|x| Some(x.iter().zip(a).map(|(x, a)| a * x).sum::<f64>() - 7.0)).collect();
    for (k, e) in morris::effects(&x, &values, &[true; 4], 0.95)?.iter().enumerate() {
        assert!((e.absolute.value - a[k].abs()).abs() < 1e-12, "{e:?}");
        assert!((e.mean.value - a[k]).abs() < 1e-12 && e.deviation.value < 1e-12);
        assert!((e.absolute.interval[1] - e.absolute.interval[0]).abs() < 1e-12);
    }
    Ok(())
}

/// x1 x2 over 0 … 1: effects of each are the other's value, which scatters: σ tells the interaction.
#[test]
fn interactions_show_in_sigma_and_lost_runs_are_left_out() -> Result<(), String> {
    let x = points("morris", 40, 3);
    let mut values: Vec<Option<f64>> = x.iter().map(|x| Some(x[0] * x[1])).collect();
    let found = morris::effects(&x, &values, &[true; 3], 0.95)?;
    assert!(found[0].deviation.value > 0.25 && found[2].absolute.value == 0.0);
    assert!((found[0].absolute.value - 0.5).abs() < 0.15, "{:?}", found[0]);
    values[1] = None;
    let fewer = morris::effects(&x, &values, &[true; 3], 0.95)?;
    let rest: Vec<Option<f64>> = values[4..].to_vec();
    assert_eq!(fewer, morris::effects(&x[4..], &rest, &[true; 3], 0.95)?);
    assert!(morris::effects(&x[..4], &values[..4], &[true; 3], 0.95).is_err());
    Ok(())
}

/// 95 % intervals of elementary effects hold what they estimate in 90 to 98 of 100 studies, of the fewest trajectories that there may be on.
#[test]
fn intervals_of_effects_cover() {
    let mut dice = Dice::new(17);
    let trials = 2000;
    for n in [2, 3, 5, 12, 40] {
        let mut held = [0.0; 2];
        for _ in 0..trials {
            let draws: Vec<f64> = (0..n).map(|_| 1.0 + dice.normal()).collect();
            let found = [morris::mean(&draws, 0.95), morris::deviation(&draws, 0.95)];
            for (held, index) in held.iter_mut().zip(found) {
                *held += f64::from(u8::from(index.interval[0] <= 1.0 && 1.0 <= index.interval[1]));
            }
        }
        for (held, of) in held.into_iter().zip(["μ", "σ"]) {
            let subject =
                format!("Statistics: part of 95 % intervals of Morris' {of} that hold it; {n} normal effects");
            agrees!(subject, COVERAGE, "", held / f64::from(trials), 0.94, abs: 0.04);
        }
    }
}

/// Of a mean the jackknife is Student's interval, and groups of many parts have nearly the same.
#[test]
fn the_jackknife_of_a_mean_is_students() {
    let mut dice = Dice::new(11);
    for (n, within) in [(7, 1e-12), (200, 1e-12), (1150, 0.1)] {
        let draws: Vec<f64> = (0..n).map(|_| 1.0 + dice.normal()).collect();
        let mean = |parts: &[usize]| vec![parts.iter().map(|&i| draws[i]).sum::<f64>() / parts.len() as f64];
        let found = jackknife(n, n as f64 - 1.0, 0.95, &mean)[0];
        let expected = morris::mean(&draws, 0.95);
        let half = |interval: [f64; 2]| 0.5 * (interval[1] - interval[0]);
        assert!((found.value - expected.value).abs() < 1e-12);
        assert!((half(found.interval) / half(expected.interval) - 1.0).abs() < within, "{n}: {found:?} {expected:?}");
    }
}

/// Shares of the variance of products and of Ishigami's function, of random base points.
#[test]
fn intervals_of_shares_cover() {
    let product = |x: &[f64]| x.iter().zip([1.5, 1.0, 0.5]).map(|(x, a)| 1.0 + a * (x - 0.5)).product::<f64>();
    let linear = |x: &[f64]| 3.0 * x[0] + 2.0 * x[1] + x[2];
    let mut dice = Dice::new(23);
    for n in [5, 12, 40] {
        for (of, function) in
            [("a sum", &linear as &dyn Fn(&[f64]) -> f64), ("a product", &product), ("Ishigami's function", &ishigami)]
        {
            let mut draw = |n: usize| -> Vec<Option<f64>> {
                let mut base = || -> Vec<[f64; 3]> { (0..n).map(|_| [0; 3].map(|_| dice.unit())).collect() };
                let (a, b) = (base(), base());
                let mixed =
                    |f: usize| a.iter().zip(&b).map(move |(a, b)| [0, 1, 2].map(|k| if k == f { b[k] } else { a[k] }));
                let all = a.iter().copied().chain(b.iter().copied()).chain((0..3).flat_map(mixed));
                all.map(|x| Some(function(&x))).collect()
            };
            let exact = sobol::shares(&draw(50_000), 3, 0.95).expect("shares");
            let trials = 400;
            let mut held = [0.0; 2];
            for _ in 0..trials {
                let found = sobol::shares(&draw(n), 3, 0.95).expect("shares");
                for (found, exact) in found.iter().zip(&exact) {
                    for (held, [index, exact]) in
                        held.iter_mut().zip([[found.first, exact.first], [found.total, exact.total]])
                    {
                        let holds = index.interval[0] <= exact.value && exact.value <= index.interval[1];
                        *held += f64::from(u8::from(holds)) / 3.0;
                    }
                }
            }
            for (held, index) in held.into_iter().zip(["first-order", "total"]) {
                let subject = format!(
                    "Statistics: part of 95 % intervals of {index} shares that hold them; {of}, {n} base points"
                );
                // Of so few a warning is given.
                let (told, middle) = if n < 12 { ("0.86 to 0.98", 0.92) } else { (COVERAGE, 0.94) };
                agrees!(subject, told, "", held / f64::from(trials), middle, abs: 0.98 - middle);
            }
        }
    }
}

/// The same of the sequence that a study takes, whose points are no independent draws: of the factor and function whose intervals hold it least often. Of 16 base points the share of the
/// friction in what a block slides under a rectangle, 0.087, lies in four of five; from 32 on all do as often as they say.
#[test]
fn intervals_of_shares_cover_on_the_sequence() {
    let slip = |x: &[f64]| {
        let (friction, a, t) = (0.2 + 0.1 * x[0], 0.5 + 0.4 * x[1], 0.1 + 0.1 * x[2]);
        t * t * a * (a / friction - 1.0)
    };
    let product = |x: &[f64]| x.iter().zip([1.5, 1.0, 0.5]).map(|(x, a)| 1.0 + a * (x - 0.5)).product::<f64>();
    let linear = |x: &[f64]| 3.0 * x[0] + 2.0 * x[1] + x[2];
    let functions = [&slip as &dyn Fn(&[f64]) -> f64, &product, &linear, &ishigami];
    let of = |x: &[Vec<f64>], function: &dyn Fn(&[f64]) -> f64| {
        let values: Vec<Option<f64>> = x.iter().map(|x| Some(function(x))).collect();
        sobol::shares(&values, 3, 0.95).expect("shares")
    };
    let many = points("sobol", 16_384, 3);
    let exact = functions.map(|function| of(&many, function));
    let trials = 400;
    for (n, told, middle) in [(16, "0.75 to 1.00", 0.875), (32, "0.90 to 1.00", 0.95), (64, "0.90 to 1.00", 0.95)] {
        // Per function and factor, first-order and total.
        let mut held = [[[0u32; 2]; 3]; 4];
        for seed in 0..trials {
            let x = seeded("sobol", [n, seed], 3);
            for ((held, function), exact) in held.iter_mut().zip(functions).zip(&exact) {
                for ((held, found), exact) in held.iter_mut().zip(of(&x, function)).zip(exact) {
                    for (held, [index, exact]) in
                        held.iter_mut().zip([[found.first, exact.first], [found.total, exact.total]])
                    {
                        *held += u32::from(index.interval[0] <= exact.value && exact.value <= index.interval[1]);
                    }
                }
            }
        }
        for (index, name) in ["first-order", "total"].into_iter().enumerate() {
            let least = held.iter().flatten().map(|held| held[index]).min().unwrap_or(0);
            let subject = format!(
                "Statistics: part of 95 % intervals of {name} shares that hold them, the least of four functions on Sobol's sequence; {n} base points"
            );
            agrees!(subject, told, "", f64::from(least) / trials as f64, middle, abs: 1.0 - middle);
        }
    }
}

/// Rank coefficients of runs with scatter, weak and strong, alone and five to a motion that has its own.
#[test]
fn intervals_of_rank_coefficients_cover() {
    let mut dice = Dice::new(29);
    for (n, each) in [(7, 1), (12, 1), (40, 1), (25, 5), (60, 5)] {
        for noise in [0.3, 3.0] {
            let mut draw = |n: usize| {
                let x: Vec<Vec<f64>> = (0..n).map(|_| (0..3).map(|_| dice.unit()).collect()).collect();
                let motions: Vec<usize> = (0..n).map(|run| run / each).collect();
                let own: Vec<f64> = (0..=n / each).map(|_| dice.normal()).collect();
                let y = |(x, m): (&Vec<f64>, &usize)| {
                    let scatter = if each > 1 { own[*m] * (0.5 + x[0]) } else { dice.normal() };
                    Some((3.0 * x[0] + 2.0 * x[1] + x[2] + noise * scatter).exp())
                };
                let values: Vec<Option<f64>> = x.iter().zip(&motions).map(y).collect();
                (x, motions, values)
            };
            // Of a few runs two factors may have the same ranks.
            let mut of = |n: usize| loop {
                let (x, motions, values) = draw(n);
                if let Ok((found, _)) = ranks::coefficients(&x, &values, &[true; 3], (&motions, 0.95)) {
                    break found;
                }
            };
            let exact = of(8_000);
            let trials = 200;
            let mut held = 0.0;
            for _ in 0..trials {
                for (found, exact) in of(n).iter().zip(&exact).filter_map(|(a, b)| Some((a.as_ref()?, b.as_ref()?))) {
                    let holds = found.interval[0] <= exact.value && exact.value <= found.interval[1];
                    held += f64::from(u8::from(holds)) / 3.0;
                }
            }
            let shared = if each > 1 { format!(", {each} of each motion") } else { String::new() };
            let subject = format!(
                "Statistics: part of 95 % intervals of rank coefficients that hold them; {n} runs{shared}, scatter {noise}"
            );
            agrees!(subject, "0.90 to 0.99", "", held / f64::from(trials), 0.945, abs: 0.045);
        }
    }
}

#[test]
fn the_kind_of_index_follows_the_design() {
    for (design, runs, index) in [
        ("morris", 8, "mu_star"),
        ("sobol", 16, "total"),
        ("latin-hypercube", 30, "rank_coefficient"),
        ("random", 30, "rank_coefficient"),
        ("grid", 0, "rank_coefficient"),
    ] {
        let study = plan(design, runs, &format!("{UNEVEN}{BETA}{ASKED}"));
        let found = found(&study, load);
        assert_eq!(found.indices.as_ref().map(|i| tables::names(i)[0]), Ok(index), "{design}");
        let table = tables::table(&study, &[found]);
        // Only the first factor does anything.
        let values = table.column(index).map(<[_]>::to_vec).unwrap_or_default();
        assert_eq!(values.len(), 2, "{design}");
        let [load, beta] = [values[0], values[1]].map(|v| v.expect("an index").abs());
        assert!(load > 0.5 && beta < 0.25, "{design}: {load} {beta}");
    }
}

/// No trajectory is run twice, forwards or backwards, as long as there are others; few of them, and few base points, are warned of.
#[test]
fn trajectories_differ() {
    use concio_study::design::scarce;
    use concio_study::file::DesignKind;
    for runs in [2, 6, 12] {
        let points = points("morris", runs, 2);
        let mut seen: Vec<Vec<String>> = Vec::new();
        for trajectory in points.chunks(3) {
            let mut own: Vec<String> = trajectory.iter().map(|row| format!("{row:?}")).collect();
            own.sort();
            assert!(!seen.contains(&own), "{own:?}");
            seen.push(own);
        }
    }
    assert!(scarce(DesignKind::Morris, 4, 3).is_some_and(|told| told.contains("design.runs = 4")));
    assert!(scarce(DesignKind::Sobol, 31, 3).is_some_and(|told| told.contains("fewer than 32 up to one in five miss")));
    assert!(scarce(DesignKind::LatinHypercube, 6, 3).is_some_and(|told| told.contains("it takes 7")));
    assert_eq!(
        [scarce(DesignKind::Morris, 5, 3), scarce(DesignKind::Sobol, 32, 3), scarce(DesignKind::Random, 7, 3)],
        [None, None, None]
    );
}
