//! Where a part is cut in two.

use super::Scratch;
use super::graph::Graph;

/// Where cuts are looked for along each axis, as shares of what is cut.
const SHARES: [f64; 5] = [0.4, 0.45, 0.5, 0.55, 0.6];
/// How many times its share of the unknowns a cut may go through more of them for sides that are as much more even.
const EVEN: f64 = 0.5;

/// Two sides that are joined only through others.
pub struct Cut {
    pub sides: [Vec<u32>; 2],
    pub through: Vec<u32>,
}

impl Cut {
    fn cost(&self) -> f64 {
        let [one, other] = self.sides.each_ref().map(Vec::len);
        let all = one + other + self.through.len();
        self.through.len() as f64 * (1.0 + EVEN * one.abs_diff(other) as f64 / all as f64)
    }
}

/// The one through the fewest unknowns, more or less. None where each would leave a side empty.
pub fn best(graph: &Graph, at: &[[f64; 2]], set: &[u32], scratch: &mut Scratch) -> Option<Cut> {
    let mut best: Option<(f64, Cut)> = None;
    for axis in [0, 1] {
        let mut sorted = set.to_vec();
        sorted.sort_unstable_by(|&i, &j| at[i as usize][axis].total_cmp(&at[j as usize][axis]).then(i.cmp(&j)));
        for share in SHARES {
            let cut = between(graph, &sorted, (share * set.len() as f64) as usize, scratch);
            let cost = cut.cost();
            if cut.sides.iter().all(|side| !side.is_empty()) && best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, cut));
            }
        }
    }
    best.map(|(_, cut)| cut)
}

/// The first `count` of a set and the rest, through the fewest of both.
pub fn between(graph: &Graph, set: &[u32], count: usize, scratch: &mut Scratch) -> Cut {
    let mut touching = Touching::new(graph, set, count, scratch);
    for k in 0..count as u32 {
        touching.match_up(k);
    }
    let is_through = touching.cover();
    let of = |range: std::ops::Range<usize>, wanted: bool| {
        range.filter(|&k| is_through[k] == wanted).map(|k| set[k]).collect()
    };
    Cut { sides: [of(0..count, false), of(count..set.len(), false)], through: of(0..set.len(), true) }
}

const NONE: u32 = u32::MAX;

/// Which unknowns on the one side are joined to which on the other, by their numbers in the set, and who is matched with whom: as many as
/// can be, each once. As many cover all joints between the sides.
struct Touching {
    count: usize,
    /// Neighbours on the other side of those on the first.
    start: Vec<usize>,
    across: Vec<u32>,
    partner: Vec<u32>,
    /// Whom on the first side those on the other were found from, and in which search.
    from: Vec<u32>,
    found: Vec<u32>,
    search: u32,
    queue: Vec<u32>,
}

impl Touching {
    fn new(graph: &Graph, set: &[u32], count: usize, scratch: &mut Scratch) -> Self {
        let other = scratch.next();
        for (k, &i) in set.iter().enumerate().skip(count) {
            (scratch.mark[i as usize], scratch.local[i as usize]) = (other, k as u32);
        }
        let (mut start, mut across) = (vec![0], Vec::new());
        for &i in &set[..count] {
            let there = graph.of(i).iter().filter(|&&j| scratch.mark[j as usize] == other);
            across.extend(there.map(|&j| scratch.local[j as usize]));
            start.push(across.len());
        }
        let none = || vec![NONE; set.len()];
        Touching {
            count,
            start,
            across,
            partner: none(),
            from: none(),
            found: vec![0; set.len()],
            search: 0,
            queue: vec![],
        }
    }

    /// Finds a partner for one of the first side, if need be by others changing theirs: the shortest way (breadth first).
    fn match_up(&mut self, first: u32) {
        self.search += 1;
        self.queue.clear();
        self.queue.push(first);
        let mut next = 0;
        while let Some(&i) = self.queue.get(next) {
            next += 1;
            for k in self.start[i as usize]..self.start[i as usize + 1] {
                let j = self.across[k] as usize;
                if self.found[j] == self.search {
                    continue;
                }
                (self.found[j], self.from[j]) = (self.search, i);
                match self.partner[j] {
                    NONE => return self.exchange(j as u32),
                    other => self.queue.push(other),
                }
            }
        }
    }

    /// Those on the way to the one without a partner take the next each.
    fn exchange(&mut self, last: u32) {
        let mut j = last;
        while j != NONE {
            let i = self.from[j as usize];
            let before = std::mem::replace(&mut self.partner[i as usize], j);
            self.partner[j as usize] = i;
            j = before;
        }
    }

    /// The fewest that all joints between the sides end at.
    fn cover(&mut self) -> Vec<bool> {
        let mut reached = vec![false; self.partner.len()];
        let joined = |k: &u32| self.start[*k as usize] < self.start[*k as usize + 1];
        let mut queue: Vec<u32> =
            (0..self.count as u32).filter(|k| joined(k) && self.partner[*k as usize] == NONE).collect();
        queue.iter().for_each(|&i| reached[i as usize] = true);
        while let Some(i) = queue.pop() {
            for &j in &self.across[self.start[i as usize]..self.start[i as usize + 1]] {
                if std::mem::replace(&mut reached[j as usize], true) {
                    continue;
                }
                let other = self.partner[j as usize];
                if other != NONE && !std::mem::replace(&mut reached[other as usize], true) {
                    queue.push(other);
                }
            }
        }
        let through = |(k, reached): (usize, bool)| match k < self.count {
            true => self.partner[k] != NONE && !reached,
            false => reached,
        };
        reached.iter().copied().enumerate().map(through).collect()
    }
}
