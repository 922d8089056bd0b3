//! A stone as high as two courses beside it has joints with both and with what lies on it.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::run::prepare_case;
use concio_verified::agrees;

/// Beam and load of 6363.5 N on two equal seats: 3577 N on the base under the tall stone, 3571 N under the two beside it.
#[test]
fn a_tall_block_bears_what_lies_on_it() {
    let block = |course: usize, x: f64, y: f64, length: f64, height: f64| {
        format!("[[panel.block]]\ncourse = {course}\nx = {x}\ny = {y}\nlength = {length}\nheight = {height}\n")
    };
    let blocks = [
        block(1, 0.0, 0.01, 0.3, 0.61),
        block(1, 0.31, 0.01, 0.3, 0.3),
        block(2, 0.31, 0.32, 0.3, 0.3),
        block(3, 0.0, 0.63, 0.61, 0.2),
    ];
    for model in ["shear", "planar"] {
        let text = format!(
            "model = \"{model}\"\n[[panel]]\nbond = \"explicit\"\n\
             brick = {{ length = 0.3, height = 0.3, thickness = 0.12, specific_weight = 18e3 }}\nmortar = {{ bed = 0.01, head = 0.01 }}\n\
             {}[joint]\nbed = {{ law = \"elastic\", stiffness = 5e7 }}\nhead = {{ law = \"elastic\", stiffness = 5e7 }}\n\
             friction = {{ law = \"coulomb\", static = 0.6 }}\n[load]\ntop = 10e3\n[motion]\nduration = 0.01\n",
            blocks.concat()
        );
        let file = from_str(&text, Syntax::Toml, None).expect("a wall file");
        let model = prepare_case(file.case, Path::new(".")).expect("a wall").model;
        let names = model.joint_names();
        for name in ["p1c1b1|p1c3b1", "p1c1b1|p1c2b1", "p1c1b1|p1c1b2", "p1c2b1|p1c3b1"] {
            assert!(names.iter().any(|n| n == name), "{name}: {names:?}");
        }
        let planar = model.planar().is_some();
        for (name, force) in [("base|p1c1b1", 3577.0), ("base|p1c1b2", 3571.0)] {
            let e = names.iter().position(|n| n == name).expect("a joint");
            let rub = model.shear.rubs.iter().find(|r| r.joint as usize == e).expect("friction");
            let model = if planar { "planar" } else { "shear" };
            let subject = format!(
                "Walls and loads: stone as high as two courses, what the base bears; {model} model, {}",
                name.replace('|', " and ")
            );
            agrees!(subject, "beam and load on two equal seats, by hand", "N", rub.normal[0], force, 1e-3);
        }
    }
}
