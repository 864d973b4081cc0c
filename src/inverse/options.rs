//! Options of an inverse computation.

use crate::numeric::stop::Stop;

named! {
    /// Method of motion estimation.
    #[derive(Default)]
    pub enum FitKind {
        /// Polynomial within one turn where it leaves only noise and is the likelier motion, else the smoother.
        #[default]
        Auto = "auto",
        /// A polynomial of the crank angle over time.
        Polynomial = "polynomial",
        /// The iterated extended Kalman smoother.
        Smoother = "smoother",
    }
}

/// Options of an inverse computation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InverseOptions {
    /// Method of motion estimation.
    pub fit: FitKind,
    /// Degree of the polynomial, which a given one asks for; none for the one that the samples support.
    pub degree: Option<usize>,
    /// Whether joint forces of the rows can be computed.
    pub reactions: bool,
    /// Whether the slider force acts beside the forces of the scene; if not, it is the whole force on the slider.
    pub beside_forces: bool,
    /// Request to stop, if any.
    pub stop: Option<Stop>,
}
