//! Virtual displacements along the configuration curve and off the guide, and the work of inertia and weight over them.

use super::plane::dot;
use super::{Equation, Path};

/// Derivatives of θ, rod centre of gravity p, rod direction ψ and x in one direction, or second ones along the curve.
pub(super) struct VirtualDisplacement {
    pub theta: f64,
    pub p: [f64; 2],
    pub psi: f64,
    pub x: f64,
}

impl VirtualDisplacement {
    /// Returns the first and second derivatives along the curve.
    #[inline(always)]
    pub(super) fn along(theta: [f64; 2], path: &Path, x: [f64; 2]) -> [VirtualDisplacement; 2] {
        let one = |theta, p, psi, x| VirtualDisplacement { theta, p, psi, x };
        [
            one(theta[0], path.dp, path.dpsi, x[0]),
            one(theta[1], path.d2p, path.d2psi, x[1]),
        ]
    }

    /// Returns the displacement that lifts the slider pin by one off the guide with the least change of both angles,
    /// from the vectors of the crank, the rod and the arm of its centre of gravity.
    #[inline(always)]
    pub(super) fn off_guide(crank: [f64; 2], rod: [f64; 2], arm: [f64; 2]) -> VirtualDisplacement {
        let squared = crank[0] * crank[0] + rod[0] * rod[0];
        let (theta, psi) = (crank[0] / squared, rod[0] / squared);
        VirtualDisplacement {
            theta,
            p: [
                -theta * crank[1] - psi * arm[1],
                theta * crank[0] + psi * arm[0],
            ],
            psi,
            x: -theta * crank[1] - psi * rod[1],
        }
    }
}

impl Equation {
    /// Returns Σ m p_a·p_b + I ψ_a ψ_b over all bodies.
    #[inline(always)]
    pub(super) fn inertia_over(&self, a: &VirtualDisplacement, b: &VirtualDisplacement) -> f64 {
        let rod = &self.rod;
        let turned = rod.inertia * a.psi * b.psi;
        let moved = rod.mass * dot(a.p, b.p);
        self.crank_inertia * a.theta * b.theta + (moved + turned) + self.slider_mass * (a.x * b.x)
    }

    /// Returns −Σ m g·p_a of gravity, for a slider that stays in its guide.
    #[inline(always)]
    pub(super) fn weight_over(&self, [cos, sin]: [f64; 2], a: &VirtualDisplacement) -> f64 {
        let weight = &self.weight;
        (weight.sine * sin + weight.cosine * cos) * a.theta
            - dot(weight.rod, a.p)
            - weight.slider[0] * a.x
    }
}
