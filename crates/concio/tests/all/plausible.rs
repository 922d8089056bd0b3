//! Numbers that are allowed but hardly meant are told, with a guess at what was meant.

use std::path::Path;

use concio::case::plausible::doubts;
use concio::case::{Case, ModelKind, Syntax, from_str, starter};

pub const WALL: &str = r#"
model = "shear"
[[panel]]
bond = "running"
courses = 2
bricks = 2
brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18000 }
mortar = { bed = 0.01, head = 0.01 }
[joint]
bed = { law = "elastic", stiffness = 5.4e7 }
head = { law = "no-tension", stiffness = 5.4e7 }
friction = { law = "stribeck", static = 0.6, dynamic = 0.4, slip_velocity = 0.001 }
[load]
top = 40000
beam = { mass = 4000 }
[motion]
base = { synthetic = { seed = 1, pga = 3.0, duration = 5.0, dt = 0.005 } }
"#;

/// A bare number that reads like a multiple of g is asked about; one with a unit never is.
#[test]
fn bare_accelerations_are_asked_about() {
    let doubts = |pga: &str| {
        let text = WALL.replace("pga = 3.0", &format!("pga = {pga}"));
        concio::case::from_str(&text, concio::case::Syntax::Toml, None).expect("a wall file").unit_doubts()
    };
    let told = ["motion.base.synthetic.pga is 0.3 m/s2, a number without a unit; did you mean \"0.3 g\"?"];
    assert_eq!(doubts("0.3"), told);
    assert_eq!(doubts("1").len(), 1);
    for fine in ["1.5", "3.0", "\"0.3 m/s2\"", "\"0.03 g\"", "\"0.3 g\""] {
        assert_eq!(doubts(fine), [""; 0], "{fine}");
    }
}

/// A bare specific weight that reads like a density of stone is asked about, wherever it stands; aerated concrete with its unit is not.
#[test]
fn bare_densities_are_asked_about() {
    let wall = WALL.replace("model = \"shear\"", "model = \"planar\"").replace("courses = 2", "courses = 8");
    let told = |text: &str| {
        let file = from_str(text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
        let mut told = [file.unit_doubts(), doubts(&file.case)].concat();
        told.retain(|doubt| doubt.contains("specific_weight"));
        told.into_iter().map(|doubt| doubt.text).collect::<Vec<_>>()
    };
    let of = |key: &str| {
        [format!(
            "{key}.specific_weight is 3200 N/m3, a number without a unit, as light as aerated concrete; did you mean \"3200 kg/m3\"?"
        )]
    };
    let brick = |weight: &str| wall.replace("specific_weight = 18000", &format!("specific_weight = {weight}"));
    let lintel = "mortar = { bed = 0.01, head = 0.01 }\n[[panel.opening]]\nx = 0.1\ny = 0.1\nwidth = 0.2\nheight = 0.1\n\
                  lintel = { height = 0.055, bearing = 0.05, specific_weight = 3200 }";
    let lintel = wall.replace("mortar = { bed = 0.01, head = 0.01 }", lintel);
    let side = format!("{wall}[[out_of_plane.side_wall]]\nx = 0\nthickness = 0.12\nspecific_weight = 3200\n");
    assert_eq!(told(&brick("3200")), of("panel[0].brick"));
    assert_eq!(told(&lintel), of("panel[0].opening[0].lintel"));
    assert_eq!(told(&side), of("out_of_plane.side_wall[0]"));
    // One sentence each, down to those that a lighter limit hid.
    for slip in ["500", "1800", "2500", "2700", "3000", "3500", "\"2.7 kN/m3\"", "\"270 kg/m3\""] {
        assert_eq!(told(&brick(slip)).len(), 1, "{slip}");
    }
    for fine in ["3600", "4000", "18000", "\"3.2 kN/m3\"", "\"4 kN/m3\"", "\"350 kg/m3\"", "\"0.6 t/m3\""] {
        assert_eq!(told(&brick(fine)), [""; 0], "{fine}");
    }
    // What a study sets counts as the file's.
    let file = from_str(&wall, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    let set = file.unit_doubts_with(&[("panel[0].brick.specific_weight".into(), 3200.into())]);
    assert_eq!(set.into_iter().map(|w| w.text).collect::<Vec<_>>(), of("panel[0].brick"));
}

/// A multiple of g that was written in m/s² shakes no wall; what is in g is meant, and so is a little shaking where damage is checked.
#[test]
fn peaks_in_metres_that_shake_no_wall_are_asked_about() {
    let site = |name: &str, a: &str| {
        let site = format!(
            "[out_of_plane.site.{name}]\nground_acceleration = {a}\namplification = 2.4\ncorner_period = 0.4\n"
        );
        WALL.replace("model = \"shear\"", "model = \"planar\"") + &site
    };
    let pga = |a: &str| WALL.replace("pga = 3.0", &format!("pga = {a}"));
    let told = |text: String| {
        let doubts = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}")).unit_doubts();
        doubts.into_iter().map(|doubt| doubt.text).collect::<Vec<_>>()
    };
    let ground = "out_of_plane.site.life_safety.ground_acceleration";
    let peak = "motion.base.synthetic.pga";
    for (text, expected) in [
        (
            site("life_safety", "\"0.15 m/s2\""),
            format!("{ground} is 0.15 m/s2, 0.0153 g, which hardly shakes a wall; did you mean \"0.15 g\"?"),
        ),
        (
            pga("\"0.25 m/s2\""),
            format!("{peak} is 0.25 m/s2, 0.0255 g, which hardly shakes a wall; did you mean \"0.25 g\"?"),
        ),
        (
            pga("\"20 mm/s2\""),
            format!("{peak} is 20 mm/s2, 0.00204 g, which hardly shakes a wall; did you mean \"0.2 g\"?"),
        ),
    ] {
        assert_eq!(told(text), [expected]);
    }
    for fine in [
        site("damage", "\"0.2 m/s2\""),
        site("life_safety", "\"0.02 g\""),
        site("life_safety", "\"0.5 m/s2\""),
        pga("\"0.02 g\""),
    ] {
        assert_eq!(told(fine.clone()), [""; 0], "{fine}");
    }
}

/// A scheme for smooth motion is doubted beside friction that falls at once, unless it is held to a fine tolerance.
#[test]
fn a_scheme_for_smooth_motion_is_doubted_where_friction_falls() {
    let told = |friction: &str, solver: &str| {
        let text = WALL.replace("law = \"stribeck\"", friction).replace(", slip_velocity = 0.001", "");
        let file =
            from_str(&format!("{text}[solver]\n{solver}\n"), Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
        doubts(&file.case).iter().filter(|doubt| doubt.contains("esdirk4")).count()
    };
    let coulomb = "law = \"coulomb\"";
    assert_eq!(told(coulomb, "scheme = \"esdirk4\""), 1);
    assert_eq!(told(coulomb, "scheme = \"esdirk4\"\ntolerance = 1e-8"), 0);
    assert_eq!(told(coulomb, "scheme = \"tr-bdf2\""), 0);
}

/// A record whose interval is ten times too long, corner periods in milliseconds.
#[test]
fn slips_of_motions_are_told() {
    let (head, _) = WALL.split_once("[motion]").expect("a motion");
    let told = |base: &str| doubts(&case(&format!("{head}[motion]\nduration = 1\nbase = {{ {base} }}\n")));
    assert_eq!(
        told("record = \"r.dat\", dt = 0.1"),
        ["motion.base.dt is 0.1 s, more than 0.05 s; did you mean \"0.01 s\"?"]
    );
    assert_eq!(told("record = \"r.dat\", dt = 5"), ["motion.base.dt is 5 s, more than 0.05 s; did you mean \"5 ms\"?"]);
    assert_eq!(
        told("synthetic = { seed = 1, pga = \"0.3 g\", duration = 12, corners = [150, 500, 2000] }"),
        [150, 500, 2000]
            .iter()
            .enumerate()
            .map(|(k, read)| format!(
                "motion.base.synthetic.corners[{k}] is {read} s, more than 20 s; did you mean \"{read} ms\"?"
            ))
            .collect::<Vec<_>>()
    );
    for fine in [
        "record = \"r.dat\", dt = 0.02",
        "record = \"r.dat\", dt = 0.1, quantity = \"displacement\"",
        "synthetic = { seed = 1, pga = \"0.3 g\", duration = 12, corners = [0.15, 0.5, 2] }",
    ] {
        assert_eq!(told(fine), [""; 0], "{fine}");
    }
}

/// Joints softer than rubber, and softer pressed than sheared.
#[test]
fn joints_of_hardly_any_material_are_told() {
    let joint = |bed: &str| {
        let wall = WALL.replace("model = \"shear\"", "model = \"planar\"");
        let mut found = doubts(&case(&wall.replacen("stiffness = 5.4e7", bed, 1)));
        found.retain(|doubt| doubt.contains("stiffness is") || doubt.contains("normal_to_shear"));
        found
    };
    assert_eq!(
        joint("stiffness = \"36e6 N/m3\""),
        ["joint.bed.stiffness is 3.6e7 N/m3, less than 4e7 N/m3; did you mean \"36 N/mm3\"?"]
    );
    assert_eq!(
        joint("stiffness = \"5e6 N/m3\""),
        ["joint.bed.stiffness is 5000000 N/m3, less than 4e7 N/m3; did you mean \"5 N/mm3\"?"]
    );
    assert_eq!(
        joint("stiffness = \"36 N/mm3\", normal_to_shear = 0.4"),
        [
            "joint.bed.normal_to_shear is 0.4, less than 1: k_n/k_s, and joints are stiffer pressed than sheared; did you mean 2.5?"
        ]
    );
    for fine in ["stiffness = \"0.1 N/mm3\"", "stiffness = \"36 N/mm3\", normal_to_shear = 1"] {
        assert_eq!(joint(fine), [""; 0], "{fine}");
    }
}

pub fn case(text: &str) -> Case {
    let file = from_str(text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
    file.validate().unwrap_or_else(|e| panic!("{e}\n{text}"));
    file.case
}

#[test]
fn an_ordinary_wall_raises_none() {
    assert_eq!(doubts(&case(WALL)), Vec::<String>::new());
    for model in [ModelKind::Shear, ModelKind::Planar] {
        assert_eq!(doubts(&case(starter(model))), Vec::<String>::new());
    }
}

/// Of devices: forces and ways of another unit, and a key that does nothing.
#[test]
fn doubtful_devices_are_told() {
    let of = |device: &str| {
        let change = format!("[[joint.change]]\nat = {{ kind = [\"bed\"] }}\ndevice = {{ {device} }}\n[load]");
        doubts(&case(&WALL.replace("[load]", &change)))
    };
    for (device, told) in [
        (
            r#"law = "viscous", damping = 1000, reference_velocity = 0.1"#,
            Some("joint.change[0].device.reference_velocity does nothing where `exponent` is 1: the dashpot is linear"),
        ),
        (r#"law = "viscous", damping = 1000, reference_velocity = 0.1, exponent = 0.5"#, None),
        (
            r#"law = "bouc-wen", yield_force = 2000, yield_displacement = 0.2"#,
            Some("joint.change[0].device.yield_displacement is 0.2 m, more than 0.05 m; did you mean \"0.2 mm\"?"),
        ),
        (r#"law = "friction-damper", slip_force = 2000"#, None),
    ] {
        assert_eq!(of(device), told.into_iter().collect::<Vec<_>>(), "{device}");
    }
}

/// Each number is one that engineers write when they forget that a bare number is in SI.
#[test]
fn each_mistake_of_unit_is_told_with_a_guess() {
    for (right, wrong, told) in [
        ("length = 0.25", "length = 300", "panel[0].brick.length is 300 m, more than 5 m; did you mean \"300 mm\"?"),
        ("length = 0.25", "length = 25", "panel[0].brick.length is 25 m, more than 5 m; did you mean \"25 cm\"?"),
        ("height = 0.055", "height = \"0.055 mm\"", "less than 0.005 m; did you mean \"0.055 m\"?"),
        ("bed = 0.01", "bed = 10", "panel[0].mortar.bed is 10 m, more than 0.07 m; did you mean \"10 mm\"?"),
        ("18000", "18", "specific_weight is 18 N/m3, less than 3000 N/m3; did you mean \"18 kN/m3\"?"),
        ("18000", "1800", "specific_weight is 1800 N/m3, less than 3000 N/m3; did you mean \"1800 kg/m3\"?"),
        ("18000", "2700", "specific_weight is 2700 N/m3, less than 3000 N/m3; did you mean \"2700 kg/m3\"?"),
        ("18000", "\"2.7 kN/m3\"", "specific_weight is 2700 N/m3, less than 3000 N/m3; did you mean \"2700 kg/m3\"?"),
        ("18000", "\"270 kg/m3\"", "less than 3000 N/m3; did you mean \"2700 kg/m3\"?"),
        ("18000", "\"18 kg/m3\"", "less than 3000 N/m3; did you mean \"1800 kg/m3\"?"),
        ("18000", "\"180 kN/m3\"", "more than 100000 N/m3; did you mean \"18 kN/m3\"?"),
        ("18000", "\"27 t/m3\"", "more than 100000 N/m3; did you mean \"2700 kg/m3\"?"),
        ("18000", "\"18000 kN/m3\"", "more than 100000 N/m3; did you mean \"18 kN/m3\"?"),
        ("18000", "\"1800 kN/m3\"", "more than 100000 N/m3; did you mean \"1800 kg/m3\"?"),
        ("bed = 0.01", "bed = \"10 cm\"", "panel[0].mortar.bed is 0.1 m, more than 0.07 m; did you mean \"10 mm\"?"),
        (
            "height = 0.055",
            "height = \"55 cm\"",
            "panel[0].brick.height is 0.55 m, 2.2 times the length of 0.25 m: bricks have at most 2; did you mean \"0.055 m\"?",
        ),
        (
            "stiffness = 5.4e7 }\nhead",
            "stiffness = 54 }\nhead",
            "joint.bed.stiffness is 54 N/m, less than 1000 N/m; did you mean \"54 MN/m\"?",
        ),
        (
            "stiffness = 5.4e7 }\nhead",
            "stiffness = \"36 N/m3\" }\nhead",
            "joint.bed.stiffness is 36 N/m3, less than 4e7 N/m3; did you mean \"36 N/mm3\"?",
        ),
        (
            "stiffness = 5.4e7 }\nhead",
            "stiffness = \"10 N/mm\" }\nhead",
            "joint.bed.stiffness is 10000 N/m of a bed joint of half a brick, 0.00067 N/mm3, softer than rubber; did you mean \"10 N/mm3\"?",
        ),
        (
            "static = 0.6",
            "static = 30",
            "joint.friction.static is 30, more than 1; did you mean 0.58, the tangent of 30 degrees?",
        ),
        ("slip_velocity = 0.001", "slip_velocity = 1", "more than 0.1 m/s; did you mean \"1 mm/s\"?"),
        ("top = 40000", "top = 40", "load.top is 40 N/m, less than 300 N/m; did you mean \"40 kN/m\"?"),
        ("mass = 4000", "mass = 4", "load.beam.mass is 4 kg, less than 10 kg; did you mean \"4 t\"?"),
        ("pga = 3.0", "pga = 300", "pga is 300 m/s2, more than 45 m/s2; did you mean \"300 cm/s2\"?"),
        ("dt = 0.005", "dt = 0.5", "motion.base.synthetic.dt is 0.5 s, more than 0.2 s"),
    ] {
        assert!(WALL.contains(right), "{right}");
        let found = doubts(&case(&WALL.replacen(right, wrong, 1)));
        // 300 m of brick still make a wall: nothing else is doubted.
        assert!(found.len() == 1 && found[0].contains(told), "{wrong}: {found:?}");
    }
}

#[test]
fn the_doubts_are_warnings_of_a_prepared_run() {
    let prepared =
        concio::run::prepare_case(case(&WALL.replace("mass = 4000", "mass = 4")), Path::new(".")).expect("a wall");
    assert!(prepared.model.warnings.iter().any(|w| w.starts_with("load.beam.mass is 4 kg")));
}

/// Runs that would take days are told with what keeps their steps short.
#[test]
fn runs_without_end_are_told() {
    let told = |wall: &str| {
        let prepared = concio::run::prepare_case(case(wall), Path::new(".")).expect("a wall");
        prepared.model.warnings.iter().find(|w| w.starts_with("motion.duration: ")).cloned()
    };
    assert_eq!(told(WALL), None);
    let (head, _) = WALL.split_once("[motion]").expect("a motion");
    let with = |rest: &str| told(&format!("{head}[motion]\n{rest}"));
    let pulse = |length: &str, duration: &str| {
        with(&format!(
            "duration = {duration}\nbase = {{ pulse = {{ shape = \"half-sine\", acceleration = 1, duration = {length} }} }}"
        ))
    };
    assert_eq!(pulse("1e-3", "10"), None);
    let short = pulse("1e-8", "10").expect("a doubt");
    assert!(short.contains("10 s takes") && short.ends_with("(what the motion changes within)"), "{short}");
    let small = with("duration = 10\n[solver]\nmax_step = 1e-9").expect("a doubt");
    assert_eq!(small, "motion.duration: 10 s takes 1e10 steps at least, none longer than 1e-9 s (solver.max_step)");
    let planar =
        told(&format!("{head}[motion]\nduration = 1e9\n").replace("\"shear\"", "\"planar\"")).expect("a doubt");
    assert!(planar.contains("1e9 s takes 1e12 steps") && planar.ends_with("0.001 s (solver.step)"), "{planar}");
}

/// Joints of planar walls open: what holds without limit there, or not at all, is told.
#[test]
fn joints_that_hold_without_limit_are_told() {
    let planar = |joint: &str| {
        doubts(&case(&format!(
            "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 4\nbricks = 3\n\
             brick = {{ length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }}\n\
             [joint]\nhead = {{ law = \"no-tension\", stiffness = \"36 N/mm3\" }}\n{joint}{}duration = 1",
            if joint.contains("[motion]") { "\n" } else { "\n[motion]\n" }
        )))
    };
    let elastic = "bed = { law = \"elastic\", stiffness = \"15 N/mm3\" }";
    let found = planar(elastic);
    assert!(found.len() == 1 && found[0].contains("pull without limit"), "{found:?}");
    let bond = |text: &str| planar(&format!("{elastic}\nbond = {{ {text} }}"));
    let found = bond("tensile_strength = \"0.1 MPa\"");
    assert!(found.len() == 1 && found[0].contains("joint.bond.cohesion is 0"), "{found:?}");
    assert_eq!(bond("tensile_strength = \"0.1 MPa\", cohesion = \"0.1 MPa\""), Vec::<String>::new());
    let smooth = "bed = { law = \"no-tension\", stiffness = \"15 N/mm3\", rigidity = 1 }";
    let found = planar(smooth);
    assert!(found.len() == 1 && found[0].contains("joint.friction is missing"), "{found:?}");
    let dry = &format!("{smooth}\nfriction = {{ law = \"coulomb\", static = 0.6, dynamic = 0.6 }}");
    assert_eq!(planar(dry), Vec::<String>::new());
    let found = planar(&dry.replace("rigidity = 1", "rigidity = 500"));
    assert!(found.len() == 1 && found[0].contains("rigidity = 500 times as stiff"), "{found:?}");
    let found = planar(&format!(
        "{dry}\n[motion]\nquasi_static = true\nbase = {{ sine = {{ amplitude = \"5 mm\", frequency = 2 }} }}"
    ));
    assert!(found.len() == 1 && found[0].contains("motion.base is a motion, and `quasi_static`"), "{found:?}");
    let tilt = "base = { tilt = { acceleration = \"0.5 g\", rise = \"5 s\" } }";
    assert_eq!(planar(&format!("{dry}\n[motion]\nquasi_static = true\n{tilt}")), Vec::<String>::new());
    let found = planar(&format!("{dry}\n[solver]\ntolerance = 1e-3\nmax_step = \"1 ms\""));
    assert!(found.len() == 2 && found[0].contains("solver.tolerance does nothing"), "{found:?}");
}

/// Bonds that are stronger than they may be, weaker than what is left of them, or that leave nothing.
#[test]
fn bonds_at_odds_with_friction_are_told() {
    let low = include_str!("../../../../examples/laboratory/ispra-low.toml");
    for (from, to, what) in [
        (
            "static = 0.577",
            "static = 0.9",
            "joint.friction.static is 0.9, above tan(friction_angle) = 0.577: from a pressure of 0.713 MPa",
        ),
        (
            "tensile_strength = \"0.1 MPa\"",
            "tensile_strength = \"0.6 MPa\"",
            "above cohesion/tan(friction_angle) = 0.398 MPa",
        ),
        (
            "mode_2_energy = \"50 N/m\"",
            "mode_2_energy = \"50 N/mm\"",
            "mode_2_energy is 50000 N/m, more than 10000 N/m",
        ),
        ("cohesion = \"0.23 MPa\"", "cohesion = \"0.23 kPa\"", "joint.bond.cohesion is 230 Pa, less than 1000 Pa"),
        (
            "friction = { law = \"coulomb\", static = 0.577, dynamic = 0.577, on = \"all\" }",
            "",
            "joints that have cracked bear no shear at all",
        ),
        ("force = \"150 kN\"", "force = 150", "load.top.force is 150 N, less than 1000 N"),
    ] {
        assert!(low.contains(from), "{from}");
        let found = doubts(&case(&low.replacen(from, to, 1)));
        assert!(found.iter().any(|doubt| doubt.text.contains(what)), "{to}: {found:?}");
    }
}

/// A push that goes far in every step is told, and joints that hold without limit are, also where a change bonds others.
#[test]
fn fast_pushes_and_beds_that_no_change_bonds_are_told() {
    let low = include_str!("../../../../examples/laboratory/ispra-low.toml");
    let told = |text: &str, what: &str| doubts(&case(text)).iter().any(|doubt| doubt.text.contains(what));
    assert!(doubts(&case(low)).is_empty(), "{:?}", doubts(&case(low)));
    for (speed, tells) in [("\"1 mm/s\"", false), ("\"5 mm/s\"", false), ("\"20 mm/s\"", true), ("1", true)] {
        let text = low.replace("speed = \"1 mm/s\"", &format!("speed = {speed}"));
        assert_eq!(told(&text, "in every step of this `quasi_static` run"), tells, "{speed}");
    }
    let tilt = |rise: &str| {
        let push = low.lines().find(|line| line.starts_with("top = { path")).expect("a push");
        low.replace(push, &format!("duration = 1\nbase = {{ tilt = {{ acceleration = \"1 g\", rise = \"{rise}\" }} }}"))
            .replace("beam = \"driven\"", "")
            .replace("beam_rotation = \"fixed\"", "")
    };
    for (rise, tells) in [("0.5 s", true), ("20 s", false)] {
        assert_eq!(told(&tilt(rise), "in every step of this `quasi_static` run"), tells, "{rise}");
    }
    // 1 g in 0.5 s of 20 ms steps is 0.04 g each, eight times 0.005 g. A longer rise alone would end after the run.
    let quick = tilt("0.5 s");
    assert!(told(&quick, "Let `rise` be 4 s or longer, and motion.duration 4 s, or the run ends before"));
    assert!(!told(&quick.replace("duration = 1\n", "duration = 4\n"), "and motion.duration"));
    let bond = low.lines().find(|line| line.starts_with("bond = {")).expect("a bond");
    let without = low.replacen(bond, "", 1);
    assert!(told(&without, "`elastic` without a bond"));
    let beds = without.replace("kind = [\"base\", \"top\"]", "kind = [\"bed\", \"base\", \"top\"]");
    assert!(!told(&beds, "`elastic` without a bond"));
}

/// What is told of a prepared wall and begins with a key.
fn prepared(text: &str, key: &str) -> Vec<String> {
    let prepared = concio::run::prepare_case(case(text), Path::new(".")).unwrap_or_else(|e| panic!("{e}\n{text}"));
    prepared.model.warnings.iter().map(|w| w.text.clone()).filter(|text| text.starts_with(key)).collect()
}

/// A run that ends while its motion still grows bears less than was asked for.
#[test]
fn motions_that_a_run_ends_before_they_have_grown_are_told() {
    let (head, _) = WALL.split_once("[motion]").expect("a motion");
    let base = |duration: f64, base: &str| {
        prepared(&format!("{head}[motion]\nduration = {duration}\nbase = {{ {base} }}\n"), "motion.base.")
    };
    let tilt = |start: f64, rise: f64| format!("tilt = {{ acceleration = \"0.5 g\", start = {start}, rise = {rise} }}");
    let sine = |rest: &str| format!("sine = {{ frequency = 2, {rest} }}");
    for (duration, motion, told) in [
        (
            5.0,
            tilt(0.0, 10.0),
            "tilt reaches 0.25 g of 0.5 g: it grows until 10 s (start + rise), and the run ends at 5 s. Let motion.duration be 10 s or longer",
        ),
        (
            4.0,
            tilt(2.0, 8.0),
            "tilt reaches 0.125 g of 0.5 g: it grows until 10 s (start + rise), and the run ends at 4 s. Let motion.duration be 10 s or longer",
        ),
        (
            1.0,
            "ramp = { amplitude = \"10 mm\", rise = 2 }".into(),
            "ramp reaches 5 mm of 10 mm: it grows until 2 s (start + rise), and the run ends at 1 s. Let motion.duration be 2 s or longer",
        ),
        (
            1.0,
            sine("acceleration = \"0.4 g\", ramp = 4"),
            "sine reaches 0.1 g of 0.4 g: it grows until 4 s (ramp), and the run ends at 1 s. Let motion.duration be 4 s or longer",
        ),
        (
            5.0,
            sine("amplitude = \"4 mm\", ramp = 2, cycles = 2"),
            "sine reaches 2 mm of 4 mm: it grows until 2 s (ramp), and motion.base.sine.cycles end at 1 s. Let `cycles` be more, or `ramp` shorter",
        ),
    ] {
        assert_eq!(base(duration, &motion), [format!("motion.base.{told}")], "{motion}");
    }
    for (duration, motion) in [
        (10.0, tilt(2.0, 8.0)),
        (2.0, "ramp = { amplitude = \"10 mm\", rise = 2 }".into()),
        (4.0, sine("acceleration = \"0.4 g\", ramp = 4")),
        (5.0, sine("amplitude = \"4 mm\", ramp = 1, cycles = 2")),
    ] {
        assert_eq!(base(duration, &motion), [""; 0], "{motion}");
    }
    let cut = prepared(
        &format!(
            "{head}[motion]\nduration = 2\nbase = {{ sine = {{ frequency = 2, cycles = 10, acceleration = 1 }} }}\n"
        ),
        "motion.duration cuts the motion of the base, which ends at 5 s: 2 s of it is used",
    );
    assert_eq!(cut.len(), 1);
    // To 1 mm in 2 s, and then back by 0.5 mm.
    let path = |duration: f64| {
        let head = head.replace("beam = { mass = 4000 }", "beam = \"driven\"").replace("\"shear\"", "\"planar\"");
        let path = "path = { displacements = [\"1 mm\", \"-1 mm\"], speed = \"0.5 mm/s\" }";
        prepared(&format!("{head}[motion]\nduration = {duration}\ntop = {{ {path} }}\n"), "motion.top.")
    };
    assert_eq!(
        path(3.0),
        [
            "motion.top.path is cut by motion.duration: it takes 6 s, and after 3 s it is at 0.5 mm; its last displacement is -1 mm. \
             Without motion.duration the run takes it whole"
        ]
    );
    assert_eq!(path(6.0), [""; 0]);
}

/// A beam of 300 mm in metres: the lever of all that acts on it.
#[test]
fn a_beam_as_high_as_a_tower_is_told() {
    let text = WALL.replace("\"shear\"", "\"planar\"").replace("[load]", "[load]\nbeam_height = 300");
    let found = doubts(&case(&text));
    let told = "load.beam_height is 300 m, more than 3 m; did you mean \"300 mm\"?";
    assert!(found.iter().any(|doubt| doubt.text == told), "{found:?}");
}

/// 61.3 ms are 61.3 steps of 1 ms, of which 61 or 62 have each value.
#[test]
fn forces_that_change_within_a_step_are_told() {
    let told = |every: &str, step: &str| {
        let force = format!(
            "[[force]]\nblock = \"p1c1b1\"\nx = [0, 3000]\nevery = \"{every}\"\n[solver]\nstep = \"{step}\"\n[load]"
        );
        let text = WALL.replace("\"shear\"", "\"planar\"").replace("[load]", &force);
        let found = doubts(&case(&text)).into_iter().filter(|doubt| doubt.text.starts_with("force"));
        found.map(|doubt| doubt.text).collect::<Vec<_>>()
    };
    assert_eq!(
        told("61.3 ms", "1 ms"),
        [
            "force[0].every is 0.0613 s, 61.3 steps: each value acts in whole steps, and its impulse is up to 1.6 % off; choose a solver.step that divides it"
        ]
    );
    assert_eq!(told("61.3 ms", "0.1 ms"), [""; 0]);
    assert_eq!(told("60 ms", "1 ms"), [""; 0]);
}

/// Masonry that rubs like rubber, and what glues it to its supports.
#[test]
fn friction_beyond_that_of_masonry_is_told() {
    let told = |friction: &str, change: &str| {
        let text = WALL.replace("static = 0.6", friction).replace("[load]", &format!("{change}\n[load]"));
        doubts(&case(&text))
    };
    assert_eq!(
        told("static = 1.2", ""),
        ["joint.friction.static is 1.2, more than 1: joints of masonry rub with 0.4 to 0.8"]
    );
    assert_eq!(told("static = 1.0", ""), [""; 0]);
    let slippery = |key: &str, number: f64| {
        format!("joint.friction.{key} is {number}, less than 0.1: joints of masonry rub with 0.4 to 0.8")
    };
    for (friction, key, number) in
        [("static = 0.06, dynamic = 0.06", "static", 0.06), ("static = 0.6, dynamic = 0.04", "dynamic", 0.04)]
    {
        let found = doubts(&case(&WALL.replace("static = 0.6, dynamic = 0.4", friction)));
        let told: Vec<&str> =
            found.iter().map(|doubt| doubt.text.as_str()).filter(|text| text.contains("less than 0.1")).collect();
        assert_eq!(told, [slippery(key, number)]);
    }
    let change = |kind: &str, static_: f64| {
        format!("[[joint.change]]\nat = {{ kind = [\"{kind}\"] }}\nfriction = {{ static = {static_} }}")
    };
    let found = told("static = 0.6", &change("bed", 1.5));
    assert_eq!(found, ["joint.change[0].friction.static is 1.5, more than 1: joints of masonry rub with 0.4 to 0.8"]);
    assert_eq!(told("static = 0.6", &change("base", 2.0)), [""; 0]);
    assert_eq!(told("static = 0.6", &change("base", 2.5)).len(), 1);
}

/// Bricks whose sides are likely one by one, and bonds as strong as their bricks.
#[test]
fn bricks_and_bonds_of_no_masonry_are_told() {
    let told = |right: &str, wrong: &str| {
        assert!(WALL.contains(right));
        doubts(&case(&WALL.replacen(right, wrong, 1)))
    };
    assert_eq!(
        told("height = 0.055", "height = \"5.5 mm\""),
        [
            "panel[0].brick.height is 0.0055 m, 0.022 times the length of 0.25 m: bricks have at least 0.05; did you mean \"0.055 m\"?"
        ]
    );
    assert_eq!(
        told("thickness = 0.12", "thickness = \"120 cm\""),
        [
            "panel[0].brick.thickness is 1.2 m, 4.8 times the length of 0.25 m: bricks have at most 4; did you mean \"0.12 m\"?"
        ]
    );
    // Hollow blocks of 250 mm on end, and soldiers.
    for upright in ["length = 0.12, height = 0.25", "length = 0.065, height = 0.215"] {
        assert_eq!(told("length = 0.25, height = 0.055", upright), [""; 0], "{upright}");
    }
    // A Roman tile, and a wall as thick as four bricks.
    assert_eq!(told("length = 0.25, height = 0.055", "length = 0.59, height = 0.045"), [""; 0]);
    assert_eq!(told("thickness = 0.12", "thickness = 1.0"), [""; 0]);
    let bond = |numbers: &str| told("[load]", &format!("[joint.bond]\n{numbers}\n[load]"));
    assert_eq!(
        bond("tensile_strength = \"10 MPa\""),
        ["joint.bond.tensile_strength is 1e7 Pa, more than 2000000 Pa; did you mean \"1 MPa\"?"]
    );
    assert_eq!(
        bond("cohesion = \"20 MPa\""),
        ["joint.bond.cohesion is 2e7 Pa, more than 4000000 Pa; did you mean \"0.02 MPa\"?"]
    );
    assert_eq!(
        bond("cohesion = \"0.2 MPa\"\nfriction_angle = \"0.6 deg\""),
        ["joint.bond.friction_angle is 0.6 deg, less than 2 deg; did you mean \"0.6 rad\"?"]
    );
    assert_eq!(bond("tensile_strength = \"1 MPa\"\ncohesion = \"2 MPa\"\nfriction_angle = \"45 deg\""), [""; 0]);
}

/// Springs stiffer than any stone: over 0.055 m + 0.01 m, 36 kN/mm³ times k_n/k_s = 2.4 are 5616 GPa, 1 kN/mm³ 156 GPa.
#[test]
fn springs_stiffer_than_stone_are_told() {
    let told = |stiffness: &str| {
        let wall = WALL.replace("model = \"shear\"", "model = \"planar\"");
        let mut found = doubts(&case(&wall.replacen("stiffness = 5.4e7", &format!("stiffness = \"{stiffness}\""), 1)));
        found.retain(|doubt| doubt.starts_with("joint.bed.stiffness"));
        found
    };
    assert_eq!(
        told("36 kN/mm3"),
        [
            "joint.bed.stiffness is 36000 N/mm3: over 0.065 m from joint to joint the masonry would have a modulus of 5620 GPa, more than 200 GPa, twice the stiffest \
             stone; did you mean \"36 N/mm3\"?"
        ]
    );
    for fine in ["1 kN/mm3", "36 N/mm3"] {
        assert_eq!(told(fine), [""; 0], "{fine}");
    }
    // k_s of half a brick of 0.25 m by 0.12 m in a shear wall: 54 GN/m are 234 GPa, 45 GN/m 195 GPa.
    let whole = |stiffness: &str| {
        doubts(&case(&WALL.replacen("stiffness = 5.4e7", &format!("stiffness = \"{stiffness}\""), 1)))
    };
    let found = whole("54e9 N/m");
    assert!(
        found.len() == 1
            && found[0].contains("is 54000 MN/m: over 0.065 m")
            && found[0].contains("234 GPa")
            && found[0].ends_with("did you mean \"54 MN/m\"?"),
        "{found:?}"
    );
    assert_eq!(whole("45e9 N/m"), [""; 0]);
}

/// A tie of 4 m and 20 MN/m that yields at 40 kN is 2 mm longer then, 0.05 %.
#[test]
fn ties_that_yield_at_nothing_or_never_are_told() {
    let told = |stiffness: &str, force: &str| {
        let text = format!(
            "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 12\nbricks = 5\n\
             brick = {{ length = 1.0, height = 0.5, thickness = 0.5, specific_weight = 18e3 }}\n\
             [[tie]]\nfrom = \"p1c12b1\"\nto = \"p1c12b5\"\nstiffness = \"{stiffness}\"\nyield_force = \"{force}\"\n\
             [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = 0.6 }}\n[motion]\nduration = 1.0\n"
        );
        prepared(&text, "tie[0].")
    };
    let at = "at its `stiffness` a tie of 4 m yields when it is";
    assert_eq!(
        told("20 MN/m", "40 N"),
        [format!(
            "tie[0].yield_force is 0.04 kN: {at} 5e-5 % longer, and steel does at 0.1 to 0.5 %; did you mean \"40 kN\"?"
        )]
    );
    assert_eq!(
        told("20 MN/m", "40 MN"),
        [format!(
            "tie[0].yield_force is 40000 kN: {at} 50 % longer, and steel does at 0.1 to 0.5 %; did you mean \"40 kN\"?"
        )]
    );
    // The wall weighs 60 times 4.5 kN.
    assert_eq!(
        told("20 kN/m", "40 N"),
        [
            "tie[0].yield_force is 0.04 kN: 0.000148 of the weight of wall and load, next to nothing; look at its unit and that of `stiffness`"
        ]
    );
    for fine in ["2 kN", "40 kN", "2 MN"] {
        assert_eq!(told("20 MN/m", fine), [""; 0], "{fine}");
    }
}

/// Anchors beside a wall are meant; one 30 m away from a wall of 5 m by 6 m, or above it, is a slip.
#[test]
fn ties_to_a_base_far_from_the_wall_are_told() {
    let told = |at: &str| {
        let text = format!(
            "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 12\nbricks = 5\n\
             brick = {{ length = 1.0, height = 0.5, thickness = 0.5, specific_weight = 18e3 }}\n\
             [[tie]]\nfrom = \"base\"\nat = {at}\nto = \"p1c12b1\"\nstiffness = \"20 MN/m\"\n\
             [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = 0.6 }}\n[motion]\nduration = 1.0\n"
        );
        prepared(&text, "tie[0].")
    };
    for (at, place) in [
        ("[30, 0]", "x = 30 m, y = 0 m, 25 m away"),
        ("[0.5, \"20 m\"]", "x = 0.5 m, y = 20 m, 14 m away"),
        ("[0.5, \"-20 m\"]", "x = 0.5 m, y = -20 m, 20 m away"),
    ] {
        let right = format!(
            "tie[0].at is fixed to the base at {place} from the wall, which goes from x = 0 to 5 m and up to y = 6 m; look at its unit"
        );
        assert_eq!(told(at), [right], "{at}");
    }
    for fine in ["[0.5, 0]", "[-8, 0]", "[12, -3]", "[-2, 7]"] {
        assert_eq!(told(fine), [""; 0], "{fine}");
    }
}

/// Three courses of a survey with a length that is wrong, and what is meant: teeth, steps, a footing.
#[test]
fn slips_in_surveyed_courses_are_told() {
    let told = |courses: &[(&str, &str)]| {
        let lists: String = courses
            .iter()
            .map(|(bricks, offset)| {
                format!("[[panel.course]]\nheight = 0.15\nbricks = [{bricks}]\noffset = {offset}\n")
            })
            .collect();
        let text = format!(
            "model = \"planar\"\n[[panel]]\nbond = \"irregular\"\n\
             brick = {{ length = 0.3, height = 0.15, thickness = 0.4, specific_weight = 21e3 }}\n\
             mortar = {{ bed = 0.015, head = 0.015 }}\n{lists}\
             [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = 0.6 }}\n[motion]\nduration = 1.0\n"
        );
        doubts(&case(&text)).iter().map(|doubt| doubt.text.clone()).collect::<Vec<_>>()
    };
    let (one, two, three) = (("0.42, 0.26, 0.39", "0"), ("0.25, 0.31, 0.24, 0.255", "0"), ("0.35, 0.4, 0.32", "0.005"));
    let apart = "they end more than half a brick of 0.3 m apart";
    assert_eq!(
        told(&[("4.2, 0.26, 0.39", "0"), two, three]),
        [format!(
            "panel[0].course[0] goes from 0 to 4.88 m, and beside it course[1] from 0 to 1.1 m and course[2] from 0.005 to 1.105 m: {apart}; did you mean bricks[0] = \"420 mm\"?"
        )]
    );
    let small = told(&[one, ("0.25, 0.31, 0.024, 0.255", "0"), three]);
    assert!(small.len() == 1 && small[0].ends_with("did you mean bricks[2] = \"240 mm\"?"), "{small:?}");
    for slip in [("0.42, 0.26, 0.19", "0"), ("0.42, 0.26, 0.39", "0.5")] {
        let found = told(&[one, slip, three]);
        assert!(found.len() == 1 && found[0].ends_with("look at its `bricks` and `offset`"), "{found:?}");
        assert!(found[0].starts_with("panel[0].course[1] goes") && found[0].contains(apart), "{found:?}");
    }
    // The first of two, one of a whole centimetre too few, and two of eight with their number.
    let found = told(&[("4.2, 0.26, 0.39", "0"), two]);
    assert!(found.len() == 1 && found[0].ends_with("did you mean bricks[0] = \"420 mm\"?"), "{found:?}");
    let found = told(&[one, two, three, ("0.42, 0.026, 0.39", "0")]);
    assert!(found.len() == 1 && found[0].ends_with("did you mean bricks[1] = \"260 mm\"?"), "{found:?}");
    let late = ("0.42, 0.26, 0.39", "-0.3");
    let found = told(&[one, late, three, one, two, late, three, one]);
    assert!(
        found.len() == 1
            && found[0].starts_with("panel[0].course[1] goes from -0.3 to")
            && found[0].contains("apart (2 courses of this panel do so); look at"),
        "{found:?}"
    );
    // A third of a brick too short where all others are flush: not of four courses, of ragged ones, or of toothing by half a brick.
    let short = ("0.42, 0.26, 0.29", "0");
    let found = told(&[one, two, short, three, one]);
    let says = "panel[0].course[2] goes from 0 to 1 m, and beside it course[1] from 0 to 1.1 m and course[3] from 0.005 to 1.105 m: they end more than a fifth of a brick of 0.3 m apart; look at its `bricks` and `offset`";
    assert_eq!(found, [says]);
    let (ragged, toothed) = (("0.42, 0.26, 0.36", "0"), ("0.42, 0.26, 0.24", "0"));
    assert_eq!(told(&[one, short, two, three]), [""; 0]);
    assert_eq!(told(&[one, two, short, ragged, one]), [""; 0]);
    assert_eq!(told(&[one, toothed, two, toothed, three]), [""; 0]);
    assert_eq!(told(&[one, two, three, one, short]), [""; 0]);
    // Short, long and short: a pattern, where no point has slipped.
    assert_eq!(told(&[("0.4, 0.4", "0"), ("0.3, 0.4, 0.4", "0"), ("0.4, 0.4", "0")]), [""; 0]);
    let slipped = told(&[("0.4, 0.4", "0"), ("0.4, 4", "0"), ("0.4, 0.4", "0")]);
    assert!(slipped.len() == 1 && slipped[0].ends_with("did you mean bricks[1] = \"400 mm\"?"), "{slipped:?}");
    // A chip in a course that ends right.
    assert_eq!(
        told(&[one, ("0.25, 0.31, 0.02, 0.475", "0"), three]),
        [
            "panel[0].course[1].bricks[2] is 0.02 m, 0.067 times the panel's brick of 0.3 m: stones have at least 0.1; look at both"
        ]
    );
    for fine in [
        vec![one, two, three],
        // Toothed by half a brick.
        vec![one, ("0.25, 0.31, 0.24, 0.405", "0"), one, ("0.25, 0.31, 0.24, 0.405", "0")],
        // Steps, on one side and on both.
        vec![("0.3, 0.3, 0.3, 0.3", "0"), ("0.3, 0.3, 0.3", "0"), ("0.3, 0.3", "0")],
        vec![("0.3, 0.3, 0.3, 0.3, 0.3", "0"), ("0.3, 0.3, 0.3", "0.315"), ("0.3", "0.63")],
        // Quoins long and short by more than half a brick, at one end.
        vec![("0.3, 0.3, 0.3, 0.6", "0"), one, ("0.3, 0.3, 0.3, 0.6", "0"), one],
        vec![one, ("0.3, 0.3, 0.3, 0.6", "0"), one, ("0.3, 0.3, 0.3, 0.6", "0"), one],
        // A ruined top, a footing that is longer on one side, a second course stepped back.
        vec![one, two, three, ("0.3, 0.4", "0")],
        vec![("0.5, 0.5, 0.5, 0.5", "0"), one, two, three],
        vec![one, ("0.3, 0.4", "0")],
        // A footing that is wider on both sides.
        vec![("0.5, 0.5, 0.5", "-0.2"), one, two, one],
    ] {
        assert_eq!(told(&fine), [""; 0], "{fine:?}");
    }
}

/// 800 courses where 80 were meant: 52 m of half a brick.
#[test]
fn walls_higher_than_any_of_their_thickness_are_told() {
    let told =
        |courses: &str| prepared(&WALL.replace("courses = 2", &format!("courses = {courses}")), "panel[0].brick");
    assert_eq!(
        told("800"),
        [
            "panel[0].brick.thickness is 0.12 m, and the panel 52 m high, 433 times as much, more than 100; look at thickness, `brick.height` and `courses`"
        ]
    );
    // Three storeys of half a brick, 9.1 m, are 76.
    assert_eq!(told("140"), [""; 0]);
    assert_eq!(told("190").len(), 1);
}

/// Two seconds of a weak wave and a strong one at 0.35 g between: what cuts the strong part off is told, with what is left.
#[test]
fn records_that_lose_their_strongest_part_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let wave = |k: i32| if (200..240).contains(&k) { 0.35 } else { 0.05 } * (0.3 * f64::from(k)).sin();
    let samples: String = (0..400).map(|k| format!("{}\n", wave(k))).collect();
    std::fs::write(folder.path().join("x.txt"), format!("# dt = 0.005 s, units: g\n{samples}")).expect("a record");
    let told = |keys: &str| {
        let moved = format!("base = {{ record = \"x.txt\"{keys} }}");
        let text = WALL.replace("base = { synthetic = { seed = 1, pga = 3.0, duration = 5.0, dt = 0.005 } }", &moved);
        let prepared = concio::run::prepare_case(case(&text), folder.path()).unwrap_or_else(|e| panic!("{e}"));
        let of_record = prepared.model.warnings.iter().filter(|w| w.contains("this leaves"));
        of_record.map(|w| w.text.clone()).collect::<Vec<_>>()
    };
    assert_eq!(
        told(", trim = [0, 0.9], pga = \"0.6 g\""),
        [
            "motion.base.trim: of the record's peak acceleration of 0.35 g this leaves 0.05 g: its strongest part is gone, and `pga` multiplies what is left by 12"
        ]
    );
    assert!(told(", baseline = { high_pass = \"30 Hz\" }")[0].contains("its strongest part is gone"));
    let sampled = told(", resample = 0.05");
    assert!(sampled[0].starts_with("motion.base.resample: of the record's peak acceleration of 0.35 g"), "{sampled:?}");
    for fine in
        ["", ", trim = [0.9, 1.9]", ", baseline = { high_pass = \"0.5 Hz\" }", ", resample = 0.01", ", scale = 0.1"]
    {
        assert_eq!(told(fine), [""; 0], "{fine}");
    }
    // What is advised of an offset takes no shaking away.
    let write = |unit: &str, sample: &dyn Fn(i32) -> f64| {
        let samples: String = (0..400).map(|k| format!("{}\n", sample(k))).collect();
        std::fs::write(folder.path().join("x.txt"), format!("# dt = 0.005 s, units: {unit}\n{samples}"))
            .expect("a record");
    };
    write("g", &|k| 0.3 + 0.1 * (0.3 * f64::from(k)).sin());
    assert_eq!(told(", baseline = { polynomial = 0 }"), [""; 0]);
    // Each step is held to its own limit: 0.25 g of 0.35 g are enough of a trimmed record, and sampling leaves them.
    write("g", &|k| if k < 200 { 0.25 } else { 0.35 } * (0.3 * f64::from(k)).sin());
    assert_eq!(told(", trim = [0, 0.9], resample = 0.01"), [""; 0]);
    // A displacement history has no peak acceleration of its own.
    write("mm", &wave);
    assert_eq!(told(", quantity = \"displacement\", trim = [0, 0.9]"), [""; 0]);
}

/// A region in millimetres holds the whole wall, and a change that was meant for a corner is one of all joints.
#[test]
fn regions_that_choose_nothing_are_told() {
    let told = |region: &str| {
        let change = format!("[[joint.change]]\nat = {{ region = {region} }}\nfriction = {{ static = 0.7 }}\n[load]");
        prepared(&WALL.replace("[load]", &change), "joint.change")
    };
    let found = told("[0, 0, 200, 100]");
    assert!(
        found.len() == 1
            && found[0].starts_with("joint.change[0].at.region, from 0, 0 to 200, 100 m, holds all ")
            && found[0].contains("in a wall up to x = 0.51 m, y = 0.13 m: it leaves none out"),
        "{found:?}"
    );
    assert_eq!(told("[0, 0, 0.2, 0.1]"), [""; 0]);
}

/// A beam of 4000 kg weighs 39.24 kN; a load of 40 kN/m on 0.49 m of brick brings 19.6 kN.
#[test]
fn a_beam_that_is_heavier_than_its_load_is_told_with_both_remedies() {
    let told = |top: &str| prepared(&WALL.replace("top = 40000", top), "load.beam.mass");
    assert_eq!(
        told("top = 40000"),
        [
            "load.beam.mass: the beam weighs 39240 N but load.top brings only 19600 N to the wall; its weight acts through load.top alone. Let load.top be \
             80.08 kN/m or more, or load.beam.mass 1998 kg or less"
        ]
    );
    assert_eq!(told("top = 80090"), [""; 0]);
    assert!(told("top = 0")[0].ends_with("Let load.top be 80.08 kN/m or more"));
    let force = told("top = { force = \"19.6 kN\" }");
    assert!(force[0].ends_with("Let load.top be 39.24 kN or more, or load.beam.mass 1998 kg or less"), "{force:?}");
}

/// Two seconds of ±0.35 g in a file in g, and what keys of the wall file make of them.
#[test]
fn records_scaled_by_g_or_one_without_the_other_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let samples: String = (0..400).map(|k| format!("{}\n", 0.35 * (0.3 * f64::from(k)).sin())).collect();
    for name in ["x.txt", "z.txt"] {
        std::fs::write(folder.path().join(name), format!("# dt = 0.005 s, units: g\n{samples}")).expect("a record");
    }
    let wall = "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n\
         brick = { length = 0.5, height = 0.5, thickness = 0.5, specific_weight = 18e3 }\n[joint]\nbed = { law = \"rigid\" }\n\
         head = { law = \"none\" }\nfriction = { law = \"coulomb\", static = 0.6 }\n[motion]\n";
    let told = |base: &str, vertical: &str| {
        let upright = if vertical.is_empty() { String::new() } else { format!("vertical = {{ {vertical} }}\n") };
        let case = case(&format!("{wall}base = {{ {base} }}\n{upright}"));
        let prepared = concio::run::prepare_case(case, folder.path()).unwrap_or_else(|e| panic!("{e}"));
        let words =
            ["conversion", "few records have", "no longer have the ratio", "hardly moves", "less than 0.01 m/s²"];
        let odd = |text: &String| words.into_iter().any(|word| text.contains(word));
        prepared.model.warnings.iter().map(|w| w.text.clone()).filter(odd).collect::<Vec<_>>()
    };
    let x = |rest: &str| format!("record = \"x.txt\"{rest}");
    let z = |rest: &str| format!("record = \"z.txt\"{rest}");
    let found = told(&x(", scale = 9.81"), "");
    assert!(
        found.len() == 2
            && found[0].starts_with(
                "motion.base.scale is 9.81, a conversion to or from g, but records are converted by their own unit: the peak is 3.43 g as it moves the wall, \
                 0.35 g without `scale`"
            )
            && found[1].contains("its peak acceleration is 3.43 g"),
        "{found:?}"
    );
    assert_eq!(told(&x(", scale = 0.102"), "").len(), 1);
    // 0.35 g times 6 is 2.1 g, times 5.5 is 1.9 g; who asks for a peak means it.
    assert_eq!(told(&x(", scale = 6"), "").len(), 1);
    for fine in ["", ", scale = 5.5", ", pga = \"2.5 g\""] {
        assert_eq!(told(&x(fine), ""), [""; 0], "{fine}");
    }
    // 0.35 g with its point a place off.
    assert!(
        told(&x(", pga = \"3.5 g\""), "")[0]
            .contains("its peak acceleration is 3.5 g as it moves the wall, more than 3 g")
    );
    // The same numbers without their unit.
    std::fs::write(folder.path().join("bare.txt"), format!("# dt = 0.005 s\n{samples}")).expect("a record");
    let bare = |rest: &str| told(&format!("record = \"bare.txt\", {rest}"), "");
    assert_eq!(
        bare("units = \"m/s2\""),
        [
            "motion.base.units is \"m/s2\", in which the record's peak acceleration is 0.0357 g: it hardly moves a wall. Is it 0.35 g? Then `units` is \"g\""
        ]
    );
    for fine in ["units = \"g\"", "units = \"m/s2\", pga = \"0.35 g\""] {
        assert_eq!(bare(fine), [""; 0], "{fine}");
    }
    // And with a wrong one in the file: numbers in g, numbers in m/s², and numbers that may be both.
    for (unit, factor, peak, meant) in [
        ("m/s2", 1.0, "0.0357", "Is it 0.35 g? Then its unit is \"g\""),
        ("cm/s2", 9.80665, "0.0035", "Is it 0.35 g? Then its unit is \"m/s2\""),
        ("cm/s2", 3.0, "0.00107", "Is it 1.05 g, or 0.107 g? Then its unit is \"g\", or \"m/s2\""),
        // Less than 0.01 m/s² too, which is told once.
        ("cm/s2", 2.0, "0.000714", "Is it 0.7 g, or 0.0714 g? Then its unit is \"g\", or \"m/s2\""),
    ] {
        let numbers: String = (0..400).map(|k| format!("{}\n", 0.35 * factor * (0.3 * f64::from(k)).sin())).collect();
        std::fs::write(folder.path().join("wrong.txt"), format!("# dt = 0.005 s, units: {unit}\n{numbers}"))
            .expect("a record");
        let said = format!(
            "motion.base.record: the unit in the file is \"{unit}\", in which the record's peak acceleration is {peak} g: it hardly moves a wall. {meant}"
        );
        assert_eq!(told("record = \"wrong.txt\"", ""), [said]);
        assert_eq!(told("record = \"wrong.txt\", pga = \"0.35 g\"", ""), [""; 0]);
    }
    // A weak vertical component is no slip beside a base that shakes; beside one as weak both are.
    let weak = |name: &str, size: f64| {
        let numbers: String = (0..400).map(|k| format!("{}\n", size * (0.3 * f64::from(k)).sin())).collect();
        std::fs::write(folder.path().join(name), format!("# dt = 0.005 s, units: m/s2\n{numbers}")).expect("a record");
    };
    weak("weak-x.txt", 1.0);
    weak("weak-z.txt", 0.4);
    assert_eq!(told("record = \"weak-x.txt\"", "record = \"weak-z.txt\""), [""; 0]);
    weak("weak-x.txt", 0.45);
    let both = told("record = \"weak-x.txt\"", "record = \"weak-z.txt\"");
    assert!(both.len() == 2 && both.iter().all(|w| w.contains("hardly moves")), "{both:?}");
    // A limit is not told of itself.
    assert_eq!(told(&x(", pga = \"3 g\""), ""), [""; 0]);
    assert!(told(&x(", pga = \"3.0001 g\""), "")[0].contains("3.0001 g as it moves the wall, more than 3 g"));
    assert_eq!(
        told(&x(", pga = \"0.7 g\""), &z("")),
        [
            "motion.vertical is not scaled, and `pga` multiplies motion.base by 2: the two no longer have the ratio that was recorded. `scale = 2` in motion.vertical keeps \
             their ratio; `scale = 1` says that it is meant so"
        ]
    );
    assert_eq!(told(&x(""), &z(", scale = 0.5")).len(), 1);
    for (base, vertical) in [
        ("", ""),
        (", pga = \"0.7 g\"", ", scale = 2"),
        (", pga = \"0.36 g\"", ""),
        (", pga = \"0.7 g\"", ", scale = 1"),
    ] {
        assert_eq!(told(&x(base), &z(vertical)), [""; 0], "{base} {vertical}");
    }
}
