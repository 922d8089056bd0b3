//! Runs the built-in wall under its record and prints what an engineer asks first.
//!
//! `cargo run --release -p concio --example run` (or with the path of a wall file)

use std::path::Path;

use concio::case;
use concio::run::{prepare, run_in_memory};
use concio::store::residual_relative;

fn main() -> concio::Result<()> {
    let file = match std::env::args().nth(1) {
        Some(path) => case::read(Path::new(&path))?,
        None => case::example()?,
    };
    let prepared = prepare(&file)?;
    prepared.model.warnings.iter().for_each(|warning| println!("warning: {}", warning.text));
    let outcome = run_in_memory(&prepared)?;
    let totals = &outcome.totals;
    println!("weight             {:.2} kN", 1e-3 * prepared.model.weight());
    println!("largest base shear {:.2} kN", 1e-3 * totals.base_shear_peak);
    println!("largest movement   {:.3} mm", 1e3 * totals.peak_relative_displacement);
    println!("energy residual    {:.1e} of the work", residual_relative(&outcome));
    match totals.collapse {
        Some(collapse) => println!("collapsed at       {:.2} s", collapse.time),
        None => println!("stands at          {:.2} s", outcome.time_reached),
    }
    Ok(())
}
