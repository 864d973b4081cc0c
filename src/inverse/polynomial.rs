//! A polynomial of the crank angle over time by least squares.

use super::motion_estimate::MotionEstimate;
use crate::numeric::fit::{Curve, Kind, Samples, Size};

/// A fitted polynomial.
#[derive(Clone, Debug)]
pub(super) struct Polynomial {
    pub degree: usize,
    pub sigma: f64,
    pub floor: f64,
    pub coefficients: Vec<f64>,
    pub standard_errors: Vec<f64>,
    pub condition: f64,
    pub motion: Vec<MotionEstimate>,
}

impl Polynomial {
    /// Fits θ (rad) over t (s) with a degree, or the best one.
    pub fn fit(
        t: &[f64],
        theta: &[f64],
        floor: f64,
        degree: Option<usize>,
    ) -> Result<Polynomial, String> {
        let samples = Samples {
            t,
            target: theta,
            weight: None,
            floor,
        };
        let curve = Curve::fit(
            &samples,
            Kind::Polynomial,
            degree.map_or(Size::Auto, Size::Fixed),
        )?;
        let quality = curve.quality();
        let (coefficients, errors, condition) = curve.coefficients();
        let motion = curve.states(t).into_iter().map(|state| MotionEstimate {
            value: state.value,
            covariance: std::array::from_fn(|k| {
                state.covariance[k] * quality.sigma * quality.sigma
            }),
            rounding: state.rounding,
        });
        Ok(Polynomial {
            degree: curve.degree(),
            sigma: quality.sigma,
            floor: quality.floor,
            coefficients,
            standard_errors: errors.iter().map(|e| e * quality.sigma).collect(),
            condition,
            motion: motion.collect(),
        })
    }
}
