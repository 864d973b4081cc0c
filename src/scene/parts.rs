//! Parts of a scene: geometry, bodies, gravity, friction, motion and run.

use std::f64::consts::{FRAC_PI_2, TAU};

/// Lengths and assembly of the mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Geometry {
    /// Crank length r, m.
    pub crank: f64,
    /// Connecting rod length l, m.
    pub rod: f64,
    /// Offset e, m: the slider moves along y = −e.
    pub offset: f64,
    /// Side of the crank pin on which the slider is assembled.
    pub branch: Branch,
}

named! {
    /// Assembly branch: the sign s in x = r cos θ + s l cos φ.
    #[derive(Default)]
    pub enum Branch {
        /// Right branch, s = +1.
        #[default]
        Right = "right",
        /// Left branch, s = −1.
        Left = "left",
    }
}

impl Branch {
    /// Returns the sign s, +1 or −1.
    pub fn sign(self) -> f64 {
        match self {
            Branch::Right => 1.0,
            Branch::Left => -1.0,
        }
    }
}

/// Mass properties of the crank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crank {
    /// Mass, kg.
    pub mass: f64,
    /// Distance of the centre of gravity from O along the crank, m.
    pub cg: f64,
    /// Distance of the centre of gravity to the left of O→A, m.
    pub cg_lateral: f64,
    /// Moment of inertia about O, kg m².
    pub inertia: f64,
}

/// Mass properties of the connecting rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rod {
    /// Model of the mass distribution.
    pub model: RodModel,
    /// Mass, kg.
    pub mass: f64,
    /// Distance of the centre of gravity from the crank pin along the rod, m.
    pub cg: f64,
    /// Distance of the centre of gravity to the left of A→P, m.
    pub cg_lateral: f64,
    /// Moment of inertia about the point `inertia_about`, kg m².
    pub inertia: f64,
    /// Reference point of `inertia`.
    pub inertia_about: InertiaAbout,
}

impl Rod {
    /// Returns the moment of inertia about the centre of gravity, kg m² (parallel axis theorem).
    pub fn central_inertia(&self) -> f64 {
        match self.inertia_about {
            InertiaAbout::Cg => self.inertia,
            InertiaAbout::CrankPin => {
                self.inertia - self.mass * (self.cg * self.cg + self.cg_lateral * self.cg_lateral)
            }
        }
    }
}

named! {
    /// Reference point of the rod's moment of inertia.
    #[derive(Default)]
    pub enum InertiaAbout {
        /// The centre of gravity.
        #[default]
        Cg = "cg",
        /// The crank pin A.
        CrankPin = "crank-pin",
    }
}

named! {
    /// Model of the mass of the connecting rod.
    #[derive(Default)]
    pub enum RodModel {
        /// A rigid body.
        #[default]
        Rigid = "rigid",
        /// Two point masses at the pins that keep the centre of gravity (Obaseki & Alfred (31)-(36)).
        TwoMass = "two-mass",
        /// Spin energy only, and the potential as printed (Duarte et al. (7), (8)).
        SpinOnly = "spin-only",
        /// No mass.
        Massless = "massless",
    }
}

/// Mass of the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slider {
    /// Mass, kg.
    pub mass: f64,
}

/// A uniform gravity field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity {
    /// Strength, m/s².
    pub acceleration: f64,
    /// Angle of the gravity vector from +x, rad; −π/2 is down.
    pub direction: f64,
}

impl Gravity {
    /// Returns standard gravity, 9.80665 m/s² along −y.
    pub fn standard() -> Gravity {
        Gravity {
            acceleration: 9.80665,
            direction: -FRAC_PI_2,
        }
    }

    /// Returns the gravity vector, m/s²; exact for the four directions of the axes.
    pub fn vector(&self) -> [f64; 2] {
        let quarter = self.direction / FRAC_PI_2;
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
    /// Kinetic coefficient, dimensionless.
    pub coefficient: f64,
    /// Static coefficient, dimensionless.
    pub static_coefficient: f64,
}

/// Initial or prescribed motion of the crank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Free or prescribed motion.
    pub kind: MotionKind,
    /// Initial crank angle, rad.
    pub angle: f64,
    /// Initial or constant crank speed, rad/s.
    pub speed: f64,
}

named! {
    /// Kind of crank motion.
    #[derive(Default)]
    pub enum MotionKind {
        /// Motion by the equation of motion.
        #[default]
        Free = "free",
        /// Constant speed, prescribed by the scene.
        ConstantSpeed = "constant-speed",
    }
}

/// Extent, output and accuracy of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// End of the run; `None`: not given.
    pub extent: Option<Extent>,
    /// Spacing of the output rows; `None`: 500 rows over the run.
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

/// End of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// Duration of the run, s.
    Duration(f64),
    /// Crank rotation of the run, turns, in either direction.
    Revolutions(f64),
}

impl Extent {
    /// Returns the crank rotation that ends the run, rad; none for a duration.
    pub fn angle(self) -> Option<f64> {
        match self {
            Extent::Duration(_) => None,
            Extent::Revolutions(turns) => Some(turns * TAU),
        }
    }
}

/// Spacing of output rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// Time, s.
    Time(f64),
    /// Crank angle, rad.
    Angle(f64),
}
