//! A run step by step. A simulation borrows its wall: both live on a thread of their own, to which this side speaks.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use concio::run::{Control, Prepared};
use concio::simulate::{Progress, Simulation as Steps};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::failure::Raised;
use crate::json;
use crate::record::shut;
use crate::watch::Watch;

/// Time by the clock between two looks at signals.
const BETWEEN_LOOKS: Duration = Duration::from_millis(20);

/// What is asked of the thread.
enum Asked {
    /// Steps until a time is reached or so many are taken.
    Advance {
        to: f64,
        steps: u64,
    },
    /// A force on a block from now on [N, N].
    Push {
        block: usize,
        force: [f64; 2],
    },
    Save,
    Restore(Vec<u8>),
}

/// What comes back: where the run is then, and what was asked for.
struct Told {
    standing: Standing,
    bytes: Vec<u8>,
    /// Whether bytes were those of this wall.
    restored: bool,
    /// Why nothing was pushed.
    refused: Option<concio::Error>,
}

/// Where a run is.
#[derive(Clone)]
struct Standing {
    time: f64,
    ended: Option<Value>,
    places: Vec<f64>,
    velocity: Vec<f64>,
    energy: Value,
}

impl Standing {
    fn of(steps: &Steps, ended: Option<Value>) -> Self {
        let state = steps.state();
        let mut energy = json!(state.energies);
        energy["input"] = json!(state.energies.input());
        energy["residual"] = json!(state.energies.residual());
        Standing { time: state.t, ended, places: steps.places().concat(), velocity: state.v.to_vec(), energy }
    }
}

/// A run under way.
#[pyclass(frozen, module = "concio._native")]
pub struct Simulation {
    asked: Mutex<Sender<Asked>>,
    told: Mutex<Receiver<Told>>,
    standing: Mutex<Standing>,
    stopped: Arc<AtomicBool>,
}

fn lost() -> Raised {
    Raised::Other("the simulation has ended with an error of the engine; begin another".into())
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Simulation {
    /// At rest at t = 0.
    pub fn begin(prepared: &Arc<Prepared>) -> Result<Self, Raised> {
        let (asked, orders) = mpsc::channel();
        let (answers, told) = mpsc::channel();
        let (first, begun) = mpsc::channel();
        let stopped = Arc::new(AtomicBool::new(false));
        let (prepared, stop) = (prepared.clone(), stopped.clone());
        thread::spawn(move || {
            let made = Steps::new(&prepared.model, &prepared.case.solver, &prepared.sampling);
            match made {
                Err(error) => drop(first.send(Err(error))),
                Ok(steps) => {
                    if first.send(Ok(Standing::of(&steps, None))).is_ok() {
                        serve(steps, &orders, &answers, &stop);
                    }
                }
            }
        });
        let standing = begun.recv().map_err(|_| lost())??;
        Ok(Simulation { asked: Mutex::new(asked), told: Mutex::new(told), standing: Mutex::new(standing), stopped })
    }

    /// Asks the thread, and looks after Ctrl-C while it works.
    fn ask(&self, py: Python<'_>, asked: Asked) -> PyResult<Told> {
        let mut watch = Watch::new(None);
        let told = py.detach(|| {
            // One caller at a time: answers would go to another else.
            let told = locked(&self.told);
            locked(&self.asked).send(asked).map_err(|_| lost())?;
            loop {
                match told.recv_timeout(BETWEEN_LOOKS) {
                    Ok(told) => {
                        *locked(&self.standing) = told.standing.clone();
                        // Before another caller asks.
                        self.stopped.store(false, Ordering::Relaxed);
                        return Ok(told);
                    }
                    Err(RecvTimeoutError::Timeout) => {
                        if watch.look(|| 0.0) == Control::Stop {
                            self.stopped.store(true, Ordering::Relaxed);
                        }
                    }
                    Err(RecvTimeoutError::Disconnected) => return Err(lost()),
                }
            }
        });
        if watch.interrupted {
            return Err(pyo3::exceptions::PyKeyboardInterrupt::new_err(()));
        }
        match watch.error {
            Some(error) => Err(error),
            None => Ok(told?),
        }
    }
}

/// Does what is asked until nobody can ask any more.
fn serve(mut steps: Steps, orders: &Receiver<Asked>, answers: &Sender<Told>, stop: &AtomicBool) {
    let mut ended = None;
    while let Ok(asked) = orders.recv() {
        let (mut bytes, mut restored, mut refused) = (Vec::new(), true, None);
        match asked {
            Asked::Advance { to, steps: most } => {
                let mut taken = 0;
                while taken < most && steps.time() < to && ended.is_none() && !stop.load(Ordering::Relaxed) {
                    if steps.buffer_is_full() {
                        steps.clear_recording();
                    }
                    if let Progress::Ended(reason) = steps.advance(1) {
                        ended = Some(json!(reason));
                    }
                    taken += 1;
                }
            }
            Asked::Push { block, force } => refused = steps.push(block, force).err(),
            Asked::Save => {
                steps.clear_recording();
                bytes = steps.save();
            }
            Asked::Restore(state) => {
                // What fails half way leaves nothing to go on with: tried on another first.
                let mut tried = steps.clone();
                restored = tried.restore(&state);
                if restored {
                    steps = tried;
                    ended = None;
                }
            }
        }
        if answers.send(Told { standing: Standing::of(&steps, ended.clone()), bytes, restored, refused }).is_err() {
            return;
        }
    }
}

#[pymethods]
impl Simulation {
    /// Takes steps until the time `to` [s] is reached, at most `steps`. Steps are those of a run: none is cut short, so that the time may be
    /// a step beyond. After Ctrl-C the steps that were taken stay.
    fn advance(&self, py: Python<'_>, to: f64, steps: u64) -> PyResult<()> {
        self.ask(py, Asked::Advance { to, steps }).map(drop)
    }

    /// Pushes a block from now on, to the right and upwards [N].
    fn push(&self, py: Python<'_>, block: usize, x: f64, y: f64) -> PyResult<()> {
        match self.ask(py, Asked::Push { block, force: [x, y] })?.refused {
            Some(error) => Err(Raised::from(error).into()),
            None => Ok(()),
        }
    }

    /// The state as bytes.
    fn save(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
        Ok(self.ask(py, Asked::Save)?.bytes)
    }

    /// Goes back to a saved state; whether it was one of this wall.
    fn restore(&self, py: Python<'_>, state: Vec<u8>) -> PyResult<bool> {
        Ok(self.ask(py, Asked::Restore(state))?.restored)
    }

    /// Time reached [s].
    #[getter]
    fn time(&self) -> f64 {
        locked(&self.standing).time
    }

    /// Why it goes no further; none while it does.
    #[getter]
    fn stop_reason(&self) -> Option<String> {
        locked(&self.standing).ended.as_ref().and_then(Value::as_str).map(str::to_string)
    }

    /// Displacements [m, m] and rotation in rad of every body.
    fn places<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        use numpy::PyArrayMethods;
        let places = locked(&self.standing).places.clone();
        let bodies = places.len() / 3;
        Ok(shut(PyArray1::from_vec(py, places).reshape([bodies, 3])?))
    }

    /// Horizontal velocity of every unknown relative to the base [m/s].
    fn velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        shut(PyArray1::from_vec(py, locked(&self.standing).velocity.clone()))
    }

    /// The energy account [J].
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let energy = locked(&self.standing).energy.clone();
        json::to_python(py, &energy)
    }
}
