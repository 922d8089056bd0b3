//! Sets of joints, and the moves from one to another.

use std::collections::BTreeSet;

use concio::dice::Dice;

/// Places of the joints of a set in a list of eligible ones, rising.
pub type Set = Vec<usize>;

/// Share of children that mix two parents instead of changing one.
const MIXED: f64 = 0.25;
/// Bounds of the three moves of a set on a scale from 0 to 1: joints are exchanged up to the first, exchanged for a
/// neighbour up to the second, added up to the third, dropped above it.
const MOVES: [f64; 3] = [0.4, 0.65, 0.85];
/// Chance that another move follows.
const ANOTHER: f64 = 0.4;

/// Where devices may go.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    /// Most joints of a set, from 1 to the number of eligible joints.
    pub most: usize,
    /// Per eligible joint, those that share a block with it.
    pub neighbours: Vec<Set>,
    /// Per eligible joint, how often it is drawn beside the others, from 0; half of the draws pass over it.
    pub weights: Vec<f64>,
}

impl Places {
    /// Number of eligible joints.
    pub fn eligible(&self) -> usize {
        self.neighbours.len()
    }

    /// `size` joints, all sets alike.
    pub fn random(&self, size: usize, dice: &mut Dice) -> Set {
        let mut all: Vec<usize> = (0..self.eligible()).collect();
        dice.shuffle(&mut all);
        all.truncate(size);
        all.sort_unstable();
        all
    }

    /// A set near one of the parents, or between two of them; never empty, never above [`Places::most`].
    pub fn child(&self, parents: &[&Set], dice: &mut Dice) -> Set {
        // Better parents come first and are taken more often.
        let one = |dice: &mut Dice| parents[(parents.len() as f64 * dice.unit().powi(2)) as usize];
        let first = one(dice);
        if parents.len() > 1 && dice.unit() < MIXED {
            let mixed = self.mixed(first, one(dice), dice);
            if mixed != *first {
                return mixed;
            }
        }
        let mut set: BTreeSet<usize> = first.iter().copied().collect();
        loop {
            self.step(&mut set, dice);
            if dice.unit() >= ANOTHER {
                return set.into_iter().collect();
            }
        }
    }

    /// What both have, and each of the others with a chance of one half.
    fn mixed(&self, a: &Set, b: &Set, dice: &mut Dice) -> Set {
        let [a, b]: [BTreeSet<usize>; 2] = [a, b].map(|s| s.iter().copied().collect());
        let mut kept: Vec<usize> = a.intersection(&b).copied().collect();
        let mut others: Vec<usize> = a.symmetric_difference(&b).copied().collect();
        dice.shuffle(&mut others);
        let size = if dice.unit() < 0.5 { a.len() } else { b.len() };
        kept.extend(others.into_iter().take(size.saturating_sub(kept.len())));
        kept.sort_unstable();
        kept
    }

    /// One move.
    fn step(&self, set: &mut BTreeSet<usize>, dice: &mut Dice) {
        let kind = dice.unit();
        let free = self.eligible() - set.len();
        if kind >= MOVES[2] && set.len() > 1 {
            let out = any(set, dice);
            set.remove(&out);
        } else if kind >= MOVES[1] && set.len() < self.most && free > 0 {
            set.extend(self.drawn(set, dice));
        } else if free > 0 {
            let out = any(set, dice);
            let near: Vec<usize> = self.neighbours[out].iter().copied().filter(|e| !set.contains(e)).collect();
            let into = match kind {
                k if (MOVES[0]..MOVES[1]).contains(&k) && !near.is_empty() => Some(near[dice.below(near.len())]),
                _ => self.drawn(set, dice),
            };
            if let Some(into) = into {
                set.remove(&out);
                set.insert(into);
            }
        }
    }

    /// A joint that is not in the set: any, or by weight.
    fn drawn(&self, set: &BTreeSet<usize>, dice: &mut Dice) -> Option<usize> {
        let free: Vec<usize> = (0..self.eligible()).filter(|e| !set.contains(e)).collect();
        let total: f64 = free.iter().map(|&e| self.weights[e]).sum();
        if total > 0.0 && dice.unit() < 0.5 {
            let mut left = dice.unit() * total;
            let at = free.iter().find(|&&e| {
                left -= self.weights[e];
                left < 0.0
            });
            return at.or(free.last()).copied();
        }
        free.get(dice.below(free.len())).copied()
    }
}

fn any(set: &BTreeSet<usize>, dice: &mut Dice) -> usize {
    set.iter().copied().nth(dice.below(set.len())).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn children_are_sets_within_bounds(seed in 0u64..1000, eligible in 1usize..12, most in 1usize..12) {
            let most = most.min(eligible);
            let neighbours = (0..eligible).map(|e| (0..eligible).filter(|f| e.abs_diff(*f) == 1).collect()).collect();
            let places = Places { most, neighbours, weights: vec![1.0; eligible] };
            let mut dice = Dice::new(seed);
            let mut parents = [places.random(most, &mut dice), places.random(1, &mut dice)];
            for _ in 0..30 {
                let child = places.child(&parents.iter().collect::<Vec<_>>(), &mut dice);
                prop_assert!((1..=most).contains(&child.len()), "{child:?}");
                prop_assert!(child.windows(2).all(|w| w[0] < w[1]) && child.iter().all(|e| *e < eligible), "{child:?}");
                parents.rotate_right(1);
                parents[0] = child;
            }
        }
    }

    /// From any set to any other of the same bounds: every joint, every size is reached.
    #[test]
    fn every_set_is_reached() {
        let places = Places { most: 3, neighbours: vec![vec![]; 5], weights: vec![0.0; 5] };
        let (mut dice, mut set, mut seen) = (Dice::new(1), vec![0], BTreeSet::new());
        for _ in 0..3000 {
            set = places.child(&[&set], &mut dice);
            seen.insert(set.clone());
        }
        // 5 of one joint, 10 of two, 10 of three.
        assert_eq!(seen.len(), 25);
    }
}
