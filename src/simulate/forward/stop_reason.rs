//! Reasons for a free motion that ends before its goal, cannot begin, or is not applicable to an engine.

use super::super::configuration_curve::{CurveProblem, EndReason, TimePiece};
use super::super::run_setup::RunSetup;
use super::super::stalled::torques;
use super::super::stop::Why;
use super::engine_loop::PassSettings;
use crate::engine::energy::NotApplicable;
use crate::engine::time::{Finish, MotionState, UNLIMITED_TIME};
use crate::error::Error;
use crate::mechanism::{CurveEquation, Singularity};
use crate::scene::Extent;

/// Returns the reason for an end before the goal of a piece in time that ends at a state of the crank, if any.
pub(super) fn reason(
    pass: &PassSettings<'_>,
    piece: &TimePiece,
    at: MotionState,
    curve: Option<&CurveProblem>,
) -> Option<Why> {
    let task = pass.task;
    let finish = match (&piece.end, pass.extent) {
        (EndReason::Done, Extent::Revolutions(turns)) if at.t >= UNLIMITED_TIME => {
            return Some(Why::TurnsNeverComplete(turns));
        }
        (EndReason::AtRest, Extent::Revolutions(turns)) => {
            let theta = at.angle.radians();
            let held_by = task.turns_fully().then(|| torques(task, theta));
            return Some(Why::AtRest { turns, held_by });
        }
        (EndReason::Named(why), _) => return Some((**why).clone()),
        (EndReason::Integrator(finish), _) => *finish,
        _ => return None,
    };
    Some(match finish {
        Finish::WorkLimit => task.limited(),
        Finish::WorkLimitAhead => Why::WorkLimitAhead,
        Finish::TooManyTurns => Why::TooManyTurns,
        Finish::NoValue => no_value(task, piece.singular_state.unwrap_or(at)),
        _ => match curve {
            Some(curve) => singular_on_curve(task, &curve.equation, piece),
            None => singular(task, piece.singular_state.unwrap_or(at), at),
        },
    })
}

/// Returns the reason for steps in the crank angle that became too small, with the last evaluation and the last state.
fn singular(task: &RunSetup<'_>, at: MotionState, last: MotionState) -> Why {
    match task.equation().singularity(at.t, at.angle, at.speed) {
        Some(Singularity::Blocked) => Why::AtLimit,
        Some(Singularity::Load) => no_value(task, at),
        Some(Singularity::NoInertia) => Why::NoInertia,
        Some(Singularity::TooLarge) => Why::TooLarge,
        None if task.inertia_is_below(1e-9, last.angle.rest) => Why::NearlyNoInertia,
        None => Why::Singular,
    }
}

/// Returns the reason for steps along the configuration curve that became too small.
fn singular_on_curve(task: &RunSetup<'_>, curve: &CurveEquation, piece: &TimePiece) -> Why {
    let singular_state = piece.singular_state.filter(|at| {
        !task
            .equation()
            .load(at.t, at.angle.radians(), at.speed)
            .is_finite()
    });
    match singular_state {
        Some(at) => no_value(task, at),
        None if curve.vanishes_at(piece.last.end.theta) => Why::NoInertiaOnCurve,
        None => Why::Singular,
    }
}

/// Returns the end at a load without a finite value, with the load.
fn no_value(task: &RunSetup<'_>, asked: MotionState) -> Why {
    Why::NoValue {
        asked,
        load: task.maker.without_value(asked),
    }
}

/// Returns the error of a run without a finite acceleration at its start.
pub(super) fn no_start(task: &RunSetup<'_>) -> Error {
    let MotionState { angle, speed, .. } = task.first_state();
    Error::refused(
        format!(
            "no motion begins at the start, theta = {} rad, omega = {speed} rad/s: the equation has no finite acceleration next to it",
            angle.radians()
        ),
        "start at another angle, or check the loads there",
    )
}

/// Returns the reason why an engine over the angle is not applicable, as a clause of a message.
pub(super) fn not_applicable(task: &RunSetup<'_>, why: NotApplicable) -> String {
    match why {
        NotApplicable::NotFinite if !task.turns_fully() => {
            "the mechanism reaches the limit of its motion".to_owned()
        }
        _ => why.to_string(),
    }
}

/// Returns the error of a method that is asked for and cannot begin.
pub(super) fn refusal(task: &RunSetup<'_>, why: NotApplicable) -> Error {
    Error::refused(
        format!(
            "method {} cannot serve this scene: {}",
            task.options.method,
            not_applicable(task, why)
        ),
        "use --method auto or time",
    )
}
