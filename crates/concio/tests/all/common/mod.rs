//! Set-ups that several files share.

pub mod ready;
pub mod restarted;
