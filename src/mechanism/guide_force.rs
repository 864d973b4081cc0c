//! The normal force at the guide of a crank that turns, and what friction adds to the force that drives the crank.

use super::CurveTerms;
use super::{Equation, Path, Terms};

/// The normal force as it would be without friction: N = place + torque·τ + force·F + square·ω², with the loads
/// τ (torque on the crank) and F (force on the slider).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Normal {
    /// N
    pub place: f64,
    /// 1/m
    pub torque: f64,
    /// κ = dN/dF, dimensionless
    pub force: f64,
    /// N s²/rad²
    pub square: f64,
    /// x', m/rad
    dx: f64,
}

impl CurveTerms {
    /// The normal force where the coordinate is the crank angle.
    pub fn normal(&self) -> Normal {
        let share = self.a / self.m;
        Normal {
            place: self.dv_n - share * self.dv,
            torque: share - self.theta_n,
            force: share * self.place.dx - self.x_n,
            square: self.b - share * self.half_dm,
            dx: self.place.dx,
        }
    }
}

impl Equation {
    /// The normal force at a position: as [`CurveTerms::normal`] gives it, to rounding, for many positions side by side.
    #[inline(always)]
    pub(super) fn normal_without_cases(&self, terms: &Terms) -> Normal {
        let Terms { pose, inertia, dv } = terms;
        let (linkage, rod) = (self.linkage(), &self.rod);
        let path = Path::on_rod(linkage, pose, rod.along, rod.left);
        let [along, bend] = Way::along([1.0, 0.0], &path, [pose.dx, pose.d2x]);
        let axis = [linkage.s * pose.cos_phi, -pose.sin_phi];
        let aside = Way::aside(
            [linkage.r * pose.cos, linkage.r * pose.sin],
            axis.map(|part| linkage.l * part),
            rod.arm(axis),
        );
        let dv_n = self.weight_over([pose.cos, pose.sin], &aside) - self.weight.slider[1];
        let share = self.inertia_over(&aside, &along) / inertia.m;
        Normal {
            place: dv_n - share * dv,
            torque: share - aside.theta,
            force: share * pose.dx - aside.x,
            square: self.inertia_over(&aside, &bend) - share * inertia.half_dm,
            dx: pose.dx,
        }
    }
}

impl Normal {
    /// What friction drives the crank with, N m, for one newton of the normal force without friction: x' c/(1 − c κ)
    /// for c = −μ sgn(v) sgn(N). None where rigid bodies jam, μ |κ| ≥ 1.
    pub fn grip(&self, c: f64) -> Option<f64> {
        let jams = c.abs() * self.force.abs() >= 1.0;
        (!jams).then(|| c * self.dx / (1.0 - c * self.force))
    }
}

/// Derivatives of θ, the rod's centre of gravity p, its direction ψ and x in one direction, or the second ones along the curve.
pub(super) struct Way {
    pub theta: f64,
    pub p: [f64; 2],
    pub psi: f64,
    pub x: f64,
}

impl Way {
    /// First and second derivatives along the curve.
    #[inline(always)]
    pub(super) fn along(theta: [f64; 2], path: &Path, x: [f64; 2]) -> [Way; 2] {
        [
            Way {
                theta: theta[0],
                p: path.dp,
                psi: path.dpsi,
                x: x[0],
            },
            Way {
                theta: theta[1],
                p: path.d2p,
                psi: path.d2psi,
                x: x[1],
            },
        ]
    }

    /// Across the curve, from the crank, the rod and the arm of its centre of gravity: crank and slider are lifted by one off the
    /// guide, in the direction of least change of both angles.
    #[inline(always)]
    pub(super) fn aside(crank: [f64; 2], rod: [f64; 2], arm: [f64; 2]) -> Way {
        let squared = crank[0] * crank[0] + rod[0] * rod[0];
        let (theta, psi) = (crank[0] / squared, rod[0] / squared);
        Way {
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
    /// Σ m p_a·p_b + I ψ_a ψ_b over all bodies.
    #[inline(always)]
    pub(super) fn inertia_over(&self, a: &Way, b: &Way) -> f64 {
        let rod = &self.rod;
        let turned = rod.inertia * a.psi * b.psi;
        let moved = rod.mass * (a.p[0] * b.p[0] + a.p[1] * b.p[1]);
        self.crank_inertia * a.theta * b.theta + (moved + turned) + self.slider_mass * (a.x * b.x)
    }

    /// −Σ m g·p_a of gravity, for a slider that stays in its guide.
    #[inline(always)]
    pub(super) fn weight_over(&self, [cos, sin]: [f64; 2], a: &Way) -> f64 {
        let weight = &self.weight;
        (weight.sine * sin + weight.cosine * cos) * a.theta
            - (weight.rod[0] * a.p[0] + weight.rod[1] * a.p[1])
            - weight.slider[0] * a.x
    }
}
