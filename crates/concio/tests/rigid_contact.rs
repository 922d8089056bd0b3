//! Rigid unilateral contact with Newton's law of impact, against closed forms and hand calculation.

use concio::case::{Pulse, PulseShape, Scheme, Signal, Solver};
use concio::excitation::Excitation;
use concio::ground::signal::compile;
use concio::model::Model;
use concio::record::StopReason;
use concio::samples::{Link, lumped, solver};
use concio::simulate::{Progress, Sampling, Simulation};
use concio::wall::End;

const M: f64 = 100.0;

fn fine(tolerance: f64) -> Solver {
    solver(Scheme::TrBdf2, tolerance)
}

/// A base acceleration of −a from t = 0 on, which presses blocks onto a contact with the base on their right.
fn pushing(a: f64, duration: f64) -> Excitation {
    let pulse = Pulse {
        shape: PulseShape::Rectangular,
        acceleration: (-a).into(),
        duration: (2.0 * duration).into(),
        start: 0.0.into(),
    };
    Excitation::of_base(compile(&Signal::Pulse(pulse), std::path::Path::new("")).unwrap(), duration)
}

/// Runs step by step; after each, `look` sees the simulation.
fn watch(model: &Model, solver: &Solver, z: &[f64], v: &[f64], mut look: impl FnMut(&Simulation)) -> StopReason {
    let sampling = Sampling { interval: model.excitation.duration, frame_every: 0, blocks: vec![], joints: vec![] };
    let mut run = Simulation::new(model, solver, &sampling).unwrap();
    run.start_from(z, v);
    loop {
        let progress = run.advance(1);
        look(&run);
        run.clear_recording();
        if let Progress::Ended(reason) = progress {
            return reason;
        }
    }
}

/// A block falls by g = 10 m/s² from 1 mm and bounces: instants of the impacts t_1 (1 + 2 Σ e^k), heights e^{2k} H.
#[test]
fn bouncing_block() {
    let (a, height) = (10.0, 1e-3f64);
    for e in [0.5, 0.8] {
        let first = (2.0 * height / a).sqrt();
        let end = first * (1.0 + e) / (1.0 - e);
        let model = lumped(&[M], &[Link::rigid(0, End::Base, e)], pushing(a, 1.1 * end));
        let mut times = Vec::new();
        let mut seen = 0;
        let mut deepest = 0.0f64;
        let reason = watch(&model, &fine(1e-9), &[-height], &[0.0], |run| {
            deepest = deepest.max(run.state().z[0]);
            if run.state().counters.impacts > seen {
                seen = run.state().counters.impacts;
                times.push(run.time());
            }
        });
        assert_eq!(reason, StopReason::Completed);
        let mut exact = first;
        for (k, t) in times.iter().take(30).enumerate() {
            assert!((t / exact - 1.0).abs() < 1e-6, "e = {e}, impact {k}: {t} against {exact}");
            exact += 2.0 * first * e.powi(k as i32 + 1);
        }
        // Bounces lower than 1e-13 m are none.
        let expected = ((1e-13 / height).ln() / (2.0 * e.ln())).ceil() as usize;
        assert!(times.len().abs_diff(expected) <= 1, "{} impacts instead of {expected}", times.len());
        assert!(deepest <= 1e-12, "{deepest:e}");
        let last = times.last().unwrap();
        assert!((last / end - 1.0).abs() < 1e-6, "bounces end at {last} instead of {end}");
    }
}
