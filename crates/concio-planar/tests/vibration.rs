//! Small vibrations against the closed form of two unknowns.

use concio_planar::body::Body;
use concio_planar::joint::{Law, Normal, Shear};
use concio_planar::motion::{Link, Motion, Setting, System};

const LENGTH: f64 = 0.4;
const HEIGHT: f64 = 1.1;
const MASS: f64 = 90.0;
const ACROSS: f64 = 6e7;
const ALONG: f64 = 2e7;

/// A block on a joint with springs, both ways or in compression only.
fn block(normal: Normal, lets_go: bool) -> Motion {
    let body = Body::rectangle("b", [0.0, LENGTH], [0.0, HEIGHT], MASS);
    let mut law = Law::dry(Some(concio_planar::joint::Friction::coulomb(0.6)));
    law.normal = normal;
    law.shear = Shear { stiffness: ALONG, damping: 300.0, series: lets_go };
    let system = System { links: vec![Link { a: None, b: 0, law }], ..System::dry(&[body], 0.6) };
    let mut motion = Motion::new(&system, Setting::new(1e-4));
    assert!(motion.stand(1e-10, 400));
    motion
}

/// K of sway u of the centre and turn θ: the foot moves by u + θ H/2, and ∫ x² over the joint is k_n L²/12.
fn expected() -> f64 {
    let lever = 0.5 * HEIGHT;
    let inertia = MASS * (LENGTH * LENGTH + HEIGHT * HEIGHT) / 12.0;
    let (a, b) = (ALONG / MASS, ALONG * lever / (MASS * inertia).sqrt());
    let d = (ALONG * lever * lever + ACROSS * LENGTH * LENGTH / 12.0) / inertia;
    (0.5 * (a + d) - (0.25 * (a - d) * (a - d) + b * b).sqrt()).sqrt()
}

#[test]
fn a_block_on_springs_sways_as_two_unknowns_do() {
    let both = Normal::Springs { both: ACROSS, press: 0.0, damping: 0.0 };
    let press = Normal::Springs { both: 0.0, press: ACROSS, damping: 0.0 };
    for (normal, lets_go) in [(both, false), (press, true)] {
        let found = block(normal, lets_go).slowest().expect("it is held");
        // Under its weight it stands 15 µm lower than it was laid.
        assert!((found.frequency / expected() - 1.0).abs() < 5e-5, "{found:?} instead of {}", expected());
        assert!(found.damping > 0.0, "{found:?}");
    }
}

/// On a rigid joint that gives way along alone, as on an isolator, it only sways; where nothing gives way it does not.
#[test]
fn a_rigid_joint_holds_what_it_bears() {
    let found = block(Normal::Rigid { restitution: 0.0 }, false).slowest().expect("it sways");
    assert!((found.frequency / (ALONG / MASS).sqrt() - 1.0).abs() < 1e-5, "{found:?}");
    assert!((found.damping / (300.0 / (2.0 * (ALONG * MASS).sqrt())) - 1.0).abs() < 1e-4, "{found:?}");
    let body = Body::rectangle("b", [0.0, LENGTH], [0.0, HEIGHT], MASS);
    let mut motion = Motion::new(&System::dry(&[body], 0.6), Setting::new(1e-4));
    assert!(motion.stand(1e-10, 400));
    assert_eq!(motion.slowest(), None);
}
