//! Errors of the rows: a motion attracted to one course is more accurate at its end than before.

use std::f64::consts::TAU;

use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Expression, Friction, Load, Scene, Slider};
use slider_crank::simulate::{Options, Simulation, simulate};

/// Crank held to 30 rad/s, with a gust in between.
fn held(friction: bool) -> Scene {
    let gust = "40*exp(-((t-0.3)/0.02)^2) - 2*(omega-30)";
    let mut scene = Scene::new(0.05, 0.15)
        .offset(0.01)
        .crank(Crank {
            inertia: 0.02,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.6 })
        .torque(Load::Expression(
            Expression::parse(gust).expect("a formula"),
        ))
        .start(0.4, 30.0)
        .duration(1.5);
    if friction {
        scene.friction = Some(Friction {
            coefficient: 0.1,
            static_coefficient: 0.1,
        });
    }
    scene
}

fn run(scene: &Scene, method: Method, tolerance: f64) -> Simulation {
    let mut scene = scene.clone();
    scene.run.tolerance = tolerance;
    let options = Options {
        method,
        ..Options::default()
    };
    simulate(&scene, &options).expect("a run")
}

#[test]
fn the_worst_error_on_the_way_is_stated() {
    for friction in [false, true] {
        let scene = held(friction);
        let best = run(&scene, Method::Time, 1e-14);
        for method in [Method::Dop853, Method::Dopri5] {
            let rough = run(&scene, method, 1e-5);
            let end = rough.summary.error_estimate.expect("an estimate");
            let rows = rough.summary.rows_error.expect("an estimate on the way");
            let off = |t: f64| {
                let [a, b] = [&rough, &best].map(|run| run.row(t).expect("a row"));
                [a.theta - b.theta, a.omega - b.omega].map(f64::abs)
            };
            let times = (0..1500).map(|i| 1e-3 * f64::from(i));
            let worst = times.map(off).fold([0.0f64; 2], |worst, off| {
                [worst[0].max(off[0]), worst[1].max(off[1])]
            });
            // Between the ends of steps the motion is less accurate.
            assert!(
                worst[0] <= 2.0 * rows.theta_rad,
                "{method}: {worst:?}, {rows:?}"
            );
            assert!(
                worst[1] <= 3.0 * rows.omega_rad_per_s,
                "{method}: {worst:?}, {rows:?}"
            );
            assert!(
                rows.omega_rad_per_s <= 5.0 * worst[1],
                "{method}: {worst:?}, {rows:?}"
            );
            assert!(rows.theta_rad > 2.0 * end.theta_rad, "{rows:?}, {end:?}");
        }
        let turns = best.summary.last.theta_rad / TAU;
        assert!(turns > 7.0, "{turns}");
    }
}
