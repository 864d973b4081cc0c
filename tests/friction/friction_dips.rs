//! Short dips of the normal force of the guide through zero: friction reverses twice within a small part of a step.

use std::f64::consts::PI;

use crate::support::close;
use slider_crank::engine::Motion;
use slider_crank::engine::event_functions;
use slider_crank::engine::event_functions::EventFunction;
use slider_crank::engine::step::{Node, Step};
use slider_crank::numeric::angle::Angle;
use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Every, Friction, Gravity, Rod, Scene, Slider};
use slider_crank::simulate::{Options, Row, Simulation, simulate, simulate_rows};

const R: f64 = 0.05;
const L: f64 = 0.15;
const FLYWHEEL: f64 = 0.004;
const MASS: f64 = 0.6;
const MU: f64 = 0.4;
const G: f64 = 9.81;
const DURATION: f64 = 0.15;

/// Heavy slider on a massless rod, which lifts it off its lower guide for a hundredth of a turn at most.
fn scene(speed: f64) -> Scene {
    let mut scene = Scene::new(R, L)
        .crank(Crank {
            inertia: FLYWHEEL,
            ..Crank::default()
        })
        .rod(Rod::default())
        .slider(Slider { mass: MASS })
        .gravity(Gravity {
            acceleration: G,
            direction: -PI / 2.0,
        })
        .start(0.0, speed)
        .duration(DURATION);
    scene.friction = Some(Friction {
        coefficient: MU,
        static_coefficient: MU,
    });
    scene
}

/// Returns angular acceleration and normal force from the equations of slider and crank, with the force S in the rod: m
/// ẍ = S cos ψ − μ |N| sgn ẋ, N = m g + S sin ψ, J θ̈ = S r sin(θ + ψ), r sin θ = l sin ψ.
fn balances(theta: f64, omega: f64) -> [f64; 2] {
    let (sin, cos) = theta.sin_cos();
    let sin_psi = R * sin / L;
    let cos_psi = (1.0 - sin_psi * sin_psi).sqrt();
    let lever = R * (sin * cos_psi + cos * sin_psi);
    // ẋ = −lever ω / cos ψ; ẍ = dx θ̈ + d2x ω².
    let dx = -lever / cos_psi;
    let dpsi = R * cos / (L * cos_psi);
    let d2x = -R * cos
        - L * cos_psi * dpsi * dpsi
        - L * sin_psi * (dpsi * dpsi * sin_psi / cos_psi - R * sin / (L * cos_psi));
    let solved = |side: f64| {
        let c = -MU * side * (dx * omega).signum();
        // m (dx S lever / J + d2x ω²) = S cos ψ + c (m g + S sin ψ)
        let s = MASS * (c * G - d2x * omega * omega)
            / (MASS * dx * lever / FLYWHEEL - cos_psi - c * sin_psi);
        [s * lever / FLYWHEEL, MASS * G + s * sin_psi]
    };
    let pressed = solved(1.0);
    if pressed[1] >= 0.0 {
        pressed
    } else {
        solved(-1.0)
    }
}

/// Integrates the motion by the classical Runge-Kutta method in equal steps; returns all normal forces as well.
fn in_small_steps(speed: f64, steps: usize) -> ([f64; 2], Vec<f64>) {
    let h = DURATION / steps as f64;
    let (mut theta, mut omega) = (0.0, speed);
    let mut normal = Vec::new();
    for _ in 0..steps {
        let [a1, n] = balances(theta, omega);
        normal.push(n);
        let w2 = omega + 0.5 * h * a1;
        let [a2, _] = balances(theta + 0.5 * h * omega, w2);
        let w3 = omega + 0.5 * h * a2;
        let [a3, _] = balances(theta + 0.5 * h * w2, w3);
        let w4 = omega + h * a3;
        let [a4, _] = balances(theta + h * w3, w4);
        theta += h / 6.0 * (omega + 2.0 * w2 + 2.0 * w3 + w4);
        omega += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    ([theta, omega], normal)
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

/// Returns the angles of rows with a negative normal force, and the least normal force.
fn lifted(scene: &Scene, method: Method) -> (Vec<f64>, f64) {
    let options = Options {
        method,
        reactions: true,
        ..Options::default()
    };
    let mut rows: Vec<Row> = Vec::new();
    let scene = scene.clone().output_every(Every::Angle(2e-4));
    simulate_rows(&scene, &options, &mut rows).expect("rows");
    let guide = |row: &Row| row.reactions.unwrap().guide;
    let at = rows.iter().filter(|row| guide(row) < 0.0);
    let least = rows.iter().map(guide).fold(f64::INFINITY, f64::min);
    (at.map(|row| row.theta).collect(), least)
}

/// Speeds from no dip to a dip of a fiftieth of a radian, 4.09 rad from the start.
const SPEEDS: [f64; 6] = [38.5818, 38.58292, 38.58312, 38.58382, 38.58582, 38.59282];

/// Every method finds the dip, and agrees with small steps, each of which determines the sign of the force anew.
#[test]
fn short_dips_are_found_by_every_method() {
    for (i, speed) in SPEEDS.into_iter().enumerate() {
        let scene = scene(speed);
        let ([theta, omega], normal) = in_small_steps(speed, 150_000);
        let least = normal.into_iter().fold(f64::INFINITY, f64::min);
        assert_eq!(least < 0.0, i > 0, "{speed} {least}");
        for method in [Method::Angle, Method::Time, Method::Dop853] {
            let (lifted_at, lowest) = lifted(&scene, method);
            close("least", lowest, least, 1.0, 2e-6);
            assert_eq!(lifted_at.is_empty(), i == 0, "{method:?} {speed}");
            if let (Some(first), Some(last)) = (lifted_at.first(), lifted_at.last()) {
                assert!(*first > 4.06 && *last < 4.12, "{first} {last}");
            }
            let run = run(&scene, method, 1e-12).summary;
            close("angle", run.last.theta_rad, theta, 1.0, 1e-11);
            close("speed", run.last.omega_rad_per_s, omega, 1.0, 1e-10);
            assert!(
                run.energy_residual.abs() < 1e-11,
                "{:e}",
                run.energy_residual
            );
        }
        let rough = run(&scene, Method::Dopri5, 1e-10).summary;
        let stated = rough.error_estimate.unwrap();
        close("angle", rough.last.theta_rad, theta, 1.0, stated.theta_rad);
    }
}

/// Crank at unit speed.
struct Steady;

impl Motion for Steady {
    fn acceleration(&self, _: f64, _: Angle, _: f64) -> f64 {
        0.0
    }

    fn acceleration_and_power(&self, _: f64, _: Angle, _: f64) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn depends_on_time(&self) -> bool {
        false
    }

    fn has_power(&self) -> bool {
        false
    }

    fn next_corner(&self, _: f64) -> f64 {
        f64::INFINITY
    }
}

/// Function that is zero at both ends of a dip.
struct Dip {
    from: f64,
    length: f64,
}

impl EventFunction<1> for Dip {
    fn values(&self, _: f64, angle: Angle, _: f64) -> [f64; 1] {
        let x = angle.rest - self.from;
        [x * (x - self.length) * (1.0 + 0.3 * (2.0 * x).sin())]
    }

    fn shown_travel(&self, _: Angle) -> f64 {
        f64::INFINITY
    }
}

fn changes(dip: &Dip, sign: f64) -> Vec<f64> {
    let node = |t: f64| Node {
        t,
        theta: t,
        omega: 1.0,
        ..Node::default()
    };
    let mut step = Step::new(0.0, node(0.0), node(1.3));
    let mut signs = [sign];
    let found = event_functions::changes(&mut step, &Steady, dip, false, &mut signs);
    assert_eq!(signs, [1.0]);
    found.into_iter().map(|change| change.t).collect()
}

/// Both ends of a dip are located, wherever it lies between the test points of a step.
#[test]
fn both_ends_of_a_dip_are_located() {
    for i in 0..400 {
        let from = 0.001 + 0.003 * f64::from(i);
        for length in [1e-6, 1e-4, 1e-3, 1e-2, 0.06, 0.09] {
            let found = changes(&Dip { from, length }, 1.0);
            assert_eq!(found.len(), 2, "{from} {length} {found:?}");
            close("begin", found[0], from, 1.0, 1e-9);
            close("end", found[1], from + length, 1.0, 1e-9);
        }
    }
}

/// In a step that begins at the start of a dip, the end of the dip is found however soon it comes.
#[test]
fn a_dip_from_the_start_of_a_step_ends_where_it_does() {
    for length in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.05, 0.2] {
        for from in [-1e-17, 0.0, 1e-17] {
            let found = changes(&Dip { from, length }, -1.0);
            assert_eq!(found.len(), 1, "{length} {found:?}");
            close("end", found[0], length, 1.0, 1e-9);
        }
    }
}
