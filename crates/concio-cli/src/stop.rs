//! Ctrl-C: the first asks the run to stop, the second ends the program.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::Failure;

static ASKED: AtomicBool = AtomicBool::new(false);

/// Status by which shells know that a signal ended a program: 128 + SIGINT.
const BY_SIGNAL: i32 = 130;

/// Listens from now on. Other signals are left as they are: `nohup` must hold, and what SIGTERM cuts off is taken up
/// from the journal.
pub fn listen() -> Result<(), Failure> {
    let heard = || {
        if ASKED.swap(true, Ordering::SeqCst) {
            process::exit(BY_SIGNAL);
        }
    };
    ctrlc::set_handler(heard).map_err(|e| Failure::Other(format!("signals cannot be handled: {e}"), None))
}

/// Whether the user has asked to stop.
pub fn asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}
