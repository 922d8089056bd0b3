//! What gives way where a wall is held, at a trial multiplier.
//!
//! A floor that holds the wall gives way in one of two manners. Its connection, its seat and ties come to their full force, as in (OP3), and
//! the wall pushes with all that the floor weighs. Or the bed joints below and above the course that it holds slide: course and floor stay
//! in their place and push nothing. Per outward displacement of the wall at the floor they take from (OP1)
//!
//! Σ (T + F + μ_f P − H) − α Σ (P + Q), μ (N_below + N_above).
//!
//! The course turns with the wall about the level of its floor, and rises with it. Both are mechanisms, and α0 of each bounds that of the wall from above. For a trial α the lower one counts and α follows, which falls until
//! it settles (Dinkelbach, as in [`crate::overturning`]). A floor without a known force has the second manner alone.

use crate::facade::{Floor, Masonry, Piece, Tie};
use crate::wall::{FloorOf, Wall};

/// Heights within this are one level [m].
const LEVEL: f64 = 1e-6;
/// Trials; they settle in a few.
const TRIALS: usize = 12;

/// A course that floors hold.
#[derive(Debug, Clone)]
struct Held {
    /// Level of the floor [m].
    level: f64,
    /// Bottom and top of the course [m].
    course: [f64; 2],
    /// Floors and ties on it, by their numbers.
    floors: Vec<usize>,
    ties: Vec<usize>,
    /// Force at which connection, seat and ties give way [N]; none where nothing says.
    borne: Option<f64>,
    /// Friction of both bed joints [N].
    rubs: f64,
    /// Weight of the course [N].
    weight: f64,
}

/// The supports of a wall.
#[derive(Debug, Clone)]
pub(crate) struct Supports<'w> {
    wall: &'w Wall,
    held: Vec<Held>,
    /// Level [m] of ties by themselves, their force, and what the bed joints of their course bear by friction [N], where that is less.
    slipping: Vec<(f64, [f64; 2])>,
}

/// What acts on the wall at a trial α.
#[derive(Debug, Clone)]
pub(crate) struct Yielding<'s> {
    /// Masonry without courses that stay.
    pub(crate) masonry: Masonry,
    /// Floors; one whose course stays carries that, and has the friction of its joints as its connection.
    pub(crate) floors: Vec<Floor>,
    /// Ties, without those on courses that stay.
    pub(crate) ties: Vec<Tie>,
    /// Level [m] of each floor that holds, its force [N], and whether its course stays.
    pub(crate) forces: Vec<(f64, f64, bool)>,
    /// Of [`Supports`].
    slipping: &'s [(f64, [f64; 2])],
}

impl<'w> Supports<'w> {
    pub(crate) fn of(wall: &'w Wall) -> Supports<'w> {
        let mut held: Vec<Held> = Vec::new();
        for own in wall.floors.iter().filter(|f| f.holds) {
            let level = own.floor.level;
            let [low, high] = course(wall, level);
            if held.iter().any(|h| (h.course[0] - low).abs() < LEVEL) {
                continue;
            }
            let on_it = |z: f64| z > low + LEVEL && z <= high + LEVEL;
            let numbers = |levels: Vec<f64>| (0..levels.len()).filter(|i| on_it(levels[*i])).collect::<Vec<_>>();
            let floors = numbers(wall.floors.iter().map(|f| f.floor.level).collect());
            let ties = numbers(wall.ties.iter().map(|t| t.level).collect());
            let holding = || floors.iter().map(|i| &wall.floors[*i]).filter(|f| f.holds);
            // Ties beside them count once.
            let beside = wall.beside(level);
            let of = |f: &FloorOf| wall.borne(f).map(|borne| borne - wall.beside(f.floor.level));
            let borne = holding().map(of).sum::<Option<f64>>().map(|floors| floors + beside);
            let (rubs, weight) = (rubs(wall, [low, high]), wall.masonry.between(low, high).weight);
            held.push(Held { level, course: [low, high], floors, ties, borne, rubs, weight });
        }
        let held_tie = |i: usize| held.iter().any(|h| h.ties.contains(&i));
        let mut slipping: Vec<(f64, [f64; 2])> = Vec::new();
        for (_, tie) in wall.ties.iter().enumerate().filter(|(i, _)| !held_tie(*i)) {
            let own = course(wall, tie.level);
            let of_course = |other: &&Tie| course(wall, other.level) == own;
            let force: f64 = wall.ties.iter().filter(of_course).map(|tie| tie.force).sum();
            let bears = rubs(wall, own);
            if force > bears && slipping.iter().all(|(z, _)| course(wall, *z) != own) {
                slipping.push((tie.level, [force, bears]));
            }
        }
        Supports { wall, held, slipping }
    }

    /// Levels [m] of floors that hold whatever pushes, as long as their courses do not slide.
    pub(crate) fn rigid(&self) -> impl Iterator<Item = f64> {
        self.held.iter().filter(|h| h.borne.is_none()).map(|h| h.level)
    }

    /// Whether nothing can turn about a joint, for a floor that holds whatever pushes has the course on it.
    pub(crate) fn blocks(&self, joint: f64) -> bool {
        let on_joint = |h: &Held| h.course[0] <= joint + LEVEL && joint < h.level - LEVEL;
        self.held.iter().any(|h| h.borne.is_none() && on_joint(h))
    }

    /// Floors as parts of the wall have them that turn by themselves: a known force holds no more than the bed joints of its course bear.
    /// From the bed joint `slid` [m] on courses whose floors have none slide: floors stay on them.
    pub(crate) fn of_parts(&self, slid: f64) -> Vec<Floor> {
        let mut floors: Vec<Floor> = self.wall.floors.iter().map(|f| f.floor).collect();
        for held in &self.held {
            let mut left = held.rubs;
            for i in &held.floors {
                let own = floors[*i];
                let bears = own.connection + own.friction * own.load;
                if held.borne.is_none() && held.level > slid + LEVEL {
                    floors[*i] = stands(&own, left);
                    left = 0.0;
                } else if held.borne.is_some() && bears > left {
                    floors[*i] = Floor { connection: left, friction: 0.0, ..own };
                    left = 0.0;
                } else {
                    left -= bears;
                }
            }
        }
        floors
    }

    /// What acts at a trial α on what moves between two levels [m].
    pub(crate) fn at(&self, alpha: f64, between: [f64; 2]) -> Yielding<'_> {
        let wall = self.wall;
        let floors = wall.floors.iter().map(|f| f.floor).collect();
        let mut found = Yielding {
            masonry: wall.masonry.clone(),
            floors,
            ties: Vec::new(),
            forces: Vec::new(),
            slipping: &self.slipping,
        };
        let mut gone = Vec::new();
        let inside = |h: &&Held| h.level > between[0] + LEVEL && h.level < between[1] - LEVEL;
        for held in self.held.iter().filter(inside) {
            // A course on the hinge turns, or nothing does.
            let free = held.course[0] > between[0] + LEVEL;
            let stays = held.borne.is_none() || free && self.gives(held, alpha) > held.rubs + alpha * held.weight;
            found.forces.push((held.level, if stays { held.rubs } else { held.borne.unwrap_or_default() }, stays));
            if stays {
                held.stays(&mut found);
                gone.extend(&held.ties);
            }
        }
        found.ties = wall.ties.iter().enumerate().filter(|(i, _)| !gone.contains(i)).map(|(_, tie)| *tie).collect();
        found
    }

    /// What a course that moves takes from (OP1) per displacement [N].
    fn gives(&self, held: &Held, alpha: f64) -> f64 {
        let floors = held.floors.iter().map(|i| self.wall.floors[*i].floor);
        let of_floors: f64 =
            floors.map(|f| f.connection + f.friction * f.load - f.thrust - alpha * (f.load + f.pushing)).sum();
        of_floors + held.ties.iter().map(|i| self.wall.ties[*i].force).sum::<f64>()
    }

    /// The least of what is made of floors and ties between two levels [m] that give way.
    pub(crate) fn least<T>(
        &self,
        between: [f64; 2],
        make: impl Fn(&Yielding<'_>) -> Option<T>,
        multiplier: impl Fn(&T) -> f64,
    ) -> Option<(T, Yielding<'_>)> {
        let first = self.at(0.0, between);
        let mut found = (make(&first)?, first);
        for _ in 0..TRIALS {
            let alpha = multiplier(&found.0);
            let next = self.at(alpha, between);
            let made = make(&next)?;
            if !(multiplier(&made) < alpha - 1e-13 * alpha.abs()) {
                break;
            }
            found = (made, next);
        }
        Some(found)
    }
}

impl Held {
    /// The course stays: what lies on it rises with the wall, and does not go out.
    fn stays(&self, found: &mut Yielding<'_>) {
        let [low, high] = self.course;
        let in_it = |p: &Piece| Piece { z: [p.z[0].max(low), p.z[1].min(high)], weight: -p.weight, ..*p };
        let taken: Vec<Piece> = found.masonry.pieces.iter().map(in_it).filter(|p| p.z[1] > p.z[0]).collect();
        found.masonry.pieces.extend(taken);
        for (k, i) in self.floors.iter().enumerate() {
            let own = &mut found.floors[*i];
            let (weight, rubs) = if k == 0 { (self.weight, self.rubs) } else { (0.0, 0.0) };
            let load = own.load + weight;
            let moment = own.load * own.depth + weight * 0.5 * found.masonry.thickness;
            let depth = if load > 0.0 { moment / load } else { own.depth };
            *own = stands(&Floor { load, depth, ..*own }, rubs);
        }
    }
}

/// A floor that stays on a course that rubs.
fn stands(floor: &Floor, rubs: f64) -> Floor {
    Floor { pushing: -floor.load, thrust: 0.0, friction: 0.0, connection: rubs, ..*floor }
}

impl Yielding<'_> {
    /// What gives way between two levels [m], in words.
    pub(crate) fn told(&self, levels: [f64; 2]) -> Vec<String> {
        let inside = self.forces.iter().filter(|(z, ..)| *z > levels[0] + LEVEL && *z < levels[1] - LEVEL);
        let of = |(z, force, stays): &(f64, f64, bool)| match stays {
            false => format!("the floor at {z:.2} m gives way at {:.2} kN", 1e-3 * force),
            true => format!("the floor at {z:.2} m stays, and its course slides at {:.2} kN", 1e-3 * force),
        };
        let tied = self.slipping.iter().filter(|(z, _)| *z > levels[0] + LEVEL && *z < levels[1] - LEVEL);
        let slips = |(z, [force, bears]): &(f64, [f64; 2])| {
            format!(
                "ties at {z:.2} m hold {:.2} kN, and the bed joints of their course bear {:.2} kN: α0 is too high where blocks slide from there",
                1e-3 * force,
                1e-3 * bears
            )
        };
        inside.map(of).chain(tied.map(slips)).collect()
    }
}

/// Bottom and top of the course of a level [m].
fn course(wall: &Wall, level: f64) -> [f64; 2] {
    let high = wall.levels.iter().copied().find(|z| *z >= level - LEVEL).unwrap_or(wall.top.max(level));
    [wall.joint_below(level), high]
}

/// Friction of the bed joints below and above a course [N].
fn rubs(wall: &Wall, [low, high]: [f64; 2]) -> f64 {
    let load = |from: f64| wall.floors.iter().filter(|f| f.floor.level > from).map(|f| f.floor.load).sum::<f64>();
    let below = wall.masonry.above(low).weight + load(low + LEVEL);
    let above = wall.masonry.above(high).weight + load(high + LEVEL);
    wall.friction * (below + above)
}
