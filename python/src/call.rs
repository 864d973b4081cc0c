//! A call of the library from Python: other threads of the interpreter run meanwhile, and Ctrl-C ends it.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;
use slider_crank::Stop;
use slider_crank::error::Error;

use crate::errors::raised;

/// How long Ctrl-C may wait.
const PAUSE: Duration = Duration::from_millis(50);

/// Stack of the computation, as that of a main thread.
const STACK: usize = 8 << 20;

/// What a computation and the loads that are Python functions share.
#[derive(Clone, Default)]
pub struct Call {
    /// Asks the computation to end.
    pub stop: Stop,
    fault: Arc<Mutex<Option<PyErr>>>,
}

impl Call {
    fn fault(&self) -> MutexGuard<'_, Option<PyErr>> {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a function has failed: then no other one is called.
    pub fn has_failed(&self) -> bool {
        self.fault().is_some()
    }

    /// The exception of a function ends the computation.
    pub fn fail(&self, error: PyErr) {
        self.fault().get_or_insert(error);
        self.stop.request();
    }

    /// What came of it, or the exception of a function.
    pub fn result<T>(&self, outcome: Result<T, Error>) -> PyResult<T> {
        match self.fault().take() {
            Some(error) => Err(error),
            None => outcome.map_err(raised),
        }
    }
}

/// Computes in a thread of its own, without the interpreter's lock, while this one looks for signals.
pub fn run<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Call) -> Result<T, Error> + Send,
) -> PyResult<T> {
    let call = Call::default();
    let (outcome, interrupt) = py.detach(|| {
        thread::scope(|scope| {
            let (done, waits) = channel::<()>();
            let of_worker = &call;
            let worker = thread::Builder::new()
                .stack_size(STACK)
                .spawn_scoped(scope, move || {
                    let _until_here = done;
                    // One state of the interpreter for all calls of functions.
                    Python::attach(|py| py.detach(|| work(of_worker)))
                });
            let worker = match worker {
                Ok(worker) => worker,
                Err(error) => return (None, Some(error.into())),
            };
            let mut interrupt: Option<PyErr> = None;
            while waits.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
                if interrupt.is_none() {
                    interrupt = Python::attach(|py| py.check_signals()).err();
                }
                if interrupt.is_some() {
                    call.stop.request();
                }
            }
            (Some(worker.join()), interrupt)
        })
    });
    match (interrupt, outcome) {
        (Some(interrupt), _) => Err(interrupt),
        (None, Some(Ok(outcome))) => call.result(outcome),
        (None, Some(Err(panic))) => resume_unwind(panic),
        (None, None) => Err(raised(Error::Interrupted)),
    }
}
