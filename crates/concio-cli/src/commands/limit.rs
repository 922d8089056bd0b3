//! `concio limit`.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use concio::case::CaseFile;
use concio::planar::Rest;
use concio::run::{Prepared, prepare};
use concio::{Error, InputError};
use concio_limit::{self as limit, JointMotion, LimitError, NonAssociative, Options, Problem, Stop};
use serde_json::{Value, json};

use super::{Answer, check::TRIED, run::refuse_a_file, wall_file};
use crate::args::{HeadFriction, Limit, LimitLoad, Side};
use crate::draw::mechanism;
use crate::failure::{Failure, STOPPED};
use crate::files;
use crate::format::{fixed, line, pairs, si, significant};

/// Names of the results in their folder.
pub(super) const RESULT: &str = "limit.json";
pub(super) const DRAWING: &str = "mechanism.svg";
/// Joints that are named on the terminal.
pub(super) const NAMED: usize = 8;
/// Relative difference of two multipliers that are equal.
const EQUAL: f64 = 1e-6;
/// Part by which estimates without dilation have to differ for one to be called the lower.
const TELLING: f64 = 0.01;

/// Finds the collapse multiplier of a wall.
pub fn limit(args: &Limit) -> Result<ExitCode, Failure> {
    let file = wall_file::read_at_rest(&args.file)?;
    wall_file::doubt(&file);
    if let Some(out) = &args.out {
        refuse_a_file(out)?;
    }
    let (weaker, other) = pushed(args, &file)?;
    weaker.problem.warnings.iter().for_each(|warning| files::note(&format!("warning: {warning}")));
    let Pushed { problem, found, .. } = &weaker;
    let falls = falls(&file);
    let result = result(args, &weaker, other.as_ref(), falls);
    if let Some(out) = &args.out {
        fs::create_dir_all(out).map_err(|e| Failure::from(Error::io(out, e)))?;
        files::write(&out.join(RESULT), &format!("{result:#}\n"))?;
        let drawing = mechanism::draw(problem, found).outlined().map_err(|e| Failure::Other(e, None))?;
        files::write(&out.join(DRAWING), &drawing)?;
    }
    if args.json {
        files::print_json(&format!("{result:#}\n"))?;
    } else {
        let title = if file.case.title.is_empty() { String::new() } else { format!("{}\n\n", line(&file.case.title)) };
        let names = |out: &Path| format!("\nopen {}\n", out.join(DRAWING).display());
        let written = args.out.as_deref().map(names).unwrap_or_default();
        let mut rows = rows(args, &weaker, other.as_ref());
        if falls == Some(true) {
            rows.push(("but", "the wall falls under its own loads: see the warning".into()));
        }
        files::print(&format!("{title}{}{written}", pairs(&rows)))?;
    }
    if falls == Some(true) {
        files::note(
            "warning: λ does not hold: with the joints of the file the wall falls under its own loads, as `concio check` tells. Where these are rigid, \
             friction that nothing presses may hold it in limit analysis, which takes any pair of forces that cancel",
        );
    }
    let estimates = [Some(&weaker), other.as_ref()].map(|p| {
        let found = &p?.found.non_associative;
        (found.stop == Stop::Converged).then_some(found.multiplier)
    });
    if let ([Some(this), Some(that)], Some(other)) = (estimates, &other)
        && that < this * (1.0 - TELLING)
    {
        let (way, that, this) = (side(other.towards), significant(that, 4), significant(this, 4));
        files::note(&format!(
            "warning: without dilation the wall is weaker to the {way}, by the estimates: {that} instead of {this}; real friction does not dilate"
        ));
    }
    // A way that is not certified may be the weaker.
    let open: Vec<&Pushed> =
        [Some(&weaker), other.as_ref()].into_iter().flatten().filter(|p| !p.found.is_certified()).collect();
    for Pushed { towards, found, .. } in &open {
        let (wide, side, most) = (significant(found.gap(), 2), side(*towards), limit::CERTIFIED);
        files::note(&format!("no certificate to the {side}: the bounds are {wide} of λ apart, {most} are allowed"));
    }
    Ok(if open.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(STOPPED) })
}

/// What `--json` prints.
pub fn answer(args: &Limit, file: &CaseFile) -> Result<Answer, Failure> {
    let (weaker, other) = pushed(args, file)?;
    let drawing = Some(mechanism::draw(&weaker.problem, &weaker.found).svg());
    Ok(Answer { value: result(args, &weaker, other.as_ref(), falls(file)), drawing })
}

/// The way in which the wall bears less, and the other where both are asked.
fn pushed(args: &Limit, file: &CaseFile) -> Result<(Pushed, Option<Pushed>), Failure> {
    if let Some(Side::Outwards | Side::Inwards) = args.towards {
        let error = InputError::new("--towards outwards and inwards are across the plane").in_file(&args.file);
        return Err(error.allowed("left and right, or --out-of-plane").into());
    }
    let sides = args.towards.map_or(vec![Side::Right, Side::Left], |side| vec![side]);
    let mut pushed = Vec::with_capacity(sides.len());
    for towards in sides {
        let problem = Problem::of(&file.case, options(args, towards));
        let problem = problem.map_err(|e| wall_file::all(file, file.locate(e)))?;
        let found = limit::analyse(&problem).map_err(|e| failure(e, &args.file))?;
        pushed.push(Pushed { towards, problem, found });
    }
    Ok(weaker(pushed))
}

/// Whether the wall falls by itself, which self-stress of rigid stones may hide; none of shear walls, large ones, and walls that cannot be run.
fn falls(file: &CaseFile) -> Option<bool> {
    let asked = |Prepared { model, .. }: Prepared| {
        let tried = model.wall.blocks.len() <= TRIED;
        model.planar().filter(|_| tried).map(|own| own.rest())
    };
    prepare(file).ok().and_then(asked).map(|rest| rest == Rest::Falls)
}

/// What was found for one way.
struct Pushed {
    towards: Side,
    problem: Problem,
    found: limit::Limit,
}

/// The way in which the wall bears less for certain, of two that are equal but for rounding the first, and the other.
fn weaker(mut pushed: Vec<Pushed>) -> (Pushed, Option<Pushed>) {
    let other = if pushed.len() > 1 { pushed.pop() } else { None };
    let first = pushed.remove(0);
    match other {
        Some(other) if other.found.bounds[0] < first.found.bounds[0] * (1.0 - EQUAL) => (other, Some(first)),
        other => (first, other),
    }
}

pub(super) fn options(args: &Limit, towards: Side) -> Options {
    Options {
        push: match args.load {
            LimitLoad::Body => limit::Push::Body,
            LimitLoad::Top => limit::Push::Top,
        },
        towards: match towards {
            Side::Left => limit::Towards::Left,
            // Across the plane the side within it plays no part.
            Side::Right | Side::Outwards | Side::Inwards => limit::Towards::Right,
        },
        heads: match args.heads {
            HeadFriction::AsGiven => limit::Heads::AsGiven,
            HeadFriction::Frictionless => limit::Heads::Frictionless,
        },
    }
}

pub(super) fn failure(error: LimitError, path: &Path) -> Failure {
    match error {
        LimitError::DoesNotStand => {
            let error = InputError::new(error.to_string()).in_file(path);
            error.allowed("a wall whose blocks are in balance without tension").into()
        }
        LimitError::Wrong(_) => InputError::new(error.to_string()).in_file(path).into(),
        LimitError::NotSolved(_) => Failure::Other(error.to_string(), None),
    }
}

fn rows(
    args: &Limit,
    Pushed { towards, problem, found }: &Pushed,
    other: Option<&Pushed>,
) -> Vec<(&'static str, String)> {
    let load = match args.load {
        LimitLoad::Body if problem.live.len() > problem.wall.blocks.len() => "weight of every block and of the beam",
        LimitLoad::Body if problem.laden => "weight of every block and of the load on them",
        LimitLoad::Body => "weight of every block",
        LimitLoad::Top => "dead load of the top course",
    };
    let heads = match args.heads {
        HeadFriction::AsGiven => "",
        HeadFriction::Frictionless => ", head joints without friction",
    };
    let [lower, upper] = found.bounds.map(|b| fixed(b, 8));
    let total: f64 = problem.live.iter().map(|f| f[0].abs()).sum();
    let mechanism = &found.mechanism;
    let named = |chosen: fn(&JointMotion) -> bool| {
        let names: Vec<&str> =
            mechanism.joints.iter().filter(|j| chosen(j)).map(|j| problem.joints[j.joint].as_str()).collect();
        let more = names.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("{}: {}{more}", names.len(), names[..names.len().min(NAMED)].join(", "))
    };
    let mut rows = vec![
        ("load", format!("λ × {load}, to the {}{heads}", side(*towards))),
        ("λ", format!("{} for associative friction{}", significant(found.multiplier(), 6), without(&problem.left_out))),
        ("bounds", format!("{lower} by forces, {upper} by a mechanism")),
        ("force", si(found.multiplier() * total, "N")),
        ("without dilation", estimate(&found.non_associative)),
        ("mechanism", mechanism.kind.what().into()),
    ];
    if let Some(other) = other {
        let value = significant(other.found.multiplier(), 6);
        let estimate = &other.found.non_associative;
        let without = match estimate.stop {
            Stop::Converged => format!("; without dilation {}", significant(estimate.multiplier, 4)),
            _ => String::new(),
        };
        rows.insert(3, ("the other way", format!("λ = {value} to the {}{without}", side(other.towards))));
    }
    if mechanism.joints.iter().any(|j| j.slides) {
        rows.push(("joints that slide", named(|j| j.slides)));
    }
    if mechanism.joints.iter().any(|j| j.opens) {
        rows.push(("joints that open", named(|j| j.opens)));
    }
    rows
}

/// Of what λ does not know.
pub(super) fn without(left_out: &[&str]) -> String {
    if left_out.is_empty() { String::new() } else { format!(", without the {}", left_out.join(" and ")) }
}

fn side(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
        Side::Outwards => "outer face",
        Side::Inwards => "inner face",
    }
}

pub(super) fn estimate(found: &NonAssociative) -> String {
    let value = significant(found.multiplier, 4);
    match found.stop {
        Stop::Converged => {
            let [least, most] = found.states.unwrap_or([found.multiplier; 2]).map(|state| significant(state, 4));
            let states =
                if least == most { String::new() } else { format!("; {least} to {most} with the same mechanism") };
            format!("λ = {value}, an estimate{states}; {} rounds", found.rounds)
        }
        Stop::Rounds => format!("no estimate: not converged in {} rounds, λ last {value}", found.rounds),
        Stop::Unsolved => format!("no estimate: round {} has no solution", found.rounds),
    }
}

/// Of `limit.json`.
pub(super) fn without_dilation(found: &NonAssociative) -> Value {
    let converged = found.stop == Stop::Converged;
    json!({
        "multiplier": converged.then_some(found.multiplier),
        "converged": converged, "rounds": found.rounds, "excess": found.excess, "states": found.states,
    })
}

fn result(
    args: &Limit,
    Pushed { towards, problem, found }: &Pushed,
    other: Option<&Pushed>,
    falls: Option<bool>,
) -> Value {
    let bodies = problem.assembly.bodies.iter().zip(&found.mechanism.velocities);
    let blocks: Vec<Value> =
        bodies.map(|(b, v)| json!({ "name": b.name, "velocity": [v[0], v[1]], "rotation": v[2] })).collect();
    let joint = |j: &JointMotion| {
        json!({
            "name": problem.joints[j.joint], "slides": j.slides, "opens": j.opens,
            "opening": j.opening, "slip": j.slip,
        })
    };
    let points = problem.assembly.points.iter().zip(&found.forces);
    let forces: Vec<Value> = points
        .map(|(p, f)| json!({ "joint": problem.joints[p.joint], "at": p.at, "normal": f[0], "tangential": f[1] }))
        .collect();
    let other = other.map(|o| {
        json!({
            "towards": side(o.towards), "multiplier": o.found.multiplier(), "bounds": o.found.bounds,
            "non_associative": without_dilation(&o.found.non_associative),
        })
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "load": match args.load { LimitLoad::Body => "body", LimitLoad::Top => "top" },
        "towards": side(*towards),
        "heads": match args.heads { HeadFriction::AsGiven => "as-given", HeadFriction::Frictionless => "frictionless" },
        "live_load": problem.live.iter().map(|f| f[0]).sum::<f64>(),
        "multiplier": found.multiplier(),
        "left_out": problem.left_out,
        "bounds": found.bounds,
        "other_way": other,
        "gap": found.gap(),
        "certified": found.is_certified(),
        "unbalanced": found.unbalanced,
        "non_associative": without_dilation(&found.non_associative),
        "mechanism": {
            "kind": found.mechanism.kind.name(),
            "blocks": blocks,
            "joints": found.mechanism.joints.iter().map(joint).collect::<Vec<_>>(),
        },
        "forces": forces,
        "warnings": problem.warnings,
        "falls_by_itself": falls,
    })
}
