//! The numerical section of the research report (its cases 1 to 5, Figures 22 to 27), run again and answered finding
//! by finding: yes or no, with the numbers that decide.
//!
//! `jobs` runs `walls`, `measures` reads numbers off a run, `findings` says what decides, `answers` applies it to all
//! settings and members, `page` writes it down and `pictures` draws
//! what the research report draws.

pub mod answers;
pub mod command;
pub mod findings;
pub mod jobs;
pub mod measures;
pub mod page;
pub mod pictures;
pub mod walls;
