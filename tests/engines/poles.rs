//! Formulas with a pole: a motion ends there, as its energy has no limit; one that turns back before it, and one through
//! a place without a value whose work is finite, goes on. A wheel of constant inertia has the energy in closed form.

use std::f64::consts::{FRAC_PI_2, TAU};

use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Expression, Load, MotionKind, Scene};
use slider_crank::simulate::{Options, Summary, Why, simulate};

const INERTIA: f64 = 0.02;
const SPEED: f64 = 30.0;

/// Wheel with a massless rod and slider, r = 0.05 m, l = 0.15 m, e = 0.01 m.
fn wheel(angle: f64) -> Scene {
    Scene::new(0.05, 0.15)
        .offset(0.01)
        .crank(Crank {
            inertia: INERTIA,
            ..Crank::default()
        })
        .start(angle, SPEED)
        .duration(1.0)
}

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).expect("a formula"))
}

fn run(scene: &Scene, method: Method) -> Summary {
    let options = Options {
        method,
        estimate: true,
        ..Options::default()
    };
    simulate(scene, &options).expect("a run").summary
}

fn energy(speed: f64) -> f64 {
    0.5 * INERTIA * speed * speed
}

/// Slider position, m, in closed form.
fn x(theta: f64) -> f64 {
    0.05 * theta.cos() + (0.15f64.powi(2) - (0.01 + 0.05 * theta.sin()).powi(2)).sqrt()
}

/// Crank angle of the inward stroke at a slider position, m, by bisection.
fn angle_at(position: f64) -> f64 {
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match x(middle) > position {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

#[test]
fn a_motion_ends_at_the_pole_of_a_formula() {
    /// Work from an angle to another, J.
    type Work = fn(f64, f64) -> f64;
    let crank: [(&str, f64, f64, Work); 5] = [
        ("0.1*tan(theta)", 0.3, FRAC_PI_2, |a, b| {
            0.1 * (a.cos() / b.cos()).ln()
        }),
        ("-0.1*tan(theta)", 0.0, FRAC_PI_2, |a, b| {
            -0.1 * (a.cos() / b.cos()).ln()
        }),
        ("0.1/(theta-3)", 0.0, 3.0, |a, b| {
            0.1 * ((3.0 - b) / (3.0 - a)).ln()
        }),
        ("-0.1/(theta-23)", 0.0, 23.0, |a, b| {
            -0.1 * ((23.0 - b) / (23.0 - a)).ln()
        }),
        ("-0.01/sin(theta)", 0.4, TAU / 2.0, |a, b| {
            -0.01 * ((0.5 * b).tan() / (0.5 * a).tan()).ln()
        }),
    ];
    let of_x: (&str, f64, f64, Work) = ("-1/(x-0.15)", 0.0, angle_at(0.15), |a, b| {
        ((x(a) - 0.15) / (x(b) - 0.15)).ln()
    });
    let scenes = crank
        .into_iter()
        .map(|case| (wheel(case.1).torque(formula(case.0)), case))
        .chain([(wheel(of_x.1).force(formula(of_x.0)), of_x)]);
    for (scene, (text, start, pole, work)) in scenes {
        for method in [Method::Auto, Method::Time] {
            let summary = run(&scene, method);
            let Some(Why::NoValue { load, .. }) = summary.stopped.map(|stopped| stopped.why) else {
                panic!("{text} by {method} goes on to {:?}", summary.last);
            };
            let named = load.expect("a load").to_string();
            assert!(named.contains(text), "{named}");
            let last = summary.last;
            assert!(
                (0.0..1e-7).contains(&(pole - last.theta_rad)),
                "{text}: {last:?}"
            );
            let error = summary.error_estimate.expect("an estimate");
            assert!(error.theta_rad < 1e-9, "{text}: {error:?}");
            let expected = energy(SPEED) + work(start, last.theta_rad);
            let off = (energy(last.omega_rad_per_s) / expected - 1.0).abs();
            assert!(off < 1e-7, "{text} by {method}: {off}");
        }
    }
    let options = Options {
        method: Method::Angle,
        ..Options::default()
    };
    let refused = simulate(&wheel(0.3).torque(formula("0.1*tan(theta)")), &options);
    let why = refused.expect_err("no turn").to_string();
    assert!(why.contains("no finite value on the way"), "{why}");
}

/// The impulse of 0.3/(t − 0.3) is a logarithm; so are the losses by the speed beside a pole of the position.
#[test]
fn loads_of_time_and_speed_have_poles_too() {
    for (text, pole) in [
        ("0.3/(t-0.3)", [0.3, f64::NAN]),
        ("0.1*tan(theta) - 0.001*omega", [f64::NAN, FRAC_PI_2]),
        ("-0.002*omega*tan(theta)", [f64::NAN, FRAC_PI_2]),
        ("-0.1*tan(theta)*cos(t)", [f64::NAN, FRAC_PI_2]),
    ] {
        for method in [Method::Auto, Method::Angle, Method::Time] {
            let summary = run(&wheel(0.2).torque(formula(text)), method);
            let stopped = summary.stopped.map(|stopped| stopped.why);
            let last = summary.last;
            assert!(
                matches!(stopped, Some(Why::NoValue { .. })),
                "{text} by {method}: {last:?} {stopped:?}"
            );
            let off = [last.t_s - pole[0], last.theta_rad - pole[1]].map(f64::abs);
            assert!(off[0].min(off[1]) < 1e-6, "{text} by {method}: {last:?}");
        }
    }
    let quick = run(&wheel(0.2).torque(formula("0.1/(t-0.3)^2")), Method::Auto);
    assert!(quick.stopped.is_some() && (0.299..0.3).contains(&quick.last.t_s));
}

/// Work through a root, a logarithm, a removable singularity and a quotient that is the sign of the position.
#[test]
fn singularities_with_finite_work_are_passed() {
    type Work = fn(f64) -> f64;
    let cases: [(&str, Work); 4] = [
        ("0.1/sqrt(abs(theta-3))", |b| {
            0.2 * (3f64.sqrt() + (b - 3.0).sqrt())
        }),
        ("0.1*ln(abs(theta-3))", |b| {
            let of = |d: f64| 0.1 * (d * d.ln() - d);
            of(3.0) + of(b - 3.0)
        }),
        ("0.1*((theta-3)^2 - 9)/(theta-6)", |b| 0.05 * b * b),
        ("0.1*(theta-3)/abs(theta-3)", |b| 0.1 * (b - 6.0)),
    ];
    for (text, work) in cases {
        let summary = run(&wheel(0.0).torque(formula(text)), Method::Auto);
        assert!(summary.stopped.is_none(), "{text}: {:?}", summary.stopped);
        let last = summary.last;
        let off = energy(last.omega_rad_per_s) / (energy(SPEED) + work(last.theta_rad)) - 1.0;
        assert!(off.abs() < 1e-7, "{text}: {off}");
    }
}

/// −c/(θ − 3)² takes all energy where c/(3 − θ) = E + c/3: the motion turns back there, never at the pole.
#[test]
fn a_motion_that_turns_back_before_a_pole_goes_on() {
    let push = 0.01;
    let scene = wheel(0.0).torque(formula("-0.01/(theta-3)^2"));
    let turn = 3.0 - push / (energy(SPEED) + push / 3.0);
    for method in [Method::Auto, Method::Time] {
        let summary = run(&scene, method);
        assert!(summary.stopped.is_none(), "{:?}", summary.stopped);
        let mut turns = summary
            .events
            .iter()
            .filter(|event| event.kind == "turning-point");
        let first = turns.next().expect("a turning point");
        assert!(
            (first.theta_rad - turn).abs() < 1e-9,
            "{first:?}, not {turn}"
        );
    }
}

/// At constant speed the driving torque has no range.
#[test]
fn the_driving_torque_of_a_pole_has_no_range() {
    let mut scene = wheel(0.0).torque(formula("0.1*tan(theta)"));
    scene.motion.kind = MotionKind::ConstantSpeed;
    let summary = run(&scene, Method::Auto);
    assert!(summary.driving_torque.is_none());
    let told = summary.warnings.iter().map(ToString::to_string);
    assert_eq!(told.filter(|told| told.contains("tan(theta)")).count(), 1);
}

/// J θ̈ = −c θ̇ never turns back: θ tends to θ₀ + J ω₀/c, and the last digits of the speed are no turning points.
#[test]
fn a_motion_that_dies_out_has_no_turning_points() {
    let loss = 0.01;
    let scene = wheel(0.0).torque(Load::Viscous(loss)).duration(1000.0);
    let summary = run(&scene, Method::Auto);
    assert!(
        summary
            .events
            .iter()
            .all(|event| event.kind == "dead-centre")
    );
    let rest = INERTIA * SPEED / loss;
    assert!((summary.last.theta_rad / rest - 1.0).abs() < 1e-11);
    let turning = run(&scene.revolutions(40.0), Method::Auto);
    let why = turning.stopped.expect("a reason").to_string();
    assert!(!why.contains("to and fro"), "{why}");
}
