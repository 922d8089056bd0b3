//! Who is joined to whom.

pub struct Graph {
    start: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    /// Each neighbour once, ascending.
    pub fn new(n: usize, pairs: &[(usize, usize)]) -> Self {
        let mut both: Vec<(u32, u32)> =
            pairs.iter().flat_map(|&(i, j)| [(i as u32, j as u32), (j as u32, i as u32)]).collect();
        both.sort_unstable();
        both.dedup();
        both.retain(|(i, j)| i != j);
        let mut start = vec![0; n + 1];
        both.iter().for_each(|(i, _)| start[*i as usize + 1] += 1);
        (0..n).for_each(|k| start[k + 1] += start[k]);
        Graph { start, neighbours: both.into_iter().map(|(_, j)| j).collect() }
    }

    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    pub fn of(&self, i: u32) -> &[u32] {
        &self.neighbours[self.start[i as usize]..self.start[i as usize + 1]]
    }
}
