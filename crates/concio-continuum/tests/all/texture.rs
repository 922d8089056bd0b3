//! From wall files to bonds, stiffnesses and strengths.

use concio::case::{Syntax, from_str};
use concio_continuum::{ContinuumError, Heads, Moduli, Pattern, Strength, Texture};
use concio_verified::agrees;

use crate::references::S1M;

fn wall(model: &str, panel: &str, joint: &str) -> Result<Texture, concio::Error> {
    let text = format!(
        "model = \"{model}\"\n[[panel]]\n{panel}\nbrick = {{ length = \"250 mm\", height = \"55 mm\", thickness = \"120 mm\", specific_weight = 18e3 }}\n\
         mortar = {{ bed = \"10 mm\", head = \"10 mm\" }}\n[joint]\n{joint}\n[motion]\nduration = 1.0\n"
    );
    let file = from_str(&text, Syntax::Toml, None).expect("a wall");
    Texture::of(&file.case, Heads::Closed)
}

const RUNNING: &str = "bond = \"running\"\ncourses = 6\nbricks = 4";
const ELASTIC: &str =
    "bed = { law = \"elastic\", stiffness = \"36 N/mm3\" }\nhead = { law = \"elastic\", stiffness = \"86.4 N/mm3\" }";

fn moduli(texture: &Texture, repeated: bool) -> Moduli {
    match texture.pattern(0, repeated).expect("a pattern") {
        Pattern::Running(bond, _) => bond.moduli(),
        Pattern::Repeated(cell) => Moduli::of_cell(&cell).expect("moduli"),
        Pattern::Irregular(why) => panic!("{why}"),
    }
}

#[test]
fn a_wall_file_gives_the_moduli_of_the_table() {
    let expected = S1M.bond().moduli();
    // Per joint: half a brick is 120 × 120 mm of contact of a reference of 125 mm, a head joint 55 × 120 mm.
    let per_joint = format!(
        "bed = {{ law = \"elastic\", stiffness = {} }}\nhead = {{ law = \"elastic\", stiffness = {} }}",
        36e9 * 0.125 * 0.12,
        86.4e9 * 0.055 * 0.12
    );
    for (name, model, joint) in
        [("planar", "planar", ELASTIC), ("shear", "shear", ELASTIC), ("per joint", "planar", &per_joint)]
    {
        let texture = wall(model, RUNNING, joint).expect("a texture");
        let found = moduli(&texture, false);
        for i in 0..3 {
            let subject = format!("Continuum: A{0}{0} of a wall file; {name}", i + 1);
            agrees!(
                subject,
                "reference table S1m by (H1), (H2)",
                "N/m",
                found.membrane[i][i],
                expected.membrane[i][i],
                1e-12
            );
        }
        assert!((texture.bed_ratio(0).expect("one bed") - 2.4).abs() < 1e-12);
    }
}

/// Listed courses that repeat, here running bond again.
#[test]
fn listed_courses_are_a_cell() {
    let courses = "bond = \"irregular\"\n[[panel.course]]\nheight = \"55 mm\"\nbricks = [\"250 mm\", \"250 mm\", \"250 mm\"]\n\
                   [[panel.course]]\nheight = \"55 mm\"\nbricks = [\"250 mm\", \"250 mm\", \"250 mm\"]\noffset = \"130 mm\"\n[panel.x]";
    let courses = courses.replace("\n[panel.x]", "");
    let text = format!(
        "model = \"planar\"\n[joint]\n{ELASTIC}\n[motion]\nduration = 1.0\n[[panel]]\n\
         brick = {{ length = \"250 mm\", height = \"55 mm\", thickness = \"120 mm\", specific_weight = 18e3 }}\nmortar = {{ bed = \"10 mm\", head = \"10 mm\" }}\n{courses}\n"
    );
    let file = from_str(&text, Syntax::Toml, None).expect("a wall");
    let texture = Texture::of(&file.case, Heads::Closed).expect("a texture");
    let expected = S1M.bond().moduli();
    let found = moduli(&texture, true);
    for i in 0..3 {
        let subject = format!("Continuum: A{0}{0} of listed courses that repeat", i + 1);
        agrees!(subject, "(H1), (H2)", "N/m", found.membrane[i][i], expected.membrane[i][i], 1e-9);
    }
    assert!(matches!(texture.pattern(0, false).expect("a pattern"), Pattern::Irregular(_)));
}

#[test]
fn walls_without_moduli_are_refused_with_their_key() {
    let refused = |joint: &str, parts: &[&str]| {
        let error = wall("planar", RUNNING, joint).expect_err("no moduli").to_string();
        for part in parts {
            assert!(error.contains(part), "{part}: {error}");
        }
    };
    refused("bed = { law = \"rigid\" }\nhead = { law = \"none\" }", &["joint.bed.law", "rigid", "allowed"]);
    refused("bed = { law = \"none\" }\nhead = { law = \"none\" }", &["joint.bed.law", "nothing"]);
    refused(
        &format!(
            "{ELASTIC}\n[[joint.change]]\nat = {{ course = [3], kind = [\"bed\"] }}\ndevice = {{ law = \"friction-damper\", slip_force = 1e3 }}"
        ),
        &["joint.change", "device"],
    );
    let one = wall("planar", "bond = \"running\"\ncourses = 1\nbricks = 4", ELASTIC).expect("a texture");
    let error = one.pattern(0, false).expect_err("one course").to_string();
    assert!(error.contains("panel[0].courses") && error.contains("two courses"), "{error}");
    let running = wall("planar", RUNNING, ELASTIC).expect("a texture");
    assert!(matches!(running.pattern(0, true), Ok(Pattern::Running(..))));
}

/// What a wall stands on is no part of its continuum.
#[test]
fn supports_may_be_rigid() {
    let joint = format!("{ELASTIC}\nbase = {{ law = \"rigid\" }}");
    let texture = wall("planar", RUNNING, &joint).expect("a texture");
    assert_eq!(moduli(&texture, false), S1M.bond().moduli());
}

#[test]
fn joints_that_differ_make_a_wall_irregular() {
    let changed = format!(
        "{ELASTIC}\n[[joint.change]]\nat = {{ course = [3], kind = [\"bed\"] }}\nspring = {{ stiffness = \"18 N/mm3\" }}"
    );
    let texture = wall("planar", RUNNING, &changed).expect("a texture");
    let Pattern::Irregular(why) = texture.pattern(0, false).expect("a pattern") else { panic!("regular") };
    assert!(why.contains("differ"), "{why}");
}

#[test]
fn strength_is_that_of_bond_or_friction() {
    let joint = format!(
        "{ELASTIC}\nfriction = {{ law = \"coulomb\", static = 0.6 }}\n\
         bond = {{ tensile_strength = \"0.05 MPa\", cohesion = \"0.1 MPa\", friction_angle = \"30 deg\" }}"
    );
    let texture = wall("planar", RUNNING, &joint).expect("a texture");
    let bonded = texture.bonded(0).expect("a bond").bed.expect("beds");
    assert!((bonded.friction - 30f64.to_radians().tan()).abs() < 1e-12);
    assert_eq!((bonded.cohesion, bonded.tension, bonded.compression), (0.1e6, 0.05e6, f64::INFINITY));
    let dry = texture.dry(0);
    assert_eq!(dry.bed, Some(Strength::dry(0.6)));
    // Friction is on beds unless the file says otherwise.
    assert_eq!(dry.head, Some(Strength::dry(0.0)));
    let dry = wall("planar", RUNNING, ELASTIC).expect("a texture");
    assert!(dry.bonded(0).is_none());
}

#[test]
fn errors_say_what_they_are() {
    for (error, part) in [
        (ContinuumError::FallsApart, "holds"),
        (ContinuumError::Outside, "does not bear"),
        (ContinuumError::NotSolved("why".into()), "why"),
    ] {
        assert!(error.to_string().contains(part), "{error}");
    }
}
