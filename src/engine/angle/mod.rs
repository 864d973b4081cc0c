//! Angle engine: motion under loads that depend on speed and time too, by collocation over the crank angle, as long as
//! the speed keeps its sign.
//!
//! On each panel of Chebyshev points the kinetic energy and the time are found together by collocation, K' = F(θ) +
//! L(θ, ω, t), t' = 1/ω: sweeps (Picard iteration) start from the profiles of earlier turns, and Newton's method takes
//! over where the loads are steep in the speed. What depends on the position alone is tabulated once for a cycle (the
//! turns after which the loads repeat) and used in every one. Where time does not occur, a cycle maps the kinetic
//! energy at its start to that at its end (Poincaré map): long runs iterate an interpolant of this map.
//!
//! The forces may have two forms, one on each side of a zero of the switch, a function of the state. A panel ends at
//! the zero, and the rest of it is solved with the other form.

mod angle_run;
mod cycle_panels;
mod dynamics;
mod errors;
mod forces;
mod guide;
mod load_resolution;
mod newton;
mod panel;
mod poincare_map;
mod predictor;
mod progress;
mod refine;
mod run;
mod secant;
mod solution;
mod stepper;
mod sweep;
mod switch;
mod table;
mod undamped;

pub use angle_run::{AngleRun, EarlyEnd, Goal, Resolution};
pub use dynamics::{Dynamics, Panels, State, StateVariable};
pub use errors::Errors;
pub use run::run;
pub use table::{Switch, Table};
