//! The parts of a stage one by one, for measurements (crates/concio/benches/parts.rs). Hidden from the documentation: what
//! is here follows the inner loop and not the other way round.

use pulp::{Simd, WithSimd};

use super::Stage;
use crate::state::{State, Tangents};
use crate::system::System;

/// τ of a stage over the step, about.
const SHARE: f64 = 0.3;

/// A stage of a run, with its matrix and tangents as they are in the middle of it.
#[derive(Debug, Clone)]
pub struct Parts<'m> {
    system: &'m System,
    stage: Stage,
    tangents: Tangents,
}

/// What is done once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Friction law (6) with its slope, all joints in one loop of vector instructions.
    Laws,
    /// Elastic and viscous part of the matrix.
    Elastic,
    /// Friction's part of the matrix, and the factorisation.
    Factors,
    /// Solution with the factors.
    Solution,
}

impl<'m> Parts<'m> {
    /// As `state`, of a run of `system`, has them.
    pub fn of(system: &'m System, state: &State) -> Self {
        let (mut stage, mut tangents) = (Stage::new(system), state.tangents.clone());
        stage.tau = SHARE * state.step;
        stage.start(system, &mut tangents);
        stage.velocity.copy_from_slice(&tangents.velocity);
        stage.assemble_elastic(system, &tangents);
        Parts { system, stage, tangents }
    }

    /// Does a part, with the instructions of the machine at hand; false where the matrix is not positive.
    pub fn run(&mut self, part: Part) -> bool {
        self.stage.arch.dispatch(One { part, parts: self })
    }
}

struct One<'a, 'm> {
    part: Part,
    parts: &'a mut Parts<'m>,
}

impl WithSimd for One<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let Parts { system, stage, tangents } = self.parts;
        match self.part {
            Part::Laws => stage.rubs.laws(&stage.velocity, &mut stage.mu, &mut stage.slope),
            Part::Elastic => stage.assemble_elastic(system, tangents),
            Part::Factors => {
                stage.factors_hold = false;
                return stage.assemble(system, tangents).is_ok();
            }
            Part::Solution => {
                let n = stage.mass.len();
                stage.rhs[..n].copy_from_slice(&stage.mass);
                stage.matrix.solve(&mut stage.rhs[..n]);
            }
        }
        true
    }
}
