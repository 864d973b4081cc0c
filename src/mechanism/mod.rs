//! The physics: geometry in closed form, energy terms, loads, the Lagrange equation, joint reactions.
//! Knows no integrator.

mod batch;
mod body;
mod constrained;
mod curve;
mod extremes;
mod friction;
mod lagrange;
mod limits;
mod linkage;
mod load;
mod obstacle;
mod reactions;
mod rocker;

pub use batch::Instants;
pub use body::{Bodies, Body, Path};
pub use constrained::{Across, Constrained};
pub use curve::{Curve, Place};
pub use extremes::{Extreme, Extremes};
pub use friction::{Free, FromRest, Jam, Touch};
pub use lagrange::{Equation, Inertia, Terms};
pub use limits::{Class, DeadCentre, Limits};
pub use linkage::{Linkage, Pose};
pub use load::{LoadValue, Loads, single};
pub use obstacle::Obstacle;
pub use reactions::{Reactions, Reactor};
