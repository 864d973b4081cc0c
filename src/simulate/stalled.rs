//! A crank that comes to a stand because its drive does not get over the load.

use std::f64::consts::TAU;
use std::fmt;

use super::result::Final;
use super::run_setup::RunSetup;
use super::stop::Why;
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;
use crate::numeric::root;
use crate::scene::{Load, Variable};

/// A crank stands where it cannot leave a balance by more than this part of the way it came.
const OF_ITS_WAY: f64 = 1e-3;

/// Torques that balance, N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torques {
    /// Whether a motor is what drives.
    by_motor: bool,
    drive: f64,
    load: f64,
}

impl fmt::Display for Torques {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.by_motor { "motor" } else { "crank" };
        write!(
            f,
            "{what} torque {} N m, load {} N m",
            self.drive, self.load
        )
    }
}

/// Why a run was stopped at a state in which the crank had stalled; none if it had not.
pub(super) fn reason(task: &RunSetup<'_>, last: &Final) -> Option<Why> {
    let reduced = task.scene.reduced();
    let rests = reduced.friction.is_some() || task.equation().loads().are_dry();
    if rests || reduced.clearance.is_some() || !task.turns_fully() {
        return None;
    }
    let theta = balance(task.equation(), task.start().radians(), last)?;
    Some(Why::Stalled {
        theta,
        torques: torques(task, theta),
        turns: task.extent.angle().map(|angle| angle / TAU),
    })
}

/// What drives the crank at rest at an angle (rad), and what it is to move: forces on the slider and weight.
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

/// The balance next to which the crank stays, rad: loads of the state alone bring it back, and its energy does not lift it
/// out of there.
fn balance(equation: &Equation, start: f64, last: &Final) -> Option<f64> {
    if equation.loads().reads().has(Variable::T) {
        return None;
    }
    let (theta, omega) = (last.theta_rad, last.omega_rad_per_s);
    let net = |theta: f64| -equation.driving_torque(0.0, theta, 0.0, 0.0);
    let width = OF_ITS_WAY * (theta - start).abs();
    let (below, above) = (theta - width, theta + width);
    let (up, down) = (net(below), net(above));
    let kinetic = equation.kinetic_energy(Angle::from(theta).reduced().rest, omega);
    let held = up > 0.0 && down < 0.0 && kinetic < 0.25 * width * up.min(-down);
    held.then(|| root::bracketed(net, below, above))?
}
