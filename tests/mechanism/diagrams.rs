//! Diagrams of a cycle compared with closed forms: with a rod a million cranks long x = r cos θ + l, and all is
//! harmonic.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use slider_crank::kinematics::{Diagrams, TurnOptions, one_turn};
use slider_crank::scene::Scene;

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
