//! The physics: geometry in closed form, energy terms, loads, the Lagrange equation, joint reactions.
//! Knows no integrator: [`Equation::acceleration`] serves any. With ode_solvers take the ends of steps
//! (`OutputType::Sparse`), for its dense output is not to be trusted, see [`Method::Dop853`](crate::plan::Method::Dop853).

mod at_rest;
mod batch;
mod body;
mod clearance;
mod configuration_curve;
mod curve_equation;
mod detail;
mod equivalent;
mod extremes;
mod first_order;
mod friction;
mod guide_force;
mod inverse_position;
mod lagrange;
mod limits;
mod linkage;
mod load;
mod loop_closure;
mod nonlinear_loads;
mod place;
mod positions;
mod reactions;
mod rocker;
mod rounding;
mod seen;
mod sensitivity;
mod singularity;
mod sizing;
mod solid;
mod statics;
mod torque_slope;
mod way;

pub use at_rest::{AtRest, Held};
pub use batch::Instants;
pub use body::{Bodies, Body, Link, Path};
pub use clearance::{
    Depth, JointTouch, LooseMechanism, LooseRates, LooseState, NormalForce, Rubbing, SpeedSizes,
    Turned,
};
pub use configuration_curve::Curve;
pub use curve_equation::{CurveEquation, CurveTerms};
pub use equivalent::EquivalentMasses;
pub use extremes::{Extreme, Extremes};
pub use first_order::FirstOrder;
pub use friction::{Free, FromRest, Jam, Touch};
pub use guide_force::Normal;
pub use inverse_position::InversePosition;
pub use lagrange::{Equation, Inertia, Terms};
pub use limits::{Class, DeadCentre, Limits};
pub use linkage::{Linkage, Pose};
pub use load::Loads;
pub use loop_closure::Closure;
pub use nonlinear_loads::{LoadValue, Sense, single};
pub use place::Place;
pub use positions::NamedPosition;
pub use reactions::{InertiaForces, Reactions, Reactor};
pub use seen::{Arms, Seen};
pub use sensitivity::{Length, PoseSlope};
pub use singularity::Singularity;
pub use sizing::size_from_stroke;
pub use solid::{MassProperties, Shape};
pub use statics::{Balance, Band, Statics, drum_torque, friction_from_tilt};
pub use torque_slope::TorqueSlope;
