//! A request from outside to end a long computation, and how far that is.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A request to stop: whoever has a copy may make it, from another thread or a signal handler, and what computes with another
/// copy ends soon after. A run then keeps what it has, as at its work limit.
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
    /// Bits of the part that is done.
    done: Arc<AtomicU64>,
}

impl Stop {
    /// Asks for the end.
    pub fn request(&self) {
        self.requested.store(true, Ordering::Relaxed);
    }

    /// Whether the end was asked for.
    pub fn is_requested(&self) -> bool {
        self.requested.load(Ordering::Relaxed)
    }

    /// The part of the computation that is done, from 0 to 1; a second run, as for an error estimate, begins anew.
    pub fn done(&self) -> f64 {
        f64::from_bits(self.done.load(Ordering::Relaxed))
    }

    /// The request for one of many computations, which says nothing of how far they are together.
    pub fn of_one(&self) -> Stop {
        Stop {
            requested: Arc::clone(&self.requested),
            done: Arc::default(),
        }
    }

    /// Says that a computation has got so far, from 0 to 1.
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
