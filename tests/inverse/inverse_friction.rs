//! Slider force and crank torque of a motion with friction at the guide, compared with forward runs and the
//! Newton-Euler equations.

use crate::support::newton::Parts;
use crate::support::random::{cases, rotating_crank};
use proptest::prelude::*;
use slider_crank::inverse::{FitKind, InverseOptions, inverse};
use slider_crank::scene::{
    Crank, Friction, Gravity, Load, Measured, Measurement, Rod, Scene, Slider, Variables,
};
use slider_crank::simulate::{Options, simulate};

fn rubbing(scene: Scene, mu: f64) -> Scene {
    let mut scene = scene
        .crank(Crank {
            inertia: 2e-3,
            ..Crank::default()
        })
        .rod(Rod {
            mass: 0.3,
            cg: 0.05,
            inertia: 8e-4,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.4 })
        .gravity(Gravity::standard());
    scene.friction = Some(Friction {
        coefficient: mu,
        static_coefficient: mu,
    });
    scene
}

/// Rotating and swinging crank, driven by a time-dependent force.
#[test]
fn a_forward_run_gives_back_its_force() {
    for (start, speed, amplitude) in [(0.3, 20.0, 10.0), (0.6, 0.0, 25.0), (0.3, -18.0, 8.0)] {
        let force = move |t: f64| amplitude * (6.0 * t).sin() - 3.0;
        let load = Load::function(Variables::T, move |now| force(now.t));
        let base = rubbing(Scene::new(0.05, 0.15).offset(0.01), 0.15);
        let mut scene = base.clone().force(load).start(start, speed).duration(0.6);
        scene.run.tolerance = 1e-11;
        let run = simulate(&scene, &Options::default()).expect("a run");
        // Between two reversals the motion is smooth.
        let turning = run
            .summary
            .events
            .iter()
            .filter(|e| e.kind == "turning-point" || e.kind == "stick");
        let end = turning
            .map(|e| e.t_s)
            .filter(|t| *t > 0.05)
            .fold(0.6, f64::min);
        let times: Vec<f64> = (0..300)
            .map(|i| end * (0.02 + 0.96 * f64::from(i) / 299.0))
            .collect();
        let angles = times
            .iter()
            .map(|t| run.at(*t).expect("inside").0)
            .collect();
        let motion = Measurement::new(Measured::Theta, times, angles).expect("samples");
        let options = InverseOptions {
            fit: FitKind::Smoother,
            reactions: true,
            ..InverseOptions::default()
        };
        let found = inverse(&base.start(start, speed), &motion, &options).expect("an inversion");
        // Where the normal force, and friction with it, changes sign, the acceleration has a corner.
        let sides: Vec<_> = found
            .rows
            .iter()
            .map(|row| found.reactions(row).map(|forces| forces.guide > 0.0))
            .collect();
        let one_side = |i: usize| {
            let around = &sides[i.saturating_sub(10)..(i + 11).min(sides.len())];
            around.iter().all(|side| *side == sides[i])
        };
        let rows = (0..sides.len()).filter(|i| sides[*i].is_some() && one_side(*i));
        let rows: Vec<_> = rows.map(|i| found.rows[i]).collect();
        assert!(rows.len() > 150, "{}", rows.len());
        let factor = found.summary.band_factor;
        let inside = rows.iter().filter(|row| {
            let apart = (row.slider_force.unwrap() - force(row.t)).abs();
            apart <= factor * row.slider_force_se.unwrap()
        });
        let share = inside.count() as f64 / rows.len() as f64;
        assert!(share > 0.9, "{start}, {speed}: {share}");
        // Without friction the force would differ by much more than the band.
        let mut bare = scene.clone();
        bare.friction = None;
        let without = inverse(&bare, &motion, &options).expect("an inversion");
        let row = rows[rows.len() / 3];
        let i = found.rows.iter().position(|r| r.t == row.t).expect("a row");
        let other = without.rows[i].slider_force.expect("a force");
        assert!((other - force(row.t)).abs() > 20.0 * row.slider_force_se.unwrap());
    }
}

/// At rest the friction may have any value up to its limit: the force is empty, and the error of the torque includes
/// this.
#[test]
fn at_rest_the_force_is_empty() {
    let times: Vec<f64> = (0..=200).map(|i| 0.005 * f64::from(i)).collect();
    let angles = times
        .iter()
        .map(|t| 1.2 + 2.0 * (t - 0.5) * (t - 0.5))
        .collect();
    let motion = Measurement::new(Measured::Theta, times, angles).expect("samples");
    let scene = rubbing(Scene::new(0.05, 0.15), 0.2);
    let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
    let row = found.rows[100];
    assert!(row.slider_force.is_none() && row.near_dead_centre && row.crank_torque_se > Some(1e-3));
    assert!(found.rows[60].slider_force.is_some() && found.rows[60].crank_torque_se < Some(1e-6));
    assert!(
        found.summary.dead_centre_bands[0]
            .reason
            .contains("friction and dry loads may act either way")
    );
}

/// The crank reverses at t = 0.5 s under a brake of 0.7 N m and, where it counts, a dry force of 20 N on the slider:
/// these have their sense before and after, and near the reversal any value up to their magnitude.
#[test]
fn at_a_reversal_dry_loads_are_in_the_band() {
    let times: Vec<f64> = (0..=200).map(|i| 0.005 * f64::from(i)).collect();
    let angles = times
        .iter()
        .map(|t| 1.2 + 2.0 * (t - 0.5) * (t - 0.5))
        .collect();
    let motion = Measurement::new(Measured::Theta, times, angles).expect("samples");
    for beside_forces in [false, true] {
        let scene = Scene::new(0.05, 0.15)
            .crank(Crank {
                inertia: 2e-3,
                ..Crank::default()
            })
            .torque(Load::dry(0.7))
            .force(Load::dry(20.0));
        let options = InverseOptions {
            beside_forces,
            ..InverseOptions::default()
        };
        let found = inverse(&scene, &motion, &options).expect("an inversion");
        let force = if beside_forces { 20.0 } else { 0.0 };
        let mut doubtful = 0;
        for row in &found.rows {
            let held = 0.7 + force * found.lever_arm(row).abs();
            let [torque, error] = [row.crank_torque, row.crank_torque_se].map(Option::unwrap);
            if (row.t - 0.5).abs() > 0.02 {
                let expected = 2e-3 * 4.0 + held * (row.t - 0.5).signum();
                let off = (torque - expected).abs();
                assert!(off < 1e-6 && error < 1e-6, "{off:e} {error:e} {row:?}");
            } else if row.slider_force.is_none() {
                assert!((torque - 2e-3 * 4.0).abs() < 1e-6, "{row:?}");
                assert!((error - held).abs() < 1e-6, "{row:?}");
                doubtful += 1;
            }
        }
        let bands = &found.summary.dead_centre_bands;
        let said = bands
            .iter()
            .any(|band| band.reason.contains("dry loads may act either way"));
        assert!(doubtful > 0 && said, "{bands:?}");
    }
}

/// The guide is self-locking where mu |tan phi| > 1: there the torque is empty but not the force, and the other rows
/// have both.
#[test]
fn where_a_guide_locks_itself_the_torque_is_empty() {
    let times: Vec<f64> = (0..200).map(|i| 0.005 * f64::from(i)).collect();
    let angles: Vec<f64> = times.iter().map(|t| 0.4 + 1.8 * t).collect();
    let motion = Measurement::new(Measured::Theta, times, angles.clone()).expect("samples");
    let mu = 1.6;
    let scene = rubbing(Scene::new(0.05, 0.09), mu);
    let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
    let mut locked = 0;
    for (row, theta) in found.rows.iter().zip(angles) {
        let sine = 0.05 / 0.09 * theta.sin();
        let slope = mu * sine / (1.0 - sine * sine).sqrt();
        if (slope - 1.0).abs() > 1e-3 {
            assert_eq!(row.crank_torque.is_none(), slope > 1.0, "{theta}");
        }
        locked += usize::from(row.crank_torque.is_none());
        assert_eq!(row.crank_torque.is_none(), row.crank_torque_se.is_none());
        assert!(row.slider_force.is_some());
    }
    let said = found
        .summary
        .warnings
        .iter()
        .find(|w| w.contains("locks itself"));
    let said = said.expect("a warning");
    assert!(0 < locked && locked < 200);
    assert!(said.contains(&format!("at {locked} samples")), "{said}");
}

/// The rod presses the slider into the guide at 45° and more, and mu = 1.2: no torque on the crank keeps the slider
/// moving.
#[test]
fn a_guide_that_locks_itself_is_refused() {
    let times: Vec<f64> = (0..50).map(|i| 0.01 * f64::from(i)).collect();
    let angles = times.iter().map(|t| 1.0 + 1.0 * t).collect();
    let motion = Measurement::new(Measured::Theta, times, angles).expect("samples");
    let scene = rubbing(Scene::new(0.05, 0.055), 1.2);
    let refused = inverse(&scene, &motion, &InverseOptions::default()).expect_err("it locks");
    assert!(
        refused.to_string().contains("locks itself at sample 1"),
        "{refused}"
    );
}

proptest! {
    #![proptest_config(cases(60))]

    /// Force and torque give the measured acceleration in the Newton-Euler equations.
    #[test]
    fn newton_and_euler_agree(
        geometry in rotating_crank(0.3),
        theta in -3.0..3.0,
        speed in prop_oneof![5.0..40.0, -40.0..-5.0],
        bend in -60.0..60.0,
        mu in 0.02..0.25,
    ) {
        let mut scene = rubbing(Scene::new(geometry.crank, geometry.rod), mu);
        scene.geometry = geometry;
        if let Some(rod) = &mut scene.rod {
            rod.cg = 0.4 * geometry.rod;
            rod.inertia = 0.1 * rod.mass * geometry.rod * geometry.rod;
        }
        let times: Vec<f64> = (0..41).map(|i| 1e-3 * f64::from(i - 20)).collect();
        let angles = times.iter().map(|t| theta + speed * t + 0.5 * bend * t * t).collect();
        let motion = Measurement::new(Measured::Theta, times, angles).expect("samples");
        let found = inverse(&scene, &motion, &InverseOptions::default());
        let found = match found {
            Ok(found) => found,
            Err(refused) => {
                prop_assert!(refused.to_string().contains("locks itself"), "{}", refused);
                return Ok(());
            }
        };
        let row = found.rows[20];
        let parts = Parts::new(&scene, row.theta);
        let with = |torque: f64, along: f64| {
            let (alpha, reactions) = parts.solve(row.omega, torque, along);
            [alpha, reactions.guide]
        };
        let dx = slider_crank::mechanism::Linkage::new(&geometry).pose(row.theta).dx;
        let direction = (dx * row.omega).signum();
        if let Some(force) = row.slider_force {
            let friction = -mu * direction * {
                // The acceleration is linear in the whole force along the guide.
                let (a, b) = (with(0.0, 0.0), with(0.0, 1.0));
                let along = (row.alpha - a[0]) / (b[0] - a[0]);
                with(0.0, along)[1].abs()
            };
            let [alpha, normal] = with(0.0, force + friction);
            prop_assert!((alpha - row.alpha).abs() < 1e-7 * (1.0 + alpha.abs() + row.omega * row.omega));
            prop_assert!((friction + mu * direction * normal.abs()).abs() < 1e-6 * (1e-3 + friction.abs()));
        }
        // Acceleration and normal force are linear in torque and friction: with the torque of the row, the friction
        // that gives the acceleration must be that of the normal force.
        let Some(torque) = row.crank_torque else {
            return Ok(());
        };
        let (a, b) = (with(torque, 0.0), with(torque, 1.0));
        prop_assume!(dx.abs() > 0.05 * geometry.crank);
        let friction = (row.alpha - a[0]) / (b[0] - a[0]);
        let [_, normal] = with(torque, friction);
        prop_assert!(
            (friction + mu * direction * normal.abs()).abs() < 1e-6 * (1.0 + normal.abs()),
            "{} {}", friction, normal
        );
    }
}
