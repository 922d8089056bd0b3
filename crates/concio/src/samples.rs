//! Reference problems with known answers: small systems of masses and joints without a wall. Used by tests,
//! benches and documents.

use crate::bond::{Bond, Bonded};
use crate::case::{Beam, DeviceLaw, JointKind, Signal, Sine, Solver};
use crate::device::{self, Device, Law, Nonlinear};
use crate::drift::Tops;
use crate::error::Result;
use crate::excitation::Excitation;
use crate::ground::signal::{GroundMotion, compile};
use crate::law::Stribeck;
use crate::law::{Contact, Elastic, Rub, Support};
use crate::model::{Model, stiffest};
use crate::quantity::{Length, Time};
use crate::record::StopReason;
use crate::simulate::{Sampling, Simulation};
use crate::wall::{Block, End, Joint, PanelInfo, Wall};

/// A joint of a sample: which sides, which laws.
#[derive(Debug, Clone, Copy)]
pub struct Link {
    /// Mass on side a.
    pub a: usize,
    /// Side b.
    pub b: End,
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
    pub fn spring(a: usize, b: End, stiffness: f64, damping: f64) -> Self {
        let elastic = Elastic { stiffness, damping, unilateral: false };
        Link { a, b, elastic, friction: None, rigid: None, bond: None, device: None }
    }
    /// A spring that acts for x_a > x_b alone.
    pub fn unilateral(a: usize, b: End, stiffness: f64) -> Self {
        let elastic = Elastic { stiffness, damping: 0.0, unilateral: true };
        Link { elastic, ..Link::spring(a, b, stiffness, 0.0) }
    }
    /// A rigid contact that never lets x_a exceed x_b, with restitution e.
    pub fn rigid(a: usize, b: End, restitution: f64) -> Self {
        Link { rigid: Some(restitution), ..Link::spring(a, b, 0.0, 0.0) }
    }
    /// A joint that is bonded and rubs, once cracked, under a normal force [N].
    pub fn bonded(a: usize, b: End, bond: Bond, friction: Option<(Stribeck, f64)>) -> Self {
        let elastic = Elastic { stiffness: bond.stiffness, damping: 0.0, unilateral: bond.opens };
        Link { elastic, friction, bond: Some(bond), ..Link::spring(a, b, bond.stiffness, 0.0) }
    }
    /// Friction under a normal force [N].
    pub fn friction(a: usize, b: End, law: Stribeck, normal: f64) -> Self {
        let elastic = Elastic { stiffness: 0.0, damping: 0.0, unilateral: false };
        Link { elastic, friction: Some((law, normal)), ..Link::spring(a, b, 0.0, 0.0) }
    }
    /// A device beside a spring k [N/m] and a dashpot c [N s/m].
    pub fn device(a: usize, b: End, law: Law, stiffness: f64, damping: f64) -> Self {
        Link { device: Some(law), ..Link::spring(a, b, stiffness, damping) }
    }
}

/// Friction (6) that is Coulomb's or Stribeck's but for a transition of width `slip_velocity`/`beta`.
pub fn sharp_friction(static_: f64, dynamic: f64, slip_velocity: f64, beta: f64) -> Stribeck {
    Stribeck { static_, dynamic, slip_velocity, beta, alpha: 0.0 }
}

/// A base acceleration A sin(2π f t) from rest.
///
/// # Errors
/// Numbers that make no sine.
pub fn shaking(acceleration: f64, frequency: f64) -> Result<GroundMotion> {
    let sine = Sine {
        amplitude: None,
        acceleration: Some(acceleration.into()),
        frequency: frequency.into(),
        ramp: Time::from_si(0.0),
        cycles: None,
    };
    compile(&Signal::Sine(sine), std::path::Path::new(""))
}

/// Compiles masses [kg] and links.
pub fn lumped(masses: &[f64], links: &[Link], excitation: Excitation) -> Model {
    let n = masses.len();
    let side = |b: End| match b {
        End::Block(b) => b,
        End::Base => n,
        End::Top => n + 1,
    };
    let block = |i: usize| Block {
        name: format!("m{}", i + 1),
        panel: 0,
        course: 0,
        x: [i as f64, i as f64 + 1.0],
        y: [0.0, 1.0],
        shape: None,
        thickness: 1.0,
        specific_weight: masses[i] * crate::G,
    };
    let panel = PanelInfo {
        name: "sample".into(),
        courses: 1,
        reference_length: 1.0,
        reference_height: 1.0,
        reference_mass: masses[0],
        mortar: [0.0; 2],
        connection: 0.0,
    };
    let kind = |link: &Link| match link.b {
        _ if link.elastic.unilateral || link.rigid.is_some() => JointKind::Head,
        End::Base => JointKind::Base,
        End::Top => JointKind::Top,
        End::Block(_) => JointKind::Bed,
    };
    let joint =
        |link: &Link| Joint { kind: kind(link), a: link.a, b: link.b, weight: 1.0, overlap: 1.0, line: [0.0; 4] };
    let rub = |(e, link): (usize, &Link)| {
        link.friction.map(|(law, normal)| Rub { joint: e as u32, normal: [normal; 2], law })
    };
    let rubs: Vec<Rub> = links.iter().enumerate().filter_map(rub).collect();
    let bonded = |(e, link): (usize, &Link)| {
        let rub = rubs.iter().position(|r| r.joint as usize == e).map(|r| r as u32);
        link.bond.map(|law| Bonded { joint: e as u32, rub, law })
    };
    let bonds: Vec<Bonded> = links.iter().enumerate().filter_map(bonded).collect();
    let rigid = |(e, link): (usize, &Link)| link.rigid.map(|restitution| Contact { joint: e as u32, restitution });
    let sides: Vec<[u32; 2]> = links.iter().map(|l| [l.a as u32, side(l.b) as u32]).collect();
    let elastic: Vec<Elastic> = links.iter().map(|l| l.elastic).collect();
    let named = |(e, link): (usize, &Link)| {
        let joint = e as u32;
        let law = match link.device? {
            Law::Power(_) => DeviceLaw::Viscous,
            Law::BoucWen(_) => DeviceLaw::BoucWen,
            Law::ReCentring(_) => DeviceLaw::ReCentring,
        };
        Some(Device { joint, law })
    };
    let nonlinear = |(e, link): (usize, &Link)| link.device.map(|law| Nonlinear { joint: e as u32, law });
    let devices = links.iter().enumerate().filter_map(named).collect();
    let nonlinear: Vec<Nonlinear> = links.iter().enumerate().filter_map(nonlinear).collect();
    let stiffest = stiffest(masses, &sides, &device::at_rest(&elastic, &nonlinear), excitation.duration);
    let contacts: Vec<Contact> = links.iter().enumerate().filter_map(rigid).collect();
    let support = |side| Support::of(side, &sides, &rubs, &bonds, &contacts, &nonlinear);
    let (on_base, on_beam) = (support(n), support(n + 1));
    let wall = Wall { panels: vec![panel], blocks: (0..n).map(block).collect() };
    let joints: Vec<Joint> = links.iter().map(joint).collect();
    Model {
        tops: Tops::of(&wall, &joints, excitation.driven.then_some(n + 1)),
        wall,
        joints,
        beam: if excitation.driven { Beam::Driven } else { Beam::Free },
        top_load: 0.0,
        load_mass: 0.0,
        mass: masses.to_vec(),
        sides,
        elastic,
        bonds,
        devices,
        nonlinear,
        rubs,
        contacts,
        on_base,
        on_beam,
        excitation,
        reciprocal: true,
        stiffest,
        planar: None,
        warnings: Vec::new(),
    }
}

/// Histories of a sample, every `interval` from t = 0.
#[derive(Debug, Clone)]
pub struct Histories {
    /// Rows of displacements relative to the base [m], one value per mass.
    pub displacement: Vec<Vec<f64>>,
    /// Rows of velocities relative to the base [m/s].
    pub velocity: Vec<Vec<f64>>,
    /// Largest residual of the energy account over the largest energy in play, initial or brought in.
    pub residual: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Why it ended.
    pub stop_reason: StopReason,
}

/// Runs a sample from given displacements and velocities.
///
/// # Errors
/// As [`Simulation::new`].
pub fn respond(model: &Model, solver: &Solver, interval: f64, z: &[f64], v: &[f64]) -> Result<Histories> {
    let sampling = Sampling { interval, frame_every: 1, blocks: Vec::new(), joints: Vec::new() };
    let mut run = Simulation::new(model, solver, &sampling)?;
    run.start_from(z, v);
    let (rows, stop_reason) = run.run_to_end();
    let n = model.unknowns();
    let by_row = |values: &[f64]| values.chunks(n).map(<[f64]>::to_vec).collect();
    let state = run.state();
    let scale = state.totals.peak_input.max(state.energies.initial.abs());
    Ok(Histories {
        displacement: by_row(&rows.frame_displacement),
        velocity: by_row(&rows.frame_velocity),
        residual: if scale > 0.0 { state.totals.peak_residual / scale } else { 0.0 },
        steps: state.counters.steps,
        stop_reason,
    })
}

/// A solver of the given scheme and tolerance, without a floor that matters.
pub fn solver(scheme: crate::case::Scheme, tolerance: f64) -> Solver {
    Solver { scheme, tolerance, floor: Length::from_si(1e-15), max_step: None, step: None }
}
