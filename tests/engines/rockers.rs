//! Mechanisms whose crank cannot turn fully, past their limits: compared with an integration of both angles along the
//! configuration curve, with the speed from the energy.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::support::close;
use slider_crank::mechanism::{Equation, Reactor};
use slider_crank::plan::Method;
use slider_crank::scene::{Branch, Crank, Geometry, Gravity, Load, Rod, Scene, Slider};
use slider_crank::simulate::{Options, Row, simulate, simulate_rows};

/// Crank inertia about O; rod mass, centre of gravity along the rod, and inertia; slider mass; downward gravity.
const BODIES: [f64; 6] = [0.02, 0.8, 0.03, 0.002, 0.5, 9.81];

fn scene(g: &Geometry, theta: f64, omega: f64, duration: f64) -> Scene {
    let [inertia, mass, cg, spin, slider, gravity] = BODIES;
    Scene::new(g.crank, g.rod)
        .offset(g.offset)
        .branch(g.branch)
        .crank(Crank {
            inertia,
            ..Crank::default()
        })
        .rod(Rod {
            mass,
            cg,
            inertia: spin,
            ..Rod::default()
        })
        .slider(Slider { mass: slider })
        .gravity(Gravity {
            acceleration: gravity,
            ..Gravity::standard()
        })
        .start(theta, omega)
        .duration(duration)
}

/// Mechanism described by two angles: that of the crank, and that of the rod below +x.
struct Plane(Geometry);

impl Plane {
    /// Returns the rates of both angles at unit speed along the curve, and twice the kinetic energy.
    fn rates(&self, [theta, rod]: [f64; 2]) -> ([f64; 2], f64) {
        let Geometry {
            crank: r, rod: l, ..
        } = self.0;
        let [inertia, mass, cg, spin, slider, _] = BODIES;
        let (a, b) = (l * rod.cos(), r * theta.cos());
        let n = a.hypot(b);
        let [dtheta, drod] = [a / n, b / n];
        let x = |length: f64| -r * theta.sin() * dtheta - length * rod.sin() * drod;
        let y = |length: f64| r * theta.cos() * dtheta - length * rod.cos() * drod;
        let twice = inertia * dtheta * dtheta
            + mass * (x(cg).powi(2) + y(cg).powi(2))
            + spin * drod * drod
            + slider * x(l).powi(2);
        ([dtheta, drod], twice)
    }

    fn potential(&self, [theta, rod]: [f64; 2]) -> f64 {
        let [_, mass, cg, _, _, gravity] = BODIES;
        mass * gravity * (self.0.crank * theta.sin() - cg * rod.sin())
    }

    fn start(&self, theta: f64) -> [f64; 2] {
        let sine = (self.0.offset + self.0.crank * theta.sin()) / self.0.rod;
        let rod = sine.asin();
        match self.0.branch {
            Branch::Right => [theta, rod],
            Branch::Left => [theta, 2.0 * FRAC_PI_2 - rod],
        }
    }

    /// Integrates both angles over a time by the classical Runge-Kutta method; the motion must not come to rest.
    fn after(&self, theta: f64, omega: f64, time: f64, steps: u32) -> [f64; 2] {
        let mut now = self.start(theta);
        let ([dtheta, _], twice) = self.rates(now);
        let speed = omega / dtheta;
        let energy = 0.5 * twice * speed * speed + self.potential(now);
        let velocity = |at: [f64; 2]| {
            let (rates, twice) = self.rates(at);
            let speed = speed.signum() * (2.0 * (energy - self.potential(at)) / twice).sqrt();
            rates.map(|rate| rate * speed)
        };
        let h = time / f64::from(steps);
        let moved = |at: [f64; 2], k: [f64; 2], h: f64| [at[0] + h * k[0], at[1] + h * k[1]];
        for _ in 0..steps {
            let k1 = velocity(now);
            let k2 = velocity(moved(now, k1, 0.5 * h));
            let k3 = velocity(moved(now, k2, 0.5 * h));
            let k4 = velocity(moved(now, k3, h));
            let mean = |i: usize| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
            now = moved(now, [mean(0), mean(1)], h);
        }
        now
    }

    fn x(&self, [theta, rod]: [f64; 2]) -> f64 {
        self.0.crank * theta.cos() + self.0.rod * rod.cos()
    }
}

/// Returns a crank angle at the middle of the crank pin heights that the rod can reach.
fn middle(g: &Geometry) -> f64 {
    let Geometry {
        crank: r,
        rod: l,
        offset: e,
        ..
    } = *g;
    let height = 0.5 * (f64::max(-l, e - r) + f64::min(l, e + r));
    ((height - e) / r).asin()
}

const SHAPES: [[f64; 3]; 8] = [
    [0.1, 0.08, 0.05],
    [0.1, 0.08, -0.05],
    [0.1, 0.12, 0.07],
    [0.1, 0.12, -0.15],
    [0.1, 0.05, 0.02],
    [0.1, 0.05, -0.02],
    [0.1, 0.05, 0.0],
    [0.1, 0.1, 0.03],
];

#[test]
fn a_rocker_swings_past_its_limits_as_both_angles_say() {
    for [crank, rod, offset] in SHAPES {
        for branch in [Branch::Right, Branch::Left] {
            let middle = middle(&Geometry {
                crank,
                rod,
                offset,
                branch,
            });
            for (theta, omega) in [(middle, 12.0), (TAU / 2.0 - middle, -9.0)] {
                let g = Geometry {
                    crank,
                    rod,
                    offset,
                    branch,
                };
                let plane = Plane(g);
                let want = plane.after(theta, omega, 1.5, 200_000);
                let run = simulate(&scene(&g, theta, omega, 1.5), &Options::default()).unwrap();
                let stated = run.summary.error_estimate.unwrap();
                assert!(stated.theta_rad < 1e-6, "{stated:?}");
                let allowed = stated.theta_rad + 1e-10;
                close("theta", run.summary.last.theta_rad, want[0], 1.0, allowed);
                assert!(run.summary.energy_residual.abs() < 1e-8);
                let mut rows: Vec<Row> = Vec::new();
                simulate_rows(
                    &scene(&g, theta, omega, 1.5),
                    &Options::default(),
                    &mut rows,
                )
                .unwrap();
                let last = rows.last().unwrap();
                close("x", last.x, plane.x(want), 1.0, 20.0 * allowed);
                let flips = rows.windows(2).filter(|w| {
                    let side = |row: &Row| row.x > crank * row.theta.cos();
                    side(&w[0]) != side(&w[1])
                });
                let limits = run
                    .summary
                    .events
                    .iter()
                    .filter(|event| event.kind == "limit");
                assert_eq!(flips.count(), limits.count(), "{g:?}");
                for w in rows.windows(2) {
                    // x and v belong to one motion, also through the limit.
                    let h = w[1].t - w[0].t;
                    let mean = 0.5 * (w[0].v + w[1].v) - h / 12.0 * (w[1].a - w[0].a);
                    close("x follows v", w[1].x - w[0].x, h * mean, 1.0, 3e-7);
                }
            }
        }
    }
}

/// l = r, e = 0: in the smooth motion the rod turns with the crank, x = 2 r cos θ, and slider and crank act as one
/// body: with M = I + 4 m r² sin²θ the time is a quadrature.
#[test]
fn a_change_point_is_crossed_with_continuous_velocities() {
    let (r, inertia, mass, omega) = (0.1, 0.01, 0.7, 15.0);
    let scene = |duration: f64| {
        Scene::new(r, r)
            .crank(Crank {
                inertia,
                ..Crank::default()
            })
            .slider(Slider { mass })
            .start(0.3, omega)
            .duration(duration)
    };
    let m = |theta: f64| inertia + 4.0 * mass * r * r * theta.sin().powi(2);
    // The midpoint rule is exact to rounding over whole periods; 3.5 turns are whole periods of a function of 2θ.
    let count = 4000;
    let turned = 7.0 * FRAC_PI_2 * 2.0;
    let speed = |theta: f64| omega * (m(0.3) / m(theta)).sqrt();
    let time: f64 = (0..count)
        .map(|i| {
            turned
                / f64::from(count)
                / speed(0.3 + turned * (f64::from(i) + 0.5) / f64::from(count))
        })
        .sum();
    let run = simulate(&scene(time), &Options::default()).unwrap();
    let stated = run.summary.error_estimate.unwrap();
    close(
        "theta",
        run.summary.last.theta_rad,
        0.3 + turned,
        1.0,
        stated.theta_rad,
    );
    assert!(stated.theta_rad < 1e-7);
    assert!(
        run.summary
            .warnings
            .iter()
            .any(|w| w.to_string().contains("change point"))
    );
    let mut rows: Vec<Row> = Vec::new();
    simulate_rows(&scene(time), &Options::default(), &mut rows).unwrap();
    for row in rows {
        close("x", row.x, 2.0 * r * row.theta.cos(), 1.0, 1e-14);
        close(
            "energy",
            m(row.theta) * row.omega.powi(2),
            m(0.3) * omega * omega,
            1.0,
            1e-8,
        );
    }
}

/// With an offset the curve crosses itself once a turn: the crank turns twice until the motion repeats.
#[test]
fn the_branch_changes_at_each_passage_of_a_change_point_with_offset() {
    for (offset, rod) in [(0.05, 0.15), (-0.05, 0.15), (0.05, 0.05), (-0.05, 0.05)] {
        for branch in [Branch::Right, Branch::Left] {
            let g = Geometry {
                crank: 0.1,
                rod,
                offset,
                branch,
            };
            // A slightly longer or shorter rod would pass close to the crossing at other times.
            let run = simulate(&scene(&g, middle(&g), 20.0, 0.06), &Options::default()).unwrap();
            let mut rows: Vec<Row> = Vec::new();
            simulate_rows(
                &scene(&g, middle(&g), 20.0, 0.06),
                &Options::default(),
                &mut rows,
            )
            .unwrap();
            for w in rows.windows(2) {
                let h = w[1].t - w[0].t;
                let mean = 0.5 * (w[0].v + w[1].v) - h / 12.0 * (w[1].a - w[0].a);
                close("x follows v", w[1].x - w[0].x, h * mean, 1.0, 1e-9);
                let turn = 0.5 * (w[0].omega + w[1].omega) - h / 12.0 * (w[1].alpha - w[0].alpha);
                close(
                    "theta follows omega",
                    w[1].theta - w[0].theta,
                    h * turn,
                    1.0,
                    1e-8,
                );
            }
            assert!(run.summary.energy_residual.abs() < 1e-9);
            // Until the crossing, both descriptions agree.
            let plane = Plane(g);
            let want = plane.after(middle(&g), 20.0, 0.02, 20_000);
            close("before", run.at(0.02).unwrap().0, want[0], 1.0, 1e-9);
        }
    }
}

/// Forward run, and back again with the speed reversed.
#[test]
fn a_motion_through_limits_can_be_run_back() {
    for [crank, rod, offset] in SHAPES {
        let g = Geometry {
            crank,
            rod,
            offset,
            branch: Branch::Right,
        };
        let theta = middle(&g);
        let there = scene(&g, theta, 12.0, 0.4).force(Load::Spring {
            stiffness: 300.0,
            rest: 0.02,
        });
        let mut rows: Vec<Row> = Vec::new();
        simulate_rows(&there, &Options::default(), &mut rows).unwrap();
        let end = rows.last().unwrap();
        let side = end.x > crank * end.theta.cos();
        let mut back = there.clone().start(end.theta, -end.omega);
        back.geometry.branch = if side { Branch::Right } else { Branch::Left };
        let run = simulate(&back, &Options::default()).unwrap();
        let last = run.summary.last;
        // Whole turns do not matter; the shift keeps a difference just below zero from counting as nearly a turn.
        let off = (last.theta_rad - theta + 1.0).rem_euclid(TAU) - 1.0;
        close("theta", off, 0.0, 1.0, 1e-7);
        close("omega", last.omega_rad_per_s, -12.0, 12.0, 1e-7);
    }
}

/// A rod longer than needed by 1e-6 and 1e-12 crank lengths: the steps do not collapse, and the stated error holds
/// against the energy integral over the crank angle.
#[test]
fn next_to_the_limit_the_steps_do_not_collapse() {
    for margin in [1e-3, 1e-6, 1e-9, 1e-12] {
        for (offset, omega) in [(0.02, 10.0), (-0.02, -10.0), (0.0, 10.0)] {
            let g = Geometry {
                crank: 0.1,
                rod: 0.1 + f64::abs(offset) + 0.1 * margin,
                offset,
                branch: Branch::Right,
            };
            let scene = scene(&g, 0.1, omega, 2.0);
            let energy = simulate(&scene, &Options::default()).unwrap();
            assert_eq!(energy.summary.engine, "energy");
            let options = Options {
                method: Method::Dop853,
                ..Options::default()
            };
            let time = simulate(&scene, &options).unwrap();
            let stated = time.summary.error_estimate.unwrap().theta_rad
                + energy.summary.error_estimate.unwrap().theta_rad;
            let apart = time.summary.last.theta_rad - energy.summary.last.theta_rad;
            assert!(
                apart.abs() < stated,
                "{margin} {offset}: {apart:e}, stated {stated:e}"
            );
            assert!(stated < 1e-5, "{margin} {offset}: {stated:e}");
            assert!(
                time.summary.evaluations < 60_000,
                "{}",
                time.summary.evaluations
            );
        }
    }
}

/// Joint forces along the curve equal those from the crank angle, and are finite at the limits.
#[test]
fn joint_forces_past_a_limit_are_those_of_newton_and_euler() {
    for [crank, rod, offset] in SHAPES {
        let g = Geometry {
            crank,
            rod,
            offset,
            branch: Branch::Left,
        };
        let swinging = scene(&g, middle(&g), 12.0, 0.5).torque(Load::Viscous(1e-3));
        let options = Options {
            method: Method::Time,
            reactions: true,
            ..Options::default()
        };
        let mut rows: Vec<Row> = Vec::new();
        simulate_rows(&swinging, &options, &mut rows).unwrap();
        for row in &rows {
            let got = row.reactions.unwrap();
            assert!(got.guide.is_finite() && got.crank_bearing[0].is_finite());
            let mut there = g;
            there.branch = if row.x > crank * row.theta.cos() {
                Branch::Right
            } else {
                Branch::Left
            };
            let on_branch = Scene {
                geometry: there,
                ..swinging.clone()
            };
            let equation = Equation::new(&on_branch);
            let pose = equation.linkage().pose(row.theta);
            if pose.cos_phi < 0.1 {
                continue;
            }
            let reactor = Reactor::new(&on_branch).unwrap();
            let want = reactor.at(&equation, row.t, row.theta, row.omega, row.alpha);
            let size = 1.0 + want.guide.abs() + want.crank_bearing[0].hypot(want.crank_bearing[1]);
            close("guide", got.guide, want.guide, size, 1e-9);
            for i in 0..2 {
                close(
                    "bearing",
                    got.crank_bearing[i],
                    want.crank_bearing[i],
                    size,
                    1e-9,
                );
                close("crank pin", got.crank_pin[i], want.crank_pin[i], size, 1e-9);
                close("wrist pin", got.wrist_pin[i], want.wrist_pin[i], size, 1e-9);
                close("shaking", got.shaking[i], want.shaking[i], size, 1e-9);
            }
            close(
                "moment",
                got.shaking_moment,
                want.shaking_moment,
                size,
                1e-9,
            );
        }
    }
}
