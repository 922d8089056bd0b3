//! Limit analysis in space against closed forms, and what it refuses.

use concio_limit::space::{
    Assembly, Cuboid, Facade, Leaves, Limit, PointLoad, Problem, Support, TextureError, Tie, analyse, crushed,
    even_twist, without_dilation,
};
use concio_limit::{LimitError, MechanismKind, NonAssociative, Stop};
use concio_verified::agrees;
use proptest::prelude::*;

const OUTWARDS: [f64; 3] = [-1.0, 0.0, 0.0];

fn block(name: &str, x: [f64; 2], y: [f64; 2], z: [f64; 2]) -> Cuboid {
    Cuboid { name: name.into(), edges: [x, y, z], specific_weight: 20e3 }
}

fn problem(blocks: &[Cuboid], mu: f64) -> Problem {
    Problem::new(Assembly::of_boxes(blocks, mu).expect("blocks"), OUTWARDS)
}

fn one([a, b, h]: [f64; 3], mu: f64) -> Problem {
    problem(&[block("b", [0.0, a], [0.0, b], [0.0, h])], mu)
}

fn certified(limit: &Limit) -> f64 {
    assert!(limit.is_certified() && limit.gap() > -1e-8, "{:?}, {:e} apart", limit.bounds, limit.gap());
    limit.multiplier()
}

fn bears(problem: &Problem) -> f64 {
    certified(&analyse(problem).expect("a limit"))
}

fn subject(what: &str) -> String {
    format!("Limit analysis in space: {what}")
}

/// A turn about an axis by an angle.
fn rotation(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let size = axis.iter().map(|v| v * v).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|v| v / size);
    let (s, c) = angle.sin_cos();
    let d = 1.0 - c;
    [
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
    ]
}

/// A block pushed along any level direction slides, or turns about the edge that its weight reaches first.
#[test]
fn a_block_slides_or_turns_in_any_direction() {
    for ([a, b, h], mu) in [([0.5, 0.5, 2.0], 0.6), ([0.4, 1.0, 1.0], 0.3), ([0.3, 2.0, 1.5], 0.7)] {
        for degrees in [0.0f64, 20.0, 45.0, 70.0, 90.0, 200.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let mut problem = one([a, b, h], mu);
            problem.direction = [3.0 * cos, 3.0 * sin, 0.0];
            let edges = (a / (h * cos.abs())).min(b / (h * sin.abs()));
            let what = subject(&format!("block; {a} × {b} × {h}, μ = {mu}, towards {degrees}°"));
            let limit = analyse(&problem).expect("a limit");
            agrees!(what, "min(μ, a/(h cos φ), b/(h sin φ))", "", certified(&limit), mu.min(edges), 1e-7);
            let kind = if mu < edges { MechanismKind::Sliding } else { MechanismKind::Overturning };
            assert_eq!(limit.mechanism.kind, kind, "{a} × {b} × {h} towards {degrees}°");
        }
    }
}

/// Pushed upwards at an angle, a block slides at μ/(cos φ + μ sin φ).
#[test]
fn a_block_pushed_upwards_slides_earlier() {
    for degrees in [10.0f64, 30.0, -20.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut problem = one([2.0, 2.0, 0.2], 0.4);
        problem.direction = [cos, 0.0, sin];
        let what = subject(&format!("block pushed upwards; φ = {degrees}°"));
        agrees!(what, "μ/(cos φ + μ sin φ)", "", bears(&problem), 0.4 / (cos + 0.4 * sin), 1e-7);
    }
}

fn without(problem: &Problem) -> ([f64; 2], NonAssociative) {
    let found = without_dilation(problem, &analyse(problem).expect("a limit"));
    assert_eq!(found.stop, Stop::Converged, "{found:?}");
    (found.states.expect("states"), found)
}

/// A block turns about its edge, or slides: its forces are known. A cube on two strips of μ 0.2 and, ahead, 0.4 slides too, and by N₁ = W − N₂ on them
/// λ = 0.4 − 0.2 N₁/W. All may stand ahead; behind stands at most what moments allow, N₁ = (1 − λ) W. A tie adds its Y, pulled level with the load.
#[test]
fn states_without_dilation_have_the_multipliers_that_balance_leaves() {
    let against = "balance of a block";
    for ([a, b, h], mu) in [([0.2, 1.0, 2.0], 0.6), ([1.0, 1.0, 0.5], 0.3)] {
        for (end, state) in ["least", "most"].into_iter().zip(without(&one([a, b, h], mu)).0) {
            let what = subject(&format!("{end} state without dilation, block; {a} × {h}, μ = {mu}"));
            agrees!(what, against, "", state, mu.min(a / h), 1e-5);
        }
    }
    for yields in [0.0, 0.1] {
        let strip = |name: &str, x: [f64; 2]| block(name, x, [0.0, 1.0], [-0.2, 0.0]);
        let cube = block("cube", [0.0, 1.0], [0.0, 1.0], [0.0, 1.0]);
        let mut wall = problem(&[strip("ahead", [0.0, 0.5]), strip("behind", [0.5, 1.0]), cube], 0.4);
        wall.assembly.contacts.iter_mut().filter(|c| c.name.contains("behind")).for_each(|c| c.friction = 0.2);
        wall.held = vec![true, true, false];
        wall.pushed = vec![false, false, true];
        let weight = wall.assembly.bodies[2].weight;
        if yields > 0.0 {
            let [at, end] = [1.0, 3.0].map(|x| [x, 0.5, 0.5]);
            wall.ties.push(Tie { body: 2, to: None, at, end, yields: yields * weight });
        }
        let (states, found) = without(&wall);
        assert!((states[0] - 1e-6..=states[1] + 1e-6).contains(&found.multiplier), "{found:?}");
        for ((end, state), by_hand) in ["least", "most"].into_iter().zip(states).zip([0.25, 0.4]) {
            let what = subject(&format!("{end} state without dilation, cube on two strips; tie of {yields} W"));
            agrees!(what, against, "", state, by_hand + yields, 1e-5);
        }
    }
}

#[test]
fn a_stack_turns_whole() {
    let blocks: Vec<Cuboid> = (0..6)
        .map(|k| block(&format!("b{k}"), [0.0, 0.3], [0.0, 0.5], [0.4 * k as f64, 0.4 * (k + 1) as f64]))
        .collect();
    agrees!(subject("stack of six blocks"), "t/h", "", bears(&problem(&blocks, 0.6)), 0.3 / 2.4, 1e-7);
}

/// A joint pressed by W resists a twist by μ W times half of its diagonal; with its points drawn in, times the mean distance.
#[test]
fn a_joint_twists_at_its_half_diagonal() {
    let (a, b, mu, arm) = (0.4, 0.7, 0.5, 3.0);
    let mut twisted = one([a, b, 0.2], mu);
    twisted.pushed = vec![false];
    let weight = twisted.assembly.bodies[0].weight;
    // Pushed at the end of an arm, and held from going along.
    twisted.loads.push(PointLoad { body: 0, at: [0.5 * a, 0.5 * b + arm, 0.0], force: [0.0; 3], pushes: weight });
    twisted.supports.push(Support { body: 0, at: [0.5 * a, 0.5 * b, 0.0], direction: [1.0, 0.0, 0.0], friction: 0.0 });
    let radius = 0.5 * a.hypot(b);
    let against = "μ W times half of the diagonal";
    agrees!(subject("twisted joint"), against, "", bears(&twisted), mu * radius / arm, 1e-7);
    // The mean distance from the middle by summation over the rectangle.
    let n = 400;
    let at = |side: f64, k: usize| side * ((k as f64 + 0.5) / n as f64 - 0.5);
    let mean = (0..n * n).map(|k| at(a, k / n).hypot(at(b, k % n))).sum::<f64>() / (n * n) as f64;
    let against = "μ W times the mean distance from the middle, summed over 160,000 points";
    agrees!(
        subject("twisted joint under even pressure"),
        against,
        "",
        bears(&twisted.drawn_in()),
        mu * mean / arm,
        1e-5
    );
    assert!((even_twist([1.0, 1.0]) - 0.541).abs() < 1e-3 && (even_twist([1e3, 1.0]) - 0.5).abs() < 1e-2);
}

/// Floors as forces, a thrust, and a tie up to its yield force: balance of moments about the outer edge.
#[test]
fn floors_and_a_tie() {
    let mut wall = problem(
        &[Cuboid { name: "wall".into(), edges: [[0.0, 0.6], [0.0, 1.0], [0.0, 9.6]], specific_weight: 19e3 }],
        1.0,
    );
    for (z, load, x, thrust) in [(3.2, 12e3, 0.35, 0.0), (6.4, 10e3, 0.30, 0.0), (9.6, 6e3, 0.25, 1.5e3)] {
        wall.loads.push(PointLoad { body: 0, at: [x, 0.5, z], force: [-thrust, 0.0, -load], pushes: load });
    }
    let against = "virtual work, computed with six digits before";
    agrees!(subject("wall of three storeys"), against, "", bears(&wall), 0.0395907, 1e-5);
    let turning = wall.turning().expect("a joint");
    agrees!(subject("wall of three storeys; closed form"), against, "", turning.multiplier, 0.0395907, 1e-6);
    wall.ties.push(Tie { body: 0, to: None, at: [0.0, 0.5, 6.4], end: [5.0, 0.5, 6.4], yields: 20e3 });
    let limit = analyse(&wall).expect("a limit");
    agrees!(subject("wall of three storeys; with a tie"), against, "", certified(&limit), 0.226367, 1e-5);
    assert!((limit.pulls[0] - 20e3).abs() < 1.0, "{:?}", limit.pulls);
    let turning = wall.turning().expect("a joint");
    agrees!(subject("wall of three storeys; closed form with a tie"), against, "", turning.multiplier, 0.226367, 1e-5);
    // A tie that is slack under the load does nothing: pushed inwards, the wall turns about its inner edge.
    wall.direction = [1.0, 0.0, 0.0];
    let limit = analyse(&wall).expect("a limit");
    assert!(limit.pulls[0].abs() < 1.0, "{:?}", limit.pulls);
}

/// Stones that crush: the hinge goes back by N/(2 f L).
#[test]
fn hinges_are_set_back() {
    let courses = |number: usize| -> Vec<Cuboid> {
        let h = 6.0 / number as f64;
        let course = |k: usize| Cuboid {
            name: format!("c{k}"),
            edges: [[0.0, 0.5], [0.0, 1.0], [h * k as f64, h * (k + 1) as f64]],
            specific_weight: 18e3,
        };
        (0..number).map(course).collect()
    };
    for number in [1, 6] {
        let found = crushed(&problem(&courses(number), 0.8).crushing(1500e3)).expect("a limit");
        let what = subject(&format!("stones that crush at 1.5 MPa; {number} courses"));
        agrees!(what, "(t − N/(f L))/h", "", certified(&found.limit), 0.0773333, 1e-5);
        assert!(found.overloaded.is_empty(), "{:?}", found.overloaded);
    }
    let found = crushed(&problem(&courses(1), 0.8).crushing(100e3));
    assert!(found.is_ok_and(|f| f.overloaded == [0] && f.limit.multiplier().abs() < 1e-6));
    assert!(matches!(crushed(&problem(&courses(1), 0.8).crushing(0.0)), Err(LimitError::Wrong(_))));
}

/// Bricks of a course share its weight as they like: what bears most is even pressure, so the hinge goes back by N/(2 f L) with
/// N and L of the whole course, however many bricks it has. N = γ t L h; h = 6 courses of 0.25 m.
#[test]
fn hinges_are_set_back_by_the_whole_course() {
    let (length, height, t, h, weight) = (0.5, 0.25, 0.5, 1.5, 20e3);
    for bricks in 1..=6 {
        let mut blocks = Vec::new();
        for course in 0..6 {
            let first = if course % 2 == 0 { length } else { 0.5 * length };
            let (end, mut at, mut size) = (bricks as f64 * length, 0.0, first);
            while end - at > 1e-9 {
                let next = (at + size).min(end);
                let z = [height * course as f64, height * (course + 1) as f64];
                blocks.push(block(&format!("{course} {at}"), [0.0, t], [at, next], z));
                (at, size) = (next, length);
            }
        }
        for strength in [0.07e6, 0.1e6, 0.25e6, 0.5e6, 2e6] {
            let what = format!("stones that crush at {} MPa; 6 courses of {bricks} bricks", strength * 1e-6);
            let crushing = problem(&blocks, 0.6).crushing(strength);
            let found = crushed(&crushing).expect("a limit");
            let right = (t - weight * t * h / strength) / h;
            agrees!(subject(&what), "(t − N/(f L))/h", "", certified(&found.limit), right, 1e-5);
            let turning = crushing.turning().expect("a joint");
            agrees!(subject(&format!("{what}; closed form")), "(t − N/(f L))/h", "", turning.multiplier, right, 1e-7);
            // Forces that prove λ obey (S6): no joint's resultant is nearer to an edge than N/(2 f l).
            for (contact, four) in crushing.assembly.contacts.iter().zip(found.limit.forces.chunks(4)) {
                let normal: f64 = four.iter().map(|f| f[0]).sum();
                let bears = strength * contact.sides().iter().product::<f64>();
                for edge in [[0, 1], [1, 2], [2, 3], [3, 0]] {
                    let there: f64 = edge.iter().map(|k: &usize| four[*k][0]).sum();
                    assert!(normal * normal <= 2.0 * bears * there * (1.0 + 1e-9), "{}: {four:?}", contact.name);
                }
            }
        }
    }
}

/// Two piers side by side, one of them laden: each has the setback of its own pressure.
#[test]
fn piers_crush_each_by_its_own_pressure() {
    let (t, h, f) = (0.5, 3.0, 0.3e6);
    let blocks = [block("slender", [0.0, t], [0.0, 0.5], [0.0, h]), block("stout", [0.0, t], [2.0, 4.0], [0.0, h])];
    let mut piers = problem(&blocks, 0.8);
    let load = 20e3;
    piers.loads.push(PointLoad { body: 0, at: [0.5 * t, 0.25, h], force: [0.0, 0.0, -load], pushes: 0.0 });
    let weight = 20e3 * t * 0.5 * h;
    // λ W h/2 = (W + P)(t/2 − (W + P)/(2 f L)).
    let all = weight + load;
    let slender = all * (t / 2.0 - all / (2.0 * f * 0.5)) / (weight * h / 2.0);
    let stout = (t - 20e3 * t * h / f) / h;
    let found = crushed(&piers.crushing(f)).expect("a limit");
    let against = "balance of moments about a hinge set back by N/(2 f L)";
    agrees!(subject("two piers that crush"), against, "", certified(&found.limit), slender.min(stout), 1e-6);
}

/// A block pushed askew cannot bear less than (S6) allows, nor more than it does without crushing.
#[test]
fn crushing_takes_from_lambda_in_any_direction() {
    for degrees in [0.0f64, 25.0, 45.0, 90.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut problem = one([0.4, 0.6, 2.0], 0.8);
        problem.direction = [cos, sin, 0.0];
        let whole = bears(&problem);
        let f = 0.2e6;
        // γ h/f of the block is crushed: (S6) draws each edge in by that part of its half side.
        let part = 20e3 * 2.0 / f;
        let right = (1.0 - part) * (0.4 / (2.0 * cos.abs())).min(0.6 / (2.0 * sin.abs()));
        let what = subject(&format!("block that crushes, pushed towards {degrees}°"));
        agrees!(what, "(1 − γ h/f) min(a/(h cos φ), b/(h sin φ))", "", bears(&problem.crushing(f)), right, 1e-6);
        assert!(right < whole, "{right} {whole}");
    }
}

/// A block between held ones slides out: no velocities part it from both.
#[test]
fn a_block_slides_out_between_held_ones() {
    let blocks =
        [0, 1, 2].map(|k| block(&format!("b{k}"), [0.0, 0.4], [0.5 * k as f64, 0.5 * (k + 1) as f64], [0.0, 0.2]));
    let mut problem = problem(&blocks, 0.4).frictionless_heads();
    problem.held = vec![true, false, true];
    agrees!(subject("block between held ones"), "μ", "", bears(&problem), 0.4, 1e-6);
    problem.held = vec![true; 3];
    assert_eq!(analyse(&problem).err(), Some(LimitError::Wrong("nothing that may move is pushed".into())));
}

/// Only the upper part is pushed, and the lower one neither slides nor turns with it.
#[test]
fn a_part_is_pushed() {
    let blocks = [block("low", [0.0, 0.5], [0.0, 1.0], [0.0, 1.0]), block("high", [0.0, 0.5], [0.0, 1.0], [1.0, 2.0])];
    let mut problem = problem(&blocks, 0.9);
    agrees!(subject("two blocks"), "t/h", "", bears(&problem), 0.25, 1e-7);
    problem.pushed[0] = false;
    agrees!(subject("two blocks; the upper one pushed"), "2 W t/2 = λ W 3 h/4", "", bears(&problem), 1.0 / 3.0, 1e-7);
    assert_eq!(problem.turning().map(|t| t.level), Some(0.0));
    problem.held[0] = true;
    assert_eq!(problem.turning().map(|t| t.level), Some(1.0));
    agrees!(subject("two blocks; the upper one pushed, the lower held"), "t/h", "", bears(&problem), 0.5, 1e-7);
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let (a, b) = (block("a", [0.0, 1.0], [0.0, 1.0], [0.0, 1.0]), block("b", [0.5, 1.5], [0.0, 1.0], [0.0, 1.0]));
    assert_eq!(Assembly::of_boxes(&[a.clone(), b], 0.6).err(), Some(TextureError::Overlap("a".into(), "b".into())));
    let flat = block("flat", [0.0, 0.0], [0.0, 1.0], [0.0, 1.0]);
    assert_eq!(Assembly::of_boxes(&[flat], 0.6).err(), Some(TextureError::NoVolume("flat".into())));
    let facade = Facade {
        thickness: 0.2,
        course: 0.2,
        courses: 3,
        length: 2.0,
        sides: [true; 2],
        depth: 0.3,
        specific_weight: 20e3,
    };
    assert!(matches!(facade.blocks(), Err(TextureError::Range("depth", _))));
    assert!(matches!(Facade { course: f64::NAN, ..facade }.blocks(), Err(TextureError::Range("course", _))));
    let leaves =
        Leaves { thickness: 0.2, course: 0.2, courses: 3, length: 2.0, headers: vec![4], specific_weight: 20e3 };
    assert!(matches!(leaves.blocks(), Err(TextureError::Range("headers", _))));
    // A block that hangs over by more than half falls; a free one too.
    let over = block("over", [0.7, 1.7], [0.0, 1.0], [1.0, 2.0]);
    assert_eq!(analyse(&problem(&[a.clone(), over], 0.6)).err(), Some(LimitError::DoesNotStand));
    let mut wrong = problem(&[a], 0.6);
    wrong.direction = [0.0; 3];
    assert!(matches!(analyse(&wrong), Err(LimitError::Wrong(_))));
    // Pressed down alone, nothing limits the load.
    wrong.direction = [0.0, 0.0, -1.0];
    assert_eq!(analyse(&wrong).err(), Some(LimitError::NotSolved("nothing limits the load".into())));
    wrong.direction = OUTWARDS;
    wrong.assembly.contacts[0].friction = f64::INFINITY;
    assert!(matches!(analyse(&wrong), Err(LimitError::Wrong(_))));
}

/// μ = 0 leaves N ≥ 0: a smooth wall slides at 0, and does not hang.
#[test]
fn smooth_joints_still_press_only() {
    let limit = analyse(&one([0.5, 0.5, 1.0], 0.0)).expect("a limit");
    assert!(limit.multiplier().abs() < 1e-6, "{:?}", limit.bounds);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, ..ProptestConfig::default() })]
    /// λ knows neither the axes nor the units of length and weight, nor the order of the blocks.
    #[test]
    fn lambda_is_of_the_wall_alone(
        axis in [-1.0f64..1.0, -1.0..1.0, 0.1..1.0], angle in 0.0f64..6.0, size in 0.01f64..100.0, weight in 0.1f64..1e6,
    ) {
        let facade = Facade {
            thickness: 0.2, course: 0.2, courses: 4, length: 1.2, sides: [true, false], depth: 0.9, specific_weight: 20e3,
        };
        let blocks = facade.blocks().expect("a façade");
        let here = bears(&problem(&blocks, 0.5));
        let turned = bears(&problem(&blocks, 0.5).turned(rotation(axis, angle)));
        prop_assert!((turned - here).abs() < 1e-6 * here, "{turned} {here}");
        let scaled = Facade {
            thickness: 0.2 * size, course: 0.2 * size, length: 1.2 * size, depth: 0.9 * size,
            specific_weight: weight, ..facade
        };
        let mut blocks = scaled.blocks().expect("a façade");
        blocks.reverse();
        let there = bears(&problem(&blocks, 0.5));
        prop_assert!((there - here).abs() < 1e-6 * here, "{there} {here}");
    }
}
