//! Work and force of the top, slip, and how often joints let go or get stuck.

use peer_system::{Side, Support, System};

use crate::motion::Motion;

/// Sums over a run.
pub struct Account {
    /// Work of the top beam [J].
    pub work: f64,
    /// Integral of the square of its force [N² s], and the largest.
    pub square: f64,
    pub largest: f64,
    /// Integral of |relative velocity| above δ_v over all joints that rub [m].
    pub slip: f64,
    /// Changes between below and above δ_v: where a scheme that locates events would stop.
    pub events: u64,
    slipping: Vec<bool>,
}

impl Account {
    pub fn new(system: &System) -> Self {
        let slipping = vec![false; system.joints.len()];
        Account { work: 0.0, square: 0.0, largest: 0.0, slip: 0.0, events: 0, slipping }
    }

    /// A step, its forces at its middle.
    pub fn add(&mut self, system: &System, before: &Motion, after: &Motion, h: f64) {
        let middle: Vec<f64> = [(&before.z, &after.z), (&before.v, &after.v)]
            .into_iter()
            .flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)))
            .collect();
        let top = system.top(after.t - 0.5 * h);
        let mut force = 0.0;
        for (e, joint) in system.joints.iter().enumerate() {
            let (d, w) = system.relative(joint, &middle, top);
            if joint.b == Side::Support(Support::Top) {
                force -= joint.stiffness * d + joint.damping * w + after.friction[e];
            }
            let Some(friction) = joint.friction else { continue };
            let slipping = w.abs() > friction.slip_velocity;
            if slipping {
                self.slip += h * w.abs();
            }
            self.events += u64::from(slipping != self.slipping[e]);
            self.slipping[e] = slipping;
        }
        self.work += h * force * top.1;
        self.square += h * force * force;
        self.largest = self.largest.max(force.abs());
    }
}
