//! Orders of the crank speed: its Fourier coefficients over the crank angle of a cycle.

use std::f64::consts::TAU;

use serde::Serialize;

use super::periodic_orbit::Found;
use super::result::Estimated;
use crate::simulate::error_estimate::MARGIN;

/// What the crank speed repeats so many times a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedOrder {
    /// Per turn.
    pub order: f64,
    /// Amplitude, rad/s.
    pub amplitude_rad_per_s: Estimated,
}

/// Highest order.
const HIGHEST: f64 = 12.0;

/// Samples of a turn: the rectangle rule is exact for orders up to this less the highest.
const SAMPLES: f64 = 1024.0;

/// The orders of a motion, with errors from another computation of it and this relative error of its speeds.
pub(super) fn orders(found: &Found, check: &Found, relative: f64) -> Vec<SpeedOrder> {
    let [speeds, others] = [found, check].map(|motion| {
        let count = (SAMPLES * motion.turns) as u32;
        let step = motion.way() / f64::from(count);
        let speed = |k: u32| motion.omega(f64::from(k) * step);
        (0..count).map(speed).collect::<Vec<f64>>()
    });
    let rounding = relative * found.speed.abs();
    let order = |k: u32| {
        let [value, other] = [&speeds, &others].map(|speeds| amplitude(speeds, k));
        SpeedOrder {
            order: f64::from(k) / found.turns,
            amplitude_rad_per_s: Estimated {
                value,
                error: MARGIN * (value - other).abs() + rounding,
            },
        }
    };
    (1..=(HIGHEST * found.turns) as u32).map(order).collect()
}

/// Amplitude of what repeats k times in the samples.
fn amplitude(samples: &[f64], k: u32) -> f64 {
    let count = samples.len() as f64;
    let (mut even, mut odd) = (0.0, 0.0);
    for (index, sample) in samples.iter().enumerate() {
        let (sin, cos) = (TAU * f64::from(k) * index as f64 / count).sin_cos();
        even += sample * cos;
        odd += sample * sin;
    }
    2.0 * even.hypot(odd) / count
}
