//! The mechanisms against reference values, closed forms and properties.

mod closed;
mod held;
mod reference;
mod rocking;
mod rocking_random;
mod rocking_reference;
mod survey;
mod time_history;
