//! Static equilibrium of slider force and crank torque over one turn, and the calibration of a force sensor.

mod calibration;
mod equilibrium;
mod least;

pub use crate::mechanism::{drum_torque, friction_from_tilt};
pub use calibration::{Calibration, Measured, calibrate};
pub use equilibrium::{StaticAnalysis, StaticsOptions, StaticsRow, statics};
