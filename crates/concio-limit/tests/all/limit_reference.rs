//! Every multiplier of the reference walls kept beside the repository, computed by another program. Skipped with one line
//! where they are not there.

use std::path::{Path, PathBuf};

use concio_limit::{Heads, Options, Push, Stop, Towards};
use serde_json::Value;

use crate::limit_walls::{DryWall, FRICTIONLESS, certified, pushed, tilted};

const TOP: Options = Options { heads: Heads::AsGiven, push: Push::Top, towards: Towards::Right };

fn reference() -> Option<Value> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("CONCIO_SHARED").map_or(beside, PathBuf::from);
    let Ok(text) = std::fs::read_to_string(folder.join("reference/limit-analysis.json")) else {
        concio_verified::skip("reference multipliers (shared/ not found)");
        return None;
    };
    Some(serde_json::from_str(&text).expect("JSON"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn pair(value: &Value) -> [f64; 2] {
    [number(&value[0]), number(&value[1])]
}

fn count(value: &Value) -> usize {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no count")) as usize
}

fn members(value: &Value) -> impl Iterator<Item = (&String, &Value)> {
    value.as_object().expect("an object").iter()
}

fn close(what: &str, found: f64, expected: &Value) {
    let error = (found - number(expected)).abs() / number(expected);
    assert!(error <= 1e-4, "{what}: {found} instead of {expected} (relative error {error:.1e})");
}

/// A wall of λ that moves between 0.97 times the frictionless and 1.01 times the associative λ when tilted slowly.
fn moves_between(what: &str, wall: &DryWall, [frictionless, associative]: [f64; 2]) {
    let found = tilted(wall, 1.2 * associative);
    println!("{what}: {frictionless:.4} … {found:.4} … {associative:.4}");
    assert!(found >= 0.97 * frictionless && found <= 1.01 * associative, "{what}: {found}");
}

/// M. C. Ferris and F. Tin-Loi, International Journal of Mechanical Sciences 43 (2001) 209–224.
#[test]
fn walls_of_ferris_and_tin_loi() {
    let Some(reference) = reference() else { return };
    let mut walls = 0;
    for (name, entry) in members(&reference["ferris_tinloi"]) {
        let rows = entry["pattern_bottom_up"].as_array().expect("courses");
        let rows: Vec<Vec<f64>> =
            rows.iter().map(|r| r.as_array().expect("a course").iter().map(number).collect()).collect();
        let width = |row: &Vec<f64>| row.iter().map(|l| l.abs()).sum::<f64>();
        assert!(rows.iter().all(|row| width(row) == width(&rows[0])), "{name}: courses of one width");
        let wall = DryWall::pattern(&rows, pair(&entry["brick"]), number(&entry["mu"]));
        let problem = wall.problem(Options::default());
        assert_eq!(problem.assembly.bodies.len(), count(&entry["n_blocks"]), "{name}: blocks");
        assert_eq!(problem.joints.len(), count(&entry["n_contacts"]), "{name}: joints");
        let limit = wall.limit(Options::default());
        close(name, certified(&limit), &entry["lam_assoc"]);
        let frictionless = certified(&wall.limit(FRICTIONLESS));
        close(&format!("{name}, frictionless heads"), frictionless, &entry["lam_assoc_frictionless_head"]);
        moves_between(name, &wall, [frictionless, limit.multiplier()]);
        let estimate = &limit.non_associative;
        println!("{name}: without dilation {estimate:?}");
        assert_eq!(estimate.stop, Stop::Converged);
        assert!(estimate.multiplier <= limit.bounds[1] && estimate.multiplier > 0.8 * limit.bounds[0], "{estimate:?}");
        walls += 1;
    }
    assert_eq!(walls, 3);
}

#[test]
fn running_bonds() {
    let Some(reference) = reference() else { return };
    let mut results = 0;
    for (name, entry) in members(&reference["own"]) {
        let brick = [number(&entry["brick_l"]), number(&entry["brick_h"])];
        let (bricks, courses) = (count(&entry["nx"]), count(&entry["ny"]));
        for result in entry["results"].as_array().expect("results") {
            let mu = number(&result["mu"]);
            let half = DryWall::running(bricks, courses, brick, mu, false);
            close(&format!("{name}, μ = {mu}"), half.multiplier(), &result["lam_assoc"]);
            let frictionless = certified(&half.limit(FRICTIONLESS));
            close(&format!("{name}, μ = {mu}, frictionless"), frictionless, &result["lam_assoc_frictionless_heads"]);
            moves_between(&format!("{name}, μ = {mu}"), &half, [frictionless, half.multiplier()]);
            let full = DryWall::running(bricks, courses, brick, mu, true).multiplier();
            close(&format!("{name}, μ = {mu}, full"), full, &result["lam_assoc_first_course_full"]);
            results += 1;
        }
    }
    assert_eq!(results, 12);
}

#[test]
fn stacks() {
    let Some(reference) = reference() else { return };
    for (name, entry) in members(&reference["stacks"]) {
        let wall = DryWall::stack(count(&entry["n"]), pair(&entry["block"]), number(&entry["mu"]));
        close(name, wall.multiplier(), &entry["lam"]);
        close(name, wall.multiplier(), &entry["expected"]);
        moves_between(name, &wall, [wall.multiplier(); 2]);
    }
}

/// Walls under a steel beam that is pushed at its middle, as in the laboratory: the beam is a block of the load's weight.
#[test]
fn shear_walls_under_a_beam() {
    let Some(reference) = reference() else { return };
    let mut walls = 0;
    for (name, entry) in members(&reference["dry_shear_walls"]) {
        let [height, length, load] = ["H", "L", "N_kN"].map(|key| number(&entry[key]));
        let brick = [number(&entry["lb"]), number(&entry["hb"])];
        let (bricks, courses) = ((length / brick[0]).round() as usize, (height / brick[1]).round() as usize);
        for (key, expected) in members(&entry["LP"]) {
            let (mu, first) = key.trim_start_matches("mu").split_once('_').expect("μ and first course");
            let mu = mu.parse().expect("μ");
            let mut wall = DryWall::running(bricks, courses, brick, mu, first == "full");
            wall.weight = 1e3 * number(&entry["W_kN"]) / (height * length);
            let bare = wall.clone();
            // The middle of the beam's block is where it is pushed.
            let beam = 2.0 * (number(&entry["H0"]) - height);
            wall.courses.push(vec![[0.0, length]]);
            wall.heights.push(beam);
            let beam_weight = 1e3 * load / (length * beam);
            let found = certified(&limit_under(&wall, beam_weight, TOP));
            close(&format!("{name}, {key}"), found * load, expected);
            walls += 1;
            // The walls that were tested are the same four over and over.
            if name.starts_with("WS.") {
                let heads = Options { heads: Heads::Frictionless, ..TOP };
                let bounds = [certified(&limit_under(&wall, beam_weight, heads)), found].map(|l| l * load);
                let peak = 1e-3 * pushed(&bare, 1e3 * load / length, beam);
                println!("{name}, {key}: {:.3} … {peak:.3} … {:.3} kN", bounds[0], bounds[1]);
                assert!(peak >= 0.97 * bounds[0] && peak <= 1.01 * bounds[1], "{name}, {key}: {peak}");
            }
        }
    }
    assert_eq!(walls, 56);
}

fn limit_under(wall: &DryWall, beam_weight: f64, options: Options) -> concio_limit::Limit {
    let mut case = wall.case();
    let last = case.panels[0].blocks.last_mut().expect("the beam");
    last.specific_weight = Some(concio::quantity::SpecificWeight::from_si(beam_weight));
    let problem = concio_limit::Problem::of(&case, options).expect("a wall");
    concio_limit::analyse(&problem).expect("a limit")
}
