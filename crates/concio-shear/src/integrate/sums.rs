//! Sums over the joints of each unknown: the numbers of a loop over joints that adds to both sides of each, without its
//! waiting, as neighbours follow each other there, for what it has just stored.

/// Which joints hang on each unknown, base and top left out.
#[derive(Debug, Clone)]
pub struct Sums {
    /// How many sides of joints each unknown is.
    count: Vec<u32>,
    /// Which these are, unknown by unknown, joints in ascending order: 2e is the first side of joint e, 2e + 1 the second.
    of: Vec<u32>,
}

impl Sums {
    /// For `n` unknowns and joints between `sides`, of which those from `n` on are none.
    pub fn new(n: usize, sides: &[[u32; 2]]) -> Self {
        let mut of: Vec<u32> = (0..2 * sides.len() as u32).collect();
        let unknown = |side: &u32| sides.as_flattened()[*side as usize];
        of.retain(|side| (unknown(side) as usize) < n);
        of.sort_by_key(unknown);
        let mut count = vec![0; n];
        of.iter().for_each(|side| count[unknown(side) as usize] += 1);
        Sums { count, of }
    }

    /// Adds to every unknown the parts of its joints, which are by joint and side.
    #[inline(always)]
    pub fn add(&self, totals: &mut [f64], parts: &[[f64; 2]]) {
        let (parts, mut of) = (parts.as_flattened(), &self.of[..]);
        for (total, &count) in totals.iter_mut().zip(&self.count) {
            let (own, rest) = of.split_at(count as usize);
            of = rest;
            let mut sum = *total;
            for &side in own {
                sum += parts[side as usize];
            }
            *total = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// To the bit what adding joint by joint gives, where several joints meet and some lead to supports.
    #[test]
    fn sums_are_those_of_a_loop_over_joints() {
        let (n, sides) = (4, [[2, 0], [0, 1], [3, 5], [1, 2], [0, 4], [2, 1], [0, 2]]);
        let parts: Vec<[f64; 2]> = (1..=sides.len()).map(|e| [0.1 / e as f64, -1e3 / e as f64]).collect();
        let mut expected = vec![0.3; n + 2];
        for (sides, parts) in sides.iter().zip(&parts) {
            for (&side, part) in sides.iter().zip(parts) {
                expected[side as usize] += part;
            }
        }
        let mut totals = vec![0.3; n];
        Sums::new(n, &sides).add(&mut totals, &parts);
        assert_eq!(totals, expected[..n]);
    }
}
