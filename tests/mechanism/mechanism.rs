//! Equation of motion, loads, energies and joint forces, compared with the Newton-Euler equations of the single bodies.

use crate::support::exact::Jet;
use crate::support::newton::Parts;
use crate::support::random::{Case, any_class, case, cases, rotating_crank};
use crate::support::run::{Run, check_reactions};
use crate::support::{close, condition, geometry};
use proptest::prelude::*;
use slider_crank::mechanism::{Equation, Loads, Reactor, Singularity, single};
use slider_crank::scene::{
    Branch, Instant, Interpolation, Load, Scene, Slider, Table, Variable, Variables,
};

fn check_terms(case: &Case, tolerance: f64) {
    let run = Run::new(case);
    let terms = run.terms();
    let got = [terms.m, terms.half_dm, terms.dv];
    let (expected, sizes) = (run.expected_terms(), run.parts.sizes());
    for (i, what) in ["M", "M'/2", "V'"].into_iter().enumerate() {
        close(what, got[i], expected[i], sizes[i], tolerance);
    }
}

fn check_acceleration(case: &Case, tolerance: f64) {
    let run = Run::new(case);
    let (alpha, _) = run.parts.solve(case.omega, run.torque, run.force);
    let m = run.expected_terms()[0];
    close(
        "acceleration",
        run.acceleration(),
        alpha,
        run.size(alpha) / m,
        tolerance,
    );
}

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn the_terms_are_inertia_and_weight_of_the_bodies(case in case(rotating_crank(1e-12))) {
        check_terms(&case, 1e-14);
    }

    #[test]
    fn the_acceleration_is_that_of_newton_and_euler(case in case(rotating_crank(1e-12))) {
        check_acceleration(&case, 1e-14);
    }

    #[test]
    fn terms_and_acceleration_of_rockers_too(case in case(any_class())) {
        let g = &case.scene.geometry;
        prop_assume!((g.offset + g.crank * case.theta.sin()).abs() < g.rod);
        let worse = condition(g, case.theta);
        check_terms(&case, 1e-14 * worse);
        check_acceleration(&case, 1e-14 * worse);
    }

    #[test]
    fn the_joint_forces_are_those_of_newton_and_euler(case in case(rotating_crank(1e-12))) {
        let run = Run::new(&case);
        let (alpha, want) = run.parts.solve(case.omega, run.torque, run.force);
        let g = &case.scene.geometry;
        let reactor = Reactor::new(&case.scene).unwrap();
        let got = reactor.at(&run.equation, case.t, case.theta, case.omega, alpha);
        let size = run.joint_size(alpha);
        check_reactions(&got, &want, size, g.rod + g.crank, 1e-14);

        // The ground force and the external loads change the momentum.
        let weight = run.parts.weight();
        let moment = run.parts.weight_moment();
        let x = run.parts.exact.p[0].value();
        close("sum of forces along x", got.crank_bearing[0] + run.force + weight[0], -got.shaking[0], size, 1e-14);
        close("sum of forces along y", got.crank_bearing[1] + got.guide + weight[1], -got.shaking[1], size, 1e-14);
        close(
            "sum of moments about O",
            run.torque + moment + x * got.guide + g.offset * run.force,
            -got.shaking_moment,
            size * (g.rod + g.crank),
            1e-14,
        );
    }

    #[test]
    fn backward_closes_forward(case in case(rotating_crank(1e-12)), alpha in -1e3..1e3) {
        let run = Run::new(&case);
        let Case { t, theta, omega, .. } = case;
        let (forward, size) = (run.acceleration(), run.size(run.acceleration()));
        let q = run.equation.generalized_force(&run.terms(), omega, forward);
        close("generalized force", q, run.torque + run.force * run.dx, size, 1e-14);
        let load = run.equation.load(t, theta, omega);
        close("load", load.generalized(run.terms().pose.dx), q, size, 1e-14);
        close("torque", load.torque, run.torque, size, 1e-14);
        close("driving torque of free motion", run.equation.driving_torque(t, theta, omega, forward), 0.0, size, 1e-14);

        // For any other motion, Newton's equations with the driving torque must give that motion.
        let driving = run.equation.driving_torque(t, theta, omega, alpha);
        let (turned, _) = run.parts.solve(omega, run.torque + driving, run.force);
        close("driven acceleration", turned, alpha, run.size(alpha) / run.expected_terms()[0], 1e-14);
    }

    #[test]
    fn energy_changes_by_the_power_of_the_loads_without_potential(case in case(rotating_crank(0.3))) {
        let run = Run::new(&case);
        let Case { t, theta, omega, .. } = case;
        let (alpha, power) = run.equation.acceleration_and_power(t, theta, omega);
        prop_assert_eq!(alpha, run.acceleration());
        let spent = case.drive.without_potential(t, theta, omega, run.parts.exact.p[0].value(), run.dx * omega);
        let size = run.size(alpha) * omega.abs() + case.drive.energy_size(&case.scene);
        close("power", power, (spent[0] + spent[1] * run.dx) * omega, size, 1e-14);
        let energy = |theta: f64| {
            run.equation.kinetic_energy(theta, omega) + run.equation.potential_energy(theta)
        };
        let momentum = run.equation.kinetic_energy(theta, omega + 0.5)
            - run.equation.kinetic_energy(theta, omega - 0.5);
        let rate = omega * slope(|h| energy(theta + h), 1e-3) + alpha * momentum;
        close("dE/dt", rate, power, size, 1e-10);
    }

    #[test]
    fn potential_energy_is_the_work_against_gravity_and_the_loads_with_potential(
        case in case(rotating_crank(1e-9)), from in -7.0..7.0,
    ) {
        let run = Run::new(&case);
        let energy = |theta: f64| {
            let parts = Parts::new(&case.scene, theta);
            let weight = parts.all.iter().fold(Jet::from(0.0), |sum, p| sum + p.potential(parts.gravity));
            weight.value() + case.drive.potential(theta, parts.exact.p[0].value())
        };
        let size = case.drive.energy_size(&case.scene) + run.parts.lift_size(&case.scene);
        let rise = run.equation.potential_energy(case.theta) - run.equation.potential_energy(from);
        close("rise of potential energy", rise, energy(case.theta) - energy(from), size, 1e-14);
    }
}

/// Returns the derivative at zero by a sixth-order central difference.
fn slope(f: impl Fn(f64) -> f64, h: f64) -> f64 {
    let odd = |n: f64| f(n * h) - f(-n * h);
    (45.0 * odd(1.0) - 9.0 * odd(2.0) + odd(3.0)) / (60.0 * h)
}

#[test]
fn an_obstacle_says_why_there_is_no_acceleration() {
    let slider_alone = Scene::new(0.1, 0.3).slider(Slider { mass: 1.0 });
    let obstacle = |scene: &Scene, theta: f64| Equation::new(scene).singularity(0.0, theta, 1.0);
    assert_eq!(obstacle(&slider_alone, 0.0), Some(Singularity::NoInertia));
    assert_eq!(obstacle(&slider_alone, 0.1), None);
    let short_rod = Scene {
        geometry: geometry(0.3, 0.1, 0.0, Branch::Right),
        ..slider_alone.clone()
    };
    assert_eq!(obstacle(&short_rod, 0.3), None);
    assert_eq!(obstacle(&short_rod, 0.4), Some(Singularity::Blocked));
    let no_value = Load::function(Variables::THETA, |now| (0.5 - now.theta).sqrt());
    assert_eq!(
        obstacle(&slider_alone.clone().force(no_value.clone()), 0.4),
        None
    );
    assert_eq!(
        obstacle(&slider_alone.clone().force(no_value.clone()), 0.6),
        Some(Singularity::Load)
    );
    let huge = Load::function(Variables::THETA, |_| 1e308);
    let light = Scene::new(0.1, 0.3).slider(Slider { mass: 1e-3 });
    assert_eq!(
        obstacle(&light.torque(huge), 0.1),
        Some(Singularity::TooLarge)
    );
    assert_eq!(
        obstacle(&slider_alone.torque(no_value), 0.6),
        Some(Singularity::Load)
    );
}

#[test]
fn loads_tell_what_they_read_and_whether_they_have_a_potential() {
    let (of_time, motor) = (
        Load::function(Variables::T, |now| now.t),
        Load::Motor {
            stall: 1.0,
            no_load_speed: 5.0,
        },
    );
    let spring = Load::Spring {
        stiffness: 2.0,
        rest: 0.1,
    };
    let empty = || Scene::new(0.1, 0.3);
    for (scene, potential, reads, on_slider) in [
        (empty(), true, Variables::NONE, false),
        (
            empty().torque(Load::Constant(1.0)),
            true,
            Variables::NONE,
            false,
        ),
        (
            empty().force(Load::Constant(1.0)),
            true,
            Variables::NONE,
            true,
        ),
        (empty().force(spring), true, Variables::X, true),
        (
            empty().torque(Load::Viscous(1.0)),
            false,
            Variables::OMEGA,
            false,
        ),
        (empty().torque(motor), false, Variables::OMEGA, false),
        (empty().torque(of_time.clone()), false, Variables::T, false),
        (empty().force(Load::Viscous(1.0)), false, Variables::V, true),
        (empty().force(of_time), false, Variables::T, true),
    ] {
        let loads = Loads::new(&scene);
        let got = (loads.have_potential(), loads.reads, loads.on_slider);
        assert_eq!(
            got,
            (potential, reads, on_slider),
            "{:?} {:?}",
            scene.torques,
            scene.forces
        );
    }
}

#[test]
fn each_kind_of_load_follows_its_formula() {
    let now = Instant {
        t: 2.0,
        theta: 0.25,
        omega: 8.0,
        x: 0.5,
        v: -3.0,
    };
    let table = |of, low, high| {
        Table::new(of, &[0.0, 1.0], &[low, high], Interpolation::Linear, None).unwrap()
    };
    let gas = |towards_crank| Load::Gas {
        pressure: table(Variable::Theta, 1e5, 9e5),
        ambient: 1e5,
        area: 0.01,
        towards_crank,
    };
    let motor = Load::Motor {
        stall: 6.0,
        no_load_speed: 16.0,
    };
    let spring = Load::Spring {
        stiffness: 40.0,
        rest: 0.75,
    };
    for (load, on_slider, value) in [
        (Load::Constant(7.0), false, 7.0),
        (Load::Viscous(0.5), false, -4.0),
        (Load::Viscous(0.5), true, 1.5),
        (motor, false, 3.0),
        (spring, true, 10.0),
        (Load::Table(table(Variable::X, 2.0, 6.0)), false, 4.0),
        (gas(-1.0), true, -2000.0),
        (gas(1.0), true, 2000.0),
        (
            Load::function(Variables::ALL, |now| now.t * now.omega + now.v),
            true,
            13.0,
        ),
    ] {
        let got = single(&load, on_slider, &now);
        assert!(
            (got - value).abs() <= 1e-12 * value.abs(),
            "{load}: {got} instead of {value}"
        );
    }
}
