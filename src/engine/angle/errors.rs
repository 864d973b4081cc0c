//! What errors of the kinetic energy do to a run over the angle.

use crate::engine::energy::piece::Piece;

/// How they go on: an energy that is off makes the motion late, the more the slower it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// How far rounding may have brought the kinetic energy, J,
    pub off: f64,
    /// and by it the time, s.
    pub late: f64,
    /// What is left of an energy that was off at the start, as part of it: a loss takes its part of an error, too,
    pub kept: f64,
    /// and how much earlier it made the end, s/J.
    pub early: f64,
}

impl Errors {
    /// At the start, with this kinetic energy, which may be off beside its rounding, J.
    pub(super) fn at(kinetic: f64, off: f64) -> Errors {
        Errors {
            off: off.hypot(0.5 * f64::EPSILON * kinetic),
            late: 0.0,
            kept: 1.0,
            early: 0.0,
        }
    }

    /// After a panel of some duration (s) that keeps this part of an error and adds some (J). An energy that is off
    /// makes it earlier by `early` (s/J), the integral of dt/2K; `most` is the larger energy of its ends, J.
    pub(super) fn pass(&mut self, kept: f64, noise: f64, early: f64, duration: f64, most: f64) {
        // What is added is added where there is more.
        let added = 0.5 * duration / most;
        self.late += (self.off * early).hypot(noise * added);
        self.early += self.kept * early;
        self.kept *= kept;
        self.off = (kept * self.off).hypot(noise);
    }
}

/// What the rounding of angles may change in the work of these forces (N m) over a piece, in units of the last place,
/// J.
pub(super) fn uncertain(piece: &Piece, forces: &[f64]) -> f64 {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = forces.iter().fold(none, |(low, high), force| {
        (low.min(*force), high.max(*force))
    });
    0.5 * piece.from.abs().max(piece.to.abs()) * (high - low)
}
