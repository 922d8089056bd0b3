//! Figures against the numbers of a run.

use concio::case::{self, Syntax};
use concio::run;
use concio::store::{SCHEMA_VERSION, StoredRun};

use super::*;

const WALL: &str = r#"
model = "shear"
[[panel]]
bond = "running"
courses = 3
bricks = 2
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
damping_ratio = 0.05
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m", rigidity = 1000 }
friction = { law = "stribeck", static = 0.6, dynamic = 0.42, slip_velocity = "1 mm/s" }
[load]
top = "10 kN/m"
beam = "driven"
[motion]
duration = "0.02 s"
top = { sine = { amplitude = "2 mm", frequency = "20 Hz" } }
[output]
interval = "0.01 ms"
frames = "0.1 ms"
"#;

fn stored(output: &str) -> StoredRun {
    let file = case::from_str(&format!("{WALL}{output}"), Syntax::Toml, None).expect("a wall");
    let prepared = run::prepare(file.case, std::path::Path::new(".")).expect("a system");
    let outcome = run::run_in_memory(&prepared).expect("a run");
    let joints = run::joint_rows(&prepared.model);
    let (provenance, wall) = (prepared.provenance(), prepared.model.wall);
    StoredRun { schema_version: SCHEMA_VERSION, provenance, wall, joints, outcome }
}

/// Frames and samples tell the same of every joint and block, supports included.
#[test]
fn frames_agree_with_samples() {
    let (asked, plain) = (stored("joints = [\"all\"]\nblocks = [\"all\"]\n"), stored(""));
    let [samples, frames] = [&asked, &plain].map(|run| Data::new(run, [None; 2]).expect("data"));
    let same = |a: &data::Motion, b: &data::Motion| {
        assert!(a.sampled && !b.sampled && b.time.len() == 201);
        let peak = a.displacement.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        for (k, t) in b.time.iter().enumerate() {
            assert!((a.time[10 * k] - t).abs() < 1e-12);
            assert!((a.displacement[10 * k] - b.displacement[k]).abs() <= 1e-12 * peak, "at {t} s");
        }
    };
    for e in 0..asked.joints.len() {
        same(&samples.joint_motion(e).expect("a joint"), &frames.joint_motion(e).expect("a joint"));
    }
    for i in 0..asked.wall.blocks.len() {
        same(&samples.block_motion(i).expect("a block"), &frames.block_motion(i).expect("a block"));
    }
}

/// The area of a friction loop is what the joint dissipates by friction, viscous damping being the rest.
#[test]
fn friction_loops_enclose_the_energy_dissipated() {
    let run = stored("joints = [\"all\"]\n");
    let data = Data::new(&run, [None; 2]).expect("data");
    let mut sum = 0.0;
    for e in (0..run.joints.len()).filter(|&e| run.joints[e].friction.is_some()) {
        let [slip, force] = data.joint_friction(e).expect("a loop");
        sum += slip.windows(2).zip(force.windows(2)).map(|(d, f)| 0.5 * (f[0] + f[1]) * (d[1] - d[0])).sum::<f64>();
    }
    let friction = run.outcome.energies.friction;
    assert!(friction > 1.0 && (sum / friction - 1.0).abs() < 0.02, "{sum} {friction}");
}

/// The default instant is that of the largest displacement; another is that of the nearest frame.
#[test]
fn instants_are_those_of_frames() {
    let run = stored("");
    let data = Data::new(&run, [None; 2]).expect("data");
    let size = |_: &Data, m: &concio::moment::Moment| m.block(6).displacement.abs();
    let peak = data.moment(Instant::Peak, size).expect("a frame");
    let row = |f: usize| run.outcome.recording.frame_displacement[f * run.outcome.layout.unknowns + 6].abs();
    assert_eq!(size(&data, &peak), (0..201).map(row).fold(0.0, f64::max));
    let time = |t: f64| data.moment(Instant::At(t), size).map(|m| m.time());
    assert!((time(0.01234).expect("inside") - 0.0123).abs() < 1e-12);
    assert!((time(0.02).expect("the end") - 0.02).abs() < 1e-12);
    assert!(time(0.021).is_err() && time(-0.001).is_err() && time(f64::NAN).is_err());
}

#[test]
fn windows_cut_histories() {
    let run = stored("");
    let data = Data::new(&run, [Some(0.005), Some(0.01)]).expect("data");
    let history = data.channel("top/force").expect("a channel");
    assert_eq!((history.time.len(), history.values.len()), (501, 501));
    assert!((history.time[0] - 0.005).abs() < 1e-12 && (history.time[500] - 0.01).abs() < 1e-12);
    assert!(Data::new(&run, [Some(0.01), Some(0.005)]).is_err());
}

/// In the deformed wall a block lies where its displacement times the scale puts it.
#[test]
fn blocks_are_drawn_where_they_are() {
    let run = stored("");
    let data = Data::new(&run, [None; 2]).expect("data");
    let options = Options { scale: Some(40.0), at: Instant::At(0.0125), ..Options::default() };
    let svg = draw(Figure::Deformed, &data, &options).expect("a figure").body;
    let bricks = svg.lines().filter(|l| l.contains("<title>p1c"));
    let edge = |l: &str| l.split(['M', ' ', 'H']).nth(2).and_then(|n| n.parse::<f64>().ok()).expect("an edge");
    let left: Vec<f64> = bricks.map(edge).collect();
    let moment = data.moment(Instant::At(0.0125), |_, _| 0.0).expect("a frame");
    let blocks = &run.wall.blocks;
    assert!(left.len() == 7 && moment.block(6).displacement.abs() > 1e-4, "the top moves");
    let place = |i: usize| blocks[i].x[0] + 40.0 * moment.block(i).displacement;
    let per_metre = (left[6] - left[0]) / (place(6) - place(0));
    for i in 0..7 {
        let expected = left[0] + per_metre * (place(i) - place(0));
        assert!((left[i] - expected).abs() < 0.02, "{i}: {} {expected}", left[i]);
    }
}
