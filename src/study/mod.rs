//! The questions: where the physics meets the integrators.

mod by_angle;
mod by_energy;
mod clearance;
mod closed_form;
mod drive;
mod explain;
mod forward;
mod in_time;
mod kinematics;
mod over_angle;
mod passages;
mod precision;
mod profile;
mod row;
mod schedule;
mod simulate;
mod stopped;
mod summary;
mod task;
mod watch;

pub use clearance::{Beyond, ClearanceSummary, ContactStatistics, Horizon, LooseFinal};
pub use explain::{Explanation, LoadAt, TermsAt, explain};
pub use kinematics::{DeadCentre, Kinematics, KinematicsRow, Located, kinematics};
pub use precision::{Precision, PrecisionOptions, PrecisionRow, precision};
pub use row::{LooseRow, NoRows, Row, RowSink};
pub use simulate::{Options, Simulation, simulate, simulate_rows};
pub use summary::{Cost, ErrorEstimate, Event, Final, Summary, TorqueRange};
