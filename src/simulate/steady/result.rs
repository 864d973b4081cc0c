//! The periodic steady state in numbers.

use serde::Serialize;

use crate::scene::{Extent, Scene};

/// A value with an estimate of its error, in the same unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Estimated {
    /// The value.
    pub value: f64,
    /// Error of the value, positive.
    pub error: f64,
}

/// An extreme of the speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedExtreme {
    /// Signed speed, rad/s.
    pub omega_rad_per_s: Estimated,
    /// Crank angle in the cycle, from 0 to 2π times its turns, rad; none if the speed does not vary by more than its error.
    pub theta_rad: Option<Estimated>,
}

/// What the crank speed repeats so many times a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedOrder {
    /// Per turn.
    pub order: f64,
    /// Amplitude, rad/s.
    pub amplitude_rad_per_s: Estimated,
}

/// The periodic motion of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct SteadyState {
    /// Title of the scene.
    pub scene: String,
    /// The scene's start angle, rad.
    pub theta_rad: f64,
    /// The steady speed there, rad/s.
    pub omega_rad_per_s: Estimated,
    /// Turns of the crank after which the motion is the same again: the cycle of the loads.
    pub cycle_turns: u32,
    /// Time of a cycle, s.
    pub period_s: Estimated,
    /// Mean speed over time, 2π turns/period, with the sign of the rotation, rad/s.
    pub omega_mean_rad_per_s: Estimated,
    /// The least speed without regard to its sign.
    pub slowest: SpeedExtreme,
    /// The largest.
    pub fastest: SpeedExtreme,
    /// Coefficient of fluctuation: the largest minus the least speed, over the mean.
    pub fluctuation: Estimated,
    /// Part of a small deviation that is left after a cycle.
    pub multiplier: Estimated,
    /// Whether small deviations die out.
    pub stable: bool,
    /// Whether it is the motion that the scene's own start speed approaches; none for a start at rest.
    pub approached_from_start: Option<bool>,
    /// Orders of the speed over the crank angle, up to the twelfth.
    pub speed_orders: Vec<SpeedOrder>,
    /// Mean power that loads put in, W: those whose work over a cycle is positive.
    pub power_in_w: Estimated,
    /// Mean power that loads take out, W, positive.
    pub power_out_w: Estimated,
    /// Each load.
    pub loads: Vec<LoadWork>,
    /// The flywheel, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flywheel: Option<Flywheel>,
    /// What the reader should know.
    pub notes: Vec<String>,
}

impl SteadyState {
    /// The scene, started in the steady state; over one cycle if it does not say how long its run is.
    pub fn start(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.motion.speed = self.omega_rad_per_s.value;
        let cycle = Some(Extent::Revolutions(self.cycle_turns.into()));
        scene.run.extent = scene.run.extent.or(cycle);
        scene
    }
}

/// One load over a period.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadWork {
    /// As `torque[1]`, with what it is.
    pub name: String,
    /// Mean over time of the power it puts in, W.
    pub power_w: Estimated,
    /// Mean over the crank angle of the crank torque that it amounts to, N m.
    pub torque_nm: Estimated,
}

/// A flywheel on the crank.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Flywheel {
    /// Coefficient of fluctuation that was asked for.
    pub wanted_fluctuation: f64,
    /// Moment of inertia to be added to the crank, kg m²; negative: so much could be taken away.
    pub added_inertia_kg_m2: Estimated,
    /// Moment of inertia of the crank with it, kg m².
    pub crank_inertia_kg_m2: f64,
    /// Coefficient of fluctuation computed anew with it.
    pub fluctuation: Estimated,
    /// Mean speed with it, rad/s.
    pub omega_mean_rad_per_s: Estimated,
}
