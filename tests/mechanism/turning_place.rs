//! Turning point of a crank, compared with the closed form of a pendulum in 31 digits: near the top its angle depends
//! on the last digits of the energy, however accurate the time is.

use std::f64::consts::FRAC_PI_2;

use crate::support::exact::Dd;
use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Gravity, Scene};
use slider_crank::simulate::{Options, Summary, simulate};

const G: f64 = 9.80665;
const MASS: f64 = 1.3;
const INERTIA: f64 = 1.7e-3;

/// Runs a crank upwards from the height of the pivot, with a speed (rad/s), for a duration (s).
fn run(cg: f64, speed: f64, duration: f64) -> Summary {
    let scene = Scene::new(0.05, 0.15)
        .crank(Crank {
            mass: MASS,
            cg,
            inertia: INERTIA,
            ..Crank::default()
        })
        .gravity(Gravity::standard())
        .start(0.0, speed)
        .duration(duration);
    let options = Options {
        method: Method::Energy,
        ..Options::default()
    };
    simulate(&scene, &options).expect("a run").summary
}

/// Returns the turning point, where sin θ = I ω₀²/(2 m g c), from the top by the difference from one in 31 digits.
fn turning_point(cg: f64, speed: f64) -> f64 {
    let dd = Dd::from;
    let twice = dd(2.0) * dd(MASS) * dd(G) * dd(cg);
    let missing = (twice - dd(INERTIA) * dd(speed) * dd(speed)) / twice;
    let from_top = 2.0 * (missing / dd(2.0)).sqrt().value().asin();
    FRAC_PI_2 - from_top
}

#[test]
fn the_place_of_a_turning_point_is_as_good_as_stated() {
    let mut beyond_rounding = 0;
    for i in 0..60 {
        let cg = 0.02 + 1e-4 * f64::from(i);
        let below = 10f64.powf(-2.0 - 0.1 * f64::from(i));
        let speed = ((1.0 - below) * 2.0 * MASS * G * cg / INERTIA).sqrt();
        let theta = turning_point(cg, speed);
        let long = run(cg, speed, 10.0);
        let turning = long
            .events
            .iter()
            .find(|event| event.kind == "turning-point");
        let at = run(cg, speed, turning.expect("a turning point").t_s);
        let error = (at.last.theta_rad - theta).abs();
        let stated = at.error_estimate.expect("an estimate").theta_rad;
        assert!(error <= 2.0 * stated, "{below:e}: {error:e} {stated:e}");
        // Energies and the balance between them are rounded, and near the top the force is small beside that before.
        let rounding = f64::EPSILON * (5.0 + 8.0 / (FRAC_PI_2 - theta));
        assert!(stated <= rounding, "{below:e}: {stated:e} {rounding:e}");
        beyond_rounding += u32::from(error > 4.0 * f64::EPSILON);
    }
    assert!(beyond_rounding > 10, "{beyond_rounding}");
}
