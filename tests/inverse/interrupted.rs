//! A request to stop ends an inverse computation whenever it is made.

use std::thread;
use std::time::{Duration, Instant};

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

/// Samples with noise: angles, slider positions, and angles in steps of an encoder.
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
fn it_ends_soon_whenever_it_is_asked() {
    for record in records() {
        let begun = Instant::now();
        assert!(recovered(&record, Some(Stop::default())).is_ok());
        let whole = begun.elapsed();
        for part in 0..12 {
            let stop = Stop::default();
            let asks = stop.clone();
            let wait = whole.mul_f64(f64::from(part) / 12.0);
            let asked = thread::spawn(move || {
                thread::sleep(wait);
                asks.request();
            });
            let begun = Instant::now();
            let found = recovered(&record, Some(stop));
            let took = begun.elapsed();
            asked.join().expect("no panic");
            // A busy machine may have been faster this time.
            match found {
                Err(Error::Interrupted) => {
                    let late = took.saturating_sub(wait);
                    assert!(
                        late < whole / 2 + Duration::from_millis(200),
                        "{late:?} of {whole:?}"
                    );
                }
                Ok(_) => assert!(part > 6, "{part}: {took:?} of {whole:?}"),
                Err(error) => panic!("{error}"),
            }
        }
    }
}
