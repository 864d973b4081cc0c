//! Bodies: each enters the equation by the path p(θ) of a point and its turn angle ψ(θ), with two derivatives each.

use super::{Linkage, Pose};
use crate::scene::{RodModel, Scene};

/// Mass, centre of gravity and moment of inertia of a body on its link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of gravity along the link, from the end at which the link begins, m.
    pub along: f64,
    /// Centre of gravity to the left of the link, m.
    pub lateral: f64,
    /// Moment of inertia about the centre of gravity, kg m²; for a crank about O.
    pub inertia: f64,
}

impl Body {
    /// Returns the rod of a scene as one body that carries forces; none for the model `spin-only`, without translation.
    pub(super) fn rod(scene: &Scene) -> Option<Body> {
        let rod = scene.rod.unwrap_or_default();
        let inertia = match rod.model {
            RodModel::Massless => return Some(Body::default()),
            RodModel::Rigid => rod.central_inertia().max(0.0),
            // Moment of inertia of two masses at the pins about their centre of gravity.
            RodModel::TwoMass => rod.mass * rod.cg * (scene.geometry.rod - rod.cg),
            RodModel::SpinOnly => return None,
        };
        Some(Body {
            mass: rod.mass,
            along: rod.cg,
            lateral: rod.cg_lateral,
            inertia,
        })
    }

    /// Returns the centre of gravity from the beginning of the link, m, for the direction of the link (a unit vector).
    pub(super) fn arm(&self, [cos, sin]: [f64; 2]) -> [f64; 2] {
        [
            self.along * cos - self.lateral * sin,
            self.along * sin + self.lateral * cos,
        ]
    }
}

/// Derivatives of the path and the turn angle of a body with respect to the crank angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Path {
    /// p', m/rad
    pub dp: [f64; 2],
    /// p'', m/rad²
    pub d2p: [f64; 2],
    /// ψ'
    pub dpsi: f64,
    /// ψ''
    pub d2psi: f64,
}

impl Path {
    /// Returns the path of a point at (along, lateral) of the rod: A plus the point in the rod's axes d = (s cos φ,
    /// −sin φ), n = (sin φ, s cos φ), which turn by ψ' = −s φ'.
    #[inline(always)]
    pub fn on_rod(linkage: &Linkage, pose: &Pose, along: f64, lateral: f64) -> Path {
        let s = linkage.s;
        let (dx, dy) = (s * pose.cos_phi, -pose.sin_phi);
        // Vector from A to the point.
        let (gx, gy) = (along * dx - lateral * dy, along * dy + lateral * dx);
        let (dpsi, d2psi) = (-s * pose.dphi, -s * pose.d2phi);
        let (ax, ay) = (linkage.r * pose.cos, linkage.r * pose.sin);
        let squared = dpsi * dpsi;
        Path {
            dp: [-ay - dpsi * gy, ax + dpsi * gx],
            d2p: [
                -ax - d2psi * gy - squared * gx,
                -ay + d2psi * gx - squared * gy,
            ],
            dpsi,
            d2psi,
        }
    }

    /// Returns the path of the tip of a turning arm, from the first and second derivative of the arm's angle.
    pub fn turning([x, y]: [f64; 2], [first, second]: [f64; 2]) -> Path {
        Path {
            dp: [-y * first, x * first],
            d2p: [
                -y * second - x * first * first,
                x * second - y * first * first,
            ],
            dpsi: first,
            d2psi: second,
        }
    }

    /// Returns the path of a body that hangs on the tip of this arm and turns as `arm` does.
    pub(super) fn carrying(&self, arm: &Path) -> Path {
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Path {
            dp: sum(self.dp, arm.dp),
            d2p: sum(self.d2p, arm.d2p),
            ..*arm
        }
    }
}

/// Coefficients of V' = sine·sin θ + cosine·cos θ − rod weight · p' − slider weight · (x', 0).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Weight {
    pub sine: f64,
    pub cosine: f64,
    pub rod: [f64; 2],
    pub slider: [f64; 2],
}

impl Weight {
    /// Adds a mass (kg) on the crank, at a place along it and to its left (m), to V' = −Σ m g·p'.
    pub fn add_on_crank(&mut self, [gx, gy]: [f64; 2], mass: f64, [along, lateral]: [f64; 2]) {
        self.sine += mass * (gx * along + gy * lateral);
        self.cosine += mass * (gx * lateral - gy * along);
    }
}
