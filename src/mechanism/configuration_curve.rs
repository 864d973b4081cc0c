//! Configuration curve: a coordinate for all connected positions, also where the crank cannot turn fully.
//!
//! The rod points along (cos Φ, −sin Φ) from A: e + r sin θ = l sin Φ, x = r cos θ + l cos Φ, where cos Φ
//! changes its sign with the assembly branch. The solutions (θ, Φ) form closed curves, and each has a
//! coordinate q of period 2π in closed form, regular also where the rod stands normal to the guide:
//!
//! - rotating crank: q = θ; rotating rod: q = Φ;
//! - double rocker with e > 0: the height of A above the guide lies between e − r and l. With
//!   h = (l − e + r)/2 it is e − r + 2 h sin²q, so that
//!   sin((θ + 90°)/2) = √(h/r) sin q and sin((90° − Φ)/2) = √(h/l) cos q;
//! - at a change point h/r = 1 or h/l = 1: there cos((θ + 90°)/2) = cos q, or cos((90° − Φ)/2) = sin q, with
//!   their signs, for the motion that keeps all velocities continuous.

use std::f64::consts::{PI, TAU};

use super::extremes::shown_distance;
use super::linkage::SAME_LENGTHS;
use super::rocker::Rocker;
use super::{Class, CurvePose, Linkage};
use crate::numeric::angle::Angle;

/// Connected set of positions of a mechanism, with a coordinate q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Linkage.
    pub linkage: Linkage,
    pub(super) chart: Chart,
    /// Whole turns of the crank that are added to the angle of the chart.
    pub(super) turns: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Chart {
    /// q = θ.
    Crank,
    /// q = Φ; the linkage with crank and rod exchanged.
    Rod(Linkage),
    Rocker(Rocker),
}

impl Curve {
    /// Returns the curve through crank angle `theta` (rad) on the linkage's branch, and the coordinate of that
    /// position. None where no position exists, and at the crossing of a change point, which lies on two curves.
    pub fn through(linkage: &Linkage, theta: Angle) -> Option<(Curve, Angle)> {
        let class = Class::of(linkage);
        let pose = linkage.pose(theta.rest);
        if !pose.cos_phi.is_finite() {
            return None;
        }
        let rod_cos = linkage.s * pose.cos_phi;
        let mut curve = Curve::on_crank(linkage);
        match class {
            Class::RotatingCrank => return Some((curve, theta)),
            Class::RotatingRod => {
                curve.chart = Chart::Rod(linkage.exchanged(pose.cos.signum()));
                let q = Angle::from(pose.sin_phi.atan2(rod_cos));
                return Some((curve.started_at(q, theta), q));
            }
            Class::DoubleRocker | Class::ChangePoint => {}
        }
        // A limit is a crossing only where the crank, too, is normal to the guide.
        let is_limit = pose.cos_phi <= SAME_LENGTHS.sqrt();
        if class == Class::ChangePoint && is_limit && pose.cos.abs() < 1e-6 {
            return None;
        }
        let rocker = Rocker::new(linkage, class, pose.cos * rod_cos < 0.0);
        let q = Angle::from(rocker.coordinate(linkage, theta.rest, pose.cos, rod_cos));
        curve.chart = Chart::Rocker(rocker);
        Some((curve.started_at(q, theta), q))
    }

    /// Returns the curve with the crank angle as its coordinate, for any class.
    pub fn on_crank(linkage: &Linkage) -> Curve {
        Curve {
            linkage: *linkage,
            chart: Chart::Crank,
            turns: 0.0,
        }
    }

    fn started_at(mut self, q: Angle, theta: Angle) -> Curve {
        let off = theta.minus(self.crank_angle(q)) / TAU;
        self.turns = off.round();
        self
    }

    /// Whether the coordinate is the crank angle.
    pub fn is_crank_angle(&self) -> bool {
        matches!(self.chart, Chart::Crank)
    }

    /// Returns a description of the coordinate, for outputs.
    pub fn coordinate(&self) -> &'static str {
        match self.chart {
            Chart::Crank => "crank angle theta",
            Chart::Rod(_) => "rod angle, as the rod turns fully and the crank does not",
            Chart::Rocker(_) => {
                "position on the configuration curve, as neither crank nor rod turns fully"
            }
        }
    }

    /// Returns the crank angle at coordinate q (rad), unwrapped along the motion.
    pub fn crank_angle(&self, q: Angle) -> Angle {
        match &self.chart {
            Chart::Crank => q,
            Chart::Rod(swapped) => {
                let inclination = swapped.pose(q.rest).phi();
                let rest = match swapped.s < 0.0 {
                    true => PI - inclination,
                    false => inclination,
                };
                Angle::new(self.turns, rest)
            }
            Chart::Rocker(rocker) => {
                let angle = rocker.crank_angle(q);
                Angle::new(self.turns + angle.turns, angle.rest)
            }
        }
    }

    /// Returns the position at coordinate q, rad.
    pub fn pose(&self, q: f64) -> CurvePose {
        match &self.chart {
            Chart::Crank => CurvePose::of(&self.linkage, &self.linkage.pose(q)),
            Chart::Rod(swapped) => CurvePose::of(swapped, &swapped.pose(q)).exchanged(),
            Chart::Rocker(rocker) => rocker.pose(&self.linkage, q),
        }
    }

    /// Returns the distance (rad) from coordinate q at which the next sample of a function of the position shows all that
    /// it does between them; infinite where no branch point is near or far.
    pub fn shown_distance(&self, q: f64) -> f64 {
        match &self.chart {
            Chart::Crank => self.linkage.shown_distance(q),
            Chart::Rod(swapped) => swapped.shown_distance(q),
            Chart::Rocker(rocker) => shown_distance(q, rocker.branch_points()),
        }
    }
}
