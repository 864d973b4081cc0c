//! No run hangs: motions that make no progress end with a clear message, and rest is found without endless search.

use crate::support::machines;
use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Expression, Gravity, Load, Rod, Scene, Slider, Variables};
use slider_crank::simulate::{Options, Summary, simulate};

fn machine() -> Scene {
    Scene::new(0.05, 0.15)
        .offset(0.01)
        .crank(Crank {
            inertia: 1e-3,
            ..Crank::default()
        })
        .rod(Rod {
            mass: 0.3,
            cg: 0.06,
            inertia: 6e-4,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.5 })
        .gravity(Gravity::standard())
        .start(0.9, 5.0)
        .duration(1.0)
}

fn rubbing(coefficient: f64, static_coefficient: f64) -> Scene {
    machines::rubbing(machine(), coefficient, static_coefficient)
}

fn run_with(scene: &Scene, options: &Options) -> Summary {
    let summary = simulate(scene, options).expect("a run").summary;
    let last = summary.last;
    assert!(last.t_s.is_finite() && last.theta_rad.is_finite() && last.omega_rad_per_s.is_finite());
    summary
}

fn run(scene: &Scene) -> Summary {
    run_with(scene, &Options::default())
}

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).expect("a formula"))
}

/// Closures that reverse with the speed hold it at zero by chattering.
#[test]
fn motions_that_make_no_way_are_given_up() {
    let chatter =
        |push, drag: f64| Load::function(Variables::V, move |now| push - drag.copysign(now.v));
    for (scene, t) in [
        (machine().force(chatter(0.0, 5.0)), 0.04),
        (rubbing(0.2, 0.3).force(chatter(-7.0, 10.0)), 0.05),
    ] {
        let summary = run(&scene);
        let why = summary.stopped.expect("given up").to_string();
        assert!(
            why.contains("long before the end") && why.contains("t = "),
            "{why}"
        );
        assert!(summary.last.t_s >= t && summary.evaluations < 20_000_000);
        assert!(summary.energy_residual.abs() < 1e-6);
    }
}

/// A motor of 10⁴ N m s/rad holds its speed against other loads of some N m, and reaches it within some 10⁻⁷ s.
#[test]
fn a_steep_loss_is_followed_in_few_steps() {
    let steep = Load::Motor {
        stall: 1e6,
        no_load_speed: 100.0,
    };
    for method in [Method::Auto, Method::Time] {
        let options = Options {
            method,
            ..Options::default()
        };
        let summary = run_with(&rubbing(0.2, 0.3).torque(steep.clone()), &options);
        assert_eq!(summary.stopped, None);
        assert!(summary.evaluations < 1_000_000, "{}", summary.evaluations);
        let [theta, omega] = [summary.last.theta_rad, summary.last.omega_rad_per_s];
        assert!((omega - 100.0).abs() < 0.01, "{omega}");
        assert!((theta - 100.9).abs() < 1e-4, "{theta}");
        let stated = summary.error_estimate.expect("an estimate");
        assert!(stated.theta_rad < 1e-9, "{stated:?}");
    }
}

/// J ω̇ = c − T tanh(ω/w) ends in a creep at w artanh(c/T): there the error limits the steps, not the sweeps.
#[test]
fn a_crank_that_creeps_takes_few_steps() {
    let (drive, drag, width) = (0.05, 0.5, 1e-4);
    let scene = Scene::new(0.05, 0.15)
        .crank(Crank {
            inertia: 0.02,
            ..Crank::default()
        })
        .torque(formula(&format!("{drive} - {drag}*tanh(omega/{width})")))
        .start(0.3, 20.0)
        .duration(10.0);
    for tolerance in [1e-6, 1e-10] {
        let run = simulate(&scene.clone().tolerance(tolerance), &Options::default());
        let run = run.expect("a run");
        let Summary { last, .. } = run.summary;
        let creep = width * f64::atanh(drive / drag);
        assert!(
            (last.omega_rad_per_s / creep - 1.0).abs() < tolerance,
            "{last:?}"
        );
        let (before, _) = run.at(5.0).expect("inside the run");
        let way = last.theta_rad - before;
        assert!((way / (5.0 * creep) - 1.0).abs() < 1e2 * tolerance, "{way}");
        let evaluations = run.summary.evaluations;
        assert!(evaluations < 8_000, "{evaluations}");
    }
}

/// Regularised friction that sticks and slips, with a drag that falls with the speed (Stribeck): each reversal is a few
/// microseconds long, and the stated errors are near the true ones.
#[test]
fn reversals_under_regularised_friction_leave_true_errors() {
    let machine = machine()
        .crank(Crank {
            inertia: 0.02,
            ..Crank::default()
        })
        .torque(formula("5*sin(2*t)"))
        .start(0.3, 0.0)
        .duration(8.0);
    for drag in [
        "-(2 + 1.5*exp(-(omega/0.5)^2))*tanh(omega/1e-4)",
        "-3*tanh(omega/1e-6)",
        "-3*2/pi*atan(omega/1e-5)",
    ] {
        let with = |tolerance| run(&machine.clone().torque(formula(drag)).tolerance(tolerance));
        let reference = with(1e-13);
        for tolerance in [1e-7, 1e-10] {
            let summary = with(tolerance);
            assert_eq!(summary.stopped, None);
            let error = (summary.last.theta_rad - reference.last.theta_rad).abs();
            let stated = summary.error_estimate.expect("an estimate").theta_rad;
            assert!(
                error <= 2.0 * stated && stated <= 4.0 * error + 1e-11,
                "{drag} at {tolerance:e}: {error:e} {stated:e}"
            );
            assert!(summary.evaluations < 150_000, "{}", summary.evaluations);
        }
    }
}

/// Modelled as friction, the chattering case is a rest.
#[test]
fn dry_friction_comes_to_rest_at_once() {
    let summary = run(&rubbing(0.2, 0.3).force(formula("-5*sign(v)")));
    assert_eq!(summary.stopped, None);
    assert_eq!(summary.events.last().map(|event| event.kind), Some("rest"));
    assert!(summary.evaluations < 10_000);
}

/// At the outer dead centre no force on the slider moves the crank, however large it grows, and the friction band is
/// always zero.
#[test]
fn rest_at_a_dead_centre_is_found_without_search() {
    let mut scene = rubbing(0.2, 0.3).start(0.0, 0.0).force(formula("50*t"));
    scene.geometry.offset = 0.0;
    scene.gravity = None;
    let summary = run(&scene);
    assert_eq!((summary.stopped, summary.last.theta_rad), (None, 0.0));
    assert_eq!(summary.events[0].kind, "rest");
    assert!(summary.evaluations < 10_000, "{}", summary.evaluations);
}

/// A search for the end of a rest that hits the work limit reports this, and not a permanent rest.
#[test]
fn a_rest_that_was_not_searched_to_its_end_is_not_for_good() {
    let scene = rubbing(0.2, 0.3)
        .start(0.9, 0.0)
        .force(formula("0.001*t"))
        .duration(1e5);
    let options = Options {
        max_evaluations: 30,
        ..Options::default()
    };
    let summary = run_with(&scene, &options);
    assert!(
        summary
            .stopped
            .expect("stopped")
            .to_string()
            .contains("work limit")
    );
    assert!(summary.last.t_s < 1e5);
    assert_eq!(summary.events[0].kind, "stick");
    let whole = run(&scene);
    assert_eq!(whole.stopped, None);
    assert!(whole.events.iter().any(|event| event.kind == "slip"));
}

/// Stiff losses and long rests: the stated error of the rest position is its true uncertainty.
#[test]
fn a_place_of_rest_is_known_however_long_it_lasts() {
    let stiff = rubbing(0.2, 0.3).torque(Load::Viscous(1e9));
    let way = 5.0 * stiff.crank.unwrap().inertia / 1e9;
    let summary = run(&stiff);
    // Slider and rod increase the inertia of the crank.
    assert!((summary.last.theta_rad - 0.9).abs() < 10.0 * way);
    assert!(summary.error_estimate.unwrap().theta_rad < 1e-12);
    let short = run(&rubbing(0.2, 0.3));
    let long = run(&rubbing(0.2, 0.3).duration(9e8));
    assert_eq!(long.last.omega_rad_per_s, 0.0);
    let [a, b] = [&short, &long].map(|summary| summary.error_estimate.unwrap().theta_rad);
    assert!(a < 1e-11 && b < 1e-11, "{a:e} {b:e}");
    assert!((short.last.theta_rad - long.last.theta_rad).abs() <= a + b);
}

/// Coefficients, starts and loads at the limits of their ranges: a run, or a reason.
#[test]
fn extremes_are_computed_or_refused() {
    let pulses = || Load::function(Variables::T, |now| 20.0 * (1e3 * now.t).sin());
    let limit = (0.01f64 / 0.05).asin();
    let mut at_limit = rubbing(0.2, 0.3).start(limit, 0.0);
    at_limit.geometry.offset = 0.14;
    let mut near = at_limit.clone().start(limit - 1e-13, 1.0);
    near.run.tolerance = 1e-9;
    let mut light = rubbing(0.2, 0.3);
    (light.rod, light.crank) = (None, None);
    let mut no_weight = rubbing(0.2, 0.3);
    (no_weight.gravity, no_weight.rod) = (None, None);
    let scenes = [
        rubbing(1e-12, 1e-12),
        rubbing(1e-12, 0.9).start(0.9, 0.0).force(pulses()),
        rubbing(0.1, 0.9).start(0.9, 0.0).force(pulses()),
        rubbing(5.2, 5.2),
        rubbing(1e6, 1e6).start(0.9, 0.0),
        at_limit,
        near,
        light,
        no_weight,
        rubbing(0.2, 0.3).start(0.9, 1e-300),
        rubbing(0.2, 0.3).start(0.9, 1e9).duration(1e-7),
    ];
    for (number, scene) in scenes.iter().enumerate() {
        for method in [Method::Auto, Method::Dop853, Method::Dopri5] {
            let options = Options {
                method,
                max_evaluations: 5_000_000,
                ..Options::default()
            };
            if let Err(refused) = simulate(scene, &options) {
                assert!(refused.to_string().contains("help:"), "{number} {method}");
                continue;
            }
            let summary = run_with(scene, &options);
            let Some(why) = summary.stopped else {
                // Almost nothing moves: the rounding of the potential is larger.
                let kept =
                    summary.energy_residual_j.abs() < 1e-14 || summary.energy_residual.abs() < 1e-6;
                assert!(kept, "{number} {method}");
                assert!(summary.error_estimate.is_some(), "{number} {method}");
                continue;
            };
            assert!(
                why.to_string().contains("stopped at t = "),
                "{number} {method}: {why}"
            );
        }
    }
}

/// Where the load in time is small beside the cubic loss, its rounding does not excuse the error of a step.
#[test]
fn a_steep_loss_is_resolved_at_the_loosest_tolerance() {
    let scene = Scene::new(100.0, 100.0)
        .offset(0.01)
        .crank(Crank {
            inertia: 1e-3,
            ..Crank::default()
        })
        .torque(formula("-8*omega^3 + cos(3*t)"))
        .start(1e-9f64.to_radians(), -1e4)
        .duration(0.1)
        .tolerance(0.1);
    let options = Options {
        max_evaluations: 100_000,
        ..Options::default()
    };
    let summary = run_with(&scene, &options);
    // The torques balance at the end, but for a lag of 3e-5 rad/s.
    let balanced = (0.3f64.cos() / 8.0).cbrt();
    let off = (summary.last.omega_rad_per_s - balanced).abs();
    assert!(off < 1e-3, "{summary:?}");
}
