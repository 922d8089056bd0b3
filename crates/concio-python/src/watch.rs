//! What a long call does beside its work: it hands on how far it is, and looks for Ctrl-C.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use concio::run::Control;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// Time by the clock between two looks.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// Looks now and then; used while the interpreter is released.
pub struct Watch {
    told: Option<Py<PyAny>>,
    looked: Instant,
    /// What a callback raised.
    pub error: Option<PyErr>,
    /// Whether Ctrl-C was pressed.
    pub interrupted: bool,
}

impl Watch {
    /// Calls `told` with the share of the work that is done, 0 … 1.
    pub fn new(told: Option<Py<PyAny>>) -> Self {
        Watch { told, looked: Instant::now(), error: None, interrupted: false }
    }

    /// To be called often.
    pub fn look(&mut self, share: impl FnOnce() -> f64) -> Control {
        if self.looked.elapsed() < BETWEEN_LOOKS {
            return Control::Continue;
        }
        self.looked = Instant::now();
        let share = share();
        let looked = Python::attach(|py| {
            py.check_signals()?;
            self.told.as_ref().map_or(Ok(()), |told| told.call1(py, (share,)).map(drop))
        });
        match looked {
            Ok(()) => Control::Continue,
            Err(error) => {
                self.interrupted = Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py));
                self.error = (!self.interrupted).then_some(error);
                Control::Stop
            }
        }
    }
}

/// What threads that work and the one that called say to each other.
#[derive(Default)]
pub struct Board {
    stopped: AtomicBool,
    share: AtomicU64,
}

impl Board {
    /// Whether the caller wants no more.
    pub fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Says how far the work is; what the caller wants.
    pub fn look(&self, share: f64) -> Control {
        self.share.store(share.to_bits(), Ordering::Relaxed);
        if self.stopped.load(Ordering::Relaxed) { Control::Stop } else { Control::Continue }
    }
}

/// Does `work` on another thread, for signals come to the one that called, and looks meanwhile.
pub fn beside<T: Send>(watch: &mut Watch, work: impl FnOnce(&Board) -> T + Send) -> std::thread::Result<T> {
    let board = Board::default();
    std::thread::scope(|scope| {
        let (done, over) = mpsc::channel::<()>();
        let board = &board;
        let worker = scope.spawn(move || {
            let made = work(board);
            drop(done);
            made
        });
        while over.recv_timeout(BETWEEN_LOOKS) == Err(RecvTimeoutError::Timeout) {
            if watch.look(|| f64::from_bits(board.share.load(Ordering::Relaxed))) == Control::Stop {
                board.stopped.store(true, Ordering::Relaxed);
                break;
            }
        }
        worker.join()
    })
}
