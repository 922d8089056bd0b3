//! From a wall file to all of its mechanisms.

use concio::case::{Syntax, from_str};
use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::{Kind, Survey, survey};
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
    assert_eq!(arches.len(), 2);
}
