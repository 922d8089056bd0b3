//! From a wall file to all of its mechanisms.

use concio::case::{Syntax, from_str};
use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::{Found, Kind, Survey, survey};
use concio_mechanisms::wall::Wall;
use concio_verified::agrees;

const FACADE: &str = include_str!("../../../../examples/limit/facade.toml");

fn wall(text: &str) -> Wall {
    let file = from_str(text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    let findings = file.findings();
    assert!(findings.is_empty(), "{findings:?}");
    concio::facade::of(&file.case).unwrap_or_else(|e| panic!("{e}"))
}

fn all(wall: &Wall) -> Survey {
    survey(wall, Overlaps::Summed)
}

/// The wall of S4 in courses of 0.2 m, as a file.
fn with_openings(more: &str) -> String {
    format!(
        "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 20\nbricks = 60\n\
         brick = {{ length = 0.1, height = 0.2, thickness = 0.45, specific_weight = 18e3 }}\n\
         opening = [{{ x = 2.4, y = 0, width = 1.2, height = 2.2, lintel = {{ height = 0.2, bearing = 0.1 }} }}, {{ x = 0.7, y = 1, width = 1, height = 1.2, lintel = {{ height = 0.2, bearing = 0.1 }} }}, \
         {{ x = 4.3, y = 1, width = 1, height = 1.2, lintel = {{ height = 0.2, bearing = 0.1 }} }}]\n\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n{more}\n[motion]\nduration = 1\n"
    )
}

#[test]
fn openings_of_a_file_are_those_of_the_formula() {
    let wall = wall(&with_openings(""));
    let own = wall.masonry.above(0.0);
    let against = "an independent program, twice";
    agrees!("Mechanisms: S4 from a wall file, area", against, "m²", own.weight / (18e3 * 0.45), 18.96, 1e-9);
    let survey = all(&wall);
    let base = survey.found.iter().find(|f| f.kind == Kind::Overturning && f.hinge == 0.0).expect("a mechanism");
    agrees!("Mechanisms: S4 from a wall file, α0", against, "", base.multiplier(), 0.1034031, 1e-5);
    // Every bed joint is a hinge: nothing bridges the openings.
    assert_eq!(wall.levels.len(), 20);
    assert!(wall.assumed.iter().any(|a| a.key == "out_of_plane"));
}

#[test]
fn mortar_counts_with_the_course_on_it() {
    let text = with_openings("")
        .replace("specific_weight = 18e3 }", "specific_weight = 18e3 }\nmortar = { bed = 0.02, head = 0 }");
    let text = text.replace("opening = [", "other = [");
    let text: String = text.lines().filter(|l| !l.starts_with("other")).map(|l| format!("{l}\n")).collect();
    let wall = wall(&text);
    assert!((wall.top - 4.4).abs() < 1e-9 && (wall.masonry.above(0.0).weight - 18e3 * 0.45 * 6.0 * 4.4).abs() < 1.0);
    assert!((wall.levels[1] - 0.22).abs() < 1e-9);
    assert!(wall.assumed.iter().any(|a| a.key == "panel.mortar"));
}

#[test]
fn the_facade_has_every_kind_that_it_can_have() {
    let wall = wall(FACADE);
    let survey = all(&wall);
    let has = |kind: Kind| survey.found.iter().any(|f| f.kind == kind);
    for kind in [Kind::Overturning, Kind::WithSideWalls, Kind::Corner, Kind::Flap] {
        assert!(has(kind), "{kind:?}: {:?}", survey.without);
    }
    for kind in [Kind::Leaf, Kind::VerticalArch, Kind::HorizontalArch, Kind::Gable] {
        assert!(!has(kind) && survey.without.iter().any(|(without, _)| *without == kind), "{kind:?}");
    }
    for found in &survey.found {
        assert!(found.multiplier().is_finite() && found.pushover.participation <= 1.0 + 1e-12);
        if let Some(s) = found.shares {
            let sum = s.wall + s.loads + s.thrusts + s.ties + s.friction + s.presses;
            assert!((sum - found.multiplier()).abs() < 1e-9);
        }
    }
    // The tie moves the governing hinge above it.
    let least = survey.least().expect("a mechanism");
    assert!(least.counts && least.hinge >= 2.5, "{}", least.hinge);
    assert!(survey.worst().is_some());
}

#[test]
fn leaves_gable_and_strip_have_their_own_mechanisms() {
    let more = "[out_of_plane]\nleaves = [0.2, 0.25]\n[out_of_plane.gable]\nheight = 2\nridge_load = 1e4\nridge_push = 3e4\n\
                [out_of_plane.strip]\nfrom = 3\nthrust = 2e4\nfriction = 0.4\n\
                [[out_of_plane.floor]]\nz = 2.4\nload = 1e4\nholds = true\n[[out_of_plane.floor]]\nz = 4\nload = 5e3\nholds = true\nclamps = true";
    let wall = wall(&with_openings(more));
    let survey = all(&wall);
    for kind in [Kind::Leaf, Kind::Gable, Kind::GableFlaps, Kind::HorizontalArch, Kind::VerticalArch] {
        let found: Vec<_> = survey.found.iter().filter(|f| f.kind == kind).collect();
        assert!(!found.is_empty(), "{kind:?}: {:?}", survey.without);
    }
    // The leaf of 0.2 m falls alone.
    let leaf = survey.found.iter().find(|f| f.kind == Kind::Leaf).expect("a leaf");
    assert!((leaf.multiplier() - 0.1 / 2.175949).abs() < 1e-5, "{}", leaf.multiplier());
    let strip = survey.found.iter().find(|f| f.kind == Kind::HorizontalArch).expect("a strip");
    // 8 H t/(w L²) + μ (1 + N/W): of the gable and the floor at the top press.
    let weight = 18e3 * 0.45;
    let pressed = (5e3 * 6.0 + weight * 6.0 + 1e4) / 6.0;
    let expected = 8.0 * 2e4 * 0.45 / (weight * 36.0) + 0.4 * (1.0 + pressed / weight);
    assert!((strip.multiplier() - expected).abs() < 1e-9, "{} instead of {expected}", strip.multiplier());
    let arches: Vec<_> = survey.found.iter().filter(|f| f.kind == Kind::VerticalArch).collect();
    // Joints of this file do not rub: the course of the lower floor slides, and both storeys bend as one too.
    assert_eq!(arches.len(), 3);
}

fn least(survey: &Survey, kind: Kind) -> &concio_mechanisms::survey::Found {
    let own = survey.found.iter().filter(|f| f.kind == kind);
    own.min_by(|a, b| a.multiplier().total_cmp(&b.multiplier()))
        .unwrap_or_else(|| panic!("{kind:?}: {:?}", survey.without))
}

/// A wall of one stone a course: t 0.5, L 4, 18 kN/m³, 12 courses of 0.5 m.
fn plain(more: &str) -> Wall {
    wall(&format!(
        "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 12\nbricks = 1\n\
         brick = {{ length = 4.0, height = 0.5, thickness = 0.5, specific_weight = 18e3 }}\nmortar = {{ bed = 0, head = 0 }}\n\
         [joint]\nbed = {{ law = \"no-tension\", stiffness = \"1 N/mm3\" }}\nhead = {{ law = \"no-tension\", stiffness = \"1 N/mm3\" }}\n\
         friction = {{ law = \"coulomb\", static = 0.6 }}\n{more}\n[motion]\nduration = 1\n"
    ))
}

/// What keeps a kind away is told as it is: a floor that holds the top, not side walls that stand too near.
#[test]
fn a_floor_that_holds_the_top_is_the_reason() {
    let floor = "[[out_of_plane.floor]]\nz = 6\nload = 20e3\nholds = true\n";
    let side = |x: f64| {
        format!("[[out_of_plane.side_wall]]\nx = {x:?}\nthickness = 0.4\ncourse_height = 0.25\noverlap = 0.2\n")
    };
    for sides in [String::new(), side(0.2) + &side(3.8)] {
        let survey = all(&plain(&format!("{floor}{sides}")));
        let mut kinds = vec![Kind::Overturning, Kind::Flap];
        if !sides.is_empty() {
            kinds.extend([Kind::WithSideWalls, Kind::Corner]);
        }
        for kind in kinds {
            let why = survey.without.iter().find(|(k, _)| *k == kind).map(|(_, why)| why.as_str());
            assert_eq!(why, Some("a floor holds the wall at 6.00 m, its top"), "{kind:?}");
        }
    }
    // Beside side walls alone it is they.
    let survey = all(&plain(&(side(0.2) + &side(3.8))));
    let flap = survey.without.iter().find(|(k, _)| *k == Kind::Flap);
    assert!(flap.is_none_or(|(_, why)| why.contains("side walls are too near")), "{flap:?}");
}

/// (OP5) with a floor on the wedge: α0 of the body by hand at the slope that was found.
#[test]
fn floors_and_ties_on_a_corner_count() {
    let side =
        "[[out_of_plane.side_wall]]\nx = 0.2\nthickness = 0.4\ncourse_height = 0.5\noverlap = 0.4\nfriction = 0.5\n";
    let floor =
        "[[out_of_plane.floor]]\nz = 6\nload = 10e3\nat = 0.2\npush = 2e3\nthrust = 500.0\nseat_friction = 0.1\n";
    let tie = "[[out_of_plane.anchor]]\nz = 5\nx = 0.3\nyield_force = 3e3\n";
    let of = |more: &str| {
        let survey = all(&plain(more));
        let base = survey.found.iter().find(|f| f.kind == Kind::Corner && f.hinge == 0.0);
        base.unwrap_or_else(|| panic!("{:?}", survey.without)).clone()
    };
    let bare = of(side);
    let laden = of(&format!("{side}{floor}{tie}"));
    let note = format!("without the floors and ties on its wedge α0 is {:.4}", bare.multiplier());
    assert!(laden.notes[0].ends_with(&note), "{} {note}", laden.notes[0]);
    // By hand: the bare wedge of this slope, and what lies on it. cos φ = sin φ = √½.
    let half = 0.5f64.sqrt();
    let concio_mechanisms::pushover::Kinematics::Body(body, _) = &laden.pushover.kinematics else { panic!("one body") };
    let wedge = body.weights[0];
    let reach = 6.0 * laden.slopes[0];
    let part = reach / 4.0;
    let [load, push, thrust, rubs] = [4e4, 8e3, 2e3, 4e3].map(|f| part * f);
    let depth = half * (0.5 * reach + 0.2);
    // Both textures: courses of 0.5 m, overlaps of a whole stone and of 0.4 m.
    let of_texture = |thickness: f64, overlap: f64, friction: f64| concio_mechanisms::side_wall::SideWall {
        thickness,
        specific_weight: 18e3,
        course: 0.5,
        overlap,
        friction,
        load: 0.0,
        opening: None,
    };
    let held = [(of_texture(0.5, 4.0, 0.6), 0), (of_texture(0.4, 0.4, 0.5), 1)];
    let held: f64 = held.iter().map(|(w, i)| w.kept(laden.slopes[*i]) * w.friction_moment(6.0, Overlaps::Summed)).sum();
    let resists = held + wedge.carried * wedge.depth + load * depth + 6.0 * (rubs - half * thrust) + half * 3e3 * 5.0;
    let expected = resists / (wedge.carried * wedge.height + 6.0 * (load + push));
    agrees!(
        "Mechanisms: corner with floor and tie",
        "balance of moments by hand",
        "",
        laden.multiplier(),
        expected,
        1e-9
    );
    assert!(laden.slopes[0] <= 4.0 / 6.0 * (1.0 + 1e-9), "no crack leaves the wall: {:?}", laden.slopes);
    assert!(reach * 5.0 / 6.0 > 0.3, "the tie lies on the wedge: {reach}");
}

/// (OP2) at all hinges of an arch: the lever between them is thinner by both setbacks, N keeps its place.
#[test]
fn arches_and_gables_are_set_back() {
    let floor = "[[out_of_plane.floor]]\nz = 6\nload = 30e3\nat = 0.25\nholds = true\n";
    let with =
        |more: &str| all(&plain(&format!("[out_of_plane]\nstrength = 2e6\nconfidence_factor = 1.2\n{floor}{more}")));
    let survey = with("");
    let arch = least(&survey, Kind::VerticalArch);
    // W 54, N 30 kN/m; crack on z: a = N/(2 f_h). Moments about both hinges: the upper part's give R, the lower part's α0.
    let at = |z: f64| {
        let [w, n, x] = [54e3, 30e3, z / 6.0];
        let [base, middle] = [(w + n) / 4e6, (n + w * (1.0 - x)) / 4e6];
        // Velocities per unit turn of the lower part: out z at the crack; the upper part turns back by z/(6 − z).
        let back = z / (6.0 - z);
        let lever = 0.5 - base - middle;
        let lower_up = 0.25 - base;
        let crack_up = lever;
        let upper_up = crack_up - (0.25 - (0.5 - middle)) * back;
        let n_up = crack_up - (0.25 - (0.5 - middle)) * back;
        let resists = w * x * lower_up + w * (1.0 - x) * upper_up + n * n_up;
        resists / (w * x * 0.5 * z + w * (1.0 - x) * 0.5 * z)
    };
    let expected = (1..12).map(|i| at(0.5 * f64::from(i))).fold(f64::INFINITY, f64::min);
    agrees!(
        "Mechanisms: vertical arch set back by crushing",
        "virtual work by hand",
        "",
        arch.multiplier(),
        expected,
        1e-9
    );
    assert!((arch.setback - 84e3 / 4e6).abs() < 1e-12 && arch.confidence == 1.2);
    let gable = "[out_of_plane.gable]\nheight = 3\nridge_load = 6e3\nridge_at = 0.2\n";
    let survey = with(gable);
    let whole = least(&survey, Kind::Gable);
    let (w, a) = (18e3 * 0.5 * 6.0, (18e3 * 0.5 * 6.0 + 6e3) / (2.0 * 2e6 * 4.0));
    let expected = (w * (0.25 - a) + 6e3 * (0.2 - a)) / (w + 6e3 * 3.0);
    agrees!("Mechanisms: gable set back by crushing", "(OP9) with (OP2)", "", whole.multiplier(), expected, 1e-12);
    let survey = with("[out_of_plane.strip]\nfrom = 4\nthrust = 40e3\n");
    // The table of floors stands before: the strip is a table of its own.
    let strip = least(&survey, Kind::HorizontalArch);
    let lever = 0.5 - 2.0 * 40e3 / (2.0 * 2e6 * 2.0);
    let expected = 8.0 * 40e3 * lever / (18e3 * 0.5 * 2.0 * 16.0);
    agrees!(
        "Mechanisms: horizontal arch set back by crushing",
        "(OP7) with (OP2)",
        "",
        strip.multiplier(),
        expected,
        1e-12
    );
}

/// Stronger abutments never make an arch weaker: beyond a setback of t/4 it takes no more of their thrust. There α0 is 8 · f_h h t²/4 · ½/(w L²).
#[test]
fn an_arch_takes_no_more_thrust_than_is_best_for_it() {
    let strip = |thrust: f64, block: &str| -> Found {
        let text = format!(
            "[out_of_plane]\nstrength = 2e6\npressure = \"{block}\"\n[out_of_plane.strip]\nfrom = 4\nthrust = {thrust:?}\n"
        );
        least(&all(&plain(&text)), Kind::HorizontalArch).clone()
    };
    let capped = |found: &Found| found.notes.iter().any(|note| note.contains("the arch takes"));
    // 2a = N/(f_h h), or 4 N/(3 f_h h), with h 2 m, t 0.5 m: best where 2a is 0.25 m.
    for (block, best) in [("rectangular", 1e6), ("triangular", 0.75e6)] {
        let thrusts: Vec<f64> = (1..60).map(|k| 5e4 * f64::from(k)).collect();
        let found: Vec<Found> = thrusts.iter().map(|thrust| strip(*thrust, block)).collect();
        for (pair, thrust) in found.windows(2).zip(&thrusts) {
            let [weaker, stronger] = [&pair[0], &pair[1]].map(Found::multiplier);
            assert!(stronger >= weaker * (1.0 - 1e-12), "{block}, {thrust} N: {weaker} and then {stronger}");
        }
        for (found, thrust) in found.iter().zip(&thrusts) {
            assert_eq!(capped(found), *thrust > best * (1.0 + 1e-9), "{block}, {thrust} N: {:?}", found.notes);
        }
        let most = found.last().map_or(f64::NAN, Found::multiplier);
        let expected = 8.0 * best * 0.25 / (18e3 * 0.5 * 2.0 * 16.0);
        let what = format!("Mechanisms: horizontal arch between strong abutments, {block} pressure");
        agrees!(what, "(OP7) with (OP2) by hand", "", most, expected, 1e-9);
    }
}

/// A parapet above the roof: damage is held against S_eZ(T_0), T_0 = 6.2 λ L √(γ/(E g)), E = 2.4 k_t h_b.
#[test]
fn a_parapet_vibrates_freely() {
    let site =
        "[out_of_plane.site]\ndamage = { ground_acceleration = 1.0, amplification = 2.4, corner_period = 0.4 }\n";
    let floor = "[[out_of_plane.floor]]\nz = 4.5\nload = 10e3\n";
    let spectrum = "[[out_of_plane.floor_spectrum]]\nz = 4.5\nperiods = [0, 1, 2]\naccelerations = [3, 23, 1]\n";
    let wall = plain(&format!("{site}{floor}{spectrum}"));
    let modulus = 2.4 * 1e9 * 0.5;
    assert!((wall.modulus.expect("springs") - modulus).abs() < 1e-3);
    let survey = all(&wall);
    let parapet = survey.found.iter().find(|f| f.kind == Kind::Overturning && f.hinge == 4.5).expect("a parapet");
    let period = 6.2 * (1.5 / 0.5) * 1.5 * (18e3 / (modulus * 9.81f64)).sqrt();
    let demand = parapet.checks.damage.expect("a check").demand;
    agrees!("Mechanisms: damage of a parapet", "S_eZ(T_0) by hand", "m/s²", demand, 3.0 + 20.0 * period, 1e-9);
    assert!(parapet.notes.iter().any(|n| n.contains("T_0 = ")), "{:?}", parapet.notes);
    // Below the roof it is no parapet, and a_Z counts.
    let below = survey.found.iter().find(|f| f.kind == Kind::Overturning && f.hinge == 4.0).expect("a mechanism");
    assert!(below.checks.damage.expect("a check").demand < demand);
}

/// One body: α on the plateau is tan(α_s − θ) at Δ2, and half of it at half of Δ1.
#[test]
fn a_trilinear_curve_ends_on_that_of_rigid_blocks() {
    let survey = all(&plain(""));
    let base = survey.found.iter().find(|f| f.kind == Kind::Overturning && f.hinge == 0.0).expect("a mechanism");
    let pushover = &base.pushover;
    let curve = pushover.trilinear([0.1, 0.4]).expect("a curve");
    // The top moves by 6 sin θ, the oscillator by half of that.
    let whole = (0.5f64 / 6.0).atan();
    let end = 0.4 * 3.0 * whole.sin();
    let expected = (whole - (end / 3.0).asin()).tan();
    agrees!("Mechanisms: plateau of a trilinear curve", "tan(α_s − θ)", "", curve.plateau, expected, 1e-9);
    assert!((curve.ends[1] - end).abs() < 1e-12);
    let at = |part: f64| pushover.at_trilinear(&curve, part * 3.0 * whole.sin());
    assert!((at(0.05) - 0.5 * curve.plateau).abs() < 1e-12 && at(0.2) == curve.plateau);
    assert!((at(0.7) - pushover.at(0.7 * pushover.last)).abs() < 1e-12);
}
