//! The figures of the report.

use concio::planar::tie_lines;
use concio::record::Channel;

use super::{Content, beam_label};
use crate::draw::curves::{self, Curve, Figure};
use crate::draw::wall::{self, Field, Paint, Subject};
use crate::format::NOTHING;

/// Single blocks and joints whose histories a report shows.
const ASKED: usize = 12;

/// Views of the wall beside that of the cracks; one less of a wall that rocks, whose hinges do not slide.
const VIEWS: usize = 5;

/// How many views of the wall there are.
pub fn views(content: &Content) -> usize {
    VIEWS + usize::from(!content.outcome.bonds.is_empty()) - usize::from(content.outcome.rocking.is_some())
}

/// The wall under one name per view; of a bonded wall the cracks come first.
pub fn walls(content: &Content) -> Vec<(&'static str, String)> {
    let beam = beam_label(&content.case);
    let (joints, names): (Vec<_>, Vec<_>) = content.joints.iter().map(|j| (j.joint.clone(), j.name.clone())).unzip();
    let ties = tie_lines(&content.case, content.wall);
    let subject = Subject { wall: content.wall, joints: &joints, names: &names, ties: &ties, beam: &beam };
    let envelopes = &content.outcome.envelopes;
    // A massive beam is one more unknown behind the blocks; the colours are those of the blocks.
    let of_blocks = &envelopes.block_displacement;
    let of_blocks = of_blocks.get(..content.wall.blocks.len()).unwrap_or(of_blocks);
    let field = |title, unit, values| Field { title, unit, values, none: "no value", parts: &[] };
    let gap = if content.is_planar() { "widest opening" } else { "widest gap of the head joints" };
    let views: [_; VIEWS] = [
        ("displacement", Paint::Blocks(field("peak displacement relative to the base", "m", of_blocks))),
        ("slip", Paint::Joints(field("way slipped", "m", &envelopes.joint_slip))),
        ("opening", Paint::Joints(field(gap, "m", &envelopes.joint_opening))),
        ("acceleration", Paint::Joints(field("peak relative acceleration", "m/s²", &envelopes.joint_acceleration))),
        ("dissipation", Paint::Joints(field("energy dissipated", "J", &envelopes.joint_dissipation))),
    ];
    let mut cracked = vec![f64::NAN; content.joints.len()];
    // Along which part of a joint it has cracked is known where cracks run along joints.
    let mut parts = vec![wall::WHOLE; content.joints.len()];
    for bond in &content.outcome.bonds {
        cracked[bond.joint] = bond.damage_of_crack();
        parts[bond.joint] = bond.cracks();
    }
    let field = Field { none: "not bonded", parts: &parts, ..field("damage of the bonds at the end", "1", &cracked) };
    let cracks = ("cracks", Paint::Joints(field));
    let cracks = (!content.outcome.bonds.is_empty()).then_some(cracks);
    // Hinges do not slide.
    let shown = views.into_iter().filter(|(name, _)| *name != "slip" || content.outcome.rocking.is_none());
    cracks.into_iter().chain(shown).map(|(name, paint)| (name, wall::draw(&subject, paint))).collect()
}

/// Whether a history differs from zero by more than rounding.
fn differs(values: &[f64]) -> bool {
    values.iter().any(|v| v.abs() >= NOTHING || v.is_nan())
}

/// Motions and forces over time.
pub fn histories(content: &Content) -> Vec<String> {
    let t = &content.outcome.recording.time;
    let driven = content.history("beam/displacement").filter(|y| differs(y));
    let mut figures = Vec::new();
    let mut add = |title, quantity, unit, curves: &[(&str, Option<Vec<f64>>)]| {
        let shown: Vec<Curve> = curves
            .iter()
            .filter_map(|(name, y)| Some(Curve { name, x: t, y: y.as_deref()? }))
            .filter(|c| differs(c.y))
            .collect();
        if !shown.is_empty() {
            figures.push(curves::draw(&Figure {
                title,
                x_label: "time [s]",
                quantity,
                unit,
                curves: shown,
                height: 250.0,
                right: curves::LEGEND,
                logarithmic: false,
            }));
        }
    };
    let of = |name: &str| content.history(name);
    add(
        "Top of the wall, relative to the base",
        "displacement",
        "m",
        &[("top course", of("top/displacement")), ("top beam", driven)],
    );
    add("Largest displacement of a block at each instant", "displacement", "m", &[("", of("peak/displacement"))]);
    add("Motion of the base", "acceleration", "m/s²", &[("", of("base/acceleration"))]);
    add("Motion of the base", "displacement", "m", &[("", of("base/displacement"))]);
    add("Horizontal forces on the wall", "force", "N", &[("base", of("base/shear")), ("top beam", of("top/force"))]);
    figures
}

/// Histories of the blocks and joints that the wall file asks for, at most [`ASKED`] of them, and how many are left
/// out: of a block its displacement, in planar walls its rise and rotation too, of a joint its relative displacement and its forces.
pub fn asked(content: &Content) -> (Vec<String>, usize) {
    let channels = content.outcome.layout.channels.iter();
    let single = |c: &&Channel| c.name.starts_with("block/") || c.name.starts_with("joint/");
    let mut owners: Vec<&str> = channels.filter(single).filter_map(|c| Some(c.name.rsplit_once('/')?.0)).collect();
    owners.dedup();
    let figures = owners.iter().take(ASKED).flat_map(|owner| of_owner(content, owner)).collect();
    (figures, owners.len().saturating_sub(ASKED))
}

fn of_owner(content: &Content, owner: &str) -> Vec<String> {
    let title = owner.replacen('/', " ", 1);
    let draw = |(unit, of_several): (&'static str, &'static str)| {
        let of_unit = content.outcome.layout.channels.iter().filter(|c| c.unit == unit);
        let found: Vec<(&str, Vec<f64>)> = of_unit
            .filter(|c| c.name.rsplit_once('/').is_some_and(|(o, _)| o == owner))
            .filter_map(|c| Some((c.name.rsplit_once('/')?.1, content.history(&c.name)?)))
            .collect();
        let named = found.len() > 1;
        let curves = found.iter().map(|(name, y)| Curve {
            name: if named { name } else { "" },
            x: &content.outcome.recording.time,
            y,
        });
        let quantity = if named { of_several } else { found.first()?.0 };
        Some(curves::draw(&Figure {
            title: &title,
            x_label: "time [s]",
            quantity,
            unit,
            curves: curves.collect(),
            height: 200.0,
            right: curves::LEGEND,
            logarithmic: false,
        }))
    };
    [("m", "displacement"), ("rad", "rotation"), ("N", "force")].into_iter().filter_map(draw).collect()
}

/// The energy account over time, and its residual.
pub fn energies(content: &Content) -> Vec<String> {
    let t = &content.outcome.recording.time;
    let parts: [&'static str; 9] =
        ["input", "friction", "damping", "elastic", "kinetic", "bond", "device", "impact", "nonreciprocal"];
    let of = |name: &&'static str| content.history(&format!("energy/{name}")).map(|y| (*name, y));
    let found: Vec<(&'static str, Vec<f64>)> = parts.iter().filter_map(of).filter(|(_, y)| differs(y)).collect();
    let curves = found.iter().map(|(name, y)| Curve { name: title(name), x: t, y }).collect();
    let account = Figure {
        title: "Energy by mechanism",
        x_label: "time [s]",
        quantity: "energy",
        unit: "J",
        curves,
        height: 340.0,
        right: curves::LEGEND,
        logarithmic: false,
    };
    let mut figures = vec![curves::draw(&account)];
    if let Some(residual) = content.history("energy/residual") {
        figures.push(curves::draw(&Figure {
            title: "Residual of the account: kinetic + elastic + dissipated − work done",
            curves: vec![Curve { name: "", x: t, y: &residual }],
            height: 200.0,
            ..account
        }));
    }
    figures
}

fn title(channel: &str) -> &str {
    match channel {
        "input" => "work done on the wall",
        "friction" => "dissipated by friction",
        "damping" => "dissipated by damping",
        "bond" => "broken bonds",
        "device" => "hysteresis of devices",
        "impact" => "lost in impacts",
        "nonreciprocal" => "unbalanced friction",
        other => other,
    }
}
