//! Loop closure of the offset slider-crank in closed form: position and derivatives from the crank angle.
//!
//! sin φ = (e + r sin θ)/l, x = r cos θ + s l cos φ, s = ±1 for the assembly branch.

use crate::numeric::exact::sum3;
use crate::scene::Geometry;

/// Difference of lengths, as a part of crank plus rod, below which they count as equal: reading rod, crank and offset
/// rounds it by ε of that sum at most, and by 3 ε where the unit is no power of ten of a metre, like an inch.
pub(super) const SAME_LENGTHS: f64 = 4.0 * f64::EPSILON;

/// Lengths of the mechanism, with the sums that an evaluation needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linkage {
    /// Crank length r, m.
    pub r: f64,
    /// Rod length l, m.
    pub l: f64,
    /// Offset e, m.
    pub e: f64,
    /// Branch sign s.
    pub s: f64,
    /// Height that A may rise until the rod stands normal to the guide, m, at θ = 90°, 0 and −90°: l − e − r, l − e and
    /// l − e + r, each rounded once.
    pub(super) above: [f64; 3],
    /// Depth that A may fall until the rod is normal to the guide, m, at θ = −90°, 0, 90°: l + e − r, l + e, l + e + r.
    pub(super) below: [f64; 3],
}

/// Returns a − r, a and a + r for a = l − e, each rounded once.
fn heights(l: f64, e: f64, r: f64) -> [f64; 3] {
    [sum3(l, -e, -r), l - e, sum3(l, -e, r)]
}

/// Position of the mechanism and its derivatives with respect to the crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// sin θ
    pub sin: f64,
    /// cos θ
    pub cos: f64,
    /// sin φ
    pub sin_phi: f64,
    /// cos φ
    pub cos_phi: f64,
    /// φ'
    pub dphi: f64,
    /// φ''
    pub d2phi: f64,
    /// Slider position x, m.
    pub x: f64,
    /// x', m/rad.
    pub dx: f64,
    /// x'', m/rad².
    pub d2x: f64,
}

impl Pose {
    /// Returns the rod inclination φ, rad, from sine and cosine: accurate to rounding also near ±90°.
    pub fn phi(&self) -> f64 {
        self.sin_phi.atan2(self.cos_phi)
    }

    /// Returns the transmission angle, rad, between the rod and the normal of the guide: 90° − |φ|. Where it is zero,
    /// no force passes from the slider along the rod to the crank.
    pub fn transmission(&self) -> f64 {
        self.cos_phi.atan2(self.sin_phi.abs())
    }

    /// Whether the position exists and is not at a limit, that is, all values are finite.
    pub fn is_regular(&self) -> bool {
        self.d2x.is_finite()
    }
}

impl Linkage {
    /// Builds the linkage of a scene's geometry.
    pub fn new(geometry: &Geometry) -> Linkage {
        let (r, l, e) = (geometry.crank, geometry.rod, geometry.offset);
        Linkage::of(r, l, e, geometry.branch.sign())
    }

    fn of(r: f64, l: f64, e: f64, s: f64) -> Linkage {
        let (above, below) = (heights(l, e, r), heights(l, -e, r));
        Linkage {
            r,
            l,
            e,
            s,
            above,
            below,
        }
    }

    /// Returns the linkage with another rod length, m.
    pub fn with_rod(&self, l: f64) -> Linkage {
        Linkage::of(self.r, l, self.e, self.s)
    }

    /// Returns the linkage whose reach ends where the guide locks itself by a friction coefficient μ, none if it locks
    /// nowhere: μ |tan φ| = 1 where |e + r sin θ| = l/sqrt(1 + μ²).
    pub fn unlocked(&self, mu: f64) -> Option<Linkage> {
        let shorter = self.with_rod(self.l / mu.hypot(1.0));
        (mu > 0.0 && shorter.margin() <= 0.0).then_some(shorter)
    }

    /// Returns the linkage with crank and rod exchanged: r sin θ = l sin Φ − e. `s` is the sign of cos θ.
    pub(super) fn exchanged(&self, s: f64) -> Linkage {
        Linkage::of(self.l, self.r, -self.e, s)
    }

    /// Whether the rod reaches the guide at crank angle `theta` (rad), to rounding.
    pub fn reaches(&self, theta: f64) -> bool {
        let height = (self.e + self.r * theta.sin()).abs();
        height <= self.l + SAME_LENGTHS * (self.l + self.r)
    }

    /// Returns the distance of the lengths from a change point l = r + |e| or r = l + |e|, in crank lengths.
    pub fn nearness_to_change_point(&self) -> f64 {
        let e = self.e.abs();
        sum3(self.l, -e, -self.r)
            .abs()
            .min(sum3(self.r, -e, -self.l).abs())
            / self.r
    }

    /// Returns l − |e| − r, m: positive iff the crank can turn fully.
    pub fn margin(&self) -> f64 {
        self.above[0].min(self.below[0])
    }

    /// Returns the position at crank angle θ (rad); not finite at a limit and where the rod does not reach the guide.
    ///
    /// l² cos²φ = (l − u)(l + u) with u = e + r sin θ. Both factors are counted from the nearest of the crank angles
    /// 90°, 0 and −90°, with 1 ∓ sin θ = cos²θ/(1 ± sin θ): neither does the difference of l and u cancel nor does a
    /// large offset take digits.
    pub fn pose(&self, theta: f64) -> Pose {
        let (sin, cos) = theta.sin_cos();
        self.pose_at(sin, cos)
    }

    /// Returns the position at the crank angle of this sine and cosine.
    #[inline]
    pub fn pose_at(&self, sin: f64, cos: f64) -> Pose {
        let Linkage { r, .. } = *self;
        let (up, down) = (&self.above, &self.below);
        let (minus, plus) = if sin > 0.5 {
            let fall = r * (cos * cos / (1.0 + sin));
            (up[0] + fall, down[2] - fall)
        } else if sin < -0.5 {
            let rise = r * (cos * cos / (1.0 - sin));
            (up[2] - rise, down[0] + rise)
        } else {
            (up[1] - r * sin, down[1] + r * sin)
        };
        self.pose_of(sin, cos, minus, plus)
    }

    /// Whether [`Self::pose_far_from_limits`] serves all crank angles.
    pub(super) fn stays_far_from_limits(&self) -> bool {
        self.margin() >= 0.25 * self.l
    }

    /// Returns the pose as [`Self::pose_at`], without branches for vectorisation.
    #[inline(always)]
    pub(super) fn pose_far_from_limits(&self, sin: f64, cos: f64) -> Pose {
        let u = self.e + self.r * sin;
        self.pose_of(sin, cos, self.l - u, self.l + u)
    }

    /// Returns the position from l − u and l + u, u = e + r sin θ.
    #[inline(always)]
    fn pose_of(&self, sin: f64, cos: f64, minus: f64, plus: f64) -> Pose {
        let Linkage { r, l, e, s, .. } = *self;
        let u = e + r * sin;
        let w = (minus * plus).sqrt();
        let per_w = 1.0 / w;
        let dphi = r * cos * per_w;
        let d2phi = (u * dphi * dphi - r * sin) * per_w;
        Pose {
            sin,
            cos,
            sin_phi: u / l,
            cos_phi: w / l,
            dphi,
            d2phi,
            x: r * cos + s * w,
            dx: -r * sin - s * u * dphi,
            d2x: -r * cos - s * (r * cos * dphi + u * d2phi),
        }
    }

    /// Returns φ''' and x''' (m/rad³) at a position.
    #[inline]
    pub fn third_derivatives(&self, pose: &Pose) -> (f64, f64) {
        let u = self.l * pose.sin_phi;
        let w = self.l * pose.cos_phi;
        let (r_sin, r_cos) = (self.r * pose.sin, self.r * pose.cos);
        let (d1, d2) = (pose.dphi, pose.d2phi);
        let d3phi = (3.0 * u * d1 * d2 - r_cos * (1.0 - d1 * d1)) / w;
        let d3x = r_sin - self.s * (2.0 * r_cos * d2 - r_sin * d1 + u * d3phi);
        (d3phi, d3x)
    }
}
