//! The estimated motion at each sample, by polynomial or smoother.

use super::branch_tracking::CrankAngles;
use super::measurement_model::Sensor;
use super::motion_estimate::MotionEstimate;
use super::outliers;
use super::polynomial::Polynomial;
use super::residual_tests::Whiteness;
use super::smoother::{Estimate, Grid, KINEMATIC, Path, Problem, Record, Smoothed};
use super::state_space::Prior;
use super::summary::{CandidateSummary, FitSummary};
use super::{FitKind, FitSize, InverseOptions};
use crate::mechanism::Equation;
use crate::numeric::parallel;
use crate::scene::{Measured, Measurement};

/// The estimated motion.
#[derive(Debug)]
pub(super) struct Fitted {
    /// One for each sample.
    pub motion: Vec<MotionEstimate>,
    /// Measured values, rad or m; a crank angle continued over the turns, a crank-pin angle with its sign.
    pub measured: Vec<f64>,
    /// Measured minus fitted.
    pub residuals: Vec<f64>,
    /// Degrees of freedom of the noise.
    pub free: f64,
    pub summary: FitSummary,
    /// Whether the residuals are plainly not noise.
    pub patterned: bool,
    /// Whether the iterations came to rest.
    pub settled: bool,
    /// Least standard deviation of a sample, rad or m.
    floor: f64,
}

/// Most rounds in which outliers are found.
const OUTLIER_ROUNDS: usize = 6;

/// Units of rounding of computed values.
const COMPUTED: f64 = 2.0;

impl Fitted {
    /// Estimates the motion.
    ///
    /// # Errors
    /// Why the samples do not serve.
    pub fn new(
        sensor: Sensor<'_>,
        measurement: &Measurement,
        angles: CrankAngles,
        equation: &Equation,
        options: &InverseOptions,
    ) -> Result<Fitted, String> {
        let values = match sensor.measured {
            Measured::Theta => angles.theta.clone(),
            _ => measurement.values().to_vec(),
        };
        let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let floor =
            (measurement.resolution() / 12f64.sqrt()).max(COMPUTED * f64::EPSILON * largest);
        let polynomial =
            |degree| Polynomial::fit(measurement.elapsed(), &angles.theta, floor, degree);
        let degree = match options.size {
            FitSize::Auto => None,
            FitSize::Fixed(degree) => Some(degree),
        };
        let of_polynomial = |polynomial: Polynomial, reason: &str| {
            Fitted::of_polynomial(sensor, measurement, polynomial, values.clone(), reason)
        };
        if options.fit == FitKind::Polynomial {
            return Ok(of_polynomial(polynomial(degree)?, "it was asked for"));
        }
        let simple = (options.fit == FitKind::Auto && is_simple(sensor, &angles.theta))
            .then(|| supported_degree(measurement.elapsed(), &angles.theta, floor))
            .and_then(|degree| polynomial(Some(degree)).ok())
            .map(|polynomial| {
                of_polynomial(polynomial, "within one turn it leaves nothing but noise")
            })
            .filter(|polynomial| !polynomial.patterned);
        let problem = Problem {
            record: Record {
                sensor,
                times: measurement.elapsed(),
                weights: vec![1.0; values.len()],
                values: values.clone(),
                floor,
                origin: measurement.origin(),
            },
            grid: Grid::new(measurement.elapsed(), &angles.theta),
            equation,
        };
        let smoothed = Fitted::smoothed(problem, &angles, measurement);
        Ok(match simple {
            Some(polynomial)
                if smoothed.summary.outliers == 0
                    && polynomial.information() <= smoothed.information() =>
            {
                polynomial
            }
            _ => smoothed,
        })
    }

    /// Akaike's information criterion for few samples (Hurvich and Tsai, Biometrika 76 (1989) 297), σ one of the parameters;
    /// of a smoother with what its parameters are worth (Hurvich, Simonoff and Tsai 1998).
    fn information(&self) -> f64 {
        let n = self.residuals.len() as f64;
        let parameters = self.summary.parameters + 1.0;
        let spread = self.summary.rms.max(self.floor);
        2.0 * n * spread.ln() + 2.0 * parameters * n / (n - parameters - 1.0).max(1.0)
    }

    fn smoothed(
        mut problem: Problem<'_>,
        angles: &CrankAngles,
        measurement: &Measurement,
    ) -> Fitted {
        let first = straight(&problem, &angles.theta);
        let sigma = angles.sigma.max(problem.record.floor);
        let mut kinematic = problem.kinematic(first, sigma);
        for _ in 0..OUTLIER_ROUNDS {
            let Some(weights) = outliers::weights(&problem, &kinematic) else {
                break;
            };
            let before = std::mem::replace(&mut problem.record.weights, weights);
            let path = problem.path_of(KINEMATIC, &kinematic);
            kinematic = problem.kinematic(path, kinematic.noise.sigma);
            if outliers::alike(&before, &problem.record.weights) {
                break;
            }
        }
        let (smoothed, candidates) = problem.likeliest(kinematic);
        Fitted::of_smoother(&problem, smoothed, &candidates, measurement)
    }

    fn of_smoother(
        problem: &Problem<'_>,
        smoothed: Smoothed,
        candidates: &[(Prior, f64)],
        measurement: &Measurement,
    ) -> Fitted {
        let record = &problem.record;
        let at = |i: usize| &smoothed.estimates[problem.node_of(i)];
        let motion = parallel::list(record.times.len(), |i| motion_of(at(i)));
        let sigma = smoothed.noise.sigma;
        let mut parameters = 0.0;
        for (i, state) in motion.iter().enumerate() {
            let slope = record.sensor.shown(state.value[0]).slope;
            parameters += record.weights[i] * slope * slope * state.covariance[0] / (sigma * sigma);
        }
        let whiteness = Whiteness::of(smoothed.estimates.iter().map(|e| e.innovation));
        let prior = smoothed.prior;
        let mut fitted = Fitted::of_motion(record.sensor, motion, record.values.clone());
        fitted.floor = record.floor;
        let list = candidates
            .iter()
            .map(|(prior, likelihood)| CandidateSummary {
                prior: prior.name(),
                log_likelihood: *likelihood,
            });
        fitted.free = (fitted.residuals.len() as f64 - parameters).max(1.0);
        fitted.patterned = whiteness.is_violated();
        fitted.settled = smoothed.settled;
        fitted.summary = FitSummary {
            kind: "smoother",
            reason: "its prior is the likeliest".to_owned(),
            prior: prior.name(),
            candidates: list.collect(),
            degree: 2 * (prior.order + 2) - 1,
            time_origin_s: measurement.origin(),
            sigma,
            parameters,
            corner_hz: Some(smoothed.noise.corner / std::f64::consts::TAU),
            outliers: record.weights.iter().filter(|w| **w < 0.5).count(),
            noise_correlation_s: smoothed.noise.correlated.map(|c| 1.0 / c.decay),
            residual_lag_one: whiteness.lag_one,
            residual_runs: whiteness.runs,
            ..fitted.summary
        };
        fitted
    }

    fn of_polynomial(
        sensor: Sensor<'_>,
        measurement: &Measurement,
        polynomial: Polynomial,
        values: Vec<f64>,
        reason: &str,
    ) -> Fitted {
        let mut fitted = Fitted::of_motion(sensor, polynomial.motion, values);
        fitted.floor = polynomial.floor;
        let whiteness = Whiteness::of(fitted.residuals.iter().copied());
        let finite = |value: &f64| value.is_finite().then_some(*value);
        let parameters = polynomial.degree as f64 + 1.0;
        fitted.free = (fitted.residuals.len() as f64 - parameters).max(1.0);
        // What rounding leaves has patterns of its own.
        fitted.patterned = whiteness.is_violated() && fitted.summary.rms > polynomial.floor;
        fitted.summary = FitSummary {
            kind: "polynomial",
            reason: reason.to_owned(),
            degree: polynomial.degree,
            time_origin_s: measurement.origin(),
            coefficients: polynomial.coefficients.iter().map(finite).collect(),
            standard_errors: polynomial.standard_errors.iter().map(finite).collect(),
            condition: finite(&polynomial.condition),
            sigma: polynomial.sigma,
            parameters,
            residual_lag_one: whiteness.lag_one,
            residual_runs: whiteness.runs,
            ..fitted.summary
        };
        fitted
    }

    /// Measured values and residuals of a motion.
    fn of_motion(sensor: Sensor<'_>, motion: Vec<MotionEstimate>, values: Vec<f64>) -> Fitted {
        let residuals = parallel::list(values.len(), |i| {
            sensor.residual(values[i], motion[i].value[0]).0
        });
        let measured = match sensor.measured {
            Measured::Gamma => parallel::list(values.len(), |i| {
                sensor.shown(motion[i].value[0]).value + residuals[i]
            }),
            _ => values,
        };
        let n = residuals.len() as f64;
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let mean = measured.iter().sum::<f64>() / n;
        let about: f64 = measured.iter().map(|v| (v - mean) * (v - mean)).sum();
        let summary = FitSummary {
            r_squared: if about > 0.0 {
                1.0 - squares / about
            } else {
                1.0
            },
            rms: (squares / n).sqrt(),
            ..FitSummary::default()
        };
        Fitted {
            motion,
            measured,
            residuals,
            free: 1.0,
            summary,
            patterned: false,
            settled: true,
            floor: 0.0,
        }
    }
}

fn motion_of(estimate: &Estimate) -> MotionEstimate {
    MotionEstimate {
        value: estimate.motion,
        covariance: estimate.covariance,
        rounding: [f64::EPSILON * estimate.motion[0].abs(), 0.0, 0.0],
    }
}

/// Highest degree of a polynomial that is tried.
const HIGHEST: usize = 12;

/// Most samples by which a degree is chosen.
const ENOUGH: usize = 2000;

/// The degree of a polynomial that the samples support (Schwarz's criterion, Annals of Statistics 6 (1978) 461).
fn supported_degree(t: &[f64], theta: &[f64], floor: f64) -> usize {
    let stride = t.len().div_ceil(ENOUGH);
    let some = |list: &[f64]| -> Vec<f64> { list.iter().step_by(stride).copied().collect() };
    let (t, theta) = (some(t), some(theta));
    let n = t.len() as f64;
    let criterion = |degree: &usize| {
        let fit = Polynomial::fit(&t, &theta, floor, Some(*degree)).ok()?;
        let squares: f64 = fit
            .motion
            .iter()
            .zip(&theta)
            .map(|(state, theta)| (theta - state.value[0]).powi(2))
            .sum();
        let variance = (squares / n).max(floor * floor);
        Some((n * variance.ln() + (*degree as f64 + 1.0) * n.ln(), *degree))
    };
    let found = (1..=HIGHEST.min(t.len().saturating_sub(3))).collect::<Vec<_>>();
    let found = found
        .iter()
        .filter_map(criterion)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    found.map_or(1, |(_, degree)| degree)
}

/// Whether a polynomial may serve: a crank angle that was measured within one turn.
fn is_simple(sensor: Sensor<'_>, theta: &[f64]) -> bool {
    let (least, most) = theta
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(*v), b.max(*v))
        });
    sensor.measured == Measured::Theta && most - least <= std::f64::consts::TAU
}

/// A first path: of measured crank angles a straight line, else the angles with their slopes.
fn straight(problem: &Problem<'_>, theta: &[f64]) -> Path {
    let (times, record) = (&problem.grid.times, &problem.record);
    let (first, last) = (0, theta.len() - 1);
    let speed = (theta[last] - theta[first]) / (record.times[last] - record.times[first]);
    let states = times.iter().enumerate().map(|(node, t)| {
        if record.sensor.measured == Measured::Theta {
            return [theta[0] + speed * (t - times[0]), speed, 0.0, 0.0];
        }
        let next = problem.grid.first[node].clamp(1, last);
        let (a, b) = (record.times[next - 1], record.times[next]);
        let slope = (theta[next] - theta[next - 1]) / (b - a);
        [theta[next - 1] + slope * (t - a), slope, 0.0, 0.0]
    });
    Path {
        states: states.collect(),
        variances: None,
    }
}
