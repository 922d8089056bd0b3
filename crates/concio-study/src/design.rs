//! Which combinations of the factors' values are run.
//!
//! - Latin hypercube: M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21 (1979) 239–245.
//! - Morris: M. D. Morris, Technometrics 33 (1991) 161–174: from a random base point on a grid of p levels one factor
//!   after the other, in random order, moves by Δ = p/(2(p − 1)). Lists are grids of their own, so that every value may be
//!   drawn; names have no order, and move to any other.
//! - Sobol: A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259–270: base points A and B, and for each factor A
//!   with this factor's column of B; A and B are the two halves of one scrambled Sobol sequence.

use std::collections::BTreeSet;

use concio::Result;
use concio::dice::Dice;

use crate::factors::{Factor, Over};
use crate::file::{DesignKind, StudyFile};

/// How many more runs than factors indices of ranks take: intervals of fewer miss up to two in five of what they estimate.
pub const FREEDOM: usize = 4;
/// Runs that a study may have: each takes some 2 kB before it is done.
pub const MOST_RUNS: usize = 500_000;
/// Values of factors that it may have over all runs.
const MOST_PLACES: usize = 20_000_000;
/// Factors that the Sobol sequence at hand has dimensions for, two each.
const MOST_SOBOL: usize = 128;

/// Points of the Sobol sequence at hand.
const MOST_SOBOL_POINTS: usize = 1 << 16;

/// Values without a run that are named.
const MOST_NAMED: usize = 10;

/// Where a factor stands in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum At {
    /// At one of its levels.
    Level(usize),
    /// At this share of its distribution, 0 … 1.
    Share(f64),
}

/// The points of the design: one row per run, one entry per factor.
///
/// # Errors
/// Factors and design that do not go together, with the line.
pub fn points(file: &StudyFile, factors: &[Factor]) -> Result<Vec<Vec<At>>> {
    let design = &file.study.design;
    let wrong = |what: String, allowed: &str| Err(file.wrong("design", what, allowed));
    if factors.is_empty() {
        return Ok(vec![Vec::new()]);
    }
    let runs = match (design.kind, design.runs) {
        (DesignKind::Grid | DesignKind::List, None) => 0,
        (DesignKind::Grid | DesignKind::List, Some(_)) => {
            return Err(file.wrong("design.runs", "a grid or list has as many runs as its values give", "no `runs`"));
        }
        (_, Some(runs)) if runs >= 1 => runs,
        (_, Some(runs)) => return Err(file.wrong("design.runs", format!("{runs} is out of range"), "from 1")),
        (_, None) => return Err(file.wrong("design.runs", "the key is missing: this design needs it", "from 1")),
    };
    if matches!(design.kind, DesignKind::Grid | DesignKind::List)
        && let Some(factor) = factors.iter().find(|f| f.levels().is_none())
    {
        let what = format!("`{}` has no values for a grid or list", factor.name);
        return Err(file.wrong(
            &factor.key,
            what,
            "`values`, `choices`, `from` with `to` and `count`; or another design",
        ));
    }
    let k = factors.len();
    let total = match design.kind {
        DesignKind::Grid => factors.iter().filter_map(Factor::levels).fold(1usize, usize::saturating_mul),
        DesignKind::List => factors[0].levels().unwrap_or(0),
        DesignKind::LatinHypercube | DesignKind::Random => runs,
        DesignKind::Morris => runs.saturating_mul(k + 1),
        DesignKind::Sobol => runs.saturating_mul(k + 2),
    };
    if total > MOST_RUNS {
        return wrong(format!("{total} runs are too many for one study"), "up to 500,000");
    }
    if total.saturating_mul(k) > MOST_PLACES {
        let what = format!("{total} runs of {k} factors are too many for one study");
        return wrong(what, &format!("up to {} runs of so many factors", MOST_PLACES / k));
    }
    let shares = match design.kind {
        DesignKind::Grid => return Ok(grid(factors)),
        DesignKind::List => return list(file, factors),
        DesignKind::LatinHypercube => latin_hypercube(runs, k, design.seed),
        DesignKind::Random => {
            let mut dice = Dice::new(design.seed);
            (0..runs).map(|_| (0..k).map(|_| dice.unit()).collect()).collect()
        }
        DesignKind::Morris => {
            if design.levels < 4 || design.levels % 2 == 1 {
                let what = format!("{} is out of range", design.levels);
                return Err(file.wrong("design.levels", what, "an even number from 4"));
            }
            suits_morris(file, factors)?;
            let grids: Vec<Grid> = factors.iter().map(|factor| Grid::of(factor, design.levels)).collect();
            return Ok(morris(runs, &grids, design.seed));
        }
        DesignKind::Sobol if k > MOST_SOBOL => return wrong(format!("{k} factors are too many for it"), "up to 128"),
        DesignKind::Sobol if runs > MOST_SOBOL_POINTS => {
            let what = format!("{runs} base points are too many for the sequence");
            return Err(file.wrong("design.runs", what, "up to 65,536"));
        }
        DesignKind::Sobol => sobol(runs, k, design.seed),
    };
    Ok(shares.into_iter().map(|row| row.iter().zip(factors).map(|(s, f)| place(*s, f)).collect()).collect())
}

/// Attempts at a trajectory that no other is.
const ATTEMPTS: usize = 50;
/// Trajectories and base points from which on 95 % intervals hold nine in ten of what they estimate.
const FEWEST_TRAJECTORIES: usize = 5;
const FEWEST_BASE_POINTS: usize = 32;

/// Trajectories move every factor, and go to the ends of its range.
fn suits_morris(file: &StudyFile, factors: &[Factor]) -> Result<()> {
    for factor in factors {
        let mut places = factor.places();
        places.sort_by(f64::total_cmp);
        if let Over::Values(values) = &factor.over {
            if !values.is_bounded() {
                let what = format!(
                    "`{}` is not cut off on both sides: design `morris` goes to the ends of each range, which would lie \
                     4.75 standard deviations off",
                    factor.name
                );
                let allowed =
                    "`low` and `high` within 4.75 standard deviations, such as 2 on either side of the middle";
                return Err(file.wrong(&format!("{}.distribution", factor.key), what, allowed));
            }
        } else if places.len() < 2 {
            let what = format!("`{}` has one value, and design `morris` moves every factor", factor.name);
            return Err(file.wrong(
                &factor.key,
                what,
                "two values or more; what does not vary stands in the wall file",
            ));
        }
    }
    Ok(())
}

fn place(share: f64, factor: &Factor) -> At {
    match (&factor.over, factor.levels()) {
        (Over::Values(_), _) | (_, None) => At::Share(share),
        (_, Some(levels)) => At::Level(((share * levels as f64) as usize).min(levels - 1)),
    }
}

fn grid(factors: &[Factor]) -> Vec<Vec<At>> {
    let mut rows = vec![Vec::new()];
    for factor in factors {
        let levels = factor.levels().unwrap_or(0);
        let with = |row: &Vec<At>, level: usize| row.iter().copied().chain([At::Level(level)]).collect();
        rows = rows.iter().flat_map(|row| (0..levels).map(move |level| with(row, level))).collect();
    }
    rows
}

fn list(file: &StudyFile, factors: &[Factor]) -> Result<Vec<Vec<At>>> {
    let levels = factors[0].levels().unwrap_or(0);
    if let Some(other) = factors.iter().find(|f| f.levels() != Some(levels)) {
        let found = other.levels().unwrap_or(0);
        let what = format!("`{}` has {found} values, `{}` {levels}", other.name, factors[0].name);
        return Err(file.wrong(&other.key, what, "equally many values for each factor of a list"));
    }
    Ok((0..levels).map(|level| vec![At::Level(level); factors.len()]).collect())
}

/// `n` rows of `k` shares: each column has one in every n-th part of 0 … 1.
fn latin_hypercube(n: usize, k: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut dice = Dice::new(seed);
    let mut rows = vec![vec![0.0; k]; n];
    for column in 0..k {
        let mut layers: Vec<usize> = (0..n).collect();
        dice.shuffle(&mut layers);
        for (row, layer) in rows.iter_mut().zip(layers) {
            row[column] = (layer as f64 + dice.unit()) / n as f64;
        }
    }
    rows
}

/// What a trajectory moves a factor over.
enum Grid {
    /// So many shares of a distribution, equally far from each other.
    Shares(usize),
    /// Levels in the order of their values.
    Rising(Vec<usize>),
    /// Levels without an order, in that of their names: what is drawn does not depend on how they are listed.
    Names(Vec<usize>),
}

impl Grid {
    /// Of a factor; `shares` for one with a distribution.
    fn of(factor: &Factor, shares: usize) -> Grid {
        let Some(levels) = factor.levels() else { return Grid::Shares(shares) };
        let mut order: Vec<usize> = (0..levels).collect();
        if let Over::Levels(all) = &factor.over
            && all.iter().any(|level| level.place.is_none())
        {
            order.sort_by_key(|level| all[*level].label.to_string());
            return Grid::Names(order);
        }
        let places = factor.places();
        order.sort_by(|a, b| places[*a].total_cmp(&places[*b]));
        Grid::Rising(order)
    }

    fn len(&self) -> usize {
        match self {
            Grid::Shares(levels) => *levels,
            Grid::Rising(order) | Grid::Names(order) => order.len(),
        }
    }

    fn at(&self, level: usize) -> At {
        match self {
            Grid::Shares(levels) => At::Share(level as f64 / (levels - 1) as f64),
            Grid::Rising(order) | Grid::Names(order) => At::Level(order[level]),
        }
    }

    /// Half of the levels away, up from the lower half and down from the upper, either way from the middle one; any other name.
    fn moved(&self, level: usize, dice: &mut Dice) -> usize {
        let (n, half) = (self.len(), self.len() / 2);
        match self {
            Grid::Names(_) => (level + 1 + dice.below(n - 1)) % n,
            _ if n % 2 == 1 && level == half => 2 * half * dice.below(2),
            _ if level < half => level + half,
            _ => level - half,
        }
    }
}

/// Trajectories of one point more than there are factors.
fn morris(trajectories: usize, grids: &[Grid], seed: u64) -> Vec<Vec<At>> {
    let mut dice = Dice::new(seed);
    let mut known: BTreeSet<Vec<Vec<usize>>> = BTreeSet::new();
    let mut rows = Vec::new();
    for _ in 0..trajectories {
        let mut trajectory = Vec::new();
        // One that was run before, forwards or backwards, would count as an effect of its own.
        for _ in 0..ATTEMPTS {
            let mut point: Vec<usize> = grids.iter().map(|grid| dice.below(grid.len())).collect();
            let mut order: Vec<usize> = (0..grids.len()).collect();
            dice.shuffle(&mut order);
            trajectory = vec![point.clone()];
            for factor in order {
                point[factor] = grids[factor].moved(point[factor], &mut dice);
                trajectory.push(point.clone());
            }
            let mut points = trajectory.clone();
            points.sort_unstable();
            if known.insert(points) {
                break;
            }
        }
        let at = |point: &Vec<usize>| point.iter().zip(grids).map(|(level, grid)| grid.at(*level)).collect();
        rows.extend(trajectory.iter().map(at));
    }
    rows
}

/// What is to be known of indices of so many `factors` with an order from fewer `runs`, trajectories or base points than they or their intervals take.
pub fn scarce(kind: DesignKind, runs: usize, factors: usize) -> Option<String> {
    let (least, told) = match kind {
        DesignKind::Morris => (FEWEST_TRAJECTORIES, ["trajectories hold a normal law at best", "two in five"]),
        DesignKind::Sobol => (FEWEST_BASE_POINTS, ["base points may be too narrow", "one in five"]),
        _ => {
            let least = factors + FREEDOM;
            return (factors > 0 && runs < least)
                .then(|| format!("{runs} runs give no rank coefficients of {factors} factors: it takes {least}"));
        }
    };
    let [narrow, miss] = told;
    (runs < least).then(|| {
        format!(
            "design.runs = {runs}: intervals of so few {narrow}: of fewer than {least} up to {miss} miss what they estimate"
        )
    })
}

/// Levels that no run has: what is said of a factor then tells nothing of them.
pub fn unreached(factors: &[Factor], points: &[Vec<At>]) -> Vec<String> {
    let of = |(k, factor): (usize, &Factor)| {
        let levels = factor.levels()?;
        let mut reached = vec![false; levels];
        for at in points.iter().map(|row| row[k]) {
            if let At::Level(level) = at {
                reached[level] = true;
            }
        }
        let lost: Vec<String> = (0..levels).filter(|&level| !reached[level]).map(|level| factor.label(level)).collect();
        let more = lost.len().saturating_sub(MOST_NAMED);
        let named =
            lost[..lost.len() - more].join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() };
        (!lost.is_empty()).then(|| {
            format!(
                "no run has {} of the {levels} values of `{}`: {named}; more `runs` reach them",
                lost.len(),
                factor.name
            )
        })
    };
    factors.iter().enumerate().filter_map(of).collect()
}

/// A (n rows), B (n), then per factor A with its column of B (n each).
fn sobol(n: usize, k: usize, seed: u64) -> Vec<Vec<f64>> {
    let scramble = (seed ^ (seed >> 32)) as u32;
    let row = |i: usize, from: usize| -> Vec<f64> {
        (0..k).map(|d| f64::from(sobol_burley::sample(i as u32, (from + d) as u32, scramble))).collect()
    };
    let a: Vec<Vec<f64>> = (0..n).map(|i| row(i, 0)).collect();
    let b: Vec<Vec<f64>> = (0..n).map(|i| row(i, k)).collect();
    let mut rows: Vec<Vec<f64>> = a.iter().chain(&b).cloned().collect();
    for factor in 0..k {
        rows.extend(a.iter().zip(&b).map(|(a, b)| {
            let mut mixed = a.clone();
            mixed[factor] = b[factor];
            mixed
        }));
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layer_of_a_latin_hypercube_is_used_once() {
        let rows = latin_hypercube(50, 3, 7);
        for column in 0..3 {
            let mut layers: Vec<usize> = rows.iter().map(|r| (r[column] * 50.0) as usize).collect();
            layers.sort_unstable();
            assert_eq!(layers, (0..50).collect::<Vec<_>>());
        }
        assert_ne!(rows, latin_hypercube(50, 3, 8));
    }

    #[test]
    fn one_factor_moves_at_a_time_on_a_trajectory() {
        let grids =
            [Grid::Shares(6), Grid::Rising(vec![3, 0, 2, 1]), Grid::Rising(vec![0, 1, 2]), Grid::Names(vec![1, 2, 0])];
        let k = grids.len();
        let number = |at: &At, grid: &Grid| match (at, grid) {
            (At::Level(level), Grid::Rising(order) | Grid::Names(order)) => {
                order.iter().position(|l| l == level).map_or(f64::NAN, |l| l as f64)
            }
            (At::Share(share), _) => *share,
            _ => f64::NAN,
        };
        let mut steps = vec![Vec::new(); k];
        for trajectory in morris(60, &grids, 3).chunks(k + 1) {
            let mut moved = vec![0; k];
            for pair in trajectory.windows(2) {
                let differ: Vec<usize> = (0..k).filter(|&f| pair[0][f] != pair[1][f]).collect();
                assert_eq!(differ.len(), 1);
                let f = differ[0];
                moved[f] += 1;
                let [from, to] = [0, 1].map(|i| number(&pair[i][f], &grids[f]));
                steps[f].push([from, to]);
            }
            assert_eq!(moved, vec![1; k]);
        }
        let sizes = |f: usize| steps[f].iter().map(|[from, to]| (to - from).abs());
        assert!(sizes(0).all(|s| (s - 0.6).abs() < 1e-12), "half of six shares");
        assert!(sizes(1).all(|s| s == 2.0), "half of four values");
        assert!(sizes(2).all(|s| s == 1.0), "half of three values, from and to the middle one");
        for names in [0.0, 1.0, 2.0] {
            for other in [0.0, 1.0, 2.0] {
                assert_eq!(steps[3].contains(&[names, other]), names != other, "{names} {other}");
            }
        }
    }

    #[test]
    fn sobol_rows_mix_two_samples_column_by_column() {
        let (n, k) = (64, 3);
        let rows = sobol(n, k, 5);
        assert_eq!(rows.len(), n * (k + 2));
        for i in 0..n {
            for f in 0..k {
                let mixed = &rows[(2 + f) * n + i];
                for d in 0..k {
                    assert_eq!(mixed[d], if d == f { rows[n + i][d] } else { rows[i][d] });
                }
            }
        }
        // Evenly spread: the mean of 64 points lies far nearer to 1/2 than that of independent draws (0.036).
        for d in 0..k {
            let mean = rows[..n].iter().map(|r| r[d]).sum::<f64>() / n as f64;
            assert!((mean - 0.5).abs() < 5e-3, "{mean}");
        }
    }
}
