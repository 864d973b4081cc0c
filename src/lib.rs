//! Dynamics of the generalized offset slider-crank from its Lagrange equation.
//!
//! ```text
//! scene  ->  mechanism  ->  plan  ->  engine  ->  trajectory  ->  report
//! what       geometry,      what      integra-    the motion,     CSV,
//! the user   energy,        is        tors        dense           text,
//! wrote      loads          needed                                JSON
//! ```
//!
//! M θ̈ + ½ M' θ̇² + V' = Q, with every term built from the kinetic and potential energy of the bodies
//! and the virtual work of the loads. Each question is a module with a function, like [`simulate::simulate`] or
//! [`kinematics::kinematics`], which a command of the program calls.
//!
//! # Example
//!
//! An engine with a load given as a closure, simulated for half a second:
//!
//! ```
//! use slider_crank::scene::{Crank, Load, Scene, Slider, Variables};
//! use slider_crank::simulate::{Options, simulate};
//!
//! let scene = Scene::new(0.05, 0.15) // crank and rod, m
//!     .offset(0.01)
//!     .crank(Crank { inertia: 2e-3, ..Crank::default() }) // kg m², about O
//!     .slider(Slider { mass: 0.4 })
//!     .torque(Load::Constant(1.5)) // N m
//!     .torque(Load::function(Variables::OMEGA, |now| -1e-4 * now.omega * now.omega.abs()))
//!     .start(0.0, 20.0) // rad, rad/s
//!     .duration(0.5);
//!
//! let run = simulate(&scene, &Options::default())?;
//! let (theta, omega) = run.at(0.25).unwrap();
//! assert!(theta > 0.0 && omega > 20.0);
//! let error = run.summary.error_estimate.unwrap();
//! assert!(error.theta_rad < 1e-6);
//! # Ok::<(), slider_crank::error::Error>(())
//! ```
//!
//! # Where to begin
//!
//! - A scene comes from code, as above, from text ([`scene::Scene::parse`]) or from a file ([`scene::Scene::load`]).
//! - [`simulate::simulate`] keeps the dense motion; [`simulate::simulate_rows`] passes its rows on, in memory that
//!   does not grow with the run.
//! - [`kinematics::kinematics`], [`kinematics::forces`] and [`statics::statics`] tabulate one turn of the crank.
//! - [`inverse::inverse`] takes measured samples, from arrays ([`scene::Measurement::new`]) or from a file
//!   ([`scene::Measurement::load`]).
//! - [`sweep::Sweep`] computes many designs, [`optimise::optimise`] searches for the best one;
//!   [`explain::explain`] shows the equation, its terms and the plan.
//!
//! Without the default feature `cli` the library has no program, scene files, sweeps, optimisation, reproduced papers
//! and reports; scenes are then written in Rust.
//!
//! All values are f64 in SI units and radians; [`mechanism::Linkage`] states the sign conventions.

/// Declares an enum whose values have names, in files, options and outputs: `NAMES`, `ALL`, `name`, `named` and `Display`.
macro_rules! named {
    ($(#[$about:meta])* pub enum $Enum:ident { $($(#[$meaning:meta])* $Value:ident = $name:literal,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $Enum {
            $($(#[$meaning])* $Value,)*
        }

        impl $Enum {
            /// Names of all values, in order.
            pub const NAMES: &[&str] = &[$($name),*];

            /// All values, in order.
            pub const ALL: [$Enum; $Enum::NAMES.len()] = [$($Enum::$Value),*];

            /// Returns the name in files, options and outputs.
            pub const fn name(self) -> &'static str {
                $Enum::NAMES[self as usize]
            }

            /// Returns the value with this name.
            pub fn named(name: &str) -> Option<$Enum> {
                $Enum::ALL.into_iter().find(|one| one.name() == name)
            }
        }

        impl std::fmt::Display for $Enum {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod engine;
pub mod error;
pub mod explain;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod figure;
pub mod inverse;
pub mod kinematics;
pub mod mechanism;
#[doc(hidden)]
pub mod numeric;
#[cfg(feature = "cli")]
pub mod optimise;
pub mod plan;
pub mod precision;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod report;
#[cfg(feature = "cli")]
pub mod reproduce;
pub mod scene;
pub mod simulate;
pub mod statics;
#[cfg(feature = "cli")]
pub mod sweep;
pub mod trajectory;

pub use numeric::stop::Stop;

#[cfg(all(doctest, feature = "cli"))]
#[doc = include_str!("../README.md")]
struct Readme;
