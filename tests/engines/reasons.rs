//! Reasons for stops and refusals: the applicable cause, and no other.

use slider_crank::scene::{
    Crank, Expression, Friction, Interpolation, Load, Scene, Slider, Table, Variable,
};
use slider_crank::simulate::{Options, simulate};

use slider_crank::plan::Method;

fn machine() -> Scene {
    Scene::new(0.05, 0.15)
        .crank(Crank {
            inertia: 0.02,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.6 })
}

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).expect("a formula"))
}

fn stopped(scene: &Scene, method: Method) -> String {
    let options = Options {
        method,
        ..Options::default()
    };
    let summary = simulate(scene, &options).expect("a run").summary;
    summary.stopped.expect("a reason").to_string()
}

/// Returns the number that follows these words.
fn number_after(text: &str, words: &str) -> f64 {
    let (_, rest) = text.split_once(words).expect(words);
    let end = rest.find([' ', ',', ':']).unwrap_or(rest.len());
    rest[..end].parse().expect("a number")
}

/// Motor of 60 N m against a stop of 200 N/mm on the inward stroke: at the stall the two balance.
#[test]
fn a_press_that_stalls_says_where_and_under_which_torques() {
    let press = machine()
        .torque(Load::Motor {
            stall: 60.0,
            no_load_speed: 10.0,
        })
        .force(formula("200000*max(0, 0.19 - x)"))
        .start(0.0, 1.0)
        .revolutions(10.0);
    let net = |theta: f64| {
        let sin = 0.05 * theta.sin() / 0.15;
        let (x, slope) = (
            0.05 * theta.cos() + 0.15 * (1.0 - sin * sin).sqrt(),
            -0.05 * theta.sin() - 0.05 * theta.cos() * sin / (1.0 - sin * sin).sqrt(),
        );
        60.0 + 200_000.0 * (0.19_f64 - x).max(0.0) * slope
    };
    let (mut low, mut high) = (0.5, 1.2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if net(middle) > 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    for method in [Method::Auto, Method::Time, Method::Dop853] {
        let why = stopped(&press, method);
        assert!(why.contains("stalled") && why.contains("10 turns"), "{why}");
        let theta = number_after(&why, "theta = ");
        assert!((theta - low).abs() < 1e-12, "{theta} for {low}");
        let drive = number_after(&why, "motor torque ");
        let load = number_after(&why, "load ");
        assert!(
            (drive - 60.0).abs() < 1e-9 && (load + 60.0).abs() < 1e-9,
            "{why}"
        );
    }
}

/// A swinging crank, and one that has far to go, are not stalled.
#[test]
fn a_crank_that_swings_or_turns_has_not_stalled() {
    let spring = machine().force(Load::Spring {
        stiffness: 1000.0,
        rest: 0.15,
    });
    let why = stopped(&spring.start(1.0, 1.0).revolutions(3.0), Method::Time);
    assert!(why.contains("to and fro"), "{why}");
    let options = Options {
        max_evaluations: 3000,
        ..Options::default()
    };
    let long = machine()
        .torque(Load::Viscous(1e-3))
        .start(0.0, 10.0)
        .revolutions(1e6);
    let long = Scene {
        forces: vec![formula("0.01*cos(t)")],
        ..long
    };
    let why = simulate(&long, &options)
        .expect("a run")
        .summary
        .stopped
        .expect("a reason")
        .to_string();
    assert!(why.contains("work limit"), "{why}");
}

#[test]
fn a_crank_that_friction_holds_says_what_it_holds() {
    let mut scene = machine()
        .torque(Load::Constant(0.5))
        .force(Load::Constant(-40.0));
    scene.friction = Some(Friction {
        coefficient: 0.3,
        static_coefficient: 0.3,
    });
    let why = stopped(
        &scene
            .clone()
            .torque(Load::dry(5.0))
            .start(1.0, 2.0)
            .revolutions(5.0),
        Method::Auto,
    );
    assert!(
        why.contains("comes to rest") && why.contains("friction holds"),
        "{why}"
    );
    let theta = number_after(&why, "theta = ");
    let sin = 0.05 * theta.sin() / 0.15;
    let slope = -0.05 * theta.sin() - 0.05 * theta.cos() * sin / (1.0 - sin * sin).sqrt();
    assert!(
        (number_after(&why, "crank torque ") - 0.5).abs() < 1e-12,
        "{why}"
    );
    assert!(
        (number_after(&why, "load ") + 40.0 * slope).abs() < 1e-9,
        "{why}"
    );
}

/// A refusal must not name unrelated loads.
#[test]
fn a_refusal_names_the_load_that_is_the_cause() {
    let speeds = Table::new(
        Variable::Omega,
        &[-100.0, 0.0, 100.0],
        &[1.0, 0.5, 0.0],
        Interpolation::Pchip,
        None,
    );
    let base = || {
        machine()
            .torque(Load::Constant(1.0))
            .start(0.3, 10.0)
            .duration(0.1)
    };
    for (scene, method, words, others) in [
        (
            base().torque(Load::Viscous(0.1)),
            Method::Energy,
            "torque[2] (viscous, coefficient 0.1) depends on omega",
            "step",
        ),
        (
            base().force(formula("step(x - 0.1)")),
            Method::Energy,
            "force[1] (expression `step(x - 0.1)`) may jump",
            "rows",
        ),
        (
            base().torque(Load::Table(speeds.expect("a table"))),
            Method::Angle,
            "has its rows over omega",
            "step",
        ),
        (
            base().start(0.3, 0.0),
            Method::Angle,
            "starts at rest",
            "rows",
        ),
        (
            base().torque(formula("0.01*theta*theta")),
            Method::Angle,
            "does not repeat",
            "rows",
        ),
        (
            base().torque(Load::dry(0.1)),
            Method::Energy,
            "torque[2] (opposes motion, magnitude constant 0.1) depends on omega",
            "rest",
        ),
    ] {
        let options = Options {
            method,
            ..Options::default()
        };
        let why = simulate(&scene, &options).expect_err(words).to_string();
        assert!(why.contains(words) && !why.contains(others), "{why}");
    }
}

#[test]
fn a_load_that_ends_is_named() {
    let ends = Table::new(
        Variable::T,
        &[0.0, 0.05],
        &[1.0, 2.0],
        Interpolation::Linear,
        None,
    );
    let scene = machine().start(0.0, 5.0).duration(1.0);
    let tabled = scene.clone().torque(Load::Table(ends.expect("a table")));
    let why = stopped(&tabled, Method::Auto);
    assert!(why.contains("(table over t, beyond its rows)"), "{why}");
    let rooted = scene.force(formula("sqrt(0.1 - t)"));
    let why = stopped(&rooted, Method::Auto);
    assert!(
        why.contains("(expression `sqrt(0.1 - t)`, outside its domain)"),
        "{why}"
    );
}
