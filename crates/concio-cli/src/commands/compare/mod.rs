//! `concio compare`.

mod constrained;
mod figures;
mod inputs;
mod numbers;
mod runs;
mod side;

use crate::args::{Compare, Comparison};
use crate::failure::Failure;

/// Compares what is asked for.
pub fn compare(args: &Compare) -> Result<(), Failure> {
    match &args.what {
        Some(Comparison::Constrained(args)) => constrained::constrained(args),
        None => runs::runs(args),
    }
}
