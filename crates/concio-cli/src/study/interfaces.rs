//! The section about smart interfaces: what the search found beside its baselines.

use std::path::Path;

use concio_study::answer::{Answer, Draws, Line, Spread, Verdict, quantile};
use concio_study::interfaces::Question;
use concio_study::search::Design;
use concio_study::table::{self, Table};

use super::page::{Figure, Section, shown};
use super::wall_map::{self, Map};
use crate::draw::chart::{self, Axis, Panel, Sheet};
use crate::failure::Failure;
use crate::format::{columns, counted, percent, plain, short, significant};

/// Width of the figures [pt], and height of a plot.
const SIZE: [f64; 2] = [510.0, 170.0];
/// Shares of the random draws that the tables show.
const QUANTILES: [(f64, &str); 3] = [(0.0, "best"), (0.5, "median"), (1.0, "worst")];

/// The answer; its tables go into the folder as well.
///
/// # Errors
/// A table that cannot be written.
pub fn section(question: &Question, answer: &Answer, out: &Path) -> Result<Section, Failure> {
    let compared = comparison(question, answer);
    let motions = by_motion(question, answer);
    let draws = all_draws(question, answer);
    for (name, lines) in [("interfaces", &compared), ("interfaces-by-motion", &motions), ("interfaces-draws", &draws)] {
        table::write_csv(lines, &out.join(format!("{name}.csv")))?;
    }
    let mut text = vec![asked(question, answer)];
    text.push(found(question, answer));
    for k in 0..question.objectives.len() {
        let kinds = [(false, "the motions of the search"), (true, "motions held out")];
        let verdicts = kinds.into_iter().filter_map(|(held, name)| Some((name, answer.verdict(question, k, held)?)));
        text.extend(verdicts.map(|(name, v)| judged(question, answer, k, name, &v)));
    }
    let mut figures = vec![convergence(question, answer), placement(question, answer)];
    if question.objectives.len() == 2 {
        figures.push(front(question, answer));
    }
    let caption =
        |what: &str| format!("{what}; means over {} copies of the motions and their scatter", question.input.copies);
    let tables = vec![
        (caption("The search beside its baselines (random draws: one copy)"), compared),
        (caption("Motion by motion"), motions),
        ("All random draws".into(), draws),
    ];
    let brief = brief(question, answer);
    Ok(Section { title: "Smart interfaces".into(), text, figures, tables, brief })
}

/// The search beside its baselines, each objective under the motions of the search and the held-out ones.
fn brief(question: &Question, answer: &Answer) -> String {
    let mut lines = vec![vec!["placement".to_string(), "joints".into()]];
    for objective in &question.objectives {
        lines[0].push(objective.title());
        if !question.of(true).is_empty() {
            lines[0].push("held out".into());
        }
    }
    for entry in entries(question, answer) {
        let words = [&entry.words[0], &entry.words[1]].map(String::as_str).join(" ");
        let mut line = vec![words.trim().to_string(), entry.joints.map_or("–".into(), plain)];
        for (k, objective) in question.objectives.iter().enumerate() {
            let unit = objective.target.unit();
            for spreads in [&entry.training, &entry.held_out] {
                let cell = |s: &Spread| match s.deviation {
                    0.0 => said(s.mean, unit),
                    deviation => format!("{} ± {}", said(s.mean, unit), said(deviation, unit)),
                };
                line.extend(spreads.get(k).map(cell));
            }
        }
        lines.push(line);
    }
    columns(&lines) + &format!("  {}\n", found(question, answer))
}

fn asked(question: &Question, answer: &Answer) -> String {
    let objectives: Vec<String> = question
        .objectives
        .iter()
        .map(|o| format!("{} as {} as can be", o.title(), if o.large { "large" } else { "small" }))
        .collect();
    let devices: Vec<&str> = question.devices.iter().map(|d| d.name.as_str()).collect();
    let [greedy, search, all] = answer.runs;
    format!(
        "Asked: {}; devices ({}) in at most {} of {}, chosen among {}. The search asked for {} under {}, the greedy \
         placements for {greedy} to tune their parameters, everything together for {all}. Scatter is the standard \
         deviation over {} copies of the motions that differ by {:e} of their strength.",
        objectives.join("; "),
        devices.join(", "),
        question.places.most,
        counted(question.joints.len(), "joint"),
        question.eligible.len(),
        counted(search, "run"),
        counted(question.of(false).len(), "motion"),
        question.input.copies,
        question.input.perturbation,
    )
}

/// What was found, of a front its knee; parameters at their bounds.
fn found(question: &Question, answer: &Answer) -> String {
    let designs: Vec<&Design> = answer.search.iter().filter_map(|line| line.design.as_ref()).collect();
    let Some(design) = designs.get(answer.chosen) else { return String::new() };
    let device = &question.devices[design.device];
    let label = device.label(&design.shares);
    let label = if label.is_empty() { label } else { format!(" ({label})") };
    let joints = counted(design.joints.len(), "joint");
    let of = match designs.len() {
        1 => String::new(),
        n => format!(
            "{n} designs, none of which another beats in both objectives. Design {}, nearest to the best of both (the knee): ",
            answer.chosen + 1
        ),
    };
    let bounds = designs.iter().enumerate().flat_map(|(number, design)| {
        let name = if designs.len() > 1 { format!("design {}, ", number + 1) } else { String::new() };
        let device = &question.devices[design.device];
        device.at_bounds(&design.shares).into_iter().map(move |told| format!(" {}.", capital(&format!("{name}{told}"))))
    });
    let names = question.names(design).join(", ");
    format!("Found: {of}{}{label} in {joints}: {names}.{}", device.name, bounds.collect::<String>())
}

fn judged(question: &Question, answer: &Answer, k: usize, motions: &str, v: &Verdict) -> String {
    let objective = &question.objectives[k];
    let unit = objective.target.unit();
    let of = |value: f64| {
        let share = format!("{} of it", significant(value / v.unreinforced.mean, 3));
        format!("{} ({share})", said(value, unit))
    };
    let scatter = |s: &Spread| format!("{} ± {}", of(s.mean), said(s.deviation, unit));
    let (place, search) = &v.search;
    let number = if answer.search.len() > 1 { format!(", design {},", place + 1) } else { String::new() };
    let greedy = |found: &Option<(&Line, Spread)>, what: &str| {
        let told = |(line, spread): &(&Line, Spread)| format!("; {what} ({}) {}", line.name, scatter(spread));
        found.as_ref().map_or(String::new(), told)
    };
    let [tuned, as_found] = &v.greedy;
    let drawn = |draws: &Option<Draws>, lines: &[Line], what: &str| {
        let told =
            |d: &Draws| format!("; of {} {what} the best {}, the median {}", lines.len(), of(d.best), of(d.median));
        draws.as_ref().map_or(String::new(), told)
    };
    let [random, placed] = &v.random;
    let cost = |value: f64| objective.cost(value);
    let others = [tuned, as_found].into_iter().flatten().map(|(_, s)| s.mean);
    let others = others.chain([random, placed].into_iter().flatten().map(|d| d.best)).chain([search.mean]);
    let nothing = match others.map(cost).all(|other| cost(v.unreinforced.mean) <= other) {
        true => " The wall does best without any device.",
        false => "",
    };
    format!(
        "{}, {motions}: the wall as it is {} ± {}; the search{number} {}{}{}{}{}. {}{}{nothing}",
        capital(&objective.title()),
        said(v.unreinforced.mean, unit),
        said(v.unreinforced.deviation, unit),
        scatter(search),
        greedy(tuned, "the best tuned greedy placement"),
        greedy(as_found, "the best with the device found"),
        drawn(random, &answer.random, "random placements"),
        drawn(placed, &answer.placed, "random places of the device found"),
        against(answer, v),
        again(answer, v),
    )
}

/// The search beside its best rival.
fn against(answer: &Answer, v: &Verdict) -> String {
    let rival = match (&answer.random, &answer.placed) {
        _ if std::ptr::eq(v.rival, &answer.unreinforced) => "the wall as it is".to_string(),
        (lines, _) if lines.iter().any(|line| std::ptr::eq(line, v.rival)) => "a random placement".into(),
        (_, lines) if lines.iter().any(|line| std::ptr::eq(line, v.rival)) => {
            "a random placement of the device found".into()
        }
        _ => v.rival.name.clone(),
    };
    let part = if v.gain.is_finite() { format!(", by {}", percent(v.gain.abs())) } else { String::new() };
    let scatters = v.scatters.map_or(String::new(), |n| format!(", {} scatters", significant(n.abs(), 2)));
    let [better, all] = v.motions;
    let what = match v.gain {
        gain if gain > 0.0 => format!("better than the best other design, {rival}{part}{scatters}"),
        gain if gain < 0.0 => format!("worse than the best other design, {rival}{part}{scatters}"),
        _ => format!("as good as the best other design, {rival}"),
    };
    let silent = match (v.scatters, v.gain == 0.0) {
        (None, false) => " Copies hardly differ, so their scatter says nothing of it.",
        _ => "",
    };
    format!("The search is {what}; it is the better one under {better} of {}.{silent}", counted(all, "motion"))
}

/// Where else the design of the search was found.
fn again(answer: &Answer, v: &Verdict) -> String {
    let is_drawn = |line: &Line| answer.random.iter().chain(&answer.placed).any(|drawn| std::ptr::eq(drawn, line));
    let (drawn, ranked): (Vec<&Line>, Vec<&Line>) = v.same.iter().partition(|line| is_drawn(line));
    let mut told: Vec<&str> = ranked.iter().map(|line| line.name.as_str()).collect();
    told.extend((!drawn.is_empty()).then_some("found at random too"));
    if told.is_empty() { String::new() } else { format!(" The same design, and no rival: {}.", told.join("; ")) }
}

/// A value with its unit; a pure number with four digits.
fn said(value: f64, unit: &str) -> String {
    match unit {
        "" => shown(value),
        "m/s²" => format!("{} m/s²", significant(value, 4)),
        _ => short(value, unit),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |c| c.to_uppercase().chain(letters).collect())
}

/// A line of the comparison: name, device, parameters, number of joints, and per objective training and held-out values.
struct Entry {
    words: [String; 3],
    joints: Option<f64>,
    /// Which they are.
    names: Option<String>,
    training: Vec<Spread>,
    held_out: Vec<Spread>,
}

fn entry(question: &Question, line: &Line) -> Entry {
    let words = match &line.design {
        Some(d) => {
            [line.name.clone(), question.devices[d.device].name.clone(), question.devices[d.device].label(&d.shares)]
        }
        None => [line.name.clone(), String::new(), String::new()],
    };
    let joints = line.design.as_ref().map(|d| d.joints.len() as f64);
    let names = line.design.as_ref().map(|d| question.names(d).join(", "));
    Entry { words, joints, names, training: line.training.clone(), held_out: line.held_out.clone() }
}

/// The quantiles of some random draws, each objective for itself. The best is that under the motions of the search, under the others too.
fn quantiles(question: &Question, name: &str, lines: &[Line]) -> Vec<Entry> {
    let of = |share: f64, held: bool| -> Vec<Spread> {
        let one = |(k, objective): (usize, &concio_study::interfaces::Objective)| {
            let costs = |held: bool| -> Vec<f64> {
                let spreads = lines.iter().filter_map(|l| if held { l.held_out.get(k) } else { l.training.get(k) });
                spreads.map(|s| objective.cost(s.mean)).collect()
            };
            let known = costs(false);
            let best = (0..known.len()).min_by(|a, b| known[*a].total_cmp(&known[*b]))?;
            let cost = if share == 0.0 { *costs(held).get(best)? } else { quantile(&costs(held), share)? };
            Some(Spread { mean: objective.cost(cost), deviation: 0.0 })
        };
        question.objectives.iter().enumerate().filter_map(one).collect()
    };
    let entry = |(share, what): (f64, &str)| Entry {
        words: [format!("{name}, {what} of {}", lines.len()), String::new(), String::new()],
        joints: None,
        names: None,
        training: of(share, false),
        held_out: of(share, true),
    };
    QUANTILES.into_iter().map(entry).collect()
}

/// The wall as it is, the random placements, the greedy ones and those of the search.
fn entries(question: &Question, answer: &Answer) -> Vec<Entry> {
    let mut entries = vec![entry(question, &answer.unreinforced)];
    entries.extend(quantiles(question, "random", &answer.random));
    entries.extend(quantiles(question, "random places of the found device", &answer.placed));
    let lines = answer.greedy.iter().chain(&answer.greedy_as_found).chain(&answer.search);
    entries.extend(lines.map(|l| entry(question, l)));
    entries
}

fn comparison(question: &Question, answer: &Answer) -> Table {
    let entries = entries(question, answer);
    let mut table = Table::default();
    for (k, heading) in ["placement", "device", "parameters"].into_iter().enumerate() {
        table.texts(heading, entries.iter().map(|e| Some(e.words[k].clone())).collect());
    }
    table.numbers("joints", "", entries.iter().map(|e| e.joints).collect());
    for (k, objective) in question.objectives.iter().enumerate() {
        for (held, kind) in [(false, "search"), (true, "held out")] {
            let of = |e: &Entry| if held { e.held_out.get(k).copied() } else { e.training.get(k).copied() };
            let Some(without) = of(&entries[0]) else { continue };
            let (name, unit) = (objective.title(), objective.target.unit());
            table.numbers(format!("{name}, {kind}"), unit, entries.iter().map(|e| of(e).map(|s| s.mean)).collect());
            let ratio = entries.iter().map(|e| of(e).map(|s| s.mean / without.mean)).collect();
            table.numbers(format!("over unreinforced, {name}, {kind}"), "", ratio);
            let copied = |e: &Entry| of(e).filter(|_| e.joints.is_some() || e.words[0] == "unreinforced");
            let scatter = entries.iter().map(|e| copied(e).map(|s| s.deviation)).collect();
            table.numbers(format!("scatter, {name}, {kind}"), unit, scatter);
        }
    }
    table.texts("which joints", entries.iter().map(|e| e.names.clone()).collect());
    table
}

fn by_motion(question: &Question, answer: &Answer) -> Table {
    let mut lines = vec![&answer.unreinforced];
    lines.extend(answer.greedy.iter().chain(&answer.greedy_as_found));
    lines.extend(answer.search.get(answer.chosen));
    let mut table = Table::default();
    table.texts("motion", question.scenes.iter().map(|s| Some(s.name.clone())).collect());
    let kind = |held: bool| if held { "held out" } else { "search" };
    table.texts("kind", question.scenes.iter().map(|s| Some(kind(s.held_out).into())).collect());
    for (k, objective) in question.objectives.iter().enumerate() {
        for (number, line) in lines.iter().enumerate() {
            // Names of two designs of one greedy front are alike.
            let again = lines[..number].iter().filter(|l| l.name == line.name).count();
            let again = if again > 0 { format!(" ({})", again + 1) } else { String::new() };
            let name = format!("{}, {}{again}", objective.target.title(), line.name);
            table.numbers(name, objective.target.unit(), line.scenes.iter().map(|v| v.get(k).copied()).collect());
        }
    }
    table
}

fn all_draws(question: &Question, answer: &Answer) -> Table {
    let lines: Vec<&Line> = answer.random.iter().chain(&answer.placed).collect();
    let designs = || lines.iter().map(|l| l.design.as_ref());
    let mut table = Table::default();
    table.texts("draw", lines.iter().map(|l| Some(l.name.clone())).collect());
    table.texts("device", designs().map(|d| d.map(|d| question.devices[d.device].name.clone())).collect());
    table.texts("parameters", designs().map(|d| d.map(|d| question.devices[d.device].label(&d.shares))).collect());
    table.texts("joints", designs().map(|d| d.map(|d| question.names(d).join(", "))).collect());
    for (k, objective) in question.objectives.iter().enumerate() {
        let (name, unit) = (objective.title(), objective.target.unit());
        let of = |s: &[Spread]| s.get(k).map(|s| s.mean);
        table.numbers(format!("{name}, search"), unit, lines.iter().map(|l| of(&l.training)).collect());
        table.numbers(format!("{name}, held out"), unit, lines.iter().map(|l| of(&l.held_out)).collect());
    }
    table
}

/// Best value so far over the runs of the search, between the wall as it is and the median of the random draws.
fn convergence(question: &Question, answer: &Answer) -> Figure {
    let panel = |(k, objective): (usize, &concio_study::interfaces::Objective)| {
        let steps = |trace: &[(usize, Vec<f64>)]| -> (Vec<f64>, Vec<f64>) {
            let finite = trace.iter().filter(|(_, v)| v[k].is_finite());
            finite.map(|(n, v)| (*n as f64, v[k])).unzip()
        };
        let (x, y) = steps(&answer.trace);
        let (first, last) = (x.first().copied().unwrap_or(0.0), x.last().copied().unwrap_or(1.0));
        let level =
            |value: f64, style: usize| chart::Line { x: vec![first, last].into(), y: vec![value, value].into(), style };
        let mut lines = vec![chart::Line { x: x.into(), y: y.into(), style: 0 }];
        let costs: Vec<f64> = answer.random.iter().map(|l| objective.cost(l.training[k].mean)).collect();
        let greedy = answer.greedy.iter().map(|l| objective.cost(l.training[k].mean)).fold(f64::INFINITY, f64::min);
        lines.push(level(answer.unreinforced.training[k].mean, 1));
        lines.extend(quantile(&costs, 0.5).map(|v| level(objective.cost(v), 2)));
        lines.push(level(objective.cost(greedy), 3));
        lines.retain(|l| l.y.iter().all(|v| v.is_finite()));
        Panel {
            heading: String::new(),
            x: Axis { quantity: "runs of the search".into(), ..Axis::default() },
            y: Axis { quantity: objective.title(), unit: objective.target.unit(), ..Axis::default() },
            lines,
            rising: true,
            bare: false,
            marked: false,
        }
    };
    let panels: Vec<Panel> = question.objectives.iter().enumerate().map(panel).collect();
    let sheet = Sheet {
        title: "Convergence of the search".into(),
        legend: ["best of the search", "unreinforced", "median of random", "best greedy"].map(String::from).to_vec(),
        columns: panels.len(),
        panels,
        width: SIZE[0],
        height: Some(SIZE[1]),
    };
    let caption =
        "Best value so far under the motions of the search, each as it is; greedy with tuned parameters.".into();
    Figure { name: "interfaces-convergence".into(), caption, drawing: chart::draw(&sheet) }
}

/// Where the devices go.
fn placement(question: &Question, answer: &Answer) -> Figure {
    let map = |line: &Line| {
        let joints = line.design.iter().flat_map(|d| &d.joints).map(|&e| question.eligible[e]).collect();
        let device = line.design.as_ref().map_or("", |d| question.devices[d.device].name.as_str());
        Map { heading: format!("{}: {device}", line.name), values: Vec::new(), marked: joints }
    };
    let mut lines: Vec<&Line> = answer.search.get(answer.chosen).into_iter().collect();
    for line in answer.greedy.iter().chain(&answer.greedy_as_found) {
        if !lines.iter().any(|l| l.name == line.name) {
            lines.push(line);
        }
    }
    let maps: Vec<Map> = lines.into_iter().map(map).collect();
    let drawing = wall_map::draw(&question.wall, &question.joints, &question.names, &maps, "Joints replaced", "");
    let caption = "Joints that the search and the rankings replace.".into();
    Figure { name: "interfaces-placement".into(), caption, drawing }
}

/// Two objectives against each other.
fn front(question: &Question, answer: &Answer) -> Figure {
    let axis = |k: usize| {
        let objective = question.objectives[k];
        Axis { quantity: objective.title(), unit: objective.target.unit(), ..Axis::default() }
    };
    let point = |line: &Line, style: usize, held: bool| {
        let at = |k: usize| {
            let spreads = if held { &line.held_out } else { &line.training };
            spreads.get(k).map_or(f64::NAN, |s| s.mean)
        };
        chart::Line { x: vec![at(0)].into(), y: vec![at(1)].into(), style }
    };
    let panel = |(held, heading): (bool, &str)| {
        let groups: [(&[Line], usize); 5] = [
            (&answer.random, 2),
            (&answer.greedy, 3),
            (&answer.greedy_as_found, 3),
            (std::slice::from_ref(&answer.unreinforced), 1),
            (&answer.search, 0),
        ];
        let all = groups.iter().flat_map(|(lines, style)| lines.iter().map(|l| point(l, *style, held)));
        Panel {
            heading: heading.into(),
            x: axis(0),
            y: axis(1),
            lines: all.filter(|l| l.x[0].is_finite() && l.y[0].is_finite()).collect(),
            rising: false,
            bare: false,
            marked: true,
        }
    };
    let held = !answer.unreinforced.held_out.is_empty();
    let kinds = [(false, "motions of the search"), (true, "held out")];
    let panels: Vec<Panel> = kinds.into_iter().filter(|(h, _)| !h || held).map(panel).collect();
    let sheet = Sheet {
        title: "Two objectives".into(),
        legend: ["search", "unreinforced", "random", "greedy"].map(String::from).to_vec(),
        columns: panels.len(),
        panels,
        width: SIZE[0],
        height: Some(SIZE[1] + 30.0),
    };
    let caption = "Designs of the search that no other dominates, beside the baselines.".into();
    Figure { name: "interfaces-front".into(), caption, drawing: chart::draw(&sheet) }
}
