//! The closed form beside the program: all that stands above a level joint turns as one about its edge.
//!
//! With hinge at height z₀ and outermost along the push, s behind it and h = z − z₀ above it, velocities per unit turn are h
//! along the push and s upwards:
//!
//! (S10) α₀ = [ Σ W s + Σ P s − Σ H h + Σ Y max(0, e) ] / [ Σ W h + Σ Q h ]
//!
//! Where stones crush, the hinge lies where it makes α₀ least; f ∫ (s′ − s) dA of what is pressed beyond it joins the numerator.
//! The pressure f beyond the hinge then bears all that stands above, (S6).
//!
//! with dead forces P and H downwards and along the push, pushing weights Q, ties of yield force Y and stretch e. It is a
//! mechanism of (S4), so none of its values is below λ. For one body it is the multiplier of vertical overturning of building
//! codes: Circolare 21.1.2019 n. 7, C8.7.1.

use super::Problem;
use super::assembly::{ContactKind, Vector, dot, length, minus, plus, scaled};

/// A hinge and its multiplier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turning {
    /// α₀ of (S10).
    pub multiplier: f64,
    /// Height of the hinge [m].
    pub level: f64,
}

/// A level joint.
struct Joint {
    /// Ends along the push [m].
    span: [f64; 2],
    /// Normal force at which it crushes [N]; none: it does not.
    bears: Option<f64>,
}

impl Joint {
    /// f ∫ (s − edge) dA of what lies beyond the edge [N m].
    fn crushed(&self, edge: f64) -> f64 {
        let [near, far] = self.span;
        let moment = |from: f64| 0.5 * ((far - edge).powi(2) - (from - edge).powi(2));
        let per_length = self.bears.unwrap_or(0.0) / (far - near);
        if edge < far { per_length * moment(near.max(edge)) } else { 0.0 }
    }
}

/// Thirds taken off until the place of a hinge is exact.
const NARROWER: usize = 100;
/// Heights nearer than this part of the wall's height are one.
const ONE: f64 = 1e-6;

impl Problem {
    /// The least α₀ of (S10) over the level joints through which no block reaches; none where there is no such joint, where a
    /// support or an abutment stands in the way, and where the push is not level.
    pub fn turning(&self) -> Option<Turning> {
        let up = scaled(self.down, -1.0 / length(self.down));
        let push = scaled(self.direction, 1.0 / length(self.direction));
        if dot(up, push).abs() > 1e-9 {
            return None;
        }
        let level = |c: &super::Contact| dot(c.middle(), up);
        let beds = || self.assembly.contacts.iter().filter(|c| c.kind != ContactKind::Head);
        let mut levels: Vec<f64> = beds().map(level).collect();
        levels.sort_by(f64::total_cmp);
        let spans: Vec<[f64; 2]> = self.assembly.bodies.iter().map(|b| span(&b.corners, up)).collect();
        let tall = spans.iter().map(|s| s[1]).fold(f64::NEG_INFINITY, f64::max) - levels.first()?;
        let near = ONE * tall;
        levels.dedup_by(|a, b| *a - *b < near);
        let of = |z: f64| -> Option<Turning> {
            // A joint of mortar is a line in its middle, which no block reaches.
            let above: Vec<bool> = spans.iter().map(|s| s[0] >= z - near).collect();
            if spans.iter().zip(&above).any(|(s, above)| !above && s[1] > z + near) {
                return None;
            }
            let here = |c: &super::Contact| c.kind != ContactKind::Head && (level(c) - z).abs() <= near;
            let joints = self.assembly.contacts.iter().enumerate().filter(|(_, c)| here(c));
            let joints: Vec<Joint> = joints.map(|(k, c)| self.joint(k, c, push)).collect::<Option<_>>()?;
            self.at(z, &joints, &above, [up, push])
        };
        levels.into_iter().filter_map(of).min_by(|a, b| a.multiplier.total_cmp(&b.multiplier))
    }

    /// Where a contact lies along the push; none where it crushes and lies askew.
    fn joint(&self, index: usize, contact: &super::Contact, push: Vector) -> Option<Joint> {
        let span = span(&contact.corners, push);
        let askew = [1, 3].into_iter().any(|k| {
            let side = minus(contact.corners[k], contact.corners[0]);
            let along = dot(side, push).abs();
            along > 1e-6 * length(side) && along < (1.0 - 1e-6) * length(side)
        });
        let bears = self.bears.get(index).copied();
        (bears.is_none() || !askew).then_some(Joint { span, bears })
    }

    fn at(&self, level: f64, joints: &[Joint], above: &[bool], ways: [Vector; 2]) -> Option<Turning> {
        let outermost = joints.iter().map(|j| j.span[1]).fold(f64::NEG_INFINITY, f64::max);
        let own = |edge: f64| self.about(level, edge, above, ways);
        if joints.iter().any(|j| j.bears.is_none()) {
            return own(outermost).map(|[resists, pushes]| Turning { multiplier: resists / pushes, level });
        }
        let crushes = |edge: f64| {
            let crushed: f64 = joints.iter().map(|j| j.crushed(edge)).sum();
            own(edge).map(|[resists, pushes]| (resists + crushed) / pushes)
        };
        // Convex in the place of the hinge.
        let innermost = joints.iter().map(|j| j.span[0]).fold(f64::INFINITY, f64::min);
        let (mut low, mut high) = (innermost, outermost);
        for _ in 0..NARROWER {
            let third = (high - low) / 3.0;
            if crushes(low + third)? < crushes(high - third)? { high -= third } else { low += third }
        }
        Some(Turning { multiplier: crushes(0.5 * (low + high))?, level })
    }

    /// Numerator of (S10) without what crushes, and denominator.
    fn about(&self, level: f64, edge: f64, above: &[bool], [up, push]: [Vector; 2]) -> Option<[f64; 2]> {
        let velocity = |p: Vector| plus(scaled(push, dot(p, up) - level), scaled(up, edge - dot(p, push)));
        let moves = |body: usize| above[body];
        let blocked = |s: &super::Support| moves(s.body) && dot(velocity(s.at), s.direction) < 0.0;
        let leans = |c: &super::Contact| moves(c.a) && c.b.is_none() && c.kind == ContactKind::Head;
        let holds = (0..above.len()).any(|i| moves(i) && self.held[i]);
        if holds || self.supports.iter().any(blocked) || self.assembly.contacts.iter().any(leans) {
            return None;
        }
        let (mut resists, mut pushes) = (0.0, 0.0);
        for (i, body) in self.assembly.bodies.iter().enumerate().filter(|(i, _)| moves(*i)) {
            let v = velocity(body.centre);
            resists += body.weight * dot(v, up);
            pushes += if self.pushed[i] { body.weight * dot(v, push) } else { 0.0 };
        }
        for load in self.loads.iter().filter(|l| moves(l.body)) {
            let v = velocity(load.at);
            resists -= dot(load.force, v);
            pushes += load.pushes * dot(v, push);
        }
        for tie in &self.ties {
            let along = minus(tie.at, tie.end);
            let ends = [(tie.at, Some(tie.body)), (tie.end, tie.to)];
            let [a, b] = ends.map(|(p, body)| if body.is_some_and(moves) { velocity(p) } else { [0.0; 3] });
            resists += tie.yields * (dot(minus(a, b), along) / length(along)).max(0.0);
        }
        (pushes > 0.0).then_some([resists, pushes])
    }
}

/// Lowest and highest corner.
fn span(corners: &[Vector], up: Vector) -> [f64; 2] {
    corners
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], c| [low.min(dot(*c, up)), high.max(dot(*c, up))])
}
