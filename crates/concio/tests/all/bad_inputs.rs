//! Wrong wall files: each error names file, line, key, cause and the allowed range. `cargo test -p concio --test all bad_inputs --
//! --nocapture` prints the table.

use std::path::Path;

use concio::case::{CaseFile, Syntax, from_str, read};
use concio::{Error, InputError, Result};

/// A right wall file; each wrong one differs from it in one place.
const GOOD: &str = r#"model = "shear"

[[panel]]
bond = "running"
courses = 6
bricks = 4
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }

[joint]
damping_ratio = 0.05
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m", rigidity = 1000 }
friction = { law = "stribeck", static = 0.6, dynamic = 0.42, slip_velocity = "1 mm/s" }

[load]
top = "10 kN/m"
beam = "driven"

[motion]
duration = "0.5 s"
base = "none"
top = { sine = { amplitude = "5 mm", frequency = "2 Hz" } }
"#;

/// A panel more.
const PANEL: &str = r#"[[panel]]
bond = "stack"
courses = 6
bricks = 1
brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }
"#;

/// A wrong file and what its error says.
struct Bad {
    title: &'static str,
    text: String,
    /// The first text of the line complained about.
    line_with: &'static str,
    key: &'static str,
    cause: &'static str,
    /// In `allowed` or, for suggestions, in `help`.
    allowed: &'static str,
}

/// `GOOD` with one text replaced.
fn edit(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "no `{from}` in the wall file");
    GOOD.replacen(from, to, 1)
}

/// The same of a planar wall.
fn planar(from: &str, to: &str) -> String {
    edit(from, to).replacen("\"shear\"", "\"planar\"", 1)
}

/// `GOOD` with another panel.
fn panel(lines: &str) -> String {
    let (head, tail) = GOOD.split_once("[[panel]]").expect("a panel");
    let (_, tail) = tail.split_once("[joint]").expect("joints");
    let brick = "brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }";
    format!("{head}[[panel]]\n{brick}\n{lines}\n[joint]{tail}")
}

fn block(course: usize, x: f64, y: f64, more: &str) -> String {
    format!("[[panel.block]]\ncourse = {course}\nx = {x}\ny = {y}\nlength = 0.25\nheight = 0.05\n{more}\n")
}

macro_rules! bad {
    ($($title:literal, $text:expr, $line_with:literal, $key:literal, $cause:literal, $allowed:literal;)+) => {
        vec![$(Bad { title: $title, text: $text.into(), line_with: $line_with, key: $key, cause: $cause, allowed: $allowed }),+]
    };
}

fn table() -> Vec<Bad> {
    let explicit = |blocks: &[String]| panel(&format!("bond = \"explicit\"\n{}", blocks.concat()));
    let random = |rest: &str| {
        panel(&format!(
            "bond = \"irregular\"\ncourses = 4\nmortar = {{ bed = 0.01, head = 0.01 }}\nrandom = {{ seed = 1, height = [0.05, 0.06], {rest} }}"
        ))
    };
    let shaped = |corners: &str, more: &str| {
        let lines = format!("bond = \"explicit\"\n[[panel.block]]\ncourse = 1\ncorners = {corners}\n{more}\n");
        panel(&lines).replacen("\"shear\"", "\"planar\"", 1)
    };
    let arch = |keys: &str| {
        panel(&format!("bond = \"arch\"\narch = {{ span = 2, thickness = 0.2, {keys} }}")).replacen(
            "\"shear\"",
            "\"planar\"",
            1,
        )
    };
    let tie = |keys: &str| edit("\"shear\"\n", &format!("\"planar\"\ntie = [{{ {keys} }}]\n"));
    let opening = |keys: &str| {
        panel(&format!(
            "bond = \"running\"\ncourses = 6\nbricks = 4\nmortar = {{ bed = 0.01, head = 0.01 }}\nopening = [{{ {keys} }}]"
        ))
    };
    let motion = |base: &str| edit("base = \"none\"", &format!("base = {base}"));
    let change = |lines: &str| edit("[load]", &format!("[[joint.change]]\n{lines}\n[load]"));
    let mut rows = keys_and_values();
    rows.extend(bad! {
        "negative brick length", edit("\"250 mm\"", "\"-250 mm\""), "brick =", "panel[0].brick.length", "-0.25 m is out of range", "above 0 m";
        "negative mass of the beam", edit("beam = \"driven\"", "beam = { mass = \"-1 t\" }"), "beam =", "load.beam.mass", "-1000 kg is out of range", "above 0 kg";
        "no course of a listed block", explicit(&[block(1, 0.0, 0.0, "").replace("course = 1", "course = -1")]), "course = -1", "panel[0].block[0].course", "the number -1 cannot stand here", "a whole number from 1";
        "two voussoirs and a half", arch("rise = 1, voussoirs = 2.5"), "arch =", "panel[0].arch.voussoirs", "the number 2.5 cannot stand here", "a whole number, 3 … 1,000";
        "opening of half a course", opening("x = 0.3, y = 0, width = 0.3, height = \"1.5 courses\""), "opening =", "panel[0].opening[0].height", "1.5 courses end within a course", "whole courses";
        "opening as wide as courses", opening("x = 0.3, y = 0, width = \"2 courses\", height = 0.13"), "opening =", "panel[0].opening[0].width", "2 courses: widths are counted in bricks", "a length, or bricks";
        "opening as high as bricks", opening("x = 0.3, y = 0, width = 0.3, height = \"1 brick\""), "opening =", "panel[0].opening[0].height", "1 brick: heights are counted in courses", "a length, or courses";
        "opening over more courses than there are", opening("x = 0.3, y = \"4 courses\", width = 0.3, height = \"3 courses\""), "opening =", "panel[0].opening[0].height", "an edge above course 7 lies outside the panel", "up to the panel's 6 courses";
        "opening in bricks of no length", random("width = 2, length = [0.2, 0.25], stagger = 0").replace("courses = 4", "courses = 4\nopening = [{ x = \"1 brick\", y = 0, width = 0.3, height = 0.2 }]"), "opening =", "panel[0].opening[0].x", "bricks of bond `irregular` have no one length", "a length; bricks in bond `running` or `stack`";
        "lintel on a joint", opening("x = 0.3, y = 0, width = 0.3, height = \"2 courses\", lintel = { height = \"1 course\", bearing = \"0.02 bricks\" }"), "opening =", "panel[0].opening[0].lintel.bearing", "0.02 bricks leave nothing to lie on", "more than a head joint";
        "rows for courses", opening("x = 0.3, y = 0, width = 0.3, height = \"2 rows\""), "opening =", "panel[0].opening[0].height", "`rows` is not a unit of length", "courses, bricks";
        "curly quotes", edit("\"250 mm\"", "“250 mm”"), "brick =", "", "not valid TOML", "texts stand in straight ones: brick = { length = \"250 mm\"";
        "a thousandth of a newton", edit("\"5.4e7 N/m\" }\nhead", "\"54 mN/m\" }\nhead"), "bed = { law", "joint.bed.stiffness", "`mN/m` is not a unit of stiffness, did you mean `MN/m`? (M is a million, m a thousandth)", "MN/m";
        "shear wall that is to stop", edit("duration =", "stop_at = \"collapse\"\nduration ="), "stop_at", "motion.stop_at", "the key is for planar walls", "leave it out";
        "stop before a collapse", planar("duration =", "stop_at = { collapse = -1 }\nduration ="), "stop_at", "motion.stop_at.collapse", "-1 s is out of range", "from 0 s";
        "stop at what there is not", planar("duration =", "stop_at = \"collaps\"\nduration ="), "stop_at", "motion.stop_at", "`collaps` is not known here", "did you mean `collapse`?";
        "zero thickness", edit("\"120 mm\"", "0"), "brick =", "panel[0].brick.thickness", "0 m is out of range", "above 0 m";
        "weight that is no number", edit("\"18 kN/m3\"", "nan"), "brick =", "panel[0].brick.specific_weight", "NaN N/m3 is out of range", "above 0 N/m3";
        "infinite load", edit("\"10 kN/m\"", "inf"), "top = inf", "load.top", "inf N/m is too large", "from 0 N/m";
        "no courses", edit("courses = 6", "courses = 0"), "courses = 0", "panel[0].courses", "0 is out of range", "from 1";
        "negative number of bricks", edit("bricks = 4", "bricks = -4"), "bricks =", "panel[0].bricks", "the number -4 cannot stand here", "a whole number from 1";
        "bricks left out", edit("bricks = 4\n", ""), "[[panel]]", "panel[0].bricks", "bond `running` needs it", "from 1";
        "a wall beyond all bounds", edit("courses = 6", "courses = 6000000000"), "[[panel]]", "panel[0]", "the wall would have up to 27000000000 blocks", "up to 500000 blocks";
        "panels beyond all bounds", edit("[joint]\n", &format!("{}[joint]\n", PANEL.repeat(1000))), "[[panel]]", "panel", "1001 panels are too many", "up to 1000";
        "ties beyond all bounds", tie(&vec!["from = \"base\", to = \"p1c1b1\", stiffness = 1e6"; 1001].join(" }, { ")), "tie =", "tie", "1001 ties are too many", "up to 1000";
        "openings beyond all bounds", opening(&vec!["x = 0.1, y = 0.1, width = 0.1, height = 0.1"; 1001].join(" }, { ")), "opening =", "panel[0].opening", "1001 openings are too many", "up to 1000";
        "name of a panel that is a book", edit("courses = 6", &format!("name = \"{}\"\ncourses = 6", "n".repeat(201))), "name =", "panel[0].name", "a name of 201 bytes is too long", "up to 200 bytes";
        "name with an end in it", edit("courses = 6", "name = \"a\\u0000b\"\ncourses = 6"), "name =", "panel[0].name", "a name holds U+0000", "all other characters";
        "name of a block that is a book", explicit(&[block(1, 0.0, 0.0, &format!("id = \"{}\"", "n".repeat(201)))]), "id =", "panel[0].block[0].id", "a name of 201 bytes is too long", "up to 200 bytes";
        "step below rounding", format!("{}[solver]\nstep = 1e-9\n", planar("0.5 s", "0.5 s")), "step", "solver.step", "1e-9 s is out of range", "from 1e-8 s";
        "mortar as long as the brick", edit("head = \"10 mm\"", "head = \"25 cm\""), "mortar", "panel[0].mortar.head", "leave no half brick", "below the brick's length, 0.25 m";
        "zero slip velocity", edit("\"1 mm/s\"", "0"), "friction", "joint.friction.slip_velocity", "0 m/s is out of range", "above 0 m/s";
        "dynamic friction above static", edit("dynamic = 0.42", "dynamic = 0.7"), "friction", "joint.friction.dynamic", "0.7 is above the static coefficient", "0 … 0.6";
        "damping beyond its range", edit("damping_ratio = 0.05", "damping_ratio = 5"), "damping_ratio", "joint.damping_ratio", "5 is out of range", "0 … 2";
        "zero rigidity", edit("rigidity = 1000", "rigidity = 0"), "head = { law", "joint.head.rigidity", "0 is out of range", "above 0";
        "friction without numbers", edit("static = 0.6, ", ""), "friction", "joint.friction.static", "law `stribeck` needs it", "from 0";
        "spring without stiffness", edit(", stiffness = \"5.4e7 N/m\"", ""), "bed = { law", "joint.bed.stiffness", "law `elastic` needs it", "from 0 N/m";
        "bond without strength", edit("[load]", "[joint.bond]\nmode_2_energy = \"50 N/m\"\n[load]"), "[joint.bond]", "joint.bond", "the bond has no strength", "`tensile_strength`, `cohesion` or `friction_angle` above 0";
        "negative cohesion", edit("[load]", "[joint.bond]\ncohesion = \"-0.1 MPa\"\n[load]"), "cohesion", "joint.bond.cohesion", "-100000 Pa is out of range", "from 0 Pa";
        "friction angle in degrees without unit", edit("[load]", "[joint.bond]\ncohesion = 1e5\nfriction_angle = 30\n[load]"), "friction_angle", "joint.bond.friction_angle", "is out of range", "0 … 80 deg (a number without unit is in rad)";
        "energy with the unit of a stress", edit("[load]", "[joint.bond]\ncohesion = 1e5\nmode_2_energy = \"50 Pa\"\n[load]"), "mode_2_energy", "joint.bond.mode_2_energy", "not a unit of energy per area", "N/m, J/m2";
        "stiffness left whole and more", edit("[load]", "[joint.bond]\ncohesion = 1e5\nresidual_stiffness = 1.5\n[load]"), "residual_stiffness", "joint.bond.residual_stiffness", "1.5 is out of range", "0 … 1";
        "bond on nothing", edit("[load]", "[joint.bond]\ncohesion = 1e5\non = []\n[load]"), "on = []", "joint.bond.on", "no kind of joint is named", "`bed`, `head`";
        "bond with a key too many", edit("[load]", "[joint.bond]\ncohesion = 1e5\nshear = 3\n[load]"), "shear", "joint.bond.shear", "unknown key", "cohesion";
        "change of a bond out of range", change("at = { kind = [\"bed\"] }\nbond = { mode_2_energy = -1 }"), "bond =", "joint.change[0].bond.mode_2_energy", "-1 N/m is out of range", "from 0 N/m";
        "negative stiffness per area", edit("law = \"elastic\", stiffness = \"5.4e7 N/m\"", "law = \"elastic\", stiffness = \"-36 N/mm3\""), "bed = { law", "joint.bed.stiffness", "-3.6e10 N/m3 is out of range", "from 0 N/m3";
        "stiffness with the unit of a stress", edit("law = \"elastic\", stiffness = \"5.4e7 N/m\"", "law = \"elastic\", stiffness = \"36 MPa\""), "bed = { law", "joint.bed.stiffness", "`MPa` is not a unit of stiffness", "N/m, kN/m, MN/m, GN/m, N/mm, kN/mm; per area of the joint: N/m3";
        "unknown model", edit("\"shear\"", "\"folding\""), "model", "model", "`folding` is not known here", "`shear`, `planar`, `rocking`";
        "step of a shear wall", format!("{GOOD}[solver]\nstep = \"1 ms\"\n"), "step", "solver.step", "the key is for planar walls", "with `model = \"planar\"`";
        "shear wall without inertia", edit("duration =", "quasi_static = true\nduration ="), "quasi_static", "motion.quasi_static", "the key is for planar walls", "leave it out";
        "shear wall shaken vertically", edit("base =", "vertical = { sine = { amplitude = \"1 mm\", frequency = 3 } }\nbase ="), "vertical", "motion.vertical", "the key is for planar walls", "leave it out";
        "level beam of a shear wall", edit("beam = \"driven\"", "beam = \"driven\"\nbeam_rotation = \"fixed\""), "beam_rotation", "load.beam_rotation", "the key is for planar walls", "leave it out";
        "normal stiffness of a shear wall", edit("rigidity = 1000", "normal_to_shear = 3"), "head = { law", "joint.head.normal_to_shear", "the key is for planar walls", "leave it out";
        "crushing in a shear wall", change("at = { kind = [\"head\"] }\nspring = { compressive_strength = \"5 MPa\" }"), "spring =", "joint.change[0].spring.compressive_strength", "the key is for planar walls", "leave it out";
        "rocking of a shear wall", edit("law = \"no-tension\"", "law = \"rigid\", rocking_restitution = 0.9"), "head = { law", "joint.head.rocking_restitution", "the key is for planar walls", "leave it out";
        "rocking changed in a shear wall", change("at = { kind = [\"head\"] }\nspring = { law = \"rigid\", rocking_restitution = 0.9 }"), "spring =", "joint.change[0].spring.rocking_restitution", "the key is for planar walls", "leave it out";
        "rocking of a spring", planar("rigidity = 1000", "rocking_restitution = 0.9"), "head = { law", "joint.head.rocking_restitution", "for law `rigid` alone", "no `rocking_restitution`";
        "rocking that grows", planar("law = \"no-tension\"", "law = \"rigid\", rocking_restitution = 1.1"), "head = { law", "joint.head.rocking_restitution", "1.1 is out of range", "0 … 1";
        "pressure by overburden in a planar wall", planar("slip_velocity =", "normal_force = \"overburden\", slip_velocity ="), "friction", "joint.friction.normal_force", "follows from the motion of its blocks", "`transmitted`";
        "preset of the report in a planar wall", planar("slip_velocity =", "preset = \"report\", slip_velocity ="), "friction", "joint.friction.preset", "follows from the motion of its blocks", "no preset";
        "level beam where there is none", planar("beam = \"driven\"", "beam_rotation = \"fixed\"").replace("top = { sine", "base = { sine").replace("base = \"none\"\n", ""), "beam_rotation", "load.beam_rotation", "there is no beam", "`driven`, `tied`";
        "joint softer when pressed", planar("rigidity = 1000", "normal_to_shear = 0"), "head = { law", "joint.head.normal_to_shear", "0 is out of range", "above 0";
        "joint without strength", planar("rigidity = 1000", "compressive_strength = \"0 MPa\""), "head = { law", "joint.head.compressive_strength", "0 Pa is out of range", "above 0 Pa";
        "step of no length", format!("{}[solver]\nstep = 0\n", planar("0.5 s", "0.5 s")), "step", "solver.step", "0 s is out of range", "from 1e-8 s";
        "tilt at once", motion("{ tilt = { acceleration = \"0.5 g\", rise = 0 } }"), "base =", "motion.base.tilt.rise", "0 s is out of range", "above 0 s";
        "path without places", motion("{ path = { displacements = [], speed = 1 } }"), "base =", "motion.base.path.displacements", "0 displacements are given", "at least one";
        "path that stands", motion("{ path = { displacements = [0.1, 0.1], speed = 1 } }"), "base =", "motion.base.path.displacements[1]", "0.1 m stands before it", "other than the one before it";
        "path that starts where it is", motion("{ path = { displacements = [0, 0.1], speed = 1 } }"), "base =", "motion.base.path.displacements[0]", "the path starts at 0 m", "the first other than 0";
        "path backwards", motion("{ path = { displacements = [0.1], speed = -1 } }"), "base =", "motion.base.path.speed", "-1 m/s is out of range", "above 0 m/s";
        "restitution above one", edit("law = \"no-tension\"", "law = \"rigid\", restitution = 1.2"), "head = { law", "joint.head.restitution", "1.2 is out of range", "0 … 1";
        "negative restitution", edit("law = \"no-tension\"", "law = \"rigid\", restitution = -0.1"), "head = { law", "joint.head.restitution", "-0.1 is out of range", "0 … 1";
        "restitution of a spring", edit("law = \"no-tension\"", "law = \"no-tension\", restitution = 0.5"), "head = { law", "joint.head.restitution", "for law `rigid` alone", "law = \"rigid\"";
        "restitution of a change", change("at = { kind = [\"head\"] }\nspring = { law = \"rigid\", restitution = 2 }"), "spring =", "joint.change[0].spring.restitution", "2 is out of range", "0 … 1";
        "driven beam at rest", edit("top = { sine = { amplitude = \"5 mm\", frequency = \"2 Hz\" } }", ""), "[motion]", "motion.top", "the beam is `driven` but has no motion", "sine";
        "top motion without a driven beam", edit("beam = \"driven\"", "beam = \"free\""), "top = { sine", "motion.top", "only a `driven` top beam takes a motion", "`none`";
        "sine with two amplitudes", edit("amplitude = \"5 mm\"", "amplitude = \"5 mm\", acceleration = \"0.8 g\""), "top = { sine", "motion.top.sine", "both a displacement and an acceleration", "exactly one";
        "sine without frequency", edit(", frequency = \"2 Hz\"", ""), "top = { sine", "motion.top.sine.frequency", "the key is missing", "f [Hz], above 0";
        "zero frequency", edit("\"2 Hz\"", "0"), "top = { sine", "motion.top.sine.frequency", "0 Hz is out of range", "above 0 Hz";
        "trim reversed", motion("{ record = \"a\", trim = [9, 3] }"), "base =", "motion.base.trim", "9 s comes before 3 s", "the first value below the second";
        "trim with one end", motion("{ record = \"a\", trim = [9] }"), "base =", "motion.base.trim", "the list has 1 values", "a list of 2 values";
        "scaled twice", motion("{ record = \"a\", scale = 2, pga = 3 }"), "base =", "motion.base.pga", "both `scale` and `pga`", "one of them";
        "negative sample interval", motion("{ record = \"a\", resample = \"-5 ms\" }"), "base =", "motion.base.resample", "-0.005 s is out of range", "above 0 s";
        "order of a filter", motion("{ record = \"a\", baseline = { high_pass = 0.1, order = 9 } }"), "base =", "motion.base.baseline.order", "9 is out of range", "1 … 8";
        "two baselines", motion("{ record = \"a\", baseline = { high_pass = 0.1, polynomial = 1 } }"), "base =", "motion.base.baseline", "either a polynomial or a high-pass", "{ polynomial = 2 }";
        "two motions", motion("{ record = \"a\", sine = { amplitude = 1, frequency = 1 } }"), "base =", "motion.base", "more than one motion", "exactly one of";
        "a path for a motion", motion("\"quake.at2\""), "base =", "motion.base", "`quake.at2` is not a motion; a file is given as { record", "\"none\"";
        "no duration", edit("duration = \"0.5 s\"\n", ""), "[motion]", "motion.duration", "no record says how long", "above 0 s";
        "output without end", format!("{GOOD}[output]\ninterval = 1e-12\n"), "interval", "output.interval", "more than 10,000,000 samples", "at least 5e-8 s";
        "unknown block kept", format!("{GOOD}[output]\nblocks = [\"p1c1b1\", \"p1c9b1\"]\n"), "blocks =", "output.blocks[1]", "no block is called `p1c9b1`", "did you mean `p1c";
        "tolerance", format!("{GOOD}[solver]\ntolerance = 0\n"), "tolerance", "solver.tolerance", "0 is out of range", "1e-12 … 0.1";
        "unknown panel chosen", change("at = { panel = [\"tower\"] }\nspring = { stiffness = 0 }"), "at =", "joint.change[0].at.panel[0]", "no panel is called `tower`", "`p1`";
        "course chosen that is not there", change("at = { course = [1, 8] }\nspring = { stiffness = 0 }"), "at =", "joint.change[0].at.course[1]", "course 8 does not exist", "1 … 6, and 7 for the top support";
        "region turned round", change("at = { region = [1, 0, 0, 1] }\nspring = { stiffness = 0 }"), "at =", "joint.change[0].at.region", "encloses nothing", "x0 below x1";
        "a change of nothing", change("at = { kind = [\"bed\"] }"), "[[joint.change]]", "joint.change[0]", "nothing is changed", "`spring`, `friction` or `bond`";
        "negative damping of a device", change("at = { kind = [\"bed\"] }\ndevice = { law = \"viscous\", damping = -2 }"), "device =", "joint.change[0].device.damping", "-2 N s/m is out of range", "above 0 N s/m";
        "unit of a device", change("at = { kind = [\"bed\"] }\ndevice = { law = \"viscous\", damping = \"2 kN/m\" }"), "device =", "joint.change[0].device.damping", "not a unit of damping constant", "N s/m";
        "unknown law of a device", change("at = { kind = [\"bed\"] }\ndevice = { law = \"viscus\" }"), "device =", "joint.change[0].device.law", "`viscus`", "`viscous`";
        "device without its key", change("at = { kind = [\"bed\"] }\ndevice = { law = \"friction-damper\" }"), "device =", "joint.change[0].device.slip_force", "law `friction-damper` needs it", "above 0";
        "key of another device", change("at = { kind = [\"bed\"] }\ndevice = { law = \"viscous\", damping = 1, yield_force = 3 }"), "device =", "joint.change[0].device.yield_force", "law `viscous` has no such key: it is for `bouc-wen`", "`damping`, `exponent`";
        "power of a dashpot", change("at = { kind = [\"bed\"] }\ndevice = { law = \"viscous\", damping = 1, exponent = 0.1 }"), "device =", "joint.change[0].device.exponent", "0.1 is out of range", "0.2 … 1";
        "hysteresis that is too smooth", change("at = { kind = [\"bed\"] }\ndevice = { law = \"bouc-wen\", yield_force = 1, yield_displacement = 1, sharpness = 0.5 }"), "device =", "joint.change[0].device.sharpness", "0.5 is out of range", "1 … 100";
        "hysteresis that gives energy", change("at = { kind = [\"bed\"] }\ndevice = { law = \"bouc-wen\", yield_force = 1, yield_displacement = 1, gamma = 0.6 }"), "device =", "joint.change[0].device.gamma", "0.6 is out of range", "above -0.5, up to 0.5";
        "flag higher than its force", change("at = { kind = [\"bed\"] }\ndevice = { law = \"re-centring\", stiffness = 1, activation_force = 1, flag = 1.2 }"), "device =", "joint.change[0].device.flag", "1.2 is out of range", "0 … 1";
        "flag that stiffens", change("at = { kind = [\"bed\"] }\ndevice = { law = \"re-centring\", stiffness = 1, activation_force = 1, flag = 1, post_stiffness = 2 }"), "device =", "joint.change[0].device.post_stiffness", "2 N/m is not below `stiffness`", "from 0 to below 1 N/m";
        "device beside mortar", change("at = { kind = [\"bed\"] }\ndevice = { law = \"viscous\", damping = 1 }\nspring = { stiffness = 0 }"), "device =", "joint.change[0].device", "a device takes the place of spring, friction and bond", "`device` alone";
        "panels of one name", edit("[joint]", "[[panel]]\nname = \"p1\"\nbond = \"stack\"\ncourses = 1\nbricks = 1\nbrick = { length = 1, height = 1, thickness = 1, specific_weight = 1 }\n[joint]"), "name =", "panel[1].name", "panel[0] is called `p1` too", "names that differ";
        "irregular without courses", panel("bond = \"irregular\""), "[[panel]]", "panel[0].course", "the courses are not given", "either [[panel.course]] or `random`";
        "explicit without blocks", panel("bond = \"explicit\""), "[[panel]]", "panel[0].block", "the panel has no block", "at least one";
        "a key of another bond", panel("bond = \"stack\"\ncourses = 1\nbricks = 1\nfirst = \"half\""), "first =", "panel[0].first", "does not go with bond `stack`", "with bond `running`";
        "duplicate ids", explicit(&[block(1, 0.0, 0.0, "id = \"a\""), block(2, 0.0, 0.05, "id = \"a\" # again")]), "id = \"a\" # again", "panel[0].block[1].id", "`a` is the name of panel[0].block[0] already", "unique";
        "overlapping blocks", explicit(&[block(1, 0.0, 0.0, "id = \"a\""), block(1, 0.2, 0.0, "id = \"b\""), block(2, 0.1, 0.05, "")]), "[[panel.block]]", "panel[0].block[1]", "blocks a and b overlap", "side by side";
        "blocks through each other", explicit(&[block(1, 0.0, 0.0, ""), block(2, 0.1, 0.06, ""), block(3, 0.1, 0.08, "")]), "[[panel.block]]", "panel[0].block[2]", "blocks p1c2b1 and p1c3b1 overlap", "share edges at most";
        "opening off the bed joints", opening("x = 0.3, y = 0.1, width = 0.3, height = 0.13"), "opening =", "panel[0].opening[0].y", "the edge at a height of 0.1 m is not on a bed joint", "0.065 … 0.075 m or 0.13 … 0.14 m";
        "opening that ends in a course", opening("x = 0.3, y = 0.065, width = 0.3, height = 0.1"), "opening =", "panel[0].opening[0].height", "the edge at a height of 0.165 m is not on a bed joint", "0.065 … 0.075 m or 0.13 … 0.14 m";
        "opening lower than a course", opening("x = 0.3, y = 0.065, width = 0.3, height = 0.005"), "opening =", "panel[0].opening[0].height", "is not on a bed joint", "0.065 … 0.075 m";
        "opening above the wall", opening("x = 0.3, y = 0.065, width = 0.3, height = 3"), "opening =", "panel[0].opening[0].height", "the edge at a height of 3.065 m is above the panel, whose top is at 0.39 m", "0.325 … 0.335 m";
        "opening above the wall, with a lintel", opening("x = 0.3, y = 0.065, width = 0.3, height = 3, lintel = { height = 0.13, bearing = 0.1 }"), "opening =", "panel[0].opening[0].height", "above the panel", "0.195 … 0.205 m";
        "opening in bare millimetres", opening("x = 300, y = 0, width = 300, height = 130"), "opening =", "panel[0].opening[0].x", "300 m in a panel of 1.03 m", "did you mean \"300 mm\"?";
        "bearing in bare millimetres", opening("x = 0.3, y = 0, width = 0.3, height = 0.13, lintel = { height = 0.06, bearing = 100 }"), "opening =", "panel[0].opening[0].lintel.bearing", "100 m in a panel", "did you mean \"100 mm\"?";
        "lintel that ends in a course", opening("x = 0.3, y = 0, width = 0.3, height = 0.13, lintel = { height = 0.1, bearing = 0.1 }"), "opening =", "panel[0].opening[0].lintel.height", "is not on a bed joint", "0.065 … 0.075 m or 0.13 … 0.14 m";
        "lintel beyond the wall's end", opening("x = 0.05, y = 0, width = 0.3, height = 0.13, lintel = { height = 0.13, bearing = 0.1 }"), "opening =", "panel[0].opening[0].x", "beyond the panel's left edge", "from 0.1 m, the bearing";
        "opening beyond the wall's end", opening("x = 0.9, y = 0, width = 0.3, height = 0.13"), "opening =", "panel[0].opening[0].width", "ends at 1.2 m, beyond the panel", "up to 0.13 m at this `x`";
        "opening without lintel", opening("x = 0.3, y = 0, width = 0.6, height = 0.13"), "opening =", "panel[0].opening[0]", "rests on nothing", "a `lintel` bears what lies over an opening";
        "opening that leaves a sliver", opening("x = 0.1295, y = 0.065, width = 0.2, height = 0.065").replace("head = 0.01", "head = 0.001"), "opening =", "panel[0].opening[0]", "the cut leaves", "rests from 0.005 m, or up to 0.001 m, which go";
        "opening of the whole width", opening("x = 0, y = 0.26, width = 1.03, height = 0.13"), "opening =", "panel[0].opening[0]", "nothing is left of course 5", "a block in every course";
        "openings through each other", opening("x = 0.3, y = 0, width = 0.3, height = 0.13, lintel = { height = 0.065, bearing = 0.1 } }, { x = 0.65, y = 0.13, width = 0.1, height = 0.065"), "opening =", "panel[0].opening[1]", "lies over opening[0] or its lintel", "beside each other";
        "opening in listed blocks", panel("bond = \"explicit\"\nopening = [{ x = 0, y = 0, width = 1, height = 1 }]\n[[panel.block]]\ncourse = 1\nx = 0\ny = 0\nlength = 1\nheight = 1"), "opening =", "panel[0].opening", "does not go with bond `explicit`", "`running`, `stack` or `irregular`";
        "opening of no width", opening("x = 0.3, y = 0, width = 0, height = 0.13"), "opening =", "panel[0].opening[0].width", "0 m is out of range", "above 0 m";
        "block of two corners", shaped("[[0, 0], [1, 0]]", ""), "corners =", "panel[0].block[0].corners", "the block has 2 corners", "3 to 16";
        "block called base", shaped("[[0, 0], [1, 0], [1, 1], [0, 1]]", "id = \"base\""), "id =", "panel[0].block[0].id", "`base` cannot be the name of a block", "mean something else";
        "block with a dent", shaped("[[0, 0], [1, 0], [0.4, 0.4], [0, 1]]", ""), "corners =", "panel[0].block[0].corners[2]", "the block is not convex", "corners in their order";
        "corner below the base", shaped("[[0, -0.1], [1, 0], [0, 1]]", ""), "corners =", "panel[0].block[0].corners[0]", "-0.1 m is out of range", "from 0 m";
        "block by corners and sides", shaped("[[0, 0], [1, 0], [0, 1]]", "length = 1"), "length =", "panel[0].block[0].length", "the block has `corners`", "`corners`, or `x`, `y`, `length` and `height`";
        "block without its height", explicit(&[block(1, 0.0, 0.0, "").replace("height = 0.05\n", "")]), "[[panel.block]]", "panel[0].block[0].height", "the key is missing: a block has", "above 0 m";
        "sloping block in a shear wall", shaped("[[0, 0], [1, 0], [0, 1]]", "").replacen("\"planar\"", "\"shear\"", 1), "corners =", "panel[0].block[0].corners", "no level rectangle", "rectangles; with `model = \"planar\"`";
        "arch higher than a semicircle", arch("rise = 1.2, voussoirs = 9"), "arch =", "panel[0].arch.rise", "1.2 m is more than half the span", "above 0 m, up to 1 m";
        "arch of two blocks", arch("rise = 1, voussoirs = 2"), "arch =", "panel[0].arch.voussoirs", "2 is out of range", "3 … 1,000";
        "arch without arch", panel("bond = \"arch\"").replacen("\"shear\"", "\"planar\"", 1), "[[panel]]", "panel[0].arch", "the key is missing: bond `arch` needs it", "span = …";
        "arch of a shear wall", arch("rise = 1, voussoirs = 9").replacen("\"planar\"", "\"shear\"", 1), "bond =", "panel[0].bond", "an arch could not give way", "`arch` with `model = \"planar\"`";
        "tie to a block that is not there", tie("from = \"p1c1b1\", to = \"p1c9b1\", stiffness = 1e7"), "tie =", "tie[0].to", "no block is called `p1c9b1`", "`base`, or names of blocks";
        "tie of a block with itself", tie("from = \"p1c1b1\", to = \"p1c1b1\", stiffness = 1e7"), "tie =", "tie[0].to", "both ends are fixed to block p1c1b1", "another block than `from`";
        "tie of the base with itself", tie("from = \"base\", to = \"base\", stiffness = 1e7"), "tie =", "tie[0].to", "both ends are fixed to the base", "another block than `from`";
        "tie without stiffness", tie("from = \"base\", to = \"p1c1b1\""), "tie =", "tie[0].stiffness", "the key is missing", "E A over its length";
        "tie that pushes", tie("from = \"base\", to = \"p1c1b1\", stiffness = 1e7, yield_force = \"-3 kN\""), "tie =", "tie[0].yield_force", "-3000 N is out of range", "above 0 N";
        "tie that is too long", tie("from = \"base\", to = \"p1c1b1\", stiffness = 1e7, slack = -1e-3"), "tie =", "tie[0].slack", "-0.001 m is out of range", "from 0 m";
        "tie of a shear wall", tie("from = \"base\", to = \"p1c1b1\", stiffness = 1e7").replacen("\"planar\"", "\"shear\"", 1), "tie =", "tie[0]", "ties are for planar walls", "leave it out";
        "a wall without overlap", explicit(&[block(1, 0.0, 0.0, ""), block(2, 0.25, 0.05, "id = \"hanging\"")]), "[[panel.block]]", "panel[0].block[1]", "block hanging of course 2 rests on nothing", "an overlap with a block of course 1";
        "a course left out", explicit(&[block(1, 0.0, 0.0, ""), block(3, 0.0, 0.05, "")]), "[[panel.block]]", "panel[0].block", "course 2 has no block", "without a gap";
        "listed courses beside each other", panel("bond = \"irregular\"\n[[panel.course]]\nheight = 0.1\nbricks = [0.25]\n[[panel.course]]\nheight = 0.1\nbricks = [0.25]\noffset = 0.3"), "[[panel.course]]", "panel[0].course[1]", "rests on nothing", "an overlap";
        "stagger that cannot be", random("width = 2, length = [0.2, 0.3], stagger = 0.15"), "random", "panel[0].random.stagger", "0.15 m cannot be held over bricks of 0.2 m", "0 … 0.1 m";
        "stagger beyond the range", random("width = 2, length = [0.2, 0.24], stagger = 0.05"), "random", "panel[0].random.stagger", "0.05 m cannot be held over bricks of 0.2 m to 0.24 m", "0 … 0.04 m";
        "width that bricks cannot fill", random("width = 0.5, length = [0.2, 0.22], stagger = 0"), "random", "panel[0].random.width", "no number of bricks of 0.2 m to 0.22 m makes up 0.5 m", "up to 0.45 m, or from 0.62 m";
        "a texture that is not found", random("width = 2, length = [0.2, 0.25], stagger = 0.0499"), "random", "panel[0].random", "no texture was found that keeps 0.0499 m", "smaller stagger";
    });
    rows
}

/// Files that fail before any number is looked at.
fn keys_and_values() -> Vec<Bad> {
    let set = |name: &str, rest: &str| {
        format!(
            "model = \"shear\"\nset = {name}\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n{rest}\n[motion]\nduration = 1\n"
        )
    };
    bad! {
        "empty file", "  \n", "", "", "the file is empty", "concio new";
        "not TOML", edit("courses = 6", "courses = = 6"), "courses", "", "not valid TOML", "";
        "key given twice", edit("courses = 6", "courses = 6\ncourses = 7"), "courses = 7", "", "duplicate key", "";
        "a list with a table", format!("{GOOD}[out_of_plane.floor]\nz = 1\n[[out_of_plane.floor]] # the roof\nz = 2\n"), "[[out_of_plane.floor]]", "", "duplicate key", "write `[[out_of_plane.floor]]` both times";
        "unknown key", edit("courses = 6", "corses = 6"), "corses", "panel[0].corses", "unknown key", "did you mean `courses`?";
        "hyphen in a key", edit("slip_velocity", "slip-velocity"), "friction", "joint.friction.slip-velocity", "unknown key", "did you mean `slip_velocity`?";
        "one panel in one bracket", edit("[[panel]]", "[panel]"), "[panel]", "panel", "a table cannot stand here", "[[two brackets]]";
        "brick without height", edit("height = \"55 mm\", ", ""), "brick =", "panel[0].brick.height", "the key is missing", "H [m], above 0";
        "file without a model", edit("model = \"shear\"", ""), "", "model", "the key is missing", "`shear`, `planar`";
        "spring law with a typing error", edit("law = \"no-tension\"", "law = \"rigd\""), "head = { law", "joint.head.law", "`rigd` is not known here", "did you mean `rigid`?";
        "spring law that there is not", edit("law = \"no-tension\"", "law = \"cubic\""), "head = { law", "joint.head.law", "`cubic` is not known here", "`elastic`, `no-tension`, `rigid`, `none`";
        "unknown table", format!("{GOOD}[soil]\nvs = 200\n"), "[soil]", "soil", "unknown key", "`motion`";
        "missing table", GOOD.split("[motion]").next().unwrap_or_default(), "model", "motion", "the key is missing", "a table `[motion]`: Motion of base and top";
        "no joints and no set", "model = \"shear\"\n[[panel]]\n", "model", "joint", "the key is missing", "set = \"report\"";
        "wrong unit", edit("\"55 mm\"", "\"55 kg\""), "brick =", "panel[0].brick.height", "`kg` is not a unit of length", "m, cm, mm";
        "no unit in a text", edit("\"55 mm\"", "\"55\""), "brick =", "panel[0].brick.height", "`55` has no unit", "m, cm, mm";
        "a text where a number belongs", edit("static = 0.6", "static = \"0.6\""), "friction", "joint.friction.static", "the text \"0.6\" cannot stand here", "a number without a unit";
        "a word where a list belongs", edit("[motion]", "[joint.bond]\ntensile_strength = 1\ncohesion = 1\non = \"bed\"\n[motion]"), "on = \"bed\"", "joint.bond.on", "the text \"bed\" cannot stand here", "a list of `bed`, `head`";
        "a list where a length belongs", edit("\"55 mm\"", "[55]"), "brick =", "panel[0].brick.height", "a list cannot stand here", "a text with its unit";
        "unknown word", edit("\"running\"", "\"runing\""), "bond", "panel[0].bond", "`runing` is not known here", "did you mean `running`?";
        "unknown beam", edit("\"driven\"", "\"drive\""), "beam", "load.beam", "`drive` is not known here", "did you mean `driven`?";
        "half a brick too many", edit("bricks = 4", "bricks = 4.5"), "bricks", "panel[0].bricks", "the number 4.5 cannot stand here", "a whole number";
        "a date", edit("courses = 6", "courses = 2026-01-01"), "courses", "panel[0].courses", "a date cannot stand here", "a whole number";
        "unknown set", set("\"p9\"", ""), "set", "set", "`p9` is not known here", "`p1`";
        "set beyond its range", set("{ name = \"p1\", at = 1.5 }", ""), "set", "set.at", "1.5 is out of range", "0 … 1";
        "what p4 does not print", set("\"p4\"", ""), "[[panel]]", "panel[0].brick.specific_weight", "set `p4` of Table 1 prints no specific weight", "above 0 N/m3";
        "what p3 does not print", set("\"p3\"", ""), "model", "joint.friction.static", "set `p3` of Table 1 prints no friction angle", "law = \"none\"";
        "preset contradicted", edit("slip_velocity =", "preset = \"report\", on = \"bed\", slip_velocity ="), "friction", "joint.friction.on", "`bed` contradicts", "`all`";
    }
}

/// All checks that run before anything is computed.
fn check(text: &str) -> Result<()> {
    let file: CaseFile = from_str(text, Syntax::Toml, Some(Path::new("wall.toml")))?;
    file.validate()?;
    concio::pattern::lay(&file.case).map(|_| ()).map_err(|e| file.locate(e))
}

fn input_error(result: Result<()>, title: &str) -> InputError {
    match result {
        Err(Error::Input(e)) => *e,
        other => panic!("{title}: {other:?}"),
    }
}

#[test]
fn the_good_file_is_good() {
    check(GOOD).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn what_only_planar_walls_have_is_taken_there() {
    let text = planar(
        "law = \"elastic\"",
        "law = \"rigid\", restitution = 0.2, rocking_restitution = 0.9, normal_to_shear = 3, compressive_strength = 5e6",
    )
    .replace("beam = \"driven\"", "beam = \"driven\"\nbeam_rotation = \"fixed\"")
    .replace("duration = \"0.5 s\"\n", "quasi_static = true\nvertical = { tilt = { acceleration = 1, rise = 1 } }\n")
    .replace(
        "sine = { amplitude = \"5 mm\", frequency = \"2 Hz\" }",
        "path = { displacements = [0.01], speed = 0.001 }",
    );
    check(&format!("{text}[solver]\nstep = \"2 ms\"\n")).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn every_bad_file_is_refused_with_place_cause_and_range() {
    let rows = table();
    assert!(rows.len() >= 25);
    println!("| # | input | message |\n|---|---|---|");
    for (i, row) in rows.iter().enumerate() {
        let e = input_error(check(&row.text), row.title);
        println!("| {} | {} | {} |", i + 1, row.title, e.to_string().replace('|', "\\|"));
        assert_eq!(e.file.as_deref(), Some(Path::new("wall.toml")), "{}: {e}", row.title);
        let line = e.line.unwrap_or_else(|| panic!("{}: no line in {e}", row.title));
        let found = row.text.lines().nth(line - 1).unwrap_or_default();
        assert!(found.starts_with(row.line_with), "{}: line {line} is `{found}`: {e}", row.title);
        assert_eq!(e.key.as_deref().unwrap_or_default(), row.key, "{}: {e}", row.title);
        assert!(e.what.contains(row.cause), "{}: {e}", row.title);
        let hints = format!("{} {}", e.allowed.unwrap_or_default(), e.help.unwrap_or_default());
        assert!(hints.contains(row.allowed), "{}: `{hints}`", row.title);
    }
}

/// The bound in an error is the bound in the documentation of its key.
#[test]
fn errors_and_documentation_give_the_same_bounds() {
    let mut compared = 0;
    for row in table().iter().filter(|r| r.cause.contains("is out of range")) {
        let e = input_error(check(&row.text), row.title);
        let about = concio::case::describe(row.key).unwrap_or_else(|| panic!("{} is not documented", row.key));
        let bound = e.allowed.unwrap_or_default();
        // The unit stands in brackets in the documentation; `above 0 kg` is `above 0` there.
        let words: Vec<&str> = bound.split(' ').take(if bound.contains('…') { 3 } else { 2 }).collect();
        assert!(about.to_lowercase().contains(&words.join(" ")), "{}: `{bound}` is not in `{about}`", row.key);
        compared += 1;
    }
    assert!(compared >= 12, "only {compared} bounds");
}

/// Of several blocks alike it is the one at fault whose line is named.
#[test]
fn the_line_is_that_of_the_block_at_fault() {
    let text = panel(&format!("bond = \"explicit\"\n{}{}", block(1, 0.0, 0.0, ""), block(2, 0.25, 0.05, "")));
    let e = input_error(check(&text), "hanging block");
    let headers: Vec<usize> =
        (1..).zip(text.lines()).filter(|(_, l)| *l == "[[panel.block]]").map(|(n, _)| n).collect();
    assert_eq!(e.line, Some(headers[1]), "{e}");
}

#[test]
fn columns_point_at_the_value_or_key() {
    let text = edit("\"55 mm\"", "\"55 kg\"");
    let e = input_error(check(&text), "unit");
    let line = text.lines().nth(e.line.unwrap_or(1) - 1).unwrap_or_default();
    assert_eq!(e.column, line.find("\"55 kg\"").map(|c| c + 1));
    let text = edit("courses = 6", "title_µ = 1, corses = 6");
    assert!(check(&text).is_err());
}

/// A wrong key of a device is answered with those of its law.
#[test]
fn unknown_keys_of_devices_name_those_of_the_law() {
    let text = edit(
        "[load]",
        "[[joint.change]]\nat = { kind = [\"bed\"] }\ndevice = { law = \"friction-damper\", force = 1200 }\n[load]",
    );
    let e = input_error(check(&text), "force");
    assert_eq!(e.key.as_deref(), Some("joint.change[0].device.force"), "{e}");
    let allowed = "`law`, and of law `friction-damper` `slip_force`, `slip_velocity`, `sticks`";
    assert_eq!(e.allowed.as_deref(), Some(allowed), "{e}");
}

/// Where the laws of bed or head joints are missing, those of the model's starter file are shown.
#[test]
fn missing_laws_are_shown_as_they_may_be() {
    for (model, allowed, help) in [
        ("shear", "`bed = { law = \"elastic\", stiffness = \"5.4e7 N/m\" }`", "set = \"report\""),
        (
            "planar",
            "`bed = { law = \"no-tension\", stiffness = \"10 N/mm3\", rigidity = 1 }`",
            "concio new --model planar",
        ),
        ("rocking", "`bed = { law = \"rigid\" }`", "concio new --model rocking"),
    ] {
        let wall = format!(
            "model = \"{model}\"\n[[panel]]\nbond = \"stack\"\ncourses = 3\nbricks = 1\n\
             brick = {{ length = 1.0, height = 1.0, thickness = 1.0, specific_weight = \"20 kN/m3\" }}\n\
             mortar = {{ bed = 0, head = 0 }}\n[joint]\n[motion]\nduration = \"1 s\"\n"
        );
        let e = input_error(check(&wall), model);
        assert_eq!((e.key.as_deref(), e.line), (Some("joint.bed"), Some(8)), "{e}");
        assert!(e.allowed.as_ref().is_some_and(|a| a.ends_with(allowed)), "{e}");
        assert!(e.help.as_ref().is_some_and(|h| h.contains(help)), "{e}");
    }
}

/// A table of joints under another name is asked about at its line; where there is none, a set is named that has all.
#[test]
fn a_misspelt_table_of_joints_is_asked_about() {
    for wrong in ["joints", "Joint", "jiont"] {
        let e = input_error(check(&edit("[joint]", &format!("[{wrong}]"))), wrong);
        assert_eq!((e.key.as_deref(), e.line), (Some("joint"), Some(10)), "{e}");
        assert_eq!(e.help, Some(format!("is `{wrong}` meant to be `joint`?")));
    }
    let e = input_error(check(&edit("[joint]", "[load.joint]")), "none");
    assert!(e.help.as_ref().is_some_and(|help| help.contains("set = \"report\"")), "{e}");
}

#[test]
fn json_errors_have_places_too() {
    let text = "{\n  \"model\": \"shear\",\n  \"panel\": [\n    { \"bond\": \"stack\", \"corses\": 3 }\n  ]\n}";
    let e = from_str(text, Syntax::Json, None).err().map(|e| input_error(Err(e), "json"));
    let e = e.expect("an error");
    // `joint` is missing as well; the reader says so before it looks at the panels.
    assert_eq!((e.line, e.key.as_deref()), (Some(1), Some("joint")));
    let text = text.replace("\n}", ",\n  \"joint\": {}\n}");
    let e = input_error(from_str(&text, Syntax::Json, None).map(|_| ()), "json");
    assert_eq!((e.line, e.column, e.key.as_deref()), (Some(4), Some(24), Some("panel[0].corses")), "{e}");
    for (bad, cause) in [
        ("{\"model\": NaN}", "not valid JSON"),
        ("{\"model\": 1, \"model\": 2}", "twice"),
        ("{\"model\": null}", "null cannot stand here"),
        ("[1]", "a list cannot stand here"),
        ("{\"model\": \"shear\"} x", "not valid JSON"),
        ("", "empty"),
    ] {
        let e = input_error(from_str(bad, Syntax::Json, None).map(|_| ()), bad);
        assert!(e.to_string().contains(cause), "{bad}: {e}");
        assert_eq!(e.line, Some(1), "{bad}: {e}");
    }
}

/// Quotes of word processors, in TOML and JSON, get the line with straight ones; those inside of a text are no mistake.
#[test]
fn curly_quotes_are_answered_with_straight_ones() {
    for (text, syntax, line) in [
        ("title = “South wall”\n", Syntax::Toml, "title = \"South wall\""),
        ("title = \"a\"\nmodel = ‘shear’\n", Syntax::Toml, "model = 'shear'"),
        ("{ \"model\": „shear“ }", Syntax::Json, "{ \"model\": \"shear\" }"),
    ] {
        let e = input_error(from_str(text, syntax, None).map(|_| ()), text);
        let help = e.help.clone().unwrap_or_default();
        assert!(help.contains("curly quotes") && help.ends_with(line), "{e}");
    }
    let e = input_error(from_str("title = \"the “old” wall\" x\n", Syntax::Toml, None).map(|_| ()), "x");
    assert!(!e.help.unwrap_or_default().contains("curly"));
}

#[test]
fn deep_nesting_is_refused() {
    for (text, syntax) in [
        (format!("model = {}{}", "[".repeat(50_000), "]".repeat(50_000)), Syntax::Toml),
        (format!("model = {}{}", "[".repeat(60), "]".repeat(60)), Syntax::Toml),
        (format!("[{}]", vec!["a"; 5_000].join(".")), Syntax::Toml),
        (format!("{}{}", "[".repeat(50_000), "]".repeat(50_000)), Syntax::Json),
        (format!("{}1{}", "{\"a\":".repeat(60), "}".repeat(60)), Syntax::Json),
    ] {
        let e = input_error(from_str(&text, syntax, None).map(|_| ()), "nesting");
        assert!(e.line.is_some(), "{e}");
    }
}

#[test]
fn files_that_cannot_be_read() {
    let dir = tempfile::tempdir().expect("a folder");
    let missing = dir.path().join("missing.toml");
    let e = input_error(read(&missing).map(|_| ()), "missing");
    assert!(e.what.contains("cannot be read") && e.file.as_deref() == Some(missing.as_path()), "{e}");
    assert!(e.allowed.is_some());

    let e = input_error(read(dir.path()).map(|_| ()), "folder");
    assert!(e.what.contains("is a folder"), "{e}");

    let binary = dir.path().join("binary.toml");
    std::fs::write(&binary, b"model = \"shear\"\n\xff\xfe").expect("written");
    let e = input_error(read(&binary).map(|_| ()), "binary");
    assert!(e.what.contains("not UTF-8") && e.line == Some(2), "{e}");

    let utf16 = dir.path().join("utf16.toml");
    std::fs::write(&utf16, b"\xff\xfem\0o\0").expect("written");
    let e = input_error(read(&utf16).map(|_| ()), "UTF-16");
    assert!(e.what.contains("UTF-16") && e.help.as_deref() == Some("save it as UTF-8"), "{e}");

    let empty = dir.path().join("empty.json");
    std::fs::write(&empty, b"").expect("written");
    let e = input_error(read(&empty).map(|_| ()), "empty");
    assert!(e.what.contains("the file is empty"), "{e}");
}

/// A frame is taken with a sample: frames between samples are refused, and samples without an interval of their own are taken so that there are none.
#[test]
fn frames_are_taken_with_samples() {
    let prepared = |output: &str| {
        let file = from_str(&format!("{GOOD}[output]\n{output}"), Syntax::Toml, None).expect("a wall file");
        concio::run::prepare_case(file.case, Path::new(""))
    };
    let refused = prepared("interval = \"0.1 s\"\nframes = \"0.25 s\"\n").map(|_| ());
    let told = input_error(refused, "frames between samples").to_string();
    assert!(
        told.contains("a frame every 0.25 s, but a sample every 0.1 s") && told.contains("0.2 s or 0.3 s"),
        "{told}"
    );
    for frames in [0.0123, 0.25] {
        let sampling = prepared(&format!("frames = {frames}\n")).expect("a run").sampling;
        assert!((sampling.frame_every as f64 * sampling.interval / frames - 1.0).abs() < 1e-9, "{sampling:?}");
    }
    // Without inertia samples are at steps, but for frames that are not.
    let arch = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/17-arch.toml"));
    let arch = arch.expect("the example").replace("duration = \"3.2 s\"", "duration = \"200 s\"\nquasi_static = true");
    for (frames, interval) in [("10 ms", 0.01), ("0.5 s", 0.1), ("1 s", 0.1)] {
        let file = from_str(&arch.replace("\"10 ms\"", &format!("\"{frames}\"")), Syntax::Toml, None).expect("a file");
        let sampling = concio::run::prepare_case(file.case, Path::new("")).expect("a run").sampling;
        assert!((sampling.interval - interval).abs() < 1e-12, "{frames}: {sampling:?}");
    }
}
