//! The program as a user meets it.

mod commands;
mod figures;
mod messages;
mod support;
