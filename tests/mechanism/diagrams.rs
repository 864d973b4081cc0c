//! Diagrams of a cycle compared with closed forms: with a rod a million cranks long x = r cos θ + l, and all is
//! harmonic.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use slider_crank::kinematics::{Diagrams, TurnOptions, forces, one_turn};
use slider_crank::scene::{Crank, Load, Period, Scene, Slider, Variables};

const CRANK: f64 = 0.05;
const SPEED: f64 = 40.0;

/// Relative deviation from the harmonic limit.
const CLOSE: f64 = 1e-5;

fn diagrams(bodies: &str, balance: f64) -> Diagrams {
    let text = format!(
        "[geometry]\ncrank = \"50 mm\"\nrod = \"50 km\"\n{bodies}\n[motion]\nkind = \"constant-speed\"\n\
         speed = \"{SPEED} rad/s\"\n[run]\nduration = \"1 s\"\n"
    );
    let scene = Scene::parse("scene.toml".as_ref(), &text).expect("a scene");
    let options = TurnOptions {
        forces: true,
        balance: Some(balance),
        ..TurnOptions::default()
    };
    let turn = one_turn(&scene, &options).expect("a turn");
    turn.diagrams.expect("diagrams")
}

fn close(value: f64, expected: f64, size: f64) {
    assert!(
        (value - expected).abs() <= CLOSE * size,
        "{value} for {expected}"
    );
}

#[test]
fn a_rotating_mass_is_balanced_by_its_moment() {
    let found = diagrams(
        "[crank]\nmass = \"2 kg\"\ncg = \"30 mm\"\ninertia = \"0.002 kg m^2\"",
        0.5,
    )
    .balance;
    let force = 2.0 * 0.03 * SPEED * SPEED;
    close(found.forward_n, force, force);
    close(found.counterweight_kg_m, 0.06, 0.06);
    close(found.angle_rad, PI, PI);
    for left in [found.forward_left_n, found.backward_n, found.largest_left_n] {
        close(left, 0.0, force);
    }
    close(found.largest_n, force, force);
}

#[test]
fn half_of_a_reciprocating_mass_leaves_half_of_its_force_turning_back() {
    let force = 3.0 * CRANK * SPEED * SPEED;
    for (part, moment, forward_left, largest) in [
        (0.0, 0.0, 0.5, 1.0),
        (0.5, 0.5, 0.0, 0.5),
        (1.0, 1.0, 0.5, 1.0),
    ] {
        let found = diagrams("[slider]\nmass = \"3 kg\"", part).balance;
        close(found.counterweight_kg_m, moment * 3.0 * CRANK, 3.0 * CRANK);
        close(found.forward_n, 0.5 * force, force);
        close(found.backward_n, 0.5 * force, force);
        close(found.forward_left_n, forward_left * force, force);
        close(found.largest_n, force, force);
        close(found.largest_left_n, largest * force, force);
    }
}

/// T = -m r² ω² sin θ cos θ: four areas per turn of m r² ω² / 2 each, and only the second order.
#[test]
fn the_torque_of_a_reciprocating_mass_is_a_wave_of_second_order() {
    let found = diagrams("[slider]\nmass = \"3 kg\"", 0.5);
    let energy = 0.5 * 3.0 * CRANK * CRANK * SPEED * SPEED;
    let moment = &found.turning_moment;
    close(moment.mean_nm, 0.0, energy);
    close(moment.fluctuation_j, energy, energy);
    assert_eq!(moment.areas.len(), 4, "{:?}", moment.areas);
    for (area, quarter) in moment.areas.iter().zip(1..) {
        close(area.energy_j.abs(), energy, energy);
        close(area.to_rad - area.from_rad, PI / 2.0, PI);
        assert!(area.from_rad <= f64::from(quarter) * PI / 2.0 + 1e-3);
    }
    close(
        moment.areas.iter().map(|area| area.energy_j).sum(),
        0.0,
        energy,
    );
    for order in &found.orders {
        let expected = if order.order == 2.0 { energy } else { 0.0 };
        close(order.torque_nm, expected, energy);
        let force = if order.order == 1.0 {
            2.0 * energy / CRANK
        } else {
            0.0
        };
        close(order.shaking_x_n, force, 2.0 * energy / CRANK);
        close(order.shaking_y_n, 0.0, 2.0 * energy / CRANK);
    }
}

/// p = P (1 + sin θ): the work is P A r π over a swept volume of 2 A r.
#[test]
fn a_pressure_in_quadrature_has_its_mean_effective_pressure() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("p.csv");
    let mut rows = "theta [deg],pressure [bar]\n".to_owned();
    for k in 0..=3600 {
        let theta = f64::from(k) / 3600.0 * TAU;
        writeln!(rows, "{},{}", 0.1 * f64::from(k), 5.0 * (1.0 + theta.sin())).expect("a row");
    }
    std::fs::write(&file, rows).expect("a file");
    let gas = format!(
        "[slider]\nmass = \"3 kg\"\n[[force]]\nkind = \"gas\"\nfile = \"{}\"\nbore = \"80 mm\"",
        file.display()
    );
    let found = diagrams(&gas, 0.5).indicated.expect("a pressure");
    let area = PI * 0.04 * 0.04;
    close(
        found.swept_volume_m3,
        2.0 * area * CRANK,
        2.0 * area * CRANK,
    );
    close(
        found.work_j,
        5e5 * area * CRANK * PI,
        5e5 * area * CRANK * PI,
    );
    close(
        found.mean_effective_pressure_pa,
        5e5 * PI / 2.0,
        5e5 * PI / 2.0,
    );
    close(found.power_w, found.work_j * SPEED / TAU, found.power_w);
}

/// Returns the diagrams of a slider alone on a rod that is longer than crank and offset by a part `gap` of the crank.
fn near_singular(gap: f64, offset: f64) -> (f64, Diagrams) {
    let rod = CRANK + offset + gap * CRANK;
    let scene = Scene::new(CRANK, rod)
        .offset(offset)
        .slider(Slider { mass: 3.0 })
        .constant_speed(0.0, SPEED);
    let options = TurnOptions {
        forces: true,
        balance: Some(0.5),
        ..TurnOptions::default()
    };
    let turn = one_turn(&scene, &options).expect("a turn");
    (rod, turn.diagrams.expect("diagrams"))
}

/// Returns x = r cos θ + W with W² = l² − (e + r sin θ)², and its first two derivatives.
fn slider_motion(rod: f64, offset: f64, theta: f64) -> [f64; 3] {
    let (sin, cos) = theta.sin_cos();
    let u = offset + CRANK * sin;
    // 1 − sin θ without cancellation beside 90 degrees.
    let short = 2.0 * (0.5 * theta - PI / 4.0).sin().powi(2);
    let w = ((rod - offset - CRANK + CRANK * short) * (rod + u)).sqrt();
    let dw = -u * CRANK * cos / w;
    let d2w = (u * CRANK * sin - (CRANK * cos).powi(2) - dw * dw) / w;
    [CRANK * cos + w, dw - CRANK * sin, d2w - CRANK * cos]
}

/// Orders beside the singular geometry: the force is m x'' ω² and the torque (m x'²/2)' ω², whose coefficients are k²
/// and k times those of x and x'². The rectangle rule gives those of x to rounding, as its error falls by e^(−N w) with
/// N samples and the width w = sqrt(2 gap) of the peaks.
#[test]
fn orders_of_narrow_peaks_are_their_fourier_coefficients() {
    for (gap, offset) in [(1e-6, 0.0), (1e-5, 0.0), (1e-5, 0.01), (0.3, 0.02)] {
        let (rod, found) = near_singular(gap, offset);
        let count = 1u32 << 18;
        let mass_times_square = 3.0 * SPEED * SPEED;
        for order in found.orders {
            let k = order.order;
            let mut sums = [[0.0; 2]; 2];
            for i in 0..count {
                let part = f64::from(i) / f64::from(count);
                let [x, dx, _] = slider_motion(rod, offset, TAU * part);
                let (sin, cos) = (TAU * (k * part).fract()).sin_cos();
                for (sum, value) in sums.iter_mut().zip([k * k * x, 0.5 * k * dx * dx]) {
                    sum[0] += value * cos;
                    sum[1] += value * sin;
                }
            }
            let factor = 2.0 * mass_times_square / f64::from(count);
            let [force, torque] = sums.map(|[even, odd]| factor * even.hypot(odd));
            for (value, expected, size) in [
                (order.shaking_x_n, force, mass_times_square * CRANK),
                (order.torque_nm, torque, mass_times_square * CRANK * CRANK),
            ] {
                let error = (value - expected).abs();
                assert!(
                    error <= 1e-9 * size.max(expected),
                    "order {k} at {gap}: {value} for {expected}"
                );
            }
        }
    }
}

/// Without loads the energy that a flywheel stores is that of the slider, m x'² ω²/2: it fluctuates by the greatest.
#[test]
fn the_fluctuation_of_narrow_peaks_is_that_of_the_kinetic_energy() {
    for (gap, offset) in [(1e-4, 0.0), (1e-7, 0.0), (1e-7, 0.01), (1e-5, 0.03)] {
        let (rod, found) = near_singular(gap, offset);
        // Angles from 1e-8 to 1 rad beside 90 and 270 degrees, dense by their logarithms.
        let logarithms = (0..=1_000_000).map(|i| 1e-8 * 1e8f64.powf(f64::from(i) / 1e6));
        let around =
            logarithms.flat_map(|d| [1.0, 3.0].map(|k| k * PI / 2.0).map(|at| [at - d, at + d]));
        let speeds = around
            .flatten()
            .map(|theta| slider_motion(rod, offset, theta)[1]);
        let largest = speeds.fold(0.0, |most: f64, dx| most.max(dx * dx));
        let energy = 0.5 * 3.0 * SPEED * SPEED * largest;
        let fluctuation = found.turning_moment.fluctuation_j;
        let error = (fluctuation - energy).abs();
        assert!(
            error <= 1e-7 * energy,
            "{fluctuation} for {energy} at {gap}"
        );
    }
}

/// The largest shaking force m |x''| ω² is that of dense rows, with and without the counterweight.
#[test]
fn the_largest_shaking_force_is_located() {
    for (gap, offset) in [(0.9, 0.031), (0.05, 0.012), (1e-4, 0.02)] {
        let (rod, found) = near_singular(gap, offset);
        let balance = found.balance;
        let counter = balance.counterweight_kg_m * SPEED * SPEED;
        let (mut largest, mut left) = (0.0f64, 0.0f64);
        let count = 1u32 << 22;
        for i in 0..count {
            let theta = TAU * f64::from(i) / f64::from(count);
            let force = -3.0 * SPEED * SPEED * slider_motion(rod, offset, theta)[2];
            let (sin, cos) = (theta + balance.angle_rad).sin_cos();
            largest = largest.max(force.abs());
            left = left.max((force + counter * cos).hypot(counter * sin));
        }
        for (value, expected) in [(balance.largest_n, largest), (balance.largest_left_n, left)] {
            let error = (value - expected).abs();
            // Dense rows miss a peak of width w by the square of their distance over w.
            let missed = 1e-9 + 1e-12 / gap;
            assert!(
                error <= missed * expected,
                "{value} for {expected} at {gap}"
            );
        }
    }
}

/// A drag −c ω takes 2π c |ω| a turn from the drive in either sense of rotation, and one that grows with sin θ takes more of it where
/// it is larger.
#[test]
fn the_work_of_the_drive_has_the_sense_of_the_speed() {
    for speed in [20.0, -20.0] {
        let drag = Load::function(Variables::THETA.or(Variables::OMEGA), |now| {
            -0.02 * now.omega * (1.0 + 0.5 * now.theta.sin())
        })
        .with_period(Period::turns(1).expect("a turn"));
        let crank = Crank {
            inertia: 0.02,
            ..Crank::default()
        };
        let scene = Scene::new(0.05, 0.15)
            .crank(crank)
            .torque(drag)
            .constant_speed(0.0, speed);
        let found = forces(&scene)
            .unwrap()
            .diagrams(&scene, 0.5)
            .expect("diagrams");
        let moment = found.turning_moment;
        close(moment.work_j, TAU * 0.02 * 20.0, 1.0);
        close(moment.mean_nm, 0.02 * speed, 1.0);
        for area in moment.areas {
            let is_upper = area.from_rad < 0.5 * PI || area.from_rad > 1.5 * PI;
            assert_eq!(area.energy_j > 0.0, is_upper, "{area:?}");
        }
    }
}
