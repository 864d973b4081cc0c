//! Misfit of the equation to a record that it does not describe, and score tests (Lagrange multiplier tests, Rao 1948)
//! of the keys that are not free.

use nalgebra::{DMatrix, DVector};

use super::trial::Trials;
use super::values::Optimum;
use crate::error::Error;
use crate::inverse::maximum::SIGNIFICANT_RISE;
use crate::inverse::residual_tests::{Runs, Whiteness};

/// Misfit of the equation with the free keys and without a torque beside it.
#[derive(Clone, Debug)]
pub(super) struct Misfit {
    /// Standard deviation of the residuals over that of the noise.
    ratio: f64,
    runs: Runs,
    /// Whether the samples are significantly likelier with a torque beside the equation.
    pub misses_torque: bool,
    /// Fixed keys whose release is expected to raise the likelihood most, by a score test.
    to_free: Vec<FixedKey>,
}

/// Fixed key, with what a score test expects of its release.
#[derive(Clone, Debug)]
struct FixedKey {
    key: String,
    /// Ratio of the residuals to the noise then.
    ratio: f64,
    /// Rise of ln of the likelihood.
    rise: f64,
}

/// Relative norm below which the part of a derivative orthogonal to those of other keys is rounding.
const SCORE_ROUNDING: f64 = 1e-5;

impl Misfit {
    /// Returns the misfit at an optimum; none if no torque is significant and the residuals are white (not for codes).
    ///
    /// # Errors
    /// [`Error::Interrupted`], and the errors of values that a scene may not have.
    pub fn of(trials: &Trials<'_>, at: &Optimum) -> Result<Option<Misfit>, Error> {
        let model = trials.model(&at.values, &at.path, at.noise.sigma)?;
        let noise = trials.without_torque(&model);
        let with_torque = model.anywhere(trials.correlated);
        let is_white = |errors: &[f64]| !Whiteness::of(errors.iter().copied()).is_violated();
        let base = Trials::innovations(&model, &noise);
        let errors = base.standardised();
        let is_code = trials.noise.is_infinite();
        let is_likely = with_torque.likelihood - noise.likelihood <= SIGNIFICANT_RISE;
        if is_likely && (is_code || is_white(&errors)) {
            return Ok(None);
        }
        let mut values = at.values.clone();
        values.extend(trials.all[trials.count..].iter().map(|one| one.start));
        let column = |k: usize| {
            let step = trials.all[k].first_step();
            let found = trials.derivatives(&values, k, step, &at.path, &base, &noise);
            found.ok().map(DVector::from_vec)
        };
        let free = (0..trials.count).filter_map(column);
        let free: Vec<_> = free.filter(|of| of.norm().is_finite()).collect();
        let basis = DMatrix::from_fn(errors.len(), free.len(), |i, j| free[j][i]);
        let basis = basis.qr().q();
        let ratio = noise.sigma / with_torque.sigma.min(trials.noise);
        let rest = beside(&basis, DVector::from_column_slice(&errors));
        let score = |k: usize| {
            let direction = beside(&basis, column(k)?)?;
            let explained = direction.dot(rest.as_ref()?).powi(2);
            let gain = -0.5 * errors.len() as f64 * (1.0 - explained).ln();
            let left = (ratio * (1.0 - explained).sqrt()).max(1.0);
            Some(FixedKey {
                key: trials.all[k].key.clone(),
                ratio: left,
                rise: gain,
            })
        };
        let mut to_free: Vec<FixedKey> =
            (trials.count..trials.all.len()).filter_map(score).collect();
        to_free.sort_by(|a, b| b.rise.total_cmp(&a.rise));
        // Keys nearly as good as the best, and significantly better than none.
        let least = to_free
            .first()
            .map_or(0.0, |best| best.rise - SIGNIFICANT_RISE);
        to_free.retain(|one| one.rise > SIGNIFICANT_RISE.max(least));
        Ok(Some(Misfit {
            ratio,
            runs: Runs::of(&errors),
            misses_torque: !is_likely,
            to_free,
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

    /// Describes remedies in words.
    pub fn help(&self) -> String {
        let load =
            "check that the scene has all loads of the rig, and that its other values are right";
        if self.to_free.is_empty() {
            return load.to_owned();
        }
        let named = self.to_free.iter();
        let named = named.map(|one| format!("`{}` ({:.2} times)", one.key, one.ratio));
        format!(
            "residuals nearer to the noise are expected with one more key free: {}; or {load}",
            named.collect::<Vec<_>>().join(", ")
        )
    }

    /// Returns the misfit as a refusal.
    pub fn refused(&self) -> Error {
        Error::refused(self.words(), self.help())
    }
}

/// Returns the unit vector along the part of a vector orthogonal to an orthonormal basis; none if that is rounding.
fn beside(basis: &DMatrix<f64>, vector: DVector<f64>) -> Option<DVector<f64>> {
    let rest = &vector - basis * basis.tr_mul(&vector);
    let left = rest.norm();
    (left.is_finite() && left > SCORE_ROUNDING * vector.norm()).then(|| rest / left)
}
