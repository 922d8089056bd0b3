//! Reference problems with known answers: masses and joints, and a base that moves. Used by tests and benches.

use concio_law::bond::Bond;
use concio_law::device::Law;
use concio_law::drift::{Top, Tops};
use concio_law::friction::Stribeck;
use concio_law::motion::{Drive, Excitation, Form, Pieces};

use crate::law::{Bonded, Contact, Elastic, Nonlinear, Rub};
use crate::system::System;

/// The other side of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Another mass.
    Block(usize),
    /// The base.
    Base,
    /// A driven top.
    Top,
}

/// A joint of a sample: which sides, which laws.
#[derive(Debug, Clone, Copy)]
pub struct Link {
    /// Mass on side a.
    pub a: usize,
    /// Side b.
    pub b: Side,
    /// Elastic and viscous part.
    pub elastic: Elastic,
    /// Friction: law and normal force [N].
    pub friction: Option<(Stribeck, f64)>,
    /// Bond; its stiffness is that of `elastic`, whose compression stays to one that opens.
    pub bond: Option<Bond>,
    /// Restitution of a rigid unilateral joint.
    pub rigid: Option<f64>,
    /// What a device does beyond `elastic` and `friction`.
    pub device: Option<Law>,
}

impl Link {
    /// A spring k [N/m] and dashpot c [N s/m].
    pub fn spring(a: usize, b: impl Into<Side>, stiffness: f64, damping: f64) -> Self {
        let elastic = Elastic { stiffness, damping, unilateral: false };
        Link { a, b: b.into(), elastic, friction: None, rigid: None, bond: None, device: None }
    }
    /// A spring that acts for x_a > x_b alone.
    pub fn unilateral(a: usize, b: impl Into<Side>, stiffness: f64) -> Self {
        let elastic = Elastic { stiffness, damping: 0.0, unilateral: true };
        Link { elastic, ..Link::spring(a, b, stiffness, 0.0) }
    }
    /// A rigid contact that never lets x_a exceed x_b, with restitution e.
    pub fn rigid(a: usize, b: impl Into<Side>, restitution: f64) -> Self {
        Link { rigid: Some(restitution), ..Link::spring(a, b, 0.0, 0.0) }
    }
    /// A joint that is bonded and rubs, once cracked, under a normal force [N].
    pub fn bonded(a: usize, b: impl Into<Side>, bond: Bond, friction: Option<(Stribeck, f64)>) -> Self {
        let elastic = Elastic { stiffness: bond.stiffness, damping: 0.0, unilateral: bond.opens };
        Link { elastic, friction, bond: Some(bond), ..Link::spring(a, b, bond.stiffness, 0.0) }
    }
    /// Friction under a normal force [N].
    pub fn friction(a: usize, b: impl Into<Side>, law: Stribeck, normal: f64) -> Self {
        Link { friction: Some((law, normal)), ..Link::spring(a, b, 0.0, 0.0) }
    }
    /// A device beside a spring k [N/m] and a dashpot c [N s/m].
    pub fn device(a: usize, b: impl Into<Side>, law: Law, stiffness: f64, damping: f64) -> Self {
        Link { device: Some(law), ..Link::spring(a, b, stiffness, damping) }
    }
    /// Whether its sides part where those of others slide.
    pub fn is_upright(&self) -> bool {
        self.elastic.unilateral || self.rigid.is_some()
    }
}

/// Masses [kg] and links, for runs of `duration` [s]. The masses lie in a row, each a top of its own course unless a link leads to a driven top.
pub fn lumped(masses: &[f64], links: &[Link], duration: f64) -> System {
    let n = masses.len();
    let side = |b: Side| match b {
        Side::Block(b) => b,
        Side::Base => n,
        Side::Top => n + 1,
    };
    let rub = |(e, link): (usize, &Link)| {
        link.friction.map(|(law, normal)| Rub { joint: e as u32, normal: [normal; 2], law })
    };
    let rubs: Vec<Rub> = links.iter().enumerate().filter_map(rub).collect();
    let bonded = |(e, link): (usize, &Link)| {
        let rub = rubs.iter().position(|r| r.joint as usize == e).map(|r| r as u32);
        link.bond.map(|law| Bonded { joint: e as u32, rub, law })
    };
    let bonds = links.iter().enumerate().filter_map(bonded).collect();
    let rigid = |(e, link): (usize, &Link)| link.rigid.map(|restitution| Contact { joint: e as u32, restitution });
    let nonlinear = |(e, link): (usize, &Link)| link.device.map(|law| Nonlinear { joint: e as u32, law });
    let all: Vec<u32> = (0..n as u32).collect();
    let top = Top { name: "sample".into(), unknowns: all.clone(), height: 0.5 };
    System {
        mass: masses.to_vec(),
        blocks: n,
        sides: links.iter().map(|l| [l.a as u32, side(l.b) as u32]).collect(),
        upright: links.iter().map(Link::is_upright).collect(),
        elastic: links.iter().map(|l| l.elastic).collect(),
        rubs,
        bonds,
        nonlinear: links.iter().enumerate().filter_map(nonlinear).collect(),
        contacts: links.iter().enumerate().filter_map(rigid).collect(),
        centres: (0..n).map(|i| [i as f64 + 0.5, 0.5]).collect(),
        tops: Tops::new(all.clone(), all, vec![top]),
        settles: concio_law::drift::settles(duration, false),
        ..System::default()
    }
    .completed(duration)
}

/// A base that moves.
#[derive(Debug, Clone)]
pub struct Base {
    pieces: Pieces,
    duration: f64,
}

impl Base {
    /// At rest.
    pub fn at_rest(duration: f64) -> Self {
        Base { pieces: Pieces::new(f64::INFINITY), duration }
    }
    /// The acceleration A sin(2π f t) from rest, in steps of a twentieth of its period at most.
    pub fn shaking(acceleration: f64, frequency: f64, duration: f64) -> Self {
        let mut pieces = Pieces::new(0.05 / frequency);
        let omega = std::f64::consts::TAU * frequency;
        pieces.acceleration(0.0, Form::sine_acceleration(0.0, omega, acceleration, 0.0));
        Base { pieces, duration }
    }
}

impl Excitation for Base {
    fn drive(&self, t: f64) -> Drive {
        let base = self.pieces.segment(t);
        let vertical = Base::at_rest(self.duration).pieces.segment(t);
        Drive { base, top: None, vertical, end: base.end.min(self.duration) }
    }
    fn base_velocity_jump(&self, _: f64) -> f64 {
        0.0
    }
    fn duration(&self) -> f64 {
        self.duration
    }
    fn longest_step(&self) -> f64 {
        self.pieces.longest_step
    }
}
