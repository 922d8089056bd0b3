//! Blocks of a planar wall that can neither rise nor turn are those of the shear model: same masses, stiffnesses and dashpots, so
//! that the same rule of integration gives the same motion. Without friction, whose pressure the two models take from elsewhere, and
//! with joints that do not open, whose dashpots let go in a planar wall alone.

use std::path::Path;

use concio::case::{Beam, Case, FrictionLaw, ModelKind, Signal, SpringLaw, Syntax, from_str};
use concio::model::Model;
use concio::run::prepare;
use concio_planar::motion::{Forcing, Motion, Setting};

const STEP: f64 = 1e-4;
const STEPS: usize = 400;

/// A pulse of the base to and fro, as change of its velocity in step `k`.
fn push(k: usize) -> f64 {
    STEP * 1e4 * (k as f64 * STEP * 400.0).sin()
}

fn compiled(mut case: Case, model: ModelKind) -> Model {
    case.model = model;
    case.load.beam = Beam::Free;
    case.motion.top = Signal::None;
    case.joint.friction.law = FrictionLaw::None;
    case.joint.friction.preset = None;
    case.motion.duration = Some(concio::quantity::Time::from_si(1.0));
    prepare(case, Path::new("examples")).expect("a wall").model
}

/// Displacements of the locked planar wall.
fn locked(model: &Model) -> Vec<f64> {
    let mut system = model.planar.as_ref().expect("a planar wall").system.clone();
    system.held.fill([false, true, true]);
    system.load.fill([0.0; 2]);
    let start: Vec<f64> = system.bodies.iter().map(|b| b.centre[0]).collect();
    let mut motion = Motion::new(&system, Setting { tolerance: 1e-13, ..Setting::new(STEP) });
    for k in 0..STEPS {
        motion.step(Forcing { base: [push(k), 0.0], held: 0.0 });
    }
    motion.places.iter().zip(start).map(|(p, x)| p.centre[0] - x).collect()
}

/// The midpoint rule on the shear model.
fn sheared(model: &Model) -> Vec<f64> {
    let n = model.mass.len();
    let (mut z, mut v) = (vec![0.0; n], vec![0.0; n]);
    let at = |x: &[f64], i: u32| x.get(i as usize).copied().unwrap_or(0.0);
    for k in 0..STEPS {
        // (M + Σ …) v_1 = M (v_0 − Δ) − Σ …
        let mut matrix = vec![vec![0.0; n]; n];
        let mut right: Vec<f64> = (0..n).map(|i| model.mass[i] * (v[i] - push(k))).collect();
        (0..n).for_each(|i| matrix[i][i] = model.mass[i]);
        for (law, &[a, b]) in model.elastic.iter().zip(&model.sides) {
            let (d, w) = (at(&z, a) - at(&z, b), at(&v, a) - at(&v, b));
            let rho = 0.5 * STEP * (law.damping + 0.5 * STEP * law.stiffness);
            let offset = STEP * law.stiffness * d + rho * w;
            let (a, b) = (a as usize, b as usize);
            for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                if i < n && j < n {
                    matrix[i][j] += sign * rho;
                }
            }
            for (i, sign) in [(a, -1.0), (b, 1.0)] {
                if i < n {
                    right[i] += sign * offset;
                }
            }
        }
        let after = solved(matrix, right);
        for i in 0..n {
            z[i] += 0.5 * STEP * (v[i] + after[i]);
        }
        v = after;
    }
    z
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
    let first = case(include_str!("../../../examples/01-first-wall.toml"));
    let irregular = case(include_str!("../../../examples/03-irregular-texture.toml"));
    let two = case(include_str!("../../../examples/04-two-panels.toml"));
    for (name, case) in [("first", elastic(first)), ("irregular", elastic(irregular)), ("two panels", elastic(two))] {
        let planar = locked(&compiled(case.clone(), ModelKind::Planar));
        let shear = sheared(&compiled(case, ModelKind::Shear));
        let size = shear.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let off = planar.iter().zip(&shear).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{name}: off by {off:e} of {size:e}");
        assert!(size > 1e-4 && off <= 1e-12 * size, "{name}: off by {off:e} of {size:e}");
    }
}
