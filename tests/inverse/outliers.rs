//! Samples that are far off by mistake, in a record whose motion is known.

use slider_crank::inverse::{InverseOptions, inverse};
use slider_crank::scene::{Crank, Measured, Measurement, Scene};

use super::noise::Random;

/// Two outliers near the end of a short record pull a smooth motion to themselves, so that many good samples lie far
/// from it. The noise is that of the good samples; its estimate from 124 of them has a standard deviation of 6.5 %.
#[test]
fn outliers_that_pull_the_motion_are_found() {
    const NOISE: f64 = 1e-3;
    let times: Vec<f64> = (0..126).map(|i| 0.02 * f64::from(i)).collect();
    for seed in 1..=8 {
        let mut random = Random(seed * 7919);
        let mut angles: Vec<f64> = times
            .iter()
            .map(|t| 0.06 + t * (0.5 + t * (2.2 + t * (-1.85 + t * 0.36))))
            .map(|angle| angle + NOISE * random.normal())
            .collect();
        for row in [109, 120] {
            angles[row] -= 0.2;
        }
        let motion = Measurement::new(Measured::Theta, times.clone(), angles).expect("a motion");
        let crank = Crank {
            inertia: 0.03,
            ..Crank::default()
        };
        let scene = Scene::new(0.05, 0.15).crank(crank);
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
        let fit = &found.summary.fit;
        assert_eq!(fit.outliers, 2, "seed {seed}");
        let off = fit.sigma / NOISE - 1.0;
        assert!(off.abs() < 4.0 * 0.065, "seed {seed}: {}", fit.sigma);
    }
}

/// The first or the last of 200 samples is 50 standard deviations off: no other sample shows on its far side where the
/// crank was. A flywheel needs the torque I θ̈.
#[test]
fn an_outlier_at_an_end_is_found() {
    const NOISE: f64 = 1e-3;
    const INERTIA: f64 = 0.03;
    let scene = Scene::new(0.05, 0.15).crank(Crank {
        inertia: INERTIA,
        ..Crank::default()
    });
    let times: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
    for (row, seed) in [0, 199]
        .into_iter()
        .flat_map(|row| (1..=4).map(move |seed| (row, seed)))
    {
        let mut random = Random(seed * 7919);
        let angle = |t: &f64| 5.0 * t + 0.5 * (3.0 * t).sin() + NOISE * random.normal();
        let mut angles: Vec<f64> = times.iter().map(angle).collect();
        angles[row] += 50.0 * NOISE;
        let motion = Measurement::new(Measured::Theta, times.clone(), angles).expect("a motion");
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
        assert_eq!(found.summary.fit.outliers, 1, "row {row}, seed {seed}");
        let covered = found.rows.iter().filter(|row| {
            let exact = -4.5 * INERTIA * (3.0 * row.t).sin();
            let [torque, se] =
                [row.crank_torque, row.crank_torque_se].map(Option::unwrap_or_default);
            (torque - exact).abs() <= found.summary.band_factor * se
        });
        let covered = covered.count();
        assert!(covered >= 180, "row {row}, seed {seed}: {covered}");
    }
}
