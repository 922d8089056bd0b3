//! A stored run at one of its frames: displacement, velocity and acceleration of every block, and the relative motion
//! and the forces of every joint by equations (2) to (6) of the theory. Signs are those of the sampled channels.

use crate::law::Stribeck;
use crate::outcome::BondRow;
use crate::store::{FrictionRow, StoredRun};
use crate::wall::End;

/// Motion of a block or of the top beam, relative to the base.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// [m]
    pub displacement: f64,
    /// [m/s]
    pub velocity: f64,
    /// [m/s²]
    pub acceleration: f64,
}

/// Relative motion and forces of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointMotion {
    /// Relative displacement [m]: the gap of a head joint or connection (positive is open), else lower side less upper.
    pub slip: f64,
    /// Its rate [m/s].
    pub velocity: f64,
    /// Its second rate [m/s²].
    pub acceleration: f64,
    /// Elastic force on the lower or left block, against its relative motion [N]; 0 for a rigid joint, whose force follows
    /// from no motion.
    pub elastic: f64,
    /// Viscous force, same sign [N].
    pub damping: f64,
    /// Friction force, same sign [N]: by (6), or as the frame holds it where a law is set-valued or a joint bonded.
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

    /// Motion of the top beam, driven, tied or with mass; at rest when there is none.
    pub fn beam(&self) -> Motion {
        self.beam
    }

    /// Motion of block `block`, below `wall.blocks.len()`.
    pub fn block(&self, block: usize) -> Motion {
        unknown(self.run, self.frame, block)
    }

    /// Relative motion and forces of joint `joint`, below `joints.len()`.
    pub fn joint(&self, joint: usize) -> JointMotion {
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
        JointMotion {
            slip: sign * d,
            velocity: sign * w,
            acceleration: sign * (a.acceleration - b.acceleration),
            elastic: row.elastic_force(d, self.bond(joint)),
            damping: row.damping * w,
            friction: friction(self.run, self.frame, joint, w),
        }
    }
}

impl Moment<'_> {
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
    let recording = &run.outcome.recording;
    let at = frame * run.outcome.layout.unknowns + index;
    Motion {
        displacement: recording.frame_displacement[at],
        velocity: recording.frame_velocity[at],
        acceleration: recording.frame_acceleration[at],
    }
}

/// A beam with mass is the last unknown; the others are sampled channels, a frame being every `frame_every`th sample.
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
    Motion { displacement: of("displacement"), velocity: of("velocity"), acceleration: of("acceleration") }
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
