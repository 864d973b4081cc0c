//! Quantities of a mechanism by name, against which formulas of papers are compared.

use std::cell::OnceCell;

use crate::kinematics::{ForceAnalysis, StrokeTorque, forces};
use crate::mechanism::{Equation, EquivalentMasses, Extremes, Limits, Linkage};
use crate::scene::Scene;
use crate::statics::StaticAnalysis;

/// Mechanism of a paper, with its analyses.
pub(super) struct MechanismQuantities {
    scene: Scene,
    linkage: Linkage,
    limits: Limits,
    forces: OnceCell<Option<ForceAnalysis>>,
    /// Equilibrium of a mechanism at rest.
    pub statics: Option<StaticAnalysis>,
}

impl MechanismQuantities {
    pub fn new(scene: Scene) -> MechanismQuantities {
        let linkage = Linkage::new(&scene.geometry);
        MechanismQuantities {
            limits: Limits::new(&linkage, 1.0),
            linkage,
            scene,
            forces: OnceCell::new(),
            statics: None,
        }
    }

    /// Returns a quantity at a crank angle, rad, in SI units; motion as derivatives by the crank angle.
    pub fn value(&self, name: &str, theta: f64) -> Option<f64> {
        let pose = self.linkage.pose(theta);
        let first = || self.linkage.first_order(theta);
        let extremes = || Extremes::new(&self.linkage);
        let centre = |kind: &str| {
            let centres = &self.limits.dead_centres;
            centres.iter().find(|c| c.kind == kind).map(|c| c.theta)
        };
        let terms = || Equation::new(&self.scene).terms(theta);
        let masses = || EquivalentMasses::new(&self.scene);
        let forces = || {
            let analysis = self.forces.get_or_init(|| forces(&self.scene).ok());
            analysis.as_ref()
        };
        let reactions = || Some(forces()?.row(theta).reactions);
        let largest = |s: StrokeTorque| s.max.value.abs().max(s.min.value.abs());
        let at_rest = || Some(self.statics.as_ref()?.row(theta));
        Some(match name {
            "sin" => pose.sin,
            "cos" => pose.cos,
            "sin_phi" => pose.sin_phi,
            "cos_phi" => pose.cos_phi,
            "phi" => pose.phi(),
            "dphi" => pose.dphi,
            "d2phi" => pose.d2phi,
            "x" => pose.x,
            "dx" => pose.dx,
            "d2x" => pose.d2x,
            "first_d2x" => first().d2x,
            "first_dx_d2x" => first().dx_d2x,
            "stroke" => self.limits.stroke,
            "advance" => self.limits.advance?,
            "retreat" => self.limits.retreat?,
            "time_ratio" => self.limits.time_ratio()?,
            "outer" | "inner" => centre(name)?,
            "d2x_max" => extremes()?.acceleration_max.value,
            "d2x_min" => extremes()?.acceleration_min.value,
            "m" => terms().m,
            "half_dm" => terms().half_dm,
            "dv" => terms().dv,
            "rotating" => masses().rotating_kg,
            "reciprocating" => masses().reciprocating_kg,
            "inertia_left" => masses().rod_inertia_left_kg_m2,
            "crank_inertia" => self.scene.crank?.inertia,
            "torque" => forces()?.torque(theta),
            "bearing_x" => reactions()?.crank_bearing[0],
            "bearing_y" => reactions()?.crank_bearing[1],
            "shaking" => reactions()?.shaking[0],
            "inward" => largest(forces()?.inward?),
            "outward" => largest(forces()?.outward?),
            "force" => at_rest()?.balance.band?.value,
            // Lower edge of the friction band.
            "least" => at_rest()?.balance.band?.min?,
            "thrust" => at_rest()?.balance.side_thrust?,
            "velocity_ratio" => at_rest()?.velocity_ratio,
            "gamma" => at_rest()?.crank_pin_angle,
            "gamma_of_least" => {
                let statics = self.statics.as_ref()?;
                statics
                    .row(statics.least.first()?.theta_rad)
                    .crank_pin_angle
            }
            _ => return None,
        })
    }
}

/// Returns the quantities of mechanisms, by the names MECHANISM_QUANTITY, and those of `other`.
pub(super) fn of(
    mechanisms: Vec<(&'static str, MechanismQuantities)>,
    other: impl Fn(&str, f64) -> Option<f64> + 'static,
) -> super::formulas::Quantities {
    Box::new(move |name, theta| {
        let ours = name.split_once('_').and_then(|(mechanism, quantity)| {
            let (_, ours) = mechanisms.iter().find(|(name, _)| *name == mechanism)?;
            ours.value(quantity, theta)
        });
        ours.or_else(|| other(name, theta))
    })
}
