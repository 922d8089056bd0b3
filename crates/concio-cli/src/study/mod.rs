//! What `concio study` writes beside tables: figures and one page, made of sections that every analysis brings.

pub mod asked;
pub mod bars;
pub mod choices;
pub mod crack_map;
pub mod cracks;
pub mod first_crack;
pub mod ida;
pub mod interfaces;
pub mod interval_bars;
pub mod page;
pub mod ranking;
pub mod sections;
pub mod sensitivity;
pub mod wall_map;

pub use page::write;

use std::path::Path;

use concio_study::store::Store;

use crate::files;
use crate::format::counted;

/// Faults of a store that are named at most.
const MOST_NAMED: usize = 5;

/// What a study asks for, by the tables that answer it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The runs of its design.
    Design,
    /// `[ida]`.
    Ida,
    /// `[first-crack]`.
    FirstCrack,
}

/// Tables of which each kind has one at least.
const TABLES: [(Kind, &[&str]); 3] = [
    (
        Kind::Design,
        &[
            "runs.csv",
            "sensitivity.csv",
            "cracks.csv",
            "ranking.csv",
            "interfaces.csv",
            "interfaces-by-motion.csv",
            "interfaces-draws.csv",
            "crack-lines.csv",
        ],
    ),
    (Kind::Ida, &["ida.csv", "capacities.csv", "fragility.csv", "fragility_curves.csv", "fractiles.csv"]),
    (Kind::FirstCrack, &["first-crack.csv", "first-crack-runs.csv"]),
];

/// Says of tables of a folder that they are of an earlier question; they stay, for the files of one folder may belong to several studies.
pub fn tell_others(out: &Path, own: Kind) {
    let others = TABLES.into_iter().filter(|(kind, _)| *kind != own).flat_map(|(_, names)| names);
    let left: Vec<&str> = others.copied().filter(|name| out.join(name).is_file()).collect();
    if !left.is_empty() {
        let names = left.join(", ");
        files::note(&format!(
            "{names} in {} are of an earlier question: this report does not write them",
            out.display()
        ));
    }
}

/// Says what a folder holds that does not count: rows of another version, and from fault number `from` on what is not what was
/// written; the number of faults.
pub fn tell_passed_over(store: &Store, from: usize) -> usize {
    if store.outdated > 0 && from == 0 {
        let many = counted(store.outdated, "run");
        files::note(&format!(
            "{many} of the folder were measured by another version and do not count: they are done anew"
        ));
    }
    let faults = &store.faults()[from..];
    for fault in faults.iter().take(MOST_NAMED) {
        files::note(&format!("warning: {fault}; it does not count, and `concio study run` does its run again"));
    }
    if faults.len() > MOST_NAMED {
        files::note(&format!("warning: {} more lines or files do not count either", faults.len() - MOST_NAMED));
    }
    from + faults.len()
}
