//! Guide normal force of a crank that turns, and the generalized force of guide friction on the crank.

use super::{CurvePose, CurveTerms, Equation, LoadValue, Path, Terms};

/// Normal force without friction: N = place + torque·τ + force·F + square·ω², for crank torque τ and slider force F.
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
    #[inline(always)]
    pub fn normal(&self) -> Normal {
        let share = self.a / self.m;
        Normal {
            place: self.dv_n - share * self.dv,
            torque: share - self.theta_n,
            force: share * self.pose.dx - self.x_n,
            square: self.b - share * self.half_dm,
            dx: self.pose.dx,
        }
    }
}

impl Equation {
    /// Computes the normal force at a position as [`CurveTerms::normal`] does, to rounding, without branches.
    #[inline(always)]
    pub(super) fn normal_without_cases(&self, terms: &Terms) -> Normal {
        let pose = &terms.pose;
        let path = Path::on_rod(self.linkage(), pose, self.rod.along, self.rod.lateral);
        let curve_pose = CurvePose::of(self.linkage(), pose);
        CurveTerms {
            m: terms.m,
            half_dm: terms.half_dm,
            dv: terms.dv,
            ..self.curve_terms(curve_pose, &path)
        }
        .normal()
    }
}

impl Normal {
    /// Returns the part of a load, N.
    pub(super) fn of_load(&self, load: LoadValue) -> f64 {
        self.torque * load.torque + self.force * load.force
    }

    /// Returns the generalized force of friction on the crank, N m, per newton of the normal force without friction: x'
    /// c/(1 − c κ) for c = −μ sgn(v) sgn(N). None where rigid bodies jam, μ |κ| ≥ 1.
    pub fn grip(&self, c: f64) -> Option<f64> {
        let jams = c.abs() * self.force.abs() >= 1.0;
        (!jams).then(|| c * self.dx / (1.0 - c * self.force))
    }
}
