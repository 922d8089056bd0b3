//! Walls that rock out of their plane: from a wall file to the mechanism of its survey, and its bodies in section as the blocks of a wall.
//!
//! The mechanism is that of `concio mechanisms`, of the same keys: multipliers and time histories cannot differ. The mechanics are those of
//! `concio_mechanisms::rocking`.

use concio_law::drift::{Top, Tops};
use concio_mechanisms::rocking::{Linkage, Mechanism, Member, Positive, Setting, Shaking, Spot};
use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::{Found, Kind, Survey, survey};
use concio_mechanisms::time_history::TimeHistory;
use concio_mechanisms::wall::Wall as Facade;
use concio_shear::law::{Contact, Elastic};
use concio_shear::system as shear;

use crate::G;
use crate::case::out_of_plane::{RockingKind, Towards};
use crate::case::{Case, JointKind};
use crate::drift;
use crate::error::{InputError, Result};
use crate::excitation::Excitation;
use crate::facade;
use crate::ground::GroundMotion;
use crate::quantity::shown;
use crate::wall::{Block, End, Joint, PanelInfo, Wall};
use crate::warning::{Warning, WarningKind};

/// Time after the end of the motion in which a wall may come to rest, where its file gives no duration [s].
pub const TAIL: f64 = 60.0;
/// Set-back of a hinge over the wall's thickness from which crushing is what overturns it: its weight lies at half of it.
const CRUSHED: f64 = 0.3;
/// Heights within this are one level [m].
const LEVEL: f64 = 1e-6;
/// The bodies, from below.
pub(crate) const BODIES: [&str; 2] = ["lower", "upper"];

/// A wall that rocks.
#[derive(Debug, Clone)]
pub struct Rocking {
    /// What rocks, as the survey found it.
    pub kind: Kind,
    /// Level of its hinge above the base, of an arch the one between its ends [m].
    pub hinge: f64,
    /// What rocks: places are depths behind the outer face and heights above the base.
    pub mechanism: Mechanism,
    /// The same, compiled.
    pub compiled: concio_mechanisms::rocking::Rocking,
    /// The side to which the motion of the base points.
    pub positive: Positive,
    /// Longest step, where one is given [s].
    pub step: Option<f64>,
    /// When the motion is over [s]; what is left of the run is for the wall to come to rest.
    pub shaking_ends: f64,
}

pub use concio_mechanisms::rocking::LiftOff;

impl Rocking {
    /// The least factor on a motion at which the wall first lifts off, in closed form; none where no factor lifts it off.
    ///
    /// # Errors
    /// None of a wall that was compiled.
    pub fn first_lift_off(&self, excitation: &Excitation) -> Result<Option<LiftOff>> {
        let setting = Setting { duration: Some(self.shaking_ends), ..Setting::default() };
        Ok(self.compiled.first_lift_off(&self.shaking(excitation), &setting)?)
    }

    /// The motion as the mechanism takes it.
    pub(crate) fn shaking<'e>(&self, excitation: &'e Excitation) -> Shaking<'e> {
        let Excitation { base, vertical, .. } = excitation;
        Shaking { across: base, positive: self.positive, vertical, scale: 1.0 }
    }

    /// How the mechanism is followed through the motion, without samples.
    pub(crate) fn setting(&self, excitation: &Excitation) -> Setting {
        Setting {
            duration: Some(self.shaking_ends),
            tail: excitation.duration - self.shaking_ends,
            step: self.step,
            ..Setting::default()
        }
    }

    /// 1 where the motion of the base points inwards, else −1.
    pub(crate) fn inwards(&self) -> f64 {
        if self.positive == Positive::Inwards { 1.0 } else { -1.0 }
    }

    /// Vertical force on what lies below hinge `e`, in a position turned by θ, θ̇ and θ̈ on ground that accelerates upwards, without the floors that
    /// are gone [N].
    pub(crate) fn pressure(&self, e: usize, turned: [f64; 3], gone: &[bool], up: f64) -> f64 {
        let above = |spot: &Spot| e == 0 || spot.member == Member::Upper;
        let force = |(spot, weight): (&Spot, f64)| {
            weight * (1.0 + (up + self.compiled.moved(spot, turned).acceleration[1]) / G)
        };
        let parts = self.mechanism.parts.iter().map(|part| (&part.centre, part.weight));
        let floors = self.mechanism.floors.iter().zip(gone).filter(|(_, gone)| !**gone).map(|(f, _)| (&f.at, f.load));
        parts.chain(floors).filter(|(spot, _)| above(spot)).map(force).sum()
    }

    /// Centre of the body of a block.
    pub(crate) fn centre(&self, wall: &Wall, block: usize) -> Spot {
        let member = if block == 0 { Member::Lower } else { Member::Upper };
        Spot { member, at: wall.blocks[block].centre() }
    }
}

impl RockingKind {
    fn of(self) -> Kind {
        match self {
            RockingKind::Overturning => Kind::Overturning,
            RockingKind::OverturningWithSideWalls => Kind::WithSideWalls,
            RockingKind::OverturningOfOuterLeaf => Kind::Leaf,
            RockingKind::VerticalArch => Kind::VerticalArch,
            RockingKind::Gable => Kind::Gable,
        }
    }
}

/// Whether nothing moves a rocking wall.
pub(crate) fn is_still(excitation: &Excitation) -> bool {
    [&excitation.base, &excitation.vertical].into_iter().all(|motion| *motion == GroundMotion::AtRest)
}

/// When the motion of a rocking wall ends that is to last `duration` [s]; a wall that nothing moves is looked at for as long.
pub(crate) fn shaking_ends(excitation: &Excitation) -> f64 {
    let ends = excitation.base.end().zip(excitation.vertical.end()).map(|(across, up)| across.max(up));
    ends.filter(|end| *end > 0.0).unwrap_or(f64::INFINITY).min(excitation.duration)
}

/// The mechanism that a wall file asks for, as the survey has it.
///
/// # Errors
/// A kind or level that the wall has not, or that cannot be followed.
fn chosen<'s>(case: &Case, survey: &'s Survey) -> Result<&'s Found> {
    let least =
        |found: &mut dyn Iterator<Item = &'s Found>| found.min_by(|a, b| a.multiplier().total_cmp(&b.multiplier()));
    let Some(kind) = case.rocking.mechanism.map(RockingKind::of) else {
        let none = || InputError::new("the wall has no mechanism out of its plane").key("out_of_plane");
        return survey.least().ok_or_else(|| none().allowed("a wall that `concio mechanisms` finds some of").into());
    };
    let of_kind = || survey.found.iter().filter(move |found| found.kind == kind);
    if of_kind().next().is_none() {
        let why = survey.without.iter().find(|(without, _)| *without == kind);
        let why = why.map_or_else(String::new, |(_, why)| format!(": {why}"));
        let error = InputError::new(format!("the wall has no {}{why}", kind.what())).key("rocking.mechanism");
        return Err(error.allowed("a mechanism that `concio mechanisms` finds").into());
    }
    let Some(level) = case.rocking.hinge.map(|level| level.si()) else {
        return Ok(least(&mut of_kind()).unwrap_or(&survey.found[0]));
    };
    least(&mut of_kind().filter(|found| (found.hinge - level).abs() < LEVEL)).ok_or_else(|| {
        let told = |level: f64| shown((1e6 * level).round() / 1e6);
        let levels: Vec<String> = of_kind().map(|found| told(found.hinge)).collect();
        let below = of_kind().map(|found| found.hinge).filter(|z| *z < level).reduce(f64::max);
        let above = of_kind().map(|found| found.hinge).filter(|z| *z > level).reduce(f64::min);
        let near: Vec<String> = below.into_iter().chain(above).map(|z| format!("{} m", told(z))).collect();
        let error = InputError::new(format!("no hinge of its {} lies at {} m", kind.what(), shown(level)));
        let error = error.key("rocking.hinge").allowed(format!("{} m", levels.join(", ")));
        error.help(format!("the nearest are at {}", near.join(" and "))).into()
    })
}

/// A compiled wall that rocks, with what results of all models list.
pub(crate) struct Compiled {
    pub rocking: Rocking,
    pub wall: Wall,
    pub joints: Vec<Joint>,
    pub shear: shear::System,
    /// End of the run [s].
    pub duration: f64,
    pub warnings: Vec<Warning>,
}

/// Compiles a wall that rocks.
///
/// # Errors
/// Walls that have no mechanisms, mechanisms that turn about other than level hinges or fall under their own loads, and what [`facade::of`] refuses.
pub(crate) fn compile(case: &Case, excitation: &Excitation) -> Result<Compiled> {
    let own = facade::of(case)?;
    let survey = survey(&own, Overlaps::Summed);
    let found = chosen(case, &survey)?;
    let of_mechanism = |what: String| {
        let key = if case.rocking.mechanism.is_some() { "rocking.mechanism" } else { "model" };
        let error = InputError::new(what).key(key).allowed("a mechanism with level hinges that stands by itself");
        error.help("`concio mechanisms` lists those of the wall; `rocking.mechanism` names one")
    };
    let name = found.kind.what();
    let made = TimeHistory::of(&own, found, case.rocking.restitution)
        .map_err(|why| of_mechanism(format!("the mechanism with the least α0, {name}, has no time history: {why}")))?;
    let compiled = concio_mechanisms::rocking::Rocking::new(&made.mechanism).map_err(|error| {
        match error.key.as_deref() {
            Some("back.restitution") => error.key("rocking.restitution").help("leave it out for (OP11)"),
            // The keys of its errors are those of a struct that nobody sees.
            _ => of_mechanism(format!("{name}: {}{}", error.what, beside(&own, found, &made))),
        }
    })?;
    let shaking_ends = shaking_ends(excitation);
    let duration = if case.motion.duration.is_none() { shaking_ends + TAIL } else { excitation.duration };
    let (wall, joints) = section(&own, &made);
    let mut warnings = warnings(case, found, &survey, &made);
    warnings.extend(facade::doubts(case, &own));
    if is_still(excitation) {
        let text = "motion.base is at rest, and so is motion.vertical: nothing moves the wall";
        warnings.push(Warning::new(WarningKind::UnlikelyRecord, text));
    }
    let rocking = Rocking {
        kind: found.kind,
        hinge: found.hinge,
        positive: match case.rocking.positive {
            Towards::Inwards => Positive::Inwards,
            Towards::Outwards => Positive::Outwards,
        },
        step: case.solver.step.map(|step| step.si()),
        shaking_ends,
        compiled,
        mechanism: made.mechanism,
    };
    let shear = listed(&wall, &joints, &rocking, duration);
    Ok(Compiled { rocking, wall, joints, shear, duration, warnings })
}

/// What may be why a mechanism does not stand by itself, where `concio mechanisms` counts it: sentences that follow another.
fn beside(own: &Facade, found: &Found, made: &TimeHistory) -> String {
    let crushed = (!own.crushing.is_left_out() && found.setback > CRUSHED * own.masonry.thickness).then(|| {
        format!(
            ". Masonry of this out_of_plane.strength crushes under it: the hinge lies {:.3} m behind the face, in {} m",
            found.setback,
            shown(own.masonry.thickness)
        )
    });
    let tied = (found.multiplier() > 0.0 && !made.mechanism.ties.is_empty()).then(|| {
        format!(
            ". Its ties, which begin at no force, do not hold it yet: with their full force α0 is {:.4}",
            found.multiplier()
        )
    });
    crushed.into_iter().chain(tied).collect()
}

/// The bodies in section: x is the depth behind the outer face, y the height above the base. A body weighs what moves with it, wedges of side walls
/// included. Joints are the hinges.
fn section(own: &Facade, made: &TimeHistory) -> (Wall, Vec<Joint>) {
    let member = [Member::Lower, Member::Upper];
    let block = |(k, [[left, low], [right, high]]): (usize, [[f64; 2]; 2])| {
        let parts = made.mechanism.parts.iter().filter(|part| part.centre.member == member[k]);
        let weight: f64 = parts.map(|part| part.weight).sum();
        Block {
            name: BODIES[k].into(),
            panel: 0,
            course: k,
            x: [left, right],
            y: [low, high],
            shape: None,
            thickness: own.length(),
            specific_weight: weight / ((right - left) * (high - low) * own.length()),
        }
    };
    let blocks: Vec<Block> = made.bodies.iter().copied().enumerate().map(block).collect();
    let panel = PanelInfo {
        name: "section".into(),
        courses: blocks.len(),
        reference_length: blocks[0].length(),
        reference_height: blocks[0].height(),
        reference_mass: blocks[0].mass(),
        mortar: [0.0; 2],
        connection: 0.0,
    };
    let joint = |k: usize| {
        let Block { x: [left, right], y: [level, _], .. } = blocks[k];
        let (kind, a, b) = if k == 0 { (JointKind::Base, 0, End::Base) } else { (JointKind::Bed, 0, End::Block(1)) };
        Joint { kind, a, b, weight: 2.0, overlap: right - left, line: [left, level, right, level] }
    };
    let joints = (0..blocks.len()).map(joint).collect();
    (Wall { panels: vec![panel], blocks }, joints)
}

/// Bodies and hinges as results of all models list them.
fn listed(wall: &Wall, joints: &[Joint], rocking: &Rocking, duration: f64) -> shear::System {
    let n = wall.blocks.len() as u32;
    let sides = joints.iter().map(|joint| [joint.a as u32, if let End::Block(b) = joint.b { b as u32 } else { n }]);
    let restitution = rocking.compiled.restitution();
    let rigid = |joint| Contact { joint, restitution };
    let control = rocking.mechanism.control;
    let (Linkage::One { hinge } | Linkage::Two { base: hinge, .. }) = rocking.mechanism.linkage;
    let top = n - 1;
    let tops = vec![Top { name: wall.panels[0].name.clone(), unknowns: vec![top], height: control.at[1] - hinge[1] }];
    shear::System {
        blocks: wall.blocks.len(),
        mass: wall.blocks.iter().map(Block::mass).collect(),
        sides: sides.collect(),
        upright: vec![false; joints.len()],
        elastic: vec![Elastic { stiffness: 0.0, damping: 0.0, unilateral: false }; joints.len()],
        contacts: (0..joints.len() as u32).map(rigid).collect(),
        centres: wall.blocks.iter().map(Block::centre).collect(),
        tops: Tops::new(vec![top], vec![top], tops),
        settles: drift::settles(duration, false),
        ..shear::System::default()
    }
    .completed(duration)
}

/// What a user should know of the mechanism before believing the run.
fn warnings(case: &Case, found: &Found, survey: &Survey, made: &TimeHistory) -> Vec<Warning> {
    let mut told = Vec::new();
    let mut add = |kind, text: String| told.push(Warning::new(kind, text));
    let least = survey.least().filter(|least| least.multiplier() < found.multiplier() * (1.0 - 1e-9));
    if let Some(least) = least {
        let text = format!(
            "{} has a lower multiplier, α0 = {:.4} with its hinge at {:.2} m, than the mechanism that is followed, {} with {:.4}: it sets off first",
            least.kind.what(),
            least.multiplier(),
            least.hinge,
            found.kind.what(),
            found.multiplier()
        );
        add(WarningKind::Assumed, text);
    }
    if !found.counts {
        add(
            WarningKind::Assumed,
            format!("the wall as it is cannot have its {}: it is followed for comparison", found.kind.what()),
        );
    }
    for note in made.notes.iter().chain(&found.notes) {
        add(WarningKind::Assumed, note.clone());
    }
    let joint = &case.joint;
    if joint.bond.is_some() || !joint.changes.is_empty() {
        let text = "joint.bond and joint.change do nothing in a rocking wall: of [joint] it reads friction.static alone, which side walls rub with";
        add(WarningKind::IdleKey, text.into());
    }
    let springs = [("bed", Some(joint.bed)), ("head", Some(joint.head)), ("base", joint.base), ("top", joint.top)];
    let springs = springs.into_iter().chain([("connection", joint.connection)]);
    for (kind, spring) in springs.filter_map(|(kind, spring)| Some((kind, spring?))) {
        let idle = [
            ("restitution", spring.restitution.is_some(), "`rocking.restitution` is that of its impacts"),
            (
                "rocking_restitution",
                spring.rocking_restitution.is_some(),
                "`rocking.restitution` is that of its impacts",
            ),
            (
                "compressive_strength",
                spring.compressive_strength.is_some(),
                "`out_of_plane.strength` sets its hinges back",
            ),
        ];
        for (key, _, instead) in idle.into_iter().filter(|(_, given, _)| *given) {
            add(WarningKind::IdleKey, format!("joint.{kind}.{key} does nothing in a rocking wall: {instead}"));
        }
    }
    told
}
