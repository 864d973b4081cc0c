//! Scenes of `data/hard/` compared with the references of its README, all independent of this program.

use std::path::PathBuf;

use slider_crank::plan::Method;
use slider_crank::scene::Scene;
use slider_crank::simulate::{Options, Simulation, simulate};

fn scene(name: &str) -> Scene {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("data/hard")
        .join(name)
        .with_extension("toml");
    Scene::load(&file).expect("a scene")
}

fn run(name: &str, method: Method) -> Simulation {
    let options = Options {
        method,
        max_evaluations: 20_000_000,
        ..Options::default()
    };
    simulate(&scene(name), &options).expect("a run")
}

/// Name, crank angle and speed at the end, and the error of the reference.
const REFERENCES: [(&str, f64, f64, f64); 22] = [
    ("01-limit-1e-6", 18.532471601824206, 9.953636237680193, 0.0),
    ("01-limit-1e-12", 18.531035303155477, 9.951119500853299, 0.0),
    (
        "01-limit-1e-12-left",
        -18.086773821194356,
        -9.859835217528916,
        0.0,
    ),
    (
        "02-change-point",
        22.453986394936827,
        13.40553514631542,
        0.0,
    ),
    (
        "03-rotating-rod",
        -0.5650117589533882,
        9.88226969687268,
        0.0,
    ),
    (
        "03-double-rocker",
        1.94015984737012,
        9.924578524547885,
        2e-11,
    ),
    (
        "04-no-inertia-at-dead-centres",
        25.67242265661743,
        7.192202800568984,
        0.0,
    ),
    ("05-rest-at-dead-centre", 0.0, 0.0, 0.0),
    (
        "05-one-microradian-off",
        6.28280228334458,
        0.009889598765983805,
        0.0,
    ),
    (
        "06-million-turns",
        6349974.708060694,
        98.57316875388682,
        0.0,
    ),
    (
        "07-near-separatrix",
        -2.801025564952111,
        -32.35093016442723,
        0.0,
    ),
    ("09-hundreds-of-reversals", 1.5619131655637277, 0.0, 0.0),
    (
        "09-stick-and-slip",
        1.1882117042847302,
        6.446446970206754,
        5e-12,
    ),
    (
        "10-combustion-spike",
        77.69234765663795,
        251.38766316019883,
        2e-13,
    ),
    ("13-micro", 10.255049782500446, 5014.562924676719, 0.0),
    ("13-ship", 180.3307094033419, 8.974006234434595, 0.0),
    ("14-zero-duration", 0.7, 3.0, 0.0),
    ("15-one-blow", 28.59643171643871, 38.97673466195545, 0.0),
    (
        "15-torque-at-a-speed",
        82.46432474848159,
        152.99973624057386,
        0.0,
    ),
    (
        "15-pulse-in-time",
        29.616610086226234,
        15.74976677620337,
        0.0,
    ),
    (
        "15-pulse-in-every-second-turn",
        107.96794956915882,
        66.61329264946285,
        2e-10,
    ),
    (
        "15-jump-in-each-turn",
        72.35068998457365,
        61.7324000891749,
        4e-11,
    ),
];

#[track_caller]
fn check(name: &str, run: &Simulation, theta: f64, omega: f64, doubt: f64) {
    let summary = &run.summary;
    assert_eq!(summary.stopped, None, "{name}");
    let stated = summary.error_estimate.expect("an estimate");
    // The true error is at most twice the estimate, plus one unit in the last place of the reference.
    let allowed = |stated: f64, value: f64| 2.0 * stated + doubt + f64::EPSILON * value.abs();
    let apart = (summary.last.theta_rad - theta).abs();
    assert!(
        apart <= allowed(stated.theta_rad, theta),
        "{name}: {apart:e}, {stated:?}"
    );
    let apart = (summary.last.omega_rad_per_s - omega).abs();
    let doubt = 20.0 * doubt;
    let allowed = 2.0 * stated.omega_rad_per_s + doubt + 2.0 * f64::EPSILON * omega.abs();
    assert!(apart <= allowed, "{name}: omega {apart:e}, {stated:?}");
}

#[test]
fn every_case_ends_at_its_reference() {
    for (name, theta, omega, doubt) in REFERENCES {
        let run = run(name, Method::Auto);
        check(name, &run, theta, omega, doubt);
        let residual = run.summary.energy_residual;
        assert!(residual.abs() < 1e-9, "{name}: {residual:e}");
    }
}

/// Loose joints: crank angle and speed, slider position and velocity at the end, and the errors of the reference in
/// angle and position. Speeds have a larger allowance because the contact is stiff.
#[test]
fn loose_joints_end_at_their_references() {
    for (name, [theta, omega, x, v], [doubt_theta, doubt_x]) in [
        (
            "11-clearance-5000rpm",
            [
                2.0943951023931953,
                523.5987755982989,
                0.08650183344178476,
                -18.727437857728965,
            ],
            [0.0, 2e-12],
        ),
        (
            "11-clearance-free-crank",
            [
                1.6404299747019266,
                482.6645035095712,
                0.10034658633078153,
                -23.350791887834358,
            ],
            [6e-13, 2e-13],
        ),
    ] {
        let summary = run(name, Method::Auto).summary;
        assert_eq!(summary.stopped, None);
        let joint = summary.clearance.expect("a loose joint");
        assert!(joint.horizon.expect("a horizon").whole_run && joint.impacts >= 8);
        let stated = summary.error_estimate.expect("an estimate");
        let near = |found: f64, want: f64, allowed: f64| {
            let apart = (found - want).abs();
            assert!(apart <= allowed, "{name}: {found} for {want}: {allowed:e}");
        };
        near(
            summary.last.theta_rad,
            theta,
            2.0 * stated.theta_rad + doubt_theta,
        );
        near(
            summary.last.omega_rad_per_s,
            omega,
            2.0 * stated.omega_rad_per_s + 1e-8,
        );
        let own = joint.last.error_x_m.expect("inside the horizon");
        near(joint.last.x_m, x, 2.0 * own + doubt_x);
        near(joint.last.v_m_per_s, v, 1e-6);
        assert!(summary.energy_residual.abs() < 1e-9);
    }
}

/// Pendulum of 1e-3 rad: the speed follows from a difference of energies, which cancels to 1e-7 of them.
#[test]
fn a_small_libration_ends_at_its_reference() {
    let run = run("07-small-libration", Method::Auto);
    check(
        "07-small-libration",
        &run,
        -1.5717869961291266,
        0.0026992690635788345,
        0.0,
    );
}

/// A method either ends at the reference state or says why it does not.
#[test]
fn every_method_is_right_or_says_why_not() {
    for (name, theta, omega, doubt) in REFERENCES {
        // A run of two million radians in time is too long for a test.
        if name.starts_with("06") {
            continue;
        }
        for method in [Method::Dop853, Method::Time, Method::Angle] {
            let options = Options {
                method,
                max_evaluations: 2_000_000,
                ..Options::default()
            };
            match simulate(&scene(name), &options) {
                Ok(run) if run.summary.stopped.is_none() => check(name, &run, theta, omega, doubt),
                Ok(run) => assert!(run.summary.stopped.unwrap().to_string().contains("stopped")),
                Err(refused) => assert!(refused.to_string().contains("help:")),
            }
        }
    }
}

/// Angle and time, from the Newton-Euler equations, at which the friction law ceases to have one solution.
#[test]
fn jamming_is_named_where_it_begins() {
    let run = run("09-jamming", Method::Auto);
    let why = run.summary.stopped.expect("it jams").to_string();
    assert!(
        why.contains("jams") && why.contains("more than one"),
        "{why}"
    );
    assert!((run.summary.last.theta_rad - 0.7644914676866464).abs() < 1e-9);
    assert!((run.summary.last.t_s - 0.07963354398823105).abs() < 1e-9);
}

#[test]
fn ten_thousand_reversals_keep_the_energy_balance() {
    let options = Options {
        estimate: false,
        events_kept: 20_000,
        ..Options::default()
    };
    let run = simulate(&scene("09-ten-thousand-reversals"), &options).unwrap();
    assert_eq!(run.summary.stopped, None);
    let reversals = run
        .summary
        .events
        .iter()
        .filter(|event| event.kind == "turning-point");
    assert!(reversals.count() >= 10_000);
    assert!(
        run.summary.energy_residual.abs() < 1e-9,
        "{:e}",
        run.summary.energy_residual
    );
}

/// Rest at the inner dead centre, 180 degrees, which is not a float: the motion from the nearest float grows as
/// cosh(18.26 t) but stays below 1e-8 rad, and the estimate covers it.
#[test]
fn rest_at_a_rounded_dead_centre_says_how_unsure_it_is() {
    let run = run("05-rest-at-inner-dead-centre", Method::Auto);
    let moved = (run.summary.last.theta_rad - std::f64::consts::PI).abs();
    assert!(moved < 1e-8, "{moved:e}");
    assert!(moved <= 2.5 * run.summary.error_estimate.unwrap().theta_rad + 1e-15);
}

/// With a small work limit every run ends, and says where.
#[test]
fn the_work_limit_ends_every_run() {
    for name in [
        "02-change-point",
        "03-double-rocker",
        "09-ten-thousand-reversals",
        "09-stick-and-slip",
        "08-steep-motor-line",
    ] {
        for method in [Method::Auto, Method::Dop853, Method::Dopri5, Method::Time] {
            let options = Options {
                method,
                max_evaluations: 500,
                estimate: false,
                ..Options::default()
            };
            let run = simulate(&scene(name), &options).unwrap();
            let Some(why) = run.summary.stopped else {
                assert!(run.summary.evaluations <= 5_000, "{name} {method}");
                continue;
            };
            let why = why.to_string();
            assert!(
                why.contains("work limit") && why.contains("t = "),
                "{name} {method}: {why}"
            );
            assert!(
                run.summary.evaluations < 2_000,
                "{name} {method}: {}",
                run.summary.evaluations
            );
        }
    }
}

/// Runs too short to change the crank angle by one float end in their start state.
#[test]
fn runs_of_hardly_any_length_end_at_their_start() {
    let frictionless = scene("14-zero-duration");
    let rubbing = scene("09-jamming");
    for scene in [frictionless, rubbing] {
        let start = scene.motion;
        for duration in [1e-300, 1e-100, 1e-20, 1e-18] {
            for method in [Method::Auto, Method::Time, Method::Dop853, Method::Dopri5] {
                let options = Options {
                    method,
                    ..Options::default()
                };
                let run = simulate(&scene.clone().duration(duration), &options).expect("a run");
                let last = run.summary.last;
                assert!(run.summary.stopped.is_none(), "{method} {duration:e}");
                let moved = (last.theta_rad - start.angle).abs();
                assert!(moved <= 1e-15, "{method} {duration:e}");
                let change = (last.omega_rad_per_s - start.speed).abs();
                assert!(change <= 1e-14 * start.speed, "{method} {duration:e}");
                let stated = run.summary.error_estimate.expect("an estimate");
                assert!(stated.omega_rad_per_s < 1e-13, "{method} {duration:e}");
            }
        }
    }
}
