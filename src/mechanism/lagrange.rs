//! Lagrange equation M θ̈ + ½ M' θ̇² + V' = Q: forward (θ̈ from loads) and backward (loads from a motion).

use super::body::Weight;
use super::plane::dot;
use super::{Body, Linkage, LoadValue, Loads, Path, Pose};
use crate::numeric::angle::Angle;
use crate::scene::{Instant, RodModel, Scene};

/// Terms of the equation that depend on the crank angle alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Position of the mechanism.
    pub pose: Pose,
    /// M, kg m²
    pub m: f64,
    /// ½ M', kg m²/rad
    pub half_dm: f64,
    /// V', N m
    pub dv: f64,
}

impl Terms {
    /// Returns θ̈, rad/s², under a generalized force Q, N m.
    #[inline]
    fn acceleration(&self, q: f64, omega: f64) -> f64 {
        (q - self.dv - self.half_dm * omega * omega) / self.m
    }
}

/// Equation of motion of one scene: immutable, shared by all evaluations.
#[derive(Clone, Debug)]
pub struct Equation {
    linkage: Linkage,
    pub(super) crank_inertia: f64,
    pub(super) rod: Body,
    has_rod: bool,
    pub(super) slider_mass: f64,
    pub(super) weight: Weight,
    has_weight: bool,
    loads: Loads,
}

impl Equation {
    /// Builds the equation of a scene without parts of zero strength.
    pub fn new(scene: &Scene) -> Equation {
        let scene = scene.reduced();
        let gravity = scene.gravity.map_or([0.0; 2], |gravity| gravity.vector());
        let (r, l) = (scene.geometry.crank, scene.geometry.rod);
        let crank = scene.crank.unwrap_or_default();
        let mut crank_inertia = crank.inertia;
        let mut slider_mass = scene.slider.map_or(0.0, |slider| slider.mass);
        let mut weight = Weight::default();
        weight.add_on_crank(gravity, crank.mass, [crank.cg, crank.cg_lateral]);
        let mut body = None;
        if let Some(rod) = &scene.rod {
            match rod.model {
                RodModel::Massless => {}
                RodModel::Rigid => {
                    body = Body::rod(&scene);
                    weight.rod = gravity.map(|part| rod.mass * part);
                }
                RodModel::TwoMass => {
                    let at_wrist_pin = rod.mass * rod.cg / l;
                    let at_crank_pin = rod.mass - at_wrist_pin;
                    crank_inertia += at_crank_pin * r * r;
                    weight.add_on_crank(gravity, at_crank_pin, [r, 0.0]);
                    slider_mass += at_wrist_pin;
                }
                RodModel::SpinOnly => {
                    body = Some(Body {
                        inertia: rod.inertia,
                        ..Body::default()
                    });
                    weight.add_on_crank(gravity, rod.mass, [l + rod.cg, 0.0]);
                }
            }
        }
        weight.slider = gravity.map(|part| slider_mass * part);
        Equation {
            linkage: Linkage::new(&scene.geometry),
            crank_inertia,
            rod: body.unwrap_or_default(),
            has_rod: body.is_some(),
            slider_mass,
            weight,
            has_weight: weight != Weight::default(),
            loads: Loads::new(&scene),
        }
    }

    /// Whether any body resists acceleration in some position.
    pub fn has_inertia(&self) -> bool {
        let rod = self.rod.mass != 0.0 || self.rod.inertia != 0.0;
        rod || self.crank_inertia != 0.0 || self.slider_mass != 0.0
    }

    /// Returns the linkage.
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// Returns the branch points of the terms as functions of a complex crank angle: angle and distance from the real
    /// axis, rad, as those of the linkage; infinitely far where the crank moves alone.
    pub fn branch_points(&self) -> [[f64; 2]; 2] {
        let alone = !self.has_rod && self.slider_mass == 0.0 && self.loads.are_none();
        let points = self.linkage.branch_points();
        if alone {
            points.map(|[angle, _]| [angle, f64::INFINITY])
        } else {
            points
        }
    }

    /// Returns the loads.
    pub fn loads(&self) -> &Loads {
        &self.loads
    }

    /// Computes the terms that depend on the crank angle (rad) alone.
    pub fn terms(&self, theta: f64) -> Terms {
        self.terms_at(self.linkage.pose(theta))
    }

    /// Computes the terms of the equation at a position.
    pub fn terms_at(&self, pose: Pose) -> Terms {
        self.terms_of(pose, self.has_rod, self.has_weight)
    }

    /// Computes terms at one of many positions without branches, for vectorisation: absent rod and weight are zero.
    #[inline(always)]
    pub(super) fn terms_without_cases(&self, pose: Pose) -> Terms {
        self.terms_of(pose, true, true)
    }

    #[inline(always)]
    fn terms_of(&self, pose: Pose, has_rod: bool, has_weight: bool) -> Terms {
        let (mut m, mut half_dm, mut dv) = (self.crank_inertia, 0.0, 0.0);
        let mut path = Path::default();
        if has_rod {
            let rod = &self.rod;
            path = Path::on_rod(&self.linkage, &pose, rod.along, rod.lateral);
            m += rod.mass * dot(path.dp, path.dp) + rod.inertia * path.dpsi * path.dpsi;
            half_dm += rod.mass * dot(path.dp, path.d2p) + rod.inertia * path.dpsi * path.d2psi;
        }
        if self.slider_mass != 0.0 {
            m += self.slider_mass * pose.dx * pose.dx;
            half_dm += self.slider_mass * pose.dx * pose.d2x;
        }
        if has_weight {
            let weight = &self.weight;
            dv = weight.sine * pose.sin + weight.cosine * pose.cos
                - dot(weight.rod, path.dp)
                - weight.slider[0] * pose.dx;
        }
        Terms {
            pose,
            m,
            half_dm,
            dv,
        }
    }

    /// Returns θ̈ in rad/s² at time t (s), crank angle θ (rad, unwrapped) and speed θ̇ (rad/s). Not finite where the
    /// position does not exist, a load has no value, or the inertia vanishes: see [`Self::singularity`].
    pub fn acceleration(&self, t: f64, theta: impl Into<Angle>, omega: f64) -> f64 {
        self.acceleration_and_power(t, theta, omega).0
    }

    /// Returns θ̈ as [`Self::acceleration`], and the power (W) of the loads that have no potential.
    pub fn acceleration_and_power(
        &self,
        t: f64,
        theta: impl Into<Angle>,
        omega: f64,
    ) -> (f64, f64) {
        let theta = theta.into();
        let terms = self.terms(theta.rest);
        let pose = &terms.pose;
        let now = pose.instant(t, theta, omega);
        let non_conservative = self.loads.without_potential(&now);
        let load = self.loads.with_potential_at(pose.x).plus(non_conservative);
        let alpha = terms.acceleration(load.generalized(pose.dx), omega);
        (alpha, non_conservative.generalized(pose.dx) * omega)
    }

    /// Returns the generalized force Q (N m) of a motion, by inverse dynamics.
    pub fn generalized_force(&self, terms: &Terms, omega: f64, alpha: f64) -> f64 {
        terms.m * alpha + terms.half_dm * omega * omega + terms.dv
    }

    /// Returns the torque (N m) on the crank that a motion needs beside the loads of the scene, by inverse dynamics.
    pub fn driving_torque(&self, t: f64, theta: impl Into<Angle>, omega: f64, alpha: f64) -> f64 {
        let theta = theta.into();
        let terms = self.terms(theta.rest);
        let load = self.loads.value(t, theta, omega, &terms.pose);
        self.generalized_force(&terms, omega, alpha) - load.generalized(terms.pose.dx)
    }

    /// Returns torque and force of the scene's loads.
    pub fn load(&self, t: f64, theta: impl Into<Angle>, omega: f64) -> LoadValue {
        let theta = theta.into();
        let pose = self.linkage.pose(theta.rest);
        self.loads.value(t, theta, omega, &pose)
    }

    /// Returns the size of the terms whose sum is M θ̈, N m, at time t (s), crank angle and speed (rad/s): rounding may
    /// change the sum by half a unit in the last place of it. A load F counts with |F| + |dF/dx| (|x| + r), and its
    /// lever x' = −r (sin θ + cos θ tan φ) with both parts.
    pub fn size_of_terms(&self, t: f64, theta: impl Into<Angle>, omega: f64) -> f64 {
        let theta = theta.into();
        let terms = self.terms(theta.rest);
        let pose = &terms.pose;
        let now = pose.instant(t, theta, omega);
        let change = f64::EPSILON.cbrt();
        let place = pose.x.abs() + self.linkage().r;
        let moved = Instant {
            x: pose.x + change * place,
            ..now
        };
        let [here, there] = [now, moved].map(|now| self.loads().at(&now));
        let changed = |here: f64, there: f64| here.abs() + (there - here).abs() / change;
        let lever = pose.dx.abs();
        let parts = self.linkage().r * (pose.cos * pose.sin_phi / pose.cos_phi).abs();
        let force = changed(here.force, there.force) * lever + here.force.abs() * parts;
        let inertia = (terms.half_dm * omega * omega).abs();
        force + changed(here.torque, there.torque) + terms.dv.abs() + inertia
    }

    /// Returns the rounding error of M at a crank angle, relative to M: half a unit in the last place of each part of
    /// x' = −r (sin θ + cos θ tan φ), which may cancel, and of the angle (rad), if it `is_rounded`.
    pub fn inertia_rounding(&self, theta: f64, is_rounded: bool) -> f64 {
        let terms = self.terms(theta);
        let pose = &terms.pose;
        let parts = pose.sin.abs() + (pose.cos * pose.sin_phi / pose.cos_phi).abs();
        let of_lever = self.slider_mass * pose.dx.abs() * self.linkage.r * parts;
        let of_angle = if is_rounded {
            terms.half_dm.abs() * theta.abs()
        } else {
            0.0
        };
        let rounding = f64::EPSILON * (of_lever + of_angle) / terms.m;
        if rounding.is_finite() { rounding } else { 0.0 }
    }

    /// Returns the kinetic energy, J.
    pub fn kinetic_energy(&self, theta: f64, omega: f64) -> f64 {
        0.5 * self.terms(theta).m * omega * omega
    }

    /// Returns the potential energy of gravity and of loads with a potential, J; for these θ counts without wrapping.
    pub fn potential_energy(&self, theta: impl Into<Angle>) -> f64 {
        let theta = theta.into();
        let pose = self.linkage.pose(theta.rest);
        self.loads.potential(theta.radians(), pose.x) + self.gravity_of(&pose)
    }

    /// Returns the potential energy of gravity alone, J.
    pub fn gravity_energy(&self, theta: f64) -> f64 {
        self.gravity_of(&self.linkage.pose(theta))
    }

    fn gravity_of(&self, pose: &Pose) -> f64 {
        let rod = [self.linkage.s * pose.cos_phi, -pose.sin_phi];
        self.gravity_at([pose.cos, pose.sin], rod, pose.x)
    }

    /// Returns the potential energy of gravity, J, from the directions of crank and rod (from A) and the slider's x.
    pub(super) fn gravity_at(&self, [cos, sin]: [f64; 2], axis: [f64; 2], x: f64) -> f64 {
        let (Linkage { r, e, .. }, weight) = (self.linkage, &self.weight);
        let arm = self.rod.arm(axis);
        let rod = [r * cos + arm[0], r * sin + arm[1]];
        let crank = weight.cosine * sin - weight.sine * cos;
        let slider = weight.slider[0] * x - weight.slider[1] * e;
        crank - dot(weight.rod, rod) - slider
    }
}
