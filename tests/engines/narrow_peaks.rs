//! Extremes that are narrow, or almost equal to others: speeds of a steady state, driving torques, joint forces.

use std::f64::consts::PI;

use slider_crank::plan::Method;
use slider_crank::scene::{
    Branch, Crank, Expression, Friction, Gravity, Load, Rod, Scene, Slider, Variables,
};
use slider_crank::simulate::{Options, Simulation, SteadyOptions, simulate, steady_state};

fn run(scene: &Scene) -> Simulation {
    let options = Options {
        reactions: true,
        ..Options::default()
    };
    simulate(scene, &options).expect("a run")
}

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).expect("a formula"))
}

#[track_caller]
fn close(got: f64, wanted: f64, relative: f64) {
    let off = (got / wanted - 1.0).abs();
    assert!(off < relative, "{got} for {wanted}");
}

/// The inertia is least at both dead centres: the crank is about as fast at one as at the other.
#[test]
fn the_faster_of_two_almost_equal_places_of_a_turn_is_found() {
    let (mass, cg, rod) = (
        0.362_213_582_755_600_67,
        1.367_804_182_330_326_4,
        1.492_673_204_242_576_5,
    );
    let scene = Scene::new(0.304_490_662_084_761_67, rod)
        .crank(Crank {
            mass: 0.867,
            inertia: 1.718_009_215_189_420_2,
            ..Crank::default()
        })
        .rod(Rod {
            mass,
            cg,
            inertia: mass * cg * (rod - cg),
            ..Rod::default()
        })
        .slider(Slider {
            mass: 0.208_549_150_296_974_3,
        })
        .torque(Load::function(Variables::OMEGA, |now| {
            32.916_466_227_690_71 * (1.0 - now.omega / 56.863_793_613_662_25)
        }))
        .torque(Load::Viscous(0.173_659_533_435_254_9))
        .start(2.760_762_601_304_997_5, 30.327_356_593_953_205);
    let steady = steady_state(&scene, &SteadyOptions::default()).expect("a steady state");
    let options = Options {
        method: Method::Dop853,
        ..Options::default()
    };
    let turn = scene
        .start(steady.theta_rad, steady.omega_rad_per_s.value)
        .revolutions(1.0);
    let turn = simulate(&turn, &options).expect("a turn");
    let states = (0..=100_000).filter_map(|k| turn.at(turn.summary.last.t_s * f64::from(k) * 1e-5));
    let fastest = states.fold(0.0, |fastest: f64, (_, omega)| fastest.max(omega));
    let fast = steady.fastest.omega_rad_per_s;
    // The two speeds differ by 8e-6 rad/s.
    assert!(
        (fast.value - fastest).abs() < 1e-7,
        "{fast:?} for {fastest}"
    );
}

/// One of seven almost equal extremes of a torque is the largest, in the middle between two degrees.
#[test]
fn the_largest_of_almost_equal_torques_is_found() {
    for degrees in [30.5_f64, 100.5, 200.5] {
        // The search has rows at every degree from the angle -1.7 rad.
        let place = degrees.to_radians() - 1.7;
        let torque = move |theta: f64| (7.0 * (theta - place)).cos() + 1e-4 * (theta - place).cos();
        let load = Load::function(Variables::THETA, move |now| torque(now.theta));
        let scene = Scene::new(0.01, 1.0)
            .crank(Crank {
                inertia: 0.01,
                ..Crank::default()
            })
            .torque(load)
            .constant_speed(-2.0, 5.0)
            .revolutions(1.2);
        let range = run(&scene).summary.driving_torque.expect("a range");
        close(range.min_nm, -1.0 - 1e-4, 1e-13);
    }
}

/// A rod hardly longer than the crank: the peak is as wide as the square root of the excess.
#[test]
fn a_run_near_singular_geometry_has_peaks() {
    for excess in [1e-5, 6e-8] {
        let crank = Crank {
            mass: 0.73,
            cg_lateral: 0.0069,
            inertia: 0.003,
            ..Crank::default()
        };
        let scene = Scene::new(0.045, 0.045 * (1.0 + excess))
            .crank(crank)
            .slider(Slider { mass: 1.1 })
            .torque(Load::Viscous(0.0177))
            .torque(Load::function(Variables::T, |now| {
                0.2 + 0.1 * (3.0 * now.t).sin()
            }))
            .start(4.2, 10.0)
            .duration(5.0);
        let options = Options {
            reactions: true,
            method: Method::Time,
            ..Options::default()
        };
        let run = simulate(&scene, &options).expect("a run");
        assert!(run.summary.stopped.is_none());
        let peaks = run.summary.peaks.as_ref();
        let peaks = peaks.unwrap_or_else(|| panic!("{excess}: {:?}", run.summary.warnings));
        let pins = (0..=200_000).filter_map(|k| {
            let [x, y] = run.row(5.0 * f64::from(k) / 2e5)?.reactions?.wrist_pin;
            Some(x.hypot(y))
        });
        let highest = pins.fold(0.0, f64::max);
        let peak = peaks.wrist_pin.value_n;
        assert!(peak >= highest * (1.0 - 1e-9), "{excess}: {peak} {highest}");
    }
}

#[test]
fn a_cycle_that_jams_is_named() {
    let scene = Scene::new(0.4633761676855147, 0.46399620349909326)
        .branch(Branch::Left)
        .crank(Crank {
            inertia: 0.65,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.628 })
        .torque(formula("69.13310413916454 - 0.9506168402945785*omega"))
        .start(2.65, 58.0);
    let scene = Scene {
        friction: Some(Friction {
            coefficient: 0.103,
            static_coefficient: 0.103,
        }),
        gravity: Some(Gravity {
            acceleration: 9.80665,
            direction: -PI / 2.0,
        }),
        ..scene
    };
    let run = simulate(&scene.clone().revolutions(1.0), &Options::default()).expect("a run");
    let stopped = run.summary.stopped.expect("a jam").to_string();
    assert!(stopped.contains("jams"), "{stopped}");
    let said = steady_state(&scene, &SteadyOptions::default()).unwrap_err();
    let said = said.to_string();
    assert!(
        said.contains("jams") && !said.contains("not smooth"),
        "{said}"
    );
}
