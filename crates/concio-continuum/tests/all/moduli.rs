//! Moduli: the reference table, and closed forms against periodic assemblies.

use concio_continuum::{Cell, CellCourse, Laying, Moduli, Stiffness};
use concio_verified::{agrees, farthest};

use crate::references::{Reference, S1, S1M, S2, S3};

/// Values of the table: A1111, A2222, A1212, p t, q t, D1111, D2222, D1212, F11, F22 [N/m, N m].
const TABLE: [(&Reference, [f64; 10]); 4] = [
    (
        &S1,
        [3.818880e9, 6.739200e8, 2.615671e8, 2.808e8, 3.81888e9, 6.164496e6, 8.087040e5, 1.427634e6, 2.2464e9, 2.808e8],
    ),
    (&S2, [2.4e8, 3.0e8, 8.923077e7, 1.2e8, 3.48e8, 2.2e6, 2.25e6, 1.0175e6, 1.68e8, 1.2e8]),
    (
        &S3,
        [1.123200e9, 6.739200e8, 2.543094e8, 2.808e8, 2.69568e9, 2.929680e6, 8.087040e5, 9.918090e5, 1.1232e9, 2.808e8],
    ),
    (
        &S1M,
        [3.317760e9, 6.220800e8, 2.410318e8, 2.592e8, 3.43872e9, 5.225472e6, 7.464960e5, 1.247031e6, 1.9872e9, 2.592e8],
    ),
];

const NAMES: [&str; 10] = ["A1111", "A2222", "A1212", "p t", "q t", "D1111", "D2222", "D1212", "F11", "F22"];

fn values(m: &Moduli) -> [f64; 10] {
    let (a, d) = (m.membrane, m.plate);
    [a[0][0], a[1][1], a[2][2], m.polar[0][0], m.polar[1][1], d[0][0], d[1][1], d[2][2], m.shear[0][0], m.shear[1][1]]
}

#[test]
fn running_bonds_have_the_moduli_of_the_table() {
    for (wall, expected) in TABLE {
        for ((name, found), expected) in NAMES.iter().zip(values(&wall.bond().moduli())).zip(expected) {
            let unit = if name.starts_with('D') { "N m" } else { "N/m" };
            agrees!(format!("Continuum: {name}; {}", wall.name), "reference table", unit, found, expected, 1e-6);
        }
        let m = wall.bond().moduli();
        assert_eq!((m.membrane[0][1], m.plate[0][1]), (0.0, 0.0));
    }
}

#[test]
fn engineering_constants_are_those_of_the_table() {
    for (wall, [e1, e2, g12]) in [
        (&S1, [31_824e6, 5_616e6, 2_179.73e6]),
        (&S2, [800e6, 1_000e6, 297.436e6]),
        (&S3, [9_360e6, 5_616e6, 2_119.25e6]),
        (&S1M, [27_648e6, 5_184e6, 2_008.60e6]),
    ] {
        let c = wall.bond().moduli().constants().expect("constants");
        for (name, found, expected) in [("E1", c.e1, e1), ("E2", c.e2, e2), ("G12", c.g12, g12)] {
            agrees!(format!("Continuum: {name}; {}", wall.name), "reference table", "Pa", found, expected, 3e-6);
        }
        assert_eq!(c.nu12, 0.0, "{}", wall.name);
    }
}

/// All numbers of moduli, each over the largest of its matrix.
fn all(m: &Moduli) -> Vec<f64> {
    let scaled = |rows: Vec<f64>| {
        let most = rows.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        rows.into_iter().map(move |v| v / most)
    };
    let own = |rows: &[[f64; 3]; 3]| rows.iter().flatten().copied().collect::<Vec<f64>>();
    let pair = |rows: &[[f64; 2]; 2]| rows.iter().flatten().copied().collect::<Vec<f64>>();
    scaled(own(&m.membrane))
        .chain(scaled(own(&m.plate)))
        .chain(scaled(pair(&m.shear)))
        .chain(scaled(pair(&m.polar)))
        .collect()
}

/// Numbers of one over those of the other, matrix by matrix.
fn off(m: &Moduli, n: &Moduli) -> f64 {
    let of = |a: Vec<f64>, b: Vec<f64>| {
        let most = b.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        farthest(a.into_iter().zip(b)) / most
    };
    let three = |rows: &[[f64; 3]; 3]| rows.iter().flatten().copied().collect::<Vec<f64>>();
    let two = |rows: &[[f64; 2]; 2]| rows.iter().flatten().copied().collect::<Vec<f64>>();
    [
        of(three(&m.membrane), three(&n.membrane)),
        of(three(&m.plate), three(&n.plate)),
        of(two(&m.shear), two(&n.shear)),
        of(two(&m.polar), two(&n.polar)),
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

#[test]
fn the_cell_of_one_brick_has_the_closed_forms() {
    for wall in [&S1, &S2, &S3, &S1M] {
        let off = off(&Moduli::of_cell(&wall.cell()).expect("moduli"), &wall.bond().moduli());
        let subject = format!("Continuum: cell of one brick; {}", wall.name);
        agrees!(subject, "(H1) to (H4), largest difference over the largest modulus", "", off, 0.0, abs: 1e-9);
    }
}

/// 4 × 4 bricks of running bond that repeat, six unknowns each.
fn assembly(wall: &Reference) -> Cell {
    let laying = wall.laying();
    let pitch = wall.brick[0] + laying.mortar[1];
    let course = |r: usize| CellCourse {
        height: wall.brick[1],
        bricks: vec![wall.brick[0]; 4],
        offset: if r % 2 == 1 { 0.5 * pitch } else { 0.0 },
    };
    Cell::of_courses(&[0, 1, 2, 3].map(course), 0.0, &laying).expect("a cell")
}

#[test]
fn an_assembly_of_bricks_has_the_closed_forms() {
    for wall in [&S1, &S2, &S3, &S1M] {
        let off = off(&Moduli::of_cell(&assembly(wall)).expect("moduli"), &wall.bond().moduli());
        let subject = format!("Continuum: 4 × 4 bricks that repeat; {}", wall.name);
        agrees!(subject, "(H1) to (H4), largest difference over the largest modulus", "", off, 0.0, abs: 1e-9);
    }
}

/// p and q of a stack bond, and what it has no more.
#[test]
fn a_stack_bond_has_its_own_forms() {
    let Laying { thickness: t, bed, head, .. } = S1M.laying();
    let cell = Cell::shifted(0.25, 0.055, 0.0, &S1M.laying()).expect("a cell");
    let m = Moduli::of_cell(&cell).expect("moduli");
    let (b, a, c, h) = (0.26, 0.065, 0.25, 0.055);
    let (p, q) = (bed.tangential * c * a / b, head.tangential * h * b / a);
    let expected = [
        ("A1111", m.membrane[0][0], t * head.normal * h * b / a),
        ("A2222", m.membrane[1][1], t * bed.normal * c * a / b),
        ("A1212", m.membrane[2][2], t * p * q / (p + q)),
        ("p t", m.polar[0][0], t * p),
        ("q t", m.polar[1][1], t * q),
    ];
    for (name, found, expected) in expected {
        agrees!(format!("Continuum: stack bond; {name}"), "closed form", "N/m", found, expected, 1e-9);
    }
}

/// By hand, for an overlap s and head mortar e: lattice steps (s b, a), ((s − 1) b, a) and (b, 0), contacts (1 − s) b − e, s b − e
/// and h_c, jumps E d + ω (d₂, −d₁).
fn by_hand(wall: &Reference, s: f64) -> [[f64; 3]; 3] {
    let Laying { thickness: t, mortar: [bed, e], .. } = wall.laying();
    let (b, a, h) = (wall.brick[0] + e, wall.brick[1] + bed, wall.brick[1]);
    let joints = [([s * b, a], (1.0 - s) * b - e, 1), ([(s - 1.0) * b, a], s * b - e, 1), ([b, 0.0], h, 0)];
    // Of ε11, ε22, γ12 and ω.
    let mut k = [[0.0; 4]; 4];
    for ([d1, d2], length, axis) in joints {
        let law = if axis == 1 { wall.bed } else { wall.head };
        let rows = [[d1, 0.0, 0.5 * d2, d2], [0.0, d2, 0.5 * d1, -d1]];
        for (direction, row) in rows.iter().enumerate() {
            let stiffness = if direction == axis { law.normal } else { law.tangential };
            for i in 0..4 {
                for j in 0..4 {
                    k[i][j] += t * stiffness * length * row[i] * row[j] / (a * b);
                }
            }
        }
    }
    std::array::from_fn(|i| std::array::from_fn(|j| k[i][j] - k[i][3] * k[3][j] / k[3][3]))
}

#[test]
fn other_overlaps_lean_to_one_side() {
    for wall in [&S1, &S1M] {
        let cell = Cell::shifted(wall.brick[0], wall.brick[1], 0.25, &wall.laying()).expect("a cell");
        let m = Moduli::of_cell(&cell).expect("moduli");
        let expected = by_hand(wall, 0.25);
        for i in 0..3 {
            for j in 0..3 {
                let subject = format!("Continuum: overlap of a quarter; {} A {i}{j}", wall.name);
                let within = 1e-9 * expected[0][0];
                agrees!(subject, "energy of the lattice by hand", "N/m", m.membrane[i][j], expected[i][j], abs: within);
            }
        }
        // Contacts (1 − s) b and s b of bricks that touch are in balance with their steps: the membrane leans by head mortar alone.
        let leans = m.membrane[0][2].abs() > 1e-3 * m.membrane[2][2];
        assert_eq!(leans, wall.name == "S1m", "{:?}", m.membrane);
        assert_eq!(m.constants().is_none(), leans);
        // Plates lean in either case, by k_s.
        assert!(m.plate[0][2].abs() > 1e-2 * m.plate[2][2], "{:?}", m.plate);
    }
}

/// Courses of two long bricks and of four short ones, heads in line over heads of other bricks: more than one brick in a cell.
fn mixed() -> Cell {
    let courses = [
        CellCourse { height: 0.065, bricks: vec![0.26, 0.26], offset: 0.0 },
        CellCourse { height: 0.065, bricks: vec![0.13, 0.13, 0.2, 0.06], offset: 0.05 },
        CellCourse { height: 0.1, bricks: vec![0.3, 0.22], offset: -0.1 },
    ];
    Cell::of_courses(&courses, 0.0, &S1.laying()).expect("a cell")
}

#[test]
fn moduli_are_symmetric_and_positive() {
    for cell in
        [mixed(), assembly(&S1), S2.cell(), S3.cell(), Cell::shifted(0.26, 0.065, 0.3, &S1.laying()).expect("a cell")]
    {
        let m = Moduli::of_cell(&cell).expect("moduli");
        for matrix in [m.membrane, m.plate] {
            let asymmetry = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| matrix[i][j] - matrix[j][i]);
            assert!(asymmetry.fold(0.0, |most: f64, v| most.max(v.abs())) <= 1e-12 * matrix[0][0]);
            let [[a, b, c], [_, d, e], [_, _, f]] = matrix;
            let minors = [a, a * d - b * b, a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d)];
            assert!(minors.iter().all(|v| *v > 0.0), "{matrix:?}");
        }
        let [[a, b], [_, c]] = m.shear;
        assert!(a > 0.0 && a * c - b * b > 0.0, "{:?}", m.shear);
        assert!(all(&m).iter().all(|v| v.is_finite()));
    }
}

/// A cell is no other if it is taken twice.
#[test]
fn a_cell_taken_twice_is_the_same() {
    let once = mixed();
    let courses = |lists: &[Vec<f64>]| {
        let of = |(k, bricks): (usize, &Vec<f64>)| CellCourse {
            height: [0.065, 0.065, 0.1][k % 3],
            bricks: bricks.clone(),
            offset: [0.0, 0.05, -0.1][k % 3],
        };
        lists.iter().enumerate().map(of).collect::<Vec<_>>()
    };
    let twice = |v: &[f64]| v.repeat(2);
    let lists = [twice(&[0.26, 0.26]), twice(&[0.13, 0.13, 0.2, 0.06]), twice(&[0.3, 0.22])];
    let doubled = [lists.clone(), lists].concat();
    let cell = Cell::of_courses(&courses(&doubled), 0.0, &S1.laying()).expect("a cell");
    let off = off(&Moduli::of_cell(&cell).expect("moduli"), &Moduli::of_cell(&once).expect("moduli"));
    agrees!("Continuum: a cell of eight bricks, taken four times", "taken once, largest difference over the largest modulus", "", off, 0.0, abs: 1e-9);
}

/// Twice the energy per area of a wave of rotations e^(i k·x) of bricks whose centres are held: what the mean rotation of two
/// neighbours does, and what the difference does. Their squares are cos²(φ/2) and 4 sin²(φ/2) with φ = k·d.
fn wave(cell: &Cell, k: [f64; 2]) -> [f64; 2] {
    let mut energy = [0.0; 2];
    for c in &cell.contacts {
        let half = 0.5 * (k[0] * c.apart[0] + k[1] * c.apart[1]);
        let jump = [c.apart[1], -c.apart[0]];
        let n = jump[0] * c.normal[0] + jump[1] * c.normal[1];
        let t = jump[1] * c.normal[0] - jump[0] * c.normal[1];
        let step = c.stiffness.normal * n * n + c.stiffness.tangential * t * t;
        energy[0] += c.length * step * half.cos().powi(2);
        energy[1] += c.stiffness.normal * c.length.powi(3) / 12.0 * 4.0 * half.sin().powi(2);
    }
    energy.map(|e| cell.thickness * e / cell.area)
}

/// What neighbours turn against each other under a gradient has the energy of C1 and C2; and long waves of rotation have less, by
/// what the mean rotation of neighbours falls short of the rotation between them: a quarter of (p + q) t times the step's square.
#[test]
fn couple_stiffness_is_the_energy_of_relative_rotation() {
    for wall in [&S1, &S2, &S1M] {
        let (cell, m) = (wall.cell(), wall.bond().moduli());
        let couple = m.couple.expect("one brick");
        let by_cell = Moduli::of_cell(&cell).expect("moduli").couple.expect("one brick");
        for (name, direction, closed, found) in
            [("C1", [1.0, 0.0], couple.c1, by_cell.c1), ("C2", [0.0, 1.0], couple.c2, by_cell.c2)]
        {
            let subject = format!("Continuum: couple stiffness {name}; {}", wall.name);
            agrees!(subject, "energy of relative rotation, summed over the joints", "N", found, closed, 1e-12);
            let small = 1e-3 / cell.area.sqrt();
            let [mean, difference] = wave(&cell, direction.map(|d| d * small)).map(|e| e / (small * small));
            let subject = format!("Continuum: {name} of a long wave, differences alone; {}", wall.name);
            agrees!(subject, "closed form", "N", difference, closed, 1e-5);
            // The whole wave has less: of the same order, and larger, is what the mean of neighbours falls short of.
            let still = wave(&cell, [0.0; 2])[0];
            let subject = format!("Continuum: rotation of all bricks; {name} {}", wall.name);
            agrees!(subject, "(p + q) t of (H2)", "N/m", still, m.polar[0][0] + m.polar[1][1], 1e-12);
            let short = mean - still / (small * small);
            assert!(short < 0.0 && short.abs() > closed, "{}: {name}: {short} beside {closed}", wall.name);
        }
    }
}

/// Flexibilities add: a wall of bricks as stiff as its joints is half as stiff, and rigid bricks change nothing.
#[test]
fn bricks_that_deform_add_their_flexibility() {
    let m = S1.bond().moduli();
    let c = m.constants().expect("constants");
    let soft = m.in_series(c.e2, 0.0).expect("a series").constants().expect("constants");
    agrees!(
        "Continuum: bricks in series with joints; E2 of bricks as stiff as the wall",
        "half",
        "Pa",
        soft.e2,
        0.5 * c.e2,
        1e-12
    );
    let stiff = m.in_series(1e18, 0.2).expect("a series").constants().expect("constants");
    assert!((stiff.e1 / c.e1 - 1.0).abs() < 1e-6 && (stiff.g12 / c.g12 - 1.0).abs() < 1e-6);
    let bricks = m.in_series(10e9, 0.2).expect("a series").constants().expect("constants");
    assert!((bricks.e1 * (1.0 / c.e1 + 1.0 / 10e9) - 1.0).abs() < 1e-12, "{bricks:?}");
    assert!(bricks.nu12 > 0.0 && bricks.g12 < c.g12 && bricks.g13 < c.g13);
    assert!(m.in_series(-1.0, 0.2).is_err() && m.in_series(1e9, 0.6).is_err());
}

#[test]
fn what_is_no_cell_is_refused() {
    let laying = S1.laying();
    assert!(Cell::shifted(0.26, 0.065, 1.0, &laying).is_err());
    assert!(Cell::shifted(0.0, 0.065, 0.5, &laying).is_err());
    let uneven = [
        CellCourse { height: 0.065, bricks: vec![0.26], offset: 0.0 },
        CellCourse { height: 0.065, bricks: vec![0.2], offset: 0.0 },
    ];
    let error = Cell::of_courses(&uneven, 0.0, &laying).expect_err("two widths").to_string();
    assert!(error.contains("0.2 m to 0.26 m") && error.contains("one width"), "{error}");
    assert!(Cell::of_courses(&[], 0.0, &laying).is_err());
}

#[test]
fn a_wall_that_falls_apart_has_no_constants() {
    let open = Laying { head: Stiffness::open(), ..S1.laying() };
    let cell = Cell::shifted(0.26, 0.065, 0.0, &open).expect("a cell");
    let m = Moduli::of_cell(&cell).expect("moduli");
    assert_eq!(m.membrane[0][0], 0.0, "columns side by side");
    assert!(m.constants().is_none());
}
