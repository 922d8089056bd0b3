//! What the schemes advance.

use peer_system::System;

/// Displacements [m] and velocities [m/s] at a time [s].
#[derive(Debug, Clone)]
pub struct Motion {
    pub t: f64,
    pub z: Vec<f64>,
    pub v: Vec<f64>,
    /// Mean friction force of every joint over the last step [N], as the scheme found it; with set-valued friction the
    /// motion alone does not tell it.
    pub friction: Vec<f64>,
}

impl Motion {
    pub fn at_rest(system: &System) -> Self {
        let zeros = vec![0.0; system.mass.len()];
        Motion { t: 0.0, z: zeros.clone(), v: zeros, friction: vec![0.0; system.joints.len()] }
    }
}

/// Work of a run.
#[derive(Debug, Default)]
pub struct Counts {
    /// Newton iterations, or sweeps over all joints.
    pub iterations: u64,
    pub factorisations: u64,
    /// Steps or stages whose iteration was cut off.
    pub unconverged: u64,
}

/// A scheme.
pub trait Step {
    /// Goes from `motion.t` to `motion.t + h`, of which the caller sets the time.
    fn step(&mut self, system: &System, motion: &mut Motion, h: f64, counts: &mut Counts) -> Result<(), String>;
}
