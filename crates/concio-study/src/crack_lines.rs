//! Crack lines: how often each joint of a wall cracks over many runs, in which order, and which joints that crack often
//! hang together.
//!
//! A run counts a joint as cracked by the rule asked for. Lines are chains of joints, cracked in at least a share of the
//! runs, each of which meets the next at the corner of a block.

use std::collections::BTreeMap;

use concio::Result;
use concio::case::{Beam, Case};
use concio::model::Model;
use concio::quantity::Length;
use concio::wall::{Joint, Wall};
use concio::{graph, pattern};

use crate::Plan;
use crate::factors::Over;
use crate::file::StudyFile;
use crate::file::analyses::CracksInput;
use crate::first_crack::check_limit;
use crate::limits::{Criterion, Limits};
use crate::measures::{End, Row};
use crate::statistics::student;

/// Slack of corners that meet, over the length of the wall.
const SLACK: f64 = 1e-6;
/// Two-sided 95 % of a normal variable.
const DEVIATIONS: f64 = 1.959_963_984_540_054;
/// Confidence of such an interval.
const CONFIDENCE: f64 = 0.95;

impl CracksInput {
    /// Says whether the numbers are in range and the question has a meaning for the walls of a plan.
    ///
    /// # Errors
    /// With the line of the study file.
    pub fn check(&self, plan: &Plan) -> Result<()> {
        let file: &StudyFile = &plan.file;
        check_limit(self.criterion, self.limit.map(Length::si), "cracks").map_err(|e| file.document.locate(e))?;
        if !(self.threshold > 0.0 && self.threshold <= 1.0) {
            let what = format!("{} is out of range", self.threshold);
            return Err(file.wrong("cracks.threshold", what, "above 0, to 1"));
        }
        let mut cases = (0..plan.points.len()).map(|number| plan.case(number));
        let Some(first) = cases.next().transpose()? else { return Ok(()) };
        let beam = |case: &Case| case.load.beam != Beam::Free;
        let joints = |case: &Case| -> Result<Vec<Joint>> {
            let wall = pattern::lay(case).map_err(|e| file.of_wall("cracks", e))?;
            Ok(graph::joints(&wall, beam(case)))
        };
        let known = joints(&first)?;
        for case in cases {
            let case = case?;
            let same = case.panels == first.panels && beam(&case) == beam(&first);
            if !same && joints(&case)? != known {
                let what = "the runs have walls of different blocks, whose joints cannot be counted together";
                return Err(file.wrong(
                    "cracks",
                    what,
                    "factors that leave joints where they are, and the kind of beam",
                ));
            }
        }
        let prepared =
            concio::run::prepare_case(first, std::path::Path::new("")).map_err(|e| file.of_wall("cracks", e))?;
        if Limits::of(&prepared.model, &self.rule()).is_none() {
            let what = format!("criterion `{}` looks at no joint of this wall", self.criterion.name());
            let allowed =
                "`[joint.bond]` in the wall file for `bond`, head joints for `opening`, bed joints for `slip`";
            return Err(file.wrong("cracks.criterion", what, allowed));
        }
        Ok(())
    }
}

/// What became of a joint over many runs.
#[derive(Debug, Clone, PartialEq)]
pub struct JointCracks {
    /// Index of the joint.
    pub joint: usize,
    /// Runs in which it cracked.
    pub cracked: usize,
    /// Share of the runs in which it cracked, 0 … 1.
    pub frequency: f64,
    /// Ends of the 95 % interval of its probability (Wilson, J. Am. Stat. Assoc. 22 (1927) 209), of as many independent runs as tell as much: those under one
    /// motion are not.
    pub interval: [f64; 2],
    /// Mean place in the order of cracking over the runs in which it cracked, 1 for the first; joints that crack together
    /// share their places. None when it never did, or the rule does not tell when.
    pub order: Option<f64>,
    /// Runs in which no joint cracked before it.
    pub first: usize,
}

/// Joints that hang together.
#[derive(Debug, Clone, PartialEq)]
pub struct CrackLine {
    /// Their indices, rising.
    pub joints: Vec<usize>,
    /// How many of them stand: head joints and connections.
    pub heads: usize,
    /// Length of the joints [m].
    pub length: f64,
    /// Left, bottom, right, top [m].
    pub reach: [f64; 4],
    /// Whether it goes from the left end of the wall to the right, and from the bottom to the top.
    pub through: [bool; 2],
    /// Share of the runs in which all of its joints cracked.
    pub whole: f64,
    /// Mean of their frequencies.
    pub frequency: f64,
}

/// Runs counted together.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// What they have in common.
    pub name: String,
    /// How many they are.
    pub runs: usize,
    /// Runs in which any joint cracked.
    pub cracked: usize,
    /// Mean number of joints that cracked in a run.
    pub mean: f64,
    /// One entry per joint that the rule looks at.
    pub joints: Vec<JointCracks>,
    /// Lines, the one of most joints first.
    pub lines: Vec<CrackLine>,
}

/// Counts all runs of a plan together and, where scales vary, those of each scale. `model` is that of any run: all have
/// the same joints ([`CracksInput::check`]). Runs that failed or stopped early are left out.
pub fn count(input: &CracksInput, plan: &Plan, model: &Model, rows: &[Option<&Row>]) -> Vec<Group> {
    let scales = plan.factors.iter().position(|f| matches!(f.over, Over::Scales(_)));
    let all: Vec<(usize, &Row)> = rows.iter().enumerate().filter_map(|(i, r)| Some((i, (*r)?))).collect();
    let done: Vec<(usize, &Row)> = all.into_iter().filter(|(_, r)| r.end == End::Completed).collect();
    let motions = plan.motions();
    let rows_of = |some: &[(usize, &Row)]| {
        some.iter().map(|(number, r)| (motions[*number], times(input, model, r))).unzip::<_, _, Vec<_>, Vec<_>>()
    };
    let mut groups = vec![group("all runs", input, model, &rows_of(&done))];
    if let Some(place) = scales
        && let Over::Scales(levels) = &plan.factors[place].over
        && levels.len() > 1
    {
        for level in levels {
            let at = |number: usize| plan.labels(number)[place].as_f64() == Some(*level);
            let some: Vec<(usize, &Row)> = done.iter().copied().filter(|(number, _)| at(*number)).collect();
            groups.push(group(&format!("scale {level}"), input, model, &rows_of(&some)));
        }
    }
    groups
}

/// When each joint cracked [s]: infinite for those that did not; 0 where the rule does not tell when.
fn times(input: &CracksInput, model: &Model, row: &Row) -> Vec<f64> {
    let value = |e: usize| row.joints.get(&input.keeps()).and_then(|v| v.get(e).copied().flatten());
    let Some(limits) = Limits::of(model, &input.rule()) else { return vec![f64::INFINITY; model.joints.len()] };
    let time = |e: usize| match (input.criterion, value(e)) {
        (Criterion::Bond, Some(time)) => time,
        (Criterion::Opening | Criterion::Slip, Some(v)) if v >= limits.of_joint[e] => 0.0,
        _ => f64::INFINITY,
    };
    (0..model.joints.len()).map(time).collect()
}

fn group(name: &str, input: &CracksInput, model: &Model, (motions, runs): &(Vec<usize>, Vec<Vec<f64>>)) -> Group {
    let places: Vec<Vec<Option<f64>>> = runs.iter().map(|times| order(times)).collect();
    let looked_at = Limits::of(model, &input.rule());
    let looked_at = |e: &usize| looked_at.as_ref().is_some_and(|l| l.of_joint[*e].is_finite());
    let joint = |e: usize| {
        let found: Vec<f64> = places.iter().filter_map(|p| p[e]).collect();
        let frequency = found.len() as f64 / runs.len().max(1) as f64;
        let told = input.criterion == Criterion::Bond && !found.is_empty();
        let earliest = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
        JointCracks {
            joint: e,
            cracked: found.len(),
            frequency,
            interval: interval(motions, &runs.iter().map(|times| times[e].is_finite()).collect::<Vec<_>>()),
            order: told.then(|| found.iter().sum::<f64>() / found.len() as f64),
            first: if told { runs.iter().filter(|t| t[e].is_finite() && t[e] == earliest(t)).count() } else { 0 },
        }
    };
    let joints: Vec<JointCracks> = (0..model.joints.len()).filter(looked_at).map(joint).collect();
    let often: Vec<usize> =
        joints.iter().filter(|j| j.cracked > 0 && j.frequency >= input.threshold).map(|j| j.joint).collect();
    let frequency = |e: usize| joints.iter().find(|j| j.joint == e).map_or(0.0, |j| j.frequency);
    let mut lines: Vec<CrackLine> = chains(&model.wall, &model.joints, &often)
        .into_iter()
        .map(|members| line(&model.wall, &model.joints, members, runs, &frequency))
        .collect();
    lines.sort_by_key(|l| (usize::MAX - l.joints.len(), l.joints[0]));
    let cracks = |times: &Vec<f64>| times.iter().filter(|t| t.is_finite()).count();
    Group {
        name: name.into(),
        runs: runs.len(),
        cracked: runs.iter().filter(|t| cracks(t) > 0).count(),
        mean: runs.iter().map(cracks).sum::<usize>() as f64 / runs.len().max(1) as f64,
        joints,
        lines,
    }
}

/// Place of each joint in the order of times, from 1; equal times share the mean of their places.
fn order(times: &[f64]) -> Vec<Option<f64>> {
    let place = |t: f64| {
        let before = times.iter().filter(|o| **o < t).count();
        let with = times.iter().filter(|o| **o == t).count();
        before as f64 + 0.5 * (with as f64 + 1.0)
    };
    times.iter().map(|t| t.is_finite().then(|| place(*t))).collect()
}

/// 95 % interval of the probability of what runs tell, `motions` being the motion of each; of one motion nothing is known.
///
/// Runs under one motion are alike: with the variance of the shares by motion, n runs tell as much as n p (1 − p)/(n V) independent ones (L. Kish, Survey Sampling, 1965), and as many
/// motions less one are the degrees of freedom. Where all runs say the same, they count as one for each motion. Few cracks tell little of how alike runs are: the upper end is the largest of
/// those cracks and of fewer, taken away from the motions of the smallest shares first, down to none; so more cracks have no lower one. The lower end is the same of what did not crack.
pub fn interval(motions: &[usize], runs: &[bool]) -> [f64; 2] {
    let mut sums: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    for (motion, hit) in motions.iter().zip(runs) {
        let sum = sums.entry(*motion).or_default();
        *sum = [sum[0] + f64::from(u8::from(*hit)), sum[1] + 1.0];
    }
    let n = runs.len() as f64;
    if sums.len() < 2 {
        return [0.0, 1.0];
    }
    if sums.len() == runs.len() {
        return wilson(sums.values().map(|[hits, _]| hits).sum::<f64>() / n, n, DEVIATIONS);
    }
    let mut sums: Vec<[f64; 2]> = sums.into_values().collect();
    let high = highest(&mut sums);
    sums.iter_mut().for_each(|sum| sum[0] = sum[1] - sum[0]);
    [1.0 - highest(&mut sums), high]
}

/// The upper end of [`interval`] of motions with so many cracks and runs each, two at least; sorts them.
fn highest(sums: &mut [[f64; 2]]) -> f64 {
    sums.sort_by(|a, b| (b[0] * a[1]).total_cmp(&(a[0] * b[1])));
    let (m, n) = (sums.len() as f64, sums.iter().map(|[_, of]| of).sum::<f64>());
    let t = student(m - 1.0, CONFIDENCE);
    let squares: f64 = sums.iter().map(|[_, of]| of * of).sum();
    // Σ hits, Σ hits² and Σ hits × runs of the motions before.
    let mut before = [0.0; 3];
    let mut high = wilson(0.0, m, DEVIATIONS)[1];
    for [most, of] in sums.iter() {
        for some in 1..=*most as usize {
            let some = some as f64;
            let [hits, of_squares, mixed] = [before[0] + some, before[1] + some * some, before[2] + some * of];
            let p = hits / n;
            // Σ (hits − p runs)² over all motions, those without cracks included.
            let variance = m / (m - 1.0) * (of_squares - 2.0 * p * mixed + p * p * squares).max(0.0) / (n * n);
            let alone = p * (1.0 - p);
            let end = match alone > 0.0 {
                true => wilson(p, (alone / variance).min(n), t)[1],
                false => wilson(p, m, DEVIATIONS)[1],
            };
            high = high.max(end);
        }
        before = [before[0] + most, before[1] + most * most, before[2] + most * of];
    }
    high
}

/// Interval of a probability that a share `p` of `n` independent runs estimates, to `z` deviations.
fn wilson(p: f64, n: f64, z: f64) -> [f64; 2] {
    let middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

/// Whether two joints meet at the corner of a block: an end of one and an end of the other are no farther apart than mortar
/// is thick.
pub fn meet(wall: &Wall, a: &Joint, b: &Joint) -> bool {
    let panels = [a, b].map(|j| &wall.panels[wall.blocks[j.a].panel]);
    let bed = panels.iter().map(|p| p.mortar[0]).fold(0.0, f64::max);
    let head = panels.iter().map(|p| p.mortar[1].max(p.connection)).fold(0.0, f64::max);
    let slack = SLACK * panels[0].reference_length;
    let ends = |j: &Joint| [[j.line[0], j.line[1]], [j.line[2], j.line[3]]];
    let near = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).abs() <= head + slack && (p[1] - q[1]).abs() <= bed + slack;
    ends(a).iter().any(|p| ends(b).iter().any(|q| near(*p, *q)))
}

/// Sets of joints that hang together, each rising.
fn chains(wall: &Wall, joints: &[Joint], members: &[usize]) -> Vec<Vec<usize>> {
    let mut left: Vec<usize> = members.to_vec();
    let mut chains = Vec::new();
    while let Some(start) = left.pop() {
        let mut chain = vec![start];
        let mut next = 0;
        while next < chain.len() {
            let here = &joints[chain[next]];
            let (touching, apart): (Vec<usize>, Vec<usize>) = left.iter().partition(|e| meet(wall, here, &joints[**e]));
            chain.extend(touching);
            left = apart;
            next += 1;
        }
        chain.sort_unstable();
        chains.push(chain);
    }
    chains
}

fn line(
    wall: &Wall,
    all: &[Joint],
    joints: Vec<usize>,
    runs: &[Vec<f64>],
    frequency: &dyn Fn(usize) -> f64,
) -> CrackLine {
    const NOWHERE: [f64; 4] = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let grow = |r: [f64; 4], l: [f64; 4]| {
        [r[0].min(l[0].min(l[2])), r[1].min(l[1].min(l[3])), r[2].max(l[0].max(l[2])), r[3].max(l[1].max(l[3]))]
    };
    let reach = joints.iter().fold(NOWHERE, |r, e| grow(r, all[*e].line));
    let bounds = wall.blocks.iter().fold(NOWHERE, |r, b| grow(r, [b.x[0], b.y[0], b.x[1], b.y[1]]));
    let mortar = wall.panels.iter().map(|p| p.mortar[0].max(p.mortar[1])).fold(0.0, f64::max);
    let close = |a: f64, b: f64| (a - b).abs() <= mortar + SLACK * (bounds[2] - bounds[0]);
    let whole = runs.iter().filter(|t| joints.iter().all(|e| t[*e].is_finite())).count();
    CrackLine {
        heads: joints.iter().filter(|e| all[**e].kind.is_upright()).count(),
        length: joints.iter().map(|e| all[*e].overlap).sum(),
        reach,
        through: [
            close(reach[0], bounds[0]) && close(reach[2], bounds[2]),
            close(reach[1], bounds[1]) && close(reach[3], bounds[3]),
        ],
        whole: whole as f64 / runs.len().max(1) as f64,
        frequency: joints.iter().map(|e| frequency(*e)).sum::<f64>() / joints.len() as f64,
        joints,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: f64 = f64::INFINITY;

    #[test]
    fn equal_times_share_their_places() {
        assert_eq!(order(&[0.3, ALL, 0.1, 0.3]), [Some(2.5), None, Some(1.0), Some(2.5)]);
    }

    /// Wilson's interval for 8 of 10, as R's `prop.test(8, 10, correct = FALSE)` prints it: 0.4901625 0.9433178.
    #[test]
    fn intervals_are_those_of_wilson() {
        let runs: Vec<bool> = (0..10).map(|k| k < 8).collect();
        let each: Vec<usize> = (0..10).collect();
        let [low, high] = interval(&each, &runs);
        assert!((low - 0.490_162_5).abs() < 1e-7 && (high - 0.943_317_8).abs() < 1e-7, "{low} {high}");
        assert_eq!(interval(&[0; 10], &runs), [0.0, 1.0], "one motion is no sample of motions");
        assert_eq!(interval(&each, &[false; 10])[0], 0.0);
        assert_eq!(interval(&[], &[]), [0.0, 1.0]);
    }

    /// One more crack, under whatever motion, lowers neither end, of five motions with up to five runs each; no cracks under six motions may be up to 1 − 6/(6 + 1.96²) as often as the runs.
    #[test]
    fn more_cracks_are_no_rarer() {
        let of = |hits: &[usize; 5]| {
            let runs = hits.iter().enumerate().flat_map(|(motion, hits)| (0..5).map(move |run| (motion, run < *hits)));
            let (motions, runs): (Vec<_>, Vec<_>) = runs.unzip();
            interval(&motions, &runs)
        };
        for pattern in 0..6usize.pow(5) {
            let hits = [0, 1, 2, 3, 4].map(|k| pattern / 6usize.pow(k) % 6);
            let [low, high] = of(&hits);
            for more in (0..5).filter(|k| hits[*k] < 5) {
                let mut hits = hits;
                hits[more] += 1;
                let next = of(&hits);
                assert!(next[0] >= low - 1e-12 && next[1] >= high - 1e-12, "{hits:?} {low} {high} {next:?}");
            }
        }
        let six: Vec<usize> = (0..60).map(|run| run % 6).collect();
        let none = 1.0 - 6.0 / (6.0 + DEVIATIONS * DEVIATIONS);
        for cracks in 0..60 {
            let [_, high] = interval(&six, &(0..60).map(|run| run < cracks).collect::<Vec<_>>());
            assert!(high >= none - 1e-12, "{cracks}: {high} {none}");
        }
        assert!((interval(&six, &[false; 60])[1] - none).abs() < 1e-12);
    }

    fn model() -> Result<Model> {
        let case = concio::case::example()?.case;
        Ok(concio::run::prepare_case(case, std::path::Path::new(""))?.model)
    }

    /// In a running bond a head joint meets the bed joints left and right of its two ends, and no head joint of the next
    /// course; two bed joints of a course meet where the blocks do.
    #[test]
    fn joints_meet_at_corners() -> Result<()> {
        let model = model()?;
        let place = |name: &str| {
            let found = model.joints.iter().position(|j| concio::graph::name(&model.wall, j) == name);
            found.unwrap_or_else(|| panic!("no joint {name}"))
        };
        let meets = |a: &str, b: &str| meet(&model.wall, &model.joints[place(a)], &model.joints[place(b)]);
        // Course 1 has whole bricks, course 2 begins with a half.
        assert!(meets("p1c1b1|p1c1b2", "p1c1b1|p1c2b2") && meets("p1c1b1|p1c1b2", "p1c1b2|p1c2b2"));
        assert!(meets("p1c1b1|p1c2b1", "p1c1b1|p1c2b2") && meets("p1c1b1|p1c2b2", "p1c1b2|p1c2b2"));
        assert!(!meets("p1c1b1|p1c1b2", "p1c2b1|p1c2b2") && !meets("p1c1b1|p1c1b2", "p1c1b1|p1c2b1"));
        assert!(meets("base|p1c1b1", "p1c1b1|p1c1b2"));
        Ok(())
    }

    #[test]
    fn a_cracked_bed_joint_from_end_to_end_is_one_line() -> Result<()> {
        let model = model()?;
        let course = |e: &usize| {
            let joint = &model.joints[*e];
            joint.kind == concio::case::JointKind::Bed && model.wall.blocks[joint.a].course == 1
        };
        let members: Vec<usize> = (0..model.joints.len()).filter(course).collect();
        let chains = chains(&model.wall, &model.joints, &members);
        assert_eq!(chains, std::slice::from_ref(&members));
        let times: Vec<f64> = (0..model.joints.len()).map(|e| if course(&e) { 0.1 } else { ALL }).collect();
        let found = line(&model.wall, &model.joints, members, &[times.clone(), vec![ALL; times.len()]], &|_| 0.5);
        assert_eq!((found.through, found.heads, found.whole), ([true, false], 0, 0.5));
        Ok(())
    }
}
