//! The covariance of the coefficients of a spline under a penalty.

use super::penalized::Normal;
use crate::numeric::banded::Banded;
use crate::numeric::parallel;

/// Step in the logarithm of the penalty for derivatives by it.
const STEP: f64 = 0.05;

/// A⁻¹ and the mean products of the errors of the coefficients, inside the band.
pub(super) struct Spread {
    pub inverse: Banded,
    pub covariance: Banded,
}

impl Spread {
    /// For samples of unit variance and curves as rough as the likely penalty has them.
    ///
    /// With N the normal matrix and P the penalty of strength s, A = N + sP, noise gives A⁻¹ N A⁻¹, and the roughness
    /// s² A⁻¹ P A⁻¹ over the likely strength. The two matrices come from A⁻¹ and its derivative by ln s, −s A⁻¹ P A⁻¹.
    pub fn of(normal: &Normal<'_>, [likely, strength]: [f64; 2], factor: &Banded) -> Spread {
        let found = parallel::map([0.0, -STEP, STEP].into_iter(), |step| match step {
            0.0 => Some(factor.inverse_band()),
            _ => Some(normal.factor(strength * step.exp())?.inverse_band()),
        });
        let mut found = found.into_iter();
        let mut next = || found.next().flatten();
        let inverse = next().unwrap_or_else(|| factor.inverse_band());
        let covariance = match (next(), next()) {
            (Some(weaker), Some(stronger)) => {
                let part = (1.0 - strength / likely) * 0.5 / STEP;
                inverse.plus(part, &stronger).plus(-part, &weaker)
            }
            // As if the fit had the likely penalty.
            _ => inverse.clone(),
        };
        Spread {
            inverse,
            covariance,
        }
    }
}
