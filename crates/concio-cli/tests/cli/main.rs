//! The program as a user meets it.

mod analyses;
mod commands;
mod compare;
mod figures;
mod first_crack;
mod messages;
mod studies;
mod support;
