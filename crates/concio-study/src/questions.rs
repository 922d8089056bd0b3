//! What a study asks of its runs, checked before any of them is done.

use std::path::Path;

use concio::Result;

use crate::alike::{self, Pair};
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
        let mut plan = Self::laid_out(file)?;
        sensitivity::measures(&plan)?;
        ida::settings(&plan.file)?;
        questions(&plan)?;
        plan.doubts = repeated(&plan)?;
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

/// Refuses motions that would count twice; tells of others that resemble each other.
fn repeated(plan: &Plan) -> Result<Vec<String>> {
    let study = &plan.file.study;
    let independent = study.ida.is_some() || study.first_crack.is_some() || study.cracks.is_some();
    if !independent && study.interfaces.is_none() && study.sensitivity.is_none() && study.ranking.is_none() {
        return Ok(Vec::new());
    }
    let mut doubts = Vec::new();
    for pair in alike::pairs(plan) {
        let [first, second] = pair.motions.map(|m| &study.motions[m]);
        let (a, b) = (&first.name, &second.name);
        let leaks = first.held_out != second.held_out;
        let same_wall = alike::of_one_wall(plan, pair.motions);
        let scaled = study.ida.is_some() && pair.is_one() && pair.factor > 0.0;
        // Runs of one motion that end at other times may be meant to be compared.
        let once = same_wall && first.duration == second.duration;
        if once && (pair.is_equal() || scaled) {
            let what = match (scaled && !pair.is_equal(), leaks) {
                (true, _) => format!("`{a}` and `{b}` are one motion once they are scaled: it would count twice"),
                (_, true) => format!("`{a}` and `{b}` are one motion: what is held out would be known to the search"),
                _ => format!("`{a}` and `{b}` are one motion: it would count twice"),
            };
            let allowed = "motions that differ by more than strength, silence and sampling";
            let allowed = if scaled { allowed } else { "motions that differ" };
            return Err(plan.file.wrong(&format!("motion[{}].base", pair.motions[1]), what, allowed));
        }
        if independent || leaks {
            doubts.push(resemblance(a, b, &pair));
        }
    }
    Ok(doubts)
}

fn resemblance(a: &str, b: &str, pair: &Pair) -> String {
    let percent = (1e4 * pair.correlation).floor() / 1e2;
    let by = match (pair.is_one(), pair.is_equal(), pair.factor < 0.0) {
        (false, ..) => format!("resemble each other with a correlation of {percent} %"),
        (_, true, _) => "are one".into(),
        (.., true) => "are one but for their sign, which a symmetric wall does not tell".into(),
        _ => "are one but for their strength".into(),
    };
    format!("motions `{a}` and `{b}` {by}: they do not count as two independent motions")
}
