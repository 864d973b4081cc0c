//! Fisher information of the free values: standard errors, correlations, and refusal of undetermined values.

use nalgebra::{DMatrix, DVector, DVectorView, SymmetricEigen};

use super::values::FreeValue;
use crate::error::Error;

/// Least eigenvalue of the information scaled to a unit diagonal: differences of innovations are accurate to about
/// 1e-6, and eigenvalues near the square of that are rounding.
const LEAST_EIGENVALUE: f64 = 1e-11;

/// Relative bound: smaller components of the weakest eigenvector count as 0, and factors that differ less as equal.
const ALIKE: f64 = 0.1;

/// Information matrix JᵀJ of standardised prediction errors, with eigenvectors after scaling to a unit diagonal.
#[derive(Clone, Debug)]
pub(super) struct Information {
    /// Norms of the columns of J.
    norms: Vec<f64>,
    eigen: SymmetricEigen<f64, nalgebra::Dyn>,
    /// (JᵀJ)⁻¹
    covariance: DMatrix<f64>,
}

impl Information {
    /// Computes the information from the columns of J.
    ///
    /// # Errors
    /// [`Error::Refused`] for values without effect or finite derivatives, or that the record cannot tell apart.
    pub fn new(
        columns: &[Vec<f64>],
        values: &[f64],
        free: &[FreeValue],
    ) -> Result<Information, Error> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let norms: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
        for (norm, one) in norms.iter().zip(free) {
            if !norm.is_finite() {
                return Err(Error::refused(
                    format!(
                        "the equation has no finite value along the motion where `{}` varies",
                        one.key
                    ),
                    "let the tables of the scene cover the measured motion, and check the lengths",
                ));
            }
            if *norm == 0.0 {
                return Err(Error::refused(
                    format!(
                        "the record does not tell `{}`: the measured motion does not depend on it",
                        one.key
                    ),
                    format!("leave `{}` out of --free", one.key),
                ));
            }
        }
        let n = norms.len();
        let scaled = DMatrix::from_fn(n, n, |i, j| {
            dot(&columns[i], &columns[j]) / (norms[i] * norms[j])
        });
        let eigen = SymmetricEigen::new(scaled);
        let inverse = DMatrix::from_diagonal(&eigen.eigenvalues.map(f64::recip));
        let inverse = &eigen.eigenvectors * inverse * eigen.eigenvectors.transpose();
        let found = Information {
            covariance: DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] / (norms[i] * norms[j])),
            norms,
            eigen,
        };
        if found.eigen.eigenvalues.min() < LEAST_EIGENVALUE {
            return Err(found.alike(values, free));
        }
        Ok(found)
    }

    /// Returns the eigenvector of the smallest eigenvalue.
    fn weakest(&self) -> DVectorView<'_, f64> {
        let at = self.eigen.eigenvalues.imin();
        self.eigen.eigenvectors.column(at)
    }

    /// Returns the indices of the values in the eigenvector of the smallest eigenvalue.
    fn group(&self) -> Vec<usize> {
        let vector = self.weakest();
        let most = vector.amax();
        let all = 0..self.norms.len();
        all.filter(|k| vector[*k].abs() > ALIKE * most).collect()
    }

    /// Returns the refusal of the weakest combination.
    fn alike(&self, values: &[f64], free: &[FreeValue]) -> Error {
        let (group, vector) = (self.group(), self.weakest());
        let names = group.iter().map(|k| format!("`{}`", free[*k].key));
        let names = Vec::from_iter(names).join(" and ");
        let parts = group
            .iter()
            .map(|k| vector[*k] / (self.norms[*k] * values[*k]));
        let mean = parts.clone().sum::<f64>() / group.len() as f64;
        // It changes all its values by one factor if the equation is homogeneous in them.
        let is_scale = parts
            .clone()
            .all(|part| (part - mean).abs() < ALIKE * mean.abs());
        match is_scale {
            true => Error::refused(
                format!(
                    "the record cannot tell {names} apart, but only their ratios: all of them multiplied by one number give the same motion, and no known mass, weight or load sets the scale"
                ),
                "state the value of one of them in the scene and leave it out of --free, or measure a motion under a known torque, force or weight",
            ),
            false => Error::refused(
                format!(
                    "the record cannot tell {names} apart: it has the same motion for many of their values"
                ),
                "leave one of them out of --free and state its value in the scene; a known torque or mass sets the scale of the others",
            ),
        }
    }

    /// Refuses values whose standard errors exceed the values because of their mutual correlation.
    pub fn is_told(&self, values: &[f64], sigma: f64, free: &[FreeValue]) -> Result<(), Error> {
        let group = self.group();
        let unclear = |k: &usize| {
            let alone = sigma / self.norms[*k];
            let error = sigma * self.error(*k);
            error > values[*k].abs() && alone < 0.1 * error
        };
        match group.len() > 1 && group.iter().all(unclear) {
            true => Err(self.alike(values, free)),
            false => Ok(()),
        }
    }

    /// Returns the standard error of a value over σ.
    pub fn error(&self, k: usize) -> f64 {
        self.covariance[(k, k)].sqrt()
    }

    /// Returns the standard error of a value over σ if no other value were free.
    pub fn error_alone(&self, k: usize) -> f64 {
        1.0 / self.norms[k]
    }

    /// Returns the correlation matrix of the values.
    pub fn correlations(&self) -> Vec<Vec<f64>> {
        let all = 0..self.norms.len();
        let of = |i: usize, j: usize| match i == j {
            true => 1.0,
            false => self.covariance[(i, j)] / (self.error(i) * self.error(j)),
        };
        let row = |i: usize| all.clone().map(|j| of(i, j)).collect();
        all.clone().map(row).collect()
    }

    /// Returns (JᵀJ)⁻¹ g.
    pub fn solved(&self, g: &[f64]) -> Vec<f64> {
        let found = &self.covariance * DVector::from_column_slice(g);
        found.as_slice().to_vec()
    }
}
