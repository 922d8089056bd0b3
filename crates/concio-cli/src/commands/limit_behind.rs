//! What `concio limit --out-of-plane` takes from the table `[out_of_plane]`, as `concio mechanisms` does.

use concio::case::{CaseFile, FrictionLaw, FrictionOn, OutOfPlane, out_of_plane};
use concio_limit::space::{Backed, Floor, Gable, Problem, SideWall};
use concio_limit::{CERTIFIED, Problem as Planar, Push};
use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::{Found, Kind, Shape, survey};
use concio_mechanisms::wall::{Side, Wall};
use serde_json::{Value, json};

use super::limit::failure;
use super::wall_file;
use crate::args::{Limit as Asked, LimitLoad, Side as Towards};
use crate::failure::Failure;
use crate::format::{counted, percent, significant};

/// λ below which it is 0.
pub(super) const NOTHING: f64 = 1e-6;

/// What stands and pulls behind the wall.
pub(super) struct Behind {
    floors: usize,
    ties: usize,
    /// Depth behind the inner face [m] of every side wall.
    side_walls: Vec<f64>,
    /// Blocks of side walls.
    blocks: usize,
    gable: bool,
    /// The least closed forms of their kinds that push as this does, the lowest first.
    pub(super) closed: Vec<Closed>,
}

/// A mechanism of the survey.
pub(super) struct Closed {
    multiplier: f64,
    hinge: f64,
    kind: &'static str,
    what: String,
}

/// f_h [Pa], for a rectangle of pressure: a triangle sets hinges back by as much at three quarters of it.
pub(super) fn strength(table: &OutOfPlane) -> Option<f64> {
    let part = match table.pressure {
        out_of_plane::PressureBlock::Rectangular => 1.0,
        out_of_plane::PressureBlock::Triangular => 0.75,
    };
    table.strength.map(|f| part * f.si())
}

/// The problem with what is behind the wall, what that is, and what is left out or taken otherwise than it may be meant.
pub(super) fn add(
    problem: Problem,
    file: &CaseFile,
    planar: &Planar,
    args: &Asked,
) -> Result<(Problem, Behind, Vec<String>), Failure> {
    let wall = concio::facade::of(&file.case).map_err(|e| wall_file::all(file, file.locate(e)))?;
    let told = |e| failure(e, &args.file);
    let push = if args.load == LimitLoad::Top { Push::Top } else { Push::Body };
    let mortar = file.case.panels.iter().flat_map(|p| [p.mortar.bed.si(), p.mortar.head.si()]).fold(0.0, f64::max);
    let problem = if wall.back { problem.inside_out() } else { problem };
    let before = problem.assembly.bodies.len();
    let mut backed = Backed::of(problem, push, planar.wall.blocks.len(), mortar);
    let doubts = concio::facade::doubts(&file.case, &wall);
    let mut warnings: Vec<String> = doubts.into_iter().map(|doubt| doubt.text).collect();
    let mut side_walls = Vec::new();
    for (i, side) in wall.side_walls.iter().enumerate() {
        match backed.side_wall(&of_side(file, i, side)) {
            Ok(deep) => side_walls.push(deep),
            Err(why) => warnings.push(format!("the side wall at x = {} m is left out: {why}", significant(side.at, 4))),
        }
    }
    let blocks = backed.problem.assembly.bodies.len().saturating_sub(before);
    for own in wall.floors.iter().filter(|f| f.given) {
        // A support of known strength gives way at it; ties near it are there themselves.
        let holds = own.holds && wall.borne(own).is_none();
        let f = own.floor;
        let floor = Floor {
            level: f.level,
            depth: f.depth,
            load: f.load,
            pushing: f.pushing,
            thrust: f.thrust,
            friction: f.friction * f.load,
            connection: f.connection,
            holds,
        };
        backed.floor(&floor).map_err(told)?;
        let at = significant(f.level, 4);
        if own.clamps {
            warnings.push(format!(
                "the clamping of the floor at {at} m is left out: its load stays in its place, and λ is too low"
            ));
        }
        if holds {
            warnings.push(format!("the floor at {at} m holds whatever pushes: without a connection λ may be too high"));
        }
    }
    for tie in &wall.ties {
        if !backed.anchor(tie.level, tie.position, tie.force) {
            let [z, x] = [tie.level, tie.position].map(|v| significant(v, 4));
            warnings
                .push(format!("the anchor at x = {x} m, z = {z} m lies in an opening: it holds the block beside it"));
        }
    }
    for side in &wall.side_walls {
        add_corner(&mut backed, &wall, side);
    }
    let has_beam = planar.assembly.bodies.len() > planar.wall.blocks.len();
    if let (Some((gable, _)), false) = (wall.gable, has_beam) {
        let middle = 0.5 * (wall.extent[0] + wall.extent[1]);
        let base = [middle - 0.5 * gable.base, middle + 0.5 * gable.base];
        let (height, thickness, weight) = (gable.height, gable.thickness, gable.weight());
        let number = backed.gable(&Gable { base, height, thickness, weight, friction: wall.friction });
        backed.at_ridge(number, gable.depth, gable.load, gable.pushing, gable.thrust);
        warnings.push("the gable is one rigid body: flaps of it may fall below λ".into());
    } else if wall.gable.is_some() {
        warnings.push("the gable is left out, for a beam lies on the wall: λ is too high".into());
    }
    if let Some([from, thrust, span, _]) = wall.strip {
        if side_walls.is_empty() && span >= wall.length() - 1e-6 {
            backed.abutments(from, thrust, wall.friction);
            warnings.push(
                "the strip's abutments press the ends with up to their thrust and hold them by friction: λ may be too high; that of smooth \
                 heads counts on no such friction"
                    .into(),
            );
        } else {
            warnings
                .push("the strip's abutments are left out: they stand beside side walls, or inside of the wall".into());
        }
    }
    if wall.leaf.is_some() {
        warnings.push("blocks reach through all leaves: the outer one, which nothing ties, may fall below λ".into());
    }
    if wall.loose > 0 {
        warnings.push(format!("not bonded, and so left out: {}", counted(wall.loose, "side wall")));
    }
    let as_here = args.load == LimitLoad::Body && !matches!(args.towards, Some(Towards::Inwards));
    let closed = if as_here { closed(&wall, args.above.unwrap_or(0.0)) } else { Vec::new() };
    let floors = wall.floors.iter().filter(|f| f.given).count();
    let gable = wall.gable.is_some() && !has_beam;
    Ok((backed.problem, Behind { floors, ties: wall.ties.len(), side_walls, blocks, gable, closed }, warnings))
}

/// Of every kind that blocks as they are here can have, falling straight outwards above a level [m]: corners fall askew, a leaf alone.
fn closed(wall: &Wall, above: f64) -> Vec<Closed> {
    let survey = survey(wall, Overlaps::Summed);
    let foot = |f: &Found| if let Shape::Storey { levels } = f.shape { levels[0] } else { f.hinge };
    let here = |f: &&Found| f.counts && foot(f) >= above - 1e-6 && !matches!(f.kind, Kind::Corner | Kind::Leaf);
    let least = |kind: Kind| {
        let own = survey.found.iter().filter(here).filter(|f| f.kind == kind);
        own.min_by(|a, b| a.multiplier().total_cmp(&b.multiplier()))
    };
    let mut found: Vec<&Found> = Kind::ALL.into_iter().filter_map(least).collect();
    found.sort_by(|a, b| a.multiplier().total_cmp(&b.multiplier()));
    let of = |f: &&Found| Closed {
        multiplier: f.multiplier(),
        hinge: f.hinge,
        kind: f.kind.name(),
        what: format!("{} ({}) at z = {} m", f.kind.what(), f.kind.equation(), significant(f.hinge, 4)),
    };
    found.iter().map(of).collect()
}

fn of_side(file: &CaseFile, number: usize, side: &Side) -> SideWall {
    let friction = &file.case.joint.friction;
    let w = side.wall;
    SideWall {
        name: format!("s{}", number + 1),
        at: side.at,
        thickness: w.thickness,
        specific_weight: w.specific_weight,
        course: w.course,
        overlap: w.overlap,
        friction: w.friction,
        heads_rub: friction.law != FrictionLaw::None && friction.on == FrictionOn::All,
        load: w.load,
        ends: w.opening,
    }
}

/// What a hip rafter brings to a corner, (OP5): along its direction of falling.
fn add_corner(backed: &mut Backed, wall: &Wall, side: &Side) {
    let Some(corner) = side.corner.filter(|c| c.load != Default::default()) else { return };
    let (sin, cos) = corner.direction.sin_cos();
    let left = side.at < 0.5 * (wall.extent[0] + wall.extent[1]);
    let (end, inwards) = if left { (wall.extent[0], 1.0) } else { (wall.extent[1], -1.0) };
    let load = corner.load;
    let force = [-load.thrust * sin, -inwards * load.thrust * cos, -load.load];
    backed.at_top(end + inwards * load.depth * cos, load.depth * sin, force, load.load, load.pushing);
}

impl Behind {
    /// In words.
    pub(super) fn text(&self) -> String {
        let mut parts = vec![counted(self.floors, "floor"), counted(self.ties, "tie")];
        let depths: Vec<String> = self.side_walls.iter().map(|d| significant(*d, 3)).collect();
        if !depths.is_empty() {
            parts.push(format!(
                "{} of {}, {} m deep",
                counted(depths.len(), "side wall"),
                counted(self.blocks, "block"),
                depths.join(" and ")
            ));
        }
        if self.gable {
            parts.push("a gable".into());
        }
        parts.join(", ")
    }

    /// For programs.
    pub(super) fn json(&self) -> Value {
        let closed = |c: &Closed| json!({ "kind": c.kind, "hinge": c.hinge, "multiplier": c.multiplier });
        json!({
            "floors": self.floors, "ties": self.ties, "side_walls": self.side_walls, "side_wall_blocks": self.blocks,
            "gable": self.gable, "mechanisms": self.closed.iter().map(closed).collect::<Vec<_>>(),
        })
    }
}

impl Closed {
    /// Whether the closed form is high or low, against λ and against that of smooth heads where there is one.
    pub(super) fn against(&self, lambda: f64, smooth: Option<f64>) -> String {
        let than = |of: f64, name: &str| match (self.multiplier - of) / of {
            off if off.abs() <= CERTIFIED => format!("equal to {name}"),
            _ if of < NOTHING => format!("{name} is 0"),
            off if off > 0.0 => format!("high, {} above {name}: the blocks find a lower one", percent(off)),
            off if self.kind == Kind::GableFlaps.name() => {
                format!(
                    "{} below {name}, which holds the gable as one body and knows no flaps: it counts",
                    percent(-off)
                )
            }
            off => format!("low, {} below {name}", percent(-off)),
        };
        let smooth = smooth.map(|of| format!("; {}", than(of, "λ of smooth heads"))).unwrap_or_default();
        format!("α₀ = {}, {}: {}{smooth}", significant(self.multiplier, 6), self.what, than(lambda, "λ"))
    }
}
