//! Voussoirs of a circular arch.
//!
//! Half span a and rise f give the radius of the intrados R = (a² + f²)/(2 f) and the angle α from the crown to the springing,
//! sin α = a/R. Joints lie along the radii that part 2 α into equal parts, and the sides of a voussoir are chords. The radial
//! bed of a springer rises outwards with π/2 − α; it gives way to a level one at the height of the springing, under the end
//! of the back. Of a semicircle both are one.

use crate::case::Arch;
use crate::polygon::Point;

/// Corners of the voussoirs from the left, counterclockwise; the leftmost lies at x = 0.
pub(super) fn voussoirs(arch: &Arch) -> Vec<Vec<Point>> {
    let (a, f, t, n) = (0.5 * arch.span.si(), arch.rise.si(), arch.thickness.si(), arch.voussoirs);
    let (radius, base) = (0.5 * (a * a + f * f) / f, arch.springing.si());
    let semicircle = f == a;
    // sin α = a/R and cos α = (R − f)/R, which is 0 to the bit for a semicircle.
    let [sin, cos] = if semicircle { [1.0, 0.0] } else { [a / radius, (radius - f) / radius] };
    let alpha = sin.atan2(cos);
    let (middle, centre) = (a + t * sin, base + f - radius);
    // Of the left half; the right one is its mirror image to the bit.
    let joint = |k: usize| -> [Point; 2] {
        let left = k.min(n - k);
        let (s, c) = match left {
            0 => (sin, cos),
            _ if 2 * left == n => (0.0, 1.0),
            _ => (alpha * (1.0 - 2.0 * left as f64 / n as f64)).sin_cos(),
        };
        [radius, radius + t].map(|r| {
            let (out, y) = (r * s, centre + r * c);
            [if 2 * k <= n { middle - out } else { middle + out }, y]
        })
    };
    let level = |[x, _]: Point| [x, base];
    let voussoir = |k: usize| {
        let ([inner, outer], [next_inner, next_outer]) = (joint(k), joint(k + 1));
        match k {
            // The inner corner of the springing lies at its height but for rounding.
            0 if semicircle => vec![level(outer), level(inner), next_inner, next_outer],
            0 => vec![level(outer), level(inner), next_inner, next_outer, outer],
            _ if k + 1 == n && semicircle => vec![level(next_inner), level(next_outer), outer, inner],
            _ if k + 1 == n => vec![level(next_inner), level(next_outer), next_outer, outer, inner],
            _ => vec![inner, next_inner, next_outer, outer],
        }
    };
    (0..n).map(voussoir).collect()
}
