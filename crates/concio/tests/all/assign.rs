//! What the wall file says of the joints, as models compile it: laws of planar walls, stiffness per joint and per area.

use concio::assign::{JointLaw, resolve};
use concio::case::{Case, JointKind, SpringLaw, Syntax, from_str};
use concio::model::Model;
use concio::pattern::lay;
use concio::run::prepare_case;
use concio::wall::{Joint, Wall};
use concio::{Error, graph};

const WALL: &str = r#"
model = "shear"
[[panel]]
bond = "running"
courses = 3
bricks = 3
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[[panel]]
bond = "running"
courses = 2
bricks = 2
brick = { length = "300 mm", height = "80 mm", thickness = "200 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
bed = { law = "elastic", stiffness = "36 N/mm3" }
head = { law = "no-tension", stiffness = "15 MPa/mm", rigidity = 100 }
friction = { law = "coulomb", static = 0.6, dynamic = 0.5 }
[load]
top = "10 kN/m"
beam = { mass = "500 kg" }
[motion]
duration = "0.1 s"
base = { pulse = { shape = "one-sine", acceleration = "0.6 g", duration = "0.1 s" } }
"#;

fn case(text: &str) -> Case {
    let file = from_str(text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    file.validate().unwrap_or_else(|e| panic!("{e}"));
    file.case
}

fn laws(case: &Case) -> (Wall, Vec<Joint>, Vec<JointLaw>) {
    let wall = lay(case).expect("laid");
    let joints = graph::joints(&wall, true);
    let laws = resolve(case, &wall, &joints).unwrap_or_else(|e| panic!("{e}"));
    (wall, joints, laws)
}

fn model(text: &str) -> Model {
    prepare_case(case(text), std::path::Path::new("")).unwrap_or_else(|e| panic!("{e}")).model
}

/// k A of every joint, whatever its kind: the overlap weight must not come in a second time. Between panels of different
/// thickness it is the thinner one that counts.
#[test]
fn stiffness_per_area_is_that_of_the_contact() {
    let case = case(WALL);
    let (wall, joints, laws) = laws(&case);
    let model = model(WALL);
    let mut kinds = std::collections::BTreeSet::new();
    for ((joint, law), elastic) in joints.iter().zip(&laws).zip(&model.shear.elastic) {
        let thickness = if wall.blocks[joint.a].panel == 0 { 0.12 } else { 0.2 };
        let upright = joint.kind.is_upright();
        let expected = if upright { 15e9 } else { 36e9 } * joint.overlap * thickness;
        assert!((law.stiffness(joint, &wall) / expected - 1.0).abs() < 1e-14);
        let kappa = if upright { 100.0 } else { 1.0 };
        assert!((elastic.stiffness / (kappa * expected) - 1.0).abs() < 1e-14);
        kinds.insert(format!("{:?}", joint.kind));
    }
    assert_eq!(kinds.len(), 5, "{kinds:?}");
}

/// A half-brick contact of the reference brick has L_ref B/2, a head joint H B: with that times k for K_H and K_V the wall
/// is the same, its dashpots (4) included.
#[test]
fn per_area_and_per_joint_say_the_same_of_one_brick() {
    let one = WALL.split_once("[[panel]]\nbond = \"running\"\ncourses = 2").expect("two panels");
    let one = format!("{}[joint]{}", one.0, one.1.split_once("[joint]").expect("joints").1);
    let (bed, head) = (36e9 * 0.125 * 0.12, 15e9 * 0.055 * 0.12);
    let per_joint =
        one.replace("\"36 N/mm3\"", &format!("{bed:?}")).replace("\"15 MPa/mm\"", &format!("\"{head:?} N/m\""));
    let (a, b) = (model(&one), model(&per_joint));
    for (a, b) in a.shear.elastic.iter().zip(&b.shear.elastic) {
        assert!((a.stiffness / b.stiffness - 1.0).abs() < 1e-13, "{a:?} {b:?}");
        assert!((a.damping / b.damping - 1.0).abs() < 1e-13 && a.damping > 0.0, "{a:?} {b:?}");
    }
    // A bond knows the same stiffness as the spring that it takes the place of.
    let bonded = model(&one.replace("[load]", "[joint.bond]\ncohesion = 1e5\ntensile_strength = 5e4\n[load]"));
    assert!(bonded.shear.bonds.len() > 20);
    for bond in &bonded.shear.bonds {
        let expected = a.shear.elastic[bond.joint as usize].stiffness / if bond.law.opens { 100.0 } else { 1.0 };
        assert!((bond.law.stiffness / expected - 1.0).abs() < 1e-13);
    }
}

/// In planar walls every joint opens and closes: each law for each kind, from the common laws and from changes.
#[test]
fn planar_walls_take_every_law_for_every_joint() {
    for law in ["no-tension", "rigid", "none", "elastic"] {
        let bed = format!("bed = {{ law = \"{law}\", stiffness = \"36 N/mm3\"");
        let changed = format!("[[joint.change]]\nat = {{ kind = [\"base\"] }}\nspring = {{ law = \"{law}\" }}\n[load]");
        for text in [
            WALL.replace("bed = { law = \"elastic\", stiffness = \"36 N/mm3\"", &bed),
            WALL.replace("[load]", &changed),
        ] {
            let planar = case(&text.replace("\"shear\"", "\"planar\""));
            let (_, joints, laws) = laws(&planar);
            assert!(laws.iter().all(|l| l.rubs().is_none_or(|f| f.sticks() && f.static_ == 0.6)));
            let name = format!("{law:?}");
            assert!(joints.iter().zip(&laws).any(|(j, l)| {
                j.kind == JointKind::Base && serde_json::to_string(&l.spring.law).is_ok_and(|found| found == name)
            }));
            // The same wall whose blocks only slide refuses the laws for one direction.
            let shear = case(&text);
            let joints = graph::joints(&lay(&shear).expect("laid"), true);
            match resolve(&shear, &lay(&shear).expect("laid"), &joints) {
                Ok(_) => assert!(["elastic", "none"].contains(&law)),
                Err(Error::Input(e)) => {
                    assert!(["no-tension", "rigid"].contains(&law), "{e}");
                    assert!(e.what.contains("slides in both directions"), "{e}");
                    assert!(e.allowed.is_some_and(|a| a.contains("`model = \"planar\"` every law")));
                }
                Err(e) => panic!("{e}"),
            }
        }
    }
}

#[test]
fn planar_numbers_come_through_changes() {
    let text = WALL.replace("\"shear\"", "\"planar\"").replace("rigidity = 100", "compressive_strength = \"4 MPa\"").replace(
        "[load]",
        "[[joint.change]]\nat = { course = [1] }\nspring = { normal_to_shear = 3, compressive_strength = \"2 MPa\" }\n[load]",
    );
    let (wall, joints, laws) = laws(&case(&text.replace("\"elastic\"", "\"no-tension\"")));
    for (joint, law) in joints.iter().zip(&laws) {
        let first = joint.kind != JointKind::Bed && wall.blocks[joint.a].course == 0;
        let given = if joint.kind.is_upright() { Some(4e6) } else { None };
        let spring = &law.spring;
        let strength = spring.compressive_strength.map(|s| s.si());
        assert_eq!(spring.normal_to_shear, if first { 3.0 } else { 2.4 });
        assert_eq!(strength, if first { Some(2e6) } else { given });
        assert_ne!(spring.law, SpringLaw::None);
    }
}

/// A joint that pulls without limit, or gives back a part of a velocity, cannot crush: it is told where that is written.
#[test]
fn what_cannot_crush_is_refused() {
    let planar = WALL.replace("\"shear\"", "\"planar\"");
    let change = |spring: &str, more: &str| {
        let change = format!("[[joint.change]]\nat = {{ kind = [\"base\"] }}\nspring = {{ {spring} }}\n{more}\n[load]");
        planar.replace("[load]", &change)
    };
    let crushes = "compressive_strength = \"4 MPa\"";
    let bond = "bond = { tensile_strength = \"0.1 MPa\", cohesion = \"0.1 MPa\" }";
    let pulls = "pulls without limit, and cannot crush";
    let gives = "gives back what its springs store";
    let rigid = format!("law = \"rigid\", {crushes}");
    for (text, refused) in [
        (planar.replace("36 N/mm3\"", &format!("36 N/mm3\", {crushes}")), Some(("joint.bed", pulls))),
        (change(crushes, ""), Some(("joint.change[0].spring", pulls))),
        (change(crushes, bond), None),
        (change(&rigid, ""), None),
        (change(&format!("{rigid}, restitution = 0.1"), ""), Some(("joint.change[0].spring", gives))),
        (change(&format!("{rigid}, rocking_restitution = 0.9"), ""), Some(("joint.change[0].spring", gives))),
    ] {
        let case = case(&text);
        let wall = lay(&case).expect("laid");
        match (resolve(&case, &wall, &graph::joints(&wall, true)), refused) {
            (Ok(_), None) => {}
            (Err(Error::Input(e)), Some((key, what))) => {
                assert_eq!(e.key.as_deref(), Some(key), "{e}");
                assert!(
                    e.what.contains(what) && e.allowed.is_some_and(|a| a.contains("compressive_strength")),
                    "{text}"
                );
            }
            (found, _) => panic!("{text}: {:?}", found.err()),
        }
    }
}
