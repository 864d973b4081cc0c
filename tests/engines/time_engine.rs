//! Stepper in time: its order in theory and by trial, the motion inside a step, events, and its behaviour where there
//! is no motion.

use std::f64::consts::{PI, TAU};

use crate::support::machines::machine;
use proptest::prelude::*;
use slider_crank::engine::WorkLimit;
use slider_crank::engine::collocation::Tableau;
use slider_crank::engine::events::{self, Crossing};
use slider_crank::engine::step::Step;
use slider_crank::engine::time::{Finish, MotionState, Settings, run};
use slider_crank::engine::{Counted, Motion, NODES};
use slider_crank::numeric::angle::Angle;
use slider_crank::plan::Method;
use slider_crank::scene::{
    Branch, Crank, Expression, Gravity, Interpolation, Load, Rod, Scene, Slider, Table, Variable,
    Variables,
};
use slider_crank::simulate::{Options, Simulation, simulate};

/// Rooted tree, given by its branches.
#[derive(Clone, Debug, PartialEq)]
struct Tree(Vec<Tree>);

impl Tree {
    fn order(&self) -> usize {
        1 + self.0.iter().map(Tree::order).sum::<usize>()
    }

    /// Returns γ(t): the order times the γ of the branches.
    fn density(&self) -> f64 {
        self.order() as f64 * self.0.iter().map(Tree::density).product::<f64>()
    }

    /// Φ_i(t) = Π over the branches of Σ_j a_ij Φ_j.
    fn weights(&self, a: &[[f64; NODES]; NODES]) -> [f64; NODES] {
        let mut product = [1.0; NODES];
        for branch in &self.0 {
            let inner = branch.weights(a);
            for (i, value) in product.iter_mut().enumerate() {
                *value *= (0..NODES).map(|j| a[i][j] * inner[j]).sum::<f64>();
            }
        }
        product
    }
}

/// Returns all rooted trees of an order; the branches are ordered by falling rank.
fn trees(order: usize) -> Vec<Tree> {
    fn forests(nodes: usize, largest: (usize, usize), all: &[Vec<Tree>]) -> Vec<Vec<Tree>> {
        if nodes == 0 {
            return vec![Vec::new()];
        }
        let mut found = Vec::new();
        for order in (1..=nodes.min(largest.0)).rev() {
            let ranks = if order == largest.0 {
                largest.1 + 1
            } else {
                all[order].len()
            };
            for rank in 0..ranks {
                for mut rest in forests(nodes - order, (order, rank), all) {
                    rest.push(all[order][rank].clone());
                    found.push(rest);
                }
            }
        }
        found
    }
    let mut all: Vec<Vec<Tree>> = vec![Vec::new()];
    for n in 1..=order {
        let largest = (n - 1, all[n - 1].len().saturating_sub(1));
        let found = forests(n - 1, largest, &all);
        all.push(found.into_iter().map(Tree).collect());
    }
    all.pop().unwrap()
}

fn by_rows(columns: &[[f64; NODES]; NODES]) -> [[f64; NODES]; NODES] {
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

/// Σ b_i Φ_i(t) = 1/γ(t) for every rooted tree (Hairer, Nørsett, Wanner I, section II.2).
#[test]
fn the_order_conditions_hold() {
    let tableau = Tableau::get();
    let a = by_rows(&tableau.speed);
    let known = [1, 1, 2, 4, 9, 20, 48, 115, 286, 719];
    for order in 1..=10 {
        let trees = trees(order);
        assert_eq!(trees.len(), known[order - 1], "trees of order {order}");
        for tree in trees {
            let sum: f64 = tree
                .weights(&a)
                .iter()
                .zip(&tableau.end_speed)
                .map(|(phi, b)| phi * b)
                .sum();
            assert!(
                (sum * tree.density() - 1.0).abs() < 2e-14,
                "{tree:?}: {sum}"
            );
        }
    }
    // Beyond these trees: the quadrature of order 2n, and the collocation conditions of order n, which give order 2n.
    let c = &tableau.nodes;
    for q in 1..=2 * NODES {
        let power = |s: f64| s.powi(q as i32 - 1);
        let sum: f64 = (0..NODES).map(|i| tableau.end_speed[i] * power(c[i])).sum();
        assert!((sum * q as f64 - 1.0).abs() < 1e-13, "{q}: {sum}");
        if q < 2 * NODES {
            let sum: f64 = (0..NODES).map(|i| tableau.end_angle[i] * power(c[i])).sum();
            assert!(
                (sum * (q * (q + 1)) as f64 - 1.0).abs() < 1e-12,
                "{q}: {sum}"
            );
        }
    }
    let twice = by_rows(&tableau.angle);
    for q in 1..=NODES {
        for i in 0..NODES {
            let (mut once_sum, mut twice_sum) = (0.0, 0.0);
            for j in 0..NODES {
                once_sum += a[i][j] * c[j].powi(q as i32 - 1);
                twice_sum += twice[i][j] * c[j].powi(q as i32 - 1);
            }
            let (n, s) = (q as f64, c[i]);
            assert!((once_sum - s.powi(q as i32) / n).abs() < 1e-15, "{q} {i}");
            let expected = s.powi(q as i32 + 1) / (n * (n + 1.0));
            assert!((twice_sum - expected).abs() < 1e-15, "{q} {i}");
        }
    }
}

/// θ̈ given as a function of time, angle and speed, with corners.
struct Made<F: Fn(f64, f64, f64) -> f64> {
    acceleration: F,
    corners: Vec<f64>,
}

fn made<F: Fn(f64, f64, f64) -> f64>(acceleration: F) -> Made<F> {
    Made {
        acceleration,
        corners: Vec::new(),
    }
}

impl<F: Fn(f64, f64, f64) -> f64> Motion for Made<F> {
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        (self.acceleration)(t, angle.radians(), speed)
    }

    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        let acceleration = self.acceleration(t, angle, speed);
        (acceleration, acceleration * speed)
    }

    fn depends_on_time(&self) -> bool {
        true
    }

    fn has_power(&self) -> bool {
        true
    }

    fn next_corner(&self, t: f64) -> f64 {
        let later = self.corners.iter().filter(|corner| **corner > t);
        later.fold(f64::INFINITY, |a, b| a.min(*b))
    }
}

fn settings(tolerance: f64, t_end: f64) -> Settings<'static> {
    Settings {
        method: None,
        tolerance,
        t_end,
        way: f64::INFINITY,
        limit: WorkLimit {
            evaluations: 1_000_000,
            stop: None,
        },
        work_unit: 1.0,
        guide: &[],
    }
}

/// Integrates; returns the steps, the kind of end, and the number of evaluations.
fn steps(
    motion: &dyn Motion,
    start: (f64, f64, f64),
    settings: &Settings,
) -> (Vec<Step>, Finish, u64) {
    let counted = Counted::new(motion);
    let start = MotionState {
        t: start.0,
        angle: Angle::from(start.1),
        speed: start.2,
    };
    let mut steps = Vec::new();
    let (finish, last, count) = run(&counted, start, settings, &mut |step| {
        steps.push(*step);
        false
    });
    assert_eq!(count, steps.len() as u64);
    if let Some(step) = steps.last() {
        assert_eq!(*step, last);
    }
    (steps, finish, counted.evaluations())
}

fn end(steps: &[Step]) -> (f64, f64) {
    let last = steps.last().unwrap();
    (last.angle(last.end.theta).radians(), last.end.omega)
}

/// θ = e^(sin t) solves θ̈ = θ̇²/θ − θ sin t.
fn wave() -> Made<impl Fn(f64, f64, f64) -> f64> {
    made(|t, theta, omega| omega * omega / theta - theta * t.sin())
}

#[test]
fn a_nonlinear_motion_under_a_load_in_time_reaches_its_order() {
    let exact = |t: f64| (t.sin().exp(), t.cos() * t.sin().exp());
    let mut evaluations = Vec::new();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14] {
        let (steps, finish, count) = steps(&wave(), (0.0, 1.0, 1.0), &settings(tolerance, 20.0));
        assert_eq!(finish, Finish::AtEnd);
        let (theta, omega) = end(&steps);
        let (theta_true, omega_true) = exact(20.0);
        assert!(
            (theta - theta_true).abs() < 20.0 * tolerance + 5e-14,
            "{tolerance:e}: {theta}"
        );
        assert!(
            (omega - omega_true).abs() < 20.0 * tolerance + 5e-14,
            "{tolerance:e}: {omega}"
        );
        // The solution inside the steps is tested too.
        for step in &steps {
            for i in 0..=10 {
                let t = step.start.t + step.length() * f64::from(i) / 10.0;
                let (theta, omega) = step.at(t);
                let theta = step.angle(theta).radians();
                let (theta_true, omega_true) = exact(t);
                assert!(
                    (theta - theta_true).abs() < 20.0 * tolerance + 5e-14,
                    "{tolerance:e} {t}"
                );
                assert!(
                    (omega - omega_true).abs() < 20.0 * tolerance + 5e-14,
                    "{tolerance:e} {t}"
                );
            }
            let (a, b) = (step.at(step.start.t), step.at(step.end.t));
            assert_eq!(a, (step.start.theta, step.start.omega));
            assert_eq!(b, (step.end.theta, step.end.omega));
        }
        evaluations.push(count as f64);
    }
    // The degree of the polynomial is NODES + 1: eight more digits take 10^(8/NODES) times the steps.
    let growth = evaluations[4] / evaluations[0];
    assert!(
        growth < 1.5 * 1e8f64.powf(1.0 / NODES as f64),
        "{evaluations:?}"
    );
}

#[test]
fn the_ends_of_steps_of_fixed_length_converge_faster_than_any_order_tested() {
    // One step of length h, with the tolerance ineffective: halving h gains 2^(2n + 1) until rounding.
    let exact = |t: f64| t.sin().exp();
    let error = |h: f64| {
        let motion = Made {
            acceleration: |t: f64, theta: f64, omega: f64| omega * omega / theta - theta * t.sin(),
            corners: vec![h],
        };
        let (steps, _, _) = steps(&motion, (0.0, 1.0, 1.0), &settings(1e-13, h));
        (end(&steps).0 - exact(h)).abs()
    };
    for h in [0.05, 0.1, 0.3, 1.0] {
        assert!(error(h) < 1e-14, "{h}: {:e}", error(h));
    }
}

#[test]
fn a_load_in_time_alone_is_integrated() {
    let motion = made(|t, _, _| t.cos());
    let (steps, _, evaluations) = steps(&motion, (0.0, 0.0, 0.0), &settings(1e-10, 30.0));
    let (theta, omega) = end(&steps);
    assert!((theta - (1.0 - 30f64.cos())).abs() < 1e-12, "{theta}");
    assert!((omega - 30f64.sin()).abs() < 1e-12, "{omega}");
    assert!(evaluations < 1000, "{evaluations}");
    // Work of cos t at speed sin t.
    let work = steps.last().unwrap().end.work;
    assert!((work - 0.5 * 30f64.sin().powi(2)).abs() < 1e-10, "{work}");
}

#[test]
fn many_turns_at_rounding_lose_little() {
    // A harmonic oscillator, unlike a pendulum with small swing around fast rotation, has a closed form.
    let motion = made(|_, theta, _| -theta);
    let (steps, _, _) = steps(&motion, (0.0, 1.0, 0.0), &settings(1e-14, 1000.0 * TAU));
    let (theta, omega) = end(&steps);
    let t: f64 = steps.last().unwrap().end.t;
    // Coefficients rounded to half a unit act like a clock that is off by this amount.
    assert!(
        (theta - t.cos()).abs() < f64::EPSILON * t,
        "{:e}",
        theta - t.cos()
    );
    assert!(
        (omega + t.sin()).abs() < f64::EPSILON * t,
        "{:e}",
        omega + t.sin()
    );
    for step in &steps {
        assert!(step.start.theta.abs() < 2.0 * TAU);
    }
}

#[test]
fn turns_are_taken_off_the_angle_without_a_trace() {
    let motion = made(|_, _, _| 0.0);
    let (steps, _, _) = steps(&motion, (0.0, 0.5, -TAU), &settings(1e-10, 5000.0));
    let last = steps.last().unwrap();
    let angle = last.angle(last.end.theta);
    assert!(angle.rest.abs() <= 2.0 * TAU, "{angle:?}");
    assert!(steps.iter().all(|step| step.start.theta.abs() <= TAU));
    // −TAU as a float is not a whole turn.
    let missing = 5000.0 * 2.4492935982947064e-16;
    let apart = Angle {
        turns: angle.turns + 5000.0,
        rest: angle.rest,
    }
    .radians()
        - 0.5
        - missing;
    assert!(apart.abs() < 2e-15, "{apart:e}");
}

/// Vertical throw: θ = v t − ½ g t².
fn thrown() -> Made<impl Fn(f64, f64, f64) -> f64> {
    made(|_, _, _| -9.81)
}

#[test]
fn an_angle_passed_twice_in_one_step_is_found_twice() {
    let (steps, _, _) = steps(&thrown(), (0.0, 0.0, 4.0), &settings(1e-9, 1.0));
    let top = 4.0 * 4.0 / (2.0 * 9.81);
    let watched = [top - 1e-3];
    let root = (2.0 * 1e-3 / 9.81f64).sqrt();
    let expected = [
        (4.0 / 9.81 - root, Crossing::Angle),
        (4.0 / 9.81, Crossing::Turning),
        (4.0 / 9.81 + root, Crossing::Angle),
    ];
    let mut found = Vec::new();
    let mut in_one_step = 0;
    for step in &steps {
        let mut here = Vec::new();
        events::crossings(step, &watched, &mut here);
        in_one_step = in_one_step.max(here.len());
        found.extend(here);
    }
    assert_eq!(in_one_step, 3, "{} steps", steps.len());
    assert_eq!(found.len(), 3, "{found:?}");
    for ((t, what), (t_true, what_true)) in found.iter().zip(&expected) {
        assert_eq!(what, what_true);
        assert!((t - t_true).abs() < 1e-13, "{t} {t_true}");
    }
}

#[test]
fn a_start_on_an_event_does_not_meet_it_and_a_restart_on_it_does_not_repeat_it() {
    let motion = made(|t, _, _| 0.3 * t.cos());
    let watched = [1.0];
    let crossings_of = |steps: &[Step]| {
        let mut all = Vec::new();
        for step in steps {
            let mut here = Vec::new();
            events::crossings(step, &watched, &mut here);
            all.extend(here);
        }
        all
    };
    let (first, _, _) = steps(&motion, (0.0, 1.0, 2.0), &settings(1e-11, 4.0));
    let met = crossings_of(&first);
    assert_eq!(met.len(), 1, "{met:?}");
    let step = first.iter().find(|step| step.end.t >= met[0].0).unwrap();
    let (theta, omega) = step.at(met[0].0);
    let angle = step.angle(theta);
    assert!((angle.radians() - 1.0 - TAU).abs() < 1e-14);
    let (again, _, _) = steps(
        &motion,
        (met[0].0, angle.radians(), omega),
        &settings(1e-11, 4.0 + met[0].0),
    );
    for (t, _) in crossings_of(&again) {
        assert!(t > met[0].0 + 1.0, "{t} {met:?}");
    }
    assert!(!crossings_of(&again).is_empty());
}

/// Start from rest, under an acceleration that begins at zero.
#[test]
fn a_start_from_rest_is_no_turning_point() {
    for rate in [0.3, 3.0, 38.4] {
        let motion = made(|t, _, _| (rate * t).sin());
        let (steps, _, _) = steps(&motion, (0.0, -1.5, 0.0), &settings(1e-10, 3.0 / rate));
        for step in &steps {
            let mut found = Vec::new();
            events::crossings(step, &[], &mut found);
            assert!(found.is_empty(), "{rate}: {found:?}");
        }
    }
}

#[test]
fn steps_end_at_corners() {
    // θ̈ = |t − 0.7| + step at 1.1
    let motion = Made {
        acceleration: |t: f64, _: f64, _: f64| (t - 0.7).abs() + if t < 1.1 { 0.0 } else { 3.0 },
        corners: vec![0.7, 1.1],
    };
    let (steps, finish, evaluations) = steps(&motion, (0.0, 0.0, 0.0), &settings(1e-12, 2.0));
    assert_eq!(finish, Finish::AtEnd);
    for corner in [0.7, 1.1, 2.0] {
        assert!(steps.iter().any(|step| step.end.t == corner), "{corner}");
    }
    for pair in steps.windows(2) {
        assert_eq!(pair[0].end.t, pair[1].start.t);
    }
    let omega = 0.5 * (0.49 + 1.69) + 3.0 * 0.9;
    assert!((end(&steps).1 - omega).abs() < 1e-13, "{}", end(&steps).1);
    assert!(evaluations < 600, "{evaluations}");
}

#[test]
fn a_jump_that_nobody_told_of_is_passed_by_small_steps() {
    let motion = made(|t, _, _| if t < PI / 5.0 { 1.0 } else { -2.0 });
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let (steps, finish, evaluations) =
            steps(&motion, (0.0, 0.0, 0.0), &settings(tolerance, 1.0));
        assert_eq!(finish, Finish::AtEnd);
        let omega = PI / 5.0 - 2.0 * (1.0 - PI / 5.0);
        let error = (end(&steps).1 - omega).abs();
        assert!(error < 10.0 * tolerance, "{tolerance:e}: {error:e}");
        assert!(evaluations < 4000, "{tolerance:e}: {evaluations}");
    }
}

/// The nodes of the last step lie before a bend close to its end.
#[test]
fn a_bend_just_before_the_end_is_seen() {
    for tolerance in [1e-6, 1e-9, 1e-12] {
        for before in [1e-5, 1e-4, 1e-3, 3e-3, 1e-2] {
            let bend = 1.0 - before;
            let motion = made(|t, _, _| 1e3 * (t - bend).max(0.0));
            let (steps, _, _) = steps(&motion, (0.0, 0.0, 0.0), &settings(tolerance, 1.0));
            let error = (end(&steps).1 - 500.0 * before * before).abs();
            // A bend inside a step costs some tens of tolerances, because its series decays slowly. If unseen, it costs
            // 500 times the square of its distance from the end.
            assert!(
                error < 100.0 * tolerance,
                "{tolerance:e} {before:e}: {error:e}"
            );
        }
    }
}

#[test]
fn a_run_ends_where_the_acceleration_does() {
    let motion = made(|t, _, _| (0.5 - t).sqrt());
    let (steps_to, finish, evaluations) = steps(&motion, (0.0, 0.0, 0.0), &settings(1e-9, 1.0));
    assert_eq!(finish, Finish::StepTooSmall);
    let reached = steps_to.last().unwrap().end.t;
    assert!(reached <= 0.5 && reached > 0.5 - 1e-9, "{reached}");
    assert!(evaluations < 20_000, "{evaluations}");

    let (none, finish, _) = steps(
        &made(|_, _, _| f64::NAN),
        (0.0, 0.0, 0.0),
        &settings(1e-9, 1.0),
    );
    assert!(none.is_empty());
    assert_eq!(finish, Finish::NoStart);

    // θ = −ln(1 − t) tends to infinity at t = 1.
    let motion = made(|_, _, omega| omega * omega);
    let (steps_to, finish, _) = steps(&motion, (0.0, 0.0, 1.0), &settings(1e-9, 2.0));
    assert_ne!(finish, Finish::AtEnd);
    let reached = steps_to.last().unwrap().end.t;
    assert!((reached - 1.0).abs() < 1e-6, "{reached}");
}

#[test]
fn work_has_a_limit_and_time_does_not_run_backwards() {
    let motion = made(|t, theta, _| -1e4 * theta + t);
    let limited = Settings {
        limit: WorkLimit {
            evaluations: 500,
            stop: None,
        },
        ..settings(1e-10, 100.0)
    };
    let (done, finish, evaluations) = steps(&motion, (0.0, 1.0, 0.0), &limited);
    assert_eq!(finish, Finish::WorkLimit);
    assert!(!done.is_empty() && evaluations < 500 + 20 * NODES as u64);
    for t_end in [0.0, -1.0] {
        let (none, finish, _) = steps(&motion, (0.0, 1.0, 0.0), &settings(1e-10, t_end));
        assert!(none.is_empty());
        assert_eq!(finish, Finish::AtEnd);
    }
}

/// ω − cos t decays with rate λ: after the transient the steps follow cos t for any λ (Prothero-Robinson problem).
#[test]
fn a_stiff_loss_takes_few_steps() {
    for rate in [2e3, 2e5, 2e7] {
        let motion = made(move |t, _, omega| -rate * (omega - t.cos()) - t.sin());
        let (steps, finish, evaluations) = steps(&motion, (0.0, 0.0, 5.0), &settings(1e-9, 10.0));
        assert_eq!(finish, Finish::AtEnd);
        let (theta, omega) = end(&steps);
        assert!((omega - 10f64.cos()).abs() < 1e-8, "{rate}: {omega}");
        let exact = 10f64.sin() + 4.0 / rate;
        assert!((theta - exact).abs() < 1e-8, "{rate}: {theta}");
        // An explicit method would take about 10 λ/3 evaluations.
        assert!(evaluations < 100_000, "{rate}: {evaluations}");
    }
}

fn simulated(scene: &Scene, method: Method, tolerance: f64) -> Simulation {
    let options = Options {
        method,
        ..Options::default()
    };
    let result = simulate(&scene.clone().tolerance(tolerance), &options).unwrap();
    assert!(
        result.summary.stopped.is_none(),
        "{:?}",
        result.summary.stopped
    );
    result
}

#[test]
fn formulas_functions_and_tables_over_time_give_the_same_motion() {
    let formula = Load::Expression(Expression::parse("-200 + 300*sin(50*t)").unwrap());
    let function = Load::function(Variables::T, |now| -200.0 + 300.0 * (50.0 * now.t).sin());
    // A load that also reads theta is not a load in time alone.
    let mixed = Load::function(Variables::T.or(Variables::THETA), |now| {
        -200.0 + 300.0 * (50.0 * now.t).sin()
    });
    let results = [formula, function, mixed].map(|load| {
        let scene = Scene::duarte().force(load);
        simulated(&scene, Method::Time, 1e-12)
            .summary
            .last
            .theta_rad
    });
    assert!((results[0] - results[1]).abs() < 1e-12, "{results:?}");
    assert!((results[0] - results[2]).abs() < 1e-12, "{results:?}");
    let table = |kind| {
        let times: Vec<f64> = (0..=20).map(|i| 0.01 * f64::from(i)).collect();
        let forces: Vec<f64> = times.iter().map(|t| 300.0 * (50.0 * t).sin()).collect();
        Table::new(Variable::T, &times, &forces, kind, None).unwrap()
    };
    for kind in [Interpolation::Linear, Interpolation::Pchip] {
        let scene = Scene::duarte()
            .force(Load::Table(table(kind)))
            .duration(0.2);
        let (a, b) = (
            simulated(&scene, Method::Time, 1e-10).summary,
            simulated(&scene, Method::Dop853, 1e-12).summary,
        );
        let apart = (a.last.theta_rad - b.last.theta_rad).abs();
        let stated = a.error_estimate.unwrap().theta_rad + b.error_estimate.unwrap().theta_rad;
        assert!(
            apart <= 2.0 * stated + 1e-13,
            "{kind:?}: {apart:e} {stated:e}"
        );
    }
}

fn driven_mechanism() -> impl Strategy<Value = Scene> {
    let lengths = (0.02..0.2f64, 1.15..5.0f64, -0.9..0.9f64, any::<bool>());
    let masses = (0.05..2.0f64, 0.0..2.0f64, 0.0..2.0f64);
    let loads = (-2.0..2.0f64, 0.0..0.05f64, -40.0..40.0f64, 1.0..60.0f64);
    let start = (
        0.0..TAU,
        prop_oneof![Just(0.0), -60.0..60.0f64],
        0.1..0.6f64,
    );
    (lengths, masses, loads, start).prop_map(|(lengths, masses, loads, start)| {
        let (r, room, offset, left) = lengths;
        let e = offset * r;
        let l = r + e.abs() + (room - 1.0) * r;
        let (crank, rod, slider) = masses;
        let (torque, loss, push, rate) = loads;
        let (angle, speed, duration) = start;
        machine([r, l, e], left, [crank, rod, slider], 0.0)
            .gravity(Gravity::standard())
            .torque(Load::Constant(torque * 20.0 * r))
            .torque(Load::Viscous(loss * r))
            .force(Load::function(Variables::T, move |now| {
                push * (rate * now.t).sin()
            }))
            .start(angle, speed)
            .duration(duration)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, max_shrink_iters: 20, failure_persistence: None, rng_seed: crate::support::seed::seed(7), ..ProptestConfig::default() })]

    #[test]
    fn own_stepper_and_dop853_agree(scene in driven_mechanism()) {
        let library = simulated(&scene, Method::Dop853, 1e-12);
        let (b, eb) = (library.summary.last, library.summary.error_estimate.unwrap());
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let own = simulated(&scene, Method::Time, tolerance);
            let (a, ea) = (own.summary.last, own.summary.error_estimate.unwrap());
            let apart = (a.theta_rad - b.theta_rad).abs();
            let allowed = 2.0 * (ea.theta_rad + eb.theta_rad);
            prop_assert!(apart <= allowed, "{tolerance:e}: {apart:e} {ea:?} {eb:?}");
            let apart = (a.omega_rad_per_s - b.omega_rad_per_s).abs();
            let allowed = 2.0 * (ea.omega_rad_per_s + eb.omega_rad_per_s);
            prop_assert!(apart <= allowed, "{tolerance:e}: {apart:e} {ea:?} {eb:?}");
            prop_assert!(own.summary.energy_residual.abs() < 10.0 * tolerance + 1e-13, "{}", own.summary.energy_residual);
            prop_assert_eq!(own.summary.events.len(), library.summary.events.len(), "{:?} {:?}", own.summary.events, library.summary.events);
        }
    }
}

/// Accelerations of a batch of instants equal those of each instant.
#[test]
fn a_batch_is_what_its_instants_are() {
    use slider_crank::mechanism::{Equation, Instants};
    let scenes = [
        Scene::duarte().torque(Load::Viscous(0.3)),
        Scene::duarte().force(Load::Spring {
            stiffness: 900.0,
            rest: 0.12,
        }),
        // Barely a full turn: near the limit the position needs its other formula.
        Scene::new(0.05, 0.0700001)
            .offset(0.02)
            .branch(Branch::Left)
            .crank(Crank {
                inertia: 1e-3,
                mass: 0.4,
                cg: 0.02,
                cg_lateral: -0.01,
            })
            .rod(Rod {
                mass: 0.3,
                cg: 0.03,
                cg_lateral: 0.004,
                inertia: 2e-4,
                ..Rod::default()
            })
            .slider(Slider { mass: 0.2 })
            .gravity(Gravity::standard()),
        Scene::new(0.05, 0.2).crank(Crank {
            inertia: 1e-3,
            ..Crank::default()
        }),
    ];
    for scene in scenes {
        let scene = scene
            .force(Load::function(Variables::T, |now| 70.0 * now.t))
            .force(Load::function(Variables::V, |now| -3.0 * now.v))
            .torque(Load::Constant(0.7));
        let equation = Equation::new(&scene);
        for k in 0..40 {
            let theta: [f64; 9] = std::array::from_fn(|i| -3.0 + 0.13 * (i + 9 * k) as f64 % 9.0);
            let omega: [f64; 9] = std::array::from_fn(|i| 3.0 - 1.7 * i as f64);
            let t: [f64; 9] = std::array::from_fn(|i| 0.1 * i as f64);
            let (mut alpha, mut power) = ([0.0; 9], [0.0; 9]);
            let of_time = equation.loads().of_times(&t);
            let at = Instants {
                t: &t,
                of_time: &of_time,
                turns: 2.0,
                theta: &theta,
                omega: &omega,
            };
            equation.accelerations(&at, &mut alpha, &mut power);
            for i in 0..9 {
                let angle = Angle {
                    turns: 2.0,
                    rest: theta[i],
                };
                let (a, p) = equation.acceleration_and_power(t[i], angle, omega[i]);
                let slope = {
                    let near = |d: f64| equation.acceleration(t[i], angle.plus(d), omega[i]);
                    (near(1e-7) - near(-1e-7)).abs() / 2e-7
                };
                // Sine and cosine differ in the last place, which amounts to a change of the angle.
                let allowed = 1e-13 * a.abs() + 1e-15 * slope + 1e-12;
                assert!(
                    (alpha[i] - a).abs() <= allowed,
                    "{} {a} at {}",
                    alpha[i],
                    theta[i]
                );
                assert!(
                    (power[i] - p).abs() <= 1e-12 * (1.0 + p.abs()),
                    "{} {p}",
                    power[i]
                );
            }
        }
    }
}

/// A run of one step is far better than a loose tolerance; a second run with the same step would tell nothing.
#[test]
fn a_short_run_at_a_loose_tolerance_is_stated_as_exact_as_it_is() {
    for (i, duration) in [1e-3, 3e-3, 0.01, 0.03, 0.1].into_iter().enumerate() {
        let scene = machine([0.05, 0.12, 0.01], i % 2 == 0, [1.0, 0.5, 0.8], 0.02)
            .gravity(Gravity::standard())
            .start(0.3 + i as f64, 40.0)
            .duration(duration);
        let run = |method: Method, tolerance: f64| {
            let options = Options {
                method,
                ..Options::default()
            };
            let scene = scene.clone().tolerance(tolerance);
            simulate(&scene, &options).unwrap().summary
        };
        let exact = run(Method::Energy, 1e-12).last;
        for tolerance in [0.1, 1e-3, 1e-6] {
            let found = run(Method::Time, tolerance);
            let stated = found.error_estimate.unwrap();
            let both = [
                (found.last.theta_rad, exact.theta_rad, stated.theta_rad),
                (
                    found.last.omega_rad_per_s,
                    exact.omega_rad_per_s,
                    stated.omega_rad_per_s,
                ),
            ];
            for (found, exact, stated) in both {
                let error = (found - exact).abs();
                let floor = 8.0 * f64::EPSILON * exact.abs();
                assert!(
                    error <= 2.0 * stated + floor,
                    "{duration} {tolerance}: {error:e} {stated:e}"
                );
                assert!(
                    stated <= 4.0 * error.max(floor),
                    "{duration} {tolerance}: {error:e} {stated:e}"
                );
            }
        }
    }
}

/// Steps end at the rows of a table at 0 and 180 degrees, which are the dead centres.
#[test]
fn dead_centres_at_the_rows_of_a_table_are_passed_once_in_each_turn() {
    let angles: Vec<f64> = (0..=12).map(|i| f64::from(i) * TAU / 12.0).collect();
    let torques: Vec<f64> = (0..=12)
        .map(|i| [0.3, -0.2, -0.1][i as usize % 3])
        .collect();
    let linear = Interpolation::Linear;
    let table = Table::new(Variable::Theta, &angles, &torques, linear, Some(TAU)).expect("a table");
    for speed in [30.0, -30.0] {
        let scene = Scene::new(0.05, 0.15)
            .crank(Crank {
                inertia: 0.02,
                ..Crank::default()
            })
            .slider(Slider { mass: 0.6 })
            .torque(Load::Table(table.clone()))
            .start(0.3, speed)
            .revolutions(200.0);
        let options = Options {
            method: Method::Time,
            ..Options::default()
        };
        let events = simulate(&scene, &options).expect("a run").summary.events;
        let way = speed.signum();
        let first = if way > 0.0 { PI } else { 0.0 };
        assert_eq!(events.len(), 400);
        for (i, event) in events.iter().enumerate() {
            let expected = first + way * PI * i as f64;
            assert!((event.theta_rad - expected).abs() < 1e-10, "{speed} {i}");
        }
    }
}

/// For θ̈ = cos 30t at t = 3·10⁵ s the rounding of t causes an error of 30 t ε = 2·10⁻⁹, which no shorter step reduces.
#[test]
fn the_rounding_of_late_times_shortens_no_step() {
    let motion = made(|t, _, _| (30.0 * t).cos());
    let late = TAU / 30.0 * 1.5e6;
    let count = |t: f64| {
        steps(&motion, (t, 0.0, 1.0), &settings(1e-13, t + 2.0))
            .0
            .len()
    };
    let (early, late) = (count(0.0), count(late));
    assert!(late <= early + early / 2, "{early} {late}");
}
