//! Parts of a joint that act alike, and the contact points that stand for each.
//!
//! What is open of a joint bears nothing, what is pressed bears as its springs do, what is pressed as hard as it can bears that. Blocks are rigid, so that over a step
//! the opening of a joint changes by a straight line along it. Two points with the first three moments of such a part (Gauss; Radau where it ends at
//! the end of the joint) bear what it does, to second order in how far its own ends move meanwhile. With inertia, what is open has its points at its ends. A zone that is alone has three, to be there wherever blocks come to touch next.

/// ∫ f x^k over a part of the joint for k of 0, 1 and 2, x going from 0 to 1 along the joint.
pub(crate) type Moments = [f64; 3];

/// Part of a joint below which there is none of a kind.
pub(crate) const LEAST: f64 = 1e-3;

/// What acts alike: any places of the joint.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Zone {
    /// Of what acts, 1 where all of the joint does.
    pub acts: Moments,
    /// Of what has cracked.
    pub cracked: Moments,
    /// Of what rubs, by 1 and x.
    pub rubs: [f64; 2],
    /// Of what acts by the gap that is left above what is crushed [m].
    pub gap: [f64; 2],
    /// Of what acts by the square of that gap [m²].
    pub square: f64,
    /// From where to where it reaches.
    pub between: [f64; 2],
}

/// What places are rounded by.
const ROUNDING: f64 = 1e-9;

/// The two places of Gauss's rule on the way from 0 to 1, ½ ∓ 1/√12.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Places of the points of what closes, over its length.
const CLOSING: [f64; 4] = [0.0, 0.02, 0.15, 1.0];
/// Gaps of the two in between at most, over what springs are pressed in by at most.
const NEAR: [f64; 2] = [0.5, 8.0];

/// What a zone is like at some place: what acts, what has cracked, what rubs, and its gap.
pub(crate) type Local = [f64; 4];

/// A part of the way from one to the other.
#[inline]
pub(crate) fn between<const N: usize>(from: &[f64; N], to: &[f64; N], part: f64) -> [f64; N] {
    std::array::from_fn(|k| from[k] + part * (to[k] - from[k]))
}

/// How far it goes on to hold on the way from 0 to `most`, or that.
fn up_to(most: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut less, mut more) = (0.0, most);
    while !holds(more) && more - less > ROUNDING {
        let half = 0.5 * (less + more);
        *if holds(half) { &mut less } else { &mut more } = half;
    }
    more
}

/// Three points and one of nothing.
pub(crate) fn padded([a, b, c]: [[f64; 2]; 3]) -> [[f64; 2]; 4] {
    [a, b, c, [c[0], 0.0]]
}

impl Zone {
    /// Takes in what lies between two places, and is as it is there and in between by straight lines.
    #[inline]
    pub fn add(&mut self, [(from, start), (to, end)]: [(f64, Local); 2]) {
        self.between =
            if self.acts[0] == 0.0 { [from, to] } else { [self.between[0].min(from), self.between[1].max(to)] };
        // Nothing is of more than third order.
        for part in GAUSS {
            let [acts, cracked, rubs, gap] = between(&start, &end, part);
            let (x, weight) = (from + part * (to - from), 0.5 * (to - from));
            for (k, power) in [1.0, x].into_iter().enumerate() {
                self.acts[k] += weight * acts * power;
                self.cracked[k] += weight * cracked * power;
                self.rubs[k] += weight * rubs * power;
                self.gap[k] += weight * acts * gap * power;
            }
            self.acts[2] += weight * acts * x * x;
            self.cracked[2] += weight * cracked * x * x;
            self.square += weight * acts * gap * gap;
        }
    }

    /// Whether there is any of it.
    pub fn is_there(&self) -> bool {
        self.acts[0] > LEAST
    }

    /// What acts of it: where its middle is, and its radius of gyration about that.
    fn middle(&self) -> [f64; 2] {
        let [all, first, second] = self.acts;
        let centre = first / all;
        [centre, (second / all - centre * centre).max(0.0).sqrt()]
    }

    /// The straight line that has these sums, over what acts, at some places.
    pub fn line(&self, [all, first]: [f64; 2]) -> impl Fn(f64) -> f64 {
        let [centre, radius] = self.middle();
        let mean = all / self.acts[0];
        let slope = if radius > 0.0 { (first - centre * all) / (self.acts[0] * radius * radius) } else { 0.0 };
        move |x| mean + slope * (x - centre)
    }

    /// Two points with its moments: where they are and how much of the joint acts there. Of given ends of the joint one is taken that it alone has.
    pub fn two(&self, ends: Option<[f64; 2]>) -> [[f64; 2]; 3] {
        let [from, to] = self.between;
        let [all, first, second] = self.acts;
        let has = ends.map(|[near, far]| [(from <= near + ROUNDING, near), (to >= far - ROUNDING, far)]);
        let edge = match has {
            Some([(true, near), (false, _)]) => near,
            Some([(false, _), (true, far)]) => far,
            _ => {
                let [centre, radius] = self.middle();
                return [[centre - radius, 0.5 * all], [centre + radius, 0.5 * all], [centre, 0.0]];
            }
        };
        let [first, second] = [first - edge * all, second - edge * (2.0 * first - edge * all)];
        let [inside, at] = if second > 0.0 { [first * first / second, second / first] } else { [0.0; 2] };
        [[edge, all - inside], [edge + at, inside], [edge, 0.0]]
    }

    /// Two points at its ends, which bear no less than the zone wherever it closes: the energy of a spring without tension is convex along the joint. Other points
    /// are pressed in too late, and the joint would store energy that nothing gave. A zone that is there is longer than [`LEAST`].
    pub fn ends(&self) -> [[f64; 2]; 3] {
        let ([from, to], [all, first, _]) = (self.between, self.acts);
        let last = (first - from * all) / (to - from);
        [[from, all - last], [to, last], [from, 0.0]]
    }

    /// Points at its ends and in between, the closer to each other the nearer to the end where its gap, which is `apart`, is smaller: what closes of it in a step is as
    /// narrow then as what a joint closes. A gap that widens fast is closed in part by what its springs are pressed in by at most, `deep`. They bear no less than the zone,
    /// as points at its ends do, and of what those lose as they are placed anew hardly anything.
    pub fn closing(&self, apart: &impl Fn(f64) -> f64, deep: f64) -> [[f64; 2]; 4] {
        let ([from, to], [[_, near], [_, far], _]) = (self.between, self.ends());
        let first = apart(from) <= apart(to);
        let place = |part: f64| if first { from + part * (to - from) } else { to - part * (to - from) };
        let within = |part: f64, gap: f64| up_to(part, |part| apart(place(part)) <= gap * deep);
        let [start, close, farther, end] = CLOSING;
        let close = within(close, NEAR[0]);
        let places = [start, close, within(farther, NEAR[1]).max(2.0 * close), end].map(place);
        // Of the straight line that acts so much at its ends: none where that is below 0 at one of them, as of two parts.
        let [start, end] = [2.0 * near - far, 2.0 * far - near].map(|acts| 2.0 * acts / (to - from));
        if start < 0.0 || end < 0.0 {
            return padded([[from, near], [to, far], [from, 0.0]]);
        }
        let acts = |at: f64| start + (at - from) / (to - from) * (end - start);
        let mut points = places.map(|at| [at, 0.0]);
        for k in 1..places.len() {
            let [a, b] = [places[k - 1], places[k]];
            points[k - 1][1] += (b - a).abs() / 6.0 * (2.0 * acts(a) + acts(b));
            points[k][1] += (b - a).abs() / 6.0 * (acts(a) + 2.0 * acts(b));
        }
        points
    }

    /// Three points with its moments, where it is all there is between these ends: at either end, wherever blocks come to touch next, and in the middle. Two where one of them would pull.
    pub fn three(&self, ends: [f64; 2]) -> [[f64; 2]; 3] {
        let [from, to] = ends;
        let ([all, first, second], length) = (self.acts, to - from);
        let [first, second] =
            [(first - from * all) / length, (second - from * (2.0 * first - from * all)) / (length * length)];
        let shares = [all - 3.0 * first + 2.0 * second, 4.0 * (first - second), 2.0 * second - first];
        let three = [0, 1, 2].map(|k| [from + 0.5 * k as f64 * length, shares[k]]);
        if shares.iter().all(|share| *share >= 0.0) { three } else { self.two(None) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points have the moments of their zone, and bear to second order what a layer of springs does whose pressed part has moved on.
    #[test]
    fn points_stand_for_their_zone() {
        for (places, cracked) in [([0.0, 0.3], [1.0, 1.0]), ([0.4, 1.0], [0.2, 0.9]), ([0.2, 0.7], [1.0, 0.1])] {
            let mut zone = Zone::default();
            zone.add([0, 1].map(|k| (places[k], [cracked[k], cracked[k], 0.5 * cracked[k], k as f64 - 0.3])));
            let close = |found: &[[f64; 2]]| {
                (0..3).all(|k| {
                    let moment: f64 = found.iter().map(|[at, share]| share * at.powi(k)).sum();
                    (moment - zone.acts[k as usize]).abs() < 1e-15
                })
            };
            assert!(close(&zone.two(Some([0.0, 1.0]))) && close(&zone.three(places)));
            let gap = zone.line(zone.gap);
            assert!(places.iter().zip([-0.3, 0.7]).all(|(at, expected)| (gap(*at) - expected).abs() < 1e-12));
        }
        // What closes bears no less than its zone, however far it does.
        let mut opened = Zone::default();
        opened.add([0.2, 0.8].map(|at| (at, [1.0 - 0.5 * at, 1.0, 1.0, at - 0.2])));
        for places in [opened.ends().to_vec(), opened.closing(&|at| at - 0.2, 0.01).to_vec()] {
            let stored = |way: f64| places.iter().map(|[at, acts]| acts * (way - at).max(0.0).powi(2)).sum::<f64>();
            let zone = |way: f64| {
                let (closed, acts) = (way - 0.2, 1.0 - 0.5 * way);
                acts * closed.powi(3) / 3.0 + 0.5 * closed.powi(4) / 4.0
            };
            let [all, first] = [0, 1].map(|k| places.iter().map(|[at, acts]| acts * at.powi(k)).sum::<f64>());
            assert!((all - opened.acts[0]).abs() < 1e-12 && (first - opened.acts[1]).abs() < 1e-12);
            assert!([0.21, 0.3, 0.5, 0.8].into_iter().all(|way| stored(way) >= zone(way)));
        }
        let mut pressed = Zone::default();
        pressed.add([0.0, 0.25].map(|at| (at, [1.0, 1.0, 1.0, 0.0])));
        let points = pressed.two(Some([0.0, 1.0]));
        let off = |part: f64| {
            let end = 0.25 * (1.0 + part);
            let borne: f64 = points.iter().map(|[at, share]| share * (end - at).max(0.0)).sum();
            (borne / (0.5 * end * end) - 1.0).abs()
        };
        let [coarse, fine] = [off(0.08), off(0.04)];
        assert!(coarse < 0.01 && (coarse / fine - 4.0).abs() < 0.3, "{coarse} {fine}");
    }
}
