//! The loose mechanism of a scene, and where its motion begins.

use super::{LooseMechanism, LooseState, NormalForce};
use crate::mechanism::{Equation, Linkage, Loads, Reactor};
use crate::numeric::angle::Angle;
use crate::scene::{Clearance, ContactLaw, Joint, MotionKind, Problem, Problems, RodModel, Scene};

impl LooseMechanism {
    /// The mechanism of a scene from which parts without strength were taken out.
    ///
    /// # Errors
    /// [`Problems`]: parts that must have inertia and have none, and what the contact force needs and is not given.
    pub fn new(scene: &Scene, clearance: Clearance) -> Result<LooseMechanism, Problems> {
        let crank = scene.crank.unwrap_or_default();
        let gravity = scene.gravity.map_or([0.0; 2], |gravity| gravity.vector());
        let driven = scene.motion.kind == MotionKind::ConstantSpeed;
        let mut problems = Vec::new();
        let rod = RodInertia::new(scene, clearance.joint).unwrap_or_else(|problem| {
            problems.push(problem);
            RodInertia::NOT_KNOWN
        });
        let force = match clearance.law {
            ContactLaw::MasslessLink => Ok(NormalForce::default()),
            _ => NormalForce::new(&clearance),
        };
        let force = force.unwrap_or_else(|missing| {
            problems.extend(missing.list().iter().cloned());
            NormalForce::default()
        });
        let slider_mass = scene.slider.map_or(0.0, |slider| slider.mass);
        let [gx, gy] = gravity;
        let per_r = crank.mass / scene.geometry.crank;
        let (along, left) = (per_r * crank.cg, per_r * crank.cg_lateral);
        let mechanism = LooseMechanism {
            joint: clearance.joint,
            side: match clearance.joint {
                Joint::CrankPin => 1.0,
                Joint::WristPin => -1.0,
            },
            r: scene.geometry.crank,
            l: scene.geometry.rod,
            e: scene.geometry.offset,
            driven,
            crank_inertia: crank.inertia,
            crank_weight: [along * gy - left * gx, left * gy + along * gx],
            rod_mass: rod.mass,
            rod_centre: rod.centre,
            rod_inertia: rod.about_pinned_end,
            per_rod_inertia: 1.0 / rod.about_pinned_end,
            slider_mass,
            per_slider_mass: 1.0 / slider_mass,
            gravity,
            loads: (!scene.torques.is_empty() || !scene.forces.is_empty())
                .then(|| Loads::new(scene)),
            turns: Angle::from(scene.motion.angle).reduced().turns,
            clearance,
            bearing: clearance.bearing_radius.unwrap_or(0.0),
            force,
            friction: clearance.friction.unwrap_or(0.0),
            guide: scene.friction,
        };
        problems.extend(mechanism.without_inertia());
        match problems.is_empty() {
            true => Ok(mechanism),
            false => Err(Problems::in_code(problems)),
        }
    }

    /// Parts that move by themselves and have no inertia.
    fn without_inertia(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        let mut refused = |field: &str, what: &str, help: &str| {
            problems.push(Problem::new(field, what, help));
        };
        if self.rod_inertia <= 0.0 {
            refused(
                "rod.inertia",
                "with a loose joint the rod moves by itself, and it has no inertia about its pinned end",
                "give the rod a mass and an inertia in [rod]",
            );
        }
        let coupled = self.rod_mass * self.rod_centre[0].hypot(self.rod_centre[1]);
        let movable = (self.rod_mass + self.slider_mass) * self.rod_inertia - coupled * coupled;
        let alone = match self.joint {
            // What moves together with a rod without inertia is not known.
            Joint::CrankPin if self.rod_inertia <= 0.0 => self.slider_mass > 0.0,
            Joint::CrankPin => movable > 1e-12 * coupled * coupled && movable > 0.0,
            Joint::WristPin => self.slider_mass > 0.0,
        };
        if !alone {
            refused(
                "slider.mass",
                "with a loose joint the slider moves by itself, and it has no mass",
                "give the slider a mass in [slider]",
            );
        }
        let carried = match self.joint {
            Joint::CrankPin => self.crank_inertia,
            Joint::WristPin if self.rod_inertia <= 0.0 => self.crank_inertia,
            Joint::WristPin => {
                let crank = self.crank_inertia + self.rod_mass * self.r * self.r;
                crank * self.rod_inertia - (coupled * self.r).powi(2)
            }
        };
        if !self.driven && carried <= 0.0 {
            refused(
                "crank.inertia",
                "with a loose joint the crank moves by itself, and it has no inertia",
                "give the crank an inertia in [crank], or use motion kind = \"constant-speed\"",
            );
        }
        problems
    }

    /// The state at the start: the crank as the scene says, the journal at its eccentricity and at rest
    /// against the bearing.
    ///
    /// # Errors
    /// [`Problems`] if the rod does not reach.
    pub fn start(&self, scene: &Scene) -> Result<LooseState, Problems> {
        let [ex, ey] = self.eccentricity(scene);
        // A journal off its bearing's centre is an ideal joint on a guide that much higher or lower.
        let mut geometry = scene.geometry;
        geometry.offset -= self.side * ey;
        let theta = Angle::from(scene.motion.angle).reduced().rest;
        let linkage = Linkage::new(&geometry);
        let pose = linkage.pose(theta);
        if !pose.exists() {
            return Err(Problems::in_code(vec![Problem::new(
                "motion.angle",
                format!(
                    "motion.angle: the rod does not reach the guide at crank angle {theta} rad with the journal where it begins"
                ),
                "start at another angle or eccentricity",
            )]));
        }
        let s = geometry.branch.sign();
        Ok(LooseState {
            t: 0.0,
            theta,
            psi: (-pose.sin_phi).atan2(s * pose.cos_phi),
            x: pose.x - self.side * ex,
            omega: scene.motion.speed,
            spin: -s * pose.dphi * scene.motion.speed,
            v: pose.dx * scene.motion.speed,
        })
    }

    /// From the bearing's centre to the journal's at the start.
    fn eccentricity(&self, scene: &Scene) -> [f64; 2] {
        let linked = self.clearance.law == ContactLaw::MasslessLink;
        let default = if linked { self.clearance.radial } else { 0.0 };
        let distance = self.clearance.eccentricity.unwrap_or(default);
        if distance == 0.0 {
            return [0.0; 2];
        }
        if let Some(angle) = self.clearance.eccentricity_angle {
            return [distance * angle.cos(), distance * angle.sin()];
        }
        // The wall pushes the rod away from the pin: along the force on the rod of the ideal joint.
        let equation = Equation::new(scene);
        let (theta, omega) = (scene.motion.angle, scene.motion.speed);
        let alpha = match self.driven {
            true => 0.0,
            false => equation.acceleration(0.0, theta, omega),
        };
        // A rod model without joint forces does not move in a clearance, and is refused before.
        let Ok(reactor) = Reactor::new(scene) else {
            return [distance, 0.0];
        };
        let forces = reactor.at(&equation, 0.0, theta, omega, alpha);
        let [fx, fy] = match self.joint {
            Joint::CrankPin => forces.crank_pin,
            Joint::WristPin => forces.wrist_pin.map(|force| -force),
        };
        let size = fx.hypot(fy);
        if size > 0.0 && size.is_finite() {
            [distance * fx / size, distance * fy / size]
        } else {
            [distance, 0.0]
        }
    }
}

/// The rod about its pinned end.
struct RodInertia {
    mass: f64,
    centre: [f64; 2],
    about_pinned_end: f64,
}

impl RodInertia {
    /// One that raises no further problem.
    const NOT_KNOWN: RodInertia = RodInertia {
        mass: 1.0,
        centre: [0.0; 2],
        about_pinned_end: 1.0,
    };

    fn new(scene: &Scene, joint: Joint) -> Result<RodInertia, Problem> {
        let rod = scene.rod.unwrap_or_default();
        let length = scene.geometry.rod;
        let central = match rod.model {
            RodModel::Massless => 0.0,
            RodModel::Rigid => rod.central_inertia().max(0.0),
            // What two masses at the pins have about their centre of gravity.
            RodModel::TwoMass => rod.mass * rod.cg * (length - rod.cg),
            RodModel::SpinOnly => {
                return Err(Problem::new(
                    "rod.model",
                    "the rod model \"spin-only\" leaves out the rod's translation, so it does not move freely in a clearance",
                    "use model = \"rigid\" or \"two-mass\"",
                ));
            }
        };
        let along = match joint {
            Joint::CrankPin => rod.cg - length,
            Joint::WristPin => rod.cg,
        };
        let squared = along * along + rod.cg_lateral * rod.cg_lateral;
        Ok(RodInertia {
            mass: rod.mass,
            centre: [along, rod.cg_lateral],
            about_pinned_end: central + rod.mass * squared,
        })
    }
}
