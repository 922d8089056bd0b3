//! Numbers that are allowed but hardly meant: a bare number is in SI, so `length = 300` is a brick of 300 m.
//!
//! The limits are generous on purpose: whatever has been built or tested lies within. A number outside is a warning and
//! no error, because nothing but its size speaks against it.

use std::f64::consts::PI;

use super::node::{Node, Value};
use super::out_of_plane::{FloorLoad, Hazard, OutOfPlane, SideWall, Site};
use super::{
    Beam, Bond, Brick, Case, Course, FrictionChange, FrictionLaw, HistoryQuantity, JointBond, JointKind, Joints,
    ModelKind, Panel, Scheme, Signal, Solver, SpringChange, TopLoad,
};
use crate::quantity::{self, Acceleration, Stiffness, shown};
use crate::warning::{Warning, WarningKind};

/// What a quantity is expected to be, in SI.
#[derive(Debug, Clone, Copy)]
pub struct Expected {
    /// Limits beyond which a warning is due.
    pub limits: [f64; 2],
    /// What it mostly is: a guess at what was meant lies in here.
    pub usual: [f64; 2],
    /// Unit of the limits in a message.
    pub unit: &'static str,
    /// Mistakes of unit: factor on the number as it was read, unit in which the guess is written, that unit in SI.
    pub slips: &'static [(f64, &'static str, f64)],
}

/// Millimetres that were read as metres.
pub const FROM_MM: (f64, &str, f64) = (1e-3, "mm", 1e-3);
const FROM_CM: (f64, &str, f64) = (1e-2, "cm", 1e-2);

/// Brick lengths and heights: from a chip of stone to the largest ashlar.
const BRICK: Expected =
    Expected { limits: [5e-3, 5.0], usual: [0.03, 2.0], unit: "m", slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0)] };
/// Joints: 0 is a dry wall, 70 mm are the thickest of Byzantine walls.
const MORTAR: Expected =
    Expected { limits: [1e-4, 0.07], usual: [1e-3, 0.05], unit: "m", slips: &[FROM_MM, (0.1, "mm", 1e-3), FROM_CM] };
/// A panel: no wall of one panel is a kilometre long.
const PANEL: Expected =
    Expected { limits: [0.05, 1e3], usual: [0.2, 100.0], unit: "m", slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0)] };
/// Openings, and where they lie in a panel.
const OPENING: Expected =
    Expected { limits: [5e-3, 1e3], usual: [0.05, 100.0], unit: "m", slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0)] };
/// From the lightest aerated concrete of walls, 3 kN/m³, to a block of steel, 78 kN/m³. Densities in kg/m³ or t/m³ fall below.
const WEIGHT: Expected = Expected {
    limits: [3e3, 1e5],
    usual: [5e3, 3.5e4],
    unit: "N/m3",
    slips: &[
        (1e3, "kN/m3", 1e3),
        (crate::G, "kg/m3", crate::G),
        (10.0, "kg/m3", crate::G),
        (100.0, "kN/m3", 1e3),
        (100.0, "kg/m3", crate::G),
        (0.1, "kN/m3", 1e3),
        (0.1, "kg/m3", crate::G),
        (1e-3, "kN/m3", 1e3),
        (1e-3 * crate::G, "kg/m3", crate::G),
    ],
};
/// Densities of stone in kg/m³ that are no weights of aerated concrete in N/m³ yet.
const DENSE: f64 = 3.5e3;
/// Rubber of 1 MPa, 10 mm thick, under half a brick has 5e5 N/m; steel of 1 mm over a metre has some 1e13 N/m.
const STIFFNESS: Expected = Expected {
    limits: [1e3, 1e13],
    usual: [1e6, 1e10],
    unit: "N/m",
    slips: &[(1e6, "MN/m", 1e6), (1e3, "kN/m", 1e3), (1e-3, "N/m", 1.0)],
};
/// The softest rubber of bearings, G = 0.4 MPa, 10 mm thick, has 4e7 N/m³ when sheared; a millimetre of glue on stone is the other
/// end.
const STIFFNESS_PER_AREA: Expected = Expected {
    limits: [4e7, 1e15],
    usual: [1e9, 1e13],
    unit: "N/m3",
    slips: &[(1e9, "N/mm3", 1e9), (1e3, "N/mm3", 1e9), (1e6, "MPa/m", 1e6), (1e-3, "N/mm3", 1e9), (1e-6, "N/mm3", 1e9)],
};
/// f_t of joints: mud to the best thin mortar, 0.05 to 1 MPa (Eurocode 6, 3.6.4: f_xk1 of 0.05 to 0.2 MPa); bricks themselves split at some MPa.
const TENSION: Expected = Expected {
    limits: [1e3, 2e6],
    usual: [1e4, 1e6],
    unit: "Pa",
    slips: &[(1e6, "MPa", 1e6), (1e3, "kPa", 1e3), (0.1, "MPa", 1e6), (1e-3, "MPa", 1e6)],
};
/// c of joints: f_vk0 of 0.1 to 0.4 MPa (Eurocode 6, table 3.4), tests up to some 2 MPa.
const COHESION: Expected = Expected { limits: [1e3, 4e6], usual: [1e4, 1e6], ..TENSION };
/// φ of joints, in degrees: tan φ from 0.3 to 1; an angle in radians that is given as one in degrees is below.
const ANGLE: Expected =
    Expected { limits: [2.0, 45.0], usual: [15.0, 45.0], unit: "deg", slips: &[(180.0 / PI, "rad", 180.0 / PI)] };
/// What holds a wall to its supports: glue and teeth too.
const HELD: Expected = Expected { limits: [1e3, 2e7], usual: [1e4, 1e7], ..TENSION };
/// Masonry bears 0.5 to 50 MPa, adobe less, hard stone laid dry more.
const COMPRESSION: Expected =
    Expected { limits: [1e4, 5e8], usual: [1e5, 1e8], unit: "Pa", slips: &[(1e6, "MPa", 1e6), (1e3, "kPa", 1e3)] };
/// Masonry as a whole at hinges: granite ashlar of thin joints is the best, rubble of 1 MPa over FC and γ_M the poorest.
const MASONRY: Expected = Expected {
    limits: [0.25e6, 1e8],
    slips: &[(1e6, "MPa", 1e6), (1e3, "kPa", 1e3), (10.0, "MPa", 1e6), (1e-2, "MPa", 1e6)],
    ..COMPRESSION
};
/// Fracture energies: mortar has 1 to 20 N/m when opened, 10 to 1000 N/m when sheared.
const OPENING_ENERGY: Expected = Expected {
    limits: [1e-4, 1e3],
    usual: [0.1, 200.0],
    unit: "N/m",
    slips: &[(1e3, "N/mm", 1e3), (1e-3, "N/m", 1.0)],
};
const SHEAR_ENERGY: Expected =
    Expected { limits: [1e-4, 1e4], usual: [0.1, 2e3], unit: "N/m", slips: &[(1e3, "N/mm", 1e3), (1e-3, "N/m", 1.0)] };
/// δ_v: faster than 0.1 m/s is beyond what joints reach in most earthquakes, so that they would never slip.
const SLIP_VELOCITY: Expected =
    Expected { limits: [1e-7, 0.1], usual: [1e-5, 0.02], unit: "m/s", slips: &[(1e-3, "mm/s", 1e-3)] };
/// From a light roof to 10 MPa on a wall of one metre.
const LOAD: Expected =
    Expected { limits: [3e2, 1e7], usual: [1e3, 2e6], unit: "N/m", slips: &[(1e3, "kN/m", 1e3), (1e-3, "kN/m", 1e3)] };
/// The same on a pier of the laboratory to a façade.
const WHOLE_LOAD: Expected =
    Expected { limits: [1e3, 1e9], usual: [1e3, 1e8], unit: "N", slips: &[(1e3, "kN", 1e3), (1e-3, "kN", 1e3)] };
/// A beam of the laboratory to the floors of a tower.
const BEAM: Expected =
    Expected { limits: [10.0, 1e7], usual: [100.0, 1e6], unit: "kg", slips: &[(1e3, "t", 1e3), (1e-3, "t", 1e3)] };
/// The largest peak acceleration ever recorded is some 4 g.
const SHAKING: Expected =
    Expected { limits: [1e-4, 45.0], usual: [0.05, 20.0], unit: "m/s2", slips: &[(1e-2, "cm/s2", 1e-2)] };
/// a_g of a site: 0.05 g or less where hardly anything shakes, 0.3 g in Italy, 1 g beside the largest faults.
const GROUND: Expected =
    Expected { limits: [0.02, 10.0], usual: [0.2, 5.0], unit: "m/s2", slips: &[(1e-2, "cm/s2", 1e-2)] };
/// S: 0.9 on rock to 1.8 on soft soil times 1 to 1.4 on ridges (NTC 2018, tables 3.2.IV and 3.2.V).
const SOIL: Expected =
    Expected { limits: [0.5, 3.0], usual: [0.8, 2.6], unit: "", slips: &[(1e-2, "", 1.0), (1e2, "", 1.0)] };
/// F0 of sites: from 2.2 (NTC 2018) to some 3.
const AMPLIFICATION: Expected =
    Expected { limits: [1.5, 5.0], usual: [2.0, 4.0], unit: "", slips: &[(1e-2, "", 1.0), (1e2, "", 1.0)] };
/// T_C: 0.15 s on rock to 2 s on the softest soils.
const CORNER: Expected =
    Expected { limits: [0.05, 3.0], usual: [0.1, 2.0], unit: "s", slips: &[(1e-3, "s", 1.0), (1e3, "s", 1.0)] };
/// What a floor, a vault or a roof brings to a metre of wall: a light roof to two heavy vaults.
const FLOOR_LOAD: Expected =
    Expected { limits: [3e2, 5e5], usual: [5e2, 2e5], unit: "N/m", slips: &[(1e3, "kN/m", 1e3), (1e-3, "kN/m", 1e3)] };
/// What they push and thrust per length of the wall.
const THRUST: Expected =
    Expected { limits: [10.0, 5e5], usual: [1e2, 2e5], unit: "N/m", slips: &[(1e3, "kN/m", 1e3), (1e-3, "kN/m", 1e3)] };
/// What connects them to it.
const CONNECTION: Expected =
    Expected { limits: [10.0, 1e7], usual: [1e2, 1e6], unit: "N/m", slips: &[(1e3, "kN/m", 1e3), (1e-3, "kN/m", 1e3)] };
/// Levels of floors and ties: a metre in a unit of thousandths lies in the lowest course.
const LEVEL: Expected = Expected { limits: [0.3, 1e3], usual: [0.5, 100.0], unit: "m", slips: &[(1e3, "m", 1.0)] };
/// Walls that stand behind another and gables: from half a brick to a tower.
const THICKNESS: Expected = Expected {
    limits: [0.05, 3.0],
    usual: [0.1, 1.5],
    unit: "m",
    slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0), (0.1, "m", 1.0), (10.0, "m", 1.0)],
};
/// Heights of gables [m].
pub const HIGHEST_GABLE: f64 = 30.0;
const GABLE: Expected = Expected {
    limits: [0.2, HIGHEST_GABLE],
    usual: [0.5, 15.0],
    unit: "m",
    slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0)],
};
/// Heights of buildings.
const BUILDING: Expected =
    Expected { limits: [1.0, 200.0], usual: [2.5, 60.0], unit: "m", slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0)] };
/// T_1 of masonry buildings: 0.1 s to 1 s, towers 2 s.
const FIRST_PERIOD: Expected =
    Expected { limits: [0.02, 5.0], usual: [0.05, 2.0], unit: "s", slips: &[(1e-3, "ms", 1e-3), (1e3, "s", 1.0)] };
/// γ_1 of regular buildings: 1 to 1.5.
const PARTICIPATION: Expected = Expected { limits: [0.5, 3.0], usual: [1.0, 2.0], unit: "", slips: &[(1e-2, "", 1.0)] };
/// Lengths on which beams lie.
const SEAT: Expected =
    Expected { limits: [5e-3, 2.0], usual: [0.03, 1.0], unit: "m", slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0)] };
/// Way that a loose tie leaves: more, and the wall has fallen.
const TIE_SLACK: Expected = Expected { limits: [1e-6, 0.2], usual: [1e-4, 0.1], unit: "m", slips: &[FROM_MM, FROM_CM] };
/// Way at which a tie breaks.
const TIE_BREAK: Expected =
    Expected { limits: [5e-4, 1.0], usual: [1e-3, 0.5], unit: "m", slips: &[FROM_MM, FROM_CM, (1e3, "mm", 1e-3)] };
/// Overlaps and courses of side walls.
const SIDE_BLOCK: Expected =
    Expected { limits: [5e-3, 2.0], usual: [0.02, 1.0], unit: "m", slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0)] };
/// Corner periods of the spectrum of a synthetic motion.
const CORNERS: Expected =
    Expected { limits: [5e-3, 20.0], usual: [0.02, 10.0], unit: "s", slips: &[(1e-3, "ms", 1e-3), (1e3, "s", 1.0)] };
/// Of a bed joint given as a whole, below which it is softer than a sheet of rubber [N/m³].
const SOFTEST: f64 = 1e7;
/// Ground displacements and strokes of actuators.
const STROKE: Expected = Expected { limits: [1e-8, 3.0], usual: [1e-4, 0.5], unit: "m", slips: &[FROM_MM, FROM_CM] };
/// Sample intervals of records.
const INTERVAL: Expected =
    Expected { limits: [1e-5, 0.2], usual: [1e-4, 0.05], unit: "s", slips: &[(1e-3, "ms", 1e-3)] };

/// Those of an acceleration that a file says itself: earthquakes are sampled at 50 Hz and more.
const SAMPLED: Expected =
    Expected { limits: [1e-5, 0.05], usual: [1e-3, 0.02], unit: "s", slips: &[(1e-3, "ms", 1e-3), (0.1, "s", 1.0)] };

/// Steps of a planar wall: longer ones than some milliseconds are taken in parts where blocks fly, and miss how they strike.
const STEP: Expected = Expected { limits: [1e-7, 0.05], usual: [1e-5, 0.01], unit: "s", slips: &[(1e-3, "ms", 1e-3)] };
/// How fast an actuator moves a wall.
const SPEED: Expected =
    Expected { limits: [1e-9, 3.0], usual: [1e-6, 0.5], unit: "m/s", slips: &[(1e-3, "mm/s", 1e-3)] };

/// Forces of ties and of what meets a corner: from a nail in old timber to a bundle of bars.
const PULL: Expected =
    Expected { limits: [2e2, 1e7], usual: [1e3, 2e6], unit: "N", slips: &[(1e3, "kN", 1e3), (1e-3, "kN", 1e3)] };
/// What a ridge beam brings to a gable: a purlin of a shed to the roof of a church.
const RIDGE: Expected = Expected { limits: [2e2, 1e6], usual: [1e3, 3e5], ..PULL };
/// Forces at which devices yield or slip: from a clip of some newtons to a damper of a bridge.
const DEVICE_FORCE: Expected =
    Expected { limits: [5.0, 1e7], usual: [50.0, 1e6], unit: "N", slips: &[(1e3, "kN", 1e3), (1e-3, "N", 1.0)] };
/// What pulls a block: a jack in a laboratory to a rope at a façade.
const BLOCK_PULL: Expected =
    Expected { limits: [10.0, 1e7], usual: [100.0, 1e6], unit: "N", slips: &[(1e3, "kN", 1e3), (1e-3, "kN", 1e3)] };
/// How far devices go until they yield.
const DEVICE_YIELD: Expected =
    Expected { limits: [1e-7, 0.05], usual: [1e-6, 0.02], unit: "m", slips: &[FROM_MM, FROM_CM] };

/// Stiffness of pressed bed joints of planar walls over what the file calls their stiffness, above which it was hardly meant.
const STIFFER: f64 = 10.0;
/// k_n/k_s below which a joint is sheared harder than pressed: no layer of one material is, whose k_n/k_s is 2 at least.
const LEAST_NORMAL_TO_SHEAR: f64 = 1.0;
/// q of the code for mechanisms out of the plane, Circolare 21.1.2019 n. 7, C8.7.1.2.1.7.
const BEHAVIOUR: f64 = 2.0;
/// Masonry rubs with 0.4 (Eurocode 6, 3.6.2) to 0.8, split and toothed stones with 1 at most.
const LARGEST_FRICTION: f64 = 1.0;
/// Difference from whole steps of how long a force acts that is told: more than a rounded step.
const WHOLE_STEPS: f64 = 1e-6;
/// What joints of masonry do.
const RUBS: &str = ": joints of masonry rub with 0.4 to 0.8";
/// Below this it slides on sheets made to slide.
const LEAST_FRICTION: f64 = 0.1;
/// Heights of beams and slabs on a wall.
const BEAM_HEIGHT: Expected =
    Expected { limits: [0.01, 3.0], usual: [0.05, 1.5], unit: "m", slips: &[FROM_MM, FROM_CM, (1e3, "m", 1.0)] };
/// Of what holds a wall to its supports, such as the glue of a laboratory.
const LARGEST_HELD: f64 = 2.0;
/// Coefficients from this on are rather angles in degrees.
const LEAST_ANGLE: f64 = 10.0;

/// `solver.tolerance` to which `esdirk4` follows friction that falls at once, as `newmark_pulses_with_less_friction_in_slip` shows.
const FINE: f64 = 1e-8;

/// One sentence for each number of a valid case that is allowed but unlikely, in the order of the wall file.
pub fn doubts(case: &Case) -> Vec<Warning> {
    let mut doubts = Doubts(Vec::new());
    for (index, panel) in case.panels.iter().enumerate() {
        of_panel(&mut doubts, &format!("panel[{index}]"), panel);
        // Elsewhere it is a reference alone.
        if matches!(panel.bond, Bond::Running | Bond::Stack | Bond::Irregular) {
            of_proportions(&mut doubts, &format!("panel[{index}].brick"), panel, case.out_of_plane.is_some());
        }
        of_courses(&mut doubts, &format!("panel[{index}]"), panel);
    }
    for (index, tie) in case.ties.iter().enumerate() {
        doubts.look(&format!("tie[{index}].stiffness"), tie.stiffness.si(), &STIFFNESS);
        doubts.look(&format!("tie[{index}].slack"), tie.slack.si(), &TIE_SLACK);
    }
    of_forces(&mut doubts, case);
    of_joints(&mut doubts, case);
    if case.model == ModelKind::Planar {
        of_planar(&mut doubts, case);
    }
    match case.load.top {
        TopLoad::PerLength(load) => doubts.look("load.top", load.si(), &LOAD),
        TopLoad::Force(force) => doubts.look("load.top.force", force.si(), &WHOLE_LOAD),
    }
    if let Beam::Mass(mass) = case.load.beam {
        doubts.look("load.beam.mass", mass.si(), &BEAM);
    }
    if let Some(height) = case.load.beam_height {
        doubts.look("load.beam_height", height.si(), &BEAM_HEIGHT);
    }
    if let Some(own) = &case.out_of_plane {
        of_out_of_plane(&mut doubts, own, case);
    }
    of_signal(&mut doubts, "motion.base", &case.motion.base);
    of_signal(&mut doubts, "motion.top", &case.motion.top);
    of_signal(&mut doubts, "motion.vertical", &case.motion.vertical);
    if let Some(step) = case.solver.step {
        doubts.look("solver.step", step.si(), &STEP);
    }
    of_scheme(&mut doubts, case);
    doubts.0
}

/// A scheme for smooth motion, by tolerances under which slides with friction that falls at once came out wrong.
fn of_scheme(doubts: &mut Doubts, case: &Case) {
    let (friction, tolerance) = (&case.joint.friction, case.solver.tolerance);
    let falls = friction.law == FrictionLaw::Coulomb && friction.dynamic < friction.static_;
    if falls && case.solver.scheme == Scheme::Esdirk4 && tolerance > FINE {
        let text = format!(
            "solver.scheme is `esdirk4`, for smooth motion, and friction falls at once from {} to {}: with a solver.tolerance of {tolerance} slides \
             may come out several times too long; take `tr-bdf2`, or a tolerance of {FINE:e}",
            shown(friction.static_),
            shown(friction.dynamic)
        );
        doubts.add(WarningKind::UnlikelyNumber, text);
    }
}

fn of_forces(doubts: &mut Doubts, case: &Case) {
    for (index, force) in case.forces.iter().enumerate() {
        for (key, values) in [("x", &force.x), ("y", &force.y)] {
            let largest =
                values.iter().map(|v| v.si()).fold(0.0f64, |most, v| if v.abs() > most.abs() { v } else { most });
            if largest != 0.0 {
                doubts.look(&format!("force[{index}].{key}"), largest.abs(), &BLOCK_PULL);
            }
        }
    }
}

fn of_out_of_plane(doubts: &mut Doubts, own: &OutOfPlane, case: &Case) {
    for (index, panel) in case.panels.iter().enumerate() {
        // Beyond the limits of bricks it is told already.
        let thickness = panel.brick.thickness.si();
        if (THICKNESS.limits[1]..=BRICK.limits[1]).contains(&thickness) {
            doubts.look(&format!("panel[{index}].brick.thickness"), thickness, &THICKNESS);
        }
    }
    if let Some(strength) = own.strength {
        doubts.look("out_of_plane.strength", strength.si(), &MASONRY);
    }
    if let Some(factor) = own.behaviour_factor.filter(|q| *q > BEHAVIOUR) {
        let text = format!(
            "out_of_plane.behaviour_factor is {}, more than {}, the code's for mechanisms out of the plane: the linear check is unsafe by as much",
            shown(factor),
            shown(BEHAVIOUR)
        );
        doubts.add(WarningKind::UnlikelyNumber, text);
    }
    doubts.look_for_twins("floor", &own.floors, "its load counts twice");
    of_floors_at_one_level(doubts, &own.floors, case);
    doubts.look_for_twins("anchor", &own.anchors, "it holds with twice its force");
    doubts.look_for_twins("side_wall", &own.side_walls, "its weight and its friction count twice");
    of_side_walls(doubts, &own.side_walls, longest(case));
    let course = case.panels.iter().map(|panel| panel.brick.height.si()).fold(f64::INFINITY, f64::min);
    let highest = case.panels.iter().map(height).fold(0.0, f64::max);
    let lowest = Expected {
        limits: [LEVEL.limits[0].min(course), LEVEL.limits[1]],
        usual: [LEVEL.usual[0], LEVEL.usual[1].min(highest)],
        ..LEVEL
    };
    for (index, floor) in own.floors.iter().enumerate() {
        let key = format!("out_of_plane.floor[{index}]");
        doubts.look_because(&format!("{key}.z"), floor.z.si(), &lowest, ": no floor lies on the lowest course");
        let given = [
            ("load", floor.load, &FLOOR_LOAD),
            ("push", floor.push, &THRUST),
            ("thrust", floor.thrust, &THRUST),
            ("connection", floor.connection, &CONNECTION),
        ];
        for (name, value, expected) in given {
            doubts.look(&format!("{key}.{name}"), value.si(), expected);
        }
        doubts.look_at_sign(&format!("{key}.thrust"), floor.thrust.si(), "N/m");
        doubts.look(&format!("{key}.seat_length"), floor.seat_length.map_or(0.0, |l| l.si()), &SEAT);
        doubts.look_at_friction(&format!("{key}.seat_friction"), floor.seat_friction, LARGEST_FRICTION);
        if floor.seat_friction > 0.0 && floor.load.si() == 0.0 {
            let text = format!(
                "{key}.seat_friction is {} and does nothing: the floor's `load` is 0, and its seat rubs with a part of that; is the load left out?",
                shown(floor.seat_friction)
            );
            doubts.add(WarningKind::IdleKey, text);
        }
    }
    for (index, anchor) in own.anchors.iter().enumerate() {
        let key = format!("out_of_plane.anchor[{index}]");
        doubts.look_because(&format!("{key}.z"), anchor.z.si(), &lowest, ": a tie there holds next to nothing");
        doubts.look(&format!("{key}.yield_force"), anchor.yield_force.si(), &PULL);
        doubts.look(&format!("{key}.anchorage"), anchor.anchorage.map_or(0.0, |f| f.si()), &PULL);
        doubts.look(&format!("{key}.stiffness"), anchor.stiffness.map_or(0.0, |k| k.si()), &STIFFNESS);
        doubts.look(&format!("{key}.slack"), anchor.slack.si(), &TIE_SLACK);
        doubts.look(&format!("{key}.breaks_at"), anchor.breaks_at.map_or(0.0, |d| d.si()), &TIE_BREAK);
    }
    if let Some(gable) = &own.gable {
        let at = "out_of_plane.gable";
        doubts.look(&format!("{at}.height"), gable.height.si(), &GABLE);
        doubts.look(&format!("{at}.thickness"), gable.thickness.map_or(0.0, |t| t.si()), &THICKNESS);
        for (name, force, expected) in [
            ("ridge_load", gable.ridge_load, &RIDGE),
            ("ridge_push", gable.ridge_push, &RIDGE),
            ("ridge_thrust", gable.ridge_thrust, &RIDGE),
            ("crack_thrust", gable.crack_thrust, &PULL),
        ] {
            doubts.look(&format!("{at}.{name}"), force.si(), expected);
        }
        doubts.look_at_sign(&format!("{at}.ridge_thrust"), gable.ridge_thrust.si(), "N");
    }
    if let Some(strip) = &own.strip {
        doubts.look("out_of_plane.strip.thrust", strip.thrust.si(), &PULL);
        doubts.look_at_friction("out_of_plane.strip.friction", strip.friction, LARGEST_FRICTION);
    }
    if let Some(building) = &own.building {
        let at = "out_of_plane.building";
        doubts.look(&format!("{at}.height"), building.height.si(), &BUILDING);
        doubts.look(&format!("{at}.period"), building.period.map_or(0.0, |t| t.si()), &FIRST_PERIOD);
        doubts.look(&format!("{at}.participation"), building.participation.unwrap_or(0.0), &PARTICIPATION);
    }
    for (name, hazard) in own.site.iter().flat_map(Site::hazards) {
        let numbers = [
            ("ground_acceleration", hazard.ground_acceleration.map(|a| a.si()), &GROUND),
            ("soil_factor", hazard.soil_factor, &SOIL),
            ("amplification", hazard.amplification, &AMPLIFICATION),
            ("corner_period", hazard.corner_period.map(|t| t.si()), &CORNER),
        ];
        for (key, value, expected) in numbers {
            doubts.look(&format!("out_of_plane.site.{name}.{key}"), value.unwrap_or(0.0), expected);
        }
    }
    let grounds: Vec<(&str, f64)> =
        own.site.iter().flat_map(Site::hazards).filter_map(|(name, hazard)| Some((name, shakes(hazard)?))).collect();
    for pair in grounds.windows(2) {
        let ((often, more), (rare, less)) = (pair[0], pair[1]);
        if more > less * (1.0 + 1e-9) {
            let text = format!(
                "out_of_plane.site.{often} shakes the ground by {} m/s2, more than out_of_plane.site.{rare} by {} m/s2, which is rarer; are they exchanged?",
                shown(rounded(more, 3)),
                shown(rounded(less, 3))
            );
            doubts.add(WarningKind::UnlikelyNumber, text);
        }
    }
}

/// About the height of a panel, in which what is guessed has to lie; without end where single blocks and courses make it [m].
fn height(panel: &Panel) -> f64 {
    let course = panel.brick.height.si() + panel.mortar.bed.si();
    let regular = matches!(panel.bond, Bond::Running | Bond::Stack);
    panel.courses.filter(|_| regular).map_or(f64::INFINITY, |courses| course * courses as f64)
}

/// Floors that differ and lie on the same place: one above the other has its own level, and floors on both sides have their own half of
/// the thickness.
fn of_floors_at_one_level(doubts: &mut Doubts, floors: &[FloorLoad], case: &Case) {
    let laden = |floor: &FloorLoad| floor.load.si() > 0.0;
    let thickness = case.panels.iter().map(|panel| panel.brick.thickness.si()).fold(f64::INFINITY, f64::min);
    let half = |floor: &FloorLoad| floor.at.map(|at| at.si() > 0.5 * thickness);
    for (second, own) in floors.iter().enumerate().filter(|(_, own)| laden(own)) {
        let meets = |other: &FloorLoad| laden(other) && other != own && other.z == own.z && half(other) == half(own);
        if let Some(first) = floors[..second].iter().position(meets) {
            let [one, other, sum] = [floors[first].load.si(), own.load.si(), floors[first].load.si() + own.load.si()]
                .map(|load| shown(rounded(1e-3 * load, 4)));
            let text = format!(
                "out_of_plane.floor[{second}] lies at z = {} m as out_of_plane.floor[{first}] does: {one} and {other} kN/m both count, {sum} kN/m together; is its level meant so?",
                shown(rounded(own.z.si(), 6))
            );
            doubts.add(WarningKind::UnlikelyNumber, text);
        }
    }
}

/// The longest block of the wall [m].
fn longest(case: &Case) -> f64 {
    let of = |panel: &Panel| {
        let courses = panel.course_list.iter().flat_map(|course| &course.bricks).map(|length| length.si());
        let blocks = panel.blocks.iter().filter_map(|block| block.length).map(|length| length.si());
        let random = panel.random.map(|random| random.length[1].si());
        courses.chain(blocks).chain(random).fold(panel.brick.length.si(), f64::max)
    };
    case.panels.iter().map(of).fold(0.0, f64::max)
}

/// Side walls; `longest` is the longest block of the wall that they meet [m].
fn of_side_walls(doubts: &mut Doubts, all: &[SideWall], longest: f64) {
    for (index, side) in all.iter().enumerate() {
        let key = format!("out_of_plane.side_wall[{index}]");
        doubts.look(&format!("{key}.thickness"), side.thickness.si(), &THICKNESS);
        doubts.look(&format!("{key}.specific_weight"), side.specific_weight.map_or(0.0, |w| w.si()), &WEIGHT);
        doubts.look(&format!("{key}.load"), side.load.si(), &FLOOR_LOAD);
        doubts.look(&format!("{key}.course_height"), side.course_height.map_or(0.0, |h| h.si()), &SIDE_BLOCK);
        let overlap = Expected { limits: [SIDE_BLOCK.limits[0], longest], ..SIDE_BLOCK };
        let why = ", the longest block of the wall: blocks overlap by a part of their length";
        doubts.look_because(&format!("{key}.overlap"), side.overlap.map_or(0.0, |l| l.si()), &overlap, why);
        for (name, way) in [("first_opening", side.first_opening), ("opening_beside", side.opening_beside)] {
            doubts.look(&format!("{key}.{name}"), way.map_or(0.0, |l| l.si()), &OPENING);
        }
        if let Some(friction) = side.friction {
            doubts.look_at_friction(&format!("{key}.friction"), friction, LARGEST_FRICTION);
        }
        if let Some(corner) = &side.corner {
            for (name, force) in [("load", corner.load), ("push", corner.push), ("thrust", corner.thrust)] {
                doubts.look(&format!("{key}.corner.{name}"), force.si(), &PULL);
            }
            doubts.look_at_sign(&format!("{key}.corner.thrust"), corner.thrust.si(), "N");
        }
        let width = |other: &SideWall| 0.5 * (side.thickness.si() + other.thickness.si());
        let apart = |other: &SideWall| (side.x.si() - other.x.si()).abs();
        // Twins are told as such; of a thickness that is doubted nothing follows.
        let known = |wall: &SideWall| (THICKNESS.limits[0]..=THICKNESS.limits[1]).contains(&wall.thickness.si());
        let inside = |other: &&SideWall| {
            *other != side && known(side) && known(other) && apart(other) < width(other) * (1.0 - 1e-9)
        };
        if let Some((first, other)) = all[..index].iter().enumerate().find(|(_, other)| inside(other)) {
            let text = format!(
                "{key} stands in out_of_plane.side_wall[{first}]: their middles are {} m apart, and half of both is {} m; is one of them left over?",
                shown(rounded(apart(other), 6)),
                shown(rounded(width(other), 6))
            );
            doubts.add(WarningKind::UnlikelyNumber, text);
        }
    }
}

/// S_e(0) [m/s²]: a_g S, or the first of the columns.
pub(crate) fn shakes(hazard: &Hazard) -> Option<f64> {
    let ground = hazard.ground_acceleration.map(|a| a.si() * hazard.soil_factor.unwrap_or(1.0));
    ground.or_else(|| hazard.accelerations.first().map(|a| a.si()))
}

impl Expected {
    /// Says of a value beyond the limits that it is; `why` follows the limit. Zero is always meant.
    pub fn doubt(&self, key: &str, value: f64, why: &str) -> Option<Warning> {
        let [low, high] = self.limits;
        let size = value.abs();
        if size == 0.0 || (low..=high).contains(&size) {
            return None;
        }
        let (than, limit) = if size < low { ("less", low) } else { ("more", high) };
        let within = |v: f64| (self.usual[0]..=self.usual[1]).contains(&v);
        let fits = || self.slips.iter().filter(|(factor, ..)| within(size * factor));
        // A weight that is odd in one unit is round in the one that was meant.
        let round = |&&(factor, _, si): &&(f64, &str, f64)| {
            let number = rounded(size * factor / si, 6);
            number == rounded(number, 3)
        };
        let guess = fits().find(round).or_else(|| fits().next());
        let meant = guess.map_or(String::new(), |&(factor, unit, si)| {
            let number = shown(rounded(value * factor / si, 6));
            let number = if unit.is_empty() { number } else { format!("\"{number} {unit}\"") };
            format!("; did you mean {number}?")
        });
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let text =
            format!("{key} is {}{unit}, {than} than {}{unit}{why}{meant}", shown(rounded(value, 6)), shown(limit));
        Some(Warning::new(WarningKind::UnlikelyNumber, text))
    }
}

struct Doubts(Vec<Warning>);

impl Doubts {
    fn add(&mut self, kind: WarningKind, text: impl Into<String>) {
        self.0.push(Warning::new(kind, text));
    }

    /// Zero is always meant.
    fn look(&mut self, key: &str, value: f64, expected: &Expected) {
        self.look_because(key, value, expected, "");
    }

    /// [`Doubts::look`], with what follows the limit in the message.
    fn look_because(&mut self, key: &str, value: f64, expected: &Expected, why: &str) {
        self.0.extend(expected.doubt(key, value, why));
    }

    /// Thrusts are positive outwards: one that is not holds the wall.
    fn look_at_sign(&mut self, key: &str, thrust: f64, unit: &str) {
        if thrust < 0.0 {
            let [thrust, meant] = [thrust, -thrust].map(|v| shown(rounded(v, 6)));
            let text = format!(
                "{key} is {thrust} {unit}: a thrust is positive outwards, and this one holds the wall upright; did you mean {meant} {unit}?"
            );
            self.add(WarningKind::UnlikelyNumber, text);
        }
    }

    /// What stands in a list of `[out_of_plane]` twice, number for number.
    fn look_for_twins<T: PartialEq>(&mut self, list: &str, all: &[T], so: &str) {
        for (second, own) in all.iter().enumerate() {
            if let Some(first) = all[..second].iter().position(|other| other == own) {
                let key = format!("out_of_plane.{list}");
                let text = format!("{key}[{second}] is the same as {key}[{first}]: {so}; is one of them left over?");
                self.add(WarningKind::UnlikelyNumber, text);
            }
        }
    }

    fn look_at_normal_to_shear(&mut self, key: &str, ratio: f64) {
        if ratio < LEAST_NORMAL_TO_SHEAR {
            let text = format!(
                "{key} is {}, less than {}: k_n/k_s, and joints are stiffer pressed than sheared; did you mean {}?",
                shown(ratio),
                shown(LEAST_NORMAL_TO_SHEAR),
                shown(rounded(1.0 / ratio, 3))
            );
            self.add(WarningKind::UnlikelyNumber, text);
        }
    }

    fn look_at_stiffness(&mut self, key: &str, stiffness: Stiffness) {
        let expected = match stiffness {
            Stiffness::PerJoint(_) => &STIFFNESS,
            Stiffness::PerArea(_) => &STIFFNESS_PER_AREA,
        };
        self.look(key, stiffness.amount(), expected);
    }

    /// Of joints as a rule: single ones may have sheets that slide.
    fn look_at_slippery(&mut self, key: &str, coefficient: f64) {
        if coefficient > 0.0 && coefficient < LEAST_FRICTION {
            let text = format!("{key} is {}, less than {LEAST_FRICTION}{RUBS}", shown(rounded(coefficient, 6)));
            self.add(WarningKind::UnlikelyNumber, text);
        }
    }

    fn look_at_friction(&mut self, key: &str, coefficient: f64, largest: f64) {
        if coefficient > largest {
            let tangent = (LEAST_ANGLE..90.0).contains(&coefficient).then(|| (coefficient * PI / 180.0).tan());
            let meant = tangent.map_or(RUBS.into(), |t| {
                format!("; did you mean {:.2}, the tangent of {} degrees?", t, shown(coefficient))
            });
            let text = format!("{key} is {}, more than {largest}{meant}", shown(rounded(coefficient, 6)));
            self.add(WarningKind::UnlikelyNumber, text);
        }
    }
}

/// Peak accelerations of a motion, below `motion.base`, `motion.top` and `motion.vertical`.
const ACCELERATIONS: [&str; 6] =
    ["pga", "sine.acceleration", "tilt.acceleration", "pulse.acceleration", "sweep.acceleration", "synthetic.pga"];
/// Bare accelerations below this [m/s²], 0.15 g, shake few walls, and as multiples of g are what is mostly tested.
const SMALL_SHAKING: f64 = 1.5;
/// Bare columns of a spectrum whose largest is below this [m/s²]: F0 = 2.4 times that.
const SMALL_SPECTRUM: f64 = 2.4 * SMALL_SHAKING;

/// A number without a unit.
fn bare(node: &Node) -> Option<f64> {
    match node.value {
        Value::Float(v) => Some(v),
        Value::Int(i) => Some(i as f64),
        _ => None,
    }
}

/// Columns of accelerations without a unit, all of them small.
fn bare_columns(key: &str, node: Option<&Node>) -> Option<Warning> {
    let Value::List(all) = &node?.value else { return None };
    bare_list(key, all.iter().map(bare))
}

/// Accelerations at `key` [m/s²], all of them so small that they read like multiples of g; none stands for one with a unit, which says that the
/// others are meant as they stand.
pub fn bare_list(key: &str, all: impl IntoIterator<Item = Option<f64>>) -> Option<Warning> {
    let values: Vec<f64> = all.into_iter().collect::<Option<_>>()?;
    let largest = values.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    (SHAKING.limits[0]..SMALL_SPECTRUM).contains(&largest).then(|| {
        let largest = shown(largest);
        let text = format!(
            "{key} go up to {largest} m/s2, numbers without a unit; did you mean \"{largest} g\", and so each of them?"
        );
        Warning::new(WarningKind::UnlikelyNumber, text)
    })
}

/// Peaks that `motion.base` and others name, of [`ACCELERATIONS`]: that of a test with sines may be as small as one likes.
const PEAKS: [&str; 2] = ["pga", "synthetic.pga"];
/// Peaks in a unit of length over time squared that shake no wall [m/s²], and those of the limit state of damage in regions that are hardly shaken.
const NO_SHAKING: f64 = 0.03 * crate::G;
const NO_DAMAGE: f64 = 0.015 * crate::G;

/// Tables of a wall file that [`by_units`] looks at.
pub(super) const WITH_UNITS: [&str; 3] = ["panel", "motion", "out_of_plane"];

/// What only the way in which numbers are written shows: [`bare_accelerations`], [`odd_accelerations`], [`bare_weights`].
pub(super) fn by_units(tree: &Node) -> Vec<Warning> {
    [bare_weights(tree), bare_accelerations(tree), odd_accelerations(tree)].concat()
}

/// The elements of a list, each with its key.
fn listed<'n>(node: Option<&'n Node>, at: &str) -> Vec<(String, &'n Node)> {
    let Some(Value::List(all)) = node.map(|node| &node.value) else { return Vec::new() };
    all.iter().enumerate().map(|(k, node)| (format!("{at}[{k}]"), node)).collect()
}

/// One sentence for each specific weight without a unit that reads like a density of stone. Smaller ones are beyond the limits of weights.
fn bare_weights(tree: &Node) -> Vec<Warning> {
    let mut holders = Vec::new();
    for (at, panel) in listed(tree.get("panel"), "panel") {
        holders.extend(panel.get("brick").map(|brick| (format!("{at}.brick"), brick)));
        holders.extend(listed(panel.get("block"), &format!("{at}.block")));
        let openings = listed(panel.get("opening"), &format!("{at}.opening"));
        holders.extend(openings.into_iter().filter_map(|(at, o)| Some((format!("{at}.lintel"), o.get("lintel")?))));
    }
    let sides = tree.get("out_of_plane").and_then(|own| own.get("side_wall"));
    holders.extend(listed(sides, "out_of_plane.side_wall"));
    let doubt = |(at, holder): (String, &Node)| {
        let weight = bare(holder.get("specific_weight")?).filter(|w| (WEIGHT.limits[0]..=DENSE).contains(w))?;
        let weight = shown(weight);
        let text = format!(
            "{at}.specific_weight is {weight} N/m3, a number without a unit, as light as aerated concrete; did you mean \"{weight} kg/m3\"?"
        );
        Some(Warning::new(WarningKind::UnlikelyNumber, text))
    };
    holders.into_iter().filter_map(doubt).collect()
}

/// One sentence for each peak with a unit of length over time squared that shakes no wall.
fn odd_accelerations(tree: &Node) -> Vec<Warning> {
    let ends = ["base", "top", "vertical"].into_iter();
    let motions = ends.flat_map(|end| PEAKS.map(|key| (format!("motion.{end}.{key}"), &SHAKING, NO_SHAKING)));
    let least = |name: &str| if name == "damage" { NO_DAMAGE } else { NO_SHAKING };
    let sites = Site::NAMES.map(|name| (format!("out_of_plane.site.{name}.ground_acceleration"), &GROUND, least(name)));
    let doubt = |(key, expected, least): (String, &Expected, f64)| {
        let Value::Text(text) = &key.split('.').try_fold(tree, |node, step| node.get(step))?.value else { return None };
        let text = text.trim();
        let peak = Acceleration::parse(text).ok()?.si();
        // What is less than any is doubted where it is read.
        let weak = peak >= expected.limits[0] && peak < least && text.contains('/');
        weak.then(|| {
            let number: Option<f64> = quantity::parts(text).0.parse().ok();
            let guess = number.into_iter().flat_map(|v| [v, 1e-2 * v]).find(|v| (0.05..=2.0).contains(v));
            let meant = guess.map_or(String::new(), |v| format!("; did you mean \"{} g\"?", shown(rounded(v, 6))));
            let peak = shown(rounded(peak / crate::G, 3));
            Warning::new(
                WarningKind::UnlikelyNumber,
                format!("{key} is {text}, {peak} g, which hardly shakes a wall{meant}"),
            )
        })
    };
    motions.chain(sites).filter_map(doubt).collect()
}

/// One sentence for each peak acceleration and each spectrum written without a unit that reads like a multiple of g.
fn bare_accelerations(tree: &Node) -> Vec<Warning> {
    let motions =
        ["base", "top", "vertical"].into_iter().flat_map(|end| ACCELERATIONS.map(|key| format!("motion.{end}.{key}")));
    let sites = Site::NAMES.map(|name| format!("out_of_plane.site.{name}.ground_acceleration"));
    let keys = motions.chain(sites);
    let doubt = |key: String| {
        let value = bare(key.split('.').try_fold(tree, |node, step| node.get(step))?)?;
        let small = value.abs() >= SHAKING.limits[0] && value.abs() < SMALL_SHAKING;
        small.then(|| {
            let value = shown(value);
            let text = format!("{key} is {value} m/s2, a number without a unit; did you mean \"{value} g\"?");
            Warning::new(WarningKind::UnlikelyNumber, text)
        })
    };
    let own = tree.get("out_of_plane");
    let site = own.and_then(|own| own.get("site"));
    let columns = |node: Option<&Node>, at: String| {
        bare_columns(&format!("{at}.accelerations"), node.and_then(|node| node.get("accelerations")))
    };
    let spectra =
        Site::NAMES.into_iter().map(|name| (site.and_then(|site| site.get(name)), format!("out_of_plane.site.{name}")));
    let floors = match own.and_then(|own| own.get("floor_spectrum")).map(|node| &node.value) {
        Some(Value::List(floors)) => &floors[..],
        _ => &[],
    };
    let floors = floors.iter().enumerate().map(|(k, node)| (Some(node), format!("out_of_plane.floor_spectrum[{k}]")));
    keys.filter_map(doubt).chain(spectra.chain(floors).filter_map(|(node, at)| columns(node, at))).collect()
}

/// With so many significant digits: conversions leave traces in the last ones.
pub fn rounded(v: f64, digits: usize) -> f64 {
    format!("{v:.*e}", digits - 1).parse().unwrap_or(v)
}

/// The next number of two digits.
fn raised(v: f64) -> f64 {
    let digit = 10f64.powf(v.log10().floor() - 1.0);
    rounded((v / digit - 1e-9).ceil() * digit, 3)
}

/// Height and thickness of bricks over their length. Roman tiles are 1 : 13 high; walls are as thick as some bricks are long.
const PROPORTIONS: [(&str, [f64; 2]); 2] = [("height", [0.05, 50.0]), ("thickness", [0.06, 4.0])];
/// Height over length of bricks side by side: posts and blocks that rock stand alone.
const UPRIGHT: f64 = 2.0;
/// Height of the flattest courses [m]: a brick that stands on end is no slip where a tenth of its height is less.
const FLATTEST: f64 = 0.045;

/// Sides that are likely by themselves, and not beside each other. Façades are thicker than their bricks are long.
fn of_proportions(doubts: &mut Doubts, at: &str, panel: &Panel, facade: bool) {
    let brick: &Brick = &panel.brick;
    let known = |v: f64| (BRICK.limits[0]..=BRICK.limits[1]).contains(&v);
    let length = brick.length.si();
    let bonded = panel.courses.is_some_and(|n| n > 1) && panel.bricks.is_some_and(|n| n > 1);
    for ((key, [least, most]), side) in PROPORTIONS.into_iter().zip([brick.height.si(), brick.thickness.si()]) {
        let slip = 0.1 * side >= FLATTEST;
        let most = if key == "height" && bonded && slip { UPRIGHT } else { most };
        // A wall may be given by the metre of its depth.
        let most = if facade || side == 1.0 { f64::INFINITY } else { most };
        if known(length) && known(side) && !(least..=most).contains(&(side / length)) {
            let low = side < length;
            let bound = if low { format!("at least {least}") } else { format!("at most {most}") };
            let meant = if low { 10.0 * side } else { 0.1 * side };
            let [part, side, meant, length] =
                [rounded(side / length, 2), side, meant, length].map(|v| shown(rounded(v, 6)));
            let text = format!(
                "{at}.{key} is {side} m, {part} times the length of {length} m: bricks have {bound}; did you mean \"{meant} m\"?"
            );
            doubts.add(WarningKind::UnlikelyNumber, text);
        }
    }
}

/// How far a course may end from those beside it, over the length of the reference brick: toothed ends have half of it.
const BESIDE: f64 = 0.55;
/// The same where all the others, of so many courses at least, end flush: within so much.
const FLUSH: f64 = 0.2;
const FLUSH_COURSES: usize = 5;
const WITHIN: f64 = 0.05;
/// Lengths of stones over that of the reference brick, from chips between them to lintels.
const STONES: [f64; 2] = [0.1, 8.0];
/// How near a length that is guessed brings the end of its course to those beside it, over the length of the reference brick.
const FITS: f64 = 0.25;

/// Part of the courses that may end apart; more of them are a pattern, such as quoins and toothing.
const PATTERN: f64 = 0.25;

/// Courses that end where those beside them do not, and stones of another size than all others: slips in what was measured.
fn of_courses(doubts: &mut Doubts, at: &str, panel: &Panel) {
    let brick = panel.brick.length.si();
    let odd = odd_courses(panel);
    if let Some(first) = odd.first().filter(|_| odd.len() as f64 <= (PATTERN * panel.course_list.len() as f64).max(1.0))
    {
        doubts.add(WarningKind::UnlikelyNumber, first.told(at, brick, odd.len()));
    }
    let courses = panel.course_list.iter().enumerate().filter(|(c, _)| odd.iter().all(|odd| odd.course != *c));
    for (c, course) in courses {
        let lengths = course.bricks.iter().map(|length| length.si()).enumerate();
        for (b, length) in lengths.filter(|(_, length)| (BRICK.limits[0]..=BRICK.limits[1]).contains(length)) {
            let [least, most] = STONES;
            let part = length / brick;
            if !(least..=most).contains(&part) {
                let bound = if part < least { format!("at least {least}") } else { format!("at most {most}") };
                let [part, length, brick] = [rounded(part, 2), length, brick].map(|v| shown(rounded(v, 6)));
                let text = format!(
                    "{at}.course[{c}].bricks[{b}] is {length} m, {part} times the panel's brick of {brick} m: stones have {bound}; look at both"
                );
                doubts.add(WarningKind::UnlikelyNumber, text);
            }
        }
    }
}

/// A course that ends apart from those beside it.
struct OddCourse {
    course: usize,
    /// Those beside it.
    beside: Vec<usize>,
    /// Ends of it and of those [m].
    ends: Vec<[f64; 2]>,
    /// Whether all others end flush.
    flush: bool,
    /// The brick that makes it so, and its length then [m].
    meant: Option<(usize, f64)>,
}

impl OddCourse {
    /// `count`: how many such courses the panel has.
    fn told(&self, at: &str, brick: f64, count: usize) -> String {
        let from_to = |[from, to]: [f64; 2]| format!("from {} to {} m", shown(rounded(from, 6)), shown(rounded(to, 6)));
        let others = self.beside.iter().zip(&self.ends[1..]);
        let others: Vec<String> = others.map(|(k, ends)| format!("course[{k}] {}", from_to(*ends))).collect();
        let meant = self.meant.map_or("look at its `bricks` and `offset`".into(), |(b, length)| {
            format!("did you mean bricks[{b}] = \"{} mm\"?", shown(rounded(1e3 * length, 6)))
        });
        let more = if count > 1 { format!(" ({count} courses of this panel do so)") } else { String::new() };
        let part = if self.flush { "a fifth of a" } else { "half a" };
        format!(
            "{at}.course[{}] goes {}, and beside it {}: they end more than {part} brick of {} m apart{more}; {meant}",
            self.course,
            from_to(self.ends[0]),
            others.join(" and "),
            shown(brick)
        )
    }
}

/// Courses that end apart from those beside them. A wall may end ruined, on a footing or with a step: the first and the last course, and those of
/// two, count only where one brick explains it. So does that between two equal ones of a wall of three: it may be a pattern.
fn odd_courses(panel: &Panel) -> Vec<OddCourse> {
    let brick = panel.brick.length.si();
    let ends: Vec<[f64; 2]> = panel.course_list.iter().map(|course| course.ends(panel.mortar.head)).collect();
    let odd = |(c, course): (usize, &Course)| {
        let flush = ends.len() >= FLUSH_COURSES && others_are_flush(&ends, c, WITHIN * brick);
        let beside = apart(&ends, c, brick * if flush { FLUSH } else { BESIDE })?;
        let meant = slipped(course, ends[c][1] - ends[beside[0]][1], brick);
        let inner = c > 0 && c + 1 < ends.len();
        let pattern = ends.len() == 3 && panel.course_list[beside[0]] == panel.course_list[beside[1]];
        let ends = std::iter::once(&c).chain(&beside).map(|&k| ends[k]).collect();
        (inner && !pattern || meant.is_some()).then_some(OddCourse { course: c, beside, ends, flush, meant })
    };
    panel.course_list.iter().enumerate().filter_map(odd).collect()
}

/// Whether all courses but one end together `within` so much [m].
fn others_are_flush(ends: &[[f64; 2]], course: usize, within: f64) -> bool {
    [0, 1].into_iter().all(|side| {
        let others = ends.iter().enumerate().filter(|(k, _)| *k != course).map(|(_, ends)| ends[side]);
        let [least, most] =
            others.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], end| [least.min(end), most.max(end)]);
        most - least <= within
    })
}

/// The courses beside one that end together, where it ends more than `far` [m] from both: gables and steps go on from course to course.
fn apart(ends: &[[f64; 2]], course: usize, far: f64) -> Option<Vec<usize>> {
    let beside = match (course, ends.len()) {
        (_, 0..=1) => return None,
        (k, 2) => vec![1 - k],
        (0, _) => vec![1, 2],
        (k, n) if k + 1 == n => vec![n - 2, n - 3],
        (k, _) => vec![k - 1, k + 1],
    };
    let together = |side: usize| beside.iter().all(|&k| (ends[k][side] - ends[beside[0]][side]).abs() <= far);
    let way = |side: usize| {
        let ways = beside.iter().map(|&k| ends[course][side] - ends[k][side]);
        ways.fold(f64::INFINITY, |least, way| if way.abs() < f64::abs(least) { way } else { least })
    };
    let [left, right] = [0, 1].map(way);
    let odd = [left, right].map(|way| way.abs() > far);
    // Wider or narrower at both ends, as footings and cornices are, is meant.
    let meant = odd == [true, true] && left * right < 0.0;
    ((odd[0] || odd[1]) && !meant && together(0) && together(1)).then_some(beside)
}

/// The brick of a course whose length, with its point moved, takes away that the course is too long by `excess` [m], and is nearer to that of the
/// reference brick of `brick` [m] then; its length then [m].
fn slipped(course: &Course, excess: f64, brick: f64) -> Option<(usize, f64)> {
    let factors = [0.1, 10.0, 1e-2, 1e2, 1e-3, 1e3];
    let lengths = course.bricks.iter().map(|length| length.si()).enumerate();
    let moved = lengths.flat_map(|(b, length)| factors.map(|factor| (b, length, factor * length)));
    let odd = |length: f64| (length / brick).ln().abs();
    let moved = moved.filter(|(_, length, meant)| excess.abs() > BESIDE * brick && odd(*meant) < odd(*length));
    let left = |&(_, length, meant): &(usize, f64, f64)| (excess - (length - meant)).abs();
    let best = moved.min_by(|a, b| left(a).total_cmp(&left(b))).filter(|found| left(found) <= FITS * brick)?;
    Some((best.0, best.2))
}

fn of_panel(doubts: &mut Doubts, at: &str, panel: &Panel) {
    let brick = &panel.brick;
    for (key, value) in [("length", brick.length), ("height", brick.height), ("thickness", brick.thickness)] {
        doubts.look(&format!("{at}.brick.{key}"), value.si(), &BRICK);
    }
    doubts.look(&format!("{at}.brick.specific_weight"), brick.specific_weight.si(), &WEIGHT);
    doubts.look(&format!("{at}.mortar.bed"), panel.mortar.bed.si(), &MORTAR);
    doubts.look(&format!("{at}.mortar.head"), panel.mortar.head.si(), &MORTAR);
    if let Some(connection) = panel.connection {
        doubts.look(&format!("{at}.connection"), connection.si(), &MORTAR);
    }
    for (c, course) in panel.course_list.iter().enumerate() {
        doubts.look(&format!("{at}.course[{c}].height"), course.height.si(), &BRICK);
        for (b, length) in course.bricks.iter().enumerate() {
            doubts.look(&format!("{at}.course[{c}].bricks[{b}]"), length.si(), &BRICK);
        }
    }
    if let Some(random) = &panel.random {
        doubts.look(&format!("{at}.random.width"), random.width.si(), &PANEL);
        for (key, [low, high]) in [("length", random.length), ("height", random.height)] {
            doubts.look(&format!("{at}.random.{key}[0]"), low.si(), &BRICK);
            doubts.look(&format!("{at}.random.{key}[1]"), high.si(), &BRICK);
        }
    }
    if let Some(arch) = panel.arch {
        doubts.look(&format!("{at}.arch.span"), arch.span.si(), &PANEL);
        // A guess beyond half the span would be refused.
        let rise = Expected { usual: [PANEL.usual[0], PANEL.usual[1].min(0.5 * arch.span.si())], ..PANEL };
        doubts.look(&format!("{at}.arch.rise"), arch.rise.si(), &rise);
        doubts.look(&format!("{at}.arch.thickness"), arch.thickness.si(), &BRICK);
        doubts.look(&format!("{at}.arch.springing"), arch.springing.si(), &PANEL);
    }
    for (o, opening) in panel.openings.iter().enumerate() {
        let at = format!("{at}.opening[{o}]");
        for (key, value) in [("x", opening.x), ("y", opening.y), ("width", opening.width), ("height", opening.height)] {
            doubts.look(&format!("{at}.{key}"), value.length().unwrap_or(0.0), &OPENING);
        }
        if let Some(lintel) = opening.lintel {
            for (key, extent) in [("height", lintel.height), ("bearing", lintel.bearing)] {
                doubts.look(&format!("{at}.lintel.{key}"), extent.length().unwrap_or(0.0), &BRICK);
            }
            if let (Some(bearing), Some(width)) = (lintel.bearing.length(), opening.width.length()) {
                of_bearing(doubts, &format!("{at}.lintel.bearing"), bearing, width);
            }
            if let Some(weight) = lintel.specific_weight {
                doubts.look(&format!("{at}.lintel.specific_weight"), weight.si(), &WEIGHT);
            }
        }
    }
    for (b, block) in panel.blocks.iter().enumerate() {
        for (key, side) in [("length", block.length), ("height", block.height)] {
            if let Some(side) = side {
                doubts.look(&format!("{at}.block[{b}].{key}"), side.si(), &BRICK);
            }
        }
        if !block.corners.is_empty() {
            let [x, y] = crate::polygon::bounds(&block.outline());
            doubts.look(&format!("the size of {at}.block[{b}]"), (x[1] - x[0]).max(y[1] - y[0]), &BRICK);
        }
        if let Some(weight) = block.specific_weight {
            doubts.look(&format!("{at}.block[{b}].specific_weight"), weight.si(), &WEIGHT);
        }
    }
}

/// Least bearing of a lintel over its span: builders' rules have 0.1.
const BEARING: f64 = 0.02;

/// A bearing that is little beside the span [m]; models of walls have small ones. Beyond the limits of bricks it is told already.
fn of_bearing(doubts: &mut Doubts, key: &str, bearing: f64, width: f64) {
    if bearing >= BRICK.limits[0] && bearing < BEARING * width {
        let [bearing, least, width] = [bearing, BEARING * width, width].map(|v| shown(rounded(1e3 * v, 6)));
        let text = format!(
            "{key} is {bearing} mm, under a span of {width} mm less than {least} mm, a fiftieth: at the least opening of the joints the lintel falls; lintels lie on a tenth"
        );
        doubts.add(WarningKind::UnlikelyNumber, text);
    }
}

/// Way of a driven top in a step without inertia from which it is told [m].
const LONG_WAY: f64 = 0.1001e-3;
/// By how much of g a tilt may grow in a step of a run without inertia.
const STEEP: f64 = 5e-3;
/// Pressure up to which a joint without a strength is looked at [Pa]: toes of laboratory walls reach some MPa.
const MOST_PRESSED: f64 = 5e6;

/// What is right in shear walls, whose joints cannot open, and hardly meant where they can.
fn of_planar(doubts: &mut Doubts, case: &Case) {
    let (given, own) = (&case.solver, Solver::default());
    let idle = [
        ("scheme", given.scheme != own.scheme),
        ("tolerance", given.tolerance != own.tolerance),
        ("max_step", given.max_step.is_some()),
        ("floor", given.floor != own.floor),
    ];
    for (key, _) in idle.into_iter().filter(|(_, given)| *given) {
        let text = format!("solver.{key} does nothing in a planar wall, whose steps have one length: `solver.step`");
        doubts.add(WarningKind::IdleKey, text);
    }
    let joint = &case.joint;
    if joint.bed.law.is_no_tension() && joint.bed.rigidity > STIFFER {
        let text = format!(
            "joint.bed is `no-tension`: pressed bed joints of this planar wall are rigidity = {} times as stiff as `stiffness` \
             says; `rigidity = 1` makes them as stiff as that",
            shown(joint.bed.rigidity)
        );
        doubts.add(WarningKind::UnlikelyJoint, text);
    }
    let step = case.planar_step();
    for (i, force) in case.forces.iter().enumerate() {
        let Some(every) = force.every.map(|every| every.si()).filter(|_| force.x.len().max(force.y.len()) > 1) else {
            continue;
        };
        let steps = every / step;
        if (steps - steps.round()).abs() > WHOLE_STEPS {
            let text = format!(
                "force[{i}].every is {} s, {} steps: each value acts in whole steps, and its impulse is up to {} % off; choose a solver.step that divides it",
                shown(rounded(every, 6)),
                shown(rounded(steps, 4)),
                shown(rounded(100.0 / steps, 2))
            );
            doubts.add(WarningKind::UnlikelyNumber, text);
        }
    }
    if case.motion.quasi_static {
        let signals = [("base", &case.motion.base), ("vertical", &case.motion.vertical)];
        let shakes = |signal: &Signal| !matches!(signal, Signal::None | Signal::Tilt(_));
        for (key, _) in signals.into_iter().filter(|(_, signal)| shakes(signal)) {
            let text = format!(
                "motion.{key} is a motion, and `quasi_static` leaves inertia out: its accelerations act as forces that change slowly, which is \
                 no earthquake analysis; a load that grows is `base = {{ tilt = … }}`"
            );
            doubts.add(WarningKind::StillMotion, text);
        }
        if let Signal::Tilt(tilt) = &case.motion.base {
            let more = tilt.acceleration.si().abs() * case.planar_step() / tilt.rise.si() / crate::G;
            if more > STEEP {
                let rise = raised(tilt.rise.si() * more / STEEP);
                let end = rounded(tilt.start.si() + rise, 6);
                let short = case.motion.duration.is_none_or(|duration| duration.si() < end);
                let too = if short {
                    format!(", and motion.duration {} s, or the run ends before", shown(end))
                } else {
                    String::new()
                };
                let text = format!(
                    "motion.base.tilt grows by {} g in every step of this `quasi_static` run: what the wall bears is known no better, and a wall that \
                     begins to fall is told to bear what comes on it meanwhile. Let `rise` be {} s or longer{too}",
                    shown(rounded(more, 2)),
                    shown(rise),
                );
                doubts.add(WarningKind::UnlikelyNumber, text);
            }
        }
        if let Signal::Path(path) = &case.motion.top {
            let way = path.speed.si() * case.planar_step();
            if way > LONG_WAY {
                let text = format!(
                    "motion.top.path.speed moves the top by {} mm in every step of this `quasi_static` run: forces depend on that, and may be far off. \
                     Up to 0.1 mm, or a ten-thousandth of the height, changes them by less than a hundredth",
                    shown(rounded(1e3 * way, 3))
                );
                doubts.add(WarningKind::UnlikelyNumber, text);
            }
        }
    }
    let changed = joint.changes.iter().any(|change| change.bond.is_some());
    let beds = |kinds: &[JointKind]| kinds.is_empty() || kinds.contains(&JointKind::Bed);
    let bonds_beds = joint.changes.iter().any(|change| change.bond.is_some() && beds(&change.at.kind));
    let dry = joint.bond.is_none() && !joint.bed.law.is_elastic() && !changed;
    let rubs = joint.changes.iter().any(|change| change.friction.is_some());
    if dry && joint.friction.law == FrictionLaw::None && joint.friction.preset.is_none() && !rubs {
        let text = "joint.friction is missing or of law `none`: dry joints of this planar wall slide at the least push; stones have a `static` of 0.4 to 0.8";
        doubts.add(WarningKind::UnlikelyJoint, text);
    }
    match &joint.bond {
        None if joint.bed.law.is_elastic() && !bonds_beds => doubts.add(
            WarningKind::UnlikelyJoint,
            "joint.bed is `elastic` without a bond: in a planar wall such joints pull without limit, and bear shear without limit beside \
             friction; dry joints are `no-tension` with `rigidity = 1`, or `rigid`",
        ),
        Some(bond) if (bond.tensile_strength.si() > 0.0) != (bond.cohesion.si() > 0.0) => {
            let missing = if bond.cohesion.si() > 0.0 { "tensile_strength" } else { "cohesion" };
            let text = format!(
                "joint.bond.{missing} is 0: joints of a planar wall are pulled and sheared, and those without it crack almost at once"
            );
            doubts.add(WarningKind::UnlikelyJoint, text);
        }
        _ => {}
    }
    if let Some(bond) = &joint.bond {
        of_bond(doubts, joint, bond);
    }
}

/// Bonds of planar walls that are weaker than what is to be left of them, or stronger than they may be.
fn of_bond(doubts: &mut Doubts, joint: &Joints, bond: &JointBond) {
    let (tan, cohesion, tension) = (bond.friction_angle.si().tan(), bond.cohesion.si(), bond.tensile_strength.si());
    let mega = |pascal: f64| shown(rounded(1e-6 * pascal, 3));
    if tan > 0.0 && cohesion > 0.0 && tension > cohesion / tan * (1.0 + 1e-9) {
        let text = format!(
            "joint.bond.tensile_strength is {} MPa, above cohesion/tan(friction_angle) = {} MPa, where its friction ends: such a joint is pulled apart by more \
             than shear would leave of it; mortar has less than half of that",
            mega(tension),
            mega(cohesion / tan),
        );
        doubts.add(WarningKind::UnlikelyNumber, text);
    }
    let friction = &joint.friction;
    let none = friction.law == FrictionLaw::None && friction.preset.is_none();
    if none && tan > 0.0 && !joint.changes.iter().any(|change| change.friction.is_some_and(|f| f.law.is_some())) {
        let text = "joint.friction is missing or of law `none` beside a bond with a friction_angle: joints that have cracked bear no shear at all. Masonry has \
                    `friction = { law = \"coulomb\", static = … }` of about the tangent of that angle";
        doubts.add(WarningKind::UnlikelyJoint, text);
    }
    let strengths =
        [Some(joint.bed), joint.base, joint.top].into_iter().flatten().filter_map(|s| s.compressive_strength);
    let crushed = strengths.map(|s| s.si()).fold(MOST_PRESSED, f64::min);
    let static_ = if none { 0.0 } else { friction.static_ };
    let from = cohesion / (static_ - tan);
    if static_ > tan && from < crushed {
        let text = format!(
            "joint.friction.static is {}, above tan(friction_angle) = {}: from a pressure of {} MPa on, c/(μ_s − tan φ), joints are stronger cracked than \
             whole, and a wall whose toes are pressed harder bears more than its bonds do",
            shown(static_),
            shown(rounded(tan, 3)),
            mega(from),
        );
        doubts.add(WarningKind::UnlikelyJoint, text);
    }
}

/// What a stiffness of the half-brick bed joint is per area, where that is too little to be meant.
fn of_whole_joint(doubts: &mut Doubts, whole: f64, brick: [f64; 2]) {
    let area = 0.5 * brick[0] * brick[1];
    let within = |x: f64, expected: &Expected| (expected.limits[0]..=expected.limits[1]).contains(&x);
    // What is doubted by itself says nothing here.
    let known = within(whole, &STIFFNESS) && brick.into_iter().all(|side| within(side, &BRICK));
    if known && whole < SOFTEST * area {
        let text = format!(
            "joint.bed.stiffness is {} N/m of a bed joint of half a brick, {} N/mm3, softer than rubber; did you mean \"{} N/mm3\"?",
            shown(rounded(whole, 6)),
            shown(rounded(1e-9 * whole / area, 2)),
            shown(rounded(1e-3 * whole, 6)),
        );
        doubts.add(WarningKind::UnlikelyNumber, text);
    }
}

/// Modulus of masonry all of whose deformation is in its joints [Pa], twice that of the stiffest stone.
const STIFFEST: f64 = 2e11;

/// Springs of bed and head joints that make masonry stiffer than any stone.
fn of_modulus(doubts: &mut Doubts, case: &Case) {
    // Elsewhere the brick is a reference alone.
    let regular = |panel: &&Panel| matches!(panel.bond, Bond::Running | Bond::Stack | Bond::Irregular);
    let (joint, Some(panel)) = (&case.joint, case.panels.iter().find(regular)) else { return };
    let share = if panel.bond == Bond::Stack { 1.0 } else { 0.5 };
    let (brick, mortar) = (&panel.brick, &panel.mortar);
    let [length, height, thickness] = [brick.length, brick.height, brick.thickness].map(|side| side.si());
    // k_n of bed joints of planar walls; shear walls have k_s alone.
    let across = if case.model == ModelKind::Planar { joint.bed.normal_to_shear } else { 1.0 };
    let joints = [
        ("bed", &joint.bed, across, height + mortar.bed.si(), share * length * thickness),
        ("head", &joint.head, 1.0, length + mortar.head.si(), height * thickness),
    ];
    for (kind, spring, times, pitch, area) in joints.into_iter().filter(|(_, spring, ..)| spring.law.has_springs()) {
        let (limits, per_area, unit, si) = match spring.stiffness {
            Stiffness::PerArea(k) => (STIFFNESS_PER_AREA.limits, k.si(), "N/mm3", 1e9),
            Stiffness::PerJoint(k) => (STIFFNESS.limits, k.si() / area, "MN/m", 1e6),
        };
        let (given, modulus) = (spring.stiffness.amount() / si, times * per_area * pitch);
        // Beyond its own limits it is told already, and so are bricks.
        let sides = [length, height, thickness].iter().all(|side| (BRICK.limits[0]..=BRICK.limits[1]).contains(side));
        let known = sides && spring.stiffness.amount() <= limits[1];
        if known && modulus > STIFFEST {
            let [given, meant] = [given, 1e-3 * given].map(|v| shown(rounded(v, 6)));
            let text = format!(
                "joint.{kind}.stiffness is {given} {unit}: over {} m from joint to joint the masonry would have a modulus of {} GPa, more than 200 GPa, twice the stiffest stone; \
                 did you mean \"{meant} {unit}\"?",
                shown(rounded(pitch, 4)),
                shown(rounded(1e-9 * modulus, 3)),
            );
            doubts.add(WarningKind::UnlikelyNumber, text);
        }
    }
}

fn of_joints(doubts: &mut Doubts, case: &Case) {
    of_modulus(doubts, case);
    let joint = &case.joint;
    let others = [("base", joint.base), ("top", joint.top), ("connection", joint.connection)];
    let springs = [("bed", Some(joint.bed)), ("head", Some(joint.head))].into_iter().chain(others);
    for (kind, spring) in springs {
        if let Some(spring) = spring {
            doubts.look_at_stiffness(&format!("joint.{kind}.stiffness"), spring.stiffness);
            if kind == "bed"
                && let (Stiffness::PerJoint(whole), Some(panel)) = (spring.stiffness, case.panels.first())
            {
                of_whole_joint(doubts, whole.si(), [panel.brick.length.si(), panel.brick.thickness.si()]);
            }
            doubts.look_at_normal_to_shear(&format!("joint.{kind}.normal_to_shear"), spring.normal_to_shear);
            if let Some(strength) = spring.compressive_strength {
                doubts.look(&format!("joint.{kind}.compressive_strength"), strength.si(), &COMPRESSION);
            }
        }
    }
    // Sets hold what was measured, split stones among it.
    let largest = if case.set.is_some() { LARGEST_HELD } else { LARGEST_FRICTION };
    doubts.look_at_friction("joint.friction.static", joint.friction.static_, largest);
    doubts.look_at_slippery("joint.friction.static", joint.friction.static_);
    if joint.friction.dynamic != joint.friction.static_ {
        doubts.look_at_slippery("joint.friction.dynamic", joint.friction.dynamic);
    }
    doubts.look("joint.friction.slip_velocity", joint.friction.slip_velocity.si(), &SLIP_VELOCITY);
    if let Some(bond) = &joint.bond {
        doubts.look("joint.bond.tensile_strength", bond.tensile_strength.si(), &TENSION);
        doubts.look("joint.bond.cohesion", bond.cohesion.si(), &COHESION);
        doubts.look("joint.bond.friction_angle", bond.friction_angle.si().to_degrees(), &ANGLE);
        doubts.look("joint.bond.mode_1_energy", bond.mode_1_energy.si(), &OPENING_ENERGY);
        doubts.look("joint.bond.mode_2_energy", bond.mode_2_energy.si(), &SHEAR_ENERGY);
    }
    for (index, change) in joint.changes.iter().enumerate() {
        let at = format!("joint.change[{index}]");
        let kinds = &change.at.kind;
        let supports = !kinds.is_empty() && kinds.iter().all(|kind| matches!(kind, JointKind::Base | JointKind::Top));
        if let Some(SpringChange { stiffness: Some(stiffness), .. }) = change.spring {
            doubts.look_at_stiffness(&format!("{at}.spring.stiffness"), stiffness);
        }
        if let Some(SpringChange { normal_to_shear: Some(ratio), .. }) = change.spring {
            doubts.look_at_normal_to_shear(&format!("{at}.spring.normal_to_shear"), ratio);
        }
        if let Some(SpringChange { compressive_strength: Some(strength), .. }) = change.spring {
            doubts.look(&format!("{at}.spring.compressive_strength"), strength.si(), &COMPRESSION);
        }
        if let Some(FrictionChange { static_: Some(coefficient), .. }) = change.friction {
            let largest = if supports { LARGEST_HELD } else { LARGEST_FRICTION };
            doubts.look_at_friction(&format!("{at}.friction.static"), coefficient, largest);
        }
        if let Some(FrictionChange { slip_velocity: Some(velocity), .. }) = change.friction {
            doubts.look(&format!("{at}.friction.slip_velocity"), velocity.si(), &SLIP_VELOCITY);
        }
        if let Some(bond) = &change.bond {
            let [tension, cohesion] = if supports { [&HELD; 2] } else { [&TENSION, &COHESION] };
            doubts.look(&format!("{at}.bond.tensile_strength"), bond.tensile_strength.map_or(0.0, |f| f.si()), tension);
            doubts.look(&format!("{at}.bond.cohesion"), bond.cohesion.map_or(0.0, |c| c.si()), cohesion);
        }
        if let Some(device) = &change.device {
            let forces = [
                ("slip_force", device.slip_force),
                ("yield_force", device.yield_force),
                ("activation_force", device.activation_force),
            ];
            for (key, force) in forces {
                doubts.look(&format!("{at}.device.{key}"), force.map_or(0.0, |f| f.si()), &DEVICE_FORCE);
            }
            if device.reference_velocity.is_some() && device.exponent.unwrap_or(1.0) == 1.0 {
                let key = format!("{at}.device.reference_velocity");
                doubts.add(
                    WarningKind::IdleKey,
                    format!("{key} does nothing where `exponent` is 1: the dashpot is linear"),
                );
            }
            let way = device.yield_displacement.map_or(0.0, |d| d.si());
            doubts.look(&format!("{at}.device.yield_displacement"), way, &DEVICE_YIELD);
        }
    }
}

fn of_signal(doubts: &mut Doubts, at: &str, signal: &Signal) {
    match signal {
        Signal::None => {}
        Signal::Record(record) => {
            if let Some(pga) = record.pga {
                doubts.look(&format!("{at}.pga"), pga.si(), &SHAKING);
            }
            let sampled = if record.quantity == HistoryQuantity::Acceleration { &SAMPLED } else { &INTERVAL };
            for (key, interval, expected) in [("resample", record.resample, &INTERVAL), ("dt", record.dt, sampled)] {
                if let Some(interval) = interval {
                    doubts.look(&format!("{at}.{key}"), interval.si(), expected);
                }
            }
        }
        Signal::Sine(sine) => {
            if let Some(amplitude) = sine.amplitude {
                doubts.look(&format!("{at}.sine.amplitude"), amplitude.si(), &STROKE);
            }
            if let Some(acceleration) = sine.acceleration {
                doubts.look(&format!("{at}.sine.acceleration"), acceleration.si(), &SHAKING);
            }
        }
        Signal::Ramp(ramp) => doubts.look(&format!("{at}.ramp.amplitude"), ramp.amplitude.si(), &STROKE),
        Signal::Tilt(tilt) => doubts.look(&format!("{at}.tilt.acceleration"), tilt.acceleration.si(), &SHAKING),
        Signal::Path(path) => {
            for (k, d) in path.displacements.iter().enumerate() {
                doubts.look(&format!("{at}.path.displacements[{k}]"), d.si(), &STROKE);
            }
            doubts.look(&format!("{at}.path.speed"), path.speed.si(), &SPEED);
        }
        Signal::Pulse(pulse) => doubts.look(&format!("{at}.pulse.acceleration"), pulse.acceleration.si(), &SHAKING),
        Signal::Sweep(sweep) => doubts.look(&format!("{at}.sweep.acceleration"), sweep.acceleration.si(), &SHAKING),
        Signal::Synthetic(synthetic) => {
            doubts.look(&format!("{at}.synthetic.pga"), synthetic.pga.si(), &SHAKING);
            doubts.look(&format!("{at}.synthetic.dt"), synthetic.dt.si(), &INTERVAL);
            for (k, corner) in synthetic.corners.iter().enumerate() {
                doubts.look(&format!("{at}.synthetic.corners[{k}]"), corner.si(), &CORNERS);
            }
        }
    }
}
