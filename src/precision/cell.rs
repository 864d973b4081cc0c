//! One cell of a work-precision diagram: runs a method at a tolerance, times it, and measures its error.

use std::hint::black_box;
use std::time::Instant;

use super::{PrecisionOptions, PrecisionRow, Reference, first_line};
use crate::error::Error;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::median::median;
use crate::plan::{Engine, Method, Stepper};
use crate::scene::Scene;
use crate::simulate::{NoRows, Options, Summary, simulate_rows};

pub(super) fn run(
    scene: &Scene,
    method: Method,
    estimate: bool,
    options: &PrecisionOptions,
) -> Result<Summary, Error> {
    let options = Options {
        method,
        estimate,
        max_evaluations: options.max_evaluations,
        events_kept: 0,
        ..Options::default()
    };
    Ok(simulate_rows(scene, &options, &mut NoRows)?.summary)
}

/// Runs all methods at tolerance 1e-13; returns identity and final state of each, by ascending estimated angle error.
pub(super) fn tight_runs(
    scene: &Scene,
    options: &PrecisionOptions,
) -> Vec<(Option<Identity>, Reference)> {
    let mut scene = scene.clone();
    let tightest = 1e-13;
    scene.run.tolerance = tightest;
    let methods = Method::ALL
        .into_iter()
        .filter(|method| *method != Method::Auto);
    let runs = methods.filter_map(|method| {
        let run = run(&scene, method, true, options).ok()?;
        let error = run.error_estimate.filter(|_| run.stopped.is_none())?;
        let reference = Reference {
            what: format!("{method} at tolerance {tightest:e}"),
            theta: DoubleDouble::from(run.last.theta_rad),
            omega: DoubleDouble::from(run.last.omega_rad_per_s),
            theta_error: error.theta_rad,
            omega_error: error.omega_rad_per_s,
            ends_at: None,
        };
        Some((Some((run.plan.engine, run.plan.stepper)), reference))
    });
    let mut runs: Vec<_> = runs.collect();
    runs.sort_by(|(_, a), (_, b)| a.theta_error.total_cmp(&b.theta_error));
    runs
}

/// Returns the state at `t_end` (s) of a motion at constant speed.
pub(super) fn closed_form(scene: &Scene, t_end: f64) -> Reference {
    let omega = DoubleDouble::from(scene.motion.speed);
    let theta = omega * t_end + scene.motion.angle;
    Reference {
        what: "angle + speed t in double-double arithmetic".to_owned(),
        theta,
        omega,
        theta_error: DoubleDouble::ROUNDING * theta.value().abs(),
        omega_error: 0.0,
        ends_at: None,
    }
}

/// Engine and stepper of a motion: two method names with equal ones are no independent check of each other.
pub(super) type Identity = (Engine, Option<Stepper>);

/// Run of one method at one tolerance, with its wall times, s.
pub(super) struct MethodRun {
    scene: Scene,
    method: Method,
    result: Result<Summary, String>,
    wall_times_s: Vec<f64>,
}

impl MethodRun {
    pub(super) fn new(
        scene: &Scene,
        method: Method,
        tolerance: f64,
        options: &PrecisionOptions,
    ) -> Result<MethodRun, Error> {
        let mut scene = scene.clone();
        scene.run.tolerance = tolerance;
        scene.check()?;
        let result = run(&scene, method, true, options).map_err(|refused| first_line(&refused));
        Ok(MethodRun {
            scene,
            method,
            result,
            wall_times_s: Vec::new(),
        })
    }

    /// Returns the row, measured against the first reference of another identity.
    pub(super) fn row(&self, references: &[(Option<Identity>, Reference)]) -> PrecisionRow {
        let mut row = PrecisionRow {
            method: self.method.to_string(),
            tolerance: self.scene.run.tolerance,
            runs: self.wall_times_s.len(),
            ..PrecisionRow::default()
        };
        let summary = match &self.result {
            Ok(summary) => summary,
            Err(why) => {
                row.failure = Some(why.clone());
                return row;
            }
        };
        let own = Some((summary.plan.engine, summary.plan.stepper));
        let found = references.iter().position(|(identity, _)| *identity != own);
        let reference = found.map(|index| &references[index].1);
        row.failure = ends_elsewhere(summary, reference);
        if row.failure.is_some() {
            return row;
        }
        row.failure = summary.stopped.as_ref().map(ToString::to_string);
        let estimate = summary.error_estimate;
        row.estimate_theta_rad = estimate.map(|error| error.theta_rad);
        row.estimate_omega_rad_per_s = estimate.map(|error| error.omega_rad_per_s);
        let wall_times_s = || self.wall_times_s.iter().copied();
        row.wall_s = wall_times_s().reduce(f64::min);
        row.wall_median_s = median(wall_times_s());
        row.evaluations = Some(summary.evaluations);
        row.steps = Some(summary.steps);
        let Some(reference) = reference else {
            row.measured_against = Some("nothing: no other method reaches the end".to_owned());
            return row;
        };
        if found != Some(0) {
            let (what, error) = (&reference.what, reference.theta_error);
            row.measured_against = Some(format!("{what}, its error {error:.1e} rad or less"));
        }
        let last = &summary.last;
        let (theta, theta_bound) = error(last.theta_rad, reference.theta, reference.theta_error);
        let (omega, omega_bound) =
            error(last.omega_rad_per_s, reference.omega, reference.omega_error);
        row.error_theta_rad = Some(theta);
        row.error_omega_rad_per_s = Some(omega);
        row.error_is_bound = theta_bound || omega_bound;
        row
    }
}

/// Returns the reason why a run does not end where the reference does; none if both end together.
fn ends_elsewhere(summary: &Summary, reference: Option<&Reference>) -> Option<String> {
    // Relative difference of end times below which two runs end at one place.
    let same_end = 1e-3;
    match (&summary.stopped, reference.and_then(|found| found.ends_at)) {
        (None, None) => None,
        (None, Some(t)) => Some(format!(
            "goes on beyond t = {t} s, where the equations of the reference end"
        )),
        (Some(_), Some(t)) if (summary.last.t_s - t).abs() <= same_end * t => None,
        (Some(why), _) => Some(why.to_string()),
    }
}

/// Returns the distance from a reference, or an upper bound of the error (true) that adds `reference_error`.
fn error(value: f64, reference: DoubleDouble, reference_error: f64) -> (f64, bool) {
    let distance = (reference - value).value().abs();
    // A reference error of at most 1 % of the distance is neglected.
    if 100.0 * reference_error > distance {
        (distance + reference_error, true)
    } else {
        (distance, false)
    }
}

/// Times all cells that reached their end in rounds, alternately forwards and backwards, to spread disturbances of the
/// machine over all. If the equations end before the run (`ends`), it is enough that a cell ran at all.
pub(super) fn time(cells: &mut [MethodRun], ends: bool, options: &PrecisionOptions) {
    let begun = Instant::now();
    for round in 0..options.repeats.max(1) {
        if round > 0 && begun.elapsed().as_secs_f64() > options.most_s {
            break;
        }
        let is_served = |cell: &&mut MethodRun| {
            let run = cell.result.as_ref();
            run.is_ok_and(|run| ends || run.stopped.is_none())
        };
        let mut served: Vec<_> = cells.iter_mut().filter(is_served).collect();
        if round % 2 == 1 {
            served.reverse();
        }
        for cell in served {
            if let Ok(summary) = run(&cell.scene, cell.method, false, options) {
                cell.wall_times_s.push(black_box(summary).wall_s);
            }
        }
    }
}
