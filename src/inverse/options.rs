//! Options of an inverse computation.

use crate::numeric::stop::Stop;

named! {
    /// Method of motion estimation.
    pub enum FitKind {
        /// Polynomial within one turn where it leaves only noise and is the likelier motion, else the smoother.
        Auto = "auto",
        /// A polynomial of the crank angle over time.
        Polynomial = "polynomial",
        /// The iterated extended Kalman smoother.
        Smoother = "smoother",
    }
}

/// Degree of a polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitSize {
    /// Degree that the samples support.
    Auto,
    /// Given degree.
    Fixed(usize),
}

/// Options of an inverse computation.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseOptions {
    /// Method of motion estimation.
    pub fit: FitKind,
    /// Degree of the polynomial.
    pub size: FitSize,
    /// Whether joint forces of the rows can be computed.
    pub reactions: bool,
    /// Whether the slider force acts beside the forces of the scene; if not, it is the whole force on the slider.
    pub beside_forces: bool,
    /// Request to stop, if any.
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
