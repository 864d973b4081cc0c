//! Static equilibrium compared with Newton's equations of the single bodies, with Ng's numbers, and with the geometry
//! of the named positions.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::support::newton::Parts;
use crate::support::random::{any_class, case, cases, rotating_crank};
use crate::support::{close, geometry};
use proptest::prelude::*;
use slider_crank::mechanism::{Linkage, Statics, drum_torque, friction_from_tilt};
use slider_crank::scene::{
    Branch, Friction, Gravity, Interpolation, Load, Period, RodModel, Scene, Slider, Table,
    Variable, Variables,
};
use slider_crank::statics::{StaticAnalysis, StaticsOptions, statics};

proptest! {
    #![proptest_config(cases(3000))]

    /// With the computed slider force and without friction, nothing accelerates; at the edges of the band the remainder
    /// is the limiting friction.
    #[test]
    fn the_slider_force_holds_every_body(
        case in case(rotating_crank(1e-6)), mu in 0.0..3.0, torque in -50.0..50.0,
    ) {
        let scene = Scene { torques: vec![Load::Constant(torque)], forces: vec![Load::Constant(7.0)], ..case.scene.clone() };
        let linkage = Linkage::new(&scene.geometry);
        let pose = linkage.pose(case.theta);
        prop_assume!(pose.dx.abs() > 1e-4 * linkage.r);
        let balance = Statics::new(&scene, mu).unwrap().slider_force(case.theta);
        let (band, parts) = (balance.band.unwrap(), Parts::new(&scene, case.theta));
        let (alpha, forces) = parts.solve(0.0, torque, band.value + 7.0);
        let [_, _, dv] = parts.sizes();
        // x' is accurate to the rounding of r/cos phi, the size of its terms.
        let lever = linkage.r / pose.cos_phi;
        let size = dv + torque.abs() + (band.value.abs() + 7.0) * lever;
        close("acceleration", alpha * inertia_of(&parts), 0.0, size, 1e-13);
        let thrust_size = size / pose.dx.abs() / pose.cos_phi + parts.force_size(0.0, 0.0, linkage.l);
        close("side thrust", balance.side_thrust.unwrap(), -forces.guide, thrust_size, 1e-12);
        let friction = mu * forces.guide.abs();
        close("least", band.min.unwrap(), band.value - friction, thrust_size, 1e-11);
        close("greatest", band.max.unwrap(), band.value + friction, thrust_size, 1e-11);
    }

    /// At an edge of the torque band, the slider force and the limiting friction for the guide force of that state hold
    /// every body.
    #[test]
    fn the_crank_torque_holds_every_body(
        case in case(rotating_crank(1e-3)), mu in 0.0..1.5, force in -500.0..500.0,
    ) {
        let scene = Scene { torques: vec![Load::Constant(3.0)], forces: vec![Load::Constant(force)], ..case.scene.clone() };
        let linkage = Linkage::new(&scene.geometry);
        let pose = linkage.pose(case.theta);
        let balance = Statics::new(&scene, mu).unwrap().crank_torque(case.theta);
        let (band, parts) = (balance.band.unwrap(), Parts::new(&scene, case.theta));
        let [_, _, dv] = parts.sizes();
        let size = dv + 3.0 + force.abs() * linkage.r / pose.cos_phi;
        let (alpha, _) = parts.solve(0.0, band.value + 3.0, force);
        close("acceleration", alpha * inertia_of(&parts), 0.0, size, 1e-13);
        prop_assert_eq!(band.min.is_none(), balance.self_locking);
        let tan = pose.sin_phi.abs() / pose.cos_phi;
        prop_assert_eq!(balance.self_locking, mu > 0.0 && mu * pose.sin_phi.abs() >= pose.cos_phi);
        let room = 1.0 - mu * tan;
        if let (Some(min), Some(max)) = (band.min, band.max)
            && room > 1e-3 && pose.dx.abs() > 1e-4 * linkage.r
        {
            prop_assert!(min <= band.value + 1e-12 * size && band.value <= max + 1e-12 * size);
            for torque in [min, max] {
                // Force transmitted to the rod by the acting torque.
                let reaches = (dv_of(&parts) - torque - 3.0) / pose.dx;
                let (_, forces) = parts.solve(0.0, torque + 3.0, reaches);
                let friction = mu * forces.guide.abs();
                let scale = (size / pose.dx.abs() + parts.force_size(0.0, 0.0, linkage.l)) * (1.0 + mu) / room / pose.cos_phi;
                close("friction at the edge", (reaches - force).abs(), friction, scale, 1e-12);
            }
        }
    }

    /// At the named dead centres no force is stated; on both sides of them one is.
    #[test]
    fn no_force_at_any_dead_centre(g in rotating_crank(1e-3), torque in 0.1..10.0) {
        let scene = Scene { geometry: g, ..Scene::new(1.0, 2.0) }.torque(Load::Constant(torque));
        let result = statics(&scene, &StaticsOptions::default()).unwrap();
        let centres = result.positions.iter().filter(|p| p.kind == "dead-centre");
        for centre in centres {
            let theta = centre.theta_rad;
            prop_assert!(result.row(theta).balance.band.is_none(), "{theta}");
            for aside in [theta - 1e-9, theta + 1e-9] {
                prop_assert!(result.row(aside).balance.band.is_some(), "{aside}");
            }
        }
    }

    #[test]
    fn named_positions_are_what_their_names_say(g in any_class(), mu in 0.01..3.0) {
        let linkage = Linkage::new(&g);
        for position in linkage.named_positions() {
            let pose = linkage.pose(position.theta_rad);
            prop_assert!((0.0..TAU).contains(&position.theta_rad));
            // Rounding of the angle, magnified where the rod is nearly normal to the guide.
            let steep = 1e-13 / pose.cos_phi.powi(2).max(1e-30);
            match position.kind {
                "dead-centre" => prop_assert!(pose.dx.abs() < steep * (g.crank + g.rod), "{pose:?}"),
                "crank-normal-to-rod" => {
                    let along = linkage.s * pose.cos * pose.cos_phi - pose.sin * pose.sin_phi;
                    prop_assert!(along.abs() < steep, "{along}");
                }
                "least-transmission-angle" => {
                    let least = (0..3600).map(|i| linkage.pose(f64::from(i) * TAU / 3600.0).transmission()).fold(9.0, f64::min);
                    prop_assert!(pose.transmission() <= least);
                }
                "rod-normal-to-guide" => prop_assert!((pose.sin_phi.abs() - 1.0).abs() < 1e-12),
                "blocked" => {
                    let middle = 0.5 * (position.theta_rad + position.to_rad.unwrap());
                    prop_assert!(!linkage.pose(middle).is_regular());
                }
                other => prop_assert!(false, "{}", other),
            }
        }
        let locked = linkage.self_locking(mu);
        for i in 0..720 {
            let theta = f64::from(i) * TAU / 720.0 + 1e-3;
            let pose = linkage.pose(theta);
            let inside = locked.iter().any(|range| {
                (theta - range.theta_rad).rem_euclid(TAU) <= range.to_rad.unwrap() - range.theta_rad
            });
            let excess = mu * pose.sin_phi.abs() / pose.cos_phi - 1.0;
            if pose.is_regular() && excess.abs() > 1e-9 {
                prop_assert_eq!(inside, excess > 0.0, "{} {}", theta, excess);
            } else if !pose.is_regular() {
                prop_assert!(!inside);
            }
        }
    }
}

/// Returns V' of the bodies, from their heights as series.
fn dv_of(parts: &Parts) -> f64 {
    let sum = parts
        .all
        .iter()
        .fold(crate::support::exact::Jet::from(0.0), |sum, part| {
            sum + part.potential(parts.gravity)
        });
    sum.d(1)
}

/// Returns M of the bodies.
fn inertia_of(parts: &Parts) -> f64 {
    let sum = parts
        .all
        .iter()
        .fold(crate::support::exact::Jet::from(0.0), |sum, part| {
            sum + part.inertia()
        });
    sum.value()
}

fn ng() -> StaticAnalysis {
    let scene = Scene {
        friction: Some(Friction {
            coefficient: 0.2,
            static_coefficient: 1.0,
        }),
        ..Scene::new(0.025, 0.072).torque(Load::Constant(0.26487))
    };
    statics(&scene, &StaticsOptions::default()).unwrap()
}

/// Least forces and their angles from 40-digit arithmetic; the static coefficient of the scene applies.
#[test]
fn least_forces_of_ng() {
    let result = ng();
    for (found, theta, force) in [
        (&result.least, 1.2677538771096712, 10.002127044939536),
        (
            &result.least_with_friction,
            1.3693918999894683,
            6.42656873467039,
        ),
    ] {
        assert_eq!(found.len(), 2, "one for each stroke: {found:?}");
        close("angle", found[0].theta_rad, theta, theta, 1e-11);
        close("force", found[0].value, force, force, 1e-13);
        close("mirror", found[1].value, -force, force, 1e-13);
    }
    let normal: Vec<_> = result
        .positions
        .iter()
        .filter(|p| p.kind == "crank-normal-to-rod")
        .collect();
    assert_eq!(normal.len(), 2);
    close(
        "90 deg",
        normal[0].theta_rad.to_degrees(),
        70.85186254,
        70.0,
        1e-10,
    );
    let row = result.row(normal[0].theta_rad);
    close(
        "force",
        row.balance.band.unwrap().value,
        10.008628537834714,
        10.0,
        1e-13,
    );
    close("angle", row.crank_pin_angle, FRAC_PI_2, 1.0, 1e-14);
}

/// Ng (A3) and (11); beyond half a turn the interior angle decreases again.
#[test]
fn velocity_ratio_and_angle_at_the_crank_pin() {
    let result = ng();
    for (degrees, beta) in [
        (10.0f64, 166.5433),
        (90.0, 69.68249),
        (160.0, 13.17963),
        (200.0, 13.17963),
    ] {
        let row = result.row(degrees.to_radians());
        close("beta", row.crank_pin_angle.to_degrees(), beta, beta, 1e-6);
        let sin_phi = 0.025 * degrees.to_radians().sin() / 0.072;
        let om = sin_phi / (1.0 - sin_phi * sin_phi).sqrt()
            * (0.025 * degrees.to_radians().cos() + 0.072 * (1.0 - sin_phi * sin_phi).sqrt());
        close(
            "velocity ratio",
            row.velocity_ratio,
            om.abs() / 0.025,
            1.0,
            1e-14,
        );
    }
}

/// Slider of 1000 t with a massless rod: N = W − R tan φ and |R − F| = μ N at the edges, so R = (F ± μ W)/(1 ± μ tan
/// φ), τ = −R x'. The edges keep all digits however large the weight is.
#[test]
fn the_edges_under_a_large_weight_keep_their_digits() {
    let (mass, force, mu, theta) = (1e6, 3.0, 0.3_f64, 1.0_f64);
    let scene = Scene::new(1.0, 3.0)
        .slider(Slider { mass })
        .gravity(Gravity::standard())
        .force(Load::Constant(force));
    let options = StaticsOptions {
        force: Some(force),
        friction: Some(mu),
        ..StaticsOptions::default()
    };
    let band = statics(&scene, &options)
        .unwrap()
        .row(theta)
        .balance
        .band
        .unwrap();
    let sin_phi = theta.sin() / 3.0;
    let tan_phi = sin_phi / (1.0 - sin_phi * sin_phi).sqrt();
    let dx = -theta.sin() - theta.cos() * tan_phi;
    let torque = |mu: f64| -(force + mu * mass * 9.80665) / (1.0 + mu * tan_phi) * dx;
    let (min, max) = (torque(-mu), torque(mu));
    close("least", band.min.unwrap(), min, min.abs(), 1e-14);
    close("greatest", band.max.unwrap(), max, max, 1e-14);
}

#[test]
fn no_force_at_a_dead_centre_but_a_torque() {
    let result = ng();
    for theta in [0.0, PI, TAU, -PI] {
        let balance = result.row(theta).balance;
        assert_eq!((balance.band, balance.side_thrust), (None, None), "{theta}");
        let options = StaticsOptions {
            force: Some(100.0),
            ..StaticsOptions::default()
        };
        let scene = Scene::new(0.025, 0.072);
        let torque = statics(&scene, &options)
            .unwrap()
            .row(theta)
            .balance
            .band
            .unwrap();
        assert!(torque.value.abs() < 1e-12, "{torque:?}");
    }
    assert!(result.row(1e-6).balance.band.unwrap().value > 1e6);
}

/// Rocker: nothing is stated where the rod does not reach, and the blocked range is named.
#[test]
fn blocked_ranges_have_no_values() {
    let scene = Scene {
        geometry: geometry(0.05, 0.05, 0.01, Branch::Left),
        ..Scene::new(1.0, 1.0)
    };
    let options = StaticsOptions {
        torque: Some(1.0),
        friction: Some(0.5),
        ..StaticsOptions::default()
    };
    let result = statics(&scene, &options).unwrap();
    let blocked: Vec<_> = result
        .positions
        .iter()
        .filter(|p| p.kind == "blocked")
        .collect();
    assert_eq!(blocked.len(), 1);
    close("from", blocked[0].theta_rad, 0.8f64.asin(), 1.0, 1e-15);
    let row = result.row(FRAC_PI_2);
    assert!(row.balance.band.is_none() && !row.balance.self_locking && row.transmission.is_nan());
    let (locked, free) = (result.row(0.9).balance, result.row(0.3).balance);
    assert!(
        locked.self_locking && !free.self_locking,
        "{locked:?} {free:?}"
    );
}

#[test]
fn what_cannot_be_is_refused() {
    let mut scene = Scene::duarte();
    for friction in [-0.1, f64::NAN, f64::INFINITY] {
        let options = StaticsOptions {
            friction: Some(friction),
            ..StaticsOptions::default()
        };
        assert!(statics(&scene, &options).is_err(), "{friction}");
    }
    assert!(
        statics(
            &scene,
            &StaticsOptions {
                torque: Some(f64::NAN),
                ..StaticsOptions::default()
            }
        )
        .is_err()
    );
    scene.rod.as_mut().unwrap().model = RodModel::SpinOnly;
    let said = statics(&scene, &StaticsOptions::default())
        .unwrap_err()
        .to_string();
    assert!(said.contains("spin-only"), "{said}");
    scene.gravity = None;
    assert!(statics(&scene, &StaticsOptions::default()).is_ok());
}

/// Where weight and torque balance, no slider force is needed.
#[test]
fn the_least_force_may_be_none() {
    let options = StaticsOptions {
        torque: Some(0.1),
        ..StaticsOptions::default()
    };
    let result = statics(&Scene::duarte(), &options).unwrap();
    let none: Vec<_> = result
        .least
        .iter()
        .filter(|found| found.value == 0.0)
        .collect();
    assert_eq!(none.len(), 2, "{:?}", result.least);
    for found in none {
        let around =
            [-1e-6, 1e-6].map(|by| result.row(found.theta_rad + by).balance.band.unwrap().value);
        assert!(around[0] * around[1] < 0.0, "{around:?}");
    }
}

/// Without weight the force is -torque/x': the least force is that of the rows of the turn, although the torque was
/// different a turn earlier.
#[test]
fn the_least_force_is_that_of_the_rows() {
    let falling = Load::function(Variables::THETA, |now| 5.0 - now.theta);
    let result = statics(
        &Scene::new(0.05, 0.15).torque(falling),
        &StaticsOptions::default(),
    );
    let result = result.unwrap();
    let [first, second] = result.least.as_slice() else {
        panic!("{:?}", result.least)
    };
    close("angle of no force", second.theta_rad, 5.0, 5.0, 1e-12);
    assert_eq!(second.value, 0.0);
    let row = |theta: f64| result.row(theta).balance.band.unwrap().value;
    let least = (1..1800)
        .map(|i| row(f64::from(i) * TAU / 3600.0))
        .fold(f64::INFINITY, f64::min);
    close("least of the first stroke", first.value, least, least, 1e-5);
    close(
        "at its angle",
        first.value,
        row(first.theta_rad),
        least,
        1e-15,
    );
}

/// Outside its table a load has no value, and neither has the equilibrium.
#[test]
fn loads_without_a_value_leave_no_value() {
    let table = Table::new(
        Variable::Theta,
        &[0.0, 1.0],
        &[1.0, 2.0],
        Interpolation::Linear,
        None,
    );
    let scene = Scene::new(0.05, 0.15).torque(Load::Table(table.unwrap()));
    let result = statics(&scene, &StaticsOptions::default()).unwrap();
    assert!(result.row(0.5).balance.band.is_some());
    let outside = result.row(2.0).balance;
    assert_eq!((outside.band, outside.side_thrust), (None, None));
}

#[test]
fn torque_of_a_drum_and_friction_of_a_tilt() {
    close("torque", drum_torque(9.81, 0.027), 0.26487, 0.26487, 1e-15);
    close(
        "friction",
        friction_from_tilt(30f64.to_radians()),
        1.0 / 3f64.sqrt(),
        1.0,
        1e-15,
    );
}

/// A slider under a constant force F and a torque τ: no force is missing where F x' = −τ. One of the two zeros lies
/// within half a degree of the dead centre, at which the force has a pole.
#[test]
fn a_zero_beside_a_dead_centre_is_found() {
    let (r, l, force) = (0.05, 0.15, 7.0);
    let dx = |theta: f64| {
        let (sin, cos) = theta.sin_cos();
        -r * sin * (1.0 + r * cos / (l * l - r * r * sin * sin).sqrt())
    };
    for near in [0.004, PI - 0.007, PI + 0.0003] {
        let scene = Scene::new(r, l)
            .torque(Load::Constant(-force * dx(near)))
            .force(Load::Constant(force));
        let result = statics(&scene, &StaticsOptions::default()).unwrap();
        // The other zero, in the same stroke: x' is monotone from its extreme near 73 deg from the outer dead centre.
        let top = if near < PI { 1.28 } else { TAU - 1.28 };
        let [mut low, mut high] = match near < 1.0 {
            true => [top, PI],
            false => [if near < PI { 0.0 } else { TAU }, top],
        };
        let rest = |theta: f64| dx(theta) - dx(near);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            let is_low = (rest(middle) > 0.0) == (rest(low) > 0.0);
            *(if is_low { &mut low } else { &mut high }) = middle;
        }
        let mut expected = [near, low];
        expected.sort_by(f64::total_cmp);
        let zeros = result.least.iter().filter(|found| found.value == 0.0);
        let zeros: Vec<f64> = zeros.map(|found| found.theta_rad).collect();
        assert_eq!(zeros.len(), 2, "{:?}", result.least);
        for (found, expected) in zeros.iter().zip(expected) {
            close("angle of no force", *found, expected, 1.0, 1e-11);
        }
    }
}

/// The torque of a table dips within half a degree, to a value of either sign: the force −τ/x' is least at the row of
/// the dip, or zero on both sides of it.
#[test]
fn dips_between_the_degrees_are_found() {
    let (r, l, at, half) = (0.05, 0.15, 1.1052, 0.0041);
    for dip in [0.3, -0.2] {
        let table = Table::new(
            Variable::Theta,
            &[0.0, at - half, at, at + half, TAU],
            &[2.0, 2.0, dip, 2.0, 2.0],
            Interpolation::Linear,
            Some(TAU),
        );
        let scene = Scene::new(r, l).torque(Load::Table(table.unwrap()));
        let result = statics(&scene, &StaticsOptions::default()).unwrap();
        let least = result.least.iter();
        let found: Vec<_> = least
            .filter(|found| (found.theta_rad - at).abs() < half)
            .collect();
        let (sin, cos) = at.sin_cos();
        let dx: f64 = -r * sin * (1.0 + r * cos / (l * l - r * r * sin * sin).sqrt());
        if dip > 0.0 {
            assert_eq!(found.len(), 1, "{:?}", result.least);
            close("angle", found[0].theta_rad, at, 1.0, 1e-9);
            close("force", found[0].value, -dip / dx, dip / dx.abs(), 1e-6);
        } else {
            assert_eq!(found.len(), 2, "{:?}", result.least);
            let aside = half * (-dip) / (2.0 - dip);
            for (found, expected) in found.iter().zip([at - aside, at + aside]) {
                assert_eq!(found.value, 0.0);
                close("angle of no force", found.theta_rad, expected, 1.0, 1e-12);
            }
        }
    }
}

/// The torque τ₀ sin θ of a mechanism without offset vanishes at the dead centres with x': the force −τ₀ sin θ/x' does
/// not.
#[test]
fn no_zero_where_the_torque_vanishes_at_a_dead_centre() {
    let torque = Load::function(Variables::THETA, |now| now.theta.sin());
    let scene = Scene::new(0.05, 0.15).torque(torque);
    let result = statics(&scene, &StaticsOptions::default()).unwrap();
    assert!(
        result.least.iter().all(|found| found.value != 0.0),
        "{:?}",
        result.least
    );
}

/// A rod that hangs below the guide wherever it reaches: with enough friction the whole reach is one range of locking,
/// through 270 or 90 degrees.
#[test]
fn one_range_of_locking_through_the_normal_of_the_guide() {
    for (offset, middle) in [(0.5, 3.0 * FRAC_PI_2), (-0.5, FRAC_PI_2)] {
        let linkage = Linkage::new(&geometry(0.22, 0.31, offset, Branch::Right));
        // The rod reaches where |e| − r cos(θ − middle) ≤ l, and locks where μ |tan φ| ≥ 1: from 0.28 m on at μ = 5.
        let half = ((0.5f64 - 0.31) / 0.22).acos();
        let locked = linkage.self_locking(5.0);
        let [range] = locked.as_slice() else {
            panic!("{locked:?}")
        };
        close(
            "from",
            range.theta_rad,
            (middle - half).rem_euclid(TAU),
            1.0,
            1e-13,
        );
        close(
            "to",
            range.to_rad.unwrap() - range.theta_rad,
            2.0 * half,
            1.0,
            1e-13,
        );
    }
}

/// A force −F sin(θ/2) of the slider repeats after two turns: what holds it is F sin(θ/2), which vanishes at 0 and 360 deg alone.
#[test]
fn the_equilibrium_covers_the_cycle_of_the_loads() {
    let load = Load::function(Variables::THETA, |now| -100.0 * (0.5 * now.theta).sin())
        .with_period(Period::turns(2).expect("two turns"));
    let found = statics(
        &Scene::new(0.05, 0.15).force(load),
        &StaticsOptions::default(),
    )
    .unwrap();
    let rows: Vec<_> = found.rows(PI / 12.0).collect();
    assert_eq!(rows.len(), 49);
    for row in rows {
        let at_dead_centre = (row.theta / PI - (row.theta / PI).round()).abs() < 1e-9;
        let Some(band) = row.balance.band.filter(|_| !at_dead_centre) else {
            continue;
        };
        close(
            "force",
            band.value,
            100.0 * (0.5 * row.theta).sin(),
            100.0,
            1e-12,
        );
    }
    let zeros: Vec<f64> = found
        .least
        .iter()
        .filter(|at| at.value.abs() < 1e-9)
        .map(|at| at.theta_rad)
        .collect();
    assert!(zeros.iter().any(|at| (at - TAU).abs() < 1e-6), "{zeros:?}");
    assert!(
        zeros
            .iter()
            .all(|at| (at / TAU - (at / TAU).round()).abs() < 1e-6),
        "{zeros:?}"
    );
}
