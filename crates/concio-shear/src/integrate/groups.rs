//! Blocks that hang together by sticking joints, or press each other in rigid ones.

use crate::system::System;

/// Scratch for groups of unknowns; base and top count as two more.
#[derive(Debug, Clone)]
pub struct Groups {
    /// A member nearer to the head of the group; the head itself for a head. Heads have the largest number of their
    /// group, so that a support heads the group that sticks to it.
    above: Vec<u32>,
    mass: Vec<f64>,
    sum: Vec<f64>,
}

impl Groups {
    /// For `n` unknowns.
    pub fn new(n: usize) -> Self {
        Groups { above: vec![0; n + 2], mass: vec![0.0; n + 2], sum: vec![0.0; n + 2] }
    }

    fn head(&mut self, mut i: u32) -> u32 {
        while self.above[i as usize] != i {
            let up = self.above[self.above[i as usize] as usize];
            self.above[i as usize] = up;
            i = up;
        }
        i
    }

    /// The groups that the joints with `stuck` (one value per rubbing joint) and `contact` (one per rigid joint) make.
    pub fn find(&mut self, system: &System, stuck: &[bool], contact: &[bool]) {
        for (i, above) in self.above.iter_mut().enumerate() {
            *above = i as u32;
        }
        for (rub, _) in system.rubs.iter().zip(stuck).filter(|(_, stuck)| **stuck) {
            self.join(system.sides[rub.joint as usize]);
        }
        for (rigid, _) in system.contacts.iter().zip(contact).filter(|(_, contact)| **contact) {
            self.join(system.sides[rigid.joint as usize]);
        }
    }

    fn join(&mut self, sides: [u32; 2]) {
        let [a, b] = sides.map(|s| self.head(s));
        self.above[a.min(b) as usize] = a.max(b);
    }

    /// Gives every group the mean of its members by mass, or the value of the support that heads it. Momentum is kept.
    pub fn average(&mut self, mass: &[f64], values: &mut [f64]) {
        let n = mass.len();
        self.mass.fill(0.0);
        self.sum.fill(0.0);
        for i in 0..n {
            let head = self.head(i as u32) as usize;
            self.mass[head] += mass[i];
            self.sum[head] += mass[i] * values[i];
        }
        for i in 0..n {
            let head = self.head(i as u32) as usize;
            if head >= n {
                values[i] = values[head];
            } else if self.mass[head] > mass[i] {
                values[i] = self.sum[head] / self.mass[head];
            }
        }
    }

    /// Finds the groups and gives each one velocity. A rigid joint among `touching` whose sides approach each other
    /// after that, by what the mean has moved them, is closed too: none is left that does.
    pub fn rest(&mut self, system: &System, stuck: &[bool], contact: &mut [bool], touching: &[bool], v: &mut [f64]) {
        for _ in 0..=contact.len() {
            self.find(system, stuck, contact);
            self.average(&system.mass, v);
            let mut closed = false;
            for (c, rigid) in system.contacts.iter().enumerate() {
                let [a, b] = system.sides[rigid.joint as usize].map(|s| s as usize);
                if touching[c] && !contact[c] && v[a] > v[b] {
                    contact[c] = true;
                    closed = true;
                }
            }
            if !closed {
                return;
            }
        }
    }
}
