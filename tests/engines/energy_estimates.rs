//! Stated errors of the energy engine: close to rest, in small swings, and truncation of its series.

use std::f64::consts::PI;

use slider_crank::engine::energy::{Orbit, Profile};
use slider_crank::numeric::angle::Angle;
use slider_crank::numeric::chebyshev::Values;
use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Expression, Gravity, Load, Rod, Scene, Slider};
use slider_crank::simulate::{Options, simulate};

/// Scene with its end (rad, rad/s), and the change of the end by half a unit in the last place of lengths, start and
/// duration.
///
/// The ends are by extrapolation of the midpoint rule (Gragg) with 113 bits for the equation of motion in time; orders
/// 20 and 22 agree to 1e-21 or better.
struct Known {
    scene: Scene,
    end: [f64; 2],
    floor: [f64; 2],
}

fn crank(inertia: f64) -> Crank {
    Crank {
        inertia,
        ..Crank::default()
    }
}

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).unwrap())
}

/// Starts with low speed, both of swings and of motions that go far.
fn next_to_rest() -> [Known; 5] {
    let swing = Scene::new(0.05, 0.15)
        .crank(crank(0.02))
        .torque(formula("-2*tan(theta)"))
        .start(1e-5, -1e-7)
        .duration(20.0);
    let below_zero = Scene::new(0.12, 0.14)
        .crank(crank(0.14))
        .slider(Slider { mass: 3.0 })
        .torque(formula("-50*tan(theta)"))
        .start(-6.4e-5, -8e-4)
        .duration(2.1);
    let spring = Scene::new(0.05, 0.13)
        .offset(-0.004)
        .crank(crank(1.5e-3))
        .slider(Slider { mass: 0.4 })
        .force(Load::Spring {
            stiffness: 900.0,
            rest: 0.05,
        })
        .start(3.12, 1e-4)
        .duration(5.0);
    let weight = Scene::new(0.48755120424725873, 0.5194335307420552)
        .crank(crank(295.7922757005398))
        .rod(Rod {
            mass: 912.8470769353961,
            cg: 0.3893813339646251,
            ..Rod::default()
        })
        .slider(Slider {
            mass: 915.110749437205,
        })
        .gravity(Gravity {
            acceleration: 9.81,
            direction: -2.3185558583638834,
        })
        .torque(Load::Constant(-2275.1603381371765))
        .start(6.982168535088714, -5.156673342293408e-5)
        .duration(1.4924024342194682);
    let flywheel = Scene::new(0.31, 0.6)
        .offset(-0.095)
        .crank(Crank {
            mass: 0.48,
            cg: 0.14,
            ..crank(0.11)
        })
        .torque(Load::Constant(0.64))
        .start(-1.26, 6.7e-5)
        .duration(1.7);
    let known = |scene, end, floor| Known { scene, end, floor };
    [
        known(
            swing,
            [4.880609744846782e-6, 8.728101083287174e-5],
            [1.9e-19, 1.1e-18],
        ),
        known(
            below_zero,
            [-1.283158123203165e-5, 0.0014297040818552822],
            [3.4e-19, 1.2e-18],
        ),
        known(
            spring,
            [3.2030834698824682, -1.6619869331396194],
            [4.2e-15, 2.3e-14],
        ),
        known(
            weight,
            [10.837969592166589, -1.2202768220805366],
            [2.3e-15, 7.8e-15],
        ),
        known(
            flywheel,
            [7.147386627272727, 9.890_976_090_909_09],
            [2.4e-15, 1.7e-15],
        ),
    ]
}

#[test]
fn small_swings_and_slow_starts_are_as_exact_as_stated() {
    let options = Options {
        method: Method::Energy,
        ..Options::default()
    };
    for (i, known) in next_to_rest().into_iter().enumerate() {
        let summary = simulate(&known.scene, &options).unwrap().summary;
        let (last, stated) = (summary.last, summary.error_estimate.unwrap());
        let both = [
            (last.theta_rad, stated.theta_rad),
            (last.omega_rad_per_s, stated.omega_rad_per_s),
        ];
        for (k, (found, stated)) in both.into_iter().enumerate() {
            let error = (found - known.end[k]).abs();
            let floor = known.floor[k];
            assert!(error <= 2.0 * stated, "{i} {k}: {error:e} {stated:e}");
            assert!(
                stated <= 20.0 * error.max(floor),
                "{i} {k}: {error:e} {stated:e}"
            );
            // The estimate is also sharp.
            assert!(error <= 4.0 * floor, "{i} {k}: {error:e} {floor:e}");
        }
    }
}

/// Motion with the speed 1 + e cos θ: t = 2/√(1 − e²) arctan(√((1 − e)/(1 + e)) tan θ/2).
struct Ellipse(f64);

impl Ellipse {
    fn speed(&self, theta: f64) -> f64 {
        1.0 + self.0 * theta.cos()
    }

    fn rate(&self) -> f64 {
        (1.0 - self.0 * self.0).sqrt()
    }

    /// Returns the angle at a time after it was zero.
    fn angle(&self, t: f64) -> f64 {
        let half = 0.5 * self.rate() * t;
        let turns = (half / PI).round();
        let tangent = ((1.0 + self.0) / (1.0 - self.0)).sqrt() * (half - turns * PI).tan();
        2.0 * (tangent.atan() + turns * PI)
    }
}

impl Profile for Ellipse {
    fn inertia_and_force(&self, theta: f64) -> (f64, f64) {
        (self.speed(theta).powi(-2), 0.0)
    }

    fn tabulate(&self, angles: &Values) -> [Values; 2] {
        [
            angles.map(|theta| self.inertia_and_force(theta).0),
            angles.map(|theta| self.inertia_and_force(theta).1),
        ]
    }

    fn rounding(&self, _: f64) -> f64 {
        0.0
    }

    fn inertia_rounding(&self, _: f64, _: bool) -> f64 {
        0.0
    }

    fn corners(&self) -> &[f64] {
        &[]
    }

    fn branch_points(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    fn corner_between(&self, _: f64, _: f64) -> Option<f64> {
        None
    }

    fn has_pole(&self, _: f64) -> bool {
        false
    }

    fn is_spent(&self) -> bool {
        false
    }

    fn repeats(&self) -> bool {
        true
    }

    fn work_of_turn(&self) -> Option<(f64, f64)> {
        Some((0.0, 0.0))
    }
}

/// At tolerances far above rounding, the truncation errors of time and speed are stated, inside panels and over many
/// turns.
#[test]
fn the_tails_of_series_are_stated() {
    for e in [0.9, 0.95, 0.98] {
        let motion = Ellipse(e);
        let period = 2.0 * PI / motion.rate();
        for tolerance in [1e-3, 1e-6, 1e-8] {
            let start = Angle::from(0.0);
            let orbit = Orbit::new(&motion, start, 1.0 + e, period, tolerance).unwrap();
            for (first, what) in [(0.0, "first turn"), (1e4, "after many")] {
                let [mut late, mut fast] = [[0.0f64; 2]; 2];
                for i in 1..400 {
                    let t = (first + (f64::from(i) - 0.3) / 400.0) * period;
                    let (angle, speed) = orbit.state(t);
                    let theta = angle.radians();
                    let error = (theta - motion.angle(t)).abs() / speed;
                    late = [late[0].max(error), late[1].max(orbit.time_error(t))];
                    // Error of the speed as a function of the angle; the error of the time is separate.
                    let error = (speed / motion.speed(angle.rest) - 1.0).abs();
                    fast = [fast[0].max(error), fast[1].max(orbit.speed_error(t))];
                }
                for [error, stated] in [late, fast] {
                    let message = format!("{e} {tolerance} {what}: {error:e} {stated:e}");
                    assert!(error <= 2.0 * stated + 1e-14 * (1.0 + first), "{message}");
                    // The following terms alternate, and partly cancel over a turn.
                    assert!(stated <= 600.0 * error + 1e-14 * (1.0 + first), "{message}");
                }
            }
        }
    }
}
