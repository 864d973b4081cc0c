//! Coulomb friction at the slider guide, with the exact normal force.
//!
//! The friction force F = c N with c = −μ sgn(v) sgn(N) changes the acceleration by F x'/M and thereby the normal
//! force: N = N_free + κ F. Hence N = N_free/(1 − c κ), linear for given signs. N and N_free have the same sign while
//! |c κ| < 1; one and only one solution therefore exists iff μ |κ| < 1. Beyond, the equations of rigid bodies have no
//! solution or two (Painlevé).
//!
//! Dry loads oppose motion with known magnitudes T of torques on the crank and D of forces on the slider. Rest lasts
//! while |Q − V'| ≤ T|θ'| + D|x'|; beyond, motion begins in the direction of Q − V' (Filippov's solution).

use super::nonlinear_loads::sign;

/// Motion without friction, and derivatives with respect to a force on the slider along the guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Free {
    /// q̈ without friction, rad/s²
    pub acceleration: f64,
    /// N without friction, N, along +y on the slider
    pub normal: f64,
    /// dq̈/dF = x'/M, rad/s² per N
    pub gain: f64,
    /// κ = dN/dF, dimensionless
    pub kappa: f64,
    /// Generalized force Q − V', N m, which accelerates from rest
    pub pull: f64,
    /// N − A q̈ without friction, N
    pub(super) normal_at_rest: f64,
    /// Change of x per lift of the slider, dimensionless
    pub(super) x_n: f64,
    /// x', m
    pub dx: f64,
    /// Power of the loads without potential, W
    pub power: f64,
}

/// Forces of the guide on the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuideForces {
    /// Normal force along +y, N.
    pub normal: f64,
    /// Friction force along +x, N.
    pub friction: f64,
}

/// Reason why rigid bodies with Coulomb friction have no unique motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jam {
    /// No acceleration satisfies the equations.
    NoSolution,
    /// Two accelerations satisfy the equations.
    TwoSolutions,
}

/// Outcome from rest: hold, move or jam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FromRest {
    /// The mechanism stays at rest.
    Hold(GuideForces),
    /// The coordinate begins to move in this direction, ±1.
    Move(f64),
    /// Rigid bodies have no unique motion.
    Jam,
}

impl Free {
    /// Returns q̈ and the guide forces while the slider slides, for c = −μ sgn(v) sgn(N).
    pub fn sliding(&self, c: f64) -> (f64, GuideForces) {
        // Without friction κ may be infinite or NaN.
        let [kappa, gain] = if c == 0.0 {
            [0.0; 2]
        } else {
            [self.kappa, self.gain]
        };
        let touch = GuideForces::rubbing(self.normal, kappa, c);
        (self.acceleration + gain * touch.friction, touch)
    }

    /// Returns c = −μ sgn(v) sgn(N) of a slider that slides in direction `sgn_v`.
    pub fn opposing(&self, mu: f64, sgn_v: f64) -> f64 {
        -mu * sgn_v * self.normal.signum()
    }

    /// Returns 1 − μ |κ|, positive where one and only one solution exists.
    pub fn clear_of_jam(&self, mu: f64) -> f64 {
        1.0 - mu * self.kappa.abs()
    }

    /// Returns the way in which the equations fail for sliding in direction `sgn_v`, given that they fail.
    pub fn jam(&self, mu: f64, sgn_v: f64) -> Jam {
        if self.opposing(mu, sgn_v) * self.kappa >= 1.0 {
            Jam::NoSolution
        } else {
            Jam::TwoSolutions
        }
    }

    /// Returns the forces that keep the mechanism at rest, from the equations with q̇ = q̈ = 0; none at a dead centre
    /// with a nonzero pull, where a force along the guide has no effect.
    pub fn holding(&self) -> Option<GuideForces> {
        let friction = if self.pull == 0.0 {
            0.0
        } else {
            -self.pull / self.dx
        };
        let normal = self.normal_at_rest - friction * self.x_n;
        (friction.is_finite() && normal.is_finite()).then_some(GuideForces { normal, friction })
    }

    /// Returns the margin of the static band, N: μs |N| less the friction that rest needs; negative: no rest.
    pub fn band(&self, mu_static: f64) -> f64 {
        match self.holding() {
            Some(touch) => mu_static * touch.normal.abs() - touch.friction.abs(),
            None => f64::NEG_INFINITY,
        }
    }

    /// Decides between rest and motion from rest; rest is kept if the static band holds.
    pub fn from_rest(&self, mu: f64, mu_static: f64) -> FromRest {
        match self.holding() {
            Some(touch) if self.band(mu_static) >= 0.0 => FromRest::Hold(touch),
            _ if self.clear_of_jam(mu) <= 0.0 => FromRest::Jam,
            // Beyond the static band the pull decides: friction cannot reverse it.
            _ => FromRest::Move(self.pull.signum()),
        }
    }
}

impl GuideForces {
    /// Returns N = N_free/(1 − c κ) and F = c N.
    pub(super) fn rubbing(free: f64, kappa: f64, c: f64) -> GuideForces {
        let normal = free / (1.0 - c * kappa);
        GuideForces {
            normal,
            friction: c * normal,
        }
    }

    /// Returns the forces on a slider with the velocity v, from the normal force without friction (N) and κ; none where
    /// rigid bodies jam, μ |κ| ≥ 1. For a crank kept in motion by a drive, κ = −tan Φ.
    pub(super) fn sliding(free: f64, kappa: f64, mu: f64, v: f64) -> Option<GuideForces> {
        let c = -mu * sign(v) * free.signum();
        (c == 0.0 || mu * kappa.abs() < 1.0).then(|| GuideForces::rubbing(free, kappa, c))
    }
}
