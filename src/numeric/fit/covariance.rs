//! The covariance of the coefficients of a spline under a penalty.

use super::penalized::Normal;
use crate::numeric::banded::{Banded, Factors};
use crate::numeric::parallel;

/// Step in the logarithm of the penalty for derivatives by it.
const STEP: f64 = 0.05;

/// What the coefficients are worth, and the mean products of their errors.
pub(super) struct Spread {
    /// What the parameters are worth.
    pub parameters: f64,
    /// The mean products inside the band.
    pub covariance: Banded,
}

impl Spread {
    /// For samples of unit variance and curves as rough as the likely penalty has them.
    ///
    /// With N the normal matrix and P the penalty of strength s, A = N + sP, noise gives A⁻¹ N A⁻¹, and the roughness
    /// s² A⁻¹ P A⁻¹ over the likely strength. The two matrices come from A⁻¹ and its derivative by ln s, −s A⁻¹ P A⁻¹.
    pub fn of(normal: &Normal<'_>, [likely, strength]: [f64; 2], factors: &Factors) -> Spread {
        let steps = [0.0, -STEP, STEP];
        // The likely penalty needs no derivative.
        let steps = if likely == strength {
            &steps[..1]
        } else {
            &steps
        };
        let found = parallel::map(steps.iter(), |step| match *step {
            0.0 => Some(factors.clone().inverse_band()),
            step => Some(normal.factor(strength * step.exp())?.inverse_band()),
        });
        let mut found = found.into_iter();
        let mut next = || found.next().flatten();
        let mut covariance = next().unwrap_or_else(|| factors.clone().inverse_band());
        let parameters = covariance.trace_of_product(&normal.matrix);
        // As if the fit had the likely penalty, if these fail.
        if let (Some(weaker), Some(stronger)) = (next(), next()) {
            let part = (1.0 - strength / likely) * 0.5 / STEP;
            covariance.add_times(part, &stronger);
            covariance.add_times(-part, &weaker);
        }
        Spread {
            parameters,
            covariance,
        }
    }
}
