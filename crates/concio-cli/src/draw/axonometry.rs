//! A mechanism in space: blocks as boxes, seen from outside and above, parallel lines parallel.
//!
//! Boxes are painted from the farthest to the nearest. Of two that a plane across an axis parts, the one on the viewer's side
//! is the nearer; those that no plane parts from each other in one sense alone do not hide each other.

use concio_limit::space::{Body, Limit, Problem, Vector};

use super::chart::LETTERS;
use super::output::Drawing;
use super::svg::{Anchor, Canvas, polygon};
use super::wall::BRICK;
use crate::format::significant;

/// Width of the drawing [pt].
const WIDTH: f64 = 340.0;
/// Room around the wall [pt]: left and right, top, bottom.
const ROOM: [f64; 3] = [10.0, 20.0, 42.0];
/// Height of the wall over the width of the drawing, at most.
const TALLEST: f64 = 1.3;
/// What the fastest corner moves, over the largest side of the wall.
const MOVED: f64 = 0.12;
/// Where the viewer is: outside, where x is below 0, to the right and above.
const VIEWER: Vector = [-0.75, 0.55, 0.40];
/// Blocks slower than this part of the fastest corner stay.
const STAYS: f64 = 1e-3;
/// Faces of a box by their corners, counterclockwise from outside, and the axis across them.
const FACES: [([usize; 4], usize); 6] =
    [([0, 4, 6, 2], 0), ([1, 3, 7, 5], 0), ([0, 1, 5, 4], 1), ([2, 6, 7, 3], 1), ([0, 2, 3, 1], 2), ([4, 5, 7, 6], 2)];
/// Light on faces across x, y and z: shares of black over their colour.
const SHADE: [f64; 3] = [0.0, 0.16, 0.06];

/// The picture plane.
struct View {
    right: Vector,
    up: Vector,
    towards: Vector,
}

impl View {
    fn new() -> Self {
        let towards = unit(VIEWER);
        let left = unit(cross([0.0, 0.0, 1.0], towards));
        // The elevation of a wall file shows the outer face with its x, here y, to the right: the picture is its mirror image.
        View { right: left.map(|v| -v), up: cross(towards, left), towards }
    }

    /// Right and up [m].
    fn at(&self, p: Vector) -> [f64; 2] {
        [dot(self.right, p), dot(self.up, p)]
    }
}

/// Draws the mechanism of the upper bound.
pub fn draw(problem: &Problem, found: &Limit) -> Drawing {
    let view = View::new();
    let bodies = &problem.assembly.bodies;
    let rest: Vec<[Vector; 8]> = bodies.iter().map(|b| b.corners).collect();
    let largest = (0..3).map(|k| extent(&rest, |p| p[k])).map(|[a, b]| b - a).fold(0.0, f64::max);
    let moved: Vec<[Vector; 8]> =
        (0..bodies.len()).map(|i| bodies[i].corners.map(|c| place(problem, found, i, c, MOVED * largest))).collect();
    let stays = |i: usize| bodies[i].corners.iter().all(|c| norm(found.mechanism.at(problem, i, *c)) < STAYS);
    let all: Vec<[Vector; 8]> = rest.iter().chain(&moved).copied().collect();
    let [x, y] = [extent(&all, |p| view.at(p)[0]), extent(&all, |p| view.at(p)[1])];
    let size = [x[1] - x[0], y[1] - y[0]].map(|v| v.max(1e-9));
    let scale = ((WIDTH - 2.0 * ROOM[0]) / size[0]).min(TALLEST * WIDTH / size[1]);
    let left = 0.5 * (WIDTH - size[0] * scale);
    let point = |p: Vector| {
        let [u, v] = view.at(p);
        [left + (u - x[0]) * scale, ROOM[1] + (y[1] - v) * scale]
    };
    let mut canvas = Canvas::default();
    let order = painted(bodies, &view);
    for &i in &order {
        for (face, _) in FACES.into_iter().filter(|f| seen(&view, &rest[i], &f.0)) {
            let corners = face.map(|c| point(rest[i][c]));
            canvas.path(&polygon(&corners), r##"fill="#ececec" stroke="#b4b4b4" stroke-width="0.3""##, None);
        }
    }
    for &i in &order {
        let colour = if stays(i) { "#e9e5df" } else { BRICK };
        for (face, axis) in FACES.into_iter().filter(|f| seen(&view, &moved[i], &f.0)) {
            let corners = face.map(|c| point(moved[i][c]));
            let path = polygon(&corners);
            let attributes = format!(r##"fill="{colour}" stroke="#333" stroke-width="0.4" stroke-linejoin="round""##);
            canvas.path(&path, &attributes, Some(&bodies[i].name));
            if SHADE[axis] > 0.0 {
                let shade = format!(r##"fill="#000" fill-opacity="{}""##, SHADE[axis]);
                canvas.path(&path, &shade, None);
            }
        }
    }
    let kind = found.mechanism.kind.name();
    let title = format!("Mechanism out of the plane at λ = {}: {kind}", significant(found.multiplier(), 4));
    canvas.text([0.5 * WIDTH, 8.0], f64::from(LETTERS[1]), Anchor::Middle, false, "#000", &title);
    let (below, letters) = (ROOM[1] + size[1] * scale, f64::from(LETTERS[0]));
    let still = (0..bodies.len()).filter(|i| stays(*i)).count();
    for (line, text) in [
        format!("brick: {} that move; light: {still} that stay; grey: at rest", bodies.len() - still),
        "outer face in front; wall to scale, its motion enlarged".into(),
    ]
    .iter()
    .enumerate()
    {
        let y = below + 12.0 + line as f64 * (letters + 4.0);
        canvas.text([ROOM[0], y], letters, Anchor::Start, false, "#000", text);
    }
    Drawing { body: canvas.into_body(), size: [WIDTH, below + ROOM[2]], title, note: String::new() }
}

/// A corner after a turn and a shift: `amount` is how far the fastest corner goes.
fn place(problem: &Problem, found: &Limit, body: usize, corner: Vector, amount: f64) -> Vector {
    let centre = problem.assembly.bodies[body].centre;
    let [shift, turn] =
        [found.mechanism.velocities[body], found.mechanism.rotations[body]].map(|v| v.map(|v| v * amount));
    let arm = [0, 1, 2].map(|k| corner[k] - centre[k]);
    let angle = norm(turn);
    let turned = if angle > 0.0 {
        // Rodrigues: a turn as large as it is drawn keeps the shape of a block.
        let axis = turn.map(|v| v / angle);
        let (sin, cos) = angle.sin_cos();
        let (side, along) = (cross(axis, arm), dot(axis, arm));
        [0, 1, 2].map(|k| cos * arm[k] + sin * side[k] + (1.0 - cos) * along * axis[k])
    } else {
        arm
    };
    [0, 1, 2].map(|k| centre[k] + shift[k] + turned[k])
}

fn seen(view: &View, corners: &[Vector; 8], face: &[usize; 4]) -> bool {
    let [a, b, _, d] = face.map(|c| corners[c]);
    let [u, v] = [b, d].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
    dot(cross(u, v), view.towards) > 0.0
}

/// Indices from the farthest body to the nearest, as they are at rest.
fn painted(bodies: &[Body], view: &View) -> Vec<usize> {
    let spans: Vec<[[f64; 2]; 3]> = bodies.iter().map(|b| [0, 1, 2].map(|k| extent(&[b.corners], |p| p[k]))).collect();
    let hides = |near: usize, far: usize| {
        let mut parted = false;
        for k in 0..3 {
            let slack = 1e-9 * (spans[near][k][1] - spans[near][k][0]);
            let ahead = spans[near][k][0] >= spans[far][k][1] - slack;
            let behind = spans[near][k][1] <= spans[far][k][0] + slack;
            match (ahead || behind, ahead == (view.towards[k] > 0.0)) {
                (false, _) => {}
                (true, true) => parted = true,
                (true, false) => return false,
            }
        }
        parted
    };
    // Farthest first among those that nothing waits for; where boxes hide each other in a ring, the farthest goes first.
    let depth = |i: usize| dot(bodies[i].centre, view.towards);
    let mut by_depth: Vec<usize> = (0..bodies.len()).collect();
    by_depth.sort_by(|a, b| depth(*a).total_cmp(&depth(*b)));
    let mut waits: Vec<usize> =
        (0..bodies.len()).map(|i| (0..bodies.len()).filter(|j| *j != i && hides(i, *j)).count()).collect();
    let mut order = Vec::with_capacity(bodies.len());
    while !by_depth.is_empty() {
        let next = by_depth.iter().position(|i| waits[*i] == 0).unwrap_or(0);
        let body = by_depth.remove(next);
        by_depth.iter().filter(|j| hides(**j, body)).for_each(|j| waits[*j] = waits[*j].saturating_sub(1));
        order.push(body);
    }
    order
}

fn extent(all: &[[Vector; 8]], of: impl Fn(Vector) -> f64) -> [f64; 2] {
    all.iter().flatten().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| [a.min(of(*p)), b.max(of(*p))])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

fn unit(a: Vector) -> Vector {
    a.map(|v| v / norm(a))
}
