//! Slider force and crank torque from measured motion.

#[path = "../support/mod.rs"]
mod support;

mod encoder;
mod hard_data;
mod identify;
mod interrupted;
mod inverse;
mod inverse_friction;
mod inverse_fuzz;
mod inverse_limits;
mod long_records;
mod measured_rows;
mod missing_values;
mod noise;
mod outliers;
mod polynomial;
mod simulated;
mod speed;
mod uncertain;
mod unwrapping;
mod white_snap;
