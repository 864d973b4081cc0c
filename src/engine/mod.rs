//! Integrators for a motion with one coordinate, given by its acceleration and power; they contain no mechanics.

pub mod angle;
pub mod collocation;
pub mod contact;
pub mod energy;
pub mod event_functions;
pub mod events;
mod motion;
pub mod resolution;
mod run_in_time;
pub mod runge_kutta;
pub mod step;
pub mod time;
pub mod work_forecast;

pub use motion::{Batch, Counted, Motion, NODES, PIECES, fill_one_by_one};
pub use run_in_time::WorkLimit;
