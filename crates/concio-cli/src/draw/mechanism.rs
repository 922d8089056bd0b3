//! A wall as it begins to fall: blocks moved by the velocities of a mechanism, over the wall at rest.

use concio_limit::{Limit, Problem};
use concio_planar::body::Body;

use super::chart::LETTERS;
use super::output::Drawing;
use super::svg::{Anchor, Canvas, line, polygon};
use super::wall::{BRICK, ground};
use crate::format::significant;

/// Width of the drawing [pt].
const WIDTH: f64 = 340.0;
/// Room around the wall [pt]: left and right, top, bottom.
const ROOM: [f64; 3] = [10.0, 18.0, 42.0];
/// Height of the wall over the width of the drawing, at most.
const TALLEST: f64 = 1.2;
/// What the fastest corner moves, over the larger side of the wall.
const MOVED: f64 = 0.06;

/// From metres to points.
struct View {
    origin: [f64; 2],
    scale: f64,
}

impl View {
    fn at(&self, p: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + p[0] * self.scale, self.origin[1] - p[1] * self.scale]
    }
}

/// A rigid motion: a shift of the centre and a turn about it.
#[derive(Clone, Copy)]
struct Motion<'a> {
    body: &'a Body,
    shift: [f64; 2],
    turn: f64,
}

impl Motion<'_> {
    /// A point given from the centre.
    fn moved(&self, r: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.turn.sin_cos();
        let c = self.body.centre;
        [c[0] + self.shift[0] + cos * r[0] - sin * r[1], c[1] + self.shift[1] + sin * r[0] + cos * r[1]]
    }
}

/// Draws the mechanism.
pub fn draw(problem: &Problem, found: &Limit) -> Drawing {
    let bodies = &problem.assembly.bodies;
    let rest: Vec<Vec<[f64; 2]>> =
        bodies.iter().map(|b| outline(&Motion { body: b, shift: [0.0; 2], turn: 0.0 })).collect();
    let [wide, high] = extent(&rest);
    let amount = MOVED * (wide[1] - wide[0]).max(high[1] - high[0]);
    let motions: Vec<Motion> = bodies
        .iter()
        .zip(&found.mechanism.velocities)
        .map(|(body, v)| Motion { body, shift: [amount * v[0], amount * v[1]], turn: amount * v[2] })
        .collect();
    let moved: Vec<Vec<[f64; 2]>> = motions.iter().map(outline).collect();
    let all: Vec<Vec<[f64; 2]>> = rest.iter().chain(&moved).cloned().collect();
    let [x, y] = extent(&all);
    let size = [x[1] - x[0], y[1] - y[0].min(0.0)].map(|v| v.max(1e-9));
    let scale = ((WIDTH - 2.0 * ROOM[0]) / size[0]).min(TALLEST * WIDTH / size[1]);
    let bottom = ROOM[1] + y[1] * scale;
    let view = View { origin: [0.5 * (WIDTH - size[0] * scale) - x[0] * scale, bottom], scale };
    let mut canvas = Canvas::default();
    let grey = r##"fill="#ececec" stroke="#a0a0a0" stroke-width="0.4""##;
    canvas.path(&rest.iter().map(|p| outlined(&view, p)).collect::<String>(), grey, None);
    let brick = format!(r##"fill="{BRICK}" fill-opacity="0.85" stroke="#333" stroke-width="0.5""##);
    for (body, corners) in bodies.iter().zip(&moved) {
        canvas.path(&outlined(&view, corners), &brick, Some(&body.name));
    }
    joints(&mut canvas, &view, problem, found, &motions);
    let [left, right] = wide.map(|x| view.at([x, 0.0])[0]);
    ground(&mut canvas, [left, right, bottom], 0.65);
    let below = bottom - y[0].min(0.0) * scale;
    legend(&mut canvas, found, below + 14.0);
    let title = format!("Mechanism at λ = {}: {}", significant(found.multiplier(), 4), found.mechanism.kind.name());
    let letters = f64::from(LETTERS[1]);
    canvas.text([0.5 * WIDTH, 8.0], letters, Anchor::Middle, false, "#000", &title);
    Drawing { body: canvas.into_body(), size: [WIDTH, below + ROOM[2]], title, note: String::new() }
}

fn outline(motion: &Motion) -> Vec<[f64; 2]> {
    motion.body.corners.iter().map(|r| motion.moved(*r)).collect()
}

/// Smallest and largest x, and y.
fn extent(outlines: &[Vec<[f64; 2]>]) -> [[f64; 2]; 2] {
    [0, 1].map(|k| {
        let values = outlines.iter().flatten().map(|p| p[k]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |e, v| [e[0].min(v), e[1].max(v)])
    })
}

fn outlined(view: &View, corners: &[[f64; 2]]) -> String {
    polygon(&corners.iter().map(|p| view.at(*p)).collect::<Vec<_>>())
}

const SLIDES: &str = r##"fill="none" stroke="#1f5fa8" stroke-width="1.6""##;
const OPENS: &str = r##"fill="none" stroke="#c0390b" stroke-width="1.6" stroke-dasharray="1.6 1.4""##;

/// The joints that move, on the block whose side they are.
fn joints(canvas: &mut Canvas, view: &View, problem: &Problem, found: &Limit, motions: &[Motion]) {
    for joint in &found.mechanism.joints {
        let ends: Vec<[f64; 2]> = problem
            .assembly
            .points
            .iter()
            .filter(|p| p.joint == joint.joint)
            .map(|p| {
                let centre = motions[p.a].body.centre;
                view.at(motions[p.a].moved([p.at[0] - centre[0], p.at[1] - centre[1]]))
            })
            .collect();
        if let [p, q] = ends[..] {
            let attributes = if joint.opens { OPENS } else { SLIDES };
            canvas.path(&line([p[0], p[1], q[0], q[1]]), attributes, Some(&problem.joints[joint.joint]));
        }
    }
}

fn legend(canvas: &mut Canvas, found: &Limit, y: f64) {
    let size = f64::from(LETTERS[0]);
    let entry = |canvas: &mut Canvas, x: f64, attributes: &str, text: &str| {
        canvas.path(&line([x, y, x + 18.0, y]), attributes, None);
        canvas.text([x + 22.0, y], size, Anchor::Start, false, "#000", text);
    };
    let number =
        |chosen: fn(&concio_limit::JointMotion) -> bool| found.mechanism.joints.iter().filter(|j| chosen(j)).count();
    entry(canvas, ROOM[0], SLIDES, &format!("slides only ({})", number(|j| j.slides && !j.opens)));
    entry(canvas, ROOM[0] + 110.0, OPENS, &format!("opens ({})", number(|j| j.opens)));
    let text = "grey: at rest; wall to scale, its motion enlarged";
    canvas.text([ROOM[0], y + size + 5.0], size, Anchor::Start, false, "#000", text);
}
