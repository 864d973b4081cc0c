//! Rows of a motion on the configuration curve.

use super::super::row::Row;
use super::super::run_setup::RunSetup;
use super::stick_slip::{InPhase, Phase};
use crate::engine::step::Step;
use crate::mechanism::{CurveEquation, Reactor};
use crate::numeric::angle::Angle;

/// The row of the end of a run in one phase.
pub(in crate::simulate) fn last_row(
    task: &RunSetup<'_>,
    equation: &CurveEquation,
    phase: Phase,
    last: &Step,
) -> Row {
    let state = (last.end.t, last.angle(last.end.theta), last.end.omega);
    row_on_curve(equation, task.maker.reactor, phase, state)
}

/// The row of a time (s), a coordinate and its rate (rad/s) in one phase.
pub(in crate::simulate) fn row_on_curve(
    equation: &CurveEquation,
    reactor: Option<&Reactor>,
    phase: Phase,
    (t, angle, speed): (f64, Angle, f64),
) -> Row {
    let motion = InPhase { equation, phase };
    let curve = equation.curve();
    let place = curve.place(angle.rest);
    let (acceleration, touch, _) = motion.state(t, angle, speed);
    let reactions = reactor.map(|reactor| {
        let load = motion.load(&place, t, angle, speed);
        let force = load.force + touch.friction;
        reactor.on_curve(&place, speed, acceleration, force, touch.normal)
    });
    Row {
        clearance: None,
        t,
        theta: curve.crank_angle(angle).radians(),
        omega: place.dtheta * speed,
        alpha: place.dtheta * acceleration + place.d2theta * speed * speed,
        x: place.x,
        v: place.dx * speed,
        a: place.dx * acceleration + place.d2x * speed * speed,
        phi: place.phi(),
        reactions,
        driving_torque: None,
    }
}
