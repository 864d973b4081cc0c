//! Runs of so many revolutions: state and error at the angle where they end.

use std::f64::consts::TAU;

use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Interpolation, Load, Scene, Slider, Table, Variable, Variables};
use slider_crank::simulate::{Options, Summary, simulate};

fn flywheel() -> Scene {
    Scene::new(0.05, 0.15)
        .crank(Crank {
            inertia: 0.01,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.4 })
        .start(0.0, 20.0)
}

fn run(scene: &Scene, method: Method) -> Summary {
    let options = Options {
        method,
        ..Options::default()
    };
    simulate(scene, &options).expect("a run").summary
}

/// A drive that holds a speed of the time forgets errors of the speed, not those of the angle: at the end angle the run is early or
/// late, and the speed is that of another time. A much finer run by another method tells both.
#[test]
fn the_error_of_the_speed_is_that_at_the_end_angle() {
    let drive = Load::function(Variables::T.or(Variables::OMEGA), |now| {
        4.0 * (20.0 + 8.0 * (9.0 * now.t).sin() - now.omega)
    });
    let scene = flywheel().torque(drive).revolutions(4.0);
    let exact = run(&scene.clone().tolerance(1e-13), Method::Dop853);
    for tolerance in [1e-5, 1e-7] {
        for method in [Method::Time, Method::Dop853, Method::Dopri5] {
            let found = run(&scene.clone().tolerance(tolerance), method);
            let error = found.error_estimate.expect("an estimate");
            let off = (found.last.omega_rad_per_s - exact.last.omega_rad_per_s).abs();
            let stated = error.omega_rad_per_s;
            assert!(
                off < 1.2 * stated + 1e-11,
                "{method} {tolerance}: {off} {stated}"
            );
        }
    }
}

/// A table of one turn ends where the run does.
#[test]
fn a_table_that_ends_at_the_end_angle_is_enough() {
    let angles: Vec<f64> = (0..=36)
        .map(|k| f64::from(k) * 10.0 / 180.0 * std::f64::consts::PI)
        .collect();
    let torques: Vec<f64> = angles.iter().map(|angle| 0.5 + angle.sin()).collect();
    for interpolation in [Interpolation::Linear, Interpolation::Pchip] {
        let table = Table::new(Variable::Theta, &angles, &torques, interpolation, None);
        let scene = flywheel()
            .torque(Load::Table(table.expect("a table")))
            .revolutions(1.0);
        for method in [Method::Auto, Method::Time, Method::Dop853] {
            let found = run(&scene, method);
            assert!(found.stopped.is_none(), "{method}: {:?}", found.stopped);
            assert!((found.last.theta_rad - TAU).abs() < 1e-12, "{method}");
        }
    }
}
