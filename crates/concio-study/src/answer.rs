//! The answer to a study's question about interfaces: what the search found, beside the wall as it is, placements by rank
//! and random ones, each under the motions of the search and under those that it did not know.
//!
//! Stick-slip is chaotic: a motion that differs in the seventh digit gives other peaks. Everything compared is therefore
//! run in several such copies of the motions, and means stand beside their scatter.

use concio::Result;
use concio::dice::Dice;

use crate::bench::{Bench, Copies};
use crate::file::PerJoint;
use crate::interfaces::Question;
use crate::measures::Row;
use crate::pareto;
use crate::placement::Set;
use crate::plan::Plan;
use crate::ranking::{Ranks, ranks};
use crate::runner::Runner;
use crate::search::{Design, Found, Member, Quest, search};

/// A mean over copies of the motions and its scatter, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation; 0 of a single copy.
    pub deviation: f64,
}

impl Spread {
    fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        Spread { mean, deviation: if n > 1.0 { (square / (n - 1.0)).sqrt() } else { 0.0 } }
    }
}

/// One of what is compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// What it is.
    pub name: String,
    /// The design; none for the wall as it is.
    pub design: Option<Design>,
    /// Per objective, under the motions of the search.
    pub training: Vec<Spread>,
    /// Per objective, under the held-out ones; empty where there are none.
    pub held_out: Vec<Spread>,
    /// Per scene and objective, the mean over the copies.
    pub scenes: Vec<Vec<f64>>,
    /// The same in the first copy, the only one of random placements.
    pub first: Vec<Vec<f64>>,
}

/// The answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Rankings of the joints of the wall as it is, under the motions of the search.
    pub ranks: Vec<Ranks>,
    /// The wall as it is.
    pub unreinforced: Line,
    /// The devices in the joints of highest rank, parameters tuned: one line per ranking, or with two objectives the ends
    /// of its front and its knee.
    pub greedy: Vec<Line>,
    /// The joints of highest rank, one line per ranking, with the device and the parameters of the chosen design.
    pub greedy_as_found: Vec<Line>,
    /// What the search found: one line, or with two objectives the front, in the order of the first.
    pub search: Vec<Line>,
    /// The line of the search that stands for it: of a front the knee.
    pub chosen: usize,
    /// Random placements with random devices and parameters.
    pub random: Vec<Line>,
    /// Random placements of as many joints as the chosen design has, with its device and parameters.
    pub placed: Vec<Line>,
    /// After every generation of the search, runs so far and the best value of each objective.
    pub trace: Vec<(usize, Vec<f64>)>,
    /// The same of the tuning of the greedy placements, all rankings one after the other.
    pub greedy_trace: Vec<(usize, Vec<f64>)>,
    /// Runs that were asked for: by the tuning of the greedy placements, the search, and everything.
    pub runs: [usize; 3],
}

/// Asks the question. `rows` are those of the plan. None where the user stopped; asked again, it goes on.
///
/// # Errors
/// The store, or a design that makes no wall.
pub fn answer(plan: &Plan, question: &Question, rows: &[&Row], runner: &mut Runner) -> Result<Option<Answer>> {
    let mut question = question.clone();
    let ranks = ranked(plan, &question, rows);
    question.places.weights = weights(&question, &ranks);
    let mut bench = Bench::new(plan, &question, runner);
    let training = question.of(false);
    let each = training.len() * question.runs_each();
    let evaluations = question.input.runs / each;
    let parameters: Vec<usize> = question.devices.iter().map(|d| d.parameters.len()).collect();
    let input = &question.input;
    let quest = Quest {
        places: &question.places,
        parameters: &parameters,
        starts: &[],
        known: &[],
        fixed: false,
        evaluations,
        population: input.population,
        seed: input.seed,
    };

    let mut tuned: Vec<(PerJoint, Found)> = Vec::new();
    for (number, rank) in ranks.iter().enumerate() {
        let starts = [top(&question, rank, question.places.most)];
        let quest = Quest {
            starts: &starts,
            fixed: true,
            // All rankings together have as much as the search.
            evaluations: evaluations / ranks.len(),
            seed: input.seed.wrapping_add(1 + number as u64),
            ..quest.clone()
        };
        let Some(found) = sought(&quest, &mut bench, &training)? else { return Ok(None) };
        tuned.push((rank.by, found));
    }
    let greedy_runs = bench.runs;
    let mut known: Vec<&Member> = tuned.iter().flat_map(|(_, found)| &found.front).collect();
    known.sort_by(|a, b| a.values[0].total_cmp(&b.values[0]));
    let known: Vec<Design> = known.into_iter().map(|m| m.design.clone()).collect();
    let starts = starts(&question, &ranks);
    let quest = Quest { starts: &starts, known: &known, ..quest };
    let Some(found) = sought(&quest, &mut bench, &training)? else { return Ok(None) };
    let search_runs = bench.runs - greedy_runs;

    let mut judge = Judge { question: &question, bench: &mut bench };
    let Some(unreinforced) = judge.line("unreinforced", None, true)? else { return Ok(None) };
    let mut greedy = Vec::new();
    for (by, found) in &tuned {
        for member in spread_out(&found.front) {
            let name = format!("greedy by {}", crate::ranking::name(*by));
            let Some(line) = judge.line(&name, Some(&member.design), true)? else { return Ok(None) };
            greedy.push(line);
        }
    }
    let Some(search) = judge.best(&found)? else { return Ok(None) };
    let costs: Vec<Vec<f64>> = search.iter().map(|l| judge.costs(l)).collect();
    let chosen = pareto::knee(&costs).unwrap_or(0);
    let Some(design) = search.get(chosen).and_then(|l| l.design.clone()) else { return Ok(None) };
    let as_the_search = |rank: &Ranks| Design { joints: top(&question, rank, question.places.most), ..design.clone() };
    let mut greedy_as_found = Vec::new();
    for rank in &ranks {
        let name = format!("greedy by {}, device of the search", crate::ranking::name(rank.by));
        let Some(line) = judge.line(&name, Some(&as_the_search(rank)), true)? else { return Ok(None) };
        greedy_as_found.push(line);
    }
    let Some(random) = judge.random(None)? else { return Ok(None) };
    let Some(placed) = judge.random(Some(&design))? else { return Ok(None) };
    let by_runs = |(n, best): &(usize, Vec<f64>)| {
        let back = best.iter().zip(&question.objectives).map(|(v, o)| o.cost(*v)).collect();
        (n * each, back)
    };
    let mut before = 0;
    let mut greedy_trace = Vec::new();
    for (_, found) in &tuned {
        greedy_trace.extend(found.trace.iter().map(by_runs).map(|(n, best)| (before + n, best)));
        before = greedy_trace.last().map_or(before, |(n, _)| *n);
    }
    let trace = found.trace.iter().map(by_runs).collect();
    let runs = [greedy_runs, search_runs, bench.runs];
    Ok(Some(Answer {
        ranks,
        unreinforced,
        greedy,
        greedy_as_found,
        search,
        chosen,
        random,
        placed,
        trace,
        greedy_trace,
        runs,
    }))
}

/// Runs that the comparison takes besides the search, at most: the wall as it is, the greedy placements and the finalists in
/// copies, random placements of both kinds once.
pub fn comparison(plan: &Plan, question: &Question) -> usize {
    let rankings = plan.file.study.ranking.clone().unwrap_or_default().by.len();
    let input = &question.input;
    // With parameters of its own, of two objectives both ends of a front and its knee; and with those of the search.
    let greedy = rankings * if question.objectives.len() > 1 { 4 } else { 2 };
    let lines = (1 + greedy + input.finalists) * input.copies + 2 * input.draws;
    lines * question.scenes.len() * question.runs_each()
}

/// Of a front the best of every objective and the knee.
fn spread_out(front: &[Member]) -> Vec<&Member> {
    let values: Vec<Vec<f64>> = front.iter().map(|m| m.values.clone()).collect();
    let objectives = values.first().map_or(0, Vec::len);
    let best = |k: usize| (0..front.len()).min_by(|&a, &b| values[a][k].total_cmp(&values[b][k]));
    let mut places: Vec<usize> = (0..objectives).filter_map(best).chain(pareto::knee(&values)).collect();
    places.sort_unstable();
    places.dedup();
    places.into_iter().map(|k| &front[k]).collect()
}

/// Ranks all joints by the runs of the plan that the search may see.
fn ranked(plan: &Plan, question: &Question, rows: &[&Row]) -> Vec<Ranks> {
    let seen: Vec<&Row> = question.of(false).into_iter().filter_map(|s| rows.get(s).copied()).collect();
    let by = plan.file.study.ranking.clone().unwrap_or_default().by;
    by.into_iter().filter_map(|by| ranks(&seen, by)).collect()
}

/// The most critical of the eligible joints.
fn top(question: &Question, ranks: &Ranks, most: usize) -> Set {
    let place = |e: &usize| question.eligible.iter().position(|f| f == e);
    let mut set: Set = ranks.order.iter().filter_map(place).take(most).collect();
    set.sort_unstable();
    set
}

/// Per eligible joint the sum of its ratios.
fn weights(question: &Question, ranks: &[Ranks]) -> Vec<f64> {
    question.eligible.iter().map(|&e| ranks.iter().map(|r| r.ratio[e]).sum()).collect()
}

/// Sets to start from: the most critical joints by every ranking; then, for every course, its beds, and the most critical
/// bed of each course: layers and ladders are what engineers would try.
fn starts(question: &Question, ranks: &[Ranks]) -> Vec<Set> {
    let most = question.places.most;
    let mut starts: Vec<Set> = ranks.iter().map(|r| top(question, r, most)).collect();
    let mut layers: Vec<(i64, Set)> = Vec::new();
    for (i, &e) in question.eligible.iter().enumerate() {
        let joint = &question.joints[e];
        if joint.kind.is_upright() {
            continue;
        }
        // Levels in micrometres: beds of one course lie on one line.
        let level = (joint.line[1] * 1e6).round() as i64;
        match layers.iter_mut().find(|(l, _)| *l == level) {
            Some((_, set)) => set.push(i),
            None => layers.push((level, vec![i])),
        }
    }
    layers.sort_unstable();
    let weight = |i: &usize| question.places.weights[*i];
    for (_, set) in &mut layers {
        set.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    }
    let mut ladder: Set = layers.iter().filter_map(|(_, set)| set.first().copied()).collect();
    ladder.truncate(most);
    let layers = layers.into_iter().map(|(_, set)| set.into_iter().take(most).collect());
    for mut set in [ladder].into_iter().chain(layers) {
        set.sort_unstable();
        if !set.is_empty() && !starts.contains(&set) {
            starts.push(set);
        }
    }
    starts
}

fn sought(quest: &Quest, bench: &mut Bench, training: &[usize]) -> Result<Option<Found>> {
    let objectives = bench.question().objectives.clone();
    let mut evaluate = |designs: &[Design]| -> Result<Option<Vec<Vec<f64>>>> {
        let some: Vec<Option<&Design>> = designs.iter().map(Some).collect();
        let Some(values) = bench.objectives(&some, training, &[1.0])? else { return Ok(None) };
        let cost = |v: &Vec<Vec<f64>>| v[0].iter().zip(&objectives).map(|(v, o)| o.cost(*v)).collect();
        Ok(Some(values.iter().map(cost).collect()))
    };
    search(quest, &mut evaluate)
}

/// Runs what is compared.
struct Judge<'j, 'b, 'r> {
    question: &'j Question,
    bench: &'j mut Bench<'b, 'r>,
}

impl Judge<'_, '_, '_> {
    /// Factors on the motions of the copies. None is the motion itself: a design was chosen by how lucky it was in that one
    /// trajectory.
    fn factors(&self, copies: usize) -> Vec<f64> {
        (1..=copies).map(|k| 1.0 + k as f64 * self.question.input.perturbation).collect()
    }

    fn line(&mut self, name: &str, design: Option<&Design>, copied: bool) -> Result<Option<Line>> {
        let lines = self.lines(&[(name.to_string(), design)], copied)?;
        Ok(lines.map(|mut lines| lines.remove(0)))
    }

    fn lines(&mut self, what: &[(String, Option<&Design>)], copied: bool) -> Result<Option<Vec<Line>>> {
        let factors = self.factors(if copied { self.question.input.copies } else { 1 });
        let designs: Vec<Option<&Design>> = what.iter().map(|w| w.1).collect();
        let scenes: Vec<usize> = (0..self.question.scenes.len()).collect();
        let Some(values) = self.bench.by_scene(&designs, &scenes, &factors)? else { return Ok(None) };
        let mut lines = Vec::new();
        for ((name, design), values) in what.iter().zip(&values) {
            lines.push(Line {
                name: name.clone(),
                design: design.cloned(),
                training: self.spreads(values, false),
                held_out: self.spreads(values, true),
                scenes: self.by_scene(values),
                first: values.first().cloned().unwrap_or_default(),
            });
        }
        Ok(Some(lines))
    }

    /// Objectives over the copies; `values` by copy, scene, objective.
    fn spreads(&self, values: &Copies, held_out: bool) -> Vec<Spread> {
        let scenes = self.question.of(held_out);
        if scenes.is_empty() {
            return Vec::new();
        }
        let one = |(k, objective): (usize, &crate::interfaces::Objective)| {
            let of = |copy: &Vec<Vec<f64>>| objective.over(&scenes.iter().map(|&s| copy[s][k]).collect::<Vec<_>>());
            Spread::of(&values.iter().map(of).collect::<Vec<_>>())
        };
        self.question.objectives.iter().enumerate().map(one).collect()
    }

    fn by_scene(&self, values: &Copies) -> Vec<Vec<f64>> {
        let mean = |s: usize, k: usize| values.iter().map(|copy| copy[s][k]).sum::<f64>() / values.len() as f64;
        let objectives = 0..self.question.objectives.len();
        (0..self.question.scenes.len()).map(|s| objectives.clone().map(|k| mean(s, k)).collect()).collect()
    }

    /// Mean objectives under the motions of the search, small where good.
    fn costs(&self, line: &Line) -> Vec<f64> {
        line.training.iter().zip(&self.question.objectives).map(|(v, o)| o.cost(v.mean)).collect()
    }

    /// The best designs again in copies: a design that was lucky in one trajectory loses its luck.
    fn best(&mut self, found: &Found) -> Result<Option<Vec<Line>>> {
        // A front comes first, from its ends inwards.
        let designs: Vec<&Design> = found.best.iter().take(self.question.input.finalists).map(|m| &m.design).collect();
        let what: Vec<(String, Option<&Design>)> = designs.iter().map(|d| ("search".to_string(), Some(*d))).collect();
        let Some(lines) = self.lines(&what, true)? else { return Ok(None) };
        let costs: Vec<Vec<f64>> = lines.iter().map(|l| self.costs(l)).collect();
        let mut front: Vec<Line> = pareto::front(&costs).into_iter().map(|k| lines[k].clone()).collect();
        front.sort_by(|a, b| self.costs(a)[0].total_cmp(&self.costs(b)[0]));
        Ok(Some(front))
    }

    /// Random placements: of `design` with as many joints, or of everything.
    fn random(&mut self, design: Option<&Design>) -> Result<Option<Vec<Line>>> {
        let question = self.question;
        let mut dice = Dice::new(question.input.seed ^ (0xd1ce + u64::from(design.is_some())));
        let draw = |dice: &mut Dice| match design {
            Some(d) => Design { joints: question.places.random(d.joints.len(), dice), ..d.clone() },
            None => {
                let device = dice.below(question.devices.len());
                let joints = question.places.random(question.places.most, dice);
                let shares = question.devices[device].parameters.iter().map(|_| dice.unit()).collect();
                Design { device, joints, shares }
            }
        };
        let designs: Vec<Design> = (0..question.input.draws).map(|_| draw(&mut dice)).collect();
        let name = |i: usize| format!("random {}", i + 1);
        let what: Vec<(String, Option<&Design>)> =
            designs.iter().enumerate().map(|(i, d)| (name(i), Some(d))).collect();
        self.lines(&what, false)
    }
}

/// Scatter of copies over the value, from which on it is evidence: below, copies hardly differ, and it says nothing.
const TELLING: f64 = 1e-3;

/// The best and the median of some random placements; the best is that under the motions of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draws {
    /// The best one, in the objective's unit.
    pub best: f64,
    /// Half of them lie below, in the same.
    pub median: f64,
}

/// How the search did for one objective under one kind of motions.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict<'a> {
    /// The wall as it is.
    pub unreinforced: Spread,
    /// The place of the search's best design for this objective, as the motions of the search show it, and its value.
    pub search: (usize, Spread),
    /// The best under the motions of the search of the greedy placements with parameters of their own, and of those with the
    /// device of the search.
    pub greedy: [Option<(&'a Line, Spread)>; 2],
    /// Random placements, and random places of the found device.
    pub random: [Option<Draws>; 2],
    /// Lines whose design is that of the search: they are no rivals.
    pub same: Vec<&'a Line>,
    /// The best of all others.
    pub rival: &'a Line,
    /// By what part of the rival's value the search is better; negative where it is not. A rival of one copy is compared with
    /// that copy of the search.
    pub gain: f64,
    /// The same in scatters of the difference of two copies; none where that is below a thousandth of the value.
    pub scatters: Option<f64>,
    /// Under how many motions the search is better than the rival, and of how many.
    pub motions: [usize; 2],
}

impl Answer {
    /// How the search did for an objective under the motions of the search or the held-out ones; none where there are none.
    pub fn verdict(&self, question: &Question, objective: usize, held_out: bool) -> Option<Verdict<'_>> {
        let goal = question.objectives[objective];
        let scenes = question.of(held_out);
        let of = |line: &Line| {
            let spreads = if held_out { &line.held_out } else { &line.training };
            spreads.get(objective).copied()
        };
        let cost = |line: &Line| of(line).map_or(f64::INFINITY, |s| goal.cost(s.mean));
        // Each strategy is asked for its best under the motions of the search: what does best under others nobody knows beforehand.
        let training = |line: &Line| line.training.get(objective).map_or(f64::INFINITY, |s| goal.cost(s.mean));
        let best = least(&self.search, &training)?;
        let place = self.search.iter().position(|line| std::ptr::eq(line, best))?;
        let search = of(best)?;
        let is_same = |line: &&Line| match (&line.design, &best.design) {
            (Some(a), Some(b)) => question.is_same(a, b),
            _ => false,
        };
        let (greedy, drawn) = ([&self.greedy, &self.greedy_as_found], [&self.random, &self.placed]);
        let kinds = || greedy.into_iter().chain(drawn);
        let rivals = kinds().filter_map(|lines| least(lines.iter().filter(|line| !is_same(line)), &training));
        let rival = least(std::iter::once(&self.unreinforced).chain(rivals), &cost)?;
        // A rival that was run once is compared with the same copy of the search, and taken to scatter as that does.
        let single = drawn.into_iter().flatten().any(|line| std::ptr::eq(line, rival));
        let by_scene = |line: &Line| -> Vec<f64> {
            let values = if single { &line.first } else { &line.scenes };
            scenes.iter().filter_map(|&s| values.get(s)?.get(objective).copied()).collect()
        };
        let [ours, theirs] = [best, rival].map(by_scene);
        let [of_search, of_rival] = match single {
            true => [goal.over(&ours), goal.over(&theirs)],
            false => [search.mean, of(rival)?.mean],
        };
        let scatter = search.deviation.hypot(if single { search.deviation } else { of(rival)?.deviation });
        let gain = goal.cost(of_rival) - goal.cost(of_search);
        let better = ours.iter().zip(&theirs).filter(|(a, b)| goal.cost(**a) < goal.cost(**b)).count();
        let draws = |lines: &Vec<Line>| {
            let costs: Vec<f64> = lines.iter().map(cost).collect();
            let best = cost(least(lines, &training)?);
            Some(Draws { best: goal.cost(best), median: goal.cost(quantile(&costs, 0.5)?) })
        };
        let with_value = |line| Some((line, of(line)?));
        Some(Verdict {
            unreinforced: of(&self.unreinforced)?,
            search: (place, search),
            greedy: greedy.map(|lines| least(lines, &training).and_then(with_value)),
            random: drawn.map(draws),
            same: kinds().flatten().filter(is_same).collect(),
            rival,
            gain: if of_rival.is_finite() && of_rival != 0.0 { gain / of_rival.abs() } else { gain },
            scatters: (scatter > 0.0 && scatter >= TELLING * of_search.abs()).then(|| gain / scatter),
            motions: [better, scenes.len()],
        })
    }
}

/// The line of least cost, of equal ones the first.
fn least<'l>(lines: impl IntoIterator<Item = &'l Line>, cost: &dyn Fn(&Line) -> f64) -> Option<&'l Line> {
    lines.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))
}

/// The value below which lies a share of some numbers, linear between them; none of none.
pub fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    (!sorted.is_empty()).then(|| crate::ida::curve::quantile(&sorted, share))
}
