//! Measurement model: crank angle and speed in, reading h(θ) or ω of a sensor and its derivatives out.

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

/// Crank angle, rad, and crank speed, rad/s.
pub(super) type Turning = [f64; 2];

/// Reading of a sensor of a turning crank.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    /// Reading, rad, m or rad/s; a crank-pin angle has its sign and is continued over the turns.
    pub value: f64,
    /// Derivative with respect to the crank angle, or the speed for a sensor of the speed.
    pub slope: f64,
    /// Second derivative.
    pub curvature: f64,
}

impl<'a> Sensor<'a> {
    /// An exact sensor of a linkage.
    pub fn exact(linkage: &'a Linkage, measured: Measured) -> Sensor<'a> {
        Sensor {
            linkage,
            measured,
            scale: Scale::TRUE,
        }
    }

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

    /// Returns true for a sensor of the speed.
    pub fn is_of_speed(&self) -> bool {
        self.measured == Measured::Omega
    }

    /// Returns the reading of a turning crank.
    pub fn shown(&self, [theta, omega]: Turning) -> Shown {
        let (value, slope, curvature) = match self.measured {
            Measured::Theta => (theta, 1.0, 0.0),
            Measured::Omega => (omega, 1.0, 0.0),
            Measured::X => {
                let pose = self.linkage.pose(theta);
                let Scale { shift, stretch } = self.scale;
                let value = shift + stretch * pose.x;
                (value, stretch * pose.dx, stretch * pose.d2x)
            }
            Measured::Gamma => {
                let pose = self.linkage.pose(theta);
                let (value, slope) = self.linkage.crank_pin_angle(theta, &pose);
                (value, slope, -self.linkage.s * pose.d2phi)
            }
        };
        Shown {
            value,
            slope,
            curvature,
        }
    }

    /// Returns the variance of a reading due to a covariance of θ, ω, θ̈ (00, 01, 11, 02, 12, 22).
    pub fn variance(&self, shown: &Shown, covariance: &[f64; 6]) -> f64 {
        shown.slope * shown.slope * covariance[if self.is_of_speed() { 2 } else { 0 }]
    }

    /// Returns the typical change of the reading per radian, or per rad/s, of the crank: the crank length, m, or 1.
    pub fn size(&self) -> f64 {
        match self.measured {
            Measured::X => self.linkage.r,
            _ => 1.0,
        }
    }

    /// Returns measured value minus reading, and the reading. A crank-pin protractor shows no sign: the sign nearer to
    /// the reading counts.
    pub fn residual(&self, value: f64, turning: Turning) -> (f64, Shown) {
        let shown = self.shown(turning);
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
