//! Lagrange equation on the configuration curve, and the guide's normal force on the slider, by virtual work.
//!
//! Along the curve: M q̈ + ½ M' q̇² + V' = Q. Across it, in the direction n of the (θ, Φ) plane that lifts the slider
//! by one off the guide, virtual work gives the normal force
//! N = A q̈ + B q̇² + V_n − Q_n with A = Σ m p_n·p' + I ψ_n ψ', B = Σ m p_n·p'' + I ψ_n ψ''.

use super::friction::{Free, GuideForces};
use super::virtual_displacement::VirtualDisplacement;
use super::{Curve, CurvePose, Equation, Linkage, LoadValue, Loads, Path, Sense};
use crate::numeric::angle::Angle;
use crate::scene::{Friction, Instant, Scene, Variable};

/// Lagrange equation of one scene on its configuration curve.
#[derive(Clone, Debug)]
pub struct CurveEquation {
    /// Equation over the crank angle.
    pub(super) equation: Equation,
    curve: Curve,
    /// Friction at the guide, if any.
    pub friction: Option<Friction>,
}

/// Terms of the equation that depend on the position alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveTerms {
    /// Position of the mechanism.
    pub pose: CurvePose,
    /// M, kg m²
    pub m: f64,
    /// ½ M', kg m²
    pub half_dm: f64,
    /// V', N m
    pub dv: f64,
    /// A, kg m
    pub(super) a: f64,
    /// B, kg m
    pub(super) b: f64,
    /// V_n, N
    pub(super) dv_n: f64,
    /// θ_n, 1/m
    pub(super) theta_n: f64,
    /// x_n
    pub(super) x_n: f64,
}

impl CurveTerms {
    /// Returns Q of a load, N m.
    pub(super) fn along(&self, load: LoadValue) -> f64 {
        load.torque * self.pose.dtheta + load.force * self.pose.dx
    }

    /// Returns Q_n of a load, N.
    pub(super) fn off_guide(&self, load: LoadValue) -> f64 {
        load.torque * self.theta_n + load.force * self.x_n
    }
}

impl CurveEquation {
    /// Builds the equation of a scene on a curve.
    pub fn new(scene: &Scene, curve: Curve) -> CurveEquation {
        CurveEquation {
            equation: Equation::new(scene),
            curve,
            friction: scene.reduced().friction,
        }
    }

    /// Returns the curve.
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// Returns the loads.
    pub fn loads(&self) -> &Loads {
        self.equation.loads()
    }

    /// Computes the terms at coordinate q, rad.
    pub fn terms(&self, q: f64) -> CurveTerms {
        let pose = self.curve.pose(q);
        let path = pose.rod_path(&self.curve.linkage, &self.equation.rod);
        self.equation.curve_terms(pose, &path)
    }

    /// Whether M vanishes at coordinate q (rad): it is below 1e-9 of M at q + 0.3 rad.
    pub fn vanishes_at(&self, q: f64) -> bool {
        self.terms(q).m < 1e-9 * self.terms(q + 0.3).m
    }

    /// Returns the variables of the loads; the crank angle, which costs an inverse tangent, only if a load reads it.
    pub fn instant(&self, pose: &CurvePose, t: f64, q: Angle, speed: f64) -> Instant {
        let theta = match self.loads().reads.has(Variable::Theta) {
            true => self.curve.crank_angle(q).radians(),
            false => 0.0,
        };
        Instant {
            t,
            theta,
            omega: pose.dtheta * speed,
            x: pose.x,
            v: pose.dx * speed,
        }
    }

    /// Returns torque and force of the loads without guide friction; dry loads oppose this speed.
    pub fn load(&self, pose: &CurvePose, t: f64, q: Angle, speed: f64) -> LoadValue {
        self.loads().at(&self.instant(pose, t, q, speed))
    }

    /// Returns acceleration and normal force without guide friction, and their derivatives with respect to a force
    /// along the guide. Dry loads oppose the speed (rad/s) of the coordinate.
    pub fn free(&self, t: f64, q: Angle, speed: f64) -> Free {
        self.against(t, q, speed, None)
    }

    /// Returns [`Self::free`] of a motion that dry loads oppose in these senses, whatever the speed.
    pub fn free_against(&self, t: f64, q: Angle, speed: f64, sense: Sense) -> Free {
        self.against(t, q, speed, Some(sense))
    }

    fn against(&self, t: f64, q: Angle, speed: f64, sense: Option<Sense>) -> Free {
        let terms = self.terms(q.rest);
        let now = self.instant(&terms.pose, t, q, speed);
        let mut free = self.without_dry(&terms, &now, speed);
        if self.loads().are_dry() {
            let sense = sense.unwrap_or_else(|| Sense::of(now.omega, now.v));
            free.push(&terms, self.loads().dry(&now, sense), speed);
        }
        free
    }

    /// Computes the motion without guide friction and without dry loads.
    pub(super) fn without_dry(&self, terms: &CurveTerms, now: &Instant, speed: f64) -> Free {
        let pose = &terms.pose;
        let loads = self.loads();
        let non_conservative = loads.non_conservative(now);
        let load = loads.with_potential_at(pose.x).plus(non_conservative);
        let squared = speed * speed;
        let pull = terms.along(load) - terms.dv;
        let acceleration = (pull - terms.half_dm * squared) / terms.m;
        let normal_at_rest = terms.b * squared + terms.dv_n - terms.off_guide(load);
        Free {
            acceleration,
            normal: terms.a * acceleration + normal_at_rest,
            gain: pose.dx / terms.m,
            kappa: terms.a * pose.dx / terms.m - terms.x_n,
            pull,
            normal_at_rest,
            x_n: terms.x_n,
            dx: pose.dx,
            power: terms.along(non_conservative) * speed,
        }
    }

    /// Returns the guide's forces where a drive keeps up an acceleration (rad/s² of q); none where the guide locks.
    pub fn driven(&self, t: f64, q: Angle, speed: f64, acceleration: f64) -> Option<GuideForces> {
        let terms = self.terms(q.rest);
        let load = self.load(&terms.pose, t, q, speed);
        let pose = &terms.pose;
        let squared = speed * speed;
        // Virtual displacement off the guide with the crank held, over which the drive does no work.
        let share = terms.theta_n / pose.dtheta;
        let slope = terms.x_n - share * pose.dx;
        let without = (terms.a - share * terms.m) * acceleration
            + (terms.b - share * terms.half_dm) * squared
            + (terms.dv_n - share * terms.dv)
            - load.force * slope;
        let mu = self.friction.map_or(0.0, |friction| friction.coefficient);
        GuideForces::sliding(without, -slope, mu, pose.dx * speed)
    }

    /// Returns the kinetic energy, J.
    pub fn kinetic_energy(&self, q: Angle, speed: f64) -> f64 {
        0.5 * self.terms(q.rest).m * speed * speed
    }

    /// Returns the potential energy of gravity and loads, J; the angle without `turns` turns, which would cost digits.
    pub fn potential_energy(&self, q: Angle, turns: f64) -> f64 {
        let pose = self.curve.pose(q.rest);
        let mut theta = self.curve.crank_angle(q);
        theta.turns -= turns;
        let (crank, axis) = ([pose.cos, pose.sin], [pose.rod_cos, -pose.rod_sin]);
        let gravity = self.equation.gravity_at(crank, axis, pose.x);
        self.loads().potential(theta.radians(), pose.x) + gravity
    }
}

impl Equation {
    /// Computes the terms along and across a curve at a position with a path of the rod.
    #[inline(always)]
    pub(super) fn curve_terms(&self, pose: CurvePose, path: &Path) -> CurveTerms {
        let Linkage { r, l, .. } = *self.linkage();
        let crank = [pose.cos, pose.sin];
        let rod = [pose.rod_cos, -pose.rod_sin];
        let turn = [pose.dtheta, pose.d2theta];
        let [along, bend] = VirtualDisplacement::along(turn, path, [pose.dx, pose.d2x]);
        let arm = self.rod.arm(rod);
        let off_guide = VirtualDisplacement::off_guide(
            crank.map(|part| r * part),
            rod.map(|part| l * part),
            arm,
        );
        CurveTerms {
            m: self.inertia_over(&along, &along),
            half_dm: self.inertia_over(&along, &bend),
            dv: self.weight_over(crank, &along),
            a: self.inertia_over(&off_guide, &along),
            b: self.inertia_over(&off_guide, &bend),
            dv_n: self.weight_over(crank, &off_guide) - self.weight.slider[1],
            theta_n: off_guide.theta,
            x_n: off_guide.x,
            pose,
        }
    }
}

impl Free {
    /// Adds a load to a motion at a speed (rad/s) of the coordinate.
    pub(super) fn push(&mut self, terms: &CurveTerms, load: LoadValue, speed: f64) {
        let (along, off_guide) = (terms.along(load), terms.off_guide(load));
        self.pull += along;
        self.acceleration += along / terms.m;
        self.normal_at_rest -= off_guide;
        self.normal += terms.a * along / terms.m - off_guide;
        self.power += along * speed;
    }
}
