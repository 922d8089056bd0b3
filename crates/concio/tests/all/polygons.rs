//! Blocks given by their corners: size, and joints along sloping sides.

use concio::case::{Case, CaseFile, JointKind, Syntax, from_str};
use concio::graph;
use concio::pattern::lay;
use concio::wall::{Block, Joint, Wall};
use concio_verified::agrees;

fn file(blocks: &str, mortar: f64) -> CaseFile {
    let text = format!(
        "model = \"planar\"\n[[panel]]\nbond = \"explicit\"\nmortar = {{ bed = {mortar}, head = {mortar} }}\n\
         brick = {{ length = 0.2, height = 0.1, thickness = 0.25, specific_weight = 20e3 }}\n{blocks}\n\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
         friction = {{ law = \"coulomb\", static = 0.6, dynamic = 0.6 }}\n[motion]\nduration = 1\n"
    );
    from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn case(blocks: &str, mortar: f64) -> Case {
    let file = file(blocks, mortar);
    file.validate().unwrap_or_else(|e| panic!("{e}"));
    file.case
}

fn block(id: &str, corners: &[[f64; 2]]) -> String {
    format!("[[panel.block]]\nid = \"{id}\"\ncourse = 1\ncorners = {corners:?}\n")
}

fn joint<'j>(wall: &Wall, joints: &'j [Joint], name: &str) -> &'j Joint {
    let names: Vec<String> = joints.iter().map(|j| graph::name(wall, j)).collect();
    let e = names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no {name} among {names:?}"));
    &joints[e]
}

fn named<'w>(wall: &'w Wall, name: &str) -> &'w Block {
    wall.blocks.iter().find(|b| b.name == name).expect("a block of that name")
}

/// Two wedges with a block on them: joints at 30° and 60° with the length, the middle and the kind of their lines.
#[test]
fn sloping_sides_are_joints() {
    let (flat, steep) = (30f64.to_radians(), 60f64.to_radians());
    // The right wedge rises by 30°, the left one leans by 60°; both stand on the base and carry one triangle between them.
    let apex = [1.0, 0.2];
    let right = [apex[0] + 0.6 * flat.cos(), apex[1] + 0.6 * flat.sin()];
    let left = [apex[0] - 0.4 * steep.cos(), apex[1] + 0.4 * steep.sin()];
    let blocks = [
        block("left", &[[0.5, 0.0], [1.0, 0.0], apex, left, [0.5, left[1]]]),
        // Clockwise, which is as good.
        block("right", &[right, [right[0], 0.0], [1.0, 0.0], apex]),
        block("wedge", &[apex, right, left]),
    ]
    .concat();
    let wall = lay(&case(&blocks, 0.0)).unwrap_or_else(|e| panic!("{e}"));
    let joints = graph::joints(&wall, false);
    assert_eq!(joints.len(), 5, "{:?}", joints.iter().map(|j| graph::name(&wall, j)).collect::<Vec<_>>());
    let bed = joint(&wall, &joints, "right|wedge");
    assert_eq!(bed.kind, JointKind::Bed);
    assert!((bed.overlap - 0.6).abs() < 1e-12 && (bed.weight - 0.6 / 0.1).abs() < 1e-12);
    let line = [apex[0], apex[1], right[0], right[1]];
    assert!((0..4).all(|k| (bed.line[k] - line[k]).abs() < 1e-12), "{:?}", bed.line);
    let head = joint(&wall, &joints, "left|wedge");
    assert_eq!(head.kind, JointKind::Head);
    assert!((head.overlap - 0.4).abs() < 1e-12 && head.weight == 1.0);
    assert!(head.line[1] < head.line[3] && (head.area(&wall) - 0.1).abs() < 1e-12);
    let upright = joint(&wall, &joints, "left|right");
    assert_eq!((upright.kind, upright.line), (JointKind::Head, [1.0, 0.0, 1.0, 0.2]));
    for (name, length) in [("base|left", 0.5), ("base|right", right[0] - 1.0)] {
        let base = joint(&wall, &joints, name);
        assert!((base.overlap - length).abs() < 1e-12 && base.line[1] == 0.0 && base.kind == JointKind::Base);
    }
    // Mass and inertia of the triangle: ½ a b with a right angle at the apex, and a b (a² + b²)/36 about its centre.
    let wedge = named(&wall, "wedge");
    let (area, polar) = (wedge.area(), wedge.polar_moment());
    agrees!("Walls and loads: right-angled triangle, area", "½ a b", "m²", area, 0.12, abs: 1e-12);
    assert!((wedge.weight() - 20e3 * 0.12 * 0.25).abs() < 1e-9);
    let expected = 0.24 * (0.36 + 0.16) / 36.0;
    agrees!("Walls and loads: right-angled triangle, polar moment", "a b (a² + b²)/36", "m⁴", polar, expected, abs: 1e-12);
    assert!(!wedge.is_rectangle() && wedge.corners().len() == 3);
}

/// Blocks of corners that are level rectangles are the same wall as blocks of sides, joints and all; with mortar the line
/// runs in its middle.
#[test]
fn rectangles_by_corners_are_rectangles() {
    let by_sides = "[[panel.block]]\ncourse = 1\nx = 0\ny = 0.01\nlength = 0.2\nheight = 0.1\n\
                    [[panel.block]]\ncourse = 1\nx = 0.21\ny = 0.01\nlength = 0.2\nheight = 0.1\n\
                    [[panel.block]]\ncourse = 2\nx = 0.1\ny = 0.12\nlength = 0.2\nheight = 0.1\n";
    let by_corners = "[[panel.block]]\ncourse = 1\ncorners = [[0, 0.01], [0.2, 0.01], [0.2, 0.11], [0, 0.11]]\n\
                      [[panel.block]]\ncourse = 1\ncorners = [[\"210 mm\", 0.01], [0.21, 0.11], [0.41000000000000003, 0.11], [0.41000000000000003, 0.01]]\n\
                      [[panel.block]]\ncourse = 2\ncorners = [[0.1, 0.12], [0.30000000000000004, 0.12], [0.30000000000000004, 0.22], [0.1, 0.22]]\n";
    let (a, b) = (lay(&case(by_sides, 0.01)).expect("laid"), lay(&case(by_corners, 0.01)).expect("laid"));
    assert_eq!(a, b);
    assert!(a.blocks.iter().all(Block::is_rectangle));
    // A fourth block far off that is a triangle has the joints of all found by their sides: they are the same.
    let odd =
        format!("{by_sides}[[panel.block]]\nid = \"odd\"\ncourse = 1\ncorners = [[3, 0], [3.2, 0], [3.1, 0.1]]\n");
    let wall = lay(&case(&odd, 0.01)).expect("laid");
    let (plain, found) = (graph::joints(&a, false), graph::joints(&wall, false));
    assert_eq!(found.len(), plain.len() + 1);
    for joint in &plain {
        let name = graph::name(&a, joint);
        let other = found.iter().find(|j| graph::name(&wall, j) == name).unwrap_or_else(|| panic!("no {name}"));
        assert_eq!(other.kind, joint.kind);
        assert!((other.overlap - joint.overlap).abs() < 1e-12 && (other.weight - joint.weight).abs() < 1e-12, "{name}");
        assert!((0..4).all(|k| (other.line[k] - joint.line[k]).abs() < 1e-12), "{:?} {:?}", other.line, joint.line);
    }
}

/// A panel in series is moved as a whole, corners too, and is joined with its neighbour.
#[test]
fn a_panel_of_polygons_in_series() {
    let first = block("a", &[[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.1, 0.3]]);
    let second = "[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\nconnection = 0.02\n\
                  brick = { length = 0.2, height = 0.2, thickness = 0.1, specific_weight = 20e3 }\n";
    let wall = lay(&case(&format!("{first}{second}"), 0.0)).expect("laid");
    let joints = graph::joints(&wall, true);
    let connection = joints.iter().find(|j| j.kind == JointKind::Connection).expect("a connection");
    assert!((0..4).all(|k| (connection.line[k] - [0.41, 0.0, 0.41, 0.2][k]).abs() < 1e-12), "{:?}", connection.line);
    assert!((connection.area(&wall) - 0.2 * 0.1).abs() < 1e-12);
    let top = joints.iter().find(|j| j.kind == JointKind::Top && j.a == 0).expect("a top");
    assert!((top.overlap - 0.3).abs() < 1e-12);
    let moved = "[[panel]]\nbond = \"explicit\"\nconnection = 0.02\n\
                 brick = { length = 0.2, height = 0.2, thickness = 0.1, specific_weight = 20e3 }\n";
    let square = "[[panel.block]]\ncourse = 1\nx = 0\ny = 0\nlength = 0.5\nheight = 0.3\n";
    let wall = lay(&case(&format!("{square}{moved}{first}"), 0.0)).expect("laid");
    assert!((named(&wall, "a").corners()[0][0] - 0.52).abs() < 1e-12 && (named(&wall, "a").x[1] - 0.92).abs() < 1e-12);
}

#[test]
fn polygons_that_cannot_be() {
    let refused = |blocks: &str| {
        let file = file(blocks, 0.0);
        match file.validate().and_then(|()| concio::pattern::lay(&file.case).map(|_| ()).map_err(|e| file.locate(e))) {
            Err(concio::Error::Input(e)) => format!("{}: {}", e.key.clone().unwrap_or_default(), e),
            other => panic!("{other:?}"),
        }
    };
    let a = block("a", &[[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.1, 0.3]]);
    let through = refused(&format!("{a}{}", block("b", &[[0.35, 0.0], [0.7, 0.0], [0.6, 0.3]])));
    assert!(through.contains("panel[0].block[1]") && through.contains("blocks a and b overlap"), "{through}");
    let hanging = refused(&format!("{a}{}", block("b", &[[0.5, 0.1], [0.7, 0.1], [0.6, 0.3]])));
    assert!(hanging.contains("panel[0].block[1]") && hanging.contains("no joint that leads to the base"), "{hanging}");
}

fn arch(rise: f64, voussoirs: usize, more: &str) -> Wall {
    let text = format!(
        "model = \"planar\"\n[[panel]]\nbond = \"arch\"\narch = {{ span = 2.0, rise = {rise}, thickness = 0.3, voussoirs = {voussoirs}{more} }}\n\
         brick = {{ length = 0.3, height = 0.2, thickness = 0.5, specific_weight = 20e3 }}\n\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
         friction = {{ law = \"coulomb\", static = 0.6, dynamic = 0.6 }}\n[motion]\nduration = 1\n"
    );
    let file = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
    file.validate().unwrap_or_else(|e| panic!("{e}"));
    concio::pattern::lay(&file.case).unwrap_or_else(|e| panic!("{e}"))
}

/// A ring of chords between the radii R and R + t over the angle 2 α has the area ½ n sin(2 α/n) ((R + t)² − R²).
#[test]
fn arches_have_the_area_of_their_ring() {
    for (rise, n) in [(1.0f64, 4usize), (1.0, 15), (0.5, 7), (0.2, 20)] {
        let wall = arch(rise, n, "");
        let radius = 0.5 * (1.0 + rise * rise) / rise;
        let alpha = (1.0 / radius).asin();
        let ring = 0.5 * n as f64 * (2.0 * alpha / n as f64).sin() * ((radius + 0.3).powi(2) - radius * radius);
        // What fills up a springer of a segment: the triangle between its radial and its level bed.
        let fill = 0.3 * alpha.sin() * 0.3 * alpha.cos();
        let area: f64 = wall.blocks.iter().map(Block::area).sum();
        let subject = format!("Walls and loads: area of an arch; {n} voussoirs, rise {rise} m");
        agrees!(
            subject,
            "½ n sin(2α/n) ((R + t)² − R²) and what fills up its springers",
            "m²",
            area,
            ring + fill,
            1e-12
        );
        let springer = if rise == 1.0 { 4 } else { 5 };
        let corners: Vec<usize> = wall.blocks.iter().map(|b| b.corners().len()).collect();
        assert_eq!((corners[0], corners[n - 1]), (springer, springer));
        assert!(corners[1..n - 1].iter().all(|c| *c == 4));
        assert_eq!((wall.blocks[0].name.as_str(), wall.blocks[n - 1].name.as_str()), ("p1c1b1", &*format!("p1c1b{n}")));
        // The clear span lies between the springers, the crown of the intrados at the rise where a joint is there.
        let (left, right) = (&wall.blocks[0], &wall.blocks[n - 1]);
        assert!((left.x[0]).abs() < 1e-12 && (right.x[1] - (2.0 + 0.6 * alpha.sin())).abs() < 1e-12);
        if n % 2 == 0 {
            let crown = wall.blocks[n / 2].corners()[0];
            assert!((crown[0] - 0.5 * right.x[1]).abs() < 1e-12 && (crown[1] - rise).abs() < 1e-12, "{crown:?}");
        }
    }
}

/// Two beds on the base, and one joint as long as the ring is thick between each two voussoirs: bed joints near the
/// springing, head joints near the crown.
#[test]
fn voussoirs_are_joined_along_radii() {
    for (rise, more, level) in [(1.0f64, "", 0.0), (0.4, "", 0.0), (1.0, ", springing = 1.5", 1.5)] {
        let wall = arch(rise, 15, more);
        let joints = graph::joints(&wall, false);
        assert_eq!(joints.len(), 16);
        let alpha = (1.0 / (0.5 * (1.0 + rise * rise) / rise)).asin();
        for name in ["base|p1c1b1", "base|p1c1b15"] {
            let base = joint(&wall, &joints, name);
            assert!((base.overlap - 0.3 * alpha.sin()).abs() < 1e-12 && base.line[1] == level && base.line[3] == level);
        }
        for k in 1..15 {
            let pair = [format!("p1c1b{k}|p1c1b{}", k + 1), format!("p1c1b{}|p1c1b{k}", k + 1)];
            let found = joints.iter().find(|j| pair.contains(&graph::name(&wall, j))).expect("a radial joint");
            assert!((found.overlap - 0.3).abs() < 1e-12);
            let angle = alpha * (1.0 - 2.0 * k as f64 / 15.0);
            let kind = if angle.abs() >= std::f64::consts::FRAC_PI_4 { JointKind::Bed } else { JointKind::Head };
            assert_eq!(found.kind, kind, "{pair:?}");
            // From the left block to the right one, from the lower to the upper.
            let first = if kind == JointKind::Head || angle > 0.0 { 0 } else { 1 };
            assert_eq!(graph::name(&wall, found), pair[first]);
        }
    }
}
