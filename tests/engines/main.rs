//! Motions against references: quadrature, other engines, conserved quantities; stated errors, limits and ends.

#[path = "../support/mod.rs"]
mod support;

mod agreement;
mod allocations;
mod angle_engine;
mod caught;
mod closures;
mod crossings;
mod cycles;
mod ends;
mod ends_at_angles;
mod energy_engine;
mod energy_estimates;
mod energy_integral;
mod estimates;
mod forward;
mod handover;
mod hard_cases;
mod interrupted;
mod limits_properties;
mod many_turns;
mod narrow_peaks;
mod number_formats;
mod numeric;
mod ode_solvers_defects;
mod on_the_way;
mod peaks;
mod poles;
mod precision;
mod pulses;
mod pulses_guided;
mod reasons;
mod rockers;
mod rows;
mod stalling;
mod steady_state;
mod switching_properties;
mod time_engine;
mod unstable;
mod work_forecast;
mod work_limit;
