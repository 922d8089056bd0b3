//! Strength: planes in closed form, against the linear program of the forces in a cell.

use concio_continuum::{
    Cell, CellCourse, Domain, Laying, Plane, RunningBond, Stiffness, Strength, cut, dry_bending, holds, planes,
};
use concio_verified::agrees;

const JOINTS: Stiffness = Stiffness { normal: 1e9, tangential: 1e9, transverse: 1e9 };

fn bond(b: f64, a: f64) -> (RunningBond, Cell) {
    let laying = Laying { thickness: 0.1, mortar: [0.0; 2], bed: JOINTS, head: JOINTS };
    let bond = RunningBond::new([b, a, 0.1], [0.0; 2], JOINTS, JOINTS).expect("a bond");
    (bond, Cell::shifted(b, a, 0.5, &laying).expect("a cell"))
}

/// Where a way through the reference table ends, by planes and by the program.
#[test]
fn strengths_are_those_of_the_table() {
    let set = |b: f64, a: f64, mu: f64, c: f64| (bond(b, a), Strength::coulomb(c, mu));
    let common = set(0.26, 0.065, 0.6, 0.1e6);
    let dry = set(0.4, 0.2, 0.65, 0.0);
    let tall = set(0.2, 0.4, 0.9, 0.1e6);
    let cases = [
        ("σ11 of common bricks", &common, [0.0, -0.3e6, 0.0], [1.0, 0.0, 0.0], 0.726667e6),
        ("σ12 of common bricks", &common, [0.0, -0.3e6, 0.0], [0.0, 0.0, 1.0], 0.279487e6),
        ("σ12 of common bricks at σ11 −0.1", &common, [-0.1e6, -0.3e6, 0.0], [0.0, 0.0, 1.0], 0.28e6),
        ("σ11 of dry stones", &dry, [0.0, -0.1e6, 0.0], [1.0, 0.0, 0.0], 0.065e6),
        ("σ12 of dry stones", &dry, [0.0, -0.1e6, 0.0], [0.0, 0.0, 1.0], 0.0393939e6),
        ("σ12 of dry stones at σ11 −0.02", &dry, [-0.02e6, -0.1e6, 0.0], [0.0, 0.0, 1.0], 0.0515152e6),
        ("σ12 of tall bricks", &tall, [0.0, -0.3e6, 0.0], [0.0, 0.0, 1.0], 0.165533e6),
        ("σ12 of tall bricks at σ11 −0.2", &tall, [-0.2e6, -0.3e6, 0.0], [0.0, 0.0, 1.0], 0.312472e6),
    ];
    for (name, ((bond, cell), law), from, direction, expected) in cases {
        assert!(holds(bond, *law, *law));
        let by_planes = cut(&planes(bond, *law), from, direction);
        agrees!(format!("Continuum: strength; {name}"), "reference table", "Pa", by_planes, expected, 2e-6);
        let domain = Domain::new(cell, Some(*law), Some(*law));
        let reach = domain.reach(from, direction).expect("a solution").expect("an end");
        agrees!(
            format!("Continuum: strength by the program; {name}"),
            "reference table",
            "Pa",
            reach.multiplier,
            expected,
            2e-6
        );
    }
}

/// Numbers from 0 to 1, the same on every machine.
fn dice() -> impl FnMut() -> f64 {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// 1,050 directions: seven sets of m and μ, 150 each. Where the program has no end the planes have none either.
#[test]
fn planes_are_what_linear_programs_find() {
    let mut roll = dice();
    let (mut worst, mut ends) = (0.0f64, 0);
    for (m, mu) in [(0.5, 0.6), (0.5, 1.0), (1.0, 0.3), (1.0, 0.9), (2.0, 0.7), (4.0, 0.3), (4.0, 0.9)] {
        let (bond, cell) = bond(0.25, 0.125 * m);
        let law = Strength::coulomb(0.1e6, mu);
        let (closed, domain) = (planes(&bond, law), Domain::new(&cell, Some(law), Some(law)));
        for _ in 0..150 {
            let from = [-0.2e6 * roll(), -0.4e6 * roll(), 0.0];
            let direction = [0, 1, 2].map(|_| roll() - 0.5);
            let found = domain.reach(from, direction).expect("a solution");
            let expected = cut(&closed, from, direction);
            match found {
                Some(reach) => {
                    worst = worst.max((reach.multiplier / expected - 1.0).abs());
                    ends += 1;
                }
                None => assert!(expected.is_infinite() || expected > 1e9, "m {m} μ {mu} {direction:?}: {expected}"),
            }
        }
    }
    assert!(ends > 700, "{ends} of 1050 have an end");
    agrees!("Continuum: strength in 1,050 directions, seven bonds", "(H5) to (H7) against linear programs, largest relative difference", "", worst, 0.0, abs: 1e-6);
}

fn has(found: &[Plane], plane: &Plane, unit: f64) -> bool {
    found.iter().any(|p| (0..3).all(|i| (p.a[i] - plane.a[i]).abs() < 1e-5) && (p.b - plane.b).abs() < 1e-5 * unit)
}

#[test]
fn the_program_finds_the_planes() {
    for (a, mu, c) in [(0.065, 0.6, 0.1e6), (0.4, 0.9, 0.1e6), (0.2, 0.65, 0.0)] {
        let (bond, cell) = bond(0.26, a);
        let law = Strength::coulomb(c, mu);
        let found = Domain::new(&cell, Some(law), Some(law)).planes([0.0, -0.2e6, 0.0], 400).expect("planes").planes;
        let closed = planes(&bond, law);
        for plane in &closed {
            assert!(has(&found, plane, 0.2e6), "a {a} μ {mu}: {plane:?} not in {found:#?}");
        }
        assert_eq!(found.len(), closed.len(), "a {a} μ {mu}: {found:#?}");
    }
}

/// A dry stack bond: heads and beds slide each by themselves, |σ12| + μ σ11 ≤ 0 and |σ12| + μ σ22 ≤ 0, also where the search
/// begins on the bound of it.
#[test]
fn stack_bonds_have_their_planes() {
    let laying = Laying { thickness: 0.2, mortar: [0.0; 2], bed: JOINTS, head: JOINTS };
    let course = |n| CellCourse { height: 0.2, bricks: vec![0.3; n], offset: 0.0 };
    let cells = [
        ("low bricks", Cell::shifted(0.3, 0.1, 0.0, &laying)),
        ("high bricks", Cell::shifted(0.3, 0.7, 0.0, &laying)),
        ("six bricks", Cell::of_courses(&[course(3), course(3)], 0.0, &laying)),
    ];
    for (name, cell) in cells {
        let cell = cell.expect("a cell");
        for mu in [0.1, 0.5, 0.65, 1.0, 1.4] {
            let law = Strength::dry(mu);
            let found = Domain::new(&cell, Some(law), Some(law)).planes([0.0, -8e3, 0.0], 400).expect("planes");
            assert_eq!((found.planes.len(), found.excess), (4, 0.0), "{name} μ {mu}: {found:#?}");
            for a in [[mu, 0.0, 1.0], [mu, 0.0, -1.0], [0.0, mu, 1.0], [0.0, mu, -1.0]] {
                let most = mu.max(1.0);
                let plane = Plane { a: a.map(|v| v / most), b: 0.0 };
                assert!(has(&found.planes, &plane, 8e3), "{name} μ {mu}: {plane:?} not in {found:#?}");
            }
        }
        let open = Domain::new(&cell, Some(Strength::dry(0.5)), None).planes([0.0, -8e3, 0.0], 400).expect("planes");
        assert_eq!(cut(&open.planes, [0.0, -8e3, 0.0], [0.0, 0.0, 1.0]), 0.0, "{name}: open heads bear no shear");
        assert_eq!(
            cut(&open.planes, [0.0, -8e3, 0.0], [-1.0, 0.0, 0.0]),
            0.0,
            "{name}: nor pressure along the courses"
        );
    }
}

/// Cells of which no closed form is known: planes against programs in 100 directions each, from where nothing searched.
#[test]
fn no_plane_is_missing() {
    let laying = Laying { thickness: 0.2, mortar: [0.0; 2], bed: JOINTS, head: JOINTS };
    let course = |height, bricks: &[f64], offset| CellCourse { height, bricks: bricks.to_vec(), offset };
    let bonded = Strength { cohesion: 0.1e6, friction: 0.6, tension: 0.08e6, compression: f64::INFINITY };
    let courses = [course(0.1, &[0.3, 0.15], 0.0), course(0.06, &[0.3, 0.15], 0.075), course(0.08, &[0.2, 0.25], 0.05)];
    let cells = [
        ("stack", Cell::shifted(0.3, 0.1, 0.0, &laying)),
        ("third", Cell::shifted(0.3, 0.1, 1.0 / 3.0, &laying)),
        ("half", Cell::shifted(0.25, 0.2, 0.5, &laying)),
        ("courses", Cell::of_courses(&courses, 0.0, &laying)),
    ];
    let mut roll = dice();
    let mut worst = 0.0f64;
    for (name, cell) in cells {
        let cell = cell.expect("a cell");
        let dry = Strength::dry(0.55);
        for (bed, head) in [(dry, Some(dry)), (bonded, Some(bonded)), (bonded, Some(dry)), (bonded, None)] {
            let domain = Domain::new(&cell, Some(bed), head);
            let found = domain.planes([0.0, -20e3, 0.0], 1000).expect("planes");
            assert_eq!(found.excess, 0.0, "{name} {bed:?} {head:?}");
            for _ in 0..100 {
                let from = [-1e3 * roll(), -20e3 - 80e3 * roll(), 0.0];
                let direction = [0, 1, 2].map(|_| roll() - 0.5);
                let by_planes = cut(&found.planes, from, direction);
                match domain.reach(from, direction) {
                    Ok(Some(reach)) => {
                        worst = worst.max((by_planes - reach.multiplier).abs() / (20e3 + reach.multiplier))
                    }
                    Ok(None) => assert!(by_planes > 1e9, "{name} {direction:?}: {by_planes}"),
                    // Flat domains: nothing along the courses.
                    Err(_) => assert!(by_planes < 1.0, "{name} {direction:?}: {by_planes}"),
                }
            }
        }
    }
    agrees!("Continuum: planes of bonds without a closed form, 1,600 directions", "linear programs, largest relative difference", "", worst, 0.0, abs: 1e-6);
}

/// A search that is stopped says how far the planes then reach.
#[test]
fn a_stopped_search_says_what_it_misses() {
    let (_, cell) = bond(0.26, 0.065);
    let law = Strength { cohesion: 0.2e6, friction: 0.6, tension: 0.05e6, compression: 3e6 };
    let domain = Domain::new(&cell, Some(law), Some(law));
    let found = domain.planes([0.0, -0.2e6, 0.0], 30).expect("planes");
    assert!(found.excess > 0.0, "{found:?}");
    let whole = domain.planes([0.0, -0.2e6, 0.0], 2000).expect("planes");
    assert!(whole.excess < found.excess, "{whole:?}");
}

/// The planes do not hold with mortar between the bricks, with heads that do not rub, above μ = 1, with a cut of tension.
#[test]
fn planes_have_limits() {
    let law = Strength::coulomb(0.1e6, 0.6);
    let (closed, _) = bond(0.26, 0.065);
    assert!(holds(&closed, law, law));
    let open = RunningBond::new([0.25, 0.055, 0.12], [0.01; 2], JOINTS, JOINTS).expect("a bond");
    assert!(!holds(&open, law, law));
    assert!(!holds(&closed, law, Strength::dry(0.0)));
    assert!(!holds(&closed, Strength::coulomb(0.1e6, 1.2), Strength::coulomb(0.1e6, 1.2)));
    let cut = Strength { tension: 0.05e6, ..law };
    assert!(!holds(&closed, cut, cut));
    let crushes = Strength { compression: 5e6, ..law };
    assert!(!holds(&closed, crushes, crushes));
}

/// Beds of one brick, by hand: σ22 up to f_t, shear up to c − μ σ22, pressure up to f_c.
#[test]
fn tension_and_pressure_are_cut() {
    let (_, cell) = bond(0.26, 0.065);
    let law = Strength { cohesion: 0.2e6, friction: 0.6, tension: 0.05e6, compression: 3e6 };
    let domain = Domain::new(&cell, Some(law), Some(law));
    let reach = |from, direction| domain.reach(from, direction).expect("a solution").expect("an end").multiplier;
    agrees!("Continuum: tension across the beds", "f_t", "Pa", reach([0.0; 3], [0.0, 1.0, 0.0]), 0.05e6, 1e-6);
    agrees!("Continuum: pressure across the beds", "f_c", "Pa", reach([0.0; 3], [0.0, -1.0, 0.0]), 3e6, 1e-6);
    let shear = reach([-0.2e6, -0.5e6, 0.0], [0.0, 0.0, 1.0]);
    agrees!("Continuum: shear of pressed beds", "c + μ p", "Pa", shear, 0.5e6, 1e-6);
}

/// Horizontal tension under pressure alone, head joints open: σ11 = μ p b/(2a), what interlocking gives.
#[test]
fn interlocking_bears_tension() {
    let (_, cell) = bond(0.4, 0.2);
    let domain = Domain::new(&cell, Some(Strength::dry(0.65)), None);
    let reach = domain.reach([0.0, -0.1e6, 0.0], [1.0, 0.0, 0.0]).expect("a solution").expect("an end");
    agrees!(
        "Continuum: tension that interlocking bears, head joints open",
        "μ p b/(2a)",
        "Pa",
        reach.multiplier,
        0.065e6,
        1e-6
    );
    // A stack bond without heads bears none.
    let laying = Laying { thickness: 0.1, mortar: [0.0; 2], bed: JOINTS, head: JOINTS };
    let stack = Cell::shifted(0.4, 0.2, 0.0, &laying).expect("a cell");
    let none = Domain::new(&stack, Some(Strength::dry(0.65)), None);
    let reach = none.reach([0.0, -0.1e6, 0.0], [1.0, 0.0, 0.0]).expect("a solution").expect("an end");
    assert!(reach.multiplier.abs() < 1.0, "{reach:?}");
}

/// A wall that bears no more than friction does not bear tension to begin with.
#[test]
fn what_lies_outside_is_said() {
    let (_, cell) = bond(0.4, 0.2);
    let domain = Domain::new(&cell, Some(Strength::dry(0.65)), Some(Strength::dry(0.65)));
    let outside = domain.reach([0.0, 0.1e6, 0.0], [1.0, 0.0, 0.0]);
    assert!(matches!(outside, Err(concio_continuum::ContinuumError::Outside)), "{outside:?}");
}

/// Pressure on a half of a bed: the wall turns about an edge, n t/2.
#[test]
fn dry_walls_bend_about_an_edge() {
    let (bond, _) = bond(0.26, 0.065);
    let bending = dry_bending(&bond, 0.6, 10e3);
    agrees!("Continuum: dry wall that bends about a bed", "n t/2", "N", bending.m22, 500.0, 1e-12);
    // c = 130, t = 100 mm: r̄ between the shorter half side over 2 and half of the diagonal.
    assert!(bending.m11 > 0.6 * 10e3 * 2.0 * 0.04 && bending.m11 < 0.6 * 10e3 * 2.0 * 0.05, "{bending:?}");
}
