//! Scenes: takes files or code, returns plain data in SI units and radians, absent parts `None`.
//!
//! A scene comes from a file ([`Scene::load`]) or from code ([`Scene::new`] and the methods that add
//! parts). [`Scene::check`] returns all problems of either.

mod builder;
mod check;
mod clearance;
mod corners;
mod csv;
mod digits;
mod expression;
#[cfg(feature = "cli")]
mod file;
mod load;
mod measurement;
mod model;
mod number;
mod parts;
mod period;
mod problem;
mod table;
mod text;
pub mod unit;
mod validate;
mod variable;

pub(crate) use check::LARGEST_VALUE;
pub use clearance::{Clearance, ContactLaw, Joint};
pub use expression::{Expression, ExpressionError};
#[cfg(feature = "cli")]
pub use file::{Assigned, Draft, NumberKey, Varied, VariedValue, printable, schema};
#[cfg(feature = "cli")]
pub(crate) use file::{DUARTE, did_you_mean};
pub use load::Load;
pub(crate) use measurement::Unwrapped;
pub use measurement::{Beside, BesideColumn, DUARTE_MOTION, Measured, Measurement, Reading};
pub use model::{LoadKey, LoadOf, MovedScene, Scene};
pub(crate) use number::unrounded;
#[cfg(feature = "cli")]
pub(crate) use number::{counted, rounded};
pub use parts::{
    Branch, Crank, Every, Extent, Friction, Geometry, Gravity, InertiaAbout, Motion, MotionKind,
    Rod, RodModel, Run, Slider,
};
pub use period::{Period, Periodicity, WhyNot};
pub use problem::{Places, Problem, Problems};
pub use table::{Interpolation, LoadTable, Table, calibration_points, load_table};
pub(crate) use validate::{LEAST_RUN_TOLERANCE, MOST_OUTPUT_ROWS};
pub use variable::{Instant, Variable, Variables};
