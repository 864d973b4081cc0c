//! The normal force at the guide of a crank that turns, and what friction adds to the force that drives the crank.

use super::curve_equation::CurveTerms;
use super::lagrange::Weight;
use super::{Body, Equation, Terms};

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
    /// The normal force at many positions, from the terms there: as [`CurveTerms::normal`] gives it one by one, to rounding.
    #[inline(always)]
    pub(super) fn normal_without_cases(&self) -> impl Fn(&Terms) -> Normal {
        let rod = self.rod.unwrap_or_default();
        let weight = self.weight.unwrap_or_default();
        move |terms| self.normal_of(terms, &rod, &weight)
    }

    /// Crank and slider lifted by one off the guide, in the direction of least change of both angles: θ_n and ψ_n are how far crank
    /// and rod turn then. A path across, p_n, is that along the curve with these in place of 1 and ψ'.
    #[inline(always)]
    fn normal_of(&self, terms: &Terms, rod: &Body, weight: &Weight) -> Normal {
        let Terms { pose, inertia, dv } = terms;
        let linkage = self.linkage();
        let s = linkage.s;
        let [ax, ay] = [linkage.r * pose.cos, linkage.r * pose.sin];
        let (lift, drop) = (ax, linkage.l * s * pose.cos_phi);
        let per_square = 1.0 / (lift * lift + drop * drop);
        let (theta_n, psi_n) = (lift * per_square, drop * per_square);
        let x_n = linkage.l * pose.sin_phi * psi_n - ay * theta_n;
        let (psi, twist) = (-s * pose.dphi, -s * pose.d2phi);
        let [gx, gy] = rod.arm([s * pose.cos_phi, -pose.sin_phi]);
        let along = [-ay - psi * gy, ax + psi * gx];
        let bend = [
            -ax - twist * gy - psi * psi * gx,
            -ay + twist * gx - psi * psi * gy,
        ];
        let aside = [-theta_n * ay - psi_n * gy, theta_n * ax + psi_n * gx];
        let dot = |with: [f64; 2]| aside[0] * with[0] + aside[1] * with[1];
        let a = self.crank_inertia * theta_n
            + rod.mass * dot(along)
            + rod.inertia * psi_n * psi
            + self.slider_mass * x_n * pose.dx;
        let b =
            rod.mass * dot(bend) + rod.inertia * psi_n * twist + self.slider_mass * x_n * pose.d2x;
        let crank = weight.sine * pose.sin + weight.cosine * pose.cos;
        let dv_n = theta_n * crank - dot(weight.rod) - weight.slider[0] * x_n - weight.slider[1];
        let share = a / inertia.m;
        Normal {
            place: dv_n - share * dv,
            torque: share - theta_n,
            force: share * pose.dx - x_n,
            square: b - share * inertia.half_dm,
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
