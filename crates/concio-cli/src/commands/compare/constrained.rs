//! `concio compare constrained`.

use std::fs;
use std::path::{Path, PathBuf};

use concio::constrained::{self, Heads, Variant};
use concio::record::StopReason;
use concio::run::{Prepared, joint_rows, warnings_of};
use concio::store::residual_relative;
use concio::{Error, InputError};
use concio_study::warned::Warned;
use serde_json::{Value, json};

use super::super::{run::refuse_a_file, wall_file};
use crate::args::{Constrained, Format};
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;
use crate::failure::Failure;
use crate::files;
use crate::format::{columns, plain, si, significant};

/// Pairs that are drawn when none are named.
const PAIRS: usize = 2;
/// Most pairs that can be named.
const MOST: usize = 20;
/// Width of the figures [pt], and height of a plot.
const SIZE: [f64; 2] = [510.0, 90.0];
/// Resolution of PNG [pixels per inch].
const DPI: f64 = 300.0;
/// Names of the three runs.
const NAMES: [&str; 3] = ["free", "no-tension", "rigid"];

/// A head joint or connection and the names of its blocks.
struct Pair {
    joint: String,
    index: usize,
    blocks: [String; 2],
}

/// Runs the wall of a file with free, no-tension and rigid head joints.
pub fn constrained(args: &Constrained) -> Result<(), Failure> {
    let file = wall_file::read(&args.file)?;
    let prepared = wall_file::prepare(&file)?;
    let stem = args.file.file_stem().unwrap_or(args.file.as_os_str()).to_string_lossy();
    let out = args.out.clone().unwrap_or_else(|| Path::new("concio-run").join(format!("{stem}-constrained")));
    refuse_a_file(&out)?;
    crate::warned::warn(&file, &prepared.model.warnings);
    // Wrong names are told before anything is run.
    let named = (!args.pairs.is_empty()).then(|| chosen(&prepared, &args.pairs)).transpose()?;
    let rigid = Heads::Rigid(args.restitution);
    constrained::with_heads(&prepared, rigid).map_err(|e| file.locate(e))?;
    let pairs = match named {
        Some(pairs) => pairs,
        None => deepest(&respond(&prepared, Heads::Free, &[])?),
    };
    let runs = [Heads::Free, Heads::NoTension(None), rigid]
        .into_iter()
        .map(|heads| respond(&prepared, heads, &pairs))
        .collect::<Result<Vec<_>, _>>()?;
    let convergence = args
        .rigidity
        .iter()
        .map(|&kappa| Ok((kappa, apart(&respond(&prepared, Heads::NoTension(Some(kappa)), &pairs)?, &runs[2], &pairs))))
        .collect::<Result<Vec<(f64, f64)>, Failure>>()?;
    let mut drawings: Vec<(String, Drawing)> =
        pairs.iter().enumerate().map(|(k, pair)| (format!("pair-{}", k + 1), drawn(pair, &runs))).collect();
    let rate = rate(&convergence);
    if convergence.iter().filter(|(_, d)| *d > 0.0).count() >= 2 {
        drawings.push(("convergence".into(), converging(&convergence)));
    }
    let mut known = Warned::default();
    known.add(String::new, &prepared.model.warnings);
    crate::warned::warn_of_runs(&file, &warned(&runs).sentences(&known));
    write(args, &out, &drawings, &summary(&runs, &pairs, &convergence, rate))?;
    files::print(&told(&runs, &pairs, &convergence, rate))
}

fn respond(prepared: &Prepared, heads: Heads, pairs: &[Pair]) -> Result<Variant, Failure> {
    let joints: Vec<String> = pairs.iter().map(|p| p.joint.clone()).collect();
    let mut blocks: Vec<String> = pairs.iter().flat_map(|p| p.blocks.clone()).collect();
    blocks.sort();
    blocks.dedup();
    let run = constrained::respond(prepared, heads, &blocks, &joints)?;
    match run.outcome.stop_reason {
        StopReason::Completed => Ok(run),
        reason => {
            let why = crate::digest::why(reason, false);
            Err(Failure::Other(format!("a run stopped at t = {} s: {why}", run.outcome.time_reached), None))
        }
    }
}

/// The pairs named.
fn chosen(prepared: &Prepared, names: &[String]) -> Result<Vec<Pair>, Failure> {
    if names.len() > MOST {
        let error = InputError::new(format!("{} names are given", names.len())).key("--pairs");
        return Err(error.allowed(format!("up to {MOST}")).into());
    }
    let all = pairs_of(prepared);
    let find = |name: &String| {
        let place = all.iter().position(|p| p.joint == *name).ok_or_else(|| {
            let example = all.first().map_or(String::new(), |p| format!(", for example {}", p.joint));
            InputError::new(format!("no head joint or connection is named `{name}`"))
                .key("--pairs")
                .allowed(format!("names as `concio check --joints` lists them{example}"))
        })?;
        Ok(Pair { joint: all[place].joint.clone(), index: all[place].index, blocks: all[place].blocks.clone() })
    };
    names.iter().map(find).collect()
}

/// All joints that open and close.
fn pairs_of(prepared: &Prepared) -> Vec<Pair> {
    let model = &prepared.model;
    let upright = |e: &usize| model.joints[*e].kind.is_upright();
    let names = model.joint_names();
    let pair = |e: usize| {
        let blocks = model.shear.sides[e].map(|b| model.wall.blocks[b as usize].name.clone());
        Pair { joint: names[e].clone(), index: e, blocks }
    };
    (0..model.joints.len()).filter(upright).map(pair).collect()
}

/// The pairs that overlap most, deepest first.
fn deepest(free: &Variant) -> Vec<Pair> {
    let closing = &free.outcome.envelopes.joint_closing;
    let mut pairs = pairs_of(&free.prepared);
    pairs.sort_by(|a, b| closing[b.index].total_cmp(&closing[a.index]).then(a.index.cmp(&b.index)));
    pairs.truncate(PAIRS);
    pairs
}

/// What the three runs warn of.
fn warned(runs: &[Variant]) -> Warned {
    let mut warned = Warned::default();
    for (name, run) in NAMES.iter().zip(runs) {
        let model = &run.prepared.model;
        warned.add(|| (*name).into(), &warnings_of(model, &joint_rows(model), &run.outcome));
    }
    warned
}

fn history(run: &Variant, name: &str) -> Vec<f64> {
    run.history(name).unwrap_or_default()
}

/// Largest difference of the displacements of the pairs from those of `from`, over their peak.
fn apart(run: &Variant, from: &Variant, pairs: &[Pair]) -> f64 {
    let of = |block: &String| {
        let name = format!("block/{block}/displacement");
        constrained::difference(&history(run, &name), &history(from, &name))
    };
    pairs.iter().flat_map(|p| &p.blocks).map(of).fold(0.0, f64::max)
}

fn rate(convergence: &[(f64, f64)]) -> Option<f64> {
    let (x, y): (Vec<f64>, Vec<f64>) = convergence.iter().copied().unzip();
    constrained::rate(&x, &y)
}

/// Displacements and velocities of both blocks and the gap between them, in the three runs.
fn drawn(pair: &Pair, runs: &[Variant]) -> Drawing {
    let [left, right] = &pair.blocks;
    let rows = [
        (format!("block/{left}/displacement"), format!("displacement of {left}"), "m"),
        (format!("block/{right}/displacement"), format!("displacement of {right}"), "m"),
        (format!("block/{left}/velocity"), format!("velocity of {left}"), "m/s"),
        (format!("block/{right}/velocity"), format!("velocity of {right}"), "m/s"),
        (format!("joint/{}/slip", pair.joint), "gap: below 0 the blocks overlap".into(), "m"),
    ];
    let last = rows.len() - 1;
    let panels = rows.into_iter().enumerate().map(|(k, (channel, heading, unit))| {
        let quantity = heading.split([' ', ':']).next().unwrap_or_default().to_string();
        let line = |(style, run): (usize, &Variant)| Line {
            x: run.outcome.recording.time.clone().into(),
            y: history(run, &channel).into(),
            style,
        };
        Panel {
            lines: runs.iter().enumerate().map(line).collect(),
            heading,
            x: Axis { quantity: "time".into(), unit: "s", ..Axis::default() },
            y: Axis { quantity, unit, ..Axis::default() },
            rising: true,
            bare: k < last,
            marked: false,
        }
    });
    chart::draw(&Sheet {
        title: format!("Motion of {left} and {right} with free, no-tension and rigid head joints"),
        legend: NAMES.map(String::from).to_vec(),
        panels: panels.collect(),
        columns: 1,
        width: SIZE[0],
        height: Some(SIZE[1]),
    })
}

fn converging(convergence: &[(f64, f64)]) -> Drawing {
    let (x, y): (Vec<f64>, Vec<f64>) = convergence.iter().copied().filter(|(_, d)| *d > 0.0).unzip();
    let axis = |quantity: &str, values: &[f64]| Axis {
        quantity: quantity.into(),
        logarithmic: true,
        range: Some(decades(values)),
        ..Axis::default()
    };
    let (across, up) = (axis("rigidity κ", &x), axis("difference", &y));
    chart::draw(&Sheet {
        title: "Difference of no-tension from rigid head joints over the rigidity".into(),
        legend: Vec::new(),
        panels: vec![Panel {
            heading: String::new(),
            x: across,
            y: up,
            lines: vec![Line { x: x.into(), y: y.into(), style: 0 }],
            rising: false,
            bare: false,
            marked: true,
        }],
        columns: 1,
        width: 0.7 * SIZE[0],
        height: Some(2.0 * SIZE[1]),
    })
}

/// Powers of ten around values above 0.
fn decades(values: &[f64]) -> [f64; 2] {
    let (low, high) = values.iter().fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(*v), h.max(*v)));
    let (low, high) = ((low.log10() + 1e-9).floor(), (high.log10() - 1e-9).ceil());
    [10f64.powf(low), 10f64.powf(high.max(low + 1.0))]
}

fn summary(runs: &[Variant], pairs: &[Pair], convergence: &[(f64, f64)], rate: Option<f64>) -> Value {
    let run = |(name, run): (&str, &Variant)| {
        let (outcome, envelopes) = (&run.outcome, &run.outcome.envelopes);
        let of_pair = |p: &Pair| {
            json!({
                "joint": p.joint,
                "deepest_interpenetration": envelopes.joint_closing[p.index],
                "widest_gap": envelopes.joint_opening[p.index],
            })
        };
        json!({
            "heads": name,
            "deepest_interpenetration": run.deepest(),
            "widest_gap": widest(run),
            "peak_relative_displacement": outcome.totals.peak_relative_displacement,
            "top_work": outcome.energies.input_top,
            "impacts": outcome.counters.impacts,
            "impact_energy": outcome.energies.impact,
            "contact_residual": outcome.totals.contact_residual,
            "steps": outcome.counters.steps,
            "energy_residual_relative": residual_relative(outcome),
            "pairs": pairs.iter().map(of_pair).collect::<Vec<_>>(),
        })
    };
    let point = |(kappa, difference): &(f64, f64)| json!({ "rigidity": kappa, "difference": difference });
    json!({
        "runs": NAMES.into_iter().zip(runs).map(run).collect::<Vec<_>>(),
        "convergence": convergence.iter().map(point).collect::<Vec<_>>(),
        "rate": rate,
        "version": env!("CARGO_PKG_VERSION"),
    })
}

fn widest(run: &Variant) -> f64 {
    run.upright().map(|e| run.outcome.envelopes.joint_opening[e]).fold(0.0, f64::max)
}

fn told(runs: &[Variant], pairs: &[Pair], convergence: &[(f64, f64)], rate: Option<f64>) -> String {
    let row = |cells: &[&str]| cells.iter().map(|c| (*c).to_string()).collect::<Vec<_>>();
    let mut rows = vec![row(&["head joints", "deepest overlap", "widest gap", "peak displacement", "impacts"])];
    for (name, run) in NAMES.iter().zip(runs) {
        let totals = &run.outcome.totals;
        rows.push(vec![
            (*name).into(),
            si(run.deepest(), "m"),
            si(widest(run), "m"),
            si(totals.peak_relative_displacement, "m"),
            run.outcome.counters.impacts.to_string(),
        ]);
    }
    let mut text = columns(&rows);
    for pair in pairs {
        let mut rows = vec![row(&[&pair.joint, "deepest overlap", "widest gap"])];
        for (name, run) in NAMES.iter().zip(runs) {
            let envelopes = &run.outcome.envelopes;
            let [deep, wide] = [&envelopes.joint_closing, &envelopes.joint_opening].map(|e| si(e[pair.index], "m"));
            rows.push(vec![(*name).into(), deep, wide]);
        }
        text += &columns(&rows);
    }
    if !convergence.is_empty() {
        let mut rows = vec![row(&["rigidity of no-tension", "difference from rigid"])];
        rows.extend(
            convergence.iter().map(|(kappa, d)| vec![plain(*kappa), format!("{} %", significant(100.0 * d, 3))]),
        );
        text += &columns(&rows);
        if let Some(rate) = rate {
            text += &format!("  the difference goes with rigidity^{}\n", significant(rate, 2));
        }
    }
    text
}

fn write(args: &Constrained, out: &Path, drawings: &[(String, Drawing)], summary: &Value) -> Result<(), Failure> {
    let content = |name: &str, drawing: &Drawing| {
        let made = match args.format {
            Format::Svg => drawing.outlined().map(String::into_bytes),
            Format::Png => drawing.png(DPI),
            Format::Pdf => drawing.pdf(),
        };
        made.map_err(|why| Failure::Other(format!("figure {name}: {why}"), None))
    };
    let contents = drawings.iter().map(|(name, d)| content(name, d)).collect::<Result<Vec<_>, _>>()?;
    let json = serde_json::to_string_pretty(summary).map_err(|e| Failure::Other(e.to_string(), None))?;
    fs::create_dir_all(out).map_err(|e| Error::io(out, e))?;
    let ending = match args.format {
        Format::Svg => "svg",
        Format::Png => "png",
        Format::Pdf => "pdf",
    };
    for ((name, _), content) in drawings.iter().zip(contents) {
        let path: PathBuf = out.join(format!("{name}.{ending}"));
        files::write(&path, &content)?;
    }
    files::write(&out.join("compare.json"), &(json + "\n"))
}
