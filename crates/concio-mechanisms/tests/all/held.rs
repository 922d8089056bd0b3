//! What holds a wall back, pushes it and crushes: cases by hand, whose answers are known.

use concio::case::{Syntax, from_str};
use concio_mechanisms::pushover::Kinematics;
use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::{Found, Kind, Survey, survey};
use concio_verified::agrees;

/// A wall 6 m long and 6 m high in 24 courses, γ = 20 kN/m³, μ = 0.6.
const LENGTH: f64 = 6.0;
const HEIGHT: f64 = 6.0;

fn of(thickness: f64, panel: &str, behind: &str) -> Survey {
    let text = format!(
        "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 24\nbricks = 12\n\
         brick = {{ length = 0.5, height = 0.25, thickness = {thickness}, specific_weight = 20e3 }}\n{panel}\n\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
         friction = {{ law = \"coulomb\", static = 0.6, on = \"all\" }}\n[out_of_plane]\n{behind}\n[motion]\nduration = 1\n"
    );
    let file = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    let wall = concio::facade::of(&file.case).unwrap_or_else(|e| panic!("{e}"));
    survey(&wall, Overlaps::Summed)
}

fn floor(level: f64, keys: &str) -> String {
    let load = if keys.contains("load") { "" } else { "load = 0.0\n" };
    format!("[[out_of_plane.floor]]\nz = {level}\n{load}{keys}\n")
}

fn tie(level: f64, keys: &str) -> String {
    format!("[[out_of_plane.anchor]]\nz = {level}\nx = 3\n{keys}\n")
}

fn counted(survey: &Survey, kind: Kind) -> Option<&Found> {
    let own = survey.found.iter().filter(|f| f.kind == kind && f.counts);
    own.min_by(|a, b| a.multiplier().total_cmp(&b.multiplier()))
}

fn at_hinge(survey: &Survey, kind: Kind, hinge: f64) -> &Found {
    let found = survey.found.iter().find(|f| f.kind == kind && (f.hinge - hinge).abs() < 1e-9);
    found.unwrap_or_else(|| panic!("{kind:?} at {hinge}: {:?}", survey.without))
}

/// α0 of a uniform storey over the bed joints by virtual work: the hinge at b goes out by b, what lies above by (h − z) b/(h − b). Forces
/// outwards at levels, with N at the middle of the top.
fn arch(thickness: f64, load: f64, forces: &[[f64; 2]]) -> f64 {
    let weight = 20e3 * thickness * LENGTH * HEIGHT;
    let one = |b: f64| {
        let other = b / (HEIGHT - b);
        let out = |z: f64| if z <= b { z } else { (HEIGHT - z) * other };
        let (below, above) = (weight * b / HEIGHT, weight * (1.0 - b / HEIGHT));
        // The lower part rises about its outer edge by t/2 per turn, its inner edge by t; the upper turns the other way about the crack.
        let rises = [0.5, 1.0 + 0.5 * other, 1.0 + 0.5 * other].map(|part| part * thickness);
        let resists = below * rises[0] + above * rises[1] + load * rises[2];
        let pushed: f64 = forces.iter().map(|[level, force]| force * out(*level)).sum();
        (resists - pushed) / (0.5 * weight * b)
    };
    (1..24).map(|i| one(0.25 * f64::from(i))).fold(f64::INFINITY, f64::min)
}

/// A tie that bears the reaction makes an arch; one that does not lets the wall overturn.
#[test]
fn a_tie_at_the_top_makes_an_arch() {
    let roof = floor(6.0, "load = 6e3\nat = 0.15");
    let strong = of(0.3, "", &format!("{roof}{}", tie(6.0, "yield_force = 200e3")));
    let found = counted(&strong, Kind::VerticalArch).expect("an arch");
    let (against, what) = ("virtual work by hand", "Mechanisms: arch below a tie");
    agrees!(what, against, "", found.multiplier(), arch(0.3, 36e3, &[]), 1e-12);
    // R = α0 W/2 − [W t/2 + N (t − d)]/h.
    let needed = found.multiplier() * 108e3 - (216e3 * 0.15 + 36e3 * 0.15) / 6.0;
    assert!((found.reaction.and_then(|r| r[0]).expect("R") - needed).abs() < 1e-6);
    // `holds` says the same.
    let held = of(0.3, "", &floor(6.0, "load = 6e3\nat = 0.15\nholds = true\nconnection = 33e3"));
    assert_eq!(counted(&held, Kind::VerticalArch).expect("an arch").multiplier(), found.multiplier());
    let weak = of(0.3, "", &format!("{roof}{}", tie(6.0, "yield_force = 5e3")));
    assert!(counted(&weak, Kind::VerticalArch).is_none());
    let base = at_hinge(&weak, Kind::Overturning, 0.0);
    let expected = (216e3 * 0.15 + 36e3 * 0.15 + 5e3 * 6.0) / (216e3 * 3.0 + 36e3 * 6.0);
    assert!((base.multiplier() - expected).abs() < 1e-12);
}

/// Thrusts inside of a storey push it, floors that are passed hold it, and a thrust at the top adds to R.
#[test]
fn floors_inside_of_a_storey_push_and_hold() {
    let roof = floor(6.0, "load = 30e3\nholds = true\nconnection = 200e3");
    for thrust in [0.0, 3e3, 60e3] {
        let survey = of(0.5, "", &format!("{}{roof}", floor(3.0, &format!("thrust = {thrust:?}"))));
        let found = counted(&survey, Kind::VerticalArch).expect("an arch");
        let expected = arch(0.5, 180e3, &[[3.0, 6.0 * thrust]]);
        agrees!(
            &format!("Mechanisms: arch with a thrust inside; {thrust} N/m"),
            "virtual work by hand",
            "",
            found.multiplier(),
            expected,
            1e-12
        );
        let falls = found.notes.iter().any(|n| n.contains("without an earthquake"));
        assert_eq!(falls, expected <= 0.0, "{thrust}");
    }
    // A floor of 0.1 kN/m that holds is passed: 600 N at 3 m.
    let passed = of(0.5, "", &format!("{}{roof}", floor(3.0, "holds = true\nconnection = 100.0")));
    let found = counted(&passed, Kind::VerticalArch).expect("an arch");
    assert!((found.multiplier() - arch(0.5, 180e3, &[[3.0, -600.0]])).abs() < 1e-12);
    // R = α0 W/2 − W t/2/h, and the thrust of 18 kN comes to the support as well.
    let pushed = |thrust: f64| {
        let survey =
            of(0.5, "", &floor(6.0, &format!("load = 30e3\nholds = true\nconnection = 12.5e3\nthrust = {thrust:?}")));
        let arch = survey.found.iter().find(|f| f.kind == Kind::VerticalArch).expect("an arch").clone();
        (arch.counts, arch.reaction.and_then(|r| r[0]).expect("R"), survey)
    };
    let ((counts, needed, _), (gives_way, with_thrust, survey)) = (pushed(0.0), pushed(3e3));
    assert!(counts && !gives_way && (with_thrust - needed - 18e3).abs() < 1e-6, "{needed} {with_thrust}");
    assert!(counted(&survey, Kind::Overturning).is_some());
}

/// Below a support that gives way every bed joint is a hinge, as without it; what it bears counts as a tie.
#[test]
fn below_a_support_that_gives_way_every_joint_is_a_hinge() {
    let below = floor(3.0, "load = 20e3\nat = 0.1\nthrust = 2e3");
    let held = of(0.5, "", &format!("{below}{}", floor(6.0, "load = 10e3\nholds = true\nconnection = 500.0")));
    let free = of(0.5, "", &format!("{below}{}", floor(6.0, "load = 10e3\nconnection = 500.0")));
    assert_eq!(held.found.iter().filter(|f| f.kind == Kind::Overturning).count(), 24);
    for hinge in (0..24).map(|i| 0.25 * f64::from(i)) {
        let [own, other] = [&held, &free].map(|s| at_hinge(s, Kind::Overturning, hinge).multiplier());
        assert!((own - other).abs() < 1e-12, "{hinge}: {own} {other}");
    }
    let arch = held.found.iter().find(|f| f.kind == Kind::VerticalArch).expect("an arch");
    assert!(!arch.counts && arch.notes.iter().any(|n| n.contains("gives way first")));
}

/// Ties count with what they come to before the wall would fall without them: at 5 m by 5 sin θ0, tan θ0 = t/h.
#[test]
fn ties_count_with_what_they_come_to() {
    let reach = 5.0 * (0.5f64 / 6.0).atan().sin();
    let bare = 0.5 / 6.0;
    for (keys, force) in [
        ("yield_force = 60e3", 60e3),
        ("yield_force = 60e3\nslack = 0.6", 0.0),
        ("yield_force = 60e3\nstiffness = 1e4", 1e4 * reach),
        ("yield_force = 60e3\nstiffness = 8e6\nbreaks_at = 1e-4", 800.0),
        ("yield_force = 60e3\nstiffness = 8e6\nslack = 0.01", 60e3),
    ] {
        let survey = of(0.5, "", &tie(5.0, keys));
        let found = at_hinge(&survey, Kind::Overturning, 0.0);
        let expected = bare + 5.0 * force / (360e3 * 3.0);
        agrees!(
            &format!("Mechanisms: a tie that comes to; {force:.0} N; {}", keys.len()),
            "(OP3) by hand",
            "",
            found.multiplier(),
            expected,
            1e-12
        );
        assert_eq!(
            found.notes.iter().any(|n| n.contains("that much counts")),
            force < 60e3,
            "{keys}: {:?}",
            found.notes
        );
    }
}

/// Over a door the hinge lies on what stands beside it, and where pressure needs more than the wall's depth nothing holds.
#[test]
fn hinges_over_openings_and_under_heavy_loads_are_set_back() {
    let door = "opening = [{ x = 1, y = 0, width = 4, height = 2.25, lintel = { height = 0.25, bearing = 0.5 } }]";
    let survey = of(0.5, door, "strength = 1e6\nconfidence_factor = 1.2");
    let found = at_hinge(&survey, Kind::Overturning, 2.25);
    let weight = 20e3 * 0.5 * 6.0 * 3.75;
    let setback = weight / (2.0 * 1e6 * 2.0);
    agrees!("Mechanisms: setback over a door", "(OP2) on what bears", "m", found.setback, setback, 1e-12);
    assert!((found.multiplier() - (0.25 - setback) / 1.875).abs() < 1e-12);
    // N/(f t L) = 1.2.
    let crushed = of(0.5, "", "strength = 1e5\nconfidence_factor = 1.2");
    let base = at_hinge(&crushed, Kind::Overturning, 0.0);
    assert!(base.multiplier() < 0.0 && base.notes.iter().any(|n| n.contains("crushes under the loads at rest")));
}

/// What lies on a side wall goes with its wedge; one side wall alone does not hold the far end.
#[test]
fn side_walls_take_their_loads_along() {
    let side = |x: f64| {
        format!(
            "[[out_of_plane.side_wall]]\nx = {x}\nthickness = 0.4\nload = 30e3\noverlap = 0.2\nfriction = 0.6\n\
             specific_weight = 20e3\ncourse_height = 0.25\nfirst_opening = 0.3\n"
        )
    };
    let both = of(0.5, "", &(side(0.2) + &side(5.8)));
    let found = at_hinge(&both, Kind::WithSideWalls, 0.0);
    let of_slope = |slope: f64| {
        let (wedge, load) = (0.5 * 20e3 * 0.4 * 36.0 * slope, 30e3 * 6.0 * slope);
        // Course by course from the top: μ l (γ t_s h_b k + q) on the bed joint below the k-th.
        let on_joint = |k: f64| 0.6 * 0.2 * (20e3 * 0.4 * 0.25 * k + 30e3) * (6.0 - 0.25 * k);
        let rubs: f64 = (1..=24).map(|k| on_joint(f64::from(k))).sum();
        let kept = 1.0 - slope / 0.8;
        let rights = 360e3 * 0.25 + 2.0 * (wedge * (0.5 + 2.0 * slope) + load * (0.5 + 3.0 * slope) + kept * rubs);
        rights / (360e3 * 3.0 + 2.0 * (wedge * 4.0 + load * 6.0))
    };
    let least = (0..=1000).map(|i| of_slope(0.05 * f64::from(i) / 1000.0)).fold(f64::INFINITY, f64::min);
    agrees!(
        "Mechanisms: loads on the wedges of side walls",
        "(OP4) with the load, scanned",
        "",
        found.multiplier(),
        least,
        1e-6
    );
    let one = of(0.5, "", &side(0.2));
    assert!(at_hinge(&one, Kind::Overturning, 0.0).counts && !at_hinge(&both, Kind::Overturning, 0.0).counts);
}

/// A floor within the outer leaf stands on it; flaps crack beside an opening too; floors push a strip.
#[test]
fn leaves_flaps_and_strips_take_what_is_theirs() {
    let leaves = "leaves = [0.2, 0.3]\nleaves_tied = false\n";
    let survey = of(0.5, "", &format!("{leaves}{}", floor(6.0, "load = 5e3\nat = 0.1\nthrust = 200.0")));
    let found = at_hinge(&survey, Kind::Leaf, 0.0);
    let (weight, load, thrust) = (20e3 * 0.2 * 36.0, 30e3, 1200.0);
    let expected = (weight * 0.1 + load * 0.1 - thrust * 6.0) / (weight * 3.0 + load * 6.0);
    agrees!("Mechanisms: a floor on the outer leaf", "(OP3) by hand", "", found.multiplier(), expected, 1e-12);
    let window = "opening = [{ x = 1, y = 3, width = 4, height = 1.5, lintel = { height = 0.25, bearing = 0.5 } }]";
    let flap = of(0.5, window, "");
    let flap = counted(&flap, Kind::Flap).expect("a flap");
    let Kinematics::Body(body, _) = &flap.pushover.kinematics else { panic!("one body") };
    assert!(body.weights.iter().all(|w| w.carried >= 0.0));
    let strip = "[out_of_plane.strip]\nfrom = 4.5\nthrust = 60e3\nspan = 4.0\nfriction = 0.5\n";
    let survey = of(0.5, "", &format!("{strip}{}", floor(6.0, "load = 6e3\npush = 5e3\nthrust = 10e3")));
    let found = counted(&survey, Kind::HorizontalArch).expect("a strip");
    // w = 15 kN/m; N = 6, M = 11, h = 10 kN/m.
    let expected = 8.0 * 60.0 * 0.5 / (26.0 * 16.0) + 0.5 * 21.0 / 26.0 - 10.0 / 26.0;
    agrees!("Mechanisms: floors push a strip", "(OP7) with masses by hand", "", found.multiplier(), expected, 1e-12);
}

/// A squat wall slides on its bed joint before it turns, and that is told where its α0 stands.
#[test]
fn sliding_before_turning_is_told() {
    let survey = of(6.0, "", "");
    let found = at_hinge(&survey, Kind::Overturning, 0.0);
    assert!((found.multiplier() - 1.0).abs() < 1e-12);
    assert!(found.notes.iter().any(|n| n.contains("slides at α = 0.6000")), "{:?}", found.notes);
    let slender = of(0.5, "", "");
    assert!(at_hinge(&slender, Kind::Overturning, 0.0).notes.iter().all(|n| !n.contains("slides")));
}

/// A tie in the course of a floor that holds, and gives way, is there once: tie and floor of the same wall without `holds`.
#[test]
fn a_tie_beside_a_floor_that_gives_way_counts_once() {
    for level in [6.0, 5.8] {
        let anchor = tie(level, "yield_force = 10e3\nstiffness = 20e6");
        let held = of(0.5, "", &format!("{}{anchor}", floor(6.0, "load = 6e3\nat = 0.2\nholds = true")));
        let base = at_hinge(&held, Kind::Overturning, 0.0);
        let expected = (360e3 * 0.25 + 36e3 * 0.2 + 10e3 * level) / (360e3 * 3.0 + 36e3 * 6.0);
        let what = format!("Mechanisms: floor that holds by a tie at {level} m and gives way, overturning");
        agrees!(what, "(OP3) with the tie once", "", base.multiplier(), expected, 1e-12);
    }
}

/// Over less than a course of the side wall no overlap is sheared: neither mechanism is pushed by friction.
#[test]
fn side_walls_of_higher_courses_push_nothing() {
    let side = "[[out_of_plane.side_wall]]\nx = 0\nthickness = 0.4\ncourse_height = 0.3\noverlap = 0.2\n";
    let survey = of(0.3, "", side);
    for kind in [Kind::WithSideWalls, Kind::Corner] {
        let top = survey.found.iter().filter(|f| f.kind == kind && f.hinge > 5.5);
        for found in top {
            assert!((0.0..2.0).contains(&found.multiplier()), "{kind:?} at {}: {}", found.hinge, found.multiplier());
        }
    }
    // (OP4) with the upright crack and no friction: the wedge of no width.
    let top = at_hinge(&survey, Kind::WithSideWalls, 5.75);
    assert!(top.multiplier() <= 0.3 / 0.25 + 1e-9, "{}", top.multiplier());
}

/// A corner has the volume of an overlap at least: over one course its crack is the texture's own.
#[test]
fn corners_are_no_slivers() {
    let side = "[[out_of_plane.side_wall]]\nx = 0\nthickness = 0.4\ncourse_height = 0.25\noverlap = 0.2\n";
    let survey = of(0.3, "", side);
    for found in survey.found.iter().filter(|f| f.kind == Kind::Corner) {
        let reach = found.slopes[0] * (HEIGHT - found.hinge);
        assert!(reach >= 0.2 - 1e-9, "at {} it reaches {reach} m into the wall", found.hinge);
    }
    let top = at_hinge(&survey, Kind::Corner, 5.75);
    assert!((top.slopes[1] - 0.8).abs() < 1e-9, "{:?}", top.slopes);
}

/// A flap that a slack or a soft tie passes through has what the tie comes to, not its force.
#[test]
fn ties_of_flaps_count_with_what_they_come_to() {
    let flap = |keys: &str| {
        let survey = of(0.3, "", &tie(5.5, &format!("yield_force = 20e3\n{keys}")));
        counted(&survey, Kind::Flap).expect("a flap").multiplier()
    };
    let bare = counted(&of(0.3, "", ""), Kind::Flap).expect("a flap").multiplier();
    let rigid = flap("");
    assert!(rigid > 1.05 * bare, "{rigid} {bare}");
    let what = "Mechanisms: flap with a tie that is slack by 5 m";
    agrees!(what, "the flap without it", "", flap("stiffness = 20e6\nslack = 5"), bare, 1e-12);
    let soft = flap("stiffness = 20");
    assert!(soft >= bare && soft < bare + 1e-3, "{soft} {bare}");
}

/// A wall 1.5 m long in courses of 0.25 m, γ = 20 kN/m³.
fn narrow(courses: u32, thickness: f64, friction: f64, behind: &str) -> Survey {
    let text = format!(
        "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = {courses}\nbricks = 3\n\
         brick = {{ length = 0.5, height = 0.25, thickness = {thickness}, specific_weight = 20e3 }}\n\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
         friction = {{ law = \"coulomb\", static = {friction} }}\n[out_of_plane]\n{behind}\n[motion]\nduration = 1\n"
    );
    let file = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    let wall = concio::facade::of(&file.case).unwrap_or_else(|e| panic!("{e}"));
    survey(&wall, Overlaps::Summed)
}

/// The lower floor carries the foot of the upper arch and the top of the lower one: both give way, and the wall overturns.
#[test]
fn two_floors_of_known_force_give_way_together() {
    let keys = |load: f64, at: f64| format!("load = {load:?}\nat = {at:?}\nholds = true\nconnection = 3e3");
    let survey = narrow(16, 0.25, 0.8, &(floor(2.0, &keys(13e3, 0.15)) + &floor(4.0, &keys(17e3, 0.2))));
    // (OP3) about the base: W 30, P 19.5 and 25.5, connections of 4.5 kN each.
    let resists = 30e3 * 0.125 + 19.5e3 * 0.15 + 25.5e3 * 0.2 + 4.5e3 * (2.0 + 4.0);
    let expected = resists / (30e3 * 2.0 + 19.5e3 * 2.0 + 25.5e3 * 4.0);
    let found = survey.least().expect("a mechanism");
    assert!(found.kind == Kind::Overturning && found.hinge == 0.0, "{:?} at {}", found.kind, found.hinge);
    let (against, what) = ("(OP3) by hand", "Mechanisms: two floors of 3 kN/m that give way together");
    agrees!(what, against, "", found.multiplier(), expected, 1e-12);
    for told in ["the floor at 2.00 m gives way at 4.50 kN", "the floor at 4.00 m gives way at 4.50 kN"] {
        assert!(found.notes.iter().any(|n| n == told), "{:?}", found.notes);
    }
}

/// (OP6) of the upper storey counts though the lower floor could not bear the top of a storey at its own, higher α0.
#[test]
fn the_arch_of_a_storey_stays_where_that_below_needs_more() {
    let held = |load: f64| format!("load = {load:?}\nat = 0.15\nholds = true");
    let survey = narrow(17, 0.3, 0.6, &(floor(1.0, &held(4e3)) + &floor(4.25, &held(8e3))));
    let found = survey.least().expect("a mechanism");
    // W 29.25 over 3.25 m, N 12 kN in the middle.
    let n = 12.0 / 29.25;
    let at = |x: f64| 2.0 * 0.3 / 3.25 * (1.0 + n * (1.0 + 0.5 * x / (1.0 - x))) / x;
    let expected = (1..13).map(|i| at(f64::from(i) / 13.0)).fold(f64::INFINITY, f64::min);
    let (against, what) = ("(OP6) on the bed joints", "Mechanisms: arch of the upper of two storeys");
    agrees!(what, against, "", found.multiplier(), expected, 1e-12);
    assert!(found.kind == Kind::VerticalArch && found.level > 1.0);
}

/// A storey may stand on a tied level: foot 1.5, hinge 3.25, top 3.75 m, with what is tied at the foot at rest.
#[test]
fn an_arch_may_stand_on_a_tied_level() {
    let behind = floor(1.5, "load = 9249.0\nat = 0.098\nconnection = 4917.0")
        + &floor(3.75, "load = 2085.0\nat = 0.134\nconnection = 4628.0")
        + &tie(1.34, "yield_force = 8692.0").replace("x = 3", "x = 0.75")
        + &tie(1.5, "yield_force = 2613.0").replace("x = 3", "x = 0.75");
    let survey = narrow(15, 0.31, 0.9, &behind);
    let found = survey.least().expect("a mechanism");
    // Over 2.25 m: W 20 · 0.31 · 1.5 · 2.25, N 3.1275 kN at 0.134 m from the outer face.
    let (weight, load, part) = (20.0 * 0.31 * 1.5 * 2.25, 2.085 * 1.5, 1.75 / 2.25);
    let expected = 2.0 / 2.25 / part * (0.31 + load / weight * (0.31 + (0.31 - 0.134) * part / (1.0 - part)));
    let (against, what) = ("(OP6) by hand", "Mechanisms: arch on a tied level");
    agrees!(what, against, "", found.multiplier(), expected, 1e-12);
    assert!(found.kind == Kind::VerticalArch && (found.hinge - 3.25).abs() < 1e-9, "{:?}", found.shape);
}

/// A floor that holds without a force stays where its course slides: that and what lies on it push nothing.
#[test]
fn a_course_that_slides_stays_with_its_floor() {
    let survey = of(0.5, "", &floor(6.0, "load = 1e3\nat = 0.2\nholds = true"));
    let found = counted(&survey, Kind::Overturning).expect("a mechanism");
    // W 345 kN over 5.75 m below the course of 15 kN; μ (15 + 6) kN at 6 m.
    let expected = (360e3 * 0.25 + 6e3 * 0.2 + 0.6 * 21e3 * 6.0) / (345e3 * 2.875);
    let (against, what) = ("virtual work by hand", "Mechanisms: a held course that slides");
    agrees!(what, against, "", found.multiplier(), expected, 1e-12);
    assert!(found.notes.iter().any(|n| n.contains("stays, and its course slides at 12.60 kN")), "{:?}", found.notes);
}

/// What a floor holds of a corner, a flap or a leaf is no more than what the bed joints of its course bear: 0.6 × (15 + 6) kN below the top one.
#[test]
fn a_connection_holds_parts_by_no_more_than_its_course_bears() {
    let side = "[[out_of_plane.side_wall]]\nx = 0\nthickness = 0.4\ncourse_height = 0.25\noverlap = 0.2\n";
    let roof = |own: f64| floor(6.0, &format!("load = 1e3\nat = 0.1\nholds = true\nconnection = {own}"));
    let leaves = "leaves = [0.2, 0.3]\nleaves_tied = false\n";
    for (kind, before, after) in [(Kind::Flap, "", ""), (Kind::Corner, "", side), (Kind::Leaf, leaves, "")] {
        let least = |own: f64| {
            let survey = of(0.5, "", &format!("{before}{}{after}", roof(own)));
            counted(&survey, kind).unwrap_or_else(|| panic!("{kind:?}: {:?}", survey.without)).multiplier()
        };
        let [weak, all, strong] = [1e3, 2.1e3, 1e6].map(least);
        let what = format!("Mechanisms: a strong connection of a course that slides, {kind:?}");
        agrees!(what, "a connection of μ N of its bed joints", "", strong, all, 1e-12);
        assert!(weak < all, "{kind:?}: {weak} {all}");
    }
}

/// A tie counts in full, as if spread. Where the bed joints of its course bear less, that is said: below the top course 0.6 × 18 kN, half way up 0.6 × 450 kN.
#[test]
fn ties_from_which_blocks_slide_are_told() {
    let told = |level: f64, force: f64| {
        let survey = of(0.6, "", &tie(level, &format!("yield_force = {force}")));
        let notes = &at_hinge(&survey, Kind::Overturning, 0.0).notes;
        notes.iter().find(|note| note.contains("bed joints of their course")).cloned()
    };
    let what = told(6.0, 12e3).expect("a note");
    assert!(
        what.starts_with("ties at 6.00 m hold 12.00 kN, and the bed joints of their course bear 10.80 kN"),
        "{what}"
    );
    assert_eq!(told(6.0, 10e3), None);
    assert_eq!(told(3.0, 260e3), None);
    assert!(told(3.0, 280e3).is_some());
}
