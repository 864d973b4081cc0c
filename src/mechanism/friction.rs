//! Coulomb friction at the slider guide, with the normal force exact.
//!
//! The friction force is F = c N with c = −μ sgn(v) sgn(N). It changes the acceleration by F x'/M, and that
//! changes the normal force: N = N_free + κ F. So N = N_free/(1 − c κ), linear for given signs; as N and N_free
//! have the same sign while |c κ| < 1, one and only one solution exists iff μ |κ| < 1. Beyond it the
//! equations of rigid bodies have no solution or two (Painlevé).
//!
//! Dry loads oppose motion with known magnitudes T of torques on the crank and D of forces on the slider. Rest lasts while
//! |Q − V'| ≤ T|θ'| + D|x'|, and beyond that motion begins in the direction of Q − V' (Filippov's solution).

use super::nonlinear_loads::sign;

/// What the motion would be without friction, and what a force on the slider along the guide changes in it.
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
    /// Q − V', N m: what accelerates from rest
    pub(super) pull: f64,
    /// N − A q̈ without friction, N
    pub(super) held: f64,
    /// How far x moves when the slider is lifted
    pub(super) x_n: f64,
    /// x', m
    pub(super) dx: f64,
    /// Power of the loads without potential, W
    pub power: f64,
}

/// Forces of the guide on the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuideForces {
    /// Along +y, N.
    pub normal: f64,
    /// Along +x, N.
    pub friction: f64,
}

/// Why rigid bodies with Coulomb friction do not say what happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jam {
    /// No acceleration satisfies the equations.
    NoSolution,
    /// Two accelerations do.
    TwoSolutions,
}

/// How motion begins or does not begin from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FromRest {
    /// The mechanism stays at rest.
    Hold(GuideForces),
    /// The coordinate begins to move in this direction, ±1.
    Move(f64),
    /// Rigid bodies do not say.
    Jam(Jam),
}

impl Free {
    /// q̈ and the forces while the slider slides, for c = −μ sgn(v) sgn(N).
    pub fn sliding(&self, c: f64) -> (f64, GuideForces) {
        // Without friction κ need not be a number.
        let [kappa, gain] = if c == 0.0 {
            [0.0; 2]
        } else {
            [self.kappa, self.gain]
        };
        let touch = GuideForces::rubbing(self.normal, kappa, c);
        (self.acceleration + gain * touch.friction, touch)
    }

    /// Slider velocity, m/s, at a speed (rad/s) of the coordinate.
    pub fn velocity(&self, speed: f64) -> f64 {
        self.dx * speed
    }

    /// Whether the coordinate would grow from rest.
    pub fn pulls_forward(&self) -> bool {
        self.pull > 0.0
    }

    /// The friction that sliding in direction `sgn_v` of the slider meets: c for the sign of N.
    pub fn opposing(&self, mu: f64, sgn_v: f64) -> f64 {
        -mu * sgn_v * self.normal.signum()
    }

    /// 1 − μ |κ|: positive where there is one and only one solution.
    pub fn clear_of_jam(&self, mu: f64) -> f64 {
        1.0 - mu * self.kappa.abs()
    }

    /// Which way the equations fail for sliding in direction `sgn_v`, where they do.
    pub fn jam(&self, mu: f64, sgn_v: f64) -> Jam {
        if self.opposing(mu, sgn_v) * self.kappa >= 1.0 {
            Jam::NoSolution
        } else {
            Jam::TwoSolutions
        }
    }

    /// The forces that keep the mechanism at rest, from the equations with q̇ = q̈ = 0; none at a dead centre
    /// where something pulls, as no force along the guide is felt there.
    pub fn holding(&self) -> Option<GuideForces> {
        let friction = if self.pull == 0.0 {
            0.0
        } else {
            -self.pull / self.dx
        };
        let normal = self.held - friction * self.x_n;
        (friction.is_finite() && normal.is_finite()).then_some(GuideForces { normal, friction })
    }

    /// What the static band leaves, N: μs |N| less the friction that rest needs; negative: it cannot rest.
    pub fn band(&self, mu_static: f64) -> f64 {
        match self.holding() {
            Some(touch) => mu_static * touch.normal.abs() - touch.friction.abs(),
            None => f64::NEG_INFINITY,
        }
    }

    /// Rest or motion from rest. Rest is kept if the static band holds.
    pub fn from_rest(&self, mu: f64, mu_static: f64) -> FromRest {
        if self.band(mu_static) >= 0.0
            && let Some(touch) = self.holding()
        {
            return FromRest::Hold(touch);
        }
        if self.clear_of_jam(mu) <= 0.0 {
            let sgn_v = (self.pull * self.dx).signum();
            return FromRest::Jam(self.jam(mu, sgn_v));
        }
        // Where the static band does not hold, the pull decides: friction cannot turn it round.
        FromRest::Move(self.pull.signum())
    }
}

impl GuideForces {
    /// N = N_free/(1 − c κ) and F = c N.
    pub(super) fn rubbing(free: f64, kappa: f64, c: f64) -> GuideForces {
        let normal = free / (1.0 - c * kappa);
        GuideForces {
            normal,
            friction: c * normal,
        }
    }

    /// The forces on a slider with the velocity v, from the normal force without friction (N) and κ; none where rigid bodies
    /// jam, μ |κ| ≥ 1. With κ = −tan Φ, what a drive of the crank keeps up.
    pub(super) fn sliding(free: f64, kappa: f64, mu: f64, v: f64) -> Option<GuideForces> {
        let c = -mu * sign(v) * free.signum();
        (c == 0.0 || mu * kappa.abs() < 1.0).then(|| GuideForces::rubbing(free, kappa, c))
    }
}
