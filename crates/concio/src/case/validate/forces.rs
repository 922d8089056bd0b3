//! Forces on blocks; that the blocks exist, the laid wall shows.

use super::{Bound, Findings};
use crate::case::Case;

/// Most forces of a wall, and values of each.
const MOST_FORCES: usize = 1000;
const MOST_VALUES: usize = 10_000_000;

pub(super) fn check(f: &mut Findings, case: &Case) {
    if case.forces.len() > MOST_FORCES {
        f.push("force", format!("{} forces are too many", case.forces.len()), format!("up to {MOST_FORCES}"));
        return;
    }
    if case.motion.quasi_static && !case.forces.is_empty() {
        f.push("force[0]", "forces act on walls with inertia alone", "none beside `motion.quasi_static`");
    }
    for (i, force) in case.forces.iter().enumerate() {
        for (key, values) in [("x", &force.x), ("y", &force.y)] {
            if values.len() > MOST_VALUES {
                let what = format!("{} values are too many", values.len());
                f.push(format_args!("force[{i}].{key}"), what, format!("up to {MOST_VALUES}"));
                continue;
            }
            for (k, value) in values.iter().enumerate() {
                if !f.takes_more() {
                    return;
                }
                f.quantity(format_args!("force[{i}].{key}[{k}]"), *value, Bound::Finite);
            }
        }
        match force.every {
            Some(every) => f.quantity(format_args!("force[{i}].every"), every, Bound::Above0),
            None if force.x.len().max(force.y.len()) > 1 => f.push(
                format_args!("force[{i}]"),
                "several values, and not how long each acts",
                "with `every`, such as \"1 ms\"",
            ),
            None => {}
        }
        if force.x.is_empty() && force.y.is_empty() {
            f.push(format_args!("force[{i}]"), "a force without values", "`x`, `y` or both, such as x = [\"1 kN\"]");
        }
    }
}
