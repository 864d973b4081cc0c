//! What the instrument shows at a crank angle, for fits in terms of what was measured.

use std::f64::consts::TAU;

use crate::mechanism::Linkage;
use crate::scene::Measured;

/// A measured quantity of a mechanism.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sensor<'a> {
    pub linkage: &'a Linkage,
    pub measured: Measured,
}

impl Sensor<'_> {
    /// What is measured minus what the crank angle θ (rad) gives, and the derivative of the latter.
    ///
    /// A crank-pin angle is measured without sign: the sign and turn next to those of the crank angle are taken.
    pub fn residual(&self, value: f64, theta: f64) -> (f64, f64) {
        match self.measured {
            Measured::Theta => (value - theta, 1.0),
            Measured::X => {
                let pose = self.linkage.pose(theta);
                (value - pose.x, pose.dx)
            }
            Measured::Gamma => {
                let pose = self.linkage.pose(theta);
                let (signed, slope) = self.linkage.crank_pin_angle(theta, &pose);
                let rest = |value: f64| {
                    let off = value - signed;
                    off - (off / TAU).round() * TAU
                };
                let (plus, minus) = (rest(value), rest(-value));
                if plus.abs() <= minus.abs() {
                    (plus, slope)
                } else {
                    (minus, slope)
                }
            }
        }
    }
}
