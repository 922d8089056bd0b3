//! What a user should know before believing a result: a sentence, and the kind of doubt that it is. Studies count by kind.

use std::fmt;
use std::ops::Deref;

use serde::{Deserialize, Serialize};

/// The kinds, each with its name in tables and files: names stay, for other programs sort by them.
macro_rules! kinds {
    ($($(#[$doc:meta])+ $kind:ident = $name:literal,)+) => {
        /// What a warning is about.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum WarningKind {
            $($(#[$doc])+ #[serde(rename = $name)] $kind,)+
        }
        impl WarningKind {
            /// All kinds, those known before a run first.
            pub const ALL: &'static [WarningKind] = &[$(WarningKind::$kind,)+];
            /// Its name in tables and files.
            pub fn name(self) -> &'static str {
                match self { $(WarningKind::$kind => $name,)+ }
            }
        }
    };
}

kinds! {
    /// A number that is allowed and hardly meant, mostly one in another unit.
    UnlikelyNumber = "unlikely-number",
    /// A key that does nothing where it stands.
    IdleKey = "idle-key",
    /// Something that is assumed of a wall that rocks out of its plane.
    Assumed = "assumed",
    /// Laws of joints that are right in the other model alone.
    UnlikelyJoint = "unlikely-joint",
    /// An earthquake with inertia left out.
    StillMotion = "quasi-static-motion",
    /// Joints that have a friction law and do not rub.
    IdleFriction = "idle-friction",
    /// Friction whose action and reaction differ.
    Overburden = "overburden",
    /// A top beam that is heavier than the load that it brings.
    HeavyBeam = "heavy-beam",
    /// A panel that ends below the beam.
    BelowBeam = "below-beam",
    /// A load without the mass that its weight has, where the base moves.
    MasslessLoad = "massless-load",
    /// A tie that is fixed beside its block.
    DetachedTie = "detached-tie",
    /// A record of which no channel was chosen.
    UnchosenChannel = "unchosen-channel",
    /// A record, or another motion or force, that the run cuts, or a record that `trim`, `baseline` or `resample` weakens.
    RecordCut = "record-cut",
    /// A record that ends before the run.
    RecordOutlasted = "record-outlasted",
    /// A motion that ends away from its start.
    Drift = "drift",
    /// A record whose unit or interval is hardly that of an earthquake.
    UnlikelyRecord = "unlikely-record",
    /// A peak that no earthquake had, or that no wall feels.
    UnlikelyPeak = "unlikely-peak",
    /// A factor on a record that is g, as if its unit were still to be converted.
    ScaledByG = "scaled-by-g",
    /// A peak that few earthquakes had.
    RarePeak = "rare-peak",
    /// A record whose file is at odds with itself.
    DoubtfulRecord = "doubtful-record",
    /// A motion of the base that results do not hold.
    MotionInNoFile = "motion-in-no-file",
    /// A run of very many steps.
    LongRun = "long-run",
    /// An energy account that does not close, or contacts that give energy back.
    Energy = "energy",
    /// Steps whose contact was left unsolved.
    Unsolved = "unsolved-contact",
    /// Steps without inertia that did not end at rest.
    Moving = "not-at-rest",
    /// A largest base shear that a tilted wall bore as it fell.
    PeakInFall = "peak-in-fall",
    /// A base shear above what friction and bond bear.
    BeyondFriction = "beyond-friction",
    /// Bonds that crack under the loads at rest.
    CrackedAtRest = "cracked-at-rest",
    /// A wall that counts as collapsed.
    Collapse = "collapse",
    /// A rocking wall that was turned farther than its weight holds, and came back.
    BeyondD0 = "beyond-balance",
    /// A run that next to nothing decides: a thousandth of the motion of a rocking one, the step where friction falls at once.
    Chance = "chance",
    /// A tie of a rocking wall that broke.
    BrokenTie = "broken-tie",
    /// A floor that a rocking wall let fall.
    LostSeat = "lost-seat",
    /// A run that ends while the wall is under way.
    UnderWay = "under-way",
    /// Joints that ring faster than steps resolve.
    Unresolved = "unresolved-joints",
    /// A slip beyond which the geometry of the model does not hold.
    LargeSlip = "large-slip",
    /// Friction work without slip.
    Creep = "creep",
}

impl fmt::Display for WarningKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A warning: reads as its sentence.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// What it is about.
    pub kind: WarningKind,
    /// The sentence.
    pub text: String,
}

impl Warning {
    /// A warning of a kind.
    pub fn new(kind: WarningKind, text: impl Into<String>) -> Self {
        Warning { kind, text: text.into() }
    }
}

impl Deref for Warning {
    type Target = str;
    fn deref(&self) -> &str {
        &self.text
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl PartialEq<str> for Warning {
    fn eq(&self, other: &str) -> bool {
        self.text == other
    }
}

impl PartialEq<String> for Warning {
    fn eq(&self, other: &String) -> bool {
        self.text == *other
    }
}

impl PartialEq<&str> for Warning {
    fn eq(&self, other: &&str) -> bool {
        self.text == *other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables hold names parted by blanks, and rows of a store are read back by them.
    #[test]
    fn kinds_have_names_of_their_own_that_read_back() {
        let mut names: Vec<&str> = WarningKind::ALL.iter().map(|k| k.name()).collect();
        for (kind, name) in WarningKind::ALL.iter().zip(&names) {
            assert!(name.bytes().all(|b| b.is_ascii_lowercase() || b == b'-'), "{name}");
            let written = serde_json::to_string(kind).expect("a name");
            assert_eq!(written, format!("\"{name}\""));
            assert_eq!(serde_json::from_str::<WarningKind>(&written).expect("a kind"), *kind);
        }
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), WarningKind::ALL.len());
    }
}
