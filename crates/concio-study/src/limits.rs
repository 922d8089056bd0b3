//! When a joint counts as cracked, and how near each joint of a run came to it.
//!
//! Demand over limit is a ratio of relative displacements: of a bond, whose joint is elastic while it is intact, that is
//! force over strength (B2). Sources of the default limits: [`CRACK_WIDTH`], [`SLIP`].

use concio::many::Until;
use concio::model::Model;
use concio::state::State;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Opening of a head joint from which a crack can be seen [m]: 0.1 mm, up to which J. B. Burland, B. B. Broms and
/// V. F. B. de Mello (Behaviour of foundations and structures, 9th ICSMFE, Tokyo 1977) call cracks of brickwork hairline
/// and damage negligible. EN 1992-1-1:2004, 7.3.1, allows 0.2 to 0.4 mm in concrete, by exposure.
pub const CRACK_WIDTH: f64 = 1e-4;
/// Offset of a bed joint's sides from which it counts as cracked [m]: no code limits it; the same 0.1 mm, since an
/// offset is seen in the same joint with the same eyes.
pub const SLIP: f64 = 1e-4;

/// What counts as a crack.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Criterion {
    /// The mortar of a joint reaches its strength, `[joint.bond]`.
    #[default]
    Bond,
    /// A head joint or connection opens by a limit.
    Opening,
    /// The sides of a bed or support joint move against each other by a limit; elastic deformation of the joint counts.
    Slip,
}

impl Criterion {
    /// Its name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Criterion::Bond => "bond",
            Criterion::Opening => "opening",
            Criterion::Slip => "slip",
        }
    }

    /// The limit that counts when none is given [m]; none for bonds, which have their own.
    pub fn limit(self) -> Option<f64> {
        match self {
            Criterion::Bond => None,
            Criterion::Opening => Some(CRACK_WIDTH),
            Criterion::Slip => Some(SLIP),
        }
    }
}

/// A criterion with its limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rule {
    /// The criterion.
    pub criterion: Criterion,
    /// Its limit [m], above 0; none for bonds.
    pub limit: Option<f64>,
}

impl Rule {
    /// With the default limit unless one is given [m].
    pub fn new(criterion: Criterion, limit: Option<f64>) -> Self {
        Rule { criterion, limit: criterion.limit().map(|default| limit.unwrap_or(default)) }
    }

    /// The rule as part of what a run is known by.
    pub fn key(&self) -> String {
        format!("{} {}", self.criterion.name(), self.limit.map_or(String::new(), |l| l.to_string()))
    }
}

/// Whether a joint that a rule looks at comes nearer to its limit by deforming elastically: by `slip`, where joints have
/// springs. A head joint that opens is unloaded, and a bond's limit is an elastic one by itself.
pub fn counts_deformation(model: &Model, rule: &Rule) -> bool {
    let lies = |e: usize| !model.joints[e].kind.is_upright();
    rule.criterion == Criterion::Slip
        && model.shear.elastic.iter().enumerate().any(|(e, law)| lies(e) && law.stiffness > 0.0)
}

impl Rule {
    /// Ends runs with their first crack. What a wall does once it has cracked is not asked, and has no bound: friction that lets go and sticks
    /// again takes small steps. Lanes gain little here: a run takes nine tenths of its time alone.
    pub fn until(&self) -> Box<Until> {
        let rule = *self;
        Box::new(move |job| {
            let limits = Limits::of(job.model, &rule);
            Box::new(move |state| limits.as_ref().is_some_and(|limits| limits.reached(state)))
        })
    }
}

/// How far each joint of a wall may move.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    criterion: Criterion,
    /// Per joint [m]; infinite for joints that the criterion does not look at.
    pub of_joint: Vec<f64>,
    upright: Vec<bool>,
}

impl Limits {
    /// Of a compiled wall; none when the criterion looks at none of its joints.
    pub fn of(model: &Model, rule: &Rule) -> Option<Self> {
        let upright: Vec<bool> = model.joints.iter().map(|j| j.kind.is_upright()).collect();
        let given = rule.limit.unwrap_or(f64::INFINITY);
        let of_joint: Vec<f64> = match rule.criterion {
            Criterion::Bond => {
                let mut all = vec![f64::INFINITY; model.joints.len()];
                for bond in &model.shear.bonds {
                    all[bond.joint as usize] = bond.law.limit();
                }
                all
            }
            Criterion::Opening => upright.iter().map(|u| if *u { given } else { f64::INFINITY }).collect(),
            Criterion::Slip => upright.iter().map(|u| if *u { f64::INFINITY } else { given }).collect(),
        };
        // A bonded rigid joint bears its strength without a displacement: its demand is not known, but when it cracks is.
        let bonded = rule.criterion == Criterion::Bond && !model.shear.bonds.is_empty();
        let any = bonded || of_joint.iter().any(|l| l.is_finite());
        any.then_some(Limits { criterion: rule.criterion, of_joint, upright })
    }

    /// The joint nearest to its limit, the first of equals, and its demand over limit; of peaks per joint,
    /// |relative displacement| and opening [m].
    pub fn nearest(&self, displacement: impl Fn(usize) -> f64, opening: impl Fn(usize) -> f64) -> (usize, f64) {
        let mut nearest = (0, 0.0);
        for (e, limit) in self.of_joint.iter().enumerate().filter(|(_, l)| l.is_finite()) {
            let ratio = if self.upright[e] { opening(e) } else { displacement(e) } / limit;
            if ratio > nearest.1 {
                nearest = (e, ratio);
            }
        }
        nearest
    }

    /// Whether a run has come to a crack.
    pub fn reached(&self, state: &State<'_>) -> bool {
        match self.criterion {
            // The solver itself says when: it ends steps where a brittle bond breaks.
            Criterion::Bond => state.bonds.iter().any(|b| b.cracked.is_finite()),
            _ => {
                let peaks = &state.envelopes;
                self.nearest(|e| peaks.joint_displacement[e], |e| peaks.joint_opening[e]).1 >= 1.0
            }
        }
    }
}
