//! Long motions whose turns gain equal work: compared with the sum over all single turns, by an independent quadrature.

#[allow(dead_code, reason = "shared with other tests")]
use std::f64::consts::{PI, TAU};

use crate::energy_integral::{EnergyIntegral, fejer};
use crate::support::machines::machine;
use proptest::prelude::*;
use slider_crank::plan::Method;
use slider_crank::scene::{Gravity, Load, Period, Scene, Variables};
use slider_crank::simulate::{Options, Simulation, simulate};

/// Torque over the crank angle, and its integral from zero.
#[derive(Clone, Copy, Debug)]
struct Torque {
    mean: f64,
    swing: f64,
}

impl Torque {
    fn value(self, theta: f64) -> f64 {
        self.mean + self.swing * (2.0 * theta + 0.3).cos()
    }

    fn work(self, from: f64, to: f64) -> f64 {
        let primitive = |theta: f64| 0.5 * self.swing * (2.0 * theta + 0.3).sin();
        self.mean * (to - from) + (primitive(to) - primitive(from))
    }
}

/// Inertia, work since the start of the turn, and weight at the nodes of one turn.
struct EveryTurn {
    nodes: Vec<(f64, f64, f64)>,
    kinetic: f64,
    gain: f64,
}

impl EveryTurn {
    fn new(scene: &Scene, torque: Torque) -> EveryTurn {
        const PANELS: u32 = 24;
        let integral = EnergyIntegral::new(scene);
        let start = scene.motion.angle;
        let step = TAU.copysign(scene.motion.speed) / f64::from(PANELS);
        let (m0, v0) = integral.m_and_v(start);
        let rule = fejer(32);
        let mut nodes = Vec::new();
        for panel in 0..PANELS {
            for (x, weight) in &rule {
                let theta = start + step * (f64::from(panel) + 0.5 * (1.0 + x));
                let (m, v) = integral.m_and_v(theta);
                let work = torque.work(start, theta) - (v - v0);
                nodes.push((m, work, 0.5 * step.abs() * weight));
            }
        }
        EveryTurn {
            nodes,
            kinetic: 0.5 * m0 * scene.motion.speed.powi(2),
            gain: TAU.copysign(scene.motion.speed) * torque.mean,
        }
    }

    /// Returns the time of the turn after this many turns, s; none if the crank comes so close to rest that the panels
    /// are too coarse.
    fn time(&self, turns: u32) -> Option<f64> {
        let kinetic = self.kinetic + f64::from(turns) * self.gain;
        let mut sum = 0.0;
        for (m, work, weight) in &self.nodes {
            let here = kinetic + work;
            if here <= 0.02 * self.kinetic {
                return None;
            }
            sum += weight * (0.5 * m / here).sqrt();
        }
        Some(sum)
    }

    /// Returns the time (s) until this many turns are complete, or until the last one that is, and their number.
    fn until(&self, turns: u32) -> (u32, f64) {
        let (mut sum, mut lost) = (0.0, 0.0);
        for turn in 0..turns {
            let Some(time) = self.time(turn) else {
                return (turn, sum + lost);
            };
            let next: f64 = sum + time;
            lost += (sum - next) + time;
            sum = next;
        }
        (turns, sum + lost)
    }
}

fn mechanism() -> impl Strategy<Value = (Scene, Torque)> {
    let lengths = (0.02..0.2f64, 0.3..2.0f64, -0.9..0.9f64, prop::bool::ANY);
    let masses = (0.3..3.0f64, 0.1..2.0f64, 0.1..2.0f64, -0.1..0.1f64);
    let motion = (0.0..TAU, 0.8..2.0f64, prop::bool::ANY, -PI..PI);
    // Work of a turn, and its swing, relative to the kinetic energy.
    let torque = (-4.0..-0.5f64, prop::bool::ANY, -0.05..0.05f64);
    (lengths, masses, motion, torque).prop_map(|(lengths, masses, motion, torque)| {
        let (r, longer, offset, left) = lengths;
        let e = offset * r;
        let l = r + e.abs() + longer * r;
        let (crank, rod, slider, aside) = masses;
        let (angle, exponent, clockwise, direction) = motion;
        let speed = 10f64.powf(exponent) * if clockwise { -1.0 } else { 1.0 };
        let energy = 0.5 * crank * (r * speed).powi(2);
        let (work, brakes, swing) = torque;
        let mean = 10f64.powf(work) * energy / TAU * if brakes { -1.0 } else { 1.0 };
        let scene = machine([r, l, e], left, [crank, rod, slider], aside)
            .gravity(Gravity {
                acceleration: 0.02 * r * speed * speed,
                direction,
            })
            .start(angle, speed);
        let torque = Torque {
            mean: mean.copysign(if brakes { -speed } else { speed }),
            swing: swing * energy,
        };
        (scene, torque)
    })
}

fn loaded(scene: &Scene, torque: Torque) -> Scene {
    let over_theta = move |now: &slider_crank::scene::Instant| torque.value(now.theta);
    scene
        .clone()
        .torque(Load::function(Variables::THETA, over_theta).with_period(Period::TURN))
}

fn by_energy(scene: &Scene) -> Simulation {
    let options = Options {
        method: Method::Energy,
        events_kept: 10,
        ..Options::default()
    };
    simulate(scene, &options).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, max_shrink_iters: 20, failure_persistence: None, rng_seed: crate::support::seed::seed(11), ..ProptestConfig::default() })]

    #[test]
    fn turns_add_up_as_if_each_were_computed((scene, torque) in mechanism(), most in 40..2000u32) {
        let every = EveryTurn::new(&scene, torque);
        let (turns, end) = every.until(most);
        prop_assume!(turns > 20);
        let direction = scene.motion.speed.signum();
        let run = by_energy(&loaded(&scene, torque).duration(end));
        prop_assert_eq!(&run.summary.stopped, &None);
        let last = run.summary.last;
        let stated = run.summary.error_estimate.unwrap();
        let truth = scene.motion.angle + direction * TAU * f64::from(turns);
        // The sum over all turns has rounding errors itself, about that of its end.
        let rounding = 4.0 * f64::EPSILON * (truth.abs() + (last.omega_rad_per_s * end).abs());
        let error = (last.theta_rad - truth).abs();
        prop_assert!(error <= 2.0 * stated.theta_rad + rounding, "{error:e} {stated:?}");
        let m0 = EnergyIntegral::new(&scene).m_and_v(scene.motion.angle).0;
        let kinetic = every.kinetic + f64::from(turns) * every.gain;
        // Unless the crank slows down, which amplifies errors of its energy, the stated error is rounding alone.
        if kinetic > 0.7 * every.kinetic {
            prop_assert!(stated.theta_rad <= 10.0 * rounding, "{stated:?} {rounding:e}");
        }
        let speed = direction * (2.0 * kinetic / m0).sqrt();
        let error = (last.omega_rad_per_s - speed).abs();
        prop_assert!(error <= 2.0 * stated.omega_rad_per_s + 1e-14 * speed.abs(), "{error:e} {stated:?}");
        // Intermediate states agree with shorter sums, in early and in late turns.
        for part in [7, turns / 3, turns / 2, turns - 2] {
            let (_, t) = every.until(part);
            let (theta, _) = run.at(t).unwrap();
            let truth = scene.motion.angle + direction * TAU * f64::from(part);
            prop_assert!((theta - truth).abs() <= 2.0 * stated.theta_rad + rounding, "{part}");
        }
        // The end by number of turns.
        let run = by_energy(&loaded(&scene, torque).revolutions(f64::from(turns - 1)));
        let (_, t) = every.until(turns - 1);
        let slowest = run.summary.omega_min.abs().min(run.summary.omega_max.abs());
        let late = 2.0 * stated.theta_rad / slowest + 4.0 * f64::EPSILON * t;
        prop_assert!((run.summary.last.t_s - t).abs() <= late);
    }
}

#[test]
fn a_constant_torque_over_millions_of_turns_is_right_to_rounding() {
    // Reference: all turns summed in 19 digits (x87), 24 Gauss nodes on each quarter; torque, duration, angle and
    // speed.
    let references = [
        (2.0, 10.0, 4334.207178463392, 755.2638870700546),
        (-0.02, 100.0, 6486.554075103779, 31.30441631516967),
        (0.01, 1000.0, 265896.257830675, 429.9175135642076),
        (-1e-4, 5000.0, 449973.5594958872, 82.96696218711344),
        (2.0, 1000.0, 33603416.10804506, 65933.02815536688),
    ];
    for (torque, duration, theta, omega) in references {
        let scene = Scene::duarte()
            .torque(Load::Constant(torque))
            .duration(duration);
        let run = by_energy(&scene);
        let stated = run.summary.error_estimate.unwrap();
        let last = run.summary.last;
        let error = (last.theta_rad - theta).abs();
        let delay = f64::EPSILON * omega * duration;
        assert!(
            error <= 2.0 * stated.theta_rad,
            "{torque}: {error:e} {stated:?}"
        );
        assert!(error <= 8.0 * delay, "{torque}: {error:e} {delay:e}");
        let error = (last.omega_rad_per_s - omega).abs();
        assert!(
            error <= 2.0 * stated.omega_rad_per_s,
            "{torque}: omega {error:e} {stated:?}"
        );
        assert!(run.summary.energy_residual.abs() < 1e-14);
    }
}

#[test]
fn the_cost_hardly_grows_with_the_turns() {
    let evaluations = |duration: f64| {
        let scene = Scene::duarte()
            .torque(Load::Constant(2.0))
            .duration(duration);
        by_energy(&scene).summary.evaluations
    };
    let (few, most) = (evaluations(10.0), evaluations(3000.0));
    assert!(most <= 3 * few, "{few} {most}");
    // The turn does no net work, which the load does not declare.
    let torque = Torque {
        mean: 0.0,
        swing: 3.0,
    };
    let evaluations = |duration: f64| {
        let scene = loaded(&Scene::duarte(), torque).duration(duration);
        by_energy(&scene).summary.evaluations
    };
    let (few, most) = (evaluations(10.0), evaluations(1e4));
    assert!(most <= few + few / 2, "{few} {most}");
}

#[test]
fn loads_that_differ_from_turn_to_turn_are_not_taken_for_alike() {
    let scene = Scene::duarte()
        .torque(Load::function(Variables::THETA, |now| {
            1.5 + 2.0 * (0.5 * now.theta).sin()
        }))
        .duration(9.0)
        .tolerance(1e-11);
    let run = by_energy(&scene);
    assert!(run.summary.revolutions > 300.0);
    let options = Options {
        method: Method::Time,
        ..Options::default()
    };
    let time = simulate(&scene, &options).unwrap();
    let apart = (run.summary.last.theta_rad - time.summary.last.theta_rad).abs();
    let stated = [&run, &time].map(|run| run.summary.error_estimate.unwrap().theta_rad);
    assert!(
        apart <= 2.0 * (stated[0] + stated[1]),
        "{apart:e} {stated:?}"
    );
}
