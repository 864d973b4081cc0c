//! The equation on the configuration curve, and the force of the guide that keeps the mechanism on it.
//!
//! Along the curve: M q̈ + ½ M' q̇² + V' = Q. Across it, in the direction n of the (θ, Φ) plane which lifts the
//! slider by one and leaves the guide, virtual work gives the normal force
//! N = A q̈ + B q̇² + V_n − Q_n with A = Σ m p_n·p' + I ψ_n ψ', B = Σ m p_n·p'' + I ψ_n ψ''.

use super::friction::{Free, Touch};
use super::{Bodies, Body, Curve, Equation, Link, Loads, Place, Sense};
use crate::numeric::angle::Angle;
use crate::scene::{Friction, Instant, Scene};

/// The equation of one scene on its configuration curve.
#[derive(Clone, Debug)]
pub struct CurveEquation {
    curve: Curve,
    vanishing: bool,
    crank_inertia: f64,
    moving: Vec<Body>,
    heavy: Vec<Body>,
    gravity: [f64; 2],
    loads: Loads,
    friction: Option<Friction>,
}

/// What depends on the position alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveTerms {
    /// The position.
    pub place: Place,
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

/// First and second derivative along the curve, first derivative across it, of a path and a turn angle.
#[derive(Clone, Copy, Debug, Default)]
struct Way {
    p: [[f64; 2]; 3],
    psi: [f64; 3],
}

impl CurveEquation {
    /// The equation of a scene on the curve.
    pub fn new(scene: &Scene, curve: Curve) -> CurveEquation {
        let scene = scene.reduced();
        let bodies = Bodies::new(&scene);
        let mut equation = CurveEquation {
            curve,
            vanishing: false,
            crank_inertia: bodies.crank_inertia,
            moving: bodies.moving,
            heavy: bodies.heavy,
            gravity: scene.gravity.map_or([0.0; 2], |gravity| gravity.vector()),
            loads: Loads::new(&scene),
            friction: scene.friction,
        };
        let mut places = curve.limits().into_iter().chain(curve.dead_centres());
        equation.vanishing = places.any(|q| equation.vanishes_at(q));
        equation
    }

    /// The curve.
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// The loads.
    pub fn loads(&self) -> &Loads {
        &self.loads
    }

    /// The friction at the guide.
    pub fn friction(&self) -> Option<Friction> {
        self.friction
    }

    /// The terms that depend on the coordinate q (rad) alone.
    pub fn across(&self, q: f64) -> CurveTerms {
        let place = self.curve.place(q);
        let linkage = self.curve.linkage();
        let (lift, drop) = (linkage.r * place.cos, linkage.l * place.rod_cos);
        let squared = lift * lift + drop * drop;
        let (theta_n, rod_n) = (lift / squared, -drop / squared);
        let frame = Frame {
            a: [lift, linkage.r * place.sin],
            along: [place.rod_cos, -place.rod_sin],
            theta: [place.dtheta, place.d2theta, theta_n],
            rod: [place.drod, place.d2rod, rod_n],
            place: &place,
            x_n: -linkage.r * place.sin * theta_n - linkage.l * place.rod_sin * rod_n,
        };
        let mut terms = CurveTerms {
            place,
            m: self.crank_inertia * place.dtheta * place.dtheta,
            half_dm: self.crank_inertia * place.dtheta * place.d2theta,
            dv: 0.0,
            a: self.crank_inertia * theta_n * place.dtheta,
            b: self.crank_inertia * theta_n * place.d2theta,
            dv_n: 0.0,
            theta_n,
            x_n: frame.x_n,
        };
        for body in &self.moving {
            let (mass, inertia, way) = (body.mass, body.inertia, frame.of(body));
            let ([along, bend, aside], [spin, twist, tilt]) = (way.p, way.psi);
            terms.m += mass * dot(along, along) + inertia * spin * spin;
            terms.half_dm += mass * dot(along, bend) + inertia * spin * twist;
            terms.a += mass * dot(aside, along) + inertia * tilt * spin;
            terms.b += mass * dot(aside, bend) + inertia * tilt * twist;
        }
        if self.gravity != [0.0; 2] {
            for body in &self.heavy {
                let way = frame.of(body);
                terms.dv -= body.mass * dot(self.gravity, way.p[0]);
                terms.dv_n -= body.mass * dot(self.gravity, way.p[2]);
            }
        }
        terms
    }

    /// Whether there is no inertia at coordinate q (rad), compared with that further on.
    pub fn vanishes_at(&self, q: f64) -> bool {
        self.across(q).m < 1e-9 * self.across(q + 0.3).m
    }

    /// Whether the inertia vanishes at a limit or a dead centre.
    pub fn vanishes_somewhere(&self) -> bool {
        self.vanishing
    }

    /// The state of motion as loads see it.
    pub fn instant(&self, place: &Place, t: f64, q: Angle, speed: f64) -> Instant {
        Instant {
            t,
            theta: self.curve.crank_angle(q).radians(),
            omega: place.dtheta * speed,
            x: place.x,
            v: place.dx * speed,
        }
    }

    /// Acceleration and normal force as they would be without friction, and what a force along the guide
    /// changes in them. Speed in rad/s of the coordinate.
    pub fn free(&self, t: f64, q: Angle, speed: f64) -> Free {
        let terms = self.across(q.rest);
        let place = &terms.place;
        let sense = Sense::of(place.dtheta * speed, place.dx * speed);
        self.against(&terms, t, q, speed, sense)
    }

    /// Motion without friction and without the dry loads.
    pub(super) fn without_dry(&self, terms: &CurveTerms, t: f64, q: Angle, speed: f64) -> Free {
        let place = &terms.place;
        let spent = self.loads.spent(&self.instant(place, t, q, speed));
        let stored = self.loads.with_potential_at(place.x);
        let (torque, force) = (stored.torque + spent.torque, stored.force + spent.force);
        let along = torque * place.dtheta + force * place.dx;
        let aside = torque * terms.theta_n + force * terms.x_n;
        let squared = speed * speed;
        let pull = along - terms.dv;
        let acceleration = (pull - terms.half_dm * squared) / terms.m;
        let held = terms.b * squared + terms.dv_n - aside;
        Free {
            acceleration,
            normal: terms.a * acceleration + held,
            gain: place.dx / terms.m,
            kappa: terms.a * place.dx / terms.m - terms.x_n,
            pull,
            held,
            x_n: terms.x_n,
            a: terms.a,
            dx: place.dx,
            power: (spent.torque * place.dtheta + spent.force * place.dx) * speed,
        }
    }

    /// Normal and friction force of a motion whose acceleration (rad/s² of the coordinate) is kept up by a drive
    /// of the crank; none where the guide locks itself.
    pub fn driven(&self, t: f64, q: Angle, speed: f64, acceleration: f64) -> Option<Touch> {
        let terms = self.across(q.rest);
        let load = self.load(&terms.place, t, q, speed);
        let place = &terms.place;
        let squared = speed * speed;
        // Across the curve with the crank held: the drive does no work then.
        let share = terms.theta_n / place.dtheta;
        let slope = terms.x_n - share * place.dx;
        let without = (terms.a - share * terms.m) * acceleration
            + (terms.b - share * terms.half_dm) * squared
            + (terms.dv_n - share * terms.dv)
            - load.force * slope;
        let mu = self.friction.map_or(0.0, |friction| friction.coefficient);
        Touch::driven(without, slope, mu, place.dx * speed)
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self, q: Angle, speed: f64) -> f64 {
        0.5 * self.across(q.rest).m * speed * speed
    }

    /// Potential energy of gravity and of the loads that have a potential, J.
    /// Crank angles count without `turns` whole turns, which would cost digits.
    pub fn potential_energy(&self, equation: &Equation, q: Angle, turns: f64) -> f64 {
        let place = self.curve.place(q.rest);
        let mut theta = self.curve.crank_angle(q);
        theta.turns -= turns;
        self.loads.potential(theta.radians(), place.x)
            + equation.gravity_at(
                [place.cos, place.sin],
                [place.rod_cos, -place.rod_sin],
                place.x,
            )
    }
}

/// A position from which the ways of all bodies follow.
struct Frame<'a> {
    a: [f64; 2],
    along: [f64; 2],
    theta: [f64; 3],
    rod: [f64; 3],
    place: &'a Place,
    x_n: f64,
}

impl Frame<'_> {
    fn of(&self, body: &Body) -> Way {
        match body.on {
            Link::Crank => turning(body.arm([self.place.cos, self.place.sin]), self.theta),
            Link::Rod => {
                let pin = turning(self.a, self.theta);
                let rest = turning(body.arm(self.along), self.rod.map(|turn| -turn));
                let p = std::array::from_fn(|i| {
                    [pin.p[i][0] + rest.p[i][0], pin.p[i][1] + rest.p[i][1]]
                });
                Way { p, psi: rest.psi }
            }
            Link::Slider => Way {
                p: [[self.place.dx, 0.0], [self.place.d2x, 0.0], [self.x_n, 1.0]],
                psi: [0.0; 3],
            },
        }
    }
}

/// An arm that turns: first and second derivative of its angle along the curve, first across it.
fn turning([x, y]: [f64; 2], [first, second, aside]: [f64; 3]) -> Way {
    Way {
        p: [
            [-y * first, x * first],
            [
                -y * second - x * first * first,
                x * second - y * first * first,
            ],
            [-y * aside, x * aside],
        ],
        psi: [first, second, aside],
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
