//! One wall with three kinds of head joints: none, no-tension springs, rigid unilateral contact. The research report sets
//! the constrained wall against the free one (its Figures 17 and 18).

use crate::case::{Case, Spring, SpringChange, SpringLaw};
use crate::error::{InputError, Result};
use crate::model::Model;
use crate::outcome::Outcome;
use crate::run::{Prepared, run_in_memory};
use crate::simulate::Sampling;

/// What head joints and connections do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Heads {
    /// Nothing but damp (4): blocks may overlap.
    Free,
    /// Equation (3), with κ as the wall file gives it or as said here, above 0.
    NoTension(Option<f64>),
    /// Rigid contact (R1) to (R4), with e as the wall file gives it for rigid joints or, where it gives none, as said
    /// here, 0 … 1.
    Rigid(f64),
}

/// The wall of `prepared` with other head joints and connections: those whose law is `no-tension` or `rigid` get what
/// `heads` says. All else stays, damping included.
///
/// # Errors
/// The wall is planar, no joint of it has one of these laws, or head joints are bonded.
pub fn with_heads(prepared: &Prepared, heads: Heads) -> Result<Prepared> {
    prepared.model.shear_only("the comparison of free and constrained head joints")?;
    if prepared.model.shear.bonds.iter().any(|bond| bond.law.opens) {
        let what = "head joints of this wall are bonded: free and rigid ones have no bond to compare with";
        let error = InputError::new(what).key("joint.bond.tensile_strength").allowed("0");
        return Err(error.help("leave out `head` and `connection` in `on` of [joint.bond]").into());
    }
    let mut case = prepared.case.clone();
    for_unilateral(&mut case, |law, rigidity, restitution| match heads {
        Heads::Free => *law = SpringLaw::NoTension,
        Heads::NoTension(kappa) => {
            *law = SpringLaw::NoTension;
            *rigidity = kappa.or(*rigidity);
        }
        Heads::Rigid(e) => {
            *law = SpringLaw::Rigid;
            *restitution = restitution.or(Some(e));
        }
    });
    let mut model = Model::compile(&case, prepared.model.wall.clone(), prepared.model.excitation.clone())?;
    if model.shear.contacts.is_empty() && !model.shear.elastic.iter().any(|law| law.unilateral) {
        let what = "no joint of this wall is `no-tension` or `rigid`: there is nothing to compare";
        return Err(InputError::new(what).key("joint.head.law").allowed("no-tension, rigid").into());
    }
    if heads == Heads::Free {
        for law in model.shear.elastic.iter_mut().filter(|law| law.unilateral) {
            (law.stiffness, law.unilateral) = (0.0, false);
        }
    }
    Ok(Prepared { case, model, ..prepared.clone() })
}

/// Calls `set` with law, κ and restitution of every spring that is `no-tension` or `rigid`.
fn for_unilateral(case: &mut Case, set: impl Fn(&mut SpringLaw, &mut Option<f64>, &mut Option<f64>)) {
    let one_sided = |law: SpringLaw| matches!(law, SpringLaw::NoTension | SpringLaw::Rigid);
    let common = |spring: &mut Spring| {
        if one_sided(spring.law) {
            let (was, mut kappa) = (spring.law, Some(spring.rigidity));
            let mut e = spring.restitution.filter(|_| was == SpringLaw::Rigid);
            set(&mut spring.law, &mut kappa, &mut e);
            spring.rigidity = kappa.unwrap_or(spring.rigidity);
            spring.restitution = e.filter(|_| spring.law == SpringLaw::Rigid);
        }
    };
    let changed = |spring: &mut SpringChange| {
        let touched = spring.rigidity.is_some() || spring.restitution.is_some();
        match &mut spring.law {
            Some(law) if one_sided(*law) => set(law, &mut spring.rigidity, &mut spring.restitution),
            // What a change of κ or e alone is for is what another law of the same joint is given here.
            None if touched => set(&mut SpringLaw::Rigid, &mut spring.rigidity, &mut spring.restitution),
            _ => {}
        }
    };
    common(&mut case.joint.head);
    case.joint.connection.iter_mut().for_each(common);
    case.joint.changes.iter_mut().filter_map(|change| change.spring.as_mut()).for_each(changed);
}

/// One of the three runs.
#[derive(Debug, Clone)]
pub struct Variant {
    /// What was computed.
    pub prepared: Prepared,
    /// What came of it.
    pub outcome: Outcome,
}

/// Runs `prepared` with `heads`, keeping the histories of the blocks and joints named.
///
/// # Errors
/// As [`with_heads`]; names that no block or joint bears.
pub fn respond(prepared: &Prepared, heads: Heads, blocks: &[String], joints: &[String]) -> Result<Variant> {
    let mut prepared = with_heads(prepared, heads)?;
    let (blocks, joints) = (blocks.to_vec(), joints.to_vec());
    prepared.sampling = Sampling { frame_every: 0, blocks, joints, ..prepared.sampling };
    let outcome = run_in_memory(&prepared)?;
    Ok(Variant { prepared, outcome })
}

impl Variant {
    /// The history of a channel, none if there is no such channel.
    pub fn history(&self, name: &str) -> Option<Vec<f64>> {
        self.outcome.history(name)
    }

    /// Deepest interpenetration over all steps [m], from 0.
    pub fn deepest(&self) -> f64 {
        (-self.outcome.totals.minimum_gap).max(0.0)
    }

    /// Index of the joints whose gap can open and close.
    pub fn upright(&self) -> impl Iterator<Item = usize> {
        let joints = &self.prepared.model.joints;
        (0..joints.len()).filter(|&e| joints[e].kind.is_upright())
    }
}

/// Largest difference of two histories over the largest value of the second; 0 where that is 0.
pub fn difference(of: &[f64], from: &[f64]) -> f64 {
    let peak = from.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let worst = of.iter().zip(from).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    if peak > 0.0 { worst / peak } else { 0.0 }
}

/// Slope of log y over log x by least squares: the power with which y goes. None for fewer than two points above 0.
pub fn rate(x: &[f64], y: &[f64]) -> Option<f64> {
    let points: Vec<[f64; 2]> =
        x.iter().zip(y).filter(|(x, y)| **x > 0.0 && **y > 0.0).map(|(x, y)| [x.ln(), y.ln()]).collect();
    let n = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / n;
    let (mx, my) = (mean(0), mean(1));
    let spread: f64 = points.iter().map(|p| (p[0] - mx).powi(2)).sum();
    let common: f64 = points.iter().map(|p| (p[0] - mx) * (p[1] - my)).sum();
    (points.len() >= 2 && spread > 0.0).then(|| common / spread)
}
