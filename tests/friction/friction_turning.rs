//! Coulomb friction of a turning crank, computed over the crank angle: compared with integration in time, with an
//! independent integration of the Newton-Euler equations, with the energy balance and with symmetries.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::support::close;
use crate::support::machines::{self, leaning};
use crate::support::random::{cases, magnitude};
use proptest::prelude::*;
use slider_crank::plan::{Engine, Method, Plan};
use slider_crank::scene::{Branch, Crank, Every, Gravity, Load, Rod, Scene, Slider, Variables};
use slider_crank::simulate::{Options, Row, Simulation, simulate, simulate_rows};

fn rubbing(scene: Scene, coefficient: f64) -> Scene {
    machines::rubbing(scene, coefficient, 1.2 * coefficient)
}

fn run(scene: &Scene, method: Method) -> Simulation {
    let options = Options {
        method,
        ..Options::default()
    };
    simulate(scene, &options).expect("a run")
}

fn in_time(scene: &Scene) -> Simulation {
    let mut scene = scene.clone();
    scene.run.tolerance = 1e-13;
    run(&scene, Method::Time)
}

fn machine(r: f64, l: f64, e: f64, lateral: f64, flywheel: f64) -> Scene {
    Scene::new(r, l)
        .offset(e)
        .crank(Crank {
            mass: 1.0,
            cg: if lateral == 0.0 { 0.0 } else { 0.01 },
            cg_lateral: 0.5 * lateral,
            inertia: flywheel,
        })
        .rod(Rod {
            mass: 0.5,
            cg: 0.06,
            cg_lateral: lateral,
            inertia: 0.001,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.6 })
}

/// Strategy for turning cranks under loads of every kind, with friction far from jamming.
fn turning() -> impl Strategy<Value = Scene> {
    (
        (magnitude(0.02, 0.3), 1.3..5.0, -0.6..0.6, any::<bool>()),
        (
            magnitude(0.03, 2.0),
            magnitude(0.1, 3.0),
            magnitude(0.5, 100.0),
            0.0..1.0,
            -0.2..0.2,
        ),
        (
            0.0..0.5,
            magnitude(3.0, 100.0),
            any::<bool>(),
            -3.0..3.0,
            0.5..10.0,
        ),
        (0..64, 0.0..0.3, 0.0..0.1, 0.3..2.5),
    )
        .prop_map(|(shape, bodies, motion, loads)| {
            let (crank, ratio, offset, left) = shape;
            let (mass, slider, flywheel, along, lateral) = bodies;
            let (mu, speed, backwards, theta, turns) = motion;
            let (which, strong, weak, rate): (i32, f64, f64, f64) = loads;
            let rod = crank * ratio;
            let omega = if backwards { -speed } else { speed };
            let (inertia, force) = (slider * crank * crank, slider * crank * speed * speed);
            let mut scene = Scene::new(crank, rod)
                .offset((rod - crank) * offset)
                .branch(if left { Branch::Left } else { Branch::Right })
                .crank(Crank {
                    inertia: inertia * flywheel,
                    ..Crank::default()
                })
                .rod(Rod {
                    mass,
                    cg: along * rod,
                    cg_lateral: lateral * rod,
                    inertia: 0.1 * mass * rod * rod,
                    ..Rod::default()
                })
                .slider(Slider { mass: slider })
                .start(theta, omega)
                .duration(turns * TAU / speed);
            let has = |bit: i32| which & (1 << bit) != 0;
            if has(0) {
                scene = scene.gravity(Gravity::standard());
            }
            if has(1) {
                scene = scene.force(Load::Spring {
                    stiffness: strong * force / crank,
                    rest: if left { -rod } else { rod },
                });
            }
            if has(2) {
                scene = scene.force(Load::Viscous(weak * slider * speed));
            }
            if has(3) {
                scene = scene.torque(Load::Motor {
                    stall: strong * inertia * speed * omega,
                    no_load_speed: rate * omega,
                });
            }
            if has(4) {
                scene = scene.force(Load::function(Variables::T, move |now| {
                    strong * force * (rate * speed * now.t).sin()
                }));
            }
            if has(5) {
                scene = scene.torque(Load::function(Variables::OMEGA, move |now| {
                    -weak * inertia * now.omega * now.omega.abs()
                }));
            }
            rubbing(scene, mu)
        })
}

/// Runs a scene; returns the guide forces at this spacing of the crank angle, rad, as well.
fn guided(scene: &Scene, spacing: f64) -> (Simulation, Vec<f64>) {
    let options = Options {
        reactions: true,
        ..Options::default()
    };
    let scene = scene.clone().output_every(Every::Angle(spacing));
    let mut rows: Vec<Row> = Vec::new();
    let run = simulate_rows(&scene, &options, &mut rows).expect("a run");
    let forces = rows.iter().map(|row| row.reactions.unwrap().guide);
    (run, forces.collect())
}

/// Returns a scene whose weight is too small by `part` to keep the slider on its lower guide.
fn dipping(scene: Scene, part: f64) -> Option<Scene> {
    let speed = scene.motion.speed.abs();
    let unit = scene.geometry.crank * speed * speed;
    let under = |weight: f64| {
        scene
            .clone()
            .gravity(Gravity {
                acceleration: weight,
                ..Gravity::standard()
            })
            .duration(TAU / speed)
    };
    let pressed = |weight: f64| guided(&under(weight), 0.02).1.iter().all(|n| *n > 0.0);
    let (mut low, mut high) = (0.0, unit);
    if pressed(low) || !pressed(high) {
        return None;
    }
    for _ in 0..16 {
        let middle = 0.5 * (low + high);
        *(if pressed(middle) { &mut high } else { &mut low }) = middle;
    }
    Some(under(high * (1.0 - part)))
}

proptest! {
    #![proptest_config(cases(200))]

    /// The angle and time engines share only the friction law.
    #[test]
    fn angle_and_time_agree_within_what_they_state(scene in turning()) {
        let (over, timed) = (run(&scene, Method::Auto), in_time(&scene));
        let (a, b) = (&over.summary, &timed.summary);
        prop_assume!(b.stopped.is_none() && b.error_estimate.is_some());
        prop_assert_eq!(over.summary.plan.engine, Engine::Angle);
        prop_assert_eq!(&a.stopped, &None);
        let (stated, other) = (a.error_estimate.unwrap(), b.error_estimate.unwrap());
        let apart = (a.last.theta_rad - b.last.theta_rad).abs();
        prop_assert!(apart <= stated.theta_rad + other.theta_rad, "{:e} {:?} {:?}", apart, stated, other);
        prop_assert!(apart < 1e-7 * (1.0 + a.last.theta_rad.abs()), "{:e}", apart);
        prop_assert!(a.energy_residual.abs() < 1e-10, "{:e}", a.energy_residual);
        let kinds = |run: &Simulation| run.summary.events.iter().map(|e| e.kind).collect::<Vec<_>>();
        prop_assert_eq!(kinds(&over), kinds(&timed));
        for (x, y) in a.events.iter().zip(&b.events) {
            close("time of an event", x.t_s, y.t_s, 1.0 + y.t_s, 1e-7);
        }
    }

    /// At the tightest tolerance the work of friction and loads equals the change of the energy, to rounding.
    #[test]
    fn the_energy_balances_to_rounding(scene in turning()) {
        let mut scene = scene;
        scene.run.tolerance = 1e-13;
        let run = run(&scene, Method::Auto);
        prop_assume!(run.summary.pieces.len() == 1);
        prop_assert!(run.summary.energy_residual.abs() < 1e-12, "{:e}", run.summary.energy_residual);
    }
}

proptest! {
    #![proptest_config(cases(100))]

    /// The engines agree also where the normal force dips through zero within a small part of a step.
    #[test]
    fn angle_and_time_agree_where_the_normal_force_dips(scene in turning(), part in magnitude(1e-5, 1e-3)) {
        let scene = dipping(scene, part);
        prop_assume!(scene.is_some());
        let scene = scene.unwrap();
        let (over, forces) = guided(&scene, 1e-3);
        let (lifted, all) = (forces.iter().filter(|n| **n < 0.0).count(), forces.len());
        prop_assume!(over.summary.engine == "angle" && over.summary.stopped.is_none());
        prop_assume!(lifted > 0 && lifted < all / 50);
        for method in [Method::Time, Method::Dop853] {
            let mut scene = scene.clone();
            scene.run.tolerance = 1e-13;
            let timed = run(&scene, method);
            let (a, b) = (&over.summary, &timed.summary);
            let stated = a.error_estimate.unwrap().theta_rad + b.error_estimate.unwrap().theta_rad;
            let apart = (a.last.theta_rad - b.last.theta_rad).abs();
            prop_assert!(apart <= stated, "{:?} {:e} {:e}", method, apart, stated);
        }
    }
}

/// Final states by another program: Newton-Euler equations of the three bodies with all joint forces unknown, friction
/// in the balance of the slider, DOP853 of SciPy at 3e-14 between located sign changes.
#[test]
fn newton_and_euler_integrated_elsewhere_arrive_at_the_same_states() {
    let driven = machine(0.05, 0.15, 0.01, 0.01, 0.002)
        .gravity(Gravity {
            acceleration: 9.81,
            ..Gravity::standard()
        })
        .torque(Load::Constant(1.0))
        .torque(Load::Viscous(0.01))
        .force(Load::Viscous(4.0))
        .force(Load::Spring {
            stiffness: 200.0,
            rest: 0.15,
        })
        .start(0.3, 25.0)
        .duration(1.0);
    let left = machine(0.05, 0.12, -0.03, 0.01, 0.004)
        .branch(Branch::Left)
        .torque(Load::Constant(-0.6))
        .force(Load::function(Variables::T, |now| {
            5.0 * (40.0 * now.t).sin()
        }))
        .start(2.0, -30.0)
        .duration(0.7);
    let coasting = machine(0.05, 0.15, 0.0, 0.0, 0.02)
        .gravity(Gravity {
            acceleration: 9.81,
            ..Gravity::standard()
        })
        .start(0.0, 40.0)
        .duration(1.5);
    for (what, scene, [theta, omega]) in [
        (
            "driven",
            rubbing(driven, 0.3),
            [51.94610379791002, 51.09706532141506],
        ),
        (
            "left",
            rubbing(left, 0.45),
            [-34.54710838319382, -67.35337134424113],
        ),
        (
            "coasting",
            rubbing(coasting, 0.2),
            [55.63277308861252, 34.7184482842365],
        ),
    ] {
        let run = run(&scene, Method::Angle);
        assert_eq!(run.summary.engine, "angle");
        close(what, run.summary.last.theta_rad, theta, 1.0, 1e-10);
        close(what, run.summary.last.omega_rad_per_s, omega, 1.0, 1e-9);
    }
}

/// Where the normal force changes its sign, the start of the panel after it lies on either side by the error of a loose
/// tolerance.
#[test]
fn loose_tolerances_find_the_side_after_a_change_of_the_normal_force() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/duarte-engine.toml");
    let engine = Scene::load(&file)
        .expect("a scene")
        .gravity(Gravity::standard());
    for (speed, mu, viscous) in [
        (60.0, 0.1, 0.03),
        (80.0, 0.2, 0.0),
        (100.0, 0.1, 0.01),
        (130.0, 0.05, 0.0),
        (170.0, 0.1, 0.01),
    ] {
        let mut scene = rubbing(engine.clone(), mu).start(0.0, speed).duration(1.0);
        if viscous > 0.0 {
            scene = scene.torque(Load::Viscous(viscous));
        }
        let theta = in_time(&scene).summary.last.theta_rad;
        for tolerance in [1e-4, 1e-5, 1e-6] {
            let loose = run(&scene.clone().tolerance(tolerance), Method::Angle).summary;
            assert_eq!(loose.engine, "angle");
            let error = (loose.last.theta_rad - theta).abs();
            assert!(
                error < tolerance * theta,
                "{speed} {mu} {tolerance}: {error:e}"
            );
        }
    }
}

/// Acceleration, joint forces and guide force in the rows agree with those of a run in time.
#[test]
fn rows_are_those_of_a_run_in_time() {
    let scene = rubbing(machine(0.05, 0.15, 0.01, 0.01, 0.004), 0.3)
        .gravity(Gravity::standard())
        .torque(Load::Motor {
            stall: 2.0,
            no_load_speed: 60.0,
        })
        .start(0.3, 20.0)
        .duration(0.6);
    let rows = |method: Method| {
        let mut rows: Vec<Row> = Vec::new();
        let options = Options {
            method,
            reactions: true,
            ..Options::default()
        };
        let mut scene = scene.clone();
        scene.run.tolerance = 1e-13;
        simulate_rows(&scene, &options, &mut rows).expect("a run");
        rows
    };
    let (over, timed) = (rows(Method::Angle), rows(Method::Time));
    assert_eq!(over.len(), timed.len());
    for (a, b) in over.iter().zip(&timed) {
        let (f, g) = (a.reactions.unwrap(), b.reactions.unwrap());
        assert_eq!(a.t, b.t);
        close("alpha", a.alpha, b.alpha, 1000.0, 1e-10);
        close("a", a.a, b.a, 100.0, 1e-10);
        close("guide", f.guide, g.guide, 100.0, 1e-10);
        let forces = [
            (f.crank_bearing, g.crank_bearing),
            (f.crank_pin, g.crank_pin),
            (f.wrist_pin, g.wrist_pin),
        ];
        for (p, q) in forces {
            close("x", p[0], q[0], 100.0, 1e-10);
            close("y", p[1], q[1], 100.0, 1e-10);
        }
    }
}

/// The mirror image about the x axis, and the mechanism rotated by half a turn, move alike.
#[test]
fn images_move_as_the_mechanism() {
    let up = |direction: f64| Gravity {
        acceleration: 9.81,
        direction,
    };
    let scene = rubbing(machine(0.05, 0.13, 0.02, 0.01, 0.004), 0.4)
        .gravity(up(-PI / 2.0))
        .torque(Load::Viscous(0.002))
        .start(0.7, 30.0)
        .duration(1.0);
    let here = run(&scene, Method::Angle).summary;
    let mut mirrored = scene.clone();
    mirrored.geometry.offset *= -1.0;
    mirrored.motion.angle *= -1.0;
    mirrored.motion.speed *= -1.0;
    mirrored.gravity = Some(up(PI / 2.0));
    mirrored.crank = scene.crank.map(|c| Crank {
        cg_lateral: -c.cg_lateral,
        ..c
    });
    mirrored.rod = scene.rod.map(|r| Rod {
        cg_lateral: -r.cg_lateral,
        ..r
    });
    let there = run(&mirrored, Method::Angle).summary;
    let allowed = 2.0 * here.error_estimate.unwrap().theta_rad + 1e-13;
    close(
        "mirrored",
        -there.last.theta_rad,
        here.last.theta_rad,
        1.0,
        allowed,
    );
    let mut turned = scene.clone();
    turned.geometry.offset *= -1.0;
    turned.geometry.branch = Branch::Left;
    turned.motion.angle += PI;
    turned.gravity = Some(up(PI / 2.0));
    let there = run(&turned, Method::Angle).summary;
    close(
        "turned",
        there.last.theta_rad - PI,
        here.last.theta_rad,
        1.0,
        10.0 * allowed,
    );
}

/// A coasting crank is handed over close to rest, and comes to rest as in integration in time.
#[test]
fn a_crank_that_coasts_to_rest_is_handed_over() {
    let scene = rubbing(machine(0.05, 0.15, 0.01, 0.01, 0.02), 0.3)
        .gravity(Gravity::standard())
        .start(0.3, 15.0)
        .duration(20.0);
    let (over, timed) = (run(&scene, Method::Auto), in_time(&scene));
    let engines: Vec<_> = over.summary.pieces.iter().map(|p| p.engine).collect();
    assert_eq!(
        (&over.summary.engine[..], &engines[..2]),
        ("angle", &["angle", "time"][..])
    );
    let (a, b) = (&over.summary, &timed.summary);
    let (last, other) = (a.events.last().unwrap(), b.events.last().unwrap());
    assert_eq!((last.kind, other.kind), ("rest", "rest"));
    assert_eq!(a.events_total, b.events_total);
    let allowed = a.error_estimate.unwrap().theta_rad + b.error_estimate.unwrap().theta_rad;
    close("rest", a.last.theta_rad, b.last.theta_rad, 1.0, allowed);
    assert!(allowed < 1e-8, "{allowed:e}");
    close("time of rest", last.t_s, other.t_s, 1.0, 1e-7);
    assert!(a.energy_residual.abs() < 1e-11, "{:e}", a.energy_residual);
    for i in 1..20 {
        let t = f64::from(i);
        let (p, q) = (over.at(t).unwrap(), timed.at(t).unwrap());
        close("angle on the way", p.0, q.0, 1.0, 1e-9);
        close("speed on the way", p.1, q.1, 1.0, 1e-8);
    }
}

/// The plan selects the angle engine for a turning crank, and refuses it where it does not apply.
#[test]
fn the_plan_says_what_serves() {
    let scene = rubbing(machine(0.05, 0.15, 0.01, 0.01, 0.004), 0.3)
        .start(0.3, 20.0)
        .duration(1.0);
    let plan = Plan::new(&scene, Method::Auto).unwrap();
    assert_eq!(plan.engine, Engine::Angle);
    assert!(plan.reason.contains("friction"), "{}", plan.reason);
    assert_eq!(
        Plan::new(&scene, Method::Angle).unwrap().engine,
        Engine::Angle
    );
    let why = Plan::new(&scene, Method::Energy).unwrap_err().to_string();
    assert!(why.contains("friction") && why.contains("speed"), "{why}");
    let at_rest = scene.start(0.3, 0.0);
    assert_eq!(
        Plan::new(&at_rest, Method::Auto).unwrap().engine,
        Engine::Time
    );
    assert!(Plan::new(&at_rest, Method::Angle).is_err());
}

/// A guide that jams at some angle of the turn is left to integration in time, which reports it.
#[test]
fn jamming_is_named() {
    let scene = rubbing(leaning(0.05), 1.5).start(0.3, 6.0);
    let (auto, timed) = (run(&scene, Method::Auto), run(&scene, Method::Time));
    assert!(
        auto.summary.plan.reason.contains("jams"),
        "{}",
        auto.summary.plan.reason
    );
    assert!(
        auto.summary
            .stopped
            .as_ref()
            .unwrap()
            .to_string()
            .contains("jams")
    );
    assert_eq!(auto.summary.stopped, timed.summary.stopped);
    let options = Options {
        method: Method::Angle,
        ..Options::default()
    };
    let why = simulate(&scene, &options).unwrap_err().to_string();
    assert!(why.contains("jams"), "{why}");
}

/// Without a normal force there is no friction.
#[test]
fn without_a_normal_force_there_is_no_friction() {
    let scene = rubbing(Scene::new(0.05, 0.15).offset(0.01), 0.5)
        .crank(Crank {
            inertia: 0.01,
            ..Crank::default()
        })
        .start(0.3, 10.0)
        .duration(1.0);
    let run = run(&scene, Method::Auto);
    assert_eq!(run.summary.engine, "angle");
    close("omega", run.summary.last.omega_rad_per_s, 10.0, 1.0, 1e-13);
}
