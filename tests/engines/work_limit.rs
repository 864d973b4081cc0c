//! Work limit: it holds for every engine, keeps the computed results, and is foreseen where possible.

use crate::support::machines;
use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Expression, Friction, Gravity, Load, Scene, Slider};
use slider_crank::simulate::{Options, Summary, simulate};

const INERTIA: f64 = 2e-6;

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).expect("a formula"))
}

/// Small crank of constant inertia alone.
fn crank() -> Scene {
    Scene::new(0.005, 0.015).crank(Crank {
        inertia: INERTIA,
        ..Crank::default()
    })
}

fn machine() -> Scene {
    crank().offset(0.001).slider(Slider { mass: 0.006 })
}

fn options(method: Method, max_evaluations: u64) -> Options {
    Options {
        method,
        max_evaluations,
        ..Options::default()
    }
}

fn run(scene: &Scene, method: Method) -> Summary {
    simulate(scene, &options(method, 2_000_000_000))
        .expect("a run")
        .summary
}

/// Equal turns, turns of equal work, unequal turns, and a swing; by time and by turns.
#[test]
fn every_engine_ends_at_the_limit_with_what_it_has() {
    let weighted = |scene: Scene| scene.gravity(Gravity::standard());
    let scenes = [
        weighted(machine().start(0.3, 40.0)).torque(Load::Constant(1e-5)),
        weighted(machine().start(0.3, 40.0)).torque(formula("1e-4*sin(0.3*theta)")),
        weighted(machine().start(0.3, 0.0)),
        weighted(machine().start(0.3, 40.0)).force(formula("-1e-5*v")),
    ];
    for (number, scene) in scenes.iter().enumerate() {
        for scene in [
            scene.clone().duration(100.0),
            scene.clone().revolutions(1e3),
        ] {
            for method in [Method::Auto, Method::Time, Method::Dop853] {
                for limit in [1, 100, 700, 3000] {
                    let limited = match simulate(&scene, &options(method, limit)) {
                        Ok(limited) => limited,
                        // The third scene starts in equilibrium.
                        Err(error) => {
                            assert!(error.to_string().contains("a crank at rest"), "{error}");
                            continue;
                        }
                    };
                    let Summary {
                        stopped,
                        last,
                        evaluations,
                        ..
                    } = &limited.summary;
                    let Some(why) = stopped else {
                        // The limit is checked before the last panel.
                        assert!(*evaluations < limit + 1500, "{number} {method} {limit}");
                        continue;
                    };
                    if !why.to_string().contains("work limit") {
                        assert!(
                            why.to_string().contains("does not complete"),
                            "{number} {why}"
                        );
                        continue;
                    }
                    assert!(why.to_string().contains("--max-evaluations"), "{why}");
                    // At most the tables of one turn exceed the limit.
                    assert!(
                        *evaluations < limit + 1500,
                        "{number} {method} {limit}: {evaluations}"
                    );
                    let whole = scene.clone().duration(1.01 * last.t_s + 1e-9);
                    let whole = simulate(&whole, &Options::default()).expect("a run");
                    let (theta, omega) = whole.at(last.t_s).expect("a time of the run");
                    assert!(
                        (theta - last.theta_rad).abs() < 1e-6,
                        "{number} {method} {limit}"
                    );
                    assert!(
                        (omega - last.omega_rad_per_s).abs() < 1e-4,
                        "{number} {method} {limit}"
                    );
                }
            }
        }
    }
}

/// Positions tabulated anew for divided panels count as well: after the first tables, the limit is exceeded by at most
/// one panel, of 40 sweeps at 33 points.
#[test]
fn panels_that_are_cut_count_too() {
    let scene = machine()
        .torque(formula("20*max(0,1-abs(omega-30)*10)+3*sin(theta/7)^2"))
        .start(0.0, 10.0)
        .revolutions(4000.0);
    for limit in [5000, 20_000, 40_000] {
        let found = simulate(&scene, &options(Method::Angle, limit)).expect("a run");
        assert!(found.summary.stopped.is_some());
        let evaluations = found.summary.evaluations;
        assert!(evaluations < limit + 40 * 33, "{limit}: {evaluations}");
    }
}

/// The torque gains the start speed within an angle below the rounding of angles: t = (ω − ω₀) I/τ, ω² = ω₀² + 2 τ θ/I.
#[test]
fn a_crank_under_far_too_strong_a_torque_is_computed_over_its_turns() {
    for (torque, speed, turns) in [(1e10, 10.0, 3e4), (1e10, -10.0, 3e4), (5.0, 1e-6, 1e5)] {
        let scene = crank()
            .torque(Load::Constant(torque))
            .start(0.5, speed)
            .revolutions(turns);
        let summary = run(&scene, Method::Auto);
        assert_eq!(summary.stopped, None);
        let way = std::f64::consts::TAU * turns;
        let omega = (speed * speed + 2.0 * torque * way / INERTIA).sqrt();
        let t = (omega - speed) * INERTIA / torque;
        let late = (summary.last.t_s / t - 1.0).abs();
        assert!(late < 1e-11, "{torque} {speed}: {late:e}");
        assert!((summary.last.omega_rad_per_s / omega - 1.0).abs() < 1e-11);
        assert!(summary.evaluations < 200_000, "{}", summary.evaluations);
    }
}

/// After a second the rest of the run would take years: the run ends early with that reason.
#[test]
fn too_many_turns_are_foreseen() {
    let strong = || {
        machine()
            .torque(Load::Constant(1e10))
            .start(0.5, 10.0)
            .duration(1.0)
    };
    let mut rubbing = machines::rubbing(strong(), 0.1, 0.1);
    rubbing.friction = Some(Friction {
        coefficient: 0.1,
        static_coefficient: 0.1,
    });
    for (scene, method) in [
        (strong(), Method::Auto),
        (strong(), Method::Time),
        (rubbing, Method::Auto),
        (strong().revolutions(1e12), Method::Dop853),
    ] {
        let summary = run(&scene, method);
        let why = summary.stopped.expect("a reason").to_string();
        assert!(
            why.contains("turns so often") && why.contains("t = "),
            "{why}"
        );
        assert!(summary.evaluations < 10_000_000, "{}", summary.evaluations);
        assert!(summary.last.t_s > 0.0 && summary.last.t_s < 1.0);
    }
}

/// Run-up to a constant speed: from there on all turns are equal, whatever their number.
#[test]
fn a_steady_speed_is_reached_whatever_follows() {
    let scene = machine()
        .torque(Load::Constant(1e-3))
        .torque(Load::Viscous(1e-6))
        .start(0.5, 10.0)
        .duration(1e12);
    let summary = run(&scene, Method::Auto);
    assert_eq!(summary.stopped, None);
    assert!(summary.revolutions > 1e13, "{}", summary.revolutions);
}

/// The residual is relative to the energies of the run, not of later turns: at the end of this run the crank has the
/// work of the torque.
#[test]
fn the_residual_is_relative_to_the_run() {
    let scene = machine()
        .offset(0.0)
        .torque(Load::Constant(1e7))
        .start(0.5, 300.0)
        .revolutions(1e4);
    let summary = run(&scene, Method::Energy);
    let largest = 1e7 * std::f64::consts::TAU * 1e4;
    let relative = summary.energy_residual_j / largest;
    assert!(summary.energy_residual != 0.0);
    assert!(
        (relative / summary.energy_residual - 1.0).abs() < 1e-3,
        "{relative:e} {:e}",
        summary.energy_residual
    );
}

/// The second run of the estimate would have to resolve a ripple that the tolerance of the first ignores.
#[test]
fn the_second_run_takes_a_share_of_work_only() {
    let scene = machine()
        .torque(formula("-1e-7*omega + 1e-9*sin(1e6*theta)"))
        .start(0.0, 50.0)
        .tolerance(1e-4)
        .revolutions(20.0);
    let begun = std::time::Instant::now();
    let summary = run(&scene, Method::Angle);
    let took = begun.elapsed().as_secs_f64();
    assert_eq!(summary.stopped, None);
    assert!(
        summary.error_estimate.is_none(),
        "{:?}",
        summary.error_estimate
    );
    let said = summary
        .warnings
        .iter()
        .any(|warning| warning.to_string().contains("could not be estimated"));
    assert!(said, "{:?}", summary.warnings);
    // Without its own limit the second run would take many times as long. A busy machine slows down both runs.
    let most = f64::max(3.0, 100.0 * summary.wall_s);
    assert!(took < most, "{took} s, {} s", summary.wall_s);
}
