//! Motion of the crank, and extent, output and accuracy of a run.

use std::f64::consts::TAU;

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

/// Kind of crank motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionKind {
    /// Motion by the equation of motion.
    #[default]
    Free,
    /// Constant speed, prescribed by the scene.
    ConstantSpeed,
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
