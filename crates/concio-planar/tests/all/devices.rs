//! Devices with laws of their own between blocks that rock, side by side.

use std::f64::consts::PI;

use concio_law::device::{BoucWen, Law as DeviceLaw, Power, ReCentring};
use concio_planar::body::Body;
use concio_planar::joint::{Device, Friction, Law, Normal, Shear};
use concio_planar::motion::{Forcing, Link, Motion, Setting, System};

/// Blocks of 0.4 m and 0.3 m × 1 m on the base, with a device across what is between them.
fn pair(law: DeviceLaw) -> System {
    let block = |x: [f64; 2]| Body::rectangle("block", x, [0.0, 1.0], (x[1] - x[0]) * 1800.0);
    let bodies = [[-0.1, 0.3], [0.3, 0.6]].map(block);
    let dry = Law::dry(Some(Friction::coulomb(0.7)));
    let between = Law {
        normal: Normal::Springs { both: 0.0, press: 0.0, damping: 0.0 },
        shear: Shear { stiffness: 0.0, damping: 0.0, series: false },
        device: Some(Device { direction: 0, law }),
        follows: true,
        ..Law::dry(None)
    };
    let links = vec![Link::closed(None, 0, dry), Link::closed(None, 1, dry), Link::closed(Some(0), 1, between)];
    System { links, ..System::dry(&bodies, 0.7) }
}

fn shaken(system: &System, step: f64, amplitude: f64, from: usize, to: usize, kept: Option<&Motion>) -> Motion {
    let mut motion = Motion::new(system, Setting::new(step));
    if let Some(kept) = kept {
        assert!(motion.take_up(kept.keep()));
    }
    let base = |t: f64| amplitude / (4.0 * PI) * (1.0 - (4.0 * PI * t).cos());
    for k in from..to {
        let at = [k as f64 * step, (k + 1) as f64 * step];
        motion.time = at[0];
        motion.go(step, &|from, to| Forcing { base: [base(to) - base(from), 0.0], held: 0.0 });
    }
    motion
}

fn laws() -> [DeviceLaw; 6] {
    let flag = |stiffness: f64, flag: f64| DeviceLaw::ReCentring(ReCentring { stiffness, activation: 2e-4, flag });
    let yields = |force: f64, sharpness: f64| {
        let law = BoucWen { force, displacement: 2e-4, amplitude: 1.0, beta: 0.6, gamma: 0.4, sharpness };
        DeviceLaw::BoucWen(law)
    };
    [
        DeviceLaw::Power(Power { damping: 2e3, velocity: 0.1, exponent: 0.3 }),
        yields(800.0, 2.0),
        yields(8e4, 30.0),
        flag(4e6, 0.8),
        flag(4e6, 0.0),
        flag(4e8, 0.8),
    ]
}

/// Whatever the law, how stiff it is and how long the step, blocks that rock and turn over keep their account, every step is solved, and a motion taken
/// up from the middle ends at the same bits.
#[test]
fn devices_between_rocking_blocks_make_nothing_of_nothing() {
    for law in laws() {
        for (step, amplitude) in [(1e-3, 7.0), (1e-3, 14.0), (4e-3, 7.0), (2e-2, 4.0), (2e-2, 7.0)] {
            let system = pair(law);
            let steps = (3.0 / step) as usize;
            let whole = shaken(&system, step, amplitude, 0, steps, None);
            let a = &whole.account;
            let taken = a.friction + a.impact + a.damping + a.device;
            let off = whole.kinetic() + a.elastic + taken - a.input;
            let counters = whole.counters;
            assert!(off.abs() < 1e-5 * a.input.abs().max(taken), "{law:?} {step} {amplitude}: {off:e} {a:?}");
            assert!(a.device >= 0.0 && a.damping >= 0.0 && a.friction >= 0.0, "{a:?}");
            assert_eq!(counters.unsolved, 0, "{law:?} {step} {amplitude}");
            let half = shaken(&system, step, amplitude, 0, steps / 2, None);
            let rest = shaken(&system, step, amplitude, steps / 2, steps, Some(&half));
            assert_eq!(rest.places, whole.places, "{law:?}");
        }
    }
}
