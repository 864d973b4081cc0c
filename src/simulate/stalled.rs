//! Detection of a stalled crank: near a balance of its torques, from which its energy does not lift it.

use std::f64::consts::TAU;

use super::result::Final;
use super::run_setup::RunSetup;
use super::stop::{Torques, Why};
use crate::numeric::angle::Angle;
use crate::numeric::root;
use crate::scene::{Load, Variable};

/// Returns the driving torque on the crank at rest at an angle (rad) and the load: forces on the slider and weight.
pub(super) fn torques(task: &RunSetup<'_>, theta: f64) -> Torques {
    let equation = task.equation();
    let drive = equation.load(0.0, theta, 0.0).torque;
    let is_motor = |load: &Load| matches!(load, Load::Motor { .. });
    Torques {
        by_motor: task.scene.torques.iter().any(is_motor),
        drive,
        load: -equation.driving_torque(0.0, theta, 0.0, 0.0) - drive,
    }
}

/// Returns the reason if the crank has stalled at the last state: loads bring it back to a balance, and its energy does
/// not lift it out. None otherwise, and with friction, dry loads, loads in time, clearance or limits.
pub(super) fn stalled(task: &RunSetup<'_>, last: &Final) -> Option<Why> {
    let equation = task.equation();
    let timed = equation.loads().reads.has(Variable::T);
    let loose = task.scene.reduced().clearance.is_some();
    if task.may_stick() || timed || loose || !task.turns_fully() {
        return None;
    }
    let net = |theta: f64| -equation.driving_torque(0.0, theta, 0.0, 0.0);
    let theta = last.theta_rad;
    // Largest distance to the balance, as part of the rotation of the crank up to there.
    let near_balance = 1e-3;
    let width = near_balance * (theta - task.start().radians()).abs();
    let (below, above) = (theta - width, theta + width);
    let (up, down) = (net(below), net(above));
    let rest = Angle::from(theta).reduced().rest;
    let kinetic = equation.kinetic_energy(rest, last.omega_rad_per_s);
    let held = up > 0.0 && down < 0.0 && kinetic < 0.25 * width * up.min(-down);
    let theta = held.then(|| root::bracketed(net, below, above))??;
    Some(Why::Stalled {
        theta,
        torques: torques(task, theta),
        turns: task.extent.angle().map(|angle| angle / TAU),
    })
}
