//! Free values, and those at the maximum of the marginal likelihood.

use super::information::Information;
use crate::inverse::grid::Path;
use crate::inverse::scales::Noise;

/// Free value of an identification.
#[derive(Clone, Debug)]
pub struct FreeValue {
    /// Key, for example `crank.inertia`.
    pub key: String,
    /// SI unit.
    pub unit: String,
    /// Start value of the search.
    pub start: f64,
    /// Size of a significant change, in `unit`: bounds the difference steps, and sets the first one where the start is 0.
    pub scale: f64,
    /// Whether the value is the zero error of the sensor, rad or m: the index mark of an angle, the zero of x.
    pub is_sensor_zero: bool,
}

/// Identified value with its standard error.
#[derive(Clone, Debug, serde::Serialize)]
pub struct IdentifiedValue {
    /// Key, for example `crank.inertia`.
    pub key: String,
    /// SI unit.
    pub unit: String,
    /// Start value of the search.
    pub start: f64,
    /// Identified value.
    pub value: f64,
    /// Standard error.
    pub standard_error: f64,
    /// Half-width of the 95 % band.
    pub half_band: f64,
}

/// First difference step relative to the start value, or to the scale where the start is 0.
const FIRST: f64 = 1e-4;

impl FreeValue {
    /// Returns the first difference step.
    pub(super) fn first_step(&self) -> f64 {
        FIRST
            * match self.start {
                0.0 => self.scale,
                start => start.abs(),
            }
    }
}

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
}
