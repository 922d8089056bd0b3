//! What a user should know of a run that has ended before believing it.

use std::f64::consts::TAU;

use crate::G;
use crate::case::plausible::rounded;
use crate::case::{Beam, JointKind};
use crate::excitation::Excitation;
use crate::graph;
use crate::model::Model;
use crate::outcome::{Deepest, Falling, Outcome};
use crate::planar::{Planar, Rest};
use crate::quantity::shown;
use crate::record::{Counters, StopReason};
use crate::rocking::{self, Rocking};
use crate::store::{JointRow, residual_relative};
use crate::warning::{Warning, WarningKind};
use concio_planar::joint::{Law, Normal};
use concio_shear::law::Rub;

/// Relative displacement of a joint, as a fraction of its overlap, from which its geometry should not be taken as
/// unchanged any more.
const LARGE_SLIP: f64 = 0.1;
/// Friction work of joints that never slip, over the largest energy in play, that could be taken for damage.
const NOTICEABLE_CREEP: f64 = 0.05;
/// Part of all steps from which those are told that ended before the wall was at rest: some that follow each load step are among them.
const MOVING: f64 = 5e-3;
/// Displacement of the top over the wall's height from which the largest base shear of a wall that tilts is one that it bore as it fell.
const FALLING: f64 = 0.1;
/// Part of the steps whose contact may be left unsolved before a result should be doubted for it.
const UNSOLVED: f64 = 1e-3;
/// Residual of the energy account over the largest work beyond which a result should not be used.
const LARGE_RESIDUAL: f64 = 1e-3;

/// Way of the vertical force on the base [m] whose work rounding and the tolerance of contact may bring or take where nothing moves.
const ROUNDING: f64 = 1e-12;

/// Base shear over what friction and bond bear up to which it is rounding.
const BEYOND: f64 = 1.001;
/// Force of a single spring over its friction from which it is told: a spring beside friction bears some as long as its joint hardly slides.
const FAR_BEYOND: f64 = 2.0;
const SPRUNG: &str = "the springs of unbonded joints go on bearing however far the joints slide. Forces and displacements are not those of masonry; use \
                      `law = \"no-tension\"` in a wall of `model = \"planar\"`, whose joints slide, or a [joint.bond], which breaks";
/// What a run without inertia is to do about a large residual: some of it no step takes away.
const STILL: &str = "lower solver.step; what lets go at once, as friction does that falls once a joint slides, needs inertia: leave \
                     motion.quasi_static out";

/// Energy that contacts gave back, over the largest work, beyond which a result should not be used.
const GIVEN_BACK: f64 = 0.01;
/// Part of what was lost that may go to joints closing or ringing faster than steps resolve, before peaks should be doubted for it.
const UNRESOLVED: f64 = 0.2;
/// How many steps go into the longest that resolves what rings where peaks are to be within a few percent, of blocks that rock and of walls that slide.
const RESOLVES: f64 = 15.0;
/// Damping over the largest energy of motion from which a wall swings on and on. A vibration of which `RESOLVES` steps make a period is 1.5 % too slow, and
/// 0.2 % with `ACCURATE` steps: near its own frequency the peak is off by several times as much.
const ON_AND_ON: f64 = 20.0;
const ACCURATE: f64 = 40.0;
/// Part of what is crushed of a joint from which it is too much for one step, and the part at which about a hundredth of it is wrong. Blocks on one joint under
/// half-sine pulses of 2 … 100 ms, 1.1 to 4 times the strength, were off by up to 1.1 times what one step took from a tenth on, where it was taken in parts by 1.6 times their
/// mean, and by up to 1.5 % at the step that is told. Below a tenth a few of 2 to 10 ms were off by 3 to 4 %: they are not told.
const ABRUPT: f64 = 0.1;
const GRADUAL: f64 = 0.02;
/// Share of friction in what is lost from which a wall slid.
const RUBBED: f64 = 0.05;
/// Factor on a motion that a rocking wall rests under, from which it is told that it lacks so much.
const FAR_TOO_WEAK: f64 = 10.0;
/// Part of the largest work that may be motion at the end before a run should be doubted for its end.
const UNDER_WAY: f64 = 0.5;
/// Slip of a joint that counts as one [m].
const SLID: f64 = 1e-6;
/// How many joints with friction that falls make slides a matter of chance: peaks of two courses of two bricks move by 2 % with the step, of three
/// by 60 %; those of example 9, of three stones, by 0.1 %.
const MANY: usize = 5;
/// Way of the wall's weight whose work is nothing [m]: what a wall at rest does.
const NOTHING: f64 = 1e-8;

/// All of a run that has ended: those of its model, known before, and those of its result. `joints` are the rows of the model.
pub fn all(model: &Model, joints: &[JointRow], outcome: &Outcome) -> Vec<Warning> {
    model.warnings.iter().cloned().chain(of(model, joints, outcome)).collect()
}

/// Those of the result, the gravest first.
fn of(model: &Model, joints: &[JointRow], outcome: &Outcome) -> Vec<Warning> {
    if let Some(rocking) = model.rocking() {
        return of_rocking(rocking, &model.excitation, outcome);
    }
    let planar = model.planar();
    let balance = match planar {
        None => unbalanced(outcome, 0.0, "lower solver.tolerance"),
        // Contacts that slip at once give back nothing here: what they set free is lost without inertia.
        Some(planar) if planar.still => unbalanced(outcome, ROUNDING * model.base_load(), STILL),
        Some(_) => unbalanced(outcome, ROUNDING * model.base_load(), "lower solver.step")
            .or_else(|| given_back(model, outcome)),
    };
    let told = [
        (WarningKind::Energy, balance),
        (WarningKind::Unsolved, unsolved(outcome)),
        (WarningKind::Moving, moving(outcome)),
        (WarningKind::PeakInFall, peak_in_fall(model, planar, outcome)),
        (WarningKind::BeyondFriction, beyond_friction(model, planar, outcome)),
        (WarningKind::CrackedAtRest, cracked_at_rest(planar, joints, outcome)),
        (WarningKind::Collapse, collapsed(model, planar, outcome)),
        (WarningKind::UnderWay, moves_on(model, planar, outcome)),
        (WarningKind::Unresolved, unresolved(model, planar, outcome)),
        (WarningKind::Unresolved, flutters(model, planar, outcome)),
        (WarningKind::Unresolved, swings_fast(model, planar, outcome)),
        (WarningKind::Unresolved, crushes_at_once(model, planar, outcome)),
        (WarningKind::Unresolved, pushed_at_once(model, planar, outcome)),
        (WarningKind::Chance, gives_way_by_chance(model, planar, outcome)),
        (WarningKind::LargeSlip, large_slips(model, outcome)),
        (WarningKind::Creep, creep(joints, outcome)),
    ];
    told.into_iter().filter_map(|(kind, text)| Some(Warning::new(kind, text?))).collect()
}

/// Those of a wall that rocks out of its plane.
fn of_rocking(wall: &Rocking, excitation: &Excitation, outcome: &Outcome) -> Vec<Warning> {
    let mut told = Vec::new();
    let mut add = |kind, text: String| told.push(Warning::new(kind, text));
    if let Some(text) = unbalanced(outcome, 0.0, "lower solver.step") {
        add(WarningKind::Energy, text);
    }
    let Some(rocking) = &outcome.rocking else { return told };
    if let Some(collapse) = outcome.totals.collapse {
        let text = format!(
            "the wall falls: it lies on the ground from t = {:.4} s on. Peaks are those of the fall",
            collapse.time
        );
        add(WarningKind::Collapse, text);
    } else if rocking.beyond_d0 > 0 {
        let text = format!(
            "the wall passed d0 {} time(s), where its weight holds no longer, and came back: the code does not count on that, nor should you",
            rocking.beyond_d0
        );
        add(WarningKind::BeyondD0, text);
    }
    if rocking.lift_offs > 0
        && matches!(outcome.stop_reason, StopReason::Completed | StopReason::Collapsed)
        && let Ok(repeated) = wall.compiled.repeat(&wall.shaking(excitation), &wall.setting(excitation))
        && let Some(text) = repeated.chance()
    {
        add(WarningKind::Chance, text);
    }
    if let Some(text) = hardly_moved(wall, excitation, outcome) {
        add(WarningKind::UnlikelyRecord, text);
    }
    let weight_moves = outcome.energies.kinetic > NOTHING * outcome.totals.peak_input;
    if outcome.stop_reason == StopReason::Completed && weight_moves {
        add(
            WarningKind::UnderWay,
            "the wall still moves when the run ends: larger turns or a fall may follow. A longer motion.duration shows it".into(),
        );
    }
    for (tie, time) in rocking.broken_ties.iter().enumerate().filter(|(_, time)| time.is_finite()) {
        add(WarningKind::BrokenTie, format!("tie {} of the mechanism broke at t = {time:.4} s", tie + 1));
    }
    for (floor, time) in rocking.lost_seats.iter().enumerate().filter(|(_, time)| time.is_finite()) {
        let text = format!(
            "floor {} of the mechanism lost its seat at t = {time:.4} s: it has fallen, whatever became of the wall",
            floor + 1
        );
        add(WarningKind::LostSeat, text);
    }
    told
}

/// Says of a wall that rests under a motion far too weak for it how much is lacking.
fn hardly_moved(wall: &Rocking, excitation: &Excitation, outcome: &Outcome) -> Option<String> {
    let found = outcome.rocking.as_ref()?;
    // Of a wall at rest it is known before.
    if outcome.stop_reason != StopReason::Completed || found.lift_offs > 0 || rocking::is_still(excitation) {
        return None;
    }
    let sets_off = shown(rounded(wall.compiled.multiplier(), 3));
    match wall.first_lift_off(excitation).ok()? {
        None => Some(format!(
            "the wall rests: nothing in the motion within the run acts in the direction that lifts it off, which takes {sets_off} g. Look at the motion's \
             start, at `rocking.positive` and motion.duration"
        )),
        Some(lift_off) if lift_off.scale > FAR_TOO_WEAK => Some(format!(
            "the wall rests: its motion within the run would have to be {} times as strong to lift it off, which takes {sets_off} g. Look at its unit, \
             `scale`, `pga` and motion.duration",
            shown(rounded(lift_off.scale, 3))
        )),
        Some(_) => None,
    }
}

/// A residual that is not a number is the stop reason's to tell; one up to `nothing` [J] is none.
fn unbalanced(outcome: &Outcome, nothing: f64, remedy: &str) -> Option<String> {
    let residual = residual_relative(outcome);
    let until = outcome.totals.collapse.and_then(|collapse| collapse.before).map(|before| before.residual);
    (residual > LARGE_RESIDUAL && outcome.totals.peak_residual > nothing).then(|| {
        if let Some(until) = until.filter(|until| *until <= LARGE_RESIDUAL) {
            return format!(
                "the energy account is off by {:.2} % of the largest work, but by {} % until the wall collapsed: what it bore until then holds, \
                 energies and the way it fell do not; end the run there, or {remedy}",
                100.0 * residual,
                shown(rounded(100.0 * until, 2))
            );
        }
        format!(
            "the energy account is off by {:.2} % of the largest work, more than 0.1 %: do not use the result, {remedy}",
            100.0 * residual
        )
    })
}

/// Impacts only take energy. Where slides turn round faster than steps resolve, friction pushes along them, and more comes back than they took.
fn given_back(model: &Model, outcome: &Outcome) -> Option<String> {
    let weight = G * model.shear.mass.iter().sum::<f64>();
    let most = outcome.totals.peak_input.max(outcome.energies.initial.abs()).max(NOTHING * weight);
    let back = -outcome.energies.impact;
    (back > GIVEN_BACK * most).then(|| {
        format!(
            "contacts gave back {:.1} % of the largest work, which nothing had put into them: do not use the result, lower \
             solver.step, or take `rigid` for joints as stiff as stones",
            100.0 * back / most
        )
    })
}

/// Steps that count: until a collapse, where that is known.
struct Counted {
    steps: u64,
    unsolved: u64,
    moving: u64,
    until: &'static str,
}

fn counted(outcome: &Outcome) -> Counted {
    let Counters { steps, unsolved, moving, .. } = outcome.counters;
    let whole = Counted { steps, unsolved, moving, until: "" };
    outcome.totals.collapse.and_then(|collapse| collapse.before).map_or(whole, |before| Counted {
        steps: before.steps,
        unsolved: before.unsolved,
        moving: before.moving,
        until: " until the wall collapsed",
    })
}

/// Says where contact was found no better than within a looser bound than asked for, in more than a few steps.
fn unsolved(outcome: &Outcome) -> Option<String> {
    let Counted { steps, unsolved, until, .. } = counted(outcome);
    (unsolved as f64 > UNSOLVED * steps as f64).then(|| {
        // Known of the whole run alone, and largest as blocks hit the ground.
        let off = match until {
            "" => format!("contact velocities are off by up to {:.1e} m/s; ", outcome.totals.contact_residual),
            _ => String::new(),
        };
        format!(
            "the contact of {unsolved} of {steps} steps{until} was left unsolved: blocks may overlap and forces may be wrong there; {off}lower solver.step"
        )
    })
}

/// Says of runs without inertia that their steps ended too soon for what swings slowly.
fn moving(outcome: &Outcome) -> Option<String> {
    let Counted { steps, moving, until, .. } = counted(outcome);
    (moving as f64 > MOVING * steps as f64).then(|| {
        format!(
            "{moving} steps{until} ended before the wall had come to rest, though it slowed down: displacements and forces lag behind their loads; a slower \
             load or lower solver.step shows by how much"
        )
    })
}

/// Says of a wall that is pushed by its own weight, without inertia, that its largest base shear came as it fell.
fn peak_in_fall(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    if !planar?.still || matches!(model.beam, Beam::Driven) {
        return None;
    }
    let height = model.wall.blocks.iter().map(|b| b.y[1]).fold(0.0, f64::max);
    let way = outcome.totals.base_shear_displacement.abs();
    (way > FALLING * height).then(|| {
        format!(
            "the largest base shear came when the top was {} mm away, {:.0} % of the height: the wall was falling, and bore less before. What it bears is \
             the base shear at which the top begins to run away, in the loop that report.html draws; a slower tilt comes nearer to it",
            rounded(1e3 * way, 3),
            100.0 * way / height
        )
    })
}

/// What springs and dashpots in no need of friction bear beyond it. Joints of planar walls that slide, and bonded ones, bear no more than they can.
fn beyond_friction(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let base = |e: &usize| model.joints[*e].kind == JointKind::Base;
    let joints: Vec<usize> = (0..model.joints.len()).filter(base).collect();
    if planar.is_some_and(|planar| joints.iter().all(|e| slides(planar, *e))) {
        return beyond_own_friction(model, planar, outcome);
    }
    if joints.iter().any(|&e| model.device_of_joint()[e].is_some()) {
        return beyond_own_friction(model, planar, outcome);
    }
    let (rubs, bonds) = (model.shear.rub_of_joint(), model.shear.bond_of_joint());
    let bears = |&e: &usize| {
        let friction = rubs[e].map_or(0.0, |r| most_friction(model, r, outcome.envelopes.joint_velocity[e]));
        let bond = bonds[e].map_or(0.0, |b| model.shear.bonds[b].law.strength);
        [friction, bond]
    };
    let [friction, bond] = joints.iter().map(bears).fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
    // What it is that the joints bear without either is for the user to know: more than the load is more than any friction.
    let bare = friction + bond == 0.0;
    let borne = if bare { model.base_load() } else { joints.iter().map(bears).map(|[f, b]| f.max(b)).sum() };
    let shear = outcome.totals.base_shear_peak;
    if !(shear > BEYOND * borne) {
        return beyond_own_friction(model, planar, outcome);
    }
    let [shear, borne] = [shear, borne].map(|force| format!("{:.2} kN", 1e-3 * force));
    let bears = match (bare, bond > 0.0) {
        (true, _) => format!("the vertical force of {borne}, of which friction can bear a part"),
        (false, false) => format!("the {borne} that friction can bear (μ_s N)"),
        (false, true) => format!("the {borne} that bond and friction can bear (c A + N tan φ, or μ_s N)"),
    };
    let sprung = |e: &usize| bonds[*e].is_none() && model.shear.elastic[*e].stiffness > 0.0;
    Some(match joints.iter().any(sprung) {
        true => format!("the largest base shear, {shear}, is above {bears}: {SPRUNG}"),
        false => format!(
            "the largest base shear, {shear}, is above {bears}: dashpots bear beside both, at any speed. See whether the result stays with \
             joint.damping_ratio = 0, or use `model = \"planar\"`, whose dry joints have none"
        ),
    })
}

/// Whether a joint of a planar wall bears along no more than its friction once it slides.
fn slides(planar: &Planar, joint: usize) -> bool {
    let law = &planar.system.links[joint].law;
    law.bond.is_some() || law.shear.series || law.shear.stiffness == 0.0
}

/// Most that friction bears in a joint that slides as fast as `speed` [m/s], in N.
fn most_friction(model: &Model, rub: usize, speed: f64) -> f64 {
    let Rub { law, normal, .. } = &model.shear.rubs[rub];
    law.static_.max(law.dynamic + law.alpha * speed * speed) * normal[0]
}

/// The spring of an unbonded bed joint that bears far more than its friction can, where the sum over the base does not show it.
fn beyond_own_friction(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let (rubs, bonds, devices) = (model.shear.rub_of_joint(), model.shear.bond_of_joint(), model.device_of_joint());
    let free = |e: &usize| !model.joints[*e].kind.is_upright() && bonds[*e].is_none() && devices[*e].is_none();
    let over = |e: usize| {
        let rub = rubs[e]?;
        let envelopes = &outcome.envelopes;
        let force = match planar {
            Some(planar) if slides(planar, e) => return None,
            Some(planar) => planar.system.links[e].law.shear.stiffness * envelopes.joint_displacement[e],
            None => envelopes.joint_force[e],
        };
        let friction = most_friction(model, rub, envelopes.joint_velocity[e]);
        (force > FAR_BEYOND * friction).then_some((force, friction, e))
    };
    let all: Vec<(f64, f64, usize)> = (0..model.joints.len()).filter(free).filter_map(over).collect();
    let (force, friction, e) = all.iter().max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))?;
    let others = if all.len() > 1 { format!(", and {} more are like it", all.len() - 1) } else { String::new() };
    Some(format!(
        "the spring of joint {} bears up to {:.2} kN, above the {:.2} kN of its friction (μ_s N){others}: {SPRUNG}",
        graph::name(&model.wall, &model.joints[*e]),
        1e-3 * force,
        1e-3 * friction,
    ))
}

/// Bonds of planar walls that are cracked before anything moves.
fn cracked_at_rest(planar: Option<&Planar>, joints: &[JointRow], outcome: &Outcome) -> Option<String> {
    let planar = planar?;
    let at_rest = || outcome.bonds.iter().filter(|bond| bond.cracked == 0.0);
    let first = at_rest().next()?;
    let rigid = at_rest().any(|bond| !planar.system.links[bond.joint].law.is_compliant());
    let remedy = if rigid {
        ": how rigid joints share forces is a convention. Compare with springs of your own (`law = \"elastic\"`)"
    } else {
        ": the wall has cracks when the motion begins"
    };
    Some(format!(
        "{} of {} bonds are cracked before anything moves, among them that of joint {}{remedy}",
        at_rest().count(),
        outcome.bonds.len(),
        joints[first.joint].name
    ))
}

/// A wall that fell is no result of the forces that it bore before.
fn collapsed(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let collapse = outcome.totals.collapse?;
    let (name, time, did) = (&model.wall.blocks.get(collapse.block)?.name, collapse.time, collapse.what());
    // Asked only of walls that fall: to settle takes a while.
    let alone = planar.is_some_and(|planar| planar.rest() == Rest::Falls);
    let alone = if alone { "the wall does not stand under its own loads, whatever the motion: " } else { "" };
    let what = "peaks and slips are those of the time before, cracks and energies those of the whole run; with another step \
                time and block may differ";
    Some(format!("{alone}the wall counts as collapsed from t = {time:.4} s on, when block {name} {did}: {what}"))
}

/// What becomes of a wall that has yet to come to rest or to fall is not seen.
fn moves_on(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let planar = planar.filter(|_| outcome.totals.collapse.is_none())?;
    if planar.still {
        return falls_on(model, outcome);
    }
    let weight = G * model.shear.mass.iter().sum::<f64>();
    let (kinetic, work) = (outcome.energies.kinetic, outcome.totals.peak_input.max(outcome.energies.initial.abs()));
    (kinetic > UNDER_WAY * work && kinetic > NOTHING * weight).then(|| {
        format!(
            "the wall is still moving when the run ends: {:.0} % of the largest work is kinetic energy. A longer motion.duration shows whether \
             it comes to rest or falls",
            100.0 * kinetic / work
        )
    })
}

/// Without inertia nothing has kinetic energy: what has no rest under its loads goes on from step to step.
fn falls_on(model: &Model, outcome: &Outcome) -> Option<String> {
    let Falling { since, block, way } = outcome.falling.filter(|falling| falling.way > NOTHING)?;
    Some(format!(
        "the wall is still falling when the run ends: it has not come to rest since t = {since:.4} s, and block {} went by {} mm in the last step. It bore its load \
         up to that time; a longer motion.duration shows where it ends",
        model.wall.blocks[block].name,
        shown(rounded(1e3 * way, 3)),
    ))
}

/// Springs keep what they take: where all joints have some, what impacts take is what steps leave out.
fn unresolved(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let planar = planar.filter(|planar| !planar.still && outcome.totals.collapse.is_none())?;
    let mut joints = planar.system.links.iter().zip(&planar.open);
    if !joints.all(|(link, open)| *open || link.law.is_compliant()) {
        return None;
    }
    let (lost, impact) = (outcome.energies.dissipated(), outcome.energies.impact);
    let weight = G * model.shear.mass.iter().sum::<f64>();
    let wanted = planar.resolving_step(false) / RESOLVES;
    let what = if planar.step > wanted {
        format!(
            "peaks come out too small, those of blocks that rock by a tenth and more. A solver.step of {} ms leaves a few percent. \
             Rigid joints are nearer to that, and a damping_ratio makes it matter less",
            cut(1e3 * wanted)
        )
    } else {
        "see whether peaks stay at half of solver.step".into()
    };
    (impact > UNRESOLVED * lost && impact > NOTHING * weight).then(|| {
        format!(
            "{:.0} % of the energy lost went to joints that close or ring faster than a step resolves: {what}",
            100.0 * impact / lost
        )
    })
}

/// Blocks that slide on springs ring as they slide, and so do those whose bonds have cracked; a step that does not resolve this changes how far
/// (`docs/planar.md`).
fn flutters(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let planar = planar.filter(|planar| !planar.still)?;
    let weight = G * model.shear.mass.iter().sum::<f64>();
    let cracked = outcome.energies.bond > NOTHING * weight;
    let rings = |law: &Law| {
        let presses = matches!(law.normal, Normal::Springs { both: 0.0, press, .. } if press > 0.0);
        presses && law.shear.series && law.shear.stiffness > 0.0
    };
    // A block that slides on the base alone rings too, but goes as far; when its bond gives way depends on how it rings.
    let laws = planar.system.links.iter().filter(|link| link.a.is_some() || link.law.bond.is_some());
    let mut laws = laws.map(|link| if cracked { link.law.cracked() } else { link.law });
    let rubs = laws.any(|law| rings(&law) && law.friction.is_some_and(|friction| friction.static_ > 0.0));
    let wanted = planar.resolving_step(cracked) / RESOLVES;
    let (lost, friction) = (outcome.energies.dissipated(), outcome.energies.friction);
    let slid = friction > RUBBED * lost && friction > NOTHING * weight;
    (rubs && slid && planar.step > wanted).then(|| {
        format!(
            "blocks slid on springs that ring faster than a solver.step of {} ms resolves: peaks change with the step then, those of a dry wall with \
             μ = 0.6 by half and more. Compare with a step of {} ms, and with rigid joints, before you rely on peaks",
            shown(rounded(1e3 * planar.step, 3)),
            cut(1e3 * wanted)
        )
    })
}

/// Says where the way of a wall is itself a vibration that steps hardly resolve, by its largest velocity over its largest way; one that rings once and
/// is still again has its peaks all the same.
fn swings_fast(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let planar = planar.filter(|planar| !planar.still && outcome.totals.collapse.is_none())?;
    let envelopes = &outcome.envelopes;
    let ways = envelopes.block_displacement.iter().zip(&envelopes.block_velocity);
    let (way, speed) = ways.max_by(|a, b| a.0.total_cmp(b.0))?;
    let mass = model.shear.mass.iter().sum::<f64>();
    let (damping, period) = (outcome.energies.damping, TAU * way / speed);
    let swings = damping > ON_AND_ON * 0.5 * mass * speed * speed && damping > NOTHING * G * mass;
    // Rounding has a period too.
    (swings && *way > NOTHING && period < RESOLVES * planar.step).then(|| {
        format!(
            "the wall swings with a period of about {} ms, of {:.1} steps: the vibration comes out {:.1} % too slow, and peaks near its own frequency \
             are off by several times as much. With a solver.step of {} ms they are off by about 1 %",
            shown(rounded(1e3 * period, 3)),
            period / planar.step,
            100.0 * (TAU * planar.step / period).powi(2) / 12.0,
            cut(1e3 * period / ACCURATE)
        )
    })
}

/// A joint that a pulse crushes: how its spring swings until then, and when the pulse passes its strength, decide how far. What is less than springs
/// are pressed in by is none.
fn crushes_at_once(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let planar = planar.filter(|_| outcome.totals.collapse.is_none())?;
    let Deepest { joint, depth, at_once } = outcome.deepest?;
    let law = planar.system.links[joint].law.cracked();
    let part = at_once / depth;
    (part > ABRUPT && depth * law.normal_stiffness() > law.crushing).then(|| {
        format!(
            "joint {} was crushed by {} mm, {:.0} % of that within one step: the depth may be off by about as much. A solver.step of {} ms leaves \
             about 1 %{}",
            graph::name(&model.wall, &model.joints[joint]),
            shown(rounded(1e3 * depth, 3)),
            100.0 * part,
            cut(1e3 * planar.step * GRADUAL / part),
            if planar.forces.is_empty() { "" } else { ", with values of `[[force]]` as close" },
        )
    })
}

/// Bonded rigid joints that a beam loads from nothing to their strength within its first step bear all that they can at once; pushed slowly one breaks before the others bear
/// so much.
fn pushed_at_once(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let planar = planar.filter(|planar| planar.still && matches!(model.beam, Beam::Driven))?;
    let rigid = |joint: usize| !planar.system.links[joint].law.is_compliant();
    let first = |time: f64| time > 0.0 && time <= planar.step * (1.0 + NOTHING);
    let at_once = outcome.bonds.iter().filter(|bond| rigid(bond.joint) && first(bond.cracked)).count();
    (at_once > 1 && 10 * at_once > outcome.bonds.len()).then(|| {
        format!(
            "{at_once} of {} bonds crack in the first step of the push: rigid joints bear all that they can at once then, and the largest force may be twice what they bear \
             one after the other. Push more slowly, or give the joints springs (`law = \"elastic\"`)",
            outcome.bonds.len()
        )
    })
}

/// Where many joints have friction that falls at once as they begin to slide, little decides which of them does first (`docs/planar.md`).
fn gives_way_by_chance(model: &Model, planar: Option<&Planar>, outcome: &Outcome) -> Option<String> {
    let weight = G * model.shear.mass.iter().sum::<f64>();
    let slid = |joint: usize| outcome.envelopes.joint_slip[joint] > SLID;
    // Coefficients at rest and in slip.
    let (falls, key, other): (Vec<[f64; 2]>, _, _) = match planar {
        Some(planar) if planar.still => return None,
        Some(planar) => {
            let links = planar.system.links.iter().enumerate().filter(|(joint, _)| slid(*joint));
            let falling = links.filter_map(|(_, link)| link.law.friction.filter(|f| f.slowly(true) < f.static_));
            let step = format!("a step of {} ms", shown(rounded(0.5e3 * planar.step, 3)));
            (falling.map(|f| [f.static_, f.dynamic]).collect(), "solver.step", step)
        }
        None => {
            let rubs = model.shear.rubs.iter().filter(|rub| rub.law.drops() && slid(rub.joint as usize));
            let falling = rubs.map(|rub| [rub.law.static_, rub.law.dynamic]);
            (falling.collect(), "solver.tolerance", "a tenth of it".into())
        }
    };
    let [at_rest, in_slip] = *falls.first().filter(|_| outcome.energies.friction > NOTHING * weight)?;
    (falls.len() >= MANY).then(|| {
        format!(
            "friction falls at once, from {} to {}, where joints begin to slide: which of them does first is a matter of chance, and peaks change with \
             {key}, by a tenth and more. Compare with {other} before you rely on them",
            shown(rounded(at_rest, 3)),
            shown(rounded(in_slip, 3)),
        )
    })
}

/// The shear model keeps its joints as they were laid: says where that ceases to be a fair picture.
fn large_slips(model: &Model, outcome: &Outcome) -> Option<String> {
    if outcome.layout.touching > 0 {
        return None;
    }
    let ratio = |e: usize| outcome.envelopes.joint_displacement[e] / model.joints[e].overlap;
    let bed = |e: &usize| matches!(model.joints[*e].kind, JointKind::Bed);
    let worst = (0..model.joints.len()).filter(bed).max_by(|&a, &b| ratio(a).total_cmp(&ratio(b)))?;
    (ratio(worst) > LARGE_SLIP).then(|| {
        format!(
            "joint {} slid by {:.0} % of its overlap: overlaps and loads are kept as laid, so do not trust the result \
             beyond this",
            graph::name(&model.wall, &model.joints[worst]),
            100.0 * ratio(worst)
        )
    })
}

/// Whether friction did work although no joint with friction ever passed its slip velocity: creep of the regularised law. Laws that stick truly
/// do not creep.
pub fn only_creeps(joints: &[JointRow], outcome: &Outcome) -> bool {
    let laws = || joints.iter().zip(&outcome.envelopes.joint_velocity).filter_map(|(j, v)| j.friction.map(|f| (f, *v)));
    outcome.energies.friction > 0.0
        && laws().any(|(law, _)| law.creeps_below() > 0.0)
        && laws().all(|(law, velocity)| velocity <= law.creeps_below())
}

/// Says that friction work is no sign of damage, where there is enough of it to be taken for one.
fn creep(joints: &[JointRow], outcome: &Outcome) -> Option<String> {
    let most = outcome.totals.peak_input.max(outcome.energies.initial.abs());
    let friction = outcome.energies.friction;
    (friction > NOTICEABLE_CREEP * most && only_creeps(joints, outcome)).then(|| {
        format!(
            "no joint slipped: the friction work, {:.0} % of the largest work, is creep of the regularised law",
            100.0 * friction / most
        )
    })
}

/// Two significant digits, not more than `v` is: a step of as much has to resolve what a step of `v` does.
fn cut(v: f64) -> f64 {
    let unit = 10f64.powf(v.log10().floor() - 1.0);
    rounded((v / unit * (1.0 + 1e-12)).floor() * unit, 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Scheme, Solver};
    use crate::excitation::Excitation;
    use crate::ground::signal::GroundMotion;
    use crate::outcome::{Before, Collapse, Totals};
    use crate::run::{Prepared, prepare_case, run_in_memory};
    use crate::samples::{Link, lumped, solver};
    use crate::simulate::{Sampling, Simulation};
    use crate::wall::End;

    /// A mass that swings on a spring, solved with far too loose a tolerance and with a fair one.
    #[test]
    fn an_account_that_does_not_close_is_warned_of() {
        let model =
            lumped(&[10.0], &[Link::spring(0, End::Base, 1e5, 0.0)], Excitation::of_base(GroundMotion::AtRest, 2.0));
        let warned = |solver: Solver| {
            let sampling = Sampling { interval: 2.0, frame_every: 0, blocks: Vec::new(), joints: Vec::new() };
            let mut run = Simulation::new(&model, &solver, &sampling).unwrap();
            run.start_from(&[0.0], &[1.0]);
            let (rows, reason) = run.run_to_end();
            let outcome = run.outcome(rows, reason);
            let rows = crate::run::joint_rows(&model);
            (residual_relative(&outcome), of(&model, &rows, &outcome))
        };
        let (residual, mut told) = warned(solver(Scheme::TrBdf2, 0.5));
        // A mass that weighs less than its spring bears, without friction or bond.
        told.retain(|warning| warning.kind != WarningKind::BeyondFriction);
        assert!(residual > LARGE_RESIDUAL && told.len() == 1, "{residual}: {told:?}");
        assert!(told[0].contains(&format!("{:.2} % of the largest work", 100.0 * residual)), "{told:?}");
        let (residual, mut told) = warned(solver(Scheme::TrBdf2, 1e-5));
        told.retain(|warning| warning.kind != WarningKind::BeyondFriction);
        assert!(residual < LARGE_RESIDUAL && told.is_empty(), "{residual}: {told:?}");
    }

    /// A block that is pushed off its springs without inertia, by steps too long for it and by others.
    #[test]
    fn a_run_without_inertia_is_warned_of_like_all_others() {
        let told = |step: &str| {
            let text = format!(
                r#"
model = "planar"
[[panel]]
bond = "running"
courses = 1
bricks = 1
brick = {{ length = 0.2, height = 0.15, thickness = 0.2, specific_weight = 26e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "no-tension", stiffness = "10.8 N/mm3", rigidity = 1 }}
head = {{ law = "no-tension", stiffness = "26 N/mm3", rigidity = 1 }}
friction = {{ law = "coulomb", static = 0.62, dynamic = 0.62, on = "all" }}
[load]
top = "100 kN/m"
beam = "driven"
beam_height = "250 mm"
[motion]
top = {{ path = {{ displacements = ["2 mm"], speed = "1 mm/s" }} }}
duration = "2 s"
quasi_static = true
[solver]
step = "{step}"
"#
            );
            let (prepared, outcome) = ran(&text);
            let told = of(&prepared.model, &crate::run::joint_rows(&prepared.model), &outcome);
            (residual_relative(&outcome), told)
        };
        let (residual, told_of) = told("100 ms");
        assert!(residual > LARGE_RESIDUAL && told_of.len() == 1, "{residual}: {told_of:?}");
        let says = format!("{:.2} % of the largest work, more than 0.1 %: do not use the result", 100.0 * residual);
        assert!(told_of[0].contains(&says) && told_of[0].contains("quasi_static"), "{told_of:?}");
        let (residual, told_of) = told("10 ms");
        assert!(residual < LARGE_RESIDUAL && told_of.is_empty(), "{residual}: {told_of:?}");
    }

    /// A rigid block that a beam tips over its toe, slowly: the beam brings what the weights take, and their net is rounding. The push is
    /// (W + Q) b/(2 h) at first, h at half of the beam, and falls as the block tips; what would leak of the beam's work is told.
    #[test]
    fn works_that_cancel_are_no_leak() {
        let (prepared, mut outcome) = ran(r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = 0.6, height = 1.2, thickness = 0.3, specific_weight = 20e3 }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.9, dynamic = 0.9, on = "all" }
[[joint.change]]
at = { kind = ["top"] }
spring = { law = "rigid" }
bond = { cohesion = "1000 MPa", tensile_strength = "1000 MPa", friction_angle = 0, mode_1_energy = 0, mode_2_energy = 0 }
[load]
top = { force = 40e3 }
beam = "driven"
beam_height = "0.1 m"
beam_rotation = "free"
[motion]
quasi_static = true
duration = "8 s"
top = { path = { displacements = ["2 mm"], speed = "0.25 mm/s" } }
"#);
        let push = (0.6 * 1.2 * 0.3 * 20e3 + 40e3) * 0.6 / (2.0 * 1.25);
        let found = outcome.totals.base_shear_peak;
        assert!((found / push - 1.0).abs() < 1e-4, "{found} N for {push} N");
        // Until 2 mm the push falls by a hundredth.
        let (work, net) = (outcome.energies.input_top, outcome.energies.input());
        assert!((work / (push * 2e-3) - 1.0).abs() < 0.01 && net.abs() < 1e-6 * work, "{work} J, net {net} J");
        let told = |outcome: &Outcome| {
            let all = of(&prepared.model, &crate::run::joint_rows(&prepared.model), outcome);
            all.iter().any(|warning| warning.kind == WarningKind::Energy)
        };
        assert!(!told(&outcome) && residual_relative(&outcome) < 1e-6, "{}", residual_relative(&outcome));
        outcome.totals.peak_residual = 3e-3 * work;
        assert!(told(&outcome), "{}", residual_relative(&outcome));
        // Where nothing moves there is rounding alone.
        (outcome.totals.peak_residual, outcome.totals.peak_work) = (1e-9, 1e-9);
        assert!(!told(&outcome));
        (outcome.totals.peak_residual, outcome.totals.peak_work) = (1e-6, 1e-6);
        assert!(told(&outcome));
    }

    /// A largest base shear with the top 0.62 m away, two fifths of the height, is that of a fall; one with the top in its place is not.
    #[test]
    fn a_base_shear_of_a_fall_is_told() {
        let (prepared, mut outcome) = ran(r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = 0.6, height = 1.5, thickness = 0.2, specific_weight = 20e3 }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "elastic", stiffness = "10 N/mm3" }
head = { law = "none" }
friction = { law = "coulomb", static = 3, dynamic = 3 }
bond = { tensile_strength = "80 kPa", cohesion = "2 MPa", friction_angle = "30 deg" }
[motion]
base = { tilt = { acceleration = "0.4 g", rise = "10 s" } }
duration = "10 s"
stop_at = "collapse"
quasi_static = true
[solver]
step = "2 ms"
"#);
        assert!((outcome.totals.base_shear_peak / 3600.0 - 0.4).abs() < 1e-3, "{}", outcome.totals.base_shear_peak);
        let mut told = |way: f64| {
            outcome.totals.base_shear_displacement = way;
            let all = of(&prepared.model, &crate::run::joint_rows(&prepared.model), &outcome);
            all.iter().any(|warning| warning.kind == WarningKind::PeakInFall)
        };
        assert!(!told(-13e-6) && !told(-0.14) && told(-0.62));
    }

    /// What a planar run leaves unsolved and a wall that fell are told, and slips that its joints follow are not.
    #[test]
    fn planar_runs_are_doubted_for_what_they_can_get_wrong() {
        let links = [Link::spring(0, End::Base, 1e5, 0.0), Link::spring(0, End::Block(1), 1e5, 0.0)];
        let model = lumped(&[10.0, 10.0], &links, Excitation::of_base(GroundMotion::AtRest, 0.1));
        let sampling = Sampling { interval: 0.1, frame_every: 0, blocks: Vec::new(), joints: Vec::new() };
        let mut run = Simulation::new(&model, &solver(Scheme::TrBdf2, 1e-5), &sampling).unwrap();
        let (rows, reason) = run.run_to_end();
        let mut outcome = run.outcome(rows, reason);
        let joints = crate::run::joint_rows(&model);
        outcome.envelopes.joint_displacement.fill(1e3);
        assert!(of(&model, &joints, &outcome)[0].contains("of its overlap"), "{:?}", of(&model, &joints, &outcome));
        outcome.layout.touching = joints.len();
        (outcome.counters.steps, outcome.counters.unsolved) = (10_000, 10);
        assert!(of(&model, &joints, &outcome).is_empty(), "{:?}", of(&model, &joints, &outcome));
        // Impacts may give back a hundredth of the largest work.
        outcome.totals.peak_input = 100.0;
        for (impact, told) in [(5.0, false), (-0.9, false), (-1.1, true)] {
            outcome.energies.impact = impact;
            assert_eq!(given_back(&model, &outcome).is_some_and(|t| t.contains("1.1 %")), told, "{impact} J");
        }
        outcome.energies.impact = 0.0;
        outcome.energies.kinetic = 90.0;
        assert_eq!(moves_on(&model, None, &outcome), None, "the shear model does not fall");
        outcome.energies.kinetic = 0.0;
        outcome.counters.unsolved = 11;
        outcome.totals.collapse = Some(Collapse { time: 0.25, block: 1, way: 0.1, turned: true, before: None });
        let told = of(&model, &joints, &outcome);
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(
            told[0].contains("11 of 10000 steps")
                && told[0].contains("contact velocities are off by up to")
                && told[1].contains("t = 0.2500 s on, when block m2 turned by 45°"),
            "{told:?}"
        );
        // What went wrong as the wall lay down is no doubt about what it bore before.
        let lay = |before: Before| {
            let collapse = outcome.totals.collapse.map(|collapse| Collapse { before: Some(before), ..collapse });
            let mut outcome = Outcome { totals: Totals { collapse, ..outcome.totals }, ..outcome.clone() };
            (outcome.totals.peak_residual, outcome.counters.moving) = (1.0, 60);
            of(&model, &joints, &outcome).into_iter().map(|told| told.text).collect::<Vec<_>>()
        };
        let before = Before { residual: 1e-5, steps: 8_000, unsolved: 8, moving: 40 };
        let told = lay(before);
        assert!(
            told.len() == 2
                && told[0].starts_with("the energy account is off by 1.00 % of the largest work, but by 0.001 % until the wall collapsed: what it bore until then holds")
                && told[0].contains("; end the run there, or lower solver."),
            "{told:?}"
        );
        assert!(lay(Before { residual: 2e-3, ..before })[0].contains("do not use the result"));
        let late = &lay(Before { unsolved: 9, ..before })[1];
        assert!(late.contains("9 of 8000 steps until the wall collapsed") && !late.contains("velocities"), "{late}");
        assert!(lay(Before { moving: 41, ..before })[1].starts_with("41 steps"));
    }

    #[test]
    fn steps_are_told_in_digits_that_do_not_round_them_up() {
        for (v, told) in
            [(0.438, 0.43), (0.4402, 0.44), (2.18, 2.1), (0.0999, 0.099), (0.43, 0.43), (35.9, 35.0), (1.0, 1.0)]
        {
            assert_eq!(cut(v), told);
        }
    }

    fn ran(text: &str) -> (Prepared, Outcome) {
        let file = crate::case::from_str(text, crate::case::Syntax::Toml, None).unwrap();
        let prepared = prepare_case(file.case, std::path::Path::new(".")).unwrap();
        let outcome = run_in_memory(&prepared).unwrap();
        (prepared, outcome)
    }

    /// Two columns on bonded bases whose bed joints are bare springs, and two of which one alone is bonded: the sum over the base hides what
    /// single springs bear beyond μ_s N.
    #[test]
    fn a_spring_beyond_its_own_friction_is_told_where_the_base_does_not_show_it() {
        let wall = |bonds: &str| {
            format!(
                r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 2
bricks = 1
brick = {{ length = 0.8, height = 0.2, thickness = 1.0, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "elastic", stiffness = "10 N/mm3" }}
head = {{ law = "no-tension", stiffness = "10 N/mm3" }}
friction = {{ law = "coulomb", static = 0.5 }}
{bonds}
[motion]
duration = 0.5
base = {{ sine = {{ acceleration = 20, frequency = 2 }} }}
"#
            )
        };
        let told = |bonds: &str| {
            let (prepared, outcome) = ran(&wall(bonds));
            beyond_friction(&prepared.model, prepared.model.planar(), &outcome)
        };
        let bonded = "bond = { tensile_strength = \"1 MPa\", cohesion = \"1 MPa\", on = [\"base\"] }";
        let beds = told(bonded).expect("a warning");
        // The upper stone: 3.2 kN, of which μ_s = 0.5 bears half.
        assert!(
            beds.starts_with("the spring of joint p1c1b1|p1c2b1 bears up to")
                && beds.contains("the 1.60 kN of its friction"),
            "{beds}"
        );
        assert!(told("").expect("a warning").starts_with("the largest base shear"));
        assert_eq!(told(&bonded.replace("on = [\"base\"]", "on = [\"base\", \"bed\"]")), None);
        // Without springs dashpots bear what is beyond friction.
        let dashpots = "[[joint.change]]\nat = { kind = [\"bed\", \"base\"] }\nspring = { stiffness_factor = 0 }";
        assert!(told(dashpots).expect("a warning").contains("dashpots bear beside both"));
    }

    /// A slender stone that turns over is told of while it does, and no more when it has come to lie; one that stands is not.
    #[test]
    fn a_run_that_ends_while_the_wall_falls_says_so() {
        let told = |acceleration: f64, duration: f64| {
            let text = format!(
                r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.2, height = 1.0, thickness = 0.5, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.8, dynamic = 0.8 }}
[motion]
duration = {duration}
base = {{ tilt = {{ acceleration = {acceleration}, rise = 0.01 }} }}
"#
            );
            let (prepared, outcome) = ran(&text);
            moves_on(&prepared.model, prepared.model.planar(), &outcome)
        };
        // It turns over from 0.2 g on.
        assert_eq!(told(0.19 * G, 0.4), None);
        assert!(told(0.3 * G, 0.4).is_some_and(|what| what.contains("run ends: 9") || what.contains("run ends: 100")));
        assert_eq!(told(0.3 * G, 2.5), None);
    }

    /// The same without inertia, which has no kinetic energy: a stone that leans further and further is told of while it does, and no more when it leans on the next one;
    /// one that stands is not.
    #[test]
    fn a_run_without_inertia_that_ends_while_the_wall_falls_says_so() {
        let text = |length: f64, duration: f64| {
            format!(
                r#"
model = "planar"
[[panel]]
bond = "explicit"
brick = {{ length = 1.0, height = 0.5, thickness = 0.5, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[[panel.block]]
id = "a"
course = 1
x = 0
y = 0
length = {length}
height = 2.0
[[panel.block]]
id = "b"
course = 1
x = 0.7
y = 0
length = 2.0
height = 1.0
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }}
[motion]
duration = {duration}
base = {{ tilt = {{ acceleration = "-0.25 g", rise = 5 }} }}
quasi_static = true
"#
            )
        };
        let told = |length: f64, duration: f64| of_kind(&text(length, duration), WarningKind::UnderWay);
        // 0.4 m over 2 m turns over from 0.2 g on, 4 s after the start where 0.25 g come in 5 s.
        assert_eq!(told(0.4, 3.99), None);
        let what = told(0.4, 6.0).expect("it falls");
        assert!(what.contains("since t = 4.0") && what.contains("block a went by"), "{what}");
        assert_eq!(told(0.4, 12.0), None);
        assert_eq!(told(0.6, 6.0), None);
    }

    /// A stone that rings on its joint after a jerk, told of by steps that do not resolve it and not by those that do, nor where a dashpot takes
    /// it, nor of springs in both directions.
    #[test]
    fn a_step_that_does_not_resolve_joints_is_told_with_one_that_does() {
        let told = |spring: &str, damping: f64, step: f64| {
            let text = format!(
                r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.5, height = 0.2, thickness = 0.5, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
damping_ratio = {damping}
bed = {{ law = "{spring}", stiffness = "10 N/mm3", normal_to_shear = 1, rigidity = 1 }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.8, dynamic = 0.8 }}
[motion]
duration = "0.1 s"
base = {{ pulse = {{ shape = "rectangular", acceleration = "0.2 g", duration = "20 ms" }} }}
[solver]
step = {step}
"#
            );
            let (prepared, outcome) = ran(&text);
            (
                prepared.model.planar().unwrap().resolving_step(false),
                unresolved(&prepared.model, prepared.model.planar(), &outcome),
            )
        };
        // √(k/m) of 10 N/mm³ below 20 kN/m³ × 0.2 m.
        let resolving = 2.18 / (10e9 * G / 4e3_f64).sqrt();
        let (found, what) = told("no-tension", 0.0, 2.0 * resolving);
        assert!((found / resolving - 1.0).abs() < 1e-12, "{found} instead of {resolving}");
        let what = what.expect("it rings");
        assert!(what.starts_with("100 % of") && what.contains("A solver.step of 0.029 ms"), "{what}");
        let (_, what) = told("no-tension", 0.0, 0.9 * resolving);
        assert!(what.is_some_and(|what| what.contains("A solver.step of 0.029 ms")));
        // What is resolved rings on and loses nothing.
        assert_eq!(told("no-tension", 0.0, 0.06 * resolving).1, None);
        assert_eq!(told("no-tension", 0.4, 0.2 * resolving).1, None);
        assert_eq!(told("elastic", 0.0, 2.0 * resolving), (f64::INFINITY, None));
    }

    /// A stone on springs shaken near its own frequency, told of by steps that hardly resolve it: at 0.8 of it 11 steps were off by 14.5 %. One that rings after a
    /// pulse, or is shaken slowly, is not.
    #[test]
    fn a_wall_that_swings_faster_than_steps_resolve_is_told() {
        let shaken = |base: &str, step: f64| {
            let text = format!(
                r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 1, height = 0.05, thickness = 0.4, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
damping_ratio = 0.05
bed = {{ law = "elastic", stiffness = "0.05 N/mm3" }}
head = {{ law = "none" }}
friction = {{ law = "none" }}
[motion]
duration = "3 s"
base = {{ {base} }}
[solver]
step = {step}
"#
            );
            ran(&text)
        };
        let told = |base: &str, step: f64| {
            let (prepared, outcome) = shaken(base, step);
            swings_fast(&prepared.model, prepared.model.planar(), &outcome)
        };
        let sine = |f: f64| format!(r#"sine = {{ acceleration = "0.1 g", frequency = {f}, ramp = "0.5 s" }}"#);
        let what = told(&sine(90.0), 1e-3).expect("it swings fast");
        assert!(what.contains("of 10.8 steps") && what.contains("With a solver.step of 0.27 ms"), "{what}");
        assert_eq!(told(&sine(90.0), 5e-4), None);
        assert_eq!(told(&sine(10.0), 1e-3), None);
        let pulse = r#"pulse = { shape = "rectangular", acceleration = "0.2 g", duration = "20 ms" }"#;
        assert_eq!(told(pulse, 1e-3), None);
        // What moves up and down alone has a way of rounding to the side.
        let (prepared, mut outcome) = shaken(&sine(90.0), 1e-3);
        outcome.envelopes.block_displacement.iter_mut().for_each(|way| *way *= 1e-9);
        assert_eq!(swings_fast(&prepared.model, prepared.model.planar(), &outcome), None);
    }

    /// Stones that slide on springs are told of, with the step that resolves them; on rigid joints, where nothing slides, and one stone alone are not.
    #[test]
    fn a_wall_that_slides_on_springs_is_told_how_short_steps_have_to_be() {
        let told = |courses: usize, joint: &str, acceleration: f64| {
            let text = format!(
                r#"
model = "planar"
[[panel]]
bond = "running"
courses = {courses}
bricks = 2
brick = {{ length = 0.4, height = 0.2, thickness = 0.3, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
damping_ratio = 0.05
bed = {joint}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.5 }}
[motion]
duration = "0.3 s"
base = {{ pulse = {{ shape = "rectangular", acceleration = {acceleration}, duration = "0.1 s" }} }}
"#
            );
            let (prepared, outcome) = ran(&text);
            flutters(&prepared.model, prepared.model.planar(), &outcome)
        };
        let springs = r#"{ law = "no-tension", stiffness = "10 N/mm3", rigidity = 1, normal_to_shear = 1 }"#;
        let what = told(2, springs, 0.8 * G).expect("they slide");
        assert!(what.contains("solver.step of 1 ms") && what.contains("μ = 0.6"), "{what}");
        assert_eq!(told(2, springs, 0.1 * G), None);
        assert_eq!(told(1, springs, 0.8 * G), None);
        assert_eq!(told(2, r#"{ law = "rigid" }"#, 0.8 * G), None);
        // Bonds that crack leave such springs, those that hold do not: 1 kPa and 1 MPa where a course weighs 4 kPa.
        let bonded = |courses: usize, strength: &str| {
            let bed = springs.replace("no-tension", "elastic");
            let bond = format!(
                "bond = {{ cohesion = \"{strength}\", tensile_strength = \"{strength}\", friction_angle = \"30 deg\" }}"
            );
            told(courses, &format!("{bed}\n{bond}"), 0.8 * G)
        };
        for courses in [1, 2] {
            let what = bonded(courses, "1 kPa").expect("they crack and slide");
            assert!(what.contains("solver.step of 1 ms") && what.contains("Compare with a step of"), "{what}");
            assert_eq!(bonded(courses, "1 MPa"), None);
        }
    }

    /// Friction that falls at once makes a wall's slides a matter of chance, but not those of a few stones; a constant one does not.
    #[test]
    fn slides_whose_friction_falls_at_once_are_told() {
        let told = |courses: usize, friction: &str| {
            let text = format!(
                r#"
model = "planar"
[[panel]]
bond = "running"
courses = {courses}
bricks = 2
brick = {{ length = 0.4, height = 0.1, thickness = 0.3, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", {friction} }}
[motion]
duration = "0.5 s"
base = {{ sine = {{ acceleration = "0.7 g", frequency = "3 Hz" }} }}
"#
            );
            let (prepared, outcome) = ran(&text);
            gives_way_by_chance(&prepared.model, prepared.model.planar(), &outcome)
        };
        let what = told(3, "static = 0.5, dynamic = 0.35").expect("they slide");
        assert!(what.contains("from 0.5 to 0.35") && what.contains("a step of 0.5 ms"), "{what}");
        assert_eq!(told(1, "static = 0.5, dynamic = 0.35"), None);
        assert_eq!(told(3, "static = 0.5, dynamic = 0.5"), None);
        assert_eq!(told(3, "static = 1.5, dynamic = 1"), None);
        // In the shear model all courses reach their friction at once.
        let shear = |dynamic: f64| {
            let text = include_str!("../../../../examples/10-true-stick.toml");
            let (prepared, outcome) = ran(&text.replace("dynamic = 0.42", &format!("dynamic = {dynamic}")));
            gives_way_by_chance(&prepared.model, None, &outcome)
        };
        let what = shear(0.42).expect("they slide");
        assert!(what.contains("from 0.6 to 0.42") && what.contains("solver.tolerance"), "{what}");
        assert_eq!(shear(0.6), None);
    }

    fn of_kind(text: &str, kind: WarningKind) -> Option<String> {
        let (prepared, outcome) = ran(text);
        let joints = crate::run::joint_rows(&prepared.model);
        all(&prepared.model, &joints, &outcome).into_iter().find(|w| w.kind == kind).map(|w| w.text)
    }

    /// A block of 5 kN under 10 kN between base and driven beam, whose springs of 2 MN/m in series bear 1 MN/m × 8 mm.
    #[test]
    fn a_base_shear_beyond_friction_and_bond_is_told_with_both() {
        let text = |model: &str, bed: &str, rest: &str| {
            format!(
                r#"
model = "{model}"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.5, height = 0.2, thickness = 0.5, specific_weight = 100e3 }}
[joint]
bed = {{ {bed} }}
head = {{ law = "none" }}
{rest}
[load]
top = 20e3
beam = "driven"
[motion]
duration = "2 s"
top = {{ ramp = {{ amplitude = "8 mm", rise = "1 s" }} }}
"#
            )
        };
        let springs = r#"law = "elastic", stiffness = "1 MN/m""#;
        let friction = r#"friction = { law = "coulomb", static = 0.4, dynamic = 0.4 }"#;
        let told = |model: &str, bed: &str, rest: &str| of_kind(&text(model, bed, rest), WarningKind::BeyondFriction);
        // 0.4 × 15 kN at the base; friction bears beside the springs: 2 MN/m × u = 2 MN/m × (8 mm − u) + 4 kN − 6 kN.
        let what = told("shear", springs, friction).expect("beyond friction");
        assert!(
            what.contains("13.0") && what.contains("kN, is above the 6.00 kN that friction can bear (μ_s N)"),
            "{what}"
        );
        // Bonds of 0.25 m² give way at their strength, c A + N tan 30° = 2.5 kN + 8.66 kN at the base, and rub with μ N then.
        let bond = r#"bond = { cohesion = "10 kPa", friction_angle = "30 deg" }"#;
        assert_eq!(told("shear", springs, &format!("{friction}\n{bond}")), None);
        assert_eq!(told("shear", r#"law = "none""#, friction), None);
        // Without either nothing is known, but that springs that bear more than all that presses are not masonry: 8 kN over 6 kN.
        assert_eq!(told("shear", springs, ""), None);
        let bare = of_kind(&text("shear", springs, "").replace("top = 20e3", "top = 2e3"), WarningKind::BeyondFriction);
        assert!(bare.as_ref().is_some_and(|what| what.contains("vertical force of 6.00 kN")), "{bare:?}");
        let planar = told("planar", springs, &friction.replace("0.4", "0.1")).expect("springs that never let go");
        assert!(planar.contains("1.50 kN that friction can bear"), "{planar}");
        for slides in [r#"law = "rigid""#, r#"law = "no-tension", stiffness = "1 MN/m", rigidity = 1"#] {
            assert_eq!(told("planar", slides, friction), None);
        }
    }

    /// Rigid joints under a third of what their friction bears: nothing creeps where friction sticks truly, in any law of a planar wall.
    #[test]
    fn friction_that_sticks_does_not_creep() {
        let text = |law: &str| {
            format!(
                r#"
model = "planar"
[[panel]]
bond = "running"
courses = 4
bricks = 2
brick = {{ length = 1, height = 0.25, thickness = 0.5, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "rigid" }}
friction = {{ law = "{law}", static = 1.2, dynamic = 1.2, on = "all" }}
[motion]
duration = "2 s"
quasi_static = true
base = {{ tilt = {{ acceleration = "0.3 g", rise = "2 s" }} }}
"#
            )
        };
        for law in ["coulomb", "stribeck"] {
            assert_eq!(of_kind(&text(law), WarningKind::Creep), None, "{law}");
            let (prepared, outcome) = ran(&text(law));
            let rows = crate::run::joint_rows(&prepared.model);
            assert!(outcome.energies.friction > 0.0 && !only_creeps(&rows, &outcome), "{law}");
        }
    }
}
