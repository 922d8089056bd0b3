//! Small vibrations against the closed form of two unknowns, and what a step takes from those that it does not resolve.

use concio_planar::body::Body;
use concio_planar::joint::{Law, Normal, Shear};
use concio_planar::motion::{Forcing, Link, Motion, Setting, System};
use concio_verified::agrees;

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
    let system = System { links: vec![Link::closed(None, 0, law)], ..System::dry(&[body], 0.6) };
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
        let subject = format!(
            "Springs: block that sways and turns on its joint, ω₁; {}",
            if lets_go { "no tension" } else { "elastic" }
        );
        agrees!(subject, "the lower root of two unknowns, u and θ", "rad/s", found.frequency, expected(), 5e-5);
        assert!(found.damping > 0.0, "{found:?}");
    }
}

/// On a rigid joint that gives way along alone, as on an isolator, it only sways; where nothing gives way it does not.
#[test]
fn a_rigid_joint_holds_what_it_bears() {
    let found = block(Normal::Rigid { restitution: 0.0, rocking: 1.0 }, false).slowest().expect("it sways");
    let (omega, ratio) = ((ALONG / MASS).sqrt(), 300.0 / (2.0 * (ALONG * MASS).sqrt()));
    agrees!("Springs: rigid joint that gives way along, ω", "√(k/m)", "rad/s", found.frequency, omega, 1e-5);
    agrees!("Springs: rigid joint that gives way along, damping ratio", "c/(2 √(k m))", "", found.damping, ratio, 1e-4);
    let body = Body::rectangle("b", [0.0, LENGTH], [0.0, HEIGHT], MASS);
    let mut motion = Motion::new(&System::dry(&[body], 0.6), Setting::new(1e-4));
    assert!(motion.stand(1e-10, 400));
    assert_eq!(motion.slowest(), None);
}

/// Rigid blocks on each other, the lowest on a bearing that gives way along, sway as one however many they are.
#[test]
fn a_tall_stack_of_rigid_joints_sways_on_what_gives_way_below() {
    for courses in [10, 60, 200] {
        let level = |k: usize| k as f64 * 0.2;
        let bodies: Vec<Body> =
            (0..courses).map(|k| Body::rectangle("b", [0.0, LENGTH], [level(k), level(k + 1)], MASS)).collect();
        let mut bearing = Law::dry(None);
        bearing.shear = Shear { stiffness: ALONG, damping: 0.0, series: false };
        let mut links = vec![Link::closed(None, 0, bearing)];
        let dry = Law::dry(Some(concio_planar::joint::Friction::coulomb(0.6)));
        links.extend((1..courses).map(|b| Link::closed(Some(b - 1), b, dry)));
        let mut motion = Motion::new(&System { links, ..System::dry(&bodies, 0.6) }, Setting::new(1e-3));
        assert!(motion.stand(1e-10, 400));
        let expected = (ALONG / (MASS * courses as f64)).sqrt();
        let found = motion.slowest().unwrap_or_else(|| panic!("{courses} courses sway"));
        let subject = format!("Springs: stack of rigid courses on a bearing, ω₁; {courses}");
        agrees!(subject, "√(k/(n m))", "rad/s", found.frequency, expected, 1e-3);
    }
}

/// Two blocks beside each other of which one is heavier by as little as told: the slower counts.
#[test]
fn blocks_nearly_alike_sway_nearly_alike() {
    for more in [0.0, 1e-5, 1e-4, 1e-3, 1e-2] {
        let bodies =
            [0.0, 3.0].map(|x| Body::rectangle("b", [x, x + LENGTH], [0.0, HEIGHT], MASS * (1.0 + x / 3.0 * more)));
        let law = Law {
            normal: Normal::Springs { both: ACROSS, press: 0.0, damping: 0.0 },
            shear: Shear { stiffness: ALONG, damping: 0.0, series: false },
            ..Law::dry(Some(concio_planar::joint::Friction::coulomb(0.6)))
        };
        let links = [0, 1].map(|b| Link::closed(None, b, law)).to_vec();
        let mut motion = Motion::new(&System { links, ..System::dry(&bodies, 0.6) }, Setting::new(1e-4));
        assert!(motion.stand(1e-10, 400));
        let found = motion.slowest().unwrap_or_else(|| panic!("{more} heavier"));
        let slower = expected() / (1.0 + more).sqrt();
        let subject = format!("Springs: two blocks of which one is a little heavier, ω₁; by {more:e}");
        agrees!(subject, "that of the heavier one", "rad/s", found.frequency, slower, 2e-4);
    }
}

/// Ratio at which a block that rings on its joint is damped by steps of `h`, whose circular frequency is `omega`: across and along.
///
/// Its mass lies in its foot and far out, so that it neither tips nor turns and every point moves all of it. Differences of its place
/// obey d_(n+1) = t d_n − q d_(n−1); a dashpot c instead would make q = (1 + z/4 − y)/(1 + z/4 + y), y = ½ h c/m, z = (h ω)².
fn ringing(h: f64, omega: f64) -> [f64; 2] {
    let stiffness = MASS * omega * omega;
    let body = Body {
        name: "b".into(),
        centre: [0.0; 2],
        corners: vec![[-0.2, 0.0], [0.2, 0.0], [0.2, 1.0], [-0.2, 1.0]],
        mass: MASS,
        inertia: 1e9 * MASS,
    };
    let law = Law {
        normal: Normal::Springs { both: 0.0, press: stiffness, damping: 0.0 },
        shear: Shear { stiffness, damping: 0.0, series: true },
        ..Law::dry(Some(concio_planar::joint::Friction::coulomb(0.6)))
    };
    let system = System { links: vec![Link::closed(None, 0, law)], ..System::dry(&[body], 0.6) };
    [1, 0].map(|k| {
        let mut motion = Motion::new(&system, Setting { tolerance: 1e-14, ..Setting::new(h) });
        assert!(motion.stand(1e-12, 400));
        motion.velocities[0][k] = 0.1 * concio_planar::G / omega;
        let places = [0, 1, 2, 3, 4].map(|_| {
            motion.step(Forcing::default());
            motion.places[0].centre[k]
        });
        let d = [0, 1, 2, 3].map(|n| places[n + 1] - places[n]);
        let q = (d[2] * d[2] - d[1] * d[3]) / (d[1] * d[1] - d[0] * d[2]);
        let y = (1.0 + 0.25 * (h * omega).powi(2)) * (1.0 - q) / (1.0 + q);
        y / (h * omega)
    })
}

/// (P6): x³/(1 + x²) at x = h ω/4, and an eighth at most.
#[test]
fn what_rings_is_damped_by_an_eighth_at_most() {
    let x = 0.25 * concio_planar::joint::RESOLVED;
    assert!((x * x * x / (1.0 + x * x) / 0.125 - 1.0).abs() < 5e-3);
    let h = 1e-3;
    for x in [0.1_f64, 0.3, 0.5, 1.0, 3.0, 20.0] {
        let expected = (x * x * x / (1.0 + x * x)).min(0.125);
        for (found, way) in ringing(h, 4.0 * x / h).into_iter().zip(["across", "along"]) {
            let subject = format!("Springs: damping ratio of steps; h ω = {}, {way}", 4.0 * x);
            agrees!(subject, "x³/(1 + x²) at x = h ω/4, an eighth at most (P6)", "", found, expected, 1e-5);
        }
    }
}
