//! Critical joints: the joints of a wall in the order of what they suffer.
//!
//! A joint's ratio in a run is its value over the largest of any joint of that run, as the research report colours them in its
//! Figure 27. The order is that of the ratios' mean over the runs, so that strong motions do not drown weak ones.

use concio::case::{Beam, Case};
use concio::{Result, graph, pattern};
use serde_json::Value;

use crate::file::analyses::Ranking;
use crate::file::{PerJoint, StudyFile, Vary};
use crate::measures::Row;
use crate::statistics::ranks as midranks;
use crate::table::Table;

impl Ranking {
    /// Refuses what cannot be ranked by.
    ///
    /// # Errors
    /// [`concio::Error::Input`] with the line.
    pub fn check(&self, file: &StudyFile) -> Result<()> {
        let allowed = "acceleration, displacement, dissipation, velocity, slip, opening, force, damage; each once";
        if self.by.is_empty() {
            return Err(file.wrong("ranking.by", "nothing to rank by", allowed));
        }
        for (i, by) in self.by.iter().enumerate() {
            let key = format!("ranking.by[{i}]");
            if *by == PerJoint::Cracked {
                return Err(file.wrong(&key, "the time of a crack is no measure of what a joint suffers", allowed));
            }
            if self.by[..i].contains(by) {
                return Err(file.wrong(&key, "is listed twice", allowed));
            }
        }
        if let Some(i) = self.by.iter().position(|by| *by == PerJoint::Damage)
            && !may_crack(file)
        {
            let what = "no joint of this wall is bonded: none has a damage";
            return Err(file.wrong(
                &format!("ranking.by[{i}]"),
                what,
                "a wall file with `joint.bond`, or another measure",
            ));
        }
        if self.listed == 0 {
            return Err(file.wrong("ranking.listed", "0 is out of range", "from 1"));
        }
        Ok(())
    }
}

impl Ranking {
    /// Refuses runs whose walls have other joints than the first: their values cannot be compared joint by joint.
    ///
    /// # Errors
    /// [`concio::Error::Input`] with the line; a wall that cannot be laid.
    pub fn check_joints<'a>(&self, file: &StudyFile, cases: impl IntoIterator<Item = &'a Case>) -> Result<()> {
        let names = |case: &Case| -> Result<Vec<String>> {
            let wall = pattern::lay(case)?;
            let joints = graph::joints(&wall, case.load.beam != Beam::Free);
            Ok(joints.iter().map(|j| graph::name(&wall, j)).collect())
        };
        let mut cases = cases.into_iter();
        let Some(first) = cases.next() else { return Ok(()) };
        let loose = |case: &Case| case.load.beam == Beam::Free;
        let others = cases.filter(|case| case.panels != first.panels || loose(case) != loose(first));
        let mut known: Option<Vec<String>> = None;
        for case in others {
            let of_first = match known.take() {
                Some(names) => names,
                None => names(first)?,
            };
            if names(case)? != of_first {
                let what = "the runs have walls of different joints, which cannot be ranked together";
                return Err(file.wrong("ranking", what, "factors that leave blocks and the kind of beam as they are"));
            }
            known = Some(of_first);
        }
        Ok(())
    }
}

/// Whether a joint of the study's wall is bonded, or a factor may make it so.
fn may_crack(file: &StudyFile) -> bool {
    let joint = &file.wall.case.joint;
    let bonds = |path: &str| path.split(['.', '[']).any(|step| step == "bond") && path.starts_with("joint");
    let sets = |vary: &Vary| {
        let chosen = vary.choices.iter().flat_map(|c| &c.set);
        vary.path.iter().any(|path| bonds(path) || path == "joint")
            || chosen.into_iter().any(|(path, value)| bonds(path) || path.starts_with("joint") && has_bond(value))
    };
    joint.bond.is_some() || joint.changes.iter().any(|c| c.bond.is_some()) || file.study.factors.iter().any(sets)
}

/// Whether a value has a table `bond` somewhere.
fn has_bond(value: &Value) -> bool {
    match value {
        Value::Object(map) => map.iter().any(|(key, value)| key == "bond" || has_bond(value)),
        Value::Array(list) => list.iter().any(has_bond),
        _ => false,
    }
}

/// Joints in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranks {
    /// By what.
    pub by: PerJoint,
    /// Per joint, the mean of its ratios, 0 … 1.
    pub ratio: Vec<f64>,
    /// Per joint, its largest value in any run, in SI.
    pub largest: Vec<f64>,
    /// Joints, the most critical first; equal ones in the order of the wall.
    pub order: Vec<usize>,
    /// Mean rank correlation (Spearman) between the runs, −1 … 1: how far one run tells the order in another. None for
    /// a single run.
    pub agreement: Option<f64>,
    /// Runs that were taken: those in which some joint has a value above 0.
    pub runs: usize,
}

/// Ranks the joints of some runs of one wall. None when no run has these values, or they are of different walls.
pub fn ranks(rows: &[&Row], by: PerJoint) -> Option<Ranks> {
    let values: Vec<Vec<f64>> = rows
        .iter()
        .filter_map(|row| row.joints.get(&by))
        .map(|joints| joints.iter().map(|v| v.unwrap_or(0.0)).collect())
        .collect();
    let joints = values.first()?.len();
    if values.iter().any(|v| v.len() != joints) {
        return None;
    }
    let largest_of = |run: &Vec<f64>| run.iter().fold(0.0f64, |m, v| m.max(*v));
    let runs: Vec<(&Vec<f64>, f64)> =
        values.iter().map(|v| (v, largest_of(v))).filter(|(_, most)| *most > 0.0).collect();
    let mean = |e: usize| match runs.len() {
        0 => 0.0,
        n => runs.iter().map(|(run, most)| run[e] / most).sum::<f64>() / n as f64,
    };
    let ratio: Vec<f64> = (0..joints).map(mean).collect();
    let largest = (0..joints).map(|e| values.iter().fold(0.0f64, |m, run| m.max(run[e]))).collect();
    let mut order: Vec<usize> = (0..joints).collect();
    order.sort_by(|&a, &b| ratio[b].total_cmp(&ratio[a]));
    let mut pairs = Vec::new();
    for (i, (a, _)) in runs.iter().enumerate() {
        pairs.extend(runs[..i].iter().filter_map(|(b, _)| spearman(a, b)));
    }
    let agreement = (!pairs.is_empty()).then(|| pairs.iter().sum::<f64>() / pairs.len() as f64);
    Some(Ranks { by, ratio, largest, order, agreement, runs: runs.len() })
}

/// Spearman's rank correlation, equal values with the mean of their ranks; none where one side is all equal.
pub fn spearman(a: &[f64], b: &[f64]) -> Option<f64> {
    let (a, b) = (midranks(a), midranks(b));
    let mean = (a.len() as f64 + 1.0) / 2.0;
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - mean) * (y - mean)).sum::<f64>();
    let [of_a, of_b] = [product(&a, &a), product(&b, &b)];
    (of_a > 0.0 && of_b > 0.0).then(|| product(&a, &b) / (of_a * of_b).sqrt())
}

/// One line per joint, in the order of the first ranking.
pub fn table(ranks: &[Ranks], names: &[String]) -> Table {
    let mut table = Table::default();
    let Some(first) = ranks.first() else { return table };
    table.texts("joint", first.order.iter().map(|&e| names.get(e).cloned()).collect());
    for rank in ranks {
        let mut place = vec![0usize; rank.order.len()];
        rank.order.iter().enumerate().for_each(|(i, &e)| place[e] = i + 1);
        let name = name(rank.by);
        table.numbers(format!("rank by {name}"), "", first.order.iter().map(|&e| Some(place[e] as f64)).collect());
        table.numbers(format!("mean ratio of {name}"), "", first.order.iter().map(|&e| Some(rank.ratio[e])).collect());
        let largest = first.order.iter().map(|&e| Some(rank.largest[e])).collect();
        table.numbers(format!("largest {name}"), rank.by.unit(), largest);
    }
    table
}

/// What it is called in texts and headings.
pub fn name(by: PerJoint) -> &'static str {
    match by {
        PerJoint::Displacement => "relative displacement",
        PerJoint::Velocity => "relative velocity",
        PerJoint::Acceleration => "relative acceleration",
        PerJoint::Slip => "slip",
        PerJoint::Opening => "opening",
        PerJoint::Force => "elastic force",
        PerJoint::Dissipation => "dissipated energy",
        PerJoint::Cracked => "time of the first crack",
        PerJoint::Damage => "damage",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(values: &[f64]) -> Row {
        let mut row = Row::failed("", "");
        row.joints.insert(PerJoint::Acceleration, values.iter().map(|v| Some(*v)).collect());
        row
    }

    #[test]
    fn ratios_are_means_over_runs_of_shares_in_the_largest() {
        // A weak run and one a hundred times as strong: both count alike.
        let rows = [row(&[1.0, 4.0, 2.0, 0.0]), row(&[400.0, 100.0, 300.0, 0.0])];
        let ranks = ranks(&rows.iter().collect::<Vec<_>>(), PerJoint::Acceleration);
        let ranks = ranks.unwrap_or_else(|| panic!("no ranks"));
        assert_eq!(ranks.ratio, [0.625, 0.625, 0.625, 0.0]);
        assert_eq!(ranks.order, [0, 1, 2, 3]);
        assert_eq!((ranks.largest, ranks.runs), (vec![400.0, 100.0, 300.0, 0.0], 2));
        // Ranks 2 4 3 1 and 4 2 3 1: 1 − 6·8/(4·15) = 0.2.
        assert!((ranks.agreement.unwrap_or(0.0) - 0.2).abs() < 1e-12);
    }

    #[test]
    fn runs_without_values_or_of_another_wall() {
        let by = PerJoint::Acceleration;
        assert_eq!(ranks(&[], by), None);
        assert_eq!(ranks(&[&row(&[1.0]), &row(&[1.0, 2.0])], by), None);
        assert_eq!(ranks(&[&row(&[1.0])], PerJoint::Slip), None);
        let still = ranks(&[&row(&[0.0, 0.0])], by);
        assert_eq!(still.map(|r| (r.runs, r.agreement, r.ratio)), Some((0, None, vec![0.0, 0.0])));
    }

    #[test]
    fn rank_correlation() {
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[10.0, 20.0, 90.0]), Some(1.0));
        assert_eq!(spearman(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]), Some(-1.0));
        assert_eq!(spearman(&[1.0, 1.0], &[3.0, 2.0]), None);
        // Two equal values share rank 0.5: 1.5/√(2 · 1.5) = √3/2.
        assert!((spearman(&[1.0, 1.0, 3.0], &[1.0, 2.0, 3.0]).unwrap_or(0.0) - 0.75f64.sqrt()).abs() < 1e-12);
    }
}
