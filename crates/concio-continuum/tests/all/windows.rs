//! Windows of walls without a cell.

use concio::case::{Syntax, from_str};
use concio_continuum::{Heads, Texture, window, windows};
use concio_verified::agrees;

use crate::references::S1;

fn texture(panel: &str) -> Texture {
    let text = format!(
        "model = \"planar\"\n[[panel]]\n{panel}\nbrick = {{ length = 0.26, height = 0.065, thickness = 0.12, specific_weight = 18e3 }}\n\
         [joint]\nbed = {{ law = \"elastic\", stiffness = \"36 N/mm3\" }}\nhead = {{ law = \"elastic\", stiffness = \"86.4 N/mm3\" }}\n\
         [motion]\nduration = 1.0\n"
    );
    let file = from_str(&text, Syntax::Toml, None).expect("a wall");
    Texture::of(&file.case, Heads::Closed).expect("a texture")
}

/// A window of a bond that repeats has the moduli of its cell: strain is uniform but for the border, where bricks lack a side.
#[test]
fn a_window_of_running_bond_has_its_moduli() {
    let texture = texture("bond = \"running\"\ncourses = 40\nbricks = 36");
    let expected = S1.bond().moduli().membrane;
    let (three, overlap) = windows(&texture.wall, 0);
    assert!(!overlap);
    for (k, w) in three.iter().enumerate() {
        let found = window(&texture.wall, &texture.joints, &texture.stiffness, w).expect("moduli");
        assert!(found.skew < 0.01, "{found:?}");
        for (i, name) in ["A1111", "A2222", "A1212"].iter().enumerate() {
            let subject = format!("Continuum: window of running bond; {name}, window {k}");
            agrees!(subject, "(H1), (H2)", "N/m", found.membrane[i][i], expected[i][i], 0.02);
        }
    }
}

#[test]
fn an_irregular_wall_scatters() {
    let texture = texture(
        "bond = \"irregular\"\ncourses = 16\nrandom = { seed = 11, width = \"5 m\", length = [\"140 mm\", \"320 mm\"], height = [\"50 mm\", \"90 mm\"], stagger = \"40 mm\" }",
    );
    let (three, overlap) = windows(&texture.wall, 0);
    assert!(!overlap);
    let found = three.map(|w| window(&texture.wall, &texture.joints, &texture.stiffness, &w).expect("moduli"));
    let e: Vec<f64> = found.iter().map(|w| w.membrane[0][0]).collect();
    let (least, most) = e.iter().fold((f64::INFINITY, 0.0f64), |(a, b), v| (v.min(a), v.max(b)));
    assert!(most > least * 1.001 && most < 1.5 * least, "{e:?}");
    // Neither far from a running bond of the mean stone.
    let running = S1.bond().moduli().membrane;
    for w in found {
        assert!(w.inside > 30 && w.membrane[2][2] > 0.0);
        for i in 0..3 {
            assert!((0.5..1.6).contains(&(w.membrane[i][i] / running[i][i])), "{i}: {w:?}");
        }
    }
}

#[test]
fn a_window_of_few_bricks_is_refused() {
    let texture = texture("bond = \"running\"\ncourses = 2\nbricks = 3");
    let (three, overlap) = windows(&texture.wall, 0);
    assert!(overlap);
    let error =
        window(&texture.wall, &texture.joints, &texture.stiffness, &three[0]).expect_err("too small").to_string();
    assert!(error.contains("neighbours on all sides") && error.contains("6 or more"), "{error}");
}
