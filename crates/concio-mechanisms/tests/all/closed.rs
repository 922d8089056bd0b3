//! Closed forms of the displaced shape, limits of one formula in another, and properties.

use std::f64::consts::{FRAC_PI_2, PI};

use concio_mechanisms::body::{Body, Hold, HoldLaw, Thrust, Weight};
use concio_mechanisms::checks::{Asked, Checks, Hazard, Missing, Place, Site, Spectrum, first_period};
use concio_mechanisms::corner::{Beside, Corner, CornerLoad};
use concio_mechanisms::facade::{Floor, Masonry, Tie};
use concio_mechanisms::flap::Flap;
use concio_mechanisms::gable::Gable;
use concio_mechanisms::horizontal_arch::HorizontalArch;
use concio_mechanisms::overturning::Facade;
use concio_mechanisms::pushover::{Kinematics, Pushover};
use concio_mechanisms::setback::Crushing;
use concio_mechanisms::side_wall::{Overlaps, SideWall};
use concio_mechanisms::vertical_arch::{self, VerticalArch};
use concio_verified::agrees;

fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within * expected.abs().max(1e-3), "{found} instead of {expected}");
}

fn wall(thickness: f64, height: f64) -> Body {
    let weight = Weight { carried: 1e4, pushing: 0.0, depth: 0.5 * thickness, height: 0.5 * height };
    Body { weights: vec![weight], ..Body::default() }
}

fn side() -> SideWall {
    SideWall {
        thickness: 0.4,
        specific_weight: 18e3,
        course: 0.25,
        overlap: 0.2,
        friction: 0.6,
        load: 0.0,
        opening: None,
    }
}

fn facade(masonry: &Masonry) -> Facade<'_> {
    let (floors, ties, side_walls) = (&[], &[], &[]);
    Facade { masonry, floors, ties, side_walls, crushing: Crushing::Rigid, overlaps: Overlaps::Summed }
}

#[test]
fn one_block_turns_as_the_tangent_says() {
    let (thickness, height) = (0.5, 6.0);
    let steep = f64::atan2(thickness, height);
    let body = wall(thickness, height);
    for part in [0.0, 0.25, 0.5, 0.9] {
        let subject = format!("Mechanisms: one block in the displaced shape; θ {part} of α_s");
        agrees!(subject, "tan(α_s − θ)", "", body.at(part * steep), (steep * (1.0 - part)).tan(), 1e-12);
    }
    near(body.last_turn(), steep, 1e-14);
}

#[test]
fn the_curve_is_the_derivative_of_the_potential() {
    // Of a flap with everything on it: forces that keep their direction have a potential.
    let angle: f64 = 0.9;
    let weights = vec![
        Weight { carried: 3e4, pushing: 2e3, depth: 0.2, height: 1.1 },
        Weight { carried: 5e3, pushing: 0.0, depth: 0.3, height: 2.0 },
    ];
    let thrusts = vec![Thrust { force: 800.0, depth: 0.3, height: 2.0 }];
    let body = Body { hinge_angle: angle, weights: weights.clone(), thrusts: thrusts.clone(), ..Body::default() };
    let rise = |x: f64, z: f64, t: f64| angle.sin() * (x * t.sin() + z * (t.cos() - 1.0));
    let out = |x: f64, z: f64, t: f64| z * t.sin() + x * (1.0 - t.cos());
    let potential = |t: f64| {
        let up: f64 = weights.iter().map(|w| w.carried * rise(w.depth, w.height, t)).sum();
        up - thrusts.iter().map(|h| h.force * out(h.depth, h.height, t)).sum::<f64>()
    };
    let pushed = |t: f64| weights.iter().map(|w| (w.carried + w.pushing) * out(w.depth, w.height, t)).sum::<f64>();
    let step = 1e-5;
    for turn in [0.01, 0.05, 0.1, 0.3] {
        let slope = |of: &dyn Fn(f64) -> f64| (of(turn + step) - of(turn - step)) / (2.0 * step);
        near(body.at(turn), slope(&potential) / slope(&pushed), 1e-8);
    }
    assert!(body.sure(body.last_turn()).abs() < 1e-12);
}

#[test]
fn a_chain_is_the_derivative_of_its_potential_too() {
    let arch = VerticalArch::uniform(0.3, 3.2, 17e3, 0.6, 30e3, 0.1);
    let [lower, upper] = [0, 1].map(|i| [arch.parts[i][0].carried, arch.parts[i][0].height]);
    let (t, b) = (arch.thickness, arch.hinge);
    let place = |turn: f64| {
        let other = arch.upper_turn(turn).unwrap();
        let hinge = [t * turn.cos() - b * turn.sin(), b * turn.cos() + t * turn.sin()];
        let of = |x: f64, z: f64| {
            [hinge[0] + x * other.cos() + z * other.sin(), hinge[1] + z * other.cos() - x * other.sin()]
        };
        let low = [0.5 * t * turn.cos() - lower[1] * turn.sin(), lower[1] * turn.cos() + 0.5 * t * turn.sin()];
        (low, of(-0.5 * t, upper[1] - b), of(-arch.depth, arch.height - b))
    };
    let step = 1e-5;
    for turn in [0.0, 0.02, 0.06] {
        let slope = |of: &dyn Fn(f64) -> f64| (of(turn + step) - of(turn - step)) / (2.0 * step);
        let potential = |turn: f64| {
            let (low, high, top) = place(turn);
            lower[0] * low[1] + upper[0] * high[1] + arch.load * top[1]
        };
        let pushed = |turn: f64| {
            let (low, high, _) = place(turn);
            -lower[0] * low[0] - upper[0] * high[0]
        };
        near(arch.at(turn).unwrap(), slope(&potential) / slope(&pushed), 1e-7);
        // The top keeps its distance from the plane of the wall.
        near(place(turn).2[0], t - arch.depth, 1e-12);
    }
}

#[test]
fn vertical_arch_by_work_is_its_formula_and_least_where_it_says() {
    for (load, depth) in [(5e3, 0.05), (30e3, 0.15), (80e3, 0.28)] {
        let (t, h, weight) = (0.3, 3.0, 16e3);
        let at = |part: f64| VerticalArch::uniform(t, h, weight, part, load, depth).multiplier();
        let n = load / weight;
        for part in [0.3, 0.5, 0.8] {
            let formula = 2.0 * t / h * (1.0 + n * (1.0 + depth / t * part / (1.0 - part))) / part;
            near(at(part), formula, 1e-12);
        }
        let least = vertical_arch::least(t, h, weight, load, depth);
        near(at(least.part), least.multiplier, 1e-12);
        assert!(at(least.part - 0.01) > least.multiplier && at(least.part + 0.01) > least.multiplier);
    }
}

#[test]
fn horizontal_arch_turns_as_a_three_hinged_one() {
    let strip = HorizontalArch {
        thickness: 0.4,
        spans: [2.5; 2],
        weight: 7.2e3,
        thrust: 25e3,
        friction: 0.0,
        load: 0.0,
        pushing: 0.0,
        outwards: 0.0,
    };
    for turn in [0.0f64, 0.05, 0.1] {
        // Half of it: the thrust's lever t cos θ − L sin θ against the weight in its middle.
        let (sin, cos) = turn.sin_cos();
        let lever = 0.4 * cos - 2.5 * sin;
        let formula = 25e3 * lever / (7.2e3 * 2.5 * 0.5 * (2.5 * cos + 0.4 * sin));
        near(strip.at(turn).unwrap(), formula, 1e-12);
    }
    assert!(strip.at(strip.last_turn()).unwrap().abs() < 1e-12);
    let rubbing = HorizontalArch { friction: 0.5, load: 3.6e3, ..strip };
    near(rubbing.multiplier() - strip.multiplier(), 0.75, 1e-12);
    // The hinge at midspan is the lowest.
    let at = |first: f64| HorizontalArch { spans: [first, 5.0 - first], ..strip }.multiplier();
    assert!(at(2.0) > at(2.5) && at(3.0) > at(2.5));
}

#[test]
fn a_flap_with_a_level_hinge_overturns() {
    let masonry = Masonry::rectangle(0.5, 6.0, 4.0, 18e3, &[[1.0, 1.0, 1.0, 2.0]]);
    let floors = [Floor { level: 6.0, load: 2e4, depth: 0.3, friction: 0.2, ..Floor::default() }];
    let ties = [Tie { level: 3.0, position: 2.0, force: 5e3, ..Tie::default() }];
    let outline = vec![[0.0, 1.0], [4.0, 1.0], [4.0, 6.0], [0.0, 6.0]];
    let flap = Flap { outline, hinge: [[0.0, 1.0], [4.0, 1.0]], crack: [[0.0, 1.0], [0.0, 6.0]], thrust: 0.0 };
    let body = flap.laden(&masonry, &floors, &ties, [0.0, 4.0]);
    let whole = Facade { floors: &floors, ties: &ties, ..facade(&masonry) }.least(1.0);
    near(flap.angle(), FRAC_PI_2, 1e-14);
    near(body.multiplier(), whole.multiplier, 1e-12);
    near(body.at(0.05), whole.body.at(0.05), 1e-12);
}

#[test]
fn a_triangular_flap_is_a_gable_at_any_angle() {
    let gable = Gable {
        base: 6.0,
        height: 2.0,
        thickness: 0.4,
        specific_weight: 18e3,
        load: 0.0,
        depth: 0.2,
        pushing: 0.0,
        thrust: 0.0,
    };
    near(gable.whole().multiplier(), 3.0 * 0.4 / (2.0 * 2.0), 1e-14);
    // Half of a gable about a line from its foot to the foot of the ridge's crack, with what is spared below the slope.
    assert!(gable.least_flaps(0.0, 0.0).multiplier >= gable.whole().multiplier() * (1.0 - 1e-9));
    // A heavy ridge beam punches: the free minimum is lower than that which blocks allow.
    let heavy = Gable { pushing: 4e4, ..gable };
    let (free, bound) = (heavy.least_flaps(0.0, 0.0), heavy.least_flaps(1.2, 0.0));
    assert!(free.multiplier < bound.multiplier);
    assert!(bound.flap.angle().tan() >= 1.2 - 1e-6);
}

#[test]
fn without_friction_the_least_crack_is_upright() {
    let masonry = Masonry::rectangle(0.5, 6.0, 5.0, 18e3, &[]);
    let dry = [SideWall { friction: 0.0, ..side() }; 2];
    let found = Facade { side_walls: &dry, ..facade(&masonry) }.least(0.0);
    assert_eq!(found.slopes, [0.0; 2]);
    near(found.multiplier, 0.5 / 6.0, 1e-14);
}

#[test]
fn the_least_crack_is_that_of_a_scan() {
    let masonry = Masonry::rectangle(0.5, 6.0, 5.0, 18e3, &[]);
    let floors = [Floor { level: 3.0, load: 4e4, depth: 0.35, thrust: 3e3, ..Floor::default() }];
    let sides = [SideWall { load: 8e3, ..side() }, SideWall { thickness: 0.7, friction: 0.4, overlap: 0.12, ..side() }];
    for crushing in [Crushing::Rigid, Crushing::Rectangular(1.5e6)] {
        let facade = Facade { floors: &floors, side_walls: &sides, crushing, ..facade(&masonry) };
        let found = facade.least(0.5);
        let mut least = f64::INFINITY;
        for i in 0..=200 {
            for k in 0..=200 {
                let slopes = [0.8 * f64::from(i) / 200.0, 0.48 * f64::from(k) / 200.0];
                least = least.min(facade.with_slopes(0.5, &slopes).multiplier);
            }
        }
        // The setback grows with the wedges, which the slopes' closed form leaves to the next round.
        let within = if crushing == Crushing::Rigid { 1e-9 } else { 1e-5 };
        assert!(found.multiplier <= least * (1.0 + within), "{} above {least}", found.multiplier);
        near(found.multiplier, least, 1e-4);
    }
}

#[test]
fn an_opening_in_the_side_wall_bounds_its_crack() {
    let masonry = Masonry::rectangle(0.5, 6.0, 5.0, 18e3, &[]);
    let sides = [SideWall { opening: Some(1.2), ..side() }; 2];
    let found = Facade { side_walls: &sides, ..facade(&masonry) }.least(0.0);
    near(found.slopes[0], 0.2, 1e-12);
}

#[test]
fn courses_sum_to_the_friction_of_the_formula() {
    for load in [0.0, 7e3] {
        let wall = SideWall { load, ..side() };
        let moment: f64 = wall.holds(6.0, 0.3, Overlaps::Summed).iter().map(|h| h.force * h.height).sum();
        near(moment, wall.kept(0.3) * wall.friction_moment(6.0, Overlaps::Summed), 1e-12);
    }
}

#[test]
fn more_pushes_less_holds() {
    let masonry = Masonry::rectangle(0.5, 6.0, 5.0, 18e3, &[]);
    let floor = Floor { level: 6.0, load: 3e4, depth: 0.2, ..Floor::default() };
    let alpha = |masonry: &Masonry, floor: Floor, ties: &[Tie]| {
        Facade { floors: &[floor], ties, ..facade(masonry) }.least(0.0).multiplier
    };
    let base = alpha(&masonry, floor, &[]);
    assert!(alpha(&masonry, Floor { thrust: 2e3, ..floor }, &[]) < base);
    assert!(alpha(&masonry, Floor { pushing: 2e4, ..floor }, &[]) < base);
    assert!(alpha(&masonry, Floor { depth: 0.3, ..floor }, &[]) > base);
    assert!(alpha(&masonry, Floor { friction: 0.3, ..floor }, &[]) > base);
    assert!(alpha(&masonry, floor, &[Tie { level: 5.0, force: 1e4, ..Tie::default() }]) > base);
    assert!(alpha(&Masonry::rectangle(0.5, 7.0, 5.0, 18e3, &[]), floor, &[]) < base);
    // A tie holds the more in proportion the lighter the wall is: α0 falls as γ h grows.
    let tie = [Tie { level: 6.0, force: 1e4, ..Tie::default() }];
    let of = |weight: f64| alpha(&Masonry::rectangle(0.5, 6.0, 5.0, weight, &[]), Floor::default(), &tie);
    assert!(of(22e3) < of(18e3) && of(18e3) < of(14e3));
    let crushed = Facade { crushing: Crushing::Rectangular(1e6), ..facade(&masonry) }.least(0.0);
    assert!(crushed.multiplier < 0.5 / 6.0 && crushed.setback > 0.0);
}

#[test]
fn ties_make_steps() {
    let law = HoldLaw::Tie { stiffness: Some(1e6), slack: 1e-3, breaks: Some(0.04) };
    let hold = Hold { force: 8e3, depth: 0.0, height: 4.0, law };
    for (displacement, force) in [(0.0, 0.0), (1e-3, 0.0), (5e-3, 4e3), (0.02, 8e3), (0.0401, 0.0)] {
        near(hold.at(displacement), force, 1e-9);
    }
    let mut body = wall(0.5, 6.0);
    body.holds.push(hold);
    let pushover = Pushover::of(Kinematics::Body(body, 6.0));
    // At 0.04 m at the tie the centre has moved by 0.03 m; the tie bore over half of what held.
    near(pushover.drop.unwrap(), 0.03, 1e-6);
    let curve = pushover.curve();
    let jump = curve.windows(2).map(|p| p[0].multiplier - p[1].multiplier).fold(0.0, f64::max);
    assert!(jump > 0.5 * curve.iter().map(|p| p.multiplier).fold(0.0, f64::max), "{jump}");
    assert!(curve.iter().all(|p| p.sure <= p.multiplier));
}

#[test]
fn a_wall_that_only_ties_hold_has_no_displacement_to_spare() {
    let mut body = wall(0.5, 6.0);
    body.thrusts.push(Thrust { force: 2e3, depth: 0.0, height: 6.0 });
    body.holds.push(Hold {
        force: 8e3,
        depth: 0.0,
        height: 6.0,
        law: HoldLaw::Tie { stiffness: None, slack: 0.0, breaks: None },
    });
    let pushover = Pushover::of(Kinematics::Body(body, 6.0));
    assert_eq!(pushover.last, 0.0);
    let hazard = Hazard { life: Some(Spectrum::Code(site())), ..Hazard::default() };
    let asked = Asked {
        hazard,
        place: Place::Ground,
        confidence: 1.35,
        behaviour: 2.0,
        seat: None,
        first_period: 0.0,
        free: false,
    };
    let checks = Checks::of(&pushover, &asked);
    assert_eq!(checks.life_displacement, Err(Missing::Stands));
    assert_eq!(checks.damage, Err(Missing::Hazard));
    assert!(checks.life.unwrap().ratio() > 0.0);
}

fn site() -> Site {
    Site { ground: 2.0, soil: 1.2, amplification: 2.4, corner: 0.45 }
}

#[test]
fn the_spectrum_joins_its_branches() {
    let spectrum = Spectrum::Code(site());
    let far = 4.0 * 2.0 / 9.81 + 1.6;
    for period in [0.15, 0.45, far] {
        let [before, after] = [-1e-9, 1e-9].map(|d| spectrum.acceleration(period + d, 8.0));
        near(before, after, 1e-7);
    }
    near(spectrum.acceleration(0.0, 8.0), 2.4, 1e-12);
    near(spectrum.peak(), 2.4, 1e-12);
    // Beyond T_D the displacement stays.
    near(spectrum.displacement(4.0, 5.0), spectrum.displacement(far, 5.0), 1e-12);
    // Columns of the same spectrum say the same, and the largest displacement of them counts.
    let periods = (0..=400).map(|i| 0.01 * f64::from(i));
    let columns = Spectrum::Columns(periods.map(|t| [t, spectrum.acceleration(t, 5.0)]).collect());
    near(columns.displacement(2.0, 8.0), spectrum.displacement(2.0, 8.0), 1e-3);
    near(columns.displacement(6.0, 8.0), spectrum.displacement(6.0, 8.0), 1e-3);
}

#[test]
fn a_cantilever_has_the_period_of_a_beam() {
    // κ = 6.2 is 2π √12/1.875².
    let (length, thickness, weight, modulus): (f64, f64, f64, f64) = (2.0, 0.3, 18e3, 1.5e9);
    let beam = 2.0 * PI * 12f64.sqrt() / 1.8751f64.powi(2) * length * length / thickness;
    let beam = beam * (weight / (9.81 * modulus)).sqrt();
    near(first_period(length, thickness, weight, modulus, true), beam, 2e-3);
}

#[test]
fn a_corner_falls_towards_the_weaker_wall_alike() {
    let wall = SideWall { friction: 0.0, ..side() };
    let thick = SideWall { thickness: 0.8, ..wall };
    let of = |walls| Corner {
        walls,
        direction: PI / 5.0,
        top: 3.0,
        load: CornerLoad::default(),
        overlaps: Overlaps::Summed,
    };
    let one = of([wall, thick]).with_slopes(0.0, [0.3, 0.5], &Beside::default());
    // The same corner seen from the other wall.
    let mirrored = Corner { direction: FRAC_PI_2 - PI / 5.0, ..of([thick, wall]) };
    near(one.multiplier, mirrored.with_slopes(0.0, [0.5, 0.3], &Beside::default()).multiplier, 1e-12);
}

/// The least flap of this gable has its hinge on the bound of its slope and its foot on the base: the wall's corner below the ridge.
#[test]
fn flaps_of_a_gable_reach_the_bounds_of_their_search() {
    let (height, half, thickness, gamma, load) = (2.85, 2.37, 0.287, 17789.0, 12448.0);
    let gable = Gable {
        base: 2.0 * half,
        height,
        thickness,
        specific_weight: gamma,
        load,
        depth: 0.5 * thickness,
        pushing: 0.0,
        thrust: 0.0,
    };
    let found = gable.least_flaps(1.0, 0.0);
    // The hinge at 45° from the middle of the base meets the slope at h b/(h + b): a triangle beside the crack, its centroid at a third.
    let weight = gamma * thickness * 0.5 * height * height * half / (height + half);
    let expected = 0.5 * thickness * (weight + 0.5 * load) / (height * (weight / 3.0 + 0.5 * load));
    let against = "the triangle over a hinge at 45°";
    agrees!("Mechanisms: flap of a gable on its bounds", against, "", found.multiplier, expected, 1e-8);
    assert!(found.flap.crack[0][1].abs() < 1e-9, "{:?}", found.flap.crack);
}
