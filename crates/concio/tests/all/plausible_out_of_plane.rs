//! Numbers about what acts out of a wall's plane that are allowed but hardly meant.

use concio::case::plausible::doubts;
use concio::case::{Case, Syntax, from_str};

use crate::plausible::{WALL, case};

/// Loads, ties and the site of what stands behind a wall.
#[test]
fn doubtful_numbers_out_of_the_plane_are_told() {
    const BEHIND: &str = r#"
[out_of_plane]
strength = "2.5 MPa"
[[out_of_plane.floor]]
z = 0.12
load = "12 kN/m"
thrust = "0.8 kN/m"
seat_friction = 0.3
[[out_of_plane.anchor]]
z = 0.1
yield_force = "60 kN"
[[out_of_plane.side_wall]]
x = 0.0
thickness = 0.12
load = "8 kN/m"
[out_of_plane.site.life_safety]
ground_acceleration = "0.2 g"
amplification = 2.4
corner_period = "0.4 s"
"#;
    let found = |text: &str| {
        let text = format!("{}{text}", WALL.replace("model = \"shear\"", "model = \"planar\""));
        let file = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
        let mut found = [file.unit_doubts(), doubts(&file.case)].concat();
        found.retain(|doubt| doubt.contains("out_of_plane"));
        found
    };
    assert_eq!(found(BEHIND), [""; 0]);
    for (right, wrong, told) in [
        (
            "strength = \"2.5 MPa\"",
            "strength = 2.5",
            "out_of_plane.strength is 2.5 Pa, less than 250000 Pa; did you mean \"2.5 MPa\"?",
        ),
        (
            "amplification = 2.4",
            "amplification = 0.024",
            "out_of_plane.site.life_safety.amplification is 0.024, less than 1.5; did you mean 2.4?",
        ),
        (
            "amplification = 2.4",
            "soil_factor = 120\namplification = 2.4",
            "out_of_plane.site.life_safety.soil_factor is 120, more than 3; did you mean 1.2?",
        ),
        (
            "corner_period = \"0.4 s\"",
            "corner_period = 480",
            "out_of_plane.site.life_safety.corner_period is 480 s, more than 3 s; did you mean \"0.48 s\"?",
        ),
        (
            "load = \"12 kN/m\"",
            "load = 12",
            "out_of_plane.floor[0].load is 12 N/m, less than 300 N/m; did you mean \"12 kN/m\"?",
        ),
        (
            "thrust = \"0.8 kN/m\"",
            "thrust = 0.8",
            "out_of_plane.floor[0].thrust is 0.8 N/m, less than 10 N/m; did you mean \"0.8 kN/m\"?",
        ),
        (
            "seat_friction = 0.3",
            "seat_friction = 30.0",
            "out_of_plane.floor[0].seat_friction is 30, more than 1; did you mean 0.58, the tangent of 30 degrees?",
        ),
        (
            "yield_force = \"60 kN\"",
            "yield_force = 60",
            "out_of_plane.anchor[0].yield_force is 60 N, less than 200 N; did you mean \"60 kN\"?",
        ),
        (
            "load = \"8 kN/m\"",
            "load = 8",
            "out_of_plane.side_wall[0].load is 8 N/m, less than 300 N/m; did you mean \"8 kN/m\"?",
        ),
        (
            "\"0.2 g\"",
            "0.2",
            "out_of_plane.site.life_safety.ground_acceleration is 0.2 m/s2, a number without a unit; did you mean \"0.2 g\"?",
        ),
        (
            "\"0.2 g\"",
            "20",
            "out_of_plane.site.life_safety.ground_acceleration is 20 m/s2, more than 10 m/s2; did you mean \"20 cm/s2\"?",
        ),
    ] {
        assert_eq!(found(&BEHIND.replacen(right, wrong, 1)), [told], "{wrong}");
    }
}

/// Columns of a spectrum in g, written as bare numbers; what is there twice; hazards that are exchanged.
#[test]
fn spectra_twins_and_exchanged_hazards_are_told() {
    let found = |behind: &str| {
        let text = format!("{}\n[out_of_plane]\n{behind}", WALL.replace("model = \"shear\"", "model = \"planar\""));
        let file = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
        let mut found = [file.unit_doubts(), doubts(&file.case)].concat();
        found.retain(|doubt| doubt.contains("out_of_plane"));
        found
    };
    let site = |state: &str, columns: &str| {
        format!("site = {{ {state} = {{ periods = [0, 0.15, 0.5, 2], accelerations = [{columns}] }} }}")
    };
    for (behind, told) in [
        (
            site("life_safety", "0.3, 0.72, 0.72, 0.18"),
            "out_of_plane.site.life_safety.accelerations go up to 0.72 m/s2, numbers without a unit; did you mean \"0.72 g\", and so each of them?",
        ),
        (
            site("damage", "1, 3, 3, 1"),
            "out_of_plane.site.damage.accelerations go up to 3 m/s2, numbers without a unit; did you mean \"3 g\", and so each of them?",
        ),
        (
            "floor_spectrum = [{ z = 3, periods = [0, 0.5, 2], accelerations = [\"0.5 g\", \"1.2 g\", \"0.3 g\"] }, \
             { z = 6, periods = [0, 0.5, 2], accelerations = [0.5, 1.2, 0.3] }]"
                .into(),
            "out_of_plane.floor_spectrum[1].accelerations go up to 1.2 m/s2, numbers without a unit; did you mean \"1.2 g\", and so each of them?",
        ),
        (
            "floor = [{ z = 0.12, load = 12e3 }, { z = 0.06, load = 12e3 }, { z = \"12 cm\", load = \"12 kN/m\" }]".into(),
            "out_of_plane.floor[2] is the same as out_of_plane.floor[0]: its load counts twice; is one of them left over?",
        ),
        (
            "anchor = [{ z = 0.1, yield_force = 30e3 }, { z = 0.1, yield_force = 30e3 }]".into(),
            "out_of_plane.anchor[1] is the same as out_of_plane.anchor[0]: it holds with twice its force; is one of them left over?",
        ),
        (
            "site = { damage = { ground_acceleration = \"0.3 g\", soil_factor = 1.2, amplification = 2.4, corner_period = 0.5 }, \
             life_safety = { ground_acceleration = \"0.1 g\", soil_factor = 1.2, amplification = 2.4, corner_period = 0.5 } }"
                .into(),
            // 0.3 · 1.2 · 9.81 and 0.1 · 1.2 · 9.81.
            "out_of_plane.site.damage shakes the ground by 3.53 m/s2, more than out_of_plane.site.life_safety by 1.18 m/s2, which is rarer; are they exchanged?",
        ),
        (
            "behaviour_factor = 3".into(),
            "out_of_plane.behaviour_factor is 3, more than 2, the code's for mechanisms out of the plane: the linear check is unsafe by as much",
        ),
        (
            "side_wall = [{ x = 0, thickness = 0.12, specific_weight = 2000 }]".into(),
            "out_of_plane.side_wall[0].specific_weight is 2000 N/m3, less than 3000 N/m3; did you mean \"2000 kg/m3\"?",
        ),
    ] {
        assert_eq!(found(&behind), [told], "{behind}");
    }
    for fine in [
        site("life_safety", "\"0.3 g\", \"0.72 g\", \"0.72 g\", \"0.18 g\""),
        // One unit says that the others are meant.
        site("life_safety", "\"0.3 m/s2\", 0.72, 0.72, 0.18"),
        site("life_safety", "2.9, 7.1, 7.1, 1.8"),
        "floor = [{ z = 0.12, load = 12e3, at = 0.03 }, { z = 0.12, load = 9e3, at = 0.09 }]".into(),
        "anchor = [{ z = 0.1, yield_force = 30e3, x = 0.1 }, { z = 0.1, yield_force = 30e3, x = 0.3 }]".into(),
        "site = { damage = { ground_acceleration = \"0.1 g\", amplification = 2.4, corner_period = 0.5 }, \
         collapse = { ground_acceleration = \"0.3 g\", amplification = 2.4, corner_period = 0.5 } }"
            .into(),
        "behaviour_factor = 2".into(),
        "side_wall = [{ x = 0, thickness = 0.12, specific_weight = \"2000 kg/m3\" }]".into(),
    ] {
        assert_eq!(found(&fine), [""; 0], "{fine}");
    }
}

/// A façade of 6 m by 5 m, half a metre thick, with what a file says beside.
fn facade(behind: &str) -> Case {
    case(&format!(
        "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 12\nbricks = 5\n\
         brick = {{ length = 1.0, height = 0.5, thickness = 0.5, specific_weight = 18e3 }}\n\
         opening = [{{ x = \"2 bricks\", y = 0, width = \"1 bricks\", height = \"4 courses\", lintel = {{ height = 0.5, bearing = 0.5 }} }}]\n\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
         friction = {{ law = \"coulomb\", static = 0.6 }}\n[motion]\nduration = 1.0\n{behind}\n"
    ))
}

/// Slips behind a wall that made a tidy wrong number: a length, a force or a period in another unit, or what stands there twice.
#[test]
fn slips_behind_a_wall_are_told() {
    let floor = |keys: &str| format!("[[out_of_plane.floor]]\n{keys}");
    let tie = |keys: &str| format!("[[out_of_plane.anchor]]\nyield_force = \"20 kN\"\n{keys}");
    let side = |keys: &str| format!("[[out_of_plane.side_wall]]\n{keys}\n");
    let gable = |keys: &str| format!("[out_of_plane.gable]\n{keys}");
    let building = |keys: &str| format!("[out_of_plane.building]\nstoreys = 2\n{keys}");
    for (behind, told) in [
        (
            floor("z = \"6 mm\"\nload = \"8 kN/m\""),
            "floor[0].z is 0.006 m, less than 0.3 m: no floor lies on the lowest course; did you mean \"6 m\"?",
        ),
        (
            tie("z = \"5.8 mm\""),
            "anchor[0].z is 0.0058 m, less than 0.3 m: a tie there holds next to nothing; did you mean \"5.8 m\"?",
        ),
        (
            floor("z = 6\nload = \"8000 kN/m\""),
            "floor[0].load is 8000000 N/m, more than 500000 N/m; did you mean \"8 kN/m\"?",
        ),
        (
            floor("z = 6\nload = \"800 kN/m\""),
            "floor[0].load is 800000 N/m, more than 500000 N/m; did you mean \"0.8 kN/m\"?",
        ),
        (
            floor("z = 6\nload = 0\npush = \"8000 kN/m\""),
            "floor[0].push is 8000000 N/m, more than 500000 N/m; did you mean \"8 kN/m\"?",
        ),
        (
            floor("z = 6\nload = 0\nthrust = \"3000 kN/m\""),
            "floor[0].thrust is 3000000 N/m, more than 500000 N/m; did you mean \"3 kN/m\"?",
        ),
        (
            floor("z = 6\nload = \"8 kN/m\"\nseat_length = 100"),
            "floor[0].seat_length is 100 m, more than 2 m; did you mean \"100 mm\"?",
        ),
        (tie("z = 5.8\nslack = 5"), "anchor[0].slack is 5 m, more than 0.2 m; did you mean \"5 mm\"?"),
        (
            tie("z = 5.8\nbreaks_at = \"0.08 mm\""),
            "anchor[0].breaks_at is 8e-5 m, less than 0.0005 m; did you mean \"80 mm\"?",
        ),
        (tie("z = 5.8\nbreaks_at = 50"), "anchor[0].breaks_at is 50 m, more than 1 m; did you mean \"50 mm\"?"),
        (side("x = 0\nthickness = 400"), "side_wall[0].thickness is 400 m, more than 3 m; did you mean \"400 mm\"?"),
        (side("x = 0\nthickness = 8"), "side_wall[0].thickness is 8 m, more than 3 m; did you mean \"0.8 m\"?"),
        (
            side("x = 0\nthickness = 0.04"),
            "side_wall[0].thickness is 0.04 m, less than 0.05 m; did you mean \"0.4 m\"?",
        ),
        (
            side("x = 0\nthickness = 0.4\noverlap = \"5 m\""),
            "side_wall[0].overlap is 5 m, more than 1 m, the longest block of the wall: blocks overlap by a part of their length; did you mean \"5 cm\"?",
        ),
        (
            side("x = 0\nthickness = 0.4") + &side("x = \"0 m\"\nthickness = \"40 cm\""),
            "side_wall[1] is the same as out_of_plane.side_wall[0]: its weight and its friction count twice; is one of them left over?",
        ),
        (
            side("x = 0\nthickness = 0.4") + &side("x = 0.3\nthickness = 0.4"),
            "side_wall[1] stands in out_of_plane.side_wall[0]: their middles are 0.3 m apart, and half of both is 0.4 m; is one of them left over?",
        ),
        (gable("height = 1.5\nthickness = 40"), "gable.thickness is 40 m, more than 3 m; did you mean \"40 cm\"?"),
        (gable("height = 150"), "gable.height is 150 m, more than 30 m; did you mean \"150 cm\"?"),
        (gable("height = 1.5\nridge_load = 5"), "gable.ridge_load is 5 N, less than 200 N; did you mean \"5 kN\"?"),
        (
            gable("height = 1.5\nridge_load = \"8 MN\""),
            "gable.ridge_load is 8000000 N, more than 1000000 N; did you mean \"8 kN\"?",
        ),
        (
            gable("height = 1.5\nridge_load = 8e3\nridge_thrust = \"-2 kN\""),
            "gable.ridge_thrust is -2000 N: a thrust is positive outwards, and this one holds the wall upright; did you mean 2000 N?",
        ),
        (
            "[out_of_plane]\nstrength = \"200 kPa\"".into(),
            "strength is 200000 Pa, less than 250000 Pa; did you mean \"2 MPa\"?",
        ),
        (
            floor("z = 6\nload = 8e3\nthrust = \"-0.5 kN/m\""),
            "floor[0].thrust is -500 N/m: a thrust is positive outwards, and this one holds the wall upright; did you mean 500 N/m?",
        ),
        (
            floor("z = 6\nload = 0\nseat_friction = 0.3"),
            "floor[0].seat_friction is 0.3 and does nothing: the floor's `load` is 0, and its seat rubs with a part of that; is the load left out?",
        ),
        (
            side("x = 0\nthickness = 0.4\ncorner = { load = 8e3, thrust = -1e3 }"),
            "side_wall[0].corner.thrust is -1000 N: a thrust is positive outwards, and this one holds the wall upright; did you mean 1000 N?",
        ),
        (
            "[out_of_plane.strip]\nfrom = 4\nthrust = 30".into(),
            "strip.thrust is 30 N, less than 200 N; did you mean \"30 kN\"?",
        ),
        (building("height = 8\nperiod = 200"), "building.period is 200 s, more than 5 s; did you mean \"200 ms\"?"),
        (building("height = 800"), "building.height is 800 m, more than 200 m; did you mean \"800 cm\"?"),
        (building("height = 8\nparticipation = 120"), "building.participation is 120, more than 3; did you mean 1.2?"),
    ] {
        assert_eq!(doubts(&facade(&behind)), [format!("out_of_plane.{told}")], "{behind}");
    }
    for fine in [
        floor("z = 0.3\nload = \"200 kN/m\"\npush = \"200 kN/m\"\nthrust = \"20 kN/m\"\nseat_length = 0.15"),
        tie("z = 0.5\nslack = \"5 mm\"\nbreaks_at = \"50 mm\"\nstiffness = \"20 kN/mm\""),
        side("x = 0.2\nthickness = 0.4\noverlap = 0.5") + &side("x = 4.8\nthickness = 1.5"),
        // Beside each other.
        side("x = 0.2\nthickness = 0.4") + &side("x = 0.6\nthickness = 0.4"),
        gable("height = 2\nthickness = 0.3\nridge_load = 5e3"),
        // A church; rubble of 1 MPa over γ_M = 3 and FC = 1.35 is just below.
        gable("height = 9\nridge_load = \"400 kN\"") + "\n[out_of_plane]\nstrength = \"250 kPa\"",
        floor("z = 6\nload = 0\nthrust = 2e3"),
        building("height = 8\nperiod = 0.3\nparticipation = 1.2"),
    ] {
        assert_eq!(doubts(&facade(&fine)), [""; 0], "{fine}");
    }
    let thick = |t: &str| {
        let text =
            WALL.replace("model = \"shear\"", "model = \"planar\"").replace("thickness = 0.12", t) + "[out_of_plane]\n";
        doubts(&case(&text)).into_iter().find(|doubt| doubt.contains("thickness"))
    };
    let told = thick("thickness = \"500 cm\"").expect("a doubt");
    assert_eq!(told, "panel[0].brick.thickness is 5 m, more than 3 m; did you mean \"0.5 m\"?");
    assert_eq!(thick("thickness = 2.5"), None);
}

/// What only the laid wall shows: openings where something should hold, loads given twice, spectra that nothing uses, walls like planks.
#[test]
fn slips_that_the_laid_wall_shows_are_told() {
    let found = |case: &Case| {
        let wall = concio::facade::of(case).unwrap_or_else(|e| panic!("{e}"));
        concio::facade::doubts(case, &wall)
    };
    let behind = |table: &str, keys: &str| format!("[out_of_plane{table}]\n{keys}");
    let floor = |keys: &str| format!("[[out_of_plane.floor]]\n{keys}");
    let side = |keys: &str| format!("[[out_of_plane.side_wall]]\nx = 0\nthickness = 0.4\n{keys}");
    let floors_shake = |by: &str| {
        format!(
            "site.life_safety = {{ ground_acceleration = \"0.25 g\", soil_factor = 1.2, amplification = 2.4, corner_period = 0.4 }}\n\
             floor_spectrum = [{{ z = 6, periods = [0, 1], accelerations = [\"{by} g\", \"0.1 g\"] }}]"
        )
    };
    let spectrum = |z: f64| {
        format!(
            "[[out_of_plane.floor_spectrum]]\nz = {z}\nperiods = [0, 1]\naccelerations = [4, 5]\n[out_of_plane.building]\nheight = 9\nstoreys = 3"
        )
    };
    for (behind, told) in [
        (
            "[[out_of_plane.anchor]]\nz = 1\nx = 2.5\nyield_force = 20e3".to_string(),
            "out_of_plane.anchor[0] lies in an opening, at x = 2.5 m and z = 1 m: there its plate holds nothing, and it counts as if it did",
        ),
        (
            "[[out_of_plane.side_wall]]\nx = 2.5\nthickness = 0.4".into(),
            "out_of_plane.side_wall[0] meets the wall at x = 2.5 m, in an opening from 2 to 3 m: there nothing bonds both, and it counts as if something did",
        ),
        (
            "[load]\ntop = \"8 kN/m\"\n[[out_of_plane.floor]]\nz = 6\nload = \"8 kN/m\"".into(),
            "load.top and out_of_plane.floor[0] at the top both bring 8 kN/m: the load counts twice; is one of them left over?",
        ),
        (
            "[load]\ntop = \"8 kN/m\"\n[[out_of_plane.floor]]\nz = 6\nload = \"5 kN/m\"".into(),
            "load.top brings 8 kN/m and out_of_plane.floor[0] at the top 5 kN/m: both count, 13 kN/m together; is one of them left over?",
        ),
        (
            spectrum(9.0),
            "out_of_plane.floor_spectrum[0].z is 9 m, farther than 0.5 m from every joint of the wall, which ends at 6 m: nothing uses it",
        ),
        (
            behind("", &floors_shake("0.04")),
            "out_of_plane.floor_spectrum[0].accelerations begin at 0.04 g, less than the 0.3 g by which out_of_plane.site.life_safety shakes the ground: \
             floors shake more than it, and the checks aloft are unsafe",
        ),
        (
            behind(".building", "height = 60\nstoreys = 2"),
            "out_of_plane.building.height is 60 m, 10 times the wall of 6 m; did you mean \"6 m\"?",
        ),
        (
            behind(".building", "height = 6\nstoreys = 20"),
            "out_of_plane.building.storeys is 20: in 6 m they are 0.3 m high each",
        ),
        (
            floor("z = 1\nload = 8e3"),
            "out_of_plane.floor[0] lies at z = 1 m, within openings that take 1 of 5 m: it rests on the piers alone, and counts along the whole wall; \
             is its level meant so?",
        ),
        (
            floor("z = 3\nload = 8e3\nseat_length = 2"),
            "out_of_plane.floor[0].seat_length is 2 m, and the wall is 0.5 m thick; did you mean \"0.2 m\"?",
        ),
        (
            floor("z = 6\nload = 6e3\nthrust = 80e3"),
            "out_of_plane.floor[0].thrust is 80 kN/m, 13 times the load of 6 kN/m there: flat vaults thrust with a few times their load",
        ),
        (
            floor("z = 3\nload = 12e3\npush = 500e3"),
            "out_of_plane.floor[0].push is 500 kN/m, 42 times the load of 12 kN/m there, and more than the 50.4 kN/m that the wall weighs",
        ),
        (
            "[load]\ntop = \"40 kN/m\"\nmass = \"4000 t\"\n[out_of_plane]".into(),
            "load.mass is 4000 t, which weigh 196 times the 200 kN of load.top; did you mean \"4 t\"?",
        ),
        (
            side("first_opening = 150"),
            "out_of_plane.side_wall[0].first_opening is 150 m, more than 60 m, 10 times the height of the wall: it is as if there were no opening; \
             did you mean \"1.5 m\"?",
        ),
        (
            side("opening_beside = 300"),
            "out_of_plane.side_wall[0].opening_beside is 300 m, more than 5 m, the length of the wall: it is as if there were no opening; \
             did you mean \"3 m\"?",
        ),
        // (6 × 1.85 + 0.4 + 0.5) cos 45°: the mean overlap is about 1.85 times the mean course.
        (
            side("corner = { load = 8e3, at = 40 }"),
            "out_of_plane.side_wall[0].corner.at is 40 m, and the corner reaches 8.5 m behind its hinge line at most: there its load holds what does \
             not fall; did you mean \"0.4 m\"?",
        ),
        // 18 kN/m³ × 5 × 2/2 m² × 0.5 m and 10 kN.
        (
            behind(".gable", "height = 2\nridge_load = 10e3\ncrack_thrust = 5e6"),
            "out_of_plane.gable.crack_thrust is 5000 kN, 91 times the 55 kN that the gable and its ridge weigh: flaps press on each other with a part of that",
        ),
        (
            behind(".gable", "height = 2\nbase = \"4.99 mm\""),
            "out_of_plane.gable.base is 0.00499 m, 0.001 times the wall's length of 5 m; without `base` the gable is as long as the wall",
        ),
        (
            behind(".gable", "height = 2\nbase = \"50 cm\""),
            "out_of_plane.gable.base is 0.5 m, 0.1 times the wall's length of 5 m; without `base` the gable is as long as the wall",
        ),
        (
            behind(".gable", "height = 25"),
            "out_of_plane.gable.height is 25 m, 5 times its base of 5 m: roofs rise by 0.2 to 1 of it; did you mean \"2.5 m\"?",
        ),
        (
            floor("z = 3\nload = 12e3\nat = \"0.3 mm\""),
            "out_of_plane.floor[0].at is 0.0003 m from the outer face, less than 0.05 m, a tenth of the thickness: beams reach farther into a wall; \
             did you mean \"0.3 m\"?",
        ),
        (
            floor("z = 3\nload = 12e3\nat = \"30 mm\""),
            "out_of_plane.floor[0].at is 0.03 m from the outer face, less than 0.05 m, a tenth of the thickness: beams reach farther into a wall; \
             did you mean \"0.3 m\"?",
        ),
        (
            behind(".gable", "height = 2\nridge_load = 10e3\nridge_thrust = 100e3"),
            "out_of_plane.gable.ridge_thrust is 100 kN, 10 times the ridge_load of 10 kN",
        ),
    ] {
        assert_eq!(found(&facade(&behind)), [told], "{behind}");
    }
    for fine in [
        "[[out_of_plane.anchor]]\nz = 1\nx = 1.5\nyield_force = 20e3".to_string(),
        "[[out_of_plane.anchor]]\nz = 4\nx = 2.5\nyield_force = 20e3".into(),
        "[[out_of_plane.side_wall]]\nx = 3\nthickness = 0.4".into(),
        "[[out_of_plane.side_wall]]\nx = 2.5\nthickness = 0.4\nbonded = false".into(),
        "[load]\ntop = \"8 kN/m\"\n[[out_of_plane.floor]]\nz = 3\nload = \"8 kN/m\"".into(),
        spectrum(6.2),
        behind("", &floors_shake("0.3")),
        // A ground floor under four others, a vault of 1 : 20, a floor that rests elsewhere, one on a lintel.
        behind(".building", "height = 30\nstoreys = 12"),
        floor("z = 3\nload = 4e3\nthrust = 20e3"),
        floor("z = 3\nload = 1e3\npush = 40e3\nseat_length = 0.5"),
        floor("z = 2\nload = 8e3"),
        "[load]\ntop = \"10 kN/m\"\nmass = \"60 t\"\n[out_of_plane]".into(),
        side("first_opening = 40\nopening_beside = 5\ncorner = { load = 8e3, at = 2 }"),
        behind(".gable", "height = 2\nridge_load = 10e3\nridge_thrust = 20e3\ncrack_thrust = 60e3"),
        // A dormer, a Gothic gable, a balcony, floors on an outer leaf.
        behind(".gable", "height = 1\nbase = 1.2"),
        behind(".gable", "height = 7"),
        floor("z = 3\nload = 12e3\nat = 0"),
        floor("z = 3\nload = 12e3\nat = 0.06"),
        behind("", "leaves = [0.12, 0.38]\n") + &floor("z = 3\nload = 2e3\nat = 0.04"),
    ] {
        assert_eq!(found(&facade(&fine)), [""; 0], "{fine}");
    }
    let thin = |t: f64| {
        let text = "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 12\nbricks = 5\nbrick = { length = 1.0, height = 0.5, thickness = T, specific_weight = 18e3 }\n\
                    [joint]\nbed = { law = \"rigid\" }\nhead = { law = \"rigid\" }\nfriction = { law = \"coulomb\", static = 0.6 }\n[motion]\nduration = 1.0\n";
        found(&case(&text.replace('T', &t.to_string())))
    };
    assert_eq!(
        thin(0.05),
        [
            "panel[0].brick.thickness of 0.05 m under a height of 6 m makes the wall 120 times as high as thick; are courses and thickness meant so?"
        ]
    );
    assert_eq!(thin(0.2), [""; 0]);
}

/// What acts in the plane alone is listed among what is assumed, with the key that acts across it.
#[test]
fn what_is_not_read_out_of_the_plane_is_listed() {
    let assumed = |besides: &str| {
        let wall = concio::facade::of(&facade(besides)).unwrap_or_else(|e| panic!("{e}"));
        wall.assumed.iter().map(|a| format!("{}: {}", a.key, a.what)).collect::<Vec<_>>()
    };
    let bond = "bond = { tensile_strength = \"0.2 MPa\", cohesion = \"0.2 MPa\" }";
    for (besides, told) in [
        (
            "[[tie]]\nfrom = \"p1c6b1\"\nto = \"p1c6b5\"\nstiffness = \"20 kN/mm\"".to_string(),
            "tie: not read: ties of the plane hold nothing across it; `out_of_plane.anchor` does",
        ),
        (
            format!("[joint.{}]\n{}", "bond", bond[9..bond.len() - 2].replace(", ", "\n")),
            "joint.bond: not read: joints bear no tension and no cohesion out of the plane, as masonry without tensile strength",
        ),
        (
            format!("[[joint.change]]\nat = {{ kind = [\"bed\"] }}\n{bond}"),
            "joint.change[0].bond: not read: joints bear no tension and no cohesion out of the plane, as masonry without tensile strength",
        ),
        (
            "[[force]]\nblock = \"p1c12b1\"\nx = [\"1 kN\"]".into(),
            "force: not read: forces on blocks act in the plane; `out_of_plane.floor` has `push` and `thrust`",
        ),
    ] {
        let found = assumed(&besides);
        assert!(found.contains(&told.to_string()), "{besides}: {found:?}");
    }
    assert!(assumed("").iter().all(|line| !line.contains("not read")));
}

/// A strength of stones, floors that meet at one level, a tie below what a guess may name.
#[test]
fn floors_at_one_level_and_guesses_beyond_the_wall() {
    let floor = |z: f64, load: &str, at: &str| format!("[[out_of_plane.floor]]\nz = {z}\nload = \"{load}\"\n{at}\n");
    let of = |behind: &str| doubts(&facade(behind));
    assert_eq!(
        of(&(floor(3.0, "12 kN/m", "at = 0.25") + &floor(3.0, "6 kN/m", "at = 0.25"))),
        [
            "out_of_plane.floor[1] lies at z = 3 m as out_of_plane.floor[0] does: 12 and 6 kN/m both count, 18 kN/m together; is its level meant so?"
        ]
    );
    assert_eq!(of(&(floor(3.0, "12 kN/m", "at = 0.35") + &floor(3.0, "6 kN/m", "at = 0.3"))).len(), 1);
    // Floors on both sides have their own places, and levels differ as a rule.
    assert_eq!(of(&(floor(3.0, "12 kN/m", "at = 0.4") + &floor(3.0, "6 kN/m", "at = 0.1"))), [""; 0]);
    assert_eq!(of(&(floor(3.0, "12 kN/m", "") + &floor(6.0, "6 kN/m", ""))), [""; 0]);
    assert_eq!(
        of("[out_of_plane]\nstrength = \"250 MPa\""),
        ["out_of_plane.strength is 2.5e8 Pa, more than 1e8 Pa; did you mean \"2.5 MPa\"?"]
    );
    assert_eq!(of("[out_of_plane]\nstrength = \"60 MPa\""), [""; 0]);
    let anchor = |z: f64| format!("[[out_of_plane.anchor]]\nz = {z}\nyield_force = \"20 kN\"");
    // 100 m lie above a wall of 6 m, 5 m in it.
    assert_eq!(
        of(&anchor(0.1)),
        ["out_of_plane.anchor[0].z is 0.1 m, less than 0.3 m: a tie there holds next to nothing"]
    );
    assert_eq!(
        of(&anchor(0.005)),
        [
            "out_of_plane.anchor[0].z is 0.005 m, less than 0.3 m: a tie there holds next to nothing; did you mean \"5 m\"?"
        ]
    );
    let door = |bearing: &str| {
        let mut wall = facade("");
        wall.panels[0].openings[0].lintel.as_mut().expect("a lintel").bearing =
            concio::case::Extent::parse(bearing).expect("a length");
        wall.panels[0].openings[0].width = 1.0.into();
        doubts(&wall)
    };
    assert_eq!(
        door("5 mm"),
        [
            "panel[0].opening[0].lintel.bearing is 5 mm, under a span of 1000 mm less than 20 mm, a fiftieth: at the least opening of the joints the lintel falls; lintels lie on a tenth"
        ]
    );
    assert_eq!(door("40 mm"), [""; 0]);
    let arch = |rise: &str| {
        doubts(&case(&format!(
            "model = \"planar\"\n[[panel]]\nbond = \"arch\"\narch = {{ span = 2, rise = {rise}, thickness = 0.25, voussoirs = 21 }}\n\
             brick = {{ length = 0.3, height = 0.25, thickness = 0.3, specific_weight = 20e3 }}\n[joint]\nbed = {{ law = \"rigid\" }}\n\
             head = {{ law = \"rigid\" }}\nfriction = {{ law = \"coulomb\", static = 0.6 }}\n[motion]\nduration = 1\n"
        )))
    };
    // 10 m rise more than half the span.
    assert_eq!(arch("0.01"), ["panel[0].arch.rise is 0.01 m, less than 0.05 m"]);
    assert_eq!(arch("0.0005"), ["panel[0].arch.rise is 0.0005 m, less than 0.05 m; did you mean \"0.5 m\"?"]);
}

/// What pushes a wall out of its plane is the mass of its beam, as in limit analysis: 5 t are 49.05 kN, the load is 8 kN/m on 5 m.
#[test]
fn the_mass_of_a_beam_pushes_out_of_the_plane() {
    let of = |load: &str| {
        let wall =
            concio::facade::of(&facade(&format!("[load]\ntop = \"8 kN/m\"\n{load}"))).unwrap_or_else(|e| panic!("{e}"));
        let told = wall.assumed.iter().find(|a| a.key == "load.top").expect("an assumption").what.clone();
        (wall.floors[0].floor.load, wall.floors[0].floor.pushing, told)
    };
    let close = |found: f64, right: f64| assert!((found - right).abs() < 1e-6, "{found} instead of {right}");
    for (load, pushing, told) in [
        ("", 0.0, "pushes with its weight, and"),
        ("beam = { mass = \"5 t\" }", 9050.0, "pushes with the 49.05 kN of load.beam.mass, where 40 kN press, and"),
        (
            "beam = { mass = \"3 t\" }",
            0.0,
            "pushes with its weight of 40 kN, more than the 29.43 kN of load.beam.mass, which is safe, and",
        ),
        ("mass = 0", 0.0, "pushes with its weight of 40 kN, more than the 0 kN of load.mass, which is safe, and"),
    ] {
        let (presses, pushes, said) = of(load);
        close(presses, 40e3);
        close(pushes, pushing);
        assert!(said.contains(told), "{said}");
    }
}
