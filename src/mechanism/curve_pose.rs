//! Position of the mechanism on its configuration curve, with derivatives along the curve.

use super::{Body, Linkage, Path, Pose};

/// Position with two derivatives with respect to q (a dash); q, like θ and Φ, is an angle in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePose {
    /// sin θ
    pub sin: f64,
    /// cos θ
    pub cos: f64,
    /// θ'
    pub dtheta: f64,
    /// θ''
    pub d2theta: f64,
    /// sin Φ; the rod points along (cos Φ, −sin Φ).
    pub rod_sin: f64,
    /// cos Φ, with the sign of the branch; zero at a limit.
    pub rod_cos: f64,
    /// Φ'
    pub drod: f64,
    /// Φ''
    pub d2rod: f64,
    /// Slider position x, m.
    pub x: f64,
    /// x', m.
    pub dx: f64,
    /// x'', m.
    pub d2x: f64,
}

impl CurvePose {
    /// Returns the position of a linkage at a crank angle, with this angle as the coordinate.
    #[inline(always)]
    pub(super) fn of(linkage: &Linkage, pose: &Pose) -> CurvePose {
        let s = linkage.s;
        CurvePose {
            sin: pose.sin,
            cos: pose.cos,
            dtheta: 1.0,
            d2theta: 0.0,
            rod_sin: pose.sin_phi,
            rod_cos: s * pose.cos_phi,
            drod: s * pose.dphi,
            d2rod: s * pose.d2phi,
            x: pose.x,
            dx: pose.dx,
            d2x: pose.d2x,
        }
    }

    /// Returns the position with crank and rod exchanged.
    pub(super) fn exchanged(self) -> CurvePose {
        CurvePose {
            sin: self.rod_sin,
            cos: self.rod_cos,
            dtheta: self.drod,
            d2theta: self.d2rod,
            rod_sin: self.sin,
            rod_cos: self.cos,
            drod: self.dtheta,
            d2rod: self.d2theta,
            ..self
        }
    }

    /// Returns the path of a body on the rod with respect to the coordinate.
    pub(super) fn rod_path(&self, linkage: &Linkage, body: &Body) -> Path {
        let crank = [self.cos, self.sin].map(|part| linkage.r * part);
        let pin = Path::turning(crank, [self.dtheta, self.d2theta]);
        let arm = body.arm([self.rod_cos, -self.rod_sin]);
        pin.carrying(&Path::turning(arm, [-self.drod, -self.d2rod]))
    }

    /// Returns the rod inclination φ in [−90°, 90°], rad, as [`super::Pose::phi`].
    pub fn phi(&self) -> f64 {
        self.rod_sin.atan2(self.rod_cos.abs())
    }
}
