//! Loop closure of the offset slider-crank in closed form.
//!
//! sin φ = (e + r sin θ)/l, x = r cos θ + s l cos φ, s = ±1 for the assembly branch.

use crate::numeric::exact::sum3;
use crate::scene::Geometry;

/// The lengths of the mechanism, ready for evaluation.
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
    /// l − e − r without rounding loss: how far the rod is from standing normal to the guide at θ = 90°.
    above: f64,
    /// l + e − r: the same at θ = −90°.
    below: f64,
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
    /// Rod inclination φ, rad, from sine and cosine: right to rounding also near ±90°.
    pub fn phi(&self) -> f64 {
        self.sin_phi.atan2(self.cos_phi)
    }

    /// Transmission angle, rad: between the rod and the normal of the guide, 90° − |φ|. No force passes
    /// from the slider to the crank's side of the rod where it is zero.
    pub fn transmission(&self) -> f64 {
        self.cos_phi.atan2(self.sin_phi.abs())
    }

    /// Whether the position exists away from a limit, that is, all values are finite.
    pub fn exists(&self) -> bool {
        self.d2x.is_finite()
    }
}

impl Linkage {
    /// The linkage of a scene's geometry.
    pub fn new(geometry: &Geometry) -> Linkage {
        let (r, l, e) = (geometry.crank, geometry.rod, geometry.offset);
        Linkage {
            r,
            l,
            e,
            s: geometry.branch.sign(),
            above: sum3(l, -e, -r),
            below: sum3(l, e, -r),
        }
    }

    /// The same linkage with another rod length, m.
    pub fn with_rod(&self, l: f64) -> Linkage {
        Linkage {
            l,
            above: sum3(l, -self.e, -self.r),
            below: sum3(l, self.e, -self.r),
            ..*self
        }
    }

    /// Least l − |e| − r, m: positive iff the crank can turn fully.
    pub fn margin(&self) -> f64 {
        self.above.min(self.below)
    }

    /// The position at crank angle θ (rad). Not finite where the rod does not reach the guide, and at the
    /// limit itself.
    ///
    /// l² cos²φ = (l − u)(l + u) with u = e + r sin θ; the smaller factor is formed from
    /// 1 ∓ sin θ = cos²θ/(1 ± sin θ) where the difference would cancel.
    pub fn pose(&self, theta: f64) -> Pose {
        let (sin, cos) = theta.sin_cos();
        self.pose_at(sin, cos)
    }

    /// The position at the crank angle of this sine and cosine.
    pub fn pose_at(&self, sin: f64, cos: f64) -> Pose {
        let Linkage { r, l, e, .. } = *self;
        let u = e + r * sin;
        let (mut minus, mut plus) = (l - u, l + u);
        if minus < 0.25 * l && sin > 0.0 {
            minus = self.above + r * (cos * cos / (1.0 + sin));
        } else if plus < 0.25 * l && sin < 0.0 {
            plus = self.below + r * (cos * cos / (1.0 - sin));
        }
        self.pose_of(sin, cos, minus, plus)
    }

    /// Whether [`Self::pose_far_from_limits`] serves all crank angles.
    pub(super) fn stays_far_from_limits(&self) -> bool {
        self.margin() >= 0.25 * self.l
    }

    /// The same as [`Self::pose_at`] without its cases, for many positions side by side.
    #[inline(always)]
    pub(super) fn pose_far_from_limits(&self, sin: f64, cos: f64) -> Pose {
        let u = self.e + self.r * sin;
        self.pose_of(sin, cos, self.l - u, self.l + u)
    }

    /// The position with l − u and l + u, u = e + r sin θ.
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

    /// φ''' and x''' (m/rad³) at a position.
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
