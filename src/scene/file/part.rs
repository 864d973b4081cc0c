//! Part of a scene that one table of a scene file makes.

use crate::scene::{
    Clearance, Crank, Friction, Geometry, Gravity, Load, Motion, Rod, Run, Scene, Slider,
};

/// Part of a scene made by one table.
#[derive(Clone, Debug)]
pub(super) enum Part {
    Geometry(Geometry),
    Crank(Crank),
    Rod(Rod),
    Slider(Slider),
    Gravity(Option<Gravity>),
    Torque(Load),
    Force(Load),
    Friction(Option<Friction>),
    Clearance(Option<Clearance>),
    Motion(Motion),
    Run(Run),
}

impl Part {
    pub fn enter(self, scene: &mut Scene) {
        match self {
            Part::Geometry(geometry) => scene.geometry = geometry,
            Part::Crank(crank) => scene.crank = Some(crank),
            Part::Rod(rod) => scene.rod = Some(rod),
            Part::Slider(slider) => scene.slider = Some(slider),
            Part::Gravity(gravity) => scene.gravity = gravity,
            Part::Torque(load) => scene.torques.push(load),
            Part::Force(load) => scene.forces.push(load),
            Part::Friction(friction) => scene.friction = friction,
            Part::Clearance(clearance) => scene.clearance = clearance,
            Part::Motion(motion) => scene.motion = motion,
            Part::Run(run) => scene.run = run,
        }
    }
}
