//! Next comes whatever leaves the fewest neighbours to each other that were none before.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::graph::Graph;
use super::{Part, Scratch, products};

/// Eliminates a set while its neighbours outside stay.
pub fn order(graph: &Graph, set: &[u32], scratch: &mut Scratch) -> Part {
    let mut search = Search::new(graph, set, scratch);
    let mut part = Part { order: Vec::with_capacity(set.len()), products: 0 };
    while search.advance(set, &mut part) {}
    part
}

/// The same. None where that takes `most` products or finding it `patience` neighbours looked at.
pub fn within(graph: &Graph, set: &[u32], most: u64, patience: u64, scratch: &mut Scratch) -> Option<Part> {
    let mut search = Search::new(graph, set, scratch);
    let mut part = Part { order: Vec::with_capacity(set.len()), products: 0 };
    while search.advance(set, &mut part) {
        if part.products >= most || search.seen > patience {
            return None;
        }
    }
    Some(part)
}

struct Search {
    /// Neighbours left, ascending, by local numbers: those of the set and then those outside.
    near: Vec<Vec<u32>>,
    /// Of those of the set: new neighbours that its elimination makes.
    fill: Vec<usize>,
    done: Vec<bool>,
    /// By fill, neighbours and number; what no longer holds is passed over.
    queue: BinaryHeap<Reverse<(usize, usize, u32)>>,
    mark: Vec<u32>,
    stamp: u32,
    /// Neighbours looked at.
    seen: u64,
    merged: Vec<u32>,
    made: Vec<(u32, u32)>,
    changed: Vec<u32>,
}

impl Search {
    fn new(graph: &Graph, set: &[u32], scratch: &mut Scratch) -> Self {
        let here = scratch.next();
        let mut members = set.to_vec();
        for (k, &i) in set.iter().enumerate() {
            (scratch.mark[i as usize], scratch.local[i as usize]) = (here, k as u32);
        }
        for k in 0..set.len() {
            for &j in graph.of(set[k]) {
                if scratch.mark[j as usize] != here {
                    (scratch.mark[j as usize], scratch.local[j as usize]) = (here, members.len() as u32);
                    members.push(j);
                }
            }
        }
        let near = |&i: &u32| {
            let here = graph.of(i).iter().filter(|&&j| scratch.mark[j as usize] == here);
            let mut near: Vec<u32> = here.map(|&j| scratch.local[j as usize]).collect();
            near.sort_unstable();
            near
        };
        let mut search = Search {
            near: members.iter().map(near).collect(),
            fill: vec![0; set.len()],
            done: vec![false; set.len()],
            queue: BinaryHeap::with_capacity(4 * set.len()),
            mark: vec![0; members.len()],
            stamp: 0,
            seen: 0,
            merged: Vec::new(),
            made: Vec::new(),
            changed: Vec::new(),
        };
        (0..set.len()).for_each(|k| search.count(k));
        search
    }

    /// Takes the next into `part`; whether there was one.
    fn advance(&mut self, set: &[u32], part: &mut Part) -> bool {
        let Some(own) = self.next() else { return false };
        part.order.push(set[own]);
        part.products = part.products.saturating_add(products(self.near[own].len()));
        self.eliminate(own);
        true
    }

    fn next(&mut self) -> Option<usize> {
        while let Some(Reverse((fill, count, own))) = self.queue.pop() {
            let own = own as usize;
            if !self.done[own] && fill == self.fill[own] && count == self.near[own].len() {
                return Some(own);
            }
        }
        None
    }

    /// Finds the fill of one of the set.
    fn count(&mut self, own: usize) {
        self.stamp += 1;
        let row = &self.near[own];
        row.iter().for_each(|&a| self.mark[a as usize] = self.stamp);
        let mut joined = 0;
        for &a in row {
            let near = &self.near[a as usize];
            self.seen += near.len() as u64;
            joined += near.iter().filter(|&&b| self.mark[b as usize] == self.stamp).count();
        }
        self.fill[own] = (row.len() * row.len().saturating_sub(1) - joined) / 2;
        self.queue.push(Reverse((self.fill[own], row.len(), own as u32)));
    }

    /// Joins the neighbours of one of the set to each other, and finds out whose fill that changes: of those with new neighbours anew; of
    /// their common neighbours it falls by one for each pair; and its own neighbours no longer have to be joined to what they had beside them.
    fn eliminate(&mut self, own: usize) {
        self.done[own] = true;
        let row = std::mem::take(&mut self.near[own]);
        let mut made = std::mem::take(&mut self.made);
        let mut changed = std::mem::take(&mut self.changed);
        made.clear();
        changed.clear();
        for (k, &a) in row.iter().enumerate() {
            self.stamp += 1;
            let near = &self.near[a as usize];
            self.seen += near.len() as u64;
            near.iter().for_each(|&b| self.mark[b as usize] = self.stamp);
            let apart = |b: &&u32| **b != a && self.mark[**b as usize] != self.stamp;
            made.extend(row[k + 1..].iter().filter(apart).map(|&b| (a, b)));
            let within = row.len() - 1 - row.iter().filter(apart).count();
            if (a as usize) < self.fill.len() {
                // Those beside are all but what is eliminated and those in the row.
                self.fill[a as usize] = self.fill[a as usize].wrapping_sub(near.len() - 1 - within);
                changed.push(a);
            }
        }
        self.stamp += 1;
        let gained = self.stamp;
        made.iter().flat_map(|&(a, b)| [a, b]).for_each(|a| self.mark[a as usize] = gained);
        for &a in &row {
            match self.mark[a as usize] == gained {
                true => self.join(a, own as u32, &row),
                false => self.near[a as usize].retain(|b| *b as usize != own),
            }
        }
        for &(a, b) in &made {
            self.seen += (self.near[a as usize].len() + self.near[b as usize].len()) as u64;
            for_common(&self.near[a as usize], &self.near[b as usize], |c| {
                if let Some(fill) = self.fill.get_mut(c as usize) {
                    *fill = fill.wrapping_sub(1);
                    changed.push(c);
                }
            });
        }
        changed.sort_unstable();
        changed.dedup();
        let anew: Vec<bool> = changed.iter().map(|&c| self.mark[c as usize] == gained).collect();
        for (&c, anew) in changed.iter().zip(anew) {
            match anew {
                true => self.count(c as usize),
                false => self.queue.push(Reverse((self.fill[c as usize], self.near[c as usize].len(), c))),
            }
        }
        (self.made, self.changed) = (made, changed);
    }

    /// The neighbours of `a`, those of what is eliminated among them.
    fn join(&mut self, a: u32, own: u32, row: &[u32]) {
        let near = &mut self.near[a as usize];
        let merged = &mut self.merged;
        merged.clear();
        let (mut x, mut y) = (near.iter().copied().peekable(), row.iter().copied().peekable());
        loop {
            let next = match (x.peek(), y.peek()) {
                (Some(p), Some(q)) => *p.min(q),
                (Some(p), None) => *p,
                (None, Some(q)) => *q,
                (None, None) => break,
            };
            x.next_if_eq(&next);
            y.next_if_eq(&next);
            if next != a && next != own {
                merged.push(next);
            }
        }
        std::mem::swap(near, merged);
    }
}

fn for_common(a: &[u32], b: &[u32], mut each: impl FnMut(u32)) {
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            Ordering::Less => i += 1,
            Ordering::Greater => j += 1,
            Ordering::Equal => {
                each(a[i]);
                (i, j) = (i + 1, j + 1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is kept up to date is what counting anew gives, in a grid of which a part stays.
    #[test]
    fn fill_is_kept_up_to_date() {
        let (w, h) = (9, 7);
        let beside = (0..w * h).filter(|k| k % w + 1 < w).map(|k| (k, k + 1));
        let above =
            (0..w * (h - 1)).flat_map(|k| [(k, k + w)].into_iter().chain((k % w + 1 < w).then_some((k, k + w + 1))));
        let graph = Graph::new(w * h, &beside.chain(above).collect::<Vec<_>>());
        let set: Vec<u32> = (0..45).collect();
        let mut scratch = Scratch { mark: vec![0; w * h], stamp: 0, local: vec![0; w * h] };
        let mut search = Search::new(&graph, &set, &mut scratch);
        let mut eliminated = 0;
        while let Some(own) = search.next() {
            search.eliminate(own);
            eliminated += 1;
            let left: Vec<usize> = (0..set.len()).filter(|k| !search.done[*k]).collect();
            for k in left {
                let kept = search.fill[k];
                search.count(k);
                assert_eq!(kept, search.fill[k]);
            }
        }
        assert_eq!(eliminated, set.len());
    }
}
