//! What stands and pulls behind a planar wall: floors, ties, a gable, abutments, side walls of blocks.
//!
//! Loads lie where (OP3) has them, at their level and depth behind the outer face, and push with the mass of what they carry
//! and of what leans on the wall. A side wall is bonded: in every second course its block reaches through to the outer face,
//! and takes the place of what the wall has there. Behind the wall its courses overlap by l, in blocks of 2 l.

use super::assembly::{Assembly, Body, Contact, ContactKind, Cuboid, Vector, length, minus, plus, scaled, touch};
use super::problem::{PointLoad, Problem, Support, Tie};
use super::texture::row;
use crate::{LimitError, Push};

/// Lengths below this are rounding [m].
const NEAR: f64 = 1e-6;

/// A floor or a roof along a wall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Floor {
    /// z [m]: it lies on the blocks that end at this level, or on those that it passes through.
    pub level: f64,
    /// x [m]: distance of its forces from the outer face.
    pub depth: f64,
    /// P [N], from 0: its weight on the wall, which pushes too.
    pub load: f64,
    /// Q [N], from 0: weight that pushes and rests elsewhere.
    pub pushing: f64,
    /// H [N]: thrust, positive outwards.
    pub thrust: f64,
    /// Friction of its seat [N], from 0: against the live load, whichever way that pushes.
    pub friction: f64,
    /// Force up to which it holds the wall back [N], from 0.
    pub connection: f64,
    /// Whether it does not let its level move along the live load.
    pub holds: bool,
}

/// A bonded wall behind another one.
#[derive(Debug, Clone, PartialEq)]
pub struct SideWall {
    /// Its name, with which those of its blocks begin.
    pub name: String,
    /// Its middle along the wall, y [m]; moved inwards where it reaches beyond an end.
    pub at: f64,
    /// t_s [m], above 0.
    pub thickness: f64,
    /// γ [N/m³], above 0.
    pub specific_weight: f64,
    /// h_b [m], above 0. Its courses are those of the wall: others have their overlap for the same slope tan β_b = l/h_b.
    pub course: f64,
    /// l [m], above 0.
    pub overlap: f64,
    /// μ of its joints, from 0.
    pub friction: f64,
    /// Whether its upright joints rub as well.
    pub heads_rub: bool,
    /// q [N/m], from 0: load on its top, which pushes too.
    pub load: f64,
    /// Where it ends, from the inner face [m], above 0. None: where no stepped crack from the base reaches, h tan β_b + l.
    pub ends: Option<f64>,
}

/// A triangular gable, one rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gable {
    /// Left and right end of its base along the wall [m].
    pub base: [f64; 2],
    /// Height [m], above 0.
    pub height: f64,
    /// Thickness [m], above 0.
    pub thickness: f64,
    /// Weight [N], from 0.
    pub weight: f64,
    /// μ of the joint below it, from 0.
    pub friction: f64,
}

/// A wall from a planar one, with what is behind it.
#[derive(Debug, Clone)]
pub struct Backed {
    /// The problem so far.
    pub problem: Problem,
    /// Whether a body is of the wall's own face, by index.
    front: Vec<bool>,
    push: Push,
    /// Level of the top [m].
    top: f64,
    /// Thickest joint [m].
    mortar: f64,
}

impl Backed {
    /// Of what [`super::of_wall`] made of a planar problem, its outer face x = 0, and the wall's thickest mortar joint [m].
    pub fn of(problem: Problem, push: Push, blocks: usize, mortar: f64) -> Self {
        let front: Vec<bool> = (0..problem.assembly.bodies.len()).map(|i| i < blocks).collect();
        let tops = problem.assembly.bodies.iter().zip(&front).filter(|(_, f)| **f).map(|(b, _)| span(b, 2)[1]);
        Backed { top: tops.fold(0.0, f64::max), problem, front, push, mortar }
    }

    /// The wall's own bodies, with their edges.
    fn own(&self) -> impl Iterator<Item = (usize, [[f64; 2]; 3])> + '_ {
        let bodies = self.problem.assembly.bodies.iter().enumerate();
        bodies.filter(|(i, _)| self.front[*i]).map(|(i, b)| (i, edges(b)))
    }

    /// Where the live load does not push to.
    fn against(&self) -> Vector {
        scaled(self.problem.direction, -1.0 / length(self.problem.direction))
    }

    /// What a force of mass pushes with: with the top course pushed alone, what presses on it.
    fn pushes(&self, level: f64, load: f64, pushing: f64) -> f64 {
        match self.push {
            Push::Body => load + pushing,
            Push::Top if level >= self.top - NEAR => load,
            Push::Top => 0.0,
        }
    }

    /// Lays a floor, spread evenly over the blocks at its level.
    ///
    /// # Errors
    /// No block at its level.
    pub fn floor(&mut self, floor: &Floor) -> Result<(), LimitError> {
        let z = floor.level;
        let reaches = |e: &[f64; 2]| e[0] - self.mortar < z - NEAR && z <= e[1] + NEAR;
        let mut at: Vec<(usize, [[f64; 2]; 3])> = self.own().filter(|(_, e)| reaches(&e[2])).collect();
        // Of blocks on each other that both reach there through their mortar, the lower one ends at the level.
        let beside = |a: [f64; 2], b: [f64; 2]| a[0].max(b[0]) < a[1].min(b[1]) - NEAR;
        let all = at.clone();
        at.retain(|(_, e)| !all.iter().any(|(_, o)| beside(o[1], e[1]) && o[2][1] < e[2][1] - NEAR));
        let whole: f64 = at.iter().map(|(_, e)| e[1][1] - e[1][0]).sum();
        if at.is_empty() {
            return Err(LimitError::Wrong(format!("no block lies at z = {z} m, where a floor does")));
        }
        let against = self.against();
        for (body, [x, y, _]) in at {
            let part = (y[1] - y[0]) / whole;
            let at = [x[0] + floor.depth, 0.5 * (y[0] + y[1]), z];
            let force = [-part * floor.thrust, 0.0, -part * floor.load];
            let pushes = part * self.pushes(z, floor.load, floor.pushing);
            self.problem.loads.push(PointLoad { body, at, force, pushes });
            let mut hold = |way: Vector, yields: f64| {
                if yields > 0.0 {
                    let end = plus(at, way);
                    self.problem.ties.push(Tie { body, to: None, at, end, yields: part * yields });
                }
            };
            hold(against, floor.friction);
            hold([1.0, 0.0, 0.0], floor.connection);
            if floor.holds {
                let ends = y.map(|y| Support { body, at: [at[0], y, z], direction: against, friction: 0.0 });
                self.problem.supports.extend(ends);
            }
        }
        Ok(())
    }

    /// Ties the wall back at a level and a place along it [m] with a force [N], by a plate on the outer face. False: there is an
    /// opening, and the plate lies on the block next to it.
    pub fn anchor(&mut self, level: f64, along: f64, yields: f64) -> bool {
        let Some((body, e, off)) = self.nearest(level, along) else { return false };
        let at = [e[0][0], along, level];
        self.problem.ties.push(Tie { body, to: None, at, end: plus(at, [1.0, 0.0, 0.0]), yields });
        off <= self.mortar + NEAR
    }

    /// A force at a corner's top [N], at a place along the wall and behind its outer face [m], on the nearest block.
    pub fn at_top(&mut self, along: f64, depth: f64, force: Vector, load: f64, pushing: f64) {
        let pushes = self.pushes(self.top, load, pushing);
        let Some((body, e, _)) = self.nearest(self.top, along) else { return };
        self.problem.loads.push(PointLoad { body, at: [e[0][0] + depth, along, self.top], force, pushes });
    }

    /// The wall's own block nearest to a place, its edges and its distance; of two at a joint the lower.
    fn nearest(&self, level: f64, along: f64) -> Option<(usize, [[f64; 2]; 3], f64)> {
        let off = |e: &[[f64; 2]; 3]| {
            let beyond = |e: [f64; 2], v: f64| (e[0] - v).max(v - e[1]).max(0.0);
            beyond(e[1], along).hypot(beyond(e[2], level))
        };
        let all = self.own().map(|(i, e)| (i, e, off(&e)));
        all.min_by(|a, b| (a.2, a.1[2][0]).partial_cmp(&(b.2, b.1[2][0])).unwrap_or(std::cmp::Ordering::Equal))
    }

    /// Sets a gable on the wall, its outer face on the wall's, and gives its number among the bodies.
    pub fn gable(&mut self, gable: &Gable) -> usize {
        let (body, ridge) = (self.problem.assembly.bodies.len(), 0.5 * (gable.base[0] + gable.base[1]));
        let tops: Vec<(usize, [[f64; 2]; 3])> = self.own().filter(|(_, e)| e[2][1] >= self.top - NEAR).collect();
        let face = tops.iter().map(|(_, e)| e[0][0]).fold(f64::INFINITY, f64::min);
        let corner = |index: usize| {
            let (upper, right) = (index >> 2 & 1 == 1, index >> 1 & 1);
            let y = if upper { ridge } else { gable.base[right] };
            let z = if upper { self.top + gable.height } else { self.top };
            [face + (index & 1) as f64 * gable.thickness, y, z]
        };
        self.problem.assembly.bodies.push(Body {
            name: "gable".into(),
            centre: [face + 0.5 * gable.thickness, ridge, self.top + gable.height / 3.0],
            corners: [0, 1, 2, 3, 4, 5, 6, 7].map(corner),
            weight: gable.weight,
        });
        self.add_unloaded(false);
        for (below, [x, y, _]) in tops {
            let [from, to] = [y[0].max(gable.base[0]), y[1].min(gable.base[1])];
            let [outer, inner] = [x[0].max(face), x[1].min(face + gable.thickness)];
            if to - from > NEAR && inner - outer > NEAR {
                let z = self.top;
                self.problem.assembly.contacts.push(Contact {
                    name: format!("{}|gable", self.problem.assembly.bodies[below].name),
                    kind: ContactKind::Bed,
                    a: below,
                    b: Some(body),
                    corners: [[outer, from, z], [inner, from, z], [inner, to, z], [outer, to, z]],
                    normal: [0.0, 0.0, 1.0],
                    friction: gable.friction,
                    gives_way: None,
                });
            }
        }
        body
    }

    /// A force on the ridge of the gable [N], at a depth behind its outer face [m].
    pub fn at_ridge(&mut self, gable: usize, depth: f64, load: f64, pushing: f64, thrust: f64) {
        let [x, y, z] = edges(&self.problem.assembly.bodies[gable]);
        let at = [x[0] + depth, 0.5 * (y[0] + y[1]), z[1]];
        let pushes = if self.push == Push::Body { load + pushing } else { 0.0 };
        self.problem.loads.push(PointLoad { body: gable, at, force: [-thrust, 0.0, -load], pushes });
    }

    /// The last body pushes with its weight, if bodies do.
    fn add_unloaded(&mut self, front: bool) {
        self.problem.pushed.push(self.push == Push::Body);
        self.problem.held.push(false);
        self.front.push(front);
    }

    /// Abutments at both ends of all above a level [m], which give way at a thrust [N], spread evenly over the height.
    pub fn abutments(&mut self, from: f64, thrust: f64, friction: f64) {
        let above: Vec<(usize, [[f64; 2]; 3])> =
            self.own().filter(|(_, e)| e[2][0] >= from - self.mortar - NEAR).collect();
        let ends =
            self.own().fold([f64::INFINITY, f64::NEG_INFINITY], |w, (_, e)| [w[0].min(e[1][0]), w[1].max(e[1][1])]);
        for (side, normal) in [(0, -1.0), (1, 1.0)] {
            let at = |e: &[[f64; 2]; 3]| (e[1][side] - ends[side]).abs() <= self.mortar + NEAR;
            let last: Vec<_> = above.iter().filter(|(_, e)| at(e)).collect();
            let whole: f64 = last.iter().map(|(_, e)| e[2][1] - e[2][0]).sum();
            for (body, [x, y, z]) in last {
                let y = y[side];
                self.problem.assembly.contacts.push(Contact {
                    name: format!("{}|abutment", self.problem.assembly.bodies[*body].name),
                    kind: ContactKind::Head,
                    a: *body,
                    b: None,
                    corners: [[x[0], y, z[0]], [x[1], y, z[0]], [x[1], y, z[1]], [x[0], y, z[1]]],
                    normal: [0.0, normal, 0.0],
                    friction,
                    gives_way: Some(thrust * (z[1] - z[0]) / whole),
                });
            }
        }
    }

    /// Builds a side wall, block by block; before floors and ties, which lie on its blocks too. Gives its depth behind the inner
    /// face [m].
    ///
    /// # Errors
    /// No courses of the wall to bond with: an opening, or blocks of which none ends where others do.
    pub fn side_wall(&mut self, side: &SideWall) -> Result<f64, LimitError> {
        let ends =
            self.own().fold([f64::INFINITY, f64::NEG_INFINITY], |w, (_, e)| [w[0].min(e[1][0]), w[1].max(e[1][1])]);
        let from = (side.at - 0.5 * side.thickness).min(ends[1] - side.thickness).max(ends[0]);
        let strip = [from, from + side.thickness];
        let levels = self.levels(strip)?;
        let rows: Vec<[f64; 2]> = levels.windows(2).map(|w| [w[0], w[1]]).collect();
        let overlap = side.overlap / side.course * self.top / rows.len() as f64;
        let inner = self.within(strip).map(|(_, e)| e[0][1]).fold(0.0, f64::max);
        let slope = side.overlap / side.course;
        let deep = side.ends.unwrap_or(self.top * slope + overlap);
        self.cut(&rows, strip);
        let mut boxes = Vec::new();
        for (c, z) in rows.iter().enumerate() {
            let bonds = c % 2 == 1;
            let middle = 0.5 * (z[0] + z[1]);
            let beside = || self.own().filter(|(_, e)| e[2][0] < middle && middle < e[2][1]);
            let here = || self.within(strip).filter(|(_, e)| e[2][0] < middle && middle < e[2][1]);
            // A course that is bonded begins at the face of its neighbours.
            let face = beside().map(|(_, e)| e[0][0]).fold(f64::INFINITY, f64::min);
            let back = here().map(|(_, e)| e[0][1]).fold(f64::NEG_INFINITY, f64::max);
            let start = if bonds { if face.is_finite() { face } else { 0.0 } } else { back };
            let first = inner - start + if bonds { overlap } else { 2.0 * overlap };
            for (k, x) in row(start, inner + deep, first, 2.0 * overlap).into_iter().enumerate() {
                let name = format!("{}c{}b{}", side.name, c + 1, k + 1);
                boxes.push((
                    Cuboid { name, edges: [x, strip, *z], specific_weight: side.specific_weight },
                    bonds && k == 0,
                ));
            }
        }
        self.join(side, &boxes)?;
        let tops = boxes.iter().enumerate().filter(|(_, (b, _))| side.load > 0.0 && b.edges[2][1] >= self.top - NEAR);
        let first = self.problem.assembly.bodies.len() - boxes.len();
        for (k, (of, _)) in tops {
            let [x, y, z] = of.edges;
            let load = side.load * (x[1] - x[0].max(inner)).max(0.0);
            let at = [0.5 * (x[0].max(inner) + x[1]), 0.5 * (y[0] + y[1]), z[1]];
            let pushes = if self.push == Push::Body { load } else { 0.0 };
            if load > 0.0 {
                self.problem.loads.push(PointLoad { body: first + k, at, force: [0.0, 0.0, -load], pushes });
            }
        }
        Ok(deep)
    }

    /// The wall's own bodies within a strip along it.
    fn within(&self, strip: [f64; 2]) -> impl Iterator<Item = (usize, [[f64; 2]; 3])> + '_ {
        self.own().filter(move |(_, e)| e[1][0].max(strip[0]) < e[1][1].min(strip[1]) - NEAR)
    }

    /// Planes of bed joints through a strip that no body crosses, from base to top.
    fn levels(&self, strip: [f64; 2]) -> Result<Vec<f64>, LimitError> {
        let there: Vec<[[f64; 2]; 3]> = self.within(strip).map(|(_, e)| e).collect();
        let mut planes: Vec<f64> = vec![0.0, self.top];
        for e in &there {
            let above =
                there.iter().map(|o| o[2][0]).filter(|z| *z > e[2][1] - NEAR && *z <= e[2][1] + self.mortar + NEAR);
            planes.extend(above.reduce(f64::min).map(|z| 0.5 * (e[2][1] + z)));
        }
        planes.retain(|z| !there.iter().any(|e| e[2][0] < z - NEAR && z + NEAR < e[2][1]));
        planes.sort_by(f64::total_cmp);
        planes.dedup_by(|a, b| (*a - *b).abs() < NEAR);
        let area: f64 =
            there.iter().map(|[_, y, z]| (y[1].min(strip[1]) - y[0].max(strip[0])) * (z[1] - z[0] + self.mortar)).sum();
        let whole = (strip[1] - strip[0]) * self.top;
        if planes.len() < 3 || area < FILLED * whole {
            return Err(LimitError::Wrong("the wall has an opening there, or no courses to bond with".into()));
        }
        Ok(planes)
    }

    /// Takes a strip out of every second row of the wall.
    fn cut(&mut self, rows: &[[f64; 2]], strip: [f64; 2]) {
        let old = self.problem.clone();
        let bonds = |e: &[[f64; 2]; 3]| {
            let middle = 0.5 * (e[2][0] + e[2][1]);
            rows.iter().skip(1).step_by(2).any(|z| z[0] < middle && middle < z[1])
        };
        // What is left of every body: its new number, and where along the wall.
        let mut left: Vec<Vec<(usize, [f64; 2])>> = Vec::with_capacity(old.assembly.bodies.len());
        let (mut bodies, mut front, mut pushed, mut held) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (i, body) in old.assembly.bodies.iter().enumerate() {
            let e = edges(body);
            let [a, b] = e[1];
            let hit = self.front[i] && bonds(&e) && a.max(strip[0]) < b.min(strip[1]) - NEAR;
            let parts = if hit { vec![[a, b.min(strip[0])], [a.max(strip[1]), b]] } else { vec![[a, b]] };
            let parts: Vec<[f64; 2]> = parts.into_iter().filter(|p| p[1] - p[0] > NEAR).collect();
            let mut own = Vec::new();
            for (k, part) in parts.iter().enumerate() {
                own.push((bodies.len(), *part));
                bodies.push(piece(body, *part, if k == 0 { "" } else { "r" }));
                front.push(self.front[i]);
                pushed.push(old.pushed[i]);
                held.push(old.held[i]);
            }
            left.push(own);
        }
        let mut contacts = Vec::new();
        for contact in &old.assembly.contacts {
            let [p, q] = along(contact);
            let upright = contact.normal[1].abs() > 0.5;
            let ends = |body: usize| edges(&old.assembly.bodies[body])[1];
            let whole = [f64::NEG_INFINITY, f64::INFINITY];
            let others =
                contact.b.map_or(vec![(None, whole)], |b| left[b].iter().map(|(i, p)| (Some(*i), *p)).collect());
            for (a, own) in &left[contact.a] {
                for (b, other) in &others {
                    if upright {
                        // The sides that touched are still there.
                        let [of_a, of_b] = [ends(contact.a), contact.b.map_or(whole, ends)];
                        if own[1] == of_a[1] && other[0] == of_b[0] {
                            contacts.push(Contact { a: *a, b: *b, ..contact.clone() });
                        }
                        continue;
                    }
                    let [from, to] = [p.max(own[0]).max(other[0]), q.min(own[1]).min(other[1])];
                    if to - from > NEAR {
                        let mut corners = contact.corners;
                        corners.iter_mut().for_each(|c| c[1] = c[1].clamp(from, to));
                        contacts.push(Contact { a: *a, b: *b, corners, ..contact.clone() });
                    }
                }
            }
        }
        let mut loads = Vec::new();
        for load in &old.loads {
            let [a, b] = edges(&old.assembly.bodies[load.body])[1];
            for (body, part) in &left[load.body] {
                let share = (part[1] - part[0]) / (b - a);
                let at = [load.at[0], load.at[1] + 0.5 * (part[0] + part[1] - a - b), load.at[2]];
                let (force, pushes) = (scaled(load.force, share), share * load.pushes);
                loads.push(PointLoad { body: *body, at, force, pushes });
            }
        }
        self.problem.assembly = Assembly { bodies, contacts };
        (self.problem.loads, self.problem.pushed, self.problem.held, self.front) = (loads, pushed, held, front);
    }

    /// Adds boxes of a side wall and where they touch each other, the wall and the base; those that are bonded are the wall's.
    fn join(&mut self, side: &SideWall, boxes: &[(Cuboid, bool)]) -> Result<(), LimitError> {
        let reached: Vec<f64> = boxes.iter().flat_map(|(b, _)| b.edges[2]).collect();
        // Blocks of the wall reach to the middle of their mortar, as the boxes do.
        let to_plane =
            |z: f64| reached.iter().copied().find(|p| (p - z).abs() <= 0.5 * self.mortar + NEAR).unwrap_or(z);
        let base = |z: f64| if z <= self.mortar + NEAR { 0.0 } else { to_plane(z) };
        let wall: Vec<Cuboid> = self
            .problem
            .assembly
            .bodies
            .iter()
            .map(|b| {
                let [x, y, z] = edges(b);
                Cuboid { name: b.name.clone(), edges: [x, y, [base(z[0]), to_plane(z[1])]], specific_weight: 1.0 }
            })
            .collect();
        let first = wall.len();
        let mut contacts = Vec::new();
        for (k, (own, _)) in boxes.iter().enumerate() {
            let i = first + k;
            if own.edges[2][0] <= NEAR {
                let [x, y, _] = own.edges;
                contacts.push(Contact {
                    name: format!("base|{}", own.name),
                    kind: ContactKind::Base,
                    a: i,
                    b: None,
                    corners: [[x[0], y[0], 0.0], [x[1], y[0], 0.0], [x[1], y[1], 0.0], [x[0], y[1], 0.0]],
                    normal: [0.0, 0.0, -1.0],
                    friction: side.friction,
                    gives_way: None,
                });
            }
            let later = boxes.iter().enumerate().skip(k + 1).map(|(j, (b, _))| (first + j, b));
            for (j, other) in wall.iter().enumerate().chain(later) {
                let found = touch([j, i], [other, own], NEAR, side.friction);
                let found = found.map_err(|e| LimitError::Wrong(format!("side wall {}: {e}", side.name)))?;
                contacts.extend(found.map(|contact| match contact.kind {
                    ContactKind::Head if !side.heads_rub => Contact { friction: 0.0, ..contact },
                    _ => contact,
                }));
            }
        }
        self.problem.assembly.contacts.extend(contacts);
        for (own, bonds) in boxes {
            self.problem.assembly.bodies.push(super::assembly::body(own));
            self.add_unloaded(*bonds);
        }
        Ok(())
    }
}

/// Part of a strip that stones fill at least where a side wall can be bonded; mortar is the rest.
const FILLED: f64 = 0.8;

fn span(body: &Body, k: usize) -> [f64; 2] {
    let of = |far: fn(f64, f64) -> f64, from: f64| body.corners.iter().map(|c| c[k]).fold(from, far);
    [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
}

fn edges(body: &Body) -> [[f64; 2]; 3] {
    [0, 1, 2].map(|k| span(body, k))
}

/// Ends of a contact along the wall.
fn along(contact: &Contact) -> [f64; 2] {
    contact.corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |w, c| [w[0].min(c[1]), w[1].max(c[1])])
}

/// A part of a body along the wall.
fn piece(body: &Body, [from, to]: [f64; 2], suffix: &str) -> Body {
    let [a, b] = span(body, 1);
    if from == a && to == b {
        return body.clone();
    }
    let moved = 0.5 * (from + to - a - b);
    let corner = |c: Vector| [c[0], c[1].clamp(from, to), c[2]];
    Body {
        name: format!("{}{suffix}", body.name),
        centre: plus(body.centre, [0.0, moved, 0.0]),
        corners: body.corners.map(corner),
        weight: body.weight * (to - from) / (b - a),
    }
}

impl Problem {
    /// The wall with its faces exchanged: x is measured from the face that was the inner one. Loads keep their side.
    pub fn inside_out(mut self) -> Self {
        let thickest = self.assembly.bodies.iter().map(|b| span(b, 0)[1]).fold(0.0, f64::max);
        let of = |p: Vector| minus([thickest, p[1], p[2]], [p[0], 0.0, 0.0]);
        for body in &mut self.assembly.bodies {
            body.centre = of(body.centre);
            let old = body.corners;
            body.corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|index| of(old[index ^ 1]));
        }
        for contact in &mut self.assembly.contacts {
            contact.corners = contact.corners.map(of);
            contact.normal[0] = -contact.normal[0];
        }
        self.loads.iter_mut().for_each(|load| load.at = of(load.at));
        self
    }
}
