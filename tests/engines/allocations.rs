//! Allocations do not grow with steps, rows or evaluations of a run: ten times the steps, the same number.

use allocation_counter::measure;
use slider_crank::engine::WorkLimit;
use slider_crank::engine::time::{MotionState, Settings, run};
use slider_crank::engine::{Counted, Motion};
use slider_crank::error::Error;
use slider_crank::numeric::angle::Angle;
use slider_crank::plan::Method;
use slider_crank::scene::{Load, Scene, Variables};
use slider_crank::simulate::{Options, Row, RowSink, simulate_rows};

/// Driven pendulum.
struct Pendulum;

impl Motion for Pendulum {
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        (3.0 * t).cos() - angle.rest.sin() - 0.01 * speed
    }

    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        (self.acceleration(t, angle, speed), speed)
    }

    fn depends_on_time(&self) -> bool {
        true
    }

    fn has_power(&self) -> bool {
        true
    }

    fn next_corner(&self, _: f64) -> f64 {
        f64::INFINITY
    }
}

#[test]
fn steps_take_no_memory() {
    let integrate = |t_end: f64| {
        let settings = Settings {
            method: None,
            tolerance: 1e-10,
            t_end,
            way: f64::INFINITY,
            limit: WorkLimit::NONE,
            work_unit: 1.0,
            guide: &[],
        };
        let start = MotionState {
            t: 0.0,
            angle: Angle::from(0.5),
            speed: 3.0,
        };
        run(&Counted::new(&Pendulum), start, &settings, &mut |_| false).2
    };
    // The first run computes the tableau.
    integrate(1.0);
    let mut steps = 0;
    let info = measure(|| steps = integrate(1000.0));
    assert!(steps > 1000, "{steps}");
    assert_eq!(info.count_total, 0, "{info:?}");
}

/// Sink that counts rows and keeps none.
struct Counter(u64);

impl RowSink for Counter {
    fn row(&mut self, _: &Row) -> Result<(), Error> {
        self.0 += 1;
        Ok(())
    }
}

#[test]
fn a_longer_run_with_rows_takes_no_more_memory() {
    let allocations = |duration: f64| {
        let scene = Scene::duarte()
            .torque(Load::Viscous(0.001))
            .force(Load::function(Variables::T, |now| {
                100.0 * (9.0 * now.t).sin()
            }))
            .duration(duration);
        let options = Options {
            method: Method::Time,
            events_kept: 4,
            ..Options::default()
        };
        let mut rows = Counter(0);
        let info = measure(|| {
            simulate_rows(&scene, &options, &mut rows).unwrap();
        });
        assert_eq!(rows.0, 500);
        info.count_total
    };
    allocations(0.5);
    let (short, long) = (allocations(0.5), allocations(20.0));
    assert!(long <= short + 8, "{short} and {long}");
}

/// Returns the allocations of a run of this many turns by an engine, without estimate and events.
fn of_turns(scene: &Scene, turns: f64, engine: &str) -> u64 {
    let scene = scene.clone().revolutions(turns);
    let options = Options {
        estimate: false,
        events_kept: 0,
        ..Options::default()
    };
    let run = || slider_crank::simulate::simulate(&scene, &options).unwrap();
    assert_eq!(run().summary.engine, engine);
    measure(|| assert!(run().summary.evaluations > 0)).count_total
}

/// Turns over the crank angle: their series are kept in one list with doubling capacity.
#[test]
fn turns_take_no_memory_but_their_place_in_the_list() {
    let scene = Scene::duarte()
        .torque(Load::Constant(1.0))
        .torque(Load::Viscous(0.01));
    let allocations = |turns: f64| of_turns(&scene, turns, "angle");
    let (few, more) = (allocations(5.0), allocations(40.0));
    // 70 panels more: a few lists double a few times.
    assert!(more <= few + 16, "{few} {more}");
    // Many turns follow from the map of one: a million turns take no more than ten thousand.
    let (many, most) = (allocations(1e4), allocations(1e6));
    assert!(most <= many + 16, "{many} {most}");
}

/// Turns of equal work are summed: a hundred times the turns add only a few cells over the energy.
#[test]
fn turns_under_a_constant_torque_take_no_memory_each() {
    let scene = Scene::duarte().torque(Load::Constant(1.0));
    let allocations = |turns: f64| of_turns(&scene, turns, "energy");
    let (many, most) = (allocations(1e4), allocations(1e6));
    assert!(most <= 4 * many, "{many} {most}");
    let (few, half) = (allocations(4e5), allocations(8e5));
    assert!(half <= few + 100, "{few} {half}");
}

/// A run that is handed over and back takes no more for additional turns in between: pieces allocate, turns do not.
#[test]
fn a_hand_over_takes_no_memory_for_the_turns_before_and_after_it() {
    let allocations = |brake: f64| {
        let scene = Scene::duarte()
            .torque(Load::function(Variables::T, move |_| -brake))
            .start(0.3, 100.0)
            .duration(12.0 / brake);
        let options = Options {
            estimate: false,
            events_kept: 3,
            ..Options::default()
        };
        let mut rows = Counter(0);
        let mut run = || simulate_rows(&scene, &options, &mut rows).unwrap().summary;
        let summary = run();
        let engines: Vec<_> = summary.pieces.iter().map(|piece| piece.engine).collect();
        assert_eq!(engines, ["angle", "time", "angle"]);
        assert!(summary.omega_min < -50.0, "{}", summary.omega_min);
        measure(|| assert!(run().evaluations > 0)).count_total
    };
    let (few, more) = (allocations(1.0), allocations(0.25));
    assert!(more <= few + 40, "{few} {more}");
}
