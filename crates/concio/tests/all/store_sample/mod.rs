//! A made-up run for tests of the store: the values follow from their indices, so that a swapped row, column or array
//! shows; they obey no mechanics.

use concio::bond::BondRow;
use concio::case::{DeviceLaw, FrictionLaw, JointKind, SpringLaw};
use concio::drift::DriftRow;
use concio::outcome::{Before, Collapse, Outcome, TieRow, Totals};
use concio::record::{Channel, Counters, Energies, Envelopes, Event, EventKind, Layout, Recording, StopReason};
use concio::store::{FrictionRow, JointRow, Provenance};
use concio::wall::{Block, End, Joint, PanelInfo, Shape, Wall};

/// How large a made-up run is.
#[derive(Debug, Clone, Copy)]
pub struct Size {
    pub courses: usize,
    pub bricks: usize,
    pub samples: usize,
    pub frame_every: usize,
    pub channels: usize,
    pub beam: bool,
    pub planar: bool,
}

pub const SMALL: Size =
    Size { courses: 3, bricks: 4, samples: 401, frame_every: 10, channels: 7, beam: true, planar: false };

pub struct Sample {
    pub provenance: Provenance,
    pub wall: Wall,
    pub joints: Vec<JointRow>,
    pub outcome: Outcome,
}

pub fn sample(size: Size) -> Sample {
    let wall = wall(size);
    let joints = joints(size, &wall);
    let outcome = outcome(size, &wall, joints.len());
    let provenance = Provenance {
        case_json: r#"{"title":"Prüfwand – β, δ_v","model":"shear"}"#.into(),
        inputs_hash: "0123456789abcdef".into(),
        version: "0.1.0".into(),
        model: if size.planar { "planar" } else { "shear" }.into(),
    };
    Sample { provenance, wall, joints, outcome }
}

fn wall(size: Size) -> Wall {
    let mut blocks = Vec::new();
    for course in 0..size.courses {
        for place in 0..size.bricks {
            let (x, y) = (0.26 * place as f64 + 0.13 * (course % 2) as f64, 0.065 * course as f64);
            blocks.push(Block {
                name: format!("p1c{}b{}", course + 1, place + 1),
                panel: 0,
                course,
                x: [x, x + 0.25],
                y: [y, y + 0.055],
                shape: None,
                thickness: 0.12,
                specific_weight: 18_000.0 + course as f64,
            });
        }
    }
    let panel = PanelInfo {
        name: "p1".into(),
        courses: size.courses,
        reference_length: 0.25,
        reference_height: 0.055,
        reference_mass: 3.03,
        mortar: [0.01, 0.011],
        connection: 0.012,
    };
    Wall { panels: vec![panel], blocks }
}

/// Makes the third block a lintel, the fifth a triangle, the sixth a pentagon and the seventh a trapezium, within their edges.
pub fn reshape(wall: &mut Wall) {
    let outlines: [&[[f64; 2]]; 3] = [
        &[[0.0, 0.0], [1.0, 0.25], [0.5, 1.0]],
        &[[0.25, 0.0], [1.0, 0.0], [1.0, 0.5], [0.75, 1.0], [0.0, 1.0]],
        &[[0.125, 0.0], [0.875, 0.0], [1.0, 1.0], [0.0, 1.0]],
    ];
    wall.blocks[2].shape = Some(Box::new(Shape { span: 2, corners: Vec::new() }));
    for (block, parts) in wall.blocks[4..].iter_mut().zip(outlines) {
        // At an end of the unit interval the edge itself, to its last digit.
        let between = |[low, high]: [f64; 2], part: f64| if part == 1.0 { high } else { low + part * (high - low) };
        let corners = parts.iter().map(|&[a, b]| [between(block.x, a), between(block.y, b)]).collect();
        block.shape = Some(Box::new(Shape { span: 1, corners }));
    }
}

/// Base supports, head joints, one bed joint from each block to the one above it, top supports.
fn joints(size: Size, wall: &Wall) -> Vec<JointRow> {
    let mut rows = Vec::new();
    for (index, block) in wall.blocks.iter().enumerate() {
        let place = index % size.bricks;
        let mut push = |kind, b| rows.push(joint(rows.len(), kind, index, b, wall));
        if block.course == 0 {
            push(JointKind::Base, End::Base);
        }
        if place + 1 < size.bricks {
            push(JointKind::Head, End::Block(index + 1));
        }
        if block.course + 1 < size.courses {
            push(JointKind::Bed, End::Block(index + size.bricks));
        } else {
            push(JointKind::Top, End::Top);
        }
    }
    rows
}

fn joint(k: usize, kind: JointKind, a: usize, b: End, wall: &Wall) -> JointRow {
    let f = k as f64;
    let other = match b {
        End::Block(b) => wall.blocks[b].name.clone(),
        End::Base => "base".into(),
        End::Top => "top".into(),
    };
    let rubs = kind != JointKind::Head;
    let friction = FrictionRow {
        law: FrictionLaw::Stribeck,
        static_: 0.6 + f,
        dynamic: 0.42 + f,
        slip_velocity: 1e-3 + f,
        beta: 100.0 + f,
        alpha: f,
    };
    JointRow {
        joint: Joint { kind, a, b, weight: 1.0 + f, overlap: 0.1 + f, line: [f, f + 0.1, f + 0.2, f + 0.3] },
        name: format!("{}|{other}", wall.blocks[a].name),
        law: if rubs { SpringLaw::Elastic } else { SpringLaw::NoTension },
        stiffness: 5.4e7 + f,
        normal_stiffness: 1.3e8 + f,
        damping: 1e3 + f,
        normal_force: [100.0 + f, 101.0 + f],
        friction: rubs.then_some(friction),
        restitution: 0.01 * f,
        device: DeviceLaw::ALL.get(k).copied(),
    }
}

fn outcome(size: Size, wall: &Wall, joints: usize) -> Outcome {
    let unknowns = wall.blocks.len() + usize::from(size.beam);
    let layout = Layout {
        interval: 2.5e-4,
        samples: size.samples,
        frame_every: size.frame_every,
        unknowns,
        turned: if size.planar { unknowns } else { 0 },
        touching: if size.planar { joints } else { 0 },
        held: if size.planar { joints } else { 3 },
        bonded: joints.min(2),
        channels: channels(size.channels, wall),
    };
    let mut recording = rows(&layout, 0..size.samples);
    recording.events.retain(|e| (e.joint as usize) < joints);
    let per_unknown = |scale: f64| (0..unknowns).map(|k| scale * (k as f64 + 1.0)).collect::<Vec<_>>();
    let per_joint = |scale: f64| (0..joints).map(|k| scale * (k as f64 + 1.0)).collect::<Vec<_>>();
    let envelopes = Envelopes {
        block_displacement: per_unknown(1.0),
        block_velocity: per_unknown(2.0),
        block_acceleration: per_unknown(3.0),
        joint_displacement: per_joint(4.0),
        joint_velocity: per_joint(5.0),
        joint_acceleration: per_joint(6.0),
        joint_slip: per_joint(7.0),
        joint_opening: per_joint(8.0),
        joint_closing: per_joint(9.0),
        joint_force: per_joint(10.0),
        joint_dissipation: per_joint(11.0),
        joint_impulse: per_joint(12.0),
        joint_impacts: per_joint(13.0),
    };
    let bond = |k: usize| BondRow {
        joint: k,
        strength: 4.5e3 + k as f64,
        stiffness: 5.4e7,
        residual_stiffness: 0.25,
        energy: 0.75,
        decay: 1e-5 * k as f64,
        damage: 0.5 + 0.5 * k as f64,
        crack: 0.75,
        crack_start: 0.25,
        spent: 0.125,
        cracked: 1e-3,
        broken: if k == 0 { f64::INFINITY } else { 2e-3 },
    };
    let tie = |k: usize| TieRow {
        from: if k == 0 { "base".into() } else { wall.blocks[0].name.clone() },
        to: wall.blocks[k.max(1)].name.clone(),
        force: 4.2e4 + k as f64,
        stretch: 1e-3 * k as f64,
        yielded: if k == 0 { f64::INFINITY } else { 5e-4 },
    };
    Outcome {
        rocking: None,
        deepest: None,
        falling: None,
        ties: if size.planar && wall.blocks.len() > 1 { (0..2).map(tie).collect() } else { Vec::new() },
        bonds: (0..layout.bonded).map(bond).collect(),
        drifts: vec![DriftRow {
            top: "p1".into(),
            height: 0.5,
            peak: -2e-3,
            time: 0.03,
            residual: f64::INFINITY,
            swing: f64::INFINITY,
        }],
        time_reached: layout.interval * (size.samples - 1) as f64,
        layout,
        recording,
        envelopes,
        energies: Energies {
            input_base: 1.5,
            input_top: 2.5,
            initial: 0.015625,
            kinetic: 0.125,
            elastic: 0.25,
            damping: 0.5,
            friction: 3.0,
            bond: 0.0625,
            device: 0.001953125,
            impact: 0.0078125,
            nonreciprocal: 0.03125,
        },
        totals: Totals {
            peak_relative_displacement: 1.1e-3,
            peak_slip_velocity: 2.2e-2,
            peak_friction_force: 1.7e3,
            base_shear_peak: 1.9e5,
            base_shear_time: 0.02,
            base_shear_displacement: -1.25e-3,
            top_force_peak: 2.3e5,
            top_force_square: 4.0e8,
            minimum_gap: -1.0e-9,
            contact_residual: 3.0e-16,
            peak_input: 8.0,
            peak_work: 16.0,
            peak_residual: 2.0e-6,
            collapse: wall.blocks.first().map(|_| Collapse {
                time: 0.06,
                block: 0,
                way: 0.25,
                turned: true,
                before: Some(Before { residual: 1e-5, steps: 6, unsolved: 1, moving: 2 }),
            }),
        },
        counters: Counters {
            steps: 10,
            rejected: 20,
            failed: 30,
            iterations: 40,
            factorisations: 50,
            events: 60,
            located: 70,
            impacts: 80,
            unsolved: 90,
            moving: 100,
        },
        stop_reason: StopReason::Completed,
    }
}

fn channels(count: usize, wall: &Wall) -> Vec<Channel> {
    let fixed = [("top/displacement", "m"), ("top/force", "N"), ("energy/friction", "J")];
    let name = |k: usize| match fixed.get(k) {
        Some(&(name, unit)) => (name.to_string(), unit),
        None if k == 3 => (format!("joint/{0}|{1}/slip", wall.blocks[0].name, wall.blocks[1].name), "m"),
        None => (format!("block/{}/velocity-{}", wall.blocks[k % wall.blocks.len()].name, k), "m/s"),
    };
    let channel = |k: usize| {
        let (name, unit) = name(k);
        Channel { name, unit: unit.into(), description: format!("Made-up history {k}.") }
    };
    (0..count).map(channel).collect()
}

/// The samples of that range, and the frames that fall on them.
pub fn rows(layout: &Layout, range: std::ops::Range<usize>) -> Recording {
    let mut rows = Recording::default();
    for k in range {
        let t = layout.interval * k as f64;
        rows.time.push(t);
        if k % 97 == 5 {
            rows.events.push(Event { time: t, joint: (k % 3) as u32, kind: EventKind::Impact, value: 0.5 * t });
        }
        if k % 97 == 6 && layout.turned > 0 {
            rows.events.push(Event { time: t, joint: (k % 3) as u32, kind: EventKind::Collapse, value: 0.25 * t });
        }
        rows.values.extend((0..layout.channels.len()).map(|c| (c as f64 + 1.0) * (t * 40.0 + c as f64).sin()));
        if layout.frame_every > 0 && k % layout.frame_every == 0 {
            rows.frame_time.push(t);
            rows.frame_displacement.extend((0..layout.unknowns).map(|u| 1e-3 * (t * 30.0 + u as f64 * 0.01).sin()));
            rows.frame_velocity.extend((0..layout.unknowns).map(|u| 3e-2 * (t * 30.0 + u as f64 * 0.01).cos()));
            rows.frame_friction.extend((0..layout.held).map(|e| 50.0 * (t * 20.0 + e as f64 * 0.1).sin()));
            rows.frame_damage.extend((0..layout.bonded).map(|b| (0.5 + t * 20.0 + b as f64 * 0.1).min(1.0)));
            // Turns of half a circle and more, and others so small that 1 − cos of them is below the digits of 1.
            let turn = |u: usize| if u.is_multiple_of(2) { 40.0 * t * (u as f64 + 1.0) } else { 1e-9 * (t + u as f64) };
            rows.frame_vertical.extend((0..layout.turned).map(|u| 2e-3 * (t * 25.0 + u as f64 * 0.02).sin()));
            rows.frame_rotation.extend((0..layout.turned).map(turn));
            rows.frame_slip.extend((0..layout.touching).map(|e| 1e-3 * (t * 20.0 + e as f64 * 0.3).sin()));
            rows.frame_opening.extend((0..layout.touching).map(|e| 1e-4 * (t * 10.0 + e as f64 * 0.3).sin().max(0.0)));
            rows.frame_pressure.extend((0..layout.touching).map(|e| 700.0 * (t * 15.0 + e as f64 * 0.2).cos()));
            rows.frame_acceleration.extend((0..layout.unknowns).map(|u| -0.9 * (t * 30.0 + u as f64 * 0.01).sin()));
        }
    }
    rows
}
