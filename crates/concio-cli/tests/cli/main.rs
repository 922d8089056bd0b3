//! The program as a user meets it.

mod analyses;
mod commands;
mod compare;
mod continuum;
mod figures;
mod first_crack;
mod head;
mod hostile;
mod kill;
mod limit;
mod limit_behind;
mod limit_space;
mod mechanisms;
mod messages;
mod read_back;
mod records;
mod rocking;
mod smart;
mod studies;
mod study_runs;
mod support;
mod tasks;
mod ties;
mod warned;
