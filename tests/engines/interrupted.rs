//! A request to stop ends every engine at that point, and the computed part is kept.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use slider_crank::Stop;
use slider_crank::error::Error;
use slider_crank::plan::Method;
use slider_crank::scene::{
    Clearance, ContactLaw, Crank, Draft, Friction, Instant, Joint, Load, Period, Rod, Scene,
    Slider, Variables,
};
use slider_crank::simulate::{Options, Summary, Why, simulate, simulate_rows, steady_state};
use slider_crank::sweep::{Sweep, SweepOptions};

/// Largest number of evaluations after the request: current panels and steps, and tables of a turn.
const BEYOND: u64 = 5000;

/// Returns a load that requests the stop at one of its evaluations, and counts the evaluations.
fn asking(
    reads: Variables,
    at: u64,
    load: impl Fn(&Instant) -> f64 + Send + Sync + 'static,
) -> (Load, Stop, Arc<AtomicU64>) {
    let (stop, count) = (Stop::default(), Arc::new(AtomicU64::new(0)));
    let (asks, counted) = (stop.clone(), count.clone());
    let load = Load::function(reads, move |now| {
        if counted.fetch_add(1, Ordering::Relaxed) == at {
            asks.request();
        }
        load(now)
    });
    (load, stop, count)
}

fn machine() -> Scene {
    Scene::new(0.05, 0.15)
        .offset(0.01)
        .crank(Crank {
            inertia: 2e-3,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.4 })
        .start(0.3, 20.0)
        .duration(1e4)
}

#[track_caller]
fn interrupted(summary: &Summary, calls: u64, at: u64) {
    let stopped = summary.stopped.as_ref().expect("a reason");
    assert!(matches!(stopped.why, Why::Interrupted), "{stopped}");
    let words = stopped.to_string();
    assert!(words.starts_with("interrupted: stopped at t = "), "{words}");
    assert_eq!(stopped.at.t, summary.last.t_s);
    assert!(summary.last.t_s < 1e4);
    // Over the angle the work of the loads is a separate quadrature over the computed part.
    assert!(calls <= 2 * at + BEYOND, "{calls} calls, asked at {at}");
}

#[test]
fn every_engine_ends_where_it_is_asked() {
    let rubbing = |scene: Scene| Scene {
        friction: Some(Friction {
            coefficient: 0.1,
            static_coefficient: 0.1,
        }),
        ..scene
    };
    let loose = |scene: Scene| Scene {
        rod: Some(Rod {
            mass: 0.3,
            inertia: 1e-3,
            ..Rod::default()
        }),
        clearance: Some(Clearance {
            law: ContactLaw::MasslessLink,
            ..Clearance::new(Joint::CrankPin, 1e-4)
        }),
        ..scene
    };
    let of_speed = |now: &Instant| 0.5 - 0.01 * now.omega;
    let of_time = |now: &Instant| 0.3 * (3.0 * now.t).sin();
    let of_angle = |now: &Instant| 0.3 + 0.1 * (0.3 * now.theta).sin();
    for at in [0, 100, 30_000] {
        for method in [Method::Auto, Method::Time, Method::Dop853] {
            let (load, stop, count) = asking(Variables::OMEGA.or(Variables::T), at, move |now| {
                of_speed(now) + of_time(now)
            });
            run(machine().torque(load), method, stop, (at, &count));
            let (load, stop, count) = asking(Variables::T, at, of_time);
            run(
                rubbing(machine().start(0.3, 0.0).torque(load)),
                method,
                stop,
                (at, &count),
            );
        }
        let (load, stop, count) = asking(Variables::THETA, at, of_angle);
        run(machine().torque(load), Method::Energy, stop, (at, &count));
        let (load, stop, count) = asking(Variables::T, at, of_time);
        run(
            loose(machine().torque(load)),
            Method::Auto,
            stop,
            (at, &count),
        );
    }
}

#[track_caller]
fn run(scene: Scene, method: Method, stop: Stop, (at, count): (u64, &AtomicU64)) {
    let options = Options {
        method,
        stop: Some(stop),
        max_evaluations: u64::MAX,
        ..Options::default()
    };
    let run = simulate(&scene, &options).expect("a run");
    interrupted(&run.summary, count.load(Ordering::Relaxed), at);
    if let Some((theta, omega)) = run.at(run.summary.last.t_s) {
        assert!((theta - run.summary.last.theta_rad).abs() < 1e-6);
        assert!((omega - run.summary.last.omega_rad_per_s).abs() < 1e-6);
    }
}

/// The rows end where the run is stopped.
#[test]
fn rows_end_where_the_run_does() {
    let (load, stop, _) = asking(Variables::OMEGA.or(Variables::T), 20_000, |now| {
        0.5 - 0.01 * now.omega + 0.3 * (3.0 * now.t).sin()
    });
    let scene = machine()
        .torque(load)
        .output_every(slider_crank::scene::Every::Time(0.01));
    let options = Options {
        stop: Some(stop),
        ..Options::default()
    };
    let mut rows = Vec::new();
    let summary = simulate_rows(&scene, &options, &mut rows)
        .expect("a run")
        .summary;
    let last = rows.last().expect("rows").t;
    assert!(
        last <= summary.last.t_s && summary.last.t_s < last + 0.0101,
        "{last}"
    );
}

/// A steady state is found or not; a sweep does not pass on an incomplete design.
#[test]
fn searches_and_sweeps_say_that_they_are_interrupted() {
    let period = Period::turns(1).expect("a period");
    let (load, stop, count) = asking(Variables::THETA.or(Variables::OMEGA), 2000, |now| {
        0.5 + 0.2 * now.theta.sin() - 0.01 * now.omega
    });
    let options = Options {
        stop: Some(stop),
        ..Options::default()
    };
    let found = steady_state(&machine().torque(load.with_period(period)), None, &options);
    assert!(matches!(found, Err(Error::Interrupted)), "{found:?}");
    assert!(count.load(Ordering::Relaxed) < 2000 + BEYOND);

    let stop = Stop::default();
    let mut options = SweepOptions::default();
    options.run.stop = Some(stop.clone());
    let rods = "geometry.rod=150mm:160mm:100000".parse();
    let rods = vec![rods.expect("values")];
    let sweep = Sweep::new(Draft::duarte(), rods.clone(), options).expect("a sweep");
    let plain = Sweep::new(Draft::duarte(), rods, SweepOptions::default());
    assert_eq!(sweep.identity(), plain.expect("a sweep").identity());
    let mut taken = 0;
    let complete = |design: slider_crank::sweep::Design| {
        let motion = design.motion.as_ref();
        motion.is_some_and(|motion| motion.stopped.is_none())
    };
    let end = sweep.map_designs(0..sweep.len(), complete, |designs| {
        assert!(designs.iter().all(|complete| *complete));
        taken += designs.len();
        stop.request();
        Ok(())
    });
    assert!(matches!(end, Err(Error::Interrupted)), "{end:?}");
    assert_eq!(taken, 16);
}
