//! Configuration curve of a double rocker and of a change point, by half angles; see [`super::Curve`].

use std::f64::consts::{FRAC_PI_2, PI};

use super::linkage::SAME_LENGTHS;
use super::{Class, CurvePose, Linkage};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::Interval;
use crate::numeric::exact::sum3;

/// Half angles of crank and rod of a double rocker or a change point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rocker {
    pub(super) crank: HalfAngle,
    pub(super) rod: HalfAngle,
    /// −1 mirrors the mechanism about the x axis, for e < 0; else 1.
    pub(super) mirror: f64,
    /// −1 where crank and rod, of equal length, lie on top of each other and the slider is at O; else 1.
    pub(super) fold: f64,
}

/// Half angle a with sin a = root · (sine or cosine of q) and cos a > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HalfAngle {
    root: f64,
    /// 1 − root²; if zero, cos a takes the sign of the other function of q.
    rest: f64,
}

impl Rocker {
    /// Builds the half angles; at a change point lengths may count as equal. `folded`: crank and rod point apart.
    pub fn new(linkage: &Linkage, class: Class, folded: bool) -> Rocker {
        let Linkage { r, l, e, .. } = *linkage;
        let e = e.abs();
        // r − h and l − h, and h.
        let (beside_crank, beside_rod) = (0.5 * sum3(r, -l, e), 0.5 * sum3(l, -r, e));
        let h = 0.5 * sum3(l, -e, r);
        let exact = class == Class::ChangePoint;
        let half = |length: f64, beside: f64| {
            if exact && beside.abs() <= 2.0 * SAME_LENGTHS * (l + r) {
                HalfAngle {
                    root: 1.0,
                    rest: 0.0,
                }
            } else {
                HalfAngle {
                    root: (h / length).sqrt(),
                    rest: beside / length,
                }
            }
        };
        let (crank, rod) = (half(r, beside_crank), half(l, beside_rod));
        let both = crank.rest == 0.0 && rod.rest == 0.0;
        Rocker {
            crank,
            rod,
            mirror: if linkage.e < 0.0 { -1.0 } else { 1.0 },
            fold: if both && folded { -1.0 } else { 1.0 },
        }
    }

    /// Returns the coordinate q of a position.
    pub fn coordinate(&self, linkage: &Linkage, theta: f64, cos: f64, rod_cos: f64) -> f64 {
        let from_below = Angle::from(self.mirror * theta + FRAC_PI_2).reduced().rest;
        let sine = (0.5 * from_below).sin().abs() / self.crank.root;
        // l (1 − sin Φ) of the mirrored mechanism.
        let height = sum3(
            linkage.l,
            -linkage.e.abs(),
            -self.mirror * linkage.r * theta.sin(),
        );
        let cosine = (0.5 * height.max(0.0) / linkage.l).sqrt() / self.rod.root;
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        let (a, b) = (sign(cos), sign(rod_cos));
        let (s, c) = match (self.crank.rest == 0.0, self.rod.rest == 0.0) {
            (false, false) => (a, b),
            (true, false) => (a * b, b),
            (false, true) => (a, a * b),
            (true, true) => (a, 1.0),
        };
        (s * sine).atan2(c * cosine)
    }

    /// Returns the crank angle at coordinate q.
    pub fn crank_angle(&self, q: Angle) -> Angle {
        let (turns, half) = if self.crank.rest == 0.0 {
            (2.0 * q.turns, q.rest)
        } else {
            let (sin, cos) = q.rest.sin_cos();
            let cosine = self.crank.cosine(sin, cos);
            (0.0, (self.crank.root * sin).atan2(cosine))
        };
        Angle::new(self.mirror * turns, self.mirror * (2.0 * half - FRAC_PI_2))
    }

    /// Returns the branch points of both half angles as functions of a complex q, where a cosine vanishes: ±90° for the
    /// crank, 0 and 180° for the rod, and the distance from the real axis, rad; infinite where the cosine is that of q.
    pub fn branch_points(&self) -> [[f64; 2]; 4] {
        let height = |half: &HalfAngle| match half.rest {
            0.0 => f64::INFINITY,
            rest => (rest.sqrt() / half.root).asinh(),
        };
        let (crank, rod) = (height(&self.crank), height(&self.rod));
        [
            [-FRAC_PI_2, crank],
            [0.0, rod],
            [FRAC_PI_2, crank],
            [PI, rod],
        ]
    }

    pub fn pose(&self, linkage: &Linkage, q: f64) -> CurvePose {
        let (sin_q, cos_q) = q.sin_cos();
        let Rocker { mirror, fold, .. } = *self;
        let crank = self.crank.double(sin_q, cos_q);
        // cos q is the sine of 90° − q.
        let rod = self.rod.double(cos_q, sin_q);
        let (r, l) = (linkage.r, linkage.l);
        // θ = 2a − 90° and Φ = 90° − 2b, where b is a function of 90° − q: dΦ/dq = d(2b)/d(90° − q).
        let (sin, cos) = (-mirror * crank.cos, crank.sin);
        let (dtheta, d2theta) = (mirror * crank.d1, mirror * crank.d2);
        let (rod_sin, rod_cos) = (mirror * rod.cos, fold * rod.sin);
        let (drod, d2rod) = (mirror * fold * rod.d1, -mirror * fold * rod.d2);
        let (y, rod_y) = (r * sin, l * rod_sin);
        let (x, rod_x) = (r * cos, l * rod_cos);
        CurvePose {
            sin,
            cos,
            dtheta,
            d2theta,
            rod_sin,
            rod_cos,
            drod,
            d2rod,
            x: x + rod_x,
            dx: -y * dtheta - rod_y * drod,
            d2x: -(x * dtheta * dtheta + y * d2theta) - (rod_x * drod * drod + rod_y * d2rod),
        }
    }
}

/// Ranges of 2a, of its sine and cosine, and of its derivative with respect to the argument of the sine.
pub(super) struct DoubleRange {
    pub angle: Interval,
    pub sin: Interval,
    pub cos: Interval,
    pub slope: Interval,
}

/// Sine and cosine of 2a, and derivatives of 2a with respect to the argument of the sine.
struct Double {
    sin: f64,
    cos: f64,
    d1: f64,
    d2: f64,
}

impl HalfAngle {
    fn cosine(&self, sin: f64, cos: f64) -> f64 {
        if self.rest == 0.0 {
            cos
        } else {
            (cos * cos + self.rest * sin * sin).sqrt()
        }
    }

    /// Encloses 2a over arguments of the sine.
    pub(super) fn enclose(&self, q: Interval) -> DoubleRange {
        let point = Interval::point;
        let twice = point(2.0) * q;
        if self.rest == 0.0 {
            return DoubleRange {
                angle: twice,
                sin: twice.sin(),
                cos: twice.cos(),
                slope: point(2.0),
            };
        }
        let sine = point(self.root) * q.sin();
        // cos²a between 1 − root² and 1.
        let squared = point(1.0) - sine.square();
        let cosine = Interval::new(squared.low.max(self.rest), squared.high).rising(f64::sqrt);
        DoubleRange {
            angle: point(2.0) * sine.rising(f64::asin),
            sin: point(2.0) * sine * cosine,
            cos: point(1.0) - point(2.0) * sine.square(),
            slope: point(2.0 * self.root) * q.cos() * cosine.reciprocal(),
        }
    }

    fn double(&self, sin: f64, cos: f64) -> Double {
        let (sine, cosine) = (self.root * sin, self.cosine(sin, cos));
        let per = 1.0 / cosine;
        let (d1, d2) = match self.rest {
            0.0 => (2.0, 0.0),
            rest => (
                2.0 * self.root * cos * per,
                -2.0 * sine * rest * per * per * per,
            ),
        };
        Double {
            sin: 2.0 * sine * cosine,
            cos: 1.0 - 2.0 * sine * sine,
            d1,
            d2,
        }
    }
}
