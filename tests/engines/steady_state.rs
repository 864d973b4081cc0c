//! Periodic steady state compared with closed solutions, with an independent quadrature, and with long simulations in
//! time.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use slider_crank::mechanism::Equation;
use slider_crank::plan::Method;
use slider_crank::scene::{
    Branch, Clearance, Crank, Friction, Gravity, Joint, Load, Period, Rod, Scene, Slider, Variables,
};
use slider_crank::simulate::{Estimated, Options, SteadyState, Summary, simulate, steady_state};

fn steady(scene: &Scene) -> SteadyState {
    steady_state(scene, None, &Options::default()).unwrap()
}

fn sized(scene: &Scene, fluctuation: f64) -> SteadyState {
    steady_state(scene, Some(fluctuation), &Options::default()).unwrap()
}

fn refused(scene: &Scene, fluctuation: Option<f64>, words: &[&str]) {
    let said = steady_state(scene, fluctuation, &Options::default());
    let said = said.unwrap_err().to_string();
    for word in words {
        assert!(said.contains(word), "{word}: {said}");
    }
}

fn crank(inertia: f64) -> Scene {
    Scene::new(0.05, 0.15).crank(Crank {
        inertia,
        ..Crank::default()
    })
}

/// Pump with all masses, an offset and a load on the slider; `sense` reverses the motor.
fn pump(branch: Branch, sense: f64) -> Scene {
    Scene::new(0.05, 0.15)
        .offset(-0.015)
        .branch(branch)
        .crank(Crank {
            mass: 1.5,
            cg: 0.01,
            cg_lateral: -0.004,
            inertia: 0.01,
        })
        .rod(Rod {
            mass: 0.4,
            cg: 0.06,
            cg_lateral: 0.003,
            inertia: 1.2e-3,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.6 })
        .gravity(Gravity {
            acceleration: 9.81,
            direction: -1.2,
        })
        .torque(Load::Motor {
            stall: sense * 8.0,
            no_load_speed: sense * 120.0,
        })
        .force(Load::Viscous(10.0))
        .force(Load::function(Variables::V, |now| {
            -2.0 * now.v * (1.0 + now.v * now.v).sqrt()
        }))
        .start(0.7, sense * 40.0)
}

fn turns(scene: &Scene, turns: f64, method: Method) -> Summary {
    let options = Options {
        method,
        ..Options::default()
    };
    let scene = scene.clone().revolutions(turns).tolerance(1e-12);
    simulate(&scene, &options).unwrap().summary
}

/// Returns least, largest and mean speed of I ω dω/dθ = τ0 + τ1 sin θ − c ω, by the Runge-Kutta method over the angle,
/// turn after turn.
fn reference(inertia: f64, tau: [f64; 2], c: f64) -> [f64; 4] {
    const STEPS: u32 = 20_000;
    let h = TAU / f64::from(STEPS);
    let slope = |theta: f64, w: f64| (tau[0] + tau[1] * theta.sin() - c * w) / (inertia * w);
    let mut w = tau[0] / c;
    let (mut low, mut high, mut time, mut before);
    loop {
        before = w;
        (low, high, time) = (w, w, 0.0);
        for i in 0..STEPS {
            let theta = f64::from(i) * h;
            let k1 = slope(theta, w);
            let k2 = slope(theta + 0.5 * h, w + 0.5 * h * k1);
            let k3 = slope(theta + 0.5 * h, w + 0.5 * h * k2);
            let k4 = slope(theta + h, w + h * k3);
            // The error of the trapezoidal rule over a period is negligible.
            time += h / w;
            w += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            (low, high) = (low.min(w), high.max(w));
        }
        if (w - before).abs() < 1e-14 * w {
            return [low, high, TAU / time, w];
        }
    }
}

#[test]
fn a_crank_alone_turns_at_the_speed_where_torque_and_loss_are_equal() {
    let (inertia, tau, c) = (0.02, 3.0, 0.1);
    for sense in [1.0, -1.0] {
        for start in [1e-3, 5.0, 30.0, 4e3] {
            let scene = crank(inertia)
                .torque(Load::Constant(sense * tau))
                .torque(Load::Viscous(c))
                .start(-9.0, sense * start);
            let found = steady(&scene);
            for omega in [found.omega_mean_rad_per_s, found.omega_rad_per_s] {
                assert!((omega.value - sense * tau / c).abs() <= omega.error);
                assert!(omega.error < 1e-11);
            }
            assert!(found.fluctuation.value <= found.fluctuation.error);
            assert!(found.fluctuation.error < 1e-12 && found.fastest.theta_rad.is_none());
            let left = (-TAU * c * c / (inertia * tau)).exp();
            assert!((found.multiplier.value - left).abs() <= found.multiplier.error);
            assert!(found.multiplier.error < 1e-10 && found.stable);
            assert_eq!(found.approached_from_start, Some(true));
            assert!((found.power_in_w.value - tau * tau / c).abs() < 1e-9);
        }
    }
}

#[test]
fn a_torque_that_varies_over_the_angle() {
    for (inertia, tau, c) in [
        (0.02, [3.0, 8.0], 0.1),
        (0.5, [3.0, -20.0], 0.05),
        // The loss is so large that a turn forgets its start.
        (1e-4, [3.0, 2.0], 0.2),
    ] {
        let [low, high, mean, at_zero] = reference(inertia, tau, c);
        for sense in [1.0, -1.0] {
            let scene = crank(inertia)
                .torque(
                    Load::function(Variables::THETA, move |now| {
                        sense * tau[0] + tau[1] * now.theta.sin()
                    })
                    .with_period(Period::TURN),
                )
                .torque(Load::Viscous(c))
                .start(0.0, sense * tau[0] / c);
            let found = steady(&scene);
            let near = |got: f64, want: f64, part: f64| {
                assert!((got - sense * want).abs() < part * want, "{got} {want}");
            };
            near(found.omega_rad_per_s.value, at_zero, 1e-10);
            near(found.omega_mean_rad_per_s.value, mean, 1e-10);
            // The extremes of the reference are at its points, 3e-4 rad apart.
            near(found.slowest.omega_rad_per_s.value, low, 1e-6);
            near(found.fastest.omega_rad_per_s.value, high, 1e-6);
            // At an extreme of the speed the torques balance.
            for extreme in [found.slowest, found.fastest] {
                let theta = extreme.theta_rad.unwrap();
                let omega = extreme.omega_rad_per_s.value;
                let torque = sense * tau[0] + tau[1] * theta.value.sin() - c * omega;
                assert!(torque.abs() < 1e-8 * tau[0], "{torque:e}");
            }
        }
    }
}

/// Reference: DOP853 of SciPy at rtol 3e-14 over the angle, with energies from the loop closure, and Brent's root.
#[test]
fn the_motor_driven_pump_agrees_with_scipy() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/data/motor-and-losses.toml");
    let found = steady(&Scene::load(file).unwrap());
    assert!((found.omega_rad_per_s.value / 98.246_838_379_917_1 - 1.0).abs() < 1e-12);
    assert!((found.period_s.value / 0.064_244_052_574_139_12 - 1.0).abs() < 1e-12);
}

#[test]
fn a_long_simulation_in_time_comes_to_the_same_motion() {
    for branch in [Branch::Right, Branch::Left] {
        for sense in [1.0, -1.0] {
            let scene = pump(branch, sense);
            let found = steady(&scene);
            let enough = (1e-14f64.ln() / found.multiplier.value.ln()).ceil();
            assert!(enough < 400.0, "{enough}");
            for method in [Method::Time, Method::Dop853] {
                let [before, last] =
                    [enough, enough + 1.0].map(|count| turns(&scene, count, method).last);
                let (speed, period) = (found.omega_rad_per_s, found.period_s);
                let apart = (last.omega_rad_per_s - speed.value).abs() / speed.value.abs();
                assert!(apart < 1e-9, "{method} {apart:e}");
                let apart = (last.t_s - before.t_s - period.value).abs() / period.value;
                assert!(apart < 1e-9, "{method} {apart:e}");
            }
            let turn = turns(&found.start(&scene), 1.0, Method::Dop853);
            let (low, high) = if sense > 0.0 {
                (turn.omega_min, turn.omega_max)
            } else {
                (turn.omega_max, turn.omega_min)
            };
            assert!((found.slowest.omega_rad_per_s.value - low).abs() < 1e-7);
            assert!((found.fastest.omega_rad_per_s.value - high).abs() < 1e-7);
            let balance = found.power_in_w.value - found.power_out_w.value;
            assert!(balance.abs() <= found.power_in_w.error + found.power_out_w.error);
            assert!(found.power_in_w.error < 1e-8 && found.power_in_w.value > 10.0);
        }
    }
}

/// The multiplier of a small deviation follows from damping over inertia: its rate is ∂θ̈/∂ω minus that of the changing
/// inertia.
#[test]
fn a_deviation_is_left_as_the_damping_says() {
    let (c, d) = (0.02, 12.0);
    let scene = crank(0.01)
        .slider(Slider { mass: 0.8 })
        .torque(Load::Constant(4.0))
        .torque(Load::Viscous(c))
        .force(Load::Viscous(d))
        .start(0.3, 60.0);
    let found = steady(&scene);
    let turn = simulate(&found.start(&scene), &Options::default()).unwrap();
    let equation = Equation::new(&scene);
    // ∮ (c + d x'²)/M dt by the trapezoidal rule over a period.
    const STEPS: u32 = 4000;
    let step = found.period_s.value / f64::from(STEPS);
    let rate = |i: u32| {
        let (theta, _) = turn
            .at((f64::from(i) * step).min(turn.summary.last.t_s))
            .unwrap();
        let terms = equation.terms(theta);
        (c + d * terms.pose.dx.powi(2)) / terms.m
    };
    let left = (-step * (0..STEPS).map(rate).sum::<f64>()).exp();
    let multiplier = found.multiplier;
    assert!(
        (multiplier.value - left).abs() < 1e-10,
        "{multiplier:?} {left}"
    );
    assert!(multiplier.error < 1e-10);
}

#[test]
fn stated_errors_hold_where_a_deviation_dies_slowly() {
    // The speed follows from the balance of the losses alone: a turn removes 1e-6 of a deviation.
    let (inertia, tau, c) = (2.0, 1e-4, 1e-5);
    let scene = crank(inertia)
        .torque(Load::Constant(tau))
        .torque(Load::Viscous(c))
        .start(1.0, 3.0);
    let found = steady(&scene).omega_mean_rad_per_s;
    assert!((found.value - tau / c).abs() <= found.error, "{found:?}");
    assert!(found.error < 1e-6);
}

#[test]
fn of_several_steady_states_it_is_the_one_that_the_start_approaches() {
    let scene = |start: f64| {
        crank(0.02)
            .torque(Load::function(Variables::OMEGA, |now| {
                -1e-3 * (now.omega - 10.0) * (now.omega - 20.0) * (now.omega - 30.0)
            }))
            .start(0.0, start)
    };
    for (start, speed) in [
        (3.0, 10.0),
        (14.0, 10.0),
        (19.5, 10.0),
        (20.5, 30.0),
        (90.0, 30.0),
    ] {
        let found = steady(&scene(start)).omega_mean_rad_per_s;
        assert!(
            (found.value - speed).abs() <= found.error && found.error < 1e-11,
            "{start}"
        );
    }
}

#[test]
fn a_start_that_stops_is_said() {
    // The crank cannot lift its weight from the start, but can in the steady state.
    let scene = Scene::new(0.05, 0.15)
        .crank(Crank {
            mass: 3.0,
            cg: 0.03,
            cg_lateral: 0.0,
            inertia: 0.02,
        })
        .gravity(Gravity {
            acceleration: 9.81,
            direction: -std::f64::consts::FRAC_PI_2,
        })
        .torque(Load::Motor {
            stall: 0.5,
            no_load_speed: 50.0,
        });
    let found = steady(&scene.clone().start(-1.5, 1.0));
    assert_eq!(found.approached_from_start, Some(false));
    assert!(found.notes.iter().any(|note| note.contains("stops")));
    let faster = steady(&scene.clone().start(-1.5, 40.0));
    assert_eq!(faster.approached_from_start, Some(true));
    let apart = found.omega_rad_per_s.value - faster.omega_rad_per_s.value;
    assert!(apart.abs() <= found.omega_rad_per_s.error);
    let rests = steady(&scene.start(-1.5, 0.0));
    assert_eq!(rests.approached_from_start, None);
    assert!(rests.omega_mean_rad_per_s.value > 40.0);
}

#[test]
fn without_speed_in_the_loads_the_start_speed_is_the_steady_one() {
    let scene = Scene::duarte();
    let found = steady(&scene);
    assert!((found.omega_rad_per_s.value - scene.motion.speed).abs() < 1e-12);
    assert!(!found.stable && found.multiplier.value == 1.0);
    let turn = turns(&scene, 1.0, Method::Dop853);
    assert!((turn.last.t_s - found.period_s.value).abs() < 1e-11);
    assert!((turn.omega_min - found.slowest.omega_rad_per_s.value).abs() < 1e-7);
}

/// I ω²/2 = I ω₀²/2 + A sin(2θ)/2: the second order of ω = √(ω₀² + A sin(2θ)/I), by the midpoint rule.
#[test]
fn orders_of_the_speed_are_its_fourier_coefficients() {
    let (inertia, size, speed) = (0.02, 3.0, 30.0);
    let scene = crank(inertia)
        .torque(
            Load::function(Variables::THETA, |now| 3.0 * (2.0 * now.theta).cos())
                .with_period(Period::TURN),
        )
        .start(0.0, speed);
    let found = steady(&scene).speed_orders;
    let omega = |theta: f64| (speed * speed + size / inertia * (2.0 * theta).sin()).sqrt();
    let amplitude = |order: f64| {
        let parts = (0..1000).map(|k| (f64::from(k) + 0.5) / 1000.0 * TAU);
        let sums = parts.fold([0.0, 0.0], |[even, odd], theta| {
            let (sin, cos) = (order * theta).sin_cos();
            [even + omega(theta) * cos, odd + omega(theta) * sin]
        });
        2.0 * sums[0].hypot(sums[1]) / 1000.0
    };
    assert_eq!(found.len(), 12);
    for one in found {
        let Estimated { value, error } = one.amplitude_rad_per_s;
        let off = (value - amplitude(one.order)).abs();
        assert!(
            off <= error + 1e-13 * speed && error < 1e-11 * speed,
            "{one:?} is off by {off}"
        );
    }
}

#[test]
fn the_flywheel_gives_the_wanted_fluctuation() {
    for branch in [Branch::Right, Branch::Left] {
        for sense in [1.0, -1.0] {
            let scene = pump(branch, sense);
            for wanted in [0.2, 0.02, 1e-3] {
                let found = sized(&scene, wanted);
                let wheel = found.flywheel.unwrap();
                let added = wheel.added_inertia_kg_m2;
                assert_eq!(added.value < 0.0, wanted > found.fluctuation.value);
                assert!((wheel.fluctuation.value / wanted - 1.0).abs() < 1e-9);
                assert!(added.error < 1e-7 * wheel.crank_inertia_kg_m2, "{added:?}");
                let mut with = scene.clone();
                with.crank.as_mut().unwrap().inertia += added.value;
                let anew = steady(&with);
                assert!((anew.fluctuation.value / wanted - 1.0).abs() < 1e-9);
                // Reference: integration in time over a turn.
                let turn = turns(&anew.start(&with), 1.0, Method::Dop853);
                let mean = TAU / turn.last.t_s;
                let simulated = (turn.omega_max - turn.omega_min) / mean;
                assert!((simulated / wanted - 1.0).abs() < 1e-5, "{simulated}");
            }
        }
    }
}

/// The fluctuation is nearly in proportion to the inverse of the inertia: few steady states are searched for a flywheel.
#[test]
fn a_flywheel_costs_few_steady_states() {
    let evaluations = |fluctuation: Option<f64>| {
        let count = Arc::new(AtomicU64::new(0));
        let counted = count.clone();
        let reads = Variables::THETA.or(Variables::OMEGA);
        let torque = Load::function(reads, move |now| {
            counted.fetch_add(1, Relaxed);
            3.0 + 5.0 * now.theta.sin() - 0.1 * now.omega
        });
        let mut scene = crank(0.02)
            .slider(Slider { mass: 0.5 })
            .torque(torque.with_period(Period::TURN))
            .start(0.0, 30.0);
        scene.friction = Some(Friction {
            coefficient: 0.1,
            static_coefficient: 0.1,
        });
        steady_state(&scene, fluctuation, &Options::default()).unwrap();
        count.load(Relaxed)
    };
    let [without, with] = [None, Some(1e-3)].map(evaluations);
    assert!(with < 6 * without, "{with} and {without}");
}

/// δ = ΔE/(I ω²) for a heavy flywheel, with ΔE = 2 τ1 for a torque τ1 sin θ (Norton, Design of Machinery, ch. 11).
#[test]
fn a_heavy_flywheel_follows_the_rule_of_its_energy() {
    let (tau, tau_1, c) = (3.0, 5.0, 0.1);
    let scene = crank(0.02)
        .torque(
            Load::function(Variables::THETA, move |now| tau_1 * now.theta.sin())
                .with_period(Period::TURN),
        )
        .torque(Load::Constant(tau))
        .torque(Load::Viscous(c))
        .start(0.0, 30.0);
    let mut off = Vec::new();
    for wanted in [1e-2, 1e-3, 1e-4] {
        let wheel = sized(&scene, wanted).flywheel.unwrap();
        let omega = wheel.omega_mean_rad_per_s.value;
        let rule = 2.0 * tau_1 / (wanted * omega * omega);
        off.push((wheel.crank_inertia_kg_m2 / rule - 1.0).abs());
    }
    assert!(off[1] < 1e-5 && off[2] < 1e-6 && off[0] < 1e-3, "{off:?}");
}

#[test]
fn what_has_no_steady_state_is_refused_with_the_reason() {
    let start = |scene: Scene| scene.start(0.2, 20.0);
    let viscous = || start(crank(0.02).torque(Load::Viscous(0.1)));
    refused(&viscous(), None, &["no steady state", "stops"]);
    let driven = start(crank(0.02).torque(Load::Constant(3.0)));
    refused(&driven, None, &["no steady state", "gains 1.8849"]);
    let braked = start(crank(0.02).torque(Load::Constant(-3.0)));
    refused(&braked, None, &["no steady state"]);
    let anti = start(crank(0.02).torque(Load::function(Variables::OMEGA, |now| 0.1 * now.omega)));
    refused(&anti, None, &["no steady state", "gains"]);
    let constant = viscous().constant_speed(0.0, 10.0);
    refused(&constant, None, &["prescribes"]);
    let timed = viscous().torque(Load::function(Variables::T, |now| now.t.sin()));
    refused(&timed, None, &["time t"]);
    let unstated = viscous().torque(Load::function(Variables::THETA, |now| now.theta.sin()));
    refused(&unstated, None, &["torque[2]", "states no period"]);
    let mut loose = viscous();
    loose.clearance = Some(Clearance::new(Joint::CrankPin, 1e-4));
    refused(&loose, None, &["clearance"]);
    let rocks = Scene::new(0.05, 0.03).slider(Slider { mass: 1.0 });
    refused(
        &start(rocks.torque(Load::Viscous(0.1))),
        None,
        &["turns fully"],
    );
    let light = Scene::new(0.05, 0.15).slider(Slider { mass: 1.0 });
    refused(&start(light), None, &["no bound"]);
    let rests = crank(0.02).start(0.0, 0.0);
    refused(&rests, None, &["at rest", "start speed"]);
}

#[test]
fn a_flywheel_that_cannot_be_is_refused_with_the_reason() {
    let scene = pump(Branch::Right, 1.0);
    for wanted in [0.0, -0.1, 2.0, f64::NAN, f64::INFINITY] {
        refused(&scene, Some(wanted), &["coefficient of fluctuation"]);
    }
    refused(&scene, Some(1.9), &["1.9", "less inertia"]);
    let even = crank(0.02)
        .torque(Load::Constant(1.0))
        .torque(Load::Viscous(0.1))
        .start(0.0, 3.0);
    refused(&even, Some(0.02), &["constant"]);
}

/// What a turn gains is told by the work of the loads, not by the difference of energies beside which it is rounding.
#[test]
fn a_loss_that_is_nothing_beside_the_energy_is_still_a_loss() {
    let light = |scale: f64| {
        crank(0.02)
            .torque(Load::Viscous(1e-2 * scale))
            .start(0.0, 3.0)
    };
    refused(&light(1e-4), None, &["at every speed a cycle loses energy"]);
    for scale in [1e-4, 1e-9, 1e-13] {
        let driven = light(scale).torque(Load::Constant(scale));
        let Estimated { value, error } = steady(&driven).omega_mean_rad_per_s;
        assert!((value - 100.0).abs() <= error, "{scale:e}: {value} {error}");
    }
}
