//! Forces at constant speed compared with the Newton-Euler equations of the single bodies.

use std::f64::consts::TAU;

use crate::support::close;
use crate::support::newton::Parts;
use crate::support::random::{case, cases, rotating_crank};
use proptest::prelude::*;
use slider_crank::kinematics::forces;
use slider_crank::mechanism::Linkage;
use slider_crank::scene::{Interpolation, Load, Scene, Slider, Table, Variable, Variables};

proptest! {
    #![proptest_config(cases(2000))]

    /// The computed torque keeps the speed constant, and every force agrees with the equations of the bodies.
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
        // Axis of the rod from crank pin to wrist pin, and below that of the crank.
        let [ax, ay] = [linkage.s * pose.cos_phi, -pose.sin_phi];
        let [px, py] = want.wrist_pin;
        close("rod axial", row.rod_axial, -(px * ax + py * ay), newton, 1e-12);
        let [cx, cy] = want.crank_pin;
        close("tangential", row.crank_tangential, cy * pose.cos - cx * pose.sin, newton, 1e-12);
        close("radial", row.crank_radial, cx * pose.cos + cy * pose.sin, newton, 1e-12);
        // The d'Alembert forces sum to the shaking force.
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
        for row in (0..63).map(|k| result.row(0.1 * f64::from(k))) {
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

/// A crank alone is driven by the torque that its load takes: from 0 to -2π N m over the first turn, which alone
/// counts.
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

/// The driving torque of a light crank is that of a table over two turns: from -200 N m at 23.2 deg to 300 N m at 500
/// deg.
#[test]
fn the_largest_torques_are_those_of_all_turns_of_the_cycle() {
    let rows = [
        (0.0, 0.0),
        (21.7, 0.0),
        (23.2, 200.0),
        (24.7, 0.0),
        (498.0, 0.0),
        (500.0, -300.0),
        (502.0, 0.0),
    ];
    let angles = rows.map(|row: (f64, f64)| row.0.to_radians());
    let values = rows.map(|row| row.1);
    let table = Table::new(
        Variable::Theta,
        &angles,
        &values,
        Interpolation::Linear,
        Some(2.0 * TAU),
    );
    let scene = Scene::new(0.05, 0.15)
        .torque(Load::Table(table.unwrap()))
        .constant_speed(0.0, 10.0);
    let found = forces(&scene).unwrap();
    assert_eq!(found.cycle_turns, 2);
    // 500 deg is 140 deg in the second turn, on the inward stroke in this sense of rotation.
    let inward = found.inward.unwrap();
    close("largest", inward.max.value, 300.0, 300.0, 1e-12);
    close(
        "its angle",
        inward.max.theta_rad,
        500f64.to_radians(),
        1.0,
        1e-9,
    );
    close("least", inward.min.value, -200.0, 200.0, 1e-12);
    close(
        "its angle",
        inward.min.theta_rad,
        23.2f64.to_radians(),
        1.0,
        1e-9,
    );
}

/// A slider alone on a rod that is hardly longer than the crank: the torque m x' x'' ω² has peaks as narrow as the root
/// of the gap beside 90 and 270 degrees. The extremes are those of dense rows there, from the closed form.
#[test]
fn narrow_peaks_of_the_torque_are_found() {
    let (r, mass, speed) = (0.05, 0.5, 10.0);
    for (gap, offset) in [(1e-3, 0.0), (1e-5, 0.0), (1e-8, 0.0), (1e-6, 0.01)] {
        let l = r + offset + gap * r;
        let scene = Scene::new(r, l)
            .offset(offset)
            .slider(Slider { mass })
            .constant_speed(0.0, speed);
        let found = forces(&scene).unwrap();
        // The lift is u = e ± r cos(d), d from 90 or 270 degrees, and W² = (l − u)(l + u), without cancellation.
        let torque = |side: f64, d: f64| {
            let (sin, cos) = (side * d.cos(), -side * d.sin());
            let u = offset + r * sin;
            let short = side * 2.0 * r * (0.5 * d).sin().powi(2);
            let [below, above] = [l - offset - side * r + short, l + offset + side * r - short];
            let w = (below * above).sqrt();
            let dw = -u * r * cos / w;
            let d2w = (-(r * cos).powi(2) + u * r * sin - dw * dw) / w;
            mass * (-r * sin + dw) * (-r * cos + d2w) * speed * speed
        };
        // Angles from 1e-7 to 1 rad on either side, dense by their logarithms.
        let logarithms = (0..=1_000_000).map(|i| 1e-7 * 1e7f64.powf(f64::from(i) / 1e6));
        let places = logarithms.flat_map(|d| [[1.0, d], [1.0, -d], [-1.0, d], [-1.0, -d]]);
        let both = places.map(|[side, d]| torque(side, d));
        let (least, most) = both.fold((0.0f64, 0.0f64), |(low, high), t| (low.min(t), high.max(t)));
        let strokes = [found.outward.unwrap(), found.inward.unwrap()];
        let min = strokes[0].min.value.min(strokes[1].min.value);
        let max = strokes[0].max.value.max(strokes[1].max.value);
        // Distance of the rows, and rounding of the gap.
        let tolerance = 1e-9 + 1e-15 / gap;
        close("least", min, least, least.abs(), tolerance);
        close("greatest", max, most, most, tolerance);
    }
}
