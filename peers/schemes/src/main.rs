//! Time integration schemes at a fixed step, on a system that `concio system` printed. One plain implementation of each,
//! all with the same dense factorisation and the same iteration on the friction law, so that what they cost and how far
//! they are off can be compared; Concio's own is faster (docs/decisions/0007-schemes.md).
//!
//! ```text
//! schemes METHOD SYSTEM.json STEP ATOL INTERVAL HISTORY.bin
//! ```
//!
//! STEP [s]; ATOL is not used. Prints one line of JSON; HISTORY.bin gets the displacements of all unknowns at INTERVAL,
//! 2 INTERVAL, …, between steps by linear interpolation: let the step divide the interval.

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use peer_system::System;
use serde_json::json;

mod account;
mod dense;
mod frictional;
mod implicit;
mod impulses;
mod motion;

use account::Account;
use frictional::{Explicit, MoreauJean};
use implicit::Implicit;
use motion::{Counts, Motion, Step};

const USAGE: &str = "\
usage: schemes METHOD SYSTEM.json STEP ATOL INTERVAL HISTORY.bin

METHOD is one of
  backward-euler    order 1
  midpoint          implicit midpoint rule, order 2
  energy            the same with the one-sided springs' force from their energy: conserves it to the last bit of the iteration
  theta             Moreau-Jean's, theta = 1/2, with friction by equation (6), by Newton's method
  tr-bdf2           order 2, L-stable, Concio's default
  esdirk4           ESDIRK4(3)6L[2]SA, order 4, L-stable
  moreau-jean       theta = 1/2, friction set-valued, by projected Gauss-Seidel
  moreau-jean-1     theta = 1
  moreau-jean-law   theta = 1/2, friction by equation (6), by Gauss-Seidel: `theta` solved another way
  explicit          central differences, friction set-valued and implicit
  explicit-law      central differences, friction by equation (6), implicit";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments == ["--version"] {
        println!("schemes of peers/schemes");
        return ExitCode::SUCCESS;
    }
    match solve(&arguments) {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn solve(arguments: &[String]) -> Result<String, Box<dyn Error>> {
    let [method, path, step, _, interval, out] = arguments else { return Err(USAGE.into()) };
    let system = System::read(path)?;
    if system
        .joints
        .iter()
        .any(|j| matches!(j.b, peer_system::Side::Block(_)) && j.normal_force[0] != j.normal_force[1])
    {
        return Err("action and reaction of friction differ: not for these schemes".into());
    }
    let (step, interval): (f64, f64) = (step.parse()?, interval.parse()?);
    let mut scheme: Box<dyn Step> = match method.as_str() {
        "backward-euler" | "midpoint" | "energy" | "theta" | "tr-bdf2" | "esdirk4" => {
            Box::new(Implicit::new(&system, method))
        }
        "moreau-jean" => Box::new(MoreauJean::new(&system, 0.5, true)),
        "moreau-jean-1" => Box::new(MoreauJean::new(&system, 1.0, true)),
        "moreau-jean-law" => Box::new(MoreauJean::new(&system, 0.5, false)),
        "explicit" => Box::new(Explicit::new(&system, true)),
        "explicit-law" => Box::new(Explicit::new(&system, false)),
        _ => return Err(USAGE.into()),
    };
    let (mut motion, mut account, mut counts) = (Motion::at_rest(&system), Account::new(&system), Counts::default());
    let steps = (system.duration / step).round().max(1.0);
    let h = system.duration / steps;
    let samples = (system.duration / interval * (1.0 + 1e-12) + 1e-9).floor() as usize;
    let (mut history, mut sample) = (Vec::new(), 1);
    let start = Instant::now();
    for k in 0..steps as u64 {
        let before = motion.clone();
        motion.t = k as f64 * h;
        scheme.step(&system, &mut motion, h, &mut counts).map_err(|why| format!("t = {} s: {why}", motion.t))?;
        motion.t = (k + 1) as f64 * h;
        account.add(&system, &before, &motion, h);
        while sample <= samples && sample as f64 * interval <= motion.t + 1e-9 * interval {
            let part = 1.0 - (motion.t - sample as f64 * interval).max(0.0) / h;
            history.extend(before.z.iter().zip(&motion.z).map(|(a, b)| a + part * (b - a)));
            sample += 1;
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    std::fs::write(out, history.iter().flat_map(|v: &f64| v.to_le_bytes()).collect::<Vec<u8>>())?;
    Ok(json!({
        "steps": steps as u64,
        "iterations": counts.iterations,
        "factorisations": counts.factorisations,
        "unconverged": counts.unconverged,
        "events": account.events,
        "solve_seconds": seconds,
        "peak_relative_displacement": history.iter().fold(0.0, |m: f64, z| m.max(z.abs())),
        "top_work": account.work,
        "top_force_peak": account.largest,
        "top_force_rms": (account.square / system.duration).sqrt(),
        "slip": account.slip,
    })
    .to_string())
}
