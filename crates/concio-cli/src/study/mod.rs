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

use concio_study::store::Store;

use crate::files;
use crate::format::counted;

/// Faults of a store that are named at most.
const MOST_NAMED: usize = 5;

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
