//! Limit analysis in space against values that a second program computed before.
//!
//! The textures: blocks 2t × t × h_b of 20 kN/m³ on a wide rigid base. In even courses, from 0, the façade is of whole blocks
//! and side walls start behind it; in odd ones side walls run through.

use concio_limit::space::{
    Assembly, Contact, ContactKind, Cuboid, Facade, Leaves, Limit, PointLoad, Problem, Support, analyse,
    without_dilation,
};
use concio_limit::{MechanismKind, Stop};
use concio_verified::agrees;

/// γ [N/m³].
const WEIGHT: f64 = 20e3;
const OUTWARDS: [f64; 3] = [-1.0, 0.0, 0.0];
const AGAINST: &str = "a second program of the same cone program";

fn facade(length: f64, sides: [bool; 2], course: f64, courses: usize, depth: f64) -> Facade {
    Facade { thickness: 0.2, course, courses, length, sides, depth, specific_weight: WEIGHT }
}

fn problem(blocks: &[Cuboid], mu: f64) -> Problem {
    Problem::new(Assembly::of_boxes(blocks, mu).expect("a wall"), OUTWARDS)
}

fn certified(limit: &Limit) -> f64 {
    assert!(limit.is_certified() && limit.gap() > -1e-8, "{:?}, {:e} apart", limit.bounds, limit.gap());
    limit.multiplier()
}

fn bears(what: &str, problem: &Problem, expected: f64) -> Limit {
    let limit = analyse(problem).unwrap_or_else(|e| panic!("{what}: {e}"));
    agrees!(format!("Limit analysis in space: {what}"), AGAINST, "", certified(&limit), expected, 1e-4);
    limit
}

/// Head joints that rub, and that do not.
fn both(what: &str, problem: &Problem, [rub, smooth]: [f64; 2]) -> [Limit; 2] {
    let frictionless = problem.frictionless_heads();
    [
        bears(&format!("{what}; head joints rub"), problem, rub),
        bears(&format!("{what}; head joints without friction"), &frictionless, smooth),
    ]
}

#[test]
fn l1_a_wall_alone() {
    let blocks = facade(2.0, [false; 2], 0.2, 10, 0.0).blocks().expect("a wall");
    for mu in [0.1, 0.3, 0.6, 1.0] {
        let limit = bears(&format!("wall without side walls; μ = {mu}"), &problem(&blocks, mu), 0.1);
        // At λ = μ it may slide as well.
        assert!(mu <= 0.1 || limit.mechanism.kind == MechanismKind::Overturning, "{:?}", limit.mechanism.kind);
    }
}

#[test]
fn l2_a_vertical_arch() {
    let course = |c: usize| Cuboid {
        name: format!("c{}", c + 1),
        edges: [[0.0, 0.3], [0.0, 1.0], [0.1 * c as f64, 0.1 * (c + 1) as f64]],
        specific_weight: WEIGHT,
    };
    let blocks: Vec<Cuboid> = (0..30).map(course).collect();
    for (x, expected, crack) in [(0.15, 0.9, "c20|c21"), (0.0, 3.5 / 3.0, "c18|c19")] {
        let mut wall = problem(&blocks, 0.6);
        wall.loads.push(PointLoad { body: 29, at: [x, 0.5, 3.0], force: [0.0, 0.0, -18e3], pushes: 0.0 });
        wall.supports.push(Support { body: 29, at: [0.0, 0.5, 3.0], direction: [1.0, 0.0, 0.0], friction: 0.0 });
        let limit = bears(&format!("vertical arch under a roof; load at x = {x}"), &wall, expected);
        let open = limit.mechanism.contacts.iter().filter(|c| c.opens);
        let open: Vec<&str> = open.map(|c| wall.assembly.contacts[c.contact].name.as_str()).collect();
        assert_eq!(open, ["base|c1", crack]);
    }
    // The support on the top course acts through one bed joint, which slides: x = 0.15, nothing on the wall.
    let mut wall = problem(&blocks, 0.6);
    wall.supports.push(Support { body: 29, at: [0.0, 0.5, 3.0], direction: [1.0, 0.0, 0.0], friction: 0.0 });
    let limit = analyse(&wall).expect("a limit");
    agrees!("Limit analysis in space: vertical arch without a roof", AGAINST, "", certified(&limit), 0.150, 2e-3);
}

#[test]
fn l3_l4_a_facade_with_two_side_walls() {
    let blocks = facade(2.0, [true; 2], 0.2, 10, 2.4).blocks().expect("a façade");
    both("façade with two side walls; L = 2, μ = 0.6", &problem(&blocks, 0.6), [0.36518, 0.33139]);
    both("façade with two side walls; L = 2, μ = 0.3", &problem(&blocks, 0.3), [0.29085, 0.28850]);
}

#[test]
fn l5_a_longer_facade() {
    let blocks = facade(4.0, [true; 2], 0.2, 10, 2.4).blocks().expect("a façade");
    both("façade with two side walls; L = 4, μ = 0.6", &problem(&blocks, 0.6), [0.28071, 0.25527]);
    both("façade with two side walls; L = 4, μ = 0.3", &problem(&blocks, 0.3), [0.21031, 0.20347]);
}

#[test]
fn l6_a_facade_with_one_side_wall() {
    let blocks = facade(2.0, [true, false], 0.2, 10, 2.4).blocks().expect("a façade");
    both("façade with one side wall", &problem(&blocks, 0.6), [0.25775, 0.22370]);
}

#[test]
fn l7_a_facade_of_570_blocks() {
    let blocks = facade(2.0, [true; 2], 0.1, 20, 4.8).blocks().expect("a façade");
    assert_eq!(blocks.len(), 570);
    both("façade of 570 blocks", &problem(&blocks, 0.6), [0.5091, 0.49579]);
    let slides = problem(&blocks, 0.3);
    let limit = analyse(&slides).expect("a limit");
    agrees!(
        "Limit analysis in space: façade of 570 blocks; μ = 0.3, all slides",
        "μ",
        "",
        certified(&limit),
        0.3,
        1e-6
    );
    assert_eq!(limit.slides_at(&slides), Some(0.3));
}

#[test]
fn l8_two_leaves() {
    for (headers, rub, smooth) in [
        (vec![], 0.12279, 0.10000),
        (vec![10], 0.13279, 0.10991),
        (vec![5, 10], 0.17241, 0.15690),
        (vec![3, 6, 9], 0.18445, 0.17458),
        (vec![2, 4, 6, 8, 10], 0.19031, 0.18593),
    ] {
        let what = format!("two leaves; headers in courses {headers:?}");
        let leaves = Leaves { thickness: 0.2, course: 0.2, courses: 10, length: 1.6, headers, specific_weight: WEIGHT };
        both(&what, &problem(&leaves.blocks().expect("leaves"), 0.6), [rub, smooth]);
    }
}

/// A strip that carries its weight on a smooth base, between abutments that give way at 20 kN.
#[test]
fn l9_a_horizontal_arch() {
    for (number, expected) in [(2usize, 1.0), (4, 1.0), (8, 1.0), (3, 1.125)] {
        let length = 4.0 / number as f64;
        let block = |k: usize| Cuboid {
            name: format!("b{}", k + 1),
            edges: [[0.0, 0.3], [length * k as f64, length * (k + 1) as f64], [0.0, 0.5]],
            specific_weight: WEIGHT,
        };
        let blocks: Vec<Cuboid> = (0..number).map(block).collect();
        let mut strip = problem(&blocks, 0.6);
        let contacts = &mut strip.assembly.contacts;
        contacts.iter_mut().filter(|c| c.kind == ContactKind::Base).for_each(|c| c.friction = 0.0);
        for (a, y, normal) in [(0, 0.0, -1.0), (number - 1, 4.0, 1.0)] {
            contacts.push(Contact {
                name: format!("abutment at {y}"),
                kind: ContactKind::Head,
                a,
                b: None,
                corners: [[0.0, y, 0.0], [0.3, y, 0.0], [0.3, y, 0.5], [0.0, y, 0.5]],
                normal: [0.0, normal, 0.0],
                friction: 0.6,
                gives_way: Some(20e3),
            });
        }
        bears(&format!("horizontal arch; {number} blocks"), &strip, expected);
    }
}

/// Blocks that reach beyond 1.6 m from the corner are held at their outer faces.
#[test]
fn l10_a_corner() {
    let blocks = facade(2.4, [true, false], 0.2, 8, 2.4).blocks().expect("a corner");
    let mut corner = problem(&blocks, 0.6).frictionless_heads();
    corner.direction = [-1.0, -1.0, 0.0];
    for (body, block) in blocks.iter().enumerate() {
        for (across, along) in [(0, 1), (1, 0)] {
            if block.edges[across][0] > 1e-9 || block.edges[along][1] <= 1.6 + 1e-9 {
                continue;
            }
            for (end, z) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let (mut at, mut direction) = ([0.0, 0.0, block.edges[2][z]], [0.0; 3]);
                (at[along], direction[across]) = (block.edges[along][end], 1.0);
                corner.supports.push(Support { body, at, direction, friction: 0.0 });
            }
        }
    }
    let limit = bears("corner; head joints without friction", &corner, 0.48828);
    // No more than the wedge of that texture, which is a mechanism.
    assert!(limit.bounds[0] <= 0.52463);
}

/// The sequence ends in forces that obey friction, and tells the least and the most λ of its mechanism. Another program had 0.346, 0.2886 and 0.259,
/// to ±0.001 of its own: it ends elsewhere in the first façade, where states of one mechanism lie between 0.31 and 0.36.
#[test]
fn l3_to_l5_without_dilation() {
    for (length, mu, theirs, off) in [(2.0, 0.6, 0.346, 3e-2), (2.0, 0.3, 0.2886, 2e-3), (4.0, 0.6, 0.259, 2e-3)] {
        let blocks = facade(length, [true; 2], 0.2, 10, 2.4).blocks().expect("a façade");
        let wall = problem(&blocks, mu);
        let associative = analyse(&wall).expect("a limit");
        let estimate = without_dilation(&wall, &associative);
        assert_eq!(estimate.stop, Stop::Converged, "{estimate:?}");
        assert!(estimate.excess < 1e-3 && estimate.multiplier < associative.bounds[0], "{estimate:?}");
        let what = format!("Limit analysis in space: façade without dilation; {length} m, μ = {mu}");
        agrees!(what, "a sequence in another program", "", estimate.multiplier, theirs, off);
        let [least, most] = estimate.states.expect("states");
        let nearest = theirs.clamp(least, most);
        let what = format!(
            "Limit analysis in space: façade without dilation, nearest state of its mechanism; {length} m, μ = {mu}"
        );
        agrees!(what, "a sequence in another program", "", nearest, theirs, 2e-3);
    }
}
