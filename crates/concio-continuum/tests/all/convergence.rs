//! How the bricks come to the continuum: a wall without sides, and panels with free sides; Concio's planar walls beside both.

use concio::case::{
    Beam, BeamRotation, Brick, Case, CaseFile, DisplacementPath, Joints, ModelKind, Motion, Panel, Signal, Spring,
    SpringLaw,
};
use concio::quantity::Stiffness as Given;
use concio::run::{prepare, run_in_memory};
use concio_continuum::{Heads, Texture, membrane_stiffness, panel_stiffness, scale};
use concio_verified::agrees;

use crate::references::{Reference, S1, S2};

/// Displacement of the beam [m]: so small that walls stay as they are laid, so large that places are not rounded.
const PUSH: f64 = 1e-8;

fn given(per_area: f64, ratio: f64) -> Spring {
    let stiffness = Given::parse(&format!("{per_area} N/m3")).expect("a stiffness per area");
    Spring { normal_to_shear: ratio, ..Spring::new(SpringLaw::Elastic, stiffness) }
}

/// A panel of elastic joints under a beam that is moved, without friction, bond and load, of hardly any weight.
fn panel(wall: &Reference, [bricks, courses]: [usize; 2]) -> Case {
    let brick = Brick::new(wall.brick, 1e-3);
    let bed = given(wall.bed.tangential, wall.bed.normal / wall.bed.tangential);
    let head = given(wall.head.normal, wall.head.normal / wall.head.tangential);
    let path = DisplacementPath { displacements: vec![PUSH.into()], speed: (PUSH / 0.1).into() };
    let motion = Motion { top: Signal::Path(path), quasi_static: true, ..Motion::default() };
    let panel = Panel::running(courses, bricks, brick, [0.0; 2]);
    let mut case = Case::new(ModelKind::Planar, panel, Joints::new(bed, head), motion);
    (case.load.beam, case.load.beam_rotation) = (Beam::Driven, BeamRotation::Fixed);
    case.solver.step = Some(0.05.into());
    case
}

/// Stiffness of a panel by a run of Concio's planar model.
fn run(wall: &Reference, size: [usize; 2]) -> f64 {
    let file = CaseFile::of(&panel(wall, size)).expect("a wall");
    let outcome = run_in_memory(&prepare(&file).expect("a wall")).expect("a run");
    outcome.push().expect("a push").stiffness
}

/// The same by the assembly of its joints.
fn assembled(wall: &Reference, size: [usize; 2]) -> f64 {
    let texture = Texture::of(&panel(wall, size), Heads::Closed).expect("a texture");
    panel_stiffness(&texture.wall, &texture.joints, &texture.stiffness).expect("a stiffness")
}

/// Errors of A1212 by courses.
const WITHOUT_SIDES: [(&Reference, [f64; 7]); 2] = [
    (&S1, [-0.32198, -0.19194, -0.10616, -0.05606, -0.02884, -0.01463, -0.00737]),
    (&S2, [-0.29319, -0.17230, -0.09428, -0.04947, -0.02536, -0.01285, -0.00646]),
];
const COURSES: [usize; 7] = [2, 4, 8, 16, 32, 64, 128];

#[test]
fn walls_without_sides_come_to_the_continuum_as_one_over_their_courses() {
    for (wall, expected) in WITHOUT_SIDES {
        let errors = COURSES.map(|n| scale(&wall.cell(), n).expect("an error"));
        for ((n, found), expected) in COURSES.iter().zip(errors).zip(expected) {
            let subject = format!("Continuum: error of A1212 in a wall without sides; {} {n} courses", wall.name);
            agrees!(subject, "reference table, five digits", "", found, expected, abs: 6e-6);
        }
        let order = (errors[5] / errors[6]).log2();
        assert!((order - 1.0).abs() < 0.02, "{}: order {order}", wall.name);
    }
}

/// Two long planar walls differ by a part without ends: (K₂ − K₁) H/(L₂ − L₁) is G_N of a wall without sides.
#[test]
fn long_planar_walls_have_the_shear_stiffness_of_walls_without_sides() {
    for (wall, [length, height, _], sizes) in
        [(&S1, S1.brick, [[2, 16, 22], [4, 24, 32]]), (&S2, S2.brick, [[2, 20, 26], [4, 40, 48]])]
    {
        let g = wall.bond().moduli().membrane[2][2];
        for [courses, shorter, longer] in sizes {
            let [less, more] = [shorter, longer].map(|bricks| run(wall, [bricks, courses]));
            let found = (more - less) * courses as f64 * height / ((longer - shorter) as f64 * length) / g - 1.0;
            let expected = scale(&wall.cell(), courses).expect("an error");
            let subject =
                format!("Continuum: error of A1212 by runs of two long walls; {} {courses} courses", wall.name);
            agrees!(subject, "the same without sides", "", found, expected, abs: 1e-5);
        }
    }
}

/// Bricks × courses, and K [N/m].
type Row = ([usize; 2], f64);
const PANELS: [(&Reference, [Row; 5], f64); 2] = [
    (
        &S1,
        [
            ([2, 8], 1.498830e8),
            ([4, 16], 1.595216e8),
            ([8, 32], 1.639770e8),
            ([16, 64], 1.664557e8),
            ([32, 128], 1.679133e8),
        ],
        1.69675e8,
    ),
    (
        &S2,
        [
            ([2, 4], 4.573080e7),
            ([4, 8], 5.272251e7),
            ([8, 16], 5.690950e7),
            ([16, 32], 5.921062e7),
            ([32, 64], 6.041978e7),
        ],
        6.16740e7,
    ),
];

#[test]
fn panels_of_bricks_come_to_the_continuum() {
    for (wall, rows, continuum) in PANELS {
        let found: Vec<f64> = rows.iter().map(|(size, _)| assembled(wall, *size)).collect();
        for ((size, expected), found) in rows.iter().zip(&found) {
            let subject = format!("Continuum: stiffness of a panel; {} {size:?}", wall.name);
            agrees!(subject, "reference table", "N/m", *found, *expected, 1e-6);
        }
        let [length, height, _] = wall.brick;
        let sides = [rows[0].0[0] as f64 * length, rows[0].0[1] as f64 * height];
        let own = membrane_stiffness(&wall.bond().moduli().membrane, sides, 32).expect("a stiffness");
        agrees!(
            format!("Continuum: finite elements of a panel; {}", wall.name),
            "reference table",
            "N/m",
            own,
            continuum,
            2e-5
        );
        // Beside the limit of ever finer elements, which the coarser meshes tell.
        let errors: Vec<f64> = found.iter().map(|k| 1.0 - k / continuum).collect();
        let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
        println!("{}: errors {errors:.4?}, orders {orders:.3?}", wall.name);
        assert!(orders.iter().all(|o| *o >= 0.8), "{}: {orders:?}", wall.name);
    }
}

/// The sizes that take seconds, by runs of planar walls.
#[test]
fn planar_walls_have_the_stiffness_of_their_assembly() {
    for (wall, rows, continuum) in PANELS {
        let found: Vec<f64> = rows[..3].iter().map(|(size, _)| run(wall, *size)).collect();
        for ((size, expected), found) in rows.iter().zip(&found) {
            let subject = format!("Continuum: stiffness of a planar wall without inertia; {} {size:?}", wall.name);
            agrees!(subject, "reference table", "N/m", *found, *expected, 1e-6);
        }
        let errors: Vec<f64> = found.iter().map(|k| 1.0 - k / continuum).collect();
        let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
        assert!(orders.iter().all(|o| *o >= 0.8), "{}: {orders:?}", wall.name);
    }
}

/// The extra bed joint explains a third to a half of what panels lack.
#[test]
fn the_bed_at_the_base_is_a_part_of_the_error() {
    for (wall, rows, continuum) in PANELS {
        let length = rows[0].0[0] as f64 * wall.brick[0];
        let bed = wall.bed.tangential * wall.brick[2] * length;
        // The table's panels keep their size; joints are as many as courses.
        for (k, (_, found)) in rows.iter().enumerate() {
            let finer = 2f64.powi(k as i32);
            let corrected = 1.0 / (1.0 / continuum + 1.0 / (bed * finer));
            let share = (continuum - corrected) / (continuum - found);
            println!("{} {k}: {share:.2}", wall.name);
            assert!((0.2..0.7).contains(&share), "{} {k}: {share}", wall.name);
        }
    }
}

/// 32 elements a side are enough: 16 differ by less than bricks do from any of them.
#[test]
fn finite_elements_converge() {
    let a = S1.bond().moduli().membrane;
    let [coarse, fine, finest] = [8, 16, 32].map(|n| membrane_stiffness(&a, [0.52, 0.52], n).expect("a stiffness"));
    assert!(coarse > fine && fine > finest, "stiffer than they are: {coarse} {fine} {finest}");
    assert!(fine / finest - 1.0 < 2e-4, "{}", fine / finest - 1.0);
    // Pure shear of a wide panel without coupling: G L/H.
    let wide =
        membrane_stiffness(&[[1.0, 0.0, 0.0], [0.0, 1e9, 0.0], [0.0, 0.0, 1.0]], [1.0, 1.0], 8).expect("a stiffness");
    assert!(wide > 0.8 && wide <= 1.0 + 1e-9, "{wide}");
}
