//! Rocking walls of all kinds at random: whatever is asked for, the account closes, losses grow, and runs end.

use concio::ground::GroundMotion;
use concio_mechanisms::rocking::{
    Back, Floor, Linkage, Mechanism, Positive, Restitution, Rocking, Rub, Setting, Shaking, Spot, Stop, Tie,
};

/// Numbers in a row that is the same each time (a linear congruential generator, D. E. Knuth's constants).
struct Dice(u64);

impl Dice {
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }
    fn odds(&mut self, share: f64) -> bool {
        self.share() < share
    }
    fn some(&mut self, low: f64, high: f64) -> Option<f64> {
        self.odds(0.5).then(|| self.between(low, high))
    }
}

fn mechanism(dice: &mut Dice) -> Mechanism {
    let (t, h) = (dice.between(0.2, 0.8), dice.between(2.0, 8.0));
    let e = Back::SideWalls(Restitution::Given(dice.between(0.0, 0.9)));
    let chain = dice.odds(0.3);
    let mut mechanism = if chain {
        let (d, x) = (dice.between(0.1, 1.0) * t, dice.between(0.4, 0.8));
        let inwards = Linkage::Two { base: [t, 0.0], middle: [0.0, x * h], top: [t - d, h] };
        let back = if dice.odds(0.4) && d < 0.9 * t { Back::Free { inwards, restitution: None } } else { e };
        Mechanism::arch([t, h], 20e3 * t * h, dice.between(0.0, 40e3), d, x, back)
    } else {
        let free = Back::Free { inwards: Linkage::One { hinge: [t, 0.0] }, restitution: dice.some(0.5, 1.0) };
        let back = if dice.odds(0.4) { free } else { e };
        Mechanism::wall(t, h, 1.0, 20e3, back)
    };
    for _ in 0..2 {
        let at = if chain && dice.odds(0.5) {
            Spot::upper([dice.between(0.2, 0.8) * t, dice.between(0.8, 1.0) * h])
        } else {
            Spot::lower([dice.between(0.2, 0.8) * t, dice.between(0.1, 0.4) * h])
        };
        if dice.odds(0.5) {
            mechanism.floors.push(Floor {
                at,
                load: dice.between(0.0, 20e3),
                pushes: dice.between(0.0, 20e3),
                thrust: dice.between(-200.0, 200.0),
                friction: dice.some(0.1, 0.6).unwrap_or(0.0),
                seat: dice.some(0.02, 0.3),
            });
        }
        if dice.odds(0.5) {
            let pretension = dice.some(0.0, 2e3).unwrap_or(0.0);
            mechanism.ties.push(Tie {
                at,
                stiffness: 10f64.powf(dice.between(4.0, 7.0)),
                slack: if pretension > 0.0 { 0.0 } else { dice.some(0.0, 0.02).unwrap_or(0.0) },
                pretension,
                yield_force: dice.some(2.5e3, 20e3),
                elongation_at_break: dice.some(0.25, 0.3),
            });
        }
        if dice.odds(0.3) {
            mechanism.rubs.push(Rub { at, force: dice.between(0.0, 3e3), overlap: dice.some(0.01, 0.2) });
        }
    }
    if dice.odds(0.3) {
        mechanism.friction_moment = dice.between(0.0, 3e3);
    }
    mechanism
}

fn motion(dice: &mut Dice, peak: f64) -> GroundMotion {
    let (a, b) = (dice.between(3.0, 30.0), dice.between(3.0, 30.0));
    let value = |k: i32| peak * (a * 0.01 * f64::from(k)).sin() * (b * 0.01 * f64::from(k)).cos();
    GroundMotion::sampled(0.01, &(0..500).map(value).collect::<Vec<_>>()).unwrap()
}

#[test]
fn whatever_rocks_keeps_its_account() {
    let mut dice = Dice(7);
    let (mut lifted, mut fell, mut stood, mut unstable, mut moving) = (0, 0, 0, 0, 0);
    for k in 0..300 {
        let asked = mechanism(&mut dice);
        let peak = 10f64.powf(dice.between(0.0, 1.0));
        let (across, up) = (motion(&mut dice, peak), motion(&mut dice, 2.0));
        let Ok(rocking) = Rocking::new(&asked) else {
            unstable += 1;
            continue;
        };
        let still = GroundMotion::AtRest;
        let vertical = if dice.odds(0.5) { &up } else { &still };
        let shaking = Shaking { vertical, ..Shaking::across(&across, Positive::Inwards) };
        let setting = Setting { interval: Some(0.01), tail: 10.0, ..Setting::default() };
        let response = rocking.respond(&shaking, &setting).unwrap();
        let shown = || format!("{k}: {asked:#?}\n{:?} {:?} {:?}", response.stop, response.counts, response.energies);
        assert!(response.relative_residual() < 1e-6, "residual {:e} of {}", response.relative_residual(), shown());
        match response.stop {
            Stop::AtRest { .. } => stood += 1,
            Stop::Fallen { .. } => fell += 1,
            Stop::Moving => moving += 1,
            _ => panic!("{}", shown()),
        }
        lifted += u32::from(response.first_lift_off.is_some());
        let history = response.history.as_ref().unwrap();
        assert!(history.rotation.iter().chain(&history.velocity).chain(&history.ties).all(|x| x.is_finite()));
        for pair in history.energies.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let slack = 1e-9 * response.scale;
            let grows = [(a.impact, b.impact), (a.friction, b.friction), (a.ties, b.ties)];
            assert!(grows.iter().all(|(a, b)| *b >= a - slack), "{grows:?} {slack:e} {}", shown());
        }
        assert_eq!(rocking.respond(&shaking, &setting).unwrap(), response);
    }
    println!("{lifted} lifted off, {stood} stood, {fell} fell, {moving} still moved, {unstable} did not stand");
    assert!(lifted > 150 && stood > 100 && fell > 20 && moving < 30, "{lifted} {stood} {fell} {moving}");
}
