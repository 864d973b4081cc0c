//! The estimated motion at each sample, by polynomial or smoother.

use super::branch_tracking::CrankAngles;
use super::measurement_model::Sensor;
use super::motion_estimate::MotionEstimate;
use super::polynomial::Polynomial;
use super::residual_tests::Whiteness;
use super::smoother::{Estimate, Grid, KINEMATIC, MECHANICAL, Path, Problem, Record, Smoothed};
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
}

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
        let floor = (measurement.resolution() / 12f64.sqrt()).max(COMPUTED * f64::EPSILON * largest);
        let polynomial = |degree| Polynomial::fit(measurement.elapsed(), &angles.theta, floor, degree);
        let degree = match options.size {
            FitSize::Auto => None,
            FitSize::Fixed(degree) => Some(degree),
        };
        if options.fit == FitKind::Polynomial {
            let polynomial = polynomial(degree)?;
            return Ok(Fitted::of_polynomial(sensor, measurement, polynomial, values, "asked for"));
        }
        let problem = Problem {
            record: Record {
                sensor,
                times: measurement.elapsed(),
                weights: vec![1.0; values.len()],
                values,
                floor,
                origin: measurement.origin(),
            },
            grid: Grid::new(measurement.elapsed(), &angles.theta),
            equation,
        };
        Ok(Fitted::smoothed(problem, &angles, measurement))
    }

    fn smoothed(problem: Problem<'_>, angles: &CrankAngles, measurement: &Measurement) -> Fitted {
        let first = straight(&problem, &angles.theta);
        let kinematic = problem.kinematic(first, angles.sigma.max(problem.record.floor));
        let mut candidates = vec![(KINEMATIC, kinematic.noise.likelihood)];
        let again = problem.candidate(KINEMATIC, &kinematic);
        candidates[0].1 = again.0.likelihood;
        let tried = parallel::map(MECHANICAL.iter(), |prior| Some(problem.candidate(*prior, &kinematic)));
        let mut best = None;
        for (prior, found) in MECHANICAL.iter().zip(tried) {
            let Some(found) = found else { continue };
            candidates.push((*prior, found.0.likelihood));
            if found.0.likelihood > again.0.likelihood
                && best.as_ref().is_none_or(|(_, (noise, _, _)): &(Prior, (super::likelihood::Noise, _, _))| found.0.likelihood > noise.likelihood)
            {
                best = Some((*prior, found));
            }
        }
        let smoothed = match best {
            Some((prior, (noise, scales, path))) => {
                let found = problem.iterated(prior, noise, scales, path);
                if found.settled { found } else { kinematic }
            }
            None => kinematic,
        };
        candidates.sort_by(|a, b| b.1.total_cmp(&a.1));
        Fitted::of_smoother(&problem, smoothed, &candidates, measurement)
    }

    fn of_smoother(problem: &Problem<'_>, smoothed: Smoothed, candidates: &[(Prior, f64)], measurement: &Measurement) -> Fitted {
        let record = &problem.record;
        let at = |i: usize| {
            let node = problem.grid.first.partition_point(|first| *first <= i) - 1;
            &smoothed.estimates[node]
        };
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
        let list = candidates.iter().map(|(prior, likelihood)| CandidateSummary {
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
            noise_correlation_s: smoothed.noise.correlated.map(|c| 1.0 / c.decay),
            residual_lag_one: whiteness.lag_one,
            residual_runs: whiteness.runs,
            ..fitted.summary
        };
        fitted
    }

    fn of_polynomial(sensor: Sensor<'_>, measurement: &Measurement, polynomial: Polynomial, values: Vec<f64>, reason: &str) -> Fitted {
        let mut fitted = Fitted::of_motion(sensor, polynomial.motion, values);
        let whiteness = Whiteness::of(fitted.residuals.iter().copied());
        let finite = |value: &f64| value.is_finite().then_some(*value);
        let parameters = polynomial.degree as f64 + 1.0;
        fitted.free = (fitted.residuals.len() as f64 - parameters).max(1.0);
        fitted.patterned = whiteness.is_violated();
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
        let residuals = parallel::list(values.len(), |i| sensor.residual(values[i], motion[i].value[0]).0);
        let measured = match sensor.measured {
            Measured::Gamma => parallel::list(values.len(), |i| sensor.shown(motion[i].value[0]).value + residuals[i]),
            _ => values,
        };
        let n = residuals.len() as f64;
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let mean = measured.iter().sum::<f64>() / n;
        let about: f64 = measured.iter().map(|v| (v - mean) * (v - mean)).sum();
        let summary = FitSummary {
            r_squared: if about > 0.0 { 1.0 - squares / about } else { 1.0 },
            rms: (squares / n).sqrt(),
            ..FitSummary::default()
        };
        Fitted { motion, measured, residuals, free: 1.0, summary, patterned: false, settled: true }
    }
}

fn motion_of(estimate: &Estimate) -> MotionEstimate {
    MotionEstimate {
        value: estimate.motion,
        covariance: estimate.covariance,
        rounding: [f64::EPSILON * estimate.motion[0].abs(), 0.0, 0.0],
    }
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
    Path { states: states.collect(), variances: None }
}
