//! A request from outside to end a long computation.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

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
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Asks for the end.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the end was asked for.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Copies of one request are equal.
impl PartialEq for Stop {
    fn eq(&self, other: &Stop) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
