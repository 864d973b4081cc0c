//! Output row of each sample.

/// Motion, force and torque at one sample, SI and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InverseRow {
    /// Time, s.
    pub t: f64,
    /// Fitted crank angle, rad, unwrapped.
    pub theta: f64,
    /// Crank speed, rad/s.
    pub omega: f64,
    /// Crank acceleration, rad/s².
    pub alpha: f64,
    /// Force on the slider along +x, N; none where the motion does not determine it.
    pub slider_force: Option<f64>,
    /// Standard error of the force, N.
    pub slider_force_se: Option<f64>,
    /// Torque on the crank that drives the motion in place of the slider force, N m; none where the guide locks.
    pub crank_torque: Option<f64>,
    /// Standard error of the torque, N m.
    pub crank_torque_se: Option<f64>,
    /// Whether the force is left empty.
    pub near_dead_centre: bool,
}

/// Measured value and residual of the fit at one sample, rad or m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Time, s.
    pub t: f64,
    /// Measured value; a crank angle is continued over the turns.
    pub measured: f64,
    /// Measured minus fitted value.
    pub residual: f64,
}
