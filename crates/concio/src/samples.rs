//! Reference problems with known answers: small systems of masses and joints without a wall. Used by tests,
//! benches and documents.

use concio_law::device::Law;
use concio_law::friction::Stribeck;
use concio_shear::samples::lumped as compile_links;
pub use concio_shear::samples::{Link, Side};

use crate::case::{Beam, DeviceLaw, JointKind, Signal, Sine, Solver};
use crate::device::Device;
use crate::drift;
use crate::error::Result;
use crate::excitation::Excitation;
use crate::ground::signal::{GroundMotion, compile};
use crate::model::{Model, System};
use crate::quantity::{Length, Time};
use crate::record::StopReason;
use crate::simulate::{Sampling, Simulation};
use crate::wall::{Block, End, Joint, PanelInfo, Wall};

impl From<End> for Side {
    fn from(end: End) -> Side {
        match end {
            End::Block(b) => Side::Block(b),
            End::Base => Side::Base,
            End::Top => Side::Top,
        }
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

/// Masses [kg] and links as a wall of one block for each mass.
pub fn lumped(masses: &[f64], links: &[Link], excitation: Excitation) -> Model {
    let end = |side: Side| match side {
        Side::Block(b) => End::Block(b),
        Side::Base => End::Base,
        Side::Top => End::Top,
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
        _ if link.is_upright() => JointKind::Head,
        Side::Base => JointKind::Base,
        Side::Top => JointKind::Top,
        Side::Block(_) => JointKind::Bed,
    };
    let joint =
        |link: &Link| Joint { kind: kind(link), a: link.a, b: end(link.b), weight: 1.0, overlap: 1.0, line: [0.0; 4] };
    let named = |(e, link): (usize, &Link)| {
        let law = match link.device? {
            Law::Power(_) => DeviceLaw::Viscous,
            Law::BoucWen(_) => DeviceLaw::BoucWen,
            Law::ReCentring(_) => DeviceLaw::ReCentring,
        };
        Some(Device { joint: e as u32, law })
    };
    let wall = Wall { panels: vec![panel], blocks: (0..masses.len()).map(block).collect() };
    let joints: Vec<Joint> = links.iter().map(joint).collect();
    let tops = drift::tops(&wall, &joints, excitation.driven.then_some(masses.len() + 1));
    let shear = concio_shear::system::System { tops, ..compile_links(masses, links, excitation.duration) };
    Model {
        wall,
        joints,
        beam: if excitation.driven { Beam::Driven } else { Beam::Free },
        top_load: 0.0,
        load_mass: 0.0,
        devices: links.iter().enumerate().filter_map(named).collect(),
        excitation,
        shear,
        system: System::Shear,
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
