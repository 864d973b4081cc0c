//! Forces at constant speed against Newton's and Euler's equations of the single bodies.

use std::f64::consts::TAU;

use crate::support::close;
use crate::support::newton::Parts;
use crate::support::random::{case, cases, rotating_crank};
use proptest::prelude::*;
use slider_crank::mechanism::Linkage;
use slider_crank::scene::{Load, Scene, Slider, Variables};
use slider_crank::study::forces;

proptest! {
    #![proptest_config(cases(2000))]

    /// The torque of the answer keeps the speed, and every force is that of the bodies' equations.
    #[test]
    fn each_force_is_that_of_newton_and_euler(case in case(rotating_crank(0.01)), force in -50.0..50.0) {
        prop_assume!(case.omega.abs() > 0.1);
        let scene = Scene {
            torques: vec![Load::Constant(2.0)],
            forces: vec![Load::Constant(force)],
            ..case.scene.clone().constant_speed(0.0, case.omega)
        };
        let row = forces(&scene).unwrap().row(case.theta);
        let parts = Parts::new(&scene, case.theta);
        let (alpha, want) = parts.solve(case.omega, row.torque + 2.0, force);
        let linkage = Linkage::new(&scene.geometry);
        let pose = linkage.pose(case.theta);
        let [m, half_dm, dv] = parts.sizes();
        let size = half_dm * case.omega.powi(2) + dv + 2.0 + force.abs() * linkage.r / pose.cos_phi;
        let inertia = parts.all.iter().map(|part| part.inertia().value()).sum::<f64>();
        close("acceleration", alpha * inertia, 0.0, size + m * alpha.abs(), 1e-13);
        let newton = parts.force_size(case.omega, 0.0, linkage.l) + force.abs() / pose.cos_phi;
        // The rod's axis from crank pin to wrist pin, and the crank's.
        let [ax, ay] = [linkage.s * pose.cos_phi, -pose.sin_phi];
        let [px, py] = want.wrist_pin;
        close("rod axial", row.rod_axial, -(px * ax + py * ay), newton, 1e-12);
        let [cx, cy] = want.crank_pin;
        close("tangential", row.crank_tangential, cy * pose.cos - cx * pose.sin, newton, 1e-12);
        close("radial", row.crank_radial, cx * pose.cos + cy * pose.sin, newton, 1e-12);
        // What d'Alembert's forces add up to is the shaking force.
        let sum = [0, 1].map(|i| row.inertia.crank[i] + row.inertia.rod[i] + if i == 0 { row.inertia.slider } else { 0.0 });
        close("shaking, x", sum[0], want.shaking[0], newton, 1e-12);
        close("shaking, y", sum[1], want.shaking[1], newton, 1e-12);
        let spin = scene.rod.map_or(0.0, |rod| rod.central_inertia()) * linkage.s * pose.d2phi * case.omega.powi(2);
        close("couple of the rod", row.inertia.rod_couple, spin, newton * linkage.l, 1e-12);
    }
}

/// Without an offset the first-order torque differs from the exact one by terms of second order in r/l.
#[test]
fn the_first_order_approaches_the_exact_for_long_rods() {
    for (rod, most) in [(0.4, 2e-2), (4.0, 2e-4)] {
        let scene = Scene::new(0.1, rod)
            .slider(Slider { mass: 2.0 })
            .constant_speed(0.0, 10.0);
        let result = forces(&scene).unwrap();
        for (_, row) in result.rows(0.1) {
            assert!(
                (row.first_order_torque - row.torque).abs() < most * 4.0,
                "{row:?}"
            );
        }
    }
}

#[test]
fn forces_need_a_speed() {
    let said = forces(&Scene::new(0.1, 0.3)).unwrap_err().to_string();
    assert!(said.contains("speed"), "{said}");
}

/// A crank alone is driven by what the load takes: from 0 to -2π N m along the rows of a turn, no more in another one.
#[test]
fn the_largest_torques_are_those_of_the_rows() {
    let load = Load::function(Variables::THETA, |now| now.theta);
    let scene = Scene::new(0.05, 0.15)
        .offset(0.02)
        .torque(load)
        .constant_speed(0.0, 10.0);
    let found = forces(&scene).unwrap();
    let strokes = [found.outward.unwrap(), found.inward.unwrap()];
    let largest = strokes.map(|stroke| stroke.max.value);
    let least = strokes.map(|stroke| stroke.min.value);
    close("largest", largest[0].max(largest[1]), 0.0, 1.0, 1e-15);
    close("least", least[0].min(least[1]), -TAU, TAU, 1e-15);
}
