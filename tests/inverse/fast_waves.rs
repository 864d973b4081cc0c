//! Motions with waves of a few samples, which a smooth fit takes for noise.

use crate::noise::Random;
use slider_crank::scene::{Crank, Load, Measured, Measurement, Scene, Slider, Variables};
use slider_crank::study::{
    FitKind, Inverse, InverseOptions, Options, Simulation, inverse, simulate,
};
use std::f64::consts::TAU;

const SAMPLES: u32 = 300;
const END: f64 = 1.0;
const NOISE: f64 = 1e-4;

/// Samples for each wave that a smooth curve does not follow.
const FAST: [f64; 3] = [2.3, 2.9, 3.7];

/// A force of a slow wave and one of so many samples.
fn force(samples: f64) -> impl Fn(f64) -> f64 + Clone + Send + Sync {
    let rate = TAU * f64::from(SAMPLES - 1) / (END * samples);
    move |t| 15.0 * (9.0 * t).sin() + 2e-4 * rate * rate * (rate * t).sin()
}

/// A run under a force over time.
fn run(force: impl Fn(f64) -> f64 + Send + Sync + 'static) -> (Scene, Simulation) {
    let scene = Scene::new(0.05, 0.15)
        .offset(0.01)
        .crank(Crank {
            inertia: 2e-3,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.4 })
        .start(0.3, 20.0)
        .duration(END);
    let load = Load::function(Variables::T, move |now| force(now.t));
    let run = simulate(&scene.clone().force(load), &Options::default()).expect("a run");
    (scene, run)
}

/// The crank angles of a run with noise, inverted.
fn inverted(scene: &Scene, run: &Simulation, fit: FitKind, random: &mut Random) -> Inverse {
    let times = (0..SAMPLES).map(|i| END * f64::from(i) / f64::from(SAMPLES - 1));
    let times: Vec<f64> = times.collect();
    let angle = |t: &f64| run.at(*t).expect("inside").0;
    let angles = times.iter().map(|t| angle(t) + NOISE * random.normal());
    let measured = Measurement::new(Measured::Theta, times.clone(), angles.collect());
    let options = InverseOptions {
        fit,
        ..InverseOptions::default()
    };
    inverse(scene, &measured.expect("samples"), &options).expect("an inversion")
}

fn says(found: &Inverse) -> bool {
    let warnings = &found.summary.warnings;
    warnings
        .iter()
        .any(|w| w.contains("the residuals have waves"))
}

/// They are said, and the band has room for the force that they belong to, but not for much more.
#[test]
fn waves_too_fast_for_the_fit_are_in_the_band() {
    let mut random = Random(2_463_534_242);
    for samples in FAST {
        let force = force(samples);
        let (scene, run) = run(force.clone());
        for fit in [FitKind::Spline, FitKind::Polynomial] {
            let found = inverted(&scene, &run, fit, &mut random);
            assert!(says(&found), "{fit:?} of waves of {samples} samples");
            let (mut all, mut inside, mut squares) = (0, 0, 0.0);
            for row in &found.rows {
                if let (Some(given), Some(error)) = (row.slider_force, row.slider_force_se) {
                    let off = (given - force(row.t)).abs();
                    all += 1;
                    inside += usize::from(off <= found.summary.band_factor * error);
                    squares += (off / error).powi(2);
                }
            }
            let usual = (squares / f64::from(all)).sqrt();
            let part = inside as f64 / f64::from(all);
            assert!(part >= 0.9, "{fit:?}, {samples}: {part}");
            assert!((0.3..=1.3).contains(&usual), "{fit:?}, {samples}: {usual}");
        }
    }
}

/// Noise alone has none.
#[test]
fn noise_is_no_wave() {
    let (scene, run) = run(|t| 15.0 * (9.0 * t).sin());
    let mut random = Random(362_436_069);
    for fit in [FitKind::Spline, FitKind::Polynomial] {
        let said = (0..50).filter(|_| says(&inverted(&scene, &run, fit, &mut random)));
        assert!(said.count() <= 1, "{fit:?}");
    }
}
