//! Joint, guide and shaking forces of a motion by the Newton-Euler equations, body by body.

use super::plane::cross;
use super::{Body, CurvePose, Equation, Linkage, LoadValue, LooseRates, LooseState, Path, Pose};
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::scene::{Joint, Scene};

/// Forces (N) at one instant; each acts ON the body named last.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reactions {
    /// Force of the ground on the crank at O.
    pub crank_bearing: [f64; 2],
    /// Force of the crank on the rod at A.
    pub crank_pin: [f64; 2],
    /// Force of the rod on the slider at P.
    pub wrist_pin: [f64; 2],
    /// Force of the guide on the slider, along +y.
    pub guide: f64,
    /// Shaking force: minus the rate of change of linear momentum.
    pub shaking: [f64; 2],
    /// Shaking moment, N m: minus the rate of change of angular momentum about O.
    pub shaking_moment: f64,
}

/// Inertia forces by d'Alembert, minus mass times acceleration, and the couple of the rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InertiaForces {
    /// Inertia force at the crank's centre of gravity, N.
    pub crank: [f64; 2],
    /// Inertia force at the rod's centre of gravity, N.
    pub rod: [f64; 2],
    /// Minus the rod's central moment of inertia times its angular acceleration, N m.
    pub rod_couple: f64,
    /// Inertia force of the slider along +x, N.
    pub slider: f64,
}

/// Rigid bodies of a scene that carry the forces.
#[derive(Clone, Debug)]
pub struct Reactor {
    linkage: Linkage,
    gravity: [f64; 2],
    crank: Body,
    rod: Body,
    slider_mass: f64,
}

/// Known forces from which the wrist-pin force follows.
enum Known {
    /// Force on the slider along the guide, N; the moments about A give the rest, which fails at a limit.
    Load(f64),
    /// Force on the slider along the guide and normal force of the guide, N.
    Slider(f64, f64),
    /// Force on the rod at A, N.
    CrankPin([f64; 2]),
    /// Force on the slider at P, N.
    WristPin([f64; 2]),
}

/// Accelerations of the centres of gravity, m/s², and of the angles, rad/s²; crank pin, m, and direction of the rod.
struct Accelerations {
    crank: [f64; 2],
    rod: [f64; 2],
    rod_turn: f64,
    slider: f64,
    crank_turn: f64,
    pin: [f64; 2],
    axis: [f64; 2],
}

impl Reactor {
    /// Collects the bodies of a scene.
    ///
    /// # Errors
    /// [`Error::Refused`] for the rod model `spin-only`, which has no joint forces.
    pub fn new(scene: &Scene) -> Result<Reactor, Error> {
        let crank = scene.crank.unwrap_or_default();
        Ok(Reactor {
            linkage: Linkage::new(&scene.geometry),
            gravity: scene.gravity.map_or([0.0; 2], |gravity| gravity.vector()),
            crank: Body {
                mass: crank.mass,
                along: crank.cg,
                lateral: crank.cg_lateral,
                inertia: crank.inertia,
            },
            rod: Body::rod(scene).ok_or_else(|| {
                Error::refused(
                    "the rod model \"spin-only\" leaves out the rod's translation, so no joint forces go with it",
                    "use model = \"rigid\" or \"two-mass\" for reactions",
                )
            })?,
            slider_mass: scene.slider.map_or(0.0, |slider| slider.mass),
        })
    }

    /// Computes the forces of a motion (θ̇ in rad/s, θ̈ in rad/s²) under a load.
    pub fn reactions(&self, pose: &Pose, omega: f64, alpha: f64, load: &LoadValue) -> Reactions {
        let pose = CurvePose::of(&self.linkage, pose);
        let motion = self.accelerations(&pose, omega, alpha);
        self.forces(&motion, &Known::Load(load.force))
    }

    /// Computes the forces of a motion along the configuration curve (rad/s and rad/s² of its coordinate), from the
    /// force on the slider along the guide, friction included, and the normal force of the guide, N.
    pub fn on_curve(
        &self,
        pose: &CurvePose,
        speed: f64,
        acceleration: f64,
        force: f64,
        normal: f64,
    ) -> Reactions {
        let motion = self.accelerations(pose, speed, acceleration);
        self.forces(&motion, &Known::Slider(force, normal))
    }

    /// Computes the forces at a state of a mechanism with a loose joint. The force in the loose joint is known; the
    /// forces in the others follow from it, body by body. Time is the coordinate of the paths.
    pub fn loose(&self, joint: Joint, s: &LooseState, rates: &LooseRates) -> Reactions {
        let Linkage { r, l, e, .. } = self.linkage;
        let direction = |angle: f64| [angle.cos(), angle.sin()];
        let (crank, axis) = (direction(s.theta), direction(s.psi));
        let (crank_turn, rod_turn) = ([s.omega, rates.alpha], [s.spin, rates.spin_rate]);
        let arm = self.rod.arm(axis);
        let [fx, fy] = rates.on_rod;
        // The rod moves with the body that it is pinned to. Its acceleration, its end at the crank, the known force.
        let (rod, pin, known) = match joint {
            Joint::CrankPin => {
                let from_slider = [0, 1].map(|i| arm[i] - l * axis[i]);
                let [x, y] = Path::turning(from_slider, rod_turn).d2p;
                let pin = [s.x - l * axis[0], -e - l * axis[1]];
                ([rates.a + x, y], pin, Known::CrankPin([fx, fy]))
            }
            Joint::WristPin => {
                let pin = crank.map(|part| r * part);
                let carrier = Path::turning(pin, crank_turn);
                let rod = carrier.carrying(&Path::turning(arm, rod_turn)).d2p;
                (rod, pin, Known::WristPin([-fx, -fy]))
            }
        };
        let motion = Accelerations {
            crank: Path::turning(self.crank.arm(crank), crank_turn).d2p,
            rod,
            rod_turn: rates.spin_rate,
            slider: rates.a,
            crank_turn: rates.alpha,
            pin,
            axis,
        };
        self.forces(&motion, &known)
    }

    fn accelerations(&self, pose: &CurvePose, speed: f64, acceleration: f64) -> Accelerations {
        let squared = speed * speed;
        let turn = [pose.dtheta, pose.d2theta];
        let crank = Path::turning(self.crank.arm([pose.cos, pose.sin]), turn);
        let rod = pose.rod_path(&self.linkage, &self.rod);
        let second = |first: f64, second: f64| first * acceleration + second * squared;
        let of = |path: &Path| [0, 1].map(|i| second(path.dp[i], path.d2p[i]));
        Accelerations {
            crank: of(&crank),
            rod: of(&rod),
            rod_turn: second(rod.dpsi, rod.d2psi),
            slider: second(pose.dx, pose.d2x),
            crank_turn: second(pose.dtheta, pose.d2theta),
            pin: [self.linkage.r * pose.cos, self.linkage.r * pose.sin],
            axis: [pose.rod_cos, -pose.rod_sin],
        }
    }

    fn forces(&self, motion: &Accelerations, known: &Known) -> Reactions {
        let Linkage { l, e, .. } = self.linkage;
        let axis = motion.axis;
        // m a − m g: sum of the forces other than gravity.
        let needs = |mass: f64, rate: [f64; 2]| [0, 1].map(|i| rate[i] - mass * self.gravity[i]);
        let crank_rate = motion.crank.map(|a| self.crank.mass * a);
        let rod_rate = motion.rod.map(|a| self.rod.mass * a);
        let slider_rate = self.slider_mass * motion.slider;
        let crank_needs = needs(self.crank.mass, crank_rate);
        let rod_needs = needs(self.rod.mass, rod_rate);
        let slider_needs = needs(self.slider_mass, [slider_rate, 0.0]);
        let centre = self.rod.arm(axis);
        let rod_couple = self.rod.inertia * motion.rod_turn;
        let wrist_pin = match *known {
            // Slider along x; moments of the rod about A: (P − A) × wrist pin force = −(spin and inertia).
            Known::Load(force) => {
                let x = slider_needs[0] - force;
                let moment = rod_couple + cross(centre, rod_needs);
                [x, (l * axis[1] * x - moment) / (l * axis[0])]
            }
            Known::Slider(force, normal) => [slider_needs[0] - force, slider_needs[1] - normal],
            Known::CrankPin(force) => [0, 1].map(|i| force[i] - rod_needs[i]),
            Known::WristPin(force) => force,
        };
        let crank_pin = match *known {
            Known::CrankPin(force) => force,
            _ => [0, 1].map(|i| rod_needs[i] + wrist_pin[i]),
        };
        let rod_centre = [0, 1].map(|i| motion.pin[i] + centre[i]);
        let spin = self.crank.inertia * motion.crank_turn
            + rod_couple
            + cross(rod_centre, rod_rate)
            + e * slider_rate;
        Reactions {
            crank_bearing: [0, 1].map(|i| crank_needs[i] + crank_pin[i]),
            crank_pin,
            wrist_pin,
            guide: slider_needs[1] - wrist_pin[1],
            shaking: [
                -(crank_rate[0] + rod_rate[0] + slider_rate),
                -(crank_rate[1] + rod_rate[1]),
            ],
            shaking_moment: -spin,
        }
    }

    /// Computes the inertia forces of a motion (θ̇ in rad/s, θ̈ in rad/s²).
    pub fn inertia_forces(&self, pose: &Pose, omega: f64, alpha: f64) -> InertiaForces {
        let motion = self.accelerations(&CurvePose::of(&self.linkage, pose), omega, alpha);
        InertiaForces {
            crank: motion.crank.map(|a| -self.crank.mass * a),
            rod: motion.rod.map(|a| -self.rod.mass * a),
            rod_couple: -self.rod.inertia * motion.rod_turn,
            slider: -self.slider_mass * motion.slider,
        }
    }

    /// Computes the forces at one state of a scene's motion.
    pub fn at(
        &self,
        equation: &Equation,
        t: f64,
        theta: impl Into<Angle>,
        omega: f64,
        alpha: f64,
    ) -> Reactions {
        let theta = theta.into();
        let pose = self.linkage.pose(theta.rest);
        let load = equation.loads().value(t, theta, omega, &pose);
        self.reactions(&pose, omega, alpha, &load)
    }
}
