//! Guide normal force of a crank that turns, and the generalized force of guide friction on the crank.

use super::virtual_displacement::VirtualDisplacement;
use super::{CurveTerms, Equation, Path, Terms};

/// Normal force without friction: N = place + torque·τ + force·F + square·ω², with the loads τ (torque on the crank)
/// and F (force on the slider).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Normal {
    /// Term of the position alone (weight), N.
    pub place: f64,
    /// dN/dτ, 1/m.
    pub torque: f64,
    /// κ = dN/dF, dimensionless
    pub force: f64,
    /// Coefficient of ω², N s²/rad².
    pub square: f64,
    /// x', m/rad
    dx: f64,
}

impl CurveTerms {
    /// Returns the normal force where the coordinate is the crank angle.
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
    /// Computes the normal force at a position as [`CurveTerms::normal`] does, to rounding, without branches.
    #[inline(always)]
    pub(super) fn normal_without_cases(&self, terms: &Terms) -> Normal {
        let Terms { pose, inertia, dv } = terms;
        let (linkage, rod) = (self.linkage(), &self.rod);
        let path = Path::on_rod(linkage, pose, rod.along, rod.lateral);
        let [along, bend] = VirtualDisplacement::along([1.0, 0.0], &path, [pose.dx, pose.d2x]);
        let axis = [linkage.s * pose.cos_phi, -pose.sin_phi];
        let aside = VirtualDisplacement::aside(
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
    /// Returns the generalized force of friction on the crank, N m, per newton of the normal force without friction: x'
    /// c/(1 − c κ) for c = −μ sgn(v) sgn(N). None where rigid bodies jam, μ |κ| ≥ 1.
    pub fn grip(&self, c: f64) -> Option<f64> {
        let jams = c.abs() * self.force.abs() >= 1.0;
        (!jams).then(|| c * self.dx / (1.0 - c * self.force))
    }
}
