//! The physics: geometry in closed form, energy terms, loads, the Lagrange equation, joint reactions.
//! Knows no integrator.

mod body;
mod extremes;
mod lagrange;
mod limits;
mod linkage;
mod load;
mod positions;
mod reactions;
mod sensitivity;
mod statics;
mod torque_slope;

pub use body::{Bodies, Body, Path};
pub use extremes::{Extreme, Extremes};
pub use lagrange::{Equation, Inertia, Obstacle, Terms};
pub use limits::{Class, DeadCentre, Limits};
pub use linkage::{Linkage, Pose};
pub use load::{LoadValue, Loads, single};
pub use positions::NamedPosition;
pub use reactions::{Reactions, Reactor};
pub use sensitivity::{Length, PoseSlope};
pub use statics::{Balance, Band, Statics, drum_torque, friction_from_tilt};
pub use torque_slope::TorqueSlope;
