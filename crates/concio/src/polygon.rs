//! Convex polygons: size, overlap, and the edges along which two of them face each other. Corners run counterclockwise.

/// A corner [m].
pub type Point = [f64; 2];

/// Sine of the angle up to which two edges count as parallel: corners written in millimetres are that far off.
const SKEW: f64 = 5e-3;

pub(crate) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Corners of a rectangle.
pub(crate) fn of_box(x: [f64; 2], y: [f64; 2]) -> Vec<Point> {
    vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

/// Left and right, lowest and highest coordinate.
pub(crate) fn bounds(corners: &[Point]) -> [[f64; 2]; 2] {
    let along = |k: usize| {
        corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| [low.min(c[k]), high.max(c[k])])
    };
    [along(0), along(1)]
}

/// Edges with their start, direction of length 1 and length.
fn edges(corners: &[Point]) -> impl Iterator<Item = (Point, Point, f64)> + '_ {
    (0..corners.len()).map(|k| {
        let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
        let way = minus(to, from);
        let length = way[0].hypot(way[1]);
        (from, [way[0] / length, way[1] / length], length)
    })
}

/// Twice the signed area [m²]: above 0 where the corners run counterclockwise.
pub(crate) fn doubled_area(corners: &[Point]) -> f64 {
    (1..corners.len().saturating_sub(1))
        .map(|k| cross(minus(corners[k], corners[0]), minus(corners[k + 1], corners[0])))
        .sum()
}

/// The corners counterclockwise.
///
/// # Errors
/// The number of the corner, from 0, at which they do not turn the way of the others or go straight on; that of the last
/// where they go round more than once.
pub(crate) fn convex(corners: &[Point]) -> Result<Vec<Point>, usize> {
    let mut ordered = corners.to_vec();
    let backwards = doubled_area(corners) < 0.0;
    if backwards {
        ordered.reverse();
    }
    let n = ordered.len();
    let number = |k: usize| if backwards { n - 1 - k } else { k };
    let ways: Vec<(Point, Point, f64)> = edges(&ordered).collect();
    let mut turned = 0.0;
    for k in 0..n {
        let ((_, before, _), (_, after, _)) = (ways[(k + n - 1) % n], ways[k]);
        let angle = cross(before, after).atan2(dot(before, after));
        // Written so that corners that coincide, whose edge has no direction, fail too.
        if !(angle > 1e-6) {
            return Err(number(k));
        }
        turned += angle;
    }
    if turned < 1.5 * std::f64::consts::TAU { Ok(ordered) } else { Err(n - 1) }
}

/// Centre of gravity [m], by triangles from the first corner.
pub(crate) fn centroid(corners: &[Point]) -> Point {
    let origin = corners[0];
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for k in 1..corners.len() - 1 {
        let (a, b) = (minus(corners[k], origin), minus(corners[k + 1], origin));
        let twice = cross(a, b);
        area += twice;
        (0..2).for_each(|i| moment[i] += twice * (a[i] + b[i]) / 3.0);
    }
    [origin[0] + moment[0] / area, origin[1] + moment[1] / area]
}

/// ∫ r² dA about the centre of gravity [m⁴].
pub(crate) fn polar_moment(corners: &[Point]) -> f64 {
    let centre = centroid(corners);
    let corner = |k: usize| minus(corners[k % corners.len()], centre);
    let part = |k: usize| {
        let (a, b) = (corner(k), corner(k + 1));
        cross(a, b) * (dot(a, a) + dot(a, b) + dot(b, b)) / 12.0
    };
    (0..corners.len()).map(part).sum()
}

/// How far two polygons reach into each other [m]: the way that one must move to be clear of the other, below 0 where they
/// are apart (the widest gap between edge lines).
pub(crate) fn depth(a: &[Point], b: &[Point]) -> f64 {
    let over = |of: &[Point], other: &[Point]| {
        let reach = |(from, along, _): (Point, Point, f64)| {
            let inwards = |c: &Point| cross(along, minus(*c, from));
            other.iter().map(inwards).fold(f64::NEG_INFINITY, f64::max)
        };
        edges(of).map(reach).fold(f64::INFINITY, f64::min)
    };
    over(a, b).min(over(b, a))
}

/// A line along which two polygons face each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Facing {
    /// Ends of the line in the middle of the gap [m], in the direction of the first polygon's edge.
    pub ends: [Point; 2],
    /// Length [m].
    pub length: f64,
    /// Outward normal of the first polygon's edge.
    pub normal: Point,
}

/// The longest line along which `a` and `b` face each other over a gap that `allows` takes, given the normal of `a`'s edge
/// and the gap [m], longer than `shortest` [m].
pub(crate) fn facing(a: &[Point], b: &[Point], shortest: f64, allows: impl Fn(Point, f64) -> bool) -> Option<Facing> {
    let mut found: Option<Facing> = None;
    for (from, along, length) in edges(a) {
        let normal = [along[1], -along[0]];
        for (start, way, other) in edges(b) {
            if dot(along, way) >= 0.0 || cross(along, way).abs() > SKEW {
                continue;
            }
            // The other edge runs the other way: its start lies further along this one than its end.
            let end = [start[0] + other * way[0], start[1] + other * way[1]];
            let [high, low] = [start, end].map(|p| (dot(minus(p, from), along), dot(minus(p, from), normal)));
            let span = [low.0.max(0.0), high.0.min(length)];
            let gap = |s: f64| low.1 + (high.1 - low.1) * (s - low.0) / (high.0 - low.0);
            let common = span[1] - span[0];
            if common <= shortest.max(found.map_or(0.0, |f| f.length)) || !span.iter().all(|s| allows(normal, gap(*s)))
            {
                continue;
            }
            let at = |s: f64| {
                let half = 0.5 * gap(s);
                [from[0] + s * along[0] + half * normal[0], from[1] + s * along[1] + half * normal[1]]
            };
            found = Some(Facing { ends: span.map(at), length: common, normal });
        }
    }
    found
}

/// Height of the upper side of a convex polygon at `x` [m]; none beside it.
pub(crate) fn top_at(corners: &[Point], x: f64) -> Option<f64> {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossing = |(p, q): (&Point, &Point)| {
        let share = (x - p[0]) / (q[0] - p[0]);
        (p[0] != q[0] && (0.0..=1.0).contains(&share)).then(|| p[1] + share * (q[1] - p[1]))
    };
    edges.filter_map(crossing).reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12 * b.abs().max(1.0)
    }

    /// Closed forms: a rectangle b h has b h (b² + h²)/12, a right triangle with legs b, h has b h (b² + h²)/36, a regular
    /// hexagon of side a has 5 √3 a⁴/8 (twice its second moment 5 √3 a⁴/16).
    #[test]
    fn sizes_of_known_shapes() {
        let (b, h) = (0.3, 0.2);
        let rectangle = of_box([1.0, 1.0 + b], [-2.0, -2.0 + h]);
        assert!(close(doubled_area(&rectangle), 2.0 * b * h));
        assert!(close(polar_moment(&rectangle), b * h * (b * b + h * h) / 12.0));
        assert!(close(centroid(&rectangle)[0], 1.15) && close(centroid(&rectangle)[1], -1.9));
        let triangle = [[5.0, 5.0], [5.0 + b, 5.0], [5.0, 5.0 + h]];
        assert!(close(doubled_area(&triangle), b * h));
        assert!(close(polar_moment(&triangle), b * h * (b * b + h * h) / 36.0));
        assert!(close(centroid(&triangle)[0], 5.1) && close(centroid(&triangle)[1], 5.0 + h / 3.0));
        let hexagon: Vec<Point> = (0..6)
            .map(|k| (f64::from(k) * std::f64::consts::FRAC_PI_3).sin_cos())
            .map(|(s, c)| [0.5 * c - 3.0, 0.5 * s + 1.0])
            .collect();
        assert!(close(doubled_area(&hexagon), 3.0 * 3f64.sqrt() * 0.25));
        assert!(close(polar_moment(&hexagon), 5.0 * 3f64.sqrt() / 8.0 * 0.0625));
    }

    #[test]
    fn convex_or_not_and_where() {
        let square = of_box([0.0, 1.0], [0.0, 1.0]);
        assert_eq!(convex(&square), Ok(square.clone()));
        let clockwise: Vec<Point> = square.iter().rev().copied().collect();
        assert_eq!(convex(&clockwise), Ok(square.clone()));
        let dented = [[0.0, 0.0], [1.0, 0.0], [0.4, 0.4], [0.0, 1.0]];
        assert_eq!(convex(&dented), Err(2));
        let back: Vec<Point> = dented.iter().rev().copied().collect();
        assert_eq!(convex(&back), Err(1));
        assert_eq!(convex(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0]]), Err(1));
        assert!(convex(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).is_err());
        // A star of five points turns left at each of them and goes round twice.
        let star: Vec<Point> =
            (0..5).map(|k| (f64::from(2 * k) * std::f64::consts::TAU / 5.0).sin_cos()).map(|(s, c)| [c, s]).collect();
        assert!(convex(&star).is_err());
    }

    #[test]
    fn squares_that_touch_face_each_other() {
        let any = |_: Point, gap: f64| gap.abs() < 0.011;
        let (a, b) = (of_box([0.0, 1.0], [0.0, 1.0]), of_box([1.01, 2.0], [0.25, 3.0]));
        let found = facing(&a, &b, 1e-6, any).expect("a line");
        assert!(close(found.length, 0.75) && found.normal == [1.0, 0.0]);
        assert!(close(found.ends[0][0], 1.005) && close(found.ends[0][1], 0.25) && close(found.ends[1][1], 1.0));
        assert!(close(depth(&a, &b), -0.01));
        assert!(close(depth(&a, &of_box([0.9, 2.0], [0.25, 3.0])), 0.1));
        assert_eq!(facing(&a, &of_box([1.05, 2.0], [0.25, 3.0]), 1e-6, any), None);
    }
}
