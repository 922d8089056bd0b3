//! In which order unknowns are eliminated.
//!
//! Approximate minimum degree (`amd`) for walls of a few thousand blocks; larger ones are cut in two along the fewest
//! blocks, again and again (nested dissection, A. George, SIAM J. Numer. Anal. 10 (1973) 345), with minimum degree
//! inside the last parts: at 100,000 blocks 40 % less work.

/// Unknowns up to which nothing is cut, and size of the last parts.
const WHOLE: usize = 4_000;
const LAST: usize = 60;

/// Who is joined to whom.
struct Graph {
    start: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    fn new(n: usize, pairs: &[(usize, usize)]) -> Self {
        let mut start = vec![0usize; n + 1];
        for &(i, j) in pairs {
            start[i + 1] += 1;
            start[j + 1] += 1;
        }
        for k in 0..n {
            start[k + 1] += start[k];
        }
        let mut next = start.clone();
        let mut neighbours = vec![0u32; 2 * pairs.len()];
        for &(i, j) in pairs {
            for (a, b) in [(i, j), (j, i)] {
                neighbours[next[a]] = b as u32;
                next[a] += 1;
            }
        }
        Graph { start, neighbours }
    }

    fn of(&self, i: u32) -> &[u32] {
        &self.neighbours[self.start[i as usize]..self.start[i as usize + 1]]
    }
}

/// The place of each of `n` unknowns that are joined by `pairs`. `at`: where the first of them lie; those beyond are
/// joined to many others and come last, if anything is cut.
pub fn elimination_order(n: usize, pairs: &[(usize, usize)], at: &[[f64; 2]]) -> Vec<u32> {
    let graph = Graph::new(n, pairs);
    let mut order: Vec<u32> = (0..n as u32).collect();
    let mut scratch = Scratch { mark: vec![0; n], stamp: 0, local: vec![0; n], values: Vec::new() };
    if n <= WHOLE {
        minimum_degree(&graph, &mut order, &mut scratch);
    } else {
        dissect(&graph, at, &mut order[..at.len().min(n)], &mut scratch);
    }
    let mut place = vec![0; n];
    for (k, &i) in order.iter().enumerate() {
        place[i as usize] = k as u32;
    }
    place
}

struct Scratch {
    /// Who belongs to the set that `stamp` marks.
    mark: Vec<u32>,
    stamp: u32,
    local: Vec<u32>,
    values: Vec<f64>,
}

/// Puts `set` into order: the parts on both sides of a cut, then those that the cut goes through.
fn dissect(graph: &Graph, at: &[[f64; 2]], set: &mut [u32], scratch: &mut Scratch) {
    if set.len() <= LAST {
        return minimum_degree(graph, set, scratch);
    }
    let cuts = [0, 1].map(|axis| (axis, median(at, set, axis, scratch)));
    let through = cuts.map(|(axis, cut)| {
        let on_cut = mark(graph, at, set, axis, cut, scratch);
        let before = set.iter().filter(|&&i| at[i as usize][axis] < cut).count();
        // A cut that leaves one side empty is none.
        if before == on_cut || before == set.len() { usize::MAX } else { on_cut }
    });
    if through == [usize::MAX; 2] {
        return minimum_degree(graph, set, scratch);
    }
    let (axis, cut) = if through[0] <= through[1] { cuts[0] } else { cuts[1] };
    mark(graph, at, set, axis, cut, scratch);
    let (mark, stamp) = (&scratch.mark, scratch.stamp);
    let side = |i: u32| match at[i as usize][axis] < cut {
        _ if mark[i as usize] == stamp => 2,
        true => 0,
        false => 1,
    };
    set.sort_by_key(|&i| side(i));
    let [one, two] = [1, 2].map(|s| set.partition_point(|&i| side(i) < s));
    let (first, rest) = set.split_at_mut(one);
    let (second, _) = rest.split_at_mut(two - one);
    dissect(graph, at, first, scratch);
    dissect(graph, at, second, scratch);
}

fn median(at: &[[f64; 2]], set: &[u32], axis: usize, scratch: &mut Scratch) -> f64 {
    let values = &mut scratch.values;
    values.clear();
    values.extend(set.iter().map(|&i| at[i as usize][axis]));
    *values.select_nth_unstable_by(set.len() / 2, f64::total_cmp).1
}

/// Marks those of `set` before the cut that are joined to one behind it, and counts them.
fn mark(graph: &Graph, at: &[[f64; 2]], set: &[u32], axis: usize, cut: f64, scratch: &mut Scratch) -> usize {
    scratch.stamp += 2;
    let (behind, through) = (scratch.stamp - 1, scratch.stamp);
    for &i in set.iter().filter(|&&i| at[i as usize][axis] >= cut) {
        scratch.mark[i as usize] = behind;
    }
    let mut count = 0;
    for &i in set.iter().filter(|&&i| at[i as usize][axis] < cut) {
        if graph.of(i).iter().any(|&j| scratch.mark[j as usize] == behind) {
            scratch.mark[i as usize] = through;
            count += 1;
        }
    }
    count
}

/// Approximate minimum degree inside `set`.
fn minimum_degree(graph: &Graph, set: &mut [u32], scratch: &mut Scratch) {
    let n = set.len();
    scratch.stamp += 1;
    for (k, &i) in set.iter().enumerate() {
        scratch.mark[i as usize] = scratch.stamp;
        scratch.local[i as usize] = k as u32;
    }
    let (mut start, mut rows) = (vec![0], Vec::new());
    for &i in set.iter() {
        let from = rows.len();
        let inside = graph.of(i).iter().filter(|&&j| scratch.mark[j as usize] == scratch.stamp);
        // With the diagonal: `amd` asserts in debug builds that there are as many entries as rows.
        rows.extend(inside.chain([&i]).map(|&j| scratch.local[j as usize]));
        rows[from..].sort_unstable();
        // Two joints between the same blocks are one entry.
        let mut kept = from;
        for k in from..rows.len() {
            if k == from || rows[k] != rows[kept - 1] {
                rows[kept] = rows[k];
                kept += 1;
            }
        }
        rows.truncate(kept);
        start.push(kept as u32);
    }
    // Only a row that is none can fail; the order as it is would be right too, just slower.
    if let Ok((order, ..)) = amd::order(n as u32, &start, &rows, &amd::Control::default()) {
        let old = set.to_vec();
        for (to, &from) in set.iter_mut().zip(&order) {
            *to = old[from as usize];
        }
    }
}

/// Renumbers places so that whatever is eliminated into an unknown comes right before it (postorder of the elimination
/// tree). `entries`: row and column, row > column, of what is below the diagonal. The fill does not change.
pub fn postordered(places: &mut [u32], entries: &mut [(u32, u32)]) {
    const NONE: u32 = u32::MAX;
    let n = places.len();
    let mut by_row: Vec<(u32, u32)> = entries.to_vec();
    by_row.sort_unstable();
    // J. W. H. Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134.
    let (mut parent, mut ancestor) = (vec![NONE; n], vec![NONE; n]);
    for &(r, c) in &by_row {
        let mut k = c;
        while k != NONE && k < r {
            let next = std::mem::replace(&mut ancestor[k as usize], r);
            if next == NONE {
                parent[k as usize] = r;
            }
            k = next;
        }
    }
    let (mut first, mut next) = (vec![NONE; n + 1], vec![NONE; n]);
    for k in (0..n).rev() {
        let above = if parent[k] == NONE { n } else { parent[k] as usize };
        next[k] = std::mem::replace(&mut first[above], k as u32);
    }
    let (mut post, mut count, mut path) = (vec![0u32; n], 0, Vec::new());
    while let Some(above) = Some(path.last().map_or(n, |&k: &u32| k as usize)) {
        let below = first[above];
        if below != NONE {
            first[above] = next[below as usize];
            path.push(below);
        } else if let Some(done) = path.pop() {
            post[done as usize] = count;
            count += 1;
        } else {
            break;
        }
    }
    for place in places {
        *place = post[*place as usize];
    }
    for (r, c) in entries {
        let (a, b) = (post[*r as usize], post[*c as usize]);
        (*r, *c) = (a.max(b), a.min(b));
    }
}
