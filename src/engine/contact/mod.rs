//! Motion with unilateral contact: free flight, contact whose force grows with the 3/2 power of the depth, and
//! the change from one to the other, located.
//!
//! The 3/2 power has no second derivative at depth zero, which costs a Runge-Kutta method its order in the first
//! and the last step of every contact. There the root of the depth takes the place of time as the independent
//! variable (after Hénon, Physica D 5 (1982) 412): in it the motion is smooth, and the contact ends exactly at
//! zero, without a search.

mod accepted_step;
mod contact_phase;
mod discontinuities;
mod dop853;
mod flight;
mod run;
mod step;

use super::WorkLimit;
use crate::numeric::enclosure::{Detail, Interval};

pub use accepted_step::AcceptedStep;
pub use run::{ContactEnd, Finish, run};

/// What the motion is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// Apart.
    Flight,
    /// Pressed together, in a contact that began with this speed, m/s.
    Contact {
        /// m/s
        approach: f64,
    },
    /// Still indented, but receding so fast that the force is zero.
    Release {
        /// m/s
        approach: f64,
    },
    /// Held at constant distance.
    Link,
}

/// What follows from a state in a phase.
#[derive(Clone, Copy, Debug)]
pub struct Sample<const N: usize> {
    /// Rates of change.
    pub rates: [f64; N],
    /// Depth of the contact, m, negative while apart.
    pub depth: f64,
    /// Rate of the depth, m/s.
    pub depth_rate: f64,
    /// Second derivative of the depth, m/s².
    pub depth_acceleration: f64,
}

/// A motion of N numbers, the first of them the time, s.
pub trait Contact<const N: usize> {
    /// What makes evaluations near a state cheaper, and which of several laws of motion holds there.
    type Near: Copy;

    /// Prepares evaluations near a state.
    fn near(&self, y: &[f64; N]) -> Self::Near;

    /// Geometry near contact at a later state, where the law of motion is that of before.
    fn near_after(&self, before: &Self::Near, y: &[f64; N]) -> Self::Near;

    /// What is positive while the law of motion lasts, and what leaves a kink in the rates where its sign changes;
    /// none if there is but one law, whose rates are smooth.
    fn breaks(&self, near: &Self::Near, phase: Phase, y: &[f64; N]) -> Option<[f64; 2]>;

    /// Goes over to the law of motion that holds after this state, from what the one of before makes of the time
    /// that follows.
    fn change(
        &self,
        near: &Self::Near,
        phase: Phase,
        y: &mut [f64; N],
        soon: &[f64; N],
    ) -> Self::Near;

    /// Rates and depth in a phase; in contact the depth (m) may be known better than from the state.
    fn sample(
        &self,
        near: &Self::Near,
        phase: Phase,
        depth: Option<f64>,
        y: &[f64; N],
    ) -> Sample<N>;

    /// A smooth measure of the gap, positive in flight and zero where contact begins, and its rate.
    fn gap(&self, y: &[f64; N]) -> (f64, f64);

    /// Positive while a contact presses whose depth changes at this rate, m/s.
    fn pressing(&self, approach: f64, rate: f64) -> f64;

    /// The speed a contact is said to begin with, m/s.
    fn approach(&self, speed: f64) -> f64;

    /// The state nearest to this one that keeps the distance of [`Phase::Link`].
    fn relinked(&self, y: &[f64; N]) -> [f64; N];

    /// The next time after t (s) at which the rates are not smooth in time.
    fn next_corner(&self, t: f64) -> f64;

    /// Whether the rates may do something between the stages of a step that its error does not tell.
    fn has_detail(&self) -> bool;

    /// What loads change in the rates over the sizes of their numbers, 1/s, over ranges of a state, and in an ellipse of this
    /// size around them.
    fn detail(&self, over: &[Interval; N], ellipse: f64) -> Detail;

    /// Size of each number, which the tolerance is relative to; the first `counted` are under error control.
    fn sizes(&self) -> ([f64; N], usize);

    /// What the depth (m) at a state may be off zero by rounding.
    fn rounding(&self, y: &[f64; N]) -> f64;

    /// The end of a step of [`Phase::Release`]: no force gives back what was stored in between, so it is lost.
    fn receded(&self, start: &[f64; N], end: &[f64; N]) -> [f64; N];
}

/// How a run is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<'a> {
    /// Local error target, relative to the sizes.
    pub tolerance: f64,
    /// s
    pub t_end: f64,
    /// On evaluations of the rates.
    pub limit: WorkLimit<'a>,
}
