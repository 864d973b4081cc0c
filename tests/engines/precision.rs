//! Comparison of methods, and its reference.

use crate::support::machines::{leaning, rubbing};
use crate::support::reference::{precision, slider};
use slider_crank::plan::Method;
use slider_crank::precision::{Precision, PrecisionOptions, PrecisionRow};
use slider_crank::scene::{
    Branch, Clearance, Crank, Friction, Gravity, Joint, Load, MotionKind, Rod, Scene, Slider,
    Variables,
};
use slider_crank::simulate::{Options, simulate};

fn compare(scene: &Scene, tolerances: &[f64]) -> Precision {
    let options = PrecisionOptions {
        tolerances: tolerances.to_vec(),
        repeats: 1,
        ..PrecisionOptions::default()
    };
    precision(scene, &options).expect("a comparison")
}

fn rows<'a>(result: &'a Precision, method: &'a str) -> impl Iterator<Item = &'a PrecisionRow> {
    result.rows.iter().filter(move |row| row.method == method)
}

/// Engine on the left branch with offset, weight and a rod whose centre of gravity is off its axis.
fn engine() -> Scene {
    Scene::new(0.05, 0.15)
        .offset(-0.01)
        .branch(Branch::Left)
        .crank(Crank {
            mass: 2.0,
            cg: 0.01,
            cg_lateral: 0.002,
            inertia: 0.02,
        })
        .rod(Rod {
            mass: 0.4,
            cg: 0.06,
            cg_lateral: 0.003,
            inertia: 1.2e-3,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.6 })
        .gravity(Gravity::standard())
        .start(0.3, -30.0)
        .duration(0.5)
}

/// Flywheel with constant torque and viscous loss: omega tends to a limit exponentially.
#[test]
fn errors_are_those_against_a_closed_solution() {
    let (inertia, torque, loss, start, duration) = (0.5, 3.0, 0.25, 40.0, 2.0);
    let scene = Scene::new(0.05, 0.15)
        .crank(Crank {
            inertia,
            ..Crank::default()
        })
        .torque(Load::Constant(torque))
        .torque(Load::Viscous(loss))
        .start(0.0, start)
        .duration(duration);
    let (rate, limit) = (loss / inertia, torque / loss);
    let decay = (-rate * duration).exp();
    let theta = limit * duration + (start - limit) * (1.0 - decay) / rate;
    let omega = limit + (start - limit) * decay;
    let result = compare(&scene, &[1e-3, 1e-6, 1e-13]);
    for (name, method) in [("dopri5", Method::Dopri5), ("dop853", Method::Dop853)] {
        for row in rows(&result, name) {
            let mut scene = scene.clone();
            scene.run.tolerance = row.tolerance;
            let options = Options {
                method,
                ..Options::default()
            };
            let last = simulate(&scene, &options).expect("a run").summary.last;
            let [by_angle, by_speed] = [last.theta_rad - theta, last.omega_rad_per_s - omega];
            let found = [row.error_theta_rad, row.error_omega_rad_per_s].map(Option::unwrap);
            assert!(
                (found[0] - by_angle.abs()).abs() < 3e-14,
                "{found:?} {by_angle}"
            );
            assert!(
                (found[1] - by_speed.abs()).abs() < 3e-14,
                "{found:?} {by_speed}"
            );
            assert!(!row.error_is_bound);
        }
    }
    assert!(
        rows(&result, "dopri5")
            .next()
            .unwrap()
            .error_theta_rad
            .unwrap()
            > 1e-10
    );
}

#[test]
fn every_method_that_can_serve_has_its_rows() {
    let tolerances = [1e-5, 1e-10];
    let result = compare(&engine(), &tolerances);
    for method in ["energy", "angle", "time", "dop853", "dopri5"] {
        let found: Vec<_> = rows(&result, method).map(|row| row.tolerance).collect();
        assert_eq!(found, tolerances, "{method}");
    }
    assert_eq!(
        rows(&result, "auto").count() + rows(&result, "closed-form").count(),
        0
    );
    assert!(result.left_out.is_empty());
    let lossy = engine().torque(Load::Viscous(0.01));
    let lossy = compare(&lossy, &tolerances);
    assert_eq!(rows(&lossy, "energy").count(), 0);
    assert!(lossy.left_out.len() == 1 && lossy.left_out[0].contains("energy"));
}

/// Two engines independent of the reference agree with it.
#[test]
fn the_reference_agrees_with_the_engines_to_rounding() {
    for scene in [
        engine(),
        engine().torque(Load::Viscous(0.01)),
        Scene::duarte(),
    ] {
        let result = compare(&scene, &[1e-13]);
        assert!(result.reference_error_theta_rad.unwrap() < 1e-24);
        for row in result
            .rows
            .iter()
            .filter(|row| ["energy", "angle"].contains(&row.method.as_str()))
        {
            let (error, stated) = (
                row.error_theta_rad.unwrap(),
                row.estimate_theta_rad.unwrap(),
            );
            assert!(error < 5e-13 && error <= 2.0 * stated, "{row:?}");
            assert!(!row.error_is_bound);
        }
    }
}

/// For many equal turns the reference is made from one period.
#[test]
fn many_equal_turns_cost_no_more_than_one() {
    let result = compare(&engine().duration(200.0), &[1e-6]);
    let own = result.reference_error_theta_rad.unwrap();
    assert!(own < 1e-20, "{own}");
    let energy = rows(&result, "energy").next().unwrap();
    assert!(energy.error_theta_rad.unwrap() < 1e-10, "{energy:?}");
}

#[test]
fn errors_fall_with_the_tolerance_and_cost_rises() {
    let result = compare(&engine(), &[1e-4, 1e-7, 1e-10]);
    let found: Vec<_> = rows(&result, "dop853").collect();
    for pair in found.windows(2) {
        assert!(pair[1].error_theta_rad < pair[0].error_theta_rad);
        assert!(pair[1].evaluations > pair[0].evaluations && pair[1].steps > pair[0].steps);
    }
    assert!(
        found
            .iter()
            .all(|row| row.runs == 1 && row.wall_s == row.wall_median_s)
    );
}

/// Loads in floats limit the reference; errors less than a hundred times its own are marked as bounds.
#[test]
fn a_reference_that_is_not_better_makes_bounds() {
    let rough = Load::function(Variables::OMEGA, |now| -1e-3 * now.omega * now.omega.abs());
    let result = compare(&engine().torque(rough), &[1e-4, 1e-13]);
    let own = result.reference_error_theta_rad.unwrap();
    assert!(own > 1e-17 && own < 1e-12, "{own}");
    for row in &result.rows {
        let error = row.error_theta_rad.unwrap();
        assert!(row.error_is_bound || error >= 100.0 * own, "{row:?}");
        assert!(error >= own);
    }
    assert!(!rows(&result, "dopri5").next().unwrap().error_is_bound);
}

#[test]
fn a_prescribed_motion_has_its_closed_form() {
    let mut scene = engine();
    scene.motion.kind = MotionKind::ConstantSpeed;
    let result = compare(&scene, &[1e-8]);
    let [row] = &result.rows[..] else {
        panic!("{result:?}")
    };
    assert_eq!(row.method, "closed-form");
    assert!(row.error_theta_rad.unwrap() < 1e-14);
}

/// A rocker without rod and slider runs into its limit, and a mechanism without inertia at its dead centres has a
/// singularity there.
#[test]
fn what_fails_is_a_row_that_says_so() {
    let mut rocker = engine();
    (rocker.geometry.crank, rocker.geometry.rod) = (0.1, 0.08);
    (rocker.motion.angle, rocker.motion.speed) = (3.0, -20.0);
    (rocker.rod, rocker.slider) = (None, None);
    let result = compare(&rocker, &[1e-6]);
    assert!(!result.has_results() && result.rows.len() >= 3);
    for row in &result.rows {
        assert!(row.failure.is_some() && row.error_theta_rad.is_none() && row.wall_s.is_none());
    }
    let light = Scene::new(0.05, 0.15)
        .offset(0.01)
        .slider(Slider { mass: 0.6 })
        .start(0.7, 20.0)
        .duration(0.5);
    let result = compare(&light, &[1e-6]);
    assert!(result.has_results());
    let energy = rows(&result, "energy").next().unwrap();
    assert!(
        energy.measured_against.as_ref().unwrap().contains("angle"),
        "{energy:?}"
    );
    assert!(energy.error_is_bound);
    assert!(rows(&result, "dopri5").next().unwrap().failure.is_some());
}

#[test]
fn a_tolerance_that_no_run_takes_is_refused() {
    let options = PrecisionOptions {
        tolerances: vec![2.0],
        ..PrecisionOptions::default()
    };
    assert!(precision(&engine(), &options).is_err());
}

/// Slider alone with friction: v falls by μ g, whatever the massless crank and rod do.
fn braked(duration: f64) -> Scene {
    let mut scene = Scene::new(0.1, 0.3)
        .offset(0.02)
        .slider(Slider { mass: 2.0 })
        .gravity(Gravity::standard())
        .start(1.0, 5.0)
        .duration(duration);
    scene.friction = Some(Friction {
        coefficient: 0.3,
        static_coefficient: 0.4,
    });
    scene
}

#[test]
fn friction_is_in_the_reference() {
    let x = |theta: f64| {
        let drop: f64 = 0.02 + 0.1 * theta.sin();
        0.1 * theta.cos() + (0.09 - drop * drop).sqrt()
    };
    let slope = |theta: f64| {
        let drop: f64 = 0.02 + 0.1 * theta.sin();
        -0.1 * theta.sin() - drop * 0.1 * theta.cos() / (0.09 - drop * drop).sqrt()
    };
    let (v, brake) = (5.0 * slope(1.0), 0.3 * Gravity::standard().acceleration);
    let stops = v.abs() / brake;
    for duration in [0.4 * stops, 1.5 * stops] {
        let t = duration.min(stops);
        let place = x(1.0) + v * t + 0.5 * brake * t * t;
        let theta = (0..60).fold(1.2, |theta, _| theta - (x(theta) - place) / slope(theta));
        let omega = (v + brake * t) / slope(theta);
        let result = compare(&braked(duration), &[1e-5, 1e-10]);
        assert!(
            result.reference_error_theta_rad.unwrap() < 1e-17,
            "{result:?}"
        );
        for row in &result.rows {
            let mut scene = braked(duration);
            scene.run.tolerance = row.tolerance;
            let options = Options {
                method: row.method.parse().unwrap(),
                ..Options::default()
            };
            let last = simulate(&scene, &options).unwrap().summary.last;
            let found = row.error_theta_rad.unwrap();
            let want = (last.theta_rad - theta).abs();
            assert!((found - want).abs() < 2e-14, "{row:?} {want:e}");
            let want = (last.omega_rad_per_s - omega).abs();
            let found = row.error_omega_rad_per_s.unwrap();
            assert!((found - want).abs() < 1e-12, "{row:?} {want:e}");
        }
    }
}

/// All runs jam at one place: their errors are measured there, and no row counts as a failure.
#[test]
fn where_the_motion_ends_its_methods_are_measured() {
    let scene = leaning(0.2).gravity(Gravity::standard()).start(0.3, 6.0);
    let scene = rubbing(scene, 1.5, 1.5);
    let result = compare(&scene, &[1e-5, 1e-10]);
    assert!(result.has_results() && result.t_s > 0.05 && result.t_s < 0.1);
    for row in &result.rows {
        assert!(row.failure.as_ref().unwrap().contains("jams"));
        let [coarse, found] = [1e-3, row.error_theta_rad.unwrap()];
        assert!(found <= coarse * row.tolerance.sqrt() && row.wall_s.is_some());
    }
}

/// Journal in its bearing: errors of crank and slider from equations in other unknowns.
#[test]
fn a_loose_joint_has_its_rows() {
    for joint in [Joint::CrankPin, Joint::WristPin] {
        let scene = Scene {
            clearance: Some(Clearance {
                bearing_radius: Some(0.01),
                young_modulus: Some(207e9),
                poisson_ratio: Some(0.3),
                restitution: Some(0.8),
                friction: Some(0.05),
                ..Clearance::new(joint, 2e-4)
            }),
            ..engine().start(0.3, 50.0).duration(6e-3)
        };
        let result = compare(&scene, &[1e-6, 1e-9, 1e-12]);
        let own = result.reference_error_theta_rad.unwrap();
        assert!(own < 1e-16, "{own:e}");
        assert_eq!(result.rows.len(), 3);
        for row in &result.rows {
            assert_eq!(row.method, "contact");
            for (error, stated) in [
                (row.error_theta_rad, row.estimate_theta_rad),
                (row.error_omega_rad_per_s, row.estimate_omega_rad_per_s),
            ] {
                let (error, stated) = (error.unwrap(), stated.unwrap());
                assert!(error <= 2.0 * stated, "{joint:?} {row:?}");
            }
        }
        let (x, own) = slider(&scene, 6e-3).unwrap();
        let errors: Vec<f64> = [1e-6, 1e-9, 1e-12]
            .iter()
            .map(|tolerance| {
                let scene = scene.clone().tolerance(*tolerance);
                let run = simulate(&scene, &Options::default()).unwrap();
                let last = run.summary.clearance.unwrap().last;
                let error = (x - last.x_m).value().abs() + own;
                assert!(error <= 2.0 * last.error_x_m.unwrap(), "{joint:?} {last:?}");
                error
            })
            .collect();
        assert!(errors[1] < errors[0] && errors[2] < errors[1], "{errors:?}");
        assert!(errors[2] < 1e-12, "{errors:?}");
    }
}
