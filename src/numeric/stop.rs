//! Request from outside to end a long computation, and progress of the computation.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Request to stop: any holder of a copy may make it, from another thread or a signal handler, and the computation with
/// another copy ends soon after. A run then keeps its results up to there, as at its work limit.
///
/// ```
/// use slider_crank::Stop;
/// use slider_crank::scene::Scene;
/// use slider_crank::simulate::{Options, Why, simulate};
/// let stop = Stop::default();
/// let options = Options { stop: Some(stop.clone()), ..Options::default() };
/// stop.request();
/// let run = simulate(&Scene::duarte(), &options).unwrap();
/// assert!(matches!(run.summary.stopped.unwrap().why, Why::Interrupted));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Stop {
    requested: Arc<AtomicBool>,
    /// Bits of the finished part.
    done: Arc<AtomicU64>,
}

impl Stop {
    /// Requests the end.
    pub fn request(&self) {
        self.requested.store(true, Ordering::Relaxed);
    }

    /// Whether the end was requested.
    pub fn is_requested(&self) -> bool {
        self.requested.load(Ordering::Relaxed)
    }

    /// Returns the finished part of the computation, from 0 to 1; a second run, as for an error estimate, begins anew.
    pub fn done(&self) -> f64 {
        f64::from_bits(self.done.load(Ordering::Relaxed))
    }

    /// Returns the request for one of many computations, with a progress of its own.
    pub fn of_one(&self) -> Stop {
        Stop {
            requested: Arc::clone(&self.requested),
            done: Arc::default(),
        }
    }

    /// Sets the finished part of a computation, from 0 to 1.
    pub fn reach(&self, part: f64) {
        self.done.store(part.to_bits(), Ordering::Relaxed);
    }
}

/// Copies of one request are equal.
impl PartialEq for Stop {
    fn eq(&self, other: &Stop) -> bool {
        Arc::ptr_eq(&self.requested, &other.requested)
    }
}
