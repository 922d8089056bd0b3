//! Dry circular arches against the thrust line: how thin a semicircle may be, and where its hinges are.

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::outcome::Outcome;
use concio::run::{Prepared, prepare_case, run_in_memory};
use concio_verified::agrees;

/// Least thickness of a semicircle over the radius of its centre line (Milankovitch 1907; Heyman 1969 has 0.106 with weights
/// on the centre line), and the angle from the crown at which its haunches open.
const THINNEST: f64 = 0.1075;
const HAUNCH: f64 = 54.5;
const VOUSSOIRS: usize = 36;

/// A semicircle of 2 m clear span whose thickness is `ratio` of the radius of its centre line, left to itself.
fn semicircle(ratio: f64) -> (Prepared, Outcome) {
    let thickness = ratio / (1.0 - 0.5 * ratio);
    let text = format!(
        r#"
model = "planar"
[[panel]]
bond = "arch"
arch = {{ span = 2, rise = 1, thickness = {thickness:?}, voussoirs = {VOUSSOIRS} }}
brick = {{ length = 0.2, height = 0.2, thickness = 0.5, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", static = 0.7, dynamic = 0.7, on = "all" }}
[motion]
duration = "1.2 s"
[output]
frames = "10 ms"
"#
    );
    let file = from_str(&text, Syntax::Toml, None).expect("a wall file");
    file.validate().expect("a valid wall");
    let prepared = prepare_case(file.case, Path::new(".")).expect("an arch");
    let outcome = run_in_memory(&prepared).expect("a run");
    (prepared, outcome)
}

#[test]
fn a_semicircle_stands_where_the_thrust_line_fits_into_it() {
    let (_, outcome) = semicircle(1.01 * THINNEST);
    let moved = outcome.totals.peak_relative_displacement;
    assert!(moved < 1e-6, "it stands: {moved} m");
}

/// Five hinges: the crown opens below, the haunches above, the springings below.
#[test]
fn a_thinner_one_falls_by_five_hinges() {
    let (prepared, outcome) = semicircle(0.97 * THINNEST);
    let (layout, recording, joints) = (&outcome.layout, &outcome.recording, &prepared.model.joints);
    let fallen = |frame: &usize| {
        let rise = &recording.frame_vertical[frame * layout.turned..][..layout.turned];
        rise.iter().any(|v| *v < -5e-3)
    };
    let frame = (0..recording.frame_time.len()).find(fallen).expect("it falls");
    let opening = &recording.frame_opening[frame * joints.len()..][..joints.len()];
    let widest = opening.iter().copied().fold(0.0, f64::max);
    let slip = recording.frame_slip[frame * joints.len()..][..joints.len()].iter().fold(0.0f64, |m, s| m.max(s.abs()));
    assert!(slip < 0.05 * widest, "it does not slide: {slip} m beside openings of {widest} m");
    // Angle of a joint from the crown, from the middle of its line about the middle of the springing.
    let middle = prepared.model.wall.blocks.iter().map(|b| b.x[1]).fold(0.0, f64::max) / 2.0;
    let angle = |e: usize| {
        let [x0, y0, x1, y1] = joints[e].line;
        (FRAC_PI_2 - (0.5 * (y0 + y1)).atan2(0.5 * (x0 + x1) - middle)).to_degrees()
    };
    let mut hinges: Vec<f64> = (0..joints.len()).filter(|&e| opening[e] > 0.2 * widest).map(angle).collect();
    hinges.sort_by(f64::total_cmp);
    let one = 180.0 / VOUSSOIRS as f64;
    for place in [-90.0, -HAUNCH, 0.0, HAUNCH, 90.0] {
        let near = hinges.iter().copied().min_by(|a, b| (a - place).abs().total_cmp(&(b - place).abs()));
        let subject = format!("Limit analysis: thin semicircle that falls, angles of its hinges; near {place}°");
        agrees!(subject, "thrust line (Milankovitch 1907)", "°", near.expect("hinges"), place, abs: one);
    }
    assert!(hinges.len() <= 8, "{hinges:?}");
}
