//! The physics: geometry in closed form, energy terms, loads, the Lagrange equation, joint reactions.
//! Knows no integrator.

mod batch;
mod body;
mod extremes;
mod fold;
mod lagrange;
mod limits;
mod linkage;
mod load;
mod obstacle;
mod reactions;

pub use batch::Instants;
pub use body::{Bodies, Body, Path};
pub use extremes::{Extreme, Extremes};
pub use fold::Candidates;
pub use lagrange::{Equation, Inertia, Terms};
pub use limits::{Class, DeadCentre, Limits};
pub use linkage::{Linkage, Pose};
pub use load::{LoadValue, Loads, single};
pub use obstacle::Obstacle;
pub use reactions::{Reactions, Reactor};
