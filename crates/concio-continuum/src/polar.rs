//! Hulls of points around the origin in three dimensions: the polar of a strength domain.
//!
//! A bound y·u ≤ 1 is a point y. The domain's corners are facets of the hull of these points and the origin.

/// Distances below this are rounding: points are of the size of 1.
const ROUNDING: f64 = 1e-7;

/// A side of a hull: all points have normal·y ≤ offset.
#[derive(Debug, Clone)]
pub struct Facet {
    /// Unit normal, outwards.
    pub normal: [f64; 3],
    /// From 0, which stands for a side through the origin.
    pub offset: f64,
    /// Indices of the points in it.
    points: Vec<usize>,
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

/// The sides of the hull of some points and the origin, each once. All triples are tried: points are few, and this holds where many
/// lie in one plane.
pub fn facets(points: &[[f64; 3]]) -> Vec<Facet> {
    let all: Vec<[f64; 3]> = points.iter().copied().chain([[0.0; 3]]).collect();
    let mut found = Vec::new();
    for i in 0..all.len() {
        for j in i + 1..all.len() {
            for k in j + 1..all.len() {
                let normal = cross(less(all[j], all[i]), less(all[k], all[i]));
                let size = dot(normal, normal).sqrt();
                if size < ROUNDING {
                    continue;
                }
                for sign in [1.0, -1.0] {
                    let normal = normal.map(|v| sign * v / size);
                    let offset = dot(normal, all[i]);
                    if offset >= -ROUNDING && all.iter().all(|y| dot(normal, *y) <= offset + ROUNDING) {
                        let offset = offset.max(0.0);
                        found.push((size, [i, j, k], Facet { normal, offset, points: Vec::new() }));
                    }
                }
            }
        }
    }
    // The widest triple tells the normal best; others of the same plane tell nothing more.
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut sides: Vec<Facet> = Vec::new();
    for (_, triple, mut side) in found {
        let inside =
            |other: &Facet| dot(other.normal, side.normal) > 0.0 && triple.iter().all(|m| other.points.contains(m));
        if !sides.iter().any(inside) {
            let near = |m: &usize| dot(side.normal, all[*m]) > side.offset - 10.0 * ROUNDING;
            side.points = (0..all.len()).filter(near).collect();
            sides.push(side);
        }
    }
    sides
}

/// The corners of the hull of some points and the origin, without the origin and each once.
pub fn corners(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut once: Vec<[f64; 3]> = Vec::new();
    for y in points {
        if !once.iter().any(|o| less(*o, *y).iter().all(|v| v.abs() < 10.0 * ROUNDING)) {
            once.push(*y);
        }
    }
    let sides = facets(&once);
    if sides.is_empty() {
        return once;
    }
    let mut kept = vec![true; once.len()];
    for own in 0..once.len() {
        // What could hold it shares a side with it.
        let own_sides = sides.iter().filter(|f| f.points.contains(&own));
        let mut beside: Vec<usize> = own_sides.flat_map(|f| f.points.iter().copied()).collect();
        beside.sort_unstable();
        beside.dedup();
        let others = beside.iter().filter(|k| **k != own && **k < once.len() && kept[**k]).map(|k| once[*k]);
        let around = facets(&others.collect::<Vec<_>>());
        let beyond = |f: &Facet| dot(f.normal, once[own]) > f.offset + ROUNDING;
        kept[own] = !beside.is_empty() && (around.is_empty() || around.iter().any(beyond));
    }
    once.into_iter().zip(kept).filter(|(_, kept)| *kept).map(|(y, _)| y).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a cube its corners are left, not the middles of edges, sides and itself, nor what comes twice.
    #[test]
    fn corners_of_a_cube_are_left() {
        let coordinates = [-1.0, 0.0, 1.0];
        let square = coordinates.iter().flat_map(|x| coordinates.map(|y| (*x, y)));
        let mut points: Vec<[f64; 3]> = square.flat_map(|(x, y)| coordinates.map(|z| [x, y, z])).collect();
        points.push([1.0, 1.0, 1.0 + 1e-9]);
        assert_eq!(corners(&points).len(), 8);
        assert_eq!(facets(&points).len(), 6);
        assert!(facets(&points).iter().all(|f| (f.offset - 1.0).abs() < 1e-8));
    }
}
