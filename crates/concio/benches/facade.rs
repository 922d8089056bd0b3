//! How the cost of a step grows with a façade: `cargo bench -p concio --bench facade [-- SECONDS]`.
//!
//! The façade of `examples/large`, 1,035 stones with a door and five windows, and the same made two to five times as long by more of its
//! openings, under 0.4 g from rest for 0.6 s unless said. They go in turn, three rounds of the same steps; printed are iterations per step,
//! the time per block and step over that of the shortest in the same round, the least and the median of it, and what each block costs that a
//! façade has more than the next shorter one over the mean of all that came after the shortest, from the quietest rounds: 1 where cost is linear.

use std::path::Path;
use std::time::Instant;

use concio::Result;
use concio::case::{Syntax, from_str};
use concio::run::{Prepared, prepare_case};
use concio::simulate::{Progress, Simulation};

const ROUNDS: usize = 3;
const LONGEST: usize = 5;
/// The façade, and bricks and metres after which its openings come again.
const FACADE: &str = include_str!("../../../examples/large/facade.toml");
const BRICKS: usize = 33;
const LENGTH: f64 = 13.2;

fn replaced(text: &str, what: &str, by: &str) -> String {
    assert!(text.contains(what), "the example has other numbers: {what}");
    text.replace(what, by)
}

/// The façade so many times as long.
fn facade(times: usize) -> Result<Prepared> {
    let (head, rest) = FACADE.split_once("[[panel.opening]]").expect("openings");
    let (openings, rest) = rest.split_once("[joint]").expect("joints after them");
    let mut text = replaced(head, &format!("bricks = {BRICKS}\n"), &format!("bricks = {}\n", times * BRICKS));
    for shift in 0..times {
        text += "[[panel.opening]]";
        for line in openings.split_inclusive('\n') {
            let at = line.strip_prefix("x = \"").and_then(|rest| rest.split_once(" m\"")).map(|(number, _)| number);
            match at.and_then(|number| number.parse::<f64>().ok()) {
                Some(x) => text += &format!("x = \"{:.1} m\"\n", x + shift as f64 * LENGTH),
                None => text += line,
            }
        }
    }
    text += "[joint]";
    text += &replaced(rest, "1.6 g", "0.4 g");
    let file = from_str(&text, Syntax::Toml, None)?;
    file.validate()?;
    prepare_case(file.case, Path::new(""))
}

/// Seconds per block and step, and iterations per step; halves of a step are part of it.
fn shaken(prepared: &Prepared, seconds: f64) -> Result<(f64, f64)> {
    let mut run = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?;
    let begun = Instant::now();
    let mut steps = 0.0;
    while run.time() < seconds {
        assert!(matches!(run.advance(1), Progress::Running), "a façade is shaken for less than its three seconds");
        run.clear_recording();
        steps += 1.0;
    }
    let time = begun.elapsed().as_secs_f64();
    let counters = run.state().counters;
    Ok((time / steps / prepared.model.wall.blocks.len() as f64, counters.iterations as f64 / steps))
}

fn main() -> Result<()> {
    let seconds = std::env::args().find_map(|a| a.parse().ok()).unwrap_or(0.6);
    let facades = (1..=LONGEST).map(facade).collect::<Result<Vec<_>>>()?;
    let mut ratios = vec![Vec::new(); LONGEST];
    // Blocks, and seconds per step.
    let mut least: Vec<[f64; 2]> = facades.iter().map(|f| [f.model.wall.blocks.len() as f64, f64::INFINITY]).collect();
    let mut iterations = [0.0; LONGEST];
    for _ in 0..ROUNDS {
        let mut shortest = 0.0;
        for (k, facade) in facades.iter().enumerate() {
            let (time, number) = shaken(facade, seconds)?;
            shortest = if k == 0 { time } else { shortest };
            ratios[k].push(time / shortest);
            least[k][1] = least[k][1].min(time * least[k][0]);
            iterations[k] = number;
        }
    }
    let per_block = |[from, to]: [[f64; 2]; 2]| (to[1] - from[1]) / (to[0] - from[0]);
    let mean = per_block([least[0], least[LONGEST - 1]]);
    for (k, ratios) in ratios.iter_mut().enumerate() {
        ratios.sort_by(f64::total_cmp);
        let more = if k > 0 {
            format!(", of one more {:.2}", per_block([least[k - 1], least[k]]) / mean)
        } else {
            String::new()
        };
        println!(
            "{:>5} blocks: {:.1} iterations per step, time per block and step {:.2}, {:.2}{more}",
            least[k][0],
            iterations[k],
            ratios[0],
            ratios[ROUNDS / 2]
        );
    }
    Ok(())
}
