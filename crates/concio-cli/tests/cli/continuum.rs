//! `concio continuum` as a user types it.

use serde_json::Value;

use crate::support::Desk;

/// S1m of the reference table: 250 × 55 × 120 mm and 10 mm of mortar.
fn wall(bed: &str, head: &str, more: &str) -> String {
    format!(
        "title = \"Panel\"\nmodel = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 8\nbricks = 4\n\
         brick = {{ length = \"250 mm\", height = \"55 mm\", thickness = \"120 mm\", specific_weight = \"18 kN/m3\" }}\n\
         mortar = {{ bed = \"10 mm\", head = \"10 mm\" }}\n[joint]\nbed = {bed}\nhead = {head}\n\
         friction = {{ law = \"coulomb\", static = 0.6 }}\n{more}\n[load]\ntop = \"36 kN/m\"\n[motion]\nduration = 1.0\n"
    )
}

const BED: &str = "{ law = \"elastic\", stiffness = \"36 N/mm3\" }";
const HEAD: &str = "{ law = \"elastic\", stiffness = \"86.4 N/mm3\" }";

fn out(desk: &Desk, command: &str) -> String {
    let done = desk.concio(command).assert().success();
    String::from_utf8_lossy(&done.get_output().stdout).into_owned()
}

fn json(desk: &Desk, command: &str) -> Value {
    serde_json::from_str(&out(desk, command)).expect("JSON")
}

fn close(found: &Value, expected: f64) {
    let found = found.as_f64().expect("a number");
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} instead of {expected}");
}

#[test]
fn moduli_and_what_they_rest_on_are_told() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(BED, HEAD, ""));
    let text = out(&desk, "continuum wall.toml");
    for part in [
        "Panel",
        "p1: running bond",
        "E1 27.65 GPa",
        "E2 5.184 GPa",
        "G12 2.009 GPa",
        "head joints open",
        "plate D",
        "Cosserat",
        "C1",
        "strength, dry",
        "linear programs",
        "M22",
        "8 courses",
        "too stiff",
        "bricks are rigid",
        "k_s = k_t",
        "2.4, E/G",
        "no weight",
        "dilates",
    ] {
        assert!(text.contains(part), "{part}:\n{text}");
    }
    let found = json(&desk, "continuum wall.toml --json");
    let p = &found["panels"][0];
    close(&p["membrane"][0][0], 3.317760e9);
    close(&p["constants"]["e2"], 5_184e6);
    close(&p["plate"][0][0], 5.225472e6);
    close(&p["transverse_shear"][0][0], 1.9872e9);
    // 18 kN/m³ of bricks over the pitch.
    close(&p["density"]["volume"], 18e3 / 9.81 * (0.25 * 0.055) / (0.26 * 0.065));
    // Load on the top course, three bricks and two halves of 120 mm, over the panel's width, and half of the weight.
    let width = 4.0 * 0.26 - 0.01;
    let half = 0.5 * 18e3 * (0.25 * 0.055) / (0.26 * 0.065) * 0.12 * 8.0 * 0.065;
    close(&p["pressure"], (36e3 * (3.0 * 0.25 + 2.0 * 0.12) / width + half) / 0.12);
    let scale = &p["scale"];
    assert!((-0.2..-0.05).contains(&scale["without_sides"].as_f64().expect("a number")), "{scale}");
    let [bricks, continuum] = [0, 1].map(|k| scale["panel"][k].as_f64().expect("a stiffness"));
    assert!((1.0..1.4).contains(&(continuum / bricks)), "{scale}");
}

#[test]
fn cards_are_printed_alone() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(BED, HEAD, ""));
    let card = json(&desk, "continuum wall.toml --card json --units N-mm");
    close(&card["constants"]["e1"], 27_648.0);
    assert_eq!((&card["units"], &card["unit_of_mass"]), (&"N-mm".into(), &"t".into()));
    let engineering = out(&desk, "continuum wall.toml --card engineering --units N-mm");
    assert!(
        engineering.contains("*ELASTIC, TYPE=ENGINEERING CONSTANTS\n2.764800000E4, 5.184000000E3"),
        "{engineering}"
    );
    let lamina = out(&desk, "continuum wall.toml --card lamina");
    assert!(lamina.contains("2.764800000E10") && lamina.starts_with("** Concio"), "{lamina}");
    let shell = out(&desk, "continuum wall.toml --card shell --units kN-m");
    assert!(shell.contains("*TRANSVERSE SHEAR\n1.987200000E6"), "{shell}");
    let tcl = out(&desk, "continuum wall.toml --card opensees --units kN-m");
    assert!(tcl.contains("nDMaterial ElasticOrthotropic") && tcl.starts_with("# Concio"), "{tcl}");
}

#[test]
fn options_change_what_is_assumed() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(BED, HEAD, ""));
    let open = json(&desk, "continuum wall.toml --json --heads open");
    let whole = json(&desk, "continuum wall.toml --json");
    let e1 = |v: &Value| v["panels"][0]["constants"]["e1"].as_f64().expect("E1");
    close(&whole["panels"][0]["e1_head_joints_open"], e1(&open));
    assert!(e1(&open) < 0.5 * e1(&whole));
    // Beds alone interlock: μ p b/(2a) of contacts 120 mm long.
    let of = |v: &Value, key: &str| v["panels"][0]["strength_dry"][key].as_f64().expect("a strength");
    let pressure = open["panels"][0]["pressure"].as_f64().expect("a pressure");
    let beds = 0.6 * pressure * 0.26 / (2.0 * 0.065);
    assert!((of(&open, "tension") / beds - 1.0).abs() < 1e-4, "{} {beds}", of(&open, "tension"));
    let soft = json(&desk, "continuum wall.toml --json --brick-modulus 10GPa");
    let doubts = |modulus: &str| {
        let found = json(&desk, &format!("continuum wall.toml --json --brick-modulus {modulus}"));
        found["panels"][0]["warnings"].to_string()
    };
    let told = doubts("10MPa");
    assert!(told.contains("bricks of 10 MPa are softer than adobe") && told.contains("were 10 GPa meant?"), "{told}");
    let pressed = |pressure: &str| {
        let found = json(&desk, &format!("continuum wall.toml --json --pressure {pressure}"));
        found["panels"][0]["warnings"].to_string()
    };
    assert!(
        pressed("300MPa").contains("a pressure of 300 MPa is more than walls bear, up to 50 MPa: were 0.3 MPa meant?")
    );
    assert!(!pressed("5MPa").contains("a pressure of"));
    assert!(doubts("90GPa").contains("bricks of 90 GPa are stiffer than any"));
    for fine in ["80MPa", "10GPa", "60GPa"] {
        assert!(!doubts(fine).contains("bricks of"), "{fine}");
    }
    assert!(e1(&soft) < 10e9 && soft["panels"][0]["assumed"].to_string().contains("an estimate"));
    let pressed = json(&desk, "continuum wall.toml --json --pressure 1MPa");
    close(&pressed["panels"][0]["pressure"], 1e6);
    let tension = |v: &Value| v["panels"][0]["strength_dry"]["tension"].as_f64().expect("a strength");
    assert!(tension(&pressed) > tension(&whole));
}

#[test]
fn head_joints_that_part_are_warned_of() {
    let desk = Desk::new();
    let head = "{ law = \"no-tension\", stiffness = \"86.4 N/mm3\", rigidity = 1 }";
    desk.put("wall.toml", wall(BED, head, ""));
    let text = out(&desk, "continuum wall.toml");
    assert!(text.contains("part freely") && text.contains("--heads open"), "{text}");
    let done = desk.concio("continuum wall.toml --card json").assert().success();
    assert!(String::from_utf8_lossy(&done.get_output().stderr).contains("part freely"));
}

#[test]
fn bonded_walls_have_two_strengths() {
    let desk = Desk::new();
    let bond = "bond = { tensile_strength = \"0.05 MPa\", cohesion = \"0.1 MPa\", friction_angle = \"30 deg\" }";
    desk.put("wall.toml", wall(BED, HEAD, bond));
    let p = &json(&desk, "continuum wall.toml --json")["panels"][0];
    let of = |which: &str| p[which]["shear"].as_f64().expect("a strength");
    assert!(of("strength_bonded") > of("strength_dry"), "{p}");
    assert!(p["warnings"].to_string().contains("one joint after another"));
}

#[test]
fn irregular_walls_have_windows() {
    let desk = Desk::new();
    let random = "bond = \"irregular\"\ncourses = 14\nrandom = { seed = 11, width = \"4 m\", length = [\"140 mm\", \"320 mm\"], height = [\"50 mm\", \"90 mm\"], stagger = \"40 mm\" }";
    let text = wall(BED, HEAD, "").replace("bond = \"running\"\ncourses = 8\nbricks = 4", random);
    desk.put("wall.toml", text);
    let text = out(&desk, "continuum wall.toml");
    for part in ["irregular", "window", "scatter", "no closed form", "apparent"] {
        assert!(text.contains(part), "{part}:\n{text}");
    }
    let p = &json(&desk, "continuum wall.toml --json")["panels"][0];
    assert_eq!(p["windows"]["each"].as_array().map(Vec::len), Some(3));
    assert!(p["plate"].is_null() && p["scale"].is_null());
    let done = desk.concio("continuum wall.toml --card shell").assert().code(2);
    let text = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(text.contains("not known") && text.contains("allowed"), "{text}");
}

/// Listed courses that repeat: running bond is (H1) again, thirds lean.
#[test]
fn listed_courses_are_a_cell_where_it_is_said() {
    let desk = Desk::new();
    let listed = |offsets: &[&str]| {
        let course = |offset: &&str| {
            format!(
                "[[panel.course]]\nheight = \"55 mm\"\nbricks = [\"250 mm\", \"250 mm\", \"250 mm\", \"250 mm\"]\noffset = \"{offset} mm\"\n"
            )
        };
        let courses: String = offsets.iter().map(course).collect();
        let text = wall(BED, HEAD, "").replace("bond = \"running\"\ncourses = 8\nbricks = 4", "bond = \"irregular\"");
        text.replace("[joint]", &format!("{courses}[joint]"))
    };
    desk.put("wall.toml", wall(BED, HEAD, ""));
    let running = json(&desk, "continuum wall.toml --json")["panels"][0]["membrane"].clone();
    desk.put("wall.toml", listed(&["0", "130"]));
    let panel = &json(&desk, "continuum wall.toml --repeated --json")["panels"][0];
    for i in 0..3 {
        close(&panel["membrane"][i][i], running[i][i].as_f64().expect("a number"));
    }
    close(&panel["membrane"][0][0], 3.317760e9);
    assert!(panel["windows"].is_null(), "{panel}");
    let text = out(&desk, "continuum wall.toml --repeated");
    assert!(text.contains("E1 27.65 GPa"), "{text}");
    // Overlaps of a third: contacts of 76.67 and 163.33 mm between pitches of 260 mm.
    desk.put("wall.toml", listed(&["0", "86.666667", "173.333333"]));
    let panel = &json(&desk, "continuum wall.toml --repeated --json")["panels"][0];
    let beds = 0.12 * 86.4e9 * (0.076666667 + 0.163333333) * 0.065 / 0.26;
    // A bond that leans turns its bricks as it is stretched: a little softer than its beds alone.
    let leaning = panel["membrane"][1][1].as_f64().expect("a number") / beds;
    assert!(leaning < 1.0 - 1e-5 && leaning > 0.99, "{leaning}");
    // Unsaid, the same panel is an irregular one, too short for windows.
    let done = desk.concio("continuum wall.toml").assert().code(2);
    let told = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(told.contains("a window from"), "{told}");
}

#[test]
fn a_figure_shows_the_error_over_the_courses() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(BED, HEAD, ""));
    desk.concio("continuum wall.toml --figure error.svg").assert().success();
    let drawing = desk.get("error.svg");
    assert!(drawing.contains("<svg") && drawing.contains("<path"), "{drawing}");
    desk.concio("continuum wall.toml --figure wall.toml").assert().code(2);
}

#[test]
fn walls_that_have_none_are_refused() {
    let desk = Desk::new();
    let refused = |text: String, command: &str, parts: &[&str]| {
        desk.put("wall.toml", text);
        let done = desk.concio(command).assert().code(2);
        let text = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        for part in parts {
            assert!(text.contains(part), "{part}:\n{text}");
        }
    };
    let good = || wall(BED, HEAD, "");
    let plain = "continuum wall.toml";
    refused(wall("{ law = \"rigid\" }", HEAD, ""), plain, &["wall.toml:10:", "joint.bed.law", "rigid", "allowed"]);
    refused(wall(BED, "{ law = \"rigid\" }", ""), plain, &["wall.toml:11:", "joint.head.law", "--heads open"]);
    refused(good().replace("courses = 8", "courses = 1"), plain, &["wall.toml:5:", "two courses"]);
    refused(good().replace("courses = 8", "courses = 0"), plain, &["wall.toml:5:", "courses"]);
    refused(good(), "continuum wall.toml --panel south", &["wall.toml", "south", "allowed: p1"]);
    refused(good(), "continuum wall.toml --card json --units stone-foot", &["--units", "stone-foot", "N-mm"]);
    refused(good(), "continuum wall.toml --card json --units N-mm-kg", &["kg", "not the mass"]);
    refused(good(), "continuum wall.toml --pressure 3", &["unit is missing"]);
    refused(good(), "continuum wall.toml --brick-modulus -1GPa", &["allowed: above 0GPa"]);
    refused(good(), "continuum wall.toml --pressure -1MPa", &["allowed: from 0MPa"]);
    for (bare, unit) in [("10", "10GPa"), ("10000", "10000MPa"), ("1e10", "1e10Pa")] {
        refused(good(), &format!("continuum wall.toml --brick-modulus {bare}"), &["unit is missing", unit]);
    }
    refused(good(), "continuum wall.toml --brick-modulus 1GPa --brick-poisson 0.7", &["0.5"]);
    refused(good(), "continuum wall.toml --repeated --units kN-m", &["--card"]);
    refused(good().replace("duration = 1.0", "duration = 1.0\nspeed = 2"), plain, &["wall.toml:", "speed"]);
    let device =
        "[[joint.change]]\nat = { kind = [\"bed\"] }\ndevice = { law = \"friction-damper\", slip_force = 1e3 }\n[load]";
    refused(good().replace("[load]", device), plain, &["wall.toml:", "joint.change", "device"]);
    let two = format!(
        "{}\n[[panel]]\nbond = \"stack\"\ncourses = 8\nbricks = 2\nbrick = {{ length = \"250 mm\", height = \"55 mm\", thickness = \"120 mm\", specific_weight = \"18 kN/m3\" }}\nmortar = {{ bed = \"10 mm\", head = \"10 mm\" }}\n",
        good()
    );
    refused(two, "continuum wall.toml --card json", &["--panel", "p1, p2"]);
}
