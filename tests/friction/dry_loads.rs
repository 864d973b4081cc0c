//! Loads that oppose motion, compared with closed forms, with an independent piecewise integration, and with the energy
//! balance.

use std::f64::consts::TAU;

use proptest::prelude::*;
use slider_crank::plan::{Method, Plan};
use slider_crank::scene::{
    Crank, Expression, Friction, Gravity, Interpolation, Load, Rod, Scene, Slider, Table, Variable,
    Variables,
};
use slider_crank::simulate::{
    Options, Row, Simulation, Summary, simulate, simulate_rows, steady_state,
};

use crate::support::machines::machine;
use crate::support::random::cases;

fn wheel(inertia: f64) -> Scene {
    Scene::new(0.05, 0.15).crank(Crank {
        inertia,
        ..Crank::default()
    })
}

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).expect("a formula"))
}

fn run(scene: &Scene) -> Simulation {
    let run = simulate(scene, &Options::default()).expect("a run");
    assert_eq!(run.summary.stopped, None);
    run
}

fn times(summary: &Summary, kind: &str) -> Vec<f64> {
    let events = summary.events.iter().filter(|event| event.kind == kind);
    events.map(|event| event.t_s).collect()
}

/// Checks that the end is within the stated error of a reference, plus the uncertainty `known` of the reference.
fn ends_at(summary: &Summary, theta: f64, omega: f64, known: f64) {
    let stated = summary.error_estimate.expect("an estimate");
    let off = [
        summary.last.theta_rad - theta,
        summary.last.omega_rad_per_s - omega,
    ];
    let most = [stated.theta_rad, stated.omega_rad_per_s].map(|stated| stated + known);
    assert!(
        off[0].abs() <= most[0] && off[1].abs() <= most[1],
        "{off:?} {most:?}"
    );
}

/// ω falls linearly: rest after J ω/T, with a rotation of J ω²/(2 T), in either direction.
#[test]
fn a_wheel_comes_to_rest_when_the_brake_has_taken_its_speed() {
    for (inertia, torque, speed) in [(0.02, 0.5, 100.0_f64), (0.3, 7.0, -40.0), (1e-5, 1e-6, 3.0)] {
        let rest = inertia * speed.abs() / torque;
        let scene = wheel(inertia)
            .torque(Load::dry(torque))
            .start(0.4, speed)
            .duration(1.5 * rest);
        let run = run(&scene);
        let found = times(&run.summary, "rest");
        assert!(
            (found[0] / rest - 1.0).abs() < 1e-13,
            "{found:?} for {rest}"
        );
        let turned = 0.5 * inertia * speed * speed.abs() / torque;
        let end = 0.4 + turned;
        // The reference is rounded.
        ends_at(&run.summary, end, 0.0, 0.5 * f64::EPSILON * end.abs());
        let (theta, omega) = run.at(0.3 * rest).expect("inside the run");
        assert!((omega / (0.7 * speed) - 1.0).abs() < 1e-12, "{omega}");
        assert!(
            (theta - 0.4 - 0.51 * turned).abs() < 1e-12 * turned.abs(),
            "{theta}"
        );
    }
}

/// The crank turns over its angle first and comes to rest in time: there are rows and largest forces of both.
#[test]
fn a_braked_crank_has_forces_up_to_its_rest() {
    let scene = wheel(0.01)
        .slider(Slider { mass: 0.5 })
        .torque(Load::dry(0.4))
        .torque(Load::Viscous(1e-3))
        .start(0.35, 20.0)
        .duration(2.0);
    let options = Options {
        reactions: true,
        ..Options::default()
    };
    let run = simulate(&scene, &options).expect("a run");
    assert_eq!(run.summary.pieces.len(), 2, "{:?}", run.summary.pieces);
    let peaks = run.summary.peaks.expect("the largest forces");
    for t in [0.1, 0.5, 1.0, 2.0] {
        let row = run.row(t).expect("a row");
        let [x, y] = row.reactions.expect("forces").shaking;
        assert!(x.hypot(y) <= peaks.shaking.value_n * (1.0 + 1e-9), "{t}");
    }
}

/// Under 2 sin 3t the band of 1 N m holds until sin 3t = 1/2; the motion after that is elementary.
#[test]
fn a_torque_in_time_tears_it_loose_at_the_edge_of_the_band() {
    let inertia = 0.02;
    let scene = wheel(inertia)
        .torque(Load::dry(1.0))
        .torque(formula("2*sin(3*t)"))
        .duration(1.2);
    let run = run(&scene);
    let slip = 0.5_f64.asin() / 3.0;
    let found = times(&run.summary, "slip");
    assert_eq!(times(&run.summary, "stick"), [0.0]);
    assert!((found[0] - slip).abs() < 1e-14, "{found:?} for {slip}");
    let (t, c): (f64, f64) = (1.2, (3.0 * slip).cos());
    let late = t - slip;
    let omega = (2.0 / 3.0 * (c - (3.0 * t).cos()) - late) / inertia;
    let theta =
        (2.0 / 3.0 * (c * late - ((3.0 * t).sin() - 0.5) / 3.0) - 0.5 * late * late) / inertia;
    ends_at(&run.summary, theta, omega, 1e-14);
}

/// Blow of 20 us in two seconds of rest, at the crank or at a slider held by the guide.
#[test]
fn a_blow_while_it_is_held_is_not_missed() {
    let (at, width) = (0.7321, 2e-5);
    let blow = |size: f64| formula(&format!("{size}*exp(-((t - {at})/{width})^2)"));
    let edge = at - width * 3.0_f64.ln().sqrt();
    let braked = wheel(0.02).torque(Load::dry(1.0)).torque(blow(3.0));
    let mut rubbing = wheel(0.02)
        .slider(Slider { mass: 0.5 })
        .gravity(Gravity {
            acceleration: 10.0,
            ..Gravity::standard()
        })
        .force(blow(3.0))
        .start(1.0, 0.0);
    // Without a torque the rod transmits nothing, and the guide holds 0.2 times 5 N.
    rubbing.friction = Some(Friction {
        coefficient: 0.2,
        static_coefficient: 0.2,
    });
    for scene in [braked, rubbing] {
        let summary = run(&scene.duration(2.0)).summary;
        let slips = times(&summary, "slip");
        assert!(
            slips.len() == 1 && (slips[0] - edge).abs() < 1e-12,
            "{slips:?} for {edge}"
        );
        assert_eq!(times(&summary, "rest").len(), 1);
    }
}

/// Reference: DOP853 of SciPy at its tightest tolerance, from reversal to dead centre to rest, for an independent
/// equation.
#[test]
fn a_crank_and_a_slider_that_rub_turn_back_at_different_places() {
    let scene = Scene::new(0.05, 0.15)
        .offset(0.01)
        .crank(Crank {
            inertia: 0.002,
            ..Crank::default()
        })
        .rod(Rod {
            mass: 0.4,
            cg: 0.06,
            inertia: 0.001,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.6 })
        .gravity(Gravity {
            acceleration: 9.81,
            ..Gravity::standard()
        })
        .torque(Load::dry(0.35))
        .force(Load::dry(12.0))
        .force(formula("40*sin(9*t)"))
        .start(0.3, 20.0)
        .duration(3.0);
    let summary = run(&scene).summary;
    let slips = [
        0.050869139978298714,
        0.41783258311421406,
        0.7560535173285139,
        1.0991279522186659,
        1.4676772907020694,
        1.7971321565578413,
        2.175759665212243,
        2.8843959896322304,
    ];
    let found = times(&summary, "slip");
    assert_eq!(found.len(), slips.len());
    for (found, slip) in found.iter().zip(slips) {
        assert!((found - slip).abs() < 1e-11, "{found} for {slip}");
    }
    ends_at(&summary, -23.216639572346278, -10.25002258320934, 2e-12);
    let (rows, _) = rows(&scene);
    // At rest nothing moves, and the forces balance.
    let still = rows.iter().filter(|row| row.omega == 0.0).count();
    assert!(still > 30, "{still}");
}

fn rows(scene: &Scene) -> (Vec<Row>, Summary) {
    let options = Options {
        reactions: true,
        ..Options::default()
    };
    let mut rows = Vec::new();
    let run = simulate_rows(scene, &options, &mut rows).expect("a run");
    (rows, run.summary)
}

/// A brake on the crank holds a force on the slider through the rod; a brake on the slider holds it directly.
#[test]
fn what_holds_decides_where_the_force_goes() {
    let held = |brake: fn(Scene) -> Scene| {
        let scene = wheel(0.02).slider(Slider { mass: 0.5 });
        let scene = brake(scene)
            .force(Load::Constant(-30.0))
            .start(1.1, 0.0)
            .duration(0.1);
        let (rows, summary) = rows(&scene);
        assert_eq!(times(&summary, "rest"), [0.0]);
        rows.last()
            .expect("rows")
            .reactions
            .expect("reactions")
            .wrist_pin[0]
            .abs()
    };
    let by_crank = held(|scene| scene.torque(Load::dry(5.0)));
    assert!((by_crank - 30.0).abs() < 1e-12, "{by_crank}");
    let by_slider = held(|scene| scene.force(Load::dry(31.0)));
    assert!(by_slider < 1e-12, "{by_slider}");
}

/// The holding forces of brakes on crank and slider and of the guide add up.
#[test]
fn the_bands_add_up() {
    let (theta, weight) = (1.1_f64, 0.5 * 9.81);
    let phi = (0.05 * theta.sin() / 0.15).asin();
    let dx = -0.05 * theta.sin() - 0.05 * theta.cos() * phi.tan();
    let torque: f64 = 0.7;
    // The rod transmits the torque to the slider, and presses it on the guide.
    let along = torque / dx.abs();
    let most = |mu: f64, aside: f64| along + 4.0 + mu * (weight + aside).abs();
    for (mu, push) in [(0.0, 1.0), (0.0, -1.0), (0.2, 1.0), (0.2, -1.0)] {
        let aside = -push * along * phi.tan();
        let edge = most(mu, aside);
        let moves = |part: f64| {
            let mut scene = wheel(0.02)
                .slider(Slider { mass: 0.5 })
                .gravity(Gravity {
                    acceleration: 9.81,
                    ..Gravity::standard()
                })
                .torque(Load::dry(torque))
                .force(Load::dry(4.0))
                .force(Load::Constant(push * part * edge))
                .start(theta, 0.0)
                .duration(0.01);
            if mu > 0.0 {
                scene.friction = Some(Friction {
                    coefficient: mu,
                    static_coefficient: mu,
                });
            }
            run(&scene).summary.last.omega_rad_per_s != 0.0
        };
        assert!(
            !moves(1.0 - 1e-9) && moves(1.0 + 1e-9),
            "mu {mu}, push {push}, {edge} N"
        );
    }
}

/// A drive at constant speed works against both brakes, in either sense of rotation.
#[test]
fn a_driven_crank_works_against_them() {
    for speed in [3.0, -3.0] {
        let scene = Scene::new(0.05, 0.15)
            .torque(Load::dry(0.5))
            .force(Load::dry(20.0))
            .constant_speed(0.2, speed)
            .duration(TAU / 3.0);
        let summary = run(&scene).summary;
        let range = summary.driving_torque.expect("a driving torque");
        // In a turn the slider moves to and fro over the stroke of 0.1 m.
        let mean = speed.signum() * (0.5 + 20.0 * 2.0 * 0.1 / TAU);
        assert!((range.mean_nm - mean).abs() < 1e-9, "{range:?} for {mean}");
        let least = if speed > 0.0 {
            range.min_nm
        } else {
            -range.max_nm
        };
        assert!((least - 0.5).abs() < 1e-6, "{range:?}");
    }
}

/// Motor line of 5 N m at rest and none at 100 rad/s against a brake of 2 N m: the speed is 60 rad/s, and the
/// multiplier of a small deviation is exp(-c T/J).
#[test]
fn a_motor_and_a_brake_agree_on_a_speed() {
    for sense in [1.0, -1.0] {
        let motor = Load::Motor {
            stall: 5.0 * sense,
            no_load_speed: 100.0 * sense,
        };
        let scene = wheel(0.02).torque(motor).torque(Load::dry(2.0));
        let found = steady_state(&scene.start(0.0, 20.0 * sense), None, &Options::default());
        let found = found.expect("a steady state");
        let near = |value: f64, expected: f64| {
            assert!((value - expected).abs() < 1e-9, "{value} for {expected}");
        };
        near(found.omega_mean_rad_per_s.value, 60.0 * sense);
        near(found.fluctuation.value, 0.0);
        near(found.multiplier.value, (-0.05 * TAU / 60.0 / 0.02).exp());
    }
}

/// A table over omega is read at |omega|, so that both directions agree.
#[test]
fn a_magnitude_over_the_speed_is_the_same_in_both_directions() {
    let stribeck = || {
        let table = Table::new(
            Variable::Omega,
            &[0.0, 5.0, 60.0],
            &[0.9, 0.4, 0.8],
            Interpolation::Pchip,
            None,
        );
        Load::Dry(Box::new(Load::Table(table.expect("a table"))))
    };
    let end = |speed: f64| {
        let scene = wheel(0.02)
            .torque(stribeck())
            .start(0.0, speed)
            .duration(1.0);
        run(&scene).summary.last
    };
    let (forwards, back) = (end(50.0), end(-50.0));
    assert!((forwards.theta_rad + back.theta_rad).abs() < 1e-12);
    assert!((forwards.omega_rad_per_s + back.omega_rad_per_s).abs() < 1e-12);
    assert!(forwards.omega_rad_per_s > 0.0);
}

/// A formula that is linear in the sign of the speed of its body is a dry load beside a rest: it holds and slips as
/// one of kind "dry", from the same steps.
#[test]
fn a_formula_with_the_sign_of_the_speed_is_a_dry_load() {
    let pairs = [
        ("-2*sign(omega)", None, 2.0),
        ("3*cos(9*t) - 2*sign(omega)", Some("3*cos(9*t)"), 2.0),
        ("2 - 4*step(omega)", None, 2.0),
        (
            "(3*cos(9*t)*sign(omega) - 2)*sign(omega)",
            Some("3*cos(9*t)"),
            2.0,
        ),
        (
            "(sin(theta) - sign(omega))/0.5 + 1",
            Some("2*sin(theta) + 1"),
            2.0,
        ),
        ("-sign(omega)*(5 - 3)", None, 2.0),
    ];
    for (text, rest, magnitude) in pairs {
        for (speed, lengths) in [(12.0, [0.05, 0.15, 0.01]), (0.0, [0.08, 0.07, 0.04])] {
            let scene = machine(lengths, false, [1.0, 0.3, 0.5], 0.0)
                .gravity(Gravity::standard())
                .torque(formula("cos(20*t)"))
                .start(0.1, speed)
                .duration(1.5);
            let mut apart = scene.clone().torque(Load::dry(magnitude));
            if let Some(rest) = rest {
                apart = apart.torque(formula(rest));
            }
            let [one, other] =
                [scene.torque(formula(text)), apart].map(|scene| run(&scene).summary);
            assert_eq!(one.events.len(), other.events.len(), "{text}");
            for (event, same) in one.events.iter().zip(&other.events) {
                assert_eq!(event.kind, same.kind, "{text}");
                assert!(
                    (event.t_s - same.t_s).abs() < 1e-9,
                    "{text}: {event:?} {same:?}"
                );
            }
            let known = other.error_estimate.expect("an estimate").theta_rad;
            ends_at(
                &one,
                other.last.theta_rad,
                other.last.omega_rad_per_s,
                known,
            );
            assert!(
                !times(&one, "rest").is_empty() || !times(&one, "stick").is_empty(),
                "{text}"
            );
        }
    }
}

/// No dry load: another body's speed, a magnitude that is zero or may be negative at rest, the sign inside a function.
#[test]
fn other_formulas_with_the_sign_of_a_speed_do_not_hold() {
    let texts = [
        "-2*sign(v)",
        "2*sign(omega)",
        "-0.01*omega^2*sign(omega)",
        "-sin(theta)*sign(omega)",
        "-exp(sign(omega))",
        "-2/sign(omega)",
        "-2/sign(omega) - 3*sign(omega)",
        "2^sign(omega) - 3*sign(omega)",
        "min(sign(omega), 0.5) - 3*sign(omega)",
    ];
    for text in texts {
        assert!(!holds(text), "{text}");
    }
    for text in [
        "-2*sign(omega)",
        "-(2 + omega)*sign(omega)",
        "-theta^2*sign(omega)",
        "-x^2*step(omega)",
    ] {
        assert!(holds(text), "{text}");
    }
}

/// True if a wheel may stick under a torque, as the plan's term says.
fn holds(text: &str) -> bool {
    let scene = wheel(0.02).torque(formula(text)).start(0.4, 50.0);
    let plan = Plan::new(&scene.duration(0.1), Method::Auto).expect("a plan");
    let may_stick = plan.events.contains(&"stick");
    let mut reasons = plan.kept.iter().map(|term| term.reason.to_string());
    let is_told = reasons.any(|reason| reason.ends_with("; holds at rest"));
    assert_eq!(may_stick, is_told, "{text}");
    may_stick
}

/// J ω̇ = −(a + b ω) sgn ω comes to rest after sgn ω₀ (J/b) ln(1 + b ω₀/a): the magnitude of a formula is read at the speed itself.
#[test]
fn the_magnitude_of_a_formula_is_read_at_the_speed_itself() {
    let (a, b, inertia) = (0.8, 0.02, 0.03);
    for speed in [30.0, -30.0f64] {
        let scene = wheel(inertia)
            .torque(formula(&format!("-({a} + {b}*omega)*sign(omega)")))
            .start(0.0, speed)
            .duration(3.0);
        let run = run(&scene);
        let rest = speed.signum() * inertia / b * ((a + b * speed) / a).ln();
        let found = times(&run.summary, "rest");
        assert!(
            (found[0] / rest - 1.0).abs() < 1e-12,
            "{found:?} for {rest}"
        );
    }
}

proptest! {
    #![proptest_config(cases(60))]

    /// Energy is balanced over limits, dead centres and rests, and a closure with the sign of the speed agrees up to
    /// the first rest.
    #[test]
    fn energy_is_balanced_and_a_closure_with_the_sign_agrees(
        lengths in prop_oneof![
            (0.03..0.06, 0.12..0.2, -0.03..0.03),
            (0.06..0.1, 0.05..0.09, 0.03..0.05),
        ],
        masses in (0.5..3.0, 0.2..1.0, 0.2..2.0),
        (torque, force) in (0.0..2.0_f64, 0.0..30.0_f64),
        mu in prop_oneof![Just(0.0), 0.01..0.2],
        (drive, rate) in (-3.0..3.0, 2.0..20.0),
        speed in -30.0..30.0,
    ) {
        let (r, l, e): (f64, f64, f64) = lengths;
        let mut scene = machine([r, l, e], false, [masses.0, masses.1, masses.2], 0.0)
            .gravity(Gravity::standard())
            .torque(formula(&format!("{drive}*cos({rate}*t)")))
            .start(0.1, speed)
            .duration(1.0);
        if mu > 0.0 {
            scene.friction = Some(Friction { coefficient: mu, static_coefficient: mu });
        }
        let dry = scene.clone().torque(Load::dry(torque)).force(Load::dry(force));
        let Ok(run) = simulate(&dry, &Options::default()) else { return Ok(()) };
        let summary = &run.summary;
        prop_assume!(summary.stopped.is_none());
        prop_assert!(summary.energy_residual.abs() < 1e-9, "{}", summary.energy_residual);
        let stops = ["stick", "rest", "turning-point", "limit"];
        let first = summary.events.iter().find(|event| stops.contains(&event.kind));
        let until = 0.9 * first.map_or(1.0, |event| event.t_s);
        if until > 0.01 {
            let signs = scene
                .torque(Load::function(Variables::OMEGA, move |now| -torque.copysign(now.omega)))
                .force(Load::function(Variables::V, move |now| -force.copysign(now.v)))
                .duration(until);
            let other = simulate(&signs, &Options::default()).expect("a run").summary;
            let (theta, omega) = run.at(until).expect("inside the run");
            prop_assert!((other.last.theta_rad - theta).abs() < 1e-7, "{} {theta}", other.last.theta_rad);
            prop_assert!((other.last.omega_rad_per_s - omega).abs() < 1e-6, "{omega}");
        }
    }
}
