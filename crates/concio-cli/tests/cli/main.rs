//! The program as a user meets it.

mod commands;
mod compare;
mod figures;
mod messages;
mod support;
