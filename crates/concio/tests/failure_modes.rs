//! One wall file, three panels: aspect ratio and load on top decide how they fail.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::planar::{Failure, Mode, failure};
use concio::quantity::ForcePerLength;
use concio::run::{prepare, run_in_memory};

const PANEL: &str = include_str!("../../../examples/16-shear-panel.toml");

fn pushed(bricks: usize, courses: usize, load: f64) -> Failure {
    let mut file = from_str(PANEL, Syntax::Toml, None).expect("the example");
    let panel = &mut file.case.panels[0];
    (panel.bricks, panel.courses) = (Some(bricks), Some(courses));
    file.case.load.top = ForcePerLength::from_si(load);
    let prepared = prepare(file.case, Path::new(".")).expect("a wall");
    let outcome = run_in_memory(&prepared).expect("a run");
    failure(&prepared.model.wall, &prepared.model.joints, &outcome.recording).expect("frames")
}

#[test]
fn panels_rock_crack_or_slide() {
    let slender = pushed(4, 16, 50e3);
    assert_eq!(slender.modes, [Mode::Rocking], "{slender:?}");
    assert!(slender.rocking > 0.8, "{slender:?}");
    let square = pushed(6, 10, 150e3);
    assert_eq!(square.modes, [Mode::Diagonal], "{square:?}");
    let squat = pushed(12, 4, 10e3);
    assert_eq!(squat.modes, [Mode::Sliding], "{squat:?}");
    assert!(squat.sliding > 0.8, "{squat:?}");
}
