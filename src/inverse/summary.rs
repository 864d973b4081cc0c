//! The result of an inverse computation in numbers.

use serde::Serialize;

use super::bands::{BandRule, DeadCentreBand};
use super::fitted::Fitted;
use super::row::InverseRow;
use super::rows::Rows;
use super::shared_errors::BudgetShare;
use crate::numeric::median::median;
use crate::numeric::parallel;
use crate::plan::Plan;
use crate::scene::{Measurement, Scene};

/// Summary of an inverse computation; its JSON is the object that `inverse --json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct InverseSummary {
    /// Title of the scene.
    pub scene: String,
    /// What was computed, and how.
    pub plan: Plan,
    /// The samples.
    pub data: DataSummary,
    /// The fit of the crank angle over time.
    pub fit: FitSummary,
    /// Whether the slider force acts beside the forces of the scene; if not it is the whole force on the slider.
    pub beside_forces: bool,
    /// Half of a 95 % band in standard errors: Student's factor for the degrees of freedom of the fit.
    pub band_factor: f64,
    /// Range of the slider force; none if no sample has one.
    pub slider_force: Option<ForceRange>,
    /// Range of the crank torque.
    pub crank_torque: ForceRange,
    /// Shares of uncertain values in the error of the slider force; empty where there is but noise.
    pub error_budget: Vec<BudgetShare>,
    /// Stretches in which the slider force is left empty.
    pub dead_centre_bands: Vec<DeadCentreBand>,
    /// The rule by which it is.
    pub dead_centre_rule: BandRule,
    /// What the reader should know.
    pub warnings: Vec<String>,
}

/// The samples that were read.
#[derive(Clone, Debug, Serialize)]
pub struct DataSummary {
    /// Name of the file, if they came from one.
    pub file: Option<String>,
    /// The measured column.
    pub column: &'static str,
    /// SI unit.
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

/// What was fitted, and how well.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FitSummary {
    /// `polynomial` or `smoother`.
    pub kind: &'static str,
    /// Why this kind was taken, in words.
    pub reason: String,
    /// What varies at random in the smoother's equation of motion; empty of a polynomial.
    pub prior: &'static str,
    /// Priors that were compared, the likeliest first.
    pub candidates: Vec<CandidateSummary>,
    /// Degree of the polynomial; of a smoother, that of the spline it is without mechanics.
    pub degree: usize,
    /// The time from which the coefficients count theirs, s; other than 0 where times so far from zero lose digits.
    pub time_origin_s: f64,
    /// Of the powers 1, t, t², ... (t in s, angle in rad); empty of a smoother. Null where plain time leaves no digits.
    pub coefficients: Vec<Option<f64>>,
    /// Their standard errors, for residuals that are noise.
    pub standard_errors: Vec<Option<f64>>,
    /// 1 − squares of the residuals over squares about the mean, of what was measured.
    pub r_squared: f64,
    /// Root mean square of the residuals, rad or m.
    pub rms: f64,
    /// Condition number (Frobenius norm) of the design matrix that belongs to the coefficients; none if it overflows.
    pub condition: Option<f64>,
    /// Standard deviation of a sample, rad or m: rms corrected for the parameters, at least what the digits allow.
    pub sigma: f64,
    /// Number of parameters, of a smoother what they are worth.
    pub parameters: f64,
    /// Corner frequency of the smoother, Hz: slower variations of the acceleration are followed.
    pub corner_hz: Option<f64>,
    /// Stretches in which the noise of the smoother's process has another intensity.
    pub intensities: Vec<IntensitySummary>,
    /// Correlation time of the noise of the samples, s, where it is not white.
    pub noise_correlation_s: Option<f64>,
    /// Other sensors of the motion.
    pub beside: Vec<SensorSummary>,
    /// Samples that hardly count because they are far off.
    pub outliers: usize,
    /// Correlation of each residual with the next; of a smoother, of each prediction error.
    pub residual_lag_one: f64,
    /// Runs of one sign among them, in standard deviations from what noise has.
    pub residual_runs: f64,
}

/// A stretch of the record in which the noise of the process has another intensity: a force that jumps, a machine at rest.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct IntensitySummary {
    /// First time, s.
    pub from_s: f64,
    /// Last time, s.
    pub to_s: f64,
    /// Intensity over the usual one.
    pub factor: f64,
}

/// A sensor beside that of the record.
#[derive(Clone, Debug, Serialize)]
pub struct SensorSummary {
    /// What it measures.
    pub column: &'static str,
    /// Standard deviation of a sample, rad or m.
    pub sigma: f64,
    /// Mean of measured minus fitted, rad or m.
    pub mean_residual: f64,
}

/// A prior that was compared with others.
#[derive(Clone, Debug, Serialize)]
pub struct CandidateSummary {
    /// What varies at random.
    pub prior: &'static str,
    /// ln of its marginal likelihood.
    pub log_likelihood: f64,
}

/// Smallest and largest value, and the median of the standard errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ForceRange {
    /// N or N m
    pub min: f64,
    /// When, s
    pub min_t_s: f64,
    /// Standard error, N or N m
    pub min_se: f64,
    /// N or N m
    pub max: f64,
    /// When, s
    pub max_t_s: f64,
    /// Standard error, N or N m
    pub max_se: f64,
    /// Median of the standard errors, N or N m
    pub median_se: f64,
}

/// Time, s, with a force or torque and its standard error, N or N m.
type Estimate = (f64, f64, f64);

impl ForceRange {
    fn of(mut values: impl Iterator<Item = Estimate>) -> Option<ForceRange> {
        let first = values.next()?;
        let (mut min, mut max, mut errors) = (first, first, vec![first.2]);
        for value in values {
            if value.1.total_cmp(&min.1).is_lt() {
                min = value;
            }
            if value.1.total_cmp(&max.1).is_ge() {
                max = value;
            }
            errors.push(value.2);
        }
        // Zero has no sign.
        Some(ForceRange {
            min: min.1 + 0.0,
            min_t_s: min.0,
            min_se: min.2,
            max: max.1 + 0.0,
            max_t_s: max.0,
            max_se: max.2,
            median_se: median(errors)?,
        })
    }
}

impl InverseSummary {
    pub(super) fn new(
        scene: &Scene,
        plan: Plan,
        measurement: &Measurement,
        fitted: &Fitted,
        found: &Rows,
        (beside_forces, band_factor): (bool, f64),
        warnings: Vec<String>,
    ) -> InverseSummary {
        let of: [fn(&InverseRow) -> Option<Estimate>; 2] = [
            |row| Some((row.t, row.slider_force?, row.slider_force_se?)),
            |row| Some((row.t, row.crank_torque?, row.crank_torque_se?)),
        ];
        let range = |of| ForceRange::of(found.rows.iter().filter_map(of));
        let ranges = parallel::map(of.into_iter(), range);
        let nothing = ForceRange {
            min: 0.0,
            min_t_s: 0.0,
            min_se: 0.0,
            max: 0.0,
            max_t_s: 0.0,
            max_se: 0.0,
            median_se: 0.0,
        };
        InverseSummary {
            scene: scene.title.clone().unwrap_or_default(),
            plan,
            data: DataSummary::new(measurement, &found.rows),
            fit: fitted.summary.clone(),
            beside_forces,
            band_factor,
            slider_force: ranges[0],
            crank_torque: ranges[1].unwrap_or(nothing),
            error_budget: Vec::new(),
            dead_centre_bands: found.bands.clone(),
            dead_centre_rule: found.rule,
            warnings,
        }
    }
}

impl DataSummary {
    fn new(measurement: &Measurement, rows: &[InverseRow]) -> DataSummary {
        let (first, last) = (&rows[0], &rows[rows.len() - 1]);
        DataSummary {
            file: measurement.file(),
            column: measurement.measured().name(),
            unit: measurement.measured().unit(),
            rows: rows.len(),
            from_s: first.t,
            to_s: last.t,
            revolutions: (last.theta - first.theta) / std::f64::consts::TAU,
        }
    }
}
