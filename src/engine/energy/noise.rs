//! What rounding makes of the series of a panel.

use super::kinetic::Energy;
use super::piece::Turning;
use crate::numeric::chebyshev::Values;

/// The last two terms of a series show so many units of the rounding of its values.
const SEEN_UNITS: f64 = 8.0;

/// What rounding leaves of the last terms of series, relative to the largest.
pub(super) struct Noise {
    pub force: f64,
    /// Of dt/dx.
    pub slope: f64,
}

impl Noise {
    /// Where rounding may change the force by `rounding` (N m) beside that of angles, of which a panel shows what of the
    /// inertia and the force changes on it: the kinetic energy is a force times a way, which is not rounded.
    pub fn of(energy: &Energy<'_>, inertia: &Values, force: &Values, rounding: f64) -> Noise {
        let range = |values: &Values| {
            let none = (f64::INFINITY, f64::NEG_INFINITY);
            let ends = |(low, high): (f64, f64), v: &f64| (low.min(*v), high.max(*v));
            values.iter().fold(none, ends)
        };
        let ((light, heavy), (low, high)) = (range(inertia), range(force));
        let span = energy.piece.span().abs();
        let units = SEEN_UNITS * f64::EPSILON;
        let place = units * energy.piece.from.abs() / span;
        let off = place * (high - low) + SEEN_UNITS * rounding;
        let of_energy = match energy.piece.turning {
            Turning::Nowhere => off * span / energy.kinetic,
            _ => off / low.abs().min(high.abs()),
        };
        Noise {
            force: units + off / low.abs().max(high.abs()),
            slope: (units + place * (heavy - light) / heavy + of_energy).min(units + place),
        }
    }
}
