//! Equivalent rotating and reciprocating masses of a scene: point masses at the pins.

use crate::scene::Scene;

/// Point masses at the pins that replace crank, rod and slider, Obaseki & Alfred (31)-(36).
///
/// Equivalent masses keep mass and first moment of rod and crank, not the moments of inertia: forces of a rod follow
/// from them only with the added couple `rod_inertia_left_kg_m2` times the angular acceleration of the rod.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct EquivalentMasses {
    /// Crank mass reduced to the crank pin, m_k k₁/k, kg.
    pub crank_at_pin_kg: f64,
    /// Rod mass at the crank pin, kg.
    pub rod_at_crank_pin_kg: f64,
    /// Rod mass at the wrist pin, kg.
    pub rod_at_wrist_pin_kg: f64,
    /// Rotating mass at the crank pin, kg.
    pub rotating_kg: f64,
    /// Reciprocating mass at the wrist pin, kg.
    pub reciprocating_kg: f64,
    /// Moment of inertia of the rod about its centre of gravity minus that of its two masses, kg m².
    pub rod_inertia_left_kg_m2: f64,
}

impl EquivalentMasses {
    /// Computes the masses of a scene; centres of gravity count with their distance along crank and rod.
    pub fn new(scene: &Scene) -> EquivalentMasses {
        let crank = scene.crank.unwrap_or_default();
        let rod = scene.rod.unwrap_or_default();
        let crank_at_pin = crank.mass * crank.cg / scene.geometry.crank;
        let at_wrist_pin = rod.mass * rod.cg / scene.geometry.rod;
        let at_crank_pin = rod.mass - at_wrist_pin;
        EquivalentMasses {
            crank_at_pin_kg: crank_at_pin,
            rod_at_crank_pin_kg: at_crank_pin,
            rod_at_wrist_pin_kg: at_wrist_pin,
            rotating_kg: crank_at_pin + at_crank_pin,
            reciprocating_kg: at_wrist_pin + scene.slider.map_or(0.0, |slider| slider.mass),
            rod_inertia_left_kg_m2: rod.central_inertia()
                - rod.mass * rod.cg * (scene.geometry.rod - rod.cg),
        }
    }
}
