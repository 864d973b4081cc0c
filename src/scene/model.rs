//! Scene, its loads and its uncertain values.

use std::fmt;
use std::path::Path;

use super::{
    Clearance, Crank, Friction, Geometry, Gravity, Load, Motion, Periodicity, Places, Rod,
    RodModel, Run, Slider, Table, Variables,
};

/// A complete scene.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Title, one line.
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
    /// Coulomb friction at the slider guide; `None`: no friction.
    pub friction: Option<Friction>,
    /// Clearance at one joint; `None`: ideal joints.
    pub clearance: Option<Clearance>,
    /// Initial or prescribed crank motion.
    pub motion: Motion,
    /// Extent, output rows and accuracy of the run.
    pub run: Run,
    /// Places of the keys in the scene file; none for a scene from code.
    pub places: Places,
}

impl Scene {
    /// Iterates over the torques, then the forces.
    pub fn loads(&self) -> impl Iterator<Item = LoadOf<'_>> {
        let lists = [(&self.torques, false), (&self.forces, true)];
        lists.into_iter().flat_map(|(list, on_slider)| {
            let keys = (1..).map(move |number| LoadKey { on_slider, number });
            list.iter()
                .zip(keys)
                .map(|(load, key)| LoadOf { load, key })
        })
    }

    /// Iterates over the files of the load tables.
    pub fn table_files(&self) -> impl Iterator<Item = &Path> {
        let tables = self.loads().filter_map(|of| of.load.table());
        tables.filter_map(Table::file)
    }

    /// Returns the scene without parts of zero strength: masses, gravity, loads, friction and clearance.
    pub fn reduced(&self) -> Scene {
        let mut scene = self.clone();
        scene.crank = scene.crank.filter(|c| c.inertia != 0.0 || c.mass != 0.0);
        let has_mass = |r: &Rod| r.mass != 0.0 || r.inertia != 0.0;
        scene.rod = scene
            .rod
            .filter(|r| r.model != RodModel::Massless && has_mass(r));
        scene.slider = scene.slider.filter(|s| s.mass != 0.0);
        scene.gravity = scene.gravity.filter(|g| g.acceleration != 0.0);
        scene.torques.retain(|load| !load.is_zero());
        scene.forces.retain(|load| !load.is_zero());
        let rubs = |f: &Friction| f.coefficient != 0.0 || f.static_coefficient != 0.0;
        scene.friction = scene.friction.filter(rubs);
        scene.clearance = scene.clearance.filter(|c| c.radial != 0.0);
        scene
    }
}

/// Load of a scene, with its place.
#[derive(Clone, Copy, Debug)]
pub struct LoadOf<'a> {
    /// The load.
    pub load: &'a Load,
    /// Name in scene files.
    pub key: LoadKey,
}

/// Name of a load in scene files, shown as `torque[1]`.
#[derive(Clone, Copy, Debug)]
pub struct LoadKey {
    /// Whether the load acts on the slider; otherwise on the crank.
    pub on_slider: bool,
    number: usize,
}

impl LoadOf<'_> {
    /// Returns the variables the load depends on.
    pub fn reads(&self) -> Variables {
        self.load.reads(self.key.on_slider)
    }

    /// Returns the period of the load over the crank angle, at equal time and crank speed.
    pub fn repeats(&self) -> Periodicity {
        self.load.repeats(self.key.on_slider)
    }
}

/// Writes the name of the load, then its description in brackets.
impl fmt::Display for LoadOf<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.key, self.load)
    }
}

impl fmt::Display for LoadKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = if self.on_slider { "force" } else { "torque" };
        write!(f, "{list}[{}]", self.number)
    }
}

/// Scene with one of its values moved by the standard error.
#[derive(Clone, Debug)]
pub struct MovedScene {
    /// Name of the value, as `geometry.rod`.
    pub key: String,
    /// Scene with the value one standard error higher, or lower where the higher one is impossible.
    pub moved: Scene,
}
