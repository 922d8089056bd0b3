//! Which columns of a factor are eliminated as one, and which rows they have.
//!
//! Elimination tree after J. W. H. Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134. Columns of the same rows, and joining
//! those of almost the same rows, after C. Ashcraft and R. Grimes, ACM Trans. Math. Software 15 (1989) 291.

use std::ops::Range;

/// Groups are joined as long as they have at most so many columns and at most this part of zeros.
const JOINED: [(usize, f64); 3] = [(4, 1.0), (16, 0.4), (48, 0.05)];
/// The same where memory counts more, beyond so many unknowns.
const JOINED_LARGE: [(usize, f64); 3] = [(4, 1.0), (16, 0.2), (48, 0.05)];
const LARGE: usize = 20_000;
/// Columns of a group with all groups below it up to which they are one.
const COLLAPSED: u32 = 16;
const COLLAPSED_LARGE: u32 = 8;

const NONE: u32 = u32::MAX;

/// Groups of columns.
pub struct Pattern {
    /// The columns of each group, in order.
    pub groups: Vec<Range<u32>>,
    /// Where the rows below each group start in `rows`, and where the last ones end.
    pub start: Vec<usize>,
    /// Rows below the columns of each group, ascending.
    pub rows: Vec<u32>,
    /// The group of every column.
    pub group_of: Vec<u32>,
}

impl Pattern {
    /// Of the factor of a matrix of order `n` with entries below the diagonal at `entries` (row, column), rows and
    /// columns numbered in postorder.
    pub fn new(n: usize, entries: &[(u32, u32)]) -> Self {
        let lower = Lower::new(n, entries);
        let tree = Tree::new(&lower);
        let (limits, most) = if n > LARGE { (&JOINED_LARGE, COLLAPSED_LARGE) } else { (&JOINED, COLLAPSED) };
        let groups = collapsed(&joined(&tree, limits), &tree, most);
        let mut group_of = vec![0; n];
        let mut start = vec![0];
        for (g, group) in (0..).zip(&groups) {
            group_of[group.start as usize..group.end as usize].fill(g);
            start.push(start[g as usize] + tree.height[group.end as usize - 1] as usize);
        }
        let mut pattern = Pattern { rows: vec![0; start[groups.len()]], groups, start, group_of };
        pattern.fill(&lower, &tree);
        pattern
    }

    /// Finds the rows: an entry of A reaches the group of its column and all above that, up to the group of its row.
    fn fill(&mut self, lower: &Lower, tree: &Tree) {
        let above = |group: &Range<u32>| tree.parent[group.end as usize - 1];
        let above: Vec<u32> = self.groups.iter().map(above).collect();
        let mut next = self.start.clone();
        let mut reached = vec![NONE; above.len()];
        for r in 0..self.group_of.len() {
            reached[self.group_of[r] as usize] = r as u32;
            for &c in lower.row(r) {
                let mut g = self.group_of[c as usize] as usize;
                while reached[g] != r as u32 {
                    reached[g] = r as u32;
                    self.rows[next[g]] = r as u32;
                    next[g] += 1;
                    g = self.group_of[above[g] as usize] as usize;
                }
            }
        }
    }
}

/// Columns of the entries below the diagonal, row by row.
struct Lower {
    start: Vec<usize>,
    columns: Vec<u32>,
}

impl Lower {
    fn new(n: usize, entries: &[(u32, u32)]) -> Self {
        let mut start = vec![0; n + 1];
        for &(r, _) in entries {
            start[r as usize + 1] += 1;
        }
        for k in 0..n {
            start[k + 1] += start[k];
        }
        let mut next = start.clone();
        let mut columns = vec![0; entries.len()];
        for &(r, c) in entries {
            columns[next[r as usize]] = c;
            next[r as usize] += 1;
        }
        Lower { start, columns }
    }

    fn row(&self, r: usize) -> &[u32] {
        &self.columns[self.start[r]..self.start[r + 1]]
    }
}

/// The elimination tree.
struct Tree {
    /// The first row below the diagonal in each column of the factor.
    parent: Vec<u32>,
    /// How many rows each column has below the diagonal.
    height: Vec<u32>,
    /// The first column of those that hang together below each, itself included: they are numbered without a gap.
    first: Vec<u32>,
    /// How many columns hang right below each.
    children: Vec<u32>,
}

impl Tree {
    fn new(lower: &Lower) -> Self {
        let n = lower.start.len() - 1;
        let (mut parent, mut height, mut reached) = (vec![NONE; n], vec![0; n], vec![NONE; n]);
        for r in 0..n {
            reached[r] = r as u32;
            for &c in lower.row(r) {
                let mut k = c as usize;
                while reached[k] != r as u32 {
                    reached[k] = r as u32;
                    height[k] += 1;
                    if parent[k] == NONE {
                        parent[k] = r as u32;
                    }
                    k = parent[k] as usize;
                }
            }
        }
        let (mut first, mut children): (Vec<u32>, _) = ((0..n as u32).collect(), vec![0; n]);
        for k in (0..n).filter(|&k| parent[k] != NONE) {
            let above = parent[k] as usize;
            first[above] = first[above].min(first[k]);
            children[above] += 1;
        }
        Tree { parent, height, first, children }
    }

    /// Runs of columns with the same rows, each the only one below the next.
    fn alike(&self) -> Vec<Range<u32>> {
        let (parent, height) = (&self.parent, &self.height);
        let continues = |k: usize| parent[k - 1] == k as u32 && self.children[k] == 1 && height[k - 1] == height[k] + 1;
        let n = parent.len();
        let begins: Vec<u32> = (0..n).filter(|&k| k == 0 || !continues(k)).map(|k| k as u32).collect();
        let ends = begins.iter().skip(1).copied().chain([n as u32]);
        begins.iter().zip(ends).map(|(&begin, end)| begin..end).collect()
    }
}

/// Groups of columns with almost the same rows: each run of the same rows takes in the group before it, if that hangs
/// below it and `limits` allow the zeros.
fn joined(tree: &Tree, limits: &[(usize, f64)]) -> Vec<Range<u32>> {
    let mut groups: Vec<Range<u32>> = Vec::new();
    let mut zeros = 0;
    for run in tree.alike() {
        let under = groups.last_mut().filter(|g| run.contains(&tree.parent[g.end as usize - 1]));
        match under.and_then(|g| Some((zeros_of(tree, g, zeros, &run, limits)?, g))) {
            Some((all, group)) => (zeros, group.end) = (all, run.end),
            None => {
                zeros = 0;
                groups.push(run);
            }
        }
    }
    groups
}

/// How many zeros a group that has `old` ones would hold together with the `run` above it; none where `limits` forbid
/// it.
fn zeros_of(tree: &Tree, group: &Range<u32>, old: usize, run: &Range<u32>, limits: &[(usize, f64)]) -> Option<usize> {
    let [lower, upper] = [group, run].map(|columns| tree.height[columns.end as usize - 1] as usize);
    let new = group.len() * (run.len() + upper - lower);
    let (zeros, width) = (old + new, group.len() + run.len());
    let entries = width * (width + 1) / 2 + width * upper;
    let allowed = |&(most, part): &(usize, f64)| width <= most && zeros as f64 <= entries as f64 * part;
    (new == 0 || limits.iter().any(allowed)).then_some(zeros)
}

/// The groups as they are eliminated. Those that hang together below one are taken into it as long as they have at most
/// `most` columns in all: a front costs more than a few columns of zeros.
fn collapsed(groups: &[Range<u32>], tree: &Tree, most: u32) -> Vec<Range<u32>> {
    let mut kept: Vec<Range<u32>> = Vec::new();
    for group in groups {
        let first = tree.first[group.end as usize - 1];
        let from = if group.end - first <= most { first } else { group.start };
        while kept.last().is_some_and(|k| k.start >= from) {
            kept.pop();
        }
        kept.push(from..group.end);
    }
    kept
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::integrate::order::{elimination_order, postordered};

    /// Entries below the diagonal in the order of elimination.
    fn ordered(n: usize, pairs: &[(usize, usize)]) -> Vec<(u32, u32)> {
        let mut places = elimination_order(n, pairs, &[]);
        let of = |&(i, j): &(usize, usize)| (places[i].max(places[j]), places[i].min(places[j]));
        let mut entries: Vec<_> = pairs.iter().map(of).collect();
        postordered(&mut places, &mut entries);
        entries
    }

    /// Rows below the diagonal of every column of the factor: eliminating a column joins all its rows.
    fn eliminated(n: usize, entries: &[(u32, u32)]) -> Vec<BTreeSet<u32>> {
        let mut columns = vec![BTreeSet::new(); n];
        for &(r, c) in entries {
            columns[c as usize].insert(r);
        }
        for k in 0..n {
            let rows: Vec<u32> = columns[k].iter().copied().collect();
            for (at, &r) in rows.iter().enumerate() {
                columns[r as usize].extend(&rows[at + 1..]);
            }
        }
        columns
    }

    /// Whether the first columns of a group, with the zeros that they hold, obey `limits`, and all others have the same
    /// rows as the last of these: they bring no zeros.
    fn obeys(group: &Range<u32>, columns: &[BTreeSet<u32>], limits: &[(usize, f64)]) -> bool {
        let height = |k: usize| columns[k].len();
        let (begin, mut last) = (group.start as usize, group.end as usize - 1);
        let within = |last: usize| {
            let zeros: usize = (begin..last).map(|k| last - k + height(last) - height(k)).sum();
            let width = last + 1 - begin;
            let all = (width * (width + 1) / 2 + width * height(last)) as f64;
            zeros == 0 || limits.iter().any(|&(most, part)| width <= most && zeros as f64 <= part * all)
        };
        while !within(last) && height(last - 1) == height(last) + 1 {
            last -= 1;
        }
        within(last)
    }

    proptest! {
        /// Groups hold every column once and have all rows of their columns, none beyond them.
        #[test]
        fn patterns_are_those_of_plain_elimination(
            n in 1usize..60,
            drawn in prop::collection::vec((0usize..60, 0usize..60), 0..160),
        ) {
            let pairs: Vec<_> = drawn.iter().map(|&(i, j)| (i % n, j % n)).filter(|(i, j)| i != j).collect();
            let entries = ordered(n, &pairs);
            let columns = eliminated(n, &entries);
            let tree = Tree::new(&Lower::new(n, &entries));
            for limits in [&JOINED, &JOINED_LARGE] {
                let groups = joined(&tree, limits);
                prop_assert!(groups.iter().all(|g| obeys(g, &columns, limits)), "{groups:?} of {columns:?}");
            }
            let pattern = Pattern::new(n, &entries);
            prop_assert!(pattern.groups.iter().cloned().flatten().eq(0..n as u32), "{:?}", pattern.groups);
            let before = joined(&tree, &JOINED);
            for (g, group) in pattern.groups.iter().enumerate() {
                prop_assert!(before.contains(group) || group.len() <= COLLAPSED as usize);
                prop_assert!(group.clone().all(|k| pattern.group_of[k as usize] == g as u32));
                let rows = &pattern.rows[pattern.start[g]..pattern.start[g + 1]];
                let theirs = group.clone().flat_map(|k| columns[k as usize].iter().copied());
                let below: BTreeSet<u32> = theirs.filter(|r| *r >= group.end).collect();
                prop_assert!(rows.iter().eq(&below), "{rows:?} for {below:?}");
            }
        }
    }

    /// Twenty unknowns in a row, by hand. Five columns would hold 10 zeros in 20 places, where 8 are allowed; four hold 6
    /// in 14. Sixteen are one group because they are all that hangs below the last of them.
    #[test]
    fn a_row_is_grouped_by_fours_and_sixteen() {
        let entries: Vec<(u32, u32)> = (0..19).map(|c| (c + 1, c)).collect();
        let tree = Tree::new(&Lower::new(20, &entries));
        assert_eq!(joined(&tree, &JOINED), [0..4, 4..8, 8..12, 12..16, 16..20]);
        let pattern = Pattern::new(20, &entries);
        assert_eq!(pattern.groups, [0..16, 16..20]);
        assert_eq!((pattern.rows, pattern.start), (vec![16], vec![0, 1, 1]));
    }
}
