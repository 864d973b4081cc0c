//! What an instrument shows at a crank angle: h(θ), with its derivatives.

use std::f64::consts::TAU;

use crate::mechanism::{InversePosition, Linkage};
use crate::scene::Measured;

/// A measured quantity of a mechanism.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sensor<'a> {
    pub linkage: &'a Linkage,
    pub measured: Measured,
    /// What a sensor of slider positions shows: shift + stretch x.
    pub scale: Scale,
}

/// Zero, m, and gain of a sensor of slider positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    pub shift: f64,
    pub stretch: f64,
}

impl Scale {
    /// The slider is where the sensor shows it.
    pub const TRUE: Scale = Scale {
        shift: 0.0,
        stretch: 1.0,
    };
}

/// A measured value at a crank angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    /// rad or m; a crank-pin angle with its sign, continued over the turns.
    pub value: f64,
    /// Derivative with respect to the crank angle.
    pub slope: f64,
    /// Second derivative.
    pub curvature: f64,
}

impl Sensor<'_> {
    /// The crank angles at which a value is shown, and how far it is from all that can be shown.
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

    /// What is shown at a crank angle, rad.
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

    /// A size of what is measured per radian of the crank: the crank length, m, or 1.
    pub fn size(&self) -> f64 {
        match self.measured {
            Measured::X => self.linkage.r,
            _ => 1.0,
        }
    }

    /// Measured minus shown, with what is shown. A protractor at the crank pin shows no sign: that next to what is shown
    /// counts.
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
