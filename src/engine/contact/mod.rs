//! Integration of a motion with unilateral contact: flight, contact with a force that grows with the 3/2 power of the
//! depth, and located transitions, by DOP853.
//!
//! The 3/2 power has no second derivative at depth zero, which costs a Runge-Kutta method its order in the first and
//! the last step of every contact. There the square root of the depth replaces time as the independent variable (after
//! Hénon, Physica D 5 (1982) 412): the motion is smooth in it, and the contact ends exactly at zero, without a search.

mod accepted_step;
mod contact_phase;
mod discontinuities;
mod dop853;
mod first_zero;
mod flight;
mod run;

use super::WorkLimit;
use crate::numeric::enclosure::{Interval, Variation};

pub use accepted_step::AcceptedStep;
pub use run::{ContactEnd, run};

/// Phase of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// Free flight.
    Flight,
    /// Contact that transmits force.
    Contact {
        /// Speed at the start of the contact, m/s.
        approach: f64,
    },
    /// Indentation without force: the bodies recede too fast.
    Release {
        /// Speed at the start of the contact, m/s.
        approach: f64,
    },
    /// Constant distance between the bodies, as by a massless link.
    Link,
}

/// Rates and contact depth at a state in a phase.
#[derive(Clone, Copy, Debug)]
pub struct Sample<const N: usize> {
    /// Time derivatives of the state.
    pub rates: [f64; N],
    /// Depth of the contact, m, negative while apart.
    pub depth: f64,
    /// Rate of the depth, m/s.
    pub depth_rate: f64,
    /// Second derivative of the depth, m/s².
    pub depth_acceleration: f64,
}

/// Equations of motion for a state of N numbers; the first is the time, s.
pub trait Contact<const N: usize> {
    /// Data for fast evaluation near a state, including the law of motion that holds there.
    type Near: Copy;

    /// Prepares evaluations near a state.
    fn near(&self, y: &[f64; N]) -> Self::Near;

    /// Updates the data to a later state under the same law of motion.
    fn near_after(&self, before: &Self::Near, y: &[f64; N]) -> Self::Near;

    /// Returns a value that is positive while the law of motion holds, and one at whose zeros the rates have a kink; none
    /// for a single law with smooth rates.
    fn breaks(&self, near: &Self::Near, phase: Phase, y: &[f64; N]) -> Option<[f64; 2]>;

    /// Changes to the law of motion after this state; `beyond`, a later state under the law before, tells which.
    fn change(
        &self,
        near: &Self::Near,
        phase: Phase,
        y: &mut [f64; N],
        beyond: &[f64; N],
    ) -> Self::Near;

    /// Computes rates and depth in a phase; in contact `depth` (m) overrides the less accurate depth of the state.
    fn sample(
        &self,
        near: &Self::Near,
        phase: Phase,
        depth: Option<f64>,
        y: &[f64; N],
    ) -> Sample<N>;

    /// Returns a smooth gap, m, positive in flight and zero where contact begins, and two time derivatives.
    fn gap(&self, near: &Self::Near, y: &[f64; N], rates: &[f64; N]) -> [f64; 3];

    /// Returns a value that is positive while a contact whose depth changes at this rate, m/s, transmits force.
    fn pressing(&self, approach: f64, rate: f64) -> f64;

    /// Returns the approach speed in the contact law, m/s, for a contact that begins with `speed`, m/s.
    fn approach(&self, speed: f64) -> f64;

    /// Returns the nearest state with the distance of [`Phase::Link`].
    fn relinked(&self, y: &[f64; N]) -> [f64; N];

    /// Returns the next time after t (s) at which the rates are not smooth in time.
    fn next_corner(&self, t: f64) -> f64;

    /// True if loads may vary between the stages of a step without a trace in its error estimate.
    fn varies_between_nodes(&self) -> bool;

    /// Returns the variation of the rates due to loads, over the sizes, 1/s, in the Bernstein `ellipse` ρ about intervals.
    fn variation(&self, over: &[Interval; N], ellipse: f64) -> Variation;

    /// Returns the sizes of the state, to which the tolerance is relative; the first `counted` are error-controlled.
    fn sizes(&self) -> ([f64; N], usize);

    /// Returns the rounding error of the depth at a state, m.
    fn rounding(&self, y: &[f64; N]) -> f64;

    /// Ends a step of [`Phase::Release`]: the elastic energy stored in between is not returned and counts as lost.
    fn receded(&self, start: &[f64; N], end: &[f64; N]) -> [f64; N];
}

/// Settings of a run with contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSettings<'a> {
    /// Tolerance of the local error, relative to the sizes.
    pub tolerance: f64,
    /// Part of the longest step that a phase admits.
    pub share: f64,
    /// Last time, s.
    pub t_end: f64,
    /// Limit of the evaluations of the rates.
    pub limit: WorkLimit<'a>,
}
