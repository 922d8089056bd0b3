//! Mechanisms out of the plane of a wall: which parts of it may fall outwards, under what multiplier of their weight, and whether that is
//! enough for a site.
//!
//! Every mechanism is a function of plain structs in SI: the module of each has its equation. Sums of virtual work are those of one place,
//! [`body`] (OP1). Multipliers are upper bounds in the class of their mechanism: the lowest over hinge levels and cracks counts.
//! [`pushover`] follows a mechanism to the displacement where it stands by itself no more, [`checks`] holds it against a site in the form of
//! the Italian code, [`rocking`] takes it through a record. [`facade`] has the parts of a wall that its mechanisms share.
//!
//! Limits: blocks are rigid, masonry that disintegrates before it turns has no mechanism here, and closed forms bound the multiplier from
//! above.
//!
//! Sources: Circolare 21 January 2019 n. 7 C.S.LL.PP., C8.7.1.2 (called Circolare below); what is marked as derived is proved in
//! `tests/all` against closed forms of its own.

pub mod body;
pub mod checks;
pub mod corner;
pub mod facade;
pub mod flap;
pub mod gable;
pub mod horizontal_arch;
mod minimum;
pub mod overturning;
pub mod pushover;
pub mod rocking;
pub mod setback;
pub mod side_wall;
mod supports;
pub mod survey;
pub mod time_history;
pub mod vertical_arch;
pub mod wall;

/// Acceleration of gravity [m/s²].
pub use concio_law::G;
