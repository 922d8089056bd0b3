//! Wall files: reading, parameter sets, patterns, and what comes back from a stored case.

use std::path::Path;

use concio::case::{
    Baseline, Beam, Case, FrictionLaw, FrictionOn, ModelKind, NormalForce, Signal, SpringLaw, Syntax, canonical_json,
    example, from_str, read, schema, starter,
};
use concio::pattern::lay;
use concio::wall::Wall;
use proptest::prelude::*;

/// The wall file of the design page, word for word.
const DESIGN: &str = r#"
model = "shear"                        # or "planar"

[[panel]]
bond = "running"                       # running | stack | irregular | explicit
courses = 6
bricks = 4
ends = "flush"                         # flush (half bricks) | toothed
first = "full"                         # bottom course: full bricks | half (starts with a half brick or half-pitch shift)
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }

[joint]
damping_ratio = 0.05
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m", rigidity = 1000 }
friction = { law = "stribeck", static = 0.6, dynamic = 0.42, slip_velocity = "1 mm/s", beta = 100, alpha = 0, on = "bed", normal_force = "transmitted" }

[load]
top = "10 kN/m"
beam = "driven"                        # free | driven | tied | { mass = "1000 kg" }

[motion]
duration = "0.5 s"
base = "none"                          # { record = "path", scale = 1.0 } | { sine = {...} } | ...
top = { sine = { amplitude = "5 mm", frequency = "2 Hz", ramp = "0.5 s" } }   # displacement × min(1, t/ramp)
"#;

fn toml(text: &str) -> Case {
    let file = from_str(text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
    file.validate().unwrap_or_else(|e| panic!("{e}\n{text}"));
    file.case
}

/// A case with another panel, of the design page's joints and motion.
fn with_panel(panel: &str) -> Case {
    let tail = DESIGN.split_once("[joint]").expect("the design page has joints").1;
    toml(&format!("model = \"shear\"\n[[panel]]\n{panel}\n[joint]{tail}"))
}

const BRICK: &str = "brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }\n";

fn per_course(wall: &Wall) -> Vec<usize> {
    let mut count = vec![0; wall.panels[0].courses];
    for block in wall.blocks.iter().filter(|b| b.panel == 0) {
        count[block.course] += 1;
    }
    count
}

#[test]
fn the_design_page_is_read_as_it_stands() {
    let case = toml(DESIGN);
    let brick = case.panels[0].brick;
    assert_eq!([brick.length.si(), brick.height.si(), brick.thickness.si()], [0.25, 0.055, 0.12]);
    assert_eq!(brick.specific_weight.si(), 18e3);
    assert_eq!((case.panels[0].courses, case.panels[0].bricks), (Some(6), Some(4)));
    assert_eq!((case.joint.bed.law, case.joint.head.law), (SpringLaw::Elastic, SpringLaw::NoTension));
    assert_eq!(case.joint.bed.stiffness.amount(), 5.4e7);
    let friction = case.joint.friction;
    assert_eq!((friction.law, friction.on), (FrictionLaw::Stribeck, FrictionOn::Bed));
    assert_eq!([friction.static_, friction.dynamic, friction.slip_velocity.si()], [0.6, 0.42, 1e-3]);
    assert_eq!((case.load.top, case.load.beam), (1e4.into(), Beam::Driven));
    assert_eq!(case.motion.base, Signal::None);
    let Signal::Sine(sine) = case.motion.top else { panic!("not a sine: {:?}", case.motion.top) };
    assert_eq!(sine.amplitude.map(|a| a.si()), Some(5e-3));
    assert_eq!((sine.frequency.si(), sine.ramp.si()), (2.0, 0.5));
}

#[test]
fn a_stored_case_reads_back_equal() {
    let texts = [
        DESIGN.to_string(),
        starter(ModelKind::Shear).to_string(),
        starter(ModelKind::Planar).to_string(),
        starter(ModelKind::Rocking).to_string(),
        DESIGN.replace("\"driven\"", "{ mass = \"1 t\" }").replace("top = { sine", "# top = { sine"),
        DESIGN.replace("base = \"none\"", "base = { record = \"a b.at2\", pga = \"0.3 g\", trim = [1, \"20 s\"], baseline = { high-pass = \"0.1 Hz\" } }"),
        DESIGN.replace("base = \"none\"", "base = { record = \"x.csv\", scale = -1.7, baseline = { polynomial = 2 }, quantity = \"displacement\", units = \"mm\", dt = 0.01 }"),
        DESIGN.replace("base = \"none\"", "base = { synthetic = { seed = 18446744073709551615, pga = \"0.1 g\", duration = 9 } }"),
        DESIGN.replace("base = \"none\"", "base = { sweep = { acceleration = \"1 g\", frequency = [1, \"20 Hz\"], duration = 3, logarithmic = true } }"),
        DESIGN.replace("base = \"none\"", "base = { pulse = { shape = \"half-sine\", acceleration = 3, duration = 0.1 } }"),
        DESIGN.replace("base = \"none\"", "base = { ramp = { amplitude = 0.1, rise = 0.1 } }"),
        DESIGN.replace("base = \"none\"", "base = { tilt = { acceleration = \"0.5 g\", rise = 10 } }"),
        DESIGN.replace("base = \"none\"", "base = { path = { displacements = [\"1 mm\", -0.001, 0.002], speed = \"0.5 mm/s\" } }"),
        DESIGN.replace("stiffness = \"5.4e7 N/m\" }", "stiffness = \"36.1 N/mm3\" }"),
        DESIGN
            .replace("model = \"shear\"", "model = \"planar\"")
            .replace("rigidity = 1000", "normal_to_shear = 2.2, compressive_strength = \"4 MPa\"")
            .replace("beam = \"driven\"", "beam = \"driven\"\nbeam_rotation = \"fixed\"")
            .replace("[joint]", "[[tie]]\nfrom = \"base\"\nto = \"p1c6b1\"\nat = [0, \"1 m\"]\nstiffness = \"20 MN/m\"\nyield_force = 4e4\n[joint]")
            .replace("[motion]", "[solver]\nstep = \"2 ms\"\n[motion]\nquasi_static = true\nvertical = { tilt = { acceleration = 1, rise = 1 } }"),
        DESIGN.replace("[joint]", "[[panel.opening]]\nx = 0.3\ny = 0\nwidth = 0.3\nheight = 0.13\nlintel = { height = \"65 mm\", bearing = 0.1 }\n[joint]"),
        DESIGN.replace("model =", "set = { name = \"p1\", at = 0.3 }\nmodel ="),
        DESIGN.replace("[load]", "[[joint.change]]\nat = { kind = [\"bed\"], panel = [\"p1\"], course = [2, 7], joints = [\"a|b\"], region = [0, 0, 1, 1] }\nspring = { stiffness_factor = 0 }\nfriction = { static = 0.7 }\n[load]"),
    ];
    for text in texts {
        let case = toml(&text);
        let json = canonical_json(&case);
        let again = from_str(&json, Syntax::Json, None).unwrap_or_else(|e| panic!("{e}\n{json}")).case;
        assert_eq!(case, again, "{json}");
        let by_serde: Case = serde_json::from_str(&json).unwrap_or_else(|e| panic!("{e}\n{json}"));
        assert_eq!(case, by_serde);
        assert_eq!(json, canonical_json(&again));
    }
}

#[test]
fn forms_of_a_baseline() {
    let with = |baseline: &str| {
        let base = format!("base = {{ record = \"r\", baseline = {baseline} }}");
        match toml(&DESIGN.replace("base = \"none\"", &base)).motion.base {
            Signal::Record(r) => r.baseline,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(with("\"none\""), Baseline::None);
    assert_eq!(with("{ polynomial = 2 }"), Baseline::Polynomial(2));
    let corner = concio::quantity::Frequency::from_si(0.1);
    for key in ["high-pass", "high_pass"] {
        assert_eq!(with(&format!("{{ {key} = \"0.1 Hz\", order = 3 }}")), Baseline::HighPass { corner, order: 3 });
        assert_eq!(with(&format!("{{ {key} = 0.1 }}")), Baseline::HighPass { corner, order: 4 });
    }
}

#[test]
fn toml_and_json_say_the_same() {
    let value: toml::Value = toml::from_str(DESIGN).expect("the design page is TOML");
    let json = serde_json::to_string_pretty(&value).expect("TOML without dates is JSON");
    let a = from_str(DESIGN, Syntax::Toml, None).expect("TOML").case;
    let b = from_str(&json, Syntax::Json, None).expect("JSON").case;
    assert_eq!(a, b);
    assert_eq!(Syntax::of(Path::new("w.json"), ""), Syntax::Json);
    assert_eq!(Syntax::of(Path::new("w.toml"), "{"), Syntax::Toml);
    assert_eq!(Syntax::of(Path::new("w"), " \n{"), Syntax::Json);
    assert_eq!(Syntax::of(Path::new("w"), "model = 1"), Syntax::Toml);
}

/// Numbers of model.md, section 5 (the report's Table 1 and section 4.2).
#[test]
fn parameter_sets_give_what_the_report_prints() {
    let bare = |set: &str, joint: &str| {
        toml(&format!(
            "model = \"shear\"\nset = {set}\n[[panel]]\nbond = \"running\"\ncourses = 2\nbricks = 2\n{joint}\n[motion]\nduration = 1\n"
        ))
    };
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} instead of {b}");
    let report = bare("{ name = \"report\", at = 0 }", "");
    close(report.joint.friction.static_, 0.40);
    close(report.joint.friction.dynamic, 0.28);
    close(report.joint.bed.stiffness.amount(), 5.4e7);
    close(report.joint.head.stiffness.amount(), 5.4e7);
    close(report.panels[0].mortar.bed.si(), 0.01);
    close(report.panels[0].brick.specific_weight.si(), 18e3);
    assert_eq!(report.joint.damping_ratio, 0.05);
    assert_eq!(report.joint.head.law, SpringLaw::NoTension);
    let report = bare("{ name = \"report\", at = 1 }", "");
    close(report.joint.friction.static_, 0.80);
    close(report.joint.friction.dynamic, 0.56);

    let p1 = bare("\"p1\"", "");
    close(p1.joint.friction.static_, 30f64.to_radians().tan());
    close(p1.joint.friction.dynamic, 0.7 * 30f64.to_radians().tan());
    close(p1.joint.head.stiffness.amount(), 1.26e8);
    close(p1.joint.bed.stiffness.amount(), 1.035e8);
    close(p1.panels[0].brick.specific_weight.si(), 19_620.0);
    close(p1.panels[0].mortar.head.si(), 0.015);

    let p2 = bare("{ name = \"p2\", at = 1.0 }", "");
    close(p2.joint.friction.static_, 38f64.to_radians().tan());
    close(p2.joint.head.stiffness.amount(), 1.80e7);
    close(p2.joint.bed.stiffness.amount(), 2.16e7);

    let p3 = bare("{ name = \"p3\", at = 0 }", "[joint.friction]\nstatic = 0.5\ndynamic = 0.4");
    close(p3.joint.friction.static_, 0.5);
    assert_eq!(p3.joint.friction.law, FrictionLaw::Stribeck);
    close(p3.joint.head.stiffness.amount(), 4.55e6);
    close(p3.joint.bed.stiffness.amount(), 6.476e7);
    close(p3.panels[0].brick.thickness.si(), 0.299);
    assert_eq!(bare("\"p3\"", "[joint.friction]\nlaw = \"none\"").joint.friction.law, FrictionLaw::None);

    let p4 = bare("{ name = \"p4\", at = 0.5 }", "brick = { specific_weight = 16000 }\n");
    close(p4.joint.bed.stiffness.amount(), 6.02e7);
    close(p4.panels[0].mortar.bed.si(), 0.0125);
    close(p4.panels[0].brick.height.si(), 0.07);
    close(p4.joint.friction.static_, 39.7f64.to_radians().tan());
}

#[test]
fn the_file_wins_over_its_set() {
    let case = toml(&DESIGN.replace("model =", "set = \"p2\"\nmodel ="));
    let mut without = toml(DESIGN);
    without.set = case.set.clone();
    assert_eq!(case, without);
}

#[test]
fn the_preset_of_the_report_is_written_out() {
    let text = DESIGN.replace("on = \"bed\", normal_force = \"transmitted\"", "preset = \"report\"");
    let friction = toml(&text).joint.friction;
    assert_eq!((friction.on, friction.normal_force), (FrictionOn::All, NormalForce::Overburden));
}

#[test]
fn templates_are_walls() {
    for model in [ModelKind::Shear, ModelKind::Planar, ModelKind::Rocking] {
        let file = from_str(starter(model), Syntax::Toml, None).expect("a starter is read");
        file.validate().expect("a starter is valid");
        concio::pattern::lay(&file.case).expect("a starter is laid");
        assert_eq!(file.case.model, model);
    }
    let example = example().expect("the built-in wall is read");
    example.validate().expect("the built-in wall is valid");
    assert_eq!(concio::pattern::lay(&example.case).expect("the built-in wall is laid").blocks.len(), 27);
}

/// Every key of a case has a description, and the schema of the file's forms holds the words.
#[test]
fn the_schema_documents_every_key() {
    let schema = schema();
    let mut keys = 0;
    let definitions = schema["$defs"].as_object().expect("definitions");
    let tables = definitions.iter().map(|(n, d)| (n.as_str(), d)).chain([("Case", &schema)]);
    for (name, definition) in tables {
        for (key, property) in definition["properties"].as_object().into_iter().flatten() {
            assert!(property["description"].is_string(), "{name}.{key} has no description");
            keys += 1;
        }
    }
    assert!(keys > 80, "only {keys} keys");
    assert!(!schema.to_string().contains("\"null\""));
    assert!(definitions["Brick"]["properties"]["specific_weight"].is_object());
    assert_eq!(definitions["Beam"]["anyOf"][0]["enum"], serde_json::json!(["free", "driven", "tied"]));
}

#[test]
fn a_file_is_read_with_its_folder() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("wall.toml");
    std::fs::write(&path, format!("\u{feff}{DESIGN}")).expect("written");
    let file = read(&path).expect("read");
    assert_eq!(file.folder(), dir.path());
    assert_eq!(file.path(), Some(path.as_path()));
    assert_eq!(file.case, toml(DESIGN));
}

#[test]
fn the_flush_panel_of_the_report_has_27_blocks() {
    let wall = lay(&toml(DESIGN)).expect("laid");
    assert_eq!(wall.blocks.len(), 27);
    assert_eq!(per_course(&wall), [4, 5, 4, 5, 4, 5]);
    let second: Vec<f64> = wall.blocks.iter().filter(|b| b.course == 1).map(|b| b.length()).collect();
    // A flush half brick is (L − t_h)/2 long (model, section 1).
    for (length, expected) in second.iter().zip([0.12, 0.25, 0.25, 0.25, 0.12]) {
        assert!((length - expected).abs() < 1e-15, "{second:?}");
    }
    assert_eq!(wall.blocks[4].name, "p1c2b1");
    assert_eq!(wall.blocks[0].y, [0.01, 0.065]);
    assert!((wall.blocks[26].y[1] - 6.0 * 0.065).abs() < 1e-15);
    let info = &wall.panels[0];
    assert_eq!((info.name.as_str(), info.courses, info.reference_length), ("p1", 6, 0.25));
    // M = γ L H B / g.
    assert!((info.reference_mass - 18e3 * 0.25 * 0.055 * 0.12 / 9.81).abs() < 1e-12);
}

#[test]
fn toothed_and_stacked_courses() {
    let mortar = "mortar = { bed = 0.01, head = 0.01 }\n";
    let wall = lay(&with_panel(&format!(
        "bond = \"running\"\ncourses = 3\nbricks = 3\nends = \"toothed\"\nfirst = \"half\"\n{BRICK}{mortar}"
    )))
    .expect("laid");
    let starts: Vec<f64> = wall.blocks.iter().map(|b| b.x[0]).collect();
    let expected = [0.13, 0.39, 0.65, 0.0, 0.26, 0.52, 0.13, 0.39, 0.65];
    assert!(starts.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{starts:?}");
    let wall = lay(&with_panel(&format!("bond = \"stack\"\ncourses = 2\nbricks = 2\n{BRICK}{mortar}"))).expect("laid");
    let starts: Vec<f64> = wall.blocks.iter().map(|b| b.x[0]).collect();
    assert_eq!(starts, [0.0, 0.26, 0.0, 0.26]);
}

#[test]
fn listed_courses_and_explicit_blocks() {
    let lists = "bond = \"irregular\"\nmortar = { bed = 0.01, head = 0.01 }\n".to_string()
        + BRICK
        + "[[panel.course]]\nheight = 0.08\nbricks = [0.3, \"200 mm\"]\n[[panel.course]]\nheight = 0.05\noffset = 0.1\nbricks = [0.1, 0.25]\n";
    let wall = lay(&with_panel(&lists)).expect("laid");
    assert_eq!(wall.blocks[1].x, [0.31, 0.51]);
    assert_eq!(wall.blocks[2].x, [0.1, 0.2]);
    assert_eq!(wall.blocks[2].y, [0.01 + (0.08 + 0.01), 0.01 + (0.08 + 0.01) + 0.05]);

    let blocks = "bond = \"explicit\"\n".to_string()
        + BRICK
        + "[[panel.block]]\nid = \"right\"\ncourse = 1\nx = 0.3\ny = 0\nlength = 0.2\nheight = 0.1\nspecific_weight = \"20 kN/m3\"\n"
        + "[[panel.block]]\ncourse = 1\nx = 0\ny = 0\nlength = 0.3\nheight = 0.1\n"
        + "[[panel.block]]\nid = \"lintel\"\ncourse = 2\nx = -0.1\ny = 0.1\nlength = 0.7\nheight = 0.1\n";
    let wall = lay(&with_panel(&blocks)).expect("laid");
    let names: Vec<&str> = wall.blocks.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["p1c1b1", "right", "lintel"]);
    assert_eq!((wall.blocks[0].specific_weight, wall.blocks[1].specific_weight), (18e3, 20e3));
}

#[test]
fn panels_in_series_stand_a_connection_apart() {
    let mortar = "mortar = { bed = 0.01, head = 0.01 }\n";
    let one = format!("bond = \"running\"\ncourses = 2\nbricks = 2\nends = \"toothed\"\n{BRICK}{mortar}");
    let text =
        format!("{one}[[panel]]\nname = \"tower\"\nconnection = \"20 mm\"\nfirst = \"half\"\n{one}[[panel]]\n{one}");
    let wall = lay(&with_panel(&text)).expect("laid");
    let edges = |p: usize| {
        let blocks = wall.blocks.iter().filter(move |b| b.panel == p);
        blocks.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], k| [a.min(k.x[0]), b.max(k.x[1])])
    };
    let [a, b, c] = [edges(0), edges(1), edges(2)];
    assert!((b[0] - a[1] - 0.02).abs() < 1e-12 && (c[0] - b[1] - 0.01).abs() < 1e-12, "{a:?} {b:?} {c:?}");
    let info: Vec<(&str, f64)> = wall.panels.iter().map(|p| (p.name.as_str(), p.connection)).collect();
    assert_eq!(info, [("p1", 0.0), ("tower", 0.02), ("p3", 0.01)]);
}

#[test]
fn half_a_million_bricks() {
    let mortar = "mortar = { bed = 0.01, head = 0.01 }\n";
    let case = with_panel(&format!("bond = \"running\"\ncourses = 1000\nbricks = 499\n{BRICK}{mortar}"));
    let wall = lay(&case).expect("laid");
    assert_eq!(wall.blocks.len(), 499_500);
    let [last] = &wall.blocks[499_499..] else { panic!("no last block") };
    assert!((last.x[1] - (499.0 * 0.25 + 498.0 * 0.01)).abs() < 1e-9);
}

/// Wide walls and tight bounds: each course has to foresee its end.
#[test]
fn random_textures_are_found_where_they_are_rare() {
    for (seed, width, length, stagger) in [
        (1, 250.0, [0.2, 0.3], 0.05),
        (2, 5.0, [0.2, 0.25], 0.03),
        (3, 1.03, [0.25, 0.27], 0.0),
        (4, 3.0, [0.1, 0.3], 0.05),
    ] {
        let wall = lay(&random_case(seed, width, length, stagger, 100, 0.01)).unwrap_or_else(|e| panic!("{seed}: {e}"));
        assert_eq!(wall.panels[0].courses, 100);
    }
}

/// The texture of a seed is part of what a result can be reproduced from: these numbers were taken from the first
/// version and must not change.
#[test]
fn a_seed_gives_the_same_texture_for_ever() {
    let wall = lay(&random_case(7, 1.0, [0.15, 0.3], 0.04, 3, 0.01)).expect("laid");
    let ends: Vec<f64> = wall.blocks.iter().map(|b| b.x[1]).collect();
    assert_eq!(ends, GOLDEN_ENDS);
}

/// Right edges, course by course. The first one follows from ChaCha8 with the key 7, 0, … (written anew in another
/// language): its first 53 bits place 0.2646163563071607 between 0.15 and 0.3.
const GOLDEN_ENDS: [f64; 14] = [
    0.2646163563071607,
    0.4945069985751548,
    0.6907944310112173,
    1.0,
    0.17248740721896266,
    0.37960234203925364,
    0.5770366749415887,
    0.7735810912879014,
    1.0,
    0.22945155022213007,
    0.4906034544288823,
    0.6765397026175264,
    0.8386669743302952,
    1.0,
];

fn random_case(seed: u64, width: f64, length: [f64; 2], stagger: f64, courses: usize, mortar: f64) -> Case {
    with_panel(&format!(
        "bond = \"irregular\"\ncourses = {courses}\n{BRICK}mortar = {{ bed = {mortar:?}, head = {mortar:?} }}\n\
         random = {{ seed = {seed}, width = {width:?}, length = [{:?}, {:?}], height = [0.05, 0.09], stagger = {stagger:?} }}",
        length[0], length[1]
    ))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Every course is as wide as asked, bricks and heights are within bounds, joints keep the stagger, the area of
    /// bricks and head joints makes up the panel.
    #[test]
    fn random_textures_keep_their_bounds(
        seed in 0u64..1 << 53,
        width in 1.0f64..8.0,
        shortest in 0.1f64..0.25,
        ratio in 1.6f64..3.0,
        part in 0.0f64..0.3,
        courses in 1usize..30,
        mortar in prop_oneof![Just(0.0), 0.001f64..0.02],
    ) {
        let (longest, stagger) = (shortest * ratio, shortest * part);
        let wall = lay(&random_case(seed, width, [shortest, longest], stagger, courses, mortar)).expect("laid");
        let mut below: Vec<f64> = Vec::new();
        let mut area = 0.0;
        for r in 0..courses {
            let row: Vec<_> = wall.blocks.iter().filter(|b| b.course == r).collect();
            prop_assert_eq!(row[0].x[0], 0.0);
            prop_assert!((row[row.len() - 1].x[1] - width).abs() <= 1e-9 * width);
            for b in &row {
                prop_assert!(b.length() >= shortest - 1e-8 && b.length() <= longest + 1e-8, "{}", b.length());
                prop_assert!(b.height() >= 0.05 - 1e-12 && b.height() <= 0.09 + 1e-12);
                prop_assert_eq!(b.y, row[0].y);
                area += b.length() * b.height();
            }
            let joints: Vec<f64> = row.windows(2).map(|p| (p[0].x[1] + p[1].x[0]) / 2.0).collect();
            for pair in row.windows(2) {
                prop_assert!((pair[1].x[0] - pair[0].x[1] - mortar).abs() < 1e-9);
            }
            for j in &joints {
                prop_assert!(below.iter().all(|b| (b - j).abs() >= stagger - 1e-9));
            }
            area += joints.len() as f64 * mortar * row[0].height();
            below = joints;
        }
        let height: f64 = (0..courses).map(|r| wall.blocks.iter().find(|b| b.course == r).map_or(0.0, |b| b.height())).sum();
        prop_assert!((area - width * height).abs() < 1e-9 * area);
    }

    /// Regular walls: no two blocks overlap, all flush courses are equally wide, bricks and mortar make up the panel.
    #[test]
    fn regular_walls_fill_their_panel(
        courses in 1usize..12,
        bricks in 1usize..12,
        half in any::<bool>(),
        stack in any::<bool>(),
        mortar in prop_oneof![Just(0.0), 0.001f64..0.03],
    ) {
        let bond = if stack { "bond = \"stack\"" } else if half { "bond = \"running\"\nfirst = \"half\"" } else { "bond = \"running\"" };
        let case = with_panel(&format!("{bond}\ncourses = {courses}\nbricks = {bricks}\n{BRICK}mortar = {{ bed = {mortar:?}, head = {mortar:?} }}\n"));
        let wall = lay(&case).expect("laid");
        let width = bricks as f64 * 0.25 + (bricks - 1) as f64 * mortar;
        let mut area = 0.0;
        for r in 0..courses {
            let row: Vec<_> = wall.blocks.iter().filter(|b| b.course == r).collect();
            prop_assert_eq!(row[0].x[0], 0.0);
            prop_assert!((row[row.len() - 1].x[1] - width).abs() < 1e-12 * (1.0 + width));
            prop_assert!(row.windows(2).all(|p| (p[1].x[0] - p[0].x[1] - mortar).abs() < 1e-12));
            area += row.iter().map(|b| b.length() * b.height()).sum::<f64>() + (row.len() - 1) as f64 * mortar * 0.055;
        }
        prop_assert!((area - width * courses as f64 * 0.055).abs() < 1e-12 * area.max(1.0));
        for (i, a) in wall.blocks.iter().enumerate() {
            for b in &wall.blocks[i + 1..] {
                let overlap = |p: [f64; 2], q: [f64; 2]| p[1].min(q[1]) - p[0].max(q[0]);
                prop_assert!(overlap(a.x, b.x) < 1e-9 || overlap(a.y, b.y) < 1e-9, "{} {}", a.name, b.name);
            }
        }
    }
}

/// Coulomb's own law has one coefficient: what is not given follows it, in a change too, unless the wall gives the other.
#[test]
fn coulomb_friction_has_one_coefficient_unless_two_are_given() {
    let read = |friction: &str, change: &str| {
        let text = format!(
            "model = \"shear\"\n[[panel]]\nbond = \"stack\"\ncourses = 2\nbricks = 1\n\
             brick = {{ length = 1, height = 1, thickness = 1, specific_weight = \"1800 kg/m3\" }}\n[joint]\n\
             bed = {{ law = \"elastic\", stiffness = 1e8 }}\nhead = {{ law = \"none\" }}\nfriction = {{ {friction} }}\n\
             [[joint.change]]\nat = {{ kind = [\"bed\"] }}\nfriction = {{ {change} }}\n[motion]\nduration = 1\n"
        );
        from_str(&text, Syntax::Toml, None).map(|file| {
            assert!(file.findings().is_empty(), "{:?}", file.findings());
            let [change] = &file.case.joint.changes[..] else { panic!("one change") };
            let change = change.friction.expect("a change of friction");
            (file.case.joint.friction.dynamic, change.dynamic)
        })
    };
    let coulomb = "law = \"coulomb\", static = 0.6";
    assert_eq!(read(coulomb, "static = 0.4").expect("a wall"), (0.6, Some(0.4)));
    assert_eq!(read(coulomb, "static = 0.7, dynamic = 0.5").expect("a wall"), (0.6, Some(0.5)));
    assert_eq!(read(&format!("{coulomb}, dynamic = 0.3"), "static = 0.4").expect("a wall"), (0.3, None));
    assert_eq!(read("law = \"none\"", "law = \"coulomb\", static = 0.4").expect("a wall"), (0.0, Some(0.4)));
    // What varies in a study is followed as well.
    let file = from_str(
        "model = \"shear\"\nset = \"report\"\n[[panel]]\nbond = \"stack\"\ncourses = 2\nbricks = 1\n[joint]\n\
         friction = { law = \"none\" }\n[motion]\nduration = 1\n",
        Syntax::Toml,
        None,
    );
    let change =
        [("joint.friction".to_string(), serde_json::json!({ "law": "coulomb", "static": 0.5, "dynamic": 0.2 }))];
    assert_eq!(file.expect("a wall").changed(&change).expect("a wall").case.joint.friction.dynamic, 0.2);
    let e = read("law = \"stribeck\", static = 0.6", "static = 0.7").expect_err("no coefficient of slip");
    assert!(e.to_string().contains("joint.friction.dynamic: the key is missing: law `stribeck` needs it"), "{e}");
}
