//! Energy engine: motion under loads of the crank angle alone, by quadrature of the energy integral.
//!
//! The kinetic energy K(θ) follows from the energy integral, which makes dt/dθ = sqrt(M/(2K)) a function of the angle.
//! It is expanded on panels in Chebyshev series, each to rounding; t(θ) is their integral, and θ(t) takes one to three
//! Newton steps. Full rotation under forces that do no work per turn is periodic; motion between two turning points is,
//! too. Ends of a libration are taken with θ = θ_end ∓ s², which makes dt/ds smooth. Where each turn gains the same
//! work, the time of many turns is a sum in closed form.

mod build;
mod equal_gains;
mod error_bound;
mod euler_maclaurin;
mod extreme;
pub(in crate::engine) mod interpolated_turns;
mod kinetic;
mod one_turn;
mod orbit;
pub(in crate::engine) mod panel;
pub(in crate::engine) mod piece;
mod positions;
mod profile;
pub(in crate::engine) mod segment;
mod turn_end;
mod turning_points;
pub(in crate::engine) mod turns;

pub use orbit::Orbit;
pub use profile::{NotApplicable, Profile};
