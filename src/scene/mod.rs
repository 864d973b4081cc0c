//! What the user wrote: a scene as plain data, SI and radians, absent parts `None`.
//!
//! A scene comes from a file ([`Scene::load`]) or from code ([`Scene::new`] and the methods that add
//! parts). Either way [`Scene::check`] says all that is wrong with it.

mod body;
mod builder;
mod check;
mod clearance;
mod corners;
mod csv;
mod expression;
#[cfg(feature = "cli")]
mod file;
mod load;
mod measurement;
mod motion;
mod number;
mod parts;
mod period;
mod places;
mod problem;
mod table;
mod text;
pub mod unit;
mod validate;
pub(crate) use validate::MOST_ROWS;
mod variable;

use std::path::Path;

use check::Check;

pub use body::{Crank, InertiaAbout, Rod, RodModel, Slider};
pub use clearance::{Clearance, ContactLaw, Joint};
pub use expression::{Expression, ExpressionError};
#[cfg(feature = "cli")]
pub use file::{Assigned, Draft, NumberKey, Varied, VariedValue, printable, schema};
#[cfg(feature = "cli")]
pub(crate) use file::{DUARTE, nearest};
pub use load::Load;
pub use measurement::{Beside, BesideColumn, DUARTE_MOTION, Measured, Measurement, Reading};
pub use motion::{Every, Extent, Motion, MotionKind, Run};
pub use parts::{Branch, Friction, Geometry, Gravity, UncertainValue};
pub use period::{Period, Repeats, WhyNot};
pub use places::Places;
pub use problem::{Problem, Problems};
pub use table::{Interpolation, Table, calibration_points};
#[cfg(feature = "cli")]
pub use table::{LoadTable, load_table};
pub use variable::{Instant, Variable, Variables};

/// A complete scene.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What the scene is, in a line.
    pub title: Option<String>,
    /// The lengths of the mechanism.
    pub geometry: Geometry,
    /// The crank's mass properties; `None`: massless.
    pub crank: Option<Crank>,
    /// The connecting rod's mass properties; `None`: massless.
    pub rod: Option<Rod>,
    /// The slider's mass; `None`: massless.
    pub slider: Option<Slider>,
    /// Gravity; `None`: none.
    pub gravity: Option<Gravity>,
    /// Torques on the crank; they add up.
    pub torques: Vec<Load>,
    /// Forces on the slider; they add up.
    pub forces: Vec<Load>,
    /// Coulomb friction at the slider guide.
    pub friction: Option<Friction>,
    /// Clearance at one joint.
    pub clearance: Option<Clearance>,
    /// Initial or prescribed crank motion.
    pub motion: Motion,
    /// How long, how fine, how exact.
    pub run: Run,
    /// Where its keys stand, if it comes from a file.
    pub places: Places,
}

impl Scene {
    /// All that is wrong with the scene's values.
    ///
    /// # Errors
    /// [`Problems`] with one entry for each impossible value.
    pub fn check(&self) -> Result<(), Problems> {
        let mut check = Check {
            problems: Vec::new(),
            places: &self.places,
        };
        validate::problems(self, &mut check);
        check.result()
    }

    /// What is wrong, with the places of the file the scene comes from.
    ///
    /// # Errors
    /// [`Problems`] if there is anything.
    pub fn refused(&self, problems: Vec<Problem>) -> Result<(), Problems> {
        let places = &self.places;
        Check { problems, places }.result()
    }

    /// The files of the tables of its loads.
    pub fn table_files(&self) -> impl Iterator<Item = &Path> {
        let loads = self.torques.iter().chain(&self.forces);
        loads.filter_map(Load::table).filter_map(Table::file)
    }

    /// The scene without what has no strength: zero masses, zero loads, zero gravity.
    pub fn reduced(&self) -> Scene {
        let mut scene = self.clone();
        scene.crank = scene.crank.filter(|c| c.inertia != 0.0 || c.mass != 0.0);
        scene.rod = scene
            .rod
            .filter(|r| r.model != RodModel::Massless && (r.mass != 0.0 || r.inertia != 0.0));
        scene.slider = scene.slider.filter(|s| s.mass != 0.0);
        scene.gravity = scene.gravity.filter(|g| g.acceleration != 0.0);
        scene.torques.retain(|load| !load.is_zero());
        scene.forces.retain(|load| !load.is_zero());
        scene.friction = scene
            .friction
            .filter(|f| f.coefficient != 0.0 || f.static_coefficient != 0.0);
        scene.clearance = scene.clearance.filter(|c| c.radial != 0.0);
        scene
    }
}
