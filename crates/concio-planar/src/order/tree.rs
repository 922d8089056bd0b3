//! What an order leaves of neighbours, and who is eliminated into whom.

use super::graph::Graph;
use super::{Elimination, Scratch, products};

const NONE: u32 = u32::MAX;

/// Places of the neighbours left, by place; those beyond the last are outside of the order.
fn rows(graph: &Graph, order: &[u32], place: impl Fn(u32) -> u32) -> Vec<Vec<u32>> {
    let mut rows: Vec<Vec<u32>> = Vec::with_capacity(order.len());
    let mut feeders = vec![NONE; order.len()];
    let mut next = vec![NONE; order.len()];
    for (own, &i) in order.iter().enumerate() {
        let mut row: Vec<u32> = graph.of(i).iter().map(|&j| place(j)).filter(|&k| k > own as u32).collect();
        let mut feeder = feeders[own];
        while feeder != NONE {
            row.extend(rows[feeder as usize].iter().filter(|&&k| k != own as u32));
            feeder = next[feeder as usize];
        }
        row.sort_unstable();
        row.dedup();
        if let Some(&into) = row.first().filter(|k| (**k as usize) < order.len()) {
            next[own] = std::mem::replace(&mut feeders[into as usize], own as u32);
        }
        rows.push(row);
    }
    rows
}

/// Products that the elimination of a set in this order takes while its neighbours outside stay.
pub fn products_of(graph: &Graph, order: &[u32], scratch: &mut Scratch) -> u64 {
    let (mine, n) = (scratch.next(), order.len() as u32);
    for (k, &i) in order.iter().enumerate() {
        (scratch.mark[i as usize], scratch.local[i as usize]) = (mine, k as u32);
    }
    let place = |j: u32| match scratch.mark[j as usize] == mine {
        true => scratch.local[j as usize],
        // Outside: by its own number, behind all.
        false => n + j,
    };
    rows(graph, order, place).iter().map(|row| products(row.len())).sum()
}

/// The same elimination with what feeds an unknown right before it.
pub fn postordered(graph: &Graph, order: &[u32]) -> Elimination {
    let n = order.len();
    let mut place = vec![0; n];
    order.iter().enumerate().for_each(|(k, &i)| place[i as usize] = k as u32);
    let found = rows(graph, order, |j| place[j as usize]);
    let mut feeders: Vec<Vec<u32>> = vec![Vec::new(); n];
    let mut open = Vec::new();
    for (k, row) in found.iter().enumerate() {
        match row.first() {
            Some(into) => feeders[*into as usize].push(k as u32),
            None => open.push(k as u32),
        }
    }
    // Every one before those that feed it, and then backwards.
    let mut last_first = Vec::with_capacity(n);
    while let Some(k) = open.pop() {
        last_first.push(k);
        open.extend(&feeders[k as usize]);
    }
    last_first.reverse();
    let mut now = vec![0; n];
    last_first.iter().enumerate().for_each(|(k, &old)| now[old as usize] = k as u32);
    let moved = |&old: &u32| {
        let mut row: Vec<u32> = found[old as usize].iter().map(|&k| now[k as usize]).collect();
        row.sort_unstable();
        row
    };
    Elimination {
        rows: last_first.iter().map(moved).collect(),
        order: last_first.iter().map(|&old| order[old as usize]).collect(),
    }
}
