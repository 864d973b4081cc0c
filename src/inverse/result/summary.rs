//! Summary of an inverse computation: plan, data, fit, ranges, bands and warnings.

use std::f64::consts::TAU;

use serde::Serialize;

use super::super::candidates::Candidate;
use super::super::intensity::Span;
pub use super::super::model::tone::Carrier;
use super::super::model::tone::Tone;
use super::super::row::InverseRow;
use super::bands::{BandRule, DeadCentreBand};
use super::shared_errors::BudgetShare;
use crate::numeric::median::median;
use crate::plan::Plan;
use crate::scene::Measurement;

/// Summary of an inverse computation; its JSON is the object that `inverse --json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct InverseSummary {
    /// Title of the scene.
    pub scene: String,
    /// Plan of the computation.
    pub plan: Plan,
    /// Samples that were read.
    pub data: DataSummary,
    /// Fit of the crank angle over time.
    pub fit: FitSummary,
    /// Whether the slider force acts beside the forces of the scene; if not it is the whole force on the slider.
    pub beside_forces: bool,
    /// Half-width of a 95 % band in standard errors: Student's factor for the degrees of freedom of the fit.
    pub band_factor: f64,
    /// Range of the slider force; none if no sample has one.
    pub slider_force: Option<ForceRange>,
    /// Range of the crank torque.
    pub crank_torque: ForceRange,
    /// Shares of the sources in the variance of the slider force; empty if noise is the only one.
    pub error_budget: Vec<BudgetShare>,
    /// Stretches in which the slider force is left empty.
    pub dead_centre_bands: Vec<DeadCentreBand>,
    /// Rule by which the slider force is left empty.
    pub dead_centre_rule: BandRule,
    /// Warnings for the user, in words.
    pub warnings: Vec<String>,
}

/// The samples that were read.
#[derive(Clone, Debug, Serialize)]
pub struct DataSummary {
    /// Name of the file, if the samples came from one.
    pub file: Option<String>,
    /// Name of the measured column.
    pub column: &'static str,
    /// SI unit of the column.
    pub unit: &'static str,
    /// Number of samples.
    pub rows: usize,
    /// First time, s.
    pub from_s: f64,
    /// Last time, s.
    pub to_s: f64,
    /// Turns from the first to the last sample, negative clockwise.
    pub revolutions: f64,
}

/// Kind, parameters and quality of a fit.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FitSummary {
    /// `polynomial` or `smoother`.
    pub kind: &'static str,
    /// Reason for this kind, in words.
    pub reason: String,
    /// Random term of the smoother's equation of motion; empty for a polynomial.
    pub prior: String,
    /// Priors that were compared, the likeliest first.
    pub candidates: Vec<CandidateSummary>,
    /// Degree of the polynomial; for a smoother, of the smoothing spline that it is without mechanics.
    pub degree: usize,
    /// Time at which the coefficients' time is 0, s; other than 0 where times far from zero lose digits.
    pub time_origin_s: f64,
    /// Coefficients of 1, t, t², ... (t in s, angle in rad), null where no digits are left; empty for a smoother.
    pub coefficients: Vec<Option<f64>>,
    /// Standard errors of the coefficients, for residuals that are noise.
    pub standard_errors: Vec<Option<f64>>,
    /// Coefficient of determination: 1 − Σ residual² / Σ (value − mean)² of the measured quantity.
    pub r_squared: f64,
    /// Root mean square of the residuals, rad or m.
    pub rms: f64,
    /// Condition number (Frobenius norm) of the design matrix that belongs to the coefficients; none if it overflows.
    pub condition: Option<f64>,
    /// Standard deviation of a sample, rad or m: rms corrected for the parameters, at least the rounding of the digits.
    pub sigma: f64,
    /// Standard error of that, for normal noise.
    pub sigma_error: f64,
    /// Number of parameters; for a smoother, the effective number.
    pub parameters: f64,
    /// Corner frequency of the smoother, Hz: slower variations of the acceleration are followed.
    pub corner_hz: Option<f64>,
    /// Stretches with another intensity of the process noise.
    pub intensities: Vec<IntensitySummary>,
    /// Sinusoids of fixed frequencies in time, in the values of the sensor or in the torque.
    pub tones: Vec<ToneSummary>,
    /// Correlation time of the noise of the samples, s, where it is not white.
    pub noise_correlation_s: Option<f64>,
    /// Other sensors of the motion.
    pub beside: Vec<SensorSummary>,
    /// Number of outliers: samples with little weight.
    pub outliers: usize,
    /// Lag-one autocorrelation of the residuals; for a smoother, of the prediction errors.
    pub residual_lag_one: f64,
    /// Runs of one sign among the residuals, in standard deviations from the number expected of noise.
    pub residual_runs: f64,
    /// Ljung-Box statistic of up to 20 autocorrelations, as a standard normal deviate; above 3.7 they are not white noise.
    pub residual_ljung_box: f64,
}

/// Stretch of the record with another intensity of the process noise: a force that jumps, a machine at rest.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct IntensitySummary {
    /// First time, s.
    pub from_s: f64,
    /// Last time, s.
    pub to_s: f64,
    /// Intensity over the usual intensity.
    pub factor: f64,
}

/// Sinusoid of a fixed frequency in time.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ToneSummary {
    /// What has it.
    pub carrier: Carrier,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude, rad or m of a sensor, N m of the torque.
    pub amplitude: f64,
    /// ln of the odds to a tone of the other one; none where that has no likelihood.
    pub log_odds: Option<f64>,
}

/// Sensor beside that of the record.
#[derive(Clone, Debug, Serialize)]
pub struct SensorSummary {
    /// Name of the measured quantity.
    pub column: &'static str,
    /// Standard deviation of a sample, rad or m.
    pub sigma: f64,
    /// Mean of measured minus fitted, rad or m.
    pub mean_residual: f64,
    /// Ljung-Box statistic of measured minus fitted beside that mean, as a standard normal deviate.
    pub residual_ljung_box: f64,
}

/// Prior that was compared with others.
#[derive(Clone, Debug, Serialize)]
pub struct CandidateSummary {
    /// Random term of the prior, in words.
    pub prior: String,
    /// ln of the marginal likelihood, less what the two parameters of a spectrum of harmonics cost.
    pub log_likelihood: f64,
}

/// Smallest and largest value, and median of the standard errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ForceRange {
    /// Smallest value, N or N m.
    pub min: f64,
    /// Time of the smallest value, s.
    pub min_t_s: f64,
    /// Standard error of the smallest value, N or N m.
    pub min_se: f64,
    /// Largest value, N or N m.
    pub max: f64,
    /// Time of the largest value, s.
    pub max_t_s: f64,
    /// Standard error of the largest value, N or N m.
    pub max_se: f64,
    /// Median of the standard errors, N or N m.
    pub median_se: f64,
}

impl ForceRange {
    /// Returns the range of a force or torque, with its standard error, over the rows that have it.
    pub(in crate::inverse) fn of(
        rows: &[InverseRow],
        value: impl Fn(&InverseRow) -> Option<f64>,
        error: impl Fn(&InverseRow) -> Option<f64>,
    ) -> Option<ForceRange> {
        let values = rows
            .iter()
            .filter_map(|row| Some((row.t, value(row)?, error(row)?)));
        let order = |a: &(f64, f64, f64), b: &(f64, f64, f64)| a.1.total_cmp(&b.1);
        let (min, max) = (values.clone().min_by(order)?, values.clone().max_by(order)?);
        // Zero has no sign.
        Some(ForceRange {
            min: min.1 + 0.0,
            min_t_s: min.0,
            min_se: min.2,
            max: max.1 + 0.0,
            max_t_s: max.0,
            max_se: max.2,
            median_se: median(values.map(|value| value.2))?,
        })
    }
}

impl DataSummary {
    pub(in crate::inverse) fn new(measurement: &Measurement, rows: &[InverseRow]) -> DataSummary {
        let (first, last) = (&rows[0], &rows[rows.len() - 1]);
        DataSummary {
            file: measurement.file(),
            column: measurement.measured().name(),
            unit: measurement.measured().unit(),
            rows: rows.len(),
            from_s: first.t,
            to_s: last.t,
            revolutions: (last.theta - first.theta) / TAU,
        }
    }
}

impl Candidate {
    /// Returns its name and likelihood.
    pub fn summary(&self) -> CandidateSummary {
        CandidateSummary {
            prior: self.prior.name(),
            log_likelihood: self.noise.likelihood,
        }
    }
}

impl Span {
    /// Returns it in the time of the scene, which is `origin`, s, where the record begins.
    pub fn summary(&self, origin: f64) -> IntensitySummary {
        IntensitySummary {
            from_s: origin + self.from,
            to_s: origin + self.to,
            factor: self.factor,
        }
    }
}

impl Tone {
    /// Returns its frequency and amplitude with the odds.
    pub fn summary(&self) -> ToneSummary {
        ToneSummary {
            carrier: self.carrier,
            frequency_hz: self.frequency / TAU,
            amplitude: self.amplitude(),
            log_odds: self.log_odds,
        }
    }
}
