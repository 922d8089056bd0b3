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
    run_of(&format!("{WALL}{output}"))
}

fn run_of(wall: &str) -> StoredRun {
    let file = case::from_str(wall, Syntax::Toml, None).expect("a wall");
    let prepared = run::prepare_case(file.case, std::path::Path::new(".")).expect("a system");
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

/// A spectrum is of the whole motion as it was given, whatever time is shown and however seldom the run kept it.
#[test]
fn spectra_are_those_of_the_whole_motion() {
    let base = "base = { synthetic = { seed = 1, pga = \"0.3 g\", duration = \"3 s\" } }";
    let moved = WALL.replace("top = { sine = { amplitude = \"2 mm\", frequency = \"20 Hz\" } }", base);
    let moved = moved.replace("beam = \"driven\"", "beam = \"free\"").replace("duration = \"0.02 s\"", "");
    let run = |interval: &str| run_of(&moved.replace("\"0.01 ms\"", interval).replace("frames = \"0.1 ms\"", ""));
    let curve = |run: &StoredRun, window: [Option<f64>; 2]| {
        let svg =
            draw(Figure::Motion, &Data::new(run, window).expect("data"), &Options::default()).expect("a figure").body;
        let (_, last) = svg.rsplit_once("d=\"M").expect("the curve of the last panel");
        let (curve, _) = last.split_once('"').expect("its end");
        assert!(curve.len() > 500, "{curve}");
        curve.to_string()
    };
    let [fine, coarse] = [run("\"5 ms\""), run("\"50 ms\"")];
    let whole = curve(&fine, [None; 2]);
    assert_eq!(curve(&fine, [Some(1.6), None]), whole);
    assert_eq!(curve(&coarse, [None; 2]), whole);
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

/// A planar run, made by hand of the wall above: in its second frame the last block has slid, risen and turned, the joint
/// under it has opened, and another has slid.
fn planar() -> StoredRun {
    let mut run = stored("");
    let (blocks, joints) = (run.wall.blocks.len(), run.joints.len());
    let outcome = &mut run.outcome;
    let layout = &mut outcome.layout;
    (layout.unknowns, layout.turned) = (blocks + 1, blocks + 1);
    (layout.touching, layout.held) = (joints, joints);
    let recording = &mut outcome.recording;
    recording.frame_time.truncate(2);
    let still = |width: usize| vec![0.0; 2 * width];
    recording.frame_displacement = still(blocks + 1);
    recording.frame_velocity = still(blocks + 1);
    recording.frame_acceleration = still(blocks + 1);
    recording.frame_vertical = still(blocks + 1);
    recording.frame_rotation = still(blocks + 1);
    recording.frame_slip = still(joints);
    recording.frame_opening = still(joints);
    recording.frame_pressure = still(joints);
    recording.frame_friction = still(joints);
    let at = blocks + 1 + (blocks - 1);
    recording.frame_displacement[at] = 0.03;
    recording.frame_vertical[at] = 0.02;
    recording.frame_rotation[at] = TURN;
    let under = bed_under(&run, blocks - 1);
    run.outcome.recording.frame_opening[joints + under] = 4e-3;
    run.outcome.recording.frame_slip[joints] = -2e-3;
    run.provenance.model = "planar".into();
    run
}

const TURN: f64 = 0.4;

fn bed_under(run: &StoredRun, block: usize) -> usize {
    let under =
        |j: &concio::store::JointRow| j.joint.b == concio::wall::End::Block(block) && !j.joint.kind.is_upright();
    run.joints.iter().position(under).expect("a joint")
}

/// Corners of a path over `M x yL x y…`, or of an upright rectangle `M x yH x V y H x z`, as drawn.
fn corners(svg: &str, title: &str) -> Vec<[f64; 2]> {
    let row = svg.lines().find(|l| l.contains(&format!("<title>{title}"))).expect("an element");
    let d = row.split('"').nth(1).expect("a path").trim_start_matches('M').trim_end_matches('z');
    let number = |n: &str| n.parse::<f64>().expect("a number");
    match d.split(['H', 'V']).collect::<Vec<_>>()[..] {
        [start, right, bottom, _] => {
            let (left, top) = start.split_once(' ').expect("a point");
            let [left, top, right, bottom] = [left, top, right, bottom].map(number);
            vec![[left, bottom], [right, bottom], [right, top], [left, top]]
        }
        _ => d.split('L').map(|p| p.split_once(' ').map(|(x, y)| [number(x), number(y)]).expect("a point")).collect(),
    }
}

/// At scale 1 the corners of a block that slid, rose and turned are those of its rectangle, turned about its centre.
#[test]
fn blocks_that_turn_are_drawn_turned() {
    let run = planar();
    let data = Data::new(&run, [None; 2]).expect("data");
    let options = Options { scale: Some(1.0), ..Options::default() };
    let svg = draw(Figure::Deformed, &data, &options).expect("a figure").body;
    let (blocks, last) = (&run.wall.blocks, run.wall.blocks.len() - 1);
    // The first block does not move: it tells where things are drawn.
    let rest = corners(&svg, &blocks[0].name);
    let scale = (rest[1][0] - rest[0][0]) / blocks[0].length();
    let place =
        |p: [f64; 2]| [rest[0][0] + scale * (p[0] - blocks[0].x[0]), rest[0][1] - scale * (p[1] - blocks[0].y[0])];
    let [x, y] = blocks[last].centre();
    let (l, h) = (0.5 * blocks[last].length(), 0.5 * blocks[last].height());
    let drawn = corners(&svg, &blocks[last].name);
    for (corner, [a, b]) in [[-l, -h], [l, -h], [l, h], [-l, h]].into_iter().enumerate() {
        let expected = place([x + 0.03 + TURN.cos() * a - TURN.sin() * b, y + 0.02 + TURN.sin() * a + TURN.cos() * b]);
        let error = (0..2).map(|k| (drawn[corner][k] - expected[k]).abs()).fold(0.0, f64::max);
        assert!(error < 0.05, "corner {corner}: {:?}, not {expected:?}", drawn[corner]);
    }
    assert!(svg.contains("turned by up to 22.9°") && svg.contains("displacements to scale"), "{svg}");
    // Everything is within the width.
    assert!(drawn.iter().all(|p| p[0] > 0.0 && p[0] < options.points() && p[1] > 0.0));
}

/// A pentagon is drawn over its five corners, turned about its centre of gravity and not about the middle of its edges.
#[test]
fn polygons_are_drawn_with_their_corners() {
    let mut run = planar();
    let last = run.wall.blocks.len() - 1;
    let block = &mut run.wall.blocks[last];
    let ([x0, x1], [y0, y1]) = (block.x, block.y);
    let outline = vec![[x0, y0], [x1, y0], [x1, y0 + 0.01], [x0 + 0.1, y1], [x0, y1]];
    block.shape = Some(Box::new(concio::wall::Shape { span: 1, corners: outline.clone() }));
    let data = Data::new(&run, [None; 2]).expect("data");
    let options = Options { scale: Some(1.0), ..Options::default() };
    let svg = draw(Figure::Deformed, &data, &options).expect("a figure").body;
    let still = &run.wall.blocks[0];
    let rest = corners(&svg, &still.name);
    let scale = (rest[1][0] - rest[0][0]) / still.length();
    let place = |p: [f64; 2]| [rest[0][0] + scale * (p[0] - still.x[0]), rest[0][1] - scale * (p[1] - still.y[0])];
    let (drawn, [x, y]) = (corners(&svg, &run.wall.blocks[last].name), run.wall.blocks[last].centre());
    assert!((x - 0.5 * (x0 + x1)).abs() > 0.01, "the centre is elsewhere");
    assert_eq!(drawn.len(), 5);
    for (found, corner) in drawn.iter().zip(&outline) {
        let (a, b) = (corner[0] - x, corner[1] - y);
        let expected = place([x + 0.03 + TURN.cos() * a - TURN.sin() * b, y + 0.02 + TURN.sin() * a + TURN.cos() * b]);
        let error = (0..2).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max);
        assert!(error < 0.05, "{found:?}, not {expected:?}");
    }
}

/// Magnified by 10 the way of every corner is 10 times as long.
#[test]
fn magnified_corners_go_the_same_way_further() {
    let run = planar();
    let data = Data::new(&run, [None; 2]).expect("data");
    let last = run.wall.blocks.len() - 1;
    let way = |scale: f64| {
        let options = Options { scale: Some(scale), ..Options::default() };
        let svg = draw(Figure::Deformed, &data, &options).expect("a figure").body;
        let rest = corners(&svg, &run.wall.blocks[0].name);
        let per_metre = (rest[1][0] - rest[0][0]) / run.wall.blocks[0].length();
        let [still, moved] = [0, last].map(|i| (corners(&svg, &run.wall.blocks[i].name), &run.wall.blocks[i]));
        let from = |(drawn, block): &(Vec<[f64; 2]>, &concio::wall::Block)| {
            [drawn[2][0] / per_metre - block.x[1], -drawn[2][1] / per_metre - block.y[1]]
        };
        [0, 1].map(|k| from(&moved)[k] - from(&still)[k])
    };
    let (once, often) = (way(1.0), way(10.0));
    for k in 0..2 {
        assert!((often[k] / once[k] - 10.0).abs() < 0.1, "{once:?} {often:?}");
    }
}

/// A joint that opened is drawn in the colour of its opening, one that slid alone dashed, the others not at all.
#[test]
fn joints_that_opened_or_slid_lie_over_the_deformed_wall() {
    let run = planar();
    let data = Data::new(&run, [None; 2]).expect("data");
    let svg = draw(Figure::Deformed, &data, &Options::default()).expect("a figure").body;
    let drawn: Vec<&str> = svg.lines().filter(|l| l.contains(": opened ")).collect();
    let [open, slid] = [bed_under(&run, run.wall.blocks.len() - 1), 0].map(|e| run.joints[e].name.as_str());
    assert_eq!(drawn.len(), 2, "{drawn:?}");
    let of = |name: &str| *drawn.iter().find(|l| l.contains(&format!("<title>{name}:"))).expect("a joint");
    assert!(of(open).contains("opened 4.000 mm") && !of(open).contains("dasharray"), "{}", of(open));
    assert!(of(slid).contains("slid −2.000 mm"), "{}", of(slid));
    assert!(of(slid).contains("dasharray"));
    assert!(
        svg.contains("opening of joints [mm]")
            && svg.contains(">4<")
            && svg.contains("slid without opening, up to 2 mm")
    );
    // Nothing of that in a shear run.
    let run = stored("");
    let data = Data::new(&run, [None; 2]).expect("data");
    let svg = draw(Figure::Deformed, &data, &Options::default()).expect("a figure").body;
    assert!(!svg.contains(": opened ") && !svg.contains("turned by"));
}

/// What frames of a planar run do not hold is refused with what to do; openings have a map of their own.
#[test]
fn figures_that_need_velocities_of_joints_say_so() {
    let mut run = planar();
    let joint = run.joints[0].name.clone();
    let data = Data::new(&run, [None; 2]).expect("data");
    let options = Options { joints: vec![joint], ..Options::default() };
    let error = draw(Figure::JointPhase, &data, &options).expect_err("no velocities").to_string();
    assert!(error.contains("was not kept"), "{error}");
    assert!(draw(Figure::JointHistories, &data, &options).is_ok());
    assert!(draw(Figure::Acceleration, &data, &options).is_err());
    run.outcome.envelopes.joint_opening.fill(0.0);
    run.outcome.envelopes.joint_opening[3] = 2e-3;
    let data = Data::new(&run, [None; 2]).expect("data");
    let svg = draw(Figure::Cracks, &data, &Options::default()).expect("a figure").body;
    assert!(svg.contains("opening of joints [mm]") && svg.contains(">2.0<"), "{svg}");
}

/// Joints of a block that has left its neighbours are not drawn, and what comes after a collapse is no peak.
#[test]
fn what_has_fallen_has_no_joints_and_is_no_peak() {
    use concio::record::{Event, EventKind};
    let mut run = planar();
    let (blocks, under) = (run.wall.blocks.len(), bed_under(&run, run.wall.blocks.len() - 1));
    run.outcome.recording.frame_displacement[blocks + 1 + (blocks - 1)] = 1.0;
    let name = run.joints[under].name.clone();
    let joints = |run: &StoredRun| {
        let data = Data::new(run, [None; 2]).expect("data");
        let svg = draw(Figure::Deformed, &data, &Options::default()).expect("a figure").body;
        (svg.lines().filter(|l| l.contains(": opened ")).count(), svg.contains(&format!("<title>{name}: opened")), svg)
    };
    let (drawn, of_fallen, svg) = joints(&run);
    assert_eq!((drawn, of_fallen), (1, false), "{svg}");
    let time = run.outcome.recording.frame_time[0];
    run.outcome.recording.events.push(Event { time, joint: under as u32, kind: EventKind::Collapse, value: 1.0 });
    let (drawn, _, svg) = joints(&run);
    assert_eq!(drawn, 0);
    assert!(svg.contains("t = 0"), "{svg}");
}
