//! A crank that comes to a stand because its drive does not get over the load.

use super::result::Final;
use super::run_setup::RunSetup;
use crate::mechanism::{Class, Equation};
use crate::numeric::angle::Angle;
use crate::numeric::root;
use crate::scene::{Load, Variable};

/// A crank stands where it cannot leave a balance by more than this part of the way it came.
const OF_ITS_WAY: f64 = 1e-3;

/// Why a run was stopped at a state in which the crank had stalled; none if it had not.
pub(super) fn reason(task: &RunSetup<'_>, last: &Final) -> Option<String> {
    let reduced = task.scene.reduced();
    let rests = reduced.friction.is_some() || task.equation().loads().are_dry();
    if rests || reduced.clearance.is_some() || task.limits.class != Class::RotatingCrank {
        return None;
    }
    let theta = balance(task.equation(), task.start().radians(), last)?;
    let torques = torques(task, theta);
    let (speed, t) = (last.omega_rad_per_s, last.t_s);
    let turns = task.extent.angle().map_or(String::new(), |angle| {
        format!(
            " and does not complete {} turns",
            angle / std::f64::consts::TAU
        )
    });
    Some(format!(
        "the crank stalled at theta = {theta} rad, {torques}{turns}: stopped at t = {t} s, omega = {speed} rad/s; give it more torque, or a duration instead"
    ))
}

/// What drives the crank at rest at an angle (rad), and what it is to move: forces on the slider and weight.
pub(super) fn torques(task: &RunSetup<'_>, theta: f64) -> String {
    let equation = task.equation();
    let drive = equation.load(0.0, theta, 0.0).torque;
    let load = -equation.driving_torque(0.0, theta, 0.0, 0.0) - drive;
    let is_motor = |load: &Load| matches!(load, Load::Motor { .. });
    let motor = match task.scene.torques.iter().any(is_motor) {
        true => "motor torque",
        false => "crank torque",
    };
    format!("{motor} {drive} N m, load {load} N m")
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
