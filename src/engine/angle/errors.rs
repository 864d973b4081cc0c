//! Propagation of errors of the kinetic energy through a run over the angle.

/// Errors of energy and time: an error of the energy shifts the time, the more the slower the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Rounding error of the kinetic energy, J.
    pub energy: f64,
    /// Time error due to rounding of the energy, s.
    pub time: f64,
    /// Fraction of an initial error of the kinetic energy that remains at the end: losses reduce it.
    pub retained: f64,
    /// Advance of the end time per initial error of the kinetic energy, s/J.
    pub advance: f64,
}

impl Errors {
    /// Returns the errors at the start for a kinetic energy, J, with an error `off` beyond its rounding, J.
    pub(super) fn at(kinetic: f64, off: f64) -> Errors {
        Errors {
            energy: off.hypot(0.5 * f64::EPSILON * kinetic),
            time: 0.0,
            retained: 1.0,
            advance: 0.0,
        }
    }

    /// Propagates the errors over a panel that retains a fraction of an energy error and adds `noise`, J. An error at
    /// the start advances the end by `advance`, the noise by `advance_of_noise`, s/J.
    pub(super) fn pass(&mut self, retained: f64, noise: f64, advance: f64, advance_of_noise: f64) {
        self.time += (self.energy * advance).hypot(noise * advance_of_noise);
        self.advance += self.retained * advance;
        self.retained *= retained;
        self.energy = (retained * self.energy).hypot(noise);
    }
}
