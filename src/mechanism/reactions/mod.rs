//! Joint and guide forces by Newton and Euler, body by body, from the motion.

mod loose;

use super::{Body, Equation, Link, Linkage, LoadValue, Path, Place, Pose};
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::scene::{RodModel, Scene};

/// Forces (N) at one instant; each acts ON the body named last.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reactions {
    /// From the ground on the crank at O.
    pub crank_bearing: [f64; 2],
    /// From the crank on the rod at A.
    pub crank_pin: [f64; 2],
    /// From the rod on the slider at P.
    pub wrist_pin: [f64; 2],
    /// From the guide on the slider, along +y.
    pub guide: f64,
    /// Minus the rate of change of linear momentum: the classical shaking force.
    pub shaking: [f64; 2],
    /// Minus the rate of change of angular momentum about O, N m: the classical shaking moment.
    pub shaking_moment: f64,
}

/// Inertia forces by d'Alembert, minus mass times acceleration, and the couple of the rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InertiaForces {
    /// At the crank's centre of gravity, N.
    pub crank: [f64; 2],
    /// At the rod's centre of gravity, N.
    pub rod: [f64; 2],
    /// Minus the rod's central moment of inertia times its angular acceleration, N m.
    pub rod_couple: f64,
    /// On the slider along +x, N.
    pub slider: f64,
}

/// The rigid bodies that carry the forces.
#[derive(Clone, Debug)]
pub struct Reactor {
    linkage: Linkage,
    gravity: [f64; 2],
    crank: Body,
    rod: Body,
    slider_mass: f64,
}

/// What the force at the wrist pin follows from.
enum Known {
    /// Force on the slider along the guide, N, and the moments about A; that fails at a limit.
    Load(f64),
    /// Force on the slider along the guide and normal force of the guide, N.
    Slider(f64, f64),
    /// Force on the rod at A, N.
    CrankPin([f64; 2]),
    /// Force on the slider at P, N.
    WristPin([f64; 2]),
}

/// The paths of the bodies with respect to a coordinate, and where the crank pin and the rod are.
struct Ways {
    crank: Path,
    rod: Path,
    slider: Path,
    pin: [f64; 2],
    axis: [f64; 2],
    /// θ' and θ''.
    turn: [f64; 2],
}

impl Reactor {
    /// The bodies of a scene.
    ///
    /// # Errors
    /// [`Error::Refused`] for the rod model `spin-only`, to which no forces belong.
    pub fn new(scene: &Scene) -> Result<Reactor, Error> {
        let mut reactor = Reactor {
            linkage: Linkage::new(&scene.geometry),
            gravity: scene.gravity.map_or([0.0; 2], |gravity| gravity.vector()),
            crank: Body::default(),
            rod: Body::default(),
            slider_mass: scene.slider.map_or(0.0, |slider| slider.mass),
        };
        if let Some(crank) = &scene.crank {
            reactor.crank = Body {
                on: Link::Crank,
                mass: crank.mass,
                along: crank.cg,
                left: crank.cg_lateral,
                inertia: crank.inertia,
            };
        }
        if let Some(rod) = &scene.rod {
            let inertia = match rod.model {
                RodModel::Massless => return Ok(reactor),
                RodModel::Rigid => rod.central_inertia().max(0.0),
                // What two masses at the pins have about their centre of gravity.
                RodModel::TwoMass => rod.mass * rod.cg * (scene.geometry.rod - rod.cg),
                RodModel::SpinOnly => {
                    return Err(Error::refused(
                        "the rod model \"spin-only\" leaves out the rod's translation, so no joint forces go with it",
                        "use model = \"rigid\" or \"two-mass\" for reactions",
                    ));
                }
            };
            reactor.rod = Body {
                on: Link::Rod,
                mass: rod.mass,
                along: rod.cg,
                left: rod.cg_lateral,
                inertia,
            };
        }
        Ok(reactor)
    }

    /// The forces for a motion (θ̇ in rad/s, θ̈ in rad/s²) under the loads of the scene.
    pub fn reactions(&self, pose: &Pose, omega: f64, alpha: f64, load: &LoadValue) -> Reactions {
        let s = self.linkage.s;
        let ways = Ways {
            crank: Path::on_crank(pose, self.crank.along, self.crank.left),
            rod: Path::on_rod(&self.linkage, pose, self.rod.along, self.rod.left),
            slider: Path::on_slider(pose),
            pin: [self.linkage.r * pose.cos, self.linkage.r * pose.sin],
            axis: [s * pose.cos_phi, -pose.sin_phi],
            turn: [1.0, 0.0],
        };
        self.forces(&ways, omega, alpha, &Known::Load(load.force))
    }

    /// The forces for a motion along the configuration curve (rad/s and rad/s² of its coordinate), under the
    /// force on the slider along the guide, friction included, and the normal force of the guide, N.
    pub fn on_curve(
        &self,
        place: &Place,
        speed: f64,
        acceleration: f64,
        force: f64,
        normal: f64,
    ) -> Reactions {
        let linkage = &self.linkage;
        let (crank, axis) = ([place.cos, place.sin], [place.rod_cos, -place.rod_sin]);
        let pin = crank.map(|part| linkage.r * part);
        let crank_turn = [place.dtheta, place.d2theta];
        let ways = Ways {
            crank: Path::turning(self.crank.arm(crank), crank_turn),
            rod: Path::turning(pin, crank_turn).carrying(&Path::turning(
                self.rod.arm(axis),
                [-place.drod, -place.d2rod],
            )),
            slider: Path {
                dp: [place.dx, 0.0],
                d2p: [place.d2x, 0.0],
                ..Path::default()
            },
            pin,
            axis,
            turn: crank_turn,
        };
        self.forces(&ways, speed, acceleration, &Known::Slider(force, normal))
    }

    fn forces(&self, ways: &Ways, speed: f64, acceleration: f64, known: &Known) -> Reactions {
        let Linkage { l, e, .. } = self.linkage;
        let squared = speed * speed;
        let rate = |path: &Path| {
            [
                path.dp[0] * acceleration + path.d2p[0] * squared,
                path.dp[1] * acceleration + path.d2p[1] * squared,
            ]
        };
        let crank_acceleration = rate(&ways.crank);
        let rod_acceleration = rate(&ways.rod);
        let rod_spin = ways.rod.dpsi * acceleration + ways.rod.d2psi * squared;
        let slider_acceleration = rate(&ways.slider)[0];
        let alpha = ways.turn[0] * acceleration + ways.turn[1] * squared;
        let g = self.gravity;

        // m (a − g): what the forces other than gravity must add up to.
        let needs = |mass: f64, a: [f64; 2]| [mass * (a[0] - g[0]), mass * (a[1] - g[1])];
        let crank_needs = needs(self.crank.mass, crank_acceleration);
        let rod_needs = needs(self.rod.mass, rod_acceleration);
        let slider_needs = needs(self.slider_mass, [slider_acceleration, 0.0]);

        let axis = ways.axis;
        let centre = self.rod.arm(axis);
        let wrist_pin = match *known {
            // Slider along x; the rod's moments about A: (P − A) × wrist pin force = −(spin and inertia).
            Known::Load(force) => {
                let x = slider_needs[0] - force;
                let moment = self.rod.inertia * rod_spin + cross(centre, rod_needs);
                [x, (l * axis[1] * x - moment) / (l * axis[0])]
            }
            Known::Slider(force, normal) => [slider_needs[0] - force, slider_needs[1] - normal],
            Known::CrankPin(force) => [0, 1].map(|i| force[i] - rod_needs[i]),
            Known::WristPin(force) => force,
        };
        let guide = slider_needs[1] - wrist_pin[1];
        let crank_pin = match *known {
            Known::CrankPin(force) => force,
            _ => [0, 1].map(|i| rod_needs[i] + wrist_pin[i]),
        };
        let crank_bearing = [crank_needs[0] + crank_pin[0], crank_needs[1] + crank_pin[1]];

        let place = [ways.pin[0] + centre[0], ways.pin[1] + centre[1]];
        let momentum = |mass: f64, a: [f64; 2]| [mass * a[0], mass * a[1]];
        let crank_rate = momentum(self.crank.mass, crank_acceleration);
        let rod_rate = momentum(self.rod.mass, rod_acceleration);
        let slider_rate = self.slider_mass * slider_acceleration;
        let spin = self.crank.inertia * alpha
            + self.rod.inertia * rod_spin
            + cross(place, rod_rate)
            + e * slider_rate;
        Reactions {
            crank_bearing,
            crank_pin,
            wrist_pin,
            guide,
            shaking: [
                -(crank_rate[0] + rod_rate[0] + slider_rate),
                -(crank_rate[1] + rod_rate[1]),
            ],
            shaking_moment: -spin,
        }
    }

    /// The inertia forces of a motion (θ̇ in rad/s, θ̈ in rad/s²).
    pub fn inertia_forces(&self, pose: &Pose, omega: f64, alpha: f64) -> InertiaForces {
        let squared = omega * omega;
        let force = |mass: f64, path: &Path| {
            [0, 1].map(|i| -mass * (path.dp[i] * alpha + path.d2p[i] * squared))
        };
        let crank = Path::on_crank(pose, self.crank.along, self.crank.left);
        let rod = Path::on_rod(&self.linkage, pose, self.rod.along, self.rod.left);
        InertiaForces {
            crank: force(self.crank.mass, &crank),
            rod: force(self.rod.mass, &rod),
            rod_couple: -self.rod.inertia * (rod.dpsi * alpha + rod.d2psi * squared),
            slider: -self.slider_mass * (pose.dx * alpha + pose.d2x * squared),
        }
    }

    /// The forces at one state of a scene's motion.
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

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
