//! Maximum of the marginal likelihood over the free values.

use super::information::Information;
use super::misfit::Misfit;
use super::values::FreeValue;
use super::values::IdentifiedValue;
use crate::inverse::grid::Path;
use crate::inverse::scales::Noise;

/// Maximum of the likelihood, with or without a missing torque.
#[derive(Debug)]
pub(super) struct Optimum {
    pub values: Vec<f64>,
    pub information: Information,
    pub noise: Noise,
    pub path: Path,
    pub innovations: Vec<f64>,
    pub iterations: usize,
    pub settled: bool,
}

/// Result of the search.
#[derive(Debug)]
pub(super) struct Found {
    pub best: Optimum,
    /// Root mean square of the missing torque, N m.
    pub missing: f64,
    /// Misfit of the equation without a torque beside it; none if the equation describes the record.
    pub misfit: Option<Misfit>,
}

impl Optimum {
    /// Returns the values with their standard errors and 95 % bands.
    pub fn values(&self, free: &[FreeValue], band_factor: f64) -> Vec<IdentifiedValue> {
        let value = |(k, free): (usize, &FreeValue)| {
            let standard_error = self.noise.sigma * self.information.error(k);
            IdentifiedValue {
                key: free.key.clone(),
                unit: free.unit.clone(),
                start: free.start,
                value: self.values[k],
                standard_error,
                half_band: band_factor * standard_error,
            }
        };
        free.iter().enumerate().map(value).collect()
    }

    /// Returns the correlation matrix of the values.
    pub fn correlations(&self) -> Vec<Vec<f64>> {
        let all = 0..self.values.len();
        let row = |i: usize| {
            all.clone()
                .map(|j| self.information.correlation(i, j))
                .collect()
        };
        all.clone().map(row).collect()
    }
}
