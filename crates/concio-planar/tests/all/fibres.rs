//! Joints on springs that open as they are sheared, against fibres of their own.

use concio_planar::G;
use concio_planar::body::Body;
use concio_planar::joint::{Friction, Law, Normal, Shear};
use concio_planar::motion::{Forcing, Link, Motion, Setting, System};
use concio_verified::agrees;

/// Half a metre deep, 22 kN/m³.
const DEPTH: f64 = 0.5;

/// A stone of `length` × `height` m on a joint of `k` N/m³ across and `k` / 2.4 along.
struct Stone {
    size: [f64; 2],
    k: f64,
    friction: Friction,
    crushing: f64,
}

impl Stone {
    fn body(&self) -> Body {
        let [length, height] = self.size;
        Body::rectangle("stone", [0.0, length], [0.0, height], 22e3 / G * length * height * DEPTH)
    }

    fn weight(&self) -> f64 {
        self.body().mass * G
    }

    fn law(&self) -> Law {
        let area = self.size[0] * DEPTH;
        Law {
            normal: Normal::Springs { both: 0.0, press: self.k * area, damping: 0.0 },
            shear: Shear { stiffness: self.k * area / 2.4, damping: 0.0, series: true },
            crushing: self.crushing * area,
            ..Law::dry(Some(self.friction))
        }
    }

    fn motion(&self, setting: Setting) -> Motion {
        let links = vec![Link::closed(None, 0, self.law())];
        let mut motion = Motion::new(&System { links, ..System::dry(&[self.body()], 5.0) }, setting);
        assert!(motion.stand(1e-13, 4000));
        motion
    }

    /// Slide of the joint after each of these forces at its centre [N], and what friction took in all [J].
    fn moves(&self, forces: &[f64], setting: Setting) -> (Vec<f64>, f64) {
        let h = setting.step;
        let mut motion = self.motion(setting);
        let before = motion.account.friction;
        let slides = forces.iter().map(|force| {
            motion.apply(0, [*force, 0.0, 0.0]);
            motion.go(h, &|_, _| Forcing::default());
            -motion.seen[0].slide
        });
        (slides.collect(), motion.account.friction - before)
    }

    /// The same of 2,000 fibres under the pressures of a joint without tension.
    fn fibres(&self, forces: &[f64]) -> (Vec<f64>, f64) {
        const FIBRES: usize = 2000;
        let ([length, height], weight) = (self.size, self.weight());
        let k = self.k * length * DEPTH / 2.4 / FIBRES as f64;
        let mut anchors = vec![0.0f64; FIBRES];
        let (mut slide, mut taken) = (0.0f64, 0.0);
        let slides = forces.iter().map(|force| {
            let away = force * 0.5 * height / weight;
            let pressure = |x: f64| {
                let x = if away < 0.0 { -x } else { x };
                let from = away.abs();
                if from <= length / 6.0 {
                    weight / length * (1.0 + 12.0 * from * x / (length * length))
                } else {
                    let pressed = 3.0 * (0.5 * length - from);
                    (2.0 * weight / pressed * (1.0 - (0.5 * length - x) / pressed)).max(0.0)
                }
            };
            let at = |n: usize| ((n as f64 + 0.5) / FIBRES as f64 - 0.5) * length;
            let limits: Vec<f64> =
                (0..FIBRES).map(|n| self.friction.static_ * pressure(at(n)) * length / FIBRES as f64).collect();
            let borne = |slide: f64, n: usize| (k * (slide - anchors[n])).clamp(-limits[n], limits[n]);
            let [mut low, mut high] = [slide - 1e-2, slide + 1e-2];
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                let all: f64 = (0..FIBRES).map(|n| borne(middle, n)).sum();
                *if all < *force { &mut low } else { &mut high } = middle;
            }
            slide = high;
            for n in 0..FIBRES {
                let bears = (k * (slide - anchors[n])).clamp(-limits[n], limits[n]);
                let anchor = slide - bears / k;
                taken += (anchor - anchors[n]) * bears;
                anchors[n] = anchor;
            }
            slide
        });
        (slides.collect(), taken)
    }
}

/// Forces that go from one of these parts of the weight to the next in steps.
fn forces(weight: f64, parts: &[f64]) -> Vec<f64> {
    const STEPS: usize = 200;
    let ways = [0.0].iter().chain(parts).zip(parts);
    let way = |(from, to): (&f64, &f64)| {
        (1..=STEPS).map(|n| weight * (from + (to - from) * n as f64 / STEPS as f64)).collect::<Vec<_>>()
    };
    ways.flat_map(way).collect()
}

const STONES: [([f64; 2], f64, f64, f64); 4] = [
    ([1.0, 1.0], 20e9, 0.75, 0.6),
    ([0.8, 1.6], 3e9, 0.65, 0.42),
    ([0.5, 0.6], 10e9, 0.6, 0.5),
    ([1.2, 0.4], 10e9, 0.6, 0.55),
];

fn stone((size, k, mu, most): ([f64; 2], f64, f64, f64)) -> (Stone, f64) {
    (Stone { size, k, friction: Friction::coulomb(mu), crushing: f64::INFINITY }, most)
}

/// A stone that opens at its heel slides as far as fibres do that let go what opens, there, back and there again; in motion too. A strength that is never reached changes nothing.
#[test]
fn what_opens_under_shear_lets_go_what_it_bore() {
    for own in STONES {
        let (mut stone, most) = stone(own);
        let forces = forces(stone.weight(), &[most, 0.0, -most, most]);
        let (expected, taken) = stone.fibres(&forces);
        let farthest = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let pressed = 3.0 * (0.5 * stone.size[0] - most * 0.5 * stone.size[1]);
        let peak = 1.2 * 2.0 * stone.weight() / (pressed * DEPTH);
        for crushing in [f64::INFINITY, peak] {
            stone.crushing = crushing;
            for setting in
                [Setting { still: true, ..Setting::new(2e-2) }, Setting { still: true, ..Setting::new(1e-3) }]
            {
                let step = setting.step;
                let (slides, takes) = stone.moves(&forces, setting);
                let off = slides.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // Fibres leave out that the stone turns.
                assert!(off < 0.012 * farthest, "{off} m of {farthest} m");
                let subject = format!(
                    "Friction: stone of {} m × {} m that opens as it is sheared to and fro, steps of {step} s, {}",
                    stone.size[0],
                    stone.size[1],
                    if crushing.is_finite() { "a strength not reached" } else { "no strength" }
                );
                agrees!(
                    format!("{subject}; slide at the end"),
                    "2,000 fibres",
                    "m",
                    slides[slides.len() - 1],
                    expected[expected.len() - 1],
                    1.5e-2
                );
                agrees!(format!("{subject}; energy"), "2,000 fibres", "J", takes, taken, 6e-2);
            }
        }
    }
}

/// A stone on springs stands until its shear is μ_s of its weight, however its pressure is shared, and slides under μ_d of it.
#[test]
fn a_joint_on_springs_slides_as_one() {
    for (size, k) in [([1.0, 0.5], 20e9), ([2.0, 0.3], 20e9), ([1.0, 0.3], 2e9)] {
        let friction = Friction { dynamic: 0.42, ..Friction::coulomb(0.6) };
        let stone = Stone { size, k, friction, crushing: f64::INFINITY };
        let mut motion = stone.motion(Setting::new(1e-3));
        let mut most = 0.0f64;
        for n in 0..1000 {
            let force = 0.65 * stone.weight() * f64::from(n) / 1000.0;
            motion.apply(0, [force, 0.0, 0.0]);
            motion.go(1e-3, &|_, _| Forcing::default());
            if motion.velocities[0][0].abs() > 1e-3 {
                break;
            }
            most = force;
        }
        let subject =
            format!("Friction: stone of {} m × {} m on springs, μ_s 0.6, μ_d 0.42, slides at", size[0], size[1]);
        agrees!(subject, "closed form", "of its weight", most / stone.weight(), 0.6, 6e-3);
    }
}
