//! The program as a user meets it.

mod commands;
mod compare;
mod figures;
mod first_crack;
mod messages;
mod support;
