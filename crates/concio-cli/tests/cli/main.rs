//! The program as a user meets it.

mod analyses;
mod commands;
mod compare;
mod figures;
mod messages;
mod support;
