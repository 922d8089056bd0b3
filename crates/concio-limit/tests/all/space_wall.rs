//! Planar walls in space: what is taken from the wall file.

use concio_limit::space::{ContactKind, Face, analyse, of_wall};
use concio_limit::{LimitError, Options, Push};
use concio_verified::agrees;

use crate::limit_walls::DryWall;

/// Blocks of these walls are 1 m thick.
fn bears(wall: &DryWall, options: Options, face: Face) -> f64 {
    let problem = of_wall(&wall.problem(options), face).expect("rectangles");
    let limit = analyse(&problem).expect("a limit");
    assert!(limit.is_certified(), "{:?}", limit.bounds);
    limit.multiplier()
}

#[test]
fn a_wall_turns_at_thickness_over_height() {
    for full in [true, false] {
        let wall = DryWall::running(3, 8, [0.8, 0.4], 0.7, full);
        for face in [Face::Outwards, Face::Inwards] {
            let what = format!("Limit analysis in space: wall file; first course full: {full}, {face:?}");
            agrees!(what, "t/h", "", bears(&wall, Options::default(), face), 1.0 / 3.2, 1e-6);
        }
    }
}

/// A load with mass presses in the middle of the thickness and pushes at the middle of the top: λ (W h/2 + Q h) = (W + Q) t/2.
#[test]
fn loads_are_those_of_the_plane() {
    let mut wall = DryWall::stack(1, [1.0, 3.0], 0.9);
    let weight = 3.0 * wall.weight;
    wall.load = format!("top = {weight:?}");
    let found = bears(&wall, Options::default(), Face::Outwards);
    agrees!("Limit analysis in space: wall under a load with mass", "balance of moments", "", found, 1.0 / 4.5, 1e-6);
    wall.load += "\nmass = 0";
    let found = bears(&wall, Options::default(), Face::Outwards);
    agrees!(
        "Limit analysis in space: wall under a load without mass",
        "balance of moments",
        "",
        found,
        1.0 / 1.5,
        1e-6
    );
    let wall = DryWall::stack(2, [1.0, 1.0], 0.9);
    let top = Options { push: Push::Top, ..Options::default() };
    agrees!(
        "Limit analysis in space: top course pushed",
        "2 t/(3 h)",
        "",
        bears(&wall, top, Face::Outwards),
        2.0 / 3.0,
        1e-6
    );
}

/// An irregular texture with a hole: joints have the areas of the plane's times the thickness, and λ is not above that of one body.
#[test]
fn any_texture_of_rectangles() {
    let rows = [vec![1.0, 1.5, 0.5, 1.0], vec![0.5, 1.5, -1.0, 1.0], vec![1.0, 2.5, 0.5], vec![1.0, 2.0, 1.0]];
    let wall = DryWall::pattern(&rows, [0.6, 0.8], 0.8);
    let planar = wall.problem(Options::default());
    let problem = of_wall(&planar, Face::Outwards).expect("rectangles");
    assert_eq!(problem.assembly.bodies.len(), planar.wall.blocks.len());
    assert_eq!(4 * problem.assembly.contacts.len(), 2 * planar.assembly.points.len());
    let beds = problem.assembly.contacts.iter().filter(|c| c.kind == ContactKind::Bed);
    let area: f64 = beds.map(|c| c.sides().iter().product::<f64>()).sum();
    assert!((area - 0.6 * (3.0 + 3.0 + 4.0)).abs() < 1e-9, "{area}");
    let limit = analyse(&problem).expect("a limit");
    let turning = problem.turning().expect("level joints");
    assert!(limit.is_certified() && limit.bounds[0] <= turning.multiplier, "{:?} {turning:?}", limit.bounds);
}

#[test]
fn polygons_are_refused() {
    let mut planar = DryWall::stack(1, [1.0, 3.0], 0.9).problem(Options::default());
    let block = &mut planar.wall.blocks[0];
    let corners = vec![[0.0, 0.0], [1.0, 0.0], [0.9, 3.0], [0.1, 3.0]];
    block.shape = concio::wall::Shape::of(1, corners, block.x, block.y);
    let refused = of_wall(&planar, Face::Outwards).err();
    assert!(matches!(refused, Some(LimitError::Wrong(why)) if why.contains("polygon")));
}
