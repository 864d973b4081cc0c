//! Steps of encoders: their errors are the same at the same places of the steps, and a fit follows what changes slowly of
//! them. The band holds the force all the same, whatever the places.

use std::f64::consts::TAU;

use slider_crank::scene::{Crank, Measured, Measurement, Scene, Slider};
use slider_crank::study::{FitKind, InverseOptions, inverse};

const CRANK: f64 = 0.05;
const ROD: f64 = 0.15;
const INERTIA: f64 = 2e-3;
const MASS: f64 = 0.4;

/// A slider and a crank with inertia: the force is known in closed form.
fn scene() -> Scene {
    Scene::new(CRANK, ROD)
        .crank(Crank {
            inertia: INERTIA,
            ..Crank::default()
        })
        .slider(Slider { mass: MASS })
}

/// The force on the slider at a crank angle, speed and acceleration.
fn force([theta, omega, alpha]: [f64; 3]) -> f64 {
    let (sin, cos) = theta.sin_cos();
    // x = r cos θ + √(l² − r² sin² θ) and its derivatives.
    let root = (ROD * ROD - (CRANK * sin).powi(2)).sqrt();
    let inner = -CRANK * CRANK * sin * cos / root;
    let first = -CRANK * sin + inner;
    let second =
        -CRANK * cos - CRANK * CRANK * (cos * cos - sin * sin) / root - inner * inner / root;
    INERTIA * alpha / first + MASS * (first * alpha + second * omega * omega)
}

const STEP: f64 = TAU / 1000.0;

/// How many places of the steps are tried.
const PLACES: u32 = 10;

/// Part of the forces inside their bands: mean over the places of a motion in an encoder's steps, given by crank angle, speed
/// and acceleration at a time (s), for as many samples each millisecond.
fn covered(fit: FitKind, rows: u32, motion: impl Fn(f64) -> [f64; 3]) -> f64 {
    let options = InverseOptions {
        fit,
        ..InverseOptions::default()
    };
    let of_place = |place: u32| {
        let moved = f64::from(place) / f64::from(PLACES);
        let times: Vec<f64> = (0..rows).map(|i| 1e-3 * f64::from(i)).collect();
        let shown = |t: &f64| ((motion(*t)[0] / STEP + moved).round() - moved) * STEP;
        let angles = times.iter().map(shown).collect();
        let samples = Measurement::new(Measured::Theta, times, angles).expect("samples");
        let found = inverse(&scene(), &samples, &options).expect("an inversion");
        let (mut inside, mut all) = (0.0, 0.0);
        for row in &found.rows {
            if let (Some(found_force), Some(error)) = (row.slider_force, row.slider_force_se) {
                let half = found.summary.band_factor * error;
                all += 1.0;
                inside += f64::from((found_force - force(motion(row.t))).abs() <= half);
            }
        }
        assert!(all > 0.8 * f64::from(rows));
        inside / all
    };
    (0..PLACES).map(of_place).sum::<f64>() / f64::from(PLACES)
}

/// Even motion of so many steps from sample to sample.
fn even(steps: f64) -> impl Fn(f64) -> [f64; 3] {
    let speed = steps * STEP / 1e-3;
    move |t| [0.3 + speed * t, speed, 0.0]
}

/// Almost every sample, every third or every second is at the same place of its step.
#[test]
fn errors_that_a_spline_follows() {
    for steps in [2.007, 3.3345, 0.502] {
        let share = covered(FitKind::Spline, 1200, even(steps));
        assert!(share >= 0.9, "{steps}: {share}");
    }
}

#[test]
fn errors_that_harmonics_follow() {
    let wavy = |t: f64| {
        let speed = 4.0001 * STEP / 1e-3;
        let (sin, cos) = (speed * t).sin_cos();
        [
            0.3 + speed * t + 0.03 * sin,
            speed * (1.0 + 0.03 * cos),
            -0.03 * speed * speed * sin,
        ]
    };
    let share = covered(FitKind::Fourier, 1200, wavy);
    assert!(share >= 0.85, "{share}");
}

/// Many samples in each step: where the motion turns round, the passages to the next step beside it are far apart, and at
/// the same border.
#[test]
fn a_swing_of_few_steps() {
    let swing = |t: f64| {
        let (sin, cos) = (1.1 * t).sin_cos();
        [0.9 + 0.7 * sin, 0.77 * cos, -0.847 * sin]
    };
    let share = covered(FitKind::Polynomial, 9000, swing);
    assert!(share >= 0.9, "{share}");
}

/// An even motion of whole steps from sample to sample shows nothing of the steps.
#[test]
fn an_even_motion_may_be_rounded() {
    let whole = even(28.0);
    let times: Vec<f64> = (0..80).map(|i| 1e-3 * f64::from(i)).collect();
    let angles = times.iter().map(|t| whole(*t)[0]).collect();
    let samples = Measurement::new(Measured::Theta, times, angles).expect("samples");
    let found = inverse(&scene(), &samples, &InverseOptions::default()).expect("an inversion");
    let warnings = &found.summary.warnings;
    let said = |warning: &String| warning.contains("takes them as exact");
    assert!(warnings.iter().any(said), "{warnings:#?}");
}
