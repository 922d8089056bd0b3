//! From a wall file to the parts of a wall that its mechanisms out of the plane need, and what is assumed where the file says nothing.
//!
//! A joint belongs to the course that lies on it: mortar counts with the weight of the blocks, and hinges lie on the lower side of their
//! joint. Levels on which a hinge can lie are bed joints that no block crosses.

use concio_mechanisms::checks::{BEHAVIOUR, Building, Hazard, LOWEST_KNOWLEDGE, Site, Spectrum};
use concio_mechanisms::corner::CornerLoad;
use concio_mechanisms::facade::{Floor, Masonry, Piece, Tie};
use concio_mechanisms::gable::Gable;
use concio_mechanisms::setback::Crushing;
use concio_mechanisms::side_wall::SideWall;
use concio_mechanisms::survey::NEAR;
use concio_mechanisms::wall::{Assumed, CornerOf, FloorOf, Side, Wall};

use crate::case::out_of_plane::{self, Hazard as GivenHazard, OutOfPlane};
use crate::case::{Beam, Bond, Case, FrictionLaw, JointKind, TopLoad, plausible};
use crate::error::{Error, InputError, Result};
use crate::quantity::{Length, shown};
use crate::wall::Wall as Laid;
use crate::warning::{Warning, WarningKind};
use crate::{graph, pattern};

/// Heights within this are one level [m].
const LEVEL: f64 = 1e-6;
/// Height over thickness of a wall beyond which it hardly stands: free-standing walls of 20 are slender already.
const SLENDER: f64 = 40.0;
/// Difference of two loads over one of them within which they are the same.
const SAME_LOAD: f64 = 1e-3;
/// φ unless given.
const DIAGONAL: f64 = std::f64::consts::FRAC_PI_4;

/// Of a valid case.
///
/// # Errors
/// Walls that cannot be laid; arches and blocks that are no level rectangles; floors, ties and side walls outside of the wall.
pub fn of(case: &Case) -> Result<Wall> {
    let laid = pattern::lay(case)?;
    refuse_shapes(case, &laid)?;
    let mut assumed = Assumptions::default();
    let none = OutOfPlane::default();
    let given = case.out_of_plane.as_ref().unwrap_or(&none);
    if case.out_of_plane.is_none() {
        assumed.add(
            "out_of_plane",
            "the file has no such table: a bare wall on the ground, without floors, ties, side walls and site",
        );
    }
    leave_out_the_plane(case, &mut assumed);
    let masonry = masonry(case, &laid, &mut assumed);
    let extent = ends(masonry.pieces.iter().map(|p| p.y));
    let top = masonry.top();
    let texture = texture(&laid, &masonry);
    let brick = case.panels[0].brick;
    let mut wall = Wall {
        specific_weight: brick.specific_weight.si(),
        levels: levels(&masonry),
        openings: openings(case, &laid)?,
        friction: friction(case, &mut assumed),
        modulus: modulus(case, texture, masonry.thickness),
        back: given.outside == out_of_plane::Face::Back,
        floors: Vec::new(),
        ties: Vec::new(),
        side_walls: Vec::new(),
        loose: 0,
        leaf: None,
        crushing: crushing(case, given, &mut assumed),
        gable: None,
        strip: None,
        confidence: LOWEST_KNOWLEDGE,
        behaviour: given.behaviour_factor.unwrap_or(BEHAVIOUR),
        hazard: hazard(given, &mut assumed),
        building: Building::regular(top, 1),
        floor_spectra: spectra(given),
        assumed: Vec::new(),
        masonry,
        extent,
        top,
        texture,
    };
    wall.confidence = confidence(given, &mut assumed)?;
    wall.leaf = leaf(given, &wall, &mut assumed)?;
    add_floors(&mut wall, case, given, &mut assumed)?;
    add_ties(&mut wall, given, &mut assumed)?;
    add_side_walls(&mut wall, given, &mut assumed)?;
    add_gable(&mut wall, given, &mut assumed)?;
    add_strip(&mut wall, given)?;
    wall.building = building(given, &wall, &mut assumed)?;
    refuse_spectra_above(given, &wall)?;
    wall.assumed = assumed.0;
    Ok(wall)
}

/// What holds or pushes a wall in its plane alone.
fn leave_out_the_plane(case: &Case, assumed: &mut Assumptions) {
    let ties = "not read: ties of the plane hold nothing across it; `out_of_plane.anchor` does";
    let bond = "not read: joints bear no tension and no cohesion out of the plane, as masonry without tensile strength";
    let forces = "not read: forces on blocks act in the plane; `out_of_plane.floor` has `push` and `thrust`";
    let bonded = case.joint.changes.iter().position(|change| change.bond.is_some());
    let change = bonded.map_or(String::new(), |number| format!("joint.change[{number}].bond"));
    let given = [
        ("tie", !case.ties.is_empty(), ties),
        ("joint.bond", case.joint.bond.is_some(), bond),
        (&change, bonded.is_some() && case.joint.bond.is_none(), bond),
        ("force", !case.forces.is_empty(), forces),
    ];
    given.into_iter().filter(|(_, given, _)| *given).for_each(|(key, _, what)| assumed.add(key, what));
}

fn add_floors(facade: &mut Wall, case: &Case, given: &OutOfPlane, assumed: &mut Assumptions) -> Result<()> {
    let (length, half) = (facade.length(), 0.5 * facade.masonry.thickness);
    for (i, own) in given.floors.iter().enumerate() {
        let key = format!("out_of_plane.floor[{i}]");
        below_top(facade, &format!("{key}.z"), own.z)?;
        let depth = own.at.map_or(half, Length::si);
        if depth > facade.masonry.thickness + LEVEL {
            let what = format!("{} m lies behind the wall", shown(depth));
            let allowed = format!("0 … {} m, the thickness", shown(facade.masonry.thickness));
            return Err(InputError::new(what).key(format!("{key}.at")).allowed(allowed).into());
        }
        if own.at.is_none() {
            assumed.add(
                format!("{key}.at"),
                "the load lies in the middle of the wall; a load nearer to the inner face holds more",
            );
        }
        let floor = Floor {
            level: own.z.si(),
            load: own.load.si() * length,
            depth,
            pushing: own.push.si() * length,
            thrust: own.thrust.si() * length,
            friction: own.seat_friction,
            seat: own.seat_length.map(Length::si),
            connection: own.connection.si() * length,
        };
        if own.seat_length.is_none() && own.load.si() > 0.0 {
            assumed
                .add(format!("{key}.seat_length"), "beams do not lose their seat before the wall falls: not checked");
        }
        facade.floors.push(FloorOf { floor, given: true, holds: own.holds, clamps: own.clamps });
    }
    let q = match case.load.top {
        TopLoad::PerLength(q) => q.si() * length,
        TopLoad::Force(force) => force.si(),
    };
    // What presses is the load. What pushes is its mass, as in `concio limit`, or the load where that is more.
    let (key, mass) = match case.load.beam {
        Beam::Mass(mass) => ("load.beam.mass", Some(mass)),
        Beam::Free => ("load.mass", case.load.mass),
        Beam::Driven | Beam::Tied => ("load.beam", None),
    };
    let shaken = mass.map_or(q, |mass| mass.si() * crate::G);
    let pushing = (shaken - q).max(0.0);
    if q > 0.0 || pushing > 0.0 {
        let floor = Floor { level: facade.top, load: q, depth: half, pushing, ..Floor::default() };
        facade.floors.push(FloorOf { floor, given: false, holds: false, clamps: false });
        let [presses, pushes] = [q, shaken].map(|force| shown(plausible::rounded(1e-3 * force, 4)));
        let how = if (shaken - q).abs() <= SAME_LOAD * q {
            "with its weight".into()
        } else if shaken > q {
            format!("with the {pushes} kN of {key}, where {presses} kN press")
        } else {
            format!("with its weight of {presses} kN, more than the {pushes} kN of {key}, which is safe")
        };
        assumed.add(
            "load.top",
            format!("it lies in the middle of the wall, pushes {how}, and is not connected to anything"),
        );
    }
    facade.floors.sort_by(|a, b| a.floor.level.total_cmp(&b.floor.level));
    if given.floors.is_empty() && case.out_of_plane.is_some() {
        assumed.add("out_of_plane.floor", "no floor or roof lies on the wall, and none holds it");
    }
    Ok(())
}

fn add_ties(facade: &mut Wall, given: &OutOfPlane, assumed: &mut Assumptions) -> Result<()> {
    for (i, own) in given.anchors.iter().enumerate() {
        let key = format!("out_of_plane.anchor[{i}]");
        below_top(facade, &format!("{key}.z"), own.z)?;
        let position = own.x.map_or(0.5 * facade.length(), Length::si);
        within(facade, &format!("{key}.x"), position)?;
        if own.anchorage.is_none() {
            assumed.add(
                format!("{key}.anchorage"),
                "the anchorage bears what the tie does: the tie is too strong where it does not",
            );
        }
        let force = own.anchorage.map_or(f64::INFINITY, |f| f.si()).min(own.yield_force.si());
        facade.ties.push(Tie {
            level: own.z.si(),
            position: facade.extent[0] + position,
            force,
            stiffness: own.stiffness.map(|k| k.si()),
            slack: own.slack.si(),
            breaks: own.breaks_at.map(Length::si),
        });
    }
    Ok(())
}

fn add_side_walls(facade: &mut Wall, given: &OutOfPlane, assumed: &mut Assumptions) -> Result<()> {
    for (i, own) in given.side_walls.iter().enumerate() {
        let key = format!("out_of_plane.side_wall[{i}]");
        within(facade, &format!("{key}.x"), own.x.si())?;
        if !own.bonded {
            facade.loose += 1;
            continue;
        }
        let mut or = |name: &str, value: Option<f64>, default: f64, what: String| {
            value.unwrap_or_else(|| {
                assumed.add(format!("{key}.{name}"), what);
                default
            })
        };
        let [course, overlap] = facade.texture;
        let of_panel = |what: &str, v: f64| format!("{what} of the wall itself, {}", shown(rounded(v)));
        let wall = SideWall {
            thickness: own.thickness.si(),
            specific_weight: or(
                "specific_weight",
                own.specific_weight.map(|w| w.si()),
                facade.specific_weight,
                of_panel("the specific weight", facade.specific_weight) + " N/m3",
            ),
            course: or(
                "course_height",
                own.course_height.map(Length::si),
                course,
                of_panel("the courses", course) + " m",
            ),
            overlap: or("overlap", own.overlap.map(Length::si), overlap, of_panel("the mean overlap", overlap) + " m"),
            friction: or("friction", own.friction, facade.friction, of_panel("the friction", facade.friction)),
            load: own.load.si(),
            opening: own.first_opening.map(Length::si),
        };
        let (x, from_right) = (own.x.si(), facade.length() - own.x.si());
        let at_end = x.min(from_right) <= own.thickness.si() + LEVEL;
        let corner = at_end.then(|| {
            let load = own.corner.map_or(CornerLoad::default(), |c| CornerLoad {
                load: c.load.si(),
                depth: c.at.si(),
                pushing: c.push.si(),
                thrust: c.thrust.si(),
            });
            let beside = facade
                .openings
                .iter()
                .map(|o| if x <= from_right { o[0] - facade.extent[0] } else { facade.extent[1] - o[2] });
            let found = beside.fold(f64::INFINITY, f64::min);
            let opening = own.opening_beside.map_or(found, Length::si);
            CornerOf {
                load,
                direction: own.corner.and_then(|c| c.direction).map_or(DIAGONAL, |a| a.si()),
                opening: opening.is_finite().then_some(opening),
            }
        });
        facade.side_walls.push(Side { at: facade.extent[0] + x, wall, corner });
    }
    Ok(())
}

fn add_gable(facade: &mut Wall, given: &OutOfPlane, assumed: &mut Assumptions) -> Result<()> {
    let Some(own) = &given.gable else { return Ok(()) };
    let thickness = own.thickness.map_or(facade.masonry.thickness, Length::si);
    if own.base.is_some_and(|b| b.si() > facade.length() + LEVEL) {
        let what = format!("{} m is longer than the wall", shown(own.base.map_or(0.0, Length::si)));
        let allowed = format!("up to {} m", shown(rounded(facade.length())));
        return Err(InputError::new(what).key("out_of_plane.gable.base").allowed(allowed).into());
    }
    let depth = own.ridge_at.map_or(0.5 * thickness, Length::si);
    if depth > thickness + LEVEL {
        let what = format!("{} m lies behind the gable", shown(depth));
        let allowed = format!("0 … {} m, the thickness of the gable", shown(rounded(thickness)));
        return Err(InputError::new(what).key("out_of_plane.gable.ridge_at").allowed(allowed).into());
    }
    if own.ridge_at.is_none() && own.ridge_load.si() > 0.0 {
        assumed.add("out_of_plane.gable.ridge_at", "the ridge beam's load lies in the middle of the gable");
    }
    let gable = Gable {
        base: own.base.map_or(facade.length(), Length::si),
        height: own.height.si(),
        thickness,
        specific_weight: facade.specific_weight,
        load: own.ridge_load.si(),
        depth,
        pushing: own.ridge_push.si(),
        thrust: own.ridge_thrust.si(),
    };
    // On the wall below it is a load at its centroid, and one at its ridge.
    let level = facade.top + gable.height / 3.0;
    let own_weight = Floor { level, load: gable.weight(), depth: 0.5 * thickness, ..Floor::default() };
    let ridge = Floor {
        level: facade.top + gable.height,
        load: gable.load,
        depth,
        pushing: gable.pushing,
        thrust: gable.thrust,
        ..Floor::default()
    };
    for floor in [own_weight, ridge] {
        facade.floors.push(FloorOf { floor, given: false, holds: false, clamps: false });
    }
    facade.gable = Some((gable, own.crack_thrust.si()));
    Ok(())
}

fn add_strip(facade: &mut Wall, given: &OutOfPlane) -> Result<()> {
    let Some(own) = &given.strip else { return Ok(()) };
    let key = "out_of_plane.strip.from";
    if own.from.si() >= facade.top - LEVEL {
        return Err(above_top(facade, key, own.from));
    }
    let span = own.span.map_or(facade.length(), Length::si);
    if span > facade.length() + LEVEL {
        let what = format!("{} m is longer than the wall", shown(span));
        let allowed = format!("up to {} m", shown(rounded(facade.length())));
        return Err(InputError::new(what).key("out_of_plane.strip.span").allowed(allowed).into());
    }
    facade.strip = Some([own.from.si(), own.thrust.si(), span, own.friction]);
    Ok(())
}

fn below_top(facade: &Wall, key: &str, level: Length) -> Result<()> {
    if level.si() > facade.top + LEVEL { Err(above_top(facade, key, level)) } else { Ok(()) }
}

fn above_top(facade: &Wall, key: &str, level: Length) -> Error {
    let what = format!("{level} lies above the wall");
    let allowed = format!("up to {} m, the top of the wall", shown(rounded(facade.top)));
    InputError::new(what).key(key).allowed(allowed).into()
}

fn within(facade: &Wall, key: &str, x: f64) -> Result<()> {
    if x <= facade.length() + LEVEL {
        return Ok(());
    }
    let what = format!("{} m lies beside the wall", shown(x));
    let allowed = format!("0 … {} m, the length of the wall", shown(rounded(facade.length())));
    Err(InputError::new(what).key(key).allowed(allowed).into())
}

#[derive(Default)]
struct Assumptions(Vec<Assumed>);

impl Assumptions {
    fn add(&mut self, key: impl Into<String>, what: impl Into<String>) {
        self.0.push(Assumed { key: key.into(), what: what.into() });
    }
}

/// To a micrometre: what lies beyond is rounding.
fn rounded(v: f64) -> f64 {
    (v * 1e6).round() / 1e6
}

fn ends(pairs: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    pairs.fold([f64::INFINITY, f64::NEG_INFINITY], |e, p| [e[0].min(p[0]), e[1].max(p[1])])
}

fn refuse_shapes(case: &Case, laid: &Laid) -> Result<()> {
    if let Some(i) = case.panels.iter().position(|p| p.bond == Bond::Arch) {
        let error =
            InputError::new("the closed forms are those of walls, not of arches").key(format!("panel[{i}].bond"));
        return Err(error.allowed("`running`, `stack`, `irregular`, `explicit`").into());
    }
    let Some(block) = laid.blocks.iter().find(|b| !b.is_rectangle()) else { return Ok(()) };
    let what =
        format!("block {} is no level rectangle: hinges of the closed forms lie on level bed joints", block.name);
    Err(InputError::new(what).key(format!("panel[{}]", block.panel)).allowed("rectangles").into())
}

/// Blocks with the mortar below and beside them, neighbours of a course in one piece.
fn masonry(case: &Case, laid: &Laid, assumed: &mut Assumptions) -> Masonry {
    let thicknesses: Vec<f64> = case.panels.iter().map(|p| p.brick.thickness.si()).collect();
    let thickness = thicknesses.iter().copied().fold(f64::INFINITY, f64::min);
    if thicknesses.iter().any(|t| *t > thickness) {
        let what = format!(
            "panels of several thicknesses turn as one wall about the face, with the lever of the thinnest, {} m",
            shown(thickness)
        );
        assumed.add("panel.brick.thickness", what);
    }
    if case.panels.iter().any(|p| p.mortar.bed.si() > 0.0 || p.mortar.head.si() > 0.0) {
        assumed
            .add("panel.mortar", "mortar weighs as much as blocks of its volume; runs in the plane count blocks alone");
    }
    let mut blocks: Vec<&crate::wall::Block> = laid.blocks.iter().collect();
    blocks.sort_by(|a, b| {
        let by_course = a.panel.cmp(&b.panel).then(a.y[0].total_cmp(&b.y[0]));
        by_course.then(a.y[1].total_cmp(&b.y[1])).then(a.x[0].total_cmp(&b.x[0]))
    });
    let mut pieces: Vec<Piece> = Vec::new();
    let mut last_panel = usize::MAX;
    for block in blocks {
        let [bed, head] = laid.panels[block.panel].mortar;
        let weight = block.specific_weight * block.thickness;
        let z = [(block.y[0] - bed).max(0.0), block.y[1]];
        match pieces.last_mut() {
            Some(piece)
                if last_panel == block.panel
                    && piece.weight == weight
                    && (piece.z[0] - z[0]).abs() < LEVEL
                    && (piece.z[1] - z[1]).abs() < LEVEL
                    && block.x[0] - piece.y[1] <= head + LEVEL =>
            {
                piece.y[1] = block.x[1];
            }
            _ => pieces.push(Piece { y: block.x, z, weight }),
        }
        last_panel = block.panel;
    }
    Masonry { thickness, pieces }
}

/// Bed joints from end to end that no block crosses.
fn levels(masonry: &Masonry) -> Vec<f64> {
    let mut all: Vec<f64> = masonry.pieces.iter().map(|p| p.z[0]).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < LEVEL);
    let crossed = |z: f64| masonry.pieces.iter().any(|p| p.z[0] < z - LEVEL && z + LEVEL < p.z[1]);
    all.retain(|z| !crossed(*z));
    all
}

fn openings(case: &Case, laid: &Laid) -> Result<Vec<[f64; 4]>> {
    let left = |panel: usize| {
        let own = laid.blocks.iter().filter(|b| b.panel == panel);
        own.map(|b| b.x[0]).fold(f64::INFINITY, f64::min)
    };
    let outline = |o: &pattern::Laid| {
        let from = left(o.panel);
        [from + o.x[0], o.y[0], from + o.x[1], o.y[1]]
    };
    Ok(pattern::openings(case)?.iter().map(outline).collect())
}

/// Mean height of courses and mean overlap of bed joints between blocks.
fn texture(laid: &Laid, masonry: &Masonry) -> [f64; 2] {
    let heights: Vec<f64> = masonry.pieces.iter().map(|p| p.z[1] - p.z[0]).collect();
    let course = heights.iter().sum::<f64>() / heights.len().max(1) as f64;
    let joints = graph::joints(laid, false);
    let beds: Vec<f64> = joints.iter().filter(|j| j.kind == JointKind::Bed).map(|j| j.overlap).collect();
    let overlap = beds.iter().sum::<f64>() / beds.len().max(1) as f64;
    [course, overlap]
}

fn friction(case: &Case, assumed: &mut Assumptions) -> f64 {
    if case.joint.friction.law == FrictionLaw::None {
        assumed.add(
            "joint.friction",
            "joints do not rub: side walls give no friction, and reactions do not pass through bed joints",
        );
        return 0.0;
    }
    case.joint.friction.static_
}

/// The stiffness of bed joints is the tangential one; pressed they are stiffer by their ratio.
fn modulus(case: &Case, [course, overlap]: [f64; 2], thickness: f64) -> Option<f64> {
    let bed = &case.joint.bed;
    let area = overlap * thickness;
    let modulus = bed.stiffness.over(area) / area * bed.normal_to_shear * course;
    (bed.law.has_springs() && modulus > 0.0 && modulus.is_finite()).then_some(modulus)
}

fn crushing(case: &Case, given: &OutOfPlane, assumed: &mut Assumptions) -> Crushing {
    if case.joint.bed.compressive_strength.is_some() {
        let what = match given.strength {
            None => "it sets no hinge back here: `out_of_plane.strength` does",
            Some(_) => "hinges are set back by `out_of_plane.strength`, and not by it",
        };
        assumed.add("joint.bed.compressive_strength", what);
    }
    let Some(strength) = given.strength else {
        assumed.add(
            "out_of_plane.strength",
            "masonry does not crush at hinges, which lie on the face: α0 is too high; FC is that of LC1",
        );
        return Crushing::Rigid;
    };
    assumed.add(
        "out_of_plane.strength",
        "it sets back level and upright hinges: those of corners and flaps lie on the face, and their FC is that of LC1",
    );
    match given.pressure {
        out_of_plane::PressureBlock::Rectangular => Crushing::Rectangular(strength.si()),
        out_of_plane::PressureBlock::Triangular => Crushing::Triangular(strength.si()),
    }
}

fn confidence(given: &OutOfPlane, assumed: &mut Assumptions) -> Result<f64> {
    match given.confidence_factor {
        Some(factor) if given.strength.is_none() && factor < LOWEST_KNOWLEDGE => {
            let what =
                format!("{} is too low: crushing at hinges is left out, for there is no `strength`", shown(factor));
            let error = InputError::new(what).key("out_of_plane.confidence_factor");
            Err(error.allowed("1.35, or a lower one beside `strength` (Circolare, C8.7.1.2.1.4)").into())
        }
        Some(factor) => Ok(factor),
        None => {
            assumed.add("out_of_plane.confidence_factor", "FC = 1.35, knowledge level LC1");
            Ok(LOWEST_KNOWLEDGE)
        }
    }
}

fn leaf(given: &OutOfPlane, wall: &Wall, assumed: &mut Assumptions) -> Result<Option<f64>> {
    let [outer, ..] = given.leaves[..] else { return Ok(None) };
    let sum: f64 = given.leaves.iter().map(|l| l.si()).sum();
    if (sum - wall.masonry.thickness).abs() > 1e-3 * wall.masonry.thickness {
        let what = format!("the leaves are {} m thick together", shown(rounded(sum)));
        let allowed = format!("{} m, the thickness of the wall", shown(wall.masonry.thickness));
        let mut error = InputError::new(what).key("out_of_plane.leaves").allowed(allowed);
        if (1e-3 * sum - wall.masonry.thickness).abs() <= 1e-3 * wall.masonry.thickness {
            let all: Vec<String> = given.leaves.iter().map(|l| format!("\"{} mm\"", shown(rounded(l.si())))).collect();
            error = error.help(format!("numbers alone are metres: write [{}]", all.join(", ")));
        }
        return Err(error.into());
    }
    let tied = given.leaves_tied.unwrap_or_else(|| {
        assumed.add("out_of_plane.leaves_tied", "nothing ties the leaves: the outer one may fall alone");
        false
    });
    Ok((!tied && given.leaves.len() > 1).then_some(outer.si()))
}

fn hazard(given: &OutOfPlane, assumed: &mut Assumptions) -> Hazard {
    let Some(site) = &given.site else {
        assumed.add("out_of_plane.site", "none: multipliers without checks");
        return Hazard::default();
    };
    let mut of = |own: &Option<GivenHazard>, name: &str, state: &str| {
        if own.is_none() {
            assumed.add(format!("out_of_plane.site.{name}"), format!("none: {state} is not checked"));
        }
        own.as_ref().map(|own| spectrum(own, &format!("out_of_plane.site.{name}"), assumed))
    };
    Hazard {
        damage: of(&site.damage, "damage", "damage (SLD)"),
        life: of(&site.life_safety, "life_safety", "life safety (SLV)"),
        collapse: of(&site.collapse, "collapse", "collapse prevention (SLC)"),
    }
}

fn spectrum(own: &GivenHazard, key: &str, assumed: &mut Assumptions) -> Spectrum {
    if !own.periods.is_empty() {
        return Spectrum::Columns(pairs(&own.periods, &own.accelerations));
    }
    if own.soil_factor.is_none() {
        assumed.add(format!("{key}.soil_factor"), "S = 1: rock, level ground");
    }
    // Validation asks for the three others.
    Spectrum::Code(Site {
        ground: own.ground_acceleration.map_or(0.0, |a| a.si()),
        soil: own.soil_factor.unwrap_or(1.0),
        amplification: own.amplification.unwrap_or(1.0),
        corner: own.corner_period.map_or(1.0, |t| t.si()),
    })
}

fn pairs(periods: &[crate::quantity::Time], accelerations: &[crate::quantity::Acceleration]) -> Vec<[f64; 2]> {
    periods.iter().zip(accelerations).map(|(t, a)| [t.si(), a.si()]).collect()
}

fn spectra(given: &OutOfPlane) -> Vec<(f64, Spectrum)> {
    let of =
        |own: &out_of_plane::FloorSpectrum| (own.z.si(), Spectrum::Columns(pairs(&own.periods, &own.accelerations)));
    given.floor_spectra.iter().map(of).collect()
}

fn building(given: &OutOfPlane, wall: &Wall, assumed: &mut Assumptions) -> Result<Building> {
    let Some(own) = &given.building else {
        let storeys = given.floors.len().max(1);
        let built = Building::regular(wall.top, storeys);
        assumed.add(
            "out_of_plane.building",
            format!(
                "as high as the wall, {} m, with {storeys} storey{}: T_1 {:.3} s, γ_1 {:.3}, ξ_1 5 %",
                shown(rounded(built.height)),
                if storeys == 1 { "" } else { "s" },
                built.period,
                built.participation
            ),
        );
        return Ok(built);
    };
    if own.height.si() < wall.top - LEVEL {
        let what = format!("{} is lower than the wall", own.height);
        let allowed = format!("from {} m, the top of the wall", shown(rounded(wall.top)));
        return Err(InputError::new(what).key("out_of_plane.building.height").allowed(allowed).into());
    }
    let mut built = Building::regular(own.height.si(), own.storeys);
    if let Some(period) = own.period {
        built.period = period.si();
    }
    if let Some(damping) = own.damping_ratio {
        built.damping = 100.0 * damping;
    }
    if let Some(participation) = own.participation {
        built.participation = participation;
    }
    Ok(built)
}

/// Of floor spectra above the building, which none of its floors has.
fn refuse_spectra_above(given: &OutOfPlane, wall: &Wall) -> Result<()> {
    let roof = wall.building.height.max(wall.top);
    let Some((i, own)) = given.floor_spectra.iter().enumerate().find(|(_, own)| own.z.si() > roof + NEAR + LEVEL)
    else {
        return Ok(());
    };
    let what = format!("{} lies above the building", own.z);
    let error = InputError::new(what).key(format!("out_of_plane.floor_spectrum[{i}].z"));
    let error = error.allowed(format!("up to {} m, half a metre above its top", shown(rounded(roof + NEAR))));
    Err(error.help("out_of_plane.building.height says how high the building is").into())
}

/// What is allowed of a wall and what stands behind it, and hardly meant: what only the laid wall shows. [`plausible::doubts`] looks at the numbers.
pub fn doubts(case: &Case, wall: &Wall) -> Vec<Warning> {
    let mut found = Vec::new();
    let mut add = |text: String| found.push(Warning::new(WarningKind::UnlikelyNumber, text));
    let metres = |v: f64| shown(rounded(v));
    let slender = wall.top / wall.masonry.thickness;
    if slender > SLENDER {
        add(format!(
            "panel[0].brick.thickness of {} m under a height of {} m makes the wall {slender:.0} times as high as thick; are courses and thickness meant so?",
            metres(wall.masonry.thickness),
            metres(wall.top)
        ));
    }
    let none = OutOfPlane::default();
    let given = case.out_of_plane.as_ref().unwrap_or(&none);
    let load = match case.load.top {
        TopLoad::PerLength(q) => q.si(),
        TopLoad::Force(force) => force.si() / wall.length(),
    };
    for (i, own) in given.floors.iter().enumerate() {
        let floor = own.load.si();
        if load > 0.0 && floor > 0.0 && (own.z.si() - wall.top).abs() <= NEAR {
            let [bring, brings, sum] = [floor, load, floor + load].map(|q| shown(plausible::rounded(1e-3 * q, 4)));
            let (key, ask) = (format!("out_of_plane.floor[{i}]"), "is one of them left over?");
            add(if (load - floor).abs() <= SAME_LOAD * load {
                format!("load.top and {key} at the top both bring {bring} kN/m: the load counts twice; {ask}")
            } else {
                format!(
                    "load.top brings {brings} kN/m and {key} at the top {bring} kN/m: both count, {sum} kN/m together; {ask}"
                )
            });
        }
    }
    // Openings along the wall from its left end.
    let along = |o: &[f64; 4]| [o[0] - wall.extent[0], o[2] - wall.extent[0]];
    for (i, own) in given.anchors.iter().enumerate() {
        let Some(x) = own.x.map(Length::si) else { continue };
        let z = own.z.si();
        let around = |o: &&[f64; 4]| {
            let [left, right] = along(o);
            left + LEVEL < x && x + LEVEL < right && o[1] + LEVEL < z && z + LEVEL < o[3]
        };
        if wall.openings.iter().any(|o| around(&o)) {
            add(format!(
                "out_of_plane.anchor[{i}] lies in an opening, at x = {} m and z = {} m: there its plate holds nothing, and it counts as if it did",
                metres(x),
                metres(z)
            ));
        }
    }
    for (i, own) in given.side_walls.iter().enumerate().filter(|(_, own)| own.bonded) {
        let x = own.x.si();
        let around = |o: &&[f64; 4]| {
            let [left, right] = along(o);
            left + LEVEL < x && x + LEVEL < right
        };
        if let Some(o) = wall.openings.iter().find(around) {
            let [left, right] = along(o).map(metres);
            add(format!(
                "out_of_plane.side_wall[{i}] meets the wall at x = {} m, in an opening from {left} to {right} m: there nothing bonds both, and it counts as if \
                 something did",
                metres(x)
            ));
        }
    }
    for (i, own) in given.floor_spectra.iter().enumerate() {
        let z = own.z.si();
        if wall.levels.iter().chain([&wall.top]).all(|level| (level - z).abs() > NEAR + LEVEL) {
            add(format!(
                "out_of_plane.floor_spectrum[{i}].z is {} m, farther than {NEAR} m from every joint of the wall, which ends at {} m: nothing uses it",
                metres(z),
                metres(wall.top)
            ));
        }
    }
    doubt_building(given, wall, &mut add);
    doubt_floors(given, wall, &mut add);
    doubt_mass(case, wall, load, &mut add);
    doubt_side_walls(given, wall, &mut add);
    doubt_gable(given, wall, &mut add);
    found
}

/// Height of a building over that of the wall from which it was hardly meant: a ground floor may bear four storeys more.
const TALLER: f64 = 5.0;
/// Least height of a storey [m].
const STOREY: f64 = 1.5;
/// Thrust over the load that brings it: vaults and arches as flat as 1 : 20 have 5.
const THRUSTS: f64 = 5.0;
/// What pushes over the load that lies on the wall; what is more than the wall itself is looked at alone.
const PUSHES: f64 = 10.0;
/// Mass that shakes over what presses.
const HEAVIER: f64 = 20.0;
/// Distance of an opening in a side wall over the height of the wall.
const FAR: f64 = 10.0;
/// Of the ground's acceleration what a floor has at least.
const STILLER: f64 = 0.7;

/// Distance of a floor's load from the outer face over the thickness of the wall.
const OUTERMOST: f64 = 0.1;
/// Base of a gable over the length of its wall: dormers and pediments have more.
const NARROW: f64 = 0.15;
/// Height of a gable over its base: that of the steepest Gothic roofs is about 1.
const STEEP: f64 = 1.5;

/// A guess at a number that was read so many times too large: the first that lies within.
fn meant(value: f64, unit: &str, factors: &[f64], within: std::ops::RangeInclusive<f64>) -> String {
    let guess = factors.iter().map(|factor| value / factor).find(|guess| within.contains(guess));
    guess.map_or(String::new(), |guess| format!("; did you mean \"{} {unit}\"?", shown(rounded(guess))))
}

/// Buildings far higher than their wall, storeys in which nobody stands, floors that shake less than the ground.
fn doubt_building(given: &OutOfPlane, wall: &Wall, add: &mut impl FnMut(String)) {
    let metres = |v: f64| shown(rounded(v));
    if let Some(own) = &given.building {
        let (height, storeys) = (own.height.si(), own.storeys as f64);
        if height > TALLER * wall.top * (1.0 + 1e-9) {
            add(format!(
                "out_of_plane.building.height is {} m, {:.0} times the wall of {} m{}",
                metres(height),
                height / wall.top,
                metres(wall.top),
                meant(height, "m", &[10.0, 100.0, 1000.0], wall.top..=TALLER * wall.top)
            ));
        } else if height < STOREY * storeys * (1.0 - 1e-9) {
            add(format!(
                "out_of_plane.building.storeys is {}: in {} m they are {} m high each",
                own.storeys,
                metres(height),
                shown(plausible::rounded(height / storeys, 3))
            ));
        }
    }
    let grounds = given.site.iter().flat_map(out_of_plane::Site::hazards);
    let grounds = grounds.filter_map(|(name, hazard)| Some((name, plausible::shakes(hazard)?)));
    let Some((name, least)) = grounds.min_by(|a, b| a.1.total_cmp(&b.1)) else { return };
    for (i, own) in given.floor_spectra.iter().enumerate() {
        let Some(floor) = own.accelerations.first().map(|a| a.si()).filter(|a| *a < STILLER * least) else { continue };
        let [floor, least] = [floor, least].map(|a| shown(plausible::rounded(a / crate::G, 3)));
        add(format!(
            "out_of_plane.floor_spectrum[{i}].accelerations begin at {floor} g, less than the {least} g by which out_of_plane.site.{name} shakes the ground: \
             floors shake more than it, and the checks aloft are unsafe"
        ));
    }
}

/// Floors in openings, seats longer than the wall is thick, thrusts and pushes many times the load.
fn doubt_floors(given: &OutOfPlane, wall: &Wall, add: &mut impl FnMut(String)) {
    let metres = |v: f64| shown(rounded(v));
    let kilo = |q: f64| shown(plausible::rounded(1e-3 * q, 4));
    let own_weight = wall.masonry.above(0.0).weight / wall.length();
    for (i, own) in given.floors.iter().enumerate() {
        let (key, z, load) = (format!("out_of_plane.floor[{i}]"), own.z.si(), own.load.si());
        let within = |o: &&[f64; 4]| o[1] + LEVEL < z && z + LEVEL < o[3];
        let open: f64 = wall.openings.iter().filter(within).map(|o| o[2] - o[0]).sum();
        if open > 0.0 && load > 0.0 {
            add(format!(
                "{key} lies at z = {} m, within openings that take {} of {} m: it rests on the piers alone, and counts along the whole wall; is its level meant so?",
                metres(z),
                metres(open),
                metres(wall.length())
            ));
        }
        let (seat, thickness) = (own.seat_length.map_or(0.0, Length::si), wall.masonry.thickness);
        let (at, outermost) = (own.at.map_or(0.0, Length::si), OUTERMOST * thickness);
        // An outer leaf bears its own.
        if load > 0.0 && at > 0.0 && at < outermost - LEVEL && given.leaves.is_empty() {
            add(format!(
                "{key}.at is {} m from the outer face, less than {} m, a tenth of the thickness: beams reach farther into a wall{}",
                shown(plausible::rounded(at, 6)),
                metres(outermost),
                meant(at, "m", &[1e-3, 1e-2, 0.1], outermost..=thickness)
            ));
        }
        if seat > thickness + LEVEL {
            add(format!(
                "{key}.seat_length is {} m, and the wall is {} m thick{}",
                metres(seat),
                metres(thickness),
                meant(seat, "m", &[10.0, 100.0, 1000.0], 0.03..=thickness)
            ));
        }
        let beside = given.floors.iter().filter(|other| (other.z.si() - z).abs() <= NEAR);
        let bears: f64 = beside.map(|other| other.load.si()).sum();
        let (thrust, push) = (own.thrust.si(), own.push.si());
        if bears > 0.0 && thrust.abs() > THRUSTS * bears {
            add(format!(
                "{key}.thrust is {} kN/m, {:.0} times the load of {} kN/m there: flat vaults thrust with a few times their load",
                kilo(thrust),
                thrust.abs() / bears,
                kilo(bears)
            ));
        }
        if bears > 0.0 && push > PUSHES * bears && push > own_weight {
            add(format!(
                "{key}.push is {} kN/m, {:.0} times the load of {} kN/m there, and more than the {} kN/m that the wall weighs",
                kilo(push),
                push / bears,
                kilo(bears),
                kilo(own_weight)
            ));
        }
    }
}

/// A mass on top that is many times what presses there; `load` is that of the top [N/m].
fn doubt_mass(case: &Case, wall: &Wall, load: f64, add: &mut impl FnMut(String)) {
    let (key, mass) = match (case.load.beam, case.load.mass) {
        (Beam::Mass(mass), _) => ("load.beam.mass", mass.si()),
        (Beam::Free, Some(mass)) => ("load.mass", mass.si()),
        _ => return,
    };
    let (presses, shakes) = (load * wall.length(), mass * crate::G);
    if case.out_of_plane.is_some() && presses > 0.0 && shakes > HEAVIER * presses {
        let tonnes = 1e-3 * mass;
        let fits = presses / crate::G * 1e-3;
        add(format!(
            "{key} is {} t, which weigh {:.0} times the {} kN of load.top{}",
            shown(rounded(tonnes)),
            shakes / presses,
            shown(plausible::rounded(1e-3 * presses, 4)),
            meant(tonnes, "t", &[1000.0], 0.05 * fits..=HEAVIER * fits)
        ));
    }
}

/// Openings beside a corner that lie beyond every wall, rafters that meet it where it does not fall.
fn doubt_side_walls(given: &OutOfPlane, wall: &Wall, add: &mut impl FnMut(String)) {
    let metres = |v: f64| shown(rounded(v));
    let (top, length) = (wall.top, wall.length());
    for (i, own) in given.side_walls.iter().enumerate() {
        let key = format!("out_of_plane.side_wall[{i}]");
        let limits = [
            ("first_opening", own.first_opening, FAR * top, format!("{} times the height of the wall", FAR)),
            ("opening_beside", own.opening_beside, length, "the length of the wall".into()),
        ];
        for (name, way, limit, what) in limits {
            let Some(way) = way.map(Length::si).filter(|way| *way > limit + LEVEL) else { continue };
            add(format!(
                "{key}.{name} is {} m, more than {} m, {what}: it is as if there were no opening{}",
                metres(way),
                metres(limit),
                meant(way, "m", &[100.0, 1000.0], 0.05..=length.max(top))
            ));
        }
        let Some(corner) = own.corner.filter(|corner| corner.load.si() > 0.0) else { continue };
        // The corner falls with the columns of both walls, and with what the cracks cut off at the top.
        let [course, overlap] = [own.course_height, own.overlap].map(|l| l.map(Length::si));
        let steepest = overlap.unwrap_or(wall.texture[1]) / course.unwrap_or(wall.texture[0]);
        let steepest = steepest.max(wall.texture[1] / wall.texture[0]);
        let (sin, cos) = corner.direction.map_or(DIAGONAL, |a| a.si()).sin_cos();
        let reach = top * steepest * sin.max(cos) + own.thickness.si() * cos + wall.masonry.thickness * sin;
        let at = corner.at.si();
        if at > reach + LEVEL {
            add(format!(
                "{key}.corner.at is {} m, and the corner reaches {} m behind its hinge line at most: there its load holds what does not fall{}",
                metres(at),
                shown(plausible::rounded(reach, 3)),
                meant(at, "m", &[100.0, 1000.0], 0.05..=reach)
            ));
        }
    }
}

/// Gables that are hardly as wide as a window, or steeper than any roof; thrusts that are many times what lies there.
fn doubt_gable(given: &OutOfPlane, wall: &Wall, add: &mut impl FnMut(String)) {
    let (Some((gable, press)), Some(own)) = (&wall.gable, &given.gable) else { return };
    let kilo = |force: f64| shown(plausible::rounded(1e-3 * force, 4));
    if gable.base < NARROW * wall.length() {
        add(format!(
            "out_of_plane.gable.base is {} m, {} times the wall's length of {} m; without `base` the gable is as long as the wall",
            shown(plausible::rounded(gable.base, 6)),
            shown(plausible::rounded(gable.base / wall.length(), 2)),
            shown(rounded(wall.length()))
        ));
    } else if gable.height > STEEP * gable.base && gable.height <= plausible::HIGHEST_GABLE {
        add(format!(
            "out_of_plane.gable.height is {} m, {} times its base of {} m: roofs rise by 0.2 to 1 of it{}",
            shown(rounded(gable.height)),
            shown(plausible::rounded(gable.height / gable.base, 2)),
            shown(rounded(gable.base)),
            meant(gable.height, "m", &[10.0, 100.0, 1000.0], 0.1 * gable.base..=STEEP * gable.base)
        ));
    }
    let weight = gable.weight() + gable.load;
    if *press > 2.0 * weight {
        add(format!(
            "out_of_plane.gable.crack_thrust is {} kN, {:.0} times the {} kN that the gable and its ridge weigh: flaps press on each other with a part of that",
            kilo(*press),
            press / weight,
            kilo(weight)
        ));
    }
    let (load, thrust) = (own.ridge_load.si(), own.ridge_thrust.si());
    if load > 0.0 && thrust.abs() > THRUSTS * load {
        add(format!(
            "out_of_plane.gable.ridge_thrust is {} kN, {:.0} times the ridge_load of {} kN",
            kilo(thrust),
            thrust.abs() / load,
            kilo(load)
        ));
    }
}
