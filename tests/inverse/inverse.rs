//! Sampled forward runs, inverted, return the applied force within the stated band.

use std::f64::consts::{PI, TAU};

use crate::noise::Random;
use slider_crank::inverse::{AsPrinted, FitKind, Inverse, InverseOptions, inverse};
use slider_crank::mechanism::Linkage;
use slider_crank::scene::{
    Branch, Crank, Gravity, Load, Measured, Measurement, Scene, Slider, Variables,
};
use slider_crank::simulate::{Options, Simulation, simulate};

fn pump() -> Scene {
    Scene::new(0.05, 0.15)
        .offset(0.01)
        .crank(Crank {
            inertia: 2e-3,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.4 })
        .gravity(Gravity::standard())
}

/// Scene, force on its slider over time and position, and sampling.
struct Case {
    scene: Scene,
    force: fn(f64, f64) -> f64,
    samples: u32,
    end: f64,
}

fn swing() -> Case {
    let force = |t: f64, _: f64| 12.0 * (5.0 * t).sin() - 4.0;
    let load = Load::function(Variables::T, move |now| force(now.t, 0.0));
    Case {
        scene: pump().force(load).start(0.6, 0.0),
        force,
        samples: 200,
        end: 0.35,
    }
}

fn turns() -> Case {
    let force = |t: f64, _: f64| 15.0 * (9.0 * t).sin();
    let load = Load::function(Variables::T, move |now| force(now.t, 0.0));
    Case {
        scene: pump().force(load).start(0.3, 20.0),
        force,
        samples: 600,
        end: 1.2,
    }
}

impl Case {
    fn run(&self) -> (Scene, Simulation) {
        let mut scene = self.scene.clone().duration(self.end);
        scene.run.tolerance = 1e-12;
        let run = simulate(&scene, &Options::default()).expect("a run");
        (scene, run)
    }

    fn times(&self) -> Vec<f64> {
        let last = f64::from(self.samples - 1);
        (0..self.samples)
            .map(|i| self.end * f64::from(i) / last)
            .collect()
    }
}

/// Returns the readings of an instrument at crank angles.
fn shown(scene: &Scene, measured: Measured, theta: &[f64]) -> Vec<f64> {
    let linkage = Linkage::new(&scene.geometry);
    let value = |theta: &f64| {
        let pose = linkage.pose(*theta);
        let place = [linkage.r * pose.cos, linkage.r * pose.sin];
        match measured {
            Measured::Theta => *theta,
            Measured::X => pose.x,
            Measured::Omega => panic!("an angle alone has no speed"),
            // Angle between the directions from the crank pin to the pivot and to the wrist pin.
            Measured::Gamma => {
                let to_pin = [pose.x - place[0], -linkage.e - place[1]];
                let (dot, cross) = (
                    -place[0] * to_pin[0] - place[1] * to_pin[1],
                    place[0] * to_pin[1] - place[1] * to_pin[0],
                );
                cross.abs().atan2(dot)
            }
        }
    };
    theta.iter().map(value).collect()
}

fn fitted(fit: FitKind) -> InverseOptions {
    InverseOptions {
        fit,
        ..InverseOptions::default()
    }
}

/// Returns the number of rows whose band covers the force, and the number of rows with a force.
fn covered(case: &Case, found: &Inverse, run: &Simulation, scene: &Scene) -> (usize, usize) {
    let linkage = Linkage::new(&scene.geometry);
    let (mut inside, mut all) = (0, 0);
    for row in &found.rows {
        if let (Some(force), Some(se)) = (row.slider_force, row.slider_force_se) {
            let (theta, _) = run.at(row.t).expect("a time of the run");
            let exact = (case.force)(row.t, linkage.pose(theta).x);
            all += 1;
            inside += usize::from((force - exact).abs() <= found.summary.band_factor * se);
        }
    }
    (inside, all)
}

#[track_caller]
fn covers(case: &Case, fit: FitKind, measured: Measured, noise: f64, repeats: u32) {
    let (scene, run) = case.run();
    let times = case.times();
    let theta: Vec<f64> = times
        .iter()
        .map(|t| run.at(*t).expect("inside").0)
        .collect();
    let exact = shown(&scene, measured, &theta);
    let mut random = Random(88_172_645_463_325_252);
    let (mut inside, mut all) = (0, 0);
    for _ in 0..repeats {
        let values = exact.iter().map(|v| v + noise * random.normal());
        let values = values.map(|v| {
            if measured == Measured::Gamma {
                PI - (PI - v.abs()).abs()
            } else {
                v
            }
        });
        let motion = Measurement::new(measured, times.clone(), values.collect()).expect("samples");
        let found = inverse(&scene, &motion, &fitted(fit)).expect("an inversion");
        // Without noise the residual is the error of the forward run, which is not white noise.
        let said = |warning: &String| warning.contains("not white noise");
        if noise == 0.0 && found.summary.warnings.iter().any(said) {
            return;
        }
        let (more, of) = covered(case, &found, &run, &scene);
        inside += more;
        all += of;
    }
    let share = inside as f64 / all as f64;
    assert!(
        share >= 0.90,
        "{fit:?} of {measured:?}, noise {noise}: {share}"
    );
    let given = all as f64 / (f64::from(repeats) * times.len() as f64);
    assert!(
        given > 0.9,
        "{fit:?} of {measured:?}: {given} of the rows have a force"
    );
}

#[test]
fn bands_by_default_cover_the_force() {
    covers(&swing(), FitKind::Auto, Measured::Theta, 1e-3, 40);
    covers(&swing(), FitKind::Auto, Measured::Gamma, 1e-3, 20);
    covers(&swing(), FitKind::Auto, Measured::X, 2e-5, 20);
}

#[test]
fn bands_of_smoothers_cover_the_force() {
    covers(&turns(), FitKind::Smoother, Measured::Theta, 1e-3, 30);
    covers(&turns(), FitKind::Smoother, Measured::Gamma, 1e-3, 6);
    covers(&turns(), FitKind::Smoother, Measured::X, 2e-5, 6);
}

#[test]
fn bands_without_noise_cover_the_force_or_are_warned_of() {
    covers(&swing(), FitKind::Auto, Measured::Theta, 0.0, 1);
    covers(&swing(), FitKind::Auto, Measured::X, 0.0, 1);
    covers(&turns(), FitKind::Smoother, Measured::Theta, 0.0, 1);
}

/// Motions by formula on mechanisms of all kinds: rotation in either sense, reversal before the dead centres, and dead
/// centres passed on the way back.
#[test]
fn folded_measurements_are_unfolded() {
    type Angle = fn(f64) -> f64;
    let rotating: [(Angle, f64); 4] = [
        (|t| 0.4 + 17.0 * t + 0.3 * (9.0 * t).sin(), 1.0),
        (|t| 0.4 - 17.0 * t, -1.0),
        (|t| 0.2 + 2.6 * (6.0 * t).sin(), 1.0),
        (|t| 2.0 + 5.0 * (3.0 * t).sin() + 2.0 * t, 1.0),
    ];
    for (offset, branch) in [
        (0.0, Branch::Right),
        (0.012, Branch::Right),
        (-0.02, Branch::Left),
    ] {
        for (angle, sign) in rotating {
            let scene = Scene::new(0.05, 0.15)
                .offset(offset)
                .branch(branch)
                .slider(Slider { mass: 1.0 });
            let scene = scene.start(angle(0.0), sign);
            check_unfolding(&scene, angle, 2.0);
        }
    }
    // Rocker: with r = 50, l = 40, e = 5 mm θ ranges from −44 to 64 degrees; the motion passes the dead centres.
    let rocker = Scene::new(0.05, 0.04)
        .offset(0.005)
        .slider(Slider { mass: 1.0 });
    check_unfolding(
        &rocker.start(0.1, 1.0),
        |t| 0.1 + 0.4 * (5.0 * t).sin(),
        2.0,
    );
}

#[track_caller]
fn check_unfolding(scene: &Scene, angle: fn(f64) -> f64, end: f64) {
    let times: Vec<f64> = (0..=400).map(|i| end * f64::from(i) / 400.0).collect();
    let theta: Vec<f64> = times.iter().map(|t| angle(*t)).collect();
    for measured in [Measured::Gamma, Measured::X] {
        let motion = Measurement::new(measured, times.clone(), shown(scene, measured, &theta))
            .expect("samples");
        let found = inverse(scene, &motion, &fitted(FitKind::Smoother)).expect("an inversion");
        let turns = ((found.rows[0].theta - theta[0]) / TAU).round() * TAU;
        for (row, theta) in found.rows.iter().zip(&theta) {
            let off = row.theta - turns - theta;
            assert!(
                off.abs() < 1e-3,
                "{measured:?}, {:?}: {off} at {}",
                scene.geometry,
                row.t
            );
        }
    }
}

/// The motion starts slowly, near a dead centre or far from one, and reverses at once: the scene's angle determines the
/// stroke, whatever the sense of its small speed.
#[test]
fn the_angle_of_the_scene_decides_where_the_motion_reverses_at_once() {
    let offsets = [
        (0.0, Branch::Right),
        (0.02, Branch::Right),
        (-0.02, Branch::Left),
    ];
    for (offset, branch) in offsets {
        for start in [0.4, 1.3, 2.5, -0.5, -1.4, -2.2] {
            for sense in [1.0, -1.0] {
                // θ = start + sense (0.3 t − 40 t²): the first 4 ms run in the opposite sense to the rest.
                let angle = move |t: f64| start + sense * (0.3 * t - 40.0 * t * t);
                let scene = Scene::new(0.05, 0.15)
                    .offset(offset)
                    .branch(branch)
                    .slider(Slider { mass: 1.0 })
                    .start(start, 0.3 * sense);
                let times: Vec<f64> = (0..=300).map(|i| 0.001 * f64::from(i)).collect();
                let theta: Vec<f64> = times.iter().map(|t| angle(*t)).collect();
                for measured in [Measured::X, Measured::Gamma] {
                    let values = shown(&scene, measured, &theta);
                    let motion =
                        Measurement::new(measured, times.clone(), values).expect("samples");
                    let found = inverse(&scene, &motion, &fitted(FitKind::Smoother));
                    let found = found.expect("an inversion");
                    for (row, theta) in found.rows.iter().zip(&theta) {
                        let off = row.theta - theta;
                        assert!(
                            off.abs() < 2e-2,
                            "{measured:?}, {offset}, {start}, {sense}: {off} at {}",
                            row.t
                        );
                    }
                }
            }
        }
    }
}

/// With a rod barely longer than the crank, slider and rod stand still for half a turn. The angle at the crank pin then
/// shows only noise, which no fit may turn into rotations.
#[test]
fn samples_that_do_not_tell_the_motion_are_refused_or_followed() {
    let scene = Scene::new(0.05, 0.05002)
        .slider(Slider { mass: 1.0 })
        .start(-0.8, 2.7);
    let times: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
    let theta: Vec<f64> = times.iter().map(|t| -0.8 + 2.7 * t + 0.3 * t * t).collect();
    let exact = shown(&scene, Measured::Gamma, &theta);
    for (seed, fit) in [
        (1, FitKind::Smoother),
        (2, FitKind::Smoother),
        (3, FitKind::Polynomial),
    ] {
        let mut random = Random(77 + seed);
        let noisy = exact.iter().map(|v| (v + 3e-3 * random.normal()).abs());
        let motion = Measurement::new(Measured::Gamma, times.clone(), noisy.collect());
        match inverse(&scene, &motion.expect("samples"), &fitted(fit)) {
            Ok(found) => assert!(found.summary.data.revolutions.abs() < 2.0),
            Err(error) => assert!(error.to_string().contains("astray"), "{error}"),
        }
    }
}

/// Where the scene's angle is absent or far from both possible starts, its speed decides.
#[test]
fn the_speed_of_the_scene_decides_where_its_angle_says_nothing() {
    let times: Vec<f64> = (0..=300).map(|i| 0.001 * f64::from(i)).collect();
    let theta: Vec<f64> = times.iter().map(|t| 0.9 + 12.0 * t).collect();
    for angle in [0.0, 2.3] {
        for sense in [1.0, -1.0] {
            let scene = Scene::new(0.05, 0.15).slider(Slider { mass: 1.0 });
            let scene = scene.start(angle, 5.0 * sense);
            let values = shown(&scene, Measured::X, &theta);
            let motion = Measurement::new(Measured::X, times.clone(), values).expect("samples");
            let found = inverse(&scene, &motion, &fitted(FitKind::Smoother)).expect("an inversion");
            assert!((found.rows[0].theta - 0.9 * sense).abs() < 1e-3);
        }
    }
}

/// The mirror image of a motion has other forces; if neither forces nor scene decide, both motions are named. With the
/// guide through the pivot the image is exact; for a crank that starts at rest the speed is no evidence.
#[test]
fn motions_and_their_mirror_images_are_told_or_both_named() {
    let times: Vec<f64> = (0..=300).map(|i| 0.004 * f64::from(i)).collect();
    let theta: Vec<f64> = times.iter().map(|t| 0.9 + 6.0 * t * t).collect();
    let pump = Scene::new(0.05, 0.15).slider(Slider { mass: 1.0 });
    let taken = |scene: Scene| {
        let values = shown(&scene, Measured::X, &theta);
        let motion = Measurement::new(Measured::X, times.clone(), values).expect("samples");
        let found = inverse(&scene, &motion, &fitted(FitKind::Smoother)).expect("an inversion");
        let mut warnings = found.summary.warnings.into_iter();
        (
            found.rows[0].theta,
            warnings.find(|w| w.contains("mirror image")),
        )
    };
    let (_, said) = taken(pump.clone());
    let said = said.expect("nothing tells");
    assert!(
        said.contains(" 0.9000 rad") && said.contains("-0.9000 rad"),
        "{said}"
    );
    for sense in [1.0, -1.0] {
        let (begin, said) = taken(pump.clone().start(0.9 * sense, 15.0 * sense));
        assert!((begin - 0.9 * sense).abs() < 1e-3 && said.is_none());
        // Angle and speed of the scene contradict each other.
        let (_, said) = taken(pump.clone().start(0.9 * sense, -15.0 * sense));
        assert!(said.is_some());
    }
}

#[test]
fn angles_reduced_to_one_turn_are_continued() {
    let times: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
    let reduced = times
        .iter()
        .map(|t| (0.5 - 12.0 * t).rem_euclid(TAU))
        .collect();
    let motion = Measurement::new(Measured::Theta, times, reduced).expect("samples");
    let found = inverse(&pump(), &motion, &InverseOptions::default()).expect("an inversion");
    assert!(found.rows.iter().all(|row| (row.omega + 12.0).abs() < 1e-9));
    assert!(
        found
            .summary
            .warnings
            .iter()
            .any(|w| w.contains("reduced to one turn"))
    );
}

/// A noisy sensor whose scale is slightly too long shows more than one turn.
#[test]
fn angles_reduced_to_a_little_more_than_one_turn_are_continued() {
    let mut random = Random(1_442_695_040_888_963_407);
    let times: Vec<f64> = (0..4000).map(|i| 5e-4 * f64::from(i)).collect();
    let reduced = times
        .iter()
        .map(|t| 1.002 * (0.5 + 12.0 * t).rem_euclid(TAU) + 0.01 * random.normal())
        .collect();
    let motion = Measurement::new(Measured::Theta, times, reduced).expect("samples");
    let found = inverse(&pump(), &motion, &InverseOptions::default()).expect("an inversion");
    let turns = found.summary.data.revolutions;
    assert!((turns - 24.0 / TAU).abs() < 0.05, "{turns} turns");
}

#[test]
fn an_angle_that_jumps_is_named() {
    let times: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
    let reset = |t: &f64| 12.0 * t - if *t < 1.195 { 0.0 } else { 2.0 * TAU };
    let values = times.iter().map(reset).collect();
    let motion = Measurement::new(Measured::Theta, times, values).expect("samples");
    let found = inverse(&pump(), &motion, &InverseOptions::default()).expect("an inversion");
    let said = &found.summary.warnings[0];
    assert!(
        said.contains("theta jumps once, by -12.446") && said.contains("at sample 121"),
        "{said}"
    );
}

#[test]
fn at_a_dead_centre_the_force_is_empty_and_the_torque_is_not() {
    let times: Vec<f64> = (0..=100).map(|i| 0.01 * f64::from(i)).collect();
    let angles = times.iter().map(|t| TAU * (t - 0.5)).collect();
    let motion = Measurement::new(Measured::Theta, times, angles).expect("samples");
    let scene = Scene::new(0.05, 0.15).slider(Slider { mass: 2.0 });
    let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
    assert!(found.rows[50].near_dead_centre && found.rows[50].slider_force.is_none());
    assert!(found.rows[50].crank_torque.expect("a torque").abs() < 1e-9);
    assert!(!found.rows[20].near_dead_centre);
    let bands = &found.summary.dead_centre_bands;
    assert_eq!(
        (
            bands.len(),
            bands.iter().map(|band| band.rows).sum::<usize>()
        ),
        (3, 3)
    );
}

#[test]
fn forces_of_the_scene_are_in_or_beside_the_result() {
    let times: Vec<f64> = (0..50).map(|i| 0.01 * f64::from(i)).collect();
    let angles = times.iter().map(|t| 0.5 + 3.0 * t).collect();
    let motion = Measurement::new(Measured::Theta, times, angles).expect("samples");
    let scene = pump()
        .force(Load::Constant(-7.0))
        .torque(Load::Viscous(0.01));
    let whole = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
    let beside = InverseOptions {
        beside_forces: true,
        ..InverseOptions::default()
    };
    let beside = inverse(&scene, &motion, &beside).expect("an inversion");
    for (a, b) in whole.rows.iter().zip(&beside.rows) {
        let (a, b) = (
            a.slider_force.expect("a force"),
            b.slider_force.expect("a force"),
        );
        assert!((b - a - 7.0).abs() < 1e-9);
    }
}

/// Terms of (9) as printed at θ = 0.7 rad, from 50-digit evaluation of the printed formula; the weight with 9.81 m/s².
#[test]
fn the_printed_equation_is_the_printed_one() {
    let scene = Scene::duarte();
    let printed = AsPrinted::new(&scene).expect("the paper's scene");
    let motion = Measurement::duarte();
    let mut row = inverse(&scene, &motion, &InverseOptions::default())
        .expect("an inversion")
        .rows[30];
    row.theta = 0.7;
    let arm = Linkage::new(&scene.geometry).pose(0.7).dx;
    let mut torque = |omega: f64, alpha: f64| {
        (row.omega, row.alpha) = (omega, alpha);
        printed.forces(&row).expect("a force")[1] * arm
    };
    let weight = torque(0.0, 0.0);
    for (found, expected) in [
        (weight, 1.335367404 * (9.80665 / 9.81)),
        (torque(0.0, 1.0) - weight, 0.02845697349),
        (torque(1.0, 0.0) - weight, 0.0002632465862),
    ] {
        assert!(
            (found - expected).abs() < 2e-9 * expected.abs().max(0.1),
            "{found} for {expected}"
        );
    }
}

/// The table of forces under `data/` agrees with the program.
#[test]
fn the_table_of_forces_is_right() {
    let scene = Scene::duarte();
    let printed = AsPrinted::new(&scene).expect("the paper's scene");
    let found =
        inverse(&scene, &Measurement::duarte(), &InverseOptions::default()).expect("an inversion");
    let text = include_str!("../../data/duarte-forces.csv");
    let mut lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    for row in &found.rows {
        let cells: Vec<f64> = lines
            .next()
            .expect("a row")
            .split(',')
            .map(|cell| cell.parse().expect("a number"))
            .collect();
        let [spin_only, nine] = printed.forces(row).expect("a force");
        for (cell, expected) in [
            (cells[4], row.slider_force.expect("a force")),
            (cells[8], spin_only),
            (cells[9], nine),
        ] {
            assert!(
                (cell - expected).abs() < 1e-6 * expected.abs(),
                "{cell} for {expected}"
            );
        }
        // The file must be regenerated when the band changes.
        let error = row.slider_force_se.expect("an error");
        assert!(
            (cells[5] / error - 1.0).abs() < 0.01,
            "{} for {error}",
            cells[5]
        );
    }
    assert!(lines.next().is_none());
}
