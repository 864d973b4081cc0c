//! Why a run on the curve ends before its time, and what the reader should know.

use super::super::run_setup::RunSetup;
use super::super::stalled;
use super::super::stop::Why;
use super::super::stop_reason;
use super::super::warning::Warning;
use super::arrived::{Arrived, End, crank_state};
use crate::engine::time::{FAR, Start};
use crate::mechanism::{Class, CurveEquation};
use crate::numeric::angle::Angle;
use crate::scene::Extent;

/// Crank lengths from a change point within which the last digits of the lengths decide.
const NEAR: f64 = 1e-6;

/// Why a run ended before its time.
pub(in crate::simulate) fn why(
    task: &RunSetup<'_>,
    arrived: &Arrived,
    equation: &CurveEquation,
) -> Option<Why> {
    Some(match (&arrived.end, task.extent) {
        (End::Done, Extent::Revolutions(turns)) if arrived.last.end.t >= FAR => Why::Turns(turns),
        (End::AtRest, Extent::Revolutions(turns)) => {
            let (angle, _) = crank_state(equation.curve(), &arrived.last);
            let held_by = task.turns_fully();
            Why::AtRest {
                turns,
                held_by: held_by.then(|| stalled::torques(task, angle.radians())),
            }
        }
        (End::Done | End::AtRest | End::Stopped, _) => return None,
        (
            &End::Jam {
                solutions,
                mu,
                kappa,
            },
            _,
        ) => Why::Jam {
            solutions,
            mu,
            kappa,
        },
        (End::Integrator(finish), _) => {
            stop_reason::limit(*finish).unwrap_or_else(|| singular(task, arrived, equation))
        }
    })
}

/// Why the steps became too small.
fn singular(task: &RunSetup<'_>, arrived: &Arrived, equation: &CurveEquation) -> Why {
    if let Some((t, theta, speed)) = arrived.impossible
        && !task.equation().load(t, theta, speed).is_finite()
    {
        let angle = Angle::from(theta);
        return stop_reason::no_value(task.equation(), Start { t, angle, speed });
    }
    if arrived.vanished || equation.vanishes_at(arrived.last.end.theta) {
        return Why::NoInertiaOnCurve;
    }
    Why::SingularOnCurve
}

/// What the reader should know about the lengths.
pub(in crate::simulate) fn warning(task: &RunSetup<'_>) -> Option<Warning> {
    let near = task.equation().linkage().nearness_to_change_point();
    match task.limits.class {
        Class::ChangePoint => Some(Warning::ChangePoint),
        _ => (near < NEAR).then_some(Warning::NearChangePoint(near)),
    }
}
