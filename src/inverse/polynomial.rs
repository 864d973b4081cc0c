//! Polynomial of the crank angle over time: samples in, motion with covariance out, by least squares in the measured
//! quantity (Gauss-Newton iterations unless the crank angle itself is measured).

use super::motion_estimate::MotionEstimate;
use super::record::Record;
use crate::numeric::parallel;
use crate::numeric::polynomial_fit::{Equations, PolynomialFit};

/// Maximum number of Gauss-Newton iterations, and number of those after which the degree is fixed.
const ITERATIONS: usize = 30;
const CHOICES: usize = 3;

/// Largest change of the crank angle, rad, at which the iterations have converged.
const ANGLE_AT_REST: f64 = 1e-10;

/// Fitted polynomial, and the motion at the samples.
#[derive(Clone, Debug)]
pub(super) struct Polynomial {
    pub fit: PolynomialFit,
    pub motion: Vec<MotionEstimate>,
    /// Whether the iterations converged.
    pub converged: bool,
}

impl Polynomial {
    /// Fits a polynomial of the given degree, or of the likeliest one, from first crank angles, rad.
    ///
    /// # Errors
    /// The reason, in words, if the samples are too few.
    pub fn new(
        record: &Record<'_>,
        first: &[f64],
        degree: Option<usize>,
    ) -> Result<Polynomial, String> {
        let mut theta = first.to_vec();
        let mut chosen = degree;
        let mut iteration = 0;
        loop {
            iteration += 1;
            let (target, weight) = parallel::pairs(theta.len(), |i| {
                let (residual, shown) = record.sensor.residual(record.values[i], [theta[i], 0.0]);
                (residual + shown.slope * theta[i], shown.slope)
            });
            let equations = Equations {
                t: &record.times,
                target: &target,
                weight: (!record.is_linear()).then_some(&weight),
                floor: record.floor,
            };
            let fit = PolynomialFit::among(&equations, chosen, degree).map_err(|few| {
                let (found, needed) = (few.found, few.needed);
                format!("{found} samples are too few for a polynomial: it needs {needed}")
            })?;
            let motion = parallel::list(theta.len(), |i| {
                let state = fit.state(record.times[i]);
                MotionEstimate {
                    value: state.value,
                    covariance: state.covariance,
                    numerical: state.rounding,
                }
            });
            let pairs = motion.iter().zip(&theta);
            let change = pairs.fold(0.0, |most: f64, (state, theta)| {
                most.max((state.value[0] - theta).abs())
            });
            let converged = record.is_linear() || change < ANGLE_AT_REST;
            if converged || iteration == ITERATIONS || !change.is_finite() {
                return Ok(Polynomial {
                    fit,
                    motion,
                    converged,
                });
            }
            if iteration >= CHOICES {
                chosen = Some(fit.degree());
            }
            theta = motion.iter().map(|state| state.value[0]).collect();
        }
    }
}
