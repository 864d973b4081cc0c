//! What a step is asked for, and how that ends.

use super::super::step::Step;
use super::state::State;

/// A step that holds.
pub struct Accepted {
    pub step: Step,
    /// The state at its end.
    pub next: State,
    /// The next step may be longer by this.
    pub factor: f64,
}

/// A step that does not hold.
#[derive(Clone, Copy, Debug)]
pub enum Failed {
    /// The next try is to have this part of its length.
    TooLong(f64),
    /// Something is hidden between its nodes: it has to end at this part of it.
    Hides(f64),
    /// The step is too long and seems to meet a corner at a part `at` of it; the one after the corner is to have `factor` times its length.
    Meets { at: f64, factor: f64 },
}

/// A step that is to be tried.
#[derive(Clone, Copy, Debug)]
pub struct Try {
    /// Length, s.
    pub h: f64,
    /// Whether it begins and ends at a corner, where the acceleration may jump.
    pub corners: [bool; 2],
}
