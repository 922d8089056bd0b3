//! Results of planar walls, made by hand: blocks that rise and turn are written, read back, exported, resumed from the
//! journal and told of a frame as they are held.

use std::fs;
use std::io::Read;
use std::path::Path;

use crate::store_sample::{SMALL, Sample, Size, reshape, rows, sample};
use concio::moment::Moment;
use concio::record::EventKind;
use concio::record::Motion;
use concio::store::{self, Journal, JournalHeader, RunFacts, StoredRun, export, hdf5};

const PLANAR: Size = Size { planar: true, ..SMALL };

fn stored(s: Sample) -> StoredRun {
    let Sample { provenance, wall, joints, outcome } = s;
    StoredRun { schema_version: store::SCHEMA_VERSION, provenance, wall, joints, outcome }
}

fn write(path: &Path, run: &StoredRun) -> concio::Result<()> {
    hdf5::write(path, &run.provenance, &run.wall, &run.joints, &run.outcome)
}

/// One frame in which nothing moves, for a test to move something in.
fn still() -> StoredRun {
    let mut run = stored(sample(Size { samples: 1, frame_every: 1, ..PLANAR }));
    for array in [
        &mut run.outcome.recording.frame_displacement,
        &mut run.outcome.recording.frame_vertical,
        &mut run.outcome.recording.frame_rotation,
    ] {
        array.fill(0.0);
    }
    run
}

#[test]
fn blocks_that_rise_and_turn_are_read_back_as_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    for size in [PLANAR, Size { beam: false, ..PLANAR }, Size { frame_every: 0, ..PLANAR }] {
        let run = stored(sample(size));
        write(&path, &run).unwrap();
        let read = hdf5::read(&path).unwrap();
        assert!(read == run, "{size:?}");
        assert_eq!(read.provenance.model, "planar");
        assert_eq!(read.outcome.layout.turned, read.outcome.layout.unknowns);
        assert_eq!(read.outcome.layout.touching, read.joints.len());
        assert_eq!(read.outcome.counters.unsolved, 90);
        assert!(read.outcome.recording.events.iter().any(|e| e.kind == EventKind::Collapse));
    }
}

#[test]
fn a_layout_that_holds_some_of_the_rotations_or_slips_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    let mut run = stored(sample(PLANAR));
    run.outcome.layout.turned -= 1;
    let error = write(&path, &run).unwrap_err().to_string();
    assert!(error.contains("12 rotations for 13 unknowns"), "{error}");
    let mut run = stored(sample(PLANAR));
    run.outcome.layout.touching = 1;
    let error = write(&path, &run).unwrap_err().to_string();
    assert!(error.contains("1 slips for"), "{error}");
    let mut run = stored(sample(PLANAR));
    run.outcome.recording.frame_pressure.pop();
    let error = write(&path, &run).unwrap_err().to_string();
    assert!(error.contains("frames of pressure"), "{error}");
    assert!(!path.exists());
}

#[test]
fn a_planar_run_resumes_from_its_journal() {
    let s = sample(PLANAR);
    let folder = tempfile::tempdir().unwrap();
    let (inputs_hash, version) = (s.provenance.inputs_hash.clone(), s.provenance.version.clone());
    let header = JournalHeader { inputs_hash, version, layout: s.outcome.layout.clone() };
    let mut journal = Journal::create(folder.path(), &header, || Ok(())).unwrap();
    journal.append(&rows(&header.layout, 0..150)).unwrap();
    journal.checkpoint(b"state").unwrap();
    journal.append(&rows(&header.layout, 150..170)).unwrap();
    drop(journal);
    let mut of_shear = header.clone();
    (of_shear.layout.turned, of_shear.layout.touching) = (0, 0);
    assert!(Journal::resume(folder.path(), &of_shear).unwrap().is_none(), "rows of another model");
    let (mut journal, state) = Journal::resume(folder.path(), &header).unwrap().unwrap();
    assert_eq!(state, b"state");
    journal.append(&rows(&header.layout, 150..401)).unwrap();
    assert!(journal.read_all().unwrap() == s.outcome.recording);
}

#[test]
fn an_archive_holds_what_the_frames_of_a_planar_run_hold() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.npz");
    let run = stored(sample(PLANAR));
    export::npz(&run, &path).unwrap();
    let mut zip = zip::ZipArchive::new(fs::File::open(&path).unwrap()).unwrap();
    let mut array = |name: &str| {
        let mut bytes = Vec::new();
        zip.by_name(&format!("frames/{name}.npy")).unwrap().read_to_end(&mut bytes).unwrap();
        let file = npyz::NpyFile::new(&bytes[..]).unwrap();
        (file.shape().to_vec(), file.into_vec::<f64>().unwrap())
    };
    let (layout, recording) = (&run.outcome.layout, &run.outcome.recording);
    let frames = recording.frame_time.len() as u64;
    for (name, width, values) in [
        ("vertical", layout.turned, &recording.frame_vertical),
        ("rotation", layout.turned, &recording.frame_rotation),
        ("slip", layout.touching, &recording.frame_slip),
        ("opening", layout.touching, &recording.frame_opening),
        ("pressure", layout.touching, &recording.frame_pressure),
        ("friction", layout.touching, &recording.frame_friction),
    ] {
        assert_eq!(array(name), (vec![frames, width as u64], values.clone()), "{name}");
    }
    let tables = folder.path().join("csv");
    export::csv(&run, &tables).unwrap();
    let events = fs::read_to_string(tables.join("events.csv")).unwrap();
    assert!(events.lines().any(|line| line.contains(",collapse,") && line.ends_with(",m")), "{events}");
}

#[test]
fn the_summary_names_the_model_and_the_steps_left_unsolved() {
    let s = sample(PLANAR);
    let summary = store::summary(&s.provenance, &s.wall, &s.joints, &s.outcome, &RunFacts::default());
    assert_eq!(summary["model"], "planar");
    assert_eq!(summary["counters"]["unsolved"], 90);
}

/// Corners of a block turned by a right angle and moved, from the rectangle by hand: counterclockwise, the bottom left corner
/// comes to the bottom right.
#[test]
fn the_corners_in_a_vtkhdf_file_are_those_of_the_turned_rectangle() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let mut run = still();
    let block = 5;
    let recording = &mut run.outcome.recording;
    recording.frame_displacement[block] = 0.25;
    recording.frame_vertical[block] = 0.5;
    recording.frame_rotation[block] = std::f64::consts::FRAC_PI_2;
    export::vtkhdf(&run, &path).unwrap();
    let file = rust_hdf5::H5File::open(&path).unwrap();
    let rest: Vec<f64> = file.dataset("VTKHDF/Points").unwrap().read_raw().unwrap();
    let moved: Vec<f32> = file.dataset("VTKHDF/PointData/displacement").unwrap().read_raw().unwrap();
    let turned: Vec<f32> = file.dataset("VTKHDF/CellData/rotation").unwrap().read_raw().unwrap();
    assert_eq!(moved.len(), rest.len());
    assert_eq!(turned[block], std::f32::consts::FRAC_PI_2);
    let place = |corner: usize| {
        let at = 3 * (4 * block + corner);
        [0, 1, 2].map(|k| rest[at + k] + f64::from(moved[at + k]))
    };
    let of = &run.wall.blocks[block];
    let ([x, y], [l, h]) = (of.centre(), [0.5 * of.length(), 0.5 * of.height()]);
    let expected = [[h, -l], [h, l], [-h, l], [-h, -l]];
    for (corner, [dx, dy]) in expected.into_iter().enumerate() {
        let wanted = [x + 0.25 + dx, y + 0.5 + dy, 0.0];
        let error = (0..3).map(|k| (place(corner)[k] - wanted[k]).abs()).fold(0.0, f64::max);
        assert!(error < 1e-7, "corner {corner}: {:?}, not {wanted:?}", place(corner));
    }
    assert!(moved.iter().enumerate().all(|(k, value)| k / 12 == block || *value == 0.0), "other blocks are at rest");
}

/// Of polygons cells have their corners, moved about their centres of gravity; area times density and thickness is the mass.
#[test]
fn cells_of_polygons_have_their_area_and_move_about_their_centres() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let mut run = still();
    reshape(&mut run.wall);
    let (triangle, pentagon) = (4, 5);
    let turn = -2.0_f64;
    for block in [triangle, pentagon] {
        run.outcome.recording.frame_displacement[block] = 0.25;
        run.outcome.recording.frame_vertical[block] = -0.5;
        run.outcome.recording.frame_rotation[block] = turn;
    }
    export::vtkhdf(&run, &path).unwrap();
    let file = rust_hdf5::H5File::open(&path).unwrap();
    let rest: Vec<f64> = file.dataset("VTKHDF/Points").unwrap().read_raw().unwrap();
    let moved: Vec<f32> = file.dataset("VTKHDF/PointData/displacement").unwrap().read_raw().unwrap();
    let offsets: Vec<i64> = file.dataset("VTKHDF/Offsets").unwrap().read_raw().unwrap();
    let kinds: Vec<u8> = file.dataset("VTKHDF/Types").unwrap().read_raw().unwrap();
    let masses: Vec<f64> = file.dataset("VTKHDF/CellData/mass").unwrap().read_raw().unwrap();
    assert_eq!(rest.len(), moved.len());
    assert_eq!(rest.len(), 3 * 4 * run.wall.blocks.len(), "a corner less and one more");
    assert_eq!(kinds, [9, 9, 9, 9, 7, 7, 9, 9, 9, 9, 9, 9], "quadrilaterals and polygons");
    for (i, block) in run.wall.blocks.iter().enumerate() {
        let points: Vec<usize> = (offsets[i] as usize..offsets[i + 1] as usize).collect();
        let at = |k: usize| [0, 1].map(|axis| rest[3 * k + axis]);
        let now = |k: usize| [0, 1].map(|axis| rest[3 * k + axis] + f64::from(moved[3 * k + axis]));
        let around = |place: &dyn Fn(usize) -> [f64; 2]| {
            let n = points.len();
            let pairs = (0..n).map(|k| [place(points[k]), place(points[(k + 1) % n])]);
            pairs.map(|[p, q]| 0.5 * (p[0] * q[1] - p[1] * q[0])).sum::<f64>()
        };
        let weight = block.specific_weight * block.thickness;
        assert!((around(&at) * weight / (masses[i] * concio::G) - 1.0).abs() < 1e-12, "{}", block.name);
        assert!((around(&now) / around(&at) - 1.0).abs() < 1e-4, "{}: turning keeps the area", block.name);
    }
    // The centre of a triangle is the mean of its corners; those go round it.
    let first = offsets[triangle] as usize;
    let mean = [0, 1].map(|axis| (0..3).map(|k| rest[3 * (first + k) + axis]).sum::<f64>() / 3.0);
    for k in first..first + 3 {
        let arm = [0, 1].map(|axis| rest[3 * k + axis] - mean[axis]);
        let wanted = [
            0.25 + turn.cos() * arm[0] - turn.sin() * arm[1] - arm[0],
            -0.5 + turn.sin() * arm[0] + turn.cos() * arm[1] - arm[1],
        ];
        let error = (0..2).map(|axis| (f64::from(moved[3 * k + axis]) - wanted[axis]).abs()).fold(0.0, f64::max);
        assert!(error < 1e-7, "corner {k}: {error}");
    }
}

/// The displacement of a corner by a rotation of 1e-9 is 1e-9 times the arm to all digits, and a block keeps its sides.
#[test]
fn a_point_turns_about_the_centre_at_any_rotation() {
    let arm = [0.3, -0.4];
    let small = Motion { rotation: 1e-9, ..Motion::default() }.of_point(arm);
    assert!((small[0] / 4e-10 - 1.0).abs() < 1e-8 && (small[1] / 3e-10 - 1.0).abs() < 1e-8, "{small:?}");
    for rotation in [1e-3, 1.0, 3.0, -20.0] {
        let motion = Motion { rotation, displacement: 0.1, vertical: -0.2, ..Motion::default() };
        let [x, y] = motion.of_point(arm);
        let (x, y) = (arm[0] + x - 0.1, arm[1] + y + 0.2);
        assert!((x.hypot(y) - 0.5).abs() < 1e-15, "{rotation}: {x}, {y}");
        assert!((y.atan2(x) - (arm[1].atan2(arm[0]) + rotation)).sin().abs() < 1e-14, "{rotation}");
    }
}

#[test]
fn a_moment_of_a_planar_run_is_what_its_frame_holds() {
    let run = stored(sample(PLANAR));
    let (layout, recording) = (&run.outcome.layout, &run.outcome.recording);
    let frame = 7;
    let moment = Moment::of(&run, frame).unwrap();
    for block in 0..run.wall.blocks.len() {
        let (motion, at) = (moment.block(block), frame * layout.turned + block);
        assert_eq!([motion.vertical, motion.rotation], [recording.frame_vertical[at], recording.frame_rotation[at]]);
        assert_eq!(motion.displacement, recording.frame_displacement[at]);
    }
    let beam = moment.beam();
    assert_eq!(beam.rotation, recording.frame_rotation[frame * layout.turned + run.wall.blocks.len()]);
    for joint in 0..run.joints.len() {
        let (motion, at) = (moment.joint(joint), frame * layout.touching + joint);
        assert_eq!([motion.slip, motion.opening], [recording.frame_slip[at], recording.frame_opening[at]]);
        assert_eq!([motion.pressure, motion.friction], [recording.frame_pressure[at], recording.frame_friction[at]]);
        assert_eq!([motion.velocity, motion.acceleration, motion.elastic, motion.damping], [0.0; 4]);
    }
}

/// Of a shear run the gap of a head joint is its opening and its elastic force its pressure; bed joints never open.
#[test]
fn a_moment_of_a_shear_run_tells_openings_from_the_motion_of_the_sides() {
    let mut run = stored(sample(SMALL));
    // Friction of all joints or of none, as a run keeps it.
    run.outcome.layout.held = 0;
    let (mut open, mut closed) = (0, 0);
    for frame in 0..run.outcome.recording.frame_time.len() {
        let moment = Moment::of(&run, frame).unwrap();
        for (index, row) in run.joints.iter().enumerate() {
            let motion = moment.joint(index);
            if row.joint.kind.is_upright() {
                assert_eq!((motion.opening, motion.pressure), (motion.slip.max(0.0), motion.elastic));
                open += usize::from(motion.opening > 0.0);
                closed += usize::from(motion.pressure > 0.0);
            } else {
                assert_eq!((motion.opening, motion.pressure), (0.0, row.normal_force[0]));
            }
        }
        assert!((0..run.wall.blocks.len()).all(|b| moment.block(b).rotation == 0.0 && moment.block(b).vertical == 0.0));
    }
    assert!(open > 10 && closed > 10, "{open} {closed}");
}
