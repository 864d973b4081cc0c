//! Why a run in time ends before its time, or cannot begin.

use super::stop::Why;
use crate::engine::step::Step;
use crate::engine::time::{FAR, Finish, Start};
use crate::error::Error;
use crate::mechanism::{Equation, Singularity};
use crate::numeric::angle::Angle;
use crate::scene::{Extent, Instant};

/// Why a run ended before its time.
pub(super) fn reason(
    finish: Finish,
    equation: &Equation,
    impossible: Option<(f64, Angle, f64)>,
    last: &Step,
    extent: Extent,
) -> Option<Why> {
    let end = &last.end;
    Some(match (finish, extent) {
        (Finish::AtEnd, Extent::Revolutions(turns)) if end.t >= FAR => Why::Turns(turns),
        (Finish::AtEnd | Finish::Stopped, _) => return None,
        (Finish::StepTooSmall | Finish::NoStart, _) => {
            let (t, angle, speed) = impossible.unwrap_or((end.t, last.angle(end.theta), end.omega));
            match equation.obstacle(t, angle, speed) {
                Some(Singularity::Blocked) => Why::AtLimit,
                Some(Singularity::Load) => no_value(equation, Start { t, angle, speed }),
                Some(Singularity::NoInertia) => Why::NoInertia,
                Some(Singularity::TooLarge) => Why::TooLarge,
                None if nearly_vanishes(equation, last) => Why::NearlyNoInertia,
                None => Why::Singular,
            }
        }
        (finish, _) => limit(finish)?,
    })
}

/// The work limit, if an integrator ended at one.
pub(super) fn limit(finish: Finish) -> Option<Why> {
    match finish {
        Finish::WorkLimit => Some(Why::WorkLimit),
        Finish::WorkLimitAhead => Some(Why::WorkLimitAhead),
        Finish::TooManyTurns => Some(Why::TooManyTurns),
        _ => None,
    }
}

/// A load has no finite value at a state: which.
pub(super) fn no_value(equation: &Equation, asked: Start) -> Why {
    let Start { t, angle, speed } = asked;
    let theta = angle.radians();
    let pose = equation.linkage().pose(theta);
    let now = Instant {
        t,
        theta,
        omega: speed,
        x: pose.x,
        v: pose.dx * speed,
    };
    let load = equation.loads().without_value(&now).cloned();
    Why::NoValue { asked, load }
}

/// Whether the inertia is next to nothing here, compared with that a radian further.
fn nearly_vanishes(equation: &Equation, last: &Step) -> bool {
    let inertia = |theta: f64| equation.terms(theta).inertia.m;
    let theta = last.end.theta;
    inertia(theta) < 1e-9 * inertia(theta + 1.0)
}

/// Why a run cannot begin from a crank angle and speed (rad/s) that nothing else is wrong with.
pub(super) fn no_start(angle: Angle, speed: f64) -> Error {
    Error::refused(
        format!(
            "no motion begins at the start, theta = {} rad, omega = {speed} rad/s: the equation has no finite acceleration next to it",
            angle.radians()
        ),
        "start at another angle, or check the loads there",
    )
}
