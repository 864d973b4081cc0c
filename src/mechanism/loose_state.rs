//! The state of a mechanism with a loose joint, and what follows from it.

use super::GuideForces;

/// Position and velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LooseState {
    /// s
    pub t: f64,
    /// Crank angle θ, rad.
    pub theta: f64,
    /// Direction ψ of the rod from the crank's end to the slider's, rad from +x; −φ on the right branch and
    /// π + φ on the left one.
    pub psi: f64,
    /// Slider position, m.
    pub x: f64,
    /// rad/s
    pub omega: f64,
    /// ψ̇, rad/s
    pub spin: f64,
    /// m/s
    pub v: f64,
}

/// What follows from a state and the forces in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LooseRates {
    /// rad/s²
    pub alpha: f64,
    /// ψ̈, rad/s²
    pub spin_rate: f64,
    /// m/s²
    pub a: f64,
    /// Power of the loads and of the torque that drives a crank of prescribed speed, W.
    pub power: f64,
    /// Power lost in the contact and by friction at the guide, W.
    pub lost: f64,
    /// What the guide does to the slider; found where it has friction only.
    pub guide: GuideForces,
    /// Normal force, N: what the bearing's wall pushes the journal with.
    pub normal: f64,
    /// Force of the loose joint on the rod, friction included, N.
    pub on_rod: [f64; 2],
    /// Torque on the crank beside those of the scene, N m, that keeps a prescribed speed.
    pub driving_torque: f64,
}
