//! Coulomb friction at the slider guide, with the normal force exact.
//!
//! The friction force is F = c N with c = −μ sgn(v) sgn(N). It changes the acceleration by F x'/M, and that
//! changes the normal force: N = N_free + κ F. So N = N_free/(1 − c κ), linear for given signs; as N and N_free
//! have the same sign while |c κ| < 1, one and only one solution exists iff μ |κ| < 1. Beyond it the
//! equations of rigid bodies have no solution or two (Painlevé).

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
    /// A, kg m
    pub(super) a: f64,
    /// x', m
    pub(super) dx: f64,
    /// Power of the loads without potential, W
    pub power: f64,
}

/// Forces of the guide on the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
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
    Hold(Touch),
    /// The coordinate begins to move in this direction, ±1.
    Move(f64),
    /// Rigid bodies do not say.
    Jam(Jam),
}

impl Free {
    /// q̈ and the forces while the slider slides, for c = −μ sgn(v) sgn(N).
    pub fn sliding(&self, c: f64) -> (f64, Touch) {
        if c == 0.0 {
            let touch = Touch {
                normal: self.normal,
                friction: 0.0,
            };
            return (self.acceleration, touch);
        }
        let normal = self.normal / (1.0 - c * self.kappa);
        let friction = c * normal;
        (
            self.acceleration + self.gain * friction,
            Touch { normal, friction },
        )
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
    pub fn holding(&self) -> Option<Touch> {
        let friction = if self.pull == 0.0 {
            0.0
        } else {
            -self.pull / self.dx
        };
        let normal = self.held - friction * self.x_n;
        (friction.is_finite() && normal.is_finite()).then_some(Touch { normal, friction })
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

impl Touch {
    /// The forces while a motion is kept up by a drive of the crank: `without` is the normal force (N) without
    /// friction, `slope` = tan Φ how far x moves when the slider is lifted with the crank held. None where the
    /// guide locks itself: no torque of the crank, however large, keeps up the motion.
    pub(super) fn driven(without: f64, slope: f64, mu: f64, v: f64) -> Option<Touch> {
        let c = -mu * v.signum() * without.signum();
        if v == 0.0 || c == 0.0 {
            return Some(Touch {
                normal: without,
                friction: 0.0,
            });
        }
        let normal = without / (1.0 + c * slope);
        (mu * slope.abs() < 1.0).then_some(Touch {
            normal,
            friction: c * normal,
        })
    }
}
