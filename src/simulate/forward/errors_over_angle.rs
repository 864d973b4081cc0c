//! Errors of motions over the crank angle or up to an angle, from roundoff of times and positions and from truncation of the series.

use super::super::energy_balance::EnergyBalance;
use super::super::result::ErrorEstimate;
use super::super::run_end::Estimate;
use super::super::run_setup::RunSetup;
use super::super::second_run::MARGIN;
use super::engine_loop::PassResult;
use crate::engine::angle::AngleRun;
use crate::engine::energy::Orbit;
use crate::engine::time::MotionState;

/// Returns the error of the worst row of a run until a time (s), from samples over the run.
pub(super) fn worst_row_error(
    end: f64,
    last: ErrorEstimate,
    error: impl Fn(f64) -> ErrorEstimate,
) -> ErrorEstimate {
    // Multiples of the golden section lie everywhere in panels, however these divide the run.
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let samples = 64;
    let times = (1..=samples).map(|i| (f64::from(i) * golden).fract() * end);
    times.fold(last, |worst, t| worst.max(error(t)))
}

/// Largest roundoff of an angle within its turn, rad.
pub(super) const TURN_ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Returns the error of a state whose time is off by `late` (s), which moves the state along the motion. The angle
/// within its turn is exact to `place` (rad), and rounded once more with its turns. The speed comes from series of 33
/// terms, whose sum is rounded by half of √33 units. These errors are independent.
pub(super) fn error_of_delay(
    task: &RunSetup<'_>,
    at: MotionState,
    late: f64,
    place: f64,
) -> ErrorEstimate {
    let MotionState { t, angle, speed } = at;
    let (alpha, _) = task.maker.forward(t, angle, speed);
    let rounding = place + 0.5 * f64::EPSILON * angle.radians().abs();
    ErrorEstimate {
        theta_rad: (speed * late).hypot(rounding),
        omega_rad_per_s: (alpha * late).hypot(3.0 * f64::EPSILON * speed),
    }
}

/// Returns the error of the last state and of the worst row of the energy engine.
pub(super) fn by_energy(
    task: &RunSetup<'_>,
    run: &AngleRun,
    result: &PassResult,
    wants_rows: bool,
) -> Estimate {
    let (orbit, end) = (&run.orbit, run.end);
    let mut error = rounding_error(task, orbit, result.state);
    error.omega_rad_per_s += truncation_error(task, orbit, result.state, result.work);
    Estimate {
        error,
        rows_error: wants_rows
            .then(|| worst_row_error(end, error, |t| row_error_by_energy(task, orbit, t))),
        cost: None,
    }
}

/// Returns the error of a state from that of its time and from the roundoff of position and energies.
fn rounding_error(task: &RunSetup<'_>, orbit: &Orbit, at: MotionState) -> ErrorEstimate {
    let MotionState { t, angle, speed } = at;
    let rests = task.speed == 0.0 || orbit.turns_back();
    // Positions and the kinetic energy at the start are rounded. Where the crank comes to rest the time depends on the
    // force, a difference with more roundoff.
    let roundings = if rests { 4.0 } else { 1.0 };
    let late = orbit.time_error(t) + roundings * f64::EPSILON * t;
    let place = orbit
        .rounding(t)
        .map_or(TURN_ROUNDING, |place| place.min(TURN_ROUNDING));
    let mut error = error_of_delay(task, at, late, place);
    error.theta_rad = error.theta_rad.hypot(orbit.turning_point_error(t));
    let momentum = task.equation().terms(angle.rest).m * speed.abs();
    // At rest: not a number.
    let kinetic = 0.5 * momentum * speed.abs();
    let by_energy = (orbit.energy_error(t, kinetic) / momentum).min(speed.abs());
    error.omega_rad_per_s = error.omega_rad_per_s.hypot(by_energy);
    error
}

/// Returns the error of the speed at its angle, rad/s: truncation of the series, or less if the energy shows it.
fn truncation_error(task: &RunSetup<'_>, orbit: &Orbit, at: MotionState, work: f64) -> f64 {
    let balance = EnergyBalance::of_crank(task, &at, work, orbit.largest_kinetic(at.t));
    let momentum = task.equation().terms(at.angle.rest).m * at.speed.abs();
    let seen = (MARGIN * balance.residual.abs() + f64::EPSILON * balance.largest) / momentum;
    (orbit.speed_error(at.t) * at.speed.abs()).min(seen)
}

/// Returns the error of a row at a time, s.
fn row_error_by_energy(task: &RunSetup<'_>, orbit: &Orbit, t: f64) -> ErrorEstimate {
    let (angle, speed) = orbit.state(t);
    let mut error = rounding_error(task, orbit, MotionState { t, angle, speed });
    error.omega_rad_per_s += orbit.speed_error(t) * speed.abs();
    error
}

/// Returns the error of a row at a time (s) from the distance of two motions, plus the error of the last row.
pub(super) fn row_error(orbits: [&Orbit; 2], t: f64, last: ErrorEstimate) -> ErrorEstimate {
    let [(angle, speed), (other, faster)] = orbits.map(|orbit| orbit.state(t));
    ErrorEstimate {
        theta_rad: MARGIN * angle.minus(other).abs() + last.theta_rad,
        omega_rad_per_s: MARGIN * (speed - faster).abs() + last.omega_rad_per_s,
    }
}

/// Returns the error of a run that ends at an angle: a lead of the angle is one of the time, which changes the speed.
pub(super) fn error_at_angle(
    task: &RunSetup<'_>,
    [result, best]: [&PassResult; 2],
    error: ErrorEstimate,
) -> ErrorEstimate {
    let MotionState { t, angle, speed } = result.state;
    let slope = task.maker.forward(t, angle, speed).0 / speed;
    let lead = angle.minus(best.state.angle);
    let late = (speed - best.state.speed - slope * lead).abs();
    // What the distance of the two runs does not show.
    let omega = MARGIN * late + (slope * (error.theta_rad - MARGIN * lead.abs())).abs();
    ErrorEstimate {
        theta_rad: error.theta_rad,
        omega_rad_per_s: if omega.is_finite() { omega } else { 0.0 },
    }
}
