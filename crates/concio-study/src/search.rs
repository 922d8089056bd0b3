//! The search for placement and parameters of devices: sets of joints change by moves ([`crate::placement`]), parameters
//! by CMA-ES ([`crate::cma`]), both in one generation, which is asked for as a whole.
//!
//! Every alternative device has a strand of its own: an archive of its best designs, the parents of the next, and a
//! distribution of its parameters. From half of the budget on, only strands that hold a design of the common front go on;
//! in its last quarter sets stay, and parameters are searched anew around the best.
//! Nothing but the seed is random.

use concio::Result;
use concio::dice::Dice;

use crate::cma::{Cma, folded};
use crate::pareto;
use crate::placement::{Places, Set};

/// Deviation of the parameters at first, their ranges being 0 … 1.
const WIDTH: f64 = 0.3;
/// The same when sets stay, and where designs with tuned parameters are known.
const NARROW: f64 = 0.1;
/// Designs of an archive that may have the same set of joints: the others leave room for other sets.
const SAME_SET: usize = 2;
/// Attempts at a child that is not in the generation yet, where a device has no parameters.
const ATTEMPTS: usize = 20;

/// A proposal.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// Place in the list of devices.
    pub device: usize,
    /// Joints that have it, as places among the eligible ones.
    pub joints: Set,
    /// Its parameters within their ranges, each 0 … 1.
    pub shares: Vec<f64>,
}

/// A design and its objectives, all to be small; infinite where a run failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// The design.
    pub design: Design,
    /// Its objectives.
    pub values: Vec<f64>,
}

/// What is searched.
#[derive(Debug, Clone)]
pub struct Quest<'q> {
    /// Where devices may go.
    pub places: &'q Places,
    /// Per device, the number of its parameters.
    pub parameters: &'q [usize],
    /// Sets to start from.
    pub starts: &'q [Set],
    /// Designs to start from, besides.
    pub known: &'q [Design],
    /// Whether sets stay as they are: only parameters are searched, for the first of the starts.
    pub fixed: bool,
    /// Evaluations at most; one generation is always done.
    pub evaluations: usize,
    /// Designs of a generation of each strand, from 4.
    pub population: usize,
    /// Seed.
    pub seed: u64,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The best design; of several objectives those that none of the others dominates.
    pub front: Vec<Member>,
    /// The best of all strands, from the best; the front comes first.
    pub best: Vec<Member>,
    /// After every generation: evaluations so far, and the best value of each objective.
    pub trace: Vec<(usize, Vec<f64>)>,
}

/// Objectives of some designs, in their order; none where the user stopped.
pub type Evaluate<'e> = dyn FnMut(&[Design]) -> Result<Option<Vec<Vec<f64>>>> + 'e;

/// Searches. None when the evaluation was stopped.
///
/// # Errors
/// Those of the evaluation.
pub fn search(quest: &Quest, evaluate: &mut Evaluate) -> Result<Option<Found>> {
    let devices = 0..quest.parameters.len();
    let mut strands: Vec<Strand> = devices.map(|device| Strand::new(quest, device)).collect();
    let (mut done, mut trace) = (0, Vec::new());
    let mut best: Vec<f64> = Vec::new();
    let (mut halved, mut settled) = (false, false);
    loop {
        let mut asked: Vec<Vec<Design>> = strands.iter_mut().map(|s| s.ask(quest)).collect();
        let size: usize = asked.iter().map(Vec::len).sum();
        if done > 0 && done + size > quest.evaluations {
            break;
        }
        let all: Vec<Design> = asked.iter().flatten().cloned().collect();
        let Some(values) = evaluate(&all)? else { return Ok(None) };
        done += size;
        let mut values = values.into_iter();
        for (strand, designs) in strands.iter_mut().zip(asked.drain(..)) {
            let of = values.by_ref().take(designs.len()).collect();
            strand.tell(quest, designs, of);
        }
        let ends = strands.iter().flat_map(|s| &s.archive).map(|m| &m.values);
        best = ends.fold(best, |best, v| match best.is_empty() {
            true => v.clone(),
            false => best.iter().zip(v).map(|(a, b)| a.min(*b)).collect(),
        });
        trace.push((done, best.clone()));
        if !halved && 2 * done >= quest.evaluations {
            halved = true;
            let front = front(&strands);
            strands.retain(|s| front.iter().any(|m| m.design.device == s.device));
        }
        if !settled && !quest.fixed && 4 * done >= 3 * quest.evaluations {
            settled = true;
            strands.iter_mut().for_each(|s| s.settle(quest));
        }
        if quest.fixed && strands.iter().all(|s| s.cma.is_none()) {
            // Nothing is left to vary.
            break;
        }
    }
    let front = front(&strands);
    let mut members: Vec<Member> = strands.into_iter().flat_map(|s| s.archive).collect();
    let order = pareto::order(&members.iter().map(|m| m.values.clone()).collect::<Vec<_>>());
    members = order.into_iter().map(|k| members[k].clone()).collect();
    Ok(Some(Found { front, best: members, trace }))
}

/// Those of all archives that none dominates.
fn front(strands: &[Strand]) -> Vec<Member> {
    let all: Vec<&Member> = strands.iter().flat_map(|s| &s.archive).collect();
    let values: Vec<Vec<f64>> = all.iter().map(|m| m.values.clone()).collect();
    pareto::front(&values).into_iter().map(|k| all[k].clone()).collect()
}

/// The search of one device.
struct Strand {
    device: usize,
    archive: Vec<Member>,
    cma: Option<Cma>,
    dice: Dice,
    asked: Vec<Vec<f64>>,
    first: bool,
    settled: bool,
}

impl Strand {
    fn new(quest: &Quest, device: usize) -> Self {
        let parameters = quest.parameters[device];
        // Strands draw from seeds of their own, so that one more device does not change what the others do.
        let seed = quest.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(device as u64);
        let known = quest.known.iter().find(|d| d.device == device);
        let middle = known.map_or(vec![0.5; parameters], |d| d.shares.clone());
        let width = if known.is_some() { NARROW } else { WIDTH };
        let cma = (parameters > 0).then(|| Cma::new(&middle, width, quest.population, seed ^ 1));
        Strand {
            device,
            archive: Vec::new(),
            cma,
            dice: Dice::new(seed),
            asked: Vec::new(),
            first: true,
            settled: false,
        }
    }

    /// From here on sets stay: parameters are searched around those of the best design.
    fn settle(&mut self, quest: &Quest) {
        let Some(best) = self.archive.first() else { return };
        if self.cma.is_some() {
            let seed = self.dice.below(usize::MAX) as u64;
            self.cma = Some(Cma::new(&best.design.shares, NARROW, quest.population, seed));
            self.settled = true;
        }
    }

    fn ask(&mut self, quest: &Quest) -> Vec<Design> {
        self.asked = match &mut self.cma {
            Some(cma) => cma.ask(),
            // The one design that there is was asked for in the first generation.
            None if quest.fixed => vec![Vec::new(); usize::from(self.first)],
            None => vec![Vec::new(); quest.population.max(4)],
        };
        let mut designs: Vec<Design> = Vec::new();
        for k in 0..self.asked.len() {
            let shares: Vec<f64> = self.asked[k].iter().map(|x| folded(*x)).collect();
            let mut joints = self.joints(quest, k);
            for _ in 0..ATTEMPTS {
                let known = |j: &Set| {
                    designs.iter().any(|d| d.joints == *j) || self.archive.iter().any(|m| m.design.joints == *j)
                };
                if quest.fixed || self.cma.is_some() || !known(&joints) {
                    break;
                }
                joints = self.joints(quest, k);
            }
            designs.push(Design { device: self.device, joints, shares });
        }
        if self.first {
            self.first = false;
            designs.extend(quest.known.iter().filter(|d| d.device == self.device).cloned());
        }
        designs
    }

    /// The set of the k-th design of a generation.
    fn joints(&mut self, quest: &Quest, k: usize) -> Set {
        if quest.fixed {
            return quest.starts.first().cloned().unwrap_or_default();
        }
        if self.archive.is_empty() {
            let start = quest.starts.get(k).cloned();
            return start.unwrap_or_else(|| quest.places.random(quest.places.most, &mut self.dice));
        }
        if self.settled {
            // Of several objectives every design of the archive is worth it.
            let several = self.archive[0].values.len() > 1;
            let of = if several { self.dice.below(self.archive.len()) } else { 0 };
            return self.archive[of].design.joints.clone();
        }
        let parents: Vec<&Set> = self.archive.iter().map(|m| &m.design.joints).collect();
        quest.places.child(&parents, &mut self.dice)
    }

    fn tell(&mut self, quest: &Quest, designs: Vec<Design>, values: Vec<Vec<f64>>) {
        let drawn = self.asked.len();
        if let Some(cma) = &mut self.cma {
            let order = pareto::order(&values[..drawn]);
            cma.tell(&order.into_iter().map(|k| self.asked[k].clone()).collect::<Vec<_>>());
        }
        let new = designs.into_iter().zip(values).map(|(design, values)| Member { design, values });
        let all: Vec<Member> = self.archive.drain(..).chain(new).collect();
        let order = pareto::order(&all.iter().map(|m| m.values.clone()).collect::<Vec<_>>());
        // A front needs room for its designs.
        let most = if all[0].values.len() > 1 { drawn.max(2) } else { (drawn / 2).max(2) };
        let alike = if quest.fixed || self.settled { most } else { SAME_SET };
        for k in order {
            let same = self.archive.iter().filter(|m| m.design.joints == all[k].design.joints).count();
            let known = self.archive.iter().any(|m| m.design == all[k].design);
            if !known && same < alike && self.archive.len() < most {
                self.archive.push(all[k].clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eighteen joints in a row, of which {2, 7, 11, 16} is the best set: every one of them brings 1, every other costs
    /// 0.3, and the parameter is best at 0.8 for one device and at 0.2, where it is worse, for the other.
    const BEST: [usize; 4] = [2, 7, 11, 16];

    fn toy(design: &Design) -> f64 {
        let good = design.joints.iter().filter(|j| BEST.contains(j)).count() as f64;
        let bad = design.joints.len() as f64 - good;
        let (at, price) = [(0.8, 0.0), (0.2, 0.5)][design.device];
        (design.shares[0] - at).powi(2) + price - good + 0.3 * bad
    }

    fn places() -> Places {
        let near = |e: usize| (0..18).filter(|f: &usize| e.abs_diff(*f) == 1).collect();
        Places { most: 5, neighbours: (0..18).map(near).collect(), weights: vec![1.0; 18] }
    }

    fn found(quest: &Quest, evaluate: &mut Evaluate) -> Found {
        match search(quest, evaluate) {
            Ok(Some(found)) => found,
            other => panic!("{other:?}"),
        }
    }

    fn quest<'q>(places: &'q Places, seed: u64) -> Quest<'q> {
        let (parameters, evaluations) = (&[1, 1], 2000);
        Quest { places, parameters, starts: &[], known: &[], fixed: false, evaluations, population: 12, seed }
    }

    #[test]
    fn the_best_set_and_parameter_are_found() {
        let places = places();
        for seed in 1..=10 {
            let mut count = 0;
            let mut evaluate = |designs: &[Design]| {
                count += designs.len();
                Ok(Some(designs.iter().map(|d| vec![toy(d)]).collect()))
            };
            let found = found(&quest(&places, seed), &mut evaluate);
            let best = &found.front[0];
            assert_eq!((best.design.device, &best.design.joints[..]), (0, &BEST[..]), "seed {seed}");
            assert!((best.design.shares[0] - 0.8).abs() < 1e-3, "seed {seed}: {:?}", best.design.shares);
            assert!(count <= 2000 && found.trace.last().is_some_and(|t| t.0 == count), "{count}");
            assert!(found.trace.windows(2).all(|w| w[1].1[0] <= w[0].1[0]));
        }
    }

    #[test]
    fn two_objectives_give_a_front_between_their_best() {
        // Few joints against a small sum: the front has one design per number of joints.
        let places = places();
        let mut evaluate = |designs: &[Design]| {
            let of = |d: &Design| vec![d.joints.len() as f64, toy(&Design { device: 0, ..d.clone() })];
            Ok(Some(designs.iter().map(of).collect()))
        };
        let front = found(&quest(&places, 3), &mut evaluate).front;
        for (joints, least) in [(1.0, -1.0), (2.0, -2.0), (3.0, -3.0), (4.0, -4.0)] {
            let has = front.iter().any(|m| m.values[0] == joints && m.values[1] < least + 0.05);
            assert!(has, "{joints}: {:?}", front.iter().map(|m| &m.values).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_fixed_set_has_its_parameters_searched_alone() {
        let places = places();
        let starts = [vec![1, 2, 3]];
        let quest = Quest { fixed: true, starts: &starts, evaluations: 300, ..quest(&places, 1) };
        let mut evaluate = |designs: &[Design]| Ok(Some(designs.iter().map(|d| vec![toy(d)]).collect()));
        let best = found(&quest, &mut evaluate).front.remove(0);
        assert_eq!(best.design.joints, starts[0]);
        assert!((best.design.shares[0] - 0.8).abs() < 1e-3);
    }

    #[test]
    fn equal_seeds_give_equal_searches_and_a_stop_is_passed_on() {
        let places = places();
        let mut evaluate = |designs: &[Design]| Ok(Some(designs.iter().map(|d| vec![toy(d)]).collect()));
        let [a, b] = [(); 2].map(|()| found(&quest(&places, 5), &mut evaluate));
        assert_eq!(a, b);
        assert_ne!(a.trace, found(&quest(&places, 6), &mut evaluate).trace);
        assert!(matches!(search(&quest(&places, 5), &mut |_| Ok(None)), Ok(None)));
    }
}
