//! Enclosed state over a piece of a motion: intervals of time, angle, speed, slider position and velocity.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::configuration_curve::Chart;
use super::rocker::Rocker;
use super::{Curve, Linkage};
use crate::numeric::enclosure::{Interval, Reach};

/// Ranges of the variables of loads; the whole line for a variable that no load depends on.
#[derive(Clone, Copy, Debug)]
pub struct EnclosedState {
    /// Time, s.
    pub t: Interval,
    /// Crank angle, rad, unwrapped.
    pub theta: Interval,
    /// Crank speed, rad/s.
    pub omega: Interval,
    /// Slider position, m.
    pub x: Interval,
    /// Slider velocity, m/s.
    pub v: Interval,
    /// x', m/rad of the coordinate.
    pub dx: Interval,
}

/// Effects of a unit load.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arms {
    /// Effect of a torque, per N m.
    pub torque: f64,
    /// Effect of a slider force, per N.
    pub force: f64,
}

impl EnclosedState {
    /// Returns the arms of the generalized force over the crank angle: Q = τ + F x'.
    pub fn arms(&self) -> Arms {
        Arms {
            torque: 1.0,
            force: self.dx.largest(),
        }
    }
}

impl Arms {
    /// Returns the sums of the magnitudes of two pairs of arms, for loads that act in two ways.
    pub fn plus(self, other: Arms) -> Arms {
        Arms {
            torque: self.torque.abs() + other.torque.abs(),
            force: self.force.abs() + other.force.abs(),
        }
    }

    /// Returns the larger magnitudes of the arms at two positions.
    pub fn larger(self, other: Arms) -> Arms {
        Arms {
            torque: self.torque.abs().max(other.torque.abs()),
            force: self.force.abs().max(other.force.abs()),
        }
    }
}

/// Ranges of a position over a range of a coordinate q.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    /// Angle at q, rad: φ of a linkage, θ of a curve.
    pub angle: Interval,
    /// Derivative of the angle with respect to q.
    pub dangle: Interval,
    /// Slider position, m.
    pub x: Interval,
    /// x', m/rad.
    pub dx: Interval,
}

fn point(at: f64) -> Interval {
    Interval::point(at)
}

fn sine(of: Interval) -> Interval {
    Interval::new(of.low.max(-1.0), of.high.min(1.0))
}

fn root(of: Interval) -> Interval {
    Interval::new(of.low.max(0.0), of.high.max(0.0)).rising(f64::sqrt)
}

impl Linkage {
    /// Encloses φ, φ', x and x' over crank angles.
    pub(super) fn enclose(&self, theta: Interval) -> Places {
        let (sin, cos) = (theta.sin(), theta.cos());
        let sin_phi = sine((point(self.e) + point(self.r) * sin) * point(1.0 / self.l));
        let cos_phi = root(point(1.0) - sin_phi.square());
        let along = point(self.r) * cos;
        let per = cos_phi.reciprocal();
        Places {
            angle: sin_phi.rising(f64::asin),
            dangle: along * point(1.0 / self.l) * per,
            x: along + point(self.s * self.l) * cos_phi,
            dx: -(point(self.r) * sin) - point(self.s) * along * sin_phi * per,
        }
    }

    /// Returns the enclosed state of a motion over the crank angle; `by_place`: with x and x', where loads need them.
    pub fn seen(&self, reach: &Reach, by_place: bool) -> EnclosedState {
        let (x, dx) = if by_place {
            let places = self.enclose(reach.angle);
            (places.x, places.dx)
        } else {
            (Interval::WHOLE, Interval::WHOLE)
        };
        EnclosedState {
            t: reach.t,
            theta: reach.angle,
            omega: reach.speed,
            x,
            v: dx * reach.speed,
            dx,
        }
    }
}

impl Rocker {
    /// Encloses θ, θ', x and x' over coordinates.
    fn enclose(&self, linkage: &Linkage, q: Interval) -> Places {
        let (mirror, fold) = (point(self.mirror), point(self.fold));
        let quarter_less = q - point(FRAC_PI_2);
        let crank = self.crank.enclose(q);
        // cos q = sin(π/2 − q).
        let rod = self.rod.enclose(-quarter_less);
        let (r, l) = (point(linkage.r), point(linkage.l));
        let (dtheta, drod) = (mirror * crank.slope, mirror * fold * rod.slope);
        let (y, rod_y) = (-(r * mirror * crank.cos), l * mirror * rod.cos);
        Places {
            angle: mirror * (crank.angle - point(FRAC_PI_2)),
            dangle: dtheta,
            x: r * crank.sin + l * fold * rod.sin,
            dx: -(y * dtheta) - rod_y * drod,
        }
    }
}

impl Curve {
    fn enclose(&self, q: Interval) -> Places {
        let turns = point(self.turns * TAU);
        match &self.chart {
            Chart::Crank => Places {
                angle: q,
                dangle: point(1.0),
                ..self.linkage().enclose(q)
            },
            Chart::Rod(swapped) => {
                let places = swapped.enclose(q);
                let (angle, sign) = match swapped.s < 0.0 {
                    true => (point(PI) - places.angle, -1.0),
                    false => (places.angle, 1.0),
                };
                Places {
                    angle: angle + turns,
                    dangle: point(sign) * places.dangle,
                    ..places
                }
            }
            Chart::Rocker(rocker) => {
                let places = rocker.enclose(self.linkage(), q);
                Places {
                    angle: places.angle + turns,
                    ..places
                }
            }
        }
    }

    /// Returns the enclosed state of a motion over the coordinate; `by_place`: with x and x', always if q is not θ.
    pub fn seen(&self, reach: &Reach, by_place: bool) -> EnclosedState {
        if self.is_crank_angle() {
            return self.linkage().seen(reach, by_place);
        }
        let places = self.enclose(reach.angle);
        EnclosedState {
            t: reach.t,
            theta: places.angle,
            omega: places.dangle * reach.speed,
            x: places.x,
            v: places.dx * reach.speed,
            dx: places.dx,
        }
    }
}
