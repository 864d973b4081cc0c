//! The questions: where the physics meets the integrators.

mod by_angle;
mod by_energy;
mod closed_form;
mod drive;
mod explain;
mod forward;
mod in_time;
mod inverse;
mod kinematics;
mod over_angle;
mod passages;
mod profile;
mod row;
mod schedule;
mod simulate;
mod stopped;
mod summary;
mod task;
mod watch;

pub use explain::{Explanation, LoadAt, TermsAt, explain};
pub use inverse::{
    AsPrinted, BandRule, DataSummary, DeadCentreBand, FitKind, FitSize, FitSummary, ForceRange,
    Inverse, InverseOptions, InverseRow, InverseSummary, Residual, inverse,
};
pub use kinematics::{DeadCentre, Kinematics, KinematicsRow, Located, kinematics};
pub use row::{NoRows, Row, RowSink};
pub use simulate::{Options, Simulation, simulate, simulate_rows};
pub use summary::{Cost, ErrorEstimate, Event, Final, Summary, TorqueRange};
