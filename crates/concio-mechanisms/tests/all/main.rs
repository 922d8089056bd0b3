//! The mechanisms against reference values, closed forms and properties.

mod closed;
mod reference;
mod survey;
