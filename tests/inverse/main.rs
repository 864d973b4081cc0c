//! Slider force and crank torque from measured motion.

#[path = "../support/mod.rs"]
mod support;

mod dense_steps;
mod encoders;
mod fast_waves;
mod fit;
mod fit_errors;
mod hard_data;
mod inverse;
mod inverse_band;
mod inverse_friction;
mod inverse_fuzz;
mod inverse_limits;
mod measured_rows;
mod missed;
mod noise;
mod polynomial;
mod rounded_times;
mod unfolding;
