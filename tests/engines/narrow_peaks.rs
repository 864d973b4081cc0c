//! Extremes that are narrow, or almost equal to others: speeds of a steady state, driving torques, joint forces.

use std::f64::consts::{PI, TAU};

use slider_crank::plan::Method;
use slider_crank::scene::{
    Branch, Crank, Every, Expression, Friction, Gravity, Interpolation, Load, Rod, Scene, Slider,
    Table, Variable, Variables,
};
use slider_crank::simulate::{Options, Simulation, simulate, simulate_rows, steady_state};

const R: f64 = 0.05;
const L: f64 = 0.15;
const E: f64 = 0.01;
const MASS: f64 = 0.5;

fn run(scene: &Scene) -> Simulation {
    let options = Options {
        reactions: true,
        ..Options::default()
    };
    simulate(scene, &options).expect("a run")
}

/// Crank with an inertia and a slider with a mass, on a rod without.
fn machine() -> Scene {
    Scene::new(R, L)
        .offset(E)
        .crank(Crank {
            inertia: 0.01,
            ..Crank::default()
        })
        .slider(Slider { mass: MASS })
}

/// Inclination of the rod (rad), x' and x'' (m/rad) of the machine, by implicit differentiation of its constraint.
fn pose(theta: f64) -> [f64; 3] {
    let sin_phi = (E + R * theta.sin()) / L;
    let phi = sin_phi.asin();
    let (tan, cos) = (phi.tan(), phi.cos());
    let rate = R * theta.cos() / (L * cos);
    let dx = -R * theta.sin() - R * theta.cos() * tan;
    let d2x = -R * theta.cos() + R * theta.sin() * tan - R * theta.cos() * rate / (cos * cos);
    [phi, dx, d2x]
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
    let steady = steady_state(&scene, None, &Options::default()).expect("a steady state");
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

/// Checks force and torque of a machine that runs for a second at ten radians per second under a pulse on its slider of
/// this half-width (rad) at some angles, with the peak at the first one.
#[track_caller]
fn has_pulse(load: &str, half_width: f64, angles: &[f64]) {
    let (omega, force) = (10.0, 20_000.0);
    let scene = machine()
        .force(formula(load))
        .constant_speed(0.0, omega)
        .duration(1.0);
    let summary = run(&scene).summary;
    let forces = |theta: f64| {
        let [phi, dx, d2x] = pose(theta);
        let inertia = MASS * d2x * omega * omega;
        [(inertia + force) / phi.cos(), dx * (inertia + force)]
    };
    let peaks = summary.peaks.expect("asked for");
    let [mut pin, mut least, mut most] = [0.0f64; 3];
    for angle in angles {
        let [along, about] = forces(*angle);
        pin = pin.max(along);
        (least, most) = (least.min(about), most.max(about));
    }
    for peak in [peaks.wrist_pin, peaks.crank_pin, peaks.crank_bearing] {
        close(peak.value_n, pin, 1e-5);
    }
    let range = summary.driving_torque.expect("asked for");
    match least < 0.0 {
        true => close(range.min_nm, least, 1e-5),
        false => close(range.max_nm, most, 1e-5),
    }
    // Kinetic energy of the slider, and the integral of the pulse.
    let kinetic = |theta: f64| 0.5 * MASS * (pose(theta)[1] * omega).powi(2);
    let pulse = |angle: &f64| force * pose(*angle)[1] * half_width * PI.sqrt();
    let work = kinetic(omega) - kinetic(0.0) + angles.iter().map(pulse).sum::<f64>();
    close(range.mean_nm, work / omega, 1e-5);
}

#[test]
fn narrow_pulses_at_constant_speed_are_found() {
    for width in ["1e-4", "1e-5", "1e-6"] {
        let w: f64 = width.parse().expect("a number");
        let load = format!("-20000*exp(-(sin((theta-1.2)/2)/{width})^2)");
        has_pulse(&load, 2.0 * w, &[1.2, 1.2 + TAU]);
        let load = format!("-20000*exp(-((t-0.503)/{width})^2)");
        has_pulse(&load, 10.0 * w, &[5.03]);
    }
}

#[test]
fn a_row_of_a_table_between_degrees_is_found() {
    let spike = 0.7123;
    let (angles, torques) = (
        [0.0, spike - 1e-3, spike, spike + 1e-3, 3.0],
        [0.0, 0.0, 7.0, 0.0, 0.0],
    );
    let table = Table::new(
        Variable::Theta,
        &angles,
        &torques,
        Interpolation::Linear,
        Some(TAU),
    );
    let table = Load::Table(table.expect("a table"));
    let crank = |load: Load| {
        let scene = Scene::new(R, L).crank(Crank {
            inertia: 0.01,
            ..Crank::default()
        });
        run(&scene.torque(load).constant_speed(0.3, 2.0).revolutions(1.5)).summary
    };
    let range = crank(table.clone()).driving_torque.expect("a range");
    assert!((range.min_nm + 7.0).abs() < 1e-12, "{range:?}");
    // Two triangles of area 7e-3 on one and a half turns.
    close(range.mean_nm, -2.0 * 7e-3 / (1.5 * TAU), 1e-9);
    let pressed = machine().slider(Slider { mass: 0.0 }).force(table);
    for scene in [
        pressed.clone().constant_speed(0.3, 2.0).revolutions(1.0),
        pressed
            .torque(formula("0.001*sin(20*t)"))
            .start(0.3, 2.0)
            .duration(1.0),
    ] {
        let peaks = run(&scene).summary.peaks.expect("asked for");
        close(peaks.wrist_pin.value_n, 7.0 / pose(spike)[0].cos(), 1e-9);
    }
}

/// The rows of the run itself meet the pulse.
#[test]
fn narrow_pulses_in_time_are_found() {
    for width in ["1e-3", "1e-5", "1e-6"] {
        let scene = machine()
            .torque(formula("0.5*sin(20*t)"))
            .force(formula(&format!("-20000*exp(-((t-0.503)/{width})^2)")))
            .start(0.5, 0.5)
            .duration(1.0)
            .output_every(Every::Time(1e-3));
        let options = Options {
            reactions: true,
            ..Options::default()
        };
        let mut rows = Vec::new();
        let run = simulate_rows(&scene, &options, &mut rows).expect("a run");
        let of_row = |row: &slider_crank::simulate::Row| {
            let [x, y] = row.reactions.expect("asked for").wrist_pin;
            x.hypot(y)
        };
        let highest = rows.iter().map(of_row).fold(0.0, f64::max);
        assert!(highest > 15_000.0, "{width}: {highest}");
        let peak = run.summary.peaks.expect("asked for").wrist_pin.value_n;
        assert!(
            peak >= highest * (1.0 - 1e-9) && peak < 1.01 * highest,
            "{width}: {peak} {highest}"
        );
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
    let said = steady_state(&scene, None, &Options::default()).unwrap_err();
    let said = said.to_string();
    assert!(
        said.contains("jams") && !said.contains("not smooth"),
        "{said}"
    );
}
