//! Enclosed state over a piece of a motion: intervals of time, angle, speed, slider position and velocity.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::configuration_curve::Chart;
use super::rocker::Rocker;
use super::{Curve, Linkage};
use crate::numeric::enclosure::{Interval, MotionPiece};

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

/// What loads make of the slider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SliderUse {
    /// Nothing.
    Untouched,
    /// They move it, and do not depend on its position or velocity.
    Moved,
    /// They depend on its position or velocity.
    Read,
}

/// Effects of a unit load.
#[derive(Clone, Copy, Debug, Default)]
pub struct UnitLoadEffects {
    /// Effect of a torque, per N m.
    pub torque: f64,
    /// Effect of a slider force, per N.
    pub force: f64,
}

impl EnclosedState {
    /// Returns the effects on the generalized force over the crank angle: Q = τ + F x'.
    pub fn unit_load_effects(&self) -> UnitLoadEffects {
        UnitLoadEffects {
            torque: 1.0,
            force: self.dx.largest(),
        }
    }
}

impl UnitLoadEffects {
    /// Returns the sums of the magnitudes of two effects, for loads that act in two ways.
    pub fn plus(self, other: UnitLoadEffects) -> UnitLoadEffects {
        UnitLoadEffects {
            torque: self.torque.abs() + other.torque.abs(),
            force: self.force.abs() + other.force.abs(),
        }
    }

    /// Returns the larger magnitudes of the effects at two positions.
    pub fn larger(self, other: UnitLoadEffects) -> UnitLoadEffects {
        UnitLoadEffects {
            torque: self.torque.abs().max(other.torque.abs()),
            force: self.force.abs().max(other.force.abs()),
        }
    }
}

/// Ranges of a position over a range of a coordinate q.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseRanges {
    /// Angle at q, rad: φ of a linkage, θ of a curve.
    pub angle: Interval,
    /// Derivative of the angle with respect to q.
    pub dangle: Interval,
    /// Slider position, m.
    pub x: Interval,
    /// x', m/rad.
    pub dx: Interval,
}

impl Linkage {
    /// Encloses φ, φ', x, x' = −r sin(θ + sφ)/cos φ over crank angles; `by_sense`: x' by its sign between dead centres.
    pub(super) fn enclose(&self, theta: Interval, by_sense: bool) -> PoseRanges {
        let point = Interval::point;
        let (sin, cos) = (theta.sin(), theta.cos());
        let sin_phi = (point(self.e) + point(self.r) * sin) * point(1.0 / self.l);
        let sin_phi = Interval::new(sin_phi.low.max(-1.0), sin_phi.high.min(1.0));
        let squared = point(1.0) - sin_phi.square();
        let cos_phi = Interval::new(squared.low.max(0.0), squared.high.max(0.0)).rising(f64::sqrt);
        let along = point(self.r) * cos;
        let per = cos_phi.reciprocal();
        let x = along + point(self.s * self.l) * cos_phi;
        let (x, dx) = match by_sense && self.margin() > 0.0 {
            true => self.between_dead_centres(theta, x, per),
            false => {
                let of_rod = point(self.s) * along * sin_phi * per;
                (x, -(point(self.r) * sin) - of_rod)
            }
        };
        PoseRanges {
            angle: sin_phi.rising(f64::asin),
            dangle: along * point(1.0 / self.l) * per,
            x,
            dx,
        }
    }

    /// Encloses x and x' for a crank that turns fully, from those of x and 1/cos φ. Between dead centres x is monotone.
    fn between_dead_centres(
        &self,
        theta: Interval,
        x: Interval,
        per: Interval,
    ) -> (Interval, Interval) {
        let dx = -(Interval::point(self.r) * self.sine_of_dead_centre(theta) * per);
        let [low, high] = [theta.low, theta.high].map(|theta| self.pose(theta).x);
        match dx.contains(0.0) {
            true => (x, dx),
            false => (Interval::between(low, high), dx),
        }
    }

    /// Encloses sin(θ + sφ) for a crank that turns fully: θ + sφ rises with θ, and the sine keeps its sign between dead
    /// centres, whose angles are rounded. The zeros there, and what rounding makes of them, are left out.
    fn sine_of_dead_centre(&self, theta: Interval) -> Interval {
        let from_line = |theta: f64| theta + self.s * self.pose(theta).phi();
        let (low, high) = (from_line(theta.low), from_line(theta.high));
        let sin = Interval::new(low, high).sin();
        let half_turns = (0.5 * (low + high) / PI).floor();
        let rounding = |theta: f64| {
            let condition = 1.0 + self.pose(theta).dphi.abs();
            4.0 * f64::EPSILON * theta.abs().max(1.0) * condition
        };
        let begins = low >= half_turns * PI - rounding(theta.low);
        let ends = high <= (half_turns + 1.0) * PI + rounding(theta.high);
        match begins && ends {
            true if half_turns.rem_euclid(2.0) == 0.0 => sin.rising(|x| x.max(f64::EPSILON)),
            true => sin.rising(|x| x.min(-f64::EPSILON)),
            false => sin,
        }
    }

    /// Returns the enclosed state of a motion over the crank angle, with x and x' if loads need them.
    pub fn enclosed_state(&self, piece: &MotionPiece, slider: SliderUse) -> EnclosedState {
        let by_sense = slider == SliderUse::Read;
        let ranges = (slider != SliderUse::Untouched).then(|| self.enclose(piece.angle, by_sense));
        let [x, dx] = ranges.map_or([Interval::WHOLE; 2], |ranges| [ranges.x, ranges.dx]);
        EnclosedState {
            t: piece.t,
            theta: piece.angle,
            omega: piece.speed,
            x,
            v: dx * piece.speed,
            dx,
        }
    }
}

impl Rocker {
    /// Encloses θ, θ', x and x' over coordinates.
    fn enclose(&self, linkage: &Linkage, q: Interval) -> PoseRanges {
        let point = Interval::point;
        let (mirror, fold) = (point(self.mirror), point(self.fold));
        let crank = self.crank.enclose(q);
        // cos q = sin(π/2 − q).
        let rod = self.rod.enclose(point(FRAC_PI_2) - q);
        let (r, l) = (point(linkage.r), point(linkage.l));
        let (dtheta, drod) = (mirror * crank.slope, mirror * fold * rod.slope);
        let (y, rod_y) = (-(r * mirror * crank.cos), l * mirror * rod.cos);
        PoseRanges {
            angle: mirror * (crank.angle - point(FRAC_PI_2)),
            dangle: dtheta,
            x: r * crank.sin + l * fold * rod.sin,
            dx: -(y * dtheta) - rod_y * drod,
        }
    }
}

impl Curve {
    /// Returns the enclosed state of a motion over the coordinate, with x and x' if loads need them or q is not θ.
    pub fn enclosed_state(&self, piece: &MotionPiece, slider: SliderUse) -> EnclosedState {
        let point = Interval::point;
        let ranges = match &self.chart {
            Chart::Crank => return self.linkage.enclosed_state(piece, slider),
            Chart::Rod(swapped) => {
                let ranges = swapped.enclose(piece.angle, true);
                match swapped.s < 0.0 {
                    true => PoseRanges {
                        angle: point(PI) - ranges.angle,
                        dangle: -ranges.dangle,
                        ..ranges
                    },
                    false => ranges,
                }
            }
            Chart::Rocker(rocker) => rocker.enclose(&self.linkage, piece.angle),
        };
        EnclosedState {
            t: piece.t,
            theta: ranges.angle + point(self.turns * TAU),
            omega: ranges.dangle * piece.speed,
            x: ranges.x,
            v: ranges.dx * piece.speed,
            dx: ranges.dx,
        }
    }
}
