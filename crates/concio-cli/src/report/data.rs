//! What the page's program gets: a table of contents in JSON and the numbers behind it, deflated, in base64.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use concio::bond::BondRow;
use concio::case::Beam;
use concio::ground::response_spectrum;
use concio::store::{FrictionRow, JointRow};
use concio::wall::{Block, End};
use serde_json::{Value, json};

use super::pack::{Digits, Pack, deflated};
use super::{Content, beam_label};

/// Layout of the data; the page's program refuses another.
const LAYOUT: u32 = 5;
/// Times that deflating makes data shorter at best: what is longer is not tried.
const SHORTER: usize = 6;
/// Bytes of a number on its way to be deflated, about.
const BYTES: usize = 3;

/// How the numbers of frames are kept.
#[derive(Debug, Clone, Copy)]
struct Precision {
    /// Motion of blocks.
    blocks: Digits,
    /// What joints do.
    joints: Digits,
}

/// In shear walls forces follow from differences of displacements, 10⁻⁷ m between blocks that moved 5·10⁻³ m: a quantum of 2⁻³⁸ of
/// the largest is right to 10⁻⁶ of them, one of 2⁻³⁰ to four digits.
const SHEAR: [Precision; 2] = [
    Precision { blocks: Digits::Shared(40), joints: Digits::Float },
    Precision { blocks: Digits::Shared(32), joints: Digits::Own(20) },
];
/// In planar walls frames bring what joints do: what is read off blocks are four digits of their own.
const PLANAR: [Precision; 3] = [
    Precision { blocks: Digits::Shared(40), joints: Digits::Float },
    Precision { blocks: Digits::Own(20), joints: Digits::Own(20) },
    Precision { blocks: Digits::Own(15), joints: Digits::Own(14) },
];
/// Bits of the damage of bonds, from 0 to 1.
const DAMAGE: Digits = Digits::Shared(20);
/// Points of a history; a longer one is drawn by the lowest and highest value of short intervals.
const MOST_POINTS: usize = 6000;
/// Histories that the page gets beyond those that every run keeps.
const MOST_ASKED: usize = 80;
/// What is drawn over each other.
const LOOPED: [&str; 4] = ["top/displacement", "base/shear", "beam/displacement", "top/force"];
/// Damping ratio of the spectrum.
const DAMPING: f64 = 0.05;
/// Periods of the spectrum [s]: that many from the shortest to the longest, at equal ratios.
const PERIODS: (usize, f64, f64) = (180, 0.02, 4.0);

/// The data in base64, of `room` bytes at most. Where they would be longer, numbers are rounded first, and then only every second,
/// third, … frame is kept.
pub fn payload(content: &Content, room: usize) -> String {
    // In base64 three bytes take four.
    let most = (room / 4 * 3).max(1);
    let levels: &[Precision] = if content.is_planar() { &PLANAR } else { &SHEAR };
    let recorded = content.outcome.recording.frame_time.len();
    let length = BYTES * numbers_of_frame(content) * recorded;
    let (mut level, mut every) = (0, 1);
    loop {
        // Finer than that it cannot fit.
        if length / every > SHORTER * most && every < recorded {
            if level + 1 < levels.len() {
                level += 1
            } else {
                every = length.div_ceil(SHORTER * most)
            }
            continue;
        }
        let data = attempt(content, levels[level], every, most);
        if data.len() <= most || every >= recorded.max(1) {
            return STANDARD.encode(data);
        }
        if level + 1 < levels.len() {
            level += 1;
        } else {
            every = (every + 1).max((every * data.len()).div_ceil(most));
        }
    }
}

/// The data with every so many frames.
fn attempt(content: &Content, precision: Precision, every: usize, most: usize) -> Vec<u8> {
    let mut pack = Pack::default();
    let frames = frames(&mut pack, content, precision, every);
    let (channels, curve) = histories(&mut pack, content, &frames);
    let looped = loops(&mut pack, content);
    let spectrum = spectrum(&mut pack, content);
    wall(&mut pack, content);
    let frictions = joints(&mut pack, content.joints);
    envelopes(&mut pack, content);
    let (arrays, numbers) = pack.finish();
    let names = |of: &dyn Fn(&JointRow) -> Value| content.joints.iter().map(of).collect::<Vec<Value>>();
    let contents = json!({
        "layout": LAYOUT,
        "name": content.name,
        "title": content.case.title,
        "block_names": content.wall.blocks.iter().map(|b| &b.name).collect::<Vec<_>>(),
        "joint_names": names(&|j| json!(j.name)),
        "joint_kinds": names(&|j| json!(j.joint.kind)),
        "joint_laws": names(&|j| j.device.map_or(json!(j.law), |device| json!(format!("{} device", device.name())))),
        "frictions": frictions,
        "bonds": bonds(content),
        "planar": content.is_planar(),
        "beam": {
            "kind": beam_kind(content.case.load.beam),
            "label": beam_label(&content.case),
            "moves": frames.beam,
        },
        "frames": {
            "recorded": content.outcome.recording.frame_time.len(),
            "every": frames.every,
            "standing": frames.standing,
            // How many times as many would have room, where deflating halves them.
            "room": 2.0 * most as f64 / (numbers.len().max(1) as f64),
            "rounded": precision.joints.rounding().map(|joints| [precision.blocks.rounding(), Some(joints)]),
        },
        "curve": curve,
        "loops": looped,
        "channels": channels,
        "spectrum": spectrum,
        "arrays": arrays,
    });
    deflated(&contents.to_string(), &numbers)
}

/// How many numbers a frame has, those of blocks and of joints.
fn numbers_of_frame(content: &Content) -> usize {
    let layout = &content.outcome.layout;
    let bonded =
        layout.bonded * if content.is_planar() { 1 } else { 1 + content.joints.len().div_ceil(layout.bonded.max(1)) };
    3 * layout.unknowns + 2 * layout.turned + 3 * layout.touching + layout.held + bonded
}

/// What held the bonded joints and what became of it, by the index of the joint.
fn bonds(content: &Content) -> Value {
    let of = |bond: &BondRow| {
        let row = json!({
            "strength": bond.strength,
            "damage": bond.damage,
            "spent": bond.spent,
            "cracked": bond.cracked,
            "broken": bond.broken,
        });
        (bond.joint.to_string(), row)
    };
    Value::Object(content.outcome.bonds.iter().map(of).collect())
}

fn beam_kind(beam: Beam) -> &'static str {
    match beam {
        Beam::Free => "free",
        Beam::Driven => "driven",
        Beam::Tied => "tied",
        Beam::Mass(_) => "mass",
    }
}

/// Which frames the page gets: every so many, and the samples that they are.
struct Kept {
    every: usize,
    /// How many show the wall up to its collapse, that instant included.
    standing: usize,
    samples: Vec<usize>,
    /// Whether the beam is the last column of a frame.
    beam: bool,
}

fn frames(pack: &mut Pack, content: &Content, precision: Precision, every: usize) -> Kept {
    let (recording, layout) = (&content.outcome.recording, &content.outcome.layout);
    let recorded = recording.frame_time.len();
    let blocks = content.wall.blocks.len();
    let of_its_own = layout.unknowns > blocks;
    let has_beam = of_its_own || content.case.load.beam != Beam::Free;
    let unknowns = blocks + usize::from(has_beam);
    let moving = [
        ("displacement", &recording.frame_displacement, layout.unknowns),
        ("velocity", &recording.frame_velocity, layout.unknowns),
        ("acceleration", &recording.frame_acceleration, layout.unknowns),
        ("vertical", &recording.frame_vertical, layout.turned),
        ("rotation", &recording.frame_rotation, layout.turned),
    ]
    .map(|(name, values, width)| (width > 0).then_some((name, values, width)));
    let touching = [
        ("slip", &recording.frame_slip),
        ("opening", &recording.frame_opening),
        ("pressure", &recording.frame_pressure),
        ("friction", &recording.frame_friction),
    ];
    let kept: Vec<usize> = (0..recorded).step_by(every).collect();
    let samples: Vec<usize> = kept.iter().map(|k| k * layout.frame_every).collect();
    let times: Vec<f64> = kept.iter().map(|&k| recording.frame_time[k]).collect();
    pack.reals("frame/time", &times);
    for (name, values, width) in moving.into_iter().flatten() {
        // A beam without an unknown of its own is known from its history.
        let beam = if of_its_own { None } else { content.history(&format!("beam/{name}")) };
        let mut rows = Vec::with_capacity(kept.len() * unknowns);
        for (&k, &sample) in kept.iter().zip(&samples) {
            let row = &values[k * width..][..width];
            rows.extend_from_slice(&row[..blocks]);
            if has_beam {
                let of_beam = row.get(blocks).or_else(|| beam.as_ref()?.get(sample));
                rows.push(of_beam.copied().unwrap_or(f64::NAN));
            }
        }
        pack.table(&format!("frame/{name}"), unknowns, &rows, precision.blocks);
    }
    for (name, values) in touching {
        let width = if name == "friction" { layout.held } else { layout.touching };
        if width > 0 {
            let rows: Vec<f64> = kept.iter().flat_map(|&k| &values[k * width..][..width]).copied().collect();
            pack.table(&format!("frame/joint/{name}"), width, &rows, precision.joints);
        }
    }
    if layout.bonded > 0 {
        let rows: Vec<f64> =
            kept.iter().flat_map(|&k| &recording.frame_damage[k * layout.bonded..][..layout.bonded]).copied().collect();
        pack.table("frame/bond/damage", layout.bonded, &rows, DAMAGE);
    }
    if !content.outcome.bonds.is_empty() && !content.is_planar() {
        let beam = content.history("beam/displacement");
        let of_beam = |sample: usize| beam.as_ref().and_then(|b| b.get(sample)).copied().unwrap_or(0.0);
        let rows = kept.iter().zip(&samples).flat_map(|(&k, &sample)| elastic_forces(content, k, of_beam(sample)));
        pack.table("frame/joint/elastic", content.joints.len(), &rows.collect::<Vec<_>>(), precision.joints);
    }
    Kept { every, standing: recording.standing(&times), samples, beam: has_beam }
}

/// Elastic forces of all joints at a frame, where bonds make them more than a function of the displacements [N].
fn elastic_forces(content: &Content, frame: usize, beam: f64) -> Vec<f64> {
    let (recording, layout) = (&content.outcome.recording, &content.outcome.layout);
    let z = &recording.frame_displacement[frame * layout.unknowns..][..layout.unknowns];
    let mut bonds = content.outcome.bonds.iter().zip(&recording.frame_damage[frame * layout.bonded..]).peekable();
    let force = |(e, row): (usize, &JointRow)| {
        let other = match row.joint.b {
            End::Block(b) => z[b],
            End::Base => 0.0,
            End::Top => beam,
        };
        let bond = bonds.next_if(|(bond, _)| bond.joint == e);
        row.elastic_force(z[row.joint.a] - other, bond.map(|(bond, damage)| (bond, *damage)))
    };
    content.joints.iter().enumerate().map(force).collect()
}

/// Histories: their values at the frames, and curves that look like all samples.
fn histories(pack: &mut Pack, content: &Content, frames: &Kept) -> (Vec<Value>, Value) {
    let (recording, layout) = (&content.outcome.recording, &content.outcome.layout);
    let width = layout.channels.len();
    let single = |name: &str| name.starts_with("block/") || name.starts_with("joint/");
    let (asked, always): (Vec<usize>, Vec<usize>) = (0..width).partition(|&c| single(&layout.channels[c].name));
    let left_out = asked.len().saturating_sub(MOST_ASKED);
    let chosen: Vec<usize> = always.into_iter().chain(asked.into_iter().take(MOST_ASKED)).collect();
    let samples = recording.time.len();
    let buckets = Buckets::of(samples);
    pack.reals("curve/time", &buckets.times(&recording.time));
    let (mut at_frames, mut curves) = (Vec::new(), Vec::new());
    for &c in &chosen {
        let values: Vec<f64> = recording.values.chunks_exact(width).map(|row| row[c]).collect();
        at_frames.extend(frames.samples.iter().map(|&s| values.get(s).copied().unwrap_or(f64::NAN)));
        buckets.curve(&values, &mut curves);
    }
    pack.reals("channel/frames", &at_frames);
    pack.table("curve/values", buckets.points(), &curves, Digits::Float);
    let channels = chosen.iter().map(|&c| json!(layout.channels[c])).collect();
    let curve = json!({
        "samples": samples,
        "points": buckets.points(),
        "interval": layout.interval,
        "left_out": left_out,
    });
    (channels, curve)
}

/// Samples put together two by two for every bucket: its lowest and its highest value, in the order they come.
struct Buckets {
    samples: usize,
    /// 0 when every sample is kept.
    buckets: usize,
}

impl Buckets {
    fn of(samples: usize) -> Self {
        Buckets { samples, buckets: if samples > MOST_POINTS { MOST_POINTS / 2 } else { 0 } }
    }
    fn points(&self) -> usize {
        if self.buckets == 0 { self.samples } else { 2 * self.buckets }
    }
    fn ends(&self, bucket: usize) -> [usize; 2] {
        [bucket, bucket + 1].map(|b| b * self.samples / self.buckets)
    }
    /// The first sample of a bucket and the one in its middle stand for the two.
    fn times(&self, time: &[f64]) -> Vec<f64> {
        if self.buckets == 0 {
            return time.to_vec();
        }
        (0..self.buckets)
            .flat_map(|b| self.ends(b).into_iter().take(1).chain([self.middle(b)]))
            .map(|s| time[s])
            .collect()
    }
    fn middle(&self, bucket: usize) -> usize {
        let [start, end] = self.ends(bucket);
        start + (end - start) / 2
    }
    fn curve(&self, values: &[f64], into: &mut Vec<f64>) {
        if self.buckets == 0 {
            into.extend_from_slice(values);
            return;
        }
        for bucket in 0..self.buckets {
            let [start, end] = self.ends(bucket);
            let part = &values[start..end];
            let [low, high] = lowest_and_highest(part);
            into.extend([low.min(high), low.max(high)].map(|k| part[k]));
        }
    }
}

/// Where the lowest and the highest of some values are.
fn lowest_and_highest(values: &[f64]) -> [usize; 2] {
    let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
    let low = (0..values.len()).min_by(by_value).unwrap_or(0);
    let high = (0..values.len()).max_by(by_value).unwrap_or(0);
    [low, high]
}

/// Forces over displacements, of whose samples those are kept at which one of them is lowest or highest in its interval: curves
/// that are thinned one by one do not belong to each other. Nothing where no curve is thinned.
fn loops(pack: &mut Pack, content: &Content) -> Vec<&'static str> {
    let time = &content.outcome.recording.time;
    if time.len() <= MOST_POINTS {
        return Vec::new();
    }
    let found = LOOPED.into_iter().filter_map(|name| Some((name, content.history(name)?)));
    let (names, values): (Vec<&str>, Vec<Vec<f64>>) = found.unzip();
    let intervals = MOST_POINTS / (2 * LOOPED.len());
    let mut chosen = Vec::with_capacity(MOST_POINTS);
    for k in 0..intervals {
        let [start, end] = [k, k + 1].map(|k| k * time.len() / intervals);
        let from = chosen.len();
        chosen.extend(values.iter().flat_map(|y| lowest_and_highest(&y[start..end])).map(|at| start + at));
        chosen[from..].sort_unstable();
    }
    chosen.dedup();
    pack.reals("loop/time", &chosen.iter().map(|&k| time[k]).collect::<Vec<_>>());
    let rows: Vec<f64> = values.iter().flat_map(|y| chosen.iter().map(|&k| y[k])).collect();
    pack.table("loop/values", chosen.len(), &rows, Digits::Float);
    names
}

/// The response spectrum of the base motion, if the base moves.
fn spectrum(pack: &mut Pack, content: &Content) -> Option<Value> {
    let acceleration = content.history("base/acceleration")?;
    let interval = content.outcome.layout.interval;
    let moves = acceleration.len() > 2 && acceleration.iter().all(|a| a.is_finite());
    if !moves || acceleration.iter().all(|a| *a == 0.0) {
        return None;
    }
    let (n, low, high) = PERIODS;
    let periods: Vec<f64> = (0..n).map(|k| low * (high / low).powf(k as f64 / (n - 1) as f64)).collect();
    let spectrum = response_spectrum(interval, &acceleration, DAMPING, &periods);
    pack.reals("spectrum/period", &spectrum.periods);
    pack.reals("spectrum/psa", &spectrum.psa);
    Some(json!({ "damping": DAMPING, "interval": interval }))
}

fn wall(pack: &mut Pack, content: &Content) {
    let mut column = |name: &str, value: fn(&Block) -> f64| {
        pack.reals(&format!("block/{name}"), &content.wall.blocks.iter().map(value).collect::<Vec<_>>());
    };
    column("x0", |b| b.x[0]);
    column("x1", |b| b.x[1]);
    column("y0", |b| b.y[0]);
    column("y1", |b| b.y[1]);
    column("mass", Block::mass);
    for (number, name) in ["bed", "head"].into_iter().enumerate() {
        let mortar = |b: &Block| content.wall.panels[b.panel].mortar[number];
        pack.reals(&format!("block/{name}"), &content.wall.blocks.iter().map(mortar).collect::<Vec<_>>());
    }
    if content.wall.blocks.iter().any(|b| !b.is_rectangle()) {
        outlines(pack, &content.wall.blocks);
    }
}

/// Corners and centres of the blocks, where edges do not tell them.
fn outlines(pack: &mut Pack, blocks: &[Block]) {
    let (mut start, mut corners) = (vec![0], Vec::new());
    for block in blocks {
        corners.extend(block.corners());
        start.push(corners.len() as i32);
    }
    let centres: Vec<[f64; 2]> = blocks.iter().map(Block::centre).collect();
    pack.indices("outline/start", &start);
    for (k, axis) in ["x", "y"].into_iter().enumerate() {
        pack.reals(&format!("outline/{axis}"), &corners.iter().map(|c: &[f64; 2]| c[k]).collect::<Vec<_>>());
        pack.reals(&format!("outline/centre_{axis}"), &centres.iter().map(|c| c[k]).collect::<Vec<_>>());
    }
}

/// Sides, lines and laws of the joints; the different friction laws.
fn joints(pack: &mut Pack, joints: &[JointRow]) -> Vec<Value> {
    let side = |end: End| match end {
        End::Block(b) => b as i32,
        End::Base => -1,
        End::Top => -2,
    };
    let mut laws: Vec<FrictionRow> = Vec::new();
    let friction: Vec<i32> = joints
        .iter()
        .map(|j| {
            let Some(law) = j.friction else { return -1 };
            let known = laws.iter().position(|l| *l == law).unwrap_or_else(|| {
                laws.push(law);
                laws.len() - 1
            });
            known as i32
        })
        .collect();
    pack.indices("joint/a", &joints.iter().map(|j| j.joint.a as i32).collect::<Vec<_>>());
    pack.indices("joint/b", &joints.iter().map(|j| side(j.joint.b)).collect::<Vec<_>>());
    pack.indices("joint/friction", &friction);
    let mut column = |name: &str, value: fn(&JointRow) -> f64| {
        pack.reals(&format!("joint/{name}"), &joints.iter().map(value).collect::<Vec<_>>());
    };
    column("x0", |j| j.joint.line[0]);
    column("y0", |j| j.joint.line[1]);
    column("x1", |j| j.joint.line[2]);
    column("y1", |j| j.joint.line[3]);
    column("overlap", |j| j.joint.overlap);
    column("stiffness", |j| j.stiffness);
    column("damping", |j| j.damping);
    column("normal_force_a", |j| j.normal_force[0]);
    laws.iter()
        .map(|l| {
            json!({"law": l.law, "static": l.static_, "dynamic": l.dynamic, "slip_velocity": l.slip_velocity,
                "beta": l.beta, "alpha": l.alpha})
        })
        .collect()
}

fn envelopes(pack: &mut Pack, content: &Content) {
    let e = &content.outcome.envelopes;
    for (name, values) in [
        ("block/displacement", &e.block_displacement),
        ("block/velocity", &e.block_velocity),
        ("block/acceleration", &e.block_acceleration),
        ("joint/displacement", &e.joint_displacement),
        ("joint/velocity", &e.joint_velocity),
        ("joint/acceleration", &e.joint_acceleration),
        ("joint/slip", &e.joint_slip),
        ("joint/opening", &e.joint_opening),
        ("joint/closing", &e.joint_closing),
        ("joint/force", &e.joint_force),
        ("joint/dissipation", &e.joint_dissipation),
    ] {
        pack.table(&format!("envelope/{name}"), values.len(), values, Digits::Float);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::pack::tests as pack;

    #[test]
    fn curves_keep_every_peak_and_their_order() {
        let mut values = vec![0.0; 100_000];
        (values[31_415], values[92_653], values[92_654]) = (7.0, -3.0, 5.0);
        let buckets = Buckets::of(values.len());
        let mut curve = Vec::new();
        buckets.curve(&values, &mut curve);
        assert_eq!(curve.len(), buckets.points());
        assert_eq!(curve.len(), MOST_POINTS);
        let nonzero: Vec<f64> = curve.iter().copied().filter(|v| *v != 0.0).collect();
        assert_eq!(nonzero, [7.0, -3.0, 5.0]);
        let time: Vec<f64> = (0..values.len()).map(|k| k as f64).collect();
        let times = buckets.times(&time);
        assert_eq!(times.len(), MOST_POINTS);
        assert!(times.windows(2).all(|w| w[0] < w[1]));
    }

    const WALL: &str = r#"
        model = "shear"
        set = "report"
        [[panel]]
        bond = "running"
        courses = 2
        bricks = 2
        [load]
        top = "10 kN/m"
        beam = "driven"
        [motion]
        duration = "0.01 s"
        top = { sine = { amplitude = "1 mm", frequency = "20 Hz" } }
    "#;

    /// Contents and numbers of a payload.
    fn read_back(payload: &str) -> (Value, Vec<u8>) {
        pack::inflated(&STANDARD.decode(payload).expect("base64"))
    }

    /// The array of that name in a payload, of numbers of `N` bytes.
    fn array<const N: usize>(contents: &Value, numbers: &[u8], name: &str) -> Vec<[u8; N]> {
        let place = &contents["arrays"][name];
        let [at, count] = ["at", "count"].map(|key| place[key].as_u64().expect(name) as usize);
        numbers[at..][..N * count].as_chunks::<N>().0.to_vec()
    }

    /// What frames hold of blocks and joints of a planar run, the beam among them, comes out of the page's numbers.
    #[test]
    fn frames_of_planar_runs_bring_rotations_and_joints() {
        use concio::record::{Event, EventKind};
        let file = concio::case::from_str(WALL, concio::case::Syntax::Toml, None).expect("a wall");
        let prepared = concio::run::prepare_case(file.case, std::path::Path::new(".")).expect("a system");
        let mut outcome = concio::run::run_in_memory(&prepared).expect("a run");
        let (rows, frames) = (concio::run::joint_rows(&prepared.model), outcome.recording.frame_time.len());
        let (columns, joints) = (prepared.model.wall.blocks.len() + 1, rows.len());
        let layout = &mut outcome.layout;
        (layout.unknowns, layout.turned, layout.touching, layout.held) = (columns, columns, joints, joints);
        let made = |width: usize, size: f64| (0..frames * width).map(|k| size * (k as f64 - 7.0)).collect::<Vec<f64>>();
        let recording = &mut outcome.recording;
        for array in [
            &mut recording.frame_displacement,
            &mut recording.frame_velocity,
            &mut recording.frame_acceleration,
            &mut recording.frame_vertical,
            &mut recording.frame_rotation,
        ] {
            *array = made(columns, 1e-4);
        }
        for array in [
            &mut recording.frame_slip,
            &mut recording.frame_opening,
            &mut recording.frame_pressure,
            &mut recording.frame_friction,
        ] {
            *array = made(joints, 3.0);
        }
        let collapse = Event { time: recording.frame_time[2], joint: 0, kind: EventKind::Collapse, value: 0.1 };
        recording.events.push(collapse);
        let content = Content {
            name: "made".into(),
            case: prepared.case.clone(),
            text: None,
            command: None,
            wall: &prepared.model.wall,
            joints: &rows,
            outcome: &outcome,
            summary: &json!({}),
        };
        let (contents, numbers) = read_back(&payload(&content, 1 << 22));
        assert_eq!((&contents["planar"], &contents["beam"]["moves"]), (&json!(true), &json!(true)));
        assert_eq!((&contents["frames"]["every"], &contents["frames"]["standing"]), (&json!(1), &json!(3)));
        assert!(contents["frames"]["rounded"].is_null());
        for (k, (found, expected)) in pack::read(&contents["arrays"], &numbers, "frame/rotation")
            .into_iter()
            .zip(&outcome.recording.frame_rotation)
            .enumerate()
        {
            assert!((found - expected).abs() <= 1e-11 * expected.abs().max(0.1), "{k}: {found}, not {expected}");
        }
        for name in ["slip", "opening", "pressure", "friction"] {
            let found = pack::read(&contents["arrays"], &numbers, &format!("frame/joint/{name}"));
            assert_eq!(found, made(joints, 3.0), "{name}");
        }
    }

    const ARCH: &str = r#"
        model = "planar"
        [[panel]]
        bond = "arch"
        arch = { span = 2, rise = 0.5, thickness = 0.3, voussoirs = 7 }
        brick = { length = 0.3, height = 0.3, thickness = 0.5, specific_weight = 20e3 }
        mortar = { bed = 0, head = 0 }
        [joint]
        bed = { law = "rigid" }
        head = { law = "rigid" }
        friction = { law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }
        [motion]
        duration = "0.01 s"
    "#;

    /// Corners and centres of voussoirs come with the page; of a wall of rectangles its edges tell them.
    #[test]
    fn outlines_of_polygons_come_with_the_page() {
        let data_of = |text: &str| {
            let file = concio::case::from_str(text, concio::case::Syntax::Toml, None).expect("a wall");
            let prepared = concio::run::prepare_case(file.case, std::path::Path::new(".")).expect("a system");
            let outcome = concio::run::run_in_memory(&prepared).expect("a run");
            let rows = concio::run::joint_rows(&prepared.model);
            let content = Content {
                name: "made".into(),
                case: prepared.case.clone(),
                text: None,
                command: None,
                wall: &prepared.model.wall,
                joints: &rows,
                outcome: &outcome,
                summary: &json!({}),
            };
            let (contents, numbers) = read_back(&payload(&content, 1 << 22));
            (prepared.model.wall, contents, numbers)
        };
        let (wall, contents, numbers) = data_of(ARCH);
        let reals = |name: &str| -> Vec<f64> {
            array::<8>(&contents, &numbers, name).into_iter().map(f64::from_le_bytes).collect()
        };
        let start: Vec<i32> =
            array::<4>(&contents, &numbers, "outline/start").into_iter().map(i32::from_le_bytes).collect();
        let (x, y) = (reals("outline/x"), reals("outline/y"));
        let centres = [reals("outline/centre_x"), reals("outline/centre_y")];
        assert_eq!((start.len(), x.len()), (8, 2 * 5 + 5 * 4), "springers have five corners");
        for (i, block) in wall.blocks.iter().enumerate() {
            let range = start[i] as usize..start[i + 1] as usize;
            let corners: Vec<[f64; 2]> = range.map(|k| [x[k], y[k]]).collect();
            assert_eq!(corners, block.corners(), "{}", block.name);
            assert_eq!([centres[0][i], centres[1][i]], block.centre(), "{}", block.name);
        }
        let (_, contents, _) = data_of(WALL);
        assert!(contents["arrays"]["outline/start"].is_null() && contents["arrays"]["block/x0"].is_object());
    }

    /// Where there is no room numbers are rounded, to four digits of each block and joint, and then frames are left out; what is kept
    /// says so, and what it is.
    #[test]
    fn data_without_room_are_rounded_and_then_thinned() {
        let file = concio::case::from_str(&ARCH.replace("0.01 s", "0.5 s"), concio::case::Syntax::Toml, None);
        let prepared =
            concio::run::prepare_case(file.expect("a wall").case, std::path::Path::new(".")).expect("a system");
        let mut outcome = concio::run::run_in_memory(&prepared).expect("a run");
        let rows = concio::run::joint_rows(&prepared.model);
        let recording = &mut outcome.recording;
        // What no neighbour foretells, of very different sizes.
        let mut dice = 1u64;
        let rolled = |width: usize| {
            move |k: usize| {
                dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                ((dice >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 10f64.powi(-((k % width % 2) as i32))
            }
        };
        for (width, array) in [
            (outcome.layout.unknowns, &mut recording.frame_displacement),
            (outcome.layout.unknowns, &mut recording.frame_velocity),
            (outcome.layout.unknowns, &mut recording.frame_acceleration),
            (outcome.layout.touching, &mut recording.frame_pressure),
        ] {
            let roll = &mut rolled(width);
            array.iter_mut().enumerate().for_each(|(k, v)| *v = roll(k));
        }
        let content = Content {
            name: "made".into(),
            case: prepared.case.clone(),
            text: None,
            command: None,
            wall: &prepared.model.wall,
            joints: &rows,
            outcome: &outcome,
            summary: &json!({}),
        };
        let frames = outcome.recording.frame_time.len();
        assert!(frames > 200);
        let whole = payload(&content, 1 << 24);
        let (mut rounded, mut thinned) = (0, 0);
        // With a single frame.
        let least = payload(&content, 0).len();
        for room in (1..=8).map(|k| least + (whole.len() + 4 - least) * k / 8) {
            let data = payload(&content, room);
            assert!(data.len() <= room, "{} bytes for {room}", data.len());
            let (contents, numbers) = read_back(&data);
            let (every, told) =
                (contents["frames"]["every"].as_u64().expect("a number") as usize, &contents["frames"]["rounded"]);
            thinned += usize::from(every > 1);
            let rounding = match told.as_array() {
                None => [0.0, 1e-7],
                Some(told) => {
                    rounded += 1;
                    [0, 1].map(|k| told[k].as_f64().expect("a number"))
                }
            };
            assert!(every == 1 || rounding[1] > 0.0, "frames go before digits do");
            let width = outcome.layout.touching;
            let found = pack::read(&contents["arrays"], &numbers, "frame/joint/pressure");
            assert_eq!(found.len(), frames.div_ceil(every) * width);
            for (k, value) in found.iter().enumerate() {
                let expected = outcome.recording.frame_pressure[k / width * every * width + k % width];
                let size = 0.5 * 10f64.powi(-((k % width % 2) as i32));
                assert!((value - expected).abs() <= size * rounding[1] * 1.0001, "{value}, not {expected}");
            }
        }
        assert!(rounded > thinned && thinned > 0, "{rounded} rounded, {thinned} thinned");
        let (contents, _) = read_back(&whole);
        assert!(
            contents["frames"]["every"] == 1 && contents["frames"]["rounded"].is_null(),
            "what has room is left alone"
        );
    }

    #[test]
    fn short_histories_are_kept_whole() {
        let buckets = Buckets::of(3);
        let mut curve = Vec::new();
        buckets.curve(&[1.0, 2.0, 3.0], &mut curve);
        assert_eq!((curve, buckets.times(&[0.0, 0.1, 0.2])), (vec![1.0, 2.0, 3.0], vec![0.0, 0.1, 0.2]));
    }
}
