//! Dry walls block by block.

use std::fmt::Write as _;
use std::path::Path;

use concio::case::{Beam, Case, ModelKind, Spring, SpringLaw, Syntax, from_str};
use concio::quantity::{Length, Time};
use concio::run::prepare_case;
use concio::simulate::{Progress, Simulation};
use concio_limit::{Heads, Limit, Options, Problem, Push, Towards, analyse};

/// Under horizontal body force, head joints without friction.
#[allow(dead_code)]
pub const FRICTIONLESS: Options = Options { heads: Heads::Frictionless, push: Push::Body, towards: Towards::Right };

/// Displacement at which a wall counts as moving [m]: what a mechanism covers within a few thousandths of the ramp.
const MOVING: f64 = 1e-5;

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

/// The wall with rigid joints, its blocks free to rise and turn, without inertia.
fn planar(wall: &DryWall, motion: &str) -> Case {
    let mut case = wall.case();
    case.model = ModelKind::Planar;
    let rigid = |spring: Spring| Spring { law: SpringLaw::Rigid, ..spring };
    (case.joint.bed, case.joint.head) = (rigid(case.joint.bed), rigid(case.joint.head));
    case.motion = serde_json::from_str(motion).expect("a motion");
    case.motion.quasi_static = true;
    case
}

fn simulation(case: Case, each: impl FnMut(&mut Simulation) -> bool) {
    let prepared = prepare_case(case, Path::new(".")).expect("a wall");
    let mut run = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling).expect("a run");
    let mut each = each;
    while each(&mut run) {
        run.clear_recording();
    }
    assert!(run.state().totals.contact_residual < 1e-5, "{:e}", run.state().totals.contact_residual);
}

/// Base acceleration over g at which a block moves, by the planar model under a ramp of 1,000 steps up to `most`.
#[allow(dead_code)]
pub fn tilted(wall: &DryWall, most: f64) -> f64 {
    // The base goes to the left, the blocks are pushed to the right.
    let acceleration = -most * concio::G;
    let case = planar(
        wall,
        &format!(r#"{{ "base": {{ "tilt": {{ "acceleration": {acceleration:?}, "rise": 20 }} }}, "duration": 20 }}"#),
    );
    let mut time = 0.0;
    simulation(case, |run| {
        time = run.time();
        let moves = run.state().totals.peak_relative_displacement >= MOVING;
        assert!(moves || run.advance(1) == Progress::Running, "it moves");
        !moves
    });
    most * time / 20.0
}

/// Largest force of a driven beam on its way over 2 mm [N], which presses with `load` [N/m] and is `height` high [m], by the planar
/// model in steps of 0.02 mm.
#[allow(dead_code)]
pub fn pushed(wall: &DryWall, load: f64, height: f64) -> f64 {
    let mut case =
        planar(wall, r#"{ "top": { "path": { "displacements": ["2 mm"], "speed": "1 mm/s" } }, "duration": 2 }"#);
    case.load.beam = Beam::Driven;
    case.load.top = load.into();
    case.load.beam_height = Some(Length::from_si(height));
    case.solver.step = Some(Time::from_si(0.02));
    let mut peak = 0.0;
    simulation(case, |run| {
        peak = run.state().totals.top_force_peak;
        run.advance(1) == Progress::Running
    });
    peak
}
