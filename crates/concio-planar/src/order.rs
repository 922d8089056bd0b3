//! In which order the bodies of a wall are eliminated, so that as few products as possible are to be made.
//!
//! A wall is cut in two along the fewest blocks, again and again, and those that a cut goes through are eliminated after both sides
//! (nested dissection, A. George, SIAM J. Numer. Anal. 10 (1973) 345). A cut is the least set of blocks that all joints from one side
//! to the other end at (D. Kőnig, Mat. Fiz. Lapok 38 (1931) 116), the best of several places along both axes. Small parts, and walls as a whole
//! that are long, are also eliminated by what joins the fewest to each other next (minimum fill, W. F. Tinney and J. W. Walker, Proc. IEEE 55 (1967)
//! 1801), and the better of the two is kept: what the rest of the wall has to do is the same after either.

mod cut;
mod graph;
mod least_fill;
mod tree;

use cut::Cut;
use graph::Graph;

/// Unknowns up to which a part is not cut, and up to which one that can be is eliminated by least fill too.
const WHOLE: usize = 60;
const BOTH: usize = 100;
/// The whole is eliminated by least fill too where its first cut goes through fewer unknowns than so many times the root of all, and for as
/// long as not more neighbours than so many times its unknowns were looked at.
const LONG: f64 = 0.75;
const PATIENCE: u64 = 10_000;

/// Products for one of those that the laid wall takes, up to which its order serves for what touches later.
const SLACK: f64 = 1.1;

/// How the bodies of a wall are eliminated, whatever touches: a run taken up midway has the same orders.
#[derive(Debug, Clone)]
pub struct Orders {
    /// Where the bodies were laid; empty where nothing is to be cut.
    at: Vec<[f64; 2]>,
    /// The order of the laid wall, and products that it takes.
    laid: Vec<u32>,
    products: u64,
}

impl Orders {
    /// Of bodies of which `pairs` touch in the wall as it is laid.
    pub fn new(at: Vec<[f64; 2]>, pairs: &[(usize, usize)]) -> Self {
        let graph = Graph::new(at.len(), pairs);
        let Part { order, products } = found(&graph, &at);
        Orders { at, laid: order, products }
    }

    /// Of any bodies, without where they are.
    pub fn anywhere() -> Self {
        Orders { at: Vec::new(), laid: Vec::new(), products: 0 }
    }

    /// Of `n` bodies that are joined by `pairs`.
    pub fn elimination(&self, n: usize, pairs: &[(usize, usize)]) -> Elimination {
        let graph = Graph::new(n, pairs);
        if self.laid.len() == n {
            let elimination = tree::postordered(&graph, &self.laid);
            if elimination.products() as f64 <= SLACK * self.products as f64 {
                return elimination;
            }
        }
        tree::postordered(&graph, &found(&graph, &self.at).order)
    }
}

/// An order of elimination, such that whatever is eliminated into an unknown comes right before it (postorder of the elimination tree).
#[derive(Debug)]
pub struct Elimination {
    /// Which unknown comes at each place.
    order: Vec<u32>,
    /// Places of the neighbours that each has left then, ascending, by its own place: the pattern of the factors.
    pub rows: Vec<Vec<u32>>,
}

impl Elimination {
    /// The place of each unknown.
    pub fn places(&self) -> Vec<u32> {
        let mut places = vec![0; self.order.len()];
        self.order.iter().enumerate().for_each(|(k, &i)| places[i as usize] = k as u32);
        places
    }

    /// Products of two blocks that it takes where the matrix is symmetric.
    fn products(&self) -> u64 {
        self.rows.iter().map(|row| products(row.len())).sum()
    }
}

fn found(graph: &Graph, at: &[[f64; 2]]) -> Part {
    let n = graph.len();
    let mut scratch = Scratch { mark: vec![0; n], stamp: 0, local: vec![0; n] };
    let set: Vec<u32> = (0..n as u32).collect();
    match at {
        [] => least_fill::order(graph, &set, &mut scratch),
        _ => whole(graph, at, set, &mut scratch),
    }
}

/// Products that an unknown takes which has so many neighbours left.
fn products(left: usize) -> u64 {
    (left * (left + 1) / 2) as u64
}

/// How a part of the unknowns is eliminated while its neighbours outside stay, and the products that this takes.
struct Part {
    order: Vec<u32>,
    products: u64,
}

/// Which unknowns belong to what is looked at; local numbers.
struct Scratch {
    mark: Vec<u32>,
    stamp: u32,
    local: Vec<u32>,
}

impl Scratch {
    /// A new number to mark with.
    fn next(&mut self) -> u32 {
        self.stamp += 1;
        self.stamp
    }
}

/// All of them.
fn whole(graph: &Graph, at: &[[f64; 2]], set: Vec<u32>, scratch: &mut Scratch) -> Part {
    let n = set.len();
    let Some(cut) = to_be_cut(graph, at, &set, scratch) else { return least_fill::order(graph, &set, scratch) };
    let is_long = (cut.through.len() as f64) < LONG * (n as f64).sqrt();
    let parts = in_parts(graph, at, cut, scratch);
    let better = match is_long {
        true => least_fill::within(graph, &set, parts.products, PATIENCE * n as u64, scratch),
        false => None,
    };
    better.unwrap_or(parts)
}

fn part(graph: &Graph, at: &[[f64; 2]], set: Vec<u32>, scratch: &mut Scratch) -> Part {
    let Some(cut) = to_be_cut(graph, at, &set, scratch) else { return least_fill::order(graph, &set, scratch) };
    let parts = in_parts(graph, at, cut, scratch);
    let better = match set.len() <= BOTH {
        true => least_fill::within(graph, &set, parts.products, u64::MAX, scratch),
        false => None,
    };
    better.unwrap_or(parts)
}

fn to_be_cut(graph: &Graph, at: &[[f64; 2]], set: &[u32], scratch: &mut Scratch) -> Option<Cut> {
    if set.len() > WHOLE { cut::best(graph, at, set, scratch) } else { None }
}

/// One side, the other, and what the cut goes through.
fn in_parts(graph: &Graph, at: &[[f64; 2]], cut: Cut, scratch: &mut Scratch) -> Part {
    let sides = cut.sides.map(|side| part(graph, at, side, scratch).order);
    let order = [&sides[0][..], &sides[1], &cut.through].concat();
    Part { products: tree::products_of(graph, &order, scratch), order }
}

#[cfg(test)]
mod tests;
