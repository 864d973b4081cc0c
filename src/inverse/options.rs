//! What is asked of an inverse computation.

use crate::numeric::stop::Stop;

/// How the motion is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitKind {
    /// A polynomial where it leaves nothing but noise within one turn, else the smoother.
    Auto,
    /// A polynomial of the crank angle over time.
    Polynomial,
    /// The iterated extended Kalman smoother.
    Smoother,
}

impl FitKind {
    /// All of them.
    pub const ALL: [FitKind; 3] = [FitKind::Auto, FitKind::Polynomial, FitKind::Smoother];

    /// Name in options and outputs.
    pub fn name(self) -> &'static str {
        match self {
            FitKind::Auto => "auto",
            FitKind::Polynomial => "polynomial",
            FitKind::Smoother => "smoother",
        }
    }
}

/// Degree of a polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitSize {
    /// The degree that the samples support.
    Auto,
    /// This degree.
    Fixed(usize),
}

/// What is asked of an inverse computation.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseOptions {
    /// How the motion is estimated.
    pub fit: FitKind,
    /// Degree of a polynomial.
    pub size: FitSize,
    /// Joint forces for the rows.
    pub reactions: bool,
    /// Whether the slider force is what acts beside the forces of the scene; if not it is the whole force on the
    /// slider.
    pub beside_forces: bool,
    /// A request to stop.
    pub stop: Option<Stop>,
}

impl Default for InverseOptions {
    fn default() -> InverseOptions {
        InverseOptions {
            fit: FitKind::Auto,
            size: FitSize::Auto,
            reactions: false,
            beside_forces: false,
            stop: None,
        }
    }
}
