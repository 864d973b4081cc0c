//! Virtual displacements along the configuration curve and off the guide, and the work of inertia and weight over them.

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
        [
            VirtualDisplacement {
                theta: theta[0],
                p: path.dp,
                psi: path.dpsi,
                x: x[0],
            },
            VirtualDisplacement {
                theta: theta[1],
                p: path.d2p,
                psi: path.d2psi,
                x: x[1],
            },
        ]
    }

    /// Returns the displacement that lifts the slider pin by one off the guide with the least change of both angles,
    /// from the vectors of the crank, the rod and the arm of its centre of gravity.
    #[inline(always)]
    pub(super) fn aside(crank: [f64; 2], rod: [f64; 2], arm: [f64; 2]) -> VirtualDisplacement {
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
        let moved = rod.mass * (a.p[0] * b.p[0] + a.p[1] * b.p[1]);
        self.crank_inertia * a.theta * b.theta + (moved + turned) + self.slider_mass * (a.x * b.x)
    }

    /// Returns −Σ m g·p_a of gravity, for a slider that stays in its guide.
    #[inline(always)]
    pub(super) fn weight_over(&self, [cos, sin]: [f64; 2], a: &VirtualDisplacement) -> f64 {
        let weight = &self.weight;
        (weight.sine * sin + weight.cosine * cos) * a.theta
            - (weight.rod[0] * a.p[0] + weight.rod[1] * a.p[1])
            - weight.slider[0] * a.x
    }
}
