//! State of a mechanism with a loose joint, and its accelerations, powers and forces.

use super::GuideForces;

/// Position and velocity of a mechanism with a loose joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LooseState {
    /// Time, s.
    pub t: f64,
    /// Crank angle θ, rad.
    pub theta: f64,
    /// Direction ψ of the rod from crank to slider, rad from +x: −φ on the right branch, π + φ on the left one.
    pub psi: f64,
    /// Slider position, m.
    pub x: f64,
    /// Crank speed, rad/s.
    pub omega: f64,
    /// ψ̇, rad/s
    pub spin: f64,
    /// Slider velocity, m/s.
    pub v: f64,
}

/// Accelerations, powers and forces at a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LooseRates {
    /// Crank acceleration, rad/s².
    pub alpha: f64,
    /// ψ̈, rad/s²
    pub spin_rate: f64,
    /// Slider acceleration, m/s².
    pub a: f64,
    /// Power of the loads and of the torque that drives a crank of prescribed speed, W.
    pub power: f64,
    /// Power lost in the contact and to friction at the guide, W.
    pub lost: f64,
    /// Forces of the guide on the slider; computed only where the guide has friction.
    pub guide: GuideForces,
    /// Normal force of the bearing's wall on the journal, N.
    pub normal: f64,
    /// Force of the loose joint on the rod, friction included, N.
    pub on_rod: [f64; 2],
    /// Torque on the crank beside the torques of the scene, N m, that keeps a prescribed speed.
    pub driving_torque: f64,
}
