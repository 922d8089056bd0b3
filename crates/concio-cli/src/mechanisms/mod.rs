//! What `concio mechanisms` shows: lines for the terminal, tables and JSON for programs, a page for a report.

use concio_mechanisms::side_wall::Overlaps;
use concio_mechanisms::survey::Survey;
use concio_mechanisms::wall::Wall;

pub mod figures;
pub mod numbers;
pub mod page;
pub mod rows;
pub mod shaken;
pub mod text;

/// What is shown.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'s> {
    /// Title of the wall.
    pub title: &'s str,
    /// The wall.
    pub wall: &'s Wall,
    /// Its mechanisms.
    pub survey: &'s Survey,
    /// Sum of the friction of overlaps.
    pub overlaps: Overlaps,
    /// Parts of d0 at which the plateau of a trilinear curve begins and ends.
    pub trilinear: Option<[f64; 2]>,
}

/// What no user should believe without knowing it.
pub const LIMITS: [&str; 5] = [
    "Blocks are rigid. Masonry of poor quality, of rubble or with weak mortar, may disintegrate before it turns as one body: no mechanism here \
     shows that. Judge the quality of the masonry first.",
    "Every α0 is an upper bound in the class of its mechanism. The wall may find a mechanism that is not in the table, and that is lower.",
    "With bonded side walls the closed form lies between 12 % below and 3 % above limit analysis of the blocks without friction in head \
     joints, in the cases that were compared; with one side wall alone it was 10 % too high, for the façade then twists.",
    "Ties and friction count with their full force at the start. The displacement checks count them while they act, but take d0 from what \
     surely acts till collapse: weights and thrusts.",
    "What the wall file does not say is assumed as the table of assumptions has it. Check each line.",
];
