//! A stored run at one of its frames: displacement, velocity and acceleration of every block, and the relative motion
//! and the forces of every joint, in the shear model by equations (2) to (6) of the theory, in the planar model as the
//! frame holds them. Signs are those of the sampled channels.

use crate::bond::BondRow;
use crate::record::Motion;
use crate::store::{FrictionRow, StoredRun};
use crate::wall::End;
use concio_law::friction::Stribeck;

/// Relative motion and forces of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointMotion {
    /// Relative displacement [m]. In the shear model the gap of a head joint or connection (positive is open), else lower
    /// side less upper. In the planar model the sliding along the joint: of an upright one how far the left side has risen
    /// over the right one, else lower side less upper.
    pub slip: f64,
    /// Widest opening over the length of the joint [m], from 0; in the shear model only head joints and connections open.
    pub opening: f64,
    /// Normal force [N], positive in compression. In the shear model the elastic force of an upright joint, and what is
    /// carried by a joint that rubs.
    pub pressure: f64,
    /// Rate of the relative displacement [m/s]; 0 in the planar model, whose frames hold no rates of joints.
    pub velocity: f64,
    /// Its second rate [m/s²]; 0 in the planar model.
    pub acceleration: f64,
    /// Elastic force on the lower or left block, against its relative motion [N]; 0 for a rigid joint, whose force follows
    /// from no motion, and in the planar model, where `pressure` and `friction` are the whole force.
    pub elastic: f64,
    /// Viscous force, same sign [N]; 0 in the planar model.
    pub damping: f64,
    /// Friction force, same sign [N]: by (6), or as the frame holds it where a law is set-valued or a joint bonded. In the
    /// planar model the whole tangential force.
    pub friction: f64,
}

/// One frame of a run.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'r> {
    run: &'r StoredRun,
    frame: usize,
    beam: Motion,
}

impl<'r> Moment<'r> {
    /// Frame `frame` of `run`; none when the run has no such frame.
    pub fn of(run: &'r StoredRun, frame: usize) -> Option<Self> {
        let recording = &run.outcome.recording;
        recording.frame_time.get(frame)?;
        Some(Moment { run, frame, beam: beam(run, frame) })
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.run.outcome.recording.frame_time[self.frame]
    }

    /// Motion of the top beam, free, driven, tied or with mass; at rest when there is none.
    pub fn beam(&self) -> Motion {
        self.beam
    }

    /// Motion of block `block`, below `wall.blocks.len()`.
    pub fn block(&self, block: usize) -> Motion {
        unknown(self.run, self.frame, block)
    }

    /// Relative motion and forces of joint `joint`, below `joints.len()`.
    pub fn joint(&self, joint: usize) -> JointMotion {
        if let Some(held) = self.held(joint) {
            return held;
        }
        let row = &self.run.joints[joint];
        let a = self.block(row.joint.a);
        let b = match row.joint.b {
            End::Block(b) => self.block(b),
            End::Base => Motion::default(),
            End::Top => self.beam,
        };
        let (d, w) = (a.displacement - b.displacement, a.velocity - b.velocity);
        let upright = row.joint.kind.is_upright();
        let sign = if upright { -1.0 } else { 1.0 };
        let elastic = row.elastic_force(d, self.bond(joint));
        JointMotion {
            slip: sign * d,
            opening: if upright { (-d).max(0.0) } else { 0.0 },
            pressure: if upright { elastic } else { row.normal_force[0] },
            velocity: sign * w,
            acceleration: sign * (a.acceleration - b.acceleration),
            elastic,
            damping: row.damping * w,
            friction: friction(self.run, self.frame, joint, w),
        }
    }
}

impl Moment<'_> {
    /// What the frame holds of a joint; none in the shear model, where it follows from the motion of its sides.
    fn held(&self, joint: usize) -> Option<JointMotion> {
        let (layout, recording) = (&self.run.outcome.layout, &self.run.outcome.recording);
        let at = self.frame * layout.touching + joint;
        let of = |rows: &[f64]| rows.get(at).copied().filter(|_| layout.touching > 0);
        Some(JointMotion {
            slip: of(&recording.frame_slip)?,
            opening: of(&recording.frame_opening)?,
            pressure: of(&recording.frame_pressure)?,
            friction: recording.frame_friction.get(self.frame * layout.held + joint).copied().unwrap_or(0.0),
            ..JointMotion::default()
        })
    }

    /// Damage of a joint, 0 … 1; none for a joint without bond.
    pub fn damage(&self, joint: usize) -> Option<f64> {
        self.bond(joint).map(|(_, damage)| damage)
    }

    fn bond(&self, joint: usize) -> Option<(&BondRow, f64)> {
        let bonds = &self.run.outcome.bonds;
        // In the order of the joints.
        let b = bonds.binary_search_by_key(&joint, |bond| bond.joint).ok()?;
        let damage = *self.run.outcome.recording.frame_damage.get(self.frame * bonds.len() + b)?;
        Some((&bonds[b], damage))
    }
}

fn unknown(run: &StoredRun, frame: usize, index: usize) -> Motion {
    Motion::in_frame(&run.outcome.layout, &run.outcome.recording, frame, index)
}

/// A beam with motion of its own is the last unknown; the others are sampled channels, a frame being every `frame_every`th sample.
fn beam(run: &StoredRun, frame: usize) -> Motion {
    let layout = &run.outcome.layout;
    if layout.unknowns > run.wall.blocks.len() {
        return unknown(run, frame, layout.unknowns - 1);
    }
    let sample = frame * layout.frame_every;
    let width = layout.channels.len();
    let value = |name: &str| {
        let at = layout.channels.iter().position(|c| c.name == name)?;
        run.outcome.recording.values.get(sample * width + at).copied()
    };
    let of = |quantity: &str| value(&format!("beam/{quantity}")).unwrap_or(0.0);
    Motion {
        displacement: of("displacement"),
        velocity: of("velocity"),
        acceleration: of("acceleration"),
        ..Motion::default()
    }
}

/// What a frame holds of a joint's friction [N], or (6) at the relative velocity `w`.
fn friction(run: &StoredRun, frame: usize, joint: usize, w: f64) -> f64 {
    let held = run.outcome.layout.held;
    if held > 0 {
        return run.outcome.recording.frame_friction[frame * held + joint];
    }
    let row = &run.joints[joint];
    let law = |f: &FrictionRow| Stribeck {
        static_: f.static_,
        dynamic: f.dynamic,
        slip_velocity: f.slip_velocity,
        beta: f.beta,
        alpha: f.alpha,
    };
    row.friction.as_ref().map_or(0.0, |f| row.normal_force[0] * law(f).value(w))
}
