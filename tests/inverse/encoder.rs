//! Codes of an encoder on a crank at constant speed, whose force has a closed form.

use std::f64::consts::TAU;

use slider_crank::inverse::{InverseOptions, inverse};
use slider_crank::scene::{Measured, Measurement, Scene, Slider};

const R: f64 = 0.05;
const L: f64 = 0.15;
const SPEED: f64 = 10.0;
const MASS: f64 = 2.0;

/// Force on the slider: its mass times x'' ω², x = r cos θ + √(l² − r² sin² θ).
fn force(theta: f64) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let rod = (L * L - R * R * sin * sin).sqrt();
    let half = R * R * sin * cos;
    let bent = (R * R * (cos * cos - sin * sin)) / rod + half * half / rod.powi(3);
    MASS * SPEED * SPEED * (-R * cos - bent)
}

/// Codes that begin where the angle is, as of a counter, not in its middle, with an index mark that is off by part of a step: the
/// error of the zero is in the band and in the budget.
#[test]
fn the_zero_of_an_encoder_is_in_the_band() {
    for steps in [256.0, 1024.0] {
        for off in [-0.9, 0.0, 0.9] {
            let step = TAU / steps;
            let times: Vec<f64> = (0..1500).map(|i| 0.0013 * f64::from(i)).collect();
            let angles: Vec<f64> = times.iter().map(|t| 0.3 + SPEED * t).collect();
            let codes = angles
                .iter()
                .map(|a| ((a / step).floor() + 0.5 + off) * step);
            let motion =
                Measurement::new(Measured::Theta, times, codes.collect()).expect("a motion");
            let scene = Scene::new(R, L).slider(Slider { mass: MASS });
            let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
            let factor = found.summary.band_factor;
            let (mut inside, mut all) = (0.0, 0.0);
            for (row, angle) in found.rows.iter().zip(&angles) {
                let (Some(found), Some(se)) = (row.slider_force, row.slider_force_se) else {
                    continue;
                };
                all += 1.0;
                inside += f64::from(u8::from((found - force(*angle)).abs() <= factor * se));
            }
            assert!(
                inside >= 0.9 * all,
                "{steps} steps, off by {off}: {inside} of {all}"
            );
            let budget = &found.summary.error_budget;
            let zero = budget.iter().find(|part| part.source.contains("encoder"));
            let share: f64 = budget.iter().map(|part| part.share).sum();
            assert!(zero.is_some() && (share - 1.0).abs() < 1e-9, "{budget:?}");
        }
    }
}
