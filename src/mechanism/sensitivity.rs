//! Derivatives of the motion with respect to the lengths of the mechanism, in closed form.
//!
//! With u = e + r sin θ, W = l cos φ and a subscript for the length: W W_p = l l_p − u u_p, and this equation
//! differentiated once and twice with respect to the crank angle.

use super::{Linkage, Pose};

named! {
    /// A length of the mechanism, named and in order as in the scene file.
    pub enum Length {
        /// Crank length r.
        Crank = "crank",
        /// Rod length l.
        Rod = "rod",
        /// Offset e.
        Offset = "offset",
    }
}

impl Length {
    /// Returns the derivatives of (r, l, e) with respect to this length.
    fn unit(self) -> [f64; 3] {
        let mut unit = [0.0; 3];
        unit[self as usize] = 1.0;
        unit
    }
}

/// Derivatives of a [`Pose`] with respect to one length, the crank angle held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseSlope {
    /// Derivative of x, dimensionless
    pub x: f64,
    /// Derivative of x', 1/rad
    pub dx: f64,
    /// Derivative of x'', 1/rad²
    pub d2x: f64,
    /// Derivative of φ', 1/m
    pub dphi: f64,
    /// Derivative of φ'', 1/m
    pub d2phi: f64,
    /// Derivatives of the unit vector from crank pin to wrist pin and of its first two derivatives along θ, 1/m.
    pub(super) axis: [[f64; 2]; 3],
    /// Derivative of the crank length.
    pub(super) crank: f64,
}

impl Linkage {
    /// Computes the derivatives of a position with respect to a length, at constant crank angle:
    /// dx/dr = cos(θ + φ)/cos φ, dx/dl = 1/cos φ, dx/de = −tan φ on the right branch, and the others.
    pub fn slope(&self, pose: &Pose, length: Length) -> PoseSlope {
        let Linkage { r, l, e, s, .. } = *self;
        let [r_p, l_p, e_p] = length.unit();
        let (sin, cos) = (pose.sin, pose.cos);
        // u and W with their derivatives along θ, then the derivatives of all with respect to the length.
        let (u, w) = (e + r * sin, l * pose.cos_phi);
        let (du, d2u) = (r * cos, -r * sin);
        let dw = -u * du / w;
        let d2w = -(du * du + u * d2u + dw * dw) / w;
        let (u_p, du_p, d2u_p) = (e_p + r_p * sin, r_p * cos, -r_p * sin);
        let w_p = (l * l_p - u * u_p) / w;
        let dw_p = -(u_p * du + u * du_p + w_p * dw) / w;
        let d2w_p = -(2.0 * du * du_p + u_p * d2u + u * d2u_p + 2.0 * dw * dw_p + w_p * d2w) / w;
        let dphi_p = (du_p - pose.dphi * w_p) / w;
        let d2phi_p = (d2u_p - dw_p * pose.dphi - dw * dphi_p - w_p * pose.d2phi) / w;
        // sin φ = u/l and cos φ = W/l; (a/l)_p = (a_p − a l_p/l)/l.
        let over_l = |a: f64, a_p: f64| (a_p - a * l_p / l) / l;
        let axis = [
            [s * over_l(w, w_p), -over_l(u, u_p)],
            [s * over_l(dw, dw_p), -over_l(du, du_p)],
            [s * over_l(d2w, d2w_p), -over_l(d2u, d2u_p)],
        ];
        PoseSlope {
            x: r_p * cos + s * w_p,
            dx: -r_p * sin + s * dw_p,
            d2x: -r_p * cos + s * d2w_p,
            dphi: dphi_p,
            d2phi: d2phi_p,
            axis,
            crank: r_p,
        }
    }
}
