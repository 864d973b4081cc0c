//! Global error of a free motion: distance from a second, much finer run, plus the propagated roundoff of both.
//!
//! Roundoff: each step rounds θ and θ̇ to half a unit in the last place, independently of the others, and a rounded
//! angle changes the acceleration. The linearised motion carries these errors to the end, as they grow with it near a
//! balance; independent errors add up by their squares.

use std::f64::consts::{PI, TAU};
use std::time::Instant;

use super::super::recorder::Record;
use super::super::result::{Cost, ErrorEstimate};
use super::super::roundoff_propagation::RoundoffPropagation;
use super::super::run_end::Estimate;
use super::super::run_setup::RunSetup;
use super::super::second_run::{Comparison, MARGIN, collocation_tolerance, same_method_tolerance};
use super::super::stop::Why;
use super::super::warning::Warning;
use super::engine_loop::{PassResult, PassSettings};
use super::errors_over_angle::{
    TURN_ROUNDING, by_energy, error_at_angle, error_of_delay, row_error, worst_row_error,
};
use super::over_angle::second_run_resolution;
use super::second_run_observer::SecondRunObserver;
use crate::engine::step::Step;
use crate::engine::time::{MotionState, Settings};
use crate::engine::{Counted, WorkLimit};
use crate::numeric::covariance_factor::CovarianceFactor;
use crate::plan::Engine;
use crate::scene::Extent;

/// Stated roundoff, in standard deviations: exceeded by 5 % of normally distributed errors.
pub(super) const STATED_DEVIATIONS: f64 = 2.0;

/// Estimates the global error of a run: from the energy engine, or by a second run, by collocation or, where that does
/// not arrive, by the method of the run.
///
/// # Errors
/// [`Warning::NotEstimated`] where no second run reaches the end; [`Warning::Undetermined`] where the error reaches half a
/// turn: the linearised motion says nothing of larger ones.
pub(super) fn estimate(
    pass: &PassSettings<'_>,
    result: &PassResult,
    record: &Record,
    wants_rows: bool,
) -> Result<Estimate, Warning> {
    let piece = result.angle_piece.as_ref();
    if let Some(piece) = piece.filter(|piece| piece.engine == Engine::Energy) {
        return Ok(by_energy(pass.task, &piece.run, result, wants_rows));
    }
    let begun = Instant::now();
    let guide = piece.map(|piece| &piece.run);
    let first_engine = match result.pieces_over_angle {
        0 => Engine::Time,
        _ => Engine::Angle,
    };
    let mut evaluations = 0;
    let second = |time_settings: Settings<'_>| {
        let finer = PassSettings {
            first_engine,
            extent: Extent::Duration(result.state.t),
            resolution: second_run_resolution(pass.resolution, guide),
            time_settings,
            // Another part of a turn than in the first run.
            resume_rotation: 1.4 * TAU,
            ..pass.clone()
        };
        let motion = Counted::new(pass.task.equation());
        let MotionState { t, angle, speed } = pass.task.first_state();
        let force = || motion.acceleration(t, angle, speed);
        let moves = speed != 0.0 || motion.depends_on_time() || force() != 0.0;
        let mut observer = SecondRunObserver {
            equation: pass.task.equation(),
            motion: &motion,
            moves,
            rounding: RoundoffPropagation::new(time_settings.method),
            comparison: Comparison::with(&record.checkpoints),
        };
        let mut best = finer.run(&motion, &mut observer).ok()?;
        evaluations += best.evaluations + observer.rounding.evaluations;
        let ends = [&result.stopped, &best.stopped];
        match ends.map(|why| why.as_ref().is_some_and(Why::is_at_a_place)) {
            // The runs end at one angle, not at one time.
            [true, true] => best.state = extrapolated(&best, result.state.t, &motion)?,
            _ if best.stopped.is_some() => return None,
            _ => {}
        }
        Some((best, observer.rounding.covariance, observer.comparison))
    };
    let mut settings = second_settings(pass, result, record).into_iter();
    let found = settings.find_map(second).ok_or(Warning::NotEstimated);
    let (best, covariance, comparison) = found?;
    let cost = Cost {
        evaluations,
        wall_s: begun.elapsed().as_secs_f64(),
    };
    let mut error = distance(pass.task, result, &best, covariance);
    if matches!(pass.extent, Extent::Revolutions(_)) {
        error = error.max(error_at_angle(pass.task, [result, &best], error));
    }
    if error.theta_rad > PI {
        return Err(Warning::Undetermined);
    }
    let rows = match (&result.angle_piece, &best.angle_piece) {
        _ if !result.is_one_piece() => None,
        (Some(one), Some(other)) => wants_rows.then(|| {
            let orbits = [one, other].map(|piece| &piece.run.orbit);
            worst_row_error(one.run.end, error, |t| row_error(orbits, t, error))
        }),
        (Some(_), None) => None,
        (None, _) => Some(comparison.worst(error)),
    };
    Ok(Estimate {
        error,
        rows_error: rows,
        cost: Some(cost),
    })
}

/// Extrapolates a motion by its last acceleration to a time (s) shortly after its end, if the acceleration is finite.
fn extrapolated(ended: &PassResult, t: f64, motion: &Counted<'_>) -> Option<MotionState> {
    let from = &ended.state;
    let alpha = match (&ended.last_step, &ended.curve) {
        (Some(step), Some(curve)) => {
            let place = curve.equation.curve().pose(step.end.theta);
            place.dtheta * step.end.alpha + place.d2theta * step.end.omega.powi(2)
        }
        _ => motion.acceleration(from.t, from.angle, from.speed),
    };
    let gap = t - from.t;
    alpha.is_finite().then(|| MotionState {
        t,
        angle: from.angle.plus(gap * (from.speed + 0.5 * alpha * gap)),
        speed: from.speed + alpha * gap,
    })
}

/// Returns the settings of the second run, by collocation and by the method of the run.
fn second_settings<'a>(
    pass: &PassSettings<'a>,
    result: &PassResult,
    record: &'a Record,
) -> [Settings<'a>; 2] {
    let limit = pass.time_settings.limit;
    // Evaluations for one of the first run, and in addition those of the first steps, or of tables over the angle.
    let per_evaluation = 20;
    let in_addition = match result.pieces_over_angle {
        0 => 20_000,
        _ => 200_000,
    };
    let share = result
        .evaluations
        .saturating_mul(per_evaluation)
        .saturating_add(in_addition);
    let again = Settings {
        t_end: result.state.t,
        limit: WorkLimit {
            evaluations: share.min(limit.evaluations),
            ..limit
        },
        tolerance: same_method_tolerance(pass.time_settings.tolerance),
        ..pass.time_settings
    };
    let collocation = Settings {
        method: None,
        tolerance: collocation_tolerance(pass.time_settings.tolerance),
        guide: &record.checkpoints.first,
        ..again
    };
    [collocation, again]
}

/// Returns the distance of two runs at the end, plus the roundoff.
fn distance(
    task: &RunSetup<'_>,
    result: &PassResult,
    best: &PassResult,
    covariance: CovarianceFactor,
) -> ErrorEstimate {
    let MotionState { t, angle, speed } = result.state;
    let [angle_noise, speed_noise] =
        of_crank(result, covariance).map(|noise| STATED_DEVIATIONS * f64::EPSILON * noise);
    // Of the angle engine, relative to the time.
    let time_rounding = 2.5 * f64::EPSILON;
    let floor = match result.pieces_over_angle {
        0 => ErrorEstimate {
            theta_rad: f64::EPSILON * angle.radians().abs(),
            omega_rad_per_s: f64::EPSILON * speed.abs(),
        },
        _ => error_of_delay(task, result.state, time_rounding * t, TURN_ROUNDING),
    };
    ErrorEstimate {
        theta_rad: MARGIN * angle.minus(best.state.angle).abs() + floor.theta_rad + angle_noise,
        omega_rad_per_s: MARGIN * (speed - best.state.speed).abs()
            + floor.omega_rad_per_s
            + speed_noise,
    }
}

/// Converts the covariance of a coordinate at the end to that of crank angle and crank speed.
fn of_crank(result: &PassResult, covariance: CovarianceFactor) -> [f64; 2] {
    let [angle, speed] = covariance.deviations();
    let (Some(Step { end, .. }), Some(curve)) = (result.last_step, &result.curve) else {
        return [angle, speed];
    };
    let place = curve.equation.curve().pose(end.theta);
    let bend = Some((place.d2theta * end.omega).abs()).filter(|bend| bend.is_finite());
    let dtheta = place.dtheta.abs();
    [dtheta * angle, dtheta * speed + bend.unwrap_or(0.0) * angle]
}
