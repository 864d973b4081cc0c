//! Builder methods for scenes in code.

use super::{
    Branch, Crank, Every, Extent, Geometry, Gravity, Load, Motion, MotionKind, Rod, Scene, Slider,
};

impl Scene {
    /// Creates a mechanism of crank length `crank`, rod length `rod` (m) and no offset, right branch, massless, at rest
    /// at zero angle: the base of scenes in code.
    ///
    /// ```
    /// use slider_crank::scene::{Crank, Load, Scene, Slider};
    /// let scene = Scene::new(0.05, 0.15)
    ///     .offset(0.01)
    ///     .crank(Crank { inertia: 2e-3, ..Crank::default() })
    ///     .slider(Slider { mass: 0.4 })
    ///     .torque(Load::Constant(1.5))
    ///     .start(0.0, 20.0)
    ///     .duration(0.5);
    /// assert!(scene.check().is_ok());
    /// ```
    pub fn new(crank: f64, rod: f64) -> Scene {
        let geometry = Geometry {
            crank,
            rod,
            ..Geometry::default()
        };
        Scene {
            geometry,
            ..Scene::default()
        }
    }

    /// Sets the offset, m.
    pub fn offset(mut self, offset: f64) -> Scene {
        self.geometry.offset = offset;
        self
    }

    /// Sets the assembly branch.
    pub fn branch(mut self, branch: Branch) -> Scene {
        self.geometry.branch = branch;
        self
    }

    /// Sets the mass properties of the crank.
    pub fn crank(mut self, crank: Crank) -> Scene {
        self.crank = Some(crank);
        self
    }

    /// Sets the mass properties of the rod.
    pub fn rod(mut self, rod: Rod) -> Scene {
        self.rod = Some(rod);
        self
    }

    /// Sets the mass of the slider.
    pub fn slider(mut self, slider: Slider) -> Scene {
        self.slider = Some(slider);
        self
    }

    /// Sets the gravity field.
    pub fn gravity(mut self, gravity: Gravity) -> Scene {
        self.gravity = Some(gravity);
        self
    }

    /// Adds a torque on the crank.
    pub fn torque(mut self, load: Load) -> Scene {
        self.torques.push(load);
        self
    }

    /// Adds a force on the slider.
    pub fn force(mut self, load: Load) -> Scene {
        self.forces.push(load);
        self
    }

    /// Sets the initial crank angle (rad) and speed (rad/s) of a free motion.
    pub fn start(mut self, angle: f64, speed: f64) -> Scene {
        let kind = MotionKind::Free;
        self.motion = Motion { kind, angle, speed };
        self
    }

    /// Prescribes a constant crank speed (rad/s) from `angle` (rad) on.
    pub fn constant_speed(mut self, angle: f64, speed: f64) -> Scene {
        let kind = MotionKind::ConstantSpeed;
        self.motion = Motion { kind, angle, speed };
        self
    }

    /// Ends the run after this time, s.
    pub fn duration(mut self, duration: f64) -> Scene {
        self.run.extent = Some(Extent::Duration(duration));
        self
    }

    /// Ends the run after this many turns.
    pub fn revolutions(mut self, revolutions: f64) -> Scene {
        self.run.extent = Some(Extent::Revolutions(revolutions));
        self
    }

    /// Sets the spacing of the output rows.
    pub fn output_every(mut self, every: Every) -> Scene {
        self.run.output_every = Some(every);
        self
    }

    /// Sets the local error target, relative and absolute.
    pub fn tolerance(mut self, tolerance: f64) -> Scene {
        self.run.tolerance = tolerance;
        self
    }
}
