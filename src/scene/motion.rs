//! Motion of the crank, and extent, output and accuracy of a run.

use std::f64::consts::TAU;

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

impl Extent {
    /// The angle by which the crank turns, rad, if that ends the run.
    pub fn angle(self) -> Option<f64> {
        match self {
            Extent::Duration(_) => None,
            Extent::Revolutions(turns) => Some(turns * TAU),
        }
    }
}

/// Distance of output rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// s
    Time(f64),
    /// rad of the crank
    Angle(f64),
}
