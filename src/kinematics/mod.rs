//! Kinematics of one turn of the crank in closed form: positions, dead centres, extremes; forces at constant speed.

mod closed_form;
mod diagrams;
mod forces;
mod one_turn;
mod synthesis;
mod turning_moment;

pub use crate::mechanism::{Length, size_from_stroke};
pub use closed_form::{DeadCentre, Kinematics, KinematicsRow, Located, NamedPosition, kinematics};
#[cfg(feature = "cli")]
pub(crate) use closed_form::{of_checked, warnings};
pub use diagrams::{Counterweight, Diagrams, Indicated, Order};
pub use forces::{ForceAnalysis, ForceRow, StrokeTorque, forces};
#[cfg(feature = "cli")]
pub(crate) use one_turn::left_out_of_forces;
pub use one_turn::{LengthSlope, MOST_ROWS_OF_TURN, OneTurn, TurnOptions, TurnRow, one_turn};
pub use synthesis::{Choice, Synthesis, synthesis};
pub use turning_moment::{Area, TurningMoment};
