//! Static equilibrium of slider force and crank torque by virtual work, with the band that guide friction allows.

use super::{Equation, Linkage, LoadValue, Pose, Reactor, Terms};
use crate::error::Error;
use crate::scene::{Instant, RodModel, Scene};

/// Static problem of a scene: weight and loads at rest.
#[derive(Clone, Debug)]
pub struct Statics {
    /// Equation of the scene.
    pub equation: Equation,
    reactor: Reactor,
    friction: f64,
}

/// Equilibrium at one crank angle, without friction and at the limits of friction.
///
/// Values that do not exist are `None`: a slider force against a torque at a dead centre, and every value where the rod
/// does not reach the guide or stands normal to it, or a load has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Slider force (N) or crank torque (N m) of equilibrium beside the loads of the scene: without friction, and the
    /// least and the greatest that hold with friction.
    pub band: Option<Band>,
    /// Force of the slider on the guide along +y without friction, N.
    pub side_thrust: Option<f64>,
    /// True if μ |tan φ| ≥ 1: no crank torque, however large, moves the slider against friction.
    pub self_locking: bool,
}

/// Force (N) or torque (N m) and the range around it; an edge that does not exist is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Value without friction.
    pub value: f64,
    /// Least value.
    pub min: Option<f64>,
    /// Greatest value.
    pub max: Option<f64>,
}

impl Statics {
    /// Builds the static problem of a scene under the friction coefficient `friction`.
    ///
    /// # Errors
    /// [`Error::Refused`] for a rod of model `spin-only` under gravity, which has no joint forces.
    pub fn new(scene: &Scene, friction: f64) -> Result<Statics, Error> {
        let mut scene = scene.reduced();
        if scene.gravity.is_none() {
            // Without weight the masses play no part.
            scene.rod = scene.rod.filter(|rod| rod.model != RodModel::SpinOnly);
        }
        Ok(Statics {
            equation: Equation::new(&scene),
            reactor: Reactor::new(&scene)?,
            friction,
        })
    }

    /// Returns the slider force (N, along +x) that holds the scene in equilibrium, beside its loads: F = (V' − τ)/x',
    /// Ng (2) and (6) for any offset, with weight.
    ///
    /// The crank torque fixes the force of the rod, and with it the normal force N of the guide, whatever friction
    /// does: the band is F ± μ |N|, Ng (8) with both edges.
    ///
    /// Dry loads hold with any value up to their magnitudes.
    pub fn slider_force(&self, theta: f64) -> Equilibrium {
        let (terms, load) = self.at(theta);
        let mut found = self.force_beside(&terms, load, theta);
        if let Some(most) = self.dry(&terms, theta) {
            let ends = [-most.torque, most.torque].map(|torque| {
                let dry = LoadValue { torque, force: 0.0 };
                self.force_beside(&terms, load.plus(dry), theta).band
            });
            found.band = found.band.map(|band| band.widened(ends, most.force));
        }
        found
    }

    fn force_beside(&self, terms: &Terms, load: LoadValue, theta: f64) -> Equilibrium {
        let pose = &terms.pose;
        let mut found = self.unknown(pose);
        let linkage = self.equation.linkage();
        if !pose.is_regular() || !load.is_finite() || dead_centre(linkage, pose, theta) {
            return found;
        }
        let whole = (terms.dv - load.torque) / pose.dx;
        let guide = self.guide(pose, load.torque, whole);
        let (force, friction) = (whole - load.force, self.friction * guide.abs());
        found.side_thrust = Some(0.0 - guide);
        let edge = |value: f64| value.is_finite().then_some(value + 0.0);
        found.band = edge(force).map(|value| Band {
            value,
            min: edge(force - friction),
            max: edge(force + friction),
        });
        found
    }

    /// Returns the crank torque (N m, counter-clockwise) of equilibrium beside the loads of the scene: τ = V' − F x'.
    ///
    /// The normal force depends on the part of the slider force that reaches the rod: it is n₀ + n₁ R for a rod force R
    /// along +x on the slider, and |R + F| is at most μ |n₀ + n₁ R|. Where μ |n₁| ≥ 1 the mechanism locks itself and
    /// holds a torque of any size; no edge is stated there.
    ///
    /// Dry loads hold with any value up to their magnitudes.
    pub fn crank_torque(&self, theta: f64) -> Equilibrium {
        let (terms, load) = self.at(theta);
        let mut found = self.torque_beside(&terms, load);
        if let Some(most) = self.dry(&terms, theta) {
            let ends = [-most.force, most.force].map(|force| {
                let dry = LoadValue { torque: 0.0, force };
                self.torque_beside(&terms, load.plus(dry)).band
            });
            found.band = found.band.map(|band| band.widened(ends, most.torque));
        }
        found
    }

    fn torque_beside(&self, terms: &Terms, load: LoadValue) -> Equilibrium {
        let pose = &terms.pose;
        let mut found = self.unknown(pose);
        if !pose.is_regular() || !load.is_finite() {
            return found;
        }
        let torque = |force: f64| terms.dv - force * pose.dx - load.torque + 0.0;
        let guide = |force: f64| self.guide(pose, load.torque, force);
        found.side_thrust = Some(0.0 - guide(load.force));
        // The guide force is affine in the force R along +x that reaches the rod: beside the weight it holds
        // R tan ψ, with sin ψ = −sin φ and cos ψ = s cos φ for the rod's turn angle ψ.
        let at_rest = guide(0.0);
        let slope = -self.equation.linkage().s * pose.sin_phi / pose.cos_phi;
        let edge = |sign: f64| {
            let mu = sign * self.friction;
            (load.force + mu * at_rest) / (1.0 - mu * slope)
        };
        let edges = (!found.self_locking).then(|| [torque(edge(1.0)), torque(edge(-1.0))]);
        found.band = Some(Band {
            value: torque(load.force),
            min: edges.map(|[a, b]| a.min(b)),
            max: edges.map(|[a, b]| a.max(b)),
        });
        found
    }

    /// Returns the magnitudes with which dry loads hold; none without dry loads.
    fn dry(&self, terms: &Terms, theta: f64) -> Option<LoadValue> {
        let loads = self.equation.loads();
        let now = Instant {
            theta,
            x: terms.pose.x,
            ..Instant::default()
        };
        loads.are_dry().then(|| loads.dry_magnitude(&now))
    }

    fn at(&self, theta: f64) -> (Terms, LoadValue) {
        (
            self.equation.terms(theta),
            self.equation.load(0.0, theta, 0.0),
        )
    }

    fn unknown(&self, pose: &Pose) -> Equilibrium {
        Equilibrium {
            band: None,
            side_thrust: None,
            self_locking: pose.is_regular()
                && self.friction * pose.sin_phi.abs() >= pose.cos_phi
                && self.friction > 0.0,
        }
    }

    /// Returns the normal force of the guide on the slider along +y, N, if `force` (N) drives the slider.
    fn guide(&self, pose: &Pose, torque: f64, force: f64) -> f64 {
        let load = LoadValue { torque, force };
        self.reactor.reactions(pose, 0.0, 0.0, &load).guide
    }
}

impl Band {
    /// Returns the band that also covers `ends`, widened on both sides; an edge needs the edges of all.
    fn widened(self, ends: [Option<Band>; 2], by: f64) -> Band {
        let all = |edge: fn(&Band) -> Option<f64>, pick: fn(f64, f64) -> f64| {
            let ends = ends.iter().map(|band| band.as_ref().and_then(edge));
            ends.fold(edge(&self), |found, end| Some(pick(found?, end?)))
        };
        Band {
            min: all(|band| band.min, f64::min).map(|min| min - by),
            max: all(|band| band.max, f64::max).map(|max| max + by),
            ..self
        }
    }
}

/// Whether a crank angle is a dead centre to rounding: x' is within the change by rounding of the angle.
fn dead_centre(linkage: &Linkage, pose: &Pose, theta: f64) -> bool {
    let angle = 2.0 * f64::EPSILON * (1.0 + theta.abs());
    let size = linkage.r * (1.0 + pose.sin_phi.abs() / pose.cos_phi);
    pose.dx.abs() <= angle * (pose.d2x.abs() + size)
}

/// Returns the friction coefficient, the tangent of the tilt (rad) at which a body begins to slide, Ng (10).
///
/// ```
/// use slider_crank::mechanism::friction_from_tilt;
/// assert!((friction_from_tilt(std::f64::consts::FRAC_PI_4) - 1.0).abs() < 1e-15);
/// ```
pub fn friction_from_tilt(angle: f64) -> f64 {
    angle.tan()
}

/// Returns the torque (N m) of a weight (N) on a cord round a drum of the given radius (m).
pub fn drum_torque(weight: f64, radius: f64) -> f64 {
    weight * radius
}
