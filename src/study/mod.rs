//! The questions: where the physics meets the integrators.

mod by_angle;
mod by_energy;
mod calibration;
mod clearance;
mod closed_form;
mod curve;
mod drive;
mod enclosed;
mod explain;
mod forces;
mod forward;
mod in_time;

mod kinematics;
mod last_row;
mod log;
mod marks;
mod offsets;
mod one_turn;
mod over_angle;
mod passages;
mod peaks;
mod precision;
mod profile;
mod relay;
#[cfg(feature = "cli")]
mod reproduce;
mod row;
mod schedule;
mod simulate;
mod sliding;
mod spread;
mod stalled;
mod statics;
mod steady;
mod stopped;
mod summary;
#[cfg(feature = "cli")]
mod sweep;
mod swing;
mod task;
mod transition;
mod watch;

pub use crate::mechanism::{Length, Reactions, drum_torque, friction_from_tilt, size_from_stroke};
pub use calibration::{Calibration, Measured, calibrate};
pub use clearance::{Beyond, ClearanceSummary, ContactStatistics, Horizon, LooseFinal};
pub use explain::{Explanation, FrictionAt, LoadAt, TermsAt, explain};
pub use forces::{ForceAnalysis, ForceRow, StrokeTorque, forces};
pub use kinematics::{DeadCentre, Kinematics, KinematicsRow, Located, NamedPosition, kinematics};
pub use offsets::{OffsetExtremes, offset_extremes};
pub use one_turn::{LengthSlope, LoopCheck, OneTurn, TurnOptions, TurnRow, one_turn};
pub use peaks::{Peak, Peaks};
pub use precision::{Precision, PrecisionOptions, PrecisionRow, precision};
#[cfg(feature = "cli")]
pub use reproduce::{Drawing, Entry, Paper, Plot, Reproduction, Series, Style, Verdict, reproduce};
pub use row::{LooseRow, NoRows, Row, RowSink};
pub use simulate::{Options, Simulation, simulate, simulate_rows};
pub use statics::{StaticAnalysis, StaticsOptions, StaticsRow, statics};
pub use steady::{
    Estimated, Flywheel, LoadWork, SpeedExtreme, SteadyOptions, SteadyState, steady_state,
};
pub use summary::{Cost, ErrorEstimate, Event, Final, Summary, TorqueRange};
#[cfg(feature = "cli")]
pub use sweep::{Design, Outcome, Sweep, SweepOptions};
