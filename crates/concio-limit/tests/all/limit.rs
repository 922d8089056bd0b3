//! Collapse multipliers against closed forms, and what a mechanism and its forces have to obey.

use concio::quantity::Length;
use concio_limit::assembly::Other;
use concio_limit::{Heads, LimitError, MechanismKind, Options, Problem, Push, Stop, Towards, analyse};
use concio_verified::agrees;
use proptest::prelude::*;

use crate::limit_walls::{DryWall, certified};

const LEFT: Options = Options { towards: Towards::Left, push: Push::Body, heads: Heads::AsGiven };
const TOP: Options = Options { push: Push::Top, towards: Towards::Right, heads: Heads::AsGiven };

fn close(what: &str, found: f64, expected: f64, relative: f64) {
    let error = (found - expected).abs() / expected.abs();
    assert!(error <= relative, "{what}: {found} instead of {expected} (relative error {error:.1e})");
}

/// A block slides at μ or turns about its foot at b/h.
#[test]
fn a_block_slides_or_turns() {
    for ([length, height], mu) in [([1.0, 3.0], 0.1), ([1.0, 3.0], 0.4), ([1.0, 1.0], 0.7), ([2.0, 0.5], 0.9)] {
        let wall = DryWall::stack(1, [length, height], mu);
        let expected = f64::min(mu, length / height);
        for options in [Options::default(), LEFT, TOP] {
            let limit = wall.limit(options);
            let way = match (options.towards, options.push) {
                (Towards::Left, _) => "to the left",
                (_, Push::Top) => "at the top",
                _ => "to the right",
            };
            let of = |what: &str| format!("Limit analysis: block, {what}; {length} × {height}, μ = {mu}, pushed {way}");
            agrees!(of("associative"), "min(μ, b/h)", "", certified(&limit), expected, 1e-9);
            let kind = if mu < length / height { MechanismKind::Sliding } else { MechanismKind::Overturning };
            assert_eq!(limit.mechanism.kind, kind, "{length} × {height}, μ = {mu}");
            assert_eq!(limit.non_associative.stop, Stop::Converged);
            let estimate = limit.non_associative.multiplier;
            agrees!(of("without dilation"), "min(μ, b/h)", "", estimate, expected, 1e-5);
        }
    }
}

/// A squat wall of little friction slides at μ: bricks go at rates of their own, so that head joints open, and none turns.
#[test]
fn what_only_slides_is_no_mixed_mechanism() {
    let limit = DryWall::running(6, 4, [0.4, 0.2], 0.2, true).limit(Options::default());
    agrees!("Limit analysis: squat wall of little friction", "μ", "", certified(&limit), 0.2, 1e-9);
    assert!(limit.mechanism.joints.iter().any(|j| j.opens), "all as one");
    assert_eq!(limit.mechanism.kind, MechanismKind::Sliding);
}

/// A stack turns whole about its foot at b/(n h).
#[test]
fn a_stack_turns_whole() {
    for (number, brick, mu) in
        [(5, [1.0, 1.0], 0.4), (5, [1.0, 1.0], 0.1), (10, [0.5, 0.25], 0.4), (3, [0.3, 0.2], 1.5)]
    {
        let expected = f64::min(mu, brick[0] / (number as f64 * brick[1]));
        let subject = format!("Limit analysis: stack of blocks; {number} of {} × {}, μ = {mu}", brick[0], brick[1]);
        let found = DryWall::stack(number, brick, mu).multiplier();
        agrees!(subject, "min(μ, b/(n h))", "", found, expected, 1e-9);
    }
}

/// Two blocks pushed at the upper one: it slides at μ or turns at b/h, both turn at 2 b/(3 h).
#[test]
fn the_top_course_is_pushed() {
    for ([length, height], mu, expected) in
        [([1.0, 1.0], 0.9, 2.0 / 3.0), ([1.0, 1.0], 0.3, 0.3), ([0.3, 0.6], 2.0, 1.0 / 3.0)]
    {
        let subject = format!("Limit analysis: two blocks, pushed at the upper one; {length} × {height}, μ = {mu}");
        let found = certified(&DryWall::stack(2, [length, height], mu).limit(TOP));
        agrees!(subject, "min(μ, b/h, 2 b/(3 h))", "", found, expected, 1e-9);
    }
    // A load of as much as a block's weight W, with its mass on the top: λ (W 3h/2 + W 2h) = (3 W) b/2 at the foot.
    let mut wall = DryWall::stack(2, [1.0, 1.0], 0.9);
    wall.load = format!("top = {:?}", wall.weight);
    let [top, weights] = [TOP, Options::default()].map(|options| certified(&wall.limit(options)));
    let against = "balance of moments about the foot";
    agrees!(
        "Limit analysis: two blocks under a load with mass, pushed at the upper one",
        against,
        "",
        top,
        1.5 / 3.5,
        1e-9
    );
    agrees!("Limit analysis: two blocks under a load with mass", against, "", weights, 1.5 / 4.0, 1e-9);
    // One without mass presses alone, and pushes in the middle of its block where the dead load of the top is what pushes.
    wall.load += "\nmass = 0";
    let [top, weights] = [TOP, Options::default()].map(|options| certified(&wall.limit(options)));
    agrees!(
        "Limit analysis: two blocks under a load without mass, pushed at the upper one",
        against,
        "",
        top,
        1.5 / 3.0,
        1e-9
    );
    agrees!("Limit analysis: two blocks under a load without mass", against, "", weights, 1.5 / 2.0, 1e-9);
}

/// A pier turns over at b/h beside a wall that it does not touch, across an open joint of whichever width; where their sides touch, they lean on each other.
#[test]
fn an_open_joint_bears_nothing() {
    let wall = |courses: usize, gap: f64, law: &str| {
        let panel = |bond: &str, bricks: usize, rest: &str| {
            format!(
                "[[panel]]\nbond = \"{bond}\"\ncourses = {courses}\nbricks = {bricks}\n{rest}\
                 brick = {{ length = 0.5, height = {}, thickness = 0.3, specific_weight = 20e3 }}\n",
                2.0 / courses as f64
            )
        };
        let (pier, squat) = (panel("stack", 1, ""), panel("running", 6, &format!("connection = {gap}\n")));
        let text = format!(
            "model = \"planar\"\n{pier}{squat}[joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             connection = {{ law = \"{law}\" }}\nfriction = {{ law = \"coulomb\", static = 0.7, dynamic = 0.7, on = \"all\" }}\n\
             [motion]\nduration = 1"
        );
        concio::case::from_str(&text, concio::case::Syntax::Toml, None).expect("a wall file").case
    };
    let found = |case: &concio::case::Case, options: Options| {
        certified(&analyse(&Problem::of(case, options).expect("a problem")).expect("a limit"))
    };
    for (courses, gap) in [(1, 0.03), (8, 0.03), (8, 0.3)] {
        for options in [Options::default(), LEFT] {
            let way = if options.towards == Towards::Left { "left" } else { "right" };
            let subject = format!("Limit analysis: pier beside a wall; {courses} courses, {gap} m, to the {way}");
            agrees!(subject, "b/h", "", found(&wall(courses, gap, "none"), options), 0.25, 1e-9);
        }
    }
    // Touching stones are those of a rigid joint.
    for options in [Options::default(), LEFT] {
        let [touching, rigid] = ["none", "rigid"].map(|law| found(&wall(8, 0.0, law), options));
        close("λ of stones that touch", touching, rigid, 1e-9);
        assert!(rigid > 0.3, "{rigid}");
    }
}

/// A beam of weight Q pushed at its underside turns with the block under it: λ (W h/2 + Q h) = (W + Q) b/2.
#[test]
fn a_beam_with_mass_is_one_more_body() {
    let mut wall = DryWall::stack(1, [1.0, 1.0], 0.9);
    let (weight, beam) = (20e3, 40e3);
    wall.load = format!("top = {beam:?}\nbeam = {{ mass = {:?} }}", beam / 9.81);
    // The beam is half as high as the stone, and its mass in its middle.
    let expected = (weight + beam) * 0.5 / (0.5 * weight + 1.25 * beam);
    let found = certified(&wall.limit(Options::default()));
    let against = "balance of moments of block and beam about the foot";
    agrees!("Limit analysis: block under a beam with mass", against, "", found, expected, 1e-9);
    wall.mu = 0.2;
    let found = certified(&wall.limit(Options::default()));
    agrees!("Limit analysis: block under a beam with mass, μ = 0.2", "μ", "", found, 0.2, 1e-9);
    wall.load = "beam = \"tied\"".into();
    let error = Problem::of(&wall.case(), Options::default()).expect_err("a held top").to_string();
    assert!(error.contains("load.beam") && error.contains("allowed"), "{error}");
}

/// A stone on mortar turns about the foot of the mortar, as in a run: λ = (ℓ/2)/(t_b + h/2).
#[test]
fn mortar_on_the_base_lifts_the_stone() {
    for bed in [0.0, 0.01, 0.1] {
        let mut case = DryWall::stack(1, [0.2, 0.4], 2.0).case();
        case.panels[0].mortar.bed = Length::from_si(bed);
        case.panels[0].blocks[0].y = Some(Length::from_si(bed));
        let problem = Problem::of(&case, Options::default()).expect("a problem");
        let found = certified(&analyse(&problem).expect("a limit"));
        let subject = format!("Limit analysis: stone on mortar; {bed} m");
        agrees!(subject, "(ℓ/2)/(t_b + h/2)", "", found, 0.1 / (bed + 0.2), 1e-9);
    }
}

#[test]
fn a_wall_that_falls_by_itself_has_no_multiplier() {
    let wall = DryWall::new(vec![vec![[0.0, 1.0]], vec![[0.6, 1.2]]], 0.5, 0.7);
    let found = analyse(&wall.problem(Options::default()));
    assert_eq!(found.map(|l| l.bounds).expect_err("it falls"), LimitError::DoesNotStand);
}

/// Forces in balance within the cones, a mechanism that obeys the flow rule, and their powers equal to λ: from the public
/// results alone.
#[test]
fn forces_and_mechanism_obey_their_equations() {
    for (mu, options) in [(0.65, Options::default()), (0.65, LEFT), (0.8, TOP), (0.3, Options::default())] {
        let problem = DryWall::running(4, 8, [0.25, 0.12], mu, false).problem(options);
        let limit = analyse(&problem).expect("a limit");
        let lambda = certified(&limit);
        let bodies = &problem.assembly.bodies;
        let scale = problem.dead.iter().map(|d| d[1].abs()).fold(0.0, f64::max);
        let load = |i: usize, k: usize| problem.dead[i][k] + lambda * problem.live[i][k];
        let mut sums: Vec<[f64; 3]> = (0..bodies.len()).map(|i| [load(i, 0), load(i, 1), 0.0]).collect();
        let velocity = |body: usize, at: [f64; 2]| {
            let (v, c) = (limit.mechanism.velocities[body], bodies[body].centre);
            [v[0] - v[2] * (at[1] - c[1]), v[1] + v[2] * (at[0] - c[0])]
        };
        for ((point, force), mu) in problem.assembly.points.iter().zip(&limit.forces).zip(&problem.friction) {
            assert!(force[0] >= 0.0 && force[1].abs() <= mu * force[0] + 1e-12 * scale, "{force:?}");
            let (n, t) = (point.normal, point.tangent());
            let f = [0, 1].map(|k| n[k] * force[0] + t[k] * force[1]);
            let mut relative = velocity(point.a, point.at).map(|v| -v);
            let mut push = |body: usize, f: [f64; 2]| {
                let r = [0, 1].map(|k| point.at[k] - bodies[body].centre[k]);
                let add = [f[0], f[1], r[0] * f[1] - r[1] * f[0]];
                sums[body].iter_mut().zip(add).for_each(|(s, a)| *s += a);
            };
            push(point.a, f.map(|f| -f));
            if let Other::Body(b) = point.b {
                push(b, f);
                let v = velocity(b, point.at);
                relative = [relative[0] + v[0], relative[1] + v[1]];
            }
            let along = |d: [f64; 2]| relative[0] * d[0] + relative[1] * d[1];
            assert!(along(n) >= mu * along(t).abs() - 1e-12, "opening {} slip {}", along(n), along(t));
        }
        assert!(sums.iter().flatten().all(|s| s.abs() <= 1e-9 * scale), "{sums:?}");
        let power = |loads: &[[f64; 2]]| -> f64 {
            let of = |(l, v): (&[f64; 2], &[f64; 3])| l[0] * v[0] + l[1] * v[1];
            loads.iter().zip(&limit.mechanism.velocities).map(of).sum()
        };
        let way = if options.towards == Towards::Left { "left" } else { "right" };
        let subject =
            format!("Limit analysis: wall of 8 courses, λ from the powers of its mechanism; μ = {mu}, to the {way}");
        agrees!(subject, "λ of the forces", "", -power(&problem.dead) / power(&problem.live), lambda, 1e-9);
        assert!(limit.unbalanced <= 1e-9 * scale);
    }
}

#[test]
fn friction_of_head_joints_only_holds() {
    for mu in [0.3, 0.5, 0.65, 0.8] {
        let wall = DryWall::running(4, 8, [0.25, 0.12], mu, false);
        let without = certified(&wall.limit(Options { heads: Heads::Frictionless, ..Options::default() }));
        let with = wall.multiplier();
        assert!(without <= with * (1.0 + 1e-9), "{without} > {with}");
        // From μ = 0.65 on bricks turn against each other, and it matters.
        assert!(mu < 0.6 || without < 0.99 * with, "{without}, {with}");
    }
}

/// Dilation can only hold a wall.
#[test]
fn friction_without_dilation_holds_less() {
    for (mu, full) in [(0.5, true), (0.65, false), (0.65, true), (0.8, false)] {
        let limit = DryWall::running(4, 8, [0.25, 0.12], mu, full).limit(Options::default());
        let estimate = &limit.non_associative;
        assert_eq!(estimate.stop, Stop::Converged, "{estimate:?}");
        assert!(estimate.multiplier <= limit.bounds[1] * (1.0 + 1e-6), "{estimate:?} above {:?}", limit.bounds);
        assert!(estimate.multiplier > 0.8 * limit.bounds[0], "{estimate:?} far below {:?}", limit.bounds);
    }
}

/// Courses of equal width, their bricks drawn; every brick rests on what is below it.
fn irregular() -> impl Strategy<Value = DryWall> {
    let course = prop::collection::vec(0.2f64..0.6, 2..5);
    let courses = prop::collection::vec((course, 0.1f64..0.3), 2..6);
    (courses, 0.3f64..0.9).prop_map(|(drawn, mu)| {
        let row = |lengths: &Vec<f64>| {
            let total: f64 = lengths.iter().sum();
            let mut x = 0.0;
            let mut blocks = Vec::new();
            for length in lengths {
                blocks.push([x, length / total]);
                x += length / total;
            }
            blocks
        };
        let mut wall = DryWall::new(drawn.iter().map(|(lengths, _)| row(lengths)).collect(), 1.0, mu);
        wall.heights = drawn.iter().map(|(_, height)| *height).collect();
        wall
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// λ knows weights by their ratios alone.
    #[test]
    fn heavier_stone_changes_nothing(wall in irregular(), factor in 0.01f64..100.0) {
        let heavier = DryWall { weight: factor * wall.weight, ..wall.clone() };
        close("λ", heavier.multiplier(), wall.multiplier(), 1e-9);
    }

    /// The wall in a mirror, pushed the other way.
    #[test]
    fn left_is_right_in_a_mirror(wall in irregular()) {
        let mirrored = |row: &Vec<[f64; 2]>| row.iter().rev().map(|[x, length]| [1.0 - x - length, *length]).collect();
        let mirror = DryWall { courses: wall.courses.iter().map(mirrored).collect(), ..wall.clone() };
        close("λ", certified(&mirror.limit(LEFT)), wall.multiplier(), 1e-9);
    }
}
