//! `concio limit --out-of-plane`.

use std::fs;
use std::process::ExitCode;

use concio::case::{CaseFile, ModelKind};
use concio::model::NOT_IN_PLANE;
use concio::{Error, InputError};
use concio_limit::space::{self, ContactKind, ContactMotion, Face, Limit, Problem, Turning, Vector};
use concio_limit::{CERTIFIED, LimitError, NonAssociative, Problem as Planar, other_strengths};
use serde_json::{Value, json};

use super::limit::{DRAWING, NAMED, RESULT, estimate, failure, options, without, without_dilation};
use super::limit_behind::{self, Behind, NOTHING};
use super::{Answer, run::refuse_a_file, wall_file};
use crate::args::{HeadFriction, Limit as Asked, LimitLoad, Side};
use crate::draw::axonometry;
use crate::failure::{Failure, STOPPED};
use crate::files;
use crate::format::{fixed, line, pairs, percent, si, significant};

/// Blocks up to which λ without dilation is estimated unasked.
const QUICK: usize = 100;
/// Twist of a bed joint over the largest velocity, per half of the joint's diagonal, from which it is told.
const TWISTS: f64 = 1e-2;

/// Beside a wall whose stones crush and that does not stand.
const CRUSHES: &str = "stones crush here, at joint.bed.compressive_strength or out_of_plane.strength: without it `limit` tells whether the wall stands on stones \
                       that do not";

/// What is found.
struct Found {
    problem: Problem,
    /// As the file says.
    limit: Limit,
    /// Head joints without friction, where the file has some.
    smooth: Option<Limit>,
    dilation: Option<NonAssociative>,
    turning: Option<Turning>,
    /// f_c [Pa], contacts that it does not suffice for.
    crushing: Option<(f64, Vec<usize>)>,
    /// Bed joints that twist in the mechanism.
    twisting: usize,
    /// What stands and pulls behind the wall.
    behind: Option<Behind>,
    left_out: Vec<&'static str>,
    warnings: Vec<String>,
}

impl Found {
    /// Whether the dead load alone crushes a joint.
    fn overloads(&self) -> bool {
        self.crushing.as_ref().is_some_and(|(_, overloaded)| !overloaded.is_empty())
    }
}

/// Finds the multiplier of a wall that is pushed across its plane.
pub fn limit(args: &Asked) -> Result<ExitCode, Failure> {
    let file = wall_file::read_at_rest(&args.file)?;
    wall_file::doubt(&file);
    if let Some(out) = &args.out {
        refuse_a_file(out)?;
    }
    let (face, found) = asked(args, &file)?;
    for warning in found.warnings.iter() {
        files::note(&format!("warning: {warning}"));
    }
    let result = result(args, face, &found);
    if let Some(out) = &args.out {
        fs::create_dir_all(out).map_err(|e| Failure::from(Error::io(out, e)))?;
        files::write(&out.join(RESULT), &format!("{result:#}\n"))?;
        let drawing = axonometry::draw(&found.problem, &found.limit).outlined();
        files::write(&out.join(DRAWING), &drawing.map_err(|e| Failure::Other(e, None))?)?;
    }
    if args.json {
        files::print_json(&format!("{result:#}\n"))?;
    } else {
        let title = if file.case.title.is_empty() { String::new() } else { format!("{}\n\n", line(&file.case.title)) };
        let names = |out: &std::path::Path| format!("\nopen {}\n", out.join(DRAWING).display());
        let written = args.out.as_deref().map(names).unwrap_or_default();
        files::print(&format!("{title}{}{written}", pairs(&rows(args, face, &found))))?;
    }
    if !found.limit.is_certified() {
        files::note(&uncertified("λ", &found.limit));
    }
    if found.overloads() {
        files::note("no certificate: joints are pressed with more than they bear");
    }
    Ok(if found.limit.is_certified() && !found.overloads() { ExitCode::SUCCESS } else { ExitCode::from(STOPPED) })
}

/// What `--json` prints.
pub fn answer(args: &Asked, file: &CaseFile) -> Result<Answer, Failure> {
    let (face, found) = asked(args, file)?;
    let drawing = Some(axonometry::draw(&found.problem, &found.limit).svg());
    Ok(Answer { value: result(args, face, &found), drawing })
}

/// Which way, and what is found.
fn asked(args: &Asked, file: &CaseFile) -> Result<(Face, Found), Failure> {
    let wrong = |what: &str, allowed: &str| Err(InputError::new(what).in_file(&args.file).allowed(allowed).into());
    let face = match args.towards {
        None | Some(Side::Outwards) => Face::Outwards,
        Some(Side::Inwards) => Face::Inwards,
        Some(Side::Left | Side::Right) => {
            return wrong("--towards left and right are in the plane", "outwards, inwards");
        }
    };
    if args.heads == HeadFriction::Frictionless {
        return wrong("--out-of-plane tells λ without friction at head joints beside the other", "no --heads");
    }
    // Blocks in space are those of any model.
    let mut case = file.case.clone();
    if case.model == ModelKind::Rocking {
        case.model = ModelKind::Planar;
    }
    let planar = Planar::of(&case, options(args, Side::Right));
    let planar = planar.map_err(|e| wall_file::all(file, file.locate(e)))?;
    let found = find(args, file, &planar, face)?;
    Ok((face, found))
}

fn find(args: &Asked, file: &CaseFile, planar: &Planar, face: Face) -> Result<Found, Failure> {
    let told = |e| failure(e, &args.file);
    let mut problem = space::of_wall(planar, face).map_err(told)?;
    let (mut strength, mut left_out) = (file.case.joint.bed.compressive_strength.map(|s| s.si()), Vec::new());
    let mut behind = None;
    if let Some(table) = &file.case.out_of_plane {
        let (backed, found, warnings) = limit_behind::add(problem, file, planar, args)?;
        strength = limit_behind::strength(table).or(strength);
        (problem, behind, left_out) = (backed, Some(found), warnings);
    }
    if let Some(above) = args.above {
        for (held, body) in problem.held.iter_mut().zip(&problem.assembly.bodies) {
            *held = body.centre[2] < above;
        }
        if !problem.held.contains(&false) {
            let error = InputError::new(format!("no block stands above --above {above} m")).in_file(&args.file);
            let tops = problem.assembly.bodies.iter().map(|b| b.centre[2]).fold(0.0, f64::max);
            return Err(error
                .allowed(format!("below {} m, the middle of the highest block", significant(tops, 4)))
                .into());
        }
    }
    let mut warnings: Vec<String> = planar
        .warnings
        .iter()
        .filter(|w| strength.is_none() || !w.starts_with("compressive_strength"))
        .filter(|w| w.as_str() != NOT_IN_PLANE)
        .cloned()
        .chain(left_out)
        .collect();
    if strength.is_some_and(|all| other_strengths(&file.case.joint).iter().any(|other| *other != all)) {
        warnings.push(
            "other compressive strengths are left out: all joints crush at that of joint.bed or out_of_plane".into(),
        );
    }
    if let Some(strength) = strength {
        problem = problem.crushing(strength);
    }
    if args.even_twist {
        problem = problem.drawn_in();
    }
    let falls = |e: LimitError| {
        let crushes = strength.is_some() && matches!(e, LimitError::DoesNotStand);
        match failure(e, &args.file) {
            Failure::Input(all) if crushes => Failure::Input(all.into_iter().map(|e| e.help(CRUSHES)).collect()),
            other => other,
        }
    };
    let space::Crushed { limit, problem, overloaded } = space::crushed(&problem).map_err(falls)?;
    let crushing = strength.map(|strength| (strength, overloaded));
    let smooth = match problem.heads_rub().then(|| space::analyse(&problem.frictionless_heads())) {
        // Friction of head joints may be what holds a stone at a jamb.
        Some(Err(LimitError::DoesNotStand)) => {
            warnings.push("without friction of the head joints the wall is not found to stand under its dead load: λ of smooth heads is left out".into());
            None
        }
        smooth => smooth.transpose().map_err(told)?,
    };
    // The comparison: the exit status is that of λ.
    warnings.extend(smooth.iter().filter(|s| !s.is_certified()).map(|s| uncertified("λ of smooth heads", s)));
    if limit.multiplier() < NOTHING {
        warnings
            .push("λ is 0: something moves at the least push; joints that do not rub (joint.friction) slide so".into());
    }
    let quick = problem.assembly.bodies.len() <= QUICK || args.without_dilation;
    let dilation = quick.then(|| space::without_dilation(&problem, &limit));
    Ok(Found {
        twisting: twisting(&problem, &limit),
        turning: problem.turning(),
        problem,
        limit,
        smooth,
        dilation,
        crushing,
        behind,
        left_out: planar.left_out.clone(),
        warnings,
    })
}

/// Bed joints and base joints whose sides turn against each other about the normal.
fn twisting(problem: &Problem, limit: &Limit) -> usize {
    let turn = |body: usize| limit.mechanism.rotations[body];
    let twists = |motion: &&ContactMotion| {
        let contact = &problem.assembly.contacts[motion.contact];
        let still = [0.0; 3];
        let other = contact.b.map_or(still, turn);
        let rate: f64 = (0..3).map(|k| (other[k] - turn(contact.a)[k]) * contact.normal[k]).sum();
        let [a, b] = contact.sides();
        contact.kind != ContactKind::Head && rate.abs() * 0.5 * a.hypot(b) > TWISTS
    };
    limit.mechanism.contacts.iter().filter(twists).count()
}

fn rows(args: &Asked, face: Face, found: &Found) -> Vec<(&'static str, String)> {
    let (problem, limit) = (&found.problem, &found.limit);
    let load = match args.load {
        LimitLoad::Body => "weight of every block and what has mass on it",
        LimitLoad::Top => "dead load of the top course",
    };
    let part = args.above.map(|z| format!(", held below {} m", significant(z, 4))).unwrap_or_default();
    let heads = if found.problem.heads_rub() { ", head joints rub" } else { ", head joints do not rub" };
    let bounds = |limit: &Limit| {
        let [lower, upper] = limit.bounds.map(|b| fixed(b, 8));
        format!("{lower} by forces, {upper} by a mechanism")
    };
    let lambda = limit.multiplier();
    let mut rows = vec![
        ("load", format!("λ × {load}, {}{part}", way(face))),
        ("λ", format!("{} for associative friction{heads}{}", significant(lambda, 6), without(&found.left_out))),
        ("bounds", bounds(limit)),
    ];
    match &found.smooth {
        Some(smooth) => {
            rows.push((
                "smooth heads",
                format!("λ = {}, head joints without friction", significant(smooth.multiplier(), 6)),
            ));
            rows.push(("bounds", bounds(smooth)));
        }
        None if found.problem.heads_rub() => rows.push(("smooth heads", "not found to stand: see the warning".into())),
        None => rows.push(("smooth heads", "the same: friction.on = \"all\" would make head joints rub".into())),
    }
    rows.push(match &found.dilation {
        Some(dilation) => ("without dilation", estimate(dilation)),
        None => ("without dilation", format!("not asked of more than {QUICK} blocks; --without-dilation asks")),
    });
    if let Some(behind) = &found.behind {
        rows.push(("behind the wall", behind.text()));
    }
    rows.push(("closed form", closed(found)));
    let smooth = found.smooth.as_ref().map(Limit::multiplier);
    let closed = found.behind.iter().flat_map(|b| &b.closed);
    rows.extend(closed.map(|c| ("mechanisms", c.against(lambda, smooth))));
    rows.push(("force", si(lambda * problem.live_load(), "N")));
    rows.push(("mechanism", limit.mechanism.kind.what().into()));
    let named = |chosen: fn(&ContactMotion) -> bool| {
        let chosen: Vec<&str> =
            limit.mechanism.contacts.iter().filter(|c| chosen(c)).map(|c| name(problem, c)).collect();
        let more = chosen.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!("{}: {}{more}", chosen.len(), chosen[..chosen.len().min(NAMED)].join(", "))
    };
    if limit.mechanism.contacts.iter().any(|c| c.slides) {
        rows.push(("joints that slide", named(|c| c.slides)));
    }
    if limit.mechanism.contacts.iter().any(|c| c.opens) {
        rows.push(("joints that open", named(|c| c.opens)));
    }
    if let Some((strength, overloaded)) = &found.crushing {
        let over = match overloaded.len() {
            0 => String::new(),
            many => format!("; {many} joints are pressed with more than they bear, and λ is no bound"),
        };
        rows.push(("crushing", format!("hinges set back for {}{over}", si(*strength, "Pa"))));
    }
    rows.push(("upper bound", "what slides dilates: where joints slide, real ones bear less than λ".into()));
    if let Some(mu) = limit.slides_at(problem) {
        let what = format!("all that slides at μ = {} slides: λ is μ. --above pushes a part", significant(mu, 4));
        rows.push(("but", what));
    }
    if args.even_twist {
        rows.push((
            "low side",
            "contact points are drawn in: joints twist like even pressure, and rock about lines inside the blocks"
                .into(),
        ));
    } else if found.twisting > 0 {
        let what = "their corners bear a twist up to twice too strongly. --even-twist gives the low side";
        rows.push(("but", format!("{} bed joints twist: {what}", found.twisting)));
    }
    rows
}

/// That bounds are too far apart to prove a multiplier.
fn uncertified(name: &str, limit: &Limit) -> String {
    let wide = significant(limit.gap(), 2);
    format!("no certificate for {name}: its bounds are {wide} of it apart, {CERTIFIED} are allowed")
}

/// How α₀ lies to λ: it is never below the true one, and between the bounds it says no more than they do.
fn beside(alpha: f64, lambda: f64, [lower, upper]: [f64; 2]) -> String {
    let off = (alpha - lambda) / lambda;
    match off {
        _ if lambda < NOTHING => "λ is 0".to_string(),
        off if !off.is_finite() || off.abs() <= CERTIFIED => "equal to λ".to_string(),
        _ if (lower..=upper).contains(&alpha) => "between the bounds of λ".to_string(),
        off if off < 0.0 => format!("{} below λ, which is no better known then", percent(-off)),
        off => format!("{} above λ: the blocks find a lower one", percent(off)),
    }
}

fn closed(found: &Found) -> String {
    let Some(turning) = found.turning else {
        return "none: no level joint runs through, or something holds what is above it".into();
    };
    let (level, alpha) = (significant(turning.level, 4), turning.multiplier);
    let than = beside(alpha, found.limit.multiplier(), found.limit.bounds);
    format!("α₀ = {}, all above z = {level} m turns as one; {than}", significant(alpha, 6))
}

fn way(face: Face) -> &'static str {
    match face {
        Face::Outwards => "outwards",
        Face::Inwards => "inwards",
    }
}

fn name<'p>(problem: &'p Problem, motion: &ContactMotion) -> &'p str {
    &problem.assembly.contacts[motion.contact].name
}

fn result(args: &Asked, face: Face, found: &Found) -> Value {
    let (problem, limit) = (&found.problem, &found.limit);
    let of = |limit: &Limit| {
        json!({
            "multiplier": limit.multiplier(), "bounds": limit.bounds, "gap": limit.gap(),
            "certified": limit.is_certified() && !found.overloads(), "unbalanced": limit.unbalanced,
        })
    };
    let motion = limit.mechanism.velocities.iter().zip(&limit.mechanism.rotations);
    let blocks: Vec<Value> = problem
        .assembly
        .bodies
        .iter()
        .zip(motion)
        .map(|(b, (v, w))| json!({ "name": b.name, "centre": b.centre, "velocity": v, "rotation": w }))
        .collect();
    let joint = |c: &ContactMotion| {
        json!({
            "name": name(problem, c), "slides": c.slides, "opens": c.opens, "opening": c.opening, "slip": c.slip,
        })
    };
    let contacts = problem.assembly.contacts.iter().zip(limit.forces.chunks(4));
    let points = contacts.flat_map(|(c, forces)| c.corners.iter().zip(forces).map(move |(at, f)| (c, at, f)));
    let forces: Vec<Value> = points
        .map(|(c, at, f): (_, &Vector, &Vector)| {
            json!({ "joint": c.name, "at": at, "normal": f[0], "tangential": f[1].hypot(f[2]) })
        })
        .collect();
    let mut result = of(limit);
    let more = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "out_of_plane": true,
        "load": match args.load { LimitLoad::Body => "body", LimitLoad::Top => "top" },
        "towards": way(face),
        "left_out": found.left_out,
        "held_below": args.above,
        "even_twist": args.even_twist,
        "live_load": problem.live_load(),
        "heads_rub": found.problem.heads_rub(),
        "frictionless_heads": found.smooth.as_ref().map(of),
        "non_associative": found.dilation.as_ref().map(without_dilation),
        "closed_form": found.turning.map(|t| json!({ "multiplier": t.multiplier, "level": t.level })),
        "crushing": found.crushing.as_ref().map(|(strength, over)| {
            let names: Vec<&str> = over.iter().map(|c| problem.assembly.contacts[*c].name.as_str()).collect();
            json!({ "strength": strength, "overloaded": names })
        }),
        "behind": found.behind.as_ref().map(Behind::json),
        "slides_at": limit.slides_at(problem),
        "twisting_joints": found.twisting,
        "mechanism": {
            "kind": limit.mechanism.kind.name(),
            "blocks": blocks,
            "joints": limit.mechanism.contacts.iter().map(joint).collect::<Vec<_>>(),
        },
        "forces": forces,
        "warnings": found.warnings,
    });
    if let (Some(result), Value::Object(more)) = (result.as_object_mut(), more) {
        result.extend(more);
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nothing lies by a negative part above another, and within the bounds the blocks find nothing lower.
    #[test]
    fn a_closed_form_lies_above_between_or_below() {
        for (alpha, lambda, bounds, told) in [
            (0.5, 0.5, [0.5, 0.5], "equal to λ"),
            (0.228088, 0.228207, [0.228044, 0.228371], "between the bounds of λ"),
            (0.625, 0.5, [0.5, 0.5], "25.0 % above λ: the blocks find a lower one"),
            (0.375, 0.5, [0.49, 0.51], "25.0 % below λ, which is no better known then"),
            (0.45, 0.0, [0.0, 0.0], "λ is 0"),
        ] {
            assert_eq!(beside(alpha, lambda, bounds), told, "{alpha} beside {lambda}");
        }
    }
}
