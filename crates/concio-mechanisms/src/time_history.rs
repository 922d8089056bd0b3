//! From a mechanism of the survey to the one that rocks: the same hinges, weights, floors, ties and friction, now with inertia.
//!
//! Of (OP10) the multiplier at rest is α0 of (OP3), (OP4), (OP6) and (OP9) once every tie bears its full force, α(θ) of weights and thrusts is that
//! of the pushover, and d0 is its d0: `tests/all/time_history.rs` holds them to 10⁻⁹. A tie here begins at no force and pulls by its stiffness. So
//! a tied wall sets off below α0.
//!
//! Moments of inertia about the centre of mass, of masonry of width b(z) and of a wedge whose crack has the slope s = tan β:
//!
//! ```text
//! I = Σ γ t b ∫ (z − z_G)² dz/g + W t²/(12 g)        wedge: W h² (1 + s²)/(18 g)        gable: W (h²/18 + t²/12)/g
//! ```
//!
//! Limits: one plane. Corners, flaps and horizontal arches turn about inclined or upright hinges, and have no time history.

use crate::G;
use crate::body::{Body, Hold, HoldLaw, Weight};
use crate::facade::{Floor as FloorOf, Masonry};
use crate::overturning::LEVEL;
use crate::pushover::Kinematics;
use crate::rocking::{Back, Floor, Linkage, Mechanism, Member, Part, Place, Restitution, Rub, Spot, Tie};
use crate::survey::{Found, Kind, Shape};
use crate::vertical_arch::VerticalArch;
use crate::wall::Wall;

/// Elongation at which a tie yields whose stiffness is not known [m].
pub const RIGID_TIE: f64 = 1e-3;

/// A mechanism that can be shaken.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeHistory {
    /// What rocks. Depths are from the outer face, heights from the base of the wall.
    pub mechanism: Mechanism,
    /// Its bodies in section, from below: the corner on the outer face below, and that on the inner face above.
    pub bodies: Vec<[Place; 2]>,
    /// What is assumed of it, in words.
    pub notes: Vec<String>,
}

impl TimeHistory {
    /// Of a mechanism that the survey of `wall` found. `restitution`: velocity after an impact over that before, from 0 to 1; without it the formula of a
    /// block against side walls, and (OP11) for what rocks to both sides.
    ///
    /// # Errors
    /// Why a mechanism of its kind has no time history, in words.
    pub fn of(wall: &Wall, found: &Found, restitution: Option<f64>) -> Result<TimeHistory, String> {
        let mut made = match (&found.pushover.kinematics, found.kind) {
            (Kinematics::VerticalArch(arch), _) => of_arch(wall, found, arch, restitution)?,
            (Kinematics::Body(body, control), Kind::Overturning | Kind::WithSideWalls | Kind::Leaf | Kind::Gable) => {
                of_body(wall, found, body, *control, restitution)
            }
            (_, Kind::HorizontalArch) => {
                return Err("it turns about upright hinges, and its thrust depends on abutments that move".into());
            }
            _ => return Err("it turns about an inclined hinge: (OP10) holds for level ones".into()),
        };
        if found.level > LEVEL {
            made.notes.push(format!(
                "the hinge or the middle of the supports lies {:.2} m above the ground: the building shakes it otherwise than the ground does, as a rule more. \
                 Give the motion of that level",
                found.level
            ));
        }
        Ok(made)
    }
}

/// One body about a level hinge.
fn of_body(wall: &Wall, found: &Found, body: &Body, control: f64, restitution: Option<f64>) -> TimeHistory {
    let (hinge, setback) = (found.hinge, found.setback);
    let at = |depth: f64, height: f64| Spot::lower([depth + setback, height + hinge]);
    let part = |weight: &Weight, inertia: f64| Part {
        centre: at(weight.depth, weight.height),
        weight: weight.carried,
        inertia,
    };
    let given: Vec<FloorOf> = match found.kind {
        Kind::Overturning | Kind::WithSideWalls => {
            wall.floors.iter().map(|f| f.floor).filter(|f| f.level > hinge + LEVEL).collect()
        }
        // What lies on the ridge.
        Kind::Gable => body.weights[1..].iter().map(|_| FloorOf::default()).collect(),
        _ => Vec::new(),
    };
    let (own, rest) = (&body.weights[0], &body.weights[1..]);
    let (loads, wedges) = rest.split_at(given.len());
    let mut parts = vec![part(own, own_inertia(wall, found, own, control))];
    // Side walls without a wedge have no weight among those of the body.
    let slopes = found.slopes.iter().filter(|slope| **slope > 0.0);
    let (wedges, on_wedges) = wedges.split_at(slopes.clone().count().min(wedges.len()));
    parts.extend(wedges.iter().zip(slopes).map(|(wedge, slope)| {
        let height = 1.5 * wedge.height;
        part(wedge, wedge.carried / G * height * height * (1.0 + slope * slope) / 18.0)
    }));
    let mut holds: Vec<Hold> = body.holds.clone();
    let floors = given.iter().zip(loads).map(|(floor, load)| {
        let here = |depth: f64, height: f64| depth == load.depth && height == load.height;
        let rubs = |h: &Hold| {
            matches!(h.law, HoldLaw::Friction { .. })
                && here(h.depth, h.height)
                && h.force == floor.friction * floor.load
        };
        let seat_rubs = holds.iter().position(rubs).map(|i| holds.remove(i)).is_some();
        let thrust = body.thrusts.iter().find(|h| here(h.depth, h.height)).map_or(0.0, |h| h.force);
        Floor {
            at: at(load.depth, load.height),
            load: load.carried,
            pushes: load.carried + load.pushing,
            thrust,
            friction: if seat_rubs { floor.friction } else { 0.0 },
            seat: floor.seat,
        }
    });
    let mut floors: Vec<Floor> = floors.collect();
    floors.extend(on_wedges.iter().map(|load| Floor::carried(at(load.depth, load.height), load.carried)));
    let mut notes = Vec::new();
    let (mut ties, mut rubs) = (Vec::new(), Vec::new());
    for hold in &holds {
        let spot = at(hold.depth, hold.height);
        match hold.law {
            HoldLaw::Friction { until } => rubs.push(Rub { at: spot, force: hold.force, overlap: until }),
            HoldLaw::Tie { .. } if !(hold.force > 0.0) => {
                notes.push(format!(
                    "the tie at {:.2} m bears nothing before the wall would fall without it: it is left out",
                    spot.at[1]
                ));
            }
            HoldLaw::Tie { breaks: Some(most), slack, .. } if most <= slack => {
                notes.push(format!("the tie at {:.2} m breaks before its slack is used: it is left out", spot.at[1]));
            }
            HoldLaw::Tie { stiffness, slack, breaks } => {
                let stiffness = stiffness.unwrap_or_else(|| {
                    notes.push(format!(
                        "the tie or connection at {:.2} m has no stiffness in the wall file: it is taken to yield at {:.0} mm",
                        spot.at[1],
                        1e3 * RIGID_TIE
                    ));
                    hold.force / RIGID_TIE
                });
                let yields = Some(hold.force);
                let elongation_at_break = breaks.map(|most| most - slack);
                ties.push(Tie {
                    at: spot,
                    stiffness,
                    slack,
                    pretension: 0.0,
                    yield_force: yields,
                    elongation_at_break,
                });
            }
        }
    }
    if !ties.is_empty() {
        notes.push(
            format!("ties begin at no force and pull by their stiffness: the wall sets off below α0 = {:.4}, which counts them in full", found.multiplier()));
    }
    let thickness = match (found.kind, &wall.gable) {
        (Kind::Leaf, _) => wall.leaf.unwrap_or_default(),
        (Kind::Gable, Some((gable, _))) => gable.thickness,
        _ => wall.masonry.thickness,
    };
    let backed = match found.kind {
        Kind::Leaf => Some("the inner leaf stops it"),
        Kind::Gable => None,
        _ if wall.side_walls.is_empty() && wall.loose == 0 => None,
        _ => Some("side walls stop it"),
    };
    let back = match backed {
        Some(stops) => {
            notes.push(format!("{stops} when it comes back: it rocks outwards only"));
            Back::SideWalls(restitution.map_or(Restitution::Block, Restitution::Given))
        }
        None => {
            let goes_on =
                if floors.is_empty() && ties.is_empty() { "" } else { "; floors and ties do not stop it inwards" };
            notes.push(format!("no wall is given behind it: it rocks to both sides{goes_on}"));
            Back::Free { inwards: Linkage::One { hinge: [thickness - setback, hinge] }, restitution }
        }
    };
    let mechanism = Mechanism {
        linkage: Linkage::One { hinge: [setback, hinge] },
        parts,
        floors,
        ties,
        rubs,
        friction_moment: 0.0,
        back,
        control: at(0.0, control),
    };
    TimeHistory { mechanism, bodies: vec![[[0.0, hinge], [thickness, hinge + control]]], notes }
}

/// Moment of inertia of the wall's own weight about its centre [kg m²].
fn own_inertia(wall: &Wall, found: &Found, own: &Weight, height: f64) -> f64 {
    let masonry = &wall.masonry;
    match (found.kind, wall.leaf, &wall.gable) {
        (Kind::Gable, _, Some((gable, _))) => {
            own.carried / G * (height * height / 18.0 + gable.thickness.powi(2) / 12.0)
        }
        (Kind::Leaf, Some(leaf), _) => {
            let whole = masonry.above(found.hinge).weight;
            own.carried / G * (spread(masonry, found.hinge, f64::INFINITY) / whole + leaf * leaf / 12.0)
        }
        _ => inertia(masonry, found.hinge, f64::INFINITY),
    }
}

/// Of the masonry between two levels [m], about its centre [kg m²].
fn inertia(masonry: &Masonry, from: f64, to: f64) -> f64 {
    let weight = masonry.pieces.iter().map(|p| p.weight * area(p.y, p.z, from, to)).sum::<f64>();
    (spread(masonry, from, to) + weight * masonry.thickness.powi(2) / 12.0) / G
}

/// Σ γ t b ∫ (z − z_G)² dz of the masonry between two levels [N m²].
fn spread(masonry: &Masonry, from: f64, to: f64) -> f64 {
    let [mut weight, mut first, mut second] = [0.0; 3];
    for piece in &masonry.pieces {
        let own = piece.weight * area(piece.y, piece.z, from, to);
        let [low, high] = [piece.z[0].max(from), piece.z[1].min(to)];
        weight += own;
        first += own * 0.5 * (low + high);
        second += own * (low * low + low * high + high * high) / 3.0;
    }
    if weight > 0.0 { second - first * first / weight } else { 0.0 }
}

fn area(y: [f64; 2], z: [f64; 2], from: f64, to: f64) -> f64 {
    (y[1] - y[0]) * (z[1].min(to) - z[0].max(from)).max(0.0)
}

/// A storey between two levels.
fn of_arch(wall: &Wall, found: &Found, arch: &VerticalArch, restitution: Option<f64>) -> Result<TimeHistory, String> {
    let Shape::Storey { levels: [low, high] } = found.shape else { return Err("its levels are not known".into()) };
    let thickness = arch.thickness;
    let at = |member: Member, [depth, height]: Place| Spot { member, at: [depth, height + low] };
    let mut parts = Vec::new();
    let mut floors = Vec::new();
    let bodies = [(Member::Lower, [low, found.hinge]), (Member::Upper, [found.hinge, high])];
    for ((member, [from, to]), weights) in bodies.into_iter().zip(&arch.parts) {
        for (i, weight) in weights.iter().enumerate() {
            let spot = at(member, [weight.depth, weight.height]);
            if i == 0 {
                parts.push(Part { centre: spot, weight: weight.carried, inertia: inertia(&wall.masonry, from, to) });
            } else {
                let pushes = weight.carried + weight.pushing;
                floors.push(Floor { pushes, ..Floor::carried(spot, weight.carried) });
            }
        }
    }
    let mut ties = Vec::new();
    for (member, forces) in [Member::Lower, Member::Upper].into_iter().zip(&arch.forces) {
        for force in forces {
            let spot = at(member, [force.depth, force.height]);
            match force.force > 0.0 {
                true => floors.push(Floor { thrust: force.force, ..Floor::carried(spot, 0.0) }),
                false => {
                    let yields = -force.force;
                    ties.push(Tie { yield_force: Some(yields), ..Tie::elastic(spot, yields / RIGID_TIE) });
                }
            }
        }
    }
    let top = [thickness - arch.depth, high];
    if arch.load > 0.0 {
        floors.push(Floor::carried(Spot::upper(top), arch.load));
    }
    let [inner, outer] = [[thickness, found.hinge], [0.0, found.hinge]];
    let inwards = Linkage::Two { base: [thickness, low], middle: outer, top };
    let mechanism = Mechanism {
        linkage: Linkage::Two { base: [0.0, low], middle: inner, top },
        parts,
        floors,
        ties,
        rubs: Vec::new(),
        friction_moment: 0.0,
        back: Back::Free { inwards, restitution },
        control: Spot::lower(inner),
    };
    let reach = if wall.side_walls.is_empty() && wall.loose == 0 { "" } else { ": side walls reach its ends alone" };
    let mut notes = vec![format!("the storey bulges to both sides{reach}")];
    if !mechanism.ties.is_empty() {
        notes.push(format!("what holds it between its ends is taken to yield at {:.0} mm", 1e3 * RIGID_TIE));
    }
    notes.push(match found.reaction {
        Some([Some(needed), Some(borne)]) if needed > borne => format!(
            "the top needs R = {:.2} kN and has {:.2} kN: it gives way first, and this time history is none of this wall",
            1e-3 * needed,
            1e-3 * borne
        ),
        _ => "its supports are taken to hold for the whole record, whose motion asks for more than R".into(),
    });
    let body = |[from, to]: [f64; 2]| [[0.0, from], [thickness, to]];
    Ok(TimeHistory { mechanism, bodies: vec![body([low, found.hinge]), body([found.hinge, high])], notes })
}
