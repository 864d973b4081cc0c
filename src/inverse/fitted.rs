//! Estimated motion at each sample, by polynomial or smoother, with residuals and figures of the fit.

use std::f64::consts::TAU;

use super::candidates::Candidate;
use super::model::prior::Unknown;
use super::model::tone::{self, Carrier, Tone};
use super::motion_estimate::MotionEstimate;
use super::polynomial::Polynomial;
use super::problem::Problem;
use super::record::Record;
use super::residual_tests::Whiteness;
use super::result::shared_errors::Source;
use super::result::summary::FitSummary;
use super::row::Residual;
use super::samples::Given;
use super::smoother::Smoothed;
use super::tones::choice::BesideTones;
use super::{FitKind, InverseOptions};
use crate::numeric::median::range;
use crate::numeric::parallel;
use crate::scene::{Measured, Measurement};

/// Estimated motion, with residuals and figures of the fit.
#[derive(Debug, Default)]
pub(super) struct Fitted {
    /// Motion at each row of the measurement.
    pub motion: Vec<MotionEstimate>,
    /// Measured values and residuals; a crank-pin angle has its sign.
    pub residuals: Vec<Residual>,
    /// Degrees of freedom of the noise.
    pub free: f64,
    pub summary: FitSummary,
    /// Whether the residuals are plainly not white noise.
    pub patterned: bool,
    /// Whether the iterations converged.
    pub converged: bool,
    /// Whether the equation has no finite value along the motion: no prior with mechanics has a likelihood.
    pub without_equation: bool,
    /// Row of the outlier with the largest residual.
    pub farthest_outlier: Option<usize>,
    /// Row of the first outlier that repeats the value before it.
    pub held: Option<usize>,
    /// Turns per cycle of the periodic torque in the smoother's prior; 0 without a periodic torque.
    pub cycle: u8,
    /// Harmonics of a turn that the samples determine in a periodic torque.
    pub told: f64,
    /// Step of an encoder or of rounding, rad, if wider than the noise.
    pub coded: Option<f64>,
    /// θ, ω, θ̈ at each sample under each of the errors that all samples share.
    pub moved: Vec<Vec<[f64; 3]>>,
}

impl Fitted {
    /// Estimates the motion by the method of the options.
    ///
    /// # Errors
    /// The reason, in words: too few samples, or a degree given to a smoother.
    pub fn new(
        given: Given<'_>,
        options: &InverseOptions,
        sources: &[Source],
    ) -> Result<Fitted, String> {
        let Given {
            measurement,
            angles,
            ..
        } = given;
        let record = given.record(&[]);
        let degree = options.degree;
        let polynomial = |reason: &str| {
            if record.sensor.is_of_speed() {
                return Err(
                    "a polynomial is fitted to samples of the position, and the motion is a speed"
                        .to_owned(),
                );
            }
            let found = Polynomial::new(&record, &angles.theta, degree)?;
            let fitted = Fitted::of_polynomial(measurement, &record, &found, reason);
            let degree = fitted.summary.degree;
            let of =
                |source: &Source| source.polynomial(&record, &fitted.motion, degree, measurement);
            let moved = sources.iter().map(of).collect();
            Ok::<_, String>((Fitted { moved, ..fitted }, found.fit))
        };
        match (options.fit, degree) {
            (FitKind::Polynomial, _) | (FitKind::Auto, Some(_)) => {
                let (fitted, fit) = polynomial("it was asked for")?;
                return Ok(match degree {
                    None => fitted.averaged(&fit, &record),
                    Some(_) => fitted,
                });
            }
            (FitKind::Smoother, Some(degree)) => {
                return Err(format!("a smoother has no degree, and {degree} is given"));
            }
            _ => {}
        }
        let (least, most) = range(&angles.theta);
        let may_be_simple =
            options.fit == FitKind::Auto && record.beside.is_empty() && most - least <= TAU;
        let mut simple = may_be_simple
            .then(|| polynomial("within one turn it leaves nothing but noise").ok())
            .flatten();
        // What a polynomial leaves is motion or noise: the smoother compares both.
        let suspected = simple.as_ref().is_some_and(|(found, _)| found.patterned);
        simple = simple.filter(|(polynomial, _)| polynomial.converged && !polynomial.patterned);
        let is_exact = |(polynomial, _): &mut (Fitted, _)| {
            polynomial.summary.rms <= record.floor && record.is_computed()
        };
        if let Some((exact, _)) = simple.take_if(is_exact) {
            return Ok(exact);
        }
        let mut found = given.likeliest(suspected);
        let rival = found.take_rival(measurement.elapsed());
        let BesideTones {
            problem,
            kinematic,
            smoothed,
            ..
        } = found;
        if let Some((polynomial, fit)) = simple {
            let degree = polynomial.summary.degree;
            let log_odds = problem.log_odds(degree, &kinematic, &smoothed);
            if let Some(log_odds) = log_odds.filter(|log_odds| *log_odds > 0.0) {
                let other = problem.averaged(smoothed);
                let other = problem.motion_at(&other, measurement.elapsed());
                return Ok(polynomial.averaged(&fit, &record).beside(other, log_odds));
            }
        }
        // Frees the memory of a long record.
        drop(kinematic);
        let smoothed = problem.averaged(smoothed);
        let fitted = Fitted {
            moved: parallel::map(sources.iter(), |source| {
                source.smoothed(&problem, &smoothed, measurement)
            }),
            ..Fitted::of_smoother(given, &problem, &smoothed)
        };
        Ok(match rival {
            // A band in which both count alike reaches beyond the less probable one.
            Some(motion) => fitted.beside(motion, 0.0),
            None => fitted,
        })
    }

    fn of_smoother(given: Given<'_>, problem: &Problem<'_>, smoothed: &Smoothed) -> Fitted {
        let record = &problem.record;
        let samples = given.record(&record.tones);
        let motion = problem.motion_at(smoothed, given.measurement.elapsed());
        let (prior, sigma) = (smoothed.prior, smoothed.noise.sigma);
        let parameters = problem.parameters(smoothed, &motion);
        let innovations = smoothed.estimates.iter().map(|e| e.innovation);
        let beside = (record.beside.iter().map(|other| other.summary(&motion))).collect();
        let whiteness = Some(Whiteness::of(innovations));
        let mut fitted = Fitted::of_motion(given.measurement, &samples, motion, whiteness);
        let size = |row: &usize| fitted.residuals[*row].residual.abs();
        let outliers: Vec<usize> = problem.single().outliers().collect();
        fitted.farthest_outlier =
            (outliers.iter().copied()).max_by(|a, b| size(a).total_cmp(&size(b)));
        fitted.held = (outliers.iter().copied()).find(|row| samples.repeated[*row]);
        let spans = problem.intensities.iter();
        let mut with_equation = (smoothed.compared.iter())
            .filter(|candidate| candidate.prior.unknown != Unknown::Acceleration)
            .peekable();
        fitted.without_equation = with_equation.peek().is_some()
            && with_equation.all(|candidate| candidate.noise.likelihood == f64::NEG_INFINITY);
        fitted.coded = record.codes.map(|codes| codes.step);
        fitted.free = (record.counted() - parameters).max(1.0);
        // Prediction errors of codes are not normal.
        fitted.patterned &= sigma > record.floor && record.codes.is_none();
        fitted.converged = smoothed.converged;
        fitted.cycle = prior.cycle;
        fitted.told = (smoothed.repeating.as_ref())
            .map_or(0.0, |torque| torque.told as f64 / f64::from(prior.cycle));
        fitted.summary = FitSummary {
            kind: "smoother",
            reason: "its prior is the likeliest".to_owned(),
            prior: prior.name(),
            candidates: smoothed.compared.iter().map(Candidate::summary).collect(),
            degree: 2 * (prior.order + 2) - 1,
            time_origin_s: record.origin,
            sigma,
            sigma_error: sigma / (2.0 * fitted.free).sqrt(),
            parameters,
            corner_hz: Some(smoothed.noise.corner / TAU),
            intensities: spans.map(|span| span.summary(record.origin)).collect(),
            tones: record.tones.iter().map(Tone::summary).collect(),
            noise_correlation_s: smoothed.noise.correlated.map(f64::recip),
            beside,
            outliers: outliers.len(),
            ..fitted.summary
        };
        fitted
    }

    fn of_polynomial(
        measurement: &Measurement,
        record: &Record<'_>,
        polynomial: &Polynomial,
        reason: &str,
    ) -> Fitted {
        let (fit, motion) = (&polynomial.fit, polynomial.motion.clone());
        let mut fitted = Fitted::of_motion(measurement, record, motion, None);
        let finite = |value: &f64| value.is_finite().then_some(*value);
        let parameters = fit.degree() as f64 + 1.0;
        fitted.free = (fitted.residuals.len() as f64 - parameters).max(1.0);
        // Rounding errors have patterns of their own.
        fitted.patterned &= fitted.summary.rms > record.floor;
        fitted.converged = polynomial.converged;
        fitted.summary = FitSummary {
            kind: "polynomial",
            reason: reason.to_owned(),
            degree: fit.degree(),
            time_origin_s: record.origin,
            coefficients: fit.coefficients.iter().map(finite).collect(),
            standard_errors: fit.standard_errors.iter().map(finite).collect(),
            condition: finite(&fit.condition),
            sigma: fit.sigma,
            sigma_error: fit.sigma / (2.0 * fitted.free).sqrt(),
            parameters,
            ..fitted.summary
        };
        fitted
    }

    /// Computes measured values and residuals of a motion, with the tests of the residuals or those given.
    fn of_motion(
        measurement: &Measurement,
        record: &Record<'_>,
        motion: Vec<MotionEstimate>,
        whiteness: Option<Whiteness>,
    ) -> Fitted {
        let (sensor, times) = (record.sensor, measurement.times());
        let residuals = parallel::list(motion.len(), |row| {
            let value = record.values[row];
            let (residual, shown) = sensor.residual(value, motion[row].turning());
            let tones = tone::sum(&record.tones, Carrier::Sensor, record.times[row]);
            Residual {
                t: times[row],
                measured: match sensor.measured {
                    Measured::Gamma => shown.value + residual + tones,
                    _ => value + tones,
                },
                residual,
            }
        });
        let whiteness =
            whiteness.unwrap_or_else(|| Whiteness::of(residuals.iter().map(|row| row.residual)));
        let n = residuals.len() as f64;
        let squares: f64 = residuals.iter().map(|row| row.residual.powi(2)).sum();
        let measured = residuals.iter().map(|row| row.measured);
        let mean = measured.clone().sum::<f64>() / n;
        let about: f64 = measured.map(|v| (v - mean) * (v - mean)).sum();
        let summary = FitSummary {
            r_squared: if about > 0.0 {
                1.0 - squares / about
            } else {
                1.0
            },
            rms: (squares / n).sqrt(),
            residual_lag_one: whiteness.lag_one,
            residual_runs: whiteness.runs,
            residual_ljung_box: whiteness.ljung_box,
            ..FitSummary::default()
        };
        Fitted {
            motion,
            residuals,
            summary,
            patterned: whiteness.is_violated(),
            ..Fitted::default()
        }
    }
}
