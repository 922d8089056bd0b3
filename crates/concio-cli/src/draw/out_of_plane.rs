//! A mechanism out of the plane: elevation with hinges and cracks, section as it begins to fall.

use concio_mechanisms::survey::{Found, Kind, Shape};
use concio_mechanisms::wall::Wall;

use super::chart::LETTERS;
use super::output::Drawing;
use super::svg::{Anchor, Canvas, line, polygon, rectangle};
use super::wall::{BRICK, ground};
use crate::format::significant;

/// Width of the drawing [pt].
const WIDTH: f64 = 420.0;
/// Room: sides, top, bottom, between elevation and section [pt].
const ROOM: [f64; 4] = [14.0, 22.0, 34.0, 60.0];
/// Height of the wall at most [pt].
const TALLEST: f64 = 260.0;
/// Turn that is drawn [rad].
const TURN: f64 = 0.14;
/// Length of arrows of floors [pt].
const ARROW: f64 = 16.0;

const REST: &str = r##"fill="#ececec" stroke="#a0a0a0" stroke-width="0.4""##;
const MOVES: &str = r##"stroke="#333" stroke-width="0.6" fill-opacity="0.9""##;
const HINGE: &str = r##"fill="none" stroke="#c0390b" stroke-width="2""##;
const CRACK: &str = r##"fill="none" stroke="#c0390b" stroke-width="1.2" stroke-dasharray="4 2""##;
const OPENING: &str = r##"fill="#fff" stroke="#808080" stroke-width="0.5""##;
const FORCE: &str = r##"fill="none" stroke="#1f5fa8" stroke-width="1.1""##;

/// From metres to points.
struct View {
    left: f64,
    bottom: f64,
    scale: f64,
}

impl View {
    fn at(&self, [x, z]: [f64; 2]) -> [f64; 2] {
        [self.left + x * self.scale, self.bottom - z * self.scale]
    }
    fn outline(&self, corners: &[[f64; 2]]) -> String {
        polygon(&corners.iter().map(|p| self.at(*p)).collect::<Vec<_>>())
    }
    fn stroke(&self, from: [f64; 2], to: [f64; 2]) -> String {
        let ([a, b], [c, d]) = (self.at(from), self.at(to));
        line([a, b, c, d])
    }
}

/// Draws a mechanism.
pub fn draw(wall: &Wall, found: &Found) -> Drawing {
    let top = top(wall);
    let (length, thickness) = (wall.length(), wall.masonry.thickness);
    let depth = depth(wall, found);
    // The section leans outwards, and side walls stand behind it.
    let lean = top * TURN;
    let across = length + lean + depth.max(thickness) + 0.2;
    let scale = ((WIDTH - 2.0 * ROOM[0] - ROOM[3]) / across).min(TALLEST / top);
    let bottom = ROOM[1] + top * scale;
    let mut canvas = Canvas::default();
    let front = View { left: ROOM[0] - wall.extent[0] * scale, bottom, scale };
    elevation(&mut canvas, &front, wall, found);
    let face = ROOM[0] + length * scale + ROOM[3] + lean * scale;
    let side = View { left: face, bottom, scale };
    section(&mut canvas, &side, wall, found, depth);
    let title = format!(
        "{} at {} m: α0 = {}",
        found.kind.what(),
        significant(found.hinge, 3),
        significant(found.multiplier(), 4)
    );
    let letters = LETTERS.map(f64::from);
    canvas.text([ROOM[0], 9.0], letters[1], Anchor::Start, false, "#000", &title);
    let caption = bottom + 18.0;
    let seen = if wall.back { "elevation, from inside: its back is the outer face" } else { "elevation, from outside" };
    canvas.text([ROOM[0], caption], letters[0], Anchor::Start, false, "#000", seen);
    let end = [WIDTH - ROOM[0], caption];
    canvas.text(end, letters[0], Anchor::End, false, "#000", "section, outside on the left");
    let size = [WIDTH, bottom + ROOM[2]];
    Drawing { body: canvas.into_body(), size, title, note: String::new() }
}

/// Level of the highest point [m].
fn top(wall: &Wall) -> f64 {
    wall.top + wall.gable.map_or(0.0, |(gable, _)| gable.height)
}

/// How far back the section shows something [m].
fn depth(wall: &Wall, found: &Found) -> f64 {
    let t = wall.masonry.thickness;
    let height = wall.top - found.hinge;
    match &found.shape {
        Shape::Above { wedges } => t + wedges.iter().map(|w| w[1]).fold(0.0, f64::max) * height,
        Shape::Corner { slopes, .. } => t + slopes[1] * height,
        _ => t,
    }
}

fn elevation(canvas: &mut Canvas, view: &View, wall: &Wall, found: &Found) {
    let [left, right] = wall.extent;
    let all = [[left, 0.0], [right, 0.0], [right, wall.top], [left, wall.top]];
    canvas.path(&view.outline(&all), REST, Some("wall at rest"));
    if let Some((gable, _)) = wall.gable {
        let from = 0.5 * (left + right - gable.base);
        let corners =
            [[from, wall.top], [from + gable.base, wall.top], [0.5 * (left + right), wall.top + gable.height]];
        canvas.path(&view.outline(&corners), REST, Some("gable"));
    }
    let moves = format!(r#"fill="{BRICK}" {MOVES}"#);
    for corners in moving(wall, found) {
        canvas.path(&view.outline(&corners), &moves, Some("what moves"));
    }
    for [x0, z0, x1, z1] in &wall.openings {
        let ([a, b], [c, d]) = (view.at([*x0, *z0]), view.at([*x1, *z1]));
        canvas.path(&rectangle([a, d, c, b]), OPENING, Some("opening"));
    }
    lines(canvas, view, wall, found);
    for floor in wall.floors.iter().filter(|f| f.floor.level <= wall.top + 1e-9) {
        let z = floor.floor.level;
        canvas.path(
            &view.stroke([left, z], [right, z]),
            r##"fill="none" stroke="#1f5fa8" stroke-width="0.7" stroke-dasharray="1.5 1.5""##,
            Some("floor"),
        );
    }
    for tie in &wall.ties {
        let [x, z] = view.at([tie.position, tie.level]);
        canvas.path(
            &format!("{}{}", line([x - 3.5, z - 3.5, x + 3.5, z + 3.5]), line([x - 3.5, z + 3.5, x + 3.5, z - 3.5])),
            FORCE,
            Some("tie"),
        );
    }
    let [a, b] = [view.at([left, 0.0])[0], view.at([right, 0.0])[0]];
    ground(canvas, [a, b, view.bottom], 0.55);
}

/// Outlines of what moves, in the elevation.
fn moving(wall: &Wall, found: &Found) -> Vec<Vec<[f64; 2]>> {
    let [left, right] = wall.extent;
    let band = |from: f64, to: f64| vec![[left, from], [right, from], [right, to], [left, to]];
    match &found.shape {
        Shape::Above { .. } => vec![band(found.hinge, wall.top)],
        Shape::Storey { levels: [low, high] } => vec![band(*low, *high)],
        Shape::Strip { levels: [low, high], at: [from, _, to] } => {
            vec![vec![[*from, *low], [*to, *low], [*to, *high], [*from, *high]]]
        }
        Shape::Corner { left: at_left, slopes } => {
            let reach = (wall.top - found.hinge) * slopes[0];
            let (edge, way) = if *at_left { (left, 1.0) } else { (right, -1.0) };
            let reach = way * reach.min(right - left);
            vec![vec![[edge, found.hinge], [edge + reach, wall.top], [edge, wall.top]]]
        }
        Shape::Outlines(all) => all.clone(),
    }
}

/// Hinges and cracks, in the elevation.
fn lines(canvas: &mut Canvas, view: &View, wall: &Wall, found: &Found) {
    let [left, right] = wall.extent;
    let mut hinge = |from, to| canvas.path(&view.stroke(from, to), HINGE, Some("hinge"));
    match &found.shape {
        Shape::Above { .. } => hinge([left, found.hinge], [right, found.hinge]),
        Shape::Storey { levels } => {
            for z in [levels[0], found.hinge, levels[1]] {
                hinge([left, z], [right, z]);
            }
        }
        Shape::Strip { levels: [low, high], at } => at.iter().for_each(|x| hinge([*x, *low], [*x, *high])),
        Shape::Corner { left: at_left, slopes } => {
            let (edge, way) = if *at_left { (left, 1.0) } else { (right, -1.0) };
            let reach = way * (wall.top - found.hinge) * slopes[0];
            canvas.path(&view.stroke([edge, found.hinge], [edge + reach, wall.top]), CRACK, Some("crack"));
        }
        Shape::Outlines(all) => {
            // A hinge rises from the foot of the crack, which is upright; the whole gable turns about its base.
            for corners in all {
                for (i, from) in corners.iter().enumerate() {
                    let to = corners[(i + 1) % corners.len()];
                    let upright = (from[0] - to[0]).abs() < 1e-9;
                    let level = (from[1] - to[1]).abs() < 1e-9;
                    let foot = from[1].min(to[1]) <= corners.iter().map(|p| p[1]).fold(f64::MAX, f64::min) + 1e-9;
                    if found.kind == Kind::Gable && level {
                        canvas.path(&view.stroke(*from, to), HINGE, Some("hinge"));
                    } else if found.kind != Kind::Gable && foot && !level {
                        let (style, name) = if upright { (CRACK, "crack") } else { (HINGE, "hinge") };
                        canvas.path(&view.stroke(*from, to), style, Some(name));
                    }
                }
            }
        }
    }
}

/// A point of the section turned outwards about a hinge on the face.
fn turned([x, z]: [f64; 2], hinge: f64, turn: f64) -> [f64; 2] {
    let (sin, cos) = turn.sin_cos();
    let up = z - hinge;
    [x * cos - up * sin, hinge + up * cos + x * sin]
}

fn section(canvas: &mut Canvas, view: &View, wall: &Wall, found: &Found, depth: f64) {
    let t = wall.masonry.thickness;
    let high = if matches!(found.kind, Kind::Gable | Kind::GableFlaps) { top(wall) } else { wall.top };
    let strip = |from: f64, to: f64| vec![[0.0, from], [t, from], [t, to], [0.0, to]];
    canvas.path(&view.outline(&strip(0.0, high)), REST, Some("wall at rest"));
    let moves = format!(r#"fill="{BRICK}" {MOVES}"#);
    let mark = |canvas: &mut Canvas, p: [f64; 2]| {
        let [x, z] = view.at(p);
        canvas.path(&rectangle([x - 2.2, z - 2.2, x + 2.2, z + 2.2]), r##"fill="#c0390b""##, Some("hinge"));
    };
    match &found.shape {
        Shape::Storey { levels: [low, upper] } => {
            // The lower part turns about the outer edge of its foot, the upper one back to the line of the wall.
            let b = found.hinge;
            let turn = (TURN * (upper - low) / (b - low) * 0.5).min(2.0 * TURN);
            let lower: Vec<[f64; 2]> = strip(*low, b).iter().map(|p| turned(*p, *low, turn)).collect();
            let back = turn * (b - low) / (upper - b);
            let knee = lower[2];
            let part: Vec<[f64; 2]> = strip(b, *upper)
                .iter()
                .map(|[x, z]| {
                    let (rx, rz) = (x - t, z - b);
                    let (sin, cos) = back.sin_cos();
                    [knee[0] + rx * cos + rz * sin, knee[1] + rz * cos - rx * sin]
                })
                .collect();
            canvas.path(&view.outline(&lower), &moves, Some("lower part"));
            canvas.path(&view.outline(&part), &moves, Some("upper part"));
            mark(canvas, [0.0, *low]);
            mark(canvas, knee);
        }
        Shape::Strip { levels: [low, upper], .. } => {
            let out: Vec<[f64; 2]> = strip(*low, *upper).iter().map(|[x, z]| [x - 0.5 * t, *z]).collect();
            canvas.path(&view.outline(&out), &moves, Some("strip at midspan"));
        }
        _ => {
            let behind = depth - t;
            if behind > 1e-6 {
                let wedge = [[t, found.hinge], [t + behind, wall.top], [t, wall.top]];
                let wedge: Vec<[f64; 2]> = wedge.iter().map(|p| turned(*p, found.hinge, TURN)).collect();
                canvas.path(&view.outline(&wedge), &moves, Some("wedge of the side wall"));
                canvas.path(&view.stroke([t, found.hinge], [t + behind, wall.top]), CRACK, Some("crack"));
            }
            let t = if found.kind == Kind::Leaf { wall.leaf.unwrap_or(t) } else { t };
            let part = [[0.0, found.hinge], [t, found.hinge], [t, high], [0.0, high]];
            let part: Vec<[f64; 2]> = part.iter().map(|p| turned(*p, found.hinge, TURN)).collect();
            canvas.path(&view.outline(&part), &moves, Some("what moves"));
            mark(canvas, [found.setback, found.hinge]);
        }
    }
    for own in wall.floors.iter().filter(|f| f.floor.level <= wall.top + 1e-9 && f.floor.load > 0.0) {
        let [x, z] = view.at([own.floor.depth, own.floor.level]);
        let arrow = format!(
            "{}{}",
            line([x, z - ARROW, x, z]),
            line([x - 2.0, z - 4.0, x, z]) + &line([x + 2.0, z - 4.0, x, z])
        );
        canvas.path(&arrow, FORCE, Some("load of a floor"));
    }
    for tie in &wall.ties {
        let [x, z] = view.at([0.0, tie.level]);
        let [end, _] = view.at([depth.max(t) + 0.1, tie.level]);
        canvas.path(&line([x, z, end, z]), FORCE, Some("tie"));
    }
    let [a, b] = [view.at([-0.1, 0.0])[0], view.at([t + 0.1, 0.0])[0]];
    ground(canvas, [a, b, view.bottom], 0.55);
}
