//! Set-ups that several files share.

pub mod planar;
pub mod ready;
pub mod restarted;
