//! Misfit of the equation to a record that it does not describe.

use super::gauss_newton::SIGNIFICANT_RISE;
use super::optimum::Optimum;
use super::trial::Trials;
use crate::error::Error;
use crate::inverse::residual_tests::{Runs, Whiteness};

/// Remedy for a misfit.
pub(super) const MISFIT_HELP: &str = "check that the scene has all loads of the rig, and that its other values are right, or let another key be free";

/// Misfit of the equation with the free keys and without a torque beside it.
#[derive(Clone, Debug)]
pub(super) struct Misfit {
    /// Standard deviation of the residuals over that of the noise.
    ratio: f64,
    runs: Runs,
    /// Whether the samples are significantly likelier with a torque beside the equation.
    pub misses_torque: bool,
}

impl Misfit {
    /// Returns the misfit at an optimum; none if no torque is significant and the residuals are white (not for codes).
    ///
    /// # Errors
    /// [`Error::Interrupted`], and the errors of values that a scene may not have.
    pub fn of(trials: &Trials<'_>, at: &Optimum) -> Result<Option<Misfit>, Error> {
        let model = trials.model(&at.values, &at.path, at.noise.sigma)?;
        let noise = trials.without_torque(&model);
        let with_torque = trials.likeliest(&model);
        let is_white = |errors: &[f64]| !Whiteness::of(errors.iter().copied()).is_violated();
        let errors = trials.innovations(&model, &noise).standardised();
        let is_code = trials.noise.is_infinite();
        let is_likely = with_torque.likelihood - noise.likelihood <= SIGNIFICANT_RISE;
        if is_likely && (is_code || is_white(&errors)) {
            return Ok(None);
        }
        Ok(Some(Misfit {
            ratio: noise.sigma / with_torque.sigma.min(trials.noise),
            runs: Runs::of(&errors),
            misses_torque: !is_likely,
        }))
    }

    /// Describes the misfit in words.
    pub fn words(&self) -> String {
        let Runs {
            found, expected, ..
        } = self.runs;
        format!(
            "the equation with these keys free does not describe the record: its residuals are {:.2} times the noise, in {found:.0} runs of one sign where noise has {expected:.0}",
            self.ratio
        )
    }

    /// Returns the misfit as a refusal.
    pub fn refused(&self) -> Error {
        Error::refused(self.words(), MISFIT_HELP)
    }
}
