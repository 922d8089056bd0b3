//! Hunting, filling, interpolation and fractiles of curves whose answers are known.

use concio_study::ida::Way;
use concio_study::ida::curve::{Curve, Point, fractiles};
use concio_study::ida::likelihood::Evidence;

fn point(intensity: f64, collapsed: bool) -> Point {
    Point { intensity, scale: intensity, damage: Some(intensity), collapsed, id: String::new(), warnings: Vec::new() }
}

/// Steps of 0.1, 0.15, 0.2, … up to the collapse at 0.97, thirds until the gap is 10 %, then the widest gaps.
#[test]
fn hunts_then_closes_in_then_fills() {
    let way = Way::Hunt { first: 0.05, step: 0.1, growth: 0.05, most: 5.0, runs: 12, resolution: 0.1 };
    let mut points: Vec<Point> = Vec::new();
    let mut asked = Vec::new();
    while let [next] = way.next(&points, &[])[..] {
        asked.push(next);
        let place = points.partition_point(|p| p.intensity < next);
        points.insert(place, point(next, next >= 0.97));
    }
    assert_eq!(asked.len(), 12);
    let third = 0.85 + 0.2 / 3.0;
    let closed = third + (1.05 - third) / 3.0;
    let expected = [0.05, 0.15, 0.3, 0.5, 0.75, 1.05, 0.85, third, closed, 0.625, 0.4, 0.225];
    for (asked, expected) in asked.iter().zip(expected) {
        assert!((asked - expected).abs() < 1e-12, "{asked} {expected}");
    }
    let collapse = points.iter().position(|p| p.collapsed).unwrap_or(0);
    assert!(points[collapse].intensity / points[collapse - 1].intensity < 1.1);
}

#[test]
fn without_collapse_it_goes_to_the_end_and_fills() {
    let way = Way::Hunt { first: 0.5, step: 1.0, growth: 0.0, most: 2.0, runs: 6, resolution: 0.1 };
    let mut points: Vec<Point> = Vec::new();
    while let [next] = way.next(&points, &[])[..] {
        let place = points.partition_point(|p| p.intensity < next);
        points.insert(place, point(next, false));
    }
    let intensities: Vec<f64> = points.iter().map(|p| p.intensity).collect();
    assert_eq!(intensities, [0.25, 0.5, 0.75, 1.0, 1.5, 2.0]);
}

fn curve(points: &[(f64, f64, bool)]) -> Curve {
    let point = |&(intensity, damage, collapsed): &(f64, f64, bool)| Point {
        intensity,
        scale: intensity,
        damage: Some(damage),
        collapsed,
        id: String::new(),
        warnings: Vec::new(),
    };
    let points = points.iter().map(point).collect();
    Curve { name: "a".into(), motion: 0, number: 0, unit: 1.0, points, failed: None }
}

/// Damage as a power of the intensity is a straight line between logarithms: capacities come out exactly.
#[test]
fn powers_are_interpolated_exactly() {
    let power = |y: f64| 0.3 * y.powf(1.7);
    let c = curve(&[0.1, 0.4, 0.5, 0.62, 2.0].map(|y| (y, power(y), false)));
    for y in [0.45, 0.5, 0.6] {
        let Evidence::At(found) = c.capacity(power(y)) else { panic!("a capacity at {y}") };
        assert!((found / y - 1.0).abs() < 1e-12);
        assert!((c.damage(y).unwrap_or(0.0) / power(y) - 1.0).abs() < 1e-12);
    }
    assert_eq!(c.capacity(power(2.5)), Evidence::Above(2.0));
    assert_eq!(c.capacity(power(0.05)), Evidence::Below(0.1));
    assert_eq!((c.damage(2.5), c.damage(0.05)), (None, None));
    // Between runs that lie far apart it may be anything.
    assert_eq!(c.capacity(power(0.15)), Evidence::Within([0.1, 0.4]));
    let fallen = curve(&[(0.1, 1.0, false), (0.4, 2.0, true)]);
    assert_eq!(fallen.damage(0.3), Some(f64::INFINITY));
    assert_eq!(fallen.capacity(9.0), Evidence::Within([0.1, 0.4]));
}

/// A number of cracked joints jumps somewhere between two runs, not at the upper one.
#[test]
fn counts_rise_by_jumps() {
    let cracked = curve(&[(4.1202, 1.0, false), (5.1012, 2.0, false)]);
    assert_eq!(cracked.capacity(2.0), Evidence::Within([4.1202, 5.1012]));
    let near = curve(&[(4.0, 20.0, false), (4.2, 21.0, false)]);
    let Evidence::At(found) = near.capacity(20.5) else { panic!("two near runs") };
    assert!((found / (4.0f64 * 4.2).sqrt() - 1.0).abs() < 1e-12, "{found}");
}

#[test]
fn fractiles_of_three_curves() {
    let curves = [1.0, 2.0, 4.0].map(|k| curve(&[(0.1, 0.1 * k, false), (1.0, k, false)]));
    let found = fractiles(&curves.iter().collect::<Vec<_>>());
    assert_eq!(found.len(), 60);
    for (y, [low, mid, high]) in found {
        assert!((mid / (2.0 * y) - 1.0).abs() < 1e-9 && (low / (1.32 * y) - 1.0).abs() < 1e-9);
        assert!((high / (3.36 * y) - 1.0).abs() < 1e-9, "{high}");
    }
}

/// Eleven of twelve curves collapse one after the other: each fractile becomes infinite in its turn, and no line is lost.
#[test]
fn fractiles_of_curves_that_collapse() {
    let mut curves: Vec<Curve> =
        (1..12).map(|k| curve(&[(0.1, 0.1, false), (0.1 + 0.05 * f64::from(k), 1.0, true)])).collect();
    curves.push(curve(&[(0.1, 0.1, false), (1.0, 1.0, false)]));
    let found = fractiles(&curves.iter().collect::<Vec<_>>());
    assert_eq!(found.len(), 60);
    // Of the fractile at place p = share × 11 among twelve, infinite values are met once more than 11 − ⌈p⌉ curves have gone.
    for (y, found) in found {
        let gone = curves.iter().filter(|c| c.damage(y) == Some(f64::INFINITY)).count();
        for (share, value) in [0.16, 0.5, 0.84].into_iter().zip(found) {
            let place: f64 = share * 11.0;
            assert_eq!(value.is_infinite(), gone > 11 - place.ceil() as usize, "{share} at {y}: {value}, {gone} gone");
            assert!(!value.is_nan());
        }
    }
}

/// What falls below a limit again is counted, and the lowest crossing is the capacity.
#[test]
fn curves_that_rise_again_are_counted() {
    let c = curve(&[(0.1, 1.0, false), (0.2, 3.0, false), (0.3, 1.5, false), (0.4, 5.0, false)]);
    assert_eq!((c.below_again(2.0), c.below_again(1.2), c.below_again(9.0)), (1, 0, 0));
    let (low, high) = c.bracket(2.0).expect("a crossing");
    assert_eq!((low.map(|p| p.intensity), high.intensity), (Some(0.1), 0.2));
}
