//! Every mechanism that a wall can have, at every hinge level, with its least multiplier, pushover and checks.

use crate::body::{Body, Shares, Thrust, Weight};
use crate::checks::{Asked, Checks, LOWEST_KNOWLEDGE, Place, first_period};
use crate::corner::{Beside, Corner};
use crate::facade::{Floor, Masonry, Tie};
use crate::flap::Flap;
use crate::gable::Flaps;
use crate::horizontal_arch::HorizontalArch;
use crate::overturning::{Facade, Overturning};
use crate::pushover::{Kinematics, Pushover};
use crate::side_wall::{Overlaps, SideWall};
use crate::supports::{Supports, Yielding};
use crate::vertical_arch::VerticalArch;
use crate::wall::{FloorOf, Side, Wall};

/// Kinds of mechanism.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The façade about a bed joint, as if nothing held its ends.
    Overturning,
    /// The same with wedges of its side walls, or held by their friction.
    WithSideWalls,
    /// The outer leaf alone.
    Leaf,
    /// A storey between levels that hold it.
    VerticalArch,
    /// A strip between abutments.
    HorizontalArch,
    /// A corner.
    Corner,
    /// A flap beside a vertical crack.
    Flap,
    /// A whole gable.
    Gable,
    /// A gable in two flaps.
    GableFlaps,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 9] = [
        Kind::Overturning,
        Kind::WithSideWalls,
        Kind::Leaf,
        Kind::VerticalArch,
        Kind::HorizontalArch,
        Kind::Corner,
        Kind::Flap,
        Kind::Gable,
        Kind::GableFlaps,
    ];

    /// As results spell it.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Overturning => "overturning",
            Kind::WithSideWalls => "overturning-with-side-walls",
            Kind::Leaf => "overturning-of-outer-leaf",
            Kind::VerticalArch => "vertical-arch",
            Kind::HorizontalArch => "horizontal-arch",
            Kind::Corner => "corner",
            Kind::Flap => "flap",
            Kind::Gable => "gable",
            Kind::GableFlaps => "gable-flaps",
        }
    }

    /// In words.
    pub fn what(self) -> &'static str {
        match self {
            Kind::Overturning => "overturning",
            Kind::WithSideWalls => "overturning with side walls",
            Kind::Leaf => "overturning of the outer leaf",
            Kind::VerticalArch => "vertical arch",
            Kind::HorizontalArch => "horizontal arch",
            Kind::Corner => "corner",
            Kind::Flap => "flap",
            Kind::Gable => "gable",
            Kind::GableFlaps => "flaps of the gable",
        }
    }

    /// Whether crushing sets its hinges back (OP2); those of corners and flaps, which are oblique, lie on the face.
    pub fn is_set_back(self) -> bool {
        !matches!(self, Kind::Corner | Kind::Flap | Kind::GableFlaps)
    }

    /// The number of its equation.
    pub fn equation(self) -> &'static str {
        match self {
            Kind::Overturning | Kind::Leaf => "OP3",
            Kind::WithSideWalls => "OP4",
            Kind::VerticalArch => "OP6",
            Kind::HorizontalArch => "OP7",
            Kind::Corner => "OP5",
            Kind::Flap => "OP8",
            Kind::Gable | Kind::GableFlaps => "OP9",
        }
    }
}

/// Where the parts of a mechanism lie, for drawings.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// All above a level; wedges of side walls at positions along the wall with their tan β.
    Above {
        /// Position [m] and tan β of each crack.
        wedges: Vec<[f64; 2]>,
    },
    /// Between two levels [m].
    Storey {
        /// Lower and upper level.
        levels: [f64; 2],
    },
    /// Between two levels [m] and two ends [m], with a vertical hinge between.
    Strip {
        /// Lower and upper level.
        levels: [f64; 2],
        /// Left end, hinge, right end.
        at: [f64; 3],
    },
    /// A corner.
    Corner {
        /// Whether it is the left one.
        left: bool,
        /// tan β in the wall and in its side wall.
        slopes: [f64; 2],
    },
    /// Polygons in the elevation [m].
    Outlines(Vec<Vec<[f64; 2]>>),
}

/// A mechanism of a wall.
#[derive(Debug, Clone)]
pub struct Found {
    /// Its kind.
    pub kind: Kind,
    /// Level of its hinge [m]: of an arch the one between its ends, of a flap the foot of its crack.
    pub hinge: f64,
    /// tan β of cracks of side walls or corners, tan ϑ of oblique hinges.
    pub slopes: Vec<f64>,
    /// a [m] of (OP2): of an arch that at its lower end.
    pub setback: f64,
    /// Oscillator and curve.
    pub pushover: Pushover,
    /// What makes up α0; none of arches.
    pub shares: Option<Shares>,
    /// Level of the checks [m]: 0 is the ground.
    pub level: f64,
    /// Checks.
    pub checks: Checks,
    /// FC that its capacity is divided by: that of LC1 where crushing is left out of it.
    pub confidence: f64,
    /// Whether it counts; a mechanism that the wall cannot have as it is stands for comparison.
    pub counts: bool,
    /// R that the top of a vertical arch needs, and what is known to bear it [N].
    pub reaction: Option<[Option<f64>; 2]>,
    /// Its place.
    pub shape: Shape,
    /// What to know before the number is believed.
    pub notes: Vec<String>,
}

impl Found {
    /// α0.
    pub fn multiplier(&self) -> f64 {
        self.pushover.multiplier
    }
}

/// All mechanisms of a wall.
#[derive(Debug, Clone)]
pub struct Survey {
    /// Kind by kind, hinges from below.
    pub found: Vec<Found>,
    /// Kinds that the wall cannot have, with the reason.
    pub without: Vec<(Kind, String)>,
}

/// Points of the search over the angle of an oblique hinge.
const ANGLES: usize = 24;
/// Flattest oblique hinge, as tan ϑ.
const FLATTEST: f64 = 4.0;
/// Farthest floor spectrum from a hinge that is taken for its [m].
pub const NEAR: f64 = 0.5;
/// Levels within this are one [m].
const LEVEL: f64 = 1e-6;
/// Heights below which a part counts as none [m].
const LOWEST: f64 = 1e-3;

/// Makes the survey of a wall; `overlaps` is the sum of the friction of overlaps.
pub fn survey(wall: &Wall, overlaps: Overlaps) -> Survey {
    let mut survey = Survey { found: Vec::new(), without: Vec::new() };
    let supports = Supports::of(wall);
    let floors = wall.floors.iter().map(|f| f.floor).collect();
    let mut making = Making { wall, overlaps, supports, floors, held: 0.0 };
    let arches = making.vertical_arches();
    making.hold(&arches);
    making.overturning(&mut survey);
    making.leaf(&mut survey);
    let (at, without) = (survey.found.len(), survey.without.len());
    making.strip(&mut survey);
    making.corners(&mut survey);
    making.flaps(&mut survey);
    making.gable(&mut survey);
    let arches = making.told(arches, &survey);
    if arches.is_empty() {
        let why = "nothing holds the wall above a bed joint (holds = true or connection at out_of_plane.floor, out_of_plane.anchor), or what does gives way first";
        survey.without.insert(without, (Kind::VerticalArch, why.into()));
    }
    survey.found.splice(at..at, arches);
    survey
}

impl Survey {
    /// The mechanism with the least α0 of those that count.
    pub fn least(&self) -> Option<&Found> {
        let counted = self.found.iter().filter(|f| f.counts);
        counted.min_by(|a, b| a.multiplier().total_cmp(&b.multiplier()))
    }

    /// The one whose check for life safety is the worst; none without checks.
    pub fn worst(&self) -> Option<&Found> {
        let counted = self.found.iter().filter(|f| f.counts && f.checks.ratio().is_some());
        counted.min_by(|a, b| a.checks.ratio().unwrap_or(f64::MAX).total_cmp(&b.checks.ratio().unwrap_or(f64::MAX)))
    }

    /// The least of each kind, in their order.
    pub fn least_of_kinds(&self) -> Vec<&Found> {
        let least = |kind: Kind| {
            let own = self.found.iter().filter(|f| f.kind == kind);
            own.min_by(|a, b| a.multiplier().total_cmp(&b.multiplier()))
        };
        Kind::ALL.into_iter().filter_map(least).collect()
    }

    /// The same and, after that of its kind, the one with the worst check, which may turn about another level.
    pub fn least_and_worst(&self) -> Vec<&Found> {
        let mut chosen = self.least_of_kinds();
        let other = self.worst().filter(|worst| !chosen.iter().any(|found| std::ptr::eq(*found, *worst)));
        if let Some(worst) = other {
            let after = chosen.iter().position(|found| found.kind == worst.kind).map_or(chosen.len(), |at| at + 1);
            chosen.insert(after, worst);
        }
        chosen
    }
}

struct Making<'w> {
    wall: &'w Wall,
    overlaps: Overlaps,
    supports: Supports<'w>,
    /// Floors as corners, flaps and a leaf have them.
    floors: Vec<Floor>,
    /// Level of the highest floor that holds whatever pushes [m]; 0 without one.
    held: f64,
}

/// A storey that bends outwards.
struct Storey {
    levels: [f64; 2],
    arch: VerticalArch,
    /// Level of the hinge between its ends [m].
    hinge: f64,
    setback: f64,
    /// R with the thrust of what stands on the support [N]; what is known to bear it; friction of the bed joint under the held course.
    needed: f64,
    borne: Option<f64>,
    rubs: f64,
    /// Whether a floor holds its top, by `holds`.
    holds: bool,
    /// What gives way between its ends.
    notes: Vec<String>,
}

impl Storey {
    /// Whether the support has less than its top needs.
    fn gives_way(&self) -> bool {
        self.needed > self.borne.unwrap_or(f64::INFINITY).min(self.rubs)
    }
}

/// Said of α0 that is not above 0.
const FALLS: &str = "α0 is not above 0: the mechanism moves without an earthquake";

impl Making<'_> {
    /// Checks of a mechanism whose hinge or supports lie at a level.
    fn checks(&self, kind: Kind, pushover: &Pushover, level: f64, seat: Option<f64>, vibrates: Vibrates) -> Checks {
        let wall = self.wall;
        let (free, first_period) = match vibrates {
            Vibrates::Unknown => (false, 0.0),
            Vibrates::Free(length, thickness) => (true, self.first_period(length, thickness, true)),
            Vibrates::Held(length) => (false, self.first_period(length, wall.masonry.thickness, false)),
        };
        let near = |(z, _): &&(f64, crate::checks::Spectrum)| (z - level).abs() <= NEAR;
        let floor =
            wall.floor_spectra.iter().filter(near).min_by(|a, b| (a.0 - level).abs().total_cmp(&(b.0 - level).abs()));
        let place = if level <= LEVEL {
            Place::Ground
        } else {
            Place::Aloft { level, building: wall.building.clone(), floor: floor.map(|(_, s)| s.clone()) }
        };
        let (hazard, confidence, behaviour) = (wall.hazard.clone(), self.confidence(kind), wall.behaviour);
        Checks::of(pushover, &Asked { hazard, place, confidence, behaviour, seat, first_period, free })
    }

    /// T_0 [s]; 0 where the stiffness of the masonry is not known.
    fn first_period(&self, length: f64, thickness: f64, cantilever: bool) -> f64 {
        let wall = self.wall;
        wall.modulus.map_or(0.0, |modulus| first_period(length, thickness, wall.specific_weight, modulus, cantilever))
    }

    /// How what stands over a hinge vibrates: freely, where nothing ties it and a floor lies below it but none above.
    fn parapet(&self, hinge: f64) -> Vibrates {
        let wall = self.wall;
        let given = || wall.floors.iter().filter(|f| f.given);
        let none_above =
            given().all(|f| f.floor.level <= hinge + LEVEL) && wall.ties.iter().all(|t| t.level <= hinge + LEVEL);
        match given().next().is_some() && none_above && hinge > LEVEL {
            true => Vibrates::Free(wall.top - hinge, wall.masonry.thickness),
            false => Vibrates::Unknown,
        }
    }

    /// What to know of the damage check of a part that vibrates freely.
    fn of_free(&self, vibrates: Vibrates, level: f64) -> Option<String> {
        let Vibrates::Free(length, thickness) = vibrates else { return None };
        let wall = self.wall;
        wall.hazard.damage.as_ref()?;
        let given = wall.floor_spectra.iter().any(|(z, _)| (z - level).abs() <= NEAR);
        Some(match (given, wall.modulus) {
            (false, _) => "it vibrates freely: the code asks for S_eZ(T_0) at damage; without a floor spectrum a_Z is taken, which is less".into(),
            (true, None) => "it vibrates freely, but its bed joints have no stiffness: S_eZ is taken at T_0 = 0".into(),
            (true, Some(_)) => {
                format!("it vibrates freely with T_0 = {:.3} s: damage is checked against S_eZ(T_0)", self.first_period(length, thickness, true))
            }
        })
    }

    /// FC: the file's where hinges are set back by crushing, else that of LC1.
    fn confidence(&self, kind: Kind) -> f64 {
        let wall = self.wall;
        if kind.is_set_back() && !wall.crushing.is_left_out() { wall.confidence } else { LOWEST_KNOWLEDGE }
    }

    /// d [m] at which the first beam loses its seat, of a body that turns about a level.
    fn seat(&self, pushover: &Pushover, hinge: f64) -> Option<f64> {
        let of = |floor: &Floor| {
            let (height, seat) = (floor.level - hinge, floor.seat?);
            (height > seat).then(|| pushover.part * pushover.kinematics.control((seat / height).asin()))
        };
        self.floors.iter().filter(|f| f.level > hinge + LEVEL).filter_map(of).reduce(f64::min)
    }

    fn add_body(&self, survey: &mut Survey, kind: Kind, body: Body, hinge: f64, control: f64, rest: Rest) {
        if control < LOWEST {
            return;
        }
        let shares = body.shares();
        let pushover = Pushover::of(Kinematics::Body(body, control));
        let seat = if rest.seats { self.seat(&pushover, hinge) } else { None };
        let vibrates = match kind {
            Kind::Overturning => self.parapet(hinge),
            Kind::Gable => Vibrates::Free(control, self.wall.gable.map_or(0.0, |(gable, _)| gable.thickness)),
            _ => Vibrates::Unknown,
        };
        let checks = self.checks(kind, &pushover, rest.level.unwrap_or(hinge), seat, vibrates);
        let Rest { slopes, setback, counts, shape, mut notes, level, .. } = rest;
        notes.extend(self.of_free(vibrates, level.unwrap_or(hinge)));
        if pushover.multiplier <= 0.0 {
            notes.push(FALLS.into());
        }
        let level = level.unwrap_or(hinge);
        survey.found.push(Found {
            kind,
            hinge,
            slopes,
            setback,
            pushover,
            shares: Some(shares),
            level,
            checks,
            confidence: self.confidence(kind),
            counts,
            reaction: None,
            shape,
            notes,
        });
    }

    /// Why nothing turns about a joint, where a floor holds the wall at its top.
    fn held_at_top(&self) -> Option<String> {
        let held = self.held;
        let none = held > 0.0 && self.levels(held).next().is_none();
        none.then(|| format!("a floor holds the wall at {held:.2} m, its top"))
    }

    fn facade<'f>(&self, yields: &'f Yielding<'_>) -> Facade<'f> {
        let Yielding { masonry, floors, ties, .. } = yields;
        Facade { masonry, floors, ties, side_walls: &[], crushing: self.wall.crushing, overlaps: self.overlaps }
    }

    /// The least over what gives way, about a joint; none where a floor holds the course on it.
    fn turned(&self, hinge: f64, side_walls: &[SideWall], overlaps: Overlaps) -> Option<(Overturning, Yielding<'_>)> {
        if self.supports.blocks(hinge) {
            return None;
        }
        let make = |yields: &Yielding<'_>| {
            let facade = Facade { overlaps, side_walls, ..self.facade(yields) };
            Some(facade.least(hinge))
        };
        self.supports.least([hinge, f64::INFINITY], make, |found| found.multiplier)
    }

    /// Which floors hold whatever pushes: not those whose course slides before the least arch sets off, for then its R does not get through.
    fn hold(&mut self, arches: &[Storey]) {
        let least = arches.iter().map(|s| s.arch.multiplier()).fold(f64::INFINITY, f64::min);
        let bonded: Vec<SideWall> = self.wall.side_walls.iter().map(|s| s.wall).collect();
        let sides: &[SideWall] = if self.one_sided() { &[] } else { &bonded };
        let top = self.supports.rigid().fold(0.0, f64::max);
        let slides = |hinge: &f64| {
            least.is_finite()
                && self.turned(*hinge, sides, self.overlaps).is_some_and(|(found, _)| found.multiplier < least)
        };
        let lowest = self.levels(0.0).filter(|z| *z < top - LEVEL).find(slides).unwrap_or(f64::INFINITY);
        self.held = self.supports.rigid().filter(|z| *z <= lowest + LEVEL).fold(0.0, f64::max);
        self.floors = self.supports.of_parts(lowest);
    }

    /// Levels of hinges from a height on, each with something above it.
    fn levels(&self, from: f64) -> impl Iterator<Item = f64> {
        self.wall.levels.iter().copied().filter(move |z| *z >= from - LEVEL && *z < self.wall.top - LOWEST)
    }

    fn overturning(&self, survey: &mut Survey) {
        let held = self.held;
        let sides: Vec<SideWall> = self.wall.side_walls.iter().map(|s| s.wall).collect();
        let bonded = !sides.is_empty();
        for hinge in self.levels(held) {
            let Some((found, yields)) = self.turned(hinge, &[], self.overlaps) else { continue };
            let mut notes = self.of_supports(hinge, &yields);
            let alone = self.one_sided();
            match (bonded, alone) {
                (true, false) => notes.push("for comparison: as if the side walls were not bonded".into()),
                (true, true) if sides.len() == 1 => {
                    notes.push("the part away from the one side wall: as if that did not hold it".into());
                }
                (true, true) => {
                    notes.push(
                        "the part away from the side walls, which all stand in one half: as if they did not hold it"
                            .into(),
                    );
                }
                _ => {}
            }
            let sliding = self.sliding(hinge, &yields);
            if sliding < found.multiplier * (1.0 - 1e-9) {
                let (what, level) = (Kind::Overturning.what(), hinge);
                notes.push(format!("the bed joint at {level:.2} m slides at α = {sliding:.4}, before the {what}: no check here knows that"));
            }
            self.turn(survey, Kind::Overturning, found, !bonded || alone, Vec::new(), notes);
        }
        if let Some(why) = self.held_at_top() {
            survey.without.push((Kind::Overturning, why.clone()));
            if bonded {
                survey.without.push((Kind::WithSideWalls, why));
            }
        }
        if !bonded {
            let why = match self.wall.loose {
                0 => "no side wall is given (out_of_plane.side_wall)",
                _ => "no side wall is bonded to it",
            };
            survey.without.push((Kind::WithSideWalls, why.into()));
            return;
        }
        for hinge in self.levels(held) {
            let Some((found, yields)) = self.turned(hinge, &sides, self.overlaps) else { continue };
            let wedges = self.wall.side_walls.iter().zip(&found.slopes).map(|(s, slope)| [s.at, *slope]).collect();
            let mut notes = self.of_supports(hinge, &yields);
            if sides.len() == 1 {
                notes.push("one side wall alone: the façade twists about it, and α0 is about a tenth too high".into());
            } else if self.one_sided() {
                notes.push("all side walls stand in one half: the façade twists about them, and α0 is too high".into());
            }
            let code = self.turned(hinge, &sides, Overlaps::Code).filter(|_| self.overlaps != Overlaps::Code);
            notes.extend(code.map(|(code, _)| format!("with f = 0.4 of the code α0 is {:.4}", code.multiplier)));
            self.turn(survey, Kind::WithSideWalls, found, true, wedges, notes);
        }
    }

    /// Whether the side walls do not reach both ends: there is one, or all stand in one half.
    fn one_sided(&self) -> bool {
        let wall = self.wall;
        let middle = 0.5 * (wall.extent[0] + wall.extent[1]);
        let all = |left: bool| wall.side_walls.iter().all(|s| if left { s.at < middle } else { s.at > middle });
        wall.side_walls.len() == 1 || all(true) || all(false)
    }

    /// What to know of what holds the part over a hinge back.
    fn of_supports(&self, hinge: f64, yields: &Yielding<'_>) -> Vec<String> {
        let gave = yields.told([hinge, f64::INFINITY]);
        let facade = self.facade(yields);
        let lost = yields.ties.iter().filter(|tie| tie.level > hinge + LEVEL).filter_map(|tie| {
            let bears = facade.tie(hinge, tie);
            (bears < (1.0 - 1e-9) * tie.force).then(|| {
                format!(
                    "the tie at {:.2} m comes to {:.2} of its {:.2} kN before the wall would fall without it: that much counts",
                    tie.level,
                    1e-3 * bears,
                    1e-3 * tie.force
                )
            })
        });
        gave.into_iter().chain(lost).collect()
    }

    /// α at which the bed joint on a level slides, as if side walls did not hold what lies above.
    fn sliding(&self, hinge: f64, yields: &Yielding<'_>) -> f64 {
        let own = yields.masonry.above(hinge).weight;
        let (mut holds, mut masses) = (self.wall.friction * own, own);
        for floor in yields.floors.iter().filter(|f| f.level > hinge + LEVEL) {
            let rubs = (self.wall.friction + floor.friction) * floor.load;
            holds += rubs + floor.connection - floor.thrust;
            masses += floor.load + floor.pushing;
        }
        let facade = self.facade(yields);
        holds += yields.ties.iter().filter(|t| t.level > hinge + LEVEL).map(|t| facade.tie(hinge, t)).sum::<f64>();
        holds / masses
    }

    fn turn(
        &self,
        survey: &mut Survey,
        kind: Kind,
        found: Overturning,
        counts: bool,
        wedges: Vec<[f64; 2]>,
        notes: Vec<String>,
    ) {
        let Overturning { hinge, setback, slopes, body, width, .. } = found;
        let mut notes = notes;
        if width > self.wall.masonry.thickness {
            notes.push(format!(
                "masonry crushes under the loads at rest: they need {width:.3} m of the joint's depth, and the hinge is taken to lie on the other face"
            ));
        }
        let shape = Shape::Above { wedges };
        let rest = Rest { slopes, setback, counts, shape, notes, seats: true, level: None };
        self.add_body(survey, kind, body, hinge, self.wall.top - hinge, rest);
    }

    fn leaf(&self, survey: &mut Survey) {
        let Some(thickness) = self.wall.leaf else {
            survey
                .without
                .push((Kind::Leaf, "the wall has one leaf, or headers tie its leaves (out_of_plane.leaves)".into()));
            return;
        };
        let part = thickness / self.wall.masonry.thickness;
        let pieces =
            self.wall.masonry.pieces.iter().map(|p| crate::facade::Piece { weight: part * p.weight, ..*p }).collect();
        let masonry = Masonry { thickness, pieces };
        for hinge in self.levels(0.0) {
            let on_it: Vec<Floor> = self.floors.iter().filter(|f| f.depth < thickness - LEVEL).copied().collect();
            let facade = Facade {
                masonry: &masonry,
                floors: &on_it,
                ties: &self.wall.ties,
                side_walls: &[],
                crushing: self.wall.crushing,
                overlaps: self.overlaps,
            };
            let rest = match on_it.len() {
                0 => "floors are taken to rest on the inner leaf".to_string(),
                _ => format!(
                    "{} of {} floors rest on it by their `at`, the others on the inner leaf",
                    on_it.len(),
                    self.floors.len()
                ),
            };
            let notes = vec![format!("{rest}; ties hold the outer one by their plates")];
            self.turn(survey, Kind::Leaf, facade.least(hinge), true, Vec::new(), notes);
        }
    }

    /// Storeys between any two levels that hold the wall, each with what gives way between them at its full force.
    fn vertical_arches(&self) -> Vec<Storey> {
        let tops = self.tops();
        let feet = self.feet(&tops);
        let rigid: Vec<f64> = self.supports.rigid().collect();
        let (mut between, mut past) = (Vec::new(), Vec::new());
        for &low in feet.iter().filter(|low| !self.supports.blocks(**low)) {
            for top in tops.iter().filter(|top| top.floor.level > low + LEVEL) {
                let levels = [low, top.floor.level];
                let make = |yields: &Yielding<'_>| self.storey(levels, top, yields);
                let Some((mut storey, yields)) = self.supports.least(levels, make, |s| s.arch.multiplier()) else {
                    continue;
                };
                storey.notes = yields.told(levels);
                let passes = rigid.iter().any(|z| *z > low + LEVEL && *z < levels[1] - LEVEL);
                if passes { past.push(storey) } else { between.push(storey) }
            }
        }
        // Past a floor without a known force only where its course slides first.
        let least = between.iter().map(|s| s.arch.multiplier()).fold(f64::INFINITY, f64::min);
        between.extend(past.into_iter().filter(|s| s.arch.multiplier() < least));
        between.sort_by(|a, b| a.levels[0].total_cmp(&b.levels[0]).then(a.levels[1].total_cmp(&b.levels[1])));
        between
    }

    /// What may hold the top of an arch: floors that hold, connections, and ties that are not beside one of them.
    fn tops(&self) -> Vec<FloorOf> {
        let wall = self.wall;
        let mut tops: Vec<FloorOf> = Vec::new();
        let holding = wall.floors.iter().filter(|f| f.holds);
        for own in holding.chain(wall.floors.iter().filter(|f| !f.holds && f.floor.connection > 0.0)) {
            if tops.iter().all(|top| (top.floor.level - own.floor.level).abs() > LEVEL) {
                tops.push(*own);
            }
        }
        for tie in &wall.ties {
            if !tops.iter().any(|top| wall.is_beside(tie, top.floor.level)) {
                let floor = Floor { level: tie.level, ..Floor::default() };
                tops.push(FloorOf { floor, given: false, holds: false, clamps: false });
            }
        }
        tops
    }

    /// Where an arch may stand: on the base, on a floor that holds, on the bed joints beside a tie.
    fn feet(&self, tops: &[FloorOf]) -> Vec<f64> {
        let beside = |z: f64| {
            let below = self.wall.levels.iter().copied().rfind(|joint| *joint <= z + LEVEL);
            let above = self.wall.levels.iter().copied().find(|joint| *joint >= z - LEVEL);
            [below, above]
        };
        let mut feet = vec![0.0];
        feet.extend(tops.iter().filter(|top| top.given).map(|top| top.floor.level));
        feet.extend(tops.iter().filter(|top| !top.given).flat_map(|top| beside(top.floor.level)).flatten());
        feet.sort_by(f64::total_cmp);
        feet.dedup_by(|a, b| (*a - *b).abs() < LEVEL);
        feet
    }

    /// The arch between two levels, the upper one held by `upper`; none where no bed joint lies between them.
    fn storey(&self, levels: [f64; 2], upper: &FloorOf, yields: &Yielding<'_>) -> Option<Storey> {
        let wall = self.wall;
        let t = wall.masonry.thickness;
        let [low, high] = levels;
        let top = self.wall.masonry.above(high);
        let above: Vec<&Floor> = wall.floors.iter().map(|f| &f.floor).filter(|f| f.level >= high - LEVEL).collect();
        let load = top.weight + above.iter().map(|f| f.load).sum::<f64>();
        let moment = top.weight * 0.5 * t + above.iter().map(|f| f.load * f.depth).sum::<f64>();
        let depth = match (upper.clamps, load > 0.0) {
            (true, _) => t,
            (false, true) => (t - moment / load).clamp(0.0, t),
            (false, false) => 0.5 * t,
        };
        let last = self.levels(0.0).filter(|z| *z < high - LEVEL).last().unwrap_or(low);
        let within = |f: &&Floor, from: f64, to: f64| f.level > from + LEVEL && f.level <= to && f.level < high - LEVEL;
        let forces = |from: f64, to: f64| {
            let inside = yields.floors.iter().filter(|f| within(f, from, to));
            let of = |f: &Floor| {
                let holds = f.connection + f.friction * f.load;
                [f.thrust, -holds].map(|force| Thrust { force, depth: f.depth, height: f.level - low })
            };
            let ties = yields.ties.iter();
            let ties = ties.filter(|t| t.level > from + LEVEL && t.level <= to && t.level < last - LEVEL);
            let ties = ties.map(|tie| Thrust { force: -tie.force, depth: 0.0, height: tie.level - low });
            inside.flat_map(of).chain(ties).filter(|force| force.force != 0.0).collect::<Vec<_>>()
        };
        let arch = |hinge: f64| {
            let part = |from: f64, to: f64| {
                let own = yields.masonry.between(from, to);
                let height = own.centroid[1] - low;
                let mut all = vec![Weight { carried: own.weight, pushing: 0.0, depth: 0.5 * t, height }];
                let inside = yields.floors.iter().filter(|f| within(f, from, to));
                all.extend(inside.map(|f| Weight {
                    carried: f.load,
                    pushing: f.pushing,
                    depth: f.depth,
                    height: f.level - low,
                }));
                all
            };
            let mut parts = [part(low, hinge), part(hinge, high)];
            let mut forces = [forces(low, hinge), forces(hinge, high)];
            let weight = |part: &Vec<Weight>| part.iter().map(|w| w.carried).sum::<f64>();
            let [lower, upper_part] = [weight(&parts[0]), weight(&parts[1])];
            // (OP2) at every hinge: the base's on the outer face, the middle's on the inner one, the top's on the outer one of a floor
            // that clamps. N that stays in its place is set back by nothing.
            let back = |force: f64, level: f64| wall.crushing.setback_within(force, wall.masonry.bearing(level), t);
            let [base, middle] = [back(load + lower + upper_part, low), back(load + upper_part, hinge)];
            let depth = if upper.clamps { t - back(load, last) } else { depth };
            parts.iter_mut().flatten().for_each(|w| w.depth -= base);
            forces.iter_mut().flatten().for_each(|f| f.depth -= base);
            let arch = VerticalArch {
                thickness: (t - base - middle).max(1e-9 * t),
                height: high - low,
                parts,
                forces,
                hinge: hinge - low,
                load,
                depth: (depth - middle).max(0.0),
            };
            (arch, base)
        };
        let inside = self.levels(0.0).filter(|z| *z > low + LOWEST && *z < high - LOWEST);
        let arches = inside.map(|z| (z, arch(z)));
        let (hinge, (arch, setback)) = arches.min_by(|a, b| a.1.0.multiplier().total_cmp(&b.1.0.multiplier()))?;
        // What the floors above push outwards goes to the support as well.
        let needed = arch.reaction() + above.iter().map(|f| f.thrust).sum::<f64>();
        let course = self.wall.masonry.between(last, high).weight;
        Some(Storey {
            levels,
            arch,
            hinge,
            setback,
            needed,
            borne: wall.borne(upper),
            rubs: wall.friction * (load + course),
            holds: upper.holds,
            notes: Vec::new(),
        })
    }

    /// Arches among all else: one whose top has less than it needs is a bound still, and counts where nothing lies below it.
    fn told(&self, arches: Vec<Storey>, survey: &Survey) -> Vec<Found> {
        let others = survey.found.iter().filter(|f| f.counts).map(Found::multiplier);
        let sure = arches.iter().filter(|s| !s.gives_way()).map(|s| s.arch.multiplier());
        let least = others.chain(sure).fold(f64::INFINITY, f64::min);
        let of = |storey: Storey| {
            let counts = !storey.gives_way() || storey.arch.multiplier() < least;
            (counts || storey.holds).then(|| self.found(storey, counts))
        };
        arches.into_iter().filter_map(of).collect()
    }

    fn found(&self, storey: Storey, counts: bool) -> Found {
        let Storey { levels, arch, hinge, setback, needed, borne, rubs, mut notes, .. } = storey;
        match borne {
            None => notes.push(format!(
                "the top needs R = {:.2} kN: assumed to be borne, for `holds` says so; give connection or anchors to check it",
                1e-3 * needed
            )),
            Some(borne) if needed > borne => notes.push(format!(
                "the top needs R = {:.2} kN and has {:.2} kN: it gives way first, {}",
                1e-3 * needed,
                1e-3 * borne,
                if counts { "and α0 is too high" } else { "and the wall overturns below it; for comparison" }
            )),
            Some(_) => {}
        }
        if needed > rubs {
            notes.push(format!(
                "the bed joint under the held course bears {:.2} kN by friction: R does not get through it",
                1e-3 * rubs
            ));
        }
        if self.wall.leaf.is_some() {
            notes.push("its leaves are not tied: α0 of a wall in one piece, which is too high".into());
        }
        let pushover = Pushover::of(Kinematics::VerticalArch(arch));
        if pushover.multiplier <= 0.0 {
            notes.push(FALLS.into());
        }
        let [low, high] = levels;
        let level = 0.5 * (low + high);
        let checks = self.checks(Kind::VerticalArch, &pushover, level, None, Vibrates::Held(high - low));
        Found {
            kind: Kind::VerticalArch,
            hinge,
            slopes: Vec::new(),
            setback,
            pushover,
            shares: None,
            level,
            checks,
            confidence: self.confidence(Kind::VerticalArch),
            counts,
            reaction: Some([Some(needed), borne]),
            shape: Shape::Storey { levels },
            notes,
        }
    }

    fn strip(&self, survey: &mut Survey) {
        let Some([from, given, span, friction]) = self.wall.strip else {
            let why = "the thrust at which its abutments give way is not given (out_of_plane.strip)";
            survey.without.push((Kind::HorizontalArch, why.into()));
            return;
        };
        let wall = self.wall;
        let own = wall.masonry.above(from);
        let on_it = || self.floors.iter().filter(|f| f.level >= from - LEVEL);
        let load: f64 = on_it().map(|f| f.load).sum();
        // A floor that holds the wall is held itself.
        let moves = || {
            self.floors
                .iter()
                .zip(&self.wall.floors)
                .filter(|(floor, own)| own.given && !own.holds && floor.level >= from - LEVEL)
        };
        let pushes: f64 = moves().map(|(f, _)| f.load + f.pushing).sum();
        let outwards: f64 = moves().map(|(f, _)| f.thrust).sum();
        // The abutments bear up to their thrust: an arch that crushes takes no more of it than is best.
        let best = wall.crushing.best_force(wall.top - from, wall.masonry.thickness);
        let thrust = given.min(best);
        // (OP2) under the thrust, over the height of the strip: at midspan on the inner face, at the abutments on the outer one.
        let setback = wall.crushing.setback(thrust, wall.top - from);
        let arch = HorizontalArch {
            thickness: wall.masonry.thickness - 2.0 * setback,
            spans: [0.5 * span; 2],
            weight: own.weight / wall.length(),
            thrust,
            friction,
            load: load / wall.length(),
            pushing: pushes / wall.length(),
            outwards: outwards / wall.length(),
        };
        let pushover = Pushover::of(Kinematics::HorizontalArch(arch));
        let level = 0.5 * (from + wall.top);
        let checks = self.checks(Kind::HorizontalArch, &pushover, level, None, Vibrates::Unknown);
        let left = wall.extent[0] + 0.5 * (wall.length() - span);
        let mut notes = vec![
            "weight, floors and their thrust taken as uniform along the strip; floors that hold the wall push nothing"
                .into(),
            "H_r is what the file gives: check the side wall in its plane with `concio limit`".into(),
        ];
        if given > best {
            notes.push(format!(
                "the abutments bear {:.1} kN, and the arch takes {:.1} kN of it: with more its masonry would crush, and it would bear less",
                1e-3 * given,
                1e-3 * best
            ));
        }
        if pushover.multiplier <= 0.0 {
            notes.push(FALLS.into());
        }
        survey.found.push(Found {
            kind: Kind::HorizontalArch,
            hinge: from,
            slopes: Vec::new(),
            setback,
            pushover,
            shares: None,
            level,
            checks,
            confidence: self.confidence(Kind::HorizontalArch),
            counts: true,
            reaction: None,
            shape: Shape::Strip { levels: [from, wall.top], at: [left, left + 0.5 * span, left + span] },
            notes,
        });
    }

    fn corners(&self, survey: &mut Survey) {
        let at_ends: Vec<&Side> = self.wall.side_walls.iter().filter(|s| s.corner.is_some()).collect();
        if at_ends.is_empty() {
            survey.without.push((Kind::Corner, "no bonded side wall stands at an end of the wall".into()));
        } else if let Some(why) = self.held_at_top() {
            survey.without.push((Kind::Corner, why));
        }
        for side in at_ends {
            let Some(own) = side.corner else { continue };
            let wall = self.wall;
            let [course, overlap] = wall.texture;
            let front = SideWall {
                thickness: wall.masonry.thickness,
                specific_weight: wall.specific_weight,
                course,
                overlap,
                friction: wall.friction,
                load: 0.0,
                // No crack leaves the wall.
                opening: Some(own.opening.filter(|d| *d > 0.0).map_or(wall.length(), |d| d.min(wall.length()))),
            };
            let beside = SideWall { opening: side.wall.opening.map(|d| d + wall.masonry.thickness), ..side.wall };
            let corner = Corner {
                walls: [front, beside],
                direction: own.direction,
                top: wall.top,
                load: own.load,
                overlaps: self.overlaps,
            };
            let left = side.at < 0.5 * (wall.extent[0] + wall.extent[1]);
            let from = |y: f64| if left { y - wall.extent[0] } else { wall.extent[1] - y };
            let ties: Vec<Tie> = wall.ties.iter().map(|t| Tie { position: from(t.position), ..*t }).collect();
            let beside = Beside { floors: &self.floors, ties: &ties, length: wall.length() };
            for hinge in self.levels(self.held) {
                let found = corner.least(hinge, &beside);
                if !found.multiplier.is_finite() {
                    // Blocks of a single course do not overlap: no crack climbs them.
                    continue;
                }
                let bare = corner.least(hinge, &Beside::default()).multiplier;
                let at = if left { "left" } else { "right" };
                let notes = vec![
                    format!("the {at} corner; without the floors and ties on its wedge α0 is {bare:.4}"),
                    format!(
                        "φ = {:.0}° is given, not found; both cracks take the same part of their textures' slope",
                        own.direction.to_degrees()
                    ),
                ];
                let shape = Shape::Corner { left, slopes: found.slopes };
                let rest = Rest {
                    slopes: found.slopes.to_vec(),
                    setback: 0.0,
                    counts: true,
                    shape,
                    notes,
                    seats: false,
                    level: None,
                };
                self.add_body(survey, Kind::Corner, found.body, hinge, wall.top - hinge, rest);
            }
        }
    }

    fn flaps(&self, survey: &mut Survey) {
        let wall = self.wall;
        let steepest = wall.texture[1] / wall.texture[0];
        let mut cracks: Vec<f64> = wall.openings.iter().flat_map(|o| [o[0], 0.5 * (o[0] + o[2]), o[2]]).collect();
        cracks.push(0.5 * (wall.extent[0] + wall.extent[1]));
        cracks.sort_by(f64::total_cmp);
        cracks.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
        let bonded = |end: f64| wall.side_walls.iter().any(|s| (s.at - end).abs() <= s.wall.thickness + LEVEL);
        let ends = wall.extent.map(|end| (end, bonded(end)));
        let before = survey.found.len();
        for foot in self.levels(self.held) {
            let height = wall.top - foot;
            let mut best: Option<(f64, Flap, Body)> = None;
            let mut free = f64::INFINITY;
            for &crack in &cracks {
                for (end, held) in ends {
                    let room = (end - crack).abs() / height;
                    // Beside a bonded side wall the hinge has to reach the top before it.
                    let flattest = if held { room } else { FLATTEST };
                    if room < 1e-3 || flattest <= 1e-3 {
                        continue;
                    }
                    let at = |slope: f64| {
                        let flap = flap(crack, foot, wall.top, end, slope);
                        let body = flap.laden(&wall.masonry, &self.floors, &wall.ties, wall.extent);
                        let value = if body.weights[0].carried > 0.0 { body.multiplier() } else { f64::INFINITY };
                        (value, flap, body)
                    };
                    free = free.min(at(crate::minimum::least(ANGLES, 0.02 * flattest, flattest, |s| at(s).0)).0);
                    if flattest < steepest {
                        continue;
                    }
                    let found = at(crate::minimum::least(ANGLES, steepest, flattest, |s| at(s).0));
                    if best.as_ref().is_none_or(|b| found.0 < b.0) && found.0.is_finite() {
                        best = Some(found);
                    }
                }
            }
            let Some((value, flap, body)) = best else { continue };
            let mut notes = vec![
                "the crack is open from foot to top, without thrust on it: blocks that interlock across it hold more"
                    .to_string(),
            ];
            if flap.angle().tan() > FLATTEST * (1.0 - 1e-6) {
                notes.push(format!("the flattest hinge that is tried, tan ϑ = {FLATTEST}: beyond it the part beside the crack overturns"));
            }
            if free < value * (1.0 - 1e-3) {
                notes.push(format!("a hinge steeper than the joints allow would give α0 = {free:.4}"));
            }
            let control = flap.outline.iter().map(|p| flap.distance(*p)).fold(0.0, f64::max);
            let level = 0.5 * (flap.hinge[0][1] + flap.hinge[1][1]);
            let rest = Rest {
                slopes: vec![flap.angle().tan()],
                setback: 0.0,
                counts: true,
                shape: Shape::Outlines(vec![flap.outline.clone()]),
                notes,
                seats: false,
                level: Some(level),
            };
            self.add_body(survey, Kind::Flap, body, foot, control, rest);
        }
        if survey.found.len() == before {
            let fits =
                "no oblique hinge fits beside a crack: bonded side walls are too near for the slope of the texture";
            survey.without.push((Kind::Flap, self.held_at_top().unwrap_or_else(|| fits.into())));
        }
    }

    fn gable(&self, survey: &mut Survey) {
        let Some((gable, press)) = self.wall.gable else {
            survey.without.push((Kind::Gable, "no gable is given (out_of_plane.gable)".into()));
            return;
        };
        let wall = self.wall;
        let left = 0.5 * (wall.extent[0] + wall.extent[1] - gable.base);
        let place = |corners: &[[f64; 2]]| corners.iter().map(|[y, z]| [left + y, wall.top + z]).collect::<Vec<_>>();
        let whole = [[0.0, 0.0], [gable.base, 0.0], [0.5 * gable.base, gable.height]];
        let mut body = gable.whole();
        let setback = wall.crushing.setback(gable.weight() + gable.load, gable.base);
        body.weights.iter_mut().for_each(|w| w.depth -= setback);
        body.thrusts.iter_mut().for_each(|h| h.depth -= setback);
        let rest = Rest {
            slopes: Vec::new(),
            setback,
            counts: true,
            shape: Shape::Outlines(vec![place(&whole)]),
            notes: Vec::new(),
            seats: false,
            level: None,
        };
        self.add_body(survey, Kind::Gable, body, wall.top, gable.height, rest);
        let steepest = wall.texture[1] / wall.texture[0];
        let Flaps { flap, multiplier, body } = gable.least_flaps(steepest, press);
        if !multiplier.is_finite() || body.weights[0].height <= 0.0 {
            survey.without.push((Kind::GableFlaps, "no oblique hinge fits the slope of the texture".into()));
            return;
        }
        let free = gable.least_flaps(0.0, press);
        let mut notes = Vec::new();
        if free.multiplier < multiplier * (1.0 - 1e-3) {
            notes.push(format!(
                "a hinge steeper than the joints allow would give α0 = {:.4}: check the ridge beam against punching",
                free.multiplier
            ));
        }
        let mirrored: Vec<[f64; 2]> = flap.outline.iter().rev().map(|[y, z]| [gable.base - y, *z]).collect();
        let control = flap.distance([0.5 * gable.base, gable.height]);
        let rest = Rest {
            slopes: vec![flap.angle().tan()],
            setback: 0.0,
            counts: true,
            shape: Shape::Outlines(vec![place(&flap.outline), place(&mirrored)]),
            notes,
            seats: false,
            level: Some(wall.top + 0.5 * (flap.hinge[0][1] + flap.hinge[1][1])),
        };
        self.add_body(survey, Kind::GableFlaps, body, wall.top + flap.crack[0][1], control, rest);
    }
}

/// How a part vibrates before it cracks.
#[derive(Debug, Clone, Copy)]
enum Vibrates {
    /// As it stands in the building.
    Unknown,
    /// Freely, of a height and a thickness [m].
    Free(f64, f64),
    /// Held at both ends, so far apart [m].
    Held(f64),
}

/// What a body does not say of itself.
struct Rest {
    slopes: Vec<f64>,
    setback: f64,
    counts: bool,
    shape: Shape,
    notes: Vec<String>,
    seats: bool,
    level: Option<f64>,
}

/// The flap between a crack and one end of the wall, its hinge rising from the foot of the crack at tan ϑ.
fn flap(crack: f64, foot: f64, top: f64, end: f64, slope: f64) -> Flap {
    let way = (end - crack).signum();
    let reach = (top - foot) * slope;
    let inside = reach <= (end - crack).abs();
    let [at, head] = [[crack, foot], [crack, top]];
    let upper = if inside { [crack + way * reach, top] } else { [end, foot + (end - crack).abs() / slope] };
    let mut outline = vec![at, upper];
    if !inside {
        outline.push([end, top]);
    }
    outline.push(head);
    if way < 0.0 {
        outline.reverse();
    }
    Flap { outline, hinge: [at, upper], crack: [at, head], thrust: 0.0 }
}
