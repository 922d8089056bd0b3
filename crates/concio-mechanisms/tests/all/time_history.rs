//! A mechanism that is shaken is the one that the survey found.

use concio::case::{Syntax, from_str};
use concio_mechanisms::rocking::{Back, Linkage, Mechanism, Restitution, Rocking, Setting, Shaking};
use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::{Found, Kind, survey};
use concio_mechanisms::time_history::TimeHistory;
use concio_mechanisms::wall::Wall;

const FACADE: &str = include_str!("../../../../examples/limit/facade.toml");

fn wall(text: &str) -> Wall {
    let file = from_str(text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    let findings = file.findings();
    assert!(findings.is_empty(), "{findings:?}");
    concio::facade::of(&file.case).unwrap_or_else(|e| panic!("{e}"))
}

/// Ties as α0 counts them.
fn at_full_force(mechanism: &Mechanism) -> Mechanism {
    let mut mechanism = mechanism.clone();
    for tie in &mut mechanism.ties {
        (tie.pretension, tie.slack) = (tie.yield_force.expect("a force"), 0.0);
    }
    // Ties that pull at rest would turn a storey inwards.
    if let (Back::Free { inwards: Linkage::Two { .. }, .. }, false) = (&mechanism.back, mechanism.ties.is_empty()) {
        mechanism.back = Back::SideWalls(Restitution::Given(0.5));
    }
    mechanism
}

/// α0, α(θ) of weights and thrusts, and d0 of what rocks are those of the survey; how many mechanisms were compared.
fn held_against(wall: &Wall, kind: Kind) -> usize {
    let survey = survey(wall, Overlaps::Summed);
    let of_kind: Vec<&Found> = survey.found.iter().filter(|f| f.kind == kind).collect();
    for found in &of_kind {
        let made = TimeHistory::of(wall, found, None).unwrap_or_else(|e| panic!("{kind:?} at {}: {e}", found.hinge));
        let rocking = Rocking::new(&at_full_force(&made.mechanism))
            .unwrap_or_else(|e| panic!("{kind:?} at {}: {e}", found.hinge));
        let close = |what: &str, found_here: f64, expected: f64| {
            let place = found.hinge;
            assert!(
                (found_here - expected).abs() <= 1e-9 * expected.abs().max(1e-3),
                "{what} of {kind:?} at {place}: {found_here} instead of {expected}"
            );
        };
        close("α0", rocking.multiplier(), found.multiplier());
        let last = found.pushover.last_turn;
        for part in [0.0, 0.1, 0.4, 0.9] {
            let turn = part * last;
            let sure = found.pushover.kinematics.sure(turn).expect("within reach");
            close("α(θ)", rocking.multiplier_at(turn), sure);
        }
        let d0 = rocking.d0().expect("weights that do not hold for ever");
        close("θ0", d0.rotation, last);
        close("d0", d0.displacement, found.pushover.kinematics.control(last));
        let own = Rocking::new(&made.mechanism).unwrap_or_else(|e| panic!("{e}"));
        assert!(own.multiplier() <= rocking.multiplier() * (1.0 + 1e-12));
    }
    of_kind.len()
}

#[test]
fn the_facade_rocks_as_the_survey_has_it_at_every_hinge() {
    let wall = wall(FACADE);
    assert_eq!(held_against(&wall, Kind::Overturning), 24);
    assert_eq!(held_against(&wall, Kind::WithSideWalls), 24);
}

#[test]
fn so_do_arches_and_what_overturns_where_their_support_gives_way() {
    let held = FACADE.replace("z = \"3 m\"\n", "z = \"3 m\"\nholds = true\nconnection = \"0.2 kN/m\"\n");
    let held = held.replace("z = \"6 m\"\n", "z = \"6 m\"\nholds = true\nconnection = \"0.2 kN/m\"\n");
    assert!(held.matches("holds = true").count() == 2);
    let wall = wall(&held);
    // Both storeys, and both as one past the lower floor.
    assert_eq!(held_against(&wall, Kind::VerticalArch), 3);
    assert!(held_against(&wall, Kind::WithSideWalls) > 0, "a support that gives way");
    // A floor inside of the storey, and one that clamps: from the base, and from the bed joint of the tie.
    let inside = FACADE.replace("z = \"6 m\"\n", "z = \"6 m\"\nholds = true\nclamps = true\n");
    assert_eq!(held_against(&self::wall(&inside), Kind::VerticalArch), 2);
}

#[test]
fn so_do_leaves_gables_and_walls_that_nothing_stands_behind() {
    let alone: String = FACADE.split("[[out_of_plane.side_wall]]").next().expect("a head").into();
    let tail = "\n[motion]\nduration = 1\n";
    let leaves = FACADE
        .replace("outside = \"front\"", "outside = \"front\"\nleaves = [\"0.2 m\", \"0.3 m\"]\nleaves_tied = false");
    assert!(held_against(&wall(&leaves), Kind::Leaf) > 10);
    let bare = alone.clone() + tail;
    assert_eq!(held_against(&wall(&bare), Kind::Overturning), 24);
    let gable = alone
        + "[out_of_plane.gable]\nbase = \"6 m\"\nheight = \"2 m\"\nridge_load = \"3 kN\"\nridge_thrust = \"0.1 kN\"\n"
        + tail;
    assert_eq!(held_against(&wall(&gable), Kind::Gable), 1);
    let free = wall(&bare);
    let found = survey(&free, Overlaps::Summed);
    let made = TimeHistory::of(&free, &found.found[0], Some(0.5)).expect("a mechanism");
    assert!(matches!(made.mechanism.back, Back::Free { restitution: Some(0.5), .. }));
}

/// What has no time history says why; a hinge aloft, a tie and what stands behind are told.
#[test]
fn what_is_assumed_and_what_cannot_be_is_told() {
    let wall = wall(FACADE);
    let survey = survey(&wall, Overlaps::Summed);
    let of = |kind: Kind| survey.found.iter().find(|f| f.kind == kind).expect("a mechanism");
    for kind in [Kind::Corner, Kind::Flap] {
        assert!(TimeHistory::of(&wall, of(kind), None).unwrap_err().contains("hinge"));
    }
    let base = TimeHistory::of(&wall, of(Kind::WithSideWalls), Some(0.3)).expect("a time history");
    assert_eq!(base.mechanism.back, Back::SideWalls(Restitution::Given(0.3)));
    let told = base.notes.join("\n");
    assert!(
        told.contains("side walls stop it") && told.contains("sets off below α0") && !told.contains("above the ground"),
        "{told}"
    );
    let aloft = survey.found.iter().find(|f| f.kind == Kind::WithSideWalls && f.hinge > 2.0).expect("a mechanism");
    let told = TimeHistory::of(&wall, aloft, None).expect("a time history").notes.join("\n");
    assert!(told.contains("above the ground"), "{told}");
}

/// Inertia by hand: a wall without openings is a rectangle, I = W (h² + t²)/(12 g), and a quarter higher up rocks alone.
#[test]
fn inertia_is_that_of_a_rectangle() {
    let text = "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 12\nbricks = 5\n\
                brick = { length = 1.0, height = 0.5, thickness = 0.5, specific_weight = 18e3 }\n\
                [joint]\nbed = { law = \"rigid\" }\nhead = { law = \"rigid\" }\n\
                friction = { law = \"coulomb\", static = 0.6 }\n[motion]\nduration = 1.0\n";
    let wall = wall(text);
    let survey = survey(&wall, Overlaps::Summed);
    let motion = concio::ground::GroundMotion::sampled(0.25, &[0.0, 2.0, -2.0, 0.0]).expect("a motion");
    for found in survey.found.iter().filter(|f| f.kind == Kind::Overturning) {
        let made = TimeHistory::of(&wall, found, None).expect("a time history");
        let height = 6.0 - found.hinge;
        let weight = 18e3 * 0.5 * 5.0 * height;
        let part = made.mechanism.parts[0];
        assert!((part.weight - weight).abs() < 1e-6 * weight);
        let expected = weight / concio_mechanisms::G * (height * height + 0.25) / 12.0;
        assert!((part.inertia - expected).abs() < 1e-12 * expected, "{} instead of {expected}", part.inertia);
        // It answers a motion as the wall of the same measures does that is made without a file.
        let [rocking, by_hand] = [
            Rocking::new(&made.mechanism),
            Rocking::new(&Mechanism::wall(
                0.5,
                height,
                5.0,
                18e3,
                Back::Free {
                    inwards: concio_mechanisms::rocking::Linkage::One { hinge: [0.5, 0.0] },
                    restitution: None,
                },
            )),
        ]
        .map(|r| r.expect("a wall that stands"));
        let shaking = Shaking::across(&motion, concio_mechanisms::rocking::Positive::Inwards);
        let [a, b] = [&rocking, &by_hand].map(|r| r.repeat(&shaking, &Setting::default()).expect("a run"));
        assert_eq!(a.verdict, b.verdict);
        assert!((a.response.peak.rotation - b.response.peak.rotation).abs() < 1e-9, "{}", found.hinge);
    }
}
