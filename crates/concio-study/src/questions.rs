//! What a study asks of its runs, checked before any of them is done.

use std::path::Path;

use concio::Result;

use crate::file::StudyFile;
use crate::plan::Plan;
use crate::{ida, interfaces, sensitivity};

impl Plan {
    /// Reads a study file and settles its runs.
    ///
    /// # Errors
    /// [`concio::Error::Input`] with file and line.
    pub fn read(path: &Path) -> Result<Self> {
        Self::of(StudyFile::read(path)?)
    }

    /// The same of a file that was read already.
    ///
    /// # Errors
    /// [`concio::Error::Input`] with file and line.
    pub fn of(file: StudyFile) -> Result<Self> {
        let plan = Self::laid_out(file)?;
        sensitivity::measures(&plan)?;
        ida::settings(&plan.file)?;
        questions(&plan)?;
        Ok(plan)
    }
}

/// Refuses questions that a plan cannot answer.
fn questions(plan: &Plan) -> Result<()> {
    let study = &plan.file.study;
    if let Some(ranking) = &study.ranking {
        ranking.check(&plan.file)?;
    }
    if study.interfaces.is_some() {
        return interfaces::question(plan).map(|_| ());
    }
    match study.motions.iter().position(|m| m.held_out) {
        Some(i) => {
            let what = "is said of a motion where nothing is searched for";
            Err(plan.file.wrong(&format!("motion[{i}].held_out"), what, "beside a table `interfaces` only"))
        }
        None => Ok(()),
    }
}
