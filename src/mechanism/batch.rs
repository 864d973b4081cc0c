//! The equation at many instants at once.

use super::lagrange::forward;
use super::{Equation, LoadValue};
use crate::numeric::angle::Angle;
use crate::numeric::trigonometry::sin_cos;

/// Instants of one motion. All angles share their whole turns.
#[derive(Clone, Copy, Debug)]
pub struct Instants<'a, const N: usize> {
    /// s
    pub t: &'a [f64; N],
    /// The loads of time alone at these times: [`super::Loads::of_time`].
    pub of_time: &'a [LoadValue; N],
    /// Whole turns beside the crank angles.
    pub turns: f64,
    /// Crank angles, rad.
    pub theta: &'a [f64; N],
    /// rad/s
    pub omega: &'a [f64; N],
}

impl Equation {
    /// θ̈ (rad/s²) at N instants, and the power (W) of the loads without a potential, as
    /// [`Equation::acceleration_and_power`] gives them one by one, to rounding.
    pub fn accelerations<const N: usize>(
        &self,
        at: &Instants<'_, N>,
        alpha: &mut [f64; N],
        power: &mut [f64; N],
    ) {
        let (sin, cos) = sin_cos(at.theta);
        let loads = self.loads();
        for i in 0..N {
            let terms = self.terms_at(sin[i], cos[i]);
            let (pose, omega) = (&terms.pose, at.omega[i]);
            let angle = Angle {
                turns: at.turns,
                rest: at.theta[i],
            };
            let steady = loads.with_potential(pose).generalized(pose);
            let spent = loads.without_potential_beside(at.of_time[i], at.t[i], angle, omega, pose);
            let spent = spent.generalized(pose);
            alpha[i] = forward(&terms, steady + spent, omega);
            power[i] = spent * omega;
        }
    }
}
