//! Loose mechanism of a scene, and its initial state.

use super::{LooseMechanism, NormalForce};
use crate::mechanism::{Body, Equation, Linkage, Loads, LooseState, Reactor};
use crate::numeric::angle::Angle;
use crate::scene::{Clearance, ContactLaw, Joint, MotionKind, Problem, Problems, Scene};

impl LooseMechanism {
    /// Builds the mechanism of a scene without parts of zero strength.
    ///
    /// # Errors
    /// [`Problems`]: parts that must have inertia and have none, and values that the contact force needs and lacks.
    pub fn new(scene: &Scene, clearance: Clearance) -> Result<LooseMechanism, Problems> {
        let crank = scene.crank.unwrap_or_default();
        let gravity = scene.gravity.map_or([0.0; 2], |gravity| gravity.vector());
        let driven = scene.motion.kind == MotionKind::ConstantSpeed;
        let mut problems = Vec::new();
        let rod = Body::rod(scene).unwrap_or_else(|| {
            problems.push(Problem::new(
                "rod.model",
                "the rod model \"spin-only\" leaves out the rod's translation, so it does not move freely in a clearance",
                "use model = \"rigid\" or \"two-mass\"",
            ));
            // A rod that raises no further problem.
            Body {
                mass: 1.0,
                inertia: 1.0,
                ..Body::default()
            }
        });
        let rod_along = match clearance.joint {
            Joint::CrankPin => rod.along - scene.geometry.rod,
            Joint::WristPin => rod.along,
        };
        let squared = rod_along * rod_along + rod.lateral * rod.lateral;
        let rod_inertia = rod.inertia + rod.mass * squared;
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
        let (along, lateral) = (per_r * crank.cg, per_r * crank.cg_lateral);
        let mechanism = LooseMechanism {
            side: match clearance.joint {
                Joint::CrankPin => 1.0,
                Joint::WristPin => -1.0,
            },
            r: scene.geometry.crank,
            l: scene.geometry.rod,
            e: scene.geometry.offset,
            driven,
            crank_inertia: crank.inertia,
            crank_weight: [along * gy - lateral * gx, lateral * gy + along * gx],
            rod_mass: rod.mass,
            rod_centre: [rod_along, rod.lateral],
            rod_inertia,
            per_rod_inertia: 1.0 / rod_inertia,
            slider_mass,
            per_slider_mass: 1.0 / slider_mass,
            gravity,
            loads: scene.loads().next().map(|_| Loads::new(scene)),
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

    /// Returns a problem for each part that moves by itself without inertia.
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
        let alone = match self.clearance.joint {
            // The mass that moves together with a rod without inertia is unknown.
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
        let carried = match self.clearance.joint {
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

    /// Returns the initial state: crank as the scene says, journal at its eccentricity and at rest against the bearing.
    ///
    /// # Errors
    /// [`Problems`] if the rod does not reach the guide.
    pub fn start(&self, scene: &Scene) -> Result<LooseState, Problems> {
        let [ex, ey] = self.eccentricity(scene);
        // A journal off its bearing's centre is an ideal joint on a guide that is higher or lower by the eccentricity.
        let mut geometry = scene.geometry;
        geometry.offset -= self.side * ey;
        let theta = Angle::from(scene.motion.angle).reduced().rest;
        let linkage = Linkage::new(&geometry);
        let pose = linkage.pose(theta);
        if !pose.is_regular() {
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

    /// Returns the vector from the bearing's centre to the journal's at the start, m.
    fn eccentricity(&self, scene: &Scene) -> [f64; 2] {
        let default = if self.is_linked() {
            self.clearance.radial
        } else {
            0.0
        };
        let distance = self.clearance.eccentricity.unwrap_or(default);
        if distance == 0.0 {
            return [0.0; 2];
        }
        if let Some(angle) = self.clearance.eccentricity_angle {
            return [distance * angle.cos(), distance * angle.sin()];
        }
        // The wall pushes the rod away from the pin: along the force on the rod in the ideal joint.
        let equation = Equation::new(scene);
        let (theta, omega) = (scene.motion.angle, scene.motion.speed);
        let alpha = match self.driven {
            true => 0.0,
            false => equation.acceleration(0.0, theta, omega),
        };
        // A rod model without joint forces does not move in a clearance, and is refused before.
        let forces = Reactor::new(scene)
            .map(|reactor| reactor.at(&equation, 0.0, theta, omega, alpha))
            .unwrap_or_default();
        let [fx, fy] = match self.clearance.joint {
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
