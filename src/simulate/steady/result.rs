//! Periodic steady state in numbers.

use serde::Serialize;

use crate::scene::{Extent, Scene};

/// Value with an estimate of its error, in the same unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Estimated {
    /// The value.
    pub value: f64,
    /// Error of the value, positive.
    pub error: f64,
}

/// Extreme of the crank speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedExtreme {
    /// Signed speed, rad/s.
    pub omega_rad_per_s: Estimated,
    /// Crank angle in the cycle, from 0 to 2π times its turns, rad; none for a fluctuation up to 4 times its error.
    pub theta_rad: Option<Estimated>,
}

/// Fourier order of the crank speed over the crank angle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedOrder {
    /// Number of periods in a turn.
    pub order: f64,
    /// Amplitude, rad/s.
    pub amplitude_rad_per_s: Estimated,
}

/// Periodic motion of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct SteadyState {
    /// Title of the scene.
    pub scene: String,
    /// Crank angle at the start of the scene, rad.
    pub theta_rad: f64,
    /// Steady speed at the start angle, rad/s.
    pub omega_rad_per_s: Estimated,
    /// Number of turns after which the motion repeats: the cycle of the loads.
    pub cycle_turns: u32,
    /// Duration of a cycle, s.
    pub period_s: Estimated,
    /// Mean speed over time, 2π turns/period, with the sign of the rotation, rad/s.
    pub omega_mean_rad_per_s: Estimated,
    /// Least speed without regard to sign.
    pub slowest: SpeedExtreme,
    /// Largest speed without regard to sign.
    pub fastest: SpeedExtreme,
    /// Coefficient of fluctuation: largest minus least speed, over the mean speed.
    pub fluctuation: Estimated,
    /// Floquet multiplier: factor on a small energy deviation over one cycle, 0 or more.
    pub multiplier: Estimated,
    /// Whether small deviations die out: multiplier below 1 by more than its error.
    pub stable: bool,
    /// Whether the scene's own start speed approaches this motion; none for a start at rest.
    pub approached_from_start: Option<bool>,
    /// Orders of the speed over the crank angle, up to the twelfth.
    pub speed_orders: Vec<SpeedOrder>,
    /// Mean power of the loads whose work over a cycle is positive, W.
    pub power_in_w: Estimated,
    /// Mean power that the other loads take out, W, positive.
    pub power_out_w: Estimated,
    /// Work of each load.
    pub loads: Vec<LoadWork>,
    /// Flywheel, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flywheel: Option<Flywheel>,
    /// Notes for the reader.
    pub notes: Vec<String>,
}

impl SteadyState {
    /// Returns the scene started in the steady state, over one cycle if it sets no extent.
    pub fn start(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.motion.speed = self.omega_rad_per_s.value;
        let cycle = Some(Extent::Revolutions(self.cycle_turns.into()));
        scene.run.extent = scene.run.extent.or(cycle);
        scene
    }

    /// Returns the least and the largest signed speed, rad/s.
    pub fn omegas(&self) -> [f64; 2] {
        let [a, b] = [&self.slowest, &self.fastest].map(|extreme| extreme.omega_rad_per_s.value);
        [a.min(b), a.max(b)]
    }
}

/// Work of one load over a period.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadWork {
    /// Key and description of the load, like `torque[1]: ...`, or `friction at the guide`.
    pub name: String,
    /// Mean power of the load over time, W.
    pub power_w: Estimated,
    /// Mean equivalent crank torque over the crank angle, N m.
    pub torque_nm: Estimated,
}

/// Flywheel on the crank.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Flywheel {
    /// Coefficient of fluctuation asked for.
    pub wanted_fluctuation: f64,
    /// Moment of inertia to be added to the crank, kg m²; negative: inertia that can be taken away.
    pub added_inertia_kg_m2: Estimated,
    /// Moment of inertia of the crank with the flywheel, kg m².
    pub crank_inertia_kg_m2: f64,
    /// Coefficient of fluctuation recomputed with the flywheel.
    pub fluctuation: Estimated,
    /// Mean speed with the flywheel, rad/s.
    pub omega_mean_rad_per_s: Estimated,
}
