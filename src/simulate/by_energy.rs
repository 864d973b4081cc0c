//! Motion from the energy integral.

use std::f64::consts::TAU;

use super::angle_model::AngleModel;
use super::angle_motion::{LEAST_TAIL, PLACE, balance, late_by, worst_row};
use super::outcome::Estimate;
use super::result::ErrorEstimate;
use super::run_setup::RunSetup;
use super::stop::Why;
use crate::engine::angle::Driving;
use crate::engine::energy::{NotApplicable, Orbit};
use crate::engine::time::Start;
use crate::numeric::angle::Angle;
use crate::numeric::root;
use crate::scene::Extent;

/// Series end where their coefficients have decayed to this part of the tolerance,
const SHARE: f64 = 0.1;
/// and at this at the latest, for all digits but the last ones.
const MOST_TAIL: f64 = 1e-13;

/// Relative error of times by rounding of the positions and of the kinetic energy at the start,
const ROUNDING: f64 = f64::EPSILON;
/// and where the crank comes to rest, next to which the time hangs on the force: a difference, which is rounded more.
const ROUNDING_AT_REST: f64 = 4.0 * f64::EPSILON;

/// A whole run, and why it ends before its goal, if it does.
pub(super) struct Solved {
    pub driving: Driving,
    pub stopped: Option<Why>,
}

/// Solves a task.
pub(super) fn solve(
    task: &RunSetup<'_>,
    position: &AngleModel<'_>,
) -> Result<Solved, NotApplicable> {
    let speed = task.scene.motion.speed;
    let tail = (SHARE * task.scene.run.tolerance).clamp(LEAST_TAIL, MOST_TAIL);
    let (orbit, end, stopped) = until_the_end(task, |until| {
        Orbit::new(position, task.start(), speed, until, tail)
    })?;
    let work = position.work(task.start(), orbit.state(end).0);
    let driving = Driving::whole(orbit, end, work);
    Ok(Solved { driving, stopped })
}

/// Error of the last state, and of the worst row.
pub(super) fn estimate(
    task: &RunSetup<'_>,
    driving: &Driving,
    work: f64,
    wants_rows: bool,
) -> Estimate {
    let (orbit, end) = (&driving.orbit, driving.end);
    let last = orbit.state(end);
    let mut error = rounded(task, (orbit, end), last);
    error.omega_rad_per_s += left_out(task, (orbit, end), last, work);
    Estimate {
        error,
        on_the_way: wants_rows.then(|| worst_row(end, error, |t| row_error(task, orbit, t))),
        cost: None,
    }
}

/// Error of a state by that of its time, and by the rounding of its place and of energies.
fn rounded(task: &RunSetup<'_>, (orbit, t): (&Orbit, f64), state: (Angle, f64)) -> ErrorEstimate {
    let rests = task.scene.motion.speed == 0.0 || orbit.turns_back();
    let rounding = if rests { ROUNDING_AT_REST } else { ROUNDING };
    let late = orbit.time_error(t) + rounding * t;
    let place = orbit.rounding(t).map_or(PLACE, |place| place.min(PLACE));
    let mut error = late_by(task, state, t, late, place);
    error.theta_rad = error.theta_rad.hypot(orbit.misplaced(t));
    let (angle, omega) = state;
    let momentum = task.equation().terms(angle.rest).inertia.m * omega.abs();
    // Not a number at rest.
    let kinetic = 0.5 * momentum * omega.abs();
    let by_energy = (orbit.energy_error(t, kinetic) / momentum).min(omega.abs());
    error.omega_rad_per_s = error.omega_rad_per_s.hypot(by_energy);
    error
}

/// How far the speed may be off that of its angle, rad/s: what the series leave out of it there, or less if
/// the energy of the state says so.
fn left_out(
    task: &RunSetup<'_>,
    (orbit, end): (&Orbit, f64),
    last: (Angle, f64),
    work: f64,
) -> f64 {
    let (angle, omega) = last;
    let at = Start {
        t: end,
        angle,
        speed: omega,
    };
    let balance = balance(task, &at, work, orbit.largest_kinetic(end));
    let momentum = task.equation().terms(angle.rest).inertia.m * omega.abs();
    let seen = (1.5 * balance.residual.abs() + f64::EPSILON * balance.largest) / momentum;
    (orbit.speed_error(end) * omega.abs()).min(seen)
}

/// Error of a row at a time, s.
fn row_error(task: &RunSetup<'_>, orbit: &Orbit, t: f64) -> ErrorEstimate {
    let state = orbit.state(t);
    let mut error = rounded(task, (orbit, t), state);
    error.omega_rad_per_s += orbit.speed_error(t) * state.1.abs();
    error
}

/// A motion, its last time, and why it does not complete its turns, if it does not.
type Ended = (Orbit, f64, Option<Why>);

/// The motion and its last time.
fn until_the_end(
    task: &RunSetup<'_>,
    mut orbit_until: impl FnMut(f64) -> Result<Orbit, NotApplicable>,
) -> Result<Ended, NotApplicable> {
    let turns = match task.extent {
        Extent::Duration(duration) => {
            let orbit = orbit_until(duration)?;
            return Ok(match cut_short(&orbit, duration) {
                Some((end, why)) => (orbit, end, Some(why)),
                None => (orbit, duration, None),
            });
        }
        Extent::Revolutions(turns) => turns,
    };
    let radians = turns * TAU;
    let speed = task.scene.motion.speed;
    // Long enough for the turns: twice as long again and again, unless the motion repeats.
    let mut until = if speed == 0.0 {
        1.0
    } else {
        radians / speed.abs()
    };
    for _ in 0..60 {
        let orbit = orbit_until(until)?;
        let period = orbit.period().map(|period| period.0);
        let known = period.unwrap_or(until.min(orbit.length()));
        let reached = if orbit.turns_back() {
            time_of_way(task, &orbit, radians, known)
        } else {
            orbit.time_of_turn(radians)
        };
        match (reached, period) {
            (Some(end), _) => return Ok((orbit, end, None)),
            (None, Some(period)) => {
                let why = Why::Period { turns, period };
                return Ok((orbit, period, Some(why)));
            }
            (None, None) => match cut_short(&orbit, until) {
                Some((end, why)) => return Ok((orbit, end, Some(why))),
                None => until *= 2.0,
            },
        }
    }
    Err(NotApplicable::TooLong)
}

/// Where (s) the work limit ends a motion that is wanted until a time (s), and why, if it does.
fn cut_short(orbit: &Orbit, until: f64) -> Option<(f64, Why)> {
    let end = orbit.length();
    (end < until).then_some((end, Why::WorkLimit))
}

/// When a motion that turns back is first so far (rad) from its start, either way.
fn time_of_way(task: &RunSetup<'_>, orbit: &Orbit, radians: f64, until: f64) -> Option<f64> {
    let beyond = |t: f64| orbit.state(t).0.minus(task.start()).abs() - radians;
    let mut from = 0.0;
    let mut ends = orbit.turning_times(until);
    ends.push(until);
    for to in ends {
        if beyond(to) >= 0.0 {
            return root::bracketed(beyond, from, to);
        }
        from = to;
    }
    None
}
