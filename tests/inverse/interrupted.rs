//! A request to stop ends an inverse computation at any time.

use std::thread;
use std::time::Instant;

use slider_crank::Stop;
use slider_crank::error::Error;
use slider_crank::inverse::{Inverse, InverseOptions, inverse};
use slider_crank::scene::{Gravity, Load, Measured, Measurement, Scene, Slider};
use slider_crank::simulate::{Options, simulate};

use crate::noise::Random;

const SAMPLES: usize = 4000;

fn scene() -> Scene {
    Scene::new(0.05, 0.15)
        .offset(0.01)
        .slider(Slider { mass: 0.8 })
        .crank(slider_crank::scene::Crank {
            inertia: 0.01,
            ..Default::default()
        })
        .gravity(Gravity::standard())
        .torque(Load::Viscous(0.002))
        .start(0.3, 25.0)
        .duration(2.0)
}

/// Returns noisy samples: angles, slider positions, and angles in encoder steps.
fn records() -> Vec<Measurement> {
    let run = simulate(&scene(), &Options::default()).expect("a run");
    let times: Vec<f64> = (0..SAMPLES)
        .map(|i| 2.0 * i as f64 / SAMPLES as f64)
        .collect();
    let mut random = Random(7);
    let mut noise = |size: f64| size * random.normal();
    let of = |value: &mut dyn FnMut(f64) -> f64| -> Vec<f64> {
        times.iter().map(|t| value(*t)).collect()
    };
    let theta = of(&mut |t| run.at(t).expect("inside").0 + noise(3e-4));
    let x = of(&mut |t| run.row(t).expect("inside").x + noise(2e-5));
    let record = |measured, values| Measurement::new(measured, times.clone(), values);
    let step = std::f64::consts::TAU / 1024.0;
    let codes = theta.iter().map(|theta| (theta / step).round() * step);
    vec![
        record(Measured::Theta, codes.collect()).expect("a record"),
        record(Measured::Theta, theta).expect("a record"),
        record(Measured::X, x).expect("a record"),
    ]
}

fn recovered(record: &Measurement, stop: Option<Stop>) -> Result<Inverse, Error> {
    let options = InverseOptions {
        stop,
        ..InverseOptions::default()
    };
    inverse(&scene(), record, &options)
}

#[test]
fn it_may_be_asked_to_end_at_any_time() {
    for record in records() {
        let begun = Instant::now();
        assert!(recovered(&record, Some(Stop::default())).is_ok());
        let mut whole = begun.elapsed();
        let mut heeded = 0;
        for part in 0..12 {
            let stop = Stop::default();
            let asks = stop.clone();
            let wait = whole.mul_f64(f64::from(part) / 12.0);
            if part == 0 {
                asks.request();
            }
            let asked = thread::spawn(move || {
                thread::sleep(wait);
                asks.request();
            });
            // The delay depends on the machine and on what else it does; a request made before the start takes effect at once.
            let begun = Instant::now();
            match recovered(&record, Some(stop)) {
                Err(Error::Interrupted) => heeded += 1,
                Ok(_) => {
                    assert!(part > 0);
                    whole = whole.min(begun.elapsed());
                }
                Err(error) => panic!("{error}"),
            }
            asked.join().expect("no panic");
        }
        assert!(heeded > 4, "{heeded} of 12");
    }
}
