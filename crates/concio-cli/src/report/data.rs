//! What the page's program gets: a table of contents in JSON, and the numbers behind it in base64.

use concio::case::Beam;
use concio::ground::response_spectrum;
use concio::outcome::BondRow;
use concio::store::{FrictionRow, JointRow};
use concio::wall::{Block, End};
use serde_json::{Value, json};

use super::pack::Pack;
use super::{Content, beam_label};

/// Layout of the data; the page's program refuses another.
const LAYOUT: u32 = 4;
/// Bytes that frames may take [bytes]; beyond it only every second, third, … goes into the page. A wall of 20 × 20 bricks
/// with 2,000 frames stays below.
const MOST_FRAMES: usize = 16 << 20;
/// Bytes of one value of an unknown in one frame, and of a joint's.
const VALUE: [usize; 2] = [5, 4];
/// Points of a history; a longer one is drawn by the lowest and highest value of short intervals.
const MOST_POINTS: usize = 6000;
/// Histories that the page gets beyond those that every run keeps.
const MOST_ASKED: usize = 80;
/// Damping ratio of the spectrum.
const DAMPING: f64 = 0.05;
/// Periods of the spectrum [s]: that many from the shortest to the longest, at equal ratios.
const PERIODS: (usize, f64, f64) = (180, 0.02, 4.0);

/// The table of contents as JSON that may stand in a page, and the numbers in base64.
pub fn payload(content: &Content) -> (String, String) {
    let mut pack = Pack::default();
    let frames = frames(&mut pack, content);
    let (channels, curve) = histories(&mut pack, content, &frames);
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
            "bytes": frames.bytes,
            "most": MOST_FRAMES,
        },
        "curve": curve,
        "channels": channels,
        "spectrum": spectrum,
        "arrays": arrays,
    });
    // No text in it can end the script element that it stands in.
    (contents.to_string().replace('<', "\\u003c"), numbers)
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
    /// Bytes of one frame.
    bytes: usize,
}

fn frames(pack: &mut Pack, content: &Content) -> Kept {
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
    let of_joints = if content.is_planar() { touching.len() * layout.touching } else { 0 };
    let bytes = VALUE[0] * unknowns * moving.iter().flatten().count() + VALUE[1] * of_joints;
    let every = (recorded * bytes).div_ceil(MOST_FRAMES).max(1);
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
        pack.rows(&format!("frame/{name}"), rows.chunks_exact(unknowns));
    }
    for (name, values) in touching {
        let width = if name == "friction" { layout.held } else { layout.touching };
        if width > 0 {
            let rows = kept.iter().flat_map(|&k| &values[k * width..][..width]);
            pack.curves(&format!("frame/joint/{name}"), &rows.map(|f| *f as f32).collect::<Vec<_>>());
        }
    }
    if !content.outcome.bonds.is_empty() && !content.is_planar() {
        let beam = content.history("beam/displacement");
        let of_beam = |sample: usize| beam.as_ref().and_then(|b| b.get(sample)).copied().unwrap_or(0.0);
        let rows = kept.iter().zip(&samples).flat_map(|(&k, &sample)| elastic_forces(content, k, of_beam(sample)));
        pack.curves("frame/joint/elastic", &rows.map(|f| f as f32).collect::<Vec<_>>());
    }
    Kept { every, standing: recording.standing(&times), samples, beam: has_beam, bytes }
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
    pack.curves("curve/values", &curves);
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
    fn curve(&self, values: &[f64], into: &mut Vec<f32>) {
        if self.buckets == 0 {
            into.extend(values.iter().map(|v| *v as f32));
            return;
        }
        for bucket in 0..self.buckets {
            let [start, end] = self.ends(bucket);
            let part = &values[start..end];
            let by_value = |a: &usize, b: &usize| part[*a].total_cmp(&part[*b]);
            let low = (0..part.len()).min_by(by_value).unwrap_or(0);
            let high = (0..part.len()).max_by(by_value).unwrap_or(0);
            into.extend([low.min(high), low.max(high)].map(|k| part[k] as f32));
        }
    }
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
        pack.reals(&format!("envelope/{name}"), values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_keep_every_peak_and_their_order() {
        let mut values = vec![0.0; 100_000];
        (values[31_415], values[92_653], values[92_654]) = (7.0, -3.0, 5.0);
        let buckets = Buckets::of(values.len());
        let mut curve = Vec::new();
        buckets.curve(&values, &mut curve);
        assert_eq!(curve.len(), buckets.points());
        assert_eq!(curve.len(), MOST_POINTS);
        let nonzero: Vec<f32> = curve.iter().copied().filter(|v| *v != 0.0).collect();
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

    /// The array of that name in a payload, of numbers of `N` bytes.
    fn array<const N: usize>(contents: &Value, numbers: &[u8], name: &str) -> Vec<[u8; N]> {
        let place = &contents["arrays"][name];
        let [at, count] = ["at", "count"].map(|key| place[key].as_u64().expect(name) as usize);
        numbers[at..][..N * count].as_chunks::<N>().0.to_vec()
    }

    /// What frames hold of blocks and joints of a planar run, the beam among them, comes out of the page's numbers.
    #[test]
    fn frames_of_planar_runs_bring_rotations_and_joints() {
        use base64::Engine as _;
        use concio::record::{Event, EventKind};
        let file = concio::case::from_str(WALL, concio::case::Syntax::Toml, None).expect("a wall");
        let prepared = concio::run::prepare(file.case, std::path::Path::new(".")).expect("a system");
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
        let (contents, numbers) = payload(&content);
        let contents: Value = serde_json::from_str(&contents).expect("JSON");
        let numbers = base64::engine::general_purpose::STANDARD.decode(numbers).expect("base64");
        assert_eq!((&contents["planar"], &contents["beam"]["moves"]), (&json!(true), &json!(true)));
        assert_eq!((&contents["frames"]["every"], &contents["frames"]["standing"]), (&json!(1), &json!(3)));
        assert_eq!(contents["frames"]["bytes"], json!(25 * columns + 16 * joints));
        let quanta = array::<8>(&contents, &numbers, "frame/rotation/quantum");
        let [low, high] = ["low", "high"].map(|part| format!("frame/rotation/{part}"));
        let (low, high) = (array::<4>(&contents, &numbers, &low), array::<1>(&contents, &numbers, &high));
        assert_eq!((quanta.len(), low.len(), high.len()), (frames, frames * columns, frames * columns));
        for (k, expected) in outcome.recording.frame_rotation.iter().enumerate() {
            let steps = i64::from(i8::from_le_bytes(high[k])) * (1 << 32) + i64::from(u32::from_le_bytes(low[k]));
            let value = steps as f64 * f64::from_le_bytes(quanta[k / columns]);
            assert!((value - expected).abs() <= 1e-11 * expected.abs().max(0.1), "{k}: {value}, not {expected}");
        }
        for name in ["slip", "opening", "pressure", "friction"] {
            let found = array::<4>(&contents, &numbers, &format!("frame/joint/{name}"));
            let found: Vec<f32> = found.into_iter().map(f32::from_le_bytes).collect();
            let expected: Vec<f32> = made(joints, 3.0).iter().map(|v| *v as f32).collect();
            assert_eq!(found, expected, "{name}");
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
        use base64::Engine as _;
        let data_of = |text: &str| {
            let file = concio::case::from_str(text, concio::case::Syntax::Toml, None).expect("a wall");
            let prepared = concio::run::prepare(file.case, std::path::Path::new(".")).expect("a system");
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
            let (contents, numbers) = payload(&content);
            let contents: Value = serde_json::from_str(&contents).expect("JSON");
            let numbers = base64::engine::general_purpose::STANDARD.decode(numbers).expect("base64");
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

    #[test]
    fn short_histories_are_kept_whole() {
        let buckets = Buckets::of(3);
        let mut curve = Vec::new();
        buckets.curve(&[1.0, 2.0, 3.0], &mut curve);
        assert_eq!((curve, buckets.times(&[0.0, 0.1, 0.2])), (vec![1.0, 2.0, 3.0], vec![0.0, 0.1, 0.2]));
    }
}
