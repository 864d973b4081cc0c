//! Measurement model: crank angle in, reading h(θ) of a sensor and its derivatives out.

use std::f64::consts::TAU;

use crate::mechanism::{InversePosition, Linkage};
use crate::scene::Measured;

/// Sensor of a mechanism: the measured quantity and its scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sensor<'a> {
    pub linkage: &'a Linkage,
    pub measured: Measured,
    /// Zero and gain of a position sensor, which shows shift + stretch x.
    pub scale: Scale,
}

/// Zero, m, and gain of a position sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    pub shift: f64,
    pub stretch: f64,
}

impl Scale {
    /// Exact sensor: zero 0 and gain 1.
    pub const TRUE: Scale = Scale {
        shift: 0.0,
        stretch: 1.0,
    };
}

/// Reading of a sensor at a crank angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    /// Reading, rad or m; a crank-pin angle has its sign and is continued over the turns.
    pub value: f64,
    /// Derivative with respect to the crank angle.
    pub slope: f64,
    /// Second derivative with respect to the crank angle.
    pub curvature: f64,
}

impl Sensor<'_> {
    /// Returns the crank angles of a reading, and its distance from all possible readings, rad or m.
    pub fn angles(&self, value: f64) -> (InversePosition, f64) {
        match self.measured {
            Measured::X => {
                let x = (value - self.scale.shift) / self.scale.stretch;
                (self.linkage.angles_of_x(x), self.linkage.excess_of_x(x))
            }
            _ => (
                self.linkage.angles_of_gamma(value),
                self.linkage.excess_of_gamma(value),
            ),
        }
    }

    /// Returns the reading at a crank angle, rad.
    pub fn shown(&self, theta: f64) -> Shown {
        match self.measured {
            Measured::Theta => Shown {
                value: theta,
                slope: 1.0,
                curvature: 0.0,
            },
            Measured::X => {
                let pose = self.linkage.pose(theta);
                let Scale { shift, stretch } = self.scale;
                Shown {
                    value: shift + stretch * pose.x,
                    slope: stretch * pose.dx,
                    curvature: stretch * pose.d2x,
                }
            }
            Measured::Gamma => {
                let pose = self.linkage.pose(theta);
                let (value, slope) = self.linkage.crank_pin_angle(theta, &pose);
                Shown {
                    value,
                    slope,
                    curvature: -self.linkage.s * pose.d2phi,
                }
            }
        }
    }

    /// Returns the typical change of the reading per radian of the crank: the crank length, m, or 1.
    pub fn size(&self) -> f64 {
        match self.measured {
            Measured::X => self.linkage.r,
            _ => 1.0,
        }
    }

    /// Returns measured value minus reading, and the reading. A crank-pin protractor shows no sign: the sign nearer to
    /// the reading counts.
    pub fn residual(&self, value: f64, theta: f64) -> (f64, Shown) {
        let shown = self.shown(theta);
        let off = |value: f64| {
            let off = value - shown.value;
            off - (off / TAU).round() * TAU
        };
        let residual = match self.measured {
            Measured::Gamma if off(-value).abs() < off(value).abs() => off(-value),
            Measured::Gamma => off(value),
            _ => value - shown.value,
        };
        (residual, shown)
    }
}
