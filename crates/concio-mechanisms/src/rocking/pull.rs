//! A tie under way: tension only, with slack, pretension, yield and break.
//!
//! ```text
//! e = T_0/k + u − s        elongation at the displacement u of its plate, pretension T_0, slack s
//! T = 0 where e ≤ e_p,  k (e − e_p) up to T_y, T_y above it; e_p: permanent set, grows where it yields
//! ```

use serde::{Deserialize, Serialize};

use super::mechanism::Tie;

/// Which branch of its law a tie is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Branch {
    Slack,
    Elastic,
    Yielding,
    Broken,
}

/// What a tie comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    Tightened,
    Slackened,
    Yielded,
    Broke,
}

/// A tie and what it has been through.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Pull {
    stiffness: f64,
    /// Elongation at rest, negative by its slack [m].
    start: f64,
    /// Elastic elongation at which it yields, and elongation at which it breaks [m]; +∞ where it does neither.
    yields: f64,
    breaks: f64,
    branch: Branch,
    /// Permanent set e_p [m].
    pub set: f64,
    /// Energy that it has taken for good, by yielding and by breaking [J].
    taken: f64,
    /// Largest pull [N].
    pub peak: f64,
}

impl Pull {
    pub fn new(tie: &Tie) -> Self {
        let start = tie.pretension / tie.stiffness - tie.slack;
        Pull {
            stiffness: tie.stiffness,
            start,
            yields: tie.yield_force.map_or(f64::INFINITY, |force| force / tie.stiffness),
            breaks: tie.elongation_at_break.unwrap_or(f64::INFINITY),
            branch: if start >= 0.0 { Branch::Elastic } else { Branch::Slack },
            set: 0.0,
            taken: 0.0,
            peak: tie.pretension,
        }
    }

    fn stretch(&self, displacement: f64) -> f64 {
        self.start + displacement - self.set
    }

    /// T on the present branch [N].
    #[inline]
    pub fn force(&self, displacement: f64) -> f64 {
        match self.branch {
            Branch::Slack | Branch::Broken => 0.0,
            Branch::Elastic => self.stiffness * self.stretch(displacement),
            Branch::Yielding => self.stiffness * self.yields,
        }
    }

    /// Energy that it gives back [J].
    pub fn elastic(&self, displacement: f64) -> f64 {
        let force = self.force(displacement);
        0.5 * force * force / self.stiffness
    }

    /// Energy that it has taken for good up to a displacement [J].
    pub fn taken(&self, displacement: f64) -> f64 {
        let yielding = self.branch == Branch::Yielding;
        let more =
            if yielding { self.stiffness * self.yields * (self.stretch(displacement) - self.yields) } else { 0.0 };
        self.taken + more
    }

    /// What it comes to at a displacement, while the plate goes outwards or comes back.
    #[inline]
    pub fn change(&self, displacement: f64, outwards: bool) -> Option<Change> {
        let stretch = self.stretch(displacement);
        match self.branch {
            Branch::Broken => None,
            _ if self.start + displacement > self.breaks => Some(Change::Broke),
            Branch::Slack => (stretch > 0.0).then_some(Change::Tightened),
            Branch::Elastic if stretch < 0.0 => Some(Change::Slackened),
            Branch::Elastic => (outwards && stretch > self.yields).then_some(Change::Yielded),
            Branch::Yielding => None,
        }
    }

    /// Goes over to another branch.
    pub fn take(&mut self, change: Change, displacement: f64) {
        match change {
            Change::Tightened => self.branch = Branch::Elastic,
            Change::Slackened => self.branch = Branch::Slack,
            Change::Yielded => self.branch = Branch::Yielding,
            Change::Broke => {
                self.taken = self.taken(displacement) + self.elastic(displacement);
                self.branch = Branch::Broken;
            }
        }
    }

    /// The plate turns back, or stands: what has yielded is set.
    pub fn turn_back(&mut self, displacement: f64) {
        if self.branch == Branch::Yielding {
            self.taken = self.taken(displacement);
            self.set += self.stretch(displacement) - self.yields;
            self.branch = Branch::Elastic;
        }
    }

    /// The plate leaves its place at rest outwards: a tie without slack pulls from the first.
    pub fn depart(&mut self) {
        if self.branch == Branch::Slack && self.stretch(0.0) >= 0.0 {
            self.branch = Branch::Elastic;
        }
    }

    /// Permanent set at a displacement, that of a yield under way included [m].
    pub fn set_at(&self, displacement: f64) -> f64 {
        let yielding = self.branch == Branch::Yielding;
        if yielding { self.set + self.stretch(displacement) - self.yields } else { self.set }
    }
}
