//! Forward dynamics: a scene in; trajectory, rows and summary out; engines of the plan take turns between events.
//!
//! A free run goes through `run`, `run_setup`, `forward` and its `engine_loop`, to the engines by `over_angle` and
//! `in_time`; `forward_recorder` and `recorder` take rows, events and motion; `estimate` states the error; `run_end`
//! makes the result, a `simulation`.

mod angle_model;
mod bounded_motion;
mod clearance;
mod closed_form;
mod configuration_curve;
mod coordinate;
mod driving_torque;
mod energy_balance;
mod forward;
mod guide_friction;
mod joint_force_maxima;
mod load_resolution;
mod options;
mod passages;
mod recorder;
mod result;
mod roundoff_propagation;
mod row;
mod row_writer;
mod run;
mod run_end;
mod run_setup;
mod schedule;
mod second_run;
mod simulation;
mod stalled;
mod state_transition;
mod steady;
mod stick_slip;
mod stop;
mod warning;

pub use crate::mechanism::Reactions;
pub use crate::numeric::stop::Stop;
pub use clearance::{Beyond, ClearanceSummary, ContactStatistics, Horizon, LooseFinal};
pub use energy_balance::Energies;
pub use options::Options;
pub use result::{Cost, ErrorEstimate, Event, Final, Peak, Peaks, Piece, Summary, TorqueRange};
pub use row::{LooseRow, NoRows, Row, RowSink};
pub use run::{simulate, simulate_rows, simulate_with_rows};
pub use simulation::Simulation;
#[cfg(feature = "cli")]
pub(crate) use steady::check_fluctuation;
pub use steady::{
    Estimated, Flywheel, LoadWork, SpeedExtreme, SpeedOrder, SteadyState, steady_state,
};
pub use stop::{Stopped, Torques, Why};
pub use warning::{NoRange, Warning};
