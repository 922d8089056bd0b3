//! Blocks of a planar wall that can neither rise nor turn are those of the shear model: same masses, stiffnesses and dashpots, so
//! that the same rule of integration gives the same motion. Without friction, whose pressure the two models take from elsewhere, and
//! without dashpots where joints open: those of a planar wall let go with the joint, those of the shear model act on.

use std::path::Path;

use concio::case::{Beam, Case, FrictionLaw, ModelKind, Signal, SpringLaw, Syntax, from_str};
use concio::model::Model;
use concio::run::prepare_case;
use concio_planar::motion::{Forcing, Motion, Setting};

const STEP: f64 = 1e-4;
const STEPS: usize = 400;
/// Fewer where joints open and close again: those that hardly do multiply what positions are rounded by tenfold and more.
const STEPS_OPEN: usize = 75;

/// A pulse of the base to and fro, as change of its velocity in step `k`: so large that what positions are rounded by, some 10⁻¹⁵ m in all
/// whatever the motion, is little beside it.
fn push(k: usize) -> f64 {
    STEP * 4e4 * (k as f64 * STEP * 400.0).sin()
}

fn compiled(mut case: Case, model: ModelKind) -> Model {
    case.model = model;
    case.load.beam = Beam::Free;
    // With the mass of the floor the wall would slide by metres.
    case.load.mass = Some(concio::quantity::Mass::from_si(0.0));
    case.motion.top = Signal::None;
    case.joint.friction.law = FrictionLaw::None;
    case.joint.friction.preset = None;
    case.motion.duration = Some(concio::quantity::Time::from_si(1.0));
    prepare_case(case, Path::new("examples")).expect("a wall").model
}

/// Displacements of the locked planar wall after each step.
fn locked(model: &Model, steps: usize) -> Vec<Vec<f64>> {
    let mut system = model.planar().expect("a planar wall").system.clone();
    system.held.fill([false, true, true]);
    system.load.fill([0.0; 2]);
    let start: Vec<f64> = system.bodies.iter().map(|b| b.centre[0]).collect();
    let mut motion = Motion::new(&system, Setting { tolerance: 1e-13, ..Setting::new(STEP) });
    let mut history = Vec::with_capacity(steps);
    for k in 0..steps {
        motion.step(Forcing { base: [push(k), 0.0], held: 0.0 });
        history.push(motion.places.iter().zip(&start).map(|(p, x)| p.centre[0] - x).collect());
    }
    history
}

/// What a spring bears at the end of a step: offset − ρ u, `u` being the velocity with which its sides part.
struct Spring {
    sides: [usize; 2],
    offset: f64,
    rho: f64,
    /// In compression only.
    lets_go: bool,
}

impl Spring {
    fn bears(&self, v: &[f64]) -> f64 {
        let at = |i: usize| v.get(i).copied().unwrap_or(0.0);
        self.offset - self.rho * (at(self.sides[1]) - at(self.sides[0]))
    }
}

/// The rules of planar joints on the shear model: midpoint where springs act in both directions, (P6) at three points that stand for
/// a sixth, two thirds and a sixth of a joint where they let go. Displacements after each step, and how many springs let go or took
/// up within one.
fn sheared(model: &Model, steps: usize) -> (Vec<Vec<f64>>, usize) {
    let n = model.shear.mass.len();
    let (mut z, mut v) = (vec![0.0; n], vec![0.0; n]);
    let at = |x: &[f64], i: usize| x.get(i).copied().unwrap_or(0.0);
    let (mut acts, mut changes) = (Vec::new(), 0);
    let mut history = Vec::with_capacity(steps);
    for k in 0..steps {
        let mut springs = Vec::new();
        for (law, &sides) in model.shear.elastic.iter().zip(&model.shear.sides) {
            let sides = sides.map(|i| i as usize);
            let (gap, u) = (at(&z, sides[1]) - at(&z, sides[0]), at(&v, sides[1]) - at(&v, sides[0]));
            if !law.unilateral {
                let rho = 0.5 * STEP * (law.damping + 0.5 * STEP * law.stiffness);
                springs.push(Spring { sides, offset: -STEP * law.stiffness * gap - rho * u, rho, lets_go: false });
                continue;
            }
            assert!(law.damping == 0.0);
            let light = sides.iter().filter_map(|i| model.shear.mass.get(*i)).map(|m| 1.0 / m).sum::<f64>();
            for share in [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0] {
                let stiffness = share * law.stiffness;
                let x = STEP * STEP * law.stiffness * light / 16.0;
                let theta = if gap > 1e-12 { 1.0 } else { 0.5 + (0.5 * x / (1.0 + x)).min(0.0625 / x.sqrt()) };
                let offset = -STEP * stiffness * (gap + 0.5 * theta * STEP * u);
                springs.push(Spring { sides, offset, rho: 0.5 * STEP * STEP * stiffness * theta, lets_go: true });
            }
        }
        acts.resize(springs.len(), true);
        let before = acts.clone();
        let after = loop {
            let mut matrix = vec![vec![0.0; n]; n];
            let mut right: Vec<f64> = (0..n).map(|i| model.shear.mass[i] * (v[i] - push(k))).collect();
            (0..n).for_each(|i| matrix[i][i] = model.shear.mass[i]);
            for spring in springs.iter().zip(&acts).filter(|(_, acts)| **acts).map(|(spring, _)| spring) {
                let [a, b] = spring.sides;
                for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                    if i < n && j < n {
                        matrix[i][j] += sign * spring.rho;
                    }
                }
                for (i, sign) in [(a, -1.0), (b, 1.0)] {
                    if i < n {
                        right[i] += sign * spring.offset;
                    }
                }
            }
            let after = solved(matrix, right);
            let now: Vec<bool> = springs.iter().map(|s| !s.lets_go || s.bears(&after) > 0.0).collect();
            if now == acts {
                break after;
            }
            acts = now;
        };
        changes += before.iter().zip(&acts).filter(|(a, b)| a != b).count();
        for i in 0..n {
            z[i] += 0.5 * STEP * (v[i] + after[i]);
        }
        v = after;
        history.push(z.clone());
    }
    (history, changes)
}

/// Gauss, with pivots down the diagonal of a positive definite matrix.
fn solved(mut a: Vec<Vec<f64>>, mut x: Vec<f64>) -> Vec<f64> {
    let n = x.len();
    for k in 0..n {
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            if factor != 0.0 {
                for j in k..n {
                    a[i][j] -= factor * a[k][j];
                }
                x[i] -= factor * x[k];
            }
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| a[k][j] * x[j]).sum();
        x[k] = (x[k] - sum) / a[k][k];
    }
    x
}

#[test]
fn locked_walls_are_those_of_the_shear_model() {
    let case = |text: &str| from_str(text, Syntax::Toml, None).expect("an example").case;
    let elastic = |mut case: Case| {
        case.joint.head.law = SpringLaw::Elastic;
        case.joint.connection.iter_mut().for_each(|spring| spring.law = SpringLaw::Elastic);
        case
    };
    let first = case(include_str!("../data/shear-panel.toml"));
    let irregular = case(include_str!("../data/irregular.toml"));
    let two = case(include_str!("../../../../examples/studies/two-panels.toml"));
    let opening = |mut case: Case| {
        case.joint.head.damping_ratio = Some(0.0);
        case.joint.connection.iter_mut().for_each(|spring| spring.damping_ratio = Some(0.0));
        case
    };
    let walls = [("first", first), ("irregular", irregular), ("two panels", two)];
    for (name, case, opens) in
        walls.into_iter().flat_map(|(name, case)| [(name, elastic(case.clone()), false), (name, opening(case), true)])
    {
        let steps = if opens { STEPS_OPEN } else { STEPS };
        let planar = locked(&compiled(case.clone(), ModelKind::Planar), steps);
        let (shear, changes) = sheared(&compiled(case, ModelKind::Shear), steps);
        let size = shear.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        let both = planar.iter().flatten().zip(shear.iter().flatten());
        let off = both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{name}: off by {off:e} of {size:e}, {changes} times a spring let go or took up");
        assert!((changes > 100) == opens, "{name}: {changes}");
        assert!(size > 1e-4 && off <= 1e-12 * size, "{name}: off by {off:e} of {size:e}");
    }
}
