//! Derivatives of the driving torque at constant speed with respect to the lengths, in closed form.

use super::plane::dot;
use super::{Equation, Length, Path, Pose, PoseSlope};
use crate::error::Error;
use crate::scene::{Load, Rod, RodModel, Scene, Variables};

/// Equation of a scene whose torque changes with the lengths; masses, moments of inertia and centres of gravity stay
/// constant, measured from the crank pivot and the crank pin.
#[derive(Clone, Debug)]
pub struct TorqueSlope {
    equation: Equation,
    gravity: [f64; 2],
    rod: Rod,
}

impl TorqueSlope {
    /// Builds the equation of a scene.
    ///
    /// # Errors
    /// [`Error::Refused`] for slider forces of position or velocity but springs and dampers: their slope is not known.
    pub fn new(scene: &Scene) -> Result<TorqueSlope, Error> {
        let scene = scene.reduced();
        let has_unknown_slope = |load: &&Load| {
            let is_linear = matches!(load, Load::Viscous(_) | Load::Spring { .. });
            !is_linear && !load.reads(true).disjoint(Variables::X.or(Variables::V))
        };
        if let Some(load) = scene.forces.iter().find(has_unknown_slope) {
            let what = format!(
                "the slope of a slider force of kind \"{}\" over position or velocity is not known, so neither is the torque's sensitivity to the lengths",
                load.kind()
            );
            return Err(Error::refused(what, "compare two scenes"));
        }
        Ok(TorqueSlope {
            equation: Equation::new(&scene),
            gravity: scene.gravity.map_or([0.0; 2], |gravity| gravity.vector()),
            rod: scene.rod.unwrap_or_default(),
        })
    }

    /// Returns dτ/d length, N, of the torque τ = ½ M' ω² + V' − F x' that keeps ω (rad/s); time counts from θ = 0.
    pub fn driving_torque(&self, theta: f64, omega: f64, length: Length) -> f64 {
        let Equation {
            rod,
            slider_mass,
            weight,
            ..
        } = &self.equation;
        let (linkage, loads) = (self.equation.linkage(), self.equation.loads());
        let pose = &linkage.pose(theta);
        let slope = linkage.slope(pose, length);
        let squared = omega * omega;
        let path = Path::on_rod(linkage, pose, rod.along, rod.lateral);
        let change = self.change_of_rod(pose, &slope);
        let bilinear =
            |a: &Path, b: &Path| rod.mass * dot(a.dp, b.d2p) + rod.inertia * a.dpsi * b.d2psi;
        let of_slider = slider_mass * (slope.dx * pose.d2x + pose.dx * slope.d2x);
        let inertia = squared * (bilinear(&change, &path) + bilinear(&path, &change) + of_slider);
        let of_weight = -dot(weight.rod, change.dp) - weight.slider[0] * slope.dx;
        let force = self.equation.load(theta / omega, theta, omega).force;
        let damping = loads.damping.force;
        let force_slope = -loads.stiffness * slope.x - damping * slope.dx * omega;
        inertia + of_weight - force * slope.dx - force_slope * pose.dx
            + self.moved_mass(pose, squared, length)
    }

    /// Returns the derivative of the path of the rod's centre of gravity with respect to the length.
    fn change_of_rod(&self, pose: &Pose, slope: &PoseSlope) -> Path {
        let (rod, s) = (&self.equation.rod, self.equation.linkage().s);
        let pin = Path::turning(
            [pose.cos, pose.sin].map(|part| slope.crank * part),
            [1.0, 0.0],
        );
        let part = |[x, y]: [f64; 2], axis: [f64; 2]| {
            let [along, across] = rod.arm(axis);
            [x + along, y + across]
        };
        Path {
            dp: part(pin.dp, slope.axis[1]),
            d2p: part(pin.d2p, slope.axis[2]),
            dpsi: -s * slope.dphi,
            d2psi: -s * slope.d2phi,
        }
    }

    /// Returns the effect of the lengths beside the motion of the bodies, N: masses and places of two point masses, and
    /// the place of a weight that is measured from the crank's end.
    fn moved_mass(&self, pose: &Pose, squared: f64, length: Length) -> f64 {
        let Rod { mass, cg, .. } = self.rod;
        let linkage = self.equation.linkage();
        let crank = Path::turning([pose.cos, pose.sin], [1.0, 0.0]);
        // V' of a unit mass on the crank, per length along it.
        let lift = -dot(self.gravity, crank.dp);
        match (length, self.rod.model) {
            (Length::Crank, RodModel::TwoMass) => (mass - mass * cg / linkage.l) * lift,
            (Length::Rod, RodModel::TwoMass) => {
                // The mass m c/l at the wrist pin falls, and the rest at the crank pin grows.
                let to_crank_pin = mass * cg / (linkage.l * linkage.l);
                let at_wrist_pin = squared * pose.dx * pose.d2x - self.gravity[0] * pose.dx;
                to_crank_pin * (linkage.r * lift - at_wrist_pin)
            }
            (Length::Rod, RodModel::SpinOnly) => mass * lift,
            _ => 0.0,
        }
    }
}
