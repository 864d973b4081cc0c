//! The physics: geometry in closed form, energy terms, loads, the Lagrange equation, joint reactions.
//! Knows no integrator.

mod body;
mod clearance;
mod extremes;
mod lagrange;
mod limits;
mod linkage;
mod load;
mod reactions;

pub use body::{Bodies, Body, Path};
pub use clearance::{
    Depth, LooseMechanism, LooseRates, LooseState, NormalForce, Touch, Turned,
};
pub use extremes::{Extreme, Extremes};
pub use lagrange::{Equation, Inertia, Obstacle, Terms};
pub use limits::{Class, DeadCentre, Limits};
pub use linkage::{Linkage, Pose};
pub use load::{LoadValue, Loads, single};
pub use reactions::{Reactions, Reactor};
