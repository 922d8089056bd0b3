//! Tie rods; that the blocks exist which they are fixed to, the laid wall shows.

use super::{Bound, Findings};
use crate::case::{Case, ModelKind, Tie};

/// Most ties of a wall: each joins what lies far apart, and makes the equations of a step denser.
const MOST_TIES: usize = 1000;

pub(super) fn check(f: &mut Findings, case: &Case) {
    if case.model == ModelKind::Shear && !case.ties.is_empty() {
        let what = "ties are for planar walls: blocks of a shear wall move horizontally and nothing else";
        f.push("tie[0]", what, "with `model = \"planar\"`; else leave it out");
    }
    if case.ties.len() > MOST_TIES {
        f.push("tie", format!("{} ties are too many", case.ties.len()), format!("up to {MOST_TIES}"));
        return;
    }
    for (i, tie) in case.ties.iter().enumerate() {
        if tie.from == tie.to {
            let what = match tie.to.as_str() {
                Tie::BASE => "both ends are fixed to the base".to_string(),
                name => format!("both ends are fixed to block {name}"),
            };
            f.push(format_args!("tie[{i}].to"), what, "another block than `from`, or `base`");
        }
        for (key, at) in [("at", tie.at), ("to_at", tie.to_at)] {
            at.into_iter().for_each(|v| f.quantity(format_args!("tie[{i}].{key}"), v, Bound::Finite));
        }
        f.quantity(format_args!("tie[{i}].stiffness"), tie.stiffness, Bound::Above0);
        if let Some(force) = tie.yield_force {
            f.quantity(format_args!("tie[{i}].yield_force"), force, Bound::Above0);
        }
        f.quantity(format_args!("tie[{i}].slack"), tie.slack, Bound::From0);
    }
}
