//! Dry walls block by block.

use std::fmt::Write as _;

use concio::case::{Case, Syntax, from_str};
use concio_limit::{Limit, Options, Problem, analyse};

/// A dry wall of blocks `[x, length]` by courses from the bottom.
#[derive(Debug, Clone)]
pub struct DryWall {
    pub courses: Vec<Vec<[f64; 2]>>,
    pub heights: Vec<f64>,
    pub mu: f64,
    /// γ [N/m³].
    pub weight: f64,
    /// Keys of `[load]`.
    pub load: String,
}

impl DryWall {
    pub fn new(courses: Vec<Vec<[f64; 2]>>, height: f64, mu: f64) -> Self {
        let heights = vec![height; courses.len()];
        DryWall { courses, heights, mu, weight: 20e3, load: String::new() }
    }

    /// `number` blocks one on the other.
    pub fn stack(number: usize, [length, height]: [f64; 2], mu: f64) -> Self {
        DryWall::new(vec![vec![[0.0, length]]; number], height, mu)
    }

    /// Courses of lengths in bricks, from x = 0; a negative one is an opening.
    #[allow(dead_code)]
    pub fn pattern(lengths: &[Vec<f64>], [length, height]: [f64; 2], mu: f64) -> Self {
        let row = |row: &Vec<f64>| {
            let mut x = 0.0;
            let mut blocks = Vec::new();
            for part in row {
                if *part > 0.0 {
                    blocks.push([x, part * length]);
                }
                x += part.abs() * length;
            }
            blocks
        };
        DryWall::new(lengths.iter().map(row).collect(), height, mu)
    }

    /// A running bond, `bricks` wide, its first course of whole bricks or with half ones at its ends.
    #[allow(dead_code)]
    pub fn running(bricks: usize, courses: usize, brick: [f64; 2], mu: f64, full: bool) -> Self {
        let whole = vec![1.0; bricks];
        let halves = [vec![0.5], vec![1.0; bricks - 1], vec![0.5]].concat();
        let row = |k: usize| if k.is_multiple_of(2) == full { whole.clone() } else { halves.clone() };
        DryWall::pattern(&(0..courses).map(row).collect::<Vec<_>>(), brick, mu)
    }

    pub fn case(&self) -> Case {
        let mut text = format!(
            "model = \"shear\"\n[[panel]]\nbond = \"explicit\"\n\
             brick = {{ length = 1.0, height = 1.0, thickness = 1.0, specific_weight = {:e} }}\n",
            self.weight
        );
        let mut y = 0.0;
        for (number, (row, height)) in self.courses.iter().zip(&self.heights).enumerate() {
            for [x, length] in row {
                let _ = writeln!(
                    text,
                    "[[panel.block]]\ncourse = {}\nx = {x:?}\ny = {y:?}\nlength = {length:?}\nheight = {height:?}",
                    number + 1
                );
            }
            y += height;
        }
        let _ = write!(
            text,
            "[joint]\nbed = {{ law = \"elastic\", stiffness = 1e8 }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = {mu:?}, dynamic = {mu:?}, on = \"all\" }}\n\
             [load]\n{}\n[motion]\nduration = 1.0\n",
            self.load,
            mu = self.mu
        );
        let file = from_str(&text, Syntax::Toml, None).expect("a wall file");
        file.validate().expect("a valid wall");
        file.case
    }

    pub fn problem(&self, options: Options) -> Problem {
        Problem::of(&self.case(), options).expect("a wall")
    }

    pub fn limit(&self, options: Options) -> Limit {
        analyse(&self.problem(options)).expect("a limit")
    }

    /// λ towards the right under its own weight, bounds checked.
    #[allow(dead_code)]
    pub fn multiplier(&self) -> f64 {
        certified(&self.limit(Options::default()))
    }
}

/// λ, once forces and mechanism have agreed on it to 1e-9.
pub fn certified(limit: &Limit) -> f64 {
    let [lower, upper] = limit.bounds;
    assert!((upper - lower).abs() <= 1e-9 * upper.abs().max(1e-3), "{lower} … {upper}");
    limit.multiplier()
}
