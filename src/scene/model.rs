//! A scene and its values.

use std::fmt;
use std::path::Path;

use super::check::Check;
use super::{
    Clearance, Crank, Friction, Geometry, Gravity, Load, Motion, Places, Problem, Problems, Rod,
    RodModel, Run, Slider, Table,
};

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
    /// What is wrong, with the places of the file the scene comes from.
    ///
    /// # Errors
    /// [`Problems`] if there is anything.
    pub fn refused(&self, problems: Vec<Problem>) -> Result<(), Problems> {
        let places = &self.places;
        Check { problems, places }.result()
    }

    /// Its torques, then its forces.
    pub fn loads(&self) -> impl Iterator<Item = LoadOf<'_>> {
        let lists = [(&self.torques, false), (&self.forces, true)];
        lists.into_iter().flat_map(|(list, on_slider)| {
            (1..).zip(list).map(move |(number, load)| LoadOf {
                load,
                on_slider,
                number,
            })
        })
    }

    /// The files of the tables of its loads.
    pub fn table_files(&self) -> impl Iterator<Item = &Path> {
        let tables = self.loads().filter_map(|of| of.load.table());
        tables.filter_map(Table::file)
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

/// A load of a scene.
#[derive(Clone, Copy, Debug)]
pub struct LoadOf<'a> {
    /// What it is.
    pub load: &'a Load,
    /// Whether it acts on the slider; else on the crank.
    pub on_slider: bool,
    number: usize,
}

/// Name of a load in scene files, shown as `torque[1]`.
#[derive(Clone, Copy, Debug)]
pub struct LoadKey {
    on_slider: bool,
    number: usize,
}

impl LoadOf<'_> {
    /// Its name in scene files.
    pub fn key(&self) -> LoadKey {
        LoadKey {
            on_slider: self.on_slider,
            number: self.number,
        }
    }
}

impl fmt::Display for LoadKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = if self.on_slider { "force" } else { "torque" };
        write!(f, "{list}[{}]", self.number)
    }
}

/// A value of a scene with its standard error.
#[derive(Clone, Debug)]
pub struct UncertainValue {
    /// Name, as `geometry.rod`.
    pub key: String,
    /// The scene with the value a standard error higher, or lower where it cannot be higher.
    pub moved: Scene,
}
