//! Loads in motion: time-dependent ones preserve the order of the method, and ones of zero strength have no effect.

use slider_crank::plan::Method;
use slider_crank::scene::{
    Crank, Expression, Friction, Gravity, Interpolation, Load, Rod, Scene, Slider, Table, Variable,
    Variables,
};
use slider_crank::simulate::{Options, Row, simulate, simulate_rows};

const INERTIA: f64 = 0.02;
const DAMPING: f64 = 0.05;
const RATE: f64 = 13.0;

/// Crank alone: I θ̈ = sin(RATE t) − DAMPING θ̇, from rest.
fn shaken_crank() -> Scene {
    Scene::new(0.05, 0.2)
        .crank(Crank {
            inertia: INERTIA,
            ..Crank::default()
        })
        .torque(Load::function(Variables::T, |now| (RATE * now.t).sin()))
        .torque(Load::Viscous(DAMPING))
        .start(0.0, 0.0)
        .duration(3.0)
}

/// Returns the solution θ̇ = A (k sin wt − w cos wt + w e^(−kt)), k = damping/inertia, A = 1/(I (k² + w²)).
fn shaken_solution(t: f64) -> (f64, f64) {
    let (k, w) = (DAMPING / INERTIA, RATE);
    let a = 1.0 / (INERTIA * (k * k + w * w));
    let fading = (-k * t).exp();
    let speed = a * (k * (w * t).sin() - w * (w * t).cos() + w * fading);
    let angle = a * (k / w * (1.0 - (w * t).cos()) - (w * t).sin() + w / k * (1.0 - fading));
    (angle, speed)
}

#[test]
fn loads_in_time_reach_the_order_of_the_method() {
    let (angle, speed) = shaken_solution(3.0);
    for (method, order) in [(Method::Dop853, 8.0), (Method::Dopri5, 5.0)] {
        let mut evaluations = Vec::new();
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
            let options = Options {
                method,
                ..Options::default()
            };
            let run = simulate(&shaken_crank().tolerance(tolerance), &options).unwrap();
            let last = run.summary.last;
            let stated = run.summary.error_estimate.unwrap();
            let error = (last.theta_rad - angle).abs();
            assert!(
                error < 100.0 * tolerance,
                "{method} {tolerance:e}: {error:e}"
            );
            assert!(
                error < 2.0 * stated.theta_rad,
                "{method} {tolerance:e}: {error:e} {stated:?}"
            );
            let error = (last.omega_rad_per_s - speed).abs();
            assert!(
                error < 2.0 * stated.omega_rad_per_s,
                "{method} {tolerance:e}: {error:e} {stated:?}"
            );
            evaluations.push(run.summary.evaluations as f64);
        }
        // Six more digits take 10^(6/order) times the steps; wrong stage times would take 10^6.
        let growth = evaluations[3] / evaluations[0];
        assert!(
            growth < 1.6 * 1e6f64.powf(1.0 / order),
            "{method}: {evaluations:?}"
        );
    }
}

#[test]
fn a_table_over_time_is_followed_through_its_corners() {
    // The torque rises linearly to 1 N m at 0.5 s and falls back to zero at 1 s.
    let table = Table::new(
        Variable::T,
        &[0.0, 0.5, 1.0],
        &[0.0, 1.0, 0.0],
        Interpolation::Linear,
        None,
    );
    let scene = Scene::new(0.05, 0.2)
        .crank(Crank {
            inertia: INERTIA,
            ..Crank::default()
        })
        .torque(Load::Table(table.unwrap()))
        .duration(1.0);
    let run = simulate(&scene, &Options::default()).unwrap();
    let last = run.summary.last;
    // Impulse 0.5 N m s; angle 0.25/I by symmetry.
    assert!(
        (last.omega_rad_per_s - 0.5 / INERTIA).abs() < 1e-8,
        "{last:?}"
    );
    assert!((last.theta_rad - 0.25 / INERTIA).abs() < 1e-8, "{last:?}");
}

#[test]
fn the_work_of_the_loads_closes_the_energy_balance() {
    let scene = Scene::duarte()
        .torque(Load::Constant(2.0))
        .torque(Load::Viscous(0.02))
        .torque(Load::Motor {
            stall: 5.0,
            no_load_speed: 150.0,
        })
        .force(Load::Spring {
            stiffness: 800.0,
            rest: 0.15,
        })
        .force(Load::Constant(-40.0))
        .force(Load::Viscous(9.0))
        .force(Load::function(Variables::T.or(Variables::X), |now| {
            30.0 * (7.0 * now.t).sin() - 200.0 * now.x
        }));
    for tolerance in [1e-8, 1e-10, 1e-12] {
        let options = Options {
            method: Method::Time,
            ..Options::default()
        };
        let run = simulate(&scene.clone().tolerance(tolerance), &options).unwrap();
        let residual = run.summary.energy_residual.abs();
        assert!(residual < 100.0 * tolerance, "{tolerance:e}: {residual:e}");
        assert!(residual > 0.0);
    }
}

fn rows(scene: &Scene) -> (Vec<Row>, u64) {
    let mut rows: Vec<Row> = Vec::new();
    let run = simulate_rows(scene, &Options::default(), &mut rows).unwrap();
    (rows, run.summary.evaluations)
}

#[test]
fn a_part_without_strength_leaves_the_run_the_same_to_the_last_bit() {
    let plain = Scene::new(0.047, 0.15583)
        .offset(0.01)
        .crank(Crank {
            inertia: 0.0277,
            ..Crank::default()
        })
        .torque(Load::Constant(2.0))
        .start(0.2, 60.0)
        .duration(0.3);
    let reference = rows(&plain);
    let additions: Vec<(&str, Scene)> = vec![
        ("rod", plain.clone().rod(Rod::default())),
        ("slider", plain.clone().slider(Slider { mass: 0.0 })),
        (
            "gravity",
            plain.clone().gravity(Gravity {
                acceleration: 0.0,
                direction: 0.3,
            }),
        ),
        ("torque", plain.clone().torque(Load::Constant(0.0))),
        ("viscous", plain.clone().torque(Load::Viscous(0.0))),
        (
            "motor",
            plain.clone().torque(Load::Motor {
                stall: 0.0,
                no_load_speed: 100.0,
            }),
        ),
        (
            "formula",
            plain
                .clone()
                .torque(Load::Expression(Expression::parse("0*(2 - 1)").unwrap())),
        ),
        ("force", plain.clone().force(Load::Constant(0.0))),
        ("damper", plain.clone().force(Load::Viscous(0.0))),
        (
            "spring",
            plain.clone().force(Load::Spring {
                stiffness: 0.0,
                rest: 0.1,
            }),
        ),
        ("friction", {
            let mut scene = plain.clone();
            scene.friction = Some(Friction {
                coefficient: 0.0,
                static_coefficient: 0.0,
            });
            scene
        }),
    ];
    for (name, scene) in additions {
        assert_eq!(rows(&scene), reference, "{name}");
    }
    assert_ne!(
        rows(&plain.clone().torque(Load::Constant(1e-9))).0,
        reference.0
    );
}
