//! Records so long that their noise is estimated from segments: variations slower than a segment are found
//! nevertheless.

use std::f64::consts::TAU;

use slider_crank::inverse::{InverseOptions, inverse};
use slider_crank::scene::{Crank, Measured, Measurement, Scene};

use super::noise::Random;

/// Flywheel whose speed of 60 rad/s varies by ±0.1 rad/s with a period of 100 s: its torque is I θ̈, and the sample
/// noise is known.
#[test]
fn a_slow_wave_of_the_speed_is_not_taken_for_noise() {
    const INERTIA: f64 = 0.02;
    const NOISE: f64 = 1e-4;
    const WAVE: f64 = TAU / 100.0;
    let times: Vec<f64> = (0..60_000).map(|i| 1e-3 * f64::from(i)).collect();
    let angle = |t: f64| 60.0 * t + 0.1 / WAVE * (1.0 - (WAVE * t).cos());
    let scene = Scene::new(0.05, 0.15).crank(Crank {
        mass: 1.0,
        inertia: INERTIA,
        ..Crank::default()
    });
    for seed in [0x5bd1_e995_7f4a_7c15, 2, 3, 4, 5] {
        let mut random = Random(seed);
        let measured = times.iter().map(|t| angle(*t) + NOISE * random.normal());
        let record = Measurement::new(Measured::Theta, times.clone(), measured.collect());
        let options = InverseOptions::default();
        let found = inverse(&scene, &record.expect("a record"), &options).expect("an inversion");
        let fit = &found.summary.fit;
        assert!(fit.sigma_error < 0.01 * NOISE, "{} rad", fit.sigma_error);
        assert!(
            (fit.sigma - NOISE).abs() < 4.0 * fit.sigma_error,
            "noise {}",
            fit.sigma
        );
        let covered = found.rows.iter().filter(|row| {
            let exact = 0.1 * WAVE * (WAVE * row.t).cos() * INERTIA;
            let [torque, se] =
                [row.crank_torque, row.crank_torque_se].map(Option::unwrap_or_default);
            (torque - exact).abs() <= found.summary.band_factor * se
        });
        let covered = covered.count() as f64 / times.len() as f64;
        assert!(covered > 0.9, "covered {covered}");
    }
}
