//! What is told of a record beside its samples.

use std::fmt;

use crate::case::plausible::rounded;

/// What a reader did to a file or found in it that the samples do not show any more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Remark {
    /// The mean of the samples was taken off, as the archive does before it tells a peak.
    Offset {
        /// The mean [m/s²].
        mean: f64,
    },
    /// The samples of the file stand at unequal steps; those of the record lie on the straight lines between them.
    Resampled {
        /// Samples in the file.
        samples: usize,
        /// Shortest and longest step in the file [s].
        steps: [f64; 2],
        /// Interval of the record [s].
        dt: f64,
        /// Whether every sample of the file is one of the record.
        exact: bool,
    },
    /// The time column of the file starts there [s]; the record starts at 0.
    Start {
        /// Time of the first sample [s], not 0.
        time: f64,
    },
    /// The file holds more samples than its header declares; they are left away.
    Surplus {
        /// How many.
        samples: u64,
    },
    /// The header names two units; the code counts.
    UnitByCode {
        /// The code of COSMOS.
        code: u32,
    },
    /// No mark of an end stands behind the channels, as archives write it: the file was made by other means, or lost its end.
    Unmarked,
    /// The file holds fewer channels than its instrument recorded: one of several was kept, or the file lost its end.
    Fewer {
        /// Channels of the instrument.
        recorded: u64,
        /// Channels in the file.
        found: usize,
    },
}

impl Remark {
    /// Whether the samples may be other than the archive meant, so that who uses them should look.
    pub fn is_doubtful(&self) -> bool {
        match self {
            Remark::UnitByCode { .. }
            | Remark::Surplus { .. }
            | Remark::Unmarked
            | Remark::Resampled { exact: false, .. } => true,
            Remark::Offset { .. } | Remark::Start { .. } | Remark::Resampled { .. } | Remark::Fewer { .. } => false,
        }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Remark::Offset { mean } => write!(
                f,
                "its samples stand on an offset of {} m/s² ({} gal), which is taken off, as the archive does before it states the peak",
                rounded(*mean, 4),
                rounded(1e2 * mean, 4)
            ),
            Remark::Resampled { samples, steps: [shortest, longest], dt, exact } => {
                let [shortest, longest, dt] = [shortest, longest, dt].map(|t| rounded(*t, 6));
                write!(
                    f,
                    "its {samples} samples stand at unequal steps of {shortest} s to {longest} s: it is resampled every {dt} s, "
                )?;
                f.write_str(if *exact {
                    "and every sample is kept"
                } else {
                    "along straight lines, which cuts peaks short"
                })
            }
            Remark::Start { time } => {
                write!(f, "its time starts at {} s, which is t = 0 here", rounded(*time, 9))
            }
            Remark::Surplus { samples } => {
                write!(f, "samples beyond those that its header declares are left out: {samples}")
            }
            Remark::UnitByCode { code } => {
                write!(f, "its header names one unit in words and another by the code {code:02}: the code counts")
            }
            Remark::Unmarked => f.write_str(
                "no mark of an end (`/&`) stands behind its samples, as archives write it: if you expect more channels, fetch it again",
            ),
            Remark::Fewer { recorded, found } => write!(
                f,
                "its instrument recorded {recorded} channels, the file holds {found}: if you expect more, fetch it again"
            ),
        }
    }
}
