//! Times that were rounded to decimals, or lost digits far from zero: even samples are fitted as such, and the band holds
//! what is left unknown.

use std::path::Path;

use slider_crank::scene::{Crank, Measured, Measurement, Reading, Scene, Slider};
use slider_crank::study::{FitKind, Inverse, InverseOptions, inverse};

/// A crank with an even load torque and no mass but its own: its force is known in closed form.
fn scene() -> Scene {
    Scene::new(0.05, 0.15)
        .crank(Crank {
            inertia: 2e-3,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.4 })
}

const ROWS: usize = 600;

/// Time from sample to sample, s: a little more than 1 ms, so that each 50th sample is a microsecond late.
const PERIOD: f64 = 1.000_02e-3;

const SPEED: f64 = 30.0;

/// Crank angle, speed and acceleration at a sample.
fn motion(sample: usize) -> [f64; 3] {
    let t = PERIOD * sample as f64;
    let (sin, cos) = (9.0 * t).sin_cos();
    [0.4 + SPEED * t + 0.2 * sin, SPEED + 1.8 * cos, -16.2 * sin]
}

/// The force on the slider that a motion of this scene needs: that on the slider's mass, and on the crank's.
fn force(sample: usize) -> f64 {
    let [theta, omega, alpha] = motion(sample);
    // x' and x'' from small steps of x, which is good to 1e-8.
    let x =
        |theta: f64| 0.05 * theta.cos() + (0.15f64.powi(2) - (0.05 * theta.sin()).powi(2)).sqrt();
    let step = 1e-4;
    let first = (x(theta + step) - x(theta - step)) / (2.0 * step);
    let second = (x(theta + step) - 2.0 * x(theta) + x(theta - step)) / (step * step);
    2e-3 * alpha / first + 0.4 * (first * alpha + second * omega * omega)
}

/// Noise of unit variance, about: even numbers, the same in every run.
fn noise(sample: usize) -> f64 {
    let turned = (sample as f64 * 0.754_877_666_246_693).fract();
    let other = (sample as f64 * sample as f64 * 0.569_840_290_998_053).fract();
    6f64.sqrt() * (turned + other - 1.0)
}

fn angles() -> Vec<f64> {
    (0..ROWS).map(|i| motion(i)[0] + 3e-7 * noise(i)).collect()
}

#[track_caller]
fn is_covered(motion: &Measurement, fit: FitKind) {
    let options = InverseOptions {
        fit,
        ..InverseOptions::default()
    };
    let found = inverse(&scene(), motion, &options).expect("an inversion");
    let warnings = &found.summary.warnings;
    assert!(
        warnings.iter().any(|w| w.contains("takes them as even")),
        "{warnings:#?}"
    );
    let share = covered(&found);
    assert!(share >= 0.88, "{fit:?}: {share}");
}

/// Part of the forces inside their bands, which are not wide.
fn covered(found: &Inverse) -> f64 {
    let (mut inside, mut all) = (0.0, 0.0);
    for (i, row) in found.rows.iter().enumerate() {
        if let (Some(found_force), Some(error)) = (row.slider_force, row.slider_force_se) {
            let half = found.summary.band_factor * error;
            all += 1.0;
            inside += f64::from((found_force - force(i)).abs() <= half);
        }
    }
    inside / all
}

#[test]
fn even_samples_of_rounded_times() {
    let mut text = "t [s],theta [rad]\n".to_owned();
    for (i, theta) in angles().into_iter().enumerate() {
        text += &format!("{:.6},{theta}\n", PERIOD * i as f64);
    }
    let motion = Measurement::parse(Path::new("rounded.csv"), text, &Reading::default());
    let motion = motion.expect("samples");
    assert!(motion.time_uncertainty() > 0.0 && motion.time_uncertainty() < 1e-6);
    for fit in [FitKind::Polynomial, FitKind::Spline] {
        is_covered(&motion, fit);
    }
}

/// Doubles near 1.7e9 s, the time of a computer's clock, are 2.4e-7 s apart.
#[test]
fn even_samples_of_a_clock() {
    let times = (0..ROWS).map(|i| 1.7e9 + PERIOD * i as f64).collect();
    let motion = Measurement::new(Measured::Theta, times, angles()).expect("samples");
    assert_eq!(motion.origin(), 1.7e9);
    for fit in [FitKind::Polynomial, FitKind::Spline] {
        is_covered(&motion, fit);
    }
}

/// Uneven times that were rounded are said, exact ones are not.
#[test]
fn uneven_rounded_times_are_said() {
    let time = |i: usize| PERIOD * (i as f64 + 0.3 * noise(i) / 3.0);
    let exact = |t: f64| 0.4 + SPEED * t + 0.2 * (9.0 * t).sin();
    let angles: Vec<f64> = (0..ROWS).map(|i| exact(time(i))).collect();
    let rounded = |i: usize| (time(i) * 1e6).round() * 1e-6;
    for (times, said) in [
        ((0..ROWS).map(rounded).collect::<Vec<f64>>(), true),
        ((0..ROWS).map(time).collect(), false),
    ] {
        let motion = Measurement::new(Measured::Theta, times, angles.clone()).expect("samples");
        let found = inverse(&scene(), &motion, &InverseOptions::default()).expect("an inversion");
        let warnings = &found.summary.warnings;
        let of_times = |w: &String| w.contains("uneven and rounded");
        assert_eq!(warnings.iter().any(of_times), said, "{warnings:#?}");
    }
}

/// Times that are what they are stay so.
#[test]
fn other_times_are_left() {
    let sample = |i: usize| PERIOD * i as f64;
    let late = |i: usize| sample(i) + 1e-6 * ((i * i) % 7) as f64;
    for times in [
        (0..ROWS).map(sample).collect::<Vec<f64>>(),
        (0..ROWS).map(late).collect(),
    ] {
        let motion = Measurement::new(Measured::Theta, times.clone(), angles()).expect("samples");
        assert_eq!(motion.elapsed(), times);
        assert_eq!(motion.time_uncertainty(), 0.0);
    }
}
