//! What the user wrote: a scene as plain data, SI and radians, absent parts `None`.
//!
//! A scene comes from a file ([`Scene::load`]) or from code ([`Scene::new`] and the methods that add
//! parts). Either way [`Scene::check`] says all that is wrong with it.

mod assemble;
mod builtin;
mod expression;
mod header;
mod keys;
mod load;
mod problem;
mod read;
mod schema;
mod table;
pub mod unit;
mod validate;

pub use expression::{Expression, ExpressionError};
pub use load::{Instant, Load, Variable, Variables};
pub use problem::{Problem, Problems};
pub use schema::schema;
pub use table::{Interpolation, Table};

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
}

/// Lengths and assembly of the mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    /// Crank length r, m.
    pub crank: f64,
    /// Connecting rod length l, m.
    pub rod: f64,
    /// Offset e, m: the slider moves along y = −e.
    pub offset: f64,
    /// On which side of the crank pin the slider is assembled.
    pub branch: Branch,
}

/// Assembly branch: the sign s in x = r cos θ + s l cos φ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Branch {
    /// s = +1
    #[default]
    Right,
    /// s = −1
    Left,
}

impl Branch {
    /// +1 or −1.
    pub fn sign(self) -> f64 {
        match self {
            Branch::Right => 1.0,
            Branch::Left => -1.0,
        }
    }

    /// Its name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Branch::Right => "right",
            Branch::Left => "left",
        }
    }
}

/// Mass properties of the crank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crank {
    /// kg
    pub mass: f64,
    /// Centre of gravity from O along the crank, m.
    pub cg: f64,
    /// Centre of gravity to the left of O→A, m.
    pub cg_lateral: f64,
    /// Moment of inertia about O, kg m².
    pub inertia: f64,
}

/// Mass properties of the connecting rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rod {
    /// How its mass is modelled.
    pub model: RodModel,
    /// kg
    pub mass: f64,
    /// Centre of gravity from the crank pin along the rod, m.
    pub cg: f64,
    /// Centre of gravity to the left of A→P, m.
    pub cg_lateral: f64,
    /// Moment of inertia about the point `inertia_about`, kg m².
    pub inertia: f64,
    /// Where the inertia is taken.
    pub inertia_about: InertiaAbout,
}

impl Rod {
    /// Moment of inertia about the centre of gravity, kg m² (parallel axis theorem).
    pub fn central_inertia(&self) -> f64 {
        match self.inertia_about {
            InertiaAbout::Cg => self.inertia,
            InertiaAbout::CrankPin => {
                self.inertia - self.mass * (self.cg * self.cg + self.cg_lateral * self.cg_lateral)
            }
        }
    }
}

/// Reference point of the rod's moment of inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InertiaAbout {
    /// The centre of gravity.
    #[default]
    Cg,
    /// The crank pin A.
    CrankPin,
}

/// How the mass of the connecting rod is modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RodModel {
    /// A rigid body.
    #[default]
    Rigid,
    /// Two point masses at the pins with the same centre of gravity (Obaseki & Alfred (31)-(36)).
    TwoMass,
    /// Spin energy only, and the potential as printed (Duarte et al. (7), (8)).
    SpinOnly,
    /// No mass.
    Massless,
}

impl RodModel {
    /// Its name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            RodModel::Rigid => "rigid",
            RodModel::TwoMass => "two-mass",
            RodModel::SpinOnly => "spin-only",
            RodModel::Massless => "massless",
        }
    }
}

/// Mass of the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slider {
    /// kg
    pub mass: f64,
}

/// A uniform gravity field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity {
    /// m/s²
    pub acceleration: f64,
    /// Angle of the gravity vector from +x, rad; −π/2 is down.
    pub direction: f64,
}

impl Gravity {
    /// 9.80665 m/s² along −y.
    pub fn standard() -> Gravity {
        Gravity {
            acceleration: 9.80665,
            direction: -std::f64::consts::FRAC_PI_2,
        }
    }

    /// The gravity vector, m/s²; exact for the four directions of the axes.
    pub fn vector(&self) -> [f64; 2] {
        let quarter = self.direction / std::f64::consts::FRAC_PI_2;
        let (sin, cos) = if quarter == quarter.round() && quarter.abs() < 1e9 {
            [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]
                [(quarter as i64).rem_euclid(4) as usize]
        } else {
            self.direction.sin_cos()
        };
        [self.acceleration * cos, self.acceleration * sin]
    }
}

/// Coulomb friction at the slider guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Kinetic coefficient.
    pub coefficient: f64,
    /// Static coefficient.
    pub static_coefficient: f64,
}

/// Radial clearance at one revolute joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// The joint.
    pub joint: Joint,
    /// Radial clearance, m.
    pub radial: f64,
    /// m
    pub bearing_radius: Option<f64>,
    /// Pa
    pub young_modulus: Option<f64>,
    /// dimensionless
    pub poisson_ratio: Option<f64>,
    /// dimensionless, 0 to 1
    pub restitution: Option<f64>,
    /// dimensionless
    pub friction: Option<f64>,
}

/// A revolute joint of the connecting rod.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// A
    CrankPin,
    /// P
    WristPin,
}

/// Initial or prescribed motion of the crank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Whether the loads or the scene decide the motion.
    pub kind: MotionKind,
    /// Initial crank angle, rad.
    pub angle: f64,
    /// Initial or constant crank speed, rad/s.
    pub speed: f64,
}

/// Who decides the crank's motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionKind {
    /// The equation of motion.
    #[default]
    Free,
    /// The scene: constant speed.
    ConstantSpeed,
}

/// Extent, output and accuracy of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// When the run ends; `None`: not said.
    pub extent: Option<Extent>,
    /// Distance of the output rows; `None`: 500 rows over the run.
    pub output_every: Option<Every>,
    /// Local error target, relative and absolute.
    pub tolerance: f64,
}

impl Default for Run {
    fn default() -> Run {
        Run {
            extent: None,
            output_every: None,
            tolerance: 1e-10,
        }
    }
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// After this time, s.
    Duration(f64),
    /// After this many turns of the crank, either way.
    Revolutions(f64),
}

/// Distance of output rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// s
    Time(f64),
    /// rad of the crank
    Angle(f64),
}

impl Scene {
    /// A mechanism of crank length `crank`, rod length `rod` (m) and no offset, right branch, massless,
    /// at rest at zero angle: the start for scenes built in code.
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
        Scene {
            title: None,
            geometry: Geometry {
                crank,
                rod,
                offset: 0.0,
                branch: Branch::Right,
            },
            crank: None,
            rod: None,
            slider: None,
            gravity: None,
            torques: Vec::new(),
            forces: Vec::new(),
            friction: None,
            clearance: None,
            motion: Motion::default(),
            run: Run::default(),
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

    /// Gives the crank mass properties.
    pub fn crank(mut self, crank: Crank) -> Scene {
        self.crank = Some(crank);
        self
    }

    /// Gives the rod mass properties.
    pub fn rod(mut self, rod: Rod) -> Scene {
        self.rod = Some(rod);
        self
    }

    /// Gives the slider mass.
    pub fn slider(mut self, slider: Slider) -> Scene {
        self.slider = Some(slider);
        self
    }

    /// Adds gravity.
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

    /// Sets the initial crank angle (rad) and speed (rad/s); the equation decides the motion.
    pub fn start(mut self, angle: f64, speed: f64) -> Scene {
        self.motion = Motion {
            kind: MotionKind::Free,
            angle,
            speed,
        };
        self
    }

    /// Prescribes a constant crank speed (rad/s) from `angle` (rad) on.
    pub fn constant_speed(mut self, angle: f64, speed: f64) -> Scene {
        self.motion = Motion {
            kind: MotionKind::ConstantSpeed,
            angle,
            speed,
        };
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

    /// Sets the distance of the output rows.
    pub fn output_every(mut self, every: Every) -> Scene {
        self.run.output_every = Some(every);
        self
    }

    /// Sets the local error target, relative and absolute.
    pub fn tolerance(mut self, tolerance: f64) -> Scene {
        self.run.tolerance = tolerance;
        self
    }

    /// All that is wrong with the scene's values.
    ///
    /// # Errors
    /// [`Problems`] with one entry for each impossible value.
    pub fn check(&self) -> Result<(), Problems> {
        let problems = validate::problems(self);
        if problems.is_empty() {
            Ok(())
        } else {
            Err(Problems::in_code(problems))
        }
    }

    /// The same scene without what has no strength: zero masses, zero loads, zero gravity.
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
