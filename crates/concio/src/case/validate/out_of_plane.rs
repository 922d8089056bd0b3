//! Floors, ties, side walls and site of `[out_of_plane]`; what only the laid wall shows is found where the mechanisms are made.

use super::{Bound, Findings};
use crate::case::out_of_plane::{CornerLoad, Gable, Hazard, SideWall};
use crate::case::{Case, OutOfPlane};
use crate::quantity::{Acceleration, Time, shown};

/// Most leaves of a wall.
const MOST_LEAVES: usize = 10;
/// Most floors, side walls and floor spectra.
const MOST_FLOORS: usize = 100;
/// Most ties.
const MOST_ANCHORS: usize = 1000;
/// Most points of a spectrum.
const MOST_POINTS: usize = 10_000;
/// Directions in which a corner may fall [rad].
const DIRECTIONS: [f64; 2] = [10.0 * std::f64::consts::PI / 180.0, 80.0 * std::f64::consts::PI / 180.0];

pub(super) fn check(f: &mut Findings, case: &Case) {
    let Some(o) = &case.out_of_plane else { return };
    if let Some(strength) = o.strength {
        f.quantity("out_of_plane.strength", strength, Bound::Above0);
    }
    if let Some(v) = o.confidence_factor {
        f.number("out_of_plane.confidence_factor", v, Bound::Between(1.0, 1.35));
    }
    if let Some(v) = o.behaviour_factor {
        f.number("out_of_plane.behaviour_factor", v, Bound::Between(1.0, 3.0));
    }
    leaves(f, o);
    for (name, number, most) in [
        ("leaves", o.leaves.len(), MOST_LEAVES),
        ("floor", o.floors.len(), MOST_FLOORS),
        ("anchor", o.anchors.len(), MOST_ANCHORS),
        ("side_wall", o.side_walls.len(), MOST_FLOORS),
        ("floor_spectrum", o.floor_spectra.len(), MOST_FLOORS),
    ] {
        if number > most {
            f.push(format_args!("out_of_plane.{name}"), format!("{number} are too many"), format!("up to {most}"));
            return;
        }
    }
    floors(f, o);
    anchors(f, o);
    o.side_walls.iter().enumerate().for_each(|(i, side)| side_wall(f, i, side));
    if let Some(own) = &o.gable {
        gable(f, own);
    }
    if let Some(strip) = &o.strip {
        f.quantity("out_of_plane.strip.from", strip.from, Bound::From0);
        f.quantity("out_of_plane.strip.thrust", strip.thrust, Bound::From0);
        f.number("out_of_plane.strip.friction", strip.friction, Bound::From0);
        if let Some(span) = strip.span {
            f.quantity("out_of_plane.strip.span", span, Bound::Above0);
        }
    }
    if let Some(site) = &o.site {
        for (name, own) in site.hazards() {
            hazard(f, &format!("out_of_plane.site.{name}"), own);
        }
    }
    if let Some(b) = &o.building {
        f.quantity("out_of_plane.building.height", b.height, Bound::Above0);
        if !(1..=MOST_FLOORS).contains(&b.storeys) {
            let what = format!("{} is out of range", b.storeys);
            f.push("out_of_plane.building.storeys", what, format!("1 … {MOST_FLOORS}"));
        }
        if let Some(v) = b.period {
            f.quantity("out_of_plane.building.period", v, Bound::Above0);
        }
        if let Some(v) = b.damping_ratio {
            f.number("out_of_plane.building.damping_ratio", v, Bound::Between(0.0, 0.3));
        }
        if let Some(v) = b.participation {
            f.number("out_of_plane.building.participation", v, Bound::Above0);
        }
    }
    for (i, own) in o.floor_spectra.iter().enumerate() {
        let key = format!("out_of_plane.floor_spectrum[{i}]");
        f.quantity(format_args!("{key}.z"), own.z, Bound::From0);
        columns(f, &key, &own.periods, &own.accelerations);
    }
}

fn leaves(f: &mut Findings, o: &OutOfPlane) {
    for (i, leaf) in o.leaves.iter().enumerate().take(MOST_LEAVES) {
        f.quantity(format_args!("out_of_plane.leaves[{i}]"), *leaf, Bound::Above0);
    }
    if o.leaves.is_empty() && o.leaves_tied.is_some() {
        f.push("out_of_plane.leaves_tied", "no leaves are given", "beside `leaves`; else leave it out");
    }
}

fn floors(f: &mut Findings, o: &OutOfPlane) {
    for (i, floor) in o.floors.iter().enumerate() {
        let key = format!("out_of_plane.floor[{i}]");
        f.quantity(format_args!("{key}.z"), floor.z, Bound::Above0);
        f.quantity(format_args!("{key}.load"), floor.load, Bound::From0);
        if let Some(at) = floor.at {
            f.quantity(format_args!("{key}.at"), at, Bound::From0);
        }
        f.quantity(format_args!("{key}.push"), floor.push, Bound::From0);
        f.quantity(format_args!("{key}.thrust"), floor.thrust, Bound::Finite);
        f.number(format_args!("{key}.seat_friction"), floor.seat_friction, Bound::From0);
        if let Some(length) = floor.seat_length {
            f.quantity(format_args!("{key}.seat_length"), length, Bound::Above0);
        }
        f.quantity(format_args!("{key}.connection"), floor.connection, Bound::From0);
        if floor.clamps && !floor.holds {
            let what = "a floor that does not hold the wall cannot clamp it";
            f.push(format_args!("{key}.clamps"), what, "with `holds = true`; else leave it out");
        }
    }
}

fn anchors(f: &mut Findings, o: &OutOfPlane) {
    for (i, anchor) in o.anchors.iter().enumerate() {
        let key = format!("out_of_plane.anchor[{i}]");
        f.quantity(format_args!("{key}.z"), anchor.z, Bound::Above0);
        if let Some(x) = anchor.x {
            f.quantity(format_args!("{key}.x"), x, Bound::From0);
        }
        f.quantity(format_args!("{key}.yield_force"), anchor.yield_force, Bound::Above0);
        if let Some(force) = anchor.anchorage {
            f.quantity(format_args!("{key}.anchorage"), force, Bound::Above0);
        }
        if let Some(stiffness) = anchor.stiffness {
            f.quantity(format_args!("{key}.stiffness"), stiffness, Bound::Above0);
        }
        f.quantity(format_args!("{key}.slack"), anchor.slack, Bound::From0);
        if let Some(at) = anchor.breaks_at {
            f.quantity(format_args!("{key}.breaks_at"), at, Bound::Above0);
            if at.si() > 0.0 && at <= anchor.slack {
                let what = format!("{at} is not beyond the slack");
                f.push(format_args!("{key}.breaks_at"), what, format!("above {}", anchor.slack));
            }
        }
    }
}

fn side_wall(f: &mut Findings, i: usize, side: &SideWall) {
    let key = format!("out_of_plane.side_wall[{i}]");
    f.quantity(format_args!("{key}.x"), side.x, Bound::From0);
    f.quantity(format_args!("{key}.thickness"), side.thickness, Bound::Above0);
    f.quantity(format_args!("{key}.load"), side.load, Bound::From0);
    if let Some(weight) = side.specific_weight {
        f.quantity(format_args!("{key}.specific_weight"), weight, Bound::Above0);
    }
    for (name, length) in [
        ("course_height", side.course_height),
        ("overlap", side.overlap),
        ("first_opening", side.first_opening),
        ("opening_beside", side.opening_beside),
    ] {
        if let Some(length) = length {
            f.quantity(format_args!("{key}.{name}"), length, Bound::Above0);
        }
    }
    if let Some(friction) = side.friction {
        f.number(format_args!("{key}.friction"), friction, Bound::From0);
    }
    if let Some(load) = &side.corner {
        corner(f, &format!("{key}.corner"), load);
    }
}

fn corner(f: &mut Findings, key: &str, load: &CornerLoad) {
    f.quantity(format_args!("{key}.load"), load.load, Bound::From0);
    f.quantity(format_args!("{key}.at"), load.at, Bound::From0);
    f.quantity(format_args!("{key}.push"), load.push, Bound::From0);
    f.quantity(format_args!("{key}.thrust"), load.thrust, Bound::Finite);
    let [low, high] = DIRECTIONS;
    if let Some(angle) = load.direction.filter(|a| !(low - 1e-9..=high + 1e-9).contains(&a.si())) {
        let what = format!("{} deg is out of range", shown(angle.si().to_degrees()));
        f.push(format_args!("{key}.direction"), what, "10 … 80 deg (a number without unit is in rad)");
    }
}

fn gable(f: &mut Findings, gable: &Gable) {
    f.quantity("out_of_plane.gable.height", gable.height, Bound::Above0);
    for (name, length) in [("base", gable.base), ("thickness", gable.thickness)] {
        if let Some(length) = length {
            f.quantity(format_args!("out_of_plane.gable.{name}"), length, Bound::Above0);
        }
    }
    if let Some(at) = gable.ridge_at {
        f.quantity("out_of_plane.gable.ridge_at", at, Bound::From0);
    }
    for (name, force) in
        [("ridge_load", gable.ridge_load), ("ridge_push", gable.ridge_push), ("crack_thrust", gable.crack_thrust)]
    {
        f.quantity(format_args!("out_of_plane.gable.{name}"), force, Bound::From0);
    }
    f.quantity("out_of_plane.gable.ridge_thrust", gable.ridge_thrust, Bound::Finite);
}

fn hazard(f: &mut Findings, key: &str, h: &Hazard) {
    let parameters = [
        ("ground_acceleration", h.ground_acceleration.is_some()),
        ("soil_factor", h.soil_factor.is_some()),
        ("amplification", h.amplification.is_some()),
        ("corner_period", h.corner_period.is_some()),
    ];
    if !h.periods.is_empty() || !h.accelerations.is_empty() {
        if let Some((name, _)) = parameters.iter().find(|(_, given)| *given) {
            let what = "the spectrum is given by columns already";
            f.push(format_args!("{key}.{name}"), what, "columns, or the parameters of the code");
        }
        columns(f, key, &h.periods, &h.accelerations);
        return;
    }
    if let Some(v) = h.ground_acceleration {
        f.quantity(format_args!("{key}.ground_acceleration"), v, Bound::Above0);
    }
    for (name, value) in [("soil_factor", h.soil_factor), ("amplification", h.amplification)] {
        if let Some(v) = value {
            f.number(format_args!("{key}.{name}"), v, Bound::Above0);
        }
    }
    if let Some(v) = h.corner_period {
        f.quantity(format_args!("{key}.corner_period"), v, Bound::Above0);
    }
    for (name, given) in parameters.into_iter().filter(|(name, _)| *name != "soil_factor") {
        if !given {
            let what = "the key is missing: without columns the spectrum of the code needs it";
            f.push(format_args!("{key}.{name}"), what, "above 0; or `periods` and `accelerations`");
        }
    }
}

fn columns(f: &mut Findings, key: &str, periods: &[Time], accelerations: &[Acceleration]) {
    if periods.len() > MOST_POINTS {
        let what = format!("{} points are too many", periods.len());
        f.push(format_args!("{key}.periods"), what, format!("up to {MOST_POINTS}"));
        return;
    }
    if periods.is_empty() || periods.len() != accelerations.len() {
        let what = format!("{} accelerations stand beside {} periods", accelerations.len(), periods.len());
        f.push(format_args!("{key}.accelerations"), what, "one for each period, at least one");
        return;
    }
    for (i, period) in periods.iter().enumerate() {
        f.quantity(format_args!("{key}.periods[{i}]"), *period, Bound::From0);
    }
    for (i, acceleration) in accelerations.iter().enumerate() {
        f.quantity(format_args!("{key}.accelerations[{i}]"), *acceleration, Bound::From0);
    }
    if accelerations[0].si() == 0.0 {
        let what = "the spectrum begins with 0: nothing shakes the wall";
        f.push(format_args!("{key}.accelerations[0]"), what, "above 0 m/s2, the peak of the ground or floor");
    }
    if periods[0].si() != 0.0 {
        let what = format!("the first period is {}", periods[0]);
        f.push(format_args!("{key}.periods[0]"), what, "0 s: there the spectrum has the peak of the ground");
    }
    if let Some(i) = periods.windows(2).position(|pair| pair[0] >= pair[1]) {
        let what = format!("{} comes after {}", periods[i + 1], periods[i]);
        f.push(format_args!("{key}.periods[{}]", i + 1), what, "rising");
    }
}
