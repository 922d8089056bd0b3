//! The program as a user meets it.

mod analyses;
mod commands;
mod compare;
mod figures;
mod head;
mod first_crack;
mod kill;
mod limit;
mod messages;
mod smart;
mod studies;
mod study_runs;
mod support;
mod ties;
