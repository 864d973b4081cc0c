//! Free motion compared with an independent quadrature of the energy integral.
//!
//! Without loads ½ M(θ) θ̇² + V(θ) is constant, so that θ̇(θ) is known and t(θ) = ∫ dθ/θ̇. M and V are derived here
//! independently, from positions and velocities of the bodies.

use crate::energy_integral::EnergyIntegral;
use slider_crank::plan::Method;
use slider_crank::scene::{Branch, Crank, Gravity, InertiaAbout, Rod, RodModel, Scene, Slider};
use slider_crank::simulate::{Options, simulate};

fn engine() -> Scene {
    Scene::duarte()
}

fn offset_mechanism() -> Scene {
    Scene::new(0.14, 0.31)
        .offset(0.06)
        .crank(Crank {
            mass: 0.764,
            cg: 0.07,
            cg_lateral: 0.004,
            inertia: 6.2e-3,
        })
        .rod(Rod {
            model: RodModel::Rigid,
            mass: 1.56,
            cg: 0.155,
            cg_lateral: -0.01,
            inertia: 14.56e-3,
            inertia_about: InertiaAbout::Cg,
        })
        .slider(Slider { mass: 1.95 })
        .gravity(Gravity {
            acceleration: 9.80665,
            direction: -1.1,
        })
        .start(0.4, 31.416)
        .duration(1.0)
}

fn scenes() -> Vec<(&'static str, Scene)> {
    vec![
        ("engine", engine()),
        ("engine, clockwise", engine().start(0.3, -80.0)),
        ("offset", offset_mechanism()),
        ("negative offset", offset_mechanism().offset(-0.06)),
        ("left branch", offset_mechanism().branch(Branch::Left)),
        (
            "left branch, negative offset, clockwise",
            offset_mechanism()
                .branch(Branch::Left)
                .offset(-0.06)
                .start(2.0, -31.416),
        ),
    ]
}

/// Returns the resolution of θ and θ̇: rounding of the reference and of the final angle.
fn resolution(theta: f64) -> f64 {
    4e-16 * theta.abs() + 2e-14
}

#[test]
fn the_stated_error_is_true_at_every_tolerance() {
    for (name, scene) in scenes() {
        let (theta, omega) = EnergyIntegral::new(&scene).state(1.0);
        for method in [Method::Dop853, Method::Dopri5] {
            for tolerance in [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13] {
                if method == Method::Dopri5 && tolerance < 1e-12 {
                    continue;
                }
                let options = Options {
                    method,
                    ..Options::default()
                };
                let run = simulate(&scene.clone().tolerance(tolerance), &options).unwrap();
                let last = run.summary.last;
                let stated = run.summary.error_estimate.unwrap();
                for (what, error, estimate) in [
                    ("angle", (last.theta_rad - theta).abs(), stated.theta_rad),
                    (
                        "speed",
                        (last.omega_rad_per_s - omega).abs(),
                        stated.omega_rad_per_s,
                    ),
                ] {
                    let resolved = resolution(theta);
                    assert!(
                        error <= 2.0 * estimate + resolved,
                        "{name} {method} {tolerance:e}: {what} is wrong by {error:e}, stated {estimate:e}"
                    );
                    assert!(
                        estimate <= 10.0 * error + 100.0 * resolved.max(3e-13),
                        "{name} {method} {tolerance:e}: {what} is wrong by {error:e} only, stated {estimate:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_motion_inside_a_run_is_as_exact_as_its_end() {
    for (name, scene) in scenes() {
        let reference = EnergyIntegral::new(&scene);
        for tolerance in [1e-8, 1e-10, 1e-12] {
            let options = Options {
                method: Method::Time,
                ..Options::default()
            };
            let run = simulate(&scene.clone().tolerance(tolerance), &options).unwrap();
            let stated = run.summary.error_estimate.unwrap();
            for i in 1..200 {
                let t = f64::from(i) / 200.0;
                let (theta, omega) = run.at(t).unwrap();
                let (theta_true, omega_true) = reference.state(t);
                let (e1, e2) = ((theta - theta_true).abs(), (omega - omega_true).abs());
                let scale = stated.theta_rad.max(tolerance);
                assert!(
                    e1 < 5.0 * scale + resolution(theta),
                    "{name} {tolerance:e} t {t}: {e1:e} {scale:e}"
                );
                let scale = stated.omega_rad_per_s.max(100.0 * tolerance);
                assert!(
                    e2 < 20.0 * scale + resolution(theta),
                    "{name} {tolerance:e} t {t}: {e2:e} {scale:e}"
                );
            }
        }
    }
}
