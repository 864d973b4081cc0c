//! Motion in time on the configuration curve: past the limits of a rocker, and with Coulomb friction.

mod arrived;
mod end_reason;
mod follow;
mod recorder;
mod release;
mod rest;
mod roundoff;
mod row;
mod senses;
mod stick_slip;

pub(super) use arrived::{Arrived, End, Follow, Observer, crank_state};
pub(super) use end_reason::{warning, why};
pub(super) use recorder::CurveWatch;
pub(super) use roundoff::Noise;
pub(super) use row::{last_row, row_on_curve};
pub(super) use stick_slip::Phase;

use super::outcome::Balance;
use super::run_setup::RunSetup;
use crate::engine::time::Start;
use crate::mechanism::{Curve, CurveEquation, Equation};
use crate::numeric::angle::Angle;

/// Whether a free motion in time is computed here.
pub(super) fn serves(task: &RunSetup<'_>) -> bool {
    let may_stick = task.scene.reduced().friction.is_some() || task.equation().loads().are_dry();
    !task.turns_fully() || may_stick
}

/// The equation on the curve of the start, and the start on it; none where no curve goes through it.
pub(super) fn through_start(task: &RunSetup<'_>) -> Option<(CurveEquation, Start)> {
    let (curve, angle) = Curve::through(task.equation().linkage(), task.start())?;
    let speed = match task.scene.motion.speed {
        0.0 => 0.0,
        speed => speed / curve.place(angle.rest).dtheta,
    };
    let start = Start {
        t: 0.0,
        angle,
        speed,
    };
    Some((CurveEquation::new(task.scene, curve), start))
}

/// Energy at the end against that at the start and the work.
pub(super) fn energy_balance(
    constrained: &CurveEquation,
    equation: &Equation,
    start: Start,
    arrived: &Arrived,
    speed: f64,
) -> Balance {
    let last = &arrived.last;
    let angle = last.angle(last.end.theta);
    let turns = constrained.curve().crank_angle(start.angle).turns;
    let potential = |q: Angle| constrained.potential_energy(equation, q, turns);
    let kinetic = [
        constrained.kinetic_energy(start.angle, start.speed),
        constrained.kinetic_energy(angle, last.end.omega),
    ];
    let rise = potential(angle) - potential(start.angle);
    let gained = (kinetic[1] - kinetic[0]) + rise;
    let peak = equation.kinetic_energy(constrained.curve().crank_angle(angle).rest, speed);
    let peak = if peak.is_finite() { peak } else { 0.0 };
    Balance::new(
        gained - arrived.work,
        &[kinetic[0], kinetic[1], rise, arrived.work, peak],
    )
}
